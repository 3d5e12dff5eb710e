"""Recognises a planar linkage of pinned bodies that is solved dyad by dyad."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import sympy as sp

from closedform.mechanics.assur import Dyad, Order, degrees, freedoms, order
from closedform.model.names import listed
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.loops.bodies import (
    GROUND,
    Joint,
    Loop,
    check_moved,
    check_pivot,
    with_pivots,
)
from closedform.scaffold.loops.cylinders import joined
from closedform.scaffold.source import literal, source

FEW = {1: 3, 2: 4}
"""The number of moving bodies of a single loop, for as many driven joints."""
POSE = 3
"""The number of driven joints that move a hand and turn it."""


@dataclass(frozen=True)
class LinkageLines:
    """The linkage as it is written: its bodies, its hand, and what it is in words."""

    bodies: tuple[str, ...]
    hand: str
    words: str
    slides: tuple[str, ...] = ()
    passive: tuple[str, ...] = ()
    """The passive slides."""
    posed: bool = False
    """Whether the task has the yaw of the body with the hand too."""
    grouped: bool = False
    """Whether it is solved as a linkage with slides, though it has none."""


def posed_linkage(loop: Loop) -> LinkageLines | None:
    """The lines of a linkage whose hand three joints move and turn; None if it is not right."""
    try:
        lines = linkage(loop, posed=True)
    except TableError:
        return None  # what the other kinds say of it is nearer
    on = list(
        dict.fromkeys(b for j in loop.joints.values() if j.at == loop.hand for b in j.between)
    )
    if lines and on:
        raise loop.error(
            f"three joints move the hand {loop.hand} and turn it, and it is a pin of {listed(on)}; "
            f"give one of them a point of another name there, which is the hand"
        )
    return lines


def linkage(loop: Loop, *, posed: bool = False) -> LinkageLines | None:
    """The lines of a linkage; None if the file is of another kind.

    Of three driven joints only those of a hand that is ``posed`` are read.
    """
    loop, cylinders = joined(with_pivots(loop))
    driven = [j for j in loop.joints.values() if j.driven]
    follower = loop.joints.get(loop.hand)
    inputs, moving = len(driven) + len(cylinders), len(loop.bodies) - 1
    few = FEW.get(inputs, 0) - len(cylinders)
    _check_slides(loop, inputs, moving > few)
    if (
        loop.dimensions != 2
        or inputs not in ((POSE,) if posed else FEW)
        or any(j.kind != "revolute" for j in loop.joints.values())
        or any(GROUND not in j.between for j in driven)
        or loop.parallelograms
        or (follower and (follower.driven or GROUND not in follower.between))
    ):
        return None
    point_of_one = inputs == 1 and not follower
    if moving < few or (moving == few and not point_of_one):
        return None
    if inputs > 1 and any(_without(loop, name) for name in loop.bodies):
        return None  # a leg may leave out where its body is joined, and its messages say more
    points = _points(loop)
    if posed and (follower or _on_legs(points, driven)):
        return None
    _check_pins(loop, points)
    check_apart(loop, points, cylinders)
    turned = {j.other(GROUND): j for j in driven}
    turning = dict(turned)
    found = _ordered(loop, points, turning, cylinders)
    if follower:
        turning[follower.other(GROUND)] = follower
    elif not any(loop.hand in at for at in points.values()):
        raise loop.error(f"the hand {loop.hand} is neither a point of a body nor a joint")
    check_moved(loop, turned)
    for joint in turning.values():
        check_pivot(loop, joint)
    bodies = tuple(line_of(name, at, turning) for name, at in points.items())
    words = _words(turned, cylinders, found)
    return LinkageLines(bodies, "" if follower else safe(loop.hand), words, posed=posed)


def _on_legs(points: Mapping[str, Iterable[str]], driven: Sequence[Joint]) -> bool:
    """Whether the hand is on legs that are no dyads, as that of a 3-RPR or 3-RRR mechanism."""
    return bool(order(points, [GROUND, *(j.other(GROUND) for j in driven)]).left)


def _check_slides(loop: Loop, inputs: int, more: bool) -> None:
    """Refuse what slides in a linkage of one driven joint if it is of no kind with slides."""
    moving = len(loop.bodies) - 1
    slides = [j.name for j in loop.joints.values() if j.kind == "prismatic"]
    if loop.dimensions == 2 and inputs == 1 and more and slides:
        raise loop.error(
            f"this is a planar linkage of {moving} moving bodies, in which {listed(slides)} "
            f"slide{'s' * (len(slides) == 1)}; a linkage of more than {FEW[1]} is supported with "
            f"revolute joints and slides.  The driven joint must be on the ground, or the slide "
            f"of a cylinder, which is pinned at both ends, and a joint that is the hand must be on "
            f"the ground"
        )


def _points(loop: Loop) -> dict[str, dict[str, sp.Matrix]]:
    """The points of all bodies; a rod has one at each end."""
    found: dict[str, dict[str, sp.Matrix]] = {}
    for name, points in loop.bodies.items():
        if name not in loop.rods:
            found[name] = {safe(p): at for p, at in points.items()}
            if missing := _without(loop, name):
                raise loop.error(no_point(name, missing[0]))
            continue
        ends = list(dict.fromkeys(safe(j.at) for j in loop.of(name)))
        if len(ends) != 2:
            raise loop.error(
                f"the rod {name} must be joined at its two ends, and is at {listed(ends) or 'none'}"
            )
        found[name] = dict(
            zip(ends, (sp.zeros(2, 1), sp.Matrix([loop.rods[name], 0])), strict=True)
        )
    return found


def no_point(body: str, joint: Joint) -> str:
    """What to write if a body has no point where a joint is."""
    return (
        f"{body} has no point {joint.at}, where {joint.name} is; give {body} this point, in the "
        f"coordinates of its other points"
    )


def _without(loop: Loop, name: str) -> list[Joint]:
    """The joints of a body, unless it is a rod, at which it has no point."""
    if name in loop.rods:
        return []
    return [j for j in loop.of(name) if j.at not in loop.bodies[name]]


def _check_pins(loop: Loop, points: Mapping[str, Mapping[str, sp.Matrix]]) -> None:
    """Refuse a point that two bodies have, if no joint holds them together there."""
    for point in dict.fromkeys(p for at in points.values() for p in at):
        holders = [name for name, at in points.items() if point in at]
        held = {holders[0]}
        pins = [j for j in loop.joints.values() if safe(j.at) == point]
        for _ in pins:
            held |= {b for j in pins if held & {*j.between} for b in j.between}
        if apart := [name for name in holders if name not in held]:
            raise loop.error(
                f"{point} is a point of {holders[0]} and of {apart[0]}, but no joint holds them "
                f"together there; give one of them another name"
            )


def _ordered(
    loop: Loop,
    points: Mapping[str, Mapping[str, sp.Matrix]],
    turning: Mapping[str, Joint],
    cylinders: Mapping[str, Joint],
) -> Order:
    """The dyads of the linkage, if there are no other groups."""
    free, drives = freedoms(points), [j.name for j in (*turning.values(), *cylinders.values())]
    if free != len(turning):
        raise loop.error(
            f"{listed(drives)} drive{'s' * (len(drives) == 1)} this linkage, but by the count of "
            f"its bodies and pins it has {degrees(free + len(cylinders))}"
            + instead_of_count(free, len(turning))
        )
    found = order(points, [GROUND, *turning])
    for step in found.held:
        raise loop.error(
            f"{step.body} is joined to {listed(step.points)}, which the driven joints and the "
            f"bodies before it place already, so they could not move"
        )
    if not found.left:
        return found
    degree = ", which leads to an equation of degree 6" if len(found.left) == 4 else ""
    without = {name: at for name, at in points.items() if name not in cylinders}
    others = [
        j.name
        for j in loop.of(GROUND)
        if len(turning) + len(cylinders) == 1
        and j.other(GROUND) in without
        and not order(without, [GROUND, j.other(GROUND)]).left
    ]
    instead = other_drive(others, [j.name for j in cylinders.values()])
    instead += reverse(loop, others, turning.values())
    raise loop.error(
        f"this is a planar linkage, but no two of the bodies {listed(found.left)} are a dyad (two "
        f"bodies with a common pin, each with one more point that is known); they are a group of "
        f"a higher class{degree}{instead}"
    )


def instead_of_count(free: int, driven: int) -> str:
    """What may be meant if the count of a linkage is not the number of driven joints."""
    if free > driven:
        return (
            ".  Drive more joints, or see whether a joint is missing: a rod is held at both ends, "
            "and a body on a slide in a slot needs a pin or a guide too"
        )
    return (
        ".  If its dimensions let it move all the same, as those of a guide where other bars lead "
        "already, or of a third bar of a parallelogram, leave out what is not needed"
    )


def other_drive(others: Sequence[str], cylinders: Sequence[str]) -> str:
    """What else may be driven, of which the length of a cylinder follows."""
    if not others:
        return ""
    beside = f" instead of {listed(cylinders)}, whose length follows from the posture"
    return f"; it can be solved if {' or '.join(others)} is driven{beside * bool(cylinders)}"


def reverse(loop: Loop, others: Sequence[str], driven: Iterable[Joint]) -> str:
    """That the inverse is the forward problem of the same linkage, if its hand may drive it.

    A cylinder is not among the ``driven`` joints, and its length is no hand.
    """
    joint = next(iter(driven), None)
    if loop.hand not in others or joint is None:
        return ""
    return (
        f'.  Driven by {loop.hand}, with hand = "{joint.name}", its fk is the inverse of this one, '
        f"and its jacobian is the reciprocal"
    )


def check_apart(
    loop: Loop, points: Mapping[str, Mapping[str, sp.Matrix]], cylinders: Mapping[str, Joint]
) -> None:
    """Refuse two bodies that are pinned together twice, which are rigid together."""
    for bodies in combinations(points, 2):
        shared = [p for p in points[bodies[0]] if p in points[bodies[1]]]
        if len(shared) < 2:
            continue
        places = " and at ".join(shared)
        bars = all(len(points[body]) == 2 for body in bodies)
        if bars or any(body in cylinders for body in bodies):
            raise loop.error(
                f"{listed(bodies)} are both pinned at {places}, so together they are one "
                f"bar, whose length cannot change; one of them has to be pinned elsewhere"
            )
        if GROUND in bodies:
            body = next(b for b in bodies if b != GROUND)
            raise loop.error(f"{body} is pinned to the ground at {places}, so it cannot move")
        raise loop.error(
            f"{listed(bodies)} are pinned together at {places}, so they are rigid "
            f"together.  Write them as one body with the points of both"
        )


def line_of(name: str, points: Mapping[str, sp.Matrix], turning: Mapping[str, Joint]) -> str:
    """A body as it is written."""
    places = ", ".join(f'"{p}": ({", ".join(map(source, at))})' for p, at in points.items())
    joint = f", {turning[name].name}" if name in turning else ""
    return f"{literal(safe(name))}: Body({{{places}}}{joint})"


def _words(turned: Mapping[str, Joint], cylinders: Mapping[str, Joint], found: Order) -> str:
    moved = [f"{j.name} turns {safe(body)}" for body, j in turned.items()]
    moved += [f"{j.name} is the length of {safe(body)}" for body, j in cylinders.items()]
    dyads = (
        f"{safe(s.bodies[0])} and {safe(s.bodies[1])} meet in {s.pin}"
        for s in found.steps
        if isinstance(s, Dyad)
    )
    return f"Joint {listed(moved)}.  Then {', '.join(dyads)}."


def safe(name: str) -> str:
    """A name as it may stand in names of variables."""
    return name.replace("-", "_")


__all__ = [
    "FEW",
    "LinkageLines",
    "check_apart",
    "instead_of_count",
    "line_of",
    "linkage",
    "no_point",
    "other_drive",
    "posed_linkage",
    "reverse",
    "safe",
]
