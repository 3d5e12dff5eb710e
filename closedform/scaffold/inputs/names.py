"""Names that the written script uses itself, and what a joint of a file is called there."""

from __future__ import annotations

import re
from collections.abc import Iterable
from keyword import iskeyword

from closedform.algebra.formulas import FUNCTIONS
from closedform.lemmas.registry import chain_lemmas
from closedform.model.names import NOT_FINITE, check_symbol

IMPORTED = (
    "Abs", "cos", "pi", "sin", "sqrt", "Matrix", "Max", "Piecewise", "Rational", "atan", "atan2",
)  # fmt: skip
CHAIN = (
    "Carrying", "Reaching", "ReachingAcross", "ReachingInPlane", "ReachingOnRail", "arm_angle",
    "rotation", "sign_of", "turned", "within_links", "within_tilt",
    *chain_lemmas(),
)  # fmt: skip
LINKED = (
    "CoordinateWithin", "LinkAcross", "LinkAtHeight", "Links", "LinksAlongSlide",
    "LinksAndObliqueWrist", "LinksAndWrist", "LinksAround", "LinksAtHeight", "LinksPastParallel",
    "LinksPastTurn", "OnCircle", "Pair", "TwoTurns",
)  # fmt: skip
AUTHOR = (
    "Chain",
    "Derivation",
    "Paper",
    *LINKED,
    "from_dh",
    "from_screws",
    "parallelogram_drive",
    "real",
)
SCRIPT = {"arm", "coupling", "d", "forward", "links", "motors", "pair"}
LINES = {
    "M", "ahead", "ik", "p", "q", "reaching", "turn1", "turn2", "wx", "wy", "x", "y", "yaw", "z",
    "rho", "rho_", "given", "left", "axis", "p_norm", "to_end", "to_target", "to_elbow", "to_wrist",
    "both_links", "on_ellipse", "R_inverse", "R_rest", "R_last", "R_between", "R_before",
    "tool", "side", "both", "pointed", "square", "along", "aside", "centre", "radius", "on_circle",
    "play", "carried", "radius_to_target", "radius_to_end", "lever", "past", "seen_across",
    "across", "missed_by", "pair_at", "aimed", "off_axis", "below_one", "squares", "at_end",
    "less", "more", "less_behind", "more_behind", "behind", "far", "tilt", "offset", "seen",
    "R_shoulder", "moved", "along_rail", "missed",
}  # fmt: skip
TAKEN = SCRIPT | LINES | {*IMPORTED, *AUTHOR, *CHAIN}
"""Names that the written script uses itself."""
NUMBERED = re.compile(r"(psi|link|pair|left|tilted)\d+_?")
"""Names with a number that the written script uses itself."""


NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


def is_taken(name: str) -> bool:
    """Whether the written script uses a name itself."""
    return name in TAKEN or NUMBERED.fullmatch(name) is not None


def names_in(formulas: Iterable[str]) -> set[str]:
    """The names in formulas, without those that a joint of another name could not have either."""
    names = {name for text in formulas for name in NAME.findall(text)} - FUNCTIONS.keys()
    return {name for name in names if not iskeyword(name) and name.lower() not in NOT_FINITE}


def symbol_of(name: str) -> str:
    """The name of a joint as an identifier that the written script does not use itself."""
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    known = plain if plain[:1].isalpha() else f"q_{plain}"
    try:
        check_symbol(known, "")
    except ValueError:
        return f"{known}_0"
    return f"{known}_0" if is_taken(known) else known


__all__ = [
    "AUTHOR",
    "CHAIN",
    "IMPORTED",
    "LINKED",
    "NUMBERED",
    "TAKEN",
    "is_taken",
    "names_in",
    "symbol_of",
]
