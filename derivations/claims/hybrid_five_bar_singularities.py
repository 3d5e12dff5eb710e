"""Claims of Chablat, Wenger and Angeles about singularities: sections 2.5 and 2.6."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.five_bar_postures import (
    Eq,
    FiveBar,
    Gt,
    Ne,
    Plane,
    closed_and,
    coincident,
    on_the_axis,
    range_of_CD,
    serial_by_position,
    square,
)
from sympy import cos, pi, sin

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Every,
    Exists,
    Gravity,
    Identity,
    Listing,
    Not,
    Notation,
    Reading,
    Relation,
    normal,
    real,
)


def notation(bar: FiveBar) -> Notation:
    names = {rf"\theta_{i}": t for i, t in enumerate(bar.angles, 1)}
    names |= {f"L_{i}": length for i, length in enumerate(bar.lengths)}
    return Notation(names | {r"\mathbf{A}": bar.A, "k": K})


def parallel(d: Derivation, bar: FiveBar) -> None:
    """Section 2.5."""
    claim = partial(d.claim, where="2.5 The parallel singularities", notation=notation(bar))
    L2 = bar.lengths[2]
    t4, t5 = bar.angles[3:]
    det = normal(bar.A.det())
    claim(
        "inside the workspace",
        "“Parallel singularities occur when the determinant of the direct kinematics matrix”"
        " [...] “vanishes, the corresponding singular configurations occurring {inside} the "
        "workspace.”",
        lambda where: Exists(
            [Eq(coincident().cross, 0), *coincident().closed().values(), *where(coincident())],
            among=[{}],
            never=within_reach(bar),
        ),
        phrases=[{"inside": lambda at: at.interior().values(), "outside": outside}],
    )

    def unresisted(directions: int) -> Check:
        kinds = {"C, P and D in line": {t5: t4 + pi}, "C and D coincide": {t5: t4}}
        return Every(
            {
                kind: Enumeration(
                    directions,
                    lambda at=at: 3 - bar.A.subs(at).applyfunc(normal).rank(),
                    "independent forces on P that no torque of the motors balances",
                )
                for kind, at in kinds.items()
            }
        )

    claim(
        "efforts in some direction",
        "“They are particularly undesirable because the manipulator {can not resist efforts "
        "in some} direction(s).”",
        unresisted,
        phrases=[
            {
                "can not resist efforts in some": 1,
                "can not resist efforts in all": 3,
                "can resist efforts in every": 0,
            }
        ],
    )
    claim(
        "eq. (6)",
        r"$\mathbf{A} \mathbf{A}^T \equiv L_2^2 \begin{bmatrix} 1 & 0 & 0 \\ 0 & 1 & "
        r"\cos(\theta_4 - \theta_5) \\ 0 & \cos(\theta_4 - \theta_5) & 1 \end{bmatrix}$",
    )
    d.erratum(
        "half-turns",
        "Parallel singularities occur at multiples of $\\pi$, not of $\\pi/2$",
        Gravity.MISPRINT,
        why="By (6), the determinant of $\\mathbf{A}\\mathbf{A}^T$ is $L_2^6 \\sin^2(\\theta_4 - "
        "\\theta_5)$.  For odd k the printed condition gives CP and DP at right angles, where "
        "$\\mathbf{A}\\mathbf{A}^T = L_2^2 \\mathbf{1}$: the best conditioned postures.  "
        "Section 3.4 has the right multiples.",
        use="A planner that excludes the printed angles excludes the isotropic postures too.  It "
        "does not miss any singularity.",
    )

    def singular_at(formula: Relation) -> Check:
        at = sp.solve(formula.left - formula.right, t4)[0]
        turns = {sp.Mod(formula.right.subs(K, i), 2 * pi) for i in range(-4, 5)}
        return Every(
            {
                "for an integer k": at_multiples(bar, det, at, "$\\det \\mathbf{A}$"),
                "and nowhere else": Enumeration(
                    set(), lambda: {sp.S.Zero, pi} - turns, "zeros of the sine that are left out"
                ),
            }
        )

    claim(
        "k(π/2), after eq. (6)",
        "“these singularities occur whenever  $\\theta_4 - \\theta_5 = k(\\pi/2)$ , for an integer "
        "k”",
        singular_at,
        corrected="“these singularities occur whenever  $\\theta_4 - \\theta_5 = k\\pi$ , for an "
        "integer k”",
        erratum="half-turns",
    )
    AC, _, CP, DP = bar.bars
    claim(
        "aligned",
        "“i.e., when the points {C, D and P} are aligned”",
        lambda area: Identity(L2 * area, det),
        phrases=[{"C, D and P": bar.turned_by(CP, DP), "A, C and P": bar.turned_by(AC, CP)}],
    )
    chord = CP - DP  # CD, since the loop is closed
    claim(
        "no effort across DC",
        "“In such configurations, the manipulator {cannot} resist an effort in the "
        "{orthogonal} direction of DC (Figure 5).”",
        lambda free: Identity((bar.A * free).subs(t5, t4 + pi), sp.zeros(3, 1)),
        phrases=[{"orthogonal": bar.k.cross(chord), "same": chord}],
        opposites={"cannot": "can"},
    )
    free = real("phi")

    def circles(centre: sp.Matrix) -> Check:
        round_it = centre + DP.subs(t5, free)
        on_circle = dict(zip(bar.p, round_it, strict=True))
        met = dict(zip(bar.p, bar.elbows[1], strict=True))
        over_c = (sum((bar.p - bar.elbows[1]).applyfunc(lambda e: e**2)) - L2**2) / 2
        return Every(
            {
                "the leg over D allows every angle": Identity(
                    bar.loop[2].subs(on_circle), sp.S.Zero
                ),
                "the linkage stays in its plane": Identity(bar.loop[0].subs(on_circle), 0),
                "the leg over C has the same equation": Every(
                    {
                        "it is a circle": Identity(over_c, bar.loop[2]),
                        "its centre is where C and D meet": Identity(
                            over_c.subs(met), -(L2**2) / 2
                        ),
                    }
                ),
            }
        )

    claim(
        "C and D coincide",
        "“when the points C and D coincide, the position of P is {no longer} controllable since P "
        "can rotate freely around {D} even if the actuated joints are locked (Figure 6).”",
        circles,
        phrases=[{"D": bar.elbows[1], "B": bar.pivots[1]}],
        opposites={"no longer": "still"},
    )
    claim(
        "by design or by path-planning",
        "“It will be shown in § 3.2 and § 3.3 that parallel singularities {can} be avoided either "
        "by design or by path-planning.”",
        lambda judged: judged(
            Every({"by design": by_design(bar), "by path-planning": by_path_planning()})
        ),
        phrases=[{"can": lambda check: check, "cannot": Not}],
    )


def outside(at: Plane) -> list[sp.Expr]:
    _, L1, L2 = at.lengths
    return [Gt(square(at.P), (L1 + L2) ** 2)]


def within_reach(bar: FiveBar) -> Check:
    """AP is at most L1 + L2 in all postures."""
    _, L1, L2 = bar.lengths
    _, t2, _, t4, _ = bar.angles
    p = bar.by_legs[0]
    return Identity((L1 + L2) ** 2 - p.dot(p), 2 * L1 * L2 * (1 - cos(t4 - t2)))


def by_design(bar: FiveBar) -> Check:
    """There are lengths for which CD is never 0 nor 2 L2, and the loop closes."""
    L0, L1, L2 = bar.lengths
    good = [Gt(L0, 2 * L1), Gt(2 * L2, L0 + 2 * L1)]
    return Every({**range_of_CD(bar), "for these lengths": Exists(good)})


def by_path_planning() -> Check:
    """Another working mode for the same P is regular."""
    posture = coincident()
    other = posture.other_mode()
    return Every(
        {
            "one working mode is singular": closed_and(posture, det_A=Eq(posture.cross, 0)),
            "another is regular for this P": closed_and(other, det_A=Ne(other.cross, 0)),
        }
    )


K = sp.Symbol("k", integer=True)


def at_multiples(bar: FiveBar, value: sp.Expr, angle: sp.Expr, name: str) -> Check:
    """An expression vanishes if theta4 has a value that depends on k, for every integer k.

    The value is a multiple of k, so four values of k stand for all of them.
    """
    theta4 = bar.angles[3]
    several = {f"for k = {k}": value.subs(theta4, angle.subs(K, k)) for k in (1, 2, 3, 4)}
    return Identity(
        list(several.values()),
        [sp.S.Zero] * 4,
        names=(name, "that of singular matrices"),
        postures=bar.postures({theta4: angle.subs(K, 1)}),
        parts=list(several),
    )


AXIS_TOO = "on-the-axis"


def serial(d: Derivation, bar: FiveBar) -> None:
    """Section 2.6."""
    claim = partial(d.claim, where="2.6 The serial singularities", notation=notation(bar))
    _, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    over_c = bar.A * sp.Matrix.hstack(*(bar.by_legs[0].diff(t) for t in (t1, t2, t4)))
    over_d = bar.A * sp.Matrix.hstack(*(bar.by_legs[1].diff(t) for t in (t1, t3, t5)))
    cases = {
        "P on AB, along the normal": (over_c[0, :], {sin(t2): -L2 / L1 * sin(t4)}),
        "AC and CP in line, along CP": (over_c[1, :], {t4: t2}),
        "the same, folded": (over_c[1, :], {t4: t2 + pi}),
        "BD and DP in line, along DP": (over_d[2, :], {t5: t3}),
        "the same, folded back": (over_d[2, :], {t5: t3 + pi}),
    }
    claim(
        "no velocity in one direction",
        "“Serial singularities occur when the determinant of the inverse kinematics matrix” [...] "
        "“vanishes. When the manipulator is in such a singularity there exists {a direction} along "
        "which {no} Cartesian velocity can be produced (Figure 7).”",
        lambda directions, speed: Every(
            {
                **{
                    n: Identity(row.subs(at), speed * sp.ones(1, 3))
                    for n, (row, at) in cases.items()
                },
                "one direction is lost with one entry of $\\mathbf{B}$": Enumeration(
                    directions,
                    lambda: 3 - sp.diag(0, bar.B[1, 1], bar.B[2, 2]).rank(),
                    "directions that are lost with one entry of $\\mathbf{B}$",
                ),
            }
        ),
        phrases=[{"a direction": 1, "a plane of directions": 2}, {"no": 0, "a": 1}],
    )
    legs = {"AC and CP aligned", "BD and DP aligned"}
    d.erratum(
        AXIS_TOO,
        "The serial singularities on the axis AB, inside the workspace, are missing",
        Gravity.OMISSION,
        why="The first entry of (4) is $L_2$ times the distance $L_1 \\sin(\\theta_2) + L_2 "
        "\\sin(\\theta_4)$ of P from the line AB.  If P is on AB, $\\mathbf{B}$ is singular, "
        "and P cannot move at right angles to the plane of the linkage.  AB passes through "
        "the workspace: for $L_0 = 7$, $L_1 = 8$, $L_2 = 5$ the point with AP = BP = 7/2 is "
        "inside.  So the sentence of section 3.1 that all singularities lie at the border is right "
        "for the linkage in its plane only.",
        use="A path inside the workspace that meets AB needs an unbounded rate of $\\theta_1$ near "
        "it, unless it keeps to the plane of the linkage.  A planner that guards the boundary only "
        "does not notice.",
    )
    posture = on_the_axis()

    def listed(named: frozenset[str]) -> Check:
        return Every(
            {
                "the list of the paper": Listing(
                    named, bar.serial_cases, r"postures at which an entry of $\mathbf{B}$ vanishes"
                ),
                "aligned bars are at the boundary": serial_by_position(bar),
                "P can be on AB inside": closed_and(
                    posture, rho=Eq(posture.P[1], 0), **posture.interior()
                ),
            }
        )

    claim(
        "serial singularities at the boundary",
        "“Such singularities are reached” [...] “{at the boundary of the workspace when BD and DP "
        "or AC and CP are aligned}.”",
        listed,
        phrases=[
            {
                "at the boundary of the workspace when BD and DP or AC and CP are aligned": (
                    frozenset(legs)
                ),
                "when P is on AB, and at the boundary of the workspace when BD and DP or AC and CP "
                "are aligned": frozenset({*legs, "P on AB"}),
            }
        ],
        corrected="“Such singularities are reached” [...] “{when P is on AB, and at the boundary "
        "of the workspace when BD and DP or AC and CP are aligned}.”",
        erratum=AXIS_TOO,
    )
    half, beyond = real("half", positive=True), real("beyond", nonnegative=True)
    R = half + beyond
    P = sp.Matrix([half, sp.sqrt(beyond) * sp.sqrt(beyond + 2 * half)])
    stretched = Identity([square(P), square(P - sp.Matrix([2 * half, 0]))], [R**2, R**2])
    claim(
        "cannot be avoided",
        "“They {cannot} be avoided.”",
        lambda judged: judged(stretched),
        phrases=[{"cannot": lambda check: check, "can": Not}],
        readings=[
            Reading(
                "no choice of the lengths avoids them: whenever the loop can close, so "
                "$L_0 \\le 2(L_1 + L_2)$, some P is at the distance $L_1 + L_2$ from A and from B"
            )
        ],
    )
