"""Arms from tables where two or three things that make a posture singular happen at once.

There a rounding turns the first joint by a multiple of it, and the next ones, which are at the end
of their range too, would seem to be out of reach.
"""

import itertools
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from chains import arm, printed, solved
from loop_files import newton
from sympy import pi
from test_six import CHAINS as SIX
from test_six import H
from test_subproblems import CHAINS as SUBPROBLEMS

from closedform.scaffold.chains.propose import propose

OBLIQUE = {
    "three parallel axes, oblique wrist whose outer axes can be aligned": [
        (H, pi / 2, 1), (2, 0, 0), (1, 0, 0), (H, pi / 3, H), (0, pi / 3, 1), (0, 0, H),
    ],
    "three parallel axes, oblique wrist whose outer axes can be opposite": [
        (H, pi / 2, 1), (2, 0, 0), (1, 0, 0), (H, 2 * pi / 3, 1), (0, pi / 3, H), (0, 0, H),
    ],
    "oblique wrist, three parallel axes": [
        (0, -pi / 3, 1), (1, pi / 2, 0), (2, 0, 0), (1, 0, H), (H, -pi / 2, 0), (0, 0, 1),
    ],
}  # fmt: skip
TABLES = {**{name: rows for name, (rows, _) in (SUBPROBLEMS | SIX).items()}, **OBLIQUE}
FACTORED = (
    "spherical wrist, axes 1 and 2 meet",
    "spherical wrist, axes 1 and 2 parallel",
    "axes 2, 3 and 4 meet in a point, 5 and 6 meet",
    "axes 2, 3 and 4 meet in a point, 5 and 6 are parallel",
    "axes 1, 2 and 3 parallel, 5 and 6 meet",
    "axes 6, 5 and 4 parallel, 3 and 2 meet",
    "axes 5, 4 and 3 parallel, 2 and 1 meet",
    *OBLIQUE,
)
"""Structures whose singular set has a factor for each joint that can reach the end of its range."""
THREE = {"axes 1, 2 and 3 parallel, 5 and 6 meet": 2, **dict.fromkeys(OBLIQUE, 1)}
"""Those with three factors that vanish together, where a tilt limits the wrist, and how often."""
FRANKA = "spherical shoulder, axes 6 and 5 meet, with t7 given"
OK, SINGULAR = 0, 2
BASES, AROUND = 4, 400
SIZE = 6
"""About the sum of the lengths of each of these arms."""


def around(bases: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """Postures from the given ones up to a thousandth away, down to where rounding hides it."""
    q = np.repeat(bases, AROUND, axis=0)
    away = 10 ** rng.uniform(-17, -3, q.shape) * rng.choice((-1, 1), q.shape)
    return q + away * (rng.random(q.shape) < 0.6)


def check(robot: ModuleType, q: np.ndarray, *given: np.ndarray) -> None:
    T = robot.fk(q)
    found = robot.ik(T, *given)
    ok = found.status == OK
    assert (ok | (found.status == SINGULAR)).any(axis=-1).all()
    miss = np.abs(robot.fk(found.q) - T[:, None]).max(axis=(-1, -2))
    assert miss[ok].max() < 1e-12 * SIZE


def check_common_zeros(structure: str, tmp_path: Path, together: int) -> int:
    """Check postures near zeros of as many factors of the singular set; the sets that have any."""
    d, serial = arm(TABLES[structure])
    serial.export(d)
    solved(d, serial, propose(serial).source)
    robot, rng, tried = printed(d, tmp_path), np.random.default_rng(2), 0
    for some in itertools.combinations(range(len(robot.SINGULARITIES)), together):
        starts = rng.uniform(-np.pi, np.pi, (3 * BASES, 6))
        found = [newton(lambda q: robot.singularities(q)[list(some)], q) for q in starts]  # noqa: B023
        bases = [q for q in found if q is not None][:BASES]
        if bases:
            tried += 1
            check(robot, around(np.array(bases), rng))
    return tried


@pytest.mark.parametrize("structure", FACTORED)
def test_no_posture_is_lost_where_factors_vanish_together(structure: str, tmp_path: Path) -> None:
    assert check_common_zeros(structure, tmp_path, together=2) >= 1


@pytest.mark.parametrize("structure", THREE)
def test_no_posture_is_lost_where_three_factors_vanish(structure: str, tmp_path: Path) -> None:
    """A tangent turn, a straight elbow, and a wrist at the limit of its tilt."""
    assert check_common_zeros(structure, tmp_path, together=3) == THREE[structure]


def test_no_posture_is_lost_where_a_joint_between_lets_the_last_axis_be_as_the_first(
    tmp_path: Path,
) -> None:
    """Joint 4 is between the parallel axes and the wrist, and lets axes 3 and 6 be parallel."""
    d, serial = arm(TABLES["axes 1, 2 and 3 parallel, 5 and 6 meet"])
    serial.export(d)
    solved(d, serial, propose(serial).source)
    robot, rng = printed(d, tmp_path), np.random.default_rng(2)
    starts = rng.uniform(-np.pi, np.pi, (8 * BASES, 6))
    found = [newton(lambda q: robot.fk(q)[:2, 2], q) for q in starts]
    bases = [q for q in found if q is not None][: 2 * BASES]
    assert len(bases) == 2 * BASES
    check(robot, around(np.array(bases), rng))
    q = rng.uniform(-np.pi, np.pi, (2000, 6))
    q[:, 3:5] = rng.choice((-1, 1), (2000, 2)) * np.pi / 2
    q[::2, 1] = 0  # a straight elbow
    away = rng.choice((0, 1e-15, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4), (2000, 1))
    check(robot, q + away * rng.choice((-1, 0, 1), q.shape))


def test_no_posture_is_lost_where_an_elbow_with_an_offset_is_stretched_and_axis_6_is_passed(
    tmp_path: Path,
) -> None:
    """At t5 = +-pi/2, axis 6 is as far from the shoulder as the elbow allows."""
    d, serial = arm(TABLES[FRANKA])
    serial.export(d)
    solved(d, serial, propose(serial, "t7").source)
    robot, rng = printed(d, tmp_path), np.random.default_rng(2)
    q = rng.uniform(-np.pi, np.pi, (8 * BASES, 7))
    q[:, 3] = -np.arctan2(4, 3)  # both links are 2 long and 1 aside
    q[:, 4] = rng.choice((-1, 1), len(q)) * np.pi / 2
    q = around(q, rng)
    check(robot, q, q[:, 6])
