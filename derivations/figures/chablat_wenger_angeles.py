"""The figures of Chablat, Wenger and Angeles: the five-bar linkage and its revolute."""

from types import ModuleType
from typing import Any

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from closedform import puma560
from closedform.plot import Diagram, colour, new_axes, new_panels, styled
from closedform.plot.catalogue import Figure, PaperFigures
from closedform.plot.contours import curves, region
from closedform.plot.postures import mechanism

NAME = "hybrid_five_bar"
CONVEX, NON_CONVEX = "plus_minus_plus", "plus_plus_plus"
ABOVE = ("plus_minus_plus", "plus_plus_plus", "plus_minus_minus", "plus_plus_minus")
"""The four working modes for P above AB, in the order of Figure 4 as far as the text tells."""
PALE = "#d6e4f0"
GRID = 900


def plane(points: np.ndarray, theta1: float = 0.0) -> np.ndarray:
    """Points of the skeleton in the plane of the linkage: along AB, and away from it."""
    away = -points[..., 0] * np.cos(theta1) + points[..., 2] * np.sin(theta1)
    return np.stack([points[..., 1], away], axis=-1)


def section(y: Any, away: Any) -> np.ndarray:
    """Targets in the section at theta1 = 0, from coordinates in the plane of the linkage."""
    y, away = np.broadcast_arrays(y, away)
    return np.stack([-away, y, np.zeros_like(y)], axis=-1)


def in_mode(robot: ModuleType, x: np.ndarray, branch: str, params: Any) -> tuple[Any, Any]:
    """The joints of a working mode, and the assembly mode in which they reach the targets."""
    found = robot.ik(x, params)
    k = robot.BRANCHES.index(branch)
    good = found.status[..., k] <= robot.Status.SINGULAR
    q = np.where((good & (found.status[..., k] != robot.Status.UNREACHABLE))[..., None],
                 found.q[..., k, :], np.nan)  # fmt: skip
    p = robot.fk(q, params).p
    gap = np.abs(p - x[..., None, :]).max(-1)
    return q, np.argmin(np.where(np.isfinite(gap), gap, np.inf), axis=-1)


def of_mode(values: np.ndarray, mode: Any) -> np.ndarray:
    """The values of one assembly mode, whose axis is the second but last."""
    mode = np.asarray(mode)
    axes = (*mode.shape, 1, 1)
    return np.take_along_axis(values, mode.reshape(axes), axis=mode.ndim)[..., 0, :]


def bars(d: Diagram, at: np.ndarray, shade: str, width: float = 2.6) -> None:
    """The linkage in its plane; ``at`` has A, B, C, D, P."""
    A, B, C, D, P = at
    d.line([A, B], color="#6b6b6b", linewidth=1.4)
    for link in ((A, C, P), (B, D, P)):
        d.link(link, shade, linewidth=width)
    for pivot in (A, B):
        d.ground(pivot)
    for joint in at[:4]:
        d.revolute(joint, shade)
    d.hand(P, shade)


def linkage(
    robot: ModuleType, ax: Any, P: Any, branch: str, *, params: Any = None, names: bool = True,
    shade: str = colour(0),
) -> tuple[Diagram, np.ndarray]:  # fmt: skip
    """The linkage with its hand at a point of the plane.

    Parameters
    ----------
    robot
        the generated module
    ax
        the axes to draw on
    P
        the point
    branch
        the name of the working mode
    params
        the dimensions; by default those of the example
    names
        whether the points are named
    shade
        the colour
    """
    params = robot.Parameters() if params is None else params
    q, mode = in_mode(robot, section(*P), branch, params)
    at = plane(robot.skeleton(q, params)[mode])
    d = Diagram(ax, 1.3 * float(params.L1 + params.L2))
    bars(d, at, shade)
    if names:
        for point, name in zip(at, "ABCDP", strict=True):
            d.label(point, f"${name}$")
    d.clean([at], margin=0.09)
    return d, at


