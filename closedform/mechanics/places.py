"""The twist of a joint of a chain, as it is seen from other places along the chain."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.mechanics.frames import reduce_circle
from closedform.mechanics.links import Group


def to_base(w: sp.Matrix, v: sp.Matrix, groups: Sequence[Group], lead: sp.Matrix) -> sp.Matrix:
    """A twist in the frame where the ``groups`` end, in the base frame."""
    for T in [*(group.transform() for group in reversed(groups)), lead]:
        w, v = T[:3, :3] * w, T[:3, :3] * v
        v = (v + T[:3, 3].cross(w)).applyfunc(sp.expand)
    return reduce_circle(sp.Matrix([*v, *w]).applyfunc(sp.expand))


def to_frame(k: int, j: int, groups: Sequence[Group], cut: int, last: sp.Matrix) -> sp.Matrix:
    """The axis ``j`` of group ``k`` where group ``cut`` starts, seen from the frame ``last``."""
    w, v = groups[k].twist_at_end(j)
    for group in groups[k + 1 : cut]:
        back = group.rotation.T
        w, v = back * w, back * (v + w.cross(group.span(0))).applyfunc(sp.expand)
        w, v = w.applyfunc(sp.expand), v.applyfunc(sp.expand)
    w, v = last[:3, :3].T * w, last[:3, :3].T * (v + w.cross(last[:3, 3]))
    return reduce_circle(sp.Matrix([*v, *w]).applyfunc(sp.expand))


def at_tool(k: int, j: int, groups: Sequence[Group], lead: sp.Matrix, last: sp.Matrix) -> sp.Matrix:
    """The velocity that an axis gives to the tool, and the axis, in base axes."""
    tool = last[:3, 3]
    for group in reversed(groups[k + 1 :]):
        tool = (group.rotation * tool + group.span(0)).applyfunc(sp.expand)
    group = groups[k]
    axis = sp.Matrix([0, 0, group.rows[j].sign])
    w, v = axis, axis.cross(group.rotation * tool + group.span(0) - group.span(0, j))
    if group.rows[j].slides:
        w, v = sp.zeros(3, 1), axis
    for R in [*(g.rotation for g in reversed(groups[:k])), lead[:3, :3]]:
        w, v = (R * w).applyfunc(sp.expand), (R * v).applyfunc(sp.expand)
    return reduce_circle(sp.Matrix([*v, *w]).applyfunc(sp.expand))


def seen_from(k: int, j: int, groups: Sequence[Group], cut: int) -> sp.Matrix:
    """The axis ``j`` of group ``k`` where group ``cut`` starts, before or after it."""
    if k < cut:
        return to_frame(k, j, groups, cut, sp.eye(4))
    return to_base(*groups[k].twist(j), groups[cut:k], sp.eye(4))


__all__ = ["at_tool", "seen_from", "to_base", "to_frame"]
