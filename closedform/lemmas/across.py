"""Turns before a slide: what is normal to it of a point is left to a link of constant length.

See :mod:`closedform.lemmas.tangent`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.tangent import CoordinateWithin, Nearest, Turn
from closedform.model.pair import Pair

STEPS = 3
"""The number of steps that improve a turn; the error after a step is of the order of its square."""


@dataclass(frozen=True)
class LinkAcross(Nearest):
    """A link of some ``length`` that has to reach a ``point`` less ``beside``, across a slide.

    ``normal`` is the unit vector across the slide; it and the point are linear in the pair.
    """

    point: Callable[[Pair], sp.Matrix]
    normal: Callable[[Pair], sp.Matrix]
    length: sp.Expr
    beside: sp.Expr = sp.S.Zero

    def nearest(self, turn: Turn) -> Pair:
        """The pair of the turn, changed by no more than rounding, with the point within reach."""
        for k in range(STEPS):
            goal = CoordinateWithin(self._linear(turn.pair), self.length)
            turn = turn.renamed(goal.nearest(turn), f"{turn.name}_{k}")
        return turn.pair

    def _linear(self, at: Pair) -> Callable[[Pair], sp.Expr]:
        """How far the point is across, by its rate at a pair."""
        q, n = self.point(at), self.normal(at)

        def value(pair: Pair) -> sp.Expr:
            both = q.dot(self.normal(pair)) + n.dot(self.point(pair))
            return sp.sympify(both - q.dot(n) - self.beside, strict=True)

        return value


__all__ = ["LinkAcross"]
