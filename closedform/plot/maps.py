"""Maps over a plane of the task or of two joints: what can be reached, and how well."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from textwrap import fill
from types import ModuleType
from typing import Any

import matplotlib as mpl
import numpy as np
from contourpy import contour_generator
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import ArrayLike, NDArray

from closedform.plot.postures import spoken
from closedform.plot.robot import JACOBIANS, Array, Robot, singular_values
from closedform.plot.sections import DIRECTION, Grid, Limits, Window, answered, grid_over, task_grid
from closedform.plot.style import colour, new_axes, styled
from closedform.plot.symbols import factor, symbol

NEAR_EDGE = 0.2
"""A factor below this part of its usual size beside the border counts as zero on it."""
BLUES = mpl.colormaps["Blues"]
DEEP = 1.9
"""The share of all branches that gets the deepest blue, so that curves stay visible."""
FEW = 0.002
"""A number of branches that occurs at a smaller share of the points is left out."""
WIDE = 30
"""Where a line of a legend is broken, in letters."""
POLE = 8.0
"""Values beyond this multiple of their median, as beside a parallel singularity, are alike."""
SIZE, AROUND = (5.2, 4.4), 1.2
"""The largest figure of a map, and what its labels take of it, in inches."""
SHORT = 25
"""A curve of fewer points than this is taken for noise of the grid."""
MEASURES = ("manipulability", "condition")
"""What is measured by the singular values of the Jacobian."""
OUTLINE = withStroke(linewidth=3.0, foreground="white")
"""Around a curve on the map of branches, which is as dark as the map if it is printed in grey."""


@styled
def workspace(
    robot: ModuleType,
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    params: Any = None,
    given: float | None = None,
    limits: Limits | None = None,
    unit: str = "",
    resolution: int = 400,
    singular: bool = True,
    ax: Any = None,
) -> Any:
    """Draw how many branches reach each point of a plane of the task, and the singular set in it.

    Parameters
    ----------
    robot
        a generated module with an inverse
    plane
        two task coordinates, such as ``("x", "z")``; by default the first two lengths, and for
        a hand on a sphere longitude and latitude
    at
        the target that gives the other coordinates; by default the image of a regular posture
    limits
        the lowest and highest value of each of the two; by default what random postures reach
    unit
        that of lengths, such as ``m``, for the names of the axes
    resolution
        points along each side
    singular
        whether a line shows where a branch is singular
    given
        as in :func:`closedform.plot.branches`
    params, ax
        as in :func:`closedform.plot.mechanism`
    """
    r = Robot.of(robot, params, given)
    grid = task_grid(r, plane, Window(at, resolution, limits, unit))
    q, status = r.branches(grid.targets)
    reached = answered(status).sum(-1)
    ax = _map_axes(grid) if ax is None else ax
    top = len(robot.BRANCHES)
    shown = np.where(reached > 0, reached, np.nan)
    ax.pcolormesh(
        *grid.sides, shown, cmap=BLUES, vmin=0.0, vmax=DEEP * top, rasterized=True, zorder=0
    )
    signs: list[Any] = [
        Patch(color=BLUES(n / (DEEP * top)), label=f"{n} branches" if n > 1 else "1 branch")
        for n in np.unique(reached[reached > 0])
        if (reached == n).mean() > FEW
    ]
    if singular:
        signs += _singular_curves(ax, r, grid, q, status)
    ax.legend(handles=signs, loc="center left", bbox_to_anchor=(1.02, 0.5), handlelength=1.6)
    _name(ax, grid)
    return ax


def _singular_curves(
    ax: Any, r: Robot, grid: Grid, q: Array, status: NDArray[np.uint8]
) -> list[Any]:
    """The border, and where a factor of a branch changes its sign inside; what the legend shows."""
    there = answered(status)
    count = there.sum(-1)
    factors = _of_branches(r, grid.targets, np.where(there[..., None], q, np.nan))
    edge = _beside_the_border(count)
    at_edge, signs = [], []
    for k in range(len(r.module.SINGULARITIES)):
        name, values = factor(r, k), factors[..., k]
        finite = np.abs(values[np.isfinite(values)])
        scale = float(np.quantile(finite, 0.95)) if finite.size else 0.0
        if scale == 0:
            continue
        with np.errstate(invalid="ignore"):
            least = np.nanmin(np.where(np.isfinite(values), np.abs(values), np.inf), axis=-1)
            if edge.any() and (least[edge] < NEAR_EDGE * scale).mean() > 0.2:
                at_edge.append(name)
        found = False
        for b in range(values.shape[-1]):
            kept = _without_jumps(values[..., b], 0.5 * scale)
            inside = kept[np.isfinite(kept)]
            if inside.size and inside.min() < -1e-9 * scale and inside.max() > 1e-9 * scale:
                for curve in _lines(grid, np.ma.masked_invalid(kept), 0.0):
                    style = {"color": colour(k + 1), "linewidth": 1.3, "zorder": 3}
                    ax.plot(*curve.T, path_effects=[OUTLINE], **style)
                    found = True
        if found:
            signs.append(Line2D([], [], color=colour(k + 1), label=_broken(name)))
    borders = [*_edges(grid, count)]
    for curve in borders:
        ax.plot(*curve.T, color="#222222", linewidth=0.8, zorder=2)
    if not borders:
        return signs
    border = "branches end: " + "; ".join(at_edge) if at_edge else "branches end"
    return [Line2D([], [], color="#222222", linewidth=0.8, label=_broken(border)), *signs]


def _broken(text: str) -> str:
    return text if "$" in text else fill(text, WIDE)


def _lines(grid: Grid, values: Any, level: float) -> Iterator[Array]:
    """The curves on which values on the grid have a level, without the shortest."""
    for curve in contour_generator(*grid.sides, values).lines(level):
        points = np.asarray(curve, dtype=float)
        if len(points) >= SHORT:
            yield points


def _edges(grid: Grid, count: NDArray[np.int_]) -> Iterator[Array]:
    """The curves at which the number of branches changes."""
    present = [n for n in np.unique(count) if (count == n).mean() > FEW]
    for low, high in pairwise(present):
        above = (count > (low + high) / 2).astype(float)
        yield from _lines(grid, above, 0.5)


def _of_branches(r: Robot, targets: Array, q: Array) -> Array:
    """The factors of each branch, in the assembly mode that reaches the target; none if unknown."""
    of_branches = np.expand_dims(targets, q.ndim - 2)
    if not r.has("singularities"):
        return np.empty((*q.shape[:-1], 0))
    factors = np.asarray(r.measured("singularities", q, of_branches))
    if not r.modes:
        return factors
    mode = r.mode_that_reaches(q, of_branches)
    return np.take_along_axis(factors, mode[..., None, None], axis=-2)[..., 0, :]


def _without_jumps(values: Array, most: float) -> Array:
    """The values, without those beside a jump, where the sign may change without a zero."""
    kept = values.copy()
    with np.errstate(invalid="ignore"):
        for axis in (0, 1):
            jump = np.abs(np.diff(values, axis=axis)) > most
            first, second = [slice(None)] * 2, [slice(None)] * 2
            first[axis], second[axis] = slice(None, -1), slice(1, None)
            kept[tuple(first)][jump] = np.nan
            kept[tuple(second)][jump] = np.nan
    return kept


def _beside_the_border(count: NDArray[np.int_]) -> NDArray[np.bool_]:
    """The points that are reached by more branches than a neighbour."""
    edge = np.zeros(count.shape, dtype=bool)
    for axis in (0, 1):
        for shift in (1, -1):
            edge |= count > np.roll(count, shift, axis)
    edge[[0, -1]] = edge[:, [0, -1]] = False
    return edge


@styled
def field(
    robot: ModuleType,
    function: str | Callable[[Array], Array] = "manipulability",
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    branch: int | str = 0,
    params: Any = None,
    given: float | None = None,
    limits: Limits | None = None,
    unit: str = "",
    resolution: int = 400,
    ax: Any = None,
) -> Any:
    """Draw a quantity of the joints over a plane of the task or of two joints.

    Parameters
    ----------
    robot
        a generated module with an inverse
    function
        ``manipulability`` (the root of det J J^T), ``condition`` (the inverse condition number of
        J, 1 where it is best), the name of an exported function of the joints, or a function of
        an array of joints
    plane
        two task coordinates, or two joints
    branch
        over the task: the branch whose postures are measured, each in the assembly mode that
        reaches the target; over two joints, the first assembly mode is
    at, limits, unit, resolution, params, given, ax
        as in :func:`workspace`; over two joints, ``at`` gives the other joints
    """
    r = Robot.of(robot, params, given)
    grid = grid_over(r, plane, Window(at, resolution, limits, unit))
    q = grid.targets if grid.joints else _answers(r, grid.targets, branch)
    first = np.zeros(q.shape[:-1], dtype=np.intp)
    mode = first if grid.joints else r.mode_that_reaches(q, grid.targets)
    values, label = _quantity(r, (q, grid.targets), mode, function)
    if function in MEASURES and r.mixes_units:
        label += f"\n({unit or 'unit of length'}, rad)"
    ax = _map_axes(grid) if ax is None else ax
    high, cut = _highest(values)
    image = ax.pcolormesh(*grid.sides, values, cmap="viridis", vmax=high, rasterized=True)
    beyond = "max" if cut else "neither"
    ax.figure.colorbar(image, ax=ax, shrink=0.8, label=label, extend=beyond)
    if not grid.joints and len(r.module.BRANCHES) > 1:
        ax.set_title(spoken(_branch_name(r, branch)))
    _name(ax, grid)
    return ax


def _highest(values: Array) -> tuple[float, bool]:
    """The value of the brightest colour, and whether a pole of the values is cut off there."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 1.0, False
    high, middle = float(np.quantile(finite, 0.995)), float(np.median(finite))
    if finite.min() >= 0 and high > POLE * middle > 0:
        return POLE * middle, True
    return high, False


