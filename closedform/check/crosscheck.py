"""Compares generated code with the symbolic source, evaluated in Arb balls.

A function of the joints is compared value by value; its error is counted in ulps of the natural
scale (see :func:`closedform.check.samples.Magnitudes`).  An inverse is compared in four ways.  Its
answers are put into the exact equations; those on and near the singular set also into the exact
forward map.  Its statuses are compared with the exact bounds.  Every posture whose image is the
target must be among the branches.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from types import ModuleType
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from closedform.algebra.balls import Undetermined, to_float
from closedform.check.samples import Sample, inverse_postures, joint_samples, perturbed
from closedform.check.singular import singular_samples
from closedform.check.truth import Solutions, Values, cached, condition_of, solutions_of, values_of
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.inverse import Inverse
from closedform.model.tolerances import DOUBLE, FLOAT, Tolerances

WELL_CONDITIONED = 3.0
"""Larger errors, in ulps, are compared with the change of the value if the inputs change."""
CUT, TURN, HIGH = 3.0, 2 * math.pi, 200
"""Angles beyond the first value are next to the cut at pi; a whole turn; bits for adding one."""

SUSPECTS = 5
"""The number of worst answers on and near the singular set that are evaluated in Arb."""

NESTED = 64.0
"""The natural scale is at most this many times the largest value, parameter or numerical length.

(For a product of lengths beside a pose, it is a power of the largest length.)  In a long chain of
steps the natural scale grows with every step, and would soon allow any error.
"""

NEAR_POLE = 2.0**-4
"""What vanishes or ends where assembly modes meet is small below this share of its scale."""

MENTIONED = 5
"""The number of failures of a function that are reported."""

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
    """The worst error of one function in one backend, and where; no ``failures`` if it is right."""

    robot: str
    function: str
    backend: str
    unit: str = "ulp"
    worst: float = 0.0
    where: str = ""
    compared: int = 0
    failures: list[str] = field(default_factory=list)

    @property
    def full(self) -> bool:
        """Whether further failures are left out of the report."""
        return len(self.failures) >= MENTIONED

    def see(self, error: float, where: Callable[[], str]) -> None:
        if error > self.worst or math.isnan(error):
            self.worst, self.where = error, where()

    def fail(self, message: str) -> None:
        if not self.full:
            self.failures.append(message)


_singular_samples = cached(singular_samples)


def crosscheck(derivation: Derivation, backend: Backend) -> list[Finding]:
    """Check every function of a derivation in one backend."""
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
    """Fewer rows for a function with many entries, because each entry is evaluated in Arb."""
    return Sample(sample.name, sample.values[:: max(1, entries // 12)], sample.parameters)


def _call(backend: Backend, function: Function, sample: Sample) -> tuple[NDArray[Any], ...]:
    inputs, column = [], 0
    for argument in function.inputs:
        part = sample.values[:, column : column + argument.size]
        inputs.append(part.reshape((len(part), *argument.shape)))
        column += argument.size
    result = backend.function(function.name)(*inputs, sample.parameters)
    parts = [np.asarray(p) for p in (result if isinstance(result, tuple) else (result,))]
    if function.has_status:  # the entries of a matrix are the unknowns of a solution
        answers, status = parts
        return answers.reshape(*status.shape, -1), status
    return tuple(parts)


def check_forward(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare values, in ulps of their natural scale."""
    finding = Finding(derivation.name, function.name, backend.name)
    values = values_of(derivation, function)
    for sample in joint_samples(derivation, function):
        sample = _round(_thinned(sample, len(values.exprs)), backend)
        if len(sample.values):
            outputs = _call(backend, function, sample)
            _compare(finding, values, backend, sample, outputs[: len(function.outputs)])
    allowed = backend.tolerances.ulps + values.operations * backend.tolerances.ulps_per_operation
    if not finding.worst <= allowed:
        finding.fail(f"{finding.worst:.3g} ulp: {finding.where}")
    return finding


