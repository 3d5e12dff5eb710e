"""The yaw of a hand from an equation ``a sin(yaw) + b cos(yaw) = c``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import sympy as sp

from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.links import degenerate
from closedform.lemmas.rails import named_number
from closedform.model.functions import Program, choose
from closedform.model.inverse import Link
from closedform.model.pair import Pair


def never_free(*coefficients: sp.Expr) -> bool:
    """Whether coefficients cannot all vanish, because one of them is a number."""
    return any(bool(e.is_number and e != 0) for e in coefficients)


def yaw_by_amplitude(
    f: Program,
    yaw: sp.Symbol,
    coefficients: Sequence[sp.Expr],
    sigma: sp.Symbol,
    size: sp.Expr,
    *,
    missed: Callable[[sp.Symbol], sp.Expr],
    said: str,
) -> tuple[Link, Pair, sp.Expr]:
    """The link for the yaw, the pair of it, and the size of ``b sin(yaw) - a cos(yaw)``.

    Parameters
    ----------
    f
        the program that the names and bounds are added to
    yaw
        the angle
    coefficients
        names for a, b and c, or numbers
    sigma
        the sign of the root
    size
        the scale of a and b
    missed
        maps the size of (a, b) to the scale of the error that is allowed in c
    said
        what is the case where the yaw is free, because a and b vanish
    """
    fixed = never_free(*coefficients)
    a, b, c = (
        named_number(f, f"{n}_turn", e) if e.is_number else e
        for n, e in zip("abc", coefficients, strict=True)
    )
    start = len(f.body)
    at = Amplitude.of(f, yaw, (a, b, c), sigma, scale=missed, suffix="_turn")
    free: sp.Basic = sp.false
    if not fixed:
        free = f.vanishes("free", at.h, size, "the hand turns freely", (yaw,))
    root = f.let("root", at.root, nonnegative=True)
    # not by the differences h - c and h + c, in which a small c is lost
    length = f.let("length", choose(free, 1, sp.sqrt(c**2 + root**2)), nonnegative=True)
    reach = f.let("reach", choose(free, 1, at.h), nonnegative=True)
    away = Pair(sigma * root / length, c / length)
    found = Pair(at.a / reach, at.b / reach) + away
    pair = Pair(f.let("s", choose(free, 0, found.s)), f.let("c_yaw", choose(free, 1, found.c)))
    how = r"\sigma\delta,\ (\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ "
    means = {pair.s: sp.sin(yaw), pair.c: sp.cos(yaw)}
    lemma = at.lemma(sp.atan2(pair.s, pair.c), rf"{how}h = \sqrt{{a^2+b^2}}")
    told = sp.atan2(a, b, evaluate=False) + sigma * sp.atan2(root, c, evaluate=False)
    lemma = replace(lemma, means=means, plainly={yaw: choose(free, 0, told)})
    link = Link(
        unknowns=(yaw,),
        equations=lemma.equations,
        given={},
        lemma=lemma,
        body=tuple(f.body[start:]),
        means=means,
        degenerate=degenerate(free, [{e: sp.S.Zero for e in (a, b, c) if e != 0}], yaw, said),
    )
    return link, pair, root


__all__ = ["never_free", "yaw_by_amplitude"]
