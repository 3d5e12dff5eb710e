"""The strokes of a drawing: links, joints, axes, angles and labels, in the plane and in space."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot import labels
from closedform.plot.robot import Array
from closedform.plot.style import COLOURS, GROUND, INK

AXIS = "#9a9a9a"
ANGLE = COLOURS[1]
ALONG = (0.5, 0.3, 0.7)
"""Where a label may stand beside an arc, as shares of it."""
MIDDLE = (0.5, 0.35, 0.65)
"""Where a label may stand beside a segment, as shares of it."""


@dataclass(frozen=True)
class Diagram:
    """Draws on axes; ``size`` is the length that joints, arcs and arrows are measured in."""

    ax: Any
    size: float

    @property
    def spatial(self) -> bool:
        return getattr(self.ax, "name", "") == "3d"

    def _here(self, points: ArrayLike) -> Array:
        """Points as the axes take them; a drawing in the plane drops their third coordinate."""
        found = np.atleast_2d(np.asarray(points, dtype=float))
        wanted = 3 if self.spatial else 2
        if found.shape[1] < wanted:
            found = np.column_stack([found, np.zeros(len(found))])
        return np.asarray(found[:, :wanted])

    def line(self, points: ArrayLike, **style: Any) -> None:
        style = {
            "color": INK,
            "linewidth": 0.8,
            "solid_capstyle": "round",
            "zorder": 2,
            "clip_on": False,
            "in_layout": False,
        } | style
        self.ax.plot(*self._here(points).T, **style)

    def link(self, points: ArrayLike, shade: str = COLOURS[0], **style: Any) -> None:
        self.line(points, **({"color": shade, "linewidth": 2.6, "zorder": 3} | style))

    def revolute(self, at: ArrayLike, shade: str = INK, *, axis: Array | None = None) -> None:
        """A joint: a circle, in space with a short cylinder along its axis."""
        if self.spatial and axis is not None:
            ends = np.asarray(at) + np.outer([-0.028, 0.028], axis) * self.size
            self.line(ends, color=shade, linewidth=8, solid_capstyle="butt", zorder=4)
        self.ax.plot(
            *self._here(at).T, "o", color="white", markeredgecolor=shade,
            markersize=5 if self.spatial else 6.5, markeredgewidth=1.3, zorder=5,
        )  # fmt: skip

    def passive(self, at: ArrayLike, shade: str = INK, size: float = 3.6) -> None:
        """Joints without a drive: small circles."""
        self.ax.plot(
            *self._here(at).T, "o", color="white", markeredgecolor=shade, markersize=size,
            markeredgewidth=0.9, zorder=4, linestyle="none",
        )  # fmt: skip

    def hand(self, at: ArrayLike, shade: str = COLOURS[0]) -> None:
        self.ax.plot(*self._here(at).T, "D", color=shade, markersize=4.5, zorder=6)

    def point(self, at: ArrayLike, shade: str = INK) -> None:
        self.ax.plot(*self._here(at).T, "o", color=shade, markersize=3, zorder=6)

    def ground(
        self, at: ArrayLike, across: ArrayLike = (1, 0, 0), down: ArrayLike = (0, -1, 0)
    ) -> None:
        """The sign of a fixed point: a line with short strokes below it."""
        a, d = (np.asarray(v, dtype=float) * self.size for v in (across, down))
        foot = np.asarray(at, dtype=float)
        foot = np.append(foot, 0.0) if foot.size < 3 else foot
        foot = foot + 0.022 * d
        self.line([foot - 0.06 * a, foot + 0.06 * a], color=GROUND, linewidth=1.1)
        for s in np.linspace(-0.05, 0.055, 5):
            start = foot + s * a
            self.line([start, start - 0.02 * a + 0.025 * d], color=GROUND, linewidth=0.7)

    def arrow(
        self, start: ArrayLike, end: ArrayLike, *, shade: str = INK, width: float = 0.9,
        head: float = 0.03, **style: Any,
    ) -> None:  # fmt: skip
        """A line with a head at its end."""
        a, b = self._here(start)[0], self._here(end)[0]
        self.line([a, b], color=shade, linewidth=width, **style)
        self._head(b, b - a, shade, width, head)

    def _head(self, at: Array, along: Array, shade: str, width: float, head: float) -> None:
        n = along / max(float(np.linalg.norm(along)), 1e-300)
        side = np.array([-n[1], n[0]]) if len(n) == 2 else self._across(n)
        back = at - head * self.size * n
        wings = [back + s * 0.36 * head * self.size * side for s in (1, -1)]
        self.line([wings[0], at, wings[1]], color=shade, linewidth=width, solid_joinstyle="miter")

    def _across(self, along: Array) -> Array:
        """A direction across a line that is seen at its full length."""
        e, a = np.radians(self.ax.elev), np.radians(self.ax.azim)
        seen = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
        side = np.cross(along, seen)
        size = float(np.linalg.norm(side))
        return side / size if size > 1e-9 else np.array([0.0, 0.0, 1.0])

    def axis(self, at: ArrayLike, along: ArrayLike, text: str = "", reach: float = 0.17) -> Array:
        """A dash-dotted line along an axis with an arrow in its direction; returns its end."""
        way = np.asarray(along, dtype=float) * self.size
        foot, end = np.asarray(at) - 0.4 * reach * way, np.asarray(at) + reach * way
        self.line([foot, end], color=AXIS, linestyle=(0, (7, 2, 1.5, 2)), linewidth=0.8, zorder=1)
        self._head(self._here(end)[0], self._here(way)[0], AXIS, 0.8, 0.022)
        if text:
            self.label(end, text, shade="#6a6a6a")
        return np.asarray(end)

    def angle(
        self, at: ArrayLike, start: ArrayLike, axis: ArrayLike, turn: float, text: str = "", *,
        radius: float = 0.1, shade: str = ANGLE, reference: float = 0.16,
    ) -> None:  # fmt: skip
        """An angle: the arc from a direction by a turn about an axis, and where it starts.

        Parameters
        ----------
        at
            its centre
        start, axis, turn
            the direction where it starts, and the turn about the axis in rad
        text
            its name
        radius
            that of the arc, as a share of the drawing
        shade
            its colour
        reference
            the length of the line in the direction where it starts, as a share of the drawing
        """
        foot, way, n = (self._three(v) for v in (at, start, axis))
        way = way - n * (way @ n)
        way = way / np.linalg.norm(way)
        side = np.cross(n, way)
        s = np.linspace(0, turn, max(8, int(abs(turn) * 24)))
        arc = foot + radius * self.size * (np.outer(np.cos(s), way) + np.outer(np.sin(s), side))
        if reference:
            ends = [foot, foot + reference * self.size * way]
            self.line(ends, color=GROUND, linestyle=(0, (2, 2)), linewidth=0.8)
        self.line(arc, color=shade, linewidth=1.0, zorder=4)
        if radius * abs(turn) > 0.03:
            tangent = np.sign(turn) * (np.cos(turn) * side - np.sin(turn) * way)
            chord = tangent - 0.012 / radius * (np.cos(turn) * way + np.sin(turn) * side)
            self._head(self._here(arc[-1])[0], self._here(chord)[0], shade, 1.0, 0.024)
        if text:
            beside = arc[[int(part * (len(arc) - 1)) for part in ALONG]]
            self.label(beside, text, shade=shade, centre=foot)

    def spin(self, at: ArrayLike, axis: ArrayLike, text: str = "", radius: float = 0.035) -> None:
        """An arrow most of the way about an axis: the sense of an angle that has no arm to show."""
        n = self._three(axis)
        start = self._across(n) if self.spatial else np.array([1.0, 0.0, 0.0])
        self.angle(at, start, n, 1.5 * np.pi, text, radius=radius, reference=0)

    @staticmethod
    def _three(vector: ArrayLike) -> Array:
        found = np.asarray(vector, dtype=float)
        return np.append(found, 0.0) if found.size == 2 else found

    def dimension(self, a: ArrayLike, b: ArrayLike, text: str) -> None:
        """The name of a length, near the middle of its segment; of several, at the clearest."""
        start, end = self._three(a), self._three(b)
        self.label(np.vstack([start + part * (end - start) for part in MIDDLE]), text)

    def seen(self, points: ArrayLike) -> Array:
        """Where points are in the picture, to the right and upwards, in units of the mechanism."""
        here = self._here(points)
        if not self.spatial:
            return here
        e, a = np.radians(self.ax.elev), np.radians(self.ax.azim)
        right = [-np.sin(a), np.cos(a), 0.0]
        up = [-np.sin(e) * np.cos(a), -np.sin(e) * np.sin(a), np.cos(e)]
        return np.asarray(here @ np.transpose([right, up]))

    def frame(
        self, at: ArrayLike, turn: ArrayLike | None = None, names: Sequence[str] = ("x", "y", "z"),
        reach: float = 0.14, shade: str = INK,
    ) -> None:  # fmt: skip
        """The axes of a frame."""
        R = np.eye(3) if turn is None else np.asarray(turn, dtype=float)
        for k, name in enumerate(names):
            if not name or (k == 2 and not self.spatial):
                continue
            end = self._three(at) + reach * self.size * R[:, k]
            self.arrow(self._three(at), end, shade=shade, width=0.9, head=0.028)
            self.label(end, f"${name}$" if not name.startswith("$") else name, shade=shade)

    def label(
        self, at: ArrayLike, text: str, *, shade: str = INK, size: float = 10,
        centre: ArrayLike | None = None,
    ) -> None:  # fmt: skip
        """A text beside a point or one of several, where it covers the least.

        If they are on an arc about a ``centre``, it is rather outside.
        """
        here = self._here(at)
        note = self.ax.text(*here[0], text, color=shade, fontsize=size, zorder=9)
        labels.add(self.ax, note, here, None if centre is None else self._here(centre)[0])

    def _share(self, points: Array) -> float:
        """How much of the width or the height of the axes some points in space take."""
        seen = labels.pixels(self.ax, points)
        return float(2 * np.nanmax(np.abs(self.ax.transAxes.inverted().transform(seen) - 0.5)))

    def clean(
        self,
        drawn: Sequence[Array],
        margin: float = 0.06,
        zoom: float = 1.15,
        filling: float | None = None,
    ) -> None:
        """Show exactly what is drawn, at equal scales and without the axes of a plot.

        A drawing in space is enlarged by ``zoom``, over the edge of the axes if it is tall, or
        until it is as large as the share ``filling`` of the axes.
        """
        seen = [self._here(d) for d in drawn]
        if not self.spatial:  # in the plane also what is drawn beside it, such as arcs
            seen += [line.get_xydata() for line in self.ax.lines]
        everything = np.vstack(seen)
        low, high = np.nanmin(everything, axis=0), np.nanmax(everything, axis=0)
        low, high = low - margin * self.size, high + margin * self.size
        self.ax.set_axis_off()
        if self.spatial:
            for k, name in enumerate("xyz"):
                getattr(self.ax, f"set_{name}lim")(low[k], high[k])
            self.ax.set_box_aspect(high - low, zoom=zoom)
            if filling is not None:
                share = self._share(everything)
                self.ax.set_box_aspect(high - low, zoom=zoom * filling / share)
        else:
            self.ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
            self.ax.set_aspect("equal")
