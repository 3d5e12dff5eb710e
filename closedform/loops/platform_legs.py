"""The legs of a hand that turns: which motion they leave it, and where they end on it."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import permutations
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.algebra.solutions import count_solutions
from closedform.lemmas.axial import Across, Along, Axial, FreeAlong
from closedform.lemmas.legs import Leg, Strut, cross_in_plane, vector
from closedform.lemmas.rails import Rail
from closedform.lemmas.turret import Around, OnTurret
from closedform.loops.hand import (
    check_order,
    check_plain,
    rate_of,
    singular_everywhere,
    square,
)
from closedform.loops.leg_by_leg import named, named_in, signs_of_modes
from closedform.loops.modes import Exported
from closedform.mechanics.frames import hat, pose_symbols, rotation
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, real
from closedform.model.inverse import Inverse, Link

LEGS = {2: (3,), 3: (4, 6)}
"""How many legs carry a hand that turns in a plane, and in space."""
UPRIGHT = 4
"""The number of legs of a hand in space that turns about the z axis alone."""
TASKS = {3: ("x", "y", "yaw"), UPRIGHT: ("x", "y", "z", "yaw")}
"""The coordinates of a hand that turns about one axis, by the number of its legs."""


@dataclass(frozen=True)
class Half:
    """A leg that ends on one half of a hand of two bodies, as that of a Par 4 or an H4.

    One bar joins the halves by pins with vertical axes, or two equal, parallel ones.  So the bars
    turn, and the halves keep their direction.  The rod of the ``leg`` is a
    :class:`~closedform.lemmas.parallelogram.Parallelogram`.  Its ``on_hand`` is the pin, in the
    frame of the bars, as seen from the point that is the hand.  ``offset`` leads from there to the
    end of the rod, and does not turn.
    """

    leg: Leg
    offset: Sequence[Any]


@dataclass(frozen=True)
class Platform:
    """A hand that turns, and its legs."""

    d: Derivation
    given: tuple[Leg | Half, ...]
    bars: int = 2
    """How many bars join the halves of a hand, if it has halves."""

    def __post_init__(self) -> None:
        name, n = self.d.name, len(self.legs)
        if n not in LEGS.get(self.dimensions, ()):
            raise ShapeError(
                f"{name}: {n} legs in {self.dimensions} dimensions; a hand that turns has three "
                f"legs in a plane; in space it has six, or four if they keep it upright"
            )
        for leg in self.legs:
            if isinstance(leg, Strut):
                raise ShapeError(f"{name}: a strut cannot carry a hand that turns")
        check_order(self.d, self.legs, axial=self.dimensions == 3 and self.tilts)
        self.check_axial()
        if self.bars not in (1, 2):
            raise ShapeError(f"{name}: one bar joins the halves of a hand, or two")
        if self.halves and n != UPRIGHT:
            raise ShapeError(f"{name}: a hand of two halves has four legs in space")
        if n != UPRIGHT:
            check_plain(self.d, self.legs)
        task = list(TASKS.get(n, map(str, self.pose)))
        if list(self.d.task) not in ([], task):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(task)}")
        self.d.task = task
        if self.spread == 0:
            same = "above each other on" if n == UPRIGHT else "in the same point of"
            raise ShapeError(f"{name}: all legs end {same} the hand; it turns freely")

    def check_axial(self) -> None:
        """Refuse legs along and across axes that are not three pairs."""
        if not self.axial:
            return
        for first, second in zip(self.legs[::2], self.legs[1::2], strict=False):
            same = _off_axis(first, second)
            if same is None:
                raise ShapeError(
                    f"{self.d.name}: legs Along and Across an axis are three pairs, in this order; "
                    f"of a pair, the second leg may be FreeAlong the axis instead.  A leg Around "
                    f"an axis and one OnTurret are a pair too"
                )
            on_hand = vector(first.on_hand or (0, 0, 0)) - vector(second.on_hand or (0, 0, 0))
            if any(map(sp.simplify, [*same, *on_hand])):
                raise ShapeError(
                    f"{self.d.name}: {first.joint} and {second.joint} have to have the same axis "
                    f"and the same point on_hand"
                )

    @property
    def rails(self) -> bool:
        """Whether legs hold points of the hand on rails."""
        return any(isinstance(leg, Rail) for leg in self.legs)

    @property
    def axial(self) -> bool:
        """Whether legs hold points of the hand by axes."""
        return any(isinstance(leg, Axial) for leg in self.legs)

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        return tuple(e.leg if isinstance(e, Half) else e for e in self.given)

    @property
    def halves(self) -> list[Half]:
        return [e for e in self.given if isinstance(e, Half)]

    @property
    def dimensions(self) -> int:
        return len(self.legs[0].base)

    @property
    def tilts(self) -> bool:
        """Whether the hand turns about all axes, and not about z alone."""
        return len(self.legs) not in TASKS

    @property
    def meet(self) -> str:
        """What the rods do where A is singular."""
        if self.axial:
            return "the legs do not hold the hand"
        if self.tilts:
            return "the lines of the rods belong to one linear complex"
        if self.dimensions == 3:
            return "the rods do not hold the hand"
        if self.rails:
            return (
                "the lines of the rods, and those at right angles to the rails, pass through one "
                "point or are parallel"
            )
        return "the rods pass through one point or are parallel"

    @property
    def numbered(self) -> list[tuple[int, Leg]]:
        return [*enumerate(self.legs, 1)]

    @cached_property
    def pose(self) -> sp.Matrix:
        """The target: the position and yaw, or a homogeneous transform."""
        return pose_symbols() if self.tilts else sp.Matrix([*map(real, TASKS[len(self.legs)])])

    @property
    def target(self) -> dict[str, Any]:
        """The input that is the target, under its name."""
        return {"T": self.pose} if self.tilts else {"x": tuple(self.pose)}

    @property
    def position(self) -> sp.Matrix:
        return self.pose[: self.dimensions, 3 if self.tilts else 0]

    @property
    def rotation(self) -> sp.Matrix:
        if self.tilts:
            return self.pose[:3, :3]
        return rotation("z", self.pose[self.dimensions])[: self.dimensions, : self.dimensions]

    @cached_property
    def places(self) -> list[sp.Matrix]:
        """Where the rods end, or the pins of their halves are, in the frame of the hand."""
        return [vector(leg.on_hand or [0] * self.dimensions) for leg in self.legs]

    @cached_property
    def offsets(self) -> list[sp.Matrix]:
        """The part of the places of the ends that does not turn."""
        none = sp.zeros(self.dimensions, 1)
        return [vector(e.offset) if isinstance(e, Half) else none for e in self.given]

    @property
    def whole(self) -> list[Leg]:
        """The legs, with the places where they end on a hand that is not turned."""
        ends = zip(self.legs, self.places, self.offsets, strict=True)
        return [replace(leg, on_hand=tuple(e + aside)) for leg, e, aside in ends]  # type: ignore[type-var]

    @property
    def spread(self) -> sp.Expr:
        """The mean squared distance of the places from their centre, across the axes of turning."""
        n = len(self.places)
        centre = sum(self.places, sp.zeros(self.dimensions, 1)) / n
        across = 3 if self.tilts else 2
        away = [(place - centre)[:across, 0] for place in self.places]
        return sp.factor(sp.expand(sum(map(square, away)) / n))

    @property
    def groups(self) -> list[list[int]]:
        """The numbers of the legs that end in the same point of the hand, for each such point."""
        return _together(self.places)

    @property
    def groups_on_ground(self) -> list[list[int]]:
        """The same for legs that start in the same point of the ground, by their near ends."""
        return _together([leg.end() for leg in self.legs])

    @property
    def pairs(self) -> list[tuple[int, int]]:
        """Of six legs that end in three points of the hand by two, where each of them starts.

        So do six legs that start in three points of the ground, seen from the hand.  Empty if the
        legs meet otherwise.
        """
        for near, far in permutations((self.groups_on_ground, self.groups)):
            if self.tilts and not self.axial and [len(group) for group in far] == [2, 2, 2]:
                start = {k: i for i, group in enumerate(near) for k in group}
                return [(start[a], start[b]) for a, b in far]
        return []

    @property
    def meeting(self) -> list[Leg]:
        """The most legs that end in the same point of the hand."""
        return [self.legs[k - 1] for k in max(self.groups, key=len)]

    @cached_property
    def arms(self) -> list[sp.Matrix]:
        """The places, from the point that is the hand, in the frame of the base."""
        return [self.rotation * place for place in self.places]

    @cached_property
    def spans(self) -> list[sp.Matrix]:
        """The vectors from the near ends of the rods to the point that is the hand.

        A rod is a span and an arm.
        """
        return [
            self.position + offset - leg.end()
            for leg, offset in zip(self.legs, self.offsets, strict=True)
        ]

    @cached_property
    def rods(self) -> list[sp.Matrix]:
        """The vectors along the rods, from their near ends to the hand."""
        return [
            pull_of(leg, span + arm)
            for leg, span, arm in zip(self.legs, self.spans, self.arms, strict=True)
        ]

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length."""
        ends = zip(self.legs, self.spans, self.arms, strict=True)
        return tuple(
            leg.excess(span + arm)
            if isinstance(leg, Axial | Rail)
            else square(span + arm) - sp.sympify(leg.rod, strict=True) ** 2
            for leg, span, arm in ends
        )

    @property
    def rows(self) -> list[sp.Matrix]:
        """The rows of A: a rod and its moment."""
        ends = zip(self.arms, self.rods, strict=True)
        return [rod.col_join(self.moment(arm, rod)).T for arm, rod in ends]

    def moment(self, arm: sp.Matrix, force: sp.Matrix) -> sp.Matrix:
        """The moment of a vector at the end of an arm, about the axes of turning."""
        if self.tilts:
            return arm.cross(force)
        return sp.Matrix([cross_in_plane(arm, force)])


