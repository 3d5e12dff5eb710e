"""Lowered programs: their cost, what they share, and that they mean the same as the source."""

import importlib
import math

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from interpreter import run
from sympy import cos, sin, sqrt

from closedform.lower import Lowered, lower
from closedform.lower import lowered as lowered_once
from closedform.lower.graph import Graph, hardly_ever, reachable
from closedform.lower.share import same
from closedform.mechanics.frames import exponential
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import Function, Program, array, choose, real, sign_of
from closedform.model.tolerances import DOUBLE

x, y, z = (real(n) for n in "xyz")
SYMBOLS = (x, y, z)
EMPTY = Derivation("test", "", Paper("", "", ()), "")


def lowered(*exprs: sp.Expr) -> Lowered:
    d = Derivation("test", "", Paper("", "", ()), "")
    return lower(d.function("f", "", {"q": SYMBOLS}, {"y": list(exprs)}), d)


def test_a_function_is_lowered_once() -> None:
    d = Derivation("test", "", Paper("", "", ()), "")
    f, g = (d.function(name, "", {"q": SYMBOLS}, {"y": [x + y * z]}) for name in "fg")
    assert lowered_once(f, d) is lowered_once(f, d) is not lowered_once(g, d)


leaves = st.sampled_from(
    [x, y, z, sp.Integer(2), sp.Rational(-3, 7), sin(x), cos(x + y), sin(2 * z - x / 2)]
)
expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.tuples(inner, inner).map(lambda p: p[0] + p[1]),
        st.tuples(inner, inner).map(lambda p: p[0] - p[1]),
        st.tuples(inner, inner).map(lambda p: p[0] * p[1]),
        inner.map(lambda e: e**2),
        inner.map(lambda e: sqrt(1 + e**2)),
        inner.map(lambda e: 1 / (2 + e**2)),
    ),
    max_leaves=12,
)


@settings(max_examples=150, deadline=None)
@given(st.lists(expressions, min_size=1, max_size=4), st.tuples(*[st.floats(-3, 3)] * 3))
def test_means_what_the_source_means(exprs: list[sp.Expr], point: tuple[float, ...]) -> None:
    values = dict(zip("xyz", point, strict=True))
    computed = run(lowered(*exprs), values)
    substitution = {s: sp.Float(v, 40) for s, v in zip(SYMBOLS, point, strict=True)}
    for got, expr in zip(computed, exprs, strict=True):
        exact = float(sp.N(expr.subs(substitution), 30))
        scale = float(
            sp.N(sum(abs(t.subs(substitution)) for t in sp.Add.make_args(sp.expand(expr))), 15)
        )
        assert got == pytest.approx(exact, rel=1e-12, abs=1e-12 * (1 + scale))


def test_sign_twins_share_their_value() -> None:
    assert lowered(x * y - z, z - x * y).operations() == {"mul": 1, "sub": 1}


def test_common_parts_are_computed_once() -> None:
    assert lowered(x * y * z, x * z).operations() == {"mul": 2}
    assert lowered(x + y + z, x + z - y, x + z).operations() == {"add": 2, "sub": 1}


def test_an_inverse_divides_once_by_the_same_value() -> None:
    """A forward map keeps its divisions: they are rounded once."""
    quotients = [x / (y + z), -z / (y + z), x / 3, z / 3]
    assert lowered(*quotients).operations()["div"] == 4
    d = Derivation("test", "", Paper("", "", ()), "")
    inputs, outputs = {"x": SYMBOLS}, {"q": quotients}
    program = lower(d.function("ik", "", inputs, outputs, result="Solutions"), d)
    assert program.operations()["div"] == 3


