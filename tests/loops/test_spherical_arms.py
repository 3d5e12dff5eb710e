"""A spherical five-bar linkage by its axes, against the turns of its joints."""

from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform.plot.robot import Robot
from closedform.scaffold.inputs.tables import TableError

POINTER = (TESTS / "held_out_loops" / "spherical_five_bar_axes.toml").read_text("utf-8")
OBLIQUE = """
hand = "T"
[bodies]
ground = {C = [0.1, 0.2, 0.3]}
rod2 = {}
rod1 = {T = [0.1, 0.2, 0.5]}
arm2 = {E = [0.1, 0.392, 0.356]}
arm1 = {C = [0.1, 0.2, 0.3]}
[joints]
t = {between = ["rod1", "rod2"], at = "T", axis = [0, 0, -1]}
n = {between = ["arm2", "rod2"], at = "E", axis = [0, 0.96, 0.28]}
m = {between = ["arm1", "rod1"], at = "C", axis = [0.6, 0, 0.8]}
q1 = {between = ["ground", "arm1"], at = "C", axis = [1, 0, 0], driven = true}
q2 = {between = ["ground", "arm2"], at = "C", axis = [0.6, 0.8, 0], driven = true}
"""
"""Other arcs about another centre; joints are at points of their axes, and the rods come first."""
SIN, COS = np.sin(0.7), np.cos(0.7)
ARC = np.array([np.cos(0.8), np.sin(0.8)])
CASES = {
    "pointer": (
        POINTER,
        np.zeros(3),
        np.array([0, 0, -0.15]),
        np.array([[SIN, 0, -COS], [-SIN, 0, -COS]]),
        np.array([[s * SIN * ARC[0], ARC[1], -COS * ARC[0]] for s in (1, -1)]),
    ),
    "oblique": (
        OBLIQUE,
        np.array([0.1, 0.2, 0.3]),
        np.array([0, 0, 0.2]),
        np.array([[1, 0, 0], [0.6, 0.8, 0]]),
        np.array([[0.6, 0, 0.8], [0, 0.96, 0.28]]),
    ),
}
OK, UNREACHABLE, SINGULAR = range(3)


def turned(axis: np.ndarray, angle: float, v: np.ndarray) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    return c * v + s * np.cross(axis, v) + (1 - c) * axis * (axis @ v)


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    name, folder = f"spherical_{request.param}", tmp_path_factory.mktemp("spherical")
    toml, *drawing = CASES[request.param]
    return derived(name, script_of(name, toml, folder), folder, crosscheck=True), *drawing


def test_newton_on_the_turns_of_the_joints_finds_the_same(case: tuple) -> None:
    """Each rod turns about its elbow, and the tips of both rods meet in the hand."""
    robot, centre, tip, axes, elbows = case
    rng, modes, answers = np.random.default_rng(5), set(), set()

    def ends(q: np.ndarray, elbow: np.ndarray) -> list[np.ndarray]:
        return [
            turned(a, x, turned(e, y, tip))
            for a, e, x, y in zip(axes, elbows, q, elbow, strict=True)
        ]

    for q in rng.uniform(-1, 1, (15, 2)):
        fk = robot.fk(q)
        for start in rng.uniform(-3, 3, (12, 2)):
            elbow = newton(lambda u: np.subtract(*ends(q, u)), start)  # noqa: B023
            if elbow is None:
                continue
            hand = centre + ends(q, elbow)[0]
            away = np.linalg.norm(fk.p - hand, axis=-1)
            assert np.nanmin(away) < 1e-7
            modes.add(int(np.nanargmin(away)))
            ik = robot.ik(hand)
            for first in rng.uniform(-3, 3, (4, 4)):
                u = newton(
                    lambda u: np.ravel([e - hand + centre for e in ends(u[:2], u[2:])]),  # noqa: B023
                    first,
                )
                if u is not None:
                    gaps = np.abs(np.exp(1j * ik.q) - np.exp(1j * u[:2])).max(-1)
                    assert np.nanmin(gaps) < 1e-6
                    answers.add(int(np.nanargmin(gaps)))
    assert modes == {0, 1} and answers == set(range(4))


def test_no_posture_is_lost(case: tuple) -> None:
    robot, centre, tip, *_ = case
    q = np.random.default_rng(6).uniform(-np.pi, np.pi, (20_000, 2))
    p, status = robot.fk(q)
    reached = p[status == OK]
    assert np.allclose(np.linalg.norm(reached - centre, axis=-1), np.linalg.norm(tip))
    back = robot.ik(reached)
    assert np.isin(back.status, (OK, SINGULAR)).any(axis=1).all()
    again = robot.fk(back.q)
    there = np.linalg.norm(again.p - reached[:, None, None], axis=-1)
    assert np.nanmin(there, axis=-1)[back.status == OK].max() < 1e-12


@pytest.mark.filterwarnings("error")
def test_it_is_drawn_in_a_posture_that_closes(case: tuple) -> None:
    robot, *_ = case
    assert OK in robot.fk(Robot.of(robot).posture()).status


def test_a_joint_is_anywhere_on_its_axis(tmp_path: Path) -> None:
    plain = OBLIQUE.replace('at = "T"', 'at = "C"').replace('at = "E"', 'at = "C"')
    assert script_of("t", plain, tmp_path) == script_of("t", OBLIQUE, tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("T = [0.1, 0.2, 0.5]", "T = [0.1, 0.3, 0.5]", "on the axis of t between rod1 and rod2"),
        ("T = [0.1, 0.2, 0.5]", "T = [0.1, 0.2, 0.3]", "and not C itself"),
        ("rod2 = {}", "rod2 = {T = [0.1, 0.2, 0.4]}", "T has different coordinates on rod1 and"),
        ('hand = "T"', 'hand = "C"', "the hand is a point of a rod, on the axis between both rods"),
        ('hand = "T"', 'hand = "E"', "the hand is a point of a rod, on the axis between both rods"),
        ("axis = [0.6, 0, 0.8]", "axis = [1, 0, 0]", "m and q1, the joints of arm1, have parallel"),
        ("axis = [0.6, 0, 0.8]", "axis = [0, 0, 1]", "t and m, the joints of rod1, have parallel"),
    ],
)
def test_a_file_that_does_not_fit_says_why(old: str, new: str, told: str, tmp_path: Path) -> None:
    text = OBLIQUE.replace('at = "T"', 'at = "C"').replace(old, new)
    assert old in OBLIQUE
    with pytest.raises(TableError, match=told):
        script_of("t", text, tmp_path)


def test_the_centre_need_not_be_a_point_of_the_file(tmp_path: Path) -> None:
    """The motors are at points of their axes, which meet elsewhere."""
    away = OBLIQUE.replace(
        "ground = {C = [0.1, 0.2, 0.3]}", "ground = {A = [1.1, 0.2, 0.3], B = [0.7, 1, 0.3]}"
    )
    away = away.replace('"arm1"], at = "C"', '"arm1"], at = "A"')
    away = away.replace('"arm2"], at = "C"', '"arm2"], at = "B"')
    script = script_of("t", away, tmp_path)
    assert script.replace("meet in O", "meet in C") == script_of("t", OBLIQUE, tmp_path)
