"""Pieces of Python code that several back ends print."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable

from closedform.emit.code import Printer
from closedform.emit.sizes import arguments
from closedform.lower import Lowered


def tuple_code(items: Iterable[str]) -> str:
    """A tuple, on one line."""
    listed = list(items)
    return f"({listed[0]},)" if len(listed) == 1 else f"({', '.join(listed)})"


def argument_list(names: Iterable[str], function: str, width: int) -> str:
    """The arguments in the definition of a function, on lines of their own if they are too long."""
    listed = ", ".join(names)
    if len(f"def {function}():") + len(listed) <= width:
        return listed
    return "\n" + textwrap.indent(textwrap.fill(listed, width - 4), "    ") + "\n"


def kernel_arguments(printer: Printer, program: Lowered) -> list[str]:
    """The names of the arguments of a kernel; unused ones begin with an underscore."""
    used = program.used_inputs()
    return [printer.inputs[e] if e in used else f"_{e}" for e in arguments(program)]
