"""A base that the mechanism stands on, and a tool at its hand."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
RIGID = 1e-6
"""How far the rotation of a base or tool may be from orthogonal."""
UPRIGHT = ("x", "y", "z", "yaw")


def rigid(T: ArrayLike | None, name: str) -> Array | None:
    """A homogeneous transform; a position or a rotation is completed to one."""
    if T is None:
        return None
    given = np.array(T, dtype=float)
    found = np.eye(4)
    if given.shape == (3,):
        found[:3, 3] = given
    elif given.shape == (3, 3):
        found[:3, :3] = given
    elif given.shape == (4, 4):
        found = given
    else:
        raise ValueError(f"{name} has shape {given.shape}, expected (4, 4), (3, 3) or (3,)")
    R = found[:3, :3]
    proper = np.abs(R @ R.T - np.eye(3)).max() < RIGID and np.linalg.det(R) > 0
    if not proper or not np.array_equal(found[3], [0, 0, 0, 1]):
        raise ValueError(f"{name} is not a homogeneous transform with a proper rotation")
    return found


def or_identity(T: Array | None) -> Array:
    """The transform, or the identity."""
    return np.eye(4) if T is None else T


def inverse_transform(T: Array) -> Array:
    """The inverse of homogeneous transforms."""
    found = np.zeros_like(T)
    R = np.swapaxes(T[..., :3, :3], -1, -2)
    found[..., :3, :3] = R
    found[..., :3, 3] = -(R @ T[..., :3, 3, None])[..., 0]
    found[..., 3, 3] = 1.0
    return found


def rotated(T: Array | None, J: Array) -> Array:
    """Twists (v; omega) in another frame; three rows are angular velocities."""
    if T is None:
        return J
    R, p = T[:3, :3], T[:3, 3]
    if J.shape[-2] == 3:
        return np.asarray(R @ J)
    omega = R @ J[..., 3:, :]
    v = R @ J[..., :3, :] + cross(p, omega)
    return np.concatenate([v, omega], axis=-2)


def cross(p: Array, columns: Array) -> Array:
    """``p x c`` for each column of (..., 3, n) arrays."""
    return np.cross(p[..., None, :], np.swapaxes(columns, -1, -2)).swapaxes(-1, -2)


@dataclass(frozen=True)
class Mounting:
    """Targets of the tool in the world, and those of the bare mechanism.

    ``base`` and ``tool`` are in the form of the target: of coordinates x, y, z, yaw, a pose that is
    the position and the turn about z.
    """

    module: ModuleType
    parameters: Any
    base: Array | None
    tool: Array | None
    form: str

    @classmethod
    def of(
        cls, module: ModuleType, parameters: Any, base: Array | None, tool: Array | None
    ) -> Mounting:
        task = tuple(module.TASK)
        form = {16: "pose", 9: "rotation"}.get(len(task), "coordinates")
        if form == "coordinates" and (base is not None or tool is not None):
            name = module.__name__.rpartition(".")[2]
            form = "upright" if task == UPRIGHT else "position"
            if not set(task) <= {"x", "y", "z"} and form == "position":
                raise ValueError(f"{name}: a target ({', '.join(task)}) has neither base nor tool")
            if form == "position" and tool is not None:
                raise ValueError(f"{name}: the target is a position, to which no tool can be added")
            flat = form == "upright" or "z" not in task
            if base is not None and flat and abs(base[2, 2] - 1) > RIGID:
                raise ValueError(f"{name}: a base must not tilt the z axis")
            if base is not None and "z" not in task and base[2, 3] != 0:
                raise ValueError(f"{name}: a base must stay in the plane of x and y")
            if tool is not None:
                tool = _upright_tool(module, parameters, tool, name)
        return cls(module, parameters, base, tool, form)

    def inside(self, x: ArrayLike) -> Any:
        """The target of the bare mechanism."""
        return self._moved(x, inverse=True)

    def outside(self, x: ArrayLike) -> Any:
        """The target of the tool in the world."""
        return self._moved(x, inverse=False)

    def _moved(self, x: ArrayLike, inverse: bool) -> Any:
        if self.base is None and self.tool is None:
            return x
        base, tool = (np.eye(4) if T is None else T for T in (self.base, self.tool))
        if inverse:
            base, tool = inverse_transform(base), inverse_transform(tool)
        target = np.asarray(x, dtype=float)
        size = {"pose": (4, 4), "rotation": (3, 3)}.get(self.form, (len(self.module.TASK),))
        if target.shape[target.ndim - len(size) :] != size or target.ndim < len(size):
            shape = ", ".join(["...", *map(str, size)])
            raise ValueError(f"the target has shape {target.shape}, expected ({shape})")
        if self.form == "pose":
            return base @ target @ tool
        if self.form == "rotation":
            return base[:3, :3] @ target @ tool[:3, :3]
        if self.form == "upright":
            return _coordinates(base @ _pose(target) @ tool)
        n = target.shape[-1]
        return target @ base[:n, :n].T + base[:n, 3]

    def geometric(self, J: Array, q: Any) -> Array:
        """The Jacobian of the mounted tool from that of the hand; ``q`` are joints of the model."""
        n = 3 if J.shape[-2] >= 6 or "z" in self.module.TASK else 2
        v, rest = J[..., :n, :], J[..., n:, :]
        if self.tool is not None:
            x = np.asarray(self.module.fk(q, params=self.parameters))
            R = x[..., :3, :3] if self.form == "pose" else _pose(x)[..., :3, :3]
            omega = rest
            if self.form == "upright":
                omega = np.concatenate([np.zeros_like(J[..., :2, :]), rest], axis=-2)
            v = v - cross(R @ self.tool[:3, 3], omega)
        if self.base is not None:
            R = self.base[:3, :3]
            v = R[:n, :n] @ v
            rest = R @ rest if rest.shape[-2] == 3 else rest
        return np.concatenate([v, rest], axis=-2)


def _upright_tool(module: ModuleType, parameters: Any, tool: Array, name: str) -> Array:
    """A tool in a frame at the hand whose axes are those of the base turned by the yaw."""
    q = np.random.default_rng(0).uniform(-1, 1, (4, len(module.JOINTS)))
    T = np.asarray(module.pose(q, params=parameters))
    K = np.swapaxes(_pose(np.asarray(module.fk(q, params=parameters)))[..., :3, :3], -1, -2)
    K = K @ T[..., :3, :3]
    if np.abs(K - K[0]).max() > RIGID or abs(abs(tool[2, 2]) - 1) > RIGID or tool[2, 2] < 0:
        raise ValueError(f"{name}: a tool must not tilt the z axis")
    turn = np.eye(4)
    turn[:3, :3] = K[0]
    return np.asarray(turn @ tool @ inverse_transform(turn))


def _pose(x: Array) -> Array:
    found = np.zeros((*x.shape[:-1], 4, 4))
    c, s = np.cos(x[..., 3]), np.sin(x[..., 3])
    found[..., 0, 0], found[..., 0, 1], found[..., 1, 0], found[..., 1, 1] = c, -s, s, c
    found[..., 2, 2] = found[..., 3, 3] = 1.0
    found[..., :3, 3] = x[..., :3]
    return found


def _coordinates(T: Array) -> Array:
    yaw = np.arctan2(T[..., 1, 0], T[..., 0, 0])
    return np.concatenate([T[..., :3, 3], yaw[..., None]], axis=-1)
