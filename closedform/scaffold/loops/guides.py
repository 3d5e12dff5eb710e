"""Recognises a passive leg that rules the motion of a hand: a universal joint and a slide."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, listed

LEGS = 3


@dataclass(frozen=True)
class GuideLine:
    """The passive leg as it is written, its slide, and what it is in words."""

    call: str
    slide: str
    words: str


def guide(found: Legs) -> GuideLine | None:
    """The passive leg between the ground and the hand, if there is one."""
    loop = found.loop
    if loop.dimensions != LEGS:
        return None
    for slide in loop.joints.values():
        hand = [body for body in slide.between if loop.hand in loop.bodies[body]]
        if slide.kind == "prismatic" and not slide.driven and hand:
            return _guide(found, slide, slide.other(hand[0]))
    return None


def _guide(found: Legs, slide: Joint, post: str) -> GuideLine:
    loop = found.loop
    held = [j for j in loop.of(post) if j is not slide]
    (turning,) = held if len(held) == 1 else (None,)
    if turning is None or turning.kind != "universal" or GROUND not in turning.between:
        raise loop.error(
            f"{slide.name} is a passive slide of the hand on {post}, which must be joined to the "
            f"ground by a universal joint, and to nothing else"
        )
    if turning.axis is None or slide.axis is None:
        raise loop.error(
            f"{turning.name} needs its axis on the ground, and {slide.name} its direction where "
            f"the hand is not turned"
        )
    if slide.at != loop.hand:
        raise loop.error(f"{slide.name} has to be at {loop.hand}, which is on the line of {post}")
    if sp.simplify(turning.axis.dot(slide.axis)) != 0:
        raise loop.error(f"the axes of {turning.name} and {slide.name} have to be at right angles")
    driven = found.driven()
    if len(driven) != LEGS:
        raise loop.error(
            f"{slide.name} and {turning.name} leave the hand three freedoms, so three joints are "
            f"driven, not {listed([j.name for j in driven])}"
        )
    second = slide.axis.cross(turning.axis)
    found.used |= {slide.name, turning.name}
    base = found.point(GROUND, turning)
    return GuideLine(
        f"Guide({slide.name}, {found.at(base)}, {found.at(turning.axis)}, {found.at(second)})",
        slide.name,
        "A passive leg of a universal joint and a slide carries the hand.",
    )


__all__ = ["GuideLine", "guide"]
