"""The figures of Shi, Zhu and Li: the IRB 260 and its open chain."""

from types import ModuleType
from typing import Any

import numpy as np

from closedform.plot import Diagram, colour, new_axes, new_panels, styled
from closedform.plot.catalogue import Figure, PaperFigures

NAME = "irb260"
CHAIN = ("base", "column", "shoulder", "elbow", "wrist", "flange", "hand")
RODS = (
    ("column", "lower_rod_turret", "lower_rod_plate", "elbow"),
    ("lower_rod_plate", "upper_rod_plate", "elbow"),
    ("upper_rod_plate", "upper_rod_bracket", "wrist"),
)
PALE = "#b5b5b5"


def flat(robot: ModuleType, q: Any) -> dict[str, np.ndarray]:
    """The points of the skeleton in the plane of the arm, for theta1 = 0."""
    at = robot.skeleton(np.asarray(q, dtype=float))[:, 1:]
    return dict(zip(robot.SKELETON.points, at, strict=True))


def arm(d: Diagram, at: dict[str, np.ndarray], shade: str, rods: str, width: float = 2.8) -> None:
    """The open chain, the rods, and the joints between them."""
    for rod in RODS:
        d.link([at[p] for p in rod], rods, linewidth=1.5)
    d.link([at[p] for p in CHAIN], shade, linewidth=width)
    for name in ("lower_rod_turret", "lower_rod_plate", "upper_rod_plate", "upper_rod_bracket"):
        d.revolute(at[name], rods)
    for name in ("shoulder", "elbow", "wrist"):
        d.revolute(at[name], shade)
    d.hand(at["hand"], shade)
    d.ground(at["base"])


@styled
def four_bar(robot: ModuleType) -> Any:
    """Fig. 1: a four-bar linkage, and its output angle over the input angle."""
    left, right = new_panels(1, 2, size=(7.0, 3.0))
    length, base = 1.0, 1.6
    turn = np.radians(62)
    A, D = np.zeros(2), np.array([base, 0.0])
    B = A + length * np.array([np.cos(turn), np.sin(turn)])
    C = D + (B - A)
    d = Diagram(left, 2.6)
    d.line([A, D], color="#6b6b6b", linewidth=1.4)
    for link, name in (((A, B), "input"), ((B, C), "coupler"), ((D, C), "output")):
        d.link(link)
        d.dimension(*link, name)
    for pivot in (A, D):
        d.ground(pivot)
    for joint in (A, B, C, D):
        d.revolute(joint, colour(0))
    for foot, name in ((A, r"\theta"), (D, r"\varphi")):
        d.angle(foot, (1, 0, 0), (0, 0, 1), turn, f"${name}$", radius=0.13)
    d.clean([np.array([A, B, C, D + 0.5 * np.eye(2)[0]])], margin=0.08)
    left.set_title("(a)")
    theta = np.linspace(0, np.pi, 181)
    right.plot(theta, theta, color=colour(0), linewidth=1.8, label="parallelogram")
    right.plot(theta, crossed(length, base, theta), color=colour(1), linewidth=1.4, linestyle="--",
               label="crossed assembly")  # fmt: skip
    ticks = np.pi * np.array([-1, 0, 1])
    right.set(xlabel=r"input $\theta$", ylabel=r"output $\varphi$", xticks=ticks[1:], yticks=ticks)
    right.set_xticklabels(["0", r"$\pi$"])
    right.set_yticklabels([r"$-\pi$", "0", r"$\pi$"])
    right.set_title("(b)")
    right.legend()
    return left


def crossed(length: float, base: float, theta: np.ndarray) -> np.ndarray:
    """The output angle of the crossed assembly: the parallelogram's corner, mirrored at BD."""
    B = length * np.column_stack([np.cos(theta), np.sin(theta)])
    D = np.array([base, 0.0])
    C = B + D
    along = (D - B) / np.linalg.norm(D - B, axis=1)[:, None]
    gap = C - B
    mirrored = B + 2 * (gap * along).sum(1)[:, None] * along - gap
    found = mirrored - D
    return np.asarray(np.unwrap(np.arctan2(found[:, 1], found[:, 0])))


