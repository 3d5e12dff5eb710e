"""A planar parallel mechanism of two RPR legs: two sliding legs carry a point."""

import sympy as sp
from closedform.derivations.papers.textbook import TEXTBOOK
from sympy import atan2, cos, sin, sqrt

from closedform import (
    SINGLE,
    Degenerate,
    Derivation,
    Inverse,
    Program,
    branches,
    circle_intersection,
    real,
    skeleton,
    velocity_matrices,
)

d = Derivation(
    "rpr_planar",
    "Planar parallel mechanism (two RPR legs)",
    TEXTBOOK,
    "Two legs turn freely about A at the origin and B at b on the x axis.  They slide out by rho1 "
    "and rho2, and both carry the point P.  The slides are driven; the angles theta1 and theta2 of "
    "the legs follow.",
    task=["x", "y"],
    singularities=("leg 1", "leg 2", "flat"),
    poles=("flat",),
)
b = d.parameter(
    "b", value=1, unit="m", meaning="distance of the pivots", source="the unit of length"
)
rho1, rho2 = q = d.joint("rho1", "prismatic"), d.joint("rho2", "prismatic")
theta1, theta2 = d.joint("theta1", passive=True), d.joint("theta2", passive=True)
x, y = p = real("x"), real("y")

loop = [x**2 + y**2 - rho1**2, (x - b) ** 2 + y**2 - rho2**2]
legs = [
    {x: rho1 * cos(theta1), y: rho1 * sin(theta1)},
    {x: b + rho2 * cos(theta2), y: rho2 * sin(theta2)},
]
the_loop = d.step(
    "The loop",
    "P is at the distance rho1 from A and rho2 from B, for any angles of the legs.",
    {r"\rho_1^2": x**2 + y**2, r"\rho_2^2": (x - b) ** 2 + y**2},
    proves="The point at the end of each leg is at the distance of that leg from its pivot.",
    equal=[(loop[0].subs(legs[0]), sp.S.Zero), (loop[1].subs(legs[1]), sp.S.Zero)],
)

sigma = real("sigma_assembly")
modes = branches((sigma, {+1: "above", -1: "below"}))
d.assembly_modes = modes.labels
f = Program()
size = b + rho1 + rho2
point, chord = circle_intersection(
    f, (b, sp.S.Zero), (rho1, rho2), p, sigma, scale=size, free=(theta1, theta2)
)
px, py = f.let("P_x", point[x]), f.let("P_y", point[y])
d.step(
    "Forward: two circles",
    "P is an intersection of the circles about A and B, above or below the line of the pivots: "
    "these are the two assembly modes.  They coincide if the mechanism is flat.",
    {"x": (b**2 + rho1**2 - rho2**2) / (2 * b), "y": sigma * sqrt(rho1**2 - x**2)},
    uses=[the_loop],
)
d.function(
    "fk",
    "Position of P in both assembly modes.",
    {"q": q},
    {"p": [px, py]},
    program=f,
    branches=modes,
    result="Positions",
    notes=(
        "UNREACHABLE: the legs do not meet, or a length is negative.",
        "SINGULAR: the pivots coincide (b = 0); P is free on a circle, and its point on the x axis "
        "is returned.",
    ),
)
d.inverses.append(
    Inverse(
        "fk",
        p,
        (sp.S.Zero,) * 2,
        tuple(loop),
        (
            Degenerate(
                (chord.flag,), {b: sp.S.Zero, rho2: rho1}, x, relation=r"x^2 + y^2 = \rho_1^2"
            ),
        ),
    )
)
d.function(
    "passive_angles",
    "Angles of the legs in both assembly modes.",
    {"q": q},
    {"theta": [atan2(py, px), atan2(py, px - b)]},
    program=f,
    branches=modes,
)

skeleton(
    d,
    {"A": (0, 0, 0), "B": (b, 0, 0), "P": (px, py, 0)},
    links={"ground": ("A", "B")},
    joints={rho1: ("A", "P"), rho2: ("B", "P"), theta1: ("A",), theta2: ("B",)},
    hand="P",
    ground=("A", "B"),
    lengths={("A", "P"): rho1, ("B", "P"): rho2},
    program=f,
    branches=modes,
)

A, B = velocity_matrices(loop, p, q)
J = (A.inv() * B).applyfunc(sp.cancel)
det = sp.factor(J.det())
d.step(
    "Velocity and singular sets",
    "A dp = B dq.  B is singular if a leg has no length (serial: the leg may turn freely).  A is "
    "singular if P is on the line of the pivots (parallel: the legs cannot hold P across the "
    "line).",
    {"A": A / 2, "B": B / 2, "J": J, r"\det A": sp.factor(A.det() / 4), r"\det J": det},
    proves=(
        "A*J = B, and the determinants of the derivatives of the squares are 4*b*y and 4*rho1*rho2."
    ),
    equal=[(A * J, B), (A.det(), 4 * b * y), (B.det(), 4 * rho1 * rho2)],
    uses=[the_loop],
)
at = {x: px, y: py}
for name, summary, outputs in (
    ("jacobian", "Derivative of p with respect to q, A^-1 B.", {"J": J.subs(at)}),
    ("determinant", "Determinant of the Jacobian.", {"det": det.subs(at)}),
    ("singularities", "rho1 and rho2 (serial) and y (parallel).", {"factors": [rho1, rho2, py]}),
):
    d.function(name, summary, {"q": q}, outputs, program=f, branches=modes)

d.step(
    "What the legs determine",
    "P is an intersection of two circles.  Rounded radii are off by a few units in the last place, "
    "and the error of P is this error divided by the sine of the angle between the legs.  Near the "
    "line of the pivots, far away from them and with b = 0 the legs do not determine P, however "
    "they are computed.  The status is SINGULAR if the sine is less than 2^-10.",
    {r"\rho_1 \rho_2 |\sin(\theta_2 - \theta_1)|": b * sp.Abs(y)},
    proves=(
        "The sine of the angle between the legs, times both lengths, is b times the height of P, "
        "which is the determinant of A."
    ),
    equal=[
        (
            rho1 * rho2 * sin(theta2 - theta1),
            legs[0][x] * legs[1][y] - (legs[1][x] - b) * legs[0][y],
        ),
        (sp.Matrix([[x, y], [x - b, y]]).det(), b * y),
    ],
)
g = Program()
leg1, leg2 = g.let("leg1", sqrt(x**2 + y**2)), g.let("leg2", sqrt((x - b) ** 2 + y**2))
g.determined(b * sp.Abs(y), leg1 * leg2, "P is on the line of the pivots or far away, or b = 0")
d.branches = SINGLE.labels
d.function(
    "ik",
    "The lengths of the legs.",
    {"x": p},
    {"q": [leg1, leg2]},
    program=g,
    branches=SINGLE,
    result="Solutions",
    notes=(
        "Every position can be reached, in exactly one way: lengths are not negative.",
        "SINGULAR: the sine of the angle between the legs is less than 2^-10: on and near the line "
        "of the pivots, at a distance of more than about 1000 b, and everywhere if b = 0.  The "
        "lengths are right, but one ulp of them moves P by more than 1e-12 of b + rho1 + rho2.",
    ),
)
d.inverses.append(Inverse("ik", q, (sp.S.Zero,) * 2, tuple(loop), images="fk", nonnegative=q))
