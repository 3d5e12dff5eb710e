"""Proposes chains for arms of six joints by where their axes are parallel, or meet in a point.

- Three parallel axes leave the component along their direction to the other joints.  They are the
  first or the last three, or three of the middle; two neighbours of the others meet, or see
  :mod:`closedform.scaffold.chains.around_parallel`.
- Three axes in the middle that meet in a point leave its distance from where two others meet; if
  these are skew, an equation of degree 4 is left.

Each also for the arm seen from its tool.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.scaffold.chains.around_parallel import AroundParallelMaker, Beside
from closedform.scaffold.chains.chainlinks import Single, Singles, parallel
from closedform.scaffold.chains.ellipse import folds
from closedform.scaffold.chains.maker import (
    Z,
    followed,
    heading,
    norm,
    point,
    sine_cosine,
    times,
    turning,
)
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.chains.wrists import Carried, is_normal
from closedform.scaffold.source import GIVEN, source


@dataclass(frozen=True)
class TurnGoal:
    """What a turn has to leave within reach of two links: a wrist, and what it turns.

    That is the ``lengths`` of the links and, as it is written with ``{}`` for the pair of the turn,
    the ``point`` that the wrist carries, the direction ``axis`` of its last axis, the rotation
    ``onward`` from its first joint to its second, and the ``offset`` from the end of the links to
    the point, which is ``constant`` or follows from the turn.
    """

    wrist: Sequence[Single]
    lengths: Sequence[str]
    point: str
    axis: str
    offset: str = ""
    onward: str = ""
    constant: sp.Matrix | None = None

    @property
    def is_normal(self) -> bool:
        """Whether neighbours among the axes of the wrist are at right angles, whatever the turn."""
        return self.constant is not None and is_normal(self.wrist)

    @property
    def numbers(self) -> tuple[str, str]:
        """The length of the offset of such a wrist, and how far it is ahead of the first axis."""
        assert self.constant is not None
        e, w = self.wrist[0].end * Z, self.constant
        if e[1].is_negative:
            e = -e
        length = norm(w[:2, 0])
        angle = (heading(w) if length != 0 else sp.S.Zero) - heading(e)
        sine, cosine = sine_cosine(angle + sp.pi / 2)
        return source(length), f"Pair({source(sine)}, {source(cosine)})"


@dataclass
class SixMaker(AroundParallelMaker):
    """Writes the lines for six joints that have no spherical wrist and no spherical shoulder."""

    def parallel_middle(self, arm: Singles) -> str:
        """Axes 2, 3 and 4 are parallel, and axes 5 and 6 meet or are skew."""
        self._require_parallel(arm, 1)
        found = arm.met(4, 2)
        if found is None:
            return self.around_parallel(arm, 1)
        arm = found
        one, two, three, four, five, six = arm.joints
        self.require(
            not parallel(one) and not parallel(four),
            f"axes {one.number} and {two.number} or {four.number} and {five.number} are parallel",
            "Three parallel axes need others that are not parallel to them.",
        )
        R = self.centre(arm)
        w = four.shift
        lift = replace(four, turn=two.turn + three.turn + four.turn)
        left = times(one.end.T, f"(turned({{}}).T * {times(arm.lead[:3, :3].T, R)})")
        place = times(one.end.T, f"(turned({{}}).T * p - {source(one.shift)})")
        goal = TurnGoal(
            [lift, five, six],
            Beside(arm, 1, self.least).lengths,
            place,
            self.last_axis(arm, left),
            constant=w,
        )
        links = self._links(goal)
        beside = two.shift[2] + three.shift[2] + w[2]
        q, pair = self._seen_in_plane(one, beside, links)
        self.add(f"left1 = ik.matrix('left1', {left.format(pair)})")
        M = self.without_tool(arm.tool[:3, :3], "left1")
        self._reach(goal, q, f"{pair}.lever")
        self.orientation([lift, five, six], M)
        self.vector("q", f"{q} - turned({self.lifted}) * {source(w)}", "q2")
        self.links_to_q(two, three)
        return Beside(arm, 1, self.least).told("{} and {} meet")

    def parallel_first(self, arm: Singles) -> str:
        """Axes 1, 2 and 3 are parallel, and axes 5 and 6 or 4 and 5 meet."""
        self._require_parallel(arm, 0)
        self.require(
            not parallel(arm.joints[2]),
            "four neighbours are parallel",
            "At most three parallel axes determine each other.",
        )
        # the direction of two others that are parallel gives a joint, even if axes meet too
        at_end, inside = (
            None if parallel(arm.joints[other]) else arm.met(start, 2)
            for start, other in ((4, 3), (3, 4))
        )
        found = at_end or inside
        if found is None:
            return self.around_parallel(arm, 0)
        one, two, three, four, five, six = found.joints
        height = sum((s.shift[2] for s in (one, two, three)), sp.S.Zero)
        lift = replace(three, turn=one.turn + two.turn + three.turn)
        R = self.centre(found)
        p = point("p")
        M = self.without_tool(found.tool[:3, :3], times(found.lead[:3, :3].T, R))
        if at_end is not None:
            s, g = four.shift, three.end.T * Z
            a, b = turning(s, g)
            before = times(three.end, "turned({})")
            offset = f"{source(three.shift)} + {{}} * {source(s)}"
            goal = TurnGoal(
                wrist=[lift, five, six],
                lengths=Beside(found, 0, self.least).lengths,
                point="p",
                axis=f"({M})[:, 2]",
                offset=offset.format(before),
                onward=followed(before, four.end),
            )
            sides = a, b, p[2] - height - g[2] * s[2]
            fourth = self._turn(four, sides, self._links(goal))
            self.add(f"R_before = {before.format(fourth)}")
            self.vector("to_end", offset.format("R_before"))
            self._reach(goal, "p", f"{fourth}.lever")
            self.wrist_about(lift, five, six, M, followed("R_before", four.end))
        else:
            self.add(f"M = ik.matrix('M', {M})")
            t = five.end.T * five.shift
            u = sp.Matrix([sp.Symbol(f"M[2, {i}]") for i in range(3)])
            a, b = turning(u, t)
            place = f"p - M * turned({{}}).T * {source(t)}"
            goal = TurnGoal(
                [lift, four, five],
                Beside(found, 0, self.least).lengths,
                place,
                f"M * turned({{}}).T * {source(five.end.T * Z)}",
                constant=three.shift,
            )
            sixth = self._turn(six, (a, b, p[2] - height - t[2] * u[2]), self._links(goal))
            self.vector("p", place.format(sixth), "p3")
            left = followed(f"M * turned({sixth}).T", five.end.T)
            self.add(f"left1 = ik.matrix('left1', {left})")
            self._reach(goal, "p", f"{sixth}.lever")
            self.orientation([lift, four, five], "left1")
            self.vector("to_end", source(three.shift))
        self.vector("q", f"p - turned({self.lifted}) * to_end")
        self.links_to_q(one, two)
        meeting = (five, six) if at_end is not None else (four, five)
        text = "{} and {} meet" if meeting[0] is four else "{1} and {2} meet"
        return Beside(found, 0, self.least).told(text)

    def meeting_middle(self, arm: Singles) -> str:
        """Axes 2, 3 and 4 meet in a point, and axes 5 and 6 meet."""
        numbers = [j.number for j in arm.joints]
        found = arm.met(1, 3)
        if found is None:
            raise NoChainError(
                "axes {1}, {2} and {3} do not meet in a point".format(*numbers),
                "Three neighbouring axes in the middle have to meet in a point.",
            )
        met = found.met(4, 2)
        if parallel(found.joints[4]):
            outer, middle = "are parallel", self._between_parallel(found)
        elif met is not None:
            outer, middle = "meet", self._between_meeting(met)
        else:
            outer, middle = "are skew", self._between_skew(found)
        self.add(f"left1 = ik.matrix('left1', {middle})")
        self.orientation(found.joints[1:4], "left1")
        text = "axes {1}, {2} and {3} meet in a point, {4} and {5} " + outer
        return text.format(*numbers)

    def _between_meeting(self, found: Singles) -> str:
        """Solve joints 1, 5 and 6 where the last two meet; return what they leave of the target.

        The distance of both points gives joint 1.
        """
        one, _, _, four, five, six = found.joints
        self._seen_from_tool(found)
        s, t, p = one.shift, four.shift, point("p")
        self.add("p_norm = ik.let('p_norm', sqrt(p.dot(p)))")
        far = sp.Symbol("p_norm")
        c = (far**2 + sp.simplify(s.dot(s) - t.dot(t))) / 2 - s[2] * p[2]
        size = sp.sqrt(sp.simplify(t.dot(t)))
        to_target = f"M.T * (turned({{}}) * {source(s)} - p)"
        v, g, w = point("to_target"), five.end.T * Z, -(four.end.T * t).applyfunc(sp.simplify)
        self.ahead_of_turn(to_target.format("pair"), w, g[2])
        sides = (*turning(s, p), c)
        first = self._turn(one, sides, "seen_across", scale=source(size / 2), by_size=True)
        self.vector("to_target", to_target.format(first))
        sixth = self._turn(six, (*turning(v, g), w[2] - g[2] * v[2]))
        self.vector("to_target", times(five.end, f"(turned({sixth}) * to_target)"), "to_target2")
        because = (
            f"{{{self.unknowns[one.number]}: -2*ik.size, "
            f"{self.unknowns[six.number]}: -to_target[2] - ({source(w[2])})}}"
        )
        fifth = self._rotate(five, "to_target", source(w[:2, 0]), because)
        if w.has(GIVEN):  # which may bring the point to this axis, where errors of turns remain
            missed = f"sqrt(to_target[0]**2 + to_target[1]**2) - {source(norm(w[:2, 0]))}"
            meaning = f"the point is as far from axis {five.number} as the target"
            self.add(f"ik.program.match({missed}, ik.size, '{meaning}')")
        middle = times(one.end.T, f"(turned({first}).T * M)") + f" * turned({sixth}).T"
        middle = f"{followed(middle, five.end.T)} * turned({fifth}).T"
        return followed(middle, four.end.T)

    def _between_skew(self, found: Singles) -> str:
        """The same where axes 5 and 6 are skew: an equation of degree 4 for joint 1.

        Joint 6 changes neither how far the point is along its axis nor how far it is from its
        origin.  Both are linear in the sine and the cosine of joint 5, and in those of joint 1.
        """
        one, _, _, four, five, six = found.joints
        v, w, s = -(four.end.T * four.shift).applyfunc(sp.simplify), five.end * Z, five.shift
        low, high = sorted((five.number, six.number))
        if self.degree < 4:
            raise NoChainError(
                f"axes {low} and {high} do not meet",
                "Besides the three axes, two neighbouring axes have to meet; otherwise an equation "
                "of degree 4 remains.",
                degree=4,
            )
        ahead = replace(five, shift=-(five.end.T * s), end=five.end.T)
        if folds(ahead, replace(four, shift=v)):
            raise NoChainError(
                f"the point where three axes meet can come to axis {six.number}, where three "
                f"solutions meet",
                "The known chain loses digits there.  Use ssik for a numeric inverse.",
                degree=4,
            )
        seen, p = one.shift, point("p")
        turned = sp.Matrix([turning(w, v)[::-1], turning(s, v)[::-1]])
        lever = sp.Abs(turned.det() / norm(v[:2, 0])).simplify()
        self.require_long(found, lever, (low, high))
        self._seen_from_tool(found)
        axis = sp.Matrix([sp.Symbol(f"M[{i}, 2]") for i in range(3)])
        self.add("square = ik.coordinate('square', p.dot(p))")
        lengths = sp.simplify(v.dot(v) + s.dot(s) - seen.dot(seen)) - sp.Symbol("square")
        levels = (
            w.dot(s) - axis.dot(p) + axis[2] * seen[2] - v[2] * w[2],
            lengths / 2 + p[2] * seen[2] - v[2] * s[2],
        )
        first = self.met_by_ellipse(one, turned, levels, (seen, (axis, p)))
        fifth = self.on_ellipse(five, one)
        self.vector("to_target", f"M.T * (turned({first}) * {source(seen)} - p)")
        at_end = f"(turned({fifth}).T * {source(v)} - {source(s)})"
        self.vector("to_end", times(five.end.T, at_end))
        self.add(f"play = ik.amplified_over({source(lever)})")
        for n in ("to_target", "to_end"):
            self.add(f"radius_{n} = ik.let('radius_{n}', sqrt({n}[0]**2 + {n}[1]**2))")
        meaning = "'the pose is one of the arm'"
        for miss in ("to_target[2] - to_end[2]", "radius_to_target - radius_to_end"):
            self.add(f"ik.program.match({miss}, play, {meaning}, rounding=ik.rounding)")
        both = [
            f"2*({source(b)}) + (to_target[2] + to_end[2])*({source(a)})"
            for a, b in zip(turned.row(0), turned.row(1), strict=True)
        ]
        because = f"{{{self.unknown(five)}: ({', '.join(both)})}}"
        sixth = self._rotate(six, "to_target", "to_end", because)
        middle = times(one.end.T, f"(turned({first}).T * M)") + f" * turned({sixth}).T"
        middle = f"{followed(middle, five.end.T)} * turned({fifth}).T"
        return followed(middle, four.end.T)

    def _between_parallel(self, found: Singles) -> str:
        """The same where axes 5 and 6 are parallel: the component along them gives joint 1."""
        one, _, _, four, five, six = found.joints
        self.require(five.end == sp.eye(3), "its last two axes are opposite", "Turn a frame by pi.")
        self._seen_from_tool(found)
        along = sp.Matrix([sp.Symbol(f"M[{i}, 2]") for i in range(3)])
        s, u, p = one.shift, five.shift, point("p")
        t = (four.end.T * four.shift).applyfunc(sp.simplify)
        c = along.dot(p) - t[2] - u[2] - along[2] * s[2]
        lengths = ", ".join(source(norm(x[:2, 0])) for x in (u, t))
        self.add(f"links = Links(lambda pair: M.T * (p - turned(pair) * {source(s)}), {lengths})")
        first = self._turn(one, (*turning(s, along), c), "links")
        self.vector("to_target", f"M.T * (p - turned({first}) * {source(s)})")
        turns = [-six.turn, -five.turn]
        self.two_links(turns, [u[:2, 0], t[:2, 0]], "to_target[0]", "to_target[1]")
        both = f"turned({self.pairs[0]} + {self.less(self.pairs[1], t[:2, 0])})"
        middle = times(one.end.T, f"(turned({first}).T * M)")
        return followed(f"{middle} * {both}", four.end.T)

    def _links(self, goal: TurnGoal) -> str:
        """The name of the goal of a turn before a wrist."""
        parts = [goal.point, goal.axis, goal.onward, goal.offset]
        if goal.constant is not None:
            parts[2:] = source(goal.wrist[0].end), source(goal.constant)
        point, axis, onward, offset = (f"lambda pair: {e.format('pair')}" for e in parts)
        lengths = ", ".join(goal.lengths)
        if goal.is_normal:
            length, turned = goal.numbers
            arguments = f"{point}, {lengths}, {axis}, {length}, {turned}"
            self.add(f"links = LinksAndWrist({arguments})")
            return "links"
        first, middle, _ = goal.wrist
        x, sense = self.middle(first, middle, goal.onward)
        arguments = f"{point}, {lengths}, {axis}, {onward}, {source(middle.end * Z)}, {offset}, {x}"
        more = ", sense=-1" if sense < 0 else ""
        self.add(f"links = LinksAndObliqueWrist({arguments}{more})")
        return "links"

    def _reach(self, goal: TurnGoal, q: str, lever: str) -> None:
        """Keep a wrist within reach of links where it is free or tangent.

        ``q`` is the name of the point, and ``lever`` that of the turn before.
        """
        if not goal.is_normal:
            entries = point("to_end") if goal.constant is None else goal.constant
            offset = "to_end" if goal.constant is None else source(entries)
            self.carried = Carried(q, offset, goal.lengths, entries)
            return
        length, turned = goal.numbers
        lengths = ", ".join(goal.lengths)
        arguments = f"offset={length}, ahead={turned}, lever={lever}"
        self.add(f"reaching = Reaching(ik, ({q}[0], {q}[1]), ({lengths}), {arguments})")
        self.more = ", reaching=reaching"

    def _require_parallel(self, arm: Singles, start: int) -> None:
        three = arm.joints[start : start + 3]
        numbers = [j.number for j in three]
        self.require(
            three[0].end == three[1].end == sp.eye(3),
            "axes {}, {} and {} are not parallel".format(*numbers),
            "This chain needs three parallel axes.",
        )


__all__ = ["SixMaker", "TurnGoal"]
