"""Claims of Chablat, Wenger and Angeles about conditioning: section 3.4 and the conclusions."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.five_bar_postures import (
    NO_MODEL,
    Eq,
    FiveBar,
    J,
    Ne,
    Plane,
    closed_and,
    coincident,
    implies,
    isotropic,
    range_of_CD,
    relations,
)
from closedform.derivations.claims.hybrid_five_bar_singularities import (
    at_multiples,
    notation,
    within_reach,
)
from sympy import Abs, sqrt

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Equal,
    Every,
    ForAll,
    Gravity,
    Identity,
    Reading,
    Relation,
    Undecidable,
    normal,
    real,
)

INDEX = "old-index"
NAMES = ("$1/\\kappa^2$", "its largest value")
KAPPA = r"$\kappa(\mathbf{A}) = "
BY_COSINE = (
    KAPPA + r"\sqrt{\frac{1 + |\cos(\theta_4 - \theta_5)|}{1 - |\cos(\theta_4 - \theta_5)|}}$"
)


def state(d: Derivation, bar: FiveBar) -> None:
    """Section 3.4 and the conclusions."""
    errata(d)
    condition_number(d, bar)
    extremes(d, bar)
    loci(d, bar)
    conclusions(d, bar)


def names(bar: FiveBar) -> dict[str, object]:
    smallest, middle, largest = bar.eigenvalues
    return {
        r"\alpha_1": smallest,
        r"\alpha_2": middle,
        r"\alpha_3": largest,
        r"\kappa(\mathbf{A})": bar.kappa,
    }


def errata(d: Derivation) -> None:
    d.erratum(
        INDEX,
        "Section 3.4 uses $\\theta_3$ where $\\theta_5$ is meant",
        Gravity.RESULT,
        why="By (6) the conditioning depends on the angle $\\theta_4 - \\theta_5$ between CP and "
        "DP. Section 3.4 has $\\theta_4 - \\theta_3$, the angle between CP and BD.  The "
        "two-dof linkage of section 2.1 has the driven angles $\\theta_1$ and $\\theta_2$, so "
        "its passive angles are $\\theta_3$ and $\\theta_4$; since the revolute about AB was "
        "added, these are $\\theta_4$ and $\\theta_5$.",
        use="The condition numbers, isotropic postures and singularities of section 3.4 are those "
        "of other postures.  For $L_0 = 2$, $L_1 = L_2 = 1$ and C, D, P at (0, 1), (1, 0), (1, 1), "
        "with AB as the first axis, the matrix is isotropic: CP and DP are at right angles.  There "
        "$\\theta_3 = \\pi$, $\\theta_4 = 0$, and the paper calls it singular.",
    )
    d.erratum(
        "obtuse",
        "Formula (8) gives the inverse of the condition number if CP and DP are at an obtuse angle",
        Gravity.RESULT,
        why="The largest and the smallest eigenvalue are $L_2^2(1 \\pm |\\cos(\\theta_4 - "
        "\\theta_5)|)$, and their ratio is $\\cot^2$ of half the angle only if the cosine is not "
        "negative.  At $\\theta_4 - \\theta_5 = 2\\pi/3$ (8) gives $1/\\sqrt{3}$ instead of "
        "$\\sqrt{3}$, but a condition number is at least 1.",
        use="All postures in which CD is longer than $\\sqrt{2} L_2$ look better conditioned than "
        "the isotropic one; near $\\theta_4 - \\theta_5 = \\pi$, a parallel singularity, (8) "
        "tends to 0.",
    )
    d.erratum(
        "eigenvalue-scale",
        "The eigenvalues of $\\mathbf{A}\\mathbf{A}^T$ lack the factor $L_2^2$",
        Gravity.MISPRINT,
        why="The matrix (6) is $L_2^2$ times the matrix whose eigenvalues are printed.",
        use="The factor cancels in the condition number.  The singular values themselves are $L_2$ "
        "times those that follow from the printed eigenvalues.",
    )


def condition_number(d: Derivation, bar: FiveBar) -> None:
    """Eq. (7), the eigenvalues and eq. (8)."""
    claim = partial(
        d.claim,
        where="3.4 The isoconditioning curves",
        notation=notation(bar).extended(names(bar)),
    )
    M = sp.Matrix(2, 3, lambda i, j: real(f"M{i + 1}{j + 1}"))
    u, w = real("u"), real("w")
    form = sp.expand((sp.Matrix([[u, w]]) * M * M.T * sp.Matrix([u, w]))[0])
    claim(
        "positive-semidefinite",
        "“the square roots of the nonnegative eigenvalues of the {positive}-semidefinite … matrix”",
        lambda sign: Identity(form, sign * sum(e**2 for e in sp.Matrix([[u, w]]) * M)),
        phrases=[{"positive": 1, "negative": -1}],
        readings=[Reading("shown for a matrix of 2 rows and 3 columns")],
    )
    closed = bar.postures()

    def equal(formula: Relation) -> Check:
        return Equal(formula, postures=closed)

    scaled, sound = (rf"$\alpha_{i} = {form}$" for i, form in ((2, "1"), (2, "L_2^2")))
    for i, sign in ((1, "-"), (3, "+")):
        claim(
            f"eigenvalue α{i}",
            rf"$\alpha_{i} = 1 {sign} |\cos(\theta_4 - \theta_3)|$",
            equal,
            corrected=rf"$\alpha_{i} = L_2^2 (1 {sign} |\cos(\theta_4 - \theta_5)|)$",
            erratum=INDEX,
        )
    claim("eigenvalue α2", scaled, equal, corrected=sound, erratum="eigenvalue-scale")
    size = real("size", nonnegative=True)

    def ordered(chain: Relation) -> Check:
        cosine = Abs(bar.gram[1, 2])
        return Every(
            {
                f"{'so are ' * (i > 1)}{i} and {i + 1}{' are in order' * (i == 1)}": ForAll(
                    relation.subs(cosine, size)
                )
                for i, relation in enumerate(relations(chain), 1)
            }
        )

    claim("order of the eigenvalues", r"$\alpha_1 \leq \alpha_2 \leq \alpha_3$", ordered)
    printed = KAPPA + r"\frac{1}{|\tan((\theta_4 - \theta_3) / 2)|}$"
    claim("eq. (8)", printed, equal, corrected=BY_COSINE, erratum=INDEX)
    t5 = bar.angles[4]
    claim(
        "eq. (8), obtuse angles",
        printed,
        equal,
        readings=[
            Reading("with the angle of DP in the place of the third one", means={r"\theta_3": t5})
        ],
        corrected=BY_COSINE,
        erratum="obtuse",
    )
    claim(
        "surfaces of revolution",
        "“These loci are, in fact, surfaces of revolution generated by the isoconditioning curves "
        "of the 2-dof manipulator, when these are rotated about the axis of the {first} revolute.”",
        lambda axis: Every(
            {
                "the turn keeps A and B in place": Identity(
                    axis.cross(bar.pivots[1] - bar.pivots[0]), sp.zeros(3, 1)
                ),
                "the condition number stays the same": Identity(
                    bar.gram.diff(bar.angles[0]), sp.zeros(3, 3)
                ),
            }
        ),
        phrases=[{"first": J, "second": bar.k}],
    )


def extremes(d: Derivation, bar: FiveBar) -> None:
    """Where the condition number is 1, and where it is infinite."""
    claim = partial(
        d.claim,
        where="3.4 The isoconditioning curves",
        notation=notation(bar).extended(names(bar)),
    )
    t4, L2 = bar.angles[3], bar.lengths[2]
    size = real("size", nonnegative=True)

    def placed(angle: Relation) -> dict[sp.Symbol, sp.Expr]:
        left = angle.left.args[0] if isinstance(angle.left, Abs) else angle.left
        return {t4: sp.solve(left - angle.right, t4)[0]}

    def minimum(
        matrix: Relation, kappa: Relation, least: Relation, angle: Relation, period: Relation
    ) -> Check:
        at = placed(angle)
        ratio = (least.left / kappa.left) ** 2
        again = {t4: at[t4] + period.left}
        there, then = bar.postures(at), bar.postures(again)
        return Every(
            {
                "the value there": Identity(ratio.subs(at), sp.S.One, names=NAMES, postures=there),
                "after one more period": Identity(
                    ratio.subs(again), sp.S.One, names=NAMES, postures=then
                ),
                "no value is smaller": ForAll(sp.Ge(1 + size, least.left**2 * (1 - size))),
                "all singular values are equal": Identity(
                    (matrix.left * matrix.left.T).subs(at), L2**2 * sp.eye(3), postures=there
                ),
            }
        )

    text = (
        "“In light of expression (8) for the condition number of the Jacobian matrix "
        "$\\mathbf{A}$, it is apparent that $\\kappa(\\mathbf{A})$ attains its minimum of $1$ when "
        "$|\\theta_%s - \\theta_4| = \\pi / 2$, the equality being understood *modulo* $\\pi$.”"
    )
    claim("minimum of 1", text % "3", minimum, corrected=text % "5", erratum=INDEX)
    text = (
        "“At the other end of the spectrum, $\\kappa(\\mathbf{A})$ tends to infinity when "
        "$\\theta_%s - \\theta_4 = k\\pi$, for k = 1, 2, …”"
    )
    claim(
        "infinity",
        text % "3",
        lambda kappa, angle: at_multiples(
            bar, 1 / kappa.left**2, placed(angle)[t4], "$1/\\kappa^2$"
        ),
        corrected=text % "5",
        erratum=INDEX,
    )
    v = sp.Matrix([real(f"v{i}") for i in (1, 2, 3)])

    def kept(kappa: int) -> Check:
        c = sp.Rational(kappa**2 - 1, kappa**2 + 1)
        gram = L2**2 * sp.Matrix([[1, 0, 0], [0, 1, c], [0, c, 1]])
        return Identity((v.T * gram.inv() * v)[0] * L2**2, v.dot(v))

    claim(
        "isotropic",
        "“When matrix” [...] “attains a condition number of {unity}, it is termed *isotropic*, its "
        "inversion being performed {without any} roundoff-error amplification.”",
        kept,
        phrases=[{"unity": 1, "two": 2}],
        opposites={"without any": "with"},
        readings=[
            Reading("its inverse changes the lengths of all vectors by the same factor, so it does "
                    "not enlarge their relative errors")
        ],
    )  # fmt: skip
    text = (
        "“Manipulator postures for which condition $\\theta_%s - \\theta_4 = \\pi / 2$ holds are "
        "thus the most accurate for purposes of the direct kinematics of the manipulator.”"
    )
    claim(
        "most accurate",
        text % "3",
        lambda angle: Identity(
            (1 / bar.kappa**2).subs(placed(angle)),
            sp.S.One,
            names=NAMES,
            postures=bar.postures(placed(angle)),
        ),
        readings=[Reading("the condition number has its least value, 1")],
        corrected=text % "5",
        erratum=INDEX,
    )
    text = (
        "“manipulator postures whereby $\\theta_%s - \\theta_4 = k\\pi$ denote a singular matrix "
        "$\\mathbf{A}$”"
    )
    claim(
        "singular postures",
        text % "3",
        lambda angle, matrix: at_multiples(
            bar, normal(matrix.left.det()), placed(angle)[t4], "$\\det \\mathbf{A}$"
        ),
        corrected=text % "5",
        erratum=INDEX,
    )


def loci(d: Derivation, bar: FiveBar) -> None:
    """Where the loci are."""
    claim = partial(
        d.claim,
        where="3.4 The isoconditioning curves",
        notation=notation(bar).extended(names(bar)),
    )
    L0, L1, L2 = bar.lengths
    inside = coincident()
    d.erratum(
        "boundary",
        "Parallel singularities do not define the boundary of the workspace",
        Gravity.INCONSISTENCY,
        why="Section 2.5 says that these singularities occur inside the workspace, and section 3.1 "
        "that its boundary is where AP or BP is $L_1 + L_2$ or $|L_1 - L_2|$.  For $L_0 = 7$, "
        "$L_1 = 8$, $L_2 = 5$ C and D coincide at the distance 3.5 from A along AB and "
        "$\\sqrt{207}/2$ from AB.  P is then free on a circle of radius 5, "
        "inside the workspace except where CP is in line with AC or BD.",
        use="A planner that expects parallel singularities at the boundary only leads P through "
        "them.  Together with the boundary of the workspace, they bound the parts that one "
        "working mode reaches without a singularity, as in figures 13 and 14.",
    )

    y, rho = real("y"), real("rho")
    AP, BP = y**2 + rho**2, (y - L0) ** 2 + rho**2
    border = sp.prod(((L1 + L2) ** 2 - reach) * (reach - (L1 - L2) ** 2) for reach in (AP, BP))
    point = dict(zip((L0, L1, L2, y, rho), (*inside.lengths, *inside.P), strict=True))

    def occur(places: frozenset[str]) -> Check:
        parts: dict[str, Check] = {
            "every posture is within reach": within_reach(bar),
            "a singular posture": closed_and(inside, det_A=Eq(inside.cross, 0)),
        }
        if "inside" not in places:
            parts[r"the point P = $(y, \rho)$ of a singular posture is at the boundary"] = ForAll(
                Eq(border, 0), among=[point]
            )
        return Every(parts)

    anywhere = {"at the boundary": frozenset({"boundary"})} | {
        "inside or at the boundary": frozenset({"inside", "boundary"})
    }
    claim(
        "singularities at the boundary",
        "“Such singularities occur {at the boundary} of the Cartesian workspace of the "
        "manipulator”",
        occur,
        phrases=[anywhere],
        readings=[
            Reading("the workspace of section 3.1, the intersection of two hollow spheres"),
        ],
        corrected="“Such singularities occur {inside or at the boundary} of the Cartesian "
        "workspace of the manipulator”",
        erratum="boundary",
    )
    curves = {
        "the boundary": frozenset({"boundary"}),
        "curves inside or at the boundary": frozenset({"inside", "boundary"}),
    }
    claim(
        "singularities define the boundary",
        "“and hence, define {the boundary} of the Cartesian workspace of the manipulator.”",
        occur,
        phrases=[curves],
        corrected="“and hence, define {curves inside or at the boundary} of the Cartesian "
        "workspace of the manipulator.”",
        erratum="boundary",
    )
    claim(
        "the singularity locus",
        "“the locus of P whereby these singularities occur, namely, the *singularity locus* in the "
        "Cartesian space, {defines this boundary}.”",
        occur,
        phrases=[
            {
                "defines this boundary": frozenset({"boundary"}),
                "passes through the inside": frozenset({"inside", "boundary"}),
            }
        ],
        corrected="“the locus of P whereby these singularities occur, namely, the *singularity "
        "locus* in the Cartesian space, {passes through the inside}.”",
        erratum="boundary",
    )
    d.erratum(
        "isotropy",
        "Not all dimensions admit isotropy",
        Gravity.RESULT,
        why="Isotropy needs CP and DP at right angles, so $CD = \\sqrt{2} L_2$.  But CD is at most "
        "$L_0 + 2L_1$ and at least $L_0 - 2L_1$.  For $L_0 = L_1 = 1$, $L_2 = 3$ CD is at "
        "most 3 and would have to be $3\\sqrt{2}$.  For $L_0 = 7/2$, $L_1 = L_2 = 1$ it is at "
        "least 3/2 and would have to be $\\sqrt{2}$.",
        use="A linkage with long following bars, or with pivots far apart, has no isotropic "
        "posture.  Its best condition number belongs to the longest or the shortest CD.",
    )
    apart = (bar.bars[2] - bar.bars[3]).dot(bar.bars[2] - bar.bars[3])

    one = sp.S.One

    def possible(printed: Relation | tuple[Relation, ...]) -> Check:
        given = relations(printed)
        wanted = (sp.Le(L0 - 2 * L1, sqrt(2) * L2), sp.Le(sqrt(2) * L2, L0 + 2 * L1))
        return Every(
            {
                "CD from the angle between CP and DP": Identity(
                    apart, 2 * L2**2 - 2 * bar.gram[1, 2]
                ),
                **range_of_CD(bar),
                r"CD can be as long as $\sqrt{2} L_2$": implies(given, wanted[1], bar.lengths),
                r"CD can be as short as $\sqrt{2} L_2$": implies(
                    given, wanted[0], bar.lengths, [{L0: sp.Rational(7, 2), L1: one, L2: one}]
                ),
            }
        )

    text = (
        "“Interestingly, isotropy can be obtained regardless of the dimensions of the manipulator, "
        "as long as *i*) it is symmetric and *ii*) $L_2 \\neq 0%s$.”"
    )
    claim(
        "isotropy for all dimensions",
        text % "",
        possible,
        corrected=text % ", L_0 - 2L_1 \\leq \\sqrt{2} L_2 \\leq L_0 + 2L_1",
        erratum="isotropy",
    )
    start = isotropic()
    other = start.other_mode()
    claim(
        "Figure 15",
        "“For the two working modes, the position of the isotropic configurations are {different} "
        "(Figure 15).”",
        lambda differ: Every(
            {
                "one mode": closed_and(start, isotropic=Eq(start.dot, 0)),
                "the other one, for this P": closed_and(
                    other, isotropic=Ne(other.dot, 0) if differ else Eq(other.dot, 0)
                ),
            }
        ),
        phrases=[{"different": True, "equal": False}],
    )
    size, x = real("size", positive=True), sp.Matrix([real(f"x{i}") for i in (1, 2, 3)])
    gram = L2**2 * sp.Matrix([[1, 0, 0], [0, 1, size], [0, size, 1]])
    least = L2**2 * (1 - size)
    claim(
        "equal distance from the singularities",
        "“The isoconditioning curves are, by definition, the sets of points which are at {equal} "
        "distance from the singularities”",
        lambda scale: Every(
            {
                "no smaller change of $\\mathbf{A}$ makes it singular": Identity(
                    (x.T * gram * x)[0] - scale * least * x.dot(x),
                    L2**2 * size * (x[0] ** 2 + (x[1] + x[2]) ** 2),
                ),
                "this one does": Identity(
                    (gram - scale * least * sp.Matrix([0, 1, -1]) * sp.Matrix([[0, 1, -1]]) / 2)
                    .det(), 0
                ),
            }
        ),
        phrases=[{"equal": 1, "twice the": 2}],
        readings=[
            Reading(
                "the distance of $\\mathbf{A}$ from the singular matrices, in units of its norm: "
                "it is the inverse of the condition number"
            ),
        ],
    )  # fmt: skip
    claim(
        "minimum stiffness",
        "“can be used as a criterion for designing and/or placing the manipulator in such a way "
        "that the working trajectories be in a region of the workspace where a minimum stiffness "
        "is guaranteed.”",
        lambda: Undecidable(NO_MODEL),
        fixed="a statement about stiffness, which the paper does not model",
    )


def conclusions(d: Derivation, bar: FiveBar) -> None:
    """Section 4."""
    claim = partial(d.claim, where="4. Conclusions", notation=notation(bar))
    dets = [bar.A.det(), bar.B.det()]
    claim(
        "two Jacobian matrices",
        "“{Two} Jacobian matrices were identified in the mapping of joint rates into Cartesian "
        "velocities, namely, the direct-kinematics and the inverse-kinematics matrices.”",
        lambda n: Enumeration(
            n,
            lambda: sum(bool(normal(e).free_symbols & set(bar.angles)) for e in dets),
            "matrices that depend on the posture and can be singular",
        ),
    )
    best = Plane((0, 1, 1), *(sp.Matrix(v) for v in ([0, 1], [1, 0], [1, 1])))
    claim(
        "optimized for volume and conditioning",
        "“The hybrid manipulators studied were optimized for maximum Cartesian workspace volume "
        "and {iso-conditioning}.”",
        lambda wanted: closed_and(best, regular=Ne(best.cross, 0), conditioning=wanted(best)),
        phrases=[
            {
                "iso-conditioning": lambda at: Eq(at.dot, 0),
                "singularity": lambda at: Eq(at.cross, 0),
            }
        ],
        readings=[
            Reading(
                "the design with the largest workspace, $L_0 = 0$ and $L_1 = L_2$, has isotropic "
                "postures"
            )
        ],
    )
