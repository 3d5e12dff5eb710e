"""Hands that lift and tilt: the 3-PRS head of the guide and others, against their drawings."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
import sympy as sp
from loop_files import derived, read_script, script_of
from places import ROOT

from closedform import plot
from closedform.algebra.shapes import ShapeError
from closedform.cli.commands import main
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

GUIDE = (ROOT / "docs" / "closed-loops.md").read_text("utf-8")
[FROM_FILE] = re.findall(r"```toml head.toml\n(.*?)```", GUIDE, re.DOTALL)
[SPRINT] = re.findall(r"```python sprint.py\n(.*?)```", GUIDE, re.DOTALL)
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
UNEVEN = """
from sympy import Rational
from closedform import Crank, Derivation, Paper, Slide, Stretch, Upright, tripod

d = Derivation("uneven", "Uneven", Paper("uneven", "Uneven", ("A. Nonymous",)), "Three legs.")
b, a, c, l, r = (
    d.parameter(name, value=Rational(value), unit="m", meaning=name, source="an example")
    for name, value in (("b", "0.3"), ("a", "0.2"), ("c", "0.15"), ("l", "0.2"), ("r", "0.4"))
)
theta1, rho2, q3 = d.joint("theta1"), d.joint("rho2", "prismatic"), d.joint("q3", "prismatic")
crank = Crank(theta1, l, r, (b, 0), (1, 0), (0, 1))
slide = Slide(rho2, r, (b, 0), (Rational(3, 5), Rational(4, 5)))
stretch = Stretch(q3, (b, 0))
away = Rational(-3, 5), Rational(-4, 5)
tripod(d, [
    Upright(crank, (1, 0), (a, 0)),
    Upright(slide, (0, 1), (0, a)),
    Upright(stretch, away, (-c, -c)),
])
"""
LIFTED = UNEVEN.replace('"uneven", "Uneven"', '"lifted", "Lifted"').replace(
    "    Upright(crank, (1, 0), (a, 0)),", "    Upright(crank, (1, 0), (a, 0, -c)),"
).replace("(0, a)),", "(0, a, -c)),").replace("(-c, -c)),", "(-c, -c, -c)),")  # fmt: skip
"""The point of the hand is above the ends of the legs."""
HEADINGS = {
    "sprint": np.array([[1, 0], [-0.5, np.sqrt(0.75)], [-0.5, -np.sqrt(0.75)]]),
    **dict.fromkeys(("uneven", "lifted"), np.array([[1, 0], [0, 1], [-0.6, -0.8]])),
}


@pytest.fixture(scope="module")
def sprint(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("sprint", SPRINT, tmp_path_factory.mktemp("sprint"))


@pytest.fixture(scope="module")
def uneven(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("uneven", UNEVEN, tmp_path_factory.mktemp("uneven"))


@pytest.fixture(scope="module")
def lifted(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("lifted", LIFTED, tmp_path_factory.mktemp("lifted"), crosscheck=True)


@pytest.fixture
def tripod(request: pytest.FixtureRequest) -> tuple[ModuleType, np.ndarray, np.ndarray]:
    """A module, the headings of its planes and the corners of its hand."""
    module = request.getfixturevalue(request.param)
    _, a, *_ = module.Parameters()
    headings = HEADINGS[request.param]
    corners = a * headings if request.param == "sprint" else np.array([[a, 0], [0, a], [-0.15] * 2])
    if request.param == "lifted":
        corners = np.pad(corners, ((0, 0), (0, 1)), constant_values=-0.15)
    return module, headings, corners


both = pytest.mark.parametrize("tripod", ["sprint", "uneven", "lifted"], indirect=True)


def poses(x: np.ndarray, twist: np.ndarray) -> np.ndarray:
    """The rotation by angles about three axes, each from its sine and its cosine."""
    turned = np.eye(3)
    for (i, j), angle in (((2, 0), x[..., 2]), ((1, 2), x[..., 1]), ((0, 1), twist)):
        about = np.broadcast_to(np.eye(3), (*np.shape(angle), 3, 3)).copy()
        about[..., i, i] = about[..., j, j] = np.cos(angle)
        about[..., j, i], about[..., i, j] = np.sin(angle), -np.sin(angle)
        turned = turned @ about
    return turned


def corners_at(T: np.ndarray, corners: np.ndarray) -> np.ndarray:
    local = np.pad(corners, ((0, 0), (0, 3 - corners.shape[1])))
    return T[..., None, :3, 3] + np.einsum("...ij,kj->...ki", T[..., :3, :3], local)


def near_ends(name: str, headings: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The near ends of the rods in space, and the lengths of the rods."""
    zero, one = np.zeros_like(q[..., 0]), np.ones_like(q[..., 0])
    if name == "sprint":
        flat = [(0.35 * one, q[..., k]) for k in range(3)]
        rods = np.full(q.shape, 0.6)
    else:
        flat = [
            (0.3 + 0.2 * np.cos(q[..., 0]), 0.2 * np.sin(q[..., 0])),
            (0.3 + 0.6 * q[..., 1], 0.8 * q[..., 1]),
            (0.3 * one, zero),
        ]
        rods = np.stack([0.4 * one, 0.4 * one, q[..., 2]], -1)
    ends = [[r * h[0], r * h[1], z] for (r, z), h in zip(flat, headings, strict=True)]
    return np.stack([np.stack(np.broadcast_arrays(*e), -1) for e in ends], -2), rods


