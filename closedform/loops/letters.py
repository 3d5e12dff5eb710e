"""Letters for the vectors and lengths of a step, which no parameter or joint has."""

from __future__ import annotations

from closedform.model.derivation import Derivation

VECTORS = {letter: letter.upper() for letter in "uvnmseb"} | {"r": "F"}
LENGTHS = {"l": "L", "h": "H"}
"""The letters of the steps on loops, and what stands for one that is taken; R is a rotation."""
MORE = dict.fromkeys("acw", "")
"""Vectors whose capital letters mean something else."""
SPARE = "WQKGYZ"


def letters(d: Derivation, wanted: str) -> list[str]:
    """The wanted letters, and others instead of those that a parameter or a joint has.

    A letter is replaced in the same way in all steps of a derivation.
    """
    names = {str(e.symbol) for e in d.parameters} | {str(e.symbol) for e in d.joints}
    stems = {name.rstrip("0123456789_") for name in names}  # vectors may have an index
    spare, other = (x for x in SPARE if x not in stems), {}
    for letter, capital in (VECTORS | LENGTHS | MORE).items():
        if letter in (names if letter in LENGTHS else stems):
            other[letter] = next(spare) if not capital or capital in stems else capital
    return [other.get(letter, letter) for letter in wanted]


def bold(d: Derivation, wanted: str) -> list[str]:
    """The same letters of vectors, as LaTeX."""
    return [rf"\mathbf {letter}" for letter in letters(d, wanted)]


__all__ = ["bold", "letters"]
