"""Compares computed values with the exact ones: numbers in ulps, truth values one by one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from flint import arb, ctx
from numpy.typing import NDArray

from closedform.algebra.balls import Undetermined, to_float
from closedform.check.assembled import assembled
from closedform.check.finding import (
    MISSED,
    Backend,
    Finding,
    called,
    called_at_all,
    rounded,
    thinned,
)
from closedform.check.samples import Sample, joint_samples
from closedform.check.truth import Values, condition_of, values_of
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.tolerances import HIGHEST_DEGREE

WELL_CONDITIONED = 3.0
"""Larger errors, in ulps, are compared with the change of the value if the inputs change."""
CUT, TURN, HIGH = 3.0, 2 * math.pi, 200
"""Angles beyond the first value are next to the cut at pi; a whole turn; bits for adding one."""

NESTED = 64.0
"""The natural scale is at most this many times the largest value, parameter or numerical length.

(For a product of lengths besides a pose, it is a power of the largest length.)  In a long chain of
steps the natural scale grows with every step, and would soon allow any error.
"""

ACCURATE = 2.0**-40
"""Balls with a radius of at most this share of the largest value give that value."""

NEAR_POLE = 2.0**-4
"""What vanishes or ends where assembly modes meet is small below this share of its scale."""


def check_forward(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare values, in ulps of their natural scale."""
    finding = backend.finding(derivation.name, function.name)
    values = values_of(derivation, function)
    drawn = joint_samples(derivation, function)
    drawn += assembled(derivation, function, values, drawn)
    samples = [rounded(thinned(sample, len(values.exprs)), backend) for sample in drawn]
    samples = [sample for sample in samples if len(sample.values)]
    values.prepare(samples)
    results = called_at_all(backend, function, samples)
    for sample, outputs in zip(samples, results, strict=True):
        _compare(finding, values, backend, sample, outputs[: len(function.outputs)])
    allowed = backend.tolerances.ulps + values.operations * backend.tolerances.ulps_per_operation
    if not finding.worst <= allowed:
        near = finding.worst <= MISSED * allowed
        finding.fail(f"{finding.worst:.3g} ulp: {finding.where}", limited=near)
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
    slack = 2 * backend.tolerances.feasibility
    exists = values.existence(rows, slack)
    wanted = ((exists > 0) | ((exists < 0) & ~np.isnan(computed))).any(axis=1)
    exists[values.flagged(rows, 2 * backend.tolerances.vanishing, wanted)] = 0
    taken = np.argwhere((exists < 0) & ~np.isnan(computed))
    explained = values.explained(rows, slack, backend.eps) if len(taken) else exists
    for row, k in taken:
        problem = f"a value out of bounds, entry {k} at {rows[row].tolist()}"
        finding.fail(problem, limited=bool(explained[row, k]))
    defined = (exists > 0).any(axis=1)
    balls = [x[defined] for x in values.exact.balls(rows)]
    rows, computed, exists = rows[defined], computed[defined], exists[defined]
    errors = _Errors(values, backend, rows, computed, balls)
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
        balls: Sequence[NDArray[Any]],
    ):
        self.values, self.backend, self.rows, self.computed = values, backend, rows, computed
        self.middle, self.radius = balls
        parameters = abs(rows[:1, values.given :])
        self.lengths = [*map(float, parameters.flat), *map(abs, values.lengths)]
        self.scales = values.scales(rows, backend.dtype)
        powers = values.powers(rows)
        self.powers = np.where(values.beside_pose & (values.degrees > 1), powers, 0.0)
        # if lengths are divided by the largest one, what is smaller than this is lost
        self.least = np.finfo(backend.dtype).tiny * np.maximum(powers, 1.0)
        # an angle just above -pi may be rounded to -pi, which is returned as pi, and one that is
        # just below it before it is reduced may be rounded to one above it
        ahead, behind = computed > CUT, computed < -CUT
        whole = (ahead & (self.middle < -CUT)).astype(int) - (behind & (self.middle > CUT))
        self.turns = np.where(values.angles, whole, 0)
        self.unsettled: set[int] = set()
        self._largest: dict[int, float] = {}

    def bounds(self) -> NDArray[np.float64]:
        """Upper bounds of all errors; infinite where nothing is known."""
        exact = self.middle + TURN * self.turns
        with np.errstate(all="ignore"):
            sizes = np.where(np.isfinite(self.radius), np.maximum(abs(exact) - self.radius, 0), 0)
            most = NESTED * sizes.max(axis=1, initial=max(self.lengths, default=0.0))
            most = np.maximum(most[:, None], NESTED * self.powers)
            size = np.maximum.reduce([np.minimum(self.scales, most), sizes, self.least])
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
        scale = natural = self._scale(row, k, exacts)
        exact = _turned(exacts[k], int(self.turns[row, k]))
        error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED:
            moved = float(_variation(self.values, k, self.rows[row], exacts[k], self.backend))
            scale += moved / self.backend.eps
            error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED:
            moved = self.values.moved_by_numbers(self.rows[row], k, self.backend.eps)
            scale += moved / self.backend.eps
            error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED:
            scale += self._of_lengths(row, k)
            error = _ulps(self.computed[row, k], exact, scale, self.backend)
        if error > WELL_CONDITIONED and (self.values.beside_pose or self.values.in_modes):
            grown = float(self._amplified[row, k])
            finite = math.isfinite(self.computed[row, k])
            # of an infinite value no digit is known where its divisor may vanish
            known = natural if finite else abs(to_float(exact))
            # and of a value below the normal numbers only those of its factors, which lose theirs
            vanishes = abs(to_float(exact)) < np.finfo(self.backend.dtype).tiny
            lost = self._overflows(row) or ((vanishes or not finite) and self._underflows(row))
            if lost or self.backend.eps * grown >= known:
                return None
            if self._open[row, k]:
                return None  # its divisor may vanish
            if self.values.beside_pose or self._near_pole(row):
                error = _ulps(self.computed[row, k], exact, scale + grown, self.backend)
        return error

    def _scale(self, row: int, k: int, exacts: Sequence[arb]) -> float:
        """The natural scale of an entry, at most :data:`NESTED` times the largest value there."""
        if row not in self._largest:
            middle, radius = abs(self.middle[row]), self.radius[row]
            if radius.max(initial=0.0) <= middle.max(initial=0.0) * ACCURATE:
                sizes = [float(middle.max(initial=0.0))]
            else:
                sizes = [abs(to_float(e)) for e in exacts if e.is_finite()]
            self._largest[row] = max([*sizes, *self.lengths], default=1.0)
        most = NESTED * max(self._largest[row], self.powers[row, k])
        scale = max(min(self.scales[row, k], most), self.least[row, k])
        return float(scale) if math.isfinite(self.scales[row, k]) else math.inf

    def _overflows(self, row: int) -> bool:
        """Whether powers of lengths may overflow, because they are not scaled."""
        largest = self.backend.tolerances.sizes(HIGHEST_DEGREE)[1]
        longest = self.values.longest(self.rows[row : row + 1])[0]
        return bool(not self.values.scaled and longest > largest)

    def _underflows(self, row: int) -> bool:
        """Whether powers of lengths may vanish, and with them what a value is divided by."""
        least = self.backend.tolerances.sizes(HIGHEST_DEGREE)[0]
        return bool(self.values.shortest(self.rows[row : row + 1])[0] < least)

    def _near_pole(self, row: int) -> bool:
        """Whether assembly modes are so close that divisors nearly cancel, or hardly exist."""
        if not self.values.in_modes:
            return False
        here = self.rows[row : row + 1]
        flagged = self.values.flagged(here, NEAR_POLE)[0]
        return bool(flagged or (self.values.existence(here, NEAR_POLE) == 0).any())

    def _of_lengths(self, row: int, k: int) -> float:
        """The natural scale with the lengths that cancel, at most the largest length."""
        named = self._named[row, k]
        return float(min(named, max(self.lengths, default=named)))

    # what follows is for all rows at once, which takes little more time than for one

    @cached_property
    def _named(self) -> NDArray[Any]:
        return self.values.named(self.rows, self.backend.dtype)

    @cached_property
    def _open(self) -> NDArray[Any]:
        return self.values.exact.open_around(self.rows, self.backend.eps)

    @cached_property
    def _amplified(self) -> NDArray[np.float64]:
        return self.values.amplified(self.rows)


