"""Generated C, compiled and called through ctypes, to check single precision."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from collections.abc import Callable, Sequence
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from closedform.check.failures import FailedError, UnavailableError
from closedform.lower import results_of
from closedform.model.derivation import Derivation
from closedform.model.functions import Function

CALLED = "-Dalways_inline=unused"
"""Functions are called instead of copied into each of their users, a third of the time of -O0."""
FLAGS = ("-std=c99", "-O0", CALLED, "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-shared")
"""Those that are recommended, but -O0, which takes a fifth of the time of -O3 and gives the same
values.  The tests compare both."""


def compiler() -> str:
    """The C compiler: ``$CC``, or the first of ``cc``, ``gcc`` and ``clang`` that is found."""
    for name in (os.environ.get("CC", ""), "cc", "gcc", "clang"):
        if name and shutil.which(name):
            return name
    raise UnavailableError("no C compiler found: install gcc or clang, or set CC")


class CompileError(FailedError):
    """The C compiler rejected a file; the message is the first thing that it said."""


class CLibrary:
    """The C of one robot as a shared library, called row by row and through its ``_batch``.

    It is compiled into ``scratch``, unless ``built`` contains one from before.
    """

    def __init__(
        self,
        derivation: Derivation,
        sources: Path,
        scratch: Path,
        *,
        single: bool = False,
        built: Path | None = None,
    ):
        self.dtype = np.float32 if single else np.float64
        self._real = ctypes.c_float if single else ctypes.c_double
        self._name = derivation.name
        self._functions = {f.name: f for f in derivation.functions}
        self._fields = len(derivation.parameters)
        library = built or _compiled(derivation.name, sources, scratch, single)
        self.compiled = ctypes.CDLL(str(library))

    def function(self, name: str) -> Callable[..., Any]:
        """``name(*inputs, params)`` over arrays with at most one leading axis.

        Every other row is one call, the rest is a batch: these are different programs.
        """
        function = self._functions[name]
        one = getattr(self.compiled, f"{self._name}_{name}")
        batch = getattr(self.compiled, f"{self._name}_{name}_batch")

        def call(*arguments: Any) -> Any:
            *inputs, params = arguments
            return self._run(one, batch, function, inputs, params)

        return call

    def _run(
        self, one: Any, batch: Any, function: Function, inputs: Sequence[Any], params: Any
    ) -> Any:
        rows = [self._rows(x, a.size) for x, a in zip(inputs, function.inputs, strict=True)]
        n = len(rows[0]) if rows else 1
        fields = (self._real * self._fields)(*map(float, params))
        results, outputs = results_of(function), []
        for result in results:
            dtype = self.dtype if result.kind == "real" else np.uint8
            outputs.append(np.empty((n, prod(result.shape)), dtype))
        together = [np.ascontiguousarray(array[::2].T) for array in (*rows, *outputs)]
        count = ctypes.c_size_t((n + 1) // 2)
        arguments: list[Any] = [count, ctypes.byref(fields)]
        for plane in together:
            arguments += [plane.ctypes.data_as(ctypes.c_void_p), count]
        batch(*arguments)
        for output, plane in zip(outputs, together[len(rows) :], strict=True):
            output[::2] = plane.T
        for k in range(1, n, 2):
            places = (a.ctypes.data + k * a.strides[0] for a in (*rows, *outputs))
            one(ctypes.byref(fields), *map(ctypes.c_void_p, places))
        lead = (n,) if inputs else ()
        shaped = [o.reshape((*lead, *r.shape)) for o, r in zip(outputs, results, strict=True)]
        return shaped[0] if len(shaped) == 1 else tuple(shaped)

    def _rows(self, value: Any, size: int) -> np.ndarray[Any, Any]:
        return np.ascontiguousarray(np.asarray(value, self.dtype).reshape(-1, size))


def _compiled(name: str, sources: Path, scratch: Path, single: bool) -> Path:
    library = scratch / f"{name}_{'float' if single else 'double'}.so"
    define = ["-DCLOSEDFORM_FLOAT"] if single else []
    command = [compiler(), *FLAGS, *define, f"-I{sources}"]
    source = sources / f"{name}.c"
    command += [str(source), "-o", str(library), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        first = next((e for e in done.stderr.splitlines() if "error" in e), done.stderr[:200])
        raise CompileError(f"{command[0]} does not compile {source}: {first}")
    return library
