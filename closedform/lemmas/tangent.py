"""Turns whose two solutions nearly meet, within the reach of the joints that follow.

There a rounding error of the target turns the joint by a multiple of that error.  The rest may then
seem to be out of reach of the later joints, although a posture reaches the target.  The target does
not distinguish some turns of the joint; of these, one is taken for which the rest is within reach.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import sympy as sp

from closedform.lemmas.amplitude import Amplitude, nearly_tangent
from closedform.lemmas.chain import Chain
from closedform.lemmas.offset import Offset
from closedform.lemmas.pairs import direction
from closedform.model.functions import Program, choose, real, sign_of
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING, VANISHING


@dataclass(frozen=True)
class Turned(Pair):
    """The pair of a joint, and the ``lever`` by which it moves the target across its plane.

    A rounding error of the target turns the joint by that error over the lever.
    """

    lever: sp.Expr


@dataclass(frozen=True)
class Within:
    """A point whose distance from the origin must be between ``low`` and ``high``.

    A turn moves the point by ``rate`` times its angle.  The square of the distance then changes by
    a part linear in the angle, and by ``bend`` times the square of the angle.
    """

    point: tuple[sp.Expr, sp.Expr]
    rate: tuple[sp.Expr, sp.Expr]
    bend: sp.Expr
    low: sp.Expr
    high: sp.Expr

    @property
    def miss(self) -> sp.Expr:
        """How far the point is out of reach."""
        x, y = self.point
        r = sp.sqrt(x**2 + y**2)
        return sp.Max(0, self.low - r, r - self.high)


@dataclass(frozen=True)
class Turn:
    """A turn that may be changed: its pair in names that end in ``name``.

    It moves the target by the ``lever`` times its angle and ``beside`` times half the square, which
    may add up to ``allowance``.
    """

    chain: Chain
    pair: Pair
    lever: sp.Expr
    beside: sp.Expr
    allowance: sp.Expr
    name: str
    side: sp.Expr = sp.S.One
    """On which side of the place where both solutions meet this one is."""

    def let(self, name: str, value: sp.Expr) -> sp.Symbol:
        return self.chain.program.let(f"{name}_{self.name}", value)

    def renamed(self, pair: Pair, name: str) -> Turn:
        p = self.chain.program
        named = Pair(p.let(f"s_{name}", pair.s), p.let(f"c_{name}", pair.c))
        return replace(self, pair=named, name=name)

    def linear(
        self, name: str, value: Callable[[Pair], sp.Matrix]
    ) -> tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]:
        """The first two coordinates of a vector that is linear in the pair, and their rates."""
        s, c = sp.Dummy("s"), sp.Dummy("c")
        x, y = value(Pair(s, c))[:2]
        here = {s: self.pair.s, c: self.pair.c}

        def rate(e: sp.Expr) -> sp.Expr:
            return e.diff(s) * self.pair.c - e.diff(c) * self.pair.s

        def named(n: str, e: sp.Expr) -> sp.Expr:
            return self.let(n, e) if e != 0 else e

        return (
            (named(f"{name}x", x.xreplace(here)), named(f"{name}y", y.xreplace(here))),
            (named(f"d{name}x", rate(x)), named(f"d{name}y", rate(y))),
        )

    def by(self, sine: sp.Expr, cosine: sp.Expr) -> Pair:
        """The pair turned further, by an angle that the target does not distinguish."""
        small = sine**2 / (1 + sp.Abs(cosine))
        versine = self.let("versine", sp.Piecewise((small, cosine > 0), (1 - cosine, True)))
        cost = self.let("cost", sp.Abs(self.lever * sine) + sp.Abs(self.beside) * versine)
        allowed = cost <= self.let("whole", self.allowance)
        s, c = (
            self.let(n, sp.Piecewise((value, allowed), (sp.Integer(k), True)))
            for n, value, k in (("sine", sine, 0), ("cosine", cosine, 1))
        )
        return self.pair + Pair(s, c)

    def by_half(self, half: sp.Expr) -> Pair:
        """The pair turned further, by twice the angle that has this tangent."""
        total = self.let("total", 1 + half**2)
        return self.by(
            self.let("by_s", 2 * half / total),
            self.let("by_c", (1 - half**2) / total),
        )

    def least(self, goal: Within) -> Pair:
        """The smallest turn that brings a point within reach, up to rounding of the target."""
        return self.by_half(self.half_to(goal))

    def half_to(self, goal: Within, side: sp.Expr | None = None) -> sp.Symbol:
        """The tangent of half of that turn, or of one to where the slope has the sign ``side``."""
        (x, y), (dx, dy) = goal.point, goal.rate
        square = self.let("square", x**2 + y**2)
        allowance = self.chain.size * ROUNDING
        low = self.let("low", sp.Max(0, goal.low - allowance) ** 2)
        high = self.let("high", (goal.high + allowance) ** 2)
        reached = sp.Max(low, sp.Min(high, square))
        miss = self.let("miss", square - reached)
        slope, bend = self.let("slope", x * dx + y * dy), self.let("bend", goal.bend)
        side = sign_of(slope) if side is None else side
        inner = self.let("inner", slope**2 - bend * miss)
        outer = self.let("outer", slope + side * sp.sqrt(sp.Max(inner, 0)))
        above, below = (
            self.let(n, sp.Piecewise((closest, inner < 0), (there, True)))
            for n, closest, there in (("above", slope, miss), ("below", 2 * bend, 2 * outer))
        )
        large = sp.Abs(above) >= sp.Abs(below)
        return self.let("half", choose(large, 0, -above / below))


@dataclass(frozen=True)
class Tangency:
    """A turn that is solved, except for the choice that its goal makes near a tangent."""

    chain: Chain
    at: Amplitude
    root: sp.Symbol
    width: sp.Symbol
    allowance: sp.Expr
    """By how much rounding may change the right side of the equation."""
    suffix: str
    free: Any
    """The flag that the turn is free, or false; then its angle is 0."""

    def pair(self, root: sp.Expr, width: sp.Expr) -> Pair:
        """The pair of the turn from its root and width."""
        both = self.at.pair(root, width)
        return Pair(choose(self.free, 0, both.s), choose(self.free, 1, both.c))

    def with_square(self, square: sp.Expr, tangent: sp.Symbol) -> Reached:
        """The pair for another ``square`` of the root, where the turn is tangent."""
        p, at, suffix = self.chain.program, self.at, self.suffix
        whole = sp.sqrt(4 * square + (at.above - at.below) ** 2)
        root = choose(tangent, sp.sqrt(square), self.root)
        root = p.let(f"kept{suffix}", root, nonnegative=True)
        width = p.let(f"span{suffix}", choose(tangent, whole, self.width), nonnegative=True)
        return Reached(self.pair(root, width), root, tangent)


@dataclass(frozen=True)
class Reached:
    """The pair that a goal has chosen, and the root that belongs to it.

    There is no root where the pair was turned further than the equation says.
    """

    pair: Pair
    root: sp.Expr | None
    tangent: sp.Basic = sp.false
    """The flag that the goal has chosen the root, near a tangent."""


class Goal:
    """What later joints must reach; it chooses among turns that differ by rounding."""

    def reached(self, turn: Tangency) -> Reached:
        """The turn within reach that is nearest to the computed one; without a goal, that one."""
        return Reached(turn.pair(turn.root, turn.width), turn.root)

    def anywhere(self, program: Program, suffix: str) -> Pair:
        """The pair of a turn that is free."""
        return Pair(sp.S.Zero, sp.S.One)

    def __repr__(self) -> str:
        return f"{type(self).__name__}()"


ANYWHERE = Goal()


class Preferred(NamedTuple):
    """A root that is preferred for a reason besides the reach of two links, and when it exists."""

    root: sp.Symbol
    exists: sp.Basic


@dataclass(frozen=True)
class LinksAtHeight(Goal):
    """Two links that have to reach a point at a ``height``, whose other coordinate a turn gives.

    That coordinate is the root of the turn.  A small root is sensitive to rounding, and links much
    shorter than the amplitude might seem too short.  The nearest of the ``preferred`` roots is
    taken if it differs from the computed one by no more than rounding.
    """

    l1: sp.Expr
    l2: sp.Expr
    height: sp.Expr
    preferred: Sequence[Preferred] = ()
    rounding: sp.Expr = ROUNDING
    """By how much rounding may change the right side of the equation, in units of its scale."""

    def square_in_reach(
        self, program: Program, at: Amplitude, scale: sp.Expr, suffix: str
    ) -> sp.Symbol:
        """The square of the root, brought within reach if rounding puts it out of reach."""
        square = at.below * at.above
        farthest = (self.l1 + self.l2) ** 2 - self.height**2
        nearest = (self.l1 - self.l2) ** 2 - self.height**2
        wanted = program.let(f"wanted{suffix}", sp.Max(0, nearest, sp.Min(square, farthest)))
        # with a name, as SymPy divides both sides of a condition by their content
        rounding = program.let(f"rounding{suffix}", 2 * at.h * scale * self.rounding)
        result = sp.Piecewise((wanted, sp.Abs(wanted - square) <= rounding), (square, True))
        least = rounding
        for root, exists in self.preferred:
            other = program.let(f"{root}_squared{suffix}", root**2)
            away = program.let(f"{root}_away{suffix}", sp.Abs(other - square))
            nearer = sp.And(exists, away <= least)
            result = program.let(
                f"{root}_held{suffix}", sp.Piecewise((other, nearer), (result, True))
            )
            least = program.let(
                f"{root}_least{suffix}", sp.Piecewise((away, nearer), (least, True))
            )
        return program.let(f"held{suffix}", result, nonnegative=True)

    def reached(self, turn: Tangency) -> Reached:
        """The pair of the turn, from the root within reach that is nearest to the computed one."""
        p, at, suffix = turn.chain.program, turn.at, turn.suffix
        tangent = nearly_tangent(p, turn.root, at.h, suffix)
        return turn.with_square(self.square_in_reach(p, at, turn.chain.size, suffix), tangent)


@dataclass(frozen=True)
class LinkAtHeight(Goal):
    """One link that ends at a ``height``; its other coordinate is the root of a turn.

    So the square of the root is known in two ways.  Near a tangent, the one that is less sensitive
    to rounding is taken: the one from the ``length`` of the link if it is shorter than the
    amplitude of the turn.
    """

    length: sp.Expr
    height: sp.Expr

    def reached(self, turn: Tangency) -> Reached:
        """The pair of the turn by the better of both squares."""
        p, at, suffix = turn.chain.program, turn.at, turn.suffix
        # not the square of the root, which is zero also where the turn is far out of reach
        square = p.let(f"apart{suffix}", sp.Abs((at.h - at.c) * (at.h + at.c)), nonnegative=True)
        # an earlier goal may have changed c by rounding, a large part in single precision
        rounding = sp.Min(8 * turn.chain.size * ROUNDING, at.h / 4)
        tangent = p.vanishes(
            f"tangent{suffix}",
            square - at.h * sp.Max(at.h / 2**16, rounding),
            at.h**2,
            "both solutions nearly coincide",
            squares=True,
        )
        height = p.let(f"height{suffix}", sp.Abs(self.height), nonnegative=True)
        own = sp.Max(0, (self.length - height) * (self.length + height))
        square = sp.Piecewise((own, self.length < at.h), (at.below * at.above, True))
        return turn.with_square(p.let(f"held{suffix}", square, nonnegative=True), tangent)


class Nearest(Goal):
    """A goal that changes the pair of a turn, by no more than rounding, where it is tangent."""

    def reached(self, turn: Tangency) -> Reached:
        chain, at, suffix = turn.chain, turn.at, turn.suffix
        found = turn.pair(turn.root, turn.width)
        # of which rounding changes the right side of the equation
        scale = turn.allowance / ROUNDING
        tangent = nearly_tangent(chain.program, turn.root, scale, suffix)
        near = self.nearest(
            Turn(
                chain=chain,
                pair=found,
                lever=turn.root,
                beside=at.c,
                allowance=turn.allowance,
                name=suffix,
                side=at.sigma * sign_of(at.c),
            ).renamed(found, f"{suffix}_1")
        )
        s, c = choose(tangent, near.s, found.s), choose(tangent, near.c, found.c)
        return Reached(Pair(s, c), None, tangent)

    def nearest(self, turn: Turn) -> Pair:
        """The pair that reaches the goal and is nearest to that of the turn."""
        raise NotImplementedError


@dataclass(frozen=True)
class Between(Nearest):
    """A point of a plane, linear in the pair of a turn, between two distances from the origin."""

    q: Callable[[Pair], sp.Matrix]
    low: sp.Expr
    high: sp.Expr

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with q between the distances."""
        x, y = turn.linear("q", self.q)
        return turn.least(Within(x, y, y[0] ** 2 + y[1] ** 2, self.low, self.high))


