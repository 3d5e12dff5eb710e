"""Recognises a hand that is the mirror image of the ground in the plane of three balls: 3-RSR."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, across_axis
from closedform.scaffold.loops.legs import Legs, LoopLeg

LEGS = 3
MIRRORS = ((1, 1, -1), (1, -1, 1), (-1, 1, 1), (-1, -1, -1))


@dataclass(frozen=True)
class MirroredLine:
    """The legs as they are written, and what the hand is a mirror image of."""

    legs: list[LoopLeg]
    pivot: str
    mirror: str
    """The argument that says how the frame of the hand is mirrored; empty if it is as usual."""


@dataclass(frozen=True)
class _Chain:
    """A crank, a ball, and the crank of the hand that the ball is joined to."""

    driven: Joint
    ball: Joint
    hinge: Joint
    rod: str


def mirrored(found: Legs) -> MirroredLine | None:
    """The legs of such a hand; None if it is of another kind."""
    loop, driven = found.loop, found.driven()
    hands = [body for body, at in loop.bodies.items() if loop.hand in at and body != GROUND]
    if loop.dimensions != len(AXES) or len(driven) != LEGS or len(hands) != 1:
        return None
    (hand,) = hands
    chains = [c for c in (_chain(found, joint, hand) for joint in driven) if c]
    if len(chains) != LEGS:
        return None
    for signs in MIRRORS:
        pivot = _pivot(found, chains, hand, sp.diag(*signs))
        if pivot is not None:
            found.used |= {j.name for c in chains for j in (c.driven, c.ball, c.hinge)}
            mirror = "" if signs == MIRRORS[0] else f"mirror={signs}"
            return MirroredLine([_leg(found, c) for c in chains], found.at(pivot), mirror)
    return None


def _chain(found: Legs, joint: Joint, hand: str) -> _Chain | None:
    """A driven crank, a ball, a rod and a hinge on the hand, one after the other."""
    loop = found.loop
    if joint.kind != "revolute" or GROUND not in joint.between or joint.axis is None:
        return None
    balls = [j for j in loop.of(joint.other(GROUND)) if j is not joint]
    if [j.kind for j in balls] != ["spherical"]:
        return None
    rod = balls[0].other(joint.other(GROUND))
    hinges = [j for j in loop.of(rod) if j is not balls[0]]
    if rod not in loop.rods or len(hinges) != 1 or hinges[0].other(rod) != hand:
        return None
    (hinge,) = hinges
    if hinge.kind != "revolute" or hinge.axis is None or hinge.at not in loop.bodies[hand]:
        return None
    return _Chain(joint, balls[0], hinge, rod)


def _arm(found: Legs, chain: _Chain) -> tuple[sp.Matrix, sp.Matrix]:
    """The crank across its axis, and the point of the axis from which it leads."""
    joint = chain.driven
    assert joint.axis is not None
    start = found.pivot(joint)
    return across_axis(joint.axis, found.point(joint.other(GROUND), chain.ball) - start, start)


def _pivot(found: Legs, chains: list[_Chain], hand: str, mirror: sp.Matrix) -> sp.Matrix | None:
    """The point of the ground whose mirror image is that of the hand, if the hand is one."""
    loop, places = found.loop, []
    for chain in chains:
        arm, start = _arm(found, chain)
        assert chain.driven.axis is not None
        assert chain.hinge.axis is not None
        turned = (mirror * chain.driven.axis).cross(chain.hinge.axis)
        off = loop.length(arm) - loop.rods[chain.rod]
        if any(map(sp.simplify, [*turned, off])):
            return None
        place = loop.bodies[hand][chain.hinge.at] - loop.bodies[hand][loop.hand]
        places.append((start - mirror * place).applyfunc(sp.simplify))
    same = all(not any(map(sp.simplify, place - places[0])) for place in places)
    return places[0] if same else None


def _leg(found: Legs, chain: _Chain) -> LoopLeg:
    joint = chain.driven
    arm, start = _arm(found, chain)
    ways = ", ".join(map(found.at, found.directions(joint, arm)))
    length = found.bar(joint.other(GROUND), found.loop.length(arm))
    return LoopLeg(
        joint,
        f"Crank({joint.name}, {length}, 0, {found.at(start)}, {ways})",
        f"{joint.name} turns a crank with a ball, from which its mirror image leads to the hand",
        sp.zeros(3, 1),
    )


__all__ = ["MirroredLine", "mirrored"]
