"""Arms that are singular everywhere: some of their joints depend on each other at every posture."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import sympy as sp

from closedform.mechanics.links import Group

POSTURES = 3
ZERO = 1e-9
"""A singular value below this share of the largest counts as zero.

Whether it really is zero is proved by the determinant.
"""


class SingularEverywhereError(ValueError):
    """An arm whose Jacobian does not have full rank at any posture."""


def dependent_joints(J: sp.Matrix, joints: Sequence[sp.Symbol]) -> tuple[int, list[sp.Symbol]]:
    """The rank of a Jacobian at ordinary postures, and the joints whose columns are dependent."""
    symbols = [*joints, *sorted(J.free_symbols - set(joints), key=str)]
    evaluate = sp.lambdify(symbols, J, "numpy")
    return _dependent(lambda point: np.array(evaluate(*point), dtype=float), len(symbols), joints)


def dependent_in_chain(
    groups: Sequence[Group], joints: Sequence[sp.Symbol], rates: sp.Matrix | None = None
) -> tuple[int, list[sp.Symbol]]:
    """The same for a serial chain, without writing its twists out.

    ``rates`` say how fast each axis moves by each joint, if some follow others.
    """
    parts = [
        sp.Matrix.hstack(
            group.transform(),
            *(sp.Matrix([[0, -w[2], w[1], v[0]], [w[2], 0, -w[0], v[1]], [-w[1], w[0], 0, v[2]],
                         [0, 0, 0, 0]]) for w, v in map(group.twist, range(len(group.rows))))
        )
        for group in groups
    ]  # fmt: skip
    free = set().union(*(part.free_symbols for part in parts)) - set(joints)
    symbols = [*joints, *sorted(free, key=str)]
    evaluate = [sp.lambdify(symbols, part, "numpy") for part in parts]
    by_joint = np.eye(len(joints)) if rates is None else np.array(rates, dtype=float)

    def jacobian(point: np.ndarray) -> np.ndarray:
        T, columns = np.eye(4), []
        for part in evaluate:
            step, *twists = np.hsplit(
                np.array(part(*point), dtype=float), len(part(*point)[0]) // 4
            )
            for V in (T @ V @ np.linalg.inv(T) for V in twists):
                columns.append([*V[:3, 3], V[2, 1], V[0, 2], V[1, 0]])
            T = T @ step
        return np.asarray(np.array(columns).T @ by_joint)

    return _dependent(jacobian, len(symbols), joints)


def _dependent(
    jacobian: Callable[[np.ndarray], np.ndarray], symbols: int, joints: Sequence[sp.Symbol]
) -> tuple[int, list[sp.Symbol]]:
    rng = np.random.default_rng(4)
    ranks, involved = [], np.zeros(len(joints), dtype=bool)
    for _ in range(POSTURES):
        _, sizes, rows = np.linalg.svd(jacobian(rng.uniform(0.3, 1.3, symbols)))
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
    together = f"what {', '.join(most)} and {last} do to the tool is not independent"
    because = together if most else f"{last} does not move the tool"
    held = (
        f".  If it is built so, like an arm on a lift that its links can replace, hold one of "
        f"these joints: in a DH table, a line such as '# {found[0]} = 0.1 m: held', with rad for a "
        f"joint that turns, makes it a parameter; of a URDF or MJCF file do so with --hold "
        f"JOINT, such as --hold {found[0]}, or take the part after it, with --base"
    )
    return SingularEverywhereError(
        f"{name}: the arm is singular everywhere: its Jacobian has rank {rank}, not "
        f"{len(joints)}, at every posture, because {because}.  Check the convention of the table "
        f"(standard, unless it is read with modified=True or --modified), and whether an axis is "
        f"given twice or too many axes are parallel or meet in a point{held if most else ''}"
    )