@dataclass(frozen=True)
class Posture:
    """The hand in an assembly mode, in the names of a program."""

    m: Platform
    program: Program
    modes: Branches
    position: sp.Matrix
    rotation: sp.Matrix
    rods: Mapping[int, sp.Matrix]
    """The vectors along the rods, by the numbers of the legs."""
    spans: Sequence[sp.Matrix]
    """The vectors from the first point in which legs end to the others."""
    volumes: Sequence[sp.Expr]
    """The factors of the determinant of A, up to a sign."""
    sign: int
    """The sign of this product."""

    def vectors(self, v: Program) -> tuple[list[sp.Matrix], list[sp.Matrix]]:
        """The arms from the point of the hand to the ends of the rods, and the rods, named."""
        arms: dict[int, sp.Matrix] = {}
        for group in self.m.groups:
            arm = self.rotation * self.m.places[group[0] - 1]
            arms |= dict.fromkeys(group, named(v, f"h_{group[0]}", arm))
        in_order = [arms[k] for k, _ in self.m.numbered]
        return in_order, [named(v, f"r_{k}", self.rods[k]) for k, _ in self.m.numbered]

    def rates(
        self, v: Program, arms: Sequence[sp.Matrix], rods: Sequence[sp.Matrix]
    ) -> tuple[sp.Matrix, list[sp.Expr]]:
        """The matrix A and the diagonal of B, named."""
        rows = []
        for k, (rod, arm) in enumerate(zip(rods, arms, strict=True), 1):
            moments = enumerate(self.m.moment(arm, rod), len(rod) + 1)
            rows.append([*rod, *(named_in(v, f"A_{k}{i}", e) for i, e in moments)])
        driven = [
            named_in(v, f"B_{k}{k}", rate_of(leg, rod))
            for (k, leg), rod in zip(self.m.numbered, rods, strict=True)
        ]
        return sp.Matrix(rows), driven


