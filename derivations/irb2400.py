"""A six-axis arm whose forearm is driven through a parallelogram, such as the IRB 2400."""

import sympy as sp
from closedform.derivations.papers.textbook import TEXTBOOK
from closedform.derivations.wrist_of_an_arm import aligned_wrist, wrist_step
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    from_dh,
    parallelogram_drive,
    real,
    rotation,
    turn,
    turned,
    two_links,
    zyz,
)

d = Derivation(
    "irb2400",
    "Six-axis arm on a parallelogram (IRB 2400)",
    TEXTBOOK,
    "theta1 turns about the vertical.  The axes of theta2 and theta3 are horizontal and parallel, "
    "and a spherical wrist (theta4, theta5, theta6) carries the tool.  At zero angles the upper "
    "arm is upright, the forearm level along x, and the tool points along x.  Motor 3 is on the "
    "turret beside motor 2, and a parallelogram transmits its rotation to the forearm.",
)


def length(name: str, millimetres: int, meaning: str, *, nonnegative: bool = True) -> sp.Symbol:
    value, source = sp.Rational(millimetres, 1000), "the maker's data of the IRB 2400/10"
    return d.parameter(
        name, value=value, unit="m", meaning=meaning, source=source, nonnegative=nonnegative
    )


a1 = length("a1", 100, "from the first axis forward to the shoulder", nonnegative=False)
d1 = length("d1", 615, "from the base up to the shoulder", nonnegative=False)
a2 = length("a2", 705, "length of the upper arm")
a3 = length("a3", 135, "from the elbow up to the axis of the forearm", nonnegative=False)
d4 = length("d4", 755, "along the forearm to the centre of the wrist")
d6 = length("d6", 85, "from the centre of the wrist to the tool", nonnegative=False)
q = theta1, theta2, theta3, theta4, theta5, theta6 = [d.joint(f"theta{i}") for i in range(1, 7)]

# Forward kinematics and velocity

rows = [
    (a1, -pi / 2, d1, theta1),
    (a2, 0, 0, theta2 - pi / 2),
    (a3, -pi / 2, 0, theta3),
    (0, pi / 2, d4, theta4),
    (0, -pi / 2, 0, theta5),
    (0, 0, d6, theta6),
]
d.write("elbow", r"\eta", "angle at the elbow, of the triangle of the arm")
d.explain(
    {
        "X": "how far the centre of the wrist is ahead of the base axis",
        "Z": "height of the centre of the wrist",
        "f": "length of the forearm, from the elbow to the centre of the wrist",
        "r": "distance of the centre of the wrist from the shoulder, in the plane of the arm",
        "w": "centre of the wrist",
    }
)
for axis in "xyz":
    d.write(f"w_{axis}", meaning="coordinate of the centre of the wrist")
d.step(
    "Denavit-Hartenberg table",
    "Standard (distal) frames.  The axes 2 and 3 are parallel, so their angles add.",
    {},
    rows=[
        ("Link", "a_i", "alpha_i", "d_i", "theta_i"),
        *((sp.Integer(i), *map(sp.sympify, row)) for i, row in enumerate(rows, 1)),
    ],
)
arm = from_dh(d, rows)
forearm_turn = theta2 + theta3
X = a1 + a2 * sin(theta2) + a3 * sin(forearm_turn) + d4 * cos(forearm_turn)
Z = d1 + a2 * cos(theta2) + a3 * cos(forearm_turn) - d4 * sin(forearm_turn)
elbow = a3 * sin(theta3) + d4 * cos(theta3)
centre = sp.Matrix([X * cos(theta1), X * sin(theta1), Z])
forward = arm.export(d, {"shoulder": X, "elbow": elbow, "wrist": sin(theta5)})
d.step(
    "Centre of the wrist",
    "In the plane of the arm, the centre of the wrist is X forward and Z up. The joints of the "
    "wrist do not move it.",
    {"X": X, "Z": Z, "w": centre},
    proves="The tool is at the distance d6 from this point, along the last axis.",
    equal=[(arm.position, centre + d6 * arm.pose[:3, 2])],
)
at_wrist = centre.jacobian(q[:3])
det = a2 * X * elbow * sin(theta5)
d.step(
    "Factors of the determinant",
    "The velocity of the centre of the wrist depends on the first three joints alone, so the "
    "determinant is that of the arm times that of the wrist.  If the upper arm has a length, the "
    "determinant vanishes where X = 0 (shoulder: the centre of the wrist is on the base axis), "
    "where the arm is stretched or folded (elbow), and where axes 4 and 6 coincide (wrist).",
    {r"|\det J|": sp.Abs(det)},
    proves="The product of both determinants is the determinant of J up to the sign.",
    equal=[((at_wrist.det() * arm.geometric[3:, 3:].det()) ** 2, det**2)],
)

