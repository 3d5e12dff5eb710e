"""The planar 2R arm of Reddy and Babu, by geometry and by Denavit-Hartenberg."""

import sympy as sp
from closedform.derivations.claims.planar_2r import state
from closedform.derivations.claims.planar_2r_notation import Arm
from closedform.derivations.papers.reddy_babu import REDDY_BABU
from sympy import atan2, cos, sin, sqrt

from closedform import (
    SINGLE,
    Degenerate,
    Derivation,
    Inverse,
    Program,
    Solved,
    Triangle,
    branches,
    chain,
    choose,
    denavit_hartenberg,
    determinant,
    jacobian,
    linear_pair,
    real,
    require_pose,
    rotation,
    skeleton,
    turned_back,
)

d = Derivation(
    "planar_2r",
    "Planar 2R arm",
    REDDY_BABU,
    "Two links of lengths l1 and l2 move in the plane of x and y.  theta1 is the angle of the "
    "first link against the x axis, theta2 that of the second link against the first; both are "
    "counter-clockwise.",
    task=["x", "y"],
    singularities=("elbow",),
)
l1 = d.parameter("l1", value=10, unit="cm", meaning="length of the first link")
l2 = d.parameter("l2", value=8, unit="cm", meaning="length of the second link")
theta1 = d.joint("theta1")
theta2 = d.joint("theta2")
q = (theta1, theta2)

# Forward kinematics by geometry

link1 = rotation("z", theta1) * sp.Matrix([l1, 0, 0])
link2 = rotation("z", theta1 + theta2) * sp.Matrix([l2, 0, 0])
position = (link1 + link2)[:2, 0]
by_geometry = d.step(
    "Position by geometry",
    "Each link is a vector along the x axis, turned by its absolute angle.  The position is the "
    "sum of both.",
    {"x": position[0], "y": position[1]},
    published=("(1)", "(2)"),
)

# Forward kinematics by Denavit-Hartenberg

A1 = denavit_hartenberg(l1, 0, 0, theta1)
A2 = denavit_hartenberg(l2, 0, 0, theta2)
pose = chain([A1, A2])
by_frames = d.step(
    "Pose by Denavit-Hartenberg",
    "Table I of the paper has the lengths l1 and l2, and no twist or offset.  The last column of "
    "the product of the two matrices is the position found by geometry.",
    {"A_1": A1, "A_2": A2, "T = A_1 A_2": pose},
    published=("(6)", "(7)", "(8)", "Table I"),
    proves=(
        "The last column of T is the position (x, y) found by geometry, and T is the product of "
        "both matrices."
    ),
    equal=[(pose[:2, 3], position), (A1 * A2, pose)],
    uses=[by_geometry],
)

d.write("r2", "r^2")
d.explain(
    {
        "A_1": "motion along a link",
        "A_2": "motion along a link",
        "D": "cosine of theta2",
        "N": "measure of the distance from the outer boundary of the workspace",
        "M": "measure of the distance from the inner boundary of the workspace",
        "r": "distance of the hand from the base",
        r"\alpha": "angle at the base, of the triangle of the links",
        "r_{max}": "outer radius of the workspace",
        "r_{min}": "inner radius of the workspace",
        "S": "area of the workspace",
        "J_{xy}": "the rows of x and y of J",
    }
)
phi = theta1 + theta2
d.step(
    "Orientation",
    "The first column of the pose is the direction of the last link, which is at the angle phi.",
    {r"\phi": phi},
    published=("(5)",),
    proves="The first column of T is (cos(phi), sin(phi)).",
    equal=[(pose[:2, 0], sp.Matrix([cos(phi), sin(phi)]))],
    uses=[by_frames],
)

