"""The palletiser by other routes: matrix exponentials, finite differences, integration."""

import csv
import importlib
import math
from importlib.resources import files

import numpy as np
import pytest

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
L = (0.100, 0.615, 0.705, 0.650, 0.181, 0.120)
EQUAL = (0.3, 0.5, 0.7, 0.7, 0.2, 0.1)
SIZE = sum(L)
M = np.array([[1, 0, 0, 0], [0, 1, 0, 0], [0, -1, 1, 0], [0, 0, 0, 1]])


@pytest.fixture(params=["numpy", "c"])
def robot(request: pytest.FixtureRequest):
    return importlib.import_module(f"closedform.generated.{request.param}.irb260")


@pytest.fixture
def q() -> np.ndarray:
    return np.random.default_rng(0).uniform(-np.pi, np.pi, (300, 4))


def expm(A: np.ndarray) -> np.ndarray:
    """Taylor's series after scaling, then squared back."""
    halvings = max(0, math.ceil(math.log2(np.linalg.norm(A) + 1e-9)) + 2)
    A = A / 2**halvings
    term = total = np.eye(4)
    for k in range(1, 20):
        term = term @ A / k
        total = total + term
    return np.linalg.matrix_power(total, 2**halvings)


def twist_matrix(w, p) -> np.ndarray:
    x, y, z = w
    hat = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    T = np.zeros((4, 4))
    T[:3, :3], T[:3, 3] = hat, -np.cross(w, p)
    return T


def by_exponentials(q: np.ndarray, lengths=L) -> np.ndarray:
    """Eq. (12) as printed, with numbers."""
    l1, l2, l3, l4, l5, l6 = lengths
    up, across = (0, 0, 1), (-1, 0, 0)
    points = [
        (0, 0, 1),
        (0, l1, l2),
        (0, l1, l2 + l3),
        (0, l1 + l4, l2 + l3),
        (0, l1 + l4 + l6, l2 + l3 - l5),
    ]
    angles = [q[0], q[1], q[2], -(q[1] + q[2]), q[3]]
    T = np.eye(4)
    for w, p, angle in zip([up, across, across, across, up], points, angles, strict=True):
        T = T @ expm(twist_matrix(w, p) * angle)
    home = np.eye(4)
    home[:3, 3] = points[4]
    return T @ home


def differences(f, q: np.ndarray, h: float = 1e-6) -> np.ndarray:
    """Central differences of f by every joint, in the last axis."""
    steps = h * np.eye(4)
    return np.stack([(f(q + s) - f(q - s)) / (2 * h) for s in steps], axis=-1)


def wrapped(angle: np.ndarray) -> np.ndarray:
    return np.angle(np.exp(1j * angle))


def missed(robot, solutions, x, params=L) -> float:
    """The largest miss of all reachable branches, metres and radians; their angles are wrapped."""
    found = np.isin(solutions.status, (OK, SINGULAR))
    angles = solutions.q[found]
    assert (angles > -np.pi).all() and (angles <= np.pi).all()
    error = robot.fk(np.where(found[..., None], solutions.q, 0.0), params) - x[..., None, :]
    error[..., 3] = wrapped(error[..., 3])
    return float(np.abs(error[found]).max(initial=0.0))


def test_names_and_defaults(robot) -> None:
    assert robot.JOINTS == ("theta1", "theta2", "theta3", "theta5")
    assert robot.TASK == ("x", "y", "z", "yaw")
    assert robot.BRANCHES == (
        "front_elbow_up",
        "front_elbow_down",
        "back_elbow_up",
        "back_elbow_down",
    )
    assert robot.SINGULARITIES == ("base axis", "elbow")
    assert robot.Parameters() == pytest.approx(L, abs=0)
    np.testing.assert_allclose(robot.fk(np.zeros(4)), [0, 0.87, 1.139, 0], atol=1e-15)


