"""Legs that revolute joints keep in planes, and a hand that they rule without a passive leg.

A revolute joint at one end of a leg, with a ball joint at the other, keeps the leg in a plane: that
of the ground or that of the hand.  A universal joint on the ground and a revolute joint on the hand
do even more: the hand stays in a plane that turns about an axis of the ground.  If the hand is
turned in a given way, all these conditions are linear in its position.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, Stretch, vector
from closedform.loops.guides import TURNS, Placed, Turning, arms_at
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import named, named_in
from closedform.mechanics.frames import rotation
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Link

ALONG, DISTANCE = real("along"), real("distance")
TILTED = tuple(map(real, ("z", "tilt_x", "tilt_y", "twist")))


@dataclass(frozen=True)
class Hinged:
    """A leg that a revolute joint keeps in a plane; the other end has a ball joint.

    Either the joint is at the near end of the rod, with the axis ``on_ground``, or it is on the
    hand, with the axis ``on_hand`` in the frame of the hand; both are unit vectors in numbers.  In
    the plane of a :class:`TurningPlane` the leg has a universal joint instead of the ball joint.
    """

    leg: Leg
    on_ground: Sequence[Any] = ()
    on_hand: Sequence[Any] = ()

    @property
    def axis(self) -> sp.Matrix:
        return vector(self.on_ground or self.on_hand)

    def check(self, name: str) -> None:
        """Refuse a leg that leaves its plane."""
        if bool(self.on_ground) == bool(self.on_hand):
            raise ShapeError(f"{name}: a Hinged leg has one axis, on_ground or on_hand")
        if sp.simplify(square(self.axis) - 1) != 0:
            raise ShapeError(f"{name}: the axis of a Hinged leg must be a unit vector, in numbers")
        if self.on_ground and sp.simplify(self.axis.dot(self.leg.rate)) != 0:
            raise ShapeError(
                f"{name}: {self.leg.joint} moves the leg out of the plane in which its hinge is"
            )


@dataclass(frozen=True)
class Frame:
    """What a target says of a hand whose hinges do not count yet, in the names of a program."""

    rotation: sp.Matrix
    axes: tuple[sp.Matrix, ...]
    """About which each coordinate of the target turns the hand; zero if it does not turn it."""
    shift: sp.Matrix
    """From the pivot to the point of the hand, where the coordinates that hinges fix are zero."""
    moves: tuple[sp.Matrix, ...]
    """How each coordinate of the target moves the point, while the fixed ones stand still."""
    fixed: tuple[sp.Expr, ...] = ()
    """What vanishes where the hinges do not fix the rotation, without a unit."""
    links: tuple[Link, ...] = ()
    """How a turn that the hinges fix was found."""


@dataclass(frozen=True)
class Hinges(ABC):
    """A hand whose legs are hinged, besides others that are not."""

    pivot: Sequence[Any]
    """The point from which the place of the hand is seen."""
    hinged: tuple[tuple[int, Hinged], ...] = field(default=(), kw_only=True)
    """The hinged legs that fix a coordinate, with their numbers; found from the legs."""

    moved: ClassVar[tuple[sp.Symbol, ...]] = ()
    what: ClassVar[str]
    holds: ClassVar[str] = ""
    follow: ClassVar[str] = "the pose of the hand follows"
    nothing: ClassVar[sp.Expr] = sp.Rational(1, 2**40)
    """The scale below which nothing fixes a coordinate; near there it is large, but exact."""
    fixes: ClassVar[str] = "place"
    """What the hinges fix."""
    divides: ClassVar[str] = "Gamma, which divides what the hinges fix,"
    """What divides the coordinates that the hinges fix."""
    left_out: ClassVar[str] = ""
    """A note on postures that are left out."""
    motion: ClassVar[str] = (
        "A coordinate of the target turns the hand about an axis, or not at all, and moves its "
        "point by w.  So an entry of A is the part of w along r_i, the vector along rod i, and the "
        "moment about the axis of r_i at e_i, which leads from the point of the hand to the end of "
        "rod i"
    )

    @property
    @abstractmethod
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        """All coordinates that the hand has without its hinges."""

    @property
    @abstractmethod
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        """The coordinates that the hinges fix, with the directions in which they move the hand."""

    @abstractmethod
    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        """The rotation of the hand and what moves it, in the names of a program.

        If it is ``guarded``, a turn that the hinges should fix is zero where it is free.
        """

    @abstractmethod
    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> Hinges:
        """The same, with the hinged legs that fix a coordinate."""

    @property
    def target(self) -> tuple[sp.Symbol, ...]:
        return tuple(c for c in self.coordinates if c not in self.solved)

    @property
    def legs(self) -> int:
        return len(self.target)

    @property
    def task(self) -> tuple[str, ...]:
        return tuple(map(str, self.target))

    @property
    def inputs(self) -> dict[str, Any]:
        return {"x": self.target}

    @property
    def turning(self) -> int:
        return len([t for t in self.target if t not in (ALONG, DISTANCE, TILTED[0])])

    @property
    @abstractmethod
    def degree(self) -> int:
        """Of the forward problem in general, counted at random numbers."""

    @property
    def own(self) -> tuple[str, ...]:
        return ("hinges",) * self.loose

    @property
    def too(self) -> str:
        """A sentence on where the hinges do not fix the hand."""
        return f"  It is SINGULAR too if {self.divides} is less than 2^-10."

    @property
    def loose(self) -> bool:
        """Whether there are postures in which the hinges do not fix the coordinates."""
        return any(h.on_hand for _, h in self.hinged)

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand at a target, without names."""
        p = Program()
        return self.place(p, places).explicit(p)

    def place(
        self,
        p: Program,
        places: Sequence[sp.Matrix],
        size: sp.Expr | None = None,
    ) -> Placed:
        """Name the hand at a target in a program; with a ``size`` also where it is not fixed.

        There the coordinates that the hinges should fix are taken as zero.
        """
        return self.placed(p, places, self.frame(p, guarded=size is not None), size)

    def placed(
        self, p: Program, places: Sequence[sp.Matrix], at: Frame, size: sp.Expr | None = None
    ) -> Placed:
        """The same, from what the target says."""
        levers = arms_at(p, at.rotation, sp.zeros(3, 1), places, "e")
        given = at.shift
        ways = list(self.solved.values())
        pulls, rest = [], []
        fixing = self.hinged[: len(ways)]
        for k, h in fixing:
            near = h.leg.base - vector(self.pivot) - given
            if h.on_hand:
                pull = named(p, f"m_{k + 1}", at.rotation * h.axis)
                rest.append(pull.dot(near) - h.axis.dot(places[k]))
            else:
                pull = h.axis
                rest.append(pull.dot(near - levers[k]))
            pulls.append(pull)
        if not self.hinged:
            return Placed(
                at.rotation,
                at.axes,
                given,
                self.ends(p, given, levers),
                moves=at.moves,
                levers=levers,
            )
        M = sp.Matrix([[pull.dot(way) for way in ways] for pull in pulls])
        width = named_in(p, "fixed", self.width(at, M))
        adjugate = M.adjugate()
        found = adjugate * sp.Matrix(rest) / width
        if size is not None and self.loose:
            meaning = "the hinges do not hold the hand"
            free = p.vanishes("loose", sp.Abs(width), self.nothing, meaning)
            found = found.applyfunc(lambda e: choose(free, 0, e))
        u = [named_in(p, f"u_{k}", e) for k, e in enumerate(found, 1)]
        total = given + sum((e * way for e, way in zip(u, ways, strict=True)), sp.zeros(3, 1))
        shift = named(p, "p", total)
        moves: list[sp.Matrix] = []
        for axis, move in zip(at.axes, at.moves, strict=True):
            rates = []
            for (k, h), pull in zip(fixing, pulls, strict=True):
                if h.on_hand:
                    across = axis.cross(pull).dot(vector(self.pivot) + shift - h.leg.base)
                else:
                    across = pull.dot(axis.cross(levers[k]))
                rates.append(across + pull.dot(move))
            follows = -adjugate * sp.Matrix(rates) / width
            number = len(moves) + 1
            names = [named_in(p, f"u_{k}{number}", e) for k, e in enumerate(follows, 1)]
            moves.append(
                move + sum((e * way for e, way in zip(names, ways, strict=True)), sp.zeros(3, 1))
            )
        return Placed(
            rotation=at.rotation,
            turns=at.axes,
            shift=shift,
            arms=self.ends(p, shift, levers),
            moves=tuple(moves),
            levers=levers,
            fixed=(*([width] if self.loose else []), *at.fixed),
            links=at.links,
        )

    def ends(
        self, p: Program, shift: sp.Matrix, levers: Sequence[sp.Matrix]
    ) -> tuple[sp.Matrix, ...]:
        """The ends of the legs, from the pivot; a hinge may keep a coordinate at zero."""
        found = []
        for k, lever in enumerate(levers, 1):
            entries = [
                sp.S.Zero if sp.expand(p.explicit(e)) == 0 else named_in(p, f"f_{k}{i}", e)
                for i, e in enumerate(shift + lever, 1)
            ]
            found.append(sp.Matrix(entries))
        return tuple(found)

    def width(self, at: Frame, M: sp.Matrix) -> sp.Expr:
        """The determinant of the matrix from which the fixed coordinates follow."""
        return sp.factor(M.det())

    def rate(self, value: Any, x: sp.Symbol) -> Any:
        """The derivative of what a posture says with respect to a coordinate of the target."""
        return value.diff(x)


