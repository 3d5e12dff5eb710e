"""Conditioning, loci and workspace of the hybrid five-bar linkage: sections 2.5, 3.1, 3.2, 3.4."""

from typing import NamedTuple

import sympy as sp
from sympy import cos, pi, sin, sqrt

from closedform.algebra import positive_form
from closedform.derivation import Derivation
from closedform.functions import Program, real
from closedform.loops import degree, eliminate
from closedform.volumes import lens

L0, L1, L2 = lengths = tuple(real(name, positive=True) for name in ("L0", "L1", "L2"))
y, rho = plane = real("y"), real("rho")
kappa = real("kappa", positive=True)
m, M = real("m", positive=True), real("M", positive=True)
"""The shorter and the longer of L1 and L2."""
R, r = M + m, M - m
AP, BP = sp.Matrix([y, rho]), sp.Matrix([y - L0, rho])
alpha, beta = (v.dot(v) + L2**2 - L1**2 for v in (AP, BP))


def conditioning(d: Derivation, A: sp.Matrix, psi: sp.Expr) -> None:
    """Singular values of A, given in the angles; ``psi`` is the angle from CP to DP."""
    c = cos(psi)
    gram = L2**2 * sp.Matrix([[1, 0, 0], [0, 1, c], [0, c, 1]])
    lam = real("lambda")
    h, e = real("h", nonnegative=True), real("e", nonnegative=True)
    by_chord = [(cos(psi), (e**2 - h**2) / L2**2), (L2, sqrt(h**2 + e**2))]
    d.step(
        "Singular values and condition number of A",
        "k is at right angles to CP and DP, so A A^T has one entry off its diagonal, the product "
        "of CP and DP.  With h half of CD and e the distance of P from CD, CP DP = e^2 - h^2 and "
        "L2^2 = h^2 + e^2: the singular values are L2, h sqrt 2 and e sqrt 2, and the condition "
        "number is the larger of h/e and e/h, for either sign of the cosine.",
        {
            r"A A^T": gram,
            r"\sigma^2": sp.Matrix([L2**2 * (1 - c), L2**2, L2**2 * (1 + c)]),
            r"\kappa": sqrt((1 + sp.Abs(c)) / (1 - sp.Abs(c))),
            r"\kappa(h, e)": sp.Max(h, e) / sp.Min(h, e),
        },
        published=("(6)", "(7)", "(8)"),
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
    d.step(
        "Isotropy",
        "kappa = 1 where CP and DP are at right angles: h = e, so CD = sqrt 2 L2.  theta2 and "
        "theta3 are independent, so CD takes every value from max(0, L0 - 2 L1) to L0 + 2 L1: A "
        "can be isotropic if and only if sqrt 2 L2 lies between the two (and L2 > 0).",
        {"d_{min}": sp.Max(0, L0 - 2 * L1), "d_{max}": L0 + 2 * L1},
        equal=[
            (gram.subs(cos(psi), 0), L2**2 * sp.eye(3)),
            *(
                ((L0 + L1 * cos(b) - L1 * cos(a)) ** 2 + (L1 * sin(b) - L1 * sin(a)) ** 2, end**2)
                for a, b, end in ((pi, 0, L0 + 2 * L1), (0, pi, L0 - 2 * L1))
            ),
        ],
    )
    d.step(
        "Designs without parallel singularities",
        "det A vanishes where C = D (h = 0) and where C, P, D are in line (e = 0, CD = 2 L2).  By "
        "the range of CD, neither happens if and only if L0 > 2 L1 and 2 L2 > L0 + 2 L1.  (With "
        "2 L2 < L0 - 2 L1 the loop never closes.)",
        {r"d_{min} > 0": L0 > 2 * L1, r"d_{max} < 2 L_2": L0 + 2 * L1 < 2 * L2},
    )


class Locus(NamedTuple):
    """Where P may be for an angle psi from CP to DP: a curve, and what elimination added."""

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
    """The same curve by a second route: two equations are linear in CP, the third is its length."""
    turned = sp.Matrix([[c, s], [-s, c]]) * BP
    beta = denominator * beta
    numerator = alpha * turned - beta * AP
    return numerator.dot(numerator) - 4 * L2**2 * sp.Matrix.hstack(AP, turned).det() ** 2


class Loci(NamedTuple):
    coincident: Locus
    in_line: Locus
    isotropy: Locus
    isoconditioning: Locus


def loci(d: Derivation) -> Loci:
    """The parallel singularities, the isotropic postures and those of equal condition number."""
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
    d.step(
        "Locus of the parallel singularities",
        "DP is CP turned by psi; the vector CP is eliminated from its length and the lengths of AC "
        "and BD by resultants.  For psi = 0, C = D, what remains has degree 4: the circles of "
        "radius L2 about the two points where C and D can meet (real if L0 <= 2 L1).  For psi = "
        "pi, C, P, D in line, it is the curve of the midpoint of the coupler of a four-bar "
        "linkage, an irreducible sextic.  The elimination adds a power of rho, and of L0, which "
        "are no part of the locus.  L0 = 0 splits the sextic into the point A and the circle of "
        "squared radius "
        "L1^2 - L2^2, both twice.",
        {
            rf"\psi = 0 \text{{ (degree {same.degree})}}": sp.Eq(circles, 0),
            rf"\psi = \pi \text{{ (degree {opposite.degree})}}": sp.Eq(opposite.curve, 0),
            r"L_0 = 0": sp.factor(opposite.curve.subs(L0, 0)),
        },
        equal=[
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
    psi, named = real("psi"), (real("alpha"), real("beta"))
    d.step(
        "Isoconditioning loci",
        "kappa is the cotangent of psi/2 or its inverse, so cos psi = (kappa^2 - 1)/(kappa^2 + 1) "
        "and sin psi = 2 kappa/(kappa^2 + 1), up to their signs.  F vanishes on the curve of one "
        "psi.  Each choice gives a coupler "
        "curve, an irreducible sextic; the two signs of psi, the two assembly modes, are mirror "
        "images about AB.  Four sextics, of degree 24 together, are the locus of a condition "
        "number above 1; two, of degree 12, that of isotropy.  They do not hold theta1: in space "
        "they are surfaces of revolution about AB.",
        {
            r"\alpha": alpha,
            r"\beta": beta,
            rf"F_\psi \text{{ (degree {general.degree})}}": by_cramer(
                cos(psi), sin(psi), alpha=named[0], beta=named[1]
            ),
            r"\text{degrees}": [square.degree, 2 * square.degree, 4 * general.degree],
        },
        equal=[
            (square.curve, by_cramer(sp.S.Zero, sp.S.One)),
            (square.curve.subs(mirror), by_cramer(sp.S.Zero, -sp.S.One)),
            (general.curve, by_cramer(k2 - 1, 2 * kappa, n)),
            (general.curve.subs(mirror), by_cramer(k2 - 1, -2 * kappa, n)),
            (general.curve.subs(kappa, 1), 4 * square.curve),
        ],
    )
    return found


class Regime(NamedTuple):
    """A range of L0, from and to, and the volume there."""

    start: sp.Expr
    end: sp.Expr
    volume: sp.Expr
    pieces: sp.Expr
    """The same by inclusion and exclusion."""


def regimes() -> dict[str, Regime]:
    """The outer balls, less the inner ones, plus what the inner ones share."""
    ball = sp.Rational(4, 3) * pi * r**3
    outer, mixed, inner = lens(R, R, L0), lens(r, R, L0), lens(r, r, L0)
    cut = pi * (L0 + 4 * r) * (L0 - 2 * r) ** 2 / 12
    crossing = 8 * pi * M**2 * m**2 / L0
    near = pi * (16 * m * (3 * M**2 + m**2) - 12 * L0 * (M**2 + m**2) + L0**3) / 6
    zero = sp.S.Zero
    return {
        "inner balls inside, apart": Regime(2 * r, 2 * m, outer - 2 * ball, outer - 2 * ball),
        "inner balls inside, overlapping": Regime(zero, 2 * m, near, outer - 2 * ball + inner),
        "inner balls cut, overlapping": Regime(2 * m, 2 * r, crossing, outer - 2 * mixed + inner),
        "inner balls cut, apart": Regime(2 * m, 2 * M, crossing - cut, outer - 2 * mixed),
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
    """Minus the derivative by L0, and a form of it with positive coefficients, by regime."""
    s, t = real("s", positive=True), real("t", positive=True)
    slack = {
        "inner balls inside, apart": [(M, m + t), (m, (L0 + s) / 2)],
        "inner balls inside, overlapping": [(M, m + t), (m, (L0 + s) / 2)],
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
    """Section 3.1: the volume for all lengths, and where it is largest."""
    found = regimes()
    reach, inner = real("R", positive=True), real("r", positive=True)
    d.step(
        "Workspace: two hollow spheres",
        "P is reached if it is between |L1 - L2| and L1 + L2 away from A and from B; theta1 turns "
        "the plane section into the intersection of two hollow spheres.  Its volume is that of the "
        "outer balls' lens, less the inner balls inside it, plus what those share.  m and M are "
        "the smaller and the larger of L1 and L2, R and r their sum and difference.",
        {
            r"V_{lens}(R, R)": lens(reach, reach, L0),
            r"V_{lens}(r, R)": lens(inner, reach, L0),
            **{
                rf"V,\ {sp.latex(g.start)} \le L_0 \le {sp.latex(g.end)}": g.volume
                for g in found.values()
            },
        },
        equal=[(g.volume, g.pieces) for g in found.values()],
    )
    d.step(
        "Workspace: the regimes meet",
        "At each seam both volumes agree, and their derivatives by L0 as well, so the formula "
        "holds for all lengths, the limits included.",
        {"L_0": [seam for _, _, seam in SEAMS]},
        equal=[
            (g(found[a].volume).subs(L0, at), g(found[b].volume).subs(L0, at))
            for a, b, at in SEAMS
            for g in (lambda v: v, lambda v: sp.diff(v, L0))
        ],
    )
    whole = sp.Rational(4, 3) * pi * (R**3 - r**3)
    d.step(
        "Workspace: where it is largest",
        "In each regime minus the derivative by L0 has positive coefficients, so the volume falls "
        "as L0 grows and is largest at L0 = 0.  For a given reach L1 + L2 it then grows as the "
        "inner radius |L1 - L2| shrinks, and is largest at L1 = L2: the whole ball.  Without such "
        "a bound on the lengths there is no largest workspace.",
        {"V(L_0 = 0)": whole, r"-V'(L_0)": sp.Matrix([form for _, form in decrease(found)])},
        equal=[
            (found["inner balls inside, overlapping"].volume.subs(L0, 0), whole),
            *decrease(found),
        ],
    )
    v = Program()
    longer, shorter = v.let("longer", sp.Max(L1, L2)), v.let("shorter", sp.Min(L1, L2))
    size = v.bound("size", L1 + L2, L1 + L2, "lengths are not negative")
    gap = v.let("gap", longer - shorter)
    named = [(M, longer), (m, shorter)]
    apart, near, crossing, cut, far, none = (g.volume.subs(named) for g in found.values())
    volume = sp.Piecewise(
        (none, 2 * size <= L0),
        (far, 2 * longer <= L0),
        (sp.Piecewise((crossing, 2 * gap >= L0), (cut, True)), 2 * shorter < L0),
        (near, 2 * gap >= L0),
        (apart, True),
    )
    d.function(
        "workspace_volume",
        "Volume of the workspace.",
        {},
        {"volume": volume},
        program=v,
        source="section 3.1, in closed form",
        notes=("NaN for a length that is negative or not finite.",),
    )
    return found
