"""The Stanford arm, RRP and a spherical wrist, in standard Denavit-Hartenberg parameters."""

import sympy as sp
from closedform.derivations.papers.stanford_textbooks import STANFORD_TEXTBOOKS
from closedform.derivations.wrist_of_an_arm import aligned_wrist, wrist_step
from sympy import cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    Notation,
    determinant,
    from_dh,
    polar,
    real,
    rotation,
    turn,
    turned,
    zyz,
)

d = Derivation(
    "stanford_arm",
    "Stanford arm",
    STANFORD_TEXTBOOKS,
    "A vertical base axis (theta1), a horizontal shoulder (theta2), a boom that slides through it "
    "(d3) and a spherical wrist (theta4, theta5, theta6).  The base frame is at the height of the "
    "shoulder, the hand frame at the centre of the wrist.  At zero the boom points up.",
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

d.explain(
    {
        "X": "how far the centre of the wrist is ahead of the base axis",
    }
)
arm = from_dh(
    d,
    [
        (0, -pi / 2, 0, theta1),
        (0, pi / 2, d2, theta2),
        (0, 0, d3, 0),
        (0, -pi / 2, 0, theta4),
        (0, pi / 2, 0, theta5),
        (0, 0, 0, theta6),
    ],
)
forward = arm.export(d, {"shoulder": sin(theta2), "boom": d3, "wrist": sin(theta5)})
d.explain(
    {
        "J_{11}": "block of J: the position of the hand, the joints of the arm",
        "J_{22}": "block of J: the rotation of the hand, the joints of the wrist",
    }
)
d.step(
    "Factors of the determinant",
    "The wrist does not move its centre, so the determinant is that of the arm times that of the "
    "wrist, the two blocks on the diagonal of J.  It vanishes where the boom is vertical "
    "(shoulder), where it is drawn in so far that the wrist is on the axis of the shoulder (boom), "
    "and where axes 4 and 6 coincide (wrist).",
    {
        r"\det J_{11}": determinant(arm.geometric[:3, :3]),
        r"\det J_{22}": determinant(arm.geometric[3:, 3:]),
    },
    proves=(
        "The last three joints do not move the centre of the wrist: their columns of the first "
        "three rows are zero."
    ),
    equal=[(arm.geometric[:3, 3:], sp.zeros(3))],
)
X, Z = d3 * sin(theta2), d3 * cos(theta2)

ik = Chain(d, forward)
px, py, pz = ik.p
ik.size = sqrt(px**2 + py**2 + pz**2) + sp.Abs(d2)
shoulder = ik.solve(turn, theta1, (-px, py, d2), {+1: "right", -1: "left"}, scale=ik.size)
lift, _ = ik.solve(polar, theta2, d3, (pz, -shoulder.ahead), {+1: "out", -1: "back"}, name="boom")
d.step(
    "Inverse: the shoulder and the boom",
    "The boom moves in a plane at the distance d2 from the base axis.  In this plane the centre "
    "of the wrist is X forward and p_z up.  The arm faces the wrist (right, X >= 0) or turns its "
    "back to it (left, X <= 0).  The boom slides out to the wrist (out, d3 >= 0) or, turned by "
    "pi, back through the shoulder (back, d3 <= 0), which a real boom cannot do.",
    {
        "X": shoulder.side * sqrt(px**2 + py**2 - d2**2),
        "d_3": real("sigma_boom") * sqrt(real("X") ** 2 + pz**2),
        r"\theta_2": sp.atan2(real("sigma_boom") * real("X"), real("sigma_boom") * pz),
    },
    solves={"ik": [theta1, theta2]},
)
R03 = rotation("z", theta1) * rotation("y", theta2)
R36 = rotation("z", theta4) * rotation("y", theta5) * rotation("z", theta6)
in_plane = ik.matrix("R1", turned(shoulder).T * ik.R)
upright = sp.Matrix([[lift.c, 0, -lift.s], [0, 1, 0], [lift.s, 0, lift.c]])
ik.solve(
    zyz, ik.matrix("R2", upright * in_plane), (theta4, theta5, theta6), {+1: "noflip", -1: "flip"}
)
wrist_step(d, arm.pose, R03, R36, (theta4, theta5, theta6))
R06 = r"R_{36} = R_{03}^T R"
ik.continuum(theta1, {px: 0, py: 0, d2: 0}, R06)
ik.continuum(theta2, {px: -d2 * sin(theta1), py: d2 * cos(theta1), pz: 0}, R06)
aligned_wrist(ik, R03, theta4)
ik.finish(
    "All 8 configurations of a pose.",
    notes=(
        "right: X >= 0, the arm faces the wrist; left: X <= 0.  out: d3 >= 0; back: d3 <= 0.",
        "X is how far the centre of the wrist is ahead of the base axis.",
        "noflip: sin(theta5) >= 0; flip: sin(theta5) <= 0.",
        "INVALID: the matrix is not a homogeneous transform with a proper rotation.",
    ),
    singular=(
        "the centre of the wrist on the base axis (d2 = 0), theta1 = 0 is returned; the boom drawn "
        "in, d3 = 0, theta2 = 0 is returned.",
        "the wrist is aligned, sin(theta5) = 0, and theta4 = 0 is returned.",
    ),
)

d.claim(
    "position",
    r"$d_x = c_1s_2d_3 - s_1d_2$, $d_y = s_1s_2d_3 + c_1d_2$, $d_z = c_2d_3$ (with $d_6 = 0$)",
    notation=Notation(
        {
            "d_x": arm.position[0],
            "d_y": arm.position[1],
            "d_z": arm.position[2],
            "d_2": d2,
            "d_3": d3,
            "d_6": sp.Integer(0),  # the hand frame is at the centre of the wrist
            "c_1": cos(theta1),
            "s_1": sin(theta1),
            "c_2": cos(theta2),
            "s_2": sin(theta2),
        }
    ),
    paraphrase=True,
)