def test_forward_by_matrix_exponentials(robot, q) -> None:
    poses = np.array([by_exponentials(row) for row in q])
    np.testing.assert_allclose(robot.pose(q), poses, atol=1e-13)
    x = robot.fk(q)
    np.testing.assert_allclose(x[:, :3], poses[:, :3, 3], atol=1e-13)
    np.testing.assert_allclose(x[:, 3], np.arctan2(poses[:, 1, 0], poses[:, 0, 0]), atol=1e-13)
    other = np.array([by_exponentials(row, EQUAL) for row in q])
    np.testing.assert_allclose(robot.pose(q, EQUAL), other, atol=1e-13)


def test_yaw_lies_in_the_half_open_interval(robot) -> None:
    q = np.zeros((5, 4))
    q[:, 0] = [np.pi, -np.pi, 2.0, 1e6, 3 * np.pi]
    q[:, 3] = [np.pi, 0.0, 2.0, 1e6, 0.0]
    yaw = robot.fk(q)[:, 3]
    assert (yaw > -np.pi).all() and (yaw <= np.pi).all()
    np.testing.assert_allclose(np.exp(1j * yaw), np.exp(1j * (q[:, 0] + q[:, 3])), atol=1e-9)


def test_every_posture_is_among_the_branches(robot, q) -> None:
    x = robot.fk(q)
    solutions = robot.ik(x)
    assert missed(robot, solutions, x) < 1e-14
    gap = np.abs(wrapped(solutions.q - q[:, None])).max(axis=-1)
    assert np.nanmin(gap, axis=1).max() < 1e-10
    rho = x[:, 1] * np.cos(q[:, 0]) - x[:, 0] * np.sin(q[:, 0])
    branch = 2 * (rho < 0) + (np.cos(q[:, 2]) < 0)
    np.testing.assert_array_equal(np.nanargmin(gap, axis=1), branch)


def test_four_distinct_branches(robot) -> None:
    """Near the base axis all four reach, and their signs are those of their names."""
    rng = np.random.default_rng(1)
    angle, r = rng.uniform(-np.pi, np.pi, 500), rng.uniform(0.01, 0.2, 500)
    z, yaw = rng.uniform(0.6, 1.3, 500), rng.uniform(-np.pi, np.pi, 500)
    x = np.stack([r * np.cos(angle), r * np.sin(angle), z, yaw], axis=-1)
    solutions = robot.ik(x)
    assert (solutions.status == OK).all()
    assert missed(robot, solutions, x) < 1e-14
    q1, q3 = solutions.q[..., 0], solutions.q[..., 2]
    rho = x[:, None, 1] * np.cos(q1) - x[:, None, 0] * np.sin(q1)
    np.testing.assert_array_equal(np.sign(rho), np.tile([1, 1, -1, -1], (500, 1)))
    np.testing.assert_array_equal(np.sign(np.cos(q3)), np.tile([1, -1, 1, -1], (500, 1)))
    for a in range(4):
        for b in range(a):
            apart = np.abs(wrapped(solutions.q[:, a] - solutions.q[:, b])).max(axis=-1)
            assert apart.min() > 1e-3


def moved(axis: str, angle: np.ndarray, shift) -> np.ndarray:
    """Turn about a coordinate axis, then go on along the turned axes."""
    i, j = {"x": (1, 2), "z": (0, 1)}[axis]
    T = np.broadcast_to(np.eye(4), (*angle.shape, 4, 4)).copy()
    T[..., i, i] = T[..., j, j] = np.cos(angle)
    T[..., j, i] = np.sin(angle)
    T[..., i, j] = -np.sin(angle)
    T[..., :3, 3] = T[..., :3, :3] @ np.asarray(shift, dtype=float)
    return T


def by_links(q: np.ndarray, lengths=L) -> np.ndarray:
    """x, y, z, yaw, link by link along the arm."""
    l1, l2, l3, l4, l5, l6 = lengths
    q1, q2, q3, q5 = np.moveaxis(q, -1, 0)
    T = moved("z", q1, (0, l1, l2)) @ moved("x", -q2, (0, 0, l3)) @ moved("x", -q3, (0, l4, 0))
    T = T @ moved("x", q2 + q3, (0, l6, -l5)) @ moved("z", q5, (0, 0, 0))
    yaw = np.arctan2(T[..., 1, 0], T[..., 0, 0])
    return np.concatenate([T[..., :3, 3], yaw[..., None]], axis=-1)


