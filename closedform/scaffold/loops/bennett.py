"""Reads a Bennett linkage: a single loop in space of four revolute joints, each with its axis."""

from __future__ import annotations

import sympy as sp

from closedform.loops.bennett import fits
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.legs import Legs, LoopLeg

BODIES = 4
NEEDED = (
    "In space four axes leave a loop a motion only if they are parallel, meet in one point, or as "
    "in a Bennett linkage.  Its file has the posture in which all joints are zero and on one line, "
    "at right angles to all axes.  Opposite bodies have the same length a or b and the same angle "
    "alpha or beta between their axes, with a*sin(beta) = b*sin(alpha); so b is a formula, such as "
    '"a*sin(beta)/sin(alpha)".  If the axes should meet in one point, all joints are at this '
    'point; if the rod has ball joints, write kind = "spherical"'
)


def bennett(found: Legs, follower: Joint) -> list[LoopLeg]:
    """The hinges of a Bennett linkage, if four revolute joints with axes close the loop."""
    loop = found.loop
    path = _around(loop, follower)
    axes = [j.axis for j in path if j.axis is not None]
    if len(axes) != BODIES or not any(any(axis.cross(axes[0])) for axis in axes):
        return []
    places = [_place(loop, j) for j in path]
    known = [at for at in places if at is not None]
    if len(known) != BODIES or not fits(known, axes) or not _keeps(loop, path, known):
        _, first, second, _ = path
        raise loop.error(
            f"{first.name} and {second.name} would hold the body between them by an axis.  {NEEDED}"
        )
    found.used |= {j.name for j in path}
    loop.seen.append(
        "The loop is a Bennett linkage: opposite bodies are alike, and where all angles are zero, "
        "all joints are on one line."
    )
    return [
        LoopLeg(
            joint,
            f"Hinge({found.at(at)}, {found.at(axis)})",
            f"{joint.name} is a revolute joint",
            sp.zeros(3, 1),
        )
        for joint, at, axis in zip(path, known, axes, strict=True)
    ]


def _around(loop: Loop, follower: Joint) -> list[Joint]:
    """The joints from the driven one around the loop to the task; none of another loop."""
    drivers = [j for j in loop.of(GROUND) if j.driven]
    alone = len(loop.joints) == len(loop.bodies) == BODIES and loop.dimensions == len(AXES)
    turning = all(j.kind == "revolute" for j in loop.joints.values())
    if len(drivers) != 1 or not alone or not turning:
        return []
    path, body = drivers, drivers[0].other(GROUND)
    while body != GROUND and len(onward := [j for j in loop.of(body) if j not in path]) == 1:
        path = [*path, *onward]
        body = onward[0].other(body)
    return path if len(path) == BODIES and path[-1] is follower else []


def _place(loop: Loop, joint: Joint) -> sp.Matrix | None:
    """Where a joint is, by the ground, the driven body or the follower."""
    ground = [b for b in joint.between if b == GROUND]
    for body in ground or joint.between:
        moved = body == GROUND or any(GROUND in j.between for j in loop.of(body))
        if moved and joint.at in loop.bodies[body]:
            return loop.bodies[body][joint.at]
    return None


def _keeps(loop: Loop, path: list[Joint], places: list[sp.Matrix]) -> bool:
    """Whether the coupler is as long as its ends are apart, if the file gives its length."""
    first, second = path[1:3]
    (coupler,) = {*first.between} & {*second.between}
    apart, points = places[2] - places[1], loop.bodies[coupler]
    square = apart.dot(apart)
    if coupler in loop.rods:
        return bool(sp.simplify(loop.rods[coupler] ** 2 - square) == 0)
    if first.at in points and second.at in points:
        span = points[second.at] - points[first.at]
        return bool(sp.simplify(span.dot(span) - square) == 0)
    return True


__all__ = ["bennett"]
