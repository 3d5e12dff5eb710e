"""The H6AR of Rao and Raju as published: the wrist follows the averages of the arms' angles."""

import sympy as sp
from closedform.derivations.claims.h6ar import state
from closedform.derivations.h6ar_free_turn import (
    as_published,
    free_turn,
    report_short_wrist,
    turn_step,
    turned_by,
    with_waist,
)
from closedform.derivations.h6ar_jacobian import TIP_RATES, factors_shown
from closedform.derivations.h6ar_mechanism import (
    ACCURACY,
    BOTH_TIPS,
    ELBOW,
    MID_PLANE_ROWS,
    STEEP,
    WAIST,
    Pair,
    Posture,
    allowances,
    alpha,
    amplification,
    arm,
    arm_frames,
    beta,
    by_half_sums,
    declare,
    design,
    extended,
    half_gap,
    half_sums,
    half_sums_step,
    in_space,
    midpoint,
    mu2,
    mu23,
    named,
    outer_jacobian,
    pair,
    phi,
    pitch,
    pose_matrix,
    product,
    psi,
    reach,
    solve_mid_plane,
    straight,
    target,
    theta2A,
    theta23A,
    tip,
    tip_system,
    turned,
    wrist_given,
    wrist_let,
    wrist_squared,
)
from closedform.derivations.h6ar_skeleton import draw
from closedform.derivations.h6ar_tip import tip_step
from closedform.derivations.papers.rao_raju import RAO_RAJU
from sympy import Rational, atan2, cos, sin, sqrt, tan

from closedform import (
    Bound,
    Combination,
    Derivation,
    Inverse,
    Link,
    Program,
    branches,
    choose,
    homogeneous,
    real,
    sign_of,
    two_sines,
)

d = Derivation(
    "h6ar",
    "H6AR, published model",
    RAO_RAJU,
    "A waist carries two equal arms of two links, each at the distance d from the mid-plane.  "
    "Their tips carry a wrist of two links and a gear set, which yaws (psi) and rolls (phi) as "
    "the arms move apart, and an actuator for the pitch (theta).  In this model, eqs. (1) to (9) "
    "as printed, the wrist hangs on a virtual arm whose angles are the averages of the real "
    "ones.  Yaw and roll are measured against the base.  The average of two directions is taken "
    "on the shorter arc between them.",
    task=["x", "y", "z", "psi", "phi", "theta"],
    singularities=(
        "the tip is above or below the waist axis",
        "virtual arm with the wrist straight or folded",
        "virtual arm straight or folded",
        "upper arms half a turn apart",
        "fore-arms half a turn apart",
        "wrist links stretched along the base line",
    ),
    poles=("wrist links stretched along the base line",),
)
m, q = declare(d)
theta1, theta2R, theta3R, theta2L, theta3L, theta = q
means, halves = half_sums(q), by_half_sums(q)
for name in ("x_T", "y_T", "z_T"):
    d.explain({name: "coordinate of the tip"})
d.explain(
    {"e_1": "side of the triangle of both points", "e_2": "side of the triangle of both points"}
)
d.explain({"r_6": "distance of the point of eq. (6) from the waist axis"})
d.explain({"h_6": "height of the point of eq. (6) above the shoulders"})
shoulder_half, fore_half = means[alpha], means[beta]

# Tips of the fore-arms

right, left = arm(m, theta2R, theta2R + theta3R), arm(m, theta2L, theta2L + theta3L)
tips = [in_space(m, pair(theta1), planar, side) for planar, side in ((right, m.d), (left, -m.d))]
end = homogeneous(sp.eye(3), (0, 0, m.L2))
by_frames = [
    product([*arm_frames(m, theta1, second, third, side), end])[:3, 3]
    for second, third, side in ((theta2R, theta3R, m.d), (theta2L, theta3L, -m.d))
]
d.step(
    "Tips of the fore-arms",
    "The product of the frames of Fig. 2 gives the tips.  The offset d from the mid-plane is along "
    "the axes of the shoulders, to the right for one arm and to the left for the other.",
    {"(x, y, z)_R": tips[0], "(x, y, z)_L": tips[1], "T_{RL}": BOTH_TIPS},
    published=("(1)", "(2)"),
    proves="The published coordinates of both tips are those of the product of the frames.",
    equal=[(tips[0], by_frames[0]), (tips[1], by_frames[1])],
)
half_sums_step(d, q)

