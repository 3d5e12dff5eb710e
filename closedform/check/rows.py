"""Ball arithmetic over arrays: many points at once, each value with a bound on its error.

The midpoints have the widest float type.  Where a ball is too wide to decide something, the point
is evaluated again in Arb, so no decision rests on a rounding error.  If the widest type is double,
Arb is needed more often: the results are the same, but slower.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property, partial, reduce
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.algebra.balls import Evaluator, Undetermined, to_float
from closedform.algebra.expressions import square_roots
from closedform.algebra.resolvent import Resolvent, cubic, slope
from closedform.algebra.scope import Case, Scope
from closedform.model.constant import Constant

Array = NDArray[Any]
WIDE = np.longdouble
Ball: TypeAlias = "tuple[Any, Any]"  # midpoints and radii
Truth: TypeAlias = "tuple[Any, Any]"  # whether a condition holds, and whether that is certain

ROUNDING = WIDE(np.finfo(WIDE).eps)
"""Twice the error of a correctly rounded operation, which also covers those of the radii."""
LIBRARY = 16 * ROUNDING
"""The same for sines, cosines and arctangents, of which libm documents errors of three units."""
LEAST = np.sqrt(WIDE(np.finfo(WIDE).tiny))
"""Below this size, rounding errors are no longer relative."""
OPEN = WIDE("inf")
EXACT = WIDE(0)
"""The radius of what is exact, recognised by identity: it needs no terms in other radii."""
KEPT_BATCHES, TOGETHER = 4096, 1024
"""How many results are kept, and how many points are evaluated together at most."""


class RowEvaluator:
    """Expressions at many points: fast, with bounds on the errors, and in Arb on request.

    They are evaluated in each of the ``cases``, one after the other, as those of an ``Evaluator``.
    The ``steady`` symbols, such as lengths, have one value at most points of a batch.
    """

    def __init__(
        self,
        symbols: Iterable[sp.Symbol],
        exprs: Iterable[Any],
        named: Mapping[sp.Symbol, Any] | None = None,
        cases: Sequence[Case] = ({},),
        *,
        steady: Iterable[sp.Symbol] = (),
    ) -> None:
        self.symbols = tuple(symbols)
        self.exprs = tuple(sp.sympify(e, strict=True) for e in exprs)
        self._named, self._cases = dict(named or {}), tuple(cases)
        self._steady = frozenset(steady)
        self._exact: dict[tuple[Any, ...], list[Any] | str] = {}
        """The Arb balls at each point so far, or the reason why there are none."""

    @cached_property
    def _program(self) -> _Program:
        return _Program(self.symbols, self.exprs, self._named, self._cases, self._steady)

    @cached_property
    def _evaluator(self) -> Evaluator:
        return Evaluator(self.symbols, self.exprs, named=self._named, cases=self._cases)

    def exactly(self, row: Iterable[float], wanted: Iterable[int] | None = None) -> list[Any]:
        """The Arb balls at one point: of all expressions, or of those that are wanted."""
        point = tuple(map(float, row))
        chosen = None if wanted is None else tuple(map(int, wanted))
        key = point, chosen
        if key not in self._exact:
            try:
                self._exact[key] = self._evaluator(point, chosen)
            except Undetermined as error:
                self._exact[key] = str(error)
        found = self._exact[key]
        if isinstance(found, str):
            raise Undetermined(found)
        return found

    def alone(self, row: Sequence[float]) -> float:
        """The first value at one point, by Arb; NaN where it cannot decide."""
        try:
            return to_float(self.exactly(row)[0])
        except Undetermined:
            return math.nan

    def balls(self, rows: Array) -> tuple[Array, Array]:
        """Midpoints and radii, one row for each point; a radius that is not finite leaves all open.

        Do not write to the arrays: the last result is kept for the next back end.
        """
        rows = np.asarray(rows)
        found: tuple[Array, Array] = _BALLS.find(self, rows, self._balls)
        return found

    def prepare(self, batches: Iterable[Array]) -> None:
        """Evaluate the balls of many batches together, which takes hardly longer than for one."""
        new = [rows for rows in map(np.asarray, batches) if not _BALLS.knows(self, rows)]
        while new:
            part, total = [new.pop(0)], 0
            while new and (total := total + len(part[-1])) + len(new[0]) <= TOGETHER:
                part.append(new.pop(0))
            found = self._balls(np.concatenate(part))
            ends = np.cumsum([len(rows) for rows in part])[:-1]
            for rows, *balls in zip(part, *(np.split(x, ends) for x in found), strict=True):
                _BALLS.put(self, rows, tuple(balls))

    def _balls(self, rows: Array) -> tuple[Array, Array]:
        shape = (len(rows), len(self._program.results))
        middle, radius = np.empty(shape, WIDE), np.empty(shape, WIDE)
        with np.errstate(all="ignore"):
            for k, (x, r) in enumerate(self._program.run(rows)):
                middle[:, k], radius[:, k] = x, r
        radius[~(np.isfinite(middle) & np.isfinite(radius))] = OPEN
        middle.flags.writeable = radius.flags.writeable = False
        return middle, radius

    def open_around(self, rows: Array, share: float) -> Array:
        """Where nothing bounds a value if each input may be off by a ``share`` of itself."""
        with np.errstate(all="ignore"):
            balls = self._program.run(np.asarray(rows), share)
            known = [np.isfinite(x + r) + np.zeros(len(rows), bool) for x, r in balls]
        return ~np.stack(known, axis=1)

    def values(self, rows: Array) -> Array:
        """The midpoints alone, to choose points with; do not decide anything by them.

        They take a quarter of the time of the balls, and are kept like these.
        """
        rows = np.asarray(rows)
        return np.asarray(_VALUES.find(self, rows, self._values))

    def _values(self, rows: Array) -> Array:
        middle = np.empty((len(rows), len(self._program.results)), WIDE)
        with np.errstate(all="ignore"):
            for k, x in enumerate(self._program.middles(rows)):
                middle[:, k] = x
        middle.flags.writeable = False
        return middle

    def settled(
        self, rows: Array, undecided: Callable[[Array, Array], Array], *, defined: bool = True
    ) -> Array:
        """The values; rows for which ``undecided(middle, radius)`` holds are evaluated in Arb.

        Unless they must be ``defined`` everywhere, a row that Arb cannot decide is NaN.
        """
        middle, radius = self.balls(rows)
        middle = middle.copy()
        for row in np.flatnonzero(undecided(middle, radius).any(axis=1)):
            try:
                middle[row] = [to_float(b) for b in self.exactly(rows[row])]
            except Undetermined:
                if defined:
                    raise
                middle[row] = np.nan
        return middle


class _Kept:
    """Results for batches of points, kept because all back ends of a robot use the same points."""

    def __init__(self) -> None:
        self._known: OrderedDict[tuple[Any, ...], Any] = OrderedDict()

    def find(self, evaluator: RowEvaluator, rows: Array, make: Callable[[Array], Any]) -> Any:
        if not self.knows(evaluator, rows):
            self.put(evaluator, rows, make(rows))
        key = _key(evaluator, rows)
        self._known.move_to_end(key)
        return self._known[key]

    def knows(self, evaluator: RowEvaluator, rows: Array) -> bool:
        return _key(evaluator, rows) in self._known

    def put(self, evaluator: RowEvaluator, rows: Array, found: Any) -> None:
        self._known[_key(evaluator, rows)] = found
        while len(self._known) > KEPT_BATCHES:
            self._known.popitem(last=False)


def _key(evaluator: RowEvaluator, rows: Array) -> tuple[Any, ...]:
    return evaluator, rows.tobytes(), rows.shape, rows.dtype.str


_BALLS, _VALUES = _Kept(), _Kept()


def crosses(*limits: float) -> Callable[[Array, Array], Array]:
    """A test for values that may be on either side of one of the limits."""

    def undecided(middle: Array, radius: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.asarray(~np.logical_and.reduce([abs(middle - x) > radius for x in limits]))

    return undecided


def inaccurate(bits: int) -> Callable[[Array, Array], Array]:
    """A test for values with fewer significant bits."""

    def undecided(middle: Array, radius: Array) -> Array:
        return np.asarray(~(radius <= abs(middle) * 2.0**-bits))

    return undecided


class _Step(NamedTuple):
    """An operation on midpoints alone, and the same on balls."""

    middle: Callable[..., Any]
    ball: Callable[..., Any]


class _Program:
    """One step for each distinct subexpression, over lists of the values so far."""

    def __init__(
        self,
        symbols: Sequence[sp.Symbol],
        exprs: Sequence[Any],
        named: Mapping[sp.Symbol, Any],
        cases: Sequence[Case],
        steady: frozenset[sp.Symbol],
    ) -> None:
        self._scope = Scope(named, cases)
        self._varies = [s not in steady for s in symbols]
        """Whether each value depends on more than steady symbols."""
        self._steps: list[tuple[_Step, tuple[int, ...]]] = []
        self._places: dict[Any, int] = {s: k for k, s in enumerate(symbols)}
        self.results: list[int] = []
        for case in cases:
            self._scope.enter(case)
            for name, value in (*case.items(), *named.items()):
                if (key := self._scope.key(name)) not in self._places:
                    self._places[key] = self._place(sp.sympify(value, strict=True))
            self.results += [self._place(e) for e in exprs]

    def run(self, rows: Array, share: float = 0.0) -> list[Any]:
        """The balls at rows of inputs, each of which may be off by a ``share`` of itself."""
        known: list[Any] = []
        for x in _columns(rows):
            exact = share == 0 and bool(np.isfinite(x).all())
            known.append((x, EXACT if exact else abs(x) * WIDE(share)))
        for step, operands in self._steps:
            known.append(step.ball(*[known[k] for k in operands]))
        return [known[k] for k in self.results]

    def middles(self, rows: Array) -> list[Any]:
        """The midpoints that :meth:`run` finds, without their radii."""
        known: list[Any] = _columns(rows)
        for step, operands in self._steps:
            known.append(step.middle(*[known[k] for k in operands]))
        return [known[k] for k in self.results]

    def _place(self, e: Any) -> int:
        key = self._scope.key(e)
        if key not in self._places:
            if isinstance(e, sp.Mul):
                self._places[key] = self._product([self._place(a) for a in e.args])
            else:
                step, operands = self._step(e)
                self._places[key] = self._add(step, tuple(map(self._place, operands)))
        return self._places[key]

    def _add(self, step: _Step, operands: tuple[int, ...]) -> int:
        self._steps.append((step, operands))
        self._varies.append(any(self._varies[k] for k in operands))
        return len(self._varies) - 1

    def _product(self, factors: Sequence[int]) -> int:
        """Of two products, that of steady factors and the other; many terms have one in common."""
        steady, varying = (
            [k for k in sorted(factors) if self._varies[k] == varies] for varies in (False, True)
        )
        halves = [reduce(self._times, half) for half in (steady, varying) if half]
        return reduce(self._times, halves)

    def _times(self, a: int, b: int) -> int:
        key = "product", a, b
        if key not in self._places:
            self._places[key] = self._add(_FUNCTIONS[sp.Mul], (a, b))
        return self._places[key]

    def _step(self, e: Any) -> tuple[_Step, Sequence[Any]]:
        if isinstance(e, Constant):
            e = e.value
        if constant := _constant_of(e):
            return constant, ()
        if e.is_Pow:
            return _power(e), [e.base]
        if isinstance(e, sp.Piecewise):
            return _CHOICE, [part for branch in e.args for part in branch]
        if isinstance(e, sp.cot | sp.sec | sp.csc):
            return _INVERTED, [_RECIPROCAL[e.func](e.args[0])]
        step = next((f for kind, f in _FUNCTIONS.items() if isinstance(e, kind)), None)
        if step is None:
            raise TypeError(f"cannot evaluate {e}: it is of type {type(e).__name__}")
        return step, e.args


def _columns(rows: Array) -> list[Any]:
    """The columns without negative zeros; of one that is constant, such as a length, its value.

    What depends on lengths alone is then computed once, not at each point.
    """
    columns = np.asarray(rows, WIDE).T + WIDE(0)
    return [x[0] if len(x) > 1 and (x == x[0]).all() else x for x in columns]


def _constant(value: Any, certainty: Any) -> _Step:
    return _Step(lambda: value, lambda: (value, certainty))


def _constant_of(e: Any) -> _Step | None:
    """The step of a number or of a truth value; None for anything else."""
    if e.is_Rational:
        number = WIDE(int(e.p)) / WIDE(int(e.q))
        exact = e.q == 1 and abs(int(e.p)) < 2**53
        return _constant(number, EXACT if exact else 2 * abs(number) * ROUNDING)
    if e is sp.pi:
        return _constant(4 * np.arctan(WIDE(1)), 4 * LIBRARY)
    if e is sp.nan or e is sp.zoo:  # a case that a flag always excludes, such as 1/0
        return _constant(WIDE("nan"), WIDE("nan"))
    if e in (sp.true, sp.false):
        return _constant(bool(e), True)
    return None


def _folded(function: Callable[[Any, Any], Any]) -> Callable[..., Any]:
    """A function of any number of values, applied to two at a time."""
    return lambda *values: reduce(function, values)


def _rounded(value: Any, radius: Any, error: Any = ROUNDING) -> Ball:
    return value, radius + np.fabs(value) * error


def _sum(*terms: Ball) -> Ball:
    def add(a: Ball, b: Ball) -> Ball:
        (x, r), (y, s) = a, b
        return _rounded(x + y, s if r is EXACT else r if s is EXACT else r + s)

    return reduce(add, terms)


def _product(*factors: Ball) -> Ball:
    return reduce(_times, factors)


def _times(a: Ball, b: Ball) -> Ball:
    (x, r), (y, s) = a, b
    value = x * y
    if r is EXACT and isinstance(x, np.floating) and abs(x) in (1, 2, 4):
        return value, s if s is EXACT else abs(x) * s
    size = np.fabs(value)
    radius = size * ROUNDING
    if s is not EXACT:
        radius = radius + np.fabs(x) * s
    if r is not EXACT:
        radius = radius + (np.fabs(y) + s) * r
    small = size < LEAST
    if np.count_nonzero(small):
        radius = np.where(small & (x != 0) & (y != 0), OPEN, radius)
    return value, radius


def _reciprocal(a: Ball) -> Ball:
    x, r = a
    size = abs(x)
    value = 1 / x
    radius = r / (size * (size - r))
    return _rounded(value, np.where(size > r, radius, OPEN))


def _root(a: Ball) -> Ball:
    x, r = a
    value = np.sqrt(x)
    radius = np.where(r > 0, r / np.sqrt(x - r), 0)
    return _rounded(value, np.where((x > r) | ((x == 0) & (r == 0)), radius, OPEN))


def _power(e: Any) -> _Step:
    """The power with the constant exponent of `e`; roots of roots are one power in SymPy."""
    roots = square_roots(e)
    times, inverted = abs(int(e.exp.p)), e.exp < 0

    def middle(x: Any) -> Any:
        base = reduce(lambda y, _: np.sqrt(y), range(roots), x)
        return reduce(np.multiply, [1 / base if inverted else base] * times)

    def ball(a: Ball) -> Ball:
        base = reduce(lambda b, _: _root(b), range(roots), a)
        if inverted:
            base = _reciprocal(base)
        return reduce(_times, [base] * times)

    return _Step(middle, ball)


def _periodic(function: Callable[[Any], Any]) -> _Step:
    """A sine or a cosine; open if the angle is."""

    def bounded(a: Ball) -> Ball:
        x, r = a
        return _rounded(function(x), np.where(r < 1, r, OPEN), LIBRARY)

    return _Step(function, bounded)


def _tangent(x: Any) -> Any:
    return np.sin(x) * (1 / np.cos(x))


def _tangent_ball(a: Ball) -> Ball:
    return _times(_periodic(np.sin).ball(a), _reciprocal(_periodic(np.cos).ball(a)))


def _monotone(function: Callable[[Any], Any]) -> _Step:
    """A monotone function; NaN, and so open, where the ball reaches beyond the domain."""

    def bounded(a: Ball) -> Ball:
        x, r = a
        value, ends = function(x), (function(x - r), function(x + r))
        errors = [abs(end - value) + LIBRARY * (abs(end) + abs(value)) for end in ends]
        return value, np.where(np.isfinite(r), np.maximum(*errors), OPEN)

    return _Step(function, bounded)


def _angle(y: Any, x: Any) -> Any:
    return np.arctan2(y + WIDE(0), x)


def _direction(a: Ball, b: Ball) -> Ball:
    """The angle of a point in the plane, unless its ball touches the cut or the origin."""
    (y, s), (x, r) = a, b
    distance, off = np.hypot(x, y) * (1 - ROUNDING), np.hypot(r, s) * (1 + ROUNDING)
    radius = np.where(off > 0, off / (distance - off), 0)
    certain = (distance > off) & (distance > LEAST) & ((x > r) | (abs(y) > s) | (s == 0))
    return _rounded(_angle(y, x), np.where(certain, radius, OPEN), LIBRARY)


def _absolute(a: Ball) -> Ball:
    return abs(a[0]), a[1]


def _sign(a: Ball) -> Ball:
    x, r = a
    return np.sign(x), np.where((abs(x) > r) | (r == 0), WIDE(0), OPEN)


def _extreme(choose: Callable[[Any, Any], Any]) -> _Step:
    def extreme(*balls: Ball) -> Ball:
        def further(a: Ball, b: Ball) -> Ball:
            return choose(a[0], b[0]), np.maximum(a[1], b[1])

        return reduce(further, balls)

    return _Step(_folded(choose), extreme)


def _comparison(holds: Callable[[Any, Any], Any]) -> _Step:
    """A comparison; it is certain where the balls do not overlap, or are points."""

    def compare(a: Ball, b: Ball) -> Truth:
        (x, r), (y, s) = a, b
        disjoint = abs(x - y) * (1 - ROUNDING) > r + s
        known = np.isfinite(x) & np.isfinite(y)
        return holds(x, y), known & (disjoint | ((r == 0) & (s == 0)))

    return _Step(holds, compare)


def _not(a: Truth) -> Truth:
    return np.logical_not(a[0]), a[1]


def _combined(decisive: bool) -> _Step:
    """A conjunction or disjunction: one True decides ``Or``, one False decides ``And``."""
    join = np.logical_or if decisive else np.logical_and

    def combine(*truths: Truth) -> Truth:
        value = reduce(join, [t for t, _ in truths])
        settled = reduce(np.logical_or, [c & (t == decisive) for t, c in truths])
        return value, settled | reduce(np.logical_and, [c for _, c in truths])

    return _Step(_folded(join), combine)


def _resolvent(*point: Any) -> Any:
    """The root of a resolvent, by Newton's method and bisection."""
    right = cubic(point[2] / 3, *point) >= 0
    u = np.where(right, WIDE(1), WIDE(-1))
    low, high = np.full_like(u, -1), np.full_like(u, 1)
    for _ in range(2 * np.finfo(WIDE).nmant):
        value = cubic(u, *point)
        low, high = np.where(value >= 0, u, low), np.where(value >= 0, high, u)
        after = u - value / slope(u, *point)
        after = np.where((after >= low) & (after <= high), after, (low + high) / 2)
        still, u = ~(np.abs(after - u) > 2 * np.finfo(WIDE).eps * np.abs(u)), after
        if still.all():
            break
    return u


