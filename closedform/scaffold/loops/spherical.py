"""Reads spherical mechanisms, all of whose axes pass one point: an arc is a rod between its ends.

A single loop of four axes is such as a joint of Cardan.  One of five axes, two of them driven, is a
five-bar linkage, whose hand is a point of the axis between both rods.  Three legs of three axes
each hold a hand that turns about the point.
"""

from __future__ import annotations

from collections.abc import Container
from dataclasses import replace
from itertools import chain, count

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

SPACE = 3
JOINTS = 4
FIVE = 5
LEGS = 3
"""How many legs of a spherical hand, and how many axes of each."""


def with_arcs(loop: Loop) -> Loop:
    """The loop with rods between points at the distance 1 on the axes of couplers.

    Only the angles between its axes count if all of them meet.  Any other loop stays as it is.
    """
    if legs := _legs(loop):
        return _on_ball(loop, legs)
    if arms := _arms(loop):
        return _on_strut(loop, *arms)
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
    centre = _centre(loop)
    assert centre is not None
    middle = _named_centre(loop, centre)
    bodies, joints, axes = dict(loop.bodies), dict(loop.joints), []
    bodies[GROUND] = {**bodies[GROUND], middle: centre}
    for joint in ends:
        body, at = joint.other(coupler), f"{joint.name}_end"
        assert joint.axis is not None
        bodies[body] = {middle: centre, at: centre + joint.axis}
        joints[joint.name] = replace(joint, kind="spherical", at=at, axis=None)
        axes.append(joint.axis)
    bodies[coupler] = {}
    arc = loop.length(axes[1] - axes[0])
    joints |= {j.name: replace(j, at=middle) for j in (driver, follower)}
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
    """Whether four axes pass one point of the ground.  The bodies need not have it themselves."""
    single = len(loop.joints) == len(loop.bodies) == JOINTS
    return single and through_one_point(loop)


def through_one_point(loop: Loop) -> bool:
    """Whether all joints are revolute, and all axes pass one point of the ground."""
    return _centre(loop) is not None


def _centre(loop: Loop) -> sp.Matrix | None:
    """The point that all axes pass; None if there is none, or a joint of another kind.

    A joint is at any point of its axis, where all joints are zero.  Other points do not count.
    """
    lines: list[tuple[sp.Matrix, sp.Matrix]] = []
    for j in loop.joints.values():
        places = [loop.bodies[b][j.at] for b in (*j.between, GROUND) if j.at in loop.bodies[b]]
        if j.kind != "revolute" or j.axis is None or not places:
            return None
        lines += [(place, j.axis) for place in places]
    if loop.rods or loop.parallelograms or loop.dimensions != SPACE or not lines:
        return None
    (start, along), *others = lines
    crossed = [(place, axis, along.cross(axis)) for place, axis in others]
    meeting = next((line for line in crossed if any(map(sp.simplify, line[2]))), None)
    if meeting is None:
        return None
    place, axis, normal = meeting
    far = sp.simplify((place - start).cross(axis).dot(normal) / normal.dot(normal))
    centre = (start + far * along).applyfunc(sp.simplify)
    off = (entry for place, axis in lines for entry in (place - centre).cross(axis))
    return None if any(map(sp.simplify, off)) else centre


def centre_name(loop: Loop) -> str:
    """The name of the point that all axes pass; empty if there is none."""
    centre = _centre(loop)
    return "" if centre is None else _named_centre(loop, centre)


def _named_centre(loop: Loop, centre: sp.Matrix) -> str:
    """The point of the ground that all axes pass, or a name for it."""
    ground = loop.bodies[GROUND]
    named = (j.at for j in loop.of(GROUND) if j.at in ground)
    here = (at for at in named if not any(map(sp.simplify, ground[at] - centre)))
    return next(here, None) or _unused("O", {*ground, loop.hand})


def _legs(loop: Loop) -> list[tuple[Joint, Joint, Joint]]:
    """The joints of three legs of three axes through the point of the hand; none if there are none.

    Each leads from the ground to the hand by a driven body and another one.
    """
    drivers = [j for j in loop.of(GROUND) if j.driven]
    named = any(loop.hand in points for points in loop.bodies.values())
    if loop.dimensions != SPACE or len(drivers) != LEGS or not named:
        return []
    if not through_one_point(loop):
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


