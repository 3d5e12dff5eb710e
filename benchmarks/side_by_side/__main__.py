"""``python -m benchmarks.side_by_side`` compares closedform with its peers, task by task.

Every answer of a peer is compared with ours before it is timed; a peer that answers another thing
is listed with what differs. Peers that are not installed are left out. Without names of peers, the
page ``docs/side-by-side.md`` is written.
"""

from __future__ import annotations

import argparse
import importlib
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import metadata
from pathlib import Path
from timeit import timeit
from typing import Any

from closedform.pipeline.disk import replace

from .. import native
from ..turns import medians
from . import ours
from .page import HEAD, INTRODUCTIONS, TAIL, TITLES
from .tasks import TASKS, DisagreementError, Ways, judged

PAGE = Path(__file__).parents[2] / "docs" / "side-by-side.md"
PEERS = {
    "toolbox": "roboticstoolbox-python",
    "ssik_solver": "ssik",
    "eaik_solver": "EAIK",
    "pinocchio_model": "pin",
    "pyroki_solver": "almond-pyroki",
}
"""The modules of this folder, and the packages that they need."""
SLOW = ("drawing", "URDF")
"""Tasks that run fewer rounds."""


@dataclass(frozen=True)
class Competitor:
    """One column of the comparison: its ways, and the seconds until they were ready."""

    name: str
    ways: Ways
    version: str
    seconds: float

    @classmethod
    def made(cls, name: str, make: Callable[[], Ways], package: str) -> Competitor:
        start = time.perf_counter()
        ways = make()
        return cls(name, ways, metadata.version(package), time.perf_counter() - start)


def competitors(names: list[str]) -> list[Competitor]:
    found = [
        Competitor.made(ours.NAME, ours.ways, "closedform"),
        Competitor.made(f"{ours.NAME}, one at a time", ours.one_by_one, "closedform"),
    ]
    for name in names:
        try:
            version = metadata.version(PEERS[name])
        except metadata.PackageNotFoundError:
            continue
        peer: Any = importlib.import_module(f"{__package__}.{name}")
        found.append(Competitor.made(peer.NAME, peer.ways, PEERS[name]))
        print(f"{peer.NAME} {version}", flush=True)
    return found


def words(seconds: float) -> str:
    """A time in the unit in which it has one to three digits before the point."""
    units = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
    unit = next((name for name, size in units.items() if seconds >= size), "us")
    value = seconds / units[unit]
    return f"{value:.2g} {unit}" if value < 100 else f"{value:.0f} {unit}"


def compared(task: str, found: list[Competitor], rounds: int) -> list[str]:
    """The rows of a task: the answers are checked once, then all take turns."""
    runs: dict[str, Callable[[], float]] = {}
    results: dict[str, str] = {}
    mine = found[0].ways[task]
    expected = mine.read(mine.run()) if mine.run else None
    for competitor in found:
        way = competitor.ways.get(task)
        if way is None or way.run is None:
            continue
        try:
            results[competitor.name] = judged(task, way, way.read(way.run()), expected)
            runs[competitor.name] = partial(timeit, way.run, number=1)
        except DisagreementError as error:
            results[competitor.name] = f"differs: {error}"
    results[found[0].name] = ""
    times = medians(runs, rounds)
    rows = []
    for competitor in found:
        way = competitor.ways.get(task)
        if way is None:
            continue
        told = words(times[competitor.name] / way.units) if competitor.name in times else ""
        result = results.get(competitor.name, "")
        rows.append(f"| {competitor.name} | {way.call} | {result} | {told} |")
    return rows


def page(names: list[str], rounds: int) -> str:
    found = competitors(names)
    lines = [HEAD.format(machine=native.processor())]
    lines += ["| | version | ready after |", "|---|---|---:|"]
    lines += [f"| {c.name} | {c.version} | {words(c.seconds)} |" for c in (found[0], *found[2:])]
    for task in TASKS:
        lines += ["", f"## {TITLES[task]}", "", INTRODUCTIONS[task], ""]
        lines += ["| | how | compared with ours | time |", "|---|---|---|---:|"]
        rows = compared(task, found, max(1, rounds // 3) if task in SLOW else rounds)
        lines += rows
        print("\n".join(rows), flush=True)
    return "\n".join([*lines, "", TAIL])


def main() -> None:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.side_by_side", description=(__doc__ or "").partition("\n")[0]
    )
    parser.add_argument("names", nargs="*", metavar="PEER", help="print these peers only")
    parser.add_argument("--rounds", type=int, default=9, help="times that each competitor runs")
    arguments = parser.parse_args()
    import matplotlib

    matplotlib.use("Agg")
    text = page(arguments.names or list(PEERS), arguments.rounds)
    if not arguments.names:
        replace(PAGE, text.encode())


if __name__ == "__main__":
    main()
