"""A parallelogram linkage."""

from __future__ import annotations

import sympy as sp

from closedform.model.lemma import Lemma


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
