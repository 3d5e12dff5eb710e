"""What three parallel axes leave to the joints beside them: a direction, and a height along it.

Let a, b and c be the other joints in the order of the arm, from after the three axes around the
target to before them.  The direction of the three axes leaves two equations that do not contain b:
how far the axis of b is turned toward it, and how far its origin is along it.  Both are linear in
the sine and the cosine of a, and in those of c.

- If the axes of a and b are skew, the pair of a runs along an ellipse if c turns.  It is on the
  unit circle: an equation of degree 4 for c.
- If the axes of a and b are parallel, or those of b and c, the first equation contains one joint.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import sympy as sp

from closedform.mechanics.frames import plane_angle, rotation
from closedform.scaffold.chains.chainlinks import Single, Singles, parallel
from closedform.scaffold.chains.maker import Z, followed, heading, norm, point, times, turning
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.chains.wrists import Carried, is_normal
from closedform.scaffold.source import source

FAR = sp.Symbol("far")
"""No point is farther from another one; the chain has a name for it if a slide may reach it."""
SHORT = sp.Rational(1, 1000)
"""Of the sum of the lengths of an arm: a chain that divides by less loses too many digits."""


@dataclass(frozen=True)
class Beside:
    """Three parallel axes of an arm, from joint ``start`` on, and the joints beside them.

    The equations say that ``Rz(a) w`` and ``Rz(a) s``, seen along ``toward``, are as far along the
    three axes as what joint c turns: each of ``ends``, seen along ``Rz(c) seen``, and a constant.
    The target is ``p`` and ``M`` before the last joint turns.

    The second of the three may be a slide across the others, or the first two of them, turned to
    one frame; then ``least`` is how near a slide comes to the first axis, and no point is farther
    than ``far``.
    """

    arm: Singles
    start: int
    least: sp.Expr | None = None

    @property
    def group(self) -> tuple[Single, ...]:
        return self.arm.joints[self.start : self.start + 3]

    @property
    def others(self) -> tuple[Single, Single, Single]:
        a, b, c = (self.arm.joints[(self.start + k) % 6] for k in (3, 4, 5))
        return a, b, c

    @cached_property
    def toward(self) -> sp.Matrix:
        """The direction of the three axes, seen before joint a turns."""
        return self.group[2].end.T * Z

    @property
    def height(self) -> sp.Expr:
        return sum((joint.shift[2] for joint in self.group[:2]), sp.S.Zero)

    @cached_property
    def seen(self) -> sp.Matrix:
        """The direction of the three axes before joint c turns it."""
        if self.start:
            return self.others[2].end * Z
        return sp.Matrix([sp.Symbol(f"M[2, {i}]") for i in range(3)])

    @cached_property
    def ends(self) -> tuple[sp.Matrix, sp.Matrix]:
        if self.start:
            return sp.Matrix([sp.Symbol(f"M[{i}, 2]") for i in range(3)]), point("p")
        _, b, _ = self.others
        axis, origin = ((b.end.T * v).applyfunc(sp.simplify) for v in (Z, b.shift))
        return axis, -origin

    @property
    def still(self) -> tuple[sp.Expr, sp.Expr]:
        """The constants of both equations."""
        *_, c = self.others
        if self.start:
            return sp.S.Zero, self.seen.dot(c.shift) + self.height + self.group[2].shift[2]
        return sp.S.Zero, self.height + self.group[2].shift[2] - sp.Symbol("p[2]")

    @property
    def levels(self) -> list[sp.Expr]:
        """What both equations leave to the pairs: the right sides, less the parts along an axis."""
        a, _, _ = self.others
        return [
            self.seen[2] * end[2] - rest - self.toward[2] * v[2]
            for end, rest, v in zip(self.ends, self.still, (a.end * Z, a.shift), strict=True)
        ]

    def left(self, pair: str) -> str:
        """The rotation that the target leaves to the three joints, a and b, as it is written."""
        _, b, c = self.others
        if self.start:
            return times(c.end.T, f"(turned({pair}).T * M)")
        return followed(f"M * turned({pair}).T", b.end.T)

    def axis(self, pair: str) -> str:
        """The axis of b, which that rotation has as its third column."""
        _, b, c = self.others
        if self.start:
            return times(c.end.T, f"(turned({pair}).T * M[:, 2])")
        return f"M * turned({pair}).T * {source((b.end.T * Z).applyfunc(sp.simplify))}"

    def place(self, pair: str) -> str:
        """Where the target leaves the origin of b, as it is written."""
        *_, c = self.others
        if self.start:
            return times(c.end.T, f"(turned({pair}).T * p - {source(c.shift)})")
        return f"p - M * turned({pair}).T * {source(-self.ends[1])}"

    def to_end(self, pair: str) -> str:
        """From the third axis to the origin of b, for a pair of joint a, as it is written."""
        a, third = self.others[0], self.group[2]
        return (
            f"{source(third.shift)} + {times(third.end, f'(turned({pair}) * {source(a.shift)})')}"
        )

    @property
    def lift(self) -> Single:
        """The three joints as one."""
        return replace(self.group[2], turn=sum((j.turn for j in self.group), sp.S.Zero))

    def is_circle(self, turned: sp.Matrix) -> bool:
        """Whether the ellipse is a circle for every target: ``turned`` multiplies its points."""
        if self.start:
            return False
        inverse, across = turned.inv(), sp.Matrix([[end[0], end[1]] for end in self.ends])
        square = (inverse * across).T * (inverse * across)
        return bool(sp.simplify(square[0, 1]) == 0 == sp.simplify(square[0, 0] - square[1, 1]))

    @property
    def reaches(self) -> tuple[sp.Expr, sp.Expr]:
        """The lengths of the two links; with a slide, of links that reach as much."""
        if self.least is not None:
            return self.least + FAR, FAR
        one, two = (norm(joint.shift[:2, 0]) for joint in self.group[:2])
        return one, two

    @property
    def lengths(self) -> list[str]:
        return [source(length) for length in self.reaches]

    def told(self, others: str) -> str:
        numbers = [joint.number for joint in (*self.group, *self.others)]
        named = "axes {}, {} and {} parallel, "
        if self.least is not None:
            slides = sum(joint.slides for joint in self.group)
            named = "axes {0} and {2} parallel, a slide between, "
            named = "two slides beside axis {2}, " if slides == 2 else named
        return named.format(*numbers) + others.format(*numbers[3:])


@dataclass
class AroundParallelMaker(SubproblemMaker):
    """Writes the lines for three parallel axes beside which no two neighbours meet."""

    least: sp.Expr | None = None
    """That of :class:`Beside`."""

    def around_parallel(self, arm: Singles, start: int) -> str:
        """The three axes are those from ``start`` on: 0 or 1."""
        beside = Beside(arm, start, self.least)
        a, b, c = beside.others
        pairs = [(beside.group[2], a), *([(c, beside.group[0])] if start else [])]
        for one, other in pairs:
            self.require(
                not parallel(one),
                f"axes {one.number} and {other.number} are parallel",
                "Three parallel axes need others that are not parallel to them.",
            )
        if parallel(a):
            return self._parallel_at_first(beside)
        if not start and parallel(b):
            return self._parallel_at_last(beside)
        return self._skew_beside(beside)

    def _parallel_at_first(self, beside: Beside) -> str:
        """The axes of a and b are parallel: their direction gives joint c, and the height a."""
        a, _, c = beside.others
        self._seen_from_tool(beside.arm)
        toward, (end, _), (level, _) = beside.toward, beside.ends, beside.levels
        offset = beside.height + beside.group[2].shift[2] + toward[2] * a.shift[2]
        axis = (beside.group[2].end * a.end * Z).applyfunc(sp.simplify)
        sides = (*turning(beside.seen, end), -level)
        self._turn(c, sides, self._past_parallel(beside, axis), scale="1")
        third = f"pair{c.number}"
        self.vector("q", beside.place(third))
        self.add(f"M = ik.matrix('M_wrist', {beside.left(third)})")

        def direction(factor: str) -> str:
            return f"{self.unknown(c)}: {factor}"

        self._lift(beside, source(axis), "M[:, 2]", direction)
        self._links_less(beside, "q", beside.to_end("pair"))
        sides = (*turning(a.shift, toward), sp.Symbol("q[2]") - offset)
        first = self._turn(a, sides, "links")
        self.vector("to_end", beside.to_end(first))
        self._last(beside, first, direction)
        return beside.told("{} and {} parallel")

    def _past_parallel(self, beside: Beside, axis: sp.Matrix) -> str:
        """Name the goal that two links reach where joint c, which may be free, moves their end."""
        a, *_ = beside.others
        third = beside.group[2]
        centre = third.shift + third.end * (a.shift[2] * Z)
        constants = {
            "axis": axis,
            "about": third.end * Z,
            "centre": centre.applyfunc(sp.simplify),
            "radius": norm(a.shift[:2, 0]),
            "height": beside.height,
        }
        place = f"lambda pair: {beside.place('pair')}, {', '.join(beside.lengths)}"
        aimed = f"aimed=lambda pair: {beside.axis('pair')}"
        more = [f"{name}={source(value)}" for name, value in constants.items()]
        named = f"a={self.unknown(a)}, beside={bool(beside.start)}"
        self.add(f"past = LinksPastParallel({place}, {aimed}, {', '.join(more)}, {named})")
        return "past"

    def _parallel_at_last(self, beside: Beside) -> str:
        """The axes of b and c are parallel: the three axes, a and both turn as a wrist does.

        This gives joint a, and the sum of b and c; the height along the three axes gives c.
        """
        a, b, c = beside.others
        self._seen_from_tool(beside.arm)
        seen, (end, point_end) = beside.seen, beside.ends
        wrist = beside.lift, a, replace(b, turn=b.turn + end[2] * c.turn)
        self.add(f"left1 = ik.matrix('left1', {followed('M', b.end.T)})")
        rest = sp.Symbol("p[2]") - beside.height + seen[2] * point_end[2]
        if is_normal(wrist[:2]):
            e = beside.group[2].end * Z
            e = -e if e[1].is_negative else e
            self.vector("aimed", f"left1[2, 2] * {source(beside.toward)}", "aligned")
            self.vector("to_end", self._to_end_by_axis(beside, point("aimed")), "end_aligned")
            self.add(f"to_end = {source(rotation('z', sp.pi / 2 - heading(e)))} * to_end")
            self.more = self._aligned(beside)
            self.orientation(wrist, "left1")
            R = beside.group[2].end
            self.vector("aimed", times(R.T, f"(turned({self.lifted}).T * left1[:, 2])"))
            self.vector("to_end", self._to_end_by_axis(beside, point("aimed")))
        else:
            _, sense = self.middle(beside.lift, a)
            if sense:
                self.vector("to_end", beside.to_end(self.untilted(a, "Pair(0, 1)")), "end_aligned")
                self.more = self._aligned(beside)
            else:
                reach = norm(seen[:2, 0]) * norm(point_end[:2, 0])
                self.within_reach(beside.to_end("pair"), rest, source(reach))
                self.before_middle = "seen_across"
            self.orientation(wrist, "left1")
            self.vector("to_end", beside.to_end(f"pair{a.number}"))
        self._links_less(beside, beside.place("pair"), "to_end", "LinksAround")
        third = self._turn(c, (*turning(seen, point_end), sp.Symbol("to_end[2]") - rest), "links")
        self.vector("q", beside.place(third))
        self._two_links_less(beside)
        return beside.told("{1} and {2} parallel")

    def _to_end_by_axis(self, beside: Beside, aimed: sp.Matrix) -> str:
        """What joint a carries, by where it turns the axis after it, which is across its own."""
        a, third = beside.others[0], beside.group[2]
        w, s = a.end * Z, a.shift
        along, aside = sp.simplify(s.dot(w)), sp.simplify(s.dot(Z.cross(w)))
        x, y, _ = aimed
        moved = sp.Matrix([along * x - aside * y, along * y + aside * x, s[2]])
        return source(third.shift + third.end * moved)

    def _aligned(self, beside: Beside) -> str:
        """The argument that keeps the three joints within reach where joint c is free too.

        Then it turns the place that the links reach in their plane, which adds to their reach.
        """
        _, point_end = beside.ends
        own, (one, two) = norm(point_end[:2, 0]), beside.reaches
        least, most = sp.Max(0, sp.Abs(one - two) - own, own - one - two), one + two + own
        lengths = ", ".join(source(e) for e in ((most + least) / 2, (most - least) / 2))
        self.vector("q", f"p + M[:, 2] * {source(point_end[2])}", "q_free")
        arguments = f"(q[0], q[1]), ({lengths}), (to_end[0], to_end[1])"
        self.add(f"reaching = Reaching.turning(ik, {arguments}, lever=ik.size)")
        return ", reaching=reaching"

    def _lift(self, beside: Beside, axis: str, aimed: str, direction: Callable[[str], str]) -> None:
        """Solve the three joints as one by the axis of b, before they turn it and after.

        ``direction`` writes why a multiple of how the third entries of both differ vanishes.
        """
        self.vector("axis", axis)
        self.vector("aimed", aimed)
        because = f"{{{direction('(aimed[2] + axis[2])')}}}"
        self.lifted = self._rotate(beside.lift, "axis", "aimed", because, scale="1")

    def _links_less(self, beside: Beside, place: str, to_end: str, goal: str = "Links") -> None:
        """Name the goal that two links reach a place less what comes after them."""
        inside = f"{place} - turned({self.lifted}) * ({to_end})"
        self.add(f"links = {goal}(lambda pair: {inside}, {', '.join(beside.lengths)})")

    def _last(self, beside: Beside, first: str, direction: Callable[[str], str]) -> None:
        """Solve joint b for the rotation that is left, and the two links."""
        a, b, _ = beside.others
        lift, end = self.unknown(beside.lift), source(beside.group[2].end)
        self.add(f"R_last = turned({self.lifted}) * {end} * turned({first}) * {source(a.end)}")
        self.add("R_rest = ik.matrix('R_rest', R_last.T * M)")
        each = f"{{{lift}: (-R_last[0, k], -R_last[1, k]), {direction('R_last[2, k]')}}}"
        self.solve(
            "spin", f"{self.unknown(b)}, R_rest, [{each} for k in (0, 1)]", f"pair{b.number}"
        )
        self._two_links_less(beside)

    def _two_links_less(self, beside: Beside) -> None:
        self.vector("q", f"q - turned({self.lifted}) * to_end", "q_links")
        self.links_to_q(*beside.group[:2])

    def links_to_q(self, one: Single, two: Single) -> None:
        """Solve the first two of the three joints for the point ``q``, which they carry."""
        links = [joint.shift[:2, 0] for joint in (one, two)]
        self.two_links([one.turn, two.turn], links, "q[0]", "q[1]")

    def _skew_beside(self, beside: Beside) -> str:
        """The axes of a and b are skew: an equation of degree 4 for joint c."""
        a, b, c = beside.others
        arm, toward, seen = beside.arm, beside.toward, beside.seen
        w, s = a.end * Z, a.shift
        turned = sp.Matrix([turning(w, toward)[::-1], turning(s, toward)[::-1]])
        lever = sp.Abs(turned.det() / norm(toward[:2, 0])).simplify()
        low, high = sorted((a.number, b.number))
        if beside.is_circle(turned):
            raise NoChainError(
                f"joint {a.number} has its axis at the same angle and distance from axis "
                f"{b.number} as joint {c.number}",
                "The equation of degree 4 that remains has degree 2 there, and the known chain "
                "divides by what vanishes.",
                degree=2,
            )
        if self.degree < 4:
            raise NoChainError(
                f"axes {low} and {high} do not meet",
                "Besides the three axes, two neighbouring axes have to meet; otherwise an equation "
                "of degree 4 remains.",
                degree=4,
            )
        self.require_long(arm, lever, (low, high))
        self._seen_from_tool(arm)
        near = self._near_parallel(beside, w)
        third = self.met_by_ellipse(c, turned, beside.levels, (seen, beside.ends), near)
        self._within_links(beside, third)
        first = self.on_ellipse(a, c)
        self.vector("q", beside.place(third))
        self.add(f"M = ik.matrix('M_wrist', {beside.left(third)})")
        self.vector("to_end", beside.to_end(first))
        self.carried = Carried("q", "to_end", beside.lengths, point("to_end"))
        x, (along_w, aside_w) = self.unknown(a), turned.row(0)

        def level(factor: str) -> str:
            return f"{x}: (-{factor}*({source(along_w)}), -{factor}*({source(aside_w)}))"

        self.around((beside.lift, a, b), source(beside.group[2].end), first, level)
        self.add(f"play = ik.amplified_over({source(lever)})")
        height = beside.height
        above = f"q[2] - to_end[2] - ({source(height)})" if height != 0 else "q[2] - to_end[2]"
        across = [f"sqrt({v}[0]**2 + {v}[1]**2)" for v in ("axis", "M[:, 2]")]
        aside = f"ik.size*({across[0]} - {across[1]})"
        meaning = "'the pose is one of the arm'"
        for miss in ("ik.size*(axis[2] - M[2, 2])", aside, above):
            self.add(f"ik.program.match({miss}, play, {meaning}, rounding=ik.rounding)")
        self._two_links_less(beside)
        return beside.told("{} and {} skew" if beside.start else "{}, {} and {} skew")

    def met_by_ellipse(
        self,
        c: Single,
        turned: sp.Matrix,
        levels: Sequence[sp.Expr],
        other: tuple[sp.Matrix, Sequence[sp.Matrix]],
        near: str = "",
    ) -> str:
        """Solve joint c by two equations linear in its pair and in that of another joint, a.

        They say that ``turned``, times the pair of a, is the sum of ``levels`` and of what joint c
        turns: a vector, seen along others.  So the pair of a runs along an ellipse if c turns.
        ``near`` are further arguments of ``OnCircle``.
        """
        seen, ends = other
        along, aside = zip(*(turning(seen, end)[::-1] for end in ends), strict=True)
        inverse = turned.inv().applyfunc(sp.simplify)
        for name, value in (("centre", levels), ("along", along), ("aside", aside)):
            self.vector(name, source(inverse * sp.Matrix(value)))
        double = "(along.dot(along) - aside.dot(aside))/2", "along.dot(aside)"
        return self.met_by_circle(c, double, "1", near)

    def on_ellipse(self, a: Single, c: Single) -> str:
        """Solve joint a, whose pair is on the ellipse; return that pair."""
        pair = f"pair{c.number}"
        self.vector("on_ellipse", f"centre + along*{pair}.c + aside*{pair}.s", "across")
        because = f"{{{self.unknown(c)}: -1}}"
        return self._rotate(a, "(1, 0)", "on_ellipse", because, scale="1")

    def _within_links(self, beside: Beside, third: str) -> None:
        """Keep the two links within reach where solutions of the quartic nearly meet."""
        a, _, c = beside.others
        axis = f"{source(beside.group[2].end)} * turned(other) * {source(a.end * Z)}"
        parts = beside.place("pair"), axis, beside.axis("pair"), beside.to_end("other")
        self.lines += ["def carried(pair, other):", f"    return {', '.join(parts)}"]
        lengths = ", ".join(beside.lengths)
        arguments = f"{self.unknown(c)}, {third}, on_circle, carried, lengths=({lengths})"
        self.add(f"{third} = within_links(ik, {arguments})")

    def require_long(self, arm: Singles, lever: sp.Expr, axes: tuple[int, int]) -> None:
        """Refuse a short ``lever``, by which a chain divides."""
        size = sum(norm(joint.shift) for joint in arm.joints)
        if not (lever / size).free_symbols and lever < SHORT * size:
            raise NoChainError(
                "axes {} and {} pass each other at a distance that is short".format(*axes),
                "The known chain divides by this distance and loses digits.  If it is not meant, "
                "let the axes meet.",
                degree=4,
            )

    def _seen_from_tool(self, found: Singles) -> None:
        """Name the point ``p`` of the last axes, and the rotation ``M`` after the last joint."""
        R = self.centre(found)
        M = self.without_tool(found.tool[:3, :3], times(found.lead[:3, :3].T, R))
        self.add(f"M = ik.matrix('M', {M})")

    def _near_parallel(self, beside: Beside, w: sp.Matrix) -> str:
        """The argument that says how far the pair of joint a is from the unit circle.

        Where the axis of b is nearly along the three axes, two solutions nearly meet, and a
        difference of squares does not tell them apart.  The sine of joint a, counted from there, is
        known to rounding, and so is that of the angle between the axes, which gives the cosine.
        Empty if the axes are never parallel.
        """
        toward = beside.toward
        sense = next((k for k in (1, -1) if sp.simplify(toward[2] - k * w[2]) == 0), 0)
        if not sense:
            return self._perhaps_parallel(beside, w)
        size = sp.simplify(1 - w[2] ** 2)
        a, b = (sense * sp.simplify(e) / size for e in turning(w, toward))
        off_axis, at = sp.Symbol("off_axis"), [sp.Symbol(f"pair_at[{i}]") for i in (0, 1)]
        lines = [
            "def missed_by(pair):",
            "    pair_at = centre + along*pair.c + aside*pair.s",
            f"    aimed = {beside.axis('pair')}",
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

    def _perhaps_parallel(self, beside: Beside, w: sp.Matrix) -> str:
        """The same if the axes are parallel for some values of the angles of the arm alone.

        The cosine of joint a, counted from there, is known from that of the angle between the axes
        and those of the angles that both have with the axis of joint a.  What both of them are
        less than one, or more than minus one, is zero exactly where the angles are the same.
        """
        toward = beside.toward
        across = [v[1] if v[0] == 0 else v[0] if v[1] == 0 else None for v in (toward, w)]
        if None in across or not sp.simplify(toward[2] ** 2 - w[2] ** 2).free_symbols:
            return ""
        one, other = (plane_angle(v[2], side) for v, side in zip((toward, w), across, strict=True))
        if one.has(sp.atan2) or other.has(sp.atan2):
            return ""
        size = sp.Mul(*across)
        a, b = (sp.simplify(e / size) for e in turning(w, toward))
        at = [sp.Symbol(f"pair_at[{i}]") for i in (0, 1)]
        self.lines += [
            f"{name} = ik.let('{name}', {source(value)})"
            for name, value in (
                ("less", 1 - sp.cos(one - other)),
                ("more", 1 - sp.cos(one + other)),
                ("less_behind", 1 + sp.cos(one + other)),
                ("more_behind", 1 + sp.cos(one - other)),
            )
        ]
        self.lines += [
            "def missed_by(pair):",
            "    pair_at = centre + along*pair.c + aside*pair.s",
            f"    aimed = {beside.axis('pair')}",
            "    below_one = (aimed[0]**2 + aimed[1]**2)/(1 + Abs(aimed[2]))",
            "    ahead = (below_one - less)*(more - below_one)",
            "    behind = (below_one - less_behind)*(more_behind - below_one)",
            "    square = Piecewise((ahead, aimed[2] > 0), (behind, True))",
            f"    return {source((b * at[1] - a * at[0]) ** 2)} - square/({source(size**2)})",
        ]
        return ", missed_by"


__all__ = ["AroundParallelMaker"]
