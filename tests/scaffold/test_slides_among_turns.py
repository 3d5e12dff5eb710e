"""Slides among one or two joints that turn: the directions of some depend on the posture."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, misses
from chains import arm
from proposals import Proposals, names
from sympy import pi

from closedform.scaffold.chains.propose import NoChainError, propose

A, B, D = (sp.Rational(n, 100) for n in (5, 40, 11))
TWO, THREE = (f"{n} slides among two joints that turn" for n in ("two", "three"))
PLANE = "a turn between two slides in its plane, and two more"
ARMS = {
    "lift, boom and telescope": (
        [(0, -pi / 2, None, 0), (A, pi / 2, D), (B, 0, None, 0), (A, 0, D)], TWO, 1,
    ),
    "boom that slides and tilts": (
        [(0, pi / 2, D), (0, 0, None, 0), (A, pi / 2, D), (0, 0, None, 0)], TWO, 1,
    ),
    "oblique slides": (
        [(A, pi / 3, D), (B, pi / 4, None, pi / 6), (A, pi / 3, D), (A, 0, None, pi / 2)], TWO, 1,
    ),
    "slides that follow each other": (
        [(A, pi / 2, D), (0, pi / 2, None, pi / 2), (0, pi / 4, None, 0), (B, pi / 3, D)], TWO, 1,
    ),
    "slides at both ends": (
        [(0, pi / 3, None, 0), (A, pi / 2, D), (B, pi / 3, D), (0, 0, None, 0)], TWO, 1,
    ),
    "gantry with a boom that slides": (
        [(0, pi / 2, None, pi / 2), (0, pi / 2, None, 0), (A, pi / 2, D), (B, pi / 3, None, 0),
         (A, 0, D)],
        THREE, 1,
    ),
    "telescope of two slides": (
        [(A, pi / 2, D), (0, pi / 3, None, pi / 6), (A, pi / 2, D), (0, pi / 3, None, 0),
         (A, pi / 4, None, pi / 2)],
        THREE, 1,
    ),
    "one joint that turns": (
        [(0, pi / 3, None, 0), (A, pi / 3, None, 0), (A, pi / 3, D), (0, pi / 2, None, pi / 2)],
        "three slides among a joint that turns", 1,
    ),
    "telescope on a rail, with a wrist": (
        [(0, -pi / 2, None, 0), (0, -pi / 2, D), (A, pi / 2, None, pi / 2), (0, pi / 2, 0),
         (D, 0, B)],
        PLANE, 2,
    ),
    "slides at the tool": (
        [(0, pi / 2, D), (0, pi / 2, 0), (0, -pi / 2, None, pi / 2), (0, pi / 2, B),
         (A, 0, None, 0)],
        PLANE, 2,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


@pytest.mark.parametrize("name", ARMS)
def test_other_poses_are_out_of_reach(name: str, folder: Path) -> None:
    q = np.random.default_rng(3).uniform(-3, 3, (50, len(ARMS[name][0])))
    T = PROPOSALS.pose(name, q)
    turned = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    T[:, :3, :3] = T[:, :3, :3] @ turned
    assert (PROPOSALS.made(name, folder).ik(T).status == UNREACHABLE).all()


def test_slides_that_are_parallel_share_their_way(folder: Path) -> None:
    """One of them is at 0 then, and the status is SINGULAR; near there both are determined."""
    name = "lift, boom and telescope"
    robot = PROPOSALS.made(name, folder)
    q = np.random.default_rng(4).uniform(-3, 3, (60, 4))
    q[:20, 1], q[20:40, 1] = 0, np.pi
    q[40:, 1] = np.geomspace(1e-13, 1e-2, 20)
    T = PROPOSALS.pose(name, q)
    answers, status = robot.ik(T)
    assert max(misses(PROPOSALS.pose(name, answers[:, 0])[:, None], T, status)) < 1e-13
    assert (status[:40] == SINGULAR).all() and (answers[:40, 0, 2] == 0).all()
    assert (status[40:] == OK).all()


def test_a_telescope_beside_its_wrist_is_refused() -> None:
    rows = [(0, -pi / 2, None, 0), (A, -pi / 2, D), (A, pi / 2, None, pi / 2), (0, pi / 2, D),
            (0, 0, B)]  # fmt: skip
    with pytest.raises(NoChainError) as error:
        propose(arm(rows, names(rows))[1], count=False)
    assert any("beside the line along which" in t.error.found for t in error.value.tried)


def test_slides_of_three_stretches_are_refused() -> None:
    rows = [(0, pi / 3, None, 0), (A, pi / 3, D), (0, pi / 3, None, 0), (A, pi / 3, D),
            (0, 0, None, 0)]  # fmt: skip
    with pytest.raises(NoChainError) as error:
        propose(arm(rows, names(rows))[1], count=False)
    assert any("between other joints that turn" in t.error.found for t in error.value.tried)
