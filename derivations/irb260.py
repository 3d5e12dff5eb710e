"""The ABB IRB 260 palletiser of Shi, Zhu and Li, by products of exponentials."""

from itertools import accumulate

import sympy as sp
from sympy import atan2, cos, pi, sin, sqrt

from closedform.derivation import Continuum, Derivation, Inverse, Solved, Table
from closedform.derivations.claims.irb260 import Palletiser, state
from closedform.derivations.papers import SHI_ZHU_LI
from closedform.frames import (
    adjoint,
    denavit_hartenberg,
    determinant,
    exponential,
    homogeneous,
    inverse,
    revolute_twist,
    simplest,
    twist_matrix,
    twist_of,
)
from closedform.functions import Program, branches, choose, real
from closedform.lemmas import linear_pair, parallelogram, two_link_triangle

d = Derivation(
    "irb260",
    "ABB IRB 260 palletiser",
    SHI_ZHU_LI,
    "A turret (theta1, about z) carries a lower arm (theta2) and an upper arm (theta3, against the "
    "lower one), which turn about -x at home.  Two parallelograms along the arms keep the wrist "
    "bracket level; they act as a virtual joint theta4 = -(theta2 + theta3).  The hand turns by "
    "theta5 about z.  At home all angles are 0: the lower arm is upright, the upper arm points "
    "along y.",
    task=["x", "y", "z", "yaw"],
    singularities=("base axis", "elbow"),
)
SOURCE = "public models of the IRB 260; the paper gives no dimensions"


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
    "The axis of each joint at home, by its direction and a point on it, and its twist "
    "(v; omega) with v = -omega x q.  A point of the axis does not move.",
    {rf"\xi_{i}": twist.T for i, twist in enumerate(twists, 1)},
    published=("(1)", "(2)", "(3)", "(4)", "(5)", "(8)", "(9)"),
    equal=[
        (twist_matrix(twist) * sp.Matrix([*p, 1]), sp.zeros(4, 1))
        for twist, p in zip(twists, points, strict=True)
    ],
)

lam, mu, theta = real("lambda"), real("mu"), real("theta")
v = sp.Matrix([real(f"v{i}") for i in "xyz"])
w = sp.Matrix([sin(lam) * cos(mu), sin(lam) * sin(mu), cos(lam)])  # any unit vector
e = exponential(sp.Matrix([*v, *w]), theta)
d.step(
    "Exponential",
    "Rodrigues' formula is the exponential of a twist with a unit axis, because it solves the "
    "differential equation that defines the exponential, and starts at the identity.  The axis "
    "here is any unit vector, given by its polar angles.",
    {
        r"e^{\hat\xi\theta}": r"\begin{bmatrix} R & (I - R)(\omega \times v) + \omega\omega^T v"
        r"\theta \\ 0 & 1 \end{bmatrix}",
        "R": r"I + \hat\omega\sin\theta + \hat\omega^2(1 - \cos\theta)",
        r"\omega": w.T,
    },
    published=("(10)",),
    equal=[
        (e.diff(theta), twist_matrix(sp.Matrix([*v, *w])) * e),
        (e.subs(theta, 0), sp.eye(4)),
    ],
)

# The mechanism behind the virtual joint

sigma = real("sigma")
a1, a2, a3 = (real(f"a{i}", positive=True) for i in (1, 2, 3))
gamma1, gamma2, gamma3 = (real(f"gamma{i}") for i in (1, 2, 3))
phi1, phi2, phi3 = (real(f"phi{i}") for i in (1, 2, 3))
beta1, beta2, beta3 = (real(f"beta{i}") for i in (1, 2, 3))
motor3 = real("m3")
forearm = theta2 + theta3 + pi / 2
lower = parallelogram(l3, a1, theta2, gamma1, phi1, beta1, sigma)
upper = parallelogram(l4, a2, forearm - phi1, gamma2, phi2, beta2, sigma)
drive = parallelogram(l3, a3, theta2, gamma3 + motor3, phi3, beta3, sigma)
loops = (lower, upper, drive)


