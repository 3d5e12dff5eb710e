"""Claims of Chablat, Wenger and Angeles about the design: sections 3.1 to 3.3."""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from types import MappingProxyType

import sympy as sp
from closedform.derivations.claims.five_bar_postures import (
    DEFAULT,
    NO_LENGTHS,
    Eq,
    FiveBar,
    Ne,
    Plane,
    closed_and,
    implies,
    in_line,
    isotropic,
    modes,
    on_the_axis,
    range_of_CD,
    relations,
    serial_by_position,
    sign_patterns,
)
from closedform.derivations.claims.hybrid_five_bar_singularities import (
    by_design as designs,
)
from closedform.derivations.claims.hybrid_five_bar_singularities import (
    by_path_planning,
    notation,
)
from closedform.derivations.hybrid_five_bar_design import decrease
from sympy import cos, pi, sin

from closedform import (
    Check,
    Derivation,
    Enumeration,
    Every,
    ForAll,
    Gravity,
    Identity,
    Not,
    Reading,
    Relation,
    Undecidable,
    Under,
    normal,
    real,
)

NEVER = (
    "C and D never meet, so $L_0 > 2 L_1$",
    "C, P and D are never in line, so $2 L_2 > L_0 + 2 L_1$",
)
GIVEN_REACH = (
    "for a given reach $L_1 + L_2$, as in the paper's reference [7]; without a bound on the "
    "lengths there is no largest workspace"
)


def larger_workspaces(claim: Callable[..., None]) -> None:
    """The announcement of section 3.3 in the abstract and in section 1."""
    claim(
        "larger workspaces",
        "“it is shown that the special kinematic structure of our manipulator has the potential of "
        "avoiding parallel singularities by a {suitable} choice of the « working mode », thus "
        "leading to larger workspaces”",
        crossed,
        phrases=[{"suitable": True, "fixed": False}],
    )


def crossed(change: bool) -> Check:
    """A point that one working mode reaches only beyond its parallel singularity.

    With a change of mode, det A has the same sign there as at a point that both modes reach.
    """
    first = next(m for m in modes(DEFAULT, sp.Matrix([sp.Rational(7, 2), 11])) if convex(m))
    beyond = next(m for m in modes(DEFAULT, sp.Matrix([sp.Rational(7, 2), 4])) if convex(m))
    regions = [first.cross, beyond.other_mode().cross if change else beyond.cross]
    return Every(
        {
            "$\\det \\mathbf{A}$ changes its sign between two points": closed_and(
                beyond, sides=sp.Lt(first.cross * beyond.cross, 0)
            ),
            "it need not, with the chosen mode": closed_and(
                first, side=sp.Gt(regions[0] * regions[1], 0)
            ),
        }
    )


def common_point() -> Check:
    """A point that two working modes reach with det A of the same sign."""
    first = next(m for m in modes(DEFAULT, sp.Matrix([sp.Rational(7, 2), 11])) if convex(m))
    other = first.other_mode()
    return Every(
        {
            "the convex mode reaches the point with this sign of $\\det \\mathbf{A}$": closed_and(
                first, det_A=sp.Gt(first.cross, 0)
            ),
            "so does the other mode": closed_and(other, det_A=sp.Gt(other.cross, 0)),
        }
    )


def convex(posture: Plane) -> bool:
    """Whether the bars of both legs turn inwards, with P above AB."""
    _, over_c, over_d = posture.diagonal
    return bool(over_c < 0) and bool(over_d > 0)


