"""Claims of Reddy and Babu about the planar arm and the Denavit-Hartenberg convention."""

from functools import partial
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, pi, sin, sqrt, tan

from closedform import (
    Count,
    Derivation,
    Equal,
    Every,
    Gravity,
    Identity,
    Notation,
    Solves,
    Undecidable,
    denavit_hartenberg,
    exponential,
    hat,
    homogeneous,
    prismatic_twist,
    real,
    revolute_twist,
    rotation,
)

DENAVIT_HARTENBERG = "Kinematic Analysis By Denavit – Hartenberg Convention"


class Arm(NamedTuple):
    """The results of the derivation; the paper's ``a_1``, ``a_2`` are its ``l_1``, ``l_2``."""

    l1: sp.Symbol
    l2: sp.Symbol
    theta1: sp.Symbol
    theta2: sp.Symbol
    position: sp.Matrix
    A1: sp.Matrix
    A2: sp.Matrix
    pose: sp.Matrix

    def eq3(self, x: sp.Expr, y: sp.Expr, sign: int) -> sp.Expr:
        """theta2 as printed, with the upper or the lower sign."""
        D = (x**2 + y**2 - self.l1**2 - self.l2**2) / (2 * self.l1 * self.l2)
        return atan2(sign * sqrt(1 - D**2), D)

    def eq4(self, x: sp.Expr, y: sp.Expr, theta2: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
        """Numerator and denominator of tan(theta1) as printed."""
        along, across = self.l2 * cos(theta2) + self.l1, self.l2 * sin(theta2)
        return y * along - x * across, x * along + y * across


def state(d: Derivation, arm: Arm) -> None:
    """Transcribe all claims, in the order of the paper."""
    geometry(d, arm)


def notation(arm: Arm) -> Notation:
    """What the paper's names mean; its ``a_1`` and ``a_2`` are other names of the lengths."""
    theta1, theta2 = arm.theta1, arm.theta2
    return Notation(
        {
            r"\theta_1": theta1,
            r"\theta_2": theta2,
            "l_1": arm.l1,
            "l_2": arm.l2,
            "a_1": arm.l1,
            "a_2": arm.l2,
            "c_1": cos(theta1),
            "s_1": sin(theta1),
            "c_2": cos(theta2),
            "s_2": sin(theta2),
            "c_{12}": cos(theta1 + theta2),
            "s_{12}": sin(theta1 + theta2),
            r"a \tan 2": atan2,
            r"\phi": atan2(arm.pose[1, 0], arm.pose[0, 0]),
        }
    )


def geometry(d: Derivation, arm: Arm) -> None:
    """Eqs. (1) to (5)."""
    l1, l2, theta1, theta2, position, _, A2, pose = arm
    x, y = position
    px, py = real("x"), real("y")
    seen = A2[:2, 3] + sp.Matrix([l1, 0])  # the hand from the base, along the first link
    at_posture = {"x": pose[0, 3], "y": pose[1, 3]}
    where = "Kinematic Analysis By Geometric Approach"
    claim = partial(d.claim, where=where, notation=notation(arm).extended(at_posture))

    claim("eq. (1)", r"$x = l_1 \cos\theta_1 + l_2 \cos(\theta_1 + \theta_2)$")
    claim("eq. (2)", r"$y = l_1 \sin\theta_1 + l_2 \sin(\theta_1 + \theta_2)$")
    bend = real("b")
    above = (x * l1 * sin(theta1) - y * l1 * cos(theta1)).subs(theta2, -bend)
    claim(
        "two solutions",
        "“If the given (x, y) coordinates are within the robot’s reach there may be {two} "
        "solutions as shown in Fig. 2, the so-called {elbow up} and elbow down configurations”",
        lambda n, elbow: Every(
            {
                "their number": Count((x - px, y - py), (theta1, theta2), n),
                "the elbow is above the line to the hand if theta2 < 0": Identity(
                    above, elbow * l1 * l2 * sin(bend)
                ),
            }
        ),
        phrases=[{"elbow up": 1, "elbow down": -1}],
    )
    at_distance = {l1: sp.Integer(10), l2: sp.Integer(8)}
    claim(
        "one solution",
        "“or there may be {exactly one} solution if the manipulator must be {fully extended} to "
        "reach the point”",
        lambda n, r: Count([e.subs(at_distance) for e in (x - r, y)], (theta1, theta2), n),
        phrases=[{"exactly one": 1, "two": 2}, {"fully extended": 18, "half extended": 9}],
    )
    claim(
        "infinitely many solutions",
        "“There may even be an {infinite} number of solutions in some cases.”",
        lambda n: Count([e.subs({l1: 1, l2: 1}) for e in (x, y)], (theta1, theta2), n),
    )
    D = (px**2 + py**2 - l1**2 - l2**2) / (2 * l1 * l2)
    claim(
        "cos θ2, before eq. (3)",
        r"$\cos\theta_2 = \frac{x^2 + y^2 - l_1^2 - l_2^2}{2l_1l_2} = D$",
        lambda formula: Equal(formula, defines=D),
        means={"D": D},
    )
    claim(
        "sin θ2, before eq. (3)",
        r"$\sin\theta_2 = \pm\sqrt{1 - D^2}$",
        means={"D": cos(theta2)},
    )
    claim(
        "eq. (3)",
        r"$\theta_2 = a \tan 2(\pm\sqrt{1 - D^2}, D)$",
        lambda formula: Solves(
            {formula.left: formula.right},
            [l1**2 + l2**2 + 2 * l1 * l2 * cos(theta2) - px**2 - py**2],
        ),
        means={"x": px, "y": py, "D": D},
    )
    alpha, beta = atan2(seen[1], seen[0]), atan2(y, x)
    angles = {r"\alpha": alpha, r"\beta": beta}
    claim(
        "θ1, before eq. (4)",
        r"$(\beta - \alpha) = \theta_1$",
        lambda f: Identity([cos(f.left), sin(f.left)], [cos(f.right), sin(f.right)]),
        means=angles,
    )
    d.erratum(
        "tan-alpha",
        "The tangent of the angle at the base has a cosine instead of a sine",
        Gravity.MISPRINT,
        why="The numerator is the height of the hand above the line of the first link, and that is "
        "the second link times the sine of its angle.",
        use="Eq. (4), which follows, is right.  An arm that takes the angle from this line alone "
        "turns its first link to a wrong angle.",
    )
    claim(
        "tan α, before eq. (4)",
        r"$\tan \alpha = \frac{l_2 \cos \theta_2}{l_2 \cos \theta_2 + l_1}$",
        means=angles,
        corrected=r"$\tan \alpha = \frac{l_2 \sin \theta_2}{l_2 \cos \theta_2 + l_1}$",
        erratum="tan-alpha",
    )
    claim("tan β, before eq. (4)", r"$\tan \beta = \frac{y}{x}$", means=angles)
    claim(
        "eq. (4)",
        r"$\tan(\beta - \alpha) = \frac{y(l_2 \cos \theta_2 + l_1) - x(l_2 \sin \theta_2)}"
        r"{x(l_2 \cos \theta_2 + l_1) + y(l_2 \sin \theta_2)}$",
        means=angles,
    )
    claim(
        "eq. (5)",
        r"$\phi = \theta_1 + \theta_2$",
        lambda f: Identity([cos(f.left), sin(f.left)], [cos(f.right), sin(f.right)]),
    )


def convention(d: Derivation) -> None:
    """Eqs. (6) and (7), for any arm."""
    claim = partial(d.claim, where=DENAVIT_HARTENBERG)
    a, alpha, offset, theta = real("a_i"), real("alpha_i"), real("d_i"), real("theta_i")
    ca, sa, ct, st = cos(alpha), sin(alpha), cos(theta), sin(theta)
    A = denavit_hartenberg(a, alpha, offset, theta)
    turn, shift = A[:3, :3], A[:3, 3]
    x_axis, z_axis, origin = sp.Matrix([1, 0, 0]), sp.Matrix([0, 0, 1]), sp.zeros(3, 1)

    claim(
        "four movements, before eq. (6)",
        r"${}^{i-1}A_i = Rot_{z,\theta_i} Trans_{z,d_i} Trans_{x,a_i} Rot_{x,\alpha_i}$",
        Identity(
            A,
            exponential(revolute_twist(z_axis, origin), theta)
            * exponential(prismatic_twist(z_axis), offset)
            * exponential(prismatic_twist(x_axis), a)
            * exponential(revolute_twist(x_axis, origin), alpha),
        ),
    )
    claim(
        "eq. (6)",
        r"${}^{i-1}A_i = \begin{bmatrix} c\theta_i & -c\alpha_i s\theta_i & s\alpha_i s\theta_i "
        r"& a_i c\theta_i \\ s\theta_i & c\theta_i c\alpha_i & -s\alpha_i c\theta_i & "
        r"a_i s\theta_i \\ 0 & s\alpha_i & c\alpha_i & d_i \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(
            sp.Matrix(
                [
                    [ct, -ca * st, sa * st, a * ct],
                    [st, ct * ca, -sa * ct, a * st],
                    [0, sa, ca, offset],
                    [0, 0, 0, 1],
                ]
            ),
            A,
        ),
    )
    R = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
    p = sp.Matrix(3, 1, lambda i, _: real(f"p{i + 1}"))
    claim(
        "eq. (7)",
        r"${}^0A_n = {}^0A_1 {}^1A_2 \dots {}^{n-1}A_n = \begin{bmatrix} {}^0R_n & {}^0p_n \\ "
        r"0 & 1 \end{bmatrix}$",
        Every(
            {
                "for one link": Identity(homogeneous(turn, shift), A),
                "with one more link": Identity(
                    homogeneous(R * turn, R * shift + p), homogeneous(R, p) * A
                ),
                "where R is a rotation": Identity(
                    [*(turn * turn.T), *turn[:, 0].cross(turn[:, 1])], [*sp.eye(3), *turn[:, 2]]
                ),
            }
        ),
    )
    point = sp.Matrix(3, 1, lambda i, _: real(f"v{i + 1}"))
    claim(
        "homogeneous transformation",
        "“The combination of the spatial location and orientation of the end – effector (kinematic "
        "attitudes) can be described mathematically by means of a homogeneous transformation (HT) "
        "matrix.”",
        Identity(homogeneous(R, p) * sp.Matrix([*point, 1]), sp.Matrix([*(R * point + p), 1])),
        where="Abstract",
    )
    back = homogeneous(turn.T, -turn.T * shift)
    claim(
        "joint variables",
        "“It must be observed that for prismatic joints $d_i$ is the joint variable and for "
        "rotational joints, $\\theta_i$ is the joint variable.”",
        Every(
            {
                "an offset slides along the joint axis": Identity(
                    (A.diff(offset) * back)[:3, :], sp.Matrix.hstack(sp.zeros(3), z_axis)
                ),
                "an angle turns about the joint axis": Identity(
                    (A.diff(theta) * back)[:3, :], sp.Matrix.hstack(hat(z_axis), origin)
                ),
            }
        ),
    )
    L = [real(f"l{i}") for i in (1, 2, 3)]
    t = [real(f"theta{i}") for i in (1, 2, 3)]
    directions = [rotation("z", sum(t[: i + 1]))[:, 0] for i in range(3)]
    claim(
        "redundant arms",
        "“D-H Convention method is also applicable to redundant robot arms”",
        Identity(  # for example three parallel joints for a position in the plane
            sp.prod(denavit_hartenberg(L[i], 0, 0, t[i]) for i in range(3))[:3, 3],
            sum((L[i] * directions[i] for i in range(3)), origin),
        ),
        where="Conclusions",
    )


