"""Arms with a spherical shoulder, an elbow and a spherical wrist, such as the KUKA LBR iiwa."""

import sympy as sp
from closedform.derivations.papers.seven_joints import ARM_ANGLE
from sympy import cos, pi, sin, sqrt

from closedform import (
    Chain,
    Derivation,
    arm_angle,
    arm_plane,
    determinant,
    from_dh,
    law_of_cosines,
    rotation,
    turned,
    zyz,
)

d = Derivation(
    "srs_arm",
    "Seven-joint arm with a spherical shoulder and wrist (SRS)",
    ARM_ANGLE,
    "The axes of theta1, theta2 and theta3 meet in the shoulder, and those of theta5, theta6 and "
    "theta7 in the wrist; neighbouring axes are at right angles.  theta4 is the elbow.  At zero "
    "angles the arm points upwards; theta1, theta3, theta5 and theta7 turn about z, theta2 and "
    "theta6 about y, and theta4 about -y.  A pose leaves one freedom: the elbow turns about the "
    "line from the shoulder to the wrist.  This turn is the arm angle, an input of the inverse.",
    singularities=("shoulder", "elbow", "wrist", "upright"),
)


def length(name: str, millimetres: int, meaning: str, *, nonnegative: bool = True) -> sp.Symbol:
    value, source = sp.Rational(millimetres, 1000), "KUKA LBR iiwa 7 R800, as in iiwa_stack"
    return d.parameter(
        name, value=value, unit="m", meaning=meaning, source=source, nonnegative=nonnegative
    )


d_bs = length("d_bs", 340, "from the base up to the shoulder", nonnegative=False)
d_se = length("d_se", 400, "from the shoulder to the elbow")
d_ew = length("d_ew", 400, "from the elbow to the wrist")
d_wf = length("d_wf", 126, "from the wrist to the flange", nonnegative=False)
q = theta1, theta2, theta3, theta4, theta5, theta6, theta7 = [
    d.joint(f"theta{i}") for i in range(1, 8)
]

# Forward kinematics and velocity

arm = from_dh(
    d,
    [
        (0, -pi / 2, d_bs, theta1),
        (0, pi / 2, 0, theta2),
        (0, pi / 2, d_se, theta3),
        (0, -pi / 2, 0, theta4),
        (0, -pi / 2, d_ew, theta5),
        (0, pi / 2, 0, theta6),
        (0, 0, d_wf, theta7),
    ],
)
forward = arm.export(d)
to_elbow = rotation("z", theta1) * rotation("y", theta2) * rotation("z", theta3)
to_elbow = to_elbow * rotation("x", pi / 2)
line = sp.Matrix([-d_ew * sin(theta4), d_se + d_ew * cos(theta4), 0])
w = to_elbow * line
d.explain(
    {
        "w": "the wrist, seen from the shoulder",
        "L": "distance of the wrist from the shoulder",
        "r": "distance of the wrist from the line through the shoulder along z",
        "e": "vertical component of a unit vector along the axis of the elbow",
        "f": "L times the vertical component of a unit vector in the plane of the arm, across the "
        "line to the wrist",
        "R_{03}": "rotation of the upper arm",
    }
)
w_squared = d_se**2 + d_ew**2 + 2 * d_se * d_ew * cos(theta4)
distance = sqrt(line.dot(line))
aside = sqrt(w[0].subs(theta1, 0) ** 2 + w[1].subs(theta1, 0) ** 2)
d.step(
    "Shoulder, elbow and wrist",
    "Seen from the shoulder, the wrist is at w.  Its distance L depends on the elbow alone; r is "
    "its distance from the line through the shoulder along z.",
    {
        "w": w,
        "L": distance,
        "L^2": w_squared,
        "r": aside,
    },
    proves="The position of the flange is the sum of d_bs upwards, w, and d_wf along the last "
    "axis.",
    equal=[
        (arm.position, sp.Matrix([0, 0, d_bs]) + w + d_wf * arm.pose[:3, 2]),
        (w.dot(w), w_squared),
        (distance**2, w_squared),
        (aside**2, w[0] ** 2 + w[1] ** 2),
    ],
)

# The self-motion and the singular set

