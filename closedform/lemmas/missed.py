"""By how much the hand of a loop may miss its rods where the loop nearly closes.

The forward map and the inverse decide about the edges of the workspace by different lengths, and
both tolerate what rounding does to them.  A leg tolerates half of the size, the sum of all lengths,
in units of the tolerance.  The forward map has to tolerate less, so that its hand is within reach
of every leg; an eighth of the size is left for rounding.  The Jacobians and the skeleton compute
the hand once more, rounded in another order; they tolerate more again, so that they see every
assembly mode that the forward map sees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.model.functions import Bound, Statement, Vanishes

SHARE = sp.Rational(3, 8)
"""The part of the size by which the hand may miss a rod."""
MOVED = SHARE / 4
"""The same where the size counts joints that slide.  Their sum is at most that of the coordinates
of the hand and three sums of lengths; so the size of the inverse, which counts the coordinates
instead, may be a quarter of that of the forward map."""

LOOSER = sp.Rational(5, 4)
"""What functions of the hand tolerate, as a multiple of what the forward map does."""


def loosened(body: Sequence[Statement]) -> list[Statement]:
    """The forward map with the larger tolerances that functions of the hand have.

    A flag that has the scale of a bound changes with it.
    """
    scales = {s.scale for s in body if isinstance(s, Bound)}
    return [
        replace(s, scale=s.scale * LOOSER)
        if isinstance(s, Bound | Vanishes) and s.scale in scales
        else s
        for s in body
    ]


__all__ = ["MOVED", "SHARE", "loosened"]
