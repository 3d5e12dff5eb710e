"""The spherical five-bar linkage: two cranks and two rods, all axes through one point."""

from closedform.derivations.papers.textbook_loops import SPHERICAL_LOOPS
from sympy import Abs, Rational, cos, sin

from closedform import Crank, Derivation, Strut, parallel, real

d = Derivation(
    "spherical_five_bar",
    "Spherical five-bar linkage",
    SPHERICAL_LOOPS,
    "All axes meet in the centre O, and all links are arcs of great circles of a sphere of radius "
    "r about it.  The first crank turns about the x axis, the second about an axis in the plane "
    "of x and y at the angle gamma from it.  The arcs of the cranks are alpha1 and alpha2, those "
    "of the rods beta1 and beta2.  The rods carry the point P.  At 0 a crank lies in the plane of "
    "x and y and points in the direction from the first axis to the second; at 90 degrees it "
    "points up along z.",
    task=["x", "y", "z"],
)
MEANINGS = {
    "gamma": ("0.8", "angle between the axes of the cranks"),
    "alpha1": ("0.9", "arc of the first crank, at most half a turn"),
    "alpha2": ("0.9", "arc of the second crank, at most half a turn"),
    "beta1": ("1.1", "arc of the rod on the first crank"),
    "beta2": ("1.1", "arc of the rod on the second crank"),
}
r = d.parameter("r", value=1, unit="m", meaning="radius of the sphere", source="the unit of length")
gamma, *arcs = (
    d.parameter(name, value=Rational(value), unit="rad", meaning=meaning, source="round numbers")
    for name, (value, meaning) in MEANINGS.items()
)
axes = (1, 0, 0), (cos(gamma), sin(gamma), 0)
ahead = (0, 1, 0), (-sin(gamma), cos(gamma), 0)
legs = [Strut(r, (0, 0, 0))]
for k in (0, 1):
    alpha, beta = arcs[k], arcs[k + 2]
    legs.append(
        Crank(
            d.joint(f"theta{k + 1}"),
            r * Abs(sin(alpha)),
            2 * r * Abs(sin(beta / 2)),
            pivot=[r * cos(alpha) * x for x in axes[k]],
            along=ahead[k],
            across=(0, 0, 1),
        )
    )
parallel(d, (real("x"), real("y"), real("z")), legs, {+1: "above", -1: "below"})
