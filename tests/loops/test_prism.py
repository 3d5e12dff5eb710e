"""Three, two and one rods, as on a Gantry-Tau, against the equations of all six rods."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from loop_files import derived, newton, script_of
from places import TESTS

from closedform import Crank, Derivation, Paper, Parallelogram, Prism, Slide, parallel, real
from closedform.algebra.shapes import ShapeError
from closedform.cli.commands import main
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "gantry_tau.toml").read_text("utf-8")
NEAR = np.array(
    [
        [0, 0.6, 0.5],
        [0, 0.6, -0.45],
        [0, 0.6, -0.35],
        [0, -0.6, 0],
        [0, -0.6, 0.1],
        [0.05, -0.6, 0.05],
    ]
)
FAR = np.array(
    [
        *[[0, 0.05, 0.1], [0, 0.05, -0.05], [0, 0.05, 0.05]],
        *[[0, -0.05, -0.05], [0, -0.05, 0.05], [0.05, -0.05, 0]],
    ]
)
SLIDER = np.array([0, 1, 1, 2, 2, 2])
LENGTHS = np.array([0.9, 0.9, 0.9, 0.8, 0.8, 0.8])


@pytest.fixture(scope="module")
def tau(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("tau")
    return derived("tau", script_of("tau", TEXT, folder), folder)


def turned(w: np.ndarray) -> np.ndarray:
    angle = np.linalg.norm(w)
    if angle == 0:
        return np.eye(3)
    x, y, z = w / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def missed(q: np.ndarray, pose: np.ndarray) -> np.ndarray:
    """By how much all six rods miss their lengths, at a position and a vector of rotation."""
    starts = NEAR + np.outer(q[SLIDER], [1, 0, 0])
    return np.linalg.norm(pose[:3] + FAR @ turned(pose[3:]).T - starts, axis=1) - LENGTHS


def rates(q: np.ndarray, p: np.ndarray) -> np.ndarray:
    at, h = np.concatenate([p, np.zeros(3)]), 1e-6
    return np.array([(missed(q, at + s) - missed(q, at - s)) / (2 * h) for s in h * np.eye(6)]).T


def test_the_six_rods_hold_the_hand_where_the_closed_form_says(tau: ModuleType) -> None:
    rng, found, compared = np.random.default_rng(1), 0, []
    for q in rng.uniform(-0.3, 0.3, (50, 3)):
        p, status = tau.fk(q)
        for k in np.flatnonzero(status == 0):
            assert np.abs(missed(q, np.concatenate([p[k], np.zeros(3)]))).max() < 1e-14
            factor, A = tau.constraint(q)[k, 0], tau.determinant(q)[k]
            six = np.linalg.det(rates(q, p[k]))
            # the six rods hold it by the three spheres and by what keeps it from turning
            volume = np.linalg.det(tau.jacobian_parallel(q)[k]) / (0.9**3 * 0.8**3)
            compared.append(six / (factor * volume))
            assert np.isfinite(A)
            if abs(factor) < 0.05:
                continue
            start = np.concatenate([p[k], np.zeros(3)]) + rng.uniform(-0.01, 0.01, 6)
            pose = newton(lambda pose: missed(q, pose), start)  # noqa: B023
            assert pose is not None and np.abs(pose[3:]).max() < 1e-9
            found += 1
    assert found > 30
    assert np.allclose(compared, compared[0], rtol=1e-6)


def test_an_article_is_printed(tmp_path: Path) -> None:
    script = tmp_path / "tau.py"
    script.write_text(script_of("tau", TEXT, tmp_path), "utf-8")
    assert main(["derive", str(script), "-o", str(tmp_path / "out"), "--backend", "latex"]) == 0
    assert "third rod" in (tmp_path / "out" / "latex" / "tau.tex").read_text("utf-8")


@pytest.mark.parametrize(
    ("old", "other"),
    [
        ("C3c = [0.05, -0.05, 0]", "C3c = [0.05, -0.05, 0.01]"),
        ('r3c = {length = "m"}', 'r3c = {length = "l"}'),
    ],
)
def test_rods_that_are_not_parallel_are_refused(old: str, other: str, tmp_path: Path) -> None:
    assert old in TEXT
    with pytest.raises(TableError, match="as on a Gantry-Tau"):
        script_of("t", TEXT.replace(old, other), tmp_path)


def legs(*rods: object) -> list[Slide]:
    joints = [real(f"q{k}") for k in (1, 2, 3)]
    places = ((0, 3, 0), (0, -3, 0), (0, 0, 4)), ((0, 1, 0), (0, -1, 0), (0, 0, 1))
    return [
        Slide(q, rod, at, (1, 0, 0), e) for q, rod, at, e in zip(joints, rods, *places, strict=True)
    ]


def plain() -> tuple[Derivation, list[sp.Symbol]]:
    d = Derivation("plain", "", Paper("", "", ()), "", task=["x", "y", "z"])
    for k in (1, 2, 3):
        d.joint(f"q{k}", "prismatic")
    return d, [real(x) for x in "xyz"]


@pytest.mark.parametrize(
    ("rods", "message"),
    [
        ((4, 5, Prism(5, (0, 0, 1), 1, (1, 0, 0))), "nothing keeps it from turning"),
        (
            (
                Parallelogram(4, (1, 0, 0), 1),
                Parallelogram(4, (0, 1, 0), 1),
                Prism(5, (0, 0, 1), 1, (1, 0, 0)),
            ),
            "in 4 ways, of which 1 is redundant",
        ),
        (
            (4, Parallelogram(4, (1, 0, 0), 1), Prism(5, (0, 0, 1), 1, (0, 0, 2))),
            "not along its bar",
        ),
    ],
)
def test_other_rods_are_refused(rods: tuple, message: str) -> None:
    d, hand = plain()
    with pytest.raises(ShapeError, match=message):
        parallel(d, hand, legs(*rods))


def test_a_crank_would_turn_the_triangle() -> None:
    d = Derivation("cranked", "", Paper("", "", ()), "", task=["x", "y", "z"])
    for k in (1, 2):
        d.joint(f"q{k}", "prismatic")
    q3 = d.joint("q3")
    first, second, _ = legs(4, Parallelogram(4, (1, 0, 0), 1), 5)
    prism = Prism(5, (0, 1, 0), 1, (1, 0, 0))
    crank = Crank(
        joint=q3,
        length=1,
        rod=prism,
        pivot=(0, 0, 4),
        along=(1, 0, 0),
        across=(0, 0, 1),
        on_hand=(0, 0, 1),
    )
    with pytest.raises(ShapeError, match="turns the triangle on it"):
        parallel(d, [real(x) for x in "xyz"], [first, second, crank])
