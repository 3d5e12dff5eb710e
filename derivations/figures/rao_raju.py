"""The figures of Rao and Raju: the H6AR."""

from types import ModuleType
from typing import Any

import numpy as np

from closedform.plot import Diagram, colour, new_axes, new_panels, styled
from closedform.plot.catalogue import Figure, PaperFigures

NAME, CLOSED = "h6ar", "h6ar_loop_closed"
DRAWN = {"L1": 0.3, "L2": 0.3, "a3": 0.05, "d1": 0.3, "d": 0.13, "gs": 0.03, "al": 0.17,
         "loff": 0.08, "lp": 0.12}  # fmt: skip
"""Lengths for the drawings, with a wrist that is large enough to be labelled."""
LEVEL = (0.0, 60.0, 30.0, 60.0, 30.0, 0.0)
"""The fore-arms level, in degrees: where the projections of Fig. 3 show them."""
Z = np.array([0.0, 0.0, 1.0])


def places(robot: ModuleType, q: Any) -> dict[str, np.ndarray]:
    """The points of the skeleton by name."""
    found = robot.skeleton(np.asarray(q), robot.Parameters(**DRAWN))
    at = dict(zip(robot.SKELETON.points, found, strict=True))
    for side in ("right", "left"):
        at.setdefault(f"foot_{side}", at[f"tip_{side}"])
    return at


def apart(robot: ModuleType, shift: np.ndarray) -> np.ndarray:
    """The joints at which the tips are shifted from the level posture, one against the other."""
    params = robot.Parameters(**DRAWN)

    def tips(joints: np.ndarray) -> np.ndarray:
        return np.asarray(robot.arm_tips(joints, params)[:, [0, 2]])

    q = np.radians(LEVEL)
    wanted = tips(q) + np.array([shift, -shift])
    for _ in range(20):
        gap = (tips(q) - wanted).ravel()
        steps = 1e-6 * np.eye(6)[1:5]
        J = np.array([(tips(q + s) - tips(q - s)).ravel() for s in steps])
        q[1:5] -= np.linalg.solve(J.T / 2e-6, gap)
    if np.abs(gap).max() > 1e-9:
        raise ValueError("the tips are not where they should be")
    return q


@styled
def schematics(robot: ModuleType) -> Any:
    """Figure 1: the manipulator, and its wrist from above."""
    left, right = new_panels(1, 2, spatial=True, size=(8.2, 3.8))
    at = places(robot, np.radians([-15, 65, 10, 65, 10, 30]))
    d = Diagram(left, 1.0)
    _arms(d, at)
    for name, text in (("upper_right", "upper arm"), ("fore_right", "fore-arm")):
        a, b = robot.SKELETON.links[name][0], robot.SKELETON.links[name][-1]
        d.label((at[a] + at[b]) / 2, text, size=9)
    d.label((at["base"] + at["column"]) / 2, "waist", size=9)
    d.label(at["gear_centre"], "wrist", size=9)
    d.clean([np.array([*at.values()])], margin=0.08)
    left.set_title("(a)", y=0.96)
    bare = places(robot, np.radians(LEVEL))
    right.view_init(elev=60, azim=-90)
    _wrist(Diagram(right, 0.55), robot, bare, names=True)
    right.set_title("(b)", y=0.96)
    return left


def _arms(d: Diagram, at: dict[str, np.ndarray]) -> None:
    """Both arms, the waist and the wrist."""
    d.link([at["base"], at["column"]], "#6b6b6b", linewidth=3)
    d.link([at["shoulder_left"], at["column"], at["shoulder_right"]], "#6b6b6b", linewidth=3)
    for k, side in enumerate(("right", "left")):
        arm = [at[f"{p}_{side}"] for p in ("shoulder", "elbow", "corner", "tip")]
        d.link(arm, colour(k))
        d.link([at[f"foot_{side}"], at[f"gear_{side}"]], "#333333", linewidth=2)
        for p in ("shoulder", "elbow", "tip"):
            d.revolute(at[f"{p}_{side}"], colour(k))
    d.link([at["gear_left"], at["gear_right"]], "#333333", linewidth=2)
    d.link([at["gear_centre"], at["pitch"], at["hand"]], colour(2), linewidth=2)
    for p in ("gear_right", "gear_left", "pitch"):
        d.revolute(at[p], "#333333")
    d.hand(at["hand"], colour(2))


