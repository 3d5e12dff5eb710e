"""The IRB 2400 against an independent forward map, and its parallelogram against its motors."""

import numpy as np
from arms import OK
from closedform.generated.numpy import irb2400

RANDOM = np.random.default_rng(5)
a1, d1, a2, a3, d4, d6 = irb2400.Parameters()


def about(axis: str, angle: float) -> np.ndarray:
    """The homogeneous rotation about an axis of coordinates."""
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    T = np.eye(4)
    T[i, i] = T[j, j] = np.cos(angle)
    T[j, i], T[i, j] = np.sin(angle), -np.sin(angle)
    return T


def along(x: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[0, 3], T[2, 3] = x, z
    return T


def link_by_link(q: np.ndarray) -> np.ndarray:
    """The pose from the drawing: all links in the plane of x and z, without a table of joints."""
    T = about("z", q[0]) @ along(a1, d1) @ about("y", q[1]) @ along(0, a2)
    T = T @ about("y", q[2]) @ along(d4, a3) @ about("x", q[3]) @ about("y", q[4])
    return T @ about("x", q[5]) @ along(d6, 0) @ about("y", np.pi / 2) @ about("z", np.pi)


def test_pose_is_that_of_the_drawing() -> None:
    for q in RANDOM.uniform(-np.pi, np.pi, (50, 6)):
        np.testing.assert_allclose(irb2400.pose(q), link_by_link(q), atol=1e-14)


def test_eight_postures_reach_a_pose_within_reach() -> None:
    q = np.array([0.3, 0.4, 0.1, 0.5, 0.7, -0.2])
    found = irb2400.ik(irb2400.pose(q))
    assert (found.status[:4] == OK).all()
    for posture in found.q[found.status == OK]:
        np.testing.assert_allclose(irb2400.pose(posture), irb2400.pose(q), atol=1e-14)
    gaps = np.abs(np.angle(np.exp(1j * (found.q - q)))).max(-1)
    assert np.nanmin(gaps) < 1e-14
    near = irb2400.ik(along(0.9, 1.0) @ about("y", np.pi))
    assert (near.status == OK).sum() >= 4


def test_branches_are_what_their_names_say() -> None:
    seen = set()
    for q in RANDOM.uniform(-np.pi, np.pi, (200, 6)):
        found = irb2400.ik(irb2400.pose(q))
        for name, posture in zip(irb2400.BRANCHES, found.q, strict=True):
            if np.isnan(posture).any():
                continue
            facing, side, flip = name.split("_")
            shoulder = np.array([a1, d1])
            elbow = shoulder + a2 * np.array([np.sin(posture[1]), np.cos(posture[1])])
            wrist = (link_by_link([0, *posture[1:]]) @ [0, 0, -d6, 1])[[0, 2]]
            assert (facing == "facing") == (wrist[0] >= 0)
            assert (flip == "noflip") == (np.sin(posture[4]) >= 0)
            along_line, to_elbow = wrist - shoulder, elbow - shoulder
            above = along_line[0] * to_elbow[1] - along_line[1] * to_elbow[0]
            above *= np.sign(along_line[0]) * (-1 if 0 <= wrist[0] < a1 else 1)
            assert (side == "up") == (above >= 0)
            seen.add(name)
    assert seen == set(irb2400.BRANCHES)


def test_the_rod_of_the_parallelogram_keeps_its_length() -> None:
    """A crank on the turret, turned by motor 3, and a point of the forearm are a2 apart."""
    r, gamma = 0.2, 2.5
    for m in RANDOM.uniform(-2, 2, (20, 6)):
        q = irb2400.joints_from_motors(m)
        np.testing.assert_allclose(irb2400.motors_from_joints(q), m, atol=1e-15)
        crank = r * np.array([np.sin(m[2] + gamma), np.cos(m[2] + gamma)])
        elbow = a2 * np.array([np.sin(q[1]), np.cos(q[1])])
        turn = about("y", q[1] + q[2])[np.ix_([0, 2], [0, 2])]
        lug = elbow + turn @ (r * np.array([np.sin(gamma), np.cos(gamma)]))
        assert abs(np.linalg.norm(lug - crank) - a2) < 1e-14
