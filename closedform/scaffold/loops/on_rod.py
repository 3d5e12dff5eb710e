"""Recognises a five-bar linkage whose hand is on a rod: a body on a driven one has its point."""

from __future__ import annotations

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source


def carried(found: Legs) -> tuple[Joint, Joint, str] | None:
    """A driven joint, the joint on what it moves, and the body there that has the hand."""
    loop = found.loop
    for joint in (j for j in found.driven() if GROUND in j.between):
        body = joint.other(GROUND)
        for near in (j for j in loop.of(body) if j is not joint and j.kind == "revolute"):
            if loop.hand in loop.bodies[near.other(body)]:
                return joint, near, near.other(body)
    return None


def on_rod(found: Legs) -> tuple[list[LoopLeg], str] | None:
    """Both legs, and where the rod of the second ends on that of the first, as it is written."""
    loop, driven, first = found.loop, found.driven(), carried(found)
    if first is None or loop.dimensions != 2 or len(driven) != 2:
        return None
    joint, near, arm = first
    held = [j for j in loop.of(arm) if j is not near]
    if len(held) != 1:
        raise loop.error(
            f"{arm} carries the hand and is joined to "
            f"{listed([j.other(arm) for j in (near, *held)])}; it must be joined to one driven "
            f"body and one rod"
        )
    span = loop.bodies[arm][loop.hand] - found.point(arm, near)
    length = found.loop.length(span)
    if length == 0:
        raise loop.error(f"the hand {loop.hand} is where {arm} is joined to {near.other(arm)}")
    loop.rods[arm] = length
    found.arm = arm
    (second,) = (j for j in driven if j is not joint)
    legs = [found.leg(joint)]
    found.end = "the first rod"
    legs.append(found.leg(second))
    on_slider = GROUND in second.between and held[0].other(arm) == second.other(GROUND)
    if legs[1].passive or on_slider:
        raise loop.error(f"{second.name} must move a rod that leads to {arm}")
    end, ahead = legs[1].place + span, found.direction(span, length)
    at = [sp.simplify(e) for e in (end.dot(ahead), ahead[0] * end[1] - ahead[1] * end[0])]
    if not any(at):
        raise loop.error(f"{held[0].name} and {near.name} are at the same point of {arm}")
    return legs, f"({source(at[0])}, {source(at[1])})"


__all__ = ["on_rod"]
