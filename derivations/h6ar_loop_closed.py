"""The H6AR with a loop that closes: the wrist spans the tips of the arms."""

import sympy as sp
from closedform.derivations.h6ar_free_turn import free_turn, moved_by, turn_step
from closedform.derivations.h6ar_jacobian import factors_shown, loop_factors
from closedform.derivations.h6ar_mechanism import (
    ACCURACY,
    BOTH_TIPS,
    ELBOW,
    L_2W,
    MID_PLANE_ROWS,
    STEEP,
    WAIST,
    Pair,
    Posture,
    a_3W,
    allowances,
    amplification,
    arm,
    by_half_sums,
    declare,
    design,
    extended,
    half_gap,
    half_sums,
    half_sums_step,
    in_space,
    midpoint,
    named,
    outer_jacobian,
    pair,
    phi,
    pitch,
    pose_matrix,
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
)
from closedform.derivations.h6ar_skeleton import draw
from closedform.derivations.h6ar_tip import bent_step, tip_step
from closedform.derivations.papers.rao_raju import RAO_RAJU
from sympy import Rational, atan2, cos, sin, sqrt, tan

from closedform import (
    Bound,
    Combination,
    Derivation,
    Inverse,
    Link,
    Program,
    Solved,
    branches,
    choose,
    elbow_squares,
    real,
    rotation,
    sign_of,
    two_link_arm_beside,
)

d = Derivation(
    "h6ar_loop_closed",
    "H6AR, loop-closed model",
    RAO_RAJU,
    "A waist carries two equal arms of two links, each at the distance d from the mid-plane.  "
    "Their tips carry a wrist of two links and a gear set, which yaws (psi) and rolls (phi) as the "
    "arms move apart, and an actuator for the pitch (theta).  In this model the loop closes: the "
    "base line of the wrist joins the tips, and the invariant point is its middle.  A virtual arm "
    "in the mid-plane, bent to the same side as the right arm, reaches that point.  Yaw and roll "
    "are measured against the virtual fore-arm; as in (9), the right tip goes down if the roll is "
    "positive.",
    task=["x", "y", "z", "psi", "phi", "theta"],
    singularities=(
        "the tip is above or below the waist axis",
        "virtual arm with the wrist straight or folded",
        "right arm straight or folded",
        "left arm straight or folded",
        "virtual arm straight or folded (a pole of the determinant)",
        "wrist links stretched along the base line",
    ),
    poles=(
        "virtual arm straight or folded (a pole of the determinant)",
        "wrist links stretched along the base line",
    ),
)
m, q = declare(d)
d.explain({"b": "half the base line of the wrist", "R_I": "reach of the virtual arm"})
d.explain({f"p_{k}": "coordinate of the invariant point" for k in (1, 2, 3)})
theta1, theta2R, theta3R, theta2L, theta3L, theta = q
theta23R, theta23L = real("theta23R"), real("theta23L")
lengths = (m.L1, m.L2, m.a3)
forearm_length = sqrt(m.L2**2 + m.a3**2)

# The tips, in the axes of the virtual fore-arm

