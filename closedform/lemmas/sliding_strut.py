"""A strut in which the hand of a loop slides, and whose far end a ball holds on the ground."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from closedform.lemmas.legs import Naming, Slide, Solution, vector


@dataclass(frozen=True)
class _Line(Slide):
    """The line of the strut, as the hand has it."""

    reaches: ClassVar[str] = "the distance of both balls reaches from one to the line of the strut"


@dataclass(frozen=True)
class SlidingStrut:
    """A strut from a ball at the point ``pivot`` of the ground, as that of a MacPherson suspension.

    The hand slides along it.  As seen from the point that is the hand, the ball is at ``joint``
    times the unit vector ``direction`` from the point ``on_hand``.
    """

    joint: sp.Symbol
    pivot: Sequence[Any]
    on_hand: Sequence[Any]
    direction: Sequence[Any]

    rod: ClassVar[int] = 0
    """It joins the hand to the ground without a rod."""

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    @property
    def ahead(self) -> sp.Matrix:
        """The direction of the line, in the frame of the hand."""
        return vector(self.direction)

    def end(self) -> sp.Matrix:
        return self.base

    def reached(self, slid: sp.Expr) -> sp.Matrix:
        """Where the ball is in the frame of the hand."""
        return vector(self.on_hand) + slid * self.ahead

    def solve(
        self, chain: Naming, distance: sp.Symbol, at: sp.Matrix, sigma: sp.Symbol
    ) -> Solution:
        """The joint, if the ball is at a ``distance`` from a point ``at`` of the hand."""
        line = _Line(self.joint, distance, self.on_hand, self.direction)
        return line.solve(chain, at - line.base, sigma)


__all__ = ["SlidingStrut"]