@styled
def two_positions(robot: ModuleType) -> Any:
    """Fig. 3: the hybrid manipulator in two positions."""
    ax = new_axes(False, (4.6, 4.0))
    d = Diagram(ax, 2.0)
    home, moved = flat(robot, [0, 0, 0, 0]), flat(robot, np.radians([0, 38, 8, 0]))
    arm(d, home, "#b9cfe2", "#d8d8d8")
    arm(d, moved, colour(0), "#7d7d7d")
    for at in (home, moved):
        d.arrow(at["flange"], at["flange"] + [0.3, 0], shade=colour(1), width=1.3)
    d.label(home["flange"] + [0.3, 0], "level in both", shade=colour(1))
    d.clean(
        [np.array([*home.values()]), np.array([*moved.values()]) + np.array([0.42, 0])], margin=0.07
    )
    return ax


@styled
def simplified(robot: ModuleType) -> Any:
    """Fig. 4: the linkage, with the equivalent open chain in dark lines."""
    ax = new_axes(False, (4.4, 4.0))
    d = Diagram(ax, 2.0)
    at = flat(robot, np.radians([0, 20, 10, 0]))
    arm(d, at, "#222222", PALE, width=3.4)
    for k, name in ((2, "shoulder"), (3, "elbow"), (4, "wrist")):
        d.label(at[name], f"axis {k}")
    for k, (foot, way) in {1: ("base", 1.0), 5: ("flange", -1.0)}.items():
        d.line([at[foot] - [0, 0.24 * way], at[foot] + [0, 0.3 * way]], color="#6a6a6a",
               linestyle=(0, (7, 2, 1.5, 2)))  # fmt: skip
        d.label(at[foot] + [0, 0.2 * way if k == 1 else 0.24], f"axis {k}")
    d.clean([np.array([*at.values()])], margin=0.09)
    return ax


@styled
def revolute(robot: ModuleType) -> Any:
    """Fig. 5: a revolute joint, with its axis, a point on it, and the velocity of a point."""
    ax = new_axes(True, (3.6, 3.4))
    d = Diagram(ax, 1.5)
    w = np.array([-0.25, 0.2, 1.0])
    w /= np.linalg.norm(w)
    q = np.array([0.25, 0.1, 0.3])
    arm_at = np.array([0.8, -0.4, 0.1])
    p = q + arm_at - w * (arm_at @ w) + 0.35 * w
    origin = np.array([-0.35, 0, 0])
    d.frame(origin, reach=0.22)
    d.line([q - 0.45 * w, q + 0.95 * w], color="#6a6a6a", linestyle=(0, (7, 2, 1.5, 2)))
    d.arrow(q + 0.5 * w, q + 0.9 * w, shade=colour(1), width=1.8, head=0.05)
    d.label(q + 0.75 * w, r"$\omega$", shade=colour(1), size=12)
    foot = q + 0.35 * w
    d.line([q - 0.09 * w, q + 0.09 * w], color="#222222", linewidth=14, solid_capstyle="butt")
    d.link([foot, p])
    d.line([q, foot], color=colour(0), linewidth=2.6)
    d.hand(p)
    d.arrow(origin, q - 0.04 * w, shade="#222222")
    d.label((q + origin) / 2, "$q$", size=12)
    radius = p - foot
    back = np.cos(0.9) * radius - np.sin(0.9) * np.cross(w, radius)
    d.angle(foot, back, w, 0.9, r"$\theta$", radius=np.linalg.norm(radius) / 1.5, reference=0.53)
    v = np.cross(w, p - q)
    d.arrow(p, p + 0.45 * v, shade=colour(2), width=1.5, head=0.05)
    d.label(p + 0.45 * v, r"$\omega \times (p - q)$", shade=colour(2))
    d.label(p, "$p$", size=12)
    d.clean([np.array([q - 0.5 * w, q + w, p, p + 0.5 * v, [-0.35, 0, 0], foot + back])])
    return ax


