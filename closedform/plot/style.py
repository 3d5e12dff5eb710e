"""Axes, colours and files; every file is the same on every run."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar

import matplotlib as mpl
from matplotlib import pyplot as plt

from closedform.plot.labels import Layout, drawn_box
from closedform.plot.robot import AZIMUTH, ELEVATION

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C564B", "#4D4D4D")
"""Colours that people with any colour vision can tell apart, after Okabe and Ito."""
GROUND = "#6b6b6b"
INK = "#222222"
RC: dict[Any, Any] = {
    "svg.hashsalt": "closedform",
    "svg.fonttype": "path",
    "pdf.fonttype": 42,
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 10,
    "axes.titlesize": 10,
    "axes.labelsize": 10,
    "axes.linewidth": 0.6,
    "xtick.labelsize": 8.5,
    "ytick.labelsize": 8.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.fontsize": 9,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
}
MARGIN = 0.04
"""Around a figure, in inches."""
UNDATED = {
    ".svg": {"Date": None, "Creator": "closedform"},
    ".pdf": {"CreationDate": None, "ModDate": None, "Creator": "closedform"},
    ".png": {"Software": "closedform"},
}


Drawing = TypeVar("Drawing", bound=Callable[..., Any])


def styled(function: Drawing) -> Drawing:
    """Draw in the style of this package, whatever the settings of the caller are."""

    @wraps(function)
    def drawn(*args: Any, **kwargs: Any) -> Any:
        with mpl.rc_context(RC):
            return function(*args, **kwargs)

    return drawn  # type: ignore[return-value]


def new_axes(spatial: bool, size: tuple[float, float] = (5.2, 4.4)) -> Any:
    """Axes of a new figure, in the style of this package."""
    return new_panels(1, 1, spatial=spatial, size=size)[0]


def new_panels(
    rows: int, columns: int, *, spatial: bool = False, size: tuple[float, float]
) -> list[Any]:
    """The axes of a new figure of several panels, row by row."""
    with mpl.rc_context(RC):
        figure = plt.figure(figsize=size, layout=Layout())
        if not spatial:
            return [figure.add_subplot(rows, columns, k + 1) for k in range(rows * columns)]
        panels = [
            figure.add_subplot(rows, columns, k + 1, projection="3d", proj_type="ortho")
            for k in range(rows * columns)
        ]
        for ax in panels:
            ax.view_init(elev=ELEVATION, azim=AZIMUTH)
            ax.computed_zorder = False
        return panels


def save(ax: Any, *targets: str | Path) -> None:
    """Write the figure of some axes as svg, pdf or png, byte for byte the same on every run.

    It is laid out once for all ``targets``.
    """
    paths = [Path(target) for target in targets]
    for path in paths:
        if path.suffix not in UNDATED:
            raise ValueError(f"{path}: the suffix must be one of {', '.join(UNDATED)}")
    figure = ax.figure
    with mpl.rc_context(RC):
        figure.draw_without_rendering()
        engine = figure.get_layout_engine()
        figure.set_layout_engine("none")  # it has placed everything
        box = drawn_box(figure, MARGIN)
        for path in paths:
            figure.savefig(path, metadata=UNDATED[path.suffix], dpi=160, bbox_inches=box)
        figure.set_layout_engine(engine)
    for path in paths:
        if path.suffix == ".svg":
            path.write_text(_shortened(path.read_text("utf-8")), "utf-8")


def _shortened(svg: str) -> str:
    """The same picture with coordinates of four digits, off by a tenth of a point, no indents.

    It does not show how a processor rounds: zeros have no sign, and names that are digests of
    numbers are counted instead.
    """
    names: dict[str, str] = {}

    def rounded(number: re.Match[str]) -> str:
        return f"{float(number[0]):.4g}"

    def path(data: re.Match[str]) -> str:
        short = re.sub(r"-?[0-9]+[.][0-9]+", rounded, data[1])
        short = re.sub(r"[ \n]*([A-Za-z])[ \n]*", r"\1", short).strip()
        return f' d="{short}"'

    def counted(name: re.Match[str]) -> str:
        return names.setdefault(name[0], f"{name[1]}{len(names) + 1}")

    svg = re.sub(r"\n +", "\n", re.sub(r' d="([^"]*)"', path, svg))
    svg = re.sub(r'(?<=[MLQC ("])-0(?![.0-9])', "0", svg)
    return re.sub(r'(?<=["#])([a-z]+)[0-9a-f]{10}(?=[")])', counted, svg)


def colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]
