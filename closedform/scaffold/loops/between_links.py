"""Recognises parallelograms between two links, as in the legs of Tsai's manipulator."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.model.names import listed
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.guides import GuideLine
from closedform.scaffold.loops.legs import Legs, LoopLeg
from closedform.scaffold.source import source

KIND = "a hand on legs with parallel axes"
WORDS = "The axes of each leg are parallel, so the hand does not turn."


@dataclass(frozen=True)
class _Leg:
    """A leg: its driven joint, the joints at the ends of its parallelogram and of its links."""

    driven: Joint
    rod: str
    near: Joint
    """Where the crank carries the leg."""
    far: Joint
    """Where the leg holds the hand."""
    inner: tuple[Joint, Joint]
    """Where the parallelogram is held."""
    links: tuple[str, str]
    """The links before it and behind it; empty if there is none."""


def between_links(found: Legs) -> tuple[list[LoopLeg], GuideLine] | None:
    """The legs of a hand, and what they do, if a leg has links beside its parallelogram."""
    loop = found.loop
    driven = found.driven()
    if loop.dimensions != len(AXES) or any(GROUND not in j.between for j in driven):
        return None
    ways = [_leg(loop, joint) for joint in driven]
    if not any(way and any(way.links) for way in ways):
        return None
    whole = [(j, way) for j, way in zip(driven, ways, strict=True) if way]
    found_for = [j.name for j, _ in whole]
    if others := [j.name for j in driven if j.name not in found_for]:
        raise loop.error(
            f"a leg has a link beside its parallelogram; then each leg is a driven crank or slider "
            f"and a parallelogram, which that of {listed(others)} is not"
        )
    if len(driven) != len(AXES):
        raise loop.error(
            f"a leg has a link beside its parallelogram; such a hand has three legs, and there are "
            f"{len(driven)} driven joints"
        )
    legs = [_written(found, way) for _, way in whole]
    return legs, GuideLine("ParallelAxes()", KIND, WORDS)


def _leg(loop: Loop, driven: Joint) -> _Leg | None:
    """The leg that a joint drives, followed from its crank to the hand."""
    body, joint = driven.other(GROUND), driven
    path: list[Joint] = []
    bodies: list[str] = []
    while loop.hand not in loop.bodies[body]:
        onward = [j for j in loop.of(body) if j is not joint]
        if len(onward) != 1 or len(path) > len(AXES):
            return None
        (joint,) = onward
        body = joint.other(body)
        path.append(joint)
        bodies.append(body)
    rods = [k for k, name in enumerate(bodies[:-1]) if name in loop.parallelograms]
    if len(rods) != 1 or len(bodies) > len(AXES) + 1:
        return None
    (k,) = rods
    before, behind = bodies[:k], bodies[k + 1 : -1]
    if len(before) > 1 or len(behind) > 1:
        return None
    return _Leg(
        driven=driven,
        rod=bodies[k],
        near=path[0],
        far=path[-1],
        inner=(path[k], path[k + 1]),
        links=("".join(before), "".join(behind)),
    )


def _written(found: Legs, leg: _Leg) -> LoopLeg:
    """The leg as a line of the script."""
    loop, name = found.loop, leg.driven.name
    found.used |= {j.name for j in (leg.driven, leg.near, leg.far, *leg.inner)}
    side = loop.parallelograms[leg.rod]
    slides = leg.driven.kind == "prismatic"
    if slides and (leg.driven.axis is None or sp.simplify(leg.driven.axis.dot(side)) != 0):
        raise loop.error(
            f"the axis of {name} has to be at right angles to the short sides of {leg.rod}; only "
            f"then the far end of its leg is at a known distance from its line"
        )
    for joint in (*[leg.driven] * (not slides), leg.near, leg.far):
        if joint.axis is None or joint.kind != "revolute":
            raise loop.error(
                f"the leg of {name} has a parallelogram between links, so {joint.name} is revolute "
                f"and has an axis, that of the short sides of {leg.rod}"
            )
        if any(sp.simplify(e) for e in joint.axis.cross(side)):
            raise loop.error(
                f"the axis of {joint.name} has to be parallel to the short sides of {leg.rod}, "
                f"which keeps the hand from turning otherwise"
            )
    near, far = (_length(loop, body) for body in leg.links)
    width = loop.length(side)
    way = found.at(found.direction(side, width))
    length = loop.rods[leg.rod]
    rod = f"Extended({source(length)}, {way}, {source(width)}, ({source(near)}, {source(far)}))"
    place = found.place_of(leg.far, held=True)
    if slides:
        start = found.at(found.point(leg.driven.other(GROUND), leg.near))
        moved = "moves a slider"
        call = f"Slide({name}, {rod}, {start}, {found.at(leg.driven.axis)}{found.tail(place)})"
    else:
        moved, call = "turns a crank", found.cranked(leg.driven, leg.near, rod, place)
    return LoopLeg(
        leg.driven,
        call,
        f"{name} {moved}, which a parallelogram with rods of length {length}, between "
        f"links of length {near} and {far}, joins to the hand",
        place,
    )


def _length(loop: Loop, body: str) -> sp.Expr:
    """The length of a link, which may have two points instead."""
    if not body:
        return sp.S.Zero
    if body in loop.rods:
        return loop.rods[body]
    points = [*loop.bodies[body].values()]
    if len(points) != 2:
        raise loop.error(f"{body} is a link of a leg, so it has a length, or two points")
    return loop.length(points[1] - points[0])


__all__ = ["between_links"]
