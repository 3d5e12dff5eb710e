"""Conditioning, loci and workspace of the hybrid five-bar linkage: sections 2.5, 3.1, 3.2, 3.4."""

from typing import NamedTuple

import sympy as sp
from sympy import cos, pi, sin, sqrt

from closedform import Derivation, Program, degree, eliminate, lens, normal, positive_form, real

L0, L1, L2 = lengths = tuple(real(name, positive=True) for name in ("L0", "L1", "L2"))
y, rho = plane = real("y"), real("rho")
kappa = real("kappa", positive=True)
m, M = real("m", positive=True), real("M", positive=True)
"""The smaller and the larger of L1 and L2."""
R, r = M + m, M - m
AP, BP = sp.Matrix([y, rho]), sp.Matrix([y - L0, rho])
alpha, beta = (v.dot(v) + L2**2 - L1**2 for v in (AP, BP))


def conditioning(
    d: Derivation,
    A: sp.Matrix,
    psi: sp.Expr,
    CD: sp.Matrix,
    joints: tuple[sp.Symbol, sp.Symbol],
) -> None:
    """Add the singular values of A, a matrix of the angles; ``psi`` is the angle from CP to DP.

    ``CD`` is a vector of the two ``joints``.
    """
    c = cos(psi)
    gram = L2**2 * sp.Matrix([[1, 0, 0], [0, 1, c], [0, c, 1]])
    lam = real("lambda")
    h, e = real("h", nonnegative=True), real("e", nonnegative=True)
    by_chord = [(cos(psi), (e**2 - h**2) / L2**2), (L2, sqrt(h**2 + e**2))]
    d.step(
        "Singular values and condition number",
        "k is at right angles to CP and DP, so the only entry of 𝐀*𝐀^T off its diagonal is the "
        "scalar product of CP and DP.  Let h be half of CD and e the distance of P from CD.  The "
        "scalar product is e^2 - h^2, and L2^2 = h^2 + e^2, so the singular values are L2, "
        "sqrt(2)*h and sqrt(2)*e.  L2 lies between the other two, and the condition number is the "
        "larger of h/e and e/h, for either sign of the cosine.",
        {
            r"\mathbf A \mathbf A^T": gram,
            r"\varsigma^2": sp.Matrix([L2**2 * (1 - c), L2**2, L2**2 * (1 + c)]),
            r"\kappa^2": (1 + sp.Abs(c)) / (1 - sp.Abs(c)),
            r"\kappa(h, e)": sp.Max(h, e) / sp.Min(h, e),
        },
        published=("(6)", "(7)", "(8)"),
        proves=(
            "The product 𝐀*𝐀^T, its characteristic polynomial, and the squares 2*h^2 and 2*e^2 "
            "of the singular values."
        ),
        equal=[
            (A * A.T, gram),
            (
                (gram - lam * sp.eye(3)).det(),
                (L2**2 - lam) * (L2**2 * (1 - c) - lam) * (L2**2 * (1 + c) - lam),
            ),
            ((L2**2 * (1 - c)).subs(by_chord), 2 * h**2),
            ((L2**2 * (1 + c)).subs(by_chord), 2 * e**2),
            ((1 + c) * sin(psi / 2) ** 2, (1 - c) * cos(psi / 2) ** 2),
        ],
    )
    range_of_CD(d, CD, *joints)
    d.step(
        "Isotropy",
        "kappa = 1 if CP and DP are at right angles: h = e, so CD = sqrt(2)*L2.  By the range of "
        "CD, 𝐀 can be isotropic if and only if L2 is positive and sqrt(2)*L2 is in that range.",
        {"d_{min}": sp.Max(0, L0 - 2 * L1), "d_{max}": L0 + 2 * L1},
        proves="𝐀*𝐀^T is L2^2 times the identity if CP and DP are at right angles.",
        equal=[(gram.subs(cos(psi), 0), L2**2 * sp.eye(3))],
    )
    d.step(
        "Designs without parallel singularities",
        "det(𝐀) vanishes if C = D (h = 0) and if C, P, D are in line (e = 0, CD = 2*L2).  By the "
        "range of CD, the first is possible if and only if L0 <= 2*L1, and the second if and only "
        "if 2*L2 is in the range.  If 2*L2 is below the range, the loop never closes.  So a "
        "linkage that can be assembled has no parallel singularity if and only if both conditions "
        "below hold.  Section 3.2 of the paper has two conditions.  The first, 2*L1 > L0, ensures "
        "the opposite of its purpose: C can meet D.  The other, 2*L2 - 2*L1 > L0, is the second "
        "one below: C, P, D are never in line, but C may still meet D.",
        {
            r"\text{C and D stay apart}": sp.Gt(L0, 2 * L1),
            r"\text{C, P, D are never in line}": sp.Gt(2 * L2, L0 + 2 * L1),
        },
    )


