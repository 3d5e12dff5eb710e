"""The generated C as it is shipped, for processors with AVX2: a library a robot and float type.

In double precision it is linked from what ``make`` compiled for this processor, if that is there.
"""

import platform
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

import pytest
from compiling import compiled
from sharing import shared

ROOT = Path(__file__).resolve().parent.parent
C = ROOT / "generated" / "c"
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


def shipped(robot: str) -> tuple[Path, str] | None:
    """The object of the compiled module, and what gcc told of its loops, unless it is outdated."""
    version = "".join(sysconfig.get_python_version().split("."))
    build = ROOT / "build" / f"temp.{sysconfig.get_platform()}-cpython-{version}"
    made, told = build / "generated" / "c" / f"{robot}.o", build / f"{robot}.loops"
    sources = [ROOT / "setup.py", C / "closedform.h", C / f"{robot}.h", C / f"{robot}.c"]
    if not (made.exists() and told.exists()):
        return None
    if made.stat().st_mtime_ns < max(path.stat().st_mtime_ns for path in sources):
        return None
    return made, told.read_text("utf-8")


def library(
    factory: pytest.TempPathFactory, robot: str, *, single: bool = False
) -> tuple[Path, str]:
    """The library, and what the compiler tells of its loops."""

    def compile_into(folder: Path) -> None:
        if not single and (there := shipped(robot)):
            link = ["gcc", "-shared", there[0], "-lm", "-o", folder / "library.so"]
            subprocess.run(link, check=True)
            (folder / "told.txt").write_text(there[1], "utf-8")
            return
        define = ["-DCLOSEDFORM_FLOAT"] if single else []
        flags = [*FLAGS.split(), *define, "-fPIC", "-shared", "-fopt-info-loop-vec-optimized"]
        said = compiled(["gcc", *flags, C / f"{robot}.c", "-lm"], folder / "library.so")
        (folder / "told.txt").write_text(said, "utf-8")

    folder = shared(factory, f"{robot}_{'float' if single else 'double'}", compile_into)
    return folder / "library.so", (folder / "told.txt").read_text("utf-8")