@styled
def elbow(robot: ModuleType) -> Any:
    """Figure 1: the first three joints of a Puma 560 without its offsets."""
    ax = new_axes(True, (3.6, 3.2))
    params = puma560.Parameters(d3=0.0, a3=0.0)
    q = np.radians([-35, 140, -55, 0, 0, 0])
    at = puma560.skeleton(q, params)
    base, elbow_at, hand = at[0], at[1], at[-1]
    d = Diagram(ax, 0.9)
    z, side = np.array([0, 0, 1.0]), np.array([-np.sin(q[0]), np.cos(q[0]), 0])
    foot = base - 0.3 * z
    d.link([foot, base], "#6b6b6b")
    d.link([base, elbow_at, hand])
    d.axis(foot + 0.1 * z, z, reach=0.1)
    for point, axis in ((foot + 0.12 * z, z), (base, side), (elbow_at, side)):
        d.revolute(point, axis=axis)
    for point, axis in ((base, side), (elbow_at, side)):
        d.axis(point, axis, reach=0.14)
    d.hand(hand)
    d.dimension(base, elbow_at, "$L_1$")
    d.dimension(elbow_at, hand, "$L_2$")
    d.clean([at, foot[None]])
    return ax


@styled
def closed_chain(robot: ModuleType) -> Any:
    """Figure 2: the linkage with its angles and lengths."""
    ax = new_axes(False, (4.4, 3.9))
    d, at = linkage(robot, ax, (4.6, 11.0), CONVEX, names=True)
    A, B, C, D, P = at
    for a, b, name in ((A, B, "L_0"), (A, C, "L_1"), (C, P, "L_2"), (B, D, "L_3"), (D, P, "L_4")):
        d.dimension(a, b, f"${name}$")
    along = np.array([1.0, 0, 0])
    for joint, foot, end in ((2, A, C), (3, B, D), (4, C, P), (5, D, P)):
        way = end - foot
        turn = float(np.arctan2(way[1], way[0]))
        d.angle(foot, along, (0, 0, 1), turn, rf"$\theta_{joint}$", radius=0.09)
    d.frame(A - np.array([0, 3.0]), names=("y", r"\rho", ""), reach=0.1)
    d.clean([at, A[None] - [0, 2.4], D[None] + [2.2, 0]], margin=0.08)
    return ax


@styled
def hybrid(robot: ModuleType) -> Any:
    """Figure 3: the linkage and the revolute about AB."""
    ax = new_axes(True, (4.4, 3.8))
    return mechanism(robot, np.radians([65, 75, 85]), ax=ax)


@styled
def working_modes(robot: ModuleType) -> Any:
    """Figure 4: the four working modes above AB; the others are their mirror images."""
    panels = new_panels(1, 4, size=(9.2, 2.2))
    for k, (ax, branch, letter) in enumerate(zip(panels, ABOVE, "abcd", strict=True)):
        linkage(robot, ax, (3.0, 8.6), branch, shade=colour(k))
        ax.set(xlim=(-4.6, 11.4), ylim=(-1.2, 10.2))
        signs = "".join("+" if s == "plus" else "−" for s in branch.split("_"))
        ax.set_title(f"({letter})  {signs}")
    return panels[0]


@styled
def assembly_modes(robot: ModuleType) -> Any:
    """Both assembly modes for the same angles of the motors."""
    ax = new_axes(False, (4.2, 4.0))
    q = np.radians([0, 65, 100])
    d = Diagram(ax, 16.0)
    shown = []
    for k in (1, 0):
        at = plane(robot.skeleton(q)[k])
        bars(d, at, colour(k))
        d.label(at[4], f"$P$, {robot.ASSEMBLY_MODES[k].replace('_', ' ')}", shade=colour(k))
        shown.append(at)
    d.line([at[2], at[3]], color="#6b6b6b", linestyle=(0, (2, 2)))
    for point, name in zip(at[:4], "ABCD", strict=True):
        d.label(point, f"${name}$")
    d.clean(shown, margin=0.1)
    return ax


def stretched(robot: ModuleType) -> tuple[float, float]:
    """P between C and D on one line, on the symmetry axis of the linkage."""
    L0, L1, L2 = robot.Parameters()
    return L0 / 2, float(np.sqrt(L1**2 - (L2 - L0 / 2) ** 2))


