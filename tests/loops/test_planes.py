"""Legs of a slider and two bars with parallel axes, against the chains of all their joints."""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, newton, read_script, script_of
from places import TESTS

from closedform import Derivation, Paper, Plane, Rail, Slide, parallel, real
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

FOLDER = TESTS / "held_out_loops"
TEXTS = {n: (FOLDER / f"{n}.toml").read_text("utf-8") for n in ("tripteron", "tilted_tripteron")}
TRIPTERON = TEXTS["tripteron"]
OK, UNREACHABLE = 0, 1
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
LINES = 40


@pytest.fixture(scope="module", params=TEXTS)
def robot(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = TEXTS[request.param]
    assert len(text.splitlines()) < LINES
    folder = tmp_path_factory.mktemp("planes")
    name = f"{request.param}_held_out"
    return derived(name, script_of(name, text, folder), folder, crosscheck=True)


def drawing(robot: ModuleType) -> tuple[np.ndarray, ...]:
    """The starts, ways, axes and ends on the hand of the legs, a row for each."""
    v = robot.Parameters()
    if "tilted" not in robot.__name__:
        return 0 * np.eye(3), np.eye(3), np.eye(3), -v.c * np.roll(np.eye(3), 1, axis=1)
    up = np.tile([0.0, 0.0, 1.0], (3, 1))
    return v.b * OUT, up, 0.6 * OUT + 0.8 * up, v.c * OUT


def turned(axis: np.ndarray, angle: float) -> np.ndarray:
    """A rotation about a unit vector, by Rodrigues' formula."""
    x, y, z = axis
    W = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * W + (1 - np.cos(angle)) * W @ W


def ends(robot: ModuleType, q: np.ndarray, angles: np.ndarray) -> list[tuple]:
    """Where each leg brings the hand, and how it turns it; three angles for each leg."""
    v, found = robot.Parameters(), []
    rows = zip(*drawing(robot), q, angles.reshape(3, 3), strict=True)
    for start, way, axis, place, joint, (a, b, c) in rows:
        side = np.cross(axis, [0.36, 0.48, 0.8])
        side /= np.linalg.norm(side)
        far = v.l * turned(axis, a) @ side + v.r * turned(axis, a + b) @ side
        R = turned(axis, a + b + c)
        found.append((start + joint * way + far - R @ place, R))
    return found


def missed(robot: ModuleType, q: np.ndarray, angles: np.ndarray) -> np.ndarray:
    (p, R), *others = ends(robot, q, angles)
    return np.concatenate([[*(p - a), *(R - B).ravel()] for a, B in others])


def test_the_chains_of_joints_find_no_posture_that_the_closed_form_lacks(
    robot: ModuleType,
) -> None:
    """A hand on two different axes does not turn, wherever the search begins."""
    rng, found = np.random.default_rng(1), 0
    for q in rng.uniform(-0.3, 0.3, (7, 3)):
        [p], [status] = robot.fk(q)
        for start in rng.uniform(-np.pi, np.pi, (6, 9)):
            angles = newton(lambda a: missed(robot, q, a), start)  # noqa: B023
            if angles is None:
                continue
            (at, R), *_ = ends(robot, q, angles)
            assert status == OK
            assert np.abs(R - np.eye(3)).max() < 1e-9
            assert np.linalg.norm(at - p) < 1e-9
            found += 1
    assert found > 5


def test_targets_at_random(robot: ModuleType) -> None:
    """The bars reach if a triangle with their lengths and the distance exists."""
    v, (starts, ways, axes, places) = robot.Parameters(), drawing(robot)
    p = np.random.default_rng(2).uniform(-0.6, 0.6, (20_000, 3))
    w = p[:, None] + places - starts
    q = np.sum(axes * w, -1) / np.sum(axes * ways, -1)
    far = np.linalg.norm(w - q[..., None] * ways, axis=-1)
    reached = np.all((far < v.l + v.r) & (far > abs(v.l - v.r)), axis=-1)
    found = robot.ik(p)
    assert 1000 < reached.sum() < 19_000
    assert (found.status[:, 0] == np.where(reached, OK, UNREACHABLE)).all()
    assert np.abs(found.q[reached, 0] - q[reached]).max() < 1e-14
    again = robot.fk(found.q[reached, 0])
    assert not again.status.any()
    assert np.abs(again.p[:, 0] - p[reached]).max() < 1e-14
    assert np.array_equal([robot.workspace_contains(row) for row in p[:200]], reached[:200])


def test_the_jacobian_is_a_difference(robot: ModuleType) -> None:
    q = robot.ik([0.1, 0.15, 0.2]).q[0] if "tilted" not in robot.__name__ else np.full(3, 0.1)
    rates = [(robot.fk(q + s).p[0] - robot.fk(q - s).p[0]) / 2e-6 for s in 1e-6 * np.eye(3)]
    J = robot.jacobian(q)[0]
    assert np.allclose(np.array(rates).T, J, atol=1e-9)
    assert np.isclose(robot.determinant(q)[0], np.linalg.det(J))
    if "tilted" not in robot.__name__:
        assert np.array_equal(J, np.eye(3))  # each joint moves one coordinate


def test_the_skeleton_has_both_bars(robot: ModuleType) -> None:
    v, (_, _, axes, _) = robot.Parameters(), drawing(robot)
    q = np.random.default_rng(3).uniform(-0.3, 0.3, (200, 3))
    at = robot.skeleton(q)[:, 0]
    seen = np.isfinite(at).all(axis=(1, 2))
    assert (seen == (robot.fk(q).status[:, 0] == OK)).all()
    assert seen.sum() > 20
    points = dict(zip(robot.SKELETON.points, np.moveaxis(at[seen], 1, 0), strict=True))
    for k, axis in enumerate(axes, 1):
        first, second = points[f"E{k}"] - points[f"B{k}"], points[f"C{k}"] - points[f"E{k}"]
        assert np.allclose(np.linalg.norm(first, axis=1), v.l, atol=1e-12)
        assert np.allclose(np.linalg.norm(second, axis=1), v.r, atol=1e-12)
        assert np.abs(first @ axis).max() < 1e-12
        assert np.abs(second @ axis).max() < 1e-12


def test_equal_bars_fold(tmp_path: Path) -> None:
    """Where the hand is at the slider, the bars have no direction; some is drawn."""
    folded = derived(
        "folded", script_of("folded", TRIPTERON.replace('"r"', '"l"'), tmp_path), tmp_path
    )
    v = folded.Parameters()
    p = np.array([0.1, v.c, 0.0])  # the end of the first leg is on the first rail
    found = folded.ik(p)
    assert found.status == [OK]
    points = dict(zip(folded.SKELETON.points, folded.skeleton(found.q[0])[0], strict=True))
    assert np.allclose(points["B1"], points["C1"])
    assert np.isclose(np.linalg.norm(points["E1"] - points["B1"]), v.l)


def test_legs_that_do_not_fit_say_why() -> None:
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A. Nonymous",)), "Legs.")
    d.task = ["x", "y", "z"]
    q = [d.joint(f"q{k + 1}", "prismatic") for k in range(3)]
    hand, o = tuple(map(real, "xyz")), (0, 0, 0)
    x, y, z = (1, 0, 0), (0, 1, 0), (0, 0, 1)
    with pytest.raises(ShapeError, match="must not be at right angles to the axes"):
        Plane(q[0], (1, 1), o, x, y)
    with pytest.raises(ShapeError, match="vectors of a plane need 3 entries"):
        Plane(q[0], (1, 1), (0, 0), (1, 0), (1, 0))
    with pytest.raises(ShapeError, match="one of three in space"):
        parallel(d, hand, [Plane(q[0], (1, 1), o, x, x), *(Slide(j, 2, o, z) for j in q[1:])])
    with pytest.raises(ShapeError, match="one of three in space"):
        parallel(
            d, hand[:2], [Plane(q[0], (1, 1), o, x, x), Rail(q[1], q[2], (0, 0), (1, 0), (0, 1))]
        )
    with pytest.raises(ShapeError, match="parallel to one plane"):
        parallel(d, hand, [Plane(j, (1, 1), o, x, a) for j, a in zip(q, (x, x, x), strict=True)])


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ('"E", axis = [1, 0, 0]', '"E", axis = [0, 1, 0]', "three revolute joints with parallel"),
        ('"E", axis = [1, 0, 0]', '"E"', "the rods upper1 and lower1 and the hand"),
        ('axis = [1, 0, 0], driven', 'axis = [0, 1, 0], driven', "must not be at right angles"),
    ],
)  # fmt: skip
def test_a_file_that_does_not_fit_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    assert old in TRIPTERON
    with pytest.raises(TableError, match=message):
        script_of("tripteron", TRIPTERON.replace(old, other), tmp_path)


def test_the_article_says_why_the_hand_does_not_turn(tmp_path: Path) -> None:
    d = read_script(script_of("tripteron", TRIPTERON, tmp_path))
    [step] = [s for s in d.steps if s.title == "The axes"]
    assert "does not turn at any posture" in step.reason
