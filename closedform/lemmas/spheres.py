"""The points that three spheres share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose, sign_of
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "three spheres",
    statement=r"""Let $\mathbf c_2 = D\,\mathbf e_1$ and $\mathbf c_3 = k\,\mathbf e_1 + j\,\mathbf
e_2$ with $D > 0$, $j > 0$ and orthonormal $\mathbf e_1$, $\mathbf e_2$, $\mathbf e_3 = \mathbf e_1
\times \mathbf e_2$.  The points $\mathbf x$ at the distance $r_1$ from the origin, $r_2$ from
$\mathbf c_2$ and $r_3$ from $\mathbf c_3$ are $\mathbf x = X\,\mathbf e_1 + Y\,\mathbf e_2 + \sigma
h\,\mathbf e_3$ with
$$X = \frac{D^2 + r_1^2 - r_2^2}{2 D}, \qquad Y = \frac{k^2 + j^2 + r_1^2 - r_3^2 - 2 k X}{2 j},
\qquad h = \sqrt{r_1^2 - X^2 - Y^2}, \qquad \sigma = \pm 1.$$
They exist if and only if $X^2 + Y^2 \le r_1^2$, and coincide if and only if these are equal.  The
first two spheres share a circle of the radius $\rho = \sqrt{r_1^2 - X^2}$, and
$$Y = \frac{j^2 + (k - X)^2 + \rho^2 - r_3^2}{2 j}, \qquad h = \sqrt{\rho^2 - Y^2}.$$""",
    proof=r"""Write $\mathbf x = X\,\mathbf e_1 + Y\,\mathbf e_2 + Z\,\mathbf e_3$.  The first
distance says $X^2 + Y^2 + Z^2 = r_1^2$.  Each of the others, subtracted from it, is linear: $2 D X
= D^2 + r_1^2 - r_2^2$ and $2 k X + 2 j Y = k^2 + j^2 + r_1^2 - r_3^2$.  These give $X$ and $Y$, and
the first equation gives $Z^2$.  With $r_1^2 = X^2 + \rho^2$ they become the second form, in which
short lengths are not the differences of long ones.""",
    exception=r"""If the centres are in line, there is no common point unless the third sphere
contains the circle in which the first two meet, or two spheres are the same and meet the other;
then $\mathbf x$ is free on this circle.  If all three are the same, $\mathbf x$ is free on it.""",
)


@dataclass(frozen=True)
class Meeting:
    """The point that circles or spheres share.

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
    free: Sequence[sp.Symbol] = (),
) -> Meeting:
    """The points at three distances, the ``radii``, from three points.

    The coordinates of the first of the three ``centres`` are symbols, and so are the ``radii``.
    ``scale`` is the size of the coordinates, whose rounding decides what counts as zero.  Where the
    centres are in line, the point may be free on a circle; what is ``free`` then gets the status
    for it.
    """
    p = program
    r1, r2, r3 = radii
    origin, *others = centres
    u, v = (
        sp.Matrix([p.let(f"{name}_{i}", e) for i, e in zip("xyz", other - origin, strict=True)])
        for name, other in zip("uv", others, strict=True)
    )
    start = len(p.body)
    size_u = p.let("size_u", sp.sqrt(u.dot(u)), nonnegative=True)
    size_v = p.let("size_v", sp.sqrt(v.dot(v)), nonnegative=True)
    same = p.vanishes("same", size_u, scale, "the first two centres coincide")
    point = p.vanishes("all_same", size_u + size_v, scale, "all centres coincide")

    def either(at_v: sp.Expr, at_u: sp.Expr) -> sp.Expr:
        return at_u if at_u == at_v else choose(same, at_v, at_u)

    D = p.let("D", either(size_v, size_u), nonnegative=True)
    near, far = either(r3, r2), either(r2, r3)
    e1 = sp.Matrix(
        [
            p.let(f"E_1{i}", choose(point, int(i == 1), either(b, a) / D))
            for i, (a, b) in enumerate(zip(u, v, strict=True), 1)
        ]
    )
    other = sp.Matrix([either(a, b) for a, b in zip(u, v, strict=True)])
    # twice: where the centres are nearly in line, the first difference has lost its direction
    once = p.let("k_0", other.dot(e1))
    nearly = sp.Matrix([p.let(f"m_{i}", e) for i, e in zip("xyz", other - once * e1, strict=True)])
    again = p.let("k_1", nearly.dot(e1))
    across = sp.Matrix(
        [p.let(f"n_{i}", e) for i, e in zip("xyz", nearly - again * e1, strict=True)]
    )
    k = p.let("k", once + again)
    j = p.let("j", sp.sqrt(across.dot(across)), nonnegative=True)
    line = p.vanishes("in_line", j, scale, "the centres are in line", free)
    e2 = sp.Matrix(
        [
            p.let(f"E_2{i}", choose(line, beside, e / j))
            for i, (e, beside) in enumerate(zip(across, _beside(e1), strict=True), 1)
        ]
    )
    if r1 == r2 == r3:
        # k^2 + j^2 - k D as a product of differences: small where the last two centres are close
        left = other.dot(other - sp.Matrix([either(b, a) for a, b in zip(u, v, strict=True)]))
        X, Y, h = _met_by_equal(p, r1, (D, j), left, (point, line), scale)
        more: tuple[sp.Symbol, ...] = ()
    else:
        X, Y, h, flat = _met_by_unequal(p, (r1, near, far), (D, k, j), point, scale)
        more = (flat,)
    e3 = e1.cross(e2)
    from_first = [X * a + Y * b + sigma * h * c for a, b, c in zip(e1, e2, e3, strict=True)]
    found = [o + x for o, x in zip(origin, from_first, strict=True)]
    place = sp.Matrix(unknowns) - origin
    lemma = Lemma(
        "three spheres",
        r"|\mathbf x| = r_1,\ |\mathbf x - \mathbf c_2| = r_2,\ |\mathbf x - \mathbf c_3| = r_3 "
        r"\;\Rightarrow\; \mathbf x = X\,\mathbf e_1 + Y\,\mathbf e_2 + \sigma h\,\mathbf e_3",
        tuple(
            (place - c).dot(place - c) - r**2
            for c, r in zip((sp.zeros(3, 1), u, v), radii, strict=True)
        ),
        dict(zip(unknowns, found, strict=True)),
        2,
        signs=(sigma,),
        letters={size_v: r"|\mathbf c_3|"},
        vectors=(
            r"The algorithm has the entries $E_{1i}$ and $E_{2i}$ of $\mathbf e_1$ and $\mathbf "
            r"e_2$.  It takes the part along $\mathbf e_1$ out of $\mathbf c_3$ twice, because "
            r"after the first time rounding leaves some of it if the centres are nearly in line."
        ),
    )
    rise = sigma * h
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
        h * D * j,
        sp.Matrix([[X, Y, rise], [X - D, Y, rise], [X - k, Y - j, rise]]),
    )


