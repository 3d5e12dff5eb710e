"""Closed loops: a hand on legs, and a single loop; against numbers found by other means."""

import ast
import importlib
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from loop_files import apart, newton, read_script, script_of

from closedform import (
    Crank,
    Derivation,
    Paper,
    Slide,
    Stretch,
    Strut,
    coupled,
    parallel,
    prove,
    real,
)
from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Naming
from closedform.lemmas.spheres import three_spheres
from closedform.model.functions import Program
from closedform.proof.links import prove_lemma
from closedform.proof.require import ProofError
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.new import new

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
HANDS = ("five_bar", "delta", "linear_delta", "orthoglide", "spherical_five_bar", "rpr_planar")
SINGLE = ("four_bar", "slider_crank")
STARTS = 40
LENGTH, ROD = real("l", nonnegative=True), real("r", nonnegative=True)


def robot(name: str):
    return importlib.import_module(f"closedform.generated.numpy.{name}")


def joints(module, rng, rows: int) -> np.ndarray:
    """Random joints; sliders within about the length of the legs."""
    slides = [module.SKELETON.joints[name].kind == "prismatic" for name in module.JOINTS]
    size = max(map(abs, module.Parameters()))
    low = np.where(slides, 0.2 * size, -np.pi)
    return rng.uniform(low, np.where(slides, size, np.pi), (rows, len(slides)))


# By Newton's method on the equations of the loop, written here from the drawing


def rods(name: str, q: np.ndarray, p: np.ndarray) -> np.ndarray:
    """By how much the length of each rod is missed."""
    values = robot(name).Parameters()
    if name == "five_bar":
        L0, L1, L2, L3, L4 = values
        ends = [(L1 * np.cos(q[0]), L1 * np.sin(q[0])), (L0 + L2 * np.cos(q[1]), L2 * np.sin(q[1]))]
        lengths = [L3, L4]
    elif name == "spherical_five_bar":
        angles = [np.arccos(np.clip(p @ b / np.linalg.norm(p), -1, 1)) for b in crank_ends(q)]
        return np.array([np.linalg.norm(p) - values.r, *angles]) - (0, values.beta1, values.beta2)
    elif name == "rpr_planar":
        ends, lengths = [(0.0, 0.0), (values.b, 0.0)], list(q)
    elif name == "orthoglide":
        ends, lengths = list(np.diag(q)), [values.L] * 3
    else:
        ends, lengths = [], [values.l] * 3
        for k in range(3):
            alpha = values[-3 + k] if name == "delta" else 2 * np.pi / 3 * k
            out = values.f - values.e
            out, up = (
                (out + values.L * np.cos(q[k]), -values.L * np.sin(q[k]))
                if name == "delta"
                else (out, q[k])
            )
            ends.append((out * np.cos(alpha), out * np.sin(alpha), up))
    return np.array([np.linalg.norm(p - e) - r for e, r in zip(ends, lengths, strict=True)])


def crank_ends(q: np.ndarray) -> list[np.ndarray]:
    """Directions of the ends of the spherical cranks: the z axis, turned by three angles each."""
    _, gamma, alpha1, alpha2, *_ = robot("spherical_five_bar").Parameters()
    # in the frame of an axis x, the crank at 0 points in y: a turn about z, then one about x
    return [
        turn("z", place) @ turn("x", angle) @ turn("z", arc) @ (1, 0, 0)
        for place, angle, arc in ((0, q[0], alpha1), (gamma, q[1], alpha2))
    ]


def turn(axis: str, angle: float) -> np.ndarray:
    i, j = {"x": (1, 2), "z": (0, 1)}[axis]
    R = np.eye(3)
    R[[i, j], [i, j]] = np.cos(angle)
    R[j, i], R[i, j] = np.sin(angle), -np.sin(angle)
    return R


@pytest.mark.parametrize("name", HANDS)
def test_newton_finds_no_posture_that_the_closed_form_lacks(name: str) -> None:
    module, rng = robot(name), np.random.default_rng(5)
    turns = np.array([module.SKELETON.joints[j].kind == "revolute" for j in module.JOINTS])
    forward = inverse = 0
    for q in joints(module, rng, 6):
        found = module.fk(q)
        size = max(map(abs, module.Parameters()))
        for start in rng.uniform(-2 * size, 2 * size, (STARTS, found.p.shape[-1])):
            p = newton(lambda p: rods(name, q, p), start)  # noqa: B023
            if p is not None:
                forward += 1
                assert np.nanmin(np.abs(found.p - p).max(axis=-1)) < 1e-6, (q, p)
        if not (found.status == OK).any():
            continue
        target = found.p[found.status == OK][0]
        answers = module.ik(target)
        for start in joints(module, rng, STARTS):
            posture = newton(lambda q: rods(name, q, target), start)  # noqa: B023
            if posture is not None and not (name == "rpr_planar" and (posture < 0).any()):
                inverse += 1
                gap = apart(answers.q, posture, turns)
                assert np.nanmin(gap) < 1e-5, (target, posture)
    assert forward > 20
    assert inverse > 20


