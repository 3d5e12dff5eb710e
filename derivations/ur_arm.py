"""A UR-type arm: shoulder, three parallel axes, two more; all eight postures."""

import sympy as sp
from closedform.derivations.papers.textbook import TEXTBOOK
from sympy import cos, pi, sin

from closedform import (
    Chain,
    Derivation,
    LinksAndWrist,
    Pair,
    Reaching,
    from_dh,
    turn,
    two_links,
    zyz,
)

d = Derivation(
    "ur_arm",
    "UR-type arm (three parallel axes)",
    TEXTBOOK,
    "theta1 turns about the vertical.  The axes of theta2, theta3 and theta4 are horizontal and "
    "parallel; the axis of theta5 is normal to them, and the axis of theta6 is normal to that of "
    "theta5.  No three axes meet in a point, so there is no spherical wrist.",
    singularities=("shoulder", "elbow", "wrist"),
)


def length(name: str, micrometres: int, meaning: str) -> sp.Symbol:
    value, source = sp.Rational(micrometres, 10**6), "the maker's table of the UR5"
    return d.parameter(name, value=value, unit="m", meaning=meaning, source=source)


d1 = length("d1", 89159, "from the base up to the shoulder")
L2 = length("L2", 425000, "upper arm")
L3 = length("L3", 392250, "forearm")
d4 = length("d4", 109150, "from the plane of the arm across to the wrist")
d5 = length("d5", 94650, "along the fifth axis")
d6 = length("d6", 82300, "from the wrist to the tool")
q = theta1, theta2, theta3, theta4, theta5, theta6 = [d.joint(f"theta{i}") for i in range(1, 7)]

arm = from_dh(
    d,
    [
        (0, pi / 2, d1, theta1),
        (-L2, 0, 0, theta2),
        (-L3, 0, 0, theta3),
        (0, pi / 2, d4, theta4),
        (0, -pi / 2, d5, theta5),
        (0, 0, d6, theta6),
    ],
)
ik = Chain(d, arm.export(d))
wrist = ik.vector("w", ik.p - d6 * ik.R[:, 2])
quarter_back = Pair(sp.S.NegativeOne, sp.S.Zero)


def in_plane(turn: Pair) -> sp.Matrix:
    return sp.Matrix([[turn.c, turn.s, 0], [0, 0, 1], [turn.s, -turn.c, 0]])


toward = LinksAndWrist(
    q=lambda turn: in_plane(turn) * wrist - sp.Matrix([0, d1, 0]),
    l1=L2,
    l2=L3,
    axis=lambda turn: in_plane(turn) * ik.R[:, 2],
    offset=d5,
    ahead=quarter_back,
)
beside = {+1: "left", -1: "right"}
shoulder = ik.solve(turn, theta1, (wrist[0], -wrist[1], d4), beside, toward=toward)
for axis in "xyz":
    d.write(f"w_{axis}", meaning="coordinate of the centre of the wrist")
d.write("phi", meaning="sum of the turns about the three parallel axes")
d.write("ex", "e_x", "horizontal component of the vector that the two links span")
d.write("ey", "e_y", "vertical component of the vector that the two links span")
d.explain({"w": "centre of the wrist"})
d.step(
    "Inverse: the shoulder",
    "The wrist, which is d6 behind the tool, is d4 beside the plane of the arm.  Two shoulder "
    "angles put it there.  There is no solution if the wrist is nearer to the first axis than d4.",
    {"w": ik.p - d6 * ik.R[:, 2], r"w_x \sin\theta_1 - w_y \cos\theta_1": d4},
    solves={"ik": [theta1]},
)
first = in_plane(shoulder)
M = ik.matrix("M", first * ik.R)
across = ik.let("across", shoulder.c * wrist[0] + shoulder.s * wrist[1])
upward = ik.let("upward", wrist[2] - d1)
lift = ik.angle("phi", theta2 + theta3 + theta4)
beta = ik.angle("beta", -theta5)
reaching = Reaching(
    ik, (across, upward), (L2, L3), offset=d5, ahead=quarter_back, lever=shoulder.lever
)
lifted = ik.solve(zyz, M, (lift, beta, theta6), {+1: "noflip", -1: "flip"}, reaching=reaching)
d.step(
    "Inverse: the wrist",
    "Seen from the plane of the arm, the tool is turned about z, y and z, by phi, -theta5 and "
    "theta6, where phi = theta2 + theta3 + theta4 is the sum of the turns about the parallel "
    "axes.  Where sin(theta5) vanishes, four axes are parallel, and phi is free within the reach "
    "of the elbow.  We return the phi that puts the wrist in the middle of this reach, so that no "
    "pose is lost.",
    {"R_z(\\phi) R_y(-\\theta_5) R_z(\\theta_6)": first * ik.R},
    solves={"ik": [lift]},
)
ex = ik.let("ex", d5 * lifted.s - across)
ey = ik.let("ey", -d5 * lifted.c - upward)
ik.solve(two_links, (theta2, theta3), (ex, ey), (L2, L3), {+1: "up", -1: "down"})
d.step(
    "Inverse: the elbow",
    "The rest is a planar two-link arm with the lengths L2 and L3; theta4 then follows from the "
    "sum phi.",
    {
        "e_x": L2 * cos(theta2) + L3 * cos(theta2 + theta3),
        "e_y": L2 * sin(theta2) + L3 * sin(theta2 + theta3),
        r"\theta_4": lift - theta2 - theta3,
    },
    solves={"ik": [theta2, theta3]},
)
ik.finish("The joint angles of a pose, all eight postures.")
