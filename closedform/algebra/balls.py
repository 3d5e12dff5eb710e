"""Rigorous evaluation of symbolic expressions in ball arithmetic (Arb).

`Evaluator` compiles expressions once to steps over numbered registers, one step for each distinct
sub-expression, and runs them at any number of points. A float has its exact binary value. The
precision doubles until every enclosure is tight relative to the terms of its sum, so a sum that
cancels to zero is also tight.

Values that are multiples of `pi` stay exact in sines and cosines: `sin(theta)` at `pi` is 0, and
`atan2(sin(theta), -1)` is `pi`, not a ball across the branch cut. A comparison with an undefined
value is false, as in IEEE arithmetic.
"""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from typing import Any, TypeAlias

import flint
import sympy as sp
from flint import arb, fmpq
from sympy import Symbol

from closedform.algebra.expressions import square_roots
from closedform.algebra.resolvent import Resolvent, enclosed
from closedform.algebra.scope import Case, Scope
from closedform.model.constant import Constant
from closedform.model.expressions import free_symbols

Expr: TypeAlias = Any  # SymPy's annotations are partial
Value: TypeAlias = Any  # int, Fraction, float, or an exact SymPy number such as pi/3
Registers: TypeAlias = "list[arb]"
Step: TypeAlias = "tuple[int, Callable[..., arb], tuple[int, ...] | None]"
Compare: TypeAlias = "Callable[[arb, arb], bool | None]"
Test: TypeAlias = "Callable[[Registers], bool | None]"

_SPARE_BITS = 40
_UNDEFINED = arb("nan")  # compared by identity: a ball that is too wide is nan as well


class Undetermined(ArithmeticError):  # noqa: N818
    """A comparison, a branch or a value is not decided at the highest precision."""


class _Undefined(Exception):  # noqa: N818
    """The value provably does not exist."""


class _Open(Exception):  # noqa: N818
    """A comparison is not decided at this precision."""


def evaluate(
    exprs: Iterable[Expr],
    values: Mapping[Symbol, Value],
    rel_bits: int = 80,
    max_bits: int = 4000,
) -> list[arb]:
    """Enclosures of the expressions at one point; see `Evaluator`."""
    return Evaluator(tuple(values), exprs, rel_bits, max_bits)(values)


