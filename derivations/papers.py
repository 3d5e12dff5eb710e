"""The papers behind the derivations."""

from closedform.derivation import Paper

REDDY_BABU = Paper(
    "reddy-babu",
    "Kinematic Attitudes of a Planar Robot and a Spherical Wrist",
    ("S. Baswanth Kumar Reddy", "K. Rajesh Babu"),
)