right, left = arm(m, theta2R, theta2R + theta3R), arm(m, theta2L, theta2L + theta3L)
middle, apart = (right + left) / 2, (right - left) / 2
means, halves = half_sums(q), by_half_sums(q)
midway, gap_half = (e(m).subs(means, simultaneous=True) for e in (midpoint, half_gap))
tips = [in_space(m, pair(theta1), planar, side) for planar, side in ((right, m.d), (left, -m.d))]
half_sums_step(d, q)
d.step(
    "Middle and distance of the tips",
    "Each tip is the end of an arm of two links.  The middle of the tips and half their difference "
    "follow from the half sums and half differences of the angles.",
    {
        "(r, h)_R": right,
        "(r, h)_L": left,
        "(x, y, z)_R": tips[0],
        "(x, y, z)_L": tips[1],
        "T_{RL}": BOTH_TIPS,
        "(r, h)_I": midpoint(m),
        r"(\Delta_a, \Delta_h)": half_gap(m),
    },
    published=("(6)",),
    proves="The middle and half the difference of the tips are as stated, in terms of the half "
    "sums and half differences of the angles.",
    equal=[(middle.xreplace(halves), midpoint(m)), (apart.xreplace(halves), half_gap(m))],
)
ahead, higher = real("ahead"), real("higher")
c23, s23 = cos(theta23A), sin(theta23A)
across_fore, along_fore = c23 * ahead + s23 * higher, s23 * ahead - c23 * higher
line = sp.Matrix([across_fore, m.d, along_fore])  # half of it, right minus middle, in fore-arm axes
forearm = sp.Matrix([[c23, 0, s23], [0, -1, 0], [s23, 0, -c23]])  # R03 for theta1 = 0
base = m.d / (cos(psi) * cos(phi))
wrist_line = base * rotation("z", phi) * rotation("x", psi) * sp.Matrix([0, 1, 0])
d.step(
    "Base line in the axes of the fore-arm",
    "The line from the middle of the tips to the right tip is half the base line.  Here it is "
    "given in the axes of the virtual fore-arm: x (upwards at home), y (to the right) and z (along "
    "it).",
    {r"R_{03}^T (p_R - p_I)": line},
    published=("(3)", "(4)", "(5)", "(6)"),
    proves="Half the base line, turned into the axes of the virtual fore-arm, has these "
    "coordinates.",
    equal=[(forearm.T * sp.Matrix([ahead, -m.d, higher]), line)],
)
half_line = sp.Matrix([-m.d * tan(phi), m.d, m.d * tan(psi) / cos(phi)])
leaning = d.step(
    "Yaw and roll from the tips",
    "The base line of the wrist is along the y axis after roll and yaw, R_z(phi) R_x(psi) e_y.  "
    "Half of it, of length b, has the component d across the mid-plane.  So b is "
    "d / (cos(psi) cos(phi)), which replaces d / cos(psi) in (8).  The other components give "
    "tan(phi) = -Delta_x / d and tan(psi) = cos(phi) Delta_z / d.",
    {r"b\,R_z(\phi) R_x(\psi)\,\mathbf e_y": half_line},
    published=("(3)", "(4)", "(8)"),
    proves="The turned y axis times half the base line has the components -d tan(phi), d and d "
    "tan(psi)/cos(phi).",
    equal=[(wrist_line, sp.Matrix([-m.d * tan(phi), m.d, m.d * tan(psi) / cos(phi)]))],
)
d.given_by |= {"psi": leaning, "phi": leaning}
axis = rotation("z", phi) * rotation("x", psi)
length = real("wrist", positive=True)
link = axis * sp.Matrix([0, m.gs, length]) - wrist_line
other = axis * sp.Matrix([0, -m.gs, length]) + wrist_line
d.step(
    "Four-bar of the wrist",
    "The gears are at the distance gs beside the axis of the wrist and l_W along it.  A wrist "
    "link joins each gear to its tip.  The length of both links is al if l_W^2 = al^2 - (b - "
    "gs)^2.",
    {"b": base, "l_W^2": m.al**2 - (real("b") - m.gs) ** 2},
    published=("(8)",),
    proves="Both wrist links have the square of their length l_W^2 + (b - gs)^2.",
    equal=[
        (link.dot(link), length**2 + (base - m.gs) ** 2),
        (other.dot(other), link.dot(link)),
    ],
)
tip_step(d, m, q, length, base)
given_ahead = m.d * (s23 * tan(psi) / cos(phi) - c23 * tan(phi))
given_higher = -m.d * (c23 * tan(psi) / cos(phi) + s23 * tan(phi))
d.step(
    "Tips from yaw and roll",
    "Conversely, yaw, roll and the direction of the virtual fore-arm give the distance of the "
    "tips.  So each arm has to reach a known point as a two-link arm.  Both are solved alike but "
    "for the bend: the right arm is bent as the virtual one, and the left one to either side.",
    {r"\Delta_a": given_ahead, r"\Delta_h": given_higher},
    proves="With these distances the base line is the one that yaw and roll give.",
    equal=[
        (line.subs({ahead: given_ahead, higher: given_higher}), wrist_line),
    ],
    solves={"ik": [theta2R, theta2L]},
)
bent_step(d, m, q, (right, left))
beyond, width = real("beyond"), real("width")
half_line = sqrt(m.d**2 + width**2 + beyond**2)
cosine_roll = m.d / sqrt(m.d**2 + width**2)
d.step(
    "Yaw without its angle",
    "The forward map computes the cosines and sines of yaw and roll directly from the tips, and "
    "needs the angles only as outputs.  Half the base line is half the distance of the tips.",
    {
        r"\cos\phi": cosine_roll,
        r"\cos\psi": sqrt(m.d**2 + width**2) / half_line,
        "b": half_line,
    },
    proves="The cosines of roll and yaw are these quotients, and half the base line is d/(cos(phi) "
    "cos(psi)).",
    equal=[
        (cos(atan2(-width, m.d)), cosine_roll),
        (cos(atan2(cosine_roll * beyond, m.d)), sqrt(m.d**2 + width**2) / half_line),
        (
            m.d / (cos(atan2(-width, m.d)) * cos(atan2(cosine_roll * beyond, m.d))),
            half_line,
        ),
    ],
)


