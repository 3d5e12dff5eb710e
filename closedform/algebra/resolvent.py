"""A root of the cubic that splits two conics into lines: exact, in balls, and over arrays.

Of ``cos 2x + 2 a cos x + 2 b sin x + e = 0`` the cubic

    (1 - u^2) (u - e) + a^2 (1 - u) - b^2 (1 + u)

is the resolvent.  It is not negative at -1 and not positive at 1, so it has a root between them.
"""

from __future__ import annotations

from typing import Any

import flint
import sympy as sp
from flint import arb

Expr = Any


class Resolvent(sp.Function):  # type: ignore[misc]  # SymPy has no annotations
    """A root of the resolvent of a, b and e, between -1 and 1.

    At the root the cubic falls.  If all three roots are real, it is the one that is farther from
    the one in the middle.
    """

    nargs = 3

    def _eval_is_real(self) -> bool:
        return True

    def law(self, u: Expr) -> Expr:
        """What vanishes if u is the root."""
        return cubic(u, *self.args)


def cubic(u: Any, a: Any, b: Any, e: Any) -> Any:
    """The resolvent at u."""
    return (1 - u) * (1 + u) * (u - e) + a * a * (1 - u) - b * b * (1 + u)


def slope(u: Any, a: Any, b: Any, e: Any) -> Any:
    """The derivative of the resolvent."""
    return (1 - u) * (1 + u) - 2 * u * (u - e) - a * a - b * b


def enclosed(a: arb, b: arb, e: arb) -> arb:
    """The root in a ball, at the current precision.

    Newton's method from the end on whose side the root is, with bisection where a step leaves the
    bracket; then the ball grows until the sign of the cubic changes for certain.
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
