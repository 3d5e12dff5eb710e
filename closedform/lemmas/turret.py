"""Legs with two motors: a turret turns about an axis of the ground, and carries a planar leg.

The planar leg moves in the plane that passes through the axis and turns with the turret.  So the
turret determines in which plane its end is, and the second motor where it is there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.legs import Carrier, Crank, Naming, Slide, Solution, Stretch, vector
from closedform.lemmas.links import degenerate
from closedform.lemmas.pairs import direction
from closedform.model.inverse import Link
from closedform.model.pair import Pair

IN_PLANE = 2


@dataclass(frozen=True)
class Around:
    """A turret, whose joint is the angle of a plane through an axis of the ground.

    The axis passes ``pivot`` and has the direction of the unit vector ``axis``.  At the angle 0 the
    plane contains the unit vector ``zero``, at right angles to it.  The plane passes the point
    ``on_hand`` of the hand, on either side of the axis.  A leg :class:`OnTurret` in the plane holds
    the same point.
    """

    joint: sp.Symbol
    pivot: Sequence[Any]
    axis: Sequence[Any]
    zero: Sequence[Any]
    on_hand: Sequence[Any] = ()
    signs: int = 2
    rod: int = 1
    """The length of what stands for the rod in formulas, the normal of the plane."""

    def __post_init__(self) -> None:
        a, u = vector(self.axis), vector(self.zero)
        if len(a) != 3 or any(map(sp.simplify, (a.dot(a) - 1, u.dot(u) - 1, a.dot(u)))):
            raise ShapeError(
                f"{self.joint}: the axis of a turret, and its direction at the angle 0, are unit "
                f"vectors in space at right angles"
            )

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    @property
    def rate(self) -> sp.Matrix:
        return sp.zeros(3, 1)

    @property
    def pair(self) -> Pair:
        """That of the joint."""
        return Pair.of(self.joint)

    def end(self) -> sp.Matrix:
        return self.base

    def ahead(self, pair: Pair) -> sp.Matrix:
        """The direction of the plane that is at right angles to the axis."""
        u = vector(self.zero)
        return pair.c * u + pair.s * vector(self.axis).cross(u)

    def normal(self, pair: Pair) -> sp.Matrix:
        """The normal of the plane."""
        return vector(self.axis).cross(self.ahead(pair))

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The vector whose product with the velocity of the point is its row of A."""
        return self.normal(self.pair)

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the point is in the plane, from the vector to it from the pivot."""
        return self.normal(self.pair).dot(span)

    def away(self, span: sp.Matrix) -> sp.Expr:
        """The entry of B: how far the point is from the axis, along the direction of the plane."""
        return self.ahead(self.pair).dot(span)

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        q, p, tag = self.joint, chain.program, f"_turret{chain.tag}"
        u = vector(self.zero)
        v = vector(self.axis).cross(u)
        a, b = chain.let("turn_a", -w.dot(u)), chain.let("turn_b", w.dot(v))
        start, said = len(p.body), "the leg of a turret ends on its axis"
        at = Amplitude.of(p, q, (a, b, sp.S.Zero), sigma, suffix=tag)
        free = chain.vanishes("on_axis", at.h, said, q)
        pair = direction(sigma * b, -sigma * a, at.h, free).known_as(p, tag)
        # not from the pair, whose entries would vanish if the squares in h overflow
        away = p.let(f"away{tag}", sigma * at.h)
        lemma = at.lemma(pair.angle, r"\sigma\frac{\pi}{2}")
        plain = sp.atan2(sigma * b, -sigma * a, evaluate=False)
        link = Link(
            unknowns=(q,),
            equations=lemma.equations,
            lemma=replace(lemma, plainly={q: plain}),
            body=tuple(p.body[start:]),
            means={pair.s: sp.sin(q), pair.c: sp.cos(q), away: b * sp.sin(q) - a * sp.cos(q)},
            degenerate=degenerate(free, [{a: sp.S.Zero, b: sp.S.Zero}], q, said),
        )
        return Solution(link, lemma[q], self.normal(pair))


@dataclass(frozen=True)
class OnTurret(Carrier):
    """A planar leg on a turret, whose second coordinate is along the axis of the turret.

    The first one is the distance from this axis, in the direction of the plane of the turret.  The
    ``leg`` is a crank, a slide or a leg that stretches.  It leads to the point ``on_hand``, which
    is that of the turret.
    """

    leg: Crank | Slide | Stretch
    turret: Around
    on_hand: Sequence[Any] = ()
    seen: Pair | None = None
    """The pair of the turret in an inverse, where it is known."""
    away: sp.Symbol | None = None
    """How far the end is from the axis, in an inverse."""

    def __post_init__(self) -> None:
        if not isinstance(self.leg, Crank | Slide | Stretch) or len(self.leg.base) != IN_PLANE:
            raise ShapeError(
                "a leg OnTurret is a crank, a slide or a leg that stretches, in the two "
                "coordinates of the plane of the turret"
            )
        object.__setattr__(self, "on_hand", self.on_hand or self.turret.on_hand)

    @property
    def base(self) -> sp.Matrix:
        return self.turret.base

    @property
    def pair(self) -> Pair:
        """That of the turret."""
        return self.seen or self.turret.pair

    def lifted(self, flat: sp.Matrix) -> sp.Matrix:
        """A vector of the plane, in space."""
        return flat[0] * self.turret.ahead(self.pair) + flat[1] * vector(self.turret.axis)

    def flat(self, span: sp.Matrix) -> sp.Matrix:
        """The coordinates of a vector in the plane."""
        ahead = self.turret.ahead(self.pair)
        return sp.Matrix([ahead.dot(span), vector(self.turret.axis).dot(span)])

    @property
    def rate(self) -> sp.Matrix:
        if isinstance(self.leg, Stretch):
            return sp.zeros(3, 1)
        return self.lifted(self.leg.rate)

    def start(self) -> sp.Matrix:
        """Where the crank or the slider starts."""
        return self.base + self.lifted(self.leg.base)

    def end(self) -> sp.Matrix:
        return self.base + self.lifted(self.leg.end())

    def pull(self, span: sp.Matrix) -> sp.Matrix:
        """The rod, as it is in the plane, from the vector to the point from the near end."""
        return self.lifted(self.flat(span))

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the rod has its length."""
        rod = self.flat(span)
        return rod.dot(rod) - sp.sympify(self.rod, strict=True) ** 2

    def turned_by(self, link: Link) -> OnTurret:
        """The same, in the names that the link of the turret has for its pair."""
        sine, cosine, away = link.means
        return replace(self, seen=Pair(sine, cosine), away=away)

    def solve(self, chain: Naming, w: sp.Matrix, sigma: sp.Symbol) -> Solution:
        seen = sp.Matrix([self.away, vector(self.turret.axis).dot(w)])
        solved = self.leg.solve(chain, seen - self.leg.base, sigma)
        return replace(solved, rod=self.lifted(solved.rod))


__all__ = ["Around", "OnTurret"]
