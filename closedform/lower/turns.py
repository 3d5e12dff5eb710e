"""Finds the outputs that are angles, and writes them so that their size is known.

An output is an angle if it is a revolute joint of an inverse, or if it, or a name from which it is
computed, contains an arctangent.  An angle of the input may have any size; in a sum it is therefore
computed from its sine and cosine.  :mod:`closedform.lower.ranges` then decides from the nodes which
wrap an angle needs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Function, Let

Expr = Any


@dataclass(frozen=True)
class Turns:
    """The angles among the outputs of one function."""

    function: Function
    lets: Mapping[Expr, Expr]
    joints: frozenset[int]
    """The indices of the entries of all outputs that are revolute joints of an inverse."""

    @classmethod
    def of(cls, function: Function, derivation: Derivation) -> Turns:
        revolute = {j.symbol for j in derivation.joints if j.kind == "revolute"}
        unknowns = [i.unknowns for i in derivation.inverses if i.function == function.name]
        return cls(
            function,
            {s.symbol: s.value for s in function.body if isinstance(s, Let)},
            frozenset(k for row in unknowns for k, u in enumerate(row) if u in revolute),
        )

    def entries(self) -> list[tuple[Expr, bool]]:
        """The outputs, and whether they are angles; angles are written so that bounds are known."""
        flat = [e for output in self.function.outputs for e in output.entries]
        angles = [k in self.joints or self._is_angle(e) for k, e in enumerate(flat)]
        return [(self._read(e) if a else e, a) for e, a in zip(flat, angles, strict=True)]

    def _is_angle(self, e: Expr) -> bool:
        """Whether a term is an arctangent, possibly times numbers and signs (but not lengths)."""
        if e in self.lets:
            return self._is_angle(self.lets[e])
        if isinstance(e, sp.Mul):
            others = [a for a in e.args if not self._is_number(a)]
            return len(others) == 1 and self._is_angle(others[0])
        if isinstance(e, sp.Piecewise):
            return any(self._is_angle(value) for value, _ in e.args)
        if isinstance(e, sp.Add | sp.Abs | sp.Max | sp.Min):
            return any(map(self._is_angle, e.args))
        return isinstance(e, sp.atan2 | sp.atan)

    def _is_number(self, e: Expr) -> bool:
        """Whether this is a number, a sign of the branch, or a computed sign."""
        if isinstance(e, sp.Piecewise):
            return all(self._is_number(value) for value, _ in e.args)
        signs = {s for _, chosen in self.function.cases() for s in chosen}
        return self._is_number(self.lets[e]) if e in self.lets else bool(e.free_symbols <= signs)

    def _read(self, e: Expr) -> Expr:
        """The same angle up to whole turns, with all input angles in one arctangent."""
        if isinstance(e, sp.Piecewise):
            return sp.Piecewise(*((self._read(value), c) for value, c in e.args))
        terms = list(sp.Add.make_args(e))
        wide: list[Expr] = []
        kept: list[Expr] = []
        while terms:
            term = terms.pop(0)
            factor, rest = term.as_coeff_Mul()
            if rest in self.lets and self._holds_input(rest):
                terms += [factor * a for a in sp.Add.make_args(self.lets[rest])]
            else:
                (wide if rest in self.function.symbols else kept).append(term)
        if not wide:
            return e
        total = sp.Add(*wide)
        return sp.Add(sp.atan2(sp.sin(total), sp.cos(total)), *kept)

    def _holds_input(self, e: Expr) -> bool:
        """Whether a term of a sum is a coordinate of the input, also by names of the body."""
        if e in self.lets:
            parts = sp.Add.make_args(self.lets[e])
            return any(self._holds_input(a.as_coeff_Mul()[1]) for a in parts)
        return e in self.function.symbols


__all__ = ["Turns"]
