"""Conditions that values are not negative, as a reader writes them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations, permutations

import sympy as sp

from closedform.emit.backends.latex.sheet import Sheet


def inequalities(
    page: Sheet, order: Mapping[sp.Symbol, int], values: Sequence[sp.Expr]
) -> list[str]:
    """``|d| <= m <= a`` for m - d, m + d and a - m, and what is left one by one."""
    math = page.math
    left = list(dict.fromkeys(values))
    texts: list[str] = []
    while pairs := [
        found
        for v, w in combinations(left, 2)
        if (found := (*magnitude(page, v, w), v, w))[0] in order and found[1] != 0
    ]:
        middle, difference, value, other = max(pairs, key=lambda p: order[p[0]])
        above = next((e + middle for e in left if is_above(e, middle)), None)
        text = rf"{math(sp.Abs(difference, evaluate=False))} \le {math(middle)}"
        text += rf" \le {math(above)}" if above is not None else ""
        texts.append(f"${text}$")
        used = {value, other, *(() if above is None else (above - middle,))}
        left = [e for e in left if e not in used]
    for value, other in permutations(left, 2):
        middle = next((m for m in order if m in value.free_symbols & other.free_symbols), None)
        if middle and is_above(value, middle) and is_above(-other, middle):
            text = rf"{math(middle - other)} \le {math(middle)} \le {math(value + middle)}"
            texts.append(f"${text}$")
            left = [e for e in left if e not in (value, other)]
            break
    return texts + [nonnegative(page, value) for value in left]


def is_above(value: sp.Expr, middle: sp.Expr) -> bool:
    """Whether a bound is something without ``middle``, less ``middle``."""
    return -middle in sp.Add.make_args(value) and not (value + middle).has(middle)


def magnitude(page: Sheet, value: sp.Expr, other: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """m and d of two bounds m - d and m + d; d has a positive term first."""
    middle, difference = sp.expand((value + other) / 2), sp.expand((other - value) / 2)
    first = page.printer._as_ordered_terms(difference)[0] if difference.is_Add else difference
    if _is_negative(first):
        difference = -difference
    return middle, difference


def nonnegative(page: Sheet, value: sp.Expr) -> str:
    """The condition that a value is not negative: ``a <= b`` for ``b - a``."""
    math = page.math
    less = [-t for t in sp.Add.make_args(value) if t.as_coeff_Mul()[0].is_negative]
    more = [t for t in sp.Add.make_args(value) if not t.as_coeff_Mul()[0].is_negative]
    if less and more:
        return rf"${math(sp.Add(*less))} \le {math(sp.Add(*more))}$"
    return rf"${math(value)} \ge 0$"


def equality(page: Sheet, value: sp.Expr) -> str:
    """The condition that a value is zero: ``a = b`` for ``a - b``, and 0 for each of squares."""
    if isinstance(value, sp.Min):
        return " or ".join(equality(page, e) for e in sorted(value.args, key=page.math))
    if isinstance(value, sp.Abs) or (value.is_Pow and value.exp.is_positive):
        return equality(page, value.args[0])
    terms = page.printer._as_ordered_terms(value) if value.is_Add else [value]
    if len(terms) > 1 and all(t.is_Pow and t.exp.is_even for t in terms):
        bases = [t.base for t in terms]
        if any(b.is_Add for b in bases):
            return " and ".join(equality(page, b) for b in bases)
        return f"${' = '.join(map(page.math, bases))} = 0$"
    less = [-t for t in terms if t.as_coeff_Mul()[0].is_negative]
    more = [t for t in terms if not t.as_coeff_Mul()[0].is_negative]
    if less and more:
        return f"${page.math(sp.Add(*more))} = {page.math(sp.Add(*less))}$"
    return f"${page.math(value)} = 0$"


def _is_negative(term: sp.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0].is_negative)


__all__ = ["equality", "inequalities"]
