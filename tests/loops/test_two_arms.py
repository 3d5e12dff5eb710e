"""A hand that two arms and a rod hold: the upright of a suspension, and its steering.

A strut in which the hand slides may take the place of the second arm.
"""

from pathlib import Path

import numpy as np
import pytest
from loop_files import derived, newton, script_of
from places import TESTS

from closedform.algebra.shapes import ShapeError
from closedform.plot.robot import Robot
from closedform.scaffold.inputs.tables import TableError

SUSPENSION = (TESTS / "held_out_loops" / "double_wishbone.toml").read_text("utf-8")
STRUT = (TESTS / "held_out_loops" / "macpherson_strut.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
WITH_SLIDER = """
hand = "B"
[parameters]
r = {value = "0.4", meaning = "arm"}
h = {value = "0.3", meaning = "from ball to ball"}
[bodies]
ground = {O = [0, 0, 0], U = [0.1, 0.5, 0], R = [0.4, 0, 0.2]}
slider = {B = [0, 0.1, 0]}
arm = {U = [0.1, 0.5, 0], C = [0.1, "0.5 + r", 0.1]}
hand = {B = [0, 0, 0], C = ["h", 0, 0], T = [0, "h/2", 0.1]}
rod = {length = 0.5}
[joints]
q = {between = ["ground", "slider"], at = "O", kind = "prismatic", axis = [0, 0, 1], driven = true}
a = {between = ["ground", "arm"], at = "U", axis = [0, 0, 1]}
b = {between = ["slider", "hand"], at = "B", kind = "spherical"}
c = {between = ["arm", "hand"], at = "C", kind = "spherical"}
t = {between = ["rod", "hand"], at = "T", kind = "spherical"}
n = {between = ["ground", "rod"], at = "R", kind = "spherical"}
"""
"""A slider instead of the driven arm, and the hand is its ball."""


def suspension(q: np.ndarray, T: np.ndarray, turn: float) -> np.ndarray:
    """By how much the hand misses the balls, and the rod its length, at an angle of the arm."""
    b = [0, 0.25 + 0.35 * np.cos(q[0]), 0.35 * np.sin(q[0])]
    c = [0.01, 0.3 + 0.25 * np.cos(turn), 0.2 + 0.25 * np.sin(turn)]
    ends = np.array([[0, -0.02, -0.12], [-0.01, -0.06, 0.12], [0.13, -0.03, 0.02]])
    return missed(T, ends, np.array([b, c]), np.array([0.12, 0.28 + q[1], 0.04]), 0.31)


def with_slider(q: np.ndarray, T: np.ndarray, turn: float) -> np.ndarray:
    c = [0.1 - 0.4 * np.sin(turn), 0.5 + 0.4 * np.cos(turn), 0.1]
    ends = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.15, 0.1]])
    return missed(T, ends, np.array([[0, 0.1, q[0]], c]), np.array([0.4, 0, 0.2]), 0.5)


def on_strut(q: np.ndarray, T: np.ndarray, slid: float) -> np.ndarray:
    way = np.array([-0.05, -0.15, 1]) / np.linalg.norm([-0.05, -0.15, 1])
    b = [0.01, 0.3 + 0.35 * np.cos(q[0]), 0.35 * np.sin(q[0])]
    ends = np.array([[0, -0.06, -0.1], slid * way + [0, -0.1, 0.12], [-0.13, -0.07, -0.03]])
    balls = np.array([b, [-0.03, 0.52, 0.65]])
    return missed(T, ends, balls, np.array([-0.14, 0.3 + q[1], 0.06]), 0.38)


def missed(
    T: np.ndarray, ends: np.ndarray, balls: np.ndarray, near: np.ndarray, rod: float
) -> np.ndarray:
    places = ends @ T[:3, :3].T + T[:3, 3]
    return np.array([*(places[:2] - balls).flat, np.linalg.norm(places[2] - near) - rod])


CASES = {
    "suspension": (SUSPENSION, suspension, (0.6, 0.05)),
    "slider": (WITH_SLIDER, with_slider, (0.3,)),
    "strut": (STRUT, on_strut, (0.5, 0.06)),
}