def test_roots_of_what_is_not_negative_become_one() -> None:
    squares = [1 + x**2, y**2 + z**2, 2 + z**2]
    a, b, c = map(sqrt, squares)
    assert lowered(3 * a * b * c).operations()["sqrt"] == 1
    assert lowered(a * b, z * a * b).operations()["sqrt"] == 1
    assert lowered(a * b, b * c).operations()["sqrt"] == 3, "b stands in two products"
    assert lowered(a * b, b + z).operations()["sqrt"] == 2
    assert lowered(sqrt(x) * sqrt(y)).operations()["sqrt"] == 2, "both may be negative"


def test_roots_of_quotients_by_what_a_flag_chooses_become_one() -> None:
    def operations(divisor: sp.Expr) -> dict[str, int]:
        p = Program()
        flag = p.vanishes("flag", y**2, 1, "y is zero", squares=True)
        root = sqrt(1 + x**2) * sqrt(1 / choose(flag, 1, divisor))
        d = Derivation("test", "", Paper("", "", ()), "")
        return lower(d.function("f", "", {"x": SYMBOLS}, {"q": [root]}, program=p), d).operations()

    assert operations(y**2)["sqrt"] == 1
    assert operations(y)["sqrt"] == 2, "y may be negative"


@pytest.mark.parametrize(("squares", "power"), [(False, 1), (True, 2)])
def test_a_square_vanishes_where_its_root_does(squares: bool, power: int) -> None:
    p = Program()
    flag = p.vanishes("flag", sp.Abs(y) ** power, x**power, "y is zero", squares=squares)
    d = Derivation("test", "", Paper("", "", ()), "")
    outputs = {"q": [choose(flag, 1, 0)]}
    program = lower(d.function("f", "", {"x": SYMBOLS}, outputs, program=p), d)
    for factor, expected in ((0.9, 1), (1.1, 0)):
        values = {"x": 3.0, "y": -3 * factor * DOUBLE.vanishing, "z": 0.0}
        assert run(program, values) == [expected]


def test_angles_take_one_root_and_no_division() -> None:
    a, b = sqrt(1 + x**2), sqrt(y**2 + z**2)
    assert lowered(2 * sp.atan2(a, b)).operations()["sqrt"] == 1
    assert lowered(2 * sp.atan2(a, b), 3 * sp.atan2(a, b)).operations()["sqrt"] == 3
    assert lowered(2 * sp.atan2(x, b)).operations()["sqrt"] == 1
    size = 1 + x**2
    assert "div" not in lowered(sp.atan2(-y / size, z / size)).operations()
    assert lowered(sp.atan2(y / x, z / x)).operations()["div"] == 2, "x may be negative"


coordinates = st.sampled_from([0.0, 1e-9, 0.5, 1.0]) | st.floats(1e-30, 3) | st.floats(-3, -1e-30)


@settings(deadline=None)
@given(st.tuples(coordinates, coordinates, coordinates))
def test_angles_by_one_root_are_those_of_two(point: tuple[float, float, float]) -> None:
    """Also if both roots vanish, and if the angle is 0, a right angle or half a turn."""
    a, b = abs(point[0]), math.hypot(*point[1:])
    size = 1 + point[2] ** 2
    exprs = [
        2 * sp.atan2(sp.Abs(x), sqrt(y**2 + z**2)),
        2 * sp.atan2(sqrt(x**2) * sqrt(1 + z**2), sqrt(y**2 + z**2) * sqrt(1 + z**2)),
        -4 * sp.atan2(sqrt(y**2 + z**2), sqrt(x**2)) / 2,
        sp.atan2(-x / (1 + z**2), y / (1 + z**2)),
    ]
    angles = [2 * math.atan2(a, b), 2 * math.atan2(a, b), -2 * math.atan2(b, a)]
    angles += [math.atan2(-point[0] / size, point[1] / size)]
    got = run(lowered(*exprs), dict(zip("xyz", point, strict=True)))
    for found, expected in zip(got, angles, strict=True):
        assert math.remainder(found - expected, math.tau) == pytest.approx(0, abs=1e-14)


