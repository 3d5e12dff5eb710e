"""An angle whose sine and cosine are known up to one factor, as a reader has it."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.model.lemma import Lemma


def scaled(lemma: Lemma, equations: Sequence[sp.Expr], algorithm: Algorithm) -> list[sp.Expr]:
    """The equations ``k sin x = f`` and ``k cos x = g``, each as a difference of its sides.

    ``equations`` are those of the derivation, which may say what k is.
    """
    roles = dict(lemma.roles)
    angle, sine, cosine = (roles[letter] for letter in lemma.scaled)
    factor = _stated(angle, (sine, cosine), equations, algorithm)
    if factor is None:
        factor = _length((sine, cosine), algorithm)
    return [factor * sp.sin(angle) - sine, factor * sp.cos(angle) - cosine]


def _stated(
    angle: sp.Expr,
    pair: tuple[sp.Expr, sp.Expr],
    equations: Sequence[sp.Expr],
    algorithm: Algorithm,
) -> sp.Expr | None:
    """The factor k of an equation that has the sine or the cosine alone."""
    for equation in equations:
        for f, value in zip((sp.sin, sp.cos), pair, strict=True):
            factor = equation.coeff(f(angle))
            rest = equation - factor * f(angle)
            for sign in (1, -1):
                difference = algorithm.full(rest) + sign * algorithm.full(value)
                if factor != 0 and sp.expand(difference) == 0:
                    return sign * factor
    return None


def _length(pair: tuple[sp.Expr, sp.Expr], algorithm: Algorithm) -> sp.Expr:
    """The length of the vector of both, by its name if it has one."""
    signs = dict.fromkeys(algorithm.signs, sp.S.One)
    square = sp.Add(*(e.xreplace(signs) ** 2 for e in pair))
    if (number := sp.trigsimp(square)).is_number:
        return sp.sqrt(number)
    for name, value in algorithm.values.items():
        if name not in algorithm.unknowns and sp.expand(value**2 - square) == 0:
            return name
    return sp.sqrt(square)


__all__ = ["scaled"]
