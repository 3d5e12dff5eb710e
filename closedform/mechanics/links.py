"""The links of a serial chain: what each joint moves, and the joints by parallel axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import sympy as sp

from closedform.mechanics.frames import homogeneous, rotation


class Motion(NamedTuple):
    """A joint, whether it slides, and whether it moves along its z axis or against it."""

    joint: sp.Symbol
    slides: bool
    sense: int = 1


class Link(NamedTuple):
    """A motion about and along z, and the constant motion to the axis that follows."""

    motion: Motion
    theta: sp.Expr
    offset: sp.Expr
    after: sp.Matrix


class Row(NamedTuple):
    """The sign of an axis along z, its turn, the shift to the next axis, and whether it slides."""

    sign: int
    turn: sp.Expr
    shift: tuple[sp.Expr, ...]
    slides: bool


@dataclass(frozen=True)
class Group:
    """Consecutive joints with parallel axes, and the constant rotation that ends them.

    The angles of turns in one plane add up, so no product of two sines of one group ever occurs.
    """

    rows: tuple[Row, ...]
    end: sp.Matrix

    def angle(self, start: int, stop: int | None = None) -> sp.Expr:
        return sp.Add(*(row.turn for row in self.rows[start:stop]))

    def span(self, start: int, stop: int | None = None, turned: sp.Expr = sp.S.Zero) -> sp.Matrix:
        """From the axis ``start`` to the axis ``stop``, seen from a frame that is turned."""
        total = sp.zeros(3, 1)
        for i, row in list(enumerate(self.rows))[start:stop]:
            total += rotation("z", self.angle(start, i + 1) - turned) * sp.Matrix(row.shift)
        return total

    @property
    def rotation(self) -> sp.Matrix:
        return rotation("z", self.angle(0)) * self.end

    def transform(self) -> sp.Matrix:
        return homogeneous(self.rotation, tuple(self.span(0)))

    def twist(self, j: int) -> tuple[sp.Matrix, sp.Matrix]:
        """The axis ``j`` in the frame where the group starts: angular and linear part."""
        axis = sp.Matrix([0, 0, self.rows[j].sign])
        if self.rows[j].slides:
            return sp.zeros(3, 1), axis
        return axis, self.span(0, j).cross(axis)

    def twist_at_end(self, j: int) -> tuple[sp.Matrix, sp.Matrix]:
        """The axis ``j`` in the frame where the group ends."""
        axis, back = sp.Matrix([0, 0, self.rows[j].sign]), self.end.T
        if self.rows[j].slides:
            return sp.zeros(3, 1), back * axis
        return back * axis, back * axis.cross(self.span(j, None, self.angle(j)))


def groups_of(links: Sequence[Link], turned: sp.Matrix) -> list[Group]:
    """The links by parallel axes; the frame before the first is ``turned`` about its axis.

    A constant rotation that keeps the axis is added to the angle of the next joint; one that
    reverses the axis mirrors all later links.
    """
    groups: list[Group] = []
    current: list[Row] = []
    for i, (motion, theta, offset, after) in enumerate(links):
        sign = int(turned[2, 2])
        mirror = sp.diag(1, sign, sign)
        shift = mirror * (after[:3, 3] + sp.Matrix([0, 0, offset]))
        turn = _angle_of(turned) + sign * theta
        current.append(Row(sign * motion.sense, turn, tuple(shift), motion.slides))
        turned = mirror * after[:3, :3]
        if i == len(links) - 1 or not turned[:2, 2].is_zero_matrix:
            groups.append(Group(tuple(current), turned))
            current, turned = [], sp.eye(3)
    return groups


def _angle_of(turned: sp.Matrix) -> sp.Expr:
    """The angle by which a rotation about z turns the x axis; the rotation may also reverse z."""
    c, s = turned[0, 0], turned[1, 0]
    if isinstance(c, sp.cos):
        angle = c.args[0]
        for value in (angle, -angle):
            if s == sp.sin(value):
                return value
    return sp.atan2(s, c)


__all__ = ["Group", "Link", "Motion", "Row", "groups_of"]
