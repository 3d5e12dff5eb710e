"""Claims of the textbooks about the Puma 560, checked by computation.

The books are cited for results that are common knowledge; the formulas have the form of the books.
Craig uses modified (proximal) Denavit-Hartenberg frames, Corke and Spong use standard ones.
"""

from functools import partial
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Derivation,
    denavit_hartenberg,
    real,
    rotation,
    rotation_parametrisation,
)
from closedform.proof.checks import Check, Count, Decimal, Deferred, Enumeration, Every, Identity

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


def craig_forward(d: Derivation, puma: Puma) -> None:
    """The twelve entries of the pose, and the relation of the two conventions."""
    a2, a3, d3, d4 = puma.lengths
    c1, c2, _, c4, c5, c6 = (cos(x) for x in puma.q)
    s1, s2, _, s4, s5, s6 = (sin(x) for x in puma.q)
    c23, s23 = cos(puma.q[1] + puma.q[2]), sin(puma.q[1] + puma.q[2])
    claim = partial(d.claim, where=CRAIG)
    T = craig_chain(puma)
    claim(
        "first column",
        r"$r_{11} = c_1[c_{23}(c_4c_5c_6 - s_4s_6) - s_{23}s_5c_6] + s_1(s_4c_5c_6 + c_4s_6)$, "
        r"$r_{21} = s_1[c_{23}(c_4c_5c_6 - s_4s_6) - s_{23}s_5c_6] - c_1(s_4c_5c_6 + c_4s_6)$, "
        r"$r_{31} = -s_{23}(c_4c_5c_6 - s_4s_6) - c_{23}s_5c_6$",
        Identity(
            sp.Matrix(
                [
                    c1 * (c23 * (c4 * c5 * c6 - s4 * s6) - s23 * s5 * c6)
                    + s1 * (s4 * c5 * c6 + c4 * s6),
                    s1 * (c23 * (c4 * c5 * c6 - s4 * s6) - s23 * s5 * c6)
                    - c1 * (s4 * c5 * c6 + c4 * s6),
                    -s23 * (c4 * c5 * c6 - s4 * s6) - c23 * s5 * c6,
                ]
            ),
            T[:3, 0],
        ),
    )
    claim(
        "second column",
        r"$r_{12} = c_1[c_{23}(-c_4c_5s_6 - s_4c_6) + s_{23}s_5s_6] + s_1(c_4c_6 - s_4c_5s_6)$, "
        r"$r_{22} = s_1[c_{23}(-c_4c_5s_6 - s_4c_6) + s_{23}s_5s_6] - c_1(c_4c_6 - s_4c_5s_6)$, "
        r"$r_{32} = -s_{23}(-c_4c_5s_6 - s_4c_6) + c_{23}s_5s_6$",
        Identity(
            sp.Matrix(
                [
                    c1 * (c23 * (-c4 * c5 * s6 - s4 * c6) + s23 * s5 * s6)
                    + s1 * (c4 * c6 - s4 * c5 * s6),
                    s1 * (c23 * (-c4 * c5 * s6 - s4 * c6) + s23 * s5 * s6)
                    - c1 * (c4 * c6 - s4 * c5 * s6),
                    -s23 * (-c4 * c5 * s6 - s4 * c6) + c23 * s5 * s6,
                ]
            ),
            T[:3, 1],
        ),
    )
    claim(
        "third column",
        r"$r_{13} = -c_1(c_{23}c_4s_5 + s_{23}c_5) - s_1s_4s_5$, "
        r"$r_{23} = -s_1(c_{23}c_4s_5 + s_{23}c_5) + c_1s_4s_5$, "
        r"$r_{33} = s_{23}c_4s_5 - c_{23}c_5$",
        Identity(
            sp.Matrix(
                [
                    -c1 * (c23 * c4 * s5 + s23 * c5) - s1 * s4 * s5,
                    -s1 * (c23 * c4 * s5 + s23 * c5) + c1 * s4 * s5,
                    s23 * c4 * s5 - c23 * c5,
                ]
            ),
            T[:3, 2],
        ),
    )
    claim(
        "position",
        r"$p_x = c_1[a_2c_2 + a_3c_{23} - d_4s_{23}] - d_3s_1$, "
        r"$p_y = s_1[a_2c_2 + a_3c_{23} - d_4s_{23}] + d_3c_1$, "
        r"$p_z = -a_3s_{23} - a_2s_2 - d_4c_{23}$",
        Identity(
            sp.Matrix(
                [
                    c1 * (a2 * c2 + a3 * c23 - d4 * s23) - d3 * s1,
                    s1 * (a2 * c2 + a3 * c23 - d4 * s23) + d3 * c1,
                    -a3 * s23 - a2 * s2 - d4 * c23,
                ]
            ),
            T[:3, 3],
        ),
    )
    mirrored = {puma.q[0]: -puma.q[0]}
    half = sp.diag(rotation("x", pi), 1)
    claim(
        "the two conventions",
        "with its base turned by $180^\\circ$ about $x$ and with $-\\theta_1$, Craig's arm is that "
        "of the standard table",
        Identity(half * T.subs(mirrored, simultaneous=True), puma.pose()),
    )


