"""Expressions in several cases, which differ in the values of some symbols, such as signs.

An expression that contains none of these symbols, nor a name whose value does, is the same in all
cases.  So what the branches of an inverse have in common is compiled, and evaluated, once.
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import sympy as sp

Case = Mapping[sp.Symbol, int]


class Scope:
    """Says which expressions are the same in which cases."""

    def __init__(self, named: Mapping[sp.Symbol, Any], cases: Sequence[Case]) -> None:
        self._ruled: dict[Any, frozenset[Any]] = {s: frozenset([s]) for c in cases for s in c}
        self._case: Case = {}
        for name, value in named.items():
            self._ruled[name] = self._by(value)

    def enter(self, case: Case) -> None:
        self._case = case

    def key(self, e: Any) -> Hashable:
        """What an expression is in this case; the same for cases in which it is the same."""
        by = self._by(e)
        return (e, tuple(v for s, v in self._case.items() if s in by)) if by else e

    def _by(self, e: Any) -> frozenset[Any]:
        """The symbols that differ from case to case on which an expression depends."""
        if e not in self._ruled:
            self._ruled[e] = frozenset().union(*map(self._by, e.args))
        return self._ruled[e]


__all__ = ["Case", "Scope"]
