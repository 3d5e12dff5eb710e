"""Wrists that do not reach every direction, where the joints that carry them are singular."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, link, misses
from chains import arm, printed, solved
from sympy import pi

from closedform.scaffold.chains.propose import propose

H = sp.Rational(1, 2)
ARMS = {
    "parallel links": [
        (0, pi / 2, 1), (2, 0, 0), (H, pi / 2, 0), (0, pi / 3, 2), (0, pi / 3, 0), (0, 0, 1),
    ],
    "a turret beside its links": [
        (H, pi / 2, 1), (2, 0, H), (H, pi / 2, 0), (0, pi / 3, 2), (0, pi / 2, 0), (0, 0, 1),
    ],
    "two axes that meet": [
        (0, pi / 2, 1), (2, pi / 2, H), (1, pi / 2, 0), (0, pi / 3, 0), (0, pi / 3, 0), (0, 0, 1),
    ],
    "axes in line": [
        (0, pi / 2, 1), (1, 0, 0), (0, pi / 2, 0), (0, pi / 3, 2), (0, -pi / 3, 0), (0, 0, H),
    ],
}  # fmt: skip
"""All have axes 4, 5 and 6 that meet, and not at right angles."""
NEAR = np.array([0, 1e-15, 1e-13, 1e-11, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4])


@pytest.fixture(scope="module")
def module(tmp_path_factory: pytest.TempPathFactory) -> Any:
    @cache
    def made(name: str) -> Any:
        d, serial = arm(ARMS[name])
        solved(d, serial, propose(serial).source)
        return printed(d, tmp_path_factory.mktemp(name.replace(" ", "_")))

    return made


def pose(name: str, q: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    for k, (a, alpha, d) in enumerate(ARMS[name]):
        T = T @ link(float(a), float(alpha), float(d), q[..., k])
    return T


def check(module: Any, name: str, T: np.ndarray) -> None:
    """Every pose has a solution, and every solution leads to its pose."""
    q, status = module(name).ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    size = sum(float(abs(a) + abs(d)) for a, _, d in ARMS[name])
    away, turned = misses(pose(name, q), T, status)
    assert away < 1e-12 * size and turned < 1e-12


def centre(name: str, T: np.ndarray) -> np.ndarray:
    """Where the axes of the wrist meet."""
    return T[..., :3, 3] - T[..., :3, 2] * float(ARMS[name][5][2])


def position_determinant(name: str, q: np.ndarray) -> np.ndarray:
    """That of how the first three joints move the centre, by differences."""
    steps = 1e-6 * np.eye(6)[:3]
    columns = [
        (centre(name, pose(name, q + s)) - centre(name, pose(name, q - s))) / 2e-6 for s in steps
    ]
    return np.linalg.det(np.stack(columns, axis=-1))


@cache
def singular_positions(name: str) -> np.ndarray:
    """Postures, by turning joint 2 or 3, where the first three joints are singular."""
    q = np.random.default_rng(7).uniform(-3, 3, (300, 6))
    rows, joint = np.arange(len(q)), 1 + np.arange(len(q)) % 2

    def at(angle: np.ndarray) -> np.ndarray:
        turned = q.copy()
        turned[rows, joint] = angle
        return turned

    grid = np.linspace(-np.pi, np.pi, 60)
    values = np.stack([position_determinant(name, at(angle)) for angle in grid])
    changes = values[:-1] * values[1:] < 0
    first = changes.argmax(axis=0)
    low, high = grid[first], grid[first + 1]
    sign = np.sign(values[first, rows])
    for _ in range(50):
        middle = (low + high) / 2
        before = position_determinant(name, at(middle)) * sign > 0
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return at(low)[changes.any(axis=0)]


@pytest.mark.parametrize("name", ARMS)
def test_no_posture_is_lost_where_a_singular_arm_has_its_wrist_at_a_limit(
    module: Any, name: str
) -> None:
    q = np.repeat(singular_positions(name), 2 * len(NEAR), axis=0)
    rng = np.random.default_rng(8)
    q[:, 4] = np.pi * rng.integers(0, 2, len(q)) + np.tile(NEAR, len(q) // len(NEAR))
    q[:, 1:3] += rng.choice(NEAR, (len(q), 2)) * rng.choice([-1, 1], (len(q), 2))
    check(module, name, pose(name, q))


def test_a_wrist_on_the_first_axis_points_anywhere(module: Any) -> None:
    """Joint 1 is free there, but only some of its values let the wrist tilt as far."""
    name = "parallel links"
    q = singular_positions(name)
    q[:, 3:] = np.random.default_rng(9).uniform(-3, 3, (len(q), 3))
    T = pose(name, q)
    T = T[np.hypot(*centre(name, T)[:, :2].T) < 1e-6]
    assert len(T) > 50
    T[:, :2, 3] -= centre(name, T)[:, :2]
    check(module, name, T)
    _, status = module(name).ik(T)
    assert (np.isin(status, (OK, SINGULAR)).sum(axis=-1) >= 2).all()


def test_an_arm_that_is_straight_along_its_first_axis_with_the_wrist_at_its_limit(
    module: Any,
) -> None:
    """A turn about the last axis does not tilt it, and how far it tilted was zero over zero."""
    name, rng = "axes in line", np.random.default_rng(5)
    q = rng.uniform(-3, 3, (400, 6))
    q[:, 1:5] = rng.choice([-1, 1], (400, 4)) * np.pi / 2
    q[:, 4] = np.pi * rng.choice([0, 1], 400)
    check(module, name, pose(name, q))


def test_what_the_wrist_cannot_reach_stays_out_of_reach(module: Any) -> None:
    """The joints before it are turned only as far as their position does not tell."""
    name = "parallel links"
    q = np.random.default_rng(10).uniform(-3, 3, (2000, 6))
    _, status = module(name).ik(pose(name, q))
    assert (status == UNREACHABLE).any()
    check(module, name, pose(name, q))


def test_a_slide_that_is_drawn_in_loses_no_posture(tmp_path: Path) -> None:
    """Joint 2 is free there, but not every value lets the wrist tilt as far."""
    rows = [
        (0, -pi / 2, 1), (0, pi / 2, H), (0, 0, None, 0), (0, pi / 3, 0), (0, -pi / 3, 0),
        (0, 0, H),
    ]  # fmt: skip
    d, serial = arm(rows, "t1 t2 d3 t4 t5 t6")
    found = propose(serial)
    assert found.structure == "spherical wrist, a turret, a joint and a slide"
    solved(d, serial, found.source)
    serial.export(d)
    robot = printed(d, tmp_path)
    rng = np.random.default_rng(12)
    q = rng.uniform(-3, 3, (4000, 6))
    q[:, 2] = rng.choice(NEAR, len(q)) * rng.choice([-1, 1], len(q))
    q[::2, 4] = np.pi * rng.integers(0, 2, len(q) // 2)
    T = np.eye(4)
    for k, (a, alpha, length, *_) in enumerate(rows):
        slides = length is None
        T = T @ link(float(a), float(alpha), 0 if slides else float(length), q[:, k] * (not slides))
        if slides:
            T[:, :3, 3] += q[:, k, None] * T[:, :3, 2]
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    away, turned = misses(robot.pose(answers), T, status)
    assert away < 1e-12 * 3 and turned < 1e-12
