"""Recognises a hand whose five legs end on one line of it, and leave it free to turn about this."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.scaffold.loops.bodies import AXES, around
from closedform.scaffold.loops.guides import GuideLine
from closedform.scaffold.loops.legs import Legs, LoopLeg

LEGS = 5
KIND = "a hand that is an axis"
WORDS = "The legs end on one line of the hand, and leave it free to turn about this line."
NEEDED = (
    "This is supported if all five legs end on one line of the hand, which passes its point; then "
    "the line has a place and a direction"
)


def spindle(found: Legs, legs: Sequence[LoopLeg]) -> GuideLine | None:
    """The line of the hand on which five legs end, if there is one with a direction in numbers."""
    if found.loop.dimensions != len(AXES) or len(legs) != LEGS:
        return None
    ends = [leg.place for leg in legs if any(leg.place)]
    if not ends or any(sp.simplify(e) for end in ends for e in end.cross(ends[0])):
        return None
    line = found.direction(ends[0], found.loop.length(ends[0]))
    if not all(e.is_number for e in line):
        return None
    axes = ", ".join(map(found.at, around(line)))
    return GuideLine(f"Spindle((0, 0, 0), {axes})", KIND, WORDS)


__all__ = ["NEEDED", "spindle"]
