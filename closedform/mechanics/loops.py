"""Closed loops: velocities by implicit differentiation, loci by elimination.

A loop is given by equations ``F(x, q) = 0`` between task coordinates and actuated joints.  Its
velocities obey ``A dx = B dq`` with ``A = dF/dx`` and ``B = -dF/dq``; a singular A is a parallel
singularity, a singular B a serial one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.algebra.factors import polynomial_factors


def velocity_matrices(
    loop: Sequence[sp.Expr], task: Sequence[sp.Symbol], joints: Sequence[sp.Symbol]
) -> tuple[sp.Matrix, sp.Matrix]:
    """``A`` and ``B`` of ``A dx = B dq``, from equations that vanish on the loop."""
    F = sp.Matrix(loop)
    return F.jacobian(list(task)), -F.jacobian(list(joints))


@dataclass(frozen=True)
class Eliminated:
    """The result of an elimination: irreducible factors over the rationals."""

    factors: tuple[tuple[sp.Expr, int], ...]

    def degrees(self, coordinates: Sequence[sp.Symbol]) -> tuple[int, ...]:
        """The total degree of each factor in the coordinates."""
        return tuple(degree(f, coordinates) for f, _ in self.factors)

    def vanishing(self, point: Sequence[tuple[sp.Symbol, Any]]) -> tuple[sp.Expr, ...]:
        """The factors that vanish at a point: the others are extraneous there."""
        return tuple(f for f, _ in self.factors if sp.expand(f.subs(point)) == 0)


def eliminate(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> Eliminated:
    """Eliminate ``unknowns`` from polynomial equations, one more than there are unknowns.

    Unknown by unknown, the resultants of the equation of least degree with each of the others.
    The result vanishes where the equations have a common solution; resultants may add factors
    that vanish elsewhere as well.
    """
    if len(equations) != len(unknowns) + 1:
        raise ValueError(f"{len(unknowns)} unknowns need {len(unknowns) + 1} equations")
    remaining = [sp.expand(e) for e in equations]
    for unknown in unknowns:
        with_it = sorted(
            (e for e in remaining if e.has(unknown)), key=lambda e: sp.degree(e, unknown)
        )
        pivot, *others = with_it
        remaining = [e for e in remaining if not e.has(unknown)]
        remaining += [sp.resultant(pivot, e, unknown) for e in others]
    (left,) = remaining
    return Eliminated(tuple(polynomial_factors(left)))


def degree(polynomial: sp.Expr, coordinates: Sequence[sp.Symbol]) -> int:
    """The total degree in the coordinates."""
    return int(sp.Poly(polynomial, *coordinates).total_degree())
