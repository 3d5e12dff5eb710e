"""The Puma 560 by other routes: products of numbers, differences, Newton, singular poses."""

import importlib
from functools import cache

import arms
import numpy as np
import pytest
from arms import INVALID, OK, SINGULAR, UNREACHABLE, link, wrapped

from closedform.lower.program import lower

P = (0.4318, 0.0203, 0.15005, 0.4318)
CENTRED = (0.4318, 0.0203, 0.0, 0.4318)
EQUAL = (0.5, 0.3, 0.2, 0.4)
EQUAL_CENTRED = (0.5, 0.3, 0.0, 0.4)
EPSILONS = (0.0, 1e-16, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3)


@pytest.fixture(params=["numpy", "c"])
def robot(request: pytest.FixtureRequest):
    return importlib.import_module(f"closedform.generated.{request.param}.puma560")


@pytest.fixture
def q() -> np.ndarray:
    return np.random.default_rng(0).uniform(-np.pi, np.pi, (2000, 6))


def by_table(q: np.ndarray, params=P) -> np.ndarray:
    """The product of the six Denavit-Hartenberg matrices."""
    a2, a3, d3, d4 = params
    h = np.pi / 2
    rows = [(0, h, 0), (a2, 0, 0), (a3, -h, d3), (0, h, d4), (0, -h, 0), (0, 0, 0)]
    T = np.eye(4)
    for joint, row in enumerate(rows):
        T = T @ link(*row, q[..., joint])
    return T


def gaps(solutions: np.ndarray, q: np.ndarray) -> np.ndarray:
    """The distance of each branch from a posture, infinite where there is no branch."""
    difference = np.abs(wrapped(solutions - q[..., None, :])).max(axis=-1)
    return np.where(np.isnan(difference), np.inf, difference)


def misses(solutions, T: np.ndarray, params=P) -> tuple[float, float]:
    """The largest errors of all branches that were found: metres and radians."""
    return arms.misses(by_table(np.nan_to_num(solutions.q), params), T, solutions.status)


def test_names_and_defaults(robot) -> None:
    assert tuple(f"theta{i}" for i in range(1, 7)) == robot.JOINTS
    assert (
        tuple(
            f"{shoulder}_{elbow}_{wrist}"
            for shoulder in ("right", "left")
            for elbow in ("up", "down")
            for wrist in ("noflip", "flip")
        )
        == robot.BRANCHES
    )
    assert robot.SINGULARITIES == ("shoulder", "elbow", "wrist")
    assert robot.Parameters() == pytest.approx(P, abs=0)
    T = robot.fk(np.zeros(6))
    np.testing.assert_allclose(T[:3, 3], [0.4521, -0.15005, 0.4318], atol=1e-15)
    np.testing.assert_allclose(T[:3, :3], np.eye(3), atol=1e-15)


@pytest.mark.parametrize("params", [P, CENTRED, EQUAL, (0.3, -0.1, -0.2, 0.7)])
def test_forward_by_the_table(robot, q, params) -> None:
    expected = by_table(q, params)
    np.testing.assert_allclose(robot.fk(q, params), expected, atol=2e-15)
    np.testing.assert_array_equal(robot.pose(q, params), robot.fk(q, params))


def test_jacobians_by_differences(robot, q) -> None:
    arms.check_jacobians(robot, by_table, q)


def test_determinant_and_factors(robot, q) -> None:
    J = robot.jacobian(q)
    det = robot.determinant(q)
    np.testing.assert_allclose(det, np.linalg.det(J), atol=1e-14)
    shoulder, elbow, wrist = robot.singularities(q).T
    np.testing.assert_allclose(det, P[0] * shoulder * elbow * wrist, atol=1e-15)
    T = by_table(q)
    np.testing.assert_allclose(
        shoulder, T[:, 0, 3] * np.cos(q[:, 0]) + T[:, 1, 3] * np.sin(q[:, 0]), atol=1e-15
    )


def test_no_branch_is_missing(robot) -> None:
    q = np.random.default_rng(1).uniform(-np.pi, np.pi, (100_000, 6))
    T = by_table(q)
    solutions = robot.ik(T)
    assert (solutions.status == OK).all()
    away, turned = misses(solutions, T)
    assert away <= 1e-14 and turned <= 1e-13
    distance = gaps(solutions.q, q)
    det = np.abs(robot.determinant(q))
    assert (distance.min(axis=1) * det).max() < 1e-11
    good = det > 1e-3
    assert distance.min(axis=1)[good].max() < 1e-11


def test_branches_are_what_their_names_say(robot, q) -> None:
    T = by_table(q)
    found = robot.ik(T).q
    c1, s1 = np.cos(found[..., 0]), np.sin(found[..., 0])
    ahead = T[:, None, 0, 3] * c1 + T[:, None, 1, 3] * s1
    elbow = P[0] * np.exp(1j * found[..., 1])
    above = np.imag(elbow * np.conj(ahead + 1j * T[:, None, 2, 3])) * np.sign(ahead)
    for branch, name in enumerate(robot.BRANCHES):
        shoulder, bend, flip = name.split("_")
        assert (ahead[:, branch] * {"right": 1, "left": -1}[shoulder] >= 0).all()
        assert (above[:, branch] * {"up": 1, "down": -1}[bend] >= -1e-15).all()
        assert (np.sin(found[:, branch, 4]) * {"noflip": 1, "flip": -1}[flip] >= 0).all()


