"""Arms of seven joints by the arm angle, beside a Denavit-Hartenberg table and plain geometry."""

import doctest
import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from closedform import robots
from closedform.robots import seven_joints
from closedform.robots.seven_joints import Parameters, arm_angle, fk, ik

IIWA_7, IIWA_14 = (robots.load(name).parameters for name in ("iiwa7", "iiwa14"))
ARMS = [IIWA_7, IIWA_14, Parameters(-0.1, 0.5, 0.2, 0.0)]
FOLDER = Path(__file__).parents[1] / "benchmarks" / "arms"
OK, UNREACHABLE, SINGULAR, INVALID = range(4)


def frames(q, arm):
    """The frames of the links, from the table that the field uses (Faria et al., 2018)."""
    twists = np.radians([-90, 90, 90, -90, -90, 90, 0])
    T = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))
    found = [T]
    for i, d in enumerate([arm.d_bs, 0, arm.d_se, 0, arm.d_ew, 0, arm.d_wf]):
        c, s = np.cos(q[..., i]), np.sin(q[..., i])
        ca, sa = np.cos(twists[i]), np.sin(twists[i])
        A = np.zeros((*q.shape[:-1], 4, 4))
        A[..., 0, 0], A[..., 0, 1], A[..., 0, 2] = c, -s * ca, s * sa
        A[..., 1, 0], A[..., 1, 1], A[..., 1, 2] = s, c * ca, -c * sa
        A[..., 2, 1], A[..., 2, 2], A[..., 2, 3], A[..., 3, 3] = sa, ca, d, 1
        T = T @ A
        found.append(T)
    return found


def away(a, b):
    """The largest difference of the angles, modulo turns."""
    return np.abs((a - b + np.pi) % (2 * np.pi) - np.pi).max(-1)


def postures(n, seed):
    """Random joints; in half of them one or more are at or near 0, a quarter or half a turn."""
    rng = np.random.default_rng(seed)
    q = rng.uniform(-np.pi, np.pi, (n, 7))
    special = rng.choice([0, np.pi, -np.pi, np.pi / 2, -np.pi / 2], (n, 7))
    special += rng.choice([0, 0, 1e-15, -1e-13, 1e-10, 1e-8, -1e-6, 1e-4], (n, 7))
    chosen = (rng.random((n, 7)) < 0.4) & (rng.random((n, 1)) < 0.5)
    return np.where(chosen, special, q)


@pytest.mark.parametrize("arm", ARMS)
def test_the_pose_is_that_of_the_table(arm):
    q = postures(1000, 1)
    assert np.abs(fk(q, arm) - frames(q, arm)[7]).max() < 1e-14


@pytest.mark.parametrize("arm", ARMS)
def test_the_jacobians_are_the_differences_of_the_pose(arm):
    q, h = postures(200, 4), 1e-5
    T = frames(q, arm)[7]
    inverse = np.linalg.inv(T)
    for j, step in enumerate(h * np.eye(7)):
        rate = (frames(q + step, arm)[7] - frames(q - step, arm)[7]) / (2 * h)
        for twist, found in (
            (rate @ inverse, seven_joints.jacobian_space(q, arm)),
            (inverse @ rate, seven_joints.jacobian_body(q, arm)),
        ):
            assert np.abs(twist[:, :3, 3] - found[:, :3, j]).max() < 1e-8
            omega = np.stack([twist[:, 2, 1], twist[:, 0, 2], twist[:, 1, 0]], axis=-1)
            assert np.abs(omega - found[:, 3:, j]).max() < 1e-8


@pytest.mark.parametrize("arm", ARMS)
def test_the_arm_angle_turns_the_elbow_about_the_line_to_the_wrist(arm):
    q = np.random.default_rng(2).uniform(-3, 3, (1000, 7))
    found = frames(q, arm)
    w = found[5][:, :3, 3] - [0, 0, arm.d_bs]
    w /= np.linalg.norm(w, axis=-1, keepdims=True)
    elbow = -found[3][:, :3, 2]  # joint 4 turns about -y
    normal = np.cross([0, 0, 1], w)
    psi = np.arctan2(np.sum(w * np.cross(normal, elbow), -1), np.sum(normal * elbow, -1))
    assert away(psi[:, None], arm_angle(q, arm)[:, None]).max() < 1e-12


@pytest.mark.parametrize("arm", ARMS)
def test_no_posture_is_lost(arm):
    """On the singular sets and near them, too: of those only the pose is compared."""
    q = postures(40000, 3)
    T, psi = frames(q, arm)[7], arm_angle(q, arm)
    found = ik(T, psi, arm)
    assert np.isin(found.status, [OK, SINGULAR]).all()
    reach = sum(map(abs, arm))
    assert np.abs(frames(found.q, arm)[7] - T[:, None]).max() < 1e-12 * reach
    generic = np.abs(np.sin(q[:, [1, 3, 5]])).min(-1) > 1e-3
    w = frames(q, arm)[5][:, :3, 3]
    generic &= np.hypot(w[:, 0], w[:, 1]) > 1e-3
    generic &= np.linalg.norm(w - [0, 0, arm.d_bs], axis=-1) > 1e-3
    assert generic.sum() > 20000
    miss = away(found.q, q[:, None])[generic]
    assert miss.min(-1).max() < 1e-8
    assert (found.status[generic][np.arange(len(miss)), miss.argmin(-1)] == OK).all()
    there = arm_angle(found.q, arm)
    assert away(there[..., None], psi[:, None, None])[generic].max() < 1e-8


