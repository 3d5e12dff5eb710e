"""The Delta robot with linear drives: three sliders on vertical columns carry a platform."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS
from sympy import Rational, sqrt

from closedform import Derivation, Parallelogram, Slide, parallel, real

d = Derivation(
    "linear_delta",
    "Delta robot with linear drives",
    TEXTBOOK_LOOPS,
    "Three sliders move up columns at the distance f from the z axis, a third of a turn apart; "
    "the first is on the x axis.  Parallelograms of length l connect them to the platform, at the "
    "distance e from its centre P, and keep it from turning.",
    task=["x", "y", "z"],
)
SIZES = {
    "f": ("0.2", "distance of the columns from the z axis"),
    "e": ("0.03", "distance of the parallelograms from the centre of the platform"),
    "l": ("0.3", "length of the parallelograms"),
}
f, e, l = (
    d.parameter(name, value=Rational(value), unit="m", meaning=meaning, source="round numbers")
    for name, (value, meaning) in SIZES.items()
)
half = Rational(1, 2)
legs = []
for k, (x, y) in enumerate([(1, 0), (-half, sqrt(3) / 2), (-half, -sqrt(3) / 2)], 1):
    start, corner = ([size * x, size * y, 0] for size in (f, e))
    slider = d.joint(f"rho{k}", "prismatic")
    rod = Parallelogram(l, bar=(-y, x, 0), width=e)
    legs.append(Slide(slider, rod, start, (0, 0, 1), on_hand=corner))
parallel(d, (real("x"), real("y"), real("z")), legs, {-1: "below", +1: "above"})
