"""Reads rods that are written as other bodies are, and two parallel rods of a leg as one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

PINS = {"revolute", "spherical", "universal"}
TAU = [1, 2, 3]
"""How many rods three driven bodies have, of which those with two and three keep the hand."""


def read_rods(loop: Loop) -> None:
    """Give the bodies that are rods a length in the place of their two points.

    They are on a driven body, or on the rod that is on it.  The latter is no rod if it has the
    point of the hand, because then it is the hand.
    """
    ends = _driven_bodies(loop)
    ends += [  # the second motor of a leg is on the first body
        j.other(body)
        for body in ends
        for j in loop.of(body)
        if j.driven and GROUND not in j.between
    ]
    for second in (False, True):
        beside = dict.fromkeys(j.other(body) for body in ends for j in loop.of(body))
        for body in beside:
            if _is_rod(loop, body) and not (second and loop.hand in loop.bodies[body]):
                first, last = _ends_of(loop, body)
                loop.rods[body], loop.bodies[body] = loop.length(last - first), {}
        ends = [body for body in beside if body in loop.rods]


def _driven_bodies(loop: Loop) -> list[str]:
    return [j.other(GROUND) for j in loop.joints.values() if j.driven and GROUND in j.between]


def _is_rod(loop: Loop, body: str) -> bool:
    """Whether a body is pinned in two points, which differ, and is not where the hand is.

    Other points that it has are of no account, unless one of them is the hand.
    """
    joints, points = loop.of(body), loop.bodies[body]
    pins = {j.at for j in joints}
    return (
        body not in loop.rods
        and len(pins) == 2
        and pins <= {*points}
        and loop.hand not in {*points} - pins
        and all(j.kind in PINS and not j.driven and j.name != loop.hand for j in joints)
        and all(GROUND not in j.between for j in joints)
        and _differ(*_ends_of(loop, body))
    )


def _ends_of(loop: Loop, body: str) -> tuple[sp.Matrix, sp.Matrix]:
    """The two points in which a body is pinned."""
    pins = {j.at for j in loop.of(body)}
    first, last = (at for point, at in loop.bodies[body].items() if point in pins)
    return first, last


def read_pairs(loop: Loop) -> None:
    """Put a parallelogram in the place of two parallel rods of a leg, as of a Delta robot.

    They join a driven body to the same other one, are equally long, and are as far apart on both.
    The parallelogram leads from the middle between them to the middle.
    """
    on = {
        body: list(
            dict.fromkeys(j.other(body) for j in loop.of(body) if j.other(body) in loop.rods)
        )
        for body in _driven_bodies(loop)
    }
    triple = sorted(map(len, on.values())) == TAU
    for body, rods in on.items():
        if len(rods) == 3 and triple:
            _read_triple(loop, body, rods)
        if len(rods) == 2:
            _read_pair(loop, body, *rods)


def _read_triple(loop: Loop, body: str, rods: Sequence[str]) -> None:
    """Put a prism in the place of three parallel rods of a leg, as of a Gantry-Tau."""
    first, second, third = rods
    ends = [e for e in (_ends(loop, body, rod) for rod in rods) if e]
    hands = {far.other(rod) for (_, far), rod in zip(ends, rods, strict=False)}
    if len(ends) != 3 or len(hands) != 1 or sp.simplify(loop.rods[first] - loop.rods[third]) != 0:
        return
    apexes = []
    for b, joints in zip((body, *hands), zip(*ends, strict=True), strict=True):
        if any(j.at not in loop.bodies[b] for j in joints):
            return
        one, two, apex = (loop.bodies[b][j.at] for j in joints)
        apexes.append((apex - (one + two) / 2).applyfunc(sp.simplify))
    if _differ(*apexes) or not _read_pair(loop, body, first, second):
        return
    for joint in ends[2]:
        del loop.joints[joint.name]
    del loop.bodies[third], loop.rods[third]
    loop.apexes[first] = apexes[0]
    loop.said[-1] = f"The rods {first}, {second} and {third} are the long sides of a prism."


def _read_pair(loop: Loop, body: str, first: str, second: str) -> bool:
    """Whether two rods are a parallelogram, which takes their place."""
    ends = [_ends(loop, body, rod) for rod in (first, second)]
    if (
        None in ends
        or {first, second} & {*loop.parallelograms}
        or sp.simplify(loop.rods[first] - loop.rods[second]) != 0
    ):
        return False
    (near, far), (beside, beyond) = (e for e in ends if e)
    hand = far.other(first)
    pairs = {body: (near, beside), hand: (far, beyond)}
    if hand != beyond.other(second) or any(
        j.at not in loop.bodies[b] for b, pair in pairs.items() for j in pair
    ):
        return False
    places = {b: [loop.bodies[b][j.at] for j in pair] for b, pair in pairs.items()}
    aside, same = (b - a for a, b in places.values())
    if _differ(aside, same) or not _differ(*places[body]):
        return False
    for b, (joint, other) in pairs.items():
        middle = f"{joint.at}_{other.at}"
        loop.bodies[b][middle] = (sum(places[b], sp.zeros(*aside.shape)) / 2).applyfunc(sp.simplify)
        loop.joints[joint.name] = replace(joint, at=middle)
        del loop.joints[other.name]
    del loop.bodies[second], loop.rods[second]
    loop.parallelograms[first] = aside
    loop.said.append(f"The rods {first} and {second} are the long sides of a parallelogram.")
    return True


def _ends(loop: Loop, body: str, rod: str) -> tuple[Joint, Joint] | None:
    """The joints of a rod on a driven body and on the other one, if they are without an axis."""
    joints = loop.of(rod)
    near = [j for j in joints if body in j.between]
    far = [j for j in joints if j not in near]
    if len(near) != 1 or len(far) != 1 or any(j.axis is not None for j in joints):
        return None
    return near[0], far[0]


def _differ(first: sp.Matrix, second: sp.Matrix) -> bool:
    return any(sp.simplify(e) != 0 for e in first - second)


def check_short_side(loop: Loop, joint: Joint, rod: str, end: str) -> None:
    """Refuse a parallelogram whose short side a driven crank turns, and with it the hand."""
    body, side = joint.other(GROUND), loop.parallelograms.get(rod)
    if side is None or body in loop.parallelograms:
        return
    flat = loop.dimensions == 2
    if flat and sum(j.driven for j in loop.joints.values()) > 2:
        return  # the hand has to turn, which no parallelogram allows
    if flat or joint.axis is None or _differ(joint.axis.cross(side), sp.zeros(3, 1)):
        instead = (
            "or leave that of the rod out if both rods end in the same point"
            if flat
            else f"or the rod a short side along the axis of {joint.name}"
        )
        raise loop.error(
            f"{joint.name} turns {body} with the short side of the parallelogram {rod}, which "
            f"would turn {end} with the crank.  Give {body} the same parallelogram, {instead}"
        )


def several_told(loop: Loop, body: str) -> str:
    """What is said of a driven body with several rods."""
    rods = {j.other(body) for j in loop.of(body)} & {*loop.rods}
    if len(rods) < 2:
        return ""
    return (
        ".  Two rods of a leg are taken as a parallelogram if they lead to the same body, are "
        "equally long, and are as far apart on it as on the driven body, in the coordinates of the "
        "file"
        + "; three of them keep a hand from turning if another body has two and the last one has "
        "one, as on a Gantry-Tau, and a third one is redundant beside three parallelograms"
        * (len(rods) > 2)
    )


__all__ = ["check_short_side", "read_pairs", "read_rods", "several_told"]
