"""Arms that are singular everywhere: some of their joints depend on each other at every posture."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

POSTURES = 3
ZERO = 1e-9
"""Of the largest singular value.  Whether it is zero indeed, the determinant proves."""


class SingularEverywhereError(ValueError):
    """An arm whose Jacobian has no full rank at any posture."""


def dependent_joints(J: sp.Matrix, joints: Sequence[sp.Symbol]) -> tuple[int, list[sp.Symbol]]:
    """The rank of a Jacobian at ordinary postures, and the joints whose columns are dependent."""
    symbols = [*joints, *sorted(J.free_symbols - set(joints), key=str)]
    evaluate = sp.lambdify(symbols, J, "numpy")
    rng = np.random.default_rng(4)
    ranks, involved = [], np.zeros(len(joints), dtype=bool)
    for _ in range(POSTURES):
        point = rng.uniform(0.3, 1.3, len(symbols))
        _, sizes, rows = np.linalg.svd(np.array(evaluate(*point), dtype=float))
        rank = int((sizes > ZERO * sizes[0]).sum())
        ranks.append(rank)
        involved |= (np.abs(rows[rank:]) > ZERO).any(axis=0)
    return max(ranks), [q for q, is_in in zip(joints, involved, strict=True) if is_in]


def singular_everywhere(
    name: str, J: sp.Matrix, joints: Sequence[sp.Symbol]
) -> SingularEverywhereError:
    """The error for an arm whose Jacobian has the determinant zero."""
    rank, found = dependent_joints(J, joints)
    *most, last = map(str, found)
    return SingularEverywhereError(
        f"{name}: the arm is singular everywhere: its Jacobian has rank {rank}, not "
        f"{len(joints)}, at every posture, because what {', '.join(most)} and {last} do to the "
        f"tool is not independent.  Check the convention of the table (standard, unless it is read "
        f"with modified=True or --modified), and whether an axis is given twice or too many axes "
        f"are parallel or meet in a point"
    )
