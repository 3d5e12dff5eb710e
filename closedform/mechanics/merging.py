"""Sums whose products of sines and cosines become sines and cosines of sums of angles.

A sum of products of symbols, sines and cosines is kept as a dictionary, which is changed in a small
part of the time that SymPy takes.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from itertools import combinations
from typing import TypeAlias

import sympy as sp
from flint import fmpq

from closedform.algebra.operations import operations

Monomial: TypeAlias = "tuple[tuple[int, int], ...]"  # numbers of factors in order, with powers
Terms: TypeAlias = "dict[Monomial, fmpq]"


@dataclass
class _Factors:
    """The symbols, sines and cosines of a sum, by number, and the operations in each."""

    listed: list[sp.Expr] = field(default_factory=list)
    sizes: list[int] = field(default_factory=list)
    numbers: dict[sp.Expr, int] = field(default_factory=dict)

    def number(self, factor: sp.Expr) -> int:
        if factor not in self.numbers:
            self.numbers[factor] = len(self.listed)
            self.listed.append(factor)
            self.sizes.append(operations(factor))
        return self.numbers[factor]


def with_merged_angles(value: sp.Expr) -> sp.Expr | None:
    """An expanded sum with as many pairs of angles merged as shorten it; None for other sums."""
    terms, factors = dict[Monomial, fmpq](), _Factors()
    for term in sp.Add.make_args(value):
        read = _read(term, factors)
        if read is None:
            return None
        monomial, number = read
        terms[monomial] = terms.get(monomial, fmpq(0)) + number
    shortest = _Sum(terms, factors)
    while (shorter := shortest.shorter()) is not None:
        shortest = shorter
    return shortest.expression()


def _read(term: sp.Expr, factors: _Factors) -> tuple[Monomial, fmpq] | None:
    number, powers = fmpq(1), dict[int, int]()
    for factor in sp.Mul.make_args(term):
        if factor.is_Rational:
            number *= fmpq(int(factor.p), int(factor.q))
            continue
        base, power = factor.args if factor.is_Pow else (factor, sp.S.One)
        turning = isinstance(base, sp.sin | sp.cos) and not base.args[0].has(sp.sin, sp.cos)
        if not (base.is_Symbol or turning) or not (power.is_Integer and power.is_positive):
            return None
        powers[factors.number(base)] = int(power)
    return tuple(sorted(powers.items())), number


@dataclass(frozen=True)
class _Sum:
    terms: Terms
    factors: _Factors

    def shorter(self) -> _Sum | None:
        """The sum with the first pair of angles merged that shortens it; None if none does."""
        angles = sorted({a for met in self._together for a in met}, key=sp.default_sort_key)
        for a, b in combinations(angles, 2):
            if any(a in met and b in met for met in self._together):
                best = min(self._with_sums(a, b), key=lambda found: found.size)
                if best.size < self.size:
                    return best
        return None

    @cached_property
    def _together(self) -> set[frozenset[sp.Expr]]:
        """The angles of each term; only angles that meet in a product can be merged."""
        listed = self.factors.listed
        angles = [f.args[0] if f.args else None for f in listed]
        return {frozenset(a for i, _ in m if (a := angles[i]) is not None) for m in self.terms}

    @cached_property
    def size(self) -> int:
        """The operations of the expression, and three more for each of its terms."""
        counted = sum(self._operations(m, abs(a)) for m, a in self.terms.items())
        negative = all(a < 0 for a in self.terms.values()) if self.terms else False
        return counted + 4 * max(1, len(self.terms)) - 1 + negative

    def _operations(self, monomial: Monomial, number: fmpq) -> int:
        if not monomial:
            return int(number.q != 1)
        sizes = sum(self.factors.sizes[i] + (n > 1) for i, n in monomial)
        return sizes + len(monomial) - 1 + int(number.p != 1) + int(number.q != 1)

    def _with_sums(self, a: sp.Expr, b: sp.Expr) -> Iterator[_Sum]:
        """The sum with products of ``a`` and ``b`` replaced, by their sum and by their difference.

        The order decides which of several shortest sums is taken.
        """
        ca, sa, cb, sb = sp.cos(a), sp.sin(a), sp.cos(b), sp.sin(b)
        yield self
        for sign in (1, -1):
            C, S = sp.cos(a + sign * b), sp.sin(a + sign * b)
            for rewritten in (self._replaced(ca, cb, C + sign * sa * sb), self):
                yield rewritten._replaced(sa, cb, S - sign * ca * sb)
                yield rewritten._replaced(ca, sb, sign * (S - sa * cb))
                yield rewritten

    def _replaced(self, first: sp.Expr, second: sp.Expr, sum_: sp.Expr) -> _Sum:
        """The sum with a product of two factors replaced, as often as it is in each term."""
        i, j = (self.factors.numbers.get(f, -1) for f in (first, second))
        found = {m for m in self.terms if i in (own := dict(m)) and j in own}
        parts = [_read(part, self.factors) for part in sp.Add.make_args(sp.expand(sum_))]
        by = dict(part for part in parts if part is not None)
        if not found or len(by) < len(parts):  # such as a cosine that is a root
            return self
        terms = {m: a for m, a in self.terms.items() if m not in found}
        powers = {1: by}
        for monomial in found:
            number, own = self.terms[monomial], dict(monomial)
            times = min(own[i], own[j])
            if times not in powers:
                powers[times] = reduce(_product, [by] * times)
            own[i], own[j] = own[i] - times, own[j] - times
            left = {tuple([(k, n) for k, n in own.items() if n]): number}
            for changed, a in _product(left, powers[times]).items():
                terms[changed] = terms.get(changed, fmpq(0)) + a
        return replace(self, terms={m: a for m, a in terms.items() if a != 0})

    def expression(self) -> sp.Expr:
        listed = self.factors.listed
        return sp.Add(
            *(
                sp.Mul(sp.Rational(int(a.p), int(a.q)), *(listed[i] ** n for i, n in m))
                for m, a in self.terms.items()
            )
        )


def _product(a: Mapping[Monomial, fmpq], b: Mapping[Monomial, fmpq]) -> Terms:
    found: Terms = {}
    for (m, x), (n, y) in ((s, t) for s in a.items() for t in b.items()):
        powers = dict(m)
        for i, k in n:
            powers[i] = powers.get(i, 0) + k
        key = tuple(sorted(powers.items()))
        found[key] = found.get(key, fmpq(0)) + x * y
    return found


__all__ = ["with_merged_angles"]
