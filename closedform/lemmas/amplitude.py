"""The equation ``a sin x + b cos x = c``: its bounds and its two solutions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy as sp

from closedform.model.functions import Program
from closedform.model.lemma import Lemma, Shape
from closedform.model.pair import Pair


@dataclass(frozen=True)
class Amplitude:
    """``a sin x + b cos x = c``, or ``cos(x - atan2(a, b)) = c / h`` with ``h = sqrt(a^2 + b^2)``.

    Half the angle ``x - atan2(a, b)`` has the tangent ``sqrt(h - c) / sqrt(h + c)``.  There are two
    solutions, by ``sigma``, where both roots are real.
    """

    x: sp.Symbol
    a: sp.Expr
    b: sp.Expr
    c: sp.Expr
    sigma: sp.Symbol
    h: sp.Symbol
    below: sp.Symbol
    above: sp.Symbol

    @classmethod
    def of(
        cls,
        program: Program,
        x: sp.Symbol,
        coefficients: tuple[sp.Expr, sp.Expr, sp.Expr],
        sigma: sp.Symbol,
        *,
        scale: Callable[[sp.Symbol], sp.Expr] = lambda h: h,
        suffix: str = "",
    ) -> Amplitude:
        """The equation with the coefficients a, b and c.

        Parameters
        ----------
        program
            the program that the names and bounds are added to
        x
            the angle
        coefficients
            a, b and c
        sigma
            the sign of the root
        scale
            maps h to the scale of the error that is allowed in c; by default it is h itself
        suffix
            what the names end in
        """
        a, b, c = coefficients
        h = program.let(f"h{suffix}", sp.sqrt(a**2 + b**2), nonnegative=True)
        if c == 0:  # both solutions exist for every h
            return cls(x, a, b, c, sigma, h, h, h)
        size = scale(h)
        below = program.bound(f"below{suffix}", h - c, size, "the amplitude is not smaller than c")
        above = program.bound(f"above{suffix}", h + c, size, "the amplitude is not smaller than -c")
        return cls(x, a, b, c, sigma, h, below, above)

    @property
    def root(self) -> sp.Expr:
        """The size of ``b sin x - a cos x``, which has the sign of sigma."""
        return sp.sqrt(self.below) * sp.sqrt(self.above)

    @property
    def half_turn(self) -> sp.Expr:
        """The angle ``x - atan2(a, b)``, without its sign."""
        return 2 * sp.atan2(sp.sqrt(self.below), sp.sqrt(self.above))

    def pair(self, root: sp.Expr, width: sp.Expr) -> Pair:
        """The pair of x, from names for the root and for ``2 h``."""
        if self.c == 0:
            return Pair(self.b * self.sigma / self.h, -self.a * self.sigma / self.h)
        away = Pair(2 * self.sigma * root / width, (self.above - self.below) / width)
        return Pair(self.a / self.h, self.b / self.h) + away

    def lemma(self, angle: sp.Expr, how: str) -> Lemma:
        """The lemma, with the closed form of x and LaTeX for how it is computed."""
        return Lemma(
            "a sin x + b cos x = c",
            rf"a\sin x + b\cos x = c \;\Rightarrow\; x = \operatorname{{atan2}}(a, b) + {how}",
            (self.a * sp.sin(self.x) + self.b * sp.cos(self.x) - self.c,),
            {self.x: angle},
            2,
            signs=(self.sigma,),
            shape=Shape.LINEAR,
            roles=(("x", self.x), ("a", self.a), ("b", self.b), ("c", self.c)),
        )


def nearly_tangent(program: Program, lever: sp.Expr, scale: sp.Expr, suffix: str = "") -> sp.Symbol:
    """A flag for a joint whose ``lever`` is so short that rounding may decide what is within reach.

    It is true if the lever is less than 2^-8 of the ``scale``.  With a longer lever, the tolerance
    of the reach covers the rounding.
    """
    return program.vanishes(
        f"tangent{suffix}", lever - scale / 2**8, scale, "both solutions nearly coincide"
    )
