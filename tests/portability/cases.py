"""Ordinary postures and the answers of the NumPy modules, to compare every other build with.

Postures at which rounding decides are left out: there a change of a few units in the last place of
an input changes a status, or an answer by much.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from closedform.model.derivation import Derivation
from closedform.model.functions import Function

from .driver import (
    HEADER,
    Answer,
    Array,
    Program,
    Request,
    derivation,
    numpy_values,
    signature,
)

POSTURES = 12
TOLERANCE = {False: 1e-10, True: 2e-3}  # for a value of size 1, in double and in float
NUDGE = {False: 1e-15, True: 1e-7}
DECIDED_BY_ROUNDING = 0.2
"""The thresholds of a status are wider in single precision, where this share may differ."""


@dataclass(frozen=True)
class Case:
    """A request and the answer of NumPy, reals before bytes."""

    request: Request
    expected: Array
    n_real: int


def cases(robots: Sequence[str], *, single: bool) -> list[Case]:
    found = [_header(single)]
    for robot in robots:
        d = derivation(robot)
        for function in d.functions:
            case = _case(robot, d, function, single)
            if case is not None:
                found.append(case)
    return found


def _rounded(values: Array, single: bool) -> Array:
    return values.astype(np.float32).astype(np.float64) if single else values


def _header(single: bool) -> Case:
    """The values of libm in double precision."""
    rng = np.random.default_rng(0)
    rows = _rounded(rng.uniform(-9, 9, (40, 2)), single)
    x, y = rows.T
    turn = [np.arctan2(np.sin(v), np.cos(v)) for v in (x, y)]
    expected = [np.sin(x), np.sin(y), np.cos(x), np.cos(y), np.arctan2(x, y), *turn]
    return Case(Request(HEADER, (), rows), np.stack(expected, axis=1), 7)


def _inputs(d: Derivation, robot: str, function: Function, parameters: list[float]) -> Array:
    rng = np.random.default_rng(1)
    size = sum(a.size for a in function.inputs)
    inverse = next((i for i in d.inverses if i.function == function.name), None)
    if inverse is None or not (inverse.images or inverse.targets == function.symbols):
        return rng.uniform(-1.5, 1.5, (8 * POSTURES, size))
    forward = d[inverse.images or "fk"]
    joints = rng.uniform(-1.5, 1.5, (8 * POSTURES, sum(a.size for a in forward.inputs)))
    images = numpy_values(robot, forward, joints, parameters)[0]
    images = images[:, : function.inputs[0].size]  # of assembly modes, the first
    named = {s.name: joints[:, k : k + 1] for k, s in enumerate(d.actuated)}
    given = [
        named[a.name] if a.name in named else numpy_values(robot, d[a.name], joints, parameters)[0]
        for a in function.inputs[1:]
    ]
    images = np.concatenate([images, *given], axis=1)
    return images[np.isfinite(images).all(axis=1)]


def _case(robot: str, d: Derivation, function: Function, single: bool) -> Case | None:
    exact = np.array([float(p.value) for p in d.parameters])
    parameters = _rounded(exact, single).tolist()
    rows = _rounded(_inputs(d, robot, function, parameters), single)
    if function.inputs and (
        not len(rows) or rows.shape[1] != sum(signature(robot, function.name).inputs)
    ):
        return None
    if not function.inputs:
        rows = np.empty((1, 0))
    expected = _joined(numpy_values(robot, function, rows, parameters))
    n_real = signature(robot, function.name).n_real
    steady = np.ones(len(rows), bool)
    for sign in (1, -1):
        moved = rows * (1 + sign * NUDGE[single] * 4)
        other = _joined(numpy_values(robot, function, moved, parameters))
        steady &= agree(other, expected, n_real, TOLERANCE[single] / 10).all(axis=1)
    if single:  # rounding took the target off the sphere, for example, that a hand moves on
        steady &= ~np.isnan(expected[:, :n_real]).all(axis=1)
    rows, expected = rows[steady][:POSTURES], expected[steady][:POSTURES]
    if not len(rows):
        return None
    return Case(Request((robot, function.name), tuple(parameters), rows), expected, n_real)


def _joined(parts: list[Array]) -> Array:
    real = [p for p in parts if p.dtype == np.float64]
    return np.concatenate(real + [p.astype(float) for p in parts if p.dtype != np.float64], axis=1)


def agree(values: Array, expected: Array, n_real: int, tolerance: float) -> np.ndarray:
    """The difference, modulo whole turns for values near pi."""
    with np.errstate(invalid="ignore"):
        gap = np.abs(values - expected)
        turned = np.abs(gap - 2 * np.pi)
        ends = (np.abs(np.abs(values) - np.pi) < 1e-2) & (np.abs(np.abs(expected) - np.pi) < 1e-2)
    close = gap <= tolerance * np.maximum(1, np.abs(expected))
    close |= ends & (turned <= tolerance) | np.isnan(values) & np.isnan(expected)
    close |= values == expected
    close[:, n_real:] = values[:, n_real:] == expected[:, n_real:]
    return np.asarray(close)


def mismatches(program: Program, wanted: Sequence[Case], *, single: bool) -> Iterator[str]:
    """A line for each function whose answers differ, in single calls or in a batch."""
    answers = program.ask([case.request for case in wanted])
    for case, answer in zip(wanted, answers, strict=True):
        for form, values in _forms(answer):
            close = agree(values, case.expected, case.n_real, TOLERANCE[single])
            statuses = close[:, case.n_real :]
            if single and statuses.size and (~statuses).mean() <= DECIDED_BY_ROUNDING:
                close[~statuses.all(axis=1)] = True
            if not close.all():
                row, k = np.argwhere(~close)[0]
                yield (
                    f"{'.'.join(case.request.name)} {form}: {values[row, k]} instead of "
                    f"{case.expected[row, k]} at {case.request.rows[row].tolist()}"
                )


def _forms(answer: Answer) -> tuple[tuple[str, Array], ...]:
    return ("single", answer.single), ("batch", answer.batch)
