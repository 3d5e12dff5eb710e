"""Leaves out what does not move the hand: bodies of a planar linkage, and chains in space."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from closedform.mechanics.assur_slides import groups_for, holder, sliding_order
from closedform.model.names import listed
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.loops.bodies import GROUND, Joint, Loop
from closedform.scaffold.loops.sliding import placed

FREEDOMS = {"revolute": 1, "prismatic": 1, "universal": 2, "spherical": 3}
ALL = 6
"""The freedoms of a body in space."""


def without_idle(loop: Loop) -> Loop:
    """The loop without what the hand does not depend on.

    This is the other jaw of a gripper, the shaft that turns the tool of a Delta robot, or a second
    wing on the same crank.  A loop of another kind, or one that the joints do not determine, stays
    as it is.
    """
    return _without_bodies(loop) if loop.dimensions == 2 else _without_shafts(_without_wings(loop))


def _without_wings(loop: Loop) -> Loop:
    """The loop without the passive chains from the ground to a driven body that hold nothing."""
    driven = [j.other(GROUND) for j in loop.of(GROUND) if j.driven]
    hands = {b for b, at in loop.bodies.items() if loop.hand in at and b != GROUND}
    idle = [
        chain
        for end in driven
        for chain in _chains(loop, end)
        if not any(j.driven or loop.hand in (j.name, j.at) for j in chain)
        and not {b for j in chain for b in j.between if b != end} & hands
        and _freedoms(chain) == ALL
    ]
    if not idle:
        return loop
    used = {j.name for chain in idle for j in chain}
    gone = list(dict.fromkeys(b for c in idle for j in c for b in j.between))
    gone = [b for b in gone if b not in (GROUND, *driven)]
    loop.notes.append(
        f"{loop.file}: {listed(gone)} follow{'s' * (len(gone) == 1)} a driven body, and do"
        f"{'es' * (len(gone) == 1)} not move the hand; {'it is' if len(gone) == 1 else 'they are'} "
        f"left out"
    )
    return _without(loop, gone, {n: j for n, j in loop.joints.items() if n not in used})


def _without_shafts(loop: Loop) -> Loop:
    """The loop without the chains from the ground to the hand that leave it all freedoms."""
    hands = [b for b, at in loop.bodies.items() if loop.hand in at and b != GROUND]
    shafts = [[*_shaft_joints(loop, b)] for b in hands]
    idle = next(filter(None, shafts), None)
    if not idle:
        return loop
    names = {j.name for j in idle}
    joints = {n: j for n, j in loop.joints.items() if n not in names}
    left = {b for j in joints.values() for b in j.between}
    gone = [b for j in idle for b in j.between if b not in left]
    driven = [j.name for j in idle if j.driven]
    beside = f"; what {listed(driven)} moves beside it is not derived" * bool(driven)
    loop.notes.append(
        f"{loop.file}: {listed([j.name for j in idle])} leave the hand all freedoms and are left "
        f"out{beside}"
    )
    return _without(loop, gone, joints)


def _shaft_joints(loop: Loop, hand: str) -> Iterator[Joint]:
    """The joints of the chains of four or more between the ground and the hand that hold nothing.

    The point of the hand may be on the last body of such a chain too.
    """
    for chain in _chains(loop, hand):
        if len(chain) > 3 and _freedoms(chain) >= ALL:
            yield from chain


def _chains(loop: Loop, end: str) -> Iterator[list[Joint]]:
    """The joints of each chain from the ground to a body, without others on the way."""
    for first in loop.of(GROUND):
        chain, body = [first], first.other(GROUND)
        while body != end and len(onward := [j for j in loop.of(body) if j not in chain]) == 1:
            chain.append(onward[0])
            body = onward[0].other(body)
        if body == end:
            yield chain


def _freedoms(chain: Sequence[Joint]) -> int:
    """The passive freedoms of a chain; between two ball joints a body may turn by itself."""
    passive = [j for j in chain if not j.driven]
    balls = sum(j.kind == "spherical" for j in passive)
    return sum(FREEDOMS[j.kind] for j in passive) - max(balls - 1, 0)


def _without_bodies(loop: Loop) -> Loop:
    """A planar loop without the bodies that the hand does not depend on."""
    try:
        found = placed(loop)
    except TableError:
        return loop  # the kind that fits it best says why
    if found is None:
        return loop
    known = [GROUND, *found.driven]
    groups = sliding_order(
        found.points, found.pairs, known, bars=found.cylinders, driven=found.glides
    ).groups
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
    joints = _held_without(loop, idle)
    if not any(last in j.between for j in joints.values() if j is not follower):
        return loop  # its direction is that of a body on which it slides, as in an Oldham coupling
    loop.notes.append(
        f"{loop.file}: {listed(idle)} do{'es' * (len(idle) == 1)} not move the hand and "
        f"{'is' if len(idle) == 1 else 'are'} left out"
    )
    return _without(loop, idle, joints)


def _held_without(loop: Loop, gone: Sequence[str]) -> dict[str, Joint]:
    """The joints without some bodies; bodies that one of these joins at a pin stay together."""
    kept = {n: j for n, j in loop.joints.items() if not {*j.between} & {*gone}}
    for name, joint in loop.joints.items():
        stay = [b for b in joint.between if b not in gone]
        if joint.kind != "revolute" or len(stay) != 1 or name in kept:
            continue
        before, after = (
            _pinned([j for j in joints if j.kind == "revolute" and j.at == joint.at], stay[0])
            for joints in (loop.joints.values(), kept.values())
        )
        if others := [b for b in before if b not in gone and b not in after]:
            kept[name] = replace(joint, between=(others[0], stay[0]))
    return {name: kept[name] for name in loop.joints if name in kept}


def _pinned(pins: Sequence[Joint], body: str) -> list[str]:
    """The bodies that the joints at a pin hold together, one of which is given first."""
    found = [body]
    for one in found:
        found += [b for j in pins if one in j.between if (b := j.other(one)) not in found]
    return found


def _without(loop: Loop, gone: Sequence[str], joints: Mapping[str, Joint]) -> Loop:
    """The loop without some bodies and rods, with these joints."""
    return replace(
        loop,
        bodies={b: at for b, at in loop.bodies.items() if b not in gone},
        rods={b: length for b, length in loop.rods.items() if b not in gone},
        joints=dict(joints),
    )


__all__ = ["without_idle"]