d.function(
    "fk",
    "Position of the hand.",
    {"q": q},
    {"x": position},
    source="eqs. (1) and (2)",
)
d.function(
    "pose", "Pose of the hand frame in the base frame.", {"q": q}, {"T": pose}, source="eq. (8)"
)
d.function(
    "orientation",
    "Angle phi of the last link against the x axis: the sum of the joint angles, in (-pi, pi].",
    {"q": q},
    {"phi": atan2(sin(phi), cos(phi))},
    source="eq. (5)",
)

skeleton(
    d,
    {"base": (0, 0, 0), "elbow": link1, "hand": (*position, 0)},
    links={"first": ("base", "elbow"), "second": ("elbow", "hand")},
    joints={theta1: ("base",), theta2: ("elbow",)},
    hand="hand",
    hand_at=pose[:3, 3],
)

# Velocity

J = jacobian(sp.Matrix([*position, phi]), q)
det = determinant(J[:2, :])
manipulability = l1 * l2 * sp.Abs(sin(theta2))
d.step(
    "Jacobian and its determinant",
    "The rows are the rates of x, y and phi.  The determinant of the rows of x and y does not "
    "depend on theta1, because it does not change if the whole arm turns about its base.",
    {"J": J, r"\det J_{xy}": det},
    proves="The determinant of the first two rows of J is the stated product.",
    equal=[(J[:2, :].det(), det)],
    uses=[by_geometry],
)
d.step(
    "Manipulability and singular set",
    "For a square Jacobian, Yoshikawa's measure sqrt(det(J J^T)) is the absolute value of the "
    "determinant.  If the links have a length, it vanishes exactly if sin(theta2) does: the arm is "
    "stretched or folded, and the hand cannot move along it.",
    {"w": manipulability, r"w^2": sp.factor(det**2)},
    proves="The determinant of J J^T, for the rows of x and y, is the square of that of J.",
    equal=[((J[:2, :] * J[:2, :].T).det(), det**2)],
)
d.function(
    "jacobian",
    "Derivative of (x, y, phi) with respect to (theta1, theta2).",
    {"q": q},
    {"J": J},
    source="derivative of eqs. (1), (2) and (5)",
)
d.function(
    "determinant",
    "Determinant of the rows of x and y of the Jacobian.",
    {"q": q},
    {"det": det},
)
d.function(
    "manipulability",
    "Yoshikawa's manipulability of the position: the absolute value of the determinant.",
    {"q": q},
    {"w": manipulability},
)
d.function(
    "singularities",
    "The factor that vanishes exactly if the arm is stretched or folded.",
    {"q": q},
    {"factors": [sin(theta2)]},
)

# Inverse kinematics

px, py = real("px"), real("py")
sigma = real("sigma_elbow")
alpha = real("alpha")
elbow = branches((sigma, {+1: "elbow_down", -1: "elbow_up"}))
d.branches = elbow.labels

