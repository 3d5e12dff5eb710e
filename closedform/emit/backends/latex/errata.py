"""The errata of the papers: every claim that is not simply proved."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from closedform.emit.backends.latex.prose import Prose
from closedform.model.claims import PROVED, VERDICTS
from closedform.model.derivation import Derivation
from closedform.proof.prove import ClaimResult, Proof


@dataclass(frozen=True)
class Part:
    """The errata of one mechanism, in plain strings."""

    paper: dict[str, str]
    mechanism: dict[str, Any]
    counts: Counter[str]


def part(derivation: Derivation, proof: Proof) -> Part | None:
    """The part of a mechanism; None if there are no claims."""
    if not proof.claims:
        return None
    prose = Prose(derivation)
    claims = [_entry(claim, prose) for claim in proof.claims if claim.kind != PROVED]
    paper = derivation.paper
    return Part(
        {
            "key": paper.key,
            "title": paper.title,
            "authors": ", ".join(paper.authors),
            "reference": paper.reference,
        },
        {"title": derivation.title, "claims": claims},
        Counter(c.kind for c in proof.claims),
    )


def together(parts: Iterable[Part | None]) -> dict[str, Any]:
    """The context of ``errata.md.jinja``: for each paper, the claims that are not simply proved."""
    papers: dict[str, dict[str, Any]] = {}
    counts: dict[str, Counter[str]] = {}
    for found in parts:
        if found is None:
            continue
        key = found.paper["key"]
        paper = papers.setdefault(key, {**found.paper, "mechanisms": []})
        paper["mechanisms"].append(found.mechanism)
        counts.setdefault(key, Counter()).update(found.counts)
    for key, paper in papers.items():
        paper["counts"] = [(kind, counts[key][kind]) for kind in VERDICTS]
        paper["total"] = sum(counts[key].values())
    return {"papers": list(papers.values())}


def _entry(claim: ClaimResult, prose: Prose) -> dict[str, str]:
    return {
        "label": markdown(claim.label),
        "where": markdown(claim.where),
        "printed": markdown(claim.printed),
        "verdict": claim.kind,
        "evidence": markdown(claim.evidence),
        "corrected": markdown(prose.correction(claim.corrected)),
    }


def markdown(text: str) -> str:
    """Text with formulas between dollar signs, in the form ``$`...`$`` that GitHub renders."""
    parts = text.split("$")
    for i, part in enumerate(parts):
        if i % 2:
            parts[i] = f"$`{part.strip().replace('`', chr(39))}`$"
            continue
        for old, new in (("**", "^"), ("*", "·"), ("<=", "≤"), (">=", "≥"), (" +/- ", " ± ")):
            part = part.replace(old, new)
        parts[i] = re.sub(r"([\\<`]|(?<!\w)_|_(?!\w)|\](?=[(:\[])|&(?=#?\w+;))", r"\\\1", part)
    return "".join(parts)
