"""Rotations in general: sequences of Euler angles, and other representations."""

from collections.abc import Callable
from functools import cache, partial
from itertools import combinations, product

import sympy as sp
from sympy import atan2, pi, sqrt

from closedform import Check, Identity, Under, equal, exponential, real, rotation

SEQUENCES = ["".join(axes) for axes in product("xyz", repeat=3)]
AXES = {name: sp.eye(3)[:, i] for i, name in enumerate("xyz")}
TURNS = (real("turn1"), real("turn2"), real("turn3"))


def about(axis: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """The rotation about a unit vector, by Rodrigues' formula."""
    return exponential(sp.Matrix([0, 0, 0, *axis]), angle)[:3, :3]


def euler(axes: str, angles: tuple[sp.Expr, ...]) -> sp.Matrix:
    """Rotations about axes of the moving frame."""
    return sp.prod(rotation(axis, angle) for axis, angle in zip(axes, angles, strict=True))


def moving(angles: tuple[sp.Expr, ...]) -> sp.Matrix:
    """ZYZ, each turn about an axis where the turns before have left it."""
    turned = sp.eye(3)
    for axis, angle in zip("zyz", angles, strict=True):
        turned = about(turned * AXES[axis], angle) * turned
    return turned


def fixed(angles: tuple[sp.Expr, ...]) -> sp.Matrix:
    """ZYZ, each turn about an axis of the frame at rest."""
    turned = sp.eye(3)
    for axis, angle in zip("zyz", angles, strict=True):
        turned = about(AXES[axis], angle) * turned
    return turned


@cache
def independent_sequences() -> tuple[str, ...]:
    """The sequences of axes with independent angular velocities for some middle angle."""
    middle = TURNS[1]
    rates = (
        sp.Matrix.hstack(AXES[i], AXES[j], rotation(j, middle) * AXES[k]) for i, j, k in SEQUENCES
    )
    return tuple(s for s, J in zip(SEQUENCES, rates, strict=True) if not equal(J.det(), 0))


def pairs_alike() -> int:
    """How many pairs of these sequences give the same matrix for the same angles."""
    matrices = [euler(axes, TURNS) for axes in independent_sequences()]
    return sum((A - B).is_zero_matrix is True for A, B in combinations(matrices, 2))


def degrees_of_freedom() -> int:
    """The dimension of the velocities W of a rotation: matrices with W + W^T = 0."""
    W = sp.Matrix(3, 3, lambda i, j: real(f"w{i}{j}"))
    return 9 - sp.Matrix([*(W + W.T)]).jacobian(list(W)).rank()


def as_zyz() -> Check:
    """Each of the twelve sequences is ZYZ between constant rotations.

    C takes z and y to the first two axes, and a turn by ``shift`` about y takes z to the third.
    """
    left, right = [], []
    first_turn, second_turn, third_turn = TURNS
    for axes in independent_sequences():
        first, second, third = (AXES[axis] for axis in axes)
        C = sp.Matrix.hstack(second.cross(first), second, first)
        local = C.T * third
        shift = atan2(local[0], local[2])
        left += list(euler(axes, TURNS))
        zyz = euler("zyz", (first_turn, second_turn + shift, third_turn))
        right += list(C * zyz * rotation("y", -shift) * C.T)
    return Identity(left, right)


def representation(kind: str, angles: tuple[sp.Expr, ...]) -> Check:
    """Whether the rotation by three ZYZ angles can be written in a representation."""
    R = euler("zyz", angles)
    q = sp.prod(
        sp.Quaternion.from_axis_angle(axis, angle)
        for axis, angle in zip(((0, 0, 1), (0, 1, 0), (0, 0, 1)), angles, strict=True)
    )
    w, v = q.a, sp.Matrix([q.b, q.c, q.d])
    size = sqrt(v.dot(v))
    if kind == "orthonormal matrices":
        return Identity([*(R * R.T), *R[:, 0].cross(R[:, 1])], [*sp.eye(3), *R[:, 2]])
    if kind == "Gibbs vector":
        return Under(Identity(cayley(v / w), R), "except for half turns, where it is infinite")
    built: dict[str, Callable[[], sp.Matrix]] = {
        "Euler angles": partial(euler, "zyz", angles),
        "two Euler angles": partial(euler, "zy", angles[:2]),
        "unit vector": partial(cayley, v / size),
        "Cayley-Klein parameters": partial(spin_rotation, w, *v),
        "real Cayley-Klein parameters": partial(spin_rotation, w, sp.S.Zero, v[1], sp.S.Zero),
        "Pauli spin matrices": partial(spin_rotation, w, *v),
        "two Pauli spin matrices": partial(spin_rotation, w, *v[:2], sp.S.Zero),
        "axis and angle": lambda: about(v / size, 2 * atan2(size, w)),
        "axis": lambda: about(v / size, pi),
        "symmetric matrices": lambda: R.T,
        "Hamilton's quaternions": partial(turned_axes, q),
        "pure quaternions": partial(turned_axes, sp.Quaternion(0, *v)),
    }
    return Identity(built[kind](), R)


def cayley(g: sp.Matrix) -> sp.Matrix:
    """The rotation of a Gibbs vector, by Cayley's formula."""
    G = sp.Matrix([[0, -g[2], g[1]], [g[2], 0, -g[0]], [-g[1], g[0], 0]])
    return sp.eye(3) + 2 * (G + G * G) / (1 + g.dot(g))


def spin_rotation(k0: sp.Expr, k1: sp.Expr, k2: sp.Expr, k3: sp.Expr) -> sp.Matrix:
    """R with ``U (p . sigma) U^+ = (R p) . sigma``, for the Cayley-Klein matrix U."""
    i = sp.I
    x, y, z = sp.Matrix([[0, 1], [1, 0]]), sp.Matrix([[0, -i], [i, 0]]), sp.diag(1, -1)
    spins = sp.symbols("k0:4", real=True)
    U = spins[0] * sp.eye(2) - i * (spins[1] * x + spins[2] * y + spins[3] * z)
    traces = [[sp.expand((to * U * of * U.H).trace()) / 2 for of in (x, y, z)] for to in (x, y, z)]
    return sp.Matrix(traces).subs(dict(zip(spins, (k0, k1, k2, k3), strict=True)))


def turned_axes(q: sp.Quaternion) -> sp.Matrix:
    """The images of the coordinate axes under a quaternion, as columns."""
    turned = [q * sp.Quaternion(0, *axis) * sp.conjugate(q) for axis in sp.eye(3).tolist()]
    return sp.Matrix([[t.b, t.c, t.d] for t in turned]).T
