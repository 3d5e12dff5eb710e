"""A joint that is an input of the inverse, besides the pose."""

from __future__ import annotations

import sympy as sp

from closedform.lemmas.applied import Applied
from closedform.lemmas.registry import theorem
from closedform.model.functions import Program
from closedform.model.lemma import Lemma
from closedform.model.pair import Pair

theorem(
    "given joint",
    statement=r"""Let $\theta_{\text{given}}$ be an angle.  In $(-\pi, \pi]$ exactly one $\theta$
equals it up to whole turns, $\theta = \operatorname{atan2}(\sin\theta_{\text{given}},
\cos\theta_{\text{given}})$.""",
    proof=r"""Angles with the same sine and cosine differ by whole turns, and one of them is in
$(-\pi, \pi]$.""",
)


def given_turn(program: Program, joint: sp.Symbol, value: sp.Symbol) -> Applied:
    """``joint = value``, an angle; the result is its pair."""
    pair = Pair(sp.sin(value), sp.cos(value)).known_as(program, f"_{joint.name}")
    lemma = Lemma(
        "given joint",
        r"\theta = \theta_{\text{given}}",
        (sp.cos(joint) - sp.cos(value), sp.sin(joint) - sp.sin(value)),
        {joint: pair.angle},
        1,
    )
    return Applied(lemma, pair, {pair.s: sp.sin(joint), pair.c: sp.cos(joint)})


def given_slide(joint: sp.Symbol, value: sp.Symbol) -> Applied:
    """``joint = value``, a length; the result is the value."""
    lemma = Lemma("slide", r"d = d_{\text{given}}", (joint - value,), {joint: value}, 1)
    return Applied(lemma, value)


__all__ = ["given_slide", "given_turn"]
