"""A function in vectors: a program has their coordinates, a reader their sums and products."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import sympy as sp

from closedform.emit.backends.latex.plain import followed
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Statement, Vanishes

AXES = "xyz"
Triple = tuple[sp.Expr, sp.Expr, sp.Expr]


class Vector(sp.Symbol):  # type: ignore[misc]
    """A vector of a program, or a scalar product of two, as a symbol."""


def is_vector(symbol: sp.Basic) -> bool:
    return isinstance(symbol, Vector)


@dataclass(frozen=True)
class InVectors:
    """A function whose vectors are single names.

    ``values`` are the vectors in other ones, or in coordinates; ``result`` is the vector that the
    function returns.  ``letters`` say how vectors and scalar products are written.
    """

    function: Function
    values: Mapping[sp.Symbol, sp.Expr | Triple]
    result: sp.Expr
    letters: Mapping[sp.Symbol, str]
    named: sp.Symbol
    """The name of the result."""
    factors: Mapping[sp.Symbol, tuple[sp.Symbol, sp.Symbol]]
    """The factors of each cross product and scalar product."""


def in_vectors(function: Function, written: Mapping[str, str]) -> InVectors | None:
    """The function in vectors, if no statement needs one of their coordinates alone.

    ``written`` says how vectors are written that have another name than in the program.
    """
    found = _Coordinates(function, written)
    if not found.triples or len(found.outputs) != 3:
        return None
    result = found.result()
    scalars = {n: found.products(e) for n, e in found.scalars.items()}
    if result is None or any(e.free_symbols & found.coordinates for e in scalars.values()):
        return None
    return found.told(scalars, result)


class _Coordinates:
    """The vectors of a function by their coordinates, which have names such as ``u_x``."""

    def __init__(self, function: Function, written: Mapping[str, str]):
        self.function, self.written = function, written
        self.factors: dict[sp.Symbol, tuple[sp.Symbol, sp.Symbol]] = {}
        self.first: sp.Symbol | None = None
        self.rest: Triple = (sp.S.Zero,) * 3
        flags = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
        values = {
            s.symbol: substitute(s.value, flags)
            for s in function.body
            if isinstance(s, Let | Bound)
        }
        outputs = [substitute(e, flags) for a in function.outputs for e in a.entries]
        names = {str(s.name): s for s in values}
        bases = [n.removesuffix("_x") for n in names if n.endswith("_x")]
        triples = {
            base: tuple(names[f"{base}_{axis}"] for axis in AXES)
            for base in bases
            if all(f"{base}_{axis}" in names for axis in AXES)
        }
        same = {n: e for n, e in values.items() if e.is_Symbol and e in values}
        kept = [t for t in triples.values() if not {*t} <= same.keys()]
        # a coordinate that is another name is known by its own
        own = {same[c]: c for triple in kept for c in triple if c in same}
        same = {n: e for n, e in same.items() if n not in own.values()}
        self.values = {n: followed(e, same) for n, e in values.items()}
        self.values = {
            n: e if n in own.values() else substitute(e, own) for n, e in self.values.items()
        }
        needed = _needed(function, self.values, [substitute(e, own) for e in outputs], same)
        self.triples: dict[str, tuple[sp.Symbol, ...]] = {
            base: triple
            for base, triple in triples.items()
            if triple in kept and {*triple} & needed
        }
        self.outputs = [substitute(followed(e, same), own) for e in outputs]
        self.coordinates = {c for triple in self.triples.values() for c in triple}
        inside = self.coordinates | same.keys()
        self.scalars = {n: e for n, e in self.values.items() if n in needed and n not in inside}
        self.vectors = {base: Vector(f"vector_{base}", real=True) for base in self.triples}
        self.letters = {
            v: written.get(base) or rf"\mathbf {base}" for base, v in self.vectors.items()
        }

    def product(self, a: str, b: str) -> sp.Symbol:
        """The scalar product of two vectors as a symbol."""
        dot = Vector(f"dot_{a}_{b}", real=True)
        self.factors[dot] = self.vectors[a], self.vectors[b]
        one, other = (self.letters[self.vectors[n]] for n in (a, b))
        self.letters[dot] = rf"\left|{one}\right|^2" if a == b else rf"{one} \cdot {other}"
        return dot

    def products(self, value: sp.Expr) -> sp.Expr:
        """The same with scalar products in place of the coordinates in them."""
        if value.args:
            value = value.func(*map(self.products, value.args))
        if not value.is_Add or not value.free_symbols & self.coordinates:
            return value
        for a, b in [*((n, n) for n in self.triples), *combinations(self.triples, 2)]:
            terms = [p * q for p, q in zip(self.triples[a], self.triples[b], strict=True)]
            total = sp.expand(value)
            factor = total.coeff(terms[0]) if total.is_Add else 0
            rest = sp.expand(total - factor * sp.Add(*terms))
            if factor != 0 and len(sp.Add.make_args(rest)) < len(total.args):
                value = rest + factor * self.product(a, b)
        return value

    def result(self) -> sp.Expr | None:
        """What is returned as a sum of vectors; the part in coordinates is a vector too."""
        parts = self.parts(self.outputs, list(self.triples))
        if parts is None:
            return None
        total, rest = parts
        if rest == (0, 0, 0):
            return total
        self.first = Vector("vector_first", real=True)
        self.letters[self.first] = self.written.get("first", r"\mathbf b")
        self.rest = rest
        return total + self.first

    def linear(self, entries: Sequence[sp.Expr], before: Sequence[str]) -> sp.Expr | None:
        """A vector as a sum of vectors with scalar factors, if it is one."""
        parts = self.parts(entries, before)
        return parts[0] if parts and parts[0] != 0 and parts[1] == (0, 0, 0) else None

    def parts(
        self, entries: Sequence[sp.Expr], known: Sequence[str]
    ) -> tuple[sp.Expr, Triple] | None:
        """A sum of vectors with scalar factors, and what is left of each coordinate."""
        sums, rests = [], []
        for axis, entry in enumerate(entries):
            names = {self.triples[n][axis]: self.vectors[n] for n in known}
            others = {c for n in self.triples for c in self.triples[n]} - names.keys()
            value = sp.expand(entry)
            if value.free_symbols & others:
                return None
            terms = sp.Add.make_args(value.xreplace(names))
            held = [t for t in terms if any(map(is_vector, t.free_symbols))]
            if any(len([f for f in t.free_symbols if is_vector(f)]) > 1 for t in held):
                return None
            sums.append(sp.Add(*held))
            rests.append(sp.Add(*(t for t in terms if t not in held)))
        x, y, z = rests
        return (sums[0], (x, y, z)) if all(e == sums[0] for e in sums) else None

    def cross(self, entries: Sequence[sp.Expr], before: Sequence[str]) -> sp.Expr | None:
        """A vector as a multiple of the cross product of two others, if it is one."""
        for a, b in combinations(before, 2):
            u, v = sp.Matrix(self.triples[a]), sp.Matrix(self.triples[b])
            product = u.cross(v)
            factor = sp.cancel(entries[0] / product[0])
            if factor.free_symbols & (u.free_symbols | v.free_symbols):
                continue
            pairs = zip(entries, product, strict=True)
            if all(sp.expand(e - factor * p) == 0 for e, p in pairs):
                one, other = (a, b) if not factor.as_coeff_Mul()[0].is_negative else (b, a)
                symbol = Vector(f"cross_{one}_{other}", real=True)
                self.factors[symbol] = self.vectors[one], self.vectors[other]
                left, right = (self.letters[self.vectors[n]] for n in (one, other))
                self.letters[symbol] = rf"{left} \times {right}"
                return symbol * (factor if (one, other) == (a, b) else -factor)
        return None

    def told(self, scalars: Mapping[sp.Symbol, sp.Expr], result: sp.Expr) -> InVectors:
        values: dict[sp.Symbol, sp.Expr | Triple] = {}
        origin = [Let(self.first, sp.Add(*self.rest))] if self.first else []
        if self.first:
            values[self.first] = self.rest
        before: list[str] = []
        lasts = {triple[2]: base for base, triple in self.triples.items()}
        body: list[Statement] = []
        for statement in self.function.body:
            symbol = getattr(statement, "symbol", None)
            if symbol in lasts:
                base = lasts[symbol]
                entries = [self.values[c] for c in self.triples[base]]
                value = self.linear(entries, before) if before else None
                value = value if value is not None else self.cross(entries, before)
                values[self.vectors[base]] = tuple(entries) if value is None else value
                body += [*(origin if not before else ()), Let(self.vectors[base], sp.Add(*entries))]
                before.append(base)
            elif symbol in scalars and isinstance(statement, Let | Bound):
                body.append(replace(statement, value=self._kept(statement.value, scalars[symbol])))
            elif symbol not in self.coordinates:
                body.append(self._aside(statement))
        named = Vector("vector_result", real=True)
        self.letters[named] = self.written.get("result", r"\mathbf x")
        function = replace(self.function, body=tuple(body))
        return InVectors(
            function=function,
            values=values,
            result=result,
            letters=self.letters,
            named=named,
            factors=self.factors,
        )

    def _aside(self, statement: Statement) -> Statement:
        """A statement that only special cases need, in vectors if it can be."""
        if isinstance(statement, Let) and statement.symbol in self.values:
            value = self.products(self.values[statement.symbol])
            if not value.free_symbols & self.coordinates:
                return replace(statement, value=self._kept(statement.value, value))
        return statement

    def _kept(self, value: sp.Expr, usual: sp.Expr) -> sp.Expr:
        """A value in vectors that keeps what it is where a flag holds, if that is a number."""
        if isinstance(value, sp.Piecewise) and value.args[0][0].is_number:
            return sp.Piecewise(value.args[0], (usual, True))
        return usual


def _needed(
    function: Function,
    values: Mapping[sp.Symbol, sp.Expr],
    outputs: Sequence[sp.Expr],
    same: Mapping[sp.Symbol, sp.Expr],
) -> set[sp.Basic]:
    """The names on which the results and the conditions depend."""
    needed = {s for e in outputs for s in followed(e, same).free_symbols}
    for statement in reversed(function.body):
        name = getattr(statement, "symbol", None)
        if name in values and (name in needed or isinstance(statement, Bound)):
            needed |= values[name].free_symbols
    return needed


def simplest_first(term: sp.Expr) -> tuple[bool, int, bool, str]:
    """The order of the terms of a vector: without a factor, with a number, with a name."""
    number = term.as_coeff_Mul()[0]
    return bool(number.is_negative), len(term.free_symbols), bool(abs(number) != 1), str(term)


__all__ = ["InVectors", "Vector", "in_vectors", "is_vector", "simplest_first"]
