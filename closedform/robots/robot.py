"""A robot: a generated module with dimensions, limits, base, tool and the maker's joint zero."""

from __future__ import annotations

from enum import Enum
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots import frames, nearest, track, velocity
from closedform.robots.limits import Limits, nearest_turn
from closedform.robots.mechanism import Array, Mechanism
from closedform.robots.nearest import Nearest
from closedform.robots.search import Search
from closedform.robots.track import Path
from closedform.robots.velocity import Rates


class Default(Enum):
    """What is taken if an argument is left out, with a name that ``help`` can show."""

    STORED_LIMITS = "stored limits"

    def __repr__(self) -> str:
        return self.value


class Robot(Mechanism):
    """The functions of a generated module, bound to one robot.

    Parameters
    ----------
    module : a generated module, such as ``closedform.ur_arm`` or its compiled form
    parameters : the dimensions, as ``module.Parameters`` or a dictionary; default: the module's
    limits : (lower, upper), each of all joints, or None; default: ``LIMITS`` of the module, if it
        has any and the joints are those of the model
    base : the pose of the mechanism in the world, 4x4 (or 3x3, or a position)
    tool : the pose of the tool in the frame of the hand
    signs, offsets : joints of the model are ``signs * q + offsets``, with the maker's ``q``
    coupling : integer matrix in place of ones on the diagonal, for motors that move several joints
    label : a name to print

    All angles are in radians.  Joint values beyond four turns raise ValueError, because they are
    likely to be degrees.
    """

    def __init__(
        self,
        module: ModuleType,
        parameters: Any = None,
        *,
        limits: Any = Default.STORED_LIMITS,
        base: ArrayLike | None = None,
        tool: ArrayLike | None = None,
        signs: ArrayLike | None = None,
        offsets: ArrayLike | None = None,
        coupling: ArrayLike | None = None,
        label: str = "",
    ):
        super().__init__(
            module,
            parameters,
            base=base,
            tool=tool,
            signs=signs,
            offsets=offsets,
            coupling=coupling,
        )
        if limits is Default.STORED_LIMITS:
            limits = getattr(module, "LIMITS", None) if self._zero is None else None
        self.limits = Limits.of(self, limits)
        self.label = label or self.name
        self._options = {"signs": signs, "offsets": offsets, "coupling": coupling, "label": label}

    def __repr__(self) -> str:
        of = "" if self.label == self.name else f" of the family {self.name}"
        return f"<Robot {self.label}{of}, {len(self.joints)} joints>"

    def replace(self, **changes: Any) -> Robot:
        """The same robot with another tool, base, limits, parameters, ..."""
        given = {
            "parameters": self.parameters,
            "limits": self.limits,
            "base": self.base,
            "tool": self.tool,
            **self._options,
        }
        return Robot(self.module, **{**given, **changes})

    # Positions

    def nearest(
        self,
        x: ArrayLike,
        q_seed: ArrayLike,
        *,
        weights: ArrayLike | None = None,
        limits: Any = Default.STORED_LIMITS,
        given: ArrayLike | None = None,
    ) -> Nearest:
        """Of all branches and turns within the limits, the posture nearest to a seed.

        The distance is ``sqrt(sum(weights * (q - q_seed)**2))``.  Leading axes of ``x``, ``q_seed``
        and the dimensions broadcast.  Of branches at the same distance the first is taken, and of
        two turns the lower angle.  Where a joint is free (SINGULAR), it keeps the value of the
        seed, as far as its limits allow, and the other joints reach ``x`` with it.

        An arm of seven joints keeps the arm angle, or the joint, that its inverse needs beside the
        target, at its value in the seed; ``given`` is another value, and broadcasts too.
        """
        return nearest.nearest(Search.of(self, self._limits(limits), weights, given), x, q_seed)

    def track(
        self,
        xs: ArrayLike,
        q0: ArrayLike,
        *,
        weights: ArrayLike | None = None,
        limits: Any = Default.STORED_LIMITS,
        max_step: ArrayLike | None = None,
        given: ArrayLike | None = None,
    ) -> Path:
        """The joints along the path ``xs``, from the posture nearest to ``q0``.

        The branch is kept until it ends, leaves the limits, or would jump; then the nearest posture
        is taken.  A free joint keeps its value.  The result says where the branch changes and where
        a joint jumps.

        Parameters
        ----------
        xs
            the targets, along the first axis
        q0
            the joints before the path
        weights
            those of the joints in the distance, as of ``nearest``
        limits
            a pair (lower, upper), or None; by default those of the robot
        max_step
            the largest step of a joint between two points that is not a jump, by default 0.5 rad
            for an angle, and without a bound for a slide
        given
            as of ``nearest``: one value, by default that of ``q0``, or one for each point
        """
        search = Search.of(self, self._limits(limits), weights, given)
        return track.track(search, xs, q0, max_step)

    def outside(self, q: ArrayLike, limits: Any = Default.STORED_LIMITS) -> NDArray[np.bool_]:
        """Which joints of ``q``, of any leading axes, have no turn within their limits."""
        values = self.as_joints(q)
        return nearest_turn(self, values, values, self._limits(limits))[1]

    def _limits(self, given: Any) -> Limits:
        return self.limits if given is Default.STORED_LIMITS else Limits.of(self, given)

    def frames(self, q: ArrayLike) -> Array:
        """The frames of the base, of each link and of the tool, (..., joints + 2, 4, 4).

        The frame of a link is at its joint, with z along the axis of the joint, and moves with the
        link.  Raises ValueError if the mechanism is not a serial chain.
        """
        return frames.frames(self, q)

    # Velocities and forces

    def twist(self, q: ArrayLike, qdot: ArrayLike, frame: str = "tip") -> Array:
        """The twist (v; omega) of the tool at joint rates.

        ``frame="tip"``: v is the velocity of the origin of the tool, in the axes of the world;
        ``"space"``: v is that of the point at the origin of the world; ``"body"``: in the frame of
        the tool.
        """
        return velocity.twist(self, q, qdot, frame)

    def joint_torques(self, q: ArrayLike, wrench: ArrayLike, frame: str = "tip") -> Array:
        """The joint torques with which the tool exerts a wrench (f; m), in the frames of twist.

        Of a mechanism without a twist, ``wrench`` holds the forces along its task coordinates.
        """
        return velocity.joint_torques(self, q, wrench, frame)

    def manipulability(self, q: ArrayLike, axes: str = "all") -> Array:
        """Yoshikawa's measure of the Jacobian; ``axes`` "all", "trans" or "rot"."""
        return velocity.manipulability(self, q, axes)

    def condition(self, q: ArrayLike, axes: str = "all") -> Array:
        """The condition number of the Jacobian; infinite at a singularity."""
        return velocity.condition(self, q, axes)

    def joint_rates(self, q: ArrayLike, rate: ArrayLike, damping: ArrayLike = 0.0) -> Rates:
        """Joint rates for a twist of the tip, or for rates of the task if it is not a pose.

        Exact and shortest without damping, also at a singularity, where ``error`` is what cannot be
        had; with damping, bounded by ``|velocity| / (2 damping)``.
        """
        return velocity.joint_rates(self, q, rate, damping)