def _resolvent_ball(a: Ball, b: Ball, e: Ball) -> Ball:
    """It is open unless the cubic provably changes its sign around it."""
    point = a[0], b[0], e[0]
    u = _resolvent(*point)
    (value, error), rate = _cubic((u, WIDE(0)), a, b, e), abs(slope(u, *point))
    radius = 4 * (abs(value) + error) / rate + ROUNDING
    (above, s), (below, r) = (_cubic((u + d, WIDE(0)), a, b, e) for d in (-radius, radius))
    certain = ((above > s) | (u - radius <= -1)) & ((below < -r) | (u + radius >= 1))
    return u, np.where(certain, radius, OPEN)


def _cubic(u: Ball, a: Ball, b: Ball, e: Ball) -> Ball:
    one: Ball = WIDE(1), WIDE(0)
    left, right = _sum(one, _minus(u)), _sum(one, u)
    middle = _product(left, right, _sum(u, _minus(e)))
    return _sum(middle, _product(a, a, left), _minus(_product(b, b, right)))


def _minus(a: Ball) -> Ball:
    return -a[0], a[1]


def _chosen(*parts: Any) -> Any:
    """The branch of the first condition that holds."""
    middle: Any = WIDE("nan")
    for x, holds in reversed(list(zip(parts[::2], parts[1::2], strict=True))):
        middle = np.where(holds, x, middle)
    return middle


