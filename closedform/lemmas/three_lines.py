"""The point of three lines of a plane that have one in common, whichever of them are parallel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import sympy as sp

from closedform.lemmas.legs import cross_in_plane
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "point of three lines",
    statement=r"""Let $\mathbf n_1$, $\mathbf n_2$, $\mathbf n_3$ be vectors of a plane, with
indices modulo 3, $w_k$ the determinant of $\mathbf n_{k+1}$ and $\mathbf n_{k+2}$, and $D = w_1^2 +
w_2^2 + w_3^2 > 0$.  For all numbers $g_k$ there is exactly one vector $\mathbf p$ with
$\sum_k(\mathbf n_k\cdot\mathbf p - g_k)\,\mathbf n_k = \mathbf 0$,
$$\mathbf p = \frac{1}{D}\sum_k w_k\,\mathbf q_k, \qquad \mathbf q_k = \begin{pmatrix} n_{k+2,2}\\
-n_{k+2,1}\end{pmatrix} g_{k+1} - \begin{pmatrix} n_{k+1,2}\\ -n_{k+1,1}\end{pmatrix} g_{k+2}.$$ If
the lines $\mathbf n_k\cdot\mathbf x = g_k$ have a point in common, it is this one.""",
    proof=r"""The equations are linear in $\mathbf p$, with the matrix $\sum_k\mathbf n_k\mathbf
n_k^T$, whose determinant is $D$ by the formula of Cauchy and Binet.  So there is exactly one
solution, and substitution shows that it is the stated one.  A common point of the lines is a
solution, because each term of the sum vanishes.""",
    exception=r"""If $D = 0$, the three lines are parallel.  Then there is no solution or a line of
them.""",
)


def three_lines(
    program: Program,
    normals: Sequence[sp.Matrix],
    levels: Sequence[sp.Expr],
    weights: Sequence[sp.Expr],
    unknowns: sp.Matrix,
) -> Link:
    """The point of three lines ``n.p = g``, from names of their unit normals and levels.

    The ``weights`` are names of the determinants of two normals each, with which the normals add
    up to zero.
    """
    p, start = program, len(program.body)
    width = p.let("width", sp.sqrt(sp.Add(*(w**2 for w in weights))), nonnegative=True)
    meaning = "all three lines are parallel"
    flag = p.vanishes("parallel", width, 1, meaning, (unknowns[0],))
    found, middle = sp.zeros(2, 1), sp.zeros(2, 1)
    for k, (n, g) in enumerate(zip(normals, levels, strict=True)):
        (a, b), (f, h) = (normals[k - 2], normals[k - 1]), (levels[k - 2], levels[k - 1])
        share = p.let(f"share{k + 1}", choose(flag, 0, weights[k] / width))
        found += share * sp.Matrix([b[1] * f - a[1] * h, a[0] * h - b[0] * f])
        middle += n * g / len(normals)
    point = [
        p.let(f"p_{i}", choose(flag, beside, e / width))
        for i, e, beside in zip("xy", found, middle, strict=True)
    ]
    missed = sum(
        (n * (n.dot(unknowns) - g) for n, g in zip(normals, levels, strict=True)), sp.zeros(2, 1)
    )
    lemma = Lemma(
        "point of three lines",
        r"\mathbf n_k\cdot\mathbf p = g_k \;\Rightarrow\; \mathbf p = \frac{1}{D}\sum_k "
        r"w_k\,\mathbf q_k,\quad D = \sum_k w_k^2",
        tuple(missed),
        dict(zip(unknowns, point, strict=True)),
        1,
        body=tuple(p.body[start:]),
        premises=dict(zip(weights, weights_of(normals), strict=True)),
        roles=(
            *((rf"\mathbf n_{k}", n) for k, n in enumerate(normals, 1)),
            *((f"g_{k}", g) for k, g in enumerate(levels, 1)),
            *((f"w_{k}", w) for k, w in enumerate(weights, 1)),
        ),
    )
    cases = _parallel(flag, normals, unknowns[0])
    return replace(Link.of(lemma), degenerate=cases)


def _parallel(
    flag: sp.Symbol, normals: Sequence[sp.Matrix], free: sp.Symbol
) -> tuple[Degenerate, ...]:
    """The cases in which the lines are parallel, by the directions of their normals."""
    beta = real("beta")
    cases = []
    for sides in product((1, -1), repeat=len(normals) - 1):
        locus: dict[sp.Symbol, sp.Expr] = {}
        for n, side in zip(normals, (1, *sides), strict=True):
            locus |= {n[0]: side * sp.cos(beta), n[1]: side * sp.sin(beta)}
        cases.append(Degenerate((flag,), locus, free, "all three lines are parallel"))
    return tuple(cases)


def weights_of(normals: Sequence[sp.Matrix]) -> list[sp.Expr]:
    """The determinants of two normals each, with which three of them add up to zero."""
    return [cross_in_plane(normals[k - 2], normals[k - 1]) for k in range(3)]


__all__ = ["three_lines", "weights_of"]
