"""The points that three spheres share."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.missed import SHARE
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose, sign_of
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "three spheres",
    statement=r"""Let $\mathbf c_2 = \mathbf a$ and $\mathbf c_3$ be such that $\mathbf m = \mathbf
a \times \mathbf c_3 \ne \mathbf 0$, and let $\mathbf n = \mathbf m \times \mathbf a$, $\mu =
|\mathbf a|^2$, $\lambda = |\mathbf m|^2$ and $k = \mathbf a \cdot \mathbf c_3 / \mu$.  The points
$\mathbf x$ at the distance $r_1$ from the origin, $r_2$ from $\mathbf c_2$ and $r_3$ from $\mathbf
c_3$ are $\mathbf x = X\,\mathbf a + Y\,\mathbf n + \sigma h\,\mathbf m$ with
$$X = \frac{\mu + r_1^2 - r_2^2}{2 \mu}, \qquad Y = \frac{|\mathbf c_3|^2 + r_1^2 - r_3^2 - 2 k \mu
X}{2 \lambda}, \qquad h = \sqrt{\frac{r_1^2 - \mu X^2 - \lambda \mu Y^2}{\lambda}}, \qquad \sigma =
\pm 1.$$
They exist if and only if $\mu X^2 + \lambda \mu Y^2 \le r_1^2$, and coincide if and only if these
are equal.  The first two spheres share a circle of the radius $\rho = \sqrt{r_1^2 - \mu X^2}$, and
with $\nu = \lambda / \mu$
$$Y = \frac{\nu + \mu (k - X)^2 + \rho^2 - r_3^2}{2 \lambda}, \qquad h = \sqrt{\frac{\rho^2 -
\lambda \mu Y^2}{\lambda}}.$$""",
    proof=r"""The vectors $\mathbf a$, $\mathbf n$ and $\mathbf m$ are at right angles to each
other, $|\mathbf n|^2 = \lambda \mu$, and $\mathbf c_3 = k\,\mathbf a + \mathbf n / \mu$.  Write
$\mathbf x = X\,\mathbf a + Y\,\mathbf n + Z\,\mathbf m$.  The first distance says $\mu X^2 +
\lambda \mu Y^2 + \lambda Z^2 = r_1^2$.  Each of the others, subtracted from it, is linear: $2 \mu X
= \mu + r_1^2 - r_2^2$ and $2 k \mu X + 2 \lambda Y = |\mathbf c_3|^2 + r_1^2 - r_3^2$.  These give
$X$ and $Y$, and the first equation gives $Z^2$.  With $r_1^2 = \mu X^2 + \rho^2$ and $|\mathbf
c_3|^2 = \mu k^2 + \nu$ they become the second form, in which short lengths are not the differences
of long ones.""",
    exception=r"""If the centres are in line, there is no common point unless the third sphere
