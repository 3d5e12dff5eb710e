"""Finds postures that an inverse misses, by numbers, to explain a failed proof."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.inverse import Inverse

_POSTURES = 60


def uncovered(derivation: Derivation, function: Function, inverse: Inverse) -> str:
    """A sentence with a posture that no branch returns for its own image.

    Empty if the targets are not images of the unknowns, or if no such posture is found.
    """
    if tuple(inverse.targets) != function.symbols:
        return ""
    parameters = [p.symbol for p in derivation.parameters]
    values = [np.float64(p.value) for p in derivation.parameters]  # division by zero must not raise
    revolute = [j.symbol for j in derivation.joints if j.kind == "revolute"]
    angular = np.array([u in revolute for u in inverse.unknowns])
    forward = sp.lambdify([*inverse.unknowns, *parameters], list(inverse.forward), "numpy")
    branches = [
        (label, sp.lambdify([*function.symbols, *parameters], list(function.values(s)), "numpy"))
        for label, s in function.cases()
    ]
    rng = np.random.default_rng(0)
    for _ in range(_POSTURES):
        posture = np.round(rng.uniform(-2.5, 2.5, len(inverse.unknowns)), 1)
        with np.errstate(all="ignore"):
            image = forward(*posture, *values)
            found = [(n, np.array(f(*image, *values), dtype=float)) for n, f in branches]
        found = [(label, q) for label, q in found if np.isfinite(q).all()]
        gaps = [_gap(q, posture, angular) for _, q in found]
        if found and min(gaps) > 1e-6:
            return (
                f"The posture {_shown(inverse.unknowns, posture)} is not covered: for its image "
                + "; ".join(
                    f"{n or 'the branch'} gives {_shown(inverse.unknowns, q)}" for n, q in found[:2]
                )
            )
    return ""


def _gap(q: np.ndarray, posture: np.ndarray, angular: np.ndarray) -> float:
    difference = q - posture
    turned = np.angle(np.exp(1j * difference))
    return float(np.abs(np.where(angular, turned, difference)).max())


def _shown(names: Sequence[sp.Symbol], values: np.ndarray) -> str:
    return "(" + ", ".join(f"{n} = {v:.4g}" for n, v in zip(names, values, strict=True)) + ")"
