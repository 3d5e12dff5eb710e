"""What a hand consists of that two arms and a rod hold, or an arm, a strut and a rod."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, Slide, Strut, vector
from closedform.lemmas.sliding_strut import SlidingStrut
from closedform.loops.hand import check_plain, square
from closedform.loops.points import side_length
from closedform.mechanics.frames import pose_symbols
from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program, real

THIRD = sp.Matrix([real(f"C_{i}") for i in "xyz"])
"""The coordinates of the end of the rod on the hand."""
ARMS, ROD = "arm at right angles to the hand", "rod in the plane of the hand"
STRUT = "strut at right angles to the line of the balls"
DAMPER = "damper in line with the hinge of its arm"


@dataclass(frozen=True)
class Damper:
    """A driven cylinder from the point ``pivot`` of the ground to the first arm.

    It ends at ``on_arm``, which is seen from the base where the angle of the arm is zero.
    """

    joint: sp.Symbol
    pivot: Sequence[Any]
    on_arm: Sequence[Any]

    @property
    def base(self) -> sp.Matrix:
        return vector(self.pivot)

    def crank(self, arm: Crank) -> Crank:
        """The arm as a crank that the damper, which is its rod, turns."""
        u, v = vector(arm.along), vector(arm.across)
        axis, out = u.cross(v), vector(self.on_arm) - arm.base
        aside = out.dot(axis)
        across = (out - aside * axis).applyfunc(sp.simplify)
        length = side_length(across)
        along = (across / length).applyfunc(sp.simplify)
        return Crank(
            arm.joint,
            length,
            self.joint,
            pivot=tuple(arm.base + aside * axis),
            along=tuple(along),
            across=tuple(axis.cross(along)),
        )


@dataclass(frozen=True)
class TwoArms:
    """The arms and the rod of a hand."""

    d: Derivation
    driver: Crank | Slide
    given: Crank | SlidingStrut
    tie: Strut | Slide | Crank
    damper: Damper | None = None

    def __post_init__(self) -> None:
        d, name = self.d, self.d.name
        for leg in (self.driver, self.given, self.tie):
            if not isinstance(leg, Strut | SlidingStrut):
                check_plain(d, [leg])
        legs = (self.driver, self.tie, self.damper)
        if self.damper and not isinstance(self.driver, Crank):
            raise ShapeError(f"{name}: a damper turns an arm, and {self.driver.joint} is a slider")
        passive = (self.driver,) if self.damper else ()
        driven = tuple(e.joint for e in legs if e and e not in passive and not isinstance(e, Strut))
        if driven != d.actuated:
            raise ShapeError(f"{name}: its joints must be those of the driven arm and of the rod")
        if self.driver.rod != 0 or self.given.rod != 0:
            raise ShapeError(f"{name}: both arms end on the hand, so their rods have the length 0")
        if any(len(place) != len(THIRD) for place in self.places):
            raise ShapeError(f"{name}: each arm and the rod end on_hand, at a point in space")
        if self.normal.is_zero_matrix:
            raise ShapeError(f"{name}: the arms and the rod end in line; the hand turns freely")
        d.task = [*map(str, pose_symbols())]
        d.singularities = d.poles = (
            *[DAMPER] * bool(self.damper),
            STRUT if self.strut else ARMS,
            ROD,
        )

    @cached_property
    def pushed(self) -> Crank | None:
        """The first arm as a crank with the damper as its rod, if there is one."""
        return self.damper.crank(self.driver) if self.damper else None  # type: ignore[arg-type]

    @property
    def strut(self) -> SlidingStrut | None:
        """The strut in which the hand slides, if there is one."""
        return self.given if isinstance(self.given, SlidingStrut) else None

    @cached_property
    def pose(self) -> sp.Matrix:
        return pose_symbols()

    @property
    def places(self) -> list[sp.Matrix]:
        """The ends of the arms and of the rod, in the frame of the hand."""
        legs = (self.driver, self.given, self.tie)
        return [
            e.reached(e.joint) if isinstance(e, SlidingStrut) else vector(e.on_hand) for e in legs
        ]

    @property
    def spans(self) -> list[sp.Matrix]:
        """The vectors from the end of the driven arm to the other ends."""
        first, *others = self.places
        return [place - first for place in others]

    @property
    def normal(self) -> sp.Matrix:
        first, second = self.spans
        return first.cross(second).applyfunc(sp.expand)

    @property
    def sides(self) -> list[sp.Expr]:
        """The lengths of the spans, and the distance of their ends."""
        first, second = self.spans
        return [*map(side_length, (first, second, second - first))]

    @property
    def equations(self) -> tuple[sp.Expr, ...]:
        """Those of the loop, with the angle of the arm and the end of the rod as unknowns."""
        b, c, n = self.driver.end(), self.given.end(), self.tie.end()
        (d, e), R, p = self.spans, self.pose[:3, :3], self.pose[:3, 3]
        u, v = c - b, THIRD - b
        rod = sp.sympify(self.tie.rod, strict=True)
        reach = square(u) - square(d)
        pushed = []
        if self.damper and self.pushed:
            pushed = [square(self.pushed.end() - self.damper.base) - self.damper.joint**2]
        turned = (R * d - u, R * e - v, R * d.cross(e) - u.cross(v))
        return (
            *pushed,
            -reach if self.strut else reach,  # as the lemma has it
            square(v) - square(e),
            square(v - u) - square(e - d),
            square(THIRD - n) - rod**2,
            *(entry for equation in turned for entry in equation),
            *(p - b + R * self.places[0]),
            *(x - int(k == 3) for k, x in enumerate(self.pose[3, :])),
        )

    @property
    def rod(self) -> sp.Expr:
        """The equation of the rod."""
        return self.equations[3 + bool(self.damper)]


@dataclass(frozen=True)
class Posture:
    """The hand in an assembly mode, in the names of a program."""

    program: Program
    modes: Branches
    position: sp.Matrix
    rotation: sp.Matrix
    ends: tuple[sp.Matrix, sp.Matrix, sp.Matrix]
    """Those of the arms and of the rod on the hand."""
    spans: Sequence[sp.Matrix]
    """The vectors from the first of these to the others."""
    near: sp.Matrix
    """The other end of the rod."""
    pushed: sp.Matrix | None = None
    """The end of the damper on the first arm."""


__all__ = ["THIRD", "Damper", "Posture", "TwoArms"]
