"""The command ``closedform claims``: judge the claims of one derivation, or examine them."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from closedform.pipeline import scripts

if TYPE_CHECKING:
    from closedform.model.claims import Claim
    from closedform.model.derivation import Derivation


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("name", metavar="NAME", help="a derivation or the path of a script")
    parser.add_argument(
        "--only", metavar="TEXT", default="", help="only claims with TEXT in the label"
    )
    parser.add_argument(
        "--mutate", action="store_true", help="change each printed text and judge it again"
    )
    parser.add_argument(
        "--paper",
        type=Path,
        metavar="FILE",
        help="print the text of the paper that no claim covers",
    )


def report(options: argparse.Namespace, derivation: Derivation) -> Iterator[str]:
    """The lines of the report."""
    from closedform.emit.terminal import mixed
    from closedform.model.claims import HOLDS
    from closedform.proof.claims import judge

    if options.paper:
        yield from _coverage(derivation, options.paper)
        return
    claims = [c for c in derivation.claims if options.only in c.label]
    if not derivation.claims:
        yield f"{derivation.name} has no claims: it quotes no paper"
    elif not claims:
        yield f"no claim of {derivation.name} has {options.only!r} in its label"
    for claim in claims:
        try:
            result = judge(claim, derivation.errata)
        except Exception as error:  # a check may call anything that its author wrote
            yield f"{claim.label}: {type(error).__name__}: {error}"
            continue
        evidence = f": {mixed(result.evidence)}" if result.evidence else ""
        yield f"{claim.label}: {result.kind}{evidence}"
        for reading in result.readings:
            evidence = f": {mixed(reading.evidence)}" if reading.evidence else ""
            yield f"    reading: {mixed(reading.text)}: {reading.kind}{evidence}"
        if result.corrected:
            yield f"    holds instead: {mixed(result.corrected)}"
        if not options.mutate:
            continue
        yield from _changed(claim, result.kind in HOLDS)


def _changed(claim: Claim, held: bool) -> Iterator[str]:
    """The changed texts of a claim that deserve a look."""
    from closedform.proof.mutations import outcomes

    found = list(outcomes(claim))
    for outcome in found:
        if outcome.error:
            yield f"    {outcome.mutation}: {outcome.error}"
        elif held and not outcome.changes:
            yield f"    survives: {outcome.mutation}: {outcome.kind}"
    if not any(outcome.changes for outcome in found):
        yield f"    cannot be changed: {claim.fixed or 'NO REASON IS GIVEN'}"


def _coverage(derivation: Derivation, path: Path) -> Iterator[str]:
    """What of the paper is covered by all derivations of it."""
    from closedform.check.coverage import cover

    paper, claims = derivation.paper, list(derivation.claims)
    for source in scripts.sources():
        if source.name == derivation.name:
            continue
        try:
            found = scripts.load(source)
        except scripts.DerivationError as error:
            yield f"left out: {error}"
            continue
        if found.paper.key == paper.key:
            claims += found.claims
    covered = cover(paper, claims, path.read_text("utf-8"))
    for gap in covered.gaps:
        yield f"line {gap.line}: {gap.text}"
    for text in covered.unfound:
        yield f"not in the paper: {text}"
    total = covered.quoted + covered.out_of_scope + covered.left
    yield (
        f"{paper.key}: {100 * covered.quoted / total:.1f} % of the characters are quoted by "
        f"claims, {100 * covered.out_of_scope / total:.1f} % are out of scope, "
        f"{100 * covered.left / total:.1f} % are left; passages not covered: "
        f"{len(covered.gaps)}, quotations not found: {len(covered.unfound)}"
    )
