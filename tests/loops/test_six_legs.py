"""Platforms on six legs, from files that describe a pair of them, against their drawings.

Newton's method on the lengths of the rods finds no joints that the closed form lacks.
"""

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, read_script, script_of
from places import TESTS

from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
LINES = 40
UNREACHABLE = 1
TURNS = np.repeat(np.exp(2j * np.pi / 3 * np.arange(3)), 2)
SIGNS = np.array([1, -1] * 3)


def around(turned: np.ndarray) -> np.ndarray:
    """Points of the plane z = 0, from complex numbers."""
    return np.stack([turned.real, turned.imag, 0 * turned.real], axis=-1)


def gough(v, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The near ends of the rods, and how long the rods are."""
    return around(TURNS * (v.b + 1j * v.g * SIGNS)), q


def hexa(v, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A positive angle lowers the crank, because its axis is to the left of it."""
    ends = around(TURNS * (v.b + v.l * np.cos(q) + 1j * v.g * SIGNS))
    return ends - np.outer(v.l * np.sin(q), [0, 0, 1]), np.full(6, v.r)


def hexaglide(v, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return around(TURNS * (v.b + 1j * v.g * SIGNS)) + np.outer(q, [0, 0, 1]), np.full(6, v.r)


DRAWN: dict[str, tuple[Callable, int, float]] = {
    "gough": (gough, 1, 0.8),
    "hexa": (hexa, 64, -0.45),
    "hexaglide": (hexaglide, 64, 0.1),
}
"""The drawing, the number of working modes, and the height of the hand that is tried."""


@pytest.fixture(scope="module", params=DRAWN)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = (FOLDER / f"{request.param}.toml").read_text("utf-8")
    assert len(text.splitlines()) < LINES
    folder = tmp_path_factory.mktemp("six_legs")
    name = f"{request.param}_held_out"
    return derived(name, script_of(name, text, folder), folder, crosscheck=True)


def drawn(robot: ModuleType) -> tuple[Callable, int, float]:
    return DRAWN[robot.__name__.split(".")[-1].removesuffix("_held_out")]


def poses(robot: ModuleType, rows: int, seed: int) -> np.ndarray:
    """Poses at the height that is tried, turned by up to half a radian about each axis."""
    rng, T = np.random.default_rng(seed), np.tile(np.eye(4), (rows, 1, 1))
    x, y, z = rng.uniform(-0.3, 0.3, (3, rows))
    o = 0 * x
    W = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)
    T[:, :3, :3] = (np.eye(3) + W) @ np.linalg.inv(np.eye(3) - W)  # Cayley's formula
    T[:, :3, 3] = rng.uniform(-0.05, 0.05, (rows, 3))
    T[:, 2, 3] += drawn(robot)[2]
    return T


def missed(robot: ModuleType, T: np.ndarray, q: np.ndarray) -> np.ndarray:
    v, (near, _, _) = robot.Parameters(), drawn(robot)
    ends, lengths = near(v, q)
    hand = around(TURNS * (v.c + 1j * v.h * SIGNS)) @ T[:3, :3].T + T[:3, 3]
    return np.linalg.norm(hand - ends, axis=1) - lengths


def test_newton_finds_no_joints_that_the_closed_form_lacks(robot: ModuleType) -> None:
    rng, found, modes = np.random.default_rng(1), 0, drawn(robot)[1]
    assert len(robot.BRANCHES) == modes
    turns = [robot.SKELETON.joints[name].kind == "revolute" for name in robot.JOINTS]
    for T in poses(robot, 4, 2):
        answers, seen = robot.ik(T), set()
        assert not np.any(answers.status == UNREACHABLE)
        for start in rng.uniform(-3, 3, (100, 6)):
            q = newton(lambda q: missed(robot, T, q), np.abs(start) if modes == 1 else start)  # noqa: B023
            if q is None or (modes == 1 and min(q) < 0):
                continue
            off = apart(answers.q, q, turns)
            assert off.min() < 1e-6
            seen.add(int(off.argmin()))
        found += len(seen)
    assert found > 4 * modes / 2


def test_all_answers_close_the_loops(robot: ModuleType) -> None:
    for T in poses(robot, 30, 3):
        answers = robot.ik(T)
        for q in answers.q[answers.status != UNREACHABLE]:
            assert np.abs(missed(robot, T, q)).max() < 1e-14


def test_a_twist_needs_the_rates_that_differences_have(robot: ModuleType) -> None:
    rng, h = np.random.default_rng(4), 1e-6
    for T in poses(robot, 20, 5):
        twist = rng.normal(size=6)
        x, y, z = twist[3:]
        W = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        after = []
        for t in (h, -h):
            moved = T.copy()
            moved[:3, :3] = (np.eye(3) + t * W + t**2 / 2 * W @ W) @ T[:3, :3]
            moved[:3, 3] += t * twist[:3]
            after.append(robot.ik(moved).q)
        rates = robot.jacobian_inverse(T, robot.ik(T).q) @ twist
        assert np.allclose((after[0] - after[1]) / (2 * h), rates, rtol=1e-5, atol=1e-5)


DELTA = """
hand = "P"
copies = 3

[bodies]
ground = {A1 = ["f", 0, 0]}
hand = {P = [0, 0, 0], C1 = ["e", 0, 0]}
crank1 = {B1 = ["f + L", 0, 0]}
rod1 = {length = "l", parallelogram = [0, "w", 0]}

[joints]
theta1 = {between = ["ground", "crank1"], at = "A1", axis = [0, 1, 0], driven = true}
b1 = {between = ["crank1", "rod1"], at = "B1"}
c1 = {between = ["rod1", "hand"], at = "C1"}
"""


def test_a_delta_is_described_by_one_leg(tmp_path: Path) -> None:
    d = read_script(script_of("delta", DELTA, tmp_path))
    assert [str(q) for q in d.actuated] == ["theta1", "theta2", "theta3"]
    assert len(d.branches) == 8


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("copies = 3", "copies = 5", "copies must be one of 2, 3, 4, 6"),
        ("copies = 3", "copies = true", "copies must be one of 2, 3, 4, 6"),
        ("copies = 3", "copies = 2", "2 joints are driven, but a hand that does not turn needs 3"),
    ],
)
def test_copies_that_cannot_be_say_why(old: str, other: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=message):
        script_of("delta", DELTA.replace(old, other), tmp_path)


def test_copies_need_numbers(tmp_path: Path) -> None:
    text = DELTA.replace("1 =", " =").replace('1"', '"')
    with pytest.raises(TableError, match="names that end in a number"):
        script_of("delta", text, tmp_path)
