"""Sums of products of sines and cosines, collected joint by joint."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.emit.backends.latex.formulas import natural


def joint_by_joint(value: sp.Expr) -> sp.Expr:
    """A sum with the sine and the cosine of the first joint before sums, in these the next ones'.

    As in ``c_1 (c_23 (c_4 c_5 c_6 - s_4 s_6) - s_23 s_5 c_6) - s_1 (s_4 c_5 c_6 + c_4 s_6)``.
    """
    angles = {f.args[0] for f in value.atoms(sp.sin, sp.cos) if _is_sum_of_symbols(f.args[0])}
    return _grouped(
        value, sorted(angles, key=lambda a: natural(str(min(map(str, a.free_symbols)))))
    )


def _grouped(value: sp.Expr, angles: Sequence[sp.Expr]) -> sp.Expr:
    if not value.is_Add or not angles:
        return value
    pair = sp.cos(angles[0]), sp.sin(angles[0])
    parts: dict[sp.Expr, list[sp.Expr]] = {}
    for term in value.args:
        found = [f for f in pair if f in sp.Mul.make_args(term)]
        factor = found[0] if len(found) == 1 else sp.S.One
        parts.setdefault(factor, []).append(term / factor)
    sums = {f: _grouped(sp.Add(*terms), angles[1:]) for f, terms in parts.items()}
    return sp.Add(*(s if f == 1 else _times(f, s) for f, s in sums.items()))


def _times(factor: sp.Expr, total: sp.Expr) -> sp.Expr:
    """A product; what divides the whole sum and the sign of most terms stand beside the factor."""
    if not total.is_Add:
        return factor * total
    if 2 * sum(t.as_coeff_Mul()[0].is_negative for t in total.args) > len(total.args):
        return -_times(factor, sp.Add(*(without_minus(-t) for t in total.args)))
    return factor * sp.factor_terms(total)


def _is_sum_of_symbols(angle: sp.Expr) -> bool:
    return all(t.is_Symbol for t in sp.Add.make_args(angle))


def without_minus(value: sp.Expr) -> sp.Expr:
    """``r*(b - a)`` for ``-r*(a - b)``."""
    number, rest = value.as_coeff_Mul()
    if not number.is_negative:
        return value
    for factor in sp.Mul.make_args(rest):
        negative = [t.as_coeff_Mul()[0].is_negative for t in factor.args] if factor.is_Add else []
        if any(negative):
            return sp.Mul(-number, rest / factor, -factor)
    return value
