"""One angle: from its sine and cosine, and from ``a sin x + b cos x = c``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.amplitude import Amplitude, nearly_tangent
from closedform.lemmas.registry import theorem
from closedform.lemmas.tangent import LinksAtHeight
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma, Shape

theorem(
    "atan2 of a linear pair",
    statement=r"""Let $f$ and $g$ be real numbers that are not both zero.  In $(-\pi, \pi]$ exactly
one $x$ has $k\sin x = f$ and $k\cos x = g$ with a number $k > 0$: $x = \operatorname{atan2}(f,
g)$.""",
    proof=r"""The squares of the equations add up to $k^2 = f^2 + g^2$.  So $(\cos x, \sin x) = (g,
f)/\sqrt{f^2 + g^2}$, and $\operatorname{atan2}(f, g)$ is the angle of this vector.  Without $k$ the
equations say that $g\sin x - f\cos x = 0$ and $f\sin x + g\cos x > 0$, which is what the prover
uses.  The inequality excludes one of the two solutions of the equation, the one that differs by
half a turn.""",
    exception=r"""If $f = g = 0$, every $x$ solves the equation: the joint is free.""",
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

    Only one of the two directions of the line has the right sign; x is free where both vanish.
    """
    return Lemma(
        "atan2 of a linear pair",
        r"k\sin x = f,\ k\cos x = g,\ k > 0 \;\Rightarrow\; x = \operatorname{atan2}(f, g)",
        (sp.sin(x) * cosine - sp.cos(x) * sine,),
        {x: sp.atan2(sine, cosine)},
        1,
        excluded=1,
        shape=Shape.CONTAINS,
        roles=(("x", x), ("f", sine), ("g", cosine)),
        scaled=("x", "f", "g"),
    )


def turned_back(
    x: sp.Symbol,
    direction: tuple[sp.Expr, sp.Expr],
    angle: sp.Symbol,
    of: tuple[sp.Expr, sp.Expr],
) -> Lemma:
    """The angle of a direction minus another ``angle``, each given by its sine and its cosine.

    Both pairs are known up to a positive factor.  The difference is computed by one arctangent; a
    reader takes two.
    """
    (up, out), (beyond, ahead) = direction, of
    lemma = linear_pair(x, up * ahead - out * beyond, out * ahead + up * beyond)
    other = sp.atan2(beyond, ahead, evaluate=False)
    plainly = {angle: other, x: sp.atan2(up, out, evaluate=False) - angle}
    return replace(lemma, roles=(("x", x + angle), ("f", up), ("g", out)), plainly=plainly)


def sine_cosine(
    program: Program,
    x: sp.Symbol,
    coefficients: tuple[sp.Expr, sp.Expr, sp.Expr],
    sigma: sp.Symbol,
    *,
    suffix: str = "",
    free: Sequence[sp.Symbol] = (),
    scale: sp.Expr = sp.S.One,
    slack: sp.Expr | None = None,
    toward: LinksAtHeight | None = None,
) -> Lemma:
    """``a sin x + b cos x = c``, by half angles: two solutions where ``a^2 + b^2 >= c^2``.

    ``b sin x - a cos x`` gets a name too.

    Parameters
    ----------
    program
        the program that the names and bounds are added to
    x
        the angle
    coefficients
        a, b and c
    sigma
        the sign that names the two solutions
    suffix
        what the names end in
    free
        joints that are free where ``a = b = c = 0``; there x = 0 is returned
    scale
        the scale of the coefficients, on which they vanish
    slack
        the scale of what c may be missed by, by default ``scale`` with free joints, else h
    toward
        what later joints have to reach, which decides where both solutions nearly meet
    """
    start = len(program.body)

    def missed_by(h: sp.Symbol) -> sp.Expr:
        return slack if slack is not None else scale if free else h

    found = Amplitude.of(program, x, coefficients, sigma, scale=missed_by, suffix=suffix)
    turn, root = found.half_turn, found.root
    if toward is not None:
        root = program.let(f"root{suffix}", root, nonnegative=True)
        size = missed_by(found.h)
        lever = 4 * root * (toward.l1 + toward.l2)
        tangent = nearly_tangent(program, lever, found.h * size, suffix)
        reached = sp.sqrt(toward.square_in_reach(program, found, size, suffix))
        turn = choose(tangent, sp.atan2(reached, (found.above - found.below) / 2), turn)
        root = program.let(f"in_reach{suffix}", choose(tangent, reached, root), nonnegative=True)
    onward = program.let(f"onward{suffix}", sigma * root)
    direction = sp.atan2(found.a, found.b) + sigma * turn
    if free:
        nowhere = program.vanishes(
            f"nowhere{suffix}", found.h, scale, "the amplitude is zero", free
        )
        direction = choose(nowhere, 0, direction)
    how = r"2\sigma\operatorname{atan2}(\sqrt{h-c}, \sqrt{h+c}),\ h = \sqrt{a^2+b^2}"
    return replace(
        found.lemma(direction, how),
        means={onward: found.b * sp.sin(x) - found.a * sp.cos(x)},
        body=tuple(program.body[start:]),
    )
