"""The lines of an algorithm on a page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

UNBROKEN = 4
"""An algorithm with more lines than this may begin at the end of a page."""


@dataclass(frozen=True)
class Line:
    """A line of the algorithm, how deep it stands, and a remark."""

    text: str
    depth: int = 0
    remark: str = ""
    kind: str = ""


def lines_kept(lines: Sequence[Line]) -> int:
    """How many lines of a page an algorithm needs, so that only a long one is broken."""
    return 2 * min(len(lines), UNBROKEN) + 3


def unless(condition: str, status: str) -> str:
    return rf"\textbf{{unless}} {condition}: {status}"


def merged(lines: Sequence[tuple[str, Any, str]]) -> list[tuple[str, Any, str]]:
    """Neighbouring bounds together, behind the names that are made between them."""
    done: list[tuple[str, Any, str]] = []
    waiting: list[tuple[str, Any, str]] = []
    last = max((k for k, line in enumerate(lines) if line[0] == "bound"), default=-1)
    for k, line in enumerate(lines):
        if line[0] == "bound":
            waiting.append(line)
            bounded = any(other[0] == "bound" for other in lines[k + 1 : k + 3])
            if k == last or not bounded:
                done += waiting
                waiting = []
        else:
            done.append(line)
    return done


def whole(equations: Sequence[tuple[str, str]]) -> list[str]:
    """Equations as formulas in the text; what was broken into lines is one formula again."""
    texts: list[str] = []
    for left, right in equations:
        if left:
            texts.append(f"{left} = {right}")
        else:
            texts[-1] += f" {right}"
    return [rf"$\displaystyle {t}$" for t in texts]


def parts_first(names: Sequence[str], texts: Sequence[str]) -> list[str]:
    """Equations in an order in which each of the names is defined before it is used.

    A matrix stands last.
    """
    parts = {n: t for n in names for t in texts if t.startswith(rf"$\displaystyle {n} =")}
    done = list[str]()

    def add(name: str) -> None:
        text = parts.pop(name)
        for other in list(parts):
            if other in parts and other in text:
                add(other)
        done.append(text)

    for name in reversed(list(parts)):
        if name in parts:
            add(name)
    rest = (t for t in texts if t not in done)
    return [*done, *sorted(rest, key=lambda t: r"\begin{bmatrix}" in t)]


__all__ = ["Line", "lines_kept", "merged", "parts_first", "unless", "whole"]