def _wrist(d: Diagram, robot: ModuleType, at: dict[str, np.ndarray], *, names: bool) -> None:
    """The wrist and the last parts of the fore-arms."""
    shown = []
    for k, side in enumerate(("right", "left")):
        tip = at[f"tip_{side}"]
        stub = tip + 0.35 * (at[f"corner_{side}"] - tip)
        d.link([stub, tip], colour(k))
        d.link([at[f"foot_{side}"], at[f"gear_{side}"]], "#333333", linewidth=2)
        shown.append(stub)
    d.line([at["tip_right"], at["tip_left"]], color="#6b6b6b", linestyle=(0, (3, 2)))
    d.link([at["gear_left"], at["gear_right"]], "#333333", linewidth=2)
    d.link([at["gear_centre"], at["pitch"], at["hand"]], colour(2), linewidth=2)
    for p in ("tip_right", "tip_left", "gear_right", "gear_left", "pitch"):
        d.revolute(at[p], "#333333")
    d.hand(at["hand"], colour(2))
    if names:
        middle = (at["tip_right"] + at["tip_left"]) / 2
        for a, b, text in (
            ("tip_right", "gear_right", r"$\alpha l$"), ("gear_centre", "pitch", r"$l_{\rm off}$"),
            ("pitch", "hand", "$l_p$"), ("gear_left", "gear_right", "$2 g_s$"),
        ):  # fmt: skip
            d.dimension(at[a], at[b], text)
        d.dimension(at["tip_left"], middle, "$d$")
        d.label(at["tip_right"], "$J_1$")
        d.label(at["tip_left"], "$J_2$")
        base = at["tip_left"] - at["tip_right"]
        link = at["gear_right"] - at["tip_right"]
        turn = float(np.arccos(base @ link / np.linalg.norm(base) / np.linalg.norm(link)))
        d.angle(at["tip_right"], base, np.cross(base, link) / np.linalg.norm(np.cross(base, link)),
                turn, r"$\beta$", radius=0.09, reference=0)  # fmt: skip
    d.clean([np.array([*shown, *(at[p] for p in at if "gear" in p or "tip" in p), at["hand"]])],
            margin=0.08)  # fmt: skip


@styled
def arm_frames(robot: ModuleType) -> Any:
    """Figure 2: the frames of the waist and of the right arm."""
    ax = new_axes(True, (5.2, 4.4))
    ax.view_init(elev=20, azim=-62)
    at = places(robot, np.radians([0, 50, 20, 50, 20, 0]))
    d = Diagram(ax, 1.0)
    d.link([at["base"], at["column"]], "#6b6b6b", linewidth=3)
    d.link([at["shoulder_left"], at["column"], at["shoulder_right"]], "#6b6b6b", linewidth=3)
    for k, side in enumerate(("right", "left")):
        arm = [at[f"{p}_{side}"] for p in ("shoulder", "elbow", "corner", "tip")]
        d.link(arm, colour(0) if k == 0 else "#c9c9c9", linewidth=2.6 if k == 0 else 1.6)
    ahead, side = np.array([1.0, 0, 0]), np.array([0, -1.0, 0])
    along = at["elbow_right"] - at["shoulder_right"]
    out = at["corner_right"] - at["elbow_right"]
    fore = at["tip_right"] - at["corner_right"]
    for k, (name, x, z) in enumerate((
        ("base", ahead, Z), ("column", ahead, side), ("shoulder_right", along, side),
        ("elbow_right", out, side), ("tip_right", out, fore),
    )):  # fmt: skip
        x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
        R = np.column_stack([x, np.cross(z, x), z])
        d.frame(at[name], R, (f"x_{k}", "", f"z_{k}"), reach=0.1, shade=colour(1 if k % 2 else 2))
    for a, b, text in (
        ("base", "column", "$d_1$"), ("column", "shoulder_right", "$d$"),
        ("shoulder_right", "elbow_right", "$L_1$"), ("elbow_right", "corner_right", "$a_3$"),
        ("corner_right", "tip_right", "$L_2$"),
    ):  # fmt: skip
        d.dimension(at[a], at[b], text)
    for p in ("column", "shoulder_right", "elbow_right"):
        d.revolute(at[p], colour(0))
    d.point(at["tip_right"])
    d.clean([np.array([at[p] for p in at if "gear" not in p and p not in ("pitch", "hand")]),
             at["tip_right"][None] + [0.12, 0, 0]], margin=0.09)  # fmt: skip
    return ax


