"""The frames of the links of a serial chain, from its joint axes by the product of exponentials."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from closedform.robots.mechanism import Array, Mechanism
from closedform.robots.mounting import inverse_transform, or_identity

AGREES = 1e-9
_NO_CHAIN = "{} is not a serial chain of its joints, so its links have no frames"
TRIALS = 3


def frames(mechanism: Mechanism, q: ArrayLike) -> Array:
    """Frames of shape (..., joints + 2, 4, 4): the base, each link, and the tool.

    The frame of a link is at its joint, with z along the axis of that joint, and moves with the
    link.
    """
    given = mechanism.as_joints(q)
    screws, home, end = _at_home(mechanism)
    _require_chain(mechanism, screws, end)
    return _frames(mechanism, given, screws, home, end)


def _frames(mechanism: Mechanism, q: Array, screws: Array, home: Array, end: Array) -> Array:
    model = np.asarray(mechanism.to_model(q))
    base = or_identity(mechanism.base)
    tool = or_identity(mechanism.tool)
    found = np.empty((*model.shape[:-1], model.shape[-1] + 2, 4, 4))
    found[..., 0, :, :] = base
    moved = np.broadcast_to(base, (*model.shape[:-1], 4, 4))
    for k in range(model.shape[-1]):
        moved = moved @ exponential(screws[:, k], model[..., k])
        found[..., k + 1, :, :] = moved @ home[k]
    found[..., -1, :, :] = moved @ end @ tool
    return found


def _at_home(mechanism: Mechanism) -> tuple[Array, Array, Array]:
    """The screws of the bare mechanism, the frames of its joints and its hand, at zero joints."""
    zero = np.zeros(len(mechanism.joints))
    if not mechanism.has("pose"):
        raise ValueError(_NO_CHAIN.format(mechanism.name))
    if any(np.ndim(p) for p in mechanism.parameters):
        raise ValueError("frames: the dimensions must be numbers, not arrays")
    screws = _screws(mechanism)
    points = np.asarray(mechanism.call("skeleton", zero))
    names = mechanism.module.SKELETON.points
    home = np.tile(np.eye(4), (len(zero), 1, 1))
    for k, name in enumerate(mechanism.joints):
        at = points[names.index(mechanism.module.SKELETON.joints[name].points[0])]
        home[k, :3, 3] = at
        axis = screws[3:, k] if mechanism.revolute[k] else screws[:3, k]
        if not axis.any():
            raise ValueError(_NO_CHAIN.format(mechanism.name))
        home[k, :3, :3] = _with_z_along(axis)
    return screws, home, np.asarray(mechanism.call("pose", zero))


def _screws(mechanism: Mechanism) -> Array:
    """The screws (v; omega) at zero joints, one a column, from poses with one joint moved."""
    moves = np.diag(np.where(mechanism.revolute, np.pi / 2, 1.0))
    poses = np.asarray(mechanism.call("pose", np.concatenate([moves, np.zeros((1, len(moves)))])))
    found = np.zeros((6, len(moves)))
    for k, T in enumerate(poses[:-1] @ inverse_transform(poses[-1])):
        W = (T[:3, :3] - T[:3, :3].T) / 2
        found[3:, k] = W[2, 1], W[0, 2], W[1, 0]
        if mechanism.revolute[k]:  # the sine is 1 and the cosine 0
            turned = moves[k, k] * np.eye(3) + W + (moves[k, k] - 1) * W @ W
            found[:3, k] = np.linalg.solve(turned, T[:3, 3])
        else:
            found[:3, k] = T[:3, 3]
    return found


def _require_chain(mechanism: Mechanism, screws: Array, end: Array) -> None:
    """Raise unless the product of the exponentials is the pose."""
    q = np.random.default_rng(0).uniform(-1, 1, (TRIALS, len(mechanism.joints)))
    moved: Array = np.eye(4)
    for k in range(q.shape[-1]):
        moved = moved @ exponential(screws[:, k], q[:, k])
    expected = np.asarray(mechanism.call("pose", q))
    scale = 1 + np.abs(expected).max()
    if not (np.abs(moved @ end - expected) <= AGREES * scale).all():
        raise ValueError(_NO_CHAIN.format(mechanism.name))


def _with_z_along(axis: Array) -> Array:
    """A rotation with z along an axis and x near the x axis, or near y if z is along x."""
    z = axis / np.linalg.norm(axis)
    along = np.eye(3)[int(abs(z[0]) > 0.9)]
    x = along - z * (along @ z)
    x /= np.linalg.norm(x)
    return np.stack([x, np.cross(z, x), z], axis=-1)


def exponential(screw: Array, angle: Array) -> Array:
    """The motions exp([screw] angle), of shape (..., 4, 4); the rotation part is a unit or zero."""
    v, omega = screw[:3], screw[3:]
    W = np.array(
        [
            [0, -omega[2], omega[1]],
            [omega[2], 0, -omega[0]],
            [-omega[1], omega[0], 0],
        ]
    )
    t = np.asarray(angle)[..., None, None]
    s, versine = np.sin(t), 2 * np.sin(t / 2) ** 2
    found = np.zeros((*np.shape(angle), 4, 4))
    found[..., :3, :3] = np.eye(3) + s * W + versine * (W @ W)
    turned = np.eye(3) * t + versine * W + (t - s) * (W @ W)
    found[..., :3, 3] = turned @ v
    found[..., 3, 3] = 1.0
    return found