def closed(loop, sign):
    """What the equations of a loop leave in one of its assemblies."""
    return sp.Matrix(loop.equations).subs(loop.solution).subs(sigma, sign)


flat = 2 * l3**2 * sin(theta2 - gamma1) ** 2
stretch = l3**2 + a1**2 - 2 * l3 * a1 * cos(theta2 - gamma1)
d.step(
    "The lower loop and its assemblies",
    "In the plane of the arm, with angles from the vertical: the lower arm and a rod of the same "
    "length join the turret to a plate at the elbow, over a distance a1 in the direction gamma1 on "
    "both.  The loop equations have two solutions for the turn phi1 of the plate and the angle "
    "beta1 of the rod.  In the parallelogram the plate does not turn, whatever a1 and gamma1; in "
    "the antiparallelogram it does.  The assemblies meet where phi1 = 0 in both, and so exactly "
    "where the loop is flat, sin(theta2 - gamma1) = 0.",
    {
        "0": sp.Matrix(lower.equations),
        r"(\varphi_1, \beta_1)_{\text{parallelogram}}": (sp.Integer(0), theta2),
        r"\varphi_{1,\text{antiparallelogram}}": lower[phi1].subs(sigma, -1),
        r"\beta_{1,\text{antiparallelogram}}": 2 * gamma1 + phi1 - theta2,
        r"1 - \cos\varphi_{1,\text{antiparallelogram}}": flat / stretch,
    },
    equal=[
        *((closed(loop, sign), sp.zeros(2, 1)) for loop in loops for sign in (1, -1)),
        (1 - cos(lower[phi1].subs(sigma, -1)), flat / stretch),
    ],
)
bracket = (lower[phi1] + upper[phi2]).subs(sigma, 1)
d.step(
    "The upper loop and the virtual joint",
    "The upper arm and a second rod join the plate to the wrist bracket, over a distance a2.  The "
    "bracket turns by phi1 + phi2 against the turret; joint 4 is what it turns against the upper "
    "arm.  In two parallelograms phi1 = phi2 = 0: the distances a1, a2 drop out, and the bracket "
    "stays level.  This is the virtual joint.  Each of the other three assemblies gives another "
    "theta4, but where a loop is flat.",
    {r"\theta_4 = \varphi_1 + \varphi_2 - \theta_2 - \theta_3": bracket - theta2 - theta3},
    equal=[(bracket - theta2 - theta3, d.couple(theta4))],
)
M = sp.Matrix([[1, 0, 0, 0], [0, 1, 0, 0], [0, -1, 1, 0], [0, 0, 0, 1]])
motors = sp.Matrix([real(f"m{i}") for i in (1, 2, 3, 5)])
d.step(
    "Motors",
    "Motor 3 sits on the turret as motor 2 does.  Its crank of length a3 drives the upper arm "
    "through a rod as long as the lower arm: a third parallelogram, whose fixed link is the crank. "
    "The upper arm does not turn against the crank, so theta2 + theta3 is the motor's angle.  The "
    "paper is silent about this, and its theta3 is the angle against the lower arm.",
    {
        r"\theta_2 + \theta_3 - m_3 = \varphi_3": drive[phi3].subs(sigma, 1),
        r"M = \partial\theta / \partial m": M,
        r"M^{-1}": M.inv(),
    },
    equal=[((M * motors)[2], drive[phi3].subs(sigma, 1) + motor3 - motors[1])],
)
d.function(
    "joint4",
    "Angle theta4 of the virtual joint, which keeps the wrist bracket level.",
    {"q": q},
    {"theta4": atan2(-sin(theta2 + theta3), cos(theta2 + theta3))},
    source="the virtual constraint, section III",
)
d.function(
    "joints_from_motors",
    "Joint angles of motor angles: theta3 = m3 - m2.",
    {"motors": motors},
    {"q": M * motors},
    notes=("The map is linear and counts turns: its angles are not reduced to (-pi, pi].",),
)
d.function(
    "motors_from_joints",
    "Motor angles of joint angles: m3 = theta2 + theta3.",
    {"q": q},
    {"motors": M.inv() * sp.Matrix(q)},
    notes=("The map is linear and counts turns: its angles are not reduced to (-pi, pi].",),
)

