"""The two-link triangle, by half angles and by squares."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma

theorem(
    "two-link triangle",
    statement=r"""Two links of lengths $l_1, l_2 > 0$ are joined at the angle $\theta$, and their
ends are at the distance $R > 0$.  Let $\alpha$ be the angle from the first link to the line of
the ends: $l_1 + l_2\cos\theta = R\cos\alpha$ and $l_2\sin\theta = R\sin\alpha$.  With $N = (l_1 +
l_2)^2 - R^2$ and $M = R^2 - (l_1 - l_2)^2$ there is a solution if and only if $N \ge 0$ and $M
\ge 0$.  The solutions are
$$\tan\frac{\theta}{2} = \sigma\frac{\sqrt N}{\sqrt M}, \qquad
\tan\alpha = \sigma\frac{2 l_2\sqrt{N M}}{(l_1 - l_2) N + (l_1 + l_2) M}, \qquad \sigma = \pm 1.$$
With the factors of Heron's formula, $S = l_1 + l_2 + R$, $A = l_1 + l_2 - R$, $B = R + l_1 - l_2$
and $C = R - l_1 + l_2$, the same solutions are
$$\tan\frac{\theta}{2} = \sigma\frac{\sqrt{S A}}{\sqrt{B C}}, \qquad
\tan\frac{\alpha}{2} = \sigma\frac{\sqrt{A C}}{\sqrt{S B}}.$$""",
    proof=r"""The sum of the squares of both equations is $l_1^2 + l_2^2 + 2 l_1 l_2\cos\theta =
R^2$.  Since $N + M = 4 l_1 l_2$, this says $\cos\theta = (M - N)/(M + N)$.  Such a $\theta$
exists if and only if $N$ and $M$ are not negative, because their sum is positive.  Then
$\tan^2(\theta/2) = (1 - \cos\theta)/(1 + \cos\theta) = N/M$, and $\sigma$ is the sign of
$\theta$.  Here $\sin\theta = 2\sigma\sqrt{N M}/(N + M)$.  Inserted into both equations, this
gives $R\cos\alpha$ and $R\sin\alpha$, and $\tan\alpha$ as their quotient.  The first two factors
of Heron's formula give $N = S A$ and the others $M = B C$.  The law of cosines for the angle at
the base, $2 R l_1\cos\alpha = R^2 + l_1^2 - l_2^2$, gives $\tan^2(\alpha/2) = (1 - \cos\alpha)/(1
+ \cos\alpha) = A C/(S B)$ in the same way; $\alpha$ has the sign of $\theta$, because
$R\sin\alpha = l_2\sin\theta$.""",
    exception=r"""If a link has no length, $N + M = 0$ and $\theta$ is free.  If $R = 0$, which
needs $l_1 = l_2$, the links lie on each other and $\alpha$ is free.""",
)


def heron_factors(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    scale: sp.Expr,
    *,
    suffix: str = "",
) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol, sp.Symbol]:
    """The factors S, A, B, C of Heron's formula; a triangle exists where none is negative."""
    return (
        program.let(f"S{suffix}", first + second + reach, nonnegative=True),
        program.bound(f"A{suffix}", first + second - reach, scale, "nearer than full stretch"),
        program.bound(f"B{suffix}", reach + first - second, scale, "farther than the fold"),
        program.bound(f"C{suffix}", reach - first + second, scale, "farther than the fold"),
    )


def square_factors(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    square: sp.Expr,
    scale: sp.Expr,
    *,
    suffix: str = "",
) -> tuple[sp.Symbol, sp.Symbol]:
    """N and M of :func:`two_link_triangle_by_square`; a triangle exists where none is negative.

    A fold of some 2^-44 of the links is none: there M may be missed by its own square.
    """
    total, apart = first + second, first - second
    N = program.bound(
        f"N{suffix}", total**2 - square, 2 * total * scale, "nearer than full stretch"
    )
    M = program.bound(
        f"M{suffix}",
        square - apart**2,
        2 * (sp.Abs(apart) + total / 2**44) * scale,
        "farther than the fold",
    )
    return N, M


def triangle_equations(
    first: sp.Expr, second: sp.Expr, reach: sp.Expr, elbow: sp.Symbol, base: sp.Symbol
) -> tuple[sp.Expr, sp.Expr]:
    """Two links, at 0 and at ``elbow``, end ``reach`` away in the direction ``base``."""
    return (
        first + second * sp.cos(elbow) - reach * sp.cos(base),
        second * sp.sin(elbow) - reach * sp.sin(base),
    )


