"""A hand that is an axis on five legs, a linear pentapod, against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform import Derivation, Hinged, Paper, Slide, Spindle, Stretch, guided, prove
from closedform.algebra.shapes import ShapeError

TEXT = (TESTS / "held_out_loops" / "pentapod.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def pentapod(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("pentapod")
    return derived("pentapod", script_of("pentapod", TEXT, folder), folder, crosscheck=True)


def lengths(v, x: np.ndarray) -> np.ndarray:
    """The lengths of the legs, from the place and the direction of the spindle."""
    b, (a, s) = v.b, x[3:]
    line = np.array([np.sin(s), -np.sin(a) * np.cos(s), np.cos(a) * np.cos(s)])
    bases = np.array([[b, 0, b], [0, b, b], [-b, 0, b], [0, -b, b], [b, b, 0]])
    return np.linalg.norm(x[:3] + v.c * np.arange(1, 6)[:, None] * line - bases, axis=1)


def targets(rows: int) -> np.ndarray:
    return np.random.default_rng(1).uniform(-0.4, 0.4, (rows, 5))


def test_joints_are_the_lengths_of_the_drawing(pentapod: ModuleType) -> None:
    v = pentapod.Parameters()
    for x in targets(50):
        [q], [status] = pentapod.ik(x)
        assert status == OK and np.allclose(q, lengths(v, x))
        back = newton(lambda x: lengths(v, x) - q, x + 1e-4)  # noqa: B023
        assert back is not None and np.allclose(back, x, atol=1e-6)
        T = pentapod.hand_pose(x)
        assert np.allclose(T[:3, 3], x[:3]) and np.allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3))


def test_rates_are_those_of_the_drawing(pentapod: ModuleType) -> None:
    v, step = pentapod.Parameters(), 1e-6 * np.eye(5)
    for x in targets(20):
        [q] = pentapod.ik(x).q
        rates = np.array([(lengths(v, x + s) - lengths(v, x - s)) / 2e-6 for s in step]).T
        assert np.allclose(pentapod.jacobian_inverse(x, q), rates, atol=1e-8)
        A = pentapod.jacobian_parallel(x, q)
        assert np.isclose(pentapod.singularities(x, q)[-1], np.linalg.det(A))
        assert np.allclose(pentapod.jacobian_serial(x, q), q)


def test_a_line_that_is_not_held_or_along_the_first_axis(pentapod: ModuleType) -> None:
    v = pentapod.Parameters()._replace(c=0.0)  # all legs end in one point
    assert (pentapod.ik(np.zeros(5), v).status == SINGULAR).all()
    along_x = [0.1, 0.2, 0.1, 0.3, np.pi / 2]  # the first axis, about which turn_1 turns nothing
    assert (pentapod.ik(along_x).status == SINGULAR).all()


def of(ends: list, kind=Stretch) -> Derivation:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    bases = [(1, 0, 1), (0, 1, 1), (-1, 0, 1), (0, -1, 1), (1, 1, 0)]
    joints = [d.joint(f"q{k}", "prismatic") for k in range(1, 6)]
    legs = [kind(q, at, end) for q, at, end in zip(joints, bases, ends, strict=True)]
    guided(d, Spindle((0, 0, 0), (1, 0, 0), (0, 1, 0)), legs)
    return d


def test_sliders_may_hold_it() -> None:
    def slide(q, at, end):
        return Slide(q, 3, at, (0, 0, 1), on_hand=end)

    d = of([(0, 0, k) for k in range(5)], slide)
    assert {i.function: i.solutions for i in prove(d).inverses} == {"ik": 32}


def test_legs_beside_the_line_are_refused() -> None:
    with pytest.raises(ShapeError, match="q5 has to end on the line of the hand"):
        of([(0, 0, 1), (0, 0, 2), (0, 0, 3), (0, 0, 4), (0, 1, 5)])
    with pytest.raises(ShapeError, match="is not Hinged"):
        of([(0, 0, k) for k in range(5)], lambda *leg: Hinged(Stretch(*leg), on_hand=(1, 0, 0)))
    with pytest.raises(ShapeError, match="five driven legs"):
        d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
        guided(d, Spindle((0, 0, 0), (1, 0, 0), (0, 1, 0)), [Stretch(d.joint("q"), (0, 0, 0))])


def test_a_line_may_have_any_direction(tmp_path: Path) -> None:
    text = TEXT
    for k in range(1, 6):
        text = text.replace(f'C{k} = [0, 0, "', f'C{k} = ["', 1)
    for k, length in enumerate(("c", "2*c", "3*c", "4*c", "5*c"), 1):
        text = text.replace(f'C{k} = ["{length}"]', f'C{k} = ["0.6*{length}", 0, "0.8*{length}"]')
    assert "Spindle((0, 0, 0), (0, 1, 0), " in script_of("pentapod", text, tmp_path)
