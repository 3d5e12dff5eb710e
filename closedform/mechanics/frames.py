"""Frames: Denavit-Hartenberg matrices, exponentials of twists, Jacobians.

Twists are ordered ``(v; omega)``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import cache, reduce
from itertools import combinations

import sympy as sp

from closedform.algebra.factoring import factored
from closedform.algebra.normal_form import normal
from closedform.algebra.operations import operations
from closedform.mechanics.merging import with_merged_angles
from closedform.model.functions import Program, real


def rotation(axis: str, angle: sp.Expr) -> sp.Matrix:
    """The 3x3 rotation about a coordinate axis ``"x"``, ``"y"`` or ``"z"``."""
    c, s = sp.cos(angle), sp.sin(angle)
    if axis == "x":
        return sp.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]])
    if axis == "y":
        return sp.Matrix([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    if axis == "z":
        return sp.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    raise ValueError(f"the axis must be x, y or z, not {axis!r}")


def homogeneous(R: sp.Matrix, p: Sequence[sp.Expr] = (0, 0, 0)) -> sp.Matrix:
    """The 4x4 transform of a rotation and a translation."""
    return sp.Matrix([[*R[i, :], p[i]] for i in range(3)] + [[0, 0, 0, 1]])


def require_rotation(program: Program, R: sp.Matrix) -> None:
    """Require that the input R is a proper rotation."""
    program.require(_rotation_residues(R), 1, "a proper rotation")


def pose_symbols() -> sp.Matrix:
    """A homogeneous transform as an input: 16 symbols, T11 to T44."""
    return sp.Matrix(4, 4, lambda i, j: real(f"T{i + 1}{j + 1}"))


def require_pose(program: Program, T: sp.Matrix) -> None:
    """Require that the input T is a homogeneous transform with a proper rotation."""
    bottom = [*T[3, :3], T[3, 3] - 1]
    program.require(
        [*_rotation_residues(T[:3, :3]), *bottom],
        1,
        "a homogeneous transform with a proper rotation",
    )


def _rotation_residues(R: sp.Matrix) -> list[sp.Expr]:
    """Expressions that vanish if the columns are orthonormal and right-handed."""
    n, o, a = (R[:, j] for j in range(3))
    return [*(n.cross(o) - a), n.dot(n) - 1, o.dot(o) - 1, n.dot(o)]


def denavit_hartenberg(
    a: sp.Expr, alpha: sp.Expr, d: sp.Expr, theta: sp.Expr, *, modified: bool = False
) -> sp.Matrix:
    """One row of a Denavit-Hartenberg table, as the product of its four motions.

    Standard (distal): ``Rz(theta) Tz(d) Tx(a) Rx(alpha)``.
    Modified (proximal, Craig): ``Rx(alpha) Tx(a) Rz(theta) Tz(d)``.
    """
    about_z = homogeneous(rotation("z", theta)) * homogeneous(sp.eye(3), (0, 0, d))
    about_x = homogeneous(sp.eye(3), (a, 0, 0)) * homogeneous(rotation("x", alpha))
    return about_x * about_z if modified else about_z * about_x


def chain(transforms: Iterable[sp.Matrix]) -> sp.Matrix:
    """The product of transforms, expanded, with the angles of parallel axes added."""
    return merge_angles(reduce(lambda A, B: (A * B).expand(), transforms))


def hat(w: sp.Matrix) -> sp.Matrix:
    """The skew matrix with ``hat(w) u = w x u``."""
    x, y, z = w
    return sp.Matrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def vee(W: sp.Matrix) -> sp.Matrix:
    """The vector of a skew matrix, the inverse of :func:`hat`."""
    return sp.Matrix([W[2, 1], W[0, 2], W[1, 0]])


def revolute_twist(w: sp.Matrix, q: sp.Matrix) -> sp.Matrix:
    """The twist ``(-w x q; w)`` of a rotation about the axis ``w`` through the point ``q``."""
    return sp.Matrix([*(-w.cross(q)), *w])


def prismatic_twist(v: sp.Matrix) -> sp.Matrix:
    """The twist ``(v; 0)`` of a translation along ``v``."""
    return sp.Matrix([*v, 0, 0, 0])


def exponential(twist: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """The rigid motion of a twist with a unit (or zero) rotation axis, by Rodrigues' formula."""
    v, w = sp.Matrix(twist[:3]), sp.Matrix(twist[3:])
    if w.is_zero_matrix:
        return homogeneous(sp.eye(3), tuple(v * angle))
    W = hat(w)
    R = sp.eye(3) + W * sp.sin(angle) + W * W * (1 - sp.cos(angle))
    p = (sp.eye(3) - R) * w.cross(v) + w * w.T * v * angle
    return homogeneous(R, tuple(p))


