"""Writes the chain of a turret, two slides and two joints whose axes need not meet, as in a C-arm.

The turret is before both slides or after them.  It leaves two equations that hold no other joint.
They say where the last axis points along that of joint 4, and where it is across the slides; for
what joint 4 carries follows from where it turns the last axis.  Both are linear in the sine and the
cosine of the turret.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, Singles, parallel, plain
from closedform.scaffold.chains.maker import Z, point, simple, times, turning
from closedform.scaffold.chains.slides import Slides
from closedform.scaffold.chains.subproblems import SubproblemMaker
from closedform.scaffold.source import source


@dataclass(frozen=True)
class Ends:
    """What joint 4 carries to the last axis, by the directions of both axes, and across them.

    That is ``level`` times its own axis, ``ahead`` times the last one, and ``aside`` times their
    cross product, of which the scalar product is ``inclined``.
    """

    joint: Single

    @cached_property
    def axis(self) -> sp.Matrix:
        return simple(self.joint.end * Z)

    @property
    def inclined(self) -> sp.Expr:
        return self.axis[2]

    @cached_property
    def ahead(self) -> sp.Expr:
        return self._share(turning(self.axis, self.joint.shift)[1])

    @cached_property
    def aside(self) -> sp.Expr:
        return self._share(turning(self.axis, self.joint.shift)[0])

    @property
    def level(self) -> sp.Expr:
        return sp.simplify(self.joint.shift[2] - self.ahead * self.axis[2])

    def _share(self, value: sp.Expr) -> sp.Expr:
        return sp.simplify(value / (self.axis[0] ** 2 + self.axis[1] ** 2))


@dataclass
class TwoSlidesMaker(SubproblemMaker):
    """Writes the lines for five joints of which the first three are a turret and two slides."""

    def two_slides(self, arm: Singles) -> str:
        """A turret before two slides or after them, and two joints about axes in any direction."""
        one, two, three, four, five = (plain(joint) for joint in arm.joints)
        kinds = [joint.slides for joint in arm.joints]
        self.require(
            kinds in ([False, True, True, False, False], [True, True, False, False, False])
            and not parallel(four),
            f"joints {one.number} to {five.number} are not a turret, two slides and two that turn",
            "Where the last axes do not meet, two slides have to be before or after a turret, and "
            "the axes after them must not be parallel.",
        )
        R = self.centre(arm)
        lead = arm.lead[:3, :3]
        self.vector("tool", times(lead.T, self.last_axis(arm, R)))
        if kinds[0]:
            frame, start = simple(one.end * two.end), simple(one.shift + one.end * two.shift)
            self.vector("p", times(frame.T, f"(p - {source(start)})"), "p_turret")
            self.vector("tool", times(frame.T, "tool"), "tool_turret")
            lead = simple(lead * frame)
            slides = (one, simple(frame.T * Z)), (two, simple(two.end.T * Z))
            turret, start, F = three, three.shift, three.end
        else:
            slides = (two, simple(one.end * Z)), (three, simple(one.end * two.end * Z))
            turret, F = one, simple(one.end * two.end * three.end)
            start = simple(one.shift + one.end * (two.shift + two.end * three.shift))
        ends = Ends(four)
        write = self._after if kinds[0] else self._before
        pair = write(turret, [a for _, a in slides], start, simple(F * Z), ends)
        frame = f"turned({pair}).T"
        self.vector("aimed", times(F.T, f"({frame} * tool)"))
        fourth = self._rotate(four, source(ends.axis[:2, 0]), "aimed", scale="1")
        carried = times(F, f"(turned({fourth}) * {source(four.shift)})")
        helper = Slides(self, arm.joints, self.unknown)
        if kinds[0]:
            self.vector("q", f"p - turned({pair}) * ({source(start)} + {carried})")
            helper.linear("q", sp.zeros(3, 1), slides)
        else:
            self.vector("q", f"{frame} * p - {carried}")
            helper.linear("q", start, slides)
        M = times(F.T, f"({frame} * {times(lead.T, R)})")
        M = self.without_tool(arm.tool[:3, :3], M)
        left = times(four.end.T, f"(turned({fourth}).T * {M})")
        self.add(f"R_rest = ik.matrix('R_rest', {left})")
        self._rotate(five, "(1, 0)", "R_rest[:, 0]", scale="1")
        self.add("ik.reached()")
        return "a turret, two slides and two joints whose axes pass each other"

    def _normal(self, turret: Single, slides: Sequence[sp.Matrix], axis: sp.Matrix) -> sp.Matrix:
        """The unit vector across the slides."""
        first, second = slides
        normal = simple(first.cross(second))
        self.require(
            not normal.is_zero_matrix,
            "the directions of its slides depend on each other",
            "Slides need independent directions.",
        )
        self.require(
            not (normal[:2, 0].is_zero_matrix and axis[:2, 0].is_zero_matrix),
            f"joint {turret.number} does not move the tool across its slides",
            "A turret has to turn its slides or the axis after them.",
        )
        return simple(normal / sp.sqrt(normal.dot(normal)))

    def _before(
        self,
        turret: Single,
        slides: Sequence[sp.Matrix],
        start: sp.Matrix,
        axis: sp.Matrix,
        ends: Ends,
    ) -> str:
        """Solve a turret that turns the slides; return its pair."""
        normal, tool = self._normal(turret, slides, axis), point("tool")
        beside, place = simple(normal.cross(axis)), point("p") - ends.ahead * tool
        across = [
            sp.simplify(a - ends.aside * b)
            for a, b in zip(turning(normal, place), turning(beside, tool), strict=True)
        ]
        level = normal.dot(start) + ends.level * normal.dot(axis)
        level -= normal[2] * place[2] - ends.aside * beside[2] * tool[2]
        return self._by_both(turret, (*across, sp.simplify(level)), axis, ends)

    def _after(
        self,
        turret: Single,
        slides: Sequence[sp.Matrix],
        start: sp.Matrix,
        axis: sp.Matrix,
        ends: Ends,
    ) -> str:
        """Solve a turret that the slides move; return its pair."""
        normal, tool = self._normal(turret, slides, axis), point("tool")
        beside, link = tool.cross(normal), simple(start + ends.level * axis)
        across = [
            sp.simplify(a + ends.aside * b)
            for a, b in zip(turning(link, normal), turning(axis, beside), strict=True)
        ]
        level = normal.dot(point("p") - ends.ahead * tool) - normal[2] * link[2]
        level -= ends.aside * axis[2] * beside[2]
        return self._by_both(turret, (*across, sp.simplify(level)), axis, ends)

    def _by_both(
        self, turret: Single, across: Sequence[sp.Expr], axis: sp.Matrix, ends: Ends
    ) -> str:
        """Solve a turret by two equations, of which one may say nothing of it.

        The other one is for the direction of the last axis along that of joint 4.
        """
        tool = point("tool")
        along = *turning(axis, tool), ends.inclined - axis[2] * tool[2]
        for name, sides in (("across", across), ("along", along)):
            self.add(f"{name} = Matrix([{', '.join(source(e) for e in sides)}])")
        self.add("side = ik.let('side', ik.size*sign_of(across[0]*along[0] + across[1]*along[1]))")
        self.vector("both", "across + side*along")
        a, b, c = point("both")
        return self._turn(turret, (a, b, c))


__all__ = ["TwoSlidesMaker"]
