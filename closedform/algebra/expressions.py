"""What the exact algebra reads from expressions: entries, subexpressions, angles and signs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import lcm
from typing import Any, TypeAlias

import sympy as sp
from sympy import Rational

Expr: TypeAlias = Any  # SymPy's annotations are partial
Problem: TypeAlias = "Expr | sp.MatrixBase | Sequence[Expr]"

QUOTIENTS: dict[type, Callable[[Expr], Expr]] = {
    sp.tan: lambda angle: sp.sin(angle) / sp.cos(angle),
    sp.cot: lambda angle: sp.cos(angle) / sp.sin(angle),
    sp.sec: lambda angle: 1 / sp.cos(angle),
    sp.csc: lambda angle: 1 / sp.sin(angle),
}
TRIGONOMETRIC = (sp.sin, sp.cos, *QUOTIENTS)


class InexactNumberError(TypeError):
    """An expression that must be exact contains a float."""


def sign_of(e: Expr) -> int:
    """1 or -1 if the assumptions on an expression say that it is not negative or not positive."""
    return 1 if e.is_nonnegative else -1 if e.is_nonpositive else 0


def margin_of(g: Expr) -> Expr:
    """What a condition says is not negative; an expression stands for itself."""
    if isinstance(g, (sp.Ge, sp.Gt)):
        return g.lhs - g.rhs
    return g.rhs - g.lhs if isinstance(g, (sp.Le, sp.Lt)) else g


def entries_of(problem: Problem) -> list[Expr]:
    entries: list[Expr] = sp.Matrix([problem]).flat()
    return entries


def subexpressions(problem: Sequence[Expr]) -> list[Expr]:
    """Every distinct sub-expression once; raises if one is a float."""
    found: dict[Expr, None] = {}
    stack = list(reversed(problem))
    while stack:
        e = stack.pop()
        if e.is_Float:
            raise InexactNumberError(f"the float {e} in an exact expression; write a Rational")
        if e not in found:
            found[e] = None
            stack.extend(reversed(e.args))
    return list(found)


def linear_root(e: Expr, x: Expr) -> Expr:
    """The x at which a linear expression vanishes; ``sp.solve`` loads half a second of modules."""
    return sp.expand(-e.xreplace({x: sp.S.Zero}) / e.diff(x))


class Derivatives:
    """Derivatives by one symbol; each part of the expressions is differentiated once.

    SymPy differentiates every factor of every product, also those without the symbol.
    """

    def __init__(self, x: Expr):
        self.x = x
        self.known: dict[Expr, Expr] = {x: sp.S.One}

    def of(self, e: Expr) -> Expr:
        if e not in self.known:
            self.known[e] = self._derived(e) if e.has_free(self.x) else sp.S.Zero
        return self.known[e]

    def _derived(self, e: Expr) -> Expr:
        if e.is_Add:
            return sp.Add(*map(self.of, e.args))
        if e.is_Mul:
            rates = [(k, rate) for k, rate in enumerate(map(self.of, e.args)) if rate != 0]
            return sp.Add(*(sp.Mul(rate, *e.args[:k], *e.args[k + 1 :]) for k, rate in rates))
        if e.is_Pow and e.exp.is_Rational:
            return e.exp * e.base ** (e.exp - 1) * self.of(e.base)
        if isinstance(e, sp.sin):
            return sp.cos(e.args[0]) * self.of(e.args[0])
        if isinstance(e, sp.cos):
            return -sp.sin(e.args[0]) * self.of(e.args[0])
        return e.diff(self.x)


def angle_terms(angle: Expr) -> dict[Expr, Rational]:
    """An angle as a rational combination of atoms."""
    terms = angle.as_coefficients_dict()
    if any(atom.is_Add or atom.is_Mul or atom.is_Pow for atom in terms):
        terms = sp.expand(angle).as_coefficients_dict()
    return {atom: q for atom, q in terms.items() if q}


def angle_divisors(problem: Sequence[Expr]) -> dict[Expr, int]:
    """For each atom of an angle, the common denominator of its multiples."""
    divisors: dict[Expr, int] = {}
    for e in subexpressions(problem):
        if isinstance(e, TRIGONOMETRIC):
            for atom, q in angle_terms(e.args[0]).items():
                divisors[atom] = lcm(divisors.get(atom, 1), int(q.q))
    return divisors


def square_roots(e: Expr) -> int:
    """How many square roots of its base a power takes; SymPy writes roots of roots as one power."""
    roots = int(e.exp.q).bit_length() - 1 if e.exp.is_Rational else 0
    if not e.exp.is_Rational or e.exp.q != 2**roots:
        raise TypeError(f"cannot evaluate the power {e}")
    return roots


def shortened(e: object, length: int = 200) -> str:
    text = str(e)
    return text if len(text) <= length else f"{text[:length]}... ({len(text)} characters)"
