"""The points that a line shares with a circle or with another line, and the direction of a line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.legs import Naming, cross_in_plane
from closedform.lemmas.registry import theorem
from closedform.model.functions import choose
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "line and circle",
    statement=r"""Let $\mathbf t \ne 0$ and $\mathbf w$ be vectors of a plane, $h = \mathbf
t\cdot\mathbf t$, $m = \mathbf t\cdot\mathbf w$ and $p = t_1 w_2 - t_2 w_1$.  The points $\mathbf x$
of the line of $\mathbf t$ through the origin at the distance $r \ge 0$ from $\mathbf w$ are
$$\mathbf x = \frac{m - \sigma\sqrt{h r^2 - p^2}}{h}\,\mathbf t, \qquad \sigma = \pm 1.$$""",
    proof=r"""With $\mathbf x = \lambda\,\mathbf t$ the distance gives $h\lambda^2 - 2 m\lambda +
\mathbf w\cdot\mathbf w = r^2$, a quadratic equation in $\lambda$.  By Lagrange's identity $m^2 +
p^2 = h\,\mathbf w\cdot\mathbf w$, so a quarter of its discriminant is $m^2 - h\,\mathbf
w\cdot\mathbf w + h r^2 = h r^2 - p^2$.""",
)
theorem(
    "direction of a line",
    statement=r"""Let $\mathbf w \ne 0$ be a vector of a plane.  The unit vectors $\mathbf t$ with
$t_1 w_2 - t_2 w_1 = e$ are
$$\mathbf t = \frac{1}{d^2}\left(k\,\mathbf w + e\begin{pmatrix} w_2\\ -w_1\end{pmatrix}\right),
\qquad d^2 = \mathbf w\cdot\mathbf w, \qquad k = \sigma\sqrt{d^2 - e^2}, \qquad \sigma = \pm 1.$$
They exist if and only if $|e| \le d$.""",
    proof=r"""The vectors $\mathbf w$ and $(w_2, -w_1)$ are at right angles and equally long.  So
$\mathbf t$ is a sum of both, and its products with them are $k = \mathbf t\cdot\mathbf w$ and $e$.
It is a unit vector if and only if $k^2 + e^2 = d^2$.""",
    exception=r"""If $\mathbf w = 0$, every direction is a solution for $e = 0$, and none for
another $e$.""",
)
theorem(
    "intersection of lines",
    statement=r"""Let $\mathbf s$ and $\mathbf t$ be vectors of a plane with $D = s_1 t_2 - s_2 t_1
\ne 0$.  The line through the origin along $\mathbf s$ and the line through $\mathbf w$ along
$\mathbf t$ have one point in common,
$$\mathbf x = \frac{w_1 t_2 - w_2 t_1}{D}\,\mathbf s.$$""",
    proof=r"""With $\mathbf x = \lambda\,\mathbf s$ the second line gives $\lambda D = w_1 t_2 - w_2
t_1$.""",
    exception=r"""If $D = 0$, the lines are parallel.  They are the same or have no point in
common.""",
)

theorem(
    "point of a known body",
    statement=r"""If a body is known, so is each coordinate $x$ of its points, and how far it slid:
