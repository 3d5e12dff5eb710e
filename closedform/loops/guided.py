"""A hand on a passive leg that rules its motion, and three driven legs: the Tricept.

The passive leg has a universal joint on the ground and a slide, to whose end the hand is fixed.  So
the joints of this leg are the three degrees of freedom of the hand.

:func:`guided` derives what has a closed form: the pose of the hand, the inverse with all working
modes, the velocity and the singular sets.  The forward problem is an equation of high degree, and
no ``fk`` is derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, vector
from closedform.loops.hand import check_order, check_plain, rate_of, square
from closedform.loops.leg_by_leg import MISSED, LegByLeg, named_in, signs_of_modes, size_of
from closedform.loops.skeleton import Drawing, points_of
from closedform.mechanics.frames import rotation
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real
from closedform.model.step import Step

TASK = ("turn_1", "turn_2", "length")
DEGREE = 28
"""Of the forward problem in general, counted with a Groebner basis at numbers drawn at random."""
TOGETHER = "The target and the joints have to belong together, as ik gives them."


@dataclass(frozen=True)
class Guide:
    """A passive leg: a universal joint at ``pivot``, and a slide that carries the hand.

    The universal joint turns the leg about ``first``, which is fixed to the ground, and about
    ``second``; both are unit vectors in numbers, at right angles.  Where both angles are zero, the
    leg has the direction ``first x second``, and the hand is not turned.  The point of the hand is
    on the line of the leg.  ``slide`` is the passive joint, for the drawing.
    """

    slide: sp.Symbol
    pivot: Sequence[Any]
    first: Sequence[Any]
    second: Sequence[Any]

    @property
    def axes(self) -> tuple[sp.Matrix, sp.Matrix, sp.Matrix]:
        """Both axes and the leg, where the hand is not turned."""
        a, b = vector(self.first), vector(self.second)
        return a, b, a.cross(b)


@dataclass(frozen=True)
class Placed:
    """The hand at a target, in the names of a program."""

    rotation: sp.Matrix
    second: sp.Matrix
    """The second axis of the passive leg, where the first one has turned it."""
    ahead: sp.Matrix
    """The direction of the passive leg."""
    arms: tuple[sp.Matrix, ...]
    """The ends of the legs, from the pivot of the passive leg."""


@dataclass(frozen=True)
class Guided:
    """A hand on a passive leg, and the driven legs."""

    d: Derivation
    guide: Guide
    legs: tuple[Leg, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != 3 or any(len(leg.base) != 3 for leg in self.legs):
            raise ShapeError(f"{name}: a hand on a passive leg has three driven legs in space")
        if not all(isinstance(leg, Crank | Slide | Stretch) for leg in self.legs):
            raise ShapeError(
                f"{name}: a driven leg beside a passive one must be a crank, a slide or a leg that "
                f"stretches"
            )
        a, b, _ = self.guide.axes
        if any(sp.simplify(e) != 0 for e in (square(a) - 1, square(b) - 1, a.dot(b))):
            raise ShapeError(
                f"{name}: the axes of the passive leg must be two unit vectors at right angles"
            )
        check_order(self.d, self.legs)
        check_plain(self.d, self.legs)
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of this hand must be {', '.join(TASK)}")
        self.d.task = list(TASK)

    @cached_property
    def target(self) -> sp.Matrix:
        return sp.Matrix([real(n) for n in TASK])

    @property
    def places(self) -> list[sp.Matrix]:
        return [vector(leg.on_hand or (0, 0, 0)) for leg in self.legs]

    @property
    def numbered(self) -> list[tuple[int, Leg]]:
        return [*enumerate(self.legs, 1)]

    @property
    def far(self) -> list[str]:
        """The names of these ends in the drawing."""
        return ["P" if e.is_zero_matrix else f"C{k}" for k, e in enumerate(self.places, 1)]

    def placed(self, p: Program) -> Placed:
        """Name the hand at a target in a program."""
        turn_1, turn_2, length = self.target
        home = sp.Matrix.hstack(*self.guide.axes)
        tilted = home * rotation("x", turn_1)
        R = p.matrix("R", tilted * rotation("y", turn_2) * home.T)
        second = sp.Matrix(
            [named_in(p, f"v_{i}", e) for i, e in zip("xyz", tilted.col(1), strict=True)]
        )
        ahead = sp.Matrix(
            [named_in(p, f"u_{i}", e) for i, e in zip("xyz", R * self.guide.axes[2], strict=True)]
        )
        arms = []
        for k, place in enumerate(self.places, 1):
            far = enumerate(length * ahead + R * place, 1)
            arms.append(sp.Matrix([named_in(p, f"f_{k}{i}", e) for i, e in far]))
        return Placed(R, second, ahead, tuple(arms))

    @cached_property
    def posture(self) -> Placed:
        """The hand in its coordinates, without a program."""
        p = Program()
        at = self.placed(p)
        parts = (at.rotation, at.second, at.ahead, *at.arms)
        R, second, ahead, *arms = (part.applyfunc(p.explicit) for part in parts)
        return Placed(R, second, ahead, tuple(arms))

    @property
    def pivot(self) -> sp.Matrix:
        return vector(self.guide.pivot)

    @property
    def loop(self) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length."""
        return tuple(
            square(self.pivot + arm - leg.end()) - sp.sympify(leg.rod, strict=True) ** 2
            for leg, arm in zip(self.legs, self.posture.arms, strict=True)
        )

    def rows(self, p: Program, placed: Placed, rods: Sequence[sp.Matrix]) -> list[sp.Matrix]:
        """The rows of A, from the vectors along the rods."""
        found = []
        for k, (arm, rod) in enumerate(zip(placed.arms, rods, strict=True), 1):
            named = [named_in(p, f"m_{k}{i}", e) for i, e in enumerate(arm.cross(rod), 1)]
            moment = sp.Matrix(named)
            row = moment.dot(self.guide.axes[0]), moment.dot(placed.second), rod.dot(placed.ahead)
            found.append(sp.Matrix([[named_in(p, f"A_{k}{i}", e) for i, e in enumerate(row, 1)]]))
        return found


