"""The skeleton: links keep their length, and the hand is where the forward map says."""

from importlib import import_module
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from libraries import FORWARD

from closedform.mechanics.arm import from_dh
from closedform.mechanics.skeleton import skeleton
from closedform.model.derivation import Derivation, Paper

ROUNDING = 1e-14
SLIDERS = ("orthoglide", "linear_delta")
"""Robots whose sliders stand about as far as their legs are long."""
POSTURES = 300


def postures(robot: Any) -> np.ndarray:
    """Random joints at which the example mechanism can be assembled."""
    rng = np.random.default_rng(3)
    q = rng.uniform(-3.1, 3.1, (POSTURES, len(robot.JOINTS)))
    if robot.__name__.endswith("h6ar") or "h6ar" in robot.__name__:
        q[:, 3:5] = q[:, 1:3] + rng.uniform(-0.05, 0.05, (POSTURES, 2))
    if "rpr" in robot.__name__:
        return np.abs(q) + 1
    if robot.__name__.endswith(SLIDERS):
        return (2 + q / 3.1) / 4 * max(robot.Parameters())
    return q


def size(robot: Any) -> float:
    return float(np.sum(np.abs(robot.Parameters()))) + 5


@pytest.fixture(params=FORWARD)
def robot(request: pytest.FixtureRequest) -> Any:
    return import_module(f"closedform.generated.numpy.{request.param}")


def drawn(robot: Any) -> np.ndarray:
    """The skeletons of the postures that exist, one for each assembly mode."""
    points = robot.skeleton(postures(robot))
    points = points.reshape(-1, len(robot.SKELETON.points), 3)
    kept = points[np.isfinite(points).all((1, 2))]
    assert len(kept) > POSTURES / 10
    return kept


def test_links_keep_their_length(robot: Any) -> None:
    points, names = drawn(robot), robot.SKELETON.points
    for link in robot.SKELETON.links.values():
        for a, b in pairwise(link):
            lengths = np.linalg.norm(points[:, names.index(a)] - points[:, names.index(b)], axis=1)
            assert np.ptp(lengths) <= ROUNDING * size(robot), (a, b)


def test_ground_does_not_move(robot: Any) -> None:
    points, names = drawn(robot), robot.SKELETON.points
    for name in robot.SKELETON.ground:
        assert np.ptp(points[:, names.index(name)], axis=0).max() == 0


def test_joints_move_what_comes_after_them_and_stand_in_their_kind(robot: Any) -> None:
    for name, joint in robot.SKELETON.joints.items():
        assert joint.kind in ("revolute", "prismatic"), name
        assert set(joint.points) <= set(robot.SKELETON.points)
        assert joint.kind == "revolute" or len(joint.points) == 2
    assert set(robot.JOINTS) <= set(robot.SKELETON.joints)


def test_hand_is_where_the_forward_map_says(robot: Any) -> None:
    q = postures(robot)
    hand = robot.skeleton(q)[..., robot.SKELETON.points.index(robot.SKELETON.hand), :]
    if hasattr(robot, "pose"):
        expected = robot.pose(q)[..., :3, 3]
    else:
        found = robot.fk(q)
        expected = found.p if hasattr(found, "p") else found
    if len(robot.TASK) == 9 and expected.ndim == 4:  # of a wrist, the middle of its three axes
        expected = robot.Parameters().r * expected.sum(axis=-1) / 3
    if robot.TASK == ("psi",):  # the angle of a rocker, whose end is the hand
        base = robot.skeleton(q)[..., robot.SKELETON.points.index("A2"), :]
        arm = robot.Parameters().L4 * np.stack([np.cos(expected), np.sin(expected)], -1)[..., 0, :]
        expected = base[..., :2] + arm
    n = min(3, expected.shape[-1])
    gap = np.abs(hand[..., :n] - expected[..., :n])
    assert np.nanmax(gap) <= ROUNDING * size(robot)
    assert (np.isnan(hand[..., :n]) == np.isnan(expected[..., :n])).all()


def test_the_c_module_has_the_same_skeleton(robot: Any) -> None:
    compiled = import_module(robot.__name__.replace("numpy", "c"))
    assert compiled.SKELETON is robot.SKELETON
    q = postures(robot)[:20]
    modes = (len(robot.ASSEMBLY_MODES),) if robot.ASSEMBLY_MODES else ()
    shape = (20, *modes, len(robot.SKELETON.points), 3)
    assert robot.skeleton(q).shape == compiled.skeleton(q).shape == shape
    np.testing.assert_allclose(compiled.skeleton(q), robot.skeleton(q), atol=1e-14 * size(robot))


