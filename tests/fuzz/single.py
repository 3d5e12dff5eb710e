"""Postures in single precision: an ``OK`` answer may miss its target by its promise, not more.

The targets are images of postures, or such images moved out of reach. Double precision is the
reference for the image of each answer. A lost posture is counted and is not a failure, because the
digits of single precision do not suffice where several parts of the singular set meet.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from given import beside

from closedform.model.tolerances import FLOAT

from .lengths import draw_lengths, draw_postures
from .outcome import Failure, Outcome, hexed, unhexed
from .postures import KEPT, OK, SINGULAR, SIZE, Array, again, reached
from .robots import Robot, robot, robots

NAME = "single"
MOST = 100
"""The largest quotient of two lengths."""


def round(rng: np.random.Generator) -> Outcome:
    """Some thousand postures of every mechanism, with as many sets of dimensions."""
    outcome = Outcome()
    for subject in robots():
        lengths = draw_lengths(rng, subject, SIZE)
        lengths = _rounded(lengths[_are_alike(subject, lengths)])
        q, singular = draw_postures(rng, subject, lengths)
        q = _rounded(q)
        away = np.where(rng.random(len(q)) < 0.5, 0.0, 10 ** rng.uniform(-8, -1, len(q)))
        lost, misses = check(subject, lengths, q, away)
        outcome.count(
            subject.name,
            postures=int((~singular).sum()),
            singular=int(singular.sum()),
            lost=lost,
            wrong=len(misses),
        )
        for row, message in misses[:KEPT]:
            case = {"robot": subject.name, "away": float(away[row]).hex()}
            case |= {"lengths": hexed(lengths[row]), "q": hexed(q[row])}
            outcome.failures.append(Failure(NAME, f"{subject.name}: {message}", case))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """What is wrong with one saved posture."""
    lengths, q = (np.array([unhexed(case[key])]) for key in ("lengths", "q"))
    away = np.array([float.fromhex(case["away"])])
    return [message for _, message in check(robot(case["robot"]), lengths, q, away)[1]]


def check(
    subject: Robot, lengths: Array, q: Array, away: Array
) -> tuple[int, list[tuple[int, str]]]:
    """How many postures are lost, and which rows have an answer that misses its target."""
    numpy, array = subject.module("numpy"), subject.module("array")
    image, rows = reached(subject, numpy, lengths, q)
    lengths, q, away = lengths[rows], q[rows], away[rows]
    if image.shape[1:] == (4, 4):
        image[:, :3, 3] *= 1 + away[:, None]
    elif image.shape[1:] != (3, 3):
        image = image * (1 + away[:, None])
    target = image.astype(np.float32)
    given = [np.asarray(v).astype(np.float32) for v in beside(numpy, q, tuple(lengths.T))]
    found = array.ik(target, *given, tuple(lengths.T.astype(np.float32)))
    status = np.asarray(found.status)
    misses = again(subject, numpy, lengths, np.asarray(found.q, float), target.astype(float))
    ok = status == OK
    lost = ~np.isin(status, (OK, SINGULAR)).any(axis=1) & (away == 0)
    allowed = [max(FLOAT.round_trip, FLOAT.promised(subject.condition(*p))) for p in lengths]
    # where the answer is just out of reach of fk, this has no image in double precision
    wrong = ok & np.isfinite(misses) & (misses > np.reshape(allowed, (-1, 1)))
    return int(lost.sum()), [
        (int(rows[i]), f"OK misses by {misses[i][wrong[i]].max():.2g} of the lengths")
        for i in np.flatnonzero(wrong.any(axis=1))
    ]


def _are_alike(subject: Robot, lengths: Array) -> Array:
    sizes = subject.lengths_of(lengths)
    if not sizes.shape[1]:
        return np.ones(len(lengths), bool)
    least = np.where(sizes > 0, sizes, np.inf).min(axis=1)
    return np.asarray(sizes.max(axis=1) <= MOST * least)


def _rounded(values: Array) -> Array:
    return values.astype(np.float32).astype(float)