def guided(d: Derivation, guide: Guide, legs: Sequence[Leg]) -> None:
    """Derive and export a hand on a passive leg, which three driven legs move.

    Its task is the joints of the passive leg: ``turn_1`` and ``turn_2`` about the axes of its
    universal joint, and its ``length`` from there to the point of the hand.  It exports
    ``hand_pose``, ``ik``, ``jacobian_parallel`` (A), ``jacobian_serial`` (the diagonal of B),
    ``jacobian_inverse`` (B^-1*A), ``jacobian``, ``determinant``, ``singularities``, ``skeleton``
    and, where the reach of the legs is limited, ``workspace_contains``.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        If it has no ``singularities``, they are named after the legs
    guide
        the passive leg
    legs
        three: cranks, slides or legs that stretch; ``on_hand`` is seen from the point of the hand,
        where the hand is not turned
    """
    m = Guided(d, guide, tuple(legs))
    if not d.singularities:
        d.singularities = ("leg 1", "leg 2", "leg 3", "all legs")
    placed = _place(m)
    loop = _close(m, placed)
    _velocity(m, loop)
    _draw(m)
    _inverse(m, loop)


def _place(m: Guided) -> Step:
    """The step on the pose of the hand, and the functions that return it and its inverse."""
    d, p, at = m.d, m.d.program(), m.posture
    placed = m.placed(p)
    a, b, c = m.guide.axes
    turn_1, turn_2, length = m.target
    position = m.pivot + length * at.ahead
    d.explain(
        {
            r"\mathbf v": "second axis of the passive leg",
            r"\mathbf u": "direction of the passive leg",
            "R": "rotation of the hand",
            r"\mathbf p": "position of the point of the hand",
        }
    )
    step = d.step(
        "Pose of the hand",
        "The universal joint of the passive leg turns it by turn_1 about an axis that is fixed to "
        "the ground, and by turn_2 about the axis v, which the first turn moves.  The hand is "
        "fixed to the end of the leg, whose direction is u.  So R is the rotation of the hand, "
        "and its point p is ahead of the pivot by the length of the leg.  Let X, Y and Z be the "
        "coordinates of u along the two axes and the leg where nothing is turned.  A position of "
        "the hand gives the length and u, and so both turns: turn_1 = atan2(-Y, Z) and turn_2 = "
        "atan2(X, sqrt(Y^2 + Z^2)), or the same with -Y, -Z and -sqrt(Y^2 + Z^2), where the hand "
        "is turned by half a turn about the leg.",
        {"R": at.rotation, r"\mathbf v": at.second, r"\mathbf u": at.ahead, r"\mathbf p": position},
        proves="R is a rotation and keeps the first axis fixed to the ground at right angles to v. "
        "The coordinates of u along the axes and the leg before they turn are those three, and the "
        "axes of the passive leg are unit vectors at right angles.",
        equal=[
            (at.rotation.T * at.rotation, sp.eye(3)),
            (at.second.dot(a), sp.S.Zero),
            (at.second.dot(at.ahead), sp.S.Zero),
            (at.rotation * b, at.second),
            (
                sp.Matrix([axis.dot(at.ahead) for axis in (a, b, c)]),
                sp.Matrix(
                    [
                        sp.sin(turn_2),
                        -sp.sin(turn_1) * sp.cos(turn_2),
                        sp.cos(turn_1) * sp.cos(turn_2),
                    ]
                ),
            ),
            (sp.Matrix([square(a), square(b), a.dot(b)]), sp.Matrix([1, 1, 0])),
        ],
    )
    T = placed.rotation.row_join(m.pivot + length * placed.ahead)
    d.function(
        "hand_pose",
        "Pose of the hand, from the joints of the passive leg.",
        {"x": tuple(m.target)},
        {"T": sp.Matrix.vstack(T, sp.Matrix([[0, 0, 0, 1]]))},
        program=p,
        notes=(
            "Conversely, turn_1 = atan2(-Y, Z), turn_2 = atan2(X, sqrt(Y^2 + Z^2)) and length = "
            "sqrt(X^2 + Y^2 + Z^2) bring the hand to the point that is at X and Y along the two "
            "axes of the passive leg and at Z along the leg, where nothing is turned, from its "
            "pivot.",
        ),
    )
    return step


