"""Four joints that turn about one direction or slide, between two that turn across it."""

import sympy as sp
from proposals import Proposals
from sympy import pi

A, B, C, D = (sp.Rational(n, 100) for n in (5, 40, 27, 11))
LINKS = "three joints that turn about one direction and a slide between two that turn"
SLIDES = "two joints that turn about one direction and two slides between two that turn"
UP = (0, 0, None, 0)
ARMS = {
    "slide before the links": (
        [(A, pi / 2, D), UP, (B, 0, 0), (C, 0, D), (A, pi / 2, A), (0, 0, D)], LINKS, 4,
    ),
    "slide after the links": (
        [(0, -pi / 2, D), (B, 0, 0), (C, 0, D), (D, 0, A), (0, pi / 2, None, pi / 2), (A, 0, D)],
        LINKS, 4,
    ),
    "slide between equal links": (
        [(0, pi / 2, 0), (B, 0, 0), UP, (B, 0, 0), (0, -pi / 2, 0), (0, 0, D)], LINKS, 4,
    ),
    "slide against the links": (
        [(A, pi / 2, D), (B, pi, 0), (0, pi, None, 0), (C, 0, D), (D, pi / 2, A), (0, 0, D)],
        LINKS, 4,
    ),
    "telescope between the links": (
        [(A, pi / 2, D), (C, pi / 2, 0), (0, -pi / 2, None, 0), (D, 0, A), (0, pi / 2, None, 0),
         (A, 0, D)],
        SLIDES, 4,
    ),
    "telescope from the first axis of the two": (
        [(0, -pi / 2, D), UP, (0, pi / 2, 0), (0, -pi / 2, None, 0), (A, pi / 2, 0), (0, 0, D)],
        SLIDES, 4,
    ),
    "slide across before the links": (
        [(A, 0, D), (0, pi / 2, None, 0), (0, 0, None, 0), (B, 0, 0), (C, pi / 2, A), (0, 0, D)],
        SLIDES, 4,
    ),
    "oblique slide across before the links": (
        [(A, pi / 3, D), (0, pi / 6, None, 0), (0, 0, None, 0), (B, 0, 0), (C, pi / 2, A),
         (0, 0, D)],
        SLIDES, 4,
    ),
    "slide across after the links": (
        [(A, pi / 2, D), (B, 0, 0), UP, (C, pi / 2, A), (0, pi / 3, None, pi / 2), (A, 0, D)],
        SLIDES, 4,
    ),
}  # fmt: skip
PROPOSALS = Proposals(ARMS)
test_every_pose_of_the_arm_is_reached, test_newton_finds_no_other_posture = PROPOSALS.tests()
