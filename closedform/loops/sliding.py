"""A planar linkage in which bodies also slide on each other: shapers, presses, scissor lifts.

It is solved group by group, as :mod:`closedform.mechanics.assur_slides` orders it.  Bodies that
slide on each other have parallel coordinates.  So what is known of a body is a :class:`Frame`: one
of its points, and a vector that turns with it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import vector
from closedform.loops.hand import square
from closedform.loops.linkage import GROUND, Body
from closedform.mechanics.assur import degrees
from closedform.mechanics.assur_slides import (
    Fold,
    Group,
    Meet,
    SlidingOrder,
    Swing,
    groups_for,
    holder,
    sliding_freedoms,
    sliding_order,
)
from closedform.mechanics.lengths import lengths_in_numbers
from closedform.model.derivation import Derivation
from closedform.model.functions import real


@dataclass(frozen=True)
class Sliding:
    """Two bodies that slide on each other along a unit vector; their coordinates are parallel.

    When the slide is at zero, the points of the second body are at their coordinates plus
    ``offset``, in the coordinates of the first.  A slide on the ground may have a ``joint``, which
    is driven or is the task.  ``slide`` is the passive joint of another slide, which is drawn.
    """

    between: tuple[str, str]
    along: Sequence[Any]
    offset: Sequence[Any] = (0, 0)
    joint: sp.Symbol | None = None
    slide: sp.Symbol | None = None

    @property
    def way(self) -> sp.Matrix:
        return vector(self.along)

    def other(self, body: str) -> str:
        return self.between[1 - self.between.index(body)]

    def shift(self, body: str) -> sp.Matrix:
        """What brings the coordinates of a body to those of the other one."""
        return vector(self.offset) * (1 if body == self.between[1] else -1)


@dataclass(frozen=True)
class Frame:
    """Where a body is: one point, and a vector of it, in its coordinates and in those of the base.

    ``still`` vanishes; the squares of all lengths of the body are larger by this share of them.
    """

    start: sp.Matrix
    local: sp.Matrix
    arm: sp.Matrix
    span: sp.Matrix
    still: sp.Expr = sp.S.Zero

    def vector(self, v: sp.Matrix) -> sp.Matrix:
        """A vector of the body, as the base sees it."""
        size = sp.factor(sp.expand(square(self.span)))
        u, w = self.span.dot(v), self.span[0] * v[1] - self.span[1] * v[0]
        a, b = (sp.factor(sp.expand(e)) / size for e in (u, w))
        return sp.Matrix([[a, -b], [b, a]]) * self.arm

    def at(self, point: sp.Matrix) -> sp.Matrix:
        if point == self.local:
            return self.start
        return self.start + self.vector(point - self.local)

    def seen(self, place: sp.Matrix) -> sp.Matrix:
        """The coordinates that a place has on the body."""
        back = Frame(self.local, self.start, self.span, self.arm)
        return back.at(place)

    def carried(self, part: Frame) -> Frame:
        """Where a part is that is known in the coordinates of this body."""
        still = (1 + self.still) * (1 + part.still) - 1
        return Frame(self.at(part.start), part.local, self.vector(part.arm), part.span, still)


@dataclass(frozen=True)
class SlidingLinkage:
    """The bodies of a linkage and its slides; the hand is a point, or the joint of a body."""

    d: Derivation
    hand: sp.Matrix
    bodies: Mapping[str, Body]
    slides: Sequence[Sliding]
    hand_at: str = ""

    def __post_init__(self) -> None:
        name = self.d.name
        if GROUND not in self.bodies:
            raise ShapeError(f"{name}: one of the bodies must be called {GROUND}")
        for slide in self.slides:
            if missing := [b for b in slide.between if b not in self.bodies]:
                raise ShapeError(f"{name}: there is no body {missing[0]}")
            task = slide.joint is not None and slide.joint not in self.d.actuated
            if task and slide.between[0] != GROUND:
                raise ShapeError(f"{name}: {slide.joint} must slide on the {GROUND}")
        joints = [*self.turning.values(), *self.sliders.values(), *self.cylinders.values()]
        joints += self.glides.values()
        if {*joints} - {self.follower_joint} != {*self.d.actuated}:
            raise ShapeError(f"{name}: each driven joint must belong to a body")
        if self.freedoms != len(self.d.actuated):
            raise ShapeError(
                f"{name}: {len(self.d.actuated)} joints are driven, but by the count of its "
                f"bodies, pins and slides the linkage has {degrees(self.freedoms)}"
            )
        if held := self.order.held:
            raise ShapeError(f"{name}: {held[0].body} cannot move, or could not if it were longer")
        if self.order.left:
            raise ShapeError(f"{name}: {self.order.undone}")
        used = {b for group in self.groups for b in group.bodies}
        used |= {GROUND, *self.turning, *self.sliders}
        if loose := [b for b in self.bodies if b not in used]:
            do, them = ("do", "them") if len(loose) > 1 else ("does", "it")
            raise ShapeError(f"{name}: {', '.join(loose)} {do} not move the hand; leave {them} out")

    @cached_property
    def points(self) -> dict[str, tuple[str, ...]]:
        return {name: tuple(body.points) for name, body in self.bodies.items()}

    @cached_property
    def pairs(self) -> list[tuple[str, str]]:
        return [slide.between for slide in self.slides]

    @cached_property
    def turning(self) -> dict[str, sp.Symbol]:
        """The bodies with a joint that turns about the ground."""
        return {name: b.joint for name, b in self.bodies.items() if b.joint is not None}

    @cached_property
    def sliders(self) -> dict[str, sp.Symbol]:
        """The bodies with a joint that slides on the ground."""
        on_ground = [s for s in self.slides if s.between[0] == GROUND]
        return {s.between[1]: s.joint for s in on_ground if s.joint is not None}

    @cached_property
    def glides(self) -> dict[int, sp.Symbol]:
        """The driven slides between moving bodies, by their numbers."""
        moving = [(k, s) for k, s in enumerate(self.slides) if s.between[0] != GROUND]
        return {k: s.joint for k, s in moving if s.joint is not None}

    @cached_property
    def cylinders(self) -> dict[str, sp.Symbol]:
        """The bodies whose length is a driven joint."""
        found: dict[str, sp.Symbol] = {}
        for name, body in self.bodies.items():
            entries = [sp.sympify(e, strict=True) for at in body.points.values() for e in at]
            for q in self.d.actuated:
                if any(e.has(q) for e in entries):
                    found[name] = q
        return found

    @property
    def follower_joint(self) -> sp.Symbol | None:
        return None if self.hand_at else self.hand[0]

    @cached_property
    def follower(self) -> str:
        """The body whose joint is the task; empty if the hand is a point."""
        both = [*self.turning.items(), *self.sliders.items()]
        return next((b for b, q in both if q == self.follower_joint), "")

    @cached_property
    def driven(self) -> dict[str, sp.Symbol]:
        """The bodies with a driven joint, but for cylinders."""
        both = [*self.turning.items(), *self.sliders.items()]
        return {b: q for b, q in both if b != self.follower}

    @property
    def freedoms(self) -> int:
        return sliding_freedoms(self.points, self.pairs) + len(self.cylinders)

    @cached_property
    def order(self) -> SlidingOrder:
        known = [GROUND, *self.driven]
        return sliding_order(
            self.points, self.pairs, known, bars=self.cylinders, driven=self.glides
        )

    @cached_property
    def groups(self) -> list[Group]:
        """The groups that move the hand, in their order."""
        groups, last = self.order.groups, self.follower
        last = last or holder(groups, self.points, [GROUND, *self.driven], self.hand_at)
        if not last:
            raise ShapeError(f"{self.d.name}: the hand is on no body that the joints move")
        return groups_for(groups, self.points, self.pairs, last)

    @cached_property
    def folded(self) -> dict[str, str]:
        """The bodies that are parts of another one, with this."""
        return {b: g.on for g in self.groups if isinstance(g, Fold) for b in g.bodies}

    @property
    def direct(self) -> bool:
        """Whether the hand is the pin of the last group."""
        last = self.groups[-1]
        return isinstance(last, Meet) and last.pin == self.hand_at

    def local(self, body: str, point: str) -> sp.Matrix:
        return vector(self.bodies[body].points[point])

    def length(self, body: str, near: str, far: str) -> sp.Expr:
        if body in self.cylinders:
            return self.cylinders[body]
        between = square(self.local(body, far) - self.local(body, near))
        return sp.sqrt(sp.factor(sp.expand(between)))

    def pivot(self, body: str) -> str:
        """The point about which a body with a joint turns."""
        shared = [p for p in self.points[body] if p in self.points[GROUND]]
        if len(shared) != 1:
            raise ShapeError(f"{self.d.name}: {body} must have one point in common with the ground")
        if any(self.local(GROUND, shared[0]) - self.local(body, shared[0])):
            raise ShapeError(
                f"{self.d.name}: {shared[0]} has different coordinates on the ground and on {body}"
            )
        return shared[0]

    def slide_of(self, body: str) -> Sliding:
        """The slide of a body with a joint."""
        on_ground = (s for s in self.slides if s.between[0] == GROUND)
        return next(s for s in on_ground if s.joint is not None and s.between[1] == body)

    def moved(self, body: str) -> Frame:
        """Where a body with a joint is, or the ground."""
        zero, right = sp.zeros(2, 1), sp.Matrix([1, 0])
        if body == GROUND:
            return Frame(zero, zero, right, right)
        if body in self.turning:
            q, at = self.turning[body], self.local(GROUND, self.pivot(body))
            return Frame(at, at, sp.Matrix([sp.cos(q), sp.sin(q)]), right)
        slide, q = self.slide_of(body), self.sliders[body]
        return Frame(vector(slide.offset) + q * slide.way, zero, right, right)

    def unknown(self, name: str) -> sp.Matrix:
        """The symbols of the coordinates of a point, or of a direction."""
        if self.direct and name == self.hand_at:
            return self.hand
        taken = {p.name for p in self.d.parameters} | {j.name for j in self.d.joints}
        taken |= {s.name for s in self.hand}
        stem = name
        while {f"{stem}_x", f"{stem}_y"} & taken:
            stem += "_0"
        return sp.Matrix([real(f"{stem}_{axis}") for axis in "xy"])

    @cached_property
    def size(self) -> sp.Expr:
        """The sum of all lengths, without those of joints."""
        lengths = [p for p in self.d.parameters if p.unit != "rad"]
        sized = [p.symbol if p.nonnegative else sp.Abs(p.symbol) for p in lengths]
        numbers = [
            max(lengths_in_numbers(sp.sympify(e, strict=True)) for at in places for e in at)
            for name, body in self.bodies.items()
            if name not in self.cylinders and (places := body.points.values())
        ]
        return sp.Add(*sized, *numbers)

    @property
    def moving(self) -> list[sp.Symbol]:
        """The driven joints that are lengths."""
        q = {*self.sliders.values(), *self.cylinders.values(), *self.glides.values()}
        return [joint for joint in self.d.actuated if joint in q]


def swing_name(group: Swing) -> str:
    """The name of the direction of two bodies that slide on each other."""
    return f"t_{group.bodies[0]}"


def fold_name(group: Fold) -> str:
    """The name of the common pin of two bodies, in the coordinates of a third one."""
    return f"{group.far}_on_{group.on}"


__all__ = ["Frame", "Sliding", "SlidingLinkage", "fold_name", "swing_name"]