def targets(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * (0.3, 1.2, 1.2)


@both
def test_the_corners_are_in_the_planes_and_the_rods_keep_their_lengths(tripod) -> None:
    module, headings, corners = tripod
    x = targets(100_000, 1)
    T, found = module.hand_pose(x), module.ik(x)
    assert np.allclose(T[:, 2, 3], x[:, 0])
    seen = np.swapaxes(poses(x, 0 * x[:, 0]), -1, -2) @ T[:, :3, :3]
    twist = np.arctan2(seen[:, 1, 0], seen[:, 0, 0])
    assert np.abs(poses(x, twist) - T[:, :3, :3]).max() < 1e-14
    far = corners_at(T, corners)
    normals = np.stack([-headings[:, 1], headings[:, 0]], -1)
    assert np.abs(np.einsum("nki,ki->nk", far[..., :2], normals)).max() < 1e-15
    kept = found.status == OK
    assert kept.mean() > 0.4
    near, rods = near_ends(module.__name__.split(".")[-1], headings, found.q)
    misses = np.linalg.norm(far[:, None] - near, axis=-1) - rods
    assert np.abs(misses[kept]).max() < 1e-14


def test_all_modes_of_the_head(sprint: ModuleType) -> None:
    """A rod is the hypotenuse over its way to the column."""
    b, a, l = sprint.Parameters()
    x = targets(100_000, 2)
    far = corners_at(sprint.hand_pose(x), a * HEADINGS["sprint"])
    away = np.einsum("nki,ki->nk", far[..., :2], HEADINGS["sprint"]) - b
    reached = (np.abs(away) < l).all(-1)
    found = sprint.ik(x)
    assert (found.status[~reached] == UNREACHABLE).all()
    assert np.isin(found.status[reached], (OK, SINGULAR)).all()
    height = np.sqrt(l**2 - away[reached] ** 2)
    signs = np.stack(np.meshgrid(*[[-1, 1]] * 3), -1).reshape(-1, 3)
    modes = far[reached][:, None, :, 2] + signs * height[:, None]
    apart = np.abs(modes[:, :, None] - found.q[reached][:, None]).max(-1)
    assert apart.min(-1).max() < 1e-12 and apart.min(-2).max() < 1e-12


@both
def test_two_twists_keep_the_corners_in_their_planes(tripod) -> None:
    """A search over the twist finds the one that is returned, and that half a turn on."""
    module, headings, corners = tripod
    normals = np.stack([-headings[:, 1], headings[:, 0]], -1)
    angles = np.linspace(-np.pi, np.pi, 2001)
    for x in targets(20, 3):
        R, axes = poses(np.tile(x, (2001, 1)), angles), corners.shape[1]
        arms = np.einsum("nij,kj->nki", R[:, :2, :axes], corners)
        off = np.einsum("nki,ki->nk", arms, normals)
        sideways = np.linalg.solve(normals[:2], -off[:, :2, None])[..., 0]
        aside = off[:, 2] + sideways @ normals[2]
        crossings = angles[:-1][np.sign(aside[1:]) != np.sign(aside[:-1])]
        assert len(crossings) == 2
        assert np.isclose(np.diff(crossings)[0], np.pi, atol=0.01)
        own = module.hand_pose(x)[:3, :3]
        gaps = [np.abs(poses(x, twist) - own).max() for twist in crossings]
        assert min(gaps) < 0.01


def test_the_known_parasitic_motion_of_even_legs(sprint: ModuleType) -> None:
    """Zero torsion: R is symmetric in x and y, and the sideways motion follows from it."""
    a = sprint.Parameters().a
    T = sprint.hand_pose(targets(1000, 4))
    assert np.abs(T[:, 0, 1] - T[:, 1, 0]).max() < 1e-15
    assert np.abs(T[:, 0, 3] - a / 2 * (T[:, 0, 0] - T[:, 1, 1])).max() < 1e-15
    assert np.abs(T[:, 1, 3] + a * T[:, 0, 1]).max() < 1e-15


@both
def test_derivatives(tripod) -> None:
    module, *_ = tripod
    x = targets(2000, 5)
    found = module.ik(x)
    modes = found.q.shape[1]
    x = np.repeat(x, modes, axis=0)[found.status.ravel() == OK]
    branch = np.tile(np.arange(modes), 2000)[found.status.ravel() == OK]
    q, step = found.q[found.status == OK], 1e-6

    def at(moved: np.ndarray) -> np.ndarray:
        return module.ik(moved).q[np.arange(len(moved)), branch]

    sides = [(at(x + step * e), at(x - step * e)) for e in np.eye(3)]
    steps = np.stack([(after - before) / (2 * step) for after, before in sides], -1)
    K, B = module.jacobian_inverse(x, q), module.jacobian_serial(x, q)
    J, A = module.jacobian(x, q), module.jacobian_parallel(x, q)
    tame = (np.abs(K).max((-1, -2)) < 30) & np.isfinite(steps).all((-1, -2))
    assert tame.mean() > 0.5
    assert np.abs(steps - K)[tame].max() < 1e-4
    assert np.allclose(A[tame], B[tame, :, None] * K[tame])
    assert np.allclose(J[tame] @ K[tame], np.eye(3), atol=1e-9)
    assert np.allclose(module.determinant(x, q)[tame] * np.linalg.det(K[tame]), 1)
    factors = module.singularities(x, q)
    assert np.allclose(factors[:, :3], B) and np.allclose(factors[:, 3], np.linalg.det(A))


@both
def test_the_skeleton_keeps_its_lengths(tripod) -> None:
    module, _, corners = tripod
    x = targets(500, 6)
    found = module.ik(x)
    kept = found.status[:, 0] == OK
    points = module.skeleton(x[kept], found.q[kept, 0])
    at = dict(zip(module.SKELETON.points, np.moveaxis(points, -2, 0), strict=True))
    assert np.abs(at["P"] - module.hand_pose(x[kept])[:, :3, 3]).max() < 1e-15
    for k, other in ((0, 1), (1, 2), (2, 0)):
        gap = np.linalg.norm(at[f"C{k + 1}"] - at[f"C{other + 1}"], axis=-1)
        assert np.abs(gap - np.linalg.norm(corners[k] - corners[other])).max() < 1e-14
    rod = np.linalg.norm(at["C1"] - at["B1"], axis=-1)
    assert np.abs(rod - rod[0]).max() < 1e-14


def test_statuses(sprint: ModuleType) -> None:
    up, right = np.pi, np.pi / 2
    assert (sprint.ik([0, up, 0]).status == SINGULAR).all()  # upside down: the twist is free
    assert np.isin(sprint.ik([0, 0, up]).status, (SINGULAR, UNREACHABLE)).all()
    assert np.isin(sprint.ik([0, right, 0.3]).status, (SINGULAR, UNREACHABLE)).all()
    assert (sprint.ik([0.1, 0.2, 0.1]).status == OK).all()
    wide = sprint.Parameters(b=0.9, a=0.25, l=0.6)
    assert (sprint.ik([0, 0, 0], wide).status == UNREACHABLE).all()
    assert not sprint.workspace_contains([0, 0, 0], wide)
    flat = sprint.Parameters(b=0.85, a=0.25, l=0.6)  # rods at right angles to the columns
    assert (sprint.ik([0, 0, 0], flat).status != UNREACHABLE).all()
    assert sprint.workspace_contains([0, 0, 0], flat)


def test_the_printed_code_agrees_with_its_source(tmp_path: Path) -> None:
    """Also where the hand is upside down: there its pose is not accurate, and none is demanded."""
    for name, script in (("sprint", SPRINT), ("uneven", UNEVEN)):
        path = tmp_path / f"{name}.py"
        path.write_text(script, "utf-8")
        assert main(["derive", str(path), "-o", str(tmp_path / "out"), "--backend", "numpy"]) == 0
        report = (tmp_path / "out" / f"{name}-crosscheck.md").read_text("utf-8")
        assert "Nothing exceeds its tolerance." in report


def test_nearest_and_pictures(sprint: ModuleType) -> None:
    robot = Robot(sprint)
    x = np.array([0.1, 0.2, -0.3])
    q = sprint.ik(x).q[5]
    assert np.allclose(robot.nearest(x, q + 0.01).q, q)
    assert len(plot.branches(sprint, x).get_lines()) > 8
    assert plot.mechanism(sprint, q, x=x).name == plot.mechanism(sprint).name == "3d"


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("(0, 1), (0, a)", "(0, 1), (0, -b)", "uneven: the corners do not determine how"),
        ("away = Rational(-3, 5), Rational(-4, 5)", "away = (-1, 0)", "two legs are in the same"),
        ("away = Rational(-3, 5), Rational(-4, 5)", "away = (-1, -1)", "a unit vector"),
        ("Stretch(q3, (b, 0))", "Stretch(q3, (b, 0, 0))", "vectors need 2"),
        ("(1, 0), (0, 1))", "(1, 0, 0), (0, 0, 1))", "vectors need 2"),
        ("Upright(crank, (1, 0), (a, 0)),", "", "a tripod has three legs, not 2"),
        (
            '"Three legs.")',
            '"Three legs.", task=["x", "y", "z"])',
            "the task of a tripod must be z",
        ),
    ],
)
def test_refusals(old: str, new: str, said: str) -> None:
    assert old in UNEVEN
    with pytest.raises(ShapeError, match=said):
        read_script(UNEVEN.replace(old, new))


