"""Judges the claims of a derivation: verdict, readings, correction, and the errata that follow."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.model.claims import (
    FAULTS,
    HOLDS,
    NOT_DECIDABLE,
    PROVED,
    REFUTED,
    Check,
    Claim,
    Erratum,
    Reading,
    Verdict,
    plain,
)
from closedform.model.notation import Notation, Relation
from closedform.proof.checks.equations import Equal
from closedform.proof.checks.evidence import constant, fixed, nearest
from closedform.proof.require import ProofError


@dataclass(frozen=True)
class ReadingResult:
    """One reading of a claim with its verdict, as plain text."""

    text: str
    kind: str
    evidence: str


@dataclass(frozen=True)
class ClaimResult:
    """A claim with its verdict, as plain text in which formulas stand between dollar signs."""

    label: str
    where: str
    printed: str
    kind: str
    evidence: str
    corrected: str
    readings: tuple[ReadingResult, ...] = ()
    erratum: str = ""
    paraphrase: bool = False


@dataclass(frozen=True)
class ErratumResult:
    """An error of the paper, as plain text; the claims that show it name its key."""

    key: str
    title: str
    gravity: str
    why: str
    use: str


def judge(claim: Claim, errata: Sequence[Erratum]) -> ClaimResult:
    """The verdict of a claim; raises if its correction does not hold or an erratum is missing."""
    readings = claim.readings or (Reading("as printed"),)
    verdicts = [judged(claim, claim.printed, reading) for reading in readings]
    kind = verdicts[0].kind
    if claim.corrected:
        if kind in HOLDS:
            raise ProofError(f"the claim holds, so it needs no correction: {claim.printed}")
        held = judged(claim, claim.corrected, readings[0]).kind
        if held not in HOLDS:
            raise ProofError(f"the correction is {held}: {claim.corrected}")
    shown = [_text(v.evidence, claim.notation) for v in verdicts]
    known = {e.key for e in errata}
    if claim.erratum and claim.erratum not in known:
        raise ProofError(f"there is no erratum {claim.erratum!r}; there are {sorted(known)}")
    if kind in FAULTS and not claim.erratum:
        raise ProofError(
            f"the verdict is {kind} ({shown[0]}): correct the transcription, or name the erratum "
            "that explains it"
        )
    if claim.erratum and kind in (PROVED, NOT_DECIDABLE):
        raise ProofError(f"the verdict is {kind}, but the claim names the erratum {claim.erratum}")
    results = (
        tuple(
            ReadingResult(r.text, v.kind, text)
            for r, v, text in zip(readings, verdicts, shown, strict=True)
        )
        if claim.readings
        else ()
    )
    return ClaimResult(
        label=claim.label,
        where=claim.where,
        printed=claim.text,
        kind=kind,
        evidence=shown[0],
        corrected=plain(claim.corrected),
        readings=results,
        erratum=claim.erratum,
        paraphrase=claim.paraphrase,
    )


def judged(claim: Claim, text: str, reading: Reading | None = None) -> Verdict:
    """The verdict of a text of a claim."""
    reading = reading or next(iter(claim.readings), None)
    verdict = claim.checked(text, reading, as_printed).judge()
    if not claim.is_opposite(text) or verdict.kind not in (*HOLDS, REFUTED):
        return verdict
    return Verdict(PROVED if verdict.kind == REFUTED else REFUTED, verdict.evidence)


def as_printed(*formulas: Relation | tuple[Relation, ...]) -> Check:
    """The check of a claim without one: all its formulas are equations that always hold."""
    relations = tuple(r for f in formulas for r in (f if isinstance(f, tuple) else (f,)))
    return Equal(relations)


def require_shown(errata: Sequence[Erratum], results: Sequence[ClaimResult]) -> None:
    """Raise if no claim shows an erratum: then the paper is right."""
    shown = {r.erratum for r in results}
    for erratum in errata:
        if erratum.key not in shown:
            raise ProofError(f"no claim shows the erratum {erratum.key}: {erratum.title}")


def erratum_result(erratum: Erratum) -> ErratumResult:
    why, use = erratum.why, erratum.use
    for name, (value, digits) in erratum.numbers.items():
        decimal = fixed(nearest(constant(value) * 10**digits), digits)
        why, use = (text.replace(f"[{name}]", decimal) for text in (why, use))
    return ErratumResult(erratum.key, erratum.title, erratum.gravity.name, why, use)


def _text(evidence: Sequence[Any], notation: Notation) -> str:
    """Evidence as one text."""
    parts = []
    for piece in evidence:
        if isinstance(piece, str):
            parts.append(piece)
        elif isinstance(piece, Mapping):
            pairs = (f"${notation.write(s)} = {notation.write(v)}$" for s, v in piece.items())
            parts.append(", ".join(pairs))
        else:
            parts.append(f"${notation.write(sp.sympify(piece, strict=True))}$")
    return "".join(parts).strip()
