"""Section IV A of Shi, Zhu and Li: screws, exponentials and the forward map, eqs. (1) to (13)."""

from functools import partial
from typing import Any

import sympy as sp
from closedform.derivations.claims.irb260_arm import (
    FORWARD,
    Palletiser,
    each,
    euler_angles,
    screw_motion,
    stated,
    turned,
    unit_axis,
    vector,
)
from sympy import cos, sin

from closedform import (
    Count,
    Derivation,
    Enumeration,
    Equal,
    Every,
    Identity,
    Not,
    Notation,
    Reading,
    Relation,
    equal,
    exponential,
    homogeneous,
    inverse,
    real,
    rotation,
    twist_matrix,
    twist_of,
)

AXES = (
    (
        r"$q_1 = \begin{bmatrix} 0 \\ 0 \\ 1 \end{bmatrix}$",
        r"$\quad \omega_1 = \begin{bmatrix} 0 \\ 0 \\ 1 \end{bmatrix}$",
    ),
    (
        r"$q_2 = \begin{bmatrix} 0 \\ l_1 \\ l_2 \end{bmatrix}$",
        r"$\quad \omega_2 = \begin{bmatrix} -1 \\ 0 \\ 0 \end{bmatrix}$",
    ),
    (
        r"$q_3 = \begin{bmatrix} 0 \\ l_1 \\ l_2 + l_3 \end{bmatrix}$",
        r"$\quad \omega_3 = \begin{bmatrix} -1 \\ 0 \\ 0 \end{bmatrix}$",
    ),
    (
        r"$q_4 = \begin{bmatrix} 0 \\ l_1 + l_4 \\ l_2 + l_3 \end{bmatrix}$",
        r"$\quad \omega_4 = \begin{bmatrix} -1 \\ 0 \\ 0 \end{bmatrix}$",
    ),
    (
        r"$q_5 = \begin{bmatrix} 0 \\ l_1 + l_4 + l_6 \\ l_2 + l_3 - l_5 \end{bmatrix}$",
        r"$\quad \omega_5 = \begin{bmatrix} 0 \\ 0 \\ 1 \end{bmatrix}$",
    ),
)


def names(arm: Palletiser) -> Notation:
    """The names of lengths and angles."""
    lengths = {f"l_{i}": symbol for i, symbol in enumerate(arm.lengths, 1)}
    angles = {rf"\theta_{i}": symbol for i, symbol in enumerate(arm.thetas, 1)}
    return Notation(lengths | angles)