@pytest.mark.parametrize("name", HANDS + SINGLE)
def test_inverse_and_forward_map_invert_each_other(name: str) -> None:
    """Every posture is among the branches of its image, and every branch leads back to it."""
    module, rng = robot(name), np.random.default_rng(6)
    turns = np.array([module.SKELETON.joints[j].kind == "revolute" for j in module.JOINTS])
    q = joints(module, rng, 100_000)
    p, status = module.fk(q)
    mode = rng.integers(2, size=len(q))
    p, status = p[np.arange(len(q)), mode], status[np.arange(len(q)), mode]
    q, p = q[status == OK], p[status == OK]
    assert len(q) > 1000
    answers = module.ik(p)
    assert np.nanmin(apart(answers.q, q[:, None], turns), axis=1).max() < 1e-6
    back, there = module.fk(answers.q)
    scale = np.sum(np.abs(module.Parameters())) + (0 if turns.all() else np.abs(q).max())
    angle = name == "four_bar"
    miss = apart(back, p[:, None, None], np.array([angle]))
    miss = np.where(there == OK, miss, np.inf).min(axis=-1)
    good = answers.status == OK
    assert good.mean() > 0.4
    assert miss[good].max() < 1e-12 * (1 if angle else scale)


@pytest.mark.parametrize("name", HANDS + SINGLE)
def test_the_jacobian_is_the_derivative(name: str) -> None:
    module, rng = robot(name), np.random.default_rng(7)
    q = joints(module, rng, 400)
    steps = 1e-6 * np.eye(q.shape[-1])
    rates = [(module.fk(q + s).p - module.fk(q - s).p) / 2e-6 for s in steps]
    expected = np.stack(rates, axis=-1)
    J, kept = module.jacobian(q), np.isfinite(expected).all(axis=(-1, -2))
    if name in HANDS:
        kept &= module.condition_number(q) < 20
    kept &= np.abs(J).max(axis=(-1, -2)) < 20
    assert kept.sum() > 100
    np.testing.assert_allclose(J[kept], expected[kept], atol=1e-6)
    A, B = module.jacobian_parallel(q), module.jacobian_serial(q)
    legs = B.shape[-1]
    rest = (A @ J)[kept][:, : A.shape[-1] - legs]  # what has no joint does not change
    np.testing.assert_allclose(rest, np.zeros_like(rest), atol=1e-9)
    driven = (A @ J)[..., A.shape[-1] - legs :, :]
    np.testing.assert_allclose(driven[kept], (B[..., None] * np.eye(legs))[kept], atol=1e-9)


@pytest.mark.parametrize("name", HANDS[:5])
def test_the_sign_of_each_leg_names_its_working_mode(name: str) -> None:
    module, rng = robot(name), np.random.default_rng(8)
    p, status = module.fk(joints(module, rng, 300))
    answers = module.ik(p[status == OK])
    B = module.jacobian_serial(answers.q)
    modes = np.array([[-1 if s == "minus" else 1 for s in b.split("_")] for b in module.BRANCHES])
    target = p[status == OK][:, None, None]
    there = np.abs(module.fk(answers.q).p - target).max(axis=-1) < 1e-9
    for row, branch, mode in np.argwhere(there & (answers.status == OK)[..., None]):
        assert (B[row, branch, mode] * modes[branch] > -1e-9).all()


def test_orthoglide_is_isotropic_at_home() -> None:
    module = robot("orthoglide")
    q = np.ones(3)
    (mode,) = np.flatnonzero(np.abs(module.fk(q).p).max(axis=-1) < 1e-12)
    assert module.condition_number(q)[mode] == pytest.approx(1)
    np.testing.assert_allclose(np.abs(module.jacobian(q)[mode]), np.eye(3), atol=1e-12)


