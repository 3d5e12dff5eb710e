"""The generated C in single precision under the undefined-behaviour sanitizer.

In double precision it runs under both sanitizers in ``test_fuzz.py``.
"""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
GENERATED = ROOT / "generated" / "c"
ROBOTS = sorted(p.stem for p in GENERATED.glob("*.c") if p.stem != "extension")

SINGLE = """
import importlib, sys
from pathlib import Path
import numpy as np
from closedform.check.clibrary import CLibrary
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
@pytest.mark.parametrize("robot", ROBOTS)
def test_float(tmp_path: Path, robot: str) -> None:
    command = [sys.executable, "-c", SINGLE, robot, str(GENERATED), str(tmp_path)]
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.startswith("ran")
