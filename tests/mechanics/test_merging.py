"""Sines and cosines of sums of angles: the same sums, and never longer ones."""

import pytest
import sympy as sp

from closedform.algebra.normal_form import equal
from closedform.algebra.operations import operations
from closedform.mechanics.frames import merge_angles
from closedform.mechanics.merging import with_merged_angles

a, b, c, x, y = sp.symbols("a b c x y", real=True)
s, k = sp.sin, sp.cos

SUMS = {
    "a product": (x * k(a) * k(b) - x * s(a) * s(b), x * k(a + b)),
    "a difference": (s(a) * k(b) - k(a) * s(b), s(a - b)),
    "three angles": (
        sp.expand((k(a) * k(b) - s(a) * s(b)) * k(c) - (s(a) * k(b) + k(a) * s(b)) * s(c)),
        k(a + b + c),
    ),
    "a square": (sp.expand((k(a) * k(b) - s(a) * s(b)) ** 2 * y), y * k(a + b) ** 2),
    "twists in numbers": (
        sp.expand(k(sp.Rational(7, 10)) * (k(a) * k(b) + s(a) * s(b)) / 3 + y),
        k(sp.Rational(7, 10)) * k(a - b) / 3 + y,
    ),
    "nothing to merge": (x * k(a) * s(b) + y * k(c), x * k(a) * s(b) + y * k(c)),
    "nothing": (sp.S.Zero, sp.S.Zero),
}


@pytest.mark.parametrize("name", SUMS)
def test_products_of_two_angles_become_sums(name: str) -> None:
    value, expected = SUMS[name]
    assert with_merged_angles(sp.expand(value)) == merge_angles(value) == expected


def test_a_sum_with_roots_of_angles_is_left_to_sympy() -> None:
    value = sp.sqrt(1 + k(a) ** 2) * (k(a) * k(b) - s(a) * s(b))
    assert with_merged_angles(sp.expand(value)) is None
    assert equal(merge_angles(value), value)


def test_a_long_sum_is_merged_without_becoming_longer() -> None:
    lengths = sp.symbols("l1:9", real=True)
    turns = [f(a) * g(b) * h(c) for f in (s, k) for g in (s, k) for h in (s, k)]
    value = sp.expand(sum((n % 3 + 1) * lengths[n] * t for n, t in enumerate(turns)))
    value += sp.expand(x * k(a + b) * k(c) - x * s(a + b) * s(c))
    merged = merge_angles(value)
    assert equal(merged, value)
    assert merged.has(k(a + b + c))
    assert operations(merged) < operations(value)
