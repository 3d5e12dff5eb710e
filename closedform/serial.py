"""Serial arms, link by link: pose, Jacobians, and arms that end in a spherical wrist.

A link is a 4x4 transform of one joint, or of several with parallel axes, multiplied by
:func:`closedform.frames.chain` so that their angles add.  Every product is named entry by entry in
a :class:`~closedform.functions.Program`, so that no chain is ever written out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import reduce

import sympy as sp

from closedform.derivation import Continuum, Inverse, Stage
from closedform.frames import hat, inverse, simplest, twist_of, vee
from closedform.functions import Program, real
from closedform.lemmas import Lemma, zyz_angles
from closedform.pairs import Pair
from closedform.solutions import rotation_parametrisation

Links = Sequence[sp.Matrix]
Joints = Sequence[sp.Symbol]

_ROUNDINGS = 16
"""How much rounding an arm puts on the rotation it leaves to its wrist, in units of that of the
target.  A wrist within it counts as aligned, which turns the hand by 3e-14 at most; 98 of 100
random postures whose wrist is aligned exactly are seen as such, of the others the angles that come
back are right as well."""


def product(links: Links) -> sp.Matrix:
    """The transform of the whole chain, not simplified."""
    return reduce(lambda A, B: A * B, links)


def named_pose(program: Program, links: Links) -> sp.Matrix:
    """The transform of the whole chain, from the hand to the base, which is the cheaper way."""
    T = links[-1]
    for k in range(len(links) - 1, 0, -1):
        T = links[k - 1] * program.matrix(f"T{k}", T)
    return T


def geometric_jacobian(program: Program, links: Links, q: Joints) -> sp.Matrix:
    """Velocity of the last origin over angular velocity, in base axes, per joint rate; 6xn."""
    point = [sp.zeros(3, 1)]

    def own(A: sp.Matrix, x: sp.Symbol) -> sp.Matrix:
        dA = A.diff(x)
        turn = simplest(vee(dA[:3, :3] * A[:3, :3].T))
        return sp.Matrix([*(dA[:3, :3] * point[0] + dA[:3, 3]), *turn])

    def carry(A: sp.Matrix, column: sp.Matrix) -> sp.Matrix:
        R = A[:3, :3]
        return sp.Matrix([*(R * column[:3, :]), *(R * column[3:, :])])

    def after(A: sp.Matrix, k: int) -> None:
        point[0] = program.matrix(f"p{k}", A[:3, :3] * point[0] + A[:3, 3])

    return _columns(program, list(links)[::-1], q, own, carry, after)


def space_jacobian(program: Program, links: Links, q: Joints) -> sp.Matrix:
    """Twist (v; omega) of the last frame in the base frame, per joint rate; 6xn."""

    def own(A: sp.Matrix, x: sp.Symbol) -> sp.Matrix:
        return simplest(twist_of(A.diff(x) * inverse(A)))

    def carry(A: sp.Matrix, column: sp.Matrix) -> sp.Matrix:
        R, turned = A[:3, :3], A[:3, :3] * column[3:, :]
        turned = sp.Matrix(turned)
        return sp.Matrix([*(R * column[:3, :] + hat(A[:3, 3]) * turned), *turned])

    return _columns(program, list(links)[::-1], q, own, carry)


def body_jacobian(program: Program, links: Links, q: Joints) -> sp.Matrix:
    """Twist (v; omega) of the last frame in its own axes, per joint rate; 6xn."""

    def own(A: sp.Matrix, x: sp.Symbol) -> sp.Matrix:
        return simplest(twist_of(inverse(A) * A.diff(x)))

    def carry(A: sp.Matrix, column: sp.Matrix) -> sp.Matrix:
        R, v, w = A[:3, :3], sp.Matrix(column[:3, :]), sp.Matrix(column[3:, :])
        return sp.Matrix([*(R.T * (v + w.cross(A[:3, 3]))), *(R.T * w)])

    return _columns(program, links, q, own, carry)


def _columns(
    program: Program,
    links: Links,
    q: Joints,
    own: Callable[[sp.Matrix, sp.Symbol], sp.Matrix],
    carry: Callable[[sp.Matrix, sp.Matrix], sp.Matrix],
    after: Callable[[sp.Matrix, int], None] = lambda A, k: None,
) -> sp.Matrix:
    """Each joint's column in the frame of its link, carried over the links that follow."""
    columns: dict[sp.Symbol, sp.Matrix] = {}
    for k, A in enumerate(links, 1):
        named = {x: program.matrix(f"J{k}_{x}", c) for x, c in columns.items()}
        columns = {x: carry(A, c) for x, c in named.items()}
        columns |= {x: own(A, x) for x in q if A.has(x)}
        after(A, k)
    return sp.Matrix.hstack(*(columns[x] for x in q))


