"""Proposes chains for arms of six joints by where their axes are parallel, or meet in a point.

- Three parallel axes leave the component along their direction to the other joints.  They are the
  first or the last three, or three of the middle; two neighbours of the others meet.  If those
  after three of the middle are skew, an equation of degree 4 is left.
- Three axes in the middle that meet in a point leave its distance from where two others meet.

Each also for the arm seen from its tool.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.scaffold.chainlinks import Single, Singles, parallel
from closedform.scaffold.maker import Z, followed, heading, norm, point, sine_cosine, times, turning
from closedform.scaffold.proposal import NoChainError
from closedform.scaffold.source import source
from closedform.scaffold.subproblems import SubproblemMaker
from closedform.scaffold.wrists import Carried, is_normal

SHORT = sp.Rational(1, 1000)
"""Of the sum of the lengths of an arm: a chain that divides by less loses too many digits."""


@dataclass(frozen=True)
class TurnGoal:
    """What a turn has to leave within reach of two ``links``: a wrist, and what it turns.

    That is, as it is written with ``{}`` for the pair of the turn, the ``point`` that the wrist
    carries, the direction ``axis`` of its last axis, the rotation ``onward`` from its first joint
    to its second, and the ``offset`` from the end of the links to the point, which is ``constant``
    or follows from the turn.
    """

    wrist: Sequence[Single]
    links: tuple[sp.Matrix, sp.Matrix]
    point: str
    axis: str
    offset: str = ""
    onward: str = ""
    constant: sp.Matrix | None = None

    @property
    def lengths(self) -> tuple[str, ...]:
        return tuple(source(norm(x[:2, 0])) for x in self.links)

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
class SixMaker(SubproblemMaker):
    """Writes the lines for six joints that have no spherical wrist and no spherical shoulder."""

    def parallel_middle(self, arm: Singles) -> str:
        """Axes 2, 3 and 4 are parallel, and axes 5 and 6 meet or are skew."""
        self._require_parallel(arm, 1)
        if not parallel(arm.joints[4]) and arm.met(4, 2) is None:
            return self._middle_before_skew(arm)
        arm = self._require_met(arm, 4)
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
            (two.shift, three.shift),
            place,
            self.last_axis(arm, left),
            constant=w,
        )
        links = self._links(goal)
        beside = two.shift[2] + three.shift[2] + w[2]
        q, pair = self._seen_in_plane(one, beside, links)
        self.add(f"left1 = ik.matrix('left1', {left.format(pair)})")
        M = self.without_tool(arm.tool[:3, :3], "left1")
        self._reach(goal, q, pair)
        self.orientation([lift, five, six], M)
        self.vector("q", f"{q} - turned({self.lifted}) * {source(w)}", "q2")
        u, v = two.shift, three.shift
        self.two_links([two.turn, three.turn], [u[:2, 0], v[:2, 0]], "q[0]", "q[1]")
        names = [j.number for j in (two, three, four, five, six)]
        return "axes {}, {} and {} parallel, {} and {} meet".format(*names)

    def _middle_before_skew(self, arm: Singles) -> str:
        """The same where axes 5 and 6 are skew: an equation of degree 4 for joint 1.

        The direction of the three axes leaves two equations: how far axis 6 is turned toward it,
        and how far its origin is along it.  Both are linear in the sine and the cosine of joint 5,
        and in those of joint 1, so that the pair of joint 5 runs along an ellipse if joint 1 turns.
        It is on the unit circle.
        """
        one, two, three, four, five, six = arm.joints
        numbers = [j.number for j in arm.joints]
        self.require(
            not parallel(one) and not parallel(four),
            f"axes {numbers[0]} and {numbers[1]} or {numbers[3]} and {numbers[4]} are parallel",
            "Three parallel axes need others that are not parallel to them.",
        )
        low, high = sorted(numbers[4:])
        if self.degree < 4:
            raise NoChainError(
                f"axes {low} and {high} do not meet",
                "Besides the three axes, two neighbouring axes have to meet; otherwise an equation "
                "of degree 4 remains.",
                degree=4,
            )
        g, toward, w, s = one.end * Z, four.end.T * Z, five.end * Z, five.shift
        turned = sp.Matrix([turning(w, toward)[::-1], turning(s, toward)[::-1]])
        lever = sp.Abs(turned.det() / norm(toward[:2, 0])).simplify()
        size = sum(norm(joint.shift) for joint in arm.joints)
        if not (lever / size).free_symbols and lever < SHORT * size:
            raise NoChainError(
                f"axes {low} and {high} pass each other at a distance that is short",
                "The known chain divides by this distance and loses digits.  If it is not meant, "
                "let the axes meet.",
                degree=4,
            )
        self._seen_from_tool(arm)
        inverse = turned.inv().applyfunc(sp.simplify)
        height = two.shift[2] + three.shift[2]
        ends = (sp.Matrix([sp.Symbol(f"M[{i}, 2]") for i in range(3)]), point("p"))
        still = (sp.S.Zero, g.dot(one.shift) + height + four.shift[2])
        centre = [
            g[2] * end[2] - rest - toward[2] * v[2]
            for end, rest, v in zip(ends, still, (w, s), strict=True)
        ]
        along, aside = ([turning(g, end)[k] for end in ends] for k in (1, 0))
        for name, seen in (("centre", centre), ("along", along), ("aside", aside)):
            self.vector(name, source(inverse * sp.Matrix(seen)))
        double = "(along.dot(along) - aside.dot(aside))/2", "along.dot(aside)"
        first = self.met_by_circle(one, double, "1", self._near_parallel(one, toward, w))
        self.vector("on_ellipse", f"centre + along*{first}.c + aside*{first}.s", "across")
        because = f"{{{self.unknown(one)}: -1}}"
        fifth = self._rotate(five, "(1, 0)", "on_ellipse", because, scale="1")
        self.add(f"M = ik.matrix('M_wrist', {times(one.end.T, f'(turned({first}).T * M)')})")
        q = times(one.end.T, f"(turned({first}).T * p - {source(one.shift)})")
        self.vector("q", q)
        inside = times(four.end, f"(turned({fifth}) * {source(s)})")
        self.vector("to_end", f"{source(four.shift)} + {inside}")
        lengths = [source(norm(x.shift[:2, 0])) for x in (two, three)]
        self.carried = Carried("q", "to_end", lengths, point("to_end"))
        lift = replace(four, turn=two.turn + three.turn + four.turn)
        x, (along_w, aside_w) = self.unknown(five), turned.row(0)

        def level(factor: str) -> str:
            return f"{x}: (-{factor}*({source(along_w)}), -{factor}*({source(aside_w)}))"

        self.around((lift, five, six), source(four.end), fifth, level)
        self.add(f"play = ik.amplified_over({source(lever)})")
        above = f"q[2] - to_end[2] - ({source(height)})" if height != 0 else "q[2] - to_end[2]"
        for miss in ("ik.size*(axis[2] - M[2, 2])", above):
            self.add(f"ik.program.match({miss}, play, 'the pose is one of the arm')")
        self.vector("q", f"q - turned({self.lifted}) * to_end", "q2")
        turns, links = [two.turn, three.turn], [two.shift[:2, 0], three.shift[:2, 0]]
        self.two_links(turns, links, "q[0]", "q[1]")
        return "axes {1}, {2} and {3} parallel, {4} and {5} skew".format(*numbers)

    def _near_parallel(self, one: Single, toward: sp.Matrix, w: sp.Matrix) -> str:
        """The argument that says how far the pair of joint 5 is from the unit circle.

        Where axis 6 is nearly along the three axes, two solutions nearly meet, and a difference of
        squares does not tell them apart.  The sine of joint 5, counted from there, is known to
        rounding, and so is that of the angle between the axes, which gives the cosine.  Empty if
        the axes are never parallel.
        """
        sense = next((k for k in (1, -1) if sp.simplify(toward[2] - k * w[2]) == 0), 0)
        if not sense:
            return ""
        size = sp.simplify(1 - w[2] ** 2)
        a, b = (sense * sp.simplify(e) / size for e in turning(w, toward))
        off_axis, at = sp.Symbol("off_axis"), [sp.Symbol(f"pair_at[{i}]") for i in (0, 1)]
        lines = [
            "def missed_by(pair):",
            "    pair_at = centre + along*pair.c + aside*pair.s",
            f"    aimed = {times(one.end.T, '(turned(pair).T * M[:, 2])')}",
            "    off_axis = aimed[0]**2 + aimed[1]**2",
        ]
        cosine = off_axis
        if w[2] != 0:
            least = f"Max(1 + {source(sense * sp.Symbol('aimed[2]'))}, {source(w[2] ** 2)})"
            lines.append(f"    below_one = {source(off_axis / size)}/{least}")
            cosine = sp.Symbol("below_one") * (2 - sp.Symbol("below_one"))
        lines.append(f"    return {source((b * at[1] - a * at[0]) ** 2 - cosine)}")
        self.lines += lines
        return ", missed_by"

    def parallel_first(self, arm: Singles) -> str:
        """Axes 1, 2 and 3 are parallel, and axes 5 and 6 or 4 and 5 meet."""
        self._require_parallel(arm, 0)
        self.require(
            not parallel(arm.joints[2]),
            "four neighbours are parallel",
            "At most three parallel axes determine each other.",
        )
        at_end, inside = arm.met(4, 2), arm.met(3, 2)
        found = at_end or inside
        if found is None:
            numbers = sorted(j.number for j in arm.joints[3:])
            raise NoChainError(
                "axes {0} and {1}, and {1} and {2}, do not meet".format(*numbers),
                "Besides three parallel axes, two neighbouring axes have to meet; otherwise an "
                "equation of degree 4 remains, which no known chain solves.",
                degree=4,
            )
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
                links=(one.shift, two.shift),
                point="p",
                axis=f"({M})[:, 2]",
                offset=offset.format(before),
                onward=followed(before, four.end),
            )
            sides = a, b, p[2] - height - g[2] * s[2]
            fourth = self._turn(four, sides, self._links(goal))
            self.add(f"R_before = {before.format(fourth)}")
            self.vector("to_end", offset.format("R_before"))
            self._reach(goal, "p", fourth)
            self.wrist_about(lift, five, six, M, followed("R_before", four.end))
        else:
            self.add(f"M = ik.matrix('M', {M})")
            t = five.end.T * five.shift
            u = sp.Matrix([sp.Symbol(f"M[2, {i}]") for i in range(3)])
            a, b = turning(u, t)
            place = f"p - M * turned({{}}).T * {source(t)}"
            goal = TurnGoal(
                [lift, four, five],
                (one.shift, two.shift),
                place,
                f"M * turned({{}}).T * {source(five.end.T * Z)}",
                constant=three.shift,
            )
            sixth = self._turn(six, (a, b, p[2] - height - t[2] * u[2]), self._links(goal))
            self.vector("p", place.format(sixth), "p3")
            left = followed(f"M * turned({sixth}).T", five.end.T)
            self.add(f"left1 = ik.matrix('left1', {left})")
            self._reach(goal, "p", sixth)
            self.orientation([lift, four, five], "left1")
            self.vector("to_end", source(three.shift))
        self.vector("q", f"p - turned({self.lifted}) * to_end")
        u, v = one.shift, two.shift
        self.two_links([one.turn, two.turn], [u[:2, 0], v[:2, 0]], "q[0]", "q[1]")
        meeting = (five, six) if at_end is not None else (four, five)
        names = [j.number for j in (one, two, three, *meeting)]
        return "axes {}, {} and {} parallel, {} and {} meet".format(*names)

    def meeting_middle(self, arm: Singles) -> str:
        """Axes 2, 3 and 4 meet in a point, and axes 5 and 6 meet."""
        numbers = [j.number for j in arm.joints]
        found = arm.met(1, 3)
        if found is None:
            raise NoChainError(
                "axes {1}, {2} and {3} do not meet in a point".format(*numbers),
                "Three neighbouring axes in the middle have to meet in a point.",
            )
        outer = "meet"
        if parallel(found.joints[4]):
            outer = "are parallel"
            middle = self._between_parallel(found)
        else:
            middle = self._between_meeting(self._require_met(found, 4))
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

    def _reach(self, goal: TurnGoal, q: str, pair: str) -> None:
        """Keep a wrist within reach of links where it is free or tangent.

        ``q`` and ``pair`` are the names of the point and of the pair before.
        """
        if not goal.is_normal:
            entries = point("to_end") if goal.constant is None else goal.constant
            offset = "to_end" if goal.constant is None else source(entries)
            self.carried = Carried(q, offset, goal.lengths, entries)
            return
        length, turned = goal.numbers
        lengths = ", ".join(goal.lengths)
        arguments = f"offset={length}, ahead={turned}, lever={pair}.lever"
        self.add(f"reaching = Reaching(ik, ({q}[0], {q}[1]), ({lengths}), {arguments})")
        self.more = ", reaching=reaching"

    def _seen_from_tool(self, found: Singles) -> None:
        """Name the point ``p`` of the last axes, and the rotation ``M`` after the last joint."""
        R = self.centre(found)
        M = self.without_tool(found.tool[:3, :3], times(found.lead[:3, :3].T, R))
        self.add(f"M = ik.matrix('M', {M})")

    def _require_parallel(self, arm: Singles, start: int) -> None:
        three = arm.joints[start : start + 3]
        numbers = [j.number for j in three]
        self.require(
            three[0].end == three[1].end == sp.eye(3),
            "axes {}, {} and {} are not parallel".format(*numbers),
            "This chain needs three parallel axes.",
        )

    def _require_met(self, arm: Singles, first: int) -> Singles:
        found = arm.met(first, 2)
        if found is None:
            one, two = sorted(arm.joints[k].number for k in (first, first + 1))
            self.require(
                not parallel(arm.joints[first]),
                f"axes {one} and {two} are parallel",
                "Beside the three axes two neighbours have to meet.",
            )
            raise NoChainError(
                f"axes {one} and {two} do not meet",
                "Besides the three axes, two neighbouring axes have to meet; otherwise an "
                "equation of degree 4 remains, which no known chain solves.",
                degree=4,
            )
        return found


__all__ = ["SixMaker"]
