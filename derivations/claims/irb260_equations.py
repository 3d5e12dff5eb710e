"""The numbered equations of Shi, Zhu and Li, and the claims that go with them."""

from functools import partial
from typing import NamedTuple

import sympy as sp
from sympy import cos, pi, sin

from closedform import (
    Deferred,
    Derivation,
    Enumeration,
    Every,
    Identity,
    Lemma,
    Refuted,
    adjoint,
    exponential,
    hat,
    homogeneous,
    inverse,
    real,
    revolute_twist,
    rotation,
    twist_matrix,
    twist_of,
)

FORWARD = "IV. Kinematics, A. Forward Kinematics"
JACOBIAN = "IV. Kinematics, B. Spatial Jacobian"
FIVE_TERMS = " + ".join(
    rf"\left(\frac{{\partial g_{{st}}}}{{\partial \theta_{i}}} g_{{st}}^{{-1}}(\theta) \right) "
    rf"\dot{{\theta}}_{i}"
    for i in range(1, 6)
)
"""The sum that is printed in full in eqs. (15) and (17)."""


class Palletiser(NamedTuple):
    """The results of the derivation; ``free`` is the pose with five independent joints."""

    lengths: tuple[sp.Symbol, ...]
    thetas: tuple[sp.Symbol, ...]
    moves: list[sp.Matrix]
    free: sp.Matrix
    links: list[sp.Matrix]
    pose: sp.Matrix
    twists: list[sp.Matrix]
    moved: list[sp.Matrix]
    J_space: sp.Matrix
    rates: sp.Matrix
    velocity: sp.Matrix
    lower: Lemma
    upper: Lemma

    @property
    def actuated(self) -> tuple[sp.Symbol, ...]:
        return self.thetas[:3] + self.thetas[4:]

    @property
    def V(self) -> sp.Matrix:
        """The spatial velocity as a 4x4 matrix."""
        return twist_matrix(self.J_space * self.rates)

    def couple(self, e: sp.Matrix) -> sp.Matrix:
        _, theta2, theta3, theta4, _ = self.thetas
        return e.xreplace({theta4: -(theta2 + theta3)})

    def rate(self, e: sp.Matrix) -> sp.Matrix:
        """The time derivative of a matrix that depends on the actuated joints."""
        pairs = zip(self.actuated, self.rates, strict=True)
        return sum((e.diff(angle) * rate for angle, rate in pairs), sp.zeros(*e.shape))


