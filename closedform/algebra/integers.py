"""The factors of integers that are found quickly."""

from __future__ import annotations

from flint import fmpz

SMOOTH = 20
"""Prime factors of at most this many bits are always found."""
SHORT = 90
"""Numbers of at most this many bits are factored, which takes milliseconds."""


def quick_factors(number: fmpz) -> tuple[list[tuple[fmpz, int]], fmpz]:
    """Factors with their powers, primes or one square, and what is left: 1 or a long number.

    To factor a number of a hundred digits may take any time; lengths in decimals lead to such.
    """
    found = [(p, k) for p, k in number.factor_smooth(SMOOTH) if p.bit_length() <= SMOOTH]
    for prime, power in found:
        number //= prime**power
    if number.is_square():
        root = number.isqrt()
        return ([*found, (root, 2)] if root != 1 else found), fmpz(1)
    if number.bit_length() > SHORT:
        return found, number
    return [*found, *number.factor()], fmpz(1)


__all__ = ["quick_factors"]
