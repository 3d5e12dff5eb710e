"""A hand in a plane that slides on three driven pins, against Newton's method on its own lines."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of, unbroken
from places import TESTS

from closedform import prove
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

CRANKS = (TESTS / "held_out_loops" / "three_rrp.toml").read_text("utf-8")
SLIDERS = CRANKS.replace(
    'at = "A1", driven', 'at = "A1", kind = "prismatic", axis = [0, 1], driven'
)
OK = 0
THIRDS = 2 * np.pi / 3 * np.arange(3)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("pins")
    return derived("three_rrp", script_of("three_rrp", CRANKS, folder), folder)


def pins(v, q: np.ndarray) -> np.ndarray:
    """The pins, leg by leg, turned about the centre."""
    local = np.stack([v.a - v.l * np.sin(q), v.l * np.cos(q)], axis=-1)
    c, s = np.cos(THIRDS), np.sin(THIRDS)
    turned = [c * local[..., 0] - s * local[..., 1], s * local[..., 0] + c * local[..., 1]]
    return np.stack(turned, axis=-1)


def off(v, q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """How far the pins are from the lines of the hand."""
    normals = np.stack([np.cos(THIRDS + x[2]), np.sin(THIRDS + x[2])], axis=-1)
    return (normals * (pins(v, q) - x[:2])).sum(axis=-1) - v.b


def test_newton_finds_no_posture_that_the_closed_form_lacks(robot: ModuleType) -> None:
    v, rng, hit = robot.Parameters(), np.random.default_rng(1), np.zeros(2, bool)
    for q in rng.uniform(-np.pi, np.pi, (6, 3)):
        p, status = robot.fk(q)
        for start in rng.uniform([-1, -1, -np.pi], [1, 1, np.pi], (10, 3)):
            if (x := newton(lambda x, q=q: off(v, q, x), start)) is not None:
                gap = p - x
                gap[:, 2] = np.angle(np.exp(1j * gap[:, 2]))
                near = np.abs(gap).max(axis=-1) < 1e-6
                assert near.any() and (status == OK).all()
                hit |= near
    assert hit.all()


def test_the_inverse_has_eight_working_modes(robot: ModuleType) -> None:
    q = np.random.default_rng(2).uniform(-np.pi, np.pi, (2000, 3))
    p, status = robot.fk(q)
    rows, modes = np.nonzero(status == OK)
    answers, told = robot.ik(p[rows, modes])
    assert answers.shape[1:] == (8, 3) and len(rows) > 1000
    best = np.abs(np.angle(np.exp(1j * (answers - q[rows, None])))).max(-1)
    assert np.median(np.nanmin(best, axis=-1)) < 1e-13
    row, branch = np.nonzero(told == OK)
    again = robot.fk(answers[row, branch]).p - p[rows, modes][row][:, None]
    again[..., 2] = np.angle(np.exp(1j * again[..., 2]))
    assert np.nanmin(np.abs(again).max(axis=-1), axis=-1).max() < 1e-11


def test_the_jacobian_is_the_derivative(robot: ModuleType) -> None:
    q, h = np.random.default_rng(3).uniform(-np.pi, np.pi, (300, 3)), 1e-6
    J, status = robot.jacobian(q), robot.fk(q).status
    for k, step in enumerate(h * np.eye(3)):
        gap = robot.fk(q + step).p - robot.fk(q - step).p
        gap[..., 2] = np.angle(np.exp(1j * gap[..., 2]))
        well = (status == OK) & (np.abs(J).max(axis=(-2, -1)) < 10)
        assert well.sum() > 50
        assert np.abs(gap / (2 * h) - J[..., k])[well].max() < 1e-5


def test_sliders_carry_the_pins(tmp_path: Path) -> None:
    d = read_script(script_of("three_prp", SLIDERS, tmp_path))
    assert tuple(i.solutions for i in prove(d).inverses) == (2, 1)


def test_parallel_lines_are_refused(tmp_path: Path) -> None:
    script = unbroken(script_of("three_rrp", CRANKS, tmp_path))
    for way in ("(-sqrt(3)/2, Rational(-1, 2)))", "(sqrt(3)/2, Rational(-1, 2)))"):
        assert way in script
        script = script.replace(way, "(0, 1))")
    with pytest.raises(ShapeError, match="parallel"):
        read_script(script)


def test_balls_that_slide_on_a_hand_in_space_are_named(tmp_path: Path) -> None:
    """With sliders along z it is derived, see test_on_balls."""
    text = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = ["b", 0, 0]}
slider1 = {B1 = ["b", 0, 0]}
block1 = {}
platform = {P = [0, 0, 0], C1 = ["c", 0, 0]}
[joints.q1]
between = ["ground", "slider1"]
at = "A1"
kind = "prismatic"
axis = [1, 0, 0]
driven = true
[joints.s1]
between = ["slider1", "block1"]
at = "B1"
kind = "spherical"
[joints.p1]
between = ["block1", "platform"]
at = "C1"
kind = "prismatic"
axis = [1, 0, 0]
"""
    with pytest.raises(TableError, match=r"3-PSP mechanism; this is supported for three parallel"):
        script_of("psp", text, tmp_path)
