"""The one Jinja environment, and the list of files that a derivation turns into."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import jinja2

from closedform.derivation import Derivation
from closedform.emit import c, numpy
from closedform.lower import lower
from closedform.tolerances import DOUBLE, FLOAT

BACKENDS = ("numpy", "c", "latex")


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


def robot_files(derivation: Derivation, backends: Sequence[str] = BACKENDS) -> dict[Path, str]:
    """Every file of one mechanism: path below ``generated/`` and contents."""
    lowered = {f.name: lower(f, derivation) for f in derivation.functions}
    name = derivation.name
    printed: dict[Path, str] = {}
    if "numpy" in backends:
        context = numpy.module(derivation, lowered)
        printed[Path("numpy", f"{name}.py")] = render("numpy/module.py.jinja", context)
    if "c" in backends:
        context = c.robot(derivation, lowered)
        printed[Path("c", f"{name}.h")] = render("c/robot.h.jinja", context)
        printed[Path("c", f"{name}.c")] = render("c/robot.c.jinja", context)
        printed[Path("c", f"{name}.py")] = render("c/module.py.jinja", context)
    return printed


def shared_files(derivations: Sequence[Derivation], backends: Sequence[str] = BACKENDS) -> dict[Path, str]:
    """The files that all mechanisms share."""
    printed: dict[Path, str] = {}
    if "numpy" in backends:
        context = {
            "feasibility": repr(DOUBLE.feasibility),
            "vanishing": f"2.0**{int(round(__import__('math').log2(DOUBLE.vanishing)))}",
            "rotation": repr(DOUBLE.rotation),
        }
        printed[Path("numpy", "_runtime.py")] = render("numpy/_runtime.py.jinja", context)
    if "c" in backends:
        robots = [
            c.robot(d, {f.name: lower(f, d) for f in d.functions}) for d in derivations
        ]
        printed[Path("c", "extension.c")] = render("c/extension.c.jinja", {"robots": robots})
        tol="".join(f"#define CLOSEDFORM_{n} CLOSEDFORM_C({v!r})\n" for n,v in (("FEASIBILITY",DOUBLE.feasibility),("VANISHING",DOUBLE.vanishing),("ROTATION",DOUBLE.rotation)))
        printed[Path("c", "closedform.h")] = render("c/closedform.h", {}).rstrip().removesuffix("#endif")+tol+"#endif\n"
    return printed
