"""Two lemmas of an inverse that differ in names alone, such as those of two equal arms.

They are recognised by what their names stand for: another choice of symbols makes one value the
other.  What holds of both is told once, of part i; what differs is told of each.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from contextlib import contextmanager
from dataclasses import dataclass, replace
from itertools import combinations, pairwise

import sympy as sp

from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.names import is_word
from closedform.emit.backends.latex.plain import angles_of_readers
from closedform.emit.backends.latex.prose import symbol_name
from closedform.model.functions import Vanishes
from closedform.model.lemma import Lemma

Pairs = dict[sp.Symbol, sp.Symbol]
Difference = tuple[str, str]
"""The parts in which two names differ: R and L, or 1 and 4."""
WORD = re.compile(r"\\[A-Za-z]+|[A-Za-z][a-z]+|.", re.ASCII)
"""What an index gives way to in a name is one of these, as a whole."""
INDICES = "ijkmn"


@dataclass(frozen=True)
class Twins:
    """The symbols of the second part for those of the first, and their indices."""

    lemmas: tuple[Lemma, Lemma]
    symbols: Mapping[sp.Symbol, sp.Symbol]
    alike: frozenset[sp.Symbol]
    """The symbols of the first part whose values are those of the second one."""
    differences: tuple[Difference, ...]
    """In what the unknowns of the parts differ, in their order."""
    letters: Mapping[sp.Symbol, str]
    """How the names of each part are written."""
    names: Sequence[str] = INDICES
    """The indices that stand for the differences."""

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
        names = self.names[: len(self.differences)]
        parts = [_tuple([_upright(d[k]) for d in self.differences]) for k in range(2)]
        return rf"${_tuple(names)} = {parts[0]},\ {parts[1]}$"

    def beside(self, texts: Iterable[str]) -> Twins:
        """The same, with indices that no name has, in either case: r_i and r_I look alike."""
        found = {w.lower() for t in texts for w in WORD.findall(t.partition("_")[2])}
        free = [i for i in INDICES if i not in found]
        return replace(self, names=(*free, *(i for i in INDICES if i in found)))

    @contextmanager
    def as_one(self, printer: Printer) -> Iterator[None]:
        """Print the symbols of the first part with an index meanwhile."""
        texts = {s: (printer.doprint(s), printer.doprint(t)) for s, t in self.symbols.items()}
        with printer.written_as({s: self._indexed(*pair) for s, pair in texts.items()}):
            yield

    def _indexed(self, one: str, other: str) -> str:
        """One name for two: an index takes the place of what differs, or is added."""
        for name, difference in zip(self.names, self.differences, strict=False):
            words = WORD.findall(one)
            if _difference(words, WORD.findall(other)) == difference:
                k = next(k for k, w in enumerate(words) if w != WORD.findall(other)[k])
                text = "".join([*words[:k], name, *words[k + 1 :]])
                return text.replace(rf"\mathrm{{{name}}}", name)
        return _with(one, self.names[0])


def _with(name: str, index: str) -> str:
    """A name with one more index."""
    base, mark, before = name.partition("_")
    before = before.removeprefix("{").removesuffix("}")
    return f"{base}_{{{before},{_upright(index)}}}" if mark else f"{base}_{_upright(index)}"


def _upright(index: str) -> str:
    """An index of several letters in upright type."""
    return index if len(index) == 1 else rf"\mathrm{{{index}}}"


def _tuple(texts: Sequence[str]) -> str:
    listed = r",\ ".join(texts)
    return listed if len(texts) == 1 else f"({listed})"


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
    names = [[WORD.findall(str(u.name)) for u in pair] for pair in unknowns]
    differences = tuple(dict.fromkeys(d for pair in names if (d := _difference(*pair))))
    told = {u for u, _ in unknowns} <= alike
    if not told or not all(_difference(*pair) for pair in names):
        return None
    marks = {s: t for s, t in combinations(flags, 2) if _same_mark(flags[s], flags[t], symbols)}
    letters: dict[sp.Symbol, str] = {}
    for pair in symbols.items():
        shared = _shared_parts(*pair)
        if shared and pair not in unknowns and not is_word(shared):
            ends = zip(pair, differences[0], strict=True)
            letters |= {s: _with(symbol_name(shared), end) for s, end in ends}
    return Twins(
        (a, b), {**symbols, **marks}, frozenset(alike | marks.keys()), differences, letters
    )


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


def _difference(one: Sequence[str], other: Sequence[str]) -> Difference | None:
    """The words in which two names differ, if they differ in one."""
    apart = [(x, y) for x, y in zip(one, other, strict=False) if x != y]
    return apart[0] if len(one) == len(other) and len(apart) == 1 else None


__all__ = ["Twins", "renamings", "twins"]
