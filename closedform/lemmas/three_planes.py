"""Three axes at right angles, each in a plane of its own: the forward map of the agile wrist."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.inverse import Degenerate, Link
from closedform.model.lemma import Lemma

theorem(
    "axes in three planes",
    statement=r"""Let $\mathbf u_1$, $\mathbf u_2$, $\mathbf u_3$ be orthonormal and right-handed,
with indices modulo 3, and let $\mathbf w_k = c_k\mathbf u_{k+1} + s_k\mathbf u_{k+2}$ be unit
vectors.  Let $\mathbf p_k = \mathbf u_k\times\mathbf w_k$, $C = c_1c_2c_3$, $S = s_1s_2s_3$ and
$\rho_k = |\mathbf w_{k+1}\times\mathbf w_{k+2}|$, and let $C \ne S$.  Then exactly eight
right-handed orthonormal triples $\mathbf v_1$, $\mathbf v_2$, $\mathbf v_3$ satisfy $\mathbf
w_k\cdot\mathbf v_k = 0$ for all $k$.  Four are $\mathbf v_k = \tau_k\mathbf u_k$, for signs with
$\tau_1\tau_2\tau_3 = 1$.  The other four, for the same signs, are $$\mathbf v_k =
x_k\mathbf u_k + y_k\mathbf p_k, \qquad x_k = \tau_k\frac{c_{k+2}s_{k+1} +
s_ks_{k+2}c_kc_{k+1}}{\rho_{k+1}\rho_{k+2}}, \qquad y_k = \tau_k\frac{C -
S}{\rho_{k+1}\rho_{k+2}}.$$""",
    proof=r"""Substitution shows that all eight are solutions.  For the last four, $\rho_k^2 = 1 -
s_{k+1}^2c_{k+2}^2 = c_{k+1}^2 + s_{k+1}^2s_{k+2}^2 = s_{k+2}^2 + c_{k+2}^2c_{k+1}^2$, so that
$\tau_k(x_k + iy_k)$ is the product of $(c_{k+2} - is_{k+2}s_k)/\rho_{k+1}$ and $(s_{k+1} +
ic_{k+1}c_k)/\rho_{k+2}$, two numbers of absolute value 1.  In the first four $y_k = 0$, in the
others $y_k \ne 0$, because $C \ne S$.  So all eight differ.  There are no others: a triple is a
rotation, so a unit quaternion up to its sign, and the three conditions are homogeneous and
quadratic in it.  By Bézout's theorem three quadrics have at most eight common points, unless
they share a curve; then the degrees of the curves and the number of isolated points still add
up to at most eight.  A solution is isolated if the vectors $\mathbf w_k\times\mathbf v_k$ are
independent.  Their determinant is $S - C$ times $\tau_1\tau_2\tau_3$ in the first four and $C -
S$ in the others, so all eight are isolated, and nothing is left for a curve.""",
    exception=r"""If $C = S$ and all $\rho_k > 0$, each of the last four is one of the first four.