def craig_inverse(d: Derivation, puma: Puma) -> None:
    """The inverse, joint by joint, in Craig's convention."""
    claim = partial(d.claim, where=CRAIG)
    theta1, theta2, theta3, theta4, theta5, theta6 = puma.q
    p = sp.Matrix([real(n) for n in ("p_x", "p_y", "p_z")])
    claim(
        r"theta_1, theta_3, theta_23",
        r"$\theta_1 = \mathrm{Atan2}(p_y, p_x) - \mathrm{Atan2}(d_3, \pm\sqrt{p_x^2 + p_y^2 - "
        r"d_3^2})$, $\theta_3 = \mathrm{Atan2}(a_3, d_4) - \mathrm{Atan2}(K, \pm\sqrt{a_3^2 + "
        r"d_4^2 - K^2})$, $K = \frac{p_x^2 + p_y^2 + p_z^2 - a_2^2 - a_3^2 - d_3^2 - d_4^2}"
        r"{2a_2}$, $\theta_{23} = \mathrm{Atan2}[(-a_3 - a_2c_3)p_z - (c_1p_x + s_1p_y)(d_4 - "
        r"a_2s_3), (a_2s_3 - d_4)p_z + (a_3 + a_2c_3)(c_1p_x + s_1p_y)]$",
        Deferred(lambda: printed_position(puma, p)),
    )
    T = craig_chain(puma)
    r = T[:3, :3]
    c1, s1 = cos(theta1), sin(theta1)
    c23, s23 = cos(theta2 + theta3), sin(theta2 + theta3)
    c4, s4, c5, s5 = cos(theta4), sin(theta4), cos(theta5), sin(theta5)
    claim(
        "theta_4",
        r"$\theta_4 = \mathrm{Atan2}(-r_{13}s_1 + r_{23}c_1, -r_{13}c_1c_{23} - r_{23}s_1c_{23} + "
        r"r_{33}s_{23})$, the arguments being $s_4s_5$ and $c_4s_5$",
        Identity(
            sp.Matrix(
                [
                    -r[0, 2] * s1 + r[1, 2] * c1,
                    -r[0, 2] * c1 * c23 - r[1, 2] * s1 * c23 + r[2, 2] * s23,
                ]
            ),
            sp.Matrix([s4 * s5, c4 * s5]),
        ),
    )
    claim(
        "theta_5",
        r"$r_{13}(c_1c_{23}c_4 + s_1s_4) + r_{23}(s_1c_{23}c_4 - c_1s_4) - r_{33}(s_{23}c_4) = "
        r"-s_5$, $r_{13}(-c_1s_{23}) + r_{23}(-s_1s_{23}) + r_{33}(-c_{23}) = c_5$",
        Identity(
            sp.Matrix(
                [
                    r[0, 2] * (c1 * c23 * c4 + s1 * s4)
                    + r[1, 2] * (s1 * c23 * c4 - c1 * s4)
                    - r[2, 2] * s23 * c4,
                    -r[0, 2] * c1 * s23 - r[1, 2] * s1 * s23 - r[2, 2] * c23,
                ]
            ),
            sp.Matrix([-s5, c5]),
        ),
    )
    claim(
        "theta_6",
        r"$s_6 = -r_{11}(c_1c_{23}s_4 - s_1c_4) - r_{21}(s_1c_{23}s_4 + c_1c_4) + "
        r"r_{31}(s_{23}s_4)$, $c_6 = r_{11}[(c_1c_{23}c_4 + s_1s_4)c_5 - c_1s_{23}s_5] + "
        r"r_{21}[(s_1c_{23}c_4 - c_1s_4)c_5 - s_1s_{23}s_5] - r_{31}(s_{23}c_4c_5 + c_{23}s_5)$",
        Identity(
            sp.Matrix(
                [
                    -r[0, 0] * (c1 * c23 * s4 - s1 * c4)
                    - r[1, 0] * (s1 * c23 * s4 + c1 * c4)
                    + r[2, 0] * s23 * s4,
                    r[0, 0] * ((c1 * c23 * c4 + s1 * s4) * c5 - c1 * s23 * s5)
                    + r[1, 0] * ((s1 * c23 * c4 - c1 * s4) * c5 - s1 * s23 * s5)
                    - r[2, 0] * (s23 * c4 * c5 + c23 * s5),
                ]
            ),
            sp.Matrix([sin(theta6), cos(theta6)]),
        ),
    )
    flipped = {theta4: theta4 + pi, theta5: -theta5, theta6: theta6 + pi}
    claim(
        "flipped wrist",
        r"$\theta_4' = \theta_4 + 180^\circ$, $\theta_5' = -\theta_5$, $\theta_6' = \theta_6 + "
        r"180^\circ$ reach the same pose",
        Identity(T.subs(flipped, simultaneous=True), T),
    )


