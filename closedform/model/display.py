"""The display of records in a notebook.

A record does not know how to print itself.  :mod:`closedform.emit.notebook` registers a printer for
each kind of record here.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

_printers: dict[tuple[type, str], Callable[[Any], str]] = {}


def prints(
    kind: type, form: str = "latex"
) -> Callable[[Callable[[Any], str]], Callable[[Any], str]]:
    """Register a function that prints a record of this kind as ``latex`` or as ``markdown``."""

    def register(printer: Callable[[Any], str]) -> Callable[[Any], str]:
        _printers[kind, form] = printer
        return printer

    return register


class Shown:
    """A record that Jupyter shows as a formula or as text with formulas."""

    def _repr_latex_(self) -> str | None:
        return self._printed("latex")

    def _repr_markdown_(self) -> str | None:
        return self._printed("markdown")

    def _printed(self, form: str) -> str | None:
        printer = _printers.get((type(self), form))
        return printer(self) if printer else None
