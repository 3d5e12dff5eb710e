"""Three parallel axes beside which no two neighbours meet, and three in the middle that meet."""

from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, link, misses, newton, wrapped
from chains import arm, printed, solved
from sympy import pi

from closedform.proof.prove import prove
from closedform.scaffold.chains.propose import NoChainError, propose


def tenths(*lengths: int) -> list[sp.Rational]:
    return [sp.Rational(n, 10) for n in lengths]


A, B, C, D, E, F = tenths(3, 7, 6, 5, 12, 9)
ARMS = {
    "axes 1, 2 and 3 parallel, 4, 5 and 6 skew": [
        (E, 0, 1), (F, 0, 0), (A, pi / 3, D), (B, pi / 4, A), (C, -pi / 3, 1), (0, 0, D),
    ],
    "axes 6, 5 and 4 parallel, 3, 2 and 1 skew": [
        (A, pi / 2, D), (B, pi / 4, A), (C, pi / 2, 1), (F, 0, 0), (E, 0, D), (0, 0, D),
    ],
    "axes 1, 2 and 3 parallel, 4 and 5 parallel": [
        (E, 0, 1), (F, 0, 0), (A, pi / 3, D), (B, 0, A), (C, pi / 4, 1), (0, 0, D),
    ],
    "axes 1, 2 and 3 parallel, 5 and 6 parallel": [
        (E, 0, 1), (F, 0, 0), (A, pi / 2, D), (B, pi / 2, A), (C, 0, 1), (0, 0, D),
    ],
    "axes 2, 3 and 4 parallel, 5 and 6 parallel": [
        (D, pi / 2, 1), (E, 0, 0), (F, 0, D), (B, pi / 2, A), (C, 0, 1), (0, 0, D),
    ],
    "axes 5, 4 and 3 parallel, 2 and 1 parallel": [
        (C, 0, 1), (B, pi / 2, A), (E, 0, 0), (F, 0, D), (D, pi / 3, 1), (0, 0, D),
    ],
    "axes 2, 3 and 4 meet in a point, 5 and 6 are skew": [
        (E, pi / 2, D), (0, pi / 2, 0), (0, -pi / 2, 0), (B, pi / 4, D), (A, pi / 2, A), (0, 0, D),
    ],
    "axes 5, 4 and 3 meet in a point, 2 and 1 are skew": [
        (A, pi / 2, A), (B, pi / 4, D), (0, pi / 3, 0), (0, -pi / 2, 0), (E, pi / 2, D), (0, 0, D),
    ],
}  # fmt: skip
Printed = Callable[[str], Any]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Printed:
    """The printed module of an arm, whose inverse the proof has accepted."""

    @cache
    def printed_arm(structure: str) -> Any:
        d, serial = arm(ARMS[structure])
        found = propose(serial)
        assert found.structure == structure
        solved(d, serial, found.source)
        (inverse,) = prove(d).inverses
        assert inverse.branches == found.branches == 8
        return printed(d, tmp_path_factory.mktemp("arm"))

    return printed_arm


def pose(structure: str, q: np.ndarray) -> np.ndarray:
    return product(ARMS[structure], q)