@cache
def found_by_newton() -> list[tuple[np.ndarray, np.ndarray]]:
    """Targets, and the postures that numbers alone find from random starts."""
    rng = np.random.default_rng(2)
    targets = by_table(rng.uniform(-np.pi, np.pi, (6, 6)))
    starts = rng.uniform(-np.pi, np.pi, (6, 600, 6))
    return [(x, wrapped(arms.newton(by_table, x, q))) for x, q in zip(targets, starts, strict=True)]


def test_newton_finds_the_same_eight_and_no_others(robot) -> None:
    for target, q in found_by_newton():
        solutions = robot.ik(target)
        distance = np.abs(wrapped(q[:, None] - solutions.q)).max(axis=-1)
        assert distance.min(axis=1).max() < 1e-7
        assert set(distance.argmin(axis=1)) == set(range(8))


def near(kind: str, epsilon: float, params, seed: int = 3) -> np.ndarray:
    """Random postures that are off one or several singularities by an angle."""
    a2, a3, _, d4 = params
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (500, 6))
    off = epsilon * rng.choice([-1, 1], (500, 3))
    forearm = np.arctan2(d4, a3)
    if "wrist" in kind:
        q[:, 4] = rng.choice([0, np.pi], 500) + off[:, 0]
    if "stretched" in kind:
        q[:, 2] = -forearm + off[:, 1]
    if "folded" in kind:
        q[:, 2] = np.pi - forearm + off[:, 1]
    if "shoulder" in kind:
        arm = a2 + (a3 + 1j * d4) * np.exp(1j * q[:, 2])
        q[:, 1] = rng.choice([-1, 1], 500) * np.pi / 2 - np.angle(arm) + off[:, 2]
    return q


@pytest.mark.parametrize("epsilon", EPSILONS)
@pytest.mark.parametrize("params", [P, CENTRED, EQUAL, EQUAL_CENTRED])
@pytest.mark.parametrize(
    "kind",
    [
        "wrist",
        "stretched",
        "folded",
        "shoulder",
        "shoulder wrist",
        "stretched wrist",
        "shoulder stretched",
        "shoulder folded wrist",
    ],
)
def test_near_and_on_singularities(robot, kind: str, params, epsilon: float) -> None:
    q = near(kind, epsilon, params)
    T = by_table(q, params)
    solutions = robot.ik(T, params)
    assert np.isin(solutions.status, (OK, SINGULAR)).all()
    away, turned = misses(solutions, T, params)
    assert away <= 1e-12 * sum(params) and turned <= 1e-12


def test_aligned_wrist(robot, q) -> None:
    """At well conditioned arms the posture comes back as singular, with theta4 = 0."""
    q[:, 4] = np.where(np.arange(len(q)) % 2, 0.0, np.pi)
    shoulder, elbow, _ = robot.singularities(q).T
    q = q[(np.abs(shoulder) > 0.2) & (np.abs(elbow) > 0.2)]
    solutions = robot.ik(by_table(q))
    arm = np.abs(wrapped(solutions.q - q[:, None]))[..., :3].max(axis=-1) < 1e-9
    assert (arm.sum(axis=1) == 2).all()
    assert (solutions.status[arm] == SINGULAR).mean() > 0.99
    assert (solutions.status[~arm] == OK).all()
    aligned = solutions.status == SINGULAR
    assert (solutions.q[aligned][:, 3] == 0).all()
    middle = np.abs(wrapped(solutions.q[..., 4] - q[:, None, 4]))
    assert middle[aligned].max() < 1e-12


def test_wrist_on_the_base_axis(robot) -> None:
    T = by_table(near("shoulder", 0.0, CENTRED), CENTRED)
    T[:, :2, 3] = 0.0
    solutions = robot.ik(T, CENTRED)
    assert (solutions.status == SINGULAR).all()
    assert (solutions.q[..., 0] == 0).all()
    assert max(misses(solutions, T, CENTRED)) < 1e-14
    assert (robot.ik(T).status == UNREACHABLE).all()


def test_inside_the_cylinder_and_on_it(robot) -> None:
    """Within d3 of the base axis nothing can be reached; on this cylinder the shoulders merge."""
    T = by_table(near("shoulder", 0.0, P))
    solutions = robot.ik(T)
    np.testing.assert_allclose(solutions.q[:, :4, 0], solutions.q[:, 4:, 0], atol=1e-7)
    T[:, :2, 3] *= 1 - 1e-9
    solutions = robot.ik(T)
    assert (solutions.status == UNREACHABLE).all() and np.isnan(solutions.q).all()
    T[:, :2, 3] *= 1 + 2e-9
    assert (robot.ik(T).status == OK).all()