def test_slides_have_the_length_of_their_joint() -> None:
    from closedform.generated.numpy import rpr_planar, stanford_arm

    for robot, joint in ((rpr_planar, "rho1"), (rpr_planar, "rho2"), (stanford_arm, "d3")):
        q, names = postures(robot), robot.SKELETON.points
        a, b = (names.index(p) for p in robot.SKELETON.joints[joint].points)
        points = robot.skeleton(q)
        length = np.linalg.norm(points[..., a, :] - points[..., b, :], axis=-1)
        expected = np.abs(q[:, robot.JOINTS.index(joint)])
        expected = expected[:, None] if length.ndim == 2 else expected
        gap = np.abs(length - expected)
        assert np.nanmax(gap) <= ROUNDING * size(robot)


def test_closed_loops_meet() -> None:
    """The arms of the H6AR end where the links of its wrist start; the rods stay parallel."""
    from closedform.generated.numpy import h6ar_loop_closed, irb260

    q = postures(h6ar_loop_closed)
    names = h6ar_loop_closed.SKELETON.points
    points, tips = h6ar_loop_closed.skeleton(q), h6ar_loop_closed.arm_tips(q)
    for k, name in enumerate(("tip_right", "tip_left")):
        found = points[:, names.index(name)]
        assert np.nanmax(np.abs(found - tips[:, k])) <= ROUNDING * size(h6ar_loop_closed)
    names, points = irb260.SKELETON.points, irb260.skeleton(postures(irb260))
    for rod, arm in (
        (("lower_rod_turret", "lower_rod_plate"), ("shoulder", "elbow")),
        (("upper_rod_plate", "upper_rod_bracket"), ("elbow", "wrist")),
    ):
        a, b = (points[:, names.index(y)] - points[:, names.index(x)] for x, y in (rod, arm))
        assert np.abs(a - b).max() <= ROUNDING * size(irb260)


def test_a_serial_arm_gets_its_skeleton_from_its_table() -> None:
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "An arm.", task=["x", "y"])
    a, b = (d.parameter(n, value=1, unit="m", meaning="length") for n in "ab")
    q1, q2 = d.joint("q1"), d.joint("q2")
    from_dh(d, [(a, 0, b, q1), (a, 0, 0, q2)]).export(d)
    assert d.skeleton is not None
    assert d.skeleton.points == ("base", "corner1", "joint2", "tool")
    assert d.skeleton.links == {"link1": ("base", "corner1", "joint2"), "link2": ("joint2", "tool")}
    assert d.skeleton.joints == {"q1": ("base",), "q2": ("joint2",)}


@pytest.mark.parametrize(
    ("links", "joint", "message"),
    [
        ({"a": ("base", "hnad")}, "base", "the skeleton has no point hnad"),
        (
            {"a": ("base", "base")},
            "base",
            "no link and no joint of the skeleton has the point hand",
        ),
    ],
)
def test_wrong_names_are_refused(links: dict[str, Any], joint: str, message: str) -> None:
    d = Derivation("arm", "Arm", Paper("p", "P", ("A",)), "An arm.", task=["x"])
    q = d.joint("q")
    points = {"base": (0, 0, 0), "hand": (1, 0, 0)}
    with pytest.raises(ValueError, match=message):
        skeleton(d, points, links=links, joints={q: (joint,)}, hand="hand")


def test_the_points_are_introduced_before_their_table() -> None:
    """A student read "A0 to A1" without having heard of either."""
    d = import_module("closedform.derivations.spherical_five_bar").d
    (step,) = (s for s in d.steps if s.title == "Skeleton")
    assert "The base has the points A0, A1 and A2." in step.reason
    assert "theta1 at A1 and theta2 at A2; the hand is at P" in step.reason
    kinds = {row[1]: row[0] for row in step.rows}
    assert kinds["A1 to B1"] == "crank 1" and kinds["B2 to P"] == "rod 2"


def test_a_slide_has_the_name_of_its_joint() -> None:
    d = import_module("closedform.derivations.orthoglide").d
    (step,) = (s for s in d.steps if s.title == "Skeleton")
    assert "rho1 from A1 to B1" in step.reason
    assert ("rho1", "A1 to B1") in {row[:2] for row in step.rows}
