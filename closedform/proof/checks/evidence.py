"""Helpers of the checks: exact entries, values at a point, and signs of constants."""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, TypeAlias

import sympy as sp
from sympy.core.relational import Relational

from closedform.algebra.balls import evaluate
from closedform.algebra.normal_form import Undecided, decide
from closedform.model.functions import reject_floats

Expr: TypeAlias = Any  # SymPy's annotations are partial
Exact: TypeAlias = Any  # an expression, a matrix or a sequence of them
Point: TypeAlias = Mapping[sp.Symbol, Expr]

_READABLE = 24
"""The longest exact value, in characters, that is not shown as a decimal."""


def entries(value: Exact) -> list[Expr]:
    """The expressions of a value; floats are refused."""
    many = isinstance(value, sp.MatrixBase | Sequence)
    found = [sp.sympify(e, strict=True) for e in (value if many else [value])]
    for e in found:
        reject_floats(e, "a claim")
    return found


def constant(value: Expr) -> Expr:
    (e,) = entries(value)
    if e.free_symbols:
        names = ", ".join(sorted(map(str, e.free_symbols)))
        raise ValueError(f"{e} is not a constant: it depends on {names}")
    return e


def difference(a: Exact, b: Exact) -> Exact:
    """``a - b``; a zero may stand for a matrix or a sequence of zeros."""
    if isinstance(a, sp.MatrixBase | Sequence) and isinstance(b, sp.Expr | int) and b == 0:
        b = sp.zeros(*a.shape) if isinstance(a, sp.MatrixBase) else [sp.S.Zero] * len(a)
    shape = getattr(a, "shape", None)
    if shape != getattr(b, "shape", None):
        raise ValueError(f"the two sides have different shapes: {a}, {b}")
    differences = [x - y for x, y in zip(entries(a), entries(b), strict=True)]
    if shape:
        return sp.Matrix(*shape, differences)
    return sp.Matrix(differences) if isinstance(a, Sequence) else differences[0]


def shown(e: Expr, point: Point) -> Expr | str:
    """The value at a point: exact if that is short, else six digits."""
    exact = sp.sympify(e, strict=True).subs(point)
    if not exact.free_symbols and exact.is_finite and len(str(exact)) <= _READABLE:
        return exact
    return f"${evaluate([e], point)[0].str(6, radius=False)}$"


def at(point: Point) -> tuple[Any, ...]:
    """The beginning of a sentence about a point; empty for constants."""
    return ("at ", dict(point), ": ") if point else ()


def denested(e: Expr) -> Expr:
    """Write roots of ``a + b sqrt(c)`` in this form too, if possible."""
    roots = [p for p in e.atoms(sp.Pow) if p.exp.is_Rational and not p.exp.is_Integer]
    plain = {p: sp.sqrtdenest(sp.sqrt(sp.expand(p.base))) ** (2 * p.exp) for p in roots}
    return e.xreplace(plain)


def sign(e: Expr) -> int:
    """The sign of a constant; zero only if the constant is proved to vanish."""
    e = constant(e)
    if e.is_Rational:
        return int(sp.sign(e))
    ball = evaluate([e], {})[0]
    if not ball.contains(0):
        return 1 if ball > 0 else -1
    if decide(denested(e)).holds:
        return 0
    raise Undecided(f"the sign of {e} cannot be decided")


def nearest(e: Expr) -> int:
    """The integer nearest to a constant; of two, the one farther from zero."""
    size = abs(e)
    floor = int(str(evaluate([size], {})[0].mid().floor().unique_fmpz()))
    below = floor if sign(size - floor) >= 0 else floor - 1
    up = sign(size - below - sp.Rational(1, 2)) >= 0
    return sign(e) * (below + up)


def fixed(n: int, digits: int) -> str:
    """``n / 10**digits`` as a decimal."""
    whole, part = divmod(abs(n), 10**digits)
    minus = "-" if n < 0 else ""
    return f"{minus}{whole}.{part:0{digits}d}" if digits else f"{minus}{whole}"


def cases(piecewise: Expr) -> Iterator[tuple[Expr, list[Expr]]]:
    """The value of each case of a piecewise function, and what is not negative there."""
    before: list[Expr] = []
    for value, condition in piecewise.args:
        holds = before if condition == sp.true else [*before, condition]
        yield value, [c.gts - c.lts for c in holds]
        if condition != sp.true:
            before.append(sp.Not(condition))


def holds(relation: Expr) -> bool:
    """Whether a relation between constants holds; SymPy may already have decided it."""
    if relation in (sp.true, sp.false):
        return bool(relation)
    if not isinstance(relation, Relational):
        raise TypeError(f"{relation} is neither an equation nor an inequality")
    return sign(relation.lhs - relation.rhs) in _SIGNS_OF[type(relation)]


_SIGNS_OF = {sp.Eq: (0,), sp.Ne: (-1, 1), sp.Gt: (1,), sp.Ge: (0, 1), sp.Lt: (-1,), sp.Le: (-1, 0)}
"""The signs of the difference of the sides for which a relation holds."""
