"""Exact expressions as lines of Python, for the scripts that ``closedform new`` writes."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence
from itertools import pairwise
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
START = re.compile(r"(return |[A-Za-z_][\w, ]* = |\w+=)?(lambda[\w, ]*: |[-+]?\w+: )?")
"""What may come before an expression."""
SIGNS = (" + ", " - "), (" * ", "*", "/")
"""Where a sum is broken, and where a product is."""
COMPREHENSION = " for "


def fitted(line: str, *, inside: bool = False) -> list[str]:
    """A line of a script in several lines if it is too long; it may stand ``inside`` brackets.

    A sum or a product is broken before its signs, in brackets, and a text at its blanks.  Otherwise
    the longest brackets are broken: what is in them is put on one line if it fits, and else each
    argument on its own.
    """
    if len(line) <= LINE:
        return [line]
    indent, text = line[: len(line) - len(line.lstrip())], line.strip()
    if text.startswith("#"):
        return [f"{indent}# {part}" for part in _words(text[2:], LINE - len(indent) - 2)]
    hidden = TEXT.sub(lambda found: "_" * len(found[0]), text)
    start, end = START.match(hidden).end(), len(text.rstrip(","))  # type: ignore[union-attr]
    if parts := _broken(text, hidden, start, end) if start or inside else []:
        if start:
            return _in_brackets(indent, f"{text[:start]}(", parts, f"){text[end:]}")
        parts[-1] += text[end:]
        return [row for part in parts for row in fitted(f"{indent}{part}", inside=True)]
    groups = _groups(hidden, start)
    if not groups:
        return [line]
    first, last = max(groups, key=lambda group: group[1] - group[0])
    commas = _at_top(hidden, first + 1, last, (",",))
    breaks = [first, *(k for k, _ in commas), last]
    alone = not commas and text[first] == "(" and not text[first - 1 : first].isidentifier()
    alone = alone or bool(_at_top(hidden, first + 1, last, (COMPREHENSION,)))
    comma = "" if alone else ","
    arguments = [f"{e}{comma}" for a, b in pairwise(breaks) if (e := text[a + 1 : b].strip())]
    whole = not commas or len(arguments) > 1
    return _in_brackets(indent, text[: first + 1], arguments, text[last:], whole=whole)


def _words(text: str, width: int) -> list[str]:
    """A text in parts; a blank between two of them is left out, and nothing else."""
    parts = list[str]()
    for word in text.split(" "):
        if parts and len(parts[-1]) + 1 + len(word) <= width:
            parts[-1] += f" {word}"
        else:
            parts.append(word)
    return parts


def _broken(text: str, hidden: str, start: int, end: int) -> list[str]:
    """The terms of a sum or the factors of a product with their signs, or the parts of a text.

    So are several values; of anything else there are none.
    """
    if _at_top(hidden, start, end, (COMPREHENSION,)):
        return []
    if TEXT.fullmatch(text, start, end):
        *parts, last = _words(words := text[start + 1 : end - 1].rstrip(" "), LINE // 2 + 20)
        last += text[start + 1 + len(words) : end - 1]
        rows = (*(f"{part} " for part in parts), last) if parts else ()  # one word stays whole
        return [f"{text[start]}{row}{text[start]}" for row in rows]
    if values := _at_top(hidden, start, end, (",",)):
        breaks = [start - 1, *(k for k, _ in values), end]
        return [f"{text[a + 1 : b].strip()}," for a, b in pairwise(breaks) if text[a + 1 : b]]
    for signs in SIGNS:
        found = _at_top(hidden, start, end, signs)
        if inside := [k for k, _ in found if text[start:k].strip()]:
            breaks = [start, *inside, end]
            return [text[a:b].strip() for a, b in pairwise(breaks)]
    return []


def _in_brackets(
    indent: str, before: str, parts: Sequence[str], after: str, *, whole: bool = False
) -> list[str]:
    """Parts between brackets: on one line if ``whole`` and they fit, or each on its own."""
    one = f"{indent}    {' '.join(parts).removesuffix(',')}"
    if whole and len(one) <= LINE:
        return [f"{indent}{before}", one, *fitted(f"{indent}{after}")]
    rows = [row for part in parts for row in fitted(f"{indent}    {part}", inside=True)]
    return [f"{indent}{before}", *rows, *fitted(f"{indent}{after}")]


def _groups(hidden: str, start: int) -> list[tuple[int, int]]:
    """Where the outermost brackets of a text open and close."""
    found, depth, first = [], 0, 0
    for k, e in enumerate(hidden):
        if e in OPENING:
            first = first if depth else k
            depth += 1
        elif e in CLOSING:
            depth -= 1
            if depth == 0 and first >= start and k > first + 1:
                found.append((first, k))
    return found


def _at_top(hidden: str, start: int, end: int, marks: Sequence[str]) -> list[tuple[int, str]]:
    """The marks of a text that are in no brackets, and where they are."""
    found, depth, k = [], 0, start
    while k < end:
        depth += (hidden[k] in OPENING) - (hidden[k] in CLOSING)
        mark = next((m for m in marks if hidden.startswith(m, k)), "") if depth == 0 else ""
        if mark and not hidden.startswith("**", k) and hidden[k - 1 : k + 1] != "**":
            found.append((k, mark))
            k += len(mark) - 1
        k += 1
    return found


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


def wrapped_literal(text: str) -> list[str]:
    """A text as an argument in several lines, each a literal."""
    rows = textwrap.wrap(text, 88, drop_whitespace=False)
    return [f"    {literal(row)}{',' * (row is rows[-1])}" for row in rows]


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