def forward(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (1) to (13)."""
    screws(d, arm)
    axes(d, arm)
    groups(d, arm)
    coordinates(d, arm)
    exponentials(d, arm)
    products(d, arm)


def screws(d: Derivation, arm: Palletiser) -> None:
    """The sentences before eq. (1)."""
    claim = partial(d.claim, where=FORWARD)
    w, p, theta = unit_axis(), vector("q"), real("theta")
    motion = screw_motion(p, theta)
    velocity = twist_of(motion.diff(theta).subs(theta, 0))
    claim(
        "zero-pitch screw",
        "“the motion of a revolute joint can correspond to a {zero}-pitch screw about an axis in "
        "the unit axis w direction passing through {the point q}”",
        lambda pitch, point: Every(
            {
                "the pitch is zero": Identity(*slides(velocity, pitch)),
                "the axis does not move": Identity(
                    motion * sp.Matrix([*(point + real("s") * w), 1]),
                    sp.Matrix([*(point + real("s") * w), 1]),
                ),
            }
        ),
        phrases=[{"the point q": p, "the origin": sp.zeros(3, 1)}],
    )
    claim(
        "any point",
        "“Therefore the motion can be parameterized with two vectors, w and q, seen in Fig. 5 "
        "where w represents the unit rotation axis and q represents the coordinate of "
        "{any point on the axis} w.”",
        lambda shift: Identity(screw_motion(p + shift, theta), motion),
        phrases=[
            {"any point on the axis": real("s") * w, "any point beside the axis": vector("s")}
        ],
    )
    at_home = dict.fromkeys(arm.thetas, 0)
    back = inverse(arm.chain)
    rates = [twist_of((arm.chain.diff(angle) * back).subs(at_home)) for angle in arm.thetas]
    claim(
        "five revolute joints",
        "“Notice that the newly created open-chain loop has {five} {revolute} joints.”",
        lambda n, pitch: Enumeration(
            n,
            lambda: sum(equal(*slides(rate, pitch)) for rate in rates),
            "joints whose twist turns without a slide",
        ),
        phrases=[{"revolute": 0, "prismatic": None}],
    )


def axes(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (1) to (5): the axes of the Denavit-Hartenberg chain at home."""
    at_home = dict.fromkeys(arm.thetas, 0)
    frames = [sp.prod([sp.eye(4), *arm.links[:i]]).subs(at_home) for i in range(6)]
    points = [frame[:3, 3] for frame in (*frames[:4], frames[5])]
    meanings = {f"q_{i}": point for i, point in enumerate(points, 1)}
    meanings |= {rf"\omega_{i}": frame[:3, 2] for i, frame in enumerate(frames[:5], 1)}

    def on_axis(q: Relation, w: Relation) -> Identity:
        return Identity([*(q.right - q.left).cross(w.left), *w.right], [*sp.zeros(3, 1), *w.left])

    def at_hand(q: Relation, w: Relation) -> Identity:
        return Identity([*q.right, *w.right], [*q.left, *w.left])

    for i, (point, axis) in enumerate(AXES, 1):
        d.claim(
            f"eq. ({i})",
            f"{point} {axis}",
            at_hand if i == 5 else on_axis,  # q5 is also the origin of the hand
            where=FORWARD,
            notation=names(arm),
            means=meanings,
            fixed="" if i == 5 else "another point of the axis describes the joint as well",
        )


def groups(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (6) and (7), and the sentences around them."""
    claim = partial(d.claim, where=FORWARD)
    R, p, point = euler_angles("alpha"), vector("p"), vector("x")
    motion = homogeneous(R, p)
    shift, turn = homogeneous(sp.eye(3), p), homogeneous(R)
    claim(
        "rotation and translation",
        "“The general rigid body motions consist of {rotation and translation}.”",
        lambda parts: Identity(parts, motion),
        phrases=[{"rotation and translation": shift * turn, "rotation": turn}],
    )
    S, r = euler_angles("beta"), vector("r")
    claim(
        "the group SE(3)",
        "“The Euclidean {group} $SE(3)$ is defined as the configuration space of the rigid body "
        "motion”",
        lambda joined, f: Every(
            {
                "two motions make one": rigid(joined),
                "so does the inverse": Identity(inverse(f.left) * f.left, sp.eye(4)),
            }
        ),
        means={"SE(3)": motion, "se(3)": velocity_of_a_curve(p, r)},
        phrases=[
            {
                "group": motion * homogeneous(S, r),
                "vector space": motion + homogeneous(S, r),
            }
        ],
    )
    claim(
        "eq. (6)",
        r"$SE(3) = \{(p, R) : p \in \mathbb{R}^3, R \in SO(3)\} = \mathbb{R}^3 \times SO(3)$",
        means={
            "SE(3)": sp.Matrix([*(R * point + p)]),
            r"\{(p, R) : p \in \mathbb{R}^3, R \in SO(3)\}": (motion * sp.Matrix([*point, 1]))[
                :3, :
            ],
            r"\mathbb{R}^3 \times SO(3)": (shift * turn * sp.Matrix([*point, 1]))[:3, :],
            "SO(3)": R * point,
            r"\mathbb{R}^3": point + p,
        },
        readings=[
            Reading(
                "as a set: each pair $(p, R)$ is one motion, which takes a point $x$ to $Rx + p$; "
                "the sentence speaks of a configuration space"
            ),
            Reading(
                "as groups: the product of $(p, R)$ and $(r, S)$ would be $(p + r, RS)$",
                check=lambda _: Identity(
                    homogeneous(R, p) * homogeneous(S, r), homogeneous(R * S, p + r)
                ),
            ),
        ],
    )
    claim(
        "p and R, after eq. (6)",
        "“where p is the point vector of {the origin} of the body frame from the inertial frame "
        "and R is the orientation matrix of {the body frame relative to the inertial frame} after "
        "the movement.”",
        lambda origin, direction: Every(
            {
                "the motion takes the origin to p": Identity(
                    (motion * sp.Matrix([*origin, 1]))[:3, :], p
                ),
                "the motion turns directions by R": Identity(
                    (motion * sp.Matrix([*point, 0]))[:3, :], direction
                ),
            }
        ),
        phrases=[
            {"the origin": sp.zeros(3, 1), "a point": point},
            {
                "the body frame relative to the inertial frame": R * point,
                "the inertial frame relative to the body frame": R.T * point,
            },
        ],
    )
    v, w = vector("v"), vector("w")
    tangent = velocity_of_a_curve(v, w)
    other = dict(zip([*v, *w], [*vector("u"), *vector("r")], strict=True))
    claim(
        "the group se(3)",
        "“the {group} $se(3)$ is defined as”",
        lambda join, f: closed(join(f.left, f.left.subs(other, simultaneous=True))),
        means={"se(3)": tangent, "SE(3)": motion},
        phrases=[{"group": lambda a, b: a + b, "ring": lambda a, b: a * b}],
        readings=[
            Reading(
                "under addition, as every vector space is a group: a sum of elements is an element"
            ),
            Reading(
                "under the product of matrices, as $SE(3)$",
                check=lambda _, f: closed(f.left * f.left.subs(other, simultaneous=True)),
            ),
        ],
    )
    claim(
        "eq. (7)",
        r"$se(3) = \{(v, \hat{\omega}) : v \in \mathbb{R}^3, \hat{\omega} \in so(3)\}$",
        means={
            "se(3)": tangent,
            "SE(3)": motion,
            r"\{(v, \hat{\omega}) : v \in \mathbb{R}^3, \hat{\omega} \in so(3)\}": (
                sp.Matrix(4, 4, [0, -w[2], w[1], v[0], w[2], 0, -w[0], v[1],
                                 -w[1], w[0], 0, v[2], 0, 0, 0, 0])
            ),
        },
    )  # fmt: skip
    claim(
        "so(3), after eq. (7)",
        "“$so(3)$ is the space of {3×3} {skew-symmetric} matrices”",
        lambda f, size, sign: Every(
            {
                "the matrices have this size": Enumeration(size, lambda: f.left.rows, "rows"),
                "the transpose is the matrix with this sign": Identity(f.left.T, sign * f.left),
            }
        ),
        means={"so(3)": tangent[:3, :3], "se(3)": tangent},
        phrases=[{"3×3": 3, "4×4": 4}, {"skew-symmetric": -1, "symmetric": 1}],
    )


def coordinates(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (8) and (9) for a revolute joint, by the velocity of its motion at the beginning."""
    w, p, theta = unit_axis(), vector("q"), real("theta")
    velocity = screw_motion(p, theta).diff(theta).subs(theta, 0)
    meanings: dict[str, Any] = {
        r"\hat{\xi}": velocity,
        r"\hat{\omega}": turned(theta).diff(theta).subs(theta, 0),
        r"\xi": twist_of(velocity),
        r"\omega": w,
        "v": velocity[:3, 3],
        "q": p,
    }
    claim = partial(d.claim, where=FORWARD, notation=Notation(meanings))
    claim(
        "v, after eq. (7)",
        r"“where $v = -\omega \times q$”",
        readings=[
            Reading(
                "of the twist of a revolute joint, whose zero-pitch screw the paper has just "
                "introduced"
            ),
            Reading("of every element of eq. (7)", means={"v": vector("v")}),
        ],
    )
    claim(
        "eq. (8)",
        r"$\hat{\xi} = \begin{bmatrix} \hat{\omega} & v \\ 0 & 0 \end{bmatrix}$",
    )
    claim(
        "twist coordinates, before eq. (9)",
        r"“Then we define a twist coordinate $\xi : (v, \omega)$ ({6}-dimensional vector) for one "
        "link.”",
        lambda f, n: Enumeration(
            n,
            lambda: sp.Matrix([*f.left]).jacobian([*vector("v"), *vector("w")]).rank(),
            "independent coordinates of a velocity",
        ),
        means={
            r"\xi : (v, \omega)": velocity_of_a_curve(vector("v"), vector("w")),
            r"\hat{\omega}": velocity_of_a_curve(sp.zeros(3, 1), vector("w")),
        },
        phrases=[{"6": 6, "3": 3}],
    )
    claim(
        "eq. (9)",
        r"$\xi = \begin{bmatrix} v \\ \omega \end{bmatrix} = \begin{bmatrix} -\omega \times q \\ "
        r"\omega \end{bmatrix}$",
    )


def exponentials(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (10) and (11)."""
    w, v, theta = unit_axis(), vector("v"), real("theta")
    # The axis of a general twist goes through w x v, and its pitch is w.v.
    motion = screw_motion(w.cross(v), theta, w.dot(v))
    slide = homogeneous(sp.eye(3), theta * v)
    claim = partial(d.claim, where=FORWARD)

    def exponential_of(f: Relation, twist: sp.Matrix) -> Every:
        """The left side solves the equation that defines the exponential, and equals the right."""
        return Every(
            {
                "both have the same derivative": Identity(
                    f.left.diff(theta), twist_matrix(twist) * f.left
                ),
                "both begin at the identity": Identity(f.left.subs(theta, 0), sp.eye(4)),
                "the two sides are equal": Equal(f),
            }
        )

    claim(
        "eq. (10)",
        r"$e^{\hat{\xi}\theta} = \begin{bmatrix} e^{\hat{\omega}\theta} & (I - "
        r"e^{\hat{\omega}\theta})(\omega \times v) + \omega \omega^T v \theta \\ 0 & 1 "
        r"\end{bmatrix}$",
        means={
            r"e^{\hat{\xi}\theta}": motion,
            r"e^{\hat{\omega}\theta}": turned(theta),
            "I": sp.eye(3),
            r"\omega": w,
            "v": v,
            r"\theta": theta,
        },
        readings=[
            Reading(
                r"for a unit axis $\omega$, as the paper introduces it, and every $v$",
                check=lambda f: exponential_of(f, sp.Matrix([*v, *w])),
            ),
            Reading(
                r"for every twist of eq. (7), such as that of a slide, $\omega = 0$",
                means={
                    r"e^{\hat{\xi}\theta}": slide,
                    r"e^{\hat{\omega}\theta}": sp.eye(3),
                    r"\omega": sp.zeros(3, 1),
                },
                check=lambda f: exponential_of(f, sp.Matrix([*v, 0, 0, 0])),
            ),
        ],
    )
    p = vector("q")
    start = homogeneous(euler_angles("alpha"), vector("p"))
    claim(
        "eq. (11)",
        r"$g(\theta) = e^{\hat{\xi}\theta} g(0)$",
        means={
            r"g(\theta)": screw_motion(p, theta) * start,
            r"e^{\hat{\xi}\theta}": exponential(sp.Matrix([*(-w.cross(p)), *w]), theta),
            "g(0)": start,
        },
    )


def products(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (12) and (13), by Denavit-Hartenberg."""
    claim = partial(d.claim, where=FORWARD, notation=names(arm))
    at_home = dict.fromkeys(arm.thetas, 0)
    home = arm.chain.subs(at_home)
    moves = {rf"e^{{\hat{{\xi}}_{i} \theta_{i}}}": move for i, move in enumerate(arm.moves, 1)}
    factors = [*arm.moves, home]
    claim(
        "eq. (12)",
        r"“So the forward kinematics map $g_{st}$ is the {product} of the exponentials of the "
        r"twist for each link as [2, 9],” “$g_{st}(\theta) = e^{\hat{\xi}_1 \theta_1} "
        r"e^{\hat{\xi}_2 \theta_2} e^{\hat{\xi}_3 \theta_3} e^{\hat{\xi}_4 \theta_4} "
        r"e^{\hat{\xi}_5 \theta_5} g_{st}(0)$”",
        lambda g, joined, f: Every(
            {"the map is this product": Identity(g.left, joined), "the formula holds": Equal(f)}
        ),
        means={
            "g_{st}": arm.chain,
            r"g_{st}(\theta)": arm.chain,
            "g_{st}(0)": home,
            **moves,
        },
        phrases=[{"product": sp.prod(factors), "sum": sum(factors, sp.zeros(4))}],
    )
    frames = [sp.prod([sp.eye(4), *arm.links[:i]]).subs(at_home) for i in range(5)]
    about = [
        frame * homogeneous(rotation("z", angle)) * inverse(frame)
        for frame, angle in zip(frames, arm.thetas, strict=True)
    ]
    claim(
        "use of eq. (10)",
        r"“$e^{\hat{\xi}_i \theta_i}$ can be computed according to {the Equation (10)}”",
        lambda f, found: Every(
            {
                f"{'it gives the motion ' * (i == 1)}of joint {i}": Identity(
                    f.left.at(i), found.at(i)
                )
                for i in f.left.indices
            }
        ),
        means={
            r"e^{\hat{\xi}_i \theta_i}": each(about),
            r"\hat{\xi}_i": each(twist_matrix(xi) for xi in arm.twists),
        },
        phrases=[{"the Equation (10)": each(arm.moves), "the Equation (11)": each([home] * 5)}],
    )
    offset = sp.Matrix([*arm.chain[:3, 3]]).subs(at_home)
    claim(
        "initial configuration",
        "“$g_{st}(0)$ is the {initial} configuration of the manipulator”",
        lambda f, angles: Identity(f.left, arm.pose.subs(angles)),
        means={
            "g_{st}(0)": homogeneous(sp.eye(3), offset),
            r"e^{\hat{\xi}_1 \theta_1}": arm.moves[0],
        },
        phrases=[{"initial": at_home, "present": {}}],
    )
    claim(
        "eq. (13)",
        r"“Substitute the Equations (1)-(5), (9) and the virtual constraint $\theta_4 = -(\theta_2 "
        r"+ \theta_3)$ into the Equation (10). Then according to the Equation (12), we can get the "
        r"final expression of the forward kinematics map $g_{st}(\theta)$, as following: "
        r"$\begin{bmatrix} c(\theta_1 + \theta_5) & "
        r"-s(\theta_1 + \theta_5) & 0 & -(l_1 + l_3 s \theta_2 + l_4 c(\theta_2 + \theta_3) + l_6) "
        r"s \theta_1 \\ s(\theta_1 + \theta_5) & c(\theta_1 + \theta_5) & 0 & (l_1 + l_3 s "
        r"\theta_2 + l_4 c(\theta_2 + \theta_3) + l_6) c \theta_1 \\ 0 & 0 & 1 & l_2 + l_3 c "
        r"\theta_2 - l_4 s(\theta_2 + \theta_3) - l_5 \\ 0 & 0 & 0 & 1 \end{bmatrix}$”",
        lambda condition, g, f: Identity(f.left, g.left.subs(condition.left, condition.right)),
        means={
            r"g_{st}(\theta)": arm.chain,
            "g_{st}(0)": home,
            "c": cos,
            "s": sin,
        },
    )
    target, yaw = sp.Matrix([real(name) for name in ("px", "py", "pz")]), real("psi")
    equations = [*(arm.pose[:3, 3] - target), *(arm.pose[:2, 0] - sp.Matrix([cos(yaw), sin(yaw)]))]
    claim(
        "inverse kinematics",
        "“Similarly, the inverse kinematics problem {can} be solved. We will not discuss it in "
        "this paper.”",
        lambda solvable: stated(solvable, Not(Count(equations, arm.actuated, None))),
        phrases=[{"can": True, "can not": False}],
        readings=[
            Reading("each pose has a finite number of solutions; the paper says that it gives none")
        ],
    )


def slides(twist: sp.Matrix, pitch: int | None) -> tuple[sp.Expr, sp.Expr]:
    """Two sides that are equal if a twist has a pitch; ``None`` means a slide without a turn."""
    v, w = twist[:3, :], twist[3:, :]
    return (w.dot(w), sp.S.Zero) if pitch is None else (w.dot(v), pitch * w.dot(w))


def velocity_of_a_curve(v: sp.Matrix, w: sp.Matrix) -> sp.Matrix:
    """The velocity at the identity of a curve of motions: it begins with any v and any w."""
    t = real("t")
    turn = sp.prod(rotation(axis, t * rate) for axis, rate in zip("xyz", w, strict=True))
    return homogeneous(turn, t * v).diff(t).subs(t, 0)


def rigid(result: sp.Matrix) -> Identity:
    """A matrix is a rigid motion: its 3x3 block is a rotation, and its last row is that of one."""
    R = result[:3, :3]
    return Identity(
        [*(R.T * R), *(R[:, 0].cross(R[:, 1]) - R[:, 2]), *result[3, :]],
        [*sp.eye(3), 0, 0, 0, 0, 0, 0, 1],
    )


def closed(result: sp.Matrix) -> Identity:
    """A result has the form of an element of se(3)."""
    return Identity(result, twist_matrix(twist_of(result)))
