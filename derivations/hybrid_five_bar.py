"""The hybrid manipulator of Chablat, Wenger and Angeles: a five-bar linkage on a revolute."""

import sympy as sp
from closedform.derivations.papers import CHABLAT_WENGER_ANGELES
from sympy import atan2, cos, sin, sqrt

from closedform.algebra import normal
from closedform.derivation import Continuum, Derivation, Inverse, Solved, Stage
from closedform.frames import merge_angles, rotation
from closedform.functions import Program, branches, choose, real
from closedform.lemmas import circle_intersection, linear_pair, two_link_triangle
from closedform.loops import velocity_matrices

d = Derivation(
    "hybrid_five_bar",
    "Five-bar linkage on a revolute",
    CHABLAT_WENGER_ANGELES,
    "The pivots A, the origin, and B lie L0 apart on the y axis.  The bars AC and BD of length L1 "
    "are driven at the angles theta2 and theta3, the bars CP and DP of length L2 follow at theta4 "
    "and theta5; all four angles are measured from the y axis.  theta1 turns the linkage about AB; "
    "at theta1 = 0 it lies in the plane of x and y, and a bar at the angle t points along "
    "(-sin t, cos t, 0).",
    task=["x", "y", "z"],
    singularities=("P on AB", "A, C, P in line", "B, D, P in line", "C, D, P in line"),
)
UNIT, NONE = "any length", "the paper gives no value"
L0 = d.parameter("L0", value=7, unit=UNIT, meaning="distance AB of the pivots", source=NONE)
L1 = d.parameter("L1", value=8, unit=UNIT, meaning="length of the driven bars", source=NONE)
L2 = d.parameter("L2", value=5, unit=UNIT, meaning="length of the following bars", source=NONE)
theta1, theta2, theta3 = (d.joint(f"theta{i}") for i in (1, 2, 3))
theta4, theta5 = (d.joint(f"theta{i}", passive=True) for i in (4, 5))
q = (theta1, theta2, theta3)


def in_space(along: sp.Expr, off: sp.Expr) -> sp.Matrix:
    """A vector of the linkage, along AB and at right angles to it, turned by theta1."""
    return rotation("y", theta1) * sp.Matrix([-off, along, 0])


def bar(length: sp.Expr, angle: sp.Expr) -> sp.Matrix:
    return in_space(length * cos(angle), length * sin(angle))


# The loop

x, y, z = p = sp.Matrix([real("x"), real("y"), real("z")])
k = rotation("y", theta1) * sp.Matrix([0, 0, 1])
A, B = in_space(0, 0), in_space(L0, 0)
c, d_point = A + bar(L1, theta2), B + bar(L1, theta3)
loop = [
    L2 * k.dot(p),
    ((p - c).dot(p - c) - L2**2) / 2,
    ((p - d_point).dot(p - d_point) - L2**2) / 2,
]
by_c, by_d = c + bar(L2, theta4), d_point + bar(L2, theta5)
rho = L1 * sin(theta2) + L2 * sin(theta4)
leg_c, leg_d = (dict(zip(p, point, strict=True)) for point in (by_c, by_d))
d.step(
    "The loop",
    "P lies in the plane of the linkage, whose normal is k, and L2 away from C and from D.  Seen "
    "along the leg over C it is rho off the axis, a distance with a sign; the leg over D must lead "
    "to the same point.",
    {
        r"\mathbf k": k,
        r"\mathbf c": c,
        r"\mathbf d": d_point,
        r"\mathbf p = \mathbf c + \overrightarrow{CP}": by_c,
        r"\mathbf p = \mathbf d + \overrightarrow{DP}": by_d,
        r"\rho": rho,
    },
    equal=[
        (by_c, sp.Matrix([-rho * cos(theta1), L1 * cos(theta2) + L2 * cos(theta4), rho * sin(theta1)])),
        (loop[0].subs(leg_c) + loop[1].subs(leg_c), sp.S.Zero),
        (loop[0].subs(leg_d) + loop[2].subs(leg_d), sp.S.Zero),
    ],
)

# Forward kinematics: both assembly modes

sigma = real("sigma_assembly")
modes = branches((sigma, {+1: "left_of_CD", -1: "right_of_CD"}))
d.assembly_modes = modes.labels

