"""Python modules: imported from the folder they were printed to."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType

from closedform.check.finding import Backend, module_backend
from closedform.model.derivation import Derivation

_PACKAGE = "_closedform_printed"


def run(name: str, derivation: Derivation, folder: Path, scratch: Path) -> Iterator[Backend]:
    yield module_backend(name, module(folder, derivation.name))


def module(folder: Path, robot: str) -> ModuleType:
    """The module that was just printed, even if another one has the same name."""
    for loaded in [m for m in sys.modules if m.partition(".")[0] == _PACKAGE]:
        del sys.modules[loaded]
    package = ModuleType(_PACKAGE)
    package.__path__ = [str(folder.resolve())]
    sys.modules[_PACKAGE] = package
    importlib.invalidate_caches()
    return importlib.import_module(f"{_PACKAGE}.{robot}")
