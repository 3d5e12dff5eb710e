"""Functions of the joints of a loop, which have a result for each assembly mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from closedform.model.derivation import Derivation
from closedform.model.functions import Branches, Program

NO_MODE = "NaN for an assembly mode that does not exist."
Exported = tuple[str, str, dict[str, Any], tuple[str, ...]]
EQUATIONS: Mapping[str, str] = {
    **{name: name for name in "ABJ"},
    "det": r"\det J",
    "factors": r"\Delta",
    "kappa": r"\kappa",
    "constraint": r"\Gamma",
}
"""What stands on the left of the equation that has a result, by the name of the output.

A function whose output is not alone in having its name is found by its own.
"""


def export(
    d: Derivation,
    program: Program,
    modes: Branches,
    functions: Sequence[Exported],
    equations: Mapping[str, str] = EQUATIONS,
) -> None:
    """Export functions of the joints in each assembly mode: name, summary, outputs and notes.

    ``equations`` says which equation of a step has a result, by the name of the output.
    """
    for name, summary, outputs, notes in functions:
        d.function(
            name,
            summary,
            {"q": d.actuated},
            outputs,
            program=program,
            branches=modes,
            notes=(NO_MODE, *notes),
            equation=equations.get(name, equations.get(next(iter(outputs)), "")),
        )


__all__ = ["EQUATIONS", "NO_MODE", "Exported", "export"]
