"""Ball evaluation, compared with mpmath, and at points where floating point fails."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

import flint
import mpmath
import pytest
import sympy as sp
from flint import arb
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import acos, asin, atan2, cos, pi, sin, sqrt, tan

from closedform.algebra.balls import Evaluator, Undetermined, evaluate, to_float

x, y, t = sp.symbols("x y t", real=True)


@pytest.fixture(autouse=True, scope="module")
def precise_comparisons() -> Iterator[None]:
    """The balls are tighter than Arb's default of 53 bits; arithmetic on them must be so too."""
    with flint.ctx.workprec(300):
        yield


EXPRESSIONS = {
    "polynomial": x**3 * y - 2 * x + y / 3,
    "trigonometric": sin(x + t) * cos(2 * y) - tan(t / 3) + sp.cot(y + 2),
    "reciprocal": sp.sec(t) + sp.csc(t + 2) + 1 / (2 + x),
    "inverse": atan2(y, x) + asin(x / 4) - acos(y / 4) + sp.atan(t),
    "roots": sqrt(x**2 + y**2) ** 3 + 1 / sqrt(5 + x) + (4 + sqrt(y**2 + 1)) ** sp.Rational(-3, 2),
    "order": sp.Max(x, y, t) - sp.Min(x, y) + sp.Abs(t) + sp.sign(t - 5),
    "cases": sp.Piecewise((x, (x > 0) & (y > 0)), (y, sp.Or(x > y, t < 0)), (t, True)),
}
HIDDEN_ZERO = sqrt(x) * sqrt(y) - sqrt(x * y)
NUMBERS = st.floats(-1.5, 1.5).filter(lambda v: abs(v) > 1e-3)


@pytest.mark.parametrize("name", EXPRESSIONS)
@settings(max_examples=40, deadline=None)
@given(st.tuples(NUMBERS, NUMBERS, NUMBERS))
def test_encloses_what_mpmath_computes(name: str, point: tuple[float, ...]) -> None:
    evaluator = Evaluator((x, y, t), [EXPRESSIONS[name]])
    (ball,) = evaluator(point)
    with mpmath.workdps(60):
        expected = sp.lambdify((x, y, t), EXPRESSIONS[name], "mpmath")(*map(mpmath.mpf, point))
        assert abs(arb(mpmath.nstr(expected, 50)) - ball) < arb("1e-24")
    assert ball.rad() < arb(2) ** -76


def test_values_of_every_kind() -> None:
    values = {x: Fraction(1, 3), y: 0.1, t: sp.pi / 3}
    third, tenth, cosine = evaluate([x, y - sp.Rational(1, 10), cos(t)], values)
    assert third.overlaps(arb(1) / 3)
    assert to_float(tenth) == float(Fraction(0.1) - Fraction(1, 10)) != 0
    assert cosine == arb(0.5)
    assert evaluate([x + y], {x: sp.Float(0.5), y: sqrt(2)})[0].overlaps(arb(2).sqrt() + 0.5)


@pytest.mark.parametrize(
    ("e", "point", "expected"),
    [
        (sin(t), {t: pi}, 0),
        (sin(2 * t + pi), {t: pi / 2}, 0),
        (atan2(sin(t), -1), {t: pi}, "pi"),
        (atan2(y, x), {x: -1, y: 0}, "pi"),
        (atan2(y, x), {x: -1, y: -1e-300}, "-pi"),
        (atan2(y, x), {x: 1, y: 0}, 0),
        (sqrt(x), {x: 0}, 0),
        (acos(x), {x: 1}, 0),
        (sp.sign(x), {x: 0}, 0),
        (x**0 + sp.Abs(y), {x: 0, y: -3}, 4),
        (sp.Piecewise((1 / x, x > 0), (sqrt(x - 1), x > 5), (7, True)), {x: 0}, 7),
        (sp.Piecewise((1, x >= sp.Rational(1, 2)), (2, True)), {x: 0.5}, 1),
    ],
)
def test_exact_points(e: sp.Expr, point: dict[sp.Symbol, object], expected: int | str) -> None:
    (ball,) = evaluate([e], point)
    if isinstance(expected, str):
        assert to_float(ball) == math.copysign(math.pi, -1 if expected[0] == "-" else 1)
    else:
        assert ball == arb(expected)


