"""An angle as a direction, by its sine and cosine.

A joint after the first is found in a frame that the earlier joints have turned.  This needs only
their sines and cosines; the angles themselves are computed once, for the output.  Every pair is
normalised by its own numbers.  So it lies on the unit circle up to rounding, even where a bound was
clamped, and rotations that are built from it stay rotations.
"""

from __future__ import annotations

import sympy as sp

from closedform.model.functions import choose, real
from closedform.model.pair import Pair


def direction(y: sp.Expr, x: sp.Expr, length: sp.Expr, undefined: sp.Basic = sp.false) -> Pair:
    """The pair of ``atan2(y, x)`` for a vector of the given length; zero where it is undefined."""
    return Pair(choose(undefined, 0, y / length), choose(undefined, 1, x / length))


def any_pair(name: str) -> Pair:
    """The pair of any angle except a half turn, as a function of a free symbol."""
    t = real(name)
    return Pair(2 * t / (1 + t**2), (1 - t**2) / (1 + t**2))
