"""Rods with universal joints at both ends, whose axes keep a body from turning."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.lemmas.registry import theorem

theorem(
    "universal joints with parallel axes",
    statement=r"""A rod has a universal joint at either end.  The two axes that are fixed to the rod
are parallel to each other and at right angles to the rod.  At the near end the outer axis has the
direction $\mathbf u$, and on the hand it has the direction $\mathbf v$, both unit vectors.  The
vector $\mathbf r$ along the rod is not parallel to $\mathbf u$.  The rod fits if and only if
$$(\mathbf u\times\mathbf r)\cdot\mathbf v = 0.$$ If $\mathbf v = \mathbf u$, it fits wherever the
hand is.
Let three of them join a hand to axes whose directions $\mathbf u_k$ do not turn, and let
$\mathbf v_k = R\,\mathbf u_k$, where $R$ is the rotation of the hand.  If the vectors $\mathbf
m_k = \mathbf r_k - (\mathbf u_k\cdot\mathbf r_k)\,\mathbf u_k$ are not in one plane, no continuous
motion leads away from $R = I$.""",
    proof=r"""In a universal joint the axes are at right angles.  So the axes fixed to the rod are
at right angles to $\mathbf u$, to $\mathbf v$ and to $\mathbf r$.  Those at right angles to
$\mathbf u$ and $\mathbf r$ have the direction of $\mathbf u\times\mathbf r$, which has to be at
right angles to $\mathbf v$.  The equations $f_k = (\mathbf u_k\times\mathbf r_k)\cdot R\,\mathbf
u_k = 0$ hold if $R = I$, wherever the hand is.  There the derivative of $f_k$, while the hand turns
with the rate $\boldsymbol\omega$ and moves in any way, is $(\mathbf u_k\times\mathbf
r_k)\cdot(\boldsymbol\omega\times\mathbf u_k) = -\boldsymbol\omega\cdot\mathbf m_k$.  If the
vectors $\mathbf m_k$ are not in one plane, these three are zero only for $\boldsymbol\omega = 0$.
Then $R = I$ is the only solution in a neighbourhood, by the implicit function theorem.""",
    exception=r"""If the vectors are in one plane, the hand can begin to turn: a constraint
singularity.  That is so if a rod is parallel to its outer axes: then $\mathbf m_k = 0$.  There are
other solutions, $\mathbf v\ne\mathbf u$, in which the hand is turned.""",
)


@dataclass(frozen=True)
class Universal:
    """A rod with universal joints at both ends: it keeps a body from turning.

    It replaces the ``rod`` of a leg.  ``axis`` is the direction of the outer axes, a unit vector:
    one of them is fixed to what moves the rod, the other one to the hand.  The two axes that are
    fixed to the rod are parallel to each other and at right angles to it.

    Postures in which the hand is turned are left out.
    """

    length: Any
    axis: Sequence[Any]

    def _sympy_(self) -> sp.Expr:
        return sp.sympify(self.length, strict=True)

    @property
    def direction(self) -> sp.Matrix:
        return sp.Matrix([sp.sympify(e, strict=True) for e in self.axis])

    def couple(self, rod: sp.Matrix) -> sp.Matrix:
        """The direction about which it keeps the hand from turning, from the vector along it."""
        return rod - self.direction.dot(rod) * self.direction

    def couples(self, rod: sp.Matrix) -> list[sp.Matrix]:
        """All such directions."""
        return [self.couple(rod)]


__all__ = ["Universal"]
