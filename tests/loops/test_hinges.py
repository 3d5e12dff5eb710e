"""Hands on hinged legs against their drawings: Exechon heads, and a hand on hinged sliders."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform import (
    Derivation,
    Hinged,
    Paper,
    Slide,
    StandingPlane,
    Stretch,
    TurningPlane,
    TwoHinges,
    guided,
)
from closedform.algebra.shapes import ShapeError
from closedform.check.finding import module_backend
from closedform.check.values import check_forward
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
EXECHON, PRS_AND_UPS = (
    (FOLDER / f"{n}.toml").read_text("utf-8") for n in ("exechon", "prs_and_ups")
)
RPS = EXECHON.replace(
    'a3 = {between = ["ground", "tube3"], at = "A3", kind = "spherical"}',
    'a3 = {between = ["ground", "tube3"], at = "A3", axis = [1, 0, 0]}',
).replace(
    'c3 = {between = ["piston3", "platform"], at = "C3", axis = [1, 0, 0]}',
    'c3 = {between = ["piston3", "platform"], at = "C3", kind = "spherical"}',
).replace('C3 = [0, "e", 0]', 'C3 = [0, "e", "-e"]')  # fmt: skip
RPU = EXECHON
for k in "12":
    RPU = RPU.replace(
        f'at = "A{k}", kind = "universal", axis = [1, 0, 0]', f'at = "A{k}", axis = [0, 1, 0]'
    ).replace(
        f'at = "C{k}", axis = [0, 1, 0]', f'at = "C{k}", kind = "universal", axis = [1, 0, 0]'
    )
FILES = {"exechon": EXECHON, "rps": RPS, "rpu": RPU, "prs_and_ups": PRS_AND_UPS}
OK, UNREACHABLE, SINGULAR = range(3)
X, Y, Z = np.eye(3)


@pytest.fixture(scope="module", params=FILES)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    name, folder = request.param, tmp_path_factory.mktemp(request.param)
    return derived(name, script_of(name, FILES[name], folder), folder, crosscheck=name == "exechon")


def name_of(robot: ModuleType) -> str:
    return robot.__name__.split(".")[-1]


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    K = np.cross(np.eye(3), axis)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def rotation(r: np.ndarray) -> np.ndarray:
    angle = np.linalg.norm(r)
    return about(r / angle, angle) if angle else np.eye(3)


def missed(robot: ModuleType, R: np.ndarray, p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how much the legs miss their lengths and their planes, as the drawing has it."""
    v, name = robot.Parameters(), name_of(robot)
    if name == "prs_and_ups":
        ends = v.c * np.array([X, Y, -X, -Y]) + v.h * np.array([0 * X, 0 * X, Y + Z, Z])
        bases = v.b * np.array([X, Y, -X, -Y])
        rods = p + ends @ R.T - bases
        rods[:2] -= np.outer(q[:2], Z)
        lengths = np.linalg.norm(rods, axis=1) - [v.l, v.l, *q[2:]]
        return np.array([*lengths, rods[0] @ Y, rods[1] @ X])
    ends = np.array([v.c * X, -v.c * X, v.e * Y - (v.e * Z if name == "rps" else 0)])
    rods = p + ends @ R.T - [v.a * X, -v.a * X, v.b * Y]
    third = rods[2] @ (X if name == "rps" else R @ X)
    plane = [Y @ R @ X, rods[0] @ Y] if name == "rpu" else [X @ R @ Y, rods[0] @ R @ Y]
    return np.array([*(np.linalg.norm(rods, axis=1) - q), *plane, third])


def target(robot: ModuleType, R: np.ndarray, p: np.ndarray) -> np.ndarray:
    """The coordinates of a pose, as the docstring of the mechanism has them."""
    if name_of(robot) == "prs_and_ups":
        up = R[:, 2]  # R_y R_x takes z there
        a, b = np.arctan2(-up[1], np.hypot(up[0], up[2])), np.arctan2(up[0], up[2])
        twisted = (about(Y, b) @ about(X, a)).T @ R
        return np.array([p[2], a, b, np.arctan2(twisted[1, 0], twisted[0, 0])])
    if name_of(robot) == "rpu":
        turn = np.arctan2(-R[2, 0], R[0, 0])
        level = about(Y, turn).T @ R
        return np.array([-p[2], turn, np.arctan2(level[2, 1], level[1, 1])])
    normal = R @ Y
    turn = np.arctan2(normal[2], normal[1])
    level = about(X, turn).T @ R
    return np.array([p @ about(X, turn) @ Z, turn, np.arctan2(level[0, 2], level[0, 0])])


