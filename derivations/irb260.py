"""The ABB IRB 260 palletiser of Shi, Zhu and Li, by the product of exponentials."""

from itertools import accumulate

import sympy as sp
from closedform.derivations.claims.irb260 import Palletiser, state
from closedform.derivations.irb260_experiment import experiment
from closedform.derivations.irb260_inverse import inverse_kinematics, workspace
from closedform.derivations.irb260_linkage import double_parallelogram
from closedform.derivations.papers.shi_zhu_li import SHI_ZHU_LI
from sympy import atan2, cos, pi, sin

from closedform import (
    Derivation,
    adjoint,
    denavit_hartenberg,
    determinant,
    exponential,
    homogeneous,
    inverse,
    parallelogram_drive,
    real,
    revolute_twist,
    simplest,
    skeleton,
    twist_matrix,
    twist_of,
)

d = Derivation(
    "irb260",
    "ABB IRB 260 palletiser",
    SHI_ZHU_LI,
    "A turret (theta1, about z) carries a lower arm (theta2) and an upper arm (theta3, measured "
    "against the lower arm).  At home both turn about -x.  Two parallelograms along the arms keep "
    "the wrist bracket level; they act as a virtual joint theta4 = -(theta2 + theta3).  The hand "
    "turns by theta5 about z.  At home all angles are 0: the lower arm is upright and the upper "
    "arm points along y.  The default dimensions are those of public models of the IRB 260; the "
    "paper gives none.",
    task=["x", "y", "z", "yaw"],
    singularities=("base axis", "elbow"),
)
SOURCE = "public models, not the paper"


def length(name: str, millimetres: int, meaning: str) -> sp.Symbol:
    value = sp.Rational(millimetres, 1000)
    return d.parameter(name, value=value, unit="m", meaning=meaning, source=SOURCE)


l1 = length("l1", 100, "from the base axis forward to the shoulder")
l2 = length("l2", 615, "from the base up to the shoulder")
l3 = length("l3", 705, "lower arm, from the shoulder to the elbow")
l4 = length("l4", 650, "upper arm, from the elbow to the wrist")
l5 = length("l5", 181, "from the wrist down to the hand")
l6 = length("l6", 120, "from the wrist forward to the axis of the hand")
theta1, theta2, theta3 = d.joint("theta1"), d.joint("theta2"), d.joint("theta3")
theta4 = d.joint("theta4", coupling=-(theta2 + theta3))
theta5 = d.joint("theta5")
q = d.actuated

# Screws

up, across = sp.Matrix([0, 0, 1]), sp.Matrix([-1, 0, 0])
axes = [up, across, across, across, up]
points = [
    sp.Matrix([0, 0, 1]),
    sp.Matrix([0, l1, l2]),
    sp.Matrix([0, l1, l2 + l3]),
    sp.Matrix([0, l1 + l4, l2 + l3]),
    sp.Matrix([0, l1 + l4 + l6, l2 + l3 - l5]),
]
twists = [revolute_twist(w, p) for w, p in zip(axes, points, strict=True)]
d.step(
    "Screws",
    "A direction and a point q define the axis of each joint at home, and its twist (v; omega) "
    "with v = -omega × q.  A point on the axis does not move.",
    {rf"\xi_{i}": twist.T for i, twist in enumerate(twists, 1)},
    published=("(1)", "(2)", "(3)", "(4)", "(5)", "(8)", "(9)"),
    proves="Each twist leaves the points of its axis where they are.",
    equal=[
        (twist_matrix(twist) * sp.Matrix([*p, 1]), sp.zeros(4, 1))
        for twist, p in zip(twists, points, strict=True)
    ],
)

for i, loop in ((1, "lower"), (2, "upper")):
    d.write(f"a{i}", meaning=f"distance of the joints on the coupler of the {loop} loop")
    d.write(f"gamma{i}", meaning=f"direction of the fixed link of the {loop} loop")
    d.write(f"phi{i}", meaning=f"turn of the coupler of the {loop} loop")
    d.write(f"beta{i}", meaning=f"angle of the rod of the {loop} loop")