contains the circle in which the first two meet, or two spheres are the same and meet the other;
then $\mathbf x$ is free on this circle.  If all three are the same, $\mathbf x$ is free on it.""",
)


@dataclass(frozen=True)
class Meeting:
    """A point that circles or spheres share.

    ``first`` leads to it from the first centre.  ``rows`` are the vectors from the centres to the
    point, in the frame of the lemma; their determinant is ``side`` times ``size``, a sign and a
    nonnegative number.
    """

    link: Link
    first: tuple[sp.Expr, ...]
    side: sp.Expr
    size: sp.Expr
    rows: sp.Matrix

    @property
    def volume(self) -> sp.Expr:
        return self.side * self.size

    @property
    def lemma(self) -> Lemma:
        assert self.link.lemma is not None
        return self.link.lemma


def three_spheres(
    program: Program,
    centres: Sequence[sp.Matrix],
    radii: Sequence[sp.Symbol],
    unknowns: tuple[sp.Symbol, ...],
    sigma: sp.Symbol,
    *,
    scale: sp.Expr,
    share: sp.Rational = SHARE,
    free: Sequence[sp.Symbol] = (),
) -> Meeting:
    """The points at three distances from three points.

    Where the three points are in line, the point that is sought may be free on a circle.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    centres
        the three points; the coordinates of the first are symbols
    radii
        the distances, three symbols
    unknowns
        the coordinates of the point that is sought
    sigma
        the sign that names the two points
    scale
        the size of the coordinates, whose rounding decides what counts as zero
    share
        what the point may miss a sphere by, as a share of the scale
    free
        the joints that are free if the point is
    """
    p = program
    r1, r2, r3 = radii
    origin, *others = centres
    u, v = (_vector(p, name, c - origin) for name, c in zip("uv", others, strict=True))
    start = len(p.body)
    uu = p.let("u_u", u.dot(u), nonnegative=True)
    vv = p.let("v_v", v.dot(v), nonnegative=True)
    square = scale**2
    same = p.vanishes("same", uu, square, "the first two centres coincide", squares=True)
    point = p.vanishes("all_same", uu + vv, square, "all centres coincide", squares=True)

    def either(at_v: sp.Expr, at_u: sp.Expr) -> sp.Expr:
        return at_u if at_u == at_v else choose(same, at_v, at_u)

    span = _vector(p, "d", [either(e, f) for e, f in zip(v, u, strict=True)])
    other = sp.Matrix([either(e, f) for e, f in zip(u, v, strict=True)])
    # where all coincide, a is as long as the mechanism, so that what is left of d is nothing to it
    whole = p.let("whole", choose(sp.Eq(scale, 0), 1, scale), nonnegative=True)
    a = sp.Matrix([p.let("a_x", choose(point, whole, span[0])), *span[1:]])
    mu = p.let("mu", choose(point, whole**2, either(vv, uu)), nonnegative=True)
    first, n, size = _frame(p, a, other, (mu, either(uu, vv)))
    line = p.vanishes("in_line", size, square * mu, "the centres are in line", free, squares=True)
    equal = r1 == r2 == r3
    beside, length = _perpendicular(p, a, whole)
    w = _vector(p, "w", [choose(line, e, f) for e, f in zip(beside, first, strict=True)])
    lam = p.let("w_w", choose(line, length, size), nonnegative=True)
    if equal:
        # |c|^2 - k mu as a product of differences: small if the last two centres are close
        left = other.dot(other - span)
        part = p.let("part", 1 / lam, nonnegative=True)
        X, Y, h = _equal_spheres(
            p, r1, (mu, part), left, flags=(point, line), scale=scale, share=share
        )
        more: tuple[sp.Symbol, ...] = ()
    else:
        lengths = (r1, either(r3, r2), either(r2, r3))
        X, Y, h, flat = _unequal_spheres(
            p, lengths, (mu, lam), other.dot(a), flags=(point, line), scale=scale, share=share
        )
        more = (flat,)
    from_first = [X * e + Y * f + sigma * h * g for e, f, g in zip(span, n, w, strict=True)]
    found = [o + x for o, x in zip(origin, from_first, strict=True)]
    place = sp.Matrix(unknowns) - origin
    lemma = Lemma(
        "three spheres",
        r"|\mathbf x| = r_1,\ |\mathbf x - \mathbf a| = r_2,\ |\mathbf x - \mathbf c_3| = r_3 "
        r"\;\Rightarrow\; \mathbf x = X\,\mathbf a + Y\,\mathbf n + \sigma h\,\mathbf m",
        tuple(
            (place - c).dot(place - c) - r**2
            for c, r in zip((sp.zeros(3, 1), u, v), radii, strict=True)
        ),
        dict(zip(unknowns, found, strict=True)),
        2,
        signs=(sigma,),
        vectors=r"Here $\mathbf m = \mathbf a \times \mathbf c_3$ and "
        r"$\mathbf n = \mathbf m \times \mathbf a$ with $\mu = |\mathbf a|^2$ and "
        r"$\lambda = |\mathbf m|^2$." + ("  The radii are equal, so $X = 1/2$." if equal else ""),
        letters={uu: r"\mu", size: r"\lambda"},
        written={"u": r"\mathbf a", "v": r"\mathbf c_3"},
    )
    D, j = sp.sqrt(mu), sp.sqrt(size)  # zero where the centres are in line
    ahead, rise = Y * D * j, sigma * h * j
    return Meeting(
        Link(
            unknowns,
            lemma.equations,
            lemma=lemma,
            body=tuple(p.body[start:]),
            degenerate=_cases((u, v), (r1, r2, r3), (same, point, line), more, free),
        ),
        tuple(from_first),
        sigma,
        h * size,
        sp.Matrix(
            [
                [X * D, ahead, rise],
                [(X - 1) * D, ahead, rise],
                [X * D - other.dot(a) / D, ahead - j / D, rise],
            ]
        ),
    )


def _equal_spheres(
    p: Program,
    r: sp.Symbol,
    squares: tuple[sp.Symbol, sp.Symbol],
    left: sp.Expr,
    *,
    flags: tuple[sp.Symbol, sp.Symbol],
    scale: sp.Expr,
    share: sp.Rational,
) -> tuple[sp.Expr, sp.Symbol, sp.Symbol]:
    """X, Y and h for one radius.

    ``squares`` has mu and the inverse of lambda, and ``left`` is 2 lambda Y.
    """
    (mu, part), (point, line) = squares, flags
    left = p.let("left", left)
    p.match(choose(line, left, 0), scale**2, "the spheres whose centres are in line share a circle")
    Y = p.let("Y", choose(line, 0, left * part / 2))
    # the error that is allowed for the spheres makes the radius of the circle larger
    missed = 2 * share * scale * r
    square = choose(point, 0, mu * (1 + 2 * left * Y) / 4)  # 2 lambda Y is left
    slack = p.bound("slack", r**2 - square, missed, "the spheres meet")
    touching = p.vanishes("touching", slack, missed, "the spheres touch")
    rise = choose(touching, 0, sp.sqrt(slack * part))
    return sp.S.Half, Y, p.let("h", rise, nonnegative=True)


def _unequal_spheres(
    p: Program,
    radii: tuple[sp.Expr, sp.Expr, sp.Expr],
    squares: tuple[sp.Symbol, sp.Symbol],
    dot: sp.Expr,
    *,
    flags: tuple[sp.Symbol, sp.Symbol],
    scale: sp.Expr,
    share: sp.Rational,
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]:
    """X, Y and h from the circle of the first two spheres.

    ``squares`` has mu and lambda, and ``dot`` is k mu.

    This circle comes from differences of lengths, which stay exact for short rods.  If the third
    sphere just misses it, the point stays on it.  The last result is a flag that is true if the
    third sphere contains it.
    """
    (r1, near, far), (mu, lam), (point, line) = radii, squares, flags
    # if the first two spheres just touch, their errors add to that of the third, so each gets a
    # third
    tolerated = 2 * share * scale / 3
    unit = p.let("length_a", sp.sqrt(mu), nonnegative=True)
    nu = p.let("nu", lam / mu, nonnegative=True)
    rest = p.let("beside_a", sp.sqrt(nu), nonnegative=True)
    D = p.let("D", choose(point, 0, unit), nonnegative=True)
    j = p.let("j", choose(line, 0, rest), nonnegative=True)
    A = p.bound("slack", r1 + near - D, tolerated, "the spheres meet")
    along, beside, _ = lens(
        p, (r1, near), D, slack=A, tolerated=tolerated, meaning="the spheres meet"
    )
    along = p.let("along", choose(point, 0, along))
    radius = p.let("rho", choose(point, r1, beside), nonnegative=True)
    part = p.let("part", 1 / (unit * rest), nonnegative=True)
    over = p.let("over_a", rest * part, nonnegative=True)
    left = p.let("left", choose(line, 0, nu) + (dot * over - along) ** 2 + radius**2 - far**2)
    meaning = "the third sphere meets the circle of the others"
    # for a radius of zero the allowed error is the same, and its square is what appears here
    missed = 2 * tolerated * (far + scale / 2**42)
    upper = p.bound("upper", 2 * j * radius + left, missed, meaning)
    lower = p.bound("lower", 2 * j * radius - left, missed, meaning)
    both = p.let("both", upper + lower, nonnegative=True)
    flat = p.vanishes("flat", both, scale * far, "the third sphere contains the circle")
    anywhere = sp.Or(flat, line)
    half = p.let("half", radius / both)
    X = p.let("X", along * over)
    Y = p.let("Y", choose(anywhere, 0, half * (upper - lower) * part * over))
    rise = choose(anywhere, radius, 2 * half * sp.sqrt(upper) * sp.sqrt(lower))
    return X, Y, p.let("h", rise * part, nonnegative=True), flat


def _frame(
    p: Program, a: sp.Matrix, c: sp.Matrix, squares: tuple[sp.Expr, sp.Expr]
) -> tuple[sp.Matrix, sp.Matrix, sp.Symbol]:
    """The vectors m and n, and the square of m; ``squares`` are those of a and c.

    Where the centres are nearly in line, the product m has lost its direction.  There it is found
    again from n, which is at right angles to a whatever m was.
    """
    (mu, square), m = squares, _vector(p, "product", a.cross(c))
    n = _vector(p, "n", m.cross(a))
    lam = p.let("product_2", m.dot(m), nonnegative=True)
    apart = mu * square
    slim = p.vanishes("slim", lam - apart / 2**12, apart, "the centres are nearly in line")
    over = p.let("over", 1 / mu, nonnegative=True)
    again = [choose(slim, e * over, f) for e, f in zip(a.cross(n), m, strict=True)]
    size = choose(slim, n.dot(n) * over, lam)
    return _vector(p, "m", again), n, p.let("m_m", size, nonnegative=True)


def lens(
    program: Program,
    radii: tuple[sp.Expr, sp.Expr],
    distance: sp.Expr,
    *,
    slack: sp.Symbol,
    tolerated: sp.Expr,
    meaning: str,
) -> tuple[sp.Expr, sp.Expr, tuple[sp.Symbol, sp.Symbol]]:
    """Where circles or spheres meet: how far along the line of the centres, and beside it.

    The last result is the other two slacks.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    radii
        those of both circles
    distance
        that of the centres
    slack
        the sum of the radii less the distance, bounded by zero
    tolerated
        how far the other two slacks may be below zero
    meaning
        what the bounds say, in words
    """
    (first, second), A = radii, slack
    B = program.bound("outer", distance + first - second, tolerated, meaning)
    C = program.bound("inner", distance - first + second, tolerated, meaning)
    # B + C is twice the distance and B - C twice the difference of the radii, also of circles
    # that miss each other by a rounding error.  Then one slack was a little negative and is now
    # zero, and the point misses both circles by half of it, however close the centres are.
    share = program.let("share", 1 / (B + C), nonnegative=True)
    along = (distance + (B - C) * (A + distance) * share) / 2
    S = first + second + distance
    return along, sp.sqrt(S) * sp.sqrt(A) * sp.sqrt(B) * sp.sqrt(C) * share, (B, C)


def _vector(p: Program, name: str, entries: Iterable[sp.Expr]) -> sp.Matrix:
    """A vector with named entries."""
    return sp.Matrix([p.let(f"{name}_{i}", e) for i, e in zip("xyz", entries, strict=True)])


def _perpendicular(p: Program, e: sp.Matrix, scale: sp.Expr) -> tuple[tuple[sp.Expr, ...], sp.Expr]:
    """A vector at right angles to a vector, and the square of its length.

    It is the product of the vector and ``scale * (1, s, 0)``, where the sign s differs from that of
    x y.  So it is not short, and its degree in lengths is that of a product.
    """
    x, y, z = e
    side = p.let("s_w", sign_of(x * y))
    up = p.let("g_1", scale * z)
    last = p.let("g_2", scale * (y + side * x))
    return (side * up, up, -last), last**2 + 2 * up**2


def _cases(
    centres: tuple[sp.Matrix, sp.Matrix],
    radii: Sequence[sp.Expr],
    flags: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    more: tuple[sp.Symbol, ...],
    free: Sequence[sp.Symbol],
) -> tuple[Degenerate, ...]:
    """The spheres share a circle, or all of each other; then ``more`` flags are true as well."""
    (u, v), (r1, r2, r3), (same, point, line) = centres, radii, flags
    joint = free[0] if free else None
    none = dict.fromkeys(u, sp.S.Zero), dict.fromkeys(v, sp.S.Zero)
    equal = [{b: a} if isinstance(b, sp.Symbol) and a != b else {} for a, b in ((r1, r2), (r1, r3))]
    along = dict(zip(v, u, strict=True))
    return tuple(
        Degenerate((*which, *more), locus, joint, meaning)
        for which, locus, meaning in (
            ((same, line), {**none[0], **equal[0]}, "the first two spheres are the same"),
            ((line,), {**none[1], **equal[1]}, "the first and the third sphere are the same"),
            ((line,), {**along, **({r3: r2} if r3 != r2 else {})}, "the last two are the same"),
            (
                (same, point, line),
                {**none[0], **none[1], **equal[0], **equal[1]},
                "all are the same",
            ),
        )
    )
