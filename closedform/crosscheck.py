"""Compares generated code with the symbolic source, evaluated in Arb balls.

A function of the joints is compared value by value; its error is counted in ulps of the natural
scale (see :func:`closedform.samples.Magnitudes`).  An inverse is compared four ways: its answers
are put into the exact equations, and those on and near the singular set into the exact forward map;
its statuses are compared with the exact bounds, and every posture whose image is the target must be
among the branches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
import sympy as sp
from flint import arb
from numpy.typing import NDArray

from closedform.arrays import columns
from closedform.chain import numbers_of_tool
from closedform.derivation import Derivation, Inverse
from closedform.functions import Bound, Function, Let, Require, Vanishes, substitute
from closedform.lower import lower
from closedform.reference import Evaluator, to_float
from closedform.samples import Magnitudes, Sample, inverse_postures, joint_samples, perturbed
from closedform.singular import singular_samples
from closedform.tolerances import DOUBLE, FLOAT, Tolerances

WELL_CONDITIONED = 3.0
"""An error of more ulps is set against how much the value moves when its inputs do."""

SUSPECTS = 5
"""So many of the worst answers on and near the singular set are evaluated in Arb."""

NESTED = 64.0
"""The natural scale counts for at most so many times the largest value or parameter, or length that
is a number: that of a long chain of steps, each with the scale of the one before, says nothing."""

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
        elif function.boolean:
            findings.append(check_boolean(derivation, function, backend))
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


def _thinned(sample: Sample, entries: int) -> Sample:
    """Fewer rows of a function with many entries, which all are evaluated in Arb."""
    return Sample(sample.name, sample.values[:: max(1, entries // 12)], sample.parameters)


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
    magnitudes = Magnitudes(symbols, exprs)
    margins = [_margins(function, symbols, signs) for _, signs in function.cases()]
    entries = len(exprs) // len(cases)
    flags = [_margins(function, symbols, signs, Vanishes) for _, signs in function.cases()]
    lengths = numbers_of_tool(derivation)
    for sample in joint_samples(derivation, function):
        sample = _round(_thinned(sample, len(exprs)), backend)
        if not len(sample.values):
            continue
        rows = len(sample.values) if function.inputs else 1
        outputs = _call(backend, function, sample)
        computed = np.concatenate([o.reshape(rows, -1) for o in outputs], axis=1)
        for row in range(rows):
            values = [*map(float, sample.values[row]), *sample.parameters]
            raised = (to_float(size) for flag in flags for size in flag(values))
            if any(size < 2 * backend.tolerances.vanishing for size in raised):
                continue  # where a flag is raised the value is a convention
            slack = 2 * backend.tolerances.feasibility
            exists = [_feasible(margin, values, slack) for margin in margins]
            scales = magnitudes(values, backend.dtype)
            exacts = reference(values)
            sizes = [abs(to_float(e)) for e in exacts if e.is_finite()]
            given = [abs(p) for p in (*sample.parameters, *lengths)]
            most = NESTED * max([*sizes, *given], default=1.0)
            for k, exact in enumerate(exacts):
                if not exists[k // entries]:
                    if exists[k // entries] is False and not np.isnan(computed[row, k]):
                        finding.fail(f"a value out of bounds, entry {k} at {values}")
                    continue
                scale = min(scales[k], most) if math.isfinite(scales[k]) else scales[k]
                error = _ulps(float(computed[row, k]), exact, scale, backend)
                if error > WELL_CONDITIONED:
                    scale += _variation(reference, k, values, exact, backend) / backend.eps
                    error = _ulps(float(computed[row, k]), exact, scale, backend)
                finding.see(error, lambda: f"{sample.name}, entry {k} at {values}")  # noqa: B023
    operations = sum(lower(function, derivation).operations().values())
    allowed = backend.tolerances.ulps + operations * backend.tolerances.ulps_per_operation
    if not finding.worst <= allowed:
        finding.fail(f"{finding.worst:.3g} ulp: {finding.where}")
    return finding


def check_boolean(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare truth values with the exact bounds, where those are not within a tolerance of zero.

    A condition in the output itself is compared in Arb as well.
    """
    finding = Finding(derivation.name, function.name, backend.name, unit="wrong answers")
    symbols = _symbols(derivation, function)
    bounds = _margins(function, symbols, {})
    (output,) = (sp.Piecewise((1, e), (0, True)) for a in function.outputs for e in a.entries)
    condition = Evaluator(symbols, [output])
    slack = 2 * backend.tolerances.feasibility
    for sample in joint_samples(derivation, function):
        sample = _round(sample, backend)
        (computed,) = _call(backend, function, sample)
        for answer, row in zip(computed, sample.values, strict=True):
            values = [*map(float, row), *sample.parameters]
            margins = list(map(to_float, bounds(values)))
            if any(abs(m) <= slack for m in margins):
                continue
            expected = all(m > 0 for m in margins) and to_float(condition(values)[0]) == 1
            finding.see(0.0, str)
            if bool(answer) != expected:
                finding.fail(f"{bool(answer)} at {sample.name}: {values}")
    return finding


