"""A hand on a passive leg: the Tricept, against its drawing, and other driven legs."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, read_script, script_of
from places import TESTS

from closedform import Derivation, Gimbal, Guide, Paper, Slide, Stretch, Strut, guided, prove
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TRICEPT = (TESTS / "held_out_loops" / "tricept.toml").read_text("utf-8")
CRANKS = (
    TRICEPT.replace("tube1 = {}", 'crank1 = {B1 = ["b + 0.2", 0, 0]}')
    .replace("piston1 = {}", 'rod1 = {length = "r"}')
    .replace('q1 = {between = ["tube1", "piston1"], at = "A1", kind = "prismatic"',
             'q1 = {between = ["ground", "crank1"], at = "A1", axis = [0, 1, 0]')
    .replace('a1 = {between = ["ground", "tube1"], at = "A1"',
             'a1 = {between = ["crank1", "rod1"], at = "B1"')
    .replace('"piston1"', '"rod1"')
    .replace("[bodies]", 'r = {value = "0.9", meaning = "rod"}\n\n[bodies]')
)  # fmt: skip
OK, UNREACHABLE, SINGULAR = range(3)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)


@pytest.fixture(scope="module", params=["tricept", "cranks"])
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = TRICEPT if request.param == "tricept" else CRANKS
    assert len(text.splitlines()) < 40
    folder = tmp_path_factory.mktemp(request.param)
    return derived(request.param, script_of(request.param, text, folder), folder, crosscheck=True)


def is_tricept(robot: ModuleType) -> bool:
    return robot.__name__.endswith("tricept")


def about_x_and_y(a: float, b: float) -> np.ndarray:
    """The rotation of a universal joint: first about x, then about the new y."""
    (c, s), (d, t) = ((np.cos(e), np.sin(e)) for e in (a, b))
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]]) @ [[d, 0, t], [0, 1, 0], [-t, 0, d]]


def hand(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The position of the hand and its rotation, which the passive leg gives it."""
    R = about_x_and_y(np.arctan2(-x[1], x[2]), np.arctan2(x[0], np.hypot(x[1], x[2])))
    assert np.allclose(np.linalg.norm(x) * R[:, 2], x)
    return x, R


