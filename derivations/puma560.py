"""The Puma 560 in standard Denavit-Hartenberg parameters, as in the Robotics Toolbox."""

import sympy as sp
from closedform.derivations.claims.puma560 import Puma, state
from closedform.derivations.papers import PUMA_TEXTBOOKS
from sympy import cos, pi, sin, sqrt

from closedform.derivation import Continuum, Derivation, Solved
from closedform.frames import chain, denavit_hartenberg, determinant, hat, rotation, vee
from closedform.functions import Program, branches, real
from closedform.lemmas import linear_pair
from closedform.pairs import direction, sine_cosine_pair, triangle_pairs
from closedform.serial import (
    body_jacobian,
    geometric_jacobian,
    given_transform,
    named_pose,
    product,
    space_jacobian,
    wrist_angles,
    wrist_partitioned,
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
SOURCE = "Corke's model of the Puma 560, Robotics Toolbox"


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
forward = Program()
pose = named_pose(forward, links)
d.step(
    "Denavit-Hartenberg table",
    "Standard (distal) frames.  The axes 2 and 3 are parallel, so their angles add.",
    {r"(a, \alpha, d, \theta)": sp.Matrix(rows), "A_2 A_3": arm[1]},
    equal=[(A[1] * A[2], arm[1])],
)
X = a2 * cos(theta2) + a3 * cos(theta2 + theta3) - d4 * sin(theta2 + theta3)
Z = a2 * sin(theta2) + a3 * sin(theta2 + theta3) + d4 * cos(theta2 + theta3)
position = product([*arm, A[3]])[:3, 3]
R03 = product(arm)[:3, :3]
R36 = product(wrist)[:3, :3]
d.step(
    "Pose",
    "The three axes of the wrist meet in its centre, which the wrist does not move.  In the plane "
    "of the arm it is at X forward and Z up.  The wrist is a ZYZ rotation with -theta5.",
    {"X": X, "Z": Z, "p": position, "R_{03}": R03, "R_{36}": R36},
    equal=[
        (product(links), forward.explicit(pose)),
        (position, sp.Matrix(rotation("z", theta1) * sp.Matrix([X, -d3, Z]))),
        (product(links)[:3, 3], position),
        (R36, rotation("z", theta4) * rotation("y", -theta5) * rotation("z", theta6)),
    ],
)
d.function(
    "fk",
    "Pose of the hand in the base frame.",
    {"q": q},
    {"T": pose},
    program=forward,
)
d.function("pose", "The same as fk.", {"q": q}, {"T": pose}, program=forward)

# Velocity

velocity, spatial, bodily = Program(), Program(), Program()
J = geometric_jacobian(velocity, links, q)
J_space = space_jacobian(spatial, links, q)
J_body = body_jacobian(bodily, links, q)
geometric = velocity.explicit(J)
det_arm, det_wrist = determinant(geometric[:3, :3]), determinant(geometric[3:, 3:])
det = det_arm * det_wrist
v, w = geometric[:3, :], geometric[3:, :]
R = product(links)[:3, :3]
rates = sp.Matrix.hstack(*(vee(R.diff(x) * R.T) for x in q))
elbow = a3 * sin(theta3) + d4 * cos(theta3)
d.step(
    "Jacobian",
    "The velocity of the centre of the wrist over the angular velocity of the hand, in the axes of "
    "the base.  The spatial and the body Jacobian are the twists (v; omega) of the hand frame in "
    "the base frame and in its own.",
    {"v": v[:, :3], r"\omega": geometric[3:, :]},
    equal=[
        (v, position.jacobian(q)),
        (w, rates),
        (spatial.explicit(J_space)[:3, :], v + hat(position) * w),
        (spatial.explicit(J_space)[3:, :], w),
        (R * bodily.explicit(J_body)[:3, :], v),
        (R * bodily.explicit(J_body)[3:, :], w),
    ],
)
d.step(
    "Determinant and singular set",
    "The wrist does not move its centre, so the determinant is that of the arm times that of the "
    "wrist.  It vanishes, for an upper arm that has a length, where X = 0 (shoulder: the centre of "
    "the wrist is as near to the base axis as d3 allows), where the arm is stretched or folded "
    "(elbow), and where the axes 4 and 6 coincide (wrist).",
    {r"\det J_{11}": det_arm, r"\det J_{22}": det_wrist},
    equal=[
        (v[:, 3:], sp.zeros(3)),
        (det_arm, -a2 * X * elbow),
        (w[:, 3:].det(), det_wrist),
        (det_wrist, -sin(theta5)),
    ],
)
d.function(
    "jacobian",
    "Velocity of the centre of the wrist over the angular velocity, in base axes, per joint rate.",
    {"q": q},
    {"J": J},
    program=velocity,
    notes=("The geometric Jacobian: rows (v; omega), v of the origin of the hand frame.",),
)
d.function(
    "jacobian_space",
    "Twist (v; omega) of the hand in the base frame per joint rate.",
    {"q": q},
    {"J": J_space},
    program=spatial,
)
d.function(
    "jacobian_body",
    "Twist (v; omega) of the hand in its own frame per joint rate.",
    {"q": q},
    {"J": J_body},
    program=bodily,
)
d.function("determinant", "Determinant of the Jacobian.", {"q": q}, {"det": det})
d.function(
    "singularities",
    "The factors of the shoulder, the elbow and the wrist.",
    {"q": q},
    {"factors": [X, elbow, sin(theta5)]},
)

# Inverse kinematics

side, bend, flip = real("sigma_shoulder"), real("sigma_elbow"), real("sigma_wrist")
choices = branches(
    (side, {+1: "right", -1: "left"}),
    (bend, {+1: "up", -1: "down"}),
    (flip, {+1: "noflip", -1: "flip"}),
)
d.branches = choices.labels
angle, alpha = real("elbow"), real("alpha")

p = Program()
T = given_transform(p)
px, py, pz = T[:3, 3]
f = p.let("f", sqrt(a3**2 + d4**2), nonnegative=True)
size = p.let("size", a2 + f + sp.Abs(d3), nonnegative=True)
shoulder, turn1, ahead = sine_cosine_pair(p, theta1, px, -py, d3, -side, size)
reach = p.let("reach", sqrt(ahead**2 + pz**2), nonnegative=True)
triangle, at_elbow, at_base, folded = triangle_pairs(
    p, a2, f, reach, angle, alpha, -side * bend, size, free=(theta3, theta2)
)
no_forearm = p.vanishes("no_forearm", f, size, "the forearm has no length", free=(theta3,))
bearing = direction(pz, ahead, reach, folded)
turn2 = (bearing - at_base).known_as(p, "2")
turn3 = (at_elbow - direction(d4, a3, f, no_forearm)).known_as(p, "3")
turn23 = (turn2 + turn3).known_as(p, "23")
turned = [(arm[0], {theta1: turn1}), (arm[1], {theta2 + theta3: turn23})]
angles = wrist_angles(p, T, turned, (theta4, theta5, theta6), flip, -1)
M = R03.T * T[:3, :3]
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
    Solved("ik", theta4, angles, M[0, 2] * sin(theta4) - M[1, 2] * cos(theta4)),
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
d.step(
    "Inverse: the wrist",
    "The arm leaves the rotation R_03^T R to the wrist, whose third column gives theta4 and "
    "theta5.  noflip has sin(theta5) >= 0, flip has theta4 and theta6 turned by pi and theta5 "
    "negated.  Where sin(theta5) = 0 only theta4 + theta6 or theta4 - theta6 is determined and we "
    "return theta4 = 0.",
    {"R_{36}": R36},
    equal=[
        (
            R36.subs(
                {theta4: theta4 + pi, theta5: -theta5, theta6: theta6 + pi}, simultaneous=True
            ),
            R36,
        )
    ],
)
d.function(
    "ik",
    "All eight configurations of a pose.",
    {"T": T},
    {
        "q": [
            turn1.angle,
            turn2.angle,
            turn3.angle,
            angles[theta4],
            angles[theta5],
            angles[theta6],
        ]
    },
    program=p,
    branches=choices,
    result="Solutions",
    notes=(
        "right: X >= 0, the arm faces the wrist; left: X <= 0.  up: the elbow is above the line "
        "from the shoulder to the wrist; down: below.  noflip: sin(theta5) >= 0; flip: <= 0.",
        "SINGULAR: the wrist is aligned, sin(theta5) = 0, theta4 = 0 is returned; the centre of "
        "the wrist on the base axis (d3 = 0), theta1 = 0 is returned; equal links folded with "
        "the wrist on the shoulder, theta2 = 0 is returned; or a link without length, theta3 is "
        "free.",
        "INVALID: a matrix that is no homogeneous transform, a mirrored rotation included.",
        "Ill-conditioned near the shoulder and elbow singularities, where the angles lose half "
        "the digits, the pose does not.",
    ),
)
beta, psi, delta = real("beta"), real("psi"), real("delta", positive=True)
rotated = T[:3, :3]
d.inverses.append(
    wrist_partitioned(
        "ik",
        T,
        arm,
        wrist,
        q,
        {theta1: turn1, theta2 + theta3: turn23},
        (
            Continuum(
                sp.Symbol("free_theta1"),
                {px: sp.S.Zero, py: sp.S.Zero, d3: sp.S.Zero},
                theta1,
                r"R_{36} = R_{03}^T R",
            ),
            *(
                Continuum(
                    folded,
                    {
                        px: sign * delta * sin(beta),
                        py: -sign * delta * cos(beta),
                        pz: sp.S.Zero,
                        d3: sign * delta,
                        a2: sqrt(a3**2 + d4**2),
                    },
                    theta2,
                    r"R_{36} = R_{03}^T R",
                )
                for sign in (1, -1)
            ),
            *(
                Continuum(
                    sp.Symbol("aligned"),
                    dict(zip(rotated, R03 * turn * rotation("z", psi), strict=True)),
                    theta4,
                    relation,
                )
                for turn, relation in (
                    (sp.eye(3), r"\theta_4 + \theta_6"),
                    (rotation("y", pi), r"\theta_4 - \theta_6"),
                )
            ),
        ),
    )
)

# Claims of the textbooks

state(d, Puma((a2, a3, d3, d4), q, links, position, R36, geometric, det))