@pytest.mark.parametrize("kind", ["stretched", "folded"])
def test_branches_merge_at_the_elbow(robot, kind: str) -> None:
    """Stretched exactly, or slightly beyond: both elbows are returned, and are equal."""
    q = near(kind, 0.0, P)
    T = by_table(q)
    T[:, :3, :3] = np.eye(3)
    length = np.hypot(P[1], P[3])
    reach = P[0] + length if kind == "stretched" else length - P[0]
    side, up = np.cos(q[:, 1]) * reach, np.sin(q[:, 1]) * reach
    rounding = 1 + (1e-13 if kind == "stretched" else -1e-13)
    T[:, 0, 3], T[:, 1, 3], T[:, 2, 3] = side * rounding, -P[2], up * rounding
    solutions = robot.ik(T)
    assert (solutions.status == OK).all()
    np.testing.assert_allclose(solutions.q[:, [0, 4]], solutions.q[:, [2, 6]], atol=2e-5)
    T[:, [0, 2], 3] *= 1 + (1e-9 if kind == "stretched" else -1e-9) / reach
    assert (robot.ik(T).status == UNREACHABLE).all()


def test_folded_on_the_shoulder(robot) -> None:
    """Equal links, the wrist on the shoulder: theta2 is free."""
    T = by_table(near("folded", 0.0, EQUAL_CENTRED), EQUAL_CENTRED)
    T[:, :3, 3] = 0.0
    solutions = robot.ik(T, EQUAL_CENTRED)
    assert (solutions.status == SINGULAR).all()
    assert (solutions.q[..., 1] == 0).all()
    assert max(misses(solutions, T, EQUAL_CENTRED)) < 1e-13


@pytest.mark.parametrize("params", [(0.0, 0.1, 0.2, 0.4), (0.5, 0.0, 0.2, 0.0)])
def test_a_missing_link(robot, q, params) -> None:
    T = by_table(q, params)
    solutions = robot.ik(T, params)
    assert (solutions.status == SINGULAR).all()
    assert max(misses(solutions, T, params)) < 1e-12


def test_what_is_no_pose_is_invalid(robot, q) -> None:
    T = by_table(q[0])
    bad = []
    for i in range(4):
        for j in range(4):
            for value in (np.nan, np.inf, -np.inf):
                bad.append(T.copy())
                bad[-1][i, j] = value
    bad += [T @ np.diag([1, 1, -1, 1]), T @ np.diag([1.001, 1.001, 1.001, 1]), 2 * T, 0 * T]
    bad.append(T + np.array([[0] * 4] * 3 + [[0, 0, 1e-3, 0]]))
    solutions = robot.ik(np.array(bad))
    assert (solutions.status == INVALID).all() and np.isnan(solutions.q).all()
    for params in [
        (-0.4, 0, 0, 0.4),
        (0.4, 0, 0, -0.4),
        (0.4, np.nan, 0, 0.4),
        (0.4, 0, np.inf, 0.4),
    ]:
        assert (robot.ik(T, params).status == INVALID).all()


def test_offsets_may_be_negative(robot, q) -> None:
    params = (0.4, -0.05, -0.2, 0.5)
    T = by_table(q, params)
    solutions = robot.ik(T, params)
    assert (solutions.status == OK).all()
    assert max(misses(solutions, T, params)) < 1e-12


def test_out_of_reach(robot) -> None:
    T = np.eye(4)
    T[:3, 3] = 0.0, 0.5, 1.0
    solutions = robot.ik(T)
    assert (solutions.status == UNREACHABLE).all() and np.isnan(solutions.q).all()


def test_empty_and_strided_batches(robot, q) -> None:
    assert robot.ik(np.empty((0, 4, 4))).q.shape == (0, 8, 6)
    T = by_table(q)
    every = robot.ik(T)
    backward = robot.ik(T[::-2])
    np.testing.assert_allclose(backward.q, every.q[::-2], atol=1e-8)
    transposed = np.ascontiguousarray(T.swapaxes(-1, -2)).swapaxes(-1, -2)
    np.testing.assert_array_equal(robot.ik(transposed).status, every.status)
    one = robot.ik(T[5])
    np.testing.assert_allclose(one.q, every.q[5], atol=1e-12)


def test_operation_counts() -> None:
    """The best of the peers take 117 and 143 for the pose and the Jacobian."""
    d = importlib.import_module("closedform.derivations.puma560").d

    def counted(name: str) -> int:
        operations = lower(d[name], d).operations()
        assert set(operations) <= {"add", "sub", "mul", "sincos"} and operations["sincos"] <= 6
        return sum(n for kind, n in operations.items() if kind != "sincos")

    assert counted("fk") <= 76
    assert counted("jacobian") <= 50
    assert counted("jacobian_space") <= 94
    assert counted("jacobian_body") <= 87
    assert counted("determinant") <= 17
    inverse = lower(d["ik"], d).operations()
    assert sum(inverse.values()) <= 507
    assert inverse["atan2"] <= 20 and inverse["sqrt"] <= 11 and inverse["div"] <= 11
