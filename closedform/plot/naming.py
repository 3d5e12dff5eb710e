"""The names in a drawing of a mechanism: of its lengths, its angles and its points."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from closedform.plot.diagram import Diagram
from closedform.plot.robot import Array, Robot
from closedform.plot.sphere import way_through
from closedform.plot.style import GROUND
from closedform.plot.symbols import directions, distances, lengths, symbol

FRAME = 0.13
"""The length of the axes of the base, as a share of the drawing."""
SMALL = 0.03
"""An arm of a joint that is shorter than this part of the drawing is too short for an arc."""
EXACT = 1e-9
"""By how much a cosine of parallel directions differs from 1."""
FLAT = 0.05
"""Angles that are smaller than this have no arc."""
ARC, RADII = 0.09, (0.1, 0.18)
"""How long an arc should be, and between which radii that is tried."""
NEXT = 0.04
"""By how much an arc about the origin is larger than the one before."""
STATIONS = (0.1, 0.07, 0.14, 0.18, 0.22, 0.26, -0.1, -0.14)
"""How far from a joint an arrow about its axis may be."""
LETTER = re.compile(r"[A-Z]\d?")
CLOSE = 0.05
"""Points that are nearer to each other than this have one name."""
DASHED = (0, (2, 2))
Axis = tuple[Array, Array]
"""A point of an axis and its direction."""


@dataclass(frozen=True)
class Drawn:
    """A mechanism in a posture, and where its points and axes are drawn."""

    diagram: Diagram
    r: Robot
    q: Array
    mode: int
    place: Mapping[str, Array]
    along: Mapping[str, Axis]

    @property
    def skeleton(self) -> Any:
        return self.r.module.SKELETON


def name_all(drawn: Drawn, *, faint: Collection[str], lettered: bool) -> None:
    """Name lengths at one of their segments, and angles at arcs, or at arrows about their axes."""
    room = Room(drawn.diagram, np.array([*drawn.place.values()]))
    _name_lengths(drawn, room, faint)
    spins = [name for name in drawn.skeleton.joints if not _named_beside(drawn, name, room)]
    if lettered:
        for name in _lettered(drawn):
            drawn.diagram.label(drawn.place[name], symbol(name), shade=GROUND, size=9)
    for name in spins:
        at, way = drawn.along[name]
        centre = room.beside(at, way)
        drawn.diagram.spin(centre, way, symbol(name, drawn.r))
        room.take(centre)


def _name_lengths(drawn: Drawn, room: Room, faint: Collection[str]) -> None:
    """The lengths of links, rather of those that are not faint, and distances without a link."""
    r, diagram, place, links = drawn.r, drawn.diagram, drawn.place, drawn.skeleton.links
    thin = {p for name, link in links.items() if name in faint for p in link}
    thin -= {p for name, link in links.items() if name not in faint for p in link}
    named = lengths(r, drawn.q, drawn.mode)
    for field, pairs in named.items():
        seen = [p for p in pairs if not {*p} & thin] or pairs
        if r.is_angle(field):
            arcs = [way_through(r, place, p) for p in seen]
            diagram.label(np.array([a[len(a) // 2] for a in arcs]), symbol(field))
            continue
        starts, ends = (np.array([place[p[k]] for p in seen]) for k in (0, 1))
        diagram.dimension(starts, ends, symbol(field))
    for field, spans in distances(r, drawn.q, drawn.mode).items():
        if field not in named:
            span = room.clearest(spans)
            diagram.line(np.array(span), color=GROUND, linewidth=0.9, linestyle=DASHED)
            diagram.dimension(*span, symbol(field))
    for k, (field, ways) in enumerate(directions(r, drawn.q, drawn.mode).items()):
        if field not in named:
            _direction(drawn, room, field, ways[0], RADII[0] + k * NEXT)


def _direction(
    drawn: Drawn, room: Room, field: str, way: tuple[Array, Array, Array], radius: float
) -> None:
    """The angle of a fixed point about the origin, which a line joins to the point."""
    start, axis, point = way
    diagram, zero = drawn.diagram, np.zeros(3)
    turn = float(getattr(drawn.r.params, field)) % (2 * np.pi)
    diagram.line([zero, point], color=GROUND, linewidth=0.9, linestyle=DASHED)
    diagram.angle(zero, start, axis, turn, symbol(field), radius=radius, reference=radius + 0.02)
    room.take(zero)


def _named_beside(drawn: Drawn, name: str, room: Room) -> bool:
    """Name a joint at its slide, at its point or at an arc; whether one of these fits."""
    joint, place = drawn.skeleton.joints[name], drawn.place
    if joint.kind == "prismatic":
        a, b = joint.points
        drawn.diagram.dimension(place[a], place[b], symbol(name, drawn.r))
    elif name not in drawn.along:
        drawn.diagram.label(place[joint.points[0]], symbol(name, drawn.r))
    elif name not in drawn.r.module.JOINTS:
        if not _passive_arc(drawn, name, room):
            drawn.diagram.label(drawn.along[name][0], symbol(name, drawn.r))
    else:
        return len(joint.points) == 1 and _arc(drawn, name, room)
    return True


def _arc(drawn: Drawn, name: str, room: Room) -> bool:
    """Draw the arc of an angle, unless the angle or the arm that shows it is too small."""
    diagram, way = drawn.diagram, drawn.along[name][1]
    foot = drawn.skeleton.joints[name].points[0]
    turn = float(drawn.q[list(drawn.r.module.JOINTS).index(name)])
    turn = float(np.angle(np.exp(1j * turn)))
    beside = {p for link in drawn.skeleton.links.values() if foot in link for p in link}
    arm = _arm(drawn.r, drawn.q, drawn.mode, name, [p for p in beside if p != foot])
    across = arm - way * (arm @ way)
    size = float(np.linalg.norm(across))
    if size < SMALL * diagram.size or abs(turn) < FLAT:
        return False
    back = np.cos(turn) * across - np.sin(turn) * np.cross(way, across)
    radius = float(np.clip(ARC / abs(turn), *RADII))
    at = drawn.place[foot]
    if abs(arm @ way) > SMALL * diagram.size or size < radius * diagram.size:
        end = at + (radius + 0.05) * diagram.size * across / size
        diagram.line([at, end], color=GROUND, linestyle=DASHED)
    text = symbol(name, drawn.r)
    diagram.angle(at, back, way, turn, text, radius=radius, reference=radius + 0.05)
    for part in (0.2, 0.5, 0.8):
        ray = np.cos(part * turn) * back + np.sin(part * turn) * np.cross(way, back)
        room.take(at + radius * diagram.size * ray / size)
    return True


def _passive_arc(drawn: Drawn, name: str, room: Room) -> bool:
    """Draw the arc of a passive angle, if a link has this angle from an axis of the base."""
    at, way = drawn.along[name]
    turn = _passive_angle(drawn, name)
    if turn is None or not FLAT < abs(turn) < np.pi:
        return False
    skeleton = drawn.skeleton
    foot = skeleton.joints[name].points[0]
    lines = [*skeleton.links.values(), *(j.points for j in skeleton.joints.values())]
    for point in dict.fromkeys(p for line in lines if foot in line for p in line):
        arm = drawn.place[point] - drawn.place[foot]
        for axis in (way, -way):  # the sense of a passive joint is not known
            back = np.cos(turn) * arm - np.sin(turn) * np.cross(axis, arm)
            if point != foot and np.max(back) > (1 - EXACT) * np.linalg.norm(back):
                radius = float(np.clip(ARC / abs(turn), *RADII))
                text, reference = symbol(name, drawn.r), radius + 0.05
                drawn.diagram.angle(at, back, axis, turn, text, radius=radius, reference=reference)
                ray = np.cos(turn / 2) * back + np.sin(turn / 2) * np.cross(axis, back)
                room.take(at + radius * drawn.diagram.size * ray / np.linalg.norm(back))
                return True
    return False


def _passive_angle(drawn: Drawn, name: str) -> float | None:
    """The angle of a joint that is not driven, if the module gives it."""
    r = drawn.r
    if name in r.module.TASK and r.modes:
        return float(r.task(drawn.q)[drawn.mode][r.module.TASK.index(name)])
    if not r.has("passive_angles"):
        return None
    joints = [n for n, j in drawn.skeleton.joints.items() if j.kind == "revolute"]
    passive = [n for n in joints if n not in r.module.JOINTS]
    return float(r.call("passive_angles", drawn.q)[drawn.mode][passive.index(name)])


def _lettered(drawn: Drawn) -> list[str]:
    """The points that texts call by a capital letter; of several at one place, the first."""
    diagram, skeleton, place = drawn.diagram, drawn.skeleton, drawn.place
    found = list[str]()
    for name in dict.fromkeys([skeleton.hand, *skeleton.ground, *skeleton.points]):
        seen = [diagram.seen(place[p])[0] for p in (*found, name)]
        near = [np.linalg.norm(p - seen[-1]) < CLOSE * diagram.size for p in seen[:-1]]
        if LETTER.fullmatch(name) and not any(near):
            found.append(name)
    return found


class Room:
    """Where arrows about axes may be: not on joints, nor on other arrows and arcs."""

    def __init__(self, diagram: Diagram, points: Array) -> None:
        self.diagram = diagram
        tips = FRAME * diagram.size * np.eye(3)
        self.kept = diagram.seen(np.vstack([points, tips]))
        self.taken = list[Array]()

    def take(self, centre: Array) -> None:
        self.taken.append(self.diagram.seen(centre)[0])

    def beside(self, at: Array, way: Array) -> Array:
        """The clearest place on an axis, rather near the joint and ahead of it."""
        size = self.diagram.size
        places = at + np.outer(STATIONS, way) * size
        seen = self.diagram.seen(places)
        cost = 3 * np.abs(np.array(STATIONS) - STATIONS[0]) + self._near(seen, self.kept, 0.06)
        if self.taken:
            cost += 3 * self._near(seen, np.array(self.taken), 0.085)
        return np.asarray(places[np.argmin(np.round(cost, 6))])

    def clearest(self, spans: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
        """Of several segments, the one that is farthest from the axes of the base."""
        axes = self._ways(np.eye(3)[: 3 if self.diagram.spatial else 2])
        ways = self._ways(np.array([b - a for a, b in spans]))
        return spans[int(np.argmin(np.round((ways @ axes.T).max(1), 6)))]

    def _ways(self, vectors: Array) -> Array:
        seen = self.diagram.seen(vectors)
        sizes = np.linalg.norm(seen, axis=1, keepdims=True)
        return np.asarray(seen / np.maximum(sizes, 1e-12))

    def _near(self, seen: Array, others: Array, reach: float) -> Array:
        gaps = np.linalg.norm(seen[:, None] - others, axis=-1) / self.diagram.size
        return np.asarray(np.clip(1 - gaps / reach, 0, None).sum(-1))


def _arm(r: Robot, q: Array, mode: int, name: str, beside: list[str]) -> Array:
    """From a joint to the end of the link that it turns; zero where nothing beside it moves."""
    names = r.module.SKELETON.points
    step = 1e-4 * np.eye(len(q))[list(r.module.JOINTS).index(name)]
    here, moved = r.points(q)[mode], r.points(q + step)[mode]
    foot = r.module.SKELETON.joints[name].points[0]
    best = np.zeros(3)
    for point in sorted(beside, key=names.index):
        k = names.index(point)
        gap = here[k] - here[names.index(foot)]
        if np.linalg.norm(moved[k] - here[k]) > 1e-7 * r.size and best @ best < gap @ gap:
            best = gap
    return best
