"""Generated NumPy and C beside ``sympy.lambdify(cse=True)``, in one run, on the same postures.

Every cell's values are checked against the peer before they are timed.
"""

import importlib
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
import sympy as sp

CASES = [
    ("planar_2r", "fk"),
    ("planar_2r", "jacobian"),
    ("planar_2r", "ik"),
    ("spherical_wrist", "fk"),
    ("spherical_wrist", "ik"),
    ("irb260", "fk"),
    ("irb260", "jacobian"),
    ("irb260", "ik"),
]
MILLION = 1_000_000


def derivation(robot: str):
    return importlib.import_module(f"closedform.derivations.{robot}").d


@cache
def peer(robot: str, name: str) -> Callable[..., Any]:
    """The lambdified source: coordinates in, list of values out."""
    d = derivation(robot)
    function = d[name]
    exprs = [e for _, signs in function.cases() for e in function.values(signs)]
    parameters = [p.symbol for p in d.parameters]
    values = {p.symbol: float(p.value) for p in d.parameters}
    compiled = sp.lambdify([*function.symbols, *parameters], exprs, "numpy", cse=True)
    return lambda planes: compiled(*planes, *values.values())


def inputs(robot: str, name: str, n: int) -> np.ndarray:
    """Postures, or for an inverse their images, as (n, ...) arrays."""
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    q = np.random.default_rng(0).uniform(-3, 3, (n, len(module.JOINTS)))
    return module.fk(q) if name == "ik" else q


def planes_of(x: np.ndarray) -> np.ndarray:
    """The same array, coordinate by coordinate in memory; the stride is no multiple of 4096."""
    flat = x.reshape(len(x), -1)
    memory = np.empty((flat.shape[1], len(x) + 24))[:, : len(x)]
    memory[:] = flat.T
    core = tuple(range(1, x.ndim))
    return memory.reshape((*x.shape[1:], len(x)), copy=False).transpose(
        x.ndim - 1, *(c - 1 for c in core)
    )


def empty_like_planes(result: Any) -> Any:
    if isinstance(result, tuple):
        return tuple(empty_like_planes(r) for r in result)
    core = result.shape[1:]
    memory = np.empty((*core, len(result) + 24), result.dtype)[..., : len(result)]
    return memory.transpose(memory.ndim - 1, *range(memory.ndim - 1))


def note(benchmark, robot: str, name: str, backend: str, size: str, postures: int) -> None:
    benchmark.group = f"{robot}.{name}, {size}"
    benchmark.extra_info.update(
        case=f"{robot}.{name}", backend=backend, size=size, postures=postures
    )


@pytest.mark.parametrize("backend", ["lambdify", "numpy", "c"])
@pytest.mark.parametrize(("robot", "name"), CASES)
def test_single(benchmark, robot: str, name: str, backend: str) -> None:
    x = inputs(robot, name, 1)[0]
    note(benchmark, robot, name, backend, "1", 1)
    if backend == "lambdify":
        call, coordinates = peer(robot, name), x.ravel().tolist()
        benchmark(call, coordinates)
        return
    function = getattr(importlib.import_module(f"closedform.generated.{backend}.{robot}"), name)
    check(function(x[None]), peer(robot, name)(x.reshape(-1, 1)))
    benchmark(function, x)


@pytest.mark.parametrize("backend", ["lambdify", "numpy", "c"])
@pytest.mark.parametrize("layout", ["(N, n)", "planes"])
@pytest.mark.parametrize(("robot", "name"), CASES)
def test_million(benchmark, robot: str, name: str, layout: str, backend: str) -> None:
    x = inputs(robot, name, MILLION)
    note(benchmark, robot, name, backend, f"1e6 {layout}", MILLION)
    benchmark.pedantic_options = {"rounds": 5}
    if backend == "lambdify":
        planes = x.reshape(MILLION, -1).T
        planes = np.ascontiguousarray(planes) if layout == "planes" else planes
        benchmark.pedantic(peer(robot, name), (planes,), rounds=5, warmup_rounds=1)
        return
    function = getattr(importlib.import_module(f"closedform.generated.{backend}.{robot}"), name)
    check(function(x[:1000]), peer(robot, name)(x[:1000].reshape(1000, -1).T))
    if layout == "planes":
        x = planes_of(x)
        out = empty_like_planes(function(x[:MILLION]))
        benchmark.pedantic(function, (x,), {"out": out}, rounds=5, warmup_rounds=1)
    else:
        benchmark.pedantic(function, (x,), rounds=5, warmup_rounds=1)


def check(result: Any, expected: list[Any]) -> None:
    """Angles modulo a turn: the peer does not wrap them."""
    q = result[0] if isinstance(result, tuple) else result
    flat = q.reshape(len(q), -1)
    for column, values in zip(flat.T, expected, strict=True):
        gap = column - values
        if isinstance(result, tuple):
            gap = np.angle(np.exp(1j * gap))
        assert np.nanmax(np.abs(gap)) < 1e-6
