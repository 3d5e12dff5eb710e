"""Joints that turn about one direction or slide, and others beside them: SCARA arms, jib cranes."""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import UNREACHABLE
from chains import arm
from proposals import Proposals, names
from sympy import pi

from closedform.scaffold.chains.propose import NoChainError, propose

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 35, 11))
LINKS = "three joints that turn about one direction, a slide and "
JIB = "two joints that turn about one direction, two slides and "
BOOM = "a turn, two joints that turn about one direction, a slide and two more"
LIFT, RADIAL = (0, -pi / 2, None, 0), (0, pi / 2, None, 0)
ARMS = {
    "SCARA with an offset wrist": (
        [(B, 0, D), (C, 0, 0), (0, 0, None, 0), (A, pi / 2, D), (A, -pi / 2, D), (0, 0, D)],
        LINKS + "two more", 4,
    ),
    "SCARA with an oblique wrist": (
        [(B, 0, D), (C, 0, 0), (0, 0, None, 0), (A, pi / 3, D), (A, -pi / 3, A), (0, 0, D)],
        LINKS + "two more", 4,
    ),
    "SCARA with a wrist, seen from the tool": (
        [(0, pi / 2, D), (A, -pi / 2, D), (B, 0, 0), (C, 0, D), (0, 0, 0), (A, pi / 2, None, 0)],
        LINKS + "two more", 4,
    ),
    "SCARA on a lift that leans": (
        [(0, pi / 6, None, pi / 2), (B, 0, D), (C, 0, 0), (A, pi / 2, D), (A, pi / 3, A)],
        LINKS + "one more", 2,
    ),
    "jib with an offset wrist": (
        [(0, 0, D), LIFT, RADIAL, (A, pi / 2, D), (A, -pi / 2, D), (0, 0, D)], JIB + "two more", 4,
    ),
    "jib beside its column": (
        [(A, 0, D), (A, -pi / 2, None, 0), RADIAL, (A, pi / 2, D), (A, -pi / 2, A), (0, 0, D)],
        JIB + "two more", 4,
    ),
    "jib beside its column with an oblique wrist": (
        [(A, 0, D), (A, -pi / 2, None, 0), RADIAL, (A, pi / 3, D), (A, pi / 4, A), (0, 0, D)],
        JIB + "two more", 4,
    ),
    "gantry that tilts, with two links": (
        [(0, pi / 2, None, pi / 2), (0, 0, None, 0), (B, 0, D), (A, pi / 2, A), (A, 0, D)],
        JIB + "one more", 2,
    ),
    "gantry that tilts, seen from the tool": (
        [(A, pi / 2, D), (B, 0, D), (0, 0, None, 0), (A, pi / 2, A), (0, 0, None, 0)],
        JIB + "one more", 2,
    ),
    "jib with two axes that meet": (
        [(0, pi / 2, D), (A, -pi / 2, None, 0), (A, pi / 2, D), (0, pi / 3, 0), (A, 0, A)],
        "two joints that turn about one direction, a slide and two more", 4,
    ),
    "telehandler": (
        [(A, pi / 2, D), (0, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (0, pi / 2, D),
         (0, 0, D)],
        BOOM, 8,
    ),
    "telehandler whose boom is offset": (
        [(A, pi / 2, D), (D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (0, pi / 2, D),
         (0, 0, D)],
        BOOM, 8,
    ),
    "telehandler with an oblique wrist": (
        [(A, pi / 2, D), (D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 3, A), (0, pi / 4, D),
         (0, 0, D)],
        BOOM, 8,
    ),
    "telehandler from the tool": (
        [(0, pi / 3, D), (A, pi / 2, D), (0, pi / 2, C), (A, -pi / 2, None, 0), (D, pi / 2, A),
         (0, 0, D)],
        BOOM, 8,
    ),
    "telehandler of five joints": (
        [(A, pi / 2, D), (D, pi / 2, 0), (0, -pi / 2, None, 0), (C, pi / 2, A), (0, 0, D)],
        BOOM[:-8] + "one more", 4,
    ),
    "crane with a telescopic jib": (
        [(A, pi / 2, D), (B, 0, 0), (A, pi / 2, A), (0, 0, None, 0), (0, 0, D)],
        BOOM[:-8] + "one more", 4,
    ),
    "crane with a telescopic jib that tilts": (
        [(A, pi / 2, D), (B, 0, 0), (A, pi / 2, A), (0, -pi / 3, None, pi / 2), (A, 0, D)],
        BOOM[:-8] + "one more", 4,
    ),
    "crane with a telescopic jib, from the tool": (
        [(0, pi / 3, D), (0, pi / 2, None, 0), (A, 0, D), (B, pi / 2, A), (0, 0, D)],
        BOOM[:-8] + "one more", 4,
    ),
    "arm on a column that turns, with a roll": (
        [(0, 0, None, 0), (A, pi / 2, D), (B, 0, 0), (C, pi / 2, 0), (0, 0, D)],
        BOOM[:-8] + "one more", 4,
    ),
    "cylindrical arm with pitch and roll": (
        [(0, 0, D), LIFT, (0, pi / 2, None, pi / 2), (A, pi / 2, A), (0, 0, D)],
        "a turn, one joint that turns, two slides and one more", 2,
    ),
    "cylindrical arm with pitch and an oblique roll": (
        [(A, 0, D), LIFT, (A, pi / 2, None, pi / 2), (A, pi / 3, A), (0, 0, D)],
        "a turn, one joint that turns, two slides and one more", 2,
    ),
    "gantry with two links and an offset wrist": (
        [(0, pi / 2, None, pi / 2), (0, 0, None, 0), (B, 0, D), (C, pi / 2, A), (A, pi / 2, A),
         (0, 0, D)],
        JIB + "two more", 4,
    ),
    "gantry with two links and an offset wrist, from the tool": (
        [(0, pi / 2, D), (A, pi / 2, A), (C, 0, A), (B, 0, D), (0, pi / 2, None, pi / 2),
         (0, 0, None, 0)],
        JIB + "two more", 4,
    ),
    "slides that turn, with an offset wrist": (
        [(B, 0, D), (C, 0, A), (0, pi / 2, None, pi / 2), (0, pi / 2, None, pi / 2),
         (A, pi / 2, A), (0, 0, D)],
        JIB + "two more", 4,
    ),
    "SCARA that tilts": (
        [(B, 0, D), (C, 0, 0), (0, 0, None, 0), (A, pi / 2, D), (A, pi / 3, A)],
        LINKS + "one more", 2,
    ),
    "jib that tilts": (
        [(0, 0, D), LIFT, RADIAL, (A, pi / 2, D), (A, 0, A)], JIB + "one more", 2,
    ),
    "five joints, the last two pass each other": (
        [(B, 0, D), (C, 0, 0), (A, pi / 2, A), (A, pi / 2, A), (0, 0, D)],
        "axes 1, 2 and 3 parallel, 4 and 5 skew", 2,
    ),
    "five joints with an oblique pair": (
        [(B, 0, D), (C, 0, 0), (A, pi / 3, A), (A, pi / 4, A), (0, 0, D)],
        "axes 1, 2 and 3 parallel, 4 and 5 skew", 2,
    ),
    "five joints from the tool": (
        [(0, pi / 2, D), (A, pi / 2, D), (B, 0, 0), (C, 0, A), (0, 0, 0)],
        "axes 5, 4 and 3 parallel, 2 and 1 meet", 4,
    ),
}  # fmt: skip


PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()


@pytest.mark.parametrize("name", [name for name in ARMS if len(ARMS[name][0]) == 5])
def test_other_poses_are_out_of_reach(name: str, folder: Path) -> None:
    rng = np.random.default_rng(3)
    T = PROPOSALS.pose(name, rng.uniform(-3, 3, (50, 5)))
    turned = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0], [0.48, 0.64, 0.6]])
    if "one more" in ARMS[name][1]:  # its slides reach any position
        T[:, :3, :3] = T[:, :3, :3] @ turned
    else:
        T[:, :3, 3] += 1e-6 * (T[:, :3, 2] if "tool" in name else np.array([0, 0, 1]))
    assert (PROPOSALS.made(name, folder).ik(T).status == UNREACHABLE).all()


