"""A joint that is free if its axis is parallel to others, within reach of the joints that follow.

Joint c is solved now.  It leaves a height along three parallel axes to joint a, and the rest to two
links, whose plane is normal to these axes.  If c is free, the links limit it: at its usual angle
they may be too short or too long, although a posture reaches the target.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from closedform.lemmas.offset import Offset
from closedform.lemmas.tangent import CoordinateWithin, Links, Turn, Within
from closedform.model.functions import choose, real, sign_of
from closedform.model.lemma import label
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING, VANISHING

STEPS = 2
"""The number of steps that improve a turn; the error after a step is of the order of its square."""
Plane = tuple[sp.Expr, sp.Expr]
Z = sp.Matrix([0, 0, 1])


@dataclass(frozen=True)
class LinksPastParallel(Links):
    """Two links from what a joint ``a`` carries to the place q, which a joint c turns.

    The three parallel axes, along z, turn the constant direction ``axis`` to ``aimed``.  They also
    turn what joint a carries: a point at the ``radius`` from its axis, which is along ``about``
    through the point ``centre``.  This point is at the height of q less ``height``.

    Joint c is free if its axis is parallel to that of joint a, so that both turn in one plane
    (``beside``), or to the three axes, so that it turns in the plane of the links.
    """

    aimed: Callable[[Pair], sp.Matrix]
    axis: sp.Matrix
    about: sp.Matrix
    centre: sp.Matrix
    radius: sp.Expr
    height: sp.Expr
    a: sp.Symbol
    beside: bool

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with the rest within reach."""
        tolerance = turn.chain.size * ROUNDING
        level = self.height + self.centre[2]
        most = self.radius * sp.sqrt(sp.simplify(1 - self.about[2] ** 2))
        in_height = CoordinateWithin(lambda pair: self.q(pair)[2] - level, most).nearest(turn)
        best = _Past(self, tolerance, turn.renamed(in_height, f"{turn.name}_0"))
        for k in range(1, STEPS + 1):
            best = best.better_of(best.closer(), f"{turn.name}_{k}")
        turns = best.in_one_plane() if self.beside else best.around()
        for k, pair in enumerate(turns, STEPS + 1):
            best = best.better_of(pair, f"{turn.name}_{k}")
        return best.turn.pair

    @cached_property
    def across(self) -> tuple[sp.Matrix, sp.Matrix]:
        """Two unit vectors across the axis of joint a, the first of them across z too."""
        n = self.about.cross(Z)
        n = (n / sp.sqrt(sp.simplify(n.dot(n)))).applyfunc(sp.simplify)
        return n, self.about.cross(n).applyfunc(sp.simplify)


