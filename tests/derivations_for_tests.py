"""A derivation for tests, as the text of a script."""

SLIDER = '''"""A slider along x, with an offset."""

import sympy as sp

from closedform.model.derivation import Derivation, Paper

d = Derivation("slider", "Slider", Paper("toy", "Toys", ("A. Nonymous",)), "One joint.", task=["x"])
a = d.parameter("a", value=2, unit="m", meaning="offset")
q1 = d.joint("q1", "prismatic")
d.step("Position", "The joint and the offset add up.", {"x": a + q1}, equal=[(q1 + a, a + q1)])
d.function("fk", "Position.", {"q": [q1]}, {"x": [a + q1]})
'''
