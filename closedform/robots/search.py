"""What a search for a posture takes into account, besides the target and the seed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.robots.limits import Limits
from closedform.robots.mechanism import Array, Mechanism


@dataclass(frozen=True)
class Search:
    """Where postures of a mechanism are sought, and how their distances are measured."""

    mechanism: Mechanism
    limits: Limits
    weights: Array
    """Those of the squares in the distance from a seed, one for each joint."""
    given: ArrayLike | None = None
    """What the inverse needs besides the target; None: its value at the seed, if it needs any."""

    @classmethod
    def of(
        cls, mechanism: Mechanism, limits: Limits, weights: Any, given: ArrayLike | None
    ) -> Search:
        """The search with weights of 1 if none are given; raises ValueError if they are wrong."""
        n = len(mechanism.joints)
        if weights is None:
            return cls(mechanism, limits, np.ones(n), given)
        weighed = np.asarray(weights, dtype=float)
        if weighed.shape[-1:] != (n,) or not (weighed >= 0).all():
            raise ValueError(
                f"weights must be {n} numbers that are not negative, one for each joint"
            )
        return cls(mechanism, limits, weighed, given)

    def at_seed(self, seed: Array) -> Search:
        """The same; what is given besides the target is by default its value at the seed."""
        if self.given is None and self.mechanism.given is not None:
            return replace(self, given=self.mechanism.given_at(seed))
        return self
