"""The exact values of a function, with which generated code is compared.

Many points are evaluated at once, in balls over arrays; points that these leave open are evaluated
in Arb.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np
import sympy as sp
from flint import arb
from numpy.typing import NDArray

from closedform.algebra.balls import Undetermined, to_float
from closedform.check.cases import Flags, Margins, flags_of, in_cases, margins_of
from closedform.check.rows import WIDE, RowEvaluator, crosses
from closedform.check.samples import Degrees, Magnitudes, Sample, with_parameters
from closedform.lower import lowered
from closedform.mechanics.lengths import numbers_of_tool
from closedform.model.cached import cached
from closedform.model.derivation import Derivation
from closedform.model.expressions import free_symbols, parts, replaced, substitute
from closedform.model.functions import Bound, Determined, Function, Let, Match, Require
from closedform.model.inverse import Combination, Inverse

Array = NDArray[Any]

STEP, CORRECTIONS, SLOW, STILL = 1e-3, 12, 1e-5, 1e-8
"""Of a motion that keeps the hand in place: its first step, and how often it is corrected.

The step is in a direction in which the hand is slow, and no correction is made where it stands
still, as shares of the fastest direction.  Where two solutions meet, each correction halves the
step, so twelve lead back.
"""
TURN = 2 * math.pi

_numbers_of_tool = cached(numbers_of_tool)


class Values:
    """The exact values of a function that is not an inverse, and where they exist."""

    def __init__(self, derivation: Derivation, function: Function):
        signs = [signs for _, signs in function.cases()]
        self.exprs = [e for s in signs for e in function.values(s)]
        self.entries = len(self.exprs) // len(signs)
        """Of one case."""
        self.angles = np.array([isinstance(e, sp.atan2) for e in self.exprs])
        symbols = symbols_of(derivation, function)
        parameters = [p.symbol for p in derivation.parameters]
        self.exact = RowEvaluator(symbols, self.exprs, steady=parameters)
        self._symbols, self._function = symbols, function
        self.given = len(function.symbols)
        """The number of inputs; what follows in a row is the parameters."""
        self.scales = Magnitudes(symbols, self.exprs)
        target = {str(s) for s in function.symbols} == set(derivation.task)
        self.beside_pose = len(function.inputs) > 1 or target
        """Whether it takes a target: alone, where the legs may not hold it, or beside joints, of
        which samples do not close the loop, so that what belongs together cancels less well."""
        self.in_modes = function.branches is not None
        """Whether it has a value in each assembly mode; divisors nearly cancel where modes meet."""
        self.lengths = _numbers_of_tool(derivation)
        self.in_numbers = max(map(_numbers_of_size, derivation.functions), default=0.0)
        """The sum of the lengths that are numbers, if an inverse has it."""
        degrees = Degrees(self.exprs)
        self.degrees = np.array(degrees.degrees)
        """Upper bounds for the degrees of the entries in lengths."""
        self._sized = [k for k, s in enumerate(symbols) if s in degrees.symbols]
        program = lowered(function, derivation)
        self.operations = sum(program.operations().values())
        self.scaled = function.has_status and program.degrees is not None
        """Whether lengths are divided by the largest one, so that their powers do not overflow."""
        self._bounds = Margins(function, symbols, matched=False)
        self._flags = Flags(function, symbols)

    def prepare(self, samples: Sequence[Sample]) -> None:
        """Evaluate the values, bounds and flags at all of these points together."""
        rows = [sample.rows for sample in samples]
        for evaluator in (self.exact, self._bounds, self._flags):
            evaluator.prepare(rows)

    def amplified(self, rows: Array) -> Array:
        """How far roundings may move each value, in the relative error of one rounding.

        This is the radius of a ball that grows with each operation of the function.
        """
        radius = np.concatenate([case.balls(rows)[1] for case in self._as_computed], axis=1)
        return np.asarray(radius / np.finfo(WIDE).eps, float)

    @cached_property
    def _as_computed(self) -> list[RowEvaluator]:
        """The outputs of each case in the names of the function, step by step."""
        function = self._function
        outputs = [e for a in function.outputs for e in a.entries]
        return [in_cases(function, self._symbols, outputs, [s]) for _, s in function.cases()]

    @cached_property
    def named(self) -> Callable[[Array, type], Array]:
        """The natural scales with all lengths, also those that cancel in the explicit form."""
        function = self._function
        flags = dict.fromkeys(flags_of(function), sp.false)
        outputs = [substitute(e, flags) for a in function.outputs for e in a.entries]
        cases = [
            Magnitudes(self._symbols, outputs, names=_names(function, signs))
            for _, signs in function.cases()
        ]
        return lambda rows, dtype: np.concatenate([case(rows, dtype) for case in cases], axis=1)

    def moved_by_numbers(self, row: Array, k: int, share: float) -> float:
        """How far an entry moves if each number that no float holds is off by a ``share``.

        Printed code has these numbers rounded, as the lengths of a mechanism that are not symbols.
        """
        evaluator, numbers = self._with_numbers
        if not len(numbers):
            return 0.0
        nearby = numbers + np.diag(numbers * share)
        try:
            exact, *moved = (evaluator.exactly([*row, *at])[k] for at in (numbers, *nearby))
        except Undetermined:  # at a pole, where nothing is allowed for
            return 0.0
        return sum(m for x in moved if math.isfinite(m := abs(to_float(x - exact))))

    @cached_property
    def _with_numbers(self) -> tuple[RowEvaluator, Array]:
        """The values as functions of these numbers too, and the numbers."""
        whole: sp.Basic = sp.Tuple(*self.exprs)
        numbers = [n for n in parts([whole]) if n.is_Rational and n.q & (n.q - 1)]
        symbols = [sp.Dummy(real=True) for _ in numbers]
        for number, symbol in zip(numbers, symbols, strict=True):
            whole = replaced(whole, number, symbol)
        given = (*self._symbols, *symbols)
        return RowEvaluator(given, whole.args), np.array(numbers, float)

    def powers(self, rows: Array) -> Array:
        """For each entry, the largest length to the power of its degree; 1 for negative degrees."""
        with np.errstate(over="ignore"):
            return np.asarray(self.longest(rows)[:, None] ** np.maximum(self.degrees, 0.0))

    def longest(self, rows: Array) -> Array:
        """The largest length of each row."""
        return np.asarray(abs(rows[:, self._sized]).max(axis=1, initial=0.0))

    def shortest(self, rows: Array) -> Array:
        """The smallest length of each row that is not zero; infinite if there is none."""
        sized = abs(rows[:, self._sized])
        return np.asarray(np.where(sized > 0, sized, np.inf).min(axis=1, initial=np.inf))

    def existence(self, rows: Array, slack: float) -> Array:
        """For each entry: 1 where it exists, -1 where not, 0 within ``slack`` of the boundary."""
        least, _ = self._bounds.least(rows, slack, -slack)
        return np.repeat((least > slack) * 1 - (least < -slack), self.entries, axis=1)

    def inside(self, rows: Array) -> Array:
        """How far inside of its bounds the case is that is the farthest; roughly."""
        return self._bounds.inside(rows)

    def explained(self, rows: Array, slack: float, rounding: float) -> Array:
        """For each entry, whether roundings explain that it has a value though it does not exist.

        Bars of very unequal lengths enlarge the roundings of the points that they hold.
        """
        found = self._bounds.explained(rows, slack, rounding)
        return np.repeat(found, self.entries, axis=1)

    def flagged(self, rows: Array, limit: float, wanted: Array | None = None) -> Array:
        """Where a flag is raised, so that the value is a convention; see :class:`Flags`."""
        return self._flags.raised(rows, limit, wanted)


def _names(
    function: Function, signs: Mapping[sp.Symbol, int]
) -> dict[sp.Symbol, sp.Expr | sp.Basic]:
    """The names of a function in one of its cases, each with its value; flags are false."""
    flags = dict.fromkeys(flags_of(function), sp.false)
    made = [s for s in function.body if isinstance(s, Let | Bound)]
    return {
        **{sign: sp.Integer(value) for sign, value in signs.items()},
        **{s.symbol: substitute(s.value, flags) for s in made},
    }


class Condition:
    """The exact truth value of a function, and the bounds it rests on."""

    def __init__(self, derivation: Derivation, function: Function):
        symbols = symbols_of(derivation, function)
        (entry,) = (e for a in function.outputs for e in a.entries)
        bounds = margins_of(function, (Bound, Match))
        self._bounds = in_cases(function, symbols, bounds, [{}])
        self._flags = Flags(function, symbols)
        self._holds = RowEvaluator(symbols, [sp.Piecewise((1, entry), (0, True))])

    def __call__(self, rows: Array, slack: float) -> tuple[Array, Array]:
        """The truth values, and where they are certain: no bound is within ``slack`` of zero."""
        margins = self._bounds.settled(rows, crosses(slack, -slack))
        holds = self._holds.settled(rows, crosses(0.5))[:, 0] == 1
        expected = np.asarray(holds & (margins > 0).all(axis=1))
        open_ = (abs(margins) <= slack).any(axis=1) | self._flags.raised(rows, slack)
        return expected, np.asarray(~open_)


class Solutions:
    """The exact equations and bounds of an inverse, ready to be evaluated."""

    def __init__(self, derivation: Derivation, function: Function, inverse: Inverse):
        self.function = function
        parameters = tuple(p.symbol for p in derivation.parameters)
        self.amplified = sp.lambdify(parameters, inverse.condition)
        revolute = {j.symbol for j in derivation.joints if j.kind == "revolute"}
        self.angular = np.array([u in revolute for u in inverse.unknowns])
        place = (*inverse.unknowns, *function.symbols, *parameters)
        self.stated = not inverse.passive
        """Whether the equations contain only what the function takes and returns."""
        stated = inverse.equations if self.stated else ()
        self._equations = RowEvaluator(place, stated, steady=parameters)
        pairs = list(zip(inverse.forward, inverse.targets, strict=True))
        self._is_turn = [
            t for _, x in pairs for t in [x in inverse.angles] * (1 + (x in inverse.angles))
        ]
        lengths = [f for f, x in pairs if x not in inverse.angles and self.stated]
        self._scales = Magnitudes(place, lengths)
        explicit = tuple(inverse.targets) == function.symbols
        self.has_images = explicit or bool(inverse.images)
        maps = [inverse.forward] if explicit else []
        posture = (*inverse.unknowns, *parameters)
        self._reach: RowEvaluator | None = None
        if inverse.images:
            forward = derivation[inverse.images]
            modes = [mode for _, mode in forward.cases()]
            maps = [forward.values(mode) for mode in modes]
            self._reach = in_cases(forward, posture, margins_of(forward, Bound), modes)
        self._maps = [RowEvaluator(posture, m, steady=parameters) for m in maps]
        self._all_maps = RowEvaluator(posture, [e for m in maps for e in m], steady=parameters)
        slides = {j.symbol for j in derivation.joints if j.kind == "prismatic"}
        self._sliding = np.array([u in slides for u in inverse.unknowns])
        self._turns = np.array([x in inverse.angles for x in function.symbols])
        weights = [inverse.weights.get(x, sp.S.One) for x in function.symbols]
        self._weights = RowEvaluator(posture, weights)
        sized = {*parameters, *slides}
        places = (3, 7, 11) if function.inputs[0].shape == (4, 4) else ()
        self._sized = [
            np.array([bool(free_symbols([e]) & sized) or k in places for k, e in enumerate(m)])
            for m in maps
        ]
        self._in_numbers = max([*_numbers_of_tool(derivation), _numbers_of_size(function)])
        given = (*function.symbols, *parameters)
        self._margins = Margins(function, given)
        self._outputs = [e for a in function.outputs for e in a.entries]
        self._answers = in_cases(function, given, self._outputs)
        required = [e for s in function.body if isinstance(s, Require) for e in s.values]
        self._required = RowEvaluator(given, function.explicit(required, {})[0])
        factors = next((f for f in derivation.functions if f.name == "singularities"), None)
        entries: list[sp.Expr] = []
        if factors and self.has_images:
            entries = [e for _, signs in factors.cases() for e in factors.values(signs)]
        self._factors = RowEvaluator(posture, entries)

    def prepare(self, samples: Sequence[Sample]) -> None:
        """Evaluate the bounds at all of these targets together."""
        self._margins.prepare([sample.rows for sample in samples])

    def images(self, sample: Sample) -> tuple[Array, Array]:
        """The images of postures in each assembly mode that they have, and the postures.

        Postures at which a flag of the forward map leaves the target free have no image, nor have
        those at which one of its bounds is negative.
        """
        rows, postures = [], []
        reached = self._reached(with_parameters(sample.values, sample.parameters))
        images = [self._exact_images(*at) for at in zip(sample.rows, reached.T, strict=True)]
        for of_mode in zip(*images, strict=True):
            for image, posture in zip(of_mode, sample.values, strict=True):
                if image and all(b.is_finite() for b in image):
                    rows.append([to_float(b) for b in image])
                    postures.append(posture)
        shape = (-1, len(self.function.symbols))
        return np.array(rows).reshape(shape), np.array(postures).reshape(-1, len(self.angular))

    def _exact_images(self, row: Array, exists: Array) -> list[list[arb]]:
        """The image in each assembly mode, in Arb; it is empty if there is none."""
        width, modes = len(self.function.symbols), np.flatnonzero(exists)
        images: list[list[arb]] = [[] for _ in exists]
        if not len(modes):
            return images
        try:
            wanted = (modes[:, None] * width + np.arange(width)).ravel()
            found = self._all_maps.exactly(row, wanted)
            for k, mode in enumerate(modes):
                images[mode] = found[k * width : (k + 1) * width]
        except Undetermined:  # in one of the modes, so each is tried alone
            for mode in modes:
                with contextlib.suppress(Undetermined):
                    images[mode] = self._maps[mode].exactly(row)
        return images

    def wide_images(self, postures: NDArray[Any], parameters: Sequence[float]) -> NDArray[Any]:
        """The images of postures in each assembly mode; NaN where the mode does not exist."""
        rows = with_parameters(postures, parameters)
        shape = (len(rows), len(self._maps), len(self.function.symbols))
        images = self._all_maps.values(rows).reshape(shape)
        images = images.swapaxes(0, 1).copy()
        images[~self._reached(rows)] = np.nan
        return images

    def _reached(self, rows: Array) -> Array:
        """For each map, the rows at which none of its bounds is certainly negative."""
        if self._reach is None or not self._reach.exprs:
            return np.ones((len(self._maps), len(rows)), bool)
        shape = (len(rows), len(self._maps), len(self._reach.exprs))
        middle, radius = (x.reshape(shape) for x in self._reach.balls(rows))
        with np.errstate(invalid="ignore"):
            return np.asarray(~(middle + radius < 0).any(axis=2).T)

    def missed(
        self,
        images: NDArray[Any],
        solutions: NDArray[Any],
        given: NDArray[Any],
        parameters: Sequence[float],
    ) -> NDArray[np.float64]:
        """How far the image in the nearest assembly mode is from the target.

        Lengths are relative to the sum of the links and slides, angles to their weights.
        """
        counted = self._weights.values(with_parameters(solutions.astype(float), parameters))
        fixed = np.abs(parameters).sum() + self._in_numbers
        size = fixed + np.abs(solutions * self._sliding).sum(axis=-1)
        missed = []
        for image, sized in zip(images, self._sized, strict=True):
            difference = (image - given).astype(float)
            turned = np.abs(np.angle(np.exp(1j * difference)))
            with np.errstate(divide="ignore", invalid="ignore"):  # slides alone, all of them at 0
                by_size = np.abs(difference) / np.where(sized, size[:, None], 1.0)
            by_size = np.where(difference == 0, 0.0, by_size)
            missed.append((counted * np.where(self._turns, turned, by_size)).max(axis=-1))
        return np.asarray(np.fmin.reduce([*missed, np.full(len(given), np.inf)]))

    def exact_miss(
        self, solution: NDArray[Any], given: NDArray[Any], parameters: Sequence[float]
    ) -> float:
        """The same for one answer, in Arb."""
        if not np.isfinite(solution.astype(float)).all():
            return math.inf
        point = [*map(float, solution), *map(float, parameters)]
        try:
            balls = self._all_maps.exactly(point)
        except Undetermined:  # what leaves the target free does not determine it
            return math.inf
        width = len(given)
        offsets = [
            [to_float(b - arb(float(g))) for b, g in zip(balls[k : k + width], given, strict=True)]
            for k in range(0, len(balls), width)
        ]
        images = np.array(offsets)[:, None]
        return float(self.missed(images, solution[None], 0 * given[None], parameters)[0])

    def residual(
        self, solution: NDArray[Any], given: NDArray[Any], parameters: Sequence[float]
    ) -> float:
        """The largest violation of an equation, relative to the largest natural scale.

        The sine and the cosine of an angle have a scale of their own, which is 1.  If the equations
        contain passive unknowns, it is how far the image misses the target.
        """
        if not np.isfinite(solution).all():
            return math.inf
        if not self.stated:
            return self.exact_miss(solution, given, parameters)
        point = [*map(float, solution), *map(float, given), *map(float, parameters)]
        scale = max(self._scales(np.array([point]))[0], default=1.0) or 1.0
        errors = [abs(to_float(e)) for e in self._equations.exactly(point)]
        return max(e / (1.0 if t else scale) for e, t in zip(errors, self._is_turn, strict=True))

    def residual_bounds(self, answers: Array, given: Array, parameters: Sequence[float]) -> Array:
        """An upper bound for the residual of each answer."""
        points = with_parameters(np.concatenate([answers, given], axis=1), parameters)
        scale = self._scales(points).max(axis=1, initial=0.0)
        scale[scale == 0] = 1.0
        middle, radius = self._equations.balls(points)
        with np.errstate(invalid="ignore"):
            errors = (abs(middle) + radius) / np.where(self._is_turn, 1.0, scale[:, None])
        return np.asarray(np.where(np.isfinite(errors), errors, np.inf).max(axis=1))

    def margins(
        self, given: Array, parameters: Sequence[float], *limits: float, matched: float
    ) -> Array:
        """The smallest bound of each branch over its scale; negative where there is no branch.

        It is decided exactly on which side of each of the ``limits`` a bound is.  A quantity that
        must match does not count if it misses by no more than ``matched``.
        """
        rows = with_parameters(given, parameters)
        least, missed = self._margins.least(rows, *limits, -matched)
        return np.where(missed >= -matched, least, np.fmin(least, missed))

    def answers(self, given: Array, parameters: Sequence[float]) -> tuple[Array, Array]:
        """The answer of each branch and a bound on its error, infinite where nothing is known.

        The branches are the second axis.  All flags are taken as false.
        """
        middle, radius = self._answers.balls(with_parameters(given, parameters))
        shape = (len(given), -1, len(self._outputs))
        return middle.reshape(shape), radius.reshape(shape).max(axis=-1)

    def violation(self, given: NDArray[Any], parameters: Sequence[float]) -> float:
        """How far an input violates its requirement, such as that a matrix is a rotation."""
        missed = self._required.exactly([*map(float, given), *parameters])
        return max((abs(to_float(m)) for m in missed), default=0.0)

    def condition(self, posture: NDArray[Any], parameters: Sequence[float]) -> float:
        """The smallest factor of the singular set, at most 1.

        An arm without such factors has the least singular value of its forward map instead.
        """
        if not self._factors.exprs:
            return float(min([1.0, *self._rates(posture, parameters)]))
        factors = self._factors.exactly([*map(float, posture), *parameters])
        return min([1.0, *(abs(to_float(f)) for f in factors if f.is_finite())])

    def continues(self, posture: NDArray[Any], parameters: Sequence[float], allowed: float) -> bool:
        """Whether the mechanism can move on from a posture and miss its target by no more.

        Then the target does not determine the posture: the answers are right, but may be far from
        it.  A step in a direction that hardly moves the hand is corrected in the other directions.
        """
        images, every = (
            self.wide_images(posture[None], parameters),
            self._slopes(posture, parameters),
        )
        for mode, (found, slopes) in enumerate(zip(images, every, strict=True)):
            if not (np.isfinite(found).all() and np.isfinite(slopes).all()):
                continue
            _, rates, directions = np.linalg.svd(slopes)
            least = SLOW * rates.max()
            rates = np.append(rates, np.zeros(len(directions) - len(rates)))
            for direction in directions[rates < least]:
                q = self._corrected(posture + STEP * direction, found, mode, parameters)
                if q is None or self.gap(q[None], posture)[0] < STEP / 10:
                    continue
                ends = self.wide_images(q[None], parameters)
                if self.missed(ends, q[None], found, parameters)[0] <= allowed:
                    return True
        return False

    def _corrected(
        self, q: NDArray[Any], target: Array, mode: int, parameters: Sequence[float]
    ) -> NDArray[Any] | None:
        """A posture that reaches a target in an assembly mode; None where the mode ends."""
        for _ in range(CORRECTIONS):
            missed = (target - self.wide_images(q[None], parameters)[mode])[0].astype(float)
            slopes = self._slopes(q, parameters)[mode]
            if not (np.isfinite(missed).all() and np.isfinite(slopes).all()):
                return None
            q = q + np.linalg.lstsq(slopes, missed, rcond=STILL)[0]
        return q

    def _rates(self, posture: NDArray[Any], parameters: Sequence[float]) -> list[float]:
        """The singular values of the forward map: how far the target moves with the joints."""
        slopes = self._slopes(posture, parameters)
        found = np.linalg.svd(slopes[np.isfinite(slopes).all(axis=(1, 2))], compute_uv=False)
        return [float(rate) for rate in found.flat]

    def _slopes(self, posture: NDArray[Any], parameters: Sequence[float]) -> NDArray[np.float64]:
        """The derivatives of the forward map by the joints in each mode, by differences."""
        steps = 1e-6 * np.eye(len(posture))
        ends = self.wide_images(np.concatenate([posture + steps, posture - steps]), parameters)
        rates = (ends[:, : len(steps)] - ends[:, len(steps) :]).astype(float) / 2e-6
        return np.asarray(rates.swapaxes(1, 2))

    def gap(self, solutions: NDArray[Any], posture: NDArray[Any]) -> NDArray[np.float64]:
        """The distance of each solution from a posture, angles modulo a turn."""
        difference = solutions.astype(float) - posture
        turns = TURN * np.rint(difference / TURN)
        return np.asarray(abs(difference - self.angular * turns).max(axis=-1))


def _numbers_of_size(function: Function) -> float:
    """The lengths of a loop that are numbers, from the sum of all its lengths."""
    named = {s.symbol: s.value for s in function.body if isinstance(s, Let | Bound)}
    sizes = [s.size for s in function.body if isinstance(s, Determined)]
    sums = [substitute(size, named) for size in sizes if size.free_symbols]
    return max(
        (float(e.xreplace(dict.fromkeys(e.free_symbols, sp.S.Zero))) for e in sums), default=0.0
    )


def symbols_of(derivation: Derivation, function: Function) -> tuple[sp.Symbol, ...]:
    """The symbols on which the values of a function depend, in the order of a row."""
    return (*function.symbols, *(p.symbol for p in derivation.parameters))


values_of, condition_of = cached(Values), cached(Condition)


@cached
def solutions_of(derivation: Derivation, function: Function, inverse: Inverse) -> Solutions:
    """The exact equations of an inverse; of a reduced one, those of its forward map."""
    if isinstance(inverse.glue, Combination) and inverse.images:
        inverse = inverse.posed(function.symbols, derivation[inverse.images].values({}))
    return Solutions(derivation, function, inverse)


__all__ = [
    "Condition",
    "Solutions",
    "Values",
    "condition_of",
    "solutions_of",
    "values_of",
]
