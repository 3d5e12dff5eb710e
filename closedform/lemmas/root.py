"""A slide from a distance, as a square root."""

from __future__ import annotations

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.model.lemma import Lemma, label

theorem(
    "slide from a distance",
    statement=r"""Let $r \ge 0$ and $h \ge 0$.  The equation $(d + e)^2 = r^2 - h^2$ has a solution
if and only if $h \le r$.  Its solutions are $d = \sigma\sqrt{(r - h)(r + h)} - e$ with $\sigma =
\pm 1$.""",
    proof=r"""A square is not negative, and $r^2 - h^2 = (r - h)(r + h)$ has the sign of $r - h$.
If it is not negative, its two roots are the values of $d + e$.""",
)


@chain_lemma("(d + e)^2 = r^2 - h^2", "d")
def root(
    chain: Chain,
    d: sp.Symbol,
    e: sp.Expr,
    lengths: tuple[sp.Expr, sp.Expr],
    choice: Choice,
    *,
    name: str = "",
) -> Applied:
    """``(d + e)^2 = r^2 - h^2`` for lengths r and h: two solutions, by the sign of d + e.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    d
        the prismatic joint or the auxiliary length that is solved for
    e
        what is added to it
    lengths
        r and h
    choice
        the names of the two solutions, by the sign of d + e
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(d)
    sigma = chain.sign(tag, choice)
    e = chain.coefficient(f"e_{tag}", e)
    r, h = (
        chain.coefficient(f"{n}_root{tag}", value, nonnegative=True)
        for n, value in zip("rh", lengths, strict=True)
    )
    # half, so that a clamped bound stays well within the promised accuracy
    below = p.bound(f"below{tag}", r - h, chain.size / 2, "the distance is not too short")
    value = p.let(f"{d.name}_{tag}", sigma * sp.sqrt(below) * sp.sqrt(r + h) - e)
    lemma = Lemma(
        "slide from a distance",
        r"(d + e)^2 = r^2 - h^2 \;\Rightarrow\; d = \sigma\sqrt{(r - h)(r + h)} - e",
        ((d + e) ** 2 - r**2 + h**2,),
        {d: value},
        2,
    )
    return Applied(lemma, value, {value: d})
