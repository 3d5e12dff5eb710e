"""The text of the articles as Markdown: the commands that they use, and no others.

The articles are prepared as LaTeX by :mod:`closedform.emit.backends.latex`.  The site and notebooks
show the same sentences, so their few commands are translated here.  One that is not known is an
error: no backslash reaches a page.
"""

from __future__ import annotations

import html
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from closedform.emit.backends.latex.sheet import Block
from closedform.emit.escape import MARKUP

ACCENTS = {"``": "“", "''": "”", "---": "—", "--": "–", "~": "\N{NO-BREAK SPACE}", "`": "‘"}
CHARACTERS = {
    r"\dots": "…",
    r"\ldots": "…",
    r"\textasciicircum": "^",
    r"\textbackslash": "\\",
    r"\textasciitilde": "~",
    r"\quad": "\N{EM SPACE}",
    r"\qquad": "\N{EM SPACE}\N{EM SPACE}",
    r"\ ": " ",
    r"\,": "\N{THIN SPACE}",
    r"\\": " ",
}
TOKEN = re.compile(r"\\[A-Za-z]+\*?|\\.|``|''|---?|[~`${}]|[^\\~`$'{}-]+|.", re.DOTALL)
SECTION = re.compile(r"Sections?~(?=\\ref)")


class MarkupError(ValueError):
    """A command that is not known."""


@dataclass(frozen=True)
class Place:
    """The target of a label: the page, the anchor on it, and how a sentence refers to it."""

    address: str
    title: str


class Markdown:
    """Translates sentences and displays of one page.

    ``places`` are those that it may refer to, and ``works`` the keys of those that it lists.
    """

    def __init__(self, places: Mapping[str, Place], works: Sequence[str] = ()):
        self.places = places
        self.works = tuple(works)
        self.commands: Mapping[str, Callable[[str], str]] = {
            r"\texttt": lambda t: f"`{plain(t)}`",
            r"\emph": lambda t: f"*{self(t)}*",
            r"\textit": lambda t: f"*{self(t)}*",
            r"\textbf": lambda t: f"**{self(t)}**",
            r"\textsc": lambda t: self.status(plain(t).upper()),
            r"\mbox": self,
            r"\fit": self,
            r"\eqref": self.equation,
            r"\ref": self.section,
            r"\ref*": lambda t: self.place(t).title,
            r"\cite": self.cited,
        }

    def __call__(self, text: str) -> str:
        """A sentence, or several."""
        text = SECTION.sub("", text.strip())
        done: list[str] = []
        at = 0
        while at < len(text):
            piece, at = self._piece(text, at)
            done.append(piece)
        return "".join(done)

    def _piece(self, text: str, start: int) -> tuple[str, int]:
        """The translation of the token that starts here with its arguments, and where they end."""
        token = TOKEN.match(text, start)
        assert token is not None
        part, at = token[0], token.end()
        if part == "$":
            end = closing_dollar(text, at)
            return self.inline(text[at:end]), end + 1
        if part == r"\[":
            end = text.index(r"\]", at)
            return displayed(text[at:end]), end + 2
        if part == r"\newline":
            return "<br>", at
        if part in self.commands:
            inner, at = argument(text, at)
            return self.commands[part](inner), at
        if part == r"\hyperref":
            label, at = argument(text, at, ("[", "]"))
            inner, at = argument(text, at)
            return self.link(label, self(inner)), at
        if part == r"\texorpdfstring":
            inner, at = argument(text, at)
            _, at = argument(text, at)
            return self(inner), at
        return _plain_token(part, text), at

    def inline(self, formula: str) -> str:
        """A formula in a sentence."""
        return inline(formula)

    def status(self, name: str) -> str:
        """The name of a status."""
        return f'<span class="status">{html.escape(name)}</span>'

    def place(self, label: str) -> Place:
        if label not in self.places:
            raise MarkupError(f"nothing has the label {label!r}")
        return self.places[label]

    def link(self, label: str, text: str) -> str:
        return f'<a class="reference internal" href="{self.place(label).address}">{text}</a>'

    def equation(self, label: str) -> str:
        return f'<a class="reference internal" href="#{anchor(label)}">({number(label)})</a>'

    def section(self, label: str) -> str:
        return self.link(label, self.place(label).title)

    def cited(self, keys: str) -> str:
        """Links to the works at the end of the page."""
        cited = sorted((self.works.index(k) + 1, k) for k in keys.split(","))
        links = (f'<a class="cited" href="#work-{k}">{n}</a>' for n, k in cited)
        return f"[{', '.join(links)}]"

    def display(self, block: Block) -> str:
        """Numbered equations below each other."""
        if block.wide:
            [row] = block.rows
            return displayed(row.text, row.label)
        return fenced(
            "display",
            block.aligned(lambda label: rf"\tag{{{number(label)}}}\label{{{anchor(label)}}}"),
        )