class Evaluator:
    """Enclosures of fixed expressions at many points.

    Every returned ball has radius at most `2**-rel_bits` times the larger of its midpoint and its
    natural scale (for a sum, the sum of the absolute values of the terms). An entry that is
    provably undefined at a point (a square root of a negative number, a division by zero,
    `atan2(0, 0)`) is the ball `nan`. `Undetermined` is raised if `max_bits` are not enough to
    decide. A radicand that cannot be distinguished from zero is taken to be nonnegative.

    The expressions may contain the names in `named`, which stand for their values; the name of a
    condition stands for its truth value.  They are evaluated in each of the `cases`, one after the
    other; a case gives integer values to more symbols.

    Parameters
    ----------
    symbols
        what gets values
    exprs
        what is evaluated
    rel_bits
        the relative accuracy of a result
    max_bits
        the highest precision that is tried
    named
        the values that names in the expressions stand for
    cases
        the integer values of more symbols, in each case
    """

    def __init__(
        self,
        symbols: Iterable[Symbol],
        exprs: Iterable[Expr],
        rel_bits: int = 80,
        max_bits: int = 4000,
        *,
        named: Mapping[Symbol, Expr] | None = None,
        cases: Sequence[Case] = ({},),
    ) -> None:
        self.symbols = tuple(symbols)
        self.exprs = tuple(sp.sympify(e, strict=True) for e in exprs)
        self.rel_bits, self.max_bits = rel_bits, max_bits
        named = {name: sp.sympify(value, strict=True) for name, value in (named or {}).items()}
        known = {*self.symbols, *named, *(s for case in cases for s in case)}
        missing = free_symbols((*self.exprs, *named.values())) - known
        if missing:
            raise KeyError(f"no value for {', '.join(sorted(map(str, missing)))}")
        self._program = _Program(self.symbols, self.exprs, named, cases)

    def __call__(
        self,
        values: Mapping[Symbol, Value] | Sequence[Value],
        wanted: Sequence[int] | None = None,
    ) -> list[arb]:
        """Enclosures at a point, given by symbol or in the order of `symbols`.

        With ``wanted``, only these expressions have to be tight, and only they are returned.
        """
        if isinstance(values, Mapping):
            values = [values[s] for s in self.symbols]
        if len(values) != len(self.symbols):
            raise ValueError(f"{len(self.symbols)} values expected, {len(values)} given")
        point = [_Point(v) for v in values]
        chosen = range(len(self._program.outputs)) if wanted is None else wanted
        # the sine of a large angle needs the digits before its binary point as well
        bits = self.rel_bits + _SPARE_BITS
        bits = min(bits + max((p.digits for p in point), default=0), self.max_bits)
        while True:
            with flint.ctx.workprec(bits):
                try:
                    registers = self._program.run(point)
                    balls = [registers[self._program.outputs[k]] for k in chosen]
                    if self._are_tight(balls, registers, chosen):
                        return balls
                    obstacle = "a value is not accurate enough"
                except _Open as reason:
                    obstacle = "".join(map(str, reason.args))
            if bits == self.max_bits:
                break
            bits = min(2 * bits, self.max_bits)
        at = ", ".join(f"{s} = {v}" for s, v in zip(self.symbols, values, strict=True))
        raise Undetermined(f"{obstacle} at {self.max_bits} bits; the point is {at}")

    def _are_tight(self, balls: Sequence[arb], registers: Registers, chosen: Sequence[int]) -> bool:
        wide = [
            (k, ball)
            for k, ball in zip(chosen, balls, strict=True)
            if ball is not _UNDEFINED and ball.rel_accuracy_bits() < self.rel_bits
        ]
        if not wide:
            return True
        if not all(ball.is_finite() for _, ball in wide):
            return False
        scales, part = self._program.scales(registers), arb(2) ** -self.rel_bits
        return all(ball.rad() <= scales[k] * part for k, ball in wide)


def to_float(ball: arb) -> float:
    """The double nearest to the midpoint."""
    if not ball.is_finite():
        return math.nan
    mantissa, exponent = map(int, ball.mid().man_exp())
    bits = mantissa.bit_length()
    if bits < 1000 and -1000 < bits + exponent < 1000:  # a normal number: rounded once
        return math.ldexp(float(mantissa), exponent)
    try:  # a quotient of integers is rounded once, also to a number that is not normal
        return mantissa / (1 << -exponent) if exponent < 0 else float(mantissa << exponent)
    except OverflowError:
        return math.inf if mantissa > 0 else -math.inf


class _Point:
    """One exact value: its ball at the current precision, and its multiple of pi if rational."""

    def __init__(self, value: Value) -> None:
        self.turns: fmpq | None = None
        self.digits = 0
        """The number of binary digits before the point."""
        self._program: _Program | None = None
        self._ball: arb | None = None
        if isinstance(value, float) and math.isfinite(value):
            self._ball = arb(value)
            self.digits = max(0, math.frexp(value)[1])
            if not value:
                self.turns = fmpq(0)
            return
        if isinstance(value, sp.Expr) and not value.is_Float and not value.is_Rational:
            self._program = _Program((), (value,), {})
            multiple = value / sp.pi
            if multiple.is_Rational:
                self.turns = fmpq(int(multiple.p), int(multiple.q))
            return
        exact = _fraction(value)
        self._value = fmpq(exact.numerator, exact.denominator)
        if not exact:
            self.turns = fmpq(0)

    def ball(self) -> arb:
        if self._ball is not None:
            return self._ball
        if self._program is None:
            return arb(self._value)
        return self._program.run([])[self._program.outputs[0]]


def _fraction(value: Value) -> Fraction:
    exact = sp.Rational(value) if isinstance(value, sp.Expr) else Fraction(value)
    return Fraction(int(exact.numerator), int(exact.denominator))


