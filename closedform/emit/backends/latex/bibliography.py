"""Bibliographies: the papers and textbooks that derivations cite."""

from __future__ import annotations

from collections.abc import Iterable

from closedform.emit.backends.latex.prose import escape
from closedform.model.names import listed
from closedform.model.paper import Paper, Work


def entries(papers: Iterable[Paper]) -> list[dict[str, str]]:
    """The works of these papers, each once, by author and year."""
    works = {work.key: work for paper in papers for work in paper.cited}
    return [_entry(w) for w in sorted(works.values(), key=lambda w: (_surnames(w), w.year))]


def _surnames(work: Work) -> list[str]:
    return [author.split()[-1] for author in work.authors]


def _entry(work: Work) -> dict[str, str]:
    published = ", ".join(filter(None, (work.published, work.year)))
    return {
        "key": work.key,
        "authors": escape(listed(work.authors)),
        "title": escape(work.title),
        "published": f"{escape(published)}." if published else "",
    }


def cited(paper: Paper) -> str:
    """The marks in a sentence: ``[2]``."""
    return rf"\cite{{{','.join(w.key for w in paper.cited)}}}" if paper.cited else ""


def source(paper: Paper) -> str:
    """What stands below the title of an article."""
    if paper.works:
        return f"{escape(paper.title)}~{cited(paper)}"
    year = f" ({escape(paper.year)})" if paper.year.isdigit() else ""
    return f"After {escape(listed(paper.authors))}: {escape(paper.title)}{year}~{cited(paper)}"
