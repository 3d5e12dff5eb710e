"""Legs of walkers: four joints, the second and third meet, the last is parallel to the third."""

import sympy as sp
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 9, 12, 3))
STRUCTURE = "axes 2 and 3 meet, and 1 joint that turns the tool"
ARMS = {
    "right angles": ([(A, pi / 2, D), (0, pi / 2, 0), (B, 0, 0), (C, 0, 0)], STRUCTURE, 2),
    "hip along the femur": ([(A, pi / 2, D), (0, pi / 2, D), (B, 0, D), (C, 0, A)], STRUCTURE, 2),
    "oblique axes": ([(A, pi / 3, D), (0, pi / 4, 0), (B, 0, D), (C, pi / 2, 0)], STRUCTURE, 2),
    "opposite axes": ([(A, pi / 2, D), (0, pi / 2, 0), (B, pi, 0), (C, 0, D)], STRUCTURE, 2),
}
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()
"""The hip was solved by a point that may be on its axis; then poses were lost."""
