"""Recognises a crank whose pin slides along a lever or a slider, with three moving bodies."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

BODIES = 3


def slotted(found: Legs, follower: Joint) -> list[LoopLeg] | None:
    """The driver and the follower, a crank and a body with a line; None if there are none."""
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
    crank, carrier = turning[pin.other(block)], turning[slide.other(block)]
    if crank.kind != "revolute":
        raise loop.error(
            f"{crank.name} moves the pin of {pin.name}, which slides along {slide.other(block)}; "
            f"this is supported if {crank.other(GROUND)} turns about the ground"
        )
    if slide.axis is None:
        raise loop.error(f"{slide.name} slides; say in which direction with axis")
    found.used |= {j.name for j in (crank, carrier, pin, slide)}
    line = lever if carrier.kind == "revolute" else yoke
    first = _crank(found, crank, pin)
    second = line(found, carrier, slide, (block, pin), sp.zeros(2, 1))
    return [first, second] if crank.driven else [second, first]


def _crank(found: Legs, joint: Joint, pin: Joint) -> LoopLeg:
    body, pivot = joint.other(GROUND), found.pivot(joint)
    arm = found.point(body, pin) - pivot
    length = found.loop.length(arm)
    if length == 0:
        raise found.loop.error(f"{pin.name} is on the axis of {joint.name}, so it does not move")
    along = found.direction(arm, length)
    across = sp.Matrix([-along[1], along[0]])
    return LoopLeg(
        joint,
        f"Crank({joint.name}, {source(length)}, 0, {found.at(pivot)}, {found.at(along)}, "
        f"{found.at(across)})",
        f"{joint.name} turns a crank of length {length}, whose pin slides along a line",
        sp.zeros(2, 1),
    )


def _beside(found: Legs, slide: Joint, held: tuple[str, Joint]) -> sp.Matrix:
    """Where the pin is on its block, as seen from the line along which the block slides."""
    block, pin = held
    points = found.loop.bodies[block]
    both = {pin.at, slide.at} <= set(points)
    return points[pin.at] - points[slide.at] if both else sp.zeros(2, 1)


def lever(
    found: Legs, joint: Joint, slide: Joint, held: tuple[str, Joint], place: sp.Matrix
) -> LoopLeg:
    """A body that turns, with the line of a block and its pin, which is at a place of the hand."""
    body, pivot = joint.other(GROUND), found.pivot(joint)
    assert slide.axis is not None
    across = sp.Matrix([-slide.axis[1], slide.axis[0]])
    start = pivot if slide.at == joint.at else found.point(body, slide)
    offset = sp.simplify(across.dot(start + _beside(found, slide, held) - pivot))
    more = f", {source(offset)}" if offset else ""
    return LoopLeg(
        joint,
        f"Lever({joint.name}, {slide.name}, {found.at(pivot)}, {found.at(slide.axis)}, "
        f"{found.at(across)}{more}{found.tail(place)})",
        f"{joint.name} turns a lever with the line",
        place,
        slide.name,
    )


def yoke(
    found: Legs, joint: Joint, slide: Joint, held: tuple[str, Joint], place: sp.Matrix
) -> LoopLeg:
    """The same of a slider."""
    if joint.axis is None:
        raise found.loop.error(f"{joint.name} slides; say in which direction with axis")
    assert slide.axis is not None
    start = found.point(joint.other(GROUND), slide) + _beside(found, slide, held)
    return LoopLeg(
        joint,
        f"Rail({joint.name}, {slide.name}, {found.at(start)}, {found.at(joint.axis)}, "
        f"{found.at(slide.axis)}{found.tail(place)})",
        f"{joint.name} moves a slider with the line",
        place,
        slide.name,
    )


__all__ = ["lever", "slotted", "yoke"]
