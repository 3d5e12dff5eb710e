"""The Stanford arm by other routes: its table in numbers, differences, Newton, singular poses."""

import importlib
from functools import cache

import arms
import numpy as np
import pytest
from arms import INVALID, OK, SINGULAR, UNREACHABLE, link, wrapped

from closedform.lower.program import lower

D2 = 0.154
EPSILONS = (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3)


@pytest.fixture(params=["numpy", "c"])
def robot(request: pytest.FixtureRequest):
    return importlib.import_module(f"closedform.generated.{request.param}.stanford_arm")


@pytest.fixture
def q() -> np.ndarray:
    return postures(2000)


def postures(n: int, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (n, 6))
    q[:, 2] = rng.uniform(-1, 1, n)
    return q


def by_table(q: np.ndarray, d2: float = D2) -> np.ndarray:
    """The product of the six Denavit-Hartenberg matrices."""
    h, zero = np.pi / 2, np.zeros(q.shape[:-1])
    rows = [(-h, zero, 0), (h, zero + d2, 1), (0, q[..., 2], None)]
    rows += [(-h, zero, 3), (h, zero, 4), (0, zero, 5)]
    T = np.eye(4)
    for alpha, d, joint in rows:
        T = T @ link(0, alpha, d, zero if joint is None else q[..., joint])
    return T


def distances(found: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Of each branch from a posture, the largest difference of a joint."""
    difference = found - q[:, None]
    turns = wrapped(difference)
    turns[..., 2] = difference[..., 2]
    return np.abs(turns).max(axis=-1)


def misses(solutions, T: np.ndarray, d2: float = D2) -> tuple[float, float]:
    return arms.misses(by_table(np.nan_to_num(solutions.q), d2), T, solutions.status)


def test_forward_and_names(robot, q) -> None:
    for d2 in (D2, 0.0, -0.3):
        np.testing.assert_allclose(robot.fk(q, (d2,)), by_table(q, d2), atol=2e-15)
    np.testing.assert_array_equal(robot.pose(q), robot.fk(q))
    assert robot.Parameters() == pytest.approx((D2,), abs=0)
    assert robot.JOINTS[2] == "d3" and len(robot.BRANCHES) == 8
    assert robot.BRANCHES[0] == "right_out_noflip" and robot.BRANCHES[-1] == "left_back_flip"


def test_jacobians_by_differences(robot, q) -> None:
    arms.check_jacobians(robot, by_table, q)
    J = robot.jacobian(q)
    det = np.linalg.det(J)
    np.testing.assert_allclose(robot.determinant(q), det, atol=1e-14)
    shoulder, boom, wrist = robot.singularities(q).T
    np.testing.assert_allclose(np.abs(shoulder * boom**2 * wrist), np.abs(det), atol=1e-14)


def test_no_branch_is_missing(robot) -> None:
    q = postures(100_000, 1)
    T = by_table(q)
    solutions = robot.ik(T)
    assert (solutions.status == OK).all()
    assert max(misses(solutions, T)) < 1e-13
    distance, det = distances(solutions.q, q), np.abs(robot.determinant(q))
    assert (distance.min(axis=1) * det).max() < 1e-11
    c1, s1 = np.cos(solutions.q[..., 0]), np.sin(solutions.q[..., 0])
    ahead = T[:, None, 0, 3] * c1 + T[:, None, 1, 3] * s1
    for branch, name in enumerate(robot.BRANCHES):
        shoulder, boom, flip = name.split("_")
        assert (ahead[:, branch] * {"right": 1, "left": -1}[shoulder] >= 0).all()
        assert (solutions.q[:, branch, 2] * {"out": 1, "back": -1}[boom] >= 0).all()
        assert (np.sin(solutions.q[:, branch, 4]) * {"noflip": 1, "flip": -1}[flip] >= 0).all()


@cache
def found_by_newton() -> list[tuple[np.ndarray, np.ndarray]]:
    """Targets, and the postures that numbers alone find from random starts."""
    return [(x, arms.newton(by_table, x, postures(500, 3))) for x in by_table(postures(5, 2))]


def test_newton_finds_the_same_eight_and_no_others(robot) -> None:
    for target, q in found_by_newton():
        distance = distances(np.broadcast_to(robot.ik(target).q, (len(q), 8, 6)), q)
        assert distance.min(axis=1).max() < 1e-7
        assert set(distance.argmin(axis=1)) == set(range(8))


@pytest.mark.parametrize("epsilon", EPSILONS)
@pytest.mark.parametrize("d2", [D2, 0.0])
@pytest.mark.parametrize("kind", ["wrist", "shoulder", "boom", "shoulder wrist", "boom wrist"])
def test_near_and_on_singularities(robot, kind: str, d2: float, epsilon: float) -> None:
    q, rng = postures(500, 4), np.random.default_rng(5)
    for joint, name in ((1, "shoulder"), (2, "boom"), (4, "wrist")):
        if name in kind:
            corner = 0 if name == "boom" else rng.choice([0, np.pi], 500)
            q[:, joint] = corner + epsilon * rng.choice([-1, 1], 500)
    T = by_table(q, d2)
    solutions = robot.ik(T, (d2,))
    assert np.isin(solutions.status, (OK, SINGULAR)).all()
    assert max(misses(solutions, T, d2)) < 1e-12


def test_statuses(robot, q) -> None:
    T = by_table(q, 0.0)
    T[:, :2, 3] = 0
    on_axis = robot.ik(T, (0.0,))
    assert (on_axis.status == SINGULAR).all() and (on_axis.q[..., 0] == 0).all()
    assert max(misses(on_axis, T, 0.0)) < 1e-13
    assert (robot.ik(T).status == UNREACHABLE).all() and np.isnan(robot.ik(T).q).all()
    T[:, 2, 3] = 0
    drawn_in = robot.ik(T, (0.0,))
    assert (drawn_in.status == SINGULAR).all() and (drawn_in.q[..., :3] == 0).all()
    pose = by_table(q[0])
    bad = [pose @ np.diag([1, 1, -1, 1]), 1.01 * pose, pose * np.nan]
    for i in range(4):
        bad += [np.where(np.arange(16).reshape(4, 4) == 5 * i, np.inf, pose)]
    assert (robot.ik(np.array(bad)).status == INVALID).all()
    assert (robot.ik(pose, (np.nan,)).status == INVALID).all()
    assert robot.ik(np.empty((0, 4, 4))).q.shape == (0, 8, 6)


def test_operation_counts() -> None:
    d = importlib.import_module("closedform.derivations.stanford_arm").d
    most = {"fk": 62, "jacobian": 34, "jacobian_space": 57, "jacobian_body": 55, "determinant": 3}
    for name, limit in most.items():
        operations = lower(d[name], d).operations()
        assert sum(n for kind, n in operations.items() if kind != "sincos") <= limit, name
    assert sum(lower(d["ik"], d).operations().values()) <= 364
