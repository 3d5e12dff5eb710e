"""The bare C under the address and undefined-behaviour sanitizers, with random numbers."""

from __future__ import annotations

import atexit
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from compiling import compiled

from .outcome import Failure, Outcome

NAME = "kernels"
CALLS = 20_000
ROOT = Path(__file__).parents[2]
GENERATED, RUNTIME = ROOT / "generated" / "c", ROOT / "closedform" / "runtime" / "extension"
SANITIZE = ("-fsanitize=address,undefined", "-fno-sanitize-recover=all")
LONG = 400_000
"""Bytes of a source from which gcc takes less time if it optimises.

Without optimisation it compares each variable of a function with every other, to find those that
are used after their scope. With it, most of them are gone by then.
"""


def available() -> bool:
    return shutil.which("gcc") is not None


def round(rng: np.random.Generator) -> Outcome:
    """Twenty thousand calls in one process."""
    outcome = Outcome()
    seed = int(rng.integers(0, 1 << 40))
    message, call = _run(seed, CALLS)
    outcome.count("generated C", calls=call + 1 if message else CALLS, failed=int(bool(message)))
    if message:
        outcome.failures.append(Failure(NAME, message, {"seed": seed, "call": call}))
    return outcome


def replay(case: Mapping[str, Any]) -> list[str]:
    """One saved call."""
    message, _ = _run(case["seed"], CALLS, case["call"])
    return [message] if message else []


def _run(seed: int, calls: int, only: int | None = None) -> tuple[str, int]:
    """Why the driver died, and in which call; the message is empty if it did not."""
    command = [driver(), str(seed), str(calls), *([str(only)] if only is not None else [])]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0:
        return "", 0
    last = done.stdout.splitlines()[-1].split()
    reason = next(
        (line for line in done.stderr.splitlines() if "rror" in line or "status" in line), ""
    )
    return f"{last[2]}: exit code {done.returncode}: {reason}", int(last[1])


def _size(source: Path) -> int:
    return source.stat().st_size


@cache
def driver() -> Path:
    """The driver with all generated C; only what changed is compiled again."""
    folder = Path(tempfile.mkdtemp(prefix="closedform-fuzz-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    sources = [ROOT / "tests" / "c" / "random_driver.c", *sorted(GENERATED.glob("*.c"))]
    # A call checks an access, which takes less to compile than checks in place.
    calls = ("--param", "asan-instrumentation-with-call-threshold=0")
    command = ["gcc", "-std=c99", *SANITIZE, *calls, f"-I{GENERATED}", f"-I{RUNTIME}"]

    def one(source: Path) -> Path:
        target = folder / f"{source.stem}.o"
        level = "-O0" if _size(source) < LONG else "-O1"
        compiled([*command, level, "-c", source], target)
        return target

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(one, sorted(sources, key=_size, reverse=True)))
    program = folder / "driver"
    subprocess.run(["gcc", *SANITIZE, *objects, "-o", program, "-lm"], check=True)
    return program