If $\rho_k = 0$, then $\mathbf w_{k+1}$ and $\mathbf w_{k+2}$ are $\mathbf u_k$ or $-\mathbf u_k$.
Every triple with $\mathbf v_k = \pm\mathbf u_k$ is a solution, so the other two axes can turn about
$\mathbf u_k$.""",
)


@dataclass(frozen=True)
class Axes:
    """The lemma, and the axes by their coordinates ``x`` along u and ``y`` along p, with signs."""

    link: Link
    x: tuple[sp.Expr, ...]
    y: tuple[sp.Expr, ...]
    gap: sp.Symbol
    """C - S, the determinant of the vectors w x v."""
    widths: tuple[sp.Symbol, ...]
    """The sines rho of the angles between the middle axes of the other two legs."""


def axes_in_three_planes(
    program: Program,
    joints: Sequence[sp.Symbol],
    axes: sp.Matrix,
    equations: Sequence[sp.Expr],
    signs: tuple[sp.Symbol, sp.Symbol],
) -> Axes:
    """Three axes at right angles, in the planes normal to ``c u' + s u''`` of three joints.

    ``axes`` has the axes as columns, in coordinates along u, and its entries are the unknowns of
    the ``equations``: the three conditions, and that it is a rotation.  ``signs`` are the first two
    of the four solutions; their product is the third.  Where two of the normals are parallel, the
    solution is returned to which a small cosine tends.
    """
    start = len(program.body)
    c = [program.let(f"c{k}", sp.cos(q)) for k, q in enumerate(joints, 1)]
    s = [program.let(f"s{k}", sp.sin(q)) for k, q in enumerate(joints, 1)]
    first, second, widths, flags = [], [], [], []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        value = sp.sqrt(c[i] ** 2 + (s[i] * s[j]) ** 2)
        rho = program.let(f"rho{k + 1}", value, nonnegative=True)
        meaning = f"the middle axes of legs {i + 1} and {j + 1} are parallel"
        flag = program.vanishes(f"parallel{k + 1}", rho, 1, meaning, (axes[i, i],))
        cosine = program.let(f"e{k + 1}", choose(flag, 1, c[i] / rho))
        sine = program.let(f"f{k + 1}", choose(flag, 0, s[j] / rho))
        first.append((cosine, -s[i] * sine))
        second.append((sine, c[j] * cosine))
        widths.append(rho)
        flags.append(flag)
    gap = program.let("gap", c[0] * c[1] * c[2] - s[0] * s[1] * s[2])
    tau = (*signs, signs[0] * signs[1])
    x, y = [], []
    solution: dict[sp.Symbol, sp.Expr] = {}
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        (a, b), (g, h) = first[i], second[j]
        x.append(program.let(f"x{k + 1}", tau[k] * (a * g - b * h)))
        y.append(program.let(f"y{k + 1}", tau[k] * (a * h + b * g)))
        solution |= {axes[k, k]: x[k], axes[i, k]: -s[k] * y[k], axes[j, k]: c[k] * y[k]}
    lemma = Lemma(
        "axes in three planes",
        r"\mathbf w_k\cdot\mathbf v_k = 0,\ \mathbf v_k \ne \pm\mathbf u_k\;\Rightarrow\;"
        r"\mathbf v_k = x_k\mathbf u_k + y_k\mathbf p_k,\quad x_k = "
        r"\tau_k\frac{c_{k+2}s_{k+1} + s_ks_{k+2}c_kc_{k+1}}{\rho_{k+1}\rho_{k+2}},"
        r"\quad y_k = \tau_k\frac{C - S}{\rho_{k+1}\rho_{k+2}}",
        tuple(equations),
        solution,
        4,
        excluded=4,
        signs=signs,
        roles=(
            *((rf"c_{k}", sp.cos(q)) for k, q in enumerate(joints, 1)),
            *((rf"s_{k}", sp.sin(q)) for k, q in enumerate(joints, 1)),
            (r"\tau_1", tau[0]),
            (r"\tau_2", tau[1]),
            (r"\tau_3", tau[2]),
            ("C", sp.prod(sp.cos(q) for q in joints)),
            ("S", sp.prod(sp.sin(q) for q in joints)),
        ),
        matrix="R",
    )
    cases = []
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        for up in (1, -1):
            for turned in (0, sp.pi):
                locus = {joints[i]: up * sp.pi / 2, joints[j]: turned}
                meaning = f"the middle axes of legs {i + 1} and {j + 1} are parallel"
                cases.append(Degenerate((flags[k],), locus, axes[i, i], meaning))
    body = tuple(program.body[start:])
    link = Link(tuple(solution), lemma.equations, {}, lemma, body, degenerate=tuple(cases))
    return Axes(link, tuple(x), tuple(y), gap, tuple(widths))


__all__ = ["Axes", "axes_in_three_planes"]
