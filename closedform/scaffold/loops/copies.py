"""Copies of the numbered bodies and joints of a file, turned about the z axis.

Many mechanisms have legs that differ by a turn about the z axis alone.  Their file describes one of
them, or a pair, and says how many there are::

    copies = 3

Bodies, joints and points whose names end in a number are copied.  If the largest number is n, those
of the first copy are n more, and those of the second 2n more.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace

import sympy as sp

from closedform.mechanics.frames import rotation
from closedform.scaffold.loops.bodies import Loop

NUMBERED = re.compile(r"(.*?)([1-9][0-9]*)")
TIMES = (2, 3, 4, 6)
"""How often legs may be there: sines and cosines of these parts of a turn are square roots."""


@dataclass(frozen=True)
class _Copy:
    """One of the copies: how much larger its numbers are, and how its vectors are turned."""

    more: int
    turn: sp.Matrix

    def name(self, name: str) -> str:
        m = NUMBERED.fullmatch(name)
        return f"{m[1]}{int(m[2]) + self.more}" if m else name

    def vector(self, v: sp.Matrix) -> sp.Matrix:
        n = len(v)
        return (self.turn[:n, :n] * v).applyfunc(sp.expand)


def copy_numbered(loop: Loop, times: object) -> None:
    """Add copies, so that each numbered body and joint is there ``times`` times."""
    if not isinstance(times, int) or times not in TIMES:
        raise loop.error(f"copies must be one of {', '.join(map(str, TIMES))}")
    bodies, joints = dict(loop.bodies), dict(loop.joints)
    names = [*bodies, *joints, *(point for points in bodies.values() for point in points)]
    most = max((int(m[2]) for name in names if (m := NUMBERED.fullmatch(name))), default=0)
    if not most:
        raise loop.error("copies needs bodies and joints with names that end in a number")
    for k in range(1, times):
        copy = _Copy(k * most, rotation("z", sp.Rational(2 * k, times) * sp.pi))
        for body in bodies:
            _add_body(loop, body, bodies[body], copy)
        for joint in joints:
            _add_joint(loop, joint, copy)


def _add_body(loop: Loop, body: str, points: Mapping[str, sp.Matrix], copy: _Copy) -> None:
    """Add a body that has a number; to any other, the points that have one."""
    other, turned = copy.name(body), {copy.name(p): copy.vector(at) for p, at in points.items()}
    if other == body:
        loop.bodies[body] = {**turned, **loop.bodies[body]}
        return
    loop.bodies[other] = turned
    if body in loop.rods:
        loop.rods[other] = loop.rods[body]
    if body in loop.parallelograms:
        loop.parallelograms[other] = copy.vector(loop.parallelograms[body])


def _add_joint(loop: Loop, name: str, copy: _Copy) -> None:
    joint, (one, two) = loop.joints[name], loop.joints[name].between
    if (other := copy.name(name)) != name:
        loop.joints[other] = replace(
            joint,
            name=other,
            between=(copy.name(one), copy.name(two)),
            at=copy.name(joint.at),
            axis=None if joint.axis is None else copy.vector(joint.axis),
            second=None if joint.second is None else copy.vector(joint.second),
        )


__all__ = ["copy_numbered"]