@styled
def in_line(robot: ModuleType) -> Any:
    """Figure 5: C, D and P on one line."""
    ax = new_axes(False, (4.2, 3.4))
    L0, _, L2 = robot.Parameters()
    y, h = stretched(robot)
    at = np.array([[0, 0], [L0, 0], [y - L2, h], [y + L2, h], [y, h]])
    d = Diagram(ax, 17.0)
    bars(d, at, colour(0))
    for point, name in zip(at, "ABCDP", strict=True):
        d.label(point, f"${name}$")
    P, up = at[4], np.array([0.0, 1.0])
    d.arrow(P + up * 0.4, P + up * 2.8, shade=colour(1), width=1.6)
    d.arrow(P - up * 0.4, P - up * 2.8, shade=colour(1), width=1.6)
    d.label(P + up * 2.8, "no force resisted", shade=colour(1))
    d.clean([at, P[None] + up * 3.2], margin=0.08)
    return ax


@styled
def coincident(robot: ModuleType) -> Any:
    """Figure 6: C and D in one place, and P free on a circle."""
    ax = new_axes(False, (3.6, 3.9))
    L0, L1, L2 = robot.Parameters()
    C = np.array([L0 / 2, np.sqrt(L1**2 - L0**2 / 4)])
    d = Diagram(ax, 17.0)
    t = np.linspace(0, 2 * np.pi, 120)
    circle = C + L2 * np.column_stack([np.cos(t), np.sin(t)])
    d.line(circle, color=colour(1), linestyle=(0, (4, 2)), linewidth=1.2)
    shown = [circle]
    for turn, faint in ((150, True), (-20, True), (65, False)):
        P = C + L2 * np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn))])
        at = np.array([[0, 0], [L0, 0], C, C, P])
        if faint:
            d.link([C, P], "#c9c9c9", linewidth=1.6)
            d.hand(P, "#c9c9c9")
        else:
            bars(d, at, colour(0))
            shown.append(at)
            for point, name in zip(at[[0, 1, 2, 4]], ("A", "B", "C = D", "P"), strict=True):
                d.label(point, f"${name}$")
    d.clean(shown, margin=0.09)
    return ax


@styled
def outstretched(robot: ModuleType) -> Any:
    """Figure 7: B, D and P on one line."""
    ax = new_axes(False, (3.9, 3.9))
    params = robot.Parameters()
    L0, L1, L2 = params
    turn = np.radians(112)
    e = np.array([np.cos(turn), np.sin(turn)])
    P = np.array([L0, 0]) + (L1 + L2) * e
    q, mode = in_mode(robot, section(*(P * (1 - 1e-9) + np.array([L0, 0]) * 1e-9)), CONVEX, params)
    at = plane(robot.skeleton(q, params)[mode])
    d = Diagram(ax, 17.0)
    bars(d, at, colour(0))
    for point, name in zip(at, "ABCDP", strict=True):
        d.label(point, f"${name}$")
    d.arrow(P + 0.5 * e, P + 3 * e, shade=colour(1), width=1.6)
    d.label(P + 3 * e, "no velocity this way", shade=colour(1))
    d.clean([at, (P + 3.3 * e)[None]], margin=0.08)
    return ax


