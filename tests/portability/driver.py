"""The generated C as a program for any compiler and any processor.

Code that cannot be loaded into this process (32 bits, another processor, code that traps) can still
run as a program, under an emulator if necessary.
"""

from __future__ import annotations

import importlib
import os
import subprocess
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import cache
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np
from compiling import CompilerError, compiled
from numpy.typing import NDArray

from closedform.model.derivation import Derivation
from closedform.model.functions import Function

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "generated" / "c"
DRIVER = Path(__file__).parent / "driver.c"
ROBOTS = tuple(sorted(p.stem for p in SOURCES.glob("*.c") if p.stem != "extension"))
HEADER = ("closedform", "header")  # the functions of closedform.h, as if they were a robot's
REFUSED = "closedform.h needs"

Array = NDArray[np.float64]
Name = tuple[str, str]


@cache
def derivation(robot: str) -> Derivation:
    found: Derivation = importlib.import_module(f"closedform.derivations.{robot}").d
    return found


def numpy_function(robot: str, name: str) -> Any:
    return getattr(importlib.import_module(f"closedform.generated.numpy.{robot}"), name)


def numpy_values(robot: str, function: Function, rows: Array, parameters: Sequence[float]) -> Any:
    """The outputs of the NumPy function as a list of arrays with a row for each posture."""
    ends = list(accumulate((a.size for a in function.inputs), initial=0))
    inputs = [
        rows[:, start : start + a.size].reshape(-1, *a.shape)
        for start, a in zip(ends, function.inputs, strict=False)
    ]
    with np.errstate(all="ignore"):
        result = numpy_function(robot, function.name)(*inputs, tuple(parameters))
    parts = result if isinstance(result, tuple) else (result,)
    n = len(rows) if inputs else 1
    return [np.asarray(part).reshape(n, -1) for part in parts]


@dataclass(frozen=True)
class Signature:
    """The numbers that a function takes and returns; ``kinds`` and ``sizes`` describe outputs."""

    inputs: tuple[int, ...]
    sizes: tuple[int, ...]
    reals: tuple[bool, ...]

    @property
    def n_real(self) -> int:
        return sum(n for n, real in zip(self.sizes, self.reals, strict=True) if real)

    @property
    def n_byte(self) -> int:
        return sum(self.sizes) - self.n_real


@cache
def signature(robot: str, name: str) -> Signature:
    d = derivation(robot)
    function = d[name]
    inputs = tuple(a.size for a in function.inputs)
    parameters = [float(p.value) for p in d.parameters]
    parts = numpy_values(robot, function, np.ones((1, sum(inputs))), parameters)
    return Signature(
        inputs, tuple(p.shape[1] for p in parts), tuple(p.dtype == np.float64 for p in parts)
    )


def functions(robots: Sequence[str]) -> list[Name]:
    return [HEADER, *((robot, f.name) for robot in robots for f in derivation(robot).functions)]


def calls_header(robots: Sequence[str]) -> str:
    """The table of calls that driver.c includes."""
    lines = [f'#include "{robot}.h"' for robot in robots]
    rows = ["HEADER"]
    for robot, name in functions(robots)[1:]:
        s = signature(robot, name)
        one, many = ["p"], ["n", "p"]
        at = {"in": 0, "out": 0, "bytes": 0}
        arrays = [("in", size) for size in s.inputs]
        arrays += [
            ("out" if real else "bytes", n) for n, real in zip(s.sizes, s.reals, strict=True)
        ]
        for array, size in arrays:
            one.append(f"{array} + {at[array]}")
            many.append(f"{array} + {at[array]} * n, n")
            at[array] += size
        full = f"{robot}_{name}"
        heads = {
            "one": (one, "const real_t *params"),
            "many": (many, "size_t n, const real_t *params"),
        }
        for form, (arguments, first) in heads.items():
            lines += [
                f"static void {full}_{form}({first}, const real_t *in, real_t *out,",
                "    uint8_t *bytes)",
                "{",
                f"    const {robot}_params *p = (const {robot}_params *)params;",
                "    (void)in, (void)out, (void)bytes;",
                f"    {full}{'_batch' if form == 'many' else ''}({', '.join(arguments)});",
                "}",
            ]
        n_params = len(derivation(robot).parameters)
        rows.append(
            f"{{ {n_params}, {at['in']}, {at['out']}, {at['bytes']}, {full}_one, {full}_many }}"
        )
    return "\n".join([*lines, "static const call calls[] = {", ",\n".join(rows), "};", ""])


