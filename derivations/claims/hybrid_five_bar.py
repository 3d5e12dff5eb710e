"""What Chablat, Wenger and Angeles say of the hybrid five-bar linkage."""

from functools import partial
from math import prod
from typing import NamedTuple

import sympy as sp
from sympy import Abs, atan2, cos, pi, sin, sqrt, tan

from closedform.claims import Check, Enumeration, Every, Holds, Identity, Refuted, Undecidable, Under
from closedform.derivation import Derivation
from closedform.derivations.hybrid_five_bar_design import Regime, decrease
from closedform.functions import real
from closedform.loops import positive_form
from closedform.solutions import count_solutions

DEFAULT = (7, 8, 5)
Eq, Ne, Lt, Gt = (partial(relation, evaluate=False) for relation in (sp.Eq, sp.Ne, sp.Lt, sp.Gt))
NO_DIMENSIONS = "a figure, drawn for lengths that are not given"


class FiveBar(NamedTuple):
    """What the derivation derived."""

    lengths: tuple[sp.Symbol, ...]
    angles: tuple[sp.Symbol, ...]
    elbows: tuple[sp.Matrix, sp.Matrix]
    by_legs: tuple[sp.Matrix, sp.Matrix]
    k: sp.Matrix
    p: tuple[sp.Symbol, ...]
    loop: tuple[sp.Expr, ...]
    A: sp.Matrix
    B: sp.Matrix
    in_plane: dict[sp.Symbol, sp.Expr]
    volumes: dict[str, Regime]

    @property
    def det_A(self) -> sp.Expr:
        return self.A.det()

    @property
    def kappa(self) -> sp.Expr:
        """The condition number of A."""
        c = Abs(cos(self.angles[3] - self.angles[4]))
        return sqrt((1 + c) / (1 - c))


def state(d: Derivation, bar: FiveBar) -> None:
    """Transcribe all claims, in the order of the paper."""
    kinematics(d, bar)
    working_modes(d, bar)
    parallel_singularities(d, bar)
    serial_singularities(d, bar)
    workspace(d, bar)
    by_design(d, bar)
    by_change_of_mode(d, bar)
    conditioning(d, bar)


def kinematics(d: Derivation, bar: FiveBar) -> None:
    """Eqs. (1a) to (5)."""
    claim = partial(d.claim, where="2.3 Kinematic relations")
    L0, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    rates = {t: real(f"rate{i}") for i, t in enumerate(bar.angles, 1)}
    j = sp.Matrix([0, 1, 0])

    def velocity(point: sp.Matrix) -> sp.Matrix:
        return sum((point.diff(t) * w for t, w in rates.items()), sp.zeros(3, 1))

    forms = []
    for label, passive, elbow, point in (("a", t4, *_leg(bar, 0)), ("b", t5, *_leg(bar, 1))):
        turned = rates[t1] * j + rates[passive] * bar.k
        form = velocity(elbow) + turned.cross(point - elbow)
        forms.append(form)
        side, angle = ("c", "4") if label == "a" else ("d", "5")
        claim(
            f"eq. (1{label})",
            rf"\dot{{\mathbf p}} = \dot{{\mathbf {side}}} + (\dot\theta_1\mathbf j + "
            rf"\dot\theta_{angle}\mathbf k)\times(\mathbf p - \mathbf {side})",
            Identity(form, velocity(point)),
        )
    rows = sp.Matrix.vstack(*(bar.A[i, :] * forms[n] for i, n in ((0, 0), (1, 0), (2, 1))))
    driven = sp.Matrix([rates[t] for t in (t1, t2, t3)])
    claim(
        "eq. (2)",
        r"\mathbf A\dot{\mathbf p} = \mathbf B\dot{\boldsymbol\theta}",
        Identity(rows, bar.B * driven),
    )
    claim(
        "eq. (3)",
        r"\mathbf A = [L_2\mathbf k^T;\ (\mathbf p-\mathbf c)^T;\ (\mathbf p-\mathbf d)^T]",
        Identity(
            sp.Matrix.vstack(L2 * bar.k.T, *((point - e).T for e, point in (_leg(bar, 0), _leg(bar, 1)))),
            bar.A,
        ),
    )
    ratio = L2 / L1
    printed = L1 * L2 * sp.diag(sin(t2) + ratio * sin(t4), sin(t2 - t4), sin(t3 - t5))
    claim(
        "eq. (4)",
        r"\mathbf B = L_1 L_2\,\mathrm{diag}(\sin\theta_2 + \lambda_1\sin\theta_4,\ "
        r"\sin(\theta_2-\theta_4),\ \sin(\theta_3-\theta_5))",
        Identity(printed, bar.B),
    )
    claim(
        "eq. (5)",
        r"\dot{\boldsymbol\theta} = [\dot\theta_1, \dot\theta_2, \dot\theta_3]^T,\ "
        r"\dot{\mathbf p} = [\dot x, \dot y, \dot z]^T",
        Undecidable("names, no statement"),
    )


