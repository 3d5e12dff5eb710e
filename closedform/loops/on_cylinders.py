"""A hand on rods that are free along their axes, as that of a 3-PRC mechanism; it does not turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.axial import FreeAlong
from closedform.lemmas.legs import Leg, vector
from closedform.loops.parallel_axes import ParallelAxes
from closedform.model.derivation import Derivation


@dataclass(frozen=True)
class OnCylinders(ParallelAxes):
    """What holds a hand that does not turn: rods at given distances from axes that motors move.

    Each of its three legs is :class:`~closedform.lemmas.axial.FreeAlong` its axis: a slider or a
    crank moves a rod, and a cylindrical joint with the same axis joins this to the hand.
    """

    degree: ClassVar[int] = 8
    """Three quadrics, by Bezout's theorem."""
    what: ClassVar[str] = "rods that are free along axes"
    legs_close: ClassVar[str] = (
        "The joint of leg i determines the near end b of its rod.  The rod turns about an axis "
        "there, and a cylindrical joint with the same direction n joins its other end to the hand "
        "at e, seen from p.  So e is on a cylinder: across n, it is as far from b as the rod is "
        "long, and along n the hand is free."
    )
    left_out: ClassVar[str] = ""
    rods: ClassVar[dict[str, str]] = {
        r"\mathbf r_i": r"\mathbf w_i - (\mathbf n_i^T\mathbf w_i)\,\mathbf n_i"
    }
    proves: ClassVar[str] = (
        "Half of the derivative of the equation of a leg with respect to the target is the row of "
        "A, and with respect to the joint it is minus the entry of B."
    )
    motion: ClassVar[str] = (
        "Row i of A is the vector r_i along the rod, because along its axis the hand is free"
    )

    def shown(self, d: Derivation) -> dict[str, Any]:
        """The equation of a leg."""
        d.explain(
            {
                r"\mathbf w_i": "from the near end of the rod of leg i to the hand",
                r"\mathbf n_i": "direction of the axes of leg i",
                "r_i": "length of the rod of leg i",
            }
        )
        return {
            r"\mathbf w_i": r"\mathbf p + \mathbf e_i - \mathbf b_i",
            r"|\mathbf w_i - (\mathbf n_i^T\mathbf w_i)\,\mathbf n_i|": "r_i",
        }

    def check(self, name: str, legs: Sequence[Leg]) -> None:
        """Refuse legs that would turn the hand, or let it turn."""
        if not all(isinstance(leg, FreeAlong) for leg in legs):
            raise ShapeError(f"{name}: each leg of a hand on cylinders is FreeAlong its axis")
        if loose := [e.joint for e in legs if isinstance(e, FreeAlong) and e.slide is None]:
            raise ShapeError(f"{name}: the leg of {loose[0]} needs its passive slide on the hand")
        axes = [vector(leg.axis) for leg in legs if isinstance(leg, FreeAlong)]
        if sp.simplify(sp.Matrix.hstack(*axes).rank()) == 1:
            raise ShapeError(
                f"{name}: all axes have the same direction, along which nothing holds the hand"
            )


__all__ = ["OnCylinders"]
