"""Lemmas: equations, and the closed forms that solve them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import Any

import sympy as sp

from closedform.model.display import Shown
from closedform.model.functions import Statement
from closedform.model.names import check_formulas, check_text
from closedform.model.pair import Pair


class Shape(Enum):
    """The form of the equation that a lemma solves, in its unknown x."""

    ANY = "any"
    LINEAR = "linear in sin(x) and cos(x)"
    CONTAINS = "contains x"


@dataclass(frozen=True)
class Lemma(Shown):
    """One application of a lemma: ``equations`` vanish at ``solution`` (unknown -> closed form).

    ``signs`` are the symbols that stand for 1 or -1: those of the branches, and others that it is
    proved for with either value.  ``shape`` says what its equation looks like in the unknown, and
    ``kind`` is the name of the function that made it, where a chain applied it.

    ``excluded`` is the number of solutions of the equations that violate the inequality in
    ``statement``.  ``means`` maps names for later steps to their meaning in the unknowns: cosine
    and sine of an unknown or of a sum, computed without the angle.  ``body`` contains the
    statements that the lemma added to the program.  ``premises`` maps names of earlier statements
    to the values that they must have; the proof of the inverse includes these.

    The rest is for the text.  ``roles`` says what each letter of the ``statement`` stands for here,
    in the order in which a reader needs them: an expression, a vector or LaTeX.  ``letters`` writes
    names of the program as the statement does.  A lemma in vectors is told as such, and its
    coordinates are left to the algorithm; ``vectors`` says how that computes them, and ``written``
    how the vectors of the program are written, by their names there.  ``matrix`` is the letter of
    the matrix that holds all unknowns, if there is one.  ``scaled`` has the letters of an angle and
    of its sine and its cosine, up to a positive factor: a reader has an equation for each.

    ``plainly`` says what a reader computes in place of what serves the rounding: closed forms of
    the unknowns, values of names of the program, and angles that only a reader has, each before it
    is needed.  A bound that says what another one says has the value 1.
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
    signs: tuple[sp.Symbol, ...] = ()
    shape: Shape = Shape.ANY
    kind: str = ""
    roles: tuple[tuple[str, Any], ...] = ()
    letters: Mapping[sp.Symbol, str] = field(default_factory=dict)
    vectors: str = ""
    written: Mapping[str, str] = field(default_factory=dict)
    matrix: str = ""
    scaled: tuple[str, ...] = ()
    plainly: Mapping[sp.Symbol, sp.Expr] = field(default_factory=dict)

    def __getitem__(self, unknown: sp.Symbol) -> sp.Expr:
        return self.solution[unknown]

    def implying(self, bounds: Sequence[sp.Symbol]) -> Lemma:
        """The lemma, whose own bounds say but for rounding what earlier ones say."""
        return replace(self, plainly={**dict.fromkeys(bounds, sp.S.One), **self.plainly})

    def known(self, value: sp.Expr) -> sp.Symbol:
        """The name of a value in the unknowns, such as ``cos(x)``."""
        (name,) = (name for name, meaning in self.means.items() if meaning == value)
        return name

    def pair(self, angle: sp.Expr) -> Pair:
        """The names of the sine and the cosine of an angle."""
        return Pair(self.known(sp.sin(angle)), self.known(sp.cos(angle)))


@dataclass(frozen=True)
class Theorem(Shown):
    """A lemma as a book prints it; texts, with formulas between dollar signs.

    ``exception`` says what happens where the assumptions of the statement fail, and ``rests_on``
    names the lemmas that the proof uses.
    """

    name: str
    statement: str
    proof: str
    exception: str = ""
    rests_on: tuple[str, ...] = ()
    title: str = ""
    """The name as a formula, if it is one."""

    def __post_init__(self) -> None:
        where = f"lemma {self.name!r}"
        texts = (self.statement, self.proof, self.exception, self.title)
        check_text(where, self.name, *self.rests_on)
        check_text(where, *texts, lines=True)
        check_formulas(where, *texts)


def label(joint: sp.Symbol) -> str:
    """The short label of a joint in the names of its sine and cosine: 1 for theta1."""
    return str(joint.name).removeprefix("theta")
