"""Things that take long to make are made once for all processes that run the tests."""

import os
import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import compiling
import pytest

from closedform.pipeline.disk import locked


def shared(
    factory: pytest.TempPathFactory, name: str, make: Callable[[Path], object] = lambda _: None
) -> Path:
    """A folder for this run of pytest, filled by the first process that asks for it."""
    base = factory.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        base = base.parent
    folder = base / name
    with locked(base / f"{name}.lock"):
        if not (base / f"{name}.made").exists():
            folder.mkdir()
            make(folder)
            (base / f"{name}.made").touch()
    return folder


def quick_compiler(folder: Path) -> str:
    """The C compiler as a program that does not optimise, for code whose speed is not looked at."""
    from closedform.check.clibrary import CALLED, compiler  # with SymPy, which few processes need

    return remembering(folder / "cc-quick", f'{compiler()} "$@" -O0 {CALLED}')


def compile_quickly(patch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let whatever is cross-checked be compiled by :func:`quick_compiler`, where there is one."""
    if os.name == "posix" and shutil.which("cc"):
        patch.setenv("CC", quick_compiler(folder))


def remembering(program: Path, command: str = '"$@"') -> str:
    """A program that runs a compiler which remembers what it compiled."""
    script = f'#!/bin/sh\nexec "{sys.executable}" "{compiling.__file__}" {command}\n'
    program.write_text(script, "utf-8")
    program.chmod(0o755)
    return str(program)