@dataclass(frozen=True)
class InPlane(Hinges):
    """A hand that some of its legs keep in a plane, in which it moves and turns."""

    first: Sequence[Any]
    second: Sequence[Any]
    inside: tuple[int, ...] = field(default=(), kw_only=True)
    """The numbers of the legs in the plane; found from the legs."""

    @property
    def joint(self) -> Turning:
        return Turning(self.pivot, self.first, self.second)

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (ALONG, DISTANCE, *TURNS)


@dataclass(frozen=True)
class TurningPlane(InPlane):
    """A plane that turns about an axis on the ground, in which legs keep the hand.

    Each of these legs has a universal joint on this axis and a revolute joint on the hand, as two
    legs of an Exechon.  The axis ``first`` passes through ``pivot``.  ``second`` is the normal of
    the plane and the direction of the revolute joints, where nothing is turned.  Both are unit
    vectors in numbers, at right angles.  In Python such a leg is ``Hinged(leg, on_hand=second)``.

    With three legs one more is hinged.  The target is the distance of the hand from the axis, in
    the direction ``first x second`` where nothing is turned, the turn of the plane, and the turn of
    the hand in it.  With four legs the place of the hand along the axis comes first.
    """

    aside: sp.Expr = field(default=sp.S.Zero, kw_only=True)
    """How far the legs end beside the point of the hand, along ``second``; found from them."""

    what: ClassVar[str] = "a plane that turns"

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return {ALONG: vector(self.first)} if self.hinged else {}

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> TurningPlane:
        a, b, _ = self.joint.axes
        inside, others, aside = [], [], set()
        for k, h in enumerate(legs):
            if not isinstance(h, Hinged):
                continue
            h.check(name)
            if not h.on_hand or any(h.axis.cross(b)):
                others.append((k, h))
                continue
            off = (h.leg.base - vector(self.pivot)).cross(a)
            if any(map(sp.simplify, [*off, *h.leg.rate.cross(a)])):
                raise ShapeError(f"{name}: a leg in the plane has to begin on its axis")
            inside.append(k)
            aside.add(sp.simplify(vector(h.leg.on_hand or (0, 0, 0)).dot(b)))
        if not inside:
            raise ShapeError(
                f"{name}: no leg keeps the hand in the plane; at least one is Hinged with the "
                f"normal of the plane on_hand"
            )
        if len(aside) > 1:
            raise ShapeError(f"{name}: the legs in the plane have to end in one plane of the hand")
        _check_hinges(name, others, most=1)
        return replace(self, hinged=tuple(others), aside=aside.pop(), inside=tuple(inside))

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        a = vector(self.first)
        R, v, *_ = self.joint.turned(p, {})
        w = named(p, "w", a.cross(v))
        shift = DISTANCE * w - self.aside * v
        none, along = sp.zeros(3, 1), [] if self.hinged else [a]
        return Frame(
            rotation=R,
            axes=(*[none for _ in along], none, a, v),
            shift=shift if self.hinged else shift + ALONG * a,
            moves=(*along, w, a.cross(shift), none),
        )

    @property
    def degree(self) -> int:
        if not self.hinged:
            return 24
        return 16 if self.loose else 12


