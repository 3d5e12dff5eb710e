"""JavaScript, called in one process of Node a robot."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from collections.abc import Callable, Iterator, Sequence
from importlib.resources import files
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from closedform.check.crosscheck import Backend
from closedform.check.runners import FailedError, UnavailableError
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.tolerances import DOUBLE


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    with Node(derivation, folder) as node:
        yield Backend(name, node.function, np.float64, DOUBLE)


def executable() -> str:
    """The path of Node."""
    found = shutil.which("node")
    if found is None:
        raise UnavailableError("Node is not installed")
    return found


class Node:
    """The module of one robot, called through its ``_batch`` functions."""

    def __init__(self, derivation: Derivation, folder: Path):
        self._functions = {f.name: f for f in derivation.functions}
        self._fields = [p.name for p in derivation.parameters]
        script = files("closedform.check.runners") / "serve.mjs"
        module = folder / f"{derivation.name}.js"
        self._process = subprocess.Popen(
            [executable(), str(script), str(module)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()

    def function(self, name: str) -> Callable[..., Any]:
        """``name(*inputs, params)`` over arrays with at most one leading axis."""
        function = self._functions[name]

        def call(*arguments: Any) -> Any:
            *inputs, params = arguments
            return self._call(function, inputs, params)

        return call

    def _call(self, function: Function, inputs: Sequence[Any], params: Any) -> Any:
        planes = [
            np.ascontiguousarray(np.asarray(x, float).reshape(-1, a.size).T)
            for x, a in zip(inputs, function.inputs, strict=True)
        ]
        n = planes[0].shape[1] if planes else 1
        results = _results(function)
        header = {
            "function": function.name,
            "n": n,
            "sizes": [len(p) for p in planes],
            "fields": self._fields,
            "outputs": len(results),
        }
        answers = self._exchange(header, [*planes, np.array([float(p) for p in params])])
        lead = (n,) if inputs else ()
        shaped = [
            np.frombuffer(answer, dtype).reshape(prod(shape), n).T.reshape((*lead, *shape))
            for answer, (shape, dtype) in zip(answers, results, strict=True)
        ]
        return shaped[0] if len(shaped) == 1 else tuple(shaped)

    def _exchange(self, header: dict[str, Any], arrays: Sequence[Any]) -> list[bytes]:
        given, taken = self._process.stdin, self._process.stdout
        assert given is not None and taken is not None
        text = json.dumps(header).encode()
        message = [struct.pack("<I", len(text)), text, *(a.tobytes() for a in arrays)]
        try:
            given.write(b"".join(message))
            given.flush()
        except BrokenPipeError:
            raise FailedError("Node cannot load the module") from None
        (size,) = struct.unpack("<I", _read(taken, 4))
        answer = json.loads(_read(taken, size))
        if "error" in answer:
            raise FailedError(f"{header['function']}: {answer['error']}")
        return [_read(taken, size) for size in answer["sizes"]]


def _read(stream: Any, size: int) -> bytes:
    found: bytes = stream.read(size)
    if len(found) < size:
        raise FailedError("Node cannot load the module, or has ended")
    return found


def _results(function: Function) -> list[tuple[tuple[int, ...], type]]:
    """The shape and the type of each result of one posture."""
    lead = (len(function.branches),) if function.branches else ()
    dtype = np.uint8 if function.boolean else np.float64
    results: list[tuple[tuple[int, ...], type]] = [
        ((*lead, *map(int, a.shape)), dtype) for a in function.outputs
    ]
    return [*results, (lead, np.uint8)] if function.has_status else results
