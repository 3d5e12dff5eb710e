"""Groebner bases over a field of parameters that record how they follow from their system."""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from closedform.algebra.trace import terms_of
from closedform.verify import Field, Lead, Monomial, Polynomial, divides, shifted

LIMIT = 250_000
"""At most this many terms are reduced for a basis, which takes a second.  Those that are found in
the mechanisms of this repository need at most 60,000."""

Combination: TypeAlias = "dict[int, Polynomial]"


class TooLargeError(ValueError):
    """A basis with its combinations is too expensive."""


@dataclass(frozen=True)
class Logged:
    """A Groebner basis, and how it follows from its system."""

    steps: list[Any]
    """A multiplier without unknowns, the new element, and the combination of earlier elements that
    equals their product."""
    basis: list[int]
    """The numbers of its elements: first come those of the system, then one for each step."""
    elements: list[Polynomial]
    leads: list[Monomial]
    """The leading monomials of the elements."""


def logged_basis(field: Field, system: Sequence[Polynomial]) -> Logged:
    """A Groebner basis of a system, by Buchberger's algorithm.

    Raises :class:`TooLargeError` if the computation is too expensive.
    """
    buchberger = _Buchberger(field, system)
    buchberger.run()
    found = buchberger.found
    minimal = [
        i
        for i, (lead, _, _) in sorted(found.items())
        if not any(
            divides(other, lead) and (other != lead or j < i)
            for j, (other, _, _) in found.items()
            if j != i
        )
    ]
    steps, basis = buchberger.written(minimal)
    elements = [buchberger.elements[i] for i in minimal]
    return Logged(steps, basis, elements, [found[i][0] for i in minimal])


class _Buchberger:
    def __init__(self, field: Field, system: Sequence[Polynomial]) -> None:
        self.field = field
        self.elements = list(system)
        self.given = len(system)
        self.steps: list[tuple[Polynomial, Combination]] = []
        self.found: dict[int, Lead] = {}
        """The elements of the basis, each with its leading monomial and its coefficient."""
        self.one = field.context.constant(1)
        self.terms = 0
        """The number of terms that were reduced so far."""

    def run(self) -> None:
        """Reduce the system and all pairs, those of the least degree first."""
        waiting = [
            (sum(self.field.leading(p)[0]), i, (i,)) for i, p in enumerate(self.elements)
        ]  # the number in the middle makes the order definite
        queue: list[tuple[int, int, tuple[int, ...]]] = sorted(waiting)
        pairs = len(queue)
        while queue:
            _, _, which = heapq.heappop(queue)
            combination = {which[0]: self.one} if len(which) == 1 else self._pair(*which)
            total = sum((q * self.elements[i] for i, q in combination.items()), 0 * self.one)
            rest = self._reduce(total, combination)
            if rest == 0:
                continue
            index = self._added(rest, combination)
            lead = (*self.field.leading(self.elements[index]), self.elements[index])
            for i, f in self.found.items():
                if any(map(min, f[0], lead[0])):  # those of coprime monomials reduce to zero
                    pairs += 1
                    heapq.heappush(queue, (sum(map(max, f[0], lead[0])), pairs, (i, index)))
            self.found[index] = lead

    def _pair(self, i: int, j: int) -> Combination:
        """The combination of two elements in which their leading terms cancel."""
        f, g = self.found[i], self.found[j]
        common, divisor = tuple(map(max, f[0], g[0])), f[1].gcd(g[1])
        left, right = (shifted(self.field, (h[0], h[1], self.one), common) for h in (f, g))
        return {i: left * (g[1] / divisor), j: -right * (f[1] / divisor)}

    def _reduce(self, p: Polynomial, combination: Combination) -> Polynomial:
        """The remainder of a combination, which is changed accordingly."""
        while p != 0:
            self.terms += len(p) + sum(map(len, combination.values()))
            if self.terms > LIMIT:
                raise TooLargeError("too many terms")
            lead, coefficient = self.field.leading(p)
            index = next((i for i, f in self.found.items() if divides(f[0], lead)), None)
            if index is None:
                break
            monomial, leading, f = self.found[index]
            common = leading.gcd(coefficient)
            scale = leading / common
            quotient = shifted(self.field, (monomial, leading, coefficient / common), lead)
            p = p * scale - quotient * f
            for i in combination:
                combination[i] *= scale
            combination[index] = combination.get(index, 0 * p) - quotient
        return p

    def _added(self, rest: Polynomial, combination: Combination) -> int:
        """The number of the new element, without its content."""
        if list(combination.values()) == [self.one]:
            return min(combination)
        content = self._content([rest])
        common = self._content([content, *combination.values()])
        kept = {i: q / common for i, q in combination.items() if q != 0}
        self.steps.append((content / common, kept))
        self.elements.append(rest / content)
        return len(self.elements) - 1

    def _content(self, polynomials: Iterable[Polynomial]) -> Polynomial:
        """The greatest common divisor of the coefficients, which are polynomials in parameters."""
        result = 0 * self.one
        slots = [len(self.field.kinds) - 1 - i for i in self.field.unknowns]
        for p in polynomials:
            coefficients: dict[Monomial, dict[Monomial, Any]] = {}
            for m, a in p.terms():
                rest = tuple([0 if j in slots else n for j, n in enumerate(m)])
                coefficients.setdefault(tuple([m[j] for j in slots]), {})[rest] = a
            for terms in coefficients.values():
                if not result.is_one():
                    result = result.gcd(self.field.context.from_dict(terms))
        return result

    def written(self, basis: Sequence[int]) -> tuple[list[Any], list[int]]:
        """The steps on which the basis depends, as plain data, and the basis."""
        used = set(basis)
        for k in reversed(range(len(self.steps))):
            if self.given + k in used:
                used |= self.steps[k][1].keys()
        kept = [k for k in range(len(self.steps)) if self.given + k in used]
        index = {i: i for i in range(self.given)}
        index |= {self.given + k: self.given + n for n, k in enumerate(kept)}
        steps = [
            [
                terms_of(self.steps[k][0]),
                terms_of(self.elements[self.given + k]),
                [[index[i], terms_of(q)] for i, q in sorted(self.steps[k][1].items())],
            ]
            for k in kept
        ]
        return steps, [index[i] for i in basis]
