"""How far rounding moves the hand of a planar linkage that is solved dyad by dyad.

Each bar of a dyad misses its length by a rounding error.  This moves the pin of the dyad, and what
depends on it.  So the hand moves by the sum of these errors, each times a factor.  The factors
follow from the hand, dyad by dyad in reverse: what the hand gains per motion of a pin gives what it
gains per error of both bars, and per motion of the points at which they are held.

All is times the determinants of the dyads that were passed, so nothing is divided by them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import sympy as sp

from closedform.lemmas.legs import cross_in_plane, turned_left
from closedform.loops.leg_by_leg import named
from closedform.loops.linkage import GROUND, Linkage
from closedform.model.functions import Program


@dataclass
class _Gains:
    """What one coordinate of the hand gains per motion of points, and per error of bars."""

    per_point: dict[str, sp.Matrix]
    per_bar: sp.Expr = field(default=sp.S.Zero)

    def add(self, point: str, gain: sp.Matrix) -> None:
        self.per_point[point] = self.per_point.get(point, sp.zeros(2, 1)) + gain


@dataclass(frozen=True)
class Bars:
    """Both bars of a dyad, from the points at which they are held to the pin, and their lengths."""

    spans: tuple[sp.Matrix, sp.Matrix]
    lengths: tuple[sp.Expr, sp.Expr]
    volume: sp.Expr
    """The determinant of the spans."""


def hand_error(
    m: Linkage,
    g: Program,
    points: Mapping[str, sp.Matrix],
    bars: Sequence[Bars],
    size: sp.Expr,
) -> sp.Expr:
    """By how much the hand moves more than bars miss, times the determinants of all dyads.

    ``bars`` are those of ``m.dyads``; a yaw or another angle counts times ``size``.
    """
    total = sp.S.Zero
    for i, gains in enumerate(_of_hand(m, points, size), 1):
        for k in reversed(range(len(m.dyads))):
            _pass(m, g, gains, (k, i), bars[k])
        total += gains.per_bar
    return total


def _of_hand(m: Linkage, points: Mapping[str, sp.Matrix], size: sp.Expr) -> list[_Gains]:
    """For each coordinate of the hand, what it gains per motion of the points of its body."""
    step = m.solved[-1]
    near, pin = step.near[0], step.pin
    found = []
    if m.at:
        found = [_Gains({m.at: sp.Matrix(e)}) for e in ((1, 0), (0, 1))]
    if m.follower or m.carrier:
        span = points[pin] - points[near]
        across = turned_left(span) * size / m.squared(m.follower or m.carrier, near, pin)
        found.append(_Gains({pin: across, near: -across}))
    return found


def _pass(m: Linkage, g: Program, gains: _Gains, index: tuple[int, int], bars: Bars) -> None:
    """Replace the gains per motion of the points of a dyad by those of what holds it."""
    k, i = index
    step = m.dyads[k]
    still = {p for body in (GROUND, *m.driven) for p in m.points[body]}
    for body, near in zip(step.bodies, step.near, strict=True):
        for point in m.points[body]:
            if point not in (near, step.pin) and point in gains.per_point:
                gain = gains.per_point.pop(point)
                turned = m.turn(body, near, step.pin, point).T * gain
                gains.add(step.pin, turned)
                gains.add(near, gain - turned)
    pin = gains.per_point.pop(step.pin, None)
    gains.per_bar *= sp.Abs(bars.volume)
    gains.per_point = {p: e * bars.volume for p, e in gains.per_point.items()}
    if pin is None:
        return
    pin = named(g, f"gain_{k + 1}{i}", pin)
    first, second = bars.spans
    shares = cross_in_plane(pin, second), cross_in_plane(first, pin)
    held = zip(shares, step.near, bars.spans, bars.lengths, strict=True)
    for j, (value, near, span, length) in enumerate(held, 1):
        share = g.let(f"share_{k + 1}{i}{j}", value)
        gains.per_bar += sp.Abs(share) * length
        if near not in still:
            gains.add(near, share * span)


__all__ = ["Bars", "hand_error"]