def test_only_flags_are_rare() -> None:
    """Either value of a computed sign is equally likely, even if the sign depends on flags."""
    p = Program()
    flag = p.vanishes("flag", y**2, x**2, "y is zero")
    turned = p.let("turned", choose(flag, 0, z / y))
    sign = sp.Piecewise((2, turned >= 0), (-1, True))
    d = Derivation("test", "", Paper("", "", ()), "")
    f = d.function("f", "", {"x": SYMBOLS}, {"q": [turned, sign * x]}, program=p)
    selects = [n for n in reachable(lower(f, d).roots) if n.op == "select"]
    assert sorted(hardly_ever(n.args[0]) for n in selects) == [False, True]


@pytest.mark.parametrize("signs", [(1, 1), (1, -1), (-1, 1), (-1, -1)])
def test_a_shared_pair_keeps_its_sign(signs: tuple[int, int]) -> None:
    """The pair y, z is in three sums, with all signs, and never first."""
    b, c = signs
    exprs = [x + b * y + c * z, x - b * y - c * z, 2 * x + b * y + c * z]
    values = {"x": 0.3, "y": 1.7, "z": -0.4}
    got = run(lowered(*exprs), values)
    exact = [float(e.subs(dict(zip(SYMBOLS, values.values(), strict=True)))) for e in exprs]
    assert got == pytest.approx(exact, abs=1e-14)
    assert sum(lowered(*exprs).operations().values()) <= 5


def test_trigonometry_is_taken_of_joint_angles_alone() -> None:
    program = lowered(cos(x + y), sin(x + y), sin(-x), cos(-y), sin(2 * x))
    assert len(program.angles) == 2
    assert {a.op for a in program.angles} == {"input"}
    assert len(lowered(sin(x / 2), cos(x)).angles) == 1


def test_structural_zeros_and_constants_cost_nothing() -> None:
    program = lowered(x - x, 0 * y, sp.Integer(1), sin(sp.pi / 6))
    assert program.operations() == {}
    assert [n.op for n in program.roots] == ["const"] * 4


def test_local_identities() -> None:
    graph = Graph()
    a, b = graph.input("a"), graph.input("b")
    assert graph.neg(graph.neg(a)) is a
    assert graph.product([graph.neg(a), graph.neg(b)]) is graph.product([b, a])
    assert graph.sum([a, graph.neg(a)]) is graph.const(0)
    assert graph.sum([graph.neg(a), graph.neg(b)]) is graph.neg(graph.sum([a, b]))
    assert graph.select(graph.node("true"), a, b) is a
    assert graph.product([a, graph.const(0)]) is graph.const(0)


@pytest.mark.parametrize(
    ("robot", "function", "limit"),
    [
        ("planar_2r", "fk", {"add": 3, "mul": 8, "sub": 1, "sincos": 2}),
        ("planar_2r", "jacobian", {"add": 3, "mul": 8, "sub": 1, "sincos": 2}),
        ("spherical_wrist", "fk", {"add": 2, "mul": 12, "sub": 2, "sincos": 3}),
    ],
)
def test_operation_counts(robot: str, function: str, limit: dict[str, int]) -> None:
    d = importlib.import_module(f"closedform.derivations.{robot}").d
    counts = lower(d[function], d).operations()
    assert sum(counts.values()) <= sum(limit.values()), counts


def test_a_function_that_cannot_be_lowered_says_so() -> None:
    with pytest.raises(TypeError, match="gamma"):
        lowered(sp.gamma(x))
    with pytest.raises(TypeError, match="sine of"):
        lowered(sin(x * y))


def test_long_products_stay_linear() -> None:
    """Sharing does not blow up: a sum of many products in well under a second."""
    terms = [sin(a) * b * c * k for k, (a, b, c) in enumerate([(x, y, z), (y, z, x)] * 20, 1)]
    program = lowered(sum(terms), sum(terms[::2]))
    assert len(list(reachable(program.roots))) < 200


