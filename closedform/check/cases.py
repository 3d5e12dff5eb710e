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
from closedform.check.rows import WIDE, RowEvaluator, crosses
from closedform.model.cached import KEPT, cached
from closedform.model.expressions import free_symbols, substitute
from closedform.model.functions import Bound, Function, Let, Match, Vanishes

Array = NDArray[Any]


def flags_of(function: Function) -> list[sp.Symbol]:
    return [s.symbol for s in function.body if isinstance(s, Vanishes)]


def margins_of(function: Function, kind: type | tuple[type, ...]) -> list[sp.Expr]:
    """The bounds (or the values of flags and matches) over their scales.

    For a match this is minus its size, which is never positive.  A flag without a scale has none:
    it compares two values that are the same but for rounding.
    """
    margins = []
    for statement in function.body:
        if isinstance(statement, Vanishes) and statement.scale == 0:
            continue
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
    flags, named, inside = _names_of(function)
    chosen = tuple(substitute(e, flags) for e in exprs)
    used: set[Any] = set()
    pending = free_symbols(chosen)
    while pending:
        used |= pending
        pending = set().union(*(inside[n] for n in pending & named.keys())) - used
    kept = tuple((n, value) for n, value in named.items() if n in used)
    signs = _signs(function) if cases is None else cases
    ruling = tuple(tuple((s, v) for s, v in case.items() if s in used) for case in signs)
    return _shared(tuple(symbols), chosen, kept, ruling)


@cached
def _names_of(
    function: Function,
) -> tuple[dict[sp.Basic, Any], dict[sp.Symbol, Any], dict[sp.Symbol, set[Any]]]:
    """The flags of a function, all false; its names with their values; the symbols in these."""
    flags = dict.fromkeys(flags_of(function), sp.false)
    made = [s for s in function.body if isinstance(s, Let | Bound)]
    named = {s.symbol: substitute(s.value, flags) for s in made}
    return flags, named, {name: free_symbols([value]) for name, value in named.items()}


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
    """The bounds and the matches of each branch over their scales, at many targets.

    The matches count only if they are ``matched``.
    """

    def __init__(
        self, function: Function, symbols: Sequence[sp.Symbol], *, matched: bool = True
    ) -> None:
        self._function, self._symbols = function, symbols
        self._cases = _signs(function)
        bounds = margins_of(function, Bound)
        matches = margins_of(function, Match) if matched else []
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

    def inside(self, rows: Array) -> Array:
        """Roughly the smallest bound of the branch for which this is the largest."""
        shape = (len(rows), len(self._cases), len(self._exprs))
        middle = self._joint.values(rows).reshape(shape)
        with np.errstate(invalid="ignore"):
            least = np.where(np.isfinite(middle), middle, -np.inf).min(axis=2, initial=np.inf)
        return np.asarray(least.max(axis=1))

    def explained(self, rows: Array, slack: float, rounding: float) -> Array:
        """For each branch, whether relative errors of a ``rounding`` explain that it is taken.

        Each bound that is less than ``-slack`` may then be as large as that.
        """
        shape = (len(rows), len(self._cases), len(self._exprs))
        middle, radius = (x.reshape(shape) for x in self._joint.balls(rows))
        off = radius * (rounding / np.finfo(WIDE).eps)
        with np.errstate(invalid="ignore"):
            return np.asarray(~((middle < -slack) & ~(middle + off >= -slack)).any(axis=-1))

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


class Flags:
    """The flags of a function in all of its cases, at many points.

    A flag may be the same in several cases, because it belongs to an unknown that is solved before
    they part.  Each is evaluated once.
    """

    def __init__(self, function: Function, symbols: Sequence[sp.Symbol]) -> None:
        flags, cases = margins_of(function, Vanishes), _signs(function)
        self._joint = in_cases(function, symbols, flags)
        every = ((case, flag) for case in cases for flag in flags)
        self._alone: dict[RowEvaluator, int] = {}
        for column, (case, flag) in enumerate(every):
            self._alone.setdefault(in_cases(function, symbols, [flag], [case]), column)

    def prepare(self, batches: Iterable[Array]) -> None:
        """Evaluate many batches of points together."""
        if self._alone:
            self._joint.prepare(batches)

    def raised(self, rows: Array, limit: float, wanted: Array | None = None) -> Array:
        """Where a flag is raised; only rows that are ``wanted`` are decided exactly.

        A flag may be defined only where an earlier one is not raised; then each is evaluated alone.
        """
        if not self._alone:
            return np.zeros(len(rows), bool)
        columns = [*self._alone.values()]
        middle, radius = (x[:, columns] for x in self._joint.balls(rows))
        with np.errstate(invalid="ignore"):
            found = np.asarray((middle + radius < limit).any(axis=1))
        undecided = crosses(limit)(middle, radius)
        if wanted is not None:
            undecided &= wanted[:, None]
        for flag, opened in zip(self._alone, undecided.T, strict=True):
            for row in np.flatnonzero(opened & ~found):
                found[row] = flag.alone(rows[row]) < limit
        return found


__all__ = ["Flags", "Margins", "flags_of", "in_cases", "margins_of"]
