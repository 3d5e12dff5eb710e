"""C99 and C++20: a source and headers for each robot, shared headers, a table for Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from closedform._version import __version__
from closedform.emit import sines
from closedform.emit.backend import Backend, Files, Mechanism, Pages, runtime
from closedform.emit.backends.c.nearest import nearest
from closedform.emit.backends.c.robot import robot
from closedform.emit.render import render
from closedform.model.tolerances import DOUBLE, FLOAT, GENERATED, HIGHEST_DEGREE, Tolerances

HEADER = Path("c", "closedform.h")
NEAREST = Path("c", "closedform_nearest.h")
SHARED = ("extension.c", "CMakeLists.txt", "closedform-config.cmake.in")


class C(Backend):
    runner = "compiled"

    def pages(self, mechanism: Mechanism) -> Pages:
        context = robot(mechanism.derivation, mechanism.lowered)
        name = mechanism.derivation.name
        found = nearest(mechanism.derivation, context["functions"])
        context = {**context, "nearest": found}
        printed = {
            Path("c", f"{name}.h"): render("c/robot.h.jinja", context),
            Path("c", f"{name}.c"): render("c/robot.c.jinja", context),
            Path("c", f"{name}.py"): render("c/module.py.jinja", context),
        }
        if found is not None:
            printed[Path("c", f"{name}_nearest.h")] = render("c/nearest.h.jinja", context)
        printed[Path("c", f"{name}.hpp")] = render("c/robot.hpp.jinja", context)
        return Pages(printed, context)

    def shared(self, shares: Sequence[Mapping[str, Any]]) -> Files:
        context = {"robots": shares, "version": __version__}
        printed = {Path("c", name): render(f"c/{name}.jinja", context) for name in SHARED}
        headers = {
            HEADER: runtime("c/closedform.h", _numbers(), including="closedform_angles.h"),
            NEAREST: runtime("c/closedform_nearest.h", ()),
        }
        return {**headers, **printed}

    def works_alone(self, path: Path) -> bool:
        """Everything but the binding to Python works alone."""
        return path.suffix != ".py" and path.name != "extension.c"

    def first_file(self, name: str) -> Path:
        return Path("c", f"{name}.c")


def _numbers() -> list[str]:
    """The tolerances of both types, the sizes, and the sine and cosine in double precision."""
    quarter = "\n".join(
        f"#define CF_PIO2_{k} CLOSEDFORM_C({part})" for k, part in enumerate(sines.RIGHT_ANGLE, 1)
    )
    return [
        f"#ifdef CLOSEDFORM_FLOAT\n{_tolerances(FLOAT)}#else\n{_tolerances(DOUBLE)}#endif\n",
        f"#define CF_TRIG_LIMIT CLOSEDFORM_C({sines.LIMIT})\n{quarter}\n"
        f"#define CF_ROUND CLOSEDFORM_C({sines.ROUND}) ",
        f"ax * CLOSEDFORM_C({sines.RIGHT_ANGLES}) * one + CF_ROUND",
        *(_polynomial(c) for c in (sines.SINE, sines.COSINE)),
    ]


def _tolerances(kind: Tolerances) -> str:
    named = [
        f"#define CLOSEDFORM_{name.upper()} CLOSEDFORM_C({getattr(kind, name)!r})"
        for name in GENERATED
    ]
    sizes = [(n, kind.sizes(n)) for n in range(2, HIGHEST_DEGREE + 1)]
    listed = [
        f"#define CF_SIZES_{n} CLOSEDFORM_C({least}), CLOSEDFORM_C({most})"
        for n, (least, most) in sizes
    ]
    return "".join(f"{line}\n" for line in (*named, *listed))


def _polynomial(c: Sequence[float]) -> str:
    return (
        f"    return ({c[0]} + z * {c[1]} * one) +\n"
        f"           z2 * (({c[2]} + z * {c[3]} * one) +\n"
        f"                 z2 * ({c[4]} + z * {c[5]} * one) * one) * one;\n"
    )


BACKEND = C()