@dataclass(frozen=True)
class StandingPlane(InPlane):
    """A plane of the ground in which legs keep an axis of the hand.

    Each of these legs has revolute joints whose axes are ``first``, the normal of the plane, and a
    universal joint on the hand, whose axes are ``first`` and ``second``.  So the hand turns about
    ``second``, which stays in the plane through ``pivot``.  Both are unit vectors in numbers, at
    right angles where nothing is turned.  In Python such a leg is ``Hinged(leg,
    on_ground=first)``, and ends on the line of ``second`` through the point of the hand.

    With three legs one more is hinged.  The target is the distance of the hand from the pivot, in
    the direction ``first x second``, the turn in the plane, and the turn about ``second``.  With
    four legs the place of the hand along ``second``, where nothing is turned, comes first.
    """

    what: ClassVar[str] = "a plane that stands still"

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return {ALONG: vector(self.second)} if self.hinged else {}

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> StandingPlane:
        a, b, _ = self.joint.axes
        inside, others = [], []
        for k, h in enumerate(legs):
            if not isinstance(h, Hinged):
                continue
            h.check(name)
            ends_on_axis = not any(vector(h.leg.on_hand or (0, 0, 0)).cross(b))
            if not (h.on_ground and ends_on_axis and not any(h.axis.cross(a))):
                others.append((k, h))
                continue
            if sp.simplify((h.leg.base - vector(self.pivot)).dot(a)) != 0:
                raise ShapeError(f"{name}: the legs in the plane have to begin in it")
            inside.append(k)
        if not inside:
            raise ShapeError(
                f"{name}: no leg keeps the hand in the plane; at least one is Hinged with the "
                f"normal of the plane on_ground, and ends on the axis of the hand"
            )
        _check_hinges(name, others, most=1)
        for _, h in others:
            if h.on_ground and sp.simplify(h.axis.dot(b)) == 0:
                raise ShapeError(
                    f"{name}: the hinge of {h.leg.joint} does not fix the place of the hand along "
                    f"its axis"
                )
        return replace(self, hinged=tuple(others), inside=tuple(inside))

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        a, b, ahead = self.joint.axes
        R, v, *_ = self.joint.turned(p, {})
        none, along = sp.zeros(3, 1), [] if self.hinged else [b]
        shift = DISTANCE * ahead
        return Frame(
            rotation=R,
            axes=(*[none for _ in along], none, a, v),
            shift=shift if self.hinged else shift + ALONG * b,
            moves=(*along, ahead, none, none),
        )

    @property
    def degree(self) -> int:
        if not self.hinged:
            return 24
        return 12 if self.loose else 16


