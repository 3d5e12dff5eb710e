"""The space and the body Jacobian, as they follow from the geometric one."""

from __future__ import annotations

import sympy as sp

from closedform.mechanics.frames import hat

SPELLED = 120
"""The most operations of a Jacobian that is written out, not expressed by the geometric one."""
SHIFT = r"\begin{bmatrix} I & [p]_\times \\ 0 & I \end{bmatrix} J"
TURN = r"\begin{bmatrix} R^T & 0 \\ 0 & R^T \end{bmatrix} J"
TURNED = (
    "  The velocity in J is that of the tool.  In J_s it is that of the point of the tool that is "
    "just at the origin of the base.  J_b is in the axes of the tool.  Here p is the position in "
    "T, R its rotation, and [p]_× the matrix of the cross product with p."
)


def from_geometric(
    pose: sp.Matrix, geometric: sp.Matrix, space: sp.Matrix, body: sp.Matrix
) -> list[tuple[sp.Matrix, sp.Matrix]]:
    """The space and the body Jacobian, by rows, each beside its form in the geometric one."""
    v, w, R = geometric[:3, :], geometric[3:, :], pose[:3, :3]
    return [
        (space[:3, :], v + hat(pose[:3, 3]) * w),
        (space[3:, :], w),
        (body[:3, :], R.T * v),
        (body[3:, :], R.T * w),
    ]
