"""Claims of Chablat, Wenger and Angeles about the kinematics of the hybrid five-bar linkage."""

from functools import partial
from math import prod

import sympy as sp
from closedform.derivations.claims import hybrid_five_bar_design as design
from closedform.derivations.claims.five_bar_postures import (
    Eq,
    FiveBar,
    Ne,
    coincident,
    on_the_axis,
    serial,
    signs,
    square,
    without_parallel,
)
from sympy import cos, pi, sin, sqrt

from closedform import (
    Derivation,
    Enumeration,
    Every,
    Holds,
    Identity,
    Refuted,
    Undecidable,
    Under,
    count_solutions,
    real,
)


def state(d: Derivation, bar: FiveBar) -> None:
    """Transcribe all claims, in the order of the paper."""
    kinematics(d, bar)
    working_modes(d, bar)
    parallel_singularities(d, bar)
    serial_singularities(d, bar)
    design.workspace(d, bar)
    design.by_design(d, bar)
    design.by_change_of_mode(d, bar)
    design.conditioning(d, bar)


def kinematics(d: Derivation, bar: FiveBar) -> None:
    """Eqs. (1a) to (5)."""
    claim = partial(d.claim, where="2.3 Kinematic relations")
    _, L1, L2 = bar.lengths
    t1, t2, t3, t4, t5 = bar.angles
    rates = {t: real(f"rate{i}") for i, t in enumerate(bar.angles, 1)}
    j = sp.Matrix([0, 1, 0])

    def velocity(point: sp.Matrix) -> sp.Matrix:
        return sum((point.diff(t) * w for t, w in rates.items()), sp.zeros(3, 1))

    forms = []
    for label, passive, elbow, point in (("a", t4, *leg(bar, 0)), ("b", t5, *leg(bar, 1))):
        turned = rates[t1] * j + rates[passive] * bar.k
        form = velocity(elbow) + turned.cross(point - elbow)
        forms.append(form)
        side, angle = ("c", "4") if label == "a" else ("d", "5")
        claim(
            f"eq. (1{label})",
            rf"$\dot{{\mathbf p}} = \dot{{\mathbf {side}}} + (\dot\theta_1\mathbf j + "
            rf"\dot\theta_{angle}\mathbf k)\times(\mathbf p - \mathbf {side})$",
            Identity(form, velocity(point)),
        )
    rows = sp.Matrix.vstack(*(bar.A[i, :] * forms[n] for i, n in ((0, 0), (1, 0), (2, 1))))
    driven = sp.Matrix([rates[t] for t in (t1, t2, t3)])
    claim(
        "eq. (2)",
        r"$\mathbf A\dot{\mathbf p} = \mathbf B\dot{\boldsymbol\theta}$",
        Identity(rows, bar.B * driven),
    )
    claim(
        "eq. (3)",
        r"$\mathbf A = [L_2\mathbf k^T;\ (\mathbf p-\mathbf c)^T;\ (\mathbf p-\mathbf d)^T]$",
        Identity(
            sp.Matrix.vstack(
                L2 * bar.k.T, *((point - e).T for e, point in (leg(bar, 0), leg(bar, 1)))
            ),
            bar.A,
        ),
    )
    ratio = L2 / L1
    printed = L1 * L2 * sp.diag(sin(t2) + ratio * sin(t4), sin(t2 - t4), sin(t3 - t5))
    claim(
        "eq. (4)",
        r"$\mathbf B = L_1 L_2\,\mathrm{diag}(\sin\theta_2 + \lambda_1\sin\theta_4,\ "
        r"\sin(\theta_2-\theta_4),\ \sin(\theta_3-\theta_5))$",
        Identity(printed, bar.B),
    )
    claim(
        "eq. (5)",
        r"$\dot{\boldsymbol\theta} = [\dot\theta_1, \dot\theta_2, \dot\theta_3]^T,\ "
        r"\dot{\mathbf p} = [\dot x, \dot y, \dot z]^T$",
        Undecidable("only names are defined, nothing is stated"),
    )


def leg(bar: FiveBar, i: int) -> tuple[sp.Matrix, sp.Matrix]:
    return bar.elbows[i], bar.by_legs[i]


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
    steps = (
        (bar.loop[0], t1, {}),
        (bar.loop[1], t2, bar.in_plane),
        (bar.loop[2], t3, bar.in_plane),
    )
    claim(
        "eight working modes",
        "the closed chain admits eight working modes",
        Enumeration(
            8,
            lambda: prod(count_solutions([e.subs(at)], (u,)).count for e, u, at in steps),
            "solutions for theta1, times those of each leg",
        ),
    )
    mirror = {t: -t for t in (t2, t3, t4, t5)}
    diagonal = [bar.B[i, i] for i in range(3)]
    claim(
        "mirror images",
        "four ... are depicted, the remaining four being the mirror image about line AB",
        Every(
            {
                "the mirror image has opposite signs in B": Identity(
                    [e.subs(mirror) for e in diagonal], [-e for e in diagonal]
                ),
                "and P is reflected": Identity(
                    [point.subs(mirror)[i] for point in bar.by_legs for i in range(3)],
                    [s * point[i] for point in bar.by_legs for i, s in enumerate((-1, 1, -1))],
                ),
            }
        ),
    )


