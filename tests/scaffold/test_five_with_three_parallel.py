"""Five joints of which the first three, or the last three, are parallel: legs of humanoids."""

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

A, B, C, D = (sp.Rational(n, 100) for n in (3, 40, 35, 11))
ARMS = {
    "axes 1, 2 and 3 parallel, 4 and 5 meet": [
        (B, 0, D), (C, 0, 0), (A, pi / 2, A), (0, pi / 2, 0), (0, 0, D),
    ],
    "axes 5, 4 and 3 parallel, 2 and 1 meet": [
        (0, pi / 2, D), (A, pi / 2, D), (B, 0, 0), (C, 0, A), (0, 0, 0),
    ],
}  # fmt: skip
OBLIQUE = [(B, 0, D), (C, 0, 0), (A, pi / 3, A), (0, pi / 4, 0), (0, 0, D)]


@cache
def made(name: str, folder: Path) -> Any:
    d, serial = arm(ARMS[name])
    found = propose(serial)
    assert found.structure == name
    solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 4
    serial.export(d)
    return printed(d, folder)


def pose(name: str, q: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    for k, (a, alpha, d) in enumerate(ARMS[name]):
        T = T @ link(float(a), float(alpha), float(d), q[..., k])
    return T


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("legs")


def postures(name: str, rng: np.random.Generator) -> np.ndarray:
    """Random ones, and others near and on the singular wrist, with a straight or folded elbow."""
    q = rng.uniform(-3, 3, (2400, 5))
    wrist, elbow = (3, 1) if name.startswith("axes 1") else (1, 3)
    off = np.array([0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3])
    q[400:, wrist] = rng.choice([0, np.pi], 2000) + rng.choice(off, 2000)
    q[1200:, elbow] = rng.choice([0, np.pi], 1200) + rng.choice(off, 1200)
    return q


@pytest.mark.parametrize("name", ARMS)
def test_every_pose_of_the_arm_is_reached(name: str, folder: Path) -> None:
    q = postures(name, np.random.default_rng(1))
    T = pose(name, q)
    answers, status = made(name, folder).ik(T)
    away, turned = misses(pose(name, answers), T, status)
    assert away < 1e-12 and turned < 1e-12
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    gaps = np.abs(wrapped(answers - q[:, None])).max(axis=-1)
    assert np.nanmin(gaps[:400], axis=1).max() < 1e-8


@pytest.mark.parametrize("name", ARMS)
def test_newton_finds_no_other_posture(name: str, folder: Path) -> None:
    rng = np.random.default_rng(2)
    for T in pose(name, rng.uniform(-3, 3, (4, 5))):
        answers, status = made(name, folder).ik(T)
        there = answers[np.isin(status, (OK, SINGULAR))]
        found = newton(lambda q: pose(name, q), T, rng.uniform(-np.pi, np.pi, (200, 5)))
        assert len(found) > 20
        away = np.abs(wrapped(found[:, None] - there)).max(axis=-1)
        assert away.min(axis=1).max() < 1e-6 and away.min(axis=0).max() < 1e-6


@pytest.mark.parametrize("name", ARMS)
def test_other_poses_are_out_of_reach(name: str, folder: Path) -> None:
    T = pose(name, np.random.default_rng(3).uniform(-3, 3, (50, 5)))
    side = T[:, :3, 2] if name.startswith("axes 5") else np.array([0, 0, 1])
    T[:, :3, 3] += 1e-6 * side
    assert (made(name, folder).ik(T)[1] == UNREACHABLE).all()


def test_oblique_axes_are_solved_too() -> None:
    d, serial = arm(OBLIQUE)
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 4


def test_axes_that_nearly_meet_are_named() -> None:
    """The chain for axes that pass each other divides by their distance."""
    near = sp.Rational(1, 10**5)
    rows = [*ARMS["axes 1, 2 and 3 parallel, 4 and 5 meet"][:3], (near, pi / 2, 0), (0, 0, D)]
    with pytest.raises(NoChainError) as caught:
        propose(arm(rows)[1])
    assert any("axes 4 and 5 pass each other" in str(t.error) for t in caught.value.tried)
