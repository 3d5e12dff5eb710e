"""A hand on a ball joint that slides along a mast (4-SPS/PS), against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of, unbroken
from places import TESTS
from test_degrees import counted, free, in_plane_of_ground

from closedform import BallOnMast, prove
from closedform.emit.pages import pages
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "ball_on_mast.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def mast(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("ball_on_mast")
    return derived("ball_on_mast", script_of("ball_on_mast", TEXT, folder), folder, crosscheck=True)


def turn(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rodrigues' formula."""
    K = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def lengths(v, x: np.ndarray) -> np.ndarray:
    """The hand is turned about axes that stand still, in the reverse order."""
    R = turn(np.eye(3)[2], x[3])
    R = turn(np.eye(3)[0], x[1]) @ turn(np.eye(3)[1], x[2]) @ R
    b, c, e = v.b, v.c, v.e
    bases = np.array([[b, 0, 0], [0, b, 0], [-b, 0, 0], [0, -b, 0]])
    ends = np.array([[c, e, 0], [0, c, e], [-c, e, 0], [0, -c, 0]])
    return np.linalg.norm([0, 0, x[0]] + ends @ R.T - bases, axis=1)


def targets(count: int) -> np.ndarray:
    return np.random.default_rng(5).uniform(-1, 1, (count, 4)) * (0.2, 1, 1, 3) + (0.5, 0, 0, 0)


def test_joints_are_the_lengths_of_the_drawing(mast: ModuleType) -> None:
    v = mast.Parameters()
    assert np.count_nonzero(mast.ik(targets(50)).status == OK) > 45
    for x in targets(50):
        [q], [status] = mast.ik(x)
        assert np.allclose(q, lengths(v, x))
        back = newton(lambda x: lengths(v, x) - q, x + 1e-5)  # noqa: B023
        assert status == SINGULAR or np.allclose(back, x, atol=1e-6)
        T = mast.hand_pose(x)
        assert np.allclose(T[:3, 3], [0, 0, x[0]]) and np.isclose(np.linalg.det(T[:3, :3]), 1)


def test_rates_are_those_of_the_drawing(mast: ModuleType) -> None:
    v, step = mast.Parameters(), 1e-6 * np.eye(4)
    for x in targets(20):
        [q] = mast.ik(x).q
        rates = np.array([(lengths(v, x + s) - lengths(v, x - s)) / 2e-6 for s in step]).T
        assert np.allclose(mast.jacobian_inverse(x, q), rates, atol=1e-8)
        assert np.allclose(mast.jacobian(x, q) @ rates, np.eye(4), atol=1e-6)
        A = mast.jacobian_parallel(x, q)
        assert np.isclose(mast.singularities(x, q)[-1], np.linalg.det(A))


def test_legs_that_do_not_hold_the_hand_and_turns_about_one_axis(mast: ModuleType) -> None:
    v = mast.Parameters()._replace(c=0.0, e=0.0)  # all legs end in the ball
    assert (mast.ik([0.5, 0.1, 0.2, 0.3], v).status == SINGULAR).all()
    assert (mast.ik([0.5, 0.1, np.pi / 2, 0.3]).status == SINGULAR).all()


def test_the_ends_of_rods_have_letters_of_their_own(tmp_path: Path) -> None:
    """The parameter e was the far end of a rod too."""
    d = read_script(script_of("ball_on_mast", TEXT, tmp_path))
    (article,) = pages(d, prove(d), ["latex"]).files.values()
    assert "far end is $c_{i}$" in article and "far end is $e$" not in article
    assert "far end of rod $i$, in the frame of the hand" in article


def test_the_degree_is_counted() -> None:
    def on_mast(rng: np.random.Generator) -> list:
        return [in_plane_of_ground(normal, np.zeros(3), np.zeros(3)) for normal in np.eye(3)[:2]]

    assert BallOnMast.degree == counted(on_mast, free, free, free, free)


def test_a_mast_may_have_any_direction(tmp_path: Path) -> None:
    text = TEXT.replace("axis = [0, 0, 1]", "axis = [0, 3, 4]")
    assert "BallOnMast((0, 0, 0), (1, 0, 0)" in unbroken(script_of("m", text, tmp_path))
    with pytest.raises(TableError, match="give m its axis, in numbers"):
        script_of("m", TEXT.replace(", axis = [0, 0, 1]", ""), tmp_path)
