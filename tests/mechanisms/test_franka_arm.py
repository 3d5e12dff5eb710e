"""The offset arm of seven joints, against products of exponentials and published poses."""

import numpy as np
import pytest
from arms import OK, SINGULAR, by_screws, check_jacobians, misses, wrapped
from closedform.generated.numpy import franka_arm

RANDOM = np.random.default_rng(5)
PANDA = franka_arm.Parameters()
ARMS = [
    PANDA,
    franka_arm.Parameters(d1=0.267, d3=0.293, a4=0.0525, a5=0.0775, d5=0.3425, a7=0.076, d7=0.097),
    franka_arm.Parameters(*[1.0] * 7),
    franka_arm.Parameters(d1=-0.2, d3=0.3, a4=0.0, a5=0.1, d5=0.5, a7=-0.1, d7=0.0),
]
DIRECTIONS = [[0, 0, 1], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1]]


def drawn(q: np.ndarray, arm: franka_arm.Parameters = PANDA) -> np.ndarray:
    """The pose of the flange, from where the axes are if the arm points upwards."""
    elbow, wrist = arm.d1 + arm.d3, arm.d1 + arm.d3 + arm.d5
    x = arm.a4 - arm.a5
    points = [
        [0, 0, 0], [0, 0, arm.d1], [0, 0, 0], [arm.a4, 0, elbow], [x, 0, 0], [x, 0, wrist],
        [x + arm.a7, 0, 0],
    ]  # fmt: skip
    home = np.diag([1.0, -1, -1, 1])
    home[:3, 3] = x + arm.a7, 0, wrist - arm.d7
    axes = [np.array(direction, float) for direction in DIRECTIONS]
    return by_screws(list(zip(axes, points, strict=True)), home, q)


@pytest.mark.parametrize("arm", ARMS)
def test_the_pose_and_the_jacobians_are_those_of_the_drawing(arm: franka_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (50, 7))
    np.testing.assert_allclose(franka_arm.pose(q, arm), drawn(q, arm), atol=1e-14)
    if arm == PANDA:
        check_jacobians(franka_arm, drawn, q[:20])


def test_the_panda_is_ready_where_its_users_expect_it() -> None:
    """The upper arm leans back by 45 degrees and the forearm is level: the hand points down."""
    T = franka_arm.pose([0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4])
    elbow = np.array([0, 0.333]) + np.sqrt(0.5) * np.array([0.0825 - 0.316, 0.0825 + 0.316])
    flange = elbow + np.array([0.384 + 0.088, 0.0825 - 0.107])
    np.testing.assert_allclose(T[[0, 2], 3], flange, atol=1e-12)
    np.testing.assert_allclose(T[[0, 2], 3], [0.3069, 0.4869 + 0.1034], atol=1e-4)  # published
    np.testing.assert_allclose(T[:3, 2], [0, 0, -1], atol=1e-15)


@pytest.mark.parametrize("arm", ARMS)
def test_all_postures_of_a_pose(arm: franka_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (3000, 7))
    T = drawn(q, arm)
    found = franka_arm.ik(T, q[:, 6], arm)
    assert np.isin(found.status, (OK, SINGULAR)).any(-1).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12 * np.abs(arm).sum()
    gaps = np.abs(wrapped(found.q - q[:, None])).max(-1)
    assert np.nanmin(gaps, -1).max() < 1e-5
    np.testing.assert_allclose(
        wrapped(found.q[..., 6] - q[:, None, 6])[found.status == OK], 0, atol=1e-15
    )


@pytest.mark.parametrize("arm", ARMS)
def test_branches_are_what_their_names_say(arm: franka_arm.Parameters) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (500, 7))
    found = franka_arm.ik(drawn(q, arm), q[:, 6], arm)
    straight = np.arctan2(arm.a4, arm.d3) + np.arctan2(arm.a5, arm.d5)
    seen = set()
    for k, name in enumerate(franka_arm.BRANCHES):
        ok = found.status[:, k] == OK
        _, s2, _, _, _, _, _ = np.sin(found.q[ok, k]).T
        bend, side, shoulder = name.split("_")
        q4, q5 = found.q[ok, k, 3], found.q[ok, k, 4]
        assert ((np.sin(q4 + straight) < 0) == (bend == "bent")).all()
        beside = arm.a5 - arm.a4 * np.cos(q4) - arm.d3 * np.sin(q4)
        assert ((np.cos(q5) * beside > 0) == (side == "ahead")).all()
        assert ((s2 > 0) == (shoulder == "front")).all()
        seen |= {name} if ok.any() else set()
    assert seen == set(franka_arm.BRANCHES)


