"""The points that two circles share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.lemmas.missed import SHARE
from closedform.lemmas.registry import theorem
from closedform.lemmas.spheres import Meeting, lens
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "circle intersection",
    statement=r"""Let $\mathbf n$ be a unit vector of the plane, $\mathbf n^\perp$ the same vector
turned by a right angle to the left, and $d > 0$.  The points $\mathbf x$ at the distance $r_1 >
0$ from the origin and $r_2 > 0$ from $d\,\mathbf n$ are
$$\mathbf x = \frac{d^2 + r_1^2 - r_2^2}{2 d}\,\mathbf n + \sigma h\,\mathbf n^\perp, \qquad
h = \frac{\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C}}{2 d}, \qquad \sigma = \pm 1,$$
with $\mathcal S = r_1 + r_2 + d$, $\mathcal A = r_1 + r_2 - d$, $\mathcal B = d + r_1 - r_2$ and
$\mathcal C = d - r_1 + r_2$.  They exist if and only if $\mathcal A$, $\mathcal B$ and $\mathcal C$
are not negative, and coincide if and only if one of these is zero.  Since $\mathcal B + \mathcal C
= 2 d$ and $(\mathcal B - \mathcal C)(\mathcal A + d) = 2(r_1^2 - r_2^2)$, the coefficient of
$\mathbf n$ is also
$$\frac{1}{2}\Bigl(d + \frac{(\mathcal B - \mathcal C)(\mathcal A + d)}{\mathcal B + \mathcal C}
\Bigr),$$
in which no digits cancel where the centres are close to each other.""",
    proof=r"""Write $\mathbf x = s\,\mathbf n + t\,\mathbf n^\perp$.  The distances give $s^2 +
t^2 = r_1^2$ and $(s - d)^2 + t^2 = r_2^2$.  Their difference is linear in $s$ and gives $2 d s
= d^2 + r_1^2 - r_2^2$.  Then $4 d^2 t^2 = (2 d r_1 - 2 d s)(2 d r_1 + 2 d s) = \bigl(r_2^2 - (d
- r_1)^2\bigr)\bigl((d + r_1)^2 - r_2^2\bigr) = \mathcal A\mathcal C\,\mathcal B\mathcal S$.  Of
$\mathcal A$, $\mathcal B$ and $\mathcal C$ at most one is negative, because the sum of any two
is twice a length.  So the product is not negative if and only if none of them is.""",
    exception=r"""If $d = 0$ and $r_1 = r_2$, the circles are the same and $\mathbf x$ is free on
