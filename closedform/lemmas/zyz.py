"""The angles of a rotation about z, y and z."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sympy as sp

from closedform.lemmas.pairs import direction
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair

theorem(
    "ZYZ angles",
    statement=r"""Let $R$ be a rotation with $h = \sqrt{R_{13}^2 + R_{23}^2} > 0$.  The equation
$R_z(\lambda)\, R_y(\mu)\, R_z(\nu) = R$ has two solutions with angles in $(-\pi, \pi]$.  For
$\sigma = \pm 1$, the sign of $\sin\mu$, they are
$$(\cos\lambda, \sin\lambda) = \frac{\sigma}{h}(R_{13}, R_{23}), \qquad
\mu = \operatorname{atan2}(R_{13}\cos\lambda + R_{23}\sin\lambda,\ R_{33}),$$
$$\nu = \operatorname{atan2}(R_{21}\cos\lambda - R_{11}\sin\lambda,\
R_{22}\cos\lambda - R_{12}\sin\lambda).$$""",
    proof=r"""The third column of the product is $(\cos\lambda\sin\mu,\ \sin\lambda\sin\mu,\
\cos\mu)$.  So $|\sin\mu| = h \ne 0$; if $\sigma$ is its sign, $\cos\lambda$ and $\sin\lambda$ are
as stated, and $\sin\mu = R_{13}\cos\lambda + R_{23}\sin\lambda$.  The equation leaves
$R_z(\lambda)^T R = R_y(\mu)\, R_z(\nu)$, whose second row is $(\sin\nu, \cos\nu, 0)$; this gives
$\nu$.  Conversely, for these $\lambda$ and $\mu$ the third column of $R_z(\lambda)^T R$ is
$(\sigma h, 0, R_{33})$, which is that of $R_y(\mu)$.  So $R_y(\mu)^T R_z(\lambda)^T R$ is a
rotation about the $z$ axis.  $R_y$ does not change second rows, so its angle is $\nu$.""",
    exception=r"""If $h = 0$, the first and the last axis coincide.  For $R_{33} = 1$ only
$\lambda + \nu$ is determined, for $R_{33} = -1$ only $\lambda - \nu$.""",
)


@dataclass(frozen=True)
class Zyz:
    """The lemma, and the outer angles: those of pairs, plus half a turn in some branches."""

    lemma: Lemma
    first: Pair
    last: Pair
    flip: sp.Expr
    aligned: sp.Symbol


def zyz_angles(
    program: Program,
    R: sp.Matrix,
    angles: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    *,
    free: Sequence[sp.Symbol] = (),
    scale: int = 1,
    suffix: str = "",
) -> Zyz:
    """``Rz(first) Ry(middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    ``angles`` are first, middle and last.  The second solution is the first with a half turn of
    both outer angles.  Where ``sin(middle) =
    0`` only ``first + last`` (or ``first - last``) is determined; the convention is ``first = 0``,
    and ``free`` says which joint that is, if not the first angle itself.  ``scale`` counts the
    roundings that R has seen.
    """
    h = program.let(f"h{suffix}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
    aligned = program.vanishes(
        f"aligned{suffix}",
        h,
        scale,
        "the first and the last axis coincide",
        free=free or angles[:1],
    )
    pair = direction(R[1, 2], R[0, 2], h, aligned)
    pair = pair.known_as(program, suffix or label(angles[0]))
    flip = program.let(f"flip{suffix}", choose(aligned, 0, (1 - sigma) * sp.pi / 2))
    lemma, rest = zyz_lemma(R, angles, pair, sigma, flip)
    return Zyz(replace(lemma, signs=(sigma,)), pair, rest, flip, aligned)


def zyz_lemma(
    R: sp.Matrix,
    angles: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    pair: Pair,
    side: sp.Expr = sp.S.One,
    flip: sp.Expr = sp.S.Zero,
) -> tuple[Lemma, Pair]:
    """The lemma, once the ``pair`` of the first angle is known, and the pair of the last.

    ``side`` is the sign of sin(middle), and ``flip`` a turn that is added to both outer angles.

    The third column of R gives the first two angles.  The last is *not* read from the third row, as
    the textbooks do: near ``middle = 0`` that row knows nothing of it.  It follows from the
    rotation that the first angle leaves, ``Rz(first)^T R = Ry(middle) Rz(last)``, whose second row
    is ``(sin(last), cos(last), 0)``, and so keeps the product exact whatever error ``first`` has.
    """
    first, middle, last = angles
    s, c = pair.s, pair.c
    rest = Pair(c * R[1, 0] - s * R[0, 0], c * R[1, 1] - s * R[0, 1])
    cf, sf, cm, sm, cl, sl = (f(x) for x in (first, middle, last) for f in (sp.cos, sp.sin))
    left = sp.Matrix([[cf, sf, 0], [-sf, cf, 0], [0, 0, 1]]) * R
    right = sp.Matrix([[cm * cl, -cm * sl, sm], [sl, cl, 0], [-sm * cl, sm * sl, cm]])
    lemma = Lemma(
        "ZYZ angles",
        r"(\cos\lambda, \sin\lambda) = \sigma (R_{13}, R_{23})/h,\ h = \sqrt{R_{13}^2 + R_{23}^2},"
        r"\quad \mu = \operatorname{atan2}(R_{13}\cos\lambda + R_{23}\sin\lambda,\ R_{33}),\quad "
        r"\nu = \operatorname{atan2}(R_{21}\cos\lambda - R_{11}\sin\lambda,\ "
        r"R_{22}\cos\lambda - R_{12}\sin\lambda)",
        tuple(left - right),
        {
            first: pair.angle + flip,
            middle: side * sp.atan2(c * R[0, 2] + s * R[1, 2], R[2, 2]),
            last: rest.angle + flip,
        },
        2,
        roles=tuple(zip((r"\lambda", r"\mu", r"\nu"), angles, strict=True)),
    )
    return lemma, rest


__all__ = ["Zyz", "zyz_angles", "zyz_lemma"]
