"""A hand that turns on three rails (3-PPR): from a file, against its drawing."""

from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of

from closedform import Derivation, Paper, Rail, plot, real
from closedform.algebra.shapes import ShapeError
from closedform.check.crosscheck import crosscheck
from closedform.check.finding import module_backend
from closedform.loops.on_rails import on_rails
from closedform.robots import Robot

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
STAGE = """
hand = "P"
[parameters]
a = {value = "0.4", meaning = "from P to a pin"}
b = {value = "1", meaning = "from the centre to a guide"}
[bodies]
ground = {G1 = ["b", 0], G2 = ["-b/2", "sqrt(3)/2*b"], G3 = [0, "-b"]}
car1 = {S = ["b", 0]}
car2 = {S = ["-b/2", "sqrt(3)/2*b"]}
car3 = {S = [0, "-b"]}
block1 = {}
block2 = {}
block3 = {}
hand = {P = [0, 0], C1 = ["a", 0], C2 = ["-a/2", "sqrt(3)/2*a"], C3 = [0, "-a/2"]}
[joints]
s1 = {between = ["car1", "block1"], at = "S", kind = "prismatic", axis = [1, 0]}
s2 = {between = ["car2", "block2"], at = "S", kind = "prismatic", axis = [-1, "sqrt(3)"]}
s3 = {between = ["car3", "block3"], at = "S", kind = "prismatic", axis = [0, 1]}
c1 = {between = ["block1", "hand"], at = "C1"}
c2 = {between = ["block2", "hand"], at = "C2"}
c3 = {between = ["block3", "hand"], at = "C3"}
[joints.q1]
between = ["ground", "car1"]
at = "G1"
kind = "prismatic"
axis = [0, 1]
driven = true
[joints.q2]
between = ["ground", "car2"]
at = "G2"
kind = "prismatic"
axis = ["sqrt(3)", 1]
driven = true
[joints.q3]
between = ["ground", "car3"]
at = "G3"
kind = "prismatic"
axis = [4, 3]
driven = true
"""
WAYS = np.array([[1, 0], [-0.5, np.sqrt(0.75)], [0, 1]])
GUIDES = np.array([[0, 1], [np.sqrt(0.75), 0.5], [0.8, 0.6]])
PINS = 0.4 * np.array([[1, 0], [-0.5, np.sqrt(0.75)], [0, -0.5]])
STARTS = np.array([[1, 0], [-0.5, np.sqrt(0.75)], [0, -1]])


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> str:
    return script_of("stage3", STAGE, tmp_path_factory.mktemp("stage3"))


