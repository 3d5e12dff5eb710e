"""Hands that turn: the stage and the hexapod of the guide, against their drawings."""

import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, read_script, script_of
from places import ROOT

from closedform import Crank, Derivation, Paper, Slide, Stretch, Strut, platform, plot, prove
from closedform.algebra.shapes import ShapeError
from closedform.check.crosscheck import crosscheck
from closedform.check.finding import Backend, module_backend
from closedform.check.values import check_forward
from closedform.loops.platform_legs import Platform, counted_degree
from closedform.model.tolerances import DOUBLE
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

GUIDE = (ROOT / "docs" / "closed-loops.md").read_text("utf-8")
[STAGE] = re.findall(r"```toml stage.toml\n(.*?)```", GUIDE, re.DOTALL)
[HEXAPOD] = re.findall(r"```python hexapod.py\n(.*?)```", GUIDE, re.DOTALL)
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
SIDES = np.exp(2j * np.pi / 3 * np.arange(3))


@pytest.fixture(scope="module")
def stage(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("stage")
    return derived("stage", script_of("stage", STAGE, folder), folder)


@pytest.fixture(scope="module")
def hexapod(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("hexapod", HEXAPOD, tmp_path_factory.mktemp("hexapod"))


# In a plane, in complex numbers


def ends(stage: ModuleType, x: np.ndarray, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The ends of the cranks and those of the rods on the hand."""
    b, a, l, _ = stage.Parameters()
    hand = x[..., :1] + 1j * x[..., 1:2] + a * SIDES * np.exp(1j * x[..., 2:])
    return b * SIDES + l * np.exp(1j * q), hand


def nearest(answers: np.ndarray, q: np.ndarray) -> np.ndarray:
    apart = np.abs(np.angle(np.exp(1j * (answers - q[..., None, :])))).max(-1)
    return np.where(np.isnan(apart), np.inf, apart).min(-1)


def test_all_working_modes_of_random_poses(stage: ModuleType) -> None:
    """The triangle of a leg says by its angle where the crank is."""
    b, _, l, r = stage.Parameters()
    rng = np.random.default_rng(1)
    x = rng.uniform(-1, 1, (300_000, 3)) * (0.15, 0.15, 1.0)
    _, hand = ends(stage, x, np.zeros(3))
    reach = hand - b * SIDES
    cosine = (np.abs(reach) ** 2 + l**2 - r**2) / (2 * l * np.abs(reach))
    reached = np.all(np.abs(cosine) < 1, -1)
    found = stage.ik(x)
    assert (found.status[~reached] == UNREACHABLE).all()
    assert np.isnan(found.q[~reached]).all()
    assert reached.sum() > 100_000
    modes = rng.choice([-1, 1], x.shape)
    q = (np.angle(reach) + modes * np.arccos(np.clip(cosine, -1, 1)))[reached]
    assert np.isin(found.status[reached], (OK, SINGULAR)).all()
    assert (found.status[reached] == OK).mean() > 0.95
    assert nearest(found.q[reached], q).max() < 1e-6
    near, far = ends(stage, x[reached][:, None], found.q[reached])
    assert np.abs(np.abs(far - near) - r).max() < 1e-14
    assert (np.array([stage.workspace_contains(row) for row in x[:200]]) == reached[:200]).all()


def test_postures_at_the_end_of_the_reach_are_kept(stage: ModuleType) -> None:
    """Crank and rod in line, at lengths that fit the pose: both modes of the leg coincide."""
    b, a, l, _ = stage.Parameters()
    x = np.random.default_rng(2).uniform(-1, 1, (20_000, 3)) * (0.2, 0.2, np.pi)
    _, hand = ends(stage, x, np.zeros(3))
    reach = (hand - b * SIDES)[:, 0]
    for sign in (1, -1):
        rod = np.abs(reach - sign * l * reach / np.abs(reach))
        found = stage.ik(x, stage.Parameters(b, a, l, rod))
        first = np.where(found.status == UNREACHABLE, np.nan, found.q[..., 0])
        seen = np.isfinite(first).any(1)
        off = np.abs(np.exp(1j * first) - sign * (reach / np.abs(reach))[:, None])
        assert seen.mean() > 0.05
        assert np.nanmax(off[seen]) < 1e-6


def test_newton_finds_no_posture_that_the_closed_form_lacks(stage: ModuleType) -> None:
    rng, r = np.random.default_rng(3), stage.Parameters().r
    x = np.array([0.02, -0.03, 0.4])
    answers, count = stage.ik(x).q, 0
    for q in rng.uniform(-np.pi, np.pi, (200, 3)):
        for _ in range(60):
            near, far = ends(stage, x, q)
            rod = far - near
            slope = -2 * (rod.conj() * 1j * np.exp(1j * q)).real * stage.Parameters().l
            miss = np.abs(rod) ** 2 - r**2
            if np.abs(miss).max() < 1e-15:
                count += 1
                assert nearest(answers, q) < 1e-6
                break
            q = q - np.clip(miss / slope, -1, 1)
    assert count > 150


def test_the_jacobians_are_derivatives(stage: ModuleType) -> None:
    rng, h = np.random.default_rng(4), 1e-6
    x = rng.uniform(-1, 1, (500, 3)) * (0.1, 0.1, 0.5)
    q, status = stage.ik(x)
    well = (np.abs(stage.singularities(x[:, None], q)) > 1e-4).all(-1) & (status == OK)
    assert well.sum() > 300
    K = stage.jacobian_inverse(x[:, None], q)
    for k in range(3):
        step = h * np.eye(3)[k]
        up, down = stage.ik(x + step).q, stage.ik(x - step).q
        rate = np.angle(np.exp(1j * (up - down))) / (2 * h)
        assert np.abs(rate - K[..., k])[well].max() < 1e-3 * np.abs(K[well]).max()
    A, B = stage.jacobian_parallel(x[:, None], q), stage.jacobian_serial(x[:, None], q)
    J = stage.jacobian(x[:, None], q)
    assert np.allclose((A @ J)[well], (B[..., None] * np.eye(3))[well], atol=1e-12)
    assert np.allclose((J @ K)[well], np.eye(3), atol=1e-8)
    assert np.allclose(stage.determinant(x[:, None], q)[well], np.linalg.det(J[well]), rtol=1e-8)
    factors = stage.singularities(x[:, None], q)
    assert np.allclose(factors[well][:, 3], np.linalg.det(A[well]), atol=1e-15)
    signs = [[-1 if s == "minus" else 1 for s in b.split("_")] for b in stage.BRANCHES]
    assert (np.sign(B[well]) == np.broadcast_to(signs, B.shape)[well]).all()


def test_rods_through_one_point_are_singular(stage: ModuleType) -> None:
    """At yaw = 0 in the centre all rods of one symmetric mode point to P or away from it."""
    b, a, l, _ = stage.Parameters()
    fitting = stage.Parameters(b, a, l, b - l - a)  # stretched inwards
    found = stage.ik([0.0, 0.0, 0.0], fitting)
    assert (found.status == SINGULAR).all()
    assert np.allclose(np.exp(1j * found.q), -SIDES, atol=1e-6)
    turned = stage.ik([0.0, 0.0, 0.3])
    for q, status in zip(*turned, strict=True):
        value = stage.singularities([0.0, 0.0, 0.3], q)[3]
        near, far = ends(stage, np.array([0.0, 0.0, 0.3]), q)
        A = np.stack([(far - near).real, (far - near).imag, (far.conj() * (far - near)).imag], 1)
        assert np.isclose(value, np.linalg.det(A), atol=1e-16)
        assert status == OK


@pytest.mark.parametrize(
    "name", ["jacobian", "jacobian_inverse", "jacobian_parallel", "singularities", "determinant"]
)
def test_a_wrong_value_is_found(stage: ModuleType, tmp_path: Path, name: str) -> None:
    """Also where poses and joints that are drawn apart come close to a pole."""
    d = read_script(script_of("stage", STAGE, tmp_path))

    def lookup(asked: str) -> Callable:
        original = getattr(stage, asked)
        return (lambda *a: original(*a) * (1 + 1e-11)) if asked == name else original

    assert not check_forward(d, d[name], module_backend("numpy", stage)).failures
    assert check_forward(d, d[name], Backend("broken", lookup, np.float64, DOUBLE)).failures


MIXED = """
from sympy import Rational
from closedform import Crank, Derivation, Paper, Slide, Stretch, platform
d = Derivation("mixed", "Mixed", Paper("toy", "Toys", ("A. Nonymous",)), "Three kinds of legs.")
r = d.parameter("r", value=2, unit="m", meaning="rod", source="an example")
q = d.joint("q1"), d.joint("q2", "prismatic"), d.joint("q3", "prismatic")
u, v = (Rational(3, 5), Rational(4, 5)), (Rational(-4, 5), Rational(3, 5))
a = Rational("0.7"), Rational("-0.2")
platform(
    d,
    [
        Crank(q[0], Rational("0.8"), r, (0, 0), u, v, on_hand=a),
        Slide(q[1], r, (1, Rational("0.1")), u, on_hand=(Rational("-0.3"), Rational("0.4"))),
        Stretch(q[2], (Rational("-0.5"), 2), on_hand=(Rational("0.1"), Rational("0.9"))),
    ],
)
"""
SLIDERS = re.sub(
    r'crank(\d) = {B\d = \["\S+ [-+] \S+", (\S+)\]}',
    r'crank\1 = {B\1 = ["\1*l", \2]}',
    STAGE.replace('", driven', '", kind = "prismatic", axis = [0, 1], driven'),
)


@pytest.mark.parametrize("name", ["mixed", "sliders"])
def test_the_crosscheck_of_other_legs(name: str, tmp_path: Path) -> None:
    script = MIXED if name == "mixed" else script_of("sliders", SLIDERS, tmp_path)
    robot = derived(name, script, tmp_path)
    found = crosscheck(read_script(script), module_backend("numpy", robot))
    assert not [failure for f in found for failure in f.failures]
    assert len(robot.BRANCHES) == {"mixed": 4, "sliders": 8}[name]


# In space


def poses(rng: np.random.Generator, rows: int) -> np.ndarray:
    found = np.tile(np.eye(4), (rows, 1, 1))
    turned = np.linalg.qr(rng.normal(size=(rows, 3, 3)))[0]
    found[:, :3, :3] = turned * np.linalg.det(turned)[:, None, None]
    found[:, :3, 3] = rng.normal(size=(rows, 3))
    return found


def points(hexapod: ModuleType) -> tuple[np.ndarray, np.ndarray]:
    """On the base and on the hand: each pair is on a line at right angles to its side."""
    b, c, g, h = hexapod.Parameters()
    ways = [(v.real, v.imag, 0.0) for v in SIDES for _ in range(2)]
    sideways = [s * np.array([-v.imag, v.real, 0.0]) for v in SIDES for s in (1, -1)]
    return b * np.array(ways) + g * np.array(sideways), c * np.array(ways) + h * np.array(sideways)


def test_legs_are_as_long_as_the_ends_are_apart(hexapod: ModuleType) -> None:
    T = poses(np.random.default_rng(5), 100_000)
    base, hand = points(hexapod)
    rods = np.einsum("nij,kj->nki", T[:, :3, :3], hand) + T[:, None, :3, 3] - base
    q, status = hexapod.ik(T)
    assert q.shape == (len(T), 1, 6)
    assert np.abs(q[:, 0] - np.linalg.norm(rods, axis=-1)).max() < 1e-14
    assert (status != UNREACHABLE).all()
    assert (status == OK).mean() > 0.8
    rows = np.concatenate([rods, np.cross(rods + base - T[:, None, :3, 3], rods)], axis=-1)
    assert np.allclose(hexapod.jacobian_parallel(T, q[:, 0]), rows, atol=1e-13)
    values = hexapod.singularities(T, q[:, 0])
    assert np.allclose(values[:, :6], q[:, 0])
    assert np.allclose(values[:, 6], np.linalg.det(rows), rtol=1e-9, atol=1e-9)


def test_the_inverse_jacobian_of_a_twist(hexapod: ModuleType) -> None:
    rng, h = np.random.default_rng(6), 1e-6
    T = poses(rng, 200)
    twist = rng.normal(size=(200, 6))
    x, y, z = twist[:, 3:].T
    o = 0 * x
    turning = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)
    moved = []
    for t in (h, -h):
        after = T.copy()
        rotation = np.eye(3) + t * turning + t**2 / 2 * turning @ turning
        after[:, :3, :3] = rotation @ T[:, :3, :3]
        after[:, :3, 3] += t * twist[:, :3]
        moved.append(hexapod.ik(after).q[:, 0])
    K = hexapod.jacobian_inverse(T, hexapod.ik(T).q[:, 0])
    rates = np.einsum("nij,nj->ni", K, twist)
    assert np.abs((moved[0] - moved[1]) / (2 * h) - rates).max() < 1e-7


def test_a_hexapod_turned_by_a_right_angle_is_singular(hexapod: ModuleType) -> None:
    """Fichter's singularity: the platform is parallel to the base and turned by 90 degrees."""
    T = np.eye(4)
    T[2, 3] = 0.7
    assert hexapod.ik(T).status == [OK]
    T[:2, :2] = [[0, -1], [1, 0]]
    assert hexapod.ik(T).status == [SINGULAR]
    T[:3, :3] = np.eye(3)
    T[2, 3] = 0
    assert hexapod.ik(T).status == [SINGULAR]
    T[0, 0] = 1.1
    assert hexapod.ik(T).status == [INVALID]
    assert np.isnan(hexapod.ik(T).q).all()


def a_derivation(joints: int, kind: str = "revolute") -> tuple[Derivation, list]:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    return d, [d.joint(f"q{k + 1}", kind) for k in range(joints)]


def test_six_cranks_have_sixty_four_working_modes() -> None:
    d, joints = a_derivation(6)
    bases = [(0, 0), (3, 0), (5, 2), (4, 5), (1, 5), (-1, 3)]
    hands = [(-1, 0), (1, 0), (1, 1), (0, 2), (-1, 2), (-2, 1)]
    platform(
        d,
        [
            Crank(q, 1, 4, pivot=(*b, 0), along=(1, 0, 0), across=(0, 0, 1), on_hand=(*c, 0))
            for q, b, c in zip(joints, bases, hands, strict=True)
        ],
    )
    (ik,) = prove(d).inverses
    assert ik.solutions == 64 == len(d.branches)


@pytest.mark.parametrize(
    ("hand", "degree"),
    [
        (((0, 0), (1, 0), (0, 1)), 6),
        (((0, 0), (1, 0), (2, 0)), 6),
        (((0, 0), (0, 0), (1, 0)), 4),
    ],
)
def test_the_degree_of_the_forward_problem_is_counted(hand: tuple, degree: int) -> None:
    """Two legs that meet in a point fix it first; then the third one gives two turns each."""
    d, joints = a_derivation(3, "prismatic")
    bases = ((0, 0), (3, 0), (1, 4))
    legs = [Stretch(q, b, on_hand=c) for q, b, c in zip(joints, bases, hand, strict=True)]
    assert counted_degree(Platform(d, tuple(legs))) == degree


def test_legs_that_do_not_fit_say_why() -> None:
    d, joints = a_derivation(3)
    legs = [Stretch(q, (k, 0), on_hand=(k, 1)) for k, q in enumerate(joints)]
    with pytest.raises(ShapeError, match="in space it has six, or four"):
        platform(d, legs[:2])
    with pytest.raises(ShapeError, match="give the legs in this order"):
        platform(d, legs[::-1])
    with pytest.raises(ShapeError, match="a strut cannot carry"):
        platform(d, [Strut(1, (0, 0)), *legs[1:]])
    with pytest.raises(ShapeError, match="it turns freely"):
        platform(d, [Slide(q, 2, (k, 0), (0, 1)) for k, q in enumerate(joints)])
    d.task = ["x", "y"]
    with pytest.raises(ShapeError, match="the task of this hand must be x, y, yaw"):
        platform(d, legs)


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('theta3 = {between = ["ground", "crank3"], at = "A3", driven = true}',
         'theta3 = {between = ["ground", "crank3"], at = "A3"}',
         "no leg contains theta3, b3 and c3;"),
        ('rod1 = {length = "r"}', 'rod1 = {length = "r", parallelogram = [0, "r"]}',
         "the parallelogram rod1 keeps it from turning"),
        ("theta1 =", "yaw =", "yaw is a coordinate of the hand; give the joint another name"),
        ("theta1 =", "x =", "x is a coordinate of the hand; give the joint another name"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        script_of("stage", STAGE.replace(old, other), tmp_path)


def test_an_array_of_lengths(stage: ModuleType) -> None:
    rods = np.array([0.16, 0.18, 0.2])
    whole = stage.ik([0.01, 0.0, 0.1], stage.Parameters()._replace(r=rods))
    for k, r in enumerate(rods):
        alone = stage.ik([0.01, 0.0, 0.1], stage.Parameters()._replace(r=r))
        assert np.array_equal(whole.q[k], alone.q)


# After the import


def test_the_skeleton_keeps_its_lengths(stage: ModuleType) -> None:
    x = np.array([0.02, -0.03, 0.2])
    q = stage.ik(x).q
    points = dict(zip(stage.SKELETON.points, np.moveaxis(stage.skeleton(x, q), -2, 0), strict=True))
    near, far = ends(stage, x, q)
    assert np.allclose(points["P"], [*x[:2], 0])
    for k in range(3):
        assert np.allclose(
            points[f"B{k + 1}"][..., 0] + 1j * points[f"B{k + 1}"][..., 1], near[:, k]
        )
        assert np.allclose(
            points[f"C{k + 1}"][..., 0] + 1j * points[f"C{k + 1}"][..., 1], far[..., k]
        )
    assert set(stage.SKELETON.joints) == {"theta1", "theta2", "theta3"}


def test_the_nearest_posture_of_a_hand_that_turns(stage: ModuleType, hexapod: ModuleType) -> None:
    """Also where the joints do not determine the hand."""
    x = [0.02, -0.03, 0.2]
    q = stage.ik(x).q
    assert [int(Robot(stage).nearest(x, row + 0.01).branch) for row in q] == [*range(8)]
    T = np.eye(4)
    T[:2, :2], T[2, 3] = [[0, -1], [1, 0]], 0.7
    found = Robot(hexapod).nearest(T, np.ones(6))
    assert found.status == SINGULAR
    assert np.array_equal(found.q, hexapod.ik(T).q[0])
    with pytest.raises(ValueError, match="hexapod has no function fk"):
        Robot(hexapod).fk(np.ones(6))


def test_a_path_keeps_its_working_mode(stage: ModuleType) -> None:
    s = np.linspace(0, 1, 50)
    xs = np.stack([0.04 * np.cos(6 * s), 0.04 * np.sin(6 * s), 0.3 * s], 1)
    for k, q in enumerate(stage.ik(xs[0]).q):
        found = Robot(stage).track(xs, q)
        assert (found.status == OK).all()
        assert (found.branch == k).all()
        assert np.abs(np.diff(found.q, axis=0)).max() < 0.05


def test_it_can_be_drawn(stage: ModuleType, hexapod: ModuleType) -> None:
    assert len(plot.branches(stage).figure.axes) == 8
    assert plot.branches(hexapod).figure is not None
    x = np.array([0.02, -0.03, 0.2])
    ax = plot.mechanism(stage, stage.ik(x).q[3], x=x)
    drawn = np.vstack([line.get_xydata() for line in ax.get_lines()])
    for point in stage.skeleton(x, stage.ik(x).q[3])[:, :2]:
        assert np.min(np.linalg.norm(drawn - point, axis=1)) < 1e-9
    with pytest.raises(ValueError, match="in no branch"):
        plot.mechanism(stage, x=[9, 9, 0])
    with pytest.raises(ValueError, match="no fk: its joints show no posture without the target x"):
        plot.mechanism(stage, stage.ik(x).q[3])


def test_its_workspace_is_a_section_of_its_targets(stage: ModuleType) -> None:
    ax = plot.workspace(stage, at=[0.0, 0.0, 0.2], resolution=60)
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("$x$", "$y$")
    shown = ax.collections[0].get_array().reshape(60, 60)
    targets = np.stack(
        [*np.meshgrid(*(np.linspace(*e, 60) for e in (ax.get_xlim(), ax.get_ylim())))], -1
    )
    counted = (stage.ik(np.insert(targets, 2, 0.2, axis=-1)).status == OK).sum(-1)
    assert np.mean(np.ma.filled(shown, 0) != counted) < 0.02
    with pytest.raises(ValueError, match="the plane of stage must be two of x, y, not theta1"):
        plot.singularities(stage, ("theta1", "theta2"))


def test_three_legs_that_meet_in_a_point_are_told_of() -> None:
    d, joints = a_derivation(6, "prismatic")
    bases = [(0, 0, 0), (3, 0, 0), (1, 4, 0), (5, 2, 0), (4, 5, 1), (1, 6, 0)]
    hands = [(0, 0, 0)] * 3 + [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    ends = zip(joints, bases, hands, strict=True)
    platform(d, [Stretch(q, b, on_hand=c) for q, b, c in ends])
    step = next(s for s in d.steps if s.title == "Forward: an equation of degree at most 16")
    assert "end in the same point of the hand, which follows from their equations" in step.reason


def test_legs_that_start_in_a_point_of_the_ground_have_a_lower_degree() -> None:
    """As many as end in a point of the hand: the article said that the degree is 40."""
    d, joints = a_derivation(6, "prismatic")
    hands = [(0, 0, 0), (3, 0, 0), (1, 4, 0), (5, 2, 0), (4, 5, 1), (1, 6, 0)]
    bases = [(0, 0, 0)] * 2 + [(5, 0, 0)] * 2 + [(0, 5, 0)] * 2
    ends = zip(joints, bases, hands, strict=True)
    platform(d, [Stretch(q, b, on_hand=c) for q, b, c in ends])
    assert any(s.title == "Forward: an equation of degree 16" for s in d.steps)
