"""The hybrid manipulator of Chablat, Wenger and Angeles: a five-bar linkage on a revolute."""

from dataclasses import replace

import sympy as sp
from closedform.derivations import hybrid_five_bar_design as design
from closedform.derivations.claims.five_bar_postures import FiveBar
from closedform.derivations.claims.hybrid_five_bar import state
from closedform.derivations.papers.chablat_wenger_angeles import CHABLAT_WENGER_ANGELES
from sympy import atan2, cos, sin, sqrt

from closedform import (
    Bound,
    Degenerate,
    Derivation,
    Inverse,
    Link,
    Program,
    Solved,
    Triangle,
    branches,
    choose,
    circle_intersection,
    linear_pair,
    merge_angles,
    normal,
    real,
    rotation,
    skeleton,
    velocity_matrices,
)

d = Derivation(
    "hybrid_five_bar",
    "Five-bar linkage on a revolute",
    CHABLAT_WENGER_ANGELES,
    "The pivots A (the origin) and B lie on the y axis at the distance L0.  The bars AC and BD of "
    "length L1 are driven at the angles theta2 and theta3.  The bars CP and DP of length L2 follow "
    "at theta4 and theta5.  All four angles are measured from the y axis.  theta1 turns the "
    "linkage about AB.  At theta1 = 0 it lies in the plane of x and y, and a bar at the angle t "
    "points along (-sin(t), cos(t), 0).",
    task=["x", "y", "z"],
    singularities=("P on AB", "A, C, P in line", "B, D, P in line", "C, D, P in line"),
    poles=("C, D, P in line",),
)
UNIT, NONE = "any unit", "the paper gives no value"
L0 = d.parameter("L0", value=7, unit=UNIT, meaning="distance AB of the pivots", source=NONE)
L1 = d.parameter("L1", value=8, unit=UNIT, meaning="length of the driven bars", source=NONE)
L2 = d.parameter("L2", value=5, unit=UNIT, meaning="length of the following bars", source=NONE)
theta1, theta2, theta3 = (d.joint(f"theta{i}") for i in (1, 2, 3))
theta4, theta5 = (d.joint(f"theta{i}", passive=True) for i in (4, 5))
q = (theta1, theta2, theta3)


