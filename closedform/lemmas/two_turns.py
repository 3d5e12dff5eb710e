"""An elbow near a tangent, before two turns that bring its end to the target."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.pairs import direction
from closedform.lemmas.tangent import CoordinateWithin, Goal, Reached, Tangency
from closedform.model.functions import Program, sign_of
from closedform.model.pair import Pair


@dataclass(frozen=True)
class TwoTurns(Goal):
    """Two turns, about axes that meet, that bring a vector to this one.

    The ``vector`` is linear in the pair of an earlier turn: x across the second axis, z along it.
    The other vector, equally long, is ``along`` and ``across`` the first axis.  The axes meet at
    the angle with the cosine c = ``tilt`` and the sine s.  So there are such turns if
    ``|z - c along| <= s across``, or if ``s |x| >= |along - c z|``, which says the same.  What is
    asked for is that about the shorter one of ``across`` and x, which says more.
    """

    vector: Callable[[Pair], sp.Matrix]
    along: sp.Expr
    across: sp.Expr
    tilt: sp.Expr = sp.S.Zero

    def reached(self, turn: Tangency) -> Reached:
        """The pair of the turn, changed by no more than rounding where it is tangent."""
        if self.tilt != 0:
            return self._oblique(turn).reached(turn)
        along, size = sp.Abs(self.along), turn.chain.size

        def shorter(x: sp.Expr, z: sp.Expr) -> sp.Expr:
            return sp.Piecewise((x, along < self.across), (z, True))

        def value(pair: Pair) -> sp.Expr:
            v = self.vector(pair)
            return shorter(v[0], v[2])

        most, least = shorter(size, self.across), shorter(along, sp.S.Zero)
        return CoordinateWithin(value, most, least).reached(turn)

    def _oblique(self, turn: Tangency) -> CoordinateWithin:
        """The same where the axes are not at a right angle: what exceeds the least x is linear."""
        let, size, sine = turn.chain.program.let, turn.chain.size, sp.sqrt(1 - self.tilt**2)
        here = self.vector(turn.pair(turn.root, turn.width))
        x = let(f"across_2{turn.suffix}", here[0])
        height = let(f"height_2{turn.suffix}", self.along - self.tilt * here[2])
        far = 2 * size  # makes the excess positive

        def shorter(x_: sp.Expr, z_: sp.Expr) -> sp.Expr:
            return sp.Piecewise((x_, sp.Abs(x) < self.across), (z_, True))

        def value(pair: Pair) -> sp.Expr:
            v = self.vector(pair)
            left = self.along - self.tilt * v[2]
            excess = sine * sign_of(x) * v[0] - sign_of(height) * left
            return shorter(excess + far, v[2] - self.tilt * self.along)

        most, least = shorter(4 * far, sine * self.across), shorter(far, sp.S.Zero)
        return CoordinateWithin(value, most, least)

    def anywhere(self, program: Program, suffix: str) -> Pair:
        """The pair of a turn that is free: one that brings z to the middle of its range."""
        s, c = sp.Dummy("s"), sp.Dummy("c")
        z = self.vector(Pair(s, c))[2]
        y, x = (program.let(f"level_{n}{suffix}", z.diff(e)) for n, e in (("s", s), ("c", c)))
        length = program.let(f"level{suffix}", sp.sqrt(x**2 + y**2), nonnegative=True)
        return direction(-x, y, length, sp.Eq(length, 0))


__all__ = ["TwoTurns"]
