"""One call of `Robot.nearest` of a compiled module: the answers and the errors of the NumPy one."""

from __future__ import annotations

import numpy as np
import pytest

from closedform import robots
from closedform.robots import Robot

NAMES = robots.names()
TOOL = np.array([[0, 0, 1, 0.1], [0, 1, 0, -0.05], [-1, 0, 0, 0.2], [0, 0, 0, 1.0]])


def pair(name: str, **options: object) -> tuple[Robot, Robot]:
    return robots.load(name, compiled=False, **options), robots.load(name, compiled=True, **options)


def agree(plain: Robot, compiled: Robot, x: np.ndarray, seed: np.ndarray, **options) -> int:
    a, b = plain.nearest(x, seed, **options), compiled.nearest(x, seed, **options)
    assert [np.shape(v) for v in a] == [np.shape(v) for v in b]
    assert [np.asarray(v).dtype for v in a] == [np.asarray(v).dtype for v in b]
    assert a.status == b.status and a.branch == b.branch
    np.testing.assert_allclose(b.q, a.q, atol=1e-9)
    np.testing.assert_allclose(b.distance, a.distance, atol=1e-9)
    np.testing.assert_array_equal(b.outside, a.outside)
    return int(a.status)


@pytest.mark.parametrize("name", NAMES)
def test_answers_are_those_of_numpy(name: str) -> None:
    random = np.random.default_rng(3)
    plain, compiled = pair(name)
    n = len(plain.joints)
    tight = (np.full(n, -1.5), np.full(n, 1.5))
    seen = set()
    for _ in range(60):
        q, seed = random.uniform(-1.5, 1.5, (2, n))
        x = plain.fk(q)
        agree(plain, compiled, x, seed)
        weights = random.uniform(0, 3, n)
        seen.add(agree(plain, compiled, x, seed, limits=tight, weights=weights))
        seen.add(agree(plain, compiled, x, seed, limits=([-0.5] * n, [0.5] * n)))
        agree(plain, compiled, x, seed * np.nan)
    assert {0, 1} <= seen


@pytest.mark.parametrize("options", [{"tool": TOOL}, {"base": TOOL}, {"base": TOOL, "tool": TOOL}])
def test_base_and_tool_are_honoured(options: dict[str, np.ndarray]) -> None:
    plain, compiled = pair("ur5e", **options)
    q = np.array([0.3, -1.2, 1.5, 0.4, -0.7, 2.1])
    agree(plain, compiled, plain.fk(q), q + 0.1)
    assert np.abs(compiled.nearest(plain.fk(q), q + 0.1).q - q).max() < 1e-9


def test_a_free_joint_keeps_its_value() -> None:
    plain, compiled = pair("puma560")
    q = np.array([0.3, -0.5, 0.6, 0.4, 0.0, 2.1])
    assert agree(plain, compiled, plain.fk(q), q + 0.1) == 2


@pytest.mark.parametrize(("name", "joint"), [("iiwa14", 1), ("iiwa14", 5), ("panda", 1)])
def test_an_arm_of_seven_joints_takes_what_is_given(name: str, joint: int) -> None:
    plain, compiled = pair(name, tool=TOOL)
    random = np.random.default_rng(5)
    for q in random.uniform(-1, 1, (20, 7)) * plain.limits.upper + np.mean(plain.limits, axis=0):
        given = plain.given_at(q)
        agree(plain, compiled, plain.fk(q), q + 0.1, given=given)
        agree(plain, compiled, plain.fk(q), q, given=given + np.pi / 3)
        q[joint] = 0.0  # two branches meet, and rounding tells which of them is nearer
        for arm in (plain, compiled):
            found = arm.nearest(plain.fk(q), q, limits=None)
            assert found.status in (0, 2) and np.abs(found.q - q).max() < 1e-6
    several = compiled.nearest(plain.fk(q), q, given=given + np.array([0, 0.1]))
    assert several.q.shape == (2, 7)


