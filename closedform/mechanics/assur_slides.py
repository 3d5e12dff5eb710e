"""The order in which a planar linkage with slides is solved: one group after the other.

Bodies that slide on each other are not turned to each other.  So a body that slides on a known one
is known but for one number, and each of its points is on a line.  A group is a pin of two bodies,
each of which holds it on a circle or on such a line; a body that slides on two known ones; or two
bodies that slide on each other, each of which is pinned to a known point.

Three bodies of which each is pinned to both others are rigid together.  If one of them is a
cylinder, its length folds the two others.  They are one body for the groups that follow.

Whether crossed bars keep a body parallel to another one is a matter of lengths, so it is given.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, product

from closedform.mechanics.assur import freedoms

PAIR = 2


@dataclass(frozen=True)
class OnCircle:
    """A body holds a point at a distance from ``near``, another point of it that is known."""

    body: str
    near: str


@dataclass(frozen=True)
class OnLine:
    """A body holds a point on a line, because it slides on a known body by the ``slide``."""

    body: str
    slide: int


@dataclass(frozen=True)
class Meet:
    """A ``pin`` that two bodies hold; both are the same if it slides on two bodies."""

    pin: str
    holds: tuple[OnCircle | OnLine, OnCircle | OnLine]

    @property
    def bodies(self) -> tuple[str, ...]:
        return tuple(dict.fromkeys(h.body for h in self.holds))


@dataclass(frozen=True)
class Swing:
    """Two bodies that slide on each other; the points in ``near`` are known."""

    bodies: tuple[str, str]
    near: tuple[str, str]
    slide: int


@dataclass(frozen=True)
class _One:
    """A group of one body."""

    body: str

    @property
    def bodies(self) -> tuple[str, ...]:
        return (self.body,)


@dataclass(frozen=True)
class Place(_One):
    """A body with the known point ``near`` that slides keep from turning to the body ``like``."""

    like: str
    near: str


@dataclass(frozen=True)
class Hold(_One):
    """A body that is held at known points, or at one and by slides on known bodies."""

    points: tuple[str, ...]
    slides: tuple[int, ...] = ()


@dataclass(frozen=True)
class EitherWay(_One):
    """A body with the known point ``near``, parallel to the body ``like`` but for half a turn."""

    like: str
    near: str


@dataclass(frozen=True)
class Fold:
    """Two bodies that become parts of the body ``on``, because all three are rigid together.

    The first one turns about this body at ``pin``, or slides on it by ``slide``.  The second one is
    pinned to it at ``near``, and both bodies meet in ``far``.  If the slide is driven, one body is
    a part of another one without a second one.
    """

    bodies: tuple[str, ...]
    on: str
    pin: str = ""
    near: str = ""
    far: str = ""
    slide: int | None = None


Group = Meet | Swing | Place | Hold | EitherWay | Fold


@dataclass
class SlidingOrder:
    """The groups in their order, and the bodies that are left."""

    groups: list[Group] = field(default_factory=list)
    left: list[str] = field(default_factory=list)

    @property
    def held(self) -> list[Hold]:
        return [g for g in self.groups if isinstance(g, Hold)]

    @property
    def undone(self) -> str:
        """Why the bodies that are left are not solved."""
        return (
            f"no two of the bodies {', '.join(self.left)} are a group that is solved alone: they "
            f"are a group of a class above II"
        )


@dataclass
class _Known:
    """The bodies with their points, the pairs of them that slide, and what is known of them."""

    on: dict[str, tuple[str, ...]]
    slides: Sequence[tuple[str, str]]
    bodies: set[str]
    points: set[str]

    def near(self, body: str) -> tuple[str, ...]:
        return tuple(p for p in self.on[body] if p in self.points)

    def of(self, body: str) -> Iterator[tuple[int, str]]:
        """The slides of a body, with the body at the other side."""
        for k, pair in enumerate(self.slides):
            if body in pair:
                yield k, pair[1 - pair.index(body)]

    def lines(self, body: str) -> tuple[int, ...]:
        """The slides of a body on known ones."""
        return tuple(k for k, other in self.of(body) if other in self.bodies)

    def like(self, body: str) -> str:
        """A known body that is not turned to another one; empty if there is none."""
        ways = [body]
        for at in ways:
            for _, other in self.of(at):
                if other in self.bodies:
                    return other
                if other not in ways:
                    ways.append(other)
        return ""

    def fold(self, group: Fold) -> None:
        """Make both bodies parts of the one that they are folded onto."""
        points = [p for name in (group.on, *group.bodies) for p in self.on[name]]
        self.on[group.on] = tuple(dict.fromkeys(points))

    def shared(self, first: str, second: str) -> list[str]:
        """The points at which two bodies are pinned together."""
        return [p for p in self.on[first] if p in self.on[second]]

    def holds(self, body: str) -> OnCircle | OnLine | None:
        """How an unknown body holds its other points."""
        if lines := self.lines(body):
            return OnLine(body, lines[0])
        near = self.near(body)
        return OnCircle(body, near[0]) if near and not self.like(body) else None


def sliding_order(
    bodies: Mapping[str, Iterable[str]],
    slides: Sequence[tuple[str, str]],
    known: Iterable[str],
    points: Iterable[str] = (),
    parallel: Sequence[tuple[str, str]] = (),
    *,
    bars: Collection[str] = (),
    driven: Collection[int] = (),
) -> SlidingOrder:
    """The order for bodies with named points, some of which slide on each other.

    Parameters
    ----------
    bodies
        the names of the points of each body; where two have a point of the same name, they are
        pinned together
    slides
        the pairs of bodies that slide on each other
    known
        the bodies that are known
    points
        the points that are known besides those of these bodies
    parallel
        pairs whose first body is parallel to the second but for half a turn; this is used where
        nothing else is left
    bars
        the bodies onto which no other one is folded, such as cylinders
    driven
        the slides between moving bodies whose joints are driven
    """
    on = {name: tuple(dict.fromkeys(at)) for name, at in bodies.items()}
    here = {*known}
    now = _Known(on, slides, here, {p for name in here for p in on[name]} | {*points})
    found = SlidingOrder(left=[name for name in on if name not in here])
    while (
        group := _glide(now, found.left, driven)
        or _next(now, found.left)
        or _either_way(now, found.left, parallel)
        or _fold(now, found.left, bars)
    ):
        found.groups.append(group)
        if isinstance(group, Fold):
            now.fold(group)
            found.left = [name for name in found.left if name not in group.bodies]
            continue
        now.bodies |= {*group.bodies}
        now.points |= {p for name in group.bodies for p in on[name]}
        if isinstance(group, Meet):
            now.points.add(group.pin)
        found.left = [name for name in found.left if name not in group.bodies]
    return found


def _next(now: _Known, left: Sequence[str]) -> Group | None:
    for name in left:
        near, lines, like = now.near(name), now.lines(name), now.like(name)
        if len(near) >= PAIR or (near and lines):
            return Hold(name, near, lines)
        if near and like:
            return Place(name, like, near[0])
    for name in left:
        if len(lines := now.lines(name)) >= PAIR and now.on[name]:
            first, second = (OnLine(name, k) for k in lines[:2])
            return Meet(now.on[name][0], (first, second))
    # where there is a choice, a direction is less sensitive than circles that nearly touch
    for a, b in combinations(left, 2):
        between = [k for k, other in now.of(a) if other == b]
        if between and now.near(a) and now.near(b) and not now.like(a):
            return Swing((a, b), (now.near(a)[0], now.near(b)[0]), between[0])
    for a, b in combinations(left, 2):
        shared = [p for p in now.on[a] if p in now.on[b] and p not in now.points]
        first_hold, second_hold = now.holds(a), now.holds(b)
        if shared and first_hold and second_hold:
            return Meet(shared[0], (first_hold, second_hold))
    return None


def _either_way(
    now: _Known, left: Sequence[str], parallel: Sequence[tuple[str, str]]
) -> EitherWay | None:
    for body, like in parallel:
        if body in left and like in now.bodies and (near := now.near(body)):
            return EitherWay(body, like, near[0])
    return None


def _glide(now: _Known, left: Sequence[str], driven: Collection[int]) -> Fold | None:
    """A body that a driven slide moves on another one, and that slides on no more bodies."""
    for k in driven:
        for body, on in (now.slides[k], now.slides[k][::-1]):
            if body in left and on in left and len([*now.of(body)]) == 1:
                return Fold((body,), on, slide=k)
    return None


def _fold(now: _Known, left: Sequence[str], bars: Collection[str]) -> Fold | None:
    """Three bodies, each of which is joined to both others; that with the most points has them."""
    whole = [name for name in left if name not in bars]
    pinned = [name for name in left if not any(now.of(name))]
    for on in sorted(whole, key=lambda name: -len(now.on[name])):
        slid = {b: k for k, b in now.of(on) if [*now.of(b)] == [(k, on)]}
        loose = sorted(pinned, key=lambda b: (b in bars, -len(now.on[b])))
        for first, second in product([*loose, *slid], loose):
            if on in (first, second) or first == second:
                continue
            nears, fars = (now.shared(second, other) for other in (on, first))
            pins = [""] if first in slid else now.shared(first, on)
            for pin, near, far in product(pins, nears, fars):
                if len({pin, near, far}) == len((pin, near, far)):
                    ends = {"pin": pin, "near": near, "far": far}
                    return Fold((first, second), on, **ends, slide=slid.get(first))
    return None


def sliding_freedoms(bodies: Mapping[str, Iterable[str]], slides: Sequence[tuple[str, str]]) -> int:
    """The number of joints that have to be driven, by the count of bodies, pins and slides.

    A loop of slides alone keeps the directions of its bodies once more than is needed.
    """
    parts: list[set[str]] = []
    for pair in slides:
        touched = [part for part in parts if part & {*pair}]
        parts = [part for part in parts if part not in touched]
        parts.append({*pair}.union(*touched))
    loops = len(slides) - sum(len(part) - 1 for part in parts)
    return freedoms(bodies) - 2 * len(slides) + loops


def groups_for(
    groups: Sequence[Group],
    bodies: Mapping[str, Iterable[str]],
    slides: Sequence[tuple[str, str]],
    wanted: str,
) -> list[Group]:
    """The groups that the body ``wanted`` depends on, in their order, and that of this body.

    With it come those of the bodies by which slides keep it from turning, though they follow later.
    """
    kept: list[Group] = []
    points: set[str] = set()
    folded = {b: group.on for group in groups if isinstance(group, Fold) for b in group.bodies}
    names = {wanted}
    while wanted in folded:
        wanted = folded[wanted]
        names.add(wanted)
    for group in groups:
        if isinstance(group, Place) and group.body == wanted:
            names |= {*_between(slides, wanted, group.like)}
    for group in reversed(groups):
        near, on = _needs(group, bodies, slides)
        moved = [*group.bodies]
        for name in moved:
            moved += [b for b, base in folded.items() if base == name]
        given = {p for name in moved for p in bodies[name]} - near
        if names & {*group.bodies} or points & given:
            kept.insert(0, group)
            points |= near
            names |= on
    return kept


def _between(slides: Sequence[tuple[str, str]], body: str, like: str) -> list[str]:
    """The bodies of the shortest chain of slides from one body to another, without both."""
    chains = [[body]]
    for chain in chains:
        for pair in slides:
            if chain[-1] not in pair:
                continue
            other = pair[1 - pair.index(chain[-1])]
            if other == like:
                return chain[1:]
            if not any(other in c for c in chains):
                chains.append([*chain, other])
    return []


def holder(
    groups: Sequence[Group], bodies: Mapping[str, Iterable[str]], known: Iterable[str], point: str
) -> str:
    """The body of the first group that holds a point, unless ``known`` bodies do; empty if none."""
    there = {p for name in known for p in bodies[name]}
    for group in groups:
        if point in there:
            break
        if holders := [name for name in group.bodies if point in bodies[name]]:
            return holders[0]
        there |= {p for name in group.bodies for p in bodies[name]}
    return ""


def _needs(
    group: Group, bodies: Mapping[str, Iterable[str]], slides: Sequence[tuple[str, str]]
) -> tuple[set[str], set[str]]:
    """The points and the bodies that have to be known before a group."""

    def other(k: int, body: str) -> str:
        return slides[k][1 - slides[k].index(body)]

    if isinstance(group, Meet):
        near = {h.near for h in group.holds if isinstance(h, OnCircle)}
        near |= {group.pin for h in group.holds if group.pin not in bodies[h.body]}
        return near, {other(h.slide, h.body) for h in group.holds if isinstance(h, OnLine)}
    if isinstance(group, Swing):
        return {*group.near}, set()
    if isinstance(group, Fold):
        return {group.pin, group.near} - {""}, {group.on}
    if isinstance(group, Place | EitherWay):
        return {group.near}, {group.like}
    return {*group.points}, {other(k, group.body) for k in group.slides}


__all__ = [
    "EitherWay",
    "Fold",
    "Group",
    "Hold",
    "Meet",
    "OnCircle",
    "OnLine",
    "Place",
    "SlidingOrder",
    "Swing",
    "groups_for",
    "holder",
    "sliding_freedoms",
    "sliding_order",
]