# Yaw, roll and the invariant point

apart = (right - left) / 2
mean = half_gap(m)
invariant = arm(m, theta2A, theta23A)
off, fore = arm(m, mu2, mu23) - midpoint(m), sqrt(m.L2**2 + m.a3**2)
short_upper, short_fore = m.L1 * (1 - cos(alpha)), fore * (1 - cos(beta))
bent = (m.L2 * sin(mu23 - mu2) + m.a3 * cos(mu23 - mu2)) / fore
leaning = d.step(
    "Yaw and roll",
    "Eqs. (3) to (5) compare the tips: d tan(psi) is half the distance by which the right tip is "
    "ahead of the left one, and d tan(phi) half the distance by which it is above.  Both are "
    "linear in the sines of the half differences of the angles.",
    {r"\Delta_a = d \tan\psi": mean[0], r"\Delta_h = d \tan\phi": mean[1]},
    published=("(3)", "(4)", "(5)"),
    proves=(
        "Half the difference of the tips is as stated, in terms of the half sums and half "
        "differences of the angles."
    ),
    equal=[(apart.xreplace(halves), mean)],
    solves={"ik": [alpha, beta]},
)
d.step(
    "Invariant point",
    "The paper gives this point twice: as the middle of the tips in (6), and by the averages of "
    "the angles in (7).  This model uses (7).  The average theta2A on the shorter arc is mu2 if "
    "cos(delta_2) is not negative, and half a turn from it otherwise; theta23A likewise.  In (6) "
    "the links are shortened by the cosines of the half differences.  If the averages are the half "
    "sums, the line between the two points is one side of a triangle, and the other sides are e_1 "
    "and e_2.  So the points are at most e_1 + e_2 apart, which is of second order in the half "
    "differences.",
    {
        "(r, h)_I": invariant,
        "(r, h)_6": midpoint(m),
        "f": fore,
        "e_1": short_upper,
        "e_2": real("f") * (1 - cos(beta)),
    },
    published=("(6)", "(7)"),
    proves=(
        "The middle of the tips is that of (6); the squared distance of both points is that of a "
        "triangle with the sides e_1 and e_2; and the cosine of the angle between these sides is "
        "the one used."
    ),
    equal=[
        (((right + left) / 2).xreplace(halves), midpoint(m)),
        (off.dot(off), short_upper**2 + short_fore**2 + 2 * short_upper * short_fore * bent),
        (1 - bent**2, (straight(m.L2, m.a3, pair(mu2), pair(mu23)) / fore) ** 2),
    ],
)

# The wrist and the tip

wrist = real("wrist", positive=True)
d.step(
    "Length of the wrist",
    "The wrist and a wrist link form a right triangle; its third side is half the base line minus "
    "half the distance of the gears.  In (8) half the base line is d / cos(psi).",
    {"l_W^2": wrist_squared(m, m.d / cos(psi))},
    published=("(8)",),
    proves="The square of the length of the wrist, from the right triangle, has the published "
    "form.",
    equal=[
        (
            wrist_squared(m, m.d / cos(psi)),
            m.al**2 - (1 - m.gs * cos(psi) / m.d) ** 2 * m.d**2 / cos(psi) ** 2,
        )
    ],
)
posture = Posture(*map(pair, (theta1, theta2A, theta23A, psi, phi, theta)), wrist, m.d / cos(psi))
T = tip(m, posture)
tip_step(d, m, q, wrist, m.d / cos(psi))
d.given_by |= {"psi": leaning, "phi": leaning}


a = real("ahead")
half_base = sqrt(m.d**2 + a**2)
d.step(
    "Yaw without its angle",
    "The forward map computes the cosines and sines of yaw and roll directly from the tips.  It "
    "needs the angles only as outputs: psi = atan2(d tan(psi), d), and likewise for roll.",
    {r"\cos\psi": m.d / half_base, r"\sin\psi": a / half_base},
    proves=(
        "The cosine and the sine of the yaw are these quotients, and both factors of the square "
        "of the length of the wrist are the same with and without the angle."
    ),
    equal=[
        (cos(atan2(a, m.d)), m.d / half_base),
        (sin(atan2(a, m.d)), a / half_base),
        *(
            (
                (m.al + k * m.gs) * m.d / half_base - k * m.d,
                m.d / half_base * (m.al + k * (m.gs - half_base)),
            )
            for k in (1, -1)
        ),
    ],
)


