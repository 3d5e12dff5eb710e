"""The point at which an axis meets the one before it."""

from __future__ import annotations

import sympy as sp

from closedform.mechanics.arm import Group

Z = sp.Matrix([0, 0, 1])


def met(before: Group, after: Group) -> list[Group]:
    """The groups, with the origin of the second moved along its axis to the meeting point.

    A table of screws may name any point of an axis.
    """
    *others, last = before.rows
    direction, shift = before.end * Z, sp.Matrix(last.shift)
    across = direction[:2, 0]
    if shift[:2, 0].is_zero_matrix or across.is_zero_matrix:
        return [before, after]
    t = -sp.simplify(across.dot(shift[:2, 0]) / across.dot(across))
    moved = (shift + t * direction).applyfunc(sp.simplify)
    if not moved[:2, 0].is_zero_matrix:
        return [before, after]
    x, y, z = after.rows[0].shift
    first = after.rows[0]._replace(shift=(x, y, sp.simplify(z - t)))
    return [
        Group((*others, last._replace(shift=tuple(moved))), before.end),
        Group((first, *after.rows[1:]), after.end),
    ]
