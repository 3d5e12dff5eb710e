"""The velocity of a hand whose arms slide through balls, and its drawing."""

from __future__ import annotations

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.loops.balls import (
    ASIDE,
    TILT_X,
    TILT_Y,
    TWIST,
    UP,
    OnBalls,
    Posture,
    Z,
    exact_turns,
)
from closedform.loops.leg_by_leg import named, size_of
from closedform.loops.modes import NO_MODE, export
from closedform.mechanics.frames import hat
from closedform.mechanics.skeleton import skeleton
from closedform.model.functions import Program, real
from closedform.model.step import Step


def state_velocity(m: OnBalls, at: Posture, loop: Step) -> None:
    d, v = m.d, Program(list(at.program.body), at.program.taken)
    exact = exact_turns()
    R = exact.rotation
    w, r, n, rate = (sp.Matrix([real(f"{e}_{i}") for i in "xyz"]) for e in ("omega", "r", "n", "v"))
    axes = {TILT_X: exact.tilted[:, 0], TILT_Y: sp.Matrix([0, 1, 0]), TWIST: exact.tilted * UP}
    d.step(
        "Velocity and singular sets",
        "Let r_i lead from the point of the hand to the ball i, n be the axis of the hand and c_i "
        "the direction across arm i.  The ball moves along z by the rate of its joint, and "
        "relative to the hand along its arm alone.  Along n this gives the rate of the joint from "
        "the motion of the hand.  Along c_i it gives three equations for the rates of x, y and the "
        "twist, "
        "whose matrix is C, because the part of c_i - (c_iz/n_z) n along z vanishes.  So A*dx = "
        "dq for the rates of the task.  If C is singular, the arms do not fix the twist.",
        {},
        proves="A tilt or the twist turns R about its axis.  The derivative of the product of a "
        "direction of the hand with r is that with the relative velocity.",
        equal=[
            *((R.diff(angle), hat(axis) * R) for angle, axis in axes.items()),
            (w.cross(n).dot(r) - n.dot(rate), -n.dot(rate + w.cross(r))),
        ],
        uses=[loop],
    )
    turns, p = at.turns, at.hand
    T = v.matrix("T", turns.tilted)
    R = v.matrix("R", turns.rotation)
    n, tilts = T[:, 2], (T[:, 0], sp.Matrix([0, 1, 0]))
    spans = [named(v, f"r_{k}", ball - p) for k, ball in enumerate(at.balls, 1)]
    C, right = sp.zeros(3, 3), sp.zeros(3, 2)
    for k, (leg, span) in enumerate(zip(m.legs, spans, strict=True)):
        across, along = R[:, :2] * leg.normal, R[:, :2] * leg.way
        flat = named(v, f"G_{k + 1}", (n[2] * across - across[2] * n)[:2, 0])
        C[k, :] = sp.Matrix([[*flat, v.let(f"k_{k + 1}", n[2] * along.dot(span))]])
        for j, axis in enumerate(tilts):
            right[k, j] = v.let(f"f_{k + 1}{j + 1}", -flat.dot(axis.cross(span)[:2, 0]))
    volume = v.let("Delta", C.det())
    follow = v.matrix("F", C.adjugate()[:2, :] * right / volume)
    rows = []
    for k, (leg, span) in enumerate(zip(m.legs, spans, strict=True), 1):
        moved = [
            n[0] * follow[0, j] + n[1] * follow[1, j] + n.cross(axis).dot(span)
            for j, axis in enumerate(tilts)
        ]
        turned = (v.let(f"A_{k}{j + 2}", leg.up * e / n[2]) for j, e in enumerate(moved))
        rows.append([leg.up, *turned])
    A = sp.Matrix(rows)
    J = _rates(m, at, v, (T, follow))
    det = v.let("det_J", J.det())
    pole = "Not finite at a parallel singularity."
    export(
        d,
        v,
        at.modes,
        [
            ("jacobian_parallel", "A of A*dx = B*dq.", {"A": A}, (pole,)),
            ("jacobian_serial", "The diagonal of B of A*dx = B*dq.", {"B": [1, 1, 1]}, ()),
            (
                "jacobian",
                "Derivative of z, tilt_x and tilt_y with respect to q: A^-1.",
                {"J": J},
                (pole,),
            ),
            ("determinant", "Determinant of the Jacobian.", {"det": det}, (pole,)),
            (
                "singularities",
                "The determinants of C (the twist) and of A^-1.",
                {"factors": [volume, det]},
                (pole,),
            ),
        ],
    )


def _rates(m: OnBalls, at: Posture, v: Program, hand: tuple[sp.Matrix, sp.Matrix]) -> sp.Matrix:
    """The Jacobian: the plane of the balls turns by the slope that the joints give it."""
    T, follow = hand
    slope = sp.Matrix([v.let(f"slope_{i}", T[k, 2] / T[2, 2]) for k, i in enumerate("xy")])
    u, w = at.sides
    flat = v.let("flat_size", size_of(m.d, m.legs) * cross_in_plane(u, w))
    # of the slope per joint
    second, third = sp.Matrix([-w[1], w[0]]) / flat, sp.Matrix([u[1], -u[0]]) / flat
    steep = v.matrix("S", sp.Matrix.hstack(-second - third, second, third))
    x, y = at.turns.x, at.turns.y
    turning = sp.Matrix([[-x.s * x.c * y.s * y.c, -(x.c**2) * y.c], [y.c**2, 0]])
    tilting = v.matrix("J_t", turning * steep)
    away = named(v, "away", (at.balls[0] - at.hand)[:2, 0])
    rise = away.T * steep - slope.T * follow * tilting
    rise[0] += 1
    return rise.col_join(tilting) * sp.diag(*(leg.up for leg in m.legs))


def draw(m: OnBalls, at: Posture) -> None:
    """The skeleton: bases A and balls B of the sliders, and P, the hand, with its arms."""
    exact_hand = sp.Matrix([*ASIDE, Z])
    bases = {f"A{k}": [*leg.base] for k, leg in enumerate(m.legs, 1)}
    points = {**bases, **{f"B{k}": [*b] for k, b in enumerate(at.balls, 1)}, "P": [*at.hand]}
    posed = {**bases, **{f"B{k}": [*leg.end()] for k, leg in enumerate(m.legs, 1)}}
    links = {"ground": ("A1", "A2", "A3", "A1")}
    lengths: dict[tuple[str, str], sp.Expr] = {}
    joints: dict[sp.Symbol, tuple[str, ...]] = {}
    for k, leg in enumerate(m.legs, 1):
        joints |= {leg.joint: (f"A{k}", f"B{k}"), leg.slide: ("P", f"B{k}")}
        span = leg.end() - exact_hand
        lengths[f"A{k}", f"B{k}"] = leg.joint
        lengths["P", f"B{k}"] = sp.sqrt(span.dot(span))
    skeleton(
        m.d,
        points,
        links=links,
        joints=joints,
        hand="P",
        ground=("A1", "A2", "A3"),
        lengths=lengths,
        program=at.program,
        branches=at.modes,
        notes=(NO_MODE,),
        at_posture=[{**posed, "P": [*exact_hand]}],
    )


__all__ = ["draw", "state_velocity"]
