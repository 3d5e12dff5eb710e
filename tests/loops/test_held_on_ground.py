"""A hand that a universal or a ball joint holds on the ground, against its drawing."""

from pathlib import Path
from types import ModuleType

import matplotlib as mpl
import matplotlib.pyplot as plt
import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import plot
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

mpl.use("Agg")
FOLDER = TESTS / "held_out_loops"
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
MODES = {"ankle": 4, "coaxial_wrist": 8, "turning_platform": 1}


@pytest.fixture(scope="module", params=MODES)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = (FOLDER / f"{request.param}.toml").read_text("utf-8")
    assert len(text.splitlines()) < 40
    folder = tmp_path_factory.mktemp(request.param)
    return derived(request.param, script_of(request.param, text, folder), folder, crosscheck=True)


def name_of(robot: ModuleType) -> str:
    return robot.__name__.split(".")[-1]


def about(axis: int, angle: float) -> np.ndarray:
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i] = R[j, j] = np.cos(angle)
    R[j, i] = np.sin(angle)
    R[i, j] = -R[j, i]
    return R


def turned(robot: ModuleType, x: np.ndarray) -> np.ndarray:
    """The rotation of the hand at a target: the ankle turns about y, then about its own x."""
    return about(1, x[0]) @ about(0, x[1]) if name_of(robot) == "ankle" else x


