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
