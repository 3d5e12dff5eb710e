"""Claims of Reddy and Babu about the planar arm by geometry, and what they conclude."""

from collections.abc import Callable
from functools import partial

import sympy as sp
from closedform.derivations.claims import planar_2r_convention
from closedform.derivations.claims.planar_2r_notation import (
    ANGLES,
    IN_A,
    IN_B,
    LENGTHS,
    RESULTS,
    Arm,
    example_of,
    given,
    lengths_of_example,
    notation,
    rounded_coordinate,
)
from sympy import atan2, cos, pi, sin

from closedform import (
    SIGN,
    Check,
    Count,
    Derivation,
    Enumeration,
    Equal,
    Every,
    Gravity,
    Holds,
    Identity,
    Listing,
    Notation,
    Postures,
    Procedure,
    Reaches,
    Reading,
    Relation,
    Replaces,
    Rounded,
    Solves,
    Undecidable,
    real,
)

GEOMETRY = "Kinematic Analysis By Geometric Approach"
EQ3 = r"\theta_2 = a \tan 2(\pm\sqrt{1 - D^2}, D)"
EQ4 = (
    r"\tan(\beta - \alpha) = \frac{y(l_2 \cos \theta_2 + l_1) - x(l_2 \sin \theta_2)}"
    r"{x(l_2 \cos \theta_2 + l_1) + y(l_2 \sin \theta_2)}"
)
SHOULDER = (
    r"\theta_1 = a \tan 2(y(l_2 \cos \theta_2 + l_1) - x(l_2 \sin \theta_2), "
    r"x(l_2 \cos \theta_2 + l_1) + y(l_2 \sin \theta_2))"
)


def state(d: Derivation, arm: Arm) -> None:
    """Transcribe all claims, in the order of the paper."""
    known = notation(arm)
    degrees_of_freedom(d, arm)
    geometry(d, arm, known)
    planar_2r_convention.state(d, arm, known)
    results(d, arm, known)
    planar_2r_convention.example(d, arm, known)
    values(d, arm)


def degrees_of_freedom(d: Derivation, arm: Arm) -> None:
    """What the abstract says about the arm."""
    rates = arm.position.jacobian([arm.theta1, arm.theta2])
    d.claim(
        "degrees of freedom",
        "“the kinematic analysis of a {2} – degrees of freedom (DOF) planar robot”",
        lambda n: Enumeration(
            n, rates.subs(arm.theta2, pi / 2).rank, "directions in which the joints move the hand"
        ),
        where="Abstract",
        phrases=[{"2": 2, "3": 3}],
    )


