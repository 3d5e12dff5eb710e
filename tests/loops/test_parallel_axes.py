"""Legs with parallel axes: Tsai's manipulator, against its drawing and Newton's method."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import Crank, Derivation, Extended, Paper, ParallelAxes, guided, parallel, real
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "falcon.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
AXES = np.stack([-np.sin(ANGLES), np.cos(ANGLES), 0 * ANGLES], axis=1)
DOWN = np.array([0, 0, -1])


@pytest.fixture(scope="module")
def falcon(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("falcon")
    return derived("falcon", script_of("falcon", TEXT, folder), folder, crosscheck=True)


def end(v, k: int, angles: np.ndarray) -> np.ndarray:
    """Where a leg brings the hand, from the angles of its crank, links and parallelogram."""
    q, link, pair = angles
    way, crank = (np.cos(t) * OUT[k] + np.sin(t) * DOWN for t in (link, q))
    rod = v.b * (np.cos(pair) * way + np.sin(pair) * AXES[k])
    return (v.r - v.c) * OUT[k] + v.a * crank + 2 * v.e * way + rod


LINEAR = (
    TEXT.replace('crank1 = {A1 = ["r", 0, 0], B1 = ["r + a", 0, 0]}', 'cart1 = {B1 = ["r", 0, 0]}')
    .replace('"crank1"], at = "A1", axis = [0, 1, 0]', '"cart1"], at = "A1", SLIDE')
    .replace("SLIDE", 'kind = "prismatic", axis = [0.6, 0, 0.8]')
    .replace('"crank1"', '"cart1"')
)


def test_sliders_may_drive_such_legs(tmp_path: Path) -> None:
    linear = derived("linear", script_of("linear", LINEAR, tmp_path), tmp_path, crosscheck=True)
    rng, v, found = np.random.default_rng(1), linear.Parameters(), 0

    def end_at(k: int, at: np.ndarray) -> np.ndarray:
        q, link, pair = at
        way = np.cos(link) * OUT[k] + np.sin(link) * DOWN
        rod = v.b * (np.cos(pair) * way + np.sin(pair) * AXES[k])
        return (v.r - v.c) * OUT[k] + q * (0.6 * OUT[k] - 0.8 * DOWN) + 2 * v.e * way + rod

    step = np.array([1e-6, -2e-6, 1e-6])
    for x in rng.uniform(-0.02, 0.02, (10, 3)):
        answers, status = linear.ik(x)
        assert not status.any()
        for k in range(3):
            for start in rng.uniform((-0.1, -3, -1), (0.1, 3, 1), (20, 3)):
                at = newton(lambda t: end_at(k, t) - x, start)  # noqa: B023
                if at is not None and np.cos(at[2]) > 0:
                    assert np.abs(answers[:, k] - at[0]).min() < 1e-9
                    found += 1
        for q, moved in zip(answers, linear.ik(x + step).q, strict=True):
            assert np.allclose(moved - q, linear.jacobian_inverse(x, q) @ step, atol=1e-9)
    assert found > 60
    far = np.array([0.3, 0, 0])
    assert (linear.ik(far).status == UNREACHABLE).all()


def targets(rows: int) -> np.ndarray:
    return np.random.default_rng(2).uniform((-0.03, -0.03, -0.13), (0.03, 0.03, -0.08), (rows, 3))


def test_newton_finds_no_joints_that_the_closed_form_lacks(falcon: ModuleType) -> None:
    rng, v, found = np.random.default_rng(1), falcon.Parameters(), 0
    for x in targets(10):
        answers, status = falcon.ik(x)
        assert not status.any() and answers.shape == (8, 3)
        for k in range(3):
            seen = set()
            for start in rng.uniform(-3, 3, (20, 3)):
                at = newton(lambda t: end(v, k, t) - x, start)  # noqa: B023
                if at is not None and np.cos(at[2]) > 0:
                    gaps = apart(answers[:, k : k + 1], at[:1], np.array([True]))
                    assert gaps.min() < 1e-6
                    seen.add(tuple(gaps < 1e-6))
            found += len(seen)
    assert found == 60  # both working modes of each leg


def test_rates_are_those_of_the_drawing(falcon: ModuleType) -> None:
    step = np.array([1e-6, -2e-6, 1e-6])
    for x in targets(10):
        before, after = falcon.ik(x).q, falcon.ik(x + step).q
        for q, moved in zip(before, after, strict=True):
            K, J = falcon.jacobian_inverse(x, q), falcon.jacobian(x, q)
            assert np.allclose(moved - q, K @ step, atol=1e-9)
            assert np.allclose(J @ K, np.eye(3))
            rod = falcon.jacobian_parallel(x, q)
            assert np.allclose(np.linalg.norm(rod, axis=1), falcon.Parameters().b)
            assert np.allclose(np.linalg.det(J), falcon.determinant(x, q))


def test_the_drawing_has_the_lengths_of_the_links(falcon: ModuleType) -> None:
    v, names = falcon.Parameters(), falcon.SKELETON.points
    for x in targets(5):
        for q in falcon.ik(x).q:
            at = dict(zip(names, falcon.skeleton(x, q), strict=True))
            for k in "123":
                lengths = [
                    np.linalg.norm(at[a + k] - at[b + k]) for a, b in ("AB", "BD", "DE", "EC")
                ]
                assert np.allclose(lengths, [v.a, v.e, v.b, v.e])
                # the links lead the way of the rods
                assert (at["D" + k] - at["B" + k]) @ (at["E" + k] - at["D" + k]) > 0


def test_where_the_legs_end(falcon: ModuleType) -> None:
    v = falcon.Parameters()
    far = np.array([0, 0, -1.0])
    assert (falcon.ik(far).status == UNREACHABLE).all() and np.isnan(falcon.ik(far).q).all()
    assert not falcon.workspace_contains(far)
    aside = v.b * AXES[0]  # the rods of leg 1 are along its axis: no part of them is left
    assert (falcon.ik(aside * (1 + 1e-9) + 0.03 * DOWN).status == UNREACHABLE).all()
    start = (v.r - v.c) * OUT[0]
    met = v._replace(a=2 * v.e + v.b)  # leg 1 ends on the axis of its crank
    q, status = falcon.ik(start, met)
    assert (status != OK).all() and not q[status == SINGULAR][:, 0].any()


def of(rods: list, axes=((0, 1, 0), (1, 0, 0), (0, 1, 0))) -> Derivation:
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T")
    joints = [d.joint(f"q{k}") for k in (1, 2, 3)]
    ways = {(0, 1, 0): ((1, 0, 0), (0, 0, -1)), (1, 0, 0): ((0, 1, 0), (0, 0, 1))}
    legs = [
        Crank(q, 1, rod, (0, 0, 0), *ways[axis], on_hand=(0, 0, 0))
        for q, rod, axis in zip(joints, rods, axes, strict=True)
    ]
    guided(d, ParallelAxes(), legs)
    return d


def test_legs_that_do_not_keep_the_hand_are_refused() -> None:
    y, x = (Extended(3, axis, 1, (1, 1)) for axis in ((0, 1, 0), (1, 0, 0)))
    with pytest.raises(ShapeError, match="a Slide whose rod is Extended"):
        of([3, x, y])
    with pytest.raises(ShapeError, match="along the axis of its crank"):
        of([x, x, y])
    with pytest.raises(ShapeError, match="about which the hand can always turn"):
        of([y, y, y], [(0, 1, 0)] * 3)
    d = Derivation("t", "T", Paper("t", "T", ("A",)), "T", task=["x", "y", "z"])
    legs = [
        Crank(
            d.joint(f"q{k}"), 1, y, (k, 0, 0), along=(1, 0, 0), across=(0, 0, -1), on_hand=(0, 0, 0)
        )
        for k in (1, 2, 3)
    ]
    with pytest.raises(ShapeError, match="with ParallelAxes, in guided"):
        parallel(d, [real(e) for e in "xyz"], legs)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"B1", axis = [0, 1, 0]', '"B1"', "so b1 is revolute and has an axis"),
        ('"C1", axis = [0, 1, 0]', '"C1", axis = [0, 0, 1]', "of c1 has to be parallel to the"),
        (
            '"A1", axis = [0, 1, 0]',
            '"A1", kind = "prismatic", axis = [0, 1, 0]',
            "axis of q1 has to be",
        ),
        ("copies = 3", "copies = 4", "such a hand has three legs, and there are 4"),
    ],
)
def test_what_a_file_lacks_is_said(old: str, new: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(TableError, match=told):
        script_of("falcon", TEXT.replace(old, new), tmp_path)


def test_one_link_alone_may_be_there(tmp_path: Path) -> None:
    text = TEXT.replace('lower1 = {E1 = [0, 0, 0], C1 = ["e", 0, 0]}\n', "")
    text = text.replace('e1 = {between = ["rod1", "lower1"], at = "E1"}\n', "")
    text = text.replace('["lower1", "hand"]', '["rod1", "hand"]')
    assert script_of("falcon", text, tmp_path).count("(e, 0))") == 3
