"""Recognises legs that end in cylindrical joints on a hand that does not turn, as in a 3-PRC."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.scaffold.loops.bodies import AXES, GROUND, Joint
from closedform.scaffold.loops.guides import GuideLine
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

KIND = "a hand on cylinders"
WORDS = "Each leg turns the hand about one direction at most, so the hand does not turn."


@dataclass(frozen=True)
class _Chain:
    """A driven joint, the hinge of its rod, and the cylindrical joint at the other end."""

    driven: Joint
    hinge: Joint
    rod: str
    turn: Joint
    slide: Joint

    @property
    def axis(self) -> sp.Matrix:
        assert self.hinge.axis is not None
        return self.hinge.axis


def on_cylinders(found: Legs) -> tuple[list[LoopLeg], GuideLine] | None:
    """The legs of such a hand, and what holds it; None if it is of another kind."""
    loop, driven = found.loop, found.driven()
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != len(AXES) or len(driven) != len(AXES) or len(hands) != 1:
        return None
    chains = [c for c in (_chain(found, joint, hands[0]) for joint in driven) if c]
    if len(chains) != len(AXES):
        return None
    return [_leg(found, hands[0], c) for c in chains], GuideLine("OnCylinders()", KIND, WORDS)


def _chain(found: Legs, joint: Joint, hand: str) -> _Chain | None:
    """The joints of a leg one after the other: P or R, R, and a cylindrical joint on the hand."""
    loop, at = found.loop, joint
    if GROUND not in joint.between or joint.kind not in ("prismatic", "revolute"):
        return None
    path: list[Joint] = []
    body = joint.other(GROUND)
    while body not in (hand, GROUND) and len(path) < len(AXES):
        onward = [j for j in loop.of(body) if j is not at]
        if len(onward) != 1 or onward[0].driven:
            return None
        (at,) = onward
        body = at.other(body)
        path.append(at)
    if body != hand or len(path) != len(AXES) or any(j.axis is None for j in (joint, *path)):
        return None
    hinge, first, second = path
    kinds = {j.kind: j for j in (first, second)}
    rod = hinge.other(joint.other(GROUND))
    if hinge.kind != "revolute" or {*kinds} != {"revolute", "prismatic"} or rod not in loop.rods:
        return None
    chain = _Chain(joint, hinge, rod, kinds["revolute"], kinds["prismatic"])
    ways = [j.axis for j in (first, second)]
    if any(any(map(sp.simplify, chain.axis.cross(way))) for way in ways):
        return None
    return chain


def _leg(found: Legs, hand: str, chain: _Chain) -> LoopLeg:
    loop, joint, axis = found.loop, chain.driven, chain.axis
    assert joint.axis is not None
    mover = joint.other(GROUND)
    turns = joint.kind == "revolute"
    off = joint.axis.cross(axis) if turns else [joint.axis.dot(axis)]
    if any(map(sp.simplify, off)):
        how = "parallel to" if turns else "at right angles to"
        raise loop.error(
            f"{joint.name} moves a rod, which a cylindrical joint joins to {hand}, as in a 3-PRC "
            f"mechanism; its axis has to be {how} that of {chain.hinge.name}"
        )
    last = next(j for j in (chain.turn, chain.slide) if hand in j.between)
    place = found.point(hand, last) - loop.bodies[hand][loop.hand]
    length = source(loop.rods[chain.rod])
    if turns:
        arm, start = found.arm_of(joint, chain.hinge)
        ways = ", ".join(map(found.at, found.directions(joint, arm)))
        crank = f"{source(loop.length(arm))}, {length}, {found.at(start)}, {ways}"
        moved = f"Crank({joint.name}, {crank})"
    else:
        start = found.point(mover, chain.hinge)
        moved = f"Slide({joint.name}, {length}, {found.at(start)}, {found.at(joint.axis)})"
    found.used |= {j.name for j in (joint, chain.hinge, chain.turn, chain.slide)}
    kind = "crank" if turns else "slider"
    return LoopLeg(
        joint,
        f"FreeAlong({moved}, {found.at(axis)}{found.tail(place)}, slide={chain.slide.name})",
        f"{joint.name} moves a {kind} with a rod, which a cylindrical joint joins to the hand",
        place,
        chain.slide.name,
    )


__all__ = ["on_cylinders"]
