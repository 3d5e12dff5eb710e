"""Writes the chain of four joints that turn about one direction or slide, between two that turn.

The orientation of the target gives the first joint, the sum of the turns in the middle and the
last joint.  What is left is a point for the links and slides in the middle.  Where the first and
the last axis are parallel, only the sum of both is known, and what is in reach decides.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.scaffold.chains.chainlinks import Single, Singles
from closedform.scaffold.chains.maker import (
    Z,
    ahead_of_lift,
    norm,
    point,
    simple,
    sine_cosine,
    times,
)
from closedform.scaffold.chains.one_direction import COUNTED, Block, OneDirectionMaker
from closedform.scaffold.chains.wrists import is_normal
from closedform.scaffold.source import source


class MiddleMaker(OneDirectionMaker):
    """Writes the lines for such joints, which are the second to the fifth of six."""

    first: str
    """The pair of the first joint."""

    def in_the_middle(self, arm: Singles) -> str:
        """Joints 2 to 5 turn about one direction or slide, at right angles to joints 1 and 6."""
        one, *middle, last = arm.joints
        self.require(
            not (one.slides or last.slides),
            f"joint {one.number} or {last.number} slides",
            "Such joints are between two that turn.",
        )
        block = self._block(middle)
        one = self._framed(one, block)
        self.require(
            is_normal([one, block.lift]),
            "the joints beside them do not turn about axes that are normal to theirs",
            "The known chain has right angles there.",
        )
        R = self.centre(arm)
        self._name_rotation(arm, times(arm.lead[:3, :3].T, R))
        lengths = self._lengths_to_reach(block, one.shift)
        if lengths:
            self._reach_by_first(one, block, lengths)
        self._turns_by_orientation(one, block, last)
        if len(block.turns) == 3:
            self._lifted_links(block)
        else:
            self._one_link(block)
        turns = f"{COUNTED[len(block.turns)]} joints that turn about one direction"
        slides = "two slides" if len(block.slides) > 1 else "a slide"
        return f"{turns} and {slides} between two that turn"

    def _turns_by_orientation(self, one: Single, block: Block, last: Single) -> None:
        """Solve the first joint, the sum of the turns and the last; name what the point leaves.

        The pair of the sum of the turns is ``lifted`` then.
        """
        self.orientation([one, block.lift, last], "M")
        self.first = self.lifted
        self.vector("aimed", times(one.end.T, f"(turned({self.first}).T * M[:, 2])"))
        place = times(one.end.T, f"(turned({self.first}).T * p - {source(one.shift)})")
        self.vector("q", f"{place} - {source(self._turned(block, block.lift.shift, 'aimed'))}")
        along, aside = self._total(block, "aimed")
        self.lifted = f"Pair({source(aside)}, {source(along)})"

    def _framed(self, one: Single, block: Block) -> Single:
        """The first joint; its motion ends in the frame of the block."""
        end = simple(one.end * block.lead)
        return replace(one, shift=simple(one.shift + end * block.levels[0].shift), end=end)

    def _total(self, block: Block, aimed: str) -> tuple[sp.Expr, sp.Expr]:
        """The cosine and the sine of the sum of the turns, from where they aim the last axis."""
        x, y, _ = block.end * Z
        a, b, _ = point(aimed)
        return x * a + y * b, x * b - y * a

    def _turned(self, block: Block, v: sp.Matrix, aimed: str) -> sp.Matrix:
        """A vector that the turns of the block turn."""
        c, s = self._total(block, aimed)
        return sp.Matrix([c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]]).applyfunc(sp.expand)

    def _plane(self, one: Single) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """How far the first joint is behind its unknown, and the plane that it turns.

        That is the directions along its axis and outward, in the frame of the links.
        """
        sine, cosine = sine_cosine(ahead_of_lift(one.end * Z))
        ahead = sp.Matrix([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]])
        level = simple(one.end.T * Z)
        return ahead, level, level.cross(Z)

    def _begin_reaching(self, one: Single, block: Block) -> None:
        """The first lines of a function of the tilt, the sum of the turns."""
        ahead, _, _ = self._plane(one)
        tilted = sp.Matrix([sp.Symbol("tilt.s"), 0, sp.Symbol("tilt.c")])
        self.lines += [
            "def reaching(tilt):",
            f"    seen = {source((one.end.T * ahead * tilted).applyfunc(sp.expand))}",
            f"    carried = {source(self._turned(block, block.lift.shift, 'seen'))}",
        ]

    def _reach_by_first(self, one: Single, block: Block, lengths: Sequence[str]) -> None:
        """Name what the links reach, as the first joint turns their plane."""
        ahead, level, outward = self._plane(one)
        p, carried = point("p"), point("carried")

        def turning(v: sp.Matrix) -> str:
            """The coefficients of cosine and sine in what the first joint leaves along ``v``."""
            x, y, _ = ahead.T * v
            return source((sp.expand(x * p[0] + y * p[1]), sp.expand(x * p[1] - y * p[0])))

        self._begin_reaching(one, block)
        self.add("    lever = ik.size**2/(ik.size + sqrt(p[0]**2 + p[1]**2))")
        if len(lengths) == 2:
            along = one.end * outward
            beside = -along.dot(one.shift) - outward.dot(carried)
            height = p[2] - one.shift[2] - level.dot(carried)
            at, links = source((sp.expand(beside), sp.expand(height))), ", ".join(lengths)
            self.add(
                f"    return ReachingInPlane.by_links(ik, {turning(along)}, {at}, ({links}), "
                f"lever=lever)"
            )
        else:
            ((k, *_), *_), n = block.across, simple(block.normal / norm(block.normal[:2, 0]))
            moved = n if k == 0 else self._turned(block, n, "seen")
            along = (one.end * moved).applyfunc(sp.expand)
            beside = along[2] * p[2] - along.dot(one.shift) - moved.dot(carried)
            self.add(
                f"    return ReachingAcross.by_slide(ik, {turning(along)}, "
                f"{source(sp.expand(beside))}, {lengths[0]}, lever=lever)"
            )
        self.more = ", reaching=reaching"


__all__ = ["MiddleMaker"]
