"""Recognises a planar linkage in which bodies also slide on each other."""

from __future__ import annotations

from dataclasses import dataclass, field

import sympy as sp

from closedform.mechanics.assur import degrees
from closedform.mechanics.assur_slides import (
    Fold,
    Group,
    Meet,
    OnCircle,
    SlidingOrder,
    Swing,
    sliding_freedoms,
    sliding_order,
)
from closedform.model.names import listed
from closedform.scaffold.loops.bodies import (
    GROUND,
    Joint,
    Loop,
    check_moved,
    check_pivot,
    with_pivots,
)
from closedform.scaffold.loops.cylinders import joined
from closedform.scaffold.loops.linkages import (
    FEW,
    LinkageLines,
    check_apart,
    instead_of_count,
    line_of,
    no_point,
    other_drive,
    reverse,
    safe,
)
from closedform.scaffold.source import literal, source

Points = dict[str, dict[str, sp.Matrix]]


@dataclass(frozen=True)
class Slide:
    """A slide of the file: both bodies, the axis, and the offset of the second when it is zero."""

    joint: Joint
    between: tuple[str, str]
    offset: sp.Matrix


@dataclass
class Found:
    """The bodies and slides of a file, as they are written."""

    loop: Loop
    cylinders: dict[str, Joint]
    points: Points = field(default_factory=dict)
    slides: list[Slide] = field(default_factory=list)
    hand: str = ""
    """The point that is the hand, under its name in ``points``."""

    def half_of(self, body: str) -> str:
        """The cylinder of which a body of the file is half."""
        return next((b for b, slide in self.cylinders.items() if body in slide.between), "")

    @property
    def with_joint(self) -> dict[str, Joint]:
        """The bodies on the ground that are driven or are the task."""
        joints = self.loop.joints.values()
        return {
            j.other(GROUND): j
            for j in joints
            if GROUND in j.between and (j.driven or j.name == self.loop.hand)
        }

    @property
    def driven(self) -> dict[str, Joint]:
        return {body: j for body, j in self.with_joint.items() if j.driven}

    @property
    def glides(self) -> dict[int, Joint]:
        """The driven slides between moving bodies, by their numbers."""
        moving = [(k, s.joint) for k, s in enumerate(self.slides) if GROUND not in s.between]
        return {k: joint for k, joint in moving if joint.driven}

    @property
    def pairs(self) -> list[tuple[str, str]]:
        return [s.between for s in self.slides]


def sliding(loop: Loop, *, few: bool = False) -> LinkageLines | None:
    """The lines of a linkage with slides; None if the file is of another kind.

    Kinds with ``few`` bodies come first, unless one asks for them.
    """
    joined_loop, cylinders = joined(with_pivots(loop))
    found = Found(joined_loop, cylinders)
    if not _is_one(found, few=few):
        return None
    _read_points(found)
    _read_slides(found)
    _separate(found)
    order = _ordered(found)
    plain = not found.slides
    folded = any(isinstance(group, Fold) for group in order.groups)
    if plain and not (folded or found.cylinders):
        return None  # what the kinds of pinned bodies say of it is nearer
    follower = loop.joints.get(loop.hand)
    hand = "" if follower else _hand(found)
    turning = {b: j for b, j in found.with_joint.items() if j.kind == "revolute"}
    for joint in turning.values():
        check_pivot(joined_loop, joint)
    bodies = tuple(line_of(name, at, turning) for name, at in found.points.items())
    slides = tuple(_line(found, s) for s in found.slides)
    passive = tuple(s.joint.name for s in found.slides if not _own(found, s))
    return LinkageLines(bodies, hand, _words(found, order), slides, passive, grouped=plain)


def _has_joints(found: Found) -> bool:
    """Whether all joints turn or slide, and the driven ones and the hand are on the ground."""
    follower = found.loop.joints.get(found.loop.hand)
    joints = found.loop.joints.values()
    return (
        all(j.kind in ("revolute", "prismatic") for j in joints)
        and all(GROUND in j.between or j.kind == "prismatic" for j in joints if j.driven)
        and not (follower and (follower.driven or GROUND not in follower.between))
    )


