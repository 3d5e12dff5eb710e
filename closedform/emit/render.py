"""The Jinja environment, and the list of files that are printed for derivations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2

from closedform.emit import c, latex, numpy
from closedform.emit.errata import Part, part, together
from closedform.emit.escape import FILTERS
from closedform.emit.table import csv
from closedform.lower import lower
from closedform.model.derivation import Derivation
from closedform.proof.prove import Proof

BACKENDS = ("numpy", "c", "latex", "data")


@cache
def environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(str(files("closedform.templates"))),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters |= FILTERS
    return environment


def render(template: str, context: Mapping[str, Any]) -> str:
    return environment().get_template(template).render(context)


@dataclass(frozen=True)
class Share:
    """The part of one mechanism in the shared files: plain strings that are cheap to pass on."""

    c: Mapping[str, Any] | None = None
    errata: Part | None = None


@dataclass(frozen=True)
class Pages:
    """The files of one mechanism, by path below ``generated/``, and its part of shared files."""

    files: dict[Path, str]
    share: Share


def pages(derivation: Derivation, proof: Proof, backends: Sequence[str] = BACKENDS) -> Pages:
    """Print one mechanism."""
    name = derivation.name
    printed: dict[Path, str] = {}
    robot = None
    lowered = (
        {f.name: lower(f, derivation) for f in derivation.functions}
        if {"numpy", "c"} & set(backends)
        else {}
    )
    if "numpy" in backends:
        context = numpy.module(derivation, lowered)
        printed[Path("numpy", f"{name}.py")] = render("numpy/module.py.jinja", context)
    if "c" in backends:
        robot = c.robot(derivation, lowered)
        printed[Path("c", f"{name}.h")] = render("c/robot.h.jinja", robot)
        printed[Path("c", f"{name}.c")] = render("c/robot.c.jinja", robot)
        printed[Path("c", f"{name}.py")] = render("c/module.py.jinja", robot)
    if "latex" in backends:
        context = latex.document(derivation, proof)
        printed[Path("latex", f"{name}.tex")] = render("latex/robot.tex.jinja", context)
    if "data" in backends:
        for table in derivation.tables:
            printed[Path("data", f"{table.name}.csv")] = csv(derivation, table)
    return Pages(printed, Share(robot, part(derivation, proof) if "latex" in backends else None))


def shared_files(shares: Sequence[Share], backends: Sequence[str] = BACKENDS) -> dict[Path, str]:
    """The files that all mechanisms share, from the part of each mechanism."""
    printed: dict[Path, str] = {}
    if "numpy" in backends:
        context = numpy.runtime()
        printed[Path("numpy", "_runtime.py")] = render("numpy/_runtime.py.jinja", context)
    if "c" in backends:
        context = c.shared([share.c for share in shares if share.c is not None])
        for name in ("closedform.h", "extension.c", "CMakeLists.txt", "closedform-config.cmake.in"):
            printed[Path("c", name)] = render(f"c/{name}.jinja", context)
    if "latex" in backends:
        context = together(share.errata for share in shares)
        printed[Path("errata.md")] = render("errata.md.jinja", context)
    return printed