UNEVEN_FILE = """
hand = "P"
[bodies]
ground = {A = ["b", 0, 0], B = [0, "b", 0], C = ["-3/5*b", "-4/5*b", 0]}
arm = {E = ["b + l", 0, 0]}
rod1 = {length = "r"}
slider = {E = [0, "b", 0]}
rod2 = {length = "r"}
tube = {}
piston = {}
hand = {P = [0, 0, 0], C1 = ["a", 0, 0], C2 = [0, "a", 0], C3 = ["-c", "-c", 0]}
[joints]
theta1 = {between = ["ground", "arm"], at = "A", axis = [0, -1, 0], driven = true}
rho2.between = ["ground", "slider"]
rho2.at = "B"
rho2.kind = "prismatic"
rho2.axis = [0, 3, 4]
rho2.driven = true
q3 = {between = ["tube", "piston"], at = "C", kind = "prismatic", driven = true}
h1 = {between = ["arm", "rod1"], at = "E", axis = [0, 1, 0]}
h2 = {between = ["slider", "rod2"], at = "E", axis = [1, 0, 0]}
h3 = {between = ["ground", "tube"], at = "C", axis = [4, -3, 0]}
c1 = {between = ["rod1", "hand"], at = "C1", kind = "spherical"}
c2 = {between = ["rod2", "hand"], at = "C2", kind = "spherical"}
c3 = {between = ["piston", "hand"], at = "C3", kind = "spherical"}
"""


