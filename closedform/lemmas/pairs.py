"""Lemmas that hand an angle on as its sine and cosine.

A joint after the first is found in a frame that the earlier joints have turned.  Only the sines
and cosines of these are needed for it; the angles themselves are taken once, for the output.  Every
pair is normalised by its own numbers, so that it lies on the unit circle to rounding even where a
bound was clamped, and what is built on it stays a rotation.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp

from closedform.lemmas.sine_cosine import nearly_tangent, root_in_reach
from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Pair:
    """The sine and the cosine of an angle."""

    s: sp.Expr
    c: sp.Expr

    def __add__(self, other: Pair) -> Pair:
        return Pair(self.s * other.c + self.c * other.s, self.c * other.c - self.s * other.s)

    def __neg__(self) -> Pair:
        return Pair(-self.s, self.c)

    def __sub__(self, other: Pair) -> Pair:
        return self + -other

    @property
    def angle(self) -> sp.Expr:
        return sp.atan2(self.s, self.c)

    def known_as(self, program: Program, label: str) -> Pair:
        """The same pair, named ``s<label>`` and ``c<label>`` in the program."""
        return Pair(program.let(f"s{label}", self.s), program.let(f"c{label}", self.c))


def direction(y: sp.Expr, x: sp.Expr, length: sp.Expr, undefined: sp.Basic = sp.false) -> Pair:
    """The pair of ``atan2(y, x)`` for a vector of the given length; zero where it is undefined."""
    return Pair(choose(undefined, 0, y / length), choose(undefined, 1, x / length))


def amplitude_lemma(x: sp.Symbol, a: sp.Expr, b: sp.Expr, c: sp.Expr, pair: Pair) -> Lemma:
    """``a sin x + b cos x = c``, solved by a pair that was built for either sign."""
    return Lemma(
        "a sin x + b cos x = c",
        r"a\sin x + b\cos x = c \;\Rightarrow\; x = \operatorname{atan2}(a, b) + \sigma\delta,\ "
        r"(\cos\delta, \sin\delta) = \frac{(c, \sqrt{(h - c)(h + c)})}{h},\ h = \sqrt{a^2+b^2}",
        (a * sp.sin(x) + b * sp.cos(x) - c,),
        {x: pair.angle},
        2,
    )


@dataclass(frozen=True)
class LinksAtHeight:
    """Two links that have to reach a point at a ``height``, whose other coordinate a turn gives.

    That is the root of the turn.  Where the root is small, rounding changes it by a multiple, and
    links much shorter than the amplitude might seem too short.
    """

    l1: sp.Expr
    l2: sp.Expr
    height: sp.Expr

    def reached(
        self,
        program: Program,
        bounds: tuple[sp.Expr, sp.Expr],
        of_turn: tuple[sp.Expr, sp.Expr],
        amplitude: sp.Expr,
        scale: sp.Expr,
        suffix: str,
    ) -> tuple[sp.Expr, sp.Expr]:
        """The root and the width of a turn; of the roots that rounding allows one within reach."""
        (below, above), (root, width) = bounds, of_turn
        tangent = nearly_tangent(program, root, amplitude, suffix)
        links = self.l1, self.l2, self.height
        held = root_in_reach(program, below * above, amplitude, scale, *links, suffix=suffix)
        whole = sp.sqrt(4 * held + (above - below) ** 2)
        return (
            program.let(f"kept{suffix}", choose(tangent, sp.sqrt(held), root), nonnegative=True),
            program.let(f"span{suffix}", choose(tangent, whole, width), nonnegative=True),
        )
