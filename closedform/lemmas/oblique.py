"""Turns near a tangent, before and in a wrist whose axes meet at any angle.

Two links have to reach a point minus an offset, and the wrist turns this offset about their axis.
The wrist also has to tilt as far as the target requires.  See :mod:`closedform.lemmas.tangent`.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import sympy as sp

from closedform.lemmas.offset import Offset
from closedform.lemmas.tangent import Links, LinksAndWrist, Turn, Within
from closedform.model.functions import real, sign_of
from closedform.model.lemma import label
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING, VANISHING

STEPS = 3
"""The number of steps that improve a turn; the error after a step is of the order of its square."""

ALIGNED = sp.Rational(1, 2**20)
"""The square of how far aside an axis may be for its direction to change faster than its offset."""


@dataclass(frozen=True)
class LinksAndObliqueWrist(Links):
    """Two links that reach q minus an ``offset``, which a wrist turns about their common axis z.

    The wrist turns about z, then follow the rotation ``onward``, another turn about z, and the
    constant vector ``last``, which has to point along ``axis``.  Only ``last`` is constant; the
    others may be linear in the pair.  ``middle`` is the angle of the second turn; ``sense`` is -1
    if it is zero where the axes are opposite.
    """

    axis: Callable[[Pair], sp.Matrix]
    onward: Callable[[Pair], sp.Matrix]
    last: sp.Matrix
    offset: Callable[[Pair], sp.Matrix]
    middle: sp.Symbol
    sense: int = 1

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with the rest within reach.

        Steps fail where a small turn reverses the direction of the axis.  There the wrist is nearly
        aligned, and its middle turn changes the axis as if its axes were at right angles.  If the
        turn decides whether it can be aligned, it turns to where the offset has a known direction.
        """
        start = _Wrist(self, turn)
        best = start.improved(turn.name)
        if start.can_be_aligned:
            name = f"{turn.name}_a"
            near = self._aligned(start).nearest(turn.renamed(turn.pair, name))
            detour = start.moved(turn.renamed(near, f"{name}_0"))
            best = best.better_of(detour, f"{name}b")
        if start.aligns_by_turn:
            for side, name in ((1, f"{turn.name}_l"), (-1, f"{turn.name}_r")):
                pair = start.directed(sp.Integer(side), name)
                detour = start.moved(turn.renamed(pair, f"{name}_to"))
                best = best.better_of(detour, f"{name}b")
        return best.turn.pair

    def _aligned(self, at: _Wrist) -> LinksAndWrist:
        """The same for a wrist that is nearly aligned, whose offset is constant."""
        (x, y, _), B = self.offset(at.turn.pair), at.onward[0]
        length = sp.sqrt(x**2 + y**2)
        last = sp.Matrix([B[1, 2], -B[0, 2]]) * self.sense
        last /= last.norm()
        ahead = Pair(sp.S.Zero, sp.S.One) if length == 0 else Pair(y / length, x / length)
        ahead -= Pair(last[1], last[0])
        return LinksAndWrist(
            q=self.q,
            l1=self.l1,
            l2=self.l2,
            axis=self.axis,
            offset=length,
            ahead=Pair(*map(sp.simplify, (ahead.s, ahead.c))),
            sigma=real(f"sigma_{label(self.middle)}"),
        )