def printed_position(puma: Puma, p: sp.Matrix) -> Check:
    """Craig's first three angles, substituted into his forward map, for all signs of both roots."""
    a2, a3, d3, d4 = puma.lengths
    theta1, theta2, theta3 = puma.q[:3]
    forward = craig_chain(puma)[:3, 3]
    K = (p.dot(p) - a2**2 - a3**2 - d3**2 - d4**2) / (2 * a2)
    parts = {}
    for shoulder in (1, -1):
        for elbow in (1, -1):
            first = atan2(p[1], p[0]) - atan2(d3, shoulder * sqrt(p[0] ** 2 + p[1] ** 2 - d3**2))
            third = atan2(a3, d4) - atan2(K, elbow * sqrt(a3**2 + d4**2 - K**2))
            ahead = cos(first) * p[0] + sin(first) * p[1]
            both = atan2(
                (-a3 - a2 * cos(third)) * p[2] - ahead * (d4 - a2 * sin(third)),
                (a2 * sin(third) - d4) * p[2] + (a3 + a2 * cos(third)) * ahead,
            )
            angles = {theta1: first, theta2: both - third, theta3: third}
            name = f"signs {shoulder:+d}, {elbow:+d}"
            parts[name] = Identity(forward.xreplace(angles), p, (p.dot(p) - d3**2,))
    return Every(parts)


