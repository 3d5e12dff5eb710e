"""Planes of the task, or of two joints, over which maps are drawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import ModuleType
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.plot.postures import regular_target, spoken
from closedform.plot.robot import OK, POSITION, Array, Robot, positions
from closedform.plot.symbols import symbol

Limits: TypeAlias = Sequence[tuple[float, float]]
SINGULAR = 2
AREA = 2
"""The coordinates of a plane."""
ROUNDS, EDGE = 12, 120
"""How often a window is opened, and the points along its border that are tried."""
DIRECTION = ("longitude", "latitude")
"""The coordinates of a hand on a sphere, about z and above the plane of x and y."""
SPHERE = ((-np.pi, np.pi), (-np.pi / 2, np.pi / 2))
"""The limits of these, which contain every direction."""
RANK = 1e-6
"""Singular values below this count as zero; they are those of differences."""
TURN = (-np.pi / 2, np.pi / 2)
"""The limits of any other angle."""


@dataclass(frozen=True)
class Window:
    """What a map shows of its plane, as the caller gives it; ``None`` is the usual."""

    at: ArrayLike | None = None
    """The target, or the joints, that give the other coordinates."""
    resolution: int = 400
    """The points along each side."""
    limits: Limits | None = None
    unit: str = ""
    """That of lengths."""


@dataclass(frozen=True)
class Grid:
    """A grid over a plane: its sides, the targets or joints on it, and the names of its axes."""

    sides: tuple[Array, Array]
    targets: Array
    names: tuple[str, str]
    joints: bool
    section: str = ""
    """The other coordinates of the target."""
    unit: str = ""
    """That of both axes, if it is told."""


def grid_over(r: Robot, plane: Sequence[str] | None, window: Window) -> Grid:
    """A plane of the task, or of two joints.

    It is one of joints where both are named, the task has no position, or there is no inverse.
    """
    names = list(r.module.JOINTS)
    over_joints = r.has_forward_map and (not r.has("ik") or bool(_without_position(r)))
    if plane is None and over_joints:
        if len(names) < AREA:
            raise ValueError(f"{r.name} has one joint, and a map needs two")
        plane = names[:AREA]
    if plane is None or not r.has_forward_map or not all(p in names for p in plane):
        return task_grid(r, plane, window)
    _check_plane(r, plane, names)
    base = r.posture() if window.at is None else np.asarray(window.at, dtype=float)
    places = [names.index(p) for p in plane]
    ends = window.limits or [r.reach(k) for k in places]
    sides = tuple(np.linspace(low, high, window.resolution) for low, high in ends)
    targets = np.broadcast_to(base, (window.resolution, window.resolution, len(names))).copy()
    targets[..., places[0]], targets[..., places[1]] = sides[0], sides[1][:, None]
    called = r.called(plane[0]), r.called(plane[1])
    return Grid((sides[0], sides[1]), targets, called, True)


def task_grid(r: Robot, plane: Sequence[str] | None, window: Window) -> Grid:
    """A plane of the task; all directions of a hand that stays on a sphere."""
    r.require("ik")
    if why := unsectioned(r):
        raise ValueError(why)
    target = _image(r) if window.at is None else np.asarray(window.at, dtype=float)
    if _on_sphere(r):
        _check_plane(r, plane or DIRECTION, DIRECTION, r.module.JOINTS)
        return _over_sphere(target, window.resolution, window.limits)
    places = _places(r, target)
    chosen = list(plane or _usual(r, places))
    known = () if not r.has_forward_map else r.module.JOINTS
    _check_plane(r, chosen, list(places), known)
    target = target.copy()
    if window.at is None and r.has_forward_map:
        for name, k in places.items():
            if name not in chosen and name != "z":
                target.reshape(-1)[k] = 0.0
    first, second = (places[name] for name in chosen)
    ends = list(window.limits or ())
    ends += [_reached(r, target, places, name) for name in chosen[len(ends) :]]
    if window.limits is None and {*chosen} <= {*POSITION}:
        ends = _opened(r, target, (first, second), ends)
    sides = [np.linspace(low, high, window.resolution) for low, high in ends]
    flat = np.broadcast_to(
        target.reshape(-1), (window.resolution, window.resolution, target.size)
    ).copy()
    flat[..., first], flat[..., second] = sides[0], sides[1][:, None]
    others = [n for n in places if n not in chosen]
    section = ", ".join(
        [_coordinate(n, flat[0, 0, places[n]], window.unit) for n in others]
        + [f"{_spoken(r, name)} {value:.3g} rad" for name, value in r.beside.items()]
    )
    return Grid(
        sides=(sides[0], sides[1]),
        targets=flat.reshape(window.resolution, window.resolution, *target.shape),
        names=(chosen[0], chosen[1]),
        joints=False,
        section=section,
        unit=_unit(chosen, window.unit),
    )


def unsectioned(robot: ModuleType | Robot) -> str:
    """Why the workspace of a mechanism has no section; empty if it has one."""
    r = Robot.of(robot)
    if not r.has_forward_map:
        return ""
    return "" if _on_sphere(r) else _without_position(r)


def _without_position(r: Robot) -> str:
    """Why the position of a hand has no section; empty if it has one."""
    places = positions(r, _image(r))
    count = len(places)
    if not count:
        return f"the task of {r.name} has no position, so there is no section of its workspace"
    if count == 1 or count > len(r.module.JOINTS):
        held = "line" if count == 1 else "curve" if len(r.module.JOINTS) == 1 else "surface"
        return f"the hand of {r.name} moves on a {held}, of which there is no section"
    free = _free(r, [*places.values()]) if r.has_forward_map and not r.modes else count
    if free < count:
        held = {1: "line", 2: "surface"}.get(free, "point")
        return f"the hand of {r.name} in one direction stays on a {held}; there is no section"
    return ""


def _free(r: Robot, places: Sequence[int]) -> int:
    """In how many directions the hand can move without a turn."""
    q, step = r.posture(), 1e-5
    ahead, back = (r.task(q + sign * step * np.eye(len(q))).reshape(len(q), -1) for sign in (1, -1))
    rates = (ahead - back) / (2 * step)
    size = np.ones(rates.shape[1])
    size[list(places)] = r.size
    turns = np.delete(rates, places, axis=1)
    whole, turning = (
        int(np.linalg.matrix_rank(m, tol=RANK)) if m.size else 0 for m in (rates / size, turns)
    )
    return whole - turning


def _image(r: Robot) -> Array:
    """A target that can be reached."""
    if not r.has_forward_map:
        return regular_target(r)
    image = r.task(r.posture())
    return np.asarray(image[0] if r.modes else image)


def _on_sphere(r: Robot) -> bool:
    """Whether the hand stays on a sphere about the origin."""
    if not r.has_forward_map or tuple(POSITION) != r.module.TASK or len(r.module.JOINTS) != AREA:
        return False
    if not r.centre:
        return False
    place = r.module.SKELETON.points.index(r.centre)
    drawn = r.points(r.posture())[..., place, :]
    return not drawn[np.isfinite(drawn)].any()


def _over_sphere(target: Array, resolution: int, limits: Limits | None) -> Grid:
    """A grid of longitudes and latitudes."""
    sides = [np.linspace(low, high, resolution) for low, high in limits or SPHERE]
    a, b = np.meshgrid(*sides)
    unit = np.stack([np.cos(b) * np.cos(a), np.cos(b) * np.sin(a), np.sin(b)], axis=-1)
    targets = np.linalg.norm(target) * unit
    return Grid((sides[0], sides[1]), targets, DIRECTION, False, unit="rad")


def _places(r: Robot, target: Array) -> Mapping[str, int]:
    """The places of the coordinates that a plane may have, among the entries of a target."""
    found = positions(r, target)
    if r.has_forward_map or len(found) >= AREA:
        return found
    return {name: k for k, name in enumerate(r.module.TASK)}


def _usual(r: Robot, places: Mapping[str, int]) -> list[str]:
    """The two coordinates that are shown by default."""
    if r.flat:
        return list(places)[:AREA]
    if {"x", "z"} <= {*places}:
        return ["x", "z"]
    return [*(n for n in places if n not in POSITION), *places][:AREA]


def _reached(r: Robot, target: Array, places: Mapping[str, int], name: str) -> tuple[float, float]:
    """The limits of a coordinate: of a position those of random postures."""
    if name not in POSITION:
        return TURN
    if not r.has_forward_map:
        middle = float(target.reshape(-1)[places[name]])
        return middle - r.size / 4, middle + r.size / 4
    hand = r.module.SKELETON.points.index(r.module.SKELETON.hand)
    seen = r.points(r.draw(2000, seed=2))[..., hand, :].reshape(-1, 3)
    seen = seen[np.isfinite(seen).all(1)]
    low, high = np.quantile(seen[:, "xyz".index(name)], (0, 1))
    margin = 0.08 * (high - low)
    return low - margin, high + margin


def _unit(chosen: Sequence[str], of_lengths: str) -> str:
    """The unit of both coordinates; none if they differ, or that of lengths is not told."""
    lengths = [name in POSITION for name in chosen]
    return of_lengths if all(lengths) else "" if any(lengths) else "rad"


def _check_plane(r: Robot, plane: Sequence[str], *kinds: Sequence[str]) -> None:
    """Refuse what is not two different coordinates of the first kind; the others may be named."""
    if len(plane) != AREA or len({*plane} & {*kinds[0]}) != AREA:
        listed = " or ".join(f"two of {', '.join(k)}" for k in kinds if len(k) >= AREA)
        raise ValueError(f"the plane of {r.name} must be {listed}, not {', '.join(plane)}")


def _spoken(r: Robot, name: str) -> str:
    """A joint as in formulas, and any other angle in words."""
    return f"{symbol(name, r)} =" if name in r.module.JOINTS else spoken(name)


def _coordinate(name: str, value: float, unit: str) -> str:
    if name not in POSITION:
        return f"{symbol(name)} = {value + 0.0:.3g} rad"
    told = f"\\,\\mathrm{{{unit}}}" if unit and value else ""
    return f"${name} = {value + 0.0:.3g}{told}$"


def _opened(
    r: Robot, target: Array, places: tuple[int, int], ends: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """A window without targets at its border that can be reached; as is, if there is none."""
    window = [list(e) for e in ends]
    for _ in range(ROUNDS):
        touched = False
        for k in (0, 1):
            along = np.linspace(window[1 - k][0], window[1 - k][1], EDGE)
            for end in (0, 1):
                points = np.broadcast_to(target.reshape(-1), (EDGE, target.size)).copy()
                points[:, places[k]], points[:, places[1 - k]] = window[k][end], along
                _, status = r.branches(points.reshape(EDGE, *target.shape))
                if answered(status).any():
                    touched = True
                    step = 0.08 * (window[k][1] - window[k][0])
                    window[k][end] += step if end else -step
        if not touched:
            return [(e[0], e[1]) for e in window]
    return ends


def answered(status: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """Where there are joints that reach the target, singular or not."""
    return np.asarray((status == OK) | (status == SINGULAR))


__all__ = [
    "DIRECTION",
    "Grid",
    "Limits",
    "Window",
    "answered",
    "grid_over",
    "task_grid",
    "unsectioned",
]
