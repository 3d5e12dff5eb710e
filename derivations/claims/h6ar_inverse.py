"""Claims of Rao and Raju about the inverse: section 4."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

import sympy as sp
from closedform.derivations.claims.h6ar_robot import Robot
from closedform.derivations.h6ar_mechanism import (
    Posture,
    extended,
    in_space,
    pair,
    reach,
    tip,
)
from sympy import Rational, asin, atan2, cos, pi, sin, sqrt

from closedform import (
    Check,
    Derivation,
    Equal,
    Every,
    ForAll,
    Gravity,
    Identity,
    Notation,
    Postures,
    Procedure,
    Reading,
    Relation,
    Solves,
    Under,
    normal,
    real,
)

INVERSE = "4 Inverse Kinematics"
EQ11 = r"-s_1 x_T + c_1 y_T = L_\theta"
BEFORE_14 = (
    r"(c_1x_T + s_1y_T)c_{23}^A + (z_T - d_1)s_{23}^A = L_1c_3^A + a_{3W}",
    r"(c_1x_T + s_1y_T)s_{23}^A - (z_T - d_1)c_{23}^A = L_1s_3^A",
)
GAMMA = (
    r"\gamma_1 = \begin{cases} \sin^{-1} \left(\frac{y_T}{\sqrt{x_T^2 + y_T^2}} \right) & "
    r"\text{if } x_T < 0, \\ \pi - \sin^{-1} \left(\frac{y_T}{\sqrt{x_T^2 + y_T^2}} \right) & "
    r"\text{if } x_T \ge 0, \end{cases}"
)
WAIST_SINE = r"\sin^{-1} \left(\frac{L_{\theta}}{\sqrt{x_T^2 + y_T^2}} \right)"
WAIST = rf"\theta_1 = {WAIST_SINE} - \gamma_1, \ {GAMMA}"
BOTH_WAISTS = (
    r"\theta_1 = \frac{\pi}{2} \pm \left(\frac{\pi}{2} - \sin^{-1} \left(\frac{L_{\theta}}"
    r"{\sqrt{x_T^2 + y_T^2}} \right) \right) - \gamma_1, \ " + GAMMA
)
ELBOW_SQUARE = (
    r"2L_1 \left(L_{2W} s_3^A + a_{3W} c_3^A \right) = \left(c_1 x_T + s_1 y_T \right)^2 + "
    r"\left(z_T - d_1 \right)^2 - L_1^2 - L_{2W}^2 - a_{3W}^2 = L_{3A}"
)
ELBOW_SINES = (
    r"\sin^{-1} \left(\frac{L_{3A}}{2L_1 \sqrt{L_{2W}^2 + a_{3W}^2}} \right)",
    r"\sin^{-1} \left(\frac{a_{3W}}{\sqrt{L_{2W}^2 + a_{3W}^2}} \right)",
)
ELBOW = rf"\theta_3^A = {ELBOW_SINES[0]} - {ELBOW_SINES[1]}"
RIGHT_SINES = (
    r"\sin^{-1}\left(\frac{\left(c_1 x_R + s_1 y_R\right)^2 + \left(z_R - d_1\right)^2 - L_1^2 - "
    r"L_2^2 - a_3^2}{2L_1 \sqrt{L_2^2 + a_3^2}}\right)",
    r"\sin^{-1}\left(\frac{a_3}{\sqrt{L_2^2 + a_3^2}}\right)",
)
RIGHT_ELBOW = rf"\theta_3^R = {RIGHT_SINES[0]} - {RIGHT_SINES[1]}"
SHOULDER = (
    r"(z_T - d_1) \left(L_1 c_3^A + a_{3W} \right) + (c_1 x_T + s_1 y_T) "
    r"\left(L_1 s_3^A + L_{2W} \right)",
    r"(c_1 x_T + s_1 y_T) \left(L_1 c_3^A + a_{3W} \right) - (z_T - d_1) "
    r"\left(L_1 s_3^A + L_{2W} \right)",
)
RIGHT_SHOULDER = (
    r"(z_{R} - d_{1}) \left(L_{1} c_{3}^{R} + a_{3} \right) + (c_{1} x_{R} + s_{1} y_{R}) "
    r"\left(L_{1} s_{3}^{R} + L_{2} \right)",
    r"(c_{1} x_{R} + s_{1} y_{R}) \left(L_{1} c_{3}^{R} + a_{3} \right) - (z_{R} - d_{1}) "
    r"\left(L_{1} s_{3}^{R} + L_{2} \right)",
)


def quotient(parts: tuple[str, str]) -> str:
    r"""The principal value, as printed."""
    return rf"\tan^{{-1}} \left(\frac{{{parts[0]}}}{{{parts[1]}}} \right)"


def quadrants(parts: tuple[str, str]) -> str:
    """The angle in all four quadrants."""
    return rf"\operatorname{{atan2}}\left({parts[0]}, {parts[1]} \right)"


def both_elbows(sines: tuple[str, str]) -> str:
    return rf"\frac{{\pi}}{{2}} \pm \left(\frac{{\pi}}{{2}} - {sines[0]} \right) - {sines[1]}"


def state(d: Derivation, r: Robot, printed: Notation) -> None:
    """Section 4."""
    given = {f"{axis}_T": real(f"{axis}_T") for axis in "xyz"}
    lengths = {n: real(n.replace("\\", "")) for n in (r"L_\theta", "L_{2W}", "a_{3W}", "L_{3A}")}
    names = printed.extended(
        given
        | lengths
        | {
            r"L_{\theta}": lengths[r"L_\theta"],
            r"\gamma_1": real("gamma_1"),
            r"\operatorname{atan2}": atan2,
        }
    )
    reached = dict(zip(given.values(), reached_tip(r, lengths), strict=True))
    virtual = Virtual(names, given, lengths, reached, sampled(r, given, lengths))
    waist(d, r, virtual)
    elbow(d, r, virtual)
    shoulder(d, r, virtual)
    whole(d, r, virtual)
    right_arm(d, r, printed.extended({r"\operatorname{atan2}": atan2}))


class Virtual(NamedTuple):
    """What section 4 takes as given: the tip and the lengths of (9) are symbols."""

    names: Notation
    tip: dict[str, sp.Symbol]
    lengths: dict[str, sp.Symbol]
    reached: dict[sp.Symbol, sp.Expr]
    """The tip by the frames of the virtual arm, from the three lengths of (9)."""
    postures: Postures


def errors(d: Derivation) -> None:
    """What is wrong in section 4."""
    d.erratum(
        "waist-rear",
        "The waist formula gives only the posture in which the robot turns its back to the target",
        Gravity.MOTION,
        why=r"$\sin^{-1}$ lies between $-90^\circ$ and $90^\circ$; there the sum "
        r"$\theta_1 + \gamma_1$ has a nonnegative cosine, and that means "
        r"$c_1 x_T + s_1 y_T \le 0$: the target is behind the robot.  The usual posture, with the "
        r"target in front, is the other solution, $\pi - \sin^{-1}(\cdot) - \gamma_1$.  A tip on "
        "the waist axis, where the formula divides by zero, is not mentioned.",
        use="A robot that uses the formula turns its back to every target and has to reach "
        "backwards over itself, if it can reach the target at all.",
    )
    d.erratum(
        "quadrant",
        "The shoulder is taken from a quotient, so half of the directions of the fore-arm are lost",
        Gravity.MOTION,
        why=r"The principal value of $\tan^{-1}$ lies between $-90^\circ$ and $90^\circ$, where "
        r"the fore-arm hangs down.  The denominator has the sign of $\cos\theta_{23}$: it is "
        "negative if the fore-arm points above the horizontal, and zero if it is level.",
        use=r"For a fore-arm above the horizontal the formula is off by $180^\circ$: the shoulder "
        "is turned by half a turn, and the hand misses its target.  For a level fore-arm it "
        "divides by zero.  A function of numerator and denominator, such as atan2, gives the "
        "correct angle.",
    )
    d.erratum(
        "one-elbow",
        "One of the two elbow postures is missing",
        Gravity.OMISSION,
        why=r"$\sin(\theta_3 + \gamma) = k$ has the solutions $\sin^{-1} k - \gamma$ and "
        r"$\pi - \sin^{-1} k - \gamma$; the paper gives the first one only, and does not say that "
        "it chooses.",
        use="The angles that the formula gives are correct.  A user who needs the other posture, "
        "for example to avoid an obstacle, does not find it.",
    )
    d.erratum(
        "sign-before-14",
        "A sign in the second equation before (14)",
        Gravity.MISPRINT,
        why="The fore-arm is added to the projection of the upper arm: $L_1 s_3^A + L_{2W}$.",
        use="Nothing: (14) uses the right sign.",
    )


def reached_tip(r: Robot, lengths: dict[str, sp.Symbol]) -> sp.Matrix:
    """The tip from the three lengths of (9)."""
    along, across = lengths["L_{2W}"], lengths["a_{3W}"]
    planar = reach(r.m, pair(r.A2), pair(r.A2 + r.A3), along, across)
    return in_space(r.m, pair(r.q.theta1), planar, -lengths[r"L_\theta"])


def sampled(r: Robot, given: dict[str, sp.Symbol], lengths: dict[str, sp.Symbol]) -> Postures:
    """Postures of the virtual arm with the example dimensions.

    The arm turns through full circles; yaw and roll are at most 30 degrees, pitch 90.
    """
    m, q = r.m, r.q
    base = m.d / cos(r.psi)
    angles = (q.theta1, r.A2, r.A2 + r.A3, r.psi, r.phi, q.theta)
    posture = Posture(*map(pair, angles), sqrt(m.al**2 - (base - m.gs) ** 2), base)
    inputs = dict(zip(given.values(), tip(m, posture), strict=True))
    inputs |= dict(zip(lengths.values(), extended(m, posture), strict=False))
    third, quarter = float(pi / 6), float(pi / 2)
    return Postures(
        inputs | {r.A23: r.A2 + r.A3},
        (q.theta1, r.A2, r.A3, r.psi, r.phi, q.theta),
        r.example,
        {r.psi: (-third, third), r.phi: (-third, third), q.theta: (-quarter, quarter)},
        virtual={r.A2: (q.theta2R + q.theta2L) / 2, r.A3: (q.theta3R + q.theta3L) / 2},
    )


PRINCIPAL = "the principal value of $\\tan^{-1}$, as in (12) for $\\sin^{-1}$"
QUADRANTS = Reading(
    "an angle in the quadrant of numerator and denominator",
    means={r"\tan^{-1}": lambda e: atan2(*sp.fraction(e))},
)


def by_side(r: Robot, v: Virtual) -> Postures:
    """The postures, in groups: is the target in front of the robot?"""
    x, y, _ = v.tip.values()
    outward = cos(r.q.theta1) * x + sin(r.q.theta1) * y
    return replace(
        v.postures, groups={"target in front": outward > 0, "target behind": outward < 0}
    )


def solves_waist(r: Robot, v: Virtual, formulas: tuple[Relation, Relation]) -> Solves:
    """The waist angle and its auxiliary angle solve (11)."""
    turn, gamma = formulas
    x, y, _ = v.tip.values()
    size, aside = sqrt(x**2 + y**2), v.lengths[r"L_\theta"]
    (eleventh,) = v.names.read(EQ11)
    return Solves(
        {turn.left: turn.right.subs(gamma.left, gamma.right)},
        [eleventh.left - eleventh.right],
        by_side(r, v),
        (size - aside, size + aside),
    )


def solves_elbow(r: Robot, v: Virtual, formula: Relation) -> Solves:
    """The elbow angle solves the relation before (13)."""
    _, along, across, square = v.lengths.values()
    fore = sqrt(along**2 + across**2)
    bent = 2 * r.m.L1 * (along * sin(r.A3) + across * cos(r.A3))
    wrist = {s: v.postures.inputs[s] for s in (along, across)}
    return Solves(
        {formula.left: formula.right},
        [bent - square],
        replace(v.postures, inputs=wrist | {square: bent.subs(wrist)}),
        (along, 2 * r.m.L1 * fore - square, 2 * r.m.L1 * fore + square),
    )


def solves_shoulder(r: Robot, v: Virtual, formula: Relation) -> Solves:
    """The angle of the fore-arm solves the two equations before (14)."""
    _, along, across, _ = v.lengths.values()
    sides = [f"{BEFORE_14[0]}", f"{BEFORE_14[1]} + L_{{2W}}"]
    names = v.names.extended(of_fore_arm(r))
    equations = [e.left - e.right for text in sides for e in names.read(text)]
    across_bend, along_bend = r.m.L1 * cos(r.A3) + across, r.m.L1 * sin(r.A3) + along
    return Solves(
        {formula.left: formula.right},
        equations,
        replace(v.postures, groups=directions(r.A23)),
        # the wrist makes the fore-arm longer, as yaw and pitch are at most a right angle
        (sp.expand(across_bend**2 + along_bend**2), along - r.m.L2),
        v.reached,
    )


def of_fore_arm(r: Robot) -> dict[str, sp.Expr]:
    return {"c_{23}^A": cos(r.A23), "s_{23}^A": sin(r.A23), r"\theta_{23}^A": r.A23}


def waist(d: Derivation, r: Robot, v: Virtual) -> None:
    """Eqs. (11), (12) and the waist angle."""
    claim = partial(d.claim, where=INVERSE, notation=v.names)
    claim(
        "eq. (11)",
        rf"From (9a) and (9b), the relation ${EQ11}$",
        lambda f: Equal(f, on=v.reached),
    )
    kappa, rho, angle, gamma = (real(n) for n in ("kappa", "rho", "x", "gamma"))
    claim(
        "eq. (12)",
        r"$\frac{\kappa \sin x + \rho \cos x}{\sqrt{\kappa^2 + \rho^2}} = \sin \left(x + \gamma "
        r"\right), \ \gamma = \begin{cases} \sin^{-1} \left(\frac{\rho}{\sqrt{\kappa^2 + \rho^2}} "
        r"\right) & \text{if } \kappa \ge 0, \\ \pi - \sin^{-1} \left(\frac{\rho}{\sqrt{\kappa^2 "
        r"+ \rho^2}} \right) & \text{if } \kappa < 0, \end{cases}$",
        lambda pair: Equal(
            replace(pair[0], sides=[e.subs(pair[1].left, pair[1].right) for e in pair[0].sides])
        ),
        means={r"\kappa": kappa, r"\rho": rho, "x": angle, r"\gamma": gamma},
    )
    claim(
        "waist angle",
        f"Applying this identity to (11) leads to the waist angle being given by ${WAIST}$",
        partial(solves_waist, r, v),
        corrected="Applying this identity to (11) leads to the waist angle being given by "
        f"${BOTH_WAISTS}$",
        erratum="waist-rear",
    )


def elbow(d: Derivation, r: Robot, v: Virtual) -> None:
    """Eq. (13)."""
    claim = partial(d.claim, where=INVERSE, notation=v.names)
    m, square = r.m, v.lengths["L_{3A}"]
    claim(
        "before eq. (13)",
        "The angle [...] is evaluated using the relation " + f"${ELBOW_SQUARE}$",
        lambda f: Equal(f, on=v.reached, defines=square),
    )
    claim(
        "eq. (13)",
        f"${ELBOW}$",
        partial(solves_elbow, r, v),
        corrected=f"$\\theta_3^A = {both_elbows(ELBOW_SINES)}$",
        erratum="one-elbow",
    )
    more = real("t_1", nonnegative=True), real("t_2", nonnegative=True)
    hand = real("L_W", nonnegative=True)

    largest = real("largest")

    def long_enough(limit: Relation) -> Check:
        """The first case of (12) applies, as the extended fore-arm has no negative length."""
        least = cos(limit.right) if limit.signs == ("<=",) else cos(sp.pi)
        length = r.beyond_elbow[2].subs(r.LW, hand)
        by_cosines = {cos(r.q.theta): least + more[0], cos(r.psi): least + more[1]}
        example = {m.L2: Rational(1, 1000), m.lp: 1, hand: 1, more[0]: 0, more[1]: 0}
        return Every(
            {
                "the limits are those of the angles": Identity(limit.left, largest),
                "the extended fore-arm has no negative length": ForAll(
                    sp.Ge(normal(length).subs(by_cosines), 0), among=[example]
                ),
            }
        )

    claim(
        "domain of eq. (13)",
        r"for $|\theta, \psi| \leq 90^{\circ}$",
        long_enough,
        means={r"|\theta, \psi|": largest},
    )


def shoulder(d: Derivation, r: Robot, v: Virtual) -> None:
    """Eq. (14)."""
    claim = partial(d.claim, where=INVERSE, notation=v.names)
    claim(
        "first equation before (14)",
        f"${BEFORE_14[0]}$",
        lambda f: Equal(f, on=v.reached),
    )
    claim(
        "second equation before (14)",
        f"${BEFORE_14[1]} - L_{{2W}}$",
        lambda f: Equal(f, on=v.reached),
        corrected=f"${BEFORE_14[1]} + L_{{2W}}$",
        erratum="sign-before-14",
    )
    claim(
        "eq. (14)",
        f"$\\theta_{{23}}^{{A}} = {quotient(SHOULDER)}$",
        partial(solves_shoulder, r, v),
        means=of_fore_arm(r),
        corrected=f"$\\theta_{{23}}^{{A}} = {quadrants(SHOULDER)}$",
        erratum="quadrant",
        readings=[Reading(PRINCIPAL), QUADRANTS],
    )


def directions(fore: sp.Symbol) -> dict[str, sp.Expr]:
    return {"fore-arm hanging down": cos(fore) > 0, "fore-arm raised": cos(fore) < 0}


def whole(d: Derivation, r: Robot, v: Virtual) -> None:
    """The angles of the virtual arm, one after the other."""
    square = v.lengths["L_{3A}"]

    def in_order(
        turn: tuple[Relation, Relation], bend: Relation, third: Relation, sum_: Relation
    ) -> Check:
        names = {turn[1].left: turn[1].right, turn[0].left: turn[0].right}
        names |= {square: bend.sides[1], third.left: third.right, sum_.left: sum_.right}
        reached = {t: e.subs(r.A2, r.A23 - r.A3) for t, e in v.reached.items()}
        steps: dict[str, Check] = {
            "the waist": solves_waist(r, v, turn),
            "the relation for the elbow": Equal(bend, on=v.reached, defines=square),
            "the elbow": solves_elbow(r, v, third),
            "the shoulder": solves_shoulder(r, v, sum_),
        }
        return Procedure(names, reached, by_side(r, v), steps)

    text = f"$%s$ [...] ${ELBOW_SQUARE}$ [...] $\\theta_3^A = %s$ [...] $\\theta_{{23}}^{{A}} = %s$"
    d.claim(
        "inverse of the virtual arm",
        text % (WAIST, f"{ELBOW_SINES[0]} - {ELBOW_SINES[1]}", quotient(SHOULDER)),
        in_order,
        where=INVERSE,
        notation=v.names.extended({r"\theta_{23}^A": r.A23}),
        corrected=text % (BOTH_WAISTS, both_elbows(ELBOW_SINES), quadrants(SHOULDER)),
        erratum="quadrant",
        readings=[Reading(PRINCIPAL)],
    )


def right_arm(d: Derivation, r: Robot, printed: Notation) -> None:
    """The angles of the right arm, and the case without yaw and roll."""
    m, q = r.m, r.q
    symbols = {f"{axis}_R": real(f"{axis}_R") for axis in "xyz"}
    claim = partial(d.claim, where=INVERSE, notation=printed.extended(symbols))
    fore = r.A2 + r.A3
    upper_by = sp.Matrix([-m.L1 * sin(r.A2), m.L1 * cos(r.A2)])
    fore_by = sp.Matrix([m.L2 * cos(fore) - m.a3 * sin(fore), m.L2 * sin(fore) + m.a3 * cos(fore)])
    yaw_roll = [real("yaw"), real("roll")]
    gap = m.d * sp.Matrix([sin(e) / cos(e) for e in yaw_roll])
    bent = upper_by[0] * fore_by[1] - upper_by[1] * fore_by[0]
    upper = asin((gap[0] * fore_by[1] - gap[1] * fore_by[0]) / bent)
    forward = asin((upper_by[0] * gap[1] - upper_by[1] * gap[0]) / bent)

    def alike(given: Relation, *angles: Relation) -> Check:
        values = dict(zip(yaw_roll, (given.right, given.sides[-2]), strict=True))
        values = {s: given.right if e in (r.psi, r.phi) else e for s, e in values.items()}
        return Under(
            Every(
                {
                    "the half differences agree": Equal(
                        tuple(replace(a, sides=[e.subs(values) for e in a.sides]) for a in angles)
                    ),
                    "yaw and roll are zero": Identity([*given.sides[:2]], [r.psi, r.phi]),
                }
            ),
            "the virtual arm is neither straight nor folded, and the angles of the arms differ by "
            "less than half a turn",
        )

    claim(
        "no yaw, no roll",
        r"“if $\psi = \phi = 0$, then $\theta_2^R = \theta_2^L = \theta_2^A$ and $\theta_3^R = "
        r"\theta_3^L = \theta_3^A$.”",
        alike,
        means={
            r"\theta_2^R": r.A2 + upper,
            r"\theta_2^L": r.A2 - upper,
            r"\theta_3^R": r.A3 + forward - upper,
            r"\theta_3^L": r.A3 - forward + upper,
        },
    )
    x, y, z = symbols.values()
    outward, height = cos(q.theta1) * x + sin(q.theta1) * y, z - m.d1
    square = outward**2 + height**2 - m.L1**2 - m.L2**2 - m.a3**2
    reach = 2 * m.L1 * sqrt(m.L2**2 + m.a3**2)
    planar = r.planar_tip(q.theta2R, q.theta2R + q.theta3R, m.d)
    place = dict(zip((x, y, z), planar, strict=True))
    whole_sum = real("theta_23^R")
    postures = Postures(
        place | {whole_sum: q.theta2R + q.theta3R},
        (q.theta1, q.theta2R, q.theta3R),
        r.example,
    )
    claim(
        "elbow of the right arm",
        "similar to the calculation of [...], using (1), [...] is given by " + f"${RIGHT_ELBOW}$",
        lambda f: Solves(
            {f.left: f.right},
            [2 * m.L1 * (m.L2 * sin(q.theta3R) + m.a3 * cos(q.theta3R)) - square],
            postures,
            (reach - square, reach + square),
        ),
        corrected="similar to the calculation of [...], using (1), [...] is given by "
        f"$\\theta_3^R = {both_elbows(RIGHT_SINES)}$",
        erratum="one-elbow",
    )
    across, along = m.L1 * cos(q.theta3R) + m.a3, m.L1 * sin(q.theta3R) + m.L2
    claim(
        "shoulder of the right arm",
        f"$\\theta_{{23}}^{{R}} = {quotient(RIGHT_SHOULDER)}$",
        lambda f: Solves(
            {f.left: f.right},
            [
                outward * cos(whole_sum) + height * sin(whole_sum) - across,
                outward * sin(whole_sum) - height * cos(whole_sum) - along,
            ],
            replace(postures, groups=directions(whole_sum)),
            (sp.expand(across**2 + along**2),),
            place,
        ),
        means={r"\theta_{23}^R": whole_sum},
        corrected=f"$\\theta_{{23}}^{{R}} = {quadrants(RIGHT_SHOULDER)}$",
        erratum="quadrant",
        readings=[Reading(PRINCIPAL), QUADRANTS],
    )
