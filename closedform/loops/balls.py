"""What a hand whose arms slide through balls consists of, and its tilts and its twist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import closing_weights, cross_in_plane
from closedform.lemmas.through_ball import ThroughBall
from closedform.loops.leg_by_leg import size_of
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, real
from closedform.model.pair import Pair

LEGS = 3
TASK = ("z", "tilt_x", "tilt_y")
Z, TILT_X, TILT_Y = TARGET = tuple(map(real, TASK))
ASIDE = sp.Matrix([real("x"), real("y")])
TWIST = real("twist")
UP = sp.Matrix([0, 0, 1])


@dataclass(frozen=True)
class OnBalls:
    """A hand whose arms slide through three balls."""

    d: Derivation
    legs: tuple[ThroughBall, ...]

    def __post_init__(self) -> None:
        name, joints = self.d.name, [leg.joint for leg in self.legs]
        if len(self.legs) != LEGS or joints != list(self.d.actuated):
            raise ShapeError(
                f"{name}: a hand on balls has three legs, in the order of the driven joints"
            )
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(TASK)}")
        self.d.task = list(TASK)
        if sp.simplify(self.area) == 0:
            raise ShapeError(f"{name}: the sliders are in one plane, and do not hold the hand")
        if 0 in self.weights:
            raise ShapeError(f"{name}: two arms are parallel; three directions hold the hand")

    @cached_property
    def bases(self) -> list[sp.Matrix]:
        """Where the sliders are, seen along them."""
        return [leg.base[:2, 0] for leg in self.legs]

    @property
    def heights(self) -> list[sp.Expr]:
        return [leg.end()[2] for leg in self.legs]

    @cached_property
    def area(self) -> sp.Expr:
        """Twice the area of the triangle of the sliders, with a sign."""
        a, b, c = self.bases
        return sp.factor(sp.expand(cross_in_plane(b - a, c - a)))

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the arms add up to zero."""
        found = closing_weights([leg.way for leg in self.legs])
        return found if sp.Add(*found) >= 0 else tuple(-w for w in found)

    @cached_property
    def sides(self) -> list[sp.Matrix]:
        """From the first slider to the others, relative to the sum of the lengths."""
        size = size_of(self.d, self.legs)
        return [(base - self.bases[0]) / size for base in self.bases[1:]]

    def normal(self, heights: Sequence[sp.Expr], sides: Sequence[sp.Matrix]) -> sp.Matrix:
        """A normal of the plane of the balls."""
        (first, second), (u, v) = (h - heights[0] for h in heights[1:]), sides
        return sp.Matrix(
            [
                u[1] * second - first * v[1],
                first * v[0] - u[0] * second,
                size_of(self.d, self.legs) * cross_in_plane(u, v),
            ]
        )

    def twisting(self, pins: Sequence[sp.Matrix]) -> tuple[sp.Expr, sp.Expr]:
        """What sin(twist) and cos(twist) are proportional to, from the balls in the plane."""
        terms = [*zip(self.weights, self.legs, pins, strict=True)]
        return (
            sp.Add(*(w * leg.normal.dot(m) for w, leg, m in terms)),
            sp.Add(*(w * leg.way.dot(m) for w, leg, m in terms)),
        )

    def centre(self, pins: Sequence[sp.Matrix], pair: Pair) -> sp.Matrix:
        """The point of the hand in its plane, in the frame of the hand: where two arms meet."""
        first, second = self.legs[:2]
        seen = [sp.Matrix([pair.c * x + pair.s * y, pair.c * y - pair.s * x]) for x, y in pins]
        g, h = (leg.normal.dot(m) for leg, m in zip((first, second), seen, strict=False))
        across = sp.simplify(cross_in_plane(first.way, second.way))
        return (g * second.way - h * first.way) / across


@dataclass(frozen=True)
class Turns:
    """Sines and cosines of both tilts and the twist."""

    x: Pair
    y: Pair
    twist: Pair

    @property
    def tilted(self) -> sp.Matrix:
        x, y = self.x, self.y
        return sp.Matrix(
            [[y.c, y.s * x.s, y.s * x.c], [0, x.c, -x.s], [-y.s, y.c * x.s, y.c * x.c]]
        )

    @property
    def rotation(self) -> sp.Matrix:
        s, c = self.twist.s, self.twist.c
        return self.tilted * sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def exact_turns() -> Turns:
    x, y, t = (Pair(sp.sin(e), sp.cos(e)) for e in (TILT_X, TILT_Y, TWIST))
    return Turns(x, y, t)


@dataclass(frozen=True)
class Posture:
    """The hand in an assembly mode, in the names of the program of ``fk``."""

    program: Program
    modes: Branches
    turns: Turns
    hand: sp.Matrix
    balls: list[sp.Matrix]
    sides: list[sp.Matrix]


__all__ = [
    "ASIDE",
    "TARGET",
    "TILT_X",
    "TILT_Y",
    "TWIST",
    "UP",
    "OnBalls",
    "Posture",
    "Turns",
    "Z",
    "exact_turns",
]
