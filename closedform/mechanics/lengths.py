"""The lengths of a mechanism that are numbers, not parameters."""

from __future__ import annotations

from collections.abc import Mapping

import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Let


def lengths_in_numbers(place: sp.Expr, names: Mapping[sp.Basic, sp.Expr] | None = None) -> sp.Expr:
    """The lengths in a coordinate that are numbers, not parameters: 3 in 3 cos(theta).

    ``names`` are those of values for which the same is known.
    """
    names = names or {}
    total = sp.S.Zero
    for term in sp.Add.make_args(sp.expand(place)):
        size, rest = term.as_independent(*term.free_symbols, as_Add=False)
        for base, _ in (f.as_base_exp() for f in sp.Mul.make_args(rest) if f != 1):
            size *= 1 if isinstance(base, sp.sin | sp.cos) else names.get(base, 0)
        total += abs(size)
    return total


def numbers_of_tool(derivation: Derivation) -> list[float]:
    """For each coordinate of the tool, the lengths in it that are numbers."""
    found = []
    for pose in (f for f in derivation.functions if f.name == "pose"):
        names: dict[sp.Basic, sp.Expr] = {}
        for statement in pose.body:
            if isinstance(statement, (Let, Bound)):
                names[statement.symbol] = lengths_in_numbers(statement.value, names)
        places = pose.outputs[0].entries[3:12:4]
        found += [float(lengths_in_numbers(place, names)) for place in places]
    return found


__all__ = ["lengths_in_numbers", "numbers_of_tool"]
