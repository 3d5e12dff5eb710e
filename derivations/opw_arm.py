"""Industrial six-axis arms: a turret, two parallel joints and a spherical wrist, with offsets."""

import sympy as sp
from closedform.derivations.claims.opw_arm import state
from closedform.derivations.papers.ortho_parallel import ORTHO_PARALLEL
from closedform.derivations.wrist_of_an_arm import aligned_wrist, wrist_step
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    Links,
    Pair,
    from_dh,
    real,
    rotation,
    turn,
    turned,
    two_links,
    zyz,
)

d = Derivation(
    "opw_arm",
    "Industrial six-axis arm (OPW)",
    ORTHO_PARALLEL,
    "theta1 turns about the vertical.  The axes of theta2 and theta3 are horizontal and parallel, "
    "and a spherical wrist (theta4, theta5, theta6) carries the tool.  At zero angles the upper "
    "arm, the forearm and the tool point upwards; the shoulder is a1 forward of the first axis, "
    "the axis of the forearm a2 forward of the elbow, and the arm b to the left of the first "
    "axis.  Most industrial arms are of this kind, up to the zeros and signs of their joints.",
)


def length(name: str, millimetres: int, meaning: str, *, nonnegative: bool = True) -> sp.Symbol:
    value, source = sp.Rational(millimetres, 1000), "KUKA KR 6 R700 sixx, as in opw_kinematics"
    if name.startswith("c"):  # upright, it would be a cosine
        d.write(name, rf"\ell_{name[1:]}")
    return d.parameter(
        name, value=value, unit="m", meaning=meaning, source=source, nonnegative=nonnegative
    )


a1 = length("a1", 25, "from the first axis forward to the shoulder", nonnegative=False)
a2 = length("a2", -35, "from the elbow forward to the axis of the forearm", nonnegative=False)
b = length("b", 0, "from the first axis to the left, to the arm", nonnegative=False)
c1 = length("c1", 400, "from the base up to the shoulder", nonnegative=False)
c2 = length("c2", 315, "length of the upper arm")
c3 = length("c3", 365, "along the forearm, from the elbow to the centre of the wrist")
c4 = length("c4", 80, "from the centre of the wrist to the tool", nonnegative=False)
q = theta1, theta2, theta3, theta4, theta5, theta6 = [d.joint(f"theta{i}") for i in range(1, 7)]

# Forward kinematics and velocity

rows = [
    (a1, -pi / 2, c1, theta1),
    (c2, 0, 0, theta2 - pi / 2),
    (a2, pi / 2, b, theta3 + pi / 2),
    (0, -pi / 2, c3, theta4),
    (0, pi / 2, 0, theta5),
    (0, 0, c4, theta6),
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
    "Standard (distal) frames.  The axes 2 and 3 are parallel, so their angles add.  The lengths "
    "c_1 to c_4 of the paper are written with an l here, because c_1 is also a cosine.",
    {},
    rows=[
        ("Link", "a_i", "alpha_i", "d_i", "theta_i"),
        *((sp.Integer(i), *map(sp.sympify, row)) for i, row in enumerate(rows, 1)),
    ],
)
arm = from_dh(d, rows)
forearm_turn = theta2 + theta3
X = a1 + c2 * sin(theta2) + a2 * cos(forearm_turn) + c3 * sin(forearm_turn)
Z = c1 + c2 * cos(theta2) - a2 * sin(forearm_turn) + c3 * cos(forearm_turn)
elbow = a2 * cos(theta3) + c3 * sin(theta3)
centre = rotation("z", theta1) * sp.Matrix([X, b, Z])
forward = arm.export(d, {"shoulder": X, "elbow": elbow, "wrist": sin(theta5)})
d.step(
    "Centre of the wrist",
    "The plane of the arm is b to the left of the first axis. In this plane, the centre of the "
    "wrist is X forward and Z up. The joints of the wrist do not move it.",
    {"X": X, "Z": Z, "w": centre},
    proves="The tool is at the distance c4 from this point, along the last axis.",
    equal=[(arm.position, centre + c4 * arm.pose[:3, 2])],
)
at_wrist = centre.jacobian(q[:3])
det = c2 * X * elbow * sin(theta5)
d.step(
    "Factors of the determinant",
    "The velocity of the centre of the wrist depends on the first three joints alone, so the "
    "determinant is that of the arm times that of the wrist.  If the upper arm has a length, the "
    "determinant vanishes where X = 0 (shoulder: the centre of the wrist is as near to the first "
    "axis as b allows), where the arm is stretched or folded (elbow), and where axes 4 and 6 "
    "coincide (wrist).",
    {r"|\det J|": sp.Abs(det)},
    proves="The product of both determinants is the determinant of J up to the sign.",
    equal=[((at_wrist.det() * arm.geometric[3:, 3:].det()) ** 2, det**2)],
)