@styled
def projections(robot: ModuleType) -> Any:
    """Figure 3: the wrist from above at a pure yaw, and from behind at a pure roll."""
    left, right = new_panels(1, 2, size=(7.8, 3.9))
    shift = 0.055
    for ax, move, plane, names, angle, title in (
        (left, (shift, 0.0), (0, 1), ("X_0", "Y_0"), r"\psi", "(a)  yaw, from above"),
        (right, (0.0, shift), (1, 2), ("Y_0", "Z_0"), r"\phi", "(b)  roll, along the fore-arms"),
    ):
        q = apart(robot, np.array(move))
        at = {name: p[list(plane)] for name, p in places(robot, q).items()}
        d = Diagram(ax, 0.46)
        _projected(d, at, names)
        middle = (at["tip_right"] + at["tip_left"]) / 2
        still = np.array([0.0, -1.0]) if plane == (0, 1) else np.array([-1.0, 0.0])
        d.line([middle - 0.12 * still, middle + 0.12 * still], color="#6b6b6b",
               linestyle=(0, (2, 2)))  # fmt: skip
        way = at["tip_right"] - middle
        turn = float(np.arctan2(still[0] * way[1] - still[1] * way[0], still @ way))
        d.angle(middle, still, (0, 0, 1), turn, f"${angle}$",
                radius=0.24, reference=0)  # fmt: skip
        d.point(middle)
        d.label(middle, "$I$")
        d.label(at["tip_right"], "$R$", shade=colour(0))
        d.label(at["tip_left"], "$L$", shade=colour(1))
        ax.set_title(title)
    return left


@styled
def open_loop(robot: ModuleType) -> Any:
    """The pure roll of Figure 3 (b) in the model of eqs. (1) and (9), where the loop stays open."""
    ax = new_axes(False, (4.4, 3.2))
    at = {n: p[1:] for n, p in places(robot, apart(robot, np.array((0.0, 0.055)))).items()}
    d = Diagram(ax, 0.46)
    _projected(d, at, ("Y_0", "Z_0"))
    d.label(at["tip_right"], "tip of the right arm", shade=colour(0))
    d.label(at["tip_left"], "tip of the left arm", shade=colour(1))
    d.label(at["foot_right"], "where (9) has\nits wrist link", shade="#333333", size=9)
    return ax


def _projected(d: Diagram, at: dict[str, np.ndarray], names: tuple[str, str]) -> None:
    shown = [at[p] for p in at if "gear" in p or "tip" in p] + [at["hand"]]
    for k, side in enumerate(("right", "left")):
        tip = at[f"tip_{side}"]
        gap = at[f"corner_{side}"] - tip
        if np.linalg.norm(gap) > 0.1:
            d.link([tip + 0.3 * gap, tip], colour(k))
            shown.append(tip + 0.3 * gap)
        d.link([at[f"foot_{side}"], at[f"gear_{side}"]], "#333333", linewidth=2)
    d.line([at["tip_right"], at["tip_left"]], color="#6b6b6b")
    d.link([at["gear_left"], at["gear_right"]], "#333333", linewidth=2)
    d.link([at["gear_centre"], at["hand"]], colour(2), linewidth=2)
    for p in ("gear_right", "gear_left", "tip_right", "tip_left"):
        d.revolute(at[p], "#333333")
    d.hand(at["hand"], colour(2))
    low = np.min(shown, axis=0) - 0.05
    for k, name in enumerate(names):
        end = low + 0.06 * np.eye(2)[k]
        d.arrow(low, end, head=0.04)
        d.label(end, f"${name}$")
    d.clean([np.array([*shown, low])], margin=0.1)


