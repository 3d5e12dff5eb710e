"""Products of polynomials in sines and cosines, found again after they were multiplied out."""

from itertools import pairwise

import numpy as np
import pytest
import sympy as sp
from sympy import cos, sin

from closedform.algebra.circles import factored_on_circles, shortest_on_circles
from closedform.mechanics.arm import from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.model.functions import real

a, b, c, h, q2, q3, q4, k = (real(n) for n in ("a", "b", "c", "h", "q2", "q3", "q4", "k"))


def on_circles(value: sp.Expr) -> sp.Expr:
    """The normal form without squares of sines, in which products do not show."""
    value = sp.expand(value, trig=True)
    for angle in (q2, q3, q4, k):
        value = sp.rem(value, sin(angle) ** 2 + cos(angle) ** 2 - 1, sin(angle))
    return sp.expand(value)


def parts(value: sp.Expr) -> list[sp.Expr]:
    bases = [f.as_base_exp() for f in sp.Mul.make_args(value)]
    return [base for base, power in bases for _ in range(int(power)) if not base.is_number]


@pytest.mark.parametrize(
    ("product", "least"),
    [
        (
            (a * sin(q3) - b * sin(k) * cos(q3))
            * (c + a * cos(q2 + q3) + b * sin(k) * sin(q2 + q3)),
            2,
        ),
        ((cos(q2) - cos(q3)) * (a + sin(q2) * sin(q3)), 2),
        ((1 - cos(q2)) * (1 + cos(q3)) * (1 + sin(q2)), 3),
        ((a * cos(q2) + b) ** 2 * (c + sin(q2 - q3)), 3),
        (sin(q2 + q3 + q4) * (a + b * cos(q4)), 2),
        ((1 + cos(q2)) ** 2 * (a + b * sin(q2)), 3),
    ],
)  # fmt: skip
def test_factors_are_found_again(product: sp.Expr, least: int) -> None:
    """The product in the normal form is one sum, which no factoring of polynomials splits."""
    hidden = on_circles(product)
    found = factored_on_circles(hidden)
    assert hidden.is_Add and len(parts(found)) >= least
    symbols = sorted(hidden.free_symbols, key=str)
    rows = np.random.default_rng(1).uniform(-3, 3, (20, len(symbols)))
    for row in rows:
        values = dict(zip(symbols, row, strict=True))
        assert float((found - product).subs(values)) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("sum_", [a + b * cos(q2), a * sin(q2) + b * cos(q3) + c, 1 - cos(q2) + a])
def test_what_is_no_product_stays(sum_: sp.Expr) -> None:
    assert factored_on_circles(sum_) == sum_


def test_other_angles_and_other_functions_stay() -> None:
    for value in (a + q2 * cos(q2), 1 / a + cos(q2), a + cos(2 * q2 + 1), sp.sqrt(a) + cos(q2)):
        assert factored_on_circles(value) == value


def test_squares_are_those_of_the_shorter_form() -> None:
    assert shortest_on_circles(a - a * cos(k) ** 2 + b * cos(k)) == a * sin(k) ** 2 + b * cos(k)
    assert shortest_on_circles(a - a * sin(k) ** 4 - 2 * a * cos(k) ** 2) == -a * cos(k) ** 4


def test_an_arm_of_oblique_twists_is_singular_at_its_elbow_its_shoulder_or_its_wrist() -> None:
    """They are factors for right angles; with parameters the first two were one long sum."""
    d = Derivation("arm", "Arm", Paper("toy", "Toys", ("A.",)), "An arm.")
    a1, a2, a3, d4, k1, k3, k4, k5 = (
        d.parameter(n, value=1, unit="rad" if n[0] == "k" else "m", meaning=n, source="the test")
        for n in ("a1", "a2", "a3", "d4", "k1", "k3", "k4", "k5")
    )
    q = [d.joint(f"t{i}") for i in range(1, 7)]
    rows = [(a1, k1, 0), (a2, 0, 0), (a3, k3, 0), (0, k4, d4), (0, k5, 0), (0, 0, 0)]
    from_dh(d, [(*row, joint) for row, joint in zip(rows, q, strict=True)]).export(d)
    found = next(f for f in d.functions if f.name == "singularities")
    factors = [e for array in found.outputs for e in array.entries]
    t2, t3, t5 = q[1], q[2], q[4]
    elbow = a3 * sin(t3) - d4 * sin(k3) * cos(t3)
    shoulder = a1 + a2 * cos(t2) + a3 * cos(t2 + t3) + d4 * sin(k3) * sin(t2 + t3)
    assert {f for pair in ((e, -e) for e in factors) for f in pair} >= {elbow, shoulder, sin(t5)}
    assert len(factors) == 3 and all(first != second for first, second in pairwise(factors))
