"""The last entry of a unit vector, from the others."""

from __future__ import annotations

import sympy as sp

from closedform.lemmas.registry import theorem
from closedform.model.functions import Program
from closedform.model.inverse import Link
from closedform.model.lemma import Lemma

theorem(
    "last entry of a unit vector",
    statement=r"""Let $h = \sqrt{a^2 + b^2}$.  A unit vector with the first entries $a$ and $b$
exists if and only if $h \le 1$.  Its last entry is $c = \sigma\sqrt{(1 - h)(1 + h)}$ with
$\sigma = \pm 1$.""",
    proof=r"""The squares of the entries add up to one, so $c^2 = 1 - h^2 = (1 - h)(1 + h)$, which
has the sign of $1 - h$.""",
)


def last_entry(
    p: Program,
    entries: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    scale: sp.Expr,
    meaning: str,
) -> tuple[Link, sp.Symbol]:
    """The link for the last entry, and its value under a name.

    Parameters
    ----------
    p
        the program that the names and bounds are added to
    entries
        the last entry, which is unknown, and names for the others
    sigma
        the sign of the last entry
    scale
        the scale of the error that is allowed in the others
    meaning
        what is the case if such a vector exists, in words
    """
    (c, a, b), start = entries, len(p.body)
    flat = p.let("flat", sp.sqrt(a**2 + b**2), nonnegative=True)
    below = p.bound("below", 1 - flat, scale, meaning)
    last = p.let("last", sigma * sp.sqrt(below) * sp.sqrt(1 + flat))
    lemma = Lemma(
        "last entry of a unit vector",
        r"c = \sigma\sqrt{(1 - h)(1 + h)},\quad h = \sqrt{a^2 + b^2}",
        (c**2 + a**2 + b**2 - 1,),
        {c: last},
        2,
        signs=(sigma,),
        roles=(("c", c), ("a", a), ("b", b)),
    )
    link = Link(
        unknowns=(c,),
        equations=lemma.equations,
        lemma=lemma,
        body=tuple(p.body[start:]),
        means={last: c},
    )
    return link, last


__all__ = ["last_entry"]
