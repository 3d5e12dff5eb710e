"""A hand whose three legs hinges on the ground keep in planes that meet in one point alone.

Such as a 3-RPS cube mechanism: the hand turns freely, and its place follows from its rotation.  If
the planes share a line, the hand moves along it, and is that of a tripod.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Leg
from closedform.loops.guides import Ball, Placed, arms_at
from closedform.loops.hinges import Hinged
from closedform.loops.leg_by_leg import named
from closedform.mechanics.frames import hat
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.step import Step

LEGS = 3


@dataclass(frozen=True)
class ThreePlanes(Ball):
    """What holds a hand on three hinged legs, whose planes meet in one point.

    Each leg is :class:`~closedform.loops.hinges.Hinged` on the ground.
    """

    pivot: Sequence[Any] = (0, 0, 0)
    hinged: tuple[Hinged, ...] = ()

    degree: ClassVar[int] = 16
    """Of three points of a body that are on given circles."""
    what: ClassVar[str] = "three planes"
    holds: ClassVar[str] = ""
    follow: ClassVar[str] = "the rotation follows"
    motion: ClassVar[str] = (
        "The hand turns the far end of rod i, which is at e_i from its point, with its angular "
        "velocity, and moves its point by V times the angular velocity.  So row i of A is the "
        "moment of the vector r_i along rod i about the point, and V^T*r_i"
    )

    def with_legs(self, name: str, legs: Sequence[Leg | Hinged]) -> ThreePlanes:
        """The same, with its legs."""
        found = [leg for leg in legs if isinstance(leg, Hinged) and leg.on_ground]
        for leg in found:
            leg.check(name)
        if not len(found) == len(legs) == LEGS:
            raise ShapeError(f"{name}: a hand in three planes has three legs Hinged on_ground")
        planes = replace(self, hinged=tuple(found))
        if sp.simplify(planes.normals.det()) == 0:
            raise ShapeError(
                f"{name}: the planes of the legs share a direction, in which nothing holds the "
                f"hand; if it is that of the z axis, take tripod"
            )
        return planes

    @property
    def normals(self) -> sp.Matrix:
        """The normals of the planes, as rows."""
        return sp.Matrix.vstack(*(leg.axis.T for leg in self.hinged))

    def shift(self, R: sp.Matrix, places: Sequence[sp.Matrix]) -> sp.Matrix:
        """The point of the hand."""
        ends = zip(self.hinged, places, strict=True)
        off = sp.Matrix([leg.axis.dot(leg.leg.base - R * place) for leg, place in ends])
        return (self.normals.inv().applyfunc(sp.simplify) * off).applyfunc(sp.expand)

    def moved_by(self, levers: Sequence[sp.Matrix]) -> sp.Matrix:
        """V, which takes the angular velocity to the velocity of the point of the hand."""
        rows = [leg.axis.cross(e).T for leg, e in zip(self.hinged, levers, strict=True)]
        return self.normals.inv().applyfunc(sp.simplify) * sp.Matrix.vstack(*rows)

    def place(self, p: Program, places: Sequence[sp.Matrix], size: sp.Expr | None = None) -> Placed:
        """Name the hand at a target in a program."""
        R, none = self.rotation, sp.zeros(3, 1)
        levers = arms_at(p, R, none, places, "e")
        shift = named(p, "p", self.shift(R, places))
        V = p.matrix("V", self.moved_by(levers))
        return Placed(
            rotation=R,
            turns=tuple(sp.eye(3).col(k) for k in range(3)),
            shift=shift,
            arms=arms_at(p, R, shift, places),
            moves=tuple(V.col(k) for k in range(3)),
            levers=levers,
        )

    def posture(self, places: Sequence[sp.Matrix]) -> Placed:
        """The hand by its rotation, without a program."""
        p = Program()
        return self.place(p, places).explicit(p)


def state_planes(d: Derivation, guide: ThreePlanes, places: Sequence[sp.Matrix]) -> Step:
    """The step on the place of the hand, and the function that returns its pose."""
    R, w = guide.rotation, sp.Matrix([real(f"omega_{i}") for i in "xyz"])
    p = d.program()
    placed = guide.place(p, places)
    shift, levers = guide.shift(R, places), [R * place for place in places]
    V = guide.moved_by(levers)
    d.explain({r"\mathbf p": "position of the point of the hand"})
    rows = [
        (str(k), leg.axis.T, leg.leg.base.T, place.T)
        for k, (leg, place) in enumerate(zip(guide.hinged, places, strict=True), 1)
    ]
    ends = [*zip(guide.hinged, levers, strict=True)]
    step = d.step(
        "Place of the hand",
        "A hinge on the ground keeps leg i in a plane with the normal n, which passes a, and its "
        "far end is e in the frame of the hand.  So n^T*(p + R*e - a) is zero.  The normals are a "
        "basis, so these three linear equations give the point p of the hand, for each rotation R.",
        {r"\mathbf p": shift},
        rows=[("i", "n", "a", "e"), *rows],
        proves="This point satisfies the equations, and the rates of p that they allow are V "
        "times the angular velocity.",
        equal=[
            *((leg.axis.dot(shift + e - leg.leg.base), sp.S.Zero) for leg, e in ends),
            *((leg.axis.dot(V * w + hat(w) * e), sp.S.Zero) for leg, e in ends),
        ],
    )
    T = R.row_join(placed.shift).col_join(sp.Matrix([[0, 0, 0, 1]]))
    d.function(
        "hand_pose",
        "Pose of the hand, which its rotation determines.",
        guide.inputs,
        {"T": T},
        program=p,
    )
    return step


__all__ = ["ThreePlanes", "state_planes"]