s2, c2, s3, c3, s4, c4 = (f(x) for x in (theta2, theta3, theta4) for f in (sin, cos))
s5, c5, s6, c6 = (f(x) for x in (theta5, theta6) for f in (sin, cos))
SELF_MOTION = "Joint rates that leave the hand where it is and turn the elbow."
self_motion = sp.Matrix(
    [
        -d_ew * s4 * c3 * s6,
        d_ew * s4 * s2 * s3 * s6,
        (d_ew * c2 * c3 * s4 - s2 * (d_se + d_ew * c4)) * s6,
        0,
        (s6 * (d_ew + d_se * c4) - d_se * s4 * c5 * c6) * s2,
        -d_se * s4 * s2 * s5 * s6,
        d_se * s4 * s2 * c5,
    ]
)
others = [[k for k in range(7) if k != j] for j in range(7)]
d.explain({r"\dot q": "joint rates that do not move the hand"})
d.step(
    "Self-motion",
    "One motion of the joints leaves the hand where it is.  Leave out one column of J at a time: "
    "the seven determinants, with alternating signs and divided by their common factor, are the "
    "rates of this motion.  The hand loses a direction exactly where all determinants vanish.  If "
    "the links have a length, that is where sin(theta4) = 0, and where sin(theta2) and "
    "sin(theta6), or sin(theta2) and cos(theta3), or sin(theta6) and cos(theta5) vanish together.",
    {r"\dot q": self_motion},
    proves="J times these rates is zero, and these rates times d_se d_ew sin(theta4) are the "
    "minors of J.",
    equal=lambda: [
        (arm.middle * self_motion, sp.zeros(6, 1)),
        *(
            (determinant(arm.middle[:, columns]), (-1) ** k * d_se * d_ew * s4 * self_motion[k])
            for k, columns in enumerate(others)
        ),
    ],
)
up = to_elbow[2, :]
level, across = -up[2], up[1] * line[0] - up[0] * line[1]
numerators = [
    across * (w_squared * level.diff(x) + level * w_squared.diff(x) / 2)
    - w_squared * level * across.diff(x)
    for x in q
]
DETERMINANT = r"\det\begin{pmatrix} J \\ \partial\psi/\partial q \end{pmatrix}"
det = -d_se * d_ew * distance * s2 * s4 * s6
d.step(
    "Determinant and singular set",
    "The arm angle psi is that of the vector (f, L e), where f and e are the coordinates below.  "
    "With its derivative as the last row, J is square.  The determinant vanishes where axes 1 and "
    "3 coincide (shoulder), where the arm is stretched or folded (elbow), and where axes 5 and 7 "
    "coincide (wrist).  If the wrist is above or below the shoulder (upright), r = 0, and psi is "
    "not defined.",
    {
        "e": level,
        "f": across,
        DETERMINANT: det,
    },
    proves="The self-motion turns psi by -L sin(theta2) sin(theta6), and r is the length of that "
    "vector.",
    equal=[
        (sp.Matrix(numerators).dot(self_motion), -w_squared * aside**2 * s2 * s6),
        (aside**2, w_squared * level**2 + across**2),
    ],
)
d.function("self_motion", SELF_MOTION, {"q": q}, {"qdot": self_motion}, equation=r"\dot q")
d.function(
    "determinant",
    "Determinant of the Jacobian with the derivative of the arm angle as its last row.",
    {"q": q},
    {"det": det},
    equation=DETERMINANT,
)
d.function(
    "singularities",
    "The factors of the determinant that depend on a joint, and r.",
    {"q": q},
    {"factors": [s2, s4, s6, aside]},
)

# Inverse kinematics

ik = Chain(d, forward)
psi = arm_angle(ik, to_elbow, line[:2, 0], sense=-1)
wx, wy, wz = p = ik.vector("w", ik.p - d_wf * ik.R[:, 2] - sp.Matrix([0, 0, d_bs]))
far = ik.let("far", sqrt(p.dot(p)))
elbow = ik.solve(law_of_cosines, theta4, (d_se, d_ew), far, {-1: "up", +1: "down"})
d.step(
    "Inverse: the elbow",
    "The upper arm, the forearm and the line from the shoulder to the wrist form a triangle.",
    {
        "w": ik.p - d_wf * ik.R[:, 2] - sp.Matrix([0, 0, d_bs]),
        "L": sqrt(p.dot(p)),
        "r": sqrt(wx**2 + wy**2),
    },
    solves={"ik": [theta4]},
)
bent = ik.vector("v", sp.Matrix([0, d_se, 0]) + turned(elbow) * sp.Matrix([0, d_ew, 0]))
M = ik.solve(arm_plane, psi, to_elbow, bent[:2, 0], p, because={theta4: 1}, sense=-1)
d.step(
    "Inverse: the shoulder",
    "The arm angle and w determine the rotation of the upper arm.  It turns the line to the wrist "
    "to w, and the axis of the elbow to the direction given by the arm angle.  The front branches "
    "have sin(theta2) >= 0.",
    {"R_{03}": rotation("z", theta1) * rotation("y", theta2) * rotation("z", theta3)},
    solves={"ik": [theta1, theta2, theta3]},
)
left = ik.matrix("R1", M * rotation("x", -pi / 2))
ik.solve(zyz, left, (theta1, theta2, theta3), {+1: "front", -1: "back"}, name="shoulder")
right = ik.matrix("R2", rotation("x", pi / 2) * (turned(elbow).T * (M.T * ik.R)))
ik.solve(zyz, right, (theta5, theta6, theta7), {+1: "noflip", -1: "flip"})
R03 = rotation("z", theta1) * rotation("y", theta2) * rotation("z", theta3)
R34 = rotation("z", theta4) * rotation("x", -pi / 2)
R47 = rotation("z", theta5) * rotation("y", theta6) * rotation("z", theta7)
d.step(
    "Inverse: the wrist",
    "M turns the upper arm, with the axis of the elbow along z.  It and theta4 are known, so the "
    "rotation of the wrist is known, and its ZYZ angles are theta5, theta6 and theta7.  In the "
    "noflip branches sin(theta6) >= 0.",
    {"M": R03 * rotation("x", pi / 2), "R_{34}": R34, "R_{47}": R47},
    proves="The rotation of the pose is M R_34 R_47.",
    equal=[(arm.pose[:3, :3], R03 * rotation("x", pi / 2) * R34 * R47)],
    solves={"ik": [theta5, theta6, theta7]},
)
d.explain(
    {
        "M": "rotation of the upper arm, with z along the axis of the elbow",
        "R_{34}": "rotation by the elbow",
        "R_{47}": "rotation by the last three joints",
    }
)
ik.finish(
    "All eight postures of a pose at an arm angle.",
    notes=(
        "up: sin(theta4) <= 0; down: sin(theta4) >= 0.  If the arm angle is between -90 and 90 "
        "degrees, the elbow of the up branches is above the line from the shoulder to the wrist.",
        "front: sin(theta2) >= 0; back: sin(theta2) <= 0.",
        "noflip: sin(theta6) >= 0; flip: sin(theta6) <= 0.",
    ),
)
