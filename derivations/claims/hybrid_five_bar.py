"""Claims of Chablat, Wenger and Angeles about the kinematics of the hybrid five-bar linkage."""

from functools import cache, partial
from math import prod

import sympy as sp
from closedform.derivations.claims import hybrid_five_bar_conditioning as conditioning
from closedform.derivations.claims import hybrid_five_bar_design as design
from closedform.derivations.claims import hybrid_five_bar_singularities as singularities
from closedform.derivations.claims.five_bar_postures import (
    NO_MODEL,
    FiveBar,
    J,
    in_loop,
    routes,
    serial_by_position,
    sign_patterns,
)
from sympy import pi

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Equal,
    Every,
    Gravity,
    Identity,
    Notation,
    Reading,
    Relation,
    Undecidable,
    count_solutions,
    real,
)


def state(d: Derivation, bar: FiveBar) -> None:
    """Transcribe all claims, in the order of the paper."""
    abstract(d, bar)
    linkage(d, bar)
    kinematics(d, bar)
    working_modes(d, bar)
    singularities.parallel(d, bar)
    singularities.serial(d, bar)
    design.workspace(d, bar)
    design.by_design(d, bar)
    design.by_change_of_mode(d, bar)
    conditioning.state(d, bar)


def notation(bar: FiveBar) -> Notation:
    """What the paper's names mean; the legs have different lengths where L3 and L4 are named."""
    names = {rf"\theta_{i}": t for i, t in enumerate(bar.angles, 1)}
    names |= {rf"\dot{{\theta}}_{i}": rate for i, rate in enumerate(rates(bar).values(), 1)}
    names |= {f"L_{i}": length for i, length in enumerate(bar.lengths)}
    return Notation(names | {f"L_{i}": real(f"L{i}", positive=True) for i in (3, 4)})


def rates(bar: FiveBar) -> dict[sp.Symbol, sp.Symbol]:
    return {t: real(f"rate{i}") for i, t in enumerate(bar.angles, 1)}


def velocity(bar: FiveBar, point: sp.Matrix) -> sp.Matrix:
    """The derivative of a point by time."""
    return sum((point.diff(t) * w for t, w in rates(bar).items()), sp.zeros(3, 1))


def abstract(d: Derivation, bar: FiveBar) -> None:
    """The abstract and section 1, which repeats it."""
    claim = partial(d.claim, where="Abstract", notation=notation(bar))
    claim(
        "degrees of freedom",
        "“This paper focuses on the kinematic properties of a new {three}-degree-of-freedom hybrid "
        "manipulator.”",
        lambda n: Enumeration(n, lambda: bar.freedom(bar.angles), "degrees of freedom"),
    )
    claim(
        "the third revolute",
        "“This manipulator is obtained by adding in series to a five-bar planar mechanism [...] a "
        "third revolute passing through the line of centers of the two {actuated} revolute joints "
        "of the above linkage”",
        lambda line: Identity(
            *moved_about(bar.by_legs[0].diff(bar.angles[0]), bar.by_legs[0], line)
        ),
        phrases=[{"actuated": bar.pivots, "passive": bar.elbows}],
    )
    claim(
        "hybrid",
        "“The resulting architecture is hybrid in that it has {both} serial and parallel links.”",
        lambda n: Enumeration(
            n,
            lambda: len({len(list(routes(a, b))) for a, b in (("base", "AB"), ("AB", "CP"))}),
            "kinds of connection: in one way from the base to AB, in two ways from AB to P",
        ),
    )
    claim(
        "stiffer and more accurate",
        "“The hybrid manipulator studied is intrinsically stiffer and more accurate”",
        lambda: Undecidable(NO_MODEL),
        fixed="a comparison that the paper does not quantify",
    )
    claim(
        "compared with the elbow manipulator",
        "“than the classical 3-revolute-jointed 3-DOF fully serial « elbow » manipulator”",
        lambda: Undecidable(NO_MODEL),
        where="1. Introduction",
        fixed="a comparison that the paper does not quantify",
    )
    A, B = bar.pivots
    claim(
        "all actuators on the first axis",
        "“Furthermore, since {all} actuators are located on the {first} axis”",
        lambda axis: Identity(axis.cross(B - A), sp.zeros(3, 1)),
        phrases=[{"first": J, "second": bar.k}],
        opposites={"all": "not all"},
    )
    claim(
        "inertial effects",
        "“the inertial effects are considerably reduced”",
        lambda: Undecidable(NO_MODEL),
        fixed="an effect that the paper does not quantify",
    )
    design.larger_workspaces(claim)


