"""A hand on lines that motors turn (3-RPR, driven pivots): from a file, against its drawing."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import Derivation, Lever, Paper, Rail, on_levers
from closedform.algebra.shapes import ShapeError
from closedform.plot.robot import Robot
from closedform.scaffold.inputs.tables import TableError

OK, UNREACHABLE, SINGULAR, INVALID = range(4)
PIVOTS = (TESTS / "held_out_loops" / "three_rpr_pivots.toml").read_text("utf-8")
MIXED = """
hand = "P"
[bodies]
ground = {A = [0.4, 0], B = [-0.3, 0.2], G = [0, -0.4]}
lever1 = {A = [0.4, 0], S = [0.4, 0]}
lever2 = {B = [-0.3, 0.2]}
car = {S = [0, -0.4]}
block1 = {S = [0, 0], C = [0.05, 0.02]}
block2 = {}
block3 = {}
hand = {P = [0, 0], C = [0.15, 0], D = [-0.1, 0.1], E = [0, -0.1]}
[joints]
s1 = {between = ["lever1", "block1"], at = "S", kind = "prismatic", axis = [0, 1]}
s2 = {between = ["lever2", "block2"], at = "B", kind = "prismatic", axis = [0.6, 0.8]}
s3 = {between = ["car", "block3"], at = "S", kind = "prismatic", axis = [0, 1]}
c = {between = ["hand", "block1"], at = "C"}
d = {between = ["hand", "block2"], at = "D"}
e = {between = ["hand", "block3"], at = "E"}
t1 = {between = ["ground", "lever1"], at = "A", driven = true}
t2 = {between = ["ground", "lever2"], at = "B", driven = true}
q3 = {between = ["ground", "car"], at = "G", kind = "prismatic", axis = [1, 0], driven = true}
"""
"""Two lines turn, one moves along, and the pin of a block is beside its line."""
THIRDS = np.exp(2j * np.pi / 3 * np.arange(3))


def pivots(q: np.ndarray, x: np.ndarray) -> np.ndarray:
    """How far the pins are from their lines, in complex numbers."""
    pins = complex(x[0], x[1]) + 0.1 * THIRDS * np.exp(1j * x[2])
    seen = (pins - 0.5 * THIRDS) / THIRDS * np.exp(-1j * q)  # as each guide sees it
    return seen.imag + 0.03


def mixed(q: np.ndarray, x: np.ndarray) -> np.ndarray:
    pins = complex(x[0], x[1]) + np.array([0.15, -0.1 + 0.1j, -0.1j]) * np.exp(1j * x[2])
    first = (pins[0] - 0.4) * np.exp(-1j * q[0])
    second = (pins[1] - (-0.3 + 0.2j)) * np.exp(-1j * q[1]) / (0.6 + 0.8j)
    return np.array([first.real - 0.05, second.imag, pins[2].real - q[2]])


CASES = {
    "pivots": (PIVOTS, pivots, (np.pi, np.pi, np.pi), 8),
    "mixed": (MIXED, mixed, (np.pi, np.pi, 0.3), 4),
}


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    name, folder = f"levers_{request.param}", tmp_path_factory.mktemp("levers")
    toml, misses, most, modes = CASES[request.param]
    made = derived(name, script_of(name, toml, folder), folder, crosscheck=True)
    return made, misses, np.array(most), modes


def turning(robot: ModuleType) -> list[bool]:
    return [robot.SKELETON.joints[name].kind == "revolute" for name in robot.JOINTS]


def drawn(most: np.ndarray, count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (count, 3)) * most


def test_newton_finds_no_posture_that_the_closed_form_lacks(case: tuple) -> None:
    robot, misses, most, modes = case
    assert len(robot.ASSEMBLY_MODES) == 2 and len(robot.BRANCHES) == modes
    seen, solved = set(), set()
    for q in drawn(most, 40, 1):
        fk = robot.fk(q)
        for start in drawn(np.array([0.5, 0.5, np.pi]), 10, 2):
            x = newton(lambda x: misses(q, x), start)  # noqa: B023
            if x is None or np.abs(x[:2]).max() > 10:
                continue
            away = apart(fk.p, x, [False, False, True])
            assert np.nanmin(away) < 1e-6
            seen.add(int(np.nanargmin(away)))
            joints = newton(lambda q: misses(q, x), q + start)  # noqa: B023
            if joints is not None:
                gaps = apart(robot.ik(x).q, joints, turning(robot))
                assert np.nanmin(gaps) < 1e-6
                solved.add(int(np.nanargmin(gaps)))
    assert seen == {0, 1}
    assert len(solved) >= modes / 2


def test_no_posture_is_lost(case: tuple) -> None:
    """Also where lines are parallel, or nearly so."""
    robot, misses, most, _ = case
    rng = np.random.default_rng(3)
    hostile = rng.integers(-6, 7, (10_000, 3)) * np.pi / 6
    hostile += rng.choice([0, 1e-12, 1e-9, 1e-6, 1e-3], (10_000, 3))
    q = np.where(turning(robot), hostile, drawn(most, 10_000, 4))
    for joints in (drawn(most, 10_000, 5), q):
        fk = robot.fk(joints)
        found = fk.status == OK
        assert found.sum() > 1000
        x = fk.p[found]
        back = robot.ik(x)
        assert np.isin(back.status, (OK, SINGULAR)).any(axis=1).all()
        good = back.status == OK
        again = robot.fk(back.q)
        gap = again.p - x[:, None, None]
        gap[..., 2] = np.angle(np.exp(1j * gap[..., 2]))
        size = 1.5 + np.abs(x).max(-1)[:, None]
        worst = np.nanmin(np.abs(gap).max(-1), axis=-1) / size
        assert worst[good].max() < 1e-12
        for k in np.flatnonzero(good.any(1))[:200]:
            for answer in back.q[k][good[k]]:
                assert np.abs(misses(answer, x[k])).max() < 1e-12 * size[k]


def test_the_jacobian_is_the_derivative(case: tuple) -> None:
    robot, _, most, _ = case
    q = drawn(most, 400, 6)
    J, fk = robot.jacobian(q), robot.fk(q)
    good = (fk.status == OK) & (np.abs(J).max((-1, -2)) < 20)
    assert good.sum() > 50
    for k, step in enumerate(1e-6 * np.eye(3)):
        rate = robot.fk(q + step).p - robot.fk(q - step).p
        rate[..., 2] = np.angle(np.exp(1j * rate[..., 2]))
        assert np.allclose((rate / 2e-6)[good], J[good][..., k], atol=1e-5, rtol=1e-4)


def test_the_signs_of_the_determinant_name_the_modes(case: tuple) -> None:
    robot, _, most, _ = case
    q = drawn(most, 400, 7)
    whole = (robot.fk(q).status == OK).all(axis=1)
    signs = np.sign(robot.singularities(q)[whole][..., -1])
    assert whole.sum() > 20 and np.array_equal(np.unique(signs, axis=0), [[1, -1]])


def test_parallel_lines_are_singular(case: tuple) -> None:
    robot, _, _, _ = case
    turned = {"pivots": -np.angle(THIRDS), "mixed": [0, np.arctan2(0.6, 0.8), 0]}
    q = np.array(turned[robot.__name__.split("_")[-1]])
    fk = robot.fk(q)
    assert np.isin(fk.status, (SINGULAR, UNREACHABLE)).all()


@pytest.mark.filterwarnings("error")
def test_it_is_drawn_in_a_posture_that_closes(case: tuple) -> None:
    robot, *_ = case
    assert OK in robot.fk(Robot.of(robot).posture()).status


def test_what_cannot_be_says_why(tmp_path: Path) -> None:
    with pytest.raises(TableError, match="say in which direction with axis"):
        script_of("t", PIVOTS.replace(", axis = [-1, 0]", ""), tmp_path)
    d = Derivation("t", "T", Paper("t", "T", ("x",)), "A test.")
    q, s = (
        [d.joint(f"{n}{k}", kind) for k in "123"]
        for n, kind in (("q", "revolute"), ("s", "prismatic"))
    )
    levers = [
        Lever(a, b, (k, 0), (1, 0), (0, 1)) for k, (a, b) in enumerate(zip(q, s, strict=True))
    ]
    with pytest.raises(ShapeError, match="needs 3 legs"):
        on_levers(d, levers[:2])
    d.joints[:] = d.joints[:3]
    with pytest.raises(ShapeError, match="the same point of the hand"):
        on_levers(d, levers)
    rails = [Rail(a, b, (0, 0), (1, 0), (0, 1)) for a, b in zip(q, s, strict=True)]
    with pytest.raises(ShapeError, match="those of on_rails"):
        on_levers(d, rails)
