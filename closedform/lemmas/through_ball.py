"""An arm of a hand that slides through a ball, which a driven slider moves; in space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import turned_left, vector


@dataclass(frozen=True)
class ThroughBall:
    """A ball on a slider that moves along the z axis, and an arm of the hand that slides in it.

    The joint moves the ball up from ``start``, or down if ``up`` is -1.  The arm is the line
    through the point of the hand with the direction of the unit vector ``along``, in the plane x, y
    of the hand.  ``slide`` is the passive joint: how far the ball is along the arm.
    """

    joint: sp.Symbol
    slide: sp.Symbol
    start: Sequence[Any]
    along: Sequence[Any]
    up: int = 1

    rod: ClassVar[int] = 0
    on_hand: ClassVar[Sequence[Any]] = ()

    def __post_init__(self) -> None:
        if len(self.start) != 3 or len(self.along) != 2:
            raise ShapeError(
                f"{self.joint}: the start of a ball needs 3 entries, and its arm is a vector in "
                f"the plane of the hand with 2"
            )
        if self.up not in (1, -1):
            raise ShapeError(f"{self.joint}: a ball moves up (1) or down (-1), not {self.up}")
        if not all(e.is_number for e in self.way):
            raise ShapeError(f"{self.joint}: the direction of an arm must be numbers")

    @property
    def base(self) -> sp.Matrix:
        return vector(self.start)

    @property
    def way(self) -> sp.Matrix:
        """The direction of the arm, in the plane of the hand."""
        return vector(self.along)

    @property
    def normal(self) -> sp.Matrix:
        """The same, turned by a right angle to the left."""
        return turned_left(self.way)

    def end(self) -> sp.Matrix:
        """The ball."""
        return self.base + sp.Matrix([0, 0, self.up * self.joint])


__all__ = ["ThroughBall"]