# Forward kinematics

thetas = (theta1, theta2, theta3, theta4, theta5)
moves = [exponential(twist, angle) for twist, angle in zip(twists, thetas, strict=True)]
home = homogeneous(sp.eye(3), points[4])
arm = simplest(d.couple(moves[1] * moves[2] * moves[3]))
pose = simplest(moves[0] * arm * moves[4] * home)
free = sp.prod([*moves, home])
d.step(
    "Pose by the product of exponentials",
    "The three parallel axes with the virtual constraint only translate the wrist; the other two "
    "axes turn the hand about z.",
    {
        r"g_{st}(0)": home,
        r"e^{\hat\xi_2\theta_2} e^{\hat\xi_3\theta_3} e^{\hat\xi_4\theta_4}": arm,
        r"g_{st}": pose,
    },
    published=("(12)", "(13)"),
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
    "A standard (distal) chain along the links: the same pose, also for five independent joints.",
    {r"(a, \alpha, d, \vartheta)": sp.Matrix(rows)},
    equal=[(sp.prod(links), free), (d.couple(sp.prod(links)), pose)],
)
position, turn = pose[:3, 3], theta1 + theta5
rho = simplest(position[1] * cos(theta1) - position[0] * sin(theta1))
yaw = atan2(sin(turn), cos(turn))
d.step(
    "Task coordinates",
    "The hand is level, so its pose is its position and its angle about z.  rho is the distance "
    "of the hand from the base axis, negative where the arm reaches over this axis.",
    {r"\rho": rho, r"\psi": turn},
    equal=[
        (pose[:3, :3] * up, up),
        (pose[:2, 0], sp.Matrix([cos(turn), sin(turn)])),
        (position[:2, 0], sp.Matrix([-rho * sin(theta1), rho * cos(theta1)])),
    ],
)
d.function(
    "fk",
    "Position of the hand and its angle about z.",
    {"q": q},
    {"x": [*position, yaw]},
    source="eq. (13)",
    notes=("The yaw theta1 + theta5 is reduced to (-pi, pi].",),
)
d.function("pose", "Pose of the hand in the base frame.", {"q": q}, {"T": pose}, source="eq. (13)")

# Velocity

