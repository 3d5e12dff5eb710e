"""A chain of lemmas as a reader computes it: in angles instead of their sines and cosines.

A program carries the sine and the cosine of an angle from lemma to lemma, each divided by their
common length.  A reader takes the arctangent of both without the length, and adds angles instead of
applying addition theorems.  Angles are counted up to whole turns.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain, combinations, count
from types import MappingProxyType
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.plain import followed, is_rounding
from closedform.emit.backends.latex.rotations import product
from closedform.model.expressions import SIMPLE, parts, substitute
from closedform.model.functions import (
    Bound,
    Function,
    Let,
    Match,
    Statement,
    Vanishes,
    choose,
    real,
)
from closedform.model.lemma import Lemma

QUARTERS = {(0, 1): sp.S.Zero, (1, 0): sp.pi / 2, (0, -1): sp.pi, (-1, 0): -sp.pi / 2}
"""The angles whose sine and cosine are whole numbers."""


@dataclass(frozen=True)
class Turned:
    """A function in angles, and what stands in it for names of the program that are gone."""

    function: Function
    names: Mapping[sp.Basic, sp.Basic]
    angles: Mapping[sp.Basic, sp.Expr] = field(default_factory=dict)
    """Results that differ from another angle by a constant."""
    product: str = ""
    """The product of rotations that it needs, in LaTeX."""
    letters: Mapping[sp.Symbol, str] = field(default_factory=dict)
    """How the entries of the product are written."""
    chosen: Mapping[sp.Symbol, Sequence[sp.Symbol]] = field(default_factory=dict)
    """For flags, the angles that have another value there than the formulas give, and no number."""

    def multiplied(self, rotations: Mapping[str, sp.MatrixBase]) -> Turned:
        """The function with one product in place of the rotations joint by joint."""
        found = product(self.function, rotations, self.angles)
        if found is None:
            return self
        names = {**self.names, **found.names}
        return replace(
            self, function=found.function, names=names, product=found.text, letters=found.letters
        )


def in_angles(
    function: Function,
    lemmas: Sequence[Lemma],
    results: Sequence[sp.Symbol],
    letters: Sequence[str],
    named: Mapping[str, str] = MappingProxyType({}),
) -> Turned:
    """The function without sines and cosines that an angle replaces.

    ``results`` are the symbols of its outputs, and ``letters`` are for angles without a symbol.
    ``named`` has the symbols that the derivation has for some, by the names of their pairs.
    """
    more = (f"omega_{k}" for k in count(2))
    found = _InAngles(function, lemmas, results, chain(letters, more), named)
    told = found.told()
    angles = {s: e for e, s in found.totals.items() if e.is_Add and len(e.free_symbols) == 1}
    return Turned(told, found.names, angles, chosen=found.chosen)


@dataclass
class _InAngles:
    """A function whose names for sines and cosines give way to angles."""

    function: Function
    lemmas: Sequence[Lemma]
    results: Sequence[sp.Symbol]
    letters: Iterator[str]
    named: Mapping[str, str]
    names: dict[sp.Basic, sp.Basic] = field(default_factory=dict)
    """What stands for the names that are gone."""
    totals: dict[sp.Expr, sp.Symbol] = field(default_factory=dict)
    """Sums of angles that have a symbol."""
    chosen: dict[sp.Symbol, list[sp.Symbol]] = field(default_factory=dict)
    """See ``Turned``."""

    def __post_init__(self) -> None:
        body = self.function.body
        self.flags = [s.symbol for s in body if isinstance(s, Vanishes)]
        self.usual: dict[sp.Basic, Any] = dict.fromkeys(self.flags, sp.false)
        flags = [s for s in body if isinstance(s, Vanishes) and not is_rounding(s)]
        self.special = [flag.symbol for flag in flags]
        self.freeing = [flag.symbol for flag in flags if flag.free]
        self.raw = {s.symbol: s.value for s in body if isinstance(s, Let | Bound)}
        self.values = {n: substitute(e, self.usual) for n, e in self.raw.items()}
        self.alias = {n: e for n, e in self.values.items() if e.is_Symbol}
        self.bounds = {s.symbol for s in body if isinstance(s, Bound)}
        self.signs = {s for _, signs in self.function.cases() for s in signs}
        self.lettered = {s for lemma in self.lemmas for s in lemma.letters}
        self.outputs = [e for a in self.function.outputs for e in a.entries]
        self.solutions = {u: e for lemma in self.lemmas for u, e in lemma.solution.items()}
        self.pairs = self._pairs()
        self.hidden = self._hidden()
        self.made: list[Statement] = []
        given = {a.name: a.entries[0] for a in self.function.inputs if a.shape == ()}
        given = {given[str(r)]: r for r in self.results if str(r) in given}
        self.names |= given
        self.known: set[sp.Symbol] = {*self.function.symbols, *given.values()}
        self.known -= {*self.results} - {*given.values()}

    def told(self) -> Function:
        """The function in angles; its results are their symbols."""
        ends = {max(pair, key=list(self.values).index): pair for pair in self.pairs}
        gone = {n for pair in self.pairs for n in pair}
        passed = set[Any]()
        for statement in self.function.body:
            name = getattr(statement, "symbol", None)
            if name not in gone:
                statement = self._renamed(statement)
                if isinstance(statement, Let) and isinstance(statement.value, sp.sin | sp.cos):
                    self.names[statement.symbol] = statement.value
                else:
                    self.made.append(statement)
            elif name in ends:
                self._turn(*ends[name])
                self._sums()
            passed.add(name)
            self._others(passed)
        outputs = self._results()
        return replace(self.function, body=tuple(self.made), outputs=outputs)

    # Which names give way

    def _pairs(self) -> list[tuple[sp.Symbol, sp.Symbol]]:
        """The sines and cosines that the answers depend on, see ``Pair.known_as``."""
        needed = self._needed()
        names = {str(s.name): s for s in self.values if s in needed}
        found = [
            (sine, cosine)
            for name, sine in names.items()
            if name[0] == "s" and (cosine := names.get(f"c{name[1:]}")) is not None
        ]
        listed = {n for pair in found for n in pair}
        for value in self.solutions.values():  # such as s1 and c1_0, beside a length c1
            for f in value.atoms(sp.atan2):
                if {*f.args} <= self.values.keys() and not {*f.args} & listed:
                    found.append(f.args)
        return found

    def _needed(self) -> set[sp.Basic]:
        needed: set[Any] = {s for e in self.outputs for s in e.free_symbols}
        for statement in reversed(self.function.body):
            if isinstance(statement, Match):
                needed |= substitute(statement.value, self.usual).free_symbols
            elif isinstance(statement, Bound) or (
                isinstance(statement, Let) and statement.symbol in needed
            ):
                needed |= self.values[statement.symbol].free_symbols
        return needed

    def _hidden(self) -> set[sp.Symbol]:
        """The names that only serve sines and cosines; bounds and other names without a letter."""
        paired = {n for pair in self.pairs for n in pair}
        stated = {s for lemma in self.lemmas for e in lemma.equations for s in e.free_symbols}
        needed, uses = self._needed(), Counter[sp.Basic]()
        users: dict[sp.Basic, set[Any]] = {}
        for name, value in [*self.values.items(), *((None, e) for e in self.outputs)]:
            if name is None or (name in needed and name not in self.alias):
                for part in sp.preorder_traversal(followed(value, self.alias)):
                    if part in self.values:
                        uses[part] += 1
                        users.setdefault(part, set()).add(name)
        serving = set[sp.Symbol]()
        for name in reversed(list(self.values)):
            if users.get(name, set()) <= paired | serving:
                serving.add(name)
        return {
            name
            for name, value in self.values.items()
            if name not in paired | self.lettered | stated
            if value.is_Atom
            or value.free_symbols <= self.signs
            or name in self.bounds
            or (name in serving and (uses[name] < 2 or self._is_short(value)))
        }

    def _is_short(self, value: sp.Expr) -> bool:
        """Whether a value may occur twice: it has no roots, or those of letters."""
        roots = [p.base for p in value.atoms(sp.Pow) if p.exp == sp.S.Half]
        return all(r in self.lettered for r in roots)

    # From a sine and a cosine to an angle

    def _turn(self, sine: sp.Symbol, cosine: sp.Symbol) -> None:
        """Name the angle of a sine and a cosine, and what it is."""
        arctangent = sp.atan2(sine, cosine)
        for unknown, solution in self.solutions.items():
            if followed(solution, self.alias) == followed(arctangent, self.alias):
                if unknown not in self.known:
                    self._define(unknown, solution)
                    self._choose(unknown, solution, arctangent)
                return self._called(sine, cosine, unknown)
            rest = solution - arctangent
            if solution.is_Add and not rest.has(sp.atan2) and (sign := self._half_turn(rest)):
                self._define(unknown, solution)
                return self._called(sine, cosine, unknown, sign)
        value = self._angle(arctangent)
        symbol = self.totals.get(value, value)
        if not (symbol.is_Symbol or symbol.is_number):
            own = self.named.get(str(sine.name)[1:].lstrip("_"))
            symbol = real(own or next(self.letters))
            self._define(symbol, arctangent)
        return self._called(sine, cosine, symbol)

    def _called(
        self, sine: sp.Symbol, cosine: sp.Symbol, angle: sp.Expr, sign: sp.Expr = sp.S.One
    ) -> None:
        self.names |= {sine: sign * sp.sin(angle), cosine: sign * sp.cos(angle)}

    def _define(self, unknown: sp.Symbol, solution: sp.Expr) -> None:
        """State an angle, with its values where a flag holds."""
        value = self._angle(solution)
        for flag in reversed([f for f in self.special if self._has(solution, f)]):
            there = None if self._varies(solution, flag) else self._angle(solution, flag)
            if there is not None and there.is_number:
                value = choose(flag, there, value)
        self.made.append(Let(unknown, value))
        self.known.add(unknown)
        usual = substitute(value, self.usual)
        if not usual.is_number:
            self.totals.setdefault(usual, unknown)

    def _choose(self, unknown: sp.Symbol, solution: sp.Expr, usual: sp.Expr) -> None:
        """Note the flags of free joints that put other names than the usual ones in an angle."""
        for flag in self.freeing:
            there = self._names_in(solution, flag)
            if there and there != self._names_in(usual, flag):
                self.chosen.setdefault(flag, []).append(unknown)

    def _names_in(self, value: sp.Expr, flag: sp.Symbol) -> set[sp.Symbol]:
        """The names that remain in a value where a flag holds."""
        flags = self.usual | {flag: sp.true}
        pending, seen, left = [value], set[sp.Symbol](), set[sp.Symbol]()
        while pending:
            found = substitute(substitute(pending.pop(), self.names), flags).free_symbols - seen
            inner = {n for n in found if self._is_inner(n)}
            pending += (self.raw[n] for n in inner)
            left |= found - inner
            seen |= found
        return left

    def _is_inner(self, name: sp.Symbol) -> bool:
        """Whether a name is a sine or a cosine of an angle to come, or only serves them."""
        paired = any(name in pair for pair in self.pairs)
        return name in self.raw and (name in self.hidden or (paired and name not in self.names))

    def _sums(self) -> None:
        """State the results that are sums of angles, as soon as these are known."""
        for result, value in zip(self.results, self.outputs, strict=True):
            held = {n for n in value.free_symbols if n in self.raw}
            if result not in self.known and held and held <= self.names.keys():
                angle = self._angle(value)
                if angle.is_Add and angle.free_symbols <= self.known:
                    self._define(result, value)

    def _others(self, passed: set[Any]) -> None:
        """State the other angles that a lemma gives beside one that is known."""
        for lemma in self.lemmas:
            for unknown, value in lemma.solution.items():
                fresh = unknown not in self.known and unknown not in self.raw
                ready = value.free_symbols & self.raw.keys() <= passed
                beside = self.known & lemma.solution.keys() and value.has(sp.atan2)
                if fresh and ready and beside:
                    self._define(unknown, value)

    def _has(self, value: sp.Expr, flag: sp.Symbol) -> bool:
        """Whether an angle is another one where the flag holds."""
        inner = (self.hidden | {n for pair in self.pairs for n in pair}) - self.names.keys()
        pending, seen = [value], set[sp.Basic]()
        while pending:
            for name in pending.pop().free_symbols - seen:
                seen.add(name)
                if name == flag:
                    return True
                if name in inner:
                    pending.append(self.raw[name])
        return False

    def _varies(self, value: sp.Expr, flag: sp.Symbol) -> bool:
        """Whether an angle is certainly not a number where a flag holds.

        Only the names that the flag changes are looked at.
        """
        flags = self.usual | {flag: sp.true}
        while True:
            value = substitute(value, flags)
            changed = {n for n in value.free_symbols & self.raw.keys() if self._has(n, flag)}
            if not changed:
                break
            value = substitute(value, {n: self.raw[n] for n in changed})
        terms = (f for t in sp.Add.make_args(value) for f in sp.Mul.make_args(t))
        return any(
            0 not in f.args and sp.Mul(f.args[0], *(1 / e for e in f.args[1:])).free_symbols
            for f in terms
            if isinstance(f, sp.atan2 | sp.atan)
        )

    def _angle(self, value: sp.Expr, flag: sp.Symbol | None = None) -> sp.Expr:
        """An angle in the names that remain."""
        value = self._plain(value, flag)
        value = value.replace(sp.atan2, self._arctangent)
        return self._without_signs(value)

    def _plain(self, value: sp.Expr, flag: sp.Symbol | None = None) -> sp.Expr:
        """A value without the names of sines and cosines, and what only serves them."""
        flags = self.usual | ({flag: sp.true} if flag else {})
        for _ in range(len(self.raw) + 1):
            value = substitute(substitute(value, self.names), flags)
            inner = {
                n: substitute(self.raw[n], flags) for n in value.free_symbols if self._is_inner(n)
            }
            if not inner:
                break
            value = substitute(value, inner)
        return self._squared(added(value, self.totals))

    def _squared(self, value: sp.Expr) -> sp.Expr:
        """The same where the square of a sign is 1."""
        powers = {p: p.base ** (p.exp % 2) for p in value.atoms(sp.Pow) if p.base in self.signs}
        return value.xreplace({p: e for p, e in powers.items() if p.exp.is_Integer})

    def _arctangent(self, y: sp.Expr, x: sp.Expr) -> sp.Expr:
        """The angle of a vector: without a common length, as a sum of angles if it is one."""
        y, x = self._shorter(y, x)
        if (y, x) in QUARTERS:
            return QUARTERS[y, x]
        found = turned(y, x)
        return sp.atan2(y, x, evaluate=False) if found is None else found

    def _shorter(self, y: sp.Expr, x: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Both without what is a positive factor of each."""
        kept = {e: _name_of(e) for value in (y, x) for e in _large_bounds(value)}
        back = {name: e for e, name in kept.items()}
        y, x = self._without_factors(y.xreplace(kept), x.xreplace(kept))
        return y.xreplace(back), x.xreplace(back)

    def _without_factors(self, y: sp.Expr, x: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        y, x = map(sp.together, (y, x))
        (y, below), (x, under) = sp.fraction(y), sp.fraction(x)
        if 0 in (y, x):  # such as the angle of a direction along an axis
            other = below if y != 0 else under
            below = under = other
        if not (self._is_positive(below) and self._is_positive(under)):
            return y / below, x / under
        common = sp.gcd_terms(sp.lcm(below, under)) if below != under else below
        y, x = sp.factor_terms(y * common / below), sp.factor_terms(x * common / under)
        number = sp.gcd(abs(y.as_coeff_Mul()[0]), abs(x.as_coeff_Mul()[0]))
        shared = set(sp.Mul.make_args(y)) & set(sp.Mul.make_args(x))
        shared = {f for f in shared if not f.is_Rational and self._is_positive(f)}
        factor = sp.Mul(number or 1, *shared)
        return self._squared(sp.expand_mul(y / factor, deep=False)), self._squared(
            sp.expand_mul(x / factor, deep=False)
        )

    def _is_positive(self, value: sp.Expr) -> bool:
        """Whether a value is not negative, by what is said of its names."""
        if value.is_nonnegative:
            return True
        if value.is_Symbol:
            own = self.values.get(value)
            return value in self.bounds or (own is not None and self._is_positive(own))
        if value.is_Add or value.is_Mul:
            return all(map(self._is_positive, value.args))
        if value.is_Pow:
            return (
                bool(value.exp.is_even) or value.exp == sp.S.Half or self._is_positive(value.base)
            )
        return False

    # Signs of branches

    def _half_turn(self, value: sp.Expr) -> sp.Expr | None:
        """The sign with which an angle is 0, and without which it is half a turn."""
        value = self._plain(value)
        for sign in sorted(value.free_symbols & self.signs, key=str):
            if [value.subs(sign, s) for s in (1, -1)] == [0, sp.pi]:
                return sign
        return None

    def _without_signs(self, value: sp.Expr) -> sp.Expr:
        """An angle with the signs of branches in the arguments of its arctangent."""
        if value.is_Add:
            angle = next((t for t in value.args if isinstance(t, sp.atan2)), None)
            rest = value - angle if angle is not None else value
            sign = self._half_turn(rest) if angle is not None else None
            if angle is None or sign is None:
                return value
            y, x = (self._squared(sp.expand_mul(sign * e)) for e in angle.args)
            return sp.atan2(sp.factor_terms(y), sp.factor_terms(x), evaluate=False)
        if value.is_Mul:
            angle = next((t for t in value.args if isinstance(t, sp.atan2)), None)
            sign, own = (value / angle).as_coeff_Mul() if angle is not None else (1, sp.S.One)
            if angle is not None and own in self.signs and abs(sign) == 1:
                y = self._squared(sp.expand_mul(own * angle.args[0]))
                return sign * sp.atan2(y, angle.args[1], evaluate=False)
        return value

    # What remains

    def _renamed(self, statement: Statement) -> Statement:
        changes = {
            name: added(substitute(value, self.names), self.totals)
            for name in ("value", "scale")
            if isinstance(value := getattr(statement, name, None), sp.Expr)
        }
        return replace(statement, **changes) if changes else statement

    def _results(self) -> tuple[Any, ...]:
        """The outputs, which are the symbols of the results."""
        for result, value in zip(self.results, self.outputs, strict=True):
            if result not in self.known:
                angle = self._angle(value)
                signed = {**{-e: -s for e, s in self.totals.items()}, **self.totals}
                if angle in signed:
                    self.made.append(Let(result, signed[angle]))
                    self.known.add(result)
                elif value.is_Symbol and value in self.raw:
                    continue
                else:
                    self._define(result, value)
        symbols = iter(
            r if r in self.known else v for r, v in zip(self.results, self.outputs, strict=True)
        )
        return tuple(
            replace(a, entries=tuple(next(symbols) for _ in a.entries))
            for a in self.function.outputs
        )


def _large_bounds(value: sp.Expr) -> list[sp.Expr]:
    """The outermost maxima, minima and absolute values that take SymPy long to make anew."""
    if isinstance(value, sp.Max | sp.Min | sp.Abs) and len(parts([value])) > SIMPLE:
        return [value]
    return [e for a in value.args for e in _large_bounds(a)]


def _name_of(value: sp.Expr) -> sp.Dummy:
    """A name for a value, with what is known of its sign."""
    return sp.Dummy(real=True, nonnegative=value.is_nonnegative)


def added(value: sp.Expr, totals: Mapping[sp.Expr, sp.Symbol]) -> sp.Expr:
    """The same with sines and cosines of sums of angles, and of the ``totals`` by their symbols."""
    while True:
        angles = sorted({f.args[0] for f in value.atoms(sp.sin, sp.cos)}, key=str)
        found: dict[sp.Basic, sp.Expr] = {}
        for a, b in combinations(angles, 2):
            for p, q, sign in ((a, b, 1), (a, b, -1)):
                sine = sp.sin(p) * sp.cos(q) + sign * sp.cos(p) * sp.sin(q)
                cosine = sp.cos(p) * sp.cos(q) - sign * sp.sin(p) * sp.sin(q)
                total = p + sign * q
                found |= {sine: sp.sin(total), -sine: -sp.sin(total)}
                found |= {cosine: sp.cos(total), -cosine: -sp.cos(total)}
        sums = [(e, s) for e, s in totals.items() if e.is_Add]
        known = {f(e): f(s) for e, s in sums for f in (sp.sin, sp.cos)}
        known |= {f(-e): f(-s) for e, s in sums for f in (sp.sin, sp.cos)}
        changed = value.xreplace(found)
        changed = changed.xreplace({e: s for e, s in known.items() if changed.has(e)})
        if changed == value:
            return value
        value = changed


def same_angle(pair: Sequence[sp.Expr], values: Sequence[sp.Expr]) -> sp.Expr | None:
    """The angle whose sine and cosine are the values, if a whole pair is that of another angle."""
    angles = {v.args[0] for v in values if isinstance(v, sp.sin | sp.cos)}
    alike = all(a.func == b.func for a, b in zip(pair, values, strict=True))
    return angles.pop() if len(pair) == 2 and alike and len(angles) == 1 else None


def turned(y: sp.Expr, x: sp.Expr) -> sp.Expr | None:
    """The angle of a vector that is a unit vector, or another one turned by an angle."""
    if isinstance(y, sp.sin) and isinstance(x, sp.cos) and y.args == x.args:
        return y.args[0]
    for angle in sorted({f.args[0] for f in y.atoms(sp.sin, sp.cos)}, key=str):
        s, c = sp.sin(angle), sp.cos(angle)
        if not all(e.is_polynomial(s, c) for e in (y, x)):
            continue  # the long formulas of roots cannot be expanded
        (ys, yc), (xs, xc) = ([sp.expand(e).coeff(f) for f in (s, c)] for e in (y, x))
        if sp.expand(y - ys * s - yc * c) != 0 or sp.expand(x - xs * s - xc * c) != 0:
            continue
        for sign in (1, -1):  # (yc, xc) turned by the angle, or back
            if sp.expand(ys - sign * xc) == 0 and sp.expand(xs + sign * yc) == 0:
                rest = QUARTERS.get((yc, xc))
                start = sp.atan2(yc, xc, evaluate=False) if rest is None else rest
                return start + sign * angle
    return None


__all__ = ["Turned", "added", "in_angles", "same_angle", "turned"]
