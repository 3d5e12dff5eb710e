"""Dimensions, frames, the tip, the wrist and the chain rule for both models of the H6AR.

Angles in the mid-plane: ``theta2A`` is the angle of the virtual upper arm and ``theta23A`` that of
the virtual fore-arm, both against the horizontal.  ``alpha`` and ``beta`` are half the differences
of the real arms' angles, right minus left.
"""

from collections.abc import Iterable
from dataclasses import replace
from functools import reduce
from typing import NamedTuple

import sympy as sp
from sympy import Rational, atan2, cos, pi, sin, sqrt

from closedform import (
    Derivation,
    Lemma,
    LinksAtHeight,
    Pair,
    Preferred,
    Program,
    choose,
    denavit_hartenberg,
    homogeneous,
    linear_pair,
    real,
    rotation,
    sine_cosine,
    two_link_arm,
)

pair = Pair.of
theta2A, theta23A = real("theta2A"), real("theta23A")
alpha, beta = real("alpha"), real("beta")
mu2, mu23 = real("mu2"), real("mu23")
x, y, z, psi, phi, pitch = (real(n) for n in ("x", "y", "z", "psi", "phi", "pitch"))
target = (x, y, z, psi, phi, pitch)
L_theta, L_2W, a_3W = real("L_theta"), real("L_2W"), real("a_3W")
sigma_waist, sigma_elbow = real("sigma_waist"), real("sigma_elbow")
WAIST = (sigma_waist, {+1: "front", -1: "rear"})
ELBOW = (sigma_elbow, {+1: "elbow_up", -1: "elbow_down"})

EXAMPLE = "example; the paper gives no dimensions"


class Dimensions(NamedTuple):
    """The parameters, in the order of the generated functions."""

    L1: sp.Symbol
    L2: sp.Symbol
    a3: sp.Symbol
    d1: sp.Symbol
    d: sp.Symbol
    gs: sp.Symbol
    al: sp.Symbol
    loff: sp.Symbol
    lp: sp.Symbol


class Joints(NamedTuple):
    """The joint variables, in the order of the generated functions."""

    theta1: sp.Symbol
    theta2R: sp.Symbol
    theta3R: sp.Symbol
    theta2L: sp.Symbol
    theta3L: sp.Symbol
    theta: sp.Symbol


class Posture(NamedTuple):
    """All quantities that the tip depends on, as names of a program or as expressions."""

    waist: Pair
    upper: Pair
    fore: Pair
    yaw: Pair
    roll: Pair
    pitch: Pair
    wrist: sp.Expr
    """The variable length l_W of eq. (8)."""
    base: sp.Expr
    """Half the base line of the wrist."""


