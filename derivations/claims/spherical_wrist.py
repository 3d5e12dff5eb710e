"""Claims of Reddy and Babu about rotations and the spherical wrist."""

from functools import partial
from itertools import product
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, pi, sin, sqrt

from closedform import (
    Derivation,
    denavit_hartenberg,
    equal,
    exponential,
    real,
    rotation,
    rotation_parametrisation,
)
from closedform.proof.checks import (
    Check,
    Count,
    Deferred,
    Enumeration,
    Every,
    Identity,
    Posture,
    Refuted,
    Undecidable,
)

ORIENTATION = "Orientation Aspects of A Spherical Wrist"
SIGNS = {"upper signs": +1, "lower signs": -1}


class Wrist(NamedTuple):
    """The results of the derivation; the paper's phi, theta, varphi are theta4, theta5, theta6."""

    d6: sp.Symbol
    theta4: sp.Symbol
    theta5: sp.Symbol
    theta6: sp.Symbol
    R: sp.Matrix
    pose: sp.Matrix
    space: sp.Matrix

    @property
    def angles(self) -> tuple[sp.Symbol, sp.Symbol, sp.Symbol]:
        return self.theta4, self.theta5, self.theta6

    @property
    def shorthand(self) -> tuple[sp.Expr, ...]:
        """The paper's c4, s4, c5, s5, c6, s6."""
        return tuple(f(t) for t in self.angles for f in (cos, sin))


def printed_inverse(R: sp.Matrix, sign: int) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
    """Eqs. (13) and (16) with all upper or all lower signs: first, middle and last angle."""
    return (
        atan2(sign * R[1, 2], sign * R[0, 2]),
        atan2(sign * sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), R[2, 2]),
        atan2(sign * R[2, 1], -sign * R[2, 0]),
    )


def state(d: Derivation, wrist: Wrist) -> None:
    """Transcribe all claims, in the order of the paper."""
    rotations(d, wrist)
    euler_angles(d, wrist)
    denavit_hartenberg_wrist(d, wrist)
    results(d, wrist)


def rotations(d: Derivation, wrist: Wrist) -> None:
    """Spherical joints, representations of rotation, and eq. (11)."""
    R, pose = wrist.R, wrist.pose
    claim = partial(d.claim, where=ORIENTATION)
    a, alpha, offset, theta = real("a_i"), real("alpha_i"), real("d_i"), real("theta_i")

    claim(
        "one common point",
        "“Spherical wrist is having the axes of their joints intersecting at one common point.”",
        Identity(pose * sp.Matrix([0, 0, -wrist.d6, 1]), sp.Matrix([0, 0, 0, 1])),
    )
    turn = denavit_hartenberg(a, alpha, offset, theta)[:3, :3]
    claim(
        "revolute joints",
        "“These joints must be of the revolute type.”",
        Identity(turn.diff(offset), sp.zeros(3)),  # a prismatic joint does not turn anything
    )
    claim(
        "spherical joint",
        "“A spherical joint can be represented by three consecutive rotary joints with "
        "intersecting rotation axes.”",
        every_rotation(R, wrist.angles),
    )
    claim(
        "representations of rotation",
        "“There are many ways to represent rotation, including the following: Euler angles, Gibbs "
        "vector, Cayley-Klein parameters, Pauli spin matrices, axis and angle, orthonormal "
        "matrices, and Hamilton's quaternions.”",
        Deferred(partial(representations, wrist)),
    )
    frame = sp.Matrix(3, 3, lambda i, j: real(f"{'xyz'[i]}_{'uvw'[j]}"))  # columns i_u, j_v, k_w
    i_u, j_v, k_w = (frame[:, j] for j in range(3))
    i_x, j_y, k_z = (sp.eye(3)[:, j] for j in range(3))
    dots = sp.Matrix([[row.dot(column) for column in (i_u, j_v, k_w)] for row in (i_x, j_y, k_z)])
    p_uvw = sp.Matrix([real("p_u"), real("p_v"), real("p_w")])
    p_xyz = p_uvw[0] * i_u + p_uvw[1] * j_v + p_uvw[2] * k_w
    claim("point, before eq. (11)", r"$P_{xyz} = RP_{uvw}$", Identity(dots * p_uvw, p_xyz))
    claim(
        "eq. (11)",
        r"$R = \begin{bmatrix} i_x \cdot i_u & i_x \cdot j_v & i_x \cdot k_w \\ "
        r"j_y \cdot i_u & j_y \cdot j_v & j_y \cdot k_w \\ "
        r"k_z \cdot i_u & k_z \cdot j_v & k_z \cdot k_w \end{bmatrix}$",
        Identity(dots.subs(dict(zip(frame, R, strict=True))), R),
    )