before = [d.couple(T) for T in accumulate([sp.eye(4), *moves[:4]], lambda A, B: A * B)]
moved = [simplest(adjoint(T) * twist) for T, twist in zip(before, twists, strict=True)]
J_space = sp.Matrix.hstack(moved[0], moved[1] - moved[3], moved[2] - moved[3], moved[4])
J_space = simplest(J_space)
J_body = simplest(adjoint(inverse(pose)) * J_space)
J = simplest(sp.Matrix([*position, turn]).jacobian(q))
J_motors = simplest(J * M)
d.step(
    "Spatial Jacobian",
    "The twist of each axis as it stands, by the adjoint of the motions before it.  The virtual "
    "joint moves with theta2 and theta3, so its twist is subtracted from theirs.  Differentiating "
    "the pose gives the same.",
    {
        **{rf"\xi_{i}'": xi.T for i, xi in enumerate(moved, 1)},
        r"J^s_{st} = [\xi_1', \xi_2' - \xi_4', \xi_3' - \xi_4', \xi_5']": J_space,
    },
    published=("(16)", "(17)", "(18)", "(20)", "(21)"),
    equal=[
        (J_space[:, i], twist_of(pose.diff(angle) * inverse(pose))) for i, angle in enumerate(q)
    ],
)
d.step(
    "Body Jacobian and task Jacobian",
    "The body Jacobian is the same twist seen from the hand.  The task Jacobian is the derivative "
    "of (x, y, z, yaw); its first rows are the velocity of the hand's origin, v + omega x p.",
    {"J_b": J_body, "J": J},
    equal=[
        (J_body[:, i], twist_of(inverse(pose) * pose.diff(angle))) for i, angle in enumerate(q)
    ]
    + [
        (J[:3, i], J_space[:3, i] + J_space[3:, i].cross(position)) for i in range(4)
    ]
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
    "The spatial velocity, applied to the point where the origin is now.  It is the derivative in "
    "time of the position in eq. (13), along any path.",
    {r"v = \hat V^s_{st} q_5": velocity},
    published=("(23)",),
    equal=[
        (spatial * sp.Matrix([*position, 1]), sp.Matrix([*velocity, 0])),
        (position.subs(along).diff(time), velocity.subs(along).subs(speeds)),
    ],
)
lost = sp.Matrix([cos(theta1), sin(theta1), 0, 0])
stuck = sp.Matrix([-sin(theta1) * sin(theta2), cos(theta1) * sin(theta2), cos(theta2), 0])
det = determinant(J)
d.step(
    "Determinant and singular set",
    "The determinant of the task Jacobian vanishes, for links that have a length, where the hand "
    "is on the base axis or the arm is straight or folded.  On the base axis the hand cannot move "
    "across the plane of the arm; with cos(theta3) = 0 it cannot move along the arm.  The products "
    "of the lost directions with the Jacobian have the factor that vanishes.  The same holds of "
    "the twists, whose rows (v; omega_z) have the same determinant.",
    {
        r"\det J": det,
        r"n_{\rho}": lost.T,
        r"n_{\rho} J": simplest(lost.T * J),
        r"n_{\theta_3}": stuck.T,
        r"n_{\theta_3} J": simplest(stuck.T * J),
    },
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
    "Twist (v; omega) of the hand in the base frame per joint rate.",
    {"q": q},
    {"J": J_space},
    source="eq. (18)",
)
d.function(
    "jacobian_body",
    "Twist (v; omega) of the hand in its own frame per joint rate.",
    {"q": q},
    {"J": J_body},
)
d.function(
    "jacobian_motors",
    "Derivative of (x, y, z, yaw) with respect to the motor angles, at joint angles.",
    {"q": q},
    {"J": J_motors},
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
)

# Inverse kinematics

px, py, pz, psi = target = (real("px"), real("py"), real("pz"), real("psi"))
side, bend = real("sigma_side"), real("sigma_elbow")
alpha, elbow = real("alpha"), real("elbow")
choices = branches(
    (side, {+1: "front", -1: "back"}), (bend, {+1: "elbow_up", -1: "elbow_down"})
)
d.branches = choices.labels