def declare(d: Derivation) -> tuple[Dimensions, Joints]:
    """The parameters and the joints."""
    millimetres = {
        "L1": (400, "length of the upper arms"),
        "L2": (400, "length of the fore-arms"),
        "a3": (50, "offset of the fore-arms at the elbow"),
        "d1": (500, "height of the shoulders"),
        "d": (100, "distance of each arm from the mid-plane"),
        "gs": (20, "half the distance of the gears of the wrist"),
        "al": (120, "length of the links of the wrist, which the paper writes as a product"),
        "loff": (50, "distance from the gears to the pitch joint"),
        "lp": (100, "distance from the pitch joint to the tip"),
    }
    dimensions = Dimensions(
        *(
            d.parameter(n, value=Rational(v, 1000), unit="m", meaning=text, source=EXAMPLE)
            for n, (v, text) in millimetres.items()
        )
    )
    theta1, theta2R, theta3R = d.joint("theta1"), d.joint("theta2R"), d.joint("theta3R")
    theta2L, theta3L = d.joint("theta2L", twin_of=theta2R), d.joint("theta3L", twin_of=theta3R)
    for arm, side in (("R", "right"), ("L", "left")):
        for k, link in ((2, "upper arm"), (3, "fore-arm")):
            d.write(f"theta{k}{arm}", rf"\theta_{k}^{arm}", f"angle of the {side} {link}")
        d.write(f"theta23{arm}", rf"\theta_{{23}}^{arm}", f"absolute angle of the {side} fore-arm")
    d.write("theta2A", r"\theta_2^A", "average of the angles of the upper arms")
    d.write("theta23A", r"\theta_{23}^A", "average of the absolute angles of the fore-arms")
    d.write("mu2", r"\mu_2", "half the sum of the angles of the upper arms")
    d.write("mu23", r"\mu_{23}", "half the sum of the absolute angles of the fore-arms")
    d.write("alpha", r"\delta_2", "half the difference of the angles of the upper arms")
    d.write("beta", r"\delta_{23}", "half the difference of the absolute angles of the fore-arms")
    d.write("f", meaning="length of a fore-arm, from the elbow to the tip")
    d.write("wrist", "l_W", "length of the wrist")
    d.write("l_W", "l_W")
    d.write("ahead", r"\Delta_a", "how far the right tip is ahead of the middle of the tips")
    d.write("higher", r"\Delta_h", "how far the right tip is above the middle of the tips")
    d.write("beyond", r"\Delta_z", "half the base line, along the virtual fore-arm")
    d.write("width", r"\Delta_x", "half the base line, across the virtual fore-arm")
    d.write("upright", r"m_\phi", "cosine of the roll, which must be positive")
    d.write("L_2W", "L_{2W}", "length of the virtual fore-arm with the wrist")
    d.write("a_3W", "a_{3W}", "offset of the virtual fore-arm with the wrist")
    d.write("psi_max", meaning="largest yaw")
    d.write("phi_max", meaning="largest roll")
    d.write("beta_min", meaning="smallest separation angle of the wrist links")
    d.explain(
        {
            r"a_{l,\min}": "shortest wrist link for a separation angle",
            "T_{RL}": "tips of the right and of the left fore-arm, a row for each",
            r"R_\parallel": "component of the reach of the virtual arm along its upper arm",
            r"R_\perp": "component of the reach of the virtual arm across its upper arm",
        }
    )
    d.write("drawn", r"R_\parallel")
    d.write("tilt", r"R_\perp")
    d.write("R_perp", r"R_\perp")
    d.write("pitch", r"\theta_T", "pitch of the target")
    d.write("tips", "P")
    d.write("angle", r"\alpha_{\max}", "largest angle of both yaw and roll")

    return dimensions, Joints(theta1, theta2R, theta3R, theta2L, theta3L, d.joint("theta"))


def product(transforms: Iterable[sp.Matrix]) -> sp.Matrix:
    """The product without simplification, for comparison with a form written by hand."""
    return reduce(sp.Matrix.__mul__, transforms)


def reach(m: Dimensions, upper: Pair, fore: Pair, along: sp.Expr, across: sp.Expr) -> sp.Matrix:
    """Distance of the end of an arm from the waist axis, and its height above the shoulder."""
    return sp.Matrix(
        [
            m.L1 * upper.c + along * fore.s + across * fore.c,
            m.L1 * upper.s - along * fore.c + across * fore.s,
        ]
    )


def arm(m: Dimensions, upper: sp.Expr, fore: sp.Expr) -> sp.Matrix:
    """The tip of a fore-arm in the plane of its arm, from absolute angles."""
    return reach(m, pair(upper), pair(fore), m.L2, m.a3)


def in_space(m: Dimensions, waist: Pair, planar: sp.Matrix, side: sp.Expr) -> sp.Matrix:
    """A point of a plane at the distance ``side`` right of the mid-plane, in the base frame."""
    r, h = planar
    return sp.Matrix([waist.s * side + waist.c * r, -waist.c * side + waist.s * r, m.d1 + h])


def half_sums(q: Joints) -> dict[sp.Symbol, sp.Expr]:
    """Half sums and half differences of the arms' angles, in terms of the joints."""
    upper, bend = (q.theta2R + q.theta2L) / 2, (q.theta3R + q.theta3L) / 2
    apart, bent = (q.theta2R - q.theta2L) / 2, (q.theta3R - q.theta3L) / 2
    return {mu2: upper, mu23: upper + bend, alpha: apart, beta: apart + bent}


