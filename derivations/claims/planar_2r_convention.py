"""Claims of Reddy and Babu about the planar arm by the Denavit-Hartenberg convention."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.planar_2r_notation import (
    ANGLES,
    IN_B,
    LENGTHS,
    RESULTS,
    Arm,
    example_of,
    given,
    rounded_coordinate,
)
from sympy import cos, pi, sin

from closedform import (
    Check,
    Derivation,
    Every,
    Gravity,
    Identity,
    Listing,
    Not,
    Notation,
    Reading,
    Relation,
    Replaces,
    Solves,
    denavit_hartenberg,
    exponential,
    hat,
    homogeneous,
    prismatic_twist,
    real,
    revolute_twist,
    rotation,
    simplest,
)
from closedform import (
    inverse as motion_inverse,
)

CONVENTION = "Kinematic Analysis By Denavit – Hartenberg Convention"
MOTIONS = (r"Rot_{z,\theta_i}", r"Trans_{z,d_i}", r"Trans_{x,a_i}", r"Rot_{x,\alpha_i}")
EQ6 = (
    r"{}^{i-1}A_i = \begin{bmatrix} c\theta_i & -c\alpha_i s\theta_i & s\alpha_i s\theta_i & "
    r"a_i c\theta_i \\ s\theta_i & c\theta_i c\alpha_i & -s\alpha_i c\theta_i & a_i s\theta_i \\ "
    r"0 & s\alpha_i & c\alpha_i & d_i \\ 0 & 0 & 0 & 1 \end{bmatrix}"
)
EQ10 = (
    r"n_x c_1 + n_y s_1 &= \cos \theta_2",
    r"o_x c_1 + o_y s_1 &= -\sin \theta_2",
    r"a_x c_1 + a_y s_1 &= 0",
    r"p_x c_1 + p_y s_1 - a_1 &= a_2 \cos \theta_2",
    r"-n_x s_1 + n_y c_1 &= \sin \theta_2",
    r"-o_x s_1 + o_y c_1 &= \cos \theta_2",
    r"-a_x s_1 + a_y c_1 &= 0",
    r"-p_x s_1 + p_y c_1 &= a_2 \sin \theta_2",
)
LOST = r"n_z = 0, o_z = 0, a_z = 1, p_z = 0"
A1_INVERSE = (
    r"\begin{bmatrix} c_1 & s_1 & 0 & -a_1 \\ -s_1 & c_1 & 0 & 0 \\ 0 & 0 & 1 & 0 \\ "
    r"0 & 0 & 0 & 1 \end{bmatrix}"
)
A2_MATRIX = (
    r"\begin{bmatrix} c_2 & -s_2 & 0 & a_2c_2 \\ s_2 & c_2 & 0 & a_2s_2 \\ 0 & 0 & 1 & 0 \\ "
    r"0 & 0 & 0 & 1 \end{bmatrix}"
)
NAMED = (
    r"\begin{bmatrix} n_x & o_x & a_x & p_x \\ n_y & o_y & a_y & p_y \\ n_z & o_z & a_z & p_z \\ "
    r"%s \end{bmatrix}"
)
PRINTED_ROW, LAST_ROW = "0 & 0 & 1 & 0", "0 & 0 & 0 & 1"
X, Z = sp.Matrix([1, 0, 0]), sp.Matrix([0, 0, 1])
ORIGIN = sp.zeros(3, 1)


def state(d: Derivation, arm: Arm, known: Notation) -> None:
    """Transcribe the claims, in the order of the paper."""
    convention(d)
    forward(d, arm, known)
    inverse(d, arm, known)
    redundant(d)


def convention_notation() -> Notation:
    """The names of eqs. (6) and (7); motions are exponentials, and A is what a table gives."""
    a, alpha, offset, theta = real("a_i"), real("alpha_i"), real("d_i"), real("theta_i")
    turn, slide = revolute_twist, prismatic_twist
    motions = (
        exponential(turn(Z, ORIGIN), theta),
        exponential(slide(Z), offset),
        exponential(slide(X), a),
        exponential(turn(X, ORIGIN), alpha),
    )
    return Notation(
        {
            r"c\theta_i": cos(theta),
            r"s\theta_i": sin(theta),
            r"c\alpha_i": cos(alpha),
            r"s\alpha_i": sin(alpha),
            "a_i": a,
            "d_i": offset,
            r"{}^{i-1}A_i": denavit_hartenberg(a, alpha, offset, theta),
        }
        | dict(zip(MOTIONS, motions, strict=True))
    )


def convention(d: Derivation) -> None:
    """Eqs. (6) and (7), for any arm."""
    known = convention_notation()
    a, alpha, offset, theta = real("a_i"), real("alpha_i"), real("d_i"), real("theta_i")
    A = known.meanings[r"{}^{i-1}A_i"]
    claim = partial(d.claim, where=CONVENTION, notation=known)

    point = sp.Matrix(3, 1, lambda i, _: real(f"v{i + 1}"))
    R = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))
    p = sp.Matrix(3, 1, lambda i, _: real(f"p{i + 1}"))
    claim(
        "homogeneous transformation",
        "“The combination of the {spatial location and orientation} of the end – effector "
        "(kinematic attitudes) can be described mathematically by means of a homogeneous "
        "transformation (HT) matrix.”",
        lambda place: Identity(homogeneous(*place) * sp.Matrix([*point, 1]),
                               sp.Matrix([*(R * point + p), 1])),
        where="Abstract",
        phrases=[{"spatial location and orientation": (R, p), "orientation": (R, ORIGIN)}],
    )  # fmt: skip
    kinds = {
        "Rotation": lambda axis, by: exponential(revolute_twist(axis, ORIGIN), by),
        "Translation": lambda axis, by: exponential(prismatic_twist(axis), by),
    }
    amounts = {"θ_i": theta, "d_i": offset, "a_i": a, "α_i": alpha}
    claim(
        "four movements",
        "“Matrix Ai representing the four movements is found by” “(a) {Rotation} of {θ_i} about "
        "current {z} axis” “(b) {Translation} of {d_i} along current {z} axis” “(c) {Translation} "
        "of {a_i} along current {x} axis” “(d) {Rotation} of {α_i} about current {x} axis”",
        lambda *said: Identity(
            sp.prod(said[k](said[k + 2], said[k + 1]) for k in range(0, 12, 3)), A
        ),
        phrases=[kinds, amounts, {"z": Z, "x": X}],
    )
    claim(
        "product, before eq. (6)",
        r"${}^{i-1}A_i = Rot_{z,\theta_i} Trans_{z,d_i} Trans_{x,a_i} Rot_{x,\alpha_i}$",
    )
    claim(
        "eq. (6)", f"${EQ6}$", means={r"{}^{i-1}A_i": sp.prod(known.meanings[m] for m in MOTIONS)}
    )
    frames = [
        (sp.Matrix(3, 3, lambda i, j, k=k: real(f"R{k}_{i + 1}{j + 1}")),
         sp.Matrix(3, 1, lambda i, _, k=k: real(f"p{k}_{i + 1}")))
        for k in range(4)
    ]  # fmt: skip
    directions = [sp.eye(3)]  # of each frame, seen from the base
    for turned, _ in frames:
        directions.append(directions[-1] * turned)
    end = sum((D * shift for D, (_, shift) in zip(directions, frames, strict=False)), ORIGIN)
    matrices = [homogeneous(*frame) for frame in frames]
    claim(
        "eq. (7)",
        "“The overall transformation matrix is represented as "
        r"${}^0A_n = {}^0A_1 {}^1A_2 \dots {}^{n-1}A_n = \begin{bmatrix} {}^0R_n & {}^0p_n \\ "
        r"0 & 1 \end{bmatrix}$”",
        means=dict(zip(("{}^0A_1", "{}^1A_2", r"\dots", "{}^{n-1}A_n"), matrices, strict=True))
        | {
            "{}^0A_n": homogeneous(directions[-1], end),
            "{}^0R_n": directions[-1],
            "{}^0p_n": end,
        },
    )
    back = homogeneous(A[:3, :3].T, -A[:3, :3].T * A[:3, 3])
    slides = sp.Matrix.vstack(sp.Matrix.hstack(sp.zeros(3), Z), sp.zeros(1, 4))
    turns = sp.Matrix.vstack(sp.Matrix.hstack(hat(Z), ORIGIN), sp.zeros(1, 4))
    claim(
        "joint variables",
        "“It must be observed that for prismatic joints {d_i} is the joint variable and for "
        "rotational joints, {θ_i} is the joint variable.”",
        lambda slid, turned: Every(
            {
                "the first slides along the axis of the joint": Identity(
                    A.diff(slid) * back, slides
                ),
                "the second turns about it": Identity(A.diff(turned) * back, turns),
            }
        ),
        phrases=[amounts],
    )


def forward(d: Derivation, arm: Arm, known: Notation) -> None:
    """Table I and eq. (8)."""
    l1, l2, theta1, theta2, position, A1, A2, pose = arm
    by_geometry = homogeneous(rotation("z", theta1 + theta2), (*position, 0))
    matrices = {"A_1": A1, "A_2": A2, "T_2^0": by_geometry}
    claim = partial(
        d.claim,
        where=f"{CONVENTION}, A. Forward Kinematics",
        notation=known.extended(matrices),
    )

    claim(
        "position and orientation",
        "“{0p_n} is the end-effector position, while its orientation is given by the rotation "
        "matrix {0R_n} ,”",
        lambda p, R: Identity([*R, *p], [*by_geometry[:3, :3], *by_geometry[:3, 3]]),
        phrases=[
            {"0p_n": pose[:3, 3], "the first column of 0R_n": pose[:3, 0]},
            {"0R_n": pose[:3, :3], "the transpose of 0R_n": pose[:3, :3].T},
        ],
        where=CONVENTION,
    )
    claim(
        "direct kinematics",
        "“Matrix {0A_n} expresses the direct kinematics of the manipulator.”",
        lambda A: Identity(A, by_geometry),
        phrases=[{"0A_n": pose, "0A_1": A1}],
        where=CONVENTION,
    )
    claim(
        "Table I",
        "“Link a_i α_i d_i θ_i” “1 {a_1} {0} {0} {θ_1}” “2 {a_2} {0} {0} {θ_2}”",
        lambda *rows: Identity(
            denavit_hartenberg(*rows[:4]) * denavit_hartenberg(*rows[4:]), by_geometry
        ),
        phrases=[
            {"a_1": l1, "a_2": l2},
            {"0": sp.S.Zero, "90°": pi / 2},
            {"θ_1": theta1, "θ_2": theta2},
        ],
    )
    claim(
        "A1, before eq. (8)",
        "“substitute the above parameters in A matrix, we get "
        r"$A_1 = \begin{bmatrix} c_1 & -s_1 & 0 & a_1c_1 \\ s_1 & c_1 & 0 & a_1s_1 \\ "
        r"0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}$”",
    )
    claim("A2, before eq. (8)", f"$A_2 = {A2_MATRIX}$")
    claim(
        "product, before eq. (8)",
        "“The successive homogeneous transformation would result in $T_2^0 = A_1 * A_2$”",
    )
    claim(
        "eq. (8)",
        r"$T_2^0 = \begin{bmatrix} c_{12} & -s_{12} & 0 & a_1c_1 + a_2c_{12} \\ s_{12} & c_{12} & "
        r"0 & a_1s_1 + a_2s_{12} \\ 0 & 0 & 1 & 0 \\ 0 & 0 & 0 & 1 \end{bmatrix}$",
        means={"T_2^0": A1 * A2},
    )
    claim("c1, after eq. (8)", r"$c_1 = \cos \theta_1$", means={"c_1": A1[0, 0]})
    claim("s1, after eq. (8)", r"$s_1 = \sin \theta_1$", means={"s_1": A1[1, 0]})
    example = example_of(arm)
    d.erratum(
        "sum-of-cosines",
        "$c_{12}$ is explained as a sum of cosines",
        Gravity.MISPRINT,
        why="The product $A_1 A_2$ contains $c_1c_2 - s_1s_2$, which is the cosine of the sum of "
        "the angles; $s_{12}$ is likewise the sine of the sum.  At $\\theta_1 = \\theta_2 = "
        "30^\\circ$ the printed sum is $\\sqrt{3}$, which is not a cosine.",
        use="The positions of the example show that the cosine of the sum was used.  A program "
        "with the printed sum would put the hand of the example at $x = [wrong]$ cm instead "
        "of [x] cm.",
        numbers={
            "wrong": ((l1 * cos(theta1) + l2 * (cos(theta1) + cos(theta2))).subs(example), 1),
            "x": ((A1 * A2)[0, 3].subs(example), 1),
        },
    )
    claim(
        "c_12, after eq. (8)",
        r"$c_{12} = c_1 + c_2$",
        means={"c_{12}": (A1 * A2)[0, 0]},
        corrected=r"$c_{12} = \cos(\theta_1 + \theta_2)$",
        erratum="sum-of-cosines",
    )


def pose_names(T: sp.Matrix) -> dict[str, sp.Expr]:
    """The names of the entries of ``T`` in eq. (9)."""
    return {f"{'noap'[j]}_{'xyz'[i]}": T[i, j] for i in range(3) for j in range(4)}


def any_pose() -> sp.Matrix:
    """A matrix of symbols with the last row of a homogeneous transformation."""
    names = sp.Matrix(3, 4, lambda i, j: real(f"{'noap'[j]}_{'xyz'[i]}"))
    return sp.Matrix.vstack(names, sp.Matrix([[0, 0, 0, 1]]))


def aligned(lines: tuple[str, ...]) -> str:
    """Lines of equations as one formula, as eq. (10) is printed."""
    return r"\begin{aligned} " + r" \\ ".join(lines) + r" \end{aligned}"


def inverse(d: Derivation, arm: Arm, known: Notation) -> None:
    """Eqs. (9) and (10)."""
    _, _, theta1, theta2, _, A1, A2, pose = arm
    A1_inverse = simplest(motion_inverse(A1))
    names = known.extended(
        {"A_1": A1, "A_2": A2, "T_2^0": A1 * A2, "A_1^{-1}": A1_inverse} | pose_names(pose)
    )
    claim = partial(d.claim, where=f"{CONVENTION}, B. Inverse Kinematics", notation=names)
    claim(
        "product, before eq. (9)",
        "“The inverse kinematics can be obtained by using the relation $T_2^0 = A_1 * A_2$ "
        "$A_1^{-1} * T_2^0 = A_2$”",
    )
    claim("eq. (9), first factor", f"$A_1^{{-1}} = {A1_INVERSE}$", paraphrase=True)
    d.erratum(
        "last-row",
        "The last row of the homogeneous transformation is (0, 0, 1, 0)",
        Gravity.MISPRINT,
        why="The last row of every homogeneous transformation is (0, 0, 0, 1), as in eqs. (6) to "
        "(8).  With the printed row, the columns $a$ and $p$ of the product are not those of "
        "$A_2$.",
        use="Eq. (10) uses the first two rows only and is not affected.  A program with the "
        "printed matrix loses the position: the last column of its product "
        "with $A_1^{-1}$ does not contain $-a_1$.",
    )
    for label, text, paraphrase in (
        ("eq. (9), second factor", f"$T_2^0 = {NAMED}$", True),
        ("eq. (9)", f"${A1_INVERSE} {NAMED} = {A2_MATRIX}$", False),
    ):
        claim(
            label,
            text % PRINTED_ROW,
            corrected=text % LAST_ROW,
            erratum="last-row",
            paraphrase=paraphrase,
        )
    claim("eq. (10)", f"${aligned(EQ10)}$")

    d.erratum(
        "rows-lost",
        "The third row of eq. (9) is lost in eq. (10)",
        Gravity.OMISSION,
        why="Eq. (9) has twelve equations, and eq. (10) repeats the eight of the first two rows.  "
        "The third row says that the target is in the plane of the arm: $n_z = o_z = 0$, "
        "$a_z = 1$, $p_z = 0$.  If $T_2^0$ is a rigid motion, the first three follow from the "
        "others, but $p_z = 0$ does not.",
        use="For a target above the plane, such as that of the example raised by 5 cm, eq. (10) "
        "has the solution $\\theta_1 = \\theta_2 = 30^\\circ$ although the arm cannot take this "
        "pose: the hand stops 5 cm below.  A program has to test $p_z = 0$ itself.",
    )
    symbolic = any_pose()
    by_name = names.extended(pose_names(symbolic))

    def all_of_it(*printed: tuple[Relation, ...]) -> Check:
        return Listing(
            [sp.expand(r.left - r.right) for lines in printed for r in lines],
            lambda: [sp.expand(e) for e in A1_inverse * symbolic - A2 if sp.expand(e) != 0],
            "equations in eq. (9)",
            lambda e: (sp.Eq(e, 0, evaluate=False),),
        )

    comparing = "“by comparing the elements of (LHS and RHS) the above matrices, we get "
    claim(
        "list of eq. (10)",
        f"{comparing}${aligned(EQ10)}$”",
        all_of_it,
        notation=by_name,
        phrases=[{"eq. (10)": by_name.read(aligned(EQ10))}],
        corrected=f"{comparing}{{eq. (10)}} and ${LOST}$”",
        erratum="rows-lost",
    )
    at_other = pose.subs({theta1: real("beta1"), theta2: real("beta2")}, simultaneous=True)
    lifted = at_other.copy()
    lifted[2, 3] = real("p_z")

    def determine(target: sp.Matrix, lines: tuple[str, ...]) -> Check:
        read = known.extended(pose_names(symbolic)).read(aligned(lines))
        values = dict(zip(symbolic[:3, :], target[:3, :], strict=True))
        return Replaces(
            [(r.left - r.right).subs(values) for r in read],
            list((A1_inverse * target - A2)[:3, :]),
            (theta1, theta2),
            {real("beta1"): theta1, real("beta2"): theta2},
        )

    claim(
        "use of eq. (10)",
        "“{Eq. (10)}, can be used to get θ_1 and θ_2”",
        partial(determine, at_other),
        phrases=[{"Eq. (10)": EQ10, "The third line of eq. (10)": EQ10[2:3]}],
        readings=[
            Reading("for a pose that the arm can take"),
            Reading(
                "also for a pose at a height $p_z$, which the arm cannot take",
                check=partial(determine, lifted),
            ),
        ],
    )


def redundant(d: Derivation) -> None:
    """Three parallel joints for a position in the plane, as an example."""
    lengths = [real(f"l{i}") for i in (1, 2, 3)]
    angles = [real(f"theta{i}") for i in (1, 2, 3)]
    links = [length * rotation("z", sum(angles[: i + 1]))[:, 0] for i, length in enumerate(lengths)]
    product = sp.prod(
        denavit_hartenberg(length, 0, 0, angle)
        for length, angle in zip(lengths, angles, strict=True)
    )
    holds = Identity(product[:3, 3], sum(links, ORIGIN))
    d.claim(
        "redundant arms",
        "“D-H Convention method is {also applicable} to redundant robot arms”",
        lambda applicable: holds if applicable else Not(holds),
        where="Conclusions",
        phrases=[{"also applicable": True, "not applicable": False}],
    )


def example(d: Derivation, arm: Arm, known: Notation) -> None:
    """The numerical example by the convention."""
    claim = partial(
        d.claim,
        where=f"{RESULTS}, B. Result for 2-DOF planar robot by D-H Convention method",
        notation=known.extended({"x": real("x"), "y": real("y")}),
    )
    values = example_of(arm)
    rounded_or_cut = [
        Reading("rounded", lambda printed: rounded_coordinate(arm, printed, values)),
        Reading(
            "the digits after the fourth are cut off",
            lambda printed: rounded_coordinate(arm, printed, values, cut=True),
        ),
    ]
    claim(
        "Results B, x",
        f"“The forward kinematic result obtained from eq. (8) is ${IN_B[0]}$”",
        readings=rounded_or_cut,
        corrected=r"$x = 12.6603 \text{ cm}$",
        erratum="rounding",
    )
    claim(
        "Results B, y",
        f"${IN_B[1]}$",
        readings=rounded_or_cut,
        corrected=r"$y = 11.9282 \text{ cm}$",
        erratum="rounding",
    )

    theta1, theta2 = arm.theta1, arm.theta2
    posture = {theta1: real("beta1"), theta2: real("beta2")}
    lines = known.extended(pose_names(arm.pose.subs(posture, simultaneous=True))).read(
        aligned(EQ10)
    )
    by_pose = [r.left - r.right for r in lines]
    by_position = list(arm.position - arm.position.subs(posture, simultaneous=True))

    def solves(equations: list[sp.Expr], *printed: tuple[Relation, ...]) -> Check:
        lengths, angles, found = map(given, printed)
        placed = {posture[name]: value for name, value in angles.items()}
        return Every(
            {
                "the angles give the target": Identity(
                    arm.position.subs(lengths).subs(angles), arm.position.subs(values)
                ),
                "they solve the equations": Identity(
                    [e.subs(lengths).subs(placed).subs(found) for e in equations],
                    [sp.S.Zero] * len(equations),
                ),
                "the equations have this solution": Solves(posture, equations),
            }
        )

    claim(
        "Results B, inverse",
        f"“Let us consider the link lengths and joint angles are as follows ${LENGTHS}$ "
        f"${ANGLES}$” “The inverse kinematic result obtained from eq. (10) is "
        r"$\theta_2 = 30^\circ; \theta_1 = 30^\circ$”",
        partial(solves, by_pose),
        readings=[
            Reading("for the whole pose, which eq. (10) takes"),
            Reading("for the position alone, as in A", check=partial(solves, by_position)),
        ],
    )