def number(label: str) -> str:
    """The number of an equation, which is the last part of its label."""
    return label.rpartition(":")[2]


def anchor(label: str) -> str:
    """The mark on the page that a label becomes."""
    return label.replace(":", "-")


def fenced(directive: str, body: str, options: str = "") -> str:
    return f"\n\n```{{{directive}}}\n{options}{body.strip()}\n```\n\n"


def inline(formula: str) -> str:
    """A formula in a sentence."""
    return f"{{math}}`{' '.join(tidy(formula).split())}`"


def displayed(formula: str, label: str = "") -> str:
    """A formula on lines of its own, broken where it is too long."""
    options = f":number: {number(label)}\n:name: {anchor(label)}\n" if label else ""
    return fenced("paragraph", tidy(formula), options)


def tidy(formula: str) -> str:
    return formula.strip().replace("`", "'")


def _plain_token(token: str, text: str) -> str:
    """A token without arguments: a character, an accent, or plain text; braces vanish."""
    if token in CHARACTERS:
        return escaped(CHARACTERS[token])
    if token in ACCENTS:
        return ACCENTS[token]
    if token.startswith("\\") and len(token) == 2 and not token[1].isalpha():
        return escaped(token[1])
    if token.startswith("\\"):
        raise MarkupError(f"there is no Markdown for the command {token} in {text!r}")
    return "" if token in "{}" else escaped(token)


def escaped(text: str) -> str:
    """Plain text, so that no character of it means anything in Markdown."""
    return MARKUP.sub(r"\\\1", text)


def plain(text: str) -> str:
    """Text between backquotes: without the escapes of LaTeX."""
    return re.sub(r"\\([^A-Za-z])", r"\1", text).replace(r"\textbackslash{}", "\\")


def argument(text: str, at: int, braces: Sequence[str] = ("{", "}")) -> tuple[str, int]:
    """The argument of a command that starts here, and where it ends."""
    opening, closing = braces
    at += len(text[at:]) - len(text[at:].lstrip())
    if text[at : at + 1] != opening:
        raise MarkupError(f"{opening} is expected at {text[at : at + 20]!r}")
    depth = 0
    for mark in re.finditer(r"\\.|[\[\]{}]", text[at:]):
        depth += (mark[0] == opening) - (mark[0] == closing)
        if depth == 0:
            return text[at + 1 : at + mark.start()], at + mark.end()
    raise MarkupError(f"{closing} is missing in {text[at:]!r}")


def closing_dollar(text: str, at: int) -> int:
    """Where the formula ends that starts here; text inside it may hold formulas of its own."""
    depth = 0
    for k in range(at, len(text)):
        if text[k] in "{}" and text[k - 1] != "\\":
            depth += 1 if text[k] == "{" else -1
        elif text[k] == "$" and text[k - 1] != "\\" and depth == 0:
            return k
    raise MarkupError(f"$ is missing in {text[at:]!r}")