def by_half_sums(q: Joints) -> dict[sp.Symbol, sp.Expr]:
    """The joints of the arms in terms of half sums and half differences."""
    return {
        q.theta2R: mu2 + alpha,
        q.theta2L: mu2 - alpha,
        q.theta3R: mu23 + beta - mu2 - alpha,
        q.theta3L: mu23 - beta - mu2 + alpha,
    }


def half_sums_step(d: Derivation, q: Joints) -> None:
    """Define the half sums and half differences."""
    means, halves = half_sums(q), by_half_sums(q)
    d.step(
        "Half sums and half differences",
        "The arms are compared in half sums (mu) and half differences (delta) of their angles.  In "
        "this form no digits cancel in the difference of the tips if these are close together.",
        {
            r"\mu_2": means[mu2],
            r"\mu_{23}": means[mu23],
            r"\delta_2": means[alpha],
            r"\delta_{23}": means[beta],
        },
        proves="The angles of the right arm are the half sums plus the half differences, and those "
        "of the left arm are the half sums minus them.",
        equal=[(joint, e.subs(means, simultaneous=True)) for joint, e in halves.items()],
    )


def half_gap(m: Dimensions) -> sp.Matrix:
    """Half the distances by which the right tip is ahead of the left one and above it."""
    upper, fore = pair(mu2), pair(mu23)
    return sp.Matrix(
        [
            -m.L1 * upper.s * sin(alpha) + (m.L2 * fore.c - m.a3 * fore.s) * sin(beta),
            m.L1 * upper.c * sin(alpha) + (m.L2 * fore.s + m.a3 * fore.c) * sin(beta),
        ]
    )


def midpoint(m: Dimensions) -> sp.Matrix:
    """The middle of the tips in the mid-plane."""
    shoulder = m.L1 * pair(mu2).unit
    return cos(alpha) * shoulder + cos(beta) * (arm(m, mu2, mu23) - shoulder)


def arm_frames(m: Dimensions, theta1: sp.Expr, theta2: sp.Expr, theta3: sp.Expr, d: sp.Expr):
    """The frames of an arm up to (X, Y, Z)_3 by Denavit-Hartenberg, as in the paper's Fig. 2."""
    return [
        denavit_hartenberg(0, pi / 2, m.d1, theta1),
        denavit_hartenberg(m.L1, 0, d, theta2),
        denavit_hartenberg(m.a3, pi / 2, 0, theta3),
    ]


def wrist_frames(m: Dimensions, length: sp.Expr, psi: sp.Expr, phi: sp.Expr, theta: sp.Expr):
    """The frames from the virtual fore-arm to the tip: roll, yaw, wrist, pitch, last link."""
    along_z = [homogeneous(sp.eye(3), (0, 0, e)) for e in (m.L2, length, m.lp)]
    return [
        along_z[0],
        homogeneous(rotation("z", phi)),
        homogeneous(rotation("x", psi)),
        along_z[1],
        homogeneous(rotation("y", theta)),
        along_z[2],
    ]


def extended(m: Dimensions, p: Posture) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """L_theta, L_2W and a_3W of eq. (9), the lengths of the virtual arm with the wrist."""
    hand = p.wrist + m.loff + m.lp * p.pitch.c
    return (
        hand * p.roll.c * p.yaw.s - m.lp * p.pitch.s * p.roll.s,
        m.L2 + hand * p.yaw.c,
        m.a3 + hand * p.roll.s * p.yaw.s + m.lp * p.pitch.s * p.roll.c,
    )


def tip(m: Dimensions, p: Posture) -> sp.Matrix:
    """The tip, eq. (9)."""
    aside, along, across = extended(m, p)
    return in_space(m, p.waist, reach(m, p.upper, p.fore, along, across), -aside)


