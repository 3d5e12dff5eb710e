"""The errata of the papers: every claim that is not simply proved."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from typing import Any

from closedform.claims import PROVED, VERDICTS
from closedform.derivation import Derivation
from closedform.emit.prose import Prose
from closedform.prove import ClaimResult, Proof


def errata(derivations: Sequence[Derivation], proofs: Sequence[Proof]) -> dict[str, Any]:
    """The context of ``errata.md.jinja``: per paper, what is not simply proved."""
    papers: dict[str, dict[str, Any]] = {}
    counts: dict[str, Counter[str]] = {}
    for derivation, proof in zip(derivations, proofs, strict=True):
        if not proof.claims:
            continue
        key = derivation.paper.key
        paper = papers.setdefault(
            key,
            {
                "title": derivation.paper.title,
                "authors": ", ".join(derivation.paper.authors),
                "reference": derivation.paper.reference,
                "mechanisms": [],
            },
        )
        prose = Prose(derivation)
        claims = [_entry(claim, prose) for claim in proof.claims if claim.kind != PROVED]
        paper["mechanisms"].append({"title": derivation.title, "claims": claims})
        counts.setdefault(key, Counter()).update(c.kind for c in proof.claims)
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
    """Text and formulas between dollar signs, as GitHub renders them: ``$`...`$`` is left alone."""
    parts = text.split("$")
    for i, part in enumerate(parts):
        if i % 2:
            parts[i] = f"$`{part.strip()}`$"
            continue
        for old, new in (("**", "^"), ("*", "·"), ("<=", "≤"), (">=", "≥"), (" +/- ", " ± ")):
            part = part.replace(old, new)
        parts[i] = re.sub(r"([\\<`]|(?<!\w)_|_(?!\w))", r"\\\1", part)
    return "".join(parts)
