"""Targets of mechanisms without ``fk``, put into the inverse: it is judged by the loops it closes.

The hand and the distance of each of its joints from the line of the slider follow from the target,
so the rod is drawn, and with it which targets are reachable.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from closedform.model.tolerances import DOUBLE

from .lengths import NEAR, draw_lengths
from .outcome import Failure, Outcome, hexed, unhexed
from .robots import BACKENDS, Robot, robot, without_forward_map

NAME = "targets"
SIZE = 2000
KEPT = 2
ROD = "l"
"""The parameter that is the length of every rod."""

Array = NDArray[Any]
OK, _, SINGULAR, _ = range(4)


def round(rng: np.random.Generator) -> Outcome:
    """Some thousand targets of every mechanism, with as many sets of dimensions."""
    outcome = Outcome()
    for subject in without_forward_map():
        lengths = draw_lengths(rng, subject, SIZE)
        x, corner = _targets(rng, lengths)
        at_limit = _rods(rng, subject, lengths, x)
        if rng.random() < 0.2:
            power = 2.0 ** float(rng.integers(-400, 400))
            lengths, x = lengths * power, x * (power, 1.0, 1.0)
        problems = check(subject, lengths, x)
        lost = {row for kind, row, _ in problems if kind == "lost"}
        wrong = {row for kind, row, _ in problems if kind != "lost"}
        singular = int((corner | at_limit).sum())
        outcome.count(
            subject.name,
            targets=SIZE - singular,
            singular=singular,
            lost=len(lost),
            wrong=len(wrong),
        )
        kinds: Counter[str] = Counter()
        for kind, row, message in problems:
            kinds[kind] += 1
            if kinds[kind] <= KEPT:
                case = {"robot": subject.name, "lengths": hexed(lengths[row]), "x": hexed(x[row])}
                outcome.failures.append(Failure(NAME, f"{subject.name}: {message}", case))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """What is wrong with one saved target."""
    lengths, x = (np.array([unhexed(case[key])]) for key in ("lengths", "x"))
    return [message for _, _, message in check(robot(case["robot"]), lengths, x)]


def _targets(rng: np.random.Generator, lengths: Array) -> tuple[Array, Array]:
    """Heights and tilts, random or at and near right angles, and which of them are."""
    n = len(lengths)
    tilts = rng.uniform(-np.pi, np.pi, (n, 2))
    near = rng.choice(NEAR, (n, 2)) * rng.choice((-1.0, 1.0), (n, 2))
    corners = rng.choice((-np.pi, -np.pi / 2, 0.0, np.pi / 2, np.pi), (n, 2)) + near
    there = rng.random((n, 2)) < 0.3
    height = rng.uniform(-1, 1, (n, 1)) * lengths.sum(axis=1, keepdims=True)
    return np.hstack([height, np.where(there, corners, tilts)]), there.any(axis=1)


def _rods(rng: np.random.Generator, subject: Robot, lengths: Array, x: Array) -> Array:
    """Let some of the rods reach only just, or only just not; returns which."""
    distances, _ = _across(subject, lengths, x)
    there = rng.random(len(x)) < 0.5
    change = 1 + rng.choice(NEAR, len(x)) * rng.choice((-1.0, 1.0), len(x))
    rows, legs = np.arange(len(x)), rng.integers(0, distances.shape[1], len(x))
    column = subject.fields.index(ROD)
    lengths[:, column] = np.where(there, distances[rows, legs] * change, lengths[:, column])
    return there


def _across(subject: Robot, lengths: Array, x: Array) -> tuple[Array, Array]:
    """How far each joint of the hand is from the line of its slider, and where along this line."""
    module = subject.module("numpy")
    still = np.zeros((len(x), len(subject.joints)))
    points = module.skeleton(x, still, tuple(lengths.T))
    start, end = (points[:, list(ends)] for ends in zip(*_rod_ends(module), strict=True))
    apart = end - start
    return np.hypot(apart[..., 0], apart[..., 1]), apart[..., 2]


def _rod_ends(module: Any) -> list[tuple[int, int]]:
    """The points at which the rods begin, at the sliders, and end, at the hand."""
    at = module.SKELETON.points.index
    rods = [ends for name, ends in module.SKELETON.links.items() if name.startswith("rod")]
    return [(at(first), at(last)) for first, last in rods]


def check(subject: Robot, lengths: Array, x: Array) -> list[tuple[str, int, str]]:
    """What is wrong, as kind, row and message."""
    problems: list[tuple[str, int, str]] = []
    statuses = {}
    for backend in BACKENDS:
        module = subject.module(backend)
        solutions = module.ik(x, tuple(lengths.T))
        statuses[backend] = np.asarray(solutions.status)
        found = _judged(subject, lengths, x, solutions)
        problems += [(kind, row, f"{backend}: {message}") for kind, row, message in found]
    alone = [subject.module("c").ik(t, tuple(p)).status for t, p in zip(x, lengths, strict=True)]
    for others, where in ((statuses["numpy"], "in NumPy"), (np.array(alone), "alone")):
        for row in np.flatnonzero((statuses["c"] != others).any(axis=1)):
            told = f"status {statuses['c'][row]} in a batch, {others[row]} {where}"
            problems.append(("status", int(row), told))
    return problems


def _judged(subject: Robot, lengths: Array, x: Array, solutions: Any) -> list[tuple[str, int, str]]:
    status, q = np.asarray(solutions.status), np.asarray(solutions.q)
    ok, singular = status == OK, status == SINGULAR
    distances, level = _across(subject, lengths, x)
    rod = lengths[:, [subject.fields.index(ROD)]]
    size = lengths.sum(axis=1) + np.abs(x[:, 0])
    size = np.where(size > 0, size, 1.0)
    problems = []
    reaches = (distances <= rod).all(axis=1)
    for row in np.flatnonzero(reaches & ~(ok | singular).any(axis=1)):
        problems.append(("lost", int(row), f"lost, status {status[row]}"))
    beyond = (distances > rod + 1e-6 * size[:, None]).any(axis=1)
    for row in np.flatnonzero(beyond & ok.any(axis=1)):
        problems.append(("reach", int(row), "OK beyond the reach of a rod"))
    with np.errstate(invalid="ignore"):
        up = level[:, None] - q
        misses = np.abs(np.hypot(distances[:, None], up) - rod[:, None]).max(axis=2)
    wrong = ok & ~(misses <= DOUBLE.round_trip * size[:, None])
    for row in np.flatnonzero(wrong.any(axis=1)):
        worst = np.nanmax(np.where(ok[row], misses[row], 0)) / size[row]
        problems.append(("miss", int(row), f"OK misses by {worst:.2g} of the lengths"))
    finite = np.isfinite(q).all(axis=2)
    for row in np.flatnonzero((finite != (ok | singular)).any(axis=1)):
        problems.append(("nan", int(row), f"status {status[row]} beside {q[row].tolist()}"))
    wide = ok.all(axis=1) & (distances < 0.9 * rod).all(axis=1)
    for row in np.flatnonzero(wide):
        if len({tuple(answer) for answer in q[row]}) != q.shape[1]:
            problems.append(("twice", int(row), "two branches are one"))
    return problems
