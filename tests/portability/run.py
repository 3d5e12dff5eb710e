"""Tries the generated C and the extension with every compiler, processor and Python that is here.

    python tests/portability/run.py [--all]

Each attempt prints a line: right, skipped with the reason, or what is wrong, which fails the run.
Nothing is timed. Every Python builds the runtime of the extension and calls it from several
threads. With --all there are all robots and flags, and every Python builds the whole extension
with two versions of NumPy. PYTHONS lists other interpreters to try.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from portability.cases import cases, mismatches
from portability.driver import ROBOTS, ROOT, RefusedError, compile_driver
from portability.flags import FLAGS, RELEASE

FEW = ("planar_2r", "spherical_wrist")


@dataclass(frozen=True)
class Target:
    """Another processor: its cross compiler, without ``-gcc``, and what runs its programs."""

    compiler: str
    emulator: str
    options: tuple[str, ...] = ()
    flags: tuple[str, ...] = ()
    link: tuple[str, ...] = ("-static",)


HERE = Path(__file__).parent
CORTEX_M4 = Target(
    "arm-none-eabi",
    "qemu-system-arm",
    options=(
        *("-M", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "none"),
        *("-semihosting-config", "enable=on,target=native", "-kernel"),
    ),
    flags=("-mcpu=cortex-m4", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16"),
    link=("--specs=rdimon.specs", "-T", str(HERE / "cortex_m.ld"), str(HERE / "cortex_m.c")),
)
TARGETS = {
    "aarch64": Target("aarch64-linux-gnu", "qemu-aarch64"),
    "32-bit ARM": Target("arm-linux-gnueabihf", "qemu-arm"),
    "s390x": Target("s390x-linux-gnu", "qemu-s390x"),
    "powerpc64": Target("powerpc64-linux-gnu", "qemu-ppc64"),
    "Cortex-M4": CORTEX_M4,
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
    command: Sequence[str],
    robots: Sequence[str],
    *,
    runner: Sequence[str] = (),
    link: Sequence[str] = (),
) -> Iterator[str]:
    for single in (False, True):
        kind = "float" if single else "double"
        with tempfile.TemporaryDirectory() as folder:
            try:
                program = compile_driver(
                    Path(folder), command, robots, single=single, runner=runner, link=link
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
    for name, target in TARGETS.items():
        compiler = found(target.compiler)
        emulators = (target.emulator, f"{target.emulator}-static")
        runner = next((n for n in emulators if shutil.which(n)), None)
        if compiler is None or runner is None:
            missing = f"{target.compiler}-gcc" if compiler is None else target.emulator
            yield name, f"skipped: there is no {missing}"
        elif not builds([compiler, *target.flags, *target.link]):
            yield name, f"skipped: {compiler} has no C library"
        else:
            command = [compiler, "-std=c99", *RELEASE, *target.flags]
            run = [runner, *target.options]
            yield name, ", ".join(values(command, robots, runner=run, link=target.link))


def interpreters(*, everything: bool) -> Iterator[tuple[str, str]]:
    """The runtime of the extension, or the extension, built in an environment of its own."""
    named = os.environ.get("PYTHONS", "").split()
    for python in dict.fromkeys([*PYTHONS, *named]):
        if not works(python):
            yield python, "skipped: it is not installed"
            continue
        yield f"{python}, threads", threads(python)
        for numpy in NUMPY if everything else ():
            yield f"{python}, {numpy}", extension(python, numpy)


def works(python: str) -> bool:
    if shutil.which(python) is None:
        return False
    return subprocess.run([python, "-c", ""], capture_output=True).returncode == 0


def environment(python: str, *packages: str) -> list[list[str]]:
    """Commands that make an environment in the current folder; the last one installs packages."""
    own = "env/bin/python"
    install = ["-m", "pip", "install", "-q", "--only-binary=:all:", *packages]
    return [[python, "-m", "venv", "env"], [own, *install]]


def threads(python: str) -> str:
    script = str(Path(__file__).with_name("threads.py"))
    with tempfile.TemporaryDirectory() as folder:
        steps = [*environment(python, "numpy"), ["env/bin/python", script, folder]]
        return attempted(steps, folder)


def extension(python: str, numpy: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        own = f"{folder}/env/bin/python"
        source = f"{folder}/source"
        ignored = shutil.ignore_patterns(".*", "build", "*.so", "__pycache__", "*.egg-info")
        shutil.copytree(ROOT, source, ignore=ignored)
        return attempted(
            [
                *environment(python, numpy, "setuptools"),
                [own, "setup.py", "-q", "build_ext", "--build-lib", f"{folder}/lib"],
                [own, "setup.py", "-q", "build_py", "--build-lib", f"{folder}/lib"],
                [own, "-c", IMPORT],
            ],
            folder,
        )


def attempted(steps: Sequence[Sequence[str]], folder: str) -> str:
    """The result of steps in a folder, the second of which installs packages."""
    environment = os.environ | {"PYTHONPATH": f"{folder}/lib", "CLOSEDFORM_DISPATCH": "0"}
    for k, step in enumerate(steps):
        place = f"{folder}/source" if "setup.py" in step else folder
        done = subprocess.run(
            step, cwd=place, env=environment, capture_output=True, text=True, check=False
        )
        if done.returncode and k < 2:
            what = "no module venv" if k == 0 else "no wheel of NumPy that pip finds"
            return f"skipped: there is {what}"
        if done.returncode:
            said = (done.stderr or done.stdout)[-300:]
            return f"WRONG: {' '.join(step[1:4])}: {said}"
    return f"right {done.stdout.strip()}"


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--all", action="store_true", help="all robots, flags and Pythons")
    everything = parser.parse_args().all
    robots = ROBOTS if everything else FEW
    wrong = 0
    attempts = [
        compilers(robots, everything=everything),
        processors(robots),
        interpreters(everything=everything),
    ]
    for attempt in attempts:
        for name, result in attempt:
            wrong += "WRONG" in result
            print(f"{name}: {result}", flush=True)
    if not everything:
        print("the whole extension for each Python: skipped without --all")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