def stand(p: Program, function: str) -> Posture:
    """The posture, from the middle of the tips and the virtual arm, in a function."""
    second = p.let("fore", forearm_length, nonnegative=True)
    squares, bent = {}, {}
    for name, angle in (("right", theta3R), ("left", theta3L)):
        squares[name], bent[name] = elbow_squares(
            p, lengths, second, pair(angle), suffix=f"_{name}"
        )
    side = p.let("sigma_side", sign_of(bent["right"]))
    point = tuple(p.let(n, e) for n, e in zip(("r_I", "h_I"), midway, strict=True))
    p.let("ahead", gap_half[0])
    p.let("higher", gap_half[1])
    gap = p.let("gap", ahead**2 + higher**2)
    mean = [(a + b) / 2 for a, b in zip(squares["right"], squares["left"], strict=True)]
    virtual = two_link_arm_beside(
        p,
        lengths,
        point,
        (theta2A, theta23A),
        side,
        second=second,
        squares=(mean[0] + gap, mean[1] - gap),
        scale=m.d,
        suffix="_virtual",
        rest=pair(theta2R),
    )
    d.solved.append(Solved(function, theta2A, virtual, virtual.equations[0]))
    upper, fore = (virtual.pair(angle) for angle in (theta2A, theta23A))
    seen = {cos(theta23A): fore.c, sin(theta23A): fore.s}
    p.let("width", across_fore.xreplace(seen))
    p.let("beyond", along_fore.xreplace(seen))
    tilted = p.let("tilted", sqrt(m.d**2 + width**2), nonnegative=True)
    half = p.let("base", sqrt(m.d**2 + ahead**2 + higher**2), nonnegative=True)
    yaw = Pair(c=p.let("c_psi", tilted / half), s=p.let("s_psi", beyond / half))
    roll = Pair(c=p.let("c_phi", m.d / tilted), s=p.let("s_phi", -width / tilted))
    wrist = wrist_let(p, m, half)
    return Posture(pair(theta1), upper, fore, yaw, roll, pitch=pair(theta), wrist=wrist, base=half)


