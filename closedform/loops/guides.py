"""What rules the motion of a hand, without a motor: a passive leg, a universal joint or a ball.

Each of them holds the hand on the ground and leaves it as many degrees of
freedom as there are driven legs.
:func:`closedform.loops.guided.guided` derives the mechanism.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, Stretch, vector
from closedform.lemmas.links import polar_lemma
from closedform.loops.hand import square
from closedform.loops.leg_by_leg import named, named_in
from closedform.mechanics.frames import require_rotation, rotation
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Degenerate, Link
from closedform.model.pair import Pair

TURNS = sp.Matrix([real("turn_1"), real("turn_2")])
LENGTH = real("length")
RHO = real("rho")
"""The distance of a hand on a passive leg from the first axis."""


@dataclass(frozen=True)
class Sliding:
    """A passive slide, whose hand has its position as the target."""

    ahead: sp.Matrix
    """The direction in which it moves the hand."""
    length: sp.Expr
    rates: sp.Matrix
    """The velocity of the point of the hand per rate of the passive joints."""
    volume: sp.Expr
    """The determinant of these rates."""
    inverse: sp.Matrix

    def explicit(self, p: Program) -> Sliding:
        """The same without the names of a program."""
        return Sliding(*(p.explicit(getattr(self, f.name)) for f in fields(self)))

    @classmethod
    def of(cls, length: sp.Expr, rho: sp.Expr, axes: Sequence[sp.Matrix]) -> Sliding:
        """From the length of the leg, the distance of the hand from the first axis, v, n and u."""
        v, n, u = axes
        return cls(
            ahead=u,
            length=length,
            rates=sp.Matrix.hstack(-rho * v, length * n, u),
            volume=rho * length,
            inverse=sp.Matrix.vstack(-v.T / rho, n.T / length, u.T),
        )


@dataclass(frozen=True)
class Placed:
    """The hand at a target, in the names of a program."""

    rotation: sp.Matrix
    turns: tuple[sp.Matrix, ...]
    """The axes about which the joints that hold the hand turn it."""
    shift: sp.Matrix
    """From the pivot to the point of the hand."""
    arms: tuple[sp.Matrix, ...]
    """The ends of the legs, from the pivot."""
    slide: Sliding | None = None
    """What a passive slide adds."""
    links: tuple[Link, ...] = ()
    """How the joints that hold the hand were found."""
    moves: tuple[sp.Matrix, ...] = ()
    """How the coordinates move the point of the hand; empty if all turn about the pivot."""
    levers: tuple[sp.Matrix, ...] = ()
    """The ends of the legs from the point of the hand, beside moves; without them, if all axes but
    the first pass this point instead of the pivot."""
    fixed: tuple[sp.Expr, ...] = ()
    """What vanishes where nothing fixes the place or the twist of the hand, without a unit."""

    def explicit(self, p: Program) -> Placed:
        """The same without the names of a program."""
        return replace(
            self,
            rotation=p.explicit(self.rotation),
            turns=tuple(map(p.explicit, self.turns)),
            shift=p.explicit(self.shift),
            arms=tuple(map(p.explicit, self.arms)),
            moves=tuple(map(p.explicit, self.moves)),
            levers=tuple(map(p.explicit, self.levers)),
            fixed=tuple(map(p.explicit, self.fixed)),
            slide=self.slide and self.slide.explicit(p),
        )

    def row(self, k: int, rod: sp.Matrix) -> sp.Matrix:
        """How the joints that hold the hand stretch the rod of leg ``k``."""
        if self.moves:
            moment = self.levers[k].cross(rod)
            motions = zip(self.turns, self.moves, strict=True)
            return sp.Matrix([[axis.dot(moment) + move.dot(rod) for axis, move in motions]])
        moments = [e[k].cross(rod) for e in (self.arms, self.levers or self.arms)]
        along = [rod.dot(self.slide.ahead)] if self.slide else []
        first, *others = self.turns
        turned = [first.dot(moments[0]), *(axis.dot(moments[1]) for axis in others)]
        return sp.Matrix([[*turned, *along]])


@dataclass(frozen=True)
class Turning:
    """Two axes at right angles: the first is fixed to the ground, the second to the hand."""

    pivot: Sequence[Any]
    first: Sequence[Any]
    second: Sequence[Any]

    @property
    def axes(self) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """Both axes and the direction at right angles to them, where the hand is not turned."""
        a, b = vector(self.first), vector(self.second)
        return a, b, a.cross(b)

    @property
    def faulty(self) -> bool:
        a, b, _ = self.axes
        return any(sp.simplify(e) != 0 for e in (square(a) - 1, square(b) - 1, a.dot(b)))

    def turned(self, p: Program, pairs: Mapping[sp.Expr, sp.Expr]) -> tuple[sp.Matrix, ...]:
        """R, the second axis and R times both other directions, for sines and cosines."""
        home, (turn_1, turn_2) = sp.Matrix.hstack(*self.axes), TURNS
        tilted = (home * rotation("x", turn_1)).xreplace(dict(pairs))
        R = p.matrix("R", tilted * rotation("y", turn_2).xreplace(dict(pairs)) * home.T)
        return R, *(
            named(p, letter, at)
            for letter, at in (
                ("v", tilted.col(1)),
                ("n", R * self.axes[0]),
                ("u", R * self.axes[2]),
            )
        )


def named_rows(p: Program, letter: str, v: sp.Matrix) -> sp.Matrix:
    """A vector of a leg, its components under names with their numbers."""
    return sp.Matrix([named_in(p, f"{letter}{i}", e) for i, e in enumerate(v, 1)])


def arms_at(
    p: Program, R: sp.Matrix, shift: sp.Matrix, places: Sequence[sp.Matrix], letter: str = "f"
) -> tuple[sp.Matrix, ...]:
    """The ends of the legs, from the pivot."""
    ends = enumerate(places, 1)
    return tuple(named_rows(p, f"{letter}_{k}", shift + R * place) for k, place in ends)


def polar(
    p: Program,
    unknowns: tuple[sp.Symbol, sp.Symbol],
    target: tuple[sp.Expr, sp.Expr],
    meaning: str,
    size: sp.Expr | None,
) -> Link:
    """The angle and the positive length of a plane vector, under names in a program.

    With a ``size`` the angle is zero where it is free.
    """
    (angle, length), (x, y), start = unknowns, target, len(p.body)
    r = p.let(f"{length}_of", sp.sqrt(x**2 + y**2), nonnegative=True)
    pair, cases = Pair(y / r, x / r), []
    if size is not None:
        flag = p.vanishes(f"free_{angle}", r, size, meaning, (angle,))
        pair = Pair(choose(flag, 0, pair.s), choose(flag, 1, pair.c))
        locus = {e if e.is_Symbol else -e: sp.S.Zero for e in target}
        cases.append(Degenerate((flag,), locus, angle, meaning))
    pair = pair.known_as(p, f"_{angle}")
    lemma = polar_lemma({angle: pair.angle, length: r}, (x, y))
    return Link(
        unknowns=(angle, length),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(p.body[start:]),
        means={pair.s: sp.sin(angle), pair.c: sp.cos(angle), r: length},
        degenerate=tuple(cases),
    )


@dataclass(frozen=True)
class Guide:
    """A passive leg: a universal joint at ``pivot``, and a slide that carries the hand.

    The universal joint turns the leg about ``first``, which is fixed to the ground, and about
    ``second``; both are unit vectors in numbers, at right angles.  Where both angles are zero, the
    leg has the direction ``first x second``, and the hand is not turned.  The point of the hand is
    on the line of the leg.  ``slide`` is the passive joint, for the drawing.
    """

    slide: sp.Symbol
    pivot: Sequence[Any]
    first: Sequence[Any]
    second: Sequence[Any]

    legs: ClassVar[int] = 3
    task: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    degree: ClassVar[int] = 28
    """Of the forward problem in general, counted with a Groebner basis at random numbers."""
    turning: ClassVar[int] = 2
    leg: ClassVar[str] = "passive leg"
    """What it is called."""
    holds: ClassVar[str] = ""

    @property
    def own(self) -> tuple[str, ...]:
        return (self.leg,)

    @property
    def what(self) -> str:
        return f"a {self.leg}"

    @property
    def follow(self) -> str:
        return f"the turns and the length of the {self.leg} follow"

    @property
    def left_out(self) -> str:
        return (
            f"The postures in which the hand is turned by half a turn about the {self.leg} are "
            f"left out."
        )

    @property
    def motion(self) -> str:
        return (
            f"The turns of the {self.leg} move the far end of rod i, which is at f_i from the "
            f"pivot, about the first axis and about v, and its length moves it along u.  So they "
            f"stretch rod i by D_i: the moment of the vector r_i along it about both axes, and its "
            f"part along u.  The same joints move the hand by G, so row i of A is D_i*G^-1"
        )

    def driven(self) -> Driven:
        """The same, if a motor moves the slide."""
        return Driven(self.slide, self.pivot, self.first, self.second)

    @property
    def joint(self) -> Turning:
        return Turning(self.pivot, self.first, self.second)

    @property
    def inputs(self) -> dict[str, Any]:
        return {"x": tuple(map(real, self.task))}

    @property
    def moved(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, self.task))

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program; with a ``size`` also where a turn is free.

        There the angle of this turn is taken as zero, instead of being undefined.
        """
        shift = sp.Matrix(self.inputs["x"]) - vector(self.pivot)
        seen = sp.Matrix.hstack(*self.joint.axes).T * shift
        X, Y, Z = (named_in(p, f"w_{k}", e) for k, e in enumerate(seen, 1))
        first = polar(p, (TURNS[0], RHO), (Z, -Y), "the hand is on the first axis", size)
        names = {e: name for name, e in first.means.items()}
        rho = names[RHO]
        second = polar(p, (TURNS[1], LENGTH), (rho, X), "the hand is at the pivot", size)
        names |= {e: name for name, e in second.means.items()}
        R, *axes = self.joint.turned(p, names)
        slide = Sliding.of(names[LENGTH], rho, axes)
        arms = arms_at(p, R, shift, places)
        return Placed(
            rotation=R,
            turns=(vector(self.first), axes[0]),
            shift=shift,
            arms=arms,
            slide=slide,
            links=(first, second),
        )

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand in the passive joints, without a program."""
        p = Program()
        R, *axes = map(p.explicit, self.joint.turned(p, {}))
        slide = Sliding.of(LENGTH, LENGTH * sp.cos(TURNS[1]), axes)
        shift = LENGTH * slide.ahead
        arms = tuple(shift + R * place for place in places)
        return Placed(R, (vector(self.first), axes[0]), shift, arms, slide)


@dataclass(frozen=True)
class Driven(Guide):
    """The same leg with a driven slide, as in a TriVariant; it is one of the three driven legs."""

    leg: ClassVar[str] = "middle leg"
    degree: ClassVar[int] = 8
    """If its length is known, two turns are left, as those of a universal joint."""

    def check(self, name: str, legs: Sequence[Leg]) -> None:
        """Refuse legs of which none is that of the slide."""
        for leg in legs:
            if leg.joint == self.slide and isinstance(leg, Stretch):
                places = [*(leg.base - vector(self.pivot)), *vector(leg.on_hand or (0, 0, 0))]
                if any(sp.simplify(e) != 0 for e in places):
                    break
                return
        raise ShapeError(
            f"{name}: {self.slide} moves the leg that carries the hand, so one of the legs is a "
            f"Stretch with this joint, from the pivot to the point of the hand"
        )


@dataclass(frozen=True)
class Gimbal(Turning):
    """A universal joint at ``pivot``, which holds the hand on the ground.

    It turns the hand about ``first``, which is fixed to the ground, and about ``second``, which is
    fixed to the hand; both are unit vectors in numbers, at right angles where the hand is not
    turned.  The pivot is the point of the hand.
    """

    legs: ClassVar[int] = 2
    task: ClassVar[tuple[str, ...]] = ("turn_1", "turn_2")
    degree: ClassVar[int] = 8
    turning: ClassVar[int] = 2
    own: ClassVar[tuple[str, ...]] = ()
    moved: ClassVar[tuple[sp.Symbol, ...]] = ()
    what: ClassVar[str] = "a universal joint"
    holds: ClassVar[str] = "The universal joint holds the point p of the hand.  "
    follow: ClassVar[str] = "both turns follow"
    motion: ClassVar[str] = (
        "The universal joint turns the far end of rod i, which is at f_i from the pivot, about the "
        "first axis and about v.  So row i of A is the moment of the vector r_i along rod i about "
        "both axes"
    )

    @property
    def joint(self) -> Turning:
        return self

    @property
    def inputs(self) -> dict[str, Any]:
        return {"x": tuple(TURNS)}

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program."""
        R, v, *_ = self.turned(p, {})
        none = sp.zeros(3, 1)
        return Placed(R, (vector(self.first), v), none, arms_at(p, R, none, places))

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand in its angles, without a program."""
        p = Program()
        R, v, *_ = map(p.explicit, self.turned(p, {}))
        return Placed(R, (vector(self.first), v), sp.zeros(3, 1), tuple(R * e for e in places))


@dataclass(frozen=True)
class Cross(Gimbal):
    """A cross that holds the hand on the ground; its axes are those of a gimbal, but need not meet.

    The cross turns about ``first`` at ``pivot``, and carries the axis ``second`` of the hand.  The
    point of the hand is on this axis, and ``offset`` leads to it from the pivot where nothing is
    turned.
    """

    offset: Sequence[Any] = (0, 0, 0)

    what: ClassVar[str] = "a cross"
    holds: ClassVar[str] = (
        "The cross turns about the first axis at its pivot.  Its second axis passes the point p of "
        "the hand, which is at s from the pivot.  "
    )
    motion: ClassVar[str] = (
        "The first axis passes the pivot, from which the far end of rod i is at f_i, and the "
        "second one, v, passes the point of the hand, which is at s.  So row i of A is the moment "
        "of the vector r_i along rod i about both axes"
    )

    def shift(self) -> sp.Matrix:
        """From the pivot to the point of the hand."""
        home = sp.Matrix.hstack(*self.axes)
        return home * rotation("x", TURNS[0]) * home.T * vector(self.offset)

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program."""
        R, v, *_ = self.turned(p, {})
        shift = named(p, "s", self.shift())
        levers = arms_at(p, R, sp.zeros(3, 1), places, "e")
        arms = tuple(named_rows(p, f"f_{k}", shift + e) for k, e in enumerate(levers, 1))
        return Placed(R, (vector(self.first), v), shift, arms, levers=levers)

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand in its angles, without a program."""
        p = Program()
        R, v, *_ = map(p.explicit, self.turned(p, {}))
        shift, levers = self.shift(), tuple(R * e for e in places)
        arms = tuple(shift + lever for lever in levers)
        return Placed(R, (vector(self.first), v), shift, arms, levers=levers)


@dataclass(frozen=True)
class Ball:
    """A ball joint at ``pivot``, which holds the hand on the ground and lets it turn freely.

    The pivot is the point of the hand.
    """

    pivot: Sequence[Any]

    legs: ClassVar[int] = 3
    task: ClassVar[tuple[str, ...]] = tuple(f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3))
    degree: ClassVar[int] = 8
    turning: ClassVar[int] = 3
    own: ClassVar[tuple[str, ...]] = ()
    moved: ClassVar[tuple[sp.Symbol, ...]] = ()
    what: ClassVar[str] = "a ball joint"
    holds: ClassVar[str] = "The ball joint holds the point p of the hand, whose rotation is R.  "
    follow: ClassVar[str] = "the rotation follows"
    motion: ClassVar[str] = (
        "The hand turns the far end of rod i, which is at f_i from the pivot, with its angular "
        "velocity.  So row i of A is the moment of the vector r_i along rod i"
    )

    @property
    def rotation(self) -> sp.Matrix:
        return sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))

    @property
    def inputs(self) -> dict[str, Any]:
        return {"R": self.rotation}

    def check(self, p: Program) -> None:
        """Require that the input is a rotation."""
        require_rotation(p, self.rotation)

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program."""
        none, axes = sp.zeros(3, 1), tuple(sp.eye(3).col(k) for k in range(3))
        return Placed(self.rotation, axes, none, arms_at(p, self.rotation, none, places))

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand by its rotation, without a program."""
        return self.place(Program(), places)


__all__ = [
    "LENGTH",
    "TURNS",
    "Ball",
    "Cross",
    "Gimbal",
    "Guide",
    "Placed",
    "Turning",
    "arms_at",
    "polar",
]
