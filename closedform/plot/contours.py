"""Contours with as few points as a figure needs."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from contourpy import contour_generator
from matplotlib.patches import PathPatch
from matplotlib.path import Path

from closedform.plot.robot import Array

FINE, STEPS = 5e-4, 1.3
"""How far a curve may be from its points: in units of the side of the figure, and for the border of
a set, which has the steps of the grid, in units of those."""
FEWEST = 6
"""Curves of fewer points are specks of the grid."""


def curves(ax: Any, x: Array, y: Array, values: Any, level: float, **style: Any) -> int:
    """Draw the curves at which values on a grid have a level; returns how many there are."""
    tolerance = STEPS / len(x) if np.asarray(values).dtype == bool else FINE
    numbers = np.ma.masked_invalid(np.asarray(values, dtype=float))
    found = contour_generator(x, y, numbers).lines(level)
    drawn = [thinned(np.asarray(c), x, y, tolerance) for c in found if len(c) >= FEWEST]
    for curve in drawn:
        ax.plot(*curve.T, **style)
    return len(drawn)


def region(
    ax: Any,
    x: Array,
    y: Array,
    values: Any,
    *,
    levels: tuple[float, float] = (0.5, 1.5),
    **style: Any,
) -> None:
    """Fill where values on a grid are between two levels, by default where truth values hold."""
    numbers = np.ma.masked_invalid(np.asarray(values, dtype=float))
    generator = contour_generator(x, y, numbers, fill_type="OuterOffset")
    filled: Any = generator.filled(*levels)
    points, offsets = filled
    for outline, ends in zip(points, offsets, strict=True):
        rings = [np.asarray(outline)[a:b] for a, b in pairwise(ends)]
        rings = [thinned(r, x, y, STEPS / len(x)) for r in rings if len(r) >= FEWEST]
        if rings:
            path = Path.make_compound_path(*(Path(r, closed=True) for r in rings))
            ax.add_patch(PathPatch(path, linewidth=0.3, **style))
    ax.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]))


def thinned(curve: Array, x: Array, y: Array, tolerance: float) -> Array:
    """A curve without the points that lie on the lines between others (Douglas and Peucker)."""
    scale = np.array([np.ptp(x), np.ptp(y)])
    points = curve / scale
    kept = np.zeros(len(points), dtype=bool)
    kept[[0, len(points) // 2, -1]] = True
    stack = [(0, len(points) // 2), (len(points) // 2, len(points) - 1)]
    while stack:
        a, b = stack.pop()
        if b - a < 2:
            continue
        chord = points[b] - points[a]
        size = float(np.hypot(*chord))
        gap = points[a + 1 : b] - points[a]
        if size > 0:
            far = np.abs(gap[:, 0] * chord[1] - gap[:, 1] * chord[0]) / size
        else:
            far = np.hypot(*gap.T)
        k = int(np.argmax(far))
        if far[k] > tolerance:
            kept[a + 1 + k] = True
            stack += [(a, a + 1 + k), (a + 1 + k, b)]
    return np.asarray(curve[kept])
