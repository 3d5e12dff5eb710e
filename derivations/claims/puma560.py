"""Claims of the textbooks about the Puma 560, checked by computation.

The books are cited for results that are common knowledge; the formulas have the form of the books.
Craig uses modified (proximal) Denavit-Hartenberg frames, Corke and Spong use standard ones.
"""

from functools import partial
from itertools import product
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


def notation(puma: Puma) -> Notation:
    """The names of the books: sines, cosines, lengths and the rotation of Craig's pose."""
    T = craig_chain(puma)
    names = dict(zip(("a_2", "a_3", "d_3", "d_4"), puma.lengths, strict=True))
    for i, angle in enumerate(puma.q, 1):
        names |= {rf"\theta_{i}": angle, f"c_{i}": cos(angle), f"s_{i}": sin(angle)}
    both = puma.q[1] + puma.q[2]
    names |= {"c_{23}": cos(both), "s_{23}": sin(both)}
    names |= {f"r_{{{i + 1}{j + 1}}}": T[i, j] for i in range(3) for j in range(3)}
    return Notation(names)


def craig_forward(d: Derivation, puma: Puma) -> None:
    """The twelve entries of the pose, and the relation of the two conventions."""
    T = craig_chain(puma)
    names = notation(puma).extended(dict(zip(("p_x", "p_y", "p_z"), T[:3, 3], strict=True)))
    claim = partial(d.claim, where=CRAIG, notation=names, paraphrase=True)
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

    def conventions(half: Relation, axis: str, first: Relation) -> Check:
        base = sp.diag(rotation(axis, half.left), 1)
        return Identity(base * T.subs(puma.q[0], first.left), puma.pose())

    claim(
        "the two conventions",
        "with its base turned by $180^\\circ$ about {x} and with $-\\theta_1$, Craig's arm is that "
        "of the standard table",
        conventions,
        phrases=[{axis: axis for axis in "xyz"}],
    )


