"""Packages whose modules are imported when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
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
