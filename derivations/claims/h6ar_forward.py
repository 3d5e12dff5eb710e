"""Claims of Rao and Raju about the invariant point and the virtual arm: sections 3.2 and 3.3."""

from functools import partial
from typing import Any

import sympy as sp
from closedform.derivations.claims.h6ar_robot import Robot
from sympy import cos, pi, sin, tan

from closedform import (
    Agree,
    Check,
    Count,
    Derivation,
    Equal,
    Gravity,
    Identity,
    Not,
    Notation,
    Reading,
    Relation,
    Under,
    real,
)

POINT = "3.2 Invariant point-forward kinematics"
SERIAL = "3.3 Equivalent serial mechanism"
EQ3 = r"z_I = z_R - d\tan\phi, \ z_I = z_L + d\tan\phi"
EQ4A = r"x_I = x_R - d\left(\tan\psi\cos\theta_1 + \sin\theta_1\right)"
EQ4B = r"y_I = y_R + d\left(\cos\theta_1 - \tan\psi\sin\theta_1\right)"
EQ5A = r"x_I = x_L + d\left(\tan\psi\cos\theta_1 + \sin\theta_1\right)"
EQ5B = r"y_I = y_L - d\left(\cos\theta_1 - \tan\psi\sin\theta_1\right)"
GENERAL = (
    r"x_R = x_I + d \left( \left(\frac{\tan\psi}{\cos\phi} s_{23}^A - \tan\phi c_{23}^A\right) "
    r"\cos\theta_1 + \sin\theta_1 \right)",
    r"y_R = y_I - d \left( \cos\theta_1 - \left(\frac{\tan\psi}{\cos\phi} s_{23}^A - \tan\phi "
    r"c_{23}^A\right) \sin\theta_1 \right)",
    r"z_R = z_I - d \left(\frac{\tan\psi}{\cos\phi} c_{23}^A + \tan\phi s_{23}^A\right)",
)
"""The right tip for any yaw and roll about the fore-arm."""


def state(d: Derivation, r: Robot, printed: Notation) -> None:
    """Sections 3.2 and 3.3, up to the length of the wrist."""
    symmetric_motions(d, r, printed)
    point_from_tips(d, r, printed)
    averages(d, r, printed)


def symmetric_motions(d: Derivation, r: Robot, printed: Notation) -> None:
    """What section 3.2 says about the motions before eq. (3)."""
    claim = partial(d.claim, where=POINT, notation=printed)
    m, q = r.m, r.q
    sines = real("s_alpha"), real("s_beta")
    # the gap of the tips is linear in the sines of the half differences of the arms' angles
    upper, fore = r.A2, r.A2 + r.A3
    u = (-m.L1 * sin(upper), m.L1 * cos(upper))
    v = (m.L2 * cos(fore) - m.a3 * sin(fore), m.L2 * sin(fore) + m.a3 * cos(fore))
    gap = [a * sines[0] + b * sines[1] for a, b in zip(u, v, strict=True)]
    wanted = [m.d * tan(r.psi), m.d * tan(r.phi)]
    alpha, beta = real("alpha"), real("beta")
    halves = {sines[0]: sin(alpha), sines[1]: sin(beta)}
    claim(
        "unique angles",
        "“Such motions are selected so that {unique} shoulders' and elbows' joint angles can be "
        "found that yield the given yaw and roll angles.”",
        phrases=[{"unique": 1, "two": 2}],
        readings=[
            Reading(
                "for given averages, among half differences of at most a right angle, which their "
                "sines determine",
                lambda n: Count(
                    [a - b for a, b in zip(gap, wanted, strict=True)], sines, n, given={}
                ),
            ),
            Reading(
                "for given averages, among all half differences",
                lambda n: Count(
                    [a.subs(halves) - b for a, b in zip(gap, wanted, strict=True)],
                    (alpha, beta),
                    n,
                ),
            ),
        ],
    )
    claim(
        "roll and waist",
        "“Since the rolling motion is {indepedent} of the waist angle, Fig. 3(b) shows the "
        "projection for a pure rolling motion for”",
        lambda judged: judged(Identity(r.tangents["roll"].diff(q.theta1), sp.S.Zero)),
        phrases=[{"indepedent": lambda check: check, "dependent": Not}],
    )
    claim(
        "actuator of the pitch",
        "“Note that the pitching motion is provided by a {separate} actuator located at the "
        "wrist.”",
        lambda judged: judged(
            Identity([e.diff(q.theta) for e in (*r.right, *r.left)], [sp.S.Zero] * 6)
        ),
        phrases=[{"separate": lambda check: check, "common": Not}],
    )