def _met_by_equal(
    p: Program,
    r: sp.Symbol,
    lengths: tuple[sp.Expr, sp.Expr],
    left: sp.Expr,
    flags: tuple[sp.Symbol, sp.Symbol],
    scale: sp.Expr,
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
    """X, Y and h for one radius; ``lengths`` are D and j, and ``left`` is 2 j Y."""
    (D, j), (point, line) = lengths, flags
    X = p.let("X", choose(point, 0, D / 2))
    left = p.let("left", left)
    p.match(choose(line, left, 0), scale**2, "the spheres whose centres are in line share a circle")
    Y = p.let("Y", choose(line, 0, left / (2 * j)))
    radius = p.let("rho", sp.sqrt(X**2 + Y**2), nonnegative=True)
    slack = p.bound("slack", r - radius, scale, "the spheres meet")
    touching = p.vanishes("touching", slack, scale, "the spheres touch")
    rise = choose(touching, 0, sp.sqrt(slack) * sp.sqrt(r + radius))
    return X, Y, p.let("h", rise, nonnegative=True)


def _met_by_unequal(
    p: Program,
    radii: tuple[sp.Expr, sp.Expr, sp.Expr],
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    point: sp.Symbol,
    scale: sp.Expr,
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]:
    """X, Y and h from the circle of the first two spheres; ``lengths`` are D, k and j.

    This circle comes from differences of lengths, which stay exact for short rods.  If the third
    sphere just misses it, the point stays on it.  The last result is a flag that is true if the
    third sphere contains it.
    """
    (r1, near, far), (D, k, j) = radii, lengths
    # with a quarter of the tolerance, the legs accept the target of what is accepted here
    tolerated = scale / 4
    A = p.bound("slack", r1 + near - D, tolerated, "the spheres meet")
    along, beside, _ = lens(p, (r1, near), D, A, tolerated, "the spheres meet")
    X = p.let("X", choose(point, 0, along))
    radius = p.let("rho", choose(point, r1, beside), nonnegative=True)
    left = p.let("left", j**2 + (k - X) ** 2 + radius**2 - far**2)
    meaning = "the third sphere meets the circle of the others"
    # a radius of zero may be missed by as much as the others, and this by its own square
    missed = 2 * tolerated * (far + scale / 2**42)
    upper = p.bound("upper", 2 * j * radius + left, missed, meaning)
    lower = p.bound("lower", 2 * j * radius - left, missed, meaning)
    both = p.let("both", upper + lower, nonnegative=True)
    flat = p.vanishes("flat", both, scale * far, "the third sphere contains the circle")
    Y = p.let("Y", choose(flat, 0, radius * (upper - lower) / both))
    rise = choose(flat, radius, 2 * radius * sp.sqrt(upper) * sp.sqrt(lower) / both)
    return X, Y, p.let("h", rise, nonnegative=True), flat


def lens(
    program: Program,
    radii: tuple[sp.Expr, sp.Expr],
    distance: sp.Expr,
    slack: sp.Symbol,
    tolerated: sp.Expr,
    meaning: str,
    suffix: str = "",
) -> tuple[sp.Expr, sp.Expr, tuple[sp.Symbol, sp.Symbol]]:
    """Where circles or spheres meet: how far along the line of the centres, and beside it.

    ``slack`` is the sum of the ``radii`` less the ``distance``, bounded by zero.  The last result
    are the other two slacks.
    """
    (first, second), A = radii, slack
    B = program.bound(f"outer{suffix}", distance + first - second, tolerated, meaning)
    C = program.bound(f"inner{suffix}", distance - first + second, tolerated, meaning)
    # B + C is twice the distance and B - C twice the difference of the radii, also of circles
    # that miss each other by a rounding error.  Then one slack was a little negative and is now
    # zero, and the point misses both circles by half of it, however close the centres are.
    share = program.let(f"share{suffix}", 1 / (B + C), nonnegative=True)
    along = (distance + (B - C) * (A + distance) * share) / 2
    S = first + second + distance
    return along, sp.sqrt(S) * sp.sqrt(A) * sp.sqrt(B) * sp.sqrt(C) * share, (B, C)


def _beside(e: sp.Matrix) -> tuple[sp.Expr, ...]:
    """A unit vector at right angles to a unit vector, without a root (Duff and others, 2017)."""
    x, y, z = e
    side = sign_of(z)
    share = -1 / (side + z)
    return (1 + side * x**2 * share, side * x * y * share, -side * x)


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