def parallel_singularities(d: Derivation, bar: FiveBar) -> None:
    """Section 2.5."""
    claim = partial(d.claim, where="2.5 The parallel singularities")
    L2 = bar.lengths[2]
    t4, t5 = bar.angles[3:]
    posture = coincident()
    other = posture.other_mode()
    claim(
        "inside the workspace",
        "the corresponding singular configurations occurring inside the workspace",
        Holds(
            {**posture.closed(), **posture.interior(), "CP and DP in line": Eq(posture.cross, 0)}
        ),
    )
    c = cos(t4 - t5)
    claim(
        "eq. (6)",
        r"$\mathbf A\mathbf A^T = L_2^2[1, 0, 0;\ 0, 1, \cos(\theta_4-\theta_5);\ "
        r"0, \cos(\theta_4-\theta_5), 1]$",
        Identity(L2**2 * sp.Matrix([[1, 0, 0], [0, 1, c], [0, c, 1]]), bar.A * bar.A.T),
    )
    claim(
        "k(pi/2)",
        r"these singularities occur whenever $\theta_4 - \theta_5 = k(\pi/2)$",
        Refuted(
            Identity((bar.A * bar.A.T).subs(t4, t5 + pi / 2), L2**2 * sp.eye(3)),
            "for k = 1, CP and DP are at right angles and A*A^T is L2^2 times the identity matrix",
            r"\theta_4 - \theta_5 = k\pi",
            Identity(bar.det_A, -(L2**3) * sin(t4 - t5)),
        ),
    )
    bars = [point - e for e, point in (leg(bar, 0), leg(bar, 1))]
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
                "the equation of C is the same": Identity(
                    sum(((x - a) ** 2 for x, a in zip(bar.p, D, strict=True)), -(L2**2)) / 2,
                    bar.loop[2],
                ),
            }
        ),
    )
    claim(
        "by design or by path-planning",
        "parallel singularities can be avoided either by design or by path-planning",
        Every(
            {
                "by design": Holds(without_parallel(3, 1, 3)),
                "by another working mode at the same P": Holds(
                    {**other.closed(), "CP and DP not in line": Ne(other.cross, 0)}
                ),
            }
        ),
    )


def serial_singularities(d: Derivation, bar: FiveBar) -> None:
    """Section 2.6."""
    claim = partial(d.claim, where="2.6 The serial singularities")
    L0, L1, L2 = bar.lengths
    t2, t3, t4, t5 = bar.angles[1:]
    rows = bar.A * sp.Matrix.hstack(*(bar.by_legs[0].diff(t) for t in (bar.angles[0], t2, t4)))
    over_d = bar.A * sp.Matrix.hstack(*(bar.by_legs[1].diff(t) for t in (bar.angles[0], t3, t5)))
    none = sp.zeros(1, 3)
    claim(
        "no velocity in one direction",
        "when the manipulator is in such a singularity there exists a direction along which no "
        "Cartesian velocity can be produced",
        Every(
            {
                "on AB, along k": Identity(rows[0, :].subs(sin(t2), -L2 / L1 * sin(t4)), none),
                "AC and CP in line, along CP": Every(
                    {
                        "stretched": Identity(rows[1, :].subs(t4, t2), none),
                        "folded": Identity(rows[1, :].subs(t4, t2 + pi), none),
                    }
                ),
                "BD and DP in line, along DP": Every(
                    {
                        "stretched": Identity(over_d[2, :].subs(t5, t3), none),
                        "folded": Identity(over_d[2, :].subs(t5, t3 + pi), none),
                    }
                ),
            }
        ),
    )
    claim(
        "boundary",
        "such singularities are reached at the boundary of the workspace when BD and DP or AC and "
        "CP are aligned",
        Refuted(
            on_the_axis(),
            "det(B) also vanishes on the axis AB inside the workspace, for example for (7, 8, 5) "
            "at AP = BP = 7/2",
            "on AB, or at the boundary with BD and DP or AC and CP aligned",
            serial(bar),
        ),
    )
    R = L1 + L2
    height = sqrt(R**2 - L0**2 / 4)
    P = sp.Matrix([L0 / 2, height])
    claim(
        "cannot be avoided",
        "they cannot be avoided",
        Under(
            Identity([P.dot(P), square(P - sp.Matrix([L0, 0]))], [R**2, R**2], (2 * R - L0,)),
            "if the loop can close, L0 <= 2 (L1 + L2), there is a point with AP = BP = L1 + L2; "
            "both legs are stretched there",
        ),
    )
