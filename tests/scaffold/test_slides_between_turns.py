"""Slides among joints that turn: rails, and booms beside which no two axes meet."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, misses
from chains import printed
from proposals import Proposals, forward
from sympy import pi

from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.scaffold.new import InverseSearch, new

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 35, 11))
WRIST = [(0, -pi / 2, B), (0, pi / 2, 0), (0, 0, 0)]
ACROSS = "spherical wrist, a slide across a turret and a joint"
BASE = [(0, pi / 2, None, pi / 2)] * 2
TWO = "a turret, two slides and two joints whose axes pass each other"
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
    "camera crane, whose head is offset": (
        [(0, pi / 2, D), (A, pi / 2, 0), (0, -pi / 2, None, 0), (0, pi / 2, 0), (A, pi / 2, D),
         (0, 0, D)],
        "axes 2 and 4 parallel, a slide between, 5 and 6 skew", 8,
    ),
    "crane whose boom and head are offset": (
        [(A, pi / 2, D), (D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 3, A), (A, pi / 4, D),
         (0, 0, D)],
        "axes 2 and 4 parallel, a slide between, 5 and 6 skew", 8,
    ),
    "crane from the tool": (
        [(A, pi / 4, D), (A, pi / 3, D), (C, pi / 2, A), (0, -pi / 2, None, 0), (D, pi / 2, A),
         (0, 0, D)],
        "axes 5 and 3 parallel, a slide between, 2 and 1 skew", 8,
    ),
    "boom at the base, before skew axes": (
        [(D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (A, pi / 2, D), (A, pi / 3, D),
         (0, 0, D)],
        "axes 1 and 3 parallel, a slide between, 4, 5 and 6 skew", 8,
    ),
    "boom at the base, before axes of which the last meet": (
        [(D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (A, pi / 2, D), (0, pi / 2, D),
         (0, 0, D)],
        "axes 1 and 3 parallel, a slide between, 5 and 6 meet", 8,
    ),
    "boom at the base, before axes of which the first meet": (
        [(D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (0, pi / 2, D), (A, pi / 2, D),
         (0, 0, D)],
        "axes 1 and 3 parallel, a slide between, 4 and 5 meet", 8,
    ),
    "mobile base with parallel joints": (
        [*BASE, (A, pi / 2, D), (B, 0, A), (C, pi / 2, 0), (0, 0, D)],
        "two slides beside axis 3, 4 and 5 parallel", 4,
    ),
    "mobile base with an offset wrist": (
        [*BASE, (A, pi / 2, D), (B, pi / 3, A), (C, pi / 2, A), (0, 0, D)],
        "two slides beside axis 3, 4, 5 and 6 skew", 4,
    ),
    "table of a machine tool, from the tool": (
        [(0, pi / 2, D), (A, pi / 3, C), (A, pi / 2, C), (B, pi / 2, D), (0, pi / 2, None, pi / 2),
         (0, 0, None, 0)],
        "two slides beside axis 4, 2 and 1 meet", 4,
    ),
    "slides after a turn in the middle": (
        [(A, pi / 2, D), (B, -pi / 2, 0), (0, pi / 2, None, pi / 2), (0, 0, None, pi / 2),
         (A, pi / 2, D), (A, 0, D)],
        "two slides beside axis 2, 5 and 6 skew", 4,
    ),
    "slides before a turn in the middle": (
        [(A, pi / 3, D), (0, pi / 2, None, pi / 2), (0, pi / 2, None, pi / 2), (B, pi / 3, A),
         (A, pi / 4, C), (0, 0, D)],
        "two slides beside axis 4, 5 and 6 skew", 4,
    ),
    "C-arm": (
        [(0, 0, D), (0, -pi / 2, None, 0), (0, 0, None, pi / 2), (A, pi / 2, D), (A, 0, D)], TWO, 2,
    ),
    "C-arm on a lift": (
        [(0, 0, None, 0), (A, -pi / 2, D), (0, 0, None, 0), (A, pi / 2, D), (A, 0, D)], TWO, 2,
    ),
    "C-arm from the tool": (
        [(A, pi / 2, D), (A, pi / 3, D), (0, pi / 2, None, 0), (0, -pi / 4, None, 0), (0, 0, D)],
        TWO, 2,
    ),
    "C-arm whose slides and axes lean": (
        [(A, 0, D), (0, pi / 3, None, pi / 2), (0, pi / 3, None, pi / 6), (A, pi / 3, D),
         (A, 0, D)],
        TWO, 2,
    ),
    "gantry of two slides with a tilt": (
        [*BASE, (A, pi / 2, D), (A, pi / 2, C), (0, 0, D)], TWO, 2,
    ),
    "lift with a telescope and a tilt": (
        [(0, -pi / 2, None, 0), (0, pi / 2, None, 0), (0, pi / 2, D), (A, pi / 2, C), (0, 0, D)],
        TWO, 2,
    ),
    "oblique slides from the tool": (
        [(A, pi / 2, 0), (A, pi / 2, D), (A, pi / 3, C), (0, pi / 3, None, pi / 2),
         (0, 0, None, 0)],
        TWO, 2,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


@pytest.mark.parametrize("name", [name for name in ARMS if len(ARMS[name][0]) == 5])
def test_other_poses_are_out_of_reach(name: str, folder: Path) -> None:
    T = PROPOSALS.pose(name, np.random.default_rng(3).uniform(-3, 3, (50, 5)))
    turned = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    T[:, :3, :3] = T[:, :3, :3] @ turned
    assert (PROPOSALS.made(name, folder).ik(T).status == UNREACHABLE).all()


GIVEN = """\
a, alpha, d, theta
0.17, -pi/2, 0, t1
0, pi/2, d2, 0
0, 0, 0.23, t3
0, -pi/2, 0.59, t4
0, pi/2, 0, t5
0.11, -pi/2, 0.43, t6
0, 0, 0, t7
"""


def test_a_turn_beside_the_slide_may_be_given(tmp_path: Path) -> None:
    """Its sine and cosine are in the sum of the turns; the proof did not know of which angle."""
    table = tmp_path / "arm.csv"
    table.write_text(GIVEN, "utf-8")
    script = new("arm", "dh", table, search=InverseSearch(fault=fault))
    assert script.structure.endswith("a slide between, 5 and 6 meet, with t3 given")
    path = tmp_path / "arm.py"
    path.write_text(script.text, "utf-8")
    (source,) = scripts.find([str(path)])
    robot = printed(scripts.load(source), tmp_path / "printed")
    rows = [(0.17, -np.pi / 2, 0), (0, np.pi / 2, None, 0), (0, 0, 0.23), (0, -np.pi / 2, 0.59),
            (0, np.pi / 2, 0), (0.11, -np.pi / 2, 0.43), (0, 0, 0)]  # fmt: skip
    q = np.random.default_rng(4).uniform(-3, 3, (400, 7))
    q[:100, 3:] = np.round(q[:100, 3:])
    T = forward(rows, q)
    answers, status = robot.ik(T, q[:, 2])
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    reached = forward(rows, answers.reshape(-1, 7)).reshape(*answers.shape[:2], 4, 4)
    assert max(misses(reached, T, status)) < 4e-12
    turns = np.arange(7) != 1
    off = np.where(turns, np.angle(np.exp(1j * (answers - q[:, None]))), answers - q[:, None])
    assert np.nanmin(np.abs(off).max(axis=-1), axis=1)[100:].max() < 1e-8
