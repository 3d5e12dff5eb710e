"""``python -m benchmarks`` times the generated code and its peers, taking turns on one core.

The values of every competitor are checked before it is timed. The competitors of a table run in
turns; their medians are printed, with the ratios to closedform. A competitor that fails is listed
with its error. The result of a whole run is also written to ``benchmarks/RESULTS.md``.
"""

from __future__ import annotations

import argparse
import os
import platform
import re
import subprocess
import sys
import tempfile
import time
import timeit
from collections.abc import Callable, Mapping
from functools import partial
from importlib import metadata
from pathlib import Path

import numpy as np

from closedform.pipeline.disk import replace

from . import batches, inverses, libraries, native
from .cases import CASES, Case, NotApplicableError, check
from .turns import medians

MILLION = 1_000_000
SETTLED = 0.1
"""Seconds to wait before timing a batch, because JAX frees its arrays in the background."""
PACKAGES = {
    "sympy.cse": "sympy",
    "lambdify": "sympy",
    "array, jax.jit": "jax",
    "array, torch": "torch",
    "array, NumPy": "array-api-compat",
}
TABLES = ("c", "batch", "single", "inverse")
ASIDE = ("array", "threads")
"""Only if they are asked for; for threads, the other tables of the run have all cores too."""
Run = Callable[[], float]
Maker = Callable[[], Run]
Competitors = dict[str, Run]