def geometry(d: Derivation, arm: Arm, known: Notation) -> None:
    """Eqs. (1) to (5)."""
    l1, l2, theta1, theta2, position, _, A2, pose = arm
    x, y = position
    px, py = real("x"), real("y")
    seen = A2[:2, 3] + sp.Matrix([l1, 0])  # the hand from the base, along the first link
    at_posture = {"x": pose[0, 3], "y": pose[1, 3]}
    claim = partial(
        d.claim, where=f"{GEOMETRY}, B. Inverse Kinematics", notation=known.extended(at_posture)
    )

    forward = partial(claim, where=f"{GEOMETRY}, A. Forward Kinematics")
    forward(
        "eq. (1)",
        "“From the Fig.1, the position of the end effector can be written in terms of the joint "
        r"coordinates in the following way [...] $x = l_1 \cos\theta_1 + l_2 \cos(\theta_1 + "
        r"\theta_2)$”",
    )
    forward("eq. (2)", r"$y = l_1 \sin\theta_1 + l_2 \sin(\theta_1 + \theta_2)$")
    bend = real("b")
    above = (x * l1 * sin(theta1) - y * l1 * cos(theta1)).subs(theta2, -bend)
    claim(
        "two solutions",
        "“If the given (x, y) coordinates are within the robot’s reach there may be {two} "
        "solutions as shown in Fig. 2, the so-called {elbow up} and elbow down configurations”",
        lambda n, elbow: Every(
            {
                "there are this many solutions": Count((x - px, y - py), (theta1, theta2), n),
                r"the elbow is above the line to the hand if $\theta_2 < 0$": Identity(
                    above, elbow * l1 * l2 * sin(bend)
                ),
            }
        ),
        phrases=[{"elbow up": 1, "elbow down": -1}],
    )
    d.erratum(
        "folded",
        "The folded arm is missing among the positions with one solution",
        Gravity.OMISSION,
        why="The two elbow configurations coincide if $\\sin\\theta_2 = 0$: at $\\theta_2 = 0$, on "
        "the outer boundary of the workspace, and at $\\theta_2 = 180^\\circ$, on the inner one at "
        "the distance $|l_1 - l_2|$ from the base.  The arm of the example is folded at $(2, 0)$, "
        "where only $\\theta_1 = 0, \\theta_2 = 180^\\circ$ is a solution.",
        use="No formula of the paper changes.  A program that expects two solutions everywhere "
        "inside full reach finds one on the inner boundary; if $l_1 = l_2$, this boundary is the "
        "base, and there are infinitely many.",
    )
    one_solution = (
        "“or there may be {exactly one} solution if the manipulator {must be %s} to reach the "
        "point”"
    )
    claim(
        "one solution",
        one_solution % "fully extended",
        where_solutions_coincide(arm),
        phrases=[
            {"exactly one": 1, "two": 2},
            {
                "must be fully extended": (sp.Integer(0),),
                "must be fully extended or folded": (sp.Integer(0), pi),
                "need not be fully extended": (sp.Integer(0), pi / 2),
            },
        ],
        corrected=one_solution % "fully extended or folded",
        erratum="folded",
        readings=[
            Reading(
                "the sentence lists the cases: two solutions, exactly one, infinitely many, each "
                "with its condition",
            ),
            Reading(
                "full extension is only an example of a position with one solution",
                check=lambda n, bends: Enumeration(
                    [n] * len(bends),
                    lambda: [number_of_solutions(arm, b) for b in bends],
                    "number of solutions",
                ),
            ),
        ],
    )
    claim(
        "infinitely many solutions",
        "“There may even be an {infinite} number of solutions in some cases.”",
        lambda n: Every(
            {
                "if the links are equal and the hand is on the base": Count(
                    [e.subs({l1: 1, l2: 1}) for e in (x, y)], (theta1, theta2), n
                )
            }
        ),
    )
    D = (px**2 + py**2 - l1**2 - l2**2) / (2 * l1 * l2)
    claim(
        "cos θ2, before eq. (3)",
        "“From the Fig. 3, using the law of cosines we see that the angle θ_2 is given by "
        r"$\cos\theta_2 = \frac{x^2 + y^2 - l_1^2 - l_2^2}{2l_1l_2} = D$”",
        lambda formula: Equal(formula, defines=D),
        means={"D": D},
    )
    claim(
        "sin θ2, before eq. (3)",
        r"$\sin\theta_2 = \pm\sqrt{1 - D^2}$",
        means={"D": cos(theta2)},
    )
    claim(
        "eq. (3)",
        f"“hence, θ_2 can be found by ${EQ3}$”",
        lambda formula: Solves(
            {formula.left: formula.right},
            [l1**2 + l2**2 + 2 * l1 * l2 * cos(theta2) - px**2 - py**2],
        ),
        means={"x": px, "y": py, "D": D},
    )
    alpha, beta = atan2(seen[1], seen[0]), atan2(y, x)
    angles = {r"\alpha": alpha, r"\beta": beta}
    claim("θ1, before eq. (4)", r"$(\beta - \alpha) = \theta_1$", same_direction, means=angles)
    d.erratum(
        "tan-alpha",
        "The tangent of the angle at the base has a cosine instead of a sine",
        Gravity.MISPRINT,
        why="The numerator is the height of the hand above the line of the first link, and that is "
        "the second link times the sine of its angle.",
        use="Eq. (4), which follows, is right.  An arm that takes the angle from this line alone "
        "turns its first link to a wrong angle.",
    )
    claim(
        "tan α, before eq. (4)",
        r"$\tan \alpha = \frac{l_2 \cos \theta_2}{l_2 \cos \theta_2 + l_1}$",
        means=angles,
        corrected=r"$\tan \alpha = \frac{l_2 \sin \theta_2}{l_2 \cos \theta_2 + l_1}$",
        erratum="tan-alpha",
    )
    claim("tan β, before eq. (4)", r"$\tan \beta = \frac{y}{x}$", means=angles)
    claim("eq. (4)", f"${EQ4}$", means=angles)
    claim(
        "eq. (5)", r"“The orientation of a 2R robot is, $\phi = \theta_1 + \theta_2$”",
        same_direction,
    )  # fmt: skip


def same_direction(formula: Relation) -> Check:
    """Two angles are equal up to full turns."""
    left, right = formula.left, formula.right
    return Identity([cos(left), sin(left)], [cos(right), sin(right)])


