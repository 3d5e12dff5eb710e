"""Claims of Reddy and Babu about the wrist by the Denavit-Hartenberg convention."""

from functools import partial

import sympy as sp
from closedform.derivations.claims.planar_2r_convention import EQ6, convention_notation
from closedform.derivations.claims.spherical_wrist_notation import (
    EULER,
    JOINTS,
    MIDDLE,
    ORIENTATION,
    Wrist,
    inverse_claim,
    middle_angle,
    notation,
)
from sympy import pi

from closedform import (
    Check,
    Derivation,
    Gravity,
    Identity,
    Not,
    Notation,
    Reading,
    Relation,
    Solves,
    denavit_hartenberg,
    homogeneous,
    real,
)

RESULTS = "Results and Discussion, C. Results for Orientation of a Spherical Wrist"
ROWS = (
    r"c_4 c_5 c_6 - s_4 s_6 & -c_4 s_5 s_6 - s_4 c_6 & c_4 s_5",
    r"s_4 c_5 c_6 + c_4 s_6 & -s_4 c_5 s_6 + c_4 c_6 & s_4 s_5",
    r"-s_5 c_6 & s_5 s_6 & c_5",
)
EQ14 = (
    rf"T_6^3 = \begin{{bmatrix}} {ROWS[0]} & c_4 s_5 d_6 \\ {ROWS[1]} & s_4 s_5 d_6 \\ "
    rf"{ROWS[2]} & c_5 d_6 \\ 0 & 0 & 0 & 1 \end{{bmatrix}}"
)
EQ15 = rf"R_6^3 = \begin{{bmatrix}} {ROWS[0]} \\ {ROWS[1]} \\ {ROWS[2]} \end{{bmatrix}}"
HAND = r"\begin{bmatrix} 1 & 0 & 0 \\ 0 & 0 & -1 \\ 0 & 1 & 0 \end{bmatrix}"
ANGLES = ("-90", "90", "90")
BOTH = (r"\mp 90", r"\pm 90", r"\pm 90")
ENTRY = real("entry12")
"""Stands for the entry in row 1, column 2, on the left side of a correction."""


def state(d: Derivation, wrist: Wrist, eq12: sp.Matrix) -> None:
    """Transcribe the claims, in the order of the paper."""
    known = notation(wrist, (JOINTS, EULER))
    convention(d, wrist, known)
    results(d, wrist, known, eq12)


def convention(d: Derivation, wrist: Wrist, known: Notation) -> None:
    """Table II and eqs. (14) to (16)."""
    d6, theta4, theta5, theta6, R, pose, _ = wrist
    where = f"{ORIENTATION}, B. D-H Convention"
    by_angles = homogeneous(R, tuple(d6 * R[:, 2]))  # the hand is along its last axis
    A4, A5, A6 = (
        denavit_hartenberg(*row)
        for row in ((0, -pi / 2, 0, theta4), (0, pi / 2, 0, theta5), (0, 0, d6, theta6))
    )
    names = known.extended(
        {
            "A_4": A4,
            "A_5": A5,
            "A_6": A6,
            "T_6^3": by_angles,
            "R_6^3": R,
            "(T_6^3)_{12}": ENTRY,
            "(R_6^3)_{12}": ENTRY,
        }
    )
    claim = partial(d.claim, where=where, notation=names)

    claim(
        "Table II",
        "“Link a^i α^i d^i θ^i” “4 {0} {-90°} {0} {θ_4}” “5 {0} {90°} {0} {θ_5}” "
        "“6 {0} {0} {d^6} {θ_6}”",
        lambda *rows: Identity(
            sp.prod(denavit_hartenberg(*rows[k : k + 4]) for k in (0, 4, 8)), by_angles
        ),
        phrases=[
            {"0": sp.S.Zero, "90°": pi / 2, "-90°": -pi / 2},
            {"d^6": d6, "2 d^6": 2 * d6},
            {"θ_4": theta4, "θ_5": theta5, "θ_6": theta6},
        ],
    )
    claim(
        "product, before eq. (14)",
        "“The final orientation matrix is given by $T_6^3 = A_4 * A_5 * A_6$”",
    )
    d.erratum(
        "entry-12",
        "The wrist's matrix has a sine instead of a cosine in row 1, column 2",
        Gravity.MOTION,
        why="The product of the three matrices has $-c_4 c_5 s_6 - s_4 c_6$ there, as eq. (12) "
        "has.  At $\\theta_4 = \\theta_5 = 0$, $\\theta_6 = 90^\\circ$ the wrist turns the hand by "
        "90 degrees about $z$, and the entry is $-1$; the printed one is 0, so that the second "
        "column vanishes and the matrix is not a rotation.",
        use="A forward map or a Jacobian made from eq. (14) or (15) is wrong except where "
        "$c_4 s_6 (s_5 - c_5) = 0$.  The example has $c_4 = 0$ and does not show it.  The inverse, "
        "eq. (16), does not use this entry.",
    )
    for label, text, derived, name in (
        ("eq. (14)", EQ14, pose, "(T_6^3)_{12}"),
        ("eq. (15)", EQ15, pose[:3, :3], "(R_6^3)_{12}"),
    ):
        if label == "eq. (15)":
            form_of_eq14(claim, pose)
        claim(
            label,
            f"${text}$",
            partial(as_derived, derived, names.read(text)[0].right),
            corrected=f"${name} = -c_4 c_5 s_6 - s_4 c_6$",
            erratum="entry-12",
        )
    claim(
        "θ5, before eq. (16)",
        f"${MIDDLE % JOINTS[1]}$",
        partial(middle_angle, wrist),
    )
    outer = JOINTS[0], JOINTS[2]
    inverse_claim(claim, wrist, pose[:3, :3], "eq. (16)", outer=outer, middle=JOINTS[1], free="θ_4")


