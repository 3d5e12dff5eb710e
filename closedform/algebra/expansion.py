"""Products of matrices, multiplied out: what ``sp.expand`` gives, by polynomial arithmetic."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import prod
from typing import Any

import sympy as sp
from flint import Ordering, fmpq, fmpq_mpoly_ctx

from closedform.algebra.expressions import subexpressions

Rows = list[list[Any]]
"""A matrix; its entries are polynomials, or expressions where these have other operations."""
FACTORS = 1000
"""Larger prime factors of the number in a root stay together."""


class Expansion:
    """The polynomials in the symbols, sines, cosines and roots of some matrices."""

    def __init__(self, matrices: Iterable[sp.Matrix]):
        parts = subexpressions([sp.sympify(e, strict=True) for M in matrices for e in M.flat()])
        inside = {
            a for e in parts if isinstance(e, sp.sin | sp.cos) for a in subexpressions(e.args)
        }
        atoms = [e for e in parts if _is_atom(e)]
        self._polynomial = all(_is_plain(e) or e in inside for e in parts) and all(
            sp.expand(e) == e for e in atoms
        )
        roots = [r for e in atoms if _is_root(e) for r in _roots_of(e)]
        self._atoms = atoms = [*(e for e in atoms if not _is_root(e)), *dict.fromkeys(roots)]
        context = fmpq_mpoly_ctx.get([f"x{i}" for i in range(len(atoms))], Ordering.lex)
        self._constant = context.constant
        self._known = dict(zip(atoms, context.gens(), strict=True))
        self._relations = [
            (k, self._known[e] ** 2 - int(e.base)) for k, e in enumerate(atoms) if e.is_Pow
        ]

    def read(self, matrix: sp.Matrix) -> Rows:
        """A matrix of the given ones, or of their entries."""
        return [[self._read(e) for e in matrix.row(i)] for i in range(matrix.rows)]

    def times(self, a: Rows, b: Rows) -> Rows:
        """The product of two matrices."""
        columns = list(zip(*b, strict=True))
        return [[self._dot(row, column) for column in columns] for row in a]

    def plus(self, a: Rows, b: Rows, sign: int = 1) -> Rows:
        """The sum of two matrices, or their difference."""
        pairs = (zip(x, y, strict=True) for x, y in zip(a, b, strict=True))
        return [[x + sign * y for x, y in row] for row in pairs]

    def cross(self, a: Rows, b: Rows) -> Rows:
        """The cross product of two columns."""
        (x,), (y,), (z,) = a
        return self.times([[0 * x, -z, y], [z, 0 * x, -x], [-y, x, 0 * x]], b)

    def written(self, rows: Rows) -> sp.Matrix:
        """The same as a matrix of SymPy."""
        return sp.Matrix([[self._written(p) for p in row] for row in rows])

    def _dot(self, row: Sequence[Any], column: Sequence[Any]) -> Any:
        total = sum((x * y for x, y in zip(row, column, strict=True) if x != 0 != y), 0 * row[0])
        if not self._polynomial:
            return sp.expand(total)
        for k, relation in self._relations:
            if total.degrees()[k] > 1:
                total = divmod(total, relation)[1]
        return total

    def _read(self, e: Any) -> Any:
        if not self._polynomial:
            return sp.expand(e)
        if e not in self._known:
            self._known[e] = self._made(e)
        return self._known[e]

    def _made(self, e: Any) -> Any:
        if e.is_Rational:
            return self._constant(fmpq(e.p, e.q))
        if _is_root(e):
            return prod(self._known[r] for r in _roots_of(e))
        if e.is_Pow:
            return self._read(e.base) ** int(e.exp)
        total = self._constant(int(e.is_Mul))
        for part in map(self._read, e.args):
            total = total * part if e.is_Mul else total + part
        return total

    def _written(self, p: Any) -> Any:
        if not self._polynomial:
            return sp.expand(p)
        terms = []
        for powers, a in p.terms():
            factors = (e**n for e, n in zip(self._atoms, powers, strict=True) if n)
            terms.append(sp.Mul(sp.Rational(int(a.p), int(a.q)), *factors))
        return sp.Add(*terms)


def _is_atom(e: Any) -> bool:
    return isinstance(e, sp.Symbol | sp.sin | sp.cos) or e is sp.pi or _is_root(e)


def _is_root(e: Any) -> bool:
    return bool(e.is_Pow and e.exp == sp.S.Half and e.base.is_Integer)


def _roots_of(root: Any) -> list[Any]:
    """The roots whose product is the root of an integer, so that those of 2, 3 and 6 are two."""
    return [sp.sqrt(p**n) for p, n in sp.factorint(root.base, limit=FACTORS).items()]


def _is_plain(e: Any) -> bool:
    """Whether an expression is made of its parts by arithmetic without a division."""
    power = e.is_Pow and e.exp.is_Integer and e.exp.is_positive
    return bool(e.is_Rational or e.is_Add or e.is_Mul or power or _is_atom(e))


__all__ = ["Expansion", "Rows"]
