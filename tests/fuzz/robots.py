"""What the attacks need to know of a generated mechanism, read from its derivation."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from types import ModuleType
from typing import Any

import numpy as np
import sympy as sp

from closedform.pipeline import scripts

BACKENDS = ("numpy", "c")
NEEDED = {"h6ar": ("L1", "L2", "d"), "h6ar_loop_closed": ("L1", "L2", "d")}
"""Lengths that the mechanism needs: its inverse says INVALID if one of them is zero."""


@dataclass(frozen=True)
class Robot:
    """Names, kinds of joints, and the indices of the joints that stay close to another."""

    name: str
    fields: tuple[str, ...]
    defaults: tuple[float, ...]
    signed: tuple[bool, ...]
    turned: tuple[bool, ...]
    """Which parameters are angles."""
    joints: tuple[str, ...]
    slides: tuple[bool, ...]
    positive: tuple[bool, ...]
    twin_of: tuple[int, ...]
    angles: tuple[bool, ...]
    modes: bool
    needed: tuple[bool, ...]
    condition: Callable[..., Any]
    """By how much roundings are amplified, from the lengths."""

    def module(self, backend: str) -> ModuleType:
        return importlib.import_module(f"closedform.generated.{backend}.{self.name}")

    def lengths_of(self, parameters: np.ndarray) -> np.ndarray:
        """The sizes of the parameters that are lengths."""
        return np.abs(parameters[..., ~np.array(self.turned, bool)])

    @property
    def revolute(self) -> np.ndarray:
        return ~np.array(self.slides)


@cache
def robots() -> tuple[Robot, ...]:
    """Every mechanism that has a forward map ``fk`` and an inverse ``ik``."""
    return tuple(_robot(s) for s in scripts.sources() if scripts.load(s).has_forward_map)


@cache
def without_forward_map() -> tuple[Robot, ...]:
    """Every mechanism that has no ``fk``."""
    return tuple(_robot(s) for s in scripts.sources() if not scripts.load(s).has_forward_map)


@cache
def robot(name: str) -> Robot:
    (source,) = scripts.find([name])
    return _robot(source)


def _robot(source: scripts.Source) -> Robot:
    d = scripts.load(source)
    joints = {j.symbol: j for j in d.joints}
    actuated = d.actuated
    inverse = next(i for i in d.inverses if i.function == "ik")
    return Robot(
        name=source.name,
        fields=tuple(p.name for p in d.parameters),
        defaults=tuple(float(p.value) for p in d.parameters),
        signed=tuple(not p.nonnegative for p in d.parameters),
        turned=tuple(p.unit == "rad" for p in d.parameters),
        joints=tuple(s.name for s in actuated),
        slides=tuple(joints[s].kind == "prismatic" for s in actuated),
        positive=tuple(s in inverse.nonnegative for s in actuated),
        twin_of=tuple(
            actuated.index(b) if (b := joints[s].twin_of) is not None else -1 for s in actuated
        ),
        angles=tuple(s in inverse.angles for s in d["ik"].symbols),
        modes=bool(d.assembly_modes),
        needed=tuple(p.name in NEEDED.get(source.name, ()) for p in d.parameters),
        condition=sp.lambdify([p.symbol for p in d.parameters], inverse.condition),
    )
