"""Letters for the vectors and lengths of a step, which no parameter or joint has."""

from __future__ import annotations

from closedform.model.derivation import Derivation

VECTORS = {letter: letter.upper() for letter in "uvnmseb"} | {"r": "F"}
LENGTHS = {"l": "L", "h": "H"}
"""The letters of the steps on loops, and what stands for one that is taken; R is a rotation."""
SPARE = "WQKG"


def letters(d: Derivation, wanted: str) -> list[str]:
    """The wanted letters, and others instead of those that a parameter or a joint has.

    A letter is replaced in the same way in all steps of a derivation.
    """
    names = {str(e.symbol) for e in d.parameters} | {str(e.symbol) for e in d.joints}
    stems = {name.rstrip("0123456789_") for name in names}  # vectors may have an index
    spare, other = iter(SPARE), {}
    for letter, capital in (VECTORS | LENGTHS).items():
        if letter in (stems if letter in VECTORS else names):
            other[letter] = next(spare) if capital in stems else capital
    return [other.get(letter, letter) for letter in wanted]


__all__ = ["letters"]
