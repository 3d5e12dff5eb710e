"""Arms with a spherical shoulder and an offset elbow and hand, such as the Franka Emika Panda."""

import sympy as sp
from closedform.derivations.papers.seven_joints import OFFSET_ARMS
from sympy import cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    LinkAtHeight,
    Pair,
    TwoTurns,
    from_dh,
    law_of_cosines,
    real,
    rotate,
    rotation,
    turn,
    turned,
    zyz,
)

d = Derivation(
    "franka_arm",
    "Seven-joint arm with an offset elbow and hand (Franka)",
    OFFSET_ARMS,
    "The axes of theta1, theta2 and theta3 meet in the shoulder.  The axis of theta4, the elbow, "
    "is offset from the upper arm and from the forearm.  The axes of theta5 and theta6 meet in "
    "the wrist, and the axis of theta7 is offset from it.  As in the maker's table, the "
    "Denavit-Hartenberg parameters are modified (Craig's).  At zero angles the arm points upwards "
    "and its hand downwards.  theta7 is an input of the inverse.",
)


def length(name: str, micrometres: int, meaning: str, *, nonnegative: bool = True) -> sp.Symbol:
    value, source = sp.Rational(micrometres, 10**6), "the maker's table of the Panda"
    return d.parameter(
        name, value=value, unit="m", meaning=meaning, source=source, nonnegative=nonnegative
    )


d1 = length("d1", 333000, "from the base up to the shoulder", nonnegative=False)
d3 = length("d3", 316000, "from the shoulder along the upper arm")
a4 = length("a4", 82500, "from the upper arm across to the elbow")
a5 = length("a5", 82500, "from the elbow back to the forearm")
d5 = length("d5", 384000, "along the forearm to the wrist")
a7 = length("a7", 88000, "from the wrist across to the last axis", nonnegative=False)
d7 = length("d7", 107000, "along the last axis to the flange", nonnegative=False)
q = theta1, theta2, theta3, theta4, theta5, theta6, theta7 = [
    d.joint(f"theta{i}") for i in range(1, 8)
]

# Forward kinematics and velocity

arm = from_dh(
    d,
    [
        (0, 0, d1, theta1),
        (0, -pi / 2, 0, theta2),
        (0, pi / 2, d3, theta3),
        (a4, pi / 2, 0, theta4),
        (-a5, -pi / 2, d5, theta5),
        (0, pi / 2, 0, theta6),
        (a7, pi / 2, d7, theta7),
    ],
    modified=True,
)
beside = a5 - a4 * cos(theta4) - d3 * sin(theta4)
bend = (a4 * d5 + a5 * d3) * cos(theta4) + (d3 * d5 - a4 * a5) * sin(theta4)
factors = {"shoulder": sin(theta2), "elbow": bend, "axis": beside, "wrist": cos(theta5)}
forward = arm.export(d, factors, given=theta7)
v = sp.Matrix([beside, 0, a4 * sin(theta4) - d3 * cos(theta4) - d5])
to_elbow, to_wrist = sp.prod(arm.moves[:4]), sp.prod(arm.moves[:6])
frame = to_elbow[:3, :3] * rotation("x", -pi / 2)
R03 = rotation("z", theta1) * rotation("y", theta2) * rotation("z", theta3)
R37 = sp.prod(arm.moves[3:])[:3, :3]
d.explain(
    {
        "s": "the shoulder, seen from joint 7 in the axes of the tool",
        "v": "the shoulder, seen from the wrist in the frame of the forearm",
        "u": "the shoulder, seen from the wrist in the frame after theta6",
        "w": "the shoulder, seen from the wrist in the frame before theta6",
        "R_{03}": "rotation of the upper arm",
        "R_{37}": "rotation by the other four joints",
    }
)
d.step(
    "The shoulder from the wrist",
    "The vector v leads from the wrist to the shoulder, in the frame of the forearm before theta5 "
    "turns it.  It depends on the elbow alone and stays in a plane.  The arm is singular where "
    "axes 1 and 3 coincide (shoulder), where it is stretched or folded (elbow), where the "
    "shoulder is on axis 5 (axis), and where axis 6 is in the plane of the arm (wrist).",
    {"v": v},
    proves="v is the vector from the wrist to the shoulder, turned into the frame of the forearm.",
    equal=[(frame.T * (sp.Matrix([0, 0, d1]) - to_wrist[:3, 3]), v)],
)

# Inverse kinematics

