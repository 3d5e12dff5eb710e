"""The Delta robot with linear drives: three sliders on vertical columns carry a platform."""

from closedform.derivations.papers.textbook import TEXTBOOK
from sympy import Rational, cos, sin

from closedform import Derivation, Slide, parallel, real

d = Derivation(
    "linear_delta",
    "Delta robot with linear drives",
    TEXTBOOK,
    "Three sliders move up columns at the distance f from the z axis, in the directions alpha1, "
    "alpha2 and alpha3.  Parallelograms of length l lead from them to the platform, at the "
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
legs = []
for k, angle in enumerate(("0", "2.0943951023931953", "4.1887902047863905"), 1):
    alpha = d.parameter(
        f"alpha{k}",
        value=Rational(angle),
        unit="rad",
        meaning=f"direction of leg {k}",
        source="a third of a turn apart",
        nonnegative=False,
    )
    out = (cos(alpha), sin(alpha), 0)
    start, corner = ([size * x for x in out] for size in (f, e))
    slider = d.joint(f"rho{k}", "prismatic")
    legs.append(Slide(slider, l, start, (0, 0, 1), on_hand=corner))
parallel(d, (real("x"), real("y"), real("z")), legs, {+1: "below", -1: "above"})