def _chosen_ball(*parts: Any) -> Ball:
    middle: Any = WIDE("nan")
    radius: Any = OPEN
    for (x, r), (holds, certain) in reversed(list(zip(parts[::2], parts[1::2], strict=True))):
        middle = np.where(holds, x, middle)
        radius = np.where(certain, np.where(holds, r, radius), OPEN)
    return middle, radius


_FUNCTIONS: dict[Any, _Step] = {
    sp.Add: _Step(_folded(np.add), _sum),
    sp.Mul: _Step(_folded(np.multiply), _product),
    sp.sin: _periodic(np.sin),
    sp.cos: _periodic(np.cos),
    sp.tan: _Step(_tangent, _tangent_ball),
    sp.atan: _monotone(np.arctan),
    sp.asin: _monotone(np.arcsin),
    sp.acos: _monotone(np.arccos),
    sp.atan2: _Step(_angle, _direction),
    sp.Abs: _Step(np.abs, _absolute),
    sp.sign: _Step(np.sign, _sign),
    sp.Max: _extreme(np.maximum),
    sp.Min: _extreme(np.minimum),
    Resolvent: _Step(_resolvent, _resolvent_ball),
    sp.Ge: _comparison(np.greater_equal),
    sp.Gt: _comparison(np.greater),
    sp.Le: _comparison(np.less_equal),
    sp.Lt: _comparison(np.less),
    sp.Eq: _comparison(np.equal),
    sp.Ne: _comparison(np.not_equal),
    sp.Not: _Step(np.logical_not, _not),
    sp.And: _combined(False),
    sp.Or: _combined(True),
}
_CHOICE = _Step(_chosen, _chosen_ball)
_INVERTED = _Step(partial(np.divide, WIDE(1)), _reciprocal)
_RECIPROCAL = {sp.cot: sp.tan, sp.sec: sp.cos, sp.csc: sp.sin}

__all__ = ["RowEvaluator", "crosses", "inaccurate"]
