"""Writes the chains of structures that have lemmas of their own.

Only geometry decides: which axes are parallel, intersect or are normal to each other.  The known
structures are

- planar arms of two or three revolute joints, also with a slide along their axes (SCARA);
- up to three slides, and a joint after them that turns the tool about z;
- gantries (three slides) and cylindrical arms (a turn, a slide along it, a slide across);
- a turret with two parallel joints, or with a joint and a slide (polar arm), and their offsets;
- these three-joint arms with a spherical wrist;
- a turret, three parallel joints and two more that are normal to each other (UR).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.mechanics.arm import Group, Serial
from closedform.mechanics.axes import met
from closedform.mechanics.frames import rotation
from closedform.scaffold.chains.maker import (
    Maker,
    Z,
    ahead_of_lift,
    heading,
    norm,
    point,
    sine_cosine,
    times,
)
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.source import source


class KnownMaker(Maker):
    """Writes the lines for arms whose neighbouring axes are parallel or normal."""

    def whole(self) -> str:
        groups, task = [_plain(group) for group in self.arm.groups], self.arm.coordinates()
        if task is None:
            return self._pose(groups)
        if "yaw" in task.names:
            return self._level(groups, task.names)
        if task.names == ("x", "y"):
            self.require(
                len(groups) == 1,
                "its axes are not parallel",
                "An arm with the task x, y needs parallel axes.",
            )
            return self._planar(groups[0], task.names)
        if task.names != ("x", "y", "z"):
            raise NoChainError(
                f"it moves the tool in {' and '.join(task.names)}",
                "The known tasks are the pose, and x, y or x, y, z, with or without the turn about "
                "z; a planar arm must have its axes along z.",
            )
        self.add("p = Matrix(ik.x)")
        self._lead_away("p")
        tool = groups[-1].end * self.arm.last[:3, 3]
        last = groups[-1].rows[-1]
        moved = tuple(sp.Matrix(last.shift) + tool)
        groups[-1] = Group((*groups[-1].rows[:-1], last._replace(shift=moved)), groups[-1].end)
        structure, _ = self._position(groups)
        return structure

    def _lead_away(self, vector: str) -> None:
        R, p = self.arm.lead[:3, :3], self.arm.lead[:3, 3]
        if not (p.is_zero_matrix and (R - sp.eye(3)).is_zero_matrix):
            self.add(
                f"{vector} = ik.vector('{vector}0', {times(R.T, f'({vector} - {source(p)})')})"
            )

    # Planar arms

    def _planar(self, group: Group, names: Sequence[str]) -> str:
        turns = [i for i, row in enumerate(group.rows) if not row.slides]
        self.require(
            len(turns) == 2 == len(group.rows),
            f"{len(turns)} of its joints turn and {len(group.rows) - len(turns)} slide",
            "A planar arm with the task x, y needs two joints that turn.",
        )
        self._require_z("its first axis is not the z axis of the base")
        vectors = self.links(group, turns)
        self._tool(group, vectors)
        self.add("x, y = ik.x[0], ik.x[1]")
        x, y = self._less_by(self.arm.lead[:2, 3])
        self.two_links([group.rows[i].turn for i in turns], vectors, x, y, alone=True)
        return "planar arm of two links"

    def _require_z(self, found: str) -> None:
        needed = "Choose the base frame so that its z axis is parallel to the first axis."
        self.require(sp.eye(3) == self.arm.lead[:3, :3], found, needed)

    def _less_by(self, offset: sp.Matrix) -> tuple[str, str]:
        """The names of x and y, minus the offset between them and the two links."""
        if offset == sp.zeros(2, 1):
            return "x", "y"
        for name, value in zip("xy", offset, strict=True):
            self.add(f"w{name} = ik.let('w{name}', {source(sp.Symbol(name) - value)})")
        return "wx", "wy"

    def _tool(self, group: Group, vectors: list[sp.Matrix]) -> None:
        """Add the tool to the vector of the last link."""
        vectors[-1] = vectors[-1] + (group.end * self.arm.last[:3, 3])[:2, 0]

    def _level(self, groups: Sequence[Group], names: Sequence[str]) -> str:
        """Solve an arm with parallel axes: two links and a yaw, with or without a slide."""
        slide = [row.slides for group in groups for row in group.rows]
        if all(slide[:-1]) and not slide[-1]:
            return self._slides_and_yaw(names)
        self.require(
            len(groups) == 1,
            "its axes are not parallel",
            "An arm with the task x, y (and z) and yaw needs parallel axes.",
        )
        self._require_z("its first axis is not parallel to the z axis of the base")
        (group,) = groups
        rows = group.rows
        turns = [i for i, row in enumerate(rows) if not row.slides]
        slides = [i for i, row in enumerate(rows) if row.slides]
        self.require(
            len(turns) == 3 and len(slides) < 2,
            f"{len(turns)} of its joints turn and {len(slides)} slide",
            "An arm with a yaw in its task needs three joints that turn, and may have a slide.",
        )
        vectors = self.links(group, turns)
        self._tool(group, vectors)
        self.add(f"{', '.join(names)} = ik.x")
        joints = [rows[i].turn for i in turns]
        x, y = self._less_by(self.arm.lead[:2, 3] + self._hand(joints, vectors[2]))
        self.two_links(joints[:2], vectors[:2], x, y, alone=x == "x")
        self._lift(rows)
        self._remaining_yaw(joints[2])
        return "planar arm of two links and a yaw" + (", with a slide (SCARA)" if slides else "")

    def _hand(self, joints: Sequence[sp.Expr], vector: sp.Matrix) -> sp.Matrix:
        """The last link: it is at the angle of the yaw, up to a constant."""
        yaw = self.arm.coordinates().values[-1]  # type: ignore[union-attr]
        ahead = sp.Symbol("yaw") + sp.simplify(sp.Add(*joints) - yaw)
        last_link = rotation("z", ahead) * sp.Matrix([*vector, 0])
        return last_link[:2, 0]

    def _lift(self, rows: Sequence[Any]) -> None:
        """Solve the slides along the axes by z."""
        for i in (i for i, row in enumerate(rows) if row.slides):
            symbol = _symbol(self.arm, rows, i)
            (value,) = sp.solve(self.arm.position[2] - sp.Symbol("z", real=True), symbol)
            self.solve("slide", f"{symbol}, {source(value)}")

    def _remaining_yaw(self, turn: sp.Expr) -> None:
        """Solve the last joint by the yaw."""
        yaw = self.arm.coordinates().values[-1]  # type: ignore[union-attr]
        last = _only(turn.free_symbols & set(self.arm.joints))
        (value,) = sp.solve(yaw - sp.Symbol("yaw", real=True), last)
        self.solve("remainder", f"{last}, {source(value)}")

    def _slides_and_yaw(self, names: Sequence[str]) -> str:
        """Solve an arm whose last joint turns the tool about z, and whose others slide."""
        *slides, last = self.arm.joints
        self.add(f"{', '.join(names)}{',' * (len(names) == 1)} = ik.x")
        task = self.arm.coordinates()
        assert task is not None
        targets = [sp.Symbol(name, real=True) for name in names]
        (turned,) = sp.solve(task.values[-1] - targets[-1], last)
        self.solve("remainder", f"{last}, {source(turned)}")
        if not slides:
            return "a yaw"
        at = [value.subs(last, turned) for value in task.values[:-1]]
        missed = [value - target for value, target in zip(at, targets, strict=False)]
        found = sp.solve(missed, slides, dict=True)
        self.require(
            len(found) == 1 and set(found[0]) == set(slides),
            "its slides do not move the tool in independent directions",
            "Slides need independent directions.",
        )
        for joint in slides:
            self.solve("slide", f"{joint}, {source(found[0][joint])}")
        return f"{'a slide' if len(slides) == 1 else f'{len(slides)} slides'} and a yaw"

    # Arms of three joints that carry a point

    def _position(self, groups: Sequence[Group]) -> tuple[str, list[str]]:
        """Solve the joints that carry the point ``p``; return the pairs that turn each group."""
        kinds = ["".join("P" if row.slides else "R" for row in g.rows) for g in groups]
        if kinds == ["P", "P", "P"]:
            return self._gantry(groups)
        if kinds[:1] == ["R"] and kinds[1:] in (["RR"], ["R", "P"]):
            return self._turret(groups, kinds)
        if kinds in (["RP", "P"], ["PR", "P"]):
            return self._cylinder(groups)
        raise NoChainError(
            f"the joints that carry its tool or wrist are {' | '.join(kinds)} (R turns, P slides, "
            "| where the direction changes)",
            "The known structures are R | RR, R | R | P, RP | P, PR | P and P | P | P.",
        )

    def _gantry(self, groups: Sequence[Group]) -> tuple[str, list[str]]:
        joints = self.arm.joints[:3]
        at, R = sp.zeros(3, 1), sp.eye(3)
        for group in groups:
            at, R = at + R * sp.Matrix(group.rows[0].shift), R * group.end
        solved = sp.solve(list(at - point("p")), joints, dict=True)
        self.require(
            len(solved) == 1 and set(solved[0]) == set(joints),
            "the directions of its three slides lie in a plane",
            "A gantry needs three independent directions.",
        )
        for joint in joints:
            self.solve("slide", f"{joint}, {source(solved[0][joint])}")
        return "gantry", ["", "", ""]

    def _cylinder(self, groups: Sequence[Group]) -> tuple[str, list[str]]:
        base, arm = groups
        turn = next(row for row in base.rows if not row.slides)
        slide = next(i for i, row in enumerate(base.rows) if row.slides)
        direction = base.end * Z
        offset = sum((sp.Matrix(row.shift) for row in base.rows), sp.zeros(3, 1))
        offset += base.end * sp.Matrix(arm.rows[0].shift)
        self.require(
            direction[2] == 0,
            "its last slide is not at right angles to its first axis",
            "A cylindrical arm needs a right angle.",
        )
        along, across, up = direction.dot(offset), Z.cross(direction).dot(offset), offset[2]
        self.require(
            sp.simplify(across) == 0,
            "the line of its last slide through the tool does not meet the first axis",
            "In a cylindrical arm they must intersect.",
        )
        lift, reach = (
            _symbol(self.arm, base.rows, slide),
            _only(along.free_symbols & set(self.arm.joints)),
        )
        a = self.angle(turn.turn + heading(direction))
        length = self.length(along, reach)
        sides = "{+1: 'front', -1: 'back'}"
        self.solve("polar", f"{a}, {length}, (p[0], p[1]), {sides}", f"{a}_, _", 2)
        self._length_back(length, along, reach)
        (value,) = sp.solve(up - point("p")[2], lift)
        self.solve("slide", f"{lift}, {source(value)}")
        return "cylindrical arm", [self.less(f"{a}_", direction), ""]

    def length(self, value: Any, joint: Any) -> str:
        value = sp.simplify(value)
        if value == joint:
            return str(joint)
        self.add(f"rho = ik.length('rho', {source(value)})")
        return "rho"

    def _length_back(self, length: str, value: Any, joint: Any) -> None:
        if length != str(joint):
            (solved,) = sp.solve(value - sp.Symbol("rho", real=True), joint)
            self.solve("slide", f"{joint}, {source(solved)}")

    def _turret(self, groups: Sequence[Group], kinds: Sequence[str]) -> tuple[str, list[str]]:
        base, second = groups[0], groups[1]
        normal = base.end * Z
        self.require_normal(normal[2], 1, 2)
        beside = sum((row.shift[2] for row in second.rows), sp.S.Zero)
        if kinds[1:] == ["R", "P"]:
            along = second.end * sp.Matrix(groups[2].rows[0].shift)
            self.require(
                (second.end * Z)[2] == 0,
                "its slide is not at right angles to axis 2",
                "A polar arm needs a right angle.",
            )
            beside += along[2]
        links = self.links(second, [0, 1]) if kinds[1:] == ["RR"] else []
        pair1 = self._turn_base(base, beside, links)
        if links:
            turns = [row.turn for row in second.rows]
            self.two_links(turns, links, "q[0]", "q[1]")
            bend = self.less(self.pairs[1], links[1])
            if bend != self.pairs[1]:
                self.add(f"turn2 = {bend}.known_as(ik.program, '_turn2')")
                bend = "turn2"
            return "turret and two parallel joints", [pair1, f"({self.pairs[0]} + {bend})"]
        first = sp.Matrix(second.rows[0].shift[:2])
        out = first + along[:2, 0]
        direction = second.end * Z
        length = sp.Matrix(direction[:2]).dot(out)
        sideways = sp.simplify(direction[0] * out[1] - direction[1] * out[0])
        self.require(
            sideways == 0,
            "the line of its slide through the tool or wrist does not meet axis 2",
            "In a polar arm they must intersect.",
        )
        slide = self.arm.joints[2]
        offset = heading(direction)
        a = self.angle(second.rows[0].turn + offset)
        name = self.length(length, slide)
        self.solve(
            "polar",
            f"{a}, {name}, (q[0], q[1]), {{+1: 'front', -1: 'back'}}, name='slide'",
            f"{a}_, _",
            2,
        )
        self._length_back(name, length, slide)
        return "turret, a joint and a slide (polar arm)", [
            pair1,
            self.less(f"{a}_", direction),
            "",
        ]

    def _turn_base(
        self, base: Group, beside: Any, links: Sequence[sp.Matrix] = (), wrist: str = ""
    ) -> str:
        """Solve the first joint by the distance ``beside`` of the point from the plane it turns.

        The ``links`` have to reach the point, minus an offset that the ``wrist`` turns, if any.
        """
        row, h = base.rows[0], base.end * Z
        p = point("p")
        a, b = source(h[0] * p[1] - h[1] * p[0]), source(h[0] * p[0] + h[1] * p[1])
        c = sp.simplify(beside + h[0] * row.shift[0] + h[1] * row.shift[1])
        joint = self.angle(row.turn)
        # the point in the turned frame: c along the normal, ahead across it, and its height
        across = Z.cross(h)
        level = base.end.T * (c * h + p[2] * Z - sp.Matrix(row.shift))
        along = base.end.T * across
        seen = level + sp.Symbol("turn1.ahead") * along
        toward = ""
        if links and (c != 0 or wrist):
            lengths = ", ".join(source(norm(link)) for link in links)
            if wrist or sp.simplify(level[:2, 0].dot(along[:2, 0])) != 0:
                inside = f"(turned(pair).T * p - {source(sp.Matrix(row.shift))})"
                place = times(base.end.T, inside)
                kind = "LinksAndWrist" if wrist else "Links"
                self.add(f"links = {kind}(lambda pair: {place}, {lengths}{wrist})")
            else:
                height = sp.simplify(along[0] * level[1] - along[1] * level[0])
                self.add(f"links = LinksAtHeight({lengths}, {source(height)})")
            toward = ", toward=links"
        self.solve(
            "turn",
            f"{joint}, ({a}, {b}, {source(c)}), {{+1: 'left', -1: 'right'}}{toward}",
            "turn1",
            2,
        )
        self.add(f"q = ik.vector('q', {source(seen.applyfunc(sp.expand))})")
        return "turn1"

    # Arms of six joints

    def _pose(self, groups: list[Group]) -> str:
        for k, group in ((6, groups[-1]), (5, groups[-2])):
            self.require(
                len(group.rows) == 1,
                f"axes {k - 1} and {k} are parallel",
                "Among the last three axes, no two neighbours may be parallel.",
            )
            self.require(
                not group.rows[0].slides, f"joint {k} slides", "The last two joints must turn."
            )
        third = groups[-3]
        if [row.slides for row in third.rows] == [True, False]:  # a slide along axis 4
            slide, turn = third.rows
            groups[-3:-2] = [_plain(Group((slide,), sp.eye(3))), Group((turn,), third.end)]
        for k in (-2, -1):
            groups[k - 1 : len(groups) + k + 1] = met(groups[k - 1], groups[k])
        wrist = groups[-2:]
        self.require(
            wrist[0].rows[0].shift[:2] == (0, 0),
            "axes 5 and 6 do not intersect",
            "The known chains need axes 5 and 6 that intersect.",
        )
        offset = self._tool_behind(wrist[1])
        self.add(f"p = ik.vector('w', ik.p - ik.R * {source(offset)})")
        self._lead_away("p")
        if (
            len(groups[-3].rows) == 3
            and len(groups) == 4
            and not any(row.slides for row in groups[-3].rows)
        ):
            return self._three_parallel(groups)
        self.require(
            len(groups[-3].rows) == 1,
            "axes 3 and 4 are parallel",
            "This is known only if axes 2, 3 and 4 are parallel and turn, as in a UR arm.",
        )
        first = groups[-3]
        self.require(
            first.rows[0].shift[:2] == (0, 0) and wrist[0].rows[0].shift == (0, 0, 0),
            "axes 4, 5 and 6 do not meet in a point",
            "The known chains have a spherical wrist, or parallel axes 2, 3 and 4 (UR).",
        )
        before = groups[:-3]
        last = before[-1].rows[-1]
        extra = before[-1].end * sp.Matrix(first.rows[0].shift)
        moved = tuple(sp.Matrix(last.shift) + extra)
        arm = [
            *before[:-1],
            Group((*before[-1].rows[:-1], last._replace(shift=moved)), before[-1].end),
        ]
        structure, pairs = self._position(arm)
        self.add(f"M = {times(self.arm.lead[:3, :3].T, 'ik.R')}")
        for group, pair in zip(arm, pairs, strict=True):
            inside = f"turned({pair}).T * M" if pair else "M"
            self.add(f"M = ik.matrix('M{len(self.lines)}', {times(group.end.T, f'({inside})')})")
        after = wrist[1].end * self.arm.last[:3, :3]
        self.wrist(first.rows[0].turn, [first, *wrist], "M", after)
        return f"{structure}, with a spherical wrist"

    def _tool_behind(self, last: Group) -> sp.Matrix:
        """The vector from the origin of the last axis to the tool, in the frame of the tool."""
        R = last.end * self.arm.last[:3, :3]
        return R.T * (sp.Matrix(last.rows[0].shift) + last.end * self.arm.last[:3, 3])

    def _three_parallel(self, groups: Sequence[Group]) -> str:
        base, parallel, fifth, last = groups
        end = parallel.end * sp.Matrix(fifth.rows[0].shift)
        normal = base.end * Z
        self.require_normal(normal[2], 1, 2)
        beside = sum((row.shift[2] for row in parallel.rows), end[2])
        u, v, w = self.links(parallel, [0, 1, 2])
        w = w + end[:2, 0]
        length = norm(w)
        lead = times(self.arm.lead[:3, :3].T, "ik.R")
        epsilon = ahead_of_lift(parallel.end * Z)
        angle = (heading(w) if length != 0 else sp.S.Zero) - epsilon
        sine, cosine = sine_cosine(angle)
        ahead = f"Pair({source(sine)}, {source(cosine)})"
        after = last.end * self.arm.last[:3, :3]
        axis = f"{lead} * {source(after.T[:, 2])}"
        axis = times(base.end.T, f"turned(pair).T * {axis}")
        offset = f"lambda pair: {axis}, {source(length)}, {ahead}"
        pair1 = self._turn_base(base, beside, [u, v], f", {offset}")
        self.add(f"M = ik.matrix('M', {times(base.end.T, f'turned({pair1}).T * {lead}')})")
        lengths = f"{source(norm(u))}, {source(norm(v))}"
        offset = f"offset={source(length)}, ahead={ahead}, lever={pair1}.lever"
        self.add(f"reaching = Reaching(ik, (q[0], q[1]), ({lengths}), {offset})")
        lift = sum((row.turn for row in parallel.rows), sp.S.Zero)
        pair, _ = self.wrist(lift, groups[1:], "M", after, more=", reaching=reaching")
        c, t = sp.Symbol(f"{pair}.c"), sp.Symbol(f"{pair}.s")
        q = point("q")
        past = length * sp.Matrix([cosine * c - sine * t, sine * c + cosine * t])
        self.add(f"x = ik.let('ex', {source(q[0] - past[0])})")
        self.add(f"y = ik.let('ey', {source(q[1] - past[1])})")
        turns = [row.turn for row in parallel.rows]
        self.two_links(turns[:2], [u, v], "x", "y")
        return "turret, three parallel joints and two more (UR)"


def _plain(group: Group) -> Group:
    """Move the constant turn of a single slide into the frame that follows it."""
    (row, *others) = group.rows
    if others or not row.slides:
        if any(row.slides and row.turn != 0 for row in group.rows[1:]):
            raise NoChainError(
                "the row of a slide has a constant angle theta",
                "Move this angle to the row before or after it, whose axis is parallel.",
            )
        return group
    R = rotation("z", row.turn)
    shift = tuple(R * sp.Matrix(row.shift))
    return Group((row._replace(turn=sp.S.Zero, shift=shift),), R * group.end)


def _only(found: set[Any]) -> Any:
    (symbol,) = found
    return symbol


def _symbol(arm: Serial, rows: Sequence[Any], i: int) -> Any:
    """The joint that slides in a row."""
    return _only(rows[i].shift[2].free_symbols & set(arm.joints))


__all__ = ["KnownMaker"]
