"""Reads a single loop of four axes through one point, such as a joint of Cardan, as two arcs."""

from __future__ import annotations

from dataclasses import replace

from closedform.scaffold.loops.bodies import GROUND, Loop

SPACE = 3
JOINTS = 4


def with_arcs(loop: Loop) -> Loop:
    """The loop with a rod between points at the distance 1 on the axes of the coupler.

    Only the angles between its axes count if all of them meet.  Any other loop stays as it is.
    """
    follower = loop.joints.get(loop.hand)
    drivers = [j for j in loop.joints.values() if j.driven]
    if loop.dimensions != SPACE or follower is None or len(drivers) != 1 or not _meet(loop):
        return loop
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
    loop.said.append(
        "The axes turn as their parallels through one point do, on which they are drawn; the rod "
        "joins points of these at the distance 1 from it."
        if loop.screws
        else "All axes meet in one point; the rod joins points of the axes at the distance 1 from "
        "it."
    )
    return replace(loop, bodies=bodies, joints=joints, rods={**loop.rods, coupler: arc})


def _meet(loop: Loop) -> bool:
    """Whether four axes pass one point of the ground, and bodies have no other points.

    The bodies need not have this point themselves.
    """
    joints = [*loop.joints.values()]
    if len(joints) != JOINTS or len(loop.bodies) != JOINTS or loop.rods or loop.parallelograms:
        return False
    places = {tuple(at) for points in loop.bodies.values() for at in points.values()}
    turning = all(j.kind == "revolute" and j.axis is not None for j in joints)
    placed = all(any(j.at in loop.bodies[b] for b in (*j.between, GROUND)) for j in joints)
    return turning and placed and len(places) == 1


__all__ = ["with_arcs"]
