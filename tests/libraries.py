"""The generated C as it is shipped, for processors with AVX2: a library a robot and float type."""

import platform
import re
import shutil
import subprocess
from pathlib import Path

import pytest
from compiling import compiled
from sharing import shared

C = Path(__file__).resolve().parent.parent / "generated" / "c"
ROBOTS = sorted(path.stem for path in C.glob("*.c") if path.stem != "extension")
FORWARD = [name for name in ROBOTS if f" {name}_fk(" in (C / f"{name}.h").read_text()]
"""Those with a forward map."""
# Without folding of identical functions: pose and fk may be one, and gcc would tell of it once.
FLAGS = "-std=c99 -O3 -fno-math-errno -fno-trapping-math -ffp-contract=fast -march=x86-64-v3"
FLAGS += " -fno-ipa-icf"
CPU = Path("/proc/cpuinfo")


def version_of_gcc() -> int:
    told = subprocess.run(["gcc", "--version"], capture_output=True, text=True).stdout
    number = re.search(r"^gcc.* (\d+)\.\d+\.\d+", told)
    return int(number[1]) if number else 0


def compiles() -> bool:
    """Whether there is a compiler that knows these processors."""
    return platform.machine() == "x86_64" and bool(shutil.which("gcc")) and version_of_gcc() >= 12


def runs() -> bool:
    """Whether this is such a processor."""
    return CPU.exists() and " avx2 " in CPU.read_text()


def library(
    factory: pytest.TempPathFactory, robot: str, *, single: bool = False
) -> tuple[Path, str]:
    """The library, and what the compiler tells of its loops."""

    def compile_into(folder: Path) -> None:
        define = ["-DCLOSEDFORM_FLOAT"] if single else []
        flags = [*FLAGS.split(), *define, "-fPIC", "-shared", "-fopt-info-loop-vec-optimized"]
        said = compiled(["gcc", *flags, C / f"{robot}.c", "-lm"], folder / "library.so")
        (folder / "told.txt").write_text(said, "utf-8")

    folder = shared(factory, f"{robot}_{'float' if single else 'double'}", compile_into)
    return folder / "library.so", (folder / "told.txt").read_text("utf-8")