def straight(along: sp.Expr, across: sp.Expr, upper: Pair, fore: Pair) -> sp.Expr:
    """The component of the fore-arm across the upper arm: zero if the arm is straight or folded."""
    bend = fore - upper
    return along * bend.c - across * bend.s


def turned(angle: sp.Expr) -> sp.Expr:
    """An angle, moved to (-pi, pi]."""
    return atan2(sin(angle), cos(angle))


def pose_matrix(m: Dimensions, program: Program, p: Posture) -> sp.Matrix:
    """The frame of the tip, R03 Rz(phi) Rx(psi) Ry(theta), from the pairs of a posture."""
    c1, s1, c23, s23 = p.waist.c, p.waist.s, p.fore.c, p.fore.s
    forearm = sp.Matrix([[c1 * c23, s1, c1 * s23], [s1 * c23, -c1, s1 * s23], [s23, 0, -c23]])
    symbols = [real("u"), real("v"), real("w")]
    rolled, yawed, pitched = (
        rotation(axis, s).xreplace({cos(s): q.c, sin(s): q.s})
        for axis, s, q in zip("zxy", symbols, (p.roll, p.yaw, p.pitch), strict=True)
    )
    hand = program.matrix("hand", rolled * yawed * pitched)
    return homogeneous(forearm * hand, tuple(tip(m, p)))


def wrist_let(program: Program, m: Dimensions, base: sp.Symbol) -> sp.Symbol:
    """Define l_W of eq. (8) for half a base line, with the conditions that the triangle closes."""
    near = program.bound("near", m.al + m.gs - base, m.al + m.gs, "the wrist links are long enough")
    far = program.bound("far", m.al - m.gs + base, m.al + m.gs, "the wrist links meet the gears")
    return program.let("wrist", sqrt(near) * sqrt(far), nonnegative=True)


def wrist_length(m: Dimensions, level: sp.Expr) -> sp.Expr:
    """l_W of eq. (8) if half the base line is d / level."""
    return sqrt((m.al + m.gs) * level - m.d) * sqrt((m.al - m.gs) * level + m.d) / level


def wrist_given(program: Program, m: Dimensions, level: sp.Expr) -> tuple[sp.Symbol, sp.Symbol]:
    """Define l_W and half the base line, d / level; ``level`` is the cosine of its tilt.

    The scale of the bounds is the sum of two parts.  One is at most ``level / 2`` times the scale
    in ``wrist_let``, so that a posture within reach here is also within reach there.  The other is
    the change by eight units in the last place of yaw and roll: near a right angle, no posture with
    a stretched wrist can be more accurate.
    """
    tilt = sum(sp.Abs(level.diff(a)) for a in sorted(level.free_symbols, key=str))
    size = (m.al + m.gs) * (level * Rational(65, 64) + tilt / 512)
    program.bound("upright", cos(phi), sp.S.One, "the roll is less than a right angle")
    near = (m.al + m.gs) * level - m.d
    near = program.bound("near", near, size, "the wrist links are long enough")
    far = (m.al - m.gs) * level + m.d
    far = program.bound("far", far, size, "the wrist links meet the gears")
    wrist = program.let("wrist", sqrt(near) * sqrt(far) / level)
    return wrist, program.let("base", m.d / level)


BOTH_TIPS = r"\begin{bmatrix} (x, y, z)_R & (x, y, z)_L \end{bmatrix}^T"

STEEP = "Unbounded where the wrist links are nearly stretched: the slope of l_W is infinite there."

ACCURACY = (
    "OK answers hold to 2^-46 of the sum of the lengths over d, where that is more than 1e-12: "
    "yaw and roll follow from displacements of the tips divided by d, so rounding errors are "
    "divided by d too."
)


def amplification(m: Dimensions) -> sp.Expr:
    """The amplification of rounding errors: yaw and roll compare the tips over the distance d."""
    return sum(m) / m.d


