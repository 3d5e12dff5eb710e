"""A hand, what holds it on the ground without a motor, and the driven legs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.axial import FreeAlong
from closedform.lemmas.extended import excess_of
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, vector
from closedform.loops.guides import LENGTH, TURNS, Ball, Driven, Gimbal, Guide, Placed
from closedform.loops.hand import check_order, check_plain
from closedform.loops.hinges import Hinges, InPlane
from closedform.loops.leg_by_leg import named_in, size_of
from closedform.loops.mast import Mast
from closedform.loops.on_cylinders import OnCylinders
from closedform.loops.parallel_axes import ParallelAxes
from closedform.loops.spindle import Spindle
from closedform.model.derivation import Derivation
from closedform.model.functions import Program

COUNTS = {2: "two", 3: "three", 4: "four", 5: "five"}
Holder = Guide | Gimbal | Ball | Hinges | ParallelAxes
"""What rules the motion of a hand."""


@dataclass(frozen=True)
class Guided:
    """A hand, what holds it on the ground, and the driven legs."""

    d: Derivation
    guide: Holder
    legs: tuple[Leg, ...]

    def __post_init__(self) -> None:
        name, n = self.d.name, self.guide.legs
        if len(self.legs) != n or any(len(leg.base) != 3 for leg in self.legs):
            raise ShapeError(
                f"{name}: a hand on {self.guide.what} has {COUNTS[n]} driven legs in space"
            )
        kinds = Crank | Slide | Stretch
        if isinstance(self.guide, OnCylinders):
            kinds |= FreeAlong
        if not all(isinstance(leg, kinds) for leg in self.legs):
            raise ShapeError(
                f"{name}: a driven leg beside {self.guide.what} must be a crank, a slide or a "
                f"leg that stretches"
            )
        turning = Guide | Gimbal | InPlane | Spindle | Mast
        if isinstance(self.guide, turning) and self.guide.joint.faulty:
            raise ShapeError(
                f"{name}: the axes of {self.guide.what} must be two unit vectors at right angles"
            )
        check_order(self.d, self.legs, axial=isinstance(self.guide, OnCylinders))
        if isinstance(self.guide, ParallelAxes | Driven):
            self.guide.check(name, self.legs)
        if not isinstance(self.guide, ParallelAxes):
            check_plain(self.d, self.legs)
        if list(self.d.task) not in ([], list(self.guide.task)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(self.guide.task)}")
        self.d.task = list(self.guide.task)

    @property
    def inputs(self) -> dict[str, Any]:
        return self.guide.inputs

    @cached_property
    def places(self) -> list[sp.Matrix]:
        return [vector(leg.on_hand or (0, 0, 0)) for leg in self.legs]

    @property
    def numbered(self) -> list[tuple[int, Leg]]:
        return [*enumerate(self.legs, 1)]

    @property
    def far(self) -> list[str]:
        """The names of the far ends of the legs in the drawing."""
        return ["P" if e.is_zero_matrix else f"C{k}" for k, e in enumerate(self.places, 1)]

    @property
    def pivot(self) -> sp.Matrix:
        return vector(self.guide.pivot)

    @cached_property
    def posture(self) -> Placed:
        """The hand in the joints that hold it, without a program."""
        return self.guide.posture(self.places)

    @property
    def joints(self) -> list[tuple[sp.Symbol, sp.Matrix]]:
        """The joints that hold the hand, each with the axis or the direction of its motion."""
        at = self.posture
        if isinstance(self.guide, Ball | Hinges | ParallelAxes):
            return []
        slide = [(LENGTH, at.slide.ahead)] if at.slide else []
        return [*zip(TURNS, at.turns, strict=True), *slide]

    @cached_property
    def size(self) -> sp.Expr:
        """The sum of all lengths."""
        return size_of(self.d, self.legs, self.guide.moved)

    def placed(self, p: Program) -> Placed:
        """Name the hand at a target in a program, outside of an inverse."""
        return self.guide.place(
            p, self.places, None if isinstance(self.guide, Hinges) else self.size
        )

    @cached_property
    def exact(self) -> Placed:
        """The hand at a target, without names; where a turn is free it is undefined."""
        if isinstance(self.guide, Hinges):
            return self.posture
        p = Program()
        return self.guide.place(p, self.places).explicit(p)

    def closed(self, arms: Sequence[sp.Matrix]) -> tuple[sp.Expr, ...]:
        """The equations of the loop, for far ends of the legs as seen from the pivot."""
        return tuple(
            leg.excess(self.pivot + arm - leg.end())
            if isinstance(leg, FreeAlong)
            else excess_of(leg.rod, self.pivot + arm - leg.end())
            for leg, arm in zip(self.legs, arms, strict=True)
        )

    def rows(self, p: Program, placed: Placed, rods: Sequence[sp.Matrix]) -> list[sp.Matrix]:
        """How the joints that hold the hand stretch the rods, from the vectors along the rods."""
        found = []
        for k, rod in enumerate(rods, 1):
            row = enumerate(placed.row(k - 1, rod), 1)
            found.append(sp.Matrix([[named_in(p, f"D_{k}{i}", e) for i, e in row]]))
        return found


__all__ = ["COUNTS", "Guided", "Holder"]