def _arms(loop: Loop) -> tuple[list[tuple[Joint, Joint]], Joint] | None:
    """The motors and the elbows of a five-bar linkage, and the joint between both rods."""
    drivers = [j for j in loop.of(GROUND) if j.driven]
    single = len(loop.joints) == len(loop.bodies) == FIVE
    if loop.dimensions != SPACE or len(drivers) != 2 or not single or loop.hand in loop.joints:
        return None
    arms, rods = [], []
    for first in drivers:
        onward = [j for j in loop.of(first.other(GROUND)) if j is not first]
        if len(onward) != 1 or onward[0].driven:
            return None
        arms.append((first, onward[0]))
        rods.append(onward[0].other(first.other(GROUND)))
    last = [j for j in loop.joints.values() if {*j.between} == {*rods}]
    held = any(loop.hand in loop.bodies[rod] for rod in rods)
    if len(last) != 1 or not held or not through_one_point(loop):
        return None
    return arms, last[0]


def _on_strut(loop: Loop, arms: list[tuple[Joint, Joint]], last: Joint) -> Loop:
    """The same with the hand on a sphere, and rods for the arcs that lead to it."""
    check_arcs(loop)
    assert last.axis is not None
    centre = _centre(loop)
    assert centre is not None
    at = _named_centre(loop, centre)
    held = [loop.bodies[body][loop.hand] for body in last.between if loop.hand in loop.bodies[body]]
    both = listed([*last.between])
    if any(any(map(sp.simplify, place - held[0])) for place in held):
        raise loop.error(
            f"the hand {loop.hand} has different coordinates on {both}; they are where it is when "
            f"all joints are zero"
        )
    out = held[0] - centre
    if not any(map(sp.simplify, out)) or any(map(sp.simplify, out.cross(last.axis))):
        raise loop.error(
            f"all axes meet in {at}, so this is a spherical five-bar linkage; its hand is a point "
            f"of a rod, on the axis of {last.name} between {both} and not {at} itself, where all "
            f"joints are zero"
        )
    radius = loop.length(out)
    mast = _unused("mast", loop.bodies)
    bodies, rods = {GROUND: {at: centre}, mast: {}}, {mast: radius}
    foot = _unused("foot", loop.joints)
    joints = {foot: _ball(foot, (GROUND, mast), at)}
    for first, elbow in arms:
        crank, end, tip = first.other(GROUND), f"{elbow.name}_end", f"{elbow.name}_tip"
        rod = elbow.other(crank)
        assert elbow.axis is not None
        arm = radius * elbow.axis
        bodies |= {crank: {end: centre + arm}, rod: {}}
        rods[rod] = loop.length(out - arm)
        joints[first.name] = replace(first, at=at)
        joints[elbow.name] = replace(elbow, at=end, kind="spherical", axis=None)
        joints[tip] = _ball(tip, (mast, rod), loop.hand)
    loop.seen.append(
        f"All axes meet in {at}, from which {loop.hand} has the same distance in all postures; the "
        f"rods join points of the axes at this distance."
    )
    return replace(loop, bodies=bodies, joints=joints, rods=rods)


def _ball(name: str, between: tuple[str, str], at: str) -> Joint:
    return Joint(name=name, kind="spherical", between=between, at=at, axis=None, driven=False)


def _unused(name: str, taken: Container[str]) -> str:
    """A name that a body or a joint may get."""
    return next(n for n in chain([name], map(f"{name}{{}}".format, count())) if n not in taken)


def _on_ball(loop: Loop, legs: list[tuple[Joint, Joint, Joint]]) -> Loop:
    """The same with the hand on a ball joint, and rods for the arcs that lead to it."""
    check_arcs(loop)
    bodies, joints, rods = dict(loop.bodies), dict(loop.joints), dict(loop.rods)
    centre = _centre(loop)
    assert centre is not None
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
    ball = _unused("ball", joints)
    joints[ball] = _ball(ball, (GROUND, hand), loop.hand)
    loop.seen.append(
        f"All axes meet in {loop.hand}, about which the hand turns as on a ball joint; the rods "
        f"join points of the axes at the distance 1 from it."
    )
    return replace(loop, bodies=bodies, joints=joints, rods=rods)


__all__ = ["centre_name", "check_arcs", "through_one_point", "with_arcs"]
