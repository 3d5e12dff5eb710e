"""The cross-check of one robot's printed code, as a page beside the code."""

from __future__ import annotations

import importlib
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType

from closedform.check.clibrary import CLibrary, compiler
from closedform.check.crosscheck import Backend, Finding, crosscheck, float_backend, module_backend
from closedform.emit.escape import markdown_text
from closedform.model.derivation import Derivation
from closedform.model.tolerances import DOUBLE

_PACKAGE = "_closedform_printed"


def report(derivation: Derivation, root: Path, backends: Sequence[str]) -> tuple[str, list[str]]:
    """The page, and the errors above the tolerances.

    ``root`` is the folder that holds the printed NumPy and C.  If there is a compiler, C is checked
    in both float types.
    """
    findings: list[Finding] = []
    remarks: list[str] = []
    with tempfile.TemporaryDirectory() as scratch:
        for backend in _backends(derivation, root, backends, Path(scratch), remarks):
            findings += crosscheck(derivation, backend)
    failures = [f"{f.function} ({f.backend}): {x}" for f in findings for x in f.failures]
    return _page(derivation, findings, failures, remarks), failures


def _backends(
    derivation: Derivation,
    root: Path,
    backends: Sequence[str],
    scratch: Path,
    remarks: list[str],
) -> Iterator[Backend]:
    if "numpy" in backends:
        yield module_backend("numpy", _module(root, derivation.name))
    if "c" in backends:
        try:
            compiler()
        except FileNotFoundError as error:
            remarks.append(f"The C was not checked: {error}.")
            return
        sources = root / "c"
        double = CLibrary(derivation, sources, scratch)
        yield Backend("c", double.function, double.dtype, DOUBLE)
        yield float_backend(CLibrary(derivation, sources, scratch, single=True).function)


def _module(root: Path, name: str) -> ModuleType:
    """The NumPy module that was just printed, even if another module has its name."""
    for loaded in [m for m in sys.modules if m.partition(".")[0] == _PACKAGE]:
        del sys.modules[loaded]
    package = ModuleType(_PACKAGE)
    package.__path__ = [str(root.resolve())]
    sys.modules[_PACKAGE] = package
    importlib.invalidate_caches()
    return importlib.import_module(f"{_PACKAGE}.numpy.{name}")


def _page(
    derivation: Derivation,
    findings: Sequence[Finding],
    failures: Sequence[str],
    remarks: Sequence[str],
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
        "natural scale; of an inverse what it leaves of its equations, in units of rounding.",
        "",
        f"| function | unit | {' | '.join(names)} | compared |",
        f"|---|---|{'---:|' * (len(names) + 1)}",
    ]
    for (name, unit), cells in rows.items():
        shown = (f"{cells[n].worst:.2f}" if n in cells else "" for n in names)
        compared = sum(f.compared for f in cells.values())
        lines.append(f"| {name} | {unit} | {' | '.join(shown)} | {compared} |")
    lines += ["", *remarks] if remarks else []
    wrong = [f"- {failure}" for failure in failures] or ["Nothing exceeds its tolerance."]
    return "\n".join([*lines, "", *wrong]) + "\n"
