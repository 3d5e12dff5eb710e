"""Three legs hinged on the hand, a 3-SPR mechanism, against its drawing and Newton's method."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform import Derivation, Hinged, Paper, Slide, Stretch, ThreeHinges, guided
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "three_spr.toml").read_text("utf-8")
OK, SINGULAR = 0, 2
AXES = np.array([[0, 1, 0], [-1, 0, 0], [np.sqrt(0.5), -np.sqrt(0.5), 0]])


@pytest.fixture(scope="module")
def spr(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("three_spr")
    return derived("three_spr", script_of("three_spr", TEXT, folder), folder)


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    K = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def rotation(r: np.ndarray) -> np.ndarray:
    angle = np.linalg.norm(r)
    return about(r / angle, angle) if angle else np.eye(3)


def missed(spr: ModuleType, R: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how much the legs miss their lengths and their planes, as the drawing has it."""
    b, c, e = spr.Parameters()
    bases = np.array([[b, 0, e], [e, b, 0], [-b, -b, 0]])
    ends = np.array([[c, e, 0], [e, c, e], [e - c, e - c, e]])
    rods = p + ends @ R.T - bases
    return np.array([*(np.linalg.norm(rods, axis=1) - q), *(rods * (AXES @ R.T)).sum(axis=1)])


def targets(rows: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform((0.3, -1, -1), (0.8, 1, 1), (rows, 3))


def target(R: np.ndarray, p: np.ndarray) -> np.ndarray:
    x, y, z = R[:, 2]
    return np.array([p[2], np.arctan2(-y, np.hypot(x, z)), np.arctan2(x, z)])


def test_the_hand_is_where_its_hinges_let_it_be(spr: ModuleType) -> None:
    for x in targets(50, 1):
        T, (q, status) = spr.hand_pose(x), spr.ik(x)
        assert status == OK
        assert np.allclose(target(T[:3, :3], T[:3, 3]), x, atol=1e-13)
        assert np.abs(missed(spr, T[:3, :3], T[:3, 3], q[0])).max() < 1e-13
        rates = spr.jacobian_inverse(x, q[0])
        step = 1e-6 * np.array([1, -2, 1])
        assert np.allclose(
            spr.ik(x + step).q[0] - spr.ik(x - step).q[0], 2 * rates @ step, atol=1e-9
        )
        assert np.allclose(spr.jacobian(x, q[0]) @ rates, np.eye(3))
        assert np.isclose(spr.determinant(x, q[0]) * np.linalg.det(rates), 1)


def test_newton_finds_no_pose_but_those_turned_by_half_a_turn(spr: ModuleType) -> None:
    rng, found, turned = np.random.default_rng(2), 0, 0
    for x in targets(4, 3):
        (q,) = spr.ik(x).q
        for start in rng.uniform(-1, 1, (12, 6)) * [2, 2, 2, 0.5, 0.5, 0.9]:
            y = newton(lambda y: missed(spr, rotation(y[:3]), y[3:], q), start)  # noqa: B023
            if y is None:
                continue
            R, at = rotation(y[:3]), target(rotation(y[:3]), y[3:])
            T = spr.hand_pose(at)
            same = np.allclose(T[:3, :3], R, atol=1e-6)
            assert same or np.allclose(T[:3, :3] @ np.diag([-1, -1, 1]), R, atol=1e-6)
            if same:
                assert np.allclose(spr.ik(at).q[0], q, atol=1e-6)
            found, turned = found + same, turned + (not same)
    assert min(found, turned) > 5


def test_where_the_hinges_do_not_hold_the_hand(spr: ModuleType) -> None:
    assert spr.SINGULARITIES == ("leg 1", "leg 2", "leg 3", "all legs", "hinges", "twist")
    on_edge = np.array([0.5, np.pi / 2, 0.3])  # the planes of the legs are horizontal lines
    q, status = spr.ik(on_edge)
    assert status == SINGULAR
    assert abs(spr.singularities(on_edge, q[0])[4]) < 1e-15


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("axis = [0, 1, 0]", "axis = [0, 1, 1]", "c1 keeps the leg of q1 in a plane.*upright on"),
        ("axis = [0, 1, 0]", "axis = [1, 0, 0]", "c1, c2 and c3, have to have three directions"),
        ('C1 = ["c", "e", 0]', 'C1 = ["c", 0, 0]', "and to meet in a line of hand"),
    ],
)
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in TEXT
    with pytest.raises(TableError, match=message):
        script_of("three_spr", TEXT.replace(old, other), tmp_path)


def test_legs_that_do_not_fit_say_why() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [d.joint(f"q{k}", "prismatic") for k in (1, 2, 3)]
    out = [(1, 0, 0), (0, 1, 0), (-1, -1, 0)]
    across = [(0, 1, 0), (-1, 0, 0), (0, 1, 0)]
    legs = [
        Hinged(Stretch(j, e, on_hand=e), on_hand=a) for j, e, a in zip(q, out, across, strict=True)
    ]
    with pytest.raises(ShapeError, match="all three legs are Hinged, with an axis on_hand"):
        guided(d, ThreeHinges(), [*legs[:2], legs[2].leg])
    with pytest.raises(ShapeError, match="two hinges are parallel"):
        guided(d, ThreeHinges(), legs)
    with pytest.raises(ShapeError, match="has to be horizontal in the frame of the hand"):
        guided(d, ThreeHinges(), [*legs[:2], Hinged(legs[2].leg, on_hand=(0, 0, 1))])
    with pytest.raises(ShapeError, match="must be a Stretch"):
        slide = Slide(q[2], 1, out[2], (0, 0, 1), on_hand=out[2])
        guided(d, ThreeHinges(), [*legs[:2], Hinged(slide, on_hand=(0, 1, 0))])
