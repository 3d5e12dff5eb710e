"""Derivatives of printed kernels for any array library, by differences of balls.

A kernel is evaluated on single balls of 600 bits, and a central difference over 2**-140 is its
derivative to more digits than a double has.  Nothing is differentiated, so nothing of the rules for
derivatives is shared with an array library.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import flint
from closedform.generated.array import _runtime
from flint import arb

BITS = 600
STEP = 2.0**-140


class Balls(_runtime.Operations):
    """The operations of a kernel on balls, conditions being known.

    No turns are taken from angles, because derivatives do not see them.
    """

    def __init__(self) -> None:
        super().__init__(self, None, None)

    float32 = "float32"

    def number(self, value: Any) -> arb:
        return value if isinstance(value, arb) else arb(value)

    def sin(self, angle: Any) -> arb:
        return self.number(angle).sin()

    def cos(self, angle: Any) -> arb:
        return self.number(angle).cos()

    def abs(self, x: Any) -> arb:
        return abs(self.number(x)).mid()

    def max(self, a: Any, b: Any) -> arb:
        a, b = self.number(a).mid(), self.number(b).mid()
        return a if a > b else b

    def min(self, a: Any, b: Any) -> arb:
        a, b = self.number(a).mid(), self.number(b).mid()
        return a if a < b else b

    def finite(self, *values: Any) -> bool:
        return all(self.number(v).is_finite() for v in values)

    def truth(self, value: bool) -> bool:
        return value

    def opposite(self, condition: bool) -> bool:
        return not condition

    def select(self, condition: bool, a: Any, b: Any) -> arb:
        return self.number(a) if condition else self.number(b)

    def sqrt(self, x: Any) -> arb:
        return self.number(x).mid().sqrt()

    def atan2(self, y: Any, x: Any) -> arb:
        return arb.atan2(self.number(y).mid(), self.number(x).mid())

    def principal(self, angle: Any) -> arb:
        return self.number(angle)

    wrap = wrap_cut = principal

    def status(self, invalid: bool, unreachable: bool, singular: bool) -> int:
        return 3 if invalid else 1 if unreachable else 2 if singular else 0


def along(kernel: Any, planes: Sequence[float], direction: Sequence[float]) -> list[float]:
    """The derivatives of all results along a direction of all inputs; 0 for a constant."""
    bits, flint.ctx.prec = flint.ctx.prec, BITS
    try:
        ends = [
            kernel.compute(
                Balls(),
                *(arb(p) + arb(sign * STEP) * d for p, d in zip(planes, direction, strict=True)),
            )
            for sign in (1.0, -1.0)
        ]
        return [
            float(_turned(a - b).mid() / (2 * STEP)) if isinstance(a, arb) else 0.0
            for a, b in zip(*ends, strict=True)
        ]
    finally:
        flint.ctx.prec = bits


def _turned(difference: arb) -> arb:
    """The difference of two angles on either side of a cut, without the turn."""
    turn = 2 * arb.pi()
    return difference - (difference / turn + 0.5).mid().floor() * turn
