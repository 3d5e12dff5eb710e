"""Recognises what rules the motion of a hand without a motor.

It is a passive leg of a universal joint and a slide, or a universal or a ball joint on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs

SPACE = 3
DRIVEN = {"universal": 2, "spherical": 3}
"""The degrees of freedom that a joint on the ground leaves the hand; each has a driven leg."""


@dataclass(frozen=True)
class GuideLine:
    """What holds the hand as it is written, its passive slide, and what it is in words."""

    call: str
    kind: str
    """The kind of the mechanism."""
    words: str
    slide: str = ""


def guide(found: Legs) -> GuideLine | None:
    """What holds the hand on the ground, if there is anything."""
    loop = found.loop
    if loop.dimensions != SPACE:
        return None
    for joint in loop.joints.values():
        hand = [b for b in joint.between if loop.hand in loop.bodies[b] and b != GROUND]
        if joint.driven or not hand:
            continue
        if joint.kind == "prismatic":
            return _guide(found, joint, joint.other(hand[0]))
        if GROUND in joint.between and joint.kind in DRIVEN:
            return _pivot(found, joint)
    return None


def _check_driven(found: Legs, held: Joint, needed: int, by: str) -> None:
    driven = found.driven()
    if len(driven) != needed:
        count = {2: "two", 3: "three"}[needed]
        raise found.loop.error(
            f"{by} leave{'s' * (held.name == by)} the hand {count} degrees of freedom, so {count} "
            f"joints are driven, not {listed([j.name for j in driven])}"
        )


def _pivot(found: Legs, joint: Joint) -> GuideLine:
    """A joint that holds the hand on the ground: universal or a ball."""
    loop = found.loop
    if joint.at != loop.hand:
        raise loop.error(
            f"{joint.name} holds the hand on the ground; it has to be at {loop.hand}, because the "
            f"hand turns about it"
        )
    base = found.at(found.point(GROUND, joint))
    found.used.add(joint.name)
    _check_driven(found, joint, DRIVEN[joint.kind], joint.name)
    if joint.kind == "spherical":
        kind, words = "a hand on a ball joint", "A ball joint holds the hand on the ground."
        return GuideLine(f"Ball({base})", kind, words)
    if joint.axis is None or joint.second is None:
        raise loop.error(
            f"{joint.name} holds the hand on the ground; give it two axes at right angles, where "
            f"the hand is not turned: axis, which is fixed to the ground, and second, which is "
            f"fixed to the hand"
        )
    if sp.simplify(joint.axis.dot(joint.second)) != 0:
        raise loop.error(f"axis and second of {joint.name} have to be at right angles")
    axes = f"{found.at(joint.axis)}, {found.at(joint.second)}"
    words = "A universal joint holds the hand on the ground."
    return GuideLine(f"Gimbal({base}, {axes})", "a hand on a universal joint", words)


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
    _check_driven(found, slide, SPACE, f"{slide.name} and {turning.name}")
    second = slide.axis.cross(turning.axis)
    found.used |= {slide.name, turning.name}
    base = found.point(GROUND, turning)
    return GuideLine(
        f"Guide({slide.name}, {found.at(base)}, {found.at(turning.axis)}, {found.at(second)})",
        "a hand on a passive leg",
        "A passive leg of a universal joint and a slide carries the hand.",
        slide.name,
    )


__all__ = ["GuideLine", "guide"]