def averages(p: Program) -> tuple[Pair, Pair]:
    """The directions of the virtual arm: averages of the real ones on the shorter arc."""
    upper, fore = (
        Pair(c=p.let(f"c{n}", side * cos(mean)), s=p.let(f"s{n}", side * sin(mean)))
        for n, mean, half in (
            ("2A", means[mu2], means[alpha]),
            ("23A", means[mu23], means[beta]),
        )
        for side in [p.let(f"side{n}", sign_of(cos(half)))]
    )
    return upper, fore


def stand(p: Program) -> tuple[Posture, sp.Matrix]:
    """The posture, and how far the right tip is ahead of the middle and above it."""
    upper, fore = averages(p)
    gap = mean.subs(means, simultaneous=True)
    ahead, above = (p.let(n, e) for n, e in zip(("ahead", "higher"), gap, strict=True))
    base = p.let("base", sqrt(m.d**2 + ahead**2), nonnegative=True)
    rise = p.let("rise", sqrt(m.d**2 + above**2), nonnegative=True)
    yaw = Pair(c=p.let("c_psi", m.d / base), s=p.let("s_psi", ahead / base))
    roll = Pair(c=p.let("c_phi", m.d / rise), s=p.let("s_phi", above / rise))
    length = wrist_let(p, m, base)
    return Posture(
        waist=pair(theta1),
        upper=upper,
        fore=fore,
        yaw=yaw,
        roll=roll,
        pitch=pair(theta),
        wrist=length,
        base=base,
    ), sp.Matrix([ahead, above])


for n, angle in (("2A", theta2A), ("23A", theta23A)):
    d.means |= {real(f"c{n}"): cos(angle), real(f"s{n}"): sin(angle)}
p = Program()
here, gap = stand(p)
fk = [*tip(m, here), *(atan2(a.s, a.c) for a in (here.yaw, here.roll)), turned(theta)]
too_wide = "NaN if the tips are farther apart than the wrist links can span."

d.function(
    "fk",
    "Position of the tip, and yaw, roll and pitch.",
    {"q": q},
    {"x": fk},
    program=p,
    source="eqs. (1) to (9)",
    notes=(too_wide,),
)
p = Program()
d.function(
    "pose",
    "Pose of the tip: turned as the fore-arm, then by phi about z, psi about x, theta about y.",
    {"q": q},
    {"T": pose_matrix(m, p, stand(p)[0])},
    program=p,
    equation="T",
    source="eq. (9) and its frames",
    notes=(too_wide,),
)
d.function(
    "arm_tips",
    "Tips of the right and of the left fore-arm.",
    {"q": q},
    {"tips": sp.Matrix.hstack(*tips).T},
    equation="T_{RL}",
    source="eqs. (1) and (2)",
)
p = Program()
here, _ = stand(p)
length = sqrt(wrist_squared(m, m.d / cos(psi)))
draw(
    d,
    m,
    q,
    p,
    here,
    posture=posture._replace(wrist=length),
    tip=T.subs(wrist, length),
    arms={"right": (theta2A + alpha, theta23A + beta), "left": (theta2A - alpha, theta23A - beta)},
    closed=False,
    notes=(
        too_wide,
        "The links of the wrist start on its base line, which joins the tips of the arms only "
        "where the arms are parallel: the published model does not close the loop.",
    ),
)
p = Program()
mid_arm = reach(m, *averages(p), m.L2, m.a3)
d.function(
    "invariant_point",
    "The invariant point, computed from the averages of the angles.",
    {"q": q},
    {"p": in_space(m, pair(theta1), mid_arm, sp.S.Zero)},
    program=p,
    source="eq. (7)",
)

# Velocity