def adjoint(T: sp.Matrix) -> sp.Matrix:
    """The 6x6 map of twists under a change of frame, for the order ``(v; omega)``."""
    R, p = T[:3, :3], T[:3, 3]
    return sp.Matrix(sp.BlockMatrix([[R, hat(p) * R], [sp.zeros(3, 3), R]]))


def jacobian(task: sp.Matrix, joints: Sequence[sp.Symbol]) -> sp.Matrix:
    """The matrix of partial derivatives, with the angles of parallel axes added."""
    return merge_angles(sp.Matrix(task).jacobian(list(joints)))


def angular_velocity_matrix(R: sp.Matrix, joints: Sequence[sp.Symbol], frame: str) -> sp.Matrix:
    """The 3xn Jacobian of the angular velocity, in the ``"space"`` or the ``"body"`` frame.

    Column by column the vector of ``dR/dq R^T`` (space) or ``R^T dR/dq`` (body).
    """
    columns = []
    for q in joints:
        dR = R.diff(q)
        columns.append(vee(dR * R.T if frame == "space" else R.T * dR))
    return merge_angles(reduce_circle(sp.Matrix.hstack(*columns)))


def reduce_circle(value: sp.Matrix) -> sp.Matrix:
    """Rewrite even powers of sines and cosines by ``s^2 + c^2 = 1`` where the result is shorter."""
    return value.applyfunc(_shorter)


@cache
def _shorter(entry: sp.Expr) -> sp.Expr:
    return min((entry, normal(entry)), key=operations)


def simplest(value: sp.Matrix | sp.Expr) -> sp.Matrix | sp.Expr:
    """Reduced by ``s^2 + c^2 = 1``, with the angles of parallel axes added, then factored.

    Of these forms and the given one, the shortest is taken for each entry.
    """
    if isinstance(value, sp.MatrixBase):
        return value.applyfunc(simplest)
    reduced = merge_angles(normal(value))
    return min((value, reduced, factored(reduced)), key=operations)


def plane_angle(x: sp.Expr, y: sp.Expr) -> sp.Expr:
    """The angle of a unit vector of the plane: a sum of angles, if these turn the vector."""
    angles = sorted(x.free_symbols | y.free_symbols, key=str)
    turns = [normal(x * y.diff(angle) - y * x.diff(angle)) for angle in angles]
    if not all(turn.is_Integer for turn in turns):
        return sp.atan2(y, x)
    home = dict.fromkeys(angles, sp.S.Zero)
    found = sp.atan2(y.xreplace(home), x.xreplace(home))
    return sum((t * angle for t, angle in zip(turns, angles, strict=True)), found)


def frame_along(w: sp.Matrix) -> sp.Matrix:
    """A rotation whose z is the unit vector ``w``."""
    across = next(e for k in (0, 1) if (e := sp.eye(3)[:, k].cross(w)) != sp.zeros(3, 1))
    if w == sp.Matrix([0, 0, 1]):
        return sp.eye(3)
    if sum(e != 0 for e in across) == 1:  # without a root, as its size may depend on an angle
        across = across.applyfunc(lambda e: sp.sign(e) if e.is_number else sp.Integer(e != 0))
    length = sp.sqrt(multiplied_out(across.T * across)[0])
    if not length.is_Rational and all(e.is_Rational for e in w):
        return _rational_frame(w)
    x = multiplied_out(across / length)
    return sp.Matrix.hstack(x, multiplied_out(w.cross(x)), w)


def multiplied_out(constants: sp.Matrix) -> sp.Matrix:
    """Constants with the products of their roots multiplied out, and roots in no denominator.

    What has symbols, or no roots, is left as it is.
    """
    return constants.applyfunc(
        lambda e: sp.radsimp(sp.expand(e)) if e.is_number and not e.is_Rational else e
    )


def _rational_frame(w: sp.Matrix) -> sp.Matrix:
    """The least rotation from z to ``w``, or to ``-w`` after half a turn about x; without roots."""
    x, y, z = up = w if w[2] >= 0 else -w
    share = 1 / (1 + z)
    turned = sp.Matrix([[1 - share * x**2, -share * x * y], [-share * x * y, 1 - share * y**2]])
    turned = sp.Matrix.hstack(turned.col_join(sp.Matrix([[-x, -y]])), up)
    return turned if up == w else turned * sp.diag(1, -1, -1)


def inverse(T: sp.Matrix) -> sp.Matrix:
    """The inverse of a rigid motion."""
    R, p = T[:3, :3], T[:3, 3]
    return homogeneous(R.T, tuple(-R.T * p))


def twist_of(V: sp.Matrix) -> sp.Matrix:
    """The twist ``(v; omega)`` of a 4x4 matrix of se(3)."""
    return sp.Matrix([*V[:3, 3], *vee(V[:3, :3])])


