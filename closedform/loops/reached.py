"""Whether a target is in reach: what is left of an inverse if only its bounds count."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Let, Match, Program, Statement, Vanishes

Kept = Let | Bound | Vanishes


def bounds_of(program: Program) -> Program:
    """What decides whether there is a solution."""
    kept: list[Statement] = []
    needed: set[sp.Basic] = set()
    for statement in reversed(program.body):
        if isinstance(statement, Bound | Match) or (
            isinstance(statement, Let | Vanishes) and statement.symbol in needed
        ):
            needed |= _used(statement)
            kept.insert(0, statement)
    return Program([*kept], program.taken)


def bounds_of_any(program: Program, signs: Sequence[sp.Symbol]) -> Program:
    """What decides whether there is a solution in any working mode.

    A bound that depends on some of the ``signs`` is written for each choice of these; one choice
    has to keep all such bounds.
    """
    p = bounds_of(program)
    chosen_by = signs_of(p.body, signs)
    dependent = [s for s in p.body if isinstance(s, Kept) and chosen_by[s.symbol]]
    if not dependent:
        return p
    p.body = [s for s in p.body if s not in dependent]
    used = [sign for sign in signs if any(sign in chosen_by[s.symbol] for s in dependent)]
    written: dict[tuple[sp.Symbol, str], sp.Symbol] = {}
    reaches = []
    for choice in product((1, -1), repeat=len(used)):
        values: dict[sp.Basic, Any] = dict(zip(used, map(sp.Integer, choice), strict=True))
        ratios = []
        for s in dependent:
            mode = "".join("pm"[values[sign] == -1] for sign in used if sign in chosen_by[s.symbol])
            if (s.symbol, mode) not in written:
                written[s.symbol, mode] = _write(p, s, f"{s.symbol.name}_{mode}", values)
            symbol = written[s.symbol, mode]
            values[s.symbol] = symbol
            if isinstance(s, Bound):
                ratios.append(symbol / substitute(s.scale, values))
                values[s.symbol] = sp.Max(0, symbol)
        reaches.append(sp.Min(*ratios))
    meanings = dict.fromkeys(s.meaning for s in dependent if isinstance(s, Bound))
    p.bound("reached", p.let("reach", sp.Max(*reaches)), sp.S.One, ", or ".join(meanings))
    return p


def export_reach(
    d: Derivation, inside: Program, target: Mapping[str, Any], what: str = "the hand"
) -> None:
    """Export ``workspace_contains``, if anything bounds how far ``what`` can reach."""
    if inside.body:
        d.function(
            "workspace_contains",
            f"Whether {what} can reach the target.",
            target,
            {"inside": sp.true},
            program=inside,
            boolean=True,
        )


def _used(statement: Kept | Match) -> set[sp.Basic]:
    """The symbols on which a statement depends."""
    found = set(statement.value.free_symbols)
    return found if isinstance(statement, Let) else found | statement.scale.free_symbols


def signs_of(
    body: Sequence[Statement], signs: Sequence[sp.Symbol]
) -> dict[sp.Basic, set[sp.Basic]]:
    """On which of some signs each symbol depends, also through others."""
    found: dict[sp.Basic, set[sp.Basic]] = {sign: {sign} for sign in signs}
    for s in body:
        if isinstance(s, Kept):
            found[s.symbol] = set().union(*(found.get(e, set()) for e in _used(s)))
    return found


def _write(p: Program, s: Kept, name: str, values: Mapping[sp.Basic, Any]) -> sp.Symbol:
    """Write a statement again under another name, with some symbols replaced."""
    value = substitute(s.value, values)
    if isinstance(s, Vanishes):
        scale = substitute(s.scale, values)
        return p.vanishes(name, value, scale, s.meaning, s.free, squares=s.squares)
    nonnegative = {"nonnegative": True} if isinstance(s, Let) and s.symbol.is_nonnegative else {}
    return p.let(name, value, **nonnegative)


__all__ = ["bounds_of", "bounds_of_any", "export_reach", "signs_of"]
