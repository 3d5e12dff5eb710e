"""Counterexamples: simple, exact, within the assumptions, the same on every run."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
import sympy as sp
from sympy import Rational, cos, pi, sin, sqrt

from closedform import Identity
from closedform.algebra.counterexample import find_counterexample

x, y, theta = sp.symbols("x y theta", real=True)
l1, l2 = sp.symbols("l1 l2", positive=True)


def test_none_for_an_identity() -> None:
    assert find_counterexample(sin(theta) ** 2 + cos(theta) ** 2 - 1) is None


def test_points_are_simple_and_respect_assumptions() -> None:
    found = find_counterexample(l1 * cos(theta) - l2 * sin(theta))
    assert found is not None
    assert found.point == {l1: 1, l2: 1, theta: 0}
    assert found.describe() == "l1 = 1, l2 = 1, theta = 0: difference = 1"


@pytest.mark.parametrize("assumption", ["positive", "negative", "nonnegative", "integer"])
def test_assumptions(assumption: str) -> None:
    s = sp.Symbol("s", real=True, **{assumption: True})
    found = find_counterexample(s - 1)
    assert found is not None and getattr(found.point[s], f"is_{assumption}")


def test_equal_lengths_and_zero_angles_do_not_hide_a_difference() -> None:
    assert find_counterexample((l1 - l2) * sin(theta) * x) is not None
    special = sin(theta) * sin(2 * theta) * sin(3 * theta) * sin(4 * theta) * x * (x**2 - 1)
    assert find_counterexample(special * (x**2 - 4) * (x**2 - 9)) is not None


def test_conditions_hold_at_the_point() -> None:
    found = find_counterexample(x - y, conditions=[x > 2, y <= -1, sp.Ne(y, -1)])
    assert found is not None
    assert found.point[x] > 2 and found.point[y] < -1
    assert find_counterexample(x, conditions=[x**2 + 1 <= 0]) is None


def test_points_outside_the_domain_are_no_counterexamples() -> None:
    found = find_counterexample(sqrt(x - 2) - 1 / (x - 3) + 5)
    assert found is not None and found.point[x] >= 2 and found.point[x] != 3


def test_entry_of_a_matrix() -> None:
    found = find_counterexample(sp.Matrix([[0, x - x], [sin(theta) ** 2, 0]]))
    assert found is not None and found.entry == 2 and "entry 2" in found.describe()


def test_a_tiny_difference_is_told_from_zero() -> None:
    found = find_counterexample(sqrt(2) - Rational(str(sp.sqrt(2).n(60))))
    assert found is not None and found.point == {} and not found.ball.contains(0)


def test_exact_angles_give_exact_values() -> None:
    found = find_counterexample(sp.atan2(sin(2 * theta), -1) - pi)
    assert found is not None and found.point[theta] != 0


def test_same_point_for_every_hash_seed() -> None:
    program = (
        "import sympy as sp; from closedform.algebra.counterexample import find_counterexample\n"
        "v = sp.symbols('u v w z', real=True)\n"
        "f = sp.prod(v) * sp.prod([a**2 - k for a in v for k in (1, 4, 9)])\n"
        "print(find_counterexample(f).describe())"
    )
    runs = {
        subprocess.run(
            [sys.executable, "-c", program],
            env={**os.environ, "PYTHONHASHSEED": seed},
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        for seed in ("0", "1")
    }
    assert len(runs) == 1


def test_a_symbol_that_cancels_in_the_difference_has_a_value() -> None:
    verdict = Identity(x + y, x + 2 * y).judge()
    assert verdict.kind == "refuted"
    (point,) = (part for part in verdict.evidence if isinstance(part, dict))
    assert point.keys() == {x, y} and point[y] != 0
