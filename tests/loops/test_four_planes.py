"""A hand that turns about z in four planes: a Quadrupteron, and one with oblique axes."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, read_script, script_of
from places import TESTS

from closedform import Derivation, Paper, Plane, platform
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

QUADRUPTERON = (TESTS / "held_out_loops" / "quadrupteron.toml").read_text("utf-8")
OBLIQUE = """
from sympy import Rational
from closedform import Derivation, Paper, Plane, platform
d = Derivation("oblique", "Oblique", Paper("toy", "Toys", ("A. Nonymous",)), "Four legs.")
l, c = (d.parameter(n, value=v, unit="m", meaning=n) for n, v in (("l", 2), ("c", 1)))
q = [d.joint(f"q{k}", "prismatic") for k in (1, 2, 3, 4)]
a, b = Rational(3, 5), Rational(4, 5)
x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
platform(d, [
    Plane(q[0], (l, l), (0, 0, 0), x, (a, b, 0), on_hand=(c, c, 0)),
    Plane(q[1], (l, l), (0, c, 0), y, (0, a, b), on_hand=(0, -c, c)),
    Plane(q[2], (l, l), (0, 0, c), z, (b, 0, a), on_hand=(-c, 0, 0)),
    Plane(q[3], (l, l), (c, 0, 0), x, (a, b, 0), on_hand=(-c, c / 2, 0)),
])
"""
OK, UNREACHABLE, SINGULAR = range(3)
TURNS = [False, False, False, True]
X, Y, Z = np.eye(3)


@pytest.fixture(scope="module", params=["quadrupteron", "oblique"])
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder, name = tmp_path_factory.mktemp(request.param), request.param
    script = OBLIQUE if name == "oblique" else script_of(name, QUADRUPTERON, folder)
    return derived(name, script, folder, crosscheck=name == "quadrupteron")


def drawing(robot: ModuleType) -> tuple[np.ndarray, ...]:
    """Where the sliders begin, their directions, the axes of the bars, and their ends."""
    c = robot.Parameters().c
    if robot.__name__.endswith("quadrupteron"):
        axes = np.array([X, X, Y, Z])
        return np.zeros((4, 3)), axes, axes, c * np.array([-Y, Y, -X, -Z])
    axes = np.array([[0.6, 0.8, 0], [0, 0.6, 0.8], [0.8, 0, 0.6], [0.6, 0.8, 0]])
    ends = c * np.array([X + Y, Z - Y, -X, Y / 2 - X])
    return c * np.array([0 * X, Y, Z, X]), np.array([X, Y, Z, X]), axes, ends


def about(r: np.ndarray) -> np.ndarray:
    """The rotation by a vector."""
    angle = np.linalg.norm(r)
    K = np.cross(np.eye(3), r / angle)
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def missed(robot: ModuleType, y: np.ndarray, q: np.ndarray) -> np.ndarray:
    """For a hand that may turn in any way: how far it is from the planes, and z from its cone."""
    starts, ways, axes, ends = drawing(robot)
    R, p = about(y[:3]), y[3:]
    spans = p + ends @ R.T - starts - q[:, None] * ways
    return np.array([*np.einsum("ki,ki->k", axes, spans), *(axes @ (R[:, 2] - Z))])


def joints(robot: ModuleType, rows: int, seed: int) -> np.ndarray:
    reach = robot.Parameters().c
    return np.random.default_rng(seed).uniform(-reach, reach, (rows, 4))


def test_newton_finds_no_pose_that_the_closed_form_lacks(robot: ModuleType) -> None:
    rng, seen = np.random.default_rng(1), set()
    for k, q in enumerate(joints(robot, 8, 2)):
        p, status = robot.fk(q)
        for start in rng.uniform(-1.5, 1.5, (6, 6)):
            y = newton(lambda y: missed(robot, y, q), start)  # noqa: B023
            if y is None:
                continue
            R = about(y[:3])
            assert np.allclose(R[:, 2], Z, atol=1e-6)  # it is upright
            hand = np.array([*y[3:], np.arctan2(R[1, 0], R[0, 0])])
            if np.isnan(p).any():
                continue  # the bars do not reach there
            off = apart(p, hand, TURNS)
            assert np.min(off) < 1e-6
            assert np.abs(robot.ik(hand).q - q).max() < 1e-6
            seen.add((k, int(np.argmin(off))))
        assert (status == OK).all() or np.isnan(p).any()
    assert len(seen) > 5
    assert {mode for _, mode in seen} == {0, 1}


def test_both_modes_are_in_all_planes(robot: ModuleType) -> None:
    p, status = robot.fk(joints(robot, 500, 3))
    q = np.broadcast_to(joints(robot, 500, 3)[:, None], (*p.shape[:2], 4))[status == OK]
    hands = p[status == OK]
    assert len(hands) > 100
    for hand, row in zip(hands[:100], q[:100], strict=True):
        y = np.array([0, 0, hand[3] or 1e-300, *hand[:3]])
        assert np.abs(missed(robot, y, row)).max() < 1e-13
    answers = robot.ik(hands)
    assert np.abs(answers.q[:, 0] - q).max() < 1e-12


def test_the_jacobian_is_that_of_small_motions(robot: ModuleType) -> None:
    h, well = 1e-6, 0
    for q in joints(robot, 30, 4):
        p, status = robot.fk(q)
        for mode in np.flatnonzero(status == OK):
            if np.abs(robot.singularities(q)[mode]).min() < 0.02:
                continue
            moved = [(robot.fk(q + s).p - robot.fk(q - s).p)[mode] / (2 * h) for s in h * np.eye(4)]
            J = robot.jacobian(q)[mode]
            if np.isnan(moved).any():
                continue
            assert np.allclose(np.array(moved).T, J, atol=1e-5)
            A, B = robot.jacobian_parallel(q)[mode], robot.jacobian_serial(q)
            assert np.allclose(A @ J, np.diag(np.broadcast_to(B, (2, 4))[mode]), atol=1e-12)
            assert np.isclose(robot.determinant(q)[mode], np.linalg.det(J))
            assert np.isclose(robot.singularities(q)[mode, 0], np.linalg.det(A))
            assert np.isfinite(p[mode]).all()
            well += 1
    assert well > 10


def test_the_bars_limit_the_reach(robot: ModuleType) -> None:
    far = 3 * sum(robot.Parameters())
    assert not robot.workspace_contains([far, far, far, 0.1])
    assert robot.ik([far, far, far, 0.1]).status[0] == UNREACHABLE


def test_the_skeleton_is_the_drawing(robot: ModuleType) -> None:
    starts, ways, _, ends = drawing(robot)
    q = next(q for q in joints(robot, 50, 5) if (robot.fk(q).status == OK).all())
    for mode, hand in enumerate(robot.fk(q).p):
        points = dict(zip(robot.SKELETON.points, robot.skeleton(q)[mode], strict=True))
        R = about(np.array([0, 0, hand[3]]))
        for k in range(4):
            assert np.allclose(points[f"B{k + 1}"], starts[k] + q[k] * ways[k])
            assert np.allclose(points[f"C{k + 1}"], hand[:3] + R @ ends[k])
            bars = points[f"E{k + 1}"] - [points[f"B{k + 1}"], points[f"C{k + 1}"]]
            assert np.allclose(np.linalg.norm(bars, axis=1), robot.Parameters().l)


def test_planes_that_do_not_hold_the_hand_say_why() -> None:
    def four(axes: list[tuple], ends: list[tuple]) -> None:
        d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
        q = [d.joint(f"q{k}", "prismatic") for k in range(4)]
        rows = zip(q, axes, ends, strict=True)
        platform(d, [Plane(j, (1, 1), (0, 0, 0), a, a, on_hand=e) for j, a, e in rows])

    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    with pytest.raises(ShapeError, match="the planes share a direction"):
        four([x, x, y, y], [x, y, x, y])
    with pytest.raises(ShapeError, match="the planes do not hold the hand anywhere"):
        four([x, x, y, z], [z, z, z, x])


def test_a_leg_whose_last_joint_cannot_turn_is_named(tmp_path: Path) -> None:
    text = QUADRUPTERON.replace(
        'at = "C1", kind = "universal", ', 'at = "C1", kind = "spherical", '
    )
    assert text != QUADRUPTERON
    with pytest.raises(TableError, match="the last joint is universal, unless the axes are vert"):
        script_of("quadrupteron", text, tmp_path)


def test_a_yaw_of_half_a_turn_counts_as_an_angle(tmp_path: Path) -> None:
    """In single precision it may be rounded to beyond pi, and come back as nearly -pi."""
    d = read_script(script_of("quadrupteron", QUADRUPTERON, tmp_path))
    assert [str(x) for i in d.inverses if i.function == "ik" for x in i.angles] == ["yaw"]