def test_the_eight_postures_differ_and_have_the_signs_of_their_names():
    q = np.array([0.3, 0.8, -0.4, 1.1, 0.5, -0.7, 0.2])
    found = ik(fk(q), arm_angle(q))
    signs = [
        "_".join(
            f"{name}_{'positive' if np.sin(p[j]) > 0 else 'negative'}"
            for name, j in (("elbow", 3), ("shoulder", 1), ("wrist", 5))
        )
        for p in found.q
    ]
    assert tuple(signs) == seven_joints.BRANCHES
    assert (found.q > -np.pi).all() and (found.q <= np.pi).all()


def test_where_the_arm_angle_has_no_plane_the_plane_of_x_and_z_is_taken():
    t4 = 1.2
    tilt = np.arctan2(0.4 * np.sin(t4), 0.4 + 0.4 * np.cos(t4))  # lays w on the first axis
    q = np.array([0.7, tilt, 0.0, t4, 0.4, 0.9, -0.3])
    found = ik(fk(q), 0.7)
    assert (found.status == SINGULAR).all()
    assert np.abs(fk(found.q) - fk(q)).max() < 1e-14
    assert away(found.q, q).min() < 1e-12
    assert abs(arm_angle(q) - 0.7) < 1e-12


def test_an_arm_stretched_or_folded_reaches_its_pose():
    for t4, expected in ((0.0, OK), (np.pi, SINGULAR)):
        q = np.array([0.3, 0.8, -0.4, t4, 0.5, -0.7, 0.2])
        T = fk(q)
        found = ik(T, arm_angle(q))
        assert (found.status == expected).all()
        assert np.abs(fk(found.q) - T).max() < 1e-14


def test_statuses_and_errors():
    far = np.eye(4)
    far[0, 3] = 2
    assert (ik(far, 0.0).status == UNREACHABLE).all() and np.isnan(ik(far, 0.0).q).all()
    T = fk([0.3, 0.8, -0.4, 1.1, 0.5, -0.7, 0.2])
    mirrored = T.copy()
    mirrored[:3, 0] *= -1
    projective = T.copy()
    projective[3, 0] = 1
    impossible = IIWA_7._replace(d_se=-0.4)
    for pose, psi, arm in (
        (mirrored, 0, IIWA_7),
        (projective, 0, IIWA_7),
        (T * np.nan, 0, IIWA_7),
        (T, np.inf, IIWA_7),
        (T, 0, impossible),
    ):
        found = ik(pose, psi, arm)
        assert (found.status == INVALID).all() and np.isnan(found.q).all()
    with pytest.raises(ValueError, match=r"expected \(\.\.\., 4, 4\)"):
        ik(np.eye(3), 0.0)
    with pytest.raises(ValueError, match=r"expected \(\.\.\., 7\)"):
        fk(np.zeros(6))


def test_arm_angles_of_one_pose_broadcast():
    T = fk([0.3, 0.8, -0.4, 1.1, 0.5, -0.7, 0.2])
    found = ik(T, np.linspace(-3, 3, 5))
    assert found.q.shape == (5, 8, 7) and found.status.shape == (5, 8)
    assert ik(np.empty((0, 4, 4)), 0.0).q.shape == (0, 8, 7)


def test_the_examples_run_as_printed():
    assert doctest.testmod(seven_joints).failed == 0
    guide = Path(__file__).parents[1] / "docs" / "using.md"
    [code] = re.findall(r"^```python seven\n(.*?)^```", guide.read_text("utf-8"), re.M | re.S)
    names = {}
    exec(code, names)
    assert names["found"].q.shape == (73, 8, 7)
    assert 0 < names["inside"].sum() < names["inside"].size


def test_the_iiwa_14_is_that_of_its_table():
    rows = (FOLDER / "iiwa14.csv").read_text("utf-8").splitlines()[3:]
    lengths = [float(row.split(",")[2]) for row in rows]
    assert lengths == [IIWA_14.d_bs, 0, IIWA_14.d_se, 0, IIWA_14.d_ew, 0, IIWA_14.d_wf]


@pytest.mark.parametrize("name", ["iiwa7", "xmatepro7"])
def test_the_arms_are_those_of_their_urdfs(name):
    """By the product of the joints; the file of the iiwa ends with a fixed frame."""
    arm, moved = robots.load(name), np.random.default_rng(5).uniform(-2, 2, (10, 7))
    there = np.broadcast_to(np.eye(4), (10, 4, 4))
    limits, k = [], 0
    for joint in ElementTree.parse(FOLDER / f"{name}.urdf").getroot().iter("joint"):
        step = np.tile(np.eye(4), (10, 1, 1))
        step[:, :3, 3] = np.array(joint.find("origin").get("xyz").split(), float)
        if joint.get("type") == "revolute":
            axis = np.array(joint.find("axis").get("xyz").split(), float)
            K = np.cross(axis, np.eye(3)).T
            s, c = np.sin(moved[:, k, None, None]), np.cos(moved[:, k, None, None])
            step[:, :3, :3] += s * K + (1 - c) * K @ K
            bounds = joint.find("limit")
            limits.append([float(bounds.get("lower")), float(bounds.get("upper"))])
            k += 1
        there = there @ step
    assert np.abs(arm.fk(moved) - there).max() < 1e-12
    assert np.abs(np.array(limits).T - arm.limits).max() < 1e-3
