"""What is said of legs that are recognised and not derived: what they are, and what to do."""

from __future__ import annotations

from collections.abc import Sequence

from closedform.scaffold.loops.bodies import GROUND, Joint, Loop


def two_motors(loop: Loop, joint: Joint, onward: Sequence[Joint]) -> str:
    """What is said of a driven slider that carries a leg that stretches, as in a 3-PRPS."""
    if len(onward) != 1 or joint.kind != "prismatic":
        return ""
    (hinge,) = onward
    tube = hinge.other(joint.other(GROUND))
    second = next((j for j in loop.of(tube) if j.driven and j.kind == "prismatic"), None)
    if second is None:
        return ""
    return (
        f".  {second.name} stretches the same leg, so it has two motors, as in a 3-PRPS mechanism; "
        f"this is supported if {hinge.name} is revolute and its axis is that of {joint.name}.  "
        f"Otherwise write the equations in Python, or hold one of both motors and describe what is "
        f"left"
    )


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
