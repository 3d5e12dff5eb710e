"""The Stanford arm, RRP and a spherical wrist, in standard Denavit-Hartenberg parameters."""

import sympy as sp
from closedform.derivations.papers import STANFORD_TEXTBOOKS
from sympy import cos, pi, sin, sqrt

from closedform import (
    Derivation,
    Identity,
    Program,
    Solved,
    branches,
    denavit_hartenberg,
    direction,
    export_determinant,
    export_inverse,
    export_jacobians,
    export_pose,
    given_transform,
    linear_pair,
    real,
    sine_cosine_pair,
)

d = Derivation(
    "stanford_arm",
    "Stanford arm",
    STANFORD_TEXTBOOKS,
    "A vertical base axis (theta1), a horizontal shoulder (theta2), a boom that slides through it "
    "(d3) and a spherical wrist (theta4, theta5, theta6).  The base frame is at the height of the "
    "shoulder, the hand frame at the centre of the wrist.  At zero the boom points up.",
    task=[f"T{i}{j}" for i in range(1, 5) for j in range(1, 5)],
    singularities=("shoulder", "boom", "wrist"),
)
d2 = d.parameter(
    "d2",
    value=sp.Rational("0.154"),
    unit="m",
    meaning="offset of the boom from the base axis",
    source="Stanford arm of the Robotics Toolbox (Corke)",
    nonnegative=False,
)
theta1, theta2, d3 = d.joint("theta1"), d.joint("theta2"), d.joint("d3", "prismatic")
theta4, theta5, theta6 = (d.joint(f"theta{i}") for i in (4, 5, 6))

rows = [
    (0, -pi / 2, 0, theta1),
    (0, pi / 2, d2, theta2),
    (0, 0, d3, 0),
    (0, -pi / 2, 0, theta4),
    (0, pi / 2, 0, theta5),
    (0, 0, 0, theta6),
]
A = [denavit_hartenberg(*row) for row in rows]
pose = export_pose(d, A, "Standard (distal) frames; the third joint is the only one that slides.")
X, Z = d3 * sin(theta2), d3 * cos(theta2)
export_determinant(
    d,
    export_jacobians(d, A),
    {"shoulder": sin(theta2), "boom": d3, "wrist": sin(theta5)},
    "It vanishes where the boom is vertical (shoulder), where it is drawn in so that the wrist is "
    "on the axis of the shoulder (boom), and where the axes 4 and 6 coincide (wrist).",
)

side, slide, flip = real("sigma_shoulder"), real("sigma_boom"), real("sigma_wrist")
p = Program()
T = given_transform(p)
px, py, pz = T[:3, 3]
size = p.let("size", sqrt(px**2 + py**2 + pz**2) + sp.Abs(d2), nonnegative=True)
shoulder, turn1, ahead, on_axis = sine_cosine_pair(p, theta1, -px, py, d2, side, size)
reach = p.let("reach", sqrt(ahead**2 + pz**2), nonnegative=True)
drawn_in = p.vanishes("drawn_in", reach, size, "the boom has no length", free=(theta2,))
turn2 = direction(-slide * ahead, slide * pz, reach, drawn_in).known_as(p, "2")
beta, delta = real("beta"), real("delta", positive=True)
d.solved += [
    Solved("ik", theta1, shoulder, py * cos(theta1) - px * sin(theta1) - d2),
    Solved(
        "ik",
        theta2,
        linear_pair(theta2, X, Z),
        (px * cos(theta1) + py * sin(theta1)) * cos(theta2) - pz * sin(theta2),
    ),
]
d.step(
    "Inverse: the shoulder and the boom",
    "The wrist is d2 beside the plane of the boom: X forward and p_z up.  The arm faces the wrist "
    "(right, X >= 0) or turns its back to it (left); the boom is drawn out to the wrist (out, d3 "
    ">= 0) or, turned by pi, through the shoulder (back, d3 <= 0; no real boom can).",
    {
        "X": side * sqrt(px**2 + py**2 - d2**2),
        "d_3": slide * sqrt(real("X") ** 2 + pz**2),
        r"\theta_2": sp.atan2(slide * real("X"), slide * pz),
    },
)
export_inverse(
    d,
    p,
    T,
    {theta1: turn1.angle, theta2: turn2.angle, d3: slide * reach},
    [(A[0], {theta1: turn1}), (A[1], {theta2: turn2})],
    A[2:],
    branches(
        (side, {+1: "right", -1: "left"}),
        (slide, {+1: "out", -1: "back"}),
        (flip, {+1: "noflip", -1: "flip"}),
    ),
    flip,
    turn=1,
    free=[
        (theta1, on_axis, {px: 0, py: 0, d2: 0}),
        (theta2, drawn_in, {px: -delta * sin(beta), py: delta * cos(beta), pz: 0, d2: delta}),
        (theta2, drawn_in, {px: delta * sin(beta), py: -delta * cos(beta), pz: 0, d2: -delta}),
    ],
    notes=(
        "right: X >= 0, the arm faces the wrist; left: X <= 0.  out: d3 >= 0; back: d3 <= 0.",
        "SINGULAR: the centre of the wrist on the base axis (d2 = 0), theta1 = 0 is returned; the "
        "boom drawn in, d3 = 0, theta2 = 0 is returned.",
    ),
)

d.claim(
    "position",
    r"$d_x = c_1s_2d_3 - s_1d_2$, $d_y = s_1s_2d_3 + c_1d_2$, $d_z = c_2d_3$ (with $d_6 = 0$)",
    Identity(
        sp.Matrix([cos(theta1) * X - sin(theta1) * d2, sin(theta1) * X + cos(theta1) * d2, Z]),
        pose[:3, 3],
    ),
)
