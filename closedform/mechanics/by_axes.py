"""How articles show a pose and a Jacobian that are too long to be written out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import sympy as sp

from closedform.algebra.operations import operations
from closedform.mechanics.frames import twist_matrix
from closedform.model.derivation import Derivation

ENTRIES = 1000
"""The most operations of a pose whose entries are written out; of a longer one, the factors are."""
AXES = "  Column i of J is that of joint i: omega_i is its axis, and o_i a point on that."
WRITTEN = {
    "omega_i": (r"\omega_i", "axis of joint i"),
    "o_i": (r"\mathbf{o}_i", "point on the axis of joint i"),
}
AXIS = r"\begin{bmatrix} \ast & \ast & \omega_i & \mathbf{o}_i \\ 0 & 0 & 0 & 1 \end{bmatrix}"
COLUMN = r"\begin{bmatrix} \omega_i \times (p - \mathbf{o}_i) \\ \omega_i \end{bmatrix}"

TURN = twist_matrix(sp.Matrix([0, 0, 0, 0, 0, 1]))
"""The rate of a turn about the z axis."""


@dataclass(frozen=True)
class ByAxes:
    """The pose as a product, and column i of the geometric Jacobian."""

    pose: str
    jacobian: dict[str, str]
    frames: Callable[[], list[sp.Matrix]]
    """Gives for each joint the frame whose z axis it turns about."""

    def equal(self, pose: sp.Matrix, geometric: sp.Matrix) -> list[tuple[sp.Matrix, sp.Matrix]]:
        """Each column by the axis of its joint, beside that of the Jacobian."""
        return [
            (sp.Matrix([w.cross(pose[:3, 3] - frame[:3, 3]), w]), geometric[:, i])
            for i, frame in enumerate(self.frames())
            for w in (frame[:3, 2],)
        ]


def by_axes(
    d: Derivation, pose: sp.Matrix, moves: Sequence[sp.Matrix], joints: Sequence[sp.Symbol]
) -> ByAxes | None:
    """The pose of a long arm and its Jacobian, by the axes of its joints; None for a short one.

    Each motion has to turn one joint about the z axis of the frame before it, or of the frame after
    it as in a modified table.  The meanings of the names are added to ``d``.
    """
    n = len(joints)
    if operations(pose) <= ENTRIES or len(moves) != n:
        return None
    for after, last in ((0, "i-1"), (1, "i")):
        if all(_turns(A, joint, after) for A, joint in zip(moves, joints, strict=True)):
            for name, (latex, meaning) in WRITTEN.items():
                d.write(name, latex, meaning)
            d.explain({"J_i": "column i of J"})
            return ByAxes(
                pose=rf"A_1 A_2 \cdots A_{n}",
                jacobian={
                    AXIS: rf"A_1 A_2 \cdots A_{{{last}}}",
                    "J_i": COLUMN,
                    "J": rf"\begin{{bmatrix}} J_1 & J_2 & \cdots & J_{n} \end{{bmatrix}}",
                },
                frames=partial(_frames, moves, after),
            )
    return None


def _turns(A: sp.Matrix, joint: sp.Symbol, after: int) -> bool:
    """Whether a motion turns with a joint about the z axis of the frame before or after it."""
    moved = A * TURN if after else TURN * A
    return bool((A.diff(joint) - moved).expand().is_zero_matrix)


def _frames(moves: Sequence[sp.Matrix], after: int) -> list[sp.Matrix]:
    return [sp.prod(moves[: i + after], start=sp.eye(4)) for i in range(len(moves))]


__all__ = ["AXES", "ByAxes", "by_axes"]