def as_derived(derived: sp.Matrix, printed: sp.Matrix, relation: Relation) -> Check:
    """A matrix as derived; a correction of one entry is put into the printed matrix."""
    matrix = relation.right
    if relation.left == ENTRY:
        matrix = printed.copy()
        matrix[0, 1] = relation.right
    return Identity(matrix, derived, names=(f"${relation.texts[0]}$ as printed", "the derived one"))


def form_of_eq14(claim: partial[None], pose: sp.Matrix) -> None:
    """What eq. (14) has in common with eq. (6), the matrix of one link."""
    eq6 = convention_notation().read(EQ6)[0].right
    eq9 = eq6.copy()
    eq9[3, :] = sp.Matrix([[0, 0, 1, 0]])  # as its second factor is printed

    def form(matrix: sp.Matrix) -> Check:
        constant = [e if e.is_number else own for e, own in zip(matrix, pose, strict=True)]
        return Identity(pose, sp.Matrix(4, 4, constant), names=("eq. (14)", "the form"))

    claim(
        "form of eq. (14)",
        "“The above 4*4 homogeneous transformation matrix is in the form of {eq. (6)}, so the "
        "rotation matrix from the above equation is”",
        lambda matrix: Identity([*pose[3, :]], [*matrix[3, :]]),
        phrases=[{"eq. (6)": eq6, "eq. (9)": eq9}],
        readings=[
            Reading(
                "both are homogeneous transformations, with the rotation in the upper left block"
            ),
            Reading("the constant entries of the one are entries of the other", check=form),
        ],
    )


def results(d: Derivation, wrist: Wrist, known: Notation, eq12: sp.Matrix) -> None:
    """The numerical example of an orientation."""
    claim = partial(d.claim, where=RESULTS, notation=known)
    names = known.extended({"R_6^3": wrist.R})
    hand = names.value(HAND)
    values = (names.value(f"{value}^\\circ") for value in ANGLES)
    example = dict(zip(wrist.angles, values, strict=True))
    claim(
        "Results C, hand",
        f"“The hands orientation after rotation is given by ${{}}^A R_H = R_{{zyz}} = {HAND}$”",
        means=dict.fromkeys(("{}^A R_H", "R_{zyz}"), wrist.R.subs(example)),
    )
    d.erratum(
        "second-solution",
        "The example of the wrist gives one solution of two",
        Gravity.OMISSION,
        why="The lower signs of eqs. (13) and (16) give the same rotation with the middle angle "
        "$-90^\\circ$, the first $90^\\circ$ and the last $-90^\\circ$.",
        use="A wrist whose joint limits exclude the printed angles may still reach the "
        "orientation.",
    )
    for label, column, forward in (
        ("Results C, Euler angles", EULER, wrist.R),
        ("Results C, D-H angles", JOINTS, wrist.pose[:3, :3]),
    ):
        claim(
            label,
            angles_text(column, ANGLES),
            partial(solve, list(forward - hand)),
            corrected=angles_text(column, BOTH),
            erratum="second-solution",
        )
    claim(
        "same joint angles",
        "“For the same rotation matrix, the joint angles obtained are {equal} for Euler angles and "
        "D-H convention method.”",
        lambda equal: same if equal else Not(same),
        phrases=[{"equal": True, "different": False}],
    )
    same = Identity(wrist.pose[:3, :3], wrist.R)
    eq15 = names.read(EQ15)[0].right
    corrected = eq15.copy()
    corrected[0, 1] = eq12[0, 1]
    text = (
        "“For the same joint angles, the rotation matrix obtained by using {eq. (12)} and {%s} is "
        "same.”"
    )
    claim(
        "same matrix",
        text % "eq. (15)",
        partial(Identity, names=("the first matrix", "the second")),
        phrases=[
            {
                "eq. (12)": eq12,
                "eq. (15)": eq15,
                "eq. (15) with c_5 in row 1, column 2": corrected,
            }
        ],
        corrected=text % "eq. (15) with c_5 in row 1, column 2",
        erratum="entry-12",
        readings=[
            Reading("for all joint angles"),
            Reading(
                "for those of the example",
                check=lambda first, second: Identity(first.subs(example), second.subs(example)),
            ),
        ],
    )


def angles_text(names: tuple[str, ...], values: tuple[str, ...]) -> str:
    """The column of a table of angles."""
    lines = (f"${n} = {v}^\\circ$" for n, v in zip(names, values, strict=True))
    return f"“{' [...] '.join(lines)}”"


def solve(equations: list[sp.Expr], *printed: Relation) -> Check:
    return Solves({r.left: r.right for r in printed}, equations)
