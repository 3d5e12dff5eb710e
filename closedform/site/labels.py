"""How the explorer writes names: as formulas in LaTeX, and as plain text, where theta2R is θ₂ᴿ."""

from __future__ import annotations

import re
import unicodedata

from closedform.emit.backends.latex.called import GREEK
from closedform.emit.backends.latex.names import coordinate_name
from closedform.emit.backends.latex.prose import written_name
from closedform.model.derivation import Derivation

DIGITS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
SIDES = str.maketrans("LR", "ᴸᴿ")
LETTERS = re.compile(r"[A-Za-z]+")
OF_AN_ARM = re.compile(r"(?<=\d)[LR]$")
ANY = "any "
"""How the unit of a dimension begins that may have any."""


def label(name: str) -> str:
    """A name in plain text, as people write it."""
    name = OF_AN_ARM.sub(lambda m: m[0].translate(SIDES), name)
    return re.sub(r"\d+", lambda m: m[0].translate(DIGITS), LETTERS.sub(_letter, name, count=1))


def written(derivation: Derivation, name: str) -> dict[str, str]:
    """A joint or a parameter as plain text, and as a formula in LaTeX."""
    return {"label": label(name), "formula": written_name(derivation, name)}


def coordinate(derivation: Derivation, name: str) -> dict[str, str]:
    """A coordinate of the task in the same way; a word, such as yaw, stays a word."""
    if name.isalpha() and name not in GREEK and len(name) > 1:
        return {"label": name}
    return {"label": label(name), "formula": coordinate_name(derivation, name)}


def given(derivation: Derivation) -> dict[str, str]:
    """What the inverse takes besides the target: a joint, or an angle that is called in words."""
    beside = [a.name for f in derivation.functions if f.name == "ik" for a in f.inputs[1:]]
    joints = {j.name for j in derivation.joints}
    if len(beside) == 1 and beside[0] in joints:
        return written(derivation, beside[0])
    return {"label": " ".join(label(name).replace("_", " ") for name in beside)}


def unit(text: str) -> str:
    """A unit as it stands beside a number: nothing for any unit."""
    return "" if text.startswith(ANY) else text


def length_unit(derivation: Derivation) -> str:
    """The unit of positions and of joints that slide."""
    units = (unit(p.unit) for p in derivation.parameters if p.unit != "rad")
    return next(units, "")


def _letter(found: re.Match[str]) -> str:
    """The Greek letter that is spelled out, or the letters as they are."""
    name = found[0]
    if name not in GREEK:
        return name
    case = "CAPITAL" if name[0].isupper() else "SMALL"
    spelled = name.lower().removeprefix("var").replace("lambda", "lamda")  # as Unicode has it
    return unicodedata.lookup(f"GREEK {case} LETTER {spelled}")
