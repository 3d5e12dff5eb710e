"""The reach of an arm whose lengths are numbers, on which the tolerances are based."""

import numpy as np
import pytest
import sympy as sp
from sympy import Rational, cos, sin, symbols

from closedform.mechanics.lengths import reach_in_numbers

a, b, c, d, L = symbols("a b c d L", real=True)


def test_links_that_follow_each_other_add_up() -> None:
    elbow = [Rational(2, 5) * f(a) + Rational(7, 20) * f(a + b) for f in (cos, sin)]
    assert reach_in_numbers(elbow) == Rational(3, 4)


def test_a_link_that_appears_in_several_terms_counts_once() -> None:
    """As that of an upper arm whose rotation has two products in each entry."""
    turned = Rational(3, 10) * (cos(a) * cos(b) * cos(c) - sin(a) * sin(c)) + Rational(1, 10)
    assert reach_in_numbers([turned]) == Rational(2, 5)


def test_it_is_rounded_up_to_three_digits() -> None:
    assert reach_in_numbers([Rational(12661, 10**7) * sin(a)]) == Rational(127, 10**5)
    assert reach_in_numbers([1234 * sin(a)]) == 1240


def test_parameters_and_slides_do_not_count() -> None:
    assert reach_in_numbers([L * cos(a) + d * sin(b), sp.S.Zero]) == 0
    assert reach_in_numbers([L * cos(a) + 2 * d + 3 * sin(b)]) == 3


@pytest.mark.parametrize("seed", range(12))
def test_no_posture_reaches_farther(seed: int) -> None:
    """The other route: many random postures of a chain of rotations."""
    rng = np.random.default_rng(seed)
    place, at = sp.zeros(3, 1), sp.eye(3)
    for angle in (a, b, c, d):
        tilt = Rational(int(rng.integers(-10, 10)), 10)
        at *= sp.rot_axis3(-angle) * sp.rot_axis1(-tilt).applyfunc(sp.nsimplify)
        place += at * sp.Matrix([Rational(int(n), 100) for n in rng.integers(-40, 40, 3)])
    found = sp.lambdify((a, b, c, d), list(place), "numpy")(*rng.uniform(-4, 4, (4, 200_000)))
    farthest = np.max(np.abs(np.array(found)))
    reach = float(reach_in_numbers(place))
    assert farthest <= reach * (1 + 1e-4) and reach < 1.15 * farthest
