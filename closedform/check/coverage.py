"""Finds the passages of a paper that no claim quotes.

A passage is covered if a claim quotes it, or if the paper lists it as out of scope.  The comparison
ignores spaces, braces, and the kinds of quotation marks and dashes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from closedform.model.claims import Claim
from closedform.model.paper import Paper

_SHORTEST_FRAGMENT = 4
_SHORTEST_GAP = 12
_IGNORED = re.compile(r"[\s$*#|{}\u200b]")
_NUMBER = re.compile(r"\\tag\{[^}]*\}")
_ALIKE = str.maketrans({"’": "'", "‘": "'", "“": '"', "”": '"', "–": "-", "—": "-", "−": "-"})


@dataclass(frozen=True)
class Gap:
    """A passage of the paper that nothing covers."""

    line: int
    text: str


@dataclass(frozen=True)
class Coverage:
    """How much of a paper is covered: characters quoted, out of scope, and left over."""

    quoted: int
    out_of_scope: int
    left: int
    gaps: tuple[Gap, ...]
    unfound: tuple[str, ...]
    """Claims that quote what the paper does not print, and passages that it does not contain."""


class _Text:
    """A text without what the comparison ignores, with the place of each character."""

    def __init__(self, text: str):
        self.text = text = _NUMBER.sub(lambda m: " " * len(m[0]), text)
        self.places = [k for k, c in enumerate(text) if not _IGNORED.match(c)]
        self.plain = "".join(text[k] for k in self.places).translate(_ALIKE)
        self.marks = [""] * len(self.plain)

    def mark(self, fragment: str, kind: str) -> bool:
        """Mark every occurrence of a fragment; returns whether there is one."""
        wanted, start, found = _plain(fragment), 0, False
        while wanted and (at := self.plain.find(wanted, start)) >= 0:
            self.put(at, at + len(wanted), kind)
            start, found = at + 1, True
        return found

    def put(self, start: int, end: int, kind: str) -> None:
        for k in range(start, end):
            self.marks[k] = self.marks[k] or kind

    def gaps(self) -> Iterable[Gap]:
        start = None
        for k in range(len(self.plain) + 1):
            free = k < len(self.plain) and not self.marks[k]
            if free and start is None:
                start = k
            elif not free and start is not None:
                passage = self.text[self.places[start] : self.places[k - 1] + 1]
                if sum(c.isalnum() for c in passage) >= _SHORTEST_GAP:
                    line = self.text.count("\n", 0, self.places[start]) + 1
                    yield Gap(line, " ".join(passage.split()))
                start = None


def cover(paper: Paper, claims: Iterable[Claim], text: str) -> Coverage:
    """The coverage of a text by claims and by passages out of scope."""
    whole, unfound = _Text(text), []
    for claim in claims:
        found = [whole.mark(f, "quoted") for f in fragments(claim.text)]
        if not claim.paraphrase and not (found and all(found)):
            unfound.append(f"{claim.label}: {claim.text}")
    for first, last, _ in paper.out_of_scope:
        start = whole.plain.find(_plain(first))
        end = whole.plain.find(_plain(last), start) if start >= 0 else -1
        if end < 0:
            unfound.append(f"out of scope: {first} ... {last}")
        else:
            whole.put(start, end + len(_plain(last)), "out of scope")
    return Coverage(
        whole.marks.count("quoted"),
        whole.marks.count("out of scope"),
        whole.marks.count(""),
        tuple(whole.gaps()),
        tuple(unfound),
    )


def fragments(text: str) -> list[str]:
    """The verbatim parts of a claim: what is between quotation marks, or the whole, by omission."""
    quoted = re.findall("“([^”]*)”", text) or [text]
    parts = [p for q in quoted for p in re.split(r"\[\.\.\.\]|…", q)]
    return [p for p in parts if len(_plain(p)) >= _SHORTEST_FRAGMENT]


def _plain(text: str) -> str:
    return _IGNORED.sub("", text).translate(_ALIKE)
