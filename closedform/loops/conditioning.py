"""The condition number of A: how well the driven legs of a closed loop move its hand."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.model.functions import Program

RODS = "of A", "Infinite at a parallel singularity."
JACOBIAN = "of the Jacobian", "Infinite at a singularity, serial or parallel."


def conditioning(
    v: Program,
    rods: Sequence[sp.Matrix],
    size: sp.Expr,
    *,
    of: tuple[str, str] = RODS,
    on_sphere: bool = False,
) -> tuple[str, dict[str, Any], tuple[str, ...]]:
    """The condition number of a matrix: what the function returns, its outputs and its notes.

    The ``rods`` are the rows of the matrix, and ``size`` is that of their determinant; ``of`` says
    which matrix it is, and where the number is infinite.  If the hand is ``on_sphere``, the first
    rod is the strut.  Only the components of the others that move the hand on the sphere count.
    """
    seen, infinite = of
    if on_sphere:
        strut, *others = rods
        length = v.let("strut", sp.sqrt(strut.dot(strut)), nonnegative=True)
        n = sp.Matrix([v.let(f"radial_{i}", e / length) for i, e in zip("xyz", strut, strict=True)])
        rods, size = [], size / length
        for k, rod in enumerate(others, 1):
            off = v.let(f"off{k}", rod.dot(n))
            across = zip("xyz", rod - off * n, strict=True)
            rods.append(sp.Matrix([v.let(f"t{k}_{i}", e) for i, e in across]))
        seen = "of the rods of the driven legs, as seen along the strut"
    squares = [v.let(f"square{k}", r.dot(r)) for k, r in enumerate(rods, 1)]
    if len(rods) == 2:
        gap = sp.sqrt((squares[0] - squares[1]) ** 2 + 4 * rods[0].dot(rods[1]) ** 2)
        value = (sp.Add(*squares) + gap) / (2 * size)
        return (
            f"Ratio of the largest to the smallest singular value {seen}.",
            {"kappa": value},
            (infinite,),
        )
    rows = [rods[1].cross(rods[2]), rods[2].cross(rods[0]), rods[0].cross(rods[1])]
    inverse = sp.Add(*(row.dot(row) for row in rows))
    value = sp.sqrt(sp.Add(*squares)) * sp.sqrt(inverse) / (3 * size)
    return (
        "Condition number of A in the Frobenius norm, divided by 3: 1 if the rods are equally long "
        "and at right angles.",
        {"kappa": value},
        (infinite,),
    )


__all__ = ["JACOBIAN", "conditioning"]
