"""The velocity of a hand whose balls slide along lines, and its drawing."""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.lemmas.legs import Crank
from closedform.loops.balls import ASIDE, TARGET, Z
from closedform.loops.leg_by_leg import named_in
from closedform.loops.lines_hand import OnLines, Posture, Twisted, exact_pose
from closedform.loops.modes import NO_MODE, export
from closedform.loops.points import side_length
from closedform.mechanics.skeleton import skeleton
from closedform.model.functions import Program
from closedform.model.step import Step


def _rows(m: OnLines, pose: Twisted) -> sp.Matrix:
    """A of A*dx = B*dq: how fast the corners rise."""
    x, y, T = pose.tilts.x, pose.tilts.y, pose.tilted
    return sp.Matrix(
        [
            [1, T[2, 2] * leg.place[1], -y.c * leg.place[0] - y.s * x.s * leg.place[1]]
            for leg in m.legs
        ]
    )


def state_velocity(m: OnLines, at: Posture, loop: Step) -> None:
    """The step on the velocity, and the Jacobians and the singular set in all assembly modes."""
    d, v, exact = m.d, Program(list(at.program.body), at.program.taken), exact_pose()
    A = _rows(m, exact)
    row = exact.tilted[2, :]
    rises = [Z + m.rise(row, k) for k, _ in enumerate(m.legs)]
    lifts = [leg.lift for leg in m.legs]
    det = exact.tilts.y.c * row[2] * m.area
    d.step(
        "Velocity and singular sets",
        "The derivatives of the heights of the corners give A*dx = B*dq for the rates of the "
        "task.  B is diagonal: entry i says how fast joint i moves its line up, and is zero where "
        "the line moves sideways (serial).  The determinant of A is cos(tilt_y)*n_z times the area "
        "of the corners, up to its sign: it is zero where the hand is on edge (parallel), and both "
        "modes of n_z meet there.  Both twists meet where mu_1*cos(twist) - mu_2*sin(twist) is "
        "zero: the lines do not fix the twist there.",
        {"A": A, **{f"B_{{{k}{k}}}": e for k, e in enumerate(lifts, 1)}},
        proves="A and B are the derivatives.",
        equal=[
            *((sp.Matrix([e.diff(x) for x in TARGET]).T, A[k, :]) for k, e in enumerate(rises)),
            *((h.diff(leg.leg.joint), leg.lift) for h, leg in zip(m.heights, m.legs, strict=True)),
            (A.det(), det),
        ],
        uses=[loop],
    )
    pose, area = at.pose, named_in(v, "triangle", m.area)
    named = v.matrix("A", _rows(m, pose))
    B = [named_in(v, f"B_{k}{k}", e) for k, e in enumerate(lifts, 1)]
    # how the height and the first two entries of the last row of R follow from the heights
    unit = sp.eye(3)
    level = [[e / area for e in m.level(list(unit.row(k)))] for k in range(3)]
    second = sp.Matrix([[-pair[0] for pair in level]]) / pose.tilts.y.c
    up = sp.Matrix([[pair[1] for pair in level]])
    first = (up + pose.tilts.y.s * pose.tilts.x.s * second) / at.upright
    rise = sp.Matrix([[int(k == 0) - m.rise(pair, 0) for k, pair in enumerate(level)]])
    J = v.matrix("K", sp.Matrix.vstack(rise, first, second)) * sp.diag(*B)
    edge = v.let("nu", pose.tilts.y.c * at.upright)
    pole = "Not finite where the hand is on edge."
    export(
        d,
        v,
        at.modes,
        [
            ("jacobian_parallel", "A of A*dx = B*dq.", {"A": named}, ()),
            ("jacobian_serial", "The diagonal of B of A*dx = B*dq.", {"B": B}, ()),
            (
                "jacobian",
                "Derivative of z, tilt_x and tilt_y with respect to q: A^-1*B.",
                {"J": J},
                (pole,),
            ),
            (
                "determinant",
                "Determinant of the Jacobian.",
                {"det": sp.Mul(*B) / (area * edge)},
                (pole,),
            ),
            (
                "singularities",
                "The diagonal of B (serial), cos(tilt_y)*n_z (the hand is on edge), and the "
                "derivative of the equation of the twist.",
                {"factors": [*B, edge, v.let("tau", at.root)]},
                (),
            ),
        ],
    )


def draw(m: OnLines, at: Posture) -> None:
    """The skeleton: bases A, ends B of the legs, balls C on their lines, and P, the hand."""
    links: dict[str, tuple[str, ...]] = {
        "ground": ("A1", "A2", "A3", "A1"),
        "hand": ("C1", "C2", "C3", "C1"),
        "hand0": ("P", "C1"),
    }
    lengths: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    exact, position = exact_pose(), sp.Matrix([*ASIDE, Z])

    def placed(pose: Twisted, hand: sp.Matrix) -> dict[str, Any]:
        found: dict[str, Any] = {"P": [*hand]}
        for k, leg in m.numbered:
            ball = hand + pose.rotation[:, :2] * leg.place
            found |= {f"A{k}": [*leg.base], f"B{k}": [*leg.leg.end()], f"C{k}": [*ball]}
        return found

    for k, leg in m.numbered:
        base, near, ball = f"A{k}", f"B{k}", f"C{k}"
        if isinstance(leg.leg, Crank):
            joints[leg.leg.joint] = (base,)
            links[f"crank{k}"] = (base, near)
            lengths[base, near] = sp.sympify(leg.length, strict=True)
        else:
            joints[leg.leg.joint] = (base, near)
            lengths[base, near] = leg.leg.joint
        joints[leg.slide] = (near, ball)
    for k in range(3):
        one, other = m.legs[k].place, m.legs[(k + 1) % 3].place
        lengths[f"C{k + 1}", f"C{(k + 1) % 3 + 1}"] = side_length(other - one)
    lengths["P", "C1"] = side_length(m.legs[0].place)
    skeleton(
        m.d,
        placed(at.pose, at.hand),
        links=links,
        joints=joints,
        hand="P",
        ground=("A1", "A2", "A3"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[placed(exact, position)],
    )


__all__ = ["draw", "state_velocity"]
