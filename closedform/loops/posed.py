"""The pose of the last body of a planar linkage: a hand that three driven joints move and turn.

Two pins of the body are known.  The direction from one to the other gives its yaw, and the position
of the hand is seen from them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.legs import turned_left
from closedform.lemmas.lines import coordinate
from closedform.loops.from_hand import turned
from closedform.loops.leg_by_leg import named
from closedform.loops.linkage import Linkage
from closedform.model.functions import Program
from closedform.model.inverse import Link


@dataclass(frozen=True)
class Pose:
    """The yaw of the hand, the links for the pose, and its equations for ``length`` besides."""

    yaw: sp.Expr
    links: tuple[Link, ...]
    equations: tuple[sp.Expr, ...]
    length: sp.Symbol


def pose_of(m: Linkage, f: Program, points: dict[str, sp.Matrix], size: sp.Expr) -> Pose:
    """The pose from the ``points``, of which that of the hand gets names of its own."""
    step, place, yaw = m.solved[-1], m.hand[:2, :], m.hand[2]
    near, pin = step.near[0], step.pin
    along, across = m.axes(m.carrier, near, pin)
    span = points[pin] - points[near]
    found = turned(
        f,
        yaw,
        (span.dot(along), span.dot(across)),
        size=size,
        free=(),
        body=m.carrier,
        name="w",
    )
    points[m.at] = named(f, "p", points[m.at])
    links = (found.link, *(coordinate(e, p) for e, p in zip(place, points[m.at], strict=True)))
    meant = m.posture[pin] - m.posture[near]
    equations = (
        found.length * sp.cos(yaw) - meant.dot(along),
        found.length * sp.sin(yaw) - meant.dot(across),
        *(place - m.posture[m.at]),
    )
    return Pose(found.angle, links, equations, found.length)


def pose_rates(
    m: Linkage, points: Mapping[str, sp.Matrix], rates: Mapping[str, sp.Matrix]
) -> sp.Matrix:
    """The rates of x, y and yaw, from those of the hand and of two pins of its body."""
    step = m.solved[-1]
    near, pin = step.near[0], step.pin
    across = turned_left(points[pin] - points[near])
    turn = across.T * (rates[pin] - rates[near]) / m.squared(m.carrier, near, pin)
    return sp.Matrix.vstack(rates[m.at], turn)


__all__ = ["Pose", "pose_of", "pose_rates"]
