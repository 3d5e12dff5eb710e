"""The agile wrist (Gosselin): three legs of right angles turn a hand about a point."""

from collections.abc import Sequence

from closedform.derivations.claims.agile_wrist import state
from closedform.derivations.papers.textbook_loops import WRIST_LOOPS
from sympy import Abs, Expr, Matrix, Min, Mul, Rational, Symbol, atan2, cos, diag, eye, sin, sqrt

from closedform import (
    Degenerate,
    Derivation,
    Inverse,
    Lemma,
    Link,
    Program,
    Solved,
    axes_in_three_planes,
    branches,
    choose,
    real,
    require_rotation,
    skeleton,
)

d = Derivation(
    "agile_wrist",
    "Agile wrist",
    WRIST_LOOPS,
    "Three equal legs join a hand to the base, and the axes of all nine joints meet in the centre "
    "O.  Neighbouring axes of a leg are at right angles.  The first axes u of the three legs are "
    "driven.  They are the axes x, y and z of the base, and the last axes v are the axes z, x and "
    "y of the hand.  The middle axis w of the first leg is along y at 0 and along z at 90 "
    "degrees; for the other legs x, y and z are interchanged cyclically.  R is the orientation of "
    "the hand.  In one of the assembly modes it is the identity where all joints are zero; there "
    "the mechanism is isotropic.",
    task=[f"R{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)],
    singularities=("leg 1", "leg 2", "leg 3", "all legs"),
)
r = d.parameter(
    "r",
    value=1,
    unit="m",
    meaning="radius of the sphere on which the links are drawn",
    source="the unit of length",
)
q = tuple(d.joint(f"theta{k}") for k in (1, 2, 3))
passive = tuple(d.joint(f"phi{k}", passive=True) for k in (1, 2, 3))
SIGN = {+1: "plus", -1: "minus"}
LEGS = [(k, (k + 1) % 3, (k + 2) % 3) for k in range(3)]
"""The number of each leg less one, and those of the legs after it."""

# The loop

given = Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
V = Matrix.hstack(given[:, 2], given[:, 0], given[:, 1])
u = [eye(3)[:, k] for k in range(3)]
w = [cos(q[k]) * u[i] + sin(q[k]) * u[j] for k, i, j in LEGS]
p = [u[k].cross(w[k]) for k in range(3)]
loop = tuple(w[k].dot(V[:, k]) for k in range(3))
square = V.T * V - eye(3)
rigid = (*(square[i, j] for i in range(3) for j in range(i, 3)), V.det() - 1)
for k in (1, 2, 3):
    d.explain(
        {rf"\mathbf w_{k}": "middle axis of leg k", f"B_{{{k}{k}}}": "entry of the diagonal of B"}
    )
    d.explain({rf"\mathbf a_{k}": "cross product of w and v, a row of A"})
    d.explain({rf"\mathbf v_{k}": "last axis of leg k"})
d.explain(
    {
        "A": "factor of the angular velocity of the hand",
        "B": "factor of the joint rates",
        "J": "angular velocity of the hand per joint rate",
        r"\kappa": "condition number of A",
    }
)
d.write("u", r"\mathbf u", "first axis of a leg")
d.write("p", r"\mathbf p", "cross product of u and w of a leg")
d.write("gap", r"\Delta", "determinant of A in every assembly mode")
d.loop = stated = d.step(
    "The loop",
    "The last axis v of each leg is an axis of the hand, and a column of R.  It is at right angles "
    "to the middle axis w, which the driven joint places, so the scalar product of both is zero.",
    {
        **{rf"\mathbf w_{k + 1}": w[k] for k in range(3)},
        **{rf"\mathbf v_{k + 1}": V[:, k] for k in range(3)},
        **{rf"\mathbf w_{k + 1}\cdot\mathbf v_{k + 1}": loop[k] for k in range(3)},
    },
    proves="The vectors u, w and their cross product p are orthonormal and right-handed.",
    equal=[(Matrix.hstack(u[k], w[k], p[k]).det(), 1) for k in range(3)]
    + [(w[k].dot(w[k]), 1) for k in range(3)],
)

# Forward

f = d.program()
sigma = real("sigma_1"), real("sigma_2")
modes = branches(*((s, SIGN) for s in sigma))
d.assembly_modes = modes.labels
found = axes_in_three_planes(f, q, V, (*loop, *rigid), sigma)
d.step(
    "Forward: three axes in three planes",
    "The three axes v are at right angles to each other.  Each is at right angles to the w of its "
    "leg, so it is in the plane of u and p, where p is the cross product of u and w.  Eight "
    "orientations satisfy this.  In four of them every v is u or -u.  They do not depend on the "
    "joints: every joint is free, and the legs turn while the hand stands still.  These four are "
    "left out.  The other four are the assembly modes.  They exist for all values of the joints.",
    {},
    uses=[stated],
    solves={"fk": ()},
)
fk = d.function(
    "fk",
    "Orientation of the hand in the four assembly modes.",
    {"q": q},
    {"p": Matrix(3, 3, [found.link.lemma[e] for e in given])},
    program=f,
    branches=modes,
    result="Positions",
    notes=(
        "The modes are named by the signs of B_11 and B_22, each times that of det A.",
        "SINGULAR: the middle axes of two legs are parallel, and the hand is free to turn about "
        "them; one of its orientations is returned.",
        "Not returned: the four orientations in which the last axis of each leg is along the first "
        "one.  All joints are free there, and none of them moves the hand.",
    ),
)
d.inverses.append(Inverse("fk", tuple(given), (0,) * 10, (*loop, *rigid), links=(found.link,)))
d.solved.append(Solved("fk", V[0, 0], found.link.lemma, loop[0]))

# Velocity

rows = [w[k].cross(V[:, k]) for k in range(3)]
rates = [p[k].dot(V[:, k]) for k in range(3)]
omega = Matrix([real(f"omega_{i}") for i in "xyz"])
x, y, rho = found.x, found.y, found.widths
A = Matrix.vstack(*((y[k] * u[k] - x[k] * p[k]).T for k in range(3)))
tau = (*sigma, sigma[0] * sigma[1])


def jacobian(a: Matrix, widths: Sequence[Expr], signs: Sequence[Expr]) -> Matrix:
    """A^-1*B: in its columns the common factor C - S has cancelled."""
    return Matrix.hstack(
        *(signs[k] / (widths[i] * widths[j]) * a[i, :].T.cross(a[j, :].T) for k, i, j in LEGS)
    )


def volume(m: Matrix) -> Expr:
    """The determinant; ``Matrix.det`` also simplifies it, which takes seconds."""
    return m.col(0).dot(m.col(1).cross(m.col(2)))


identities = []
for _, signs in fk.cases():
    a, b, held = (fk.explicit(e, signs)[0] for e in ([*A], y, [found.gap, *rho]))
    (gap, *widths), a = held, Matrix(3, 3, a)
    J = jacobian(a, widths, [e.xreplace(signs) for e in tau])
    identities += [(volume(a), gap), (a * J, diag(*b)), (volume(J), gap**2 / Mul(*widths) ** 2)]
d.step(
    "Velocity and singular sets",
    "The derivatives of the loop equations give A*omega = B*dq for the angular velocity omega of "
    "the hand.  The rows of A are the cross products of w and v.  B is diagonal, because each leg "
    "depends on its own joint alone; its entries are sines of the angles between u and v.  In all "
    "assembly modes the determinant of A is C - S, where C is the product of the cosines of the "
    "joints and S the product of their sines.  The entry of B for a leg is plus or minus C - S, "
    "divided by the sines of the angles between its middle axis and the other two.  So A and B "
    "are singular together.  If no two middle axes are parallel, every v is then u or -u: the "
    "hand is in one of the four orientations in which the legs turn freely, and the Jacobian is "
    "finite.  Where two middle axes are parallel, the Jacobian is not finite: the hand turns "
    "about them while the joints stand still.",
    {
        **{rf"\mathbf a_{k + 1}": rows[k] for k in range(3)},
        **{rf"B_{{{k + 1}{k + 1}}}": rates[k] for k in range(3)},
        "A": r"\begin{bmatrix} \mathbf a_1 & \mathbf a_2 & \mathbf a_3 \end{bmatrix}^T",
        "B": diag(*(Symbol(f"B_{k}{k}") for k in (1, 2, 3))),
        r"\Delta": Mul(*map(cos, q)) - Mul(*map(sin, q)),
        "J": "A^{-1} B",
        r"\det J": r"\frac{\det B}{\det A}",
        r"\kappa": r"\tfrac{1}{3}\,\lVert A\rVert_F\,\lVert A^{-1}\rVert_F",
    },
    proves="A and B are the derivatives, and in each mode det A is C - S.  The Jacobian J "
    "satisfies A*J = B, and its determinant is the square of C - S divided by the squares "
    "of the sines.",
    equal=[
        *((rows[k].dot(omega), -w[k].dot(omega.cross(V[:, k]))) for k in range(3)),
        *((rates[k], loop[k].diff(q[k])) for k in range(3)),
        *identities,
    ],
    uses=[stated],
)


def of_joints(name: str, summary: str, outputs: dict[str, object], *notes: str) -> None:
    """Export a function of the driven joints in each assembly mode, which a step has shown."""
    (output,) = outputs
    d.function(
        name,
        summary,
        {"q": q},
        outputs,
        program=v,
        branches=modes,
        notes=notes,
        equation=SHOWN.get(output, output),
    )


SHOWN = {"det": r"\det J", "factors": r"\Delta", "kappa": r"\kappa"}
"""The equations of results that a step does not show by their names."""
v = Program(list(f.body), f.taken)
A = v.matrix("A", A)
cross = [A[i, :].T.cross(A[j, :].T) for _, i, j in LEGS]
pole = "Not finite where the middle axes of two legs are parallel."
of_joints(
    "jacobian_parallel",
    "A of A*omega = B*dq; its rows are the cross products of w and v.",
    {"A": A},
)
of_joints(
    "jacobian_serial",
    "The diagonal of B of A*omega = B*dq.",
    {"B": list(y)},
    "Its signs distinguish the working modes; BRANCHES lists them in the same order.",
)
of_joints(
    "jacobian_space",
    "Angular velocity of the hand in the base frame per joint rate: A^-1*B.",
    {"J": jacobian(A, rho, tau)},
    pole,
)
of_joints(
    "determinant",
    "Determinant of jacobian_space.",
    {"det": found.gap**2 / Mul(*rho) ** 2},
    pole,
)
of_joints(
    "singularities",
    "The diagonal of B and the determinant of A.",
    {"factors": [*(v.let(f"B_{k}{k}", e) for k, e in enumerate(y, 1)), found.gap]},
)
of_joints(
    "condition_number",
    "Condition number of A in the Frobenius norm, divided by 3: 1 if its rows are at right angles.",
    {"kappa": sqrt(sum(e.dot(e) for e in cross) / 3) / Abs(found.gap)},
    "Infinite where the determinant of A vanishes.",
)
d.function(
    "passive_angles",
    "Angles of the middle joints: from u to v, about w.",
    {"q": q},
    {"phi": [atan2(-y[k], x[k]) for k in range(3)]},
    program=v,
    branches=modes,
    entries=passive,
)

# Skeleton

place = {e: found.link.lemma[e] for e in given}
at = V.xreplace(place)
points = {f"U{k + 1}": r * u[k] for k in range(3)}
points |= {f"W{k + 1}": r * w[k] for k in range(3)}
points |= {f"V{k + 1}": r * at[:, k] for k in range(3)}
points["O"] = Matrix([0, 0, 0])
points["P"] = r * (at[:, 0] + at[:, 1] + at[:, 2]) / 3
skeleton(
    d,
    points,
    links={
        "ground": ("U1", "U2", "U3", "U1"),
        **{f"crank{k}": (f"U{k}", f"W{k}") for k in (1, 2, 3)},
        **{f"rod{k}": (f"W{k}", f"V{k}") for k in (1, 2, 3)},
        "hand": ("V1", "V2", "V3", "V1"),
        **{f"hand{k}": ("P", f"V{k}") for k in (1, 2, 3)},
    },
    joints={x: ("O", f"U{k}") for k, x in enumerate(q, 1)},
    hand="P",
    ground=("U1", "U2", "U3"),
    lengths={
        **{
            pair: sqrt(2) * r
            for k in (1, 2, 3)
            for pair in ((f"U{k}", f"W{k}"), (f"W{k}", f"V{k}"))
        },
        **{pair: sqrt(2) * r for pair in (("V1", "V2"), ("V2", "V3"), ("V3", "V1"))},
        **{("P", f"V{k}"): sqrt(6) * r / 3 for k in (1, 2, 3)},
    },
    program=f,
    branches=modes,
)

# Inverse

g = d.program()
require_rotation(g, given)
links, values, cosines, sines, heights = [], [], [], [], []
signs = tuple(real(f"sigma_leg{k}") for k in (1, 2, 3))
for k, i, j in LEGS:
    beyond, ahead, number = V[i, k], V[j, k], k + 1
    start = len(g.body)
    h = g.let(f"h{number}", sqrt(beyond**2 + ahead**2), nonnegative=True)
    heights.append(h)
    along = f"the last axis of leg {number} is along the first"
    # the loop still closes to its own small size where v is almost along u
    free = g.vanishes(f"free{number}", h, Rational(1, 2**100), along, (q[k],))
    sines.append(g.let(f"s{number}", choose(free, 0, -signs[k] * beyond / h)))
    cosines.append(g.let(f"c{number}", choose(free, 1, signs[k] * ahead / h)))
    lemma = Lemma(
        "atan2 of a linear pair",
        r"(\cos x, \sin x) = \pm(g, f)/\sqrt{f^2 + g^2}",
        (loop[k],),
        {q[k]: atan2(sines[k], cosines[k])},
        2,
        signs=(signs[k],),
        roles=(("x", q[k]), ("f", -beyond), ("g", ahead)),
    )
    case = Degenerate((free,), {beyond: 0, ahead: 0}, q[k], along)
    links.append(
        Link((q[k],), lemma.equations, {}, lemma, tuple(g.body[start:]), degenerate=(case,))
    )
    values.append(lemma[q[k]])
gap = g.let("gap", Mul(*cosines) - Mul(*sines))
g.determined(
    Min(Abs(gap), *heights),
    1,
    "the cross products of w and v are in one plane",
    name=r"\min(|\det A|, |B_{kk}|)",
)
working = branches(*((sign, SIGN) for sign in signs))
d.branches = working.labels
d.step(
    "Inverse: leg by leg",
    "The middle axis w is at right angles to u and to v, so each leg has two solutions, half a "
    "turn apart.  Their signs are those of the diagonal of B.  The product of these signs is that "
    "of det A, so a working mode and an orientation determine the assembly mode.  Near the four "
    "orientations in which every v is u or -u, and where the middle axes of two legs are "
    "parallel, rounded joints do not determine the hand.  The status is SINGULAR if det A or an "
    "entry of B is less than 2^-10.",
    {},
    uses=[stated],
    solves={"ik": ()},
)
d.function(
    "ik",
    "The driven joints of all working modes.",
    {"R": given},
    {"q": values},
    program=g,
    branches=working,
    result="Solutions",
    notes=(
        "SINGULAR: the last axis of a leg is along its first one; its joint is free, and 0 is "
        "returned.",
        "SINGULAR also near it, where det A or B_kk is less than 2^-10: the loop closes, but one "
        "ulp of the joints moves the hand by more than 1e-12.",
        "INVALID: the matrix is not a proper rotation.",
    ),
)
d.inverses.append(Inverse("ik", q, (0,) * 3, loop, images="fk", links=tuple(links)))
for link in links:
    d.solved.append(Solved("ik", link.unknowns[0], link.lemma, link.lemma.equations[0]))

# Claims

state(d, q, [(u[k], w[k], p[k], V[:, k]) for k in range(3)], given, loop)
