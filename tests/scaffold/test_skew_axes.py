"""Three parallel axes and three skew ones: solutions meet where a fourth axis is parallel."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from arms import OK, SINGULAR, misses
from chains import arm, compiled, printed, solved
from proposals import forward
from sympy import Rational, pi

from closedform.scaffold.chains.propose import propose

H, THIRD = Rational(1, 2), Rational(1, 3)
ARMS = {
    "parallel last": [(1, pi / 2, 1), (1, -pi / 2, 1), (1, pi / 2, 1), (1, 0, 1), (1, 0, 1),
                      (1, 0, 1)],
    "parallel first": [(1, 0, 1), (1, 0, 1), (1, pi / 2, 1), (1, -pi / 2, 1), (1, pi / 2, 1),
                       (0, 0, 1)],
    "oblique": [(1, pi / 3, H), (1, pi / 3, 1), (H, pi / 3, 1), (1, 0, H), (THIRD, 0, 1),
                (H, 0, 1)],
}  # fmt: skip
"""Where axes 1 and 3 (or 4 and 6) are as far from the axis between them, three solutions meet."""
FOURTH = {"parallel last": 2, "parallel first": 3, "oblique": 2}
"""The joint that brings a fourth axis parallel to the three: at 0 or at half a turn."""


@cache
def made(name: str) -> Any:
    d, serial = arm(ARMS[name])
    found = propose(serial)
    assert "quartic" in found.lemmas and found.branches == 8
    solved(d, serial, found.source)
    serial.export(d)
    return d


@pytest.mark.parametrize("near", [0.0, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7])
@pytest.mark.parametrize("name", ARMS)
def test_no_posture_is_lost_where_a_fourth_axis_is_parallel(
    name: str, near: float, tmp_path: Path
) -> None:
    """The fourth axis makes the offset turn freely, within what the target does not tell."""
    code = printed(made(name), tmp_path)
    q = np.random.default_rng(3).uniform(-np.pi, np.pi, (4000, 6))
    q[:, FOURTH[name]] = np.where(q[:, 0] > 0, np.pi, 0) + near
    T = forward(ARMS[name], q)
    answers, status = code.ik(T)
    done = np.isin(status, (OK, SINGULAR)).any(axis=1)
    assert (~done).sum() <= 8
    size = abs(T[:, :3, 3]).max()
    assert misses(code.fk(np.nan_to_num(answers)), T, status)[0] < 2e-12 * size


@pytest.mark.parametrize("name", ARMS)
def test_one_call_gives_what_a_batch_gives(name: str, tmp_path: Path) -> None:
    """They are different programs; a call once divided by 1 instead of what is not zero."""
    library = compiled(made(name), tmp_path)
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (500, 6))
    T = np.repeat(forward(ARMS[name], q), 2, axis=0)
    answers, status = library.function("ik")(T, ())
    assert np.isin(status, (OK, SINGULAR)).any(axis=1).all()
    np.testing.assert_allclose(answers[::2], answers[1::2], rtol=0, atol=1e-12)
    np.testing.assert_array_equal(status[::2], status[1::2])
