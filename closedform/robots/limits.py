"""Limits of joints, and the turn of each joint that is nearest to a seed within them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from closedform.robots.mechanism import TURN, Array, Mechanism

SLACK = 1e-9
"""How far a joint may pass a limit: radians, or this share of the limit of a slide.  It covers the
rounding of a target that was computed from joints at their limits."""

HALFWAY = 1e-9
"""In turns: a seed this close to the middle of two turns is equally far from both."""


class Limits(NamedTuple):
    """The least and the largest value of each joint; infinite if there is none."""

    lower: Array
    upper: Array

    @classmethod
    def of(cls, mechanism: Mechanism, given: Any) -> Limits:
        """Limits from a pair (lower, upper), as an array of shape (2, joints) is; None: without."""
        n = len(mechanism.joints)
        if given is None:
            return cls(np.full(n, -np.inf), np.full(n, np.inf))
        if len(given) != 2:
            raise ValueError("limits must be a pair: the lower and the upper limits of all joints")
        lower, upper = (mechanism.as_joints(side, "limits") for side in given)
        if not (lower <= upper).all():
            raise ValueError("limits: a lower limit is larger than the upper one")
        return cls(lower, upper)

    @property
    def slack(self) -> Array:
        """How far each joint may pass its limits; as for angles if they are near zero."""
        sizes = np.maximum(np.abs(self.lower), np.abs(self.upper))
        return SLACK * np.where(np.isfinite(sizes), np.maximum(sizes, 1e-3), 1.0)

    def at(self, axes: int) -> Limits:
        """The same with axes of length 1 before the last one, such as that of the branches."""
        fill = (..., *[None] * axes, slice(None))
        return Limits(self.lower[fill], self.upper[fill])

    def exceeded(self, q: Array) -> NDArray[np.bool_]:
        """Which joints of exactly these values are beyond their limits."""
        slack = self.slack
        return np.asarray((q < self.lower - slack) | (q > self.upper + slack))


def nearest_turn(
    mechanism: Mechanism, q: Array, seed: Array, limits: Limits
) -> tuple[Array, NDArray[np.bool_]]:
    """Each joint moved by whole turns to where it is nearest to the seed within its limits.

    Of two turns at the same distance the lower one is taken.  Also returns which joints have no
    turn within their limits; these are not moved.
    """
    with np.errstate(invalid="ignore"):
        turns = np.ceil((seed - q) * (1 / TURN) - (0.5 + HALFWAY))
        if not (np.isfinite(limits.lower).any() or np.isfinite(limits.upper).any()):
            turns *= mechanism.revolute
            return np.where(turns != 0, q + TURN * turns, q), np.zeros(q.shape, bool)
        slack = limits.slack
        first = np.ceil((limits.lower - slack - q) / TURN)
        last = np.floor((limits.upper + slack - q) / TURN)
        turns = np.minimum(np.maximum(turns, first), last)
        outside = np.where(mechanism.revolute, first > last, limits.exceeded(q))
        moves = mechanism.revolute & ~outside & np.isfinite(turns) & (turns != 0)
        return np.where(moves, q + TURN * np.where(moves, turns, 0.0), q), outside
