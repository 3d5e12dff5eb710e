"""A slide from a product, whose other factor depends on the posture."""

from __future__ import annotations

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain
from closedform.lemmas.links import degenerate, differs_from_zero, vanishing
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.model.functions import choose
from closedform.model.lemma import Lemma, label

theorem(
    "slide from a product",
    statement=r"""If $k \ne 0$, the equation $k\,d = c$ has exactly one solution, $d = c/k$.""",
    proof=r"""Both sides are divided by $k$.""",
    exception=r"""If $k = c = 0$, every $d$ is a solution: the slide is free.  If $k = 0 \ne c$,
there is no solution.""",
)


@chain_lemma("k d = c", "d")
def quotient(
    chain: Chain,
    d: sp.Symbol,
    k: sp.Expr,
    c: sp.Expr,
    *,
    meaning: str,
    name: str = "",
) -> Applied:
    """``k d = c``: one solution.  d is free where k vanishes, as another slide is parallel there.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    d
        the prismatic joint that is solved for
    k
        the factor, which is 1 at most: the square of the sine of the angle between slides
    c
        the product
    meaning
        where k vanishes, in words
    name
        what the names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(d)
    k = chain.coefficient(f"k_{tag}", k, nonnegative=True)
    c = chain.coefficient(f"c_{tag}", c)
    flag = sp.false
    if not differs_from_zero(chain, k, sp.S.One):
        flag = p.vanishes(f"along_{tag}", k, 1, meaning, free=(d,), squares=True)
    value = p.let(f"{d.name}_", choose(flag, 0, c / k))
    chain.d.write(value, same=d.name)
    lemma = Lemma(
        "slide from a product",
        r"k\,d = c \;\Rightarrow\; d = c/k",
        (k * d - c,),
        {d: value},
        1,
        roles=(("k", k), ("d", d), ("c", c)),
    )
    cases = degenerate(flag, [vanishing(k, c)], d, f"{meaning}; {d} is free, 0 is returned.")
    return Applied(lemma, value, {value: d}, {}, cases)
