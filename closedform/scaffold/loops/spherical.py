"""Reads spherical mechanisms, all of whose axes pass one point: an arc is a rod between its ends.

A single loop of four axes is such as a joint of Cardan, and three legs of three axes each hold a
hand that turns about the point.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

SPACE = 3
JOINTS = 4
LEGS = 3
"""How many legs of a spherical hand, and how many axes of each."""


def with_arcs(loop: Loop) -> Loop:
    """The loop with rods between points at the distance 1 on the axes of couplers.

    Only the angles between its axes count if all of them meet.  Any other loop stays as it is.
    """
    if legs := _legs(loop):
        return _on_ball(loop, legs)
    follower = loop.joints.get(loop.hand)
    drivers = [j for j in loop.joints.values() if j.driven]
    if loop.dimensions != SPACE or follower is None or len(drivers) != 1 or not _meet(loop):
        return loop
    check_arcs(loop)
    (driver,) = drivers
    ends = [j for j in loop.joints.values() if j not in (driver, follower)]
    moved = [j.other(GROUND) for j in (driver, follower) if GROUND in j.between]
    (coupler, *others) = {*loop.bodies} - {GROUND, *moved}
    if len(moved) != len(ends) or others or any(coupler not in j.between for j in ends):
        return loop
    bodies, joints, axes = dict(loop.bodies), dict(loop.joints), []
    for joint in ends:
        body, at = joint.other(coupler), f"{joint.name}_end"
        centre = loop.bodies[GROUND][driver.at]
        assert joint.axis is not None
        bodies[body] = {driver.at: centre, at: centre + joint.axis}
        joints[joint.name] = replace(joint, kind="spherical", at=at, axis=None)
        axes.append(joint.axis)
    bodies[coupler] = {}
    arc = loop.length(axes[1] - axes[0])
    joints |= {j.name: replace(j, at=driver.at) for j in (driver, follower)}
    loop.seen.append(
        "The axes turn as their parallels through one point do, on which they are drawn; the rod "
        "joins points of these at the distance 1 from it."
        if loop.screws
        else "All axes meet in one point; the rod joins points of the axes at the distance 1 from "
        "it."
    )
    return replace(loop, bodies=bodies, joints=joints, rods={**loop.rods, coupler: arc})


def check_arcs(loop: Loop) -> None:
    """Refuse a moving body between two axes with the same direction, which has no angle."""
    for body in loop.bodies:
        axes = [(j.name, j.axis) for j in loop.of(body) if j.axis is not None]
        if body == GROUND or len(axes) != 2:
            continue
        (first, u), (second, v) = axes
        if not any(map(sp.simplify, u.cross(v))):
            raise loop.error(
                f"{first} and {second}, the joints of {body}, have parallel axes; there must be an "
                f"angle between them"
            )


def _meet(loop: Loop) -> bool:
    """Whether four axes pass one point of the ground, where all joints are.

    The bodies need not have this point themselves.
    """
    single = len(loop.joints) == len(loop.bodies) == JOINTS
    return single and _through_one_point(loop)


def _through_one_point(loop: Loop) -> bool:
    """Whether all joints are revolute, and at the same point of the bodies; others do not count."""
    joints = [*loop.joints.values()]
    if loop.rods or loop.parallelograms:
        return False
    used = {j.at for j in joints}
    points = [at for own in loop.bodies.values() for name, at in own.items() if name in used]
    places = {tuple(at) for at in points}
    turning = all(j.kind == "revolute" and j.axis is not None for j in joints)
    placed = all(any(j.at in loop.bodies[b] for b in (*j.between, GROUND)) for j in joints)
    return turning and placed and len(places) == 1


def _legs(loop: Loop) -> list[tuple[Joint, Joint, Joint]]:
    """The joints of three legs of three axes through the point of the hand; none if there are none.

    Each leads from the ground to the hand by a driven body and another one.
    """
    drivers = [j for j in loop.of(GROUND) if j.driven]
    named = any(loop.hand in points for points in loop.bodies.values())
    if loop.dimensions != SPACE or len(drivers) != LEGS or not named:
        return []
    if not _through_one_point(loop):
        return []
    found, hands = [], set()
    for first in drivers:
        path, body = [first], first.other(GROUND)
        while len(path) < LEGS and len(onward := [j for j in loop.of(body) if j not in path]) == 1:
            path.append(onward[0])
            body = onward[0].other(body)
        hands.add(body)
        found.append((path[0], path[1], path[2]) if len(path) == LEGS else None)
    legs = [leg for leg in found if leg]
    around = len(hands) == 1 and GROUND not in hands and len(legs) == LEGS
    return legs if around and len(loop.joints) == LEGS**2 else []


def _on_ball(loop: Loop, legs: list[tuple[Joint, Joint, Joint]]) -> Loop:
    """The same with the hand on a ball joint, and rods for the arcs that lead to it."""
    check_arcs(loop)
    bodies, joints, rods = dict(loop.bodies), dict(loop.joints), dict(loop.rods)
    at = legs[0][0].at
    centre = next(points[at] for points in loop.bodies.values() if at in points)
    hand = next(b for b in legs[0][2].between if b not in legs[0][1].between)
    bodies[GROUND] = {loop.hand: centre}
    bodies[hand] = {loop.hand: sp.zeros(SPACE, 1)}
    for first, middle, last in legs:
        (arc,) = {*middle.between} & {*last.between}
        assert middle.axis is not None
        assert last.axis is not None
        near, far = f"{middle.name}_end", f"{last.name}_end"
        bodies[first.other(GROUND)] = {near: centre + middle.axis}
        bodies[hand][far] = last.axis
        bodies[arc], rods[arc] = {}, loop.length(last.axis - middle.axis)
        joints[first.name] = replace(first, at=loop.hand)
        joints[middle.name] = replace(middle, kind="spherical", at=near, axis=None)
        joints[last.name] = replace(last, kind="spherical", at=far, axis=None)
    ball = next(n for n in ("ball", *(f"ball{k}" for k in range(len(joints)))) if n not in joints)
    joints[ball] = Joint(
        name=ball, kind="spherical", between=(GROUND, hand), at=loop.hand, axis=None, driven=False
    )
    loop.seen.append(
        f"All axes meet in {loop.hand}, about which the hand turns as on a ball joint; the rods "
        f"join points of the axes at the distance 1 from it."
    )
    return replace(loop, bodies=bodies, joints=joints, rods=rods)


__all__ = ["check_arcs", "with_arcs"]
