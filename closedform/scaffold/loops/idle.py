"""Leaves out the bodies of a planar linkage that do not move its hand."""

from __future__ import annotations

from dataclasses import replace

from closedform.mechanics.assur_slides import groups_for, holder, sliding_order
from closedform.model.names import listed
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.loops.bodies import GROUND, Loop
from closedform.scaffold.loops.sliding import placed


def without_idle(loop: Loop) -> Loop:
    """The loop without the bodies that the hand does not depend on, as the other jaw of a gripper.

    A loop of another kind, or one that the joints do not determine, stays as it is.
    """
    try:
        found = placed(loop)
    except TableError:
        return loop  # the kind that fits it best says why
    if found is None:
        return loop
    known = [GROUND, *found.driven]
    groups = sliding_order(found.points, found.pairs, known).groups
    follower = loop.joints.get(loop.hand)
    last = follower.other(GROUND) if follower else holder(groups, found.points, known, found.hand)
    if not any(last in group.bodies for group in groups):
        return loop
    kept = groups_for(groups, found.points, found.pairs, last)
    moving = {*known, *(b for group in kept for b in group.bodies)}
    idle = [b for b in found.points if b not in moving]
    if not idle:
        return loop
    idle += [b for b in loop.bodies if b not in found.points and found.half_of(b) in idle]
    loop.notes.append(
        f"{loop.file}: {listed(idle)} do{'es' * (len(idle) == 1)} not move the hand and "
        f"{'is' if len(idle) == 1 else 'are'} left out"
    )
    return replace(
        loop,
        bodies={name: at for name, at in loop.bodies.items() if name not in idle},
        rods={name: length for name, length in loop.rods.items() if name not in idle},
        joints={n: j for n, j in loop.joints.items() if not {*j.between} & {*idle}},
    )


__all__ = ["without_idle"]
