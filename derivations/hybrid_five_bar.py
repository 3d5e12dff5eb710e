"""The hybrid manipulator of Chablat, Wenger and Angeles: a five-bar linkage on a revolute."""

import sympy as sp
from closedform.derivations import hybrid_five_bar_design as design
from closedform.derivations.claims.five_bar_postures import FiveBar
from closedform.derivations.claims.hybrid_five_bar import state
from closedform.derivations.hybrid_five_bar_inverse import Loop, inverse_kinematics
from closedform.derivations.papers.chablat_wenger_angeles import CHABLAT_WENGER_ANGELES
from sympy import Rational, atan2, cos, sin, sqrt

from closedform import (
    Derivation,
    Inverse,
    Program,
    branches,
    choose,
    circle_intersection,
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
d.loop = the_loop = d.step(
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
size = f.let("size", L0 + L1 + L2)
# the inverse tolerates less than the usual share: L1 + L2 may be a third of the size
meeting, chord = circle_intersection(
    f, CD, (L2, L2), CP, sigma, scale=size, share=Rational(1, 4), free=(theta4, theta5)
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
    "In the plane of the linkage, P is an intersection of the circles of radius L2 about C and "
    "D.  It is to the left or to the right of CD: these are the two assembly modes.  Let n be the "
    "unit vector from C to D and h half of their distance.  P is at the distance e from the "
    "middle of CD, at right angles to n, on either side.  The loop cannot close if CD is longer "
    "than 2*L2.  If C and D coincide, P is free on a circle; we return the limit for C and D that "
    "approach each other along the y axis.",
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
    solves={"fk": ()},
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
    ("CD_y", "component of CD along AB"),
    ("CD_r", "component of CD away from AB"),
    ("n_1", "component of n along AB"),
    ("n_2", "component of n away from AB"),
    ("L3", "length of the driven bar BD, if it differs from AC"),
    ("L4", "length of the passive bar DP, if it differs from CP"),
    ("psi", "angle from CP to DP"),
    ("kappa", "condition number of 𝐀"),
    ("w", "by how much L0 exceeds 2*L1"),
    ("s", "how far L0 is above its lower limit in a regime"),
    ("t", "how far L0 is below its upper limit in a regime"),
    ("M", "the larger of L1 and L2"),
    ("m", "the smaller of L1 and L2"),
    ("R", "L1 + L2, the outer radius of the hollow spheres"),
    ("r", "|L1 - L2|, the inner radius of the hollow spheres"),
):
    d.write(name, meaning=meaning)
d.write("r_P", "r_P", "distance of P from AB")
d.write("rP", "r_P", same="r_P")
d.write("rP2", "r_P^{2}", same="r_P")
for letter in ("a", "b"):
    d.write(f"{letter}2", f"{letter}^{{2}}", same=letter)
d.explain(
    {
        r"\rho": "distance of P from AB, with a sign",
        r"\overrightarrow{AP}": "vector from A to P, along AB and away from it",
        r"\overrightarrow{BP}": "vector from B to P, along AB and away from it",
        r"\overrightarrow{CP}": "vector of the bar CP",
        r"\overrightarrow{DP}": "vector of the bar DP",
        r"\varsigma": "singular values of 𝐀",
        r"\mathbf A": "factor of the rate of P in 𝐀*dp = 𝐁*dq",
        r"\mathbf B": "factor of the rates of the joints, diagonal",
        r"\mathbf J": "derivative of p with respect to q",
        "a": "distance of P from A",
        "b": "distance of P from B",
        r"\mathbf c": "place of C",
        r"\mathbf d": "place of D",
        r"\mathbf p": "place of P",
        r"\mathbf k": "normal of the plane of the linkage",
        "d_{max}": "largest distance of C and D",
        "d_{min}": "smallest distance of C and D",
        "e": "distance of P from the middle of CD",
        "h": "half the distance of C and D",
        r"F_\psi": "polynomial that vanishes on the curve of one psi",
        r"\alpha": "abbreviation, for the leg over A",
        r"\beta": "abbreviation, for the leg over B",
        "N_c": "measure of how far leg AC is from being stretched",
        "M_c": "measure of how far leg AC is from being folded",
        "N_d": "measure of how far leg BD is from being stretched",
        "M_d": "measure of how far leg BD is from being folded",
    }
)
d.write("P_r", r"\rho", same="rho")
d.write("side", r"\Delta", "cross product of CP and DP, in an assembly mode")
d.write("apart", r"\mathit{CD}", "distance of C and D")
d.write(height, "e", same="e")
d.write("along_c", "B_{22}")
d.write("along_d", "B_{33}")
d.write("volume", "V", "volume of the workspace")

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
    """The matrix with P replaced in its rows: by its plane, the leg over C, the leg over D."""
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
    "Velocity: the two matrices",
    "These are the derivatives of the loop equations.  The rows of 𝐀 are L2*k, p - c and p - d.  𝐁 "
    "is diagonal because each leg depends on its own motor only and a turn about AB moves P at "
    "right angles to both bars.  CP_y is the component of CP along AB and CP_r the one away from "
    "it; DP likewise.",
    {r"\mathbf A": A_p, r"\mathbf B": B_q, r"\mathbf B(\theta)": by_angles},
    published=("(2)", "(3)", "(4)"),
    proves=(
        "The rows of 𝐀 are L2*k, p - c and p - d; in the angles, 𝐁 is diagonal with the entries "
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
    "L2 = L4.  Then the triangle over CD is isosceles, L2^2 is a common factor of 𝐀*𝐀^T, which the "
    "condition number uses, and the two hollow spheres of the workspace have the same size.",
    {r"B_{33}(L_3, L_4)": L3 * L4 * sin(theta5 - theta3)},
    proves="The last rows of 𝐀 and 𝐁 are those of the bars L3 and L4.",
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
    "Velocity: the Jacobian and the determinants",
    "𝐉 = 𝐀^-1*𝐁.  All determinants factor: det(𝐀) contains the sine of the angle between CP and "
    "DP, det(𝐁) contains rho and the sine of the angle between the bars of each leg.  At a "
    "parallel singularity, det(𝐀) = 0, either C, D, P are in line or C = D: P can move although "
    "the motors stand still, at right angles to CP or on a circle about D.  At a serial "
    "singularity, det(𝐁) = 0, a motor turns and P stands still.  For theta1 this happens with P on "
    "AB (rho = 0), which section 2.6 of the paper does not mention; for theta2 with A, C, P in "
    "line; for theta3 with B, D, P in line.  In the last two cases a leg is stretched or folded.",
    {
        r"\bigl(\overrightarrow{CP}\times\overrightarrow{DP}\bigr) \mathbf A^{-1}": (
            A_inverse * product
        ).applyfunc(lambda entry: sp.factor(normal(entry))),
        r"\det\mathbf A": det_a,
        r"\det\mathbf B": det_b,
        r"\det\mathbf J": det_j,
    },
    proves=(
        "𝐀*𝐉 = 𝐁; the determinants of 𝐀, 𝐁 and 𝐉 are as stated; and the cross product of CP and "
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
shown_as = {"jacobian_parallel": r"\mathbf A", "jacobian_serial": r"\mathbf B"}
for name, summary, outputs, notes in (
    ("jacobian_parallel", "𝐀 of 𝐀*dp = 𝐁*dq; its rows are L2*k, p - c and p - d.", {"A": A_p}, ()),
    (
        "jacobian_serial",
        "The diagonal of 𝐁 of 𝐀*dp = 𝐁*dq: L2*rho, L1*L2*sin(theta4 - theta2) and L1*L2*sin(theta5 "
        "- theta3).",
        {"B": [L2 * P_r, along_c, along_d]},
        ("Its signs distinguish the working modes; BRANCHES lists them in the same order.",),
    ),
    (
        "jacobian",
        "Derivative of p with respect to q: 𝐀^-1*𝐁.",
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
        "Ratio of the largest to the smallest singular value of 𝐀.",
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
        equation=shown_as.get(name, ""),
        notes=("NaN for an assembly mode that does not exist.", *notes),
    )

# Inverse kinematics: all working modes

angles = (theta1, theta2, theta3, theta4, theta5)
solved = Loop(
    lengths=(L0, L1, L2),
    angles=angles,
    p=p,
    k=k,
    equations=tuple(loop),
    legs=(leg_c, leg_d),
    step=the_loop,
)
inverse_kinematics(d, solved)

# Conditioning, loci, workspace

design.conditioning(d, A_p.subs(passive), theta5 - theta4, d_point - c, (theta2, theta3))
design.loci(d)
volumes = design.workspace(d)

# Claims of the paper

state(
    d,
    FiveBar(
        lengths=(L0, L1, L2),
        angles=angles,
        pivots=(A, B),
        elbows=(c, d_point),
        by_legs=(by_c, by_d),
        k=k,
        p=p,
        loop=tuple(loop),
        A=A_p.subs(passive),
        A_loop=A_loop,
        B=by_angles,
        in_plane=solved.in_plane,
        volumes=volumes,
    ),
)
