"""Tries the generated C and the extension with every compiler, processor and Python that is here.

    python tests/portability/run.py [--all]

Each attempt prints a line: right, skipped with the reason, or what is wrong, which fails the run.
Nothing is timed. Without --all only two robots are tried, and no Python environment is made.
PYTHONS lists the other interpreters to try.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from portability.cases import cases, mismatches
from portability.driver import ROBOTS, ROOT, RefusedError, compile_driver
from portability.flags import FLAGS, RELEASE

FEW = ("planar_2r", "spherical_wrist")
TARGETS = {
    "aarch64-linux-gnu": "qemu-aarch64",
    "arm-linux-gnueabihf": "qemu-arm",
    "s390x-linux-gnu": "qemu-s390x",
    "powerpc64-linux-gnu": "qemu-ppc64",
}
PYTHONS = ("python3.11", "python3.12", "python3.13", "python3.14", "python3.13t", "python3.14t")
NUMPY = ("numpy==1.26.*", "numpy")
IMPORT = """
import sys, numpy as np
from closedform.generated.c import planar_2r as c
from closedform.generated.numpy import planar_2r as n
q = np.random.default_rng(0).uniform(-3, 3, (200, 2))
for f in ("fk", "pose", "jacobian"):
    np.testing.assert_allclose(getattr(c, f)(q), getattr(n, f)(q), atol=1e-12)
    np.testing.assert_allclose(getattr(c, f)(q[0]), getattr(n, f)(q[0]), atol=1e-12)
x = n.fk(q)
for a, b in zip(c.ik(x), n.ik(x)):
    np.testing.assert_allclose(a, b, atol=1e-9)
print("with NumPy", np.__version__)
"""


def found(target: str) -> str | None:
    """A cross compiler, the newest if several carry their version in their name."""
    names = [f"{target}-gcc", *(f"{target}-gcc-{v}" for v in range(16, 9, -1))]
    return next((name for name in names if shutil.which(name)), None)


def values(
    command: Sequence[str], robots: Sequence[str], *, runner: Sequence[str] = ()
) -> Iterator[str]:
    for single in (False, True):
        kind = "float" if single else "double"
        with tempfile.TemporaryDirectory() as folder:
            try:
                static = ["-static"] if runner else []
                program = compile_driver(
                    Path(folder), command, robots, single=single, runner=runner, link=static
                )
                wrong = list(mismatches(program, cases(robots, single=single), single=single))
            except RefusedError:
                yield f"{kind} refused"
            except RuntimeError as error:
                yield f"WRONG: {kind}: {str(error)[:300]}"
            else:
                yield f"WRONG: {kind}: {wrong[0]}" if wrong else f"{kind} right"


def compilers(robots: Sequence[str], *, everything: bool) -> Iterator[tuple[str, str]]:
    for compiler in ("gcc", "clang"):
        if not shutil.which(compiler):
            yield compiler, "skipped: it is not installed"
            continue
        chosen = (
            FLAGS if everything else {"release": RELEASE, "32 bits, SSE": FLAGS["32 bits, SSE"]}
        )
        for name, flags in chosen.items():
            if "-m32" in flags and not builds([compiler, *flags]):
                yield f"{compiler} {name}", "skipped: there are no 32-bit libraries"
                continue
            done = values([compiler, "-std=c99", *flags], robots)
            yield f"{compiler} {name}", ", ".join(done)


def builds(command: Sequence[str]) -> bool:
    with tempfile.TemporaryDirectory() as folder:
        probe = [*command, "-x", "c", "-", "-o", f"{folder}/probe", "-lm"]
        source = b"#include <math.h>\nint main(void) { return 0; }"
        return subprocess.run(probe, input=source, capture_output=True).returncode == 0


def processors(robots: Sequence[str]) -> Iterator[tuple[str, str]]:
    for target, emulator in TARGETS.items():
        compiler = found(target)
        runner = next((n for n in (emulator, f"{emulator}-static") if shutil.which(n)), None)
        if compiler is None or runner is None:
            missing = f"{target}-gcc" if compiler is None else emulator
            yield target, f"skipped: there is no {missing}"
        elif not builds([compiler, "-static"]):
            yield target, f"skipped: {compiler} has no C library"
        else:
            done = values([compiler, "-std=c99", *RELEASE], robots, runner=[runner])
            yield target, ", ".join(done)


def interpreters() -> Iterator[tuple[str, str]]:
    """The extension, built against each NumPy in an environment of its own."""
    named = os.environ.get("PYTHONS", "").split()
    for python in dict.fromkeys([*PYTHONS, *named]):
        if not works(python):
            yield python, "skipped: it is not installed"
            continue
        for numpy in NUMPY:
            yield f"{python}, {numpy}", extension(python, numpy)


def works(python: str) -> bool:
    if shutil.which(python) is None:
        return False
    return subprocess.run([python, "-c", ""], capture_output=True).returncode == 0


def extension(python: str, numpy: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        own = f"{folder}/env/bin/python"
        source = f"{folder}/source"
        ignored = shutil.ignore_patterns(".*", "build", "*.so", "__pycache__", "*.egg-info")
        shutil.copytree(ROOT, source, ignore=ignored)
        steps = [
            [python, "-m", "venv", f"{folder}/env"],
            [own, "-m", "pip", "install", "-q", "--only-binary=:all:", numpy, "setuptools"],
            [own, "setup.py", "-q", "build_ext", "--build-lib", f"{folder}/lib"],
            [own, "setup.py", "-q", "build_py", "--build-lib", f"{folder}/lib"],
            [own, "-c", IMPORT],
        ]
        for step in steps:
            place = folder if step[1] == "-c" else source
            environment = os.environ | {"PYTHONPATH": f"{folder}/lib", "CLOSEDFORM_DISPATCH": "0"}
            done = subprocess.run(
                step, cwd=place, env=environment, capture_output=True, text=True, check=False
            )
            if done.returncode and step[2:4] == ["pip", "install"]:
                return f"skipped: pip finds no wheel of {numpy}"
            if done.returncode:
                return f"WRONG: {' '.join(step[1:4])}: {done.stderr[-300:]}"
        return f"right {done.stdout.strip()}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--all", action="store_true", help="all robots, flags and Pythons")
    everything = parser.parse_args().all
    robots = ROBOTS if everything else FEW
    wrong = 0
    attempts = [compilers(robots, everything=everything), processors(robots)]
    for attempt in [*attempts, interpreters()] if everything else attempts:
        for name, result in attempt:
            wrong += "WRONG" in result
            print(f"{name}: {result}", flush=True)
    if not everything:
        print("interpreters of Python: skipped without --all")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