def targets(robot: ModuleType, rows: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    if name_of(robot) == "prs_and_ups":
        return rng.uniform((0.2, -0.4, -0.4, -0.4), (0.7, 0.4, 0.4, 0.4), (rows, 4))
    return rng.uniform((0.3, -0.6, -0.6), (0.8, 0.6, 0.6), (rows, 3))


def test_the_hand_is_where_its_hinges_let_it_be(robot: ModuleType) -> None:
    count = 0
    for x in targets(robot, 100, 1):
        T, answers = robot.hand_pose(x), robot.ik(x)
        assert np.allclose(target(robot, T[:3, :3], T[:3, 3]), x, atol=1e-13)
        for q in answers.q[answers.status != UNREACHABLE]:
            assert np.abs(missed(robot, T[:3, :3], T[:3, 3], q)).max() < 1e-14
            count += 1
    assert count > 50


def test_newton_finds_no_pose_that_the_closed_form_lacks(robot: ModuleType) -> None:
    """From joints, all poses of the hand: their joints are among those of the inverse."""
    rng, found = np.random.default_rng(2), set()
    for k, x in enumerate(targets(robot, 6, 3)):
        for q in robot.ik(x).q[:1]:
            if np.isnan(q).any():
                continue
            for start in rng.uniform(-1, 1, (12, 6)) * [2, 2, 2, 0.5, 0.5, 0.8]:
                y = newton(lambda y: missed(robot, rotation(y[:3]), y[3:], q), start)  # noqa: B023
                if y is None:
                    continue
                R, p = rotation(y[:3]), y[3:]
                there = target(robot, R, p)
                T = robot.hand_pose(there)
                assert np.allclose(T[:3, :3], R, atol=1e-8)
                assert np.allclose(T[:3, 3], p, atol=1e-6)
                assert np.nanmin(np.abs(robot.ik(there).q - q).max(-1)) < 1e-6
                found.add((k, *np.round(there, 4)))
    assert len(found) > 12


def test_only_a_matrix_is_told_to_be_a_rotation(robot: ModuleType) -> None:
    """It was said of a height, two tilts and a twist."""
    assert "proper rotation" not in (robot.ik.__doc__ or "")


def test_the_jacobians_are_differences(robot: ModuleType) -> None:
    h, well = 1e-6, 0
    for x in targets(robot, 20, 5):
        q, status = robot.ik(x)
        for k in np.flatnonzero(status == OK):
            if np.abs(robot.singularities(x, q[k])).min() < 1e-3:
                continue
            ends = [
                (robot.ik(x + s).q[k] - robot.ik(x - s).q[k]) / (2 * h) for s in h * np.eye(len(x))
            ]
            K = robot.jacobian_inverse(x, q[k])
            assert np.allclose(np.array(ends).T, K, rtol=1e-5, atol=1e-5)
            J, A = robot.jacobian(x, q[k]), robot.jacobian_parallel(x, q[k])
            assert np.allclose(A @ J, np.diag(robot.jacobian_serial(x, q[k])), atol=1e-9)
            assert np.isclose(robot.determinant(x, q[k]), np.linalg.det(J), rtol=1e-6)
            well += 1
    assert well > 10


def test_the_hinges_of_an_exechon_hold_nothing_at_a_right_angle(robot: ModuleType) -> None:
    status = robot.ik([0.5, 0.2, np.pi / 2, 0.1][: len(robot.TASK)]).status
    assert (status == SINGULAR).all() == (name_of(robot) == "exechon") or status[0] == UNREACHABLE
    assert ("hinges" in robot.SINGULARITIES) == (name_of(robot) in ("exechon", "rpu"))


def test_the_skeleton_is_the_drawing_and_nearest_follows_it(robot: ModuleType) -> None:
    x = targets(robot, 1, 7)[0]
    answers = robot.ik(x)
    q = answers.q[answers.status == OK][0]
    T = robot.hand_pose(x)
    points = dict(zip(robot.SKELETON.points, robot.skeleton(x, q), strict=True))
    assert np.allclose(points["P"], T[:3, 3])
    assert set(robot.SKELETON.joints) == set(robot.JOINTS)
    assert np.allclose(Robot(robot).nearest(x, q).q, q)


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('axis = [1, 0, 0]}\na2', 'axis = [0, 0, 1]}\na2', "a1 and a2 need parallel axes"),
        ('at = "C3", axis = [1, 0, 0]', 'at = "C3", kind = "spherical"',
         "leave the hand four degrees of freedom, so four joints are driven, not 3"),
        ('kind = "universal", axis = [1, 0, 0]', 'axis = [1, 0, 0]',
         "hinge of the leg of q3 leaves the hand five degrees of freedom; this is supported for"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in EXECHON
    with pytest.raises(TableError, match=message):
        script_of("exechon", EXECHON.replace(old, other), tmp_path)


def test_a_hinge_on_the_hand_beside_a_ball_joint_that_moves_is_refused(tmp_path: Path) -> None:
    """As on a 3-RSR mechanism whose hand is not the mirror image of the ground."""
    text = """
hand = "P"
copies = 3
[bodies]
ground = {A1 = [0.1, 0, 0]}
arm1 = {B1 = [0.3, 0, 0]}
far1 = {length = 0.25}
top = {P = [0, 0, 0], C1 = [0.1, 0, 0]}
[joints]
q1 = {between = ["ground", "arm1"], at = "A1", axis = [0, 1, 0], driven = true}
b1 = {between = ["arm1", "far1"], at = "B1", kind = "spherical"}
c1 = {between = ["far1", "top"], at = "C1", axis = [0, 1, 0]}
"""
    with pytest.raises(TableError, match="q1 moves the ball joint b1 of the same rod"):
        script_of("wrist", text, tmp_path)


def toy() -> tuple[Derivation, list]:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    return d, [d.joint(f"q{k}", "prismatic") for k in (1, 2, 3, 4)]


def test_legs_that_do_not_fit_say_why() -> None:
    d, q = toy()
    o, x, y, z = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    plane = TurningPlane(o, x, y)
    free = [Stretch(j, e, on_hand=e) for j, e in zip(q, (x, y, z, (1, 1, 0)), strict=True)]
    inside = Hinged(free[0], on_hand=y)
    with pytest.raises(ShapeError, match="no leg keeps the hand in the plane"):
        guided(d, plane, free)
    with pytest.raises(ShapeError, match="a leg in the plane has to begin on its axis"):
        guided(d, plane, [inside, Hinged(free[1], on_hand=y), *free[2:]])
    with pytest.raises(ShapeError, match="one axis, on_ground or on_hand"):
        guided(d, plane, [inside, Hinged(free[1]), *free[2:]])
    with pytest.raises(ShapeError, match="must be a unit vector"):
        guided(d, plane, [inside, Hinged(free[1], on_hand=(1, 1, 0)), *free[2:]])
    with pytest.raises(ShapeError, match="at most one more leg is Hinged, not 2"):
        guided(d, plane, [inside, *(Hinged(leg, on_ground=x) for leg in free[1:3]), free[3]])
    with pytest.raises(ShapeError, match="has three driven legs"):
        guided(d, plane, [inside, Hinged(free[1], on_ground=x), *free[2:]])
    with pytest.raises(ShapeError, match="two legs are Hinged, not 1"):
        guided(d, TwoHinges(), [Hinged(free[0], on_ground=y), *free[1:]])
    with pytest.raises(ShapeError, match="meet in a horizontal line"):
        guided(d, TwoHinges(), [*(Hinged(leg, on_ground=y) for leg in free[:2]), *free[2:]])
    slide = Slide(q[1], 1, o, x, on_hand=x)
    with pytest.raises(ShapeError, match="must be a Stretch"):
        guided(d, plane, [inside, Hinged(slide, on_hand=x), *free[2:]])
    with pytest.raises(ShapeError, match="q2 moves the leg out of the plane"):
        guided(d, plane, [inside, Hinged(slide, on_ground=x), *free[2:]])


def test_legs_that_do_not_keep_the_hand_in_a_standing_plane_say_why() -> None:
    d, q = toy()
    o, x, y, z = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    plane = StandingPlane(o, y, x)
    free = [Stretch(j, e, on_hand=e) for j, e in zip(q, (x, y, z, (1, 1, 0)), strict=True)]
    with pytest.raises(ShapeError, match="no leg keeps the hand in the plane"):
        guided(d, plane, free)
    with pytest.raises(ShapeError, match="the legs in the plane have to begin in it"):
        guided(d, plane, [Hinged(Stretch(q[0], y, on_hand=x), on_ground=y), *free[1:]])
    inside = Hinged(free[0], on_ground=y)
    with pytest.raises(ShapeError, match="the hinge of q3 does not fix the place"):
        guided(d, plane, [inside, free[1], Hinged(free[2], on_ground=z)])


def test_a_single_leg_keeps_the_hand_in_the_plane() -> None:
    """One leg with a universal joint, and three cylinders: the plane has any direction."""
    d, q = toy()
    o, y, z = (0, 0, 0), (0, 1, 0), (0, 0, 1)
    ends = (1, 1, 0), (-1, 1, 0), (0, 1, -1)
    legs = [Stretch(j, e, on_hand=e) for j, e in zip(q[1:], ends, strict=True)]
    guided(d, TurningPlane(o, z, y), [Hinged(Stretch(q[0], o, on_hand=z), on_hand=y), *legs])
    assert d.task == ["along", "distance", "turn_1", "turn_2"]


def test_the_words_of_a_file_say_what_hinges_do(tmp_path: Path) -> None:
    d = read_script(script_of("exechon", EXECHON, tmp_path))
    assert "The legs of q1 and q2 keep the hand in a plane that turns." in d.mechanism
    assert any("an equation of degree 16" in step.title for step in d.steps)


def test_rates_are_infinite_only_where_a_divisor_may_cancel(
    robot: ModuleType, tmp_path: Path
) -> None:
    """The cross-check forgives this, and no other infinite value."""
    name = name_of(robot)
    if name != "prs_and_ups":
        pytest.skip("one of them is enough")
    d = read_script(script_of(name, FILES[name], tmp_path))
    backend = module_backend("numpy", robot)
    assert not check_forward(d, d["jacobian_inverse"], backend).failures
    wrong = replace(backend, function=lambda _: lambda x, *_: np.full((len(x), 4, 4), np.inf))
    assert check_forward(d, d["jacobian_inverse"], wrong).failures


PRU_UPR = """
hand = "P"
[bodies]
ground = {A1 = [0.3, 0, 0], A2 = [-0.3, 0, 0], A3 = [0, 0.3, 0]}
slider1 = {A1 = [0.3, 0, 0]}
slider2 = {A2 = [-0.3, 0, 0]}
rod1 = {length = 0.4}
rod2 = {length = 0.4}
tube = {}
piston = {}
hand = {P = [0, 0, 0], C1 = [0.1, 0, 0], C2 = [-0.1, 0, 0], C3 = [0, 0.1, 0]}
[joints]
q1 = {between = ["ground", "slider1"], at = "A1", kind = "prismatic", axis = [0, 0, 1], driven = true}
q2 = {between = ["ground", "slider2"], at = "A2", kind = "prismatic", axis = [0, 0, 1], driven = true}
q3 = {between = ["tube", "piston"], at = "A3", kind = "prismatic", driven = true}
a1 = {between = ["slider1", "rod1"], at = "A1", axis = [0, 1, 0]}
a2 = {between = ["slider2", "rod2"], at = "A2", axis = [0, 1, 0]}
a3 = {between = ["ground", "tube"], at = "A3", kind = "universal", axis = [0, 1, 0]}
c1 = {between = ["rod1", "hand"], at = "C1", kind = "universal", axis = [1, 0, 0]}
c2 = {between = ["rod2", "hand"], at = "C2", kind = "universal", axis = [1, 0, 0]}
c3 = {between = ["piston", "hand"], at = "C3", axis = [1, 0, 0]}
"""  # noqa: E501


UPR_RPU = """
hand = "P"
[bodies]
ground = {A1 = [0.3, 0, 0], A2 = [-0.3, 0, 0], A3 = [0, 0.3, 0]}
tube1 = {}
tube2 = {}
tube3 = {}
piston1 = {}
piston2 = {}
piston3 = {}
hand = {P = [0, 0, 0], C1 = [0.1, 0, 0], C2 = [-0.1, 0, 0], C3 = [0, 0.1, 0]}
[joints]
q1 = {between = ["tube1", "piston1"], at = "A1", kind = "prismatic", driven = true}
q2 = {between = ["tube2", "piston2"], at = "A2", kind = "prismatic", driven = true}
q3 = {between = ["tube3", "piston3"], at = "A3", kind = "prismatic", driven = true}
a1 = {between = ["ground", "tube1"], at = "A1", kind = "universal", axis = [1, 0, 0]}
a2 = {between = ["ground", "tube2"], at = "A2", kind = "universal", axis = [1, 0, 0]}
a3 = {between = ["ground", "tube3"], at = "A3", axis = [1, 0, 0]}
c1 = {between = ["piston1", "hand"], at = "C1", axis = [0, 1, 0]}
c2 = {between = ["piston2", "hand"], at = "C2", axis = [0, 1, 0]}
c3 = {between = ["piston3", "hand"], at = "C3", kind = "universal", axis = [0, 1, 0]}
"""
Vectors = tuple[np.ndarray, np.ndarray]


def pru_upr(q: np.ndarray, p: np.ndarray, R: np.ndarray) -> tuple[list[float], list[float]]:
    """What the legs leave open, and the target of a pose."""
    rods = p + 0.1 * np.array([R[:, 0], -R[:, 0], R[:, 1]])
    rods -= [[0.3, 0, q[0]], [-0.3, 0, q[1]], [0, 0.3, 0]]
    gaps = np.linalg.norm(rods, axis=1) - [0.4, 0.4, q[2]]
    turns = np.arctan2(-R[2, 0], R[0, 0]), np.arctan2(-R[1, 2], R[1, 1])
    return [*gaps, rods[0, 1], rods[1, 1], rods[2] @ R[:, 0]], [-p[2], *turns]


def upr_rpu(q: np.ndarray, p: np.ndarray, R: np.ndarray) -> tuple[list[float], list[float]]:
    rods = p + 0.1 * np.array([R[:, 0], -R[:, 0], R[:, 1]])
    rods -= [[0.3, 0, 0], [-0.3, 0, 0], [0, 0.3, 0]]
    gaps = np.linalg.norm(rods, axis=1) - q
    turn = np.arctan2(R[2, 1], R[1, 1])
    ahead = p[2] * np.cos(turn) - p[1] * np.sin(turn)
    target = [ahead, turn, np.arctan2(R[0, 2], R[0, 0])]
    return [*gaps, rods[0] @ R[:, 1], rods[1] @ R[:, 1], rods[2, 0]], target


@pytest.mark.parametrize(("text", "seen"), [(PRU_UPR, pru_upr), (UPR_RPU, upr_rpu)])
def test_a_leg_with_the_axes_of_the_plane_is_hinged(
    text: str, seen: Callable, tmp_path: Path
) -> None:
    """2-PRU + UPR and 2-UPR + RPU, against Newton's method on what each leg leaves the hand."""
    m = derived(seen.__name__, script_of(seen.__name__, text, tmp_path), tmp_path)
    rng, found = np.random.default_rng(6), 0

    def pose(u: np.ndarray) -> Vectors:
        angle, K = np.linalg.norm(u[3:]), np.cross(np.eye(3), u[3:] / np.linalg.norm(u[3:]))
        return u[:3], np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K

    for q in rng.uniform(0.1, 0.4, (12, 3)) + (0.2 if seen is upr_rpu else 0):
        for start in rng.normal(0, 1, (8, 6)) * (0.3, 0.1, 0.5, 1, 1, 1):
            u = newton(lambda u: np.array(seen(q, *pose(u))[0]), start)  # noqa: B023
            if u is None:
                continue
            (p, R), (_, x) = pose(u), seen(q, *pose(u))
            T = m.hand_pose(x)
            assert np.allclose(T[:3, :3], R, atol=1e-6) and np.allclose(T[:3, 3], p, atol=1e-6)
            assert np.nanmin(np.abs(m.ik(x).q - q).max(axis=-1)) < 1e-6
            found += 1
    assert found > 30
