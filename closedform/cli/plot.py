"""The command ``closedform plot``: one figure."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from closedform.pipeline import scripts

if TYPE_CHECKING:
    from closedform.plot.catalogue import Figure

KINDS = ("mechanism", "branches", "workspace", "singularities", "field", "path")
SUFFIXES = (".svg", ".pdf", ".png")
STEPS = 200


class PlotError(ValueError):
    """A figure that cannot be drawn."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("robot", metavar="ROBOT", help="a generated mechanism")
    parser.add_argument(
        "what", metavar="WHAT", help=f"{', '.join(KINDS)}, or a figure of its paper, such as fig1"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", type=Path, required=True, help="an svg, pdf or png file"
    )
    parser.add_argument(
        "--plane", nargs=2, metavar=("A", "B"), help="two task coordinates or two joints"
    )
    parser.add_argument(
        "--function",
        default="manipulability",
        help="for field: manipulability, condition or a name",
    )
    parser.add_argument("--branch", help="for field and path: the name of a branch")


def draw(options: argparse.Namespace) -> str:
    """Draw one figure; returns a line that says where it is."""
    target: Path = options.output
    if target.suffix not in SUFFIXES:
        raise PlotError(f"{target}: the suffix must be one of {', '.join(SUFFIXES)}")
    robot = module(options.robot)
    if options.branch is not None and options.branch not in robot.BRANCHES:
        raise PlotError(
            f"{options.robot} has no branch {options.branch!r}; there are "
            f"{', '.join(robot.BRANCHES)}"
        )
    drawn = figures(robot, plane=options.plane, branch=options.branch, function=options.function)
    named = {f.name: f for f in catalogue(options.robot)}
    if options.what not in {*drawn, *named}:
        known = ", ".join(dict.fromkeys([*drawn, *named]))
        raise PlotError(f"{options.robot} has no figure {options.what!r}; there are {known}")
    write(drawn.get(options.what, lambda: named[options.what].draw(robot)), target)
    return f"{target}: {options.what} of {options.robot}\n"


def drawings() -> Any:
    """How the figures of mechanisms and papers are drawn."""
    return import_module("closedform.derivations.figures")


def catalogue(name: str) -> list[Figure]:
    """The figures of a mechanism, as far as its task allows them."""
    from closedform.plot.catalogue import fits

    return [f for f in drawings().figures(name) if fits(module(name), f.name)]


def module(name: str) -> ModuleType:
    """The generated module of a mechanism, compiled if it can be."""
    if name not in [s.name for s in scripts.sources()]:
        raise PlotError(f"there is no mechanism {name!r}; closedform list names them")
    try:
        return import_module(f"closedform.generated.c.{name}")
    except ImportError:
        return import_module(f"closedform.generated.numpy.{name}")


def write(figure: Callable[[], Any], *targets: Path) -> None:
    """Draw once without a display, and save in each format."""
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from closedform.plot import save

    mpl.use("Agg")
    try:
        save(figure(), *targets)
    finally:
        plt.close("all")


def figures(
    robot: ModuleType,
    *,
    plane: Sequence[str] | None = None,
    branch: str | None = None,
    function: str = "manipulability",
) -> dict[str, Callable[[], Any]]:
    """The function that draws each kind of figure."""
    from closedform import plot

    return {
        "mechanism": lambda: plot.mechanism(robot),
        "branches": lambda: plot.branches(robot),
        "workspace": lambda: plot.workspace(robot, plane),
        "singularities": lambda: plot.singularities(robot, plane),
        "field": lambda: plot.field(robot, function, plane, branch=branch or 0),
        "path": lambda: plot.path(robot, plot.line(robot, STEPS), branch=branch),
    }