p = Program()
here = stand(p, "fk")
fk = [*tip(m, here), *(atan2(a.s, a.c) for a in (here.yaw, here.roll)), turned(theta)]
notes = (
    "NaN if the tips are farther apart than the wrist links can span, or if the virtual arm cannot "
    "reach the middle of the tips.",
    "Ill-conditioned if the virtual arm is nearly straight: yaw and roll are measured against its "
    "fore-arm.",
)
d.function(
    "fk",
    "Position of the tip, and yaw, roll and pitch.",
    {"q": q},
    {"x": fk},
    program=p,
    source="eqs. (1), (2), (6) and (9), with the closed loop",
    notes=notes,
)
p = Program()
d.function(
    "pose",
    "Pose of the tip: turned as the fore-arm, then by phi about z, psi about x, theta about y.",
    {"q": q},
    {"T": pose_matrix(m, p, stand(p, "pose"))},
    program=p,
    equation="T",
    source="eq. (9) and its frames",
    notes=notes,
)
p = Program()
closed = sqrt(m.al**2 - (base - m.gs) ** 2)
angles = Posture(*map(pair, (theta1, theta2A, theta23A, psi, phi, theta)), closed, base)
draw(
    d,
    m,
    q,
    p,
    stand(p, "skeleton"),
    posture=angles,
    tip=tip(m, angles),
    arms={"right": (theta2R, theta2R + theta3R), "left": (theta2L, theta2L + theta3L)},
    closed=True,
    notes=notes,
)
d.function(
    "arm_tips",
    "Tips of the right and of the left fore-arm.",
    {"q": q},
    {"tips": sp.Matrix.hstack(*tips).T},
    equation="T_{RL}",
    source="eqs. (1) and (2)",
)
d.function(
    "invariant_point",
    "The invariant point, the middle of the tips.",
    {"q": q},
    {"p": in_space(m, pair(theta1), midway, sp.S.Zero)},
    source="eq. (6)",
)

# Velocity

reclined = sqrt(m.d**2 + width**2)
by_line = sp.Matrix([atan2(beyond, reclined), atan2(-width, m.d)]).jacobian([width, beyond])
line_by = sp.Matrix([across_fore, along_fore]).jacobian([ahead, higher, theta23A])
point_by = arm(m, theta2A, theta23A).jacobian([theta2A, theta23A])
outer = outer_jacobian(m, q, base, length)
without = straight(m.L2, m.a3, pair(theta2A), pair(theta23A))
posture = Posture(*map(pair, (theta1, theta2A, theta23A, psi, phi, theta)), length, base)
_, along, across = extended(m, posture)
with_wrist = straight(along, across, posture.upper, posture.fore)
outward = reach(m, pair(theta2A), pair(theta23A), along, across)[0]
by_right = arm(m, theta2R, theta2R + theta3R).jacobian([theta2R, theta3R])
by_left = arm(m, theta2L, theta2L + theta3L).jacobian([theta2L, theta3L])
factors_of, position = factors_shown(d, m, q, base, length)
d.step(
    "Jacobian by the chain rule",
    "The task depends on the joints through theta1, the virtual arm, yaw, roll and pitch.  The "
    "virtual arm follows the middle of the tips by the inverse of its own Jacobian.  Yaw and roll "
    "follow the base line in the axes of the virtual fore-arm.  The determinant is the product of "
    "the determinants of the factors: those of both real arms are in the numerator, that of the "
    "virtual arm is in the denominator.",
    factors_of | loop_factors(d, point_by, (by_right, by_left), by_line, line_by),
    proves="The first three rows of J_o, the rates of the tips, and the determinant of each "
    "factor: the outer one, those of the virtual and of the real arms, and those of yaw and roll.",
    equal=[
        (outer[:3, :], position),
        (middle.jacobian(q[1:5]), sp.Matrix.hstack(by_right, by_left) / 2),
        (apart.jacobian(q[1:5]), sp.Matrix.hstack(by_right, -by_left) / 2),
        (outer[:3, :3].det(), m.L1 * outward * with_wrist),
        (point_by.det(), -m.L1 * without),
        (by_right.det(), -m.L1 * straight(m.L2, m.a3, pair(theta2R), pair(q[1] + q[2]))),
        (line_by[:, :2].det(), -sp.S.One),
        (
            by_line.det(),
            m.d / (sqrt(m.d**2 + width**2) * half_line**2),
        ),
    ],
)


