"""Claims of Chablat, Wenger and Angeles about the design of the hybrid five-bar linkage."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.five_bar_postures import (
    Eq,
    FiveBar,
    Lt,
    Ne,
    Plane,
    coincident,
    isotropic,
    longest,
    on_the_axis,
    serial,
    shortest,
    signs,
    without_parallel,
)
from closedform.derivations.hybrid_five_bar_design import decrease
from sympy import Abs, cos, pi, sin, sqrt, tan

from closedform import Derivation, positive_form, real
from closedform.proof.checks import (
    Check,
    Enumeration,
    Every,
    Holds,
    Identity,
    Refuted,
    Undecidable,
    Under,
)

NO_DIMENSIONS = "a figure for lengths that the paper does not give"


def workspace(d: Derivation, bar: FiveBar) -> None:
    """Section 3.1."""
    claim = partial(d.claim, where="3.1 Workspace")
    L0, L1, L2 = bar.lengths
    t2, t4 = bar.angles[1], bar.angles[3]
    reach = L1**2 + L2**2 + 2 * L1 * L2 * cos(t4 - t2)
    claim(
        "hollow spheres",
        "the intersection of two hollow spheres, where radii are $L_1 + L_2$ and $L_1 - L_2$, the "
        "distance between the centers of these spheres being $L_0$",
        Identity(
            ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2),
            (2 * L1 * L2 * sin(t4 - t2)) ** 2,
        ),
    )
    falls = Every({f"regime {i}": Identity(*p) for i, p in enumerate(decrease(bar.volumes), 1)})
    claim("L0 = 0", "the workspace is maximum when $L_0$ is equal to 0", falls)
    M, m = real("M", positive=True), real("m", positive=True)
    at_zero = bar.volumes["inner balls inside, overlapping"].volume.subs(L0, 0)
    claim(
        "L1 = L2",
        "and, by extrapolating the results from [7], when $L_1$ is equal to $L_2$",
        Under(
            Identity(at_zero, sp.Rational(4, 3) * pi * ((M + m) ** 3 - (M - m) ** 3)),
            "for a given reach L1 + L2; without a bound on the lengths there is no maximum",
        ),
    )
    same_legs = bar.loop[2].subs(L0, 0) - bar.loop[1].subs(bar.angles[1], bar.angles[2])
    mirrored = Plane((0, 1, 1), *(sp.Matrix(v) for v in ([0, 1], [1, 0], [1, 1])))
    claim(
        "two operative working modes",
        "the optimum manipulator has only two operative working modes because the other two lie in "
        "parallel singular configurations",
        Every(
            {
                "both legs have the same equation, so equal signs mean C = D": Identity(
                    same_legs, sp.S.Zero
                ),
                "unequal signs are regular": Holds(
                    {**mirrored.closed(), "CP and DP not in line": Ne(mirrored.cross, 0)}
                ),
            }
        ),
    )
    claim(
        "border",
        "all singularities of this mechanism lie at the border of the workspace",
        Refuted(
            Holds(
                {
                    **Plane(
                        (0, 1, 1),
                        sp.Matrix([sp.Rational(1, 2), sqrt(3) / 2]),
                        sp.Matrix([sp.Rational(1, 2), -sqrt(3) / 2]),
                        sp.Matrix([1, 0]),
                    ).closed(),
                    "0 < AP < 2": sp.sympify(0 < 1 < 2),
                }
            ),
            "for L0 = 0, L1 = L2 = 1 the points of the axis inside the workspace are singular, for "
            "example P = (0, 1, 0)",
            "the serial ones lie at the border or on AB",
            serial(bar),
        ),
    )


def by_design(d: Derivation, bar: FiveBar) -> None:
    """Section 3.2."""
    claim = partial(d.claim, where="3.2 Avoiding parallel singularities by proper design")
    L0, L1, _ = bar.lengths
    t2, t3 = bar.angles[1:3]
    CD = bar.elbows[1] - bar.elbows[0]
    a, b, w = (real(n, nonnegative=True) for n in ("a", "b", "w"))
    apart = [(cos(t3), a - 1), (cos(t2), 1 - b), (L0, 2 * L1 + w)]
    stay_apart = Identity(CD[1].subs(apart), positive_form(CD[1], apart))
    default = coincident()
    claim(
        "2 L1 > L0",
        "if the sum of lengths $L_1 + L_1$ is greater than the distance between the two pivots, "
        "$L_0$, we eliminate a parallel singularity type, C and D coinciding",
        Refuted(
            Holds({**default.closed(), "2 L1 > L0": sp.sympify(16 > 7)}),
            "for (7, 8, 5), 16 > 7, C and D coincide at 7/2 along AB: the condition makes the "
            "circles of C and D meet",
            r"L_0 > 2 L_1",
            stay_apart,
        ),
    )
    small = coincident((1, 1, 2))
    claim(
        "2 L2 - 2 L1 > L0",
        "we can eliminate all parallel singularities if the condition below is imposed: "
        "$2L_2 - 2L_1 > L_0$",
        Refuted(
            Holds({**small.closed(), "2 L2 - 2 L1 > L0": sp.sympify(4 - 2 > 1)}),
            "for (1, 1, 2), 4 - 2 > 1, C and D coincide at theta2 = 60 and theta3 = 120 degrees; "
            "the condition only prevents C, P, D from being in line",
            r"L_0 > 2 L_1 \text{ and } 2 L_2 > L_0 + 2 L_1",
            Every({"C and D stay apart": stay_apart, "CD < 2 L2": longest(bar)}),
        ),
    )


def by_change_of_mode(d: Derivation, bar: FiveBar) -> None:
    """Section 3.3."""
    claim = partial(
        d.claim, where="3.3 Avoiding parallel singularities by a change of working mode"
    )
    L0, L1, L2 = bar.lengths
    t2, t4 = bar.angles[1], bar.angles[3]
    default = coincident()
    other = default.other_mode()
    claim(
        "the posture changes",
        "according to the working mode chosen, the parallel-singularity posture changes",
        Holds(
            {
                **other.closed(),
                "singular in one mode": Eq(default.cross, 0),
                "regular in another": Ne(other.cross, 0),
            }
        ),
    )
    claim(
        "Figure 12",
        "in the convex working mode the manipulator is in parallel singularity, while it is in a "
        "regular configuration in the non-convex working mode",
        Undecidable(NO_DIMENSIONS),
    )
    claim(
        "Figures 13 and 14",
        "it is possible, by means of a change of working mode, to reach points inside the two "
        "workspace sections displayed in figures 13 and 14",
        Undecidable(NO_DIMENSIONS),
    )
    claim(
        "necessary",
        "to change working mode, it is necessary to pass through a serial singularity",
        signs(bar),
    )
    claim(
        "located at the boundary",
        "a serial singularity, located at the boundary of the Cartesian workspace",
        Refuted(
            on_the_axis(),
            "the sign of rho, and so the working mode, changes on the axis AB inside the workspace",
            "at the boundary, where a leg is stretched or folded, or on AB",
            serial(bar),
        ),
    )
    bounds = d["ik"].bounds
    cases = d["ik"].cases
    one_workspace = Enumeration(
        1,
        lambda: len({bounds(case) for _, case in cases()}),
        "sets of conditions on P, over the eight working modes",
    )
    claim(
        "twice as large",
        "by doing so, we can reach a workspace that is twice as large as each of those displayed",
        Refuted(
            one_workspace,
            "the conditions on P contain no sign: every working mode reaches the same workspace, "
            "and a change of mode adds nothing",
            "all working modes have the same workspace",
            one_workspace,
        ),
    )
    claim(
        "not avoidable",
        "parallel singularities not being avoidable",
        Refuted(
            Holds(without_parallel(3, 1, 3)),
            "(3, 1, 3) has none, and section 3.2 itself avoids them",
            r"L_0 > 2 L_1 \text{ and } 2 L_2 > L_0 + 2 L_1 \text{ avoid them}",
            Every({"C and D stay apart": shortest(bar), "CD < 2 L2": longest(bar)}),
        ),
    )
    M, m = real("M", positive=True), real("m", positive=True)
    at_zero = bar.volumes["inner balls inside, overlapping"].volume.subs(L0, 0)
    claim(
        "always smaller",
        "the workspace of a parallel manipulator is always smaller than that of its serial "
        "counterpart of the same size",
        Refuted(
            Identity(at_zero, sp.Rational(4, 3) * pi * ((M + m) ** 3 - (M - m) ** 3)),
            "for L0 = 0 it is the same hollow sphere as that of the serial arm with the same bars",
            r"V(L_0) \le V(0)",
            Every({f"regime {i}": Identity(*p) for i, p in enumerate(decrease(bar.volumes), 1)}),
        ),
    )
    start = isotropic()
    reach = L1**2 + L2**2 + 2 * L1 * L2 * cos(t4 - t2)
    claim(
        "condition numbers differ: A",
        "according to the working mode, the condition numbers of the direct- ... kinematics "
        "matrices are different",
        Holds(
            {
                **start.closed(),
                "CP and DP at right angles": Eq(start.dot, 0),
                "not so with the leg reflected": Ne(start.other_mode().dot, 0),
            }
        ),
    )
    claim(
        "condition numbers differ: B",
        "and those of the inverse-kinematics matrix",
        Refuted(
            Identity(4 * bar.B[1, 1] ** 2, ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2)),
            "up to their signs, the entries of B depend only on P: rho*L2, and for each leg twice "
            "the area of the triangle over AP or BP",
            "the condition number of B depends only on P",
            serial(bar),
        ),
    )


def half_angle(bar: FiveBar, sign: int) -> Check:
    """kappa from u, the cotangent of half the angle between CP and DP, for a sign of its cosine."""
    u = real("u", positive=True)
    cosine = Abs(cos(bar.angles[3] - bar.angles[4]))
    by_u = (bar.kappa**2).subs(cosine, sign * (u**2 - 1) / (u**2 + 1))
    return Identity(by_u, u ** (2 * sign))


def conditioning(d: Derivation, bar: FiveBar) -> None:
    """Section 3.4."""
    claim = partial(d.claim, where="3.4 The isoconditioning curves")
    L2 = bar.lengths[2]
    t1, _, t3, t4, t5 = bar.angles
    claim(
        "eq. (7)",
        r"$\kappa(\mathbf M) = \sigma_1/\sigma_s$",
        Undecidable("a definition"),
    )
    printed, right = Abs(cos(t4 - t3)), Abs(cos(t4 - t5))
    claim(
        "eigenvalues",
        r"$\alpha_1 = 1 - |\cos(\theta_4-\theta_3)|,\ \alpha_2 = 1,\ "
        r"\alpha_3 = 1 + |\cos(\theta_4-\theta_3)|$",
        Identity(
            [1 - printed, sp.S.One, 1 + printed],
            [L2**2 * (1 - right), L2**2, L2**2 * (1 + right)],
        ),
    )
    gaps = [(1 - right, sp.S.One), (sp.S.One, 1 + right)]
    claim(
        "order of the eigenvalues",
        r"$\alpha_1 \leq \alpha_2 \leq \alpha_3$",
        Identity([b - a for a, b in gaps], [right, right]),
    )
    wide = {t3: pi / 2, t4: 2 * pi / 3, t5: 0}

    def printed_kappa(angle: sp.Symbol) -> sp.Expr:
        return 1 / Abs(tan((t4 - angle) / 2))

    claim(
        "eq. (8)",
        r"$\kappa(\mathbf A) = 1/|\tan((\theta_4-\theta_3)/2)|$",
        Refuted(
            Holds(
                {
                    "as printed it is not kappa": Ne((printed_kappa(t3) / bar.kappa).subs(wide), 1),
                    "with theta5 it is the inverse": Eq(
                        (printed_kappa(t5) * bar.kappa).subs(wide), 1
                    ),
                    "which is not kappa": Ne(bar.kappa.subs(wide), 1),
                }
            ),
            "theta3 is printed instead of theta5, the angle of DP.  With theta5 the formula is "
            "right only if cos(theta4 - theta5) is not negative.  If CD is longer than sqrt(2)*L2, "
            "it gives the inverse: at theta4 = 2*pi/3, theta5 = 0 it is sqrt(3)/3, but kappa is "
            "sqrt(3)",
            r"\max(|\tan\tfrac{\theta_4-\theta_5}{2}|,\ 1/|\tan\tfrac{\theta_4-\theta_5}{2}|)",
            Every(
                {
                    "the cosine is not negative": half_angle(bar, 1),
                    "the cosine is not positive": half_angle(bar, -1),
                }
            ),
        ),
    )
    claim(
        "surfaces of revolution",
        "these loci are surfaces of revolution generated by the isoconditioning curves of the "
        "2-dof manipulator, when these are rotated about the axis of the first revolute",
        Identity((bar.A * bar.A.T).diff(t1), sp.zeros(3, 3)),
    )
    right_angle, aligned = {t3: pi / 6, t5: 0, t4: 2 * pi / 3}, {t3: 0, t5: pi / 2, t4: pi}
    claim(
        "minimum of 1",
        r"$\kappa(\mathbf A)$ attains its minimum of 1 when $|\theta_3-\theta_4| = \pi/2$",
        Refuted(
            Holds({"kappa is not 1": Ne(bar.kappa.subs(right_angle), 1)}),
            "theta3 is printed instead of theta5, as in eq. (8); kappa is sqrt(3) at "
            "theta3 = pi/6, theta4 = 2*pi/3, theta5 = 0",
            r"|\theta_5-\theta_4| = \pi/2",
            Identity(bar.kappa.subs(t4, t5 + pi / 2), sp.S.One),
        ),
    )
    claim(
        "infinity",
        r"$\kappa(\mathbf A)$ tends to infinity when $\theta_3-\theta_4 = k\pi$",
        Refuted(
            Holds({"kappa is 1": Eq(bar.kappa.subs(aligned), 1)}),
            "theta3 is printed instead of theta5; kappa is 1 at theta3 = 0, theta4 = pi, "
            "theta5 = pi/2",
            r"\theta_5-\theta_4 = k\pi",
            Identity(bar.det_A, L2**3 * sin(t5 - t4)),
        ),
    )
    claim(
        "isotropic",
        "its inversion being performed without any roundoff-error amplification",
        Identity((bar.A.T * bar.A).subs(t4, t5 + pi / 2) / L2**2, sp.eye(3)),
    )
    claim(
        "most accurate",
        "postures with a right angle are the most accurate for the direct kinematics",
        Undecidable("the paper defines accuracy only by the condition number itself"),
    )
    inside = coincident()
    claim(
        "define the boundary",
        "such singularities occur at the boundary of the Cartesian workspace, and the singularity "
        "locus defines this boundary",
        Refuted(
            Holds(
                {**inside.closed(), **inside.interior(), "CP and DP in line": Eq(inside.cross, 0)}
            ),
            "for (7, 8, 5) C and D coincide at (7/2, sqrt(207)/2), with P inside the workspace; "
            "the boundary is where a leg is stretched or folded, a serial singularity",
            r"AP, BP \in \{L_1 + L_2, |L_1 - L_2|\}",
            serial(bar),
        ),
    )
    claim(
        "isotropy regardless of the dimensions",
        "isotropy can be obtained regardless of the dimensions of the manipulator, as long as i) "
        "it is symmetric and ii) L2 is not 0",
        Refuted(
            Every(
                {
                    "CD is at most L0 + 2 L1": longest(bar),
                    "for (1, 1, 3) this is too short": Holds({"3 < 3 sqrt 2": Lt(3, 3 * sqrt(2))}),
                }
            ),
            "it needs CD = sqrt(2)*L2, but CD <= L0 + 2*L1; for (1, 1, 3) that is 4.24 against 3",
            r"\max(0, L_0 - 2 L_1) \le \sqrt{2} L_2 \le L_0 + 2 L_1",
            Every({"longest": longest(bar), "shortest": shortest(bar)}),
        ),
    )
    start = isotropic()
    other = start.other_mode()
    claim(
        "Figure 15",
        "for the two working modes, the position of the isotropic configurations are different",
        Holds(
            {
                **start.closed(),
                **other.closed(),
                "isotropic in one mode": Eq(start.dot, 0),
                "not in the other": Ne(other.dot, 0),
            }
        ),
    )
    claim(
        "equal distance",
        "isoconditioning curves are, by definition, the sets of points at equal distance from the "
        "singularities",
        Undecidable(
            "the distance is not defined; 1/kappa is a distance of matrices, not of points"
        ),
    )
