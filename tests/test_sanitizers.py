"""The generated C under the address and undefined-behaviour sanitizers, in both float types."""

import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
GENERATED, RUNTIME = ROOT / "generated" / "c", ROOT / "closedform" / "extension"
SANITIZE = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]
ROBOTS = sorted(p.stem for p in GENERATED.glob("*.c") if p.stem != "extension")

SINGLE = """
import importlib, sys
from pathlib import Path
import numpy as np
from closedform.clibrary import CLibrary
d = importlib.import_module("closedform.derivations." + sys.argv[1]).d
flags = ["-fsanitize=undefined", "-fno-sanitize-recover=all", "-static-libubsan"]
library = CLibrary(d, Path(sys.argv[2]), Path(sys.argv[3]), single=True, flags=flags)
awkward = np.array([0, -0.0, 1, -1, 3.1415927, 1e-38, 1e-45, 1e20, 3e38, np.inf, np.nan, 18, 2])
rng = np.random.default_rng(0)
for f in d.functions:
    inputs = [rng.choice(awkward, (300, *a.shape)) for a in f.inputs]
    library.function(f.name)(*inputs, [float(p.value) for p in d.parameters])
print("ran", len(d.functions))
"""


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc and its sanitizers are needed")
def test_double(tmp_path: Path) -> None:
    program = tmp_path / "driver"
    sources = [ROOT / "tests" / "c" / "table_driver.c", *GENERATED.glob("*.c")]
    # With -ftree-vectorize as -O3, without its time for unrolling what nobody runs fast here.
    command = ["gcc", "-std=c99", "-O1", "-ftree-vectorize", *SANITIZE]
    command += [f"-I{GENERATED}", f"-I{RUNTIME}"]
    objects = [tmp_path / f"{source.stem}.o" for source in sources]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        commands = [
            [*command, "-c", source, "-o", o] for source, o in zip(sources, objects, strict=True)
        ]
        list(pool.map(partial(subprocess.run, check=True), commands))
    subprocess.run(["gcc", *SANITIZE, *objects, "-o", program, "-lm"], check=True)
    ran = subprocess.run([program], capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert int(ran.stdout.split()[0]) >= 17


@pytest.mark.skipif(shutil.which("gcc") is None, reason="gcc and its sanitizers are needed")
@pytest.mark.parametrize("robot", ROBOTS)
def test_float(tmp_path: Path, robot: str) -> None:
    command = [sys.executable, "-c", SINGLE, robot, str(GENERATED), str(tmp_path)]
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("ran")