def in_space(along: sp.Expr, off: sp.Expr) -> sp.Matrix:
    """A vector in the plane of the linkage, from its components along AB and across AB."""
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
the_loop = d.step(
    "The loop",
    "P lies in the plane of the linkage, whose normal is k, at the distance L2 from C and from D.  "
    "By the leg over C, the signed distance of P from the axis is rho.  The leg over D must lead "
    "to the same point.",
    {
        r"\mathbf k": k,
        r"\mathbf c": c,
        r"\mathbf d": d_point,
        r"\mathbf p = \mathbf c + \overrightarrow{CP}": by_c,
        r"\mathbf p = \mathbf d + \overrightarrow{DP}": by_d,
        r"\rho": rho,
    },
    proves=(
        "Both legs lead to the same point, which is at the signed distance rho from the axis; "
        "and the loop equations hold for it."
    ),
    equal=[
        (
            by_c,
            sp.Matrix([-rho * cos(theta1), L1 * cos(theta2) + L2 * cos(theta4), rho * sin(theta1)]),
        ),
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
meeting, chord = circle_intersection(
    f, CD, (L2, L2), CP, sigma, scale=L0 + L1 + L2, free=(theta4, theta5)
)
n, half, height = chord.direction, chord.along, chord.height
for name, value in zip(CP, (meeting[CP[0]], meeting[CP[1]]), strict=True):
    f.let(str(name), value)
for name, value in zip(DP, (meeting[u].subs(half, -half) for u in CP), strict=True):
    f.let(str(name), value)
P_y, P_r = f.let("P_y", C[0] + CP[0]), f.let("P_r", C[1] + CP[1])
h, e = real("h", nonnegative=True), real("e", nonnegative=True)
to_p = sp.Matrix([meeting[u].subs({chord.distance: 2 * h, height: e}) for u in CP])
d.step(
    "Forward: P from two circles",
    "In the plane of the linkage, P is an intersection of the circles of radius L2 about C and D.  "
    "It is to the left or to the right of CD: these are the two assembly modes.  Let n be the unit "
    "vector from C to D and h half of their distance.  P is at the distance e from the middle of "
    "CD, at right angles to n, on either side.  The loop cannot close if CD is longer than 2*L2.  "
    "If C and D coincide, P is free on a circle; we return the limit for C and D that part along "
    "the y axis.",
    {
        "h": sqrt(CD[0] ** 2 + CD[1] ** 2) / 2,
        "e": sqrt(L2 - h) * sqrt(L2 + h),
        r"\overrightarrow{CP}": to_p,
        r"\overrightarrow{DP}": to_p.subs(h, -h),
    },
    proves=(
        "CP minus DP is the vector from C to D, CP has the squared length e^2 + h^2, and this is "
        "L2^2."
    ),
    equal=[
        (to_p - to_p.subs(h, -h), 2 * h * sp.Matrix(n)),
        (
            to_p.dot(to_p).subs(list(zip(n, (cos(theta4), sin(theta4)), strict=True))),
            sigma**2 * e**2 + h**2,
        ),
        (h**2 + (sqrt(L2 - h) * sqrt(L2 + h)) ** 2, L2**2),
    ],
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
        "UNREACHABLE: C and D are more than 2*L2 apart, so the loop cannot close.",
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
    entries=(theta4, theta5),
    notes=(
        "NaN for an assembly mode that does not exist.",
        "If C and D coincide, both angles are free but equal: +90 or -90 degrees is returned.",
    ),
)

for name, meaning in (
    ("CP_y", "component of CP along AB"),
    ("CP_r", "component of CP away from AB"),
    ("DP_y", "component of DP along AB"),
    ("DP_r", "component of DP away from AB"),
    ("P_r", "distance of P from AB, with a sign"),
    ("CD_y", "component of CD along AB"),
    ("CD_r", "component of CD away from AB"),
    ("n_1", "component of n away from AB"),
    ("n_2", "component of n along AB"),
    ("L3", "length of the driven bar over D, where it differs"),
    ("L4", "length of the passive bar over D, where it differs"),
    ("psi", "angle from CP to DP"),
    ("kappa", "condition number of A"),
    ("w", "by how much L0 exceeds 2*L1"),
    ("s", "slack of the lower limit of L0 in a regime"),
    ("t", "slack of the upper limit of L0 in a regime"),
    ("M", "the larger of L1 and L2"),
    ("m", "the smaller of L1 and L2"),
    ("R", "L1 + L2, the outer radius of the hollow spheres"),
    ("r", "|L1 - L2|, the inner radius of the hollow spheres"),
):
    d.write(name, meaning=meaning)
d.write("r_P", "r_P", "distance of P from AB")

skeleton(
    d,
    {
        "A": A,
        "B": B,
        "C": in_space(*C),
        "D": in_space(*D),
        "P": in_space(P_y, P_r),
    },
    links={"ground": "AB", "AC": "AC", "BD": "BD", "CP": "CP", "DP": "DP"},
    joints={theta1: "AB", theta2: "A", theta3: "B", theta4: "C", theta5: "D"},
    hand="P",
    ground=("A", "B"),
    lengths={("A", "C"): L1, ("B", "D"): L1, ("C", "P"): L2, ("D", "P"): L2},
    program=f,
    branches=modes,
    notes=("NaN for an assembly mode that does not exist.",),
)

# Velocity

A_loop, B_loop = velocity_matrices(loop, p, q)
on_c, on_d = (dict(zip(p, s + in_space(*b), strict=True)) for s, b in ((c, CP), (d_point, DP)))
at_p = dict(zip(p, in_space(real("P_y"), P_r), strict=True))


def on_the_loop(M: sp.Matrix) -> sp.Matrix:
    """The matrix with P replaced in its rows: by its plane, by the leg over C, by that over D."""
    rows = [M[i, :].subs(place, simultaneous=True) for i, place in enumerate((at_p, on_c, on_d))]
    return sp.Matrix.vstack(*rows).applyfunc(normal)


A_p, B_q = on_the_loop(A_loop), on_the_loop(B_loop)
passive = dict(
    zip(
        (*CP, *DP, P_r),
        (*(L2 * g(t) for t in (theta4, theta5) for g in (cos, sin)), rho),
        strict=True,
    )
)
by_angles = merge_angles(B_q.subs(passive).expand())
d.step(
    "Velocity: A and B",
    "These are the derivatives of the loop equations.  The rows of A are L2*k, p - c and p - d.  B "
    "is diagonal because each leg depends on its own motor only and a turn about AB moves P at "
    "right angles to both bars.  CP_y is the component of CP along AB and CP_r the one away from "
    "it; DP likewise.",
    {"A": A_p, "B": B_q, r"B(\theta)": by_angles},
    published=("(2)", "(3)", "(4)"),
    proves=(
        "The rows of A are L2*k, p - c and p - d; in the angles, B is diagonal with the entries "
        "L2*rho, L1*L2*sin(theta4 - theta2) and L1*L2*sin(theta5 - theta3)."
    ),
    equal=[
        (A_p, sp.Matrix.vstack(L2 * k.T, in_space(*CP).T, in_space(*DP).T)),
        (
            by_angles,
            sp.diag(L2 * rho, L1 * L2 * sin(theta4 - theta2), L1 * L2 * sin(theta5 - theta3)),
        ),
    ],
    uses=[the_loop],
)

L3, L4 = (real(name, positive=True) for name in ("L3", "L4"))
unequal = [(L1, L3), (L2, L4)]
other_leg = ((p - d_point).dot(p - d_point) - L2**2).subs(unequal) / 2
A_other, B_other = velocity_matrices([other_leg], p, q)
over_d = dict(zip(p, by_d.subs(unequal), strict=True))
general = sp.Matrix.hstack(A_other, B_other).subs(over_d, simultaneous=True).applyfunc(normal)
d.step(
    "Velocity: unequal legs",
    "With bars of lengths L3 and L4 over D only the last rows change.  From here on L1 = L3 and "
    "L2 = L4.  Then the triangle over CD is isosceles, L2^2 is a common factor of A*A^T, which the "
    "condition number uses, and the two hollow spheres of the workspace have the same size.",
    {r"B_{33}": L3 * L4 * sin(theta5 - theta3)},
    proves="The last rows of A and B are those of the bars L3 and L4.",
    equal=[
        (general[:, :3], bar(L4, theta5).T),
        (general[:, 3:], sp.Matrix([[0, 0, L3 * L4 * sin(theta5 - theta3)]])),
    ],
)

# Inverse of A: the circles give CP x DP = 2 sigma h e, without the cancellation of the product.

product = CP[0] * DP[1] - CP[1] * DP[0]
side = sigma * height * chord.distance


def across(h: sp.Expr, e: sp.Expr) -> sp.Expr:
    """CP x DP from the intersection of the circles, for n at any angle."""
    n = sp.Matrix([cos(theta4), sin(theta4)])
    normal_to_n = sp.Matrix([-n[1], n[0]])
    return sp.Matrix.hstack(h * n + e * normal_to_n, -h * n + e * normal_to_n).det()


along_c, along_d = real("along_c"), real("along_d")
A_inverse = (A_p.adjugate() / (L2 * product)).applyfunc(normal)
J = A_inverse * sp.diag(L2 * P_r, along_c, along_d)
driven = {along_c: B_q[1, 1], along_d: B_q[2, 2]}
det_a = L2**3 * sin(theta5 - theta4)
det_b = L1**2 * L2**3 * rho * sin(theta4 - theta2) * sin(theta5 - theta3)
det_j = L1**2 * rho * sin(theta4 - theta2) * sin(theta5 - theta3) / sin(theta5 - theta4)
d.step(
    "Velocity: J and the determinants",
    "J = A^-1*B.  All determinants factor: det(A) contains the sine of the angle between CP and "
    "DP, det(B) contains rho and the sine of the angle between the bars of each leg.  At a "
    "parallel singularity, det(A) = 0, either C, D, P are in line or C = D: P can move although "
    "the motors stand still, at right angles to CP or on a circle about D.  At a serial "
    "singularity, det(B) = 0, a motor turns and P stands still.  For theta1 this happens with P on "
    "AB (rho = 0), which section 2.6 does not mention; for theta2 with A, C, P in line; for theta3 "
    "with B, D, P in line.  In the last two cases a leg is stretched or folded.",
    {
        r"\bigl(\overrightarrow{CP}\times\overrightarrow{DP}\bigr) A^{-1}": (
            A_inverse * product
        ).applyfunc(normal),
        r"\det A": det_a,
        r"\det B": det_b,
        r"\det J": det_j,
    },
    proves=(
        "A*J = B; the determinants of A, B and J are as stated; and the cross product of CP and "
        "DP is 2*h*e."
    ),
    equal=[
        (A_p * J.subs(driven), B_q),
        (A_p.det().subs(passive), det_a),
        (B_q.det().subs(passive), det_b),
        (J.subs(driven).det().subs(passive), det_j),
        (across(half, height), 2 * half * height),
    ],
)
v = Program(list(f.body))
sideways = v.let("side", side)
for symbol, value in driven.items():
    v.let(str(symbol), value)


J_named = J.xreplace({-sp.expand(product): -sideways})
for name, summary, outputs, notes in (
    ("jacobian_parallel", "A of A*dp = B*dq; its rows are L2*k, p - c and p - d.", {"A": A_p}, ()),
    (
        "jacobian_serial",
        "The diagonal of B of A*dp = B*dq: L2*rho, L1*L2*sin(theta4 - theta2) and L1*L2*sin(theta5 "
        "- theta3).",
        {"B": [L2 * P_r, along_c, along_d]},
        ("Its signs distinguish the working modes; BRANCHES lists them in the same order.",),
    ),
    (
        "jacobian",
        "Derivative of p with respect to q: A^-1*B.",
        {"J": J_named},
        ("Not finite at a parallel singularity.",),
    ),
    (
        "determinant",
        "Determinant of the Jacobian.",
        {"det": P_r * along_c * along_d / sideways},
        ("Not finite at a parallel singularity.",),
    ),
    (
        "singularities",
        "Factors that vanish exactly on the singular sets: rho, L1*L2*sin(theta4 - theta2) and "
        "L1*L2*sin(theta5 - theta3) (serial), and L2^2*sin(theta5 - theta4) (parallel).",
        {"factors": [P_r, along_c, along_d, sideways]},
        (),
    ),
    (
        "condition_number",
        "Ratio of the largest to the smallest singular value of A.",
        {"kappa": choose(chord.flag, 1, sp.Max(half, height)) / sp.Min(half, height)},
        (
            "Infinite at a parallel singularity.  It does not depend on theta1 and is the same for "
            "both modes.",
        ),
    ),
):
    d.function(
        name,
        summary,
        {"q": q},
        outputs,
        program=v,
        branches=modes,
        notes=("NaN for an assembly mode that does not exist.", *notes),
    )

# Inverse kinematics: all working modes

tau, sigma2, sigma3 = (real(f"sigma_{name}") for name in ("axis", "leg_c", "leg_d"))
SIGN = {+1: "plus", -1: "minus"}
working = branches((tau, SIGN), (sigma2, SIGN), (sigma3, SIGN))
d.branches = working.labels
base2, base3, elbow4, elbow5 = (real(name) for name in ("base2", "base3", "elbow4", "elbow5"))

w = Program()
r2 = w.let("r2", x**2 + z**2, nonnegative=True)
square_c = w.let("square_c", r2 + y**2, nonnegative=True)
square_d = w.let("square_d", r2 + (y - L0) ** 2, nonnegative=True)
squares = list(w.body)
(triangle_c, arm_c), (triangle_d, arm_d) = (
    Triangle.from_square(w, (L1, L2), square, sign, suffix=suffix).stretched_without_link(
        w, angles, sqrt(square), suffix=suffix
    )
    for suffix, square, angles, sign in (
        ("_c", square_c, (elbow4, base2), sigma2),
        ("_d", square_d, (elbow5, base3), sigma3),
    )
)
inside = Program([*squares, *(s for s in w.body if isinstance(s, Bound))])
size = L0 + L1 + L2
r = w.let("r", sqrt(r2), nonnegative=True)
on_axis = w.vanishes("on_axis", r, size, "P is on the axis", free=(theta1,))
at_a = w.vanishes("at_A", r + sp.Abs(y), size, "P is at A", free=(theta2,))
at_b = w.vanishes("at_B", r + sp.Abs(y - L0), size, "P is at B", free=(theta3,))
w.vanishes("no_bar", L1, L1 + L2, "the driven bars have no length", free=(theta2, theta3))
turn = linear_pair(theta1, tau * z, -tau * x)
bearing_c, bearing_d = (
    linear_pair(theta, tau * r * ahead - along * beyond, along * ahead + tau * r * beyond)
    for theta, along, (ahead, beyond) in ((theta2, y, arm_c), (theta3, y - L0, arm_d))
)

Products = tuple[sp.Expr, sp.Expr]


def products(u: sp.Matrix, v: sp.Matrix) -> Products:
    """The inner and the cross product of two vectors in the plane."""
    return u.dot(v), sp.Matrix.hstack(u, v).det()


def bars_at_p(pivots: Products, leg_c: Products, leg_d: Products) -> sp.Expr:
    """CP x DP, times AP^2 and BP^2, from the products of AP and BP, AP and CP, BP and DP."""
    along = leg_c[0] * leg_d[0] + leg_c[1] * leg_d[1]
    return pivots[0] * (leg_c[0] * leg_d[1] - leg_c[1] * leg_d[0]) + pivots[1] * along


legs = [
    (w.let(f"inner_{name}", square - (L1 - L2) * (L1 + L2)), sign * (sqrt(N) * sqrt(M)))
    for name, square, sign in (("c", square_c, sigma2), ("d", square_d, sigma3))
    for N, M in [[real(f"{n}_{name}", nonnegative=True) for n in "NM"]]
]
w.determined(
    sp.Abs(bars_at_p((y * (y - L0) + r2, tau * r * L0), *legs)),
    4 * L2**2 * square_c * square_d,
    "C, D and P are in line, or C and D coincide",
)
driven_angles = [choose(at_a, 0, bearing_c[theta2]), choose(at_b, 0, bearing_d[theta3])]


def spelled(name: str, square: sp.Expr, along: sp.Expr, sign: sp.Symbol) -> dict[str, sp.Expr]:
    """The formulas of one leg: distance of P from its pivot, N, M and the angle of its bar."""
    N, M = (real(f"{n}_{name}", nonnegative=True) for n in "NM")
    distance = real(name) ** 2
    return {
        f"{name}^2": square,
        f"N_{name}": (L1 + L2) ** 2 - distance,
        f"M_{name}": distance - (L1 - L2) ** 2,
        rf"\theta_{ {'a': 2, 'b': 3}[name] }": atan2(tau * real("r_P"), along)
        - Triangle(L1, L2, sign, N, M).base,
    }


d.step(
    "Inverse: the eight working modes",
    "rho is the distance of P from the axis with either sign; the other sign turns theta1 by half "
    "a turn.  In the plane of the linkage, A, C, P and B, D, P are triangles with known sides.  "
    "Each has two mirror images, which differ in the sign of the angle between the bars.  So the "
    "three signs are those of the diagonal of B.  If P is on the axis, theta1 is free and we "
    "return 0.  P can be at A or at B only if L1 = L2; then theta2 or theta3 is free as well.",
    {
        "r_P": sqrt(x**2 + z**2),
        r"\theta_1": turn[theta1],
        **spelled("a", y**2 + real("r_P") ** 2, y, sigma2),
        **spelled("b", (y - L0) ** 2 + real("r_P") ** 2, y - L0, sigma3),
    },
    uses=[the_loop],
)
off_axis = real("rho")
ap, bp = sp.Matrix([y, off_axis]), sp.Matrix([y - L0, off_axis])
cp, dp = (L2 * sp.Matrix([cos(t), sin(t)]) for t in (theta4, theta5))
d.step(
    "Inverse: what the joints determine",
    "Rounded joints miss the lengths of the bars by a few units in the last place of L0 + L1 + "
    "L2.  The error of P, where the bars CP and DP meet, is this error divided by the sine of the "
    "angle between them.  So near a parallel singularity, with C, D and P in line or with C = D, "
    "fk cannot recover P from the joints, however they are computed.  The status is SINGULAR if "
    "the sine is less than 2^-10.  The inverse computes the cross product of the bars without "
    "their angles, from the products of each bar with the line from its pivot to P.  The inner "
    "product of AP and CP is half of AP^2 - L1^2 + L2^2, and their cross product is half the root "
    "of N_a M_a, with the sign of the leg.",
    {
        r"\overrightarrow{AP}": ap,
        r"\overrightarrow{BP}": bp,
        r"|\overrightarrow{CP}\times\overrightarrow{DP}|": L2**2 * sp.Abs(sin(theta5 - theta4)),
    },
    proves=(
        "The cross product of CP and DP from the products with AP and BP, and each of these "
        "products as stated."
    ),
    equal=[
        (
            bars_at_p(products(ap, bp), products(ap, cp), products(bp, dp)),
            ap.dot(ap) * bp.dot(bp) * products(cp, dp)[1],
        ),
        (products(ap, bp)[0], y * (y - L0) + off_axis**2),
        (products(ap, bp)[1], off_axis * L0),
        (2 * products(ap, cp)[0], ap.dot(ap) + cp.dot(cp) - (ap - cp).dot(ap - cp)),
        (
            4 * products(ap, cp)[1] ** 2,
            4 * ap.dot(ap) * cp.dot(cp) - (2 * products(ap, cp)[0]) ** 2,
        ),
    ],
)
d.function(
    "ik",
    "The driven angles of all eight working modes.",
    {"x": tuple(p)},
    {"q": [choose(on_axis, 0, turn[theta1]), *driven_angles]},
    program=w,
    branches=working,
    result="Solutions",
    source="the working modes of section 2.4",
    notes=(
        "BRANCHES name the signs of the diagonal of B; each posture is in one of the two assembly "
        "modes.",
        "UNREACHABLE: the distance of P from A or from B is more than L1 + L2 or less than "
        "|L1 - L2|.",
        "SINGULAR: theta1 is free if P is on the axis; theta2 or theta3 is free if L1 = L2 and P "
        "is at A or at B; both are free if L1 = 0.  0 is returned for theta1, and for the others "
        "unless L1 = 0.",
        "SINGULAR also near a parallel singularity, if the sine of the angle between CP and DP is "
        "less than 2^-10: the loop closes, but one ulp of the joints moves P by more than 1e-12 of "
        "the lengths.  If L0 = 0, C coincides with D for equal signs of the last two entries.",
        "Ill-conditioned near the boundary of the workspace: the angles lose half their digits, "
        "but the loop still closes.",
    ),
)
d.function(
    "workspace_contains",
    "Whether P can be reached: it lies in both hollow spheres.",
    {"p": tuple(p)},
    {"inside": sp.true},
    program=inside,
    source="section 3.1",
    boolean=True,
)


def cosine_rule(square: sp.Expr, angle: sp.Expr) -> sp.Expr:
    return square - L1**2 - L2**2 - 2 * L1 * L2 * cos(angle)


def toward(theta: sp.Symbol, along: sp.Expr, passive_angle: sp.Symbol) -> sp.Expr:
    """Zero if the end of the bars, as seen from their pivot, is in the direction of P."""
    elbow = passive_angle - theta
    reach = sp.Matrix([L1 + L2 * cos(elbow), L2 * sin(elbow)])
    off = z * sin(theta1) - x * cos(theta1)
    return sin(theta) * (along * reach[0] + off * reach[1]) - cos(theta) * (
        off * reach[0] - along * reach[1]
    )


between_c, between_d = theta4 - theta2, theta5 - theta3
told_c, told_d = (
    replace(lemma, roles=(*lemma.roles, (r"\theta", angle)))
    for lemma, angle in ((triangle_c, between_c), (triangle_d, between_d))
)
d.solved += [
    Solved("ik", theta1, turn, k.dot(p), leg_c),
    Solved("ik", theta4, told_c, cosine_rule(x**2 + y**2 + z**2, between_c), leg_c),
    Solved("ik", theta5, told_d, cosine_rule(x**2 + (y - L0) ** 2 + z**2, between_d), leg_d),
    Solved("ik", theta2, bearing_c, toward(theta2, y, theta4), leg_c),
    Solved("ik", theta3, bearing_d, toward(theta3, y - L0, theta5), leg_d),
]
in_plane = {x: -off_axis * cos(theta1), z: off_axis * sin(theta1)}
axis = {x: sp.S.Zero, z: sp.S.Zero}
d.inverses.append(
    Inverse(
        "ik",
        q,
        (sp.S.Zero,) * 3,
        tuple(loop),
        (
            Degenerate(
                (on_axis,),
                axis,
                theta1,
                relation=r"\theta_2, \theta_3 \text{ as for any } \theta_1",
            ),
            Degenerate(
                (at_a, on_axis),
                {**axis, y: sp.S.Zero, L2: L1},
                theta2,
                relation=r"\theta_4 = \theta_2 + \pi",
            ),
            Degenerate(
                (at_b, on_axis),
                {**axis, y: L0, L2: L1},
                theta3,
                relation=r"\theta_5 = \theta_3 + \pi",
            ),
        ),
        images="fk",
        links=tuple(
            Link((joint,), (equation,), given)
            for joint, equation, given in zip(q, loop, ({}, in_plane, in_plane), strict=True)
        ),
    )
)

# Conditioning, loci, workspace

design.conditioning(d, A_p.subs(passive), theta5 - theta4, d_point - c, theta2, theta3)
design.loci(d)
volumes = design.workspace(d)

# Claims of the paper

state(
    d,
    FiveBar(
        (L0, L1, L2),
        (theta1, theta2, theta3, theta4, theta5),
        (A, B),
        (c, d_point),
        (by_c, by_d),
        k,
        p,
        tuple(loop),
        A_p.subs(passive),
        A_loop,
        by_angles,
        in_plane,
        volumes,
    ),
)