def _is_one(found: Found, *, few: bool) -> bool:
    """Whether the file is of this kind, and of no kind that has fewer bodies unless ``few``."""
    loop = found.loop
    joints = list(loop.joints.values())
    follower = loop.joints.get(loop.hand)
    driven = [j for j in joints if j.driven]
    slides = [j for j in joints if j.kind == "prismatic"]
    inputs, moving = len(driven) + len(found.cylinders), len(loop.bodies) - 1
    if (
        loop.dimensions != 2
        or inputs not in FEW
        or not (slides or few)
        or loop.parallelograms
        or not _has_joints(found)
    ):
        return False
    if not few and any(GROUND not in j.between for j in driven):
        return False
    least = FEW[inputs] - len(found.cylinders)
    return few or moving > least or (moving == least and inputs == 1 and not follower)


def placed(loop: Loop) -> Found | None:
    """The bodies of a planar linkage, with or without slides, that the joints determine."""
    joined_loop, cylinders = joined(with_pivots(loop))
    found = Found(joined_loop, cylinders)
    inputs = sum(j.driven for j in found.loop.joints.values()) + len(cylinders)
    fits = loop.dimensions == 2 and inputs in FEW and not loop.parallelograms
    if not fits or not _has_joints(found):
        return None
    _read_points(found)
    _read_slides(found)
    _separate(found)
    _ordered(found)
    found.hand = "" if loop.hand in loop.joints else _hand(found)
    return found


def _read_points(found: Found) -> None:
    """The points of all bodies; a rod has one at each end, and a block those of its pins."""
    loop = found.loop
    for name, points in loop.bodies.items():
        if name not in loop.rods:
            found.points[name] = dict(points)
            continue
        if sliding_joints := [j.name for j in loop.of(name) if j.kind == "prismatic"]:
            raise loop.error(
                f"the rod {name} slides by {sliding_joints[0]}; give it points instead of a "
                f"length, so that it is known along which line"
            )
        ends = list(dict.fromkeys(j.at for j in loop.of(name)))
        if len(ends) != 2:
            raise loop.error(
                f"the rod {name} must be joined at its two ends, and is at {listed(ends) or 'none'}"
            )
        far = sp.Matrix([loop.rods[name], 0])
        found.points[name] = dict(zip(ends, (sp.zeros(2, 1), far), strict=True))


def _read_slides(found: Found) -> None:
    loop = found.loop
    own = list(found.with_joint.values())
    # where a body is when its own joint is zero comes first
    for joint in sorted(loop.joints.values(), key=lambda j: j not in own):
        if joint.kind == "prismatic":
            first, second = joint.between
            between = (second, first) if second == GROUND else (first, second)
            if joint.axis is None:
                raise loop.error(f"{joint.name} slides; say in which direction with axis")
            found.slides.append(Slide(joint, between, _offset(found, joint, between)))
    for name in loop.bodies:
        pins = [j for j in loop.of(name) if j.kind == "revolute"]
        if missing := [j for j in pins if j.at not in found.points[name]]:
            raise loop.error(no_point(name, missing[0]))


def _offset(found: Found, joint: Joint, between: tuple[str, str]) -> sp.Matrix:
    """Where the second body is when the slide is at zero, seen from its own coordinates.

    The line of the slide passes ``at``.  A body without points has its pins there, and one with a
    single point has it on this line.
    """
    loop, zero = found.loop, sp.zeros(2, 1)
    places = [found.points[body].get(joint.at) for body in between]
    if not any(found.points[body] for body in between):  # a strut: its line passes both pins
        for body in between:
            found.points[body] |= dict.fromkeys(_pins(loop, body), zero)
        return zero
    first, second = places
    if first is not None and second is not None:
        if joint in found.with_joint.values() and any(first - second):
            raise loop.error(
                f"{joint.at} has different coordinates on {between[0]} and on {between[1]}, which "
                f"is where it is when {joint.name} is zero"
            )
        return first - second
    if first is not None:
        return _from_line(found, joint, between, first)
    if second is not None:
        return -_from_line(found, joint, between[::-1], second)
    raise loop.error(
        f"neither {between[0]} nor {between[1]} has the point {joint.at}, where {joint.name} slides"
    )


