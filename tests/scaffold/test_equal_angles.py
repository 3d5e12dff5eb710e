"""Wrists whose angles are parameters, which may be equal: then all three axes can be in line."""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from arms import OK, SINGULAR, UNREACHABLE, link, misses
from chains import arm, printed, solved
from sympy import pi

from closedform.proof.prove import prove
from closedform.scaffold.chains.propose import propose

k, j = sp.symbols("k j", real=True)
H = sp.Rational(1, 2)
ARMS = {
    "spherical wrist": [
        (H, pi / 2, 1), (2, 0, H), (H, pi / 2, 0), (0, k, 2), (0, j, 0), (0, 0, 1),
    ],
    "UR type": [(0, pi / 2, 1), (2, 0, 0), (2, 0, 0), (0, k, H), (0, j, H), (0, 0, H)],
    "spherical shoulder": [
        (0, k, 1), (0, j, 0), (H, pi / 2, 2), (2, 0, H), (H, pi / 2, 1), (0, 0, 1),
    ],
}  # fmt: skip
ANGLES = [(1.0, 1.0), (1.0, 1.0 + 1e-9), (1.0, np.pi - 1.0), (0.7, 0.3), (2.0, 2.0 - 1e-5)]
"""Equal ones, nearly so, angles that add up to half a turn, and any others."""


@pytest.fixture(scope="module", params=ARMS)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Any:
    rows = ARMS[request.param]
    d, serial = arm(rows, k="1", j="1")
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 8
    return rows, printed(d, tmp_path_factory.mktemp("arm"))


@pytest.mark.parametrize("name", ARMS)
@pytest.mark.parametrize("known", [k, j])
def test_one_of_the_angles_is_a_number_with_roots(name: str, known: sp.Symbol, tmp_path) -> None:
    """Solutions are counted in rational numbers, and the sine of 60 degrees is none."""
    rows = [tuple(sp.sympify(e).subs(known, -pi / 3) for e in row) for row in ARMS[name]]
    other = j if known == k else k
    d, serial = arm(rows, **{other.name: "1"})
    solved(d, serial, propose(serial).source)
    assert prove(d).inverses[0].branches == 8
    module, rng = printed(d, tmp_path), np.random.default_rng(3)
    q = rng.uniform(-3, 3, (500, 6))
    q[:100, 1 if name == "spherical shoulder" else 4] = 0
    for angle in (1.0, np.pi / 3, np.pi / 3 + 1e-9, -2 * np.pi / 3):
        T = pose(rows, (angle, angle), q)
        answers, status = module.ik(T, params=(angle,))
        assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
        reached = pose(rows, (angle, angle), answers)
        away, turned = misses(reached, T, np.where(status == OK, OK, UNREACHABLE))
        assert away < 8e-12 and turned < 1e-12


def pose(rows: list, angles: tuple[float, float], q: np.ndarray) -> np.ndarray:
    at = dict(zip((k, j), angles, strict=True))
    T = np.eye(4)
    for i, (a, alpha, d) in enumerate(rows):
        alpha = float(sp.sympify(alpha, strict=True).xreplace(at))
        T = T @ link(float(a), alpha, float(d), q[..., i])
    return T


@pytest.mark.parametrize("angles", ANGLES)
def test_axes_in_line_cost_no_digits(made: Any, angles: tuple[float, float]) -> None:
    """The middle joint followed from a cosine, and lost half of its digits at half a turn."""
    rows, module = made
    rng = np.random.default_rng(11)
    q = rng.uniform(-3, 3, (4000, 6))
    middle = 1 if rows[0][1] == k else 4
    near = rng.choice([0, 1e-12, 1e-9, 1e-8, 1e-7, 1e-6, 1e-4], len(q)) * rng.choice(
        [-1, 1], len(q)
    )
    q[:, middle] = rng.choice([0, np.pi], len(q)) + near
    T = pose(rows, angles, q)
    answers, status = module.ik(T, params=angles)
    assert np.isin(status, (OK, SINGULAR)).any(axis=-1).all()
    reached = pose(rows, angles, answers)
    for kinds, missed in (((OK,), 1e-12), ((OK, SINGULAR), 1e-10)):
        away, turned = misses(reached, T, np.where(np.isin(status, kinds), OK, UNREACHABLE))
        assert away < 8 * missed and turned < missed