@pytest.mark.parametrize(("text", "original"), [(FROM_FILE, SPRINT), (UNEVEN_FILE, UNEVEN)])
def test_a_tripod_from_a_file_is_the_one_from_legs(
    text: str, original: str, tmp_path: Path
) -> None:
    """Equation by equation; only the parameters have other assumptions."""
    own, given = (read_script(s) for s in (script_of("loop", text, tmp_path), original))
    assert [f.name for f in own.functions] == [f.name for f in given.functions]
    names = {p.symbol: sp.Symbol(p.name) for d in (own, given) for p in d.parameters}
    first, second = ([e.xreplace(names) for e in d.inverses[0].forward] for d in (own, given))
    assert all(sp.simplify(a - b) == 0 for a, b in zip(first, second, strict=True))


def test_the_point_of_the_hand_may_be_beside_the_plane_of_the_corners(tmp_path: Path) -> None:
    text = FROM_FILE.replace('C1 = ["a", 0, 0]', 'C1 = ["a", 0, "-l/4"]')
    script = script_of("loop", text, tmp_path)
    assert text != FROM_FILE and "corner=(a, 0, -l/4)" in script


@pytest.mark.parametrize(
    ("old", "other", "said"),
    [
        (
            "axis = [0, 1, 0]}",
            'kind = "spherical"}',
            "four joints are driven, not 3.  With three, all legs",
        ),
        ("axis = [0, 1, 0]}", "axis = [0, 1, 1]}", "h1 keeps .* its axis is horizontal"),
        ("axis = [0, -1, 0], d", "axis = [0, -1, 1], d", "of theta1 and h1 have to be parallel"),
        ('"b + l", 0, 0', '"b + l", "l", 0', "has to contain the z axis"),
        (
            'C2 = [0, "a", 0]',
            'C2 = [0, "a", "a"]',
            "the rods on hand have to be at the same height in its frame",
        ),
    ],
)
def test_a_file_that_is_not_a_tripod_says_why(
    old: str, other: str, said: str, tmp_path: Path
) -> None:
    assert old in UNEVEN_FILE
    with pytest.raises(TableError, match=said):
        script_of("loop", UNEVEN_FILE.replace(old, other), tmp_path)