def allowances(
    program: Program, m: Dimensions, wrist: sp.Symbol, apart: sp.Expr, gap: Iterable[sp.Expr] = ()
) -> tuple[sp.Symbol, sp.Symbol]:
    """The scales of the errors that are allowed at the tip and at the tips of the real arms.

    They are a quarter of the error that an answer may have, because several limits may be missed at
    once.  Yaw and roll are only known to some units in the last place; ``apart`` says how far the
    tips move by such an error.  Such an error changes the length of a ``wrist`` the more, the
    shorter it is, and if its links are stretched by its root; there the status is SINGULAR.  With
    a ``gap``, this part is allowed for any length of the wrist: see `report_short_wrist`.
    """
    base = m.al + m.gs + apart
    by_root = m.al * base / (2**9 * wrist + sqrt(m.al * base) / 2**15 + base / 2**60)
    stretched = program.vanishes(
        "stretched", wrist - m.al / 2**10, m.al, "the wrist links are stretched"
    )
    by_root = by_root if gap else choose(stretched, by_root, 0)
    by_wrist = program.let("by_wrist", by_root, nonnegative=True)
    far = program.let("far_apart", apart / 512 + by_wrist, nonnegative=True)
    lengths = program.let("lengths", sum(m))
    reached = program.let("slack", lengths / 4 + far, nonnegative=True)
    beside = program.let("play", sum(map(sp.Abs, gap), m.d) / 4 + lengths / 2048 + far)
    return reached, beside


def distances_across_gap(
    program: Program,
    m: Dimensions,
    gap: tuple[sp.Expr, sp.Expr],
    fore: tuple[sp.Expr, sp.Expr],
    height: sp.Expr,
) -> tuple[Preferred, ...]:
    """Distances of the tip from the waist axis with the longer link across the gap of the tips.

    The ``fore`` link, along and across, ends at the tip, at a ``height`` above the shoulder.  At
    the limit of the waist, a rounding error of the target hides this distance.  If the other link
    is much shorter, the gap determines it, because other postures do not have that gap.  The longer
    link may point to either end of the gap, and the other one to either side.  Such a posture
    exists if the longer link spans the gap.  If the other link is too short for the remaining
    height, the longer one has to turn, and both must still reach the gap after that.
    """
    let = program.let
    along, across = fore
    second, whole = sqrt(m.L2**2 + m.a3**2), sqrt(along**2 + across**2)
    by_fore = second > m.L1
    gap_size = let("gap_size", sqrt(gap[0] ** 2 + gap[1] ** 2))
    size = gap_size + (m.L1 + second) / 2**100
    x = sp.Piecewise(((across * m.L2 - along * m.a3) / second, by_fore), (0, True))
    y = sp.Piecewise(((across * m.a3 + along * m.L2) / second, by_fore), (m.L1, True))
    x, y = let("long_x", x / size), let("long_y", -y / size)
    long_r, long_h = let("long_r", x * gap[0] - y * gap[1]), let("long_h", x * gap[1] + y * gap[0])
    shorter = let("shorter", sp.Piecewise((m.L1, by_fore), (whole, True)))
    spans = gap_size <= sp.Max(second, m.L1)
    # an upright shorter link has this component across the longer one
    across_long = m.L1 * sp.Abs(gap[1]) / size
    margin = let("across_long", sp.Piecewise((across_long, by_fore), (second, True)))
    roots = []
    for name, across in (("_ahead", long_h), ("_behind", -long_h)):
        beyond = let(f"beyond_gap{name}", height - across)
        short_h = let(f"short_h{name}", sp.Max(-shorter, sp.Min(shorter, beyond)))
        square = long_r**2 + (short_h - beyond) * (across + height - short_h)
        left_r = let(f"left_r{name}", sqrt(sp.Max(0, square)))
        short_r = let(f"short_r{name}", sqrt((shorter - short_h) * (shorter + short_h)))
        lacking = (sp.Abs(beyond) - shorter) * gap_size
        exists = sp.And(spans, lacking <= margin * left_r)
        roots.append(Preferred(let(f"root_same{name}", left_r + short_r), exists))
        roots.append(Preferred(let(f"root_apart{name}", sp.Abs(left_r - short_r)), exists))
    return tuple(roots)


