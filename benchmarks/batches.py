"""Peers that are called from Python, on a million postures and on one."""

from __future__ import annotations

import ctypes
import os
import tempfile
import timeit
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from . import native
from .cases import Case, NotApplicableError

Values = Callable[[], Any]
Peer = Callable[[Case, str, np.ndarray], tuple[timeit.Timer, Values | None]]
"""The call to time, and a function that gives its values, if it computes any."""
NAMES = ("sin", "cos", "arctan2", "sqrt", "abs")


def statement(code: str, **names: Any) -> timeit.Timer:
    """A call as a user writes it, timed without a wrapper around it."""
    return timeit.Timer(code, globals=names)


def numpy_like(module: Any) -> dict[str, Any]:
    """The names that SymPy prints, as functions of a module with NumPy's names."""
    found = {name: getattr(module, name) for name in NAMES}
    found["nonnegative"] = lambda x: module.where(x >= 0, 1.0, 0.0)
    return {**found, "atan2": found["arctan2"]}


def planes_of(rows: np.ndarray) -> np.ndarray:
    """The rows as planes, shape (coordinates, N); the stride is not a power of two."""
    memory = np.empty((rows.shape[1], len(rows) + 24))[:, : len(rows)]
    memory[:] = rows.T
    return memory


def ours(
    backend: str, case: Case, layout: str, rows: np.ndarray, **options: int
) -> tuple[timeit.Timer, Values]:
    function = partial(case.ours(backend), **options) if options else case.ours(backend)
    core = case.source.inputs[0].shape
    if len(rows) == 1:
        x = rows.reshape(core)
        out = function(x)
        out = out if isinstance(out, tuple) else np.asarray(out)
    elif layout == "rows":
        x = rows.reshape(-1, *core)
        out = function(x)
    else:
        x = np.moveaxis(planes_of(rows).reshape((*core, len(rows)), copy=False), -1, 0)
        out = like_planes(function(x))
    call = statement("function(x, out=out)", function=function, x=x, out=out)
    return call, lambda: first(function(x, out=out)).reshape(len(rows), -1)


def first(result: Any) -> np.ndarray:
    return result[0] if isinstance(result, tuple) else result


def like_planes(result: Any) -> Any:
    if isinstance(result, tuple):
        return tuple(like_planes(r) for r in result)
    memory = np.empty((*result.shape[1:], len(result) + 24), result.dtype)[..., : len(result)]
    return np.moveaxis(memory, -1, 0)


def stacked(values: Any, n: int) -> np.ndarray:
    return np.stack([np.broadcast_to(np.asarray(v), (n,)) for v in values], axis=-1)


