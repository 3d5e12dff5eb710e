"""The back ends, one a language: a module or a package of this folder, found by its name.

Its ``BACKEND`` is a :class:`closedform.emit.backend.Backend`.  Listing the names imports none.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from closedform.lazy import submodules

if TYPE_CHECKING:
    from closedform.emit.backend import Backend


def names() -> tuple[str, ...]:
    """The names of all back ends."""
    return tuple(sorted(submodules(__path__)))


def load(name: str) -> Backend:
    """The back end of this name, or of this module, if it is somewhere else."""
    backend: Backend = import_module(name if "." in name else f"{__name__}.{name}").BACKEND
    return backend