def workspace(d: Derivation, bar: FiveBar) -> None:
    """Section 3.1."""
    claim = partial(d.claim, where="3.1 Workspace", notation=notation(bar))
    _, L1, L2 = bar.lengths
    t2, t4 = bar.angles[1], bar.angles[3]
    A, B = bar.pivots
    d.erratum(
        "radius",
        "The inner radius is $|L_1 - L_2|$",
        Gravity.OMISSION,
        why="A radius is not negative.  The designs of section 3.2 have $2L_2 - 2L_1 > L_0$, so "
        "$L_2 > L_1$, and $L_1 - L_2$ is negative for all of them.",
        use="A test of the distance from A against $L_1 - L_2$ accepts points in the hole of these "
        "designs.  The volume formula needs the absolute value too.",
    )

    def radii(outer: Relation, inner: Relation, apart: Relation) -> Check:
        at = [bar.by_legs[0].subs(t4, t2 + turned) for turned in (sp.S.Zero, pi)]
        found = [sp.sqrt(sp.factor(sp.expand(sp.trigsimp(p.dot(p))))) for p in at]
        return Identity(
            [outer.left, inner.left, apart.left],
            [*found, sp.sqrt((B - A).dot(B - A))],
            (L1 - L2,),
        )

    claim(
        "hollow spheres",
        "“A possible design of the manipulator at hand is obtained upon maximizing its workspace "
        "volume, which is given by the intersection of two hollow spheres, where radii are $L_1 + "
        "L_2$ and $L_1 - L_2$, the distance between the centers of these spheres being $L_0$.”",
        radii,
        erratum="radius",
    )
    M, m = real("M", positive=True), real("m", positive=True)
    whole = sp.Rational(4, 3) * pi * ((M + m) ** 3 - (M - m) ** 3)
    near = bar.volumes["inner balls inside, overlapping"].volume
    falls = {
        f"{'the volume falls ' * (i == 1)}in regime {i}": Identity(*pair)
        for i, pair in enumerate(decrease(bar.volumes), 1)
    }
    claim(
        "largest for L_0 = 0",
        "“Therefore, the workspace is maximum when $L_0$ is equal to {0}”",
        lambda variable, value: Every(
            {
                **falls,
                "there it is that of the hollow ball": Identity(
                    near.subs(variable.left, value), whole
                ),
            }
        ),
        phrases=[{"0": sp.S.Zero, "1": sp.S.One}],
    )
    reach = real("reach", positive=True)
    inner = real("inner", nonnegative=True)
    volume = whole.subs({M: (reach + inner) / 2, m: (reach - inner) / 2}, simultaneous=True)

    def largest(first: Relation, second: Relation) -> Check:
        gap = sp.Abs(L1 - L2).subs(second.left, first.left)
        return Under(
            Every(
                {
                    "the inner radius there": Identity(gap, sp.S.Zero),
                    "the volume lost by an inner radius": Identity(
                        volume.subs(inner, 0) - volume, sp.Rational(4, 3) * pi * inner**3
                    ),
                }
            ),
            GIVEN_REACH,
        )

    claim(
        "largest for L_1 = L_2",
        "“by extrapolating the results from [7], when $L_1$ is equal to $L_2$”",
        largest,
    )
    y, rho, angle = real("y"), real("rho"), real("angle")

    def operative(n: int, others: int, first: Relation, second: Relation, times: int = 1) -> Check:
        given = {r.left: r.right for r in (first, second)}
        # Twice: the right side of one equation may be the left side of the other.
        lengths = [e.subs(given).subs(given) for e in bar.lengths]
        four = modes(lengths, sp.Matrix([y, rho]))
        return Every(
            {
                "modes that are not always singular": Enumeration(
                    n, lambda: times * sum(normal(m.cross**2) != 0 for m in four), "for all P"
                ),
                "modes with C = D": Enumeration(
                    others, lambda: times * sum(m.C == m.D for m in four), "for all P"
                ),
            }
        )

    claim(
        "two operative working modes",
        "“We notice that the optimum manipulator has {only} {two} operative working mode because "
        "the other {two} working modes lie in parallel singular configurations (see figures 4 b & "
        "c when $L_0 = 0$ and $L_1 = L_2$)”",
        operative,
        opposites={"only": "not only"},
        readings=[
            Reading("of the four working modes of figure 4, for P on one side of AB"),
            Reading("of all eight working modes", partial(operative, times=2)),
        ],
    )
    AP = y**2 + rho**2
    border = AP * (4 * L1**2 - AP)
    mirrored = modes((sp.S.Zero, L1, L1), sp.Matrix([y, rho]))[1]
    off_axis, *legs = mirrored.diagonal
    bounds = {
        "AP = 2 L1": {y: 2 * L1 * cos(angle), rho: 2 * L1 * sin(angle)},
        "P = A": {y: sp.S.Zero, rho: sp.S.Zero},
    }

    def lie_on(place: sp.Expr, turning: bool = False) -> Check:
        """Of the plane linkage, or also of the revolute that turns it about AB."""
        factors, form = mirrored.cross**2 * sp.prod(e**2 for e in legs), (border / 4) ** 3
        on = bounds
        if turning:
            factors, form = factors * off_axis**2, form * L1**2 * rho**2
            on = {"P on AB": {rho: sp.S.Zero}, **bounds}
        names = ("the product that vanishes there", "its value")
        return Every(
            {
                "$\\det \\mathbf{A}$ or $\\det \\mathbf{B}$ vanishes with these": Identity(
                    factors, form
                ),
                **{n: Identity(place.subs(at), sp.S.Zero, names=names) for n, at in on.items()},
            }
        )

    claim(
        "all singularities at the border",
        "“Thus, {all} singularities of this mechanism lie {at the border of the workspace}.”",
        lie_on,
        opposites={"all": "not all"},
        phrases=[{"at the border of the workspace": border, "on the axis AB": rho}],
        readings=[
            Reading(
                "this mechanism is the linkage in its plane, whose four working modes the sentence "
                "before counts, and A, the limit of the inner sphere, counts as border"
            ),
            Reading("the manipulator with its three joints", partial(lie_on, turning=True)),
        ],
    )


