"""What the letters of a lemma stand for in a step, and which of them mean something else there."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.equations import canonical, skeleton
from closedform.emit.backends.latex.formulas import FITS, measure
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.backends.latex.wide import Equation
from closedform.model.lemma import Lemma
from closedform.model.names import listed

LETTER = re.compile(
    r"\\(?:operatorname|text|begin|end)\{[^}]*\}|\\math[a-z]+ ?(?:\{[^}]*\}|[A-Za-z])"
    r"|(?:\\[A-Za-z]+|[A-Za-z])(?:_(?:\{[^}]*\}|\w))?"
)
"""A letter of a formula with its index, or a piece that has letters of another kind."""


@dataclass(frozen=True)
class Roles:
    """The letters of a lemma: in a sentence, or on lines of their own where they are wide."""

    sentence: str
    rows: list[Equation]
    values: list[sp.Expr]
    """What the letters stand for."""
    apart: frozenset[str]
    """The letters that mean something else in the chapter, which have a prime."""


def roles(lemmas: Sequence[Lemma], page: Sheet, named: Callable[[sp.Expr], sp.Expr]) -> Roles:
    """The letters of a lemma that is applied once or to several equations in turn.

    Parameters
    ----------
    lemmas
        the same lemma, applied to each equation
    page
        the mechanism, with its symbols
    named
        an expression in the names that are printed
    """
    inline, rows = list[str](), list[Equation]()
    values: list[sp.Expr] = []
    taken = {canonical(page.math(s)) for s in page.symbols}
    apart = set[str]()

    def written(value: Any) -> str:
        if isinstance(value, str):
            return value
        if isinstance(value, sp.MatrixBase):
            entries = [named(e) for e in value]
            values.extend(entries)
            return f"({', '.join(map(page.math, entries))})"
        values.append(named(sp.sympify(value, strict=True)))
        return page.math(values[-1])

    turns = ""
    for several in zip(*(lemma.roles for lemma in lemmas), strict=True):
        letter = several[0][0]
        texts = [written(value) for _, value in several]
        if all(skeleton(canonical(text)) == skeleton(canonical(letter)) for text in texts):
            continue
        if canonical(letter) in taken:
            apart.add(canonical(letter))
            letter = primed(letter, apart)
        if len({*texts}) > 1:
            turns = " in turn"
        text = r",\ ".join(texts) if len({*texts}) > 1 else texts[0]
        if measure(letter + text) <= FITS / 3 and r"\frac" not in text:
            inline.append(f"${letter}$ is ${text}$")
        else:
            rows.append((letter, text))
    return Roles(listed(inline) + turns if inline else "", rows, values, frozenset(apart))


def primed(formula: str, letters: Collection[str]) -> str:
    """A formula of a lemma with a prime at some of its letters."""

    def one(found: re.Match[str]) -> str:
        return f"{found[0]}'" if canonical(found[0]) in letters else found[0]

    return LETTER.sub(one, formula)


__all__ = ["Roles", "primed", "roles"]
