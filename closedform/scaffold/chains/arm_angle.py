"""Writes the chain of an arm of seven joints whose arm angle is an input of the inverse."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.mechanics.frames import rotation
from closedform.scaffold.chains.chainlinks import Single, Singles
from closedform.scaffold.chains.maker import followed, times
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.chains.wrists import is_normal
from closedform.scaffold.source import source

NAME = "arm_angle"
SIDES = "{+1: 'front', -1: 'back'}"


class ArmAngleMaker(SubproblemMaker):
    """Writes the lines for a spherical shoulder, an elbow and a spherical wrist."""

    def solved_by_arm_angle(self, arm: Singles) -> str:
        """Solve the elbow by a distance, then the shoulder in its plane, then the wrist."""
        wrist = arm.met(4, 3)
        found = wrist.met(0, 3) if wrist else None
        self.require(
            found is not None,
            "its first three axes, or its last three, do not meet in a point",
            "An arm angle needs a spherical shoulder and a spherical wrist.",
        )
        assert found is not None
        *shoulder, elbow = found.joints[:4]
        for three in (shoulder, found.joints[4:]):
            self.require_right_angles(three)
        first = found.joints[2]
        e, u = (first.end.T * first.shift).applyfunc(sp.simplify), elbow.shift
        self.require(
            sp.simplify(e[2] + u[2]) == 0,
            "the line from its shoulder to its wrist is not normal to axis 4",
            "An arm angle needs both in a plane that is normal to the axis of the elbow.",
        )
        R = self.centre(found)
        turned = [followed(f"rotation('z', {source(j.turn)})", j.end) for j in shoulder]
        sense = self._sense(shoulder)
        self.add(f"R_shoulder = {' * '.join(turned)}")
        self.add(f"to_wrist = {source(e)} + rotation('z', {source(elbow.turn)}) * {source(u)}")
        self.add(f"given = arm_angle(ik, R_shoulder, to_wrist[:2, 0]{sense})")
        self.add("p_norm = ik.let('p_norm', sqrt(p.dot(p)))")
        pair, turn = f"pair{elbow.number}", self.elbow(elbow, e, u)
        if turn != pair:
            self.add(f"{pair} = {turn}.known_as(ik.program, '_{pair}')")
        self.vector("to_wrist", f"{source(e)} + turned({pair}) * {source(u)}")
        because = f"because={{{self.unknowns[elbow.number]}: 1}}"
        arguments = f"given, R_shoulder, to_wrist[:2, 0], p, {because}{sense}"
        self.solve("arm_plane", arguments, "M")
        self.add(f"left1 = ik.matrix('left1', M * {source(first.end.T)})")
        self.normal_wrist(shoulder, "left1", ", name='shoulder'", SIDES)
        inside = f"(turned({pair}).T * (M.T * {times(found.lead[:3, :3].T, R)}))"
        self.add(f"left2 = ik.matrix('left2', {times(elbow.end.T, inside)})")
        ends = found.joints[4:]
        self.normal_wrist(ends, self.without_tool(found.tool[:3, :3], "left2"))
        return "spherical shoulder, elbow and spherical wrist, with the arm angle given"

    def require_right_angles(self, joints: Sequence[Single]) -> None:
        numbers = [j.number for j in joints]
        self.require(
            is_normal(joints),
            "axes {}, {} and {} are not at right angles".format(*numbers),
            "An arm angle needs neighbours at right angles in its shoulder and its wrist.",
        )

    def _sense(self, shoulder: Sequence[Single]) -> str:
        """An argument that counts the arm angle from where axis 4 points as axis 2, if it may."""
        _, second, third = shoulder
        home = rotation("z", third.turn.xreplace({third.joint: sp.S.Zero}))
        along = (second.end * home * third.end)[2, 2]
        return ", sense=-1" if sp.simplify(along).is_negative else ""


__all__ = ["NAME", "ArmAngleMaker"]
