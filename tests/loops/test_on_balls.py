"""A hand whose arms slide through balls on parallel sliders (3-PSP), against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS
from sympy import Rational

from closedform import Derivation, Paper, ThroughBall, on_balls, prove
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "three_psp.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
WAYS = np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1)
BASE = 0.3


@pytest.fixture(scope="module")
def psp(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("psp")
    return derived("psp", script_of("psp", TEXT, folder), folder, crosscheck=True)


def turned(angles: np.ndarray) -> np.ndarray:
    """The hand at both tilts and a twist."""
    (a, b, c), (u, v, w) = np.cos(angles), np.sin(angles)
    x, y = (
        np.array([[1, 0, 0], [0, a, -u], [0, u, a]]),
        np.array([[b, 0, v], [0, 1, 0], [-v, 0, b]]),
    )
    return y @ x @ np.array([[c, -w, 0], [w, c, 0], [0, 0, 1]])


def off(q: np.ndarray, p: np.ndarray, R: np.ndarray) -> np.ndarray:
    """How far the balls are from the arms."""
    seen = (np.column_stack([BASE * WAYS, q]) - p) @ R
    return np.concatenate([seen[:, 2], WAYS[:, 0] * seen[:, 1] - WAYS[:, 1] * seen[:, 0]])


@pytest.mark.parametrize("up", [(-1, -1, -1), (1, -1, -1)])
def test_sliders_may_point_down(up: tuple[int, ...], tmp_path: Path) -> None:
    name = f"psp_{up.count(-1)}_down"
    script = script_of(name, TEXT.replace("[0, 0, 1]", "[0, 0, -1]"), tmp_path)
    assert script.count(", -1),") == 3
    script = script.replace(", -1),", "),", up.count(1))
    psp = derived(name, script, tmp_path, crosscheck=True)
    x = targets(1000, 5) * (1, 0.5, 0.5)
    q, status = psp.ik(x)
    q = q[:, 0]
    assert (status == OK).all()
    for target, joints in zip(x, q, strict=True):
        T = psp.hand_pose(target)
        assert np.abs(off(up * joints, T[:3, 3], T[:3, :3])).max() < 1e-14
    p, J, A = psp.fk(q).p[:, 0], psp.jacobian(q)[:, 0], psp.jacobian_parallel(q)[:, 0]
    assert np.abs(p - x).max() < 1e-12
    assert np.allclose(A @ J, np.eye(3), atol=1e-9)
    for k, step in enumerate(1e-6 * np.eye(3)):
        rate = (psp.fk(q + step).p - psp.fk(q - step).p)[:, 0] / 2e-6
        assert np.allclose(rate, J[:, :, k], atol=1e-6)
    assert np.allclose(psp.determinant(q)[:, 0], np.linalg.det(J), rtol=1e-8)


def targets(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * (1, 1.2, 1.2)


def test_both_problems_close_the_loop(psp: ModuleType) -> None:
    x = targets(100_000, 1)
    q, status = psp.ik(x)
    assert (status == OK).mean() > 0.999
    p, modes = psp.fk(q[:, 0])
    assert (modes == OK).mean() > 0.999
    assert np.abs(p[:, 0] - x).max() < 1e-12
    for target, joints in zip(x[:300], q[:300, 0], strict=True):
        T = psp.hand_pose(target)
        assert np.isclose(T[2, 3], target[0], atol=1e-15)
        assert np.abs(off(joints, T[:3, 3], T[:3, :3])).max() < 1e-14
        turn = turned(np.array([*target[1:], 0])).T @ T[:3, :3]
        assert np.allclose(turn[2], [0, 0, 1]) and turn[0, 0] > 0


def test_newton_finds_no_other_posture(psp: ModuleType) -> None:
    """Up to the half turn about the axis of the hand, which takes its arms to themselves."""
    rng, seen = np.random.default_rng(2), set()
    for q in psp.ik(targets(15, 3)).q[:, 0]:
        found = psp.fk(q).p
        axes = np.array([turned(np.array([*tilts, 0]))[:, 2] for _, *tilts in found])
        for start in rng.uniform(-1, 1, (15, 6)) * (0.5, 0.5, 1, 3, 3, 3):
            u = newton(lambda u: off(q, u[:3], turned(u[3:])), start)  # noqa: B023
            if u is not None:
                gaps = np.abs(axes - turned(u[3:])[:, 2]).max(axis=1) + np.abs(found[:, 0] - u[2])
                seen.add(int(gaps.argmin()))
                assert gaps.min() < 1e-6
    assert seen == {0, 1}


def test_derivatives(psp: ModuleType) -> None:
    q = psp.ik(targets(500, 4)).q[:, 0]
    rates = [(psp.fk(q + s).p - psp.fk(q - s).p) / 2e-6 for s in 1e-6 * np.eye(3)]
    J = psp.jacobian(q)
    tame = np.abs(J).max((-1, -2)) < 20
    assert tame.mean() > 0.9
    np.testing.assert_allclose(J[tame], np.stack(rates, -1)[tame], atol=1e-6)
    A = psp.jacobian_parallel(q)
    np.testing.assert_allclose((A @ J)[tame], np.broadcast_to(np.eye(3), A.shape)[tame], atol=1e-9)
    np.testing.assert_allclose(psp.determinant(q)[tame], np.linalg.det(J[tame]), rtol=1e-8)
    assert (psp.jacobian_serial(q) == 1).all()


def test_where_the_arms_do_not_fix_the_twist(psp: ModuleType) -> None:
    """A flat hand upside down can turn freely: its arms pass a triangle the other way round."""
    q, status = psp.ik([0.2, 0, np.pi])
    assert (status == SINGULAR).all() and np.allclose(q, 0.2)
    p, modes = psp.fk([0.2, 0.2, 0.2])
    assert modes.tolist() == [OK, SINGULAR] and np.allclose(p[0], [0.2, 0, 0])
    assert abs(psp.singularities([0.2, 0.2, 0.2])[1, 0]) < 1e-15


def test_a_steep_plane_is_out_of_reach(psp: ModuleType) -> None:
    assert (psp.fk([0, 0, 1e3]).status == UNREACHABLE).all()
    assert (psp.ik([0, np.pi / 2, 0]).status == UNREACHABLE).all()
    assert (psp.fk([0, 0, 100]).status == OK).all()


def legs(d: Derivation, places: list, ways: list) -> list[ThroughBall]:
    joints = [d.joint(f"q{k}", "prismatic") for k in range(3)]
    slides = [d.joint(f"s{k}", "prismatic", passive=True) for k in range(3)]
    return [ThroughBall(*leg) for leg in zip(joints, slides, places, ways, strict=True)]


def toy() -> Derivation:
    return Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Arms.")


def test_sliders_and_arms_of_any_directions_are_proved() -> None:
    d = toy()
    slanted = (Rational(3, 5), Rational(-4, 5))
    places = [(0, 0, 1), (2, 0, 0), (1, 3, Rational(1, 2))]
    on_balls(d, legs(d, places, [(1, 0), slanted, (0, 1)]))
    assert {i.function: i.solutions for i in prove(d).inverses} == {"fk": 2, "ik": 1}


def test_what_does_not_hold_the_hand_says_why() -> None:
    ways = [(1, 0), (0, 1), (Rational(3, 5), Rational(4, 5))]
    d = toy()
    with pytest.raises(ShapeError, match="the sliders are in one plane"):
        on_balls(d, legs(d, [(k, k, 0) for k in range(3)], ways))
    d = toy()
    with pytest.raises(ShapeError, match="two arms are parallel"):
        on_balls(d, legs(d, [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0), (0, 1), (-1, 0)]))


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("axis = [0, 0, 1], driven", "axis = [0, 1, 1], driven", "move along the z axis"),
        ("axis = [1, 0, 0]}", "axis = [1, 0, 1]}", "its axis has to be horizontal"),
        ('at = "P", kind', 'at = "E1", kind', "the three arms have to meet in P"),
        ("axis = [1, 0, 0]}", "axis = [1, 0, 0], driven = true}", "s1"),
    ],
)
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    text = TEXT.replace("star = {P = [0, 0, 0]}", 'star = {P = [0, 0, 0], E1 = [0, "b", 0]}')
    with pytest.raises(TableError, match=message):
        script_of("psp", text.replace(old, other), tmp_path)
