"""The postures and dimensions at which generated code is tested: those at which it may break.

They are home, multiples of a right angle approached to 1e-15, huge angles, denormals, merging
branches, the boundary of the workspace, and random ones.  All are ordinary arrays of doubles, the
same on every run.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.check.rows import RowEvaluator, inaccurate
from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.functions import Function

Array = NDArray[np.float64]

APPROACHES = (0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e-1)
HUGE = (1e4, 4e5, 1e7, 1e15, 1e22, 1e300)
TINY = (5e-324, 2.2250738585072014e-308, 1e-160, 1e-20)


@dataclass(frozen=True)
class Sample:
    """A named batch: a row of joint values (or inputs) for each posture, one set of parameters."""

    name: str
    values: Array
    parameters: tuple[float, ...]

    @property
    def rows(self) -> Array:
        """Each row followed by the parameters."""
        return with_parameters(self.values, self.parameters)


def with_parameters(values: Array, parameters: Sequence[float]) -> Array:
    """Rows of values, each followed by the parameters."""
    sizes = np.broadcast_to(np.array(parameters, float), (len(values), len(parameters)))
    return np.concatenate([np.asarray(values, float), sizes], axis=1)


def parameter_sets(derivation: Derivation, rng: np.random.Generator) -> Iterator[tuple[float, ...]]:
    """The example dimensions, then equal, random and very unequal ones."""
    n = len(derivation.parameters)
    if not n:
        yield ()
        return
    yield tuple(float(p.value) for p in derivation.parameters)
    yield (1.0,) * n
    yield tuple(rng.uniform(0.1, 3.0, n))
    yield tuple(10.0 ** rng.uniform(-3, 3, n))


def _different(sets: Iterable[tuple[float, ...]]) -> Iterator[tuple[float, ...]]:
    """The sets without repetitions: the example of an arm from a table has equal dimensions."""
    return iter(dict.fromkeys(sets))


def joint_samples(derivation: Derivation, function: Function, seed: int = 1) -> list[Sample]:
    """Inputs of a function of joint values (or of any free real numbers, or of a pose)."""
    rng = np.random.default_rng(seed)
    n = len(function.symbols)
    if n == 0:
        none = np.empty((1, 0))
        return [Sample("constant", none, p) for p in _different(parameter_sets(derivation, rng))]
    rows = {
        "home": np.zeros((1, n)),
        "random": rng.uniform(-np.pi, np.pi, (60, n)),
        "right angles": _approaches(rng, n, 40),
        "tiny": rng.choice(TINY, (8, n)) * rng.choice((-1, 1), (8, n)),
        "huge": rng.choice(HUGE, (24, n)) * rng.uniform(-1, 1, (24, n)),
    }
    if len(function.inputs) > 1:  # a pose and the joints that belong to it differ less in size
        lengths = Degrees([e for _, signs in function.cases() for e in function.values(signs)])
        sized = np.array([s in lengths.symbols for s in function.symbols])
        rows["huge"][:, sized] = rng.uniform(-np.pi, np.pi, (24, sized.sum()))
        small = rows["tiny"][:, sized]
        rows["tiny"][:, sized] = np.copysign(np.maximum(abs(small), TINY[2]), small)
    column = 0
    for argument in function.inputs:
        if argument.shape in ((3, 3), (4, 4)):
            made = _poses if argument.shape == (4, 4) else _rotations
            for values in rows.values():
                own = values[:, column : column + argument.size]
                own[:] = made(own[:, :6]).reshape(len(own), -1)
        column += argument.size
    return [
        Sample(
            name,
            values if name == "huge" else drawn_beside(derivation, function.symbols, values),
            parameters,
        )
        for parameters in _different(parameter_sets(derivation, rng))
        for name, values in rows.items()
    ]


def _rotations(values: Array) -> Array:
    """A rotation for each row, which begins with three angles about x, y and z."""
    turned = np.eye(3)
    for k, (i, j) in enumerate(((1, 2), (2, 0), (0, 1))):
        about = np.tile(np.eye(3), (len(values), 1, 1))
        about[:, i, i] = about[:, j, j] = np.cos(values[:, k])
        about[:, j, i] = np.sin(values[:, k])
        about[:, i, j] = -about[:, j, i]
        turned = turned @ about
    return np.asarray(turned)


def _poses(values: Array) -> Array:
    """A pose for each row of three angles about x, y and z, and a position."""
    poses = np.tile(np.eye(4), (len(values), 1, 1))
    poses[:, :3, :3], poses[:, :3, 3] = _rotations(values), values[:, 3:6]
    return poses


def inverse_postures(
    derivation: Derivation, unknowns: Sequence[sp.Symbol], seed: int = 2
) -> list[Sample]:
    """Joint values, including singular ones, whose images are the targets of an inverse."""
    rng = np.random.default_rng(seed)
    n = len(unknowns)
    rows = {
        "random": rng.uniform(-np.pi, np.pi, (60, n)),
        "right angles": _approaches(rng, n, 60),
        "one joint singular": _one_singular(rng, n),
    }
    return [
        Sample(name, drawn_beside(derivation, unknowns, values), parameters)
        for parameters in _different(parameter_sets(derivation, rng))
        for name, values in rows.items()
    ]


def drawn_beside(derivation: Derivation, symbols: Sequence[sp.Symbol], values: Array) -> Array:
    """Move each joint that stays close to another one near that joint."""
    values = values.copy()
    for joint in derivation.joints:
        if joint.twin_of is not None and joint.symbol in symbols:
            own, other = symbols.index(joint.symbol), symbols.index(joint.twin_of)
            for start, fraction in ((0, 8.0), (1, 32.0), (2, 512.0)):
                rows = values[start::3]
                values[start::3, own] = rows[:, other] + rows[:, own] / fraction
    return values


def perturbed(targets: Array, seed: int = 3) -> Array:
    """Targets moved by relative amounts down to an ulp, inwards and outwards over the boundary."""
    rng = np.random.default_rng(seed)
    steps = rng.choice((1e-16, 1e-14, 1e-9, 1e-3, 0.3), (len(targets), 1))
    return np.asarray(targets * (1 + steps * rng.choice((-1, 1), (len(targets), 1))))


def _approaches(rng: np.random.Generator, n: int, rows: int) -> Array:
    """Every joint at a multiple of a right angle, with a small or no deviation."""
    corners = rng.choice((-np.pi, -np.pi / 2, 0.0, np.pi / 2, np.pi), (rows, n))
    return np.asarray(corners + rng.choice(APPROACHES, (rows, n)) * rng.choice((-1, 1), (rows, n)))


def _one_singular(rng: np.random.Generator, n: int) -> Array:
    """All joints random except one, which approaches 0 or pi."""
    rows = []
    for joint in range(n):
        for corner in (0.0, np.pi, -np.pi):
            for approach in APPROACHES:
                row = rng.uniform(-np.pi, np.pi, n)
                row[joint] = corner - np.copysign(approach, corner) if corner else approach
                rows.append(row)
    return np.array(rows)


class Degrees:
    """Upper bounds for the degrees of expressions in lengths, and which symbols are lengths.

    A sine or a cosine has degree 0; the degree of a product is the sum over its factors.
    """

    def __init__(self, exprs: Sequence[sp.Expr]):
        self.symbols: set[sp.Basic] = set()
        self._known: dict[sp.Basic, float] = {}
        self.degrees = [self._of(sp.sympify(e, strict=True)) for e in exprs]

    def _of(self, e: sp.Basic) -> float:
        if e not in self._known:
            self._known[e] = self._computed(e)
        return self._known[e]

    def _computed(self, e: sp.Basic) -> float:
        if e.is_Symbol:
            self.symbols.add(e)
            return 1.0
        if isinstance(e, sp.Mul):
            return sum(map(self._of, e.args))
        if isinstance(e, sp.Pow) and e.exp.is_Number:
            return float(e.exp) * self._of(e.base)
        if isinstance(e, sp.Piecewise):
            return max(self._of(branch) for branch, _ in e.args)
        if isinstance(e, (sp.Add, sp.Abs, sp.Max, sp.Min)):
            return max(map(self._of, e.args))
        return 0.0


class Magnitudes:
    """The natural scales of values: all signs positive, sines and cosines at their largest.

    Divisors keep their value.  Each subexpression is visited once, because the full tree would be
    far too large.

    The expressions may contain ``names``, with a value each, which hold what cancels in a formula
    that is written out.
    """

    def __init__(
        self,
        symbols: Sequence[sp.Symbol],
        exprs: Sequence[sp.Expr],
        *,
        names: Mapping[sp.Symbol, sp.Expr] | None = None,
    ):
        self._names = names or {}
        self._written_out: dict[sp.Basic, sp.Expr] = {}
        for name, value in self._names.items():
            self._written_out[name] = substitute(value, self._written_out)
        self._places = {s: k for k, s in enumerate(symbols)}
        self._steps: list[Callable[[list[Any], Sequence[Any]], Any]] = []
        self._known: dict[sp.Basic, int] = {}
        self._divisors: list[sp.Expr] = []
        self._results = [self._place(sp.sympify(e, strict=True)) for e in exprs]
        self._evaluate = RowEvaluator(symbols, self._divisors)

    def __call__(self, rows: Array, dtype: type = float) -> Array:
        """A row for each point: infinite where the float type overflows, zero where undefined."""
        found = self._evaluate.settled(rows, inaccurate(bits=40), defined=False)
        with np.errstate(all="ignore"):
            given = list(abs(np.concatenate([rows, found], axis=1)).astype(dtype).T)
            done: list[Any] = []
            for step in self._steps:
                done.append(step(done, given))
            scales = [np.broadcast_to(done[k], len(rows)).astype(float) for k in self._results]
        shaped = np.stack(scales, axis=-1) if scales else np.empty((len(rows), 0))
        return np.where(np.isnan(shaped), 0.0, shaped)

    def _place(self, e: sp.Basic) -> int:
        if e not in self._known:
            step = self._step(e)
            self._steps.append(step)
            self._known[e] = len(self._steps) - 1
        return self._known[e]

    def _step(self, e: sp.Basic) -> Callable[[list[Any], Sequence[Any]], Any]:
        if e in self._names:
            value = self._place(self._names[e])
            return lambda done, given: done[value]
        if isinstance(e, (sp.sin, sp.cos)):
            return lambda done, given: 1.0
        if isinstance(e, (sp.atan2, sp.asin, sp.acos, sp.atan)):
            return lambda done, given: math.pi
        if e.is_Number or e.is_NumberSymbol:
            number = abs(float(e))
            return lambda done, given: number
        if e in self._places:
            place = self._places[e]
            return lambda done, given: given[place]
        if isinstance(e, (sp.Add, sp.Mul, sp.Max, sp.Min, sp.Piecewise, sp.Abs)):
            branches = [b for b, _ in e.args] if isinstance(e, sp.Piecewise) else e.args
            parts = [self._place(b) for b in branches]
            total = math.prod if isinstance(e, sp.Mul) else sum
            return lambda done, given: total(done[k] for k in parts)
        if isinstance(e, sp.Pow) and e.exp.is_Number and e.exp > 0:
            base, power = self._place(e.base), float(e.exp)
            return lambda done, given: np.power(done[base], power)
        place = self._evaluated(e)
        return lambda done, given: given[place]

    def _evaluated(self, e: sp.Expr) -> int:
        """The place of an expression that is evaluated."""
        self._divisors.append(substitute(e, self._written_out))
        return len(self._places) + len(self._divisors) - 1
