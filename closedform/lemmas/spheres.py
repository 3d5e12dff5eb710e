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
They exist if and only if $X^2 + Y^2 \le r_1^2$, and coincide if and only if these are equal.""",
    proof=r"""Write $\mathbf x = X\,\mathbf e_1 + Y\,\mathbf e_2 + Z\,\mathbf e_3$.  The first
distance says $X^2 + Y^2 + Z^2 = r_1^2$.  Each of the others, subtracted from it, is linear: $2 D X
= D^2 + r_1^2 - r_2^2$ and $2 k X + 2 j Y = k^2 + j^2 + r_1^2 - r_3^2$.  These give $X$ and $Y$, and
the first equation gives $Z^2$.""",
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
    side: sp.Symbol
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
    X = p.let("X", choose(point, 0, (D + (r1 - near) * (r1 + near) / D) / 2))
    # k^2 + j^2 - k D as a product of differences: it is small where the last two centres are close
    beyond = other.dot(other - sp.Matrix([either(b, a) for a, b in zip(u, v, strict=True)]))
    unequal = (r1 - far) * (r1 + far) - (r1 - near) * (r1 + near) * k / D
    left = p.let("left", choose(point, 0, beyond + unequal) if unequal != 0 else beyond)
    meaning = "the spheres whose centres are in line share a circle"
    p.match(choose(line, left, 0), scale**2, meaning)
    Y = p.let("Y", choose(line, 0, left / (2 * j)))
    radius = p.let("rho", sp.sqrt(X**2 + Y**2), nonnegative=True)
    # A sphere is missed by this slack times the first radius over its own: with a quarter of the
    # tolerance, the legs accept the target of what is accepted here, unless a rod is very short.
    tolerated = scale if r1 == r2 == r3 else scale / 4
    slack = p.bound("slack", r1 - radius, tolerated, "the spheres meet")
    touching = p.vanishes("touching", slack, scale, "the spheres touch")
    rise = choose(touching, 0, sp.sqrt(slack) * sp.sqrt(r1 + radius))
    h = p.let("h", rise, nonnegative=True)
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
    )
    rise = sigma * h
    return Meeting(
        Link(
            unknowns,
            lemma.equations,
            lemma=lemma,
            body=tuple(p.body[start:]),
            degenerate=_cases((u, v), (r1, r2, r3), (same, point, line), free),
        ),
        tuple(from_first),
        sigma,
        h * D * j,
        sp.Matrix([[X, Y, rise], [X - D, Y, rise], [X - k, Y - j, rise]]),
    )


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
    free: Sequence[sp.Symbol],
) -> tuple[Degenerate, ...]:
    """The spheres share a circle, or all of each other."""
    (u, v), (r1, r2, r3), (same, point, line) = centres, radii, flags
    joint = free[0] if free else None
    none = dict.fromkeys(u, sp.S.Zero), dict.fromkeys(v, sp.S.Zero)
    equal = [{b: a} if isinstance(b, sp.Symbol) and a != b else {} for a, b in ((r1, r2), (r1, r3))]
    along = dict(zip(v, u, strict=True))
    return tuple(
        Degenerate(which, locus, joint, meaning)
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
