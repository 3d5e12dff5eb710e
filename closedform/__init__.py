"""closedform: published mechanisms as proved, fast, closed-form kinematics.

The NumPy module of a mechanism is an attribute, ``closedform.puma560``; the same module is
``closedform.generated.numpy.puma560``, and ``closedform.generated.c.puma560`` is the compiled one.
"""

from types import ModuleType as _ModuleType

__version__ = "0.1.0"


def __getattr__(name: str) -> _ModuleType:
    from importlib import import_module

    if name == "generated":
        return import_module("closedform.generated")
    if name in _mechanisms():
        return import_module(f"closedform.generated.numpy.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), "generated", *_mechanisms()})


def _mechanisms() -> set[str]:
    """The printed mechanisms, but for those that have the name of a module of the toolkit."""
    from importlib import import_module

    from closedform.lazy import submodules

    printed = import_module("closedform.generated.numpy")
    return submodules(printed.__path__) - submodules(__path__)
