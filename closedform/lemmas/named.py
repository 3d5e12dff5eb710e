"""Values and vectors under names of a program."""

from __future__ import annotations

import sympy as sp

from closedform.model.functions import Program


def named_in(p: Program, name: str, value: sp.Expr) -> sp.Symbol:
    return value if value.is_Symbol or value.is_number else p.let(name, value)


def named(p: Program, name: str, place: sp.Matrix) -> sp.Matrix:
    """A vector, with its coordinates under names."""
    return sp.Matrix([named_in(p, f"{name}_{i}", e) for i, e in zip("xyz", place, strict=False)])


__all__ = ["named", "named_in"]
