"""The factors of integers that are found quickly."""

from __future__ import annotations

from flint import fmpz

SMOOTH = 20
"""Prime factors of at most this many bits are always found."""
SHORT = 90
"""Numbers of at most this many bits are factored, which takes milliseconds."""


def smooth_factors(number: fmpz) -> tuple[list[tuple[fmpz, int]], fmpz]:
    """Short prime factors with their powers, and what is left of the number."""
    found = [(p, k) for p, k in number.factor_smooth(SMOOTH) if p.bit_length() <= SMOOTH]
    for prime, power in found:
        number //= prime**power
    return found, number


def long_factors(number: fmpz) -> list[tuple[fmpz, int]]:
    """Factors of a number without short ones, with their powers; a long number is one factor.

    Factoring a number of a hundred digits can take very long, and lengths in decimals lead to such
    numbers.
    """
    return number.factor() if number.bit_length() <= SHORT else [(number, 1)]


__all__ = ["long_factors", "smooth_factors"]
