"""The attacks of ``make fuzz``: saved failures stay mended, and a fault is found."""

import importlib
import json
import multiprocessing
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from closedform.generated.c import planar_2r, three_prs
from fuzz import ATTACKS, arguments, kernels, postures, single, tables, targets
from fuzz.__main__ import attack, table
from fuzz.outcome import CASES
from fuzz.robots import Robot, robot

SEED = 20
TABLE = {"kind": "dh", "name": "arm", "text": "", "modified": False}
QUICK = ("planar_2r", "puma560", "rpr_planar", "scara", "spherical_wrist", "stanford_arm", "ur_arm")
"""Mechanisms whose derivations are loaded in a few seconds."""


@pytest.mark.parametrize("path", sorted(CASES.glob("*.json")), ids=lambda path: path.stem)
def test_saved_case(path: Path) -> None:
    case = json.loads(path.read_text("utf-8"))
    assert ATTACKS[case["attack"]].replay(case) == []


def test_small_round(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(postures, "SIZE", 150)
    monkeypatch.setattr(single, "SIZE", 150)
    for module in (postures, single):
        monkeypatch.setattr(module, "robots", lambda: tuple(map(robot, QUICK)))
    monkeypatch.setattr(targets, "SIZE", 150)
    monkeypatch.setattr(arguments, "CALLS", 300)
    monkeypatch.setattr(tables, "TABLES", 25)
    total = attack([postures, targets, single, arguments, tables], SEED, 0, tmp_path)
    assert [f.problem for outcome in total.values() for f in outcome.failures] == []
    printed = "\n".join(table(total))
    assert "| ur_arm | " in printed
    assert "| three_prs | " in printed


def test_another_unit_of_length_changes_no_angle() -> None:
    subject = robot("delta")
    given = np.array([subject.defaults])
    rng = np.random.default_rng(SEED)
    lengths, _ = postures._rescaled(rng, subject, given, np.zeros((1, 3)))
    angles = np.array([f.startswith("alpha") for f in subject.fields])
    assert (lengths[:, angles] == given[:, angles]).all()
    assert (lengths[:, ~angles] != given[:, ~angles]).all()
    assert subject.lengths_of(given).shape == (1, 4)


@pytest.mark.skipif(not kernels.available(), reason="gcc and its sanitizers are needed")
def test_bare_c() -> None:
    outcome = kernels.round(np.random.default_rng(SEED))
    assert outcome.failures == []


def one_off(x, params):
    q, status = planar_2r.ik(x, params)
    return planar_2r.Solutions(q + 1e-9, status)


def lossy(x, params):
    q, status = planar_2r.ik(x, params)
    return planar_2r.Solutions(np.full_like(q, np.nan), np.ones_like(status))


def careless(x, params):
    q, status = planar_2r.ik(x, params)
    return planar_2r.Solutions(np.where(q > 0, np.nan, q), status)


@pytest.mark.parametrize(
    ("ik", "kind"),
    [(one_off, "miss"), (lossy, "lost"), (careless, "nan")],
    ids=["one_off", "lossy", "careless"],
)
def test_faults_are_found(monkeypatch: pytest.MonkeyPatch, ik, kind: str) -> None:
    planar = robot("planar_2r")
    kept = {name: getattr(planar_2r, name) for name in ("JOINTS", "fk", "singularities")}
    broken = SimpleNamespace(**kept, ik=ik)
    monkeypatch.setattr(Robot, "module", lambda _self, _backend: broken)
    rng = np.random.default_rng(0)
    lengths = np.tile(planar.defaults, (100, 1))
    q = rng.uniform(-np.pi, np.pi, (100, 2))
    assert kind in {problem for problem, _, _ in postures.check(planar, lengths, q)}


@pytest.mark.parametrize(
    ("change", "lost", "wrong"),
    [
        (lambda q, status: (q, status), 0, False),
        (lambda q, status: (q + 1e-4, status), 0, True),
        (lambda q, status: (q, np.ones_like(status)), 100, False),
    ],
    ids=["right", "one_off", "lossy"],
)
def test_faults_in_single_precision_are_found(
    monkeypatch: pytest.MonkeyPatch, change, lost: int, wrong: bool
) -> None:
    def ik(x, params):
        return planar_2r.Solutions(*change(*kept(x, params)))

    planar = robot("planar_2r")
    array = planar.module("array")
    kept = array.ik
    monkeypatch.setattr(array, "ik", ik)
    lengths = np.tile(np.float32(planar.defaults).astype(float), (100, 1))
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (100, 2))
    found, misses = single.check(planar, lengths, q, np.zeros(100))
    assert (found, bool(misses)) == (lost, wrong)


@pytest.mark.parametrize(
    ("change", "kind"),
    [
        (lambda q, status: (q + 1e-9, status), "miss"),
        (lambda q, status: (np.full_like(q, np.nan), np.ones_like(status)), "lost"),
        (lambda q, status: (np.repeat(q[..., ::2, :], 2, axis=-2), status), "twice"),
    ],
    ids=["one_off", "lossy", "repeating"],
)
def test_faults_without_a_forward_map_are_found(
    monkeypatch: pytest.MonkeyPatch, change, kind: str
) -> None:
    def ik(x, params):
        return three_prs.Solutions(*change(*three_prs.ik(x, params)))

    broken = SimpleNamespace(SKELETON=three_prs.SKELETON, skeleton=three_prs.skeleton, ik=ik)
    tripod = robot("three_prs")
    monkeypatch.setattr(Robot, "module", lambda _self, _backend: broken)
    x = np.random.default_rng(0).uniform(-0.3, 0.3, (50, 3))
    found = targets.check(tripod, np.tile(tripod.defaults, (50, 1)), x)
    assert kind in {problem for problem, _, _ in found}


def test_failure_is_saved_and_replayed(tmp_path: Path) -> None:
    outcome = postures.Outcome()
    case = {"robot": "planar_2r", "lengths": ["0x1p+0", "0x1p+0"], "q": ["0x1p-2", "0x1p-1"]}
    outcome.failures.append(postures.Failure("postures", "an example", case))
    path = outcome.failures[0].save(tmp_path)
    assert ATTACKS["postures"].replay(json.loads(path.read_text("utf-8"))) == []


def test_a_crash_is_a_finding() -> None:
    call = {"robot": "planar_2r", "function": "no_such_function", "arguments": [], "params": None}
    (problem,) = arguments.replay({"call": call})
    assert "no_such_function" in problem


def test_a_table_that_acts_is_a_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tables, "new", lambda *_a, **_k: os.system("true"))
    (problem,) = tables.replay(TABLE)
    assert "os.system" in problem


@pytest.mark.parametrize("write", [os.open, open], ids=["os.open", "open"])
def test_a_table_that_writes_in_another_process_is_a_finding(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, write
) -> None:
    """An exception there ends the process; the reader would only say that it took too long."""
    mode = os.O_WRONLY | os.O_CREAT if write is os.open else "w"

    def writes(*_a, **_k) -> None:
        process = multiprocessing.get_context("fork").Process(target=write, args=(made, mode))
        process.start()
        process.join()
        raise ValueError("it took too long")

    made = tmp_path / "made"
    monkeypatch.setattr(tables, "new", writes)
    (problem,) = tables.replay(TABLE)
    assert "open" in problem
    assert not made.exists()


def test_bytecode_that_python_keeps_is_not_a_finding(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "imported_late.py").write_text("text = 'd = 1'\n", "utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.setattr(tables, "new", lambda *_a, **_k: importlib.import_module("imported_late"))
    assert tables.replay(TABLE) == []
    assert not sys.dont_write_bytecode
