"""Robots of seven joints: the arm angle, or a joint, besides the target of the inverse."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from closedform.generated.numpy import srs_arm

from closedform import plot, robots
from closedform.robots import Robot

OK, UNREACHABLE, SINGULAR = 0, 1, 2


@pytest.fixture(scope="module")
def arm() -> Robot:
    return robots.load("iiwa14", base=[0.1, -0.2, 0.7], tool=[0, 0.05, 0.1])


def postures(arm: Robot, n: int) -> np.ndarray:
    return np.random.default_rng(1).uniform(*arm.limits, (n, 7))


def turns(a: Any, b: Any) -> np.ndarray:
    return abs((np.asarray(a) - b + np.pi) % (2 * np.pi) - np.pi)


def test_the_arm_angle_of_the_seed_is_kept(arm: Robot) -> None:
    q = postures(arm, 500)
    moved = arm.fk(q)
    moved[:, :3, 3] += 0.002
    found = arm.nearest(moved, q)
    good = found.status == OK
    assert good.mean() > 0.9 and set(found.status) <= {OK, UNREACHABLE}
    assert abs(arm.fk(found.q[good]) - moved[good]).max() < 1e-12
    assert turns(arm.given_at(found.q[good]), arm.given_at(q[good])).max() < 1e-8
    assert (found.q[good] >= arm.limits.lower).all() and (found.q[good] <= arm.limits.upper).all()
    every = arm.ik(moved[good], arm.given_at(q[good])).q
    own = every[np.arange(len(every)), found.branch[good]]
    assert turns(own, found.q[good]).max() < 1e-12
    assert np.median(abs(found.q[good] - q[good]).max(-1)) < 0.02


def test_other_arm_angles_can_be_given_and_broadcast(arm: Robot) -> None:
    (q,) = postures(arm, 1)
    T, angles = arm.fk(q), np.linspace(-3, 3, 61)
    found = arm.nearest(T, q, given=angles)
    assert found.q.shape == (61, 7) and (found.status == OK).any()
    at = found.q[found.status == OK]
    assert abs(arm.fk(at) - T).max() < 1e-12
    assert turns(arm.given_at(at), angles[found.status == OK]).max() < 1e-8
    assert found.outside[found.status == UNREACHABLE].any(-1).all()


@pytest.mark.parametrize("joint", [1, 5])
def test_a_free_joint_keeps_the_value_of_the_seed_and_the_arm_its_angle(
    arm: Robot, joint: int
) -> None:
    """Where the axes 1 and 3, or 5 and 7, coincide, the self-motion of the elbow is another one."""
    q = postures(arm, 200)
    q[:, joint] = 0
    found = arm.nearest(arm.fk(q), q)
    assert (found.status == SINGULAR).mean() > 0.5 and set(found.status) <= {OK, SINGULAR}
    assert abs(found.q - q).max() < 1e-6  # also where rounding of the target hides that it is so
    shifted = q + np.where(np.arange(7) == joint - 1, 0.1, 0.0)  # another value of the free joint
    free = arm.nearest(arm.fk(q), shifted, given=arm.given_at(q), limits=None)
    assert abs(free.q[:, joint - 1] - shifted[:, joint - 1]).max() < 1e-9
    assert turns(arm.given_at(free.q), arm.given_at(q)).max() < 1e-9
    assert abs(arm.fk(free.q) - arm.fk(q)).max() < 1e-12


def test_a_wrist_above_the_shoulder_has_no_arm_angle_but_a_posture(arm: Robot) -> None:
    q = np.radians([[30, 0, 0, 80, 0, 50, 0]])
    tilt = np.arctan2(0.4 * np.sin(q[0, 3]), 0.42 + 0.4 * np.cos(q[0, 3]))
    q[:, 1] = tilt  # the wrist is above the shoulder
    found = arm.nearest(arm.fk(q), q)
    assert (found.status == SINGULAR).all()
    assert abs(arm.fk(found.q) - arm.fk(q)).max() < 1e-12
    assert abs(found.q - q).max() < 1e-6
    q[:, 0] += 0.1  # the elbow can go round: theta1 is free, whatever angle is given
    for given in (None, 0.0, 0.8):
        turned = arm.nearest(arm.fk(found.q), q, given=given)
        assert (turned.status == SINGULAR).all() and (turned.q[:, 0] == q[:, 0]).all()
        assert abs(arm.fk(turned.q) - arm.fk(found.q)).max() < 1e-12


def test_a_path_keeps_the_arm_angle_or_follows_another(arm: Robot) -> None:
    q = np.radians([20, 40, 10, -80, 0, 50, 0])
    xs = np.repeat(arm.fk(q)[None], 300, axis=0)
    xs[:, 1, 3] += np.linspace(0, 0.2, 300)
    path = arm.track(xs, q)
    assert (path.status == OK).all() and not path.changed.any() and not path.jump.any()
    assert turns(arm.given_at(path.q), arm.given_at(q)).max() < 1e-9
    swing = arm.given_at(q) + np.linspace(0, 0.4, 300)
    swung = arm.track(xs, q, given=swing)
    assert not swung.jump.any()
    assert turns(arm.given_at(swung.q), swing).max() < 1e-9
    assert abs(arm.fk(swung.q) - xs).max() < 1e-12


def test_the_other_functions_of_a_robot(arm: Robot) -> None:
    q = postures(arm, 20)
    frames = arm.frames(q)
    assert frames.shape == (20, 9, 4, 4)
    assert abs(frames[:, -1] - arm.fk(q)).max() < 1e-14
    points = arm.skeleton(q)
    for k, name in enumerate(arm.joints):
        at = srs_arm.SKELETON.points.index(srs_arm.SKELETON.joints[name].points[0])
        assert abs(frames[:, k + 1, :3, 3] - points[:, at]).max() < 1e-14
    rates = arm.joint_rates(q, [0.1, 0, 0, 0, 0.2, 0])
    assert abs(arm.twist(q, rates.qdot) - [0.1, 0, 0, 0, 0.2, 0]).max() < 1e-9
    assert plot.mechanism(srs_arm, q[0]) is not None


def test_what_must_be_given_is_said(arm: Robot) -> None:
    with pytest.raises(ValueError, match="also needs given=arm_angle"):
        arm.ik(np.eye(4))
    for compiled in (False, True):
        six = robots.load("ur5e", compiled=compiled)
        with pytest.raises(ValueError, match="takes the target only"):
            six.ik(np.eye(4), 0.1)
        with pytest.raises(ValueError, match="takes the target only"):
            six.nearest(np.eye(4), [0] * 6, given=0)


def test_a_given_joint_is_that_of_the_maker() -> None:
    """Its inverse takes the joint of the model; the robot that of the maker."""
    taken = []

    def ik(T: Any, theta3: Any, params: Any = None) -> Any:
        taken.append(theta3)
        return srs_arm.ik(T, 0.0)

    names = {name: getattr(srs_arm, name) for name in srs_arm.__all__} | {"ik": ik}
    module: Any = SimpleNamespace(__name__="by.theta3", __all__=list(names), **names)
    signs, offsets = [1, 1, -1, 1, 1, 1, 1], [0, 0, 0.5, 0, 0, 0, 0]
    arm = Robot(module, signs=signs, offsets=offsets)
    assert arm.given == "theta3" and arm.given_at(np.arange(7) / 10) == 0.2
    arm.ik(np.eye(4), 0.2)
    arm.nearest(np.eye(4), np.arange(7) / 10)
    assert np.allclose(taken, 0.3)
    mixed = np.eye(7)
    mixed[2, 1] = -1
    with pytest.raises(ValueError, match="motors are coupled"):
        Robot(module, coupling=mixed).ik(np.eye(4), 0.2)
