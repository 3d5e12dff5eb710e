"""Factors of polynomials, as :func:`sympy.factor` writes them, in a small part of its time."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from operator import mul
from typing import Any, TypeAlias

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx
from sympy.core.mul import _keep_coeff
from sympy.polys.polyoptions import build_options
from sympy.polys.polyutils import _sort_gens

from closedform.algebra.tower import content


def factored(value: sp.Expr) -> sp.Expr:
    """The same as ``sympy.factor(value)``."""
    found = _factors(value) or _factors_of_quotient(value)
    if found is None:
        return sp.factor(value)
    constant, powers = found
    return _keep_coeff(constant, sp.Mul(*(factor**power for factor, power in powers)))


Factors: TypeAlias = "tuple[sp.Rational, list[tuple[sp.Expr, int]]]"  # a number, and powers


def _factors(value: sp.Expr) -> Factors | None:
    """The factors of a polynomial; None if it is not one, or a number."""
    found: set[sp.Expr] = set()
    if not _collect(value, found) or not found:
        return None
    # the order decides which sign a factor has
    generators = _sort_gens(found, opt=build_options([], {}))
    ring = fmpq_mpoly_ctx.get([f"g{i}" for i in range(len(generators))], Ordering.lex)
    known = dict(zip(generators, ring.gens(), strict=True))
    polynomial = _polynomial(value, known, ring)
    if polynomial.is_zero():
        return sp.S.Zero, []
    constant, powers = polynomial.factor()
    factors = []
    for factor, power in powers:
        scale = content(factor)
        constant *= scale**power
        factors.append((_expression(factor / scale, generators), int(power)))
    return _rational(constant), factors


def _factors_of_quotient(value: sp.Expr) -> Factors | None:
    """The factors of a numerator and of its denominator, each with an order of its own."""
    constant, factors = sp.S.One, list[tuple[sp.Expr, int]]()
    if not any(p.exp.is_Integer and p.exp.is_negative for p in value.atoms(sp.Pow)):
        return None
    for part in sp.Mul.make_args(sp.together(value)):
        base, power = part.args if part.is_Pow and part.exp.is_Integer else (part, 1)
        found = (base, []) if base.is_Rational else _factors(base)
        if found is None or base.is_number is not base.is_Rational:
            return None
        constant *= found[0] ** power
        factors += [(factor, times * int(power)) for factor, times in found[1]]
    return constant, factors


def _collect(value: sp.Expr, found: set[sp.Expr]) -> bool:
    """Whether it is a polynomial in symbols, sines, cosines and roots of numbers: ``found``."""
    if value.is_Rational:
        return True
    if value.is_Add or value.is_Mul:
        return all(_collect(a, found) for a in value.args)
    if value.is_Pow and value.exp.is_Integer and value.exp.is_positive:
        return _collect(value.base, found)
    if value in found:
        return True
    root = value.is_Pow and value.base.is_Integer and value.exp == sp.Rational(1, 2)
    if root or value.is_Symbol or (isinstance(value, sp.sin | sp.cos) and value.expand() == value):
        found.add(value)
        return True
    return False


def _polynomial(value: sp.Expr, known: Mapping[sp.Expr, fmpq_mpoly], ring: Any) -> Any:
    if value.is_Rational:
        return ring.constant(fmpq(value.p, value.q))
    if value in known:
        return known[value]
    if value.is_Pow:
        return _polynomial(value.base, known, ring) ** int(value.exp)
    parts = [_polynomial(a, known, ring) for a in value.args]
    return reduce(mul, parts) if value.is_Mul else sum(parts[1:], parts[0])


def _expression(p: fmpq_mpoly, generators: tuple[sp.Expr, ...]) -> sp.Expr:
    return sp.Add(
        *(
            sp.Mul(
                _rational(a),
                *(g**k for g, k in zip(generators, map(int, monomial), strict=True) if k),
            )
            for monomial, a in p.terms()
        )
    )


def _rational(value: fmpq) -> sp.Rational:
    return sp.Rational(int(value.p), int(value.q))


__all__ = ["factored"]
