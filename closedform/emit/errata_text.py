"""The errata of the papers as a page for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from closedform.emit.errata import KINDS, Entry, PaperErrata, Part, gathered
from closedform.emit.terminal import heading, mixed, paragraph
from closedform.model.claims import NOT_DECIDABLE, PROVED, PROVED_UNDER
from closedform.proof.claims import ClaimResult


def text(parts: Iterable[Part | None]) -> str:
    """All papers, those with errors first, in lines of at most 100 columns."""
    papers = [line for paper in gathered(parts) for line in _paper(paper)]
    return "\n".join(papers).strip("\n") + "\n"


def _paper(found: PaperErrata) -> Iterator[str]:
    paper = found.paper
    lines = paragraph(paper.title)
    yield from ("", "", *lines, "=" * max(map(len, lines)))
    yield from paragraph(
        f"{', '.join(filter(None, (*paper.authors, paper.reference, paper.year)))}."
    )
    proved = len(found.with_verdict(PROVED))
    yield from paragraph(f"{proved} of {len(found.claims)} claims are proved as printed.")
    if paper.source:
        yield from ("", *paragraph(mixed(paper.source)))
    for kind in KINDS:
        if entries := found.of_kind(kind):
            yield from heading(kind)
            for entry in entries:
                yield from _entry(entry)
    if claims := found.with_verdict(PROVED_UNDER):
        numbers = {e.erratum.key: e.number for e in found.entries}
        yield from heading("Assumptions that the paper does not state")
        for claim in claims:
            yield from _claim(claim, numbers.get(claim.erratum))
    if claims := found.with_verdict(NOT_DECIDABLE):
        yield from heading("Not decided here")
        for claim in claims:
            yield from _claim(claim)


def _entry(entry: Entry) -> Iterator[str]:
    """One error, the claims that show it, and what follows."""
    erratum, gravity = entry.erratum, entry.gravity.value
    yield from ("", *paragraph(f"{entry.number}. {mixed(erratum.title)}"))
    yield from paragraph(f"{gravity[0].upper()}{gravity[1:]}.  {mixed(erratum.why)}", 3, 0)
    for claim in entry.claims:
        yield from _claim(claim)
    yield from ("", *paragraph(f"What follows: {mixed(erratum.use)}", 3, 0))


def _claim(claim: ClaimResult, number: int | None = None) -> Iterator[str]:
    """What the paper says, how it is read, its verdict, and what holds instead."""
    where = f" ({claim.where})" if claim.where else ""
    yield from ("", *paragraph(f"{claim.label}{where}", 3))
    told = [("paraphrased" if claim.paraphrase else "printed", claim.printed)]
    if claim.readings:
        told.append(("read as", claim.readings[0].text))
    see = f" (see {number})" if number else ""
    told.append((claim.kind, f"{claim.evidence}{see}"))
    for reading in claim.readings[1:]:
        evidence = f" ({reading.evidence})" if reading.evidence else ""
        told.append((f"other reading, {reading.kind}", f"{reading.text}{evidence}"))
    if claim.corrected:
        told.append(("holds instead, proved", claim.corrected))
    for name, what in told:
        yield from paragraph(f"{name}: {mixed(what)}" if what else name, 5)


__all__ = ["text"]
