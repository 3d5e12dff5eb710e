"""Writes the chain of slides among joints that turn, whose axes are not parallel.

Cranes whose boom turns between a lift and a telescope, and cylindrical joints one after another,
are of this kind.  The joints that turn follow from the orientation alone.  Then the direction of
each slide is known, and what is left of the position is linear in the slides.  Slides that become
parallel determine their sum only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import sympy as sp

from closedform.mechanics.frames import rotation
from closedform.scaffold.chains.chainlinks import Single, Singles, plain
from closedform.scaffold.chains.maker import (
    Z,
    ahead_of_lift,
    heading,
    point,
    simple,
    sine_cosine,
    times,
)
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.chains.wrists import is_normal
from closedform.scaffold.source import source

NAMES = {1: "a slide", 2: "two slides", 3: "three slides"}


@dataclass
class Stretch:
    """What is between two joints that turn: slides along directions, a shift and a rotation.

    All are in the frame after the first of both joints.
    """

    shift: sp.Matrix = field(default_factory=lambda: sp.zeros(3, 1))
    end: sp.Matrix = field(default_factory=lambda: sp.eye(3))
    slides: list[tuple[Single, sp.Matrix]] = field(default_factory=list)

    def extend(self, joint: Single) -> None:
        if joint.slides:
            self.slides.append((joint, simple(self.end * Z)))
        self.shift = simple(self.shift + self.end * joint.shift)
        self.end = simple(self.end * joint.end)


class AmongTurnsMaker(SubproblemMaker):
    """Writes the lines for up to three slides among one or two joints that turn, or three."""

    def among_turns(self, arm: Singles) -> str:
        """The pose of fewer than six joints."""
        turning = [j for j in arm.joints if not j.slides]
        slides = [j for j in arm.joints if j.slides]
        self.require(
            0 < len(turning) <= 2 and 0 < len(slides) <= 3,
            "it has more than two joints that turn among its slides",
            "Up to three slides among one or two joints that turn are solved after these.",
        )
        arm = replace(arm, joints=tuple(map(plain, arm.joints)))
        stretches = self._stretches(arm)
        axes = [s.end * Z for s in stretches[1:-1]]
        self.require(
            not any(axis[:2, 0].is_zero_matrix for axis in axes),
            "its joints that turn are parallel",
            "The joints that turn must follow from the orientation of the tool.",
        )
        M = self._rotation(arm, stretches)
        self.orientation(self._ends(turning, stretches), M)
        pairs = [f"pair{joint.number}" for joint in turning]
        self._position(pairs, stretches, Slides(self, slides, self.unknown))
        self.add("ik.reached()")
        turns = "two joints that turn" if len(turning) > 1 else "a joint that turns"
        return f"{NAMES[len(slides)]} among {turns}"

    def in_a_plane(self, arm: Singles) -> str:
        """Five joints: a turn between two slides in its plane, and two turns whose axes meet.

        Where the first and the last of the turns are parallel, the slides reach each point of the
        plane at any angle of the first but those at which they are parallel too.
        """
        kinds = "".join("P" if j.slides else "R" for j in arm.joints)
        slides = [j for j in arm.joints if j.slides]
        moved = replace(arm, joints=tuple(map(plain, arm.joints))).met(3, 2)
        self.require(
            kinds == "PRPRR" and moved is not None,
            "it is not a turn between two slides, and two turns whose axes meet",
            "Of five joints with two slides this chain needs these, in this order.",
        )
        assert moved is not None
        turning = [j for j in moved.joints if not j.slides]
        stretches = self._stretches(moved)
        before, after = stretches[:2]
        (_, a), (_, b) = (*before.slides, *after.slides)
        a = simple(before.end.T * a)
        self.require(
            a[2] == b[2] == 0 and not (after.end * Z)[:2, 0].is_zero_matrix,
            "its slides are not in the plane of the turn between them",
            "The known chain needs right angles there.",
        )
        self.require(
            sp.simplify(b.cross(after.shift)[2]) == 0,
            "the point where the last two axes meet is beside the line along which it slides",
            "Where its slides are nearly parallel, one solution is far away then.",
        )
        ends = self._ends(turning, stretches)
        self.require(
            is_normal(ends),
            "the axes of its turns are not at right angles",
            "Where its slides are nearly parallel, one solution is far away then.",
        )
        M = self._rotation(moved, stretches)
        first, *others = ends
        turn = heading(a) - heading(b) + sp.pi / 2 + ahead_of_lift(first.end * Z)
        turn = sp.atan2(*sine_cosine(turn))
        back = rotation("z", -turn).applyfunc(sp.simplify)
        if back != sp.eye(3):
            self.add(f"M = ik.matrix('M_turned', {times(back, M)})")
            M = "M"
        self.orientation([replace(first, turn=first.turn - turn), *others], M)
        sine, cosine = sine_cosine(turn)
        ahead = "" if turn == 0 else f" + Pair({source(sine)}, {source(cosine)})"
        helper = Slides(self, slides, self.unknown)
        self._position([f"({self.lifted}{ahead})"], stretches, helper)
        ((joint, axis),) = before.slides
        slid = helper.sense[joint.number] * sp.Symbol(f"{joint.joint}_") * axis
        self.add(f"ik.reached(q - {source(slid)})")
        return "a turn between two slides in its plane, and two more"

    def _ends(self, turning: Sequence[Single], stretches: Sequence[Stretch]) -> list[Single]:
        """The joints that turn, each with the rotation to the next."""
        return [replace(j, end=s.end) for j, s in zip(turning, stretches[1:], strict=True)]

    def _rotation(self, arm: Singles, stretches: Sequence[Stretch]) -> str:
        """The rotation that is left to the joints that turn."""
        R = self.centre(arm)
        M = times(simple(stretches[0].end.T * arm.lead[:3, :3].T), R)
        self.add(f"M = ik.matrix('M', {M})")
        return self.without_tool(simple(stretches[-1].end * arm.tool[:3, :3]), "M")

    def _stretches(self, arm: Singles) -> list[Stretch]:
        """What is before, between and after the joints that turn; not the motion to the tool."""
        found = [Stretch()]
        last = arm.joints[-1]
        still = replace(last, shift=sp.zeros(3, 1), end=sp.eye(3))
        for joint in (*arm.joints[:-1], still):
            if not joint.slides:
                found.append(Stretch())
            found[-1].extend(joint)
        return found

    def _position(self, pairs: Sequence[str], stretches: Sequence[Stretch], helper: Slides) -> None:
        """Solve the slides, seen from the stretch that has most of them.

        ``pairs`` are those of the joints that turn.
        """
        home = max(range(len(stretches)), key=lambda k: len(stretches[k].slides))

        def seen(k: int, value: str) -> str:
            """A vector of a stretch, in the frame of the one at home."""
            for i in range(k, home):
                value = f"turned({pairs[i]}).T * {times(stretches[i].end.T, value)}"
            for i in range(k, home, -1):
                value = times(stretches[i - 1].end, f"(turned({pairs[i - 1]}) * {value})")
            return value

        place = "p"
        for k, stretch in enumerate(stretches[: home + 1]):
            if not stretch.shift.is_zero_matrix:
                place = f"({place} - {source(stretch.shift)})"
            if k < home:
                place = f"turned({pairs[k]}).T * {times(stretch.end.T, place)}"
        for k, stretch in enumerate(stretches[home + 1 :], home + 1):
            if not stretch.shift.is_zero_matrix:
                place = f"{place} - {seen(k, source(stretch.shift))}"
        self.vector("q", place)
        fixed = stretches[home].slides
        moving = [(k, *s) for k, part in enumerate(stretches) if k != home for s in part.slides]
        self.require(
            len(moving) < 2 and len(fixed) + len(moving) < 4,
            "each of its three slides is between other joints that turn",
            "Two of three slides have to be beside each other.",
        )
        for k, joint, direction in moving:
            self.vector("moved", seen(k, source(direction)))
            self._apart(joint, helper.sense[joint.number], [axis for _, axis in fixed])
        helper.linear("q", sp.zeros(3, 1), fixed)

    def _apart(self, joint: Single, sense: int, fixed: Sequence[sp.Matrix]) -> None:
        """Solve a slide along ``moved`` by what is normal to the ``fixed`` directions."""
        others = "the other slides" if len(fixed) > 1 else "the other slide"
        if len(fixed) > 1:
            normal = simple(fixed[0].cross(fixed[1]))
            normal = simple(normal / sp.sqrt(normal.dot(normal)))
            self.add(f"across = {source(normal)}.dot(moved)")
            k, c = "across**2", f"across*{source(normal)}.dot(q)"
            meaning = f"{joint.joint} slides in the plane of {others}"
        else:
            (axis,) = fixed
            self.vector("across", source(axis.cross(point("moved"))))
            k, c = "across.dot(across)", f"across.dot({source(axis.cross(point('q')))})"
            meaning = f"{joint.joint} slides along {others}"
        value, sign = f"{joint.joint}_", "" if sense > 0 else "-"
        self.solve("quotient", f"{joint.joint}, {k}, {sign}{c}, meaning='{meaning}'", value)
        self.vector("q", f"q - {sign}{value}*moved", "q_fixed")


__all__ = ["AmongTurnsMaker"]
