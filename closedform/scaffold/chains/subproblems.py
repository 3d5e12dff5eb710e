"""Proposes a chain of subproblems for arms whose axes have any direction.

Three axes that meet in a point leave this point to the other joints, and a rotation to themselves.
The other joints are solved one after another, each by an equation that holds no other unknown:

- two neighbours that meet leave the distance between their point and a later one;
- two parallel neighbours leave the component along their axis;
- and what is left of a pair is the rotation of one vector to another.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.algebra.normal_form import equal
from closedform.mechanics.frames import plane_angle, rotation
from closedform.scaffold.chains.chainlinks import Single, Singles, parallel
from closedform.scaffold.chains.ellipse import Ellipse, folds
from closedform.scaffold.chains.maker import (
    SIDE,
    Solved,
    Z,
    followed,
    heading,
    norm,
    point,
    times,
    turning,
)
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.wrists import ELBOW, WristMaker, is_normal
from closedform.scaffold.source import source


@dataclass
class SubproblemMaker(WristMaker):
    """Writes the lines for an arm of single joints."""

    tool: str = ""
    """The direction of the last axis, if it determines the first joint."""
    along: sp.Expr = sp.S.Zero
    """Its component along the parallel axes in between."""
    between: sp.Matrix | None = None
    """The direction of those."""
    third: str = ""
    """The direction of the last of four axes, if the third has the same: two joints turn it."""

    def give(self, joint: Single) -> None:
        """Take a joint as an input."""
        self.add(f"given = ik.given({joint.joint})")

    def solved(self, arm: Singles, wrist: int) -> str:
        """Solve an arm whose last ``wrist`` joints meet in a point; return its structure.

        Fewer than six joints do not reach every pose, so that the target is compared at the end.
        """
        n = len(arm.joints)
        before, ends = arm.joints[: n - wrist], arm.joints[n - wrist :]
        R = self.centre(arm)
        self._see_the_last_axis(arm, R)
        if n == len(self.arm.joints) == 4 and not arm.joints[2].slides and parallel(arm.joints[2]):
            opposite = arm.joints[2].end[2, 2] == -1
            axis = self.last_axis(arm, R)
            self.third = times(arm.lead[:3, :3].T, f"-{axis}" if opposite else axis)
        solved = self.position(before)
        M = times(arm.lead[:3, :3].T, R)
        slides = any(j.slides for j in before)
        rolls = wrist == 2 and n == 5 and not slides and not parallel(before[-1])
        if rolls or (wrist == 3 and not is_normal(ends)):
            tool = followed(M, arm.tool[:3, :3].T)
            self._within_tilt(before, ends, tool)
        for k, (pair, end) in enumerate(solved.turned, 1):
            if not pair and end == sp.eye(3):
                continue
            inside = f"(turned({pair}).T * {M})" if pair else M
            self.add(f"left{k} = ik.matrix('left{k}', {times(end.T, inside)})")
            M = f"left{k}"
        M = self.without_tool(arm.tool[:3, :3], M)
        self.orientation(ends, M)
        if len(self.arm.joints) < 6:
            self.add(f"ik.reached({solved.rest if wrist == 3 else ''})")
        return solved.structure

    def _within_tilt(self, before: Sequence[Single], ends: Sequence[Single], M: str) -> None:
        """Keep the last axis within the limits of an oblique wrist where joints are singular."""
        turning = [joint for joint in before if not joint.slides]
        if not turning or before[0].slides or any(j.number not in self.solved_as for j in turning):
            return
        shown, pairs = [], []
        for joint in self._with_slides(before):
            unknown, pair, ahead = self.solved_as[joint.number]
            T = rotation("z", -ahead)
            motion = f"{source(T * joint.shift)}, {source(T * joint.end)}"
            shown.append(f"Carrying({unknown}, {pair}, {motion})")
            pairs.append(pair)
        g, w = ends[0].end.T * Z, Z if len(ends) == 2 else ends[1].end * Z
        level, across = g[2] * w[2], norm(g[:2, 0]) * norm(w[:2, 0])
        limits = f"({source(level - across)}, {source(level + across)})"
        arguments = f"tool=({M})[:, 2], limits={limits}, levers=[{', '.join(self.levers)}]"
        carrying = f"[{', '.join(shown)}]"
        self.add(f"{', '.join(pairs)}, = within_tilt(ik, {carrying}, p, {arguments})")

    def _with_slides(self, joints: Sequence[Single]) -> list[Single]:
        """The joints that turn; each carries the slides after it at what was solved for them."""
        found: list[Single] = []
        for joint in joints:
            if not joint.slides:
                found.append(joint)
                continue
            R = rotation("z", joint.turn)
            known = {joint.joint: sp.Symbol(f"{joint.joint}_")}
            last = found[-1]
            shift = last.shift + last.end * R * joint.shift.xreplace(known)
            found[-1] = replace(last, shift=shift, end=last.end * R * joint.end)
        return found

    def solved_point(self, arm: Singles) -> str:
        """Solve three joints for the position of the tool."""
        tool = arm.tool[:3, 3]
        self.add("p = Matrix(ik.x)")
        if arm.lead != sp.eye(4):
            moved = times(arm.lead[:3, :3].T, f"(p - {source(arm.lead[:3, 3])})")
            self.vector("p", moved, "p0")
        last = replace(arm.joints[-1], shift=tool)
        return self.position([*arm.joints[:-1], last]).structure

    def solved_level(self, arm: Singles) -> str:
        """Solve three joints for the point that a fourth turns the tool about, and then that."""
        *before, last = arm.joints
        self.require(
            not last.slides,
            f"joint {last.number} slides after those that turn the tool",
            "Among four joints with the task x, y, z and yaw the last must turn.",
        )
        home = self.arm.pose[:3, :3].subs(dict.fromkeys(self.arm.joints, 0))
        level = rotation("z", -plane_angle(home[0, 0], home[1, 0])) * home
        beside = (level * arm.tool[:3, :3].T * arm.tool[:3, 3]).applyfunc(sp.simplify)
        self.add("x, y, z, yaw = ik.x")
        x, y, z, yaw = map(sp.Symbol, ("x", "y", "z", "yaw"))
        self.vector("p", source(sp.Matrix([x, y, z]) - rotation("z", yaw) * beside), "w")
        if arm.lead != sp.eye(4):
            moved = times(arm.lead[:3, :3].T, f"(p - {source(arm.lead[:3, 3])})")
            self.vector("p", moved, "p0")
        structure = self.position(before).structure
        total = self.arm.coordinates().values[-1]  # type: ignore[union-attr]
        (value,) = sp.solve(total - sp.Symbol("yaw", real=True), last.joint)
        self.solve("remainder", f"{last.joint}, {source(value)}")
        return f"{structure}, and a turn of the level tool"

    def solved_in_plane(self, arm: Singles) -> str:
        """Solve a turret, three parallel joints and one whose axis does not meet theirs."""
        one, two, three, four, five = arm.joints
        self.require(
            not parallel(one) and not parallel(four) and two.end == three.end == sp.eye(3),
            "axes 2, 3 and 4 are not parallel, or axis 1 or 5 is parallel to them",
            "The known chain of five joints has three parallel axes in the middle.",
        )
        R = self.centre(arm)
        self._see_the_last_axis(arm, R)
        w = four.shift
        q, pair = self._seen_in_plane(one, two.shift[2] + three.shift[2] + w[2])
        M = f"{times(one.end.T, f'(turned({pair}).T * {times(arm.lead[:3, :3].T, R)})')}"
        self.add(f"left1 = ik.matrix('left1', {M})")
        M = self.without_tool(arm.tool[:3, :3], "left1")
        lift = replace(four, turn=two.turn + three.turn + four.turn)
        self.orientation([lift, five], M)
        turn = f"pair{four.number}"
        self.vector("q", f"{q} - turned({turn}) * {source(w)}", "q2")
        u, v = two.shift, three.shift
        self.two_links([two.turn, three.turn], [u[:2, 0], v[:2, 0]], "q[0]", "q[1]")
        self.add("ik.reached()")
        return "turret, three parallel joints and one more"

    def without_tool(self, after: sp.Matrix, M: str) -> str:
        if (after - sp.eye(3)).is_zero_matrix:
            return M
        self.add(f"left = ik.matrix('left', {M} * {source(after.T)})")
        return "left"

    def last_axis(self, arm: Singles, M: str) -> str:
        """The direction of the last axis, seen from where ``M`` leads to the tool."""
        return f"{M} * {source((arm.tool[:3, :3].T * Z).applyfunc(sp.simplify))}"

    def centre(self, arm: Singles) -> str:
        """Name the point ``p`` where the last axes meet, and return the name of the rotation."""
        R, p = ("ik.R", "ik.p")
        if arm.inverted:
            self.add("R_inverse = ik.R.T")
            self.vector("p", "-R_inverse * ik.p", "base")
            R, p = "R_inverse", "p"
        tool = arm.tool
        offset = (tool[:3, :3].T * tool[:3, 3]).applyfunc(sp.simplify)
        if not offset.is_zero_matrix:
            self.vector("p", f"{p} - {R} * {source(offset)}", "w")
        elif p != "p":
            self.add(f"p = {p}")
        lead = arm.lead[:3, :3]
        if arm.lead != sp.eye(4):
            moved = times(lead.T, f"(p - {source(arm.lead[:3, 3])})")
            self.vector("p", moved, "p0")
        return R

    def _see_the_last_axis(self, arm: Singles, R: str) -> None:
        """Keep the direction of the last axis if the joints between that turn are parallel.

        Six joints reach every direction, so it says nothing of the first one.
        """
        first, middle, last = arm.joints[0], arm.joints[1:-1], arm.joints[-1]
        if len(arm.joints) > 5 or first.slides or last.slides:
            return
        frame, axes = first.end, []
        for joint in middle:
            axes += [] if joint.slides else [(frame * Z).applyfunc(sp.simplify)]
            frame = frame * (rotation("z", joint.turn) if joint.slides else sp.eye(3)) * joint.end
        if not axes or not all(a.cross(axes[0]).is_zero_matrix for a in axes):
            return
        self.tool = times(arm.lead[:3, :3].T, self.last_axis(arm, R))
        self.between, self.along = axes[0], sp.simplify(axes[0].dot(frame * Z))

    # The joints that carry a point

    def position(self, joints: Sequence[Single]) -> Solved:
        """Solve up to three joints that carry the point ``p``, which is at the end of the last."""
        if any(j.slides for j in joints):
            return Slides(self, joints, self.unknown, self._slid_by_axis).solved()
        if len(joints) == 3:
            return self._three(*joints)
        if len(joints) == 2:
            return self._two(*joints)
        if len(joints) == 1:
            (only,) = joints
            pair = self._rotate(only, source(only.shift[:2, 0]), "p")
            rest = f"turned({pair}).T * p - {source(only.shift)}"
            return Solved("a turret", [(pair, only.end)], rest)
        if not joints:
            return Solved("a wrist alone", [], "p")
        raise NoChainError(
            f"{len(joints)} joints carry its wrist", "The known chains have up to 3."
        )

    def _two(self, one: Single, two: Single) -> Solved:
        u = two.shift
        if parallel(one):
            self.require(
                one.end == sp.eye(3), "its first two axes are opposite", "Turn a frame by pi."
            )
            self._two_links_of(one, two, one.shift, u, "p")
            bend = self.less(self.pairs[1], u[:2, 0])
            first, second = self.pairs
            a, b = (source(norm(w[:2, 0])) for w in (one.shift, u))
            x, y = (f"{a}*{first}.{n} + {b}*({first} + {second}).{n}" for n in "cs")
            rest = f"p - Matrix([{x}, {y}, {source(one.shift[2] + u[2])}])"
            return Solved("two links", [(f"({self.pairs[0]} + {bend})", two.end)], rest)
        q, pair = self._seen_in_plane(one, u[2])
        second = self._rotate(two, source(u[:2, 0]), q)
        rest = f"turned({second}).T * q - {source(u)}"
        return Solved("a turret and a joint", [(pair, one.end), (second, two.end)], rest)

    def _two_links_of(
        self, first: Single, second: Single, u: sp.Matrix, v: sp.Matrix, at: str
    ) -> None:
        """Solve two parallel joints, with links ``u`` and ``v``, for a point of their plane."""
        turns, links = [first.turn, second.turn], [u[:2, 0], v[:2, 0]]
        self.two_links(turns, links, f"{at}[0]", f"{at}[1]")
        before = sp.S.Zero
        for joint, pair, w in zip((first, second), self.pairs, links, strict=True):
            ahead = heading(w)
            self.solved_as[joint.number] = (pair[:-1], pair, ahead - before)
            before = ahead
        self.levers.append(f"{self.pairs[1]}.s")

    def _seen_in_plane(self, one: Single, beside: sp.Expr, toward: str = "") -> tuple[str, str]:
        """Solve a joint by how far ``p`` is along the next axis; name the point in that frame."""
        g, p = one.end * Z, point("p")
        c = beside + g.dot(one.shift) - g[2] * p[2]
        if self.tool:
            pair = self._by_point_and_axis(one, g, c, toward)
        else:
            pair = self._turn(one, (*turning(g, p), c), toward)
        q = times(one.end.T, f"(turned({pair}).T * p - {source(one.shift)})")
        self.vector("q", q)
        return "q", pair

    def _slid_by_axis(self, one: Single, n: sp.Matrix, c: sp.Expr) -> str:
        """The pair by the point, ``c`` along the axes between, and by the last; else empty."""
        seen = self.tool and n == self.between
        return self._by_point_and_axis(one, n, c, "") if seen else ""

    def _by_point_and_axis(self, one: Single, g: sp.Matrix, c: sp.Expr, toward: str) -> str:
        """Solve a joint by the components of the point ``p`` and of the last axis along ``g``.

        Where one of them is near the axis of the joint, the other decides.
        """
        self.vector("tool", self.tool)
        tool = point("tool")
        if self.along in (1, -1):
            return self._rotate(one, source(g[:2, 0] * self.along), "tool", scale="1")
        self.add("side = ik.let('side', ik.size*sign_of(p[0]*tool[0] + p[1]*tool[1]))")
        self.vector("both", "p + side*tool")
        both, side = point("both"), sp.Symbol("side")
        sides = (*turning(g, both), c + side * (self.along - g[2] * tool[2]))
        return self._turn(one, sides, toward)

    def _three(self, one: Single, two: Single, three: Single) -> Solved:
        if not parallel(one) and two.end == sp.eye(3):
            return self._parallel_last(one, two, three)
        if not parallel(one) and one.shift.is_zero_matrix:
            return self._meeting_first(one, two, three)
        if not parallel(two) and two.shift.is_zero_matrix:
            return self._meeting_last(one, two, three)
        if one.end == sp.eye(3) and not parallel(two):
            return self._parallel_first(one, two, three)
        return self._skew(one, two, three)

    def _parallel_last(self, one: Single, two: Single, three: Single) -> Solved:
        u, v = two.shift, three.shift
        if self.tool and len(self.arm.joints) == 4 and not parallel(three):
            return self._pointing(one, two, three)
        reached = times(one.end.T, f"(turned(pair).T * p - {source(one.shift)})")
        lengths = ", ".join(source(norm(w[:2, 0])) for w in (u, v))
        self.add(f"links = Links(lambda pair: {reached}, {lengths})")
        _, pair = self._seen_in_plane(one, u[2] + v[2], "links")
        self._two_links_of(two, three, u, v, "q")
        bend = self.less(self.pairs[1], v[:2, 0])
        return Solved(
            f"axes {two.number} and {three.number} parallel",
            [(pair, one.end), (f"({self.pairs[0]} + {bend})", three.end)],
        )

    def _pointing(self, one: Single, two: Single, three: Single) -> Solved:
        """Two parallel joints that point the last axis: it says more of their sum than a point."""
        u, v = two.shift, three.shift
        self.require(
            not u[:2, 0].is_zero_matrix,
            f"axes {two.number} and {three.number} are one",
            "Two parallel axes need a link between them.",
        )
        q, first = self._seen_in_plane(one, u[2] + v[2])
        both = self.angle(two.turn + three.turn)
        pointed = times(one.end.T, f"(turned({first}).T * tool)")
        axis = source((three.end * Z)[:2, 0])
        self.solve("rotate", f"{both}, {axis}, {pointed}, scale=1", "pointed")
        self.vector("to_elbow", f"{q} - turned(pointed) * {source(v)}")
        self._rotate(two, source(u[:2, 0]), "to_elbow")
        return Solved(
            f"axes {two.number} and {three.number} parallel, which point the last",
            [(first, one.end), ("pointed", three.end)],
        )

    def _meeting_first(self, one: Single, two: Single, three: Single) -> Solved:
        t, u, p = two.shift, three.shift, point("p")
        e, g = (two.end.T * t).applyfunc(sp.simplify), one.end * Z
        links = (e[:2, 0], u[:2, 0])
        flat = sp.simplify(e[2] + u[2]) == 0 and sp.zeros(2, 1) not in links
        normal = flat and is_normal((one, two))
        self.add("p_norm = ik.let('p_norm', sqrt(p.dot(p)))")
        sides = turning(g, p)
        to_end = f"{source(t)} + {times(two.end, f'(turned({{}}) * {source(u)})')}"
        self.add(f"reach = ik.let('reach', {source(norm(sp.Matrix(sides)))})")

        def goal(pair: str) -> str:
            if normal or (flat and sp.simplify((two.end * Z)[2]) == 0):
                return self._two_turns(two, to_end.format(pair), p[2], g)
            self.within_reach(to_end.format(pair), g[2] * p[2], "reach")
            return "seen_across"

        third, factor = (
            (self.elbow(three, e, u, goal), "1")
            if flat
            else (self._by_distance(three, e, u, goal("pair")), "2*ik.size")
        )
        self.vector("to_end", to_end.format(third))
        v = point("to_end")
        seen = norm(g[:2, 0]) * sp.sqrt(v[0] ** 2 + v[1] ** 2)
        self.add(f"link = LinkAtHeight({source(seen)}, {source(p[2] - g[2] * v[2])})")
        first = self._turn(one, (*sides, v[2] - g[2] * p[2]), "link")
        self.vector("to_target", times(one.end.T, f"(turned({first}).T * p)"))
        because = (
            f"{{{self.unknowns[three.number]}: {factor}, "
            f"{self.unknowns[one.number]}: to_target[2] + to_end[2]}}"
        )
        second = self._rotate(two, "to_end", "to_target", because)
        return Solved(
            f"axes {one.number} and {two.number} meet",
            [(first, one.end), (second, two.end), (third, three.end)],
        )

    def _two_turns(self, two: Single, to_end: str, along: sp.Expr, g: sp.Matrix) -> str:
        """Name the goal that two turns bring the point of an elbow to the target.

        The point stays in the plane through the second axis that is normal to that of the elbow.
        """
        axis = (two.end * Z).applyfunc(sp.simplify)
        seen = times(rotation("z", -heading(Z.cross(axis))), f"({to_end})")
        across = source(sp.Symbol("reach") / norm(g[:2, 0]))
        more = f", tilt={source(g[2])}" if g[2] != 0 else ""
        arguments = f"along={source(along)}, across={across}{more}"
        self.add(f"two_turns = TwoTurns(lambda pair: {seen}, {arguments})")
        return "two_turns"

    def elbow(
        self, joint: Single, e: sp.Matrix, u: sp.Matrix, goal: Callable[[str], str] | None = None
    ) -> str:
        """Solve the elbow between the links ``e`` and ``u`` by the distance; returns its pair.

        ``goal`` names what later joints need of a pair, as it is written.
        """
        e, u = e[:2, 0], u[:2, 0]
        lengths = [norm(e), norm(u)]
        self.require(
            0 not in lengths,
            f"its shoulder or its wrist is on axis {joint.number}",
            "An elbow needs two links.",
        )
        links = [self.length_of(f"link{k}", w) for k, w in enumerate(lengths, 1)]
        between = sp.Matrix([e.dot(u), e[0] * u[1] - e[1] * u[0]])
        offset = heading(between)
        x = self.unknowns[joint.number] = self.angle(joint.turn + offset)
        pair, turn = f"pair{joint.number}", self.less("{}", between)
        more = f", toward={goal(turn.format('pair'))}" if goal else ""
        self.solve("law_of_cosines", f"{x}, ({', '.join(links)}), p_norm, {ELBOW}{more}", pair, 2)
        self.levers.append(f"{pair}.s")
        self.solved_as[joint.number] = (x, pair, offset)
        return turn.format(pair)

    def _meeting_last(self, one: Single, two: Single, three: Single) -> Solved:
        t, u, p = one.shift, three.shift, point("p")
        g = two.end * Z
        self.add("p_norm = ik.let('p_norm', sqrt(p.dot(p)))")
        far = sp.Symbol("p_norm")
        c = (far**2 + sp.simplify(t.dot(t) - u.dot(u))) / 2 - t[2] * p[2]
        size = sp.sqrt(sp.simplify(u.dot(u)))
        sides = (*turning(t, p), c)
        to_target = times(one.end.T, f"(turned({{}}).T * p - {source(t)})")
        self.ahead_of_turn(to_target.format("pair"), u, g[2])
        first = self._turn(one, sides, "seen_across", scale=source(size / 2), by_size=True)
        self.vector("to_target", to_target.format(first))
        m = point("to_target")
        moved = f"{self.unknowns[one.number]}: 2*ik.size"
        if self.third:  # of which the point says nothing where it is on the second axis
            aimed = times(one.end.T, f"(turned({first}).T * {self.third})")
            second = self._rotate(two, source(g[:2, 0]), aimed, scale="1")
        else:
            second = self._turn(two, (*turning(g, m), u[2] - g[2] * m[2]))
            moved += f", {self.unknowns[two.number]}: to_target[2] + {source(u[2])}"
        turned = f"(turned({second}).T * to_target)"
        self.vector("to_target", times(two.end.T, turned), "to_target2")
        third = self._rotate(three, source(u[:2, 0]), "to_target", f"{{{moved}}}")
        return Solved(
            f"axes {two.number} and {three.number} meet",
            [(first, one.end), (second, two.end), (third, three.end)],
        )

    def _parallel_first(self, one: Single, two: Single, three: Single) -> Solved:
        s, t, u, p = one.shift, two.shift, three.shift, point("p")
        f = two.end.T * Z
        a, b = map(sp.simplify, turning(u, f))
        to_end = f"{source(t)} + {times(two.end, f'(turned({{}}) * {source(u)})')}"
        self.add("radius = ik.let('radius', sqrt(p[0]**2 + p[1]**2))")
        lengths = f"{source(norm(s[:2, 0]))}, radius"
        self.add(f"links = Links(lambda pair: {to_end.format('pair')}, {lengths})")
        third = self._turn(three, (a, b, p[2] - s[2] - t[2] - f[2] * u[2]), "links")
        self.vector("to_end", to_end.format(third))
        far, v = sp.Symbol("radius"), point("to_end")
        c = (far**2 - s[0] ** 2 - s[1] ** 2 - v[0] ** 2 - v[1] ** 2) / 2
        sides = (*turning(v, s), c)
        second = self._turn(two, sides, scale="(radius + ik.size/2**44)/2", by_size=True)
        self.vector("both_links", f"{source(s)} + turned({second}) * to_end")
        first = self._rotate(one, "both_links", "p", f"{{{self.unknowns[two.number]}: 2*ik.size}}")
        return Solved(
            f"axes {one.number} and {two.number} parallel",
            [(first, one.end), (second, two.end), (third, three.end)],
        )

    def _skew(self, one: Single, two: Single, three: Single) -> Solved:
        """Three joints of which no two neighbours meet or are parallel: an equation of degree 4.

        Seen across the first axis, the third joint moves the point along an ellipse, see
        :mod:`closedform.scaffold.chains.ellipse`; the target is on a circle around this axis.
        """
        self.require(
            not parallel(one) and not parallel(two),
            f"axes {one.number}, {two.number} and {three.number} are parallel",
            "Of three joints that carry a point, at most two may be parallel.",
        )
        square, p = sp.Symbol("square"), point("p")
        g, s, t, u = one.end * Z, one.shift, two.shift, three.shift
        self.require(
            not equal(Z.dot(g.cross(s)), sp.S.Zero),
            f"the joint that is given can make axes {one.number} and {two.number} parallel, and "
            f"they meet elsewhere",
            "The point where they meet must stay where it is; give another joint.",
        )
        ellipse = Ellipse.of((one, two, three), square, p[2])
        degree = 2 if ellipse.double == (0, 0) else 4
        if self.degree < degree:
            raise NoChainError(
                f"no two neighbours among axes {one.number}, {two.number} and {three.number} are "
                f"parallel or meet",
                "Otherwise they leave an equation of degree 4.",
                degree=4,
            )
        if folds(two, three):
            raise NoChainError(
                f"its wrist can come to axis {two.number}, where three solutions meet",
                "The known chain loses digits there.  Use ssik for a numeric inverse.",
                degree=degree,
            )
        self.add("square = ik.coordinate('square', p.dot(p))")
        self.add(f"along, aside = {source(ellipse.along)}, {source(ellipse.aside)}")
        self.vector("centre", source(ellipse.centre))
        self.add("radius = ik.let('radius', sqrt(p[0]**2 + p[1]**2))")
        if degree == 2:
            third, factor = self._circles_met(three), "2*ik.size"
        else:
            double = source(ellipse.double[0]), source(ellipse.double[1])
            third, factor = self.met_by_circle(three, double, "radius"), "1"
        self.vector("on_ellipse", f"centre + along*{third}.c + aside*{third}.s", "across")
        first = self._rotate(one, "on_ellipse", "p", f"{{{self.unknowns[three.number]}: {factor}}}")
        inside = times(two.end, f"(turned({third}) * {source(u)})")
        self.vector("to_end", f"{source(t)} + {inside}")
        self.vector("to_target", times(one.end.T, f"(turned({first}).T * p - {source(s)})"))
        short = sp.Abs(Z.dot((one.end * Z).cross(one.shift)))
        self.add(f"play = ik.amplified_over({source(short)})")
        meaning = "'the point is one of the arm'"
        for n in ("to_target", "to_end"):
            self.add(f"radius_{n} = ik.let('radius_{n}', sqrt({n}[0]**2 + {n}[1]**2))")
        for miss in ("to_target[2] - to_end[2]", "radius_to_target - radius_to_end"):
            self.add(f"ik.program.match({miss}, play, {meaning}, rounding=ik.rounding)")
        both = f"2*{source(s)} + (to_target[2] + to_end[2])*{source(g)}"
        self.vector("lever", f"turned({first}) * ({both})")
        because = f"{{{self.unknowns[one.number]}: (-lever[0], -lever[1])}}"
        second = self._rotate(two, "to_end", "to_target", because)
        return Solved(
            f"axes {one.number}, {two.number} and {three.number} neither meet nor are parallel",
            [(first, one.end), (second, two.end), (third, three.end)],
        )

    def met_by_circle(
        self, joint: Single, double: tuple[str, str], radius: str, more: str = ""
    ) -> str:
        """Solve for where an ellipse meets a circle around the origin; returns the pair.

        The equation is the difference of the squares of both distances; ``double`` are the
        coefficients of twice the angle in it.  ``more`` are further arguments of ``OnCircle``.
        """
        pair = f"pair{joint.number}"
        self.by_quartic(self.unknown(joint), double, radius, pair, more)
        return pair

    def _circles_met(self, joint: Single) -> str:
        """The same if the ellipse is a circle: the equation does not contain twice the angle.

        Like the quartic it accepts much more than rounding, because the result is compared with
        the target.
        """
        self.add("squares = centre.dot(centre) + along.dot(along)")
        sides = "centre.dot(aside)/ik.size, centre.dot(along)/ik.size"
        sides += ", (radius**2 - squares)/(2*ik.size)"
        scale = "2**16*(radius**2 + squares)/ik.size"
        pair = f"pair{joint.number}"
        self.solve("turn", f"{self.unknown(joint)}, ({sides}), {SIDE}, scale={scale}", pair, 2)
        return pair

    def _by_distance(self, joint: Single, e: sp.Matrix, u: sp.Matrix, toward: str) -> str:
        """Solve ``e . Rz(x) u`` by a distance; the equation is divided by the size of the arm."""
        a, b = map(sp.simplify, turning(u, e))
        far = sp.Symbol("p_norm")
        c = (far**2 - sp.simplify(e.dot(e) + u.dot(u))) / 2 - sp.simplify(e[2] * u[2])
        self.require(
            (a, b) != (0, 0),
            f"the distance of its wrist does not depend on joint {joint.number}",
            "An elbow needs an axis beside the line of its ends.",
        )
        scale = "(p_norm + ik.size/2**44)/2"
        return self._turn(joint, (a, b, c), toward, scale=scale, by_size=True)


__all__ = ["SubproblemMaker"]