def euler_angles(d: Derivation, wrist: Wrist) -> None:
    """The sequences of axes, and eqs. (12) and (13)."""
    _, phi, theta, varphi, R, _, space = wrist
    claim = partial(d.claim, where=f"{ORIENTATION}, A. Euler Angles")

    claim(
        "minimal representation",
        "“Euler angles are a minimal representation of relative orientation.”",
        Enumeration(3, space.subs(theta, pi / 2).rank, "independent rates, of three angles"),
    )
    first = rotation("z", phi)
    second = about(first[:, 1], theta) * first
    claim(
        "moving axes",
        "“This set of three angles describes a sequence of rotations about the axes of a moving "
        "reference frame.”",
        Identity(about(second[:, 2], varphi) * second, R),
    )
    claim(
        "twelve sequences",
        "“There are however many (12, to be exact) sets that describe the same orientation”",
        Deferred(partial(twelve, wrist)),
    )
    zxz = euler("zxz", (phi + pi / 2, theta, varphi - pi / 2))
    claim(
        "different sequences",
        "“different combination of axes (e.g. ZXZ, ZYZ, and so on) lead to different Euler angles”",
        Identity(zxz, R),
    )
    claim(
        "identical axes",
        "“Identical axes should not be in consecutive places (e.g. ZZZ).”",
        Enumeration(
            [axes for axes in SEQUENCES if axes[0] != axes[1] != axes[2]],
            independent_sequences,
            "sequences, of all 27, with independent rates",
        ),
    )
    claim(
        "product, before eq. (12)",
        r"$R_{z\gamma z} = R_{z,\phi} R_{y,\theta} R_{z,\varphi}$",
        Identity(rotation("z", phi) * rotation("y", theta) * rotation("z", varphi), R),
    )
    claim(
        "eq. (12)",
        r"$R_{z\gamma z} = \begin{bmatrix} c\phi c\theta c\varphi - s\phi s\varphi & "
        r"-c\phi c\theta s\varphi - s\phi c\varphi & c\phi s\theta \\ "
        r"s\phi c\theta c\varphi + c\phi s\varphi & -s\phi c\theta s\varphi + c\phi c\varphi & "
        r"s\phi s\theta \\ -s\theta c\varphi & s\theta s\varphi & c\theta \end{bmatrix}$",
        Identity(eq12(wrist), rotation("z", phi) * rotation("y", theta) * rotation("z", varphi)),
    )
    inverse_claims(
        claim,
        wrist,
        R,
        "eq. (13)",
        r"$\theta = a \tan 2(\pm\sqrt{(R_{13})^2 + (R_{23})^2}, R_{33})$",
        r"$\phi = a \tan 2(\pm R_{23}, \pm R_{13}),\quad "
        r"\varphi = a \tan 2(\pm R_{32}, \mp R_{31})$",
    )