def lambdify(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    function = case.translate(numpy_like(np))
    planes = list(planes_of(rows)) if layout == "planes" else list(rows.T)
    parameters = list(case.parameters.values())

    def run() -> Any:
        with np.errstate(all="ignore"):
            return function(*planes, *parameters)

    return statement("run()", run=run), lambda: stacked(run(), len(rows))


def symengine(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    if layout == "planes":
        raise NotApplicableError("takes rows")
    import symengine as se

    backend = "llvm" if se.have_llvm else "lambda"
    names = {n: getattr(se, n) for n in ("sin", "cos", "sqrt", "atan2")}
    names |= {"abs": se.Abs, "nonnegative": lambda x: se.Piecewise((1, x >= 0), (0, True))}
    symbols = se.symbols([str(s) for s in case.symbols])
    expressions = case.translate(names)(*symbols)
    function = se.Lambdify(symbols, expressions, backend=backend, cse=True)
    x = np.hstack([rows, np.tile(list(case.parameters.values()), (len(rows), 1))])
    out = np.empty((len(rows), case.width))
    return statement("function(x, out=out)", function=function, x=x, out=out), lambda: function(x)


def casadi(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    if layout == "planes":
        raise NotApplicableError("takes rows")
    import casadi as ca

    names = native.casadi_names()
    x = ca.SX.sym("x", len(case.source.symbols))
    p = ca.SX.sym("p", len(case.parameters))
    values = ca.vertcat(*case.translate(names)(*ca.vertsplit(x), *ca.vertsplit(p)))
    one = ca.Function("peer", [x, p], [values], {"cse": True})
    many = one.map("many", "serial", len(rows), [1], []) if len(rows) > 1 else one
    buffer, trigger = many.buffer()
    x_rows = np.ascontiguousarray(rows)
    constants = np.array(list(case.parameters.values()))
    out = np.empty((len(rows), case.width))
    buffer.set_arg(0, memoryview(x_rows))
    buffer.set_arg(1, memoryview(constants))
    buffer.set_res(0, memoryview(out))

    def values_of() -> np.ndarray:
        trigger()
        return out.copy()

    return statement("trigger()", trigger=trigger, alive=(buffer, x_rows, constants)), values_of


def numba(
    case: Case, layout: str, rows: np.ndarray, threads: int = 1
) -> tuple[timeit.Timer, Values]:
    """A loop over the postures; with several ``threads`` it is a parallel one."""
    import math

    import numba as nb
    import sympy as sp

    temporaries, results = case.program
    at = "x_in[{k}, i]" if layout == "planes" else "x_in[i, {k}]"
    to = "out[{k}, i]" if layout == "planes" else "out[i, {k}]"
    lines = ["def kernel(x_in, p_in, out):", " for i in nb.prange(x_in.shape[AXIS]):"]
    n = len(case.source.symbols)
    for k, symbol in enumerate(case.symbols):
        place = at.format(k=k) if k < n else f"p_in[{k - n}]"
        lines.append(f"  {symbol} = {place}")
    printed = sp.printing.pycode
    lines += [f"  {s} = {printed(e)}" for s, e in temporaries]
    lines += [f"  {to.format(k=k)} = {printed(e)}" for k, e in enumerate(results)]
    scope: dict[str, Any] = {"math": math, "nb": nb}
    exec("\n".join(lines).replace("AXIS", "1" if layout == "planes" else "0"), scope)
    compiled = nb.njit(fastmath=False, error_model="numpy", parallel=threads > 1)
    kernel = compiled(scope["kernel"])
    x = planes_of(rows) if layout == "planes" else rows
    out = np.empty((case.width, len(rows)) if layout == "planes" else (len(rows), case.width))
    p = np.array(list(case.parameters.values()))

    def run() -> None:
        nb.set_num_threads(threads)
        kernel(x, p, out)

    def values() -> np.ndarray:
        run()
        return (out.T if layout == "planes" else out).copy()

    call = "kernel(x, p, out)" if threads == 1 else "run()"
    return statement(call, kernel=kernel, x=x, p=p, out=out, run=run), values


def pytensor(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    import pytensor as pt
    import pytensor.tensor as tensor

    names = {
        **{n: getattr(tensor, n) for n in ("sin", "cos", "sqrt", "abs")},
        "atan2": tensor.arctan2,
        "nonnegative": lambda x: tensor.switch(tensor.ge(x, 0), 1.0, 0.0),
    }
    arguments = [tensor.vector(s.name) for s in case.source.symbols]
    values = case.translate(names)(*arguments, *case.parameters.values())
    outputs = [tensor.as_tensor_variable(v) for v in values]
    function = pt.function(arguments, outputs, on_unused_input="ignore")
    planes = (
        list(planes_of(rows)) if layout == "planes" else [np.ascontiguousarray(c) for c in rows.T]
    )
    call = statement("function(*planes)", function=function, planes=planes)
    return call, lambda: stacked(function(*planes), len(rows))


def jax_library() -> Any:
    """JAX on the processor, with doubles."""
    os.environ.setdefault("JAX_PLATFORMS", "cpu")
    import jax as library

    library.config.update("jax_enable_x64", True)
    return library


def jax(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, Values]:
    library = jax_library()
    jnp = library.numpy
    one = case.translate(numpy_like(jnp))
    parameters = list(case.parameters.values())
    axis = 1 if layout == "planes" else 0

    def posture(x: Any) -> Any:
        return jnp.stack([jnp.asarray(v, float) for v in one(*x, *parameters)])

    function = library.jit(library.vmap(posture, in_axes=axis, out_axes=axis))
    x = library.device_put(np.ascontiguousarray(rows.T) if axis else rows)

    def values() -> np.ndarray:
        result = np.asarray(function(x))
        return result.T if axis else result

    return statement("function(x).block_until_ready()", function=function, x=x), values


def of_planes(
    printed: Callable[[Case], str], case: Case, layout: str, rows: np.ndarray
) -> tuple[timeit.Timer, Values]:
    """Time C code for a structure of arrays."""
    if layout != "planes" or len(rows) == 1:
        raise NotApplicableError("takes planes")
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder, "planes.c")
        run = native.compiled(
            ["gcc", "-std=gnu99"], source, printed(case), native.widest()
        ).evaluate
    run.argtypes, run.restype = [size, pointer, pointer, size, pointer, size], None
    x = planes_of(rows)
    out = planes_of(np.empty((len(rows), case.width)))
    p = np.array(list(case.parameters.values()))
    strides = [a.strides[0] // a.itemsize for a in (x, out)]
    arguments = (
        len(rows), p.ctypes.data, x.ctypes.data, strides[0], out.ctypes.data, strides[1]
    )  # fmt: skip
    call = statement("run(*arguments)", run=run, arguments=arguments, alive=(p, x, out))

    def values() -> np.ndarray:
        run(*arguments)
        return out.T.copy()

    return call, values


def writing(case: Case, layout: str, rows: np.ndarray) -> tuple[timeit.Timer, None]:
    return of_planes(native.writing_of_planes, case, layout, rows)[0], None


PEERS: dict[str, Peer] = {
    "closedform C": partial(ours, "c"),
    "limit": partial(of_planes, native.limit_of_planes),
    "closedform NumPy": partial(ours, "numpy"),
    "lambdify": lambdify,
    "symengine": symengine,
    "casadi": casadi,
    "numba": numba,
    "pytensor": pytensor,
    "jax": jax,
    "writing alone": writing,
}
