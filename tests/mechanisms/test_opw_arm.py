"""The arm of industry against a forward map from its drawing, and the names of its branches."""

import numpy as np
import pytest
from arms import OK, SINGULAR, check_jacobians, misses
from closedform.generated.numpy import opw_arm

RANDOM = np.random.default_rng(5)
ARMS = [
    opw_arm.Parameters(),
    opw_arm.Parameters(a1=0.15, a2=0.07, b=0.09, c1=0.5, c2=0.6, c3=0.55, c4=0.1),
    opw_arm.Parameters(a1=-0.1, a2=-0.2, b=-0.3, c1=-0.1, c2=0.3, c3=0.4, c4=-0.1),
]


def about(axis: str, angle: float) -> np.ndarray:
    """The homogeneous rotation about an axis of coordinates."""
    i, j = {"y": (2, 0), "z": (0, 1)}[axis]
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[j, i], T[i, j] = np.sin(angle), -np.sin(angle)
    return T


def along(x: float, y: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def link_by_link(q: np.ndarray, arm: opw_arm.Parameters) -> np.ndarray:
    """The pose from the drawing, without a table of joints."""
    T = about("z", q[0]) @ along(arm.a1, arm.b, arm.c1) @ about("y", q[1]) @ along(0, 0, arm.c2)
    T = T @ about("y", q[2]) @ along(arm.a2, 0, arm.c3) @ about("z", q[3])
    return T @ about("y", q[4]) @ about("z", q[5]) @ along(0, 0, arm.c4)


@pytest.mark.parametrize("arm", ARMS)
def test_pose_and_velocities_are_those_of_the_drawing(arm: opw_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (20, 6))
    drawn = np.array([link_by_link(row, arm) for row in q])
    np.testing.assert_allclose(opw_arm.pose(q, arm), drawn, atol=1e-14)
    if arm == opw_arm.Parameters():
        check_jacobians(opw_arm, lambda q: np.array([link_by_link(r, arm) for r in q]), q)


@pytest.mark.parametrize("arm", ARMS)
def test_all_postures_of_a_pose(arm: opw_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (2000, 6))
    T = opw_arm.pose(q, arm)
    found = opw_arm.ik(T, arm)
    assert max(misses(opw_arm.pose(found.q, arm), T, found.status)) < 1e-12
    gaps = np.abs(np.angle(np.exp(1j * (found.q - q[:, None])))).max(-1)
    assert np.nanmin(gaps, -1).max() < 1e-6


def test_stretched_beside_the_first_axis() -> None:
    """The wrist is as near to the first axis as b allows, and the arm at full stretch."""
    arm = opw_arm.Parameters(a1=0.2, a2=0.0, b=0.3, c1=0.0, c2=0.5, c3=0.5, c4=0.1)
    q = RANDOM.uniform(-3, 3, (500, 6))
    q[:, 1] = -np.arcsin(0.2) + RANDOM.choice([0, 1e-15, -1e-12, 1e-9], 500)
    q[:, 2] = RANDOM.choice([0, 1e-14, -1e-10, 1e-8], 500)
    T = opw_arm.pose(q, arm)
    found = opw_arm.ik(T, arm)
    assert np.isin(found.status, (OK, SINGULAR)).any(-1).all()
    assert max(misses(opw_arm.pose(found.q, arm), T, found.status)) < 1e-12


@pytest.mark.parametrize("arm", ARMS)
def test_branches_are_what_their_names_say(arm: opw_arm.Parameters) -> None:
    seen = set()
    for q in RANDOM.uniform(-np.pi, np.pi, (200, 6)):
        found = opw_arm.ik(opw_arm.pose(q, arm), arm)
        for name, posture in zip(opw_arm.BRANCHES, found.q, strict=True):
            if np.isnan(posture).any():
                continue
            facing, side, flip = name.split("_")
            shoulder = np.array([arm.a1, arm.c1])
            elbow = shoulder + arm.c2 * np.array([np.sin(posture[1]), np.cos(posture[1])])
            wrist = (link_by_link([0, *posture[1:]], arm) @ [0, 0, -arm.c4, 1])[[0, 2]]
            assert (facing == "facing") == (wrist[0] >= 0)
            assert (flip == "noflip") == (np.sin(posture[4]) >= 0)
            line, to_elbow = wrist - shoulder, elbow - shoulder
            above = line[0] * to_elbow[1] - line[1] * to_elbow[0]
            assert (side == "up") == (above >= 0 if facing == "facing" else above <= 0)
            seen.add(name)
    assert seen == set(opw_arm.BRANCHES)
