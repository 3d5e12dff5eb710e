"""Recognises a hand in a plane that slides on three driven pins: 3-PRP and 3-RRP."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

LEGS = 3


def on_pins(found: Legs) -> list[LoopLeg] | None:
    """The legs of a hand on driven pins; None if it is of another kind."""
    loop, driven = found.loop, [j for j in found.driven() if GROUND in j.between]
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != 2 or len(driven) != LEGS or len(hands) != 1:
        return None
    legs = [_leg(found, joint, hands[0]) for joint in driven]
    return [leg for leg in legs if leg] if all(legs) else None


def _leg(found: Legs, joint: Joint, hand: str) -> LoopLeg | None:
    loop, body = found.loop, joint.other(GROUND)
    pins = [j for j in loop.of(body) if j is not joint]
    if len(pins) != 1 or pins[0].kind != "revolute":
        return None
    (pin,) = pins
    block = pin.other(body)
    slides = [j for j in loop.of(block) if j is not pin]
    if len(slides) != 1 or slides[0].kind != "prismatic" or slides[0].other(block) != hand:
        return None
    (slide,) = slides
    if slide.driven:
        return None
    if slide.axis is None:
        raise loop.error(f"{slide.name} slides; say in which direction with axis")
    found.used |= {joint.name, pin.name, slide.name}
    points = loop.bodies[block]
    both = {pin.at, slide.at} <= set(points)
    beside = points[pin.at] - points[slide.at] if both else sp.zeros(2, 1)
    line = found.point(hand, slide) - loop.bodies[hand][loop.hand] + beside
    carrier, words = _carrier(found, joint, pin)
    return LoopLeg(
        joint,
        f"Sleeve({carrier}, {slide.name}, {found.at(line)}, {found.at(slide.axis)})",
        f"{joint.name} {words} with a pin on which {hand} slides",
        line,
        slide.name,
    )


def _carrier(found: Legs, joint: Joint, pin: Joint) -> tuple[str, str]:
    """What moves the pin, as it is written and in words."""
    body = joint.other(GROUND)
    end = found.point(body, pin)
    if joint.kind == "prismatic":
        if joint.axis is None:
            raise found.loop.error(f"{joint.name} slides; say in which direction with axis")
        return (
            f"Slide({joint.name}, 0, {found.at(end)}, {found.at(joint.axis)})",
            "moves a slider",
        )
    pivot = found.pivot(joint)
    length = found.loop.length(end - pivot)
    if length == 0:
        raise found.loop.error(f"{pin.name} is on the axis of {joint.name}, so it does not move")
    along = found.direction(end - pivot, length)
    across = sp.Matrix([-along[1], along[0]])
    return (
        f"Crank({joint.name}, {source(length)}, 0, {found.at(pivot)}, {found.at(along)}, "
        f"{found.at(across)})",
        f"turns a crank of length {length}",
    )


__all__ = ["on_pins"]
