"""What the third of three joints does to a point, seen across the first axis: an ellipse.

Let the point p be at the end of the third joint, and let the first two axes be skew.  The second
joint changes neither the height of the point above its own axis nor its distance from the origin on
that axis.  Both are linear in the sine and the cosine of the third joint, and in the coordinates of
p across the first axis before the first joint turns them.  So these coordinates run along an
ellipse if the third joint turns; where it meets the circle of p around the first axis, the
third joint has an equation of degree four.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.circles import shortest_on_circles
from closedform.algebra.factoring import factored
from closedform.algebra.normal_form import normal
from closedform.algebra.operations import operations
from closedform.scaffold.chains.chainlinks import Single
from closedform.scaffold.chains.maker import Z

SAMPLES = 1000
NEAR = 1 / 128
"""More than what a point moves by from one sample to the next."""


@dataclass(frozen=True)
class Ellipse:
    """``centre + along cos x + aside sin x``, where x is the angle of the third joint.

    The centre contains ``square``, the square of the distance of the point from the origin, and its
    ``height`` along the first axis.
    """

    centre: sp.Matrix
    along: sp.Matrix
    aside: sp.Matrix

    @classmethod
    def of(cls, joints: tuple[Single, Single, Single], square: Any, height: Any) -> Ellipse:
        """The ellipse of three joints of which the first two have skew axes."""
        one, two, three = joints
        g, s, t, u = one.end * Z, one.shift, two.shift, three.shift
        seen_by = sp.Matrix([[g[0], g[1]], [s[0], s[1]]]).inv()

        def seen(v: sp.Matrix, fixed: sp.Matrix) -> sp.Matrix:
            """What a part v of the point, seen from the second joint, adds to the ellipse."""
            return (seen_by * (sp.Matrix([v[2], -t.dot(v)]) + fixed)).applyfunc(_simple)

        lengths = (square + s.dot(s) - t.dot(t) - u.dot(u)) / 2
        fixed = sp.Matrix([t[2] + g.dot(s) - g[2] * height, lengths - s[2] * height])
        return cls(
            seen(two.end * sp.Matrix([0, 0, u[2]]), fixed),
            seen(two.end * sp.Matrix([u[0], u[1], 0]), sp.zeros(2, 1)),
            seen(two.end * sp.Matrix([-u[1], u[0], 0]), sp.zeros(2, 1)),
        )

    @property
    def double(self) -> tuple[Any, Any]:
        """The coefficients of cos 2x and sin 2x in the square of the distance from the axis."""
        a, b = self.along, self.aside
        return _simple(a.dot(a) - b.dot(b)) / 2, _simple(a.dot(b))


def _simple(e: sp.Expr) -> sp.Expr:
    """The shorter of the same and a quotient of products, without squares that circles spare."""
    parts = (sp.expand(normal(part)) for part in sp.fraction(sp.together(e)))
    top, bottom = (factored(shortest_on_circles(part)) for part in parts)
    return min(top / bottom, e, key=operations)


def folds(two: Single, three: Single) -> bool:
    """Whether the third joint can bring its end to the axis of the second, or very close.

    There the second joint is nearly free, three solutions meet, and squares of lengths tell little.
    Parameters count as different numbers.
    """
    entries = [*two.shift, *two.end, *three.shift]
    symbols = sorted({s for e in entries for s in e.free_symbols}, key=str)
    numbers = {s: 1 + sp.Rational(k * 37 % 101, 101) for k, s in enumerate(symbols, 1)}

    def across(v: sp.Matrix) -> complex:
        return complex(*(float(e.xreplace(numbers)) for e in (two.end * v)[:2, 0]))

    x, y, z = three.shift
    still = across(sp.Matrix([0, 0, z])) + complex(*map(float, two.shift[:2, 0].xreplace(numbers)))
    along, aside = across(sp.Matrix([x, y, 0])), across(sp.Matrix([-y, x, 0]))
    angles = (2 * math.pi * k / SAMPLES for k in range(SAMPLES))
    nearest = min(abs(still + along * math.cos(t) + aside * math.sin(t)) for t in angles)
    return nearest < NEAR * (abs(still) + abs(along) + abs(aside))


__all__ = ["Ellipse", "folds"]
