"""Functions of the joints of a loop, which have a result for each assembly mode."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

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


def export_in_plane(
    d: Derivation,
    program: Program,
    modes: Branches,
    rates: tuple[sp.Matrix, Sequence[sp.Expr]],
    volume: sp.Expr,
) -> None:
    """Export the Jacobians of a hand in a plane with A*dx = B*dq, where B is diagonal.

    ``rates`` are A and the diagonal of B in assembly modes, and ``volume`` is the determinant of A.
    """
    A = program.matrix("A", rates[0])
    B = program.matrix("B", sp.Matrix(rates[1]))
    delta = program.let("Delta", volume)
    pole = "Not finite at a parallel singularity."
    export(
        d,
        program,
        modes,
        [
            ("jacobian_parallel", "A of A*dx = B*dq.", {"A": A.tolist()}, ()),
            ("jacobian_serial", "The diagonal of B of A*dx = B*dq.", {"B": list(B)}, ()),
            (
                "jacobian",
                "Derivative of x, y and yaw with respect to q: A^-1*B.",
                {"J": (A.adjugate() * sp.diag(*B) / delta).tolist()},
                (pole,),
            ),
            ("determinant", "Determinant of the Jacobian.", {"det": sp.Mul(*B) / delta}, (pole,)),
            (
                "singularities",
                "The diagonal of B (serial) and the determinant of A (parallel).",
                {"factors": [*B, delta]},
                (),
            ),
        ],
    )


__all__ = ["EQUATIONS", "NO_MODE", "Exported", "export", "export_in_plane"]