def certify_forward(m: Platform, links: Sequence[Link], equations: Sequence[sp.Expr]) -> None:
    """State that the links solve the equations of the loop for the pose, and for other points."""
    passive = tuple(e for link in links for e in link.unknowns if e not in {*m.pose})
    m.d.inverses.append(
        Inverse(
            "fk",
            tuple(m.pose),
            (sp.S.Zero,) * len(equations),
            tuple(equations),
            links=tuple(links),
            passive=passive,
        )
    )


def _off_axis(first: Leg, second: Leg) -> list[sp.Expr] | None:
    """What vanishes if two legs have the same axis; None if they are not a pair."""
    if isinstance(first, Around) and isinstance(second, OnTurret):
        return [sp.Integer(first != replace(second.turret, on_hand=first.on_hand))]
    if not (isinstance(first, Along) and isinstance(second, Across | FreeAlong)):
        return None
    off = [*vector(first.direction).cross(vector(second.axis))]
    if isinstance(second, Across):
        off += [*(first.base - second.base).cross(first.rate)]
    return off


def pull_of(leg: Leg, span: sp.Matrix) -> sp.Matrix:
    """The vector of the row of A of a leg, along its rod if it has one."""
    return leg.pull(span) if isinstance(leg, Axial | Rail) else span


def _together(points: Sequence[sp.Matrix]) -> list[list[int]]:
    """The numbers of points, by their coordinates."""
    found: dict[tuple[sp.Expr, ...], list[int]] = {}
    for k, point in enumerate(points, 1):
        found.setdefault(tuple(point), []).append(k)
    return list(found.values())


