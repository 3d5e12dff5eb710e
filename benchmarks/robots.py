"""``python -m benchmarks.robots`` writes ``docs/robots.md``: the inverses of real robots.

Each robot is a file of joints in ``benchmarks/arms``, with its source.  Its inverse is proposed and
proved as ``closedform new`` and ``closedform derive`` do; the seconds are those of one core.  The
nanoseconds are those of one call of the printed C, with all branches, at random postures.
"""

from __future__ import annotations

import argparse
import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from statistics import median

import numpy as np
import sympy as sp

from closedform.emit.pages import pages, shared_files
from closedform.model.derivation import Derivation
from closedform.pipeline import run as pipeline
from closedform.pipeline import scripts
from closedform.pipeline.trial import fault
from closedform.proof.prove import prove
from closedform.scaffold.chains.arm_angle import NAME as ARM_ANGLE
from closedform.scaffold.inputs.tree import Choice
from closedform.scaffold.new import InverseSearch, Script, new

from .native import LOOP, compiled, processor, running

FOLDER = Path(__file__).parent / "arms"
PAGE = Path(__file__).parents[1] / "docs" / "robots.md"
HEAD = """\
# Real robots

The inverses that `closedform new` proposes for the files in `benchmarks/arms`, tables of joints and
URDF, and that the prover accepts.

The lengths are nominal; compare them with the linked source before you rely on one. They are
numbers here, so what is proved is proved for these numbers; the derivations `puma560`, `ur_arm`,
`stanford_arm` and `scara` have the lengths as parameters, and their proofs hold for any lengths. A
robot that was calibrated has other lengths, and its axes are not exactly parallel. A joint that is
given is an input of the inverse, and so is an arm angle (`--given arm_angle`). If short lengths
were left out (`--ignore`), the row says so; the tool is off by about as much.

The seconds are those of one core for `closedform new`, which proves the inverse that it proposes,
and for `closedform derive`, which proves it again, without printing. The nanoseconds are those of
one call of the printed C with all branches, on one core of {machine}.
This page is written by `python -m benchmarks.robots`.

| robot | structure | branches | lemmas | s | ns |
|---|---|---:|---|---:|---:|
"""
CALLS = """
#include "{name}.c"
static const {name}_params params = {upper}_DEFAULTS;
void reach(const double *q, double *x) {{ {name}_fk(&params, q, x); }}
void evaluate(const double *in, double *out)
{{
    {name}_ik(&params, {arguments}, out, (unsigned char *)(out + {answers}));
}}
"""
POSTURES, ROUNDS = 512, 31


@dataclass(frozen=True)
class Robot:
    """A file of joints, and what its head says."""

    path: Path
    title: str
    source: str
    modified: bool
    ignore: str

    @classmethod
    def read(cls, path: Path) -> Robot:
        said = {}
        for line in path.read_text("utf-8").splitlines():
            head = line.removeprefix("<!-- ").removesuffix(" -->").removeprefix("# ")
            key, colon, value = head.partition(": ")
            if head != line and colon:
                said[key] = value
        modified = said.get("convention") == "modified"
        return cls(path, said["robot"], said["source"], modified, said.get("ignore", "0"))

    def script(self, given: str = "") -> Script:
        kind = "urdf" if self.path.suffix == ".urdf" else "dh"
        search = InverseSearch(given=given, fault=fault)
        choice = Choice(ignore=float(self.ignore))
        return new(
            self.path.stem, kind, self.path, modified=self.modified, choice=choice, search=search
        )


def seconds_of_computing() -> float:
    """Those of this process and of the ended ones that it started, as ``new`` does."""
    return sum(os.times()[:4])


def rows(robot: Robot, *, timed: bool = True) -> Iterator[str]:
    """The lines of the table: a second one if the arm angle can be an input.

    If they are not ``timed``, no C is printed and compiled, and the last column is empty.
    """
    start = seconds_of_computing()
    script = robot.script()
    yield row(robot, script, start, timed=timed)
    start = seconds_of_computing()
    script = robot.script(ARM_ANGLE)
    if script.structure:
        yield row(robot, script, start, timed=timed)


def row(robot: Robot, script: Script, start: float, *, timed: bool = True) -> str:
    """A line of the table; the time counts from ``start``."""
    name = f"[{robot.title}]({robot.source})"
    if not script.structure:
        return f"| {name} | {script.inverse} | | | | |"
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, f"{robot.path.stem}.py")
        path.write_text(script.text, "utf-8")
        (source,) = scripts.find([str(path)])
        d = scripts.load(source)
        proof = prove(d)
        seconds = seconds_of_computing() - start
        taken = ""
        if timed:
            done = pages(d, proof, ["c"])
            pipeline.write(Path(folder), {**done.files, **shared_files([done.share], ["c"])})
            taken = nanoseconds(d, Path(folder, "c"))
    (inverse,) = proof.inverses
    lemmas = ", ".join(f"`{lemma}`" for lemma in script.lemmas)
    structure = script.structure
    if robot.ignore != "0":
        structure += f"; lengths up to {robot.ignore} left out"
    cells = (name, structure, inverse.branches, lemmas, f"{seconds:.1f}", taken)
    return f"| {' | '.join(map(str, cells))} |"


def nanoseconds(d: Derivation, folder: Path) -> str:
    """The time of one call of the inverse."""
    inverse, joints = d["ik"], [s.name for s in d.actuated]
    arguments = [
        f"in + {inverse.inputs[0].size + joints.index(a.name)}" if a.name in joints else "in"
        for a in inverse.inputs
    ]
    branches = len(list(inverse.cases()))
    answers, entries = branches * len(joints), inverse.inputs[0].size
    code = CALLS.format(
        name=d.name, upper=d.name.upper(), arguments=", ".join(arguments), answers=answers
    )
    loop = folder / "loop.c"
    loop.write_text(LOOP, "utf-8")
    library = compiled(["gcc", "-std=gnu99"], folder / "calls.c", code, "native", loop)
    run = running(library)
    values = np.zeros((POSTURES, entries + len(joints)))
    values[:, entries:] = np.random.default_rng(1).uniform(-3, 3, (POSTURES, len(joints)))
    for posture in values:
        library.reach(np.ctypeslib.as_ctypes(posture[entries:]), np.ctypeslib.as_ctypes(posture))
    out = np.empty((POSTURES, answers + branches))
    sizes = (values.shape[1], out.shape[1], POSTURES, 1)
    return f"{median(run(values, out, *sizes) for _ in range(ROUNDS)):.0f}"


def page(paths: list[Path]) -> str:
    lines = []
    for robot in sorted(map(Robot.read, paths), key=lambda r: r.title.lower()):
        sp.core.cache.clear_cache()
        for line in rows(robot):
            lines.append(line)
            print(line, flush=True)
    return HEAD.format(machine=processor()) + "\n".join(lines) + "\n"


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("names", nargs="*", help="print the rows of these robots only")
    names = parser.parse_args().names
    files = sorted([*FOLDER.glob("*.csv"), *FOLDER.glob("*.urdf")])
    if names:
        page([path for path in files if path.stem in names])
    else:
        PAGE.write_text(page(files), "utf-8")


if __name__ == "__main__":
    main()