@pytest.fixture(scope="module", params=CASES)
def case(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple:
    name, folder = f"two_arms_{request.param}", tmp_path_factory.mktemp("two_arms")
    toml, loop, most = CASES[request.param]
    return derived(name, script_of(name, toml, folder), folder), loop, np.array(most)


def drawn(most: np.ndarray, rows: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1, 1, (rows, len(most))) * most


def placed(x: np.ndarray) -> np.ndarray:
    """A pose from a position and a vector along the axis, as long as the angle."""
    angle = np.linalg.norm(x[3:6])
    a, b, c = x[3:6] / angle
    W = np.array([[0, -c, b], [c, 0, -a], [-b, a, 0]])
    R = np.eye(3) + np.sin(angle) * W + (1 - np.cos(angle)) * W @ W
    return np.block([[R, x[:3, None]], [np.zeros(3), 1]])


def test_the_modes_are_all_postures(case: tuple) -> None:
    """Newton's method on the balls and the rod finds most of them, and no other."""
    robot, loop, most = case
    assert len(robot.ASSEMBLY_MODES) == 4
    rng, hits, several = np.random.default_rng(2), 0, 0
    for q in drawn(most, 6, 1):
        fk = robot.fk(q)
        there, found = fk.p[fk.status == OK], set()
        several += len(there)
        for start in rng.uniform(-2, 2, (30, 7)):
            x = newton(lambda x: loop(q, placed(x), x[6]), start)  # noqa: B023
            if x is not None:
                away = np.abs(there - placed(x)).max((1, 2))
                assert away.min() < 1e-6, (q, x)
                found.add(int(away.argmin()))
        hits += len(found)
    assert several >= 16
    assert hits > 0.6 * several


def test_the_jacobian_is_the_derivative(case: tuple) -> None:
    robot, _, most = case
    q = drawn(most, 200, 3)
    J, fk = robot.jacobian(q), robot.fk(q)
    good = (fk.status == OK) & (np.abs(J).max((-1, -2)) < 20)
    assert good.sum() > 100
    for k, step in enumerate(1e-6 * np.eye(len(most))):
        rate = (robot.fk(q + step).p - robot.fk(q - step).p) / 2e-6
        W = rate[..., :3, :3] @ fk.p[..., :3, :3].swapaxes(-1, -2)
        turns = [W[..., 2, 1], W[..., 0, 2], W[..., 1, 0]]
        twist = np.stack([*np.moveaxis(rate[..., :3, 3], -1, 0), *turns], -1)
        assert np.allclose(twist[good], J[good][:, :, k], atol=1e-5, rtol=1e-5)


def test_the_signs_of_the_factors_name_the_modes(case: tuple) -> None:
    robot, _, most = case
    q = drawn(most, 200, 4)
    whole = (robot.fk(q).status == OK).all(axis=1)
    assert whole.sum() > 20
    (modes,) = np.unique(np.sign(robot.singularities(q)[whole]), axis=0)
    assert len(np.unique(modes, axis=0)) == 4


@pytest.mark.filterwarnings("error")
def test_it_is_drawn_in_a_posture_that_closes(case: tuple) -> None:
    robot, _, _ = case
    assert OK in robot.fk(Robot.of(robot).posture()).status


def test_what_cannot_be_says_why(case: tuple) -> None:
    robot, _, most = case
    assert np.all(robot.fk(most * np.nan).status == INVALID)
    far = robot.Parameters(**{robot.Parameters._fields[0]: 50})
    assert np.all(robot.fk(0 * most, far).status == UNREACHABLE)


BESIDE = """
hand = "P"
[parameters]
a = {value = "-0.1", meaning = "top"}
b = {value = "-0.5", meaning = "top"}
c = {value = "-0.6", meaning = "top"}
t = {value = "0.38", meaning = "rod"}
[bodies]
ground = {L = [0, 0.3, 0], T = ["-a", "-b", "-c"], R = [-0.15, 0.3, 0.05]}
arm = {B = [0, 0.7, 0]}
tie = {length = "t"}
strut = {S = [0, 0, 0], T = [0, 0.05, 0.2]}
knuckle = {P = [0, 0, 0], B = [0, -0.05, -0.1], N = [0, 0.1, -0.15], S = [0, -0.15, 0.1]}
[joints]
q = {between = ["ground", "arm"], at = "L", axis = [1, 0, 0], driven = true}
t0 = {between = ["ground", "strut"], at = "T", kind = "spherical"}
s = {between = ["strut", "knuckle"], at = "S", kind = "prismatic", axis = [0, 0, 1]}
k = {between = ["arm", "knuckle"], at = "B", kind = "spherical"}
r = {between = ["ground", "tie"], at = "R", kind = "spherical"}
n = {between = ["tie", "knuckle"], at = "N", kind = "spherical"}
"""
"""A strut whose ball is beside its line, in the plane of the arm's ball and the end of the rod."""


@pytest.fixture(scope="module")
def beside(tmp_path_factory: pytest.TempPathFactory) -> tuple:
    """The module, and a function that moves the top and the rod to where the hand is."""
    folder = tmp_path_factory.mktemp("beside")
    robot = derived("two_arms_beside", script_of("two_arms_beside", BESIDE, folder), folder)
    at = {"B": [0, -0.05, -0.1], "N": [0, 0.1, -0.15], "T": [0, -0.1, 0.3]}

    def held(q: np.ndarray, R: np.ndarray, s: np.ndarray) -> tuple:
        """The parameters of a mechanism with this posture, and the pose of its hand."""
        ball = np.stack([0 * q, 0.3 + 0.4 * np.cos(q), 0.4 * np.sin(q)], -1)
        p = ball - R @ at["B"]
        top = p + np.einsum("nij,nj->ni", R, at["T"] + s[:, None] * [0, 0, 1])
        rod = np.linalg.norm(p + R @ at["N"] - [-0.15, 0.3, 0.05], axis=-1)
        return robot.Parameters(*-top.T, rod), p

    return robot, held


def turns(rng: np.random.Generator, angles: np.ndarray) -> np.ndarray:
    """Rotations about z, x and z."""
    found = np.eye(3)
    for angle, (i, j) in zip(angles.T, ((0, 1), (1, 2), (0, 1)), strict=True):
        R = np.broadcast_to(np.eye(3), (len(angle), 3, 3)).copy()
        R[:, i, i] = R[:, j, j] = np.cos(angle)
        R[:, j, i] = np.sin(angle)
        R[:, i, j] = -R[:, j, i]
        found = found @ R
    return found


@pytest.mark.parametrize("hostile", [False, True])
def test_no_posture_on_a_strut_is_lost(beside: tuple, hostile: bool) -> None:
    robot, held = beside
    rng, n = np.random.default_rng(7), 4000
    angles, s = rng.uniform(-np.pi, np.pi, (n, 4)), rng.uniform(-0.8, 0.8, n)
    if hostile:
        small = rng.choice([0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-3], (n, 5))
        angles = rng.integers(-2, 3, (n, 4)) * np.pi / 2 + small[:, :4]
        s = rng.choice([-0.4, -0.5, -0.383, 0, 0.2], n) + small[:, 4]
    R = turns(rng, angles[:, 1:])
    parameters, p = held(angles[:, 0], R, s)
    T, status = robot.fk(angles[:, :1], parameters)
    answers = np.isin(status, (OK, SINGULAR))
    assert answers.any(1).all()
    size = sum(map(np.abs, parameters))[:, None] + 1
    found, place = T[..., :3, :3], T[..., :3, 3]
    top = -np.stack(parameters[:3], -1)[:, None] - place
    ball = np.stack([0 * p[:, 0], 0.3 + 0.4 * np.cos(angles[:, 0]), 0.4 * np.sin(angles[:, 0])], -1)
    rod = found @ [0, 0.1, -0.15] + place - [-0.15, 0.3, 0.05]
    wrong = [
        np.linalg.norm(found @ [0, -0.05, -0.1] + place - ball[:, None], axis=-1),
        np.linalg.norm((np.einsum("nkji,nkj->nki", found, top) - [0, -0.1, 0.3])[..., :2], axis=-1),
        np.abs(np.linalg.norm(rod, axis=-1) - parameters.t[:, None]),
        np.abs(found @ found.swapaxes(-1, -2) - np.eye(3)).max((-1, -2)),
    ]
    assert (np.array(wrong) / size)[:, status == OK].max() < 1e-12
    away = np.abs(found - R[:, None]).max((-1, -2))
    clear = (status == OK).all(1)  # in all modes
    assert clear.sum() > n / 4
    near = np.where(clear, np.nan_to_num(away, nan=9).min(1), 0)
    assert near.max() < (1e-3 if hostile else 1e-7)


def test_a_hand_whose_three_points_are_nearly_in_line_is_singular(beside: tuple) -> None:
    """There the rod hardly turns it."""
    robot, held = beside
    s = -0.4 + 0.05 / 3 + np.array([1e-5, 0.2])  # the ball is beside that of the arm and the end
    q, R = np.full(2, 0.3), turns(np.random.default_rng(1), np.full((2, 3), 0.4))
    status = robot.fk(q[:, None], held(q, R, s)[0]).status
    assert SINGULAR in status[0]
    assert SINGULAR not in status[1]


@pytest.mark.parametrize(("away", "status"), [(0.005, OK), (0.001, SINGULAR)])
def test_the_rotation_of_a_slim_hand_is_one(away: float, status: int, tmp_path: Path) -> None:
    """Where rounding decides the turn about the line of both balls, the status says so."""
    upright = (
        f"upright = {{B = [0, 0, -0.12], C = [0, 0, 0.12], T = [{away}, 0, 0.02], W = [0, 0, 0]}}"
    )
    text = "\n".join(
        upright if line.startswith("upright") else line for line in SUSPENSION.splitlines()
    )
    name = f"slim_{status}"
    robot = derived(name, script_of(name, text, tmp_path), tmp_path)
    T, found = robot.fk(drawn(np.array([0.6, 0.3]), 20_000, 5))
    R = T[np.isin(found, (OK, SINGULAR))][:, :3, :3]
    assert len(R) > 50
    assert (found[np.isin(found, (OK, SINGULAR))] == status).all()
    if status == OK:
        assert np.abs(R @ R.swapaxes(-1, -2) - np.eye(3)).max() < 1e-12


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("T = [0.13, -0.03, 0.02]", "T = [-0.02, -0.1, 0.36]", "end in line"),
        ('kind = "universal"}', "axis = [1, 0, 0]}", 'kind = "spherical"'),
        ('tie = {length = "t"}', "tie = {}", "a body with a length or two points"),
        ('at = "U", axis = [1, 0, 0]}', 'at = "U"}', "say about which axis"),
    ],
)
def test_a_file_that_does_not_fit_says_why(old: str, new: str, told: str, tmp_path: Path) -> None:
    assert old in SUSPENSION
    with pytest.raises((TableError, ShapeError), match=told):
        exec(script_of("wrong", SUSPENSION.replace(old, new), tmp_path), {})
