"""The modules for any array library, beside the same formulas in the library's own names."""

from __future__ import annotations

import timeit
from functools import partial
from typing import Any

import numpy as np

from .batches import Peer, Values, first, jax, jax_library, ours, statement
from .cases import Case, NotApplicableError


def under_jit(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    """The array module, compiled by JAX."""
    library = jax_library()
    function, core, planes = case.ours("array"), case.source.inputs[0].shape, layout == "planes"
    move = library.numpy.moveaxis

    def evaluate(x: Any) -> tuple[Any, ...]:
        x = move(x.reshape(*core, -1), -1, 0) if planes else x.reshape(-1, *core)
        result = function(x)
        results = tuple(result) if isinstance(result, tuple) else (result,)
        return tuple(move(r, 0, -1) for r in results) if planes else results

    compiled = library.jit(evaluate)
    x = library.device_put(np.ascontiguousarray(rows.T) if planes else rows)

    def values() -> np.ndarray:
        found = np.asarray(compiled(x)[0])
        return (np.moveaxis(found, -1, 0) if planes else found).reshape(len(rows), -1)

    block = library.block_until_ready
    return statement("block(compiled(x))", block=block, compiled=compiled, x=x), values


def plain(library: str, case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    """The array module, an operation at a time."""
    if layout == "planes":
        raise NotApplicableError("takes rows")
    x: Any = rows.reshape(-1, *case.source.inputs[0].shape)
    if library == "torch":
        import torch

        torch.set_num_threads(1)
        x = torch.from_numpy(x)
    function = case.ours("array")
    call = statement("function(x)", function=function, x=x)
    return call, lambda: np.asarray(first(function(x))).reshape(len(rows), -1)


PEERS: dict[str, Peer] = {
    "array, jax.jit": under_jit,
    "lambdify, jax.jit": jax,
    "array, torch": partial(plain, "torch"),
    "array, NumPy": partial(plain, "numpy"),
    "closedform NumPy": partial(ours, "numpy"),
}
