"""Which outputs are angles, and how far they may be from (-pi, pi].

The wrap of the printed code takes away one turn.  How many turns there can be follows from the way
an angle was put together: an arctangent lies in half a turn to either side, whether it stands in
the output itself or in a name that the output is computed from; an angle of the input may have
any size, and is therefore read from its sine and cosine where it enters a sum.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

import sympy as sp

from closedform.derivation import Derivation
from closedform.functions import Function, Let

Expr = Any
UNBOUNDED = sp.oo


@dataclass(frozen=True)
class Span:
    """``size`` bounds the modulus in half turns; ``angle`` says that an arctangent is in it."""

    size: Expr
    angle: bool


@dataclass(frozen=True)
class Turns:
    """The angles among the outputs of one function."""

    function: Function
    lets: Mapping[Expr, Expr]
    joints: frozenset[int]
    """Which entries of the outputs, counted through, are revolute joints of an inverse."""

    @classmethod
    def of(cls, function: Function, derivation: Derivation) -> Turns:
        revolute = {j.symbol for j in derivation.joints if j.kind == "revolute"}
        unknowns = [i.unknowns for i in derivation.inverses if i.function == function.name]
        return cls(
            function,
            {s.symbol: s.value for s in function.body if isinstance(s, Let)},
            frozenset(k for row in unknowns for k, u in enumerate(row) if u in revolute),
        )

    def entries(self) -> list[Expr]:
        """The outputs; angles of the input that are added to an angle are read from sine and
        cosine."""
        flat = [e for output in self.function.outputs for e in output.entries]
        return [self._read(e) if self._is_angle(k, e) else e for k, e in enumerate(flat)]

    def wraps(self, k: int, entry: Expr, signs: Mapping[Expr, int]) -> int:
        """How often the wrap must be applied to an entry of :meth:`entries`, in one branch."""
        if not self._is_angle(k, entry):
            return 0
        size = self.span(entry, signs).size
        if size is UNBOUNDED:
            raise TypeError(
                f"{self.function.name}: the size of the angle {entry} is not known, so that it "
                f"cannot be brought into (-pi, pi]; write it as atan2(sin, cos)"
            )
        # atan2(-0, -1) is -pi, so that a half turn needs the wrap too
        least = 1 if size >= 1 or entry.has(sp.atan2) else 0
        return int(max(least, ceil((size - 1) / 2)))

    def _is_angle(self, k: int, entry: Expr) -> bool:
        return k in self.joints or self.span(entry, {}).angle

    def span(self, e: Expr, signs: Mapping[Expr, int]) -> Span:
        """Signs that are not given count as +1 or -1, as branch signs are."""
        if e.free_symbols <= signs.keys():
            value = e.xreplace(signs)
            if value.is_number and not value.has(sp.nan, sp.zoo):
                return Span(abs(value) / sp.pi, False)
        if e in self.lets:
            return self.span(self.lets[e], signs)
        if isinstance(e, sp.atan2 | sp.atan):
            right = isinstance(e, sp.atan) or self._nonnegative(e.args[1])
            return Span(sp.Rational(1, 2) if right else sp.S.One, True)
        if isinstance(e, sp.Add):
            spans = [self.span(a, signs) for a in e.args]
            return Span(sp.Add(*(s.size for s in spans)), any(s.angle for s in spans))
        if isinstance(e, sp.Mul):
            return self._product(e, signs)
        if isinstance(e, sp.Piecewise | sp.Abs | sp.Max | sp.Min):
            parts = [a for a, _ in e.args] if isinstance(e, sp.Piecewise) else e.args
            spans = [self.span(a, signs) for a in parts]
            return Span(max(s.size for s in spans), any(s.angle for s in spans))
        return Span(UNBOUNDED, False)

    def _product(self, e: sp.Mul, signs: Mapping[Expr, int]) -> Span:
        """A multiple of an angle by numbers and signs is one; by a length it is none."""
        size, found = sp.S.One, None
        for factor in e.args:
            if factor.free_symbols <= {*self._signs, *signs}:
                size *= self._greatest(factor, signs)
                continue
            inner = self.span(factor, signs)
            if not inner.angle and inner.size is not UNBOUNDED:
                size *= inner.size * sp.pi  # a sign that was computed
            elif inner.angle and found is None:
                found = inner
            else:
                return Span(UNBOUNDED, False)
        return Span(size * found.size, True) if found else Span(size / sp.pi, False)

    @property
    def _signs(self) -> frozenset[Expr]:
        return frozenset(s for _, chosen in self.function.cases() for s in chosen)

    def _greatest(self, factor: Expr, signs: Mapping[Expr, int]) -> Expr:
        """The greatest modulus of a factor of numbers and signs."""
        cases = [signs] if signs else [chosen for _, chosen in self.function.cases()]
        return max(abs(factor.xreplace({**chosen})) for chosen in cases)

    def _nonnegative(self, e: Expr) -> bool:
        """Whether it is plain that an expression is not negative, in the names of the body too."""
        if e.is_nonnegative:
            return True
        if e in self.lets:
            return self._nonnegative(self.lets[e])
        if isinstance(e, sp.Piecewise):
            return all(self._nonnegative(value) for value, _ in e.args)
        if isinstance(e, sp.Pow):
            return e.exp.is_Rational and (e.exp.q == 2 or self._nonnegative(e.base))
        return isinstance(e, sp.Add | sp.Mul) and all(map(self._nonnegative, e.args))

    def _read(self, e: Expr) -> Expr:
        """The same angle up to whole turns, with what is unbounded in it as one arctangent."""
        if isinstance(e, sp.Piecewise):
            return sp.Piecewise(*((self._read(value), c) for value, c in e.args))
        terms = list(sp.Add.make_args(e))
        wide: list[Expr] = []
        kept: list[Expr] = []
        while terms:
            term = terms.pop(0)
            factor, rest = term.as_coeff_Mul()
            if rest in self.lets and self.span(rest, {}).size is UNBOUNDED:
                terms += [factor * a for a in sp.Add.make_args(self.lets[rest])]
            elif rest in self.function.symbols:
                wide.append(term)
            else:
                kept.append(term)
        if not wide:
            return e
        total = sp.Add(*wide)
        return sp.Add(sp.atan2(sp.sin(total), sp.cos(total)), *kept)


__all__ = ["Span", "Turns"]
