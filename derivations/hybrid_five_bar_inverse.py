"""The inverse of the five-bar linkage on a revolute: all working modes, and where P can be."""

from dataclasses import replace
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, sin, sqrt

from closedform import (
    Bound,
    Degenerate,
    Derivation,
    Inverse,
    Lemma,
    Link,
    Program,
    Solved,
    Step,
    Triangle,
    branches,
    choose,
    linear_pair,
    real,
    turned_back,
)

SIGN = {+1: "plus", -1: "minus"}
tau, sigma2, sigma3 = (real(f"sigma_{name}") for name in ("axis", "leg_c", "leg_d"))
off_axis = real("rho")


class Loop(NamedTuple):
    """The loop: the lengths, the angles, P, the normal of its plane, and the equations."""

    lengths: tuple[sp.Symbol, ...]
    angles: tuple[sp.Symbol, ...]
    p: sp.Matrix
    k: sp.Matrix
    equations: tuple[sp.Expr, ...]
    legs: tuple[dict[sp.Symbol, sp.Expr], dict[sp.Symbol, sp.Expr]]
    """P by the leg over C, and by that over D."""
    step: Step

    @property
    def in_plane(self) -> dict[sp.Symbol, sp.Expr]:
        """The coordinates of P across AB, from its signed distance."""
        (x, _, z), theta1 = self.p, self.angles[0]
        return {x: -off_axis * cos(theta1), z: off_axis * sin(theta1)}


Products = tuple[sp.Expr, sp.Expr]


def products(u: sp.Matrix, v: sp.Matrix) -> Products:
    """The inner and the cross product of two vectors in the plane."""
    return u.dot(v), sp.Matrix.hstack(u, v).det()


def bars_at_p(pivots: Products, leg_c: Products, leg_d: Products) -> sp.Expr:
    """CP x DP, times AP^2 and BP^2, from the products of AP and BP, AP and CP, BP and DP."""
    along = leg_c[0] * leg_d[0] + leg_c[1] * leg_d[1]
    return pivots[0] * (leg_c[0] * leg_d[1] - leg_c[1] * leg_d[0]) + pivots[1] * along


def inverse_kinematics(d: Derivation, loop: Loop) -> None:
    """Add the inverse and the workspace."""
    L0, L1, L2 = loop.lengths
    theta1, theta2, theta3, *_ = loop.angles
    x, y, z = p = loop.p
    working = branches((tau, SIGN), (sigma2, SIGN), (sigma3, SIGN))
    d.branches = working.labels
    base2, base3, elbow4, elbow5 = (real(name) for name in ("base2", "base3", "elbow4", "elbow5"))

    w = Program()
    r2 = w.let("rP2", x**2 + z**2, nonnegative=True)
    square_c = w.let("a2", r2 + y**2, nonnegative=True)
    square_d = w.let("b2", r2 + (y - L0) ** 2, nonnegative=True)
    squares = list(w.body)
    (triangle_c, arm_c), (triangle_d, arm_d) = (
        Triangle.from_square(w, (L1, L2), square, sign, suffix=suffix).stretched_without_link(
            w, angles, sqrt(square), suffix=suffix
        )
        for suffix, square, angles, sign in (
            ("_c", square_c, (elbow4, base2), sigma2),
            ("_d", square_d, (elbow5, base3), sigma3),
        )
    )
    inside = Program([*squares, *(s for s in w.body if isinstance(s, Bound))])
    size = L0 + L1 + L2
    r = w.let("rP", sqrt(r2), nonnegative=True)
    on_axis = w.vanishes("on_axis", r, size, "P is on the axis", free=(theta1,))
    at_a = w.vanishes("at_A", r + sp.Abs(y), size, "P is at A", free=(theta2,))
    at_b = w.vanishes("at_B", r + sp.Abs(y - L0), size, "P is at B", free=(theta3,))
    w.vanishes("no_bar", L1, L1 + L2, "the driven bars have no length", free=(theta2, theta3))
    turn = linear_pair(theta1, tau * z, -tau * x)
    bearing_c, bearing_d = (
        turned_back(theta, (tau * r, along), base, (beyond, ahead))
        for theta, along, base, (ahead, beyond) in (
            (theta2, y, base2, arm_c),
            (theta3, y - L0, base3, arm_d),
        )
    )

    legs = [
        (w.let(f"inner_{name}", square - (L1 - L2) * (L1 + L2)), sign * (sqrt(N) * sqrt(M)))
        for name, square, sign in (("c", square_c, sigma2), ("d", square_d, sigma3))
        for N, M in [[real(f"{n}_{name}", nonnegative=True) for n in "NM"]]
    ]
    w.determined(
        sp.Abs(bars_at_p((y * (y - L0) + r2, tau * r * L0), *legs)),
        4 * L2**2 * square_c * square_d,
        "C, D and P are in line, or C and D coincide",
        name=r"|\overrightarrow{CP} \times \overrightarrow{DP}|",
        scale_name="L_2^2",
        missed=sum(
            sp.Max(0, sqrt(square) - L1 - L2, sp.Abs(L1 - L2) - sqrt(square))
            for square in (square_c, square_d)
        ),
        size=size,
    )
    driven_angles = [choose(at_a, 0, bearing_c[theta2]), choose(at_b, 0, bearing_d[theta3])]
    _explain(d, loop, turn)
    d.function(
        "ik",
        "The driven angles of all eight working modes.",
        {"x": tuple(p)},
        {"q": [choose(on_axis, 0, turn[theta1]), *driven_angles]},
        program=w,
        branches=working,
        result="Solutions",
        source="the working modes of section 2.4",
        notes=(
            "BRANCHES name the signs of the diagonal of 𝐁; each posture is in one of the two "
            "assembly modes.",
            "UNREACHABLE: the distance of P from A or from B is more than L1 + L2 or less than "
            "|L1 - L2|.",
            "SINGULAR: theta1 is free if P is on the axis; theta2 or theta3 is free if L1 = L2 "
            "and P is at A or at B; both are free if L1 = 0.  0 is returned for theta1, and for "
            "the others unless L1 = 0.",
            "SINGULAR also near a parallel singularity, if the sine of the angle between CP and "
            "DP is less than 2^-10: the loop closes, but a unit in the last place of the joints "
            "moves P by more than 1e-12 of the lengths.  The length by which the answer misses a "
            "target just outside of the workspace counts as a rounding error too.  If L0 = 0, C "
            "coincides with D in the branches whose last two signs are equal.",
            "Ill-conditioned near the boundary of the workspace: the angles lose half their "
            "digits, but the loop still closes.",
        ),
    )
    d.function(
        "workspace_contains",
        "Whether P can be reached: it lies in both hollow spheres.",
        {"p": tuple(p)},
        {"inside": sp.true},
        program=inside,
        source="section 3.1",
        boolean=True,
    )
    _tell(d, loop, (turn, bearing_c, bearing_d), (triangle_c, triangle_d))
    _certify(d, loop, (on_axis, at_a, at_b))


