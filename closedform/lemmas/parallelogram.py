"""Parallelogram linkages: in a plane, and the pair of rods that carries a hand in space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.lemma import Lemma

theorem(
    "parallelogram",
    statement=r"""Let $l, a > 0$, and let the points $l e^{i\theta}$ and $a e^{i\gamma}$ of the
plane be distinct.  The equation $l e^{i\theta} + a e^{i(\gamma + \varphi)} = a e^{i\gamma} + l
e^{i\beta}$ has two solutions $(\varphi, \beta)$: the parallelogram, $(0, \theta)$, and the
crossed one,
$$\tan\frac{\varphi}{2} = \frac{l\sin(\theta - \gamma)}{l\cos(\theta - \gamma) - a}, \qquad
\beta = 2\gamma + \varphi - \theta.$$
They coincide if and only if the linkage is flat: $\sin(\theta - \gamma) = 0$.""",
    proof=r"""Either side is the point $P$ in which the coupler meets the rod.  It is at the
distance $a$ from $L = l e^{i\theta}$ and $l$ from $F = a e^{i\gamma}$.  Two circles about these
points have two points in common, mirror images of each other in the line $LF$.  One is $L + F$:
there the sides are parallel, $\varphi = 0$ and $\beta = \theta$.  Let $\delta$ be the direction
of $L - F$.  The mirror image turns the direction $\gamma$ from $L$ to $P$ into $2\delta -
\gamma$, and the direction $\theta$ from $F$ to $P$ into $2\delta - \theta$.  So $\varphi =
2(\delta - \gamma)$ and $\beta = 2\delta - \theta = 2\gamma + \varphi - \theta$.  The vector $(L
- F) e^{-i\gamma} = l e^{i(\theta - \gamma)} - a$ has the direction $\delta - \gamma =
\varphi/2$, which gives the tangent.  Both points are the same if $L + F$ is on the line $LF$,
that is, if $L$ and $F$ are in line with the origin.""",
    exception=r"""If $l = a$ and $\theta = \gamma$, the points $L$ and $F$ are the same, and
$\varphi$ is free.""",
    rests_on=("circle intersection",),
)

theorem(
    "parallelogram in space",
    statement=r"""Two rods of length $l > 0$ join the ends of two bars of length $2h > 0$ by ball
joints.  The bars have the directions $\mathbf u$ and $\mathbf v$, both unit vectors, and $\mathbf
r$ leads from the middle of the first to the middle of the second.  The rods fit if and only if
$$\mathbf r\cdot(\mathbf v - \mathbf u) = 0 \quad\text{and}\quad |\mathbf r|^2 + h^2 |\mathbf v -
\mathbf u|^2 = l^2.$$ If $\mathbf v = \mathbf u$, this is a parallelogram, and $|\mathbf r| = l$.
Let three of them join a hand to bars whose directions $\mathbf u_k$ do not turn, and let
$\mathbf v_k = R\,\mathbf u_k$, where $R$ is the rotation of the hand.  If the normals $\mathbf
n_k = \mathbf u_k\times\mathbf r_k$ of the parallelograms are not in one plane, no continuous
motion leads away from $R = I$.""",
    proof=r"""The rods are $\mathbf r\pm h(\mathbf v - \mathbf u)$.  Half of the sum of their
squares is $|\mathbf r|^2 + h^2|\mathbf v - \mathbf u|^2$, and the difference is $4h\,\mathbf
r\cdot(\mathbf v - \mathbf u)$.  The equations $f_k = \mathbf r_k\cdot(R\,\mathbf u_k - \mathbf
u_k) = 0$ hold if $R = I$, wherever the hand is.  There the derivative of $f_k$, while the hand
turns with the rate $\boldsymbol\omega$ and moves in any way, is $\mathbf
r_k\cdot(\boldsymbol\omega\times\mathbf u_k) = \boldsymbol\omega\cdot\mathbf n_k$.  If the normals
are not in one plane, these three are zero only for $\boldsymbol\omega = 0$.  Then $R = I$ is
the only solution in a neighbourhood, by the implicit function theorem.""",
    exception=r"""If the normals are in one plane, the hand can begin to turn: a constraint
singularity.  The other solutions, $\mathbf v\ne\mathbf u$, are crossed or twisted.""",
)

theorem(
    "three parallel rods",
    statement=r"""Two rods of length $l > 0$ form a parallelogram whose bars have the direction
$\mathbf u$, and $\mathbf r$ leads from the middle of the first bar to the middle of the second.
A third rod of length $l$ leads from the end of $\mathbf s$, seen from the middle of the first bar,
to that of $R\,\mathbf s$, seen from the middle of the second, where $R$ is the rotation of the body
with the second bar against the body with the first.  If $R = I$, it is parallel to the two others,
and fits.  While the body with the second bar turns with the rate $\boldsymbol\omega$ and the first
one does not, the lengths of the rods require $\boldsymbol\omega\cdot(\mathbf u\times\mathbf r) =
\boldsymbol\omega\cdot(\mathbf s\times\mathbf r) = 0$.  So if such a leg and a parallelogram join a
hand to bodies that do not turn, and the normals of the parallelogram and these two vectors are not
in one plane, no continuous motion leads away from $R = I$.""",
    proof=r"""The third rod is $\mathbf r + R\,\mathbf s - \mathbf s$, which is $\mathbf r$ if $R =
