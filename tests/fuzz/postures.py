"""Images of postures, put into the inverse: no posture may be lost, no answer may be wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from given import beside
from numpy.typing import NDArray

from closedform.model.tolerances import DOUBLE

from .lengths import draw_lengths, draw_postures
from .outcome import Failure, Outcome, hexed, unhexed
from .robots import BACKENDS, Robot, robot, robots

NAME = "postures"
SIZE = 2000
KEPT = 2
"""Failures of one kind that a round keeps for one mechanism."""
GENERIC = 1e-3
"""A posture must be returned if each of its factors is more than this share of its median."""

Array = NDArray[Any]
OK, UNREACHABLE, SINGULAR, INVALID = range(4)


def round(rng: np.random.Generator) -> Outcome:
    """Some thousand postures of every mechanism, with as many sets of dimensions."""
    outcome = Outcome()
    for subject in robots():
        lengths = draw_lengths(rng, subject, SIZE)
        q, singular = draw_postures(rng, subject, lengths)
        if rng.random() < 0.2:
            lengths, q = _rescaled(rng, subject, lengths, q)
        problems = check(subject, lengths, q)
        lost = {row for kind, row, _ in problems if kind == "lost"}
        wrong = {row for kind, row, _ in problems if kind != "lost"}
        outcome.count(
            subject.name,
            postures=int((~singular).sum()),
            singular=int(singular.sum()),
            lost=len(lost),
            wrong=len(wrong),
        )
        kinds: dict[str, int] = {}
        for kind, row, message in problems:
            kinds[kind] = kinds.get(kind, 0) + 1
            if kinds[kind] <= KEPT:
                case = {"robot": subject.name, "lengths": hexed(lengths[row]), "q": hexed(q[row])}
                outcome.failures.append(Failure(NAME, f"{subject.name}: {message}", case))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """What is wrong with one saved posture."""
    lengths, q = (np.array([unhexed(case[key])]) for key in ("lengths", "q"))
    return [message for _, _, message in check(robot(case["robot"]), lengths, q)]


def _rescaled(
    rng: np.random.Generator, subject: Robot, lengths: Array, q: Array
) -> tuple[Array, Array]:
    """The same postures in other units: all lengths are multiplied by a power of two."""
    power = 2.0 ** float(rng.integers(-900, 900))
    lengths = np.where(subject.turned, lengths, lengths * power)
    return lengths, np.where(subject.slides, q * power, q)


def check(subject: Robot, lengths: Array, q: Array) -> list[tuple[str, int, str]]:
    """What is wrong, as kind, row and message."""
    problems: list[tuple[str, int, str]] = []
    statuses = {}
    for backend in BACKENDS:
        module = subject.module(backend)
        image, rows = reached(subject, module, lengths, q)
        more = beside(module, q[rows], tuple(lengths[rows].T))
        solutions = module.ik(image, *more, tuple(lengths[rows].T))
        misses = again(subject, module, lengths[rows], solutions.q, image)
        statuses[backend] = np.asarray(solutions.status)
        found = _judged(subject, lengths[rows], q[rows], solutions, misses)
        problems += [(k, int(rows[i]), f"{backend}: {message}") for k, i, message in found]
        if backend == "c":
            alone = [
                module.ik(*x, tuple(p)).status
                for *x, p in zip(image, *more, lengths[rows], strict=True)
            ]
            alone = np.array(alone).reshape(statuses["c"].shape)
            differ = np.flatnonzero((alone != statuses["c"]).any(axis=1))
            problems += [
                ("status", int(rows[i]), f"status {statuses['c'][i]} in a batch, {alone[i]} alone")
                for i in differ
            ]
        else:
            given, given_rows = (image, *more), rows
    other = np.asarray(subject.module("c").ik(*given, tuple(lengths[given_rows].T)).status)
    differ = np.flatnonzero((statuses["numpy"] != other).any(axis=1))
    problems += [
        ("status", int(given_rows[i]), f"status {statuses['numpy'][i]} in NumPy, {other[i]} in C")
        for i in differ
    ]
    return problems


def reached(
    subject: Robot, module: Any, lengths: Array, q: Array
) -> tuple[Array, NDArray[np.intp]]:
    """Targets that the forward map reaches, and the row of the posture of each."""
    image = module.fk(q, tuple(lengths.T))
    rows = np.arange(len(q))
    if subject.modes:
        modes = image.p.shape[1]
        exists = (image.status == OK).ravel()
        targets = image.p.reshape(len(q) * modes, *image.p.shape[2:])
        rows = np.repeat(rows, modes)
    else:
        targets = image
        exists = np.isfinite(image.reshape(len(q), -1)).all(axis=1)
    return targets[exists], rows[exists]


def again(subject: Robot, module: Any, lengths: Array, q: Array, reached: Array) -> Array:
    """How far the answer of each branch misses its target, in units of the lengths."""
    n, branches = q.shape[:2]
    params = tuple(np.repeat(lengths, branches, axis=0).T)
    image = module.fk(q.reshape(n * branches, q.shape[2]), params)
    target = np.repeat(reached, branches, axis=0)
    slides = np.abs(np.where(subject.slides, q, 0.0)).sum(axis=2).ravel()
    size = np.repeat(subject.lengths_of(lengths).sum(axis=1), branches) + np.nan_to_num(slides)
    size = np.where(size > 0, size, 1.0)
    if subject.modes:
        error = np.abs(image.p - target[:, None])
        if target.ndim == 2:
            error = _relative(subject, error, size[:, None, None])
        miss = error.max(axis=tuple(range(2, error.ndim)))
        return np.asarray(np.where(np.isnan(miss), np.inf, miss).min(axis=1).reshape(n, branches))
    error = np.abs(image - target)
    if target.ndim == 2:
        error = _relative(subject, error, size[:, None])
    elif target.shape[1:] == (4, 4):
        error[:, :3, 3] /= size[:, None]
    worst = error.reshape(n, branches, -1).max(axis=2)
    return np.asarray(np.where(np.isnan(worst), np.inf, worst))


def _relative(subject: Robot, error: Array, size: Array) -> Array:
    """Errors of coordinates: angles modulo a turn, lengths in units of the size."""
    turned = np.abs(np.remainder(error + np.pi, 2 * np.pi) - np.pi)
    return np.where(subject.angles, turned, error / size)


def _judged(
    subject: Robot, lengths: Array, q: Array, solutions: Any, misses: Array
) -> list[tuple[str, int, str]]:
    status = np.asarray(solutions.status)
    answers = np.asarray(solutions.q)
    ok, singular = status == OK, status == SINGULAR
    problems = []
    for i in np.flatnonzero(~(ok | singular).any(axis=1)):
        problems.append(("lost", int(i), f"lost, status {status[i]}"))
    allowed = [max(DOUBLE.round_trip, DOUBLE.promised(subject.condition(*p))) for p in lengths]
    wrong = ok & ~(misses <= np.reshape(allowed, (-1, 1)))
    for i in np.flatnonzero(wrong.any(axis=1)):
        worst = misses[i][ok[i]].max()
        problems.append(("miss", int(i), f"OK misses by {worst:.2g} of the lengths"))
    finite = np.isfinite(answers).all(axis=2)
    for i in np.flatnonzero((finite != (ok | singular)).any(axis=1)):
        problems.append(("nan", int(i), f"status {status[i]} beside {answers[i].tolist()}"))
    turns = answers[..., subject.revolute]
    outside = ((turns <= -np.pi) | (turns > np.pi)).any(axis=(1, 2))
    for i in np.flatnonzero(outside):
        problems.append(("range", int(i), "an angle is outside of (-pi, pi]"))
    for i in np.flatnonzero(_generic(subject, lengths, q) & ~singular.any(axis=1)):
        away = answers[i] - q[i]
        away = np.where(subject.slides, away, np.remainder(away + np.pi, 2 * np.pi) - np.pi)
        scale = np.where(
            subject.slides, max(subject.lengths_of(lengths[i]).sum(), np.abs(q[i]).max()), 1.0
        )
        nearest = np.nanmin(np.abs(away / scale).max(axis=1), initial=np.inf)
        if not nearest < 1e-4:
            problems.append(("missing", int(i), f"its own posture is {nearest:.2g} away"))
    return problems


def _generic(subject: Robot, lengths: Array, q: Array) -> Array:
    """Which postures are far from every part of the singular set, with lengths of one size."""
    if not len(q) or not lengths.shape[1]:
        return np.zeros(len(q), bool)
    factors = subject.module("c").singularities(q, tuple(lengths.T)).reshape(len(q), -1)
    sizes = np.hstack([subject.lengths_of(lengths), np.abs(q[:, subject.slides])])
    with np.errstate(all="ignore"):
        alike = sizes.max(axis=1) < 100 * sizes.min(axis=1)
        median = np.nanmedian(np.abs(factors[alike]), axis=0) if alike.any() else 1.0
        return np.asarray(alike & (np.abs(factors) > GENERIC * median).all(axis=1))
