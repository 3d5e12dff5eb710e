"""Two lemmas of an inverse that differ in names alone, such as those of two equal arms.

They are recognised by what their names stand for: another choice of symbols makes one value the
other.  What holds of both is told once, of part i; what differs is told of each.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import combinations, pairwise

import sympy as sp

from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.names import is_word
from closedform.emit.backends.latex.plain import angles_of_readers
from closedform.emit.backends.latex.prose import symbol_name
from closedform.model.alike import INDEX
from closedform.model.functions import Vanishes
from closedform.model.lemma import Lemma

Pairs = dict[sp.Symbol, sp.Symbol]


@dataclass(frozen=True)
class Twins:
    """The symbols of the second part for those of the first, and their indices."""

    lemmas: tuple[Lemma, Lemma]
    symbols: Mapping[sp.Symbol, sp.Symbol]
    alike: frozenset[sp.Symbol]
    """The symbols of the first part whose values are those of the second one."""
    indices: tuple[str, str]
    letters: Mapping[sp.Symbol, str]
    """How the names of each part are written."""

    @property
    def second(self) -> frozenset[sp.Symbol]:
        """The symbols of the second part that are told with those of the first."""
        return frozenset(self.symbols[s] for s in self.alike)

    @property
    def apart(self) -> Pairs:
        """The symbols of the second part for those of the first whose values are others."""
        return {s: t for s, t in self.symbols.items() if s not in self.alike}

    @property
    def each(self) -> str:
        """For which parts a line holds."""
        return rf"${INDEX} = \mathrm{{{self.indices[0]}}},\ \mathrm{{{self.indices[1]}}}$"

    @contextmanager
    def as_one(self, printer: Printer) -> Iterator[None]:
        """Print the symbols of the first part with the index i meanwhile."""
        first = re.escape(self.indices[0])
        names = {}
        for s in self.symbols:
            text = printer.doprint(s)
            names[s] = re.sub(rf"(?<=[\^_{{]){first}(?=\}}*$)", INDEX, text)
            if names[s] == text:
                names[s] = f"{text}_{INDEX}"
        with printer.written_as(names):
            yield


def twins(
    lemmas: Sequence[Lemma],
    values: Mapping[sp.Symbol, sp.Expr],
    flags: Mapping[sp.Symbol, Vanishes],
) -> Twins | None:
    """The first two neighbours that find several unknowns by the same lemma in the same way."""
    for a, b in pairwise(lemmas):
        alike = a.name == b.name and len(a.solution) == len(b.solution) > 1 and not a.matrix
        if alike and (found := _matched(a, b, values, flags)):
            return found
    return None


def _matched(
    a: Lemma,
    b: Lemma,
    values: Mapping[sp.Symbol, sp.Expr],
    flags: Mapping[sp.Symbol, Vanishes],
) -> Twins | None:
    unknowns = list(zip(a.solution, b.solution, strict=True))
    angles = zip(angles_of_readers(a), angles_of_readers(b), strict=False)
    symbols: Pairs = {}
    pending = [*unknowns, *angles]
    while pending:
        one, other = pending.pop()
        if one == other or one in symbols or other in symbols.values():
            continue
        symbols[one] = other
        if one in values and other in values:
            pending += _corresponding(values[one], values[other], symbols, values.keys())
    alike = {s for s, t in symbols.items() if s in values and t in values}
    alike = {s for s in alike if values[s].xreplace(symbols) == values[symbols[s]]}
    indices = _difference(*(str(u.name) for u in unknowns[0]))
    if not indices or not {u for u, _ in unknowns} <= alike:
        return None
    marks = {s: t for s, t in combinations(flags, 2) if _same_mark(flags[s], flags[t], symbols)}
    letters: dict[sp.Symbol, str] = {}
    for pair in symbols.items():
        shared = _shared_parts(*pair)
        if shared and pair not in unknowns and not is_word(shared):
            letters |= {s: f"{symbol_name(shared)}_{k}" for s, k in zip(pair, indices, strict=True)}
    return Twins((a, b), {**symbols, **marks}, frozenset(alike | marks.keys()), indices, letters)


def _same_mark(one: Vanishes, other: Vanishes, symbols: Pairs) -> bool:
    """Whether flags are those of the same case of both parts."""
    free = [symbols.get(s, s) for s in one.free] == list(other.free) and one.free != other.free
    return free and bool(one.value.xreplace(symbols) == other.value)


def _corresponding(
    one: sp.Expr, other: sp.Expr, names: Pairs, computed: Set[sp.Symbol]
) -> list[tuple[sp.Symbol, sp.Symbol]]:
    """The further symbols in which two values differ; what is given is the same in both."""
    for found in renamings(one, other, names):
        more = [(s, t) for s, t in found.items() if s not in names]
        if all({s, t} <= computed for s, t in more):
            return more
    return []


def renamings(one: sp.Expr, other: sp.Expr, names: Pairs) -> Iterator[Pairs]:
    """The other symbols for those of an expression that make it another one, ``names`` included.

    Terms and factors that both have stay what they are.
    """
    if one.is_Symbol and other.is_Symbol:
        taken = one in names or other in names.values()
        if names.get(one, one) == other and (one in names or not taken):
            yield names
        elif not taken:
            yield {**names, one: other}
    elif one.func == other.func and len(one.args) == len(other.args):
        if not one.args:
            yield from [names] if one == other else []
        elif one.is_Add or one.is_Mul:
            mine = [a for a in one.args if a not in other.args]
            yield from _in_any_order(mine, [a for a in other.args if a not in one.args], names)
        else:
            yield from _in_order(one.args, other.args, names)


def _in_order(one: Sequence[sp.Expr], other: Sequence[sp.Expr], names: Pairs) -> Iterator[Pairs]:
    if not one:
        yield names
        return
    for found in renamings(one[0], other[0], names):
        yield from _in_order(one[1:], other[1:], found)


def _in_any_order(
    one: Sequence[sp.Expr], other: Sequence[sp.Expr], names: Pairs
) -> Iterator[Pairs]:
    if not one:
        yield names
        return
    for k, e in enumerate(other):
        for found in renamings(one[0], e, names):
            yield from _in_any_order(one[1:], [*other[:k], *other[k + 1 :]], found)


def _shared_parts(one: sp.Symbol, other: sp.Symbol) -> str:
    """What is left of two names without the part in which they differ: N of N_right and N_left."""
    a, b = str(one.name).split("_"), str(other.name).split("_")
    if len(a) != len(b) or sum(x != y for x, y in zip(a, b, strict=True)) != 1:
        return ""
    return "_".join(x for x, y in zip(a, b, strict=True) if x == y)


def _difference(one: str, other: str) -> tuple[str, str] | None:
    """The letters in which names of equal length differ: R and L of theta2R and theta2L."""
    apart = [(x, y) for x, y in zip(one, other, strict=False) if x != y]
    return apart[0] if len(one) == len(other) and len(apart) == 1 else None


__all__ = ["Twins", "renamings", "twins"]
