"""The comment on a function in the C header."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod

from closedform.emit.docstring import Wording, inputs_of, notes, opening, results_of, section
from closedform.model.derivation import Derivation
from closedform.model.functions import Function


def _kind(ctype: str, branches: int, shape: Sequence[int]) -> str:
    axes = [branches, *shape] if branches else [*shape]
    named = f"{ctype}[{prod(axes)}]"
    return f"{named}, shape ({', '.join(map(str, axes))})" if len(axes) > 1 else named


C = Wording(
    "const real_t",
    "real_t",
    "uint8_t",
    "uint8_t",
    _kind,
    status="A CLOSEDFORM_ status",
    quote="",
    constants=False,
)


def comment(derivation: Derivation, function: Function, width: int) -> list[str]:
    """The lines of a comment in the C header."""
    return [
        *opening(function, width),
        *section("Inputs", inputs_of(derivation, function, C), width),
        *section("Outputs", results_of(derivation, function, C), width),
        *notes(derivation, function, width, C),
    ]
