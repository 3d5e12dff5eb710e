"""What a lemma is: equations, and the closed forms that solve them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp

from closedform.model.functions import Statement


@dataclass(frozen=True)
class Lemma:
    """A lemma applied: ``equations`` vanish at ``solution`` (unknown -> closed form).

    ``excluded`` solutions of the equations violate the inequality that ``statement`` names.
    ``means`` holds names for the steps that follow, and what they are in the unknowns: cosine and
    sine of one, or of a sum, computed without the angle.  ``body`` are the statements that the
    lemma added to the program.  ``premises`` says what names of earlier statements must stand for;
    where the inverse is proved, so is that.
    """

    name: str
    statement: str
    equations: tuple[sp.Expr, ...]
    solution: Mapping[sp.Symbol, sp.Expr]
    branches: int
    excluded: int = 0
    means: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)
    body: tuple[Statement, ...] = ()
    premises: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def __getitem__(self, unknown: sp.Symbol) -> sp.Expr:
        return self.solution[unknown]

    def known(self, value: sp.Expr) -> sp.Symbol:
        """The name of a value in the unknowns, as ``cos(x)``."""
        return next(name for name, meaning in self.means.items() if meaning == value)

    def pair(self, angle: sp.Expr) -> tuple[sp.Symbol, sp.Symbol]:
        """The names of the cosine and the sine of an angle."""
        return self.known(sp.cos(angle)), self.known(sp.sin(angle))


def label(joint: sp.Symbol) -> str:
    """What tells a joint from the others in the names of its sine and cosine: 1 of theta1."""
    return str(joint.name).removeprefix("theta")
