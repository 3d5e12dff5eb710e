"""An angle as its sine and its cosine."""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.model.functions import Program


@dataclass(frozen=True)
class Pair:
    """The sine and the cosine of an angle, in the order in which ``atan2`` takes them."""

    s: sp.Expr
    c: sp.Expr

    @classmethod
    def of(cls, angle: sp.Expr) -> Pair:
        """The pair of an angle."""
        return cls(sp.sin(angle), sp.cos(angle))

    def __add__(self, other: Pair) -> Pair:
        return Pair(self.s * other.c + self.c * other.s, self.c * other.c - self.s * other.s)

    def __neg__(self) -> Pair:
        return Pair(-self.s, self.c)

    def __sub__(self, other: Pair) -> Pair:
        return self + -other

    @property
    def angle(self) -> sp.Expr:
        return sp.atan2(self.s, self.c)

    @property
    def unit(self) -> sp.Matrix:
        """The unit vector at the angle, ``(cos, sin)``."""
        return sp.Matrix([self.c, self.s])

    def known_as(self, program: Program, label: str) -> Pair:
        """The same pair under the names ``s<label>`` and ``c<label>`` in the program."""
        return Pair(program.let(f"s{label}", self.s), program.let(f"c{label}", self.c))


__all__ = ["Pair"]
