"""The lemmas of an inverse, each with its equations and unknowns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.model.derivation import Solved
from closedform.model.inverse import Inverse, Link, Rank
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Solving:
    """A lemma applied: its equations, its unknowns, and what it handed on."""

    lemma: Lemma
    equations: tuple[sp.Expr, ...]
    unknowns: tuple[sp.Symbol, ...]
    link: Link | None = None


def solvings(inverse: Inverse, solved: Sequence[Solved]) -> list[Solving]:
    """The lemmas of an inverse, in their order."""
    if isinstance(inverse.glue, Rank) or not solved:
        return [
            Solving(link.lemma, link.lemma.equations, tuple(link.lemma.solution), link)
            for link in inverse.links
            if link.lemma
        ]
    found = []
    for s in solved:
        others = {o.unknown for o in solved if o is not s}
        sought = {*inverse.unknowns, *inverse.passive}
        joints = [u for u in s.lemma.solution if u in sought and u not in others]
        unknowns = tuple(dict.fromkeys((s.unknown, *joints)))
        equations = s.lemma.equations if len(unknowns) > 1 else (s.equation,)
        found.append(Solving(s.lemma, equations, unknowns))
    return found


__all__ = ["Solving", "solvings"]
