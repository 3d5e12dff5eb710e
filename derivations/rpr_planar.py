"""A planar parallel mechanism of two RPR legs: two sliding legs carry a point."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS

from closedform import Derivation, Stretch, parallel, real

d = Derivation(
    "rpr_planar",
    "Planar parallel mechanism (two RPR legs)",
    TEXTBOOK_LOOPS,
    "Two legs turn freely about A1 at the origin and A2 at b on the x axis.  Their lengths are "
    "rho1 and rho2, and both carry the point P.  The slides are driven; the angles theta1 and "
    "theta2 of the legs follow.",
    task=["x", "y"],
    singularities=("leg 1", "leg 2", "flat"),
    poles=("flat",),
)
b = d.parameter(
    "b", value=1, unit="m", meaning="distance of the pivots", source="the unit of length"
)
rho1, rho2 = d.joint("rho1", "prismatic"), d.joint("rho2", "prismatic")
passive = d.joint("theta1", passive=True), d.joint("theta2", passive=True)
parallel(
    d,
    (real("x"), real("y")),
    [Stretch(rho1, (0, 0)), Stretch(rho2, (b, 0))],
    {+1: "above", -1: "below"},
    passive=passive,
)
