"""Arms of five joints on a rail: a slide across a turret, three parallel joints and a roll."""

from pathlib import Path

import numpy as np
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, misses
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 27, 11))
RAIL = "a rail, a turret, three parallel joints and a roll"
ALONG_Y, ALONG_X = (0, -pi / 2, None, 0), (0, pi / 2, None, pi / 2)
ARMS = {
    "offsets everywhere": (
        [ALONG_Y, (A, pi / 2, D), (B, 0, 0), (C, 0, A), (D, pi / 2, A), (0, 0, D)], RAIL, 4,
    ),
    "equal links without offsets": (
        [ALONG_Y, (0, pi / 2, D), (B, 0, 0), (B, 0, 0), (0, pi / 2, 0), (0, 0, D)], RAIL, 4,
    ),
    "links against each other": (
        [ALONG_X, (A, -pi / 2, D), (B, pi, 0), (C, 0, 0), (0, -pi / 2, 0), (0, 0, D)], RAIL, 4,
    ),
    "beside its turret": (
        [ALONG_X, (0, pi / 2, D), (C, 0, D), (B, 0, 0), (A, pi / 2, 0), (A, 0, 0)], RAIL, 4,
    ),
    "rail at the tool": (
        [(A, pi / 2, D), (B, 0, 0), (C, 0, A), (D, -pi / 2, 0), (A, pi / 2, D), (0, 0, None, 0)],
        RAIL, 4,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


def test_links_along_the_rail_leave_the_slide_free(folder: Path) -> None:
    """With the links along the rail the slide is what keeps the point within reach."""
    name = "offsets everywhere"
    robot, rng = PROPOSALS.made(name, folder), np.random.default_rng(4)
    q = rng.uniform(-3, 3, (200, 6))
    q[:, 1] = np.pi / 2 * np.repeat([1, -1], 100)
    q[::2, 3] = 1e-9  # a straight elbow
    T = PROPOSALS.pose(name, q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert (status == SINGULAR).any(axis=1).mean() > 0.9
    reached = PROPOSALS.pose(name, answers.reshape(-1, 6)).reshape(*answers.shape[:2], 4, 4)
    assert max(misses(reached, T, status)) < 1e-12


def test_a_point_beside_that_plane_is_out_of_reach(folder: Path) -> None:
    """The roll is not parallel to the turret, so the target has the plane of the links."""
    name = "offsets everywhere"
    q = np.random.default_rng(5).uniform(-1, 1, (50, 6))
    q[:, 1] = np.pi / 2
    T = PROPOSALS.pose(name, q)
    T[:, 0, 3] += 0.01  # across the rail
    answers, status = PROPOSALS.made(name, folder).ik(T)
    reached = PROPOSALS.pose(name, answers.reshape(-1, 6)).reshape(*answers.shape[:2], 4, 4)
    assert max(misses(reached, T, status)) < 1e-12
    assert np.isin(status, (OK, SINGULAR, UNREACHABLE)).all()
    assert (status == UNREACHABLE).all(axis=1).any()