def _leg(bar: FiveBar, i: int) -> tuple[sp.Matrix, sp.Matrix]:
    return bar.elbows[i], bar.by_legs[i]


def signs(bar: FiveBar) -> Check:
    """The sine between the bars of a leg has the sign of its branch: 2 sigma atan2(a, b)."""
    a, b = real("a", positive=True), real("b", positive=True)
    sigma = real("sigma")
    return Every(
        {
            f"branch {s}": Identity(
                sin(2 * sigma * atan2(a, b)).subs(sigma, s), s * 2 * a * b / (a**2 + b**2)
            )
            for s in (1, -1)
        }
    )


def working_modes(d: Derivation, bar: FiveBar) -> None:
    """Section 2.4."""
    claim = partial(d.claim, where="2.4 The working mode")
    t1, t2, t3, t4, t5 = bar.angles
    claim(
        "diagonal",
        "a diagonal inverse-kinematics matrix B",
        Identity(bar.B, sp.diag(*(bar.B[i, i] for i in range(3)))),
    )
    claim(
        "one solution each",
        "working modes are separated by a serial singularity, each with one inverse solution",
        signs(bar),
    )
    steps = ((bar.loop[0], t1, {}), (bar.loop[1], t2, bar.in_plane), (bar.loop[2], t3, bar.in_plane))
    claim(
        "eight working modes",
        "the closed chain admits eight working modes",
        Enumeration(
            8,
            lambda: prod(count_solutions([e.subs(at)], (u,)).count for e, u, at in steps),
            "solutions, by theta1 and then by leg",
        ),
    )
    mirror = {t: -t for t in (t2, t3, t4, t5)}
    diagonal = [bar.B[i, i] for i in range(3)]
    claim(
        "mirror images",
        "four ... are depicted, the remaining four being the mirror image about line AB",
        Every(
            {
                "the mirror image has the opposite signs in B": Identity(
                    [e.subs(mirror) for e in diagonal], [-e for e in diagonal]
                ),
                "and P is reflected": Identity(
                    [point.subs(mirror)[i] for point in bar.by_legs for i in range(3)],
                    [s * point[i] for point in bar.by_legs for i, s in enumerate((-1, 1, -1))],
                ),
            }
        ),
    )


class Plane(NamedTuple):
    """A posture in the plane of the linkage: AC, BD, P as (y, rho), for given lengths."""

    lengths: tuple[int, int, int]
    C: sp.Matrix
    D: sp.Matrix
    P: sp.Matrix

    @property
    def B(self) -> sp.Matrix:
        return sp.Matrix([self.lengths[0], 0])

    def closed(self) -> dict[str, sp.Expr]:
        _, L1, L2 = self.lengths
        return {
            "AC = BD = L1": Eq(_square(self.C) - _square(self.D - self.B), 0),
            "AC = L1": Eq(_square(self.C) - L1**2, 0),
            "CP = L2": Eq(_square(self.P - self.C) - L2**2, 0),
            "DP = L2": Eq(_square(self.P - self.D) - L2**2, 0),
        }

    def interior(self) -> dict[str, sp.Expr]:
        _, L1, L2 = self.lengths
        found = {}
        for name, reach in (("AP", _square(self.P)), ("BP", _square(self.P - self.B))):
            found[f"{name} < L1 + L2"] = Lt(reach, (L1 + L2) ** 2)
            found[f"{name} > |L1 - L2|"] = Gt(reach, (L1 - L2) ** 2)
        return found

    @property
    def cross(self) -> sp.Expr:
        """CP x DP, L2^2 times the sine between them."""
        return sp.Matrix.hstack(self.P - self.C, self.P - self.D).det()

    @property
    def dot(self) -> sp.Expr:
        return (self.P - self.C).dot(self.P - self.D)

    def other_mode(self) -> "Plane":
        """The leg over C turned over: C reflected about AP."""
        C = 2 * self.C.dot(self.P) / _square(self.P) * self.P - self.C
        return self._replace(C=C)