def jacobian_of_general_twists(n: int) -> Function:
    """The spatial Jacobian of n joints with arbitrary axes, frame by frame."""
    program = Program()
    q, dimensions, columns, T = [], [], [], sp.eye(4)
    for i in range(n):
        angle = real(f"q{i}")
        w, v = (sp.Matrix([real(f"{name}{i}{axis}") for axis in "xyz"]) for name in "wv")
        spun = program.matrix(f"w{i}", T[:3, :3] * w)
        moved = program.matrix(f"v{i}", T[:3, :3] * v + T[:3, 3].cross(spun))
        motion = program.matrix(f"E{i}", exponential(sp.Matrix([*v, *w]), angle))
        T = program.matrix(f"T{i}", T * motion)
        q.append(angle)
        dimensions += [*v, *w]
        columns.append(sp.Matrix([*moved, *spun]))
    inputs = (array("q", sp.Matrix(q)), array("axes", sp.Matrix(dimensions)))
    output = array("J", sp.Matrix.hstack(*columns))
    return Function("jacobian", "", inputs, (output,), body=tuple(program.body))


def test_long_chains_stay_linear() -> None:
    """Each joint of a chain costs the same number of operations, and no frame is multiplied out."""
    operations = [
        sum(lower(jacobian_of_general_twists(n), EMPTY).operations().values()) for n in (6, 12, 18)
    ]
    first, second = operations[1] - operations[0], operations[2] - operations[1]
    assert first == second
    assert second <= 6 * 180


def test_an_angle_behind_a_name_is_wrapped() -> None:
    """A sum with a named arctangent needs the wrap, just as one with the arctangent itself."""
    d = Derivation("test", "", Paper("", "", ()), "")
    p = Program()
    a, b = p.let("a", sp.atan2(y, x)), p.let("b", sp.atan2(z, x))
    entries = [a + b, a - b, a + 2 * b, 2 * a + 3 * b, sp.sin(a), x * a, a + z]
    program = lower(d.function("f", "", {"q": SYMBOLS}, {"y": entries}, program=p), d)
    for values in ((-1.0, 0.1, 0.2), (-1.0, -0.1, -0.2), (-2.0, 1e-9, 1e-9), (-1.0, 0.3, -9.0)):
        got = run(program, dict(zip("xyz", values, strict=True)))
        u, v, w = values
        t, s = math.atan2(v, u), math.atan2(w, u)
        wanted = [t + s, t - s, t + 2 * s, 2 * t + 3 * s, math.sin(t), u * t, t + w]
        for k, (found, exact) in enumerate(zip(got, wanted, strict=True)):
            if k in (4, 5):
                assert found == pytest.approx(exact)
            else:
                assert -math.pi < found <= math.pi * (1 + 1e-15)
                assert math.sin(found - exact) == pytest.approx(0, abs=1e-12)
                assert math.cos(found - exact) == pytest.approx(1)


def test_a_condition_on_what_was_chosen_is_refused_before_sympy_drops_a_part_of_it() -> None:
    chosen = choose(sp.Symbol("flag"), x, y)
    assert not sp.Piecewise((1, chosen >= 0), (-1, True)).has(y)  # what SymPy does
    for refused in (lambda: choose(chosen >= 0, 1, 2), lambda: sign_of(chosen)):
        with pytest.raises(ValueError, match="this condition contains a choice"):
            refused()
    assert sign_of(sp.Integer(3)) == 1 and sign_of(sp.Integer(-3)) == -1


def test_an_arctangent_of_constants_is_a_constant() -> None:
    """A turn that is zero in the common case costs no arctangent there."""
    graph = Graph()
    turn = graph.atan2(graph.input("x"), graph.const(1))
    assert same(graph, turn, (graph.const(0), graph.const(1))) is graph.const(0)


def test_a_quotient_by_a_power_of_two_counts_as_the_product_that_is_printed() -> None:
    assert lowered(x * y / 2).operations() == {"mul": 2}
    assert lowered(x * y / 3).operations() == {"div": 1, "mul": 1}