def _compare(
    finding: Finding,
    values: Values,
    backend: Backend,
    sample: Sample,
    outputs: Sequence[NDArray[Any]],
) -> None:
    """Record the worst error of a sample; only what may exceed the worst so far needs Arb."""
    rows = sample.rows
    computed = np.concatenate([o.reshape(len(rows), -1) for o in outputs], axis=1).astype(float)
    exists = values.existence(rows, 2 * backend.tolerances.feasibility)
    exists[values.flagged(rows, 2 * backend.tolerances.vanishing)] = 0
    for row, k in np.argwhere((exists < 0) & ~np.isnan(computed)):
        finding.fail(f"a value out of bounds, entry {k} at {rows[row].tolist()}")
    defined = (exists > 0).any(axis=1)
    rows, computed, exists = rows[defined], computed[defined], exists[defined]
    errors = _Errors(values, backend, rows, computed, [abs(p) for p in sample.parameters])
    bounds = errors.bounds()
    bounds[exists <= 0] = 0.0
    finding.compared += int((exists > 0).sum())
    for place in np.argsort(-bounds, axis=None):
        row, k = map(int, np.unravel_index(place, bounds.shape))
        if not bounds[row, k] > finding.worst:
            break
        if (error := errors.at(row, k)) is not None:
            finding.see(error, lambda: f"{sample.name}, entry {k} at {rows[row].tolist()}")  # noqa: B023
    finding.compared -= int((exists[[*errors.unsettled]] > 0).sum())


class _Errors:
    """The errors of computed values in ulps of their natural scales, evaluated in Arb on demand."""

    def __init__(
        self,
        values: Values,
        backend: Backend,
        rows: NDArray[np.float64],
        computed: NDArray[np.float64],
        parameters: Sequence[float],
    ):
        self.values, self.backend, self.rows, self.computed = values, backend, rows, computed
        self.lengths = [*parameters, *map(abs, values.lengths)]
        self.scales = values.scales(rows, backend.dtype)
        self.powers = values.powers(rows)
        self.middle, self.radius = values.exact.balls(rows)
        # an angle just above -pi may be rounded to -pi, which is returned as pi
        self.turned = values.angles & (computed > CUT) & (self.middle < -CUT)
        self.unsettled: set[int] = set()
        self._largest: dict[int, float] = {}
        self._amplified: dict[int, NDArray[Any]] = {}

    def bounds(self) -> NDArray[np.float64]:
        """Upper bounds of all errors; infinite where nothing is known."""
        exact = self.middle + TURN * self.turned
        with np.errstate(all="ignore"):
            sizes = np.where(np.isfinite(self.radius), np.maximum(abs(exact) - self.radius, 0), 0)
            most = NESTED * sizes.max(axis=1, initial=max(self.lengths, default=0.0))
            most = np.maximum(most[:, None], NESTED * self.powers)
            size = np.maximum(np.minimum(self.scales, most), sizes)
            errors = abs(self.computed - exact) + self.radius
            bounds = errors / _last_places(size, self.backend)
            bounds[~np.isfinite(bounds)] = np.inf
            return np.where(np.isfinite(self.scales), bounds, 0.0).astype(float)

    def at(self, row: int, k: int) -> float | None:
        """The error of an entry; None where Arb cannot settle it, or it means nothing."""
        if row in self.unsettled:
            return None
        try:
            exacts = self.values.exact.exactly(self.rows[row])
        except Undetermined:  # whether it is at a pole, where irrational numbers cancel
            self.unsettled.add(row)
            return None
        scale = self._scale(row, k, exacts)
        exact = _turned(exacts[k]) if self.turned[row, k] else exacts[k]
        error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED:
            moved = float(_variation(self.values, k, self.rows[row], exacts[k], self.backend))
            scale += moved / self.backend.eps
            error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED and self.values.in_modes:
            scale += self._of_lengths(row, k)
            error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED and (self.values.beside_pose or self._near_pole(row)):
            grown = float(self._amplified_scales(row)[k])
            if self.backend.eps * grown >= self.scales[row, k]:  # a divisor is a rounding
                return None
            error = _ulps(self.computed[row, k], exact, scale + grown, self.backend)
        return error

    def _scale(self, row: int, k: int, exacts: Sequence[arb]) -> float:
        """The natural scale of an entry, at most :data:`NESTED` times the largest value there."""
        if row not in self._largest:
            sizes = [abs(to_float(e)) for e in exacts if e.is_finite()]
            self._largest[row] = max([*sizes, *self.lengths], default=1.0)
        most = NESTED * max(self._largest[row], self.powers[row, k])
        scale = self.scales[row, k]
        return float(min(scale, most)) if math.isfinite(scale) else math.inf

    def _near_pole(self, row: int) -> bool:
        """Whether assembly modes are so close that divisors nearly cancel, or hardly exist."""
        if not self.values.in_modes:
            return False
        here = self.rows[row : row + 1]
        flagged = self.values.flagged(here, NEAR_POLE)[0]
        return bool(flagged or (self.values.existence(here, NEAR_POLE) == 0).any())

    def _of_lengths(self, row: int, k: int) -> float:
        """The natural scale with the lengths that cancel, at most the largest length."""
        named = self.values.named(self.rows[row : row + 1], self.backend.dtype)[0, k]
        return float(min(named, max(self.lengths, default=named)))

    def _amplified_scales(self, row: int) -> NDArray[Any]:
        if row not in self._amplified:
            one = self.rows[row : row + 1]
            self._amplified[row] = self.values.amplified(one, self.backend.dtype)[0]
        return self._amplified[row]


