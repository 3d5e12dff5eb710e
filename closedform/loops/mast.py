"""A hand on a universal or a ball joint that slides along a mast, as a swash plate."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, vector
from closedform.loops.guides import TURNS, Turning
from closedform.loops.hinges import Frame, Hinged, Hinges
from closedform.loops.leg_by_leg import named
from closedform.mechanics.frames import rotation
from closedform.model.functions import Program, real

TRAVEL, SPIN = real("travel"), real("turn_3")


@dataclass(frozen=True)
class Mast(Hinges):
    """A passive slide on the ground that carries a universal joint, which holds the hand.

    The slide moves along the unit vector ``along``, and at 0 the universal joint is at ``pivot``.
    It turns the hand about ``first``, which the slide does not turn, and about ``second``, which is
    fixed to the hand; both are unit vectors in numbers, at right angles where the hand is not
    turned.  The centre of the universal joint is the point of the hand.
    """

    first: Sequence[Any]
    second: Sequence[Any]
    along: Sequence[Any]

    turning: ClassVar[int] = 2
    degree: ClassVar[int] = 28
    """That of a passive leg whose slide is on its universal joint, seen from the hand."""
    moved: ClassVar[tuple[sp.Symbol, ...]] = (TRAVEL,)
    what: ClassVar[str] = "a mast"
    follow: ClassVar[str] = "the travel and both turns follow"

    @property
    def joint(self) -> Turning:
        return Turning(self.pivot, self.first, self.second)

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (TRAVEL, *TURNS)

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return {}

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> Mast:
        way = vector(self.along)
        if sp.simplify(way.dot(way) - 1) != 0:
            raise ShapeError(f"{name}: the direction of a mast is a unit vector, in numbers")
        if any(isinstance(leg, Hinged) for leg in legs):
            raise ShapeError(f"{name}: a leg of a hand on a mast is not Hinged")
        return self

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        R, v, *_ = self.joint.turned(p, {})
        none, way = sp.zeros(3, 1), vector(self.along)
        return Frame(
            rotation=R,
            axes=(none, vector(self.first), v),
            shift=TRAVEL * way,
            moves=(way, none, none),
        )


@dataclass(frozen=True)
class BallOnMast(Mast):
    """A passive slide on the ground that carries a ball joint, which holds the hand.

    The hand is turned about ``first``, which stands still, about ``second``, which the first turn
    moves, and then about an axis of its own: ``first x second``, where nothing is turned.  The
    centre of the ball is the point of the hand.
    """

    turning: ClassVar[int] = 3
    degree: ClassVar[int] = 28
    what: ClassVar[str] = "a ball joint on a mast"
    follow: ClassVar[str] = "the travel and the three turns follow"
    left_out: ClassVar[str] = (
        "SINGULAR too where turn_2 is a right angle: turn_1 and turn_3 turn the hand about the "
        "same axis there."
    )

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (*super().coordinates, SPIN)

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        home = sp.Matrix.hstack(*self.joint.axes)
        swung = home * rotation("x", TURNS[0])
        tilted = swung * rotation("y", TURNS[1])
        R = p.matrix("R", tilted * rotation("z", SPIN) * home.T)
        none, way = sp.zeros(3, 1), vector(self.along)
        own = (named(p, letter, at) for letter, at in (("v", swung.col(1)), ("u", tilted.col(2))))
        return Frame(
            rotation=R,
            axes=(none, vector(self.first), *own),
            shift=TRAVEL * way,
            moves=(way, none, none, none),
        )


__all__ = ["BallOnMast", "Mast"]