@pytest.mark.parametrize(
    ("e", "point"),
    [
        (sqrt(x), {x: -1}),
        (1 / x, {x: 0}),
        (acos(x), {x: 1 + 2.0**-50}),
        (atan2(y, x), {x: 0, y: 0}),
        (tan(t), {t: pi / 2}),
        (sp.Piecewise((x, x > 0)), {x: 0}),
        (cos(sqrt(x)) + 1, {x: -1}),
    ],
)
def test_undefined_is_nan_and_does_not_disturb_other_entries(
    e: sp.Expr, point: dict[sp.Symbol, object]
) -> None:
    undefined, other = evaluate([e, sp.Integer(3)], point)
    assert undefined.is_nan() and other == arb(3)


def test_cancellation_raises_the_precision() -> None:
    (ball,) = evaluate([1 - cos(x)], {x: 1e-30})
    assert ball.overlaps(arb(1e-30) ** 2 / 2) or abs(ball / (arb(1e-30) ** 2 / 2) - 1) < 1e-20
    lost, kept = (evaluate([sqrt(x**2 + 1) - x], {x: 2.0**60}, rel_bits=b)[0] for b in (80, 250))
    assert lost.rad() < arb(2) ** (61 - 80) and lost.overlaps(kept)
    assert abs(kept * arb(2) ** 61 - 1) < arb(2) ** -100


def test_exact_zero_that_looks_inexact_is_tight() -> None:
    (ball,) = evaluate([HIDDEN_ZERO], {x: 2, y: 3})
    assert not ball.is_exact() and ball.contains(0) and ball.rad() < arb(2) ** -78


def test_undecidable_comparison_is_reported() -> None:
    point = {x: 2, y: 3}
    with pytest.raises(Undetermined, match="x = 2, y = 3"):
        evaluate([sp.Piecewise((1, HIDDEN_ZERO > 0), (2, True))], point, max_bits=500)
    with pytest.raises(Undetermined, match="500 bits"):
        evaluate([atan2(HIDDEN_ZERO, -1)], point, max_bits=500)
    decided = sp.Piecewise((1, (HIDDEN_ZERO > 0) & (x < 0)), (2, True))
    assert evaluate([decided], point, max_bits=500) == [arb(2)]


def test_errors_name_what_is_wrong() -> None:
    with pytest.raises(KeyError, match="y"):
        evaluate([x + y], {x: 1})
    with pytest.raises(TypeError, match="float"):
        evaluate([x + sp.Float(0.5)], {x: 1})
    with pytest.raises(ValueError, match="2 values"):
        Evaluator((x, y), [x])((1,))
    with pytest.raises(TypeError, match="gamma"):
        evaluate([sp.gamma(x)], {x: 1})


def test_matrix_is_flattened_by_rows() -> None:
    assert [to_float(v) for v in evaluate(sp.Matrix([[x, 2], [3, x + 3]]), {x: 1})] == [1, 2, 3, 4]


def test_one_evaluator_many_points() -> None:
    evaluator = Evaluator((x,), [sp.Piecewise((sqrt(x), x >= 0), (-1, True)), x**2])
    assert [to_float(evaluator([v])[0]) for v in (4, -4, 0, 9, -1)] == [2, -1, 0, 3, -1]


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_to_float_round_trips(value: float) -> None:
    assert to_float(arb(value)) == value


def test_to_float_rounds_to_nearest_once() -> None:
    assert to_float(arb(1) / 3) == 1 / 3
    half_way = arb(1) + arb(2) ** -53
    assert to_float(half_way) == 1.0
    assert math.isnan(to_float(arb("nan")))
