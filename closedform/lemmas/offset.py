"""An offset that leads from a point to a given distance from the origin: its direction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.chain import Chain
from closedform.model.functions import choose
from closedform.model.pair import Pair
from closedform.model.tolerances import VANISHING

Plane = tuple[sp.Expr, sp.Expr]


def chord(lengths: Plane, aside: sp.Expr) -> Plane:
    """How near and how far two links reach along a line that is ``aside`` of their start."""
    l1, l2 = lengths
    near, far = (sp.sqrt(sp.Max(0, (e - aside) * (e + aside))) for e in (sp.Abs(l1 - l2), l1 + l2))
    return near, far


def on_side(ahead: sp.Basic, near: sp.Expr, far: sp.Expr) -> Plane:
    """From where to where what is so near and so far is, ahead of its start or behind it."""
    low, high = (sp.Piecewise((a, ahead), (-b, True)) for a, b in ((near, far), (far, near)))
    return low, high


def plain(name: str, value: sp.Expr, scale: sp.Expr) -> sp.Basic:
    """A condition that a value vanishes, for values that only the tangent case computes."""
    return value <= scale * VANISHING


@dataclass(frozen=True)
class Offset:
    """A ``point``, ``r`` away, from which an ``offset`` leads in a direction that is free.

    ``vanishes`` makes the flags: of a name, a value and its scale.
    """

    point: tuple[sp.Expr, sp.Expr]
    r: sp.Expr
    offset: sp.Expr
    vanishes: Callable[[str, sp.Expr, sp.Expr], sp.Basic] = plain

    def leaving(
        self, chain: Chain, reach: sp.Expr, side: sp.Expr, name: str
    ) -> tuple[Pair, tuple[sp.Expr, ...]]:
        """The direction u for which the point minus ``offset`` times u is ``reach`` away.

        It follows from the law of cosines in half angles, to one ``side`` of the point; the
        intermediate results are returned too.
        """
        p, r, e = chain.program, self.r, self.offset
        cc = p.let(f"k_{name}", sp.Max(0, (r + e - reach) * (r + e + reach)), nonnegative=True)
        ss = p.let(f"d_{name}", sp.Max(0, (reach - r + e) * (reach + r - e)), nonnegative=True)
        return self.turned(chain, (cc, ss, side), chain.size * (r + e), name)

    def turned(
        self, chain: Chain, halves: tuple[sp.Expr, sp.Expr, sp.Expr], scale: sp.Expr, name: str
    ) -> tuple[Pair, tuple[sp.Expr, ...]]:
        """The direction of the point, turned by an angle; returns the ``halves`` too.

        They are the squares of the cosine and of the sine of half of the angle, times the same
        number, and the side to which it turns.
        """
        p, r, (x, y), (cc, ss, side) = chain.program, self.r, self.point, halves
        total = p.let(f"n_{name}", cc + ss, nonnegative=True)
        any_turn = self.vanishes(f"any_{name}", total, scale)
        cosine = p.let(f"uc_{name}", choose(any_turn, 1, (cc - ss) / total))
        across = 2 * side * sp.sqrt(cc) * sp.sqrt(ss) / total
        sine = p.let(f"us_{name}", choose(any_turn, 0, across))
        at_hub = self.vanishes(f"hub_{name}", r, chain.size)
        s = p.let(f"s_{name}", choose(at_hub, 0, (y * cosine + x * sine) / r))
        c = p.let(f"c_{name}", choose(at_hub, 1, (x * cosine - y * sine) / r))
        return Pair(s, c), halves