$x = c$, with $c$ computed from what is known.""",
    proof=r"""The equation is solved already.""",
)

FAR = 2**10


@dataclass(frozen=True)
class Ray:
    """A line: a point of it, and a vector along it, which is a unit vector but for rounding."""

    at: sp.Matrix
    way: sp.Matrix

    def equation(self, x: sp.Matrix) -> sp.Expr:
        """What vanishes if a point is on the line."""
        return cross_in_plane(self.way, x - self.at)


def line_and_circle(
    names: Naming,
    line: Ray,
    circle: tuple[sp.Matrix, sp.Symbol],
    unknowns: sp.Matrix,
    sigma: sp.Symbol,
) -> tuple[Link, sp.Expr]:
    """The points of a line at a distance from a centre; the sign is that of the determinant.

    Returns the link, and the length by which the line misses the circle.

    Parameters
    ----------
    names
        names quantities of the program that the names and bounds are added to
    line
        a line, in symbols or numbers
    circle
        its centre and its radius, in symbols or numbers
    unknowns
        the coordinates of the point that is sought
    sigma
        the sign that names the two points
    """
    (centre, r), t, start = circle, line.way, len(names.program.body)
    w = sp.Matrix([names.let(f"w_{i}", e) for i, e in zip("xy", centre - line.at, strict=True)])
    h = sp.simplify(t.dot(t))
    m, aside = names.let("m", w.dot(t)), names.let("aside", cross_in_plane(t, w))
    wide = r
    if h != 1:
        h = names.let("h", h, nonnegative=True)
        wide = names.let("wide", sp.sqrt(h) * r, nonnegative=True)
    root = names.half_chord("root", wide, aside, "the bar reaches the line of its slide")
    far = names.let("along", (m - sigma * root) / h)
    plain = (m - sigma * sp.sqrt(h * r**2 - aside**2)) / h
    lemma = Lemma(
        "line and circle",
        r"\mathbf x = \frac{m - \sigma\sqrt{h r^2 - p^2}}{h}\,\mathbf t",
        (line.equation(unknowns), (unknowns - centre).dot(unknowns - centre) - r**2),
        dict(zip(unknowns, line.at + far * t, strict=True)),
        2,
        signs=(sigma,),
        roles=((r"\mathbf t", t), (r"\mathbf w", w), ("m", m), ("r", r), ("p", aside)),
        plainly=dict(zip(unknowns, line.at + plain * t, strict=True)),
    )
    missed = names.let("missed", sp.Max(0, sp.Abs(aside) - wide))
    body = tuple(names.program.body[start:])
    return Link(tuple(unknowns), lemma.equations, {}, lemma, body), missed


def two_lines(
    names: Naming,
    lines: tuple[Ray, Ray],
    unknowns: sp.Matrix,
    size: sp.Expr,
    free: Sequence[sp.Symbol] = (),
    *,
    fixed: bool = False,
) -> Link:
    """The point that two lines share.

    Parameters
    ----------
    names
        names quantities of the program that the names and bounds are added to
    lines
        both lines, in symbols or numbers
    unknowns
        the coordinates of the point that is sought
    size
        that of the mechanism; lines that meet at more than ``FAR`` times it count as parallel
    free
        the joints that are free if the lines are the same
    fixed
        whether the names of their directions stand for numbers, so that they are not parallel
    """
    (a, b), p, start = lines, names.program, len(names.program.body)
    across, w = sp.simplify(cross_in_plane(a.way, b.way)), b.at - a.at
    off = names.let("off", cross_in_plane(w, b.way))
    cases: tuple[Degenerate, ...] = ()
    if fixed:
        far = names.let("along", off / across)
    else:
        cross = names.let("cross", across)
        flag = p.vanishes(
            f"parallel{names.tag}", sp.Abs(cross), 1, "two slides are parallel", tuple(free)
        )
        least = FAR * size * sp.Abs(cross) - sp.Abs(off)
        scale = FAR * names.size * names.share
        p.bound(f"near{names.tag}", least, scale, "both lines meet nearby")
        far = names.let("along", choose(flag, 0, off / cross))
        locus = dict(zip((*b.at, *b.way), (*a.at, *a.way), strict=True))
        locus = {x: e for x, e in locus.items() if x.is_Symbol}
        cases = (Degenerate((flag,), locus, free[0] if free else None, "two slides are parallel"),)
    lemma = Lemma(
        "intersection of lines",
        r"\mathbf x = \frac{w_1 t_2 - w_2 t_1}{D}\,\mathbf s",
        (a.equation(unknowns), b.equation(unknowns)),
        dict(zip(unknowns, a.at + far * a.way, strict=True)),
        1,
        roles=((r"\mathbf s", a.way), (r"\mathbf t", b.way), (r"\mathbf w", sp.Matrix(w))),
    )
    body = tuple(p.body[start:])
    return Link(tuple(unknowns), lemma.equations, {}, lemma, body, degenerate=cases)


def slide_to_line(
    names: Naming, q: sp.Symbol, normal: tuple[sp.Expr, sp.Expr], size: sp.Expr
) -> Link:
    """A slide that moves a point to a line: ``along * q = off``, both named or numbers.

    Parameters
    ----------
    names
        names quantities of the program that the names and bounds are added to
    q
        the slide
    normal
        the part of its direction along the normal of the line, and how far the line is
    size
        that of the mechanism; a slide of more than ``FAR`` times this counts as parallel
    """
    p, (across, off) = names.program, normal
    start = len(p.body)
    met = "a slider moves along the line of the hand"
    flag = p.vanishes(f"parallel{names.tag}", sp.Abs(across), 1, met, (q,))
    least, scale = FAR * size * sp.Abs(across) - sp.Abs(off), FAR * names.size * names.share
    p.bound(f"near{names.tag}", least, scale, "the slider meets the line of the hand nearby")
    value = names.let("slid", choose(flag, 0, off / across))
    lemma = Lemma(
        "oblique coordinates",
        r"q = \frac{w_1 t_2 - w_2 t_1}{D}",
        (across * q - off,),
        {q: value},
        1,
        roles=((r"w_1 t_2 - w_2 t_1", off), ("D", across)),
    )
    case = Degenerate((flag,), {across: sp.S.Zero, off: sp.S.Zero}, q, met)
    body = tuple(p.body[start:])
    return Link((q,), lemma.equations, {}, lemma, body, degenerate=(case,))


def direction(
    names: Naming,
    w: sp.Matrix,
    offset: sp.Expr,
    unknowns: sp.Matrix,
    sigma: sp.Symbol,
    *,
    free: Sequence[sp.Symbol] = (),
) -> tuple[Link, sp.Expr]:
    """The unit vectors whose line through the origin passes a point at a distance.

    The sign is that of the product with ``w``.  Returns the link, and by how much the point is too
    near.

    Parameters
    ----------
    names
        names quantities of the program that the names and bounds are added to
    w
        the point, in symbols or numbers
    offset
        its distance from the line, positive on the left; a symbol or a number
    unknowns
        the vector that is sought
    sigma
        the sign that names the two vectors
    free
        the joints that are free if the vector is
    """
    p, start = names.program, len(names.program.body)
    # squares of a slide may overflow
    whole = names.let("whole", choose(sp.Eq(names.size, 0), 1, names.size), nonnegative=True)
    share_x, share_y = (names.let(f"w_{i}", e / whole) for i, e in zip("xy", w, strict=True))
    d = names.let("apart", whole * sp.sqrt(share_x**2 + share_y**2), nonnegative=True)
    flag = p.vanishes(
        f"coincide{names.tag}", d, names.size, "both pivots of a slide coincide", tuple(free)
    )
    if offset == 0:
        share, missed, plain = sp.S.One, sp.S.Zero, sp.S.One
    else:
        over, under = (
            names.bound(n, e, "the line of a slide passes its pivots")
            for n, e in (("over", d - offset), ("under", d + offset))
        )
        low, high = (
            names.let(n, choose(flag, 1, e / d), nonnegative=True)
            for n, e in (("low", over), ("high", under))
        )
        share = names.let("share", sp.sqrt(low) * sp.sqrt(high), nonnegative=True)
        missed = names.let("missed", sp.Max(0, sp.Abs(offset) - d))
        plain = sp.sqrt(d**2 - offset**2) / d
    n = sp.Matrix(
        [
            names.let(f"n_{i}", choose(flag, z, e / d))
            for i, z, e in zip("xy", (1, 0), w, strict=True)
        ]
    )
    aside = sp.S.Zero if offset == 0 else choose(flag, 0, offset / d)

    def vector(k: sp.Expr) -> list[sp.Expr]:
        """With this share along ``w``."""
        return [k * n[0] + aside * n[1], k * n[1] - aside * n[0]]

    x = unknowns
    found = [names.let(f"t_{i}", e) for i, e in zip("xy", vector(sigma * share), strict=True)]
    lemma = Lemma(
        "direction of a line",
        r"\mathbf t = \frac{1}{d^2}(k\,\mathbf w + e\,(w_2, -w_1)),\quad "
        r"k = \sigma\sqrt{d^2 - e^2}",
        (cross_in_plane(x, w) - offset, x.dot(x) - 1),
        dict(zip(x, found, strict=True)),
        2,
        signs=(sigma,),
        roles=((r"\mathbf w", w), ("e", offset)),
        plainly=dict(zip(x, vector(sigma * plain), strict=True)),
    )
    locus = {e: sp.S.Zero for e in (*w, offset) if sp.sympify(e, strict=True).is_Symbol}
    case = Degenerate((flag,), locus, free[0] if free else None, "both pivots coincide")
    body = tuple(p.body[start:])
    return Link(tuple(x), lemma.equations, {}, lemma, body, degenerate=(case,)), missed


def either_way(way: sp.Matrix, unknowns: sp.Matrix, sigma: sp.Symbol) -> Link:
    """The unit vectors along a line whose direction is a unit vector, forwards and backwards."""
    x = unknowns
    lemma = Lemma(
        "direction of a line",
        r"\mathbf t = \sigma\,\mathbf w",
        (cross_in_plane(x, way), x.dot(x) - 1),
        dict(zip(x, sigma * way, strict=True)),
        2,
        signs=(sigma,),
        roles=((r"\mathbf w", way), ("e", sp.S.Zero)),
    )
    return Link(tuple(x), lemma.equations, {}, lemma)


def coordinate(x: sp.Symbol, value: sp.Expr) -> Link:
    """A coordinate that is known."""
    lemma = Lemma(
        "point of a known body",
        "x = c",
        (x - value,),
        {x: value},
        1,
        roles=(("x", x), ("c", value)),
    )
    return Link((x,), lemma.equations, {}, lemma)


__all__ = [
    "Ray",
    "coordinate",
    "direction",
    "either_way",
    "line_and_circle",
    "slide_to_line",
    "two_lines",
]