for i in (1, 2, 3, 5):
    d.write(f"theta{i}_dot", meaning=f"rate of joint {i}")
d.write("lambda", meaning="polar angle of an axis")
d.write("mu", meaning="azimuth of an axis")
d.write("t", meaning="time")
d.explain(
    {
        r"\alpha": "angle at the shoulder, of the triangle of the arms",
        r"\beta_{1,\text{crossed}}": "angle of the rod of the lower loop, crossed",
        r"\phi_{1,\text{crossed}}": "turn of the coupler of the lower loop, crossed",
        r"\omega": "direction of an axis, a unit vector",
        r"\rho": "distance of the hand from the base axis, with a sign",
        r"\rho_0": "centre of the annulus, in the plane of the arm",
        "z_0": "height of the centre of the annulus",
        r"e^{\hat\xi\theta}": "motion by the angle theta about the axis of a twist",
        "g_{st}": "pose of the hand by the product of exponentials",
        "J_b": "twist of the hand in its own frame per joint rate",
        "J^s_{st}": "twist of the hand in the base frame per joint rate",
        "h": "how far the wrist is above the shoulder",
        "u": "how far the wrist is ahead of the shoulder",
        "R": "rotation by the angle theta",
        r"n_\rho": "direction in which the hand cannot move on the base axis",
        r"n_{\theta_3}": "direction in which the hand cannot move with a straight arm",
        "r_{max}": "outer radius of the annulus",
        "r_{min}": "inner radius of the annulus",
        "w": "velocity of the hand if motor 3 were on the turret",
        r"\xi_1": "twist of a joint at home",
        r"\xi_1'": "twist of a joint in the present posture",
        r"\xi_2": "twist of a joint at home",
        r"\xi_2'": "twist of a joint in the present posture",
        r"\xi_3": "twist of a joint at home",
        r"\xi_3'": "twist of a joint in the present posture",
        r"\xi_4": "twist of a joint at home",
        r"\xi_4'": "twist of a joint in the present posture",
        r"\xi_5": "twist of a joint at home",
        r"\xi_5'": "twist of a joint in the present posture",
        **dict.fromkeys("ABCS", "factor of Heron's formula"),
        "L": "distance of the wrist from the shoulder",
        "J_m": "derivative of (x, y, z, yaw) with respect to the motors",
        "v_1": "component of v",
        "w_1": "component of w",
        "v_2": "component of v",
        "w_2": "component of w",
    }
)
d.write("yaw", r"\psi")
d.write("margin", r"\delta", "distance from the border of the workspace")
lam, mu, theta = real("lambda"), real("mu"), real("theta")
v = sp.Matrix([real(f"v{i}") for i in "xyz"])
w = sp.Matrix([sin(lam) * cos(mu), sin(lam) * sin(mu), cos(lam)])  # any unit vector
e = exponential(sp.Matrix([*v, *w]), theta)
d.step(
    "Exponential of a twist",
    "Rodrigues' formula is the exponential of a twist with a unit axis, because it solves the "
    "differential equation of the exponential and starts at the identity.  The axis is an "
    "arbitrary unit vector, given by its polar angles.",
    {
        r"e^{\hat\xi\theta}": r"\begin{bmatrix} R & (I - R)(\omega \times v) + \omega\omega^T v"
        r"\theta \\ 0 & 1 \end{bmatrix}",
        "R": r"I + \hat\omega\sin\theta + \hat\omega^2(1 - \cos\theta)",
        r"\omega": w.T,
    },
    published=("(10)",),
    proves=(
        "The derivative of the formula with respect to the angle is the twist times the formula, "
        "and at zero the formula is the identity."
    ),
    equal=[(e.diff(theta), twist_matrix(sp.Matrix([*v, *w])) * e), (e.subs(theta, 0), sp.eye(4))],
)

# The mechanism behind the virtual joint, and its motors

