"""What the names of Reddy and Babu mean for the spherical wrist, and its printed inverse."""

from functools import partial
from typing import NamedTuple

import sympy as sp
from sympy import atan2, cos, pi, sin

from closedform import (
    SIGN,
    Cases,
    Check,
    Every,
    Notation,
    Reading,
    Relation,
    Solves,
    real,
    rotation,
    rotation_parametrisation,
)

ORIENTATION = "Orientation Aspects of A Spherical Wrist"
MIDDLE = r"%s = a \tan 2(\pm\sqrt{(R_{13})^2 + (R_{23})^2}, R_{33})"
FIRST = r"%s = a \tan 2(\pm R_{23}, \pm R_{13})"
LAST = r"%s = a \tan 2(\pm R_{32}, \mp R_{31})"
ALIGNED = r"%s = a \tan 2(R_{21}, R_{22}) - R_{33} %s"
"""The last angle if the outer axes coincide, for any value of the first."""
EULER = (r"\phi", r"\theta", r"\varphi")
JOINTS = (r"\theta_4", r"\theta_5", r"\theta_6")
GIVEN = sp.Matrix(3, 3, lambda i, j: real(f"R{i + 1}{j + 1}"))


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


def notation(wrist: Wrist, order: tuple[tuple[str, ...], ...] = (EULER, JOINTS)) -> Notation:
    """The names of both sections; theta in the condition of eq. (16) is theta5.

    Evidence uses the names that come first in the ``order``.
    """
    names: dict[str, object] = {r"a \tan 2": atan2, "d_6": wrist.d6}
    for names_of_angles in order:
        names |= dict(zip(names_of_angles, wrist.angles, strict=True))
    for euler, number, angle in zip(EULER, "456", wrist.angles, strict=True):
        names |= {f"c{euler}": cos(angle), f"s{euler}": sin(angle)}
        names |= {f"c_{number}": cos(angle), f"s_{number}": sin(angle)}
    entries = {f"R_{{{i + 1}{j + 1}}}": GIVEN[i, j] for i in range(3) for j in range(3)}
    return Notation(names | entries)


def every_rotation(wrist: Wrist, forward: sp.Matrix) -> Check:
    """Eq. (13) gives all solutions of ``forward(angles) = R`` for a general rotation R."""
    known = notation(wrist)
    printed = [known.read(t % n)[0] for t, n in zip((FIRST, MIDDLE, LAST), EULER, strict=True)]
    return Solves({r.left: r.right for r in printed}, list(forward - GIVEN), given=general())


def general() -> dict[sp.Symbol, sp.Expr]:
    """The entries of a rotation in free parameters.

    Half turns are left out, but an equation that holds around them holds for them too.
    """
    return dict(zip(GIVEN, rotation_parametrisation(), strict=True))


def aligned(middle: sp.Expr) -> dict[sp.Symbol, sp.Expr]:
    """The entries of a rotation whose middle angle is 0 or pi, so that the outer axes coincide."""
    turned = rotation("y", middle) * rotation("z", real("psi"))
    return dict(zip(GIVEN, turned, strict=True))


def middle_angle(wrist: Wrist, printed: Relation) -> Check:
    """The middle angle alone solves its equation."""
    return Solves({printed.left: printed.right}, [wrist.R[2, 2] - GIVEN[2, 2]], given=general())


def by_cases(wrist: Wrist, forward: sp.Matrix, *printed: Relation) -> Check:
    """Each case is a condition and the formulas that follow it; the middle angle is as printed."""
    middle = wrist.theta5
    first = notation(wrist).read(MIDDLE % EULER[1])[0].right
    rotations = {sp.S.Zero: aligned(sp.S.Zero), pi: aligned(pi), pi / 2: general()}
    cases: list[tuple[sp.Expr, dict[sp.Symbol, sp.Expr]]] = []
    for relation in printed:
        if relation.left in wrist.angles:
            cases[-1][1][relation.left] = relation.right
        else:
            cases.append((relation.relational, {middle: first}))
    return Cases(
        [
            (
                condition,
                Every(
                    {
                        f"${EULER[1]} = {sp.latex(at)}$" if at != pi / 2 else "otherwise": Solves(
                            formulas, list(forward - GIVEN), given=given
                        )
                        for at, given in rotations.items()
                        if condition.subs(middle, at) == sp.true
                    }
                ),
            )
            for condition, formulas in cases
        ],
        [{middle: at} for at in rotations],
    )


def separate_signs(wrist: Wrist, forward: sp.Matrix, *printed: Relation) -> Check:
    """The same with the other sign in the formula of the first angle."""
    changed = [
        Relation((r.left, r.right.subs(SIGN, -SIGN)), r.signs, r.texts)
        if r.left == wrist.theta4
        else r
        for r in printed
    ]
    return by_cases(wrist, forward, *changed)


def inverse_claim(
    claim: partial[None],
    wrist: Wrist,
    forward: sp.Matrix,
    label: str,
    *,
    outer: tuple[str, str],
    middle: str,
    free: str,
) -> None:
    """The outer angles, which the paper prints twice, under a condition on the middle one.

    It writes theta in the condition both times.

    Parameters
    ----------
    claim
        records a claim of the paper
    wrist
        the symbols of the wrist
    forward
        its rotation
    label
        the number of the equation
    outer, middle
        the angles as the paper writes them
    free
        the angle that is free where the middle one has no sine
    """
    first, last = outer
    formulas = rf"we have ${FIRST % first}$ [...] ${LAST % last}$"
    claim(
        label,
        rf"“If $\sin \theta \neq 0$, {formulas}”",
        partial(by_cases, wrist, forward),
        corrected=rf"“If $\sin {middle} \neq 0$, {formulas}; if $\sin {middle} = 0$, we have "
        rf"${ALIGNED % (last, first)}$ for any {free}”",
        erratum="aligned-axes",
        readings=[
            Reading("the upper signs of all formulas belong together, and so do the lower ones"),
            Reading("each sign may be chosen alone", check=partial(separate_signs, wrist, forward)),
        ],
    )
