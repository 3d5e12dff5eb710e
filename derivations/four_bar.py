"""The planar four-bar linkage: a crank drives a rocker by a coupler."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS

from closedform import Crank, Derivation, coupled, real

d = Derivation(
    "four_bar",
    "Planar four-bar linkage",
    TEXTBOOK_LOOPS,
    "The crank of length L2 turns about A1, the origin, and the rocker of length L4 about A2, at "
    "L1 on the x axis.  The coupler of length L3 joins their ends.  Both angles are measured from "
    "the x axis.",
    task=["psi"],
)
MEANINGS = {
    "L1": (4, "distance of the pivots"),
    "L2": (1, "length of the crank"),
    "L3": (4, "length of the coupler"),
    "L4": (3, "length of the rocker"),
}
L1, L2, L3, L4 = (
    d.parameter(name, value=value, unit="any unit", meaning=meaning, source="round numbers")
    for name, (value, meaning) in MEANINGS.items()
)
coupled(
    d,
    Crank(d.joint("theta"), L2, L3, (0, 0), (1, 0), (0, 1)),
    Crank(real("psi"), L4, L3, (L1, 0), (1, 0), (0, 1)),
)
