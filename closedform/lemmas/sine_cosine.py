"""One angle: from its sine and cosine, and from ``a sin x + b cos x = c``."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma


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
) -> Lemma:
    """``a sin x + b cos x = c``: two solutions where ``a^2 + b^2 >= c^2``.

    With ``h = sqrt(a^2 + b^2)`` the equation is ``cos(x - atan2(a, b)) = c / h``; half the angle
    ``x - atan2(a, b)`` has the tangent ``sqrt(h - c) / sqrt(h + c)``.  x is free where
    ``a = b = c = 0``; with ``free`` joints that is flagged, on the ``scale`` of the coefficients,
    and the answer there is x = 0.  ``b sin x - a cos x`` gets a name too.
    """
    start = len(program.body)
    h = program.let(f"h{suffix}", sp.sqrt(a**2 + b**2), nonnegative=True)
    size = scale if free else h
    below = program.bound(f"below{suffix}", h - c, size, "the amplitude is not smaller than c")
    above = program.bound(f"above{suffix}", h + c, size, "the amplitude is not smaller than -c")
    half = sp.atan2(sp.sqrt(below), sp.sqrt(above))
    onward = program.let(f"onward{suffix}", sigma * sp.sqrt(below) * sp.sqrt(above))
    direction = sp.atan2(a, b) + 2 * sigma * half
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
