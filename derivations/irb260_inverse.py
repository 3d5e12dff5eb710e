"""The inverse kinematics of the IRB 260, which the paper does not give, and its workspace."""

from dataclasses import replace

import sympy as sp
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Degenerate,
    Derivation,
    Inverse,
    Program,
    Solved,
    Triangle,
    branches,
    choose,
    linear_pair,
    real,
)

TARGET = (real("px"), real("py"), real("pz"), real("psi"))


def inverse_kinematics(d: Derivation, lengths: tuple[sp.Symbol, ...], position: sp.Matrix) -> None:
    """Add the inverse: all postures for a position and a yaw."""
    l1, l2, l3, l4, l5, l6 = lengths
    theta1, theta2, theta3, theta5 = d.actuated
    px, py, pz, psi = TARGET
    side, bend = real("sigma_side"), real("sigma_elbow")
    alpha, elbow = real("alpha"), real("elbow")
    choices = branches(
        (side, {+1: "front", -1: "back"}), (bend, {+1: "elbow_up", -1: "elbow_down"})
    )
    d.branches = choices.labels

    p = Program()
    size = l1 + l2 + l3 + l4 + l5 + l6
    r = p.let("r", sqrt(px**2 + py**2), nonnegative=True)
    on_axis = p.vanishes("on_axis", r, size, "the hand is on the base axis", free=(theta1,))
    c1 = p.let("c_turret", choose(on_axis, 1, side * py))
    s1 = p.let("s_turret", choose(on_axis, 0, -side * px))
    u = p.let("u", side * r - l1 - l6)
    h = p.let("h", pz - l2 + l5)
    reach = p.let("reach", sqrt(u**2 + h**2), nonnegative=True)
    sides = Triangle.from_reach(p, (l3, l4), reach, bend, scale=size).rooted(p)
    triangle = sides.lemma((elbow, alpha), reach)
    folded = p.vanishes("folded", reach, size, "the wrist is on the shoulder", free=(theta2,))
    no_link = p.vanishes("no_link", l3 * l4, (l3 + l4) ** 2, "an arm has no length", free=(theta3,))
    turret = replace(
        linear_pair(theta1, s1, c1),
        plainly={theta1: choose(on_axis, 0, atan2(-side * px, side * py))},
        roles=(("x", theta1), ("f", -side * px), ("g", side * py)),
    )
    shoulder = linear_pair(theta2, u, h)
    hand = replace(
        linear_pair(theta5, sin(psi) * c1 - cos(psi) * s1, cos(psi) * c1 + sin(psi) * s1),
        plainly={theta5: psi - theta1},
        roles=(("x", theta1 + theta5), ("f", sin(psi)), ("g", cos(psi))),
    )
    solution = {
        theta1: turret[theta1],
        theta2: choose(folded, 0, shoulder[theta2] - choose(no_link, 0, triangle[alpha])),
        theta3: choose(no_link, -pi / 2, triangle[elbow] - pi / 2),
        theta5: hand[theta5],
    }
    span = real("L")
    roots = {real(f"r{k}", nonnegative=True): sqrt(real(k, nonnegative=True)) for k in "SABC"}
    told_elbow = replace(
        triangle,
        solution={theta3: triangle[elbow] - pi / 2},
        roles=(*triangle.roles, (r"\theta", theta3 + pi / 2)),
    )
    told_shoulder = replace(
        shoulder,
        solution={theta2: shoulder[theta2] - triangle[alpha]},
        roles=(("x", theta2 + alpha), ("f", u), ("g", h)),
    )
    arms = {
        u: l3 * sin(theta2) + l4 * cos(theta2 + theta3),
        h: l3 * cos(theta2) - l4 * sin(theta2 + theta3),
        alpha: atan2(l4 * cos(theta3), l3 - l4 * sin(theta3)),
    }
    law = u**2 + h**2 - l3**2 - l4**2 + 2 * l3 * l4 * sin(theta3)
    toward = h * sin(theta2 + alpha) - u * cos(theta2 + alpha)
    d.solved += [
        Solved("ik", theta1, turret, px * cos(theta1) + py * sin(theta1)),
        Solved("ik", theta3, told_elbow, law, arms),
        Solved("ik", theta2, told_shoulder, toward, arms),
        Solved("ik", theta5, hand, sin(theta1 + theta5 - psi)),
    ]
    d.step(
        "Inverse: the turret",
        "The hand is in the plane of the arm, at the distance r from the base axis.  Either the "
        "arm faces the hand (front, sigma_side = 1) and rho = r, or it reaches over the axis "
        "(back, sigma_side = -1) and rho = -r.  If the hand is on the axis, theta1 is free; we "
        "return 0.",
        {
            r"\rho": side * sqrt(px**2 + py**2),
            r"\theta_1": atan2(-side * px, side * py),
            r"u": r"\rho - l_1 - l_6",
            r"h": pz - l2 + l5,
        },
        solves={"ik": [theta1]},
    )
    d.step(
        "Inverse: the elbow and the shoulder",
        "The wrist is u ahead of the shoulder and h above it.  The two arms and the line of "
        "length L between these joints form a triangle.  S, A, B and C are the factors of Heron's "
        "formula for its area; the roots of their products give the tangents of half its angles.  "
        "The turn at the elbow is theta3 + 90 degrees, and alpha is the angle at the shoulder.  "
        "So elbow_up (sigma_elbow = 1) means cos(theta3) >= 0, as at home, and elbow_down means "
        "cos(theta3) <= 0.  If the arms are equal and the wrist is on the shoulder, theta2 is "
        "free; we return 0.",
        {
            "L": sqrt(u**2 + h**2),
            "S": l3 + l4 + span,
            "A": l3 + l4 - span,
            "B": l3 - l4 + span,
            "C": l4 - l3 + span,
            r"\theta_3": triangle[elbow].xreplace(roots) - pi / 2,
            r"\alpha": triangle[alpha].xreplace(roots),
            r"\theta_2": shoulder[theta2] - alpha,
        },
        solves={"ik": [theta2, theta3]},
    )
    d.step(
        "Inverse: the hand",
        "theta5 is the yaw minus the turn of the turret.",
        {r"\theta_5": r"\psi - \theta_1"},
        solves={"ik": [theta5]},
    )
    d.function(
        "ik",
        "All four configurations for a position and a yaw.",
        {"x": TARGET},
        {"q": [solution[angle] for angle in d.actuated]},
        program=p,
        branches=choices,
        result="Solutions",
        source="eq. (13), which is solved here; the paper does not give the inverse",
        notes=(
            "front: the arm faces the hand, rho >= 0; back: it reaches over the base axis, rho <= "
            "0, with rho = y*cos(theta1) - x*sin(theta1).  elbow_up: cos(theta3) >= 0, as at "
            "home; elbow_down: cos(theta3) <= 0.",
            "SINGULAR: if the hand is on the base axis, theta1 is free (theta1 + theta5 is "
            "determined) and 0 is returned; if equal arms are folded with the wrist on the "
            "shoulder, theta2 is free and 0 is returned; if an arm has no length, its angle is "
            "free and theta3 = -pi/2 is returned.",
            "Ill-conditioned if the arm is straight or folded: the angles lose half their digits, "
            "the position does not.",
        ),
    )
    beta = real("beta")
    d.inverses.append(
        Inverse(
            "ik",
            d.actuated,
            TARGET,
            (*position, theta1 + theta5),
            (
                Degenerate(
                    (on_axis,),
                    {px: sp.S.Zero, py: sp.S.Zero},
                    theta1,
                    relation=r"\theta_1 + \theta_5 = \psi",
                ),
                Degenerate(
                    (folded,),
                    {
                        px: -(l1 + l6) * sin(beta),
                        py: (l1 + l6) * cos(beta),
                        pz: l2 - l5,
                        l4: l3,
                    },
                    theta2,
                    relation=r"\theta_3 = \pi/2",
                    branches=("front_elbow_up", "front_elbow_down"),
                ),
            ),
            angles=(psi,),
        )
    )


