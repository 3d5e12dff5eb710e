"""Modules for any array library: with NumPy in both float types, and with others if installed.

JAX compiles every operation for every shape of its operands.  Its batches are therefore padded to a
few lengths, and it is tested in double precision only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from closedform.check.failures import UnavailableError
from closedform.check.finding import Backend
from closedform.check.runners.python import module
from closedform.model.derivation import Derivation
from closedform.model.tolerances import DOUBLE, FLOAT

FILLED = 128
"""The length of a batch of JAX is a multiple of this."""


@dataclass(frozen=True)
class Library:
    """How a library makes an array, and of which length batches are a multiple."""

    array: Callable[[NDArray[Any]], Any]
    multiple: int = 1

    def call(self, function: Callable[..., Any], dtype: type, *given: Any) -> tuple[Any, ...]:
        arrays: list[NDArray[Any]] = [np.asarray(x, dtype) for x in given]
        inputs, params = arrays[:-1], arrays[-1]
        postures = len(inputs[0]) if inputs else 1
        more = -postures % self.multiple if inputs and postures else 0
        filled = [np.concatenate([x, np.repeat(x[-1:], more, axis=0)]) for x in inputs]
        if params.ndim > 1:
            params = np.concatenate([params, np.repeat(params[:, -1:], more, axis=1)], axis=1)
        found = function(*map(self.array, filled), self.array(params))
        results = found if isinstance(found, tuple) else (found,)
        return tuple(np.asarray(r)[:postures] if inputs else np.asarray(r) for r in results)


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    if not find_spec("array_api_compat"):
        raise UnavailableError("array-api-compat is not installed")
    printed = module(folder, derivation.name)
    numpy = Library(np.asarray)
    yield _backend("array", printed, numpy)
    yield _backend("array float", printed, numpy, single=True)
    if find_spec("torch"):
        torch = Library(import_module("torch").asarray)
        yield _backend("torch", printed, torch)
        yield _backend("torch float", printed, torch, single=True)
    if find_spec("jax"):
        jax = import_module("jax")
        with jax.enable_x64(True):
            yield _backend("jax", printed, Library(jax.numpy.asarray, FILLED))


def _backend(name: str, printed: ModuleType, library: Library, *, single: bool = False) -> Backend:
    dtype, tolerances = (np.float32, FLOAT) if single else (np.float64, DOUBLE)

    def function(name: str) -> Callable[..., Any]:
        def called(*given: Any) -> Any:
            return library.call(getattr(printed, name), dtype, *given)

        return called

    return Backend(name, function, dtype, tolerances, broadcasts=True)
