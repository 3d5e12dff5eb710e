"""Two joints of a wrist whose axes meet at any angle: how far it tilts, and the last rotation."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.lemmas.amplitude import Amplitude
from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.links import degenerate, differs_from_zero, named, vanishing
from closedform.lemmas.pairs import any_pair, direction
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.rotate import Because, terms
from closedform.lemmas.tangent import ANYWHERE, Goal, Reached, Tangency
from closedform.model.functions import Program, choose, real
from closedform.model.inverse import Relation
from closedform.model.lemma import Lemma, label
from closedform.model.tolerances import ROUNDING

theorem(
    "tilt of a wrist",
    statement=r"""Let $k > 0$, and let $v$ be a unit vector.  The equation $k\,(1 - \cos\theta) = 1
- v_3$ has a solution if and only if $m = (v_1^2 + v_2^2)/(1 + |v_3|) + |v_3| - v_3 \le 2k$.  Its
solutions are, for $\sigma = \pm 1$,
$$(\cos\theta, \sin\theta) = \frac{(k - m,\ \sigma\sqrt{m\,(2k - m)})}{k}.$$""",
    proof=r"""Since $v_1^2 + v_2^2 = (1 - |v_3|)(1 + |v_3|)$, the number $m$ is $1 - v_3 \ge 0$,
without a difference of nearly equal numbers.  The equation says $\cos\theta = 1 - m/k$, which is at
most 1, and at least $-1$ if and only if $m \le 2k$.  Then $\sin^2\theta = (1 - \cos\theta)(1 +
\cos\theta) = m\,(2k - m)/k^2$, and either sign of the sine gives an angle.""",
    exception=r"""If $k = 0$, there is no solution unless $v_3 = 1$; then every $\theta$ is one,
and the joint is free.""",
)


@chain_lemma("k (1 - cos x) = 1 - v3", "the pair of x")
def tilt(
    chain: Chain,
    x: sp.Symbol,
    k: sp.Expr,
    v: Sequence[sp.Expr],
    choice: Choice,
    *,
    sense: int = 1,
    toward: Goal = ANYWHERE,
    name: str = "",
) -> Applied:
    """``k (1 - cos x) = 1 - sense v3`` for a column v of a rotation: both solutions.

    This is ``a sin x + b cos x = c`` for a wrist whose first and last axis can be aligned.  Near
    alignment the difference between c and its largest value is small, and v1 and v2 determine it
    more accurately.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    k
        the coefficient
    v
        the column of the rotation
    choice
        the names of the two solutions
    sense
        -1 if the axes are opposite where they are aligned
    toward
        what later joints have to reach; near a tangent, x is turned such that they do
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(x)
    sigma = chain.sign(tag, choice)
    k = chain.coefficient(f"k_tilt{tag}", k, nonnegative=True)
    v1, v2, v3 = v[:3]
    along = sense * v3
    size = sp.Abs(along)
    missed = (v1**2 + v2**2) / (1 + size) + (size - along)
    below = p.let(f"below{tag}", missed, nonnegative=True)
    above = p.bound(f"above{tag}", 2 * k - below, sp.S.One, "the wrist does not tilt as far")
    width = p.let(f"width{tag}", below + above, nonnegative=True)
    flag: Any = sp.false
    if not differs_from_zero(chain, k, sp.S.One):
        flag = p.vanishes(f"level{tag}", width, 1, "the axes of the wrist are parallel", free=(x,))
    cosine = p.let(f"level_at{tag}", (above - below) / 2)
    at = Amplitude(x=x, a=sp.S.Zero, b=k, c=cosine, sigma=sigma, h=k, below=below, above=above)
    found = _reached(chain, at, width, tag, free=flag, toward=toward)
    pair, means = named(chain, x, found.pair)
    lemma = Lemma(
        "tilt of a wrist",
        r"k(1 - \cos\theta) = 1 - v_3 \;\Rightarrow\; (\cos\theta, \sin\theta) = "
        r"\frac{(k - m, \sigma\sqrt{m(2k - m)})}{k},\ "
        r"m = \frac{v_1^2 + v_2^2}{1 + |v_3|} + |v_3| - v_3",
        (k * (1 - sp.cos(x)) - 1 + along,),
        {x: pair.angle},
        2,
        roles=((r"\theta", x), ("k", k), ("v", sp.Matrix([v1, v2, along]))),
    )
    meaning = f"all axes of the wrist are parallel; {x} is free, 0 is returned."
    locus = vanishing(k, v1, v2)
    cases = degenerate(
        flag, [None if locus is None else locus | {v3: sp.sympify(sense, strict=True)}], x, meaning
    )
    return Applied(lemma, pair, means, dict(zip((v1, v2, v3), _unit(), strict=True)), cases)


