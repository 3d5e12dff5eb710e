"""A hand on a leg whose slide is driven, and on two more legs (TriVariant), against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS
from sympy import Matrix

from closedform import Derivation, Guide, Paper, Stretch, guided
from closedform.algebra.shapes import ShapeError
from closedform.algebra.solutions import count_solutions
from closedform.loops.guides import TURNS, Driven
from closedform.mechanics.frames import rotation
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "trivariant.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def head(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("head")
    return derived("head", script_of("head", TEXT, folder), folder, crosscheck=True)


def off(v, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """By how much the legs miss their lengths, at two turns and the length of the middle leg."""
    (a, b), (s, t) = np.cos(u[:2]), np.sin(u[:2])
    R = np.array([[1, 0, 0], [0, a, -s], [0, s, a]]) @ np.array([[b, 0, t], [0, 1, 0], [-t, 0, b]])
    rods = [R @ [v.c, side * v.c, u[2]] - np.array([v.b, side * v.b, 0]) for side in (1, -1)]
    return np.array([u[2] - q[0], *(np.linalg.norm(rods, axis=1) - q[1:])])


def test_postures_that_newton_finds_have_these_joints(head: ModuleType) -> None:
    v, rng, count = head.Parameters(), np.random.default_rng(1), 0
    for u in rng.uniform((-1, -1, 0.4), (1, 1, 1.5), (20, 3)):
        q = off(v, np.zeros(3), u)
        for start in (u, *rng.uniform((-1, -1, 0.4), (1, 1, 1.5), (5, 3))):
            found = newton(lambda u: off(v, q, u), start)  # noqa: B023
            if found is None or found[2] < 0:
                continue
            (a, b), (s, t) = np.cos(found[:2]), np.sin(found[:2])
            x = found[2] * np.array([t, -s * b, a * b])
            if b < 0:
                continue  # the half turn that is left out
            [joints], [status] = head.ik(x)
            assert status in (OK, SINGULAR) and np.allclose(joints, q)
            count += 1
    assert count > 40


def test_rates(head: ModuleType) -> None:
    x = np.array([0.2, -0.1, 0.9])
    [q], [status] = head.ik(x)
    step = np.array([1e-6, 2e-6, -1e-6])
    assert status == OK
    assert np.allclose(head.ik(x + step).q[0] - q, head.jacobian_inverse(x, q) @ step, atol=1e-11)
    assert np.allclose(head.jacobian(x, q) @ head.jacobian_inverse(x, q), np.eye(3))


def test_the_degree_of_the_forward_problem() -> None:
    R, draw = rotation("x", TURNS[0]) * rotation("y", TURNS[1]), np.random.default_rng(1)
    equations = []
    for place, base in draw.integers(-9, 9, (2, 2, 3)).tolist():
        rod = R * Matrix(place) - Matrix(base)
        equations.append(rod.dot(rod) - 70)
    found = count_solutions(equations, tuple(TURNS), method="specialised")
    assert found.count == Driven.degree


def test_a_driven_slide_is_one_of_the_legs() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [d.joint(f"q{k}", "prismatic") for k in range(3)]
    guide = Guide(q[0], (0, 0, 0), (1, 0, 0), (0, 1, 0))
    legs = [Stretch(joint, (k, 1, 0), on_hand=(k, 0, 0)) for k, joint in enumerate(q)]
    with pytest.raises(ShapeError, match="one of the legs is a Stretch with this joint"):
        guided(d, guide, legs)


def test_a_third_leg_beside_it_is_too_many(tmp_path: Path) -> None:
    more = TEXT.replace("[joints]", "tube3 = {}\npiston3 = {}\n[joints]")
    more = more.replace('C2 = ["c", "-c", 0]}', 'C2 = ["c", "-c", 0], C3 = ["-c", 0, 0]}')
    more = more.replace('A2 = ["b", "-b", 0]}', 'A2 = ["b", "-b", 0], A3 = ["-b", 0, 0]}')
    more += """
a3 = {between = ["ground", "tube3"], at = "A3", kind = "universal"}
q3 = {between = ["tube3", "piston3"], at = "A3", kind = "prismatic", driven = true}
c3 = {between = ["piston3", "platform"], at = "C3", kind = "spherical"}
"""
    with pytest.raises(TableError, match="three degrees of freedom, so three joints are driven"):
        script_of("head", more, tmp_path)