def cartesian(
    robot: ModuleType, params: Any, branches: Any, span: Any, *, ax: Any, regular: Any = None,
) -> list[Any]:  # fmt: skip
    """A section of the workspace: what is reached, its border, and where det A vanishes.

    Parameters
    ----------
    robot, params
        the generated module and the dimensions
    branches
        the working modes whose parallel singularities are drawn
    span
        the lowest and the highest value of each coordinate
    ax
        the axes to draw on
    regular
        the working mode of which the part with a positive determinant is shaded; by default, all
        that is reached is
    """
    (y0, y1), (a0, a1) = span
    y, away = np.linspace(y0, y1, GRID), np.linspace(a0, a1, GRID)
    x = section(y, away[:, None])
    reached = robot.workspace_contains(x, params)
    if regular is None:
        region(ax, y, away, reached, color=PALE)
    else:
        q, mode = in_mode(robot, x, regular, params)
        det = of_mode(robot.singularities(q, params), mode)[..., 3]
        with np.errstate(invalid="ignore"):
            positive = reached & (det > 0)
        region(ax, y, away, reached, color="#ededed")
        region(ax, y, away, positive, color=PALE)
    curves(ax, y, away, reached, 0.5, color="#222222", linewidth=1.0)
    for k, branch in enumerate(branches):
        q, mode = in_mode(robot, x, branch, params)
        det = of_mode(robot.singularities(q, params), mode)[..., 3]
        curves(ax, y, away, det, 0.0, color=colour(1 + 2 * k), linewidth=1.4)
    L0 = float(params.L0)
    pivots = [((0, 0), "A"), ((L0, 0), "B")] if L0 else [((0, 0), "A = B")]
    for pivot, name in pivots:
        ax.plot(*pivot, "o", color="#222222", markersize=3)
        ax.annotate(f"${name}$", pivot, xytext=(4, 3), textcoords="offset points")
    ax.set(xlabel="$y$", ylabel=r"$\rho$")
    ax.set_aspect("equal")
    return [
        Patch(
            color=PALE, label="reached" if regular is None else r"reached with $\det\mathbf{A} > 0$"
        ),
        Line2D([], [], color="#222222", linewidth=1.0, label="serial singularities"),
    ]


def joint_space(robot: ModuleType, params: Any, ax: Any) -> list[Any]:
    """The angles of the motors for which the linkage closes, and where it is singular there."""
    t = np.linspace(-np.pi, np.pi, GRID)
    q = np.stack([np.zeros((GRID, GRID)), *np.broadcast_arrays(t, t[:, None])], axis=-1)
    found = robot.fk(q, params)
    there = found.status[..., 0] != robot.Status.UNREACHABLE
    region(ax, t, t, there, color=PALE)
    curves(ax, t, t, there, 0.5, color=colour(1), linewidth=1.4)
    factors = robot.singularities(q, params)
    for mode, style in ((0, "-"), (1, "--")):
        for k in (1, 2):
            curves(ax, t, t, factors[..., mode, k], 0.0, color="#222222", linewidth=0.8,
                   linestyle=style)  # fmt: skip
    ax.set(xlabel=r"$\theta_2$", ylabel=r"$\theta_3$")
    ticks = np.pi * np.array([-1, 0, 1])
    ax.set(xticks=ticks, yticks=ticks)
    ax.set_xticklabels([r"$-\pi$", "0", r"$\pi$"])
    ax.set_yticklabels([r"$-\pi$", "0", r"$\pi$"])
    ax.set_aspect("equal")
    left, right = (name.replace("_", " ") for name in robot.ASSEMBLY_MODES)
    return [
        Patch(color=PALE, label="the linkage closes"),
        Line2D([], [], color="#222222", linewidth=0.8, label=f"serial, {left}"),
        Line2D([], [], color="#222222", linewidth=0.8, linestyle="--",
               label=f"serial, {right}"),
        Line2D([], [], color=colour(1), linewidth=1.4, label="parallel: $C$, $D$, $P$ in line"),
    ]  # fmt: skip


def legend(ax: Any, handles: list[Any], columns: int = 2) -> None:
    ax.figure.legend(handles=handles, loc="outside lower center", ncols=columns)


@styled
def optimal_section(robot: ModuleType) -> Any:
    """Figure 8: a section for L0 = 0 and L1 = L2."""
    ax = new_axes(False, (3.8, 3.9))
    params = robot.Parameters(0.0, 6.0, 6.0)
    legend(ax, cartesian(robot, params, (), ((-13, 13), (-13, 13)), ax=ax))
    return ax