def check_holds(m: Platform) -> None:
    """Refuse legs that hold the hand in no posture, because A is singular everywhere.

    This is tried with 50 digits at a posture and lengths that are drawn at random.
    """
    draw, at = random.Random(len(m.legs)), {}
    if m.tilts:
        half = hat(sp.Matrix([sp.Rational(draw.randint(50, 999), 100) for _ in "xyz"]))
        at = dict(zip(m.rotation, (sp.eye(3) + half) * (sp.eye(3) - half).inv(), strict=True))
    if singular_everywhere(sp.Matrix.vstack(*m.rows), at):
        raise ShapeError(
            f"{m.d.name}: the legs do not hold the hand; the matrix A is singular in every posture"
        )


def matrices(
    m: Platform, A: sp.Matrix, driven: Sequence[sp.Expr], volume: sp.Expr
) -> list[Exported]:
    """Both matrices of A*t = B*dq and what makes them singular, as functions."""
    return [
        (
            "jacobian_parallel",
            "A of A*t = B*dq; a row is the vector along a rod and its moment about the hand.",
            {"A": A},
            (),
        ),
        (
            "jacobian_serial",
            "The diagonal of B of A*t = B*dq.",
            {"B": driven},
            signs_of_modes(m.legs),
        ),
        (
            "singularities",
            "The diagonal of B (serial) and the determinant of A (parallel).",
            {"factors": [*driven, volume]},
            (),
        ),
    ]


def jacobians(
    m: Platform, p: Program, A: sp.Matrix, driven: Sequence[sp.Expr], volume: sp.Expr
) -> list[Exported]:
    """The Jacobian of a hand that turns about one axis and its determinant, as functions."""
    pole = ("Not finite at a parallel singularity.",)
    *names, last = m.d.task
    task = f"{', '.join(names)} and {last}"
    # the quotient first: a cofactor times an entry of B may be too small for the type
    shares = [p.let(f"share_{k}", b / volume) for k, b in enumerate(driven, 1)]
    J = A.adjugate() * sp.diag(*shares)
    det = sp.Mul(*driven) / volume
    if m.rails:  # the same in this order, because a product of small lengths may be too small
        det = shares[0]
        for k, b in enumerate(driven[1:], 2):
            det = p.let(f"part_{k}", det * b)
    return [
        ("jacobian", f"Derivative of {task} with respect to q: A^-1*B.", {"J": J}, pole),
        ("determinant", "Determinant of the Jacobian.", {"det": det}, pole),
    ]


def counted_degree(m: Platform) -> int:
    """The number of complex poses for the same joints, at generic lengths and joints.

    A square root in the drawing is one more unknown, whose two values have as many poses each.
    """
    axes = "xyz"[: m.dimensions]
    ends = [sp.Matrix([real(f"b{k}_{i}") for i in axes]) for k, _ in m.numbered]
    hand = [m.position + arm - end for arm, end in zip(m.arms, ends, strict=True)]
    equations = [
        (leg.normal.dot(e) if isinstance(leg, Rail) else square(e)) - real(f"r{k}")
        for (k, leg), e in zip(m.numbered, hand, strict=True)
    ]
    roots = {e for f in equations for e in f.atoms(sp.Pow) if e.exp == sp.Rational(1, 2)}
    names = {e: real(f"root{k}") for k, e in enumerate(sorted(roots, key=str))}
    equations = [e.xreplace(names) for e in equations]
    equations += [name**2 - e.base for e, name in names.items()]
    unknowns = (*m.pose, *names.values())
    found = int(count_solutions(equations, unknowns, method="specialised").count)
    return found // (1 << len(names))


__all__ = [
    "LEGS",
    "UPRIGHT",
    "Half",
    "Platform",
    "Posture",
    "certify_forward",
    "check_holds",
    "counted_degree",
    "jacobians",
    "matrices",
    "pull_of",
]