outer = outer_jacobian(m, q, m.d / cos(psi), wrist)
by_half = sp.Matrix([means[s] for s in (mu2, mu23, alpha, beta)]).jacobian(q)
gap = real("ahead"), real("higher")
side2A, side23A = real("side2A"), real("side23A")
inner = sp.zeros(6)
inner[0, 0] = inner[5, 5] = sp.S.One
inner[1:3, :] = by_half[:2, :]
for k in (0, 1):
    inner[3 + k, :] = atan2(gap[k], m.d).diff(gap[k]) * apart[k, :].jacobian(q)
by_right = arm(m, theta2R, theta2R + theta3R).jacobian([theta2R, theta3R])
by_left = arm(m, theta2L, theta2L + theta3L).jacobian([theta2L, theta3L])
d.explain(TIP_RATES)
slopes = sp.diag(*(1 / (m.d**2 + e**2) for e in gap))
aside, along, across = extended(m, posture)
outward = reach(m, posture.upper, posture.fore, along, across)[0]


with_wrist = straight(along, across, posture.upper, posture.fore)
without = straight(m.L2, m.a3, pair(mu2), pair(mu23))
area = sp.Matrix([mean[0], mean[1]]).jacobian([alpha, beta]).det()
factors_of, position = factors_shown(d, m, q, m.d / cos(psi), wrist)
d.step(
    "Jacobian by the chain rule",
    "The task depends on the joints through theta1, the averages, yaw, roll and pitch.  The outer "
    "factor is the derivative of the task with respect to these quantities, and the inner factor "
    "is their derivative with respect to the joints.",
    {
        **factors_of,
        "V": by_half[:2, 1:5],
        "W": r"\frac{d}{2} \begin{bmatrix} \frac{1}{d^2 + \Delta_a^2} & 0 \\[6pt] "
        r"0 & \frac{1}{d^2 + \Delta_h^2} \end{bmatrix} "
        r"\begin{bmatrix} A_R & -A_L \end{bmatrix}",
        "A_R": by_right,
        "A_L": by_left,
    },
    proves=(
        "The first three rows of the outer factor and W are as stated.  The determinant of J "
        "is the product of three: that of the virtual arm with the wrist, that of the rates of "
        "yaw and roll, and 1/4 for the averages and half differences."
    ),
    equal=[
        (outer[:3, :], position),
        (inner[3:5, 1:5], m.d / 2 * slopes * sp.Matrix.hstack(by_right, -by_left)),
        (outer[:3, :3].det(), m.L1 * outward * with_wrist),
        (area, -m.L1 * without * cos(alpha) * cos(beta)),
        (by_half[:, 1:5].det(), Rational(1, 4)),
    ],
)


def turn_rates(here: Posture) -> sp.Expr:
    """d(psi, phi) / d(ahead, above), as a determinant."""
    return here.yaw.c**2 * here.roll.c**2 / m.d**2


def factors(here: Posture) -> list[sp.Expr]:
    aside, along, across = extended(m, here)
    del aside
    return [
        reach(m, here.upper, here.fore, along, across)[0],
        straight(along, across, here.upper, here.fore),
        straight(m.L2, m.a3, here.upper, here.fore),
        side2A * cos(shoulder_half),
        side23A * cos(fore_half),
        here.wrist,
    ]


p = Program()
here, _ = stand(p)
J = p.matrix("outer", named(outer, here, q).xreplace({wrist: here.wrist})) * p.matrix(
    "inner", inner
)
d.function(
    "jacobian",
    "Derivative of the task with respect to the joints.",
    {"q": q},
    {"J": J},
    program=p,
    equation="J",
    source="derivative of eqs. (1) to (9)",
    notes=(too_wide, STEEP),
)
p = Program()
here, _ = stand(p)
f = factors(here)
d.function(
    "determinant",
    "Determinant of the Jacobian.",
    {"q": q},
    {"det": -(m.L1**2) * f[0] * f[1] * f[2] * f[3] * f[4] * turn_rates(here) / 4},
    program=p,
    notes=(too_wide,),
)
p = Program()
here, _ = stand(p)
d.function(
    "singularities",
    "The factors of the determinant, and the length of the wrist.",
    {"q": q},
    {"factors": factors(here)},
    program=p,
    notes=(too_wide,),
)

# Inverse

