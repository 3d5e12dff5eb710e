"""Arms with two equal links, which fold the wrist onto the shoulder, where two axes meet."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arms import OK, SINGULAR, misses
from chains import arm, printed, solved
from sympy import Rational, pi

from closedform.proof.prove import prove
from closedform.scaffold.chains.propose import propose

WRIST = [(0, -pi / 2, 0), (0, pi / 2, 0), (0, 0, 0)]
OFFSET = [(0, -pi / 2, 0), (0, pi / 2, 0), (1, pi / 2, 1), (-1, -pi / 2, 0)]
ARMS = {
    "an offset elbow": ([*OFFSET, (0, pi / 2, 1), (1, pi / 2, 0), (0, 0, 1)], np.pi / 2),
    "an oblique wrist": ([*OFFSET, (0, pi / 3, 1), (1, pi / 2, 0), (0, 0, 1)], np.pi / 2),
    "six joints": ([(0, pi / 2, 1), (1, pi / 2, 0), (1, pi / 2, 0), *WRIST], np.pi),
}  # fmt: skip
"""Rows of a, alpha and d, and the angle of the elbow where the links are folded."""


@pytest.fixture(scope="module", params=ARMS)
def folding(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    rows, fold = ARMS[request.param]
    d, serial = arm(rows)
    solved(d, serial, propose(serial, "t7" if len(rows) == 7 else "").source)
    serial.export(d)
    (inverse,) = prove(d).inverses
    assert inverse.branches == inverse.solutions == 8
    folder: Path = tmp_path_factory.mktemp("folded")
    return printed(d, folder), len(rows), fold


def answers(module: Any, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    T = module.pose(q)
    found = module.ik(T, q[:, 6]) if q.shape[1] == 7 else module.ik(T)
    return T, found.q, found.status


@pytest.mark.parametrize("near", [0, 1e-15, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-3])
def test_near_a_fold_every_pose_has_solutions_that_reach_it(folding: tuple, near: float) -> None:
    """Squares of the distance lose half of its digits there; half of the wrists are in line too."""
    module, joints, fold = folding
    rng, elbow = np.random.default_rng(6), 3 if joints == 7 else 2
    q = rng.uniform(-np.pi, np.pi, (4000, joints))
    for angle in (fold, fold - np.pi):
        q[:, elbow] = angle + near * rng.standard_normal(4000)
        aligned = rng.choice([-1, 1], 2000) * np.pi / 2 + near * rng.standard_normal(2000)
        q[::2, elbow + 1] = aligned
        T, found, status = answers(module, q)
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        away, turned = misses(module.pose(found), T, status)
        assert away < 2e-11 and turned < 2e-11


def test_all_postures_are_among_the_solutions(folding: tuple) -> None:
    module, joints, _ = folding
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (2000, joints))
    T, found, status = answers(module, q)
    away, turned = misses(module.pose(found), T, status)
    assert away < 2e-11 and turned < 2e-11
    same = np.abs(np.exp(1j * found) - np.exp(1j * q[:, None])).max(axis=-1)
    assert np.nanmin(same, axis=-1).max() < 1e-6


FIVE = [(0, pi / 2, 1), (1, 0, 0), (0, pi / 2, 0), (0, -pi / 2, 1), (Rational(1, 4), 0, 0)]
"""A roll along the second link, and a bend after it: five joints reach few directions."""


@pytest.mark.parametrize("turret", [0, Rational(1, 4)])
def test_an_arm_of_five_joints_reaches_the_direction_where_it_folds(
    tmp_path: Path, turret: Rational
) -> None:
    """The joint before the fold was taken from a direction that rounding decides: all were lost."""
    d, serial = arm([(turret, *FIVE[0][1:]), *FIVE[1:]])
    solved(d, serial, propose(serial).source)
    serial.export(d)
    (inverse,) = prove(d).inverses
    assert inverse.branches == inverse.solutions == 4
    module, rng = printed(d, tmp_path), np.random.default_rng(7)
    for near, most in ((1e-12, 10), (1e-11, 1), (1e-10, 0), (1e-9, 0), (1e-7, 0)):
        q = rng.uniform(-np.pi, np.pi, (2000, 5))
        q[:, 2] = 3 * np.pi / 2 + near * rng.uniform(-1, 1, 2000)
        T = module.pose(q)
        found = module.ik(T)
        lost = ~np.isin(found.status, (OK, SINGULAR)).any(axis=-1)
        assert lost.sum() <= most, near
        away, turned = misses(module.pose(found.q), T, found.status)
        assert away < 2e-12 and turned < 2e-12