def test_a_small_spherical_five_bar_is_a_planar_one() -> None:
    """On a sphere of ten thousand times its size, mode by mode and branch by branch."""
    planar, sphere, rng = robot("five_bar"), robot("spherical_five_bar"), np.random.default_rng(11)
    lengths, r = np.array([6.0, 7.0, 5.0, 9.0, 8.0]), 1e5
    L0, L1, L2, L3, L4 = lengths / r
    parameters = sphere.Parameters(r, L0, L1, L2, L3, L4)
    q = rng.uniform(-np.pi, np.pi, (2000, 2))
    expected, found = planar.fk(q, lengths), sphere.fk(q, parameters)
    assert planar.BRANCHES == sphere.BRANCHES
    assert planar.ASSEMBLY_MODES == sphere.ASSEMBLY_MODES
    good = (expected.status == OK) & (np.abs(planar.singularities(q, lengths)[..., -1]) > 5)
    assert good.sum() > 1000
    np.testing.assert_allclose(found.p[good][:, 1:], expected.p[good], atol=1e-4)
    p = found.p[good]
    good = planar.ik(p[:, 1:], lengths).status == OK
    answers = planar.ik(p[:, 1:], lengths).q, sphere.ik(p, parameters).q
    B = np.abs(planar.jacobian_serial(answers[0], lengths)).min(axis=(-1, -2)) > 5
    gap = apart(*answers, np.array([True]))[good & B]
    assert len(gap) > 1000
    assert gap.max() < 1e-4


def test_spherical_five_bar_at_right_angles_is_isotropic() -> None:
    module = robot("spherical_five_bar")
    right = module.Parameters(1, *[np.pi / 2] * 5)
    q = np.array([0, np.pi])
    np.testing.assert_allclose(np.abs(module.fk(q, right).p), [[0, 0, 1]] * 2, atol=1e-15)
    np.testing.assert_allclose(module.condition_number(q, right), 1)
    rng = np.random.default_rng(12)
    q = joints(module, rng, 200)
    p, A = module.fk(q).p, module.jacobian_parallel(q)
    there = np.isfinite(p).all(axis=-1) & (module.condition_number(q) < 1e3)
    along = p[there][:, :, None] * p[there][:, None] / module.Parameters().r ** 2
    singular = np.linalg.svd(A[there][:, 1:] @ (np.eye(3) - along), compute_uv=False)
    np.testing.assert_allclose(module.condition_number(q)[there], singular[:, 0] / singular[:, 1])


def test_a_target_off_the_sphere_is_unreachable() -> None:
    module = robot("spherical_five_bar")
    p = module.fk(np.array([1.9, 1.2])).p[0]
    size = np.array([1, 1 + 1e-13, 1 + 1e-11, 1 - 1e-11, 0.5, 0])[:, None]
    statuses = module.ik(size * p).status
    np.testing.assert_array_equal(statuses, np.repeat([[OK, OK, *[UNREACHABLE] * 4]], 4, 0).T)
    np.testing.assert_array_equal(module.workspace_contains(size * p), (statuses == OK)[:, 0])


def test_four_bar_satisfies_freudensteins_equation() -> None:
    module = robot("four_bar")
    L1, L2, L3, L4 = module.Parameters()
    theta = np.linspace(-3, 3, 101)[:, None]
    psi = module.fk(theta).p[..., 0]
    total = L1**2 + L2**2 - L3**2 + L4**2
    left = 2 * L1 * L4 * np.cos(psi) - 2 * L1 * L2 * np.cos(theta) + total
    np.testing.assert_allclose(left, 2 * L2 * L4 * np.cos(theta - psi), atol=1e-12)


@pytest.mark.parametrize("name", ["delta", "orthoglide", "five_bar", "spherical_five_bar"])
def test_where_the_centres_coincide_the_hand_is_free(name: str) -> None:
    """Two legs with the same end: the status says so, and the answer satisfies the loop."""
    module = robot(name)
    q, parameters = {
        "delta": ([0.3, 0.3, 0.5], (0.1, 0.04, 0.15, 0.35, 1.0, 1.0, 2.0)),
        "orthoglide": ([0.0, 0.0, 0.3], (1.0,)),
        "five_bar": ([0.4, 0.4], (0.0, 2.0, 2.0, 1.0, 1.0)),
        "spherical_five_bar": ([0.4, 0.4], (1.0, 0.0, 0.9, 0.9, np.pi / 3, np.pi / 3)),
    }[name]
    p, status = module.fk(np.array(q), parameters)
    assert (status == SINGULAR).all()
    A = module.jacobian_parallel(np.array(q), parameters)
    lengths = np.linalg.norm(A, axis=-1)
    np.testing.assert_allclose(lengths, lengths[0, 0], rtol=1e-12)
    assert np.isfinite(p).all()


