"""The twist of a joint of a chain, as it is seen from other places along the chain."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from closedform.algebra.expansion import Expansion, Rows
from closedform.mechanics.frames import reduce_circle
from closedform.mechanics.links import Group


class Places:
    """The frames along a chain: ``lead``, the groups of joints with parallel axes, ``last``."""

    def __init__(self, groups: Sequence[Group], lead: sp.Matrix, last: sp.Matrix):
        self.groups, whole = groups, [lead, *(g.transform() for g in groups), last]
        starts = [g.twist(j) for g in groups for j in range(len(g.rows))]
        ends = [g.twist_at_end(j) for g in groups for j in range(len(g.rows))]
        spans = [g.span(0, j) for g in groups for j in range(len(g.rows))]
        self._in = Expansion([*whole, *(part for twist in starts + ends for part in twist), *spans])
        self._whole = [self._in.read(T) for T in whole]
        self._turns = [self._in.read(T[:3, :3]) for T in whole]
        self._back = [self._in.read(T[:3, :3].T) for T in whole]
        self._shifts = [self._in.read(T[:3, 3]) for T in whole]

    def pose(self) -> sp.Matrix:
        """The frame at the end."""
        T, *others = self._whole
        for step in others:
            T = self._in.times(T, step)
        return reduce_circle(self._in.written(T))

    def at_base(self, k: int, j: int) -> sp.Matrix:
        """The twist of axis ``j`` of group ``k`` in the base frame."""
        return self._before(k, j, 0)

    def at_end(self, k: int, j: int) -> sp.Matrix:
        """The same in the frame at the end."""
        return self._after(k, j, len(self.groups) + 1)

    def seen_from(self, k: int, j: int, cut: int) -> sp.Matrix:
        """The same where group ``cut`` starts, before or after it."""
        return self._after(k, j, cut) if k < cut else self._before(k, j, cut + 1)

    def at_tool(self, k: int, j: int) -> sp.Matrix:
        """The velocity that an axis gives to the tool, and the axis, in base axes."""
        ring, group = self._in, self.groups[k]
        tool = self._shifts[-1]
        for i in range(len(self.groups), k, -1):
            tool = ring.plus(ring.times(self._turns[i], tool), self._shifts[i])
        w = v = ring.read(sp.Matrix([0, 0, group.rows[j].sign]))
        if group.rows[j].slides:
            w = ring.read(sp.zeros(3, 1))
        else:
            v = ring.cross(w, ring.plus(tool, ring.read(group.span(0, j)), -1))
        for R in reversed(self._turns[: k + 1]):
            w, v = ring.times(R, w), ring.times(R, v)
        return self._written(w, v)

    def _before(self, k: int, j: int, cut: int) -> sp.Matrix:
        """The twist in a frame before the group."""
        ring = self._in
        w, v = map(ring.read, self.groups[k].twist(j))
        for R, p in reversed([*zip(self._turns, self._shifts, strict=True)][cut : k + 1]):
            w, v = ring.times(R, w), ring.times(R, v)
            v = ring.plus(v, ring.cross(p, w))
        return self._written(w, v)

    def _after(self, k: int, j: int, cut: int) -> sp.Matrix:
        """The twist in a frame after the group."""
        ring = self._in
        w, v = map(ring.read, self.groups[k].twist_at_end(j))
        for i in range(k + 2, cut + 1):
            v = ring.plus(v, ring.cross(w, self._shifts[i]))
            w, v = ring.times(self._back[i], w), ring.times(self._back[i], v)
        return self._written(w, v)

    def _written(self, w: Rows, v: Rows) -> sp.Matrix:
        return reduce_circle(self._in.written([*v, *w]))


__all__ = ["Places"]
