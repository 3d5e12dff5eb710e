"""Links of spherical mechanisms, which are drawn as arcs on one sphere."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from closedform.plot.robot import Array, Robot


def on_sphere(r: Robot, points: Array) -> Array:
    """The points of a spherical mechanism, moved along their radii to one sphere; others as is."""
    if not r.centre:
        return points
    centre = points[r.module.SKELETON.points.index(r.centre)]
    ways = points - centre
    far = np.linalg.norm(ways, axis=1, keepdims=True)
    moved = centre + far.max() * ways / np.where(far > 0, far, 1)
    return np.asarray(moved)


def way_through(r: Robot, place: Mapping[str, Array], link: Sequence[str]) -> Array:
    """The line of a link: straight, or arcs of great circles of a spherical mechanism."""
    points = [place[p] for p in link]
    if not r.centre:
        return np.array(points)
    centre, parts = place[r.centre], [points[:1]]
    for a, b in pairwise(points):
        u, v = a - centre, b - centre
        size = float(np.linalg.norm(u) * np.linalg.norm(v))
        angle = float(np.arccos(np.clip(u @ v / size, -1, 1))) if size else 0.0
        if angle < 1e-6 or angle > np.pi - 1e-6:
            parts.append([b])
            continue
        s = np.linspace(0, 1, max(3, int(angle * 18)))[1:, None]
        arc = (np.sin((1 - s) * angle) * u + np.sin(s * angle) * v) / np.sin(angle)
        parts.append(list(centre + arc))
    return np.vstack(parts)
