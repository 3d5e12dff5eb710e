"""Robots: base, tool and joint zero, frames of the links, velocities and forces."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import closedform
from closedform.robots import Robot

STEP = 1e-6
SERIAL = ("puma560", "ur_arm", "stanford_arm", "scara", "spherical_wrist")


def transform(axis: str, angle: float, position: list[float]) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    T = np.eye(4)
    T[:3, :3] = {
        "x": [[1, 0, 0], [0, c, -s], [0, s, c]],
        "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]],
        "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]],
    }[axis]
    T[:3, 3] = position
    return T


BASE = transform("x", 0.4, [0.1, -0.2, 0.3]) @ transform("z", 1.1, [0, 0, 0])
TOOL = transform("y", -0.7, [0.02, 0.03, 0.15]) @ transform("z", 0.3, [0, 0, 0])
UPRIGHT = (transform("z", 0.6, [0.1, 0.2, -0.3]), transform("z", -0.9, [0.05, 0.02, 0.1]))


def postures(arm: Robot, n: int) -> np.ndarray:
    q = np.random.default_rng(7).uniform(-1, 1, (n, len(arm.joints)))
    q[:, ~arm.revolute] = 0.3 + abs(q[:, ~arm.revolute])
    return q


def numeric_twists(arm: Robot, q: np.ndarray, frame: str) -> np.ndarray:
    """The Jacobian of the pose by differences, as the definitions of the frames say."""
    T = arm.pose(q)
    columns = []
    for k in range(len(q)):
        nudge = STEP * np.eye(len(q))[k]
        rate = (arm.pose(q + nudge) - arm.pose(q - nudge)) / (2 * STEP)
        W = rate[:3, :3] @ T[:3, :3].T
        omega = np.array([W[2, 1], W[0, 2], W[1, 0]])
        v = rate[:3, 3]
        if frame == "space":
            v = v - np.cross(omega, T[:3, 3])
        if frame == "body":
            v, omega = T[:3, :3].T @ v, T[:3, :3].T @ omega
        columns.append([*v, *omega])
    return np.array(columns).T


@pytest.mark.parametrize("name", ["puma560", "ur_arm", "stanford_arm"])
def test_base_tool_and_joint_zero_are_products_and_sums(name: str) -> None:
    module = getattr(closedform, name)
    n = len(module.JOINTS)
    signs, offsets = np.array([1, -1, 1, -1, 1, 1]), np.linspace(-0.4, 0.6, n)
    arm = Robot(module, base=BASE, tool=TOOL, signs=signs, offsets=offsets)
    q = postures(arm, 5)
    x = BASE @ module.fk(signs * q + offsets) @ TOOL
    assert np.abs(arm.fk(q) - x).max() < 1e-12 and np.abs(arm.pose(q) - x).max() < 1e-12
    found = arm.nearest(x, q)
    assert np.abs(found.q - q).max() < 1e-9
    solutions = arm.ik(x)
    assert np.nanmin(np.abs(solutions.q - q[:, None]).max(-1), axis=-1).max() < 1e-9
    good = solutions.status == 0
    again = arm.fk(solutions.q)
    assert np.abs(again - x[:, None])[good].max() < 1e-12
    for k in range(3):
        for frame in ("tip", "space", "body"):
            J = np.stack([arm.twist(q[k], e, frame) for e in np.eye(n)], axis=-1)
            assert np.abs(J - numeric_twists(arm, q[k], frame)).max() < 1e-8
        assert np.abs(arm.jacobian(q[k]) - numeric_twists(arm, q[k], "tip")).max() < 1e-8
        assert np.abs(arm.jacobian_space(q[k]) - numeric_twists(arm, q[k], "space")).max() < 1e-8
        assert np.abs(arm.jacobian_body(q[k]) - numeric_twists(arm, q[k], "body")).max() < 1e-8
        assert arm.determinant(q[k]) == pytest.approx(np.linalg.det(arm.jacobian(q[k])), abs=1e-12)
    points = arm.skeleton(q)
    assert np.abs(points[..., 0, :] - BASE[:3, 3]).max() < 1e-12


@pytest.mark.parametrize("name", ["scara", "irb260"])
def test_a_palletiser_takes_an_upright_base_and_tool(name: str) -> None:
    module = getattr(closedform, name)
    base, tool = UPRIGHT
    arm = Robot(module, base=base, tool=tool)
    q = postures(arm, 6)
    T = base @ module.pose(q) @ tool
    x = arm.fk(q)
    assert np.abs(arm.pose(q) - T).max() < 1e-12 and np.abs(x[:, :3] - T[:, :3, 3]).max() < 1e-12
    assert np.abs(arm.nearest(x, q).q - q).max() < 1e-9
    nudges = STEP * np.eye(4)
    J = (arm.fk(q[0] + nudges) - arm.fk(q[0] - nudges)).T / (2 * STEP)
    assert np.abs(arm.jacobian(q[0]) - J).max() < 1e-8
    for wrong in ({"base": BASE}, {"tool": TOOL}):
        with pytest.raises(ValueError, match="must not tilt"):
            Robot(module, **wrong)


def test_targets_that_are_not_poses_take_what_they_can() -> None:
    wrist = Robot(closedform.spherical_wrist, base=BASE, tool=TOOL)
    q = postures(wrist, 4)
    expected = BASE[:3, :3] @ closedform.spherical_wrist.fk(q) @ TOOL[:3, :3]
    assert np.abs(wrist.fk(q) - expected).max() < 1e-12
    assert np.abs(wrist.nearest(expected, q).q - q).max() < 1e-9
    flat = Robot(closedform.planar_2r, base=transform("z", 0.5, [1, 2, 0]))
    q = postures(flat, 4)
    assert np.abs(flat.nearest(flat.fk(q), q).q - q).max() < 1e-9
    nudges = STEP * np.eye(2)
    J = (flat.fk(q[0] + nudges) - flat.fk(q[0] - nudges)).T / (2 * STEP)
    assert np.abs(flat.jacobian(q[0])[:2] - J).max() < 1e-7
    five = Robot(closedform.hybrid_five_bar, base=BASE)
    q = np.array([0.3, 1.0, 2.0])
    p = five.fk(q).p[0]
    assert (
        np.abs(p - BASE[:3, :3] @ closedform.hybrid_five_bar.fk(q).p[0] - BASE[:3, 3]).max() < 1e-12
    )
    assert np.abs(five.nearest(p, q).q - q).max() < 1e-9
    with pytest.raises(ValueError, match="to which no tool can be added"):
        Robot(closedform.planar_2r, tool=[0, 0, 1])
    with pytest.raises(ValueError, match="has neither base nor tool"):
        Robot(closedform.h6ar, base=BASE)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"base": np.diag([1, 1, -1, 1])}, "base is not a homogeneous transform"),
        ({"tool": np.eye(2)}, r"tool has shape \(2, 2\)"),
        ({"signs": [1, 1, 2, 1, 1, 1]}, "each 1 or -1"),
        ({"offsets": [1, 2]}, r"offsets has shape \(2,\)"),
        ({"coupling": 2 * np.eye(6)}, "determinant 1 or -1"),
    ],
)
def test_what_is_not_a_mounting_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Robot(closedform.puma560, **options)


@pytest.mark.parametrize("name", SERIAL)
def test_frames_are_at_the_joints_and_move_with_the_links(name: str) -> None:
    base, tool = UPRIGHT
    arm = Robot(getattr(closedform, name), base=base, tool=tool)
    q = postures(arm, 3)
    frames = arm.frames(q)
    n = len(arm.joints)
    assert frames.shape == (3, n + 2, 4, 4)
    assert np.abs(frames[:, 0] - base).max() == 0
    assert np.abs(frames[:, -1] - arm.pose(q)).max() < 1e-12
    points, names = arm.skeleton(q), arm.module.SKELETON.points
    for k, joint in enumerate(arm.joints):
        shown = arm.module.SKELETON.joints[joint]
        at = points[:, names.index(shown.points[0])]
        # A point of a skeleton may stand elsewhere on the axis of its joint.
        apart = at - frames[:, k + 1, :3, 3]
        z = frames[:, k + 1, :3, 2]
        if arm.revolute[k]:
            assert np.abs(np.cross(apart, z)).max() < 1e-12
        moved = arm.frames(q + 0.3 * np.eye(n)[k])
        assert np.abs(moved[:, : k + 1] - frames[:, : k + 1]).max() < 1e-12
        between = np.linalg.inv(frames[:, k + 1]) @ moved[:, k + 1]
        turn = transform("z", 0.3, [0, 0, 0]) if arm.revolute[k] else np.eye(4)
        if not arm.revolute[k]:
            turn[2, 3] = 0.3
        assert np.abs(between - turn).max() < 1e-12


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("name", ["irb260", "hybrid_five_bar", "h6ar"])
def test_a_mechanism_with_loops_has_no_frames_of_links(name: str) -> None:
    with pytest.raises(ValueError, match=r"not a serial chain|no function"):
        Robot(getattr(closedform, name)).frames(np.zeros(len(getattr(closedform, name).JOINTS)))


def test_torques_do_the_work_of_the_wrench() -> None:
    arm = Robot(closedform.puma560, base=BASE, tool=TOOL)
    rng = np.random.default_rng(1)
    q, qdot, wrench = rng.normal(size=(4, 6)), rng.normal(size=(4, 6)), rng.normal(size=(4, 6))
    for frame in ("tip", "space", "body"):
        power = (wrench * arm.twist(q, qdot, frame)).sum(-1)
        assert (arm.joint_torques(q, wrench, frame) * qdot).sum(-1) == pytest.approx(power)
    # A weight at the tool takes the torque that lifts it.
    weight = np.array([0, 0, 1.0, 0, 0, 0])
    height = [(arm.pose(q[0] + e)[2, 3] - arm.pose(q[0] - e)[2, 3]) / (2 * STEP)
              for e in STEP * np.eye(6)]  # fmt: skip
    assert arm.joint_torques(q[0], weight) == pytest.approx(height, abs=1e-8)
    with pytest.raises(ValueError, match="frame must be one of tip, space, body"):
        arm.twist(q, qdot, "world")


def test_a_planar_arm_has_frames_of_its_links() -> None:
    arm = Robot(closedform.planar_2r)
    q = np.random.default_rng(5).uniform(-3, 3, (10, 2))
    frames, points = arm.frames(q), arm.skeleton(q)
    assert np.abs(frames[:, -1] - arm.pose(q)).max() < 1e-13
    elbow = closedform.planar_2r.SKELETON.joints["theta2"].points[0]
    at = points[:, closedform.planar_2r.SKELETON.points.index(elbow)]
    assert np.abs(frames[:, 2, :3, 3] - at).max() < 1e-13
    assert np.abs(frames[:, 1:3, 2, 2] - 1).max() == 0


@pytest.mark.parametrize("name", ["delta", "hybrid_five_bar", "orthoglide", "planar_2r", "h6ar"])
def test_torques_of_a_mechanism_without_a_twist(name: str) -> None:
    """By virtual work: the force along the task coordinates times their change."""
    arm = Robot(getattr(closedform, name))
    rng = np.random.default_rng(4)
    q = 0.3 + 0.1 * rng.random(len(arm.joints))
    at, force = arm.fk(q), rng.normal(size=len(arm.module.TASK))

    def place(q: np.ndarray) -> np.ndarray:
        found = arm.fk(q)
        return found.p if hasattr(found, "p") else found

    work = [(place(q + e) - place(q - e)) @ force / (2 * STEP) for e in STEP * np.eye(len(q))]
    assert arm.joint_torques(q, force) == pytest.approx(np.array(work).T, abs=1e-7)
    assert not hasattr(at, "p") or len(arm.joint_torques(q, force)) == len(
        arm.module.ASSEMBLY_MODES
    )
    with pytest.raises(ValueError, match="wrench has shape"):
        arm.joint_torques(q, np.ones(len(force) + 1))


def test_what_a_mechanism_does_not_have_is_said_plainly() -> None:
    hand = Robot(closedform.agile_wrist)
    with pytest.raises(ValueError, match="not a serial chain"):
        hand.frames(np.zeros(3))
    with pytest.raises(ValueError, match="agile_wrist has no twist"):
        hand.twist(np.zeros(3), np.ones(3))
    assert np.isfinite(hand.joint_torques([0.1, 0.2, 0.3], [1.0, 0, 0])).any()


def test_measures_of_dexterity() -> None:
    arm = Robot(closedform.puma560)
    q = postures(arm, 5)
    assert arm.manipulability(q) == pytest.approx(np.abs(arm.determinant(q)))
    J = arm.jacobian(q)[:, :3]
    assert arm.manipulability(q, "trans") == pytest.approx(
        np.sqrt(np.linalg.det(J @ np.swapaxes(J, -1, -2)))
    )
    assert arm.condition(q) == pytest.approx(np.linalg.cond(arm.jacobian(q)))
    q[0, 4] = 0.0
    assert np.isinf(arm.condition(q)[0]) and np.isfinite(arm.condition(q)[1:]).all()
    assert np.isfinite(arm.condition(q, "trans")).all()
    flat = Robot(closedform.planar_2r)
    assert flat.manipulability([0.3, 0.5]) == pytest.approx(
        abs(closedform.planar_2r.determinant([0.3, 0.5]))
    )


def test_joint_rates_give_the_velocity_that_is_asked_for() -> None:
    arm = Robot(closedform.ur_arm, tool=TOOL)
    q = postures(arm, 8)
    twist = np.random.default_rng(2).normal(size=(8, 6))
    found = arm.joint_rates(q, twist)
    assert np.abs(arm.twist(q, found.qdot) - twist).max() < 1e-9
    assert (found.status == 0).all() and np.abs(found.error).max() < 1e-9
    scara = Robot(closedform.scara)
    q = postures(scara, 1)[0]
    rates = scara.joint_rates(q, [0.1, 0.2, -0.1, 0.5]).qdot
    assert scara.fk(q + STEP * rates) - scara.fk(q) == pytest.approx(
        STEP * np.array([0.1, 0.2, -0.1, 0.5]), abs=1e-10
    )


def test_joint_rates_behave_at_a_singularity() -> None:
    arm = Robot(closedform.puma560)
    q = postures(arm, 1)[0]
    q[4] = 0.0
    J = arm.jacobian(q)
    twist = np.random.default_rng(3).normal(size=6)
    exact = arm.joint_rates(q, twist)
    assert exact.status == closedform.puma560.Status.SINGULAR
    assert np.abs(J.T @ exact.error).max() < 1e-9  # the least error
    null = np.array([0, 0, 0, 1, 0, -1.0])
    assert abs(exact.qdot @ null) < 1e-9  # the shortest rates
    for damping in (0.01, 0.2):
        damped = arm.joint_rates(q, twist, damping=damping).qdot

        def cost(rates: np.ndarray, damping: float = damping) -> float:
            return float(((J @ rates - twist) ** 2).sum() + damping**2 * (rates**2).sum())

        for nudge in 1e-3 * np.random.default_rng(4).normal(size=(20, 6)):
            assert cost(damped) < cost(damped + nudge)
        assert np.linalg.norm(damped) <= np.linalg.norm(twist) / (2 * damping)
    near = q + 1e-7 * np.eye(6)[4]
    assert np.abs(arm.joint_rates(near, twist, damping=0.05).qdot).max() < 40
    bad = arm.joint_rates(np.full(6, np.nan), twist)
    assert bad.status == 3 and np.isnan(bad.qdot).all()
