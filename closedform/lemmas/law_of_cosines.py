"""The elbow of two links whose ends have a known distance, without cancellation."""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.links import degenerate, differs_from_zero, named
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.tangent import ANYWHERE, Goal, Tangency
from closedform.lemmas.triangle import Triangle
from closedform.model.functions import choose
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair
from closedform.model.tolerances import ROUNDING

theorem(
    "law of cosines",
    statement=r"""Let $l_1, l_2 > 0$ and $r \ge 0$.  With the factors $\mathcal S = l_1 + l_2 + r$,
$\mathcal A = l_1 + l_2 - r$, $\mathcal B = r + l_1 - l_2$ and $\mathcal C = r - l_1 + l_2$, the
equation $l_1^2 + l_2^2 + 2 l_1 l_2 \cos\theta = r^2$ has a solution if and only if $\mathcal A$,
$\mathcal B$ and $\mathcal C$ are not negative.  The solutions are
$$(\cos\theta, \sin\theta) = \frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\ 2\sigma\sqrt{
\mathcal S\mathcal A\mathcal B\mathcal C})}{\mathcal B\mathcal C + \mathcal S\mathcal A},\qquad
\sigma = \pm 1.$$""",
    proof=r"""The products are $\mathcal B\mathcal C = r^2 - (l_1 - l_2)^2$ and
$\mathcal S\mathcal A = (l_1 + l_2)^2 - r^2$.  So the equation says $2 l_1 l_2\,(1 + \cos\theta) =
\mathcal B\mathcal C$ and $2 l_1 l_2\,(1 - \cos\theta) = \mathcal S\mathcal A$.  The sum of both is
$4 l_1 l_2 = \mathcal B\mathcal C + \mathcal S\mathcal A$, and the difference gives $\cos\theta$.
There is such an angle if and only if neither product is negative: since $\mathcal S > 0$, and
$\mathcal B + \mathcal C = 2r$ is not negative, this means that no factor is.  The product of both
is $4 l_1^2 l_2^2 \sin^2\theta = \mathcal S\mathcal A\mathcal B\mathcal C$, and either sign of the
sine gives an angle.""",
    exception=r"""If a link has no length, $\theta$ is free where there is a solution.  A stretched
arm is returned, unless later joints need another one.""",
)


@chain_lemma("l1^2 + l2^2 + 2 l1 l2 cos x = r^2", "the pair of x")
def law_of_cosines(
    chain: Chain,
    x: sp.Symbol,
    lengths: tuple[sp.Expr, sp.Expr],
    r: sp.Expr,
    choice: Choice,
    *,
    toward: Goal = ANYWHERE,
    name: str = "elbow",
) -> Applied:
    """The elbow of two links whose ends are r apart: two solutions.

    It is free if a link has no length; then 0 is returned, or what ``toward`` needs.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    lengths
        l1 and l2
    r
        the distance of the ends
    choice
        the names of the two elbows, by the sign of sin(x)
    toward
        what later joints have to reach; near a stretched or folded elbow, x is turned such that
        they do
    name
        the name of the sign, and what other names end in
    """
    p = chain.program
    sigma = chain.sign(name, choice)
    l1, l2 = (
        chain.coefficient(f"l{i}_{name}", e, nonnegative=True) for i, e in enumerate(lengths, 1)
    )
    r = chain.named(f"r_{name}", r, nonnegative=True)
    # half, so that a clamped bound stays well within the promised accuracy
    triangle = Triangle.from_reach(p, (l1, l2), r, sigma, scale=chain.size / 2, suffix=f"_{name}")
    flag: Any = sp.false
    if not differs_from_zero(chain, l1 * l2, (l1 + l2) ** 2):
        flag = p.vanishes(
            f"no_link_{name}", l1 * l2, (l1 + l2) ** 2, "a link has no length", free=(x,)
        )
    twice = p.let(f"area_{name}", 2 * triangle.root, nonnegative=True)
    whole = p.let(f"sum_{name}", triangle.whole, nonnegative=True)
    bent = triangle.elbow_pair(twice, whole)
    if toward is not ANYWHERE:
        turn = _tangency(chain, x, triangle, (twice, whole, r), name)
        reached = toward.reached(turn)
        bent = reached.pair
        chain.tangent.append(reached.tangent)
    free = Pair(sp.S.Zero, sp.S.One) if flag is sp.false else toward.anywhere(p, f"_{name}")
    pair, means = named(chain, x, Pair(choose(flag, free.s, bent.s), choose(flag, free.c, bent.c)))
    lemma = Lemma(
        "law of cosines",
        r"l_1^2 + l_2^2 + 2 l_1 l_2 \cos\theta = r^2 \;\Rightarrow\; (\cos\theta, \sin\theta) = "
        r"\frac{(\mathcal B\mathcal C - \mathcal S\mathcal A,\ "
        r"2\sigma\sqrt{\mathcal S\mathcal A\mathcal B\mathcal C})}"
        r"{\mathcal B\mathcal C + \mathcal S\mathcal A}",
        (l1**2 + l2**2 + 2 * l1 * l2 * sp.cos(x) - r**2,),
        {x: pair.angle},
        2,
        roles=((r"\theta", x), ("l_1", l1), ("l_2", l2), ("r", r)),
        letters=triangle.letters,
    )
    loci = [{gone: sp.S.Zero, r: other} for gone, other in ((l1, l2), (l2, l1)) if gone.is_Symbol]
    returned = "0" if free.s == 0 else "one within reach"
    cases = degenerate(
        flag, loci, x, f"a link without length: {x} is free, {returned} is returned."
    )
    return Applied(lemma, pair, means, {}, cases)


def _tangency(
    chain: Chain,
    x: sp.Symbol,
    triangle: Triangle,
    names: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    name: str,
) -> Tangency:
    """The elbow as the turn ``h cos x = c`` with ``h = l1 l2 / size``, in units of a length.

    The names are those of twice the area, of ``4 l1 l2`` and of the distance of the ends.
    """
    p, size, (twice, whole, r) = chain.program, chain.size, names
    lever = p.let(f"lever_{name}", twice / (4 * size), nonnegative=True)
    span = p.let(f"span_{name}", whole / (2 * size), nonnegative=True)
    h = p.let(f"h_{name}", span / 2, nonnegative=True)
    below, above = triangle.N / (2 * size), triangle.M / (2 * size)
    at = Amplitude(
        x=x, a=sp.S.Zero, b=h, c=h - below, sigma=triangle.sigma, h=h, below=below, above=above
    )
    allowance = (r + size * ROUNDING) * ROUNDING
    return Tangency(
        chain=chain,
        at=at,
        root=lever,
        width=span,
        allowance=allowance,
        suffix=f"_{name}",
        free=sp.false,
    )


__all__ = ["law_of_cosines"]
