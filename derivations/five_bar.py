"""The planar five-bar linkage with five lengths: two cranks and two rods carry a point."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS

from closedform import Crank, Derivation, parallel, real

d = Derivation(
    "five_bar",
    "Planar five-bar linkage",
    TEXTBOOK_LOOPS,
    "The cranks of lengths L1 and L2 turn about A1, the origin, and A2, at L0 on the x axis.  The "
    "rods of lengths L3 and L4 lead from their ends to the point P.  All angles are measured from "
    "the x axis.",
    task=["x", "y"],
)
MEANINGS = {
    "L0": (6, "distance of the pivots"),
    "L1": (7, "length of the first crank"),
    "L2": (7, "length of the second crank"),
    "L3": (9, "length of the rod on the first crank"),
    "L4": (9, "length of the rod on the second crank"),
}
L0, L1, L2, L3, L4 = (
    d.parameter(name, value=value, unit="any unit", meaning=meaning, source="round numbers")
    for name, (value, meaning) in MEANINGS.items()
)
theta1, theta2 = d.joint("theta1"), d.joint("theta2")
passive = d.joint("theta3", passive=True), d.joint("theta4", passive=True)
parallel(
    d,
    (real("x"), real("y")),
    [
        Crank(theta1, L1, L3, pivot=(0, 0), along=(1, 0), across=(0, 1)),
        Crank(theta2, L2, L4, pivot=(L0, 0), along=(1, 0), across=(0, 1)),
    ],
    {+1: "above", -1: "below"},
    passive=passive,
)
