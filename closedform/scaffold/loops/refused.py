"""What is said of legs that are recognised and not derived: what they are, and what to do."""

from __future__ import annotations

from collections.abc import Sequence

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop

DEGREE_OF_TRIPOD = 16
"""Of the forward problem of three legs that are hinged on the ground and end in balls."""


def two_motors(loop: Loop, joint: Joint, onward: Sequence[Joint]) -> str:
    """What is said of a driven slider that carries a leg that stretches, as in a 3-PRPS."""
    if len(onward) != 1 or joint.kind != "prismatic":
        return ""
    (hinge,) = onward
    tube = hinge.other(joint.other(GROUND))
    second = next((j for j in loop.of(tube) if j.driven and j.kind == "prismatic"), None)
    if second is None:
        return ""
    along = ""
    if hinge.kind == "revolute" and _parallel(joint, hinge):
        along = (
            f"  Its inverse is short: {joint.name} is the coordinate of the end of the leg along "
            f"the axis, and {second.name} the distance from there.  Three such legs lead to the "
            f"equation of a 3-RPS mechanism for the pose, of degree {DEGREE_OF_TRIPOD}."
        )
    return (
        f".  {second.name} stretches the same leg, so it has two motors, as in a 3-PRPS mechanism; "
        f"this is not supported.{along}  Write the equations in Python, or hold one of both motors "
        f"and describe what is left"
    )


def _parallel(one: Joint, other: Joint) -> bool:
    """Whether both axes are given and parallel."""
    return one.axis is not None and other.axis is not None and not any(one.axis.cross(other.axis))


def carried(loop: Loop, joint: Joint) -> str:
    """What is said of a driven joint that turns a body which nothing else holds."""
    alone = [body for body in joint.between if loop.of(body) == [joint]]
    if len(alone) != 1 or joint.kind != "revolute":
        return ""
    (tool,) = alone
    body = joint.other(tool)
    return (
        f".  Nothing else holds {tool}, so {joint.name} is in no loop: it is the angle of {tool} "
        f"on {body}.  Leave both out, and take a point of {body} as the hand"
    )


__all__ = ["carried", "two_motors"]
