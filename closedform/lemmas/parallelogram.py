"""A parallelogram linkage."""

from __future__ import annotations

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
distance $a$ from $L = l e^{i\theta}$ and $l$ from $F = a e^{i\gamma}$.  Two circles have two
points in common, mirror images of each other in the line $LF$.  One is $L + F$: there the sides
are parallel, $\varphi = 0$ and $\beta = \theta$.  Let $\delta$ be the direction of $L - F$.  The
mirror image turns the direction $\gamma$ from $L$ to $P$ into $2\delta - \gamma$, and the
direction $\theta$ from $F$ to $P$ into $2\delta - \theta$.  So $\varphi = 2(\delta - \gamma)$ and
$\beta = 2\delta - \theta = 2\gamma + \varphi - \theta$.  The vector $(L - F) e^{-i\gamma} = l
e^{i(\theta - \gamma)} - a$ has the direction $\delta - \gamma = \varphi/2$, which gives the
tangent.  Both points are the same if $L + F$ is on the line $LF$, that is, if $L$ and $F$ are in
line with the origin.""",
    exception=r"""If $l = a$ and $\theta = \gamma$, the points $L$ and $F$ are the same, and
$\varphi$ is free.""",
    rests_on=("circle intersection",),
)


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