def _square(v: sp.Matrix) -> sp.Expr:
    return sp.expand(v.dot(v))


def coincident(lengths: tuple[int, int, int] = DEFAULT) -> Plane:
    """C = D, and P beside them at the distance L2, parallel to AB."""
    L0, L1, L2 = lengths
    C = sp.Matrix([sp.Rational(L0, 2), sqrt(L1**2 - sp.Rational(L0, 2) ** 2)])
    return Plane(lengths, C, C, C - sp.Matrix([L2, 0]))


def isotropic() -> Plane:
    """CD parallel to AB and sqrt 2 L2 long, P between A and CD or beyond: the symmetric posture."""
    L0, L1, L2 = DEFAULT
    half = L2 / sqrt(2)
    C_y = sp.Rational(L0, 2) - half
    height = sqrt(sp.expand(L1**2 - C_y**2))
    P = sp.Matrix([sp.Rational(L0, 2), height - half])
    return Plane(DEFAULT, sp.Matrix([C_y, height]), sp.Matrix([L0 - C_y, height]), P)


def parallel_singularities(d: Derivation, bar: FiveBar) -> None:
    """Section 2.5."""
    claim = partial(d.claim, where="2.5 The parallel singularities")
    L0, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    posture = coincident()
    claim(
        "inside the workspace",
        "the corresponding singular configurations occurring inside the workspace",
        Holds({**posture.closed(), **posture.interior(), "CP x DP = 0": Eq(posture.cross, 0)}),
    )
    c = cos(t4 - t5)
    claim(
        "eq. (6)",
        r"\mathbf A\mathbf A^T = L_2^2[1, 0, 0;\ 0, 1, \cos(\theta_4-\theta_5);\ "
        r"0, \cos(\theta_4-\theta_5), 1]",
        Identity(L2**2 * sp.Matrix([[1, 0, 0], [0, 1, c], [0, c, 1]]), bar.A * bar.A.T),
    )
    claim(
        "k(pi/2)",
        r"these singularities occur whenever \theta_4 - \theta_5 = k(\pi/2)",
        Refuted(
            Identity((bar.A * bar.A.T).subs(t4, t5 + pi / 2), L2**2 * sp.eye(3)),
            "for k = 1, CP and DP are at right angles and A A^T = L2^2 times the unit matrix",
            r"\theta_4 - \theta_5 = k\pi",
            Identity(bar.det_A, -(L2**3) * sin(t4 - t5)),
        ),
    )
    bars = [point - e for e, point in (_leg(bar, 0), _leg(bar, 1))]
    claim(
        "aligned",
        "i.e., when the points C, D and P are aligned",
        Identity(bars[0].cross(bars[1]), bar.det_A / L2 * bar.k),
    )
    off = bar.k.cross(bars[0])
    claim(
        "Figure 5",
        "the manipulator cannot resist an effort in the orthogonal direction of DC",
        Identity((bar.A * off).subs(t5, t4 + pi), sp.zeros(3, 1)),
    )
    free = real("phi")
    D = bar.elbows[1]
    circling = {**dict(zip(bar.p, bar.by_legs[1].subs(t5, free), strict=True))}
    same = sp.Matrix([bar.loop[0].subs(circling), bar.loop[2].subs(circling)])
    claim(
        "Figure 6",
        "when C and D coincide, P can rotate freely around D",
        Every(
            {
                "the equations of D hold for every angle of DP": Identity(same, sp.zeros(2, 1)),
                "that of C is the same": Identity(
                    sum(((x - a) ** 2 for x, a in zip(bar.p, D, strict=True)), -(L2**2)) / 2,
                    bar.loop[2],
                ),
            }
        ),
    )
    claim(
        "by design or by path-planning",
        "parallel singularities can be avoided either by design or by path-planning",
        Holds(without_parallel(3, 1, 3)),
    )


