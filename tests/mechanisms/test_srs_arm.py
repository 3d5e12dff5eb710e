"""The arm of seven joints by its arm angle, against products of exponentials of its drawing."""

import numpy as np
import pytest
from arms import OK, SINGULAR, by_screws, check_jacobians, misses, wrapped
from closedform.generated.numpy import srs_arm

RANDOM = np.random.default_rng(5)
ARMS = [
    srs_arm.Parameters(),
    srs_arm.Parameters(d_bs=-0.1, d_se=0.5, d_ew=0.2, d_wf=0.0),
    srs_arm.Parameters(d_bs=0.3, d_se=0.1, d_ew=0.7, d_wf=-0.2),
]
AXES = np.array([[0, 0, 1], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1], [0, 1, 0], [0, 0, 1]])


def heights(arm: srs_arm.Parameters) -> np.ndarray:
    """Those of the shoulder, the elbow, the wrist and the flange at zero angles."""
    return np.cumsum(arm)


def drawn(q: np.ndarray, arm: srs_arm.Parameters, joints: int = 7) -> np.ndarray:
    """What the first joints do to what is fixed to them; of all of them, the pose of the flange."""
    shoulder, elbow, wrist, flange = ([0, 0, z] for z in heights(arm))
    points = [shoulder] * 3 + [elbow] + [wrist] * 3
    home = np.eye(4)
    home[2, 3] = flange[2] if joints == 7 else 0.0
    return by_screws(list(zip(AXES, points, strict=True))[:joints], home, q[..., :joints])


def places(q: np.ndarray, arm: srs_arm.Parameters) -> tuple[np.ndarray, np.ndarray]:
    """The elbow and the wrist, seen from the shoulder."""
    shoulder, elbow, wrist, _ = ([0, 0, z, 1] for z in heights(arm))
    at_elbow = (drawn(q, arm, 3) @ elbow)[..., :3] - shoulder[:3]
    return at_elbow, (drawn(q, arm, 4) @ wrist)[..., :3] - shoulder[:3]


def turned(q: np.ndarray, arm: srs_arm.Parameters) -> np.ndarray:
    """The arm angle by geometry: the turn of the axis of the elbow about the line to the wrist."""
    axis = (drawn(q, arm, 3)[..., :3, :3] @ AXES[3]) * -1
    w = places(q, arm)[1]
    w = w / np.linalg.norm(w, axis=-1, keepdims=True)
    level = np.cross([0, 0, 1], w)
    return np.arctan2((np.cross(level, axis) * w).sum(-1), (level * axis).sum(-1))


@pytest.mark.parametrize("arm", ARMS)
def test_the_pose_and_the_points_are_those_of_the_drawing(arm: srs_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (50, 7))
    np.testing.assert_allclose(srs_arm.pose(q, arm), drawn(q, arm), atol=1e-14)
    points, shoulder = srs_arm.skeleton(q, arm), np.array([0, 0, arm.d_bs])
    for name, place in zip(("joint4", "joint6"), places(q, arm), strict=True):
        k = srs_arm.SKELETON.points.index(name)
        np.testing.assert_allclose(points[:, k], shoulder + place, atol=1e-14)


def test_the_jacobians_are_differences_of_the_drawing() -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (20, 7))
    check_jacobians(srs_arm, lambda q: drawn(q, srs_arm.Parameters()), q)


@pytest.mark.parametrize("arm", ARMS)
def test_the_arm_angle_turns_the_elbow_about_the_line_to_the_wrist(
    arm: srs_arm.Parameters,
) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (1000, 7))
    gap = np.abs(wrapped(srs_arm.arm_angle(q, arm) - turned(q, arm)))
    assert gap.max() < 1e-11


@pytest.mark.parametrize("arm", ARMS)
def test_all_postures_of_a_pose(arm: srs_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (2000, 7))
    T, psi = srs_arm.pose(q, arm), turned(q, arm)
    found = srs_arm.ik(T, psi, arm)
    assert (found.status == OK).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12
    assert np.abs(wrapped(turned(found.q, arm) - psi[:, None])).max() < 1e-9
    gaps = np.abs(wrapped(found.q - q[:, None])).max(-1)
    assert gaps.min(-1).max() < 1e-6
    apart = np.abs(wrapped(found.q[:, :, None] - found.q[:, None])).max(-1)
    assert np.sort(apart, axis=-1)[..., 1].min() > 1e-4


