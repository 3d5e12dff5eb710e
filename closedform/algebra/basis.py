"""Groebner bases over a field of parameters that record how they follow from their system."""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from functools import reduce
from itertools import count
from typing import Any

from flint import fmpq_mpoly

from closedform.algebra.trace import terms_of
from closedform.verify import Field, Lead, Monomial, divides, shifted


def logged_basis(field: Field, system: Sequence[fmpq_mpoly]) -> tuple[list[Any], list[int], list[Monomial]]:
    """A Groebner basis of a system, by Buchberger's algorithm.

    The elements are numbered: first those of the system, then one for each step.  A step is a
    multiplier without unknowns, the new element, and a combination of earlier elements that is
    their product.  The second result lists the elements that are the basis, the third their leading
    monomials.
    """
    elements = list(system)
    steps: list[tuple[fmpq_mpoly, dict[int, fmpq_mpoly]]] = []
    found: dict[int, Lead] = {}
    number = count()
    one = field.context.constant(1)
    waiting = [(sum(field.leading(p)[0]), next(number), (i,)) for i, p in enumerate(system)]
    heapq.heapify(waiting)
    while waiting:
        _, _, which = heapq.heappop(waiting)
        if len(which) == 1:
            p, combination = elements[which[0]], {which[0]: one}
        else:
            f, g = (found[i] for i in which)
            common = tuple(map(max, f[0], g[0]))
            if sum(common) == sum(f[0]) + sum(g[0]):
                continue  # the leading monomials are coprime
            gcd = f[1].gcd(g[1])
            left, right = (shifted(field, (h[0], h[1], one), common) for h in (f, g))
            combination = {which[0]: left * (g[1] / gcd), which[1]: -right * (f[1] / gcd)}
            p = sum((q * elements[i] for i, q in combination.items()), 0 * one)
        p = _reduce(field, p, found, combination)
        if p == 0:
            continue
        content = _content(field, p)
        if list(combination.values()) == [one]:
            index = which[0]
        else:
            common = reduce(fmpq_mpoly.gcd, (_content(field, q) for q in combination.values()), content)
            steps.append((content / common, {i: q / common for i, q in combination.items() if q != 0}))
            index = len(elements)
            elements.append(p / content)
        lead = (*field.leading(elements[index]), elements[index])
        for i, f in found.items():
            degree = sum(map(max, f[0], lead[0]))
            heapq.heappush(waiting, (degree, next(number), (i, index)))
        found[index] = lead
    minimal = [
        i
        for i, f in found.items()
        if not any(
            divides(g[0], f[0]) and (g[0] != f[0] or j < i) for j, g in found.items() if j != i
        )
    ]
    written, basis = _needed(elements, len(system), steps, minimal)
    return written, basis, [found[i][0] for i in sorted(minimal)]


def _reduce(
    field: Field, p: fmpq_mpoly, found: dict[int, Lead], combination: dict[int, fmpq_mpoly]
) -> fmpq_mpoly:
    """The remainder; the combination that gives it is updated."""
    while p != 0:
        lead, coefficient = field.leading(p)
        index = next((i for i, f in found.items() if divides(f[0], lead)), None)
        if index is None:
            break
        f = found[index]
        common = f[1].gcd(coefficient)
        scale, quotient = f[1] / common, shifted(field, (f[0], f[1], coefficient / common), lead)
        p = p * scale - quotient * f[2]
        for i in combination:
            combination[i] = combination[i] * scale
        combination[index] = combination.get(index, 0 * p) - quotient
    return p


def _content(field: Field, p: fmpq_mpoly) -> fmpq_mpoly:
    """The greatest common divisor of the coefficients, which are polynomials in parameters."""
    result, zero = 0 * p, (0,) * len(field.unknowns)
    while p != 0:
        lead, coefficient = field.leading(p)
        result = result.gcd(coefficient)
        p = p - shifted(field, (zero, coefficient, coefficient), lead)
    return result


def _needed(
    elements: Sequence[fmpq_mpoly],
    given: int,
    steps: Sequence[tuple[fmpq_mpoly, dict[int, fmpq_mpoly]]],
    basis: Sequence[int],
) -> tuple[list[Any], list[int]]:
    """Only the steps on which the basis depends, as plain data."""
    used = set(basis)
    for k in reversed(range(len(steps))):
        if given + k in used:
            used |= steps[k][1].keys()
    kept = [k for k in range(len(steps)) if given + k in used]
    index = {i: i for i in range(given)} | {given + k: given + n for n, k in enumerate(kept)}
    written = [
        [
            terms_of(steps[k][0]),
            terms_of(elements[given + k]),
            [[index[i], terms_of(q)] for i, q in sorted(steps[k][1].items())],
        ]
        for k in kept
    ]
    return written, sorted(index[i] for i in basis)
