"""Hands on four legs that stay upright: the Par 4 and the 4-UPU of the guide, as drawn."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, read_script, script_of
from places import ROOT

from closedform import Crank, Derivation, Half, Paper, Parallelogram, Slide, Stretch, platform
from closedform.algebra.shapes import ShapeError
from closedform.lemmas.universal import Universal
from closedform.loops.platform_legs import Platform, counted_degree
from closedform.scaffold.inputs.tables import TableError
from closedform.scaffold.new import new

GUIDE = (ROOT / "docs" / "closed-loops.md").read_text("utf-8")
FILES = {
    name: re.findall(rf"```toml {name}.toml\n(.*?)```", GUIDE, re.DOTALL)[0]
    for name in ("par4", "lift")
}
FILES["h4"] = "\n".join(line for line in FILES["par4"].splitlines() if "bar2" not in line)
OK, UNREACHABLE, SINGULAR = range(3)
OUT = np.array([(1, 1, 0), (1, -1, 0), (-1, -1, 0), (-1, 1, 0)]) / np.sqrt(2)
UP = np.array([0, 0, 1])


@pytest.fixture(scope="module", params=["par4", "h4", "lift"])
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp(request.param)
    script = script_of(request.param, FILES[request.param], folder)
    return derived(request.param, script, folder, crosscheck=True)


def has_halves(robot: ModuleType) -> bool:
    return not robot.__name__.endswith("lift")


def turned(yaw: float, v: np.ndarray) -> np.ndarray:
    c, s = np.cos(yaw), np.sin(yaw)
    return v @ np.array([(c, s, 0), (-s, c, 0), (0, 0, 1)])


def ends(robot: ModuleType, x: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The near ends of the rods and the far ones."""
    v = robot.Parameters()
    if has_halves(robot):
        near = v.b * np.sqrt(2) * OUT + v.l * (np.cos(q)[:, None] * OUT - np.sin(q)[:, None] * UP)
        pins = turned(x[3], np.array([(v.c, 0, 0)] * 2 + [(-v.c, 0, 0)] * 2))
        return near, x[:3] + pins + v.e * np.array([(0, 1, 0), (0, -1, 0), (0, -1, 0), (0, 1, 0)])
    near = v.b * np.array([(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)])
    hand = np.array([(v.c, v.h, 0), (v.h, v.c, 0), (-v.c, -v.h, 0), (-v.h, -v.c, 0)])
    return near, x[:3] + turned(x[3], hand)


def missed(robot: ModuleType, x: np.ndarray, q: np.ndarray) -> np.ndarray:
    near, far = ends(robot, x, q)
    return np.linalg.norm(far - near, axis=1) - (robot.Parameters().s if has_halves(robot) else q)


def targets(rows: int, seed: int) -> np.ndarray:
    low, high = (-0.3, -0.3, -0.9, -1), (0.3, 0.3, -0.6, 1)
    return np.random.default_rng(seed).uniform(low, high, (rows, 4))


def test_newton_finds_no_joints_that_the_closed_form_lacks(robot: ModuleType) -> None:
    rng, found, angles = np.random.default_rng(1), 0, [has_halves(robot)] * 4
    assert len(robot.BRANCHES) == (16 if has_halves(robot) else 1)
    for x in targets(8, 2):
        answers, seen = robot.ik(x), set()
        for start in rng.uniform(-3, 3, (30, 4)):
            start = start if has_halves(robot) else np.abs(start)
            q = newton(lambda q: missed(robot, x, q), start)  # noqa: B023
            if q is None:
                continue
            off = apart(answers.q, q, angles)
            assert np.nanmin(off) < 1e-6
            seen.add(int(np.nanargmin(off)))
        found += len(seen)
    assert found >= (60 if has_halves(robot) else 8)


def test_all_answers_close_the_loops(robot: ModuleType) -> None:
    """Each leg is reached if and only if the triangle of its crank and rod closes."""
    reached = 0
    for x in targets(400, 3):
        q, status = robot.ik(x)
        v, (near, far) = robot.Parameters(), ends(robot, x, np.zeros(4))
        if has_halves(robot):
            w = far - (near - v.l * OUT)
            across = np.cross(OUT, UP)
            aside = np.sum(w * across, axis=1)
            rest = np.linalg.norm(w - aside[:, None] * across, axis=1)
            fore = np.sqrt(np.maximum(0, v.s**2 - aside**2))
            inside = ((abs(v.l - fore) < rest) & (rest < v.l + fore)).all()
            assert (status != UNREACHABLE).all() == inside
            assert robot.workspace_contains(x) == inside
        for row in q[status != UNREACHABLE]:
            assert np.abs(missed(robot, x, row)).max() < 1e-14
            reached += 1
    assert reached >= 400


