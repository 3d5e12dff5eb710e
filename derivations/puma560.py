"""The Puma 560 in standard Denavit-Hartenberg parameters, as in the Robotics Toolbox."""

import sympy as sp
from closedform.derivations.claims.puma560 import Puma, state
from closedform.derivations.papers.puma_textbooks import PUMA_TEXTBOOKS
from closedform.derivations.wrist_of_an_arm import aligned_wrist, wrist_step
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    LinksAtHeight,
    from_dh,
    real,
    rotation,
    turn,
    turned,
    two_links,
    zyz,
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
q = theta1, theta2, theta3, theta4, theta5, theta6 = [d.joint(f"theta{i}") for i in range(1, 7)]

# Forward kinematics and velocity

rows = [
    (0, pi / 2, 0, theta1),
    (a2, 0, 0, theta2),
    (a3, -pi / 2, d3, theta3),
    (0, pi / 2, d4, theta4),
    (0, -pi / 2, 0, theta5),
    (0, 0, 0, theta6),
]
d.write("base_elbow", r"\alpha", same="alpha")
d.write("alpha", meaning="angle at the shoulder, of the triangle of the arm")
d.write("elbow", r"\eta", "angle at the elbow, of the triangle of the arm")
d.explain(
    {
        "X": "how far the centre of the wrist is ahead of the base axis",
        "Z": "height of the centre of the wrist",
        "f": "length of the forearm, from the elbow to the centre of the wrist",
        "p": "centre of the wrist",
        "r": "distance of the centre of the wrist from the shoulder, in the plane of the arm",
    }
)
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
X = a2 * cos(theta2) + a3 * cos(theta2 + theta3) - d4 * sin(theta2 + theta3)
Z = a2 * sin(theta2) + a3 * sin(theta2 + theta3) + d4 * cos(theta2 + theta3)
elbow = a3 * sin(theta3) + d4 * cos(theta3)
det = a2 * X * elbow * sin(theta5)
forward = arm.export(d, {"shoulder": X, "elbow": elbow, "wrist": sin(theta5)})
d.step(
    "Centre of the wrist",
    "In the plane of the arm, the centre of the wrist is X forward and Z up. The joints of the "
    "wrist do not move it.",
    {"X": X, "Z": Z, "p": arm.position},
    proves="The position of the pose is this vector, turned by theta1.",
    equal=[(arm.position, rotation("z", theta1) * sp.Matrix([X, -d3, Z]))],
)
d.step(
    "Factors of the determinant",
    "The wrist does not move its centre, so the determinant is that of the arm times that of the "
    "wrist.  If the upper arm has a length, the determinant vanishes where X = 0 (shoulder: the "
    "centre of the wrist is as near to the base axis as d3 allows), where the arm is stretched or "
    "folded (elbow), and where axes 4 and 6 coincide (wrist).",
    {r"\det J": det},
    proves=(
        "The last three joints do not move the centre of the wrist, and the product of both "
        "determinants is that of J."
    ),
    equal=[
        (arm.geometric[:3, 3:], sp.zeros(3)),
        (arm.geometric[:3, :3].det() * arm.geometric[3:, 3:].det(), det),
    ],
)

# Inverse kinematics

