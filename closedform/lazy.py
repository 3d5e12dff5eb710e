"""Modules and names that are imported on first use."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from types import ModuleType


def submodules(path: Iterable[str]) -> set[str]:
    """The public modules and packages in the folders of a package."""
    return {module.name for module in iter_modules(path) if not module.name.startswith("_")}


def attach(
    package: str, path: Iterable[str]
) -> tuple[Callable[[str], ModuleType], Callable[[], list[str]]]:
    """The ``__getattr__`` and the ``__dir__`` of a package."""

    def getattribute(name: str) -> ModuleType:
        if name in submodules(path):
            return import_module(f"{package}.{name}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    return getattribute, lambda: sorted(submodules(path))


def homes(path: Iterable[str]) -> dict[str, str]:
    """The names that the stub of a package re-exports, each with the module that defines it."""
    return _homes(Path(next(iter(path))) / "__init__.pyi")


@cache
def _homes(stub: Path) -> dict[str, str]:
    import ast  # not needed to import a mechanism from closedform.generated

    return {
        alias.name: statement.module
        for statement in ast.parse(stub.read_bytes()).body
        if isinstance(statement, ast.ImportFrom) and statement.module
        for alias in statement.names
        if not alias.name.startswith("_") and statement.module.startswith("closedform.")
    }