p = Program()
size = l1 + l2 + l3 + l4 + l5 + l6
r = p.let("r", sqrt(px**2 + py**2), nonnegative=True)
on_axis = p.vanishes("on_axis", r, size, "the hand is on the base axis", free=(theta1,))
c1 = p.let("c_turret", choose(on_axis, 1, side * py))
s1 = p.let("s_turret", choose(on_axis, 0, -side * px))
u = p.let("u", side * r - l1 - l6)
h = p.let("h", pz - l2 + l5)
reach = p.let("reach", sqrt(u**2 + h**2), nonnegative=True)
triangle = two_link_triangle(p, l3, l4, reach, elbow, alpha, bend, scale=size)
folded = p.vanishes("folded", reach, size, "the wrist is on the shoulder", free=(theta2,))
p.vanishes("no_link", l3 * l4, (l3 + l4) ** 2, "an arm has no length", free=(theta3,))
turret = linear_pair(theta1, s1, c1)
shoulder = linear_pair(theta2, u, h)
hand = linear_pair(theta5, sin(psi) * c1 - cos(psi) * s1, cos(psi) * c1 + sin(psi) * s1)
solution = {
    theta1: turret[theta1],
    theta2: choose(folded, 0, shoulder[theta2] - triangle[alpha]),
    theta3: triangle[elbow] - pi / 2,
    theta5: hand[theta5],
}
wrist = py * cos(theta1) - px * sin(theta1) - l1 - l6
height = pz - l2 + l5
along3, across3 = l3 - l4 * sin(theta3), l4 * cos(theta3)
d.solved += [
    Solved("ik", theta1, turret, px * cos(theta1) + py * sin(theta1)),
    Solved(
        "ik", theta3, triangle, wrist**2 + height**2 - l3**2 - l4**2 + 2 * l3 * l4 * sin(theta3)
    ),
    Solved(
        "ik",
        theta2,
        shoulder,
        sin(theta2) * (height * along3 + wrist * across3)
        - cos(theta2) * (wrist * along3 - height * across3),
    ),
    Solved("ik", theta5, hand, sin(theta1 + theta5 - psi)),
]
d.step(
    "Inverse: the turret",
    "The hand is in the plane of the arm, at the distance rho = +-r from the base axis: the arm "
    "faces it (front, sigma_side = +1) or reaches over the axis (back, sigma_side = -1).  On the "
    "axis itself theta1 is free; we return 0.",
    {
        r"\rho": side * sqrt(px**2 + py**2),
        r"\theta_1": atan2(-side * px, side * py),
        r"u": r"\rho - l_1 - l_6",
        r"h": pz - l2 + l5,
    },
)
d.step(
    "Inverse: the elbow and the shoulder",
    "Seen from the shoulder the wrist is at u forward and h up.  The two arms and the line between "
    "these joints form a triangle, in which the angle of the elbow is theta3 + 90 degrees: "
    "elbow_up (sigma_elbow = +1) is cos(theta3) >= 0, as at home, and elbow_down is "
    "cos(theta3) <= 0.  If the arms are equal and the wrist is on the shoulder, theta2 is free; we "
    "return 0.",
    {
        r"\theta_3": solution[theta3],
        r"\alpha": triangle[alpha],
        r"\theta_2": shoulder[theta2] - alpha,
    },
)
d.step(
    "Inverse: the hand",
    "What the turret leaves of the yaw, by sine and cosine.",
    {r"\theta_5": r"\psi - \theta_1"},
)
d.function(
    "ik",
    "All four configurations of a position and a yaw.",
    {"x": target},
    {"q": [solution[angle] for angle in q]},
    program=p,
    branches=choices,
    result="Solutions",
    source="solved from eq. (13); the paper leaves the inverse out",
    notes=(
        "front: the arm faces the hand, rho >= 0; back: it reaches over the base axis, rho <= 0, "
        "where rho = y cos(theta1) - x sin(theta1).  elbow_up: cos(theta3) >= 0, as at home; "
        "elbow_down: cos(theta3) <= 0.",
        "SINGULAR: the hand on the base axis, theta1 is free (theta1 + theta5 is determined) and 0 "
        "is returned; equal arms folded with the wrist on the shoulder, theta2 is free and 0 is "
        "returned; or an arm without length, whose angle is free.",
        "Ill-conditioned where the arm is straight or folded: the angles lose half the digits "
        "there, the position does not.",
    ),
)
bearing = real("bearing")
d.inverses.append(
    Inverse(
        "ik",
        q,
        target,
        (*position, turn),
        (
            Continuum(
                on_axis, {px: sp.S.Zero, py: sp.S.Zero}, theta1, r"\theta_1 + \theta_5 = \psi"
            ),
            Continuum(
                folded,
                {
                    px: -(l1 + l6) * sin(bearing),
                    py: (l1 + l6) * cos(bearing),
                    pz: l2 - l5,
                    l4: l3,
                },
                theta2,
                r"\theta_3 = \pm\pi/2",
                ("front_elbow_up", "front_elbow_down"),
            ),
        ),
        angles=(psi,),
    )
)

# Workspace

