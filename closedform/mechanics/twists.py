"""The Jacobians of an arm beside each other, and beside the derivatives of its pose."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.algebra.expressions import Derivatives
from closedform.mechanics.frames import hat, twist_matrix

SPELLED = 120
"""The most operations of a Jacobian that is written out, not expressed by the geometric one."""
SHIFT = r"\begin{bmatrix} I & [p]_\times \\ 0 & I \end{bmatrix} J"
TURN = r"\begin{bmatrix} R^T & 0 \\ 0 & R^T \end{bmatrix} J"
TURNED = (
    "  The velocity in J is that of the tool.  In J_s it is that of the point of the tool that is "
    "just at the origin of the base.  J_b is in the axes of the tool.  Here p is the position in "
    "T, R its rotation, and [p]_× the matrix of the cross product with p."
)


def differentiated(
    pose: sp.Matrix,
    joints: Sequence[sp.Symbol],
    twists: tuple[sp.Matrix, sp.Matrix, sp.Matrix],
    *,
    spelled: bool,
) -> list[tuple[sp.Matrix, sp.Matrix]]:
    """The derivatives of the pose, each beside what the ``twists`` say of it.

    These are the geometric, the space and the body Jacobian; unless they are ``spelled``, the
    last two are also beside their forms in the first one.
    """
    geometric, space, body = twists
    rates = [pose.applyfunc(Derivatives(joint).of) for joint in joints]
    found = [
        *(() if spelled else _from_geometric(pose, geometric, space, body)),
        (geometric[:3, :], sp.Matrix.hstack(*(rate[:3, 3] for rate in rates))),
        (geometric[3:, :], space[3:, :]),
    ]
    for i, rate in enumerate(rates):
        found.append((rate, twist_matrix(space[:, i]) * pose))
        found.append((rate, pose * twist_matrix(body[:, i])))
    return found


def _from_geometric(
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
