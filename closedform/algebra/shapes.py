"""The shape of the equation that a lemma solves, so that a wrong one is reported early."""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.algebra.expressions import shortened
from closedform.model.lemma import Lemma, Shape


class ShapeError(ValueError):
    """A lemma is applied to an equation of another shape."""


def require_shape(lemma: Lemma, equation: Any, unknown: sp.Symbol) -> None:
    """Raise :class:`ShapeError` if the lemma cannot solve ``equation = 0``."""
    if lemma.shape is Shape.LINEAR:
        coefficients(equation, unknown, lemma.name)
    elif lemma.shape is Shape.CONTAINS and not equation.has(unknown):
        raise ShapeError(
            f"the lemma {lemma.name!r} for {unknown} needs an equation in sin({unknown}) and "
            f"cos({unknown}); 0 = {shortened(equation)} does not contain {unknown}"
        )


def coefficients(
    equation: Any, x: sp.Symbol, lemma: str = "a sin x + b cos x = c"
) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """``a, b, c`` of an equation ``a sin x + b cos x - c = 0``.

    >>> l, y = sp.symbols("l y")
    >>> coefficients(2 * l * sp.sin(x := sp.Symbol("x")) - y, x)
    (2*l, 0, y)
    """
    s, c = sp.Dummy("s"), sp.Dummy("c")
    expanded = sp.expand(sp.expand_trig(sp.expand(equation)))
    renamed = expanded.xreplace({sp.sin(x): s, sp.cos(x): c})
    needs = f"the lemma {lemma!r} for {x} needs an equation that is linear in sin({x}), cos({x})"
    if renamed.has(x):
        raise ShapeError(f"{needs}; in 0 = {shortened(equation)} the unknown occurs elsewhere")
    try:
        polynomial = sp.Poly(renamed, s, c)
    except sp.PolynomialError as error:
        what = "is not a polynomial in them"
        raise ShapeError(f"{needs}; 0 = {shortened(equation)} {what}") from error
    if polynomial.is_ground:
        raise ShapeError(f"{needs}; 0 = {shortened(equation)} does not contain {x}")
    for (i, j), value in polynomial.terms():
        if i + j > 1:
            term = value * sp.sin(x) ** i * sp.cos(x) ** j
            raise ShapeError(f"{needs}; 0 = {shortened(equation)} has the term {shortened(term)}")
    a, b, rest = (polynomial.coeff_monomial(m) for m in (s, c, 1))
    return a, b, -rest