def denavit_hartenberg_wrist(d: Derivation, wrist: Wrist) -> None:
    """Table II and eqs. (14) to (16)."""
    d6, theta4, theta5, theta6, R, pose, _ = wrist
    c4, s4, c5, s5, *_ = wrist.shorthand
    claim = partial(d.claim, where=f"{ORIENTATION}, B. D-H Convention")

    table = ((0, -pi / 2, 0, theta4), (0, pi / 2, 0, theta5), (0, 0, d6, theta6))
    by_angles = sp.Matrix.vstack(
        sp.Matrix.hstack(R, d6 * R[:, 2]), sp.Matrix([[0, 0, 0, 1]])
    )  # the rotation by Euler angles, with the hand at the distance d6 along its last axis
    claim(
        "Table II",
        r"$\begin{array}{ccccc} \text{Link} & a^i & \alpha^i & d^i & \theta^i \\ "
        r"4 & 0 & -90^\circ & 0 & \theta_4 \\ 5 & 0 & 90^\circ & 0 & \theta_5 \\ "
        r"6 & 0 & 0 & d^6 & \theta_6 \end{array}$",
        Identity(sp.prod(denavit_hartenberg(*row) for row in table), by_angles),
    )
    A4, A5, A6 = (denavit_hartenberg(*row) for row in table)
    claim("product, before eq. (14)", r"$T_6^3 = A_4 * A_5 * A_6$", Identity(A4 * A5 * A6, pose))
    eq14 = sp.Matrix.vstack(
        sp.Matrix.hstack(eq15(wrist), sp.Matrix([c4 * s5 * d6, s4 * s5 * d6, c5 * d6])),
        sp.Matrix([[0, 0, 0, 1]]),
    )
    claim(
        "eq. (14)",
        r"$T_6^3 = \begin{bmatrix} c_4 c_5 c_6 - s_4 s_6 & -c_4 s_5 s_6 - s_4 c_6 & c_4 s_5 & "
        r"c_4 s_5 d_6 \\ s_4 c_5 c_6 + c_4 s_6 & -s_4 c_5 s_6 + c_4 c_6 & s_4 s_5 & s_4 s_5 d_6 \\ "
        r"-s_5 c_6 & s_5 s_6 & c_5 & c_5 d_6 \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(eq14, pose),
    )
    at = {theta5: pi / 2, theta6: 0}
    claim(
        "form of eq. (14)",
        "“The above 4*4 homogeneous transformation matrix is in the form of eq. (6), so the "
        "rotation matrix from the above equation is”",
        Refuted(
            Identity(pose[2, 0].subs(at), sp.Integer(-1)),
            "the entry (3,1) of eq. (6) is 0, but at theta5 = pi/2, theta6 = 0 that of eq. (14) is "
            "-1",
            r"it is in the form of eq. (7), $\begin{bmatrix} {}^3R_6 & {}^3p_6 \\ 0 & 1 "
            r"\end{bmatrix}$",
            Identity(pose, by_angles),
        ),
    )
    claim(
        "eq. (15)",
        r"$R_6^3 = \begin{bmatrix} c_4 c_5 c_6 - s_4 s_6 & -c_4 s_5 s_6 - s_4 c_6 & c_4 s_5 \\ "
        r"s_4 c_5 c_6 + c_4 s_6 & -s_4 c_5 s_6 + c_4 c_6 & s_4 s_5 \\ "
        r"-s_5 c_6 & s_5 s_6 & c_5 \end{bmatrix}$",
        Identity(eq15(wrist), pose[:3, :3]),
    )
    inverse_claims(
        claim,
        wrist,
        pose[:3, :3],
        "eq. (16)",
        r"$\theta_5 = a \tan 2(\pm\sqrt{(R_{13})^2 + (R_{23})^2}, R_{33})$",
        r"$\theta_4 = a \tan 2(\pm R_{23}, \pm R_{13}),\quad "
        r"\theta_6 = a \tan 2(\pm R_{32}, \mp R_{31})$",
    )


