"""Where functions without a status find no posture.

A forward map says, by its status or by NaN, where the workspace ends.  Other functions of the
joints compute the same posture once more, with other rounding errors.  They tolerate more than the
forward map, so that in every language they find each posture that it finds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Function, Statement, Vanishes

LOOSER = sp.Rational(5, 4)
"""The tolerance of such functions, as a multiple of that of the forward map."""


def within_edge(function: Function, derivation: Derivation) -> Function:
    """The function; with larger tolerances, if it has the inputs of a map that is inverted."""
    maps = {inverse.images for inverse in derivation.inverses} - {""}
    if function.has_status or function.name in maps:
        return function
    if all(function.inputs != derivation[name].inputs for name in maps):
        return function
    return replace(function, body=tuple(_loosened(function.body)))


def _loosened(body: Sequence[Statement]) -> list[Statement]:
    """The statements with larger tolerances; a flag with the scale of a bound changes with it."""
    scales = {s.scale for s in body if isinstance(s, Bound)}
    return [
        replace(s, scale=_looser(s.scale))
        if isinstance(s, Bound | Vanishes) and s.scale in scales
        else s
        for s in body
    ]


def _looser(scale: sp.Expr) -> sp.Expr:
    """The scale times the factor; a sum is not multiplied term by term."""
    number, rest = scale.as_coeff_Mul()
    return sp.Mul(number * LOOSER, rest, evaluate=False)


__all__ = ["within_edge"]
