"""Compares generated code with the symbolic source, evaluated in Arb balls.

A function of the joints is compared value by value; its error is counted in ulps of the natural
scale (see :func:`closedform.samples.magnitude`).  An inverse is compared three ways: its answers are
put into the exact forward map, its statuses are compared with the exact bounds, and every posture
whose image is the target must be among the branches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
import sympy as sp
from flint import arb
from numpy.typing import NDArray

from closedform.derivation import Derivation, Inverse
from closedform.functions import Bound, Function, substitute
from closedform.reference import Evaluator, to_float
from closedform.samples import Sample, inverse_postures, joint_samples, magnitude, perturbed
from closedform.tolerances import DOUBLE, FLOAT, Tolerances

OK, UNREACHABLE, SINGULAR, INVALID = range(4)


@dataclass(frozen=True)
class Backend:
    """Generated code under test: its functions by name, its float type and its tolerances."""

    name: str
    function: Callable[[str], Callable[..., Any]]
    dtype: type
    tolerances: Tolerances

    @property
    def eps(self) -> float:
        return float(np.finfo(self.dtype).eps)


def module_backend(name: str, module: ModuleType) -> Backend:
    """A generated Python module, NumPy or compiled C."""
    return Backend(name, lambda function: getattr(module, function), np.float64, DOUBLE)


def float_backend(call: Callable[[str], Callable[..., Any]]) -> Backend:
    """Single-precision C, called through ``call(name)(*inputs, params)``."""
    return Backend("c float", call, np.float32, FLOAT)


@dataclass
class Finding:
    """The worst error of one function in one backend, and where; ``failures`` should be empty."""

    robot: str
    function: str
    backend: str
    unit: str = "ulp"
    worst: float = 0.0
    where: str = ""
    compared: int = 0
    failures: list[str] = field(default_factory=list)

    def see(self, error: float, where: Callable[[], str]) -> None:
        self.compared += 1
        if error > self.worst or math.isnan(error):
            self.worst, self.where = error, where()

    def fail(self, message: str) -> None:
        if len(self.failures) < 5:
            self.failures.append(message)


def crosscheck(derivation: Derivation, backend: Backend) -> list[Finding]:
    """Every function of a derivation in one backend."""
    inverses = {i.function: i for i in derivation.inverses}
    findings = []
    for function in derivation.functions:
        if function.name in inverses:
            findings.append(check_inverse(derivation, function, inverses[function.name], backend))
        else:
            findings.append(check_forward(derivation, function, backend))
    return findings


def _symbols(derivation: Derivation, function: Function) -> tuple[sp.Symbol, ...]:
    return (*function.symbols, *(p.symbol for p in derivation.parameters))


def _round(sample: Sample, backend: Backend) -> Sample:
    """The sample in the float type of the backend, as doubles."""
    if backend.dtype is np.float64:
        return sample
    with np.errstate(over="ignore", under="ignore"):
        values = sample.values.astype(backend.dtype).astype(np.float64)
        parameters = np.asarray(sample.parameters, backend.dtype).astype(np.float64)
    keep = np.isfinite(values).all(axis=1)
    return Sample(sample.name, values[keep], tuple(float(p) for p in parameters))


def _call(backend: Backend, function: Function, sample: Sample) -> tuple[NDArray[Any], ...]:
    inputs, column = [], 0
    for argument in function.inputs:
        part = sample.values[:, column : column + argument.size]
        inputs.append(part.reshape((len(part), *argument.shape)))
        column += argument.size
    result = backend.function(function.name)(*inputs, sample.parameters)
    parts = result if isinstance(result, tuple) else (result,)
    return tuple(np.asarray(p) for p in parts)


def check_forward(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare values, in ulps of their natural scale."""
    finding = Finding(derivation.name, function.name, backend.name)
    cases = [function.values(signs) for _, signs in function.cases()]
    exprs = [e for case in cases for e in case]
    symbols = _symbols(derivation, function)
    reference = Evaluator(symbols, exprs)
    scales = [sp.lambdify(symbols, magnitude(e), "math") for e in exprs]
    for sample in joint_samples(derivation, function):
        sample = _round(sample, backend)
        if not len(sample.values):
            continue
        rows = len(sample.values) if function.inputs else 1
        outputs = [np.broadcast_to(o, (rows, *o.shape[bool(function.inputs) :])) for o in _call(backend, function, sample)]
        computed = np.concatenate([o.reshape(rows, -1) for o in outputs], axis=1)
        for row in range(rows):
            values = [*map(float, sample.values[row]), *sample.parameters]
            for k, exact in enumerate(reference(values)):
                scale = float(scales[k](*values))
                error = _ulps(float(computed[row, k]), exact, scale, backend)
                finding.see(error, lambda: f"{sample.name}, entry {k} at {values}")
    if not finding.worst <= backend.tolerances.ulps:
        finding.fail(f"{finding.worst:.3g} ulp: {finding.where}")
    return finding


