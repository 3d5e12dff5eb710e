"""Recognises a hand whose three balls slide along horizontal lines that motors move: CaPaMan."""

from __future__ import annotations

import sympy as sp

from closedform.scaffold.loops.bodies import AXES, GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

LEGS = 3


def on_lines(found: Legs) -> list[LoopLeg] | None:
    """The legs of such a hand; None if it is of another kind."""
    loop, driven = found.loop, [j for j in found.driven() if GROUND in j.between]
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != len(AXES) or not driven or len(hands) != 1:
        return None
    chains = [chain for joint in driven if (chain := _chain(found, joint, hands[0]))]
    if len(chains) != len(driven):
        return None
    if len(chains) != LEGS:
        raise loop.error(
            f"a hand whose balls slide along lines needs {LEGS} legs, and has {len(chains)}"
        )
    return [_leg(found, hands[0], *chain) for chain in chains]


def _chain(found: Legs, joint: Joint, hand: str) -> tuple[Joint, Joint, Joint] | None:
    """A driven joint, a passive horizontal slide on its body and a ball, one after the other."""
    loop, at, body, path = found.loop, joint, joint.other(GROUND), [joint]
    for kind in ("prismatic", "spherical"):
        onward = [j for j in loop.of(body) if j is not at]
        if len(onward) != 1 or onward[0].kind != kind or onward[0].driven:
            return None
        (at,) = onward
        body = at.other(body)
        path.append(at)
    first, slide, ball = path
    level = slide.axis is not None and slide.axis[2] == 0
    return (first, slide, ball) if body == hand and level else None


def _leg(found: Legs, hand: str, joint: Joint, slide: Joint, ball: Joint) -> LoopLeg:
    loop = found.loop
    assert slide.axis is not None
    if not all(e.is_number for e in slide.axis):
        raise loop.error(f"{slide.name} has a direction with parameters; use numbers")
    place = found.point(hand, ball) - loop.bodies[hand][loop.hand]
    if sp.simplify(place[2]) != 0:
        raise loop.error(
            f"{ball.at} is above or below {loop.hand}; on a hand whose balls slide along lines, "
            f"take a point {loop.hand} in the plane of the balls, and let this be the plane of x "
            f"and y of {hand}"
        )
    place = sp.Matrix(place[:2])
    leg, words = _moved(found, joint, slide)
    found.used |= {joint.name, slide.name, ball.name}
    along = sp.Matrix(slide.axis[:2])
    return LoopLeg(
        joint,
        f"BallOnLine({leg}, {slide.name}, {found.at(along)}, {found.at(place)})",
        f"{joint.name} {words} with a horizontal line, along which a ball of {hand} slides",
        place,
        slide.name,
    )


def _moved(found: Legs, joint: Joint, slide: Joint) -> tuple[str, str]:
    """What moves the line, as it is written and in words."""
    loop, body = found.loop, joint.other(GROUND)
    assert slide.axis is not None
    if joint.axis is None:
        raise loop.error(f"{joint.name} moves {body} in space; say its axis")
    if joint.kind == "prismatic":
        if not joint.axis[2].is_number or joint.axis[2] == 0:
            raise loop.error(
                f"{joint.name} has to move the line of {slide.name} up or down, in a direction of "
                f"numbers"
            )
        at = f"{found.at(found.point(body, slide))}, {found.at(joint.axis)}"
        return f"Slide({joint.name}, 0, {at})", "moves a slider"
    if body not in loop.parallelograms and any(map(sp.simplify, joint.axis.cross(slide.axis))):
        raise loop.error(
            f"{joint.name} turns {body} and the line of {slide.name} with it, as in no CaPaMan: "
            f"there a parallelogram carries the line.  Give {body} parallelogram = [...], a vector "
            f"along its short sides, or {joint.name} the axis of {slide.name}"
        )
    arm, start = found.arm_of(joint, slide)
    ways = ", ".join(map(found.at, found.directions(joint, arm)))
    length = source(loop.length(arm))
    return f"Crank({joint.name}, {length}, 0, {found.at(start)}, {ways})", "turns a crank"


__all__ = ["on_lines"]