def _from_line(found: Found, joint: Joint, between: tuple[str, str], place: sp.Matrix) -> sp.Matrix:
    """The offset of the second body, if the first alone has the point ``at`` of the slide."""
    loop, (own, body), axis = found.loop, between, joint.axis
    other = found.points[body]
    assert axis is not None
    if not other:
        other |= dict.fromkeys(_pins(loop, body) or [joint.at], place)
    elif not joint.driven and joint not in found.with_joint.values():
        if len(other) == 1:
            (only,) = other.values()
            return place - only
        across = sp.Matrix([-axis[1], axis[0]])
        if all(sp.simplify(across.dot(at - place)) != 0 for at in other.values()):
            raise loop.error(
                f"{joint.name} slides along the line through {joint.at} of {own}, on which {body} "
                f"has no point; give {body} the point {joint.at}, which is there when "
                f"{joint.name} is zero"
            )
    return sp.zeros(2, 1)


def _pins(loop: Loop, body: str) -> list[str]:
    """Where other bodies are pinned to a body."""
    return [j.at for j in loop.of(body) if j.kind == "revolute"]


def _separate(found: Found) -> None:
    """Give points that bodies have in common, but that no pin holds together, other names."""
    loop = found.loop
    separated: Points = {name: {} for name in found.points}
    for point in dict.fromkeys(p for at in found.points.values() for p in at):
        holders = [name for name, at in found.points.items() if point in at]
        pins = [j for j in loop.joints.values() if j.at == point and j.kind == "revolute"]
        parts: list[set[str]] = []
        for name in holders:
            part = {name}
            for _ in pins:
                part |= {b for j in pins if part & {*j.between} for b in j.between}
            if part not in parts:
                parts.append(part)
        for part in parts:
            slid = any(s.joint.at == point and {*s.between} & part for s in found.slides)
            plain = GROUND in part or len(parts) == 1
            if not (plain or slid or parts.index(part) == 0):
                raise loop.error(
                    f"{point} is a point of {holders[0]} and of {min(part)}, but no joint holds "
                    f"them together there; give one of them another name"
                )
            owner = next(name for name in holders if name in part)
            label = safe(point) if plain else f"{safe(point)}_{safe(owner)}"
            for name in part:
                separated[name][label] = found.points[name][point]
    found.points = separated


def _hand(found: Found) -> str:
    """The name of the point that is the hand."""
    loop = found.loop
    names = [
        (body, p)
        for body, at in found.points.items()
        for p in at
        if body != GROUND and (p == safe(loop.hand) or p.startswith(f"{safe(loop.hand)}_"))
    ]
    known = {p for body in (GROUND, *found.driven) for p in found.points[body]}
    moved = [p for body, p in names if p not in known and loop.hand in loop.bodies[body]]
    moved += [p for body, p in names if p not in known]
    if not moved:
        check_moved(loop, found.driven)
        raise loop.error(f"the hand {loop.hand} is neither a point that moves nor a joint")
    return moved[0]