def _ulps(computed: float, exact: arb, scale: float, backend: Backend) -> float:
    """The error in units in the last place of the larger of the value and its natural scale."""
    if not exact.is_finite() or not math.isfinite(scale):
        return 0.0
    if not math.isfinite(computed):
        return math.inf
    size = max(scale, abs(to_float(exact)), float(np.finfo(backend.dtype).tiny))
    unit = 2.0 ** math.floor(math.log2(size)) * backend.eps
    return abs(to_float(exact - arb(computed))) / max(unit, 5e-324)


def check_inverse(
    derivation: Derivation, function: Function, inverse: Inverse, backend: Backend
) -> Finding:
    """Put the answers into the exact forward map; compare statuses; look for known postures."""
    finding = Finding(derivation.name, function.name, backend.name, unit="residual / eps")
    truth = _Truth(derivation, function, inverse)
    for sample in inverse_postures(derivation, len(inverse.unknowns)):
        rounded = _round(sample, backend)
        images = truth.images(rounded)
        for moved in (False, True):
            targets = perturbed(images) if moved else images
            posed = _round(Sample(sample.name, targets, sample.parameters), backend)
            q, status = _call(backend, function, posed)
            for row, target in enumerate(posed.values):
                known = None if moved else rounded.values[row]
                _check_target(finding, truth, backend, posed, target, q[row], status[row], known)
    return finding


class _Truth:
    """The exact forward map and bounds of an inverse, ready to be evaluated."""

    def __init__(self, derivation: Derivation, function: Function, inverse: Inverse):
        parameters = tuple(p.symbol for p in derivation.parameters)
        self.labels = [label for label, _ in function.cases()]
        self.forward = Evaluator((*inverse.unknowns, *parameters), inverse.forward)
        self.scale = sp.lambdify(parameters, [magnitude(e) for e in inverse.forward], "math")
        bounds = [
            [(s.symbol, s.scale) for s in function.body if isinstance(s, Bound)]
            for _ in self.labels
        ]
        exact = [function.bounds(signs) for _, signs in function.cases()]
        self.bounds = Evaluator(
            (*function.symbols, *parameters),
            [e for b in exact for e in b] or [sp.Integer(1)],
        )
        known = {s.symbol: s.value for s in function.body if hasattr(s, "symbol")}
        scales = [substitute(scale, known) for row in bounds for _, scale in row]
        self.bound_scales = Evaluator(
            (*function.symbols, *parameters), scales or [sp.Integer(1)]
        )
        self.per_branch = len(bounds[0]) if bounds else 0
        factors = next((f for f in derivation.functions if f.name == "singularities"), None)
        entries = factors.outputs[0].entries if factors else (sp.Integer(1),)
        self.factors = Evaluator((*inverse.unknowns, *parameters), entries)

    def images(self, sample: Sample) -> NDArray[np.float64]:
        rows = [
            [to_float(b) for b in self.forward([*map(float, row), *sample.parameters])]
            for row in sample.values
        ]
        return np.array(rows).reshape(len(sample.values), -1)

    def residual(self, q: NDArray[Any], target: NDArray[Any], parameters: Sequence[float]) -> float:
        """The largest deviation of the image from the target, over its natural scale."""
        exact = self.forward([*map(float, q), *parameters])
        scales = self.scale(*parameters)
        largest = max(map(float, scales)) or 1.0
        return max(abs(to_float(e - arb(float(x)))) for e, x in zip(exact, target, strict=True)) / largest

    def feasible(
        self, target: NDArray[Any], parameters: Sequence[float], branch: int, slack: float
    ) -> bool | None:
        """Whether the branch exists; ``None`` if a bound is within ``slack`` of zero."""
        if not self.per_branch:
            return True
        point = [*map(float, target), *parameters]
        part = slice(branch * self.per_branch, (branch + 1) * self.per_branch)
        balls, scales = self.bounds(point)[part], self.bound_scales(point)[part]
        margins = [to_float(b) / (to_float(s) or 1.0) for b, s in zip(balls, scales, strict=True)]
        if any(abs(m) <= slack for m in margins) and all(m >= -slack for m in margins):
            return None
        return all(m >= 0 for m in margins)

    def distance_from_singular(self, q: NDArray[Any], parameters: Sequence[float]) -> float:
        """The smallest factor of the singular set, at most 1."""
        return min(abs(to_float(f)) for f in self.factors([*map(float, q), *parameters]))


