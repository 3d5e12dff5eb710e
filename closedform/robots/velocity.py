"""Velocities and forces: twists, joint torques, measures of dexterity, and joint rates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.robots.mechanism import Array, Mechanism

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
CUTOFF = 1e-10
"""Singular values below this share of the largest count as zero."""
FRAMES = ("tip", "space", "body")
AXES = {"all": slice(0, 6), "trans": slice(0, 3), "rot": slice(3, 6)}


class Rates(NamedTuple):
    """Joint rates, and how well they give the requested velocity.

    ``error``, of the shape of the velocity, is the part that is missing.  ``status`` is OK,
    SINGULAR if the Jacobian loses rank there, or INVALID if it is not finite; ``qdot`` is then NaN.
    """

    qdot: Array
    error: Array
    status: NDArray[np.uint8]


def twist_jacobian(mechanism: Mechanism, q: ArrayLike, frame: str = "tip") -> Array:
    """The 6 x n Jacobian of the twist (v; omega).

    ``"tip"``: v is the velocity of the origin of the tool, both in the axes of the world.
    ``"space"``: v is that of the point at the origin of the world.  ``"body"``: in the frame of the
    tool.
    """
    if frame not in FRAMES:
        raise ValueError(f"frame must be one of {', '.join(FRAMES)}, not {frame!r}")
    if not _has_twist(mechanism):
        raise ValueError(f"{mechanism.name} has no twist; jacobian gives the rates of its task")
    if frame == "body" and _has_six_rows(mechanism):
        return mechanism.jacobian_body(q)
    J = mechanism.jacobian_space(q)
    T = mechanism.pose(q)
    p = T[..., :3, 3]
    if J.shape[-2] == 3:  # the axes of a wrist meet at the origin of its base
        origin = np.zeros(3) if mechanism.base is None else mechanism.base[:3, 3]
        J = np.concatenate([-_cross(J, origin), J], axis=-2)
    if frame == "space":
        return J
    v, omega = J[..., :3, :], J[..., 3:, :]
    v = v + _cross(omega, p)
    if frame == "body":
        R = np.swapaxes(T[..., :3, :3], -1, -2)
        v, omega = R @ v, R @ omega
    return np.concatenate([v, omega], axis=-2)


def _has_twist(mechanism: Mechanism) -> bool:
    return mechanism.has("jacobian_space") and mechanism.has("pose")


def _has_six_rows(mechanism: Mechanism) -> bool:
    return mechanism.has("jacobian_body") and len(mechanism.module.TASK) != 9


def _cross(columns: Array, p: Array) -> Array:
    """``c x p`` for each column."""
    return np.asarray(np.cross(np.swapaxes(columns, -1, -2), p[..., None, :]).swapaxes(-1, -2))


def twist(mechanism: Mechanism, q: ArrayLike, qdot: ArrayLike, frame: str = "tip") -> Array:
    """The twist (v; omega) of the tool at joint rates."""
    rates = np.asarray(qdot, dtype=float)[..., None]
    return np.asarray((twist_jacobian(mechanism, q, frame) @ rates)[..., 0])


def joint_torques(
    mechanism: Mechanism, q: ArrayLike, wrench: ArrayLike, frame: str = "tip"
) -> Array:
    """The joint torques that hold a wrench (f; m) which the tool exerts: ``J.T @ wrench``.

    A mechanism without a twist takes the forces along its task coordinates, as ``joint_rates``
    takes their rates.
    """
    twisted = _has_twist(mechanism)
    J = twist_jacobian(mechanism, q, frame) if twisted else rate_jacobian(mechanism, q)
    if np.shape(wrench)[-1:] != J.shape[-2:-1]:
        raise ValueError(f"wrench has shape {np.shape(wrench)}, expected (..., {J.shape[-2]})")
    force = np.asarray(wrench, dtype=float)[..., None]
    return np.asarray((np.swapaxes(J, -1, -2) @ force)[..., 0])


def rate_jacobian(mechanism: Mechanism, q: ArrayLike) -> Array:
    """The Jacobian that joint rates are computed from: of the tip, or of the task."""
    if mechanism.has("jacobian_space") and len(mechanism.module.TASK) == 16:
        return twist_jacobian(mechanism, q)
    if len(mechanism.module.TASK) == 9:
        return mechanism.jacobian_space(q)
    return mechanism.jacobian(q)[..., : len(mechanism.module.TASK), :]


def _singular_values(mechanism: Mechanism, q: ArrayLike, axes: str) -> Array:
    if axes not in AXES:
        raise ValueError(f"axes must be one of {', '.join(AXES)}, not {axes!r}")
    J = rate_jacobian(mechanism, q)
    if axes != "all":
        J = twist_jacobian(mechanism, q)[..., AXES[axes], :]
    finite = np.asarray(np.isfinite(J).all((-1, -2)))
    sizes = np.linalg.svd(np.where(finite[..., None, None], J, 0.0), compute_uv=False)
    return np.asarray(np.where(finite[..., None], sizes, np.nan))


def manipulability(mechanism: Mechanism, q: ArrayLike, axes: str = "all") -> Array:
    """Yoshikawa's measure, the product of the singular values of the Jacobian."""
    return np.asarray(_singular_values(mechanism, q, axes).prod(-1))


def condition(mechanism: Mechanism, q: ArrayLike, axes: str = "all") -> Array:
    """The largest singular value of the Jacobian over the smallest; infinite if that is zero."""
    sizes = _singular_values(mechanism, q, axes)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = sizes[..., 0] / sizes[..., -1]
    lost = sizes[..., -1] <= CUTOFF * sizes[..., 0]
    return np.asarray(np.where(lost, np.inf, found))


def joint_rates(
    mechanism: Mechanism, q: ArrayLike, velocity: ArrayLike, damping: ArrayLike = 0.0
) -> Rates:
    """The joint rates for a twist of the tip, or for rates of the task coordinates.

    Without damping these are the shortest rates with the least error, also where the Jacobian loses
    rank.  With damping they minimise ``|J qdot - velocity|^2 + damping^2 |qdot|^2``, and stay below
    ``|velocity| / (2 damping)`` near a singularity.
    """
    J = rate_jacobian(mechanism, q)
    wanted = np.asarray(velocity, dtype=float)
    if wanted.shape[-1:] != J.shape[-2:-1]:
        raise ValueError(f"velocity has shape {wanted.shape}, expected (..., {J.shape[-2]})")
    damped = np.asarray(damping, dtype=float)[..., None]
    finite = np.asarray(np.isfinite(J).all((-1, -2)))
    u, sizes, vt = np.linalg.svd(np.where(finite[..., None, None], J, 0.0), full_matrices=False)
    kept = sizes > CUTOFF * sizes[..., :1]
    with np.errstate(divide="ignore", invalid="ignore"):
        gain = np.where(kept | (damped > 0), sizes / (sizes**2 + damped**2), 0.0)
    along = (np.swapaxes(u, -1, -2) @ wanted[..., None])[..., 0]
    qdot = (np.swapaxes(vt, -1, -2) @ (gain * along)[..., None])[..., 0]
    good = finite & np.isfinite(wanted).all(-1)
    qdot = np.where(good[..., None], qdot, np.nan)
    error = wanted - (J @ qdot[..., None])[..., 0]
    status = np.where(kept.all(-1), OK, SINGULAR)
    status = np.broadcast_to(status, good.shape)
    return Rates(qdot, error, np.where(good, status, INVALID).astype(np.uint8))