class _Program:
    """Straight-line code; a case of a `Piecewise` is a block that runs only if it is chosen."""

    def __init__(
        self,
        symbols: Sequence[Symbol],
        exprs: Sequence[Expr],
        named: Mapping[Symbol, Expr],
        cases: Sequence[Case] = ({},),
    ) -> None:
        self._scope = Scope(named, cases)
        self._symbols = {s: i for i, s in enumerate(symbols)}
        self._size = len(symbols)
        self._turns: list[fmpq | None] | None = None
        self._block: list[Step] = []
        self._register: dict[Any, int] = dict(self._symbols)
        self._constants: list[Step] = []
        self._initial: dict[int, Registers] = {}
        self._truths: dict[Any, Test] = {}
        self._scale_steps: list[Callable[[Registers, Registers], arb]] = []
        self._scaled: dict[Any, int] = {}
        outputs, scales = list[int](), list[int]()
        for case in cases:
            self._scope.enter(case)
            for sign, value in case.items():
                self._register[self._scope.key(sign)] = self._compile(sp.Integer(value))
            for name, value in named.items():
                self._name(self._scope.key(name), value)
            outputs += map(self._compile, exprs)
            scales += map(self._scale, exprs)
        self.outputs, self._scales = tuple(outputs), tuple(scales)

    def _name(self, name: Any, value: Expr) -> None:
        """Let a name stand for its value in this case, unless it has this value already."""
        if isinstance(value, sp.logic.boolalg.Boolean) and not value.is_Symbol:
            if name not in self._truths:
                self._truths[name] = self._test(value)
        elif name not in self._register:
            self._register[name] = self._compile(value)
            self._scaled[name] = self._scale(value)

    def run(self, point: Sequence[_Point]) -> Registers:
        """All registers at a point, at the current precision."""
        bits = flint.ctx.prec
        if bits not in self._initial:
            self._initial[bits] = [arb(0)] * self._size
            _execute(self._constants, self._initial[bits])
        registers = self._initial[bits].copy()
        registers[: len(point)] = [p.ball() for p in point]
        turned = any(p.turns for p in point)
        self._turns = [p.turns for p in point] if turned else None
        _execute(self._block, registers)
        return registers

    def scales(self, registers: Registers) -> list[arb]:
        """The sizes of the terms of the outputs; the width of a ball is compared with them."""
        sizes: Registers = []
        for step in self._scale_steps:
            sizes.append(step(registers, sizes))
        return [sizes[k] for k in self._scales]

    def _scale(self, e: Expr) -> int:
        key = self._scope.key(e)
        if key not in self._scaled:
            step = self._scale_step(e)
            self._scale_steps.append(step)
            self._scaled[key] = len(self._scale_steps) - 1
        return self._scaled[key]

    def _scale_step(self, e: Expr) -> Callable[[Registers, Registers], arb]:
        if e.is_Add or e.is_Mul:
            join, parts = operator.add if e.is_Add else operator.mul, [*map(self._scale, e.args)]
            return lambda registers, sizes: reduce(join, (sizes[k] for k in parts))
        if e.is_Pow and e.exp.is_positive:
            base, power = self._scale(e.base), fmpq(int(e.exp.p), int(e.exp.q))
            return lambda registers, sizes: sizes[base] ** power
        place, least = self._register[self._scope.key(e)], 0 if e.is_Atom or e.is_Pow else 1
        return lambda registers, sizes: registers[place].abs_upper().max(arb(least))

    # Compilation

    def _compile(self, e: Expr) -> int:
        key = self._scope.key(e)
        known = self._register.get(key)
        if known is None:
            known = self._register[key] = self._emit(e)
        return known

    def _step(self, function: Callable[..., arb], args: Iterable[int] | None) -> int:
        self._size += 1
        operands = None if args is None else tuple(args)
        self._block.append((self._size - 1, function, operands))
        return self._size - 1

    def _emit(self, e: Expr) -> int:
        if isinstance(e, Constant):
            e = e.value
        if e.is_Rational:
            return self._constant(lambda: arb(fmpq(int(e.p), int(e.q))))
        if e is sp.pi:
            return self._constant(arb.pi)
        if e is sp.nan or e is sp.zoo:  # a case that a flag always excludes, such as 1/0
            return self._constant(lambda: arb("nan"))
        if e.is_Pow:
            return self._step(_power(e), [self._compile(e.base)])
        if isinstance(e, sp.sin | sp.cos | sp.tan):
            return self._trigonometric(e)
        if isinstance(e, sp.cot | sp.sec | sp.csc):
            return self._compile(1 / _RECIPROCAL[e.func](e.args[0]))
        if isinstance(e, sp.Piecewise):
            return self._piecewise(e)
        function = next((f for kind, f in _FUNCTIONS.items() if isinstance(e, kind)), None)
        if function is None:
            kind = "a float" if e.is_Float else f"of type {type(e).__name__}"
            raise TypeError(f"cannot evaluate {e}: it is {kind}")
        return self._step(function, [self._compile(a) for a in e.args])

    def _constant(self, function: Callable[[], arb]) -> int:
        self._size += 1
        self._constants.append((self._size - 1, function, ()))
        return self._size - 1

    def _trigonometric(self, e: Expr) -> int:
        plain, of_turns = _TRIGONOMETRIC[e.func]
        register = self._compile(e.args[0])
        terms = e.args[0].as_coefficients_dict()
        if not all(atom in self._symbols or atom is sp.pi for atom in terms):
            return self._step(plain, [register])
        multiples = {atom: fmpq(int(q.p), int(q.q)) for atom, q in terms.items()}
        half_turn = multiples.pop(sp.pi, fmpq(0))
        angles = [(self._symbols[atom], q) for atom, q in multiples.items()]

        def exact_or_plain(registers: Registers) -> arb:
            if self._turns is None:
                return plain(registers[register])
            products = [q * t for i, q in angles if (t := self._turns[i]) is not None]
            if len(products) < len(angles):
                return plain(registers[register])
            return of_turns(sum(products, half_turn))

        return self._step(exact_or_plain, None)

    def _piecewise(self, e: Expr) -> int:
        arms = [(self._test(condition), *self._branch(value)) for value, condition in e.args]

        def choose(registers: Registers) -> arb:
            for test, block, result in arms:
                holds = test(registers)
                if holds is None:
                    raise _Open("a condition of ", e, " is not decided")
                if holds:
                    _execute(block, registers)
                    return registers[result]
            raise _Undefined

        return self._step(choose, None)

    def _branch(self, e: Expr) -> tuple[list[Step], int]:
        """The steps that only this case needs; their results are not available outside."""
        outer, known = self._block, self._register.copy()
        self._block = []
        result = self._compile(e)
        block, self._block, self._register = self._block, outer, known
        return block, result

    def _test(self, condition: Any) -> Test:
        if condition.is_Relational:
            left, right = self._compile(condition.lhs), self._compile(condition.rhs)
            compare = _COMPARISONS[condition.rel_op]
            return lambda registers: compare(registers[left], registers[right])
        if (name := self._scope.key(condition)) in self._truths:
            return self._truths[name]
        if condition in (sp.true, sp.false):
            truth = bool(condition)
            return lambda registers: truth
        parts = [self._test(part) for part in condition.args]
        if isinstance(condition, sp.Not):
            return lambda registers: _not(parts[0](registers))
        if isinstance(condition, sp.And | sp.Or):
            decisive = isinstance(condition, sp.Or)
            return lambda registers: _combine(decisive, [part(registers) for part in parts])
        raise TypeError(f"cannot evaluate the condition {condition}")