class RefusedError(Exception):
    """The header refuses these flags, and says why."""


@dataclass(frozen=True)
class Request:
    """A function, its parameters, and a row of inputs for each posture."""

    name: Name
    parameters: tuple[float, ...]
    rows: Array


@dataclass(frozen=True)
class Answer:
    """Outputs by posture, reals before bytes; exceptions are 1 invalid, 2 by zero, 4 overflow."""

    single: Array
    batch: Array
    exceptions: list[int]
    batch_exceptions: int


@dataclass(frozen=True)
class Program:
    """The driver, built for some robots."""

    path: Path
    robots: tuple[str, ...]
    runner: tuple[str, ...] = ()

    def ask(self, requests: Sequence[Request], *arguments: str) -> list[Answer]:
        """Return the outputs; raise if the program was stopped by a trap."""
        places = {name: k for k, name in enumerate(functions(self.robots))}
        lines = []
        for r in requests:
            numbers = [*r.parameters, *r.rows.ravel().tolist()]
            lines.append(f"{places[r.name]} {len(r.rows)}")
            lines.append(" ".join(repr(float(x)) for x in numbers))
        done = subprocess.run(
            [*self.runner, str(self.path), *arguments],
            input="\n".join(lines),
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
        )
        if done.returncode:
            raise RuntimeError(f"the program ended with {done.returncode}: {done.stderr[:500]}")
        answers = iter(done.stdout.splitlines())
        return [self._answer(answers, len(r.rows)) for r in requests]

    @staticmethod
    def _answer(lines: Any, n: int) -> Answer:
        rows = [next(lines).split() for _ in range(n)]
        flags, *values = next(lines).split()
        numbers = [[float(x) for x in row[1:]] for row in rows]
        batch = np.array([float(x) for x in values]).reshape(n, -1)
        return Answer(np.array(numbers), batch, [int(row[0]) for row in rows], int(flags))


def compile_driver(
    folder: Path,
    command: Sequence[str],
    robots: Sequence[str],
    *,
    single: bool = False,
    runner: Sequence[str] = (),
    link: Sequence[str] = (),
    made: Mapping[str, Path] | None = None,
) -> Program:
    """Builds the driver by ``command``, a compiler and its flags; ``made`` robots have objects."""
    made = made or {}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "calls.h").write_text(calls_header(robots), "utf-8")
    define = ["-DCLOSEDFORM_FLOAT"] if single else []
    start = [*command, *define, f"-I{SOURCES}", f"-I{folder}"]
    sources = [DRIVER, *(SOURCES / f"{robot}.c" for robot in robots if robot not in made)]
    objects = [folder / f"{source.stem}.o" for source in sources]

    def one(pair: tuple[Path, Path]) -> None:
        source, target = pair
        try:
            compiled([*start, "-c", source], target)
        except CompilerError as error:
            raise _reason(command, str(error)) from None

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(one, zip(sources, objects, strict=True)))
    program = folder / "driver"
    linked = [*command, *map(str, [*objects, *made.values()]), "-o", str(program), *link, "-lm"]
    done = subprocess.run(linked, capture_output=True, text=True, check=False)
    if done.returncode:
        raise _reason(linked, done.stderr)
    return Program(program, tuple(robots), tuple(runner))


def _reason(command: Sequence[str], said: str) -> Exception:
    errors = [line for line in said.splitlines() if "error" in line]
    if any(REFUSED in line for line in errors):
        return RefusedError(errors[0])
    return RuntimeError(f"{' '.join(command)}\n{said[:2000]}")
