"""The bounds of an inverse in all of its branches, which are evaluated together.

What several branches have in common, such as the joints that are solved first, is evaluated once.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.algebra.balls import Undetermined, to_float
from closedform.algebra.scope import Case
from closedform.check.rows import RowEvaluator, crosses
from closedform.model.cached import KEPT
from closedform.model.expressions import free_symbols, substitute
from closedform.model.functions import Bound, Function, Let, Match, Vanishes

Array = NDArray[Any]


def flags_of(function: Function) -> list[sp.Symbol]:
    return [s.symbol for s in function.body if isinstance(s, Vanishes)]


def margins_of(function: Function, kind: type | tuple[type, ...]) -> list[sp.Expr]:
    """The bounds (or the values of flags and matches) over their scales.

    For a match this is minus its size, which is never positive.
    """
    margins = []
    for statement in function.body:
        if isinstance(statement, kind) and isinstance(statement, Bound | Match | Vanishes):
            value = -sp.Abs(statement.value) if isinstance(statement, Match) else statement.value
            margin = value / statement.scale
            if isinstance(statement, Vanishes) and statement.squares:
                margin = sp.sqrt(margin)
            margins.append(margin)
    return margins


def in_cases(
    function: Function,
    symbols: Sequence[sp.Symbol],
    exprs: Iterable[sp.Expr],
    cases: Sequence[Case] | None = None,
) -> RowEvaluator:
    """Expressions in the names of a function, in one case of it after the other.

    All flags are taken as false, and values that are chosen only where one holds are left out.
    """
    flags = dict.fromkeys(flags_of(function), sp.false)
    made = [s for s in function.body if isinstance(s, Let | Bound)]
    named = {s.symbol: substitute(s.value, flags) for s in made}
    chosen = tuple(substitute(e, flags) for e in exprs)
    used: set[Any] = set()
    pending = free_symbols(chosen)
    while pending:
        used |= pending
        pending = free_symbols([named[n] for n in pending & named.keys()]) - used
    kept = tuple((n, value) for n, value in named.items() if n in used)
    signs = _signs(function) if cases is None else cases
    ruling = tuple(tuple((s, v) for s, v in case.items() if s in used) for case in signs)
    return _shared(tuple(symbols), chosen, kept, ruling)


@lru_cache(KEPT)
def _shared(
    symbols: tuple[sp.Symbol, ...],
    exprs: tuple[sp.Expr, ...],
    named: tuple[tuple[sp.Symbol, sp.Basic], ...],
    cases: tuple[tuple[tuple[sp.Symbol, int], ...], ...],
) -> RowEvaluator:
    """One evaluator for all functions with the same expressions, which keeps the Arb results."""
    return RowEvaluator(symbols, exprs, dict(named), [dict(case) for case in cases])


def _signs(function: Function) -> list[Case]:
    return [signs for _, signs in function.cases()]


class Margins:
    """The bounds and the matches of each branch over their scales, at many targets."""

    def __init__(self, function: Function, symbols: Sequence[sp.Symbol]) -> None:
        self._function, self._symbols = function, symbols
        self._cases = _signs(function)
        bounds, matches = margins_of(function, Bound), margins_of(function, Match)
        self._exprs, self._bounds = [*bounds, *matches], len(bounds)
        self._joint = in_cases(function, symbols, self._exprs)
        self._alone: dict[tuple[int, bool], RowEvaluator] = {}

    def prepare(self, batches: Iterable[Array]) -> None:
        """Evaluate many batches of targets together."""
        if self._exprs:
            self._joint.prepare(batches)

    def least(self, rows: Array, *limits: float) -> tuple[Array, Array]:
        """The smallest bound and the smallest match of each branch; 1 if there are none.

        It is NaN where all are defined only for a case that a flag excludes.  If one is provably
        below all limits, the others are not evaluated exactly: they may depend on its root.
        """
        shape = (len(rows), len(self._cases), len(self._exprs))
        middle, radius = (x.reshape(shape) for x in self._joint.balls(rows))
        middle, undecided = middle.copy(), np.zeros(shape, bool)
        for group in self._groups():
            part, error = middle[..., group], radius[..., group]
            with np.errstate(invalid="ignore"):
                below = (part + error < min(limits)).any(axis=-1, keepdims=True)
            opened = crosses(*limits)(part, error).any(axis=-1, keepdims=True)
            undecided[..., group] = opened & ~below
        for row in np.flatnonzero(undecided.any(axis=(1, 2))):
            self._settle(rows[row], middle[row], undecided[row])
        found = (np.fmin.reduce(middle[..., g], axis=-1, initial=np.nan) for g in self._groups())
        bounds, matches = (
            least if g.stop > g.start else np.ones(shape[:2])
            for least, g in zip(found, self._groups(), strict=True)
        )
        return bounds, matches

    def _groups(self) -> tuple[slice, slice]:
        return slice(0, self._bounds), slice(self._bounds, len(self._exprs))

    def _settle(self, row: Array, values: Array, undecided: Array) -> None:
        """Evaluate what is undecided at one target in Arb; NaN where that is not possible."""
        wanted = np.flatnonzero(undecided)
        try:
            values.flat[wanted] = list(map(to_float, self._joint.exactly(row, wanted)))
            return
        except Undetermined:  # of one branch or one kind, so each is tried alone
            pass
        for case, is_open in enumerate(undecided):
            for group in self._groups():
                if is_open[group].any():
                    alone = self._evaluator(case, group)
                    try:
                        values[case, group] = list(map(to_float, alone.exactly(row)))
                    except Undetermined:
                        values[case, group] = np.nan

    def _evaluator(self, case: int, group: slice) -> RowEvaluator:
        key = case, group.start == 0
        if key not in self._alone:
            exprs, cases = self._exprs[group], [self._cases[case]]
            self._alone[key] = in_cases(self._function, self._symbols, exprs, cases)
        return self._alone[key]


__all__ = ["Margins", "flags_of", "in_cases", "margins_of"]
