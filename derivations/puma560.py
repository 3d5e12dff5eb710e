"""The Puma 560 in standard Denavit-Hartenberg parameters, as in the Robotics Toolbox."""

import sympy as sp
from closedform.derivations.claims.puma560 import Puma, state
from closedform.derivations.papers import PUMA_TEXTBOOKS
from sympy import cos, pi, sin, sqrt

from closedform import (
    Derivation,
    Program,
    Solved,
    branches,
    chain,
    denavit_hartenberg,
    direction,
    export_determinant,
    export_inverse,
    export_jacobians,
    export_pose,
    given_transform,
    linear_pair,
    product,
    real,
    rotation,
    sine_cosine_pair,
    triangle_pairs,
)

d = Derivation(
    "puma560",
    "Puma 560",
    PUMA_TEXTBOOKS,
    "A vertical base axis (theta1), two parallel horizontal axes (theta2, theta3) and a spherical "
    "wrist (theta4, theta5, theta6).  The frames are those of the standard Denavit-Hartenberg "
    "table of the Robotics Toolbox: the base frame is at the height of the shoulder, the hand "
    "frame at the centre of the wrist.  At zero angles the upper arm is level along x and the "
    "forearm upright.",
    task=[f"T{i}{j}" for i in range(1, 5) for j in range(1, 5)],
    singularities=("shoulder", "elbow", "wrist"),
)
SOURCE = "Puma 560 of the Robotics Toolbox (Corke)"


def length(name: str, value: str, meaning: str, *, nonnegative: bool = True) -> sp.Symbol:
    return d.parameter(
        name,
        value=sp.Rational(value),
        unit="m",
        meaning=meaning,
        source=SOURCE,
        nonnegative=nonnegative,
    )


a2 = length("a2", "0.4318", "length of the upper arm")
a3 = length("a3", "0.0203", "offset of the forearm at the elbow", nonnegative=False)
d3 = length("d3", "0.15005", "offset of the arm from the base axis", nonnegative=False)
d4 = length("d4", "0.4318", "length of the forearm, from the elbow to the wrist")
q = tuple(d.joint(f"theta{i}") for i in range(1, 7))
theta1, theta2, theta3, theta4, theta5, theta6 = q

# Forward kinematics

rows = [
    (0, pi / 2, 0, theta1),
    (a2, 0, 0, theta2),
    (a3, -pi / 2, d3, theta3),
    (0, pi / 2, d4, theta4),
    (0, -pi / 2, 0, theta5),
    (0, 0, 0, theta6),
]
A = [denavit_hartenberg(*row) for row in rows]
arm, wrist = [A[0], chain(A[1:3])], A[3:]
links = [*arm, *wrist]
d.step(
    "Denavit-Hartenberg table",
    "Standard (distal) frames.  The axes 2 and 3 are parallel, so their angles add.",
    {r"(a, \alpha, d, \theta)": sp.Matrix(rows), "A_2 A_3": arm[1]},
    equal=[(A[1] * A[2], arm[1])],
)
pose = export_pose(d, links, "The axes 2 and 3 are one link.")
X = a2 * cos(theta2) + a3 * cos(theta2 + theta3) - d4 * sin(theta2 + theta3)
Z = a2 * sin(theta2) + a3 * sin(theta2 + theta3) + d4 * cos(theta2 + theta3)
position = pose[:3, 3]
d.step(
    "Centre of the wrist",
    "In the plane of the arm it is at X forward and Z up; the wrist does not move it.",
    {"X": X, "Z": Z, "p": product([*arm, A[3]])[:3, 3]},
    equal=[(position, rotation("z", theta1) * sp.Matrix([X, -d3, Z]))],
)

# Velocity

J = export_jacobians(d, links)
elbow = a3 * sin(theta3) + d4 * cos(theta3)
det = export_determinant(
    d,
    J,
    {"shoulder": X, "elbow": elbow, "wrist": sin(theta5)},
    "It vanishes, for an upper arm that has a length, where X = 0 (shoulder: the centre of the "
    "wrist is as near to the base axis as d3 allows), where the arm is stretched or folded "
    "(elbow), and where the axes 4 and 6 coincide (wrist).",
)
d.step(
    "Factors",
    "The factors of the shoulder, the elbow and the wrist.",
    {r"\det J": det},
    equal=[(det, a2 * X * elbow * sin(theta5))],
)

# Inverse kinematics