def by_design(d: Derivation, bar: FiveBar) -> None:
    """Section 3.2."""
    claim = partial(
        d.claim,
        where="3.2 Avoiding parallel singularities by proper design",
        notation=notation(bar),
    )
    L0, L1, L2 = bar.lengths
    apart, never_in_line = sp.Gt(L0, 2 * L1), sp.Gt(2 * L2, L0 + 2 * L1)
    d.erratum(
        "C-meets-D",
        "The condition that keeps C and D apart is the wrong way round",
        Gravity.RESULT,
        why="C and D move on circles of the radius $L_1$ about A and B.  The circles meet if $2L_1 "
        "\\ge L_0$ and have no common point if $2L_1 < L_0$.  For $L_0 = L_1 = 1$ C and D "
        "coincide at $\\theta_2 = \\pi/3$, $\\theta_3 = 2\\pi/3$.  The second condition, "
        "$2L_2 - 2L_1 > L_0$, only keeps C, P and D from being in line; C and D can still "
        "coincide.",
        use="Linkages designed by these conditions have parallel singularities inside the "
        "workspace, in every working mode.  A linkage without any has $L_0 > 2L_1$ and $2L_2 "
        "- 2L_1 > L_0$, for example $L_0 = L_2 = 3$, $L_1 = 1$.",
    )

    def avoids(wanted: Sequence[sp.Expr], printed: Sequence[sp.Expr]) -> Check:
        return Every(
            {
                **range_of_CD(bar),
                **{
                    name: implies(printed, relation, bar.lengths)
                    for name, relation in zip(NEVER, wanted, strict=False)
                },
            }
        )

    sums = "If the sum of lengths $L_1 + L_1$ is {%s} than the distance between the two pivots"
    rest = " A and B, i.e. $L_0$, we eliminate a parallel singularity type."
    claim(
        "C and D apart",
        "“We choose lengths allowing to avoid this configurations for which points C and D "
        f"coincide. {sums % 'greater'}{rest}”",
        lambda total, more, distance: avoids([apart], [more(total.left, distance.left)]),
        phrases=[{"greater": sp.Gt, "smaller": sp.Lt}],
        corrected="“We choose lengths allowing to avoid this configurations for which points C and "
        f"D coincide. {sums % 'smaller'}{rest}”",
        erratum="C-meets-D",
    )
    before, after = (
        "“In the same way, we can eliminate {all} parallel singularities if the condition below "
        "is imposed:",
        "In using this property, the mechanism has {no} parallel singularity”",
    )
    first = relations(notation(bar).read("L_1 + L_1 > L_0"))
    claim(
        "no parallel singularity",
        f"{before} $2L_2 - 2L_1 > L_0$ {after}",
        lambda printed: avoids([apart, never_in_line], relations(printed)),
        opposites={"all": "not all", "no": "a"},
        readings=[
            Reading("this condition alone is sufficient"),
            Reading(
                "it is imposed in addition to the first one, as printed",
                lambda printed: avoids([apart, never_in_line], [*relations(printed), *first]),
            ),
            Reading(
                "it is imposed in addition to the first one, the right way round",
                lambda printed: avoids([apart, never_in_line], [*relations(printed), apart]),
            ),
        ],
        corrected=f"{before} $L_0 > 2L_1, 2L_2 - 2L_1 > L_0$ {after}",
        erratum="C-meets-D",
    )
    claim(
        "Figures 10 and 11",
        "“Figure 10. Cross-section of the workspace free of parallel singularities” [...] “Figure "
        "11. Cross-section of the joint space free of parallel singularities”",
        lambda: Undecidable(NO_LENGTHS),
        fixed="figures",
    )


