"""Writes the chain of an arm of five joints on a rail: a slide, a turret, three links and a roll.

The orientation of the target gives the turret, the sum of the turns of the links, and the roll.
How far the point is across the plane of the links gives the slide, which is free where the plane is
along the rail.  What is left is a point for two links.
"""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, Singles, plain
from closedform.scaffold.chains.in_the_middle import MiddleMaker
from closedform.scaffold.chains.maker import Z, point, simple, times
from closedform.scaffold.chains.one_direction import Block
from closedform.scaffold.chains.wrists import is_normal
from closedform.scaffold.source import source


class RailMaker(MiddleMaker):
    """Writes the lines for such arms, from the base or from the tool."""

    def on_a_rail(self, arm: Singles) -> str:
        """A slide across joint 2, which turns three joints about one direction, and joint 6."""
        rail, one, *middle, last = arm.joints
        self.require(
            rail.slides and not (one.slides or last.slides),
            f"joint {rail.number} does not slide before joints that turn",
            "An arm on a rail has a slide before a turret, three parallel joints and a roll.",
        )
        block = self._block(middle, (3,))
        sense, rail = rail.sense, plain(rail)
        one = self._framed(one, block)
        axis = simple(rail.end.T * Z)
        self.require(
            not block.slides and axis[2] == 0 and is_normal([one, block.lift]),
            "its rail, its turret, its links and its last axis are not at right angles",
            "The known chain has right angles there.",
        )
        R = self.centre(arm)
        self.vector("p", times(rail.end.T, f"(p - {source(rail.shift)})"), "p_rail")
        self._name_rotation(arm, times(simple(rail.end.T * arm.lead[:3, :3].T), R))
        lengths = [source(length) for length in block.reach]
        self._reach_on_rail(one, block, axis, lengths)
        self._turns_by_orientation(one, block, last)
        self.vector("along_rail", times(one.end.T, f"(turned({self.first}).T * {source(axis)})"))
        k, q = sp.Symbol("along_rail[2]"), point("q")
        height = sum((level.shift[2] for level in block.levels[1:-1]), sp.S.Zero)
        along = source(tuple(sense * e for e in point("along_rail")[:2]))
        at = f"(q[0], q[1]), {along}, ({', '.join(lengths)})"
        self.add(f"links = LinksAlongSlide({at})")
        value = f"{rail.joint}_"
        meaning = f"the links turn in a plane along the slide {rail.joint}"
        missed = sp.Symbol("missed")
        self.add(f"missed = ik.let('missed', {source(q[2] - height)})")
        sides = f"{source(k**2)}, {source(sense * k * missed)}"
        more = f"meaning='{meaning}', missed=missed, reaching=links"
        self.solve("quotient", f"{rail.joint}, {sides}, {more}", value)
        self.vector("q", f"q - {source(sense * sp.Symbol(value))}*along_rail", "q_arm")
        self._lifted_links(block)
        return "a rail, a turret, three parallel joints and a roll"

    def _reach_on_rail(
        self, one: Single, block: Block, axis: sp.Matrix, lengths: Sequence[str]
    ) -> None:
        """Name what the links reach, as the turret turns their plane, on any place of the rail."""
        ahead, level, outward = self._plane(one)
        across = simple(Z.cross(axis))
        p, carried = point("p"), point("carried")
        self._begin_reaching(one, block)
        along = one.end * outward
        height = p[2] - one.shift[2] - level.dot(carried)
        start = along.dot(one.shift) + outward.dot(carried)
        # beside the plane, toward the left of its direction outward
        left = sp.simplify(Z.cross(along).dot(one.end * Z))
        offsets = sum((v.shift[2] for v in block.levels[1:-1]), sp.S.Zero)
        beside = left * ((one.end * Z).dot(one.shift) + carried[2] + offsets)
        target = source((axis.dot(p), across.dot(p)))
        plane = source((tuple(axis[:2]), tuple(simple(ahead.T * along)[:2]), sp.expand(beside)))
        at, links = source((sp.expand(start), sp.expand(height))), ", ".join(lengths)
        self.add(f"    return ReachingOnRail.by_links(ik, {target}, {plane}, {at}, ({links}))")
        self.more = ", reaching=reaching"


__all__ = ["RailMaker"]