def _unit() -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Every unit vector but one, in free symbols."""
    a, b = real("tau1"), real("tau2")
    below = 1 + a**2 + b**2
    return 2 * a / below, 2 * b / below, (1 - a**2 - b**2) / below


theorem(
    "tilt of any wrist",
    statement=r"""Let $g$, $w$ and $v$ be unit vectors whose angles with the third axis are $k$, $j$
and $\tau$, with $h = \sin k\sin j > 0$.  The equation $g \cdot R_z(\theta)\,w = v_3$ has a solution
if and only if $m = \cos(k - j) - \cos\tau$ and $n = \cos\tau - \cos(k + j)$ are not negative.
Its solutions are then $\theta = \operatorname{atan2}(g_2 w_1 - g_1 w_2,\ g_1 w_1 + g_2 w_2) +
\sigma\delta$ with $\sigma = \pm 1$ and $\delta = 2\operatorname{atan2}(\sqrt m, \sqrt n)$.""",
    proof=r"""The left side is $g_3 w_3 + h\cos(\theta - \alpha)$ for the angle $\alpha$ of the
stated $\operatorname{atan2}$, because the parts of $g$ and $w$ across the axis have the lengths
$\sin k$ and $\sin j$.  So this is $a\sin\theta + b\cos\theta = c$ with $c = v_3 - g_3 w_3$ and
$g_3 w_3 = \cos k\cos j$.  There $h - c = \cos(k - j) - v_3 = m$ and $h + c = v_3 - \cos(k + j) =
n$.  Where a cosine is positive, $1 - \cos$ is computed as $\sin^2/(1 + \cos)$, which keeps the
digits of a small angle.""",
    exception=r"""If $h = 0$, two axes of the wrist are one; then every $\theta$ is a solution, or
none, and the joint is free.""",
    rests_on=("a sin x + b cos x = c",),
)


@chain_lemma("g . Rz(x) w = v3, for unit vectors", "the pair of x")
def tilt_between(
    chain: Chain,
    x: sp.Symbol,
    axes: tuple[Sequence[sp.Expr], Sequence[sp.Expr]],
    v: Sequence[sp.Expr],
    choice: Choice,
    *,
    toward: Goal = ANYWHERE,
    name: str = "",
) -> Applied:
    """``g . Rz(x) w = v3`` for a column v of a rotation: both solutions.

    Seen from the middle joint of a wrist, g and w are its first and its last axis.  If their angles
    with the middle one are parameters, they may be equal.  Then all three can be in line, and
    ``a sin x + b cos x = c`` loses half of the digits of x there.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint that is solved for
    axes
        the unit vectors g and w, which do not depend on joints
    v
        the column of the rotation
    choice
        the names of the two solutions
    toward
        what later joints have to reach; near a tangent, x is turned such that they do
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(x)
    sigma, start = chain.sign(tag, choice), len(p.body)
    (g1, g2, g3), (w1, w2, w3) = axes
    v1, v2, v3 = v[:3]
    a, b = g2 * w1 - g1 * w2, g1 * w1 + g2 * w2
    first, last = sp.sqrt(sp.simplify(g1**2 + g2**2)), sp.sqrt(sp.simplify(w1**2 + w2**2))
    h = p.let(f"h{tag}", first * last, nonnegative=True)

    aside = p.let(f"aside_tilt{tag}", v1**2 + v2**2)
    margins = []
    for limit, side, meaning in (
        ("least", 1, "the wrist tilts far enough"),
        ("most", -1, "the wrist does not tilt as far"),
    ):
        sine = p.let(f"sine_{limit}{tag}", first * w3 - side * g3 * last)
        within = p.let(
            f"{limit}{tag}", _versine(p, sine**2, h + side * g3 * w3, f"limit_{limit}{tag}")
        )
        tilt = _versine(p, aside, side * v3, f"tilt_{limit}{tag}")
        margin = p.let(f"margin_{limit}{tag}", tilt - within)
        # what is missed of a cosine is more of a small angle
        missed = 2**8 * sp.Max(0, -margin) / ROUNDING
        p.determined(sp.sqrt(aside) + sp.Abs(sine), missed, "the wrist is at its limit")
        margins.append(p.bound(f"{limit}_tilt{tag}", margin, sp.S.One, meaning))
    below, above = margins
    width = p.let(f"width{tag}", below + above, nonnegative=True)
    flag = p.vanishes(f"level{tag}", h, 1, "two axes of the wrist are one", free=(x,))
    cosine = p.let(f"level_at{tag}", (above - below) / 2)
    at = Amplitude(x=x, a=a, b=b, c=cosine, sigma=sigma, h=h, below=below, above=above)
    found = _reached(chain, at, width, tag, free=flag, toward=toward)
    chain.tangent.append(found.tangent)
    pair, means = named(chain, x, found.pair)
    c = v3 - g3 * w3
    away = sp.atan2(sp.sqrt((h - c) * (h + c)), c, evaluate=False)
    told = sp.atan2(a, b, evaluate=False) + sigma * away
    lemma = Lemma(
        "tilt of any wrist",
        r"g \cdot R_z(\theta)\,w = v_3 \;\Rightarrow\; \theta = \operatorname{atan2}(g_2 w_1 - g_1 "
        r"w_2,\ g_1 w_1 + g_2 w_2) + 2\sigma\operatorname{atan2}(\sqrt m, \sqrt n)",
        (a * sp.sin(x) + b * sp.cos(x) + g3 * w3 - v3,),
        {x: pair.angle},
        2,
        signs=(sigma,),
        body=tuple(p.body[start:]),
        roles=(
            (r"\theta", x), ("g", sp.Matrix([g1, g2, g3])), ("w", sp.Matrix([w1, w2, w3])),
            ("v", sp.Matrix([v1, v2, v3])),
        ),
        plainly={below: h - c, above: h + c, x: choose(flag, 0, told)},
    )  # fmt: skip
    meaning = f"two axes of the wrist are one; {x} is free, 0 is returned."
    loci = [vanishing(g1, g2), vanishing(w1, w2)]
    on_axis = [None if at is None else at | {v3: (g3 * w3).xreplace(at)} for at in loci]
    cases = degenerate(flag, on_axis, x, meaning)
    return Applied(lemma, pair, means, dict(zip((v1, v2, v3), _unit(), strict=True)), cases)


