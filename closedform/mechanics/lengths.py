"""The lengths of a mechanism that are numbers, not parameters."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Let

TURNS = sp.sin, sp.cos
POSTURES, STARTS, SWEEPS, DIRECTIONS = 1024, 16, 4, 180
"""How many postures are tried for a reach, how many of them are improved, and how often and how
finely each joint is turned for that."""


def lengths_in_numbers(place: sp.Expr, names: Mapping[sp.Basic, sp.Expr] | None = None) -> sp.Expr:
    """The lengths in a coordinate that are numbers, not parameters: 3 in 3 cos(theta).

    ``names`` are those of values for which the same is known.
    """
    names = names or {}
    total = sp.S.Zero
    for size, factors in _terms(place):
        for base, _ in factors:
            size *= 1 if isinstance(base, TURNS) else names.get(base, 0)
        total += abs(size)
    return total


def _terms(place: sp.Expr) -> Iterator[tuple[sp.Expr, list[tuple[sp.Expr, sp.Expr]]]]:
    """The terms of a coordinate: a number, and the bases and exponents of the other factors."""
    for term in sp.Add.make_args(sp.expand(place)):
        number, rest = term.as_independent(*term.free_symbols, as_Add=False)
        yield number, [f.as_base_exp() for f in sp.Mul.make_args(rest) if f != 1]


def reach_in_numbers(places: Iterable[sp.Expr]) -> sp.Expr:
    """The largest size of a coordinate as the joints turn, of the lengths that are numbers.

    It is rounded up to three digits, so that it is the same on every computer.
    """
    reach = max(map(_largest, places), default=0.0)
    if reach == 0:
        return sp.S.Zero
    place = 2 - math.floor(math.log10(reach))
    return sp.Integer(math.ceil(reach * 10.0**place * (1 - 1e-9))) * sp.Integer(10) ** -place


def _largest(place: sp.Expr) -> float:
    """The largest size of the part of a coordinate that consists of numbers, sines and cosines.

    The angles of the sines and cosines count as independent.  From the best of many postures, one
    angle after the other goes to where the size is largest.
    """
    terms = [
        (number, factors)
        for number, factors in _terms(place)
        if all(isinstance(base, TURNS) for base, _ in factors)
    ]
    angles = sorted({base.args[0] for _, factors in terms for base, _ in factors}, key=str)

    def sizes(at: NDArray[np.float64]) -> NDArray[np.float64]:
        known = {
            f(a): getattr(np, f.__name__)(row)
            for f in TURNS
            for a, row in zip(angles, at, strict=True)
        }
        total = np.zeros(at.shape[1:])
        for number, factors in terms:
            powers = (known[base] ** int(exponent) for base, exponent in factors)
            total = total + float(number) * np.multiply.reduce([np.ones(at.shape[1:]), *powers])
        return np.asarray(abs(total))

    steps = np.sqrt([float(sp.prime(k + 1)) for k in range(len(angles))])
    tried = 2 * np.pi * np.outer(steps, np.arange(POSTURES))
    best = tried[:, np.argsort(sizes(tried))[-STARTS:]]
    ways = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    for k in [*range(len(angles))] * SWEEPS:
        tried = np.repeat(best[:, :, None], DIRECTIONS, axis=2)
        tried[k] = ways
        best[k] = ways[sizes(tried).argmax(axis=-1)]
    return float(sizes(best).max())


def numbers_of_tool(derivation: Derivation) -> list[float]:
    """For each coordinate of the tool, the lengths in it that are numbers."""
    found = []
    for pose in (f for f in derivation.functions if f.name == "pose"):
        names: dict[sp.Basic, sp.Expr] = {}
        for statement in pose.body:
            if isinstance(statement, (Let, Bound)):
                names[statement.symbol] = lengths_in_numbers(statement.value, names)
        places = pose.outputs[0].entries[3:12:4]
        found += [float(lengths_in_numbers(place, names)) for place in places]
    return found


__all__ = ["lengths_in_numbers", "numbers_of_tool", "reach_in_numbers"]
