"""C, compiled on the spot in both float types."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from closedform.check.clibrary import CLibrary, compiler
from closedform.check.crosscheck import Backend, float_backend
from closedform.model.derivation import Derivation
from closedform.model.tolerances import DOUBLE


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    compiler()
    double = CLibrary(derivation, folder, scratch)
    yield Backend(name, double.function, double.dtype, DOUBLE)
    yield float_backend(CLibrary(derivation, folder, scratch, single=True).function)
