"""What a lemma that was applied to a chain hands on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import sympy as sp

from closedform.model.derivation import Degenerate
from closedform.model.lemma import Lemma


@dataclass(frozen=True)
class Applied:
    """A lemma applied: what it hands on, and what the names it made stand for."""

    lemma: Lemma
    result: Any
    means: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    given: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    degenerate: tuple[Degenerate, ...] = ()
