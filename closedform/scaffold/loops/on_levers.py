"""Recognises a hand in a plane on three lines, some of which motors turn: 3-RPR, driven pivots."""

from __future__ import annotations

from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.loops.slotted import lever, yoke

LEGS = 3


def on_levers(found: Legs) -> list[LoopLeg] | None:
    """The legs of a hand on lines that motors turn or move; None if it is of another kind."""
    loop, driven = found.loop, [j for j in found.driven() if GROUND in j.between]
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != 2 or len(driven) != LEGS or len(hands) != 1:
        return None
    if all(joint.kind == "prismatic" for joint in driven):
        return None
    (hand,) = hands
    carried = [_carried(found, joint, hand) for joint in driven]
    legs = zip(driven, carried, strict=True)
    return [_leg(found, joint, *pair) for joint, pair in legs if pair] if all(carried) else None


def _carried(found: Legs, joint: Joint, hand: str) -> tuple[Joint, Joint] | None:
    """The slide on a driven body, and the pin that joins what slides to the hand."""
    loop, body = found.loop, joint.other(GROUND)
    slides = [j for j in loop.of(body) if j is not joint]
    if len(slides) != 1 or slides[0].kind != "prismatic" or slides[0].driven:
        return None
    (slide,) = slides
    block = slide.other(body)
    pins = [j for j in loop.of(block) if j is not slide]
    if len(pins) != 1 or pins[0].kind != "revolute" or pins[0].driven:
        return None
    return (slide, pins[0]) if pins[0].other(block) == hand else None


def _leg(found: Legs, joint: Joint, slide: Joint, pin: Joint) -> LoopLeg:
    loop, block = found.loop, slide.other(joint.other(GROUND))
    if slide.axis is None:
        raise loop.error(f"{slide.name} slides; say in which direction with axis")
    found.used |= {joint.name, slide.name, pin.name}
    hand = pin.other(block)
    place = found.point(hand, pin) - loop.bodies[hand][loop.hand]
    line = lever if joint.kind == "revolute" else yoke
    return line(found, joint, slide, (block, pin), place)


__all__ = ["on_levers"]