def forward(d: Derivation, arm: Arm) -> None:
    """Table I and eq. (8)."""
    l1, l2, theta1, theta2, position, A1, A2, pose = arm
    c1, s1, c2, s2 = cos(theta1), sin(theta1), cos(theta2), sin(theta2)
    c12, s12 = cos(theta1 + theta2), sin(theta1 + theta2)
    by_geometry = homogeneous(rotation("z", theta1 + theta2), (*position, 0))
    claim = partial(d.claim, where=f"{DENAVIT_HARTENBERG}, A. Forward Kinematics")

    claim(
        "position and orientation",
        "“${}^0p_n$ is the end-effector position, while its orientation is given by the rotation "
        "matrix ${}^0R_n$, which can be used to obtain Euler angles or other representations.”",
        Identity(pose, by_geometry),
    )
    table = ((l1, 0, 0, theta1), (l2, 0, 0, theta2))
    claim(
        "Table I",
        r"$\begin{array}{ccccc} \text{Link} & a_i & \alpha_i & d_i & \theta_i \\ "
        r"1 & a_1 & 0 & 0 & \theta_1 \\ 2 & a_2 & 0 & 0 & \theta_2 \end{array}$",
        Identity(sp.prod(denavit_hartenberg(*row) for row in table), by_geometry),
    )
    claim(
        "A1, before eq. (8)",
        r"$A_1 = \begin{bmatrix} c_1 & -s_1 & 0 & a_1c_1 \\ s_1 & c_1 & 0 & a_1s_1 \\ "
        r"0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(
            sp.Matrix([[c1, -s1, 0, l1 * c1], [s1, c1, 0, l1 * s1], [0, 0, 1, 0], [0, 0, 0, 1]]), A1
        ),
    )
    claim(
        "A2, before eq. (8)",
        r"$A_2 = \begin{bmatrix} c_2 & -s_2 & 0 & a_2c_2 \\ s_2 & c_2 & 0 & a_2s_2 \\ "
        r"0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(
            sp.Matrix([[c2, -s2, 0, l2 * c2], [s2, c2, 0, l2 * s2], [0, 0, 1, 0], [0, 0, 0, 1]]), A2
        ),
    )
    claim(
        "product, before eq. (8)",
        r"$T_2^0 = A_1 * A_2$",
        Identity(A1 * A2, by_geometry),
    )
    claim(
        "eq. (8), with c12 = cos(θ1 + θ2)",
        r"$T_2^0 = \begin{bmatrix} c_{12} & -s_{12} & 0 & a_1c_1 + a_2c_{12} \\ s_{12} & c_{12} & "
        r"0 & a_1s_1 + a_2s_{12} \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(
            sp.Matrix(
                [
                    [c12, -s12, 0, l1 * c1 + l2 * c12],
                    [s12, c12, 0, l1 * s1 + l2 * s12],
                    [0, 0, 1, 0],
                    [0, 0, 0, 1],
                ]
            ),
            A1 * A2,
        ),
    )
    claim(
        "c12, after eq. (8)",
        r"$c_{12} = c_1 + c_2$",
        Identity(c1 + c2, (A1 * A2)[0, 0], corrected=c12),
    )


