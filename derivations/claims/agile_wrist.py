"""Claims of Bonev, Chablat and Wenger about the Agile Eye, quoted from the abstract."""

from collections.abc import Sequence
from functools import partial

import sympy as sp

from closedform import Check, Count, Derivation, Every, Identity, real, rotation_parametrisation

ABSTRACT = "Bonev, Chablat, Wenger, abstract"


def state(
    d: Derivation,
    joints: Sequence[sp.Symbol],
    axes: Sequence[Sequence[sp.Matrix]],
    given: sp.Matrix,
    loop: Sequence[sp.Expr],
) -> None:
    """Transcribe the claims; ``axes`` are u, w, p and v of each leg, p the product of u and w."""
    claim = partial(d.claim, where=ABSTRACT)
    R = dict(zip(given, rotation_parametrisation(), strict=True))

    def orthogonal(cosine: int) -> Check:
        """The first two by themselves, the last two where the loop is closed."""
        return Every(
            {
                "the first and the middle axis are at this angle": Identity(
                    [u.dot(w) for u, w, _, _ in axes], [cosine] * 3
                ),
                "so are the middle and the last axis": Identity(
                    [w.dot(v) for _, w, _, v in axes], [e + cosine for e in loop]
                ),
            }
        )

    def direct(number: int) -> Check:
        """The last axes are x u + y p; y is zero where a leg turns while the hand stands still."""
        x = [real(f"x_{k}") for k in range(3)]
        y = [real(f"y_{k}") for k in range(3)]
        rest = real("rest")
        placed = [a * u + b * p for a, b, (u, _, p, _) in zip(x, y, axes, strict=True)]
        V = sp.Matrix.hstack(*placed)
        square = V.T * V - sp.eye(3)
        rigid = [square[i, j] for i in range(3) for j in range(i, 3)]
        return Count([*rigid, V.det() - 1, rest * y[0] - 1], [*x, *y, rest], number)

    claim(
        "axes",
        "“{all} pairs of adjacent joint axes are {orthogonal}”",
        orthogonal,
        phrases=[{"orthogonal": 0, "parallel": 1}],
        opposites={"all": "not all"},
    )
    claim(
        "assembly modes",
        "“the {four} solutions to the direct kinematics of the Agile Eye (assembly modes)”",
        direct,
    )
    claim(
        "working modes",
        "“the {eight} solutions to the inverse kinematics (working modes)”",
        lambda number: Count(loop, joints, number, given=R),
    )
