"""Maps over a plane of the task or of two joints: what is reached, and how well."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import ArrayLike, NDArray

from closedform.plot.postures import OK
from closedform.plot.robot import Array, Robot, positions, singular_values
from closedform.plot.style import GROUND, colour, new_axes

SINGULAR = 2
NEAR = 0.03
"""A factor below this part of its usual size counts as near zero in a drawing."""


def workspace(
    robot: ModuleType,
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    params: Any = None,
    resolution: int = 400,
    ax: Any = None,
) -> Any:
    """Draw how many branches reach each point of a plane of the task.

    Parameters
    ----------
    robot
        a generated module with an inverse
    plane
        two task coordinates, such as ``("x", "z")``; by default the first two lengths
    at
        the target that gives the other coordinates; by default the image of a regular posture
    resolution
        points along each side
    params, ax
        as in :func:`closedform.plot.mechanism`
    """
    r = Robot.of(robot, params)
    grid = _task_plane(r, plane, at, resolution)
    _, status = r.branches(grid.targets)
    reached = answered(status).sum(-1)
    ax = new_axes(False) if ax is None else ax
    top = len(robot.BRANCHES)
    shown = np.where(reached > 0, reached, np.nan)
    image = ax.pcolormesh(
        *grid.sides, shown, cmap=_steps(top), vmin=0.5, vmax=top + 0.5, rasterized=True
    )
    present = np.unique(reached[reached > 0])
    bar = ax.figure.colorbar(image, ax=ax, ticks=present, shrink=0.8)
    bar.set_label("branches that reach the point")
    _name(ax, grid)
    return ax


def field(
    robot: ModuleType,
    function: str | Callable[[Array], Array] = "manipulability",
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    branch: int | str = 0,
    params: Any = None,
    resolution: int = 400,
    ax: Any = None,
) -> Any:
    """Draw a quantity of the joints over a plane of the task or of two joints.

    Parameters
    ----------
    function
        ``manipulability`` (the root of det J J^T), ``condition`` (the inverse condition number of
        J, 1 where it is best), the name of an exported function of the joints, or a function of
        an array of joints
    plane
        two task coordinates, or two joints
    branch
        over the task: the branch whose postures are measured
    at, resolution, params, ax
        as in :func:`workspace`; over two joints, ``at`` gives the other joints
    """
    r = Robot.of(robot, params)
    grid = _plane(r, plane, at, resolution)
    q = grid.targets if grid.joints else _answers(r, grid.targets, branch)
    values, label = _quantity(r, q, function)
    ax = new_axes(False) if ax is None else ax
    with np.errstate(invalid="ignore"):
        high = float(np.nanquantile(values, 0.995)) if np.isfinite(values).any() else 1.0
    image = ax.pcolormesh(*grid.sides, values, cmap="viridis", vmax=high, rasterized=True)
    ax.figure.colorbar(image, ax=ax, shrink=0.8, label=label)
    if not grid.joints:
        ax.set_title(f"branch {_branch_name(r, branch)}")
    _name(ax, grid)
    return ax


def singularities(
    robot: ModuleType,
    plane: Sequence[str] | None = None,
    *,
    at: ArrayLike | None = None,
    params: Any = None,
    resolution: int = 400,
    ax: Any = None,
) -> Any:
    """Draw where each factor of the singular set vanishes, over the task or over two joints.

    Over two joints these are curves.  Over the task, a colour marks where a factor of some branch
    is below 3 % of its usual size, and a line the border of the workspace.  The parameters are
    those of :func:`field`.
    """
    r = Robot.of(robot, params)
    grid = _plane(r, plane, at, resolution)
    ax = new_axes(False) if ax is None else ax
    drawn: dict[str, Any] = {}
    if grid.joints:
        factors = _factors(r, grid.targets)
        for k, name in enumerate(robot.SINGULARITIES):
            for mode in range(factors.shape[-2]):
                values = factors[..., mode, k]
                finite = values[np.isfinite(values)]
                if finite.size and finite.min() < 0 < finite.max():
                    masked = np.ma.masked_invalid(values)
                    ax.contour(*grid.sides, masked, levels=[0.0], colors=[colour(k)])
                    drawn[name] = Line2D([], [], color=colour(k))
    else:
        q, status = r.branches(grid.targets)
        answers = answered(status)
        count = answers.sum(-1).astype(float)
        factors = np.abs(_factors(r, np.where(answers[..., None], q, np.nan)))
        ax.contour(*grid.sides, count, levels=[0.5], colors=[GROUND], linewidths=1.0)
        for k, name in enumerate(robot.SINGULARITIES):
            values = factors[..., k].reshape(*count.shape, -1)
            finite = values[np.isfinite(values)]
            if not finite.size or finite.max() == 0:
                continue
            least = np.where(np.isfinite(values), values, np.inf).min(-1)
            near = np.where(np.isfinite(least), least / np.quantile(finite, 0.95), np.nan)
            if np.nanmin(near) < NEAR:
                band = np.ma.masked_invalid(near)
                ax.contourf(*grid.sides, band, levels=[-1.0, NEAR], colors=[colour(k)], alpha=0.8)
                drawn[name] = Patch(color=colour(k), alpha=0.8)
    if drawn:
        ax.figure.legend(drawn.values(), drawn.keys(), loc="outside lower center", ncols=1)
    _name(ax, grid)
    return ax


def answered(status: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Where there are joints that reach the target, singular or not."""
    return np.asarray((status == OK) | (status == SINGULAR))