it; if $d = 0$ and $r_1 \ne r_2$, there is no such point.""",
)


@dataclass(frozen=True)
class Chord:
    """Where two circles meet, seen from the line of their centres.

    ``direction`` points from the first centre to the second, ``distance`` is between them; a common
    point is ``along`` that line from the first centre and ``height`` to its left or right.
    """

    direction: tuple[sp.Expr, sp.Expr]
    distance: sp.Expr
    along: sp.Expr
    height: sp.Expr
    flag: sp.Symbol


def circle_intersection(
    program: Program,
    centres: tuple[sp.Expr, sp.Expr],
    radii: tuple[sp.Expr, sp.Expr],
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    scale: sp.Expr,
    share: sp.Expr = SHARE,
    free: tuple[sp.Symbol, ...] = (),
) -> tuple[Lemma, Chord]:
    """The points at two distances, the ``radii``, from two points.

    With the factors of Heron's formula the height of the triangle is ``sqrt(S*A*B*C)/(2*d)``.  If
    the radii are equal and the centres coincide, the point is free on a circle.  By convention, the
    answer is then the point on the first axis.  If both radii are the same symbol, it is the limit
    for centres that approach each other along this axis.  Circles that touch meet in one point.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    centres
        the vector from the first to the second
    radii
        the distances of the point from them
    unknowns
        the vector from the first centre to the point
    sigma
        the sign that names the two points
    scale
        the size of the coordinates, whose rounding decides what counts as zero
    share
        what the point may miss a circle by, as a share of the scale
    free
        the joints that are free if the point is
    """
    (x, y), (first, second) = unknowns, radii
    distance = program.let("apart", sp.sqrt(centres[0] ** 2 + centres[1] ** 2), nonnegative=True)
    S = first + second + distance
    # if there is a gap between the circles, the point misses each of them by half of it
    tolerated = 2 * share * scale
    A = program.bound("slack", first + second - distance, tolerated, "the bars meet")
    touching = program.vanishes("touching", A, scale, "the bars are in line")
    flag = program.vanishes("coincide", distance, scale, "the centres coincide", free)
    n: tuple[sp.Expr, sp.Expr] = (
        choose(flag, 1, centres[0] / distance),
        choose(flag, 0, centres[1] / distance),
    )
    if first == second:
        d = program.let("distance", choose(flag, 0, distance), nonnegative=True)
        along, height = d / 2, sp.sqrt(S) * sp.sqrt(A) / 2
    else:
        d = distance
        along, rise, (B, C) = lens(
            program, radii, d, slack=A, tolerated=tolerated, meaning="the bars meet"
        )
        along = choose(flag, first, along)
        height = choose(flag, 0, rise)
    n = (program.let("n_1", n[0]), program.let("n_2", n[1]))
    height = program.let("height", choose(touching, 0, height), nonnegative=True)
    plainly = {}
    if first != second:
        foot = choose(flag, first, (distance**2 + first**2 - second**2) / (2 * distance))
        plainly = {x: foot * n[0] - sigma * height * n[1], y: foot * n[1] + sigma * height * n[0]}
        if not program.suffix:
            rise = sp.sqrt(S) * sp.sqrt(A) * sp.sqrt(B) * sp.sqrt(C) / (2 * distance)
            plainly[height] = choose(sp.Or(touching, flag), 0, rise)
    return Lemma(
        "circle intersection",
        r"|\mathbf x| = r_1,\ |\mathbf x - d\,\mathbf n| = r_2 \;\Rightarrow\; \mathbf x = "
        r"\frac{d^2 + r_1^2 - r_2^2}{2 d}\,\mathbf n + \sigma h\,\mathbf n^\perp,\quad "
        r"h = \frac{\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C}}{2 d}",
        (
            x**2 + y**2 - first**2,
            (x - centres[0]) ** 2 + (y - centres[1]) ** 2 - second**2,
        ),
        {x: along * n[0] - sigma * height * n[1], y: along * n[1] + sigma * height * n[0]},
        2,
        signs=(sigma,),
        plainly=plainly,
        letters={
            name: letter
            for name, letter in zip(
                (distance, A, height, *((B, C) if first != second else ())),
                ("d", r"\mathcal A", "h", r"\mathcal B", r"\mathcal C"),
                strict=False,
            )
            if isinstance(name, sp.Symbol) and not program.suffix
        },
    ), Chord(n, d, along, height, flag)


def two_circles(
    program: Program,
    centres: Sequence[sp.Matrix],
    radii: Sequence[sp.Symbol],
    unknowns: tuple[sp.Symbol, ...],
    sigma: sp.Symbol,
    *,
    scale: sp.Expr,
    share: sp.Expr = SHARE,
    free: Sequence[sp.Symbol] = (),
) -> Meeting:
    """The points at two distances from two points, as :func:`circle_intersection` gives them.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    centres
        the two points; the coordinates of the first are symbols
    radii
        the distances, two symbols
    unknowns
        the coordinates of the point that is sought
    sigma
        the sign that names the two points
    scale
        the size of the coordinates, whose rounding decides what counts as zero
    share
        what the point may miss a circle by, as a share of the scale
    free
        the joints that are free if the point is
    """
    p, (r1, r2), (origin, other) = program, radii, centres
    # where both circles are the same the span is zero, and what else has its symbols is not
    kept = {*radii, *origin.free_symbols}
    span = sp.Matrix(
        [
            e if e == 0 or (e.is_Symbol and e not in kept) else p.let(f"u_{i}", e)
            for i, e in zip("xy", other - origin, strict=True)
        ]
    )
    start = len(p.body)
    x, y = first = real("from_x"), real("from_y")
    lemma, chord = circle_intersection(
        p,
        (span[0], span[1]),
        (r1, r2),
        first,
        sigma,
        scale=scale,
        share=share,
        free=tuple(free),
    )
    placed = {u: x - o for u, x, o in zip(first, unknowns, origin, strict=True)}
    shifted = replace(
        lemma,
        equations=tuple(e.xreplace(placed) for e in lemma.equations),
        solution={x: o + lemma[u] for u, x, o in zip(first, unknowns, origin, strict=True)},
        plainly={
            **{n: e for n, e in lemma.plainly.items() if n not in first},
            **{
                x: o + lemma.plainly[u]
                for u, x, o in zip(first, unknowns, origin, strict=True)
                if u in lemma.plainly
            },
        },
    )
    at_centre = dict.fromkeys(span.free_symbols, sp.S.Zero) | ({r2: r1} if r2 != r1 else {})
    case = Degenerate(
        (chord.flag,), at_centre, free[0] if free else None, "both circles are the same"
    )
    rise = sigma * chord.height
    return Meeting(
        Link(unknowns, shifted.equations, {}, shifted, tuple(p.body[start:]), degenerate=(case,)),
        (lemma[x], lemma[y]),
        sigma,
        chord.height * chord.distance,
        sp.Matrix([[chord.along, rise], [chord.along - chord.distance, rise]]),
    )