def _close(m: Guided, placed: Step) -> Step:
    rows = (
        (str(k), leg.end().T, place.T, sp.sympify(leg.rod, strict=True))
        for (k, leg), place in zip(m.numbered, m.places, strict=True)
    )
    m.d.loop = loop = m.d.step(
        "The loop",
        "The joint of leg i determines the near end b of its rod.  The far end is e in the frame "
        "of the hand, seen from its point p.  The rod keeps the distance of its ends: |p + R*e - "
        "b| is its length.",
        {},
        rows=[("i", "b", "e", "length of the rod"), *rows],
        uses=[placed],
    )
    m.d.step(
        f"Forward: an equation of degree {DEGREE}",
        "If the joints are given, the turns and the length of the passive leg follow from three "
        f"equations, which have to be solved together.  In general they have {DEGREE} complex "
        "solutions.  No formula is derived for it.",
        {},
        uses=[loop],
    )
    return loop


def _velocity(m: Guided, loop: Step) -> None:
    """A*dx = B*dq, in the joints x of the passive leg."""
    d, p, at = m.d, m.d.program(), m.posture
    placed = m.placed(p)
    rods = []
    for (k, leg), arm in zip(m.numbered, placed.arms, strict=True):
        near = [named_in(p, f"b_{k}{i}", e) for i, e in enumerate(leg.end(), 1)]
        rod = m.pivot + arm - sp.Matrix(near)
        rods.append(sp.Matrix([named_in(p, f"r_{k}{i}", e) for i, e in enumerate(rod, 1)]))
    rows = m.rows(p, placed, rods)
    driven = [
        named_in(p, f"B_{k}{k}", rate_of(leg, rod))
        for (k, leg), rod in zip(m.numbered, rods, strict=True)
    ]
    A = sp.Matrix.vstack(*rows)
    volume = p.let("Delta", A.det())
    turn_1, turn_2, length = m.target
    exact = [m.pivot + arm - leg.end() for leg, arm in zip(m.legs, at.arms, strict=True)]
    r, f, w = (sp.Matrix([real(f"{n}_{i}") for i in "xyz"]) for n in ("r", "f", "omega"))
    d.explain(
        {
            r"\mathbf f_i": "from the pivot of the passive leg to the far end of rod i",
            r"\mathbf r_i": "vector along rod i",
            r"\mathbf a_i": "row i of A",
            r"\mathbf a": "first axis of the passive leg",
            "B_{ii}": "entry of the diagonal of B",
        }
    )
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations, halved, give A*dx = B*dq for the rates of the "
        "joints x of the passive leg.  The turns move the far end of rod i, which is at f_i from "
        "the pivot, about the first axis and about v, and the length moves it along u.  So row i "
        "of A is the moment of the vector r_i along rod i about both axes, and its part along u.  "
        "B is diagonal, because each leg depends on its own joint alone.  B is singular if the "
        "joint moves the near end of a rod at right angles to it (serial: the joint moves and the "
        "hand stands still).  A is singular if the rods do not hold the hand (parallel: the hand "
        "can move while the joints stand still).",
        {
            r"\mathbf a_i": r"\begin{bmatrix}\mathbf a^T(\mathbf f_i\times\mathbf r_i) & "
            r"\mathbf v^T(\mathbf f_i\times\mathbf r_i) & \mathbf u^T\mathbf r_i\end{bmatrix}",
            "B_{ii}": r"\mathbf r_i^T\,\frac{\partial\mathbf b_i}{\partial q_i}",
        },
        proves="The derivative of each f_i with respect to x is that of a point that turns about "
        "the first axis and v and moves along u.  The product of r_i with a velocity of turning is "
        "its moment.  The derivative of each loop equation with respect to its joint is minus "
        "twice the entry of B.",
        equal=[
            *(
                pair
                for arm in at.arms
                for pair in (
                    (arm.diff(turn_1), m.guide.axes[0].cross(arm)),
                    (arm.diff(turn_2), at.second.cross(arm)),
                    (arm.diff(length), at.ahead),
                )
            ),
            (r.dot(w.cross(f)), w.dot(f.cross(r))),
            *(
                (e.diff(leg.joint), -2 * rate_of(leg, rod))
                for leg, rod, e in zip(m.legs, exact, m.loop, strict=True)
            ),
        ],
        uses=[loop],
    )
    J = A.adjugate() * sp.diag(*driven) / volume
    pole = "Not finite at a parallel singularity."
    exported: list[tuple[str, str, dict[str, Any], tuple[str, ...]]] = [
        ("jacobian_parallel", "A of A*dx = B*dq.", {"A": A}, ()),
        (
            "jacobian_serial",
            "The diagonal of B of A*dx = B*dq.",
            {"B": driven},
            signs_of_modes(m.legs),
        ),
        (
            "jacobian_inverse",
            "B^-1*A: joint rates per rate of the passive leg.",
            {"K": sp.Matrix.vstack(*(row / b for row, b in zip(rows, driven, strict=True)))},
            ("Not finite at a serial singularity.",),
        ),
        ("jacobian", "Derivative of the target with respect to q: A^-1*B.", {"J": J}, (pole,)),
        ("determinant", "Determinant of the Jacobian.", {"det": sp.Mul(*driven) / volume}, (pole,)),
        (
            "singularities",
            "The diagonal of B (serial) and the determinant of A (parallel).",
            {"factors": [*driven, volume]},
            (),
        ),
    ]
    for name, summary, outputs, notes in exported:
        d.function(
            name,
            summary,
            {"x": tuple(m.target), "q": d.actuated},
            outputs,
            program=p,
            notes=(TOGETHER, *notes),
        )


