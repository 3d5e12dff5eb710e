"""The book: the articles as chapters, between an introduction and the lemmas, errata and index."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from closedform.emit.backends.latex import bibliography, lemmas
from closedform.emit.backends.latex.article import index_of, indexed
from closedform.emit.backends.latex.prose import escape, mixed, quoted
from closedform.emit.errata import MEANINGS, Entry, PaperErrata, Part, gathered
from closedform.model.claims import VERDICTS
from closedform.model.derivation import Derivation
from closedform.model.paper import Paper

COURSE = (
    "planar_2r",
    "spherical_wrist",
    "scara",
    "puma560",
    "stanford_arm",
    "irb2400",
    "opw_arm",
    "ur_arm",
    "srs_arm",
    "franka_arm",
    "slider_crank",
    "four_bar",
    "rpr_planar",
    "five_bar",
    "linear_delta",
    "delta",
    "orthoglide",
    "three_prs",
    "spherical_five_bar",
    "agile_wrist",
    "hybrid_five_bar",
    "irb260",
    "h6ar",
    "h6ar_loop_closed",
)
"""The order in which a course would take the mechanisms; others follow, by name."""


@dataclass(frozen=True)
class Chapter:
    """What one mechanism adds to the book and to the errata."""

    name: str
    title: str
    paper: Paper
    lemmas: tuple[str, ...]
    errata: Part | None
    indexed: tuple[str, ...] = ()
    """The entries of the index that its steps and functions have."""


def chapter(derivation: Derivation, errata: Part | None) -> Chapter:
    used = tuple(lemmas.lemmas_of(derivation))
    found = [indexed(s.title) for s in derivation.steps]
    found += [index_of(f.name) for f in derivation.functions]
    entries = tuple(dict.fromkeys(found))
    return Chapter(
        derivation.name, derivation.title, derivation.paper, used, errata, indexed=entries
    )


def in_order(chapters: Iterable[Chapter]) -> list[Chapter]:
    """The chapters as a course would take them."""
    place = {name: k for k, name in enumerate(COURSE)}
    return sorted(chapters, key=lambda c: (place.get(c.name, len(COURSE)), c.name))


def context(shares: Sequence[Chapter]) -> dict[str, Any]:
    """The context of ``latex/book.tex.jinja``."""
    chapters = in_order(shares)
    used: dict[str, list[str]] = {}
    for one in chapters:
        for name in one.lemmas:
            link = rf"\hyperref[chapter:{one.name}]{{{escape(one.title)}}}"
            used.setdefault(name, []).append(link)
    return {
        "everywhere": everywhere(chapters),
        "names": [one.name for one in chapters],
        "theorems": lemmas.context(None, used),
        "papers": [_paper(p, chapters) for p in gathered(one.errata for one in chapters)],
        "meanings": [(kind, escape(MEANINGS[kind])) for kind in VERDICTS],
        "works": bibliography.entries(one.paper for one in chapters),
    }


def everywhere(chapters: Sequence[Chapter]) -> list[str]:
    """The entries of more than half of the chapters: the index would say nothing about them."""
    found = Counter(entry for one in chapters for entry in one.indexed)
    return sorted(entry for entry, n in found.items() if n > 2 and 2 * n > len(chapters))


def _paper(found: PaperErrata, chapters: Sequence[Chapter]) -> dict[str, Any]:
    own = [c for c in chapters if c.paper == found.paper]
    return {
        "title": escape(found.paper.title),
        "cited": bibliography.cited(found.paper),
        "sources": len(found.paper.cited) > 1,
        "verdicts": ", ".join(f"{n} {kind}" for kind, n in found.verdicts().items() if n),
        "entries": [_entry(e, own) for e in found.entries],
    }


def _entry(entry: Entry, chapters: Sequence[Chapter]) -> dict[str, Any]:
    key = entry.erratum.key
    shown = next(c for c in chapters if c.errata and any(e.key == key for e in c.errata.errata))
    return {
        "number": entry.number,
        "title": mixed(entry.erratum.title),
        "label": f"erratum:{shown.name}:{key}",
        "where": quoted("; ".join(dict.fromkeys(c.label for c in entry.claims))),
        "gravity": entry.gravity.value,
    }
