"""Claims of the textbooks about the Puma 560, checked by computation.

The books are cited for results that are common knowledge; the formulas have the form of the books.
Craig uses modified (proximal) Denavit-Hartenberg frames, Corke and Spong use standard ones.
"""

from functools import partial
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, pi, sin

from closedform import (
    Check,
    Count,
    Derivation,
    Enumeration,
    Every,
    Identity,
    Notation,
    Relation,
    Rounded,
    Solves,
    denavit_hartenberg,
    real,
    rotation,
    rotation_parametrisation,
)

CRAIG = "Craig, Introduction to Robotics: Unimation PUMA 560"
CORKE = "Corke, Robotics Toolbox: p560"
SPONG = "Spong, Hutchinson, Vidyasagar, Robot Modeling and Control: decoupling of singularities"
LEE = "Lee, Ziegler: arm configurations"


class Puma(NamedTuple):
    """The results of the derivation."""

    lengths: tuple[sp.Symbol, ...]
    q: tuple[sp.Symbol, ...]
    links: list[sp.Matrix]
    position: sp.Matrix
    R36: sp.Matrix
    J: sp.Matrix
    det: sp.Expr

    def pose(self) -> sp.Matrix:
        return sp.prod(self.links)

    def at(self, d: Derivation, *angles: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
        """A posture of the arm with the example dimensions."""
        values: dict[sp.Symbol, sp.Expr] = {p.symbol: p.value for p in d.parameters}
        return values | dict(zip(self.q, map(sp.sympify, angles), strict=True))


def state(d: Derivation, puma: Puma) -> None:
    """Transcribe the claims."""
    craig_forward(d, puma)
    craig_inverse(d, puma)
    corke(d, puma)
    singularities(d, puma)
    configurations(d, puma)


def notation(puma: Puma) -> Notation:
    """The names that the books share; ``r_{ij}`` and ``p_x`` are entries of Craig's product."""
    theta2, theta3 = puma.q[1:3]
    names = dict(zip(("a_2", "a_3", "d_3", "d_4"), puma.lengths, strict=True))
    for index, angle in (*zip("123456", puma.q, strict=True), ("{23}", theta2 + theta3)):
        names |= {f"c_{index}": cos(angle), f"s_{index}": sin(angle)}
        names[rf"\theta_{index}"] = angle
    T = craig_chain(puma)
    names |= {f"r_{{{i + 1}{j + 1}}}": T[i, j] for i in range(3) for j in range(3)}
    names |= {f"p_{axis}": T[k, 3] for k, axis in enumerate("xyz")}
    return Notation(names)


def craig_chain(puma: Puma) -> sp.Matrix:
    """The product of Craig's table of modified parameters."""
    a2, a3, d3, d4 = puma.lengths
    rows = [(0, 0, 0), (0, -pi / 2, 0), (a2, 0, d3), (a3, -pi / 2, d4), (0, pi / 2, 0)]
    rows.append((0, -pi / 2, 0))
    return sp.prod(
        [
            denavit_hartenberg(a, alpha, offset, theta, modified=True)
            for (a, alpha, offset), theta in zip(rows, puma.q, strict=True)
        ]
    )


def craig_forward(d: Derivation, puma: Puma) -> None:
    """The twelve entries of the pose, and the relation of the two conventions."""
    claim = partial(d.claim, where=CRAIG, notation=notation(puma), paraphrase=True)
    claim(
        "first column",
        r"$r_{11} = c_1[c_{23}(c_4c_5c_6 - s_4s_6) - s_{23}s_5c_6] + s_1(s_4c_5c_6 + c_4s_6)$, "
        r"$r_{21} = s_1[c_{23}(c_4c_5c_6 - s_4s_6) - s_{23}s_5c_6] - c_1(s_4c_5c_6 + c_4s_6)$, "
        r"$r_{31} = -s_{23}(c_4c_5c_6 - s_4s_6) - c_{23}s_5c_6$",
    )
    claim(
        "second column",
        r"$r_{12} = c_1[c_{23}(-c_4c_5s_6 - s_4c_6) + s_{23}s_5s_6] + s_1(c_4c_6 - s_4c_5s_6)$, "
        r"$r_{22} = s_1[c_{23}(-c_4c_5s_6 - s_4c_6) + s_{23}s_5s_6] - c_1(c_4c_6 - s_4c_5s_6)$, "
        r"$r_{32} = -s_{23}(-c_4c_5s_6 - s_4c_6) + c_{23}s_5s_6$",
    )
    claim(
        "third column",
        r"$r_{13} = -c_1(c_{23}c_4s_5 + s_{23}c_5) - s_1s_4s_5$, "
        r"$r_{23} = -s_1(c_{23}c_4s_5 + s_{23}c_5) + c_1s_4s_5$, "
        r"$r_{33} = s_{23}c_4s_5 - c_{23}c_5$",
    )
    claim(
        "position",
        r"$p_x = c_1[a_2c_2 + a_3c_{23} - d_4s_{23}] - d_3s_1$, "
        r"$p_y = s_1[a_2c_2 + a_3c_{23} - d_4s_{23}] + d_3c_1$, "
        r"$p_z = -a_3s_{23} - a_2s_2 - d_4c_{23}$",
    )
    claim(
        "the two conventions",
        "with its base turned by $180^\\circ$ about {x} and with $-\\theta_1$, Craig's arm is that "
        "of the standard table",
        lambda angle, axis, first: Identity(
            sp.diag(rotation(axis, angle.left), 1)
            * craig_chain(puma).subs({puma.q[0]: first.left}, simultaneous=True),
            puma.pose(),
        ),
        phrases=[{"x": "x", "y": "y"}],
    )


def craig_inverse(d: Derivation, puma: Puma) -> None:
    """The inverse, joint by joint, in Craig's convention."""
    place = {f"p_{axis}": real(f"p_{axis}") for axis in "xyz"}
    names = {r"\mathrm{Atan2}": atan2, "K": real("K")}
    claim = partial(d.claim, where=CRAIG, notation=notation(puma), paraphrase=True)
    claim(
        "theta_1, theta_3, theta_23",
        r"$\theta_1 = \mathrm{Atan2}(p_y, p_x) - \mathrm{Atan2}(d_3, \pm\sqrt{p_x^2 + p_y^2 - "
        r"d_3^2})$, $\theta_3 = \mathrm{Atan2}(a_3, d_4) - \mathrm{Atan2}(K, \pm\sqrt{a_3^2 + "
        r"d_4^2 - K^2})$, $K = \frac{p_x^2 + p_y^2 + p_z^2 - a_2^2 - a_3^2 - d_3^2 - d_4^2}"
        r"{2a_2}$, $\theta_{23} = \mathrm{Atan2}[(-a_3 - a_2c_3)p_z - (c_1p_x + s_1p_y)(d_4 - "
        r"a_2s_3), (a_2s_3 - d_4)p_z + (a_3 + a_2c_3)(c_1p_x + s_1p_y)]$",
        partial(every_sign, puma, sp.Matrix(list(place.values()))),
        means=place | names,
    )
    claim(
        "theta_4",
        r"$\theta_4 = \mathrm{Atan2}(-r_{13}s_1 + r_{23}c_1, -r_{13}c_1c_{23} - r_{23}s_1c_{23} + "
        r"r_{33}s_{23})$, the arguments being $s_4s_5$ and $c_4s_5$",
        lambda angle, sine, cosine: Every(
            {
                "the arguments": Identity([*angle.right.args], [sine.left, cosine.left]),
                "the angle": Identity(
                    [sin(angle.left) * sin(puma.q[4]), cos(angle.left) * sin(puma.q[4])],
                    [*angle.right.args],
                ),
            }
        ),
        means=names,
    )
    claim(
        "theta_5",
        r"$r_{13}(c_1c_{23}c_4 + s_1s_4) + r_{23}(s_1c_{23}c_4 - c_1s_4) - r_{33}(s_{23}c_4) = "
        r"-s_5$, $r_{13}(-c_1s_{23}) + r_{23}(-s_1s_{23}) + r_{33}(-c_{23}) = c_5$",
    )
    claim(
        "theta_6",
        r"$s_6 = -r_{11}(c_1c_{23}s_4 - s_1c_4) - r_{21}(s_1c_{23}s_4 + c_1c_4) + "
        r"r_{31}(s_{23}s_4)$, $c_6 = r_{11}[(c_1c_{23}c_4 + s_1s_4)c_5 - c_1s_{23}s_5] + "
        r"r_{21}[(s_1c_{23}c_4 - c_1s_4)c_5 - s_1s_{23}s_5] - r_{31}(s_{23}c_4c_5 + c_{23}s_5)$",
    )
    primed = [real(f"theta_{k}'") for k in (4, 5, 6)]
    turned = dict(zip(primed, puma.q[3:], strict=True))
    claim(
        "flipped wrist",
        r"$\theta_4' = \theta_4 + 180^\circ$, $\theta_5' = -\theta_5$, $\theta_6' = \theta_6 + "
        r"180^\circ$ reach the {same} pose",
        lambda *pieces: Identity(
            pieces[-1]
            * craig_chain(puma).subs(
                {turned[f.left]: f.right for f in pieces[:-1]},
                simultaneous=True,
            ),
            craig_chain(puma),
        ),
        means={rf"\theta_{k}'": s for k, s in zip((4, 5, 6), primed, strict=True)},
        phrases=[{"same": sp.eye(4), "opposite": sp.diag(rotation("x", pi), 1)}],
    )


def every_sign(puma: Puma, p: sp.Matrix, *formulas: Relation) -> Check:
    """The first three angles, one after the other, for all signs of both roots.

    Each formula gives all solutions of an equation that the forward map satisfies.
    """
    a2, a3, d3, d4 = puma.lengths
    theta1, theta2, theta3 = puma.q[:3]
    first, third, square, both = formulas
    forward = dict(zip(p, craig_chain(puma)[:3, 3], strict=True))
    ahead = cos(theta1) * p[0] + sin(theta1) * p[1]
    sum_, elbow = real("theta_23"), a3 * cos(theta3) - d4 * sin(theta3)
    along, across = a2 * cos(theta3) + a3, d4 - a2 * sin(theta3)
    beside = cos(theta1) * p[1] - sin(theta1) * p[0] - d3
    in_fore_arm = [
        ahead * cos(sum_) - p[2] * sin(sum_) - along,
        -ahead * sin(sum_) - p[2] * cos(sum_) - across,
    ]
    true_sum = {sum_: theta2 + theta3}
    names = [first.left, third.left, square.left, both.left]
    return Every(
        {
            "the names": Identity(names, [theta1, theta3, real("K"), theta2 + theta3]),
            "the equations": Identity(
                [e.subs(true_sum).subs(forward) for e in (beside, *in_fore_arm)], [sp.S.Zero] * 3
            ),
            "theta1": Solves(
                {theta1: first.right}, [beside], nonnegative=(p[0] ** 2 + p[1] ** 2 - d3**2,)
            ),
            "K": Identity(square.right.subs(forward), elbow),
            "theta3": Solves(
                {theta3: third.right},
                [elbow - square.left],
                nonnegative=(a3**2 + d4**2 - square.left**2,),
            ),
            "theta23": Solves(
                {sum_: both.right},
                in_fore_arm,
                nonnegative=(sp.expand(along**2 + across**2),),
                given=forward,
            ),
        }
    )


def corke(d: Derivation, puma: Puma) -> None:
    """Numbers that the Toolbox prints for its named postures."""
    claim = partial(d.claim, where=CORKE, paraphrase=True)
    postures = {
        "qz": (0, 0, 0, 0, 0, 0),
        "qr": (0, pi / 2, -pi / 2, 0, 0, 0),
        "qn": (0, pi / 4, pi, 0, pi / 4, 0),
    }
    printed = {
        "qz": r"$x = 0.4521$, $y = -0.1500$, $z = 0.4318$",
        "qr": r"$x = 0.0203$, $y = -0.1500$, $z = 0.8636$",
        "qn": r"$x = 0.5963$, $y = -0.1501$, $z = -0.01435$",
    }
    coordinates = [real(n) for n in "xyz"]
    for name, text in printed.items():
        reached = puma.position.subs(puma.at(d, *postures[name]))
        claim(
            f"fkine({name})",
            f"position {text}",
            partial(rounded, coordinates, list(reached)),
            notation=Notation(dict(zip("xyz", coordinates, strict=True))),
        )
    entries = [[real(f"J_{{{i}{j}}}") for j in range(1, 7)] for i in range(1, 7)]
    rows = (
        ("0.1501", "0.0144", "0.3197", "0", "0", "0"),
        ("0.5963", "0", "0", "0", "0", "0"),
        ("0", "0.5963", "0.2910", "0", "0", "0"),
        ("0", "0", "0", "0.7071", "0", "1"),
        ("0", "-1", "-1", "0", "-1", "0"),
        ("1", "0", "0", "-0.7071", "0", "0"),
    )
    names = [s for row in entries for s in row]
    numbers = [n for row in rows for n in row]
    claim(
        "jacob0(qn)",
        ", ".join(f"${s} = {n}$" for s, n in zip(names, numbers, strict=True)),
        lambda *f: rounded(names, list(puma.J.subs(puma.at(d, *postures["qn"]))), *f),
        notation=Notation({str(s): s for s in names}),
    )
    claim(
        "rank of jacob0(qr)",
        "at qr the Jacobian has rank {five}: q6 depends on {q4}",
        lambda rank, column: Every(
            {
                "rank": Enumeration(
                    rank, lambda: puma.J.subs(puma.at(d, *postures["qr"])).rank(), "rank at qr"
                ),
                "columns": Identity(
                    puma.J[:, column].subs(puma.q[4], 0), puma.J[:, 5].subs(puma.q[4], 0)
                ),
            }
        ),
        phrases=[{"q4": 3, "q5": 4}],
    )


def rounded(names: list[sp.Symbol], exact: list[sp.Expr], *printed: Relation) -> Check:
    """Printed decimals, each with the name of what it rounds."""
    return Every(
        {
            str(name): Every({"name": Identity(f.left, name), "number": Rounded(f, value)})
            for name, value, f in zip(names, exact, printed, strict=True)
        }
    )


def singularities(d: Derivation, puma: Puma) -> None:
    """Decoupling, and Spong's elbow manipulator as a special case."""
    _, _, d3, d4 = puma.lengths
    arm, wrist = puma.J[:3, :3], puma.J[3:, 3:]
    names = notation(puma).extended(
        {"J": puma.J, "J_{11}": arm, "J_{21}": puma.J[3:, :3], "J_{22}": wrist}
    )
    names = names.extended(
        {r"\det J": puma.det, r"\det J_{11}": arm.det(), r"\det J_{22}": wrist.det()}
    )
    claim = partial(d.claim, where=SPONG, notation=names, paraphrase=True)
    claim(
        "decoupling",
        r"$J = \begin{bmatrix} J_{11} & 0 \\ J_{21} & J_{22} \end{bmatrix}$, $\det J = \det J_{11} "
        r"\det J_{22}$",
    )
    ours = {d3: sp.S.Zero, d4: sp.S.Zero}
    claim(
        "elbow manipulator",
        r"with the forearm along its frame ($d_3 = d_4 = 0$), up to the sign, $\det J_{11} = "
        r"a_2a_3s_3(a_2c_2 + a_3c_{23})$",
        lambda lengths, formula: Every(
            {
                "the lengths": Identity([*lengths.sides[:2]], [d3, d4]),
                "the square of the determinant": Identity(
                    *(e.subs(dict.fromkeys(ours, lengths.right)) ** 2 for e in formula.sides)
                ),
            }
        ),
    )
    axes = {"z_3": wrist[:, 0], "z_5": wrist[:, 2], r"\theta_5": puma.q[4]}

    def aligned(first: Relation, second: Relation, a: Relation, b: Relation, how: str) -> Check:
        apart = {"collinear": a.left.cross(b.left), "perpendicular": a.left.dot(b.left)}[how]
        parts: dict[str, Check] = {}
        for case in (first, second):
            at = {puma.q[4]: case.right}
            parts[case.texts[1]] = Every(
                {
                    "the angle": Identity(case.left, puma.q[4]),
                    "determinant": Identity(wrist.det().subs(at), sp.S.Zero),
                    "axes": Identity(
                        [*sp.Matrix([apart]).subs(at)], [sp.S.Zero] * len(sp.Matrix([apart]))
                    ),
                }
            )
        parts["the names"] = Identity(sp.Matrix([a.left, b.left]), sp.Matrix([*axes_of_wrist]))
        return Every(parts)

    axes_of_wrist = wrist[:, 0], wrist[:, 2]
    claim(
        "wrist singularity",
        r"the wrist is singular if $\theta_5 = 0$ or $\theta_5 = \pi$: $z_3$ and $z_5$ are "
        "{collinear}",
        aligned,
        means=axes,
        phrases=[{how: how for how in ("collinear", "perpendicular")}],
    )


def configurations(d: Derivation, puma: Puma) -> None:
    """The number of solutions."""
    claim = partial(d.claim, where=LEE, paraphrase=True)
    p = [real(n) for n in ("p_x", "p_y", "p_z")]
    R = rotation_parametrisation()
    position = [a - b for a, b in zip(puma.position, p, strict=True)]
    claim(
        "four arm configurations",
        "{four} possible solutions to the first three joints",
        lambda n: Count(position, puma.q[:3], n),
    )
    claim(
        "two wrists",
        "for each of these four solutions {two} possible solutions to the last three joints",
        lambda n: Count(list(puma.R36 - sp.Matrix(R)), puma.q[3:], n),
    )