@dataclass(frozen=True)
class LinksAround(Links):
    """Two links that reach q, which a joint turns in their plane where it is free."""

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with q within reach."""
        tolerance = turn.chain.size * ROUNDING
        low, high = turn.let("fold", sp.Abs(self.l1 - self.l2)), turn.let("full", self.l1 + self.l2)

        def within(at: Turn) -> Within:
            point, rate = at.linear("q", self.q)
            return Within(point, rate, rate[0] ** 2 + rate[1] ** 2, low, high)

        at = turn.renamed(super().nearest(turn), f"{turn.name}_0")
        goal = within(at)
        (x, y), (dx, dy) = goal.point, goal.rate
        hub = self.q(Pair(sp.S.Zero, sp.S.Zero))
        hx, hy = (at.let(f"hub{k}", hub[k]) for k in (0, 1))
        vx, vy = at.let("vx", hx - x), at.let("vy", hy - y)
        far = at.let("far", sp.sqrt(x**2 + y**2))
        reach = at.let("reach", sp.Min(sp.Max(far, low), high))
        sides = sign_of(hx * vy - hy * vx), sign_of(vy * dx - vx * dy)
        ended = _ended(at.renamed(at.pair, f"{turn.name}_1"), (vx, vy), (hx, hy), reach, sides)
        other = turn.renamed(ended, f"{turn.name}_2")
        missed = at.let("missed", goal.miss - tolerance)
        nearer = sp.And(missed > 0, other.let("misses", within(other).miss) < missed)
        return _better(nearer, other.pair, at.pair)


@dataclass(frozen=True)
class _Past:
    """What follows from a turn of joint c, seen as before the three parallel axes turn."""

    goal: LinksPastParallel
    tolerance: sp.Expr
    """By how much the links may miss."""
    turn: Turn

    def let(self, name: str, value: sp.Expr) -> sp.Expr:
        return value if value.is_number else self.turn.let(name, value)

    def _renamed(self, name: str) -> Turn:
        return self.turn.renamed(self.turn.pair, f"{self.turn.name}_{name}")

    def better_of(self, pair: Pair, name: str) -> _Past:
        """This turn, or another one if it misses less."""
        other = _Past(self.goal, self.tolerance, self.turn.renamed(pair, f"{name}_moved"))
        better = _better(other.miss < self.miss, other.turn.pair, self.turn.pair)
        return _Past(self.goal, self.tolerance, self.turn.renamed(better, name))

    @cached_property
    def _aimed(self) -> tuple[Plane, Plane]:
        return self.turn.linear("aimed", self.goal.aimed)

    @cached_property
    def _back(self) -> Pair:
        """The turn back of the three axes."""
        (u, v), _ = self._aimed
        x, y, _ = self.goal.axis
        square = self.let("aims", sp.Max(u**2 + v**2, VANISHING**2))
        length = self.let("aim", sp.sqrt(square) * sp.sqrt(sp.simplify(x**2 + y**2)))
        s, c = (u * y - v * x) / length, (u * x + v * y) / length
        return Pair(self.let("back_s", s), self.let("back_c", c))

    def _before(self, name: str, vector: sp.Matrix) -> sp.Matrix:
        """A vector as it is before the three axes turn it."""
        s, c = self._back.s, self._back.c
        x, y, z = (self.let(f"{name}{k}", e) for k, e in enumerate(vector))
        return sp.Matrix(
            [self.let(f"{name}x", c * x - s * y), self.let(f"{name}y", s * x + c * y), z]
        )

    @cached_property
    def _hub(self) -> sp.Matrix:
        """The part of q that joint c does not turn."""
        return self._before("hub", self.goal.q(Pair(sp.S.Zero, sp.S.Zero)))

    @cached_property
    def _q(self) -> sp.Matrix:
        return self._before("q", self.goal.q(self.turn.pair))

    @cached_property
    def _rate(self) -> sp.Matrix:
        """That of q if joint c alone turns."""
        s, c = sp.Dummy("s"), sp.Dummy("c")
        q, pair = self.goal.q(Pair(s, c)), self.turn.pair
        return self._before("dq", q.diff(s) * pair.c - q.diff(c) * pair.s)

    @cached_property
    def _rise(self) -> Plane:
        """How far up, across its axis, joint a has to carry its point, and how far it does."""
        goal = self.goal
        _, up = goal.across
        rise = self.let("rise", (self._q[2] - goal.centre[2] - goal.height) / up[2])
        return rise, self.let("risen", sp.Max(-goal.radius, sp.Min(goal.radius, rise)))

    @cached_property
    def _bridged(self) -> sp.Matrix:
        """From what joint a carries to q."""
        (level, up), (_, risen) = self.goal.across, self._rise
        bridged = self._q - self.goal.centre - self._aside * level - risen * up
        return sp.Matrix([self.let(f"bridged{k}", e) for k, e in enumerate(bridged)])

    @cached_property
    def _aside(self) -> sp.Expr:
        r, (_, risen) = self.goal.radius, self._rise
        rest = sp.sqrt(sp.Max(0, (r - risen) * (r + risen)))
        return self.let("aside", real(f"sigma_{label(self.goal.a)}") * rest)

    @cached_property
    def _links(self) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        """How far the links have to reach, and the least and the most that they do."""
        x, y, _ = self._bridged
        l1, l2 = self.goal.l1, self.goal.l2
        far = self.let("far", sp.sqrt(x**2 + y**2))
        return far, self.let("fold", sp.Abs(l1 - l2)), self.let("full", l1 + l2)

    @cached_property
    def miss(self) -> sp.Expr:
        """How far the rest is out of reach, beyond rounding."""
        (far, low, high), (rise, risen) = self._links, self._rise
        missed = sp.Max(0, low - far, far - high) + sp.Abs(rise - risen)
        return self.let("miss", sp.Max(0, missed - self.tolerance))

    def closer(self) -> Pair:
        """The smallest turn to within reach of the links, at the present rates."""
        (level, up), (_, risen) = self.goal.across, self._rise
        (u, v), (du, dv) = self._aimed
        spin = self.let("spin", (u * dv - v * du) / sp.Max(u**2 + v**2, VANISHING**2))
        x, y, _ = self._q
        rise = self.let("d_rise", self._rate[2] / up[2])
        held = sp.Max(sp.Abs(self._aside), VANISHING * self.turn.chain.size)
        aside = self.let("d_aside", -sign_of(self._aside) * risen * rise / held)
        moved = self._rate - spin * sp.Matrix([-y, x, 0]) - aside * level - rise * up
        dx, dy = (self.let(f"d_bridged{k}", moved[k]) for k in (0, 1))
        _, low, high = self._links
        bend = self.let("bend", dx**2 + dy**2)
        return self._renamed("near").least(
            Within((self._bridged[0], self._bridged[1]), (dx, dy), bend, low, high)
        )

    def around(self) -> list[Pair]:
        """The turn about the three axes that moves the end of the links to where they reach."""
        far, low, high = self._links
        (x, y, _), (kx, ky, _) = self._hub, self._hub - self._bridged
        kx, ky = self.let("kx", kx), self.let("ky", ky)
        within = self.let("within", sp.Min(sp.Max(far, low), high))
        (u, v), (du, dv) = self._aimed
        sense, side = sign_of(u * dv - v * du), sign_of(x * ky - y * kx)
        return [_ended(self._renamed("around"), (kx, ky), (x, y), within, (side, sense))]

    def in_one_plane(self) -> list[Pair]:
        """Turns of joints a and c, whose axes are parallel, to where the links reach.

        In the plane across these axes, what the links bridge has a known coordinate.  The other one
        is limited by the links, and by the triangle that both joints turn.
        """
        goal, (_, low, high) = self.goal, self._links
        (level, up), g, r = goal.across, goal.about, goal.radius
        turned, fixed = self._q - self._hub, self._hub - goal.centre
        v = [self.let(f"v{k}", turned.dot(e)) for k, e in enumerate(goal.across)]
        dv = [self._rate.dot(e) for e in goal.across]
        own = self.let("own", sp.sqrt(v[0] ** 2 + v[1] ** 2))
        along = self.let("along", (self._q - goal.centre).dot(g))
        known = self.let("known", (goal.height - along * g[2]) / up[2])
        depth = self.let("depth", along * sp.sqrt(sp.simplify(1 - g[2] ** 2)) + known * g[2])
        aside, above = self.let("fixed", fixed.dot(level)), self.let("above", known - fixed.dot(up))
        links = [self._leg(f"link{k}", e, depth) for k, e in enumerate((low, high))]
        turns = [self._leg(f"turns{k}", e, above) for k, e in enumerate((own - r, own + r))]
        here = self.let("here", self._bridged.dot(level))
        there = self._nearest(here, links, turns, aside)
        hub = self.let("past_fixed", there - aside), above
        sense = sign_of(v[0] * dv[1] - v[1] * dv[0])
        return [
            _ended(self._renamed(name), (v[0], v[1]), hub, r, (sp.Integer(side), sense))
            for side, name in ((1, "one"), (-1, "other"))
        ]

    def _nearest(
        self, here: sp.Expr, one: list[sp.Expr], other: list[sp.Expr], shift: sp.Expr
    ) -> sp.Expr:
        """The nearest number whose size is in one range and, less the shift, in the other one."""
        best, least = here, sp.S.Zero
        for k, (a, b) in enumerate(((1, 1), (1, -1), (-1, 1), (-1, -1))):
            (a0, a1), (b0, b1) = ([s * e for e in ends[::s]] for s, ends in ((a, one), (b, other)))
            lowest = self.let(f"lowest{k}", sp.Max(a0, shift + b0))
            highest = self.let(f"highest{k}", sp.Min(a1, shift + b1))
            there = self.let(f"there{k}", sp.Min(sp.Max(here, lowest), highest))
            empty = 2**20 * sp.Max(0, lowest - highest)  # or rounding, at an end of both
            away = self.let(f"away{k}", sp.Abs(there - here) + empty)
            if k:
                nearer = away < least
                there = self.let(f"best{k}", sp.Piecewise((there, nearer), (best, True)))
                away = self.let(f"least{k}", sp.Min(away, least))
            best, least = there, away
        return best

    def _leg(self, name: str, longest: sp.Expr, other: sp.Expr) -> sp.Expr:
        """The leg of a right triangle, or zero."""
        return self.let(name, sp.sqrt(sp.Max(0, (longest - other) * (longest + other))))


def _better(better: sp.Basic, there: Pair, here: Pair) -> Pair:
    """One pair if it is better, else another one."""
    s, c = (
        sp.Piecewise((moved, better), (still, True))
        for moved, still in ((there.s, here.s), (there.c, here.c))
    )
    return Pair(s, c)


def _ended(
    turn: Turn, v: Plane, hub: Plane, reach: sp.Expr, sides: tuple[sp.Expr, sp.Expr]
) -> Pair:
    """Turned until the vector v ends at a distance ``reach`` from the hub.

    The ``sides`` are that of the hub on which v is then, and the sense in which v turns.
    """
    side, sense = (turn.let(n, e) for n, e in zip(("side", "sense"), sides, strict=True))
    size = turn.chain.size
    r = turn.let("r", sp.sqrt(hub[0] ** 2 + hub[1] ** 2))
    length = turn.let("v", sp.sqrt(v[0] ** 2 + v[1] ** 2))
    u, _ = Offset(hub, r, length).leaving(turn.chain, reach, side, f"past_{turn.name}")
    us, uc = turn.let("us", u.s), turn.let("uc", u.c)
    still = length <= size * VANISHING
    sine = choose(still, 0, sense * (v[0] * us - v[1] * uc) / length)
    cosine = choose(still, 1, (v[0] * uc + v[1] * us) / length)
    return turn.by(turn.let("by_s", sine), turn.let("by_c", cosine))


__all__ = ["LinksAround", "LinksPastParallel"]
