"""What a conversion to the normal form records for a certificate."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, TypeAlias

from flint import fmpq_mpoly

Expr: TypeAlias = Any  # SymPy's annotations are partial
Factors: TypeAlias = "list[tuple[fmpq_mpoly, int]]"


@dataclass
class Trace:
    """What a checker needs to repeat the conversion; see :mod:`closedform.algebra.certificates`."""

    steps: list[tuple[Any, ...]] = field(default_factory=list)
    """In order: a name; an angle with its divisor; a root with its radicand; a polynomial that is
    known not to be negative, with the expression and the factors that show it; a root that was
    taken, as an expression and as a product."""
    guards: dict[Expr, bool] = field(default_factory=dict)
    """The assumptions, and whether they contain roots."""
    unwritable: str = ""
    """Why the format cannot express the conversion; empty if it can."""


def terms_of(p: fmpq_mpoly) -> list[list[Any]]:
    """A polynomial as a list of terms: each a coefficient, then generators, each with its power.

    Generators are numbered from the last slot of the ring, which is the oldest.
    """
    return [
        [str(a), *(x for i, n in enumerate(reversed(m)) if n for x in (i, int(n)))]
        for m, a in p.terms()
    ]


def factors_of(factors: Iterable[tuple[fmpq_mpoly, int]]) -> list[list[Any]]:
    """Polynomials, each with its power; a factor of one is left out."""
    return [[terms_of(p), int(n)] for p, n in factors if not p.is_one()]
