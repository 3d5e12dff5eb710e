"""Factors of polynomials in sines and cosines, found on the circles of their angles.

Such a polynomial can be a product although no way to write it as a polynomial in independent sines
and cosines shows that.  In the tangents of half the angles the factors are those of a polynomial.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from typing import Any

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly, fmpq_mpoly_ctx

from closedform.algebra.factoring import factored
from closedform.algebra.operations import operations

LARGEST = 3000
"""A polynomial that would have more terms in the tangents is not factored."""


def factored_on_circles(value: sp.Expr) -> sp.Expr:
    """The same as a product of polynomials in sines and cosines, as far as they are factors."""
    return sp.Mul(
        *(
            _factors(base) ** power if base.is_Add else factor
            for factor in sp.Mul.make_args(value)
            for base, power in (factor.as_base_exp(),)
        )
    )


def shortest_on_circles(value: sp.Expr) -> sp.Expr:
    """An expanded polynomial with squares of the sine or of the cosine, whichever is shorter."""
    for angle in _angles(value) or ():
        s, c = sp.sin(angle), sp.cos(angle)
        forms = (value, _without_squares(value, s, c), _without_squares(value, c, s))
        value = min(forms, key=operations)
    return value


def _without_squares(value: sp.Expr, gone: sp.Expr, kept: sp.Expr) -> sp.Expr:
    """The same sum of products; ``gone`` is a sine or cosine, and ``kept`` the other one."""
    terms = []
    for term in sp.Add.make_args(value):
        powers = dict(f.as_base_exp() for f in sp.Mul.make_args(term))
        squares = powers.get(gone, 0) // 2
        rest = term / gone ** (2 * squares) if squares else term
        binomials = range(squares + 1)
        terms += [rest * sp.binomial(squares, k) * (-(kept**2)) ** k for k in binomials]
    return sp.Add(*terms)


def _angles(value: sp.Expr) -> list[sp.Symbol] | None:
    """The angles, in order; None if one of them is not a symbol or stands for itself too."""
    angles = {f.args[0] for f in value.atoms(sp.sin, sp.cos)}
    names = {f: sp.Dummy() for f in value.atoms(sp.sin, sp.cos)}
    bare = value.xreplace(names)
    is_polynomial = bare.is_polynomial(*bare.free_symbols)
    if not is_polynomial or not all(a.is_Symbol for a in angles) or angles & bare.free_symbols:
        return None
    return sorted(angles, key=str)


def _factors(value: sp.Expr) -> sp.Expr:
    found = _in_tangents(value)
    if found is None:
        return value
    whole, degrees, angles, others = found
    number, powers = whole.factor()
    parts = _of_even_degree(powers, len(angles), whole.context().constant(1))
    rest = [2 * d - sum(f.degrees()[i] * k for f, k in parts) for i, d in enumerate(degrees)]
    if len(parts) + sum(r > 1 for r in rest) == 1:
        return value
    product = sp.Rational(int(number.p), int(number.q))
    for f, k in parts:
        halves = [(d + 1) // 2 for d in f.degrees()[: len(angles)]]
        rest = [r - (2 * h - d) * k for r, h, d in zip(rest, halves, f.degrees(), strict=False)]
        product *= factored(shortest_on_circles(_trigonometric(f, halves, angles, others))) ** k
    for r, a in zip(rest, angles, strict=True):  # what vanishes at half a turn lowers the degree
        product *= ((1 + sp.cos(a)) / 2) ** (r // 2)
    return product


def _in_tangents(
    value: sp.Expr,
) -> tuple[fmpq_mpoly, list[int], list[sp.Symbol], list[sp.Symbol]] | None:
    """A polynomial in tangents t of half the angles, multiplied by powers of all 1 + t^2.

    With it are these powers, the angles, and its other symbols.
    """
    angles = _angles(value)
    if not angles:
        return None
    n, others = len(angles), sorted(value.free_symbols - {*angles}, key=str)
    read = sp.Poly(value, *(f(a) for a in angles for f in (sp.sin, sp.cos)), *others)
    monomials = read.monoms()
    degrees = [max(m[2 * i] + m[2 * i + 1] for m in monomials) for i in range(n)]
    size = prod(2 * d + 1 for d in degrees) * len({m[2 * n :] for m in monomials})
    if size > LARGEST or not all(c.is_Rational for c in read.coeffs()):
        return None
    names = [f"t{i}" for i in range(n)] + [f"p{i}" for i in range(len(others))]
    ring = fmpq_mpoly_ctx.get(names, Ordering.lex)
    t, p = ring.gens()[:n], ring.gens()[n:]
    whole = ring.constant(0)
    for monomial, number in read.terms():
        term = ring.constant(fmpq(int(number.p), int(number.q)))
        for i in range(n):
            a, b = monomial[2 * i : 2 * i + 2]
            term *= (2 * t[i]) ** a * (1 - t[i] ** 2) ** b * (1 + t[i] ** 2) ** (degrees[i] - a - b)
        whole += prod((g**e for g, e in zip(p, monomial[2 * n :], strict=True)), start=term)
    return whole, degrees, angles, others


def _of_even_degree(
    powers: Sequence[tuple[fmpq_mpoly, int]], n: int, one: fmpq_mpoly
) -> list[tuple[fmpq_mpoly, int]]:
    """Factors that are polynomials in sines and cosines: those of odd degree only together are."""
    found, together = list[tuple[fmpq_mpoly, int]](), one
    for f, k in powers:
        if all(d % 2 == 0 for d in f.degrees()[:n]):
            found.append((f, k))
            continue
        if k > 1:
            found.append((f * f, k // 2))
        if k % 2:
            together *= f
    return found if together == one else [*found, (together, 1)]


def _trigonometric(
    f: fmpq_mpoly, halves: Sequence[int], angles: Sequence[sp.Symbol], others: Sequence[sp.Symbol]
) -> sp.Expr:
    """A polynomial in tangents t, divided by the powers ``halves`` of all 1 + t^2."""
    n = len(angles)
    terms = []
    for exponents, number in f.to_dict().items():
        term: Any = sp.Rational(int(number.p), int(number.q))
        term *= sp.Mul(*(s**e for s, e in zip(others, exponents[n:], strict=True)))
        for k, half, angle in zip(exponents, halves, angles, strict=False):
            s, c = sp.sin(angle), sp.cos(angle)
            odd = k % 2
            below, above = (1 - c) / 2, (1 + c) / 2
            term *= below ** (k // 2) * above ** (half - k // 2 - odd) * (s / 2) ** odd
        terms.append(sp.expand(term))
    return sp.expand(sp.Add(*terms))


__all__ = ["factored_on_circles", "shortest_on_circles"]
