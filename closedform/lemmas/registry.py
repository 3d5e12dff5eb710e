"""The lemmas that a chain applies, found by looking through the modules of this folder.

A lemma registers itself with the decorator :func:`chain_lemma`.  ``closedform new`` and the guide
read the list; ``docs/adding-a-lemma.md`` says how to write one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class ChainLemma:
    """A lemma for :meth:`closedform.lemmas.chain.Chain.solve`."""

    name: str
    equation: str
    """What it solves, as the guide prints it: ``a sin x + b cos x = c``."""
    result: str
    """What ``solve`` returns: ``the pair of x``."""
    apply: Callable[..., Any]


_registered: dict[str, ChainLemma] = {}


def chain_lemma(equation: str, result: str) -> Callable[[_Function], _Function]:
    """Register a function as a lemma, under its own name."""

    def register(function: _Function) -> _Function:
        name = function.__name__
        _registered[name] = ChainLemma(name, equation, result, function)
        return function

    return register


def chain_lemmas() -> dict[str, ChainLemma]:
    """Every lemma of this folder, by name."""
    package = __name__.rpartition(".")[0]
    for module in iter_modules([str(Path(__file__).parent)]):
        import_module(f"{package}.{module.name}")
    return dict(sorted(_registered.items()))