def equations(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (1) to (23)."""
    screws(d, arm)
    exponentials(d, arm)
    velocities(d, arm)
    adjoints(d, arm)


def screws(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (1) to (9)."""
    l1, l2, l3, l4, l5, l6 = arm.lengths
    claim = partial(d.claim, where=FORWARD)
    w, p, theta = unit_axis(), sp.Matrix([real(f"q_{i}") for i in "xyz"]), real("theta")
    twist = revolute_twist(w, p)
    claim(
        "zero-pitch screw",
        "“the motion of a revolute joint can correspond to a zero-pitch screw about an axis in the "
        "unit axis w direction passing through the point q”",
        Every(
            {
                "points of the axis do not move": Identity(
                    exponential(twist, theta) * sp.Matrix([*p, 1]), sp.Matrix([*p, 1])
                ),
                "no pitch": Identity(w.dot(twist[:3, :]), 0),
            }
        ),
    )
    s = real("s")
    claim(
        "any point",
        "“q represents the coordinate of any point on the axis w”",
        Identity(revolute_twist(w, p + s * w), twist),
    )
    up, across = ([0, 0, 1], "0 \\\\ 0 \\\\ 1"), ([-1, 0, 0], "-1 \\\\ 0 \\\\ 0")
    printed = (
        ([0, 0, 1], "0 \\\\ 0 \\\\ 1", up),
        ([0, l1, l2], "0 \\\\ l_1 \\\\ l_2", across),
        ([0, l1, l2 + l3], "0 \\\\ l_1 \\\\ l_2 + l_3", across),
        ([0, l1 + l4, l2 + l3], "0 \\\\ l_1 + l_4 \\\\ l_2 + l_3", across),
        ([0, l1 + l4 + l6, l2 + l3 - l5], "0 \\\\ l_1 + l_4 + l_6 \\\\ l_2 + l_3 - l_5", up),
    )
    at_home = dict.fromkeys(arm.thetas, 0)
    for i, (point, text, (axis, axis_text)) in enumerate(printed, 1):
        link = sp.prod([sp.eye(4), *arm.links[: i - 1]]).subs(at_home)
        claim(
            f"eq. ({i})",
            rf"$q_{i} = \begin{{bmatrix}} {text} \end{{bmatrix}},\ "
            rf"\omega_{i} = \begin{{bmatrix}} {axis_text} \end{{bmatrix}}$",
            Identity(  # the joint axis of the Denavit-Hartenberg chain at home
                revolute_twist(sp.Matrix(axis), sp.Matrix(point)),
                revolute_twist(link[:3, 2], link[:3, 3]),
            ),
        )
    R1, p1 = euler_angles("first"), symbols("p", 1)
    R2, p2 = euler_angles("second"), symbols("r", 1)
    claim(
        "eq. (6)",
        r"$SE(3) = \{(p, R) : p \in \mathbb{R}^3, R \in SO(3)\} = \mathbb{R}^3 \times SO(3)$",
        Every(
            {
                "as a set; the product of two motions is (p + R r, R S)": Identity(
                    homogeneous(R1, p1) * homogeneous(R2, p2), homogeneous(R1 * R2, R1 * p2 + p1)
                ),
                "and R S is a rotation": Identity((R1 * R2).T * R1 * R2, sp.eye(3)),
            }
        ),
    )
    v, u = symbols("v", 1), symbols("u", 1)
    a, b = symbols("a", 1), symbols("b", 1)
    A, B = twist_matrix(sp.Matrix([*v, *a])), twist_matrix(sp.Matrix([*u, *b]))
    bracket = A * B - B * A
    claim(
        "the group se(3)",
        "“the group $se(3)$ is defined as”",
        Refuted(
            Identity((twist_matrix(sp.Matrix([0, 0, 0, 0, 0, 1])) ** 2)[0, 0], -1),
            "the square of the twist about z has the entry (1,1) = -1; a skew matrix has 0 there",
            "the Lie algebra $se(3)$: closed under sums and commutators, not under products",
            Identity(bracket, twist_matrix(twist_of(bracket))),
        ),
    )
    turn = exponential(sp.Matrix([*v, *w]), theta)
    claim(
        "eq. (7)",
        r"$se(3) = \{(v, \hat{\omega}) : v \in \mathbb{R}^3, \hat{\omega} \in so(3)\}$",
        Identity(turn.diff(theta).subs(theta, 0), twist_matrix(sp.Matrix([*v, *w]))),
    )
    pitch = real("h")
    claim(
        "v, after eq. (7)",
        r"“where $v = -\omega \times q$”",
        Refuted(
            Every(
                {
                    "this v has no component along the axis": Identity(w.dot(-w.cross(p)), 0),
                    "the v of a screw has one": Identity(w.dot(-w.cross(p) + pitch * w), pitch),
                }
            ),
            "eq. (7) allows every v, but this v has no pitch: it is that of a revolute joint",
            r"v = -\omega \times q + h\omega, \text{ with } h = 0 \text{ for a revolute joint}",
            Identity(twist[:3, :], -w.cross(p)),
        ),
    )
    block = sp.Matrix.vstack(sp.Matrix.hstack(hat(w), v), sp.zeros(1, 4))
    claim(
        "eq. (8)",
        r"$\hat{\xi} = \begin{bmatrix} \hat{\omega} & v \\ 0 & 0 \end{bmatrix}$",
        Identity(block, turn.diff(theta).subs(theta, 0)),
    )
    claim(
        "eq. (9)",
        r"$\xi = \begin{bmatrix} v \\ \omega \end{bmatrix} = \begin{bmatrix} -\omega \times q \\ "
        r"\omega \end{bmatrix}$",
        Identity(
            sp.Matrix([*(-w.cross(p)), *w]),
            twist_of((homogeneous(sp.eye(3), p) * exponential(sp.Matrix([0, 0, 0, *w]), theta)
                      * homogeneous(sp.eye(3), -p)).diff(theta).subs(theta, 0))
        )
    )  # fmt: skip


def exponentials(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (10) to (13)."""
    l1, l2, l3, l4, l5, l6 = arm.lengths
    theta1, theta2, theta3, _, theta5 = arm.thetas
    claim = partial(d.claim, where=FORWARD)
    w, v, theta = unit_axis(), symbols("v", 1), real("theta")
    twist = twist_matrix(sp.Matrix([*v, *w]))
    E = exponential(sp.Matrix([0, 0, 0, *w]), theta)[:3, :3]
    e = homogeneous(E, (sp.eye(3) - E) * w.cross(v) + w * w.T * v * theta)
    claim(
        "eq. (10)",
        r"$e^{\hat{\xi}\theta} = \begin{bmatrix} e^{\hat{\omega}\theta} & (I - "
        r"e^{\hat{\omega}\theta})(\omega \times v) + \omega \omega^T v \theta \\ 0 & 1 "
        r"\end{bmatrix}$",
        Every(
            {
                "for a unit axis, its derivative": Identity(e.diff(theta), twist * e),
                "its initial value": Identity(e.subs(theta, 0), sp.eye(4)),
            }
        ),
    )
    g = e * homogeneous(symbols("R"), symbols("p", 1))
    claim(
        "eq. (11)",
        r"$g(\theta) = e^{\hat{\xi}\theta} g(0)$",
        Every(
            {
                "its velocity is the twist": Identity(g.diff(theta), twist * g),
                "its initial value": Identity(
                    g.subs(theta, 0), homogeneous(symbols("R"), symbols("p", 1))
                ),
            }
        ),
    )
    claim(
        "eq. (12)",
        r"$g_{st}(\theta) = e^{\hat{\xi}_1 \theta_1} e^{\hat{\xi}_2 \theta_2} "
        r"e^{\hat{\xi}_3 \theta_3} e^{\hat{\xi}_4 \theta_4} e^{\hat{\xi}_5 \theta_5} g_{st}(0)$",
        Identity(arm.free, sp.prod(arm.links)),
    )
    rho = l1 + l3 * sin(theta2) + l4 * cos(theta2 + theta3) + l6
    c15, s15 = cos(theta1 + theta5), sin(theta1 + theta5)
    eq13 = sp.Matrix(
        [
            [c15, -s15, 0, -rho * sin(theta1)],
            [s15, c15, 0, rho * cos(theta1)],
            [0, 0, 1, l2 + l3 * cos(theta2) - l4 * sin(theta2 + theta3) - l5],
            [0, 0, 0, 1],
        ]
    )
    claim(
        "eq. (13)",
        r"$\begin{bmatrix} c(\theta_1 + \theta_5) & -s(\theta_1 + \theta_5) & 0 & -(l_1 + l_3 s "
        r"\theta_2 + l_4 c(\theta_2 + \theta_3) + l_6) s \theta_1 \\ s(\theta_1 + \theta_5) & "
        r"c(\theta_1 + \theta_5) & 0 & (l_1 + l_3 s \theta_2 + l_4 c(\theta_2 + \theta_3) + l_6) c "
        r"\theta_1 \\ 0 & 0 & 1 & l_2 + l_3 c \theta_2 - l_4 s(\theta_2 + \theta_3) - l_5 \\ "
        r"0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(eq13, arm.couple(sp.prod(arm.links))),
    )
    claim(
        "inverse kinematics",
        "“Similarly, the inverse kinematics problem can be solved. We will not discuss it in this "
        "paper.”",
        Enumeration(
            4, lambda: len(d["ik"].branches or ()), "closed forms, proved sound and complete"
        ),
    )


def velocities(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (14) to (18)."""
    claim = partial(d.claim, where=JACOBIAN)
    g, back = arm.pose, inverse(arm.pose)
    claim(
        "actuated joints",
        "“Although there are five joints in this model, only four of them, the joints 1, 2, 3, and "
        "5, are actuated.”",
        Enumeration([1, 2, 3, 5], lambda: [int(q.name[-1]) for q in d.actuated], "the joints"),
    )
    velocity = arm.rate(g)
    claim(
        "eq. (14)",
        r"$\dot{V}_{st}^s = g_{st}(\theta) \dot{g}_{st}^{-1}(\theta)$",
        Refuted(
            Every(
                {
                    "with the derivative of the inverse": Identity(g * arm.rate(back), -arm.V),
                    "the derivative has no inverse": Identity(velocity[3, :], sp.zeros(1, 4)),
                }
            ),
            "the factors are in the wrong order: with the derivative of the inverse the product is "
            "minus the velocity, and the derivative itself has no inverse; in eqs. (15) and (23) "
            "the V has a hat and no dot",
            r"\hat{V}_{st}^s = \dot{g}_{st}(\theta) g_{st}^{-1}(\theta)",
            Identity(velocity * back, arm.V),
        ),
    )
    claim(
        "eq. (15)",
        r"$\hat{V}_{st}^s = \sum_{i=1}^5 \left(\frac{\partial g_{st}}{\partial \theta_i} "
        r"\dot{\theta}_i \right) g_{st}^{-1}(\theta) = \sum_{i=1}^5 \left(\frac{\partial g_{st}}"
        r"{\partial \theta_i} g_{st}^{-1}(\theta) \right) \dot{\theta}_i = "
        f"{FIVE_TERMS}$",
        Deferred(partial(chain_rule, arm)),
    )
    claim(
        "eq. (16)",
        r"$\left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1} \right)^v = \xi_i'$",
        Deferred(partial(partial_twists, arm)),
    )
    xi = [arm.couple(m) for m in arm.moved]
    r1, r2, r3, r5 = arm.rates
    hats = [twist_matrix(x) for x in xi]
    claim(
        "eq. (17), up to the last line",
        rf"${FIVE_TERMS} = "
        r"\hat{\xi}_1' \dot{\theta}_1 + \hat{\xi}_2' \dot{\theta}_2 + \hat{\xi}_3' "
        r"\dot{\theta}_3 + \hat{\xi}_4' (-\dot{\theta}_2 - \dot{\theta}_3) + \hat{\xi}_5' "
        r"\dot{\theta}_5 = \hat{\xi}_1' \dot{\theta}_1 + (\hat{\xi}_2' - \hat{\xi}_4') "
        r"\dot{\theta}_2 + (\hat{\xi}_3' - \hat{\xi}_4') \dot{\theta}_3 + \hat{\xi}_5' "
        r"\dot{\theta}_5$",
        Every(
            {
                "first form": Identity(
                    hats[0] * r1 + hats[1] * r2 + hats[2] * r3 - hats[3] * (r2 + r3) + hats[4] * r5,
                    velocity * back,
                ),
                "second form": Identity(
                    hats[0] * r1
                    + (hats[1] - hats[3]) * r2
                    + (hats[2] - hats[3]) * r3
                    + hats[4] * r5,
                    velocity * back,
                ),
            }
        ),
    )
    row = sp.Matrix.hstack(hats[0], hats[1] - hats[3], hats[2] - hats[3], hats[4])
    columns = sp.Matrix.hstack(xi[0], xi[1] - xi[3], xi[2] - xi[3], xi[4])
    claim(
        "eq. (17), last line",
        r"$= \begin{bmatrix} \hat{\xi}_1' & \hat{\xi}_2' - \hat{\xi}_4' & \hat{\xi}_3' - "
        r"\hat{\xi}_4' & \hat{\xi}_5' \end{bmatrix} \dot{\theta}$",
        Refuted(
            Enumeration((4, 16), lambda: row.shape, "the shape of the row of 4x4 matrices"),
            "a 4x16 matrix cannot multiply the 4 joint rates; without the hats it can",
            r"V_{st}^s = \begin{bmatrix} \xi_1' & \xi_2' - \xi_4' & \xi_3' - \xi_4' & \xi_5' "
            r"\end{bmatrix} \dot{\theta}",
            Identity(columns * arm.rates, twist_of(velocity * back)),
        ),
    )
    by_differentiation = sp.Matrix.hstack(*(twist_of(g.diff(q) * back) for q in arm.actuated))
    claim(
        "eq. (18)",
        r"$J_{st}^s(\theta) = \begin{bmatrix} \xi_1' & \xi_2' - \xi_4' & \xi_3' - \xi_4' & \xi_5' "
        r"\end{bmatrix}$",
        Identity(columns, by_differentiation),
    )


def adjoints(d: Derivation, arm: Palletiser) -> None:
    """Eqs. (19) to (23)."""
    claim = partial(d.claim, where=JACOBIAN)
    theta1, l1, l2 = arm.thetas[0], *arm.lengths[:2]
    first, second = arm.moves[0], arm.moved[1]
    twice = adjoint(first) * second
    there = {theta1: pi / 2}
    witness = Identity(
        sp.Matrix.hstack(twice.subs(there), second.subs(there)),
        sp.Matrix([[0, l2], [l2, 0], [l1, l1], [1, 0], [0, -1], [0, 0]]),
    )
    claim(
        "eq. (19)",
        r"$\left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1} \right) \dot{\theta}_i = "
        r"\left(e^{\hat{\xi}_1' \theta_1} \dots e^{\hat{\xi}_{i-1}' \theta_{i-1}} \hat{\xi}_i' "
        r"e^{\hat{\xi}_i' \theta_i} \dots e^{\hat{\xi}_n' \theta_n} g_{st}(0) g_{st}^{-1} \right) "
        r"\dot{\theta}_i = \left(e^{\hat{\xi}_1' \theta_1} \dots e^{\hat{\xi}_{i-1}' \theta_{i-1}} "
        r"\hat{\xi}_i' e^{-\hat{\xi}_{i-1}' \theta_{i-1}} \dots e^{-\hat{\xi}_1' \theta_1} \right) "
        r"\dot{\theta}_i$",
        Refuted(
            witness,
            "the primed twists are already moved, and here they are moved again: for i = 2 at "
            "theta1 = pi/2 the axis is along x instead of -y.  The primes must be dropped",
            r"\left(e^{\hat{\xi}_1 \theta_1} \dots e^{\hat{\xi}_{i-1} \theta_{i-1}} \hat{\xi}_i "
            r"e^{-\hat{\xi}_{i-1} \theta_{i-1}} \dots e^{-\hat{\xi}_1 \theta_1} \right) "
            r"\dot{\theta}_i",
            Deferred(partial(conjugations, arm)),
        ),
    )
    claim(
        "eq. (20)",
        r"$\xi_i' = \left(\frac{\partial g_{st}}{\partial \theta_i} g_{st}^{-1} \right)^v = "
        r"Ad_{(e^{\hat{\xi}_1' \theta_1} \dots e^{\hat{\xi}_{i-1}' \theta_{i-1}})} \hat{\xi}_i'$",
        Refuted(
            witness,
            "as in eq. (19), the primed twists are moved twice; also, Ad multiplies the six "
            "coordinates of a twist, not the 4x4 matrix with the hat",
            r"\xi_i' = Ad_{(e^{\hat{\xi}_1 \theta_1} \dots "
            r"e^{\hat{\xi}_{i-1} \theta_{i-1}})} \xi_i",
            Deferred(partial(adjoint_twists, arm)),
        ),
    )
    xi = sp.Matrix([*symbols("v", 1), *symbols("w", 1)])
    p = symbols("p", 1)
    R = euler_angles("turn")
    blocks = sp.Matrix.vstack(sp.Matrix.hstack(R, hat(p) * R), sp.Matrix.hstack(sp.zeros(3, 3), R))
    g = homogeneous(R, p)
    claim(
        "eq. (21)",
        r"$Ad_g = \begin{bmatrix} R & \hat{p}R \\ 0 & R \end{bmatrix}$",
        Identity(blocks * xi, twist_of(g * twist_matrix(xi) * inverse(g))),
    )
    point = symbols("x", 1)
    claim(
        "eq. (22)",
        r"$g = \begin{bmatrix} R & p \\ 0 & 1 \end{bmatrix}$",
        Identity(
            sp.Matrix.vstack(sp.Matrix.hstack(R, p), sp.Matrix([[0, 0, 0, 1]]))
            * sp.Matrix([*point, 1]),
            sp.Matrix([*(R * point + p), 1]),
        ),
    )
    position = arm.pose[:, 3]
    claim(
        "eq. (23)",
        r"$v_{q_5}^s = \hat{V}_{st}^s q_5^s$",
        Identity(arm.V * position, arm.rate(position)),
    )
    at_home = position.subs(dict.fromkeys(arm.actuated, 0))
    rho, turned = at_home[1], dict.fromkeys(arm.actuated, 0) | {theta1: pi / 2}
    claim(
        "eq. (23), with the point of eq. (5)",
        "“The velocity of the origin of the end-effector $q_5$ relative to the spatial (inertial) "
        "frame is then given by”",
        Refuted(
            Identity(
                sp.Matrix.hstack((arm.V * at_home).subs(turned), arm.rate(position).subs(turned))
                .diff(arm.rates[0]),
                sp.Matrix([[-rho, 0], [0, -rho], [0, 0], [0, 0]])
            ),
            "q5 of eq. (5) is the position of the hand at home; at theta1 = pi/2 with a turning "
            "turret this constant point would move along x, but the hand moves along -y",
            r"$q_5^s$ is the present position of the point, $g_{st}(\theta)(0, 0, 0, 1)^T$, in "
            r"homogeneous coordinates",
            Identity(arm.V * position, arm.rate(position))
        )
    )  # fmt: skip


def chain_rule(arm: Palletiser) -> Every:
    """Eq. (15) with five independent joints."""
    time, rates = real("t"), [real(f"rate_{i}") for i in range(1, 6)]
    g = sp.prod(arm.links)
    back = inverse(g)
    path = {q: q + rate * time for q, rate in zip(arm.thetas, rates, strict=True)}
    total = g.xreplace(path).diff(time).subs(time, 0)
    terms = [(g.diff(q), rate) for q, rate in zip(arm.thetas, rates, strict=True)]
    first = sum((slope * rate for slope, rate in terms), sp.zeros(4)) * back
    return Every(
        {
            "first form": Identity(first, total * back),
            "second form": Identity(
                sum((slope * back * rate for slope, rate in terms), sp.zeros(4)), first
            ),
        }
    )


def partial_twists(arm: Palletiser) -> Identity:
    """Each derivative in eq. (16) is the matrix of the primed twist."""
    g = sp.prod(arm.links)
    found = sp.Matrix.hstack(*(arm.couple(g.diff(q) * inverse(g)) for q in arm.thetas))
    return Identity(found, sp.Matrix.hstack(*(twist_matrix(x) for x in arm.moved)))


def conjugations(arm: Palletiser) -> Identity:
    """Eq. (19) without primes, for all joints."""
    g = sp.prod(arm.links)
    left, right = [], []
    for i, (q, twist) in enumerate(zip(arm.thetas, arm.twists, strict=True)):
        before = sp.prod([sp.eye(4), *arm.moves[:i]])
        left.append(g.diff(q))
        right.append(before * twist_matrix(twist) * inverse(before) * g)
    return Identity(sp.Matrix.hstack(*left), sp.Matrix.hstack(*right))


def adjoint_twists(arm: Palletiser) -> Identity:
    """Eq. (20) without primes and hats, for all joints."""
    before = [sp.prod([sp.eye(4), *arm.moves[:i]]) for i in range(5)]
    pairs = zip(before, arm.twists, strict=True)
    return Identity(
        sp.Matrix.hstack(*(arm.couple(adjoint(T) * twist) for T, twist in pairs)),
        sp.Matrix.hstack(*arm.moved),
    )


def unit_axis() -> sp.Matrix:
    """An arbitrary unit vector, given by its polar angles."""
    lam, mu = real("lambda"), real("mu")
    return sp.Matrix([sin(lam) * cos(mu), sin(lam) * sin(mu), cos(lam)])


def euler_angles(name: str) -> sp.Matrix:
    """An arbitrary rotation."""
    return sp.prod(rotation(axis, real(f"{name}_{i}")) for i, axis in enumerate("zyz"))


def symbols(name: str, columns: int = 3) -> sp.Matrix:
    """A 3x3 matrix or a vector of real symbols."""
    if columns == 1:
        return sp.Matrix([real(f"{name}_{i}") for i in "xyz"])
    return sp.Matrix(3, 3, lambda i, j: real(f"{name}_{i + 1}{j + 1}"))