def _factors(r: Robot, q: Array) -> Array:
    """The factors of the singular set, an axis for the assembly mode before the last."""
    found = np.asarray(r.call("singularities", q))
    return found if r.modes else found[..., None, :]


@dataclass(frozen=True)
class _Grid:
    """A grid over a plane: its sides, the targets or joints on it, and the names of its axes."""

    sides: tuple[Array, Array]
    targets: Array
    names: tuple[str, str]
    joints: bool


def _plane(r: Robot, plane: Sequence[str] | None, at: ArrayLike | None, resolution: int) -> _Grid:
    """A plane of the task, or of two joints where both names are joints."""
    names = list(r.module.JOINTS)
    if plane is None or not all(p in names for p in plane):
        return _task_plane(r, plane, at, resolution)
    base = r.posture() if at is None else np.asarray(at, dtype=float)
    places = [names.index(p) for p in plane]
    sides = tuple(
        np.linspace(0, r.size, resolution)
        if k in r.slides
        else np.linspace(-np.pi, np.pi, resolution)
        for k in places
    )
    targets = np.broadcast_to(base, (resolution, resolution, len(names))).copy()
    targets[..., places[0]], targets[..., places[1]] = sides[0], sides[1][:, None]
    return _Grid((sides[0], sides[1]), targets, (plane[0], plane[1]), True)


def _task_plane(
    r: Robot, plane: Sequence[str] | None, at: ArrayLike | None, resolution: int
) -> _Grid:
    r.require("ik")
    posture = r.posture()
    image = r.task(posture)
    target = (image[0] if r.modes else image) if at is None else np.asarray(at, dtype=float)
    places = positions(r, target)
    chosen = list(plane or list(places)[:2]) if r.flat else list(plane or ("x", "z"))
    if len(chosen) != 2 or not all(n in places for n in chosen):
        known = ", ".join([*places, *r.module.JOINTS])
        raise ValueError(f"the plane of {r.name} needs two of {known}; not {chosen}")
    hand = r.module.SKELETON.points.index(r.module.SKELETON.hand)
    seen = r.points(r.draw(2000, seed=2))[..., hand, :].reshape(-1, 3)
    seen = seen[np.isfinite(seen).all(1)]
    sides = []
    for name in chosen:
        low, high = np.quantile(seen[:, "xyz".index(name)], (0, 1))
        margin = 0.08 * (high - low)
        sides.append(np.linspace(low - margin, high + margin, resolution))
    flat = np.broadcast_to(target.reshape(-1), (resolution, resolution, target.size)).copy()
    if at is None:
        for name, k in places.items():
            if name not in chosen and name != "z":
                flat[..., k] = 0.0
    flat[..., places[chosen[0]]] = sides[0]
    flat[..., places[chosen[1]]] = sides[1][:, None]
    targets = flat.reshape(resolution, resolution, *target.shape)
    return _Grid((sides[0], sides[1]), targets, (chosen[0], chosen[1]), False)


def _answers(r: Robot, targets: Array, branch: int | str) -> Array:
    k = list(r.module.BRANCHES).index(branch) if isinstance(branch, str) else branch
    q, status = r.branches(targets)
    answered = np.where((status == OK)[..., None], q, np.nan)
    return np.asarray(answered[..., k, :])


def _branch_name(r: Robot, branch: int | str) -> str:
    return branch if isinstance(branch, str) else str(r.module.BRANCHES[branch])


def _quantity(r: Robot, q: Array, function: str | Callable[[Array], Array]) -> tuple[Array, str]:
    if callable(function):
        return np.asarray(function(q)), getattr(function, "__name__", "")
    if r.has(function):
        values = np.asarray(r.call(function, q))
        return (values[..., 0] if values.ndim > q.ndim - 1 else values), function
    if function not in ("manipulability", "condition"):
        raise ValueError(
            f"{r.name} has no function {function}; there are manipulability, condition and "
            f"{', '.join(n for n in r.module.__all__ if n.islower())}"
        )
    name = next((n for n in ("jacobian", "jacobian_space") if r.has(n)), "jacobian")
    J = np.asarray(r.call(name, q))
    J = J[..., 0, :, :] if r.modes else J
    sizes = singular_values(J[..., : J.shape[-1], :])
    if function == "condition":
        with np.errstate(invalid="ignore", divide="ignore"):
            return sizes[..., -1] / sizes[..., 0], "inverse condition number of the Jacobian"
    return np.prod(sizes, axis=-1), "manipulability"


def _steps(n: int) -> Any:
    """One colour for each number of branches."""
    return mpl.colormaps["Blues"].resampled(n + 1)


def _name(ax: Any, grid: _Grid) -> None:
    ax.set(xlabel=grid.names[0], ylabel=grid.names[1])
    if not grid.joints:
        ax.set_aspect("equal")