def craig_inverse(d: Derivation, puma: Puma) -> None:
    """The inverse, joint by joint, in Craig's convention."""
    names = notation(puma)
    claim = partial(d.claim, where=CRAIG, notation=names, paraphrase=True)
    T = craig_chain(puma)
    a2, a3, d3, d4 = puma.lengths
    theta1, theta2, theta3 = puma.q[:3]
    px, py, K, both = real("p_x"), real("p_y"), real("K"), real("theta_23")
    hand = dict(zip(("p_x", "p_y", "p_z"), T[:3, 3], strict=True))
    beside = cos(theta1) * py - sin(theta1) * px - d3

    claim(
        "θ_1",
        r"$\theta_1 = \mathrm{Atan2}(p_y, p_x) - \mathrm{Atan2}(d_3, \pm\sqrt{p_x^2 + p_y^2 - "
        r"d_3^2})$",
        lambda f: Every(
            {
                "the hand is beside the arm": Identity(beside.subs({px: T[0, 3], py: T[1, 3]}), 0),
                "all its angles solve this": Solves(
                    {f.left: f.right}, [beside], nonnegative=(px**2 + py**2 - d3**2,)
                ),
            }
        ),
        means={r"\mathrm{Atan2}": atan2, "p_x": px, "p_y": py},
    )
    claim(
        "K",
        r"$K = \frac{p_x^2 + p_y^2 + p_z^2 - a_2^2 - a_3^2 - d_3^2 - d_4^2}{2a_2}$",
        means=hand | {"K": a3 * cos(theta3) - d4 * sin(theta3)},
    )
    claim(
        "θ_3",
        r"$\theta_3 = \mathrm{Atan2}(a_3, d_4) - \mathrm{Atan2}(K, \pm\sqrt{a_3^2 + d_4^2 - K^2})$",
        lambda f: Solves(
            {f.left: f.right},
            [a3 * cos(theta3) - d4 * sin(theta3) - K],
            nonnegative=(a3**2 + d4**2 - K**2,),
        ),
        means={r"\mathrm{Atan2}": atan2, "K": K},
    )

    def direction(formula: Relation) -> Check:
        """The printed pair is a vector along the upper arm, which points the same way."""
        y, x = formula.right
        turned = rotation("z", -formula.left)
        ahead = (a2 * cos(theta3) + a3) ** 2 + (d4 - a2 * sin(theta3)) ** 2
        along = turned * sp.Matrix([x, y, 0])
        return Identity([e.subs(both, theta2 + theta3) for e in along[:2]], [ahead, sp.S.Zero])

    claim(
        "θ_23",
        r"$\theta_{23} = \mathrm{Atan2}[(-a_3 - a_2c_3)p_z - (c_1p_x + s_1p_y)(d_4 - a_2s_3), "
        r"(a_2s_3 - d_4)p_z + (a_3 + a_2c_3)(c_1p_x + s_1p_y)]$",
        direction,
        means={r"\mathrm{Atan2}": lambda y, x: (y, x), r"\theta_{23}": both} | hand,
    )

    def arguments(formula: Relation, y: Relation, x: Relation) -> Check:
        angle, printed = formula.left, formula.right
        return Every(
            {
                "the arguments are those printed": Identity(printed, sp.Matrix([y.left, x.left])),
                "their ratio is the tangent": Identity(
                    printed[0] * cos(angle), printed[1] * sin(angle)
                ),
            }
        )

    claim(
        "θ_4",
        r"$\theta_4 = \mathrm{Atan2}(-r_{13}s_1 + r_{23}c_1, -r_{13}c_1c_{23} - r_{23}s_1c_{23} + "
        r"r_{33}s_{23})$, the arguments being $s_4s_5$ and $c_4s_5$",
        arguments,
        means={r"\mathrm{Atan2}": lambda y, x: sp.Matrix([y, x])},
    )
    claim(
        "θ_5",
        r"$r_{13}(c_1c_{23}c_4 + s_1s_4) + r_{23}(s_1c_{23}c_4 - c_1s_4) - r_{33}(s_{23}c_4) = "
        r"-s_5$, $r_{13}(-c_1s_{23}) + r_{23}(-s_1s_{23}) + r_{33}(-c_{23}) = c_5$",
    )
    claim(
        "θ_6",
        r"$s_6 = -r_{11}(c_1c_{23}s_4 - s_1c_4) - r_{21}(s_1c_{23}s_4 + c_1c_4) + "
        r"r_{31}(s_{23}s_4)$, $c_6 = r_{11}[(c_1c_{23}c_4 + s_1s_4)c_5 - c_1s_{23}s_5] + "
        r"r_{21}[(s_1c_{23}c_4 - c_1s_4)c_5 - s_1s_{23}s_5] - r_{31}(s_{23}c_4c_5 + c_{23}s_5)$",
    )
    primed = {rf"\theta_{i}'": real(f"theta{i}_flipped") for i in (4, 5, 6)}
    meant = dict(zip(primed.values(), puma.q[3:], strict=True))

    def flipped(*formulas: Relation) -> Check:
        posture = {meant[f.left]: f.right for f in formulas}
        return Identity(T.subs(posture, simultaneous=True), T)

    claim(
        "flipped wrist",
        r"$\theta_4' = \theta_4 + 180^\circ$, $\theta_5' = -\theta_5$, $\theta_6' = \theta_6 + "
        r"180^\circ$ reach the same pose",
        flipped,
        means=primed,
    )


