"""Recognises a tripod in the file of a loop: three legs that hinges keep in vertical planes."""

from __future__ import annotations

from dataclasses import replace

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

LEGS = 3
HINGED = (
    "A hand that lifts and tilts on three legs in vertical planes needs three, if the joint that "
    "keeps each leg in its plane is revolute and has an axis, normal to the plane."
)


def hinge(found: Legs, joint: Joint) -> Joint | None:
    """The joint at the near end of a rod, if it keeps the rod in a plane."""
    loop = found.loop
    if GROUND in joint.between:
        body = joint.other(GROUND)
        near = [j for j in loop.of(body) if j is not joint and j.other(body) in loop.rods]
    else:
        near = [j for j in loop.of(GROUND) if set(j.between) & set(joint.between)]
    hinged = [j for j in near if j.kind == "revolute" and j.axis is not None]
    return hinged[0] if len(hinged) == len(near) == 1 else None


def uprights(found: Legs) -> list[LoopLeg]:
    """The legs of a tripod; empty if there are not three hinges."""
    driven = found.driven()
    hinges = [hinge(found, j) for j in driven]
    if found.loop.dimensions != LEGS or len(driven) != LEGS or None in hinges:
        return []
    legs = [_upright(found, j, h) for j, h in zip(driven, hinges, strict=True) if h is not None]
    if any(sp.simplify(leg.place[2] - legs[0].place[2]) != 0 for leg in legs):
        body = found.turning
        raise found.loop.error(
            f"the ends of the rods on {body} have to be at the same height in its frame, or they "
            f"twist it otherwise"
        )
    return legs


def _upright(found: Legs, joint: Joint, hinged: Joint) -> LoopLeg:
    loop, axis = found.loop, hinged.axis
    assert axis is not None
    if axis[2] != 0 or not all(e.is_number for e in axis):
        raise loop.error(
            f"{hinged.name} keeps the leg of {joint.name} in a plane, which has to be vertical: "
            "its axis is horizontal, in numbers"
        )
    if joint.kind == "revolute" and joint.axis is not None and any(joint.axis.cross(axis)):
        raise loop.error(f"the axes of {joint.name} and {hinged.name} have to be parallel")
    heading = sp.Matrix([axis[1], -axis[0], 0])
    off: list[sp.Expr] = []

    def seen(v: sp.Matrix) -> sp.Matrix:
        """In the plane of the leg: the distance from the z axis and the height."""
        off.append(sp.simplify(v.dot(axis)))
        return sp.Matrix([sp.simplify(v.dot(heading)), v[2]])

    found.upright = seen
    leg = found.leg(joint)
    if sp.simplify(leg.place.dot(heading)).xreplace(found.loop.positive).is_negative:
        heading = -heading
        leg = found.leg(joint)
    found.upright = None
    if any(off):
        raise loop.error(
            f"the plane of the leg of {joint.name}, which is normal to the axis of {hinged.name}, "
            f"has to contain the z axis; put the origin where the planes of the three legs meet"
        )
    corner = ", ".join(map(source, leg.place if leg.place[2] != 0 else leg.place[:2, 0]))
    way = f"({source(heading[0])}, {source(heading[1])})"
    call = f"Upright({leg.call}, {way}, corner=({corner}))"
    return replace(leg, call=call)


__all__ = ["HINGED", "uprights"]
