"""The figures of Reddy and Babu: the planar arm and the spherical wrist."""

from types import ModuleType
from typing import Any

import numpy as np

from closedform.plot import Diagram, colour, new_axes, new_panels, styled
from closedform.plot.catalogue import Figure, PaperFigures

ARM, WRIST = "planar_2r", "spherical_wrist"
WORKED = np.radians([30.0, 30.0])
"""The angles of the worked example."""
E = np.array([1.0, 0.0, 0.0])
Z = np.array([0.0, 0.0, 1.0])
PALE = "#b9cfe2"
FRAMES = ("#222222", colour(0), colour(1), colour(2))


def arm(d: Diagram, at: np.ndarray, shade: str = colour(0)) -> None:
    """The links and joints of the planar arm."""
    d.link(at, shade)
    d.revolute(at[1], shade)
    d.revolute(at[0], shade)
    d.hand(at[2], shade)


@styled
def schematic(robot: ModuleType) -> Any:
    """Fig. 1: the planar arm with its lengths and angles."""
    ax = new_axes(False, (4.2, 3.7))
    at = robot.skeleton(WORKED)
    d = Diagram(ax, 19.0)
    d.line([at[1], at[1] + (at[1] - at[0]) / 3], color="#6b6b6b", linestyle=(0, (2, 2)))
    arm(d, at)
    d.ground(at[0])
    d.dimension(at[0], at[1], "$l_1$")
    d.dimension(at[1], at[2], "$l_2$")
    d.angle(at[0], E, Z, WORKED[0], r"$\theta_1$", radius=0.16, reference=0)
    d.angle(at[1], at[1] - at[0], Z, WORKED[1], r"$\theta_2$", radius=0.13, reference=0)
    d.arrow((0, 0), (15.5, 0))
    d.arrow((0, 0), (0, 13.5))
    d.label((15.5, 0), "$x$")
    d.label((0, 13.5), "$y$")
    for foot in ([at[2][0], 0, 0], [0, at[2][1], 0]):
        d.line([at[2], foot], color="#9a9a9a", linestyle=(0, (3, 2)))
    d.label(at[2], "$(x, y)$")
    d.clean([at, np.array([[0, 13.5, 0], [15.8, 0, 0], [14.6, 12, 0]])], margin=0.05)
    return ax


@styled
def both_elbows(robot: ModuleType) -> Any:
    """Fig. 2: the elbow up and the elbow down."""
    ax = new_axes(False, (4.2, 3.6))
    x = robot.fk(WORKED)
    d = Diagram(ax, 19.0)
    shown = []
    for k, (q, name) in enumerate(zip(robot.ik(x).q, robot.BRANCHES, strict=True)):
        at = robot.skeleton(q)
        arm(d, at, colour(k))
        turn = f"{np.degrees(q[0]):.2f}°, {np.degrees(q[1]):.2f}°".replace("-", "−")
        d.label(at[1], f"{name.replace('_', ' ')}:\n{turn}", shade=colour(k), size=9)
        shown.append(at)
    d.ground(at[0])
    d.frame((0, 0, 0), reach=0.1)
    d.label(x, "$(x, y)$")
    d.clean([*shown, np.array([[15, 3, 0], [0, 12, 0]])], margin=0.07)
    return ax


@styled
def triangle(robot: ModuleType) -> Any:
    """Fig. 3: the triangle of the two links, with alpha and beta."""
    ax = new_axes(False, (4.4, 3.8))
    at = robot.skeleton(WORKED)
    base, elbow, hand = at
    beta = float(np.arctan2(hand[1], hand[0]))
    alpha = beta - WORKED[0]
    along = (elbow - base) / 10
    foot = base + along * ((hand - base) @ along)
    d = Diagram(ax, 19.0)
    d.line([base, hand], color=colour(2), linewidth=1.2)
    d.line([elbow, foot, hand], color="#6b6b6b", linestyle=(0, (3, 2)))
    arm(d, at)
    d.ground(base)
    d.angle(base, E, Z, WORKED[0], r"$\theta_1$", radius=0.16, reference=0)
    d.angle(base, elbow - base, Z, alpha, r"$\alpha$", radius=0.27, shade=colour(2), reference=0)
    d.angle(base, E, Z, beta, r"$\beta$", radius=0.42, shade=colour(3), reference=0)
    d.angle(elbow, elbow - base, Z, WORKED[1], r"$\theta_2$", radius=0.12, reference=0)
    d.dimension(base, elbow, "$l_1$")
    d.dimension(elbow, hand, "$l_2$")
    d.dimension(elbow, foot, r"$l_2 \cos\theta_2$")
    d.dimension(foot, hand, r"$l_2 \sin\theta_2$")
    d.arrow((0, 0), (16, 0))
    d.label((16, 0), "$x$")
    d.label(hand, "$(x, y)$")
    d.clean([at, foot[None], np.array([[16.3, 0, 0], [0, 12.5, 0]])], margin=0.06)
    return ax