turn_step(d, m)
as_published(d, m)
p = Program()
length, base = wrist_given(p, m, cos(psi))
p.determined(length, m.al, "the wrist links are stretched")
tangents = p.let("t_psi", sin(psi) / cos(psi)), p.let("t_phi", sin(phi) / cos(phi))
gap = p.let("ahead", m.d * tangents[0]), p.let("higher", m.d * tangents[1])
apart_by = sum(sp.Abs(g * t) for g, t in zip(gap, tangents, strict=True))
slack, beside = allowances(p, m, length, apart_by, gap)
middle = solve_mid_plane(p, m, q, (length, base), slack=slack, gap=gap)
upper, elbow = middle.upper, middle.elbow
# in the axes of the upper arm: there sin(alpha) multiplies (0, L1)
seen = (
    p.let("p_1", upper.c * gap[0] + upper.s * gap[1]),
    p.let("p_2", upper.c * gap[1] - upper.s * gap[0]),
)
v = p.let("v_1", m.L2 * elbow.c - m.a3 * elbow.s), p.let("v_2", m.L2 * elbow.s + m.a3 * elbow.c)
free, waist_rate = with_waist(free_turn(p, m, elbow, slack), upper, middle.outward)
fore_size = p.let("fore_size", sqrt(m.L2**2 + m.a3**2), nonnegative=True)
# in exact arithmetic all these turns are zero
turns, fore_turns, upper_turns, before = [], [], [], len(p.body)
for sine in ("alpha", "beta"):
    # by Cramer's rule sin(alpha) = (p x v) / (u x v) and sin(beta) = (u x p) / (u x v)
    aligned = v[0] * seen[0] + v[1] * seen[1]
    part, rate, seen_rate = {
        "alpha": (v[0] * seen[1] - v[1] * seen[0], -aligned, sp.S.Zero),
        "beta": (m.L1 * seen[0], (m.L1 - free.drawn) * seen[1], seen[1]),
    }[sine]
    whole = p.let(f"whole_{sine}", m.L1 * v[0])
    part = p.let(f"part_{sine}", part)
    to_whole, to_part = map(sign_of, (whole, part))
    margin = p.let(f"margin_{sine}", to_whole * whole - to_part * part)
    aside = p.let(f"slope_aside_{sine}", m.L1 * (to_whole * v[1] - to_part * seen_rate))
    by_fore = -to_whole * free.drawn * v[1] - to_part * rate
    slopes = p.let(f"slope_{sine}", free.fore * by_fore + free.aside * aside), aside
    size = (fore_size if sine == "alpha" else m.L1) * beside
    corrected = free.correction(sine, margin, slopes, size, "a sine is at most 1")
    spent = corrected.spent
    turn = p.let(f"turn_{sine}", choose(spent, corrected.linear_turn(), 0))
    p.determined(
        choose(spent, 1 - corrected.strain(turn), 1),
        1,
        f"no small turn keeps sin({sine}) at most 1",
    )
    upper_turn = p.let(f"lean_{sine}", choose(spent, free.upper_turn(turn, corrected.aside), 0))
    fore_turn = p.let(f"fore_turn_{sine}", choose(spent, free.fore * turn, 0))
    back, on = turned_by(upper_turn), turned_by(fore_turn)
    ahead = on - back
    v, seen = (
        tuple(
            p.let(
                f"{name}_{k + 1}_{sine}", choose(spent, by.c * e[k] + side * by.s * e[1 - k], e[k])
            )
            for k, side in ((0, -1), (1, 1))
        )
        for name, e, by in (("v", v, ahead), ("p", seen, -back))
    )
    turns.append(turn)
    fore_turns.append(fore_turn)
    upper_turns.append(upper_turn)
for k in (1, 2):
    d.write(f"p_{k}_beta", rf"\hat p_{k}", "gap of the tips, in the axes of the virtual upper arm")
    d.write(f"v_{k}_beta", rf"\hat v_{k}", "virtual fore-arm, in the axes of the virtual upper arm")
