"""Irreducible factors of polynomials, by FLINT.

SymPy's algorithm tries random points, and for some of them it takes minutes.
"""

from __future__ import annotations

import sympy as sp
from flint import Ordering, fmpz_mpoly_ctx


def polynomial_factors(expr: sp.Expr) -> list[tuple[sp.Expr, int]]:
    """The irreducible factors over the integers, with their multiplicities; no constants."""
    polynomial = sp.Poly(expr).clear_denoms()[1].set_domain(sp.ZZ)
    names = tuple(f"x{k}" for k in range(len(polynomial.gens)))
    context = fmpz_mpoly_ctx.get(names, Ordering.lex)
    given = {exponents: int(c) for exponents, c in polynomial.terms()}
    _, found = context.from_dict(given).factor()
    factors = []
    for factor, multiplicity in found:
        terms = {tuple(map(int, e)): int(c) for e, c in factor.to_dict().items()}
        leading = terms[max(terms)]
        signed = {e: c if leading > 0 else -c for e, c in terms.items()}
        factors.append((sp.Poly(signed, *polynomial.gens).as_expr(), int(multiplicity)))
    return sorted(factors, key=lambda f: (f[1], len(sp.Add.make_args(f[0])), str(f[0])))


__all__ = ["polynomial_factors"]