@styled
def four_parameters(robot: ModuleType) -> Any:
    """Fig. 4: the four Denavit-Hartenberg parameters between two axes."""
    ax = new_axes(True, (4.6, 3.8))
    ax.view_init(elev=24, azim=-66)
    d = Diagram(ax, 2.6)
    theta, shift, length, twist = np.radians(40), 0.75, 1.25, np.radians(-38)
    across = np.array([np.cos(theta), np.sin(theta), 0])
    corner = shift * Z
    end = corner + length * across
    up = np.cos(twist) * Z + np.sin(twist) * np.cross(across, Z)
    for at, way, name in ((np.zeros(3), Z, "i-1"), (end, up, "i")):
        d.line([at - 0.35 * way, at + 1.25 * way], color="#6a6a6a", linestyle=(0, (7, 2, 1.5, 2)))
        d.arrow(at, at + 0.5 * way if name == "i" else 0.42 * way, width=1.2)
        d.label(at + 0.5 * way if name == "i" else 0.42 * way, rf"$z_{{{name}}}$")
    d.link([np.zeros(3), corner, end])
    d.arrow(np.zeros(3), 0.5 * E, width=1.2)
    d.label(0.5 * E, "$x_{i-1}$")
    d.arrow(end, end + 0.5 * across, width=1.2)
    d.label(end + 0.5 * across, "$x_i$")
    d.dimension(np.zeros(3), corner, "$d_i$")
    d.label(corner + 0.72 * (end - corner), "$a_i$")
    d.line([corner, corner + 0.6 * E], color="#6b6b6b", linestyle=(0, (2, 2)))
    d.angle(corner, E, Z, theta, r"$\theta_i$", radius=0.17, reference=0)
    d.line([end, end + 0.8 * Z], color="#6b6b6b", linestyle=(0, (2, 2)))
    d.angle(end, Z, -across, -twist, r"$\alpha_i$", radius=0.27, reference=0)
    d.clean(
        [np.array([-0.35 * Z, 1.25 * Z, end + 1.2 * up, end - 0.3 * up, end + 0.5 * across, E])]
    )
    return ax


def turned(axis: int, turn: float) -> np.ndarray:
    """The rotation about one axis of a frame."""
    c, s = np.cos(turn), np.sin(turn)
    R = np.eye(3)
    i, j = [k for k in range(3) if k != axis]
    s = -s if axis == 1 else s
    R[i, i] = R[j, j] = c
    R[i, j], R[j, i] = -s, s
    return R


@styled
def euler(robot: ModuleType) -> Any:
    """Fig. 5: the rotations about z, about the new y, and about the new z."""
    panels = new_panels(1, 3, spatial=True, size=(8.4, 3.1))
    phi, theta, psi = np.radians([40, 35, 45])
    R = np.eye(3)
    letters = "xyz"
    names: list[list[str]] = [[f"{a}" + "\N{PRIME}" * k for a in letters] for k in range(4)]
    for k, (ax, axis, turn, name) in enumerate(
        zip(panels, (2, 1, 2), (phi, theta, psi), (r"\phi", r"\theta", r"\varphi"), strict=True)
    ):
        ax.view_init(elev=24, azim=-50)
        d = Diagram(ax, 1.55)
        after = R @ turned(axis, turn)
        kept = [n if i != axis else "" for i, n in enumerate(names[k])]
        d.frame(np.zeros(3), R, kept, reach=0.62, shade="#8a8a8a")
        new = list(names[k + 1])
        new[axis] = f"{names[k][axis]} = {names[k + 1][axis]}"
        d.frame(np.zeros(3), after, new, reach=0.62, shade=FRAMES[k + 1])
        for i in range(3):
            if i != axis:
                d.angle(np.zeros(3), R[:, i], R[:, axis], turn, f"${name}$", radius=0.4,
                        reference=0)  # fmt: skip
        d.clean([1.05 * np.vstack([np.eye(3), R.T, after.T, np.zeros((1, 3))])])
        ax.set_title(f"$R_{{{letters[axis]},{name}}}$")
        R = after
    found = robot.fk([phi, theta, psi])
    if not np.allclose(np.reshape(found, (3, 3)), R, atol=1e-12):
        raise ValueError("the three rotations are not the orientation of the wrist")
    return panels[0]