def _execute(block: Sequence[Step], registers: Registers) -> None:
    for target, function, args in block:
        try:
            if args is None:
                registers[target] = function(registers)
                continue
            operands = [registers[i] for i in args]
            for x in operands:  # not by any(), which would take as long as the function
                if x is _UNDEFINED:
                    registers[target] = _UNDEFINED
                    break
            else:
                registers[target] = function(*operands)
        except _Undefined:
            registers[target] = _UNDEFINED


def _not(truth: bool | None) -> bool | None:
    return None if truth is None else not truth


def _combine(decisive: bool, truths: Sequence[bool | None]) -> bool | None:
    """The truth of an `Or`, which one True decides, or of an `And`, which one False decides."""
    if decisive in truths:
        return decisive
    return None if None in truths else not decisive


def _comparison(holds: Compare, fails: Compare, undefined: bool = False) -> Compare:
    """True or False if the balls prove it, otherwise None; equal exact balls prove equality."""

    def compare(a: arb, b: arb) -> bool | None:
        if a is _UNDEFINED or b is _UNDEFINED:
            return undefined
        return True if holds(a, b) else False if fails(a, b) else None

    return compare


_COMPARISONS = {
    "<": _comparison(operator.lt, operator.ge),
    "<=": _comparison(operator.le, operator.gt),
    ">": _comparison(operator.gt, operator.le),
    ">=": _comparison(operator.ge, operator.lt),
    "==": _comparison(operator.eq, operator.ne),
    "!=": _comparison(operator.ne, operator.eq, undefined=True),
}


