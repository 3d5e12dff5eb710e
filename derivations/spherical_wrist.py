"""The spherical wrist of Reddy and Babu, by ZYZ Euler angles and by Denavit-Hartenberg."""

import sympy as sp
from closedform.derivations.claims.spherical_wrist import state
from closedform.derivations.claims.spherical_wrist_notation import Wrist
from closedform.derivations.papers.reddy_babu import REDDY_BABU
from sympy import cos, sin

from closedform import (
    Degenerate,
    Derivation,
    Inverse,
    Program,
    Solved,
    angular_velocity_matrix,
    branches,
    chain,
    denavit_hartenberg,
    determinant,
    homogeneous,
    real,
    require_rotation,
    rotation,
    rotation_parametrisation,
    skeleton,
    zyz_angles,
)

d = Derivation(
    "spherical_wrist",
    "Spherical wrist",
    REDDY_BABU,
    "The axes of three revolute joints meet in one point.  theta4 turns about z, theta5 about the "
    "y axis after that turn, and theta6 about the z axis after both.  The hand is at the distance "
    "d6 along the last axis.",
    task=[f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)],
    singularities=("axes 4 and 6 coincide",),
)
d6 = d.parameter(
    "d6",
    value=1,
    unit="any length",
    meaning="distance of the hand from the centre of the wrist",
    source="the paper gives no value",
    nonnegative=False,
)
theta4, theta5, theta6 = d.joint("theta4"), d.joint("theta5"), d.joint("theta6")
q = (theta4, theta5, theta6)

# Orientation by Euler angles

R = chain([rotation("z", theta4), rotation("y", theta5), rotation("z", theta6)])
d.explain(
    {
        "A_4": "motion from link to link",
        "A_5": "motion from link to link",
        "A_6": "motion from link to link",
        "J_s": "angular velocity in the base frame per joint rate",
        "J_b": "angular velocity in the hand frame per joint rate",
    }
)
by_angles = d.step(
    "Orientation by ZYZ Euler angles",
    "Rotations about the axes of the moving frame multiply from left to right.",
    {r"R = R_z(\theta_4)\,R_y(\theta_5)\,R_z(\theta_6)": R},
    published=("(12)",),
    proves="R is a rotation: R R^T is the identity and the determinant is 1.",
    equal=[(R * R.T, sp.eye(3)), (R.det(), sp.Integer(1))],
)

# Pose by Denavit-Hartenberg

A4 = denavit_hartenberg(0, -sp.pi / 2, 0, theta4)
A5 = denavit_hartenberg(0, sp.pi / 2, 0, theta5)
A6 = denavit_hartenberg(0, 0, d6, theta6)
pose = chain([A4, A5, A6])
d.step(
    "Pose by Denavit-Hartenberg",
    "Table II of the paper has twists of -90 and +90 degrees; the offset d6 is the only length.  "
    "The rotation is that of the Euler angles, which the paper calls phi, theta and varphi: they "
    "are theta4, theta5 and theta6.",
    {"A_4": A4, "A_5": A5, "A_6": A6, "T = A_4 A_5 A_6": pose},
    published=("(14)", "(15)", "Table II"),
    proves="The rotation of T is R, and T is R followed by the offset d6 along z.",
    equal=[(pose[:3, :3], R), (pose, homogeneous(R) * homogeneous(sp.eye(3), (0, 0, d6)))],
    uses=[by_angles],
)
d.function("fk", "Rotation of the hand.", {"q": q}, {"R": R}, source="eqs. (12) and (15)")
d.function(
    "pose", "Pose of the hand, with its offset d6.", {"q": q}, {"T": pose}, source="eq. (14)"
)

skeleton(
    d,
    {"centre": (0, 0, 0), "hand": pose[:3, 3]},
    links={"hand": ("centre", "hand")},
    joints=dict.fromkeys(q, ("centre",)),
    hand="hand",
    hand_at=pose[:3, 3],
    ground=("centre",),
)

# Velocity

