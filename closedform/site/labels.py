"""Names of joints and parameters in Unicode, for controls and graphs: theta2R is θ₂R."""

from __future__ import annotations

import re
import unicodedata

from closedform.emit.backends.latex.prose import GREEK

DIGITS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
LETTERS = re.compile(r"[A-Za-z]+")


def label(name: str) -> str:
    """A name as people write it."""
    return re.sub(r"\d+", lambda m: m[0].translate(DIGITS), LETTERS.sub(_letter, name, count=1))


def _letter(found: re.Match[str]) -> str:
    """The Greek letter that is spelled out, or the letters as they are."""
    name = found[0]
    if name not in GREEK:
        return name
    case = "CAPITAL" if name[0].isupper() else "SMALL"
    spelled = name.lower().removeprefix("var").replace("lambda", "lamda")  # as Unicode has it
    return unicodedata.lookup(f"GREEK {case} LETTER {spelled}")
