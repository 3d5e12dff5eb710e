"""Labels that keep clear of lines and of each other, in the plane and in space."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

try:  # this file comes first, because it needs none of the others
    from matplotlib.layout_engine import ConstrainedLayoutEngine
    from matplotlib.transforms import Affine2D, Bbox, ScaledTranslation
    from mpl_toolkits.mplot3d import proj3d
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "closedform.plot needs Matplotlib; run: pip install 'closedform[plot]'"
    ) from error

Array = NDArray[np.float64]
DIRECTIONS = 16
AROUND = 8.0
"""Lines that are nearer to a label than that, in points of the page, could be taken for its own."""
DISTANCES = (4.0, 8.0, 13.0, 19.0)
"""How far a label may be from its point, in points of the page."""
BETWEEN = 2.5
"""The room between two labels, in points of the page."""
ROUNDS = 4
"""How often each label is placed again, beside where the others are by then."""
OUTSIDE = 0.12
"""What it costs to name an arc beside it, and half of what it costs inside."""
POINTS_PER_INCH = 72


@dataclass
class Label:
    """A text, the places that it may name, and the transformation of its axes."""

    text: Any
    at: Array
    inside: Any
    centre: Array | None = None
    """Of an arc, which has its name rather outside."""
    box: Array | None = None
    """Where it was placed, in pixels."""


def add(ax: Any, text: Any, at: Array, centre: Array | None = None) -> None:
    """Register a text, so that it is moved beside one of its points when the figure is drawn."""
    text.set(ha="center", va="center")
    places, own = np.atleast_2d(at), text.get_transform()
    ax.__dict__.setdefault("_closedform_labels", []).append(Label(text, places, own, centre))


class Layout(ConstrainedLayoutEngine):
    """The layout of a figure, which also places its labels: whenever the figure is drawn."""

    def execute(self, fig: Any) -> Any:
        found = super().execute(fig)
        place(fig)
        return found


def place(figure: Any) -> None:
    """Move all registered labels to where they cover the least, lines and each other."""
    for ax in figure.axes:
        mine = getattr(ax, "_closedform_labels", [])
        if not mine:
            continue
        ax.apply_aspect()
        for label in mine:
            label.text.set_transform(label.inside)
        lines, thick = _lines(ax)
        places = [_places(figure, ax, label, (lines, thick)) for label in mine]
        boxes = np.full((len(mine), 2, 2), np.nan)
        for _ in range(ROUNDS):
            for k, (centres, half, cost) in enumerate(places):
                others = np.delete(boxes, k, axis=0)
                total = cost + _shared(centres, half, others[np.isfinite(others[:, 0, 0])], ax)
                centre = centres[np.argmin(np.round(total, 6))]
                boxes[k] = [centre - half, centre + half]
        for label, box in zip(mine, boxes, strict=True):
            moved = (box.mean(0) - pixels(ax, label.at)[0]) / figure.dpi
            label.text.set_transform(
                label.inside + ScaledTranslation(moved[0], moved[1], figure.dpi_scale_trans)
            )
            label.box = box


def _places(
    figure: Any, ax: Any, label: Label, lines: tuple[Array, Array]
) -> tuple[Array, Array, Array]:
    """Where a label may be, half of its size, and what it would cover at each place."""
    scale = figure.dpi / POINTS_PER_INCH
    at = pixels(ax, label.at)
    box = label.text.get_window_extent(figure._get_renderer())
    half = np.array([box.width, box.height]) / 2
    angles = 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS + np.pi / 4
    ways = np.column_stack([np.cos(angles), np.sin(angles)])
    far = np.tile(np.repeat(DISTANCES, DIRECTIONS), len(at))[:, None]
    way = np.tile(ways, (len(at) * len(DISTANCES), 1))
    starts = np.repeat(at, DIRECTIONS * len(DISTANCES), axis=0)
    centres = starts + way * (far * scale + half * np.abs(way))
    cost = far[:, 0] / 25 + _cost(centres, half + 1.5 * scale, lines, ax)
    if label.centre is not None:
        out = starts - pixels(ax, np.atleast_2d(label.centre))
        out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-9)
        cost += OUTSIDE * (1 - (out * way).sum(1))
    return centres, half, cost


def _shared(centres: Array, half: Array, placed: Array, ax: Any) -> Array:
    """How much of other labels each place would cover, with a little room between them."""
    half = half + BETWEEN * ax.figure.dpi / POINTS_PER_INCH
    low, high = centres - half, centres + half
    sides = np.minimum(high[:, None], placed[:, 1]) - np.maximum(low[:, None], placed[:, 0])
    return np.asarray(0.2 * np.prod(np.clip(sides, 0, None), axis=-1).sum(-1))


def _cost(centres: Array, half: Array, lines: tuple[Array, Array], ax: Any) -> Array:
    """What a label would cover at each place: points of lines and the border.

    Lines beside it count a little, so that of two free places it takes the clearer one.
    """
    frame = ax.get_window_extent()
    points, thick = lines
    around = AROUND * ax.figure.dpi / POINTS_PER_INCH
    reach = half + thick[:, None]
    close = (np.abs(points - centres.mean(0)) < reach + around + np.ptp(centres, axis=0)).all(1)
    gaps = np.abs(points[close] - centres[:, None]) - reach[close]
    covered = (gaps < 0).all(-1).sum(-1)
    beside = (gaps < around).all(-1).sum(-1)
    low, high = centres - half, centres + half
    corner, end = np.array([frame.x0, frame.y0]), np.array([frame.x1, frame.y1])
    outside = np.maximum(corner - low, high - end).max(-1).clip(0)
    return np.asarray(0.35 * covered + 0.002 * beside + 0.05 * outside)


def _lines(ax: Any) -> tuple[Array, Array]:
    """Points along all that is drawn as a line, some three pixels apart; half of its thickness."""
    found, thick = [], list[float]()
    for line in ax.lines:
        data = line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_data()
        points = np.array([np.ravel(d) for d in data], dtype=float).T
        if line.get_transform() != ax.transData:
            continue
        ends = pixels(ax, points)
        for a, b in pairwise(ends):
            if np.isfinite([a, b]).all():
                n = 2 + int(np.hypot(*(b - a)) / 3)
                found.append(a + np.linspace(0, 1, n)[:, None] * (b - a))
        if len(ends) == 1:
            found.append(ends[0] + np.array([[0, 0], [3, 0], [-3, 0], [0, 3], [0, -3]]))
        half = line.get_linewidth() / 2 * ax.figure.dpi / POINTS_PER_INCH
        thick += [half] * (sum(map(len, found)) - len(thick))
    return np.vstack(found) if found else np.zeros((0, 2)), np.array(thick)


def pixels(ax: Any, points: Array) -> Array:
    """Where points of the axes are on the page, in pixels."""
    if getattr(ax, "name", "") == "3d":
        x, y, _ = proj3d.proj_transform(*np.asarray(points).T, ax.get_proj())
        points = np.column_stack([np.asarray(x), np.asarray(y)])
    return np.asarray(ax.transData.transform(points))


def drawn_box(figure: Any, margin: float) -> Bbox:
    """The part of a page that is drawn on, in inches: of axes that are off, what is in them."""
    renderer = figure._get_renderer()
    boxes = [legend.get_window_extent(renderer) for legend in figure.legends]
    for ax in figure.axes:
        if ax.axison:
            boxes.append(ax.get_tightbbox(renderer))
            continue
        boxes += [Bbox(label.box) for label in getattr(ax, "_closedform_labels", [])]
        boxes += [ax.title.get_window_extent(renderer)] * bool(ax.title.get_text())
        lines, _ = _lines(ax)
        if len(lines):
            boxes.append(Bbox([lines.min(0), lines.max(0)]))
    scale = Affine2D().scale(1 / figure.dpi)
    found = Bbox.union([b for b in boxes if b is not None]).transformed(scale)
    return found.padded(margin)
