"""What the names of Reddy and Babu mean for the planar arm, and their numerical example."""

from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, sin

from closedform import Notation, Relation, Rounded, real

RESULTS = "Results and Discussion"
LENGTHS = r"l_1 = 10 \text{ cm}, l_2 = 8 \text{ cm}"
ANGLES = r"\theta_1 = 30^\circ, \theta_2 = 30^\circ"
IN_A = (r"x = 12.6602 \text{ cm}", r"y = 11.9282 \text{ cm}")
IN_B = (r"x = 12.6601 \text{ cm}", r"y = 11.9281 \text{ cm}")
"""The positions that both sections of the results print."""


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


def given(*formulas: tuple[Relation, ...]) -> dict[sp.Symbol, sp.Expr]:
    """The values that formulas such as ``l_1 = 10, l_2 = 8`` give to names."""
    return {r.left: r.right for formula in formulas for r in formula}


def example_of(arm: Arm) -> dict[sp.Symbol, sp.Expr]:
    """The lengths and angles of the paper's example."""
    known = notation(arm)
    return given(known.read(LENGTHS), known.read(ANGLES))


def lengths_of_example(arm: Arm) -> dict[sp.Symbol, sp.Expr]:
    return given(notation(arm).read(LENGTHS))


def rounded_coordinate(
    arm: Arm, printed: Relation, example: dict[sp.Symbol, sp.Expr], *, cut: bool = False
) -> Rounded:
    """A printed coordinate of the hand; a name to which the paper gives no value counts as 0."""
    exact = dict(zip((real("x"), real("y")), arm.position, strict=True)).get(
        printed.left, sp.S.Zero
    )
    rest = dict.fromkeys((arm.l1, arm.l2, arm.theta1, arm.theta2), 0)
    return Rounded(printed, exact.subs(example).subs(rest), "cm", cut=cut)
