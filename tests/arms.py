"""Serial arms in plain numbers, for the tests of arms that have a pose as their task."""

import numpy as np

OK, UNREACHABLE, SINGULAR, INVALID = range(4)


def link(a: float, alpha: float, d: float, theta: np.ndarray) -> np.ndarray:
    c, s, ca, sa = np.cos(theta), np.sin(theta), np.cos(alpha), np.sin(alpha)
    T = np.zeros((*np.shape(theta), 4, 4))
    T[..., 0, 0], T[..., 0, 1], T[..., 0, 2], T[..., 0, 3] = c, -s * ca, s * sa, a * c
    T[..., 1, 0], T[..., 1, 1], T[..., 1, 2], T[..., 1, 3] = s, c * ca, -c * sa, a * s
    T[..., 2, 1], T[..., 2, 2], T[..., 2, 3], T[..., 3, 3] = sa, ca, d, 1
    return T


def wrapped(angle: np.ndarray) -> np.ndarray:
    return np.angle(np.exp(1j * angle))


def misses(reached: np.ndarray, T: np.ndarray, status: np.ndarray) -> tuple[float, float]:
    """The largest errors of all branches that were found: metres and radians."""
    found = np.isin(status, (OK, SINGULAR))
    away = np.linalg.norm((reached - T[..., None, :, :])[..., :3, 3], axis=-1)
    turned = reached[..., :3, :3].swapaxes(-1, -2) @ T[..., None, :3, :3]
    skew = (turned - turned.swapaxes(-1, -2)) / 2
    sine = np.linalg.norm(skew[..., [2, 0, 1], [1, 2, 0]], axis=-1)
    trace = np.trace(turned, axis1=-2, axis2=-1)
    angle = np.arctan2(sine, (trace - 1) / 2)
    return float(away[found].max(initial=0)), float(angle[found].max(initial=0))


def differences(f, q: np.ndarray, h: float = 1e-6) -> list[np.ndarray]:
    """The derivative of a pose by each joint, by central differences."""
    return [(f(q + s) - f(q - s)) / (2 * h) for s in h * np.eye(q.shape[-1])]


def newton(pose, target: np.ndarray, q: np.ndarray, steps: int = 60) -> np.ndarray:
    """Where Newton's method finds the target, from starts q, with a Jacobian by differences."""
    q, moving = q.copy(), np.arange(len(q))
    for _ in range(steps):
        at = q[moving]
        error = (pose(at) - target)[:, :3].reshape(-1, 12)
        missed = np.abs(error).max(axis=1) > 1e-14
        at, error, moving = at[missed], error[missed], moving[missed]
        J = np.stack([r[:, :3].reshape(-1, 12) for r in differences(pose, at)], -1)
        step = (np.linalg.pinv(J) @ error[..., None])[..., 0]
        size = np.linalg.norm(step, axis=-1, keepdims=True)
        q[moving] = at - step * np.minimum(1, 0.7 / np.maximum(size, 1e-300))
    return q[np.abs(pose(q) - target).max(axis=(-1, -2)) < 1e-10]


def turned_by(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """A rotation about a unit vector through the origin, as a pose."""
    return by_screws([(axis, np.zeros(3))], np.eye(4), np.asarray(angle)[..., None])


def twists(matrices: list[np.ndarray]) -> np.ndarray:
    """Columns (v; omega) of matrices of se(3)."""
    rows = [(0, 3), (1, 3), (2, 3), (2, 1), (0, 2), (1, 0)]
    return np.stack([np.stack([V[..., i, j] for i, j in rows], -1) for V in matrices], -1)


def check_jacobians(robot, pose, q: np.ndarray) -> None:
    """The three Jacobians of an arm against differences of a pose from elsewhere."""
    rates, inverse = differences(pose, q), np.linalg.inv(pose(q))
    space, body = twists([r @ inverse for r in rates]), twists([inverse @ r for r in rates])
    np.testing.assert_allclose(robot.jacobian_space(q), space, atol=1e-8)
    np.testing.assert_allclose(robot.jacobian_body(q), body, atol=1e-8)
    J = robot.jacobian(q)
    np.testing.assert_allclose(J[:, :3], np.stack([r[:, :3, 3] for r in rates], -1), atol=1e-8)
    np.testing.assert_allclose(J[:, 3:], space[:, 3:], atol=1e-8)


def by_screws(axes: list[tuple], home: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The pose by a product of exponentials: a unit vector and a point of each axis at zero."""
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))
    for (axis, point), angle in zip(axes, np.moveaxis(q, -1, 0), strict=True):
        K = np.cross(axis, np.eye(3)).T
        s, c = np.sin(angle)[..., None, None], np.cos(angle)[..., None, None]
        R = np.eye(3) + s * K + (1 - c) * K @ K
        step = np.zeros((*np.shape(angle), 4, 4))
        step[..., :3, :3], step[..., 3, 3] = R, 1
        step[..., :3, 3] = np.asarray(point) - R @ np.asarray(point)
        T = T @ step
    return T @ home
