"""The command ``closedform plot``: one figure."""

from __future__ import annotations

import argparse
import difflib
import sys
from collections.abc import Callable
from functools import partial
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
    parser.add_argument(
        "robot",
        metavar="ROBOT",
        help="a mechanism that closedform list names, or a NumPy module that derive printed, "
        "such as out/numpy/my_arm.py",
    )
    parser.add_argument(
        "what", metavar="WHAT", help=f"{', '.join(KINDS)}, or a figure of its paper, such as fig1"
    )
    parser.add_argument(
        "-o", "--output", metavar="FILE", type=Path, required=True, help="an svg, pdf or png file"
    )
    parser.add_argument(
        "--plane", nargs=2, metavar=("A", "B"), help="of a map: two task coordinates or two joints"
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
    robot, name = module(options.robot), Path(options.robot).stem
    if options.branch is not None and options.branch not in robot.BRANCHES:
        raise PlotError(
            f"{name} has no branch {options.branch!r}; there are {', '.join(robot.BRANCHES)}"
        )
    drawn = figures(robot, name, options)
    if options.what not in drawn:
        known = ", ".join(drawn)
        raise PlotError(f"{name} has no figure {options.what!r}; there are {known}")
    write(drawn[options.what], target)
    return f"{target}: {options.what} of {name}\n"


def drawings() -> Any:
    """How the figures of mechanisms and papers are drawn."""
    return import_module("closedform.derivations.figures")


def catalogue(name: str, robot: ModuleType | None = None) -> list[Figure]:
    """The figures of a mechanism, as far as its task allows them."""
    from closedform.plot.catalogue import fits

    robot = robot or module(name)
    return [f for f in drawings().figures(name) if fits(robot, f.name)]


def module(name: str) -> ModuleType:
    """The generated module of a mechanism, compiled if it can be."""
    if name.endswith(".py"):
        return _printed(Path(name))
    known = [s.name for s in scripts.sources()]
    if name not in known:
        close = difflib.get_close_matches(name, known)
        hint = f"did you mean {close[0]}?" if close else "closedform list names them"
        raise PlotError(f"there is no mechanism {name!r}; {hint}")
    try:
        return import_module(f"closedform.generated.c.{name}")
    except ImportError:
        return import_module(f"closedform.generated.numpy.{name}")


def _printed(path: Path) -> ModuleType:
    """A NumPy module that ``derive`` printed, from its file."""
    if not path.is_file():
        raise PlotError(f"there is no file {path}")
    if not (path.parent / "_runtime.py").is_file():
        raise PlotError(
            f"{path} is not a printed NumPy module; derive it first: closedform derive {path} -o "
            f"out; then plot out/numpy/{path.name}"
        )
    package = ModuleType("closedform_printed")
    package.__path__ = [str(path.parent)]
    sys.modules[package.__name__] = package
    return import_module(f"{package.__name__}.{path.stem}")


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
    robot: ModuleType, name: str, options: argparse.Namespace
) -> dict[str, Callable[[], Any]]:
    """The function that draws each kind of figure; a mechanism is shown as in the documents."""
    from closedform import plot

    view = drawings().view(name)
    plane = options.plane
    shown: dict[str, Any] = {"unit": view.unit, "given": view.given}
    if plane is None:  # a section of the task, or of the joints
        shown |= {"at": view.at, "limits": view.limits}
        plane = view.plane or view.measured
    maps: dict[str, Callable[[], Any]] = {
        "workspace": lambda: plot.workspace(robot, options.plane or view.plane, **shown),
        "singularities": lambda: plot.singularities(robot, plane, **shown),
        "field": lambda: plot.field(
            robot, options.function, plane, branch=options.branch or 0, **shown
        ),
    }
    as_listed = {f.name: partial(f.draw, robot) for f in catalogue(name, robot)}
    if options.plane is None:
        maps |= {k: draw for k, draw in as_listed.items() if k in maps}
    path = {"path": lambda: plot.path(robot, plot.line(robot, STEPS), branch=options.branch)}
    return as_listed | maps | path
