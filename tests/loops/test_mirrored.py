"""A hand that is the mirror image of the ground in the plane of three balls: a Canfield joint.

Rigid bodies, which Newton's method puts together, know nothing of the mirror.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import apart, derived, newton, script_of
from places import TESTS

from closedform import Crank, Derivation, Paper, Slide, mirrored
from closedform.algebra.shapes import ShapeError
from closedform.scaffold.inputs.tables import TableError

TEXT = (TESTS / "held_out_loops" / "canfield.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR, INVALID = range(4)
ANGLES = 2 * np.pi / 3 * np.arange(3)
OUT = np.stack([np.cos(ANGLES), np.sin(ANGLES), 0 * ANGLES], axis=1)
AXES = np.stack([np.sin(ANGLES), -np.cos(ANGLES), 0 * ANGLES], axis=1)
UP = np.array([0, 0, 1])


@pytest.fixture(scope="module")
def joint(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    assert len(TEXT.splitlines()) < 40
    folder = tmp_path_factory.mktemp("canfield")
    return derived("canfield", script_of("canfield", TEXT, folder), folder, crosscheck=True)


def rotation(r: np.ndarray) -> np.ndarray:
    K = np.cross(np.eye(3), r)
    return np.linalg.inv(np.eye(3) + K) @ (np.eye(3) - K)


def balls(v, q: np.ndarray) -> np.ndarray:
    return v.b * OUT + v.l * (np.cos(q)[:, None] * OUT + np.sin(q)[:, None] * UP)


def missed(v, q: np.ndarray, p: np.ndarray, R: np.ndarray) -> np.ndarray:
    """By how far links of the hand miss the balls, and the planes in which they turn."""
    rods = balls(v, q) - p - v.b * OUT @ R.T
    return np.array([*(np.linalg.norm(rods, axis=1) - v.l), *(rods * (AXES @ R.T)).sum(axis=1)])


def targets(count: int) -> np.ndarray:
    around = np.random.default_rng(5).uniform(-0.15, 0.15, (count, 3))
    return around + np.array([0, 0, 0.4])


def test_both_problems_close_the_loop_of_rigid_bodies(joint: ModuleType) -> None:
    v, x = joint.Parameters(), targets(2000)
    q, status = joint.ik(x)
    assert q.shape == (2000, 8, 3) and (status == OK).mean() > 0.5
    p, back = joint.fk(q[status == OK])
    assert (back == OK).all()
    assert np.abs(p[:, 0] - np.repeat(x, (status == OK).sum(axis=1), axis=0)).max() < 1e-12
    for target, rows, which in zip(x[:50], q, status, strict=False):
        T = joint.hand_pose(target)
        assert np.isclose(np.linalg.det(T[:3, :3]), 1)
        for row in rows[which == OK]:
            assert np.abs(missed(v, row, T[:3, 3], T[:3, :3])).max() < 1e-12


def test_newton_finds_no_mirrored_posture_that_ik_lacks(joint: ModuleType) -> None:
    """At a position, the rotation and the joints are unknown."""
    v, rng, met, other = joint.Parameters(), np.random.default_rng(1), 0, 0
    for x in targets(12):
        q, status = joint.ik(x)
        R = joint.hand_pose(x)[:3, :3]
        for start in rng.uniform(-2, 2, (12, 6)):
            f = lambda u: missed(v, u[:3], x, rotation(u[3:]))  # noqa: B023, E731
            found = newton(f, start)
            if found is None:
                continue
            if np.allclose(rotation(found[3:]), R, atol=1e-7):
                met += 1
                assert apart(q[status == OK], found[:3], np.array([True])).min() < 1e-7
            else:
                other += 1
    assert met > 10 and other > 0  # others are those that are left out


def test_newton_finds_the_hand_among_the_postures_of_its_joints(joint: ModuleType) -> None:
    v, rng = joint.Parameters(), np.random.default_rng(2)
    for q in rng.uniform(0.2, 1.2, (6, 3)):
        [p], [status] = joint.fk(q)
        assert status == OK
        seen: list[np.ndarray] = []
        for start in rng.uniform(-1, 1, (40, 6)):
            found = newton(lambda u: missed(v, q, u[:3], rotation(u[3:])), start)  # noqa: B023
            if found is not None and not any(np.allclose(found, e, atol=1e-6) for e in seen):
                seen.append(found)
        assert any(np.allclose(e[:3], p, atol=1e-6) for e in seen) and len(seen) <= 16


def test_derivatives(joint: ModuleType) -> None:
    step = np.array([1, -2, 1]) * 1e-6
    for q in np.random.default_rng(3).uniform(0.2, 1.2, (20, 3)):
        [p], [J] = joint.fk(q).p, joint.jacobian(q)
        assert np.allclose(joint.fk(q + step).p[0] - p, J @ step, atol=1e-10)
        [A], [B] = joint.jacobian_parallel(q), joint.jacobian_serial(q)
        assert np.allclose(A @ J, np.diag(B))
        assert np.isclose(joint.determinant(q)[0], np.linalg.det(J))
        *_, area, away = joint.singularities(q)[0]
        size = sum(joint.Parameters())
        assert np.isclose(abs(np.linalg.det(A)), area * size**2 * abs(away) / 2)


def test_where_the_balls_or_the_pivot_do_not_determine_the_plane(joint: ModuleType) -> None:
    v = joint.Parameters()
    [p], [status] = joint.fk([0, 0, 0])  # the plane of the balls contains the pivot
    assert status == OK and np.allclose(p, 0)
    assert (joint.ik(p).status == SINGULAR).all() and np.isfinite(joint.jacobian([0, 0, 0])).all()
    high = balls(
        v, np.array([np.pi / 2, np.pi, -np.pi / 2])
    )  # the second one is between the others
    assert np.allclose(high[0] + high[2], 2 * high[1])
    [p], [status] = joint.fk([np.pi / 2, np.pi, -np.pi / 2])
    assert status == SINGULAR and np.allclose(p, 0)
    assert (joint.ik([0, 0, 5]).status == UNREACHABLE).all()
    assert (joint.ik([np.nan, 0, 1]).status == INVALID).all()


def test_a_frame_that_is_mirrored_otherwise(tmp_path: Path) -> None:
    """The hand may be drawn with its x axis reversed, and its point anywhere on it."""
    text = TEXT.replace("P = [0, 0, 0]", 'P = [0, 0, "b"]').replace("copies = 3\n", "")
    legs = []
    for k, angle in enumerate(("0", "2*pi/3", "-2*pi/3"), 1):
        x, y = f"cos({angle})", f"sin({angle})"
        legs.append((k, x, y))
    text = """hand = "P"