# the turns that meet each limit alone miss both together by a little; the status says so
at_limits = sp.Or(sp.Symbol("spent_alpha"), sp.Symbol("spent_beta"))
half = two_sines(
    p,
    (alpha, beta),
    ((sp.S.Zero, m.L1), v),
    seen,
    scale=beside,
    free=(theta3R, theta3L),
    leniency=choose(at_limits, free.leniency, 1),
).implying([s.symbol for s in p.body[before:] if isinstance(s, Bound)])
# near a right angle, sines at their limits may miss the gap by more than yaw and roll allow
at_limit = sp.Or(*(sp.Symbol(f"spent_{n}") for n in ("alpha", "beta", "along")))
sines = [next(s for s, e in half.means.items() if e == sin(x)) for x in (alpha, beta)]
missed = v[0] * sines[1] - seen[0], m.L1 * sines[0] + v[1] * sines[1] - seen[1]
missed = p.let("missed", choose(at_limit, sum(map(sp.Abs, missed)), 0))
# what is missed turns yaw and roll, and moves the tip more if the wrist links are nearly stretched
turning = (1 + sp.Min(*(t**2 for t in tangents))) * sp.Max(m.d, sum(m) / 64)
allowed = sp.Min(turning, sum(m) * length / m.al)
p.determined(
    choose(at_limit, allowed, 1), missed * 2**50, "sines at their limits miss the gap of the tips"
)
report_short_wrist(p, m, sp.Or(at_limit, sp.Symbol("tangent")))
lemmas = (*middle.lemmas, half)
solution = {s: e for lemma in lemmas for s, e in lemma.solution.items()}


def together(first: sp.Expr, second: sp.Expr) -> sp.Expr:
    """The angle of two small turns after each other, from their tangents."""
    return atan2(first + second, 1 - first * second)


turned_halves = {
    mu2: theta2A + together(*upper_turns),
    mu23: theta23A + together(*fore_turns),
}
waist_turn = p.let("waist_turn", choose(at_limit, waist_rate * sum(turns), 0))
joints = {theta1: theta1 + atan2(waist_turn, sp.S.One), theta: theta} | {
    s: halves[s].xreplace(turned_halves) for s in (theta2R, theta3R, theta2L, theta3L)
}
from_upper = sp.Matrix([[cos(theta2A), -sin(theta2A)], [sin(theta2A), cos(theta2A)]])
sides = branches(WAIST, ELBOW)
d.branches = sides.labels
d.function(
    "ik",
    "All postures of the published model that reach a tip.",
    {"x": target},
    {"q": [joints[s].xreplace(solution) for s in q]},
    program=p,
    branches=sides,
    result="Solutions",
    source="eqs. (11), (13) and (14), with the exact half differences",
    notes=(
        "UNREACHABLE: the wrist links are too short for the yaw, the tip is nearer to the waist "
        "axis than L_theta, the virtual arm cannot reach the tip, or the tips of the arms cannot "
        "be so far apart.",
        "SINGULAR: x = y = 0 with L_theta = 0 (theta1 = 0 is returned); the tip of the virtual arm "
        "with the wrist is on its shoulder (a horizontal upper arm is returned); or the virtual "
        "arm without the wrist is straight or folded.  In the last case yaw and roll determine "
        "only the sum of L1 sin(alpha) and f sin(beta) (straight) or their difference (folded); "
        "alpha and beta are half the differences of the arms' angles, and sines of equal size are "
        "returned.",
        "SINGULAR also if the wrist links are nearly stretched (l_W is less than 2^-10 al): "
        "rounded joints do not determine the tip to 1e-12 there; or if a half difference is at a "
        "right angle, or the waist is tangent, and rounding of the target decides whether the arms "
        "reach it.",
        ACCURACY,
        "INVALID: d, L1, or both L2 and a3 are zero.",
    ),
)
targets, forward = tip_system(m, q, cos(psi))
d.inverses.append(
    Inverse(
        "ik",
        tuple(q),
        (*targets, tan(psi), tan(phi)),
        (*forward, *(apart / m.d)),
        angles=(psi, phi, pitch),
        images="fk",
        condition=amplification(m),
        links=tuple(map(Link.of, lemmas)),
        glue=Combination(sp.diag(MID_PLANE_ROWS, from_upper / m.d), joints),
    )
)
design(d, m, cos(psi))

# Claims of the paper

state(d, m, q)