def by_change_of_mode(d: Derivation, bar: FiveBar) -> None:
    """Section 3.3."""
    claim = partial(
        d.claim,
        where="3.3 Avoiding parallel singularities by a change of working mode",
        notation=notation(bar),
    )
    L0 = bar.lengths[0]
    claim(
        "the posture changes",
        "“According to the working mode chosen, the parallel-singularity posture {changes} inside "
        "the workspace, as displayed in figure 12.”",
        lambda judged: judged(by_path_planning()),
        phrases=[{"changes": kept, "does not change": Not}],
    )
    flat = in_line()
    claim(
        "Figure 12",
        "“In the «{convex} working mode» (Figure 12 left), the manipulator is in {parallel "
        "singularity}, while it is in a {regular configuration} in the {non-convex} working mode "
        "(Figure 12 right).”",
        lambda shape, singular, regular, other: Every(
            {
                "the first mode is as stated": closed_and(
                    flat, mode=shape(flat), det_A=singular(flat.cross)
                ),
                "so is the second mode": closed_and(
                    flat.other_mode(),
                    mode=other(flat.other_mode()),
                    det_A=regular(flat.other_mode().cross),
                ),
            }
        ),
        phrases=[
            {"convex": outline, "non-convex": lambda at: sp.Not(outline(at))},
            {
                "parallel singularity": lambda det: Eq(det, 0),
                "regular configuration": lambda det: Ne(det, 0),
            },
        ],
        readings=[
            Reading(
                "such a posture exists, for example for the lengths 7, 8, 5; the paper does not "
                "give those of the figure"
            )
        ],
    )
    claim(
        "Figures 13 and 14",
        "“It is possible, by means of a change of working mode, to reach points inside the two "
        "workspace sections displayed in figures 13 and 14.” [...] “Figure 13. Workspace of the "
        "convex working mode” [...] “Figure 14. Workspace of the nonconvex working mode”",
        lambda: Undecidable(NO_LENGTHS),
        fixed="figures",
    )
    axis = on_the_axis()

    def change(
        required: Callable[[Check], Check],
        located: Callable[[Check], Check],
        others: Mapping[str, Check] = MappingProxyType({}),
    ) -> Check:
        return Every(
            {
                "each mode has its own signs of $\\mathbf{B}$": required(
                    sign_patterns(lambda at: at.diagonal)
                ),
                "they change at the boundary": located(
                    Every(
                        {
                            "a sign of $\\mathbf{B}$ changes only at zero": serial_by_position(bar),
                            **others,
                        }
                    )
                ),
            }
        )

    inside = closed_and(axis, rho=Eq(axis.P[1], 0), **axis.interior())
    claim(
        "a change passes through a serial singularity",
        "“To change working mode, it is {necessary} to pass through a serial singularity, "
        "{located} at the boundary of the Cartesian workspace.”",
        change,
        phrases=[
            {"necessary": kept, "unnecessary": Not},
            {"located": kept, "not located": Not},
        ],
        readings=[
            Reading("the modes of figures 12 to 14, which differ in the posture of a leg"),
            Reading(
                "any two of the eight working modes of section 2.4; the mirror images meet on AB",
                partial(change, others={"P on AB is not inside": Not(inside)}),
            ),
        ],
    )
    bounds, cases = d["ik"].bounds, d["ik"].cases
    claim(
        "twice as large",
        "“By doing so, we can reach a workspace that is {twice} as large as each of those "
        "displayed in figures 13 and 14.”",
        lambda times: Undecidable(
            "the sections are the parts of the workspace that each mode reaches without a parallel "
            "singularity, as their captions say; their sizes depend on lengths that are not given"
        ),
        phrases=[{"twice": 2, "once": 1}],
        readings=[
            Reading("the union of the sections of figures 13 and 14, against each of them"),
            Reading(
                "the same, where each section is the part above AB in which $\\det \\mathbf{A}$ is "
                "positive, for the lengths 7, 8, 5; the union can be twice as large as each "
                "section only if they have no point in common",
                lambda times: Not(common_point()) if times == 2 else common_point(),
            ),
            Reading(
                "all points that the modes reach, parallel singularities included",
                lambda times: Enumeration(
                    times,
                    lambda: len({bounds(case) for _, case in cases()}),
                    "different sets of conditions on P, over all working modes",
                ),
            ),
        ],
        fixed="figures for lengths that are not given",
    )
    d.erratum(
        "never-smaller",
        "Parallel singularities can be avoided, and the workspace can be that of the serial arm",
        Gravity.INCONSISTENCY,
        why="Section 2.5 says that parallel singularities can be avoided by design or by "
        "path-planning, and section 3.2 does so.  The workspace for $L_0 = 0$, the optimum of "
        "section 3.1, is the whole hollow sphere that the serial arm with the bars $L_1$ and $L_2$ "
        "reaches, and for $L_1 = L_2$ two working modes have no parallel singularity inside.",
        use="The smaller workspace is not a reason to rule out this architecture: for $L_0 > 0$ "
        "its workspace is smaller, for $L_0 = 0$ it is as large as that of the serial arm.",
    )
    claim(
        "not avoidable",
        "“In fact, parallel singularities {not being avoidable}”",
        lambda judged: judged(designs(bar)),
        phrases=[{"not being avoidable": Not, "being avoidable": kept}],
        corrected="“In fact, parallel singularities {being avoidable}”",
        erratum="never-smaller",
    )
    M, m = real("M", positive=True), real("m", positive=True)
    serial_arm = sp.Rational(4, 3) * pi * ((M + m) ** 3 - (M - m) ** 3)

    at_zero = bar.volumes["inner balls inside, overlapping"].volume.subs(L0, 0)

    def compared(relation: type[sp.Rel]) -> Check:
        falls = {f"regime {i}": Identity(*p) for i, p in enumerate(decrease(bar.volumes), 1)}
        return Every(
            {
                "for $L_0 = 0$, where the volumes are equal": ForAll(
                    relation(sp.expand(at_zero - serial_arm), 0)
                ),
                **{f"{n}: the volume falls as $L_0$ grows": c for n, c in falls.items()},
            }
        )

    claim(
        "always smaller",
        "“the workspace of a parallel manipulator is {always smaller} than that of its serial "
        "counterpart of the same size”",
        compared,
        phrases=[{"always smaller": sp.Lt, "never larger": sp.Le}],
        corrected="“the workspace of a parallel manipulator is {never larger} than that of its "
        "serial counterpart of the same size”",
        erratum="never-smaller",
    )
    d.erratum(
        "kappa-of-B",
        "The condition number of $\\mathbf{B}$ does not depend on the working mode",
        Gravity.STATEMENT,
        why="For a given P, the diagonal entries of (4) are, up to their signs, $L_2$ times the "
        "distance of P from AB and twice the areas of the triangles ACP and BDP.  The working mode "
        "changes signs only, and singular values have none.",
        use="A working mode can be chosen by the condition number of $\\mathbf{A}$.  That of "
        "$\\mathbf{B}$ gives no preference.",
    )

    def differ(matrices: tuple[int, ...]) -> Check:
        parts: dict[str, Check] = {
            "these are two working modes": closed_and(isotropic().other_mode()),
            "entries of $\\mathbf{B}$ for a given P": serial_by_position(bar),
        }
        square_kappas = [m.conditions for m in (isotropic(), isotropic().other_mode())]
        for i in matrices:
            first, second = (kappas[i] for kappas in square_kappas)
            parts[rf"the condition numbers of $\mathbf{{{'AB'[i]}}}$ differ"] = Not(
                Identity(first, second)
            )
        return Every(parts)

    claim(
        "condition numbers differ",
        "“according to the” [...] “working mode, the condition numbers of {the direct- and the "
        "inverse-kinematics matrices} are different.”",
        differ,
        phrases=[
            {
                "the direct- and the inverse-kinematics matrices": (0, 1),
                "the direct-kinematics matrix, but not that of the other one,": (0,),
            }
        ],
        corrected="“according to the” [...] “working mode, the condition numbers of {the "
        "direct-kinematics matrix, but not that of the other one,} are different.”",
        erratum="kappa-of-B",
    )
    claim(
        "choice by the task",
        "“Thus, according to the task to execute, requiring either a precise motion or a fast "
        "motion, we can choose one suitable working mode.”",
        lambda: Undecidable("the paper gives neither tasks nor a criterion"),
        fixed="a judgement of value",
    )


def kept(check: Check) -> Check:
    """The meaning of a phrase that states what a check proves; its opposite is ``Not``."""
    return check


def outline(posture: Plane) -> sp.Expr:
    """Whether the outline A, B, D, P, C is convex."""
    corners = posture.corners()
    return sp.And(*(sp.Ge(c, 0) for c in corners))