# Proofs can fail


def spheres(sign: int = 1):
    program, x = Program(), tuple(map(real, "xyz"))
    radius = real("r", nonnegative=True)
    centres = [sp.Matrix([real(f"c{3 * k + i}") for i in range(3)]) for k in range(3)]
    found = three_spheres(program, centres, [radius] * 3, x, real("sigma"), scale=real("size"))
    solution = {u: sign * e for u, e in found.lemma.solution.items()}
    return replace(found.link, lemma=replace(found.lemma, solution=solution))


def test_three_spheres_is_proved_and_can_fail() -> None:
    assert prove_lemma(spheres(), (real("sigma"),), "")[1].count == 2
    with pytest.raises(ProofError, match="does not satisfy its equations"):
        prove_lemma(spheres(-1), (real("sigma"),), "")


@pytest.mark.parametrize(
    "leg",
    [
        Crank(real("q"), LENGTH, ROD, pivot=(0, 0), along=(1, 0), across=(0, 1)),
        Crank(real("q"), LENGTH, ROD, pivot=(0, 0, 0), along=(1, 0, 0), across=(0, 1, 0)),
        Slide(real("q"), ROD, (0, 0, 0), (0, 0, 1)),
        Stretch(real("q"), (0, 0, 0)),
    ],
    ids=["crank in a plane", "crank in space", "slide", "stretch"],
)
def test_the_lemma_of_each_leg(leg) -> None:
    w = sp.Matrix([real(f"w{i}") for i in range(len(leg.base))])
    found = leg.solve(Naming(Program(), real("size"), "_1"), w, real("sigma"))
    counted = prove_lemma(found.link, (real("sigma"),), "")[1]
    assert counted.count == found.link.lemma.branches + found.link.lemma.excluded


def a_five_bar(second: Crank | None = None) -> Derivation:
    d = Derivation(
        "loop", "Loop", Paper("loop", "A loop", ("A. Nonymous",)), "A loop.", task=["x", "y"]
    )
    L, M = (
        d.parameter(n, value=v, unit="m", meaning="a length", source="a test")
        for n, v in (("L", 2), ("M", 3))
    )
    q1, q2 = d.joint("q1"), d.joint("q2")
    legs = [
        Crank(q1, L, M, pivot=(0, 0), along=(1, 0), across=(0, 1)),
        Crank(q2, L, M, pivot=(L, 0), along=(1, 0), across=(0, 1)),
    ]
    parallel(d, (real("x"), real("y")), [legs[0], second or legs[1]])
    return d


def test_a_crank_whose_directions_are_not_at_right_angles_is_found() -> None:
    d = a_five_bar()
    with pytest.raises(ProofError):
        slanted = Crank(
            real("q2"),
            d.parameters[0].symbol,
            d.parameters[1].symbol,
            pivot=(1, 0),
            along=(1, 0),
            across=(1, 1),
        )
        prove(a_five_bar(slanted))
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 2, "ik": 4}


def test_legs_and_joints_must_agree() -> None:
    d = a_five_bar()
    with pytest.raises(ShapeError, match="two legs in a plane or three in space"):
        parallel(d, (real("x"), real("y")), [Stretch(real("q1"), (0, 0))])
    with pytest.raises(ShapeError, match="give the legs in this order"):
        parallel(d, (real("x"), real("y")), [Stretch(q, (0, 0)) for q in (real("q2"), real("q1"))])
    for legs in ([Strut(1, (0, 0)), Stretch(real("q1"), (0, 0))], [Strut(1, (0, 0))] * 2):
        with pytest.raises(ShapeError, match="must be the first of three legs in space"):
            parallel(d, (real("x"), real("y")), legs)
    with pytest.raises(ValueError, match="same rod"):
        coupled(
            d,
            Crank(real("q1"), 1, 2, pivot=(0, 0), along=(1, 0), across=(0, 1)),
            Slide(real("x"), 3, (0, 0), (1, 0)),
        )


# From a file

