"""The slider-crank: a crank drives a slider by a connecting rod."""

from closedform.derivations.papers.textbook_loops import TEXTBOOK_LOOPS

from closedform import Crank, Derivation, Slide, coupled, real

d = Derivation(
    "slider_crank",
    "Slider-crank",
    TEXTBOOK_LOOPS,
    "The crank of length r turns about the origin.  The slider moves along a line parallel to the "
    "x axis, at the height e.  The connecting rod of length l joins the end of the crank to the "
    "slider.",
    task=["x"],
)
r = d.parameter("r", value=1, unit="m", meaning="length of the crank", source="the unit of length")
l = d.parameter("l", value=3, unit="m", meaning="length of the rod", source="round numbers")
e = d.parameter(
    "e", value=0, unit="m", meaning="offset of the slider", source="in line", nonnegative=False
)
coupled(
    d,
    Crank(d.joint("theta"), r, l, pivot=(0, 0), along=(1, 0), across=(0, 1)),
    Slide(real("x"), l, (0, e), (1, 0)),
)
