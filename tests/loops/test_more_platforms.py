"""Mechanisms in space that nobody had tried here: their joints by Newton's method on the rods.

The ends of the rods are written from the drawings.  From random starts Newton's method finds no
joints that ``ik`` lacks.
"""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

FOLDER = TESTS / "held_out_loops"
OK, STARTS, LINES = 0, 60, 40
THIRDS = 2 * np.pi / 3 * np.arange(3)


def about(axis: int, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    R, (i, j) = np.eye(3), [k for k in range(3) if k != axis]
    R[i, i], R[j, j] = c, c
    R[i, j], R[j, i] = (s, -s) if axis == 1 else (-s, s)
    return R


def ball_balancer(v, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    turn = [about(2, a) for a in THIRDS]
    near = [R @ [v.b + v.l * np.cos(a), 0, -v.l * np.sin(a)] for R, a in zip(turn, q, strict=True)]
    far = [T[:3, 3] + T[:3, :3] @ R @ [v.a, 0, 0] for R in turn]
    return np.linalg.norm(np.array(far) - near, axis=1) - v.r


def solar_tracker(v, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    feet = np.array([[v.b, 0, 0], [0, v.b, 0]])
    ends = [0, 0, v.h] + np.array([[v.c, 0, 0], [0, v.c, 0]]) @ T[:3, :3].T
    return np.linalg.norm(ends - feet, axis=1) - q


def humanoid_wrist(v, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    sides = np.array([[0.03, 0.02, 0], [-0.03, 0.02, 0]])
    carts = sides + np.stack([0 * q, 0 * q, q - 0.1], axis=1)
    return np.linalg.norm(sides @ T[:3, :3].T - carts, axis=1) - 0.1


def rotopod(v, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    ends = [about(2, a) @ [v.c, side * v.g, 0] for a in THIRDS for side in (1, -1)]
    turned = np.repeat(THIRDS, 2) + q
    near = v.R * np.stack([np.cos(turned), np.sin(turned), 0 * q], axis=1)
    return np.linalg.norm(T[:3, 3] + ends @ T[:3, :3].T - near, axis=1) - v.l


def four_ruu(v, q: np.ndarray, T: np.ndarray) -> np.ndarray:
    half = [np.eye(3), np.diag([-1, -1, 1])]
    bases = [R @ e for R in half for e in np.array([[v.b, 0, 0], [0, v.b, 0]])]
    ends = [R @ e for R in half for e in np.array([[v.c, 0.05, 0], [0.05, v.c, 0.05]])]
    turned = q + np.array([0, 0.5, 1, 1.5]) * np.pi
    near = bases + v.l * np.stack([np.cos(turned), np.sin(turned), 0 * q], axis=1)
    return np.linalg.norm(T[:3, 3] + ends @ T[:3, :3].T - near, axis=1) - v.r


def by_hand_pose(mechanism: ModuleType, x: np.ndarray) -> np.ndarray:
    return mechanism.hand_pose(x)


def by_pose(_: ModuleType, x: np.ndarray) -> np.ndarray:
    return x


def by_yaw(_: ModuleType, x: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = about(2, x[3]), x[:3]
    return T


def tilted(rng: np.random.Generator) -> np.ndarray:
    T, (a, b, c) = np.eye(4), rng.uniform(-0.2, 0.2, 3)
    T[:3, :3] = about(0, a) @ about(1, b) @ about(2, c)
    T[:3, 3] = rng.uniform((-0.05, -0.05, 0.35), (0.05, 0.05, 0.42))
    return T


Target = Callable[[np.random.Generator], np.ndarray]
SLIDING = ("solar_tracker", "humanoid_wrist")
MECHANISMS: dict[str, tuple[Callable, Callable, Target]] = {
    "ball_balancer": (
        ball_balancer,
        by_hand_pose,
        lambda rng: rng.uniform((0.07, -0.2, -0.2), (0.1, 0.2, 0.2)),
    ),
    "solar_tracker": (solar_tracker, by_hand_pose, lambda rng: rng.uniform(-0.6, 0.6, 2)),
    "humanoid_wrist": (humanoid_wrist, by_hand_pose, lambda rng: rng.uniform(-0.6, 0.6, 2)),
    "rotopod": (rotopod, by_pose, tilted),
    "four_ruu": (
        four_ruu,
        by_yaw,
        lambda rng: rng.uniform((-0.05, -0.05, 0.2, -0.3), (0.05, 0.05, 0.3, 0.3)),
    ),
}


@pytest.mark.parametrize("name", MECHANISMS)
def test_newton_finds_no_joints_that_the_closed_form_lacks(name: str, tmp_path: Path) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    assert len(text.splitlines()) < LINES
    mechanism = derived(name, script_of(name, text, tmp_path), tmp_path)
    missed, pose, target = MECHANISMS[name]
    v, rng, found = mechanism.Parameters(), np.random.default_rng(4), 0
    for x in [target(rng) for _ in range(5)]:
        (q, status), T = mechanism.ik(x), pose(mechanism, x)
        exist = q[status == OK]
        assert len(exist)
        assert all(np.abs(missed(v, row, T)).max() < 1e-12 for row in exist)
        turns = np.full(q.shape[1], name not in SLIDING)
        for start in rng.uniform(0.1, 3, (STARTS, q.shape[1])):
            at = newton(lambda q: missed(v, q, T), start)  # noqa: B023
            if at is not None:
                assert apart(exist, at, turns).min() < 1e-6
                found += 1
    assert found > STARTS
