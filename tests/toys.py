"""Small mechanisms that the vocabulary was not written for: prismatic, coupled, closed-loop."""

import sympy as sp
from sympy import cos, sin, sqrt

from closedform.lemmas.sine_cosine import linear_pair
from closedform.mechanics.frames import (
    adjoint,
    chain,
    denavit_hartenberg,
    exponential,
    homogeneous,
    prismatic_twist,
    revolute_twist,
    vee,
)
from closedform.model.derivation import Derivation, Paper, Solved
from closedform.model.functions import Program, branches, choose, real
from closedform.model.inverse import Inverse

PAPER = Paper("toy", "Mechanisms of the tests", ("The closedform authors",))
X, Y, Z = (sp.Matrix(v) for v in ([1, 0, 0], [0, 1, 0], [0, 0, 1]))


def polar_arm() -> Derivation:
    """A revolute and a prismatic joint, by exponentials and by Denavit-Hartenberg."""
    d = Derivation("polar", "Polar arm", PAPER, "RP.", task=["x", "y"])
    h = d.parameter("h", value=2, unit="m", meaning="reach at home")
    theta, s = d.joint("theta"), d.joint("s", "prismatic")
    exponentials = [
        exponential(revolute_twist(Z, sp.zeros(3, 1)), theta),
        exponential(prismatic_twist(X), s),
        homogeneous(sp.eye(3), (h, 0, 0)),
    ]
    pose = chain(exponentials)
    rows = [
        denavit_hartenberg(0, sp.pi / 2, 0, theta + sp.pi / 2),
        denavit_hartenberg(0, -sp.pi / 2, h + s, 0),
    ]
    d.step("Pose", "Two routes.", {"T": pose}, equal=[(pose[:3, 3], chain(rows)[:3, 3])])
    d.function("fk", "Position.", {"q": (theta, s)}, {"x": pose[:2, 3]})
    d.function("pose", "Pose.", {"q": (theta, s)}, {"T": pose})
    px, py, sigma = real("px"), real("py"), real("sigma_side")
    side = branches((sigma, {+1: "front", -1: "back"}))
    d.branches = side.labels
    p = Program()
    r = p.let("r", sqrt(px**2 + py**2), nonnegative=True)
    free = p.vanishes("on_axis", r, h, "the hand is on the axis", free=(theta,))
    bearing = linear_pair(theta, sigma * py, sigma * px)
    d.solved.append(Solved("ik", theta, bearing, py * cos(theta) - px * sin(theta)))
    values = [choose(free, 0, bearing[theta]), sigma * r - h]
    d.function(
        "ik", "Both.", {"x": (px, py)}, {"q": values}, program=p, branches=side, result="Solutions"
    )
    d.inverses.append(Inverse("ik", (theta, s), (px, py), tuple(pose[:2, 3])))
    return d


def levelled_arm() -> Derivation:
    """A planar arm whose last joint is coupled to keep the hand level, with both Jacobians."""
    d = Derivation("levelled", "Levelled arm", PAPER, "RRR with a coupling.", task=["x", "y"])
    a, b, c = (d.parameter(n, value=1, unit="m", meaning="a link") for n in "abc")
    t1, t2 = d.joint("theta1"), d.joint("theta2")
    t3 = d.joint("theta3", coupling=-(t1 + t2))
    free = chain(denavit_hartenberg(length, 0, 0, t) for length, t in ((a, t1), (b, t2), (c, t3)))
    pose = d.couple(free)
    d.step("Level", "The coupling.", {"T": pose}, equal=[(pose[:3, :3], sp.eye(3))])
    axes = [sp.zeros(3, 1), a * X, (a + b) * X]
    twists = [revolute_twist(Z, p) for p in axes]
    before = [exponential(t, q) for t, q in zip(twists, (t1, t2, t3), strict=True)]
    columns = [twists[0], adjoint(before[0]) * twists[1], adjoint(chain(before[:2])) * twists[2]]
    spatial = d.couple(
        sp.Matrix.hstack(columns[0] - columns[2], columns[1] - columns[2]).applyfunc(sp.expand)
    )
    velocity = [pose.diff(q) * pose.inv() for q in (t1, t2)]
    by_differentiation = sp.Matrix.hstack(
        *(sp.Matrix([*V[:3, 3], *vee(V[:3, :3])]) for V in velocity)
    )
    d.step("Rates", "Two routes.", {"J": spatial}, equal=[(spatial, by_differentiation)])
    d.function("fk", "Position.", {"q": d.actuated}, {"x": pose[:2, 3]})
    d.function("jacobian_space", "Twists.", {"q": d.actuated}, {"J": spatial})
    return d


def five_bar() -> Derivation:
    """A closed loop: two assembly modes from the loop equations, with passive angles."""
    d = Derivation("fivebar", "Five-bar", PAPER, "RRRRR.", task=["x", "y"])
    L0, L1, L2 = (
        d.parameter(n, value=v, unit="m", meaning="a bar")
        for n, v in (("L0", 2), ("L1", 2), ("L2", 3))
    )
    t1, t2 = d.joint("theta1"), d.joint("theta2")
    d.joint("theta3", passive=True)
    sigma = real("sigma_mode")
    modes = branches((sigma, {+1: "up", -1: "down"}))
    d.assembly_modes = modes.labels
    C = sp.Matrix([L1 * cos(t1), L1 * sin(t1)])
    D = sp.Matrix([L0 + L1 * cos(t2), L1 * sin(t2)])
    p = Program()
    cx, cy = p.let("cx", C[0]), p.let("cy", C[1])
    ux, uy = p.let("ux", (D[0] - cx) / 2), p.let("uy", (D[1] - cy) / 2)
    half = p.let("half", sqrt(ux**2 + uy**2), nonnegative=True)
    rest = p.bound("rest", L2 - half, L2, "the bars meet")
    height = p.let("height", sigma * sqrt(rest) * sqrt(L2 + half) / half)
    x, y = real("x"), real("y")
    solution = [cx + ux - height * uy, cy + uy + height * ux]
    loop = [(x - A[0]) ** 2 + (y - A[1]) ** 2 - L2**2 for A in (C, D)]
    d.function(
        "fk",
        "Both.",
        {"q": (t1, t2)},
        {"p": solution},
        program=p,
        branches=modes,
        result="Positions",
    )
    passive = [sp.atan2(solution[1] - cy, solution[0] - cx)]
    d.function(
        "passive_angles",
        "Both.",
        {"q": (t1, t2)},
        {"theta": passive},
        program=p,
        branches=modes,
    )
    A = sp.Matrix(
        [
            [solution[0] - cx, solution[1] - cy],
            [solution[0] - cx - 2 * ux, solution[1] - cy - 2 * uy],
        ]
    )
    d.function("jacobian_parallel", "A.", {"q": (t1, t2)}, {"A": A}, program=p, branches=modes)
    d.inverses.append(Inverse("fk", (x, y), (sp.S.Zero, sp.S.Zero), tuple(loop)))
    return d


TOYS = {f.__name__: f for f in (polar_arm, levelled_arm, five_bar)}
