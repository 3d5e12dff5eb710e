"""A planar linkage that is solved dyad by dyad: six-bar linkages, straight-line linkages, legs.

Its bodies are pinned to each other.  The driven ones turn about the ground, or are cylinders, whose
length is the joint.  Two bodies with a common pin, each of which has one more point that is known,
are a dyad: two circles meet in the pin.  Then all points of both bodies are known, and the next
dyad follows.  So each dyad has two assembly modes.

A point of a body is seen from another one of its points as a third one is, turned and stretched by
constants.  If the hand is on a body of the last dyad, the same turn and stretch take the circles of
the pin to those of the hand, as in :mod:`closedform.loops.on_rod`.  Three driven joints move the
hand and turn its body as well; then the last pin gives the pose.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, rotated, turned_left, vector
from closedform.loops.hand import square
from closedform.mechanics.assur import Dyad, Order, degrees, freedoms, needed_for, order
from closedform.mechanics.lengths import lengths_in_numbers
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, choose, real
from closedform.model.pair import Pair

GROUND = "ground"
POSE = 3
"""The number of coordinates of a hand that turns: x, y and yaw."""


@dataclass(frozen=True)
class Body:
    """A body of a planar linkage: its named points, and the joint by which it turns.

    Bodies that have a point of the same name are pinned together there.  The points of the ground,
    and of a body with a joint, are where they are when the joint is zero; of any other body only
    the distances of its points count, and on which side they are.  A cylinder is a body of two
    points at a distance that is a driven joint.
    """

    points: Mapping[str, Sequence[Any]]
    joint: sp.Symbol | None = None


@dataclass(frozen=True)
class Solved:
    """A dyad as it is solved: for the pin, or for the point of its first body that is the hand."""

    dyad: Dyad
    goal: str
    unknowns: sp.Matrix
    turned: sp.Matrix
    """The turn and stretch that takes the pin to the goal, as seen from the first near point."""

    @property
    def near(self) -> tuple[str, str]:
        return self.dyad.near

    @property
    def pin(self) -> str:
        return self.dyad.pin


@dataclass(frozen=True)
class Linkage:
    """The bodies of a linkage, and its hand.

    The hand is a point, a point and the yaw of its body, or the joint of a body that is not driven.
    """

    d: Derivation
    hand: sp.Matrix
    bodies: Mapping[str, Body]
    at: str = ""
    names: dict[str, sp.Matrix] = field(default_factory=dict)
    divisors: dict[sp.Expr, tuple[str, str, str]] = field(default_factory=dict)
    """The squared distances by which a vector is divided: of a body, and of two of its points."""

    def __post_init__(self) -> None:
        name = self.d.name
        if GROUND not in self.bodies:
            raise ShapeError(f"{name}: one of the bodies must be called {GROUND}")
        for body, parts in self.bodies.items():
            if any(len(at) != 2 for at in parts.points.values()):
                raise ShapeError(f"{name}: {body} needs points with two coordinates")
        if {b.joint for b in self.driven.values()} | set(self.cylinders.values()) != {
            *self.d.actuated
        }:
            raise ShapeError(f"{name}: each driven joint must belong to a body")
        if self.posed and len(self.d.actuated) != POSE:
            raise ShapeError(
                f"{name}: a hand with x, y and yaw needs {POSE} driven joints, and there are "
                f"{len(self.d.actuated)}"
            )
        free = freedoms(self.points)
        if free != len(self.driven):
            raise ShapeError(
                f"{name}: {len(self.d.actuated)} joints are driven, but by the count of its bodies "
                f"and pins the linkage has {degrees(free + len(self.cylinders))}"
            )
        if held := self.order.held:
            raise ShapeError(
                f"{name}: {held[0].body} cannot move, because the driven joints and "
                f"the bodies before "
                f"it place two of its points"
            )
        if self.order.left:
            raise ShapeError(f"{name}: {self.order.undone}")
        used = {dyad.pin for dyad in self.dyads}
        loose = [b for dyad in self.order.dyads if dyad.pin not in used for b in dyad.bodies]
        if loose:
            raise ShapeError(f"{name}: {', '.join(loose)} do not move the hand; leave them out")

    @cached_property
    def points(self) -> dict[str, tuple[str, ...]]:
        return {name: tuple(body.points) for name, body in self.bodies.items()}

    @cached_property
    def driven(self) -> dict[str, Body]:
        """The bodies with a driven joint, in the order of the joints."""
        on = {body.joint: (name, body) for name, body in self.bodies.items() if body.joint}
        return dict(on[q] for q in self.d.actuated if q in on)

    @cached_property
    def cylinders(self) -> dict[str, sp.Symbol]:
        """The bodies whose length is a driven joint, with this joint."""
        found = {}
        for name, body in self.bodies.items():
            entries = [sp.sympify(e, strict=True) for at in body.points.values() for e in at]
            for q in self.d.actuated:
                if any(e.has(q) for e in entries):
                    found[name] = q
                    if len(body.points) != 2:
                        raise ShapeError(f"{self.d.name}: the cylinder {name} needs two points")
        return found

    @cached_property
    def follower(self) -> str:
        """The body whose joint is the task; empty if the hand is a point."""
        found = [n for n, b in self.bodies.items() if b.joint is not None and n not in self.driven]
        return found[0] if found else ""

    @property
    def posed(self) -> bool:
        """Whether the hand turns too: its yaw is that of the only body that has its point."""
        return len(self.hand) == POSE

    @cached_property
    def carrier(self) -> str:
        """The body whose pose is the task; empty if the hand does not turn."""
        if not self.posed:
            return ""
        found = [name for name, at in self.points.items() if self.at in at]
        if len(found) != 1:
            raise ShapeError(
                f"{self.d.name}: the hand {self.at} must be a point of one body, whose yaw is the "
                f"task too"
            )
        return found[0]

    @property
    def known(self) -> list[str]:
        """The bodies that are known if the hand is."""
        return [GROUND, *[name for name in (self.follower, self.carrier) if name]]

    @cached_property
    def order(self) -> Order:
        return order(self.points, [GROUND, *self.driven])

    @cached_property
    def dyads(self) -> list[Dyad]:
        """The dyads that move the hand; it is on the first body of the last one."""
        dyads, bodies = self.order.dyads, self.points
        for dyad in dyads:
            for body in dyad.bodies:
                if body in self.known or (self.at in bodies[body] and self.at not in dyad.near):
                    kept = needed_for(dyads, bodies, dyad)
                    return [*kept[:-1], dyad if dyad.bodies[0] == body else swapped(dyad)]
        raise ShapeError(f"{self.d.name}: the hand is on no body that the dyads move")

    @cached_property
    def solved(self) -> list[Solved]:
        """Each dyad with the point that it is solved for; the last may have a joint instead."""
        found = []
        for dyad in self.dyads:
            last = dyad is self.dyads[-1] and bool(self.at) and not self.posed
            goal = self.at if last else dyad.pin
            point = self.hand if last else self.unknown(goal)
            turned = self.turn(dyad.bodies[0], dyad.near[0], dyad.pin, goal)
            found.append(Solved(dyad, goal, point, turned))
        return found

    @property
    def circles(self) -> list[Solved]:
        """The dyads that are solved for a point."""
        return self.solved[:-1] if self.follower else self.solved

    def unknown(self, point: str) -> sp.Matrix:
        """The symbols of the coordinates of a point."""
        if point not in self.names:
            taken = {p.name for p in self.d.parameters} | {j.name for j in self.d.joints}
            taken |= {s.name for s in self.hand}
            stem = point
            while {f"{stem}_x", f"{stem}_y"} & taken:
                stem += "_0"
            self.names[point] = sp.Matrix([real(f"{stem}_{axis}") for axis in "xy"])
        return self.names[point]

    def span(self, body: str, start: str, end: str) -> sp.Matrix:
        at = self.bodies[body].points
        return vector(at[end]) - vector(at[start])

    def squared(self, body: str, start: str, end: str) -> sp.Expr:
        return sp.factor(sp.expand(square(self.span(body, start, end))))

    def length(self, body: str, start: str, end: str) -> sp.Expr:
        if body in self.cylinders:
            return self.cylinders[body]
        return sp.sqrt(self.squared(body, start, end))

    def axes(self, body: str, start: str, end: str) -> tuple[sp.Matrix, sp.Matrix]:
        """The direction from a point of a body to another one, and that to its left."""
        along = self.span(body, start, end) / self.length(body, start, end)
        along = along.applyfunc(sp.simplify)
        return along, turned_left(along)

    def turn(self, body: str, start: str, seen: str, end: str) -> sp.Matrix:
        """The turn and stretch that takes a point of a body to another, as seen from a third."""
        if seen == end:
            return sp.eye(2)
        a, b = self.span(body, start, seen), self.span(body, start, end)
        size = self.squared(body, start, seen)
        if size == 0:
            raise ShapeError(f"{self.d.name}: {start} and {seen} are at the same place of {body}")
        self.divisors.setdefault(size, (body, start, seen))
        u, v = (sp.factor(sp.expand(e)) for e in (a.dot(b), a[0] * b[1] - a[1] * b[0]))
        return sp.Matrix([[u, -v], [v, u]]) / size

    def require_apart(self, p: Program) -> list[str]:
        """Refuse dimensions with which points of a body coincide that have to give its direction.

        Only differences of lengths are checked, since a length of its own is not zero.
        """
        positive = {e.symbol: sp.Dummy(positive=True) for e in self.d.parameters}
        notes = []
        for square_, (body, start, seen) in self.divisors.items():
            if square_.xreplace(positive).is_positive:
                continue
            apart = f"{start} and {seen} are at different places of {body}"
            same = p.vanishes(
                f"same_{start}_{seen}",
                square_,
                self.size**2,
                f"{start} and {seen} coincide",
                squares=True,
            )
            p.require([choose(same, 1, 0)], 1, apart)
            notes.append(f"INVALID: also unless {apart}.")
        return notes

    def pivot(self, body: str) -> str:
        """The point about which a body with a joint turns."""
        shared = [p for p in self.points[body] if p in self.points[GROUND]]
        if len(shared) != 1:
            raise ShapeError(f"{self.d.name}: {body} must have one point in common with the ground")
        if any(self.ground(shared[0]) - vector(self.bodies[body].points[shared[0]])):
            raise ShapeError(
                f"{self.d.name}: {shared[0]} has different coordinates on the ground and on {body}"
            )
        return shared[0]

    def ground(self, point: str) -> sp.Matrix:
        return vector(self.bodies[GROUND].points[point])

    def crank(self, body: str, end: str, rod: Any = 0) -> Crank:
        """A body with a joint as a crank from its pivot to one of its points."""
        joint, pivot = self.bodies[body].joint, self.pivot(body)
        length, (along, across) = self.length(body, pivot, end), self.axes(body, pivot, end)
        assert joint is not None
        return Crank(
            joint,
            length,
            rod,
            pivot=tuple(self.ground(pivot)),
            along=tuple(along),
            across=tuple(across),
        )

    def on_turning(self, body: str, point: str) -> sp.Matrix:
        """Where a point of a body is whose joint or pose is known."""
        if body == self.carrier:
            span = self.span(body, self.at, point)
            return self.hand[:2, :] + rotated(span, Pair.of(self.hand[2]))
        if point == self.pivot(body):
            return self.ground(point)
        return self.crank(body, point).end()

    @cached_property
    def size(self) -> sp.Expr:
        """The sum of all lengths, without those of cylinders."""
        lengths = [p for p in self.d.parameters if p.unit != "rad"]
        sized = [p.symbol if p.nonnegative else sp.Abs(p.symbol) for p in lengths]
        numbers = [
            max(
                lengths_in_numbers(sp.sympify(e, strict=True))
                for at in body.points.values()
                for e in at
            )
            for name, body in self.bodies.items()
            if name not in self.cylinders
        ]
        return sp.Add(*sized, *numbers)

    @cached_property
    def posture(self) -> dict[str, sp.Matrix]:
        """All points, in the joints and in the symbols of the points that are solved for."""
        at = {p: self.ground(p) for p in self.points[GROUND]}
        for body in self.driven:
            at |= {p: self.on_turning(body, p) for p in self.points[body]}
        for step in self.circles:
            at[step.goal] = step.unknowns
            self.carry(step, at)
        if self.follower:
            last = self.solved[-1].dyad
            at |= {p: self.on_turning(self.follower, p) for p in self.points[self.follower]}
            self.carry_body(last.bodies[1], last.near[1], last.pin, at)
        return at

    def carry(self, step: Solved, at: dict[str, sp.Matrix]) -> None:
        """Add the points of both bodies of a dyad to those that are known."""
        (first, second), (near, other) = step.dyad.bodies, step.near
        if step.pin not in at:
            at[step.pin] = self.point_on(first, (near, step.goal, step.pin), at)
        self.carry_body(first, near, step.goal, at)
        self.carry_body(second, other, step.pin, at)

    def carry_body(self, body: str, near: str, far: str, at: dict[str, sp.Matrix]) -> None:
        for point in self.points[body]:
            if point not in at:
                at[point] = self.point_on(body, (near, far, point), at)

    def point_on(
        self, body: str, three: tuple[str, str, str], at: Mapping[str, sp.Matrix]
    ) -> sp.Matrix:
        """The third point of a body, from the first two."""
        near, far, point = three
        return at[near] + self.turn(body, near, far, point) * (at[far] - at[near])

    def centres(self, step: Solved, at: Mapping[str, sp.Matrix]) -> tuple[sp.Matrix, sp.Matrix]:
        """The centres of the circles in which the goal is."""
        first, second = (at[p] for p in step.near)
        return first, first + step.turned * (second - first)

    def radii(self, step: Solved) -> tuple[sp.Expr, sp.Expr]:
        a, b = step.dyad.bodies
        return (
            self.length(a, step.near[0], step.goal),
            self.length(b, step.near[1], step.pin) * self.stretch(step),
        )

    def stretch(self, step: Solved) -> sp.Expr:
        """By how much the goal is farther from the first near point than the pin is."""
        body, near = step.dyad.bodies[0], step.near[0]
        return self.length(body, near, step.goal) / self.length(body, near, step.pin)

    @cached_property
    def loop(self) -> list[sp.Expr]:
        """The equations of all dyads: the distance of each goal from its centres."""
        at, found = self.posture, []
        for step in self.circles:
            for centre, radius in zip(self.centres(step, at), self.radii(step), strict=True):
                found.append(square(step.unknowns - centre) - radius**2)
        if self.follower:
            last = self.solved[-1].dyad
            rod = self.length(last.bodies[1], last.near[1], last.pin)
            found.append(square(at[last.pin] - at[last.near[1]]) - rod**2)
        return found

    @cached_property
    def variables(self) -> tuple[sp.Symbol, ...]:
        """The coordinates of the goals, in the order of the dyads; the task is last.

        If the hand turns, it follows from the last pin, and is not among them.
        """
        inner = [e for step in self.inner for e in step.unknowns]
        return (*inner, *self.hand) if not self.posed else (*inner,)

    @property
    def inner(self) -> list[Solved]:
        """The dyads whose goal is not the hand."""
        return self.solved if self.posed else self.solved[:-1]


def swapped(dyad: Dyad) -> Dyad:
    return Dyad(dyad.pin, (dyad.bodies[1], dyad.bodies[0]), (dyad.near[1], dyad.near[0]))


__all__ = ["GROUND", "POSE", "Body", "Linkage", "Solved"]
