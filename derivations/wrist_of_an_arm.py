"""The spherical wrist at the end of an arm: how the Puma and the Stanford arm explain theirs."""

import sympy as sp
from sympy import pi

from closedform import Chain, Derivation, real, rotation


def wrist_step(
    d: Derivation, pose: sp.Matrix, R03: sp.Matrix, R36: sp.Matrix, wrist: tuple[sp.Symbol, ...]
) -> None:
    """Add the step that splits the rotation of the ``pose`` into those of arm and wrist."""
    theta4, theta5, theta6 = wrist
    turned_back = {theta4: theta4 + pi, theta5: -theta5, theta6: theta6 + pi}
    about_y = -theta5 if R36[2, 0] == sp.sin(theta5) * sp.cos(theta6) else theta5
    turns = rotation("z", theta4) * rotation("y", about_y) * rotation("z", theta6)
    d.step(
        "Inverse: the wrist",
        f"The rotation of the wrist is R_03^T R.  It turns about z, y and z, by theta4, {about_y} "
        "and theta6: its third column gives theta4 and theta5, and its third row theta6.  The "
        "branches with noflip in their names have sin(theta5) >= 0.  In those with flip, theta5 "
        "has the opposite sign, and theta4 and theta6 are turned by pi.  If sin(theta5) = 0, only "
        "theta4 + theta6 or theta4 - theta6 is determined, and we return theta4 = 0.",
        {"R_{03}": R03, "R_{36}": R36},
        proves=(
            "The rotation of the pose is R_03 R_36.  R_36 is the product of the three turns, and "
            "it is the same if theta4 and theta6 are turned by pi and theta5 changes its sign."
        ),
        equal=[
            (pose[:3, :3], R03 * R36),
            (R36, turns),
            (R36.subs(turned_back, simultaneous=True), R36),
        ],
        solves={"ik": wrist},
    )
    d.explain({"R_{03}": "rotation of the arm", "R_{36}": "rotation of the wrist"})


def aligned_wrist(ik: Chain, R03: sp.Matrix, theta4: sp.Symbol) -> None:
    """State where the outer axes of the wrist coincide, and what stays fixed there."""
    for middle, relation in (
        (sp.eye(3), r"\theta_4 + \theta_6"),
        (rotation("y", pi), r"\theta_4 - \theta_6"),
    ):
        aligned = R03 * middle * rotation("z", real("psi"))
        ik.continuum(theta4, dict(zip(ik.R, aligned, strict=True)), relation)
