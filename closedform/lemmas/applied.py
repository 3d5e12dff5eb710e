"""The result of a lemma that was applied to a chain."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.model.inverse import Degenerate, Relation
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair


@dataclass(frozen=True)
class Applied:
    """A lemma that was applied: its result, and the meanings of the names that it added."""

    lemma: Lemma
    result: Any
    means: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    degenerate: tuple[Degenerate, ...] = ()
    halves: Mapping[sp.Symbol, tuple[Pair, sp.Expr]] = field(default_factory=dict)
    """Angles as that of a pair, which all branches share, plus zero or half a turn."""
    relations: tuple[Relation, ...] = ()