def bend_of(p: Posture) -> tuple[sp.Expr, sp.Expr]:
    """Distance of the tip from the waist axis, and the bend of the virtual arm with the wrist."""
    _, along, across = extended(m, p)
    return reach(m, p.upper, p.fore, along, across)[0], straight(along, across, p.upper, p.fore)


def factors(here: Posture) -> list[sp.Expr]:
    return [
        *bend_of(here),
        straight(m.L2, m.a3, pair(theta2R), pair(theta2R + theta3R)),
        straight(m.L2, m.a3, pair(theta2L), pair(theta2L + theta3L)),
        straight(m.L2, m.a3, here.upper, here.fore),
        here.wrist,
    ]


p = Program()
here = stand(p, "jacobian")
tilted = real("tilted", nonnegative=True)
by_virtual = p.matrix("virtual", named(point_by.adjugate(), here, q))
mid_rates = p.matrix("mid", middle.jacobian(q))
bend = p.let("slack", -m.L1 * straight(m.L2, m.a3, here.upper, here.fore))
virtual_rates = p.matrix("rate", (by_virtual * mid_rates) / bend)
gap_rates = p.matrix("gap", apart.jacobian(q))
line_rates = p.matrix(
    "line", named(line_by, here, q) * sp.Matrix.vstack(gap_rates, virtual_rates[1, :])
)
by_names = by_line.subs(reclined, tilted).subs(m.d**2 + width**2, tilted**2)
turn_rates = p.matrix("turn", by_names) * line_rates
inner = sp.zeros(6)
inner[0, 0] = inner[5, 5] = sp.S.One
inner[1:3, :], inner[3:5, :] = virtual_rates, turn_rates
outer_rates = named(outer, here, q).xreplace({length: here.wrist})
J = p.matrix("outer", outer_rates) * p.matrix("inner", inner)
d.function(
    "jacobian",
    "Derivative of the task with respect to the joints.",
    {"q": q},
    {"J": J},
    program=p,
    equation="J",
    notes=(*notes, STEEP),
)
p = Program()
here = stand(p, "determinant")
f = factors(here)
turning = m.d / (tilted * here.base**2)
d.function(
    "determinant",
    "Determinant of the Jacobian; it has a pole if the virtual arm is straight or folded.",
    {"q": q},
    {"det": m.L1**2 * Rational(1, 4) * f[0] * f[1] * f[2] * f[3] * turning / f[4]},
    program=p,
    notes=notes,
)
p = Program()
here = stand(p, "singularities")
d.function(
    "singularities",
    "The factors of the determinant, its pole, and the length of the wrist.",
    {"q": q},
    {"factors": factors(here)},
    program=p,
    notes=notes,
)

# Inverse

turn_step(d, m)
sigma_left = real("sigma_left")
d.write(sigma_left, r"\sigma_{\mathrm{alike}}")
d.write("point_11", "r_I", "distance of the middle of the tips from the waist axis")
d.write("point_21", "h_I", "height of the middle of the tips above the shoulders")
d.write("shift_11", r"\Delta_a", same="ahead")
d.write("shift_21", r"\Delta_h", same="higher")
LEFT = (sigma_left, {+1: "alike", -1: "mixed"})
p = Program()
wrist, half_base = wrist_given(p, m, cos(psi) * cos(phi))
tangents = [p.let(f"t_{e.name}", sin(e) / cos(e)) for e in (psi, phi)]
slack, beside = allowances(p, m, wrist, sum(sp.Abs(half_base * t) for t in tangents))
mid = solve_mid_plane(p, m, q, (wrist, half_base), slack=slack)
upper, fore = mid.upper, mid.fore
second = p.let("fore_arm", forearm_length, nonnegative=True)
(N, M), bent = elbow_squares(p, lengths, second, mid.elbow, suffix="_mid")
straight_mid = m.L2 * mid.elbow.s + m.a3 * mid.elbow.c
by_pairs = {cos(theta23A): fore.c, sin(theta23A): fore.s}
by_pairs |= {tan(e): t for e, t in zip((psi, phi), tangents, strict=True)}
point = p.matrix("point", reach(m, upper, fore, m.L2, m.a3))
shift = p.matrix("shift", sp.Matrix([given_ahead, given_higher]).xreplace(by_pairs))
gap = p.let("gap", shift.dot(shift))
cross = p.let("twice", 2 * point.dot(shift))

