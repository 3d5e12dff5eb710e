"""Postures on and near the singular set of a mechanism, factor by factor."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.check.rows import WIDE, RowEvaluator
from closedform.check.samples import Sample, drawn_beside, parameter_sets
from closedform.model.derivation import Derivation
from closedform.model.expressions import substitute
from closedform.model.functions import Bound, Function, Let, Vanishes
from closedform.model.tolerances import DOUBLE

Array = NDArray[Any]

DISTANCES = (0.0, *10.0 ** np.arange(-15.0, 0.5))
"""How far the joints are moved off the singular set."""
STEPS = 40
SHARES = (1.0, 0.5, 0.25)
"""Shares of a Newton step: half a step is right if a factor is a root, as at the end of a reach."""
CLOSE = 1e-7
"""How small a factor becomes on the singular set; for a root, the root of a rounding error."""
STARTS, RANDOM = 8, 600


def singular_samples(
    derivation: Derivation, unknowns: tuple[sp.Symbol, ...], seed: int = 4
) -> list[Sample]:
    """Random postures, and postures on and near every factor in every assembly mode."""
    rng = np.random.default_rng(seed)
    sets = list(parameter_sets(derivation, rng))
    factors = next((f for f in derivation.functions if f.name == "singularities"), None)
    found = [[_drawn(derivation, unknowns, rng, p, RANDOM)] for p in sets]
    if factors and set(factors.symbols) == set(unknowns):
        start = [_drawn(derivation, unknowns, rng, p, RANDOM) for p in sets]
        for value in _values(derivation, factors, unknowns):
            for k, near in enumerate(_on_and_near(value, start, sets, rng)):
                found[k].append(near)
    return [
        Sample("singular set", np.concatenate(rows), p) for rows, p in zip(found, sets, strict=True)
    ]


def _drawn(
    derivation: Derivation,
    unknowns: Sequence[sp.Symbol],
    rng: np.random.Generator,
    parameters: Sequence[float],
    rows: int,
) -> Array:
    """Random postures; a slide reaches about as far as all links together."""
    slides = [j.symbol for j in derivation.joints if j.kind == "prismatic"]
    ends = [sum(map(abs, parameters)) if u in slides else np.pi for u in unknowns]
    values = rng.uniform(-1, 1, (rows, len(unknowns))) * ends
    return drawn_beside(derivation, unknowns, values)


def _values(
    derivation: Derivation, factors: Function, unknowns: Sequence[sp.Symbol]
) -> list[Callable[[Array], Array]]:
    """Each factor in each assembly mode, as a function of rows of joint values and parameters.

    Its value is NaN if the mode does not exist.
    """
    given = (*unknowns, *(p.symbol for p in derivation.parameters))
    entries = [e for a in factors.outputs for e in a.entries]

    def value(evaluator: RowEvaluator, rows: Array) -> Array:
        factor, *margins = evaluator.values(rows).T
        exists = np.all([m >= -DOUBLE.feasibility for m in margins], axis=0)
        return np.where(exists, factor, np.nan)

    values: list[Callable[[Array], Array]] = []
    for _, signs in factors.cases():
        named: dict[sp.Symbol, sp.Basic] = {s: sp.Integer(v) for s, v in signs.items()}
        lowered: dict[sp.Basic, sp.Basic] = {}
        margins = []
        for statement in factors.body:
            if isinstance(statement, Vanishes):
                lowered[statement.symbol] = sp.false
            elif isinstance(statement, Let):
                named[statement.symbol] = substitute(statement.value, lowered)
            elif isinstance(statement, Bound):
                bound = substitute(statement.value, lowered)
                margins.append(bound / substitute(statement.scale, lowered))
                named[statement.symbol] = sp.Max(bound, 0, evaluate=False)
        for entry in entries:
            exprs = [substitute(entry, lowered), *margins]
            values.append(partial(value, RowEvaluator(given, exprs, named=named)))
    return values


def _on_and_near(
    value: Callable[[Array], Array],
    starts: Sequence[Array],
    sets: Sequence[Sequence[float]],
    rng: np.random.Generator,
) -> list[Array]:
    """For each set of parameters, postures at which a factor vanishes, and others near them."""
    dimensions = np.array(sets, WIDE).reshape(len(sets), 1, -1)
    exist = [
        rows[np.isfinite(_at(value, rows, np.broadcast_to(size, (len(rows), size.shape[1]))))]
        for rows, size in zip(starts, dimensions, strict=True)
    ]
    kept = [rows[:STARTS] for rows in exist]
    sizes = [len(rows) for rows in kept]
    q = np.concatenate(kept).astype(WIDE)
    parameters = np.repeat(dimensions[:, 0], sizes, axis=0)
    scale = np.abs(_at(value, q, parameters))
    q = _descended(value, q, parameters)
    ended = np.abs(_at(value, q, parameters)) <= CLOSE * scale
    aside = rng.normal(size=(len(DISTANCES), *q.shape))
    aside /= np.linalg.norm(aside, axis=-1, keepdims=True)
    near = q.astype(float) + np.array(DISTANCES)[:, None, None] * aside
    ends = np.cumsum([0, *sizes])
    return [near[:, a:b][:, ended[a:b]].reshape(-1, q.shape[1]) for a, b in pairwise(ends)]


def _at(value: Callable[[Array], Array], q: Array, parameters: Array) -> Array:
    """The factor at postures of shape (..., rows, joints)."""
    whole = np.concatenate(
        [q, np.broadcast_to(parameters, (*q.shape[:-1], parameters.shape[1]))], -1
    )
    return value(whole.reshape(-1, whole.shape[-1])).reshape(q.shape[:-1])


def _descended(value: Callable[[Array], Array], q: Array, parameters: Array) -> Array:
    """Newton's method along the gradient, with the share of each step that descends the most.

    It ends at the lowest value that it finds, whether zero or not.
    """

    axes = np.eye(q.shape[1])[:, None, :]
    size = np.abs(_at(value, q, parameters)) + np.finfo(float).tiny
    q, moving = q.copy(), np.arange(len(q))
    for _ in range(STEPS):
        at, dimensions = q[moving], parameters[moving]
        here = _at(value, at, dimensions)
        h = np.clip((here / size[moving]) ** 2 * 1e-3, 1e-15, 1e-6)[:, None]
        beside = _at(value, np.concatenate([at + h * axes, at - h * axes]), dimensions)
        beside = np.where(np.isnan(beside), here, beside)
        rates = (beside[: len(axes)] - beside[len(axes) :]).T / (2 * h)
        with np.errstate(all="ignore"):
            step = here[:, None] * rates / (rates**2).sum(axis=-1, keepdims=True)
            step /= np.maximum(1, np.sqrt((step**2).sum(axis=-1, keepdims=True)))
        tried = np.stack([at, *(at - share * step for share in SHARES)])
        left = np.abs(_at(value, tried, dimensions))
        best = np.argmin(np.where(np.isfinite(left), left, np.inf), axis=0)
        q[moving] = tried[best, np.arange(len(at))]
        moving = moving[best > 0]
        if not len(moving):
            break
    return q


__all__ = ["singular_samples"]
