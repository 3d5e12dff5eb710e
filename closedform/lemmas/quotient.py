"""A slide from a product, whose other factor depends on the posture."""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain
from closedform.lemmas.links import degenerate, differs_from_zero, vanishing
from closedform.lemmas.on_rail import LinksAlongSlide
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.model.functions import choose, real
from closedform.model.inverse import Degenerate
from closedform.model.lemma import Lemma, label
from closedform.model.tolerances import ROUNDING

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
    missed: sp.Expr = sp.S.Zero,
    reaching: LinksAlongSlide | None = None,
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
    missed
        a length that has to vanish where k does, if nothing compares it later
    reaching
        what the rest of the arm has to reach, if the slide decides on it
    name
        what the names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(d)
    k = chain.coefficient(f"k_{tag}", k, nonnegative=True)
    c = chain.coefficient(f"c_{tag}", c)
    flag: Any = sp.false
    if not differs_from_zero(chain, k, sp.S.One):
        flag = p.vanishes(f"along_{tag}", k, 1, meaning, free=(d,), squares=True)
    if flag is not sp.false and missed != 0:
        # half: what is allowed here stays well within the round trip that is promised
        p.match(choose(flag, missed, 0), chain.size / 2, f"{d.name} does not move the point there")
    found, returned = choose(flag, 0, c / k), "0 is returned."
    near: tuple[sp.Symbol, ...] = ()
    free: dict[sp.Symbol, sp.Expr] = {}
    if reaching is not None:
        found, near, free = _within_reach(chain, k, found, reaching, tag)
        returned = "a value within reach is returned."
    value = p.let(f"{d.name}_", found)
    chain.d.write(value, same=d.name)
    lemma = Lemma(
        "slide from a product",
        r"k\,d = c \;\Rightarrow\; d = c/k",
        (k * d - c,),
        {d: value},
        1,
        roles=(("k", k), ("d", d), ("c", c)),
    )
    locus = vanishing(k, c)
    cases = degenerate(flag, [locus], d, f"{meaning}; {d} is free, {returned}")
    if near and locus is not None:
        cases += (Degenerate(near, locus | free, None, meaning),)
    return Applied(lemma, value, {value: d}, {}, cases)


def _within_reach(
    chain: Chain, k: sp.Expr, d: sp.Expr, reaching: LinksAlongSlide, tag: str
) -> tuple[sp.Expr, tuple[sp.Symbol, ...], dict[sp.Symbol, sp.Expr]]:
    """The slide, changed by no more than rounding so that links reach.

    Also returns the flag that it is, and the free choice as any number.
    """
    p, size = chain.program, chain.size
    raw = p.let(f"raw_{tag}", d)
    near = p.let(f"near_{tag}", reaching.nearest(chain, raw, f"_{tag}"))
    doubt = sp.sqrt(k) * sp.Abs(near - raw) - 4 * ROUNDING * (size + sp.Abs(near))
    moves = p.vanishes(f"moves_{tag}", doubt, size, "the slide is free up to rounding")
    return choose(moves, near, raw), (moves,), {near: real("t")}