def moved_about(
    speed: sp.Matrix, point: sp.Matrix, line: tuple[sp.Matrix, sp.Matrix]
) -> tuple[sp.Matrix, sp.Matrix]:
    """The speed of a point, and that of a turn about the line of two points, times its length."""
    along = line[1] - line[0]
    return speed * along.dot(J), along.cross(point - line[0])


def linkage(d: Derivation, bar: FiveBar) -> None:
    """Sections 2.1 and 2.2."""
    claim = partial(d.claim, where="2.1 A two-dof closed-chain manipulator", notation=notation(bar))
    t1, t2, t3, t4, t5 = bar.angles
    planar = (t2, t3, t4, t5)
    claim(
        "two degrees of freedom",
        "“A {two}-dof closed-chain manipulator”",
        lambda n: Enumeration(n, lambda: bar.freedom(planar), "degrees of freedom"),
    )
    claim(
        "five bars",
        "“The closed-chain manipulator which constitutes the parallel array of the hybrid "
        "manipulator is a {five}-bar, revolute (R)-coupled linkage”",
        lambda n: Enumeration(
            n,
            lambda: bar.freedom(planar) + 3,
            "a loop of n bars and n revolutes has n - 3 freedoms",
        ),
    )

    def drives(*driven: Relation) -> Check:
        free = [t for t in planar if t not in {r.left for r in driven}]
        return Enumeration(0, lambda: bar.freedom(free), "freedom when these angles are locked")

    claim(
        "actuated joint variables",
        r"“The actuated joint variables are $\theta_1$ and $\theta_2$”",
        drives,
        readings=[
            Reading(
                "the two motors of the linkage of figure 2 alone, before the revolute of section "
                "2.2 is added and all angles are counted from it, as in the paper's reference [3]",
                means={r"\theta_1": t2, r"\theta_2": t3},
            ),
            Reading(
                "in the numbering of eqs. (1) to (6), where the first angle turns the whole linkage"
            ),
        ],
    )
    claim(
        "Cartesian variables",
        "“while the Cartesian variables are the (x, y) coordinates of the revolute center {P}”",
        lambda point: Enumeration(
            bar.freedom(planar),
            lambda: point.jacobian([t2, t4]).subs({t1: 0, t2: pi / 2, t4: pi / 3}).rank(),
            "independent coordinates of the point while the loop moves",
        ),
        phrases=[{"P": bar.by_legs[0], "C": bar.elbows[0]}],
    )
    claim(
        "actuated joints on the pivots",
        "“To decrease the inertia effects of moving bodies, we place actuated joints of the "
        "closed-chain onto pivots {A} and {B}.”",
        lambda first, second: Identity(
            sp.Matrix.hstack(*(bar.k.cross(e - o) for e, o in
                               zip(bar.elbows, (first, second), strict=True))),
            sp.Matrix.hstack(bar.elbows[0].diff(t2), bar.elbows[1].diff(t3)),
        ),
        phrases=[
            {"A": bar.pivots[0], "C": bar.elbows[0]},
            {"B": bar.pivots[1], "D": bar.elbows[1]},
        ],
    )  # fmt: skip
    claim(
        "lengths",
        "“Lengths $L_0, L_1, L_2, L_3$, and $L_4$ define the geometry of this manipulator "
        "entirely.”",
        lambda several, last: Enumeration(
            len({r.left for r in (*several, last)}),
            lambda: len(in_loop()),
            "bars of the loop, each of which has one length between its two joints",
        ),
    )
    (a_name, b_name), rho, y = (("L_1", "L_3"), ("L_2", "L_4")), real("rho"), real("y")
    outer, inner = ([notation(bar).value(n) for n in pair] for pair in (a_name, b_name))
    turn = real("turn")

    def squared(o: sp.Expr, driven: sp.Expr, following: sp.Expr, angle: sp.Expr) -> sp.Expr:
        along, off = y - o - driven * sp.cos(angle), rho - driven * sp.sin(angle)
        return along**2 + off**2 - following**2

    def mirrored(*equal_lengths: Relation) -> Check:
        same = {r.right: r.left for r in equal_lengths}
        over_c = squared(sp.S.Zero, outer[0], inner[0], turn)
        over_d = squared(bar.lengths[0], outer[1], inner[1], pi - turn)
        return Identity(over_d.subs(y, bar.lengths[0] - y).subs(same), over_c)

    claim(
        "symmetrical",
        "“in this paper we focus on a symmetrical manipulators, with $L_1 = L_3$ and $L_2 = L_4$”",
        mirrored,
    )
    claim(
        "justified for general tasks",
        "“The symmetrical architecture of the manipulator at hand is justified for general tasks.”",
        lambda: Undecidable("the paper gives neither tasks nor a criterion"),
        fixed="a judgement of value",
    )
    claim = partial(claim, where="2.2 A three-dof hybrid manipulator")
    claim(
        "one more degree of freedom",
        "“Now we add {one} degree of freedom to the manipulator of figure 2.”",
        lambda n: Enumeration(
            n, lambda: bar.freedom(bar.angles) - bar.freedom(planar), "added degrees of freedom"
        ),
    )
    claim(
        "rotation about AB",
        "“We do this by allowing the overall two-dof manipulator to rotate about line {AB} by "
        "means of a revolute coupling the fixed link of the above manipulator with the base of the "
        "new manipulator.”",
        lambda line: Identity(*moved_about(bar.by_legs[0].diff(t1), bar.by_legs[0], line)),
        phrases=[{"AB": bar.pivots, "CD": bar.elbows}],
    )
    claim(
        "Figure 3",
        "“The {three}-dof hybrid manipulator”",
        lambda n: Enumeration(n, lambda: bar.freedom(bar.angles), "degrees of freedom"),
    )


