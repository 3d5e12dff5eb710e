"""Robots: nearest and track against enumeration, known paths and the forward map."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from closedform.generated.c import puma560 as compiled_puma560

import closedform
from closedform import robots
from closedform.robots import Robot

PI, TURN = math.pi, 2 * math.pi
NAMES = (
    "h6ar",
    "h6ar_loop_closed",
    "hybrid_five_bar",
    "irb260",
    "planar_2r",
    "puma560",
    "rpr_planar",
    "scara",
    "spherical_wrist",
    "stanford_arm",
    "ur_arm",
)
OK, UNREACHABLE, SINGULAR, INVALID = range(4)


def robot(name: str, **options: Any) -> Robot:
    return Robot(getattr(closedform, name), **options)


def postures(arm: Robot, n: int, seed: int = 0) -> np.ndarray:
    q = np.random.default_rng(seed).uniform(-1, 1, (n, len(arm.joints)))
    q[:, ~arm.revolute] = 0.3 + abs(q[:, ~arm.revolute])
    if arm.name.startswith("h6ar"):
        q[:, 3:5] = q[:, 1:3] + 0.1 * q[:, 3:5]
    return q


def targets(arm: Robot, q: np.ndarray) -> np.ndarray:
    found = arm.fk(q)
    return found.p[..., 0, :] if hasattr(found, "p") else found


def gap(arm: Robot, q: np.ndarray, x: np.ndarray) -> float:
    """How far joints are from a target, for mechanisms with and without assembly modes."""
    found = arm.fk(q)
    if hasattr(found, "p"):
        return float(np.nanmin(np.abs(found.p - x[..., None, :]).max(-1), axis=-1).max())
    return float(np.abs(found - x).max())


def by_enumeration(
    arm: Robot, x: np.ndarray, seed: np.ndarray, weights: np.ndarray
) -> tuple[int, float]:
    """The nearest branch and its distance, by trying the turns of every joint one by one."""
    solutions = arm.ik(x)
    best = (-1, math.inf)
    for b, (q, status) in enumerate(zip(solutions.q, solutions.status, strict=True)):
        if status != OK:
            continue
        total = 0.0
        for j, value in enumerate(q):
            turns = range(-3, 4) if arm.revolute[j] else [0]
            lower, upper = arm.limits.lower[j], arm.limits.upper[j]
            tried = [value + k * TURN for k in turns if lower <= value + k * TURN <= upper]
            total += weights[j] * min(((v - seed[j]) ** 2 for v in tried), default=math.inf)
        if math.sqrt(total) < best[1] - 1e-9:
            best = (b, math.sqrt(total))
    return best


@pytest.mark.parametrize("name", NAMES)
def test_nearest_is_the_best_of_all_branches_and_turns(name: str) -> None:
    n = len(getattr(closedform, name).JOINTS)
    arm = robot(name, limits=(np.full(n, -4.0), np.full(n, 4.5)))
    q = postures(arm, 20)
    x = targets(arm, q)
    seeds = np.random.default_rng(1).uniform(-5, 5, q.shape)
    weights = np.linspace(0.5, 2.0, n)
    found = arm.nearest(x, seeds, weights=weights)
    for k in range(len(q)):
        branch, distance = by_enumeration(arm, x[k], seeds[k], weights)
        assert found.branch[k] == branch
        if branch >= 0:
            assert found.distance[k] == pytest.approx(distance, rel=1e-9)
            step = np.sqrt((weights * (found.q[k] - seeds[k]) ** 2).sum())
            assert found.distance[k] == pytest.approx(step)
    solved = found.status == OK
    assert solved.any()
    assert gap(arm, found.q[solved], x[solved]) < 1e-9
    assert (found.q[solved] >= -4).all() and (found.q[solved] <= 4.5).all()
    assert np.isnan(found.q[~solved]).all() and np.isinf(found.distance[~solved]).all()


def test_nearest_tries_all_turns_of_all_joints_together() -> None:
    lower, upper = np.array([-7.0, -2.0]), np.array([2.0, 9.0])
    arm = robot("planar_2r", limits=(lower, upper))
    rng = np.random.default_rng(3)
    for _ in range(20):
        x, seed = targets(arm, rng.uniform(-3, 3, 2)), rng.uniform(-9, 9, 2)
        every = [
            q + TURN * np.array(turns)
            for q in arm.ik(x).q
            for turns in itertools.product(range(-3, 4), repeat=2)
        ]
        inside = [q for q in every if (q >= lower).all() and (q <= upper).all()]
        best = min(inside, key=lambda q: float(np.linalg.norm(q - seed)))
        assert arm.nearest(x, seed).q == pytest.approx(best)


def test_a_batch_is_the_same_as_its_parts() -> None:
    arm = robot("puma560")
    q = postures(arm, 6).reshape(2, 3, 6)
    seeds = postures(arm, 2, seed=5).reshape(2, 1, 6)
    x = arm.fk(q)
    found = arm.nearest(x, seeds)
    assert found.q.shape == (2, 3, 6) and found.outside.shape == (2, 3, 8, 6)
    for i, j in np.ndindex(2, 3):
        one = arm.nearest(x[i, j], seeds[i, 0])
        assert np.array_equal(one.q, found.q[i, j]) and one.branch == found.branch[i, j]
    assert arm.nearest(np.empty((0, 4, 4)), np.zeros(6)).q.shape == (0, 6)
    many = arm.nearest(np.tile(x[0, 0], (2500, 1, 1)), seeds[0, 0])
    assert (many.q == found.q[0, 0]).all()


def test_dimensions_may_differ_among_targets() -> None:
    lengths = np.array([[1.0, 1.0], [2.0, 1.0], [1.0, 1.0]]).T
    arm = robot("planar_2r", parameters=tuple(lengths))
    x = np.array([[0.0, 0.0], [1.2, 0.4], [0.0, 0.0]])
    found = arm.nearest(x, [0.7, 2.9])
    assert found.status.tolist() == [SINGULAR, OK, SINGULAR]
    assert np.abs(arm.fk(found.q) - x).max() < 1e-12
    assert found.q[[0, 2], 0] == pytest.approx([0.7, 0.7])


def test_of_two_turns_at_the_same_distance_the_lower_is_taken() -> None:
    arm = robot("scara")
    q = np.array([0.4, 0.8, 0.1, 0.0])
    weights = [1e6, 1e6, 1, 1]  # on the branch of q
    for seed, expected in ((PI, 0), (3 * PI, TURN), (-PI, -TURN), (PI + 0.01, TURN)):
        found = arm.nearest(arm.fk(q), [0.4, 0.8, 0.1, seed], weights=weights)
        assert found.q[3] == pytest.approx(expected, abs=1e-12)


def test_of_equal_branches_the_first_is_taken() -> None:
    arm = robot("planar_2r")
    for seed in ([0.3, 0.1], [0.3, -0.1], [0.2, 0.0]):
        assert arm.nearest([18.0 * math.cos(0.3), 18.0 * math.sin(0.3)], seed).branch == 0


def test_limits_say_which_branch_violates_which_joint() -> None:
    arm = robot("planar_2r", parameters=(1.0, 1.0), limits=([-0.5, -3.0], [2.0, 3.0]))
    x = arm.fk([0.2, 1.0])  # the other branch has theta1 = 1.2, theta2 = -1
    found = arm.nearest(x, [1.2, -1.0])
    assert found.branch == 1 and not found.outside.any()
    tight = arm.nearest(x, [1.2, -1.0], limits=([-0.5, 0.0], [2.0, 3.0]))
    assert tight.branch == 0 and tight.outside.tolist() == [[False, False], [False, True]]
    none = arm.nearest(x, [1.2, -1.0], limits=([1.0, 0.0], [2.0, 3.0]))
    assert none.branch == -1 and none.status == UNREACHABLE and np.isnan(none.q).all()
    assert none.outside.tolist() == [[True, False], [False, True]]
    assert arm.outside([2.5, 0.0]).tolist() == [True, False]
    # Beyond reach there is nothing that limits could exclude.
    far = arm.nearest([3.0, 0.0], [0.0, 0.0], limits=([1.0, 0.0], [2.0, 3.0]))
    assert far.status == UNREACHABLE and not far.outside.any()


def test_a_joint_at_its_limit_is_within_it() -> None:
    rng = np.random.default_rng(2)
    lower, upper = np.full(6, -0.9), np.full(6, 1.1)
    arm = robot("puma560", limits=(lower, upper))
    q = np.where(rng.random((50, 6)) < 0.5, lower, upper)
    found = arm.nearest(arm.fk(q), q)
    assert (found.branch >= 0).all() and np.abs(found.q - q).max() < 1e-7


def test_statuses_of_what_is_not_a_target() -> None:
    arm = robot("puma560")
    q = postures(arm, 1)[0]
    assert arm.nearest(np.full((4, 4), np.nan), q).status == INVALID
    assert arm.nearest(arm.fk(q), np.full(6, np.nan)).status == INVALID
    far = np.eye(4)
    far[0, 3] = 9.0
    assert arm.nearest(far, q).status == UNREACHABLE


# Free joints


def test_an_aligned_wrist_keeps_theta4() -> None:
    arm = robot("puma560")
    q = postures(arm, 30)
    q[:, 4] = 0.0
    seeds = q + np.random.default_rng(4).normal(0, 0.3, q.shape)
    x = arm.fk(q)
    found = arm.nearest(x, seeds)
    assert (found.status == SINGULAR).all()
    assert np.abs(found.q[:, 3] - seeds[:, 3]).max() == 0
    assert np.abs(found.q[:, 3] + found.q[:, 5] - q[:, 3] - q[:, 5]).max() < 1e-12
    assert gap(arm, found.q, x) < 1e-12


@pytest.mark.parametrize("name", ["puma560", "stanford_arm"])
def test_a_wrist_on_the_base_axis_keeps_theta1(name: str) -> None:
    """The other joints then follow a curve, not a line."""
    if name == "puma560":
        arm = robot(name, parameters={"d3": 0.0})
        low, high = 0.0, 2.0
        for _ in range(80):  # theta2 for which the wrist is on the axis
            middle = (low + high) / 2
            point = arm.fk([0, middle, 0.5, 0, 0, 0])[0, 3]
            low, high = (middle, high) if point > 0 else (low, middle)
        q = np.array([0.7, low, 0.5, 0.3, 0.5, 0.9])
    else:
        arm = robot(name, parameters={"d2": 0.0})
        q = np.array([0.7, 0.0, 0.4, 0.3, 0.5, 0.9])
    x = arm.fk(q)
    x[:2, 3] = 0.0
    assert (arm.ik(x).status == SINGULAR).any()
    for turn in (0.0, 0.4, -1.5):
        seed = q + turn * np.eye(6)[0]
        found = arm.nearest(x, seed)
        assert found.status == SINGULAR and found.q[0] == seed[0]
        assert gap(arm, found.q, x) < 1e-12
        if not turn:
            assert np.abs(found.q - q).max() < 1e-7


def test_a_seed_that_reaches_a_singular_target_is_the_answer() -> None:
    """Of the UR arm with parallel axes 4 and 6, four joints are free together."""
    arm = robot("ur_arm")
    q = np.random.default_rng(0).uniform(-3, 3, (4, 6))  # of two, the curve turns back on the way
    q[:, 4] = 0.0
    x = arm.fk(q)
    assert (arm.ik(x).status == SINGULAR).any(-1).all()
    found = arm.nearest(x, q)
    assert np.abs(found.q - q).max() < 1e-7 and gap(arm, found.q, x) < 1e-12
    near = arm.nearest(x, q + 1e-3)
    assert np.abs(near.q - q).max() < 0.05 and gap(arm, near.q, x) < 1e-12
    # The branch is the one that the posture belongs to.
    right = [arm.ik(arm.fk(p + 1e-3 * np.eye(6)[4])) for p in q]
    gaps = [np.abs(s.q - p).max(-1) for s, p in zip(right, q, strict=True)]
    up = np.array([name.endswith("up") for name in arm.branches])
    expected = [up[np.nanargmin(g)] for g in gaps]
    assert up[found.branch].tolist() == expected


@pytest.mark.parametrize(
    ("name", "parameters", "x", "seed", "kept"),
    [
        ("irb260", None, [0.0, 0.0, 0.9, 0.4], [1.0, 0.6, 2.3, -0.5], 0),
        ("planar_2r", (1.0, 1.0), [0.0, 0.0], [1.3, 3.0], 0),
        ("planar_2r", (1.0, 0.0), [0.6, 0.8], [0.9, 1.7], 1),
        ("scara", (0.3, 0.3, 0.2), [0.0, 0.0, 0.1, 0.3], [1.1, 3.1, 0.0, 0.5], 0),
        ("hybrid_five_bar", None, [0.0, 3.5, 0.0], [0.9, 1.0, 2.0], 0),
    ],
)
def test_a_free_joint_keeps_the_value_of_the_seed(
    name: str, parameters: Any, x: list[float], seed: list[float], kept: int
) -> None:
    arm = robot(name, parameters=parameters)
    statuses = arm.ik(x).status
    assert (statuses == SINGULAR).any(), statuses
    found = arm.nearest(x, seed)
    assert found.status == SINGULAR and found.q[kept] == pytest.approx(seed[kept], abs=1e-12)
    assert gap(arm, found.q, np.array(x)) < 1e-11


def test_a_free_joint_stays_within_its_limits() -> None:
    limits = np.full(6, 2.0)
    arm = robot("puma560", limits=(-limits, limits))
    q = np.array([0.3, -0.5, 0.4, 0.6, 0.0, 0.8])
    found = arm.nearest(arm.fk(q), [0.3, -0.5, 0.4, 2.6, 0.0, -1.2])
    assert found.q[3] == pytest.approx(2.0) and found.q[5] == pytest.approx(-0.6)


# Paths


def line(start: list[float], end: list[float], n: int) -> np.ndarray:
    return np.array(start) + np.linspace(0, 1, n)[:, None] * (np.array(end) - np.array(start))


@pytest.mark.parametrize("module", [closedform.puma560, compiled_puma560])
def test_a_path_is_followed_through_turns_and_a_singularity(module: Any) -> None:
    arm = Robot(module)
    q = line([0.3, -0.5, 0.4, 0.6, -0.8, 0.2], [5.0, -1.2, 0.9, -0.7, 0.8, 9.0], 2001)
    assert abs(q[1000, 4]) < 1e-15  # the aligned wrist, exactly
    path = arm.track(arm.fk(q), q[0])
    kept = np.arange(len(q)) != 1000  # where theta4 keeps its value, for one step
    assert np.abs(path.q - q)[kept].max() < 1e-6 and path.q[1000, 3] == path.q[999, 3]
    assert gap(arm, path.q, arm.fk(q)) < 1e-12
    assert not path.jump.any() and (path.status[[999, 1001]] == OK).all()
    # Beyond the singularity the same motion is on the other branch of the wrist, and it is said.
    assert path.changed.sum() == 1 and path.changed[1000:1002].any()
    assert path.branch[0] != path.branch[-1]


def test_a_path_passes_between_points_from_branch_to_branch() -> None:
    arm = robot("puma560")
    q = line([0.3, -0.5, 0.4, 0.6, -0.8, 0.2], [0.5, -0.6, 0.5, 0.7, 0.8, 0.3], 100)
    path = arm.track(arm.fk(q), q[0])
    assert np.abs(path.q - q).max() < 1e-9 and not path.jump.any() and path.changed.sum() == 1


def test_a_path_along_singular_points_keeps_the_free_joint() -> None:
    arm = robot("puma560")
    q = line([0.3, -0.5, 0.4, 0.6, 0.0, 0.2], [1.0, -1.2, 0.9, 0.6, 0.0, 3.0], 300)
    path = arm.track(arm.fk(q), q[0])
    assert (path.status == SINGULAR).all() and not path.jump.any() and not path.changed.any()
    assert np.abs(path.q - q).max() < 1e-9


@pytest.mark.parametrize("name", ["puma560", "kr6_r700"])
@pytest.mark.parametrize("mounted", [False, True])
def test_rounding_of_a_singular_target_does_not_turn_the_wrist(name: str, mounted: bool) -> None:
    """Near another singularity the inverse of some of these targets is OK, with any theta4."""
    tool = np.array([[0.6, -0.8, 0, 0.1], [0.8, 0.6, 0, 0], [0, 0, 1, 0.2], [0, 0, 0, 1]])
    arm = robots.load(name, tool=tool if mounted else None).replace(limits=None)
    q = np.random.default_rng(11).uniform(-2.5, 2.5, (20000, 6)) * [1, 1, 1, 1, 0, 1]
    others = np.abs(arm.singularities(q)[:, :2]).min(-1)
    q = q[(others > 1e-3) & (others < 0.03)]
    found = arm.nearest(arm.fk(q), q)
    assert set(found.status) == {OK, SINGULAR}
    assert np.abs(found.q - q).max() < 1e-5
    assert gap(arm, found.q, arm.fk(q)) < 1e-12


def test_a_path_along_an_aligned_wrist_does_not_jump_by_rounding() -> None:
    arm = robots.load("puma560", tool=[0, 0.1, 0.2])
    start, end = [0.3, 0.8, 1.61, 0.6, 0, 0.2], [1.0, 1.4, 1.61, 0.6, 0, 1.0]
    q = line(start, end, 3000)  # the arm is nearly stretched
    assert 1e-3 < np.abs(arm.singularities(q)[:, :2]).min() < 1e-2
    path = arm.track(arm.fk(q), q[0], limits=None)
    assert set(path.status) == {OK, SINGULAR}
    assert not path.jump.any() and np.abs(path.q - q).max() < 1e-5


def test_limits_make_a_path_jump_and_say_so() -> None:
    arm = robot("scara", limits=([-3, 0, -1, -4], [3, 3, 1, 4]))
    q = line([0.2, 0.9, 0.1, 3.0], [0.3, 1.0, 0.2, 5.0], 101)
    path = arm.track(arm.fk(q), q[0])
    (at,) = np.flatnonzero(path.jump)
    assert q[at - 1, 3] <= 4 < q[at, 3]
    assert np.abs(path.q[:at] - q[:at]).max() < 1e-12
    assert np.abs(path.q[at:, 3] - q[at:, 3] + TURN).max() < 1e-12
    free = arm.track(arm.fk(q), q[0], limits=None)
    assert not free.jump.any() and np.abs(free.q - q).max() < 1e-12


def test_a_branch_that_leaves_the_limits_is_changed() -> None:
    arm = robot("planar_2r", parameters=(1.0, 1.0))
    q = line([0.0, 1.0], [1.0, 1.0], 51)
    limits = ([-2.0, -2.0], [0.605, 2.0])
    path = arm.track(arm.fk(q), q[0], limits=limits)
    assert (path.branch[:31] == 0).all() and not path.changed[:31].any()
    # theta1 of the other branch is larger: nothing is left.
    assert (path.branch[31:] == -1).all() and (path.status[31:] == UNREACHABLE).all()
    assert path.outside[31:].any(-1).all() and np.isnan(path.q[31:]).all()
    back = arm.track(arm.fk(q[::-1]), q[-1], limits=limits)
    assert (back.branch[:20] == -1).all() and (back.branch[20:] == 0).all()
    wide = arm.track(arm.fk(q), q[0], limits=([-2.0, -2.0], [9.0, 2.0]))
    assert (wide.branch == 0).all()
    low = arm.track(arm.fk(q[::-1]), [2.0, -1.0], limits=([1.355, -2.0], [3.0, 2.0]))
    assert (low.branch[:32] == 1).all() and (low.branch[34:] == -1).all()


def test_points_without_a_solution_do_not_end_a_path() -> None:
    arm = robot("planar_2r", parameters=(1.0, 1.0))
    x = line([1.0, 1.0], [3.0, 0.0], 20)
    x = np.concatenate([x, x[::-1]])
    path = arm.track(x, arm.ik(x[0]).q[1])
    out = (x**2).sum(-1) > 4
    assert out.any() and (path.status[out] == UNREACHABLE).all() and (path.branch[~out] == 1).all()
    assert gap(arm, path.q[~out], x[~out]) < 1e-12


def test_the_number_of_points_does_not_change_a_path() -> None:
    arm = robot("irb260")
    q = line([0.2, 0.3, 0.4, 0.1], [9.0, 0.1, 0.8, -9.0], 3001)
    full = arm.track(arm.fk(q), q[0])
    assert np.abs(full.q - q).max() < 1e-9
    assert arm.track(arm.fk(q[:0]), q[0]).q.shape == (0, 4)
    assert np.abs(arm.track(arm.fk(q[:1]), q[0] + 0.1).q - q[:1]).max() < 1e-9
    with pytest.raises(ValueError, match="along one axis"):
        arm.track(arm.fk(q[0]), q[0])


def test_angles_in_degrees_are_refused() -> None:
    arm = robot("puma560")
    q = np.array([0.0, -90.0, 90.0, 0.0, 45.0, 0.0])
    for call in (arm.fk, arm.jacobian, lambda q: arm.nearest(np.eye(4), q)):
        with pytest.raises(ValueError, match=r"theta2 = 90 is more than 4 turns.*np\.radians"):
            call(q)
    with pytest.raises(ValueError, match="limits: theta1 = 160"):
        robot("puma560", limits=(np.full(6, -160.0), np.full(6, 160.0)))
    assert robot("stanford_arm").fk([0, 0, 900.0, 0, 0, 0]).shape == (4, 4)  # a length, in mm


def test_what_does_not_fit_is_refused() -> None:
    arm = robot("puma560")
    with pytest.raises(ValueError, match=r"q_seed has shape \(5,\), expected \(\.\.\., 6\)"):
        arm.nearest(np.eye(4), np.zeros(5))
    with pytest.raises(ValueError, match="lower limit is larger"):
        robot("puma560", limits=(np.ones(6), np.zeros(6)))
    with pytest.raises(ValueError, match="not negative"):
        arm.nearest(np.eye(4), np.zeros(6), weights=[-1, 1, 1, 1, 1, 1])
    with pytest.raises(TypeError, match="not a generated module"):
        Robot(math)
    with pytest.raises(ValueError, match="h6ar has no function jacobian_space"):
        robot("h6ar").jacobian_space(np.zeros(6))


def test_what_is_found_is_told_on_a_line() -> None:
    arm = robots.Robot(closedform.planar_2r, {"l1": 3, "l2": 1}, limits=[[-1, -1], [1, 1]])
    near = repr(arm.nearest([3.9, 0], [0, 0]))
    assert near.startswith("Nearest([") and " OK, branch 0, distance " in near
    far = repr(arm.nearest([-3.5, 0], [0, 0]))
    assert far == "Nearest([nan, nan] UNREACHABLE, branches outside the limits: 2)"
    assert "array(" in repr(arm.nearest([[3.5, 0]], [0, 0]))


def test_a_dimension_that_is_not_one_is_named() -> None:
    with pytest.raises(TypeError, match="planar_2r has no dimension l9; there are l1, l2"):
        robots.Robot(closedform.planar_2r, {"l9": 1})