def test_a_slide_that_reaches_only_in_some_postures_is_named() -> None:
    """A log loader: where two axes of its wrist are parallel, its jib reaches in some postures."""
    rows = [(A, pi / 2, D), (B, 0, 0), (A, pi / 2, A), (0, 0, None, 0), (0, pi / 2, A), (0, 0, D)]
    with pytest.raises(NoChainError, match="its slides reach the tool only in some postures"):
        propose(arm(rows, names(rows))[1])


@pytest.mark.parametrize(
    ("rows", "free", "held"),
    [
        ([(0, pi / 2, None, pi / 2), (0, 0, D), (B, 0, 0), (0, pi / 2, A), (0, 0, D)],
         "joints t2 and t3", "'# t2 = 0.1 rad: held'"),
        ([(0, 0, None, 0), (1, 0, 0), (0, pi / 2, None, 0), (0, pi / 2, A), (A, pi / 2, 0),
          (0, 0, D)], "joints d1 and d3", "'# d1 = 0.1 m: held'"),
    ],
)  # fmt: skip
def test_joints_that_move_while_the_tool_stands_still_are_named(
    rows: list, free: str, held: str
) -> None:
    with pytest.raises(NoChainError, match=f"at every posture its {free} can move") as caught:
        propose(arm(rows, names(rows))[1])
    assert held in caught.value.needed
