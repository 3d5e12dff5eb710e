"""C, compiled on the spot in both float types."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from closedform.check.clibrary import CLibrary, compiler
from closedform.check.finding import Backend, float_backend
from closedform.model.derivation import Derivation
from closedform.model.tolerances import DOUBLE


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    compiler()
    with ThreadPoolExecutor() as pool:  # the compiler works in processes of its own
        double, single = pool.map(
            lambda single: CLibrary(derivation, folder, scratch, single=single), (False, True)
        )
    yield Backend(name, double.function, double.dtype, DOUBLE)
    yield float_backend(single.function)