ik = Chain(d, forward)
given = ik.given(theta7)
s = ik.vector("s", ik.R.T * (sp.Matrix([0, 0, d1]) - ik.p) + sp.Matrix([0, 0, d7]))
u = ik.vector("u", rotation("x", pi / 2) * (turned(given) * s + sp.Matrix([a7, 0, 0])))
far = ik.let("far", sqrt(u.dot(u)))
reach = ik.let("reach", sqrt(u[0] ** 2 + u[1] ** 2))
d.step(
    "Inverse: the shoulder",
    "In the frame of the hand, s leads to the shoulder from the point of the last axis that is d7 "
    "before the hand.  theta7 is given, so the vector u from the wrist to the shoulder is known "
    "too, in the frame of theta6.",
    {
        "s": ik.R.T * (sp.Matrix([0, 0, d1]) - ik.p) + sp.Matrix([0, 0, d7]),
        "u": rotation("x", pi / 2) * (rotation("z", theta7) * s + sp.Matrix([a7, 0, 0])),
    },
    solves={"ik": [real("elbow")]},
)
upper = ik.program.let("upper", sqrt(a4**2 + d3**2), nonnegative=True)
fore = ik.program.let("fore", sqrt(a5**2 + d5**2), nonnegative=True)
straight = ik.direction("straight", d3 * d5 - a4 * a5, a4 * d5 + a5 * d3)
elbow_angle = theta4 + sp.atan2(a4 * d5 + a5 * d3, d3 * d5 - a4 * a5)
elbow = ik.angle("elbow", elbow_angle)
d.write("elbow", r"\eta", "angle of the elbow, zero where the straight links are in line")


def shoulder_from_wrist(pair: Pair) -> sp.Matrix:
    """The shoulder in the frame of the forearm, from the cosine and sine of the elbow."""
    bent = turned(-(pair - straight)) * sp.Matrix([-a4, -d3, 0])
    return sp.Matrix([bent[0] + a5, 0, bent[1] - d5])


bent = ik.solve(
    law_of_cosines,
    elbow,
    (upper, fore),
    far,
    {-1: "bent", +1: "over"},
    toward=TwoTurns(shoulder_from_wrist, along=u[2], across=reach),
)
d.step(
    "Inverse: the elbow",
    "Think of two straight links, from the shoulder to the elbow and from the elbow to the "
    "wrist.  The angle between them is theta4 plus a constant, and it is 0 where they are in "
    "line.  The law of cosines gives it from the distance between shoulder and wrist.",
    {
        r"\eta": elbow_angle,
        r"|u|^2": a4**2
        + d3**2
        + a5**2
        + d5**2
        + 2 * sqrt(a4**2 + d3**2) * sqrt(a5**2 + d5**2) * cos(real("elbow")),
    },
    solves={"ik": [real("elbow")]},
)
v = ik.vector("v", shoulder_from_wrist(bent))
tilt = ik.solve(
    turn,
    theta6,
    (u[0], u[1], v[2]),
    {-1: "ahead", +1: "behind"},
    toward=LinkAtHeight(sp.Abs(v[0]), u[2]),
)
w = ik.vector("w", rotation("x", pi / 2) * (turned(tilt) * u))
roll = ik.solve(
    rotate,
    theta5,
    w[:2, 0],
    v[:2, 0],
    because={elbow: -1, theta6: -w[2] - v[2]},
)
d.step(
    "Inverse: the wrist",
    "theta6 turns u until its component along the forearm is that of v, and theta5 then turns it "
    "to v.  If the shoulder is on axis 6 or on axis 5, that joint is free.",
    {
        r"u_x\sin\theta_6 + u_y\cos\theta_6": v[2],
        "w": rotation("x", pi / 2) * (rotation("z", theta6) * u),
        r"R_z(\theta_5)\,w": sp.Matrix([real("v_x"), 0, real("v_z")]),
    },
    solves={"ik": [theta5, theta6]},
)
R = ik.matrix("R1", ik.R * turned(given).T * rotation("x", -pi / 2))
R = ik.matrix("R2", R * turned(tilt).T * rotation("x", -pi / 2))
R = ik.matrix("R3", R * turned(roll).T * rotation("x", pi / 2))
R = ik.matrix("R4", R * turned(bent - straight).T * rotation("x", -pi / 2))
ik.solve(zyz, R, (theta1, theta2, theta3), {+1: "front", -1: "back"})
d.step(
    "Inverse: the first three joints",
    "The other four joints are known, so the rotation of the upper arm is known, and its ZYZ "
    "angles are theta1, theta2 and theta3.",
    {
        "R_{03}": R03,
        "R_{37}": R37,
    },
    proves="The rotation of the pose is R_03 R_37.",
    equal=[(arm.pose[:3, :3], R03 * R37)],
    solves={"ik": [theta1, theta2, theta3]},
)
ik.finish(
    "All eight postures of a pose at a given theta7.",
    notes=(
        "bent: the elbow is bent to the side that the joint limits of a Panda allow; over: it is "
        "bent to the other side.",
        "ahead: the shoulder, seen from the wrist before theta5 turns, has x >= 0; behind: x <= 0.",
        "front: sin(theta2) >= 0; back: sin(theta2) <= 0.",
    ),
)