def product(rows: list, q: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    for k, (a, alpha, d) in enumerate(rows):
        T = T @ link(float(a), float(alpha), float(d), q[..., k])
    return T


def size(structure: str) -> float:
    return sum(float(a + d) for a, _, d in ARMS[structure])


@pytest.mark.parametrize("structure", ARMS)
def test_every_posture_is_among_the_branches(made: Printed, structure: str) -> None:
    q = np.random.default_rng(4).uniform(-3, 3, (500, 6))
    T = pose(structure, q)
    answers, status = made(structure).ik(T)
    away, turned = misses(pose(structure, answers), T, status)
    assert away < 1e-12 * size(structure) and turned < 1e-12
    off = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
    assert (np.nanmin(off, axis=1) < 1e-6).all()


@pytest.mark.parametrize("structure", ARMS)
def test_newton_finds_no_posture_that_the_branches_lack(made: Printed, structure: str) -> None:
    rng = np.random.default_rng(5)
    for T in pose(structure, rng.uniform(-3, 3, (4, 6))):
        answers, status = made(structure).ik(T)
        there = answers[np.isin(status, (OK, SINGULAR))]
        found = newton(lambda q: pose(structure, q), T, rng.uniform(-np.pi, np.pi, (200, 6)))
        assert len(found) > 20
        away = np.abs(wrapped(found[:, None] - there)).max(axis=-1)
        assert away.min(axis=1).max() < 1e-6
        assert away.min(axis=0).max() < 1e-6


@pytest.mark.parametrize("structure", ARMS)
def test_out_of_reach_is_said(made: Printed, structure: str) -> None:
    q = np.random.default_rng(6).uniform(-3, 3, (20, 6))
    T = pose(structure, q)
    T[:, :3, 3] += 4 * size(structure)
    answers, status = made(structure).ik(T)
    assert not np.isin(status, (OK, SINGULAR)).any() and np.isnan(answers).all()


MIDDLE = [(A, pi / 2, D), (0, pi / 3, B), (0, pi / 4, 0), (B, 0, D), (C, pi / 2, 0), (0, 0, D)]
"""Axes 2, 3 and 4 meet at oblique angles, and axis 5 is parallel to axis 4."""


def test_an_axis_beside_three_that_meet_may_be_parallel_to_one() -> None:
    """One equation had coordinates of the target that no other has, and the proof took no rest."""
    d, serial = arm(MIDDLE)
    found = propose(serial)
    assert found.structure == "axes 2, 3 and 4 meet in a point, 5 and 6 are skew"
    solved(d, serial, found.source)
    (inverse,) = prove(d).inverses
    assert inverse.branches == found.branches == 8


def test_a_small_least_tilt_is_kept_to_the_promise(tmp_path: Path) -> None:
    """A cosine that is missed by 1e-12 is missed by 4e-12 as an angle of 15 degrees."""
    d, serial = arm(MIDDLE)
    solved(d, serial, propose(serial).source)
    rng = np.random.default_rng(8)
    q = np.array([0, -pi / 2, pi, pi, pi / 2, 0], float) + rng.choice(
        [0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3], (20_000, 6)
    ) * rng.choice([-1, 1], (20_000, 6))
    T = product(MIDDLE, q)
    answers, status = printed(d, tmp_path).ik(T)
    away, turned = misses(product(MIDDLE, answers), T, np.where(status == OK, OK, UNREACHABLE))
    assert away < 1e-12 * sum(float(a + d) for a, _, d in MIDDLE) and turned < 1e-12


def test_axes_that_nearly_meet_are_named() -> None:
    """The distance of two skew axes divides rounding errors."""
    near = sp.Rational(1, 10**5)
    rows = [(E, 0, 1), (F, 0, 0), (A, pi / 3, D), (near, pi / 4, A), (C, -pi / 3, 1), (0, 0, D)]
    with pytest.raises(NoChainError, match="axes 4 and 5 pass each other") as caught:
        propose(arm(rows)[1])
    assert caught.value.degree == 4 and "ssik" in caught.value.needed


def test_a_point_that_comes_to_the_last_axis_is_named() -> None:
    """There three solutions meet, and the inverse would lose digits."""
    rows = [
        (E, pi / 2, D),
        (0, pi / 2, 0),
        (0, -pi / 2, 0),
        (B, pi / 2, 0),
        (B, pi / 2, 0),
        (0, 0, D),
    ]
    with pytest.raises(NoChainError, match="can come to axis 6") as caught:
        propose(arm(rows)[1])
    assert caught.value.degree == 4 and "ssik" in caught.value.needed


def test_two_pairs_of_axes_alike_are_named() -> None:
    """The ellipse of the pair of joint 4 is a circle for every target."""
    rows = [(2, 0, 1), (1, 0, 0), (1, pi / 2, D), (1, pi / 2, D), (1, -pi / 2, 0), (0, 0, D)]
    with pytest.raises(NoChainError, match="at the same angle and distance from axis 5") as caught:
        propose(arm(rows)[1])
    assert caught.value.degree == 2 and "ssik" in caught.value.needed


MEET = {
    "a UR with an offset wrist": (
        [(0, pi / 2, 1), (1, 0, 0), (1, 0, 0), (0, pi / 2, 1), (1, -pi / 2, 1), (0, 0, 1)],
        [-0.1 - np.pi / 2, np.pi + 1e-9, np.pi, -np.pi / 2 - 1e-6, -np.pi, -np.pi / 2 + 1e-9],
    ),
    "three parallel axes at the end": (
        [(A, pi / 3, D), (B, pi / 4, sp.Rational(1, 3)), (C, -pi / 3, 1), (1, 0, 0), (2, 0, D),
         (0, 0, D)],
        [-np.pi / 2 - 1e-3, np.pi + 1e-6, -1e-15, np.pi / 2 - 1e-9, np.pi - 1e-9, np.pi],
    ),
}  # fmt: skip
"""Arms, and a posture where two or three solutions meet and the elbow is stretched or folded."""


@pytest.mark.parametrize("name", MEET)
def test_links_reach_where_solutions_meet(name: str, tmp_path: Path) -> None:
    """Rounding turns a joint by the root of an error, and the links seemed to be too short."""
    rows, posture = MEET[name]
    d, serial = arm(rows)
    solved(d, serial, propose(serial).source)
    serial.export(d)
    robot = printed(d, tmp_path)
    rng = np.random.default_rng(8)
    q = np.array(posture) + rng.choice([0, 1e-15, 1e-13], (200, 6))
    q[0] = posture
    T = np.eye(4)
    for k, (a, alpha, length) in enumerate(rows):
        T = T @ link(float(a), float(alpha), float(length), q[:, k])
    answers, status = robot.ik(T)
    found = np.isin(status, (OK, SINGULAR))
    length = sum(float(abs(a) + abs(d)) for a, _, d in rows)
    away, turned = misses(robot.pose(answers), T, status)
    assert away < 1e-12 * length and turned < 4e-12
    first = np.abs(wrapped(answers[..., 0] - q[:, None, 0]))
    assert (np.where(found, first, np.inf).min(axis=1) < 1e-4).all()


H = sp.Rational(1, 2)
AT_RIGHT_ANGLES = {
    "the first three and the last axis": [
        (2, 0, 1), (1, 0, 0), (1, pi / 2, H), (1, pi / 2, H), (sp.Rational(11, 10), -pi / 2, 0),
        (0, 0, H),
    ],
    "no offset where the elbow ends": [
        (5, 0, 2), (4, 0, 0), (1, pi / 2, 1), (1, pi / 2, 0), (2, pi / 2, 0), (0, 0, 1),
    ],
    "three parallel axes before two": [
        (E, 0, 1), (F, 0, 0), (A, pi / 2, D), (B, 0, A), (C, pi / 2, 1), (0, 0, D),
    ],
    "three parallel axes after two": [
        (C, 0, 1), (B, pi / 2, A), (E, 0, 0), (F, 0, D), (D, pi / 2, 1), (0, 0, D),
    ],
    "three parallel axes, then two": [
        (D, pi / 2, 1), (E, 0, 0), (F, 0, D), (B, pi / 2, A), (C, 0, 1), (0, 0, D),
    ],
    "three parallel axes, one, then two": [
        (E, 0, 1), (F, 0, 0), (A, pi / 2, D), (B, pi / 2, A), (C, 0, 1), (0, 0, D),
    ],
}  # fmt: skip
"""Arms whose last axis can be parallel to the first ones, or the first axis to the last ones."""


@pytest.mark.parametrize("name", AT_RIGHT_ANGLES)
def test_no_posture_near_right_angles_is_lost(name: str, tmp_path: Path) -> None:
    """A joint that parallel axes leave free has to be where the two links reach."""
    rows = AT_RIGHT_ANGLES[name]
    d, serial = arm(rows)
    solved(d, serial, propose(serial).source)
    robot = printed(d, tmp_path)
    rng = np.random.default_rng(1)
    q = rng.choice([-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi], (6000, 6))
    q += rng.choice([0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3], (6000, 1)) * rng.choice(
        [-1, 0, 1], q.shape
    )
    T, reached = np.eye(4), np.eye(4)
    for k, (a, alpha, length) in enumerate(rows):
        T = T @ link(float(a), float(alpha), float(length), q[:, k])
    answers, status = robot.ik(T)
    for k, (a, alpha, length) in enumerate(rows):
        reached = reached @ link(float(a), float(alpha), float(length), answers[..., k])
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    away, turned = misses(reached, T, status)
    assert away < 1e-12 * sum(float(a + d) for a, _, d in rows) and turned < 1e-12


def test_oblique_axes_with_the_same_angle_as_others(tmp_path: Path) -> None:
    """With equal twists the last axis can be parallel to the three: nearly all was lost there."""
    al, be = sp.symbols("al be", real=True)
    rows = [(A, pi / 3, D), (E, 0, 0), (F, 0, 0), (B, al, A), (C, be, 1), (0, 0, D)]
    d, serial = arm(rows, al="0.8", be="1.1")
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 8
    serial.export(d)
    module = printed(d, tmp_path)
    rng = np.random.default_rng(7)
    for angles, at in (((1.0, 1.0), np.pi), ((0.9, np.pi - 0.9), 0), ((-1.2, 1.2), 0)):
        q = rng.uniform(-np.pi, np.pi, (800, 6))
        q[:, 4] = at + rng.choice([-1, 1], 800) * np.repeat([1e-3, 1e-4, 1e-5, 1e-6], 200)
        T = module.pose(q, angles)
        answers, status = module.ik(T, angles)
        away, turned = misses(module.pose(answers, angles), T, status)
        assert away < 1e-12 * 5 and turned < 1e-12
        gaps = np.abs(np.exp(1j * answers) - np.exp(1j * q[:, None])).max(axis=-1)
        assert np.nanmin(np.where(np.isin(status, (OK, SINGULAR)), gaps, 9), axis=1).max() < 1e-4
