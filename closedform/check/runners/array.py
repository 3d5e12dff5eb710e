"""Modules for any array library: with NumPy in both float types, and with others if installed.

JAX compiles each operation for each shape.  So batches are filled up to a few sizes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from closedform.check.crosscheck import Backend
from closedform.check.failures import UnavailableError
from closedform.check.runners.python import module
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.tolerances import DOUBLE, FLOAT, Tolerances

TYPES: tuple[tuple[str, type, Tolerances], ...] = (
    ("", np.float64, DOUBLE),
    (" float", np.float32, FLOAT),
)
FILLED = 64


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    if not find_spec("array_api_compat"):
        raise UnavailableError("array-api-compat is not installed")
    printed = module(folder, derivation.name)
    for library, arrays in _libraries().items():
        for suffix, dtype, tolerances in TYPES:
            call = _caller(printed, derivation, arrays, dtype)
            yield Backend(f"{library}{suffix}", call, dtype, tolerances)


def _libraries() -> dict[str, Callable[[Any], Any]]:
    """The libraries that are installed, and how each makes an array of one of NumPy."""
    found: dict[str, Callable[[Any], Any]] = {"array": np.asarray}
    if find_spec("torch"):
        found["torch"] = import_module("torch").asarray
    return found


def _caller(
    printed: ModuleType, derivation: Derivation, arrays: Callable[[Any], Any], dtype: type
) -> Callable[[str], Callable[..., Any]]:
    def function(name: str) -> Callable[..., Any]:
        described: Function = derivation[name]

        def call(*given: Any) -> Any:
            *inputs, params = (arrays(np.asarray(x, dtype)) for x in given)
            found = getattr(printed, name)(*inputs, params)
            if described.has_status:
                return tuple(map(np.asarray, found))
            return np.asarray(found)

        return call

    return function
