"""The Delta robot with rotary drives (Clavel): three cranks carry a platform that does not turn."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS
from sympy import Rational, cos, sin

from closedform import Crank, Derivation, Parallelogram, parallel, real

d = Derivation(
    "delta",
    "Delta robot with rotary drives",
    TEXTBOOK_LOOPS,
    "Three cranks of length L turn about axes in the base plane z = 0, at the distance f from the "
    "centre of the base and in the directions alpha1, alpha2 and alpha3.  A crank points outwards "
    "at 0 and down at 90 degrees.  Three parallelograms of length l carry the platform, at the "
    "distance e from its centre P, and keep it from turning.",
    task=["x", "y", "z"],
)
SIZES = {
    "f": ("0.1", "distance of the axes of the cranks from the centre of the base"),
    "e": ("0.04", "distance of the parallelograms from the centre of the platform"),
    "L": ("0.15", "length of the cranks"),
    "l": ("0.35", "length of the parallelograms"),
}
f, e, L, l = (
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
    pivot, corner = ([size * x for x in out] for size in (f, e))
    rod = Parallelogram(l, bar=(-sin(alpha), cos(alpha), 0), width=e)
    legs.append(
        Crank(
            d.joint(f"theta{k}"), L, rod, pivot=pivot, along=out, across=(0, 0, -1), on_hand=corner
        )
    )
parallel(d, (real("x"), real("y"), real("z")), legs, {-1: "below", +1: "above"})
