"""Balls over arrays hold what Arb finds, or say that they do not know."""

import math

import flint
import numpy as np
import pytest
import sympy as sp
from flint import arb, ctx

from closedform.algebra.balls import Undetermined, to_float
from closedform.check.rows import WIDE, RowEvaluator, crosses, inaccurate

x, y, z = sp.symbols("x y z", real=True)
EXPRESSIONS = {
    "sum": x + y + z / 3,
    "cancels": (x + y) ** 2 - x**2 - 2 * x * y - y**2,
    "quotient": (x - y) / (x + z),
    "product": (x - y / 3 - 2 * z / 3) * (x / 3 + y / 3 - 2 * z / 3) * (x + y + z),
    "exact factors": -x * y + 2 * x * z - 4 * y * z - z,
    "inverse square": 1 / (x * y) ** 2,
    "root": sp.sqrt(x**2 + y**2 - z),
    "inverse root": (x - y) ** sp.Rational(-3, 2),
    "root of a root": sp.Abs(x - y) ** sp.Rational(-3, 4) + sp.sqrt(sp.sqrt(sp.Abs(z))),
    "circle": sp.cos(x + y) ** 2 + sp.sin(x + y) ** 2,
    "turns": sp.sin(x) * sp.cos(y - sp.pi / 3) + sp.tan(z),
    "reciprocals": sp.sec(x) + sp.csc(y) + sp.cot(z),
    "direction": sp.atan2(sp.sin(x) - y, x * z),
    "on the cut": sp.atan2(x - x * y / y, -sp.Abs(z)),
    "arcs": sp.asin(sp.sin(x) * sp.cos(y)) + sp.acos(x / (1 + sp.Abs(x))) + sp.atan(z),
    "extremes": sp.Max(x, y * z, 1) - sp.Min(x, y) + sp.Abs(z) * sp.sign(x),
    "choice": sp.Piecewise(
        (x, sp.And(x > y, z <= 1)), (y, sp.Or(y > z, sp.Ne(x, z))), (z**2, True)
    ),
    "of a difference": sp.Piecewise((1, sp.sin(x) ** 2 + sp.cos(x) ** 2 > 1), (2, True)) * y,
    "undefined": sp.sqrt(x) + sp.sqrt(y),
}


def points() -> np.ndarray:
    """Ordinary, huge, tiny, equal and vanishing values."""
    rng = np.random.default_rng(0)
    special = (0.0, -0.0, 1.0, -1.0, np.pi, np.pi / 2, 1e-300, 5e-324, 1e-17, 1e15, 1e300)
    return np.concatenate(
        [
            rng.uniform(-4, 4, (40, 3)),
            rng.choice(special, (60, 3)),
            rng.uniform(-2, 2, (20, 1)) * (1 + rng.choice((0, 1e-16, 1e-9), (20, 3))),
        ]
    )


def of_wide(value) -> arb:
    """A number of the widest type, to the last bit."""
    fraction, exponent = np.frexp(WIDE(value))
    return arb(int(np.ldexp(fraction, 120))) * arb(2) ** (int(exponent) - 120)


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_balls_hold_what_arb_finds(name: str) -> None:
    evaluator, rows = RowEvaluator((x, y, z), [EXPRESSIONS[name]]), points()
    middle, radius = evaluator.balls(rows)
    known = np.isfinite(radius[:, 0])
    for k in np.flatnonzero(known):
        (exact,) = evaluator.exactly(rows[k])
        with flint.ctx.workprec(400):
            away = abs(of_wide(middle[k, 0]) - exact.mid())
            assert exact.is_finite() and away <= of_wide(radius[k, 0]) + exact.rad(), rows[k]
    if np.finfo(WIDE).nmant > 60:
        ordinary = known[:40]
        assert ordinary.mean() > 0.1 or name in ("on the cut", "of a difference"), name


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_values_are_the_midpoints_of_the_balls(name: str) -> None:
    evaluator, rows = RowEvaluator((x, y, z), [EXPRESSIONS[name], z]), points()
    np.testing.assert_array_equal(evaluator.values(rows), evaluator.balls(rows)[0])


@pytest.mark.parametrize("name", EXPRESSIONS)
def test_a_symbol_with_one_value_is_computed_once(name: str) -> None:
    """The balls with two constant columns enclose the same values; nothing more is open."""
    rows = points()
    rows[:, 1:] = rows[7, 1:]
    steady = RowEvaluator((x, y, z), [EXPRESSIONS[name]], steady=[y, z])
    middle, radius = steady.balls(rows)
    for k, row in enumerate(rows):
        alone = RowEvaluator((x, y, z), [EXPRESSIONS[name]]).balls(row[None])
        assert np.isfinite(radius[k]) == np.isfinite(alone[1][0])
        if np.isfinite(radius[k]):
            assert abs(middle[k] - alone[0][0]) <= radius[k] + alone[1][0]


def test_what_is_open_is_settled_in_arb() -> None:
    """Values beside a limit by less than the rounding of the widest type, on either side of it."""
    evaluator = RowEvaluator((x, y), [x + y - x])
    rows = np.array([[1e30, 1e-3], [1e30, -1e-3], [0.5, 2.0]])
    np.testing.assert_array_equal(
        evaluator.settled(rows, crosses(0.0)).astype(float)[:, 0] > 0, [True, False, True]
    )
    sine = RowEvaluator((x,), [sp.sin(x) ** 2 + sp.cos(x) ** 2 - 1 + x / 2**90])
    rows = np.array([[3.0], [-3.0]])
    found = sine.settled(rows, inaccurate(bits=40)).astype(float)
    np.testing.assert_allclose(found, rows / 2.0**90, rtol=1e-8)
    (value,) = sine.exactly(rows[0])
    assert to_float(value) == found[0, 0]


def test_what_no_precision_settles_is_an_error() -> None:
    evaluator = RowEvaluator(
        (x,), [sp.Piecewise((1, sp.sin(x) ** 2 > 1 - sp.cos(x) ** 2), (0, True))]
    )
    with pytest.raises(Undetermined):
        evaluator.settled(np.array([[1.0]]), crosses(0.5))


def test_a_number_beyond_all_doubles_is_infinite() -> None:
    with ctx.workprec(3000):
        huge = (arb(2) ** 1100 + 1) ** 2
    assert to_float(huge) == math.inf
    assert to_float(-huge) == -math.inf


def test_a_divisor_that_inputs_off_by_a_rounding_may_annul_leaves_all_open() -> None:
    """The ball of the value itself is small, because the inputs are exact."""
    evaluator = RowEvaluator((x,), [(1 + sp.cos(x)) / sp.sin(x), 1 / (2 + sp.sin(x))])
    row = np.array([[-math.pi]])
    _, radius = evaluator.balls(row)
    assert np.isfinite(radius).all()
    assert evaluator.open_around(row, 2.0**-52).tolist() == [[True, False]]
    assert not evaluator.open_around(row + 1e-3, 2.0**-52).any()