# Inverse kinematics

ik = Chain(d, forward)
wx, wy, wz = ik.vector("w", ik.p - c4 * ik.R[:, 2])
f = ik.program.let("f", sqrt(a2**2 + c3**2), nonnegative=True)
up = ik.let("up", wz - c1)
facing = {-1: "facing", +1: "backward"}


def from_shoulder(turret: Pair) -> sp.Matrix:
    """The centre of the wrist in the plane of the arm, seen from the shoulder."""
    return sp.Matrix([turret.c * wx + turret.s * wy - a1, up, 0])


links = Links(from_shoulder, c2, f)
shoulder = ik.solve(turn, theta1, (wx, -wy, -b), facing, toward=links)
d.step(
    "Inverse: the turret",
    "The centre of the wrist, which is c4 behind the tool, is in the plane of the arm.  Two "
    "angles of the turret put it there: facing (X >= 0) and backward (X <= 0).  There is no "
    "solution if it is nearer to the first axis than b.  If it is on the axis, with b = 0, theta1 "
    "is free and we return 0.",
    {"w": centre, r"w_x \sin\theta_1 - w_y \cos\theta_1": -b},
    solves={"ik": [theta1]},
)
angle = ik.angle("elbow", theta3 + atan2(a2, c3))
lower = ik.angle("lower", theta2 - pi / 2)
forearm = ik.direction("forearm", c3, a2)
out = ik.let("out", shoulder.ahead - a1)
lift, bend = ik.solve(
    two_links, (lower, angle), (out, -up), (c2, f), {-1: "up", +1: "down"}, mirrored=shoulder.side
)
fore, bent = sqrt(a2**2 + c3**2), theta3 + atan2(a2, c3)
d.step(
    "Inverse: the elbow",
    "The upper arm c2, the forearm f and the line r from the shoulder to the wrist form a "
    "triangle.  The turn eta at the elbow follows from its sides.  theta3 is eta less the constant "
    "angle between the forearm and its frame.",
    {
        "f": fore,
        "r": sqrt((real("X") - a1) ** 2 + (real("Z") - c1) ** 2),
        r"\ell_2^2 + f^2 + 2 \ell_2 f\cos\eta": real("r") ** 2,
        r"\theta_3": angle - atan2(a2, c3),
    },
    proves="The centre of the wrist of the forward map is at the end of this triangle.",
    equal=[
        ((X - a1) ** 2 + (Z - c1) ** 2, c2**2 + fore**2 + 2 * c2 * fore * cos(bent)),
    ],
    solves={"ik": [angle]},
)
in_plane = ik.matrix("R1", rotation("x", pi / 2) * turned(shoulder).T * ik.R)
both = turned(lift + (bend - forearm).known_as(ik.program, "3"))
upright = rotation("x", -pi / 2) * rotation("z", -pi / 2)
left = ik.matrix("R2", upright * both.T * in_plane)
ik.solve(zyz, left, (theta4, theta5, theta6), {+1: "noflip", -1: "flip"})
R03 = rotation("z", theta1) * rotation("y", forearm_turn)
R36 = rotation("z", theta4) * rotation("y", theta5) * rotation("z", theta6)
wrist_step(d, arm.pose, R03, R36, (theta4, theta5, theta6))
px, py, pz = ik.p
R06 = r"R_{36} = R_{03}^T R"
ik.continuum(theta1, {px: c4 * ik.R[0, 2], py: c4 * ik.R[1, 2], b: 0}, R06)
aligned_wrist(ik, R03, theta4)
ik.finish(
    "All eight postures of a pose.",
    notes=(
        "facing: X >= 0; backward: X <= 0.  up: the elbow is above the line from the shoulder to "
        "the wrist; down: it is below.  Where X is between 0 and a1, up and down are interchanged.",
        "X is how far the centre of the wrist is ahead of the base axis.",
        "noflip: sin(theta5) >= 0; flip: sin(theta5) <= 0.",
        "Ill-conditioned near the shoulder and elbow singularities: the angles lose half their "
        "digits, the pose does not.",
        "INVALID: the matrix is not a homogeneous transform with a proper rotation.",
    ),
    singular=(
        "the centre of the wrist on the first axis (b = 0), theta1 = 0 is returned; equal links "
        "folded with the wrist on the shoulder, theta2 = 0 is returned; or a link without length, "
        "theta3 is free.",
        "the wrist is aligned, sin(theta5) = 0, and theta4 = 0 is returned.",
    ),
)

# Claims

state(d, (a1, a2, b, c1, c2, c3, c4), q, arm.pose, centre)