def off_the_middle(r: Robot, yaw: sp.Expr) -> sp.Expr:
    """The distance of (7) from the middle of the tips, with a level fore-arm and without roll."""
    m, fore = r.m, r.A2 + r.A3
    at = r.example | {r.A2: pi / 3, r.A3: pi / 6}
    upper_by, fore_by, apart = (
        sp.Matrix(vector).subs(at)
        for vector in (
            [-m.L1 * sin(r.A2), m.L1 * cos(r.A2)],
            [m.L2 * cos(fore) - m.a3 * sin(fore), m.L2 * sin(fore) + m.a3 * cos(fore)],
            [m.d * sp.tan(yaw), 0],  # half of the vector between the tips of the arms
        )
    )
    sines = sp.Matrix.hstack(upper_by, fore_by).inv() * apart
    lost = [1 - sp.sqrt(1 - s**2) for s in sines]
    along = [sp.Matrix([-v[1], v[0]]) for v in (upper_by, fore_by)]  # the links have these lengths
    return (lost[0] * along[0] + lost[1] * along[1]).norm()


def wrong_averages(d: Derivation, r: Robot) -> None:
    """What is wrong in (7)."""
    d.erratum(
        "averages",
        "The averages of the joint angles do not give the middle of the tips",
        Gravity.MOTION,
        why=r"By (6) the invariant point is the middle of the tips.  If the arms differ, the links "
        r"to that point are shortened: $L_1$ by the cosine of half the difference of the shoulder "
        r"angles, $L_2$ and $a_3$ by that of half the difference of the $\theta_{23}$.  So (7), "
        "and the left arm computed from the averages, hold only approximately.",
        use="The error is of second order in the differences of the arms.  For $L_1 = [L1]$ m, "
        r"$L_2 = [L2]$ m, $a_3 = [a3]$ m, $d = [d]$ m, $\theta_2^A = 60^\circ$ and a level "
        "fore-arm it is [some] mm at 15 degrees of yaw, and [more] mm at 30 degrees.",
        numbers={
            **{name: (r.example[getattr(r.m, name)], 2) for name in ("L1", "L2", "a3", "d")},
            "some": (1000 * off_the_middle(r, pi / 12), 1),
            "more": (1000 * off_the_middle(r, pi / 6), 1),
        },
    )


def wrong_frames(d: Derivation, r: Robot) -> None:
    """What is wrong in (3) to (5)."""
    d.erratum(
        "roll-sign",
        "The roll of (3) has the opposite sign of the roll of (9)",
        Gravity.MOTION,
        why=r"In (3) a positive $\phi$ lifts the right tip: $z_R = z_I + d\tan\phi$.  In (9) the "
        r"wrist is turned by $+\phi$ about the axis of the fore-arm, which points away from the "
        "robot, so the right tip goes down.  The two cannot be the same angle.",
        use="The inverse takes the tip from (9) and the arms from (3): the robot rolls by "
        r"$-\phi$ where $+\phi$ is asked for.  Changing the sign of $\phi$ in one of the two "
        "corrects this.",
    )
    d.erratum(
        "yaw-roll-axes",
        "Yaw and roll are measured against the base in (3) to (5), but against the fore-arm in (9)",
        Gravity.MOTION,
        why="Eqs. (3) to (5) are read from Fig. 3, which shows pure yaw and pure roll in the "
        "planes of the base.  Eq. (9) turns the wrist about the axes of the fore-arm.  If yaw or "
        "roll differs from zero, the two agree, apart from the sign in (3), only if the other one "
        "is zero and the fore-arm is level; the inverse uses (3) and (4) for all postures.",
        use=r"For $d = [d]$ m, 10 degrees of yaw and a fore-arm at $\theta_{23} = 45^\circ$, (4) "
        "puts the right tip [gap] mm from where (9) puts it; the distance grows with yaw and "
        "roll.",
        numbers={
            "d": (r.example[r.m.d], 2),
            "gap": (1000 * r.example[r.m.d] * sp.tan(pi / 18) * 2 * sp.sin(pi / 8), 0),
        },
    )