@styled
def optimal_joints(robot: ModuleType) -> Any:
    """Figure 9: the joint space for L0 = 0 and L1 = L2."""
    ax = new_axes(False, (3.8, 4.3))
    params = robot.Parameters(0.0, 6.0, 6.0)
    t = np.linspace(-np.pi, np.pi, 2)
    ax.fill_between(t, -np.pi, np.pi, color=PALE)
    for shift in (-2, 0, 2):
        ax.plot(t, t + shift * np.pi, color=colour(1), linewidth=1.4)
    for shift in (-1, 1):
        ax.plot(t, t + shift * np.pi, color="#222222", linewidth=0.8)
    ticks = np.pi * np.array([-1, 0, 1])
    ax.set(xlabel=r"$\theta_2$", ylabel=r"$\theta_3$", xticks=ticks, yticks=ticks)
    ax.set(xlim=(-np.pi, np.pi), ylim=(-np.pi, np.pi))
    ax.set_xticklabels([r"$-\pi$", "0", r"$\pi$"])
    ax.set_yticklabels([r"$-\pi$", "0", r"$\pi$"])
    ax.set_aspect("equal")
    _check_that_all_close(robot, params)
    legend(ax, [
        Patch(color=PALE, label="the linkage closes"),
        Line2D([], [], color=colour(1), linewidth=1.4, label="parallel singularities: $C = D$"),
        Line2D([], [], color="#222222", linewidth=0.8, label="$C$, $D$, $P$ in line, $P$ at $A$"),
    ], columns=1)  # fmt: skip
    return ax


def _check_that_all_close(robot: ModuleType, params: Any) -> None:
    """For these lengths the linkage closes for all angles of the motors."""
    rng = np.random.default_rng(0)
    theta2, theta3 = rng.uniform(-3, 3, (2, 200))
    found = robot.fk(np.column_stack([0 * theta2, theta2, theta3]), params)
    if (found.status == robot.Status.UNREACHABLE).any():
        raise ValueError("the linkage does not close for all angles")


AVOIDING = (5.0, 2.0, 5.0)
"""Lengths with L0 > 2 L1 and 2 L2 - 2 L1 > L0."""


@styled
def avoiding_section(robot: ModuleType) -> Any:
    """Figure 10: a section without parallel singularities."""
    ax = new_axes(False, (3.8, 4.2))
    params = robot.Parameters(*AVOIDING)
    legend(ax, cartesian(robot, params, ABOVE, ((-4, 9), (-7.5, 7.5)), ax=ax))
    return ax


@styled
def avoiding_joints(robot: ModuleType) -> Any:
    """Figure 11: the joint space, without and with the point where C and D meet."""
    panels = new_panels(1, 2, size=(6.6, 4.2))
    handles = joint_space(robot, robot.Parameters(*AVOIDING), panels[0])[:3]
    panels[0].set_title("$L_0 > 2L_1$: none")
    params = robot.Parameters(4.0, 5.0, 8.0)
    joint_space(robot, params, panels[1])
    L0, L1, _ = params
    meet = float(np.arccos(L0 / (2 * L1)))
    for s in (1, -1):
        panels[1].plot(s * meet, s * (np.pi - meet), "o", color=colour(1), markersize=5)
    panels[1].set_title("$L_0 < 2L_1$: $C$ meets $D$")
    handles.append(
        Line2D([], [], color=colour(1), marker="o", linestyle="", label="parallel: $C = D$")
    )
    legend(panels[0], handles)
    return panels[0]


@styled
def mode_and_singularity(robot: ModuleType) -> Any:
    """Figure 12: one place of the hand in two working modes, one of them singular."""
    panels = new_panels(1, 2, size=(6.4, 3.0))
    P = stretched(robot)
    for ax, branch, title in zip(
        panels, (CONVEX, NON_CONVEX), ("$C$, $D$, $P$ in line", "regular"), strict=True
    ):
        _, at = linkage(robot, ax, P, branch)
        ax.set(xlim=(-3.2, 10.4), ylim=(-1.6, 9.4))
        ax.plot(*at[[2, 3]].T, color=colour(1), linestyle=(0, (3, 2)), linewidth=1.2, zorder=2)
        ax.set_title(title)
    return panels[0]


def _mode_section(branch: str) -> Any:
    @styled
    def drawn(robot: ModuleType) -> Any:
        ax = new_axes(False, (4.2, 3.4))
        handles = cartesian(
            robot, robot.Parameters(), (branch,), ((-7.5, 14.5), (0, 13.5)), ax=ax, regular=branch
        )
        handles.append(
            Line2D([], [], color=colour(1), linewidth=1.4, label="parallel singularities")
        )
        legend(ax, handles, columns=3)
        return ax

    return drawn


