"""The joints along a path of the hand."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot.postures import regular_target, spoken
from closedform.plot.robot import OK, Array, Robot, positions
from closedform.plot.style import colour, new_axes, styled
from closedform.plot.symbols import symbol

HALVED = 8
"""How often a line is made shorter that leaves the workspace."""


@styled
def path(
    robot: ModuleType,
    xs: ArrayLike,
    *,
    branch: int | str | None = None,
    start: ArrayLike | None = None,
    params: Any = None,
    given: float | None = None,
    ax: Any = None,
) -> Any:
    """Draw the joints along a path, in one branch.

    Parameters
    ----------
    robot
        a generated module with an inverse
    xs
        targets in their order, (n, ...)
    branch
        its name or number; by default the one nearest to ``start``, or the first that reaches
        the beginning
    start
        joints near those at the beginning
    params, ax
        as in :func:`closedform.plot.mechanism`
    given
        as in :func:`closedform.plot.branches`

    Angles are continued over half a turn.  Where the branch does not reach the path, the curves
    have a gap.
    """
    r = Robot.of(robot, params, given)
    targets = np.asarray(xs, dtype=float)
    q, status = r.branches(targets)
    if q.ndim != 3:
        raise ValueError(
            f"xs must be a sequence of targets of {r.name}; its shape is {targets.shape}"
        )
    k = _chosen(r, q[0], status[0], branch, start)
    curves = np.where((status[:, k] == OK)[:, None], q[:, k], np.nan)
    angles = [j for j in range(len(robot.JOINTS)) if j not in r.slides]
    curves[:, angles] = _unwrapped(curves[:, angles])
    ax = new_axes(False, (5.6, 3.4)) if ax is None else ax
    for j, name in enumerate(robot.JOINTS):
        ax.plot(curves[:, j], color=colour(j), label=symbol(name, r), linewidth=1.6)
    ax.set(xlabel="target", ylabel="angle in radians" if not r.slides else "joint")
    ax.set_title(f"branch {spoken(robot.BRANCHES[k])}")
    ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    ax.grid(alpha=0.3)
    return ax


def line(robot: ModuleType, n: int, *, params: Any = None) -> Array:
    """Targets on a straight line through the image of a regular posture, (n, ...).

    Only the position changes.  The line is so short that one branch reaches both ends.  Raises
    ``ValueError`` if there is none, as for a hand that moves on a surface.
    """
    r = Robot.of(robot, params)
    target = regular_target(r)
    places = positions(r, target)
    if not places:
        raise ValueError(f"the task of {r.name} has no position")
    way = np.zeros(target.size)
    way[list(places.values())] = [-1 / 6 if i else 1 / 4 for i in range(len(places))]
    for shorter in range(HALVED):
        along = np.linspace(-0.25, 0.25, n) * r.size / 2**shorter
        moved = target.reshape(-1) + along[:, None] * way
        targets: Array = moved.reshape(n, *target.shape)
        status = r.branches(targets[[0, -1]])[1]
        if (status == OK).all(0).any():
            return targets
    raise ValueError(
        f"no straight path of the hand of {r.name} was found; "
        f"in Python, plot.path takes other targets"
    )


def _chosen(
    r: Robot, q: Array, status: Array, branch: int | str | None, start: ArrayLike | None
) -> int:
    if isinstance(branch, str):
        return list(r.module.BRANCHES).index(branch)
    if branch is not None:
        return branch
    reached = np.flatnonzero(status == OK)
    if not reached.size:
        raise ValueError(f"no branch of {r.name} reaches the beginning of the path")
    if start is None:
        return int(reached[0])
    gap = np.abs(np.angle(np.exp(1j * (q[reached] - np.asarray(start, dtype=float)))))
    return int(reached[np.argmin(gap.sum(-1))])


def _unwrapped(angles: Array) -> Array:
    """Angles without jumps of a full turn, on each side of a gap."""
    done = angles.copy()
    for j in range(angles.shape[1]):
        finite = np.isfinite(angles[:, j])
        done[finite, j] = np.unwrap(angles[finite, j])
    return done