def _check_target(
    finding: Finding,
    truth: _Truth,
    backend: Backend,
    sample: Sample,
    target: NDArray[Any],
    q: NDArray[Any],
    status: NDArray[Any],
    known: NDArray[Any] | None,
) -> None:
    parameters = sample.parameters
    tolerances = backend.tolerances
    where = f"{sample.name}: target {target.tolist()}, parameters {parameters}"
    for branch, (solution, code) in enumerate(zip(q, status, strict=True)):
        feasible = truth.feasible(target, parameters, branch, 2 * tolerances.feasibility)
        if code in (UNREACHABLE, INVALID):
            if not np.isnan(solution).all():
                finding.fail(f"status {code} with an answer; {where}")
            if feasible and known is not None:
                finding.fail(f"status {code} for a target that can be reached; {where}")
            continue
        if feasible is False:
            finding.fail(f"status {code} for a target out of reach; {where}")
            continue
        if not (np.isfinite(solution).all() and (abs(solution) <= np.pi * (1 + backend.eps)).all()):
            finding.fail(f"angles {solution.tolist()}; {where}")
            continue
        residual = truth.residual(solution, target, parameters)
        if known is not None:
            finding.see(residual / backend.eps, lambda: where)
            if not residual <= tolerances.round_trip:
                finding.fail(f"branch {branch} misses by {residual:.3g}; {where}")
    if known is not None:
        _check_known(finding, truth, backend, parameters, q, status, known, where)


def _check_known(
    finding: Finding,
    truth: _Truth,
    backend: Backend,
    parameters: Sequence[float],
    q: NDArray[Any],
    status: NDArray[Any],
    known: NDArray[Any],
    where: str,
) -> None:
    """The posture that made the target is among the branches, unless a joint is free."""
    if (status == SINGULAR).any():
        return
    gap = np.abs(np.angle(np.exp(1j * (q.astype(float) - known)))).max(axis=1)
    condition = max(truth.distance_from_singular(known, parameters), math.sqrt(backend.eps))
    spread = max(parameters) / min(parameters) if parameters else 1.0
    if not np.nanmin(gap, initial=np.inf) <= 1e3 * backend.eps * spread / condition:
        finding.fail(f"the posture {known.tolist()} is not among {q.tolist()}; {where}")


def table(findings: Sequence[Finding]) -> Iterator[str]:
    """The worst errors as lines of text, a row a function and a column a backend."""
    names = list(dict.fromkeys(f.backend for f in findings))
    rows: dict[tuple[str, str], dict[str, Finding]] = {}
    for f in findings:
        rows.setdefault((f"{f.robot}.{f.function}", f.unit), {})[f.backend] = f
    yield f"{'function':34}{'unit':>16}" + "".join(f"{n:>12}" for n in names)
    for (name, unit), cells in rows.items():
        shown = "".join(f"{cells[n].worst:12.2f}" if n in cells else " " * 12 for n in names)
        yield f"{name:34}{unit:>16}{shown}"


__all__: Sequence[str] = (
    "Backend",
    "Finding",
    "check_forward",
    "check_inverse",
    "crosscheck",
    "float_backend",
    "module_backend",
    "table",
)
