"""The toy of toy.c as an extension module, compiled from the sources of the runtime."""

from __future__ import annotations

import importlib.util
import os
import sys
import sysconfig
from pathlib import Path
from typing import Any

import numpy as np
from compiling import compiled

from .toy import ROWS

ROOT = Path(__file__).parents[2]
RUNTIME = ROOT / "closedform" / "runtime" / "extension"
TOY = Path(__file__).parent / "toy.c"
SANITIZERS = {
    "": [],
    "address": ["-fsanitize=address,undefined", "-fno-sanitize-recover=undefined", "-O1"],
    "thread": ["-fsanitize=thread", "-O1"],
}
SANITIZED = os.environ.get("CLOSEDFORM_TEST_SANITIZE", "")
INCLUDES = [
    f"-I{RUNTIME}",
    "-isystem",
    sysconfig.get_paths()["include"],
    "-isystem",
    np.get_include(),
]


def _target(folder: Path) -> Path:
    return folder / ("toy_native" + sysconfig.get_config_var("EXT_SUFFIX"))


def compile_toy(folder: Path, *flags: str) -> None:
    command = [os.environ.get("CC", "cc"), "-std=c99", "-O2", "-fPIC", "-shared", *flags]
    command += ["-fno-math-errno", "-fno-trapping-math", "-DCF_MODULE_NAME=toy_native"]
    command += SANITIZERS[SANITIZED]
    command += [*INCLUDES, *map(str, sorted(RUNTIME.glob("*.c"))), str(TOY), "-lm"]
    compiled(command, _target(folder))


def loaded(folder: Path) -> Any:
    spec = importlib.util.spec_from_file_location("toy_native", _target(folder))
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["toy_native"] = module
    spec.loader.exec_module(module)
    return module


def function(native: Any, name: str) -> Any:
    return native.function(f"toy.{name}", ROWS[name].results)