@pytest.fixture(scope="module")
def stage(script: str, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return derived("stage3", script, tmp_path_factory.mktemp("stage3"))


def off(q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The distances of the pins from their rails."""
    s, c = np.sin(x[..., 2]), np.cos(x[..., 2])
    R = np.stack([np.stack([c, -s], -1), np.stack([s, c], -1)], -2)
    pins = x[..., None, :2] + np.einsum("...ij,kj->...ki", R, PINS)
    gaps = pins - STARTS - q[..., None] * GUIDES
    return WAYS[:, 0] * gaps[..., 1] - WAYS[:, 1] * gaps[..., 0]


def postures(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * (0.5, 0.5, np.pi)


def test_all_postures_close_the_loop(stage: ModuleType) -> None:
    x = postures(100_000, 1)
    q, status = stage.ik(x)
    assert q.shape == (100_000, 1, 3) and np.isin(status, (OK, SINGULAR)).all()
    assert np.abs(off(q[:, 0], x)).max() < 1e-14
    kept = status[:, 0] == OK
    assert kept.mean() > 0.95
    found = stage.fk(q[kept, 0])
    gap = found.p - x[kept, None]
    gap[..., 2] = np.angle(np.exp(1j * gap[..., 2]))
    assert np.abs(gap).max(-1).min(-1).max() < 1e-12 * 1.4
    assert (found.status == OK).all()
    assert np.abs(found.p[..., 2]).max() <= np.pi
    assert np.abs(off(q[kept, None, 0], found.p)).max() < 1e-12


def test_newton_finds_two_modes(stage: ModuleType) -> None:
    rng, seen = np.random.default_rng(2), set()
    for q in stage.ik(postures(10, 3)).q[:, 0]:
        p = stage.fk(q).p
        for start in postures(20, int(rng.integers(1000))):
            x = newton(lambda x: off(q, x), start)  # noqa: B023
            if x is not None:
                gap = p - x
                gap[:, 2] = np.angle(np.exp(1j * gap[:, 2]))
                seen.add(int(np.abs(gap).max(-1).argmin()))
                assert np.abs(gap).max(-1).min() < 1e-6
    assert seen == {0, 1}


def test_where_the_hand_is_too_short(stage: ModuleType) -> None:
    """At the end of the reach both modes meet: SINGULAR there, UNREACHABLE beyond."""
    q = stage.ik(postures(2000, 4)).q[:, 0]
    far = q + 3 * (q - q[::-1])
    gone = (stage.fk(far).status[:, 0] == UNREACHABLE) & (stage.fk(q).status[:, 0] == OK)
    assert gone.sum() > 100
    low, high = q[gone], far[gone]
    for _ in range(60):
        there = stage.fk((low + high) / 2).status[:, :1] == OK
        low, high = np.where(there, (low + high) / 2, low), np.where(there, high, (low + high) / 2)
    found = stage.fk(low)
    assert np.abs(found.p[:, 0] - found.p[:, 1]).max() < 1e-5
    assert (stage.ik(found.p[:, 0]).status == SINGULAR).all()
    assert np.abs(off(low[:, None], found.p)).max() < 1e-11


def test_derivatives(stage: ModuleType) -> None:
    q = stage.ik(postures(500, 5)).q[:, 0]
    steps = 1e-6 * np.eye(3)
    rates = [(stage.fk(q + s).p - stage.fk(q - s).p) / 2e-6 for s in steps]
    J, expected = stage.jacobian(q), np.stack(rates, -1)
    tame = (np.abs(J).max((-1, -2)) < 20) & (np.abs(expected).max((-1, -2)) < 20)
    assert tame.mean() > 0.5
    np.testing.assert_allclose(J[tame], expected[tame], atol=1e-6)
    A, B = stage.jacobian_parallel(q), stage.jacobian_serial(q)
    np.testing.assert_allclose((A @ J)[tame], (B[..., None] * np.eye(3))[tame], atol=1e-10)
    np.testing.assert_allclose(np.linalg.det(A), stage.singularities(q)[..., 0], atol=1e-14)
    np.testing.assert_allclose(stage.determinant(q)[tame], np.linalg.det(J)[tame], rtol=1e-8)
    signs = [1 if mode == "plus" else -1 for mode in stage.ASSEMBLY_MODES]
    assert (stage.singularities(q)[..., 0] * signs >= 0).all()


def test_the_printed_code_agrees_with_its_source(script: str, stage: ModuleType) -> None:
    found = crosscheck(read_script(script), module_backend("numpy", stage))
    assert not [failure for f in found for failure in f.failures]


def test_the_skeleton_is_the_hand_on_its_rails(stage: ModuleType) -> None:
    q = stage.ik(postures(100, 6)).q[:, 0]
    x, points = stage.fk(q).p, stage.skeleton(q)
    at = dict(zip(stage.SKELETON.points, np.moveaxis(points, -2, 0), strict=True))
    s, c = np.sin(x[..., 2]), np.cos(x[..., 2])
    for k, (px, py) in enumerate(PINS, 1):
        pin = x[..., :2] + np.stack([c * px - s * py, s * px + c * py], -1)
        np.testing.assert_allclose(at[f"C{k}"][..., :2], pin, atol=1e-13)
        car = STARTS[k - 1] + q[:, k - 1, None] * GUIDES[k - 1]
        np.testing.assert_allclose(at[f"B{k}"][..., 0, :2], car, atol=1e-15)


def test_it_can_be_drawn_and_followed(stage: ModuleType) -> None:
    q = stage.ik([0.1, 0.2, 0.3]).q[0]
    assert np.allclose(Robot(stage).nearest([0.1, 0.2, 0.3], q).q, q)
    assert len(plot.mechanism(stage, q).get_lines()) > 3


def test_rails_that_hold_nothing_say_why() -> None:
    def toy() -> tuple[Derivation, list]:
        d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
        return d, [d.joint(f"q{k}", "prismatic") for k in range(3)]

    d, joints = toy()
    with pytest.raises(ShapeError, match="the three rails are parallel"):
        on_rails(d, [Rail(q, real("s"), (k, 0), (1, 0), (0, 1)) for k, q in enumerate(joints)])
    d, joints = toy()
    ways = [(1, 0), (0, 1), (0, 1)]
    with pytest.raises(ShapeError, match="it turns freely"):
        on_rails(
            d,
            [
                Rail(q, real("s"), (0, 0), way[::-1], way, on_hand=(2, 3))
                for q, way in zip(joints, ways, strict=True)
            ],
        )
