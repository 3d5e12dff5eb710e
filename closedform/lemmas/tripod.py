"""A tripod: three legs in upright planes carry a hand that lifts and tilts, as in the 3-PRS.

The planes share a vertical axis.  A leg is hinged, so that it stays in its plane, and a ball joint
carries the hand at its end.  The hand has three freedoms: it lifts and tilts in two directions.
It also twists and moves sideways: this parasitic motion follows from them in closed form.

:func:`tripod` derives what has a closed form: the place of the hand, the inverse with all working
modes, the velocity and the singular sets.  The forward problem leads to an equation of degree 16,
and no ``fk`` is derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import sympy as sp

from closedform.algebra.shapes import ShapeError
from closedform.lemmas.hand import check_order, check_plain, rate_of, square
from closedform.lemmas.leg_by_leg import LegByLeg, named_in, signs_of_modes, size_of
from closedform.lemmas.legs import Crank, Leg, Slide, Stretch, cross_in_plane, vector
from closedform.mechanics.frames import rotation
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation, Step
from closedform.model.functions import Program, Vanishes, choose, real

TASK = ("z", "tilt_x", "tilt_y")
DEGREE = 16
"""Of the forward problem of a tripod in general: three circles that carry a triangle."""
TOGETHER = "The target and the joints have to belong together, as ik gives them."


@dataclass(frozen=True)
class Upright:
    """A leg that stays in an upright plane through the z axis, and carries a corner of the hand.

    The plane contains the z axis and ``heading``, a horizontal unit vector in numbers.  In this
    plane the ``leg`` is seen with two coordinates: the distance from the z axis along ``heading``,
    and the height.  ``corner`` is the end of the leg on the hand, as x and y in the frame of the
    hand.
    """

    leg: Leg
    heading: Sequence[Any]
    corner: Sequence[Any]

    @property
    def along(self) -> sp.Matrix:
        return vector(self.heading)

    @property
    def normal(self) -> sp.Matrix:
        """The normal of the plane, horizontal."""
        return sp.Matrix([-self.along[1], self.along[0]])

    def in_space(self, place: sp.Matrix) -> list[sp.Expr]:
        """A point of the plane: distance from the z axis and height."""
        return [*(place[0] * self.along), place[1]]


def tripod(d: Derivation, legs: Sequence[Upright]) -> None:
    """Derive and export a hand that three legs in upright planes lift and tilt.

    Its task is the height z of the point of the hand, and the tilts: the hand is first twisted
    about its own z axis, then turned by ``tilt_x`` about the x axis of the base, and by ``tilt_y``
    about the y axis.  It exports ``hand_pose``, ``ik``, ``jacobian_parallel`` (A),
    ``jacobian_serial`` (the diagonal of B), ``jacobian_inverse`` (B^-1*A), ``jacobian``,
    ``determinant``, ``singularities``, ``skeleton`` and, where the reach of the legs is limited,
    ``workspace_contains``.

    Parameters
    ----------
    d
        the derivation, with its parameters and joints; the legs are in the order of the joints.
        If it has no ``singularities``, they are named after the legs
    legs
        three, in planes of different headings; see :class:`Upright`
    """
    m = Tripod(d, tuple(legs))
    if not d.singularities:
        d.singularities = ("leg 1", "leg 2", "leg 3", "all legs", "twist")
    placed = _place(m)
    loop = _close(m, placed)
    _velocity(m, loop)
    _draw(m)
    _inverse(m, loop)


@dataclass(frozen=True)
class Placed:
    """The hand at a target, in the names of a program."""

    program: Program
    turn: tuple[sp.Expr, sp.Expr]
    """The cosine and the sine of the twist."""
    delta: sp.Expr
    rotation: sp.Matrix
    position: sp.Matrix
    arms: tuple[sp.Matrix, ...]
    """The corners, from the point of the hand, in the base frame."""

    def corner(self, leg: Upright, k: int) -> sp.Matrix:
        """The corner of a leg, in its plane."""
        far = self.position + self.arms[k]
        return sp.Matrix([leg.along.dot(far[:2, 0]), far[2]])


@dataclass(frozen=True)
class Tripod:
    """The legs of a tripod."""

    d: Derivation
    legs: tuple[Upright, ...]

    def __post_init__(self) -> None:
        name = self.d.name
        if len(self.legs) != 3:
            raise ShapeError(f"{name}: a tripod has three legs, not {len(self.legs)}")
        for upright in self.legs:
            leg = upright.leg
            if not isinstance(leg, Crank | Slide | Stretch) or not all(
                len(v) == 2 for v in (upright.heading, upright.corner, leg.base, leg.rate)
            ):
                raise ShapeError(
                    f"{name}: a leg of a tripod is a crank, a slide or a stretching leg in a "
                    f"plane, so its vectors have 2 entries"
                )
            if not square(upright.along).is_number or sp.simplify(square(upright.along) - 1) != 0:
                raise ShapeError(f"{name}: a heading is a unit vector, in numbers")
        check_order(self.d, [upright.leg for upright in self.legs])
        check_plain(self.d, [upright.leg for upright in self.legs])
        if any(weight == 0 for weight in self.weights):
            raise ShapeError(f"{name}: two legs are in the same plane")
        if list(self.d.task) not in ([], list(TASK)):
            raise ShapeError(f"{name}: the task of a tripod is {', '.join(TASK)}")
        if not self.side:
            raise ShapeError(
                f"{name}: the corners do not say which way the hand is turned at rest; their "
                f"coordinates need parameters that are positive"
            )
        self.d.task = list(TASK)

    @cached_property
    def target(self) -> tuple[sp.Symbol, ...]:
        return tuple(map(real, TASK))

    @property
    def size(self) -> sp.Expr:
        """The sum of the distances of the corners from the axes of the hand."""
        return sp.Add(*(sp.Abs(e) for leg in self.legs for e in vector(leg.corner)))

    @cached_property
    def weights(self) -> tuple[sp.Expr, ...]:
        """Factors with which the normals of the planes add up to zero."""
        n = [leg.normal for leg in self.legs]
        return tuple(sp.simplify(cross_in_plane(n[(k + 1) % 3], n[(k + 2) % 3])) for k in range(3))

    @cached_property
    def tilted(self) -> sp.Matrix:
        """The rotation without the twist."""
        _, a, b = self.target
        return rotation("y", b) * rotation("x", a)

    def balance(self, turned: bool) -> sp.Expr:
        """The sum over the legs of weight*n*e, for the corners e as they are, or a right angle on.

        With the twist psi, the first times cos(psi) plus the second times sin(psi) vanishes.
        """
        total = sp.S.Zero
        for weight, leg in zip(self.weights, self.legs, strict=True):
            x, y = vector(leg.corner)
            e = sp.Matrix([-y, x, 0] if turned else [x, y, 0])
            total += weight * leg.normal.dot((self.tilted * e)[:2, 0])
        return sp.collect(sp.expand(total), [sp.cos(t) for t in self.target])

    @cached_property
    def side(self) -> int:
        """The sign of the second sum if the hand is level and not twisted; 0 if it is unknown."""
        level = sp.simplify(self.balance(turned=True).subs(dict.fromkeys(self.target, 0)))
        return int(bool(level.is_positive)) - int(bool(level.is_negative))

    @property
    def numbered(self) -> list[tuple[int, Upright]]:
        return [*enumerate(self.legs, 1)]

    def placed(self, p: Program, *, guarded: bool = False) -> Placed:
        """Name in a program what the target says of the hand; ``guarded`` where the twist is free.

        There the hand is not twisted, instead of being nowhere.
        """
        side = sp.Integer(self.side)
        f = p.let("f", side * self.balance(turned=False))
        g = p.let("g", side * self.balance(turned=True))
        delta = p.let("delta", sp.sqrt(f**2 + g**2), nonnegative=True)
        cosine, sine = g / delta, -f / delta
        if guarded:
            free = p.vanishes("untwisted", delta, self.size, "the twist of the hand is free")
            cosine, sine = choose(free, 1, cosine), choose(free, 0, sine)
        c, s = p.let("c", cosine), p.let("s", sine)
        first, second, third = (self.tilted.col(k) for k in range(3))
        columns = [c * first + s * second, c * second - s * first, third]
        R = p.matrix("R", sp.Matrix.hstack(*columns))
        arms = []
        for k, leg in self.numbered:
            x, y = vector(leg.corner)
            arm = R.col(0) * x + R.col(1) * y
            arms.append(sp.Matrix([named_in(p, f"h_{k}{i}", e) for i, e in enumerate(arm, 1)]))
        n = [leg.normal for leg in self.legs]
        off = [named_in(p, f"beside_{k + 1}", n[k].dot(arms[k][:2, 0])) for k in range(2)]
        across = self.weights[2]
        x = named_in(p, "px", (n[0][1] * off[1] - n[1][1] * off[0]) / across)
        y = named_in(p, "py", (n[1][0] * off[0] - n[0][0] * off[1]) / across)
        return Placed(p, (c, s), delta, R, sp.Matrix([x, y, self.target[0]]), tuple(arms))

    @cached_property
    def posture(self) -> Placed:
        """The hand in the angles of the target and the twist psi, without a program."""
        psi = real("psi")
        turned = self.tilted * rotation("z", psi)
        arms = tuple(turned * sp.Matrix([*vector(leg.corner), 0]) for leg in self.legs)
        n = [leg.normal for leg in self.legs]
        off = [n[k].dot(arms[k][:2, 0]) for k in range(2)]
        sideways = sp.Matrix([n[0].T, n[1].T]).LUsolve(-sp.Matrix(off))
        position = sp.Matrix([*sideways, self.target[0]])
        pair = (sp.cos(psi), sp.sin(psi))
        return Placed(Program(), pair, sp.S.One, turned, position, arms)

    @property
    def twisting(self) -> sp.Expr:
        """What vanishes for the right twist psi."""
        c, s = self.posture.turn
        f, g = (self.side * self.balance(turned) for turned in (False, True))
        return f * c + g * s

    def rows(self, placed: Placed, rods: Sequence[sp.Matrix], delta: sp.Expr) -> list[sp.Matrix]:
        """The rows of A, from the vectors along the rods; ``delta`` is what divides."""
        p, at, psi, tilts = placed.program, self.posture, real("psi"), self.target[1:]
        held = dict(zip(at.turn, placed.turn, strict=True))
        follows = [
            named_in(p, f"twist_{t}", -self.twisting.diff(t).xreplace(held) / delta) for t in tilts
        ]
        rows = []
        for k, (leg, rod) in enumerate(zip(self.legs, rods, strict=True)):
            far, row = at.corner(leg, k), [rod[1]]
            for t, follow in zip(tilts, follows, strict=True):
                rate = far.diff(t).xreplace(held) + far.diff(psi).xreplace(held) * follow
                row.append(named_in(p, f"A_{k + 1}{len(row) + 1}", rod.dot(rate)))
            rows.append(sp.Matrix([row]))
        return rows

    def loop(self, placed: Placed) -> tuple[sp.Expr, ...]:
        """The equations of the loop: each rod keeps its length."""
        return tuple(
            square(placed.corner(leg, k) - leg.leg.end())
            - sp.sympify(leg.leg.rod, strict=True) ** 2
            for k, leg in enumerate(self.legs)
        )


def _place(m: Tripod) -> Step:
    """The step on the place of the hand, and the function that returns it."""
    d, at = m.d, m.posture
    p = d.program()
    placed = m.placed(p)
    side, (c, s) = sp.Integer(m.side), at.turn
    f, g = (side * m.balance(turned) for turned in (False, True))
    far = [at.position + arm for arm in at.arms]
    aside = [leg.normal.dot(e[:2, 0]) for leg, e in zip(m.legs, far, strict=True)]
    d.write("psi", r"\psi", "twist of the hand about its own z axis")
    d.explain({"f": "coefficient of cos(psi) in the equation of the twist"})
    d.explain({"g": "coefficient of sin(psi) in the equation of the twist"})
    step = d.step(
        "The place of the hand",
        "The hand is twisted by psi about its own z axis and tilted.  Its position is p, and the "
        "corner of leg i is e in its frame, so it is at p + R*e.  It has to be in the plane of its "
        "leg, whose normal is n: three equations.  The sum of the normals, each times a weight, "
        "is zero.  So the sum of the equations with these weights does not contain p.  It is "
        "f*cos(psi) + g*sin(psi) = 0, and gives the twist.  Then two of the equations are "
        "linear in the x and y of p.  The other solution, half a turn on, is left out: it is that "
        "of a hand whose corners are on the other side of its centre.  If f and g both vanish, "
        "the twist is free; on three equal legs, the hand is upside down there.",
        {
            r"R\,R_z(\psi)^{-1}": m.tilted,
            "f": f,
            "g": g,
            r"\cos\psi": sp.Symbol("g") / sp.Symbol("delta"),
            r"\sin\psi": -sp.Symbol("f") / sp.Symbol("delta"),
        },
        proves="The weighted normals add up to zero.  The corners of two legs are in their planes, "
        "and for that of the third the distance from its plane, times its weight, is "
        "f*cos(psi) + g*sin(psi).",
        equal=[
            (
                sum((w * l.normal for w, l in zip(m.weights, m.legs, strict=True)), sp.zeros(2, 1)),
                sp.zeros(2, 1),
            ),
            (sp.Matrix(aside[:2]), sp.zeros(2, 1)),
            (m.weights[2] * aside[2], side * (f * c + g * s)),
        ],
    )
    d.function(
        "hand_pose",
        "Pose of the hand: its twist and its sideways motion follow from the target.",
        {"x": m.target},
        {
            "T": sp.Matrix.vstack(
                placed.rotation.row_join(placed.position), sp.Matrix([[0, 0, 0, 1]])
            )
        },
        program=p,
        notes=("Not finite where the twist is free: on three equal legs, upside down.",),
    )
    return step


def _close(m: Tripod, placed: Step) -> Step:
    ends = (
        (str(k), sp.Matrix(u.leg.end()).T, sp.sympify(u.leg.rod, strict=True))
        for k, u in m.numbered
    )
    loop = m.d.step(
        "The loop",
        "In the plane of leg i, with the distance from the z axis and the height as coordinates, "
        "its joint determines the near end b of the rod.  The corner of the hand is the far end.  "
        "The rod keeps the distance of its ends.",
        {},
        rows=[("i", "b", "length of the rod"), *ends],
        uses=[placed],
    )
    m.d.step(
        f"Forward: an equation of degree {DEGREE}",
        "If the joints are given, each corner of the hand is on a circle in the plane of its leg, "
        "and the corners keep their distances.  Three equations in three angles remain, and all "
        f"of them at once decide.  They lead to an equation of degree {DEGREE} in general.  No "
        "formula is derived for it.",
        {},
        uses=[loop],
    )
    return loop


def _velocity(m: Tripod, loop: Step) -> None:
    """A*dx = B*dq, where the twist follows the tilts."""
    d, at, psi = m.d, m.posture, real("psi")
    p = d.program()
    placed = m.placed(p)
    rods = []
    for k, (number, leg) in enumerate(m.numbered):
        near = sp.Matrix([named_in(p, f"b_{number}{i}", e) for i, e in enumerate(leg.leg.end(), 1)])
        rod = placed.corner(leg, k) - near
        rods.append(sp.Matrix([named_in(p, f"r_{number}{i}", e) for i, e in enumerate(rod, 1)]))
    rows = m.rows(placed, rods, placed.delta)
    driven = [
        named_in(p, f"B_{number}{number}", rate_of(leg.leg, rod))
        for (number, leg), rod in zip(m.numbered, rods, strict=True)
    ]
    A = sp.Matrix.vstack(*rows)
    volume = p.let("Delta", A.det())
    exact = [at.corner(leg, k) - leg.leg.end() for k, leg in enumerate(m.legs)]
    turning, names = m.twisting.diff(psi), Program()
    exact_rows = map(names.explicit, m.rows(replace(at, program=names), exact, turning))
    d.step(
        "Velocity and singular sets",
        "The derivatives of the loop equations, halved, give A*dx = B*dq for the rates of the "
        "target and of the joints.  Row i of A is the vector r along rod i times the derivatives "
        "of its far end.  These take into account that the twist follows the tilts.  F_k is the "
        "derivative of f*cos(psi) + g*sin(psi) with respect to entry k of the target; that with "
        "respect to psi is delta.  B is diagonal, because each leg depends "
        "on its own joint alone.  B is singular if the joint moves the near end of a rod at right "
        "angles to it (serial: the joint moves and the hand stands still).  A is singular if the "
        "rods do not hold the hand (parallel), and where tilt_x is a right angle: there "
        "tilt_y turns the hand about its own axis, as the twist does.  Where delta, the root of "
        "f^2 + g^2, vanishes, the planes do not hold the twist (constraint).",
        {
            r"\frac{\partial\psi}{\partial x_k}": -sp.Symbol("F_k") / sp.Symbol("delta"),
        },
        proves="The derivative of f*cos(psi) + g*sin(psi) with respect to psi is g*cos(psi) - "
        "f*sin(psi), which is delta.  The derivative of each loop equation is twice the row of A "
        "with respect to the target, and less twice the entry of B with respect to the joint.",
        equal=[
            (
                turning,
                sp.Integer(m.side)
                * (m.balance(turned=True) * at.turn[0] - m.balance(turned=False) * at.turn[1]),
            ),
            *(
                (e.diff(u.leg.joint), -2 * rate_of(u.leg, rod))
                for u, rod, e in zip(m.legs, exact, m.loop(at), strict=True)
            ),
            *(
                (e.diff(t) - e.diff(psi) * m.twisting.diff(t) / turning, 2 * entry)
                for e, row in zip(m.loop(at), exact_rows, strict=True)
                for t, entry in zip(m.target, row, strict=True)
            ),
        ],
        uses=[loop],
    )
    target = {"x": m.target, "q": d.actuated}
    J = A.adjugate() * sp.diag(*driven) / volume
    pole = "Not finite at a parallel singularity."
    upright = [u.leg for u in m.legs]
    exported: list[tuple[str, str, dict[str, Any], tuple[str, ...]]] = [
        ("jacobian_parallel", "A of A*dx = B*dq.", {"A": A}, ()),
        (
            "jacobian_serial",
            "The diagonal of B of A*dx = B*dq.",
            {"B": driven},
            signs_of_modes(upright),
        ),
        (
            "jacobian_inverse",
            "B^-1*A: joint rates per rate of the target.",
            {"K": sp.Matrix.vstack(*(row / b for row, b in zip(rows, driven, strict=True)))},
            ("Not finite at a serial singularity.",),
        ),
        ("jacobian", "Derivative of the target with respect to q: A^-1*B.", {"J": J}, (pole,)),
        ("determinant", "Determinant of the Jacobian.", {"det": sp.Mul(*driven) / volume}, (pole,)),
        (
            "singularities",
            "The diagonal of B (serial), the determinant of A (parallel) and delta (constraint).",
            {"factors": [*driven, volume, placed.delta]},
            (),
        ),
    ]
    for name, summary, outputs, notes in exported:
        d.function(name, summary, target, outputs, program=p, notes=(TOGETHER, *notes))


def _draw(m: Tripod) -> None:
    """The skeleton: bases A, near ends B and corners C, and P, the hand."""
    d, p, at = m.d, m.d.program(), m.posture
    placed = m.placed(p)

    def points(placed: Placed) -> dict[str, Sequence[Any]]:
        found: dict[str, Sequence[Any]] = {"P": [*placed.position]}
        for k, (number, leg) in enumerate(m.numbered):
            found[f"A{number}"] = leg.in_space(leg.leg.base)
            if not isinstance(leg.leg, Stretch):
                found[f"B{number}"] = leg.in_space(leg.leg.end())
            found[f"C{number}"] = [*(placed.position + placed.arms[k])]
        return found

    links: dict[str, tuple[str, ...]] = {"ground": ("A1", "A2", "A3", "A1")}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    closing: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    corners = [sp.Matrix([*vector(leg.corner)]) for leg in m.legs]
    for k, (number, leg) in enumerate(m.numbered):
        base, far = f"A{number}", f"C{number}"
        near = base if isinstance(leg.leg, Stretch) else f"B{number}"
        lengths[near, far] = sp.sympify(leg.leg.rod, strict=True)
        aside = leg.normal.dot((at.position + at.arms[k])[:2, 0])
        closing[near, far] = m.loop(at)[k] + aside**2
        joints[leg.leg.joint] = (base,) if isinstance(leg.leg, Crank) else (base, near)
        after = (k + 1) % 3
        lengths[far, f"C{after + 1}"] = sp.sqrt(sp.factor(square(corners[after] - corners[k])))
        lengths["P", far] = sp.sqrt(sp.factor(square(corners[k])))
        links[f"hand{number}"] = ("P", far)
        if isinstance(leg.leg, Stretch):
            joints[leg.leg.joint] = (base, far)
            continue
        links[f"rod{number}"] = (near, far)
        lengths[base, near] = leg.leg.joint
        if isinstance(leg.leg, Crank):
            links[f"crank{number}"] = (base, near)
            lengths[base, near] = sp.sympify(leg.leg.length, strict=True)
    links["hand"] = ("C1", "C2", "C3", "C1")
    skeleton(
        d,
        points(placed),
        links=links,
        joints=joints,
        hand="P",
        ground=("A1", "A2", "A3"),
        lengths=lengths,
        pose={"x": m.target},
        program=p,
        notes=(TOGETHER,),
        at_posture=[points(at)],
        closing=closing,
    )


def _inverse(m: Tripod, loop: Step) -> None:
    d, g = m.d, m.d.program()
    legs = [u.leg for u in m.legs]
    moved = m.target[:1] if any(isinstance(leg, Slide) for leg in legs) else ()
    solved = LegByLeg(d, g, g.let("size", size_of(d, moved)))
    placed = m.placed(g, guarded=True)
    for k, (number, leg) in enumerate(m.numbered):
        corner = placed.corner(leg, k)
        solved.solve(number, leg.leg, corner - leg.leg.base)
    free = next(s.symbol for s in g.body if isinstance(s, Vanishes))
    rows = m.rows(placed, [s.rod for s in solved.found], choose(free, 1, placed.delta))
    volume = g.let("Delta", sp.Matrix.vstack(*rows).det())
    spread = sp.Add(*(square(vector(leg.corner)) for leg in m.legs)) / 3
    least = g.let("least", solved.lengths(legs) * spread, nonnegative=True)
    meet = "the rods or the planes of the legs do not hold the hand"
    g.determined(
        sp.Min(sp.Abs(volume) * m.size, placed.delta * least),
        m.size * least,
        meet,
        name=r"\min(|\det A|\,e,\ \delta\,\Lambda)",
        scale_name=r"e\,\Lambda",
    )
    d.step(
        "Inverse: leg by leg",
        f"The target gives the corners, and each leg is solved alone.  {solved.on_modes}Near a "
        "parallel or a constraint singularity rounded joints do not determine the hand.  The "
        "status is SINGULAR if the determinant of A is less than 2^-10 of Lambda, the product of "
        "the lengths of the rods and the mean square distance of the corners from the centre of "
        "the hand, or if delta is less than 2^-10 of e, the sum of the coordinates of the corners.",
        {},
        uses=[loop],
    )
    solved.export(
        {"x": m.target},
        {"x": m.target},
        "UNREACHABLE: a rod does not reach.",
        [
            f"SINGULAR also near a parallel or a constraint singularity, where {meet}: the loop "
            "closes, but the joints do not determine the hand.",
            "Where the twist of the hand is free (on three equal legs, upside down) it is taken as "
            "0.  A rod that does not reach then might with another twist.",
            "Left out: the postures in which the hand is twisted half a turn more.",
            f"fk is not derived: the forward problem is an equation of degree {DEGREE}.",
        ],
    )
    plain = m.placed(Program())
    solved.certify([plain.program.explicit(e) for e in m.loop(plain)])


__all__ = ["Tripod", "Upright", "tripod"]