def _variation(
    reference: Evaluator, k: int, values: Sequence[float], exact: arb, backend: Backend
) -> float:
    """How far the exact value moves when every input moves by an ulp: near a singularity, far."""
    moved = []
    for i, value in enumerate(values):
        nearby = [*values[:i], value * (1 + backend.eps), *values[i + 1 :]]
        moved.append(abs(to_float(reference(nearby)[k] - exact)))
    return sum(m for m in moved if math.isfinite(m))


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
    """Put the answers into the exact equations; compare statuses; look for known postures.

    Where the inputs are the images of the unknowns, they are made from postures, which must come
    back; else (the assembly modes of a loop) inputs are sampled as they are.
    """
    finding = Finding(derivation.name, function.name, backend.name, unit="residual / eps")
    if inverse.reduction:
        inverse = inverse.posed(function.symbols, derivation[inverse.images].values({}))
    truth = _Truth(derivation, function, inverse)
    if not truth.has_images:
        for sample in joint_samples(derivation, function):
            _check_batch(finding, truth, backend, _round(sample, backend), None, exact=True)
        return finding
    answers = len(inverse.unknowns) * len(list(function.cases()))
    for sample in inverse_postures(derivation, inverse.unknowns):
        postures = _round(_thinned(sample, answers), backend)
        images, known_postures = truth.images(postures)
        if not len(images):
            continue
        for values, known in ((images, known_postures), (perturbed(images), None)):
            posed = _round(Sample(sample.name, values, sample.parameters), backend)
            _check_batch(finding, truth, backend, posed, known, exact=known is not None)
    for sample in singular_samples(derivation, inverse.unknowns):
        _check_round_trips(finding, truth, backend, _round(sample, backend))
    return finding


