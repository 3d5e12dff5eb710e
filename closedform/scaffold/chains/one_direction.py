"""Writes the chain of joints that turn about one direction or slide, beside others that turn.

SCARA arms, jib cranes and gantries with an offset wrist are of this kind.  The joints that turn
about one direction turn the tool as one, so the orientation of the target gives this turn and
those of the other joints, wherever their axes are.  What is left is a point, and its turn is known:

- three joints that turn are two links, seen along their direction; a slide lifts them;
- two joints that turn leave the component that is normal to the slides, and then the slides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, Singles, plain
from closedform.scaffold.chains.maker import (
    Z,
    ahead_of_lift,
    followed,
    norm,
    point,
    simple,
    sine_cosine,
    times,
    turning,
)
from closedform.scaffold.chains.proposal import NoChainError
from closedform.scaffold.chains.six import SixMaker, TurnGoal
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.wrists import Carried, is_normal
from closedform.scaffold.source import source

COUNTED = {1: "one", 2: "two", 3: "three", 4: "four"}
NEEDED = (
    "Joints that turn about one direction or slide are solved if two or three of them turn, and "
    "their slides move the tool in independent directions."
)


@dataclass(frozen=True)
class Level:
    """What joints carry between two that turn: a vector, and slides along directions."""

    shift: sp.Matrix
    slides: tuple[tuple[Single, sp.Matrix], ...] = ()


@dataclass(frozen=True)
class Block:
    """Joints that turn about the z axis or slide, after the rotation ``lead``.

    They carry a point to ``levels[0] + Rz(turns[0]) (levels[1] + Rz(turns[1]) (...))``; their
    rotation is ``Rz(sum of turns) end``.
    """

    joints: tuple[Single, ...]
    lead: sp.Matrix
    turns: tuple[sp.Expr, ...]
    levels: tuple[Level, ...]
    end: sp.Matrix

    @classmethod
    def of(cls, joints: Sequence[Single]) -> Block | None:
        """The joints as such a block; None if they turn about different directions."""
        lead = sp.eye(3)
        for joint in map(plain, joints):
            if not joint.slides:
                break
            lead = simple(lead * joint.end)
        frame, turns, levels = lead.T, [], [Level(sp.zeros(3, 1))]
        for joint in map(plain, joints):
            axis, level = simple(frame * Z), levels[-1]
            if joint.slides:
                level = replace(level, slides=(*level.slides, (joint, axis)))
            elif axis[:2, 0].is_zero_matrix:
                turns.append(axis[2] * joint.turn)
                level = Level(sp.zeros(3, 1))
            else:
                return None
            if not joint.slides:
                levels.append(level)
            levels[-1] = replace(level, shift=simple(level.shift + frame * joint.shift))
            frame = simple(frame * joint.end)
        return cls(tuple(joints), lead, tuple(turns), tuple(levels), frame)

    @property
    def lift(self) -> Single:
        """The joints that turn, as one."""
        last = [joint for joint in self.joints if not joint.slides][-1]
        turn, shift = sp.Add(*self.turns), self.levels[-1].shift
        return replace(last, turn=turn, shift=shift, end=self.end)

    @property
    def slides(self) -> list[tuple[int, Single, sp.Matrix]]:
        """The slides with the numbers of their levels; one along the turns may be at any level."""
        return [(k, *slide) for k, level in enumerate(self.levels) for slide in level.slides]

    @property
    def across(self) -> list[tuple[int, Single, sp.Matrix]]:
        """Those that are not along the turns."""
        return [slide for slide in self.slides if not slide[2][:2, 0].is_zero_matrix]

    @property
    def normal(self) -> sp.Matrix:
        """What is normal to one or two slides, the direction of the turns if there is only one."""
        (_, _, first), *others = self.slides
        return simple(others[0][2].cross(first) if others else Z.cross(first))

    @property
    def reach(self) -> tuple[sp.Expr, ...]:
        """Two links to the point; or, at a level with slides, how near it comes to the turn."""
        links = [norm(level.shift[:2, 0]) for level in self.levels[1:-1]]
        if len(links) > 1:
            return tuple(links)
        n = self.normal
        return (sp.Abs(sp.simplify(n.dot(self.levels[1].shift) / norm(n[:2, 0]))),)


@dataclass
class OneDirectionMaker(SixMaker):
    """Writes the lines for such joints, and others after them or on both sides."""

    sliding: Block | None = None
    """Joints that slide and turn in one plane, where a chain for three parallel axes is taken."""

    def in_one_direction(self, arm: Singles, count: int) -> str:
        """The first ``count`` joints turn about one direction, or slide."""
        met = arm.met(count, 2)
        arm = met or arm
        block, others = self._block(arm.joints[:count]), arm.joints[count:]
        self._require_turning(block, others)
        R = self.centre(arm)
        if block.lead != sp.eye(3):
            self.vector("p", times(block.lead.T, "p"), "p1")
        lead = simple(arm.lead[:3, :3] * block.lead)
        self._name_rotation(arm, times(lead.T, R))
        if not block.levels[0].shift.is_zero_matrix:
            self.vector("p", f"p - {source(block.levels[0].shift)}", "p2")
        if len(others) == 1:
            self.orientation([block.lift, *others], "M")
            self.lifted = f"pair{block.lift.number}"
            self.vector("to_end", source(block.levels[-1].shift))
        elif len(arm.joints) == 5 and met is None:
            self._beside_skew(arm, block, others)
        else:
            self._wrist_beside(block, others)
        self.vector("q", f"p - turned({self.lifted}) * to_end")
        rest = self._lifted_links(block) if len(block.turns) == 3 else self._one_link(block)
        if len(self.arm.joints) < 6:
            self.add(f"ik.reached({rest if met else ''})")
        return self._told(arm, block, others)

    def in_one_direction_between(self, arm: Singles) -> str:
        """Joints 2, 3 and 4 turn about one direction, one slides; axes 5 and 6 meet.

        How far the point where they meet is along that direction gives the first joint.
        """
        found = arm.met(4, 2)
        if found is None:
            low, high = sorted(joint.number for joint in arm.joints[4:])
            raise NoChainError(
                f"axes {low} and {high} do not meet",
                "Beside a joint before joints that turn about one direction, the axes of the two "
                "joints after them have to meet.",
            )
        *_, five, six = found.joints
        block = self._block(found.joints[1:4])
        self._require_turning(block, (five, six))
        one = self._one_before(found, block)
        end = one.end
        R = self.centre(found)
        lengths = self._lengths_to_reach(block, one.shift, between=True)
        left = times(end.T, f"(turned({{}}).T * {times(found.lead[:3, :3].T, R)})")
        goal = TurnGoal(
            [block.lift, five, six],
            lengths,
            times(end.T, f"(turned({{}}).T * p - {source(one.shift)})"),
            self.last_axis(found, left),
            constant=block.lift.shift,
        )
        beside = sum((level.shift[2] for level in block.levels[1:]), sp.S.Zero)
        q, pair = self._seen_in_plane(one, beside, self._links(goal) if lengths else "")
        self._name_rotation(found, left.format(pair))
        if lengths:
            self._reach(goal, q, f"{pair}.lever")
        self.orientation([block.lift, five, six], "M")
        self.vector("q", f"{q} - turned({self.lifted}) * {source(goal.constant)}", "q_end")
        self._one_link(block)
        return f"a turn, {self._told(found, block, (five, six))}"

    def with_slides(self, arm: Singles, start: int) -> str:
        """A slide between two parallel axes, or two slides beside one axis, all across them.

        They reach most points, or all.  So the chains for three parallel axes hold, with links that
        reach as much.
        """
        group = arm.joints[start : start + 3]
        self.require(
            not any(joint.slides for joint in arm.joints if joint not in group),
            "it has slides elsewhere",
            "Beside slides and turns of one plane, the other joints have to turn.",
        )
        self.sliding = block = self._block(group, (1, 2))
        ((level, *_), *_) = block.across
        self.require(
            not any(axis[2] for *_, axis in block.slides) and (level == 1 or len(block.turns) == 1),
            "its slides are not between two parallel axes and across them, or two beside one",
            "Other slides in one plane have no known chain where the other axes are skew.",
        )
        self.least = block.reach[0] if len(block.turns) == 2 else sp.S.Zero
        still = {"turn": sp.S.Zero, "shift": sp.zeros(3, 1), "end": sp.eye(3)}
        free = [replace(joint, **still) for joint in group if joint.slides]
        ends = [sp.eye(3), block.end][-len(block.turns) :]
        turns = [
            replace(joint, turn=turn, shift=level.shift, end=end)
            for joint, turn, level, end in zip(
                (j for j in group if not j.slides), block.turns, block.levels[1:], ends, strict=True
            )
        ]
        joints, lead = [*arm.joints], arm.lead
        joints[start : start + 3] = [*turns[:-1], *free, turns[-1]]
        moved = sp.eye(4)
        moved[:3, :3], moved[:3, 3] = block.lead, block.lead * block.levels[0].shift
        if start:
            one = joints[start - 1]
            shift, end = one.shift + one.end * moved[:3, 3], one.end * block.lead
            joints[start - 1] = replace(one, shift=simple(shift), end=simple(end))
        else:
            lead = simple(lead * moved)
        view = replace(arm, joints=tuple(joints), lead=lead)
        return self.parallel_middle(view) if start else self.parallel_first(view)

    def centre(self, arm: Singles) -> str:
        """Name the point ``p`` where the last axes meet, and return the name of the rotation."""
        R = super().centre(arm)
        if self.sliding is not None:
            shifts = [joint.shift for joint in arm.joints]
            farthest = sum((sp.sqrt(sp.simplify(v.dot(v))) for v in shifts), sp.S.Zero)
            self.add(f"far = ik.let('far', sqrt(p.dot(p)) + {source(farthest)})")
        return R

    def links_to_q(self, one: Single, two: Single) -> None:
        """Solve the first two of three joints for the point ``q``, which they carry."""
        if self.sliding is None:
            super().links_to_q(one, two)
        elif len(self.sliding.turns) == 2:
            self._one_link(self.sliding)
        else:
            self._slides_alone(self.sliding)

    def in_one_direction_of_five(self, arm: Singles) -> str:
        """The same with one joint after them: where its axis is free, it points the first joint."""
        last = arm.joints[-1]
        block = self._block(arm.joints[1:4], (1, 2))
        self._require_turning(block, (last,))
        one = self._one_before(arm, block)
        R = self.centre(arm)
        self._see_the_last_axis(arm, R)
        beside = sum((level.shift[2] for level in block.levels[1:]), sp.S.Zero)
        rotation = times(arm.lead[:3, :3].T, R)
        links = self._reach_across(arm, block, one, rotation) if len(block.turns) == 2 else ""
        q, pair = self._seen_in_plane(one, beside, links)
        M = times(one.end.T, f"(turned({pair}).T * {rotation})")
        self._name_rotation(arm, M)
        self.orientation([block.lift, last], "M")
        self.lifted = f"pair{block.lift.number}"
        self.vector("q", f"{q} - turned({self.lifted}) * {source(block.lift.shift)}", "q_end")
        if len(block.turns) == 2:
            self._one_link(block)
        else:
            self._slides_alone(block)
        self.add("ik.reached()")
        return f"a turn, {self._told(arm, block, (last,))}"

    def _reach_across(self, arm: Singles, block: Block, one: Single, R: str) -> str:
        """Name what a link reaches across a slide, if the first joint is nearly tangent.

        The direction of the last axis, across the one of the turns, turns with their sum.
        """
        ((level, *_), *_), n, w = block.across, block.normal, block.lift.shift
        (least,), length = block.reach, source(norm(block.levels[1].shift[:2, 0]))
        if level == 1 and least == 0:
            return ""
        self.vector("aimed", self.last_axis(arm, R), "aimed_tool")
        x, y, _ = block.end * Z
        v, (a, b) = (n if level == 2 else w), sp.symbols("seen[0] seen[1]")
        along, aside = (sp.simplify(e / (x**2 + y**2)) for e in turning((x, y), v)[::-1])
        turned = sp.Matrix([along * a - aside * b, aside * a + along * b, 0])
        self.lines += [
            "def carried(pair):",
            f"    seen = {times(one.end.T, '(turned(pair).T * aimed)')}",
            f"    return {source(turned)}",
        ]
        place = times(one.end.T, f"(turned(pair).T * p - {source(one.shift)})")
        if level == 2:
            beside = source(sp.simplify(n.dot(w)))
            goal = f"LinkAcross(lambda pair: {place}, carried, {length}, {beside})"
        elif level == 0:
            goal = (
                f"LinkAcross(lambda pair: {place} - carried(pair), lambda _: {source(n)}, {length})"
            )
        else:
            lengths = ", ".join(self._lengths_to_reach(block, one.shift))
            goal = f"Links(lambda pair: {place} - carried(pair), {lengths})"
        self.add(f"links = {goal}")
        return "links"

    def _one_before(self, arm: Singles, block: Block) -> Single:
        """The first joint, which turns the others; its motion ends in the frame of the block."""
        one = arm.joints[0]
        end = simple(one.end * block.lead)
        self.require(
            not one.slides
            and not (end * Z)[:2, 0].is_zero_matrix
            and all(direction[2] == 0 for *_, direction in block.slides),
            f"joint {one.number} does not turn the others in another direction",
            "The joint before them has to turn about another direction, and their slides have to "
            "be normal to theirs.",
        )
        return replace(one, shift=simple(one.shift + end * block.levels[0].shift), end=end)

    def _name_rotation(self, arm: Singles, M: str) -> None:
        """Name the rotation that the target leaves to the joints that turn."""
        self.add(f"M = ik.matrix('M', {M})")
        left = self.without_tool(arm.tool[:3, :3], "M")
        if left != "M":
            self.add(f"M = {left}")

    def _block(self, joints: Sequence[Single], count: Sequence[int] = (2, 3)) -> Block:
        """Joints that turn about one direction, of which as many as one ``count`` turn."""
        block = Block.of(joints)
        *numbers, last = (joint.number for joint in joints)
        named = f"joints {', '.join(map(str, numbers))} and {last}"
        self.require(
            block is not None,
            f"{named} do not turn about one direction",
            "Of joints that turn about one direction, some may slide.",
        )
        assert block is not None
        turns, slides = len(block.turns), block.slides
        levels = {k for k, *_ in block.across}
        if turns == 3:
            links = [level.shift[:2, 0].is_zero_matrix for level in block.levels[1:-1]]
            independent = not any(links) and all(
                k in (0, 3) or (axis[:2, 0].is_zero_matrix) for k, _, axis in slides
            )
            independent = independent and all(axis[2] != 0 for *_, axis in slides)
        else:
            independent = len(levels) == 1 and len(slides) in ((2,) if turns == 1 else (1, 2))
            if independent:
                across = block.normal[:2, 0] if turns == 2 else block.normal[2:, 0]
                independent = not simple(across).is_zero_matrix
        self.require(
            turns in count and independent,
            f"{named} are not links and slides of this kind",
            NEEDED,
        )
        (level,) = levels or {1}
        link = block.levels[1].shift
        self.require(
            turns != 2 or level == 1 or not link[:2, 0].is_zero_matrix,
            f"joint {block.lift.number} does not move the point across its slides",
            "A link beside its axis is needed there.",
        )
        return block

    def _require_turning(self, block: Block, others: Sequence[Single]) -> None:
        axes = [block.end * Z, *(joint.end * Z for joint in others[:-1])]
        self.require(
            not any(joint.slides for joint in others)
            and not any(simple(axis[:2, 0]).is_zero_matrix for axis in axes),
            "the other joints do not turn about other directions",
            "Beside joints that turn about one direction, neighbours must not be parallel.",
        )

    # The joints that turn, by the orientation

    def _wrist_beside(self, block: Block, others: Sequence[Single]) -> None:
        """Solve three turns; where they are free, the point has to stay within reach."""
        five, _ = others
        lift, shift = block.lift, block.levels[-1].shift
        after = times(block.end, f"(turned({{}}) * {source(five.shift)})")
        moves = not five.shift.is_zero_matrix
        to_end = f"{source(shift)} + {after}" if moves else source(shift)
        lengths = self._lengths_to_reach(block, five.shift)
        if not is_normal([lift, five]):
            self.require(
                len(lengths) != 1,
                "its wrist is oblique, and its slides are not between two joints about one axis",
                "The known chain needs right angles there.",
            )
            if lengths:
                entries = point("to_end") if moves else shift
                self.carried = Carried("p", to_end, lengths, entries)
            self.orientation([lift, *others], "M")
            if not (lengths and moves):
                self.vector("to_end", to_end.format(f"pair{five.number}"))
            return
        epsilon = ahead_of_lift(block.end * Z)
        if lengths:
            self._reach_by_tilt(block, five, lengths, epsilon)
        self.orientation([lift, *others], "M")
        if moves:
            aimed = times(block.end.T, f"(turned({self.lifted}).T * M[:, 2])")
            self.vector("aimed", aimed)
        self.vector("to_end", self._by_axis(block, five, point("aimed")))

    def _reach_by_tilt(
        self, block: Block, five: Single, lengths: Sequence[str], epsilon: sp.Expr
    ) -> None:
        """Name what two links reach, as a wrist turns and tilts what it carries."""
        sine, cosine = sine_cosine(epsilon)
        ahead = sp.Matrix([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        tilted = sp.Matrix([sp.Symbol("tilt.s"), 0, sp.Symbol("tilt.c")])
        carried = times(ahead.T, f"({self._by_axis(block, five, block.end.T * ahead * tilted)})")
        self.lines += [
            "def reaching(tilt):",
            f"    carried = {carried}",
            *self._within(block, lengths, ahead),
        ]
        self.more = ", reaching=reaching"

    def _beside_skew(self, arm: Singles, block: Block, others: Sequence[Single]) -> None:
        """Solve five joints of which three turn about one direction, and the others are skew.

        The direction of the last axis and the height of the tool are linear in the sine and the
        cosine of the joint before it.
        """
        five, last = others
        first, second = five.number, last.number
        low, high = min(first, second), max(first, second)
        self.require(
            not block.slides,
            f"axes {low} and {high} do not meet",
            "Beside joints of which one slides, the axes of the last two have to meet.",
        )
        toward, w, s = block.end.T * Z, five.end * Z, five.shift
        linear = sp.Matrix([turning(w, toward)[::-1], turning(s, toward)[::-1]])
        lever = sp.Abs(linear.det() / norm(toward[:2, 0])).simplify()
        self.require_long(arm, lever, (low, high))
        height = sum((level.shift[2] for level in block.levels[1:]), sp.S.Zero)
        levels = sp.Matrix([sp.Symbol("M[2, 2]"), sp.Symbol("p[2]") - height])
        levels -= toward[2] * sp.Matrix([w[2], s[2]])
        inverse = linear.inv().applyfunc(sp.simplify)
        self.vector("at_end", source(inverse * levels))
        pair = self._rotate(five, "(1, 0)", "at_end", scale="1")
        after = times(block.end, f"(turned({pair}) * {source(s)})")
        self.vector("to_end", f"{source(block.levels[-1].shift)} + {after}")
        self.vector("axis", times(block.end, f"turned({pair}) * {source(w)}"))
        lengths = [source(length) for length in block.reach]
        self.carried = Carried("p", "to_end", lengths, point("to_end"))
        self.lifted = self._rotate(block.lift, "axis", "M[:, 2]", scale="16", more=self._free())
        frames = [f"turned({self.lifted})", followed(f"turned({pair})", five.end)]
        self.add(f"R_last = {followed(frames[0], block.end)} * {frames[1]}")
        self.add("R_rest = ik.matrix('R_rest', R_last.T * M)")
        self._rotate(last, "(1, 0)", "R_rest[:, 0]", scale="1")

    def _within(self, block: Block, lengths: Sequence[str], ahead: sp.Matrix) -> list[str]:
        """The last lines of a function that says what is reached."""
        if len(lengths) == 2:
            return [
                "    offset = carried[0], carried[1]",
                f"    links = {', '.join(lengths)}",
                "    return Reaching.turning(ik, (p[0], p[1]), links, offset, lever=ik.size)",
            ]
        ((level, *_), *_), n = block.across, block.normal / norm(block.normal[:2, 0])
        moved, p, carried = simple(ahead.T * n), point("p"), point("carried")
        sine, cosine = turning(moved, p) if level else (-e for e in turning(carried, n))
        beside = -moved.dot(carried) if level else n.dot(p)
        target = f"({source(cosine)}, {source(sine)}), {source(beside)}, {lengths[0]}"
        return [
            "    lever = ik.size**2/(ik.size + sqrt(p[0]**2 + p[1]**2))",
            f"    return ReachingAcross.by_slide(ik, {target}, lever=lever)",
        ]

    def _by_axis(self, block: Block, five: Single, aimed: sp.Matrix) -> str:
        """What the joints carry, by where the axis after the next joint points, normal to it."""
        w, s = five.end * Z, five.shift
        along, aside = sp.simplify(s.dot(w)), sp.simplify(s.dot(Z.cross(w)))
        x, y, _ = aimed
        moved = sp.Matrix([along * x - aside * y, along * y + aside * x, s[2]])
        return source((block.levels[-1].shift + block.end * moved).applyfunc(sp.expand))

    def _lengths_to_reach(
        self, block: Block, beside: sp.Matrix, between: bool = False
    ) -> list[str]:
        """Those of two links that have to reach the point; none if any point is reached.

        One link with a slide across it reaches each point but near ones.  A vector ``beside`` the
        joints is between their end and the point ``p``; they may be ``between`` others.  One length
        is that of a link across the slides.
        """
        if len(block.turns) == 3:
            self.require(
                not block.across,
                "its slide leans to the axes about which three joints turn",
                "Where two axes of its wrist are parallel, the known chain needs a slide along "
                "those axes.",
            )
            return [source(length) for length in block.reach]
        ((level, *_), *_) = block.across
        if block.normal[2] != 0 or (level != 1 and between):
            raise NoChainError(
                "where two axes of its wrist are parallel, its slides reach the tool only in some "
                "postures",
                "After a turret the known chain has a slide between two joints that turn about one "
                "direction, or three such joints; other slides are along these axes or across "
                "them.  Otherwise use a numeric inverse, such as that of Pinocchio.",
                degree=2,
            )
        if level != 1:
            return [source(norm(block.levels[1].shift[:2, 0]))]
        (least,) = block.reach
        if least == 0:
            return []
        shifts = block.levels[-1].shift, beside
        farthest = sum((sp.sqrt(sp.simplify(v.dot(v))) for v in shifts), sp.S.Zero)
        self.add(f"far = ik.let('far', sqrt(p[0]**2 + p[1]**2) + {source(farthest)})")
        return [source(least + sp.Symbol("far")), "far"]

    # The point, where the turn of the last is known

    def _lifted_links(self, block: Block) -> str:
        """Solve three joints as two links, after a slide that lifts them; return what is left."""
        helper = Slides(self, block.joints, self.unknown)
        height = sum((level.shift[2] for level in block.levels[1:-1]), sp.S.Zero)
        for k, slide, axis in block.slides:
            helper.linear("q", height * Z, ((slide, axis[2] * Z),))
            if axis[:2, 0].is_zero_matrix:
                continue
            moved = source(helper.sense[slide.number] * axis)
            moved = f"turned({self.lifted}) * {moved}" if k else moved
            self.vector("q", f"q - {slide.joint}_*{moved}", "q2")
        one, two, _ = block.turns
        u, v = (level.shift[:2, 0] for level in block.levels[1:-1])
        self.two_links([one, two], [u, v], "q[0]", "q[1]")
        return f"Matrix([{source(sp.Symbol('q[2]') - height)}])"

    def _one_link(self, block: Block) -> str:
        """Solve two joints that turn by what is normal to the slides; return what is left."""
        helper, n = Slides(self, block.joints, self.unknown), block.normal
        first, _ = (joint for joint in block.joints if not joint.slides)
        one, two = block.turns
        level, shift, still = block.across[0][0], block.levels[1].shift, sp.zeros(3, 1)
        along = [(slide, axis) for _, slide, axis in block.slides]
        if level == 1:
            q, still = point("q"), shift
            sides = (*turning(n, q), sp.simplify(n.dot(shift)) - n[2] * q[2])
            pair = self._turn(replace(first, turn=one), sides)
            self.vector("q", f"turned({pair}).T * q", "q2")
        else:
            if level == 2:
                self.vector("q", f"turned({self.lifted}).T * q", "q1")
            sides = (*turning(shift, n), n.dot(point("q")) - sp.simplify(n[2] * shift[2]))
            pair = self._turn(replace(first, turn=one if level == 0 else -two), sides)
            self.vector("q", f"q - turned({pair}) * {source(shift)}", "q2")
        helper.linear("q", still, along)
        left = "q" if still.is_zero_matrix else f"q - {source(still)}"
        slid = [
            f"{slide.joint}_*{source(helper.sense[slide.number] * axis)}" for slide, axis in along
        ]
        return " - ".join([left, *slid])

    def _slides_alone(self, block: Block) -> None:
        """Solve two slides before the joint that turns with them, or after it."""
        ((level, *_), *_) = block.slides
        if level:
            self.vector("q", f"turned({self.lifted}).T * q", "q2")
        along = [(slide, axis) for _, slide, axis in block.slides]
        Slides(self, block.joints, self.unknown).linear("q", sp.zeros(3, 1), along)

    def _told(self, arm: Singles, block: Block, others: Sequence[Single]) -> str:
        if not block.slides:
            numbers = [joint.number for joint in arm.joints]
            meets = "meet" if arm.met(3, 2) else "skew"
            text = "axes {}, {} and {} parallel, {} and {} " + meets
            return text.format(*numbers)
        turns = f"{COUNTED[len(block.turns)]} joints that turn about one direction"
        if len(block.turns) == 1:
            turns = "one joint that turns"
        slides = "two slides" if len(block.slides) > 1 else "a slide"
        more = "two more" if len(others) > 1 else "one more"
        return f"{turns}, {slides} and {more}"


__all__ = ["OneDirectionMaker"]