def _reached(
    chain: Chain, at: Amplitude, width: sp.Symbol, tag: str, *, free: Any, toward: Goal
) -> Reached:
    """The turn of a wrist for a direction, which is known to some units in the last place."""
    root = chain.program.let(f"root{tag}", at.root, nonnegative=True)
    return toward.reached(
        Tangency(
            chain=chain,
            at=at,
            root=root,
            width=width,
            allowance=2 * ROUNDING,
            suffix=tag,
            free=free,
        )
    )


def _versine(p: Program, square: sp.Expr, cosine: sp.Expr, name: str) -> sp.Expr:
    """1 minus a cosine, from it and from the square of the sine, with all digits."""
    over = p.let(f"over_{name}", choose(cosine > 0, 1 + cosine, 1))  # which is not zero
    return choose(cosine > 0, square / over, 1 - cosine)


theorem(
    "remaining rotation",
    statement=r"""Let $N$ be a rotation that keeps the third unit vector.  In $(-\pi, \pi]$ exactly
one $\theta$ has $R_z(\theta) = N$, which is $\operatorname{atan2}(N_{21}, N_{11})$.""",
    proof=r"""The first two columns of $N$ are orthonormal and normal to the third unit vector, so
$N = R_z(\theta)$ for the angle $\theta$ of the first column, $(\cos\theta, \sin\theta, 0)$.  No
other angle in $(-\pi, \pi]$ has the same sine and cosine.""",
)


@chain_lemma("Rz(x) = N, a rotation about z", "the pair of x")
def spin(
    chain: Chain, x: sp.Symbol, N: sp.Matrix, because: Sequence[Because], *, name: str = ""
) -> Applied:
    """``Rz(x) = N`` for the rotation that remains after the earlier joints.

    N is a rotation about z by the equations that were solved for the unknowns in ``because``: the
    first two entries of its third column are sums of these equations, each times the factor given.
    """
    tag = name or label(x)
    length = chain.program.let(f"unit_{tag}", sp.sqrt(N[0, 0] ** 2 + N[1, 0] ** 2))
    pair, means = named(chain, x, direction(N[1, 0], N[0, 0], length))
    turned = sp.Matrix([[sp.cos(x), -sp.sin(x)], [sp.sin(x), sp.cos(x)], [0, 0]])
    lemma = Lemma(
        "remaining rotation",
        r"R_z(\theta) = N \;\Rightarrow\; \theta = \operatorname{atan2}(N_{21}, N_{11})",
        tuple(turned - N[:, :2]),
        {x: pair.angle},
        1,
    )
    turn = any_pair("tau")
    s, c = turn.s, turn.c
    about_z = dict(zip(N[:, :2], (c, -s, s, c, sp.S.Zero, sp.S.Zero), strict=True))
    relations = tuple(
        Relation(N[i, 2], terms(factors), "that a rotation is one about z")
        for i, factors in enumerate(because)
    )
    return Applied(lemma, pair, means, about_z, relations=relations)
