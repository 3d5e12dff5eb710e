"""A hand that is an axis: five legs end on it and leave it free to turn about itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg, vector
from closedform.loops.guides import TURNS, Turning
from closedform.loops.hinges import Frame, Hinged, Hinges
from closedform.model.functions import Program, real

PLACE = tuple(map(real, "xyz"))


@dataclass(frozen=True)
class Spindle(Hinges):
    """A hand that five legs hold by balls on one line of it, a linear pentapod.

    The legs leave it one freedom, the turn about this line, such as that of a milling tool.  The
    target is the position of the hand from ``pivot``, and two turns of the line, about ``first``,
    which is fixed to the ground, and then about ``second``.  Both are unit vectors in numbers, at
    right angles; where nothing is turned, the line has the direction ``first x second``.  It passes
    the point of the hand.
    """

    first: Sequence[sp.Expr]
    second: Sequence[sp.Expr]

    turning: ClassVar[int] = 2
    degree: ClassVar[int] = 8
    """Three quadrics: the five equations are linear in p, u, |p|^2 and p*u, where u is the
    direction of the line; so three linear ones remain beside |p|^2, p*u and |u|^2 = 1."""
    what: ClassVar[str] = "a line"
    follow: ClassVar[str] = "the place and the direction of the line of the hand follow"
    left_out: ClassVar[str] = (
        "SINGULAR too where the line is along the first axis, about which turn_1 does not turn "
        "it.  The turn of the hand about its line is free; hand_pose takes none."
    )

    @property
    def joint(self) -> Turning:
        return Turning(self.pivot, self.first, self.second)

    @property
    def coordinates(self) -> tuple[sp.Symbol, ...]:
        return (*PLACE, *TURNS)

    @property
    def solved(self) -> dict[sp.Symbol, sp.Matrix]:
        return {}

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> Spindle:
        line = self.joint.axes[2]
        for leg in legs:
            if isinstance(leg, Hinged):
                raise ShapeError(f"{name}: a leg that ends on the line of the hand is not Hinged")
            if any(map(sp.simplify, vector(leg.on_hand or (0, 0, 0)).cross(line))):
                raise ShapeError(
                    f"{name}: the leg of {leg.joint} has to end on the line of the hand, which "
                    f"passes its point in the direction first x second"
                )
        return self

    def frame(self, p: Program, *, guarded: bool = False) -> Frame:
        R, v, *_ = self.joint.turned(p, {})
        none, ways = sp.zeros(3, 1), [sp.eye(3).col(k) for k in range(3)]
        return Frame(
            rotation=R,
            axes=(none, none, none, vector(self.first), v),
            shift=sp.Matrix(PLACE),
            moves=(*ways, none, none),
        )


__all__ = ["Spindle"]
