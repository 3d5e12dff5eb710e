"""What an algorithm tells: a function, or the part of it that each of several alike legs has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import sympy as sp

from closedform.model.alike import INDEX, Alike, renamed, symbols_in, with_index
from closedform.model.derivation import Derivation, Solved
from closedform.model.functions import (
    Array,
    Bound,
    Branches,
    Determined,
    Function,
    Let,
    Statement,
    Vanishes,
)
from closedform.model.inverse import Inverse
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Subject:
    """A function with its inverse and its lemmas; ``each`` says for which legs it is told."""

    function: Function
    inverse: Inverse | None
    solved: tuple[Solved, ...]
    each: str = ""

    @classmethod
    def of(cls, derivation: Derivation, function: Function) -> Subject:
        """The function, or leg i of it if its legs are alike and each is computed alone."""
        inverse = next((i for i in derivation.inverses if i.function == function.name), None)
        solved = tuple(s for s in derivation.solved if s.function == function.name)
        whole = cls(function, inverse, solved)
        if derivation.alike is None:
            return whole
        return _Legs(derivation.alike, function).subject(whole) or whole

    @property
    def lemmas(self) -> list[Lemma]:
        """The lemmas of the function, and those of the links of its inverse."""
        links = self.inverse.links if self.inverse else ()
        return [s.lemma for s in self.solved] + [k.lemma for k in links if k.lemma]


class _Legs:
    """A function taken apart: the statements of each leg, and what the legs share."""

    def __init__(self, alike: Alike, function: Function):
        self.alike, self.function = alike, function
        self.legs = range(len(alike.symbols))
        self.owners: dict[sp.Basic, frozenset[int]] = {
            s: frozenset([k]) for k in self.legs for s in alike.symbols[k]
        }
        self.shared: list[Statement] = []
        self.own: list[list[Statement]] = [[] for _ in self.legs]
        self.together: list[Statement] = []
        self.same: dict[sp.Symbol, sp.Symbol] = {}
        """Names for what an earlier name stands for: one height of the hand serves all legs."""
        for statement in function.body:
            self._sort(renamed(statement, self.same))
        self.names: list[dict[sp.Symbol, sp.Symbol]] = [alike.names(k) for k in self.legs]

    def _owners(self, value: Any) -> frozenset[int]:
        return frozenset().union(*(self.owners.get(s, frozenset()) for s in symbols_in(value)))

    def _sort(self, statement: Statement) -> None:
        legs = self._owners(statement)
        if isinstance(statement, Let | Bound | Vanishes):
            self.owners[statement.symbol] = legs
        if len(legs) > 1 or isinstance(statement, Determined):
            self.together.append(statement)
        elif legs:
            self.own[next(iter(legs))].append(statement)
        elif isinstance(statement, Let) and (twin := self._twin(statement)):
            self.same[statement.symbol] = twin
        else:
            self.shared.append(statement)

    def _twin(self, statement: Let) -> sp.Symbol | None:
        """The name of what is shared and has the value of a statement."""
        known = (s for s in self.shared if isinstance(s, Let))
        return next((s.symbol for s in known if s.value == statement.value), None)

    def subject(self, whole: Subject) -> Subject | None:
        """What is told of leg i, if the statements and the results of all legs are alike."""
        if not all(isinstance(s, Let | Determined) for s in self.together):
            return None
        first, *others = self.own
        if not first or any(len(o) != len(first) for o in others):
            return None
        for row in zip(*self.own, strict=True):
            symbols = [s.symbol for s in row if isinstance(s, Let | Bound | Vanishes)]
            if symbols:
                name = with_index(symbols)
                for k, symbol in enumerate(symbols):
                    self.names[k][symbol] = name
        told = [renamed(tuple(own), names) for own, names in zip(self.own, self.names, strict=True)]
        outputs = self._outputs()
        if outputs is None or any(t != told[0] for t in told):
            return None
        kept = (*self.shared, *told[0], *(s for s in self.together if isinstance(s, Determined)))
        unknowns = whole.inverse.unknowns if whole.inverse else ()
        function = replace(
            self.function,
            body=kept,
            outputs=outputs,
            branches=self._branches(),
            entries=tuple(self.names[0][u] for u in unknowns if u in self.names[0]),
        )
        numbers = r",\ ".join(str(k + 1) for k in self.legs)
        each = rf"each {self.alike.kind} ${INDEX} = {numbers}$"
        return Subject(function, self._inverse(whole.inverse), self._solved(whole.solved), each)

    def _outputs(self) -> tuple[Array, ...] | None:
        """The results of leg i; a truth value is that of all legs."""
        found = []
        for array in self.function.outputs:
            if array.entries == (sp.true,):
                found.append(array)
                continue
            if len(array.entries) != len(self.legs):
                return None
            entries = renamed(array.entries, self.same)
            each = [renamed(e, n) for e, n in zip(entries, self.names, strict=True)]
            if any(e != each[0] for e in each) or self._owners(entries[0]) != {0}:
                return None
            found.append(replace(array, shape=(1,), entries=(each[0],)))
        return tuple(found)

    def _branches(self) -> Branches | None:
        """The signs of leg i."""
        given = self.function.branches
        if given is None:
            return None
        own = self.names[0]
        cases: dict[tuple[tuple[sp.Symbol, int], ...], str] = {}
        for label, signs in self.function.cases():
            cases.setdefault(tuple((own[s], v) for s, v in signs.items() if s in own), label)
        return Branches(tuple(cases.values()), tuple(map(dict, cases)))

    def _inverse(self, inverse: Inverse | None) -> Inverse | None:
        if inverse is None:
            return None
        unknowns = tuple(u for u in inverse.unknowns if u in self.names[0])
        links = tuple(x for x in inverse.links if {*x.unknowns} <= {*unknowns})
        kept = replace(inverse, unknowns=unknowns, links=links)
        return renamed(kept, {**self.same, **self.names[0]})

    def _solved(self, solved: Sequence[Solved]) -> tuple[Solved, ...]:
        own = [s for s in solved if s.unknown in self.names[0]]
        return tuple(renamed(s, {**self.same, **self.names[0]}) for s in own)


__all__ = ["Subject"]