@styled
def wrist_frames(robot: ModuleType) -> Any:
    """Fig. 6: the frames of the wrist by Denavit and Hartenberg, at theta = 0."""
    ax = new_axes(True, (4.4, 4.2))
    ax.view_init(elev=20, azim=-48)
    d = Diagram(ax, 1.5)
    q = np.radians([0, 38, 30])
    centre, hand = robot.skeleton(q)
    axes = {name: way for name, (_, way) in _axes(robot, q).items()}
    d.link([centre - 0.8 * Z, centre], "#6b6b6b")
    d.link([centre, hand])
    for name, label in (("theta4", "z_3"), ("theta5", "z_4"), ("theta6", "z_5")):
        way = axes[name]
        d.arrow(centre, centre + 0.5 * way, width=1.1)
        d.label(centre + 0.5 * way, f"${label}$")
    d.spin(centre - 0.45 * Z, Z, r"$\theta_4$", radius=0.06)
    d.spin(centre + 0.36 * axes["theta5"], axes["theta5"], r"$\theta_5$", radius=0.06)
    d.spin(centre + 0.72 * axes["theta6"], axes["theta6"], r"$\theta_6$", radius=0.06)
    R = np.reshape(robot.fk(q), (3, 3))
    d.frame(hand, R, ("x_6", "y_6", "z_6"), reach=0.25, shade=colour(1))
    d.label((centre + hand) / 2, "$d_6$")
    d.revolute(centre - 0.45 * Z, axis=Z)
    d.point(centre)
    d.clean([np.array([centre - 0.85 * Z, hand + 0.3 * R[:, 2], hand + 0.4 * R[:, 0],
                       hand + 0.4 * R[:, 1], 0.55 * axes["theta5"], 0.55 * Z])])  # fmt: skip
    return ax


def _axes(robot: ModuleType, q: np.ndarray) -> Any:
    from closedform.plot import joint_axes

    return joint_axes(robot, q)


@styled
def hand_frame(robot: ModuleType) -> Any:
    """Fig. 7: the frame of a hand, and the frame after the rotations of the worked example."""
    panels = new_panels(1, 2, spatial=True, size=(6.6, 3.3))
    q = np.radians([-90, 90, 90])
    R = np.reshape(robot.fk(q), (3, 3))
    for ax, turn, title, names in zip(
        panels,
        (np.eye(3), R),
        (r"(a)  hand frame $\Sigma_H$", r"(b)  $\Sigma_H$ in $\Sigma_A$"),
        (("x_H", "y_H", "z_H"), ("x_H", "y_H", "z_H")),
        strict=True,
    ):
        ax.view_init(elev=22, azim=32)
        d = Diagram(ax, 1.5)
        if turn is R:
            d.frame(np.array([0, -0.9, -0.45]), np.eye(3), ("x_A", "y_A", "z_A"), reach=0.4,
                    shade="#8a8a8a")  # fmt: skip
        palm = np.array([[-0.22, -0.3], [0.22, -0.3], [0.22, 0.05], [-0.22, 0.05], [-0.22, -0.3]])
        fingers = [np.array([[x, 0.05], [x, 0.4]]) for x in (-0.18, 0.18)]
        for part in (palm, *fingers):
            d.link((turn[:, [0, 2]] @ part.T).T - 0.12 * turn[:, 2], "#8fb3d1", linewidth=2.2)
        d.frame(np.zeros(3), turn, names, reach=0.42, shade=colour(1))
        shown = [0.7 * turn.T, -0.45 * turn.T[2:] - 0.25 * turn.T[:1]]
        if turn is R:
            shown.append(np.array([0, -0.9, -0.45]) + 0.65 * np.vstack([np.eye(3), np.zeros(3)]))
        d.clean(shown)
        ax.set_title(title)
    return panels[0]


ALL = (
    (ARM, Figure("fig1", "The planar arm with its lengths and angles (Fig. 1 of the paper).",
                 schematic, step="Position by geometry")),
    (ARM, Figure("fig2", "Both postures that reach the point of the worked example (Fig. 2).",
                 both_elbows, step="Inverse: the law of cosines")),
    (ARM, Figure("fig3", "The triangle of the two links: $\\theta_1 = \\beta - \\alpha$ (Fig. 3).",
                 triangle, step="Inverse: the shoulder")),
    (ARM, Figure("fig4", "The four Denavit-Hartenberg parameters (Fig. 4).", four_parameters,
                 step="Pose by Denavit-Hartenberg")),
    (WRIST, Figure("fig5", "The $ZYZ$ Euler angles, one rotation after the other (Fig. 5).",
                   euler, step="Orientation by ZYZ Euler angles")),
    (WRIST, Figure("fig6", "The axes and the last frame of the spherical wrist (Fig. 6).",
                   wrist_frames, step="Pose by Denavit-Hartenberg")),
    (WRIST, Figure("fig7", "The frame of a hand (a), and the same after the rotations $-90°$, "
                   "$90°$, $90°$ of the worked example (b; Fig. 7).", hand_frame,
                 step="Inverse orientation")),
)  # fmt: skip

PAPER = PaperFigures(
    paper="reddy-babu",
    heading="S. B. K. Reddy, K. R. Babu: Kinematic Attitudes of a Planar Robot and a Spherical "
    "Wrist",
    count=7,
    drawn={number: ALL[number - 1] for number in range(1, 8)},
    missing={},
    contradicted={
        2: "The paper gives $(-30°, -30°)$ for the elbow up in its worked example. The arm reaches "
        "the point with the angles that the figure shows.",
    },
)
