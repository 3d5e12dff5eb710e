"""Legs with two motors, of which the second one moves a rod across the axis of the first.

A 3-PPRS mechanism has a cross table under each leg, a 3-PRRS mechanism a crank on a slider.  The
joints are those that Newton's method finds from the drawing.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of, unbroken
from places import TESTS

from closedform import Across, Along, Crank, Derivation, FreeAlong, Paper, Slide, Stretch, platform
from closedform.algebra.shapes import ShapeError

TABLES = (TESTS / "held_out_loops" / "three_pprs.toml").read_text("utf-8")
CRANKS = (
    TABLES.replace("table1", "crank1")
    .replace('B1 = ["b", 0, 0]', 'B1 = ["b + a", 0, 0]')
    .replace('at = "A1", kind = "prismatic", axis = [1, 0, 0]', 'at = "A1", axis = [0, 1, 0]')
    .replace("[bodies]", 'a = {value = "0.2", meaning = "crank"}\n[bodies]')
)
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
ASIDE = np.stack([-np.sin(ANGLES), np.cos(ANGLES), 0 * ANGLES], axis=1)
UP = np.array([0, 0, 1])


@pytest.fixture(scope="module", params=["tables", "cranks"])
def mechanism(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory):
    text, folder = {"tables": TABLES, "cranks": CRANKS}[request.param], tmp_path_factory.mktemp("m")
    assert len(text.splitlines()) < 40
    return request.param, derived(
        f"across_{request.param}",
        script_of(f"across_{request.param}", text, folder),
        folder,
        crosscheck=True,
    )


def rotation(r: np.ndarray) -> np.ndarray:
    K = np.cross(np.eye(3), r)
    return np.linalg.inv(np.eye(3) + K) @ (np.eye(3) - K)


def missed(kind: str, v, t: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how far rods miss the planes of their legs and their lengths."""
    ends = t[:3] + v.c * OUT @ rotation(t[3:]).T
    along, across = q[::2, None], q[1::2, None]
    if kind == "tables":
        near = (v.b + across) * OUT
    else:  # a positive angle about the axis of the slider turns the crank down
        near = v.b * OUT + v.a * (np.cos(across) * OUT - np.sin(across) * UP)
    rods = ends - near - along * ASIDE
    return np.array([*(rods * ASIDE).sum(axis=1), *(np.linalg.norm(rods, axis=1) - v.l)])


def pose(t: np.ndarray) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = rotation(t[3:]), t[:3]
    return T


def targets(rows: int) -> np.ndarray:
    around = np.random.default_rng(3).uniform(-0.05, 0.05, (rows, 6))
    return around + np.array([0, 0, 0.25, 0, 0, 0])


def test_newton_finds_no_joints_that_the_closed_form_lacks(mechanism) -> None:
    kind, m = mechanism
    rng, v = np.random.default_rng(1), m.Parameters()
    turns, met = np.array([False, kind == "cranks"] * 3), 0
    for t in targets(20):
        q, status = m.ik(pose(t))
        assert (status == OK).all() and q.shape == (8, 6)
        for row in q:
            assert np.abs(missed(kind, v, t, row)).max() < 1e-12
        for start in rng.uniform(-1, 1, (6, 6)):
            found = newton(lambda q: missed(kind, v, t, q), start)  # noqa: B023
            met += found is not None
            assert found is None or apart(q, found, turns).min() < 1e-9
    assert met > 60


def test_rates_are_those_of_the_drawing(mechanism) -> None:
    _, m = mechanism
    for t in targets(10):
        T = pose(t)
        twist = np.array([1, -2, 1, 2, 1, -1]) * 1e-6
        K = np.cross(np.eye(3), twist[3:])
        moved = T.copy()
        moved[:3, 3] += twist[:3]
        moved[:3, :3] = np.linalg.inv(np.eye(3) - K / 2) @ (np.eye(3) + K / 2) @ T[:3, :3]
        for k, q in enumerate(m.ik(T).q):
            rates = m.jacobian_inverse(T, q) @ twist
            assert np.allclose(m.ik(moved).q[k] - q, rates, atol=1e-9)
            A, B = m.jacobian_parallel(T, q), m.jacobian_serial(T, q)
            assert np.allclose(A @ twist, B * rates)
            assert np.isclose(m.singularities(T, q)[-1], np.linalg.det(A))


def test_the_hand_is_singular_where_its_rods_are_in_its_plane(mechanism) -> None:
    kind, m = mechanism
    T = np.eye(4)
    if kind == "tables":
        q, status = m.ik(T)
        assert (status == SINGULAR).all()
        assert all(abs(m.singularities(T, row)[-1]) < 1e-12 for row in q)
    T[2, 3] = 2
    assert (m.ik(T).status == UNREACHABLE).all()


def test_a_hinge_may_turn_about_the_second_slider(tmp_path: Path) -> None:
    """Then the second slider moves the leg along its axis, and the first one across it."""
    text = TABLES.replace("axis = [0, 1, 0], driven", "axis = [9], driven")
    text = text.replace("axis = [1, 0, 0], driven", "axis = [0, 1, 0], driven")
    script = unbroken(script_of("swapped", text.replace("[9]", "[1, 0, 0]"), tmp_path))
    assert script.index("Along(y1") < script.index("FreeAlong(Slide(x1") < script.index("Along(y2")
    plain = unbroken(script_of("plain", TABLES, tmp_path)).split("platform(")[1]
    assert script.split("platform(")[1].replace("x", "y") == plain.replace("x", "y")


def test_an_oblique_hinge_is_told_of(tmp_path: Path) -> None:
    text = TABLES.replace('at = "B1", axis = [0, 1, 0]', 'at = "B1", axis = [0, 1, 1]')
    with pytest.raises(ValueError, match="moves a rod across it by a slider or a crank"):
        script_of("oblique", text, tmp_path)


def test_legs_that_do_not_move_across_their_axis_are_refused() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    q = [d.joint(f"q{k}", "prismatic") for k in range(1, 7)]
    with pytest.raises(ShapeError, match="is a crank or a slide in space"):
        FreeAlong(Stretch(q[0], (0, 0, 0)), (0, 0, 1))
    with pytest.raises(ShapeError, match="at right angles to the plane in which q1 moves"):
        FreeAlong(Slide(q[0], 1, (0, 0, 0), (0, 0, 1)), (0, 0, 1))
    with pytest.raises(ShapeError, match="is a unit vector"):
        FreeAlong(Crank(q[0], 1, 1, (0, 0, 0), along=(1, 0, 0), across=(0, 1, 0)), (0, 0, 2))
    place = {"on_hand": (1, 0, 0)}
    legs = [Along(q[k], (0, 0, 0), (0, 0, 1), **place) for k in (0, 2, 4)]
    others = [Across(q[k], (0, 0, 0), (0, 0, 1), **place) for k in (1, 3)]
    others.append(FreeAlong(Slide(q[5], 1, (0, 0, 0), (0, 1, 0)), (1, 0, 0), **place))
    with pytest.raises(ShapeError, match="q5 and q6 have to have the same axis"):
        platform(d, [leg for pair in zip(legs, others, strict=True) for leg in pair])


def test_the_place_on_the_hand_may_be_that_of_the_leg() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    leg = Slide(d.joint("q1", "prismatic"), 1, (0, 0, 0), (1, 0, 0), on_hand=(1, 2, 3))
    assert FreeAlong(leg, (0, 0, 1)).on_hand == (1, 2, 3)
    assert isinstance(FreeAlong(leg, (0, 0, 1)).leg, Slide)