# The middle of the tips determines the virtual arm, unless it is nearly folded or ends close to the
# shoulder; the distance of the tips determines the length of the wrist.
size = p.let("size", m.L1 + second)
square = p.let("square_mid", M + (m.L1 - second) ** 2)
# the roll has d for a scale, and its promised error grows with the sum of all lengths over d
over = p.let("over", sp.Max(64 * m.d, sum(m)))
p.determined(M * square * over**2, 4096 * gap * size**4, "the virtual arm is folded", squares=True)
p.determined(square, size**2, "the virtual arm has no length", squares=True)
p.determined(wrist, m.al, "the wrist links are stretched")
free = free_turn(p, m, mid.elbow, slack)
ends, squares, corrections, before = {}, {}, [], len(p.body)
for name, sign in (("right", 1), ("left", -1)):
    r, h = (p.let(f"{c}_{name}_0", point[k] + sign * shift[k]) for k, c in enumerate("rh"))
    ends[name] = r, h
    square = r**2 + h**2
    beside_shoulder = size**2 * square < gap**2
    folding = sp.Piecewise(
        (square - (m.L1 - second) ** 2, beside_shoulder), (M + sign * cross + gap, True)
    )
    nearer = p.let(f"nearer_{name}", N - sign * cross - gap)
    farther = p.let(f"farther_{name}", folding)
    squares[name] = nearer, farther
    margin = p.let(f"margin_{name}", sp.Min(nearer, farther))
    # the free turn changes the square of the reach, and the two margins in opposite directions
    sense = sp.Piecewise((1, nearer <= farther), (-1, True))
    across = h * upper.c - r * upper.s
    slopes = (
        p.let(f"slope_{name}", sense * 2 * free.drawn * across),
        p.let(f"slope_aside_{name}", -sense * 2 * m.L1 * across),
    )
    onward = r * upper.c + h * upper.s - m.L1
    curve = p.let(f"curve_{name}", sense * onward * free.drawn**2 / m.L1)
    corrected = free.correction(name, margin, slopes, size * beside, "the arm is long enough")
    corrections.append((corrected, curve))
spent = sp.Or(*(e.spent for e, _ in corrections))
turn = free.turn("both", corrections)
more, less = (e.aside for e, _ in corrections)
aside = sp.Piecewise((more, sp.Abs(more) >= sp.Abs(less)), (less, True))
lean = p.let("lean", choose(spent, free.upper_turn(turn, aside), 0))
bent = p.let(
    "bent_then", choose(spent, bent * (1 + turn * lean) + straight_mid * (turn - lean), bent)
)
side = p.let("sigma_right", sign_of(bent))
opposite = p.let("sigma_other", side * sigma_left)
elbow = p.matrix("elbow", m.L1 * upper.unit)
swing = p.matrix("swing", moved_by(lean, elbow))
limits = [s.symbol for s in p.body[before:] if isinstance(s, Bound)]
arms = []
for name, sigma, unknowns in (
    ("right", side, (theta2R, theta23R)),
    ("left", opposite, (theta2L, theta23L)),
):
    end = sp.Matrix(ends[name])
    more = p.matrix(f"more_{name}", swing + moved_by(turn, end - elbow))
    change = p.let(f"change_{name}", choose(spent, more.dot(2 * end + more), 0))
    end = tuple(
        p.let(f"{c}_{name}", choose(spent, e + by, e))
        for c, e, by in zip("rh", end, more, strict=True)
    )
    arms.append(
        two_link_arm_beside(
            p,
            lengths,
            end,
            unknowns,
            sigma,
            second=second,
            squares=(squares[name][0] - change, squares[name][1] + change),
            scale=beside,
            suffix=f"_{name}",
            sided=name == "right",
            free=unknowns[:1],
            rest=upper,
        )
    )