@styled
def open_chain(robot: ModuleType) -> Any:
    """Fig. 6: the open chain at home, with the point and the direction of each screw."""
    ax = new_axes(True, (5.0, 4.6))
    ax.view_init(elev=18, azim=-40)
    at = dict(zip(robot.SKELETON.points, robot.skeleton(np.zeros(4)), strict=True))
    d = Diagram(ax, 1.9)
    d.link([at[p] for p in CHAIN])
    z, x = np.array([0, 0, 1.0]), np.array([-1.0, 0, 0])
    screws = (("base", z), ("shoulder", x), ("elbow", x), ("wrist", x), ("flange", z))
    ends = []
    for k, (name, axis) in enumerate(screws, 1):
        q = at["hand"] if k == 5 else at[name]
        d.revolute(at["base"] + 0.36 * z if k == 1 else at[name], colour(0), axis=axis)
        d.axis(at["base"] + 0.36 * z if k == 1 else at[name], axis, reach=0.1)
        start = at["base"] + 0.42 * z if k == 1 else at[name] + 0.03 * axis
        end = start + (0.14 if k == 1 else 0.26) * axis
        d.arrow(start, end, shade=colour(1), width=1.8, head=0.035)
        d.label(end, rf"$\omega_{k}$", shade=colour(1))
        if k > 1:
            d.point(q)
            d.label(q, f"$q_{k}$")
        ends.append(end)
    for a, b, name in (
        ("column", "shoulder", "l_1"), ("base", "column", "l_2"), ("shoulder", "elbow", "l_3"),
        ("elbow", "wrist", "l_4"), ("flange", "hand", "l_5"), ("wrist", "flange", "l_6"),
    ):  # fmt: skip
        d.dimension(at[a], at[b], f"${name}$")
    d.frame(np.zeros(3), reach=0.13)
    d.clean([np.array([at[p] for p in CHAIN]), np.array(ends), 0.25 * np.eye(3)])
    return ax


RATES = np.radians([-30.0, 10.0, 5.0, 0.0])


@styled
def velocities(robot: ModuleType) -> Any:
    """Fig. 7 (b): the velocity of the hand at the rates of section V, from all angles 0."""
    panels = new_panels(1, 3, size=(8.6, 2.7))
    t = np.linspace(0, 10, 201)
    relative = t[:, None] * RATES
    grounded = robot.joints_from_motors(relative)
    motors = robot.joints_from_motors(RATES)
    for k, (ax, name) in enumerate(zip(panels, "xyz", strict=True)):
        first = robot.point_velocity(relative, np.broadcast_to(RATES, relative.shape))
        second = robot.point_velocity(grounded, np.broadcast_to(motors, grounded.shape))
        ax.plot(t, first[:, k], color=colour(0), linewidth=1.6,
                label="axis 3 as in the paper, against the lower arm")  # fmt: skip
        ax.plot(t, second[:, k], color=colour(1), linewidth=1.4, linestyle="--",
                label="axis 3 as a motor on the turret")  # fmt: skip
        ax.axhline(0, color="#9a9a9a", linewidth=0.6)
        ax.set(xlabel="$t$ in s", title=f"$v_{name}$ in m/s", xlim=(0, 10))
    panels[0].figure.legend(handles=panels[0].lines[:2], loc="outside lower center", ncols=2)
    return panels[0]


FIGURES = (
    Figure("fig1", "A four-bar linkage with equal opposite links (a), and its output angle over "
           "its input angle in both assemblies (b; Fig. 1 of the paper).", four_bar,
           step="The lower loop and its assemblies"),
    Figure("fig3", "The double parallelogram in two positions: the bracket at the wrist stays "
           "level (Fig. 3).", two_positions, step="The upper loop and the virtual joint"),
    Figure("fig4", "The linkage in grey, and the equivalent open chain in dark lines (Fig. 4).",
           simplified, step="The upper loop and the virtual joint"),
    Figure("fig5", "A revolute joint: its direction $\\omega$, a point $q$ on its axis, and the "
           "velocity of a point $p$ (Fig. 5).", revolute, step="Exponential of a twist"),
    Figure("fig6", "The open chain at home, with the screws of eqs. (1) to (5) (Fig. 6).",
           open_chain, step="Screws"),
    Figure("fig7", "The velocity of the hand in the experiment of section V, from all angles 0 and "
           "with the dimensions of the data sheet, for both readings of axis 3 (Fig. 7b).",
           velocities, step="Angles relative or grounded"),
)  # fmt: skip
BY_NUMBER = {1: 0, 3: 1, 4: 2, 5: 3, 6: 4, 7: 5}

ALL = tuple((NAME, f) for f in FIGURES)
PAPER = PaperFigures(
    paper="shi-zhu-li",
    heading="J. Shi, X. Zhu, Z. Li: New Method for Kinematic Analysis of a Hybrid Manipulator",
    count=8,
    drawn={number: (NAME, FIGURES[k]) for number, k in BY_NUMBER.items()},
    missing={
        2: "photographs of the robot",
        8: "the differences between the curves of two programs, one of which simulates a model "
        "that is not printed; the curves of Fig. 7 (a) are from the same model",
    },
    contradicted={
        5: "The text says that Fig. 5 shows the virtual motor; by its caption it shows a revolute "
        "joint, and the open chain is in Fig. 6.",
    },
)