def corke(d: Derivation, puma: Puma) -> None:
    """Numbers that the Toolbox prints for its named postures."""
    claim = partial(d.claim, where=CORKE)
    postures = {
        "qz": ((0, 0, 0, 0, 0, 0), ("0.4521", "-0.1500", "0.4318")),
        "qr": ((0, pi / 2, -pi / 2, 0, 0, 0), ("0.0203", "-0.1500", "0.8636")),
        "qn": ((0, pi / 4, pi, 0, pi / 4, 0), ("0.5963", "-0.1501", "-0.01435")),
    }
    for name, (angles, printed) in postures.items():
        reached = puma.position.subs(puma.at(d, *angles))
        claim(
            f"fkine({name})",
            f"position ({', '.join(printed)})",
            Every({x: Decimal(n, e) for x, n, e in zip("xyz", printed, reached, strict=True)}),
        )
    rows = (
        ("0.1501", "0.0144", "0.3197", "0", "0", "0"),
        ("0.5963", "0", "0", "0", "0", "0"),
        ("0", "0.5963", "0.2910", "0", "0", "0"),
        ("0", "0", "0", "0.7071", "0", "1"),
        ("0", "-1", "-1", "0", "-1", "0"),
        ("1", "0", "0", "-0.7071", "0", "0"),
    )
    claim(
        "jacob0(qn)",
        "; ".join(" ".join(row) for row in rows),
        Deferred(lambda: printed_jacobian(d, puma, rows)),
    )
    claim(
        "rank of jacob0(qr)",
        "at qr the Jacobian has rank 5: q6 depends on q4",
        Every(
            {
                "rank": Enumeration(
                    5,
                    lambda: puma.J.subs(puma.at(d, *postures["qr"][0])).rank(),
                    "rank at qr",
                ),
                "columns": Identity(
                    puma.J[:, 3].subs(puma.q[4], 0), puma.J[:, 5].subs(puma.q[4], 0)
                ),
            }
        ),
    )


def printed_jacobian(d: Derivation, puma: Puma, rows: tuple[tuple[str, ...], ...]) -> Check:
    exact = puma.J.subs(puma.at(d, 0, pi / 4, pi, 0, pi / 4, 0))
    return Every(
        {
            f"row {i + 1}, column {j + 1}": Decimal(rows[i][j], exact[i, j])
            for i in range(6)
            for j in range(6)
        }
    )


def singularities(d: Derivation, puma: Puma) -> None:
    """Decoupling, and Spong's elbow manipulator as a special case."""
    a2, a3, d3, d4 = puma.lengths
    theta2, theta3 = puma.q[1:3]
    claim = partial(d.claim, where=SPONG)
    arm, wrist = puma.J[:3, :3], puma.J[3:, 3:]
    claim(
        "decoupling",
        r"$J = \begin{bmatrix} J_{11} & 0 \\ J_{21} & J_{22} \end{bmatrix}$, $\det J = \det J_{11}"
        r"\det J_{22}$",
        Every(
            {
                "block": Identity(puma.J[:3, 3:], sp.zeros(3)),
                "determinant": Identity(arm.det() * wrist.det(), puma.det),
            }
        ),
    )
    ours = {d3: sp.Integer(0), d4: sp.Integer(0)}
    printed = a2 * a3 * sin(theta3) * (a2 * cos(theta2) + a3 * cos(theta2 + theta3))
    claim(
        "elbow manipulator",
        r"with the forearm along its frame ($d_3 = d_4 = 0$), up to the sign, $\det J_{11} = "
        r"a_2a_3s_3(a_2c_2 + a_3c_{23})$",
        Identity(printed**2, arm.subs(ours).det() ** 2),
    )
    claim(
        "wrist singularity",
        r"the wrist is singular if $\theta_5 = 0$ or $\pi$: $z_3$ and $z_5$ are collinear",
        Every(
            {
                "determinant": Identity(wrist.det() ** 2, sin(puma.q[4]) ** 2),
                "axes": Identity(
                    wrist[:, 0].cross(wrist[:, 2]).dot(wrist[:, 0].cross(wrist[:, 2])),
                    sin(puma.q[4]) ** 2,
                ),
            }
        ),
    )


def configurations(d: Derivation, puma: Puma) -> None:
    """The number of solutions."""
    claim = partial(d.claim, where=LEE)
    p = [real(n) for n in ("p_x", "p_y", "p_z")]
    R = rotation_parametrisation()
    position = [a - b for a, b in zip(puma.position, p, strict=True)]
    claim(
        "four arm configurations",
        "“four possible solutions to the first three joints”",
        Count(position, puma.q[:3], 4),
    )
    claim(
        "two wrists",
        "“for each of these four solutions two possible solutions to the last three joints”",
        Count(list(puma.R36 - sp.Matrix(R)), puma.q[3:], 2),
    )