FIVE_BAR = """
hand = "P"
[parameters]
L0 = {value = "0.5", meaning = "distance of the pivots"}
[bodies.ground]
A1 = [0, 0]
A2 = ["L0", 0]
[bodies.crank1]
B1 = ["L1", 0]
[bodies.crank2]
B2 = ["L0 + L2", 0]
[bodies.rod1]
length = "L3"
[bodies.rod2]
length = "L4"
[joints.theta1]
between = ["ground", "crank1"]
at = "A1"
driven = true
[joints.theta2]
between = ["ground", "crank2"]
at = "A2"
driven = true
[joints.b1]
between = ["crank1", "rod1"]
at = "B1"
[joints.b2]
between = ["crank2", "rod2"]
at = "B2"
[joints.p]
between = ["rod1", "rod2"]
at = "P"
"""


def written(text: str, tmp_path: Path) -> Derivation:
    return read_script(script_of("loop", text, tmp_path))


def test_a_loop_from_a_file_is_the_one_from_legs(tmp_path: Path) -> None:
    d = written(FIVE_BAR, tmp_path)
    original = importlib.import_module("closedform.derivations.five_bar").d
    assert [f.name for f in d.functions] == [
        f.name for f in original.functions if f.name != "passive_angles"
    ]
    names = {p.symbol: sp.Symbol(p.name) for p in (*d.parameters, *original.parameters)}
    own, given = (i.inverses[1].forward for i in (d, original))
    assert [e.xreplace(names) for e in own] == [e.xreplace(names) for e in given]


SLIDERS = """
hand = "P"
[bodies.ground]
O = [0, 0, 0]
[bodies.x]
O = [0, 0, 0]
[bodies.y]
O = [0, 0, 0]
[bodies.z]
O = [0, 0, 0]
[bodies.rod1]
length = "L"
parallelogram = [0, "w", 0]
[bodies.rod2]
length = "L"
parallelogram = [0, 0, "w"]
[bodies.rod3]
length = "L"
parallelogram = [0, "w", 0]
[bodies.hand]
P = [0, 0, 0]
C = ["e", 0, 0]
[joints.q1]
between = ["ground", "x"]
kind = "prismatic"
axis = [1, 0, 0]
driven = true
[joints.q2]
between = ["ground", "y"]
kind = "prismatic"
axis = [0, 1, 0]
driven = true
[joints.q3]
between = ["ground", "z"]
kind = "prismatic"
axis = [0, 0, 2]
driven = true
[joints.b1]
between = ["x", "rod1"]
at = "O"
[joints.b2]
between = ["y", "rod2"]
at = "O"
[joints.b3]
between = ["z", "rod3"]
at = "O"
[joints.c1]
between = ["rod1", "hand"]
at = "C"
[joints.c2]
between = ["rod2", "hand"]
at = "C"
[joints.c3]
between = ["rod3", "hand"]
at = "C"
"""


def test_three_sliders_from_a_file_are_proved(tmp_path: Path) -> None:
    proof = prove(written(SLIDERS, tmp_path))
    assert {i.function: i.solutions for i in proof.inverses} == {"fk": 2, "ik": 8}


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('hand = "P"', 'hand = "Q"', "is not a point of a body"),
        ("driven = true", "driven = false", "no joint is driven"),
        ('parallelogram = [0, "w", 0]\n', "", "may turn"),
        ('[0, "w", 0]', "true", "a vector along its short sides"),
        ('[0, "w", 0]', "[0, 0]", "a vector along its short sides"),
        ('[0, "w", 0]', "[0, 0, 0]", "need a length"),
        ("axis = [0, 0, 2]\n", "", "say in which direction"),
        ("axis = [0, 0, 2]", "axis = [0, 0, 0]", "has no length"),
        ("axis = [0, 0, 2]", "axis = [0, 0]", "needs 3 coordinates"),
        ('between = ["z", "rod3"]', 'between = ["z", "rod4"]', "there is no body rod4"),
        ("[bodies.ground]", "[bodies.frame]", "there is no"),
        ('length = "L"', 'length = "().__class__"', "loop.toml"),
        ("O = [0, 0, 0]", "O = [0, 0]", "2 coordinates"),
        ("driven = true", 'driven = "yes"', "true or false"),
        ('between = ["z", "rod3"]', 'between = ["z\\u202e", "rod3"]', r"not 'z\\u202e'"),
        ('at = "C"', 'at = ""', "letters, digits"),
        ('hand = "P"', 'hand = "P\\n"', "letters, digits"),
        ('at = "O"', 'at = "U"', "x has no point U, where b1 is"),
        ('length = "L"', "length = -0.5", "must be positive, not -1/2"),
        ('length = "L"', 'lenght = "L"', "did you mean length?"),
        ('length = "L"\n', 'length = "L"\nQ = [0, 0, 0]\n', "no points, but there is Q"),
        ('["z", "rod3"]', '["rod3", "rod3"]', "between names rod3 twice"),
        ('["rod3", "hand"]', '["rod3", "x"]', "it is joined to rod1 and rod3"),
        (
            '["rod3", "hand"]\nat = "C"',
            '["rod3", "half"]\nat = "C"\n[bodies.half]\nC = [0, 0, 0]',
            "c3 leads to half, not to a body with the point P, which is the hand",
        ),
        ("[bodies.hand]", "[bodies.spare]\nS = [0, 0, 0]\n[bodies.hand]", "no joint holds spare"),
        (
            "[joints.b1]",
            "[bodies.rod4]\nlength = 1\n[joints.b4]\nbetween = ['ground', 'rod4']\n"
            "at = 'O'\n[joints.c4]\nbetween = ['rod4', 'hand']\nat = 'P'\n[joints.b1]",
            "a hand that does not turn needs 2 beside its strut",
        ),
        (
            "[joints.b1]",
            "[bodies.tube]\nO = [0, 0, 0]\n[joints.o]\nbetween = ['ground', 'tube']\n"
            "kind = 'universal'\n[joints.s]\nbetween = ['tube', 'hand']\nat = 'P'\n"
            "kind = 'prismatic'\n[joints.b1]",
            "no leg contains o and s;",
        ),
    ],
)
def test_a_file_that_cannot_be_read_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        written(SLIDERS.replace(old, other), tmp_path)


