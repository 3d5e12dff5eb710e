"""What a hand consists of whose three balls slide along horizontal lines, as that of a CaPaMan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, cast

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import (
    Crank,
    Leg,
    Slide,
    closing_weights,
    cross_in_plane,
    turned_left,
    vector,
)
from closedform.loops.balls import ASIDE, TILT_X, TILT_Y, TWIST, Turns, Z
from closedform.loops.hand import check_order, check_plain, square
from closedform.mechanics.frames import rotation
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program
from closedform.model.pair import Pair

LEGS, SPACE = 3, 3
TASK = ("z", "tilt_x", "tilt_y")


@dataclass(frozen=True)
class BallOnLine:
    """A horizontal line that a motor moves, and a ball of the hand that slides along it.

    The ``leg`` is a crank or a slide in space with the rod 0, and its end is a point of the line.
    ``along`` is the direction of the line, a horizontal unit vector, as x and y in numbers.
    ``slide`` is the passive joint, and ``corner`` the ball as x and y in the frame of the hand.
    """

    leg: Crank | Slide
    slide: sp.Symbol
    along: Sequence[Any]
    corner: Sequence[Any]

    rod: ClassVar[int] = 0

    def __post_init__(self) -> None:
        leg, joint = self.leg, self.leg.joint
        if not isinstance(leg, Crank | Slide) or leg.rod != 0 or len(leg.base) != SPACE:
            raise ShapeError(
                f"{joint}: a crank or a slide in space with the rod 0 moves the line of a ball"
            )
        if len(self.along) != 2 or len(self.corner) != 2:
            raise ShapeError(
                f"{joint}: the direction of a horizontal line and the corner of the hand need 2 "
                f"entries"
            )
        if not square(self.way).is_number or sp.simplify(square(self.way) - 1) != 0:
            raise ShapeError(f"{joint}: the direction of a line must be a unit vector, in numbers")
        if isinstance(leg, Slide) and not (self.lift.is_number and self.lift != 0):
            raise ShapeError(
                f"{joint}: the slide has to move its line up or down, in a direction of numbers"
            )

    @property
    def way(self) -> sp.Matrix:
        return vector(self.along)

    @property
    def normal(self) -> sp.Matrix:
        """The same, turned by a right angle to the left."""
        return turned_left(self.way)

    @property
    def place(self) -> sp.Matrix:
        """The ball in the frame of the hand."""
        return vector(self.corner)

    @property
    def lift(self) -> sp.Expr:
        """How fast the joint moves the line up."""
        return sp.simplify(self.leg.rate[2])

    @property
    def base(self) -> sp.Matrix:
        return self.leg.base

    @property
    def length(self) -> Any:
        return self.leg.length if isinstance(self.leg, Crank) else 0

    @property
    def on_hand(self) -> Sequence[Any]:
        return self.corner


@dataclass(frozen=True)
class OnLines:
    """A hand whose three balls slide along horizontal lines."""

    d: Derivation
    legs: tuple[BallOnLine, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != LEGS:
            raise ShapeError(f"{name}: a hand whose balls slide along lines has three legs")
        check_order(self.d, [cast("Leg", leg.leg) for leg in self.legs])
        check_plain(self.d, [leg.leg for leg in self.legs])
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(TASK)}")
        self.d.task = list(TASK)
        if not any(self.weights):
            raise ShapeError(f"{name}: the three lines are parallel, so the hand slides along them")
        if sp.simplify(self.area) == 0:
            raise ShapeError(f"{name}: the corners of the hand are in line, and do not hold it")

    @property
    def numbered(self) -> list[tuple[int, BallOnLine]]:
        return [*enumerate(self.legs, 1)]

    @property
    def sliders(self) -> list[sp.Symbol]:
        return [leg.leg.joint for leg in self.legs if isinstance(leg.leg, Slide)]

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the lines add up to zero."""
        return closing_weights([leg.normal for leg in self.legs])

    @cached_property
    def order(self) -> tuple[int, int]:
        """Two lines that are not parallel; they give the place of the hand."""
        last = next(k for k in (2, 0, 1) if self.weights[k] != 0)
        return (last + 1) % LEGS, (last + 2) % LEGS

    @cached_property
    def sides(self) -> tuple[sp.Matrix, sp.Matrix]:
        """From the first corner of the hand to the others."""
        first, second, third = (leg.place for leg in self.legs)
        return second - first, third - first

    @cached_property
    def area(self) -> sp.Expr:
        """Twice the area of the triangle of the corners, with a sign."""
        return sp.factor(sp.expand(cross_in_plane(*self.sides)))

    @property
    def spread(self) -> sp.Expr:
        """The sum of the sides, which an error of the heights is multiplied by."""
        return sp.Add(*(sp.Abs(e) for side in self.sides for e in side))

    @property
    def heights(self) -> list[sp.Expr]:
        return [leg.leg.end()[2] for leg in self.legs]

    @property
    def beside(self) -> list[sp.Expr]:
        """How far the lines are from the z axis, along their normals."""
        return [sp.expand(leg.normal.dot(leg.leg.end()[:2, 0])) for leg in self.legs]

    def level(self, heights: Sequence[sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
        """The first entries of the last row of R, times the area, from the heights of the balls."""
        (e, g), (second, third) = self.sides, (h - heights[0] for h in heights[1:])
        return second * g[1] - third * e[1], third * e[0] - second * g[0]

    def rise(self, row: Sequence[sp.Expr], k: int) -> sp.Expr:
        """How far a corner is above the point of the hand, by the last row of R."""
        return row[0] * self.legs[k].place[0] + row[1] * self.legs[k].place[1]

    def twisting(self, flat: Sequence[sp.Matrix]) -> tuple[sp.Expr, sp.Expr]:
        """What sin(twist) and cos(twist) are multiplied by, from the corners without the twist."""
        terms = [*zip(self.weights, self.legs, flat, strict=True)]
        return (
            sp.Add(*(w * leg.normal.dot(turned_left(f)) for w, leg, f in terms)),
            sp.Add(*(w * leg.normal.dot(f) for w, leg, f in terms)),
        )

    def weighted(self, beside: Sequence[sp.Expr]) -> sp.Expr:
        """The sum of the distances of the lines, each times its weight."""
        return sp.Add(*(w * e for w, e in zip(self.weights, beside, strict=True)))

    def centre(self, beside: Sequence[sp.Expr], flat: Sequence[sp.Matrix], pair: Pair) -> sp.Matrix:
        """The point of the hand, seen from above: where two lines, moved by its corners, meet."""
        (i, k), ends = self.order, [pair.c * f + pair.s * turned_left(f) for f in flat]
        first, second = self.legs[i], self.legs[k]
        g, h = (beside[j] - self.legs[j].normal.dot(ends[j]) for j in (i, k))
        across = sp.simplify(cross_in_plane(first.way, second.way))
        return (g * second.way - h * first.way) / across

    @cached_property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each ball is at the height of its line, and on it."""
        R, found = exact_pose().rotation, []
        for k, leg in enumerate(self.legs):
            ball = sp.Matrix([*ASIDE, Z]) + R[:, :2] * leg.place
            found += [
                ball[2] - self.heights[k],
                leg.normal.dot(ball[:2, 0]) - self.beside[k],
            ]
        return tuple(found)


@dataclass(frozen=True)
class Twisted:
    """A rotation: by both tilts, and then by the twist about the z axis of the base."""

    tilts: Turns
    pair: Pair

    @property
    def tilted(self) -> sp.Matrix:
        return self.tilts.tilted

    @property
    def rotation(self) -> sp.Matrix:
        s, c = self.pair.s, self.pair.c
        return sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]]) * self.tilted


def exact_pose() -> Twisted:
    """The hand in the angles of its target and the twist."""
    x, y, t = (Pair(sp.sin(e), sp.cos(e)) for e in (TILT_X, TILT_Y, TWIST))
    return Twisted(Turns(x, y, Pair(sp.S.Zero, sp.S.One)), t)


def as_turns() -> sp.Matrix:
    """The same rotation, as a product of turns."""
    return rotation("z", TWIST) * rotation("y", TILT_Y) * rotation("x", TILT_X)


@dataclass(frozen=True)
class Posture:
    """The hand in an assembly mode, in the names of the program of ``fk``."""

    program: Program
    modes: Branches
    pose: Twisted
    hand: sp.Matrix
    upright: sp.Expr
    """The last entry of R."""
    root: sp.Expr
    """The derivative of the equation of the twist, up to its sign."""


__all__ = [
    "TASK",
    "BallOnLine",
    "OnLines",
    "Posture",
    "Twisted",
    "as_turns",
    "exact_pose",
]
