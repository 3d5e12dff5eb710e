"""One angle: from its sine and cosine, and from ``a sin x + b cos x = c``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.amplitude import Amplitude, nearly_tangent
from closedform.lemmas.tangent import LinksAtHeight
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma, Shape


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
        shape=Shape.CONTAINS,
    )


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

    ``b sin x - a cos x`` gets a name too.  The keywords are

    ``free``
        joints that are free where ``a = b = c = 0``; there x = 0 is returned;
    ``scale``
        the scale of the coefficients, on which they vanish;
    ``slack``
        the scale of what c may be missed by, by default ``scale`` with free joints, else h;
    ``toward``
        what later joints have to reach, which decides where both solutions nearly meet.
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
        held = sp.sqrt(toward.held(program, found, size, suffix))
        turn = choose(tangent, sp.atan2(held, (found.above - found.below) / 2), turn)
        root = program.let(f"in_reach{suffix}", choose(tangent, held, root), nonnegative=True)
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