@pytest.mark.parametrize("params", [L, EQUAL, (2.0, 0.1, 0.3, 0.9, 0.4, 1.5)])
def test_newton_finds_no_other_solution(robot, params) -> None:
    """Newton's method from many starts, on the arm built link by link."""

    def gap(q: np.ndarray) -> np.ndarray:
        miss = by_links(q, params) - x
        miss[..., 3] = wrapped(miss[..., 3])
        return miss

    rng = np.random.default_rng(9)
    x = by_links(rng.uniform(-np.pi, np.pi, (6, 1, 4)), params)
    q = np.tile(rng.uniform(-np.pi, np.pi, (1, 60, 4)), (6, 1, 1))
    for _ in range(60):
        steps = 1e-6 * np.eye(4)
        J = np.stack([wrapped(gap(q + s) - gap(q - s)) / 2e-6 for s in steps], axis=-1)
        J = J + 1e-9 * np.eye(4)  # no start is exactly singular
        step = np.linalg.solve(J, -gap(q)[..., None])[..., 0]
        length = np.linalg.norm(step, axis=-1, keepdims=True)
        q = q + step / np.maximum(1, 2 * length)
    solved = np.abs(gap(q)).max(axis=-1) < 1e-10
    solutions = robot.ik(x[:, 0], params)
    reached = (solutions.status == OK)[:, None]
    known = np.where(reached[..., None], solutions.q[:, None], 0.0)
    apart = np.abs(wrapped(known - q[:, :, None])).max(axis=-1)
    apart = np.where(reached, apart, np.inf)
    assert solved.sum() > 60
    assert apart.min(axis=-1)[solved].max() < 1e-6
    nearest = apart.argmin(axis=-1)
    for k in range(6):
        assert set(nearest[k][solved[k]]) == set(np.flatnonzero(solutions.status[k] == OK))