def number_of_solutions(arm: Arm, bend: sp.Expr) -> int | None:
    """The number of postures that put the hand of the example arm where ``bend`` puts it."""
    at_example = arm.position.subs(lengths_of_example(arm))
    target = at_example.subs({arm.theta1: 0, arm.theta2: bend})
    return Count(list(at_example - target), (arm.theta1, arm.theta2), None).found()


def where_solutions_coincide(arm: Arm) -> Callable[[int, tuple[sp.Expr, ...]], Check]:
    """Lists the elbow angles at which theta2 and -theta2, the roots of eq. (3), coincide."""
    coincide = sp.solveset(sin(arm.theta2), arm.theta2, sp.Interval.Lopen(-pi, pi))

    def check(n: int, bends: tuple[sp.Expr, ...]) -> Check:
        return Listing(
            bends,
            lambda: [b for b in sorted(coincide) if number_of_solutions(arm, b) == n],
            f"elbow angles with {n} solution{'s' * (n > 1)}",
            lambda bend: ({arm.theta2: bend},),
        )

    return check


def results(d: Derivation, arm: Arm, known: Notation) -> None:
    """The numerical example by geometry, and how the paper solves its inverse."""
    example = example_of(arm)
    claim = partial(
        d.claim,
        where=f"{RESULTS}, A. Result for 2-DOF planar robot by Geometric approach",
        notation=known.extended({"x": real("x"), "y": real("y")}),
    )

    hand = arm.position.subs(example)
    in_B = [known.extended({"x": real("x"), "y": real("y")}).read(text)[0] for text in IN_B]
    d.erratum(
        "rounding",
        "The last digits of the position in example B are wrong",
        Gravity.STATEMENT,
        why="The exact position is $x = 4 + 5\\sqrt{3} = [x]$, $y = 5 + 4\\sqrt{3} = [y]$.  In A "
        "the digits after the fourth are cut off.  In B both values are too small by more than one "
        "unit of the last digit, so they are neither cut nor rounded, and they differ from those "
        "of A for the same arm at the same angles.",
        use="The hand is off by [off] cm at most.  Both methods give the same position: the "
        "different digits do not come from the methods.",
        numbers={
            "x": (hand[0], 5),
            "y": (hand[1], 5),
            "off": (sp.Max(*(h - r.right for h, r in zip(hand, in_B, strict=True))), 4),
        },
    )
    claim(
        "Results A, x",
        f"${IN_A[0]}$",
        readings=[
            Reading(
                "the digits after the fourth are cut off, as both values of A allow",
                lambda x: rounded_coordinate(arm, x, example, cut=True),
            ),
            Reading("rounded", lambda x: rounded_coordinate(arm, x, example)),
        ],
    )
    claim(
        "Results A, y",
        f"“Let us consider the link lengths and joint angles as follows ${LENGTHS}$ ${ANGLES}$ "
        f"from eq. (1) and (2), we get forward kinematic solution as below [...] ${IN_A[1]}$”",
        readings=[
            Reading(
                "the digits after the fourth are cut off",
                lambda lengths, angles, y: rounded_coordinate(
                    arm, y, given(lengths, angles), cut=True
                ),
            ),
            Reading(
                "rounded",
                lambda lengths, angles, y: rounded_coordinate(arm, y, given(lengths, angles)),
            ),
        ],
    )
    d.erratum(
        "quadrant",
        "Only the tangent of $\\theta_1$ is given, so its quadrant is open",
        Gravity.OMISSION,
        why="Eq. (4) is right, but $\\theta_1$ and $\\theta_1 + 180^\\circ$ have the same tangent. "
        "So eqs. (3) and (4) together have four solutions, and two of them put the hand at "
        "$(-x, -y)$.  The signs of the numerator and of the denominator decide, as they do in "
        "eq. (3).",
        use="A program that takes $\\theta_1 = \\tan^{-1}$ of the right side of (4) sends the "
        "hand to the opposite side of the base whenever $\\cos\\theta_1 < 0$, for example for the "
        "target $(-18, 0)$.",
    )
    claim(
        "use of eqs. (3) and (4)",
        "“The inverse kinematic solution can be obtained from {eq. (3), (4)}”",
        partial(from_equations, arm),
        phrases=[{"eq. (3), (4)": (EQ3, EQ4), "eq. (3)": (EQ3,)}],
        corrected="“The inverse kinematic solution can be obtained from {eq. (3)} and "
        f"${SHOULDER}$”",
        erratum="quadrant",
        readings=[
            Reading(
                "both are equations for the two angles, as printed; their solutions are counted "
                "for the lengths of the example"
            ),
            Reading(
                "the first angle is the arctangent of the right side of eq. (4)",
                check=partial(by_arctangent, arm),
            ),
        ],
    )
    solutions(d, arm, claim)


