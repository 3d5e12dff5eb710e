"""A hand on a universal joint that slides along a mast (swash plate, 3-UPS + PU)."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import Derivation, Hinged, Mast, Paper, Stretch, guided
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "swash_plate.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
UP = np.array([0, 0, 1])


@pytest.fixture(scope="module")
def plate(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("swash")
    return derived("swash", script_of("swash", TEXT, folder), folder, crosscheck=True)


def pose(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    (_, a, b), (_, u, v) = np.cos(x), np.sin(x)
    about_x = np.array([[1, 0, 0], [0, a, -u], [0, u, a]])
    return x[0] * UP, about_x @ np.array([[b, 0, v], [0, 1, 0], [-v, 0, b]])


def missed(v, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how far pushrods miss their lengths."""
    p, R = pose(x)
    horns = v.b * OUT + v.r * (np.cos(q)[:, None] * OUT - np.sin(q)[:, None] * UP)
    return np.linalg.norm(p + v.c * OUT @ R.T - horns, axis=1) - v.l


def targets(count: int) -> np.ndarray:
    around = np.random.default_rng(4).uniform(-1, 1, (count, 3)) * (0.01, 0.25, 0.25)
    return around + np.array([0.09, 0, 0])


def test_newton_finds_no_joints_that_the_closed_form_lacks(plate: ModuleType) -> None:
    rng, v, met = np.random.default_rng(1), plate.Parameters(), 0
    for x in targets(20):
        q, status = plate.ik(x)
        assert q.shape == (8, 3) and (status == OK).all()
        for row in q:
            assert np.abs(missed(v, x, row)).max() < 1e-14
        for start in rng.uniform(-3, 3, (8, 3)):
            found = newton(lambda q: missed(v, x, q), start)  # noqa: B023
            if found is not None:
                met += 1
                assert apart(q, found, np.array([True])).min() < 1e-9
        back = newton(lambda x: missed(v, x, q[0]), x + 1e-4)  # noqa: B023
        assert back is not None and np.allclose(back, x, atol=1e-9)
    assert met > 80


def test_pose_and_rates_are_those_of_the_drawing(plate: ModuleType) -> None:
    step = np.array([1e-7, 2e-7, -1e-7])
    for x in targets(20):
        T, (p, R) = plate.hand_pose(x), pose(x)
        assert np.allclose(T[:3, 3], p) and np.allclose(T[:3, :3], R)
        for k, q in enumerate(plate.ik(x).q):
            K, J = plate.jacobian_inverse(x, q), plate.jacobian(x, q)
            assert np.allclose(plate.ik(x + step).q[k] - q, K @ step, atol=1e-10)
            assert np.allclose(J @ K, np.eye(3), atol=1e-9)
            A, B = plate.jacobian_parallel(x, q), plate.jacobian_serial(x, q)
            assert np.allclose(A, np.diag(B) @ K)
            assert np.isclose(plate.singularities(x, q)[-1], np.linalg.det(A))


def test_rods_in_the_plane_of_the_plate_do_not_hold_it(plate: ModuleType) -> None:
    v = plate.Parameters(b=0.12, r=0.03)  # the rods are horizontal if the horns lie outwards
    q, status = plate.ik([0, 0, 0], v)
    flat = np.abs(q).max(axis=-1) < 1e-12
    assert flat.any() and (status[flat] == SINGULAR).all()
    assert (plate.ik([1, 0, 0]).status == UNREACHABLE).all()


def test_the_slide_may_be_named_at_another_point(tmp_path: Path) -> None:
    """The universal joint is where the sleeve has it, when the slide is at zero."""
    text = TEXT.replace("P = [0, 0, 0]}\nplate", 'P = [0, 0, "l"]}\nplate')
    assert text != TEXT and "Mast((0, 0, l), (1, 0, 0), (0, 1, 0), (0, 0, 1))" in script_of(
        "t", text, tmp_path
    )


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        (", second = [0, 1, 0]", "", "two axes at right angles, where the hand is not turned"),
        ("second = [0, 1, 0]", "second = [1, 1, 0]", "axis and second of u have to be at right"),
        (
            'kind = "universal", axis',
            'kind = "spherical", axis',
            "leave the hand four degrees of freedom, so four joints are driven, not q1, q2 and q3",
        ),
    ],
)
def test_other_joints_are_told_of(old: str, new: str, told: str, tmp_path: Path) -> None:
    text = TEXT.replace(old, new)
    if "spherical" in new:
        text = text.replace(", axis = [1, 0, 0], second = [0, 1, 0]", "")
    assert text != TEXT
    with pytest.raises(TableError, match=told):
        script_of("t", text, tmp_path)


def test_a_driven_slide_of_a_mast_is_told_of(tmp_path: Path) -> None:
    text = TEXT.replace('kind = "prismatic", axis', 'kind = "prismatic", driven = true, axis')
    assert text != TEXT
    with pytest.raises(TableError, match=r"m is the slide of a mast.* passive and one more leg"):
        script_of("t", text, tmp_path)


def test_what_is_no_mast_is_refused() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    legs = [
        Stretch(d.joint(f"q{k}", "prismatic"), (k, k**2, 0), on_hand=(k, 0, 1)) for k in (1, 2, 3)
    ]
    with pytest.raises(ShapeError, match="direction of a mast is a unit vector"):
        guided(d, Mast((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 2)), legs)
    with pytest.raises(ShapeError, match="must be two unit vectors at right angles"):
        guided(d, Mast((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0, 1)), legs)
    with pytest.raises(ShapeError, match="is not Hinged"):
        hinged = [Hinged(legs[0], on_ground=(0, 1, 0)), *legs[1:]]
        guided(d, Mast((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)), hinged)
