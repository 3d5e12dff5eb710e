"""A hand on a rod: velocities against differences, what is drawn, and files that do not fit."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, script_of
from places import TESTS

from closedform import Crank, Derivation, Paper, Parallelogram, Stretch, on_rod, real
from closedform.algebra.shapes import ShapeError
from closedform.robots import Robot
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
NAMES = ("loader", "minitaur")
OK, UNREACHABLE, SINGULAR = 0, 1, 2


def text(name: str) -> str:
    return (FOLDER / f"{name}.toml").read_text("utf-8")


@pytest.fixture(scope="module", params=NAMES)
def loop(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    name, folder = request.param, tmp_path_factory.mktemp("rods")
    return derived(f"{name}_on_rod", script_of(f"{name}_on_rod", text(name), folder), folder)


def postures(loop: ModuleType, count: int) -> np.ndarray:
    """Joints of which the loop closes, away from singular ones."""
    q = np.random.default_rng(1).uniform(0.2, 2, (50 * count, 2))
    factors = np.abs(loop.singularities(q)).min(axis=(-2, -1))
    return q[factors > 0.01 * np.nanmax(factors)][:count]


def test_the_jacobian_is_the_derivative(loop: ModuleType) -> None:
    q, step = postures(loop, 100), 1e-6
    J = loop.jacobian(q)
    assert len(q) == 100
    assert np.isfinite(J).all()
    for k, e in enumerate(step * np.eye(2)):
        rates = (loop.fk(q + e).p - loop.fk(q - e).p) / (2 * step)
        assert np.allclose(J[..., k], rates, rtol=1e-5, atol=1e-5 * np.abs(J).max())
    A, B = loop.jacobian_parallel(q), loop.jacobian_serial(q)
    assert np.allclose(A @ J, B, atol=1e-12)
    assert (B[..., 0, 1] == 0).all()
    assert np.allclose(loop.determinant(q), np.linalg.det(J))
    assert np.allclose(loop.singularities(q)[..., -1], np.linalg.det(A))


def test_inverse_and_forward_map_invert_each_other(loop: ModuleType) -> None:
    q = np.random.default_rng(2).uniform(-3, 3, (1000, 2))
    p, status = loop.fk(q)
    for mode in range(2):
        kept = status[:, mode] == OK
        answers, told = loop.ik(p[kept, mode])
        turns = [loop.SKELETON.joints[n].kind == "revolute" for n in loop.JOINTS]
        gap = answers - q[kept, None]
        gap = np.where(turns, np.angle(np.exp(1j * gap)), gap)
        assert np.all(np.nanmin(np.abs(gap).max(axis=-1), axis=-1) < 1e-5)
        again = loop.fk(answers[told == OK]).p
        target = np.broadcast_to(p[kept, None, mode], answers.shape)[told == OK]
        assert np.all(np.linalg.norm(again - target[:, None], axis=-1).min(axis=-1) < 1e-12 * 3)


def test_the_workspace_is_where_an_answer_exists(loop: ModuleType) -> None:
    v = loop.Parameters()
    p = np.random.default_rng(3).uniform(-1.1, 1.1, (10_000, 2)) * sum(v)
    inside = loop.workspace_contains(p)
    assert (inside == (loop.ik(p).status != UNREACHABLE).any(axis=-1)).all()
    assert 500 < inside.sum() < 9500


def test_the_condition_number_is_that_of_a(loop: ModuleType) -> None:
    q = postures(loop, 100)
    assert np.allclose(loop.condition_number(q), np.linalg.cond(loop.jacobian_parallel(q)))


def test_lengths_in_numbers_are_proved_too(tmp_path: Path) -> None:
    numbers = text("minitaur").replace('"l2 + t"', "0.235")
    numbers = numbers.replace('"l1"', "0.1").replace('"l2"', "0.2")
    numbers = numbers[: numbers.index("[parameters]")] + numbers[numbers.index("[bodies]") :]
    loop = derived("leg_in_numbers", script_of("leg_in_numbers", numbers, tmp_path), tmp_path)
    p = loop.fk([0.3, 2]).p[0]
    assert np.abs(loop.ik(p).q - [0.3, 2]).max(axis=-1).min() < 1e-9


def test_the_second_rod_is_drawn_where_it_ends(tmp_path: Path, loop: ModuleType) -> None:
    points = loop.skeleton(postures(loop, 20))
    at = dict(zip(loop.SKELETON.points, np.moveaxis(points, -2, 0), strict=True))
    v = loop.Parameters()
    whole, part = (v.r, np.hypot(v.a, v.h)) if "loader" in loop.__name__ else (v.l2 + v.t, v.l2)
    assert np.allclose(np.linalg.norm(at["P"] - at["B1"], axis=-1), whole)
    assert np.allclose(np.linalg.norm(at["C"] - at["B1"], axis=-1), part)


def test_it_can_be_followed(loop: ModuleType) -> None:
    q = postures(loop, 1)[0]
    p = loop.fk(q).p[0]
    found = Robot(loop).nearest(p + 1e-3, q)
    assert found.status == OK
    assert np.abs(np.asarray(found.q) - q).max() < 0.1


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('P = ["l2 + t", 0]', "P = [0, 0]", "the hand P is where shank is joined to crank1"),
        ('C = ["l2", 0]', "C = [0, 0]", "c and b1 are at the same point of shank"),
        ('c = {between = ["shank", "rod2"]', 'c = {between = ["crank1", "rod2"]',
         "shank carries the hand and is joined to crank1; it must be joined to one"),
        ('{length = "l2"}', '{B2 = [0, 0], D = ["l2", 0], Q = [0, 1]}', "which must be joined"),
        ('"rod2"], at = "C"', '"rod2"], at = "D"', "shank has no point D, where c is"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in text("minitaur")
    with pytest.raises(TableError, match=message):
        script_of("leg", text("minitaur").replace(old, other), tmp_path)


def test_a_point_of_the_second_rod_without_a_joint_is_of_no_account(tmp_path: Path) -> None:
    whole = text("minitaur")
    more = whole.replace('{length = "l2"}', '{B2 = [0, 0], C = ["l2", 0], Q = [0, 1]}')
    assert more != whole and script_of("leg", more, tmp_path) == script_of("leg", whole, tmp_path)


def test_legs_that_do_not_fit_say_why() -> None:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T.", task=["x", "y"])
    a, b = d.joint("a"), d.joint("b")
    hand, flat = (real("x"), real("y")), ((1, 0), (0, 1))
    legs = Crank(a, 1, 2, (0, 0), *flat), Crank(b, 1, 1, (1, 0), *flat)
    with pytest.raises(ShapeError, match="where the second ends, not both 0"):
        on_rod(d, hand, *legs, (0, 0))
    with pytest.raises(ShapeError, match="which only parallel supports"):
        on_rod(d, hand, legs[0], Crank(b, 1, Parallelogram(1, (1, 0), 1), (1, 0), *flat), (1, 0))
    with pytest.raises(ShapeError, match="needs a rod of constant length"):
        on_rod(d, hand, Stretch(a, (0, 0)), legs[1], (1, 0))
    with pytest.raises(ShapeError, match="driven by b, a"):
        on_rod(d, hand, *legs[::-1], (1, 0))


TANGENT = """
hand = "D"
[bodies]
ground = {O = [0, 0], Q = [-0.3, 0.3]}
k1 = {O = [0, 0], A = [0.1, 0]}
k2 = {Q = [-0.3, 0.3], B = [-0.1, 0.3]}
upper = {A = [0, 0], C = [0.2, 0], D = [0.4, 0]}
front = {length = 0.1}
[joints]
q1 = {between = ["ground", "k1"], at = "O", driven = true}
q2 = {between = ["ground", "k2"], at = "Q", driven = true}
a = {between = ["k1", "upper"], at = "A"}
b = {between = ["k2", "front"], at = "B"}
c = {between = ["upper", "front"], at = "C"}
"""


def test_both_legs_may_be_stretched(tmp_path: Path) -> None:
    """There rounding of the hand moves the first crank far, and the second rod just reaches.

    Of 22,000 such postures 927 were lost.
    """
    both = derived("both", script_of("both", TANGENT, tmp_path), tmp_path, crosscheck=True)
    rng, shape = np.random.default_rng(3), (20_000, 2)
    near = rng.choice([0, *10.0 ** np.arange(-12, -2)], shape) * rng.choice([-1, 1], shape)
    p, status = both.fk(rng.integers(-1, 3, shape) * np.pi / 2 + near)
    x = p[status == OK]
    q, status = both.ik(x)
    assert len(x) > 5000 and ((status == OK) | (status == SINGULAR)).any(axis=-1).all()
    gaps = np.linalg.norm(both.fk(q).p - x[:, None, None], axis=-1)
    assert np.nanmin(gaps[status == OK], axis=-1).max() < 1e-12
