"""Slides among joints that turn, where no three neighbours meet or are parallel: rails, C-arms."""

from pathlib import Path

import pytest
import sympy as sp
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 35, 11))
WRIST = [(0, -pi / 2, B), (0, pi / 2, 0), (0, 0, 0)]
ACROSS = "spherical wrist, a slide across a turret and a joint"
ARMS = {
    "turret on a rail": (
        [(0, pi / 2, None, pi / 2), (A, pi / 2, D), (B, pi / 2, A), *WRIST], ACROSS, 8,
    ),
    "oblique turret on a rail": (
        [(0, pi / 2, None, pi / 2), (A, pi / 3, D), (B, pi / 2, A), *WRIST], ACROSS, 8,
    ),
    "rail at the tool": (
        [(0, -pi / 2, D), (0, pi / 2, 0), (B, pi / 2, A), (B, pi / 2, A), (A, pi / 2, D),
         (0, 0, None, 0)],
        "spherical shoulder, a slide across a turret and a joint", 8,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("slides_between")


@pytest.mark.parametrize("name", ARMS)
def test_every_pose_of_the_arm_is_reached(name: str, folder: Path) -> None:
    PROPOSALS.reach_every_pose(name, folder)


@pytest.mark.parametrize("name", ARMS)
def test_newton_finds_no_other_posture(name: str, folder: Path) -> None:
    PROPOSALS.are_all(name, folder)