@pytest.mark.parametrize("params", [L, EQUAL])
@pytest.mark.parametrize("small", [0.0, 1e-16, 1e-15, 1e-14, 1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize("where", ["stretched", "folded", "base axis"])
def test_near_the_singular_set(robot, where: str, small: float, params) -> None:
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (400, 4))
    if where == "base axis":
        # A posture whose hand is on the axis, moved off it by a little.
        z = np.random.default_rng(3).uniform(0.6, 1.1, 400)
        bearing, yaw = q[:, 0], q[:, 3]
        x = np.stack([small * np.cos(bearing), small * np.sin(bearing), z, yaw], axis=-1)
    else:
        q[:, 2] = (np.pi / 2 if where == "folded" else -np.pi / 2) + small
        x = robot.fk(q, params)
    solutions = robot.ik(x, params)
    found = np.isin(solutions.status, (OK, SINGULAR))
    assert found.any(axis=1).all()
    assert missed(robot, solutions, x, params) < 1e-12 * sum(params)
    if where == "base axis":
        assert found[:, 0].all() and found[:, 2].all()
        if small <= 1e-16:
            assert (solutions.status[found] == SINGULAR).all()
            np.testing.assert_array_equal(solutions.q[found][:, 0], 0.0)
            np.testing.assert_array_equal(solutions.q[:, 0, 0], solutions.q[:, 2, 0])
        if small >= 1e-12:
            assert (solutions.status[found] == OK).all()
    if where == "folded" and params is EQUAL and small == 0.0:
        reached = x[:, 1] * np.cos(q[:, 0]) - x[:, 0] * np.sin(q[:, 0])
        np.testing.assert_allclose(reached, 0.4, atol=1e-15)
        assert (solutions.status[:, :2] == SINGULAR).all()
        np.testing.assert_array_equal(solutions.q[:, :2, 1], 0.0)


@pytest.mark.parametrize("reach", [L[2] + L[3], L[2] - L[3]])
def test_on_the_boundary(robot, reach: float) -> None:
    direction, bearing = np.random.default_rng(4).uniform(-np.pi, np.pi, (2, 2000))
    outward = 1 + 1e-9 if reach > 1 else 1 - 1e-9

    def target(reach: float) -> np.ndarray:
        rho = L[0] + L[5] + reach * np.cos(direction)
        z = L[1] - L[4] + reach * np.sin(direction)
        return np.stack([-rho * np.sin(bearing), rho * np.cos(bearing), z, bearing], axis=-1)

    x = target(reach)
    solutions = robot.ik(x)
    assert (solutions.status == OK).any(axis=1).all()
    assert missed(robot, solutions, x) < 1e-12 * SIZE
    facing = L[0] + L[5] + reach * np.cos(direction) > 1e-3
    assert (solutions.status[facing, :2] == OK).all()
    beyond = robot.ik(target(reach * outward))
    assert (beyond.status[facing, :2] == UNREACHABLE).all()
    assert np.isnan(beyond.q[facing, :2]).all()


def test_impossible_input(robot) -> None:
    x = robot.fk([0.1, 0.2, 0.3, 0.4])
    for k in range(4):
        for bad in (np.nan, np.inf, -np.inf):
            moved = x.copy()
            moved[k] = bad
            assert (robot.ik(moved).status == INVALID).all()
    for k in range(6):
        for bad in (-0.1, np.nan, np.inf):
            lengths = list(L)
            lengths[k] = bad
            solutions = robot.ik(x, tuple(lengths))
            assert (solutions.status == INVALID).all() and np.isnan(solutions.q).all()


def test_arms_without_length(robot) -> None:
    for l3, l4, theta2 in [(0.0, 0.7, 0.4), (0.7, 0.0, 0.4), (0.7, 1e-17, 0.6), (0.0, 0.0, 0.4)]:
        params = (0.1, 0.6, l3, l4, 0.2, 0.1)
        x = robot.fk([0.3, theta2, 0.5, 0.6], params)
        solutions = robot.ik(x, params)
        assert (solutions.status[:2] == SINGULAR).all()
        assert missed(robot, solutions, x, params) < 1e-15
        np.testing.assert_array_equal(solutions.q[:2, 2], -np.pi / 2)
        np.testing.assert_array_equal(solutions.q[0], solutions.q[1])


def test_jacobians_by_differences(robot, q) -> None:
    def task(q):
        x = robot.fk(q)
        return np.concatenate([x[..., :3], np.sin(x[..., 3:]), np.cos(x[..., 3:])], axis=-1)

    rates, yaw = differences(task, q), robot.fk(q)[:, 3, None]
    yaw_rates = rates[:, 3] * np.cos(yaw) - rates[:, 4] * np.sin(yaw)
    J = robot.jacobian(q)
    np.testing.assert_allclose(J[:, :3], rates[:, :3], atol=1e-8)
    np.testing.assert_allclose(J[:, 3], yaw_rates, atol=1e-8)
    np.testing.assert_allclose(robot.determinant(q), np.linalg.det(J), atol=1e-14)
    rho, bend = robot.singularities(q).T
    np.testing.assert_allclose(robot.determinant(q), L[2] * L[3] * rho * bend, atol=1e-15)

    T, dT = robot.pose(q), np.moveaxis(differences(robot.pose, q), -1, 0)
    for name, velocity in (
        ("jacobian_space", lambda slope: slope @ np.linalg.inv(T)),
        ("jacobian_body", lambda slope: np.linalg.inv(T) @ slope),
    ):
        V = [velocity(slope) for slope in dT]
        columns = [np.concatenate([v[:, :3, 3], v[:, [2, 0, 1], [1, 2, 0]]], axis=-1) for v in V]
        np.testing.assert_allclose(getattr(robot, name)(q), np.stack(columns, axis=-1), atol=1e-8)


def test_lost_directions(robot, q) -> None:
    q[:150, 2] = np.pi / 2
    q[150:, 2] = -np.pi / 2
    s1, c1, s2, c2 = np.sin(q[:, 0]), np.cos(q[:, 0]), np.sin(q[:, 1]), np.cos(q[:, 1])
    lost = np.stack([-s1 * s2, c1 * s2, c2, 0 * s1], axis=-1)
    assert np.abs(np.einsum("ni,nij->nj", lost, robot.jacobian(q))).max() < 1e-15
    on_axis = robot.ik([0.0, 0.0, 1.0, 0.3]).q
    on_axis[:, 0] = [0.1, 0.2, 0.3, 0.4]
    across = np.stack([np.cos(on_axis[:, 0]), np.sin(on_axis[:, 0]), *np.zeros((2, 4))], axis=-1)
    assert np.abs(np.einsum("ni,nij->nj", across, robot.jacobian(on_axis))).max() < 1e-15


def test_motors(robot, q) -> None:
    motors = robot.motors_from_joints(q)
    np.testing.assert_allclose(motors[:, 2], q[:, 1] + q[:, 2], atol=0)
    np.testing.assert_allclose(robot.joints_from_motors(motors), q, atol=1e-15)
    np.testing.assert_array_equal(robot.joints_from_motors(np.eye(4)), M.T)
    np.testing.assert_allclose(robot.jacobian_motors(q), robot.jacobian(q) @ M, atol=1e-15)
    rates = differences(lambda m: robot.fk(robot.joints_from_motors(m))[:, :3], motors)
    np.testing.assert_allclose(robot.jacobian_motors(q)[:, :3], rates, atol=1e-8)


def test_virtual_joint(robot, q) -> None:
    np.testing.assert_allclose(wrapped(robot.joint4(q) + q[:, 1] + q[:, 2]), 0, atol=1e-15)
    np.testing.assert_allclose(robot.pose(q)[:, :3, 2], np.tile([0, 0, 1], (300, 1)), atol=0)


def test_virtual_joint_lies_in_the_half_open_interval(robot) -> None:
    q = np.zeros((5, 4))
    q[:, 1], q[:, 2] = [np.pi, -np.pi, np.pi / 2, 3.0, -3.0], [0.0, 0.0, np.pi / 2, 3.0, -3.0]
    theta4 = robot.joint4(q)
    assert (theta4 > -np.pi).all() and (theta4 <= np.pi).all()
    np.testing.assert_allclose(theta4[:3], np.pi, atol=1e-15)
    np.testing.assert_allclose(theta4[3:], [2 * np.pi - 6, 6 - 2 * np.pi], atol=1e-15)


def test_point_velocity(robot, q) -> None:
    rates = np.random.default_rng(5).normal(size=(300, 4))
    v = robot.point_velocity(q, rates)
    np.testing.assert_allclose(
        v, np.einsum("nij,nj->ni", robot.jacobian(q), rates)[:, :3], atol=1e-14
    )
    h = 1e-6
    moved = (robot.fk(q + h * rates) - robot.fk(q - h * rates))[:, :3] / (2 * h)
    np.testing.assert_allclose(v, moved, atol=1e-8)
    spatial = np.einsum("nij,nj->ni", robot.jacobian_space(q), rates)
    p = robot.fk(q)[:, :3]
    np.testing.assert_allclose(v, spatial[:, :3] + np.cross(spatial[:, 3:], p), atol=1e-14)
    for reading in (rates[:, None], rates):
        assert robot.point_velocity(q, reading).shape[-1] == 3


def test_workspace(robot) -> None:
    rng = np.random.default_rng(6)
    x = np.concatenate([rng.uniform(-1.8, 2.2, (4000, 3)), np.zeros((4000, 1))], axis=-1)
    margin = robot.workspace_margin(x[:, :3])
    reached = (robot.ik(x).status == OK).any(axis=-1)
    clear = np.abs(margin) > 1e-9
    np.testing.assert_array_equal(reached[clear], margin[clear] > 0)
    assert 0.2 < reached.mean() < 0.8
    np.testing.assert_allclose(robot.workspace_section(), [0.22, 0.434, 0.055, 1.355], rtol=1e-14)


@pytest.mark.parametrize("params", [L, EQUAL, (0.0, 0.5, 0.7, 0.6, 0.0, 0.0)])
def test_workspace_contains_what_the_inverse_reaches(robot, params) -> None:
    """Also just inside and outside of every boundary, in front of the axis and behind it."""
    l1, l2, l3, l4, l5, l6 = params
    direction, bearing = np.random.default_rng(7).uniform(-np.pi, np.pi, (2, 300))
    reached = 0
    for radius in (l3 + l4, abs(l3 - l4)):
        for off in (-0.3, -1e-6, -1e-11, -1e-13, 0.0, 1e-13, 1e-11, 1e-6, 0.3):
            for facing in (1, -1):
                reach = radius + off * sum(params)
                rho = facing * (l1 + l6 + reach * np.cos(direction))
                z = l2 - l5 + reach * np.sin(direction)
                p = np.stack([-rho * np.sin(bearing), rho * np.cos(bearing), z], axis=-1)
                status = robot.ik(np.concatenate([p, bearing[:, None]], axis=-1), params).status
                inside = robot.workspace_contains(p, params)
                assert inside.dtype == np.bool_ and inside.shape == (300,)
                found = np.isin(status, (OK, SINGULAR)).any(axis=1)
                np.testing.assert_array_equal(inside, found)
                reached += found.sum()
    assert 2000 < reached < 10000
    assert not robot.workspace_contains([np.nan, 0.5, 1.0])
    assert not robot.workspace_contains([0.1, 0.5, 1.0], (0.1, 0.6, -0.7, 0.6, 0.1, 0.1))


def test_margin_is_the_distance_to_the_boundary_of_the_section(robot) -> None:
    """With the shoulder on the base axis front and back are the same annulus."""
    direction = np.random.default_rng(8).uniform(-1.2, 1.2, 200)
    params = (0.0, 0.5, 0.7, 0.4, 0.2, 0.0)
    for reach in (0.2, 0.31, 0.5, 1.0, 1.3):
        rho, z = reach * np.cos(direction), 0.3 + reach * np.sin(direction)
        margin = robot.workspace_margin(np.stack([0 * rho, rho, z], axis=-1), params)
        np.testing.assert_allclose(margin, min(1.1 - reach, reach - 0.3), atol=1e-14)


@pytest.fixture(scope="module")
def table() -> np.ndarray:
    text = (files("closedform.generated") / "data" / "irb260_section_v.csv").read_text("utf-8")
    header, *rows = csv.reader(text.splitlines())
    assert header[:4] == ["t [s]", "vx [m/s]", "vy [m/s]", "vz [m/s]"]
    return np.array(rows, dtype=float)


@pytest.mark.parametrize("grounded", [False, True])
def test_the_experiment_of_section_v(robot, table, grounded: bool) -> None:
    t, v = table[:, 0], table[:, 4:7] if grounded else table[:, 1:4]
    np.testing.assert_array_equal(t, np.arange(101) / 10)
    rates = np.deg2rad([-30, 10, 5, 0])
    rates = M @ rates if grounded else rates

    def position(t: np.ndarray) -> np.ndarray:
        return robot.fk(rates * t[:, None])[:, :3]

    h = 1e-5
    np.testing.assert_allclose(v, (position(t + h) - position(t - h)) / (2 * h), atol=1e-9)
    np.testing.assert_allclose(v, robot.point_velocity(rates * t[:, None], rates), atol=1e-14)
    simpson = np.array([1, *[4, 2] * 49, 4, 1]) * 0.1 / 3
    np.testing.assert_allclose(simpson @ v, (position(t[-1:]) - position(t[:1]))[0], atol=1e-6)


def test_readings_of_motor_3_differ(table) -> None:
    """At once in z, then in y, then in x."""
    t, apart = table[:, 0], np.abs(table[:, 1:4] - table[:, 4:7])
    np.testing.assert_array_equal(apart[0, :2], 0)
    np.testing.assert_allclose(table[0, 3], 3 * table[0, 6], rtol=1e-15)
    orders = np.log2(apart[2, :2] / apart[1, :2])
    np.testing.assert_allclose(orders, [2, 1], atol=0.05)
    assert (apart[t > 2].max(axis=0) > 0.05).all()
