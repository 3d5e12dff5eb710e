"""A tripod: three legs in vertical planes carry a hand that lifts and tilts, as in the 3-PRS.

The planes share a vertical axis.  A leg is hinged, so that it stays in its plane, and a ball joint
carries the hand at its end.  The hand has three degrees of freedom: it lifts, and it tilts in two
directions.  It also twists and moves sideways: this parasitic motion follows from them in closed
form.

:func:`tripod` derives what has a closed form: the place of the hand, the inverse with all working
modes, the velocity and the singular sets.  The forward problem leads to an equation of degree 16,
and no ``fk`` is derived.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from closedform.lemmas.legs import Crank, Slide, Stretch
from closedform.loops.hand import rate_of, square
from closedform.loops.leg_by_leg import MISSED, LegByLeg, named_in, signs_of_modes, size_of
from closedform.loops.tripod_legs import Placed, Tripod, Upright
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation
from closedform.model.functions import Let, Program, Vanishes, choose, real
from closedform.model.step import Step

DEGREE = 16
"""Of the forward problem of a tripod in general: three circles that carry a triangle."""
VECTORS = {
    "a_k": "axis about which entry k of the target tilts the hand",
    "a_psi": "axis of the twist",
    "v_ik": "derivative of h_i with respect to entry k of the target",
    "p_k": "derivative of the position with respect to entry k of the target",
    "h_i": "from the point of the hand to the corner of leg i",
    "n_i": "normal of the plane of leg i",
    "d_i": "horizontal direction in the plane of leg i",
    "b_i": "near end of rod i, in the plane of the leg",
    "r_i": "from the near end of rod i to the corner of the hand, in the plane of the leg",
}
"""In the step on the velocity."""
CANCEL = (
    "There the cosines in u nearly cancel.  The first form of u keeps all digits, because sines "
    "near zero are known to all digits."
)
TOGETHER = "The target and the joints have to belong together, as ik gives them."


def tripod(d: Derivation, legs: Sequence[Upright]) -> None:
    """Derive and export a hand that three legs in vertical planes lift and tilt.

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


