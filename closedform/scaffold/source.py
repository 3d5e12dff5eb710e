"""Exact expressions as lines of Python, for the scripts that ``closedform new`` writes."""

from __future__ import annotations

import re
from typing import Any

import sympy as sp
from sympy.printing.str import StrPrinter

NAME = re.compile(r"[A-Za-z_]\w*(\[\d(, \d)?\]|\.[cs]|\.ahead)?", re.ASCII)
"""The name of a symbol, an entry of a vector, or a part of what a lemma returns."""


GIVEN = sp.Symbol("given", real=True)
"""The angle of a joint that is an input of the inverse; in the lines its pair is ``given``."""


VARIABLES = {"d": "d_"}
"""The variables of parameters whose names the script uses itself: d is the derivation."""


LINE = 100
"""How long a line of a script may be."""

OPENING, CLOSING = "([{", ")]}"
TEXT = re.compile(r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)*\'')


def fitted(line: str) -> list[str]:
    """A line of a script, in several lines if it is too long: its outermost brackets are broken.

    What is in them is put on one line if it fits, and otherwise each argument on its own.
    """
    hidden = TEXT.sub(lambda text: "_" * len(text[0]), line)
    start = next((k for k, e in enumerate(hidden) if e in OPENING), -1)
    if len(line) <= LINE or start < 0:
        return [line]
    depth, breaks, end = 0, [start], len(line)
    for k, e in enumerate(hidden[start:], start):
        depth += (e in OPENING) - (e in CLOSING)
        if depth == 0:
            end = k
            break
        if depth == 1 and e == ",":
            breaks.append(k)
    indent = " " * (len(line) - len(line.lstrip()) + 4)
    inside = f"{indent}{line[start + 1 : end]}"
    if len(inside) <= LINE:
        return [line[: start + 1], inside, f"{indent[4:]}{line[end:]}"]
    parts = [line[a + 1 : b].strip() for a, b in zip(breaks, [*breaks[1:], end], strict=True)]
    rows = [row for part in parts if part for row in fitted(f"{indent}{part},")]
    return [line[: start + 1], *rows, f"{indent[4:]}{line[end:]}"]


class _Source(StrPrinter):  # type: ignore[misc]
    """Expressions as Python; a fraction of integers stays exact."""

    def _print_sin(self, expr: Any) -> str:
        return "given.s" if expr.args[0] == GIVEN else f"sin({self._print(expr.args[0])})"

    def _print_cos(self, expr: Any) -> str:
        return "given.c" if expr.args[0] == GIVEN else f"cos({self._print(expr.args[0])})"

    def _print_tan(self, expr: Any) -> str:
        """The printed code has no tangents."""
        return f"(sin({self._print(expr.args[0])})/cos({self._print(expr.args[0])}))"

    def _print_Symbol(self, expr: Any) -> str:
        if not NAME.fullmatch(expr.name):
            raise ValueError(f"{expr.name!r} is not a name in Python")
        return variable(str(expr.name))

    def _print_Rational(self, expr: Any) -> str:
        return f"Rational({expr.p}, {expr.q})"

    def _print_MatrixBase(self, expr: Any) -> str:
        rows = [[self._print(e) for e in expr.row(i)] for i in range(expr.rows)]
        return "Matrix([" + ", ".join(f"[{', '.join(row)}]" for row in rows) + "])"


def literal(text: str) -> str:
    """A text as a Python literal, in double quotes if it contains none."""
    return repr(text) if '"' in text else f'"{repr(chr(39) + text)[2:]}'


def variable(name: str) -> str:
    """The variable of the script that holds the symbol of this name."""
    return VARIABLES.get(name, name)


def file_name(name: str) -> str:
    """The name of a file as it may stand in a text of the script."""
    return re.sub(r"[^\w .()-]", "_", name)


def source(e: Any) -> str:
    """An exact expression or a matrix as Python code, with the names of ``sympy``."""
    exact = sp.sympify(e, strict=True)
    if exact.has(GIVEN):
        exact = sp.expand_trig(exact)
    text: str = _Source().doprint(exact)
    return text