def kinematics(d: Derivation, bar: FiveBar) -> None:
    """Eqs. (1a) to (5)."""
    names = {r"\mathbf{j}": J, r"\mathbf{k}": bar.k}
    for name, point in zip("cd", bar.elbows, strict=True):
        names |= {rf"\mathbf{{{name}}}": point, rf"\dot{{\mathbf{{{name}}}}}": velocity(bar, point)}
    over_c, over_d = (
        {r"\mathbf{p}": point, r"\dot{\mathbf{p}}": velocity(bar, point)} for point in bar.by_legs
    )
    claim = partial(
        d.claim, where="2.3 Kinematic relations", notation=notation(bar).extended(names)
    )
    claim(
        "two forms of the velocity",
        "“The velocity $\\dot{\\mathbf{p}}$ of point P can be obtained in {two} different forms, "
        "depending on the direction in which the loop is traversed”",
        lambda speed, n: Every(
            {
                "ways from AB to P along the loop": Enumeration(
                    n, lambda: len({r[0] for r in routes("AB", "CP")}), "their number"
                ),
                "the velocity is that of P": Identity(speed.left, velocity(bar, bar.by_legs[0])),
            }
        ),
        means=over_c,
    )
    claim(
        "eq. (1a)",
        r"$\dot{\mathbf{p}} = \dot{\mathbf{c}} + (\dot{\theta}_1 \mathbf{j} + \dot{\theta}_4 "
        r"\mathbf{k}) \times (\mathbf{p} - \mathbf{c})$",
        means=over_c,
    )
    claim(
        "eq. (1b)",
        r"$\dot{\mathbf{p}} = \dot{\mathbf{d}} + (\dot{\theta}_1 \mathbf{j} + \dot{\theta}_5 "
        r"\mathbf{k}) \times (\mathbf{p} - \mathbf{d})$",
        means=over_d,
    )
    joint, speed = (sp.Matrix([real(f"{n}{i}") for i in (1, 2, 3)]) for n in ("dq", "dp"))

    def follows(n: int, law: Relation, given: tuple[Relation, ...]) -> Check:
        """The law for the vectors that are given; each row by one of the two forms of (1)."""
        rate_vector, velocities = (r.right for r in given)
        rows = []
        names = (*given[0].left, *given[1].left)
        for i, leg in enumerate((0, 0, 1)):
            found = dict(zip("xyz", velocity(bar, bar.by_legs[leg]), strict=True))
            moved = velocities.subs({real(f"rate_{c}"): v for c, v in found.items()})
            both = dict(zip(names, (*rate_vector, *moved), strict=True))
            rows.append([side.row(i)[0].subs(both) for side in law.sides])
        return Every(
            {
                "the velocities of P satisfy the equation": Identity(
                    [r[0] for r in rows], [r[1] for r in rows]
                ),
                "it has three rows": Enumeration(n, lambda: law.left.rows, "independent equations"),
            }
        )

    claim(
        "eqs. (2) and (5)",
        "“The equations (1a & b) can be shown to lead to the following {3}-dimensional vector "
        "equation relating joint and Cartesian velocities [3], "
        r"$\mathbf{A}\dot{\mathbf{p}} = \mathbf{B}\dot{\boldsymbol{\theta}} \quad$” [...] "
        r"“$\dot{\boldsymbol{\theta}} = [\dot{\theta}_1, \dot{\theta}_2, \dot{\theta}_3]^T, \quad "
        r"\dot{\mathbf{p}} = [\dot{x}, \dot{y}, \dot{z}]^T$”",
        follows,
        phrases=[{"3": 3, "2": 2}],
        means={
            r"\mathbf{A}": bar.A,
            r"\mathbf{B}": bar.B,
            r"\dot{\boldsymbol{\theta}}": joint,
            r"\dot{\mathbf{p}}": speed,
            **{rf"\dot{{{c}}}": real(f"rate_{c}") for c in "xyz"},
        },
    )
    claim(
        "eq. (3)",
        r"$\mathbf{A} \equiv \begin{bmatrix} L_2 \mathbf{k}^T \\ (\mathbf{p} - \mathbf{c})^T \\ "
        r"(\mathbf{p} - \mathbf{d})^T \end{bmatrix}$",
        means={r"\mathbf{A}": bar.A_loop, r"\mathbf{p}": bar.p},
    )
    ratio = real("lambda_1")

    def by_ratio(matrix: Relation, name: Relation, definition: Relation) -> Check:
        if name.left != definition.left:
            raise ValueError("another name is defined")
        sides = tuple(side.subs(definition.left, definition.right) for side in matrix.sides)
        return Equal(Relation(sides, matrix.signs, matrix.texts), postures=bar.postures())

    d.erratum(
        "sign-of-B",
        "The entries of $\\mathbf{B}$ for the joints 2 and 3 have the wrong sign",
        Gravity.MOTION,
        why="The scalar product of $\\mathbf{p} - \\mathbf{c}$ with (1a) is $\\dot{\\theta}_2 "
        "\\mathbf{k} \\cdot (\\mathbf{c} \\times (\\mathbf{p} - \\mathbf{c}))$, if A is the "
        "origin, and that is $L_1 L_2 \\sin(\\theta_4 - \\theta_2) \\dot{\\theta}_2$.  With "
        "the rows of (3), (4) has $\\sin(\\theta_2 - \\theta_4)$ and $\\sin(\\theta_3 - "
        "\\theta_5)$ instead.  The first entry has the right sign if $\\mathbf{j}$ points from A "
        "to B; if it points from B to A, this entry has the wrong sign too.",
        use="A controller that uses (2) to (4) turns the joints 2 and 3 the wrong way for a wanted "
        "velocity of P.  The singularities, where an entry vanishes, and the working modes do not "
        "change.",
    )
    entries = (r"\sin(\theta_2 - \theta_4)", r"\sin(\theta_3 - \theta_5)")

    defined = r"“with $\lambda_1$ defined as $\lambda_1 \equiv L_2 / L_1$”"
    printed, right = (
        r"“$\mathbf{B} \equiv L_1 L_2 \begin{bmatrix} \sin(\theta_2) + \lambda_1 \sin(\theta_4) & "
        rf"0 & 0 \\ 0 & {second} & 0 \\ 0 & 0 & {third} \end{{bmatrix}}$” [...] {defined}"
        for second, third in (entries, (r"\sin(\theta_4 - \theta_2)", r"\sin(\theta_5 - \theta_3)"))
    )
    claim(
        "eq. (4)",
        printed,
        by_ratio,
        means={r"\mathbf{B}": bar.B, r"\lambda_1": ratio},
        readings=[
            Reading(r"$\mathbf{j}$ points from A to B, and the angles are counted from there"),
            Reading(
                r"$\mathbf{j}$ points from B to A",
                means={r"\mathbf{B}": sp.diag(-bar.B[0, 0], bar.B[1, 1], bar.B[2, 2])},
            ),
        ],
        corrected=right,
        erratum="sign-of-B",
    )


