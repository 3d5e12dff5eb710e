"""What is checked, and what is found: a back end, a finding for each function, and their table."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from closedform.check.samples import Sample
from closedform.model.functions import Function
from closedform.model.tolerances import DOUBLE, FLOAT, Tolerances

MISSED = 10
"""By how many tolerances single precision may miss where its digits do not suffice."""
MENTIONED = 5
"""The number of failures of a function that are reported."""


@dataclass(frozen=True)
class Backend:
    """Generated code under test: its functions by name, its float type and its tolerances."""

    name: str
    function: Callable[[str], Callable[..., Any]]
    dtype: type
    tolerances: Tolerances
    broadcasts: bool = False
    """Whether each parameter may be an array, with a value for each row."""

    @property
    def eps(self) -> float:
        return float(np.finfo(self.dtype).eps)

    def finding(self, robot: str, function: str, unit: str = "ulp") -> Finding:
        """A finding without anything in it."""
        return Finding(robot, function, self.name, unit, single=self.dtype is np.float32)


def module_backend(name: str, module: ModuleType) -> Backend:
    """A generated Python module, NumPy or compiled C."""
    return Backend(name, lambda function: getattr(module, function), np.float64, DOUBLE, True)


def float_backend(call: Callable[[str], Callable[..., Any]]) -> Backend:
    """Single-precision C, called through ``call(name)(*inputs, params)``."""
    return Backend("c float", call, np.float32, FLOAT)


@dataclass
class Finding:
    """The worst error of one function in one backend, and where; no ``failures`` if it is right.

    In ``single`` precision, ``limits`` tell what it cannot do, mostly near singular postures or
    with very unequal lengths.
    """

    robot: str
    function: str
    backend: str
    unit: str = "ulp"
    worst: float = 0.0
    where: str = ""
    compared: int = 0
    failures: list[str] = field(default_factory=list)
    single: bool = False
    limits: list[str] = field(default_factory=list)

    @property
    def full(self) -> bool:
        """Whether further failures are left out of the report."""
        return len(self.failures) >= MENTIONED

    def see(self, error: float, where: Callable[[], str]) -> None:
        if error > self.worst or math.isnan(error):
            self.worst, self.where = error, where()

    def fail(self, message: str, *, limited: bool = False) -> None:
        """Report an error; with ``limited``, the digits of single precision may not suffice."""
        if limited and self.single:
            self.limits.append(message)
        elif not self.full:
            self.failures.append(message)


def rounded(sample: Sample, backend: Backend) -> Sample:
    """The sample in the float type of the backend, as doubles."""
    if backend.dtype is np.float64:
        return sample
    with np.errstate(over="ignore", under="ignore"):
        values = sample.values.astype(backend.dtype).astype(np.float64)
        parameters = np.asarray(sample.parameters, backend.dtype).astype(np.float64)
    keep = np.isfinite(values).all(axis=1)
    return Sample(sample.name, values[keep], tuple(float(p) for p in parameters))


def thinned(sample: Sample, entries: int) -> Sample:
    """Fewer rows for a function with many entries, because each entry is evaluated in Arb."""
    return Sample(sample.name, sample.values[:: max(1, entries // 12)], sample.parameters)


def called(backend: Backend, function: Function, sample: Sample) -> tuple[NDArray[Any], ...]:
    """The results at each row of a sample: the answers and the status, or each output."""
    return _called(backend, function, sample.values, sample.parameters)


def _called(
    backend: Backend, function: Function, values: NDArray[Any], parameters: Sequence[Any]
) -> tuple[NDArray[Any], ...]:
    inputs, column = [], 0
    for argument in function.inputs:
        part = values[:, column : column + argument.size]
        inputs.append(part.reshape((len(part), *argument.shape)))
        column += argument.size
    result = backend.function(function.name)(*inputs, tuple(parameters))
    parts = [np.asarray(p) for p in (result if isinstance(result, tuple) else (result,))]
    if function.has_status:  # the entries of a matrix are the unknowns of a solution
        answers, status = parts
        return answers.reshape(*status.shape, -1), status
    return tuple(parts)


def called_at_all(
    backend: Backend, function: Function, samples: Sequence[Sample], *, mixed: bool = False
) -> list[tuple[NDArray[Any], ...]]:
    """The results at each sample; those with the same parameters are one batch of the code.

    With ``mixed``, all samples are one batch if parameters may be arrays.
    """
    if not function.inputs:
        return [called(backend, function, sample) for sample in samples]
    found: dict[int, tuple[NDArray[Any], ...]] = {}
    groups: dict[tuple[float, ...], list[int]] = {}
    mixed = mixed and backend.broadcasts
    for k, sample in enumerate(samples):
        groups.setdefault(() if mixed else sample.parameters, []).append(k)
    for same, members in groups.items():
        rows = np.concatenate([samples[k].rows for k in members])
        values, sizes = np.split(rows, [sum(a.size for a in function.inputs)], axis=1)
        results = _called(backend, function, values, [*sizes.T] if mixed else same)
        ends = np.cumsum([len(samples[k].values) for k in members])[:-1]
        for k, *parts in zip(members, *(np.split(r, ends) for r in results), strict=True):
            found[k] = tuple(parts)
    return [found[k] for k in range(len(samples))]


def table(findings: Sequence[Finding]) -> Iterator[str]:
    """The worst errors as lines of text: a row for each function, a column for each backend."""
    names = list(dict.fromkeys(f.backend for f in findings))
    rows: dict[tuple[str, str], dict[str, Finding]] = {}
    for f in findings:
        rows.setdefault((f"{f.robot}.{f.function}", f.unit), {})[f.backend] = f
    yield f"{'function':34}{'unit':>16}" + "".join(f"{n:>12}" for n in names)
    for (name, unit), cells in rows.items():
        shown = "".join(f"{cells[n].worst:12.2f}" if n in cells else " " * 12 for n in names)
        yield f"{name:34}{unit:>16}{shown}"