def _draw(m: Guided) -> None:
    """The skeleton: pivot O, bases A, near ends B and far ends C of the legs, and P, the hand."""
    d, p, at = m.d, m.d.program(), m.posture
    placed = m.placed(p)

    def points(placed: Placed) -> dict[str, Sequence[Any]]:
        hand = m.pivot + m.target[2] * placed.ahead
        found: dict[str, Sequence[Any]] = {"O": [*m.pivot], "P": [*hand]}
        for (k, leg), arm, far in zip(m.numbered, placed.arms, m.far, strict=True):
            found |= points_of(k, leg, far, m.pivot + arm)
        return found

    drawn = Drawing({"ground": ("A1", "A2", "A3", "A1")}, {("O", "P"): m.target[2]})
    drawn.joints[m.guide.slide] = ("O", "P")
    for (k, leg), place, far, equation in zip(m.numbered, m.places, m.far, m.loop, strict=True):
        drawn.add_leg(k, leg, far, equation)
        if far != "P":
            drawn.links[f"hand{k}"] = ("P", far)
            drawn.lengths["P", far] = sp.sqrt(sp.factor(sp.trigsimp(square(place))))
    skeleton(
        d,
        points(placed),
        links=drawn.links,
        joints=drawn.joints,
        hand="P",
        ground=("O", "A1", "A2", "A3"),
        lengths=drawn.lengths,
        pose={"x": tuple(m.target)},
        program=p,
        notes=(TOGETHER,),
        at_posture=[points(at)],
        closing=drawn.closing,
    )


