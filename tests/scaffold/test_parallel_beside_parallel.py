"""Three parallel axes at an end of six joints, and two others that are parallel.

The last of those two, or the axis after them, may meet another one.
"""

import sympy as sp
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 35, 11))
FIRST = "axes 1, 2 and 3 parallel, "
ARMS = {
    "4 and 5 parallel, 5 and 6 meet": (
        [(B, 0, D), (C, 0, 0), (A, pi / 2, D), (B, 0, A), (0, pi / 2, 0), (0, 0, A)],
        FIRST + "4 and 5 parallel", 8,
    ),
    "4 and 5 parallel, oblique axes": (
        [(B, 0, D), (C, 0, 0), (A, pi / 2, D), (A, 0, A), (0, pi / 3, 0), (A, 0, A)],
        FIRST + "4 and 5 parallel", 8,
    ),
    "4 and 5 meet, 5 and 6 parallel": (
        [(B, 0, D), (C, 0, 0), (A, pi / 2, D), (0, pi / 2, 0), (A, 0, 0), (0, 0, A)],
        FIRST + "5 and 6 parallel", 8,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()
"""Code for the first could not be printed; the last lost poses where three solutions meet."""
