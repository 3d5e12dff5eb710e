"""The errors of a paper, gathered from the claims that show them.

A paper may have several mechanisms.  An error that several of them show is one error.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from closedform.model.claims import (
    APPROXIMATION,
    INCOMPLETE,
    INCONSISTENT,
    NOT_DECIDABLE,
    PROVED,
    PROVED_UNDER,
    REFUTED,
    VERDICTS,
    Gravity,
)
from closedform.model.derivation import Derivation
from closedform.model.paper import Paper
from closedform.proof.claims import ClaimResult, ErratumResult
from closedform.proof.prove import Proof

MEANINGS = {
    PROVED: "exact algebra shows that the statement holds for all values of its symbols",
    PROVED_UNDER: "it holds under an assumption that the paper does not state",
    APPROXIMATION: "it does not hold exactly; the order of the error is derived",
    INCOMPLETE: "it is right where it answers, but it loses solutions or cases",
    INCONSISTENT: "it cannot hold together with another statement of the paper",
    REFUTED: "it does not hold; a counterexample shows this",
    NOT_DECIDABLE: "a figure, a measurement or a judgement of value, which algebra cannot decide",
}
"""The meaning of each verdict."""

KINDS = {
    "Errors": (Gravity.MOTION, Gravity.RESULT, Gravity.STATEMENT),
    "Inconsistencies": (Gravity.INCONSISTENCY,),
    "Omissions": (Gravity.OMISSION,),
    "Misprints": (Gravity.MISPRINT,),
}
"""The sections of a list of errata, with what stands in each, gravest first."""


@dataclass(frozen=True)
class Part:
    """The contribution of one mechanism to the errata of its paper."""

    paper: Paper
    robot: str
    claims: tuple[ClaimResult, ...]
    errata: tuple[ErratumResult, ...]


@dataclass(frozen=True)
class Entry:
    """One error: its number within the paper, and the claims that show it."""

    number: int
    erratum: ErratumResult
    claims: tuple[ClaimResult, ...]

    @property
    def gravity(self) -> Gravity:
        return Gravity[self.erratum.gravity]

    @property
    def verdicts(self) -> tuple[str, ...]:
        """The verdicts of the claims, the worst first."""
        kinds = {c.kind for c in self.claims}
        return tuple(kind for kind in reversed(VERDICTS) if kind in kinds)


@dataclass(frozen=True)
class PaperErrata:
    """The claims and the errors of one paper, the gravest error first."""

    paper: Paper
    claims: tuple[ClaimResult, ...]
    entries: tuple[Entry, ...]

    def of_kind(self, kind: str) -> tuple[Entry, ...]:
        """The entries of one of :data:`KINDS`."""
        return tuple(e for e in self.entries if e.gravity in KINDS[kind])

    def with_verdict(self, verdict: str) -> tuple[ClaimResult, ...]:
        return tuple(c for c in self.claims if c.kind == verdict)

    def errors(self) -> dict[str, int]:
        """The number of distinct errors of each of :data:`KINDS`."""
        return {kind: len(self.of_kind(kind)) for kind in KINDS}

    def verdicts(self) -> dict[str, int]:
        """The number of claims for each verdict."""
        counts = Counter(c.kind for c in self.claims)
        return {kind: counts[kind] for kind in VERDICTS}


def part(derivation: Derivation, proof: Proof) -> Part | None:
    """The part of a mechanism; None if there are no claims."""
    if not proof.claims:
        return None
    return Part(derivation.paper, derivation.name, proof.claims, proof.errata)


def gathered(parts: Iterable[Part | None]) -> list[PaperErrata]:
    """The errata of each paper, from all its mechanisms; papers without any come last."""
    papers: dict[str, list[Part]] = {}
    for found in parts:
        if found is not None:
            papers.setdefault(found.paper.key, []).append(found)
    return sorted(map(_of_paper, papers.values()), key=lambda paper: not paper.entries)


def _of_paper(parts: Sequence[Part]) -> PaperErrata:
    errata: dict[str, tuple[str, ErratumResult]] = {}
    for found in parts:
        for erratum in found.errata:
            robot, known = errata.setdefault(erratum.key, (found.robot, erratum))
            if known != erratum:
                raise ValueError(
                    f"{robot} and {found.robot} describe the erratum {erratum.key} of "
                    f"{found.paper.key} in different words: write it once, and import it"
                )
    claims = tuple(dict.fromkeys(c for found in parts for c in found.claims))
    order = list(Gravity)
    ranked = sorted((e for _, e in errata.values()), key=lambda e: order.index(Gravity[e.gravity]))
    entries = (
        Entry(number, erratum, tuple(c for c in claims if c.erratum == erratum.key))
        for number, erratum in enumerate(ranked, 1)
    )
    return PaperErrata(parts[0].paper, claims, tuple(entries))