@dataclass(frozen=True)
class CoordinateWithin(Nearest):
    """A coordinate, linear in the pair of a turn, whose size is between ``least`` and ``most``."""

    value: Callable[[Pair], sp.Expr]
    most: sp.Expr
    least: sp.Expr = sp.S.Zero

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with the coordinate in range.

        A turn by an angle adds ``rate`` times its sine, less ``arm`` times its versine.
        """
        let, rounding = turn.let, turn.chain.size * ROUNDING
        s, c = sp.Dummy("s"), sp.Dummy("c")
        value = self.value(Pair(s, c))
        by_s, by_c = value.diff(s), value.diff(c)
        here = let("q", value.xreplace({s: turn.pair.s, c: turn.pair.c}))
        rate = let("rate", by_s * turn.pair.c - by_c * turn.pair.s)
        arm = let("arm", by_s * turn.pair.s + by_c * turn.pair.c)
        size = let("size", sp.Abs(here))
        wanted = sp.Max(self.least - rounding, sp.Min(size, self.most + rounding))
        step = let("step", sign_of(here) * (wanted - size))
        inner = let("inner", rate**2 - step * (2 * arm + step))
        above, below = (
            let(n, sp.Piecewise((farthest, inner < 0), (there, True)))
            for n, farthest, there in (
                ("above", rate, step),
                ("below", 2 * arm + step, rate + sign_of(rate) * sp.sqrt(sp.Max(inner, 0))),
            )
        )
        large = sp.Abs(above) >= sp.Abs(below)
        return turn.by_half(let("half", choose(large, 0, above / below)))


@dataclass(frozen=True)
class Links(Nearest):
    """Two links that have to reach the point q of their plane, linear in the pair of a turn."""

    q: Callable[[Pair], sp.Matrix]
    l1: sp.Expr
    l2: sp.Expr

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with q within reach."""
        return Between(self.q, sp.Abs(self.l1 - self.l2), self.l1 + self.l2).nearest(turn)


