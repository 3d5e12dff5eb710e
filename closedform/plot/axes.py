"""The axes of joints, from what a generated module exports."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot.robot import Array, Robot

STEP = 1e-5
MOVING = 1e-4
"""A point that is slower than this, in units of the mechanism, does not move."""
EXACT = 1e-9


def joint_axes(
    robot: ModuleType | Robot, q: ArrayLike, *, params: Any = None, mode: int = 0
) -> dict[str, tuple[Array, Array]]:
    """A point and a unit vector along the axis of each joint of the skeleton, in one posture.

    A revolute joint turns by the right-hand rule about the vector, and a slide moves along it as
    it grows.
    For a passive joint the vector may have the other sign.
    """
    r = Robot.of(robot, params)
    joints = np.asarray(q, dtype=float)
    points = r.points(joints)[mode]
    skeleton, driven = r.module.SKELETON, r.module.JOINTS
    place = dict(zip(skeleton.points, points, strict=True))
    found: dict[str, tuple[Array, Array]] = {}
    for name, joint in skeleton.joints.items():
        at = place[joint.points[-1]] if name in driven else place[joint.points[0]]
        if joint.kind == "prismatic" or len(joint.points) == 2:
            along = place[joint.points[1]] - place[joint.points[0]]
            if joint.kind == "prismatic" and name in driven and joints[driven.index(name)] < 0:
                along = -along
        elif name in driven:
            along = _turning(r, joints, mode, name)
        else:
            along = _normal(r, place, joint.points[0])
        size = float(np.linalg.norm(along))
        if size > 0:
            found[name] = (at, along / size)
    return found


def _turning(r: Robot, q: Array, mode: int, name: str) -> Array:
    """The angular velocity of the link that a joint turns, at the rate 1."""
    j = list(r.module.JOINTS).index(name)
    if r.has("jacobian_space"):
        exported = np.asarray(r.call("jacobian_space", q))[-3:, j]
        if abs(np.linalg.norm(exported) - 1) < EXACT:  # less where other joints are coupled to it
            return exported
    skeleton = r.module.SKELETON
    foot = skeleton.joints[name].points[-1]
    step = STEP * np.eye(len(q))[j]
    before, here, after = (r.points(x)[mode] for x in (q - step, q, q + step))
    velocity = (after - before) / (2 * STEP)
    beside = {p for link in skeleton.links.values() if foot in link for p in link}
    origin = here[skeleton.points.index(foot)]
    rows, rates = [], []
    for k, point in enumerate(skeleton.points):
        if point in beside and np.linalg.norm(velocity[k]) > MOVING * r.size:
            x, y, z = here[k] - origin
            rows.append([[0, z, -y], [-z, 0, x], [y, -x, 0]])
            rates.append(velocity[k])
    if rows:
        return np.asarray(np.linalg.lstsq(np.vstack(rows), np.concatenate(rates), rcond=1e-9)[0])
    return np.zeros(3)


def _normal(r: Robot, place: dict[str, Array], foot: str) -> Array:
    """The normal of two links that meet at a passive joint."""
    ways = []
    for link in r.module.SKELETON.links.values():
        for k, point in enumerate(link):
            if point == foot:
                ways += [place[n] - place[foot] for n in (*link[:k][-1:], *link[k + 1 :][:1])]
    crossed = [np.cross(a, b) for i, a in enumerate(ways) for b in ways[i + 1 :]]
    if not crossed:
        return np.array([0.0, 0.0, 1.0])
    return np.asarray(max(crossed, key=lambda n: float(np.linalg.norm(n))))
