"""A constant that generated code takes by its name, as its value depends on the type of numbers."""

from __future__ import annotations

from typing import Any

import sympy as sp


class Constant(sp.AtomicExpr):  # type: ignore[misc]  # SymPy has no annotations
    """A positive constant with a ``name`` and its ``value`` in double precision."""

    is_real = is_positive = is_commutative = True
    name: str
    value: sp.Rational

    def __new__(cls, name: str, value: sp.Rational) -> Constant:
        found: Constant = super().__new__(cls)
        found.name, found.value = name, value
        return found

    def __getnewargs__(self) -> tuple[str, sp.Rational]:
        return self.name, self.value

    def _hashable_content(self) -> tuple[str, sp.Rational]:
        return self.name, self.value

    def _sympystr(self, printer: Any) -> str:
        return self.name


__all__ = ["Constant"]