def corke(d: Derivation, puma: Puma) -> None:
    """Numbers that the Toolbox prints for its named postures."""
    claim = partial(d.claim, where=CORKE, paraphrase=True)
    postures = {
        "qz": ((0, 0, 0, 0, 0, 0), "$x = 0.4521$, $y = -0.1500$, $z = 0.4318$"),
        "qr": ((0, pi / 2, -pi / 2, 0, 0, 0), "$x = 0.0203$, $y = -0.1500$, $z = 0.8636$"),
        "qn": ((0, pi / 4, pi, 0, pi / 4, 0), "$x = 0.5963$, $y = -0.1501$, $z = -0.01435$"),
    }
    for name, (angles, printed) in postures.items():
        reached = puma.position.subs(puma.at(d, *angles))
        claim(
            f"fkine({name})",
            printed,
            lambda *formulas: Every(
                {x: Rounded(f, f.left) for x, f in zip("xyz", formulas, strict=True)}
            ),
            means=dict(zip("xyz", reached, strict=True)),
        )
    exact = puma.J.subs(puma.at(d, *postures["qn"][0]))
    claim(
        "jacob0(qn)",
        r"$J = \begin{bmatrix} 0.1501 & 0.0144 & 0.3197 & 0 & 0 & 0 \\ 0.5963 & 0 & 0 & 0 & 0 & 0 "
        r"\\ 0 & 0.5963 & 0.2910 & 0 & 0 & 0 \\ 0 & 0 & 0 & 0.7071 & 0 & 1 \\ "
        r"0 & -1 & -1 & 0 & -1 & 0 \\ 1 & 0 & 0 & -0.7071 & 0 & 0 \end{bmatrix}$",
        rounded_entries,
        means={"J": exact},
    )

    def dependent(rank: int, one: Relation, other: Relation) -> Check:
        at = puma.at(d, *postures["qr"][0])
        a, b = (puma.J[:, puma.q.index(joint.left)] for joint in (one, other))
        return Every(
            {
                "the rank falls": Enumeration(rank, lambda: puma.J.subs(at).rank(), "rank at qr"),
                "the two columns are equal": Identity(a.subs(at), b.subs(at)),
            }
        )

    claim(
        "rank of jacob0(qr)",
        "at qr the Jacobian has rank {five}: $q_6$ depends on $q_4$",
        dependent,
        means={f"q_{i}": q for i, q in enumerate(puma.q, 1)},
    )


def rounded_entries(matrix: Relation) -> Check:
    """Each entry of a printed matrix is rounded to the digits of the longest."""
    exact, printed = matrix.sides
    entries = {}
    for i, j in product(range(exact.rows), range(exact.cols)):
        sides = (exact[i, j], printed[i, j])
        entry = Relation(sides, matrix.signs, matrix.texts, matrix.decimals)
        entries[f"row {i + 1}, column {j + 1}"] = Rounded(entry, entry.left)
    return Every(entries)


def singularities(d: Derivation, puma: Puma) -> None:
    """Decoupling, and Spong's elbow manipulator as a special case."""
    arm, wrist = puma.J[:3, :3], puma.J[3:, 3:]
    factors = {
        "J": puma.J,
        "J_{11}": arm,
        "J_{21}": puma.J[3:, :3],
        "J_{22}": wrist,
        r"\det": lambda matrix: puma.det if matrix == puma.J else matrix.det(),
        **{f"z_{i + 3}": wrist[:, i] for i in range(3)},
    }
    names = notation(puma).extended(factors)
    claim = partial(d.claim, where=SPONG, notation=names, paraphrase=True)
    claim(
        "decoupling",
        r"$J = \begin{bmatrix} J_{11} & 0 \\ J_{21} & J_{22} \end{bmatrix}$, $\det J = \det J_{11}"
        r"\det J_{22}$",
    )

    def special(given: Relation, formula: Relation) -> Check:
        case = dict.fromkeys(given.sides[:-1], given.right)
        return Identity(formula.right.subs(case) ** 2, formula.left.subs(case) ** 2)

    claim(
        "elbow manipulator",
        r"with the forearm along its frame ($d_4 = 0$), up to the sign, $\det J_{11} = "
        r"a_2a_3s_3(a_2c_2 + a_3c_{23})$",
        special,
    )

    def singular(first: Relation, second: Relation, one: Relation, other: Relation) -> Check:
        if one.left == other.left:
            raise ValueError("an axis is collinear with itself")
        postures = [{first.left: first.right}, {first.left: second.left}]
        cross = one.left.cross(other.left)
        return Identity(
            [e.subs(at) for at in postures for e in (wrist.det(), *cross)],
            [sp.S.Zero] * 2 * (1 + len(cross)),
        )

    claim(
        "wrist singularity",
        r"the wrist is singular if $\theta_5 = 0$ or $\pi$: $z_3$ and $z_5$ are collinear",
        singular,
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