@styled
def singularities(
    robot: ModuleType,
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    params: Any = None,
    given: float | None = None,
    limits: Limits | None = None,
    unit: str = "",
    resolution: int = 400,
    ax: Any = None,
) -> Any:
    """Draw where each factor of the singular set vanishes, over the task or over two joints.

    Over the task, these are the curves inside the workspace where a factor of some branch changes
    its sign, and the border, with the factors that vanish there.

    Parameters
    ----------
    robot, plane, at, params, given, limits, unit, resolution, ax
        as in :func:`field`
    """
    r = Robot.of(robot, params, given)
    grid = grid_over(r, plane, Window(at, resolution, limits, unit))
    ax = _map_axes(grid) if ax is None else ax
    drawn: dict[str, Any] = {}
    if grid.joints:
        factors = _factors(r, grid.targets)
        for k in range(len(robot.SINGULARITIES)):
            for mode in range(factors.shape[-2]):
                values = factors[..., mode, k]
                finite = values[np.isfinite(values)]
                if finite.size and finite.min() < 0 < finite.max():
                    masked = np.ma.masked_invalid(values)
                    width = 1.4 * (len(robot.SINGULARITIES) - k)  # all show if they meet
                    style = {"levels": [0.0], "colors": [colour(k)], "linewidths": width}
                    ax.contour(*grid.sides, masked, **style)
                    drawn[factor(r, k)] = Line2D([], [], color=colour(k), linewidth=width)
    else:
        q, status = r.branches(grid.targets)
        drawn = {str(s.get_label()): s for s in _singular_curves(ax, r, grid, q, status)}
    ax.set(xlim=grid.sides[0][[0, -1]], ylim=grid.sides[1][[0, -1]])
    if drawn:
        ax.figure.legend(drawn.values(), drawn.keys(), loc="outside lower center", ncols=1)
    _name(ax, grid)
    return ax