def without_parallel(L0: int, L1: int, L2: int) -> dict[str, sp.Expr]:
    """The conditions for a design without parallel singularities, for numbers."""
    return {
        f"{L0} > 2 x {L1}, C and D stay apart": sp.sympify(L0 > 2 * L1),
        f"2 x {L2} > {L0} + 2 x {L1}, C, P, D are never in line": sp.sympify(2 * L2 > L0 + 2 * L1),
    }


def on_the_axis() -> Holds:
    """P on AB, inside the workspace: the default lengths, AP = BP = 7/2."""
    L0, L1, L2 = DEFAULT
    half = sp.Rational(L0, 2)
    C_y = (L1**2 - L2**2 + half**2) / (2 * half)
    C = sp.Matrix([C_y, sqrt(L1**2 - C_y**2)])
    posture = Plane(DEFAULT, C, sp.Matrix([L0 - C[0], C[1]]), sp.Matrix([half, 0]))
    return Holds({**posture.closed(), **posture.interior(), "rho = 0": Eq(posture.P[1], 0)})


def serial_singularities(d: Derivation, bar: FiveBar) -> None:
    """Section 2.6."""
    claim = partial(d.claim, where="2.6 The serial singularities")
    L0, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    reach = L1**2 + L2**2 + 2 * L1 * L2 * cos(t4 - t2)
    aligned = Every(
        {
            "AP": Identity(sum(e**2 for e in bar.by_legs[0]), reach),
            "stretched": Identity(reach.subs(t4, t2), (L1 + L2) ** 2),
            "folded": Identity(reach.subs(t4, t2 + pi), (L1 - L2) ** 2),
        }
    )
    claim(
        "no velocity in one direction",
        "there exists a direction along which no Cartesian velocity can be produced",
        Identity(
            bar.det_A * (bar.A.adjugate() / bar.det_A * bar.B).det(),
            prod(bar.B[i, i] for i in range(3)),
        ),
    )
    claim(
        "boundary",
        "such singularities are reached at the boundary of the workspace when BD and DP or AC and "
        "CP are aligned",
        Refuted(
            on_the_axis(),
            "det B vanishes on the axis AB too, inside the workspace: for (7, 8, 5) at AP = BP = 7/2",
            r"\text{on } AB \text{, or with } BD, DP \text{ or } AC, CP \text{ aligned, at the "
            r"boundary}",
            aligned,
        ),
    )
    R = L1 + L2
    height = sqrt(R**2 - L0**2 / 4)
    P = sp.Matrix([L0 / 2, height])
    claim(
        "cannot be avoided",
        "they cannot be avoided",
        Under(
            Identity([P.dot(P), _square(P - sp.Matrix([L0, 0]))], [R**2, R**2], (2 * R - L0,)),
            "where the loop closes at all, L0 <= 2 (L1 + L2), there is a point with AP = BP = "
            "L1 + L2, and both legs are stretched there",
        ),
    )


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
    x, y, z = bar.p
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
            "with L0 = 0, L1 = L2 = 1 the axis is singular inside the workspace, e.g. P = (0, 1, 0)",
        ),
    )


def by_design(d: Derivation, bar: FiveBar) -> None:
    """Section 3.2."""
    claim = partial(d.claim, where="3.2 Avoiding parallel singularities by proper design")
    L0, L1, L2 = bar.lengths
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
            "for (1, 1, 2), 4 - 2 > 1, C and D coincide at theta2 = 60 and theta3 = 120 degrees; the "
            "condition keeps C, P, D from being in line, and nothing else",
            r"L_0 > 2 L_1 \text{ and } 2 L_2 > L_0 + 2 L_1",
            Every({"C and D stay apart": stay_apart, "CD < 2 L2": longest(bar)}),
        ),
    )