class _Truth:
    """The exact equations and bounds of an inverse, ready to be evaluated."""

    def __init__(self, derivation: Derivation, function: Function, inverse: Inverse):
        self.function = function
        parameters = tuple(p.symbol for p in derivation.parameters)
        self.amplified = sp.lambdify(parameters, inverse.condition)
        revolute = {j.symbol for j in derivation.joints if j.kind == "revolute"}
        self.angular = np.array([u in revolute for u in inverse.unknowns])
        place = (*inverse.unknowns, *function.symbols, *parameters)
        self._equations = Evaluator(place, inverse.equations)
        pairs = list(zip(inverse.forward, inverse.targets, strict=True))
        self._is_turn = [
            t for _, x in pairs for t in [x in inverse.angles] * (1 + (x in inverse.angles))
        ]
        lengths = [f for f, x in pairs if x not in inverse.angles]
        self._scales = Magnitudes(place, lengths)
        explicit = tuple(inverse.targets) == function.symbols
        self.has_images = explicit or bool(inverse.images)
        maps = [inverse.forward] if explicit else []
        if inverse.images:
            forward = derivation[inverse.images]
            maps = [forward.values(mode) for _, mode in forward.cases()]
        self._posture = (*inverse.unknowns, *parameters)
        self._map_exprs = maps
        self._maps = [Evaluator(self._posture, m) for m in maps]
        slides = {j.symbol for j in derivation.joints if j.kind == "prismatic"}
        self._sliding = np.array([u in slides for u in inverse.unknowns])
        self._turns = np.array([x in inverse.angles for x in function.symbols])
        sized = {*parameters, *slides}
        places = (3, 7, 11) if len(function.symbols) == 16 else ()
        self._sized = [
            np.array([bool(e.free_symbols & sized) or k in places for k, e in enumerate(m)])
            for m in maps
        ]
        self._in_numbers = max(numbers_of_tool(derivation), default=0.0)
        given = (*function.symbols, *parameters)
        self._bounds = [_margins(function, given, signs) for _, signs in function.cases()]
        required = [e for s in function.body if isinstance(s, Require) for e in s.values]
        self._required = Evaluator(given, function.explicit(required, {})[0])
        factors = next((f for f in derivation.functions if f.name == "singularities"), None)
        entries: list[sp.Expr] = []
        if factors and self.has_images:
            entries = [e for _, signs in factors.cases() for e in factors.values(signs)]
        self._factors = Evaluator((*inverse.unknowns, *parameters), entries)

    def images(self, sample: Sample) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What the postures are taken to, in each assembly mode they have, and the postures."""
        rows, postures = [], []
        for forward in self._maps:
            for row in sample.values:
                image = forward([*map(float, row), *sample.parameters])
                if all(b.is_finite() for b in image):
                    rows.append([to_float(b) for b in image])
                    postures.append(row)
        shape = (-1, len(self.function.symbols))
        return np.array(rows).reshape(shape), np.array(postures).reshape(-1, len(self.angular))

    def wide_images(self, postures: NDArray[Any], parameters: Sequence[float]) -> NDArray[Any]:
        """What postures are taken to in each assembly mode, NaN where it does not exist."""
        sizes = np.broadcast_to(np.array(parameters), (len(postures), len(parameters)))
        rows = np.concatenate([postures, sizes], axis=1)
        return np.stack([columns(m, self._posture, rows) for m in self._map_exprs])

    def missed(
        self,
        images: NDArray[Any],
        solutions: NDArray[Any],
        given: NDArray[Any],
        parameters: Sequence[float],
    ) -> NDArray[np.float64]:
        """How far the image in the nearest assembly mode is from the target.

        Lengths are counted in the sum of those of links and slides, angles as they are.
        """
        fixed = np.abs(parameters).sum() + self._in_numbers
        size = fixed + np.abs(solutions * self._sliding).sum(axis=-1)
        apart = []
        for image, sized in zip(images, self._sized, strict=True):
            difference = (image - given).astype(float)
            turned = np.abs(np.angle(np.exp(1j * difference)))
            by_size = np.abs(difference) / np.where(sized, size[:, None], 1.0)
            apart.append(np.where(self._turns, turned, by_size).max(axis=-1))
        return np.asarray(np.fmin.reduce([*apart, np.full(len(given), np.inf)]))

    def exact_miss(
        self, solution: NDArray[Any], given: NDArray[Any], parameters: Sequence[float]
    ) -> float:
        """The same for one answer, in Arb."""
        if not np.isfinite(solution.astype(float)).all():
            return math.inf
        point = [*map(float, solution), *map(float, parameters)]
        balls = [forward(point) for forward in self._maps]
        offsets = [
            [to_float(b - arb(float(g))) for b, g in zip(m, given, strict=True)] for m in balls
        ]
        images = np.array(offsets)[:, None]
        return float(self.missed(images, solution[None], 0 * given[None], parameters)[0])

    def residual(
        self, solution: NDArray[Any], given: NDArray[Any], parameters: Sequence[float]
    ) -> float:
        """The largest violation of an equation, over the largest natural scale.

        The sine and the cosine of an angle have a scale of their own, which is 1.
        """
        if not np.isfinite(solution).all():
            return math.inf
        point = [*map(float, solution), *map(float, given), *map(float, parameters)]
        scale = max(self._scales(point), default=1.0) or 1.0
        errors = [abs(to_float(e)) for e in self._equations(point)]
        return max(e / (1.0 if t else scale) for e, t in zip(errors, self._is_turn, strict=True))

    def margin(self, given: NDArray[Any], parameters: Sequence[float], branch: int) -> float:
        """The smallest bound of a branch over its scale, negative where the branch is none."""
        margins = map(to_float, self._bounds[branch]([*map(float, given), *parameters]))
        return min(margins, default=1.0)

    def unfit(self, given: NDArray[Any], parameters: Sequence[float]) -> float:
        """How far an input misses what is required of it, as that its matrix is a rotation."""
        missed = self._required([*map(float, given), *parameters])
        return max((abs(to_float(m)) for m in missed), default=0.0)

    def condition(self, posture: NDArray[Any], parameters: Sequence[float]) -> float:
        """The smallest factor of the singular set, at most 1."""
        factors = self._factors([*map(float, posture), *parameters])
        return min([1.0, *(abs(to_float(f)) for f in factors if f.is_finite())])

    def gap(self, solutions: NDArray[Any], posture: NDArray[Any]) -> NDArray[np.float64]:
        """The distance of each solution from a posture, angles modulo a turn."""
        difference = solutions.astype(float) - posture
        turned = np.abs(np.angle(np.exp(1j * difference)))
        return np.asarray(np.where(self.angular, turned, np.abs(difference)).max(axis=-1))


def _feasible(margins: Evaluator, values: Sequence[float], slack: float) -> bool | None:
    """Whether all margins are positive; ``None`` if that hangs on one within ``slack`` of zero."""
    found = list(map(to_float, margins(values)))
    if min(found, default=1.0) > slack:
        return True
    return False if min(found) < -slack else None


def _margins(
    function: Function,
    symbols: Sequence[sp.Symbol],
    signs: Mapping[sp.Symbol, int],
    kind: type = Bound,
) -> Evaluator:
    """The bounds (or what the flags look at) of a branch, over their natural scales.

    No flag holds, and what is chosen only where one does is left out.
    """
    named: dict[sp.Symbol, sp.Basic] = {s: sp.Integer(v) for s, v in signs.items()}
    lowered: dict[sp.Basic, sp.Basic] = {}
    margins = []
    for statement in function.body:
        if isinstance(statement, (Let, Bound)):
            named[statement.symbol] = substitute(statement.value, lowered)
        elif isinstance(statement, Vanishes):
            lowered[statement.symbol] = sp.false
        if isinstance(statement, kind) and isinstance(statement, (Bound, Vanishes)):
            margins.append(substitute(statement.value / statement.scale, lowered))
    used: set[sp.Basic] = set()
    pending = {s for e in margins for s in e.free_symbols}
    while pending:
        used |= pending
        pending = {s for n in pending & named.keys() for s in named[n].free_symbols} - used
    return Evaluator(symbols, margins, named={n: e for n, e in named.items() if n in used})


def _check_batch(
    finding: Finding,
    truth: _Truth,
    backend: Backend,
    sample: Sample,
    known: NDArray[Any] | None,
    *,
    exact: bool,
) -> None:
    solutions, status = _call(backend, truth.function, sample)
    for row, given in enumerate(sample.values):
        where = f"{sample.name}: {given.tolist()}, parameters {sample.parameters}"
        for branch, (solution, code) in enumerate(zip(solutions[row], status[row], strict=True)):
            slack = 2 * backend.tolerances.feasibility
            margin = truth.margin(given, sample.parameters, branch)
            feasible = margin > 0 if abs(margin) > slack else None
            problem = _contradiction(truth, backend, solution, int(code), feasible, exact)
            if feasible is False and code in (OK, SINGULAR):
                # where a joint is free, another turn of it may reach what the generic one does not
                missed = truth.residual(solution, given, sample.parameters)
                allowed = backend.tolerances.round_trip + truth.unfit(given, sample.parameters)
                problem = "" if missed <= allowed else problem
            if problem:
                finding.fail(f"branch {branch} {problem}; {where}")
            elif exact and code in (OK, SINGULAR):
                residual = truth.residual(solution, given, sample.parameters)
                if not margin < -16 * backend.eps:  # there it is out of reach, and missed by that
                    finding.see(residual / backend.eps, lambda: where)  # noqa: B023
                if not residual <= backend.tolerances.round_trip:
                    finding.fail(f"branch {branch} misses by {residual:.3g}; {where}")
        if known is not None and SINGULAR not in status[row]:
            one = Sample(sample.name, sample.values[row : row + 1], sample.parameters)
            _check_known(finding, truth, backend, one, solutions[row], known[row], where)


def _check_round_trips(finding: Finding, truth: _Truth, backend: Backend, postures: Sample) -> None:
    """The exact forward map takes every answer that is OK to the target.

    What seems to be off by more than half of what is allowed is evaluated in Arb, the worst first.
    """
    parameters = postures.parameters
    allowed = backend.tolerances.promised(float(truth.amplified(*parameters)))
    images = truth.wide_images(postures.values, parameters)
    targets = np.concatenate(list(images)).astype(float)
    posed = _round(
        Sample(postures.name, targets[np.isfinite(targets).all(axis=-1)], parameters), backend
    )
    if not len(posed.values):
        return
    solutions, status = _call(backend, truth.function, posed)
    row, branch = np.nonzero(status == OK)
    answers, given = solutions[row, branch].astype(float), posed.values[row]
    missed = truth.missed(truth.wide_images(answers, parameters), answers, given, parameters)
    for k in np.argsort(-missed)[:SUSPECTS]:
        if missed[k] > allowed / 2:
            exact = truth.exact_miss(answers[k], given[k], parameters)
            if not exact <= allowed:
                finding.fail(
                    f"branch {branch[k]} is OK, and fk misses by {exact:.3g}; "
                    f"{posed.name}: {given[k].tolist()}, parameters {parameters}"
                )


def _contradiction(
    truth: _Truth,
    backend: Backend,
    solution: NDArray[Any],
    code: int,
    feasible: bool | None,
    exact: bool,
) -> str:
    """What is wrong with a status and the answer that goes with it."""
    if code in (UNREACHABLE, INVALID):
        if not np.isnan(solution).all():
            return f"has status {code} and an answer"
        return f"has status {code} but can be reached" if feasible and exact else ""
    if feasible is False:
        return f"has status {code} but is out of reach"
    angles = solution[truth.angular]
    if not np.isfinite(solution).all() or (abs(angles) > np.pi * (1 + backend.eps)).any():
        return f"has status {code} and the answer {solution.tolist()}"
    return ""


def _check_known(
    finding: Finding,
    truth: _Truth,
    backend: Backend,
    sample: Sample,
    solutions: NDArray[Any],
    posture: NDArray[Any],
    where: str,
) -> None:
    """The posture that made the input is among the branches, unless a joint is free."""
    parameters = sample.parameters
    condition = max(truth.condition(posture, parameters), math.sqrt(backend.eps))
    sizes = [abs(p) for p in parameters if p]
    spread = max(sizes) / min(sizes) if sizes else 1.0
    nearest = np.nanmin(truth.gap(solutions, posture), initial=np.inf)
    if np.isnan(solutions).all() and _leaves_the_workspace(truth, backend, sample):
        return
    allowed = backend.eps * spread / condition
    if nearest > 1e3 * allowed:  # a joint that is nearly free turns far for an ulp of the target
        allowed += _movement(truth, backend, sample, solutions)
    if not nearest <= 1e3 * allowed:
        finding.fail(f"{posture.tolist()} is not among {solutions.tolist()}; {where}")


def _movement(truth: _Truth, backend: Backend, sample: Sample, solutions: NDArray[Any]) -> float:
    """How far the answers move when every coordinate of the target moves by an ulp.

    An ulp may be lost in the rounding of what is computed first, so four count as well.
    """
    largest = 0.0
    for ulps in (1, 4):
        nearby = _nearby(backend, sample, ulps)
        moved = truth.gap(_call(backend, truth.function, nearby)[0], solutions) / ulps
        largest = float(np.max(moved, initial=largest, where=np.isfinite(moved)))
    return largest


def _leaves_the_workspace(truth: _Truth, backend: Backend, sample: Sample) -> bool:
    """Whether a target an ulp away is out of reach by more than the tolerance in all branches.

    Where a large offset is taken from a large distance, an ulp of the target is far inside.
    """
    slack = backend.tolerances.feasibility
    branches = range(len(list(truth.function.cases())))
    return any(
        all(truth.margin(row, sample.parameters, b) < -slack for b in branches)
        for row in _nearby(backend, sample).values
    )


def _nearby(backend: Backend, sample: Sample, ulps: int = 1) -> Sample:
    """Targets that are off one target by some ulps of every coordinate."""
    columns = np.arange(sample.values.shape[1])
    signs = np.array([(-1) ** ((pattern >> (columns % 2)) & 1) for pattern in range(4)])
    moved = sample.values * (1 + ulps * signs * backend.eps)
    return Sample(sample.name, moved, sample.parameters)


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
    "check_boolean",
    "check_forward",
    "check_inverse",
    "crosscheck",
    "float_backend",
    "module_backend",
    "table",
)
