"""The cross-check of one robot's printed code, as a page beside the code."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from closedform.check import runners
from closedform.check.crosscheck import crosscheck
from closedform.check.failures import UnavailableError
from closedform.check.finding import Finding
from closedform.emit.backends import load
from closedform.emit.escape import markdown_text
from closedform.model.derivation import Derivation


class Report(NamedTuple):
    """The page, the errors above the tolerances, and what single precision cannot do."""

    page: str
    failures: list[str]
    limits: list[str]


def report(derivation: Derivation, root: Path, backends: Sequence[str]) -> Report:
    """Cross-check what was printed.

    ``root`` is the folder with the printed files, each back end in a folder of its own.  Code that
    cannot be run here is left out, and the page says so.
    """
    findings: list[Finding] = []
    remarks: list[str] = []
    for name in backends:
        if not (kind := load(name).runner):
            continue
        try:
            with tempfile.TemporaryDirectory() as scratch:
                for backend in runners.load(kind)(name, derivation, root / name, Path(scratch)):
                    findings += crosscheck(derivation, backend)
        except UnavailableError as error:
            remarks.append(f"What is in {name}/ was not checked: {error}.")
    failures = [f"{f.function} ({f.backend}): {x}" for f in findings for x in f.failures]
    limits = [f"{f.function} ({f.backend}): {x}" for f in findings for x in f.limits]
    if limits:
        remarks.append(
            "Mostly near singular postures and with very unequal lengths, the digits of single\n"
            "precision do not suffice:\n\n" + "\n".join(f"- {x}" for x in limits)
        )
    return Report(_page(derivation, findings, failures, remarks), failures, limits)


def _page(
    derivation: Derivation,
    findings: Sequence[Finding],
    failures: Sequence[str],
    remarks: list[str],
) -> str:
    names = list(dict.fromkeys(f.backend for f in findings))
    rows: dict[tuple[str, str], dict[str, Finding]] = {}
    for f in findings:
        rows.setdefault((f.function, f.unit), {})[f.backend] = f
    lines = [
        f"# {markdown_text(derivation.title)}: cross-check",
        "",
        "The worst error of each printed function against its symbolic source, evaluated in Arb",
        "balls, over ordinary, huge, tiny and singular inputs: in units in the last place of the",
        "natural scale; of an inverse what it leaves of its equations, or by how much its answers",
        "miss the target, in units of rounding.",
        "",
        f"| function | unit | {' | '.join(names)} | compared |",
        f"|---|---|{'---:|' * (len(names) + 1)}",
    ]
    for (name, unit), cells in rows.items():
        shown = (f"{cells[n].worst:.2f}" if n in cells else "" for n in names)
        compared = sum(f.compared for f in cells.values())
        lines.append(f"| {name} | {unit} | {' | '.join(shown)} | {compared} |")
        if not compared:
            remarks = [*remarks, f"No value of {name} could be compared."]
    lines += ["", *remarks] if remarks else []
    wrong = [f"- {failure}" for failure in failures] or ["Nothing exceeds its tolerance."]
    return "\n".join([*lines, "", *wrong]) + "\n"
