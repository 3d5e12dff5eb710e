"""Legs that hold a point by where it is along an axis, and by how far it is from it.

A slider on the ground carries a leg that turns about the direction of the slide and stretches at
right angles to it, as in a 3-PRPS mechanism.  Such a leg has two motors, and is a leg for each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.lemmas.legs import Naming, Slider, Solution, vector
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Along(Slider):
    """A slider whose joint is the coordinate of a point along an axis.

    It moves from ``start`` along the unit vector ``direction``, which is the axis, and keeps the
    point ``on_hand`` of the hand in the plane through it at right angles to the axis.  A leg
    :class:`Across` with the same axis holds the same point.
    """

    joint: sp.Symbol
    start: Sequence[Any]
    direction: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 1
    rod: int = 1
    """The length of what stands for the rod in formulas, the unit vector along the axis."""

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The vector whose product with the velocity of the point is its row of A."""
        return self.rate

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the point is in the plane, from the vector to it from the slider."""
        return self.rate.dot(span)

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q = self.joint
        value = chain.let("slide", self.rate.dot(w))
        lemma = Lemma(
            "line and plane",
            r"q = \frac{\mathbf n\cdot\mathbf w}{D}",
            (value - q,),
            {q: value},
            1,
            roles=((r"\mathbf w", sp.Matrix(w)), (r"\mathbf n", self.rate), ("D", sp.S.One)),
        )
        return Solution(Link((q,), lemma.equations, {}, lemma), value, self.rate)


@dataclass(frozen=True)
class Across:
    """A leg that turns about an axis, and whose joint is its length, at right angles to the axis.

    The axis passes ``pivot`` and has the direction of the unit vector ``axis``.  The leg ends at
    the point ``on_hand`` of the hand.  A leg :class:`Along` moves it along the axis.
    """

    joint: sp.Symbol
    pivot: Sequence[Any]
    axis: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 1

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    @property
    def rod(self) -> sp.Symbol:
        return self.joint

    @property
    def rate(self) -> sp.Matrix:
        return sp.zeros(3, 1)

    def end(self) -> sp.Matrix:
        return self.base

    def foot(self, span: sp.Matrix) -> sp.Matrix:
        """The point of the axis that is nearest, as seen from the pivot."""
        axis = vector(self.axis)
        return axis.dot(span) * axis

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The leg, from the vector to the point from the pivot."""
        return (span - self.foot(span)).applyfunc(sp.expand)

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the leg has its length."""
        across = self.pull(span)
        return across.dot(across) - self.joint**2

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q, across = self.joint, self.pull(w)
        named = [chain.coefficient(f"w{k}", e) for k, e in enumerate(across, 1)]
        start = len(chain.program.body)
        value = chain.let("leg", sp.sqrt(sum(e**2 for e in named)), nonnegative=True)
        lemma = Lemma(
            "length of a leg",
            r"q = |\mathbf w|",
            (sum(e**2 for e in named) - q**2,),
            {q: value},
            1,
            excluded=1,
            roles=(("q", q), (r"\mathbf w", sp.Matrix(across))),
            letters={value: "q"},
            plainly={value: sp.sqrt(sum(e**2 for e in across))},
        )
        body = tuple(chain.program.body[start:])
        link = Link((q,), lemma.equations, {}, lemma, body)
        return Solution(link, value, sp.Matrix(named))


Axial = Along | Across
"""Legs that hold a point by an axis."""

__all__ = ["Across", "Along", "Axial"]
