"""Drawings of a mechanism: one posture, or all postures that reach a target."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from itertools import combinations
from types import MappingProxyType, ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from closedform.plot.axes import joint_axes
from closedform.plot.diagram import Diagram
from closedform.plot.labels import Layout
from closedform.plot.labels import place as place_labels
from closedform.plot.naming import FRAME, Drawn, name_all
from closedform.plot.robot import OK, Array, Robot
from closedform.plot.sphere import on_sphere, way_through
from closedform.plot.style import GROUND, colour, new_axes, new_panels, styled
from closedform.plot.symbols import symbol

NO_HUES: Mapping[str, int] = MappingProxyType({})
CENTRED = 2.5
"""How much larger axes and arcs are where all joints are at one point."""
WRIST = 3
"""If branches look alike, they differ in the axes of these last joints."""
UNDER_A_TITLE = 0.84
"""The share of its panel that a drawing in space fills: it must not reach into the title."""
TITLE = {2: 11, 4: 15}
"""The size of the names of branches, by columns: a page is as wide as both."""
NEARLY = 0.4
"""Branches that are so far apart, as a share of what is possible, are told apart well."""
PAST = 0.07
"""How far the rail of a slider leads past it, as a share of the drawing."""
OVERLAID = 2
"""More branches than this are drawn side by side."""


@styled
def mechanism(
    robot: ModuleType,
    q: ArrayLike | None = None,
    *,
    x: ArrayLike | None = None,
    params: Any = None,
    mode: int | None = None,
    ax: Any = None,
    labels: bool = True,
    lettered: bool = True,
    axes: bool = True,
    faint: Collection[str] = (),
    hues: Mapping[str, int] = NO_HUES,
) -> Any:
    """Draw a mechanism in one posture, with the axes of its joints, its lengths and angles.

    Parameters
    ----------
    robot
        a generated module
    q
        the joints, (joints,); by default a posture that is far from singular
    x
        the target, only for a mechanism without a forward map, where ``q`` needs it
    params
        the dimensions; by default those of the example
    mode
        the assembly mode, for mechanisms that have several; by default the first that is not
        singular
    ax
        the axes to draw on, with a 3D projection unless the mechanism is planar
    labels
        whether lengths, angles and the frame of the base are shown and named
    lettered
        whether points are named too, if a letter names them
    axes
        whether the axes of joints in space are shown
    faint
        links that are drawn thinner, such as those of an equivalent mechanism
    hues
        the number of the colour of links that have one of their own, such as those of a leg
    """
    r = Robot.of(robot, params)
    r = r if q is not None and x is None else _posed(r, x)
    joints = _first(r) if q is None else np.asarray(q, dtype=float)
    if joints.shape != (len(robot.JOINTS),):
        raise ValueError(f"q must have the shape ({len(robot.JOINTS)},), not {joints.shape}")
    mode = r.first_mode(joints) if mode is None else mode
    points = r.points(joints)[mode]
    if not np.isfinite(points).all():
        modes = [r.modes[k] for k in r.modes_at(joints)]
        raise ValueError(
            f"{r.name} cannot be assembled at {joints.tolist()} in mode {mode}; "
            f"modes that exist there: {', '.join(modes) or 'none'}"
        )
    ax = new_axes(not r.flat) if ax is None else ax
    points = on_sphere(r, points)
    along = joint_axes(r, joints, mode=mode)
    diagram = Diagram(ax, extent([points]) * (CENTRED if _meet(r, along) else 1))
    draw(
        diagram,
        r,
        points,
        colour(0),
        along=along if axes else {},
        faint=faint,
        hues=hues,
    )
    shown = [points, *_past_blocks(diagram, r, points)]
    if axes and diagram.spatial:
        shown += _show_axes(diagram, along)
    if labels:
        place = dict(zip(robot.SKELETON.points, points, strict=True))
        drawn = Drawn(diagram, r, joints, mode, place, along)
        name_all(drawn, faint=faint, lettered=lettered)
        shown.append(_base_frame(diagram, r, points))
    diagram.clean(shown)
    _settle(ax)
    return ax


def _posed(r: Robot, x: ArrayLike | None) -> Robot:
    """The same with the pose of its hand, unless a forward map gives it."""
    if r.has_forward_map:
        return r
    return replace(r, target=regular_target(r) if x is None else np.asarray(x, dtype=float))


def _first(r: Robot) -> Array:
    """A posture that is far from singular, or the first one for the pose of the hand."""
    if r.has_forward_map:
        return r.posture()
    q, status = r.branches(r.target)
    if not (status == OK).any():
        raise ValueError(f"{r.name} reaches the target {r.target.tolist()} in no branch")
    return np.asarray(q[np.argmax(status == OK)])


def _settle(ax: Any) -> None:
    """Place the labels now on a figure that is not of this package; others do it when drawn."""
    if not isinstance(ax.figure.get_layout_engine(), Layout):
        ax.figure.draw_without_rendering()
        place_labels(ax.figure)


def posture(robot: ModuleType, *, params: Any = None) -> Array:
    """Joints far from singular at which the mechanism can be assembled, always the same."""
    return Robot.of(robot, params).posture()


@styled
def branches(
    robot: ModuleType,
    x: ArrayLike | None = None,
    *,
    params: Any = None,
    given: float | None = None,
    general: ArrayLike | None = None,
    mode: int = 0,
    ax: Any = None,
    faint: Collection[str] = (),
) -> Any:
    """Draw all postures that reach a target, one colour a branch.

    Parameters
    ----------
    robot
        a generated module with an inverse
    x
        the target, as ``ik`` takes it; by default one that most branches reach
    params, faint
        as in :func:`mechanism`
    given
        the joint or the arm angle that an arm of seven joints takes besides the target; by default
        that of a regular posture
    general, mode
        joints and an assembly mode whose image is the target, unless another one shows the
        branches better
    ax
        the axes to draw all branches on; by default more than two are drawn side by side, with
        the others behind each in grey, and the axes of the first are returned
    """
    r = Robot.of(robot, params, given)
    r.require("ik")
    if x is None:
        x = regular_target(r, general, mode)
    r = _posed(r, x)
    q, status = r.branches(x)
    if status.shape != (len(robot.BRANCHES),):
        raise ValueError(f"x must be one target of {r.name}, not {np.shape(x)}")
    found = {
        name: on_sphere(r, r.points(q[k])[r.mode_that_reaches(q[k], x)])
        for k, name in enumerate(robot.BRANCHES)
        if status[k] == OK
    }
    if not found:
        raise ValueError(f"{r.name} reaches the target {np.asarray(x).tolist()} in no branch")
    frame = [np.vstack(list(found.values()))]
    names = list(robot.BRANCHES)
    alike = len(found) > 1 and any(
        np.allclose(p, frame[0][: len(p)]) for p in [*found.values()][1:]
    )
    if ax is not None or (len(found) <= OVERLAID and not alike):
        ax = new_axes(not r.flat) if ax is None else ax
        diagram = Diagram(ax, extent(frame))
        for name, points in found.items():
            shade = colour(names.index(name))
            draw(diagram, r, points, shade, label=spoken(name), faint=faint)
            frame += _past_blocks(diagram, r, points)
        diagram.clean([*frame, _base_frame(diagram, r, frame[0])])
        if len(names) > 1:
            ax.figure.legend(loc="outside lower center", ncols=min(len(found), 4))
        _settle(ax)
        return ax
    columns = 4 if len(found) > 4 else 2
    rows = -(-len(found) // columns)
    panels = new_panels(rows, columns, spatial=not r.flat, size=(2.35 * columns, 2.3 * rows))
    for panel in panels[len(found) :]:
        panel.set_axis_off()
    for panel, name in zip(panels, found, strict=False):
        along = joint_axes(r, q[names.index(name)]) if alike else {}
        diagram = Diagram(panel, extent(frame) * (CENTRED if _meet(r, along) else 1))
        others = [points for other, points in found.items() if other != name]
        diagram.link(_outlines(r, others), "#dddddd", linewidth=1.0)
        along = dict(list(along.items())[-WRIST:])
        draw(
            diagram, r, found[name], colour(names.index(name)), width=2.2, faint=faint,
            along=along,
        )  # fmt: skip
        ends = _show_axes(diagram, along)
        for points in found.values():
            ends += _past_blocks(diagram, r, points)
        diagram.clean([*frame, *ends], margin=0.02, filling=UNDER_A_TITLE)
        panel.set_title(spoken(name), fontsize=TITLE[columns], y=1.0)
    return panels[0]


def _outlines(r: Robot, postures: list[Array]) -> Array:
    """The links of several postures as one line, with gaps between them."""
    names = r.module.SKELETON.points
    gap = np.full((1, 3), np.nan)
    ways = [*r.module.SKELETON.links.values()]
    ways += [j.points for j in r.module.SKELETON.joints.values() if j.kind == "prismatic"]
    parts = [
        part
        for points in postures
        for way in ways
        for part in (way_through(r, dict(zip(names, points, strict=True)), way), gap)
    ]
    return np.vstack(parts)


def spoken(name: str) -> str:
    """The name of a branch in words, with the joints in it as formulas."""
    words = name.split("_")
    return " ".join(symbol(w) if w[-1:].isdigit() else w for w in words)


def extent(drawn: list[Array]) -> float:
    """The diagonal of the box around points: the scale of a drawing."""
    everything = np.vstack([*drawn, np.zeros((1, 3))])
    return float(np.linalg.norm(np.nanmax(everything, axis=0) - np.nanmin(everything, axis=0)))


def regular_target(r: Robot, general: ArrayLike | None = None, mode: int = 0) -> Array:
    """The image of a posture: of those that the most branches reach, the one that shows them best.

    That of a ``general`` posture is taken if it shows them nearly as well.
    """
    if not r.has_forward_map:
        x = r.poses(200)
        q, status = r.branches(x)
        reached = (status == OK).sum(-1)
        x, q = x[reached == reached.max()], q[reached == reached.max()]
        far = np.abs(np.asarray(r.call("singularities", x[:, None], q))[..., -1]).max(-1)
        return np.asarray(x[np.argmax(np.where(np.isfinite(far), far, 0.0))])
    first = r.posture() if general is None else np.asarray(general, dtype=float)
    q = np.vstack([first, r.draw(60, seed=1)])
    x = r.task(q)
    if r.modes:
        regular = (np.asarray(r.call("fk", q).status) == OK).any(axis=0).tolist()
        x = x[:, mode if regular[mode] or True not in regular else regular.index(True)]
    finite = np.isfinite(x.reshape(len(x), -1)).all(1)
    found, status = r.branches(np.where(np.isfinite(x), x, 0.0))
    reached = np.where(finite, (status == OK).sum(-1), -1)
    most = np.flatnonzero(reached == reached.max())
    apart = [_apart(r, found[k][status[k] == OK], x[k]) for k in most]
    if most[0] == 0 and apart[0] >= NEARLY * max(apart):
        return np.asarray(x[0])
    return np.asarray(x[most[np.argmax(np.round(apart, 6))]])


def _apart(r: Robot, postures: Array, x: Array) -> float:
    """How far the two most similar of some postures are apart, as a share of the drawing."""
    seen = [r.points(q)[r.mode_that_reaches(q, x)] for q in postures]
    gaps = [np.linalg.norm(a - b, axis=-1).max() for a, b in combinations(seen, 2)]
    return float(min(gaps) / extent(seen)) if gaps else 0.0


def draw(
    diagram: Diagram,
    r: Robot,
    points: Array,
    shade: str,
    *,
    along: Mapping[str, tuple[Array, Array]] | None = None,
    label: str = "",
    width: float = 2.6,
    faint: Collection[str] = (),
    hues: Mapping[str, int] = NO_HUES,
) -> None:
    """The links, the joints and the hand of one posture.

    Parameters
    ----------
    diagram
        what it is drawn on
    r
        the mechanism
    points
        those of its skeleton
    shade
        the colour
    along
        the place and the direction of the axis of each joint that turns
    label
        what the legend calls it
    width
        that of the links, in points
    faint, hues
        as in :func:`mechanism`
    """
    skeleton = r.module.SKELETON
    place = dict(zip(skeleton.points, points, strict=True))
    named: dict[str, Any] = {"label": label} if label else {}
    for name, link in skeleton.links.items():
        hue = colour(hues[name]) if name in hues else shade
        style: dict[str, Any] = {"linewidth": width, "color": hue}
        if name == "ground" or set(link) <= set(skeleton.ground):
            style = {"linewidth": 1.6, "color": GROUND}
        elif name in faint:
            style |= {"linewidth": 0.5 * width, "linestyle": (0, (4, 1.5)), "alpha": 0.75}
        elif named:
            style |= named
            named = {}
        diagram.link(way_through(r, place, link), **style)
    for name, joint in skeleton.joints.items():
        ends = np.array([place[p] for p in joint.points])
        if joint.kind == "prismatic":
            (_rail if name in r.rails else _slide)(diagram, ends, shade, width, named)
            named = {}
    pivots = _pivots(r, diagram)
    if free := [place[point] for point in _passive(skeleton, pivots, r.module.JOINTS)]:
        diagram.passive(free, shade, 1.4 * width)
    for name in pivots:
        _, way = (along or {}).get(name, (None, None))
        diagram.revolute(place[skeleton.joints[name].points[0]], shade, axis=way)
    diagram.hand(place[skeleton.hand], shade)


def _pivots(r: Robot, diagram: Diagram) -> list[str]:
    """The joints that have a symbol: in a plane those that are driven or on the ground."""
    skeleton = r.module.SKELETON
    return [
        name
        for name, joint in skeleton.joints.items()
        if joint.kind == "revolute"
        and (diagram.spatial or name in r.module.JOINTS or joint.points[0] in skeleton.ground)
    ]


def _passive(skeleton: Any, pivots: Collection[str], driven: Collection[str]) -> list[str]:
    """The points where links meet that have no other symbol: what turns freely there.

    A passive slide counts as a link to the body at its far end, such as to one on a ball.
    """
    slides = {n: j.points for n, j in skeleton.joints.items() if j.kind == "prismatic"}
    passive = [set(points) for name, points in slides.items() if name not in driven]
    known = {p for name in pivots for p in skeleton.joints[name].points} | {skeleton.hand}
    known |= {p for n, points in slides.items() for p in (points if n in driven else points[:1])}
    links = [*(set(link) for link in skeleton.links.values()), *passive]
    met = [p for p in skeleton.points if sum(p in link for link in links) > 1]
    return [p for p in met if p not in known]


def _slide(diagram: Diagram, ends: Array, shade: str, width: float, named: dict[str, Any]) -> None:
    """A slide: a wide sleeve, and the rod that comes out of it."""
    a, b = ends
    diagram.link(ends, shade, linewidth=0.6 * width, **named)
    sleeve = [a + 0.1 * (b - a), a + 0.5 * (b - a)]
    diagram.link(sleeve, shade, linewidth=2.6 * width, solid_capstyle="butt")
    diagram.link(sleeve, "white", linewidth=1.6 * width, solid_capstyle="butt")


def _rail(diagram: Diagram, ends: Array, shade: str, width: float, named: dict[str, Any]) -> None:
    """A block on a fixed line, which leads a little past it; links are drawn over the block."""
    a, b = ends
    way = _past(diagram, a, b) / PAST
    diagram.link([a, b + PAST * way], GROUND, linewidth=0.6 * width, zorder=1)
    for half, wide, hue in ((0.04, 4.4, shade), (0.035, 3.6, "white")):
        block = [b - half * way, b + half * way]
        style = {"linewidth": wide * width, "solid_capstyle": "butt", "zorder": 2}
        diagram.link(block, hue, **style, **named)
        named = {}


def _past(diagram: Diagram, a: Array, b: Array) -> Array:
    """How far a rail from one point leads past another."""
    way: Array = (b - a) / max(float(np.linalg.norm(b - a)), 1e-300)
    return PAST * diagram.size * way


def _past_blocks(diagram: Diagram, r: Robot, points: Array) -> list[Array]:
    """The ends of the rails in a posture."""
    joints = r.module.SKELETON.joints
    place = dict(zip(r.module.SKELETON.points, points, strict=True))
    rails = [[place[p] for p in joints[name].points] for name in r.rails]
    return [np.atleast_2d(b + _past(diagram, a, b)) for a, b in rails]


def _show_axes(diagram: Diagram, along: Mapping[str, tuple[Array, Array]]) -> list[Array]:
    """The axis of each revolute joint; joints that share theirs have one line."""
    ends: list[Array] = []
    seen: list[tuple[Array, Array]] = []
    for at, way in along.values():
        if any(
            np.linalg.norm(np.cross(at - p, w)) < 1e-6 * diagram.size and abs(way @ w) > 1 - 1e-9
            and np.linalg.norm(at - p) < 1e-6 * diagram.size
            for p, w in seen
        ):  # fmt: skip
            continue
        seen.append((at, way))
        end = diagram.axis(at, way)
        ends.append(np.array([end]))
    return ends


def _meet(r: Robot, along: Mapping[str, tuple[Array, Array]]) -> bool:
    """Whether several joints are all at one point, so that only their axes tell them apart."""
    joints = r.module.SKELETON.joints
    places = [at for name, (at, _) in along.items() if joints[name].kind == "revolute"]
    return len(places) > 1 and bool(np.ptp(places, axis=0).max() < 1e-9)


def _base_frame(diagram: Diagram, r: Robot, points: Array) -> Array:
    """The frame of the base at the origin, or beside the drawing if that is too crowded."""
    diagram.frame(np.zeros(3), reach=FRAME)
    return np.vstack([np.zeros(3), FRAME * diagram.size * np.eye(3)])
