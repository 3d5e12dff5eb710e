"""How articles show a pose and a Jacobian that are too long to be written out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import sympy as sp

from closedform.model.derivation import Derivation

ENTRIES = 1000
"""The most operations of a pose whose entries are written out; of a longer one, the factors are."""
AXES = "  Here w_i is the axis of joint i, o_i a point on it, and p the position in T."
MEANINGS = {"w_i": "axis of joint i", "o_i": "point on the axis of joint i"}
AXIS = r"\begin{bmatrix} \ast & \ast & \mathbf{w}_i & \mathbf{o}_i \\ 0 & 0 & 0 & 1 \end{bmatrix}"
COLUMN = r"\begin{bmatrix} \mathbf{w}_i \times (p - \mathbf{o}_i) \\ \mathbf{w}_i \end{bmatrix}"


@dataclass(frozen=True)
class ByAxes:
    """The pose as a product, column i of the geometric Jacobian, and what proves them."""

    pose: str
    jacobian: dict[str, str]
    equal: list[tuple[sp.Matrix, sp.Matrix]]


def by_axes(
    d: Derivation, pose: sp.Matrix, geometric: sp.Matrix, moves: Sequence[sp.Matrix]
) -> ByAxes | None:
    """The pose of a long arm and its Jacobian, by the axes of its joints; None for a short one.

    Each motion has to turn one joint about the z axis of the frame before it, or of the frame after
    it as in a modified table.  The meanings of the names are added to ``d``.
    """
    n = geometric.cols
    if sp.count_ops(pose) <= ENTRIES or len(moves) != n:
        return None
    for after, last in ((0, "i-1"), (1, "i")):
        frames = [sp.prod(moves[: i + after], start=sp.eye(4)) for i in range(n)]
        columns = [
            sp.Matrix([w.cross(pose[:3, 3] - frame[:3, 3]), w])
            for frame in frames
            for w in (frame[:3, 2],)
        ]
        if _agree(sp.Matrix.hstack(*columns), geometric):
            for name, meaning in MEANINGS.items():
                d.write(name, rf"\mathbf{{{name[0]}}}_{{i}}", meaning)
            d.explain({"J_i": "column i of J"})
            return ByAxes(
                pose=rf"A_1 A_2 \cdots A_{n}",
                jacobian={
                    AXIS: rf"A_1 A_2 \cdots A_{{{last}}}",
                    "J_i": COLUMN,
                    "J": rf"\begin{{bmatrix}} J_1 & J_2 & \cdots & J_{n} \end{{bmatrix}}",
                },
                equal=[(column, geometric[:, i]) for i, column in enumerate(columns)],
            )
    return None


def _agree(first: sp.Matrix, second: sp.Matrix) -> bool:
    """Whether two matrices have the same values at a point; the proof decides."""
    symbols = sorted(first.free_symbols | second.free_symbols, key=str)
    # In floats, because SymPy's own evaluation takes longer than the rest of a derivation.
    point = [(7 * k + 3) / 11 for k in range(len(symbols))]
    a, b = sp.lambdify(symbols, [first, second], "numpy")(*point)
    return bool(np.abs(a - b).max() < 1e-9)


__all__ = ["AXES", "ByAxes", "by_axes"]
