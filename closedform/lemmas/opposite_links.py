"""The angle by which two links turn against each other, from the distance that they reach."""

from __future__ import annotations

from typing import Any

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.chain import Chain, Choice
from closedform.lemmas.links import differs_from_zero, named
from closedform.lemmas.registry import chain_lemma, theorem
from closedform.lemmas.triangle import indexed
from closedform.model.functions import choose
from closedform.model.lemma import Lemma, label
from closedform.model.pair import Pair

theorem(
    "links that turn against each other",
    statement=r"""Let $l_1, l_2 > 0$, $h \ge 0$ and $r \ge 0$, and let $L = l_1 + l_2$, $D = l_1 -
l_2$ and $K = 4 l_1 l_2$.  The equation $(L\cos\theta + h)^2 + (D\sin\theta)^2 = r^2$ has the
solutions
$$(\cos\theta, \sin\theta) = \frac{(u - h,\ \sigma\sqrt{(L + h - u)(L - h + u)})}{L}, \qquad u =
\frac{-D^2 h + \tau L\sqrt E}{K}, \qquad \sigma, \tau = \pm 1,$$
with $E = D^2(h^2 - K) + K r^2$, where $E$ and both factors under the root are not negative.  The
greater $u$ is also $\bigl(L^2 r^2 - D^2(L - h)(L + h)\bigr)/(D^2 h + L\sqrt E)$.""",
    proof=r"""Let $u = L\cos\theta + h$.  Then $L^2\sin^2\theta = L^2 - (u - h)^2$, which is the
product $(L + h - u)(L - h + u)$, and since $L^2 - D^2 = K$, the equation times $L^2$ says $K u^2 +
2 D^2 h u + D^2(L^2 - h^2) - L^2 r^2 = 0$.  A quarter of the discriminant is $L^2 E$, which gives
$u$.  The product of both roots is $\bigl(D^2(L^2 - h^2) - L^2 r^2\bigr)/K$, which gives the other
form of the greater one.  The cosine follows from $u$, and the sine has either sign.""",
    exception="If a link has no length, another lemma is needed.",
)


@chain_lemma("((l1 + l2) cos x + h)^2 + ((l1 - l2) sin x)^2 = r^2", "the pair of x")
def opposite_links(
    chain: Chain,
    x: sp.Symbol,
    lengths: tuple[sp.Expr, sp.Expr, sp.Expr],
    r: sp.Expr,
    choices: tuple[Choice, Choice],
    *,
    name: str = "",
) -> Applied:
    """The angle x and its opposite, by which two links turn: up to four solutions.

    Their ends are r apart, with a third length h along the line from which both angles are
    measured.  The status is INVALID if l1 or l2 is zero.

    Parameters
    ----------
    chain
        the chain that the lemma extends
    x
        the joint or the auxiliary angle that is solved for
    lengths
        l1, l2 and h
    r
        the distance
    choices
        the names of the two values of cos(x), the greater one first, and of the signs of sin(x)
    name
        the name of the sign and what other names end in, by default the number of the joint
    """
    p, tag = chain.program, name or label(x)
    tau, sigma = (
        chain.sign(sign, choice) for sign, choice in zip((f"{tag}_root", tag), choices, strict=True)
    )
    l1, l2, h = (
        chain.coefficient(f"{n}_{tag}", e, nonnegative=True)
        for n, e in zip(("l1", "l2", "h"), lengths, strict=True)
    )
    r = chain.named(f"r_{tag}", r, nonnegative=True)
    if not differs_from_zero(chain, l1 * l2, (l1 + l2) ** 2):
        meaning = "both links have a length"
        none = p.vanishes(f"no_link_{tag}", l1 * l2, (l1 + l2) ** 2, "a link has no length")
        p.require([choose(none, 1, 0)], sp.S.One, meaning)
    L, K = (
        p.let(f"{n}_{tag}", e, nonnegative=True) for n, e in (("L", l1 + l2), ("K", 4 * l1 * l2))
    )
    D = p.let(f"D_{tag}", l1 - l2)
    # half, so that a clamped bound stays well within the promised accuracy
    E = p.bound(
        f"E_{tag}",
        D**2 * (h**2 - K) + K * r**2,
        K * r * chain.size,
        "the distance is not too short",
    )
    offset = p.let(f"offset_{tag}", D**2 * h, nonnegative=True)
    root = p.let(f"root_{tag}", L * sp.sqrt(E), nonnegative=True)
    greater: Any = (root - offset) / K
    if h != 0:  # without a difference of nearly equal numbers
        product = L**2 * r**2 - D**2 * (L - h) * (L + h)
        greater = sp.Piecewise((product / (offset + root), 2 * offset > root), (greater, True))
    greater = p.let(f"greater_{tag}", greater)
    lesser = p.let(f"lesser_{tag}", -(offset + root) / K)
    u = p.let(f"u_{tag}", (1 + tau) / 2 * greater + (1 - tau) / 2 * lesser)
    N, M = (
        p.bound(f"{n}_{tag}", value, chain.size / 2, meaning)
        for n, value, meaning in (
            ("N", (L + h) - u, "nearer than full stretch"),
            ("M", (L - h) + u, "farther than the fold"),
        )
    )
    whole = p.let(f"sum_{tag}", N + M, nonnegative=True)
    found = Pair(2 * sigma * sp.sqrt(N) * sp.sqrt(M) / whole, (M - N) / whole)
    pair, means = named(chain, x, found)
    lemma = Lemma(
        "links that turn against each other",
        r"(L\cos\theta + h)^2 + (D\sin\theta)^2 = r^2 \;\Rightarrow\; (\cos\theta, \sin\theta) = "
        r"\frac{(u - h,\ \sigma\sqrt{(L + h - u)(L - h + u)})}{L}",
        (((l1 + l2) * sp.cos(x) + h) ** 2 + ((l1 - l2) * sp.sin(x)) ** 2 - r**2,),
        {x: pair.angle},
        4,
        plainly={
            u: (tau * L * sp.sqrt(E) - D**2 * h) / K,
            x: sp.atan2(sigma * sp.sqrt((L + h - u) * (L - h + u)), u - h),
        },
        letters={u: indexed("u", tag)},
        roles=((r"\theta", x), ("l_1", l1), ("l_2", l2), ("h", h), ("r", r)),
    )
    return Applied(lemma, pair, means)


__all__ = ["opposite_links"]
