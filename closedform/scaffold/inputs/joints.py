"""Joints of files that describe robots, and those of them that follow others.

A joint that mimics another has no motor of its own.  It is read if it moves in the same way as a
neighbour on the chain: about the same axis, as in a parallelogram, or in the same direction, as
the stages of a telescope.  Both are then one joint of the arm, and its coupling says what its
motors do.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.model.functions import real
from closedform.model.names import listed
from closedform.scaffold.inputs.names import symbol_of
from closedform.scaffold.inputs.tables import (
    Table,
    TableError,
    add_joint,
    own_name,
    shown_name,
)

MOVING = {"revolute": "revolute", "continuous": "revolute", "prismatic": "prismatic"}


@dataclass(frozen=True)
class Joint:
    """A joint of the file, with its place on the parent link and its axis, as they are written."""

    name: str
    kind: str
    parent: str
    child: str
    origin: sp.Matrix
    axis: sp.Matrix
    limits: tuple[str, str] | None = None
    mimics: str = ""
    factor: sp.Rational = sp.S.One
    offset: sp.Rational = sp.S.Zero
    """Of a joint that mimics another: its value is the factor times that one, plus the offset."""
    written: tuple[sp.Matrix, sp.Matrix] | None = None
    """Place and axis without what was taken for other numbers; None if nothing was."""
    fault: str = ""
    """Why the joint cannot be on the chain, in words, if something else moves or holds it."""
    notes: tuple[str, ...] = ()
    """What was not taken as it is written."""


def declare(joint: Joint, table: Table, where: str) -> sp.Symbol:
    """The symbol of a joint that moves, which becomes one of the table, with its limits."""
    name = own_name(joint.name, table, where)
    add_joint(table, name, MOVING[joint.kind], where)
    if joint.limits:
        table.limits[name] = joint.limits
    return real(name)


def led(chain: Sequence[Joint], joints: Sequence[Joint], file: str) -> list[Joint]:
    """The chain, in which every joint that mimics another follows one that has a motor.

    A joint may follow one that follows a third.  If all of them follow a joint beside the chain, as
    the other finger of a hand, then the first of them on the chain leads the rest.
    """
    named = {j.name: j for j in joints}
    leaders: dict[str, Joint] = {j.name: j for j in chain if not j.mimics}
    found = []
    for joint in chain:
        if joint.fault:
            raise TableError(f"{file}, joint {shown_name(joint.name)}: {joint.fault}")
        if joint.kind in MOVING and joint.mimics:
            root, factor, offset = _root(joint, named, file)
            leader = leaders.setdefault(root, replace(joint, factor=factor, offset=offset))
            if leader.name == joint.name:
                note = (
                    f"{_where(joint, file)} and {shown_name(root)} is not on the chain; it counts "
                    f"as a joint with a motor of its own"
                )
                joint = replace(joint, mimics="", notes=(*joint.notes, note))
            elif leader.mimics:
                factor /= leader.factor
                offset -= factor * leader.offset
                joint = replace(joint, mimics=leader.name, factor=factor, offset=offset)
            else:
                joint = replace(joint, mimics=root, factor=factor, offset=offset)
        found.append(joint)
    return found


def _root(joint: Joint, named: dict[str, Joint], file: str) -> tuple[str, sp.Rational, sp.Rational]:
    """The joint that one follows in the end, the factor and the offset."""
    at, factor, offset = joint, sp.S.One, sp.S.Zero
    for _ in named:
        if not at.mimics:
            return at.name, factor, offset
        if at.factor == 0:
            raise TableError(f"{_where(at, file)} zero times; write it as a fixed joint")
        if at.mimics not in named:
            raise TableError(f"{_where(at, file)}, and the file has no such joint")
        offset += factor * at.offset
        factor *= at.factor
        at = named[at.mimics]
    raise TableError(f"{_where(joint, file)}, which follows it in turn; one needs a motor")


def _where(joint: Joint, file: str) -> str:
    return f"{file}, joint {shown_name(joint.name)}: it mimics {shown_name(joint.mimics)}"


@dataclass(frozen=True)
class Mimic:
    """A joint that mimics another of the chain, at home, after some number of other joints."""

    joint: Joint
    place: sp.Matrix
    after: int
    file: str

    @property
    def slides(self) -> bool:
        return MOVING[self.joint.kind] == "prismatic"

    def couple(self, table: Table) -> tuple[sp.Symbol, list[Any], list[Any]] | None:
        """Let a neighbour on the same axis turn by what this joint adds, or slide along with it.

        Returns the axis of a joint that follows a parallel one instead; None if there is none.
        """
        mimicked, factor = symbol_of(self.joint.mimics), self.joint.factor
        told, kind = _where(self.joint, self.file), MOVING[self.joint.kind]
        slides = self.slides
        near = [
            (str(table.axes[k][0]), sense)
            for k in self._near(table)
            if table.joints[str(table.axes[k][0])] == kind
            and (sense := self.sense(*table.axes[k][1:]))
        ]
        near.sort(key=lambda found: found[0] != mimicked)
        alike = kind == table.joints[mimicked]
        whole, beside = factor.is_Integer and alike, alike and self._turns_beside(table)
        if not near and whole and beside:
            return self._follower(table)
        if not near or not (slides or (whole and near[0][0] != mimicked)):
            alone = bool(near) and near[0][0] == mimicked
            why = self._refusal(alone=alone, near=bool(near) or beside, alike=alike)
            raise TableError(
                f"{told}; {why}.  A mimic joint is read if it turns about the axis of a neighbour "
                f"on the chain that has a motor of its own, and by a whole multiple of the angle "
                f"of another, as in a parallelogram; if it slides in the direction of a "
                f"neighbour, as in a telescope; or if it turns by a whole multiple of the angle of "
                f"a joint with a parallel axis, after a third such joint, as in a robot for "
                f"wafers.  If such joints keep the hand level, as in a "
                f"palletiser, write the arm as a table, with the lengths from the wrist to the "
                f"hand in the row of the turret, as docs/adding-a-mechanism.md says.  To give it a "
                f"motor of its own, leave its mimic element out of the file"
            )
        name, sense = near[0]
        own = table.couplings.get(name, real(f"m_{name}"))
        table.couplings[name] = own + sense * factor * real(f"m_{mimicked}")
        both = (
            f"both slide along the same line, and {name} is what they move together"
            if slides
            else f"both turn about the axis of {name}, whose angle is"
        )
        driven = f"{'; this is ' if slides else ' '}{table.couplings[name]}"
        table.notes.append(f"{told}; {both}{driven} in those of the motors")
        return None

    def _turns_beside(self, table: Table) -> bool:
        """Whether the joint turns about an axis parallel to that of the one it mimics, and so does
        a joint before that one, with no other direction between them."""
        names = [str(joint) for joint, *_ in table.axes]
        mimicked = symbol_of(self.joint.mimics)
        at = names.index(mimicked)
        if self.slides or mimicked in table.couplings or at >= self.after:
            return False
        before = [k for k in range(at) if table.joints[names[k]] == "revolute"]
        between_axes = table.axes[before[-1] : self.after] if before else []
        turning = [w for joint, w, _ in between_axes if table.joints[str(joint)] == "revolute"]
        return bool(turning) and all(map(self.along, turning))

    def _follower(self, table: Table) -> tuple[sp.Symbol, list[Any], list[Any]]:
        """The axis of the joint, which follows the one that it mimics."""
        mimicked, factor = symbol_of(self.joint.mimics), self.joint.factor
        where = f"{self.file}, joint {shown_name(self.joint.name)}"
        symbol = declare(replace(self.joint, limits=None), table, where)
        table.followers[symbol.name] = mimicked, factor
        table.notes.append(f"{_where(self.joint, self.file)}; it turns by {factor} times its angle")
        return symbol, list(self.axis), list(self.place[:3, 3])

    def _refusal(self, *, near: bool, alone: bool, alike: bool) -> str:
        """Why the joint is not one with another: is a neighbour ``near`` on its axis, or does it
        turn beside the one it mimics, is that ``alone`` on its axis, and are both ``alike``?"""
        mimicked = shown_name(self.joint.mimics)
        if not alike:
            return (
                "one of the two turns and the other slides, so that their inverse is not algebraic"
            )
        if not near and self.slides:
            return f"the motor of {mimicked} then moves the arm along two lines at once"
        if not near:
            return (
                f"its axis is not that of a neighbour, so that the motor of {mimicked} turns the "
                f"arm about two axes at once, and no lemma solves for such an angle"
            )
        if not alone:
            return (
                f"it turns by {self.joint.factor} times the angle, which is not a whole multiple, "
                f"so that a turn of the motor does not lead back to the same posture"
            )
        return (
            f"both turn about one axis, by {1 + self.joint.factor} times the angle of the motor, "
            f"of which the pose of the tool determines only the fraction of a turn"
        )

    def _near(self, table: Table) -> Iterator[int]:
        """The axes with which a joint can be one; slides do not change the direction of others."""
        ahead, back = range(self.after, len(table.axes)), range(self.after - 1, -1, -1)
        for side in (ahead, back):
            for k in side:
                yield k
                joint, direction, _ = table.axes[k]
                still = table.joints[str(joint)] == "prismatic" or self.along(direction)
                if self.joint.kind != "prismatic" or not still:
                    break

    @property
    def axis(self) -> sp.Matrix:
        return (self.place[:3, :3] * self.joint.axis).applyfunc(sp.expand)

    def along(self, direction: Sequence[sp.Expr]) -> bool:
        across = self.axis.cross(sp.Matrix(direction))
        return bool(across.applyfunc(sp.simplify).is_zero_matrix)

    def sense(self, direction: Sequence[sp.Expr], point: Sequence[sp.Expr]) -> int:
        """1 or -1 if an axis is that of this joint, in its direction or against it; else 0.

        Only the direction matters of a joint that slides.
        """
        between_axes = sp.Matrix(point) - self.place[:3, 3]
        if not self.along(direction):
            return 0
        if self.joint.kind != "prismatic" and not self.along(between_axes):
            return 0
        return self.sign(direction)

    def sign(self, direction: Sequence[sp.Expr]) -> int:
        """1 or -1 if this joint turns as one about a parallel direction does, or against it."""
        return 1 if sp.simplify(self.axis.dot(sp.Matrix(direction))) > 0 else -1


def _refuse_finger(mimics: Sequence[Mimic], table: Table) -> None:
    """Refuse joints that follow one motor about parallel axes, which no other joint turns about."""
    leaders = {symbol_of(mimic.joint.mimics) for mimic in mimics}
    at = {str(joint): (direction, point) for joint, direction, point in table.axes}
    if len(leaders) != 1 or any(mimic.slides for mimic in mimics):
        return
    (leader,) = leaders
    if table.joints[leader] == "prismatic":
        return
    direction, point = at.pop(leader)
    beside = [m for m in mimics if m.along(direction) and not m.sense(direction, point)]
    others = [w for joint, (w, _) in at.items() if table.joints[joint] == "revolute"]
    if len(beside) != len(mimics) or any(mimics[0].along(w) for w in others):
        return
    total = 1 + sum(m.joint.factor * m.sign(direction) for m in mimics)
    names = [shown_name(m.joint.name) for m in mimics]
    follow = "follow the motor of", "follows the motor of"
    axes = "about axes parallel to its own", "about an axis parallel to its own"
    one = len(names) == 1
    raise TableError(
        f"{mimics[0].file}: {'joint' if one else 'joints'} {listed(names)} {follow[one]} "
        f"{shown_name(mimics[0].joint.mimics)} {axes[one]}, as in a finger.  {_turned_by(total)}, "
        f"so there is no inverse.  To solve it as if each joint had a motor of its own, leave the "
        f"mimic elements out of the file; or end the chain before them, with --tool "
        f"{shown_name(mimics[0].joint.parent)}.  If bars couple the joints, write them as a loop "
        f"file, as docs/closed-loops.md says"
    )


def _turned_by(total: sp.Rational) -> str:
    """What a motor turns a tip by, and why this does not give its angle."""
    if total == 0:
        return "The tip does not turn, and an arm needs a joint for each motion of its tool"
    if abs(total) == 1:
        return "The tip turns as the motor does, but an arm needs a motor for each joint"
    return (
        f"The tip turns by {float(total):g} times the angle of the motor, and no lemma divides an "
        f"angle"
    )


def couple(mimics: Sequence[Mimic], table: Table) -> None:
    """Add what joints that mimic others do to those that they are one with."""
    _refuse_finger(mimics, table)
    axes = [(mimic.after, axis) for mimic in mimics if (axis := mimic.couple(table))]
    for after, axis in reversed(axes):
        table.axes.insert(after, axis)
    for follower, (leader, _) in table.followers.items():
        if leader in table.couplings:
            raise TableError(
                f"{mimics[0].file}, joint {follower}: it mimics {leader}, about whose axis another "
                f"joint turns too, so that the angle of {leader} is not that of its motor; write "
                f"the arm as a table with a column motors"
            )
    for name, driven in table.couplings.items():
        limits = table.limits.pop(name, None)
        share = driven / real(f"m_{name}")
        if limits and share.is_Rational:
            least, most = sorted(share * sp.Rational(value) for value in limits)
            table.limits[name] = (str(least), str(most))


__all__ = ["MOVING", "Joint", "Mimic", "couple", "declare", "led"]
