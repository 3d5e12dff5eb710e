"""The lemmas, found by looking through the modules of this folder.

A lemma that a chain can use registers itself with the decorator :func:`chain_lemma`; ``closedform
new`` and the guide read the list.  The statement and the proof of a lemma are registered by
:func:`theorem`; the book reads that list.  ``docs/adding-a-lemma.md`` says how to write one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules
from typing import Any, TypeVar

from closedform.model.lemma import Theorem

_Function = TypeVar("_Function", bound=Callable[..., Any])


@dataclass(frozen=True)
class ChainLemma:
    """A lemma for :meth:`closedform.lemmas.chain.Chain.solve`."""

    name: str
    equation: str
    """The equation that it solves, as the guide prints it: ``a sin x + b cos x = c``."""
    result: str
    """The result of ``solve``: ``the pair of x``."""
    apply: Callable[..., Any]


_registered: dict[str, ChainLemma] = {}


def chain_lemma(equation: str, result: str) -> Callable[[_Function], _Function]:
    """Register a function as a lemma, under its own name."""

    def register(function: _Function) -> _Function:
        name = function.__name__
        _registered[name] = ChainLemma(name, equation, result, function)
        return function

    return register


_theorems: dict[str, Theorem] = {}


def theorem(
    name: str,
    *,
    statement: str,
    proof: str,
    exception: str = "",
    rests_on: Sequence[str] = (),
    title: str = "",
) -> Theorem:
    """Register the statement of the lemma of this name, and its proof.

    Parameters
    ----------
    name
        that of the lemma
    statement, proof, exception, rests_on, title
        the fields of :class:`Theorem`
    """
    found = Theorem(name, statement, proof, exception, tuple(rests_on), title)
    _theorems[name] = found
    return found


def chain_lemmas() -> dict[str, ChainLemma]:
    """Every lemma of this folder, by name."""
    _look_through_the_folder()
    return dict(sorted(_registered.items()))


def theorems() -> dict[str, Theorem]:
    """The statement of every lemma, by name; a lemma comes after those that its proof uses."""
    _look_through_the_folder()
    ordered: dict[str, Theorem] = {}

    def add(name: str) -> None:
        for other in _theorems[name].rests_on:
            if other not in ordered:
                add(other)
        ordered[name] = _theorems[name]

    for name in sorted(_theorems, key=lambda n: (len(_theorems[n].rests_on) > 0, n)):
        add(name)
    return ordered


def _look_through_the_folder() -> None:
    package = __name__.rpartition(".")[0]
    for module in iter_modules([str(Path(__file__).parent)]):
        import_module(f"{package}.{module.name}")