@pytest.mark.parametrize("arm", ARMS)
def test_branches_are_what_their_names_say(arm: srs_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (500, 7))
    psi = RANDOM.uniform(-1.5, 1.5, 500)
    found = srs_arm.ik(srs_arm.pose(q, arm), psi, arm)
    elbow, wrist = places(found.q, arm)
    along = (elbow * wrist).sum(-1, keepdims=True) / (wrist * wrist).sum(-1, keepdims=True)
    above = (elbow - along * wrist)[..., 2]
    _, s2, _, s4, _, s6, _ = np.moveaxis(np.sin(found.q), -1, 0)
    for k, name in enumerate(srs_arm.BRANCHES):
        side, shoulder, flip = name.split("_")
        assert ((above if side == "up" else -above)[:, k] > 0).all()
        assert ((s4[:, k] < 0) == (side == "up")).all()
        assert ((s2[:, k] > 0) == (shoulder == "front")).all()
        assert ((s6[:, k] > 0) == (flip == "noflip")).all()


@pytest.mark.parametrize("arm", ARMS)
def test_the_self_motion_leaves_the_hand_and_turns_the_elbow(arm: srs_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (200, 7))
    rates = srs_arm.self_motion(q, arm)
    h = 1e-6
    moved = drawn(q + h * rates, arm) - drawn(q - h * rates, arm)
    assert np.abs(moved).max() / (2 * h) < 1e-8
    by_rates = wrapped(turned(q + h * rates, arm) - turned(q - h * rates, arm)) / (2 * h)
    far = np.linalg.norm(places(q, arm)[1], axis=-1)
    np.testing.assert_allclose(
        by_rates, -far * np.sin(q[:, 1]) * np.sin(q[:, 5]), rtol=1e-5, atol=1e-5
    )


def test_the_determinant_is_that_of_pose_and_arm_angle() -> None:
    arm, h = srs_arm.Parameters(), 1e-5
    q = RANDOM.uniform(-np.pi, np.pi, (200, 7))
    q = q[srs_arm.singularities(q, arm)[:, 3] > 0.1]
    steps = h * np.eye(7)
    row = np.stack([wrapped(turned(q + s, arm) - turned(q - s, arm)) for s in steps], -1) / (2 * h)
    J = np.concatenate([srs_arm.jacobian(q, arm), row[:, None]], axis=1)
    np.testing.assert_allclose(srs_arm.determinant(q, arm), np.linalg.det(J), atol=1e-8)


def test_the_hand_loses_a_direction_exactly_where_the_self_motion_vanishes() -> None:
    right = np.pi / 2
    places = [{3: 0.0}, {1: 0.0, 5: np.pi}, {1: np.pi, 2: right}, {5: 0.0, 4: -right}]
    others = [{1: 0.0}, {5: 0.0}, {2: right}, {4: right}, {1: 0.0, 4: right}, {5: 0.0, 2: right}]
    q = RANDOM.uniform(0.4, 1.2, 7)
    for lost, sets in ((True, places), (False, others)):
        for at in sets:
            posture = q.copy()
            posture[list(at)] = list(at.values())
            assert (np.linalg.svd(srs_arm.jacobian(posture))[1][-1] < 1e-12) == lost
            vanishes = np.abs(srs_arm.self_motion(posture) * np.sin(posture[3])).max() < 1e-12
            assert vanishes == lost


def test_a_wrist_above_the_shoulder_has_another_reference() -> None:
    """The arm angle is then counted from the plane of x and z, and the status is SINGULAR."""
    arm = srs_arm.Parameters()
    q = RANDOM.uniform(-np.pi, np.pi, (300, 7))
    q[:, 2] = 0
    q[:, 1] = np.arctan2(arm.d_ew * np.sin(q[:, 3]), arm.d_se + arm.d_ew * np.cos(q[:, 3]))
    T = srs_arm.pose(q)
    assert srs_arm.singularities(q)[:, 3].max() < 1e-15
    assert (srs_arm.arm_angle(q) == 0).all()
    found = srs_arm.ik(T, 0.7)
    assert (found.status == SINGULAR).mean() > 0.99
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12
    axis = -(drawn(found.q, arm, 3)[..., :3, :3] @ AXES[3])
    w = np.sign(places(found.q, arm)[1][..., 2])
    np.testing.assert_allclose(axis[..., 1], np.cos(0.7), atol=1e-12)
    np.testing.assert_allclose(axis[..., 0], -w * np.sin(0.7), atol=1e-12)


@pytest.mark.parametrize("near", [0, 1e-15, 1e-12, 1e-9, 1e-6])
def test_no_posture_is_lost_where_a_joint_is_free(near: float) -> None:
    arm = srs_arm.Parameters(d_ew=0.42)
    q = RANDOM.uniform(-np.pi, np.pi, (4000, 7))
    for k in (1, 3, 5):
        at = RANDOM.choice([0, np.pi, -np.pi], 4000) + near * RANDOM.standard_normal(4000)
        q[:, k] = np.where(RANDOM.random(4000) < 0.6, at, q[:, k])
    T = srs_arm.pose(q, arm)
    found = srs_arm.ik(T, srs_arm.arm_angle(q, arm), arm)
    assert np.isin(found.status, (OK, SINGULAR)).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12