def target_of(arm: Arm) -> dict[sp.Symbol, sp.Expr]:
    """The names of the position, with their values at a posture."""
    return {real("x"): arm.position[0], real("y"): arm.position[1]}


def elbow_equations(arm: Arm, first: sp.Expr) -> Notation:
    """The notation of eqs. (3) and (4) for a position ``x, y``; ``first`` is beta - alpha."""
    x, y = real("x"), real("y")
    return notation(arm).extended(
        {
            "x": x,
            "y": y,
            "D": (x**2 + y**2 - arm.l1**2 - arm.l2**2) / (2 * arm.l1 * arm.l2),
            r"\alpha": real("alpha"),
            r"\beta": first + real("alpha"),
        }
    )


def from_equations(arm: Arm, named: tuple[str, ...], *printed: Relation) -> Check:
    """Whether equations, named or printed, determine both angles for a position."""
    theta1, theta2 = arm.theta1, arm.theta2
    known = elbow_equations(arm, theta1)
    relations = [r for text in named for r in known.read(text)] + list(printed)
    source = [e - name for name, e in target_of(arm).items()]
    formulas = {r.left: r.right for r in relations}
    if set(formulas) == {theta1, theta2}:
        bend = formulas[theta2]
        return Solves({theta1: formulas[theta1].subs(theta2, bend), theta2: bend}, source)
    equations = [_equation(r, theta2) for r in relations]
    example = lengths_of_example(arm)  # solutions are counted for these lengths alone
    return Replaces(equations, source, (theta1, theta2), target_of(arm), example)


def _equation(relation: Relation, bend: sp.Symbol) -> sp.Expr:
    """An expression that vanishes where a relation holds, with either sign of the root in (3)."""
    if relation.left == bend:
        return cos(bend) - sp.simplify(cos(relation.right).subs(SIGN, 1))
    return relation.left - relation.right


def by_arctangent(arm: Arm, named: tuple[str, ...]) -> Check:
    """Eq. (3), and the arctangent of the right side of eq. (4)."""
    theta1, theta2 = arm.theta1, arm.theta2
    known = elbow_equations(arm, theta1)
    eq3, eq4 = (known.read(text)[0] for text in named)
    target = target_of(arm)
    return Procedure(
        {theta2: eq3.right, theta1: sp.atan(eq4.right)},
        target,
        Postures(target, (theta1, theta2), lengths_of_example(arm)),
    )


def solutions(d: Derivation, arm: Arm, claim: partial[None]) -> None:
    """The two solutions of the example, and its orientation."""
    example, bent = example_of(arm), elbow_solution(arm, -1)
    hand = arm.position.subs(example)
    angles = (arm.theta1, arm.theta2)
    mirrored = arm.position.subs(example | {q: -example[q] for q in angles})
    d.erratum(
        "elbow-up",
        "The elbow-up solution of the example is wrong",
        Gravity.RESULT,
        why="With both angles negative the arm is mirrored: its hand is at $([x], [mirrored])$ "
        "instead of $([x], [y])$.  Eq. (4), with $\\theta_2 = -30^\\circ$, gives "
        "$\\theta_1 = [shoulder]^\\circ$, so $\\phi = [sum]^\\circ$.",
        use="An arm that takes the printed angles misses the point by [miss] cm.  The formulas of "
        "the paper are not affected.",
        numbers={
            "x": (hand[0], 2),
            "y": (hand[1], 2),
            "mirrored": (mirrored[1], 2),
            "miss": (sp.sqrt(sum(e**2 for e in hand - mirrored)), 1),
            "shoulder": (bent[arm.theta1] * 180 / pi, 4),
            "sum": ((bent[arm.theta1] + bent[arm.theta2]) * 180 / pi, 4),
        },
    )

    def rounded(elbow: int, angles: tuple[Relation, ...]) -> Check:
        exact = elbow_solution(arm, elbow)
        at_example = arm.position.subs(lengths_of_example(arm))
        return Every(
            {
                "both angles are printed": Listing(
                    [r.left for r in angles], lambda: list(exact), "angles"
                ),
                "the exact angles": Reaches(at_example, exact, target),
            }
            | {f"${r.texts[0]}$": in_degrees(r, exact[r.left]) for r in angles}
        )

    target = arm.position.subs(example_of(arm))
    phrases = [{"elbow up": -1, "elbow down": 1}]
    claim(
        "Results A, elbow up",
        r"“For {elbow up}, $\theta_2 = -30^\circ, \theta_1 = -30^\circ$”",
        rounded,
        phrases=phrases,
        corrected=r"“For {elbow up}, $\theta_2 = -30^\circ, \theta_1 = 56.5894^\circ$”",
        erratum="elbow-up",
    )
    claim(
        "Results A, elbow down",
        r"“For {elbow down}, $\theta_2 = 30^\circ, \theta_1 = 30^\circ$”",
        rounded,
        phrases=phrases,
    )
    orientation = (
        r"“The orientation of the 2-DOF planar robot is obtained by using eq. (5) "
        r"$\phi = \theta_1 + \theta_2$ $\phi = 60^\circ \text{ or } %s^\circ$”"
    )
    claim(
        "Results A, orientation",
        orientation % "-60",
        lambda eq5, printed: Every(
            {
                name: in_degrees(r, eq5.right.subs(elbow_solution(arm, elbow)))
                for r, name, elbow in zip(printed, ("elbow down", "elbow up"), (1, -1), strict=True)
            }
        ),
        corrected=orientation % "26.5894",
        erratum="elbow-up",
    )