ik = Chain(d, forward)
px, py, pz = ik.p
f = ik.program.let("f", sqrt(a3**2 + d4**2), nonnegative=True)
ik.size = a2 + f + sp.Abs(d3)
facing = {-1: "right", +1: "left"}
shoulder = ik.solve(turn, theta1, (px, -py, d3), facing, toward=LinksAtHeight(a2, f, pz))
d.step(
    "Inverse: the shoulder",
    "The third row of A_1^{-1} T says that the wrist is d3 beside the plane of the arm.  The two "
    "solutions face the wrist (right, X >= 0) and turn their back to it (left, X <= 0).  There is "
    "no solution if the wrist is nearer to the base axis than d3.  If it is on the axis, with d3 "
    "= 0, theta1 is free and we return 0.",
    {
        r"p_x \sin\theta_1 - p_y \cos\theta_1": d3,
        "X": -shoulder.side * sqrt(px**2 + py**2 - d3**2),
    },
    solves={"ik": [theta1]},
)
angle = ik.angle("elbow", theta3 + atan2(d4, a3))
forearm = ik.direction("forearm", a3, d4)
lift, bend = ik.solve(
    two_links,
    (theta2, angle),
    (shoulder.ahead, pz),
    (a2, f),
    {+1: "up", -1: "down"},
    mirrored=shoulder.side,
)
fore, bent = sqrt(a3**2 + d4**2), theta3 + atan2(d4, a3)
ahead = arm.position[0] * cos(theta1) + arm.position[1] * sin(theta1)
height = arm.position[2]
d.step(
    "Inverse: the elbow",
    "The upper arm a2, the forearm f and the line r from the shoulder to the wrist form a "
    "triangle.  The turn eta at the elbow follows from its sides, and so does the angle alpha "
    "between the upper arm and the line r.  theta3 is eta less the constant angle between the "
    "forearm and its frame.  up: the elbow is above the line from the shoulder to the wrist; down: "
    "below.  X is negative if the arm turns its back to the wrist.  The elbow that is above then "
    "has the other sign of eta, so this sign is the product of those of the shoulder and of the "
    "elbow.",
    {
        "f": fore,
        "r": sqrt(real("X") ** 2 + pz**2),
        r"a_2^2 + f^2 + 2 a_2 f\cos\eta": real("r") ** 2,
        r"r\cos\alpha": a2 + f * cos(angle),
        r"r\sin\alpha": f * sin(angle),
        r"\theta_3": angle - atan2(d4, a3),
        r"\theta_2": atan2(pz, real("X")) - real("alpha"),
    },
    proves="The wrist of the forward map is at the end of this triangle: the squares of its "
    "coordinates in the plane of the arm add up to the cosine law, and its parts along the upper "
    "arm and across it are those of the forearm.",
    equal=[
        (ahead**2 + height**2, a2**2 + fore**2 + 2 * a2 * fore * cos(bent)),
        (ahead * cos(theta2) + height * sin(theta2), a2 + fore * cos(bent)),
        (height * cos(theta2) - ahead * sin(theta2), fore * sin(bent)),
    ],
    solves={"ik": [theta2]},
)
in_plane = ik.matrix("R1", rotation("x", -pi / 2) * turned(shoulder).T * ik.R)
both = turned(lift + (bend - forearm).known_as(ik.program, "3"))
left = ik.matrix("R2", rotation("x", pi / 2) * both.T * in_plane)
ik.solve(zyz, left, (theta4, ik.angle("beta", -theta5), theta6), {-1: "noflip", +1: "flip"})
R03 = rotation("z", theta1) * rotation("x", pi / 2) * rotation("z", theta2 + theta3)
R03 = R03 * rotation("x", -pi / 2)
R36 = rotation("z", theta4) * rotation("y", -theta5) * rotation("z", theta6)
wrist_step(d, arm.pose, R03, R36, (theta4, theta5, theta6))
R06 = r"R_{36} = R_{03}^T R"
ik.continuum(theta1, {px: 0, py: 0, d3: 0}, R06)
ik.continuum(
    theta2,
    {px: d3 * sin(theta1), py: -d3 * cos(theta1), pz: 0, a2: sqrt(a3**2 + d4**2)},
    R06,
)
aligned_wrist(ik, R03, theta4)
ik.finish(
    "All 8 configurations of a pose.",
    notes=(
        "right: X >= 0, the arm faces the wrist; left: X <= 0.  up: the elbow is above the line "
        "from the shoulder to the wrist; down: below.",
        "X is how far the centre of the wrist is ahead of the base axis.",
        "noflip: sin(theta5) >= 0; flip: sin(theta5) <= 0.",
        "Ill-conditioned near the shoulder and elbow singularities: the angles lose half their "
        "digits, the pose does not.",
        "INVALID: the matrix is not a homogeneous transform with a proper rotation.",
    ),
    singular=(
        "the centre of the wrist on the base axis (d3 = 0), theta1 = 0 is returned; equal links "
        "folded with the wrist on the shoulder, theta2 = 0 is returned; or a link without length, "
        "theta3 is free.",
        "the wrist is aligned, sin(theta5) = 0, and theta4 = 0 is returned.",
    ),
)

# Claims of the textbooks

links = list(arm.moves)
state(
    d,
    Puma(
        lengths=(a2, a3, d3, d4),
        q=q,
        links=links,
        position=arm.position,
        R36=R36,
        J=arm.geometric,
        det=det,
    ),
)