def workspace(
    d: Derivation, lengths: tuple[sp.Symbol, ...], position: sp.Matrix, rho: sp.Expr
) -> None:
    """Add the limits of the positions of the hand; they do not depend on its yaw."""
    l1, l2, l3, l4, l5, l6 = lengths
    theta3, (px, py, pz, _) = d.actuated[2], TARGET
    inner, outer = sp.Abs(l3 - l4), l3 + l4
    square = l3**2 + l4**2 - 2 * l3 * l4 * sin(theta3)
    d.step(
        "Workspace",
        "In the plane of the arm the hand can reach an annulus about the point at rho = l1 + l6 "
        "and z = l2 - l5; its radii are the difference and the sum of the arms.  With the turns of "
        "the turret, the workspace is this annulus and its mirror image, turned about the base "
        "axis.  The arm is folded at the inner radius and straight at the outer one.",
        {
            r"\rho_0": l1 + l6,
            "z_0": l2 - l5,
            r"(\rho - \rho_0)^2 + (z - z_0)^2": square,
            "r_{min}": inner,
            "r_{max}": outer,
        },
        proves=(
            "The squared distance from the centre is the stated one, and it is the square of the "
            "inner radius for the folded and of the outer radius for the straight arm."
        ),
        equal=[
            ((rho - l1 - l6) ** 2 + (position[2] - l2 + l5) ** 2, square),
            (square.subs(theta3, pi / 2), inner**2),
            (square.subs(theta3, -pi / 2), outer**2),
        ],
    )
    d.function(
        "workspace_section",
        "The annulus that the hand can reach in the plane of the arm.",
        {},
        {"section": [l1 + l6, l2 - l5, inner, outer]},
        notes=("Radius and height of the centre, inner and outer radius.",),
    )
    p = Program()
    r = p.let("r", sqrt(px**2 + py**2), nonnegative=True)
    h = p.let("h", pz - l2 + l5)
    gaps = []
    for name, sign in (("front", 1), ("back", -1)):
        there = p.let(f"reach_{name}", sqrt((sign * r - l1 - l6) ** 2 + h**2), nonnegative=True)
        gaps.append(p.let(f"margin_{name}", sp.Min(outer - there, there - inner)))
    margin = sp.Max(*gaps)
    d.function(
        "workspace_margin",
        "How far a position is inside the workspace, in the plane of the arm; negative outside.",
        {"p": (px, py, pz)},
        {"margin": margin},
        program=p,
    )
    inside = Program(list(p.body))
    inside.bound("margin", margin, sum(lengths), "the front or the back of the arm reaches it")
    d.function(
        "workspace_contains",
        "Whether any configuration reaches a position; the yaw does not matter.",
        {"p": (px, py, pz)},
        {"inside": sp.true},
        program=inside,
        notes=("True if and only if ik has a branch that is OK or SINGULAR.",),
        boolean=True,
    )
