"""Legs that hold a point by where it is along an axis, and by how far it is from it.

A slider on the ground carries a leg that turns about the direction of the slide and stretches at
right angles to it, as in a 3-PRPS mechanism.  Such a leg has two motors, and is a leg for each.
Instead of stretching, it may be a rod on a crank or on another slider, as in a 3-PPRS mechanism.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Carrier, Crank, Naming, Slide, Slider, Solution, vector
from closedform.lemmas.turret import Around, OnTurret
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


class _AcrossAxis:
    """A leg that is at right angles to an axis, in a plane that may be anywhere along it."""

    axis: Sequence[Any]

    def foot(self, span: sp.Matrix) -> sp.Matrix:
        """The part along the axis of a vector from where the leg starts to its end."""
        axis = vector(self.axis)
        return axis.dot(span) * axis

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The leg or its rod: what is left of that vector, across the axis."""
        return (span - self.foot(span)).applyfunc(sp.expand)


@dataclass(frozen=True)
class Across(_AcrossAxis):
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


@dataclass(frozen=True)
class FreeAlong(Carrier, _AcrossAxis):
    """A crank or a slide with a rod whose end is free along an axis.

    Revolute joints whose axes have the direction of the unit vector ``axis`` join the parts of the
    ``leg``, which move in a plane at right angles to it.  The whole plane may slide along the axis.
    The rod leads to the point ``on_hand`` of the hand, which is that of the leg if it is left out.
    """

    leg: Crank | Slide
    axis: Sequence[Any]
    on_hand: Sequence[Any] = ()
    slide: sp.Symbol | None = None
    """The passive joint of a cylindrical joint on the hand: how far this has slid on the rod."""

    def __post_init__(self) -> None:
        if not isinstance(self.leg, Crank | Slide) or len(self.leg.base) != len(self.axis):
            raise ShapeError("a leg that is FreeAlong an axis is a crank or a slide in space")
        axis, name = vector(self.axis), self.joint
        if any(map(sp.simplify, [axis.dot(axis) - 1, *(e.dot(axis) for e in self.plane)])):
            raise ShapeError(
                f"{name}: the axis of a leg that is FreeAlong it is a unit vector, at right angles "
                f"to the plane in which {name} moves its end"
            )
        object.__setattr__(self, "on_hand", self.on_hand or self.leg.on_hand)

    @property
    def base(self) -> sp.Matrix:
        return self.leg.base

    @property
    def rate(self) -> sp.Matrix:
        return self.leg.rate

    @property
    def plane(self) -> tuple[sp.Matrix, sp.Matrix]:
        """Two directions of the plane of the leg."""
        if isinstance(self.leg, Crank):
            return vector(self.leg.along), vector(self.leg.across)
        return self.leg.rate, vector(self.axis).cross(self.leg.rate)

    def end(self) -> sp.Matrix:
        return self.leg.end()

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the rod has its length."""
        rod = self.pull(span)
        return rod.dot(rod) - sp.sympify(self.rod, strict=True) ** 2

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        first, second = self.plane
        flat = (
            replace(self.leg, pivot=(0, 0), along=(1, 0), across=(0, 1), on_hand=())
            if isinstance(self.leg, Crank)
            else replace(self.leg, start=(0, 0), direction=(1, 0), on_hand=())
        )
        solved = flat.solve(chain, sp.Matrix([w.dot(first), w.dot(second)]), sigma)
        return replace(solved, rod=solved.rod[0] * first + solved.rod[1] * second)


Axial = Along | Across | FreeAlong | Around | OnTurret
"""Legs that hold a point by an axis."""

__all__ = ["Across", "Along", "Axial", "FreeAlong"]
