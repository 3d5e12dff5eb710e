"""The one Jinja environment, and the list of files that derivations turn into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2

from closedform.derivation import Derivation
from closedform.emit import c, latex, numpy
from closedform.emit.errata import errata
from closedform.emit.table import csv
from closedform.lower import lower
from closedform.prove import Proof

BACKENDS = ("numpy", "c", "latex", "data")


@cache
def environment() -> jinja2.Environment:
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(files("closedform.templates"))),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        undefined=jinja2.StrictUndefined,
    )


def render(template: str, context: Mapping[str, Any]) -> str:
    return environment().get_template(template).render(context)


def robot_files(
    derivation: Derivation, proof: Proof, backends: Sequence[str] = BACKENDS
) -> dict[Path, str]:
    """Every file of one mechanism: the path below ``generated/`` and the contents."""
    name = derivation.name
    lowered = {f.name: lower(f, derivation) for f in derivation.functions}
    printed: dict[Path, str] = {}
    if "numpy" in backends:
        context = numpy.module(derivation, lowered)
        printed[Path("numpy", f"{name}.py")] = render("numpy/module.py.jinja", context)
    if "c" in backends:
        context = c.robot(derivation, lowered)
        printed[Path("c", f"{name}.h")] = render("c/robot.h.jinja", context)
        printed[Path("c", f"{name}.c")] = render("c/robot.c.jinja", context)
        printed[Path("c", f"{name}.py")] = render("c/module.py.jinja", context)
    if "latex" in backends:
        context = latex.document(derivation, proof)
        printed[Path("latex", f"{name}.tex")] = render("latex/robot.tex.jinja", context)
    if "data" in backends:
        for table in derivation.tables:
            printed[Path("data", f"{table.name}.csv")] = csv(derivation, table)
    return printed


def shared_files(
    derivations: Sequence[Derivation],
    proofs: Sequence[Proof],
    backends: Sequence[str] = BACKENDS,
) -> dict[Path, str]:
    """The files that all mechanisms share."""
    printed: dict[Path, str] = {}
    if "numpy" in backends:
        context = numpy.runtime()
        printed[Path("numpy", "_runtime.py")] = render("numpy/_runtime.py.jinja", context)
    if "c" in backends:
        context = c.shared(derivations)
        for name in ("closedform.h", "extension.c", "CMakeLists.txt", "closedform-config.cmake.in"):
            printed[Path("c", name)] = render(f"c/{name}.jinja", context)
    if "latex" in backends:
        printed[Path("errata.md")] = render("errata.md.jinja", errata(derivations, proofs))
    return printed
