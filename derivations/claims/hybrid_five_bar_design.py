"""What Chablat, Wenger and Angeles say of the hybrid five-bar linkage: its design."""

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
    shortest,
    signs,
    without_parallel,
)
from closedform.derivations.hybrid_five_bar_design import decrease
from sympy import Abs, cos, pi, sin, sqrt, tan

from closedform.algebra import positive_form
from closedform.claims import Enumeration, Every, Holds, Identity, Refuted, Undecidable, Under
from closedform.derivation import Derivation
from closedform.functions import real

NO_DIMENSIONS = "a figure, drawn for lengths that are not given"


def workspace(d: Derivation, bar: FiveBar) -> None:
    """Section 3.1."""
    claim = partial(d.claim, where="3.1 Workspace")
    L0, L1, L2 = bar.lengths
    t2, t4 = bar.angles[1], bar.angles[3]
    reach = L1**2 + L2**2 + 2 * L1 * L2 * cos(t4 - t2)
    claim(
        "hollow spheres",
        "the intersection of two hollow spheres of radii L1 + L2 and L1 - L2, L0 apart",
        Identity(
            ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2),
            (2 * L1 * L2 * sin(t4 - t2)) ** 2,
        ),
    )
    falls = Every({f"regime {i}": Identity(*p) for i, p in enumerate(decrease(bar.volumes), 1)})
    claim("L0 = 0", "the workspace is maximum when L0 is equal to 0", falls)
    M, m = real("M", positive=True), real("m", positive=True)
    at_zero = bar.volumes["inner balls inside, overlapping"].volume.subs(L0, 0)
    claim(
        "L1 = L2",
        "and ... when L1 is equal to L2",
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
                "both legs obey one equation, so equal signs mean C = D": Identity(
                    same_legs, sp.S.Zero
                ),
                "unequal signs are regular": Holds(
                    {**mirrored.closed(), "CP x DP is not 0": Ne(mirrored.cross, 0)}
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
            "with L0 = 0, L1 = L2 = 1 the axis is singular inside the workspace, as P = (0, 1, 0)",
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
        "if L1 + L1 is greater than L0, we eliminate a parallel singularity type (C = D)",
        Refuted(
            Holds({**default.closed(), "2 L1 > L0": sp.sympify(16 > 7)}),
            "for (7, 8, 5), 16 > 7, C and D coincide 7/2 along AB: the condition is what lets the "
            "circles of C and D meet",
            r"L_0 > 2 L_1",
            stay_apart,
        ),
    )
    small = coincident((1, 1, 2))
    claim(
        "2 L2 - 2 L1 > L0",
        "2 L2 - 2 L1 > L0 eliminates all parallel singularities",
        Refuted(
            Holds({**small.closed(), "2 L2 - 2 L1 > L0": sp.sympify(4 - 2 > 1)}),
            "for (1, 1, 2), 4 - 2 > 1, C and D coincide at theta2 = 60 and theta3 = 120 degrees; "
            "the condition keeps C, P, D from being in line, and nothing else",
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
        "in the convex working mode the manipulator is in parallel singularity",
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
            "the sign of rho, and with it the working mode, changes on the axis AB, inside the "
            "workspace",
        ),
    )
    bounds = d["ik"].bounds
    cases = d["ik"].cases
    claim(
        "twice as large",
        "by doing so, we can reach a workspace that is twice as large",
        Refuted(
            Enumeration(
                1,
                lambda: len({bounds(case) for _, case in cases()}),
                "sets of conditions on P, over the eight working modes",
            ),
            "the conditions on P hold no sign: every working mode reaches the same workspace, and "
            "a change of mode adds nothing to it",
        ),
    )
    claim(
        "not avoidable",
        "parallel singularities not being avoidable",
        Refuted(
            Holds(without_parallel(3, 1, 3)),
            "(3, 1, 3) has none; section 3.2 itself avoids them",
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
            "for L0 = 0 it is the hollow sphere of the serial arm with the same bars",
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
                "CP DP = 0": Eq(start.dot, 0),
                "turned over, not": Ne(start.other_mode().dot, 0),
            }
        ),
    )
    claim(
        "condition numbers differ: B",
        "and those of the inverse-kinematics matrix",
        Refuted(
            Identity(4 * bar.B[1, 1] ** 2, ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2)),
            "up to their signs, the entries of B depend on P alone: rho L2, and by leg the area of "
            "the triangle over AP or BP; B has one condition number in all eight working modes",
        ),
    )


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
    claim(
        "eq. (8)",
        r"$\kappa(\mathbf A) = 1/|\tan((\theta_4-\theta_3)/2)|$",
        Every(
            {
                "as printed": Identity(1 / Abs(tan((t4 - t3) / 2)), bar.kappa),
                "with theta5 for theta3": Identity(1 / Abs(tan((t4 - t5) / 2)), bar.kappa),
            }
        ),
    )
    claim(
        "surfaces of revolution",
        "these loci are surfaces of revolution",
        Identity((bar.A * bar.A.T).diff(t1), sp.zeros(3, 3)),
    )
    claim(
        "minimum of 1",
        r"$\kappa(\mathbf A)$ attains its minimum of 1 when $|\theta_3-\theta_4| = \pi/2$",
        Every(
            {
                "as printed": Identity(bar.kappa.subs(t4, t3 + pi / 2), sp.S.One),
                "with theta5 for theta3": Identity(bar.kappa.subs(t4, t5 + pi / 2), sp.S.One),
            }
        ),
    )
    claim(
        "infinity",
        r"$\kappa(\mathbf A)$ tends to infinity when $\theta_3-\theta_4 = k\pi$",
        Every(
            {
                "as printed": Identity(bar.det_A.subs(t4, t3 + pi), sp.S.Zero),
                "with theta5 for theta3": Identity(bar.det_A.subs(t4, t5 + pi), sp.S.Zero),
            }
        ),
    )
    claim(
        "isotropic",
        "its inversion being performed without any roundoff-error amplification",
        Identity((bar.A.T * bar.A).subs(t4, t5 + pi / 2) / L2**2, sp.eye(3)),
    )
    inside = coincident()
    claim(
        "define the boundary",
        "such singularities occur at the boundary of the Cartesian workspace, and the singularity "
        "locus defines this boundary",
        Refuted(
            Holds({**inside.closed(), **inside.interior(), "CP x DP = 0": Eq(inside.cross, 0)}),
            "for (7, 8, 5) C and D coincide at (7/2, sqrt(207)/2), with P inside the workspace; "
            "the boundary is where a leg is stretched or folded, a serial singularity",
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
                    "for (1, 1, 3) that is too short": Holds({"3 < 3 sqrt 2": Lt(3, 3 * sqrt(2))}),
                }
            ),
            "it takes CD = sqrt 2 L2, but CD <= L0 + 2 L1; for (1, 1, 3) 4.24 against 3",
            r"\max(0, L_0 - 2 L_1) \le \sqrt 2 L_2 \le L_0 + 2 L_1",
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
            "the distance is not defined; 1/kappa is one between matrices, not between points"
        ),
    )
