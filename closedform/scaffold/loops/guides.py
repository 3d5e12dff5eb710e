"""Recognises what rules the motion of a hand without a motor.

It is a passive leg of a universal joint and a slide, or a universal or a ball joint on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint, Loop, around
from closedform.scaffold.loops.legs import Legs, middle_leg

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
    held: tuple[str, ...] = ()
    """The joints that hold the hand by an axis."""


def guide(found: Legs) -> GuideLine | None:
    """What holds the hand on the ground, if there is anything."""
    loop = found.loop
    if loop.dimensions != SPACE:
        return None
    if on_mast := _mast(found):
        return on_mast
    for joint in loop.joints.values():
        hand = [b for b in joint.between if loop.hand in loop.bodies[b] and b != GROUND]
        if hand and joint.kind == "prismatic" and (not joint.driven or middle_leg(loop, joint)):
            return _guide(found, joint, joint.other(hand[0]))
        if joint.driven or not hand:
            continue
        if GROUND in joint.between and joint.kind in DRIVEN:
            return _pivot(found, joint)
        for body in hand if joint.kind == "revolute" else []:
            if first := _first_of_cross(found, joint, body):
                return _cross(found, first, joint)
    return None


def _mast(found: Legs) -> GuideLine | None:
    """A universal or a ball joint at the point of the hand, on a passive slide of the ground."""
    loop = found.loop
    for turning in loop.joints.values():
        if turning.kind not in DRIVEN or turning.at != loop.hand or GROUND in turning.between:
            continue
        for post in turning.between:
            onto = [j for j in loop.of(post) if j is not turning]
            if [j.kind for j in onto] != ["prismatic"] or GROUND not in onto[0].between:
                continue
            if onto[0].driven:
                continue
            on_mast = _on_mast if turning.kind == "universal" else _ball_on_mast
            return on_mast(found, onto[0], turning, post)
    return None


def _on_mast(found: Legs, slide: Joint, turning: Joint, post: str) -> GuideLine:
    loop = found.loop
    if slide.axis is None or turning.axis is None or turning.second is None:
        raise loop.error(
            f"{turning.name} holds the hand on {post}, which {slide.name} moves; give {slide.name} "
            f"its axis, and {turning.name} two axes at right angles, where the hand is not turned: "
            f"axis, which is fixed to {post}, and second, which is fixed to the hand"
        )
    _require_cross(loop, turning)
    base = _foot_of_mast(found, slide, turning, post)
    _check_driven(found, slide, SPACE, f"{slide.name} and {turning.name}")
    axes = ", ".join(map(found.at, (turning.axis, turning.second, slide.axis)))
    return GuideLine(
        f"Mast({base}, {axes})",
        "a hand on a mast",
        "A universal joint, which slides along a mast, holds the hand.",
    )


def _ball_on_mast(found: Legs, slide: Joint, turning: Joint, post: str) -> GuideLine:
    loop = found.loop
    if slide.axis is None or not all(e.is_number for e in slide.axis):
        raise loop.error(
            f"{turning.name} holds the hand on {post}, which {slide.name} moves; give {slide.name} "
            f"its axis, in numbers"
        )
    base = _foot_of_mast(found, slide, turning, post)
    _check_driven(found, slide, SPACE + 1, f"{slide.name} and {turning.name}")
    axes = ", ".join(map(found.at, (*around(slide.axis), slide.axis)))
    return GuideLine(
        f"BallOnMast({base}, {axes})",
        "a hand on a ball joint on a mast",
        "A ball joint, which slides along a mast, holds the hand.",
    )


def _foot_of_mast(found: Legs, slide: Joint, turning: Joint, post: str) -> str:
    """Where the joint that holds the hand is if the slide is at zero."""
    loop = found.loop
    points, base = loop.bodies[post], found.point(GROUND, slide)
    if slide.at in points and turning.at in points:
        base += points[turning.at] - points[slide.at]
    points.pop(loop.hand, None)  # the hand is the body that the joint carries
    found.used |= {slide.name, turning.name}
    return found.at(base)


def _first_of_cross(found: Legs, second: Joint, hand: str) -> Joint | None:
    """The joint on the ground of the cross that ``second`` joins to the hand, if it is one."""
    loop, cross = found.loop, second.other(hand)
    if cross in loop.rods or cross == GROUND:
        return None
    others = [j for j in loop.of(cross) if j is not second]
    (first,) = others if len(others) == 1 else (None,)
    if first is None or first.kind != "revolute" or GROUND not in first.between or first.driven:
        return None
    return first


def _cross(found: Legs, first: Joint, second: Joint) -> GuideLine:
    """A body between the ground and the hand that turns about one axis and carries another."""
    loop = found.loop
    cross, both = first.other(GROUND), f"{first.name} and {second.name}"
    if first.axis is None or second.axis is None:
        raise loop.error(
            f"{both} hold the hand on the ground by {cross}; give both their axis, where the hand "
            f"is not turned"
        )
    if sp.simplify(first.axis.dot(second.axis)) != 0:
        raise loop.error(
            f"{both} hold the hand on the ground by {cross}; their axes have to be at right angles"
        )
    if second.at != loop.hand:
        raise loop.error(f"{second.name} has to be at {loop.hand}, a point of its axis")
    offset = sp.zeros(3, 1)
    if first.at != second.at:
        offset = found.point(cross, second) - found.point(cross, first)
    found.used |= {first.name, second.name}
    _check_driven(found, first, DRIVEN["universal"], both)
    base, axes = (
        found.at(found.point(GROUND, first)),
        f"{found.at(first.axis)}, {found.at(second.axis)}",
    )
    if any(sp.simplify(e) != 0 for e in offset):
        return GuideLine(
            f"Cross({base}, {axes}, {found.at(offset)})",
            "a hand on a cross",
            f"{cross} holds the hand on the ground: its two axes do not meet.",
            held=(second.name,),
        )
    words = f"{cross} holds the hand on the ground, as a universal joint."
    kind = "a hand on a universal joint"
    return GuideLine(f"Gimbal({base}, {axes})", kind, words, held=(second.name,))


def _check_driven(found: Legs, held: Joint, needed: int, by: str) -> None:
    driven = found.driven()
    if len(driven) != needed:
        count = {2: "two", 3: "three", 4: "four"}[needed]
        raise found.loop.error(
            f"{by} leave{'s' * (held.name == by)} the hand {count} degrees of freedom, so {count} "
            f"joints are driven, not {listed([j.name for j in driven])}"
        )


def _require_cross(loop: Loop, universal: Joint) -> None:
    """Refuse a universal joint whose axes are not at right angles."""
    assert universal.axis is not None
    assert universal.second is not None
    if sp.simplify(universal.axis.dot(universal.second)) != 0:
        raise loop.error(f"axis and second of {universal.name} have to be at right angles")


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
    _require_cross(loop, joint)
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
            f"ground by a universal joint, and to nothing else.  Or the slide is on the ground, "
            f"and carries a universal joint at {loop.hand}, as that of a swash plate"
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
    how = " driven" * slide.driven
    return GuideLine(
        f"Guide({slide.name}, {found.at(base)}, {found.at(turning.axis)}, {found.at(second)})",
        f"a hand on a {'middle' if slide.driven else 'passive'} leg",
        f"A {'middle' if slide.driven else 'passive'} leg of a universal joint and a{how} slide "
        f"carries the hand.",
        "" if slide.driven else slide.name,
    )


__all__ = ["GuideLine", "guide"]
