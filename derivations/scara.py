"""A SCARA arm: two parallel revolute joints and a spindle that slides and turns."""

import sympy as sp
from closedform.derivations.papers.textbook import TEXTBOOK
from sympy import pi

from closedform import Chain, Derivation, from_dh, remainder, slide, two_links

d = Derivation(
    "scara",
    "SCARA arm (RRPR)",
    TEXTBOOK,
    "Two links of lengths l1 and l2 turn in a horizontal plane at the height h.  At their end a "
    "spindle slides down by d3 and turns by theta4, counter-clockwise as seen from below.",
)
SOURCE = "the size of a common SCARA arm"
l1 = d.parameter("l1", value=sp.Rational(13, 40), unit="m", meaning="first link", source=SOURCE)
l2 = d.parameter("l2", value=sp.Rational(11, 40), unit="m", meaning="second link", source=SOURCE)
h = d.parameter(
    "h", value=sp.Rational(7, 20), unit="m", meaning="height of the links", source=SOURCE
)
theta1, theta2 = d.joint("theta1"), d.joint("theta2")
d3, theta4 = d.joint("d3", "prismatic"), d.joint("theta4")

arm = from_dh(d, [(l1, 0, h, theta1), (l2, pi, 0, theta2), (0, 0, d3, 0), (0, 0, 0, theta4)])
ik = Chain(d, arm.export(d), angles=["yaw"])
d.explain({"J": "velocity and angular velocity of the tool, per joint rate"})
x, y, z, yaw = ik.x
ik.solve(two_links, (theta1, theta2), (x, y), (l1, l2), {+1: "left", -1: "right"}, scale=l1 + l2)
ik.solve(slide, d3, h - z)
ik.solve(remainder, theta4, theta1 + theta2 - yaw)
d.step(
    "Inverse",
    "Seen from above, the links are a planar two-link arm with two elbows, theta2 >= 0 (left) and "
    "theta2 <= 0 (right).  Then the height gives the slide of the spindle, and the yaw gives its "
    "turn.",
    {r"d_3": h - z, r"\theta_4": theta1 + theta2 - yaw},
    solves={"ik": ()},
)
ik.finish("Both elbow configurations for a position and a yaw.")
