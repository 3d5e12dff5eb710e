"""Parallelograms that links extend at both ends, as in the legs of Tsai's manipulator."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.lemmas.parallelogram import Parallelogram
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program

theorem(
    "parallelogram between two links",
    statement=r"""A leg has revolute joints at both ends, whose axes have the direction $\mathbf
n$, a unit vector.  From the near one a link of length $d \ge 0$ leads to a parallelogram, whose
rods have the length $r > 0$ and whose bars have the direction $\mathbf n$.  A link of length $e \ge
0$ leads on to the far one, in the direction of the first link.  Both are at right angles to the
bars, in the plane of the parallelogram.  Let $\mathbf w$ lead from the near end to the far one, and
let $y = \mathbf n\cdot\mathbf w$ and $s = \sqrt{r^2 - y^2}$.  The leg fits, and its parallelogram
leads the way of the links, if and only if $|y| \le r$ and
$$|\mathbf w - y\,\mathbf n| = d + s + e.$$
While this holds with $s > 0$, a motion of the ends keeps it if and only if the rate of $\mathbf w$
is at right angles to the rods of the parallelogram,
$$\mathbf r = y\,\mathbf n + \frac{s}{d + s + e}\,(\mathbf w - y\,\mathbf n).$$""",
    proof=r"""Let $\mathbf u$ be the direction of the links.  A rod of the parallelogram is $\mathbf
r = y\,\mathbf n + s\,\mathbf u$ with $y^2 + s^2 = r^2$, because the links and the bars have no part
along the other direction; that $s \ge 0$ says which way it leads.  So $\mathbf w = y\,\mathbf n +
(d + s + e)\,\mathbf u$.  If the lengths fit, $\mathbf u$ is the direction of $\mathbf w -
y\,\mathbf n$, about which the revolute joints turn the leg.  Let $F = |\mathbf w -
y\,\mathbf n|^2 - (d + s + e)^2$.  Since $s\,\mathrm ds = -y\,\mathrm dy$, the derivative of $F$
along $\dot{\mathbf w}$ is $2\,\frac{d + s + e}{s}\,\mathbf r\cdot\dot{\mathbf w}$.""",
    exception=r"""If $s = 0$, the rods are parallel to the bars, and the parallelogram may fold.  If
$d + s + e = 0$, the leg turns freely.""",
)


@dataclass(frozen=True)
class Extended(Parallelogram):
    """A parallelogram between two links, with revolute joints at both ends of the leg.

    The axes of these joints, and that of the crank that carries the leg, have the direction of the
    ``bar``.  ``ends`` are the lengths of both links, from a joint to the parallelogram.

    Postures in which the parallelogram leads back from the first link are left out.
    """

    ends: tuple[Any, Any]

    @property
    def links(self) -> tuple[sp.Expr, sp.Expr]:
        near, far = (sp.sympify(end, strict=True) for end in self.ends)
        return near, far

    def split(self, span: sp.Matrix) -> tuple[sp.Expr, sp.Matrix]:
        """How far a vector between the ends leads along the axes, and the rest of it."""
        aside = span.dot(self.direction)
        return aside, span - aside * self.direction

    def fore(self, span: sp.Matrix) -> sp.Expr:
        """How far the rods lead at right angles to the axes."""
        length, (aside, _) = sp.sympify(self, strict=True), self.split(span)
        return sp.sqrt(length - aside) * sp.sqrt(length + aside)

    def reach(self, span: sp.Matrix) -> sp.Expr:
        """How far the leg does."""
        return sp.Add(*self.links, self.fore(span))

    def excess(self, span: sp.Matrix) -> sp.Expr:
        """What vanishes if the leg fits between its ends."""
        _, across = self.split(span)
        return across.dot(across) - self.reach(span) ** 2

    def along(self, span: sp.Matrix) -> sp.Matrix:
        """The vector along the rods, from that between the ends."""
        aside, across = self.split(span)
        return aside * self.direction + self.fore(span) / self.reach(span) * across

    def named_along(self, p: Program, tag: str, span: sp.Matrix) -> sp.Matrix:
        """The same in the names of a program; where the rods do not reach, they lead aside."""
        length = sp.sympify(self, strict=True)
        aside = p.let(f"aside{tag}", span.dot(self.direction))
        over, under = (sp.Max(0, length + sign * aside) for sign in (-1, 1))
        fore = p.let(f"fore{tag}", sp.sqrt(over) * sp.sqrt(under), nonnegative=True)
        reach = p.let(f"reach{tag}", sp.Add(*self.links, fore), nonnegative=True)
        share = p.let(f"part{tag}", fore / reach, nonnegative=True)
        return aside * self.direction + share * (span - aside * self.direction)


def rod_of(rod: Any, span: sp.Matrix) -> sp.Matrix:
    """The vector along a rod, from the vector between the ends of its leg."""
    return rod.along(span) if isinstance(rod, Extended) else span


def excess_of(rod: Any, span: sp.Matrix) -> sp.Expr:
    """What vanishes if a rod fits between its ends."""
    if isinstance(rod, Extended):
        return rod.excess(span)
    return span.dot(span) - sp.sympify(rod, strict=True) ** 2


def stretched_by(rod: Any, span: sp.Matrix) -> sp.Expr:
    """Half of the derivative of the excess, per rate along the vector of the rod."""
    return rod.reach(span) / rod.fore(span) if isinstance(rod, Extended) else sp.S.One


__all__ = ["Extended", "excess_of", "rod_of", "stretched_by"]