def _turned(angle: arb) -> arb:
    with ctx.workprec(HIGH):
        return angle + 2 * arb.pi()


def _last_places(sizes: NDArray[Any], backend: Backend) -> NDArray[Any]:
    """The units in the last place of numbers of these sizes."""
    normal = np.maximum(sizes, float(np.finfo(backend.dtype).tiny))
    return np.asarray(np.maximum(np.ldexp(backend.eps, np.frexp(normal)[1] - 1), 5e-324))


def check_boolean(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare truth values with the exact bounds, except within a tolerance of zero.

    A condition in the output itself is compared in Arb as well.
    """
    finding = Finding(derivation.name, function.name, backend.name, unit="wrong answers")
    condition = condition_of(derivation, function)
    for sample in joint_samples(derivation, function):
        sample = _round(sample, backend)
        (computed,) = _call(backend, function, sample)
        expected, certain = condition(sample.rows, 2 * backend.tolerances.feasibility)
        finding.compared += int(certain.sum())
        for row in np.flatnonzero(certain & (computed.astype(bool) != expected)):
            finding.fail(f"{bool(computed[row])} at {sample.name}: {sample.rows[row].tolist()}")
    return finding


def _variation(
    values: Values, k: int, row: NDArray[np.float64], exact: arb, backend: Backend
) -> float:
    """How far the exact value moves if every input moves by an ulp: far, near a singularity."""
    nearby = row + np.diag(row * (1 + backend.eps) - row)
    moved = (abs(to_float(values.exact.exactly(at)[k] - exact)) for at in nearby)
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

    If the inputs are images of the unknowns, they are made from postures, which the inverse must
    return.  Otherwise (the assembly modes of a loop) the inputs are sampled directly.
    """
    finding = Finding(derivation.name, function.name, backend.name, unit="residual / eps")
    truth = solutions_of(derivation, function, inverse)
    if not truth.has_images:
        if not truth.stated:
            return check_forward(derivation, function, backend)
        for sample in joint_samples(derivation, function):
            _Batch(finding, truth, backend, _round(sample, backend), exact=True).check(None)
        return finding
    answers = len(inverse.unknowns) * len(list(function.cases()))
    for sample in inverse_postures(derivation, inverse.unknowns):
        postures = _round(_thinned(sample, answers), backend)
        images, known_postures = truth.images(postures)
        if not len(images):
            continue
        for values, known in ((images, known_postures), (perturbed(images), None)):
            posed = _round(Sample(sample.name, values, sample.parameters), backend)
            _Batch(finding, truth, backend, posed, exact=known is not None).check(known)
    for sample in _singular_samples(derivation, inverse.unknowns):
        _check_round_trips(finding, truth, backend, _round(sample, backend))
    return finding


@dataclass(frozen=True)
class _Batch:
    """A batch of targets whose answers are compared with the exact equations.

    With ``exact`` the targets are images of postures, so they can be reached.
    """

    finding: Finding
    truth: Solutions
    backend: Backend
    sample: Sample
    exact: bool

    def check(self, known: NDArray[Any] | None) -> None:
        """Compare all answers; only what may be wrong, or worse than the worst so far, needs Arb.

        The ``known`` postures must be among the answers.
        """
        truth, sample, eps = self.truth, self.sample, self.backend.eps
        solutions, status = _call(self.backend, truth.function, sample)
        feasibility = self.backend.tolerances.feasibility
        slack, matched = 2 * feasibility, min(16 * eps, feasibility / 8)
        limits = (slack, -slack, -16 * eps)
        margins = truth.margins(sample.values, sample.parameters, *limits, matched=matched)
        feasible = np.where(abs(margins) > slack, np.sign(margins), 0)
        wrong = self._suspicious(solutions, status, feasible)
        for row, branch in np.argwhere(wrong):
            code, reached = int(status[row, branch]), feasible[row, branch]
            problem = self._problem(row, solutions[row, branch], code, reached)
            if problem:
                self.finding.fail(f"branch {branch} {problem}; {self._where(row)}")
            wrong[row, branch] = bool(problem)
            if self.finding.full:
                return
        if self.exact and truth.stated:
            answered = np.argwhere(~wrong & np.isin(status, (OK, SINGULAR)))
            self._see_residuals(solutions, margins, answered)
        if known is not None:
            spread = eps * _spread(sample.parameters)
            gap = np.fmin.reduce(truth.gap(solutions, known[:, None]), axis=1, initial=np.inf)
            for row in np.flatnonzero(~(gap <= 1e3 * spread) & ~(status == SINGULAR).any(axis=1)):
                self._check_known(row, solutions[row], known[row])
                if self.finding.full:
                    return

    def _where(self, row: Any) -> str:
        sample = self.sample
        return f"{sample.name}: {sample.values[row].tolist()}, parameters {sample.parameters}"

    def _suspicious(
        self, solutions: NDArray[Any], status: NDArray[Any], feasible: NDArray[Any]
    ) -> NDArray[np.bool_]:
        """The answers in which :meth:`_contradiction` finds something."""
        empty, whole = np.isnan(solutions).all(axis=-1), np.isfinite(solutions).all(axis=-1)
        with np.errstate(invalid="ignore"):
            turned = abs(solutions[..., self.truth.angular]) > np.pi * (1 + self.backend.eps)
        refused = ~empty | ((feasible > 0) & self.exact)
        accepted = (feasible < 0) | ~whole | turned.any(axis=-1)
        return np.asarray(np.where(np.isin(status, (UNREACHABLE, INVALID)), refused, accepted))

    def _problem(self, row: Any, solution: NDArray[Any], code: int, feasible: float) -> str:
        """What is wrong with an answer; empty if nothing is, or if a free joint explains it."""
        problem = self._contradiction(solution, code, feasible)
        if problem and feasible < 0 and code in (OK, SINGULAR):
            # where a joint is free, another turn of it may reach what the generic one does not
            given, parameters = self.sample.values[row], self.sample.parameters
            missed = self.truth.residual(solution, given, parameters)
            allowed = self.backend.tolerances.round_trip + self.truth.violation(given, parameters)
            return "" if missed <= allowed else problem
        return problem

    def _contradiction(self, solution: NDArray[Any], code: int, feasible: float) -> str:
        """What is wrong with a status and its answer; empty if nothing is."""
        if code in (UNREACHABLE, INVALID):
            if not np.isnan(solution).all():
                return f"has status {code} and an answer"
            return f"has status {code} but can be reached" if feasible > 0 and self.exact else ""
        # a pin that is free may have a place that the generic one does not have
        if feasible < 0 and (self.truth.stated or code == OK):
            return f"has status {code} but is out of reach"
        angles = solution[self.truth.angular]
        if not np.isfinite(solution).all() or (abs(angles) > np.pi * (1 + self.backend.eps)).any():
            return f"has status {code} and the answer {solution.tolist()}"
        return ""

    def _see_residuals(
        self, solutions: NDArray[Any], margins: NDArray[Any], answered: NDArray[np.intp]
    ) -> None:
        """Record by how much the answers violate the equations."""
        row, branch = answered.T
        eps, parameters = self.backend.eps, self.sample.parameters
        # where it is out of reach, an answer misses by that
        counted = ~(margins[row, branch] < -16 * eps)
        self.finding.compared += int(counted.sum())
        answers, given = solutions[row, branch].astype(float), self.sample.values[row]
        bounds = self.truth.residual_bounds(answers, given, parameters)
        allowed = self.backend.tolerances.violated(float(self.truth.amplified(*parameters)))
        for k in np.argsort(-bounds):
            worse = counted[k] and bounds[k] > self.finding.worst * eps
            if not (worse or bounds[k] > allowed):
                continue
            residual = self.truth.residual(solutions[row[k], branch[k]], given[k], parameters)
            where = self._where(row[k])
            if counted[k]:
                self.finding.see(residual / eps, lambda: where)  # noqa: B023
            if not residual <= allowed:
                self.finding.fail(f"branch {branch[k]} misses by {residual:.3g}; {where}")
                if self.finding.full:
                    return

    def _check_known(self, row: Any, solutions: NDArray[Any], posture: NDArray[Any]) -> None:
        """Check that the posture behind a target is among the branches, unless a joint is free."""
        truth, backend, parameters = self.truth, self.backend, self.sample.parameters
        one = Sample(self.sample.name, self.sample.values[row : row + 1], parameters)
        condition = max(truth.condition(posture, parameters), math.sqrt(backend.eps))
        nearest = np.nanmin(truth.gap(solutions, posture), initial=np.inf)
        if np.isnan(solutions).all() and _leaves_the_workspace(truth, backend, one):
            return
        if truth.undetermined(posture, parameters) and not np.isnan(solutions).all():
            return
        allowed = backend.eps * _spread(parameters) / condition
        if nearest > 1e3 * allowed:  # an ulp of the target turns a nearly free joint far
            allowed += _movement(truth, backend, one, solutions)
        if not nearest <= 1e3 * allowed:
            self.finding.fail(
                f"{posture.tolist()} is not among {solutions.tolist()}; {self._where(row)}"
            )


def _check_round_trips(
    finding: Finding, truth: Solutions, backend: Backend, postures: Sample
) -> None:
    """The exact forward map takes every answer that is OK to the target.

    Answers that seem to miss by more than half of the tolerance are evaluated in Arb, worst first.
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
                    f"branch {branch[k]} is OK, but fk misses by {exact:.3g}; "
                    f"{posed.name}: {given[k].tolist()}, parameters {parameters}"
                )


def _spread(parameters: Sequence[float]) -> float:
    """The largest length over the smallest."""
    sizes = [abs(p) for p in parameters if p]
    return max(sizes) / min(sizes) if sizes else 1.0


def _movement(truth: Solutions, backend: Backend, sample: Sample, solutions: NDArray[Any]) -> float:
    """How far the answers move when every coordinate of the target moves by an ulp.

    The first rounding may hide a single ulp, so four ulps are tried as well.
    """
    largest = 0.0
    for ulps in (1, 4):
        nearby = _nearby(backend, sample, ulps)
        moved = truth.gap(_call(backend, truth.function, nearby)[0], solutions) / ulps
        largest = float(np.max(moved, initial=largest, where=np.isfinite(moved)))
    return largest


def _leaves_the_workspace(truth: Solutions, backend: Backend, sample: Sample) -> bool:
    """Whether a target an ulp away is out of reach by more than the tolerance in all branches.

    If a large offset is subtracted from a large distance, an ulp of the target moves far inside.
    """
    slack = backend.tolerances.feasibility
    nearby = _nearby(backend, sample).values
    margins = truth.margins(nearby, sample.parameters, -slack, matched=slack)
    return bool((margins < -slack).all(axis=1).any())


def _nearby(backend: Backend, sample: Sample, ulps: int = 1) -> Sample:
    """Targets that differ from one target by some ulps in every coordinate."""
    columns = np.arange(sample.values.shape[1])
    signs = np.array([(-1) ** ((pattern >> (columns % 2)) & 1) for pattern in range(4)])
    moved = sample.values * (1 + ulps * signs * backend.eps)
    return Sample(sample.name, moved, sample.parameters)


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
