"""closedform: proved closed-form kinematics of published mechanisms.

The NumPy module of a mechanism is an attribute, ``closedform.puma560``; the same module is
``closedform.generated.numpy.puma560``, and ``closedform.generated.c.puma560`` is the compiled one.

What a derivation is written with is here too: ``from closedform import Chain, Derivation``.  These
names are listed in ``__init__.pyi`` and loaded when they are asked for, because they need
SymPy; the mechanisms need NumPy only.
"""

from types import ModuleType as _ModuleType
from typing import Any as _Any

from closedform._version import __version__ as __version__


def __getattr__(name: str) -> _Any:
    import sys
    from importlib import import_module

    if name == "generated":
        return import_module("closedform.generated")
    if home := _authors_names().get(name):
        if "IPython" in sys.modules:
            import_module("closedform.emit.notebook")
        return getattr(import_module(home), name)
    if name in _mechanisms():
        return import_module(f"closedform.generated.numpy.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), "generated", *_mechanisms(), *_authors_names()})


def _mechanisms() -> set[str]:
    """The printed mechanisms, except those that share a name with the toolkit."""
    from importlib import import_module

    from closedform.lazy import submodules

    printed: _ModuleType = import_module("closedform.generated.numpy")
    return submodules(printed.__path__) - submodules(__path__) - _authors_names().keys()


def _authors_names() -> dict[str, str]:
    """The names that a derivation imports, each with its module."""
    from closedform.lazy import homes

    return homes(__path__)
