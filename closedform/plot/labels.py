"""Labels that keep clear of lines and of each other, in the plane and in space."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.transforms import ScaledTranslation
from mpl_toolkits.mplot3d import proj3d
from numpy.typing import NDArray

Array = NDArray[np.float64]
DIRECTIONS = 16
DISTANCES = (4.0, 8.0, 13.0, 19.0)
"""How far a label may be from its point, in points of the page."""
POINTS_PER_INCH = 72


@dataclass
class Label:
    """A text, the place that it names, and the transformation of its axes."""

    text: Any
    at: Array
    inside: Any


def add(ax: Any, text: Any, at: Array) -> None:
    """Register a text, so that :func:`place` moves it beside its point."""
    text.set(ha="center", va="center")
    ax.__dict__.setdefault("_closedform_labels", []).append(Label(text, at, text.get_transform()))


def place(figure: Any) -> None:
    """Move all registered labels to where they cover the least, in the order of registration."""
    chosen = [ax for ax in figure.axes if getattr(ax, "_closedform_labels", None)]
    if not chosen:
        return
    for ax in chosen:
        for label in ax._closedform_labels:
            label.text.set_transform(label.inside)
    figure.draw_without_rendering()
    for ax in chosen:
        lines = _lines(ax)
        placed: list[Array] = []
        for label in ax._closedform_labels:
            placed.append(_place_one(figure, ax, label, lines, placed))


def _place_one(figure: Any, ax: Any, label: Label, lines: Array, placed: list[Array]) -> Array:
    scale = figure.dpi / POINTS_PER_INCH
    at = pixels(ax, label.at[None])[0]
    box = label.text.get_window_extent()
    half = np.array([box.width, box.height]) / 2
    frame = ax.get_window_extent()
    best = (np.inf, at)
    for distance in DISTANCES:
        for angle in 2 * np.pi * np.arange(DIRECTIONS) / DIRECTIONS + np.pi / 4:
            way = np.array([np.cos(angle), np.sin(angle)])
            centre = at + way * (distance * scale + half * np.abs(way))
            cost = distance / 40 + _cost(centre, half + 1.5 * scale, lines, placed, frame)
            if cost < best[0] - 1e-9:
                best = (cost, centre)
    centre = best[1]
    moved = (centre - at) / figure.dpi
    label.text.set_transform(
        label.inside + ScaledTranslation(moved[0], moved[1], figure.dpi_scale_trans)
    )
    return np.array([centre - half, centre + half])


def _cost(centre: Array, half: Array, lines: Array, placed: list[Array], frame: Any) -> float:
    """What a label at this place would cover: points of lines, other labels, the border."""
    covered = (np.abs(lines - centre) < half).all(1).sum() if len(lines) else 0
    low, high = centre - half, centre + half
    shared = sum(
        float(np.prod(np.clip(np.minimum(high, b[1]) - np.maximum(low, b[0]), 0, None)))
        for b in placed
    )
    outside = max(frame.x0 - low[0], high[0] - frame.x1, frame.y0 - low[1], high[1] - frame.y1, 0)
    return float(0.35 * covered + 0.2 * shared + 0.05 * outside)


def _lines(ax: Any) -> Array:
    """Points along everything that is drawn as a line, in pixels, some three pixels apart."""
    found = []
    for line in ax.lines:
        data = line.get_data_3d() if hasattr(line, "get_data_3d") else line.get_data()
        points = np.array([np.ravel(d) for d in data], dtype=float).T
        if line.get_transform() != ax.transData or not np.isfinite(points).all():
            continue
        ends = pixels(ax, points)
        for a, b in pairwise(ends):
            n = 2 + int(np.hypot(*(b - a)) / 3)
            found.append(a + np.linspace(0, 1, n)[:, None] * (b - a))
        if len(ends) == 1:
            found.append(ends[0] + np.array([[0, 0], [3, 0], [-3, 0], [0, 3], [0, -3]]))
    return np.vstack(found) if found else np.zeros((0, 2))


def pixels(ax: Any, points: Array) -> Array:
    """Where points of the axes are on the page, in pixels."""
    if getattr(ax, "name", "") == "3d":
        x, y, _ = proj3d.proj_transform(*np.asarray(points).T, ax.get_proj())
        points = np.column_stack([np.asarray(x), np.asarray(y)])
    return np.asarray(ax.transData.transform(points))
