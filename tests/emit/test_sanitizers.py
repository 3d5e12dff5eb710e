"""The generated C in single precision under the undefined-behaviour sanitizer.

In double precision it runs under both sanitizers in ``test_fuzz.py``.
"""

import importlib
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from compiling import compiled
from places import ROOT

GENERATED = ROOT / "generated" / "c"
ROBOTS = sorted(p.stem for p in GENERATED.glob("*.c") if p.stem != "extension")

# What is undefined is so at every level; without optimisation no check is removed as redundant.
FLAGS = "-std=c99 -O0 -fno-math-errno -fno-trapping-math -fPIC -shared -DCLOSEDFORM_FLOAT"
FLAGS += " -fsanitize=undefined -fno-sanitize-recover=all -static-libubsan"

CALLS = """
import ctypes, json, sys
import numpy as np
library, n = ctypes.CDLL(sys.argv[1]), 300
awkward = np.array([0, -0.0, 1, -1, 3.1415927, 1e-38, 1e-45, 1e20, 3e38, np.inf, np.nan, 18, 2])
rng = np.random.default_rng(0)
functions = json.loads(sys.argv[3])
params = (ctypes.c_float * 99)(*map(float, sys.argv[2].split()))
for name, arrays in functions:
    planes = [
        rng.choice(awkward, (size, n)).astype(np.float32) if given
        else np.empty((size, n), np.float32 if real else np.uint8)
        for given, real, size in arrays
    ]
    strided = [x for a in planes for x in (ctypes.c_void_p(a.ctypes.data), ctypes.c_size_t(n))]
    library[name](ctypes.c_size_t(n), params, *strided)
print("ran", len(functions))
"""


def functions(robot: str) -> list[tuple[str, list[tuple[bool, bool, int]]]]:
    """The batch functions of a header, and of each array whether it is given, real, and its size.

    The planes of a batch are the entries of the array of the single call.
    """
    header = " ".join((GENERATED / f"{robot}.h").read_text("utf-8").split())
    found = []
    for name, arguments in re.findall(rf"void ({robot}_\w+)\(([^()]*)\);", header):
        if name.endswith("_batch"):
            continue
        arrays = re.findall(r"(const )?(real_t|uint8_t) \w+\[(\d+)\]", arguments)
        shapes = [(bool(const), kind == "real_t", int(n)) for const, kind, n in arrays]
        found.append((f"{name}_batch", shapes))
    return found


def run(*command: str | Path) -> str:
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc and its sanitizers are needed")
@pytest.mark.parametrize("robot", ROBOTS)
def test_float(tmp_path: Path, robot: str) -> None:
    library = tmp_path / "library.so"
    compiled(["gcc", *FLAGS.split(), GENERATED / f"{robot}.c", "-lm"], library)
    called = functions(robot)
    module = importlib.import_module(f"closedform.generated.numpy.{robot}")
    assert {name.removeprefix(f"{robot}_").removesuffix("_batch") for name, _ in called} <= {
        *vars(module)
    }
    dimensions = " ".join(map(str, module.Parameters()))
    told = run(sys.executable, "-c", CALLS, library, dimensions, json.dumps(called))
    assert told == f"ran {len(called)}\n" and called


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc and its sanitizers are needed")
def test_the_sanitizer_stops_a_program(tmp_path: Path) -> None:
    source, program = tmp_path / "wrong.c", tmp_path / "wrong"
    source.write_text("int main(int n, char **v) { (void)v; return (n << 31) != 0; }\n")
    flags = [flag for flag in FLAGS.split() if flag not in ("-fPIC", "-shared")]
    run("gcc", *flags, source, "-o", program)
    assert "left shift" in subprocess.run([program, "2"], capture_output=True, text=True).stderr
