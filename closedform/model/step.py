"""A step of a derivation: what is derived, and the identities that prove it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias

import sympy as sp

from closedform.model.display import Shown
from closedform.model.functions import reject_floats

Pairs: TypeAlias = "Sequence[tuple[Any, Any]]"


@dataclass(frozen=True)
class Step(Shown):
    """One step: its reason, the derived expressions, and the differences that must vanish.

    The left-hand sides in ``shown`` are LaTeX; the other texts are plain.
    """

    title: str
    reason: str
    shown: tuple[tuple[str, Any], ...]
    published: tuple[str, ...] = ()
    differences: Callable[[], tuple[Any, ...]] = tuple
    """Gives what must vanish.  It is called when a proof or a page needs it."""
    nonnegative: tuple[sp.Expr, ...] = ()
    rows: tuple[tuple[Any, ...], ...] = ()
    """The rows of a table; the first is its head.  A cell is a sentence, an expression or an
    increasing chain of expressions, such as ``(0, x, 1)`` for 0 <= x <= 1."""
    proves: str = ""
    """What the vanishing differences mean, in sentences."""
    uses: tuple[Step, ...] = ()
    """Earlier steps whose equations this one rests on."""
    solves: tuple[tuple[str, tuple[sp.Symbol, ...]], ...] = ()
    """The inverses that this step gives reasons for, and the unknowns whose solution it explains;
    without unknowns, it explains the inverse as a whole."""

    @cached_property
    def vanishes(self) -> tuple[Any, ...]:
        """The differences that must vanish."""
        return self.differences()


def differences(pairs: Pairs, where: str) -> tuple[Any, ...]:
    """The difference of each pair, none of which may contain a float."""
    check_exact([side for pair in pairs for side in pair], where)
    return tuple(a - b for a, b in pairs)


def check_exact(values: Sequence[Any], where: str) -> None:
    """Raise ``TypeError`` if a value is a float or contains one."""
    for value in values:
        for part in value if isinstance(value, list | tuple) else [value]:
            if isinstance(part, float):
                raise TypeError(
                    f"{where}: {part} is a float; write an integer or sympy.Rational('{part}')"
                )
            if isinstance(part, sp.Basic | sp.MatrixBase):
                for entry in part if isinstance(part, sp.MatrixBase) else [part]:
                    reject_floats(entry, where)


__all__ = ["Pairs", "Step", "check_exact", "differences"]
