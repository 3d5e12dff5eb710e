"""The order in which a planar linkage of pinned bodies is solved: one dyad after the other.

A dyad is two bodies with a pin in common, each of which has one more point that is known.  The pin
is where two circles meet, and with it all points of both bodies are known.  Such groups are of
class II in Assur's order; others lead to equations of a degree above four.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import combinations, permutations


@dataclass(frozen=True)
class Dyad:
    """Two bodies and their common ``pin``; the points in ``near`` are known before."""

    pin: str
    bodies: tuple[str, str]
    near: tuple[str, str]

    @property
    def pins(self) -> tuple[str, str]:
        """The pins of both bodies, which are the same."""
        return self.pin, self.pin


@dataclass(frozen=True)
class Held:
    """A body of which two points are known, or more: their distances have to be right."""

    body: str
    points: tuple[str, ...]
    implied: bool = False
    """Whether their distances are right because two bars of a parallelogram are alike."""


@dataclass(frozen=True)
class Parallel:
    """A body that parallelograms keep parallel to the ground; ``near`` is its known point.

    ``bars`` are the two bars of each parallelogram, from the ground to the body.
    """

    body: str
    near: str
    bars: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Shifted:
    """A dyad whose ``pin`` is on a body that is not turned, and carries the end of the first bar.

    The first one of the ``bodies`` is pinned to the body ``on`` at ``far``, the second one at
    ``pin``, and the points in ``near`` are known before.  So the first one holds the pin as if both
    its ends were moved from ``far`` to ``pin``.
    """

    pin: str
    bodies: tuple[str, str]
    near: tuple[str, str]
    on: str
    far: str

    @property
    def pins(self) -> tuple[str, str]:
        """The pins of both bodies, at different points of the body that is not turned."""
        return self.far, self.pin


@dataclass
class Order:
    """The steps in which the bodies become known, and the bodies that are left."""

    steps: list[Dyad | Held | Parallel | Shifted] = field(default_factory=list)
    left: list[str] = field(default_factory=list)

    @property
    def dyads(self) -> list[Dyad]:
        return [s for s in self.steps if isinstance(s, Dyad)]

    @property
    def held(self) -> list[Held]:
        return [s for s in self.steps if isinstance(s, Held) and not s.implied]

    @property
    def parallel(self) -> list[Parallel]:
        return [s for s in self.steps if isinstance(s, Parallel)]

    @property
    def pairs(self) -> list[Dyad | Shifted]:
        """The steps in which two bodies meet in a pin."""
        return [s for s in self.steps if isinstance(s, Dyad | Shifted)]

    @property
    def undone(self) -> str:
        """Why the bodies that are left are not solved."""
        left, four = ", ".join(self.left), len(self.left) == 4
        if len(self.left) == 1:
            return f"{left} can still move"
        group = "class III, which leads to an equation of degree 6" if four else "a class above II"
        return f"no two of the bodies {left} are a dyad; they are a group of {group}"


def order(
    bodies: Mapping[str, Iterable[str]],
    known: Iterable[str],
    points: Iterable[str] = (),
    *,
    sought: Iterable[str] = (),
    parallel: Iterable[Parallel] = (),
) -> Order:
    """The order for bodies with named points, of which some are ``known``.

    Bodies that have a point of the same name are pinned together there.  ``points`` are known
    besides those of the known bodies.  Dyads with the ``sought`` bodies come as early as they can.
    Bodies that are ``parallel`` to the ground are known by one point.
    """
    on = {name: tuple(dict.fromkeys(at)) for name, at in bodies.items()}
    there = {p for name in known for p in on[name]} | set(points)
    found = Order(left=[name for name in on if name not in set(known)])
    even = {p.body: p for p in parallel}
    while (
        step := _beside(on, found, there, even)
        or _next(on, found.left, there, {*sought})
        or _shifted(on, found.left, there, even, {*sought})
    ):
        solved = step.bodies if isinstance(step, Dyad | Shifted) else (step.body,)
        found.steps.append(step)
        found.left = [name for name in found.left if name not in solved]
        there |= {p for name in solved for p in on[name]}
    return found


def _beside(
    on: Mapping[str, Sequence[str]], found: Order, there: set[str], even: Mapping[str, Parallel]
) -> Parallel | Held | None:
    """A body that is parallel to the ground, or a bar that only repeats what another one says."""
    for name in found.left:
        near = tuple(p for p in on[name] if p in there)
        if near and name in even:
            return Parallel(name, near[0], even[name].bars)
        if len(near) > 1 and _repeats(name, found):
            return Held(name, near, implied=True)
    return None


def _repeats(bar: str, found: Order) -> bool:
    """Whether the other bar of a parallelogram that was used is known already."""
    pairs = {pair for step in found.parallel for pair in step.bars if bar in pair}
    return any(not ({*pair} - {bar}) & {*found.left} for pair in pairs)


def _next(
    on: Mapping[str, Sequence[str]], left: Sequence[str], there: set[str], sought: set[str]
) -> Dyad | Held | None:
    near = {name: tuple(p for p in on[name] if p in there) for name in left}
    for name in left:
        if len(near[name]) > 1:
            return Held(name, near[name])
    dyads = [
        Dyad(p, (a, b), (near[a][0], near[b][0]))
        for a, b in combinations([name for name in left if near[name]], 2)
        for p in on[a]
        if p in on[b] and p not in there
    ]
    return min(dyads, key=lambda dyad: not sought & {*dyad.bodies}, default=None)


def _shifted(
    on: Mapping[str, Sequence[str]],
    left: Sequence[str],
    there: set[str],
    even: Mapping[str, Parallel],
    sought: set[str],
) -> Shifted | None:
    """Two bodies with known points that are pinned to a body which is not turned."""
    near = {name: [p for p in on[name] if p in there] for name in left}
    pins = {
        name: [(b, p) for b in left for p in on[b] if b != name and near[b] and p in on[name]]
        for name in left
        if name in even
    }
    bars = {name: {bar for pair in even[name].bars for bar in pair} for name in pins}
    found = [
        Shifted(pin, (a, b), (near[a][0], near[b][0]), name, far)
        for name in pins
        for (a, far), (b, pin) in permutations(pins[name], 2)
        if a in bars[name] and b not in bars[name] and pin != far
    ]
    return min(found, key=lambda step: step.bodies[0] not in sought, default=None)


def needed_for(
    steps: Sequence[Dyad], bodies: Mapping[str, Iterable[str]], last: Dyad
) -> list[Dyad]:
    """The dyads that ``last`` depends on, in their order, and this one."""
    wanted, kept = set(last.near), [last]
    for dyad in reversed(steps[: steps.index(last)]):
        if wanted & {p for name in dyad.bodies for p in bodies[name]} - set(dyad.near):
            wanted |= set(dyad.near)
            kept.insert(0, dyad)
    return kept


def freedoms(bodies: Mapping[str, Iterable[str]]) -> int:
    """The number of joints that have to be driven, by the count of bodies and pins."""
    holders: dict[str, int] = {}
    for at in bodies.values():
        for p in dict.fromkeys(at):
            holders[p] = holders.get(p, 0) + 1
    return 3 * (len(bodies) - 1) - 2 * sum(n - 1 for n in holders.values())


def degrees(free: int) -> str:
    """A number of degrees of freedom, in words."""
    return f"{free} degree{'s' * (free != 1)} of freedom"


__all__ = [
    "Dyad",
    "Held",
    "Order",
    "Parallel",
    "Shifted",
    "degrees",
    "freedoms",
    "needed_for",
    "order",
]