@dataclass(frozen=True)
class LinksAndWrist(Links):
    """Two links that reach q minus an offset, which a wrist turns.

    The ``axis`` of the wrist is linear in the pair too.  The offset is turned ``ahead`` of the
    direction of that axis, or with ``sigma`` of its opposite.
    """

    axis: Callable[[Pair], sp.Matrix]
    offset: sp.Expr
    ahead: Pair
    sigma: sp.Symbol = real("sigma_wrist")  # noqa: RUF009

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with the rest within reach.

        Steps that nearly keep the direction of the axis fail where a small turn reverses the axis.
        So there are also detours, which first move to where the axis has another direction.  Of all
        results the one that misses least is taken.
        """
        numbers = itertools.count(2)

        def moved(place: _Place, pair: Pair) -> _Place:
            return place.moved(pair, f"{turn.name}_{next(numbers)}")

        def follow(place: _Place, steps: Sequence[Callable[[_Place], Pair]]) -> _Place:
            for step in steps:
                place = moved(place, step(place))
            return place

        start = _Place(self, turn)
        best = follow(start, [_Place.closer] * 3)
        # steps may lead away from where the axis reverses, so the last detour begins anew
        for detour, begin in zip(_DETOURS, (best, moved(start, start.turn.pair)), strict=True):
            other = follow(begin, detour)
            best = moved(best, best.better_of(other.miss < best.miss, other))
        return best.turn.pair


@dataclass(frozen=True)
class _Place:
    """Two links and a wrist, as a turn has moved them."""

    goal: LinksAndWrist
    turn: Turn

    def moved(self, pair: Pair, name: str) -> _Place:
        return _Place(self.goal, self.turn.renamed(pair, name))

    def better_of(self, better: sp.Basic, other: _Place) -> Pair:
        """The pair of this place, or of the other one if it is better."""
        there, here = other.turn.pair, self.turn.pair
        return Pair(
            sp.Piecewise((there.s, better), (here.s, True)),
            sp.Piecewise((there.c, better), (here.c, True)),
        )

    def closer(self) -> Pair:
        """The smallest turn to within reach of the links, if the axis does not turn far."""
        return self.turn.least(self.within)

    @cached_property
    def miss(self) -> sp.Symbol:
        return self.turn.let("missed", self.within.miss)

    @cached_property
    def q(self) -> tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]:
        return self.turn.linear("q", self.goal.q)

    @cached_property
    def axis(self) -> tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]:
        return self.turn.linear("axis", self.goal.axis)

    @cached_property
    def wrist(self) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        """The sine between the axis and the normal of the plane, and the direction of the offset.

        It has none where the axis is normal to the plane.
        """
        (ax, ay), _ = self.axis
        turn, sigma = self.turn, self.goal.sigma
        h = turn.let("h", sp.sqrt(ax**2 + ay**2))
        u = direction(sigma * ay, sigma * ax, h, sp.Eq(h, 0)) + self.goal.ahead
        return h, turn.let("us", u.s), turn.let("uc", u.c)

    @cached_property
    def within(self) -> Within:
        """The goal for a small turn; rounding may turn an aligned wrist and its offset anywhere."""
        turn, offset = self.turn, self.goal.offset
        (qx, qy), (dqx, dqy) = self.q
        (ax, ay), (dax, day) = self.axis
        h, us, uc = self.wrist
        least = turn.let("fold", sp.Abs(self.goal.l1 - self.goal.l2))
        most = turn.let("full", self.goal.l1 + self.goal.l2)
        loose = h <= ROUNDING / 4
        spin = turn.let("spin", choose(loose, 0, (ax * day - ay * dax) / h**2))
        rate = turn.let("rate", offset * spin)
        # u only turns: the square of its length has no part in the bend
        straight = turn.let("straight", dqx**2 + dqy**2)
        bent = straight + rate * (spin * (qx * uc + qy * us) + 2 * (dqx * us - dqy * uc))
        apart = turn.let("apart", sp.Max(least - offset, offset - most))
        x, y, dx, dy, bend, low, high = (
            turn.let(n, sp.Piecewise((a, loose), (b, True)))
            for n, a, b in (
                ("x", qx, qx - offset * uc),
                ("y", qy, qy - offset * us),
                ("dx", dqx, dqx + rate * us),
                ("dy", dqy, dqy - rate * uc),
                ("bends", straight, bent),
                ("nearest", sp.Max(0, apart), least),
                ("farthest", most + offset, most),
            )
        )
        return Within((x, y), (dx, dy), bend, low, high)

    def aligned(self) -> Pair:
        """Turned so that the axis is as near to the normal of the plane as it gets."""
        return self.across(sp.S.Zero)

    def across(self, wanted: sp.Expr) -> Pair:
        """Turned so that the first coordinate of the axis, which changes, has the wanted value."""
        turn = self.turn
        (ax, _), (dax, _) = self.axis
        margin = turn.let("margin", sp.Max(0, (self.most - wanted) * (self.most + wanted)))
        rest = turn.let("rest", sign_of(dax) * sp.sqrt(margin))
        fixed = self.most <= VANISHING  # the axis is that of the turn
        return turn.by(
            turn.let("by_s", choose(fixed, 0, (dax * wanted - ax * rest) / self.most**2)),
            turn.let("by_c", choose(fixed, 1, (ax * wanted + dax * rest) / self.most**2)),
        )

    @cached_property
    def most(self) -> sp.Symbol:
        (ax, _), (dax, _) = self.axis
        return self.turn.let("most", sp.sqrt(ax**2 + dax**2))

    def directed(self) -> Pair:
        """Turned so that the axis of the wrist has the nearest direction that is within reach.

        A turn changes only one coordinate of the axis; where the other is zero up to rounding, the
        wrist is aligned.
        """
        goal, turn, chain = self.goal, self.turn, self.turn.chain
        (qx, qy), _ = self.q
        (_, ay), _ = self.axis
        _, us, uc = self.wrist
        there = turn.let(
            "there", sp.sqrt((qx - goal.offset * uc) ** 2 + (qy - goal.offset * us) ** 2)
        )
        reach = turn.let(
            "goal", sp.Min(sp.Max(there, sp.Abs(goal.l1 - goal.l2)), goal.l1 + goal.l2)
        )
        side = turn.let("side", sign_of(qx * us - qy * uc))
        r = turn.let("r", sp.sqrt(qx**2 + qy**2))
        past = Offset((qx, qy), r, goal.offset)
        back = -goal.ahead
        (vs, vc), (ws, wc) = (
            (turn.let(f"{n}s", v.s), turn.let(f"{n}c", v.c))
            for n, sign in (("v", 1), ("w", -1))
            for v in [past.leaving(chain, reach, sign * side, f"{n}_{turn.name}")[0] + back]
        )
        other = turn.let("other", goal.sigma * ay * vs) < 0  # the turn does not change ay
        vs, vc = (
            turn.let(n, sp.Piecewise((w, other), (v, True)))
            for n, v, w in (("to_s", vs, ws), ("to_c", vc, wc))
        )
        across = turn.let("across", choose(sp.Abs(ay) <= 16 * VANISHING, 0, ay * vc * sign_of(vs)))
        beyond = sp.Abs(across) >= self.most * sp.Abs(vs)
        limited = choose(beyond, self.most * sign_of(across), across / sp.Abs(vs))
        return self.across(turn.let("wanted", choose(sp.Eq(across, 0), 0, limited)))


_DETOURS = (
    (_Place.directed, _Place.closer, _Place.closer),
    (_Place.aligned, *[_Place.directed] * 2, *[_Place.closer] * 5),
)
