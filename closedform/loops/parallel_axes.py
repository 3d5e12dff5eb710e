"""A hand on legs all of whose joints turn it about one direction each, so that it does not turn.

The rods of its legs are parallelograms between two links, as in Tsai's manipulator or a Falcon.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.axial import FreeAlong
from closedform.lemmas.extended import Extended, excess_of, rod_of, stretched_by
from closedform.lemmas.legs import Crank, Leg, Slide, vector
from closedform.loops.guides import Placed, arms_at
from closedform.loops.hand import rate_of
from closedform.loops.held import parallel_axes
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.step import Step


@dataclass(frozen=True)
class ParallelAxes:
    """What holds a hand that does not turn: the axes of each of its three legs are parallel.

    Each leg is a :class:`~closedform.lemmas.legs.Crank` whose rod is
    :class:`~closedform.lemmas.extended.Extended`, or such a
    :class:`~closedform.lemmas.legs.Slide` at right angles to the axes.
    """

    legs: ClassVar[int] = 3
    task: ClassVar[tuple[str, ...]] = ("x", "y", "z")
    degree: ClassVar[int] = 16
    """Of the point of three tori in general, counted with a Groebner basis at random numbers."""
    turning: ClassVar[int] = 0
    own: ClassVar[tuple[str, ...]] = ()
    pivot: ClassVar[tuple[int, ...]] = (0, 0, 0)
    what: ClassVar[str] = "legs with parallel axes"
    holds: ClassVar[str] = "The hand does not turn, and p is its point.  "
    legs_close: ClassVar[str] = (
        "The joint of leg i determines the near end b of its first link.  The far end of its last "
        "link is e, seen from p.  The axes of the leg have the direction n, and so have the bars "
        "of its parallelogram, whose rods have the length r.  Both links, which add up to c, are "
        "at right angles to n and in line.  The rods lead as far as the vector w between the ends "
        "does along n, and by s in the direction of the links."
    )
    follow: ClassVar[str] = "the point of the hand follows"
    left_out: ClassVar[str] = (
        "Left out: postures in which a parallelogram is crossed, or leads back from its first link."
    )
    rods: ClassVar[dict[str, str]] = {
        r"\mathbf r_i": r"y_i\,\mathbf n_i + \frac{s_i}{c_i + s_i}(\mathbf w_i - y_i\,\mathbf n_i)"
    }
    """The vectors along the rods."""
    proves: ClassVar[str] = (
        "Let F be the square of the left side of the equation of a leg, minus that of the right "
        "side.  Its derivative with respect to the target is the row of A, and that with respect "
        "to the joint is minus the entry of B, both times 2*(c_i + s_i)/s_i."
    )
    motion: ClassVar[str] = (
        "A motion of the hand keeps a leg closed if the velocity of its far end, less that of its "
        "near end, is at right angles to the rods of its parallelogram.  So row i of A is the "
        "vector r_i along them"
    )

    @property
    def inputs(self) -> dict[str, Any]:
        return {"x": self.moved}

    @property
    def moved(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, self.task))

    def shown(self, d: Derivation) -> dict[str, Any]:
        """The equation of a leg."""
        d.explain(
            {
                r"\mathbf w_i": "from the near end of leg i to its far end",
                r"\mathbf n_i": "direction of the axes of leg i",
                "y_i": "how far leg i leads along its axes",
                "s_i": "how far the rods of leg i lead in the direction of its links",
                "r_i": "length of the rods of leg i",
                "c_i": "sum of both links of leg i",
            }
        )
        return {
            r"\mathbf w_i": r"\mathbf p + \mathbf e_i - \mathbf b_i",
            "y_i": r"\mathbf n_i^T\mathbf w_i",
            "s_i": r"\sqrt{r_i^2 - y_i^2}",
            r"|\mathbf w_i - y_i\mathbf n_i|": "c_i + s_i",
        }

    def check(self, name: str, legs: Sequence[Leg]) -> None:
        """Refuse legs that would turn the hand, or let it turn."""
        if not all(isinstance(leg, Crank | Slide) for leg in legs) or not all(
            isinstance(leg.rod, Extended) for leg in legs
        ):
            raise ShapeError(
                f"{name}: each leg with parallel axes is a Crank or a Slide whose rod is Extended; "
                f"without links at its ends it is a Parallelogram, in parallel"
            )
        bars = [leg.rod.direction for leg in legs]
        for leg, bar in zip(legs, bars, strict=True):
            if isinstance(leg, Slide):
                if sp.simplify(leg.rate.dot(bar)) != 0:
                    raise ShapeError(
                        f"{name}: {leg.joint} slides along the bars; it has to slide at right "
                        f"angles to them"
                    )
                continue
            axis = vector(leg.along).cross(vector(leg.across))  # type: ignore[attr-defined]
            if any(map(sp.simplify, axis.cross(bar))) or sp.simplify(bar.dot(bar) - 1) != 0:
                raise ShapeError(
                    f"{name}: the bar of {leg.joint} must be a unit vector along the axis of its "
                    f"crank"
                )
        if not any(sp.simplify(e) for bar in bars for e in bar.cross(bars[0])):
            raise ShapeError(
                f"{name}: all axes have the same direction, about which the hand can always turn"
            )

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program."""
        axes, none = tuple(sp.eye(3).col(k) for k in range(3)), sp.zeros(3, 1)
        shift = sp.Matrix(self.moved)
        return Placed(
            rotation=sp.eye(3),
            turns=(none,) * 3,
            shift=shift,
            arms=arms_at(p, sp.eye(3), shift, places),
            moves=axes,
            levers=tuple(places),
        )

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand at a target, without a program."""
        p = Program()
        return self.place(p, places).explicit(p)


def state_axes(d: Derivation, legs: Sequence[Leg], loop: Step) -> None:
    """The step on the axes, which keep the hand from turning."""
    axes = [vector(e.axis) if isinstance(e, FreeAlong) else e.rod.direction for e in legs]
    parallel_axes(d, axes, loop)


def moved_by(
    leg: Leg, span: sp.Matrix, target: Sequence[sp.Symbol]
) -> list[tuple[sp.Expr, sp.Expr]]:
    """How the equation of a leg changes with the target and with its joint."""
    if isinstance(leg, FreeAlong):
        equation, rod, by = leg.excess(span), leg.pull(span), sp.Integer(2)
    else:
        equation, rod = excess_of(leg.rod, span), rod_of(leg.rod, span)
        by = 2 * stretched_by(leg.rod, span)
    return [
        *((equation.diff(x), by * e) for x, e in zip(target, rod, strict=False)),
        (equation.diff(leg.joint), -by * rate_of(leg, rod)),
    ]


__all__ = ["ParallelAxes", "moved_by", "state_axes"]
