"""The commands ``closedform plot`` and ``make figures``."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from importlib import import_module
from pathlib import Path
from types import ModuleType
from typing import Any

from closedform.pipeline import run as pipeline

KINDS = ("mechanism", "branches", "workspace", "singularities", "field", "path")
SUFFIXES = (".svg", ".pdf", ".png")
STEPS = 200
PLACES = ("x", "y", "z", "T14", "T24", "T34")
"""Task coordinates that are a position."""


class PlotError(ValueError):
    """A figure that cannot be drawn."""


def add_options(parser: argparse.ArgumentParser) -> None:
    """The options of the command."""
    parser.add_argument("robot", metavar="ROBOT", help="a generated mechanism")
    parser.add_argument("what", metavar="WHAT", choices=KINDS, help=", ".join(KINDS))
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
    write(drawn[options.what], target)
    return f"{target}: {options.what} of {options.robot}\n"


def draw_all(folder: Path) -> Iterator[str]:
    """Draw every figure that fits every mechanism; yields a line for each mechanism."""
    folder.mkdir(parents=True, exist_ok=True)
    for source in pipeline.sources():
        robot = module(source.name)
        drawn = [kind for kind in KINDS if fits(robot, kind)]
        for kind in drawn:
            write(figures(robot, function="condition")[kind], folder / f"{source.name}-{kind}.svg")
        yield f"{source.name}: {', '.join(drawn)}\n"


def fits(robot: ModuleType, kind: str) -> bool:
    """Whether a figure makes sense for a mechanism: a map needs a position in the task."""
    if kind == "mechanism":
        return True
    return hasattr(robot, "ik") and (kind == "branches" or not set(robot.TASK).isdisjoint(PLACES))


def module(name: str) -> ModuleType:
    """The generated module of a mechanism, compiled if it can be."""
    if name not in [s.name for s in pipeline.sources()]:
        raise PlotError(f"there is no mechanism {name!r}; closedform list names them")
    try:
        return import_module(f"closedform.generated.c.{name}")
    except ImportError:
        return import_module(f"closedform.generated.numpy.{name}")


def write(figure: Callable[[], Any], target: Path) -> None:
    """Draw without a display, and save."""
    import matplotlib as mpl
    from matplotlib import pyplot as plt

    from closedform.plot import save

    mpl.use("Agg")
    try:
        save(figure(), target)
    finally:
        plt.close("all")


def figures(
    robot: ModuleType,
    *,
    plane: Sequence[str] | None = None,
    branch: str | None = None,
    function: str = "manipulability",
) -> dict[str, Callable[[], Any]]:
    """What draws each kind of figure."""
    from closedform import plot

    return {
        "mechanism": lambda: plot.mechanism(robot),
        "branches": lambda: plot.branches(robot),
        "workspace": lambda: plot.workspace(robot, plane),
        "singularities": lambda: plot.singularities(robot, plane),
        "field": lambda: plot.field(robot, function, plane, branch=branch or 0),
        "path": lambda: plot.path(robot, plot.line(robot, STEPS), branch=branch),
    }
