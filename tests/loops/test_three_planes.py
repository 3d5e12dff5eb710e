"""A hand on three legs in planes that meet in one point (3-RPS cube), against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS
from sympy import Rational

from closedform import (
    Crank,
    Derivation,
    Hinged,
    Paper,
    Slide,
    Stretch,
    ThreePlanes,
    guided,
    prove,
)
from closedform.algebra.shapes import ShapeError

TEXT = (TESTS / "held_out_loops" / "three_rps_cube.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)
NORMALS = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])


@pytest.fixture(scope="module")
def cube(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("cube")
    return derived("cube", script_of("cube", TEXT, folder), folder, crosscheck=True)


def rotation(r: np.ndarray) -> np.ndarray:
    K = np.cross(np.eye(3), r)
    return np.linalg.inv(np.eye(3) + K) @ (np.eye(3) - K)


def off(v, q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """How far the ends are from their planes, and by how much the legs miss their lengths."""
    rods = u[:3] + v.c * rotation(u[3:]).T - v.a * np.eye(3)
    return np.array([*(rods * NORMALS).sum(axis=1), *(np.linalg.norm(rods, axis=1) - q)])


def test_postures_that_newton_finds_have_these_joints(cube: ModuleType) -> None:
    v, rng, count = cube.Parameters(), np.random.default_rng(1), 0
    for q in rng.uniform(0.2, 0.6, (60, 3)):
        for start in rng.uniform(-0.4, 0.4, (5, 6)):
            u = newton(lambda u: off(v, q, u), start)  # noqa: B023
            if u is None:
                continue
            R = rotation(u[3:])
            [joints], [status] = cube.ik(R)
            assert status in (OK, SINGULAR) and np.allclose(joints, q)
            assert np.allclose(cube.hand_pose(R)[:3, 3], u[:3])
            count += 1
    assert count > 50


def test_rates(cube: ModuleType) -> None:
    w, step = np.array([0.3, -0.5, 0.2]), 1e-6
    for r in np.random.default_rng(2).uniform(-0.3, 0.3, (20, 3)):
        R = rotation(r)
        [q], [status] = cube.ik(R)
        moved = rotation(w * step / 2) @ R
        K = cube.jacobian_inverse(R, q)
        turn = moved @ R.T
        omega = np.array([turn[2, 1], turn[0, 2], turn[1, 0]])
        assert status == OK
        assert np.allclose(cube.ik(moved).q[0] - q, K @ omega, atol=1e-10)
        assert np.allclose(cube.jacobian(R, q) @ K, np.eye(3))


@pytest.mark.parametrize("kind", ["slide", "crank", "stretch"])
def test_each_kind_of_leg_in_oblique_planes_is_proved(kind: str) -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [
        d.joint(f"q{k}", "revolute" if kind == "crank" and not k else "prismatic") for k in range(3)
    ]
    first = {
        "slide": Slide(q[0], 2, (1, 0, 0), (0, 0, 1), on_hand=(1, 0, 0)),
        "crank": Crank(
            q[0], 1, 2, pivot=(1, 0, 0), along=(1, 0, 0), across=(0, 0, 1), on_hand=(1, 0, 0)
        ),
        "stretch": Stretch(q[0], (1, 0, 0), on_hand=(1, 0, 0)),
    }[kind]
    slanted = (0, Rational(3, 5), Rational(4, 5))
    others = [
        Stretch(q[1], (0, 2, 0), on_hand=(0, 1, 0)),
        Stretch(q[2], (0, 0, 3), on_hand=(0, 0, 1)),
    ]
    axes = [(0, 1, 0), slanted, (1, 0, 0)]
    guided(
        d,
        ThreePlanes(),
        [Hinged(leg, on_ground=n) for leg, n in zip([first, *others], axes, strict=True)],
    )
    assert {i.function: i.solutions for i in prove(d).inverses} == {
        "ik": 1 if kind == "stretch" else 2
    }


def test_planes_that_do_not_hold_the_hand_say_why() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [d.joint(f"q{k}", "prismatic") for k in range(3)]
    legs = [Stretch(joint, (k, 0, 0), on_hand=(k, 1, 0)) for k, joint in enumerate(q)]
    axes = [(1, 0, 0), (0, 1, 0), (Rational(3, 5), Rational(4, 5), 0)]
    with pytest.raises(ShapeError, match="share a direction"):
        guided(
            d, ThreePlanes(), [Hinged(leg, on_ground=n) for leg, n in zip(legs, axes, strict=True)]
        )
    with pytest.raises(ShapeError, match="has three legs Hinged on_ground"):
        guided(d, ThreePlanes(), legs)


def test_planes_in_one_direction_are_those_of_a_tripod(tmp_path: Path) -> None:
    head = (TESTS / "held_out_loops" / "three_spr.toml").read_text("utf-8")
    assert "ThreePlanes" not in script_of("head", head, tmp_path)
