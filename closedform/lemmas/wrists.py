"""Arms that end in a spherical wrist: the arm places its centre, the wrist then turns the hand.

The three axes of the wrist meet in its centre, which is the origin of the hand frame.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from closedform.algebra.solutions import rotation_parametrisation
from closedform.lemmas.pairs import Pair
from closedform.lemmas.zyz import zyz_angles
from closedform.mechanics.frames import determinant, rotation
from closedform.mechanics.serial import Links, product
from closedform.model.derivation import Continuum, Derivation, Inverse, Solved, Stage
from closedform.model.functions import Branches, Program, real

Pairs = Mapping[sp.Expr, Pair]

_ROUNDINGS = 16
"""How much rounding an arm puts on the rotation it leaves to its wrist, in units of that of the
target.  A wrist within it counts as aligned, which turns the hand by 3e-14 at most; 98 of 100
random postures of a Puma whose wrist is aligned exactly are seen as such, of the others the angles
that come back are right as well."""


def export_determinant(
    d: Derivation, J: sp.Matrix, factors: Mapping[str, sp.Expr], reason: str
) -> sp.Expr:
    """The determinant of the geometric Jacobian, arm by wrist, and the factors of its zeros."""
    arm, wrist = determinant(J[:3, :3]), determinant(J[3:, 3:])
    det = arm * wrist
    d.step(
        "Determinant and singular set",
        "The wrist does not move its centre, so the determinant is that of the arm times that of "
        f"the wrist.  {reason}",
        {r"\det J_{11}": arm, r"\det J_{22}": wrist},
        equal=[
            (J[:3, 3:], sp.zeros(3)),
            (J[:3, :3].det(), arm),
            (J[3:, 3:].det(), wrist),
        ],
    )
    q = d.actuated
    d.function("determinant", "Determinant of the Jacobian.", {"q": q}, {"det": det})
    named = ", ".join(factors)
    d.function(
        "singularities",
        f"The factors whose zeros are the singular set: {named}.",
        {"q": q},
        {"factors": list(factors.values())},
    )
    return det


def export_inverse(
    d: Derivation,
    program: Program,
    T: sp.Matrix,
    solution: Mapping[sp.Symbol, sp.Expr],
    arm: Sequence[tuple[sp.Matrix, Pairs]],
    wrist: Links,
    branches: Branches,
    sigma: sp.Symbol,
    *,
    turn: int,
    free: Sequence[tuple[sp.Symbol, sp.Symbol, Mapping[sp.Symbol, Any]]] = (),
    notes: Sequence[str] = (),
) -> None:
    """The inverse of an arm that ``solution`` solves, with its wrist: steps, function and proof.

    ``arm`` lists its links with the pairs of their angles, which are handed on to the wrist.  The
    wrist is ``Rz Ry(turn * middle) Rz``: a twist of +90 degrees before its middle joint makes
    ``turn`` -1.  The sign ``sigma`` of ``branches`` is that of the sine of the middle joint.
    ``free`` lists where a joint of the arm is free: the joint, the flag of the program, and the
    values of inputs and parameters there; the wrist follows the joint.
    """
    joints = tuple(x for x in d.actuated if x not in solution)
    first, middle, last = joints
    links = [A for A, _ in arm]
    R03, R36 = product(links)[:3, :3], product(wrist)[:3, :3]
    left = T[:3, :3]
    for k, (A, pairs) in enumerate(arm, 1):
        known = {f: v for angle, pair in pairs.items() for f, v in pair.instead_of(angle).items()}
        left = program.matrix(f"R{k}", A[:3, :3].xreplace(known).T * left)
    angles = zyz_angles(program, left, first, middle, last, sigma, turn=turn, scale=_ROUNDINGS)
    M = R03.T * T[:3, :3]
    d.solved.append(Solved("ik", first, angles, M[0, 2] * sp.sin(first) - M[1, 2] * sp.cos(first)))
    turned = {first: first + sp.pi, middle: -middle, last: last + sp.pi}
    d.step(
        "Inverse: the wrist",
        f"The arm leaves the rotation R_03^T R to the wrist, whose third column gives {first} and "
        f"{middle}.  noflip has sin({middle}) >= 0, flip has {first} and {last} turned by pi and "
        f"{middle} negated.  Where sin({middle}) = 0 only {first} + {last} or {first} - {last} is "
        f"determined and we return {first} = 0.",
        {"R_{03}": R03, "R_{36}": R36},
        equal=[
            (R36, rotation("z", first) * rotation("y", turn * middle) * rotation("z", last)),
            (R36.subs(turned, simultaneous=True), R36),
        ],
    )
    d.branches = branches.labels
    d.function(
        "ik",
        f"All {len(branches)} configurations of a pose.",
        {"T": T},
        {"q": [solution.get(x, angles.solution.get(x)) for x in d.actuated]},
        program=program,
        branches=branches,
        result="Solutions",
        notes=(
            *notes,
            f"noflip: sin({middle}) >= 0; flip: sin({middle}) <= 0.",
            f"SINGULAR: the wrist is aligned, sin({middle}) = 0, and {first} = 0 is returned.",
            "INVALID: a matrix that is no homogeneous transform, a mirrored rotation included.",
        ),
    )
    given = {angle: pair for _, pairs in arm for angle, pair in pairs.items()}
    continua = [
        Continuum(
            flag,
            {x: sp.sympify(value, strict=True) for x, value in locus.items()},
            joint,
            r"R_{36} = R_{03}^T R",
        )
        for joint, flag, locus in free
    ]
    continua += _aligned(T, R03, first, last)
    d.inverses.append(_partitioned(T, links, wrist, d.actuated, joints, given, tuple(continua)))


def _aligned(
    T: sp.Matrix, R03: sp.Matrix, first: sp.Symbol, last: sp.Symbol
) -> tuple[Continuum, ...]:
    """The wrist straight and folded back: its outer axes coincide."""
    psi = real("psi")
    cases = ((sp.eye(3), "+"), (rotation("y", sp.pi), "-"))
    return tuple(
        Continuum(
            sp.Symbol("aligned"),
            dict(zip(T[:3, :3], R03 * middle * rotation("z", psi), strict=True)),
            first,
            f"{sp.latex(first)} {sign} {sp.latex(last)}",
        )
        for middle, sign in cases
    )


def _partitioned(
    T: sp.Matrix,
    arm: Links,
    wrist: Links,
    q: Sequence[sp.Symbol],
    joints: tuple[sp.Symbol, ...],
    pairs: Pairs,
    continua: tuple[Continuum, ...],
) -> Inverse:
    """What the inverse must satisfy: the position by the arm, then the rotation by the wrist."""
    R = product(arm)[:3, :3]
    place = {e: k for k, e in enumerate(T)}
    turns = tuple(place[e] for e in T[:3, :3])
    bottom = zip(T[3, :], map(sp.sympify, (0, 0, 0, 1)), strict=True)
    position = Stage(
        tuple(x for x in q if x not in joints),
        tuple(k for k in range(16) if k not in turns),
        dict(bottom),
    )
    orientation = Stage(
        joints,
        turns,
        dict(zip(T[:3, :3], R * rotation_parametrisation(), strict=True)),
        sp.Matrix(sp.kronecker_product(R.T, sp.eye(3))),
        {v: f for angle, pair in pairs.items() for f, v in pair.instead_of(angle).items()},
    )
    forward = tuple(product([*arm, *wrist]))
    return Inverse("ik", tuple(q), tuple(T), forward, continua, stages=(position, orientation))