def _explain(d: Derivation, loop: Loop, turn: Lemma) -> None:
    """The steps of the article."""
    L0, L1, L2 = loop.lengths
    theta1, _, _, theta4, theta5 = loop.angles
    x, y, z = loop.p

    def spelled(leg: str, square: sp.Expr, along: sp.Expr, sign: sp.Symbol) -> dict[str, sp.Expr]:
        """The formulas of one leg: distance of P from its pivot, N, M and the angle of its bar."""
        N, M = (real(f"{n}_{leg}", nonnegative=True) for n in "NM")
        name, joint = {"c": ("a", 2), "d": ("b", 3)}[leg]
        distance = real(name) ** 2
        return {
            f"{name}^2": square,
            f"N_{leg}": (L1 + L2) ** 2 - distance,
            f"M_{leg}": distance - (L1 - L2) ** 2,
            rf"\theta_{joint}": atan2(tau * real("r_P"), along) - Triangle(L1, L2, sign, N, M).base,
        }

    d.step(
        "Inverse: the eight working modes",
        "rho is the distance of P from the axis with either sign; the other sign turns theta1 by "
        "half a turn.  In the plane of the linkage, A, C, P and B, D, P are triangles with known "
        "sides.  Each has two mirror images, which differ in the sign of the angle between the "
        "bars.  So the three signs are those of the diagonal of 𝐁.  If P is on the axis, theta1 "
        "is free and we return 0.  P can be at A or at B only if L1 = L2; then theta2 or theta3 "
        "is free too.",
        {
            "r_P": sqrt(x**2 + z**2),
            r"\theta_1": turn[theta1],
            **spelled("c", y**2 + real("r_P") ** 2, y, sigma2),
            **spelled("d", (y - L0) ** 2 + real("r_P") ** 2, y - L0, sigma3),
        },
        uses=[loop.step],
        solves={"ik": ()},
    )
    ap, bp = sp.Matrix([y, off_axis]), sp.Matrix([y - L0, off_axis])
    cp, dp = (L2 * sp.Matrix([cos(t), sin(t)]) for t in (theta4, theta5))
    d.step(
        "Inverse: accuracy near a parallel singularity",
        "Rounded joints miss the lengths of the bars by a few units in the last place of L0 + L1 "
        "+ L2.  The error of P, where the bars CP and DP meet, is this error divided by the sine "
        "of the angle between them.  So near a parallel singularity, with C, D and P in line or "
        "with C = D, fk cannot recover P from the joints, however they are computed.  The status "
        "is SINGULAR if the sine is less than 2^-10.  The inverse computes the cross product of "
        "the bars without their angles, from the products of each bar with the line from its "
        "pivot to P.  The inner product of AP and CP is half of AP^2 - L1^2 + L2^2, and their "
        "cross product is half the root of N_c M_c, with the sign of the leg.",
        {
            r"\overrightarrow{AP}": ap,
            r"\overrightarrow{BP}": bp,
            r"|\overrightarrow{CP}\times\overrightarrow{DP}|": L2**2 * sp.Abs(sin(theta5 - theta4)),
        },
        proves=(
            "The cross product of CP and DP follows from the products with AP and BP, and each of "
            "these products is as stated."
        ),
        equal=[
            (
                bars_at_p(products(ap, bp), products(ap, cp), products(bp, dp)),
                ap.dot(ap) * bp.dot(bp) * products(cp, dp)[1],
            ),
            (products(ap, bp)[0], y * (y - L0) + off_axis**2),
            (products(ap, bp)[1], off_axis * L0),
            (2 * products(ap, cp)[0], ap.dot(ap) + cp.dot(cp) - (ap - cp).dot(ap - cp)),
            (
                4 * products(ap, cp)[1] ** 2,
                4 * ap.dot(ap) * cp.dot(cp) - (2 * products(ap, cp)[0]) ** 2,
            ),
        ],
        solves={"ik": ()},
    )


