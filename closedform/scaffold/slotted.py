"""Recognises a crank whose pin slides along a lever, in a loop of three moving bodies."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops import GROUND, Joint, Legs, LoopLeg
from closedform.scaffold.source import source

BODIES = 3


def slotted(found: Legs, follower: Joint) -> list[LoopLeg] | None:
    """The driver and the follower, one of which is the lever; None if there is no lever."""
    loop, driven = found.loop, found.driven()
    if loop.dimensions != 2 or len(loop.bodies) - 1 != BODIES or len(driven) != 1:
        return None
    turning = {j.other(GROUND): j for j in (*driven, follower) if GROUND in j.between}
    block = next((body for body in loop.bodies if body not in (GROUND, *turning)), "")
    pins = [j for j in loop.of(block) if j.kind == "revolute" and j.other(block) in turning]
    slides = [j for j in loop.of(block) if j.kind == "prismatic" and j.other(block) in turning]
    if not len(turning) == len(loop.of(block)) == 2 or len(pins) != 1 or len(slides) != 1:
        return None
    (pin,), (slide,) = pins, slides
    bodies = pin.other(block), slide.other(block)
    crank, lever = (turning[body] for body in bodies)
    if {crank.kind, lever.kind} != {"revolute"}:
        raise loop.error(
            f"{slide.name} slides along {bodies[1]}; this is known if both {bodies[0]} and "
            f"{bodies[1]} turn about the ground"
        )
    if slide.axis is None:
        raise loop.error(f"{slide.name} slides; say in which direction with axis")
    found.used |= {j.name for j in (crank, lever, pin, slide)}
    legs = {crank: _crank(found, crank, pin), lever: _lever(found, lever, slide, (block, pin))}
    return [legs[driven[0]], legs[follower]]


def _pivot(found: Legs, joint: Joint) -> sp.Matrix:
    """Where a body turns about the ground, which is the same point of both at the angle 0."""
    body = joint.other(GROUND)
    at = found.point(GROUND, joint)
    if any(sp.simplify(e) for e in found.loop.bodies[body].get(joint.at, at) - at):
        raise found.loop.error(
            f"{joint.at} has different coordinates on the ground and on {body}; the points of "
            f"{body} are where they are when {joint.name} is zero"
        )
    return at


def _crank(found: Legs, joint: Joint, pin: Joint) -> LoopLeg:
    body, pivot = joint.other(GROUND), _pivot(found, joint)
    arm = found.point(body, pin) - pivot
    length = found.length(arm)
    if length == 0:
        raise found.loop.error(f"{pin.name} is on the axis of {joint.name}, so it does not move")
    along = found.direction(arm, length)
    across = sp.Matrix([-along[1], along[0]])
    return LoopLeg(
        joint,
        f"Crank({joint.name}, {source(length)}, 0, {found.at(pivot)}, {found.at(along)}, "
        f"{found.at(across)})",
        f"{joint.name} turns a crank of length {length}, whose pin slides along the lever",
        sp.zeros(2, 1),
    )


def _lever(found: Legs, joint: Joint, slide: Joint, held: tuple[str, Joint]) -> LoopLeg:
    (block, pin), body, pivot = held, joint.other(GROUND), _pivot(found, joint)
    assert slide.axis is not None
    across = sp.Matrix([-slide.axis[1], slide.axis[0]])
    points = found.loop.bodies[block]
    off = points[pin.at] - points[slide.at] if {pin.at, slide.at} <= set(points) else sp.zeros(2, 1)
    line = pivot if slide.at == joint.at else found.point(body, slide)
    offset = sp.simplify(across.dot(line + off - pivot))
    more = f", {source(offset)}" if offset else ""
    return LoopLeg(
        joint,
        f"Lever({joint.name}, {slide.name}, {found.at(pivot)}, {found.at(slide.axis)}, "
        f"{found.at(across)}{more})",
        f"{joint.name} turns the lever",
        sp.zeros(2, 1),
        slide.name,
    )


__all__ = ["slotted"]