class MidPlane(NamedTuple):
    """The first part of both inverses: waist and virtual arm from the tip."""

    lemmas: tuple[Lemma, ...]
    upper: Pair
    fore: Pair
    elbow: Pair
    """Cosine and sine of the angle from the upper arm to the fore-arm."""
    outward: sp.Symbol
    """How far the tip is from the waist axis in the mid-plane."""


def solve_mid_plane(
    program: Program,
    m: Dimensions,
    q: Joints,
    wrist: tuple[sp.Symbol, sp.Symbol],
    *,
    slack: sp.Symbol,
    gap: tuple[sp.Expr, sp.Expr] | None = None,
) -> MidPlane:
    """Solve for pitch, waist and virtual arm.

    Parameters
    ----------
    program
        the program of the inverse
    m, q
        the dimensions and the joints
    wrist
        the length of the wrist, and half of its base line
    slack
        the scale of the error that is allowed
    gap
        how far the right tip is ahead of the middle and above it, if known before the virtual arm
    """
    given = (pair(psi), pair(phi), pair(pitch))
    program.let("extent", m.d * m.L1 * (m.L2 + m.a3))
    program.require(
        [sp.Piecewise((0, real("extent") > 0), (1, True))],
        1,
        "the arms are apart, and upper arms and fore-arms have a length",
    )
    nothing = Pair(sp.S.Zero, sp.S.Zero)
    known = Posture(nothing, nothing, nothing, *given, *wrist)
    names = ("L_theta", "L_2W", "a_3W")
    aside, along, across = (
        program.let(n, e) for n, e in zip(names, extended(m, known), strict=True)
    )
    virtual = LinksAtHeight(m.L1, sqrt(along**2 + across**2), z - m.d1)
    if gap:
        roots = distances_across_gap(program, m, gap, (along, across), z - m.d1)
        # the error that a clamped bound may have: eight units in the last place of yaw and roll
        virtual = replace(virtual, preferred=roots, rounding=Rational(1, 2**40))
    turn = sine_cosine(
        program,
        q.theta1,
        (-x, y, aside),
        sigma_waist,
        free=(q.theta1,),
        scale=sum(m),
        slack=slack,
        toward=virtual,
    )
    outward = turn.known(x * cos(q.theta1) + y * sin(q.theta1))
    sigma_bend = program.let("sigma_bend", -sigma_waist * sigma_elbow)
    bend = two_link_arm(
        program,
        (m.L1, along, across),
        (outward, z - m.d1),
        (theta2A, theta23A),
        sigma_bend,
        scale=slack,
        free=(q.theta2R, q.theta2L),
    )
    pitched = linear_pair(q.theta, sin(pitch), cos(pitch))
    pairs = (bend.pair(e) for e in (theta2A, theta23A, theta23A - theta2A))
    return MidPlane((pitched, turn, bend), *pairs, outward)


def tip_system(m: Dimensions, q: Joints, level: sp.Expr) -> tuple[tuple, tuple]:
    """Targets and forward expressions of pitch and tip, for given yaw, roll and pitch."""
    angles = (q.theta1, theta2A, theta23A, psi, phi, pitch)
    there = Posture(*map(pair, angles), wrist_length(m, level), m.d / level)
    return (sp.S.Zero, x, y, z), (sin(q.theta - pitch), *tip(m, there))


MID_PLANE_ROWS = sp.Matrix(
    [
        # rows: sin(theta - pitch), x, y, z; columns: pitch, waist, r and h of the virtual arm
        [1, 0, 0, 0],
        [0, sin(real("theta1")), cos(real("theta1")), 0],
        [0, -cos(real("theta1")), sin(real("theta1")), 0],
        [0, 0, 0, 1],
    ]
)


def wrist_squared(m: Dimensions, base: sp.Expr) -> sp.Expr:
    """l_W^2 of eq. (8)."""
    return m.al**2 - (base - m.gs) ** 2