def _place(m: Tripod) -> Step:
    """The step on the place of the hand, and the function that returns it."""
    d, at = m.d, m.posture
    p = d.program()
    placed = m.placed(p)
    side, (c, s) = sp.Integer(m.side), at.turn
    f, g = (side * m.balance(turned) for turned in (False, True))
    made = {let.symbol: let.value for let in p.body if isinstance(let, Let)}
    shown = {*placed.rotation, *(e for arm in placed.arms for e in arm), *placed.turn}
    unshown = {s: e for s, e in made.items() if s not in shown | {placed.delta}}
    sums = {s.name: e for s, e in made.items() if s.name in ("u", "f", "g")}
    plain, apart = m.cosines()
    far = [at.position + arm for arm in at.arms]
    aside = [leg.normal.dot(e[:2, 0]) for leg, e in zip(m.legs, far, strict=True)]
    if "u" in sums:
        d.explain({"u": "sum of the cosines of the tilts"})
    d.write("psi", r"\psi", "twist of the hand about its own z axis")
    d.explain({"f": "coefficient of cos(psi) in the equation of the twist"})
    d.explain({"g": "coefficient of sin(psi) in the equation of the twist"})
    d.explain({r"\delta": "amplitude of the equation of the twist", "R": "rotation of the hand"})
    d.explain({"c": "cosine of the twist", "s": "sine of the twist"})
    d.explain({r"\mathbf p": "position of the point of the hand"})
    d.explain(
        {
            rf"\mathbf h_{k}": "from the point of the hand to the corner of a leg"
            for k, _ in m.numbered
        }
    )
    step = d.step(
        "Pose of the hand",
        "The hand is twisted by psi about its own z axis and tilted.  Its position is p, and "
        "h_i leads from there to the corner of leg i.  The corner has to be in the plane of its "
        "leg, whose normal is n_i.  This gives three equations.  The sum of the normals, each "
        "times a weight, is zero.  So the sum of the equations with these weights does not "
        "contain p.  It is f*cos(psi) + g*sin(psi) = 0, and gives the twist.  Then two of the "
        "equations are linear in the x and y of p.  The other solution for the twist differs by "
        "half a turn and is left out: there the corners are on the other side of the centre of "
        "the hand.  If f and g both vanish, the twist is free.  If the three legs are equal, this "
        "is where the hand is upside down." + ("  " + CANCEL if "u" in sums else ""),
        {
            r"R\,R_z(\psi)^{-1}": m.tilted,
            **sums,
            r"\delta": made[placed.delta],
            r"c = \cos\psi": made[placed.turn[0]],
            r"s = \sin\psi": made[placed.turn[1]],
            "R": placed.rotation.xreplace(made),
            **{rf"\mathbf h_{k}": arm.xreplace(made) for k, arm in enumerate(placed.arms, 1)},
            r"\mathbf p": placed.position.xreplace(made).xreplace(unshown),
        },
        proves="The weighted normals add up to zero.  The corners of two legs are in their planes, "
        "and for that of the third the distance from its plane, times its weight, is "
        "f*cos(psi) + g*sin(psi)." + ("  Both forms of u are equal." if "u" in sums else ""),
        equal=[
            (
                sum((w * l.normal for w, l in zip(m.weights, m.legs, strict=True)), sp.zeros(2, 1)),
                sp.zeros(2, 1),
            ),
            (sp.Matrix(aside[:2]), sp.zeros(2, 1)),
            (m.weights[2] * aside[2], side * (f * c + g * s)),
            *([(plain, apart)] if "u" in sums else []),
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
    m.d.loop = loop = m.d.step(
        "The loop",
        "In the plane of leg i, with the distance from the z axis and the height as coordinates, "
        "its joint determines the near end b_i of the rod.  The corner of the hand is the far "
        "end.  The rod keeps the distance of its ends.",
        {},
        rows=[("i", "b_i", "length of the rod"), *ends],
        uses=[placed],
    )
    m.d.step(
        f"Forward: an equation of degree {DEGREE}",
        "If the joints are given, each corner of the hand is on a circle in the plane of its "
        "leg, and the corners keep their distances.  Three equations in three angles remain, "
        f"which have to be solved together.  They lead to an equation of degree {DEGREE} in "
        "general.  No formula is derived for it.",
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
        "target and of the joints.  Row i of A is the vector r_i along the rod times the "
        "derivatives of its far end, the corner.  Entry k of the target, k = 2 or 3, tilts the "
        "hand about the axis a_k, and the twist turns it about a_psi.  The twist follows the "
        "tilts: F_k is the derivative of f*cos(psi) + g*sin(psi) with respect to entry k, and "
        "delta is the derivative with respect to psi.  So the corner of leg i moves by v_ik, "
        "seen from the point of the hand.  The point itself moves by p_k, which is horizontal "
        "and keeps the corners in their planes.  The vector r_i has the entries r_i1 along d_i "
        "and r_i2 upwards, and v_ik3 is the third entry of v_ik.  B is diagonal, because each "
        "leg depends on its own joint alone.  B is singular if the joint moves the near end of a "
        "rod at right angles to it (serial: the joint moves and the hand stands still).  A is "
        "singular if the rods do not hold the hand (parallel), and where tilt_x is a right "
        "angle: there tilt_y turns the hand about its own axis, as the twist does.  Where delta, "
        "the root of f^2 + g^2, vanishes, the planes do not hold the twist (constraint).",
        _velocities(m),
        proves="The derivative of f*cos(psi) + g*sin(psi) with respect to psi is g*cos(psi) - "
        "f*sin(psi), which is delta.  The derivative of each loop equation with respect to "
        "the target is twice the row of A, and with respect to the joint it is minus twice "
        "the entry of B.  The far end of each rod moves by p_k + v_ik.",
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
            *_corners_move(m),
        ],
        uses=[loop],
    )
    target = {"x": m.target, "q": d.actuated}
    J = A.adjugate() * sp.diag(*driven) / volume
    pole = "Not finite at a parallel singularity."
    upright = [u.leg for u in m.legs]
    exported: list[tuple[str, str, str, dict[str, Any], tuple[str, ...]]] = [
        ("jacobian_parallel", "A", "A of A*dx = B*dq.", {"A": A}, ()),
        (
            "jacobian_serial",
            "B",
            "The diagonal of B of A*dx = B*dq.",
            {"B": driven},
            signs_of_modes(upright),
        ),
        (
            "jacobian_inverse",
            "K",
            "B^-1*A: joint rates per rate of the target.",
            {"K": sp.Matrix.vstack(*(row / b for row, b in zip(rows, driven, strict=True)))},
            ("Not finite at a serial singularity.",),
        ),
        ("jacobian", "J", "Derivative of the target with respect to q: A^-1*B.", {"J": J}, (pole,)),
        (
            "determinant",
            r"\det J",
            "Determinant of the Jacobian.",
            {"det": sp.Mul(*driven) / volume},
            (pole,),
        ),
        (
            "singularities",
            r"\Delta",
            "The diagonal of B (serial), the determinant of A (parallel) and delta (constraint).",
            {"factors": [*driven, volume, placed.delta]},
            (),
        ),
    ]
    for name, equation, summary, outputs, notes in exported:
        d.function(
            name,
            summary,
            target,
            outputs,
            program=p,
            equation=equation,
            notes=(TOGETHER, *notes),
        )


def _velocities(m: Tripod) -> dict[str, Any]:
    """What the step on the velocity shows."""
    d, (a2, a3, w) = m.d, m.axes
    for name, meaning in VECTORS.items():
        stem, _, index = name.replace("psi", r"\psi").partition("_")
        d.write(name, rf"\mathbf{{{stem}}}_{{{index}}}", meaning)
    d.explain(
        {
            r"\mathbf a_2": "axis of tilt_x",
            r"\mathbf a_3": "axis of tilt_y",
            "F_k": "derivative of the equation of the twist with respect to entry k of the target",
            "A_{i1}": "entry of A",
            "A_{ik}": "entry of A for a tilt, k = 2 or 3",
            "B_{ii}": "entry of B",
            "A": "factor of the rates of the target",
            "B": "factor of the rates of the joints",
            r"\Delta": "determinant of A",
            "K": "joint rates per rate of the target",
            "J": "derivative of the target with respect to the joints",
        }
    )
    twist = r"\frac{\partial\psi}{\partial x_k}"
    turned = rf"\left(\mathbf a_k + {twist}\,\mathbf a_\psi\right)"
    moved = r"\mathbf p_k + \mathbf v_{ik}"
    return {
        "F_k": r"\frac{\partial f}{\partial x_k}\cos\psi + \frac{\partial g}{\partial x_k}\sin\psi",
        twist: -sp.Symbol("F_k") / sp.Symbol("delta"),
        r"\mathbf a_2": a2,
        r"\mathbf a_3": a3,
        r"\mathbf a_\psi": w,
        r"\mathbf v_{ik}": rf"{turned} \times \mathbf h_i",
        rf"\mathbf n_i^T({moved})": sp.S.Zero,
        "A_{i1}": "r_{i2}",
        "A_{ik}": rf"r_{{i1}}\,\mathbf d_i^T({moved}) + r_{{i2}}\,v_{{ik3}}",
        "B_{ii}": r"\mathbf r_i^T\,\frac{\partial\mathbf b_i}{\partial q_i}",
        "A": sp.Matrix(3, 3, lambda i, k: sp.Symbol(f"A_{i + 1}{k + 1}")),
        "B": sp.diag(*(sp.Symbol(f"B_{k}{k}") for k in (1, 2, 3))),
        r"\Delta": r"\det A",
        "K": r"B^{-1}A",
        "J": r"A^{-1}B",
        r"\det J": r"\frac{B_{11}B_{22}B_{33}}{\Delta}",
    }


def _corners_move(m: Tripod) -> list[tuple[sp.Matrix, sp.Matrix]]:
    """The derivatives of the corners, and p_k + v_ik in the plane of the leg, for any F_k."""
    at, psi, follow = m.posture, real("psi"), real("follow")
    *tilts, w = m.axes
    normals = sp.Matrix([leg.normal.T for leg in m.legs[:2]])
    found = []
    for t, axis in zip(m.target[1:], tilts, strict=True):
        moved = [(axis + follow * w).cross(arm) for arm in at.arms]
        aside = [leg.normal.dot(h[:2, 0]) for leg, h in zip(m.legs[:2], moved, strict=False)]
        p_k = normals.LUsolve(-sp.Matrix(aside))
        for k, (leg, h) in enumerate(zip(m.legs, moved, strict=True)):
            far = at.corner(leg, k)
            end = sp.Matrix([leg.along.dot(p_k + h[:2, 0]), h[2]])
            found.append((far.diff(t) + follow * far.diff(psi), end))
    return found


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
    corners = [leg.end for leg in m.legs]
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
    solved = LegByLeg(d, g, g.let("size", size_of(d, legs, moved)))
    placed = m.placed(g, guarded=True)
    for k, (number, leg) in enumerate(m.numbered):
        corner = placed.corner(leg, k)
        solved.solve(number, leg.leg, corner - leg.leg.base)
    free = next(s.symbol for s in g.body if isinstance(s, Vanishes))
    rows = m.rows(placed, [s.rod for s in solved.found], choose(free, 1, placed.delta))
    volume = g.let("Delta", sp.Matrix.vstack(*rows).det())
    spread = sp.Add(*(square(leg.flat) for leg in m.legs)) / 3
    least = g.let("least", solved.lengths(legs) * spread, nonnegative=True)
    meet = "the rods or the planes of the legs do not hold the hand"
    g.determined(
        sp.Min(sp.Abs(volume) * m.size, placed.delta * least),
        m.size * least,
        meet,
        name=r"\min(|\det A|\,e,\ \delta\,\Lambda)",
        scale_name=r"e\,\Lambda",
        missed=solved.missed,
        size=solved.size,
    )
    middle = "centre" if m.legs[0].end[2] == 0 else "z axis"
    d.step(
        "Inverse: leg by leg",
        f"The target gives the corners, and each leg is solved alone.  {solved.on_modes}Near a "
        "parallel or a constraint singularity rounded joints do not determine the hand.  The "
        "status is SINGULAR if the determinant of A is less than 2^-10 of Lambda, the product of "
        f"the lengths of the rods and the mean square distance of the corners from the {middle} of "
        "the hand, or if delta is less than 2^-10 of e, the sum of the coordinates of the "
        f"corners.  {MISSED}",
        {},
        uses=[loop],
        solves={"ik": ()},
    )
    solved.export(
        {"x": m.target},
        {"x": m.target},
        "UNREACHABLE: a rod does not reach.",
        [
            f"SINGULAR also near a parallel or a constraint singularity, where {meet}: the loop "
            "closes, but the joints do not determine the hand.",
            "Where the twist of the hand is free (on three equal legs, upside down) it is taken "
            "as 0.  A rod may then be too short, although it would reach with another twist.",
            "Left out: the postures in which the hand is twisted by another half turn.",
            f"fk is not derived: the forward problem is an equation of degree {DEGREE}.",
        ],
    )
    plain = m.placed(Program(), plain=True)
    solved.certify([plain.program.explicit(e) for e in m.loop(plain)])


__all__ = ["tripod"]