def _factors(r: Robot, q: Array) -> Array:
    """The factors of the singular set, an axis for the assembly mode before the last."""
    found = np.asarray(r.call("singularities", q))
    return found if r.modes else found[..., None, :]


def _answers(r: Robot, targets: Array, branch: int | str) -> Array:
    k = list(r.module.BRANCHES).index(branch) if isinstance(branch, str) else branch
    q, status = r.branches(targets)
    return np.where(answered(status)[..., None], q, np.nan)[..., k, :]


def _branch_name(r: Robot, branch: int | str) -> str:
    return branch if isinstance(branch, str) else str(r.module.BRANCHES[branch])


def _quantity(
    r: Robot,
    place: tuple[Array, Array],
    mode: NDArray[np.intp],
    function: str | Callable[[Array], Array],
) -> tuple[Array, str]:
    """The values of a function for each posture, in its assembly mode, and what they are.

    The ``place`` is the joints and the target; the target counts if no forward map gives it.
    """
    q, x = place

    def in_mode(values: Array) -> Array:
        axes = tuple(range(mode.ndim, values.ndim))
        return np.take_along_axis(values, np.expand_dims(mode, axes), mode.ndim).squeeze(mode.ndim)

    if callable(function):
        return np.asarray(function(q)), getattr(function, "__name__", "")
    if r.has(function):
        values = np.asarray(r.measured(function, q, x))
        return (in_mode(values) if values.ndim >= q.ndim else values), function
    if function not in MEASURES:
        there = dict.fromkeys([*MEASURES, *(n for n in r.module.__all__ if n.islower())])
        raise ValueError(f"{r.name} has no function {function}; there are {', '.join(there)}")
    known = JACOBIANS if function == "condition" else JACOBIANS[:2]
    name = next((n for n in known if r.has(n)), "jacobian")
    J = np.asarray(r.measured(name, q, x))
    J = in_mode(J) if r.modes else J
    sizes = singular_values(J[..., : J.shape[-1], :])
    if function == "condition":
        with np.errstate(invalid="ignore", divide="ignore"):
            return sizes[..., -1] / sizes[..., 0], "inverse condition number of the Jacobian"
    return np.prod(sizes, axis=-1), "manipulability"


def _map_axes(grid: Grid) -> Any:
    """Axes of a figure that is as low as the section is."""
    width, height = (float(np.ptp(side)) for side in grid.sides)
    low = SIZE[1] if grid.joints else AROUND + (SIZE[0] - AROUND) * height / width
    return new_axes(False, (SIZE[0], min(max(low, 2 * AROUND), SIZE[1])))


def _name(ax: Any, grid: Grid) -> None:
    unit = f" ({grid.unit})" if grid.unit else ""
    named = [name if name in DIRECTION else symbol(name) for name in grid.names]
    ax.set(xlabel=named[0] + unit)
    ax.set_ylabel(named[1] + unit, rotation=90 if unit else 0)
    if not grid.joints:
        ax.set_aspect("equal")
        named = [text for text in (ax.get_title(), grid.section) if text]
        ax.set_title(", ".join(named), fontsize=9)
