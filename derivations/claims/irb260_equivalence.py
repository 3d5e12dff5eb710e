"""Is the open chain with its virtual joint equivalent to the closed linkage?"""

import sympy as sp
from closedform.derivations.claims.irb260_arm import ASSEMBLY, Palletiser, stated
from sympy import cos, sin

from closedform import Check, Identity, Reading, Undecidable, Under

EQUIVALENT = {"equivalent": True, "not equivalent": False}


def same_pose(arm: Palletiser, holds: bool = True) -> Under:
    """The open chain with the virtual constraint has the pose of the closed linkage."""
    same = Identity(arm.couple(arm.free), arm.linkage(arm.bracket()))
    return Under(stated(holds, same), ASSEMBLY)


def crossed_differs(arm: Palletiser, holds: bool = True) -> Check:
    """The same if the lower loop is crossed."""
    turn = arm.bracket(lower=-1)
    names = ("the cosine and the sine of the turn of the hand", "those of no turn")
    return stated(holds, Identity([cos(turn), sin(turn)], [sp.S.One, sp.S.Zero], names=names))


def equivalent_readings(arm: Palletiser) -> list[Reading]:
    return [
        Reading(
            "the hand of the open chain has the pose of that of the closed linkage, for all "
            "angles, while both loops are parallelograms",
            check=lambda holds: same_pose(arm, holds),
        ),
        Reading(
            "also if the lower loop is crossed",
            check=lambda holds: crossed_differs(arm, holds),
        ),
    ]


def valid_readings(arm: Palletiser) -> list[Reading]:
    return [
        Reading(
            "what is concluded: the method gives the pose of the hand of the closed linkage",
            check=lambda holds: same_pose(arm, holds),
        ),
        Reading(
            "that the curves of Figs. 7 and 8 show it",
            check=lambda _: Undecidable(
                "the paper prints curves of one path without dimensions, start or numbers, and the "
                "velocity of the hand does not contain all lengths"
            ),
        ),
    ]
