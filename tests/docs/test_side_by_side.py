"""The comparison with other libraries: each that is installed gives what we give."""

from __future__ import annotations

import importlib
import re
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from places import ROOT

from benchmarks.side_by_side import __main__ as comparison
from benchmarks.side_by_side import ours
from benchmarks.side_by_side.tasks import (
    TARGETS,
    TASKS,
    TURN,
    DisagreementError,
    Way,
    Ways,
    judged,
    pose,
)

PAGE = ROOT / "docs" / "side-by-side.md"
IMPORTS = {
    "toolbox": "roboticstoolbox",
    "ssik_solver": "ssik",
    "eaik_solver": "eaik",
    "pinocchio_model": "pinocchio",
    "pyroki_solver": "pyroki",
}


@cache
def our_ways() -> Ways:
    return ours.ways()


@cache
def ways_of(peer: str) -> Ways:
    found: Ways = importlib.import_module(f"benchmarks.side_by_side.{peer}").ways()
    return found


@cache
def answer(task: str) -> Any:
    way = our_ways()[task]
    assert way.run is not None
    return way.read(way.run())


@pytest.fixture(autouse=True)
def without_windows() -> None:
    pytest.importorskip("matplotlib").use("Agg")


def test_all_peers_have_all_tasks() -> None:
    assert set(IMPORTS) == set(comparison.PEERS) and tuple(our_ways()) == TASKS


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("peer", IMPORTS)
def test_a_peer_agrees(peer: str, task: str) -> None:
    pytest.importorskip(IMPORTS[peer])
    way = ways_of(peer)[task]
    if way.run is None:
        pytest.skip(way.call)
    judged(task, way, way.read(way.run()), answer(task))


@pytest.mark.parametrize("task", ours.one_by_one())
def test_one_target_at_a_time(task: str) -> None:
    way = ours.one_by_one()[task]
    assert way.run is not None
    judged(task, way, way.read(way.run()), answer(task))


def test_targets_are_reached() -> None:
    """By the table of the maker, without anything of ours."""
    np.testing.assert_allclose(pose(answer("nearest")), TARGETS, rtol=0, atol=1e-12)


WAY = Way("")
ITERATED = replace(WAY, numeric=True)


@pytest.mark.parametrize("task", ["nearest", "tracking", "tool"])
def test_another_posture_is_noticed(task: str) -> None:
    q = answer(task).copy()
    assert judged(task, WAY, q, answer(task)) == "the same postures"
    q[3] += TURN * np.eye(6)[2]
    with pytest.raises(DisagreementError, match="1 of"):
        judged(task, WAY, q, answer(task))
    assert "another solution 1 times" in judged(task, ITERATED, q, answer(task))
    q[3] += 1e-3
    with pytest.raises(DisagreementError, match="1 postures miss"):
        judged(task, WAY, q, answer(task))
    q[4] = np.nan
    assert "none 2 times" in judged(task, ITERATED, q, answer(task))
    with pytest.raises(DisagreementError, match="only 0"):
        judged(task, ITERATED, q + TURN, answer(task))


@pytest.mark.parametrize("task", ["limits", "batch"])
def test_another_set_is_noticed(task: str) -> None:
    sets = [q.copy() for q in answer(task)]
    fewer = [sets[0][1:], *sets[1:]]
    with pytest.raises(DisagreementError, match="lacks 1"):
        judged(task, WAY, fewer, sets)
    with pytest.raises(DisagreementError, match="do not have"):
        judged(task, WAY, sets, fewer)
    with pytest.raises(DisagreementError, match="answers"):
        judged(task, WAY, sets[1:], sets)
    with pytest.raises(DisagreementError, match="only 0"):
        judged(task, ITERATED, [q[:0] for q in sets], sets)
    assert judged(task, ITERATED, [q[:1] for q in sets], sets).startswith(f"{len(sets)} of the")


def test_other_numbers_are_noticed() -> None:
    for task in ("gradient", "URDF"):
        expected = answer("gradient")
        wrong = expected + 1e-5 * (np.arange(expected.size) == 7).reshape(expected.shape)
        with pytest.raises(DisagreementError, match="1e-05"):
            judged(task, WAY, wrong, expected)
    points = answer("drawing").copy()
    judged("drawing", WAY, points, None)
    points[6, 2] += 1e-3
    with pytest.raises(DisagreementError, match="off"):
        judged("drawing", WAY, points, None)


def test_a_peer_that_differs_is_listed(monkeypatch: pytest.MonkeyPatch) -> None:
    good = our_ways()["gradient"]
    bad = replace(good, run=lambda: answer("gradient") + 1)
    found = [
        comparison.Competitor("ours", {"gradient": good}, "1", 0.0),
        comparison.Competitor("theirs", {"gradient": bad}, "1", 0.0),
        comparison.Competitor("others", {"gradient": Way("no Jacobian")}, "1", 0.0),
    ]
    rows = comparison.compared("gradient", found, 3)
    assert len(rows) == 3 and re.search(r"\| \d.* [mu]?s \|$", rows[0])
    assert rows[1].endswith("| differs: differs by 1 |  |")
    assert rows[2] == "| others | no Jacobian |  |  |"


@pytest.mark.parametrize(
    ("seconds", "told"),
    [(5.84, "5.8 s"), (0.145, "145 ms"), (0.0025, "2.5 ms"), (1.4e-6, "1.4 us"), (120, "120 s")],
)
def test_times_are_short(seconds: float, told: str) -> None:
    assert comparison.words(seconds) == told


def test_the_page_has_every_call() -> None:
    text = PAGE.read_text("utf-8")
    for task, way in our_ways().items():
        assert f"## {comparison.TITLES[task]}\n" in text and f"| {way.call} |" in text