# The parallelogram and the motors

parallelogram_drive(d, {theta3: (theta2, a2)})

# Inverse kinematics

ik = Chain(d, forward)
wx, wy, wz = ik.vector("w", ik.p - d6 * ik.R[:, 2])
f = ik.program.let("f", sqrt(a3**2 + d4**2), nonnegative=True)
up = ik.let("up", wz - d1)
facing = {-1: "facing", +1: "backward"}
shoulder = ik.solve(turn, theta1, (wx, -wy, 0), facing)
d.step(
    "Inverse: the turret",
    "The centre of the wrist, which is d6 behind the tool, is in the plane of the arm.  Two "
    "angles of the turret put it there: facing (X >= 0) and backward (X <= 0).  If it is on the "
    "base axis, theta1 is free and we return 0.",
    {"w": centre, r"w_x \sin\theta_1 - w_y \cos\theta_1": sp.S.Zero},
    solves={"ik": [theta1]},
)
angle = ik.angle("elbow", theta3 + atan2(d4, a3))
lower = ik.angle("lower", theta2 - pi / 2)
forearm = ik.direction("forearm", a3, d4)
out = ik.let("out", shoulder.ahead - a1)
lift, bend = ik.solve(
    two_links, (lower, angle), (out, -up), (a2, f), {-1: "up", +1: "down"}, mirrored=shoulder.side
)
fore, bent = sqrt(a3**2 + d4**2), theta3 + atan2(d4, a3)
d.step(
    "Inverse: the elbow",
    "The upper arm a2, the forearm f and the line r from the shoulder to the wrist form a "
    "triangle.  The turn eta at the elbow follows from its sides.  theta3 is eta less the constant "
    "angle between the forearm and its frame.",
    {
        "f": fore,
        "r": sqrt((real("X") - a1) ** 2 + (real("Z") - d1) ** 2),
        r"a_2^2 + f^2 + 2 a_2 f\cos\eta": real("r") ** 2,
        r"\theta_3": angle - atan2(d4, a3),
    },
    proves="The centre of the wrist of the forward map is at the end of this triangle.",
    equal=[
        ((X - a1) ** 2 + (Z - d1) ** 2, a2**2 + fore**2 + 2 * a2 * fore * cos(bent)),
    ],
    solves={"ik": [angle]},
)
in_plane = ik.matrix("R1", rotation("x", pi / 2) * turned(shoulder).T * ik.R)
both = turned(lift + (bend - forearm).known_as(ik.program, "3"))
left = ik.matrix("R2", rotation("x", pi / 2) * both.T * in_plane)
ik.solve(zyz, left, (theta4, ik.angle("beta", -theta5), theta6), {-1: "noflip", +1: "flip"})
R03 = rotation("z", theta1) * rotation("x", -pi / 2) * rotation("z", forearm_turn - pi / 2)
R03 = R03 * rotation("x", -pi / 2)
R36 = rotation("z", theta4) * rotation("y", -theta5) * rotation("z", theta6)
wrist_step(d, arm.pose, R03, R36, (theta4, theta5, theta6))
px, py, pz = ik.p
R06 = r"R_{36} = R_{03}^T R"
ik.continuum(theta1, {px: d6 * ik.R[0, 2], py: d6 * ik.R[1, 2]}, R06)
aligned_wrist(ik, R03, theta4)
ik.finish(
    "All eight postures of a pose, as angles of the joints.",
    notes=(
        "motors_from_joints converts them to angles of the motors.",
        "facing: X >= 0; backward: X <= 0.  up: the elbow is above the line from the shoulder to "
        "the wrist; down: it is below.  Where X is between 0 and a1, up and down are interchanged.",
        "X is how far the centre of the wrist is ahead of the base axis.",
        "noflip: sin(theta5) >= 0; flip: sin(theta5) <= 0.",
    ),
    singular=(
        "the centre of the wrist on the base axis, theta1 = 0 is returned; equal links folded "
        "with the wrist on the shoulder, or a link without length.",
        "the wrist is aligned, sin(theta5) = 0, and theta4 = 0 is returned.",
    ),
)