@pytest.mark.parametrize("name", ["ur5e", "puma560", "kr6_r700", "stanford_arm", "iiwa14", "panda"])
def test_a_batch_gives_the_answers_of_its_postures(name: str) -> None:
    """Also where a joint is free or nothing is found, which Python decides."""
    plain, compiled = pair(name)
    q = np.random.default_rng(2).uniform(-1.2, 1.2, (3, 40, len(plain.joints)))
    q[0, :5, -2] = 0  # the wrists that have one are aligned
    x, seeds = plain.fk(q), q[1] + 0.1
    x[1, 3] = np.nan
    x[2, 4, :3, 3] = 99.0
    for options in ({}, {"limits": [[-1] * q.shape[-1], [1] * q.shape[-1]]}):
        found = compiled.nearest(x, seeds, **options)
        assert {0, 1, 3} <= set(found.status.ravel().tolist())
        for wanted, values in zip(plain.nearest(x, seeds, **options), found, strict=True):
            np.testing.assert_allclose(values, wanted, atol=1e-7, strict=True)


def test_many_dimensions_are_taken() -> None:
    plain, compiled = pair("ur5e")
    q = np.random.default_rng(2).uniform(-1.5, 1.5, (7, 6))
    d1 = np.array([0.1, 0.2])
    wide = compiled.replace(parameters=compiled.parameters._replace(d1=d1))
    assert wide.nearest(plain.fk(q[0]), q[0]).q.shape == (2, 6)


@pytest.mark.parametrize(
    ("x", "seed", "options", "error"),
    [
        (np.eye(3), np.zeros(6), {}, ValueError),
        ("far", np.zeros(6), {}, TypeError),
        (np.eye(4), np.zeros(5), {}, ValueError),
        (np.eye(4), np.full(6, 90.0), {}, ValueError),
        (np.eye(4), np.zeros(6), {"weights": [-1.0] * 6}, ValueError),
    ],
)
def test_errors_are_those_of_numpy(x, seed, options, error) -> None:
    messages = []
    for arm in pair("ur5e"):
        with pytest.raises(error) as caught:
            arm.nearest(x, seed, **options)
        messages.append(str(caught.value))
    assert messages[0] == messages[1]
    bad = np.eye(4)
    bad[0, 0] = -1
    assert {arm.nearest(bad, np.zeros(6)).status for arm in pair("ur5e")} == {3}


@pytest.mark.parametrize("name", ["ur5e", "kr6_r700", "irb120", "iiwa7", "panda", "lwr4"])
def test_one_call_takes_the_compiled_function(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the maker counts the joints from other zeros and in other directions."""
    compiled = robots.load(name, compiled=True)
    q = np.array([0.3, -1.2, 1.5, 0.4, -0.7, 2.1, 0.6])[: len(compiled.joints)]
    x = compiled.fk(q)
    monkeypatch.setattr(compiled.module, "ik", None)
    assert np.abs(compiled.nearest(x, q, limits=None).q - q).max() < 1e-9


def test_of_two_turns_the_lower_is_taken_in_joints_of_the_maker() -> None:
    plain, compiled = pair("kr6_r700")
    q = np.array([0.3, -1.2, 1.5, 0.4, -0.7, 2.1])
    x = plain.fk(q)
    branch = plain.nearest(x, q, limits=None).q
    for k in range(6):
        for half in (-np.pi, np.pi):
            seed = branch + half * (np.arange(6) == k)
            agree(plain, compiled, x, seed, limits=None, weights=1.0 - (np.arange(6) == k))


def test_rounding_of_a_singular_target_does_not_turn_the_wrist() -> None:
    """Near another singularity the inverse of some of these targets is OK, with any theta4."""
    rng = np.random.default_rng(12)
    arm = robots.load("puma560", compiled=True, tool=[0, 0.1, 0.2])
    q = rng.uniform(-2.5, 2.5, (20000, 6)) * [1, 1, 1, 1, 0, 1]
    others = np.abs(arm.singularities(q)[:, :2]).min(-1)
    q = q[(others > 1e-3) & (others < 0.03)]
    q = q[((q >= arm.limits.lower) & (q <= arm.limits.upper)).all(-1)]
    found = [arm.nearest(arm.fk(posture), posture) for posture in q]
    assert {int(one.status) for one in found} == {0, 2}
    close = 1e-2  # an answer so near to the seed is kept as it is
    assert np.abs(np.array([one.q for one in found]) - q).max() < close
