"""Drawings of a mechanism: one posture, or all postures that reach a target."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot.robot import Array, Robot
from closedform.plot.style import GROUND, colour, new_axes

OK = 0
WIDEST, THINNER = 4.6, 0.42


def mechanism(
    robot: ModuleType,
    q: ArrayLike | None = None,
    *,
    params: Any = None,
    mode: int = 0,
    ax: Any = None,
    labels: bool = True,
) -> Any:
    """Draw a mechanism in one posture.

    Parameters
    ----------
    robot
        a generated module
    q
        the joints, (joints,); by default a posture that is far from singular
    params
        the dimensions; by default those of the example
    mode
        the assembly mode, for mechanisms that have several
    ax
        the axes to draw on, with a 3D projection unless the mechanism is planar
    labels
        whether joints and the hand are named
    """
    r = Robot.of(robot, params)
    joints = r.posture() if q is None else np.asarray(q, dtype=float)
    if joints.shape != (len(robot.JOINTS),):
        raise ValueError(f"q must have the shape ({len(robot.JOINTS)},), not {joints.shape}")
    points = r.points(joints)[mode]
    if not np.isfinite(points).all():
        modes = [r.modes[k] for k, p in enumerate(r.points(joints)) if np.isfinite(p).all()]
        raise ValueError(
            f"{r.name} cannot be assembled at {joints.tolist()} in mode {mode}; "
            f"modes that exist there: {', '.join(modes) or 'none'}"
        )
    ax = new_axes(not r.flat) if ax is None else ax
    _draw(ax, r, points, colour(0), labels=labels)
    _frame(ax, r, [points])
    return ax


def posture(robot: ModuleType, *, params: Any = None) -> Array:
    """Joints far from singular at which the mechanism can be assembled, always the same."""
    return Robot.of(robot, params).posture()


def branches(
    robot: ModuleType, x: ArrayLike | None = None, *, params: Any = None, ax: Any = None
) -> Any:
    """Draw all postures that reach a target, one colour a branch.

    Parameters
    ----------
    robot
        a generated module with an inverse
    x
        the target, as ``ik`` takes it; by default one that most branches reach
    params, ax
        as in :func:`mechanism`
    """
    r = Robot.of(robot, params)
    r.require("ik")
    if x is None:
        x = regular_target(r)
    q, status = r.branches(x)
    if status.shape != (len(robot.BRANCHES),):
        raise ValueError(f"x must be one target of {r.name}, not {np.shape(x)}")
    ax = new_axes(not r.flat) if ax is None else ax
    drawn: list[Array] = []
    for k, name in enumerate(robot.BRANCHES):
        if status[k] == OK:
            points = r.points(q[k])[r.mode_that_reaches(q[k], x)]
            width = WIDEST - THINNER * len(drawn)  # a branch that lies on another stays visible
            _draw(ax, r, points, colour(k), label=name, labels=False, width=width)
            drawn.append(points)
    if not drawn:
        raise ValueError(f"{r.name} reaches the target {np.asarray(x).tolist()} in no branch")
    _frame(ax, r, drawn)
    ax.figure.legend(loc="outside lower center", ncols=2 if len(drawn) > 3 else len(drawn))
    return ax


def regular_target(r: Robot) -> Array:
    """The image of a posture: of those drawn, one that the most branches reach."""
    q = np.vstack([r.posture(), r.draw(60, seed=1)])
    x = r.task(q)
    x = x[:, 0] if r.modes else x
    finite = np.isfinite(x.reshape(len(x), -1)).all(1)
    _, status = r.branches(np.where(np.isfinite(x), x, 0.0))
    reached = np.where(finite, (status == OK).sum(-1), -1)
    return np.asarray(x[np.argmax(reached)])


def _draw(
    ax: Any,
    r: Robot,
    points: Array,
    shade: str,
    *,
    label: str = "",
    labels: bool = True,
    width: float = 2.6,
) -> None:
    """The links and the joints of one posture."""
    skeleton = r.module.SKELETON
    place = dict(zip(skeleton.points, points[:, :2] if _planar(ax) else points, strict=True))
    named = bool(label)
    for name, link in skeleton.links.items():
        own = name == "ground" or set(link) <= set(skeleton.ground)
        line = np.array([place[p] for p in link]).T
        ax.plot(
            *line,
            color=GROUND if own else shade,
            linewidth=1.6 if own else width,
            solid_capstyle="round",
            solid_joinstyle="round",
            label=label if named and not own else None,
            zorder=2,
        )
        named = named and own
    for name, joint in skeleton.joints.items():
        ends = np.array([place[p] for p in joint.points])
        if joint.kind == "prismatic":
            ax.plot(
                *ends.T, color=shade, linewidth=1.4, linestyle=(0, (4, 1.5)), zorder=2,
                label=label if named else None,
            )  # fmt: skip
            named = False
        else:
            ax.plot(*ends[:1].T, "o", color="white", markeredgecolor=shade, markersize=5, zorder=3)
        if labels:
            at = ends.mean(0) if joint.kind == "prismatic" else ends[0]
            _write(ax, at, name.replace("theta", "θ").replace("rho", "ρ"), r.size)
    ax.plot(*place[skeleton.hand][:, None], "D", color=shade, markersize=4.5, zorder=4)
    if labels:
        _write(ax, place[skeleton.hand], "hand", r.size)


def _write(ax: Any, at: Array, text: str, size: float) -> None:
    """A label beside a point; several joints at one point share a line."""
    written = ax.__dict__.setdefault("_closedform_labels", [])
    for other, note in written:
        if np.abs(other - at).max() < 1e-3 * size:
            note.set_text(f"{note.get_text()}, {text}")
            return
    note = ax.text(*at, f"  {text}", fontsize=8, va="bottom", zorder=5)
    written.append((at, note))


def _frame(ax: Any, r: Robot, drawn: list[Array]) -> None:
    """Equal scales, a margin, and the names of the axes."""
    everything = np.vstack([*drawn, np.zeros((1, 3))])
    low, high = everything.min(0), everything.max(0)
    half = 0.56 * max((high - low).max(), 1e-9)
    middle = (low + high) / 2
    if _planar(ax):
        ax.set_aspect("equal", adjustable="datalim")
        ax.set(xlabel="x", ylabel="y")
        ax.margins(0.12)
    else:
        ax.set(xlabel="x", ylabel="y", zlabel="z")
        for k, axis in enumerate("xyz"):
            getattr(ax, f"set_{axis}lim")(middle[k] - half, middle[k] + half)
            getattr(ax, f"{axis}axis").set_pane_color((1, 1, 1, 0))
        ax.set_box_aspect((1, 1, 1))
    ax.grid(alpha=0.3)


def _planar(ax: Any) -> bool:
    return getattr(ax, "name", "") != "3d"