def _tell(
    d: Derivation, loop: Loop, turns: tuple[Lemma, ...], triangles: tuple[Lemma, ...]
) -> None:
    """Say which lemma solves which equation."""
    L0, L1, L2 = loop.lengths
    theta1, theta2, theta3, theta4, theta5 = loop.angles
    (x, y, z), (leg_c, leg_d) = loop.p, loop.legs
    turn, bearing_c, bearing_d = turns

    def cosine_rule(square: sp.Expr, angle: sp.Expr) -> sp.Expr:
        return square - L1**2 - L2**2 - 2 * L1 * L2 * cos(angle)

    def toward(theta: sp.Symbol, along: sp.Expr, passive_angle: sp.Symbol) -> sp.Expr:
        """Zero if the end of the bars, as seen from their pivot, is in the direction of P."""
        elbow = passive_angle - theta
        reach = sp.Matrix([L1 + L2 * cos(elbow), L2 * sin(elbow)])
        off = z * sin(theta1) - x * cos(theta1)
        return sin(theta) * (along * reach[0] + off * reach[1]) - cos(theta) * (
            off * reach[0] - along * reach[1]
        )

    between_c, between_d = theta4 - theta2, theta5 - theta3
    told_c, told_d = (
        replace(
            lemma,
            roles=(*lemma.roles, (r"\theta", passive - driven)),
            solution={passive: driven + next(iter(lemma.solution.values()))},
        )
        for lemma, passive, driven in zip(
            triangles, (theta4, theta5), (theta2, theta3), strict=True
        )
    )
    d.solved += [
        Solved("ik", theta1, turn, loop.k.dot(loop.p), leg_c),
        Solved("ik", theta4, told_c, cosine_rule(x**2 + y**2 + z**2, between_c), leg_c),
        Solved("ik", theta5, told_d, cosine_rule(x**2 + (y - L0) ** 2 + z**2, between_d), leg_d),
        Solved("ik", theta2, bearing_c, toward(theta2, y, theta4), leg_c),
        Solved("ik", theta3, bearing_d, toward(theta3, y - L0, theta5), leg_d),
    ]


def _certify(d: Derivation, loop: Loop, flags: tuple[sp.Symbol, ...]) -> None:
    """State what the driven angles satisfy, and where they are free."""
    L0, L1, L2 = loop.lengths
    q = theta1, theta2, theta3 = loop.angles[:3]
    (x, y, z), in_plane = loop.p, loop.in_plane
    on_axis, at_a, at_b = flags
    axis = {x: sp.S.Zero, z: sp.S.Zero}
    d.inverses.append(
        Inverse(
            "ik",
            q,
            (sp.S.Zero,) * 3,
            loop.equations,
            (
                Degenerate(
                    (on_axis,),
                    axis,
                    theta1,
                    relation=r"\theta_2 \text{ and } \theta_3",
                ),
                Degenerate(
                    (at_a, on_axis),
                    {**axis, y: sp.S.Zero, L2: L1},
                    theta2,
                    relation=r"\theta_4 = \theta_2 + \pi",
                ),
                Degenerate(
                    (at_b, on_axis),
                    {**axis, y: L0, L2: L1},
                    theta3,
                    relation=r"\theta_5 = \theta_3 + \pi",
                ),
            ),
            images="fk",
            links=tuple(
                Link((joint,), (equation,), given)
                for joint, equation, given in zip(
                    q, loop.equations, ({}, in_plane, in_plane), strict=True
                )
            ),
        )
    )