class Report:
    """Lines of Markdown, printed as they are added."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def write(self, line: str = "") -> None:
        self.lines.append(line)
        print(line, flush=True)

    def table(self, title: str, unit: str, competitors: Competitors, rounds: int) -> None:
        """Time all competitors, taking turns; the ratios are to the first one."""
        self.write(f"\n| {title} | median, {unit} | times closedform |\n|---|---:|---:|")
        found = medians(competitors, rounds)
        best = next(iter(found.values()), 1.0)
        for name, median in found.items():
            self.write(f"| {name} | {median:.4g} | {median / best:.2f} |")


def explained(error: BaseException) -> str:
    text = re.sub(r"\S*/", "", str(error).split("\n", 1)[0])
    return f"{type(error).__name__}: {text[:110]}"


def clock(call: timeit.Timer, postures: int, repeat: int) -> Run:
    def timed() -> float:
        if postures > 1:
            time.sleep(SETTLED)
        return call.timeit(repeat) / repeat / postures * 1e9

    return timed


def compared(
    report: Report, title: str, unit: str, makers: Mapping[str, Maker], rounds: int
) -> None:
    """Write a table of the competitors that work, and the errors of those that fail."""
    competitors: Competitors = {}
    failures = []
    for name, make in makers.items():
        try:
            competitors[name] = make()
        except NotApplicableError:
            continue
        except Exception as error:
            failures.append(f"- {name}: {explained(error)}")
    report.table(title, unit, competitors, rounds)
    report.write()
    for failure in failures:
        report.write(failure)


def from_c(
    name: str, case: Case, target: str, *, folder: Path, inputs: np.ndarray, expected: np.ndarray
) -> Run:
    """The run of a competitor in C, after its values are found to be right.

    Parameters
    ----------
    name
        that of the competitor
    case
        the function
    target
        the flags of the compiler for a machine
    folder
        where it is compiled
    inputs, expected
        postures, and the values for them
    """
    run, values = native.timer(name, case, target, folder, inputs)
    check(case, values, expected)
    return run


def calls_from_c(report: Report, cases: list[Case], rounds: int, folder: Path) -> None:
    report.write("\n## One call from C\n")
    flags = " ".join(native.FLAGS)
    report.write(f"Every competitor is compiled with `{flags}` and runs over 512 postures.")
    for case in cases:
        inputs = case.inputs(512)
        expected = case.values(inputs)
        for label, target in native.TARGETS.items():
            makers = {
                name: partial(
                    from_c, name, case, target, folder=folder, inputs=inputs, expected=expected
                )
                for name in native.SOURCES
            }
            compared(report, f"{case.title}, {label}", "ns", makers, rounds)


def from_python(
    peer: batches.Peer, case: Case, layout: str, rows: np.ndarray, expected: np.ndarray
) -> Run:
    call, values = peer(case, layout, rows)
    if values is not None:
        check(case, values()[: len(expected)], expected)
    return clock(call, len(rows), 1 if len(rows) > 1 else 2000)


def calls_from_python(
    report: Report,
    cases: list[Case],
    rounds: int,
    n: int,
    *,
    peers: Mapping[str, batches.Peer] = batches.PEERS,
    words: str = "",
) -> None:
    """Write the tables of batches of ``n`` postures in both layouts, or of single postures.

    Parameters
    ----------
    report
        what they are written to
    cases
        the functions
    rounds
        how many times each competitor runs
    n
        the number of postures in a batch
    peers
        the competitors, by name
    words
        what the title says of them
    """
    report.write(f"\n## {'One call' if n == 1 else f'Batch of {n:,}'} from Python{words}")
    layouts = {"planes": ", structure of arrays, `out=`", "rows": ", `(N, n)` arrays"}
    for case in cases:
        inputs = case.inputs(n)
        expected = case.values(inputs[:1000])
        for layout, said in layouts.items() if n > 1 else [("rows", "")]:
            makers = {
                name: partial(from_python, peer, case, layout, inputs, expected)
                for name, peer in peers.items()
            }
            compared(report, case.title + said, "ns per posture", makers, rounds)


def with_threads(cores: int) -> dict[str, batches.Peer]:
    """The compiled functions and numba's parallel loops, on some and on all cores."""
    counts = sorted({1, 2, cores // 2, cores} - {0})
    ours = {f"closedform C, {n}": partial(batches.ours, "c", threads=n) for n in counts}
    return ours | {f"numba, {n}": partial(batches.numba, threads=n) for n in counts}


def versions() -> str:
    names = dict.fromkeys(
        PACKAGES.get(n, n)
        for n in (*native.SOURCES, *batches.PEERS, *libraries.PEERS, *inverses.PEERS)
    )
    found = []
    for name in ("numpy", *names):
        try:
            found.append(f"{name} {metadata.version(name)}")
        except metadata.PackageNotFoundError:
            continue
    return ", ".join(dict.fromkeys(found))


def machine() -> str:
    gcc = subprocess.run(["gcc", "-dumpfullversion"], capture_output=True, text=True, check=False)
    return f"{native.processor()}, gcc {gcc.stdout.strip()}, Python {platform.python_version()}"


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("cases", nargs="*", help="part of a title, such as 'pose'; default all")
    parser.add_argument("--rounds", type=int, default=9, help="times that each competitor runs")
    parser.add_argument("--batch", type=int, default=MILLION, help="postures in a batch")
    parser.add_argument(
        "--only",
        choices=(*TABLES, *ASIDE),
        action="append",
        help=f"write only this table; can be repeated (default: {', '.join(TABLES)})",
    )
    parser.add_argument(
        "-o", "--output", type=Path, help="file to write; RESULTS.md for a whole run"
    )
    arguments = parser.parse_args()
    tables = arguments.only or TABLES
    cores = os.sched_getaffinity(0) if hasattr(os, "sched_getaffinity") else set()
    if cores and "threads" not in tables:
        os.sched_setaffinity(0, {max(cores)})
    chosen = [c for c in CASES if not arguments.cases or any(w in c.title for w in arguments.cases)]
    report = Report()
    where = "on all cores" if "threads" in tables else "on one core"
    report.write(f"# Benchmarks\n\nWritten by `make bench`; competitors take turns {where}.\n")
    report.write(f"{machine()}; {versions()}.")
    with tempfile.TemporaryDirectory() as folder:
        if "c" in tables:
            calls_from_c(report, chosen, arguments.rounds, Path(folder))
    calls = partial(calls_from_python, report, chosen, arguments.rounds)
    if "batch" in tables:
        calls(arguments.batch)
    if "single" in tables:
        calls(1)
    if "array" in tables:
        calls(arguments.batch, peers=libraries.PEERS, words=", by array libraries")
    if "threads" in tables:
        peers = with_threads(len(cores) or os.cpu_count() or 1)
        calls(arguments.batch, peers=peers, words=", by the number of threads")
    if "inverse" in tables:
        inverses.compare(report, arguments.rounds)
    whole = not (arguments.cases or arguments.only)
    output = arguments.output or (Path(__file__).with_name("RESULTS.md") if whole else None)
    if output:
        replace(output, ("\n".join(report.lines) + "\n").encode())
    return 0


if __name__ == "__main__":
    sys.exit(main())