def missed(robot: ModuleType, R: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how much each rod misses its length, as the drawing has it."""
    v, angles = robot.Parameters(), 2 * np.pi / 3 * np.arange(3)
    around = [about(2, a) for a in angles]
    if name_of(robot) == "ankle":
        ends = [[-v.b, v.w, 0], [-v.b, -v.w, 0]]
        near = [
            [-v.a * np.cos(a), s * v.w, h + v.a * np.sin(a)]
            for a, s, h in zip(q, (1, -1), (v.h1, v.h2), strict=True)
        ]
        lengths = np.array([v.h1, v.h2])
    elif name_of(robot) == "coaxial_wrist":
        ends = [A @ [np.sin(v.gamma), 0, np.cos(v.gamma)] for A in around]
        arm = np.array([np.sin(v.alpha), 0, -np.cos(v.alpha)])
        near = [A @ about(2, a) @ arm for A, a in zip(around, q, strict=True)]
        rods = np.einsum("ki,ki->k", np.array(ends) @ R.T, np.array(near))
        return rods - np.cos(v.beta)
    else:
        ends = [A @ [0, v.c, 0] for A in around]
        near, lengths = [A @ [v.b, 0, -v.h] for A in around], q
    return np.linalg.norm(np.array(ends) @ R.T - near, axis=1) - lengths


def targets(robot: ModuleType, rows: int, seed: int) -> list[np.ndarray]:
    rng = np.random.default_rng(seed)
    if name_of(robot) == "ankle":
        return list(rng.uniform(-0.6, 0.6, (rows, 2)))
    tilts = rng.uniform(-0.5, 0.5, (rows, 3))
    return [about(2, c) @ about(1, b) @ about(0, a) for a, b, c in tilts]


def test_newton_finds_no_joints_that_the_closed_form_lacks(robot: ModuleType) -> None:
    rng, found = np.random.default_rng(1), 0
    turns = [name_of(robot) != "turning_platform"] * len(robot.JOINTS)
    assert len(robot.BRANCHES) == MODES[name_of(robot)]
    for x in targets(robot, 10, 2):
        answers, seen = robot.ik(x), set()
        for start in rng.uniform(-3, 3, (30, len(turns))):
            start = start if turns[0] else np.abs(start)
            q = newton(lambda q: missed(robot, turned(robot, x), q), start)  # noqa: B023
            if q is None:
                continue
            off = apart(answers.q, q, turns)
            assert np.nanmin(off) < 1e-6
            seen.add(int(np.nanargmin(off)))
        found += len(seen)
    assert found >= 5 * MODES[name_of(robot)]


def test_all_answers_close_the_loops(robot: ModuleType) -> None:
    count = 0
    for x in targets(robot, 100, 3):
        q, status = robot.ik(x)
        for row in q[status != UNREACHABLE]:
            assert np.abs(missed(robot, turned(robot, x), row)).max() < 1e-14
        count += (status == OK).any()
    assert count > 50


def test_the_jacobian_is_that_of_small_motions(robot: ModuleType) -> None:
    h, well = 1e-6, 0
    for x in targets(robot, 30, 5):
        q, status = robot.ik(x)
        for k in np.flatnonzero(status == OK):
            A, B = robot.jacobian_parallel(x, q[k]), robot.jacobian_serial(x, q[k])
            sizes = np.linalg.norm(A, axis=1)
            if (abs(B) < sizes / 20).any() or abs(np.linalg.det(A)) < sizes.prod() / 20:
                continue
            rates = []
            for i in range(len(robot.JOINTS)):
                if x.shape == (3, 3):
                    ends = [robot.ik(about(i, s) @ x).q[k] for s in (h, -h)]
                else:
                    ends = [robot.ik(x + s * np.eye(2)[i]).q[k] for s in (h, -h)]
                rates.append((ends[0] - ends[1]) / (2 * h))
            K = robot.jacobian_inverse(x, q[k])
            assert np.allclose(np.array(rates).T, K, rtol=1e-5, atol=1e-4)
            J = robot.jacobian(x, q[k])
            assert np.allclose(K @ J, np.eye(len(K)), atol=1e-9)
            assert np.isclose(robot.determinant(x, q[k]), np.linalg.det(J))
            assert np.allclose(robot.singularities(x, q[k]), [*B, np.linalg.det(A)], atol=1e-15)
            well += 1
    assert well > 10


def test_the_skeleton_turns_about_its_pivot(robot: ModuleType) -> None:
    (x,) = targets(robot, 1, 6)
    q, status = robot.ik(x)
    k = int(np.flatnonzero(status != UNREACHABLE)[0])
    points = dict(zip(robot.SKELETON.points, robot.skeleton(x, q[k]), strict=True))
    level = np.zeros(2) if x.shape == (2,) else np.eye(3)
    home = dict(zip(robot.SKELETON.points, robot.skeleton(level, q[k]), strict=True))
    assert np.allclose(points["P"], 0)
    for name in points:
        if name.startswith("C"):
            assert np.allclose(points[name], turned(robot, x) @ home[name])


def test_it_is_drawn_and_tracked_as_any_mechanism(robot: ModuleType) -> None:
    (x,) = targets(robot, 1, 6)
    q, status = robot.ik(x)
    k = int(np.flatnonzero(status != UNREACHABLE)[0])
    assert plot.mechanism(robot, q[k], x=x) is not None
    assert plot.branches(robot) is not None
    assert plot.workspace(robot, resolution=40) is not None
    plt.close("all")
    assert np.allclose(Robot(robot).nearest(x, q[k] + 1e-3).q, q[k])


def test_a_matrix_that_is_no_rotation_is_invalid(robot: ModuleType) -> None:
    if name_of(robot) != "ankle":
        assert (robot.ik(np.diag([1.0, 1.0, -1.0])).status == INVALID).all()


@pytest.mark.parametrize(
    ("name", "old", "other", "message"),
    [
        ("ankle", ", second = [1, 0, 0]", "", "give it two axes at right angles"),
        ("ankle", "second = [1, 0, 0]", "second = [1, 1, 0]", "second of ankle have to be at"),
        ("ankle", 'kind = "universal", axis = [0, 1, 0], second = [1, 0, 0]', 'kind = "spherical"',
         "ankle leaves the hand three degrees of freedom, so three joints are driven, not q1"),
        ("ankle", 'kind = "universal", axis = [0, 1, 0], second', 'kind = "spherical", second',
         "only a universal joint has a second axis"),
        ("ankle", 'kind = "universal", axis = [0, 1, 0], second = [1, 0, 0]', 'axis = [0, 1, 0]',
         "of the joints that hold a hand on the ground"),
        ("turning_platform", "ground = {P = [0, 0, 0], A1",
         "ground = {Q = [0, 0, 0], A1", "say where the bodies meet"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    name: str, old: str, other: str, message: str, tmp_path: Path
) -> None:
    text = (FOLDER / f"{name}.toml").read_text("utf-8")
    assert old in text
    with pytest.raises(TableError, match=message):
        script_of(name, text.replace(old, other), tmp_path)