f = Program()
C = f.let("C_y", L1 * cos(theta2)), f.let("C_r", L1 * sin(theta2))
D = f.let("D_y", L0 + L1 * cos(theta3)), f.let("D_r", L1 * sin(theta3))
CP, DP = (real("CP_y"), real("CP_r")), (real("DP_y"), real("DP_r"))
CD = f.let("CD_y", D[0] - C[0]), f.let("CD_r", D[1] - C[1])
meeting, chord = circle_intersection(f, CD, L2, L2, CP, sigma, L0 + L1 + L2, free=(theta4, theta5))
n, half, height = chord.direction, chord.along, chord.height
for name, value in zip(CP, (meeting[CP[0]], meeting[CP[1]]), strict=True):
    f.let(str(name), value)
for name, value in zip(DP, (meeting[u].subs(half, -half) for u in CP), strict=True):
    f.let(str(name), value)
P_y, P_r = f.let("P_y", C[0] + CP[0]), f.let("P_r", C[1] + CP[1])
d.step(
    "Forward: P from two circles",
    "In the plane of the linkage, P is where the circles of radius L2 about C and D meet: to the "
    "left or to the right of CD, the two assembly modes.  With n the direction of CD and h half "
    "its length, CP and DP are +h n and -h n, plus the same vector e along the normal.  The loop "
    "stays open where CD is longer than 2 L2.  If C and D coincide, P is free on a circle; we "
    "return the limit of C and D parting along the y axis.",
    {
        r"h": chord.distance / 2,
        r"e": sqrt(L2 - half) * sqrt(L2 + half),
        r"\overrightarrow{CP}": sp.Matrix([half * n[0] - sigma * height * n[1], half * n[1] + sigma * height * n[0]]),
    },
)
d.function(
    "fk",
    "Position of P in both assembly modes.",
    {"q": q},
    {"p": in_space(P_y, P_r)},
    program=f,
    branches=modes,
    result="Positions",
    source="the loop closure of section 2.3",
    notes=(
        "UNREACHABLE: C and D are more than 2 L2 apart, the loop is open.",
        "SINGULAR: C and D coincide; P is free on the circle of radius L2 about them, and the "
        "point at theta4 = theta5 = +90 or -90 degrees is returned.",
        "Ill-conditioned near the parallel singularities, where both modes meet or P is free.",
    ),
)
d.inverses.append(Inverse("fk", tuple(p), (sp.S.Zero,) * 3, tuple(loop)))
d.function(
    "passive_angles",
    "Angles theta4 and theta5 of CP and DP in both assembly modes.",
    {"q": q},
    {"theta": [atan2(CP[1], CP[0]), atan2(DP[1], DP[0])]},
    program=f,
    branches=modes,
)

# Velocity

A_loop, B_loop = velocity_matrices(loop, p, q)
on_c, on_d = (dict(zip(p, s + in_space(*b), strict=True)) for s, b in ((c, CP), (d_point, DP)))
at_p = dict(zip(p, in_space(real("P_y"), P_r), strict=True))


def on_the_loop(M: sp.Matrix) -> sp.Matrix:
    """Row by row at P on the axis plane, over C and over D."""
    rows = [M[i, :].subs(place, simultaneous=True) for i, place in enumerate((at_p, on_c, on_d))]
    return sp.Matrix.vstack(*rows).applyfunc(normal)


A_p, B_q = on_the_loop(A_loop), on_the_loop(B_loop)
passive = dict(
    zip((*CP, *DP, P_r), (*(L2 * g(t) for t in (theta4, theta5) for g in (cos, sin)), rho), strict=True)
)
by_angles = merge_angles(B_q.subs(passive).expand())
d.step(
    "Velocity: A and B",
    "The loop equations, differentiated.  The rows of A are L2 k, p - c and p - d; B is diagonal, "
    "because the two legs do not know of each other and a turn about AB moves P at right angles to "
    "both bars.",
    {"A": A_p, "B": B_q, r"B(\theta)": by_angles},
    published=("(2)", "(3)", "(4)"),
    equal=[
        (A_p, sp.Matrix.vstack(L2 * k.T, in_space(*CP).T, in_space(*DP).T)),
        (by_angles, sp.diag(L2 * rho, L1 * L2 * sin(theta4 - theta2), L1 * L2 * sin(theta5 - theta3))),
    ],
)