I$.  Its squared length and that of $\mathbf r$ have derivatives that differ by $2\,\mathbf
r\cdot(\boldsymbol\omega\times\mathbf s) = 2\,\boldsymbol\omega\cdot(\mathbf s\times\mathbf r)$
there, and $|\mathbf r| = l$ at first order because of the two other rods.  The rest is the
argument of the parallelogram in space.""",
    exception=r"""If the three vectors are in one plane, the hand can begin to turn: a constraint
singularity.  Of three rods alone this is so everywhere: both vectors are at right angles to
$\mathbf r$, about which the hand turns.""",
)


@dataclass(frozen=True)
class Parallelogram:
    """Two equal rods between two equal bars, instead of one rod: they keep a body from turning.

    It replaces the ``rod`` of a leg or the ``length`` of a crank.  ``bar`` is the direction of the
    bars, a unit vector, and ``width`` is their length.  The width drops out of all equations and
    matters only for the drawing.

    The crossed linkage with the same rods and bars, the antiparallelogram, is left out, and so are
    twisted ones in space.
    """

    length: Any
    bar: Sequence[Any]
    width: Any

    def _sympy_(self) -> sp.Expr:
        return sp.sympify(self.length, strict=True)

    @property
    def direction(self) -> sp.Matrix:
        return sp.Matrix([sp.sympify(e, strict=True) for e in self.bar])

    @property
    def half(self) -> sp.Expr:
        """Half of the width."""
        return sp.sympify(self.width, strict=True) / 2

    def couple(self, rod: sp.Matrix) -> sp.Matrix:
        """The direction about which it keeps the hand from turning, from the vector along it."""
        return self.direction.cross(rod)

    def couples(self, rod: sp.Matrix) -> list[sp.Matrix]:
        """All such directions."""
        return [self.couple(rod)]


@dataclass(frozen=True)
class Prism(Parallelogram):
    """Three equal rods between two equal triangles, as on a Gantry-Tau, instead of one rod.

    Two of them are a parallelogram.  ``apex`` leads from the middle between them to the third one,
    on either body.  It takes two freedoms of turning from a hand, and the width matters as little
    as that of a parallelogram.
    """

    apex: Sequence[Any]

    @property
    def aside(self) -> sp.Matrix:
        """From the middle between two rods to the third one."""
        return sp.Matrix([sp.sympify(e, strict=True) for e in self.apex])

    def couples(self, rod: sp.Matrix) -> list[sp.Matrix]:
        """The directions about which it keeps the hand from turning; the second has unit size."""
        size = sp.sqrt(sp.factor(self.aside.dot(self.aside)))
        return [self.couple(rod), (self.aside / size).cross(rod)]


def parallelogram(
    lengths: tuple[sp.Expr, sp.Expr],
    angles: tuple[sp.Expr, sp.Expr],
    unknowns: tuple[sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
) -> Lemma:
    """The four-bar linkage with equal opposite sides: its two assemblies.

    ``lengths`` are that of the crank and the rod, and that of the coupler and the fixed link;
    ``angles`` are those of the crank and of the fixed link in a common plane.  The ``unknowns``
    are the turn of the coupler against the fixed link and the angle of the rod.

    With the plus sign the linkage is a parallelogram, and the coupler does not turn; with the minus
    sign it is an antiparallelogram.  They meet where the linkage is flat.  The antiparallelogram
    has a free turn where it is flat with equal sides.
    """
    (crank, coupler), (angle, frame), (turn, rod) = lengths, angles, unknowns
    bend = angle - frame
    half = sp.atan2(crank * sp.sin(bend), crank * sp.cos(bend) - coupler)
    turned = (1 - sigma) * half
    return Lemma(
        "parallelogram",
        r"l\,e^{i\theta} + a\,e^{i(\gamma + \varphi)} = a\,e^{i\gamma} + l\,e^{i\beta} "
        r"\;\Rightarrow\; (\varphi, \beta) = (0, \theta) \text{ or } "
        r"\tan\frac{\varphi}{2} = \frac{l\sin(\theta - \gamma)}{l\cos(\theta - \gamma) - a},\ "
        r"\beta = 2\gamma + \varphi - \theta",
        tuple(
            crank * (f(angle) - f(rod)) + coupler * (f(frame + turn) - f(frame))
            for f in (sp.cos, sp.sin)
        ),
        {turn: turned, rod: sigma * angle + (1 - sigma) * frame + turned},
        2,
        signs=(sigma,),
    )