def _inverse(m: Guided, loop: Step) -> None:
    d, g = m.d, m.d.program()
    size = g.let("size", size_of(d, m.legs, m.target[2:]))
    solved = LegByLeg(d, g, size)
    placed = m.placed(g)
    for (k, leg), arm in zip(m.numbered, placed.arms, strict=True):
        solved.solve(k, leg, m.pivot + arm - leg.base)
    rows = m.rows(g, placed, [s.rod for s in solved.found])
    volume = g.let("Delta", sp.Matrix.vstack(*rows).det())
    spread = sp.Add(*(square(arm) for arm in placed.arms)) / 3
    least = g.let("least", solved.lengths(m.legs) * spread, nonnegative=True)
    meet = "the rods do not hold the hand"
    g.determined(
        sp.Abs(volume),
        least,
        meet,
        name=r"|\det A|",
        scale_name=r"\Lambda",
        missed=solved.missed,
        size=solved.size,
    )
    d.step(
        "Inverse: leg by leg",
        f"The target gives the pose of the hand, and each leg is solved alone.  {solved.on_modes}"
        "Near a parallel singularity rounded joints do not determine the hand.  The status is "
        "SINGULAR if the determinant of A is less than 2^-10 of Lambda, the product of the lengths "
        "of the rods and the mean square distance of their far ends from the pivot of the passive "
        f"leg.  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        {"x": tuple(m.target)},
        {"x": tuple(m.target)},
        "UNREACHABLE: a rod does not reach.",
        [
            f"SINGULAR also near a parallel singularity, where {meet}: the loop closes, but the "
            "joints do not determine the hand.",
            f"fk is not derived: the forward problem is an equation of degree {DEGREE}.",
        ],
    )
    solved.certify(m.loop)


__all__ = ["Guide", "guided"]
