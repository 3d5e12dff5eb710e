"""The mechanisms as compiled modules, with the names and the meaning of the NumPy modules."""

from importlib import import_module
from types import ModuleType

from closedform.lazy import attach

_mechanism, __dir__ = attach(__name__, __path__)


def __getattr__(name: str) -> ModuleType:
    if name != "_native":
        return _mechanism(name)
    try:
        return import_module(f"{__name__}._native")
    except ModuleNotFoundError as error:
        raise ImportError(
            "the functions in C are not compiled here; install closedform with a C compiler and "
            "without CLOSEDFORM_COMPILE=0, or take closedform.generated.numpy, which has the same"
        ) from error