def missed(robot: ModuleType, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    return missed_by(robot, *hand(x), q)


def missed_by(robot: ModuleType, p: np.ndarray, R: np.ndarray, q: np.ndarray) -> np.ndarray:
    v = robot.Parameters()
    far = p + (v.c * OUT - v.e * np.array([0, 0, 1])) @ R.T
    if is_tricept(robot):
        return np.linalg.norm(far - v.b * OUT, axis=1) - q
    near = (v.b + 0.2 * np.cos(q))[:, None] * OUT - 0.2 * np.sin(q)[:, None] * [0, 0, 1]
    return np.linalg.norm(far - near, axis=1) - v.r


def targets(rows: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform((-0.35, -0.35, 0.7), (0.35, 0.35, 0.95), (rows, 3))


def test_newton_finds_no_joints_that_the_closed_form_lacks(robot: ModuleType) -> None:
    rng, found = np.random.default_rng(1), 0
    assert len(robot.BRANCHES) == (1 if is_tricept(robot) else 8)
    for x in targets(10, 2):
        answers, seen = robot.ik(x), set()
        for start in rng.uniform(-3, 3, (20, 3)):
            start = np.abs(start) if is_tricept(robot) else start
            q = newton(lambda q: missed(robot, x, q), start)  # noqa: B023
            if q is None:
                continue
            off = apart(answers.q, q, [not is_tricept(robot)] * 3)
            assert np.nanmin(off) < 1e-6
            seen.add(int(np.nanargmin(off)))
        found += len(seen)
    assert found >= (10 if is_tricept(robot) else 30)


def test_all_answers_close_the_loops(robot: ModuleType) -> None:
    count = 0
    for x in targets(200, 3):
        answers = robot.ik(x)
        for q in answers.q[answers.status != UNREACHABLE]:
            assert np.abs(missed(robot, x, q)).max() < 1e-14
            count += answers.status[0] == OK
    assert count > 100


def test_the_hand_turns_as_the_passive_leg_does(robot: ModuleType) -> None:
    for x in targets(50, 4):
        p, R = hand(x)
        T = robot.hand_pose(x)
        assert np.allclose(T[:3, 3], p, atol=1e-15)
        assert np.allclose(T[:3, :3], R, atol=1e-15)
    assert "turn_1 = atan2(-Y, Z)" in robot.hand_pose.__doc__


def test_on_the_first_axis_the_leg_turns_freely(robot: ModuleType) -> None:
    """The hand is there at the side of the pivot, and turn_1 = 0 is taken."""
    R, count = about_x_and_y(0, np.pi / 2), 0
    for along in np.linspace(0.1, 1.2, 12):
        for off in (0.0, 1e-17):
            x = np.array([along, off, 0.0])
            q, status = robot.ik(x)
            assert not (status == OK).any()
            for row in q[status == SINGULAR]:
                assert np.abs(missed_by(robot, x, R, row)).max() < 1e-14
                count += 1
    assert count > (5 if is_tricept(robot) else -1)  # the rods do not reach there
    assert (robot.ik(np.zeros(3)).status != OK).all()


def test_the_jacobians_are_differences(robot: ModuleType) -> None:
    h, well = 1e-6, 0
    for x in targets(30, 5):
        q, status = robot.ik(x)
        for k in np.flatnonzero(status == OK):
            if np.abs(robot.singularities(x, q[k])).min() < 0.02:
                continue
            ends = [(robot.ik(x + s).q[k] - robot.ik(x - s).q[k]) / (2 * h) for s in h * np.eye(3)]
            K = robot.jacobian_inverse(x, q[k])
            assert np.allclose(np.array(ends).T, K, rtol=1e-5, atol=1e-5)
            J, A = robot.jacobian(x, q[k]), robot.jacobian_parallel(x, q[k])
            B = robot.jacobian_serial(x, q[k])
            assert np.allclose(A @ J, np.diag(B), atol=1e-11)
            assert np.isclose(robot.determinant(x, q[k]), np.linalg.det(J), rtol=1e-7)
            off_axis = np.hypot(x[1], x[2]) * np.linalg.norm(x)
            factors = [*B, np.linalg.det(A) * off_axis, off_axis]
            assert np.allclose(robot.singularities(x, q[k]), factors, atol=1e-13)
            well += 1
    assert well > 20


def test_the_skeleton_is_the_drawing(robot: ModuleType) -> None:
    v, x = robot.Parameters(), np.array([0.2, -0.3, 0.9])
    q, (p, R) = robot.ik(x).q[0], hand(x)
    points = dict(zip(robot.SKELETON.points, robot.skeleton(x, q), strict=True))
    assert np.allclose(points["P"], p)
    for k, out in enumerate(OUT, 1):
        assert np.allclose(points[f"A{k}"], v.b * out)
        assert np.allclose(points[f"C{k}"], p + R @ (v.c * out - [0, 0, v.e]))
    assert set(robot.SKELETON.joints) == {"q1", "q2", "q3", "s"}


def test_legs_that_do_not_fit_say_why() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [d.joint(f"q{k + 1}", "prismatic") for k in range(3)]
    slide = d.joint("s", "prismatic", passive=True)
    o, x, y, z = (0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)
    legs = [Stretch(j, a, on_hand=b) for j, a, b in zip(q, (x, y, z), (y, z, x), strict=True)]
    post = Guide(slide, o, x, y)
    with pytest.raises(ShapeError, match="three driven legs in space"):
        guided(d, post, legs[:2])
    with pytest.raises(ShapeError, match="a crank, a slide or a leg that stretches"):
        guided(d, post, [Strut(1, o), *legs[1:]])
    with pytest.raises(ShapeError, match="two unit vectors at right angles"):
        guided(d, Guide(slide, o, x, (1, 1, 0)), legs)
    with pytest.raises(ShapeError, match="give the legs in this order"):
        guided(d, post, legs[::-1])
    with pytest.raises(ShapeError, match="a Universal keeps the hand from turning"):
        guided(d, post, [Stretch(j, o, on_hand=x, axis=y) for j in q])
    with pytest.raises(ShapeError, match="a hand on a universal joint has two driven legs"):
        guided(d, Gimbal(o, x, y), legs)
    with pytest.raises(ShapeError, match="the axes of a universal joint must be two unit vectors"):
        guided(d, Gimbal(o, x, x), legs[:2])
    d.task = ["x", "y", "yaw"]
    with pytest.raises(ShapeError, match="the task of this hand must be x, y, z"):
        guided(d, post, legs)


def test_a_passive_leg_in_any_direction() -> None:
    """Its axes are oblique, and the sliders have rods."""
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    q = [d.joint(f"q{k + 1}", "prismatic") for k in range(3)]
    slide = d.joint("s", "prismatic", passive=True)
    ends = (1, 0, 0), (0, 1, 0), (-1, -1, 0)
    legs = [Slide(j, 3, e, (0, 0, 1), on_hand=e) for j, e in zip(q, ends, strict=True)]
    guided(d, Guide(slide, (0, 0, 1), (0, 0, 1), (0, 1, 0)), legs)
    assert len(d.branches) == 8
    assert prove(d).inverses[0].branches == 8


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('kind = "universal", axis = [1, 0, 0]', 'axis = [1, 0, 0]',
         "joined to the ground by a universal joint"),
        ('kind = "universal", axis = [1, 0, 0]', 'kind = "universal"', "o needs its axis"),
        ("axis = [0, 0, 1]", "axis = [1, 0, 1]", "the axes of o and s have to be at right angles"),
        ('at = "P", kind', 'at = "Q", kind', "s has to be at P, which is on the line of post"),
        ('"C1", kind = "spherical"', '"C1", axis = [0, 1, 0]',
         "c1, c2 and c3 would hold platform by an axis; a leg may end"),
        ("copies = 3", "copies = 2", "so three joints are driven, not q1 and q2"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in TRICEPT
    with pytest.raises(TableError, match=message):
        script_of("tricept", TRICEPT.replace(old, other), tmp_path)


def test_the_words_of_a_file_name_the_passive_leg(tmp_path: Path) -> None:
    d = read_script(script_of("tricept", TRICEPT, tmp_path))
    assert "A passive leg of a universal joint and a slide carries the hand." in d.mechanism
