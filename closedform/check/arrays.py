"""Expressions evaluated at many points at once, in the widest float type that NumPy has.

The values are not rigorous; they show which points are worth an evaluation in Arb.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from functools import reduce
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.model.functions import Bound, Function, Let, Vanishes
from closedform.model.tolerances import DOUBLE

Array = NDArray[Any]
WIDE = np.longdouble


class ArrayEvaluator:
    """Values of expressions in ``known`` symbols; each part is evaluated at most once.

    The names of a function's body may be used too.  Its flags are false.  A bound that is negative
    because of rounding counts as zero; one that is more negative is NaN.
    """

    def __init__(self, known: Mapping[sp.Symbol, Any], function: Function | None = None):
        self._known: dict[sp.Basic, Any] = {s: np.asarray(v, WIDE) for s, v in known.items()}
        body = function.body if function else ()
        self._named = {s.symbol: s for s in body if isinstance(s, (Let, Bound, Vanishes))}

    def __call__(self, e: sp.Basic) -> Any:
        if e not in self._known:
            self._known[e] = self._value(e)
        return self._known[e]

    def _value(self, e: sp.Basic) -> Any:
        if e in self._named:
            return self._of_statement(self._named[e])
        if e.is_Rational:
            return WIDE(int(e.p)) / WIDE(int(e.q))
        if e is sp.pi:
            return 4 * np.arctan(WIDE(1))
        if e in (sp.true, sp.false):
            return bool(e)
        if isinstance(e, sp.Piecewise):
            return self._chosen(e)
        if e.is_Pow:
            return _power(self(e.base), e.exp)
        function = next(f for kind, f in _FUNCTIONS.items() if isinstance(e, kind))
        return function(*map(self, e.args))

    def _of_statement(self, statement: Let | Bound | Vanishes) -> Any:
        if isinstance(statement, Vanishes):
            return False
        value = self(statement.value)
        if isinstance(statement, Bound):
            slack = DOUBLE.feasibility * self(statement.scale)
            return np.where(value < -slack, WIDE("nan"), np.maximum(value, 0))
        return value

    def _chosen(self, e: sp.Piecewise) -> Any:
        value: Any = WIDE("nan")
        for branch, condition in reversed(e.args):
            holds = self(condition)
            if isinstance(holds, bool):
                value = self(branch) if holds else value
            else:
                value = np.where(holds, self(branch), value)
        return value


def _power(base: Any, exponent: sp.Rational) -> Any:
    """The power, from roots and products, which are much faster."""
    root = np.sqrt(base) if exponent.q == 2 else base
    if exponent.q > 2:
        return base ** (WIDE(int(exponent.p)) / int(exponent.q))
    raised = reduce(operator.mul, [root] * abs(int(exponent.p)))
    return raised if exponent.p > 0 else 1 / raised


_FUNCTIONS: dict[Any, Callable[..., Any]] = {
    sp.Add: lambda *a: reduce(operator.add, a),
    sp.Mul: lambda *a: reduce(operator.mul, a),
    sp.sin: np.sin,
    sp.cos: np.cos,
    sp.tan: np.tan,
    sp.atan: np.arctan,
    sp.asin: np.arcsin,
    sp.acos: np.arccos,
    sp.atan2: np.arctan2,
    sp.Abs: np.abs,
    sp.sign: np.sign,
    sp.Max: lambda *a: reduce(np.maximum, a),
    sp.Min: lambda *a: reduce(np.minimum, a),
    sp.Ge: operator.ge,
    sp.Gt: operator.gt,
    sp.Le: operator.le,
    sp.Lt: operator.lt,
    sp.Eq: operator.eq,
    sp.Ne: operator.ne,
    sp.Not: np.logical_not,
    sp.And: lambda *a: reduce(operator.and_, a),
    sp.Or: lambda *a: reduce(operator.or_, a),
}


def columns(
    exprs: Sequence[sp.Expr],
    symbols: Sequence[sp.Symbol],
    rows: Array,
    function: Function | None = None,
) -> Array:
    """The expressions at each of ``rows``, which hold values of the symbols; NaN if undefined."""
    evaluate = ArrayEvaluator(dict(zip(symbols, rows.T, strict=True)), function)
    with np.errstate(all="ignore"):
        found = [np.broadcast_to(evaluate(e), len(rows)) for e in exprs]
    return np.stack(found, axis=-1) if found else np.empty((len(rows), 0), WIDE)
