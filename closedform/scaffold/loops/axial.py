"""Recognises legs with two motors.

One motor moves a leg along an axis, and the other one moves its end across it.  Or a turret turns
the plane of a leg, in which the other motor moves its end.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import sympy as sp

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop, across_axis
from closedform.scaffold.source import source

SPACE = 3


@dataclass(frozen=True)
class TwoMotors:
    """A leg with two motors: one moves its end along an axis, the other one across it.

    The second motor stretches the leg, or it moves a ``rod`` by a crank or by a slider.  If the
    first one is a turret, it turns a plane through the axis, in which the second one moves the end.
    """

    along: Joint
    across: Joint
    hinge: Joint
    ball: Joint
    rod: str = ""

    @property
    def joints(self) -> tuple[Joint, ...]:
        return self.along, self.across, self.hinge, self.ball

    @property
    def motors(self) -> tuple[Joint, Joint]:
        return self.along, self.across

    @property
    def turret(self) -> bool:
        return self.along.kind == "revolute"


class Finder(Protocol):
    """What writes the legs of a loop."""

    loop: Loop

    def at(self, v: sp.Matrix) -> str:
        """A point or a direction as it is written."""

    def point(self, body: str, joint: Joint) -> sp.Matrix:
        """Where a joint is on a body."""

    def pivot(self, joint: Joint) -> sp.Matrix:
        """Where a body turns about the ground."""

    def directions(self, joint: Joint, arm: sp.Matrix) -> tuple[sp.Matrix, sp.Matrix]:
        """Where a crank points at the angle 0, and the direction in which it turns there."""


def leg_on_axis(loop: Loop, driven: Joint) -> TwoMotors | None:
    """The leg with two motors of which a joint is one, if it is of this kind."""
    if loop.dimensions != SPACE:
        return None
    found = (_from_ground(loop, j) for j in loop.of(GROUND) if j.driven)
    return next((leg for leg in found if leg and driven in leg.motors), None)


def _from_ground(loop: Loop, first: Joint) -> TwoMotors | None:
    """The leg that a driven joint of the ground carries."""
    path = [first, *_onward(loop, first)]
    if len(path) != 4 or path[3].kind != "spherical":
        return None
    turret = first.kind == "revolute"
    if path[1].kind == "revolute" and not path[1].driven and path[2].driven:
        _, hinge, second, ball = path
        fits = _normal(first, hinge) if turret else _parallel(first, hinge)
        fits = fits and second.kind == "prismatic"
        return TwoMotors(first, second, hinge, ball) if fits else None
    _, second, hinge, ball = path
    if not second.driven or hinge.kind != "revolute" or second.axis is None:
        return None
    rods = [body for body in ball.between if body in hinge.between and body in loop.rods]
    for along, across in ((first, second), (second, first)):
        turns = across.kind == "revolute"
        fits = _parallel(across, hinge) if turns else _normal(across, hinge)
        fits = fits and (_normal(first, hinge) if turret else _parallel(along, hinge))
        if rods and (turret or along.kind == "prismatic") and fits:
            return TwoMotors(along, across, hinge, ball, rods[0])
    return None


def _onward(loop: Loop, joint: Joint) -> Iterator[Joint]:
    """The joints after one on the ground, up to the hand, as long as no body has a branch."""
    body = joint.other(GROUND)
    while body != GROUND and loop.hand not in loop.bodies[body]:
        onward = [j for j in loop.of(body) if j is not joint]
        if len(onward) != 1:
            return
        (joint,) = onward
        body = joint.other(body)
        yield joint


def _parallel(one: Joint, other: Joint) -> bool:
    """Whether two joints have the same direction."""
    if one.axis is None or other.axis is None:
        return False
    return not any(map(sp.simplify, one.axis.cross(other.axis)))


def _normal(one: Joint, other: Joint) -> bool:
    """Whether the directions of two joints are at right angles."""
    if one.axis is None or other.axis is None:
        return False
    return bool(sp.simplify(one.axis.dot(other.axis)) == 0)


def in_pairs(loop: Loop, driven: Sequence[Joint]) -> list[Joint]:
    """Driven joints in their order, but both motors of a leg one after the other."""
    found: list[Joint] = []
    for joint in driven:
        leg = leg_on_axis(loop, joint)
        found += [j for j in (leg.motors if leg else (joint,)) if j not in found]
    return found


def call_of(found: Finder, leg: TwoMotors, joint: Joint) -> str:
    """One of both motors as it is written, without the place of its end on the hand."""
    assert leg.along.axis is not None
    axis = found.at(leg.along.axis)
    if leg.turret:
        return _on_turret(found, leg, joint)
    if not leg.rod:
        start = found.at(found.point(leg.along.other(GROUND), leg.hinge))
        return f"{'Along' if joint is leg.along else 'Across'}({joint.name}, {start}, {axis}"
    end = found.point(leg.hinge.other(leg.rod), leg.hinge)
    moved, start = _moved(found, leg, end, found.at, sp.zeros(SPACE, 1))
    if joint is leg.along:
        return f"Along({joint.name}, {found.at(start)}, {axis}"
    return f"FreeAlong({moved}, {axis}"


def _on_turret(found: Finder, leg: TwoMotors, joint: Joint) -> str:
    """One of both motors of a leg on a turret, in the plane that passes through its axis."""
    loop, axis, normal = found.loop, leg.along.axis, leg.hinge.axis
    assert axis is not None
    assert normal is not None
    pivot = found.pivot(leg.along)
    mover = leg.hinge.other(leg.rod) if leg.rod else leg.along.other(GROUND)
    end = found.point(mover, leg.hinge)
    ahead = normal.cross(axis).applyfunc(sp.simplify)
    if sp.simplify((end - pivot).dot(ahead)).xreplace(loop.positive).is_negative:
        ahead = -ahead
    if sp.simplify((end - pivot).dot(normal)) != 0:
        raise loop.error(
            f"{leg.hinge.name} is beside the axis of {leg.along.name}: the plane of the leg, which "
            f"is normal to the axis of {leg.hinge.name}, has to contain this axis"
        )

    def flat(v: sp.Matrix) -> str:
        """In the plane: along the direction of the turret, and along its axis."""
        return found.at(sp.Matrix([sp.simplify(v.dot(e)) for e in (ahead, axis)]))

    turret = f"Around({leg.along.name}, {found.at(pivot)}, {found.at(axis)}, {found.at(ahead)}"
    if joint is leg.along:
        return turret
    moved = (
        _moved(found, leg, end, flat, pivot)[0]
        if leg.rod
        else f"Stretch({joint.name}, {flat(end - pivot)})"
    )
    return f"OnTurret({moved}, {turret})"


def _moved(
    found: Finder,
    leg: TwoMotors,
    end: sp.Matrix,
    written: Callable[[sp.Matrix], str],
    origin: sp.Matrix,
) -> tuple[str, sp.Matrix]:
    """What moves the near ``end`` of a rod, with places seen from the ``origin``, and its start."""
    joint, body, length = leg.across, leg.hinge.other(leg.rod), source(found.loop.rods[leg.rod])
    assert joint.axis is not None
    if joint.kind == "prismatic":
        places = f"{written(end - origin)}, {written(joint.axis)}"
        return f"Slide({joint.name}, {length}, {places})", end
    start = found.loop.bodies[body].get(joint.at)
    if start is None:
        start = found.point(joint.other(body), joint)
    arm, start = across_axis(joint.axis, end - start, start)
    ways = ", ".join(map(written, found.directions(joint, arm)))
    lengths = f"{source(found.loop.length(arm))}, {length}"
    return f"Crank({joint.name}, {lengths}, {written(start - origin)}, {ways})", start


def told(leg: TwoMotors, joint: Joint) -> str:
    """What one of both motors of a leg does, in words."""
    if joint is leg.along:
        turns = (
            f"{joint.name} turns the plane of a leg, which passes through the axis of this joint"
        )
        moves = f"{joint.name} moves a leg along an axis, about which it turns"
        return turns if leg.turret else moves
    if not leg.rod:
        return f"{joint.name} is the length of such a leg"
    moved = "a crank" if joint.kind == "revolute" else "a slider"
    where = "in this plane" if leg.turret else "across the axis"
    return f"{joint.name} moves {moved} with the rod of such a leg, {where}"


__all__ = ["TwoMotors", "call_of", "in_pairs", "leg_on_axis", "told"]