inner, outer = sp.Abs(l3 - l4), l3 + l4
d.step(
    "Workspace",
    "In the plane of the arm the hand reaches an annulus about the point at rho = l1 + l6 and "
    "z = l2 - l5, with the arms' difference and sum as radii; all around the base axis, this "
    "annulus and its mirror image.  At the radii the arm is folded and straight.",
    {r"\rho_0": l1 + l6, "z_0": l2 - l5, "r_{min}": inner, "r_{max}": outer},
    equal=[
        (
            ((rho - l1 - l6) ** 2 + (position[2] - l2 + l5) ** 2).subs(theta3, turned),
            (l3 - sin(turned) * l4) ** 2,
        )
        for turned in (pi / 2, -pi / 2)
    ],
)
d.function(
    "workspace_section",
    "The annulus that the hand can reach in the plane of the arm.",
    {},
    {"section": [l1 + l6, l2 - l5, inner, outer]},
    notes=("Radius and height of the centre, inner and outer radius.",),
)
m = Program()
r = m.let("r", sqrt(px**2 + py**2), nonnegative=True)
h = m.let("h", pz - l2 + l5)
gaps = []
for name, sign in (("front", 1), ("back", -1)):
    there = m.let(f"reach_{name}", sqrt((sign * r - l1 - l6) ** 2 + h**2), nonnegative=True)
    gaps.append(sp.Min(l3 + l4 - there, there - inner))
d.function(
    "workspace_margin",
    "How far a position is inside the workspace, in the plane of the arm; negative outside.",
    {"p": (px, py, pz)},
    {"margin": sp.Max(*gaps)},
    program=m,
    notes=("Some configuration reaches the position exactly where the margin is not negative.",),
)

# The experiment of section V

degree = pi / 180
omega = sp.Matrix([-30, 10, 5, 0]) * degree
motion = dict(zip(q, omega * time, strict=True))
grounded = dict(zip(q, M * omega * time, strict=True))
v_relative = velocity.subs(dict(zip(rates, omega, strict=True))).subs(motion)
v_grounded = velocity.subs(dict(zip(rates, M * omega, strict=True))).subs(grounded)
difference = v_relative - v_grounded
d.step(
    "The experiment of section V",
    "From theta = 0 with the rates -30, 10, 5 and 0 degrees per second (t in seconds).  These are "
    "the derivatives in time of the position along the path.",
    {"v": v_relative},
    equal=[(v_relative, position.subs(motion).diff(time))],
)
first, second = (difference.diff(time, k).subs(time, 0) for k in (1, 2))
d.step(
    "Relative or grounded",
    "If 5 degrees per second were the rate of the motor 3 on the turret, the joint would turn by "
    "theta3 = (5 - 10) t.  All three components tell the readings apart, but not equally soon: at "
    "t = 0 only the vertical one differs, threefold; the difference of the others grows from 0, "
    "that of y with t and that of x with t^2.",
    {
        r"v_{\text{grounded}}": v_grounded,
        r"(v - v_{\text{grounded}})_{t = 0}": difference.subs(time, 0).T,
        r"\frac{d}{dt}(v - v_{\text{grounded}})_{t = 0}": first.T,
        r"\frac{d^2}{dt^2}(v - v_{\text{grounded}})_{t = 0}": second.T,
    },
    equal=[
        (v_grounded, position.subs(grounded).diff(time)),
        (v_relative[2].subs(time, 0), 3 * v_grounded[2].subs(time, 0)),
        (difference[:2, 0].subs(time, 0), sp.zeros(2, 1)),
        (first[0], sp.S.Zero),
    ],
)
d.tables.append(
    Table(
        "irb260_section_v",
        "t [s]",
        time,
        tuple(sp.Rational(k, 10) for k in range(101)),
        {
            f"v{axis}{suffix} [m/s]": value
            for suffix, values in (("", v_relative), (" if motor 3 is grounded", v_grounded))
            for axis, value in zip("xyz", values, strict=True)
        },
    )
)

# Claims of the paper

arms = Palletiser(
    (l1, l2, l3, l4, l5, l6),
    thetas,
    moves,
    free,
    links,
    pose,
    twists,
    moved,
    J_space,
    rates,
    velocity,
    lower,
    upper,
)
state(d, arms)
