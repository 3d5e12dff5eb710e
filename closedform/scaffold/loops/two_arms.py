"""Recognises a hand in space that two arms and a rod hold, as the upright of a suspension.

A strut in which the hand slides may take the place of the second arm.
"""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop
from closedform.scaffold.loops.legs import Legs, LoopLeg, across_axis
from closedform.scaffold.source import source

BALLS = ("spherical", "universal")
HELD = 3
"""How many balls hold the hand."""


def two_arms(loop: Loop) -> list[LoopLeg] | None:
    """The driven arm, the other one and the rod; None if the hand is of another kind."""
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and _held(loop, body)]
    hands += [body for body, at in loop.bodies.items() if loop.hand in at and _strut(loop, body)]
    if loop.dimensions != len("xyz") or loop.hand in loop.joints:
        return None
    if not hands:
        _check_strut(loop)
    if len(hands) != 1:
        return None
    (hand,) = hands
    strut, damper = _strut(loop, hand), _damper(loop)
    balls = [j for j in loop.of(hand) if not strut or j is not strut[0]]
    driven, passive, rods = [], [], []
    for ball in balls:
        hinge = _other_end(loop, ball.other(hand), ball, damper)
        if hinge is None:
            return None
        arm = damper[0] if damper else ""
        if GROUND in hinge.between and (hinge.driven or (arm and arm in hinge.between)):
            driven.append((hinge, ball))
        elif GROUND in hinge.between and hinge.kind == "revolute":
            passive.append((hinge, ball))
        else:
            rods.append((hinge, ball))
    if not (len(driven) == len(rods) == 1 == len(passive) + bool(strut)):
        return None
    found = Legs(loop)
    place = {ball: _place(found, hand, ball) for ball in balls}
    legs = [
        _arm(found, *driven[0], place[driven[0][1]]),
        _on_strut(found, hand, *strut) if strut else _arm(found, *passive[0], place[passive[0][1]]),
        _rod(found, hand, *rods[0], place[rods[0][1]]),
    ]
    if damper:
        legs.append(_on_damper(found, driven[0][0], *damper[1:]))
    found.end = hand
    found.check_all_used()
    return legs


def _check_strut(loop: Loop) -> None:
    """Refuse a hand that a driven slide moves on its strut."""
    for body in [body for body, at in loop.bodies.items() if loop.hand in at]:
        if found := _strut(loop, body, driven=True):
            slide, top = found
            raise loop.error(
                f"{slide.name} is the slide of a strut, as of a MacPherson suspension.  Drive the "
                f"hinge of the arm instead: then fk gives the pose of {body}, and the strut is as "
                f"long as {top.at} is away from it"
            )


def _held(loop: Loop, body: str) -> bool:
    """Whether three balls hold a body, and nothing else."""
    balls = [j for j in loop.of(body) if j.kind in BALLS and j.axis is None]
    return body != GROUND and len(balls) == len(loop.of(body)) == HELD


def _strut(loop: Loop, body: str, *, driven: bool = False) -> tuple[Joint, Joint] | None:
    """The slide and the ball of a strut that leads from the ground to a body with two balls."""
    slides = [j for j in loop.of(body) if j.kind == "prismatic" and j.driven == driven]
    balls = [j for j in loop.of(body) if j.kind in BALLS and j.axis is None]
    if body == GROUND or len(slides) != 1 or len(balls) != HELD - 1 or len(loop.of(body)) != HELD:
        return None
    (slide,) = slides
    top = _other_end(loop, slide.other(body), slide)
    if top is None or GROUND not in top.between or top.kind != "spherical":
        return None
    return slide, top


def _damper(loop: Loop) -> tuple[str, Joint, Joint, Joint] | None:
    """A body on a hinge with what turns it: the driven slide of a cylinder, and both its ends."""
    slides = [j for j in loop.joints.values() if j.driven and j.kind == "prismatic"]
    for slide in [j for j in slides if GROUND not in j.between]:
        ends = [_other_end(loop, body, slide) for body in slide.between]
        if not all(j and j.kind in BALLS and j.axis is None for j in ends):
            continue
        for base, end in (ends, ends[::-1]):
            if base and end and GROUND in base.between and GROUND not in end.between:
                arm = next(b for b in end.between if b not in slide.between)
                return arm, slide, base, end
    return None


def _on_damper(found: Legs, hinge: Joint, slide: Joint, base: Joint, end: Joint) -> LoopLeg:
    """The damper that turns an arm."""
    found.used |= {slide.name, base.name, end.name}
    arm = hinge.other(GROUND)
    place = found.point(GROUND, hinge) + found.point(arm, end) - found.point(arm, hinge)
    call = f"Damper({slide.name}, {found.at(found.point(GROUND, base))}, {found.at(place)})"
    words = f"{slide.name} is the length of a cylinder that turns {arm}"
    return LoopLeg(slide, call, words, place)


