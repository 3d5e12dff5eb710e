"""Counterexamples that a person can check: simple exact points at which two sides differ."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache, partial
from typing import Any, TypeAlias

import sympy as sp
from flint import arb
from sympy import Rational, Symbol
from sympy.core.relational import Relational

from closedform.algebra.balls import Evaluator, Undetermined
from closedform.algebra.expressions import TRIGONOMETRIC

Expr: TypeAlias = Any  # SymPy's annotations are partial

_LENGTHS = tuple(map(Rational, (1, 2, 3)))
_NUMBERS = tuple(map(Rational, (0, 1, -1, 2, -2, 3, -3)))
_ANGLES = tuple(
    q * sp.pi
    for r in ("0", "1/2", "1/6", "1/3", "1/4", "1")
    for q in ([Rational(r)] if r in ("0", "1") else [Rational(r), -Rational(r)])
)
_SIMPLE_POINTS = 400
_RANDOM_POINTS = 200
_COMPLETIONS = 20
_BITS = 300  # distinguishes a difference of 1e-80 from zero


@dataclass(frozen=True)
class Counterexample:
    """A point, and an enclosure of one entry of the difference there, which excludes zero."""

    point: dict[Symbol, Expr]
    ball: arb
    entry: int

    def describe(self) -> str:
        """The point and the difference, such as `theta1 = 0, l1 = 1: difference = 0.2929`."""
        at = ", ".join(f"{s} = {v}" for s, v in self.point.items())
        where = f"entry {self.entry}, " if self.entry else ""
        return f"{where}{at}{': ' if at else ''}difference = {_shown(self.ball)}"


def _shown(ball: arb, digits: int = 10) -> str:
    text: str = ball.str(digits)
    return text.rstrip("0").rstrip(".") if "." in text and text[-1].isdigit() else text


def find_counterexample(
    difference: Expr | sp.MatrixBase,
    symbols: Sequence[Symbol] | None = None,
    *,
    conditions: Sequence[Relational] = (),
    seed: int = 0,
    sides: Sequence[Sequence[Expr]] = (),
    postures: Sequence[Mapping[Symbol, Expr]] = (),
) -> Counterexample | None:
    """The simplest point at which some entry provably differs from zero.

    The simplest points are tried first: small integers for coordinates, 1, 2, 3 for positive
    symbols, the usual fractions of `pi` for angles. Then come random rationals, the same on every
    run. The result is None if no point is found, which proves nothing.

    Parameters
    ----------
    difference
        an expression or a matrix of them
    symbols
        those that a point gives values for, by default all that occur, sorted by name
    conditions
        what must provably hold at the point
    seed
        that of the random points
    sides
        for each entry, the expressions of which it is the difference; they have values at the
        point, so the point also gives values for symbols that cancel
    postures
        points at which symbols that depend on each other agree; no other point is tried then
    """
    entries: list[Expr] = sp.Matrix([difference]).flat()
    gaps = [_gap(c) for c in conditions]
    free = {s for e in [*entries, *(g for g, _ in gaps)] for s in e.free_symbols}
    if postures:
        names = list(postures[0])
    else:
        names = sorted(free, key=str) if symbols is None else list(symbols)
    evaluator = Evaluator(
        names, [*entries, *(g for g, _ in gaps)], rel_bits=_BITS, max_bits=4 * _BITS
    )
    completions = [cache(partial(_Completion, names, exprs, seed)) for exprs in sides]
    tried: Iterable[tuple[Expr, ...]] = (
        (tuple(at[s] for s in names) for at in postures)
        if postures
        else _points(names, _angles(entries), random.Random(seed))
    )
    for values in tried:
        try:
            balls = evaluator(values)
        except Undetermined:
            continue
        held = zip(balls[len(entries) :], gaps, strict=True)
        if not all(g > 0 or (g >= 0 and not strict) for g, (_, strict) in held):
            continue
        for entry, ball in enumerate(balls[: len(entries)]):
            if ball.is_finite() and not ball.contains(0):
                point = dict(zip(names, values, strict=True))
                completed = completions[entry]()(point) if completions else point
                if completed is not None:
                    return Counterexample(completed, ball, entry)
    return None


class _Completion:
    """Extends a point with values for further symbols, so that expressions have values there."""

    def __init__(self, names: Sequence[Symbol], exprs: Sequence[Expr], seed: int):
        free = {s for e in exprs for s in e.free_symbols}
        self.missing = sorted(free - set(names), key=str)
        self.evaluator = Evaluator([*names, *self.missing], exprs)
        self.angles = _angles(exprs)
        self.seed = seed

    def __call__(self, point: dict[Symbol, Expr]) -> dict[Symbol, Expr] | None:
        """The point with a value for each missing symbol, sorted by name; None if none is found."""
        draw = random.Random(self.seed)
        for values in _points(self.missing, self.angles, draw, _COMPLETIONS, _COMPLETIONS):
            completed = point | dict(zip(self.missing, values, strict=True))
            try:
                balls = self.evaluator(completed)
            except Undetermined:
                continue
            if all(ball.is_finite() for ball in balls):
                return {s: completed[s] for s in sorted(completed, key=str)}
        return None


def _gap(condition: Relational) -> tuple[Expr, bool]:
    """An expression that must not be negative, and whether it must not be zero either."""
    if isinstance(condition, sp.Ge | sp.Gt):
        return condition.lhs - condition.rhs, isinstance(condition, sp.Gt)
    if isinstance(condition, sp.Le | sp.Lt):
        return condition.rhs - condition.lhs, isinstance(condition, sp.Lt)
    if isinstance(condition, sp.Ne):
        return sp.Abs(condition.lhs - condition.rhs), True
    if condition in (sp.true, sp.false):
        return Rational(1 if condition == sp.true else -1), True
    raise TypeError(f"a condition must be an inequality, not {condition}")


def _angles(entries: Sequence[Expr]) -> set[Symbol]:
    """Symbols that occur only as angles in the arguments of sines and cosines."""
    return {
        atom
        for e in entries
        for trigonometric in e.atoms(*TRIGONOMETRIC)
        for atom in sp.expand(trigonometric.args[0]).as_coefficients_dict()
        if atom.is_Symbol
    }


def _points(
    names: Sequence[Symbol],
    angles: set[Symbol],
    draw: random.Random,
    simple: int = _SIMPLE_POINTS,
    drawn: int = _RANDOM_POINTS,
) -> Iterator[tuple[Expr, ...]]:
    """Points from simple to random; each coordinate obeys the assumptions on its symbol."""
    menus = [_menu(s, s in angles) for s in names]
    yield from itertools.islice(_simplest(menus), simple)
    for _ in range(drawn):
        yield tuple(draw.choice(menu) for menu in menus)
    for _ in range(drawn):
        yield tuple(_rational(s, draw) for s in names)


def _menu(s: Symbol, angle: bool) -> list[Expr]:
    values = _ANGLES if angle else _LENGTHS if s.is_positive else _NUMBERS
    return [v for v in values if _admits(s, v)] or [v for v in _NUMBERS if _admits(s, v)]


def _admits(s: Symbol, value: Expr) -> bool:
    """Whether the assumptions on a symbol allow a value."""
    return all(
        getattr(value, f"is_{name}") is truth
        for name, truth in s.assumptions0.items()
        if name in ("positive", "negative", "zero", "nonnegative", "nonpositive", "integer")
    )


def _simplest(menus: Sequence[Sequence[Expr]]) -> Iterator[tuple[Expr, ...]]:
    """The product of the menus, ordered by total rank, so that few values are unusual."""
    longest = sum(len(menu) - 1 for menu in menus)
    for total in range(longest + 1):
        for ranks in _compositions(total, [len(menu) - 1 for menu in menus]):
            yield tuple(menu[r] for menu, r in zip(menus, ranks, strict=True))


def _compositions(total: int, limits: Sequence[int]) -> Iterator[tuple[int, ...]]:
    if not limits:
        if total == 0:
            yield ()
        return
    for first in range(min(total, limits[0]), -1, -1):
        for others in _compositions(total - first, limits[1:]):
            yield (first, *others)


def _rational(s: Symbol, draw: random.Random) -> Expr:
    """A random rational with a small denominator."""
    while True:
        value = Rational(draw.randint(-30, 30), draw.randint(1, 10))
        if _admits(s, value):
            return value
        if s.is_positive or s.is_nonnegative:
            value = abs(value)
