"""The planar four-bar linkage: a crank drives a rocker by a coupler."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS
from sympy import sqrt

from closedform import Crank, Derivation, Equal, Notation, coupled, real

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
theta, psi = d.joint("theta"), real("psi")
crank = Crank(theta, L2, L3, pivot=(0, 0), along=(1, 0), across=(0, 1))
rocker = Crank(psi, L4, L3, pivot=(L1, 0), along=(1, 0), across=(0, 1))
coupled(d, crank, rocker)

coupler = rocker.end() - crank.end()
names = {"d": L1, "a": L2, "b": L3, "c": L4, r"\theta": theta, r"\psi": psi}
d.claim(
    "Freudenstein's equation",
    r"$\frac{d}{a} \cos\psi - \frac{d}{c} \cos\theta + \frac{a^2 - b^2 + c^2 + d^2}{2 a c} = "
    r"\cos(\theta - \psi)$",
    lambda relation: Equal(relation, on={L3: sqrt(coupler.dot(coupler))}),
    where="Freudenstein; a is the crank, b the coupler, c the rocker, d the ground",
    notation=Notation(names),
    paraphrase=True,
)