def in_degrees(relation: Relation, exact: sp.Expr) -> Check:
    return Rounded(relation, exact, "degrees", pi / 180)


def elbow_solution(arm: Arm, elbow: int) -> dict[sp.Symbol, sp.Expr]:
    """The angles of the example (+1), or mirrored at the line to the hand (-1)."""
    example = example_of(arm)
    lead = atan2(arm.l2 * sin(arm.theta2), arm.l1 + arm.l2 * cos(arm.theta2)).subs(example)
    return {
        arm.theta2: elbow * example[arm.theta2],
        arm.theta1: example[arm.theta1] + (1 - elbow) * lead,
    }


def values(d: Derivation, arm: Arm) -> None:
    """Sentences that read like findings."""
    claim = partial(d.claim, where=RESULTS)
    value = "a judgement of value"
    known = notation(arm).extended({"x": real("x"), "y": real("y")})
    positions = [[known.read(text)[0] for text in texts] for texts in (IN_A, IN_B)]
    claim(
        "better results",
        "“From the above it is evident that D-H Convention method has yielded better results when "
        "compared to Geometric approach.”",
        lambda: Undecidable(f"{value}: the paper does not say what makes a result better"),
        readings=[
            Reading("better to work with, as the next sentence suggests"),
            Reading(
                "closer to the exact position of the example",
                check=lambda: Holds(
                    {
                        f"{r_a.left} is closer in B": abs(r_b.right - exact)
                        < abs(r_a.right - exact)
                        for r_a, r_b, exact in zip(
                            *positions, arm.position.subs(example_of(arm)), strict=True
                        )
                    }
                ),
            ),
        ],
        fixed="what is judged here has no measure",
    )
    claim(
        "without much difficulty",
        "“This is due to the fact that the inverse kinematic solution of spatial robot (higher "
        "order DOF) can be obtained without much difficulty by D-H convention method.”",
        lambda: Undecidable(f"{value}: the paper names no spatial robot and no measure"),
        fixed="what is judged here has no measure",
    )
    claim(
        "much better",
        "“Among all the methods used, D-H Convention method is much better for analysis of a given "
        "robot manipulator and wrist combination.”",
        lambda: Undecidable(value),
        where="Conclusions",
        fixed="what is judged here has no measure",
    )
    claim(
        "MATLAB, abstract",
        "“A computer based numerical tool called MATLAB was used in developing the algorithms for "
        "analyzing kinematic attitudes of a robot and a wrist. The codes so developed were tested "
        "and verified with suitable numerical examples.”",
        lambda: Undecidable("the paper prints no code and no record of a test"),
        where="Abstract",
        fixed="a report of work",
    )
    claim(
        "MATLAB, conclusions",
        "“The algorithms were developed using MATLAB to verify the accuracy of the solutions "
        "obtained.”",
        lambda: Undecidable("the paper prints no algorithm and no accuracy"),
        where="Conclusions",
        fixed="a report of work",
    )