lower, upper = double_parallelogram(d, l3, l4, theta2, theta3)
d.function(
    "joint4",
    "Angle theta4 of the virtual joint, which keeps the wrist bracket level.",
    {"q": q},
    {"theta4": atan2(-sin(theta2 + theta3), cos(theta2 + theta3))},
    source="the virtual constraint, section III",
)
# Motor 3 drives the upper arm through a third parallelogram, which the paper does not mention.
M = parallelogram_drive(d, {theta3: (theta2, l3)})

# Forward kinematics

thetas = (theta1, theta2, theta3, theta4, theta5)
moves = [exponential(twist, angle) for twist, angle in zip(twists, thetas, strict=True)]
home = homogeneous(sp.eye(3), points[4])
arm = simplest(d.couple(moves[1] * moves[2] * moves[3]))
pose = simplest(moves[0] * arm * moves[4] * home)
free = sp.prod([*moves, home])
by_screws = d.step(
    "Pose by the product of exponentials",
    "The pose is the product of the motions about the axes, from joint 1 to joint 5, and of the "
    "pose at home.  With the virtual constraint, the three parallel axes only translate the "
    "wrist.  The other two axes turn the hand about z.",
    {
        r"g_{st}(0)": home,
        r"e^{\hat\xi_2\theta_2} e^{\hat\xi_3\theta_3} e^{\hat\xi_4\theta_4}": arm,
        r"g_{st}": pose,
    },
    published=("(12)", "(13)"),
    proves="The product of the exponentials, with the virtual constraint, is the stated pose.",
    equal=[(d.couple(free), pose)],
)
rows = [
    (l1, -pi / 2, l2, theta1 + pi / 2),
    (l3, 0, 0, theta2 - pi / 2),
    (l4, 0, 0, theta3 + pi / 2),
    (l6, pi / 2, 0, theta4),
    (0, 0, -l5, theta5 - pi / 2),
]
links = [denavit_hartenberg(a, alpha, offset, turn) for a, alpha, offset, turn in rows]
d.step(
    "Pose by Denavit-Hartenberg",
    "A standard (distal) chain along the links gives the same pose, also for five independent "
    "joints.",
    {r"(a_i, \alpha_i, d_i, \vartheta_i)": sp.Matrix(rows)},
    proves=(
        "The chain along the links is the product of the exponentials, with and without the "
        "constraint."
    ),
    equal=[(sp.prod(links), free), (d.couple(sp.prod(links)), pose)],
    uses=[by_screws],
)
position, turn = pose[:3, 3], theta1 + theta5
rho = simplest(position[1] * cos(theta1) - position[0] * sin(theta1))
yaw = atan2(sin(turn), cos(turn))
d.step(
    "Task coordinates",
    "The hand is level, so its position and its angle about z describe its pose.  rho is the "
    "distance of the hand from the base axis; it is negative if the arm reaches over this axis.",
    {r"\rho": rho, r"\psi": turn},
    proves=(
        "The hand stays level, its x axis has the direction psi, and its origin is at the "
        "distance rho from the base axis in the direction of theta1."
    ),
    equal=[
        (pose[:3, :3] * up, up),
        (pose[:2, 0], sp.Matrix([cos(turn), sin(turn)])),
        (position[:2, 0], sp.Matrix([-rho * sin(theta1), rho * cos(theta1)])),
    ],
    uses=[by_screws],
)
d.function(
    "fk",
    "Position of the hand and its angle about z.",
    {"q": q},
    {"x": [*position, yaw]},
    source="eq. (13)",
    notes=("The yaw theta1 + theta5 is reduced to (-pi, pi].",),
)
d.function(
    "pose",
    "Pose of the hand in the base frame.",
    {"q": q},
    {"T": pose},
    source="eq. (13)",
    equation="g_{st}",
)

# What to draw

rod = l3 / 4  # the paper does not give the distance of the rods; it drops out of all equations
before = [d.couple(T) for T in accumulate([sp.eye(4), *moves[:4]], lambda A, B: A * B)]


def moved_by(joints: int, home: sp.Matrix) -> sp.Matrix:
    """A point moved by the first joints, from its position at home."""
    return simplest((before[joints] * sp.Matrix([*home, 1]))[:3, 0])


