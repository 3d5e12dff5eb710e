"""``python -m benchmarks.robots`` writes ``docs/robots.md``: the inverses of real robots.

Each robot is a table of joints in ``benchmarks/arms``, with its source.  The inverse is proposed
and proved as ``closedform new`` and ``closedform derive`` do it; the time is that of one core.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from pathlib import Path

import sympy as sp

import closedform
from closedform.lazy import homes
from closedform.lemmas.chain import Chain
from closedform.mechanics.arm import Serial, from_dh
from closedform.model.derivation import Derivation, Paper
from closedform.proof.prove import prove
from closedform.scaffold.proposal import Proposal
from closedform.scaffold.propose import NoChainError, propose
from closedform.scaffold.tables import Table, read_dh

FOLDER = Path(__file__).parent / "arms"
PAGE = Path(__file__).parents[1] / "docs" / "robots.md"
HEAD = """\
# Real robots

The inverses that `closedform new` proposes for the tables in `benchmarks/arms`, and that the prover
accepts.

The lengths are nominal; compare them with the linked source before you rely on one. They are
numbers here, so what is proved is proved for these numbers; the derivations `puma560`, `ur_arm`,
`stanford_arm` and `scara` have the lengths as parameters, and their proofs hold for any lengths. A
robot that was calibrated has other lengths, and its axes are not exactly parallel. A joint that is
given is an input of the inverse. The seconds are those of one core for reading the table, proposing
the chain and proving the inverse, without printing. This page is written by `python -m
benchmarks.robots`.

| robot | structure | branches | lemmas | seconds |
|---|---|---:|---|---:|
"""


@dataclass(frozen=True)
class Robot:
    """A table with its name and its source."""

    title: str
    source: str
    table: Table

    @classmethod
    def read(cls, path: Path) -> Robot:
        text = path.read_text("utf-8")
        said = {}
        for line in text.splitlines():
            key, colon, value = line.removeprefix("# ").partition(": ")
            if line.startswith("# ") and colon:
                said[key] = value
        modified = said.get("convention") == "modified"
        return cls(said["robot"], said["source"], read_dh(path, modified=modified))

    def arm(self) -> tuple[Derivation, Serial]:
        d = Derivation("robot", self.title, Paper("own", "own", ("the maker",)), "A robot.")
        for name in self.table.parameters:
            d.parameter(name, value=1, unit="m", meaning=name)
        joints = {n: d.joint(n, k) for n, k in self.table.joints.items()}  # type: ignore[arg-type]
        known = {**joints, **{p.symbol.name: p.symbol for p in d.parameters}}
        rows = [
            tuple(e.xreplace({s: known[s.name] for s in e.free_symbols}) for e in row)
            for row in self.table.rows
        ]
        return d, from_dh(d, rows, modified=self.table.modified)


def proved(d: Derivation, arm: Serial, found: Proposal) -> int:
    """The number of proved branches."""
    task = arm.coordinates()
    if task is not None:
        d.task = list(task.names)
    angles = ["yaw"] if task is not None and "yaw" in task.names else []
    ik = Chain(d, arm.pose if task is None else task.values, angles=angles)
    names: dict[str, object] = {}
    exec("from sympy import *", names)
    names |= {name: getattr(closedform, name) for name in homes(closedform.__path__)}
    names |= {s.name: s for s in (*ik.joints, *(p.symbol for p in d.parameters))}
    exec(found.source, names | {"ik": ik})
    ik.finish("All.")
    (inverse,) = prove(d).inverses
    return inverse.branches


def row(robot: Robot) -> str:
    """A line of the table."""
    name = f"[{robot.title}]({robot.source})"
    start = time.process_time()
    d, arm = robot.arm()
    try:
        found = propose(arm)
    except NoChainError as error:
        return f"| {name} | no inverse, because {error.found} | | | |"
    count = proved(d, arm, found)
    lemmas = ", ".join(f"`{lemma}`" for lemma in found.lemmas)
    seconds = time.process_time() - start
    return f"| {name} | {found.structure} | {count} | {lemmas} | {seconds:.1f} |"


def page(paths: list[Path]) -> str:
    rows = []
    for path in paths:
        sp.core.cache.clear_cache()
        rows.append(row(Robot.read(path)))
    return HEAD + "\n".join(rows) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", help="print the rows of these tables only")
    names = parser.parse_args().names
    if names:
        print(page([FOLDER / f"{name}.csv" for name in names]))
    else:
        PAGE.write_text(page(sorted(FOLDER.glob("*.csv"))), "utf-8")


if __name__ == "__main__":
    main()