@styled
def conditioning(robot: ModuleType) -> Any:
    """Figure 15: curves of equal condition number for two working modes."""
    panels = new_panels(1, 2, size=(6.4, 3.3))
    params = robot.Parameters()
    y, away = np.linspace(-6.5, 13.5, GRID // 3), np.linspace(0.02, 13, GRID // 3)
    x = section(y, away[:, None])
    levels = [0.2, 0.4, 0.6, 0.8]
    shades = ["#f3f7fb", "#dbe7f3", "#bcd4e9", "#93bbdb", "#5a95c4"]
    for ax, branch, title in zip(
        panels, (CONVEX, NON_CONVEX), ("convex", "non-convex"), strict=True
    ):
        q, mode = in_mode(robot, x, branch, params)
        kappa = of_mode(robot.condition_number(q, params)[..., None], mode)[..., 0]
        det = of_mode(robot.singularities(q, params), mode)[..., 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            inverse = np.ma.masked_invalid(1 / kappa)
        for low, high, shade in zip([0, *levels], [*levels, 1.001], shades, strict=True):
            region(ax, y, away, inverse, levels=(low, high), color=shade)
        curves(ax, y, away, det, 0.0, color=colour(1), linewidth=1.4)
        dot = of_mode(_bend(robot, q, params)[..., None], mode)[..., 0]
        curves(ax, y, away, dot, 0.0, color="#222222", linewidth=1.4)
        reached = robot.workspace_contains(x, params)
        curves(ax, y, away, reached, 0.5, color="#222222", linewidth=0.6)
        ax.set(title=title, xlabel="$y$", ylabel=r"$\rho$")
        ax.set_aspect("equal")
    bands = [
        Patch(color=shade, label=rf"$1/\kappa(\mathbf{{A}})$ to {high:g}")
        for shade, high in zip(shades, [*levels, 1], strict=True)
    ]
    legend(panels[0], [
        Line2D([], [], color="#222222", linewidth=1.4, label=r"isotropic, $\kappa = 1$"),
        Line2D([], [], color=colour(1), linewidth=1.4, label="parallel singularities"),
        *bands,
    ], columns=4)  # fmt: skip
    return panels[0]


def _bend(robot: ModuleType, q: np.ndarray, params: Any) -> np.ndarray:
    """The scalar product of CP and DP, which vanishes where A is isotropic."""
    at = robot.skeleton(q, params)
    C, D, P = (at[..., robot.SKELETON.points.index(n), :] for n in "CDP")
    return np.asarray(((P - C) * (P - D)).sum(-1))


@styled
def isotropic(robot: ModuleType) -> Any:
    """An isotropic posture: CP and DP at a right angle."""
    ax = new_axes(False, (3.6, 3.7))
    L0, L1, L2 = robot.Parameters()
    half = L2 / np.sqrt(2)
    h = np.sqrt(L1**2 - (L0 / 2 - half) ** 2)
    at = np.array([[0, 0], [L0, 0], [L0 / 2 - half, h], [L0 / 2 + half, h], [L0 / 2, h + half]])
    d = Diagram(ax, 17.0)
    bars(d, at, colour(0))
    P = at[4]
    a, b = (0.9 * (e - P) / L2 for e in at[2:4])
    d.line([P + a, P + a + b, P + b], color=colour(1), linewidth=1.2)
    for point, name in zip(at, "ABCDP", strict=True):
        d.label(point, f"${name}$")
    d.clean([at], margin=0.08)
    return ax


@styled
def volume(robot: ModuleType) -> Any:
    """The volume of the workspace over L0, for bars that reach equally far together."""
    ax = new_axes(False, (4.8, 3.4))
    L0 = np.linspace(0, 2, 201)
    for k, share in enumerate((0.5, 0.6, 0.7, 0.8)):
        found = robot.workspace_volume(robot.Parameters(L0, share, 1 - share))
        ax.plot(L0, found / (4 * np.pi / 3), color=colour(k), linewidth=1.6,
                label=rf"$L_1 = {share:.1f}\,(L_1 + L_2)$")  # fmt: skip
    ax.set(xlabel="$L_0 / (L_1 + L_2)$", xlim=(0, 2), ylim=(0, 1.02))
    ax.set_ylabel(r"volume / $\frac{4}{3}\pi (L_1 + L_2)^3$")
    ax.legend()
    return ax


FIGURES = (
    Figure("fig1", "The elbow manipulator (Figure 1 of the paper).", elbow),
    Figure("fig2", "The five-bar linkage, with its lengths and angles (Figure 2).", closed_chain),
    Figure("fig3", "The hybrid manipulator: the linkage turns about $AB$ (Figure 3).", hybrid),
    Figure("fig4", "The four working modes with $P$ above $AB$; the remaining four are their "
           "mirror images (Figure 4).", working_modes, step="Inverse: the eight working modes"),
    Figure("fig5", "A parallel singularity: $C$, $D$ and $P$ in line (Figure 5).", in_line,
           step="Velocity: the Jacobian and the determinants"),
    Figure("fig6", "A parallel singularity: $C$ and $D$ coincide, and $P$ moves on a circle while "
           "the motors are locked (Figure 6).", coincident,
           step="Velocity: the Jacobian and the determinants"),
    Figure("fig7", "A serial singularity: $B$, $D$ and $P$ in line (Figure 7).", outstretched,
           step="Velocity: the Jacobian and the determinants"),
    Figure("fig8", "A section of the workspace for $L_0 = 0$ and $L_1 = L_2$ (Figure 8).",
           optimal_section, step="Workspace: largest volume"),
    Figure("fig9", "The joint space for $L_0 = 0$ and $L_1 = L_2$ (Figure 9).", optimal_joints,
           step="Workspace: largest volume"),
    Figure("fig10", "A section of the workspace without parallel singularities, for "
           "$L_0 = 5$, $L_1 = 2$, $L_2 = 5$ (Figure 10).", avoiding_section,
           step="Designs without parallel singularities"),
    Figure("fig11", "The joint space without parallel singularities, for $L_0 = 5$, $L_1 = 2$, "
           "$L_2 = 5$ (left), and with the two points where $C$ and $D$ meet, for $L_0 = 4$, "
           "$L_1 = 5$, $L_2 = 8$, which satisfy both conditions of section 3.2 of the paper as "
           "they are printed (right; Figure 11).",
           avoiding_joints, step="Designs without parallel singularities"),
    Figure("fig12", "One place of $P$ in two working modes: singular in the convex one, regular in "
           "the non-convex one (Figure 12).", mode_and_singularity,
           step="Locus of the parallel singularities"),
    Figure("fig13", "The convex working mode: the part of the workspace on one side of the "
           "parallel singularities (Figure 13).", _mode_section(CONVEX),
           step="Locus of the parallel singularities"),
    Figure("fig14", "The same for a non-convex working mode (Figure 14).",
           _mode_section(NON_CONVEX), step="Locus of the parallel singularities"),
    Figure("fig15", "Curves of equal condition number of $\\mathbf{A}$ in two working modes, "
           "with the isotropic locus (Figure 15).", conditioning, step="Isoconditioning loci"),
    Figure("assembly", "The two assembly modes for the same angles of the motors.",
           assembly_modes, step="Forward: P from two circles"),
    Figure("isotropic", "An isotropic posture: $CP$ and $DP$ are at a right angle.", isotropic,
           step="Isotropy"),
    Figure("volume", "The volume of the workspace for bars of the same total length: it is "
           "largest for $L_0 = 0$ and $L_1 = L_2$, as section 3.1 of the paper says.", volume,
           step="Workspace: largest volume"),
)  # fmt: skip

ALL = tuple((NAME, f) for f in FIGURES)
PAPER = PaperFigures(
    paper="chablat-wenger-angeles",
    heading="D. Chablat, P. Wenger, J. Angeles: The Kinematic Design of a 3-DOF Hybrid Manipulator",
    count=15,
    drawn={k: (NAME, FIGURES[k - 1]) for k in range(1, 16)},
    missing={},
    contradicted={
        11: "The conditions of section 3.2 as they are printed allow $L_0 < 2 L_1$; then $C$ and "
        "$D$ meet, and the joint space is not free of parallel singularities.",
    },
)
