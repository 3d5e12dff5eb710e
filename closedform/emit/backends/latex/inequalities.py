"""Conditions that values are not negative, as a reader writes them."""

from __future__ import annotations

from collections.abc import Container, Mapping, Sequence
from itertools import combinations, permutations

import sympy as sp

from closedform.emit.backends.latex.sheet import Sheet


def inequalities(
    page: Sheet, order: Mapping[sp.Symbol, int], values: Sequence[sp.Expr]
) -> list[str]:
    """``|d| <= m <= a`` for m - d, m + d and a - m, ``b <= x <= a`` alike, and the others alone."""
    math = page.math
    left = list(dict.fromkeys(values))
    texts: list[str] = []
    while pairs := [
        (order.get(found[0], len(order)), *found, v, w)
        for v, w in combinations(left, 2)
        if is_name(found := magnitude(page, v, w), order)
    ]:
        _, middle, difference, value, other = max(pairs, key=lambda p: p[0])
        left = [e for e in left if e not in (value, other)]
        texts.append(between_sizes(page, difference, middle, left))
    while between := next((b for v, w in permutations(left, 2) if (b := limits(v, w))), None):
        lower, middle, upper = between
        left = [e for e in left if e not in (upper - middle, middle - lower)]
        if lower == -upper:
            texts.append(between_sizes(page, middle, upper, left))
        else:
            lower = page.lines.tidy(lower)
            texts.append(rf"${math(lower)} \le {math(middle)} \le {math(upper)}$")
    return texts + [nonnegative(page, value) for value in left]


def between_sizes(page: Sheet, inner: sp.Expr, middle: sp.Expr, left: list[sp.Expr]) -> str:
    """``|d| <= m``, and ``<= a`` for a bound a - m among those that are left, which is used up."""
    text = rf"{page.math(sp.Abs(inner, evaluate=False))} \le {page.math(middle)}"
    if above := next((e for e in left if is_above(e, middle)), None):
        left.remove(above)
        text += rf" \le {page.math(above + middle)}"
    return f"${text}$"


def is_name(found: tuple[sp.Expr, sp.Expr], order: Container[sp.Expr]) -> bool:
    """Whether the middle of two bounds is a name or a root, and the bounds differ."""
    middle, difference = found
    root = middle.is_Pow and middle.exp == sp.S.Half
    return difference != 0 and (middle in order or bool(root))


def limits(value: sp.Expr, other: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """b, x and a of the bounds a - x and x - b: what is subtracted in one and added in the other.

    The terms with a minus in x have to have one in ``other`` too, as those of x - b do.
    """
    terms = sp.Add.make_args(other)
    shared = [t for t in terms if -t in sp.Add.make_args(value)]
    middle = sp.Add(*shared)
    lower, upper = middle - other, value + middle
    if not shared or not lower or not upper or all(map(_is_negative, shared)):
        return None
    return lower, middle, upper


def is_above(value: sp.Expr, middle: sp.Expr) -> bool:
    """Whether a bound is something without ``middle``, less ``middle``."""
    return -middle in sp.Add.make_args(value) and not (value + middle).has(middle)


def magnitude(page: Sheet, value: sp.Expr, other: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    """m and d of two bounds m - d and m + d; the first term of d by its letter is positive."""
    middle, difference = sp.expand((value + other) / 2), sp.expand((other - value) / 2)
    numbers = {t: t.as_coeff_Mul() for t in sp.Add.make_args(difference)}
    first = min(numbers, key=lambda t: page.math(abs(numbers[t][0]) * numbers[t][1]))
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
    root = value.is_Pow and value.exp == sp.S.Half and value.base.is_Symbol
    if root and not page.math(value).startswith(r"\sqrt"):  # of a name that is a square
        return f"${page.math(value)} = 0$"
    if isinstance(value, sp.Abs) or (value.is_Pow and value.exp.is_positive):
        return equality(page, value.args[0])
    if value.is_Mul:  # a number does not vanish
        value = value.as_coeff_Mul()[1]
    terms = page.printer._as_ordered_terms(value) if value.is_Add else [value]
    if len(terms) > 1 and all(t.is_Pow and t.exp.is_even for t in terms):
        bases = [t.base for t in terms]
        if any(b.is_Add for b in bases):
            return " and ".join(equality(page, b) for b in bases)
        return f"${' = '.join(map(page.math, bases))} = 0$"
    less = [-t for t in terms if t.as_coeff_Mul()[0].is_negative]
    more = [t for t in terms if not t.as_coeff_Mul()[0].is_negative]
    if less and more:
        sides = [sp.Add(*more), sp.Add(*less)]
        sides.sort(key=lambda e: e.free_symbols <= page.parameters)
        return f"${page.math(sides[0])} = {page.math(sides[1])}$"
    return f"${page.math(value)} = 0$"


def _is_negative(term: sp.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0].is_negative)


__all__ = ["equality", "inequalities"]
