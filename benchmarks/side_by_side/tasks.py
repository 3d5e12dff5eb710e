"""The tasks, all for a UR5e, and the checks of what a peer answers against what we answer."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from closedform import robots

TASKS = ("nearest", "limits", "tracking", "batch", "gradient", "tool", "drawing", "URDF")
SAME = 1e-6
"""rad: postures closer than that are the same."""

# Standard Denavit-Hartenberg table, as the maker publishes it; see the entry of ur5e in the robots.
A = np.array([0, -0.425, -0.3922, 0, 0, 0])
D = np.array([0.1625, 0, 0, 0.1333, 0.0997, 0.0996])
ALPHA = np.array([1, 0, 0, 1, -1, 0]) * np.pi / 2
TURN = 2 * np.pi
LIMITS = np.array([[-TURN, -TURN, -np.pi, -TURN, -TURN, -TURN]]) * [[1], [-1]]
NARROW = np.array([np.full(6, -2.6), np.full(6, 2.6)])
TOOL = np.eye(4)
TOOL[:3, 3] = 0.02, 0, 0.15

_random = np.random.default_rng(21)
POSTURES = _random.uniform(-2.4, 2.4, (100, 6))
SEEDS = POSTURES + _random.uniform(-0.3, 0.3, POSTURES.shape)


def pose(q: np.ndarray) -> np.ndarray:
    """The product of the table for joints (..., 6): an independent route to the pose."""
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))
    for i in range(6):
        T = T @ turned(q[..., i]) @ moved(i)
    return np.asarray(T)


def turned(angle: np.ndarray) -> np.ndarray:
    T = np.zeros((*angle.shape, 4, 4))
    T[..., 0, 0] = T[..., 1, 1] = np.cos(angle)
    T[..., 1, 0] = np.sin(angle)
    T[..., 0, 1] = -T[..., 1, 0]
    T[..., 2, 2] = T[..., 3, 3] = 1
    return T


def moved(i: int) -> np.ndarray:
    """What follows the joint i in the table."""
    c, s = np.cos(ALPHA[i]), np.sin(ALPHA[i])
    return np.array([[1, 0, 0, A[i]], [0, c, -s, 0], [0, s, c, D[i]], [0, 0, 0, 1]])


TARGETS = pose(POSTURES)
HOME = np.radians([20, -100, 100, -80, -70, 30.0])


def straight() -> np.ndarray:
    """A straight path of the flange from HOME, 40 cm in 200 points."""
    path = np.repeat(pose(HOME)[None], 200, axis=0)
    path[:, 1, 3] += np.linspace(0, 0.4, len(path))
    return path


PATH = straight()


def urdf(limits: np.ndarray = LIMITS, tool: np.ndarray | None = None) -> str:
    """The arm as a URDF without meshes, whose links have the frames of the table."""
    lines = ['<robot name="ur5e">', *(f'<link name="l{i}"/>' for i in range(7))]
    origin = "0 0 0", 0.0
    for i in range(6):
        (xyz, roll), (low, high) = origin, limits[:, i].tolist()
        lines.append(
            f'<joint name="theta{i + 1}" type="revolute"><parent link="l{i}"/>'
            f'<child link="l{i + 1}"/><origin xyz="{xyz}" rpy="{roll!r} 0 0"/><axis xyz="0 0 1"/>'
            f'<limit lower="{low!r}" upper="{high!r}" effort="150" velocity="3.14"/></joint>'
        )
        origin = f"{float(A[i])!r} 0 {float(D[i])!r}", float(ALPHA[i])
    xyz, roll = origin
    lines.append(f'<link name="flange"/>{fixed("l6", "flange", xyz, roll)}')
    if tool is not None:
        x, y, z = tool[:3, 3].tolist()
        lines.append(f'<link name="tcp"/>{fixed("flange", "tcp", f"{x} {y} {z}", 0.0)}')
    return "\n".join([*lines, "</robot>"])


def fixed(parent: str, child: str, xyz: str, roll: float) -> str:
    return (
        f'<joint name="to_{child}" type="fixed"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="{roll!r} 0 0"/></joint>'
    )


def as_given(answer: Any) -> Any:
    return answer


@dataclass(frozen=True)
class Way:
    """How a task is done: the call, and what it gives, if it can be done."""

    call: str
    run: Callable[[], Any] | None = None
    units: int = len(POSTURES)
    """How many targets or postures the time is divided by."""
    numeric: bool = False
    """Whether it iterates from a seed to one solution, which need not be the nearest."""
    tolerance: float = SAME
    """rad and m; below it, postures are the same and a target is reached."""
    read: Callable[[Any], Any] = as_given
    """The answer as arrays, which takes no part of the time."""


Ways = dict[str, Way]


class DisagreementError(Exception):
    """A peer answers another thing than we."""


def require(condition: bool, told: str) -> None:
    if not condition:
        raise DisagreementError(told)


def reached(q: np.ndarray, targets: np.ndarray, way: Way) -> np.ndarray:
    """Which postures reach their targets; only a numeric solver may return others."""
    found = np.isfinite(q).all(axis=-1)
    gap = np.abs(pose(np.where(found[..., None], q, 0)) - targets).max(axis=(-1, -2))
    hits = np.asarray(found & (gap < way.tolerance))
    require(way.numeric or bool(hits.all()), f"{(~hits).sum()} postures miss their targets")
    return hits


def same_postures(theirs: Any, ours: np.ndarray, way: Way, targets: np.ndarray) -> str:
    """Compare one posture for each target."""
    q = np.asarray(theirs, dtype=float)
    require(q.shape == ours.shape, f"shape {q.shape}, expected {ours.shape}")
    hits = reached(q, targets, way)
    same = hits & (np.abs(q - ours).max(axis=1) < way.tolerance)
    if not way.numeric:
        require(bool(same.all()), f"{(~same).sum()} of {len(q)} postures differ")
        return "the same postures"
    other, none = int((hits & ~same).sum()), int((~hits).sum())
    require(2 * same.sum() > len(q), f"only {same.sum()} of {len(q)} postures are the same")
    words = [f"the same posture {same.sum()} times"]
    words += [f"another solution {other} times"] * (other > 0) + [f"none {none} times"] * (none > 0)
    return ", ".join(words)


def same_sets(theirs: Sequence[Any], ours: Sequence[np.ndarray], way: Way) -> str:
    """Compare the solutions of each target, modulo turns; a numeric solver gives one of them."""
    require(len(theirs) == len(ours), f"{len(theirs)} answers, expected {len(ours)}")
    found = 0
    for k, (mine, expected) in enumerate(zip(theirs, ours, strict=True)):
        q = np.asarray(mine, dtype=float).reshape(-1, 6)
        q = q[reached(q, TARGETS[k], way)]
        gap = np.abs(np.remainder(q[:, None] - expected + np.pi, TURN) - np.pi).max(axis=2)
        close = gap < way.tolerance
        require(bool(close.any(axis=1).all()), f"target {k}: a posture that we do not have")
        missing = int((~close.any(axis=0)).sum())
        require(way.numeric or not missing, f"target {k}: lacks {missing} of {len(expected)}")
        found += len(q)
    total = sum(map(len, ours))
    if not way.numeric:
        return f"the same {total} postures"
    require(2 * found > len(ours), f"only {found} of {len(ours)} targets are reached")
    return f"{found} of the {total} postures, one for a target"


def same_arrays(theirs: Any, ours: np.ndarray, way: Way) -> str:
    gap = float(np.abs(np.asarray(theirs, dtype=float) - ours).max())
    require(gap < way.tolerance, f"differs by {gap:.1g}")
    return f"equal within {10.0 ** np.ceil(np.log10(max(gap, 1e-16))):.0e}"


def on_our_axes(theirs: Any, ours: np.ndarray) -> str:
    """Compare joints that are drawn: a point on the axis of each joint, and the flange."""
    points = np.asarray(theirs, dtype=float)
    frames = robots.load("ur5e").frames(HOME)
    off = np.cross(points[:6] - frames[1:7, :3, 3], frames[1:7, :3, 2])
    gap = max(float(np.abs(off).max()), float(np.abs(points[6] - frames[7, :3, 3]).max()))
    require(gap < 1e-9, f"the joints are {gap:.1g} off")
    return "joints on the same axes"


def judged(task: str, way: Way, theirs: Any, ours: Any) -> str:
    """What the answers of a peer are beside ours; raises DisagreementError if they are wrong."""
    if task in ("nearest", "tool"):
        return same_postures(theirs, ours, way, TARGETS)
    if task == "tracking":
        return same_postures(theirs, ours, way, PATH)
    if task in ("limits", "batch"):
        return same_sets(theirs, ours, way)
    return on_our_axes(theirs, ours) if task == "drawing" else same_arrays(theirs, ours, way)


def nearest_of(branches: Iterable[np.ndarray], seed: np.ndarray) -> np.ndarray:
    """What a user writes who gets all branches: the nearest one, with its nearest turns."""
    q = np.asarray(list(branches)).reshape(-1, 6)
    q = q + TURN * np.round((seed - q) / TURN)
    return np.asarray(q[np.linalg.norm(q - seed, axis=1).argmin()])
