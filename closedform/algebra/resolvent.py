"""A root of the cubic that splits two conics into lines: exact, in balls, and over arrays.

The equation ``cos 2x + 2 a cos x + 2 b sin x + e = 0`` has the resolvent

    (1 - u^2) (u - e) + a^2 (1 - u) - b^2 (1 + u).

It is not negative at -1 and not positive at 1, so it has a root between them.
"""

from __future__ import annotations

from typing import Any

import flint
import sympy as sp
from flint import arb

Expr = Any


class Resolvent(sp.Function):  # type: ignore[misc]  # SymPy has no annotations
    """A root of the resolvent of a, b and e, between -1 and 1.

    The cubic decreases at this root.  If all three roots are real, it is the outer root that is
    farther from the middle one.
    """

    nargs = 3

    def _eval_is_real(self) -> bool:
        return True

    def law(self, u: Expr) -> Expr:
        """The expression that vanishes if u is the root."""
        return cubic(u, *self.args)


def cubic(u: Any, a: Any, b: Any, e: Any) -> Any:
    """The resolvent at u."""
    return (1 - u) * (1 + u) * (u - e) + a * a * (1 - u) - b * b * (1 + u)


def slope(u: Any, a: Any, b: Any, e: Any) -> Any:
    """The derivative of the resolvent."""
    return (1 - u) * (1 + u) - 2 * u * (u - e) - a * a - b * b


def enclosed(a: arb, b: arb, e: arb) -> arb:
    """The root in a ball, at the current precision.

    Newton's method starts from the end of the interval on the side of the root, and bisects when a
    step leaves the bracket.  Then the ball grows until the cubic provably changes its sign in it.
    """
    point = tuple(map(_middle, (a, b, e)))
    least = arb(2) ** (8 - flint.ctx.prec)
    low, high = arb(-1), arb(1)
    u = high if cubic(point[2] / 3, *point) >= 0 else low
    for _ in range(4 * flint.ctx.prec):
        value, rate = _middle(cubic(u, *point)), _middle(slope(u, *point))
        low, high = (u, high) if value >= 0 else (low, u)
        after = _middle(u - value / rate) if rate != 0 else high + 1
        if not low <= after <= high:
            after = _middle((low + high) / 2)
        before, u = u, after
        if abs(u - before) <= least:
            break
    radius = least
    while radius < 2:
        left, right = u - radius, u + radius
        if (left <= -1 or cubic(left, a, b, e) > 0) and (right >= 1 or cubic(right, a, b, e) < 0):
            return arb(u, radius).intersection(arb(0, 1))
        radius *= 4
    return arb(0, 1)


def _middle(x: arb) -> arb:
    return arb(x.mid())


__all__ = ["Resolvent", "cubic", "enclosed", "slope"]