def test_the_determinant_is_that_of_the_other_six_joints() -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (200, 7))
    J = franka_arm.jacobian(q)[:, :, :6]
    np.testing.assert_allclose(franka_arm.determinant(q), np.linalg.det(J), atol=1e-15)
    product = franka_arm.singularities(q).prod(-1)
    np.testing.assert_allclose(np.abs(product), np.abs(np.linalg.det(J)), atol=1e-15)


@pytest.mark.parametrize("near", [0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-5])
def test_a_wrist_at_the_shoulder_is_not_lost(near: float) -> None:
    """Equal links can fold so; squares of the distance lost half of its digits there."""
    arm = franka_arm.Parameters(*[1.0] * 7)
    q = RANDOM.uniform(-np.pi, np.pi, (4000, 7))
    q[:, 3] = np.pi / 2 + near * RANDOM.standard_normal(4000)
    q[::2, 4] = RANDOM.choice([-1, 1], 2000) * np.pi / 2 + near * RANDOM.standard_normal(2000)
    T = drawn(q, arm)
    found = franka_arm.ik(T, q[:, 6], arm)
    assert np.isin(found.status, (OK, SINGULAR)).any(-1).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 7e-12


@pytest.mark.parametrize("near", [0, 1e-15, 1e-12, 1e-9, 1e-6])
@pytest.mark.parametrize("arm", ARMS)
def test_no_posture_is_lost_where_factors_vanish(arm: franka_arm.Parameters, near: float) -> None:
    q = RANDOM.uniform(-np.pi, np.pi, (4000, 7))
    straight = np.arctan2(arm.a4, arm.d3) + np.arctan2(arm.a5, arm.d5)
    corners = {
        1: [0, np.pi, -np.pi], 3: [-straight, np.pi - straight], 4: [np.pi / 2, -np.pi / 2],
    }  # fmt: skip
    for k, at in corners.items():
        value = RANDOM.choice(at, 4000) + near * RANDOM.standard_normal(4000)
        q[:, k] = np.where(RANDOM.random(4000) < 0.6, value, q[:, k])
    T = drawn(q, arm)
    found = franka_arm.ik(T, q[:, 6], arm)
    assert np.isin(found.status, (OK, SINGULAR)).any(-1).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12 * np.abs(arm).sum()


def test_an_elbow_at_the_wrist_is_singular_and_not_lost() -> None:
    """Then the elbow may turn anywhere, but not every turn leaves the wrist within reach."""
    arm = franka_arm.Parameters(d1=0.3, d3=0.4, a4=0.1, a5=0.0, d5=0.0, a7=0.1, d7=0.1)
    q = RANDOM.uniform(-np.pi, np.pi, (2000, 7))
    T = drawn(q, arm)
    found = franka_arm.ik(T, q[:, 6], arm)
    assert (found.status == SINGULAR).all()
    assert np.abs(drawn(found.q, arm) - T[:, None]).max() < 1e-12


@pytest.mark.parametrize("short", [("d3", "a4", "a5"), ("a4", "a5", "d5"), ("a5", "d5")])
def test_links_much_shorter_than_others_miss_nothing(short: tuple[str, ...]) -> None:
    """The tolerance of what the long links reach may be as large as the short ones."""
    scales = 10.0 ** RANDOM.uniform(-4, 0, len(short))
    arm = franka_arm.Parameters(*[1.0] * 7)._replace(**dict(zip(short, 1e-3 * scales, strict=True)))
    q = RANDOM.uniform(-np.pi, np.pi, (4000, 7))
    corners = RANDOM.choice([-np.pi / 2, 0, np.pi / 2, np.pi], q.shape)
    q = np.where(RANDOM.random(q.shape) < 0.5, corners, q)
    T = drawn(q, arm)
    found = franka_arm.ik(T, q[:, 6], arm)
    assert np.isin(found.status, (OK, SINGULAR)).any(-1).all()
    assert max(misses(drawn(found.q, arm), T, found.status)) < 1e-12 * sum(arm)
