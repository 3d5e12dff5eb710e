"""One angle: from its sine and cosine, and from ``a sin x + b cos x = c``."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma

theorem(
    "atan2 of a linear pair",
    statement=r"""Let $A$ and $B$ be real numbers that are not both zero.  In $(-\pi, \pi]$ the
equation $B\sin x - A\cos x = 0$ with $A\sin x + B\cos x > 0$ has exactly one solution, $x =
\operatorname{atan2}(A, B)$.""",
    proof=r"""By the equation the vectors $(\cos x, \sin x)$ and $(B, A)$ are parallel, and by the
inequality they point the same way.  So $(\cos x, \sin x) = (B, A)/\sqrt{A^2 + B^2}$, and
$\operatorname{atan2}(A, B)$ is the angle of this vector.  The inequality excludes one of the two
solutions of the equation, the one that differs by half a turn.""",
    exception=r"""If $A = B = 0$, every $x$ solves the equation: the joint is free.""",
)
theorem(
    "a sin x + b cos x = c",
    title=r"$a\sin x + b\cos x = c$",
    statement=r"""Let $h = \sqrt{a^2 + b^2} > 0$.  The equation $a\sin x + b\cos x = c$ has a
solution if and only if $|c| \le h$.  Its solutions are then $x = \operatorname{atan2}(a, b) +
\sigma\delta$ with $\sigma = \pm 1$ and $\delta = 2\operatorname{atan2}\bigl(\sqrt{h - c}, \sqrt{h
+ c}\bigr)$, that is, $(\cos\delta, \sin\delta) = \bigl(c, \sqrt{(h - c)(h + c)}\bigr)/h$.  They
coincide, up to a turn, if and only if $|c| = h$.""",
    proof=r"""Let $\alpha = \operatorname{atan2}(a, b)$, so that $a = h\sin\alpha$ and $b =
h\cos\alpha$.  The equation becomes $h\cos(x - \alpha) = c$.  It needs $|c| \le h$; then $x -
\alpha = \pm\delta$ for the $\delta$ in $[0, \pi]$ with $\cos\delta = c/h$.  Half of this angle is
in $[0, \pi/2]$, where sine and cosine are not negative, and $\tan^2(\delta/2) = (1 -
\cos\delta)/(1 + \cos\delta) = (h - c)/(h + c)$.  Also $\sin^2\delta = 1 - c^2/h^2 = (h - c)(h +
c)/h^2$.  The angles $\pm\delta$ agree, up to a turn, if $\delta$ is $0$ or $\pi$.""",
    exception=r"""If $a = b = 0$, there is no solution unless $c = 0$; then every $x$ is one, and
the joint is free.""",
)


def linear_pair(x: sp.Symbol, sine: sp.Expr, cosine: sp.Expr) -> Lemma:
    """``cos x : sin x = cosine : sine``, both known up to a common positive factor.

    Of the two directions of the line only one has the right sign; x is free where both vanish.
    """
    return Lemma(
        "atan2 of a linear pair",
        r"\sin x\,B - \cos x\,A = 0,\ A\sin x + B\cos x > 0 \;\Rightarrow\; "
        r"x = \operatorname{atan2}(A, B)",
        (sp.sin(x) * cosine - sp.cos(x) * sine,),
        {x: sp.atan2(sine, cosine)},
        1,
        excluded=1,
    )


def sine_cosine(
    program: Program,
    x: sp.Symbol,
    a: sp.Expr,
    b: sp.Expr,
    c: sp.Expr,
    sigma: sp.Symbol,
    *,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
    scale: sp.Expr = sp.S.One,
    slack: sp.Expr | None = None,
    reach: tuple[sp.Expr, sp.Expr, sp.Expr] | None = None,
) -> Lemma:
    """``a sin x + b cos x = c``: two solutions where ``a^2 + b^2 >= c^2``.

    With ``h = sqrt(a^2 + b^2)`` the equation is ``cos(x - atan2(a, b)) = c / h``; half the angle
    ``x - atan2(a, b)`` has the tangent ``sqrt(h - c) / sqrt(h + c)``.  x is free where
    ``a = b = c = 0``; with ``free`` joints that is flagged, on the ``scale`` of the coefficients,
    and the answer there is x = 0.  ``b sin x - a cos x`` gets a name too.

    ``slack`` is the scale of the amount by which c may be missed, by default the same scale.
    ``reach`` holds two links and a height: in the plane that x turns, the links have to reach the
    point at this coordinate and height.
    """
    start = len(program.body)
    h = program.let(f"h{suffix}", sp.sqrt(a**2 + b**2), nonnegative=True)
    size = slack if slack is not None else scale if free else h
    below = program.bound(f"below{suffix}", h - c, size, "the amplitude is not smaller than c")
    above = program.bound(f"above{suffix}", h + c, size, "the amplitude is not smaller than -c")
    turn = 2 * sp.atan2(sp.sqrt(below), sp.sqrt(above))
    root = sp.sqrt(below) * sp.sqrt(above)
    if reach is not None:
        root = program.let(f"root{suffix}", root, nonnegative=True)
        lever = 4 * root * (reach[0] + reach[1])
        tangent = nearly_tangent(program, lever, h * size, suffix)
        held = sp.sqrt(root_in_reach(program, below * above, h, size, *reach, suffix=suffix))
        turn = choose(tangent, sp.atan2(held, (above - below) / 2), turn)
        root = program.let(f"in_reach{suffix}", choose(tangent, held, root), nonnegative=True)
    onward = program.let(f"onward{suffix}", sigma * root)
    direction = sp.atan2(a, b) + sigma * turn
    if free:
        nowhere = program.vanishes(f"nowhere{suffix}", h, scale, "the amplitude is zero", free)
        direction = choose(nowhere, 0, direction)
    return Lemma(
        "a sin x + b cos x = c",
        r"a\sin x + b\cos x = c \;\Rightarrow\; x = \operatorname{atan2}(a, b) + "
        r"2\sigma\operatorname{atan2}(\sqrt{h-c}, \sqrt{h+c}),\ h = \sqrt{a^2+b^2}",
        (a * sp.sin(x) + b * sp.cos(x) - c,),
        {x: direction},
        2,
        means={onward: b * sp.sin(x) - a * sp.cos(x)},
        body=tuple(program.body[start:]),
    )


def nearly_tangent(program: Program, lever: sp.Expr, scale: sp.Expr, suffix: str = "") -> sp.Symbol:
    """A flag that the ``lever`` of a turn is so short that rounding may decide what is in reach.

    It is 2^-8 of the ``scale``; for a longer one the tolerance of a reach covers the rounding.
    """
    return program.vanishes(f"tangent{suffix}", lever - scale / 2**8, scale, "the turn is tangent")


def root_in_reach(
    program: Program,
    square: sp.Expr,
    h: sp.Expr,
    scale: sp.Expr,
    first: sp.Expr,
    second: sp.Expr,
    height: sp.Expr,
    *,
    suffix: str,
) -> sp.Symbol:
    """The ``square`` of a coordinate, brought within reach if rounding puts it out of reach."""
    farthest, nearest = (first + second) ** 2 - height**2, (first - second) ** 2 - height**2
    wanted = program.let(f"wanted{suffix}", sp.Max(0, nearest, sp.Min(square, farthest)))
    rounding = 2 * h * scale / 2**44
    return program.let(
        f"held{suffix}",
        sp.Piecewise((wanted, sp.Abs(wanted - square) <= rounding), (square, True)),
        nonnegative=True,
    )