[parameters]
b = {value = "0.2", meaning = "base"}
l = {value = "0.3", meaning = "links"}
[bodies]
"""
    text += "ground = {" + ", ".join(f'A{k} = ["b*{x}", "b*{y}", 0]' for k, x, y in legs) + "}\n"
    corners = ", ".join(f'C{k} = ["-b*{x}", "b*{y}", "-b"]' for k, x, y in legs)
    text += "hand = {P = [0, 0, 0], " + corners + "}\n"
    for k, x, y in legs:
        text += (
            f'low{k} = {{B{k} = ["(b + l)*{x}", "(b + l)*{y}", 0]}}\nrod{k} = {{length = "l"}}\n'
        )
    text += "[joints]\n"
    for k, x, y in legs:
        text += (
            f'q{k} = {{between = ["ground", "low{k}"], at = "A{k}", axis = ["{y}", "-{x}", 0], '
            f'driven = true}}\nb{k} = {{between = ["low{k}", "rod{k}"], at = "B{k}", kind = '
            f'"spherical"}}\nc{k} = {{between = ["rod{k}", "hand"], at = "C{k}", '
            f'axis = ["{y}", "{x}", 0]}}\n'
        )
    script = script_of("turned", text, tmp_path)
    assert "mirror=(-1, 1, 1)" in script and "(0, 0, b)," in script


def test_a_hand_that_is_no_mirror_image_is_told_of(tmp_path: Path) -> None:
    text = TEXT.replace('upper1 = {length = "l"}', 'upper1 = {length = "b"}')
    with pytest.raises(TableError, match="the mirror image of the ground, as that of a Canfield"):
        script_of("longer", text, tmp_path)


def test_legs_that_are_not_cranks_are_refused() -> None:
    d = [Derivation("t", "T", Paper("t", "T", ("A",)), "T") for _ in range(3)]
    for e in d:
        for k in (1, 2, 3):
            e.joint(f"q{k}")
    cranks = [
        [Crank(j.symbol, 1, 0, (1, 0, 0), along=(1, 0, 0), across=(0, 0, 1)) for j in e.joints]
        for e in d
    ]
    with pytest.raises(ShapeError, match="three legs, in the order of the driven joints"):
        mirrored(d[0], (0, 0, 0), cranks[0][::-1])
    with pytest.raises(ShapeError, match="cranks in space with the rod 0"):
        slide = Slide(d[1].joints[2].symbol, 0, (0, 0, 0), (0, 0, 1))
        mirrored(d[1], (0, 0, 0), [*cranks[1][:2], slide])  # type: ignore[list-item]
    with pytest.raises(ShapeError, match="mirrored in a plane of two of its axes"):
        mirrored(d[2], (0, 0, 0), cranks[2], mirror=(1, 1, 1))
