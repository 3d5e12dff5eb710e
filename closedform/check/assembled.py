"""Joints with which a mechanism can be assembled, where random ones hardly ever do.

The lengths of cylinders have to fit to each other, and to dimensions that may be numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from closedform.check.finding import thinned
from closedform.check.samples import Sample, with_parameters
from closedform.check.truth import Values
from closedform.model.derivation import Derivation
from closedform.model.functions import Function

FEW, KEPT, DRAWN = 3, 40, 4000
"""Fewer of the random rows that are compared are too few; how many are added, and drawn."""
SHARES = 2.0 ** -np.arange(5)
"""Slides are drawn up to these shares of all lengths."""
INSIDE = 1e-3
"""A mode exists safely if its bounds are larger than this share of their scales."""


def assembled(
    derivation: Derivation, function: Function, values: Values, samples: Sequence[Sample]
) -> list[Sample]:
    """Further joints for the dimensions with which hardly any of the random ones close."""
    joints = {j.symbol: j for j in derivation.joints}
    if not values.in_modes or not set(function.symbols) <= set(joints):
        return []
    slides = np.array([joints[s].kind == "prismatic" for s in function.symbols])
    rng, found = np.random.default_rng(6), []
    for sample in samples:
        compared = thinned(sample, len(values.exprs)).rows
        if sample.name != "random" or (values.inside(compared) > INSIDE).sum() >= FEW:
            continue
        drawn = rng.uniform(-1, 1, (DRAWN, len(slides)))
        longest = sum(map(abs, sample.parameters), values.in_numbers) or 1.0
        drawn *= np.where(slides, longest * rng.choice(SHARES, drawn.shape), np.pi)
        kept = drawn[values.inside(with_parameters(drawn, sample.parameters)) > INSIDE][:KEPT]
        if len(kept):
            found.append(replace(sample, name="assembled", values=kept))
    return found


__all__ = ["assembled"]
