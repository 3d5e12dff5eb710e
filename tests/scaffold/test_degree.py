"""The number of solutions for a pose, and the degrees of the equations that give them."""

import numpy as np
import pytest
import sympy as sp
from chains import arm
from sympy import pi
from sympy.combinatorics import Permutation, PermutationGroup

from closedform.scaffold.chains import degree
from closedform.scaffold.chains import propose as proposals
from closedform.scaffold.chains.chainlinks import singles
from closedform.scaffold.chains.degree import (
    Numeric,
    Solutions,
    free_joints,
    solutions,
    solutions_of_few,
    stays_regular,
    steps,
)
from closedform.scaffold.chains.propose import NoChainError, propose

H = sp.Rational(1, 2)
COUNTED = {
    "spherical wrist": (
        [(0, pi / 2, 1), (2, 0, 0), (H, pi / 2, 0), (0, -pi / 2, 2), (0, pi / 2, 0), (0, 0, 1)],
        8, (2, 2, 2), True,
    ),
    "spherical wrist after three joints at random": (
        [(1, pi / 3, 1), (2, pi / 4, H), (H, pi / 5, 0), (0, pi / 2, 2), (0, pi / 2, 0), (0, 0, 1)],
        8, (2, 4), True,
    ),
    "six joints at random": (
        [(1, pi / 2, 0), (2, pi / 3, 1), (1, pi / 4, 2), (3, pi / 2, 1), (1, pi / 3, 0),
         (2, pi / 5, 1)],
        16, (16,), False,
    ),
    "a hollow wrist": (
        [(3, -pi / 2, 6), (10, 0, 0), (1, -pi / 2, 0), (0, 2 * pi / 5, 12), (0, -2 * pi / 5, 1),
         (0, 0, 2)],
        16, (16,), False,
    ),
    "a slide": (
        [(0, pi / 2, 1), (0, pi / 2, H), (0, 0, None, 0), (0, -pi / 2, 0), (0, pi / 2, 0),
         (0, 0, 1)],
        8, (2, 2, 2), True,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", COUNTED)
def test_the_solutions_of_a_pose_are_counted(name: str) -> None:
    """Those of a spherical wrist are twice those of the joints before; Raghavan and Roth: 16."""
    rows, number, degrees, solvable = COUNTED[name]
    found = solutions(singles(arm(rows)[1]))
    assert found is not None
    assert (found.number, sorted(found.steps), found.solvable) == (number, [*degrees], solvable)


FEW = {
    "an elbow and a roll": ([(0, pi / 2, 1), (2, 0, 0), (1, 0, 0), (0, pi / 2, 0), (0, 0, 1)], 4),
    "five joints at random": (
        [(1, pi / 2, 2), (3, pi / 3, 1), (4, pi / 4, 0), (3, pi / 3, 1), (0, 0, 1)], 1,
    ),
    "a wrist after a slide": (
        [(0, pi / 3, None, 0), (1, pi / 2, 0), (0, -pi / 2, 2), (0, pi / 2, 0), (0, 0, H)], 2,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FEW)
def test_the_solutions_of_a_pose_that_few_joints_reach_are_counted(name: str) -> None:
    """A turret in front or behind, with both elbows: 4.  A wrist that flips: 2."""
    rows, number = FEW[name]
    assert solutions_of_few(singles(arm(rows)[1])) == number


@pytest.mark.parametrize(("number", "why"), [(1, "degree 1 give it"), (4, "4 or less give them")])
def test_an_arm_of_five_joints_without_a_chain_names_the_degree(
    number: int, why: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(proposals, "solutions_of_few", lambda _: number)
    with pytest.raises(NoChainError, match="do not meet in a point") as caught:
        propose(arm(FEW["five joints at random"][0])[1])
    assert caught.value.degree == number
    assert why in caught.value.needed and "Pinocchio" in caught.value.needed


def test_one_count_may_miss_solutions_but_two_must_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    """The first count of these is a lower bound; the others outvote it."""
    rows, number, *_ = COUNTED["six joints at random"]
    whole = singles(arm(rows)[1])
    counts = iter([8, number, 12, number])

    def once(*_: object) -> Solutions:
        n = next(counts)
        return Solutions(n, (n,), False)

    monkeypatch.setattr(degree, "counted_once", once)
    assert solutions(whole) is None
    counts = iter([8, number, number])
    found = solutions(whole)
    assert found is not None and found.number == number


def test_an_arm_that_cannot_move_its_tool_in_six_ways_is_not_counted() -> None:
    assert solutions(singles(arm([(1, 0, 0)] * 6)[1])) is None


def test_the_steps_of_a_group_are_those_of_its_blocks() -> None:
    assert steps(PermutationGroup([Permutation([1, 2, 3, 4, 5, 0])])) in ((2, 3), (3, 2))
    assert steps(
        PermutationGroup([Permutation([1, 2, 3, 4, 0]), Permutation([1, 0, 2, 3, 4])])
    ) == (5,)


def test_a_point_that_a_given_joint_moves_far_away_is_not_one_where_axes_meet(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Joint 6 can make axes 5 and 7 parallel; the chain divided by the sine of its angle."""
    monkeypatch.setattr(proposals, "solutions", lambda _: None)
    a, b = sp.Rational(1, 10), sp.Rational(1, 2)
    rows = [
        (0, pi / 2, b), (0, -pi / 2, 0), (a, pi / 2, b), (a, -pi / 2, 0), (0, pi / 2, b),
        (a, -pi / 2, 0), (0, 0, a),
    ]  # fmt: skip
    with pytest.raises(NoChainError) as caught:
        propose(arm(rows)[1], "t6")
    reasons = [tried.error.found for tried in caught.value.tried]
    assert any("can make axes 7 and 5 parallel" in found for found in reasons)


def test_solutions_are_followed_in_few_corrections() -> None:
    """With a straight line from each solution to the next, and steps that grew until they failed,
    this took 47,000, and an arm of seven joints was refused after up to 20 s."""
    fibre = degree._explored(singles(arm(COUNTED["six joints at random"][0])[1]), degree.SEEDS[0])
    assert fibre is not None and degree.WORK - fibre.work < 40_000


GIVEN = {
    "joint 2 turns about the wrist": (
        [(0, -pi / 2, 0), (0, pi / 2, H), (0, -pi / 2, 0), (0, pi / 2, H), (0, -pi / 2, 0),
         (H / 10, pi / 2, 0), (H / 5, 0, 0)],
        "1 2 4 6 7",
    ),
    "axes 1 and 2 are parallel": (
        [(0, 0, H), (H, pi / 2, H), (0, pi / 2, 0), (0, -pi / 2, H), (0, pi / 2, 0),
         (0, -pi / 2, H), (0, pi / 2, H / 5)],
        "1 2",
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", GIVEN)
@pytest.mark.filterwarnings("error")
def test_some_joints_leave_a_singular_arm_at_some_values(name: str) -> None:
    rows, numbers = GIVEN[name]
    whole = singles(arm(rows)[1])
    assert [j.number for j in whole.joints if stays_regular(whole, j)] == [
        *map(int, numbers.split())
    ]


def test_a_slide_that_is_turned_moves_the_tool_as_its_table_says() -> None:
    """The constant turn of a slide was left out: its joints were said to move each other's tool."""
    rows = [(0, -pi / 2, None, 0), (0, -pi / 2, H), (H, pi / 2, None, pi / 2), (0, pi / 2, H),
            (0, 0, 1)]  # fmt: skip
    _, serial = arm(rows, "d1 t2 d3 t4 t5")
    assert free_joints(singles(serial)) == []
    at = dict(zip(serial.joints, (0.3, 0.7, -0.4, 1.1, 0.2), strict=True))
    numeric = Numeric.of(singles(serial), np.random.default_rng(1))
    T, _ = numeric.pose(np.array([list(at.values())], complex))
    expected = np.array(serial.pose.subs(at).evalf().tolist(), float)
    np.testing.assert_allclose(T[0], expected[:3], atol=1e-12)