def results(d: Derivation, wrist: Wrist) -> None:
    """The numerical example of an orientation."""
    claim = partial(d.claim, where="Results and Discussion, C")
    claim(
        "Results C, figure",
        "“The hands orientation after rotation is given by”",
        Undecidable("the orientation is taken from a drawing, Fig. 7"),
    )
    hand = sp.Matrix([[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    printed = dict(zip(wrist.angles, (-pi / 2, pi / 2, pi / 2), strict=True))
    claim(
        "Results C, hand",
        r"${}^A R_H = R_{zyz} = \begin{bmatrix} 1 & 0 & 0 \\ 0 & 0 & -1 \\ 0 & 1 & 0 "
        r"\end{bmatrix}$",
        Identity(hand, wrist.R.subs(printed)),
    )
    for label, names, forward in (
        ("Results C, Euler angles", (r"\phi", r"\theta", r"\varphi"), wrist.R),
        ("Results C, D-H angles", (r"\theta_4", r"\theta_5", r"\theta_6"), wrist.pose[:3, :3]),
    ):
        other = dict(zip(wrist.angles, printed_inverse(hand, -1), strict=True))
        degrees = ", ".join(str(angle * 180 / pi) for angle in other.values())
        claim(
            label,
            r"${} = -90^\circ,\ {} = 90^\circ,\ {} = 90^\circ$".format(*names),
            Every(
                {
                    "as printed": Posture(forward, printed, hand),
                    f"the lower signs, which the paper omits, give {degrees} degrees": Posture(
                        forward, other, hand
                    ),
                    "there are no others": Count(list(forward - hand), wrist.angles, len(SIGNS)),
                }
            ),
        )
    claim(
        "same joint angles",
        "“For the same rotation matrix, the joint angles obtained are equal for Euler angles and "
        "D-H convention method.”",
        Identity(wrist.pose[:3, :3], wrist.R),  # the same map, so the same solutions
    )
    claim(
        "same matrix",
        "“For the same joint angles, the rotation matrix obtained by using eq. (12) and eq. (15) "
        "is same.”",
        Identity(eq15(wrist), eq12(wrist)),
    )


def inverse_claims(
    claim: partial[None], wrist: Wrist, forward: sp.Matrix, label: str, middle: str, others: str
) -> None:
    """The inverse, which the paper prints twice; theta is theta5 in eq. (16)."""
    solutions = {name: printed_inverse(forward, sign) for name, sign in SIGNS.items()}
    claim(
        f"middle angle, before {label}",
        middle,
        Every(
            {
                name: Identity(
                    [cos(angles[1]), sin(angles[1]) ** 2],
                    [cos(wrist.theta5), sin(wrist.theta5) ** 2],
                )
                for name, angles in solutions.items()
            }
        ),
    )
    claim(
        f"condition of {label}",
        r"“If $\sin \theta \neq 0$, we have”",
        Every(
            {
                f"theta = {angle}: the other two angles are not determined": Count(
                    list(
                        forward
                        - forward.subs(dict.fromkeys(wrist.angles, 0) | {wrist.theta5: angle})
                    ),
                    wrist.angles,
                    None,
                )
                for angle in (sp.Integer(0), pi)
            }
        ),
    )
    claim(label, others, every_rotation(forward, wrist.angles))


def every_rotation(forward: sp.Matrix, angles: tuple[sp.Symbol, ...]) -> Check:
    """Eqs. (13) and (16) give all solutions of ``forward(angles) = R`` for every rotation R.

    The parametrisation excludes half turns.  Equations that hold around them also hold for them.
    """

    def check() -> Check:
        given = rotation_parametrisation()
        parts: dict[str, Check] = {
            name: Identity(
                forward.subs(dict(zip(angles, printed_inverse(given, sign), strict=True))),
                sp.Matrix(given),
            )
            for name, sign in SIGNS.items()
        }
        parts["there are no others"] = Count(list(forward - given), angles, len(SIGNS))
        return Every(parts)

    return Deferred(check)


def eq12(wrist: Wrist) -> sp.Matrix:
    """As printed."""
    c1, s1, c, s, c2, s2 = wrist.shorthand
    return sp.Matrix(
        [
            [c1 * c * c2 - s1 * s2, -c1 * c * s2 - s1 * c2, c1 * s],
            [s1 * c * c2 + c1 * s2, -s1 * c * s2 + c1 * c2, s1 * s],
            [-s * c2, s * s2, c],
        ]
    )


def eq15(wrist: Wrist) -> sp.Matrix:
    """As printed."""
    c4, s4, c5, s5, c6, s6 = wrist.shorthand
    return sp.Matrix(
        [
            [c4 * c5 * c6 - s4 * s6, -c4 * s5 * s6 - s4 * c6, c4 * s5],
            [s4 * c5 * c6 + c4 * s6, -s4 * c5 * s6 + c4 * c6, s4 * s5],
            [-s5 * c6, s5 * s6, c5],
        ]
    )


SEQUENCES = ["".join(axes) for axes in product("xyz", repeat=3)]
AXES = {name: sp.eye(3)[:, i] for i, name in enumerate("xyz")}


def about(axis: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """The rotation about a unit vector, by Rodrigues' formula."""
    return exponential(sp.Matrix([0, 0, 0, *axis]), angle)[:3, :3]


def euler(axes: str, angles: tuple[sp.Expr, ...]) -> sp.Matrix:
    """Three rotations about axes of the moving frame."""
    return sp.prod(rotation(axis, angle) for axis, angle in zip(axes, angles, strict=True))


def independent_sequences() -> list[str]:
    """The sequences of axes with independent angular velocities for some middle angle."""
    middle = real("middle")
    rates = (
        sp.Matrix.hstack(AXES[i], AXES[j], rotation(j, middle) * AXES[k]) for i, j, k in SEQUENCES
    )
    return [axes for axes, J in zip(SEQUENCES, rates, strict=True) if not equal(J.det(), 0)]


def twelve(wrist: Wrist) -> Check:
    """Twelve sequences of axes describe every orientation."""
    return Every(
        {
            "12": Enumeration(
                12,
                lambda: len(independent_sequences()),
                "sequences, of all 27, with independent rates",
            ),
            "each reaches the same rotations as ZYZ": Identity(*as_zyz(wrist)),
            "ZYZ reaches every rotation": every_rotation(wrist.R, wrist.angles),
        }
    )


def as_zyz(wrist: Wrist) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Each of the twelve sequences, and the same rotation by ZYZ between constant rotations.

    C takes z and y to the first two axes, and a turn by ``shift`` about y takes z to the third.
    """
    left, right = [], []
    for axes in independent_sequences():
        first, second, third = (AXES[axis] for axis in axes)
        C = sp.Matrix.hstack(second.cross(first), second, first)
        local = C.T * third
        shift = atan2(local[0], local[2])
        zyz = wrist.R.subs(wrist.theta5, wrist.theta5 + shift)
        left += list(euler(axes, wrist.angles))
        right += list(C * zyz * rotation("y", -shift) * C.T)
    return left, right


def representations(wrist: Wrist) -> Check:
    """Each listed representation of the rotation by ZYZ angles gives that rotation."""
    R = wrist.R
    z, y = (0, 0, 1), (0, 1, 0)
    turns = zip((z, y, z), wrist.angles, strict=True)
    q = sp.prod(sp.Quaternion.from_axis_angle(axis, angle) for axis, angle in turns)
    w, vector = q.a, sp.Matrix([q.b, q.c, q.d])
    turned = [q * sp.Quaternion(0, *axis) * sp.conjugate(q) for axis in sp.eye(3).tolist()]
    size = sqrt(vector.dot(vector))
    gibbs = sp.symbols("g1:4", real=True)
    spins = sp.symbols("k0:4", real=True)
    return Every(
        {
            "Euler angles": Identity(euler("zyz", wrist.angles), R),
            "Gibbs vector, except for half turns": Identity(
                sp.Matrix(rotation_parametrisation(gibbs)).subs(
                    dict(zip(gibbs, vector / w, strict=True))
                ),
                R,
            ),
            "Cayley-Klein parameters and Pauli spin matrices": Identity(
                spin_rotation(spins).subs(dict(zip(spins, (w, *vector), strict=True))), R
            ),
            "axis and angle": Identity(about(vector / size, 2 * atan2(size, w)), R),
            "orthonormal matrices": Identity(
                [*(R * R.T), *R[:, 0].cross(R[:, 1])], [*sp.eye(3), *R[:, 2]]
            ),
            "quaternions": Identity(sp.Matrix([[t.b, t.c, t.d] for t in turned]).T, R),
        }
    )


def spin_rotation(k: tuple[sp.Symbol, ...]) -> sp.Matrix:
    """R with ``U (p . sigma) U^+ = (R p) . sigma``, for the Cayley-Klein matrix U."""
    i = sp.I
    x, y, z = sp.Matrix([[0, 1], [1, 0]]), sp.Matrix([[0, -i], [i, 0]]), sp.diag(1, -1)
    U = k[0] * sp.eye(2) - i * (k[1] * x + k[2] * y + k[3] * z)
    return sp.Matrix(
        [[sp.expand((to * U * of * U.H).trace()) / 2 for of in (x, y, z)] for to in (x, y, z)]
    )
