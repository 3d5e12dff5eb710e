"""Mechanisms that tests derive from a file of bodies and joints, or from a script."""

import importlib
import re
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from closedform import Derivation
from closedform.cli.commands import main
from closedform.scaffold.loops.file import read_loop
from closedform.scaffold.loops.script import loop_script


def script_of(name: str, text: str, folder: Path) -> str:
    """The script that is written from a file with this text."""
    path = folder / f"{name}.toml"
    path.write_text(text, "utf-8")
    return loop_script(name, read_loop(path), path.name)[0]


def unbroken(script: str) -> str:
    """A script whose calls are each on one line."""
    return re.sub(r",?\s+(?=[)\]])|(?<=[(\[])\s+", "", re.sub(r"\n +", " ", script))


def read_script(script: str) -> Derivation:
    """The derivation of a script."""
    space: dict = {}
    exec(compile(script, "script.py", "exec"), space)
    return space["d"]


def derived(name: str, script: str, folder: Path, *, crosscheck: bool = False) -> ModuleType:
    """The NumPy module that is printed from a script."""
    path, out = folder / f"{name}.py", folder / f"{name}_out"
    path.write_text(script, "utf-8")
    derive = ["derive", str(path), "-o", str(out), "--backend", "numpy"]
    assert main([*derive, *["--no-crosscheck"] * (not crosscheck)]) == 0
    for known in [m for m in sys.modules if m.split(".")[0] == out.name]:
        del sys.modules[known]  # another test may have derived a mechanism of this name
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        return importlib.import_module(f"{name}_out.numpy.{name}")


def newton(f: Callable[[np.ndarray], np.ndarray], x: np.ndarray) -> np.ndarray | None:
    """A zero of ``f`` that is found from a start, if any is."""
    for _ in range(30):
        here = f(x)
        if np.abs(here).max() < 1e-13:
            return x
        steps = 1e-7 * np.eye(len(x))
        rates = np.array([(f(x + s) - f(x - s)) / 2e-7 for s in steps]).T
        step = np.linalg.lstsq(rates, here)[0]
        x = x - step / max(1.0, np.abs(step).max())
    return None


def apart(a: np.ndarray, b: np.ndarray, turns: Sequence[bool] | np.ndarray) -> np.ndarray:
    """The largest difference of each row of ``a`` from ``b``; what turns, up to whole turns."""
    return np.abs(np.where(turns, np.angle(np.exp(1j * (a - b))), a - b)).max(axis=-1)
