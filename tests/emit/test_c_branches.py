"""The branches of a single call in C are the lanes of vectors, for arms of users as well."""

import re
import subprocess
from pathlib import Path

import pytest
from libraries import FLAGS, ROOT, C, compiles

from closedform.emit.pages import pages, shared_files
from closedform.pipeline import scripts
from closedform.pipeline.run import write
from closedform.proof.prove import Proof
from closedform.scaffold.new import new

ARMS = ROOT / "benchmarks" / "arms"
BRANCHES = re.compile(r"CF_INLINE void \w+_branches\(")
BUNDLED = sorted(p.stem for p in C.glob("*.c") if BRANCHES.search(p.read_text("utf-8")))

pytestmark = pytest.mark.skipif(not compiles(), reason="no gcc 12 for x86-64")


def assert_branches_become_vectors(source: Path, output: Path) -> None:
    lines = source.read_text("utf-8").splitlines()
    start = next(k for k, line in enumerate(lines) if BRANCHES.match(line))
    loop = next(k for k in range(start, len(lines)) if "for (size_t i = 0;" in lines[k]) + 1
    told = subprocess.run(
        ["gcc", *FLAGS.split(), "-fopt-info-loop-vec-optimized", "-c", source, "-o", output],
        capture_output=True, text=True, check=True,
    ).stderr  # fmt: skip
    assert f"{source}:{loop}:5: optimized: loop vectorized" in told


@pytest.mark.parametrize("robot", BUNDLED)
def test_bundled(robot: str, tmp_path: Path) -> None:
    assert_branches_become_vectors(C / f"{robot}.c", tmp_path / "robot.o")


@pytest.mark.parametrize("file", ["z1.urdf", "ur5.csv"])
def test_arm_of_a_user(file: str, tmp_path: Path) -> None:
    """Without an offset at the shoulder, jumps around divisors left no vectors."""
    path = ARMS / file
    script = tmp_path / f"{path.stem}.py"
    kind = "urdf" if path.suffix == ".urdf" else "dh"
    script.write_text(new(path.stem, kind, path).text, "utf-8")
    d = scripts.load(scripts.find([str(script)])[0])
    done = pages(d, Proof(d.name, "own", (), 0, ()), ["c"])
    write(tmp_path, {**done.files, **shared_files([done.share], ["c"])})
    assert_branches_become_vectors(tmp_path / "c" / f"{path.stem}.c", tmp_path / "arm.o")
