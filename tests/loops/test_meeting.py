"""Hands in a plane of which two legs end in one point, against Newton's method on their drawing."""

from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of

OK = 0
SLIDES = """
hand = "P"
[parameters]
a = {value = "0.5", meaning = "base"}
c = {value = "0.2", meaning = "hand"}
[bodies]
ground = {A1 = [0, 0], A2 = ["a/2", "a"], A3 = ["a", 0]}
top = {P = [0, 0], C = ["c", 0]}
tube1 = {}
tube2 = {}
tube3 = {}
rod1 = {}
rod2 = {}
rod3 = {}
[joints]
a1 = {between = ["ground", "tube1"], at = "A1"}
a2 = {between = ["ground", "tube2"], at = "A2"}
a3 = {between = ["ground", "tube3"], at = "A3"}
q1 = {between = ["tube1", "rod1"], at = "A1", kind = "prismatic", driven = true}
q2 = {between = ["tube2", "rod2"], at = "A2", kind = "prismatic", driven = true}
q3 = {between = ["tube3", "rod3"], at = "A3", kind = "prismatic", driven = true}
c1 = {between = ["rod1", "top"], at = "P"}
c2 = {between = ["rod2", "top"], at = "C"}
c3 = {between = ["rod3", "top"], at = "P"}
"""
MIXED = """
from sympy import Rational
from closedform import Crank, Derivation, Paper, Slide, Stretch, platform
paper = Paper("toy", "Toys", ("A. Nonymous",))
d = Derivation("meeting_mixed", "Mixed", paper, "Three kinds of legs.")
r = d.parameter("r", value=2, unit="m", meaning="rod", source="an example")
c = d.parameter("c", value=1, unit="m", meaning="hand", source="an example")
q = d.joint("q1"), d.joint("q2", "prismatic"), d.joint("q3", "prismatic")
u, v = (Rational(3, 5), Rational(4, 5)), (Rational(-4, 5), Rational(3, 5))
end, other = (c, Rational(-1, 5)), (Rational(-3, 10), Rational(2, 5))
platform(
    d,
    [
        Crank(q[0], Rational(4, 5), r, (0, 0), u, v, on_hand=end),
        Slide(q[1], r, (1, Rational(1, 10)), u, on_hand=other),
        Stretch(q[2], (Rational(-1, 2), 2), on_hand=end),
    ],
)
"""


def ends_of_slides(robot: ModuleType, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The near ends of the rods, their lengths, and their ends on the hand."""
    a, c = robot.Parameters()
    return np.array([0, a / 2 + 1j * a, a]), q, np.array([0, c, 0])


def ends_of_mixed(robot: ModuleType, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    r, c = robot.Parameters()
    u = 0.6 + 0.8j
    near = np.array([0.8 * u * np.exp(1j * q[0]), 1 + 0.1j + q[1] * u, -0.5 + 2j])
    return near, np.array([r, r, q[2]]), np.array([c - 0.2j, -0.3 + 0.4j, c - 0.2j])


CASES = {"slides": (SLIDES, ends_of_slides), "mixed": (MIXED, ends_of_mixed)}


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    text, ends = CASES[request.param]
    name, folder = f"meeting_{request.param}", tmp_path_factory.mktemp("meeting")
    script = script_of(name, text, folder) if text == SLIDES else text
    return derived(name, script, folder), ends


def joints(rows: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(0.2, 1.4, (rows, 3))


def missed(ends: tuple[np.ndarray, np.ndarray, np.ndarray], x: np.ndarray) -> np.ndarray:
    """By how much the rods miss their lengths at a pose."""
    near, length, on_hand = ends
    return np.abs(x[0] + 1j * x[1] + on_hand * np.exp(1j * x[2]) - near) - length


def test_the_modes_are_all_postures(case: tuple) -> None:
    """Newton's method from many starts finds most of them, and no other."""
    robot, ends = case
    rng, hits, several = np.random.default_rng(2), 0, 0
    for q in joints(15, 1):
        fk = robot.fk(q)
        there = fk.p[fk.status == OK]
        several += len(there)
        here = ends(robot, q)
        assert all(np.abs(missed(here, x)).max() < 1e-12 for x in there)
        found = set()
        for start in rng.uniform((-2, -2, -np.pi), (2, 2, np.pi), (40, 3)):
            x = newton(lambda x: missed(here, x), start)  # noqa: B023
            if x is not None:
                away = np.abs(np.exp(1j * there[:, 2]) - np.exp(1j * x[2]))
                away += np.abs(there[:, :2] - x[:2]).sum(-1)
                assert away.min() < 1e-6, (q, x)
                found.add(int(away.argmin()))
        hits += len(found)
    assert several > 10
    assert hits > 0.8 * several


def test_the_inverse_returns_to_the_joints(case: tuple) -> None:
    robot, _ = case
    q = joints(20_000, 3)
    fk = robot.fk(q)
    rows, mode = np.nonzero(fk.status == OK)
    answers = robot.ik(fk.p[rows, mode])
    off = np.abs(np.angle(np.exp(1j * (answers.q - q[rows, None]))))
    assert np.nanmin(np.where(np.isnan(off), np.inf, off).max(-1), axis=1).max() < 1e-6
    factors = robot.singularities(q)[rows, mode, -1]
    sides = np.array(
        [np.prod([1 if s == "plus" else -1 for s in b.split("_")]) for b in robot.ASSEMBLY_MODES]
    )
    assert len(set(np.sign(factors) * sides[mode])) == 1


def test_the_jacobian_is_the_derivative(case: tuple) -> None:
    robot, _ = case
    for q in joints(40, 4):
        J, there = robot.jacobian(q), robot.fk(q).status == OK
        near = np.abs(robot.singularities(q)[:, -1]) > 0.05
        for mode in np.nonzero(there & near)[0]:
            steps = 1e-6 * np.eye(3)
            rates = [(robot.fk(q + s).p - robot.fk(q - s).p)[mode] / 2e-6 for s in steps]
            assert np.allclose(np.transpose(rates), J[mode], atol=1e-5, rtol=1e-5)
