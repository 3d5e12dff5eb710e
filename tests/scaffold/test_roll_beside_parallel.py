"""Arms of three parallel axes, another joint, and a roll whose axis this joint can make parallel.

There the joint is tangent too, so that rounding hides its angle, and the cosine between the axes
does not say whether the wrist can tilt as far as the target has it.
"""

from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, misses
from chains import arm, printed, solved
from proposals import forward
from sympy import pi

from closedform.scaffold.chains.propose import propose

A, B, C, D, E = (sp.Rational(n, 100) for n in (40, 35, 20, 15, 10))
WRISTS = {"at a right angle": pi / 2, "oblique": pi / 4}


@pytest.mark.parametrize("name", WRISTS)
def test_no_posture_is_lost_where_the_roll_is_parallel(name: str, tmp_path: Path) -> None:
    """Up to 80 of 100 were, within 1e-8 rad of there."""
    rows = [(A, 0, 0), (B, 0, 0), (C, pi / 2, E), (0, pi / 2, 0), (0, WRISTS[name], D), (0, 0, E)]
    d, serial = arm(rows)
    found = propose(serial)
    assert found.structure == "axes 1, 2 and 3 parallel, 5 and 6 meet"
    solved(d, serial, found.source)
    serial.export(d)
    robot = printed(d, tmp_path)
    rng, n = np.random.default_rng(7), 2000
    q = rng.uniform(-np.pi, np.pi, (n, 6))
    away = 10.0 ** rng.uniform(-13, -3, n)
    q[:, 3] = rng.integers(-1, 3, n) * np.pi / 2 + rng.choice([-1, 1], n) * away
    T = forward([[float(e) for e in row] for row in rows], q)
    answers, status = robot.ik(T)
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    assert max(misses(robot.pose(answers), T, status)) < 1e-12 * 2
