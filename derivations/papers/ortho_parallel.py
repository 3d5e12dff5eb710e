"""Arms with an ortho-parallel basis and a spherical wrist."""

from closedform import Paper

ORTHO_PARALLEL = Paper(
    "ortho-parallel",
    "An Analytical Solution of the Inverse Kinematics Problem of Industrial Serial Manipulators "
    "with an Ortho-parallel Basis and a Spherical Wrist",
    ("Mathias Brandstötter", "Arthur Angerer", "Michael Hofbaur"),
    "Proceedings of the Austrian Robotics Workshop",
    source="The formulas are quoted as in the public implementation opw_kinematics, which "
    "follows the paper; the paper itself was not read.",
    year="2014",
)
