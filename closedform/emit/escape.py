"""Escapes text for each language: it is printed faithfully and cannot end its string or comment.

The templates apply these filters to every text.  LaTeX has its own module,
:mod:`closedform.emit.backends.latex.prose`, which also typesets parts of sentences that look like
formulas.
"""

from __future__ import annotations

import json
import re

MARKUP = re.compile(r"([\\`*_<>\[\]|#~$&]|^(?=[-+=]))")
"""Characters with a meaning in Markdown, also those with one only at the start of a line."""


def c_comment(text: str) -> str:
    """Text inside ``/* */``; a space breaks ends and starts of comments, and trigraphs."""
    return re.sub(r"(?<=\*)(?=/)|(?<=/)(?=\*)|(?<=\?)(?=\?)", " ", text)


def c_string(text: str) -> str:
    """A string literal with the bytes of UTF-8."""
    return '"' + "".join(map(_c_character, text.encode())) + '"'


def _c_character(byte: int) -> str:
    character = chr(byte)
    if character == "\n":
        return r"\n"
    if character in '"\\?':
        return "\\" + character
    return character if 32 <= byte < 127 else f"\\{byte:03o}"


def python_comment(text: str) -> str:
    """Text after ``#``; a space breaks anything that would declare the encoding of the file."""
    return re.sub(r"(?<=coding)(?=[:=])", " ", text)


def python_docstring(text: str) -> str:
    """Text between triple double quotes."""
    escaped = text.replace("\\", "\\\\").replace('"""', r"\"\"\"")
    return escaped[:-1] + r"\"" if escaped.endswith('"') else escaped


def python_string(text: str) -> str:
    """A string literal."""
    return repr(text)


def javascript_comment(text: str) -> str:
    """Text inside ``/** */`` or after ``//``; a space breaks anything that would end it."""
    return re.sub(r"(?<=\*)(?=/)", " ", text)


def javascript_string(text: str) -> str:
    """A string literal."""
    return json.dumps(text)


def markdown_text(text: str) -> str:
    """Text on one line of Markdown."""
    return MARKUP.sub(r"\\\1", " ".join(text.split()))


FILTERS = {
    f.__name__: f
    for f in (
        c_comment,
        c_string,
        javascript_comment,
        javascript_string,
        python_comment,
        python_docstring,
        python_string,
        markdown_text,
    )
}
"""The filters of the templates, by name."""

__all__ = [
    "FILTERS",
    "c_comment",
    "c_string",
    "javascript_comment",
    "javascript_string",
    "markdown_text",
    "python_comment",
    "python_docstring",
    "python_string",
]