@dataclass(frozen=True)
class TwoHinges(Hinges):
    """Two hinged legs, which fix the place of a hand sideways, besides two others.

    The target is the height z of the hand, its tilts as those of a tripod, and its twist.
    """

    pivot: Sequence[Any] = (0, 0, 0)

    what: ClassVar[str] = "two hinged legs"

    @property
    def degree(self) -> int:
        return 24 if len({bool(h.on_hand) for _, h in self.hinged}) == 2 else 32

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (real("x"), real("y"), *TILTED)

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return dict(zip(self.coordinates[:2], (sp.eye(3).col(0), sp.eye(3).col(1)), strict=True))

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> TwoHinges:
        hinged = [(k, h) for k, h in enumerate(legs) if isinstance(h, Hinged)]
        for _, h in hinged:
            h.check(name)
        _check_hinges(name, hinged, most=2, least=2)
        if not any(h.on_hand for _, h in hinged):
            one, other = (h.axis for _, h in hinged)
            if sp.simplify(one[0] * other[1] - one[1] * other[0]) == 0:
                raise ShapeError(f"{name}: the planes of the hinged legs meet in a horizontal line")
        return replace(self, hinged=tuple(hinged))

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        z, a, b, psi = TILTED
        x, y, up = (sp.eye(3).col(k) for k in range(3))
        tilted = rotation("y", b) * rotation("x", a)
        R = p.matrix("R", tilted * rotation("z", psi))
        none = sp.zeros(3, 1)
        return Frame(
            rotation=R,
            axes=(none, named(p, "a", rotation("y", b) * x), y, R.col(2)),
            shift=sp.Matrix([0, 0, z]),
            moves=(up, none, none, none),
        )


def _check_hinges(
    name: str, hinged: Sequence[tuple[int, Hinged]], *, most: int, least: int = 0
) -> None:
    for _, h in hinged:
        if h.on_hand and not isinstance(h.leg, Stretch):
            raise ShapeError(
                f"{name}: a leg with a hinge on the hand must be a Stretch, so that its ball joint "
                f"stands still"
            )
    if not least <= len(hinged) <= most:
        count = {1: "at most one more leg is", 2: "two legs are"}[most]
        raise ShapeError(f"{name}: {count} Hinged, not {len(hinged)}")


__all__ = ["Hinged", "Hinges", "InPlane", "StandingPlane", "TurningPlane", "TwoHinges"]