def working_modes(d: Derivation, bar: FiveBar) -> None:
    """Section 2.4."""
    claim = partial(d.claim, where="2.4 The working mode", notation=notation(bar))
    t1, t2, t3, t4, t5 = bar.angles
    diagonal = [bar.B[i, i] for i in range(3)]
    beside = [bar.B[i, j] for i in range(3) for j in range(3) if i != j]
    claim(
        "diagonal",
        "“The manipulator under study has a {diagonal} inverse-kinematics matrix” [...] “as shown "
        "in eq. (4)”",
        lambda zero: Identity(zero, [sp.S.Zero] * len(zero)),
        phrases=[{"diagonal": beside, "singular": [bar.B.det()]}],
    )
    claim(
        "one entry vanishes",
        "“the vanishing of {one} of its diagonal entries thus indicating the occurrence of a "
        "*serial singularity*”",
        lambda n: Enumeration(
            n,
            lambda: min(k for k in range(4) if sp.prod([sp.S.Zero] * k + diagonal[k:]) == 0),
            "the least number of vanishing entries for which the determinant vanishes",
        ),
    )
    steps = (
        (bar.loop[0], t1, {}),
        (bar.loop[1], t2, bar.in_plane),
        (bar.loop[2], t3, bar.in_plane),
    )

    @cache
    def counts() -> list[int]:
        return [count_solutions([e.subs(at)], (u,)).count for e, u, at in steps]

    claim(
        "separated by serial singularities",
        "“The different working modes are thus separated by a {serial} singularity, with a set of "
        "postures in different working modes corresponding to an inverse kinematic solution.”",
        lambda indicator: Every(
            {
                "each working mode has its own signs of $\\mathbf{B}$": sign_patterns(indicator),
                "a sign of $\\mathbf{B}$ changes only at zero": serial_by_position(bar),
            }
        ),
        phrases=[{"serial": lambda at: at.diagonal, "parallel": lambda at: (at.cross,)}],
    )
    claim(
        "eight working modes",
        "“For the manipulator at hand, the closed chain admits {eight} working modes”",
        lambda n: Enumeration(
            n, lambda: prod(counts()), "solutions for the first joint, times those of each leg"
        ),
    )
    everywhere = {t: -t for t in (t2, t3, t4, t5)}
    bisector = {t2: pi - t3, t3: pi - t2, t4: pi - t5, t5: pi - t4}

    def mirror(n: int, image: dict[sp.Symbol, sp.Expr]) -> Check:
        moved = [e.subs(image, simultaneous=True) for e in diagonal]
        return Every(
            {
                "every sign of $\\mathbf{B}$ changes": Identity(
                    [sp.expand_trig(e) for e in moved], [-sp.expand_trig(e) for e in diagonal]
                ),
                "half of the modes are images of the others": Enumeration(
                    n, lambda: prod(counts()) // 2, "the other half"
                ),
            }
        )

    claim(
        "mirror images",
        "“four of which are depicted in figure 4, the remaining {four} being the mirror image of "
        "the first ones about line {AB}”",
        mirror,
        phrases=[{"AB": everywhere, "of symmetry between A and B": bisector}],
    )
    claim(
        "Figure 4",
        "“Figure 4. The {four} working modes”",
        lambda n: Enumeration(
            n, lambda: prod(counts()[1:]), "solutions of both legs, for P on one side of AB"
        ),
    )
