"""Recognises a hand whose arms slide through three balls on parallel sliders: 3-PSP."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import AXES, GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg

LEGS = 3


def on_balls(found: Legs) -> list[LoopLeg] | None:
    """The legs of a hand whose arms slide through balls; None if it is of another kind."""
    loop, driven = found.loop, [j for j in found.driven() if GROUND in j.between]
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != len(AXES) or len(driven) != LEGS or len(hands) != 1:
        return None
    chains = [_chain(found, joint, hands[0]) for joint in driven]
    return [_leg(found, hands[0], *chain) for chain in chains if chain] if all(chains) else None


def _chain(found: Legs, joint: Joint, hand: str) -> tuple[Joint, Joint, Joint] | None:
    """A slider, the ball on it and the passive slide of an arm, one after the other."""
    loop, at, body = found.loop, joint, joint.other(GROUND)
    path = [joint]
    for kind in ("spherical", "prismatic"):
        onward = [j for j in loop.of(body) if j is not at]
        if len(onward) != 1 or onward[0].kind != kind or onward[0].driven:
            return None
        (at,) = onward
        body = at.other(body)
        path.append(at)
    first, ball, slide = path
    return (first, ball, slide) if joint.kind == "prismatic" and body == hand else None


def _leg(found: Legs, hand: str, joint: Joint, ball: Joint, slide: Joint) -> LoopLeg:
    loop = found.loop
    for j in (joint, slide):
        if j.axis is None:
            raise loop.error(f"{j.name} slides; say in which direction with axis")
    assert joint.axis is not None
    assert slide.axis is not None
    down = [*joint.axis] == [0, 0, -1]
    if [*joint.axis] != [0, 0, 1] and not down:
        raise loop.error(
            f"{joint.name} moves a ball, through which an arm of {hand} slides, as in a 3-PSP "
            f"mechanism; this is supported for three parallel sliders: turn the drawing so that "
            f"all of them move along the z axis, axis = [0, 0, 1] or [0, 0, -1]"
        )
    if slide.axis[2] != 0 or not all(e.is_number for e in slide.axis):
        raise loop.error(
            f"{slide.name} is an arm of {hand}; its axis has to be horizontal where {hand} is not "
            f"turned, in numbers"
        )
    beside = found.point(hand, slide) - loop.bodies[hand][loop.hand]
    if any(sp.simplify(e) != 0 for e in beside.cross(slide.axis)):
        raise loop.error(
            f"{slide.name} is an arm of {hand}; the three arms have to meet in {loop.hand}, which "
            f"is the hand, and its line does not pass this point"
        )
    found.used |= {joint.name, ball.name, slide.name}
    start = found.point(joint.other(GROUND), ball)
    along = sp.Matrix(slide.axis[:2])
    return LoopLeg(
        joint,
        f"ThroughBall({joint.name}, {slide.name}, {found.at(start)}, {found.at(along)}"
        f"{', -1' * down})",
        f"{joint.name} moves a ball, through which an arm of {hand} slides",
        sp.zeros(3, 1),
        slide.name,
    )


__all__ = ["on_balls"]
