"""An arm on a tilted mount: what is seen from the mount, and how the mount turns it.

A rotation that turns no axis of coordinates to another one spreads its numbers through every
entry.  So the arm is multiplied out and differentiated without it.
"""

from __future__ import annotations

import sympy as sp

from closedform.algebra.expansion import Expansion
from closedform.mechanics.frames import adjoint

MOUNTED = (
    "  The derivatives are compared for the arm without its mount A_1, which is at rest: it turns "
    "and shifts both sides alike."
)


def is_tilted(mount: sp.Matrix) -> bool:
    """Whether a constant motion turns an axis of coordinates to a direction between them."""
    return any(e not in (-1, 0, 1) for e in mount[:3, :3])


def moved(mount: sp.Matrix, pose: sp.Matrix) -> sp.Matrix:
    """A pose that is seen from the mount, in the base frame."""
    return _product(mount, pose)


def turned(mount: sp.Matrix, geometric: sp.Matrix) -> sp.Matrix:
    """A geometric Jacobian that is seen from the mount, in base axes."""
    return _product(sp.diag(mount[:3, :3], mount[:3, :3]), geometric)


def carried(mount: sp.Matrix, space: sp.Matrix) -> sp.Matrix:
    """Twists that are seen from the mount, in the base frame."""
    return _product(adjoint(mount), space)


def _product(a: sp.Matrix, b: sp.Matrix) -> sp.Matrix:
    ring = Expansion([a, b])
    return ring.written(ring.times(ring.read(a), ring.read(b)))


__all__ = ["MOUNTED", "carried", "is_tilted", "moved", "turned"]
