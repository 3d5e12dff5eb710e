"""Chains of subproblems: axes in any direction, seven joints, and fewer than six."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, link, misses
from chains import arm, printed, solved
from sympy import cos, pi, sin

from closedform.check.truth import Solutions
from closedform.lemmas.chain import Chain
from closedform.lemmas.links import turn
from closedform.lemmas.rotate import rotate
from closedform.mechanics.arm import Serial
from closedform.model.derivation import Derivation, Paper
from closedform.proof.prove import prove
from closedform.proof.require import ProofError
from closedform.scaffold.chains.propose import NoChainError, propose
from closedform.scaffold.chains.recognise import recognised

ROOM = sp.Rational(1, 2)
WRIST = [(0, -pi / 2, ROOM), (0, pi / 2, 0), (0, 0, 0)]
"""The last three rows of an arm with a spherical wrist."""


CHAINS = {
    "spherical wrist, axes 1 and 2 meet": (
        [(0, pi / 2, 1), (2, pi / 2, ROOM), (1, pi / 2, 0), *WRIST], 8,
    ),
    "spherical wrist, axes 2 and 3 meet": (
        [(ROOM, pi / 2, 1), (0, pi / 2, 2), (1, pi / 2, 0), *WRIST], 8,
    ),
    "spherical wrist, axes 1 and 2 parallel": (
        [(1, 0, 1), (2, pi / 2, 0), (1, pi / 2, 0), *WRIST], 8,
    ),
    "spherical shoulder, axes 6 and 5 meet, with t7 given": (
        [(0, -pi / 2, 0), (0, pi / 2, 0), (1, pi / 2, 2), (-1, -pi / 2, 0),
         (0, pi / 2, 2), (ROOM, pi / 2, 0), (0, 0, 1)], 8,
    ),
    "axes 1 and 2 meet, and 2 joints that turn the tool": (
        [(0, pi / 2, 1), (ROOM, -pi / 3, ROOM), (ROOM, -pi / 2, 0), (0, -pi / 2, 1), (0, 0, 0)], 4,
    ),
    "axes 2 and 3 parallel, and 2 joints that turn the tool": (
        [(0, pi / 2, 1), (2, 0, 0), (1, 0, 0), (0, pi / 2, 0), (0, 0, ROOM)], 4,
    ),
}  # fmt: skip


@pytest.mark.parametrize("structure", CHAINS)
def test_the_proof_accepts_a_chain_of_subproblems(structure: str) -> None:
    rows, branches = CHAINS[structure]
    d, serial = arm(rows)
    found = propose(serial)
    assert found.structure == structure
    solved(d, serial, found.source)
    (inverse,) = prove(d).inverses
    assert inverse.branches == branches == found.branches


@pytest.fixture(scope="module")
def franka() -> tuple[Derivation, Serial]:
    return arm(CHAINS["spherical shoulder, axes 6 and 5 meet, with t7 given"][0])


def test_a_joint_of_seven_can_be_chosen(franka: tuple[Derivation, Serial]) -> None:
    serial = franka[1]
    assert "t7 given" in propose(serial, "t7").structure
    with pytest.raises(NoChainError, match="t9 cannot be given"):
        propose(serial, "t9")


def test_a_degree_is_named() -> None:
    """Three parallel axes beside two that nearly meet, and no axes that are parallel or meet."""
    short = sp.Rational(1, 10000)
    rows = [(1, 0, 0), (1, 0, 0), (1, pi / 3, 1), (short, pi / 2, 1), (1, pi / 3, 1), (1, 0, 1)]
    with pytest.raises(NoChainError, match="pass each other at a distance that is short") as e:
        propose(arm(rows)[1])
    assert e.value.degree == 4 and "ssik" in e.value.needed
    rows = [(a, pi / 2, 0) for a in (1, 2, 3, 4, 5, 6)]
    with pytest.raises(NoChainError, match="there is no closed form: degree 16") as e:
        propose(arm(rows)[1])
    assert e.value.degree == 16 and "ssik" in e.value.needed


def test_an_arm_with_a_slide_is_told_of_the_axes_that_it_needs() -> None:
    """The first reason was that of a structure it does not have: that two axes are parallel."""
    rows = [
        (0, -pi / 2, None, 0), (ROOM, pi / 2, 1), (2, 0, 0), (1, pi / 2, 0), (0, -pi / 2, ROOM),
        (0, 0, 1),
    ]  # fmt: skip
    with pytest.raises(NoChainError, match="because no three neighbouring axes"):
        propose(arm(rows, "d1 t2 t3 t4 t5 t6")[1])


def test_seven_joints_without_a_chain_have_a_degree_too() -> None:
    """Those of a Baxter: with the joint given that is tried first, and with one that is chosen."""
    rows = [
        (sp.Rational(69, 1000), -pi / 2, 1),
        (0, pi / 2, 0),
        (ROOM, -pi / 2, 2),
        (0, pi / 2, 0),
        (sp.Rational(1, 50), -pi / 2, 2),
        (0, pi / 2, 0),
        (0, 0, 1),
    ]
    serial = arm(rows)[1]
    with pytest.raises(NoChainError, match="none of its seven joints") as e:
        propose(serial)
    assert e.value.degree == 16 and "with t3 given there is no closed form" in e.value.found
    assert "ssik" in e.value.needed and "--given" in e.value.needed
    with pytest.raises(NoChainError, match="with t5 given there is no closed form"):
        propose(serial, "t5")


def test_a_chain_that_nearly_fits_is_named() -> None:
    """A torso turns about the axis of the shoulder, and the elbow comes to this axis.

    The message named no reason, and advised to give joints that cannot be given.
    """
    rows = [
        (0, 0, ROOM), (sp.Rational(1, 5), pi / 2, ROOM), (0, pi / 2, 0), (0, -pi / 2, ROOM),
        (0, pi / 2, 0), (0, -pi / 2, ROOM), (0, pi / 2, 1),
    ]  # fmt: skip
    serial = arm(rows)[1]
    with pytest.raises(NoChainError, match="with t1 given, the point where three axes meet") as e:
        propose(serial)
    assert "Only t1 or t2 can be given" in e.value.needed and e.value.needed.count("ssik") == 1
    q = dict(zip(serial.joints, np.random.default_rng(0).normal(size=7), strict=True))
    twists = np.array(serial.geometric.subs(q).evalf().tolist(), float)
    moving = np.linalg.svd(twists)[2][-1]
    assert np.flatnonzero(np.abs(moving) > 1e-9).tolist() == [0, 1]
    rows[1] = (sp.Rational(4, 5), *rows[1][1:])
    assert propose(arm(rows)[1]).structure.endswith("3 and 2 are skew, with t1 given")


def test_a_joint_is_given_that_leaves_a_regular_arm() -> None:
    """The last four axes meet in a point, so one of them has to be given."""
    rows = [
        (0, -pi / 4, ROOM), (0, -pi / 2, 1), (ROOM, pi / 2, 2), (0, pi / 2, 1),
        (0, pi / 2, 0), (0, pi / 2, 0), (0, 0, 1),
    ]  # fmt: skip
    serial = arm(rows)[1]
    assert propose(serial).structure == "spherical wrist, axes 2 and 3 meet, with t7 given"
    with pytest.raises(NoChainError, match="with t3 given, the other joints do not move the tool"):
        propose(serial, "t3")


def test_eight_joints_are_told_what_to_do() -> None:
    rows = [(1, pi / 2, 1)] * 8
    with pytest.raises(NoChainError, match="it has 8 joints, and a pose determines six") as e:
        propose(arm(rows, "t1 t2 t3 t4 t5 t6 t7 t8")[1])
    assert "Give values to 1 of them, or to 2" in e.value.needed
    assert "'# t1 = 0.1 rad: held'" in e.value.needed


def test_of_eight_joints_a_slide_is_held_in_metres() -> None:
    """A lift under an arm of seven joints, as of a TIAGo or a Fetch."""
    rows = [(0, 0, None, 0), *[(0, pi / 2, 1), (0, -pi / 2, 0)] * 3, (0, 0, 1)]
    with pytest.raises(NoChainError) as e:
        propose(arm(rows, "d1 t1 t2 t3 t4 t5 t6 t7")[1])
    assert "'# d1 = 0.1 m: held'" in e.value.needed


RAILS = {
    "spherical wrist, axes 3 and 4 parallel, with d1 given": [
        (0, -pi / 2, None, 0), (ROOM, -pi / 2, 1), (2, 0, 0), (ROOM, -pi / 2, 0),
        (0, pi / 2, 2), (0, -pi / 2, 0), (0, 0, 1),
    ],
    "axes 3, 4 and 5 parallel, 6 and 7 meet, with d1 given": [
        (0, -pi / 2, None, 0), (0, pi / 2, 1), (-2, 0, 0), (-1, 0, 0), (0, pi / 2, ROOM),
        (0, -pi / 2, ROOM), (0, 0, 1),
    ],
}  # fmt: skip


@pytest.mark.parametrize("structure", RAILS)
def test_an_arm_on_a_rail_takes_the_place_on_it(structure: str, tmp_path: Path) -> None:
    """The rail is an input of the inverse, as far from the origin as it may be."""
    d, serial = arm(RAILS[structure], "d1 t2 t3 t4 t5 t6 t7")
    found = propose(serial)
    assert found.structure == structure
    ik = solved(d, serial, found.source)
    assert prove(d).inverses[0].branches == found.branches == 8
    assert [a.name for a in d["ik"].inputs] == ["T", "d1"] and "d1" not in ik.angles
    serial.export(d)
    robot = printed(d, tmp_path)
    q = np.random.default_rng(5).uniform(-3, 3, (300, 7))
    q[:, 0] *= 3
    T = robot.pose(q)
    answers, status = robot.ik(T, q[:, 0])
    assert (answers[status == OK][:, 0] == np.repeat(q[:, 0], (status == OK).sum(axis=1))).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12 * 10
    off = np.abs(np.exp(1j * (answers - q[:, None])) - 1).max(axis=-1)
    assert (np.nanmin(off, axis=1) < 1e-8).all()
    at_zero, _ = robot.ik(T, 0 * q[:, 0])
    assert np.isnan(at_zero).any() and (at_zero[np.isfinite(at_zero[..., 0])][:, 0] == 0).all()


def test_it_says_what_it_recognised() -> None:
    rows = [(0, pi / 2, 1), (2, 0, 0), (1, 0, 0), (ROOM, pi / 2, 0), (0, pi / 3, 1), (0, 0, 0)]
    assert recognised(arm(rows)[1]) == [
        "axes 1 and 2 meet at a right angle",
        "axes 2 and 3 are parallel",
        "axes 3 and 4 are parallel",
        "axes 4 and 5 are normal to each other, apart",
        "axes 5 and 6 meet at an oblique angle",
        "axes 2, 3 and 4 are parallel",
    ]


def test_three_axes_that_meet_are_recognised() -> None:
    rows = CHAINS["spherical wrist, axes 1 and 2 meet"][0]
    assert recognised(arm(rows)[1])[-1] == "axes 4, 5 and 6 meet in a point"


class Two:
    """Two joints that carry a point: the distance gives the second, a rotation the first."""

    def __init__(self) -> None:
        d = self.d = Derivation(
            "two", "Two", Paper("toy", "Toys", ("A.",)), "Two links.", task=["x", "y"]
        )
        self.t1, self.t2 = t1, t2 = d.joint("t1"), d.joint("t2")
        forward = [3 * cos(t1) + 2 * cos(t1 + t2), 3 * sin(t1) + 2 * sin(t1 + t2)]
        self.ik = Chain(d, forward)
        x, y = self.ik.x
        self.far = self.ik.let("far", (x**2 + y**2 - 13) / 2)

    def solve(self, because: Callable) -> None:
        x, y = self.ik.x
        second = self.ik.solve(turn, self.t2, (0, 6, self.far), {+1: "up", -1: "down"})
        w = (3 + 2 * second.c, 2 * second.s)
        self.ik.solve(rotate, self.t1, w, (x, y), because=because(self))
        self.ik.finish("Both.")

    def prove(self, because: Callable) -> None:
        self.solve(because)
        (inverse,) = prove(self.d).inverses
        assert inverse.branches == 2


def test_a_rotation_needs_vectors_of_equal_length() -> None:
    Two().prove(lambda two: {two.t2: 2})


def test_an_arm_without_factors_is_as_near_to_singular_as_its_rates_are_small() -> None:
    """Where it is stretched, its two solutions meet, but it cannot move without its hand."""
    two = Two()
    two.solve(lambda two: {two.t2: 2})
    solutions = Solutions(two.d, two.d["ik"], two.d.inverses[0])
    stretched, bent = (np.array([0.3, elbow]) for elbow in (1e-12, 1.0))
    assert solutions.condition(stretched, ()) < 1e-10 and solutions.condition(bent, ()) > 0.1
    assert not any(solutions.continues(q, (), 1e-12) for q in (stretched, bent))


@pytest.mark.parametrize(
    ("because", "why"),
    [
        (lambda two: {two.t2: 3}, "does not follow so"),
        (lambda two: {}, "does not follow from earlier equations; say with because="),
        (lambda two: {two.t1: 2}, "no earlier lemma solves for t1"),
    ],
)
def test_that_they_are_must_follow(because: Callable, why: str) -> None:
    with pytest.raises(ProofError, match=f"equally long.*{why}"):
        Two().prove(because)


def test_a_pose_that_is_none_of_the_arms_must_be_compared() -> None:
    """Without the comparison, two coordinates of the target have no equation."""
    rows = CHAINS["axes 2 and 3 parallel, and 2 joints that turn the tool"][0]
    d, serial = arm(rows)
    lines = propose(serial).source.replace("ik.reached()", "")
    solved(d, serial, lines)
    with pytest.raises(ProofError, match="equally long"):
        prove(d)


def test_a_given_joint_is_an_input(franka: tuple[Derivation, Serial]) -> None:
    d, serial = franka
    solved(d, serial, propose(serial).source)
    assert [a.name for a in d["ik"].inputs] == ["T", "t7"]
    assert d.inverses[0].targets[-1].name == "x_t7"


def test_two_axes_beside_three_parallel_ones_may_pass_each_other() -> None:
    """An arm for a drone; if a joint of the three slides, they have to meet."""
    rows = [(2, 0, 0), (1, 0, 0), (0, pi / 2, 0), (1, pi / 2, 1), (0, 0, 1)]
    assert propose(arm(rows)[1]).structure == "axes 1, 2 and 3 parallel, 4 and 5 skew"
    rows[:2] = [(2, pi / 2, 0), (0, -pi / 2, None, 0)]
    with pytest.raises(NoChainError) as e:
        propose(arm(rows, "t1 d2 t3 t4 t5")[1])
    assert "axes 4 and 5 do not meet" in [t.error.found for t in e.value.tried]


ELBOW_BEFORE = [
    (0, -pi / 2, 0), (0, pi / 2, ROOM), (0, -pi / 2, 0), (0, pi / 2, ROOM), (0, -pi / 2, 0),
    (ROOM / 10, pi / 2, 0), (ROOM / 5, 0, 0),
]  # fmt: skip
"""With joint 3 at 0 or at half a turn, joint 2 turns about the centre of the wrist."""


def near_singular_values(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Postures with joint 3 near such a value, and their poses."""
    rng = np.random.default_rng(4)
    q = rng.uniform(-3, 3, (count, 7))
    q[:, 2] = rng.choice((0, np.pi), count) + rng.choice((0, 1e-10, 1e-7, 1e-5), count)
    T = np.eye(4)
    for k, (a, alpha, length) in enumerate(ELBOW_BEFORE):
        T = T @ link(float(a), float(alpha), float(length), q[:, k])
    return q, T


def test_the_joint_that_is_given_leaves_no_singular_arm(tmp_path: Path) -> None:
    """With t3 given, a tenth of the postures were lost near such values of it."""
    d, serial = arm(ELBOW_BEFORE)
    found = propose(serial)
    assert (
        found.structure == "spherical wrist, axes 2 and 3 meet, with t7 given" and not found.doubt
    )
    solved(d, serial, found.source)
    serial.export(d)
    robot, (q, T) = printed(d, tmp_path), near_singular_values(3000)
    answers, status = robot.ik(T, q[:, 6])
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12


def test_where_the_others_are_singular_no_answer_misses_its_target(tmp_path: Path) -> None:
    """Answers that were OK missed by up to 1e-6."""
    d, serial = arm(ELBOW_BEFORE)
    found = propose(serial, "t3")
    assert "At some values of t3 the other joints" in found.doubt
    solved(d, serial, found.source)
    serial.export(d)
    robot, (q, T) = printed(d, tmp_path), near_singular_values(3000)
    answers, status = robot.ik(T, q[:, 2])
    assert (status == OK).any()
    assert max(misses(robot.pose(answers), T, status)) < 2e-12
