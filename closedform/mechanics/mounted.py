"""An arm on a tilted mount: what is seen from the mount, and how the mount turns it.

A rotation that turns no axis of coordinates to another one spreads its numbers through every
entry.  So the arm is multiplied out and differentiated without it.
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.algebra.expansion import Expansion
from closedform.mechanics.frames import adjoint
from closedform.model.derivation import Derivation

MOUNTED = (
    "  J_0 is that of the arm without its mount A_1, which is at rest, and R_1 is the rotation in "
    "A_1.  The derivatives are compared without the mount: it turns and shifts both sides alike."
)
TURNED = r"\begin{bmatrix} R_1 & 0 \\ 0 & R_1 \end{bmatrix} J_0"
"""The geometric Jacobian by that of the arm without its mount."""


def is_tilted(mount: sp.Matrix) -> bool:
    """Whether a constant motion turns an axis of coordinates to a direction between them."""
    return any(e not in (-1, 0, 1) for e in mount[:3, :3])


def shown(
    d: Derivation, pose: sp.Matrix, geometric: sp.Matrix
) -> tuple[dict[str, Any], dict[str, Any]]:
    """How an article shows the pose and the geometric Jacobian: by those seen from the mount."""
    d.explain(
        {
            "T_0": "pose of the tool, seen from the mount",
            "J_0": "J without the mount",
            "R_1": "rotation in A_1",
        }
    )
    return {"T_0": pose, "T": "A_1 T_0"}, {"J_0": geometric, "J": TURNED}


def turning(mount: sp.Matrix) -> sp.Matrix:
    """What turns a geometric Jacobian as the mount does."""
    return sp.diag(mount[:3, :3], mount[:3, :3])


def moved(mount: sp.Matrix, pose: sp.Matrix) -> sp.Matrix:
    """A pose that is seen from the mount, in the base frame."""
    return _product(mount, pose)


def turned(mount: sp.Matrix, geometric: sp.Matrix) -> sp.Matrix:
    """A geometric Jacobian that is seen from the mount, in base axes."""
    return _product(turning(mount), geometric)


def carried(mount: sp.Matrix, space: sp.Matrix) -> sp.Matrix:
    """Twists that are seen from the mount, in the base frame."""
    return _product(adjoint(mount), space)


def _product(a: sp.Matrix, b: sp.Matrix) -> sp.Matrix:
    ring = Expansion([a, b])
    return ring.written(ring.times(ring.read(a), ring.read(b)))


__all__ = ["MOUNTED", "carried", "is_tilted", "moved", "shown", "turned", "turning"]
