"""Splits a printed formula into tokens."""

from __future__ import annotations

import re
from typing import NamedTuple


class Token(NamedTuple):
    """A piece of LaTeX and its place in the text."""

    text: str
    start: int
    end: int
    closed: int = 0
    """The end with the brace that was dropped after the piece, if there is one."""

    @property
    def after(self) -> int:
        """The end of all that belongs to the piece."""
        return self.closed or self.end


SPACES = (
    r"\,", r"\;", r"\:", r"\!", r"\ ", r"\quad", r"\qquad", "~", r"\displaystyle", r"\limits",
)  # fmt: skip
"""Commands that change only the look of a formula."""
SIZES = (
    r"\left", r"\right", r"\bigl", r"\bigr", r"\Bigl", r"\Bigr", r"\big", r"\Big",
)  # fmt: skip
"""The size of the delimiter that follows."""
TOKEN = re.compile(
    r"(?P<word>\\(?:text|mathrm|begin|end)\s*\{[^{}]*\})|(?P<command>\\[A-Za-z]+|\\.)"
    r"|(?P<number>\d+(?:\.\d+)?)|(?P<space>\s+)|(?P<other>.)",
    re.DOTALL,
)


def tokens(text: str) -> list[Token]:
    r"""The tokens of a formula; spaces are dropped, and so are braces around one index.

    ``\text{...}`` and ``\begin{...}`` are two tokens each: the command and what is in its braces.
    """
    found: list[Token] = []
    sized: int | None = None
    for match in TOKEN.finditer(text):
        part, start, end = match[0], match.start(), match.end()
        if match["space"] or part in SPACES:
            continue
        if part in SIZES:
            sized = start
            continue
        start, sized = start if sized is None else sized, None
        if match["word"]:
            brace = part.index("{")
            found.append(Token(part[:brace].strip(), start, start + brace))
            found.append(Token(part[brace:], start + brace, end))
        else:
            found.append(Token(part, start, end))
    return _single(found)


def _single(found: list[Token]) -> list[Token]:
    """The tokens with ``_{1}`` written as ``_1``."""
    done: list[Token] = []
    k = 0
    while k < len(found):
        done.append(found[k])
        if (
            found[k].text in ("_", "^")
            and k + 3 < len(found)
            and found[k + 1].text == "{"
            and found[k + 3].text == "}"
        ):
            done.append(found[k + 2]._replace(closed=found[k + 3].end))
            k += 3
        k += 1
    return done