side, bend, flip = real("sigma_shoulder"), real("sigma_elbow"), real("sigma_wrist")
choices = branches(
    (side, {+1: "right", -1: "left"}),
    (bend, {+1: "up", -1: "down"}),
    (flip, {+1: "noflip", -1: "flip"}),
)
angle, alpha = real("elbow"), real("alpha")

p = Program()
T = given_transform(p)
px, py, pz = T[:3, 3]
f = p.let("f", sqrt(a3**2 + d4**2), nonnegative=True)
size = p.let("size", a2 + f + sp.Abs(d3), nonnegative=True)
shoulder, turn1, ahead, on_axis = sine_cosine_pair(
    p, theta1, px, -py, d3, -side, size, reach=(a2, f, pz)
)
reach = p.let("reach", sqrt(ahead**2 + pz**2), nonnegative=True)
triangle, at_elbow, at_base, folded = triangle_pairs(
    p, a2, f, reach, angle, alpha, -side * bend, size, free=(theta3, theta2)
)
no_forearm = p.vanishes("no_forearm", f, size, "the forearm has no length", free=(theta3,))
bearing = direction(pz, ahead, reach, folded)
turn2 = (bearing - at_base).known_as(p, "2")
turn3 = (at_elbow - direction(d4, a3, f, no_forearm)).known_as(p, "3")
turn23 = (turn2 + turn3).known_as(p, "23")
d.solved += [
    Solved("ik", theta1, shoulder, px * sin(theta1) - py * cos(theta1) - d3),
    Solved(
        "ik",
        theta3,
        triangle,
        px**2
        + py**2
        + pz**2
        - d3**2
        - a2**2
        - a3**2
        - d4**2
        - 2 * a2 * (a3 * cos(theta3) - d4 * sin(theta3)),
    ),
    Solved(
        "ik",
        theta2,
        linear_pair(theta2, pz, ahead),
        (px * cos(theta1) + py * sin(theta1)) * Z - pz * X,
    ),
]
d.step(
    "Inverse: the shoulder",
    "The third row of A_1^{-1} T says that the wrist is d3 beside the plane of the arm.  The two "
    "solutions face the wrist (right, X >= 0) and turn their back to it (left, X <= 0).  Nearer to "
    "the base axis than d3 there is none; on the axis itself, with d3 = 0, theta1 is free and we "
    "return 0.",
    {r"p_x \sin\theta_1 - p_y \cos\theta_1": d3, "X": side * sqrt(px**2 + py**2 - d3**2)},
)
d.step(
    "Inverse: the elbow",
    "The upper arm a2, the forearm f and the line from the shoulder to the wrist are a triangle, "
    "whose angle at the elbow is theta3 plus that of the forearm against its frame.  up: the elbow "
    "is above the line from the shoulder to the wrist; down: below.",
    {
        "f": sqrt(a3**2 + d4**2),
        "r": sqrt(X**2 + pz**2),
        r"\theta_3": real("elbow") - sp.atan2(d4, a3),
        r"\theta_2": sp.atan2(pz, real("X")) - alpha,
    },
)
beta, delta = real("beta"), real("delta", positive=True)
export_inverse(
    d,
    p,
    T,
    {theta1: turn1.angle, theta2: turn2.angle, theta3: turn3.angle},
    [(arm[0], {theta1: turn1}), (arm[1], {theta2 + theta3: turn23})],
    wrist,
    choices,
    flip,
    turn=-1,
    free=[
        (theta1, on_axis, {px: 0, py: 0, d3: 0}),
        *(
            (
                theta2,
                folded,
                {px: k * sin(beta), py: -k * cos(beta), pz: 0, d3: k, a2: sqrt(a3**2 + d4**2)},
            )
            for k in (delta, -delta)
        ),
    ],
    notes=(
        "right: X >= 0, the arm faces the wrist; left: X <= 0.  up: the elbow is above the line "
        "from the shoulder to the wrist; down: below.",
        "SINGULAR: the centre of the wrist on the base axis (d3 = 0), theta1 = 0 is returned; "
        "equal links folded with the wrist on the shoulder, theta2 = 0 is returned; or a link "
        "without length, theta3 is free.",
        "Ill-conditioned near the shoulder and elbow singularities, where the angles lose half "
        "the digits, the pose does not.",
    ),
)

# Claims of the textbooks

state(d, Puma((a2, a3, d3, d4), q, links, position, product(wrist)[:3, :3], J, det))