shoulder, elbow, wrist = (moved_by(n, points[n]) for n in (1, 2, 3))
behind, above = (simplest(moves[0][:3, :3] * rod * v) for v in (-sp.eye(3)[:, 1], up))
skeleton(
    d,
    {
        "base": (0, 0, 0),
        "column": (0, 0, l2),
        "shoulder": shoulder,
        "elbow": elbow,
        "wrist": wrist,
        "flange": moved_by(4, points[4] + l5 * up),
        "hand": moved_by(4, points[4]),
        "lower_rod_turret": shoulder + behind,
        "lower_rod_plate": elbow + behind,
        "upper_rod_plate": elbow + above,
        "upper_rod_bracket": wrist + above,
    },
    links={
        "turret": ("base", "column", "shoulder", "lower_rod_turret"),
        "lower_arm": ("shoulder", "elbow"),
        "upper_arm": ("elbow", "wrist"),
        "lower_rod": ("lower_rod_turret", "lower_rod_plate"),
        "plate": ("lower_rod_plate", "elbow", "upper_rod_plate", "lower_rod_plate"),
        "upper_rod": ("upper_rod_plate", "upper_rod_bracket"),
        "bracket": ("upper_rod_bracket", "wrist", "flange"),
        "hand": ("flange", "hand"),
    },
    joints={
        theta1: ("base", "column"),
        theta2: ("shoulder",),
        theta3: ("elbow",),
        theta4: ("wrist",),
        theta5: ("flange",),
    },
    hand="hand",
    hand_at=position,
    notes=("The rods are drawn at a quarter of l3; the paper gives no distance.",),
)

# Velocity

