"""Compares the answers of an inverse with its equations, bounds, branches and known postures."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from closedform.check.finding import MISSED, Backend, Finding, called_at_all, rounded, thinned
from closedform.check.samples import Sample, inverse_postures, joint_samples, perturbed
from closedform.check.singular import singular_samples
from closedform.check.truth import Solutions, solutions_of
from closedform.check.values import check_forward
from closedform.lower import lowered
from closedform.model.cached import cached
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.inverse import Inverse
from closedform.model.tolerances import HIGHEST_DEGREE

APART = 5e-4
"""The largest distance of an answer from the posture behind its target, times a thousandth."""
FEW = 3
"""So many ordinary answers of a sample may be lost in single precision, or a tenth of its rows."""
UNEQUAL = 100
"""The ratio of the longest length to the shortest from which on lengths are very unequal."""
SUSPECTS = 5
"""The number of worst answers on and near the singular set that are evaluated in Arb."""

OK, UNREACHABLE, SINGULAR, INVALID = range(4)


_singular_samples = cached(singular_samples)


def check_inverse(
    derivation: Derivation, function: Function, inverse: Inverse, backend: Backend
) -> Finding:
    """Put the answers into the exact equations; compare statuses; look for known postures.

    If the inputs are images of the unknowns, they are made from postures, which the inverse must
    return.  Otherwise (the assembly modes of a loop) the inputs are sampled directly.
    """
    finding = backend.finding(derivation.name, function.name, "residual / eps")
    truth = solutions_of(derivation, function, inverse)
    if not truth.has_images:
        if not truth.stated:
            return check_forward(derivation, function, backend)
        drawn = [rounded(sample, backend) for sample in joint_samples(derivation, function)]
        parts = [p for s in drawn for p in _in_range(derivation, function, s, backend)]
        _check_batches(finding, truth, backend, [(part, exact, None) for part, exact in parts])
        return finding
    batches: list[_Targets] = []
    answers = len(inverse.unknowns) * len(list(function.cases()))
    for sample in inverse_postures(derivation, inverse.unknowns):
        postures = rounded(thinned(sample, answers), backend)
        images, known_postures = truth.images(postures)
        if not len(images):
            continue
        for values, known in ((images, known_postures), (perturbed(images), None)):
            posed = rounded(Sample(sample.name, values, sample.parameters), backend)
            batches.append((posed, known is not None, known))
    _check_batches(finding, truth, backend, batches)
    drawn = _singular_samples(derivation, inverse.unknowns)
    targets = [_targets(truth, backend, rounded(sample, backend)) for sample in drawn]
    targets = [posed for posed in targets if len(posed.values)]
    results = called_at_all(backend, function, targets)
    for posed, found in zip(targets, results, strict=True):
        _check_round_trips(finding, truth, backend, posed, found)
    return finding


_Targets: TypeAlias = "tuple[Sample, bool, NDArray[Any] | None]"
"""Targets, whether they can be reached, and the postures behind them."""


def _check_batches(
    finding: Finding, truth: Solutions, backend: Backend, batches: Sequence[_Targets]
) -> None:
    """Check each batch; what they need in balls is evaluated for all of them together."""
    samples = [sample for sample, _, _ in batches]
    truth.prepare(samples)
    results = called_at_all(backend, truth.function, samples)
    for (sample, exact, known), found in zip(batches, results, strict=True):
        _Batch(finding, truth, backend, sample, exact=exact).check(found, known)


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

    def check(self, found: tuple[NDArray[Any], ...], known: NDArray[Any] | None) -> None:
        """Compare the answers that were ``found``; the ``known`` postures must be among them.

        What single precision cannot do is an error if it is more than a few ordinary answers.
        """
        before = len(self.finding.limits)
        solutions, status = found
        self._compare(solutions, status, known)
        limits = self.finding.limits[before:]
        ordinary = self.sample.name == "random" and _spread(self.sample.parameters) < UNEQUAL
        if ordinary and len(limits) > max(FEW, len(self.sample.values) / 10):
            for message in limits:
                self.finding.fail(message)

    def _compare(
        self, solutions: NDArray[Any], status: NDArray[Any], known: NDArray[Any] | None
    ) -> None:
        """Only what may be wrong, or worse than the worst so far, is evaluated in Arb."""
        truth, sample, eps = self.truth, self.sample, self.backend.eps
        feasibility = self.backend.tolerances.feasibility
        slack, matched = 2 * feasibility, min(16 * eps, feasibility / 8)
        limits = (slack, -slack, -16 * eps)
        margins = truth.margins(sample.values, sample.parameters, *limits, matched=matched)
        feasible = np.where(abs(margins) > slack, np.sign(margins), 0)
        wrong = self._suspicious(solutions, status, feasible)
        for row, branch in np.argwhere(wrong):
            code, reached = int(status[row, branch]), feasible[row, branch]
            problem, limited = self._problem(row, solutions[row, branch], code, reached)
            if problem:
                message = f"branch {branch} {problem}; {self._where(row)}"
                self.finding.fail(message, limited=limited)
            wrong[row, branch] = bool(problem)
            if self.finding.full:
                return
        if self.exact and truth.stated:
            answered = np.argwhere(~wrong & np.isin(status, (OK, SINGULAR)))
            self._see_residuals(solutions, margins, answered)
        if self.exact and sample.name == "random" and status.shape[1] > 1:
            self._compare_branches(solutions, status)
        if known is not None:
            spread = eps * _spread(sample.parameters)
            gap = np.fmin.reduce(truth.gap(solutions, known[:, None]), axis=1, initial=np.inf)
            for row in np.flatnonzero(~(gap <= 1e3 * spread) & ~(status == SINGULAR).any(axis=1)):
                self._check_known(row, solutions[row], known[row])
                if self.finding.full:
                    return

    def _compare_branches(self, solutions: NDArray[Any], status: NDArray[Any]) -> None:
        """No branch has the answer of another one.

        Only answers are judged that are far from their own branch and on another one, at random
        postures: near a singular one, rounding may move an answer from one branch to another.
        """
        apart = 1e3 * math.sqrt(self.backend.eps)  # branches that meet differ by a rounding's root
        exact, radius = self.truth.answers(self.sample.values, self.sample.parameters)
        known = radius < apart
        gaps = self.truth.gap(solutions[:, :, None], exact[:, None])
        own = np.diagonal(gaps, axis1=1, axis2=2)[:, :, None]
        judged = ((status == OK) & known)[:, :, None] & known[:, None] & (own > apart)
        unequal = _spread(self.sample.parameters) >= UNEQUAL
        for row, branch, other in np.argwhere(judged & (gaps < own / 1e3)):
            where = self._where(row)
            self.finding.fail(
                f"branch {branch} has the answer of branch {other}; {where}", limited=unequal
            )

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

    def _problem(
        self, row: Any, solution: NDArray[Any], code: int, feasible: float
    ) -> tuple[str, bool]:
        """What is wrong with an answer, and whether too few digits may explain it.

        It is empty if nothing is wrong, or if a free joint explains it.
        """
        problem = self._contradiction(solution, code, feasible)
        if not problem or code not in (OK, SINGULAR):
            return problem, np.isnan(solution).all()
        if feasible < 0:
            # where a joint is free, another turn of it may reach what the generic one does not
            given, parameters = self.sample.values[row], self.sample.parameters
            missed = self.truth.residual(solution, given, parameters)
            allowed = self._violated() + self.truth.violation(given, parameters)
            return "" if missed <= allowed else problem, missed <= MISSED * allowed
        return problem, False

    def _violated(self) -> float:
        """By how much an answer may violate its equations, with the parameters of the sample."""
        condition = float(self.truth.amplified(*self.sample.parameters))
        return self.backend.tolerances.violated(condition)

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
        allowed = self._violated()
        for k in np.argsort(-bounds):
            worse = counted[k] and bounds[k] > self.finding.worst * eps
            if not (worse or bounds[k] > allowed):
                continue
            residual = self.truth.residual(solutions[row[k], branch[k]], given[k], parameters)
            where = self._where(row[k])
            if counted[k]:
                self.finding.see(residual / eps, lambda: where)  # noqa: B023
            if not residual <= allowed:
                near = residual <= MISSED * allowed
                self.finding.fail(
                    f"branch {branch[k]} misses by {residual:.3g}; {where}", limited=near
                )
                if self.finding.full:
                    return

    def _check_known(self, row: Any, solutions: NDArray[Any], posture: NDArray[Any]) -> None:
        """Check that the posture behind a target is among the branches, unless a joint is free."""
        truth, backend, parameters = self.truth, self.backend, self.sample.parameters
        one = Sample(self.sample.name, self.sample.values[row : row + 1], parameters)
        gaps = truth.gap(solutions, posture)
        if np.isnan(gaps).all():
            if not _leaves_the_workspace(truth, backend, one):
                lost = f"{posture.tolist()} is lost: no branch has a solution"
                self.finding.fail(f"{lost}; {self._where(row)}", limited=True)
            return
        # where three solutions meet, a rounding moves them by its cube root
        condition = max(truth.condition(posture, parameters), backend.eps ** (2 / 3))
        allowed = min(backend.eps / condition, APART) * _spread(parameters)
        nearest = int(np.nanargmin(gaps))
        # an ulp of the target turns a nearly free joint far
        far = gaps[nearest] / 1e3 - allowed
        if far <= 0 or _moves(truth, backend, one, solutions, far):
            return
        if not truth.continues(posture, parameters, backend.tolerances.forward):
            lost = (
                f"{posture.tolist()} is lost: the nearest solution is {solutions[nearest].tolist()}"
            )
            self.finding.fail(f"{lost}; {self._where(row)}", limited=True)


def _in_range(
    derivation: Derivation, function: Function, sample: Sample, backend: Backend
) -> Iterator[tuple[Sample, bool]]:
    """The targets that the function promises to reach, and those whose powers may overflow.

    The latter exist if lengths of the mechanism are numbers, because it cannot be scaled then.
    """
    limit = backend.tolerances.sizes(HIGHEST_DEGREE)[1]
    beyond = (abs(sample.values) > limit).any(axis=1)
    beyond &= beyond.any() and lowered(function, derivation).degrees is None
    for rows in (~beyond, beyond):
        if rows.any():
            yield replace(sample, values=sample.values[rows]), rows is not beyond


def _targets(truth: Solutions, backend: Backend, postures: Sample) -> Sample:
    """The images of postures, as targets in the float type of the code."""
    images = truth.wide_images(postures.values, postures.parameters)
    targets = np.concatenate(list(images)).astype(float)
    finite = targets[np.isfinite(targets).all(axis=-1)]
    return rounded(Sample(postures.name, finite, postures.parameters), backend)


def _check_round_trips(
    finding: Finding,
    truth: Solutions,
    backend: Backend,
    posed: Sample,
    found: tuple[NDArray[Any], ...],
) -> None:
    """The exact forward map takes every answer that is OK to the target.

    Answers that seem to miss by more than half of the tolerance are evaluated in Arb, worst first.
    """
    parameters = posed.parameters
    allowed = backend.tolerances.promised(float(truth.amplified(*parameters)))
    solutions, status = found
    row, branch = np.nonzero(status == OK)
    answers, given = solutions[row, branch].astype(float), posed.values[row]
    missed = truth.missed(truth.wide_images(answers, parameters), answers, given, parameters)
    if not truth.stated:
        finding.compared += len(answers)
        worst = missed.max(initial=0.0) / backend.eps
        finding.see(float(worst), lambda: posed.name)
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


def _moves(
    truth: Solutions, backend: Backend, sample: Sample, solutions: NDArray[Any], far: float
) -> bool:
    """Whether the answers move that far when a coordinate or a parameter moves by an ulp.

    A tiny coordinate hardly moves by an ulp, but lengths that nearly cancel do: where a rod ends
    close to the axis of its crank, the angle depends on the last bits of two equal lengths.  The
    first rounding may hide a single ulp, so four ulps are tried as well.
    """
    for ulps in (1, 4):
        nearby = [_nearby(backend, sample, ulps), *_resized(backend, sample, ulps)]
        for answers, _ in called_at_all(backend, truth.function, nearby, mixed=True):
            moved = truth.gap(answers, solutions) / ulps
            if np.max(moved, initial=0.0, where=np.isfinite(moved)) >= far:
                return True
    return False


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


def _resized(backend: Backend, sample: Sample, ulps: int) -> Iterator[Sample]:
    """The same target for mechanisms in which one parameter differs by some ulps."""
    for k, parameter in enumerate(sample.parameters):
        others = sample.parameters[:k], sample.parameters[k + 1 :]
        for step in (ulps * backend.eps, -ulps * backend.eps):
            resized = (*others[0], parameter * (1 + step), *others[1])
            yield replace(sample, parameters=resized)


__all__ = ["check_inverse"]
