"""What articles call joints that a file calls by words: ``left_arm_joint3`` is written theta_3.

The table of the joints says which is which.
"""

from __future__ import annotations

import re
from collections.abc import Callable

from sympy.core.alphabets import greeks

from closedform.model.derivation import Derivation

GREEK = {*greeks, *(g.capitalize() for g in greeks), "lambda", "varphi"}
LETTERS = "|".join(sorted(GREEK))
WORDS = re.compile(rf"(?=.*[\d_])(?!(?:{LETTERS})(?![a-z]))[A-Za-z_]*[A-Za-z]{{3}}\w*")
"""The name of a joint that is a word and a number, or more than a word, and no Greek letter."""


def as_it_is(name: str) -> str:
    """The name itself."""
    return name


def called(derivation: Derivation) -> Callable[[str], str]:
    """How names are spelled in which joints occur; as they are if the name of a joint is short.

    A joint that turns is theta with its number in the chain, another one q with its number; in the
    names of signs and of what a lemma finds on the way the number stands alone.
    """
    joints = derivation.joints
    if not joints or not all(WORDS.fullmatch(j.name) for j in joints):
        return as_it_is
    numbers = {j.name: str(k) for k, j in enumerate(joints, 1)}
    letters = {j.name: "theta" if j.kind == "revolute" else "q" for j in joints}
    taken = {p.name for p in derivation.parameters} | {*derivation.written} | {*derivation.task}
    taken |= {s.name for f in derivation.functions for s in f.symbols}
    if taken & {letters[n] + numbers[n] for n in numbers}:
        return as_it_is
    longest_first = sorted(numbers, key=len, reverse=True)
    part = re.compile(rf"(?:{'|'.join(longest_first)})(?!\d)")

    def spelled(name: str) -> str:
        before, joint = (name[:2], name[2:]) if name[:2] in ("c_", "s_") else ("", name)
        if joint in numbers:  # itself, or the cosine or the sine of a joint that is given
            return f"{before}{letters[joint]}{numbers[joint]}"
        return part.sub(lambda found: numbers[found[0]], name)

    return spelled


__all__ = ["GREEK", "as_it_is", "called"]
