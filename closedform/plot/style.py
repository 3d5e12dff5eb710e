"""Axes, colours and files; every file is the same on every run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from closedform.plot.robot import AZIMUTH, ELEVATION

try:
    import matplotlib as mpl
    from matplotlib import pyplot as plt
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "closedform.plot needs Matplotlib; run: pip install 'closedform[plot]'"
    ) from error

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C564B", "#4D4D4D")
"""Colours that people with any colour vision can tell apart, after Okabe and Ito."""
GROUND = "#6b6b6b"
RC: dict[Any, Any] = {
    "svg.hashsalt": "closedform",
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "font.size": 9,
    "axes.titlesize": 10,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "axes.spines.top": False,
    "axes.spines.right": False,
}
UNDATED = {
    ".svg": {"Date": None, "Creator": "closedform"},
    ".pdf": {"CreationDate": None, "ModDate": None, "Creator": "closedform"},
    ".png": {"Software": "closedform"},
}


def new_axes(spatial: bool, size: tuple[float, float] = (5.2, 4.4)) -> Any:
    """Axes of a new figure, in the style of this package."""
    with mpl.rc_context(RC):
        figure = plt.figure(figsize=size, layout="constrained")
        if not spatial:
            return figure.add_subplot()
        ax = figure.add_subplot(projection="3d", proj_type="ortho")
        ax.view_init(elev=ELEVATION, azim=AZIMUTH)
        return ax


def save(ax: Any, target: str | Path) -> None:
    """Write the figure of some axes as svg, pdf or png, byte for byte the same on every run."""
    path = Path(target)
    if path.suffix not in UNDATED:
        raise ValueError(f"{path}: the suffix must be one of {', '.join(UNDATED)}")
    with mpl.rc_context(RC):
        ax.figure.savefig(path, metadata=UNDATED[path.suffix], dpi=160)


def colour(k: int) -> str:
    return COLOURS[k % len(COLOURS)]
