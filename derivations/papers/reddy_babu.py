"""Reddy and Babu: a planar arm and a spherical wrist."""

from closedform import Paper

REDDY_BABU = Paper(
    "reddy-babu",
    "Kinematic Attitudes of a Planar Robot and a Spherical Wrist",
    ("S. Baswanth Kumar Reddy", "K. Rajesh Babu"),
)
