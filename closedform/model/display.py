"""The display of records in a notebook.

A record does not know how to print itself.  :mod:`closedform.emit.notebook` registers a printer for
each kind of record here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_printers: dict[type, Callable[[Any], str]] = {}


def prints(kind: type) -> Callable[[Callable[[Any], str]], Callable[[Any], str]]:
    """Register a function that prints a record of this kind as LaTeX."""

    def register(printer: Callable[[Any], str]) -> Callable[[Any], str]:
        _printers[kind] = printer
        return printer

    return register


class Shown:
    """A record that Jupyter shows as LaTeX."""

    def _repr_latex_(self) -> str | None:
        printer = _printers.get(type(self))
        return printer(self) if printer else None
