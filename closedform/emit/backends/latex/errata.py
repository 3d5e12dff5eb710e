"""``errata.md``: the distinct errors of all papers, as Markdown.

GitHub reads a formula between ``$`` and `` ` `` or in a block of kind ``math``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Any

from closedform.emit.errata import KINDS, MEANINGS, Entry, PaperErrata, Part, gathered
from closedform.emit.escape import markdown_text
from closedform.model.claims import NOT_DECIDABLE, PROVED, PROVED_UNDER, VERDICTS
from closedform.proof.claims import ClaimResult, ReadingResult

ALONE = re.compile(r"\$([^$]*)\$[.,;]?")
"""A text that is one formula."""
WIDE = 60
"""The longest formula, in characters, that stands in a line of text."""


def context(parts: Iterable[Part | None]) -> dict[str, Any]:
    """The context of ``errata.md.jinja``."""
    papers = gathered(parts)
    return {
        "kinds": list(KINDS),
        "verdicts": [
            (kind, _with_total([p.verdicts()[kind] for p in papers])) for kind in VERDICTS
        ],
        "meanings": [(kind, MEANINGS[kind]) for kind in VERDICTS],
        "papers": [_paper(p) for p in papers],
        "errors_in_all": [sum(p.errors()[kind] for p in papers) for kind in KINDS],
        "claims_in_all": sum(len(p.claims) for p in papers),
    }


def _with_total(counts: list[int]) -> list[int]:
    return [*counts, sum(counts)]


def _paper(found: PaperErrata) -> dict[str, Any]:
    paper = found.paper
    numbers = {e.erratum.key: e.number for e in found.entries}
    sections = [
        (kind, [_entry(e, paper.key) for e in entries])
        for kind in KINDS
        if (entries := found.of_kind(kind))
    ]
    return {
        "key": paper.key,
        "title": markdown_text(paper.title),
        "authors": markdown_text(", ".join(paper.authors)),
        "reference": markdown_text(", ".join(filter(None, (paper.reference, paper.year)))),
        "source": markdown(paper.source),
        "errors": list(found.errors().values()),
        "total": len(found.claims),
        "summary": [_row(e, paper.key) for e in found.entries],
        "sections": sections,
        "assumptions": [
            _claim(c, _link(numbers.get(c.erratum), paper.key))
            for c in found.with_verdict(PROVED_UNDER)
        ],
        "undecided": [_claim(c) for c in found.with_verdict(NOT_DECIDABLE)],
        "proved": len(found.with_verdict(PROVED)),
    }


def _anchor(number: int, paper: str) -> str:
    return f"{paper}-{number}"


def _link(number: int | None, paper: str) -> str:
    return "" if number is None else f"[erratum {number}](#{_anchor(number, paper)})"


def _row(entry: Entry, paper: str) -> dict[str, Any]:
    """The line of an error in the summary."""
    return {
        "number": entry.number,
        "anchor": _anchor(entry.number, paper),
        "title": markdown(entry.erratum.title),
        "where": "; ".join(markdown_text(c.label) for c in entry.claims),
        "gravity": entry.gravity.value,
        "verdict": ", ".join(entry.verdicts),
    }


def _entry(entry: Entry, paper: str) -> dict[str, Any]:
    erratum = entry.erratum
    return {
        **_row(entry, paper),
        "why": markdown(erratum.why),
        "use": markdown(erratum.use),
        "claims": [_claim(c) for c in entry.claims],
    }


def _claim(claim: ClaimResult, see: str = "") -> dict[str, Any]:
    return {
        "label": markdown_text(claim.label),
        "where": markdown_text(claim.where),
        "verdict": claim.kind,
        "verb": "paraphrased" if claim.paraphrase else "printed",
        "printed": stacked(claim.printed),
        "line": markdown(claim.printed),
        "evidence": markdown(claim.evidence),
        "corrected": stacked(claim.corrected),
        "reading": markdown(claim.readings[0].text) if claim.readings else "",
        "others": [_reading(r) for r in claim.readings[1:]],
        "see": see,
    }


def _reading(reading: ReadingResult) -> dict[str, str]:
    return {
        "text": markdown(reading.text),
        "verdict": reading.kind,
        "evidence": markdown(reading.evidence),
    }


def stacked(text: str) -> str:
    """What follows a colon in an item of a list: a line, or a block for a long formula alone."""
    alone = ALONE.fullmatch(text.strip())
    if alone is None or len(alone[1]) <= WIDE:
        return f" {markdown(text)}" if text else ""
    return "".join(f"\n    {line}" for line in ("```math", formula(alone[1]), "```"))


def markdown(text: str) -> str:
    """Text with formulas between dollar signs, in the form ``$`...`$`` that GitHub renders."""
    parts = text.split("$")
    for i, part in enumerate(parts):
        if i % 2:
            parts[i] = f"$`{formula(part)}`$"
        else:
            before, after = part[: len(part) - len(part.lstrip())], part[len(part.rstrip()) :]
            inner = markdown_text(part)
            parts[i] = f"{before}{inner}{after}" if inner else before
    return "".join(parts)


def formula(text: str) -> str:
    """A formula that can stand in Markdown, also in a table: without bars and backquotes."""
    plain = text.replace("`", "'").replace(r"\|", r"\Vert ").replace("|", r"\vert ")
    return " ".join(plain.split())