def inverse(d: Derivation, arm: Arm) -> None:
    """Eqs. (9) and (10)."""
    l1, l2, theta1, theta2, _, A1, A2, pose = arm
    c1, s1, c2, s2 = cos(theta1), sin(theta1), cos(theta2), sin(theta2)
    claim = partial(d.claim, where=f"{DENAVIT_HARTENBERG}, B. Inverse Kinematics")

    A1_inverse = sp.Matrix([[c1, s1, 0, -l1], [-s1, c1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    T = sp.Matrix.vstack(pose[:3, :], sp.Matrix([[0, 0, 1, 0]]))
    claim(
        "eq. (9), inverse of A1",
        r"$A_1^{-1} = \begin{bmatrix} c_1 & s_1 & 0 & -a_1 \\ -s_1 & c_1 & 0 & 0 \\ 0 & 0 & 1 & 0 "
        r"\\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(A1_inverse * A1, sp.eye(4)),
    )
    claim("product, before eq. (9)", r"$A_1^{-1} * T_2^0 = A_2$", Identity(A1_inverse * pose, A2))
    claim(
        "eq. (9), last row of T",
        r"$T_2^0 = \begin{bmatrix} n_x & o_x & a_x & p_x \\ n_y & o_y & a_y & p_y \\ "
        r"n_z & o_z & a_z & p_z \\ 0 & 0 & 1 & 0 \end{bmatrix}$",
        Identity(T, pose),
    )
    claim(
        "eq. (9)",
        r"$\begin{bmatrix} c_1 & s_1 & 0 & -a_1 \\ -s_1 & c_1 & 0 & 0 \\ 0 & 0 & 1 & 0 \\ "
        r"0 & 0 & 0 & 1 \end{bmatrix} \begin{bmatrix} n_x & o_x & a_x & p_x \\ "
        r"n_y & o_y & a_y & p_y \\ n_z & o_z & a_z & p_z \\ 0 & 0 & 1 & 0 \end{bmatrix} = "
        r"\begin{bmatrix} c_2 & -s_2 & 0 & a_2c_2 \\ s_2 & c_2 & 0 & a_2s_2 \\ 0 & 0 & 1 & 0 \\ "
        r"0 & 0 & 0 & 1 \end{bmatrix}$",
        Identity(A1_inverse * T, A2),
    )
    (nx, ox, ax, px), (ny, oy, ay, py) = pose[0, :], pose[1, :]
    eq10 = (
        (r"n_x c_1 + n_y s_1 = \cos \theta_2", nx * c1 + ny * s1, c2),
        (r"o_x c_1 + o_y s_1 = -\sin \theta_2", ox * c1 + oy * s1, -s2),
        (r"a_x c_1 + a_y s_1 = 0", ax * c1 + ay * s1, 0),
        (r"p_x c_1 + p_y s_1 - a_1 = a_2 \cos \theta_2", px * c1 + py * s1 - l1, l2 * c2),
        (r"-n_x s_1 + n_y c_1 = \sin \theta_2", -nx * s1 + ny * c1, s2),
        (r"-o_x s_1 + o_y c_1 = \cos \theta_2", -ox * s1 + oy * c1, c2),
        (r"-a_x s_1 + a_y c_1 = 0", -ax * s1 + ay * c1, 0),
        (r"-p_x s_1 + p_y c_1 = a_2 \sin \theta_2", -px * s1 + py * c1, l2 * s2),
    )
    for line, (printed, left, right) in enumerate(eq10, 1):
        claim(f"eq. (10), line {line}", f"${printed}$", Identity(left, right))
    unknown1, unknown2 = real("unknown1"), real("unknown2")
    seen = A1_inverse.subs(theta1, unknown1) * pose - A2.subs(theta2, unknown2)
    claim(
        "use of eq. (10)",
        "“Eq. (10), can be used to get $\\theta_1$ and $\\theta_2$”",
        Count(list(seen[:2, :]), (unknown1, unknown2), 1),
    )


def results(d: Derivation, arm: Arm) -> None:
    """The numerical example, and the sentences about it."""
    l1, l2, theta1, theta2, position, *_, pose = arm
    px, py = real("px"), real("py")
    given = {l1: sp.Integer(10), l2: sp.Integer(8)}
    printed_angles = {theta1: pi / 6, theta2: pi / 6}
    by_geometry, by_pose = position.subs(given), pose[:2, 3].subs(given)
    x, y = target = by_geometry.subs(printed_angles)

    def inverse(x: sp.Expr, y: sp.Expr, sign: int) -> dict[sp.Symbol, sp.Expr]:
        bend = arm.eq3(x, y, sign)
        return {theta1: atan2(*arm.eq4(x, y, bend)), theta2: bend}

    claim = partial(d.claim, where="Results and Discussion, A")
    claim("Results A, x", r"$x = 12.6602 \text{ cm}$", Decimal("12.6602", x, "cm"))
    claim("Results A, y", r"$y = 11.9282 \text{ cm}$", Decimal("11.9282", y, "cm"))
    claim(
        "use of eqs. (3) and (4)",
        "“The inverse kinematic solution can be obtained from eq. (3), (4)”",
        Every(
            {  # numerator and denominator give the quadrant, which the tangent does not
                name: Identity(position.subs(inverse(px, py, sign)), sp.Matrix([px, py]))
                for name, sign in (("elbow down", +1), ("elbow up", -1))
            }
        ),
    )
    bend = -pi / 6
    elbow_up = {theta1: atan2(*(e.subs(given).expand() for e in arm.eq4(x, y, bend))), theta2: bend}
    claim(
        "Results A, elbow up",
        r"For elbow up, $\theta_2 = -30^\circ, \theta_1 = -30^\circ$",
        Posture(by_geometry, {theta2: -pi / 6, theta1: -pi / 6}, target, elbow_up),
    )
    claim(
        "Results A, elbow down",
        r"For elbow down, $\theta_2 = 30^\circ, \theta_1 = 30^\circ$",
        Posture(by_geometry, {theta2: pi / 6, theta1: pi / 6}, target),
    )
    claim(
        "Results A, orientation",
        r"$\phi = 60^\circ \text{ or } -60^\circ$",
        Every(
            {
                "elbow down": Decimal("60", 2 * pi / 6 * 180 / pi, "degrees"),
                "elbow up": Decimal("-60", sum(elbow_up.values()) * 180 / pi, "degrees"),
            }
        ),
    )
    claim = partial(d.claim, where="Results and Discussion, B")
    x, y = by_pose.subs(printed_angles)
    claim("Results B, x", r"$x = 12.6601 \text{ cm}$", Decimal("12.6601", x, "cm"))
    claim("Results B, y", r"$y = 11.9281 \text{ cm}$", Decimal("11.9281", y, "cm"))
    claim(
        "Results B, inverse",
        r"$\theta_2 = 30^\circ; \theta_1 = 30^\circ$",
        Posture(by_pose, {theta2: pi / 6, theta1: pi / 6}, target),
    )


def values(d: Derivation) -> None:
    """Sentences that read like findings, and why they cannot be decided."""
    claim = d.claim
    claim(
        "better results",
        "“From the above it is evident that D-H Convention method has yielded better results when "
        "compared to Geometric approach.”",
        Undecidable("a judgement of value: the paper does not say what makes a result better"),
        where="Results and Discussion",
    )
    claim(
        "without much difficulty",
        "“the inverse kinematic solution of spatial robot (higher order DOF) can be obtained "
        "without much difficulty by D-H convention method”",
        Undecidable("a judgement of value: the paper names no robot and no measure of difficulty"),
        where="Results and Discussion",
    )
    claim(
        "much better",
        "“Among all the methods used, D-H Convention method is much better for analysis of a given "
        "robot manipulator and wrist combination.”",
        Undecidable("a judgement of value"),
        where="Conclusions",
    )
    claim(
        "MATLAB, abstract",
        "“The codes so developed were tested and verified with suitable numerical examples.”",
        Undecidable("the paper prints no code and no record of a test"),
        where="Abstract",
    )
    claim(
        "MATLAB, conclusions",
        "“The algorithms were developed using MATLAB to verify the accuracy of the solutions "
        "obtained.”",
        Undecidable("the paper prints no algorithm and no accuracy"),
        where="Conclusions",
    )