p = Program()
r2 = p.let("r2", px**2 + py**2, nonnegative=True)
sides = Triangle.from_square(p, (l1, l2), r2, sigma)
triangle, (ahead, beyond) = sides.stretched_without_link(
    p, (theta2, alpha), sqrt(r2), free=(theta2,)
)
at_base = p.vanishes(
    "at_base", sp.Abs(px) + sp.Abs(py), l1 + l2, "the hand is on the base axis", free=(theta1,)
)
bearing = turned_back(theta1, (py, px), alpha, (beyond, ahead))
solution = {
    theta1: choose(at_base, 0, bearing[theta1]),
    theta2: triangle[theta2],
}
d.solved += [
    Solved("ik", theta2, triangle, px**2 + py**2 - l1**2 - l2**2 - 2 * l1 * l2 * cos(theta2)),
    Solved(
        "ik",
        theta1,
        bearing,
        sin(theta1) * (px * (l1 + l2 * cos(theta2)) + py * l2 * sin(theta2))
        - cos(theta1) * (py * (l1 + l2 * cos(theta2)) - px * l2 * sin(theta2)),
    ),
]
r, D = real("r"), real("D")
cosine = (r**2 - l1**2 - l2**2) / (2 * l1 * l2)
by_the_law_of_cosines = d.step(
    "Inverse: the law of cosines",
    "The links and the line from the base to the hand form a triangle with the sides l1, l2 and "
    "r.  The sum of the squares of x and y is l1^2 + l2^2 + 2 l1 l2 cos(theta2), which gives the "
    "cosine of theta2.  The sine follows up to its sign, one for each elbow, and the angle from "
    "both.  The paper stops here.",
    {"r^2": px**2 + py**2, "D": cosine, r"\theta_2": atan2(sigma * sqrt(1 - D**2), D)},
    published=("(3)",),
    proves=(
        "The square of the position is that of the law of cosines, and D is the cosine of theta2."
    ),
    equal=[
        (position.dot(position), l1**2 + l2**2 + 2 * l1 * l2 * cos(theta2)),
        (cosine.xreplace({r: sqrt(position.dot(position))}), cos(theta2)),
    ],
    uses=[by_geometry],
    solves={"ik": [theta2]},
)
N, M = real("N", nonnegative=True), real("M", nonnegative=True)
outer, inner = (l1 + l2) ** 2 - r**2, r**2 - (l1 - l2) ** 2
with_names = Triangle(l1, l2, sigma, N, M)
d.step(
    "Inverse: the elbow",
    "The code computes the angle differently.  Near a boundary of the workspace D is nearly 1 or "
    "-1.  Then 1 - D^2 has lost half the digits of the sine, or is negative by a rounding error.  "
    "N and M measure how far the hand is from both boundaries.  They are 1 - D and 1 + D up to a "
    "common factor, so the ratio of their roots is the tangent of half the angle.  With this "
    "angle the hand reaches its position up to rounding.",
    {"N": outer, "M": inner, r"\theta_2": with_names.elbow},
    proves="N and M are 1 - D and 1 + D, each times twice the product of the lengths.",
    equal=[(outer, 2 * l1 * l2 * (1 - cosine)), (inner, 2 * l1 * l2 * (1 + cosine))],
    uses=[by_the_law_of_cosines],
    solves={"ik": [theta2]},
)
d.step(
    "Inverse: the shoulder",
    "The direction of the first link is beta - alpha, where beta = atan2(p_y, p_x) is that of the "
    "hand and alpha the angle of the triangle at the base.  Along the first link and across it, "
    "the hand is r cos(alpha) and r sin(alpha) from the base.  With N and M, the sine and the "
    "cosine of theta2 are 2 sigma_elbow sqrt(M N) and M - N, each divided by M + N.  The hand can "
    "be on the base axis only if l1 = l2.  Then every theta1 is a solution; we return 0.",
    {
        r"r\cos\alpha": l1 + l2 * cos(theta2),
        r"r\sin\alpha": l2 * sin(theta2),
        r"\alpha": with_names.base,
        r"\theta_1": atan2(py, px) - alpha,
    },
    published=("(4)",),
    proves="In N and M, the position of the hand along the first link is the stated one, up to "
    "the factor M + N.",
    equal=[
        (
            (outer + inner) * (l1 + l2 * cosine),
            inner * (l1 + l2) + outer * (l1 - l2),
        )
    ],
    solves={"ik": [theta1]},
)
d.function(
    "ik",
    "Both elbow configurations for a position.",
    {"x": (px, py)},
    {"q": [solution[theta1], solution[theta2]]},
    program=p,
    branches=elbow,
    result="Solutions",
    source="eqs. (3) and (4), by arctangents",
    notes=(
        "SINGULAR: if l1 = l2 and the hand is on the base axis, theta1 is free and 0 is returned; "
        "if a link has no length, its angle is free.",
        "Ill-conditioned near the stretched and the folded arm: the angles lose half their digits, "
        "the position does not.",
    ),
)
d.inverses.append(
    Inverse(
        "ik",
        q,
        (px, py),
        tuple(position),
        (
            Degenerate(
                (at_base,),
                {px: sp.Integer(0), py: sp.Integer(0), l2: l1},
                theta1,
                relation=r"\theta_2 = \pi",
            ),
        ),
    )
)