space = angular_velocity_matrix(R, q, "space")
body = angular_velocity_matrix(R, q, "body")
det = determinant(space)
d.step(
    "Angular Jacobians",
    "In the space frame, the columns are the present axes of the joints: z, the turned y and the "
    "last column of R.  In the body frame, they are the same axes in the frame of the hand.",
    {"J_s": space, "J_b": body},
    proves=(
        "The columns of the spatial Jacobian are the present axes of the joints, and it is R "
        "times the body Jacobian."
    ),
    equal=[
        (space, sp.Matrix.hstack(sp.Matrix([0, 0, 1]), rotation("z", theta4)[:, 1], R[:, 2])),
        (space, R * body),
    ],
    uses=[by_angles],
)
d.step(
    "Determinant and singular set",
    "Both determinants are the same, because the frames differ by a rotation.  They vanish "
    "exactly if theta5 is 0 or pi: then the first and the last axis coincide, and the hand cannot "
    "turn about the normal to axes 4 and 5.",
    {r"\det J_s = \det J_b": det},
    proves="Both determinants are the stated one.",
    equal=[(space.det(), det), (body.det(), det)],
)
d.function(
    "jacobian_space",
    "Angular velocity in the base frame per joint rate.",
    {"q": q},
    {"J": space},
)
d.function(
    "jacobian_body",
    "Angular velocity in the hand frame per joint rate.",
    {"q": q},
    {"J": body},
)
d.function("determinant", "Determinant of either angular Jacobian.", {"q": q}, {"det": det})
d.function(
    "singularities",
    "The factor that vanishes exactly if the axes 4 and 6 coincide.",
    {"q": q},
    {"factors": [sin(theta5)]},
)

# Inverse

given = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
sigma = real("sigma_wrist")
flip = branches((sigma, {+1: "theta5_positive", -1: "theta5_negative"}))
d.branches = flip.labels

p = Program()
require_rotation(p, given)
angles = zyz_angles(p, given, q, sigma).lemma
undone, remaining = (rotation("z", theta4).T * M for M in (R, given))
d.solved.append(Solved("ik", theta4, angles, given[0, 2] * sin(theta4) - given[1, 2] * cos(theta4)))
d.step(
    "Inverse orientation",
    "The third column of R gives theta4, up to the sign of sin(theta5), and then theta5.  theta6 "
    "follows from the rotation that remains after theta4 is undone.  Eq. (16) takes theta6 from "
    "the third row instead, which hardly depends on it if theta5 is small.",
    {
        r"\theta_4": sp.atan2(sigma * given[1, 2], sigma * given[0, 2]),
        r"\theta_5": sp.atan2(remaining[0, 2], given[2, 2]),
        r"\theta_6": sp.atan2(remaining[1, 0], remaining[1, 1]),
    },
    published=("(13)", "(16)"),
    uses=[by_angles],
    proves="The third column of R is sin(theta5) times the direction of theta4, above the cosine "
    "of theta5.  After theta4 is undone, it holds the sine of theta5, and the second row holds "
    "the sine and the cosine of theta6.",
    equal=[
        (R[:, 2], sp.Matrix([sin(theta5) * cos(theta4), sin(theta5) * sin(theta4), cos(theta5)])),
        (undone[0, 2], sin(theta5)),
        (undone[1, :], sp.Matrix([[sin(theta6), cos(theta6), 0]])),
    ],
    solves={"ik": ()},
)
d.function(
    "ik",
    "Both wrist configurations for a rotation.",
    {"R": given},
    {"q": [angles[theta4], angles[theta5], angles[theta6]]},
    program=p,
    branches=flip,
    result="Solutions",
    source="eqs. (13) and (16), with theta6 from the remaining rotation",
    notes=(
        "SINGULAR: theta5 = 0 or pi; only theta4 + theta6 or theta4 - theta6 is determined, and "
        "theta4 = 0 is returned.",
        "INVALID: the matrix is not a proper rotation, for example a reflection.",
        "Near theta5 = 0 and pi, theta4 and theta6 are ill-conditioned; their sum or difference is "
        "not.",
    ),
)
free = real("psi")
aligned = sp.Symbol("aligned")
turned = rotation("z", free)
opposed = rotation("y", sp.pi) * rotation("z", free)
d.inverses.append(
    Inverse(
        "ik",
        q,
        tuple(given),
        tuple(R),
        tuple(
            Degenerate((aligned,), dict(zip(given, R0, strict=True)), theta4, relation=kept)
            for R0, kept in ((turned, r"\theta_4+\theta_6"), (opposed, r"\theta_6-\theta_4"))
        ),
        parametrisation=tuple(rotation_parametrisation()),
    )
)

# Claims of the paper

state(d, Wrist(d6, theta4, theta5, theta6, R, pose, space))