def outer_jacobian(m: Dimensions, q: Joints, base: sp.Expr, wrist: sp.Symbol) -> sp.Matrix:
    """Derivative of the task by (theta1, theta2A, theta23A, psi, phi, theta).

    ``base`` is half the base line as a function of psi and phi; ``wrist`` is the symbol for l_W.
    """
    state = (q.theta1, theta2A, theta23A, psi, phi, q.theta)
    p = Posture(*map(pair, state), wrist, base)
    T = tip(m, p)
    length = sp.Matrix([wrist_squared(m, base)]).jacobian(state) / (2 * wrist)
    J = T.jacobian(state) + T.diff(wrist) * length
    return sp.Matrix.vstack(J, sp.eye(6)[3:, :])


def named(expr, p: Posture, q: Joints):
    """An expression in the angles of the mid-plane, rewritten in the named pairs of a posture."""
    state = (q.theta1, theta2A, theta23A, psi, phi, q.theta)
    names = {
        f: n
        for angle, known in zip(state, p[:6], strict=True)
        for f, n in ((sin(angle), known.s), (cos(angle), known.c))
    }
    return expr.xreplace(names)


def design(d: Derivation, m: Dimensions, level: sp.Expr) -> None:
    """Add the functions for the design of the wrist; half the base line is d / ``level``."""
    p = Program()
    length = wrist_given(p, m, level)[0]
    d.function(
        "wrist_length",
        "The variable length l_W of the wrist; NaN if the links are too short.",
        {"psi": psi, "phi": phi},
        {"l_W": length},
        program=p,
        source="eq. (8)",
    )
    psi_max, phi_max, beta_min = real("psi_max"), real("phi_max"), real("beta_min")
    needed = (m.d / level - m.gs).xreplace({psi: psi_max, phi: phi_max}) / cos(beta_min)
    span = m.al * cos(beta_min) + m.gs
    rolls = level.has(cos(phi))
    margin, w = real("margin", positive=True), real("w", positive=True)
    d.step(
        "Wrist design",
        "The separation angle is that between a wrist link and the base line, so half the base "
        "line is al times its cosine plus half the distance of the gears.  The angle is smallest "
        "at the largest yaw and roll.  This gives the shortest links, or the largest yaw for given "
        "links.",
        {r"a_{l,\min}": needed, r"\cos\psi_{max}": m.d / (span * (cos(phi) if rolls else 1))},
        published=("(10)",),
        proves=(
            "The cosine of twice the returned half angle is the quotient that equation (10) asks "
            "for."
        ),
        equal=[(cos(2 * atan2(sqrt(margin), sqrt(margin + 2 * w))), w / (w + margin))],
    )
    d.function(
        "minimum_link_length",
        "The shortest wrist links that keep the separation angle up to the given yaw and roll.",
        {"psi_max": psi_max, "phi_max": phi_max, "beta_min": beta_min},
        {"al": needed},
        source="eq. (10)" + (", with yaw and roll combined" if rolls else ""),
    )
    p = Program()
    w = p.let("span", span * (cos(phi) if rolls else 1))
    margin = p.bound("margin", w - m.d, m.al + m.gs, "the links are long enough for that roll")
    d.function(
        "largest_yaw",
        "The largest yaw at a roll that keeps the separation angle; NaN if there is none.",
        {"phi": phi, "beta_min": beta_min},
        {"psi": 2 * atan2(sqrt(margin), sqrt(w + m.d))},
        program=p,
    )
    p = Program()
    w = p.let("span", span)
    margin = p.bound("margin", w - m.d, m.al + m.gs, "the links are long enough")
    adjacent = sqrt(w) + sqrt(m.d) if rolls else sqrt(w + m.d)
    d.function(
        "largest_angle",
        "The largest angle that yaw and roll may both have; NaN if there is none.",
        {"beta_min": beta_min},
        {"angle": 2 * atan2(sqrt(margin), adjacent)},
        program=p,
    )