# Inverse kinematics from the full pose

T = sp.Matrix(4, 4, lambda i, j: real(f"T{i + 1}{j + 1}"))
n, origin = T[:3, 0], T[:3, 3]
f = Program()
require_pose(f, T)
elbow_x = f.let("elbow_x", origin[0] - l2 * n[0])
elbow_y = f.let("elbow_y", origin[1] - l2 * n[1])
f.match(sqrt(elbow_x**2 + elbow_y**2) - l1, l1 + l2, "the elbow is one link away from the base")
f.match(origin[2], l1 + l2, "the hand is in the plane")
for entry in (T[0, 2], T[1, 2], T[2, 2] - 1):
    f.match(entry, sp.Integer(1), "the hand turns about z alone")
no_first = f.vanishes("no_first_link", l1, l1 + l2, "the first link has no length", free=(theta1,))
c1 = f.let("c1", choose(no_first, 1, elbow_x / l1))
s1 = f.let("s1", choose(no_first, 0, elbow_y / l1))
full = linear_pair(theta2, n[1] * c1 - n[0] * s1, n[0] * c1 + n[1] * s1)
d.step(
    "Inverse from the full pose",
    "The target T has the rotation R and the position p.  The first column of R is the direction "
    "of the last link, so the elbow is at p minus l2 times this column, which gives theta1.  Then "
    "the first column of A_1^{-1} T = A_2 gives theta2.  The other entries of this equation, (9) "
    "of the paper, are conditions on the pose.",
    {
        r"\theta_1": atan2(origin[1] - l2 * n[1], origin[0] - l2 * n[0]),
        r"\theta_2": full[theta2],
    },
    published=("(9)", "(10)"),
    uses=[by_frames],
    solves={"ik_pose": ()},
)
d.function(
    "ik_pose",
    "The joint angles for a full pose; there is at most one solution.",
    {"T": T},
    {"q": [atan2(s1, c1), full[theta2]]},
    program=f,
    branches=SINGLE,
    result="Solutions",
    source="eq. (10)",
    notes=("UNREACHABLE if the arm cannot take the pose exactly.",),
)

a1, a2 = real("a1"), real("a2")
d.inverses.append(
    Inverse(
        "ik_pose",
        q,
        tuple(T),
        tuple(pose),
        parametrisation=tuple(pose.subs({theta1: a1, theta2: a2}, simultaneous=True)),
    )
)
d.solved += [
    Solved(
        "ik_pose",
        theta1,
        linear_pair(theta1, elbow_y, elbow_x),
        l1 * sin(theta1) - T[1, 3] + l2 * T[1, 0],
    ),
    Solved("ik_pose", theta2, full, T[0, 0] * cos(theta1) + T[1, 0] * sin(theta1) - cos(theta2)),
]

# Workspace

d.step(
    "Workspace",
    "The triangle exists if |l1 - l2| <= r <= l1 + l2, so the workspace is an annulus.",
    {"r_{min}": sp.Abs(l1 - l2), "r_{max}": l1 + l2, "S": sp.pi * 4 * l1 * l2},
    proves="The area of the annulus is pi times the difference of the squared radii.",
    equal=[(sp.pi * ((l1 + l2) ** 2 - (l1 - l2) ** 2), 4 * sp.pi * l1 * l2)],
)
d.function(
    "workspace_radii",
    "Inner and outer radius of the annulus that the hand can reach.",
    {},
    {"radii": [sp.Abs(l1 - l2), l1 + l2]},
)

# Claims of the paper

state(d, Arm(l1, l2, theta1, theta2, position, A1, A2, pose))