def test_the_pivot_of_a_crank_has_one_place(tmp_path: Path) -> None:
    moved = FIVE_BAR.replace("[bodies.crank2]", "[bodies.crank2]\nA2 = [0, 0]")
    with pytest.raises(TableError, match="A2, where theta2 is, has different coordinates"):
        written(moved, tmp_path)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("L0; import os", "is not a name"),
        ("Crank", "uses the name Crank itself"),
        ("Rail", "uses the name Rail itself"),
        ("lambda", "lambda"),
        ("theta1", "is a joint and a parameter"),
        ("x", "is a coordinate of the hand"),
    ],
)
def test_names_that_would_enter_the_script_are_refused(
    name: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        written(FIVE_BAR.replace("L0 = {", f'"{name}" = {{'), tmp_path)


@pytest.mark.parametrize(("old", "name"), [("L0", "d"), ("theta1", "z")])
def test_a_name_may_be_that_of_the_derivation_or_of_a_coordinate_out_of_the_plane(
    old: str, name: str, tmp_path: Path
) -> None:
    """The script calls the derivation d itself; a hand in a plane has no z."""
    (tmp_path / "bar.toml").write_text(re.sub(rf"\b{old}\b", name, FIVE_BAR), "utf-8")
    space: dict = {}
    exec(compile(new("arm", "loop", tmp_path / "bar.toml").text, "script.py", "exec"), space)
    names = {str(p.symbol) for p in space["d"].parameters} | {*map(str, space["d"].actuated)}
    assert name in names and old not in names and "d_" not in names


def test_the_name_of_a_file_stays_a_text(tmp_path: Path) -> None:
    path = tmp_path / 'loop"""; raise SystemExit; """.toml'
    path.write_text(FIVE_BAR, "utf-8")
    script = new("arm", "loop", path).text
    assert not [n for n in ast.walk(ast.parse(script)) if isinstance(n, ast.Raise)]


@pytest.mark.parametrize("power", [-700, 0, 700])
@pytest.mark.parametrize("name", ["delta", "linear_delta", "orthoglide", "spherical_five_bar"])
def test_where_spheres_meet_scales_with_the_lengths(name: str, power: int) -> None:
    module = importlib.import_module(f"closedform.generated.numpy.{name}")
    lengths, scale = np.array(module.Parameters()), 2.0**power
    turned = [f.startswith(("alpha", "beta", "gamma")) for f in module.Parameters._fields]
    slides = name in ("linear_delta", "orthoglide")
    q = np.array([0.1, 0.15, 0.2])[: len(module.JOINTS)]
    p, status = module.fk(q * scale if slides else q, np.where(turned, lengths, lengths * scale))
    assert (status == OK).all()
    np.testing.assert_array_equal(p / scale, module.fk(q, lengths).p)
    p, status = module.fk(0 * q, 0 * lengths)
    assert (status == SINGULAR).all()
    assert (p == 0).all()