def test_the_jacobians_are_differences(robot: ModuleType) -> None:
    h, well = 1e-6, 0
    for x in targets(20, 4):
        q, status = robot.ik(x)
        for k in np.flatnonzero(status == OK):
            factors = robot.singularities(x, q[k])
            if np.abs(factors[:4]).min() < 0.05 or abs(factors[4]) < 1e-3:
                continue
            up, down = ([robot.ik(x + s * step).q[k] for step in np.eye(4)] for s in (h, -h))
            K = robot.jacobian_inverse(x, q[k])
            assert np.allclose((np.array(up) - down).T / (2 * h), K, rtol=1e-5, atol=1e-5)
            J, A = robot.jacobian(x, q[k]), robot.jacobian_parallel(x, q[k])
            B = robot.jacobian_serial(x, q[k])
            assert np.allclose(A @ J, np.diag(B), atol=1e-10)
            assert np.isclose(robot.determinant(x, q[k]), np.linalg.det(J), rtol=1e-7)
            assert np.allclose(factors, [*B, np.linalg.det(A)], atol=1e-13)
            well += 1
    assert well > 15


def test_the_constraint_vanishes_where_the_hand_can_tilt(robot: ModuleType) -> None:
    """The rates of turning that the legs leave: the null space of what each of them takes."""
    bars = np.cross(UP, OUT)

    def taken(x: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Rows for the rate of the hand; halves on one bar turn about z with rates of their own."""
        near, far = ends(robot, x, q)
        rods = far - near
        if not has_halves(robot):
            return rods[:, :2]
        normals = np.cross(bars, rods)
        if not robot.__name__.endswith("h4"):
            return normals
        first = np.array([True, True, False, False])
        return np.column_stack((normals[:, :2], normals[:, 2] * first, normals[:, 2] * ~first))

    for x in targets(20, 5):
        for q in robot.ik(x).q:
            if np.isnan(q).any():
                continue
            smallest = np.linalg.svd(taken(x, q), compute_uv=False)[-1]
            factors = robot.constraint(x, q)
            assert np.abs(factors).max() > 0.02 * smallest**3
    v = robot.Parameters()
    if has_halves(robot):  # all rods hang vertically, so all normals are horizontal
        fitting = v._replace(e=v.c)
        theta = np.arccos(np.sqrt(2) * (v.c - v.b) / v.l)
        x = np.array([0, 0, -v.l * np.sin(theta) - v.s, 0])
        q = np.full(4, theta)
        assert np.abs(robot.ik(x, fitting).q - q).max(axis=-1).min() < 1e-6
    else:  # the horizontal parts of all rods are parallel
        fitting = v._replace(h=v.b - v.c)
        x = np.array([0.0, 0.0, -0.5, 0.0])
        q = robot.ik(x, fitting).q[0]
    assert np.abs(robot.constraint(x, q, fitting)).max() < 1e-15


def test_the_skeleton_is_the_drawing(robot: ModuleType) -> None:
    x = np.array([0.05, -0.08, -0.7, 0.4])
    q = robot.ik(x).q[0]
    points = dict(zip(robot.SKELETON.points, robot.skeleton(x, q), strict=True))
    near, far = ends(robot, x, q)
    assert np.allclose(points["P"], x[:3])
    for k in range(4):
        assert np.allclose(points[f"B{k + 1}" if has_halves(robot) else f"A{k + 1}"], near[k])
        assert np.allclose(points[f"C{k + 1}"], far[k])
    if has_halves(robot):
        middle = (points["M1"] + points["M2"]) / 2
        assert np.allclose(middle, points["P"])
        ends_of_bar = points["C1a"] - points["B1a"], points["C1b"] - points["B1b"]
        assert np.allclose(*ends_of_bar)


@pytest.mark.parametrize(
    "hand",
    [
        ((1, 0, 0), (1, 0, 0), (-1, 0, 0), (-1, 0, 0)),
        ((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)),
        ((2, 0, 1), (1, 3, 0), (-1, 1, 2), (0, -2, 1)),
    ],
)
def test_the_degree_of_the_forward_problem_is_8(hand: tuple) -> None:
    d, joints = a_derivation()
    legs = [Stretch(q, (k, k * k, 1), on_hand=c) for k, (q, c) in enumerate(zip(joints, hand))]  # noqa: B905
    assert counted_degree(Platform(d, tuple(legs))) == 8


def test_four_legs_that_are_alike_do_not_hold_the_hand(tmp_path: Path) -> None:
    text = re.sub(r".*2 = {.*\n", "", FILES["lift"].replace("copies = 2", "copies = 4"))
    text = re.sub(r", ([AC])2 = [^]]*]", "", text)
    with pytest.raises(ShapeError, match="singular in every posture"):
        read_script(script_of("lift", text, tmp_path))


def a_derivation() -> tuple[Derivation, list]:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    return d, [d.joint(f"q{k + 1}", "prismatic") for k in range(4)]


def test_legs_that_do_not_keep_the_hand_upright_say_why() -> None:
    x, y, z = np.eye(3, dtype=int).tolist()
    corners = (x, y, [-1, 0, 0], [0, -1, 0])

    def refused(message: str, legs_of) -> None:
        d, joints = a_derivation()
        legs = [legs_of(k, q, c) for k, (q, c) in enumerate(zip(joints, corners, strict=True))]
        with pytest.raises(ShapeError, match=message):
            platform(d, legs)

    refused("universal joints, .* or two halves", lambda k, q, c: Stretch(q, c, on_hand=c))
    refused("have to be vertical", lambda k, q, c: Stretch(q, c, on_hand=c, axis=x))
    refused("it turns freely", lambda k, q, c: Stretch(q, c, on_hand=(1, 0, k), axis=z))
    bars = Parallelogram(1, y, 1)
    refused(
        "all four legs end on a Half",
        lambda k, q, c: Half(Slide(q, bars, c, z, on_hand=c), x) if k else Slide(q, bars, c, z),
    )
    refused(
        "needs rods that are a Parallelogram",
        lambda k, q, c: Half(Slide(q, 1, c, z, on_hand=c), x),
    )
    refused("two legs end on each half", lambda k, q, c: Half(Slide(q, bars, c, z, on_hand=c), x))
    refused(
        "the crank of q1 turns the axis",
        lambda k, q, c: Crank(q, 1, Universal(1, z), c, along=x, across=z, on_hand=c),
    )
    d, joints = a_derivation()
    joints += [d.joint(f"q{k}", "prismatic") for k in (5, 6)]
    with pytest.raises(ShapeError, match="a hand of two halves has four legs"):
        platform(d, [Half(Slide(q, 1, x, z), x) for q in joints])
    with pytest.raises(ShapeError, match="six, or four if they keep it upright"):
        platform(d, [Slide(q, 1, x, z) for q in joints[:5]])


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('n1 = {between = ["bar2", "half1"], at = "N1", axis = [0, 0, 1]}\n', "", "as bar1 does"),
        ("bar2 = {N1 = [\"c\"", "bar2 = {N1 = [\"e\"", "opposite sides of a parallelogram"),
        ('at = "M1", axis = [0, 0, 1]', 'at = "M1", axis = [0, 1, 0]', "axis has to be"),
        ("axis = [-1, -1, 0], driven = true", "axis = [-1, -1, 0]", "no leg contains theta4"),
    ],
)  # fmt: skip
def test_a_file_with_other_halves_says_why(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    text = FILES["par4"].replace(old, new)
    assert text != FILES["par4"]
    with pytest.raises(TableError, match=message):
        script_of("par4", text, tmp_path)


@pytest.mark.parametrize(
    ("name", "bars", "joints"),
    [
        ("par4", "Two parallel bars with vertical pins join", 16),
        ("h4", "One bar with vertical", 14),
    ],
)
def test_new_says_that_the_hand_stays_upright(
    name: str, bars: str, joints: int, tmp_path: Path
) -> None:
    (tmp_path / f"{name}.toml").write_text(FILES[name], "utf-8")
    script = new(name, "loop", tmp_path / f"{name}.toml")
    assert script.inverse == f"a hand that stays upright, of {joints} joints"
    assert bars in script.text
