"""JavaScript: an ES module for each robot, the shared runtime, and a package for npm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from closedform._version import __version__
from closedform.emit import sines
from closedform.emit.backend import Backend, Files, Mechanism, Pages, runtime
from closedform.emit.backends.js.module import module
from closedform.emit.render import render
from closedform.model.tolerances import DOUBLE, GENERATED

SHARED = ("index.js", "package.json")


class JavaScript(Backend):
    runner = "node"

    def pages(self, mechanism: Mechanism) -> Pages:
        name = mechanism.derivation.name
        context = module(mechanism.derivation, mechanism.lowered)
        path = Path("js", f"{name}.js")
        return Pages({path: render("js/module.js.jinja", context)}, name)

    def shared(self, shares: Sequence[str]) -> Files:
        context = {"robots": sorted(shares), "version": __version__}
        printed = {Path("js", name): render(f"js/{name}.jinja", context) for name in SHARED}
        shared = {
            Path("js", "_runtime.js"): runtime("js/_runtime.js", _numbers()),
            Path("js", "_nearest.js"): runtime("js/_nearest.js", ()),
        }
        return {**shared, **printed}

    def first_file(self, robot: str) -> Path:
        return Path("js", f"{robot}.js")


def _numbers() -> list[str]:
    """The tolerances, and the sine and cosine by the operations of the C."""
    turns, limit, shift = sines.RIGHT_ANGLE, sines.LIMIT, sines.ROUND
    return [
        "".join(f"export const {n.upper()} = {getattr(DOUBLE, n)!r};\n" for n in GENERATED),
        f"if (!(size <= {limit})) {{",
        f"if (!(Math.abs(angle) <= {limit})) return",
        f"n = (size * {sines.RIGHT_ANGLES} + {shift}) - {shift};",
        f"near = size - n * {turns[0]};\n    const part = n * {turns[1]};",
        f"- part) - n * {turns[2]};",
        *(_polynomial(c) for c in (sines.SINE, sines.COSINE)),
        f"((angle - turns * (4 * {turns[0]})) - turns * (4 * {turns[1]})) -\n"
        f"        turns * (4 * {turns[2]});",
    ]


def _polynomial(c: Sequence[float]) -> str:
    return (
        f" = ({c[0]} + z * {c[1]}) +\n"
        f"        z2 * (({c[2]} + z * {c[3]}) +\n"
        f"            z2 * ({c[4]} + z * {c[5]}));\n"
    )


BACKEND = JavaScript()
