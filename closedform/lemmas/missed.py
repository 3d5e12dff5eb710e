"""How far the hand of a loop may miss its rods where the loop nearly closes.

The forward map and the inverse use different lengths to decide where the workspace ends, and both
tolerate rounding errors.  A leg tolerates half of the size, the sum of all lengths, in units of the
tolerance.  The forward map has to tolerate less, so that its hand is within reach of every leg; an
eighth of the size remains for rounding.  The Jacobians and the skeleton compute the hand once more,
with other rounding errors.  They tolerate more than the forward map, so that they find every
assembly mode that it finds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.model.functions import Bound, Statement, Vanishes

SHARE = sp.Rational(3, 8)
"""The part of the size by which the hand may miss a rod."""
MOVED = SHARE / 4
"""The same if the size counts joints that slide.

Their sum is at most the sum of the coordinates of the hand and three times the sum of all lengths.
So the size of the inverse, which counts the coordinates instead, may be a quarter of that of the
forward map.
"""

LOOSER = sp.Rational(5, 4)
"""The tolerance of functions of the hand, as a multiple of that of the forward map."""


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
