"""The Jacobian of the H6AR as a product of small matrices, for both models.

The tip is at the end of a virtual arm whose fore-arm includes the wrist: three lengths, which
depend on yaw, roll and pitch alone, and three angles.
"""

from typing import Any

import sympy as sp
from closedform.derivations.h6ar_mechanism import (
    L_2W,
    Dimensions,
    Joints,
    Posture,
    a_3W,
    extended,
    in_space,
    pair,
    phi,
    psi,
    reach,
    theta2A,
    theta23A,
    wrist_squared,
)
from sympy import cos

from closedform import Derivation, real

L_theta, l_H = real("L_theta"), real("l_H")
LENGTHS = (L_theta, L_2W, a_3W)
MEANINGS = {
    "J_o": "derivative of the task with respect to theta1, the virtual arm, yaw, roll and pitch",
    "J_i": "derivative of theta1, the virtual arm, yaw, roll and pitch with respect to the joints",
    "P": "derivative of the position with respect to theta1 and the virtual arm",
    "Q": "derivative of the position with respect to the lengths of the virtual arm with the wrist",
    "H": "derivative of the lengths of the virtual arm with the wrist with respect to yaw, roll "
    "and pitch",
    "H_0": "what H is for a wrist of constant length",
    r"\mathbf w": "derivative of the lengths of the virtual arm with the wrist with respect to "
    "that of the wrist",
    r"\mathbf g": "derivative of the length of the wrist with respect to yaw, roll and pitch",
    "V": "derivative of the virtual arm with respect to the joints of the arms",
    "W": "derivative of yaw and roll with respect to the joints of the arms",
}


def factors_shown(
    d: Derivation, m: Dimensions, q: Joints, base: sp.Expr, wrist: sp.Symbol
) -> tuple[dict[str, Any], sp.Matrix]:
    """What a step shows of the outer factor, and the first three rows that follow from it.

    ``base`` is half the base line as a function of yaw and roll, ``wrist`` the symbol for l_W.
    """
    d.explain(MEANINGS)
    turns = (psi, phi, q.theta)
    whole = wrist + m.loff + m.lp * cos(q.theta)
    posture = Posture(*map(pair, (q.theta1, theta2A, theta23A, *turns)), wrist, base)
    aside, along, across = (_with_hand(e, whole) for e in extended(m, posture))
    lengths = sp.Matrix([aside, along, across])
    end = reach(m, posture.upper, posture.fore, L_2W, a_3W)
    place = in_space(m, posture.waist, end, -L_theta)
    P, Q = place.jacobian([q.theta1, theta2A, theta23A]), place.jacobian(LENGTHS)
    by_hand = lengths.diff(l_H)
    constant = lengths.jacobian(turns) + by_hand * sp.Matrix([whole]).jacobian(turns)
    slopes = sp.Matrix([wrist_squared(m, base)]).jacobian(turns) / (2 * wrist)
    known = dict(zip(LENGTHS, lengths, strict=True))
    rows = sp.Matrix.hstack(P.subs(known), Q * (constant + by_hand * slopes)).subs(l_H, whole)
    shown = {
        "J": r"J_o\,J_i",
        "J_o": r"\begin{bmatrix} P & Q\,H \\ 0 & I \end{bmatrix}",
        "J_i": r"\begin{bmatrix} 1 & 0 & 0 \\ 0 & V & 0 \\ 0 & W & 0 \\ 0 & 0 & 1 \end{bmatrix}",
        "P": P,
        "Q": Q,
        "H": r"H_0 + \mathbf w\,\mathbf g^T",
        "H_0": constant,
        r"\mathbf w": by_hand,
        r"\mathbf g": slopes.T,
    }
    return shown, rows


def _with_hand(length: sp.Expr, whole: sp.Expr) -> sp.Expr:
    """A length in the name of the distance of the hand along the wrist."""
    return sp.sympify(length).subs(whole, l_H)


TIP_RATES = {
    "A_R": "derivative of the right tip with respect to the joints of its arm, in the mid-plane",
    "A_L": "derivative of the left tip with respect to the joints of its arm, in the mid-plane",
}
LOOP_MEANINGS = TIP_RATES | {
    "K": "derivative of the end of the virtual arm with respect to its angles",
    "E": "derivative of yaw and roll with respect to the base line",
    "S": "derivative of the base line, seen from the virtual fore-arm, with respect to the tips",
}


def loop_factors(
    d: Derivation,
    virtual: sp.Matrix,
    arms: tuple[sp.Matrix, sp.Matrix],
    by_line: sp.Matrix,
    line_by: sp.Matrix,
) -> dict[str, Any]:
    """The factors of the rates of the virtual arm, of yaw and of roll in the closed loop."""
    d.explain(LOOP_MEANINGS)
    right, left = arms
    return {
        "V": r"\frac{1}{2} K^{-1} \begin{bmatrix} A_R & A_L \end{bmatrix}",
        "K": virtual,
        "A_R": right,
        "A_L": left,
        "W": r"E\,S \begin{bmatrix} \left[\frac{1}{2} A_R \;\; - \frac{1}{2} A_L\right] \\[5pt] "
        r"\left[0 \;\; 1\right] V \end{bmatrix}",
        "E": by_line,
        "S": line_by,
    }


__all__ = ["TIP_RATES", "factors_shown", "loop_factors"]