# an arm at its limit may bend to the other side, and then the wrist points elsewhere
kept = [real(f"{k}_{name}", nonnegative=True) for k in "NM" for name in ("right", "left")]
N, M = (kept[0] + kept[1]) / 2 + gap, (kept[2] + kept[3]) / 2 - gap
bends = 2 * m.L1 * bent - side * sqrt(sp.Max(0, N)) * sqrt(sp.Max(0, M))
aside = (sp.Abs(L_2W - m.L2) + sp.Abs(a_3W - m.a3)) * sp.Abs(bends)
p.determined(
    choose(spent, m.L1 * second * sum(m), 1),
    p.let("astray", choose(spent, aside * 2**50, 0)),
    "arms at their limits do not bend as the virtual arm",
)
lemmas = (*mid.lemmas, arms[0].implying(limits), arms[1])
joints = {s: s for s in q} | {theta3R: theta23R - theta2R, theta3L: theta23L - theta2L}
solution = {s: e for lemma in lemmas for s, e in lemma.solution.items()}
sides = branches(WAIST, ELBOW, LEFT)
d.branches = sides.labels
d.function(
    "ik",
    "All postures of the mechanism that reach a tip; in a mixed one the elbows are on opposite "
    "sides.",
    {"x": target},
    {"q": [joints[s].xreplace(solution) for s in q]},
    program=p,
    branches=sides,
    result="Solutions",
    source="eqs. (11), (13) and (14), then each arm separately",
    notes=(
        "UNREACHABLE: the wrist links are too short for yaw and roll, the tip is nearer to the "
        "waist axis than L_theta, or an arm cannot reach its tip.",
        "SINGULAR: x = y = 0 with L_theta = 0 (theta1 = 0 is returned), or the tip of an arm on "
        "its own shoulder (its upper arm is returned parallel to that of the virtual arm).",
        "SINGULAR also if rounded joints do not determine the tip, yaw and roll to 1e-12: near a "
        "folded virtual arm (its reach times its bend times d is less than 2^-10 of the square of "
        "its size times half the distance of the tips; if d is less than 1/64 of the sum of all "
        "lengths, that replaces d), with a virtual arm shorter than 2^-10 of a stretched one, and "
        "where the wrist links are nearly stretched (l_W is less than 2^-10 al).  A posture is "
        "SINGULAR too if an arm is at its limit and rounding bends it to the other side than the "
        "virtual arm.",
        ACCURACY,
        "INVALID: d, L1, or both L2 and a3 are zero.",
        "If the right arm is straight, it is returned bent by a few units in the last place, so "
        "that fk can tell the side.",
    ),
)
half_row = Rational(1, 2)
closure = sp.Matrix([[half_row, 0, half_row, 0], [0, half_row, 0, half_row]])
difference = sp.Matrix([[half_row, 0, -half_row, 0], [0, half_row, 0, -half_row]])
turned_line = sp.Matrix([[s23, -c23], [-c23, -s23]]) / m.d
targets, forward = tip_system(m, q, cos(psi) * cos(phi))
d.inverses.append(
    Inverse(
        "ik",
        tuple(q),
        (*targets, 0, 0, tan(psi) / cos(phi), tan(phi)),
        (
            *forward,
            *(middle - arm(m, theta2A, theta23A)),
            *(
                sp.Matrix([along_fore, -across_fore]).subs({ahead: apart[0], higher: apart[1]})
                / m.d
            ),
        ),
        angles=(psi, phi, pitch),
        images="fk",
        condition=amplification(m),
        links=tuple(map(Link.of, lemmas)),
        glue=Combination(
            sp.diag(MID_PLANE_ROWS, sp.Matrix.vstack(closure, turned_line * difference)),
            joints,
            solutions_per_branch=2,
            because="the virtual arm is bent to the same side as the right arm",
        ),
    )
)
design(d, m, cos(psi) * cos(phi))
