"""By how much the hand of a loop may miss its rods where the loop nearly closes.

The forward map and the inverse decide about the edges of the workspace by different lengths, and
both tolerate what rounding does to them.  A leg tolerates half of the size, the sum of all lengths,
in units of the tolerance.  The forward map has to tolerate less, so that its hand is within reach
of every leg; an eighth of the size is left for rounding.
"""

from __future__ import annotations

import sympy as sp

SHARE = sp.Rational(3, 8)
"""The part of the size by which the hand may miss a rod."""
MOVED = SHARE / 4
"""The same where the size counts joints that slide.  Their sum is at most that of the coordinates
of the hand and three sums of lengths; so the size of the inverse, which counts the coordinates
instead, may be a quarter of that of the forward map."""

__all__ = ["MOVED", "SHARE"]
