"""Three points of a linkage in line, as of the pantograph leg of a walking machine.

The foot is as much farther from the one slide than the other slide as the pantograph says.
"""

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, read_script, script_of
from places import TESTS

TEXT = (TESTS / "held_out_loops" / "decoupled_leg.toml").read_text("utf-8")
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def leg(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("pantograph")
    assert len(TEXT.splitlines()) < 40
    return derived("leg", script_of("leg", TEXT, folder), folder, crosscheck=True)


def foot(q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The foot, and the distance of both slides."""
    upper = np.stack([0 * q[..., 0], 0.3 + q[..., 0]], -1)
    lower = np.stack([0.1 + q[..., 1], 0 * q[..., 1]], -1)
    return upper + 4 * (lower - upper), np.linalg.norm(lower - upper, axis=-1)


def test_both_slides_follow_from_the_foot(leg: ModuleType) -> None:
    q = np.random.default_rng(1).uniform(-0.4, 0.4, (10000, 2))
    p, apart = foot(q)
    inside = apart < 0.2
    assert inside.sum() > 500
    answers, status = leg.ik(p)
    assert (status[inside] != UNREACHABLE).all() and (status[~inside] == UNREACHABLE).all()
    assert np.abs(answers - q[:, None])[inside].max() < 1e-15
    again = leg.fk(answers[status == OK]).p
    target = np.repeat(p[:, None], 2, axis=1)[status == OK]
    gaps = np.nanmin(np.abs(again - target[:, None]).max(axis=-1), axis=-1)
    assert len(gaps) > 1000 and gaps.max() < 1e-13
    assert (leg.workspace_contains(p) == inside).all()


def test_a_foot_on_the_edge_of_its_reach_is_singular(leg: ModuleType) -> None:
    way = np.array([4 * 0.2 * np.cos(1), -3 * 0.2 * np.sin(1)])
    for share in (1e-6, 1e-9, 1e-12, 1e-15, 0):
        q, status = leg.ik(way * (1 - share))
        assert (status == SINGULAR).all()
        assert np.abs(foot(q)[0] - way * (1 - share)).max() < 1e-14
    assert (leg.ik(way * (1 + 1e-9)).status == UNREACHABLE).all()


def test_a_parallelogram_that_is_none_has_no_inverse(tmp_path: Path) -> None:
    other = TEXT.replace('link1 = {length = "b - a"}', 'link1 = {length = "b"}')
    assert other != TEXT
    d = read_script(script_of("other", other, tmp_path))
    assert "a class above II" in d.without_inverse
    assert not read_script(script_of("leg2", TEXT, tmp_path)).without_inverse


def test_two_joints_of_one_coordinate_are_not_determined(tmp_path: Path) -> None:
    text = (TESTS / "held_out_loops" / "multi_link_engine.toml").read_text("utf-8")
    d = read_script(script_of("engine", text, tmp_path))
    assert d.without_inverse == (
        "2 joints are driven and the hand has one coordinate, so a target does not determine them"
    )
