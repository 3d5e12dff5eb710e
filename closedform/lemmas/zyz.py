"""The angles of a rotation about z, y and z."""

from __future__ import annotations

import sympy as sp

from closedform.model.functions import Program, choose
from closedform.model.lemma import Lemma, label


def zyz_angles(
    program: Program,
    R: sp.Matrix,
    first: sp.Symbol,
    middle: sp.Symbol,
    last: sp.Symbol,
    sigma: sp.Symbol,
    *,
    turn: int = 1,
    scale: int = 1,
    suffix: str = "",
) -> Lemma:
    """``Rz(first) Ry(turn * middle) Rz(last) = R``: two solutions, by the sign of sin(middle).

    The third column of R gives the first two angles.  The last is *not* read from the third row, as
    the textbooks do: near ``middle = 0`` that row knows nothing of it.  It follows from the
    rotation that the first angle leaves, ``Rz(first)^T R = Ry(middle) Rz(last)``, whose second row
    is ``(sin(last), cos(last), 0)``, and so keeps the product exact whatever error ``first`` has.
    The second solution is the first with a half turn of both outer angles.

    Where ``sin(middle) = 0`` only ``first + last`` (or ``first - last``) is determined; the
    convention is ``first = 0``.  ``scale`` counts the roundings that R has seen.
    """
    h = program.let(f"h{suffix}", sp.sqrt(R[0, 2] ** 2 + R[1, 2] ** 2), nonnegative=True)
    aligned = program.vanishes(
        f"aligned{suffix}", h, scale, "the first and the last axis coincide", free=(first,)
    )
    tag = label(first)
    c_first = program.let(f"c{tag}", choose(aligned, 1, turn * R[0, 2] / h))
    s_first = program.let(f"s{tag}", choose(aligned, 0, turn * R[1, 2] / h))
    flip = program.let(f"flip{suffix}", choose(aligned, 0, (1 - sigma) * sp.pi / 2))
    s_middle = turn * (c_first * R[0, 2] + s_first * R[1, 2])
    s_last = c_first * R[1, 0] - s_first * R[0, 0]
    c_last = c_first * R[1, 1] - s_first * R[0, 1]
    axis = [turn * R[i, 2] for i in (0, 1)]
    return Lemma(
        "ZYZ angles",
        r"c_1 = \sigma R_{13}/h,\ s_1 = \sigma R_{23}/h,\ h = \sqrt{R_{13}^2 + R_{23}^2};\quad "
        r"\theta_2 = \operatorname{atan2}(c_1 R_{13} + s_1 R_{23}, R_{33});\quad "
        r"\theta_3 = \operatorname{atan2}(c_1 R_{21} - s_1 R_{11}, c_1 R_{22} - s_1 R_{12})",
        (
            sp.cos(first) * sp.sin(middle) - axis[0],
            sp.sin(first) * sp.sin(middle) - axis[1],
            sp.cos(middle) - R[2, 2],
            sp.sin(last) - (sp.cos(first) * R[1, 0] - sp.sin(first) * R[0, 0]),
            sp.cos(last) - (sp.cos(first) * R[1, 1] - sp.sin(first) * R[0, 1]),
        ),
        {
            first: sp.atan2(s_first, c_first) + flip,
            middle: sigma * sp.atan2(s_middle, R[2, 2]),
            last: sp.atan2(s_last, c_last) + flip,
        },
        2,
    )