moved = [simplest(adjoint(T) * twist) for T, twist in zip(before, twists, strict=True)]
J_space = sp.Matrix.hstack(moved[0], moved[1] - moved[3], moved[2] - moved[3], moved[4])
J_space = simplest(J_space)
J_body = simplest(adjoint(inverse(pose)) * J_space)
J = simplest(sp.Matrix([*position, turn]).jacobian(q))
J_motors = simplest(J * M)
d.step(
    "Spatial Jacobian",
    "The adjoint of the motions before an axis gives its twist in the present posture.  The "
    "virtual joint moves with theta2 and theta3, so its twist is subtracted from theirs.  The "
    "derivative of the pose gives the same.",
    {
        **{rf"\xi_{i}'": xi.T for i, xi in enumerate(moved, 1)},
        r"J^s_{st} = [\xi_1', \xi_2' - \xi_4', \xi_3' - \xi_4', \xi_5']": J_space,
    },
    published=("(16)", "(17)", "(18)", "(20)", "(21)"),
    proves="Each column is the twist that belongs to the derivative of the pose with respect to "
    "its joint.",
    equal=[
        (J_space[:, i], twist_of(pose.diff(angle) * inverse(pose))) for i, angle in enumerate(q)
    ],
)
d.step(
    "Body Jacobian and task Jacobian",
    "The body Jacobian gives the same twist in the frame of the hand.  The task Jacobian is the "
    "derivative of (x, y, z, yaw); its first three rows are the velocity of the origin of the "
    "hand, v + omega × p.  J_m is the derivative with respect to the motors.",
    {"J_b": J_body, "J": J, "J_m = J M": J_motors},
    proves=(
        "Each column of the body Jacobian is the twist that belongs to the derivative of the "
        "pose, in the frame of the hand; the rows of the task Jacobian are v + omega × p and the "
        "rate of the yaw."
    ),
    equal=[(J_body[:, i], twist_of(inverse(pose) * pose.diff(angle))) for i, angle in enumerate(q)]
    + [(J[:3, i], J_space[:3, i] + J_space[3:, i].cross(position)) for i in range(4)]
    + [(J[3, :], J_space[5, :])],
)
rates = sp.Matrix([real(f"theta{i}_dot") for i in (1, 2, 3, 5)])
velocity = J[:3, :] * rates
spatial = twist_matrix(J_space * rates)
time = real("t")
paths = [sp.Function(f"theta{i}", real=True)(time) for i in (1, 2, 3, 5)]
along = dict(zip(q, paths, strict=True))
speeds = dict(zip(rates, (path.diff(time) for path in paths), strict=True))
d.step(
    "Velocity of the hand's origin",
    "This is the spatial velocity applied to the present position of the origin.  It is the time "
    "derivative of the position in eq. (13) along any path.",
    {r"v = \hat V^s_{st} q_5": velocity},
    published=("(23)",),
    proves=(
        "The spatial velocity of the origin is the stated one, and it is the time derivative of "
        "the position along any path."
    ),
    equal=[
        (spatial * sp.Matrix([*position, 1]), sp.Matrix([*velocity, 0])),
        (position.subs(along).diff(time), velocity.subs(along).subs(speeds)),
    ],
    uses=[by_screws],
)
lost = sp.Matrix([cos(theta1), sin(theta1), 0, 0])
stuck = sp.Matrix([-sin(theta1) * sin(theta2), cos(theta1) * sin(theta2), cos(theta2), 0])
det = determinant(J)
d.step(
    "Determinant and singular set",
    "If the links have a length, the determinant of the task Jacobian vanishes exactly if the hand "
    "is on the base axis or the arm is straight or folded.  On the base axis the hand cannot move "
    "across the plane of the arm; with cos(theta3) = 0 it cannot move along the arm.  The products "
    "of these lost directions with the Jacobian contain the factor that vanishes.  The same holds "
    "for the twists, because their rows (v; omega_z) have the same determinant.",
    {
        r"\det J": det,
        r"n_{\rho}": lost.T,
        r"n_{\rho} J": simplest(lost.T * J),
        r"n_{\theta_3}": stuck.T,
        r"n_{\theta_3} J": simplest(stuck.T * J),
    },
    proves=(
        "The determinant is the stated product, also for the twists; the lost directions times "
        "the Jacobian are the stated rows."
    ),
    equal=[
        (J.det(method="berkowitz"), det),
        (det, l3 * l4 * rho * cos(theta3)),
        (J_space.extract([0, 1, 2, 5], range(4)).det(method="berkowitz"), det),
        (lost.T * J, -rho * sp.Matrix([[1, 0, 0, 0]])),
        (stuck.T * J, -l4 * cos(theta3) * sp.Matrix([[0, 1, 1, 0]])),
    ],
)
d.function(
    "jacobian",
    "Derivative of (x, y, z, yaw) with respect to the joint angles.",
    {"q": q},
    {"J": J},
    source="derivative of eq. (13)",
)
d.function(
    "jacobian_space",
    "Twist (v; omega) of the hand in the base frame, per joint rate.",
    {"q": q},
    {"J": J_space},
    source="eq. (18)",
)
d.function(
    "jacobian_body",
    "Twist (v; omega) of the hand in its own frame, per joint rate.",
    {"q": q},
    {"J": J_body},
)
d.function(
    "jacobian_motors",
    "Derivative of (x, y, z, yaw) with respect to the motor angles, at joint angles.",
    {"q": q},
    {"J": J_motors},
    equation="J_m",
)
d.function("determinant", "Determinant of the task Jacobian.", {"q": q}, {"det": det})
d.function(
    "singularities",
    "The factors rho (hand on the base axis) and cos(theta3) (arm straight or folded).",
    {"q": q},
    {"factors": [rho, cos(theta3)]},
)
d.function(
    "point_velocity",
    "Velocity of the origin of the hand, in the base frame.",
    {"q": q, "qdot": rates},
    {"v": velocity},
    source="eq. (23)",
    equation="v",
)

# The inverse, which the paper does not give, and the workspace

lengths = (l1, l2, l3, l4, l5, l6)
inverse_kinematics(d, lengths, position)
workspace(d, lengths, position, rho)

# The experiment of section V, and the claims of the paper

experiment(d, position, velocity, rates, M)
state(
    d,
    Palletiser(
        lengths,
        thetas,
        moves,
        free,
        links,
        simplest(sp.prod(links)),
        pose,
        twists,
        moved,
        J_space,
        rates,
        velocity,
        lower,
        upper,
    ),
)