def twist_matrix(twist: sp.Matrix) -> sp.Matrix:
    """The 4x4 matrix of a twist ``(v; omega)``, the inverse of :func:`twist_of`."""
    v, w = sp.Matrix(twist[:3]), sp.Matrix(twist[3:])
    return sp.Matrix.vstack(sp.Matrix.hstack(hat(w), v), sp.zeros(1, 4))


def determinant(J: sp.Matrix) -> sp.Expr:
    """The determinant of a Jacobian, factored, with the angles of parallel axes added."""
    reduced = normal(J.det(method="berkowitz"))
    return min(map(factored, (reduced, merge_angles(reduced))), key=operations)


def merge_angles(value: sp.Matrix | sp.Expr) -> sp.Matrix | sp.Expr:
    """Collect ``c_a c_b - s_a s_b`` into ``cos(a + b)`` and the like, wherever that shortens.

    Every pair of angles in the expression is tried; a rewriting is kept only if it leaves fewer
    terms, so that the result is the form a person would write.
    """
    if isinstance(value, sp.MatrixBase):
        return value.applyfunc(merge_angles)
    return _merged(sp.sympify(value, strict=True))


@cache
def _merged(value: sp.Expr) -> sp.Expr:
    best = sp.expand(value)
    if (found := with_merged_angles(best)) is not None:
        return found
    improved = True
    while improved:
        improved = False
        length = _terms(best)
        angles = sorted({f.args[0] for f in best.atoms(sp.sin, sp.cos)}, key=sp.default_sort_key)
        together = _angles_together(best)
        for a, b in combinations(angles, 2):
            if not any(a in met and b in met for met in together):
                continue
            merged = _merge_pair(best, a, b)
            if _terms(merged) < length:
                best, improved = merged, True
                break
    return best


def _angles_together(expr: sp.Expr) -> list[set[sp.Expr]]:
    """The angles of each term; only angles that meet in a product can be merged."""
    return [{f.args[0] for f in _functions(t)} for t in sp.Add.make_args(expr)]


def _merge_pair(expr: sp.Expr, a: sp.Expr, b: sp.Expr) -> sp.Expr:
    """Replace the products of ``a`` and ``b`` by functions of their sum or their difference."""
    ca, sa, cb, sb = sp.cos(a), sp.sin(a), sp.cos(b), sp.sin(b)
    candidates = [expr]
    for sign in (1, -1):
        C, S = sp.cos(a + sign * b), sp.sin(a + sign * b)
        for rewritten in (_replaced(expr, ca * cb, C + sign * sa * sb), expr):
            for second in ((sa * cb, S - sign * ca * sb), (ca * sb, sign * (S - sa * cb))):
                candidates.append(_replaced(rewritten, *second))
            candidates.append(rewritten)
    return min(dict.fromkeys(candidates), key=_terms)


def _replaced(expr: sp.Expr, product: sp.Expr, sum_: sp.Expr) -> sp.Expr:
    """An expanded expression with a product replaced, and expanded again where it occurred."""
    rest: list[sp.Expr] = []
    changed: list[sp.Expr] = []
    for term in sp.Add.make_args(expr):
        replaced = _replaced_in(term, product, sum_)
        (rest if replaced is term else changed).append(replaced)
    return sp.Add(*rest, *changed) if changed else expr


@cache
def _functions(term: sp.Expr) -> frozenset[sp.Expr]:
    """The sines and cosines in a term."""
    return frozenset(term.atoms(sp.sin, sp.cos))


def _replaced_in(term: sp.Expr, product: sp.Expr, sum_: sp.Expr) -> sp.Expr:
    """The same for a term; the term itself, if the product is not in it."""
    if not _functions(product) <= _functions(term):
        return term
    powers = dict.fromkeys(product.args, 0)
    others = []
    for factor in sp.Mul.make_args(term):
        base, exponent = factor.args if factor.is_Pow else (factor, sp.S.One)
        if base in powers and exponent.is_Integer and exponent.is_positive:
            powers[base] += int(exponent)
        else:
            others.append(factor)
    if any(other.has(*powers) for other in others):  # in a root or a denominator
        replaced = term.subs(product, sum_)
        return term if replaced == term else sp.expand(replaced)
    times = min(powers.values())
    if times == 0:
        return term
    left = sp.Mul(*others, *(base ** (n - times) for base, n in powers.items()))
    if times == 1:
        return sp.Add(*(left * part for part in sum_.args))
    return sp.expand(left * sum_**times)


def _terms(expr: sp.Expr) -> int:
    """The operations of an expression, and three more for each of its terms."""
    terms = sp.Add.make_args(expr)
    counted = [_operations(term) for term in terms]
    return sum(n for n, _ in counted) + 4 * len(terms) - 1 + all(minus for _, minus in counted)


@cache
def _operations(term: sp.Expr) -> tuple[int, bool]:
    """The operations of a term without its minus sign, and whether it has one."""
    coefficient, _ = term.as_coeff_Mul()
    minus = bool(coefficient.is_negative)
    return operations(-term if minus else term), minus
