"""The lemma of links that turn against each other: for all lengths, and a wrong one is found."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import sympy as sp

from closedform.lemmas.chain import Chain
from closedform.lemmas.links import slide
from closedform.lemmas.opposite_links import opposite_links
from closedform.model.derivation import Derivation, Paper
from closedform.proof.links import prove_lemma
from closedform.proof.require import ProofError

SIGNS = {+1: "a", -1: "b"}, {+1: "c", -1: "d"}


def applied(h: Any = None) -> Chain:
    """The lemma for a distance that another joint gives."""
    d = Derivation("toy", "Toy", Paper("toy", "Toys", ("A.",)), "Links.", task=["x", "y"])
    l1, l2, h1 = (d.parameter(n, value=1, unit="m", meaning=n) for n in ("l1", "l2", "h"))
    x, s = d.joint("x"), d.joint("s", "prismatic")
    h = h1 if h is None else h
    square = ((l1 + l2) * sp.cos(x) + h) ** 2 + ((l1 - l2) * sp.sin(x)) ** 2
    ik = Chain(d, [sp.sqrt(square), s])
    ik.solve(slide, s, ik.x[1])
    ik.solve(opposite_links, x, (l1, l2, h), ik.x[0], SIGNS)
    return ik


@pytest.mark.parametrize("h", [None, sp.S.Zero])
def test_it_has_four_solutions_for_all_lengths(h: Any) -> None:
    ik = applied(h)
    _, counted = prove_lemma(ik.links[-1], [s for s, _ in ik.choices], "")
    assert counted.count == 4


@pytest.mark.parametrize(
    "wrong",
    [
        lambda link: {"unknown": -link.lemma.solution[link.unknowns[0]] + sp.pi / 6},
        lambda link: {"branches": 2},
    ],
)
def test_a_wrong_one_is_found(wrong: Any) -> None:
    ik = applied()
    link = ik.links[-1]
    changed = wrong(link)
    if "unknown" in changed:
        lemma = replace(link.lemma, solution={link.unknowns[0]: changed["unknown"]})
    else:
        lemma = replace(link.lemma, **changed)
    with pytest.raises(ProofError, match=r"does not satisfy its equations|4 solutions"):
        prove_lemma(replace(link, lemma=lemma), [s for s, _ in ik.choices], "")


def test_both_forms_of_the_greater_root_are_equal() -> None:
    l1, l2, h, r = (sp.Rational(k, 7) for k in (3, 2, 4, 6))
    L, D, K = l1 + l2, l1 - l2, 4 * l1 * l2
    E = D**2 * (h**2 - K) + K * r**2
    one = (L * sp.sqrt(E) - D**2 * h) / K
    other = (L**2 * r**2 - D**2 * (L - h) * (L + h)) / (D**2 * h + L * sp.sqrt(E))
    assert np.isclose(float(one), float(other)) and sp.simplify(one - other) == 0
