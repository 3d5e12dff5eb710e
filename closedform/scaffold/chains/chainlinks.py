"""An arm as single joints: a turn or slide along z each, and the constant motion to the next."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.mechanics.arm import Serial
from closedform.mechanics.frames import homogeneous, inverse, rotation
from closedform.scaffold.chains.maker import Z
from closedform.scaffold.source import GIVEN


@dataclass(frozen=True)
class Single:
    """``Rz(turn)``, then the ``shift`` and the rotation ``end`` to the frame of the next joint.

    ``number`` counts the joints of the arm from 1.
    """

    number: int
    joint: sp.Symbol
    turn: sp.Expr
    slides: bool
    shift: sp.Matrix
    end: sp.Matrix

    @property
    def sense(self) -> int:
        """Whether a joint moves along or about its axis (1), or against it (-1)."""
        return int((self.shift[2] if self.slides else self.turn).diff(self.joint))


def slid(single: Single) -> sp.Expr:
    """How far a slide moves along its axis; 0 for a joint that turns."""
    return single.sense * single.joint if single.slides else sp.S.Zero


def plain(joint: Single) -> Single:
    """A slide without a constant turn, and without its variable in the shift."""
    if not joint.slides:
        return joint
    R = rotation("z", joint.turn)
    shift = R * (joint.shift - slid(joint) * Z)
    shift, end = (sp.Matrix(v).applyfunc(sp.simplify) for v in (shift, R * joint.end))
    return replace(joint, shift=shift, end=end)


@dataclass(frozen=True)
class Singles:
    """``lead``, the joints one by one; the tool is at ``last`` in the frame after the last one.

    With ``inverted`` this is the arm from the tool to the base, and its target the inverse pose.
    """

    joints: tuple[Single, ...]
    lead: sp.Matrix
    inverted: bool = False

    @property
    def tool(self) -> sp.Matrix:
        """The constant motion after the last joint."""
        return _motion(self.joints[-1])

    def pose(self) -> sp.Matrix:
        """Where the tool is, or the base seen from the tool."""
        found = self.lead
        for joint in self.joints:
            found = found * sp.diag(rotation("z", joint.turn), 1) * _motion(joint)
        return found

    def reversed(self) -> Singles:
        """The arm seen from its tool: the inverse of each motion, in the opposite order."""
        still = [replace(s, shift=s.shift - slid(s) * Z) for s in self.joints]
        after = [_inverse(self.lead), *(_inverse(_motion(s)) for s in still)]
        joints = []
        for k in range(len(self.joints) - 1, -1, -1):
            single, motion = self.joints[k], after[k]
            joints.append(
                replace(
                    single,
                    turn=-single.turn,
                    shift=motion[:3, 3] - slid(single) * Z,
                    end=motion[:3, :3],
                )
            )
        return Singles(tuple(joints), after[-1], not self.inverted)

    def orders(self) -> Iterator[Singles]:
        """This arm, and the same with slides moved past joints that turn about parallel axes."""
        found, seen = [self], {self.numbers}
        for arm in found:
            yield arm
            for k in range(len(arm.joints) - 1):
                first, second = arm.joints[k : k + 2]
                if first.slides == second.slides or not parallel(first):
                    continue
                exchanged = arm._exchanged(k)
                if exchanged.numbers not in seen:
                    seen.add(exchanged.numbers)
                    found.append(exchanged)

    @property
    def numbers(self) -> tuple[int, ...]:
        return tuple(joint.number for joint in self.joints)

    def _exchanged(self, k: int) -> Singles:
        """The arm with joint ``k`` after the next; one slides along the axis of the other."""
        first, second = self.joints[k : k + 2]
        along = (first.end * Z)[2]
        slide, turn = (first, second) if first.slides else (second, first)
        plain = replace(slide, shift=slide.shift - slid(slide) * Z)
        still = sp.diag(rotation("z", slide.turn), 1) * _motion(plain)
        moved, free = along * slid(slide) * Z, sp.zeros(3, 1)
        joints, lead = list(self.joints), self.lead
        if first.slides:
            joints[k] = replace(turn, shift=free, end=sp.eye(3))
            joints[k + 1] = replace(slide, turn=sp.S.Zero, shift=turn.shift + moved, end=turn.end)
            before = (lead if k == 0 else _motion(joints[k - 1])) * still
            if k == 0:
                lead = _simplified(before)
            else:
                joints[k - 1] = _moved(joints[k - 1], before)
        else:
            joints[k] = replace(slide, turn=sp.S.Zero, shift=moved, end=sp.eye(3))
            joints[k + 1] = _moved(turn, _motion(turn) * still)
        return Singles(tuple(joints), lead, self.inverted)

    def with_given(self, number: int, value: sp.Symbol) -> Singles:
        """The arm with a joint that has a known ``value``."""
        k = next(i for i, s in enumerate(self.joints) if s.number == number)
        known = {self.joints[k].joint: value}
        turned = rotation("z", self.joints[k].turn.xreplace(known)).applyfunc(sp.expand_trig)
        fixed = sp.diag(turned, 1) * _motion(self.joints[k]).xreplace(known)
        others = [*self.joints[:k], *self.joints[k + 1 :]]
        if k == 0:
            return Singles(tuple(others), _simplified(self.lead * fixed), self.inverted)
        before = _motion(others[k - 1]) * fixed
        others[k - 1] = _moved(others[k - 1], before)
        return Singles((*others[: k - 1], *_level(others[k - 1 :])), self.lead, self.inverted)

    def met(self, first: int, count: int) -> Singles | None:
        """The same with the origins of joints that meet in one point moved there; None if not.

        The point of axes that a given joint can make parallel counts only if it stays where it is.
        """
        joints = list(self.joints)
        lead = self.lead
        chosen = joints[first : first + count]
        if len(chosen) < count or any(j.slides for j in chosen):
            return None
        for k in range(first, first + count - 1):
            shift, axis = joints[k].shift, joints[k].end * Z
            across = axis[:2, 0]
            if across.is_zero_matrix:
                return None
            square = sp.simplify(across.dot(across))
            beta = sp.simplify(across.dot(shift[:2, 0]) / square)
            if square.has(GIVEN) and beta.has(GIVEN):
                return None
            rest = (shift - beta * axis).applyfunc(sp.simplify)
            if not rest[:2, 0].is_zero_matrix:
                return None
            alpha = rest[2]
            if alpha != 0:
                if k > first:
                    return None
                if k == 0:
                    move = lead[:3, :3] * (alpha * Z)
                    lead = lead.copy()
                    lead[:3, 3] = lead[:3, 3] + move
                else:
                    before = joints[k - 1]
                    moved = (before.shift + before.end * (alpha * Z)).applyfunc(sp.simplify)
                    joints[k - 1] = replace(before, shift=moved)
            joints[k] = replace(joints[k], shift=sp.zeros(3, 1))
            onward = (joints[k + 1].shift + beta * Z).applyfunc(sp.simplify)
            joints[k + 1] = replace(joints[k + 1], shift=onward)
        return Singles(tuple(joints), lead, self.inverted)


def singles(arm: Serial) -> Singles:
    """The joints of an arm one by one; the tool is part of the last motion."""
    joints: list[Single] = []
    names = iter(arm.axes)
    for group in arm.groups:
        for i, row in enumerate(group.rows):
            end = group.end if i == len(group.rows) - 1 else sp.eye(3)
            number = len(joints) + 1
            joints.append(
                Single(
                    number=number,
                    joint=next(names),
                    turn=row.turn,
                    slides=row.slides,
                    shift=sp.Matrix(row.shift),
                    end=end,
                )
            )
    last = joints[-1]
    motion = _motion(last) * arm.last
    joints[-1] = replace(last, shift=motion[:3, 3], end=motion[:3, :3])
    return Singles(tuple(joints), arm.lead)


def parallel(single: Single) -> bool:
    """Whether the axis after a joint is parallel to its own."""
    return bool((single.end * Z)[:2, 0].applyfunc(sp.simplify).is_zero_matrix)


def _motion(single: Single) -> sp.Matrix:
    return homogeneous(single.end, tuple(single.shift))


def _level(joints: Sequence[Single]) -> list[Single]:
    """The same with frames that are turned only where the direction of the axes changes.

    Of two axes in opposite directions the second one is turned round, with its joint.
    """
    found = list(joints)
    for k, after in enumerate(found[1:], 1):
        end = found[k - 1].end
        if not parallel(found[k - 1]) or end.free_symbols:
            continue
        flip = sp.eye(3) if sp.simplify((end * Z)[2]) > 0 else sp.diag(1, -1, -1)
        turned = end * flip
        sense = flip[2, 2]
        turn = sense * after.turn + sp.atan2(turned[1, 0], turned[0, 0])
        found[k - 1] = replace(found[k - 1], end=sp.eye(3))
        found[k] = replace(after, turn=turn, shift=flip * after.shift, end=flip * after.end)
    return found


def _moved(single: Single, motion: sp.Matrix) -> Single:
    """The joint with another ``motion`` after it."""
    motion = _simplified(motion)
    return replace(single, shift=motion[:3, 3], end=motion[:3, :3])


def _inverse(motion: sp.Matrix) -> sp.Matrix:
    return inverse(motion).applyfunc(sp.expand)


def _simplified(motion: sp.Matrix) -> sp.Matrix:
    return motion.applyfunc(lambda e: sp.trigsimp(sp.expand(e)) if e.has(sp.sin, sp.cos) else e)


__all__ = ["Single", "Singles", "parallel", "plain", "singles", "slid"]
