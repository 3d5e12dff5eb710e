"""The Orthoglide (Wenger and Chablat): three sliders at right angles carry a point."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS

from closedform import Derivation, Parallelogram, Slide, parallel, real

d = Derivation(
    "orthoglide",
    "Orthoglide",
    TEXTBOOK_LOOPS,
    "Three sliders move along the axes x, y and z.  Parallelograms of length L connect them to "
    "the hand P and keep it from turning.  If all sliders are at L, P is at the origin and the "
    "legs are at right angles to each other: there the mechanism is isotropic.",
    task=["x", "y", "z"],
)
L = d.parameter("L", value=1, unit="m", meaning="length of the legs", source="the unit of length")
axes = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
legs = [
    Slide(d.joint(f"rho{k}", "prismatic"), Parallelogram(L, axes[k % 3], L / 8), (0, 0, 0), axis)
    for k, axis in enumerate(axes, 1)
]
parallel(d, (real("x"), real("y"), real("z")), legs, {+1: "outer", -1: "inner"})