def point_from_tips(d: Derivation, r: Robot, printed: Notation) -> None:
    """Eqs. (3) to (6)."""
    names = {f"{axis}_{point}": real(f"{axis}_{point}") for axis in "xyz" for point in "IRL"}
    plain = printed.extended(names)
    centre = [names[f"{axis}_I"] for axis in "xyz"]

    def tips(**at: sp.Expr) -> dict[str, sp.Expr]:
        """The tips on the line through the invariant point that the frames of (9) give."""
        line = r.half_line.subs({real(n): e for n, e in at.items()}, simultaneous=True)
        ends = {"R": 1, "L": -1}
        return {
            f"{axis}_{side}": centre[k] + sign * line[k]
            for side, sign in ends.items()
            for k, axis in enumerate("xyz")
        }

    level = {r.A23.name: pi / 2}
    by_fore_arm = {"s_{23}^A": sin(r.A23), "c_{23}^A": cos(r.A23)}
    claim = partial(d.claim, where=POINT, notation=plain.extended(by_fore_arm))

    def agree(*relations: Relation | tuple[Relation, ...]) -> Check:
        parts = [e for f in relations for e in (f if isinstance(f, tuple) else (f,))]
        names = ("the left side", "the right side, with the tips by the frames of (9),")
        sides = [e.left for e in parts], [e.right for e in parts]
        return Agree(*(sides if len(parts) > 1 else (s[0] for s in sides)), names)

    drawn = "from Fig. 3(b), the coordinate [...] is given by "
    claim(
        "eq. (3)",
        f"{drawn}${EQ3}$",
        agree,
        corrected=drawn + r"$z_I = z_R + d\tan\phi, \ z_I = z_L - d\tan\phi$",
        erratum="roll-sign",
        readings=[
            Reading("the roll of (9), for a level fore-arm as in Fig. 3(b)", means=tips(**level)),
            Reading(
                "(3) alone defines the roll: then the point is in the middle, as in (6)",
                lambda pair: Identity(
                    sum(e.left - e.right for e in pair),
                    2 * centre[2] - names["z_R"] - names["z_L"],
                ),
            ),
        ],
    )
    pure = tips(**level, phi=sp.S.Zero)
    assumption = "the fore-arm is level, so that its axes and those of the base have the same yaw"
    for label, before, text in (
        ("eq. (4a)", "From the triangles [...], it can be shown that ", EQ4A),
        ("eq. (4b)", "", EQ4B),
        (
            "eq. (5a)",
            "Since the left-hand part of the wrist assembly is symmetric, the relations ",
            EQ5A,
        ),
        ("eq. (5b)", "", EQ5B),
    ):
        claim(
            label,
            f"{before}${text}$",
            erratum="yaw-roll-axes",
            readings=[
                Reading(
                    "pure yaw, as Fig. 3(a) shows it",
                    lambda f: Under(Equal(f), assumption),
                    pure,
                ),
                Reading("any yaw and roll, as the inverse uses it", agree, tips()),
            ],
        )
    used = plain.extended(tips())
    claim(
        "use of (3) and (4)",
        "“the coordinates (x, y, z)_R are calculated using the relations {(3) and (4)}.”",
        lambda *pieces: agree(*(e for p in pieces for e in (p if isinstance(p, tuple) else (p,)))),
        where="4 Inverse Kinematics",
        means=tips(),
        phrases=[
            {
                "(3) and (4)": (used.read(EQ3)[0], *used.read(EQ4A), *used.read(EQ4B)),
                "(5)": (*used.read(EQ5A), *used.read(EQ5B)),
            }
        ],
        corrected="“the coordinates (x, y, z)_R are calculated using the relations "
        + ", ".join(f"${text}$" for text in GENERAL)
        + "”",
        erratum="yaw-roll-axes",
    )
    by_tips = {}
    for text, tip in zip((EQ4A, EQ4B, EQ5A, EQ5B), ("x_R", "y_R", "x_L", "y_L"), strict=True):
        (relation,) = plain.read(text)
        by_tips[tip] = names[tip] + relation.left - relation.right
    for relation, tip in zip(plain.read(EQ3), ("z_R", "z_L"), strict=True):
        by_tips[tip] = names[tip] + relation.left - relation.right
    d.claim(
        "eq. (6)",
        "Thus, these relations lead to the simple results "
        r"$x_I = \frac{x_R + x_L}{2}, \ y_I = \frac{y_R + y_L}{2}, \ z_I = \frac{z_R + z_L}{2}$",
        where=POINT,
        notation=plain,
        means=by_tips,
    )


