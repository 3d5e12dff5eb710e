"""Mechanisms that tests derive from a file of bodies and joints, or from a script."""

import importlib
from pathlib import Path
from types import ModuleType

import pytest

from closedform import Derivation
from closedform.cli.commands import main
from closedform.scaffold.loop_script import loop_script
from closedform.scaffold.loops import read_loop


def script_of(name: str, text: str, folder: Path) -> str:
    """The script that is written from a file with this text."""
    path = folder / f"{name}.toml"
    path.write_text(text, "utf-8")
    return loop_script(name, read_loop(path), path.name)


def read_script(script: str) -> Derivation:
    """The derivation of a script."""
    space: dict = {}
    exec(compile(script, "script.py", "exec"), space)
    return space["d"]


def derived(name: str, script: str, folder: Path) -> ModuleType:
    """The NumPy module that is printed from a script."""
    path, out = folder / f"{name}.py", folder / f"{name}_out"
    path.write_text(script, "utf-8")
    derive = ["derive", str(path), "-o", str(out), "--backend", "numpy", "--no-crosscheck"]
    assert main(derive) == 0
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(folder)
        return importlib.import_module(f"{name}_out.numpy.{name}")