def _inverse(x: arb) -> arb:
    if x.is_zero():
        raise _Undefined
    return 1 / x


def _monotone(function: Callable[[arb], arb], low: int, high: float) -> Callable[[arb], arb]:
    """A monotone function on its domain; a ball is intersected with the domain."""

    def restricted(x: arb) -> arb:
        if (x >= low and x <= high) or not x.is_finite():
            return function(x)
        if x < low or x > high:
            raise _Undefined
        return function(x.lower().max(arb(low))).union(function(x.upper().min(arb(high))))

    return restricted


_sqrt = _monotone(arb.sqrt, 0, math.inf)


def _atan2(y: arb, x: arb) -> arb:
    if y.is_zero() and x.is_zero():
        raise _Undefined
    return arb.atan2(y, x)


def _sign(x: arb) -> arb:
    sign = x.sgn()
    if not sign.is_exact():
        raise _Open("a sign is not decided")
    return sign


def _tan_turns(q: fmpq) -> arb:
    return arb.sin_pi_fmpq(q) * _inverse(arb.cos_pi_fmpq(q))


def _power(e: Expr) -> Callable[[arb], arb]:
    """The power with the constant exponent of `e`."""
    roots, n, inverted = square_roots(e), abs(int(e.exp.p)), e.exp < 0

    def power(x: arb) -> arb:
        base = reduce(lambda y, _: _sqrt(y), range(roots), x)
        return _whole_power(_inverse(base) if inverted else base, n)

    return power


def _whole_power(x: arb, n: int) -> arb:
    """The power by squaring: `**` of python-flint gives nan for a ball that contains zero."""
    result = arb(1)
    while n:
        if n & 1:
            result *= x
        x, n = x * x, n >> 1
    return result


_FUNCTIONS: dict[type, Callable[..., arb]] = {
    sp.Add: lambda *terms: reduce(operator.add, terms),
    sp.Mul: lambda *factors: reduce(operator.mul, factors),
    sp.atan2: _atan2,
    sp.acos: _monotone(arb.acos, -1, 1),
    sp.asin: _monotone(arb.asin, -1, 1),
    sp.atan: arb.atan,
    sp.Abs: abs,
    sp.sign: _sign,
    sp.Max: lambda *xs: reduce(arb.max, xs),
    sp.Min: lambda *xs: reduce(arb.min, xs),
    Resolvent: enclosed,
}


def pivot_rows(rows: Sequence[Sequence[Any]]) -> list[int]:
    """The rows of a matrix of balls that are certainly independent, by Gaussian elimination."""
    left, chosen = dict(enumerate(map(list, rows))), list[int]()
    for column in range(len(rows[0])):
        certain = [j for j, row in left.items() if not row[column].contains(0)]
        if certain:
            best = max(certain, key=lambda j: abs(float(left[j][column].mid())))
            pivot = left.pop(best)
            for j, row in left.items():
                scale = row[column] / pivot[column]
                left[j] = [a - b * scale for a, b in zip(row, pivot, strict=True)]
            chosen.append(best)
    return sorted(chosen)


_TRIGONOMETRIC: dict[type, tuple[Callable[[arb], arb], Callable[[fmpq], arb]]] = {
    sp.sin: (arb.sin, arb.sin_pi_fmpq),
    sp.cos: (arb.cos, arb.cos_pi_fmpq),
    sp.tan: (arb.tan, _tan_turns),
}
_RECIPROCAL = {sp.cot: sp.tan, sp.sec: sp.cos, sp.csc: sp.sin}
