"""The mirror image of a point in a plane, as what three points of the plane determine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma

theorem(
    "mirror image",
    statement=r"""Let $\mathbf b_1$, $\mathbf b_2$ and $\mathbf b_3$ be points that are not in one
line, and $\mathbf N = (\mathbf b_2 - \mathbf b_1)\times(\mathbf b_3 - \mathbf b_1)$.  The equations
$\mathbf w\cdot\mathbf b_k = \frac12\,\mathbf w\cdot\mathbf w$ for $k = 1, 2, 3$ have the solution
$\mathbf w = 0$, and $$\mathbf w = \frac{2\,\mathbf N\cdot\mathbf b_1}{\mathbf N\cdot\mathbf
N}\,\mathbf N,$$ the mirror image of the origin in the plane of the three points.""",
    proof=r"""The differences of the equations say that $\mathbf w$ is at right angles to two sides
of the triangle.  So it is $t\,\mathbf N$, and the first equation is $t\,\mathbf N\cdot\mathbf b_1 =
\frac12 t^2\,\mathbf N\cdot\mathbf N$: either $t = 0$, or $t$ is that of the statement.  For a
$\mathbf w \ne 0$ the equations say that the points are in the plane that halves the vector
$\mathbf w$ at right angles, so they are as far from $\mathbf w$ as from the origin.""",
    exception=r"""If the origin is in the plane of the points, both solutions are one.  If the
points are in one line, the solutions are the mirror images in all planes through it.""",
)


@dataclass(frozen=True)
class Image:
    """The link that finds the image, and the names of the plane."""

    link: Link
    normal: sp.Matrix
    """A unit normal of the plane."""
    away: sp.Symbol
    """How far the image is from the origin along the normal."""
    area: sp.Symbol
    """Twice the area of the triangle of the points, over the square of the size."""


def mirror_image(
    program: Program,
    unknowns: Sequence[sp.Symbol],
    origin: sp.Matrix,
    points: Sequence[sp.Matrix],
    size: sp.Expr,
) -> Image:
    """The mirror image of the ``origin`` in the plane of three points, which are seen from it.

    ``unknowns`` are the coordinates of the image.  Where the points are in one line, the origin
    itself is returned.  ``size`` is that of the mechanism.
    """
    p, (first, second, third) = program, points
    start = len(p.body)
    u, v = (
        sp.Matrix([p.let(f"{n}_{i}", e) for i, e in zip("xyz", (b - first) / size, strict=True)])
        for n, b in (("u", second), ("v", third))
    )
    # v without its part along u: so rounding does not move the plane off the points near a line
    square = p.let("square", u.dot(u), nonnegative=True)
    said = "two balls are at the same point"
    same = p.vanishes("same", sp.sqrt(square), sp.S.One, said, tuple(unknowns))
    part = p.let("part", choose(same, 0, u.dot(v) / square))
    aside = sp.Matrix([p.let(f"v_aside_{i}", e) for i, e in zip("xyz", v - part * u, strict=True)])
    N = sp.Matrix([p.let(f"N_{i}", e) for i, e in zip("xyz", u.cross(aside), strict=True)])
    area = p.let("area", sp.sqrt(N.dot(N)), nonnegative=True)
    said = "the balls are in one line"
    flat = p.vanishes("flat", area, sp.S.One, said, tuple(unknowns))
    n = sp.Matrix(
        [p.let(f"n_{i}", choose(flat, 0, e / area)) for i, e in zip("xyz", N, strict=True)]
    )
    far = p.let("away", 2 * n.dot(first))
    w = sp.Matrix(unknowns) - origin
    found = [p.let(f"p_{i}", o + far * e) for i, o, e in zip("xyz", origin, n, strict=True)]
    lemma = Lemma(
        "mirror image",
        r"\mathbf w\cdot\mathbf b_k = \tfrac12\,\mathbf w\cdot\mathbf w \;\Rightarrow\; \mathbf w ="
        r" \frac{2\,\mathbf N\cdot\mathbf b_1}{\mathbf N\cdot\mathbf N}\,\mathbf N",
        tuple(w.dot(b) - w.dot(w) / 2 for b in points),
        dict(zip(unknowns, found, strict=True)),
        1,
        excluded=1,
        roles=(
            (r"\mathbf w", w),
            *((rf"\mathbf b_{k}", b) for k, b in enumerate(points, 1)),
        ),
    )
    link = Link(tuple(unknowns), lemma.equations, lemma=lemma, body=tuple(p.body[start:]))
    return Image(link, n, far, area)


__all__ = ["Image", "mirror_image"]
