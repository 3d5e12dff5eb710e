"""Arms of seven joints with a spherical shoulder and wrist, by the arm angle: the KUKA LBR iiwa.

    >>> from closedform import robots
    >>> from closedform.robots import seven_joints
    >>> arm = robots.load("iiwa7").parameters
    >>> q = [0.3, 0.8, -0.4, 1.1, 0.5, -0.7, 0.2]
    >>> T, psi = seven_joints.fk(q, arm), seven_joints.arm_angle(q, arm)
    >>> found = seven_joints.ik(T, psi, arm)
    >>> bool(np.isclose(found.q, q).all(-1).any())
    True

The names are those of a generated module, so that a `Robot` takes it as one.
At zero the arm points up along z.  The joints 1, 3, 5 and 7 turn about z, the joints 2 and 6 about
y, and joint 4 about -y.  The inverse needs the pose and the arm angle.  It is composed of modules
that are proved: ``planar_2r`` gives the elbow, ``spherical_wrist`` the shoulder and the wrist.

The arm angle psi: let w be the line from the shoulder to the centre of the wrist, at the azimuth
phi and the angle chi from z, 0 <= chi <= pi.  Turn the axis of the elbow and w together, so that w
is z: what remains is Rz(phi) Ry(chi) Rz(psi).  At psi = 0 the axis of the elbow is normal to the
plane of z and w, as at theta3 = 0 with 0 <= chi.  Joints beyond that are at psi = pi.  The angle
also exists where the arm is stretched, because the axis of the elbow gives it.  If w is along z
that plane is undefined: the plane of x and z takes its place, and the status is SINGULAR.

After M. Shimizu et al., Analytical inverse kinematic computation for 7-DOF redundant manipulators
with joint limits and its application to redundancy resolution, IEEE Trans. Robotics 24(5), 2008.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from closedform.generated.numpy import planar_2r, spherical_wrist
from closedform.generated.numpy._runtime import Skeleton, SkeletonJoint, Solutions, Status

Floats = NDArray[np.float64]

__all__ = [
    "ASSEMBLY_MODES",
    "BRANCHES",
    "JOINTS",
    "SKELETON",
    "TASK",
    "Parameters",
    "Solutions",
    "Status",
    "arm_angle",
    "fk",
    "ik",
    "jacobian_body",
    "jacobian_space",
    "pose",
    "skeleton",
]

JOINTS = tuple(f"theta{i}" for i in range(1, 8))
TASK = tuple(f"T{i}{j}" for i in range(1, 5) for j in range(1, 5))
ASSEMBLY_MODES = ()
BRANCHES = tuple(
    f"{elbow}_{shoulder}_{wrist}"
    for elbow in ("elbow_negative", "elbow_positive")
    for shoulder in ("shoulder_positive", "shoulder_negative")
    for wrist in ("wrist_positive", "wrist_negative")
)
"""The signs of sin(theta4), sin(theta2) and sin(theta6)."""

ALONG_Z = 1e-14
"""The sine of the angle between w and z below which the reference plane is undefined.  Roundings of
the pose already leave this much."""


class Parameters(NamedTuple):
    """The lengths of an arm, in m, by default those of the LBR iiwa 7 R800."""

    d_bs: float = 0.34
    """From the base up to the shoulder."""
    d_se: float = 0.4
    """From the shoulder to the elbow."""
    d_ew: float = 0.4
    """From the elbow to the wrist."""
    d_wf: float = 0.126
    """From the wrist to the flange."""


_DEFAULT = Parameters()
SKELETON = Skeleton(
    points=("base", "shoulder", "elbow", "wrist", "flange"),
    links={
        "column": ("base", "shoulder"),
        "upper_arm": ("shoulder", "elbow"),
        "forearm": ("elbow", "wrist"),
        "hand": ("wrist", "flange"),
    },
    joints={
        name: SkeletonJoint("revolute", (point,))
        for name, point in zip(
            JOINTS,
            ("base", "shoulder", "shoulder", "elbow", "elbow", "wrist", "wrist"),
            strict=True,
        )
    },
    hand="flange",
    ground=("base", "shoulder"),
)


def fk(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """Pose of the flange, (..., 4, 4), of the joints ``q``, (..., 7), in radians."""
    joints = _joints(q)
    shoulder, wrist = (spherical_wrist.fk(joints[..., part]) for part in (_SHOULDER, _WRIST))
    forearm = shoulder @ _about_y(-joints[..., 3])
    hand = forearm @ wrist
    T = np.zeros((*joints.shape[:-1], 4, 4))
    T[..., :3, :3] = hand
    T[..., :3, 3] = (
        params.d_se * shoulder[..., 2] + params.d_ew * forearm[..., 2] + params.d_wf * hand[..., 2]
    )
    T[..., 2, 3] += params.d_bs
    T[..., 3, 3] = 1
    return T


def pose(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """Pose of the flange, as ``fk``."""
    return fk(q, params)


def skeleton(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """The points of ``SKELETON`` in the base frame, (..., 5, 3), of the joints ``q``, (..., 7)."""
    joints = _joints(q)
    upper = spherical_wrist.fk(joints[..., _SHOULDER])
    forearm = upper @ _about_y(-joints[..., 3])
    points = np.zeros((*joints.shape[:-1], 5, 3))
    points[..., 1:, 2] = params.d_bs
    points[..., 2:, :] += params.d_se * upper[..., None, :, 2]
    points[..., 3:, :] += params.d_ew * forearm[..., None, :, 2]
    points[..., 4, :] = fk(joints, params)[..., :3, 3]
    return points


def jacobian_space(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """Twist (v; omega) of the flange per joint rate in the base frame, (..., 6, 7).

    ``q`` are the joints, (..., 7), in radians.  v is the velocity of the point of the flange that
    is now at the origin of the base.
    """
    joints = _joints(q)
    shoulder = spherical_wrist.fk(joints[..., _SHOULDER])
    forearm = shoulder @ _about_y(-joints[..., 3])
    first = spherical_wrist.jacobian_space(joints[..., _SHOULDER])
    last = forearm @ spherical_wrist.jacobian_space(joints[..., _WRIST])
    axes = np.concatenate([first, -shoulder[..., 1:2], last], axis=-1)
    points = np.zeros_like(axes)
    points[..., 2, :] = params.d_bs
    points[..., 3:] += params.d_se * shoulder[..., 2:]
    points[..., 4:] += params.d_ew * forearm[..., 2:]
    return np.concatenate([np.cross(points, axes, axis=-2), axes], axis=-2)


def jacobian_body(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """Twist (v; omega) of the flange per joint rate in its own frame, (..., 6, 7).

    ``q`` are the joints, (..., 7), in radians.  v is the velocity of the flange.
    """
    T, space = fk(q, params), jacobian_space(q, params)
    back, omega = np.swapaxes(T[..., :3, :3], -1, -2), space[..., 3:, :]
    v = space[..., :3, :] - np.cross(T[..., :3, 3:], omega, axis=-2)
    return np.concatenate([back @ v, back @ omega], axis=-2)


def arm_angle(q: ArrayLike, params: Parameters = _DEFAULT) -> Floats:
    """The arm angle psi, (...), in (-pi, pi], of the joints ``q``, (..., 7), in radians.

    If w is along z the plane of x and z is the reference.
    """
    joints = _joints(q)
    elbow = joints[..., 3]
    along = params.d_se + params.d_ew * np.cos(elbow)
    tilt = np.arctan2(-params.d_ew * np.sin(elbow), along)
    turned = spherical_wrist.fk(joints[..., _SHOULDER]) @ _about_y(tilt)
    reference = _reference(turned[..., 2])[0]
    rest = np.swapaxes(reference, -1, -2) @ turned
    angle: Floats = np.arctan2(rest[..., 1, 0], rest[..., 0, 0])
    return angle


def ik(T: ArrayLike, arm_angle: ArrayLike, params: Parameters = _DEFAULT) -> Solutions:
    """All 8 postures of a pose ``T``, (..., 4, 4), at the arm angle, (...), in radians.

    Returns ``Solutions``: ``q`` (..., 8, 7) in (-pi, pi] and ``status`` (..., 8), in the order of
    ``BRANCHES``.

    UNREACHABLE: the wrist would be too far from the shoulder, or too near.
    SINGULAR: w is along z; the arm is folded so that the wrist is on the shoulder, and w = z is
    taken; the axes 1 and 3 coincide, theta1 = 0 is returned; the axes 5 and 7 coincide, theta5 = 0
    is returned.  The answers reach the pose.
    INVALID: ``T`` is not a homogeneous transform, the arm angle is not finite, or ``d_se`` or
    ``d_ew`` is negative.
    """
    pose, angle = np.asarray(T, dtype=float), np.asarray(arm_angle, dtype=float)
    if pose.shape[-2:] != (4, 4):
        raise ValueError(f"T has the shape {pose.shape}; expected (..., 4, 4)")
    leading = np.broadcast_shapes(pose.shape[:-2], angle.shape)
    pose, angle = np.broadcast_to(pose, (*leading, 4, 4)), np.broadcast_to(angle, leading)
    hand = pose[..., :3, :3]
    w = pose[..., :3, 3] - params.d_wf * hand[..., 2]
    w[..., 2] -= params.d_bs
    distance = np.linalg.norm(w, axis=-1)
    ahead = np.stack([distance, np.zeros_like(distance)], axis=-1)
    elbow = planar_2r.ik(ahead, planar_2r.Parameters(params.d_se, params.d_ew))
    folded = distance[..., None] == 0
    upwards = np.where(folded, [0.0, 0.0, 1.0], w) / np.where(folded, 1, distance[..., None])
    reference, undefined = _reference(upwards)
    zero = np.zeros_like(angle)
    plane = reference @ spherical_wrist.fk(np.stack([zero, zero, angle], axis=-1))

    # One axis each for the elbow, the shoulder and the wrist
    upper = plane[..., None, :, :] @ _about_y(elbow.q[..., 0])
    forearm = upper @ _about_y(elbow.q[..., 1])
    shoulder = spherical_wrist.ik(upper)
    wrist = spherical_wrist.ik(np.swapaxes(forearm, -1, -2) @ hand[..., None, :, :])
    q = np.empty((*leading, 2, 2, 2, 7))
    q[..., _SHOULDER] = shoulder.q[..., :, :, None, :]
    q[..., 3] = -elbow.q[..., :, None, None, 1]
    q[..., _WRIST] = wrist.q[..., :, None, :, :]
    q[..., 3][q[..., 3] == -np.pi] = np.pi

    reached = elbow.status[..., :, None, None]
    singular = (
        (reached == Status.SINGULAR)
        | undefined[..., None, None, None]
        | (shoulder.status[..., :, :, None] == Status.SINGULAR)
        | (wrist.status[..., :, None, :] == Status.SINGULAR)
    )
    status = np.where(singular, Status.SINGULAR, Status.OK)
    status = np.where(reached == Status.UNREACHABLE, Status.UNREACHABLE, status)
    last = (pose[..., 3, :] == [0, 0, 0, 1]).all(-1) & np.isfinite(angle) & np.isfinite(w).all(-1)
    proper = spherical_wrist.ik(hand).status[..., 0] != Status.INVALID
    invalid = ~(last & proper)[..., None, None, None] | (reached == Status.INVALID)
    status = np.where(invalid, Status.INVALID, status).astype(np.uint8)
    q[(status == Status.UNREACHABLE) | (status == Status.INVALID)] = np.nan
    return Solutions(q.reshape(*leading, 8, 7), status.reshape(*leading, 8))


_SHOULDER, _WRIST = slice(0, 3), slice(4, 7)


def _joints(q: ArrayLike) -> Floats:
    joints = np.asarray(q, dtype=float)
    if joints.shape[-1:] != (7,):
        raise ValueError(f"q has the shape {joints.shape}; expected (..., 7)")
    return joints


def _about_y(angle: Floats) -> Floats:
    zero = np.zeros_like(angle)
    rotation: Floats = spherical_wrist.fk(np.stack([zero, angle, zero], axis=-1))
    return rotation


def _reference(w: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Rz(phi) Ry(chi), whose third column is the unit vector ``w``, and where phi is undefined."""
    across = np.hypot(w[..., 0], w[..., 1])
    undefined = across <= ALONG_Z
    azimuth = np.where(undefined, 0, np.arctan2(w[..., 1], w[..., 0]))
    chi = np.arctan2(across, w[..., 2])
    rotation = spherical_wrist.fk(np.stack([azimuth, chi, np.zeros_like(chi)], axis=-1))
    return rotation, undefined
