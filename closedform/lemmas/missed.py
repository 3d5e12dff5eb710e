"""How far the hand of a loop may miss its rods where the loop nearly closes.

The forward map and the inverse use different lengths to decide where the workspace ends, and both
tolerate rounding errors.  A leg tolerates half of the size, the sum of all lengths, in units of the
tolerance.  The forward map has to tolerate less, so that its hand is within reach of every leg; an
eighth of the size remains for rounding.
"""

from __future__ import annotations

import sympy as sp

from closedform.model.tolerances import HALF_DIGITS

SHARE = sp.Rational(3, 8)
"""The part of the size by which the hand may miss a rod."""
MOVED = SHARE / 4
"""The same if the size counts joints that slide.

Their sum is at most the sum of the coordinates of the hand and three times the sum of all lengths.
So the size of the inverse, which counts the coordinates instead, may be a quarter of that of the
forward map.
"""
LEAST = 4 * HALF_DIGITS
"""The part of a size below which a length has lost half of its digits."""
MOST_LOST = LEAST**-2
"""The most that two such losses amount to."""


def lost(size: sp.Expr, length: sp.Expr) -> sp.Expr:
    """How much more than ``size`` rounding moves what is divided by a ``length``."""
    return size / (length + size * LEAST)


def missed_circles(apart: sp.Expr, radii: tuple[sp.Expr, sp.Expr]) -> sp.Expr:
    """The length by which two circles do not meet, whose centres are ``apart``."""
    first, second = radii
    return sp.Max(0, apart - first - second, sp.Abs(first - second) - apart)


__all__ = ["MOST_LOST", "MOVED", "SHARE", "lost", "missed_circles"]