def averages(d: Derivation, r: Robot, printed: Notation) -> None:
    """Eq. (7) and the virtual arm."""
    m, (upper, fore) = r.m, (real("delta_2"), real("delta_{23}"))
    sides = {"R": 1, "L": -1}
    differing: dict[str, Any] = {
        r"\delta_2": upper,
        r"\delta_{23}": fore,
    }
    points = {}
    for side, sign in sides.items():
        second = r.A2 + sign * upper
        third = r.A2 + r.A3 + sign * fore - second
        differing[rf"\theta_2^{side}"] = second
        differing[rf"\theta_{{23}}^{side}"] = second + third
        points[side] = r.planar_tip(second, second + third, sign * m.d)
    middle = (points["R"] + points["L"]) / 2
    differing |= {f"{axis}_I": e for axis, e in zip("xyz", middle, strict=True)}
    names = printed.extended(differing)
    claim = partial(d.claim, where=POINT, notation=names)
    planar = (
        r"\left[L_1 c_2^A + L_2 s_{23}^A + a_3 c_{23}^A \right]",
        r"\left[L_1 \cos\frac{\theta_2^R - \theta_2^L}{2} c_2^A + "
        r"\cos\frac{\theta_{23}^R - \theta_{23}^L}{2} (L_2 s_{23}^A + a_3 c_{23}^A) \right]",
    )
    for label, text, corrected in (
        ("eq. (7a)", rf"x_I = c_1 {planar[0]}", rf"x_I = c_1 {planar[1]}"),
        ("eq. (7b)", rf"y_I = s_1 {planar[0]}", rf"y_I = s_1 {planar[1]}"),
        (
            "eq. (7c)",
            r"z_I = d_1 + L_1 s_2^A - L_2 c_{23}^A + a_3 s_{23}^A",
            r"z_I = d_1 + L_1 \cos\frac{\theta_2^R - \theta_2^L}{2} s_2^A + "
            r"\cos\frac{\theta_{23}^R - \theta_{23}^L}{2} (a_3 s_{23}^A - L_2 c_{23}^A)",
        ),
    ):
        claim(
            label,
            f"${text}$",
            lambda f: Equal(f, small=(upper, fore)),
            corrected=f"${corrected}$",
            erratum="averages",
        )
    virtual = r.planar_tip(r.A2, r.A2 + r.A3, sp.S.Zero)
    shift = sp.Matrix([real(f"u_{axis}") for axis in "xyz"])
    place = sp.Matrix([real(f"{axis}_I") for axis in "xyz"])
    claim(
        "invariant to the motions",
        "“the fact that the point (x, y, z)_I is {invariant} to the reflectivesymmetric motions”",
        phrases=[{"invariant": lambda check: check, "not invariant": Not}],
        readings=[
            Reading(
                "if the tips move symmetrically about the point, it stays in their middle",
                lambda judged: judged(Identity(((place + shift) + (place - shift)) / 2, place)),
            ),
            Reading(
                "if the averages of the angles stay, the middle of the tips stays",
                lambda judged: judged(Identity(middle, virtual)),
            ),
        ],
    )

    ahead = {r.q.theta1: 0}  # the waist turns all tips alike

    def virtual_arm(lengths: str, angles: Any, reached: sp.Matrix, **how: Any) -> Check:
        links = {"L_1 and L_2": (m.L1, m.L2), "L_2 and L_1": (m.L2, m.L1)}[lengths]
        swapped = dict(zip((m.L1, m.L2), links, strict=True))
        arm = virtual.subs(swapped, simultaneous=True).subs(angles, simultaneous=True)
        return Identity(
            reached.subs(ahead), arm.subs(ahead), names=("the point", "the tip of that arm"), **how
        )

    seventh = [rf"c_1 {planar[0]}", rf"s_1 {planar[0]}"]
    seventh.append("d_1 + L_1 s_2^A - L_2 c_{23}^A + a_3 s_{23}^A")
    by_seven = sp.Matrix([printed.value(text) for text in seventh])
    choices = [
        {name: name for name in ("L_1 and L_2", "L_2 and L_1")},
        {"averages": {}, "sums": {r.A2: 2 * r.A2, r.A3: 2 * r.A3}},
    ]
    d.claim(
        "virtual arm",
        "“From (7), it is clear that the link lengths of this virtual mechanism are {L_1 and L_2} "
        "and that its joint angles are the {averages} of the respective actual joint angles.”",
        where=SERIAL,
        notation=names,
        phrases=choices,
        readings=[
            Reading("the arm whose tip is given by (7)", lambda n, a: virtual_arm(n, a, by_seven)),
            Reading(
                "the arm whose tip is the middle of the tips, (6)",
                lambda n, a: virtual_arm(n, a, middle, small=(upper, fore)),
            ),
        ],
    )
    claim(
        "equivalent mechanism",
        "“an equivalent serial mechanism lying in the {midplane} of the actual twin arms and whose "
        "fore-arm tip has the coordinates [...] can be constructed.”",
        lambda side: Identity(
            r.lateral.dot(r.arm_tip(r.A2, r.A3, sp.S.Zero)), r.lateral.dot(middle) + side
        ),
        where=SERIAL,
        phrases=[{"midplane": sp.S.Zero, "plane": m.d}],
    )
    required = 2 * virtual - r.planar_tip(r.A2 + upper, r.A2 + r.A3 + fore, m.d)
    by_average = r.planar_tip(r.A2 - upper, r.A2 + r.A3 - fore, -m.d)
    d.claim(
        "only one set of angles",
        "“Since the average of the twin shoulder and elbow angles, [...], respectively, are known, "
        "it is sufficient to find {only one set} of angles,”",
        where="4 Inverse Kinematics",
        notation=names,
        phrases=[{"only one set": by_average, "both sets": required}],
        corrected="“Since the average of the twin shoulder and elbow angles, [...], respectively, "
        "are known, it is sufficient to find {both sets} of angles,”",
        erratum="averages",
        readings=[
            Reading(
                "the known angles are those of (13) and (14), of the arm that reaches the "
                "invariant point; the left tip then has to be where (3) to (5) put it",
                lambda left: Identity(
                    left.subs(ahead),
                    required.subs(ahead),
                    small=(upper, fore),
                    names=("the left tip", "the tip opposite the right one"),
                ),
            ),
            Reading(
                "the averages are those of the joint angles",
                lambda left: Identity(
                    sp.Matrix([2 * r.A2 - (r.A2 + upper)]),
                    sp.Matrix([r.A2 - upper]),
                ),
            ),
        ],
    )