def _turned(angle: arb, turns: int) -> arb:
    """The angle and whole turns."""
    if turns == 0:
        return angle
    with ctx.workprec(HIGH):
        return angle + 2 * turns * arb.pi()


def _last_places(sizes: NDArray[Any], backend: Backend) -> NDArray[Any]:
    """The units in the last place of numbers of these sizes."""
    normal = np.maximum(sizes, float(np.finfo(backend.dtype).tiny))
    return np.asarray(np.maximum(np.ldexp(backend.eps, np.frexp(normal)[1] - 1), 5e-324))


def check_boolean(derivation: Derivation, function: Function, backend: Backend) -> Finding:
    """Compare truth values with the exact bounds, except within a tolerance of zero.

    A condition in the output itself is compared in Arb as well.
    """
    finding = backend.finding(derivation.name, function.name, "wrong answers")
    condition = condition_of(derivation, function)
    for sample in joint_samples(derivation, function):
        sample = rounded(sample, backend)
        (computed,) = called(backend, function, sample)
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
    value = abs(to_float(exact))
    if not (math.isfinite(value) and math.isfinite(scale)):
        return 0.0
    if not math.isfinite(computed):
        return math.inf
    size = max(scale, value, float(np.finfo(backend.dtype).tiny))
    unit = 2.0 ** math.floor(math.log2(size)) * backend.eps
    return abs(to_float(exact - arb(computed))) / max(unit, 5e-324)


__all__ = ["check_boolean", "check_forward"]
