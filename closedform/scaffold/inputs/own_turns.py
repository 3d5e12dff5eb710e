"""The part of the origin of a joint that is a turn about its own axis.

It becomes an offset of the joint: then the axes after it may be along the coordinates.
"""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from closedform.mechanics.frames import exponential, homogeneous
from closedform.scaffold.inputs.exact import orthonormal, turned_on
from closedform.scaffold.inputs.joints import MOVING, Joint


def own_turn(joint: Joint) -> sp.Expr:
    """The angle of a turn about the axis of a joint after which its origin has no other turn.

    It is 0 if there is none, and if the origin does not need it.
    """
    R = joint.origin[:3, :3]
    if not R.has(sp.sin, sp.cos) or not _has_own_axis(joint):
        return sp.S.Zero
    held = {f.args[0] for f in R.atoms(sp.sin, sp.cos)}
    for angle in (k * a for a in sorted(held, key=sp.default_sort_key) for k in (1, -1)):
        if not turned_back(joint, angle).origin[:3, :3].has(sp.sin, sp.cos):
            return angle
    return sp.S.Zero


def own_part(joint: Joint) -> sp.Expr:
    """The least multiple of pi/12 about the axis of a joint without which its origin turns axes of
    coordinates to each other; 0 if there is none."""
    if joint.origin.has(sp.sin, sp.cos) or not _has_own_axis(joint):
        return sp.S.Zero
    angles = (sign * k * sp.pi / 12 for k in range(4) for sign in (1, -1))
    return next((a for a in angles if along_axes(turned_back(joint, a).origin)), sp.S.Zero)


def _has_own_axis(joint: Joint) -> bool:
    """Whether a joint turns, has an angle of its own, and an axis that is not rounded."""
    return MOVING.get(joint.kind) == "revolute" and not joint.mimics and orthonormal(joint.axis)


def turned_back(joint: Joint, angle: sp.Expr) -> Joint:
    """The joint with the origin where it has turned back by an angle."""
    if angle == 0:
        return joint
    turn = exponential(sp.Matrix([0, 0, 0, *joint.axis]), -angle)
    return replace(joint, origin=product(joint.origin, turn))


def along_axes(place: sp.Matrix) -> bool:
    """Whether a pose turns the axes of coordinates to each other."""
    return all(e in (-1, 0, 1) for e in place[:3, :3])


def product(a: sp.Matrix, b: sp.Matrix) -> sp.Matrix:
    """The product of two poses, in which turns about parallel axes are one turn."""
    shifted = a[:3, :3] * b[:3, 3] + a[:3, 3]
    return homogeneous(turned_on(a[:3, :3], b[:3, :3]), tuple(shifted.applyfunc(sp.expand)))


__all__ = ["along_axes", "own_part", "own_turn", "product", "turned_back"]
