"""The parts of expressions and substitution; each part is visited once, which SymPy does not do."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from itertools import islice
from typing import Any

import sympy as sp

SIMPLE = 50
"""The largest number of nodes of an argument that SymPy may compare with the other arguments."""


def parts(exprs: Iterable[sp.Basic]) -> dict[sp.Basic, None]:
    """All expressions that others consist of, and these; one that occurs many times is there once.

    SymPy visits it as often as it occurs, in a long chain of names thousands of times.
    """
    found: dict[sp.Basic, None] = {}
    pending = list(exprs)
    while pending:
        e = pending.pop()
        if e not in found:
            found[e] = None
            pending += e.args
    return found


def free_symbols(exprs: Iterable[sp.Basic]) -> set[Any]:
    """The symbols in expressions."""
    return {e for e in parts(exprs) if e.is_Symbol}


def substitute(expr: sp.Basic, known: Mapping[sp.Basic, sp.Basic]) -> Any:
    """Replace symbols simultaneously, in each part of the expression once."""
    inside = parts([expr])
    images = {e: known[e] for e in inside if e.is_Symbol and e in known}
    if not images:
        return expr
    return _image(expr, images)


def replaced(expr: sp.Basic, old: sp.Basic, new: sp.Basic) -> Any:
    """Replace a part of an expression or of a matrix, in each part that contains it once."""
    images = {old: new}
    if isinstance(expr, sp.MatrixBase):
        return expr.applyfunc(lambda e: _image(e, images))
    return _image(expr, images)


def _image(expr: sp.Basic, images: dict[sp.Basic, Any]) -> Any:
    """The image of an expression, which is kept with those of its parts.

    SymPy factors the arguments of a new ``Max`` or ``Min`` and expands that of a new ``Abs``.  For
    large arguments this takes a minute and finds nothing, so it is not done.
    """
    if expr in images:
        return images[expr]
    if not expr.args:
        return expr
    args = [_image(a, images) for a in expr.args]
    found: Any = expr
    if any(new is not old for new, old in zip(args, expr.args, strict=True)):
        costly = isinstance(expr, sp.Max | sp.Min | sp.Abs)
        if costly and not all(map(_is_simple, args)):
            found = expr.func(*args, evaluate=False)
        else:
            found = expr.func(*args)
    images[expr] = found
    return found


def _is_simple(expr: sp.Basic) -> bool:
    return sum(1 for _ in islice(sp.preorder_traversal(expr), SIMPLE + 1)) <= SIMPLE


__all__ = ["SIMPLE", "free_symbols", "parts", "replaced", "substitute"]