@styled
def virtual_arm(robot: ModuleType) -> Any:
    """Figure 4: the equivalent serial mechanism, with the frames of the wrist."""
    ax = new_axes(True, (5.4, 4.2))
    ax.view_init(elev=22, azim=-62)
    q = np.radians([0, 55, 25, 55, 25, 25])
    at = places(robot, q)
    d = Diagram(ax, 1.0)
    for side in ("right", "left"):
        arm = [at[f"{p}_{side}"] for p in ("shoulder", "elbow", "corner", "tip")]
        d.link(arm, "#d5d5d5", linewidth=1.5)
        d.link([at[f"foot_{side}"], at[f"gear_{side}"]], "#d5d5d5", linewidth=1.5)
    d.link([at["base"], at["column"]], "#6b6b6b", linewidth=3)
    d.link([at[p] for p in ("column", "elbow_virtual", "corner_virtual", "tip_virtual")])
    d.link([at[p] for p in ("tip_virtual", "gear_centre", "pitch")], colour(1))
    d.link([at["pitch"], at["hand"]], colour(2))
    for p in ("column", "elbow_virtual", "pitch"):
        d.revolute(at[p], colour(0), axis=np.array([0, 1.0, 0]))
    fore = at["pitch"] - at["tip_virtual"]
    fore /= np.linalg.norm(fore)
    side = np.array([0, 1.0, 0])
    up = np.cross(fore, side)
    R = np.column_stack([up, np.cross(fore, up), fore])
    d.frame(at["tip_virtual"], R, ("x_{4V}", "", "z_{4V}"), reach=0.12, shade="#222222")
    d.axis(at["pitch"], side, r"pitch $\theta$", reach=0.12)
    d.spin(at["tip_virtual"] + 0.05 * fore, fore, r"roll $\phi$", radius=0.03)
    d.spin(at["tip_virtual"] + 0.11 * up, up, r"yaw $\psi$", radius=0.03)
    d.dimension(at["tip_virtual"], at["pitch"], "$L_W = l_W + l_{\\rm off}$")
    d.dimension(at["pitch"], at["hand"], "$l_p$")
    d.dimension(at["column"], at["elbow_virtual"], "$L_1$")
    d.dimension(at["corner_virtual"], at["tip_virtual"], "$L_2$")
    d.point(at["tip_virtual"])
    d.label(at["tip_virtual"], "$I$")
    d.hand(at["hand"], colour(2))
    d.label(at["hand"], "$T$")
    d.clean([np.array([*at.values()])], margin=0.06)
    return ax


FIGURES = (
    Figure("fig1", "The H6AR (a) and its wrist (b; Figure 1 of the paper).", schematics),
    Figure("fig2", "The frames of the waist and of the right arm (Figure 2).", arm_frames,
           step="Tips of the fore-arms"),
    Figure("fig3", "Projections of the wrist: a pure yaw from above (a), and a pure roll along the "
           "level fore-arms (b; Figure 3).", projections, step="Yaw and roll from the tips"),
    Figure("fig4", "The equivalent serial mechanism in the mid-plane, with the axes of the wrist "
           "(Figure 4).", virtual_arm, step="Tip"),
    Figure("loop", "The pure roll of Figure 3 (b) by eqs. (1), (2) and (9): the links of the wrist "
           "do not meet the tips of the arms, because the roll of (9) has the other sign.",
           open_loop, step="Yaw and roll"),
)  # fmt: skip

PAPER = PaperFigures(
    paper="rao-raju",
    heading="S. Rao, J. Raju: Forward and inverse kinematics of a hybrid series-parallel "
    "manipulator",
    count=4,
    drawn={k: (CLOSED if k == 3 else NAME, FIGURES[k - 1]) for k in range(1, 5)},
    missing={},
    contradicted={
        3: "The roll that the figure and eq. (3) show has the other sign in eq. (9): with the "
        "equations as they are printed, the links of the wrist do not meet the tips of the arms.",
    },
)
ALL = tuple((CLOSED if f.name == "fig3" else NAME, f) for f in FIGURES)