def given_transform(program: Program) -> sp.Matrix:
    """A 4x4 input ``T``, which must be a homogeneous transform with a proper rotation."""
    T = sp.Matrix(4, 4, lambda i, j: real(f"T{i + 1}{j + 1}"))
    n, o, a = (T[:3, j] for j in range(3))
    program.require(
        [
            *(n.cross(o) - a),
            n.dot(n) - 1,
            o.dot(o) - 1,
            n.dot(o),
            *T[3, :3],
            T[3, 3] - 1,
        ],
        1,
        "a homogeneous transform with a proper rotation",
    )
    return T


def wrist_angles(
    program: Program,
    T: sp.Matrix,
    turned: Sequence[tuple[sp.Matrix, Mapping[sp.Expr, Pair]]],
    joints: tuple[sp.Symbol, sp.Symbol, sp.Symbol],
    sigma: sp.Symbol,
    turn: int,
) -> Lemma:
    """The spherical wrist that turns the hand from where the arm has left it into the pose T.

    ``turned`` lists the links of the arm with the pairs of their angles.  The wrist is
    ``Rz Ry(turn * middle) Rz``: a twist of +90 degrees before the middle joint makes ``turn`` -1.
    """
    R = T[:3, :3]
    for k, (A, pairs) in enumerate(turned, 1):
        known = {f: v for angle, pair in pairs.items() for f, v in pair.instead_of(angle).items()}
        R = program.matrix(f"R{k}", A[:3, :3].xreplace(known).T * R)
    return zyz_angles(program, R, *joints, sigma, turn=turn, scale=_ROUNDINGS)


def wrist_partitioned(
    function: str,
    T: sp.Matrix,
    arm: Links,
    wrist: Links,
    q: Joints,
    pairs: Mapping[sp.Expr, Pair],
    continua: Sequence[Continuum] = (),
) -> Inverse:
    """What the inverse of an arm with a spherical wrist must satisfy: position, then rotation.

    The wrist has its centre at the end of ``arm`` and no offset.  ``pairs`` are handed on from the
    position to the rotation.  ``continua`` of the wrist may be made by :func:`aligned`.
    """
    forward = product([*arm, *wrist])
    R = product(arm)[:3, :3]
    place = {e: k for k, e in enumerate(T)}
    rotation = [place[e] for e in T[:3, :3]]
    position = [k for k in range(16) if k not in rotation]
    bottom = dict(zip(T[3, :], (0, 0, 0, 1), strict=True))
    given = dict(zip(T[:3, :3], R * rotation_parametrisation(), strict=True))
    moved = [x for x in q if any(A.has(x) for A in arm)]
    carried = {v: f for angle, pair in pairs.items() for f, v in pair.instead_of(angle).items()}
    return Inverse(
        function,
        tuple(q),
        tuple(T),
        tuple(forward),
        tuple(continua),
        stages=(
            Stage(tuple(moved), tuple(position), {k: sp.sympify(v) for k, v in bottom.items()}),
            Stage(
                tuple(x for x in q if x not in moved),
                tuple(rotation),
                given,
                sp.Matrix(sp.kronecker_product(R.T, sp.eye(3))),
                carried,
            ),
        ),
    )
