"""Claims of Rao and Raju about the wrist: its length, the tip, and its design."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import sympy as sp
from closedform.derivations.claims.h6ar_forward import SERIAL
from closedform.derivations.claims.h6ar_robot import Robot
from closedform.derivations.h6ar_mechanism import arm_frames, product
from sympy import Rational, cos, pi, sqrt
from sympy.core.relational import Relational

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Every,
    Exists,
    ForAll,
    Gravity,
    Identity,
    Not,
    Notation,
    Reading,
    Relation,
    Undecidable,
    equal,
    real,
)

WRIST = "3.4 Wrist"
ALPHA = real("alpha")
"""The ratio of (8)."""
LENGTH = (
    r"$l_W = \sqrt{(\alpha l)^2 - \frac{(\alpha d)^2}{\cos^2 \psi}}, \ "
    r"\alpha = 1 - \frac{g_s \cos(\psi)}{d}$"
)


def state(d: Derivation, r: Robot, printed: Notation) -> None:
    """The end of section 3.3, and section 3.4."""
    length(d, r, printed)
    tip(d, r, printed)
    design(d, r, printed)


def error(d: Derivation, r: Robot) -> None:
    """What is wrong in (8) and (10)."""
    yawed = wrist_length(r).subs(r.example).subs(r.psi, pi / 6)
    half_line = (r.half_base - r.m.gs).subs(r.example).subs(r.psi, pi / 6)
    flat, steep = (half_line.subs(r.phi, roll) for roll in (0, pi / 6))
    d.erratum(
        "roll-in-wrist",
        "The wrist is computed and designed for pure yaw; roll makes its base line longer",
        Gravity.MOTION,
        why=r"The tips are $2d/\cos\psi$ apart if the robot yaws, but "
        r"$2d/(\cos\psi\cos\phi)$ if it also rolls.  The wrist links then lie flatter: $l_W$ in "
        "(8) is too long, and the links that (10) asks for are too short.  For $d = 1$, "
        "$g_s = 1/2$ and 60 degrees of yaw, of roll and of the smallest separation angle, (10) "
        "admits $\\alpha l = 3$; but half the line between the tips is "
        r"$d/(\cos\psi\cos\phi) = 4$, so a link has to be longer than $4 - g_s = 3.5$.",
        use="The tip is misplaced whenever the robot rolls.  At 30 degrees of yaw and roll the "
        "wrist of the example ($d = [d]$ m, $\\alpha l = [al]$ m, $g_s = [gs]$ m) is [gap] mm "
        "shorter than by (8).  The shortest wrist links that (10) allows can reach their singular "
        "configuration before both angles are at their limits.  For limits of 30 degrees and this "
        r"$g_s$, they do if $\beta_{\min}$ is below [enough] degrees.",
        numbers={
            **{name: (r.example[getattr(r.m, name)], 2) for name in ("d", "al", "gs")},
            "enough": (sp.acos(flat / steep) * 180 / pi, 1),
            "gap": (1000 * (yawed.subs(r.phi, 0) - yawed.subs(r.phi, pi / 6)), 0),
        },
    )


def wrist_length(r: Robot) -> sp.Expr:
    """From the base line to the gears: a wrist link and half the base line less half the gears."""
    return sqrt(r.m.al**2 - (r.half_base - r.m.gs) ** 2)


def length(d: Derivation, r: Robot, printed: Notation) -> None:
    """Eq. (8)."""
    m = r.m
    claim = partial(d.claim, where=SERIAL, notation=printed.extended({r"\alpha": ALPHA}))
    gears = real("l_W")
    names = {"l_W": gears, "L_W": sqrt((gears + m.loff) ** 2)}
    claim(
        "wrist as one link",
        "“the wrist assembly that undergoes the roll and yaw can be reduced to an equivalent "
        "single link of length $L_W = (l_W + l_{off})$”",
        lambda f: Identity(f.left**2, f.right**2),
        means=names,
    )

    def given(angles: tuple[sp.Symbol, ...], formulas: tuple[Relation, ...]) -> Check:
        first, ratio = formulas
        value = first.right.subs(ratio.left, ratio.right)
        return Every(
            {
                "the length depends on these angles": Enumeration(
                    [a.name for a in angles],
                    lambda: [a.name for a in (r.psi, r.phi) if not equal((value**2).diff(a), 0)],
                    "the length depends on",
                ),
                "the formula is the length of the closed wrist": Identity(
                    value, first.left, names=("the right side", "the length of the closed wrist")
                ),
            }
        )

    angles = {"yaw angle": (r.psi,), "yaw and roll angles": (r.psi, r.phi)}
    before = "using simple geometric relations, it can be shown that the length "
    claim(
        "eq. (8)",
        before + "[...] is dependent on the {yaw angle} and is given by " + LENGTH,
        given,
        means={"l_W": wrist_length(r)},
        phrases=[angles],
        corrected=before + "[...] is dependent on the {yaw and roll angles} and is given by "
        r"$l_W = \sqrt{(\alpha l)^2 - \frac{(\alpha d)^2}{\cos^2 \psi \cos^2 \phi}}, \ "
        r"\alpha = 1 - \frac{g_s \cos(\psi) \cos(\phi)}{d}$",
        erratum="roll-in-wrist",
        readings=[
            Reading("for the roll and yaw that the wrist undergoes"),
            Reading(
                "without roll, as Fig. 3(a) shows it", means={"l_W": wrist_length(r).subs(r.phi, 0)}
            ),
        ],
    )


def tip(d: Derivation, r: Robot, printed: Notation) -> None:
    """Eq. (9)."""
    m, q = r.m, r.q
    claim = partial(d.claim, where=WRIST, notation=printed)

    def frames(upper: sp.Expr, elbow: sp.Expr, side: sp.Expr) -> sp.Matrix:
        return sp.Matrix(product(arm_frames(m, q.theta1, upper, elbow, side))[:3, :3])

    virtual = frames(r.A2, r.A3, sp.S.Zero)
    other = frames(q.theta2R, q.theta3R, m.d)
    alike = {q.theta2R: r.A2, q.theta3R: r.A3}
    claim(
        "frames of the virtual arm",
        "“Note that the frames [...] have the {same} orientation as the frames [...] as shown in "
        "Fig. 2.”",
        phrases=[{"same": 1, "opposite": -1}],
        readings=[
            Reading(
                "they are assigned in the same way, as the figures show them, without yaw and roll",
                lambda side: Identity(side * virtual, other.subs(alike, simultaneous=True)),
            ),
            Reading(
                "they stay parallel when the arms differ",
                lambda side: Identity(side * virtual, other),
            ),
        ],
    )
    across, aside, along = r.beyond_elbow
    names = {r"L_\theta": -aside, "L_{2W}": along, "a_{3W}": across}
    named = printed.extended(names)
    for label, text in (
        (
            "eq. (9a)",
            r"x_T = c_1 \left(L_1 c_2^A + L_{2W} s_{23}^A + a_{3W} c_{23}^A \right) - s_1 L_\theta",
        ),
        (
            "eq. (9b)",
            r"y_T = s_1 \left(L_1 c_2^A + L_{2W} s_{23}^A + a_{3W} c_{23}^A \right) + c_1 L_\theta",
        ),
        ("eq. (9c)", r"z_T = d_1 + L_1 s_2^A - L_{2W} c_{23}^A + a_{3W} s_{23}^A"),
        (
            "eq. (9), distance from the mid-plane",
            r"L_\theta = (L_W + l_n c_\theta) c_\phi s_\psi - l_n s_\theta s_\phi",
        ),
        ("eq. (9), extended fore-arm", r"L_{2W} = L_2 + (L_W + l_p c_\theta) c_\psi"),
        (
            "eq. (9), extended offset",
            r"a_{3W} = a_3 + (L_W + l_p c_\theta) s_\phi s_\psi + l_p s_\theta c_\phi",
        ),
    ):
        claim(label, f"${text}$", notation=named)


def design(d: Derivation, r: Robot, printed: Notation) -> None:
    """Eq. (10), and what the paper says around it."""
    m = r.m
    yaw, roll = real("psi_max"), real("phi_max")
    narrow = real("k", positive=True)
    """The cosine of the smallest separation angle."""
    claim = partial(
        d.claim,
        where=WRIST,
        notation=printed.extended(
            {
                r"\psi_{\max}": yaw,
                r"\cos(\beta_{\min})": narrow,
            }
        ),
    )

    def needed(psi: sp.Expr, phi: sp.Expr) -> sp.Expr:
        """The shortest wrist link with the smallest separation angle at a yaw and a roll."""
        base = r.half_base.subs({r.psi: psi, r.phi: phi}, simultaneous=True)
        return (base - m.gs) / narrow

    ranges = {"d": m.d, "αl": m.al, "β": narrow, "g_s": m.gs}
    limit = m.d / (m.al * narrow + m.gs)  # cos(psi_max), where the links just reach
    claim(
        "ranges of yaw and roll",
        "“The yaw and roll angle ranges, [...] are decided by {the mid-plane offset, the wrist "
        "link length αl, and the separation angle β}.”",
        phrases=[
            {
                "the mid-plane offset, the wrist link length αl, and the separation angle β": (
                    "d",
                    "αl",
                    "β",
                ),
                "the arms": ("L_1", "L_2"),
            }
        ],
        readings=[
            Reading(
                "each of the three changes the ranges",
                lambda three: Enumeration(
                    three,
                    lambda: tuple(n for n in three if n in ranges and limit.has(ranges[n])),
                    "of these, the limit depends on",
                ),
            ),
            Reading(
                "nothing else changes them",
                lambda three: Enumeration(
                    three,
                    lambda: tuple(n for n, s in ranges.items() if limit.has(s)),
                    "the limit depends on",
                ),
            ),
        ],
    )
    touching = {m.d: sp.S.One, m.gs: Rational(1, 2), m.al: Rational(3, 2), r.psi: pi / 3}
    claim(
        "singular wrist",
        "“the wrist {can} assume a singular configuration for certain values of ψ within the "
        "chosen range if the wrist parameters are not properly designed.”",
        lambda judged: judged(Exists([sp.Eq(wrist_length(r).subs(r.phi, 0), 0)], among=[touching])),
        phrases=[{"can": lambda check: check, "cannot": Not}],
    )
    wide, more = real("c", positive=True), real("t", nonnegative=True)
    by_cosine = {cos(r.psi): wide + more}

    def keeps(bound: Relation) -> Check:
        """The bound is the one at the largest yaw, and this is the largest for all yaws."""
        signed = bound.left - bound.right
        if bound.signs[0] not in (">=", ">"):
            signed = -signed
        (line,) = (needed(r.psi, 0).subs(by_cosine),)
        return Every(
            {
                "it holds at the largest yaw": Identity(signed, m.al - needed(yaw, sp.S.Zero)),
                "it holds at smaller yaws": ForAll(
                    sp.Ge((line.subs(more, 0) - line) * narrow * wide * (wide + more), 0),
                    slack=[],
                ),
            }
        )

    claim(
        "eq. (10)",
        EQ10,
        keeps,
        readings=[
            Reading("for yaw alone, from (8); the next sentence takes the roll up", keeps),
            Reading(
                "for yaw and roll at their limits",
                lambda f: Identity(f.left - f.right, m.al - needed(yaw, roll)),
            ),
        ],
    )

    claim(
        "no constraints of the passive joints",
        "“Note that no angular constraints are imposed on the passive joints J_1 and J_2 .”",
        lambda: Undecidable("a choice of design: the paper gives no ranges of these joints"),
        fixed="the sentence states a choice",
    )
    keeps_apart(claim, r, printed)


class Secants(NamedTuple):
    """Of angles of the wrist below a right angle: they grow with the sizes of the angles."""

    yaw: sp.Symbol = real("sec_psi", positive=True)
    largest_yaw: sp.Symbol = real("sec_psi_max", positive=True)
    roll: sp.Symbol = real("sec_phi", positive=True)
    largest_roll: sp.Symbol = real("sec_phi_max", positive=True)
    least: sp.Symbol = real("sec_beta_min", positive=True)
    """Of the smallest separation angle."""


EQ10 = r"$\alpha l \ge \frac{d - g_s \cos(\psi_{\max})}{\cos(\psi_{\max}) \cos(\beta_{\min})}$"
BOTH = r"\cos(\psi_{\max}) \cos(\phi_{\max})"
WITH_ROLL = rf"$\alpha l \ge \frac{{d - g_s {BOTH}}}{{{BOTH} \cos(\beta_{{\min}})}}$"


def keeps_apart(claim: Callable[..., None], r: Robot, printed: Notation) -> None:
    """What follows from (10): for which yaw and roll are the wrist links never in line?

    A link is in line with the tips if half of the line between them, less half the distance of the
    gears, is as long as the link.
    """
    m, sec = r.m, Secants()
    roll, limit = real("phi"), real("phi_max")
    names = {
        r"\cos(\psi_{\max})": 1 / sec.largest_yaw,
        r"\cos(\phi_{\max})": 1 / sec.largest_roll,
        r"\cos(\beta_{\min})": 1 / sec.least,
        r"\phi": roll,
        r"\phi_{\text{max}}": limit,
        r"\sec\psi": sec.yaw,
        r"\sec\phi": sec.roll,
        r"\sec\psi_{\max}": sec.largest_yaw,
        r"\sec\phi_{\max}": sec.largest_roll,
        r"\sec\beta_{\min}": sec.least,
    }
    named = printed.extended(names)
    half_line = r.half_base.subs({cos(r.psi): 1 / sec.yaw, cos(r.phi): 1 / sec.roll})
    # 60 degrees of yaw, roll and separation
    steep = dict.fromkeys(sec, sp.Integer(2))
    steep |= {m.d: sp.S.One, m.gs: Rational(1, 2), m.al: sp.Integer(3)}

    def never_in_line(bound: Relation, rolls: Relation | None) -> Check:
        """For all yaws up to the largest, and for these rolls; without them, for no roll."""
        level = {sec.roll: sp.S.One} if rolls is None else {}
        where = [
            (m.al, bound.relational),
            (sec.largest_yaw, sp.Le(sec.yaw, sec.largest_yaw)),
            (sec.yaw, sp.Ge(sec.yaw, 1)),
            (sec.roll, sp.Ge(sec.roll, 1)),
            (sec.least, sp.Gt(sec.least, 1)),
            (m.d, sp.Gt(m.d, m.gs)),
        ]
        if rolls is not None:
            angles = {sp.Abs(roll): sec.roll, limit: sec.largest_roll}
            where.insert(1, (sec.largest_roll, rolls.relational.subs(angles)))
        return ForAll(
            sp.Gt(m.al, half_line.subs(level) - m.gs),
            where=[relation for _, relation in where],
            slack=[
                slack(symbol, relation, k)
                for k, (symbol, relation) in enumerate(where)
                if relation.has(symbol)
            ],
            among=[steep],
        )

    claim = partial(claim, notation=named)
    claim(
        "no singular wrist",
        f"“{EQ10}” “then, the wrist does {{not}} assume the singular configuration.”",
        lambda bound, judged: judged(never_in_line(bound, None)),
        phrases=[{"not": lambda check: check, "always": Not}],
        readings=[Reading("for yaw alone, as in (8); the next sentence takes the roll up")],
    )
    also = r"“This result also holds for any roll angle $|\phi| \leq \phi_{\text{max}}$.”"
    claim(
        "any roll",
        f"“{EQ10}” [...] {also}",
        never_in_line,
        corrected=f"{WITH_ROLL} [...] {also}",
        erratum="roll-in-wrist",
    )
    (bound,) = named.read(EQ10.strip("$"))
    (any_roll,) = named.read(r"|\phi| \leq \phi_{\text{max}}")
    text = (
        "“The parameters αl and β are designed so that the wrist {does not assume} a singular "
        "configuration for the allowed {%s}.”"
    )
    claim(
        "design of the wrist",
        text % "roll and yaw angles",
        lambda rolls: never_in_line(bound, rolls),
        where="2 Description of the H6AR",
        phrases=[{"roll and yaw angles": any_roll, "yaw angles": None}],
        opposites={"does not assume": "assumes"},
        readings=[Reading("by (10), the procedure to which the paper refers")],
        corrected=text % "yaw angles",
        erratum="roll-in-wrist",
    )


def slack(symbol: sp.Symbol, relation: Relational, k: int) -> tuple[sp.Symbol, sp.Expr]:
    """The symbol for the margin by which an inequality is satisfied."""
    strict = isinstance(relation, sp.Gt | sp.Lt)
    gap = real(f"gap_{k}", positive=True) if strict else real(f"gap_{k}", nonnegative=True)
    (value,) = sp.solve(relation.gts - relation.lts - gap, symbol)
    return symbol, value
