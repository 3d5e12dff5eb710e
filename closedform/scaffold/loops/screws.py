"""Reads an RCCC linkage: its rotations as a spherical four-bar linkage, and where its axes are."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.spherical import check_arcs
from closedform.scaffold.source import literal, source

BODIES = 4
CENTRE = "O"
FITS = (
    "a cylindrical joint, which turns and slides along one axis, is supported on the ground, with "
    "its slide driven, and in a single loop of four bodies in space: a driven revolute joint on "
    "the ground and three cylindrical ones, each with its axis, of which that on the ground is the "
    "task.  Elsewhere it is a slide and a revolute joint, with a body between them"
)


def with_screws(loop: Loop) -> Loop:
    """The spherical four-bar linkage with the directions of the axes of an RCCC linkage.

    A loop without cylindrical joints stays as it is.
    """
    cylinders = [j for j in loop.joints.values() if j.kind == "cylindrical"]
    if not cylinders:
        return loop
    driver, first, second, task = _in_order(loop)
    check_arcs(loop)
    names = [j.name for j in (first, second, task)]
    loop.seen.append(f"Joints {listed(names)} are cylindrical.")
    places = [_place(loop, j) for j in (driver, first, second, task)]
    joints = {n: replace(j, kind="revolute", at=CENTRE) for n, j in loop.joints.items()}
    bodies: dict[str, dict[str, sp.Matrix]] = {name: {} for name in loop.bodies}
    bodies[GROUND] = {CENTRE: sp.zeros(3, 1)}
    screws = f"Screws(({', '.join(map(literal, names))}), {', '.join(places)})"
    return replace(loop, bodies=bodies, joints=joints, screws=screws)


def _in_order(loop: Loop) -> list[Joint]:
    """The joints around the loop, from the driven one to the task."""
    drivers = [j for j in loop.of(GROUND) if j.driven and j.kind == "revolute"]
    if len(drivers) != 1 or loop.dimensions != len(AXES) or loop.rods:
        raise loop.error(FITS)
    path, body = drivers, drivers[0].other(GROUND)
    while body != GROUND and len(onward := [j for j in loop.of(body) if j not in path]) == 1:
        path = [*path, *onward]
        body = onward[0].other(body)
    kinds = [j.kind for j in path[1:]]
    around = body == GROUND and len(path) == len(loop.joints) == len(loop.bodies) == BODIES
    if not around or kinds != ["cylindrical"] * (BODIES - 1) or path[-1].name != loop.hand:
        raise loop.error(FITS)
    if lost := [j.name for j in path if j.axis is None]:
        raise loop.error(f"{lost[0]} needs its axis")
    return path


def _place(loop: Loop, joint: Joint) -> str:
    """A point of the axis of a joint, which the bodies have where all joints are zero."""
    found = [loop.bodies[b][joint.at] for b in joint.between if joint.at in loop.bodies[b]]
    if not found or any(map(sp.simplify, found[0] - found[-1])):
        raise loop.error(
            f"{joint.at}, where {joint.name} is, has to be the same point of both bodies where all "
            f"joints are zero"
        )
    return f"({', '.join(map(source, found[0]))})"


__all__ = ["with_screws"]
