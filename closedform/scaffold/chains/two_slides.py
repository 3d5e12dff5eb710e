"""Writes the chain of a turret, two slides and two joints whose axes need not meet: C-arms.

The turret leaves two equations that hold no other joint.  They say where the last axis points along
that of joint 4, and where it is across the slides; for what joint 4 carries follows from where it
turns the last axis.  Both are linear in the sine and the cosine of the turret.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.scaffold.chains.chainlinks import Singles, parallel, plain
from closedform.scaffold.chains.maker import Z, point, times, turning
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.source import source


@dataclass
class TwoSlidesMaker(SubproblemMaker):
    """Writes the lines for five joints of which the second and the third slide."""

    def two_slides(self, arm: Singles) -> str:
        """A turret, two slides, and two joints that turn about axes in any direction."""
        one, two, three, four, five = (plain(joint) for joint in arm.joints)
        kinds = [joint.slides for joint in arm.joints]
        self.require(
            kinds == [False, True, True, False, False] and not parallel(four),
            f"joints {one.number} to {five.number} are not a turret, two slides and two that turn",
            "Where the last axes do not meet, the slides have to follow a turret, and the axes "
            "after them must not be parallel.",
        )
        along, across = _simple(one.end * Z), _simple(one.end * two.end * Z)
        normal, F = _simple(along.cross(across)), _simple(one.end * two.end * three.end)
        self.require(
            not normal.is_zero_matrix,
            "the directions of its slides depend on each other",
            "Slides need independent directions.",
        )
        start = _simple(one.shift + one.end * (two.shift + two.end * three.shift))
        R = self.centre(arm)
        self.vector("tool", times(arm.lead[:3, :3].T, self.last_axis(arm, R)))
        normal = _simple(normal / sp.sqrt(normal.dot(normal)))
        axis, w, s = _simple(F * Z), _simple(four.end * Z), four.shift
        square = sp.simplify(w[0] ** 2 + w[1] ** 2)
        ahead, aside = (sp.simplify(e / square) for e in turning(w, s)[::-1])
        self.require(
            not (normal[:2, 0].is_zero_matrix and axis[:2, 0].is_zero_matrix),
            f"joint {one.number} does not move the tool across its slides",
            "A turret has to turn its slides or the axis after them.",
        )
        p, tool = point("p"), point("tool")
        beside = _simple(normal.cross(axis))
        place = p - ahead * tool
        first = [
            sp.simplify(a - aside * b)
            for a, b in zip(turning(normal, place), turning(beside, tool), strict=True)
        ]
        level = normal.dot(start) + (s[2] - ahead * w[2]) * normal.dot(axis)
        level -= normal[2] * place[2] - aside * beside[2] * tool[2]
        second = turning(axis, tool)
        sides = (*first, sp.simplify(level)), (*second, w[2] - axis[2] * tool[2])
        for name, side in zip(("across", "along"), sides, strict=True):
            self.add(f"{name} = Matrix([{', '.join(source(e) for e in side)}])")
        self.add("side = ik.let('side', ik.size*sign_of(across[0]*along[0] + across[1]*along[1]))")
        self.vector("both", "across + side*along")
        pair = self._turn(one, tuple(point("both")))
        frame = f"turned({pair}).T"
        self.vector("aimed", times(F.T, f"({frame} * tool)"))
        fourth = self._rotate(four, source(w[:2, 0]), "aimed", scale="1")
        self.vector("q", f"{frame} * p - {times(F, f'(turned({fourth}) * {source(s)})')}")
        Slides(self, arm.joints, self.unknown).linear("q", start, ((two, along), (three, across)))
        M = times(F.T, f"({frame} * {times(arm.lead[:3, :3].T, R)})")
        M = self.without_tool(arm.tool[:3, :3], M)
        self.add(
            f"R_rest = ik.matrix('R_rest', {times(four.end.T, f'(turned({fourth}).T * {M})')})"
        )
        self._rotate(five, "(1, 0)", "R_rest[:, 0]", scale="1")
        self.add("ik.reached()")
        return "a turret, two slides and two joints whose axes pass each other"


def _simple(value: sp.Matrix) -> sp.Matrix:
    return sp.Matrix(value).applyfunc(sp.simplify)


__all__ = ["TwoSlidesMaker"]