def two_link_triangle(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    reach: sp.Expr,
    elbow: sp.Symbol,
    base: sp.Symbol,
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
) -> Lemma:
    """The triangle of two links of lengths ``first``, ``second`` whose ends are ``reach`` apart.

    ``elbow`` is the joint angle between the links (zero when stretched), ``base`` the angle from
    the first link to the line of the ends, so that a link at ``theta`` reaches the direction
    ``theta + base``.  Two mirror solutions.  With the four factors of Heron's formula, S, A, B, C,

        tan(elbow / 2) = sqrt(S A) / sqrt(B C),   tan(base / 2) = sqrt(A C) / sqrt(S B).

    The elbow is free where a link has no length, and the base where the reach is zero.  ``scale``
    is the natural scale of the lengths: by default that of the links, more where the reach is a
    difference of larger lengths.
    """
    scale = first + second if scale is None else scale
    S, A, B, C = heron_factors(program, first, second, reach, scale, suffix=suffix)
    rS, rA, rB, rC = (
        program.let(f"r{name}{suffix}", sp.sqrt(value), nonnegative=True)
        for name, value in (("S", S), ("A", A), ("B", B), ("C", C))
    )
    return Lemma(
        "two-link triangle",
        r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt{S A}}{\sqrt{B C}},\quad "
        r"\tan\frac{\alpha}{2} = \sigma\frac{\sqrt{A C}}{\sqrt{S B}}",
        triangle_equations(first, second, reach, elbow, base),
        {
            elbow: 2 * sigma * sp.atan2(rS * rA, rB * rC),
            base: 2 * sigma * sp.atan2(rA * rC, rS * rB),
        },
        2,
    )


def triangle_angles(
    first: sp.Expr, second: sp.Expr, N: sp.Expr, M: sp.Expr, sigma: sp.Expr
) -> tuple[sp.Expr, sp.Expr]:
    """Elbow and base of :func:`two_link_triangle_by_square`, for N and M."""
    elbow = 2 * sigma * sp.atan2(sp.sqrt(N), sp.sqrt(M))
    beyond = 2 * sigma * second * (sp.sqrt(N) * sp.sqrt(M))
    return elbow, sp.atan2(beyond, (first - second) * N + (first + second) * M)


def two_link_triangle_by_square(
    program: Program,
    first: sp.Expr,
    second: sp.Expr,
    square: sp.Expr,
    elbow: sp.Symbol,
    base: sp.Symbol,
    sigma: sp.Symbol,
    *,
    scale: sp.Expr | None = None,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
) -> tuple[Lemma, tuple[sp.Expr, sp.Expr]]:
    """As :func:`two_link_triangle`, by the ``square`` of the distance R of the ends.

    With N = (l1 + l2)^2 - R^2 and M = R^2 - (l1 - l2)^2

        tan(elbow / 2) = sqrt(N / M),
        tan(base) = 2 l2 sqrt(N M) / ((l1 - l2) N + (l1 + l2) M),

    without R itself.  Cosine and sine of the base, times 4 l1 l2 R, are returned too, for what
    turns with it.  Both angles rest on the same N and M, whose rounding counts as some of R; so
    the links end where they should even where their angles are ill-conditioned.

    The elbow is free where a link has no length: the convention is a stretched one, and the
    ``free`` joints get the status for it.  The base is free where R = 0.  ``scale`` is the natural
    scale of the lengths: by default that of the links, more where R comes from larger ones.
    """
    total = first + second
    N, M = square_factors(
        program, first, second, square, total if scale is None else scale, suffix=suffix
    )
    bend, lead = triangle_angles(first, second, N, M, sigma)
    no_link = program.vanishes(
        f"no_link{suffix}", first * second, total**2, "a link has no length", free
    )
    ahead = program.let(f"ahead{suffix}", choose(no_link, 1, lead.args[1]))
    beyond = program.let(f"beyond{suffix}", choose(no_link, 0, lead.args[0]))
    lemma = Lemma(
        "two-link triangle",
        r"N = (l_1 + l_2)^2 - R^2,\ M = R^2 - (l_1 - l_2)^2:\quad "
        r"\tan\frac{\theta}{2} = \sigma\frac{\sqrt N}{\sqrt M},\quad "
        r"\tan\alpha = \sigma\frac{2 l_2 \sqrt{N M}}{(l_1 - l_2) N + (l_1 + l_2) M}",
        triangle_equations(first, second, sp.sqrt(square), elbow, base),
        {elbow: choose(no_link, 0, bend), base: sp.atan2(beyond, ahead)},
        2,
    )
    return lemma, (ahead, beyond)
