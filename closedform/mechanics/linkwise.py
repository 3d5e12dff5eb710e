"""The pose and the Jacobians of a serial chain, link by link.

A link is a :class:`~closedform.mechanics.links.Group`: joints with parallel axes, whose angles add.
Every product is named entry by entry in a :class:`~closedform.model.functions.Program`, so that no
chain is ever written out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.mechanics.frames import hat
from closedform.mechanics.links import Group
from closedform.model.functions import Program

Columns = dict[sp.Symbol, sp.Matrix]


@dataclass(frozen=True)
class Link:
    """A rigid motion from frame to frame, and the joints that move it: those of a group, or none.

    ``twists``, ``(v; omega)``, are in the frame where the link starts, ``twists_at_end`` in the
    frame where it ends.  ``spans`` lead from each axis to the end of the link, in the frame where
    it starts.
    """

    transform: sp.Matrix
    twists: Columns
    twists_at_end: Columns
    spans: Columns

    @property
    def rotation(self) -> sp.Matrix:
        return self.transform[:3, :3]


@dataclass(frozen=True)
class Named:
    """A matrix in the names of a program."""

    program: Program
    matrix: sp.Matrix

    @property
    def explicit(self) -> sp.Matrix:
        """The matrix written out, in joints and parameters."""
        return self.program.explicit(self.matrix)

    def part(self, rows: Sequence[int], columns: Sequence[int]) -> Named:
        """A part of the matrix, with the statements that define its names."""
        part = self.matrix.extract(list(rows), list(columns))
        return Named(self.program.needed_for(part), part)


def links_of(
    groups: Sequence[Group], joints: Sequence[sp.Symbol], lead: sp.Matrix, last: sp.Matrix
) -> list[Link]:
    """The links of a chain; a slide that starts a group is a link of its own."""
    remaining = iter(joints)
    links = [_moving(part, remaining) for group in groups for part in _split(group)]
    if lead != sp.eye(4):
        links.insert(0, Link(lead, {}, {}, {}))
    if last != sp.eye(4):
        links.append(Link(last, {}, {}, {}))
    return links


def _split(group: Group) -> list[Group]:
    first, *others = group.rows
    if others and first.slides and first.turn == 0:
        return [Group((first,), sp.eye(3)), *_split(Group(tuple(others), group.end))]
    return [group]


def _moving(group: Group, joints: Iterator[sp.Symbol]) -> Link:
    own = [next(joints) for _ in group.rows]
    twists, ends, spans = Columns(), Columns(), Columns()
    for j, joint in enumerate(own):
        for found, (w, v) in ((twists, group.twist(j)), (ends, group.twist_at_end(j))):
            found[joint] = sp.Matrix([*v, *w])
        spans[joint] = group.span(j, None, -group.angle(0, j))
    return Link(group.transform(), twists, ends, spans)


def pose(program: Program, links: Sequence[Link]) -> Named:
    """The transform of the whole chain, multiplied from the tool on, which is cheaper."""
    T = links[-1].transform
    for k in range(len(links) - 1, 0, -1):
        T = links[k - 1].transform * program.matrix(f"T{k}", T)
    return Named(program, T)


def _moved(link: Link, point: sp.Matrix) -> sp.Matrix:
    return sp.Matrix(link.rotation * point + link.transform[:3, 3])


def geometric_jacobian(
    program: Program, links: Sequence[Link], joints: Sequence[sp.Symbol]
) -> Named:
    """Velocity of the tool's origin over angular velocity, in base axes, per joint rate; 6xn."""
    point = sp.zeros(3, 1)

    def own(link: Link, k: int) -> Columns:
        nonlocal point
        columns = Columns()
        for x, twist in link.twists.items():
            v, w = sp.Matrix(twist[:3]), sp.Matrix(twist[3:])
            arm = link.rotation * point + link.spans[x]
            columns[x] = sp.Matrix([*(v if w.is_zero_matrix else w.cross(arm)), *w])
        point = program.matrix(f"p{k}", _moved(link, point))
        return columns

    def carry(link: Link, column: sp.Matrix) -> sp.Matrix:
        return sp.Matrix([*(link.rotation * column[:3, :]), *(link.rotation * column[3:, :])])

    return _columns(program, links[::-1], joints, own, carry)


def space_jacobian(program: Program, links: Sequence[Link], joints: Sequence[sp.Symbol]) -> Named:
    """Twist (v; omega) of the tool in the base frame, per joint rate; 6xn."""

    def carry(link: Link, column: sp.Matrix) -> sp.Matrix:
        v, w = link.rotation * column[:3, :], sp.Matrix(link.rotation * column[3:, :])
        return sp.Matrix([*(v + hat(link.transform[:3, 3]) * w), *w])

    return _columns(program, links[::-1], joints, lambda link, k: link.twists, carry)


def body_jacobian(program: Program, links: Sequence[Link], joints: Sequence[sp.Symbol]) -> Named:
    """Twist (v; omega) of the tool in its own frame, per joint rate; 6xn."""

    def carry(link: Link, column: sp.Matrix) -> sp.Matrix:
        v, w, back = sp.Matrix(column[:3, :]), sp.Matrix(column[3:, :]), link.rotation.T
        return sp.Matrix([*(back * (v + w.cross(link.transform[:3, 3]))), *(back * w)])

    return _columns(program, links, joints, lambda link, k: link.twists_at_end, carry)


def _columns(
    program: Program,
    links: Sequence[Link],
    joints: Sequence[sp.Symbol],
    own: Callable[[Link, int], Columns],
    carry: Callable[[Link, sp.Matrix], sp.Matrix],
) -> Named:
    """Each joint's column in the frame of its link, carried over the links that follow."""
    columns = Columns()
    for k, link in enumerate(links, 1):
        named = {x: program.matrix(f"J{k}_{x}", column) for x, column in columns.items()}
        columns = {x: carry(link, column) for x, column in named.items()}
        columns |= own(link, k)
    return Named(program, sp.Matrix.hstack(*(columns[x] for x in joints)))


__all__ = [
    "Link",
    "Named",
    "body_jacobian",
    "geometric_jacobian",
    "links_of",
    "pose",
    "space_jacobian",
]
