"""Two links whose plane turns on a rail: what is in reach where the target leaves a joint free.

A slide moves the axis of a turret across it, and two links in the plane of the turret reach a
point.  Where the plane is along the rail, the slide is free; where a wrist is aligned with the axis
of the turret, the turret is.  Then the reach of the links decides.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.chain import Chain
from closedform.lemmas.offset import Plane, chord, on_side
from closedform.lemmas.pairs import direction
from closedform.lemmas.zyz import Reaching
from closedform.model.functions import sign_of
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING


@dataclass(frozen=True)
class LinksAlongSlide:
    """Two links that have to reach the ``point`` of a plane, less d times the vector ``along``."""

    point: Plane
    along: Plane
    lengths: Plane

    def nearest(self, chain: Chain, d: sp.Expr, name: str) -> sp.Expr:
        """The way d of the slide, changed so that the links reach.

        It is right where most of the slide is in the plane of the links.
        """
        let, (x, y), (a, b) = chain.program.let, self.point, self.along
        square = let(f"along_square{name}", sp.Max(a**2 + b**2, sp.Rational(1, 2)))
        length = let(f"along_size{name}", sp.sqrt(square))
        foot = let(f"foot{name}", (x * a + y * b) / square)
        aside = let(f"aside{name}", sp.Abs(x * b - y * a) / length)
        near, far = (
            let(f"{n}{name}", e / length)
            for n, e in zip(("nearest", "farthest"), chord(self.lengths, aside), strict=True)
        )
        gone = let(f"gone{name}", d - foot)
        return foot + sign_of(gone) * sp.Min(sp.Max(sp.Abs(gone), near), far)


@dataclass(frozen=True)
class ReachingOnRail(Reaching):
    """Turns u of a plane on a rail, for which two links in the plane reach a target.

    ``target`` is that along and across the rail.  The plane carries a point at ``out`` along its
    direction ``outward`` and ``beside`` it; links reach this point at ``out`` less ``start``, if
    it is at a ``height``.
    """

    rail: Plane
    outward: Plane
    beside: sp.Expr
    start: sp.Expr
    height: sp.Expr

    @classmethod
    def by_links(
        cls,
        chain: Chain,
        target: Plane,
        plane: tuple[Plane, Plane, sp.Expr],
        at: Plane,
        lengths: Plane,
    ) -> ReachingOnRail:
        """For a ``plane``: the unit vectors of the rail and outward, and the offset beside it.

        The links start ``at`` a distance outward, from where the point has a height.
        """
        rail, outward, beside = plane
        none, (start, height) = Pair(sp.S.Zero, sp.S.One), at
        exact = [sp.sympify(e, strict=True) for e in lengths]
        return cls(
            chain, target, (exact[0], exact[1]), offset=sp.S.Zero, ahead=none, lever=chain.size,
            rail=rail, outward=outward, beside=sp.sympify(beside, strict=True), start=start,
            height=height,
        )  # fmt: skip

    def _carried(self, out: sp.Expr) -> Plane:
        """The point that the plane carries, before it turns."""
        (x, y), e = self.outward, self.beside
        return x * out - y * e, y * out + x * e

    def _limits(self, ahead: sp.Basic, name: str) -> Plane:
        """How far the point may be out, where the links start and on one side of it."""
        let = self.chain.program.let
        near, far = (
            let(f"{n}_{name}", e)
            for n, e in zip(("near", "far"), chord(self.lengths, sp.Abs(self.height)), strict=True)
        )
        low, high = on_side(ahead, near, far)
        return self.start + low, self.start + high

    def _toward(self, out: sp.Expr, side: sp.Expr, name: str) -> Pair:
        """The turn that brings a point so far out across the rail to where the target is."""
        let, across = self.chain.program.let, self.target[1]
        square = let(f"square_{name}", out**2 + self.beside**2)
        along = let(f"way_{name}", side * sp.sqrt(sp.Max(0, square - across**2)))
        (x, y), (a, b) = self._carried(out), self.rail
        v, w = a * along - b * across, b * along + a * across
        sine, cosine = let(f"us_{name}", x * w - y * v), let(f"uc_{name}", x * v + y * w)
        length = let(f"n_{name}", sp.sqrt(sine**2 + cosine**2), nonnegative=True)
        none = self.chain.program.vanishes(
            f"any_{name}", length, self.chain.size**2, "the turn has no effect"
        )
        pair = direction(sine, cosine, length, none)
        named = Pair(let(f"s_{name}", pair.s), let(f"c_{name}", pair.c))
        self.chain.units.append((named.s, named.c, (sine, cosine)))
        return named

    def middle(self) -> Pair:
        """The middle of what is in reach, on the side on which the point can be farther."""
        let, across = self.chain.program.let, self.target[1]
        ahead = self.start >= 0
        low, high = self._limits(ahead, "mid")
        least = sp.sqrt(sp.Max(0, across**2 - self.beside**2))
        one, other = (let(f"{n}_out", sp.Abs(e)) for n, e in (("one", low), ("other", high)))
        # on this side both are farther out than the start of the links
        nearest, farthest = sp.Max(sp.Min(one, other), least), sp.Max(one, other)
        size = let("out_mid", (nearest + farthest) / 2)
        return self._toward(let("out", sp.Piecewise((size, ahead), (-size, True))), sp.S.One, "mid")

    def moved(self, u: Pair, gain: sp.Expr) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, Pair]:
        p, size, (x, y), (a, b) = self.chain.program, self.chain.size, self.outward, self.rail
        along, across = u.c * x - u.s * y, u.s * x + u.c * y
        aside = p.let("aside_out", a * across - b * along)
        ahead = p.let("ahead_out", a * along + b * across)
        out = p.let("out_there", (self.target[1] - self.beside * ahead) / aside)
        side = sign_of(out * ahead - self.beside * aside)
        low, high = self._limits(out >= self.start, "near")
        reach = p.let("out_near", sp.Min(sp.Max(out, low), high))
        v = self._toward(reach, side, "near")
        close = p.vanishes(
            "close", gain * size - size / 2**11, size, "its direction may be inaccurate"
        )
        inside = p.vanishes("inside", sp.Abs(reach - out), size, "it is in reach")
        change = sp.sqrt((v.c - u.c) ** 2 + (v.s - u.s) ** 2)
        doubt = gain * change - 4 * ROUNDING
        near = p.vanishes("within_rounding", doubt, 4, "the turn is free up to rounding")
        return close, near, inside, v


__all__ = ["LinksAlongSlide", "ReachingOnRail"]
