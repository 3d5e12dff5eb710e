"""The claims of a paper and its errata, as LaTeX, with links to the steps that derive them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from closedform.emit import terminal
from closedform.emit.backends.latex.called import GREEK
from closedform.emit.backends.latex.equations import reference
from closedform.emit.backends.latex.formulas import flat
from closedform.emit.backends.latex.prose import Prose, escape, mixed, quoted
from closedform.emit.errata import Entry, gathered, part
from closedform.model.claims import HOLDS, PROVED_UNDER
from closedform.model.derivation import Derivation
from closedform.model.step import Step
from closedform.proof.claims import ClaimResult
from closedform.proof.prove import Proof

TERM = r"\|?(?:\d+ )?[A-Z]+\d?(?: [-+] (?:\d+ )?[A-Z]+\d?)*\|?"
COMPARED = rf"{TERM}(?: (?:<=|>=|=|<|>) {TERM})+"
"""A comparison of distances in plain text: ``CD <= L0 + 2 L1``."""


@dataclass(frozen=True)
class Claims:
    """The claims of one mechanism; ``labels`` are those of the equations of each step."""

    derivation: Derivation
    proof: Proof
    labels: Sequence[Sequence[str]] = ()

    @cached_property
    def prose(self) -> Prose:
        return Prose(self.derivation)

    def judged(self, published: str) -> int:
        """The number of the first claim about an equation of the paper, or 0."""
        claims = enumerate(self.proof.claims, 1)
        return next((k for k, c in claims if _is_of(published, c.label)), 0)

    def errata(self) -> list[dict[str, Any]]:
        """The errors of the paper that this mechanism shows, gravest first."""
        papers = gathered([part(self.derivation, self.proof)])
        return [self.erratum(e) for paper in papers for e in paper.entries]

    def erratum(self, entry: Entry) -> dict[str, Any]:
        return {
            "key": entry.erratum.key,
            "title": self.text(entry.erratum.title),
            "heading": self._heading(entry.erratum.title),
            "gravity": entry.gravity.value.capitalize(),
            "verdict": ", ".join(entry.verdicts),
            "why": self.text(entry.erratum.why),
            "use": self.text(entry.erratum.use),
            "claims": [self.claim(c) for c in entry.claims],
        }

    def _heading(self, title: str) -> str:
        """A title with a plain version for the bookmarks, which show no formulas."""
        plain = escape(terminal.mixed(title, pretty=False))
        plain = plain.replace(r"$\times$", "x").replace("$", "")
        return rf"\texorpdfstring{{{self.text(title)}}}{{{plain}}}"

    def rows(self) -> list[dict[str, Any]]:
        """The rows of the table; ``heading`` is the section of the paper, given once."""
        rows, where = [], ""
        sections = [*self.derivation.paper.sections, *(c.where for c in self.proof.claims)]
        order = sorted(enumerate(self.proof.claims, 1), key=lambda c: sections.index(c[1].where))
        for k, claim in order:
            rows.append({**self.claim(claim), "number": k, "heading": claim.where != where})
            where = claim.where
        return rows

    def claim(self, claim: ClaimResult) -> dict[str, Any]:
        titles = {e.key: self.text(e.title) for e in self.proof.errata}
        steps = self.derivation.steps
        return {
            "where": escape(claim.where),
            "label": quoted(claim.label),
            "step": next((k for k, s in enumerate(steps, 1) if derives(s, claim.label)), 0),
            "equations": self.equations_of(claim.label),
            "verdict": claim.kind if claim.kind in HOLDS else rf"\textbf{{{claim.kind}}}",
            "printed": mixed(claim.printed),
            "paraphrase": claim.paraphrase,
            "judged": f"{claim.kind.capitalize()}{':' if claim.evidence else '.'}",
            "found": "Assumption:" if claim.kind == PROVED_UNDER else "Found:",
            "evidence": self.told(claim.evidence),
            "reading": self.text(claim.readings[0].text) if claim.readings else "",
            "others": [
                (self.text(r.text), r.kind, self.told(r.evidence)) for r in claim.readings[1:]
            ],
            "corrected": mixed(claim.corrected, led=True),
            "erratum": claim.erratum,
            "title": titles.get(claim.erratum, ""),
        }

    def told(self, evidence: str) -> str:
        """What was found, in a line: fractions are flat, comparisons and joints are formulas."""
        parts = flat(evidence).split("$")
        names = [*(j.name for j in self.derivation.joints), *self.derivation.task]
        names = [rf"\b{n}\b" for n in dict.fromkeys(names) if n in GREEK or re.search(r"\d", n)]
        formula = "|".join([COMPARED, *names])
        for i in range(0, len(parts), 2):
            parts[i] = re.sub(formula, lambda m: f"${self.prose.formula(m[0])}$", parts[i])
        return self.text("$".join(parts))

    def text(self, text: str) -> str:
        """A text in which points of the drawing, and lines through them, are formulas."""
        parts = text.split("$")
        for i in range(0, len(parts), 2):
            parts[i] = self.prose.with_points(parts[i], first=not i)
        return mixed("$".join(parts))

    def equations_of(self, label: str) -> str:
        """The equations that derive those of a claim."""
        for step, labels in zip(self.derivation.steps, self.labels, strict=False):
            names = [n for n in step.published if _is_of(n, label)]
            if names and len(labels) == len(step.published):
                return reference([labels[step.published.index(names[0])]])
            if names:
                return reference(labels)
        return ""


def derives(step: Step, label: str) -> bool:
    """Whether a step derives the equation of a claim: ``eq. (9)`` or ``eq. (9), first line``."""
    return any(_is_of(name, label) for name in step.published)


def _is_of(published: str, label: str) -> bool:
    return bool({label, label.partition(",")[0]} & {published, f"eq. {published}"})
