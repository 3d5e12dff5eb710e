"""Inverses of arms as a reader computes them: in angles, and with one product of rotations."""

import random

import pytest
import sympy as sp

from closedform.emit.backends.latex.angles import _InAngles, added, in_angles, turned
from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.functions import (
    Bound,
    Function,
    Let,
    Statement,
    Vanishes,
    array,
    choose,
    real,
)
from closedform.pipeline import scripts

ARMS = ("franka_arm", "irb2400", "opw_arm", "puma560", "srs_arm", "stanford_arm", "ur_arm")
LETTERS = ("alpha", "gamma", "delta", "zeta", "mu", "nu", "xi")
a, b, x, y = (real(name) for name in "abxy")


def inverse(name: str) -> tuple[Derivation, Function, list, tuple[sp.Symbol, ...]]:
    derivation = scripts.load(next(s for s in scripts.sources() if s.name == name))
    f = next(f for f in derivation.functions if f.has_status)
    found = next(i for i in derivation.inverses if i.function == f.name)
    return derivation, f, [k.lemma for k in found.links if k.lemma], found.unknowns


def target(derivation: Derivation, ik: Function) -> dict[sp.Basic, sp.Expr]:
    """The parameters, and the target of a posture in general position."""
    draw = random.Random(7)
    forward = next(f for f in derivation.functions if f.name == "fk")
    values = {p.symbol: p.value for p in derivation.parameters}
    joints = {j.symbol: sp.Rational(draw.randrange(200, 900), 1000) for j in derivation.joints}
    pose = [sp.N(e.xreplace(values | joints), 40) for e in forward.values({})]
    first, *rest = ik.inputs
    given = {e: sp.Rational(3, 5) for array in rest for e in array.entries}
    return values | dict(zip(first.entries, pose, strict=True)) | given


def computed(f: Function, known: dict[sp.Basic, sp.Expr]) -> list[sp.Expr]:
    """The outputs in digits, statement by statement."""
    flags = {s.symbol: sp.false for s in f.body if isinstance(s, Vanishes)}
    values = {s.symbol: s.value for s in f.body if isinstance(s, Let | Bound)}
    done = dict(known)

    def number(value: sp.Expr) -> sp.Expr:
        value = substitute(value, flags)
        for name in value.free_symbols - done.keys():
            done[name] = number(values[name])
        return sp.N(value.xreplace(done), 40)

    return [number(e) for a in f.outputs for e in a.entries]


@pytest.mark.parametrize("name", ARMS)
def test_every_branch_is_the_same(name: str) -> None:
    derivation, f, lemmas, unknowns = inverse(name)
    read = in_angles(f, lemmas, unknowns, LETTERS)
    shown = {n: v for step in derivation.steps for n, v in step.shown if "R_{" in n}
    turned_once = read.multiplied({n: v for n, v in shown.items() if v.shape == (3, 3)})
    point = target(derivation, f)
    given = {read.names[e]: v for e, v in point.items() if e in read.names}
    reached = 0
    for _, chosen in f.cases():
        signs = {s: sp.Integer(v) for s, v in chosen.items()}
        expected = computed(f, point | signs)
        if not all(e.is_real for e in expected):
            continue  # out of reach
        reached += 1
        for g in (read.function, turned_once.function):
            for one, other in zip(expected, computed(g, point | given | signs), strict=True):
                assert abs(sp.sin((one - other) / 2)) < 1e-25
    assert reached >= 2


def test_the_franka_arm_is_told_in_few_lines() -> None:
    derivation, f, lemmas, unknowns = inverse("franka_arm")
    shown = {n: v for step in derivation.steps for n, v in step.shown if n in ("R_{03}", "R_{37}")}
    read = in_angles(f, lemmas, unknowns, LETTERS).multiplied(shown)
    assert read.product == r"R' = R\,R_{37}^T"
    assert read.function.outputs[0].entries == unknowns
    values = {str(s.symbol): s.value for s in read.function.body if isinstance(s, Let)}
    assert values["theta4"] == real("elbow") - real("alpha")
    assert not {"lever_elbow", "span_elbow", "size"} & {
        str(s) for s in values["elbow"].free_symbols
    }
    assert not any(name.startswith("R3_") for name in values)


def test_sums_of_angles_are_added() -> None:
    value = a * (sp.sin(x) * sp.cos(y) - sp.cos(x) * sp.sin(y)) + sp.cos(x + y)
    assert added(value, {}) == a * sp.sin(x - y) + sp.cos(x + y)
    assert added(value, {x + y: b}) == a * sp.sin(x - y) + sp.cos(b)


def test_a_vector_that_is_turned_has_the_sum_of_two_angles() -> None:
    assert turned(sp.sin(x), sp.cos(x)) == x
    assert turned(sp.cos(x), -sp.sin(x)) == x + sp.pi / 2
    back = turned(b * sp.cos(x) - a * sp.sin(x), a * sp.cos(x) + b * sp.sin(x))
    assert back == sp.atan2(b, a) - x
    assert turned(a * sp.sin(x), b * sp.cos(x)) is None


@pytest.mark.parametrize("name", ARMS)
def test_an_angle_that_a_flag_changes_has_no_value_of_another_name(name: str) -> None:
    """Where the wrist of a UR arm is aligned, phi is not 0, as a name on the way to it is."""
    _, f, lemmas, unknowns = inverse(name)
    read = in_angles(f, lemmas, unknowns, LETTERS)
    values = {s.symbol: s.value for s in read.function.body if isinstance(s, Let)}
    chosen = {str(u): values[u] for angles in read.chosen.values() for u in angles}
    assert [*chosen] == (["phi"] if name == "ur_arm" else [])
    assert not any(value.has(sp.Piecewise) for value in chosen.values())


def test_a_large_maximum_is_not_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """SymPy would compare its arguments again, which took a minute for a skew wrist."""
    angles = in_progress(x)
    many = sum(b * sp.sqrt(a**k + b) * real(f"z{k}") for k in range(2, 20))
    bound = sp.Max(many, x, evaluate=False)
    monkeypatch.setattr(sp.Max, "_find_localzeros", None)
    length = sp.sqrt(x**2 + 1)
    shorter = angles._shorter(length * (bound + 1) * y, length * x * y**2)
    assert shorter == (y * bound + y, x * y**2)


def test_flags_are_looked_into_before_an_angle_is_derived() -> None:
    """Where a flag holds, the pair is that of a number, or still depends on other names."""
    flag, s, c = sp.Symbol("free"), real("s1"), real("c1")
    for beside, varies in ((sp.S.Zero, False), (y, True)):
        angles = in_progress(
            sp.atan2(s, c),
            Vanishes(flag, a**2, sp.S.One, "a is zero"),
            Let(s, choose(flag, beside, x)),
            Let(c, choose(flag, b**2 + 1, a)),
        )
        assert angles._varies(sp.atan2(s, c), flag) == varies


def in_progress(output: sp.Expr, *body: Statement) -> _InAngles:
    inputs = tuple(array(e.name, e) for e in (a, b, x, y))
    return _InAngles(
        Function("ik", "", inputs, (array("q", output),), body), (), (), iter(LETTERS), {}
    )
