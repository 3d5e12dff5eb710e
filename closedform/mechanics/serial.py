"""Serial arms, link by link: the pose and the Jacobians, derived, proved and exported.

A link is a 4x4 transform of one joint, or of several with parallel axes, multiplied by
:func:`closedform.mechanics.frames.chain` so that their angles add.  Every product is named entry by
entry in a :class:`~closedform.model.functions.Program`, so that no chain is ever written out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import reduce

import sympy as sp

from closedform.mechanics.frames import hat, inverse, simplest, twist_of, vee
from closedform.model.derivation import Derivation
from closedform.model.functions import Program, real

Links = Sequence[sp.Matrix]
Joints = Sequence[sp.Symbol]


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


def export_pose(d: Derivation, links: Links, reason: str) -> sp.Matrix:
    """The step and the functions ``fk`` and ``pose`` of an arm; returns the pose, written out."""
    program = Program()
    named = named_pose(program, links)
    pose = product(links)
    d.step(
        "Pose",
        f"{reason}  The pose is the product of the transforms of the links.",
        {f"T_{k}": A for k, A in enumerate(links, 1)},
        equal=[(pose, program.explicit(named))],
    )
    inputs = {"q": d.actuated}
    d.function("fk", "Pose of the hand in the base frame.", inputs, {"T": named}, program=program)
    d.function("pose", "The same as fk.", inputs, {"T": named}, program=program)
    return pose


def export_jacobians(d: Derivation, links: Links) -> sp.Matrix:
    """The step and the functions of the Jacobians of an arm; returns the geometric one."""
    q, pose = d.actuated, product(links)
    programs = {name: Program() for name in ("jacobian", "jacobian_space", "jacobian_body")}
    makers = (geometric_jacobian, space_jacobian, body_jacobian)
    named = [make(p, links, q) for make, p in zip(makers, programs.values(), strict=True)]
    J, space, body = (p.explicit(m) for p, m in zip(programs.values(), named, strict=True))
    R, v, w = pose[:3, :3], J[:3, :], J[3:, :]
    rates = [vee(R.diff(x) * R.T) for x in q]
    d.step(
        "Jacobians",
        "The geometric Jacobian is the velocity of the origin of the hand frame over the angular "
        "velocity, in the axes of the base.  The spatial and the body Jacobian are the twists "
        "(v; omega) of the hand frame in the base frame and in its own.",
        {"v": v, r"\omega": w},
        equal=[
            (v, sp.Matrix(pose[:3, 3]).jacobian(list(q))),
            (w, sp.Matrix.hstack(*rates)),
            (space, sp.Matrix.vstack(v + hat(pose[:3, 3]) * w, w)),
            (sp.Matrix.vstack(R * body[:3, :], R * body[3:, :]), J),
        ],
    )
    summaries = (
        "Velocity of the hand's origin over its angular velocity, in base axes, per joint rate.",
        "Twist (v; omega) of the hand in the base frame per joint rate.",
        "Twist (v; omega) of the hand in its own frame per joint rate.",
    )
    for (name, program), matrix, summary in zip(programs.items(), named, summaries, strict=True):
        notes = ("The geometric Jacobian, in the order (v; omega).",) if name == "jacobian" else ()
        d.function(name, summary, {"q": q}, {"J": matrix}, program=program, notes=notes)
    return J