def longest(bar: FiveBar) -> Check:
    """(L0 + 2 L1)^2 - CD^2 as a sum that is not negative."""
    L0, L1, _ = bar.lengths
    t2, t3 = bar.angles[1:3]
    CD = bar.elbows[1] - bar.elbows[0]
    rest = 2 * L0 * L1 * ((1 - cos(t3)) + (1 + cos(t2))) + 2 * L1**2 * (1 + cos(t3 - t2))
    return Identity((L0 + 2 * L1) ** 2 - CD.dot(CD), rest)


def by_change_of_mode(d: Derivation, bar: FiveBar) -> None:
    """Section 3.3."""
    claim = partial(d.claim, where="3.3 Avoiding parallel singularities by a change of working mode")
    L0, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
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
            "the conditions on P hold no sign: every working mode reaches the same workspace, and a "
            "change of mode adds nothing to it",
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
        "according to the working mode, the condition numbers of the direct-kinematics matrix differ",
        Holds({**start.closed(), "CP DP = 0": Eq(start.dot, 0), "turned over, not": Ne(start.other_mode().dot, 0)}),
    )
    claim(
        "condition numbers differ: B",
        "and those of the inverse-kinematics matrix",
        Refuted(
            Identity(
                4 * bar.B[1, 1] ** 2, ((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2)
            ),
            "up to their signs, the entries of B depend on P alone: rho L2, and by leg the area of "
            "the triangle over AP or BP; B has one condition number in all eight working modes",
        ),
    )


def conditioning(d: Derivation, bar: FiveBar) -> None:
    """Section 3.4."""
    claim = partial(d.claim, where="3.4 The isoconditioning curves")
    L0, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    claim(
        "eq. (7)",
        r"\kappa(\mathbf M) = \sigma_1/\sigma_s",
        Undecidable("a definition"),
    )
    printed, right = Abs(cos(t4 - t3)), Abs(cos(t4 - t5))
    claim(
        "eigenvalues",
        r"\alpha_1 = 1 - |\cos(\theta_4-\theta_3)|,\ \alpha_2 = 1,\ "
        r"\alpha_3 = 1 + |\cos(\theta_4-\theta_3)|",
        Identity(
            [1 - printed, sp.S.One, 1 + printed],
            [L2**2 * (1 - right), L2**2, L2**2 * (1 + right)],
        ),
    )
    claim(
        "eq. (8)",
        r"\kappa(\mathbf A) = 1/|\tan((\theta_4-\theta_3)/2)|",
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
        r"\kappa(\mathbf A) attains its minimum of 1 when |\theta_3-\theta_4| = \pi/2",
        Every(
            {
                "as printed": Identity(bar.kappa.subs(t4, t3 + pi / 2), sp.S.One),
                "with theta5 for theta3": Identity(bar.kappa.subs(t4, t5 + pi / 2), sp.S.One),
            }
        ),
    )
    claim(
        "infinity",
        r"\kappa(\mathbf A) tends to infinity when \theta_3-\theta_4 = k\pi",
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
            "for (7, 8, 5) C and D coincide at (7/2, sqrt(207)/2), with P inside the workspace; the "
            "boundary is where a leg is stretched or folded, a serial singularity",
        ),
    )
    claim(
        "isotropy regardless of the dimensions",
        "isotropy can be obtained regardless of the dimensions of the manipulator, as long as i) it "
        "is symmetric and ii) L2 is not 0",
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
        Undecidable("the distance is not defined; 1/kappa is one between matrices, not between points"),
    )


def shortest(bar: FiveBar) -> Check:
    """CD^2 - (L0 - 2 L1)^2 for L0 > 2 L1, in a form with positive coefficients."""
    L0, L1, _ = bar.lengths
    t2, t3 = bar.angles[1:3]
    CD = bar.elbows[1] - bar.elbows[0]
    w = real("w", nonnegative=True)
    along = (1 + cos(t3)) + (1 - cos(t2))
    rest = 2 * w * L1 * along + L1**2 * along**2 + L1**2 * (sin(t3) - sin(t2)) ** 2
    return Identity((CD.dot(CD) - (L0 - 2 * L1) ** 2).subs(L0, 2 * L1 + w), rest)