@dataclass(frozen=True)
class _Wrist:
    """A wrist and the links before it, as a turn has moved them."""

    goal: LinksAndObliqueWrist
    turn: Turn

    def moved(self, turn: Turn) -> _Wrist:
        return _Wrist(self.goal, turn)

    def improved(self, name: str) -> _Wrist:
        """The wrist after some steps toward where the rest is within reach."""
        best = self
        for k in range(2, 2 * STEPS + 2, 2):
            tilted = best.moved(best.turn.renamed(best.turn.least(best.tilt), f"{name}_{k}"))
            other = tilted.moved(tilted.turn.renamed(tilted.closer(), f"{name}_{k + 1}"))
            best = best.better_of(other, f"{name}_{k}b")
        return best

    def better_of(self, other: _Wrist, name: str) -> _Wrist:
        """This wrist, or the other one if it misses less."""
        better = other.miss < self.miss
        s, c = (
            sp.Piecewise((there, better), (here, True))
            for there, here in zip(_both(other.turn.pair), _both(self.turn.pair), strict=True)
        )
        return self.moved(self.turn.renamed(Pair(s, c), name))

    @cached_property
    def miss(self) -> sp.Symbol:
        """How far the rest is out of reach; the middle joint changes by the root of a tilt."""
        let, size = self.turn.let, self.turn.chain.size
        steeper = let("steeper", sp.Max(0, self.tilt.miss - 2 * ROUNDING * size))
        turned = sp.sqrt(size * steeper)
        if self.aligns_by_turn:
            turned = sp.Piecewise((steeper, self._near), (turned, True))
        return let("missed", turned + self.reach.miss)

    def along(
        self, name: str, value: Callable[[Pair], sp.Matrix]
    ) -> tuple[list[sp.Expr], list[sp.Expr]]:
        """The coordinates of a vector that is linear in the pair, and their rates."""
        s, c = sp.Dummy("s"), sp.Dummy("c")
        pair = self.turn.pair
        here = {s: pair.s, c: pair.c}
        entries = list(value(Pair(s, c)))
        rates = [e.diff(s) * pair.c - e.diff(c) * pair.s for e in entries]
        return (
            [self._named(f"{name}{i}", e.xreplace(here)) for i, e in enumerate(entries)],
            [self._named(f"d{name}{i}", e) for i, e in enumerate(rates)],
        )

    def _named(self, name: str, value: sp.Expr) -> sp.Expr:
        return value if value.is_number else self.turn.let(name, value)

    @cached_property
    def axis(self) -> tuple[list[sp.Expr], list[sp.Expr]]:
        return self.along("axis", self.goal.axis)

    @cached_property
    def onward(self) -> tuple[sp.Matrix, sp.Matrix]:
        value, rate = self.along("onward", self.goal.onward)
        return sp.Matrix(3, 3, value), sp.Matrix(3, 3, rate)

    @cached_property
    def tilt(self) -> Within:
        """How far the wrist tilts: a triangle on the sphere, of the axes and the direction.

        One of its sides changes with the turn.  It is compared on the scale of lengths.
        """
        (*_, az), (*_, daz) = self.axis
        B, dB = self.onward
        w, size, turn = self.goal.last, self.turn.chain.size, self.turn
        z, dz, other = (az, daz, B[2, 2]) if dB.is_zero_matrix else (B[2, 2], dB[2, 2], az)
        level = turn.let("level", other * w[2])
        square = (1 - other) * (1 + other)
        reach = turn.let("tilting", sp.sqrt(w[0] ** 2 + w[1] ** 2) * sp.sqrt(sp.Max(0, square)))
        zero, tilted = sp.S.Zero, z - level
        if self.aligns_by_turn:
            (sine, cosine), _ = self._apart
            spread = -dz / sp.Max(self._onward_across, VANISHING)
            tilted, dz, reach = (
                sp.Piecewise((near, self._near), (far, True))
                for near, far in ((sine, tilted), (cosine * spread, dz), (self.across, reach))
            )
        point = (turn.let("tilted", size * tilted), zero)
        rate = (turn.let("dtilted", size * dz), zero)
        found = Within(point, rate, rate[0] ** 2, zero, turn.let("most", size * reach))
        return self._first_apart(found) if self.aligns_by_turn else found

    def _first_apart(self, otherwise: Within) -> Within:
        """How far the first two axes must be apart, where they are nearly in line.

        Their cosine does not say so, but the sine between them is at least that by which the
        direction of the outer axes differs from a right angle, or from the angle of the last two.
        """
        let, w, size = self.turn.let, self.goal.last, self.turn.chain.size
        (*_, az), _ = self.axis
        B, dB = self.onward
        in_line = 4 * self._onward_across <= 1
        least = let("least_apart", sp.Abs(az - B[2, 2] * w[2]) / sp.sqrt(w[0] ** 2 + w[1] ** 2))
        (x, y), (dx, dy) = otherwise.point, otherwise.rate
        names = "apart_x", "apart_y", "dapart_x", "dapart_y", "apart_low", "apart_high"
        x, y, dx, dy, low, high = (
            let(name, sp.Piecewise((size * there, in_line), (here, True)))
            for name, there, here in zip(
                names,
                (B[2, 0], B[2, 1], dB[2, 0], dB[2, 1], least, 2),
                (x, y, dx, dy, otherwise.low, otherwise.high),
                strict=True,
            )
        )
        return Within((x, y), (dx, dy), let("apart_bend", dx**2 + dy**2), low, high)

    @property
    def aligns_by_turn(self) -> bool:
        """Whether the turn changes the angle between the first two axes of the wrist.

        Then it decides whether the outer axes can coincide.
        """
        return not self.onward[1].is_zero_matrix

    @cached_property
    def _onward_across(self) -> sp.Symbol:
        """The sine between the first two axes of the wrist."""
        B, _ = self.onward
        return self.turn.let("onward_across", sp.sqrt(B[2, 0] ** 2 + B[2, 1] ** 2))

    @cached_property
    def _near(self) -> sp.Basic:
        """Whether the outer axes are nearly in line, and the smallest angle between them.

        The angle is at least the difference of those of neighbouring axes.  Cosines of small angles
        do not say so, but sines do.
        """
        w = self.goal.last
        return sp.And(4 * self.across <= sp.sqrt(w[0] ** 2 + w[1] ** 2), self._apart[1] > 0)

    @cached_property
    def _apart(self) -> tuple[tuple[sp.Expr, sp.Expr], sp.Expr]:
        """Sine and cosine of the least angle between the outer axes, or to where they are opposite.

        And the cosine, without its sign.
        """
        let, w, B = self.turn.let, self.goal.last, self.onward[0]
        (*_, az), _ = self.axis
        side = let("in_line", sign_of(az))
        s, c, sine, cosine = self._onward_across, B[2, 2], sp.sqrt(w[0] ** 2 + w[1] ** 2), w[2]
        apart = (
            let("apart_s", s * cosine - side * c * sine),
            let("apart_c", c * cosine + side * s * sine),
        )
        return apart, side * apart[1]

    def closer(self) -> Pair:
        """The smallest turn to within reach of the links, if the middle joint follows it.

        At the limit of the tilt a tiny turn moves the middle joint by its root.  So this is a step
        along the curve of both; to its second order, the turn is that part of it.
        """
        half, middle = self.turn.half_to(self.reach), self._middle
        return self.turn.by_half(self.turn.let("part", half * (middle.part - middle.curve * half)))

    @cached_property
    def _ends(self) -> list[tuple[list[sp.Expr], list[sp.Expr]]]:
        """The point q and the offset, with their rates."""
        return [self.along(n, e) for n, e in (("q", self.goal.q), ("o", self.goal.offset))]

    @cached_property
    def reach(self) -> Within:
        """The end of the links, where the wrist has the tilt that is nearest to the wanted one.

        Its rate is that along the curve of the turn and the middle joint.
        """
        let, goal = self.turn.let, self.goal
        ((qx, qy, *_), (dqx, dqy, *_)), ((ox, oy, *_), (dox, doy, *_)) = self._ends
        (us, uc), spin = self._lift
        ex, ey = let("ex", uc * ox - us * oy), let("ey", us * ox + uc * oy)
        part = self._middle.part
        dx = let("dx", part * (dqx - uc * dox + us * doy) + spin * ey)
        dy = let("dy", part * (dqy - us * dox - uc * doy) - spin * ex)
        least, most = let("fold", sp.Abs(goal.l1 - goal.l2)), let("full", goal.l1 + goal.l2)
        bend = let("bends", dx**2 + dy**2)
        x, y = let("x", qx - ex), let("y", qy - ey)
        if not (self.can_be_aligned or self.aligns_by_turn):
            return Within((x, y), (dx, dy), bend, least, most)
        # rounding may turn an aligned wrist and its offset anywhere
        loose = self.across <= ROUNDING / 4
        offset = let("length", sp.sqrt(ox**2 + oy**2))
        apart = let("apart", sp.Max(0, least - offset, offset - most))
        if self.aligns_by_turn:
            # or a little, if it is nearly aligned
            spare = let("spare", offset * ROUNDING / 8 / sp.Max(self.across, VANISHING))
            least, most = sp.Max(0, least - spare), most + spare
        x, y, dx, dy, low, high = (
            let(f"{n}_any", sp.Piecewise((free, loose), (held, True)))
            for n, free, held in (
                ("x", qx, x),
                ("y", qy, y),
                ("dx", dqx, dx),
                ("dy", dqy, dy),
                ("low", apart, least),
                ("high", most + offset, most),
            )
        )
        return Within((x, y), (dx, dy), let("bends_any", dx**2 + dy**2), low, high)

    def directed(self, side: sp.Expr, name: str) -> Pair:
        """Turned so that the wrist can turn the offset to where the links reach.

        The angle between the last two axes is constant.  If the first turn of the wrist is known,
        this is an equation that is linear in the pair.
        """
        turn, goal = self.turn.renamed(self.turn.pair, name), self.goal
        let, size = turn.let, turn.chain.size
        ((qx, qy, *_), _), ((ox, oy, *_), _) = self._ends
        (ax, ay, az), _ = self.axis
        B, dB = self.onward
        (x, y), least, most = self.reach.point, sp.Abs(goal.l1 - goal.l2), goal.l1 + goal.l2
        wanted = let("reached", sp.Max(least, sp.Min(sp.sqrt(x**2 + y**2), most)))
        r, e = let("r", sp.sqrt(qx**2 + qy**2)), let("e", sp.sqrt(ox**2 + oy**2))
        u, _ = Offset((qx, qy), r, e).leaving(turn.chain, wanted, side, f"to_{turn.name}")
        us, uc = let("us", u.s), let("uc", u.c)
        length = sp.Max(e, VANISHING * size)
        s, c = (
            let("lift_s", (ox * us - oy * uc) / length),
            let("lift_c", (ox * uc + oy * us) / length),
        )
        last = sp.Matrix([let("px", c * ax + s * ay), let("py", c * ay - s * ax), az])
        missed = let("beside", B[:, 2].dot(last) - goal.last[2])
        rate = let("rate", dB[:, 2].dot(last))
        small = 2 * sp.Abs(missed) <= sp.Abs(rate)
        return turn.by_half(let("half", sp.Piecewise((-missed / (2 * rate), small), (0, True))))

    @cached_property
    def can_be_aligned(self) -> bool:
        """Whether the outer axes of the wrist can coincide, at any turn."""
        B, dB = self.onward
        other = self.goal.sense * self.goal.last[2]
        return bool(dB.is_zero_matrix and sp.simplify(B[2, 2] - other) == 0)

    @cached_property
    def across(self) -> sp.Symbol:
        """The sine between the outer axes."""
        (ax, ay, _), _ = self.axis
        return self.turn.let("across", sp.sqrt(ax**2 + ay**2))

    @cached_property
    def _middle(self) -> _Middle:
        """The middle joint of the wrist that follows from the turn, and how both change."""
        let, w = self.turn.let, self.goal.last
        (*_, az), (*_, daz) = self.axis
        B, dB = self.onward
        a, b = let("a", w[0] * B[2, 1] - w[1] * B[2, 0]), let("b", w[0] * B[2, 0] + w[1] * B[2, 1])
        h = let("h", sp.sqrt(a**2 + b**2))
        below, above = self._margins(h, az)
        rest = let("rest", sp.sqrt(below) * sp.sqrt(above))
        held = let("held", (above - below) / 2)
        side = self.goal.sense * real(f"sigma_{label(self.goal.middle)}")
        whole = let("square_h", sp.Max(h**2, VANISHING**2))
        s2 = let("s2", (a * held + side * b * rest) / whole)
        c2 = let("c2", (b * held - side * a * rest) / whole)
        v = sp.Matrix([c2 * w[0] - s2 * w[1], s2 * w[0] + c2 * w[1], w[2]])
        moved, turned = dB * v, B * sp.Matrix([-v[1], v[0], 0])
        tilted = let("tilt_rate", daz - moved[2])
        slant = let("slant", sp.Max(rest, VANISHING))
        square = let("steepness", slant**2 + tilted**2)
        steep = let("steep", sp.sqrt(square))
        part, by = let("along", slant / steep), let("by", -side * tilted / steep)
        dx, dy = (let(f"dlast{n}", part * moved[i] + by * turned[i]) for i, n in enumerate("xy"))
        x, y, _ = B * v
        last = (let("lastx", x), let("lasty", y)), (dx, dy)
        return _Middle(last, part, let("curve", held * tilted / square))

    def _margins(self, h: sp.Expr, az: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """How far the tilt is from its largest value, and from its smallest.

        Where the outer axes are nearly aligned, the axis across says it more accurately.
        """
        let, w, sense = self.turn.let, self.goal.last, self.goal.sense
        (ax, ay, _), _ = self.axis
        B, _ = self.onward
        c = let("right", az - B[2, 2] * w[2])
        margins = h - c, h + c
        if self.can_be_aligned:
            size = sp.Abs(az)
            opposite = let("opposite", size - sense * az)
            near = let("near", (ax**2 + ay**2) / (1 + size) + opposite)
            margins = (near, 2 * h - near)[::sense]
        elif self.aligns_by_turn:
            (sine, _), cosine = self._apart
            least = sp.Abs(sine)
            near = let(
                "near", (self.across - least) * (self.across + least) / (sp.Abs(az) + cosine)
            )
            below, above = sp.And(self._near, az > 0), sp.And(self._near, az < 0)
            margins = (
                sp.Piecewise((near, below), (2 * h - near, above), (margins[0], True)),
                sp.Piecewise((near, above), (2 * h - near, below), (margins[1], True)),
            )
        below, above = (
            let(f"{n}_most", sp.Max(0, sp.Min(margin, 2 * h)))
            for n, margin in zip(("below", "above"), margins, strict=True)
        )
        return below, above

    @cached_property
    def _lift(self) -> tuple[tuple[sp.Expr, sp.Expr], sp.Expr]:
        """Sine and cosine of the first turn of the wrist, and its rate."""
        let, (ax, ay, _), (dax, day, _) = self.turn.let, *self.axis
        ((x, y), (dx, dy)), part = self._middle.last, self._middle.part
        seen = let("seen", sp.Max(ax**2 + ay**2, VANISHING**2))
        there = let("there", sp.Max(x**2 + y**2, VANISHING**2))
        spin = let("spin", part * (ax * day - ay * dax) / seen - (x * dy - y * dx) / there)
        both = let("both", sp.sqrt(seen) * sp.sqrt(there))
        us, uc = let("us", (ay * x - ax * y) / both), let("uc", (ax * x + ay * y) / both)
        return (us, uc), spin


class _Middle(NamedTuple):
    """A step along the curve of a turn and of the middle joint of a wrist, which follows from it.

    ``last`` is across the first axis of the wrist, with its rate along the curve.  The turn has a
    ``part`` in a step, less ``curve`` times half the square of the step.
    """

    last: tuple[tuple[sp.Expr, sp.Expr], tuple[sp.Expr, sp.Expr]]
    part: sp.Expr
    curve: sp.Expr


@dataclass(frozen=True)
class LinksPastTurn(Links):
    """Two links that reach q minus an ``offset``, after the middle turn of such a wrist.

    The turn moves ``last``, which the first turn of the wrist brings to the direction ``axis``;
    the latter and q depend on no pair.  The offset is linear in the pair, or constant.
    """

    axis: sp.Matrix
    offset: Callable[[Pair], sp.Matrix]
    last: Callable[[Pair], sp.Matrix]

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with q within reach.

        Near alignment the component of ``last`` along the first axis of the wrist says little of
        the component across it, which has to be that of ``axis``.
        """
        across = turn.let("aside", sp.sqrt(self.axis[0] ** 2 + self.axis[1] ** 2))
        turn = turn.renamed(self._as_far(turn, across), f"{turn.name}_2")
        turn = replace(turn, allowance=turn.let("play", turn.allowance * across))
        for k in range(3, STEPS + 3):
            turn = turn.renamed(self._closer(turn), f"{turn.name}_{k}")
        return turn.pair

    def _as_far(self, turn: Turn, across: sp.Symbol) -> Pair:
        """Turned so that the component across the first axis of the wrist has the wanted value.

        There are two such turns, and rounding may hide on which side of their middle this one is;
        the branch says it.
        """
        size = turn.chain.size
        x, y = turn.linear("far", lambda pair: size * self.last(pair))
        goal = turn.let("goal", size * across)
        level = self.last(turn.pair)[2]
        grows = turn.let("grows", level * (level - self.last(Pair(sp.S.Zero, sp.S.Zero))[2]))
        side = turn.let("ahead", turn.side * sign_of(grows))
        within = Within(x, y, y[0] ** 2 + y[1] ** 2, goal, goal)
        return turn.by_half(turn.half_to(within, side))

    def _closer(self, turn: Turn) -> Pair:
        """Turned so that the offset is where the links reach, by the rates at this turn.

        If the axis of the turn is parallel to that of the links, this is exact.
        """
        let, chain = turn.let, turn.chain
        (x, y), (dx, dy) = turn.linear("last", self.last)
        qx, qy = list(self.q(turn.pair))[:2]
        there = let("there", sp.Max(x**2 + y**2, VANISHING**2))
        both = let("both", sp.sqrt(self.axis[0] ** 2 + self.axis[1] ** 2) * sp.sqrt(there))
        both = let("lengths", sp.Max(both, VANISHING**2))
        us = let("us", (self.axis[1] * x - self.axis[0] * y) / both)
        uc = let("uc", (self.axis[0] * x + self.axis[1] * y) / both)
        spin = let("spin", (y * dx - x * dy) / there)
        (ox, oy), rate = turn.linear("off", self.offset)
        ex, ey = (let(n, v) for n, v in zip(("ex", "ey"), _turned(us, uc, (ox, oy)), strict=True))
        r, e = let("r", sp.sqrt(qx**2 + qy**2)), let("e", sp.sqrt(ox**2 + oy**2))
        here = let("here", sp.sqrt((qx - ex) ** 2 + (qy - ey) ** 2))
        wanted = let("goal", sp.Min(sp.Max(here, sp.Abs(self.l1 - self.l2)), self.l1 + self.l2))
        side = let("side", sign_of(qx * ey - qy * ex))
        v, _ = Offset((qx, qy), r, e).leaving(chain, wanted, side, f"past_{turn.name}")
        vs, vc = let("vs", v.s), let("vc", v.c)
        sine, cosine = let("dots", vs * ex - vc * ey), let("dotc", e + vc * ex + vs * ey)
        half = let("half", sine / sp.Max(cosine, VANISHING * e) / spin)
        still = sp.Or(sp.Eq(e, 0), sp.Eq(spin, 0))
        if rate != (0, 0):
            ahead = [let(n, v) for n, v in zip("fg", _turned(us, uc, rate), strict=True)]
            moved = turn.renamed(turn.pair, f"{turn.name}_by_rate")
            by_rate = moved.half_to(self._within((qx, qy), (ex, ey), spin, ahead))
            aside = there > ALIGNED
            half = let("half_of", sp.Piecewise((by_rate, aside), (half, True)))
            still = sp.And(still, sp.Not(aside))
        found = turn.by_half(half)
        still = sp.Or(sp.Eq(wanted, here), still)
        s, c = (
            sp.Piecewise((now, still), (then, True))
            for now, then in zip(_both(turn.pair), _both(found), strict=True)
        )
        return Pair(s, c)

    def _within(
        self,
        q: tuple[sp.Expr, sp.Expr],
        e: tuple[sp.Expr, sp.Expr],
        spin: sp.Expr,
        ahead: Sequence[sp.Expr],
    ) -> Within:
        """Where the links reach, if the offset is e and both turns move it: by spin, and ahead."""
        x, y = q[0] - e[0], q[1] - e[1]
        dx, dy = spin * e[1] - ahead[0], -spin * e[0] - ahead[1]
        bend = dx**2 + dy**2 + spin**2 * (x * e[0] + y * e[1])
        return Within((x, y), (dx, dy), bend, sp.Abs(self.l1 - self.l2), self.l1 + self.l2)


def _turned(s: sp.Expr, c: sp.Expr, v: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    return c * v[0] - s * v[1], s * v[0] + c * v[1]


def _both(pair: Pair) -> tuple[sp.Expr, sp.Expr]:
    return pair.s, pair.c


__all__ = ["LinksAndObliqueWrist", "LinksPastTurn"]
