"""The motion of a mechanism with one joint: the task and its derivative over the joint."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.lines import Line2D

from closedform.plot.postures import spoken
from closedform.plot.robot import POSITION, Array, Robot
from closedform.plot.sections import answered
from closedform.plot.style import colour, new_panels, styled
from closedform.plot.symbols import factor, symbol

STEPS = 4001
"""Postures along a curve."""
VANISHED = 0.05
"""At the end of a curve, a factor below this part of its usual size is zero."""
ROUNDING = 1e-9
"""A factor below this part of its usual size is zero."""
MOST = 4.0
"""Slopes up to this multiple of the usual one are shown."""


@styled
def motion(robot: ModuleType, *, params: Any = None, unit: str = "") -> Any:
    """Draw the task of a mechanism with one joint, and its derivative, over the joint.

    Parameters
    ----------
    robot
        a generated module with one joint and one coordinate of the task
    params
        as in :func:`closedform.plot.mechanism`
    unit
        that of lengths, such as ``m``, for the names of the axes
    """
    r = Robot.of(robot, params)
    if len(robot.JOINTS) != 1 or len(robot.TASK) != 1:
        raise ValueError(f"{r.name} must have one joint and one coordinate of the task")
    (joint,), (task,) = robot.JOINTS, robot.TASK
    reach = r.reach(0)
    q = np.linspace(*reach, STEPS)
    images, slopes = (_by_mode(r, name, q) for name in ("fk", "jacobian"))
    # some linkages are never singular
    factors = _by_mode(r, "singularities", q) if robot.SINGULARITIES else np.empty((len(q), 1, 0))
    if task not in POSITION:
        images[1:][np.abs(np.diff(images, axis=0)) > np.pi] = np.nan  # it passes half a turn
    above, below = new_panels(2, 1, size=(5.2, 4.4))
    modes = r.modes or ("",)
    for k, mode in enumerate(modes):
        for ax, values in ((above, images), (below, slopes)):
            ax.plot(q, values[:, k, 0], color=colour(k), linewidth=1.6, label=spoken(mode))
    signs = [Line2D([], [], color=colour(k), label=spoken(m)) for k, m in enumerate(modes) if m]
    for n in range(len(robot.SINGULARITIES)):
        shade = colour(len(modes) + n)
        dots = [(i, k) for k in range(len(modes)) for i in _zeros(factors[:, k, n])]
        dot: dict[str, Any] = {"color": shade, "marker": "o", "linestyle": "", "markersize": 5}
        for i, k in dots:
            above.plot(q[i], images[i, k, 0], zorder=3, clip_on=False, **dot)
        if dots:
            signs.append(Line2D([], [], label=factor(r, n), **dot))
    finite = np.abs(slopes[np.isfinite(slopes)])
    high = (min(finite.max(), MOST * np.median(finite)) if finite.size else 0.0) or 1.0
    below.set_ylim(-1.1 * high, 1.1 * high)
    unit_of = {True: f" ({unit})" if unit else "", False: " (rad)"}
    letters = symbol(task).strip("$"), symbol(joint, r).strip("$")
    above.set(ylabel=symbol(task) + unit_of[task in POSITION])
    below.set(xlabel=symbol(joint, r) + unit_of[bool(r.slides)])
    below.set(ylabel=rf"$d{letters[0]}/d{letters[1]}$")
    for ax in (above, below):
        ax.grid(alpha=0.3)
        ax.set_xlim(*reach)
    above.legend(handles=signs, loc="center left", bbox_to_anchor=(1.02, 0.5), handlelength=1.6)
    return above


def _by_mode(r: Robot, function: str, q: Array) -> Array:
    """The values of a function along the joint: an axis for the mode, and one for the entries."""
    found = r.call(function, q[:, None])
    if function == "fk" and hasattr(found, "p"):
        found = np.where(answered(np.asarray(found.status))[..., None], found.p, np.nan)
    return np.array(found, dtype=float).reshape(len(q), len(r.modes) or 1, -1)


def _zeros(factor: Array) -> Iterator[int]:
    """Where a factor changes its sign, or is nearly zero at the end of a curve."""
    there = np.isfinite(factor)
    if not there.any():
        return
    scale = np.quantile(np.abs(factor[there]), 0.95)
    factor = np.where(np.abs(factor) < ROUNDING * scale, 0.0, factor)
    for i in np.flatnonzero(there):
        before = factor[i - 1] if i else np.nan
        ends = (i and not there[i - 1]) or (i + 1 < len(factor) and not there[i + 1])
        near = ends and abs(factor[i]) < VANISHED * scale
        if near or factor[i] == 0 or before * factor[i] < 0:
            yield int(i)


__all__ = ["motion"]
