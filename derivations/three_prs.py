"""The 3-PRS mechanism (Carretero et al.): three sliders lift and tilt a hand."""

from closedform.derivations.papers.textbook_loops import TRIPODS
from sympy import Rational, sqrt

from closedform import Derivation, Slide, Upright, tripod

d = Derivation(
    "three_prs",
    "3-PRS mechanism",
    TRIPODS,
    "Three sliders move along columns.  A rod leads from each of them to a corner of the hand.  A "
    "hinge at the slider keeps the rod in a vertical plane, and a ball joint connects it to the "
    "hand.  The planes meet in the z axis, at 120 degrees to each other.  The hand lifts and "
    "tilts.  It also turns about z and moves sideways a little, as its height and its tilts "
    "determine.",
)
b, a, l = (
    d.parameter(name, value=Rational(value), unit="m", meaning=meaning, source="an example")
    for name, value, meaning in (
        ("b", "0.35", "distance of the columns from the z axis"),
        ("a", "0.25", "distance of the corners from the centre of the hand"),
        ("l", "0.6", "length of the rods"),
    )
)
half = Rational(1, 2)
legs = []
for k, (x, y) in enumerate([(1, 0), (-half, sqrt(3) / 2), (-half, -sqrt(3) / 2)], 1):
    slider = d.joint(f"rho{k}", "prismatic")
    legs.append(Upright(Slide(slider, l, (b, 0), (0, 1)), (x, y), corner=(a * x, a * y)))
d.write("tilt_x", r"\tau_x", "tilt of the hand about the x axis")
d.write("tilt_y", r"\tau_y", "tilt of the hand about the y axis")
tripod(d, legs)
