"""JavaScript, called in one Node process for each robot."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from closedform.check.failures import FailedError, UnavailableError
from closedform.check.finding import Backend
from closedform.check.runners import shaped
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.tolerances import DOUBLE

TYPES = {"Float64Array": np.float64, "Uint8Array": np.uint8}


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    fields = [p.name for p in derivation.parameters]
    with Node(folder / f"{derivation.name}.js") as node:

        def function(name: str) -> Callable[..., Any]:
            return lambda *arguments: _called(node, derivation[name], fields, *arguments)

        yield Backend(name, function, np.float64, DOUBLE)


def _called(node: Node, function: Function, fields: Sequence[str], *arguments: Any) -> Any:
    """A function that takes arrays and then the parameters."""
    *inputs, params = arguments
    planes = [
        np.asarray(x, float).reshape(-1, a.size).T
        for x, a in zip(inputs, function.inputs, strict=True)
    ]
    found = node.batch(function.name, planes, dict(zip(fields, map(float, params), strict=True)))
    return shaped(function, np.concatenate(found).T)


def executable() -> str:
    """The path of Node."""
    found = shutil.which("node")
    if found is None:
        raise UnavailableError("Node is not installed")
    return found


class Node:
    """A module, called through its ``_batch`` functions."""

    def __init__(self, module: Path):
        script = files("closedform.check.runners") / "serve.mjs"
        self._process = subprocess.Popen(
            [executable(), str(script), str(module)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def __enter__(self) -> Node:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.communicate()

    def batch(
        self, function: str, inputs: Sequence[NDArray[Any]], parameters: Mapping[str, float]
    ) -> list[NDArray[Any]]:
        """The results like the inputs: a row for each number, a column for each posture."""
        n = inputs[0].shape[1] if inputs else 1
        header = {
            "function": function,
            "n": n,
            "sizes": [len(x) for x in inputs],
            "fields": [*parameters],
        }
        text = json.dumps(header).encode()
        numbers = [*inputs, np.array([*parameters.values()], float)]
        self._give(b"".join([struct.pack("<I", len(text)), text, *(x.tobytes() for x in numbers)]))
        (size,) = struct.unpack("<I", self._take(4))
        answer = json.loads(self._take(size))
        if "error" in answer:
            raise FailedError(f"{function}: {answer['error']}")
        return [
            np.frombuffer(self._take(size), TYPES[name]).reshape(-1, n)
            for name, size in answer["arrays"]
        ]

    def _give(self, message: bytes) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(message)
            self._process.stdin.flush()
        except BrokenPipeError:
            raise FailedError("Node cannot load the module") from None

    def _take(self, size: int) -> bytes:
        assert self._process.stdout is not None
        found: bytes = self._process.stdout.read(size)
        if len(found) < size:
            raise FailedError("Node cannot load the module, or has ended")
        return found