def longest(CD: sp.Matrix, theta2: sp.Expr, theta3: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """(L0 + 2 L1)^2 - CD^2, and the same as a sum of nonnegative terms."""
    slack = (1 - cos(theta3)) + (1 + cos(theta2))
    rest = 2 * L0 * L1 * slack + 2 * L1**2 * (1 + cos(theta3 - theta2))
    return (L0 + 2 * L1) ** 2 - CD.dot(CD), rest


def shortest(CD: sp.Matrix, theta2: sp.Expr, theta3: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """CD^2 - (L0 - 2 L1)^2 for L0 = 2 L1 + w, and the same as a sum, nonnegative for w >= 0."""
    w = real("w", nonnegative=True)
    along = (1 + cos(theta3)) + (1 - cos(theta2))
    rest = 2 * w * L1 * along + L1**2 * along**2 + L1**2 * (sin(theta3) - sin(theta2)) ** 2
    return (CD.dot(CD) - (L0 - 2 * L1) ** 2).subs(L0, 2 * L1 + w), rest


def range_of_CD(d: Derivation, CD: sp.Matrix, theta2: sp.Symbol, theta3: sp.Symbol) -> None:
    square = CD.dot(CD)
    corner = sp.acos(L0 / (2 * L1))
    bounds = [longest(CD, theta2, theta3), shortest(CD, theta2, theta3)]
    d.step(
        "The range of CD",
        "theta2 and theta3 are independent, so CD takes every value between its smallest and its "
        "largest.  The largest is L0 + 2*L1: both bars are along AB and point away from each "
        "other. If L0 = 2*L1 + w with w >= 0, the smallest is L0 - 2*L1: the bars point towards "
        "each other.  Otherwise it is 0: the circles of C and D meet.",
        {
            r"(L_0 + 2 L_1)^2 - CD^2": bounds[0][1],
            r"CD^2 - (L_0 - 2 L_1)^2": bounds[1][1],
        },
        proves="Both differences of squares are the stated sums, and each bound is attained.",
        equal=[
            *bounds,
            (square.subs({theta2: pi, theta3: 0}), (L0 + 2 * L1) ** 2),
            (square.subs({theta2: 0, theta3: pi}), (L0 - 2 * L1) ** 2),
            (CD.subs({theta2: corner, theta3: pi - corner}), sp.zeros(3, 1)),
        ],
    )


class Locus(NamedTuple):
    """The curve of P for an angle psi from CP to DP, and the factors that elimination added."""

    curve: sp.Expr
    degree: int
    extraneous: tuple[sp.Expr, ...]


def locus(c: sp.Expr, s: sp.Expr, denominator: sp.Expr = sp.S.One) -> Locus:
    """Eliminate the vector CP from the loop, for DP = CP turned by psi.

    ``c`` and ``s`` over ``denominator`` are the cosine and the sine of psi.
    """
    X, Y = real("X"), real("Y")
    CP = sp.Matrix([X, Y])
    DP = sp.Matrix([[c, -s], [s, c]]) * CP
    equations = [
        CP.dot(CP) - L2**2,
        AP.dot(AP) - 2 * AP.dot(CP) + L2**2 - L1**2,
        denominator * (BP.dot(BP) + L2**2 - L1**2) - 2 * BP.dot(DP),
    ]
    factors = [f for f, _ in eliminate(equations, (X, Y)).factors]
    (curve,) = (f for f in factors if f.has(L1))
    return Locus(curve, degree(curve, plane), tuple(f for f in factors if f != curve))


def by_cramer(
    c: sp.Expr,
    s: sp.Expr,
    denominator: sp.Expr = sp.S.One,
    alpha: sp.Expr = alpha,
    beta: sp.Expr = beta,
) -> sp.Expr:
    """The same curve by Cramer's rule: two equations are linear in CP, the third is its length."""
    turned = sp.Matrix([[c, s], [-s, c]]) * BP
    beta = denominator * beta
    numerator = alpha * turned - beta * AP
    return numerator.dot(numerator) - 4 * L2**2 * sp.Matrix.hstack(AP, turned).det() ** 2


def distinct(c: sp.Expr, s: sp.Expr, denominator: sp.Expr) -> int:
    """The number of distinct curves for all signs of the cosine and the sine."""
    signs = ((a, b) for a in (1, -1) for b in (1, -1))
    return len(
        {
            normal(by_cramer(sp.sympify(a * c), sp.sympify(b * s), sp.sympify(denominator)))
            for a, b in signs
        }
    )


class Loci(NamedTuple):
    coincident: Locus
    in_line: Locus
    isotropy: Locus
    isoconditioning: Locus


def loci(d: Derivation) -> Loci:
    """Add the loci of parallel singularities, of isotropy and of equal condition number."""
    k2 = kappa**2
    found = Loci(
        locus(sp.S.One, sp.S.Zero),
        locus(-sp.S.One, sp.S.Zero),
        locus(sp.S.Zero, sp.S.One),
        locus(k2 - 1, 2 * kappa, k2 + 1),
    )
    same, opposite, square, general = found
    apart = 4 * L1**2 - L0**2
    circles = ((y - L0 / 2) ** 2 + rho**2 + apart / 4 - L2**2) ** 2 - rho**2 * apart
    mirror = {rho: -rho}
    psi, A, B = map(real, ("psi", "alpha", "beta"))
    turned = by_cramer(cos(psi), sin(psi), alpha=A, beta=B)
    far = y**2 + rho**2
    cross = L0 * (rho * cos(psi) + y * sin(psi)) - far * sin(psi)
    shown = sp.Add(*(t for t in turned.args if not t.has(L2)), -4 * L2**2 * cross**2)
    flat = rho**2 * (A + B) ** 2 + (A * (y - L0) + B * y) ** 2, 4 * L0**2 * L2**2 * rho**2
    d.step(
        "Locus of the parallel singularities",
        "DP is CP turned by psi.  The lengths of AC and BD give two linear equations for the "
        "vector CP, whose right sides are alpha and beta.  Cramer's rule solves them, and the "
        "length of CP gives F, which vanishes on the curve of P for one psi: the coupler curve of "
        "a four-bar linkage.  For psi = 0, C = D, the curve is the two circles of radius L2 "
        "about the points where C and D can meet; they are real for L0 <= 2*L1.  For psi = pi, C, "
        "P, D in line, it is the curve of the midpoint of the coupler.  Resultants, which "
        "eliminate CP, give both again, times powers of rho.  "
        "So every real point of a curve, except isolated points on AB, is the P of such a "
        "posture.  If L0 = 0, the two driven circles coincide, and every point of the workspace "
        "can also be reached with C = D.  C, P, D are then in line on the circle about A with the "
        "squared radius L1^2 - L2^2, and at A if L1 = L2.",
        {
            r"\alpha": alpha,
            r"\beta": beta,
            r"F_\psi": shown,
            r"\psi = 0": sp.Eq(circles, 0, evaluate=False),
            r"\psi = \pi": sp.Eq(*flat, evaluate=False),
            r"\psi = \pi,\ L_0 = 0": sp.Eq(A**2 * far, 0, evaluate=False),
        },
        proves=(
            "The resultants are the stated curves, Cramer's rule gives them too, they are "
            "symmetric, and for L0 = 0 the second one factors as shown."
        ),
        equal=lambda: [
            (turned, shown),
            (opposite.curve, (flat[0] - flat[1]).subs({A: alpha, B: beta})),
            (same.curve, sp.expand(circles)),
            (L0**2 * same.curve, by_cramer(sp.S.One, sp.S.Zero)),
            (opposite.curve, by_cramer(-sp.S.One, sp.S.Zero)),
            (opposite.curve, opposite.curve.subs(mirror)),
            (
                opposite.curve.subs(L0, 0),
                4 * (y**2 + rho**2) * (y**2 + rho**2 + L2**2 - L1**2) ** 2,
            ),
        ],
    )
    n = k2 + 1
    half = psi / 2
    concentric = 4 * sin(half) ** 2 * far * (A**2 - 4 * L2**2 * far * cos(half) ** 2)
    d.step(
        "Isoconditioning loci",
        "kappa is the cotangent of psi/2 or its inverse, so cos(psi) = (kappa^2 - 1)/(kappa^2 + 1) "
        "and sin(psi) = 2*kappa/(kappa^2 + 1), up to their signs.  The locus is the curve F = 0 of "
        "this psi.  The curves for the two signs of psi, the two assembly modes, are mirror images "
        "about AB.  The two signs of the cosine belong to "
        "postures with e > h and with e < h.  For L0 = 0 a curve consists of circles about A.  The "
        "curves do not depend on theta1: in space they are surfaces of revolution about AB.",
        {r"F_\psi(L_0 = 0)": concentric},
        proves=(
            "The resultants for a right angle and for a general psi are the curves that Cramer's "
            "rule gives, their mirror images belong to the other sign, and the curve factors for "
            "L0 = 0."
        ),
        equal=lambda: [
            (square.curve, by_cramer(sp.S.Zero, sp.S.One)),
            (square.curve.subs(mirror), by_cramer(sp.S.Zero, -sp.S.One)),
            (general.curve, by_cramer(k2 - 1, 2 * kappa, n)),
            (general.curve.subs(mirror), by_cramer(k2 - 1, -2 * kappa, n)),
            (general.curve.subs(kappa, 1), 4 * square.curve),
            (turned.subs({L0: 0, B: A}), concentric),
        ],
    )
    d.step(
        "Loci: degrees",
        "The curves are polynomials in the coordinates y and rho of P in the plane of the "
        "linkage.  The factors are those over the rationals, with all lengths and kappa symbolic.  "
        "The factor of C = D splits into two circles if the square root of 4*L1^2 - L0^2 is "
        "adjoined.",
        {},
        rows=[
            ("locus of P", "of", "factors", "degree"),
            *(
                (name, of, f"{times} of degree {one.degree}", str(times * one.degree))
                for name, of, times, one in (
                    ("parallel singularity", "C = D", 1, same),
                    ("parallel singularity", "C, P, D in line", 1, opposite),
                    ("isotropy", "kappa = 1, both signs of psi", distinct(0, 1, 1), square),
                    (
                        "isoconditioning",
                        "kappa > 1, all signs",
                        distinct(k2 - 1, 2 * kappa, n),
                        general,
                    ),
                )
            ),
        ],
    )
    return found


class Regime(NamedTuple):
    """A range of L0, and the volume of the workspace in that range."""

    start: sp.Expr
    end: sp.Expr
    volume: sp.Expr
    pieces: sp.Expr
    """The same volume by inclusion and exclusion."""


def regimes() -> dict[str, Regime]:
    """The lens of the outer balls, minus the inner balls in it, plus the part that these share."""
    ball = sp.Rational(4, 3) * pi * r**3
    outer, mixed, inner = lens(R, R, L0), lens(r, R, L0), lens(r, r, L0)
    cut = pi * (L0 + 4 * r) * (L0 - 2 * r) ** 2 / 12
    crossing = 8 * pi * M**2 * m**2 / L0
    near = pi * (16 * m * (3 * M**2 + m**2) - 12 * L0 * (M**2 + m**2) + L0**3) / 6
    zero = sp.S.Zero
    return {
        "inner balls inside, overlapping": Regime(
            zero, sp.Min(2 * m, 2 * r), near, outer - 2 * ball + inner
        ),
        "inner balls inside, apart": Regime(2 * r, 2 * m, outer - 2 * ball, outer - 2 * ball),
        "inner balls cut, overlapping": Regime(2 * m, 2 * r, crossing, outer - 2 * mixed + inner),
        "inner balls cut, apart": Regime(
            sp.Max(2 * m, 2 * r), 2 * M, crossing - cut, outer - 2 * mixed
        ),
        "inner balls out of reach": Regime(2 * M, 2 * R, outer, outer),
        "no contact": Regime(2 * R, sp.oo, zero, zero),
    }


SEAMS = (
    ("inner balls inside, overlapping", "inner balls inside, apart", 2 * r),
    ("inner balls inside, overlapping", "inner balls cut, overlapping", 2 * m),
    ("inner balls inside, apart", "inner balls cut, apart", 2 * m),
    ("inner balls cut, overlapping", "inner balls cut, apart", 2 * r),
    ("inner balls cut, apart", "inner balls out of reach", 2 * M),
    ("inner balls out of reach", "no contact", 2 * R),
)


def decrease(found: dict[str, Regime]) -> list[tuple[sp.Expr, sp.Expr]]:
    """For each regime, minus the derivative for L0, and the same with positive coefficients."""
    s, t = real("s", positive=True), real("t", positive=True)
    slack = {
        "inner balls inside, overlapping": [(M, m + t), (m, (L0 + s) / 2)],
        "inner balls inside, apart": [(M, m + t), (m, (L0 + s) / 2)],
        "inner balls cut, overlapping": [],
        "inner balls cut, apart": [(L0, 2 * (M - m) + s), (M, m + t)],
        "inner balls out of reach": [(M, (L0 + s) / 2 - m)],
    }
    pairs = []
    for name, changes in slack.items():
        slope = -sp.diff(found[name].volume, L0)
        pairs.append((slope.subs(changes), positive_form(slope, changes)))
    return pairs


def workspace(d: Derivation) -> dict[str, Regime]:
    """Add section 3.1: the volume for all lengths, and the lengths with the largest volume."""
    found = regimes()
    reach, inner = real("R", positive=True), real("r", positive=True)

    bracket = L0**2 + 2 * L0 * (reach + inner) - 3 * (reach - inner) ** 2
    mixed = pi * (reach + inner - L0) ** 2 * bracket / (12 * L0)

    def by_radii(e: sp.Expr) -> sp.Expr:
        return sp.sympify(e).subs(
            {k * (M + n * m): k * u for k in (1, 2, 4) for n, u in ((1, reach), (-1, inner))}
        )

    d.step(
        "Workspace: two hollow spheres",
        "P can be reached if its distances from A and from B are between |L1 - L2| and L1 + L2.  "
        "theta1 turns this plane section about AB, so the workspace is the intersection of two "
        "hollow spheres.  Its volume is that of the lens of the outer balls, minus that of the "
        "inner balls inside the lens, plus that of the part the inner balls share.  M and m are "
        "the larger and the smaller of L1 and L2; R = M + m and r = M - m are their sum and "
        "difference.",
        {
            r"V_{lens}(R, R)": lens(reach, reach, L0),
            r"V_{lens}(r, R)": mixed,
            r"V_{lens}(r, r)": lens(inner, inner, L0),
        },
        proves=("The volume in each regime is the sum of its lenses, with their signs."),
        equal=[
            (mixed, lens(inner, reach, L0)),
            *((g.volume, g.pieces) for g in found.values()),
        ],
        rows=[
            ("inner balls", "range", "volume"),
            *(
                (
                    name.removeprefix("inner balls "),
                    tuple(map(by_radii, (g.start, L0, g.end)[: 3 - (g.end == sp.oo)])),
                    by_radii(g.volume),
                )
                for name, g in found.items()
            ),
        ],
    )
    d.step(
        "Workspace: seams of the regimes",
        "At each seam the volumes of both regimes agree, and so do their derivatives with respect "
        "to L0.  So the formula holds for all lengths, including the limits.",
        {},
        rows=[
            ("inner balls", "inner balls", "seam"),
            *(
                (*(n.removeprefix("inner balls ") for n in (a, b)), sp.Eq(L0, by_radii(at)))
                for a, b, at in SEAMS
            ),
        ],
        proves="The volumes of neighbouring regimes, and their derivatives, agree at each seam.",
        equal=[
            (g(found[a].volume).subs(L0, at), g(found[b].volume).subs(L0, at))
            for a, b, at in SEAMS
            for g in (lambda v: v, lambda v: sp.diff(v, L0))
        ],
    )
    whole = sp.Rational(4, 3) * pi * (R**3 - r**3)
    d.step(
        "Workspace: largest volume",
        "In each regime the lengths are written in terms of L0 and the distances s and t of L0 "
        "from its limits.  The table has minus the derivative of the volume with respect to L0: "
        "all its coefficients are positive, so the volume falls as L0 grows and is largest at "
        "L0 = 0.  For a given reach L1 + L2 the volume at L0 = 0 grows as the inner "
        "radius |L1 - L2| shrinks; it is largest at L1 = L2, the whole ball.  Without such a "
        "bound on the lengths there is no largest workspace.",
        {"V(L_0 = 0)": whole},
        rows=[
            ("inner balls", "fall of the volume with L0"),
            *(
                (name.removeprefix("inner balls "), sp.factor(form))
                for name, (_, form) in zip(found, decrease(found), strict=False)
            ),
        ],
        proves="The volume at L0 = 0 is as stated, and so is minus the derivative for each regime.",
        equal=[
            (found["inner balls inside, overlapping"].volume.subs(L0, 0), whole),
            *decrease(found),
        ],
    )
    v = Program()
    longer, shorter = v.let("M", sp.Max(L1, L2)), v.let("m", sp.Min(L1, L2))
    size = v.bound("R", L1 + L2, L1 + L2, "lengths are not negative")
    gap = v.let("r", longer - shorter)
    named = [(M, longer), (m, shorter)]
    near, apart, crossing, cut, far, none = (g.volume.subs(named) for g in found.values())
    volume = sp.Piecewise(
        (none, 2 * size <= L0),
        (far, 2 * longer <= L0),
        (near, 2 * sp.Min(shorter, gap) >= L0),
        (cut, 2 * sp.Max(shorter, gap) <= L0),
        (apart, 2 * shorter >= L0),
        (crossing, True),
    )
    d.function(
        "workspace_volume",
        "Volume of the workspace.",
        {},
        {"volume": volume},
        program=v,
        source="section 3.1, in closed form",
        notes=("NaN if a length is negative or not finite.",),
    )
    return found
