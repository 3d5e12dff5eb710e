"""A strut in a file of bodies and joints: the tracker of the guide, against its drawing."""

import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from loop_files import derived, script_of
from places import ROOT

from closedform.scaffold.inputs.tables import TableError

GUIDE = ROOT / "docs" / "adding-a-mechanism.md"
[TRACKER] = re.findall(r"```toml tracker.toml\n(.*?)```", GUIDE.read_text("utf-8"), re.DOTALL)
MAST, COLUMNS, ROD = 0.5, np.array([[0.4, 0.0], [0.0, 0.4]]), 0.6
OK, UNREACHABLE, SINGULAR = range(3)


@pytest.fixture(scope="module")
def tracker(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    folder = tmp_path_factory.mktemp("tracker")
    return derived("tracker", script_of("tracker", TRACKER, folder), folder)


def missed(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """By how much the squares of the mast and of both rods are missed."""
    ends = np.stack(
        [np.concatenate([np.broadcast_to(c, (len(q), 2)), q[:, [k]]], 1)
         for k, c in enumerate(COLUMNS)], 1
    )  # fmt: skip
    rods = np.sum((p[:, None] - ends) ** 2, -1) - ROD**2
    return np.concatenate([np.sum(p**2, -1, keepdims=True) - MAST**2, rods], 1)


def nearest(answers: np.ndarray, to: np.ndarray) -> np.ndarray:
    """The distance of the nearest answer that is finite."""
    apart = np.linalg.norm(answers - to[:, None], axis=-1)
    return np.min(np.where(np.isnan(apart), np.inf, apart), axis=1)


def test_no_posture_is_lost(tracker: ModuleType) -> None:
    """Where the sliders hang below the hand or stand above it is known from the drawing."""
    rng = np.random.default_rng(1)
    p = rng.normal(size=(300_000, 3))
    p *= MAST / np.linalg.norm(p, axis=1, keepdims=True)
    level = ROD**2 - np.sum((p[:, None, :2] - COLUMNS) ** 2, -1)
    p, level = p[np.all(level >= 0, 1)], level[np.all(level >= 0, 1)]
    q = p[:, 2:] + rng.choice([-1, 1], level.shape) * np.sqrt(level)
    assert len(p) > 100_000
    solved, placed = tracker.ik(p), tracker.fk(q)
    assert np.all((solved.status == OK) | (solved.status == SINGULAR))
    assert np.max(nearest(solved.q, q)) < 1e-7
    assert np.max(nearest(placed.p, p)) < 1e-5
    again = tracker.fk(solved.q)
    back = nearest(again.p.reshape(-1, 2, 3), np.repeat(p, 4, 0)).reshape(-1, 4)
    assert np.max(back[solved.status == OK]) < 1e-11


def test_newton_finds_no_posture_that_the_closed_form_lacks(tracker: ModuleType) -> None:
    rng = np.random.default_rng(2)
    q = np.repeat(rng.uniform(-1, 1, (200, 2)), 30, 0)
    p = rng.uniform(-1, 1, (len(q), 3))
    with np.errstate(all="ignore"):
        for _ in range(60):
            rows = [p, p.copy(), p.copy()]
            for k, c in enumerate(COLUMNS):
                rows[k + 1] = p - np.column_stack([np.broadcast_to(c, (len(q), 2)), q[:, k]])
            A = 2 * np.stack(rows, 1)
            p = p - np.einsum("nij,nj->ni", np.linalg.pinv(A), missed(p, q))
    closed = np.max(np.abs(missed(p, q)), 1) < 1e-12
    placed = tracker.fk(q)
    assert np.mean(closed) > 0.2
    assert np.max(nearest(placed.p[closed], p[closed])) < 1e-5
    there = placed.status != UNREACHABLE
    answers = placed.p[there]
    assert np.max(np.abs(missed(answers, np.repeat(q, 2, 0)[there.ravel()]))) < 1e-12


def test_a_target_off_the_sphere_is_unreachable(tracker: ModuleType) -> None:
    p = np.array([0.3, 0.0, 0.4])
    assert np.all(tracker.ik(p).status == OK)
    assert np.all(tracker.ik(1.001 * p).status == UNREACHABLE)


@pytest.mark.parametrize(
    ("old", "other", "message"),
    [
        ("[joints.q1]", "[joints.o2]\nbetween = ['ground', 'stay']\nat = 'O'\n"
         "[bodies.stay]\nlength = 'h'\n[joints.q1]", "only one may"),
        ("[joints.q2]", "[joints.q3]\nbetween = ['ground', 'slider1']\nat = 'O'\n"
         "kind = 'prismatic'\naxis = [0, 0, 1]\ndriven = true\n[joints.q2]",
         "a leg has one driven joint"),
        ('at = "O"\nkind = "universal"', 'at = "U"\nkind = "universal"', "ground has no point U"),
    ],
)  # fmt: skip
def test_a_strut_that_cannot_be_says_why(
    old: str, other: str, message: str, tmp_path: Path
) -> None:
    with pytest.raises(TableError, match=message):
        script_of("tracker", TRACKER.replace(old, other), tmp_path)