def _ordered(found: Found) -> SlidingOrder:
    """The groups of the linkage, if all are solved alone."""
    loop = found.loop
    check_apart(loop, found.points, found.cylinders)
    free = sliding_freedoms(found.points, found.pairs) + len(found.cylinders)
    driven = [*found.driven.values(), *found.cylinders.values(), *found.glides.values()]
    if free != len(driven):
        raise loop.error(
            f"{listed([j.name for j in driven])} drive{'s' * (len(driven) == 1)} this linkage, but "
            f"by the count of its bodies, pins and slides it has {degrees(free)}"
            + instead_of_count(free, len(driven))
        )
    _check_directions(found)
    known = [GROUND, *found.driven]
    order = sliding_order(
        found.points, found.pairs, known, bars=found.cylinders, driven=found.glides
    )
    for step in order.held:
        raise loop.error(
            f"the driven joints and the bodies before it hold {step.body} already, so they could "
            f"not move"
        )
    for group in order.groups:
        _check_lengths(found, group)
    if order.left:
        without = {name: at for name, at in found.points.items() if name not in found.cylinders}
        others = [
            j.name
            for j in loop.of(GROUND)
            if len(driven) == 1
            and not j.driven
            and j.other(GROUND) in without
            and not sliding_order(without, found.pairs, [GROUND, j.other(GROUND)]).left
        ]
        instead = other_drive(others, [j.name for j in found.cylinders.values()])
        if not found.cylinders:
            instead += reverse(loop, others, driven)
        raise loop.error(f"this is a planar linkage with slides, but {order.undone}{instead}")
    return order


def _check_lengths(found: Found, group: Group) -> None:
    """Refuse a body that holds a pin where it is held itself."""
    if not isinstance(group, Meet):
        return
    for hold in group.holds:
        if not isinstance(hold, OnCircle) or hold.body in found.cylinders:
            continue
        own = found.points[hold.body]
        ends = [own[p] for p in (hold.near, group.pin) if p in own]
        if len(ends) > 1 and not any(map(sp.simplify, ends[1] - ends[0])):
            raise found.loop.error(
                f"{hold.near} and {group.pin} are at the same point of {hold.body}"
            )


def _own(found: Found, slide: Slide) -> bool:
    """Whether a slide is driven or is the task."""
    return slide.joint.driven or slide.joint.name == found.loop.hand


def _check_directions(found: Found) -> None:
    """Refuse a body that slides on another one as this one does on the ground."""
    for own in (s for s in found.slides if GROUND in s.between):
        (body,) = (b for b in own.between if b != GROUND)
        for other in (s for s in found.slides if s is not own and body in s.between):
            a, b = own.joint.axis, other.joint.axis
            if a is not None and b is not None and sp.simplify(a[0] * b[1] - a[1] * b[0]) == 0:
                raise found.loop.error(
                    f"{own.joint.name} and {other.joint.name} slide in the same direction, so "
                    f"{body} could move alone"
                )


def _line(found: Found, slide: Slide) -> str:
    axis, (first, second) = slide.joint.axis, slide.between
    assert axis is not None
    own = _own(found, slide)
    parts = [
        f"({literal(safe(first))}, {literal(safe(second))})",
        f"({', '.join(map(source, axis))})",
    ]
    if any(slide.offset):
        parts.append(f"({', '.join(source(sp.simplify(e)) for e in slide.offset)})")
    parts.append(f"{'joint' if own else 'slide'}={slide.joint.name}")
    return f"Sliding({', '.join(parts)})"


def _words(found: Found, order: SlidingOrder) -> str:
    moved = [
        f"{j.name} {'turns' if j.kind == 'revolute' else 'moves'} {safe(body)}"
        for body, j in found.driven.items()
    ]
    for joint in found.glides.values():
        first, second = map(safe, joint.between)
        moved.append(f"{joint.name} moves {second} on {first}")
    moved += [f"{j.name} is the length of {safe(body)}" for body, j in found.cylinders.items()]
    told = []
    for group in order.groups:
        names = " and ".join(map(safe, group.bodies))
        if isinstance(group, Meet):
            told.append(f"{names} meet in {group.pin}" if len(group.bodies) > 1 else names)
        elif isinstance(group, Swing):
            told.append(f"{names} slide on each other")
        elif isinstance(group, Fold):
            told.append(
                f"{names} meet on {safe(group.on)}"
                if group.far
                else f"{safe(group.on)} carries {names}"
            )
        else:
            told.append(names)
    return f"Joint {listed(moved)}.  Then {', '.join(told)}."


__all__ = ["placed", "sliding"]
