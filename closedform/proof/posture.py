"""The values of all names of an inverse at a posture whose image is the target."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import sympy as sp

from closedform.algebra.expressions import linear_root
from closedform.model.expressions import free_symbols, parts, replaced, substitute
from closedform.model.functions import Bound, Function, Let, Vanishes
from closedform.model.inverse import Combination, Inverse, Rank

Expr = Any


class Posture:
    """The values of the names of a chain, whose glue is a rank; flags are false."""

    def __init__(self, inverse: Inverse, glue: Rank, function: Function):
        self.sums: dict[Expr, Expr] = {}
        taken: set[Expr] = set()
        for symbol, value in sorted(
            glue.defined.items(), key=lambda item: sum(item[1].has(j) for j in inverse.unknowns)
        ):
            # a sum replaces its newest joint that no shorter one does; only single angles remain
            held = [j for j in inverse.unknowns if value.has(j) and j not in taken]
            if held:
                taken.add(held[-1])
                # a sum may contain the sine and cosine of a given joint
                total = linear_root(value - symbol, held[-1])
                self.sums[held[-1]] = substitute(total, glue.meaning)
        self.names: dict[Expr, Expr] = {}
        self.extra_coordinates = glue.extra_coordinates
        self.meaning = glue.meaning
        self.made = {s.symbol: s.value for s in function.body if isinstance(s, (Let, Bound))}
        self.flags = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
        images = dict(zip(inverse.targets, inverse.forward, strict=True))
        # a sum may contain a given joint, as the direction of a link that this joint makes longer
        given = {x: self.in_sums(f) for x, f in images.items() if f in inverse.unknowns}
        self.targets = {x: substitute(self.in_sums(f), given) for x, f in images.items()}
        self.lengths = {s: substitute(self.in_sums(e), given) for s, e in glue.lengths.items()}

    def in_sums(self, e: Expr) -> Expr:
        for _ in self.sums:
            e = substitute(e, self.sums)
        return e

    def named(self, e: Expr) -> Expr:
        """An expression in terms of the unknowns and the target only."""
        return self.in_sums(self._written_out(e, self.names))

    def in_coordinates(self, e: Expr) -> Expr:
        """The same, with the names that count as coordinates of the target."""
        return self.in_sums(self._written_out(e, {s: s for s in self.extra_coordinates}))

    def _written_out(self, e: Expr, names: dict[Expr, Expr]) -> Expr:
        e = substitute(e, self.flags)
        for s in e.free_symbols:
            if s not in names and (s in self.meaning or s in self.made):
                names[s] = self._written_out(self.meaning.get(s, self.made.get(s)), names)
        return substitute(e, names)

    def __call__(self, e: Expr) -> Expr:
        """The value of an expression at a posture, with its image as the target."""
        return substitute(substitute(self.named(e), self.lengths), self.targets)


def meanings(function: Function, inverse: Inverse, glue: Combination) -> dict[Expr, Expr]:
    """The values of the names of a program in inputs, parameters and unknowns of the lemmas.

    Flags are false, as in every proof of the generic case.  Only the values that the equations of
    the lemmas depend on are written out, because those of other cases may be large.
    """
    known: dict[Expr, Expr] = {}
    inside: set[int] = set()
    roots: list[Expr] = list(glue.joints.values())
    for link in inverse.links:
        known |= link.means
        roots += link.means.values()
        inside |= {id(s) for s in link.body}
        roots += link.equations
        if link.lemma:
            premises = link.lemma.premises
            roots += [*premises, *premises.values(), *link.lemma.signs]
    flags = {s.symbol: sp.false for s in function.body if isinstance(s, Vanishes)}
    values = {
        s.symbol: substitute(s.value, flags)
        for s in function.body
        if isinstance(s, (Let, Bound)) and id(s) not in inside
    }
    needed = free_symbols(roots)
    for symbol, value in reversed(values.items()):
        if symbol in needed:
            needed |= free_symbols([value]) - known.keys()
    known |= flags
    for symbol in [s for s in values if s in needed]:
        known[symbol] = substitute(values[symbol], known)
    # what a lemma returns may mean something in its coefficients, such as a length
    means = [meaning for link in inverse.links for meaning in link.means.values()]
    coefficients = {s: known[s] for s in free_symbols(means) if s in values}
    return {s: substitute(e, coefficients) for s, e in known.items()}


def outcomes(expr: Expr) -> Iterator[Expr]:
    """The values of an expression for all outcomes of its choices between sides."""
    inside = parts(expr if isinstance(expr, sp.MatrixBase) else [expr])
    chosen = (p for p in inside if isinstance(p, sp.Piecewise))
    choices = [c for p in chosen for _, c in p.args if c.is_Relational]
    if not choices:
        yield expr
        return
    for holds in (sp.true, sp.false):
        yield from outcomes(replaced(expr, choices[0], holds))


def generic(expr: Expr) -> Expr:
    """The expression with the first case of choices between sides and the last of those by flag."""
    cases = {
        p: p.args[0 if p.args[0][1].is_Relational else -1][0] for p in expr.atoms(sp.Piecewise)
    }
    return generic(expr.xreplace(cases)) if cases else expr


__all__ = ["Posture", "generic", "meanings", "outcomes"]