def _other_end(
    loop: Loop, body: str, ball: Joint, damper: tuple[str, Joint, Joint, Joint] | None = None
) -> Joint | None:
    """The joint at the other end of a body that has two, without that of a damper."""
    others = [j for j in loop.of(body) if j is not ball and not (damper and j is damper[3])]
    return others[0] if len(others) == 1 else None


def _place(found: Legs, hand: str, ball: Joint) -> sp.Matrix:
    return found.point(hand, ball) - found.loop.bodies[hand][found.loop.hand]


def _arm(found: Legs, hinge: Joint, ball: Joint, place: sp.Matrix) -> LoopLeg:
    """An arm that a hinge joins to the ground, or a driven slider, and that ends in a ball."""
    found.used |= {hinge.name, ball.name}
    body = hinge.other(GROUND)
    call = _moved(found, hinge, found.point(body, ball), "0", place)
    if hinge.kind == "prismatic":
        words = f"{hinge.name} moves a slider, which a ball joins to the hand"
    elif hinge.driven:
        words = f"{hinge.name} turns {body}, an arm that ends in a ball on the hand"
    else:
        words = f"the body {body} is an arm that turns freely and ends in a ball on the hand"
    return LoopLeg(hinge, call, words, place)


def _on_strut(found: Legs, hand: str, slide: Joint, top: Joint) -> LoopLeg:
    """A strut that a ball holds on the ground, and in which the hand slides."""
    loop = found.loop
    found.used |= {slide.name, top.name}
    if slide.axis is None:
        raise loop.error(f"{slide.name} slides; say in which direction with axis")
    place = _place(found, hand, slide)
    strut = loop.bodies[slide.other(hand)]
    if slide.at in strut and top.at in strut:  # the ball may be beside the line of the slide
        place += strut[top.at] - strut[slide.at]
    base = found.point(GROUND, top)
    call = (
        f"SlidingStrut({slide.name}, {found.at(base)}, {found.at(place)}, {found.at(slide.axis)})"
    )
    words = (
        f"the body {hand} slides by {slide.name} along a strut, which a ball holds on the ground"
    )
    return LoopLeg(slide, call, words, place)


def _moved(found: Legs, joint: Joint, end: sp.Matrix, rod: str, place: sp.Matrix) -> str:
    """A crank or a slider with its ``end``, as it is written."""
    loop, name, on_hand = found.loop, joint.name, found.at(place)
    if joint.axis is None:
        slides = joint.kind == "prismatic"
        sliding, turning = "slides; say in which direction with", "turns in space; say about which"
        raise loop.error(f"{name} {sliding if slides else turning} axis")
    if joint.kind == "prismatic":
        return f"Slide({name}, {rod}, {found.at(end)}, {found.at(joint.axis)}, on_hand={on_hand})"
    base, body = found.point(GROUND, joint), joint.other(GROUND)
    arm = end - (found.pivot(joint) if joint.driven else found.point(body, joint))
    arm, base = across_axis(joint.axis, arm, base)
    along, across = found.directions(joint, arm)
    return (
        f"Crank({name}, {source(loop.length(arm))}, {rod}, {found.at(base)}, {found.at(along)}, "
        f"{found.at(across)}, on_hand={on_hand})"
    )


def _rod(found: Legs, hand: str, near: Joint, ball: Joint, place: sp.Matrix) -> LoopLeg:
    """The rod, which is fixed to the ground or to a driven body."""
    loop, rod = found.loop, ball.other(hand)
    found.used |= {near.name, ball.name}
    points = list(loop.bodies[rod].values())
    if rod in loop.rods:
        length = loop.rods[rod]
    elif len(points) == len((near, ball)):
        length = loop.length(points[1] - points[0])
    else:
        raise loop.error(f"{rod} must be a rod, a body with a length or two points")
    if near.kind not in BALLS or near.axis is not None:
        raise loop.error(f'{near.name} is at the end of the rod {rod}; write kind = "spherical"')
    carrier = near.other(rod)
    if carrier == GROUND:
        at = found.at(found.point(GROUND, near))
        call = f"Strut({source(length)}, {at}, on_hand={found.at(place)})"
        words = f"a rod of length {length} joins the hand to the ground"
        return LoopLeg(near, call, words, place)
    moving = _other_end(loop, carrier, near)
    if moving is None or GROUND not in moving.between or not moving.driven:
        raise loop.error(
            f"the rod {rod} leads from {hand} to {carrier}; it has to lead to the ground, or to a "
            f"body on the ground that is driven and carries nothing else"
        )
    found.used.add(moving.name)
    call = _moved(found, moving, found.point(carrier, near), source(length), place)
    words = f"{moving.name} moves {carrier}, which a rod of length {length} joins to the hand"
    return LoopLeg(moving, call, words, place)


__all__ = ["two_arms"]
