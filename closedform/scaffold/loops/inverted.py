"""Reads a single loop whose task is the joint between two moving bodies, such as an RRSS linkage.

Seen from the body that both the driven joint and the task are on, the ground moves, and the loop is
an ordinary one: the inversion of a linkage has the same joints.
"""

from __future__ import annotations

from dataclasses import replace

from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop


def inverted(loop: Loop) -> Loop:
    """The loop as it is seen from the driven body, if the task is a joint on this.

    Any other loop stays as it is.
    """
    task, drivers = loop.joints.get(loop.hand), [j for j in loop.joints.values() if j.driven]
    if task is None or len(drivers) != 1 or loop.dimensions != len(AXES):
        return loop
    (driver,) = drivers
    if GROUND in task.between or GROUND not in driver.between or driver.axis is None:
        return loop
    still = driver.other(GROUND)
    if still not in task.between:
        return loop
    base = next(name for name in ("base", "frame", "ground_") if name not in loop.bodies)
    bodies, names = dict(loop.bodies), {GROUND: base, still: GROUND}
    for joint, body, other in (
        (driver, still, GROUND),
        (task, still, task.other(still)),
        (task, task.other(still), still),
    ):
        if joint.at in bodies[other]:
            bodies[body] = {joint.at: bodies[other][joint.at], **bodies[body]}
    joints = {name: _renamed(joint, names) for name, joint in loop.joints.items()}
    joints[driver.name] = replace(joints[driver.name], axis=-driver.axis)
    turns = driver.kind == "revolute"
    moves, leg = ("turns about", "crank") if turns else ("slides along", "slider")
    loop.seen.append(
        f"The loop is seen from {still}, which stands still here, while the ground {moves} the "
        f"axis of {driver.name} the other way.  So the {leg} of {driver.name} is the ground."
    )
    return replace(
        loop,
        bodies={names.get(name, name): points for name, points in bodies.items()},
        joints=joints,
    )


def _renamed(joint: Joint, names: dict[str, str]) -> Joint:
    first, second = (names.get(body, body) for body in joint.between)
    return replace(joint, between=(first, second))


__all__ = ["inverted"]
