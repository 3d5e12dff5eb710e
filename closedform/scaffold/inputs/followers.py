"""Joints of a table that one motor moves together, as a belt or a rope does.

Of joints that turn, those that turn more follow the one that turns least.  Slides in one direction,
as the stages of a telescope, become one joint: what they move together.
"""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from closedform.model.functions import real
from closedform.model.names import listed
from closedform.scaffold.inputs.tables import Table, TableError


def follow(table: Table, where: str) -> None:
    """Find the joints of one motor among those with ``couplings``, and let them follow one.

    Raises :class:`TableError` if they cannot.
    """
    sets = _sets(table)
    for together in sets:
        if table.joints[together[0]] == "revolute":
            _turn_together(table, together, where)
        else:
            _slide_together(table, together, where)
    own = list(table.couplings.values())
    if sets and all(e.is_Symbol for e in own) and len({*own}) == len(own):
        table.couplings.clear()  # each joint that is left has a motor of its own


def declared(table: Table) -> Iterator[tuple[str, str, sp.Expr | None]]:
    """The joints with their kinds, and of those that follow another, which come last, by what."""
    for joint, kind in table.joints.items():
        if joint not in table.followers:
            yield joint, kind, None
    for joint, (leader, factor) in table.followers.items():
        yield joint, table.joints[joint], factor * real(leader)


def _sets(table: Table) -> list[list[str]]:
    """The joints of one kind whose couplings are multiples of each other, two or more."""
    found: list[list[str]] = []
    for joint in table.couplings:
        for others in found:
            alike = table.joints[others[0]] == table.joints[joint]
            if alike and _ratio(table, joint, others[0]).is_Rational:
                others.append(joint)
                break
        else:
            found.append([joint])
    return [joints for joints in found if len(joints) > 1]


def _ratio(table: Table, joint: str, other: str) -> sp.Expr:
    return sp.simplify(table.couplings[joint] / table.couplings[other])


def _turn_together(table: Table, joints: list[str], where: str) -> None:
    for leader in sorted(joints, key=lambda joint: abs(_ratio(table, joint, joints[0]))):
        ratios = {q: _ratio(table, q, leader) for q in joints if q != leader}
        if all(ratio.is_Integer for ratio in ratios.values()):
            break
    else:
        driven = listed([f"{q} by {table.couplings[q]}" for q in joints])
        raise TableError(
            f"{where}: one motor turns {driven}, and none of them turns by a whole multiple of "
            f"another that all are multiples of, so that the angles of the joints do not determine "
            f"that of the motor"
        )
    for joint, ratio in ratios.items():
        table.followers[joint] = leader, ratio
        table.notes.append(
            f"{where}: {joint} follows {leader}, as {joint} = {ratio * real(leader)}"
        )
        del table.couplings[joint]


def _slide_together(table: Table, joints: list[str], where: str) -> None:
    leader, *others = joints
    total = sp.S.One
    for joint in others:
        sense = (_sense_of_rows if table.rows else _sense_of_axes)(table, leader, joint)
        if sense == 0:
            raise TableError(
                f"{where}: one motor moves {leader} and {joint}, and they slide along two lines; "
                f"slides of one motor are read if they have one direction, as in a telescope"
            )
        total += sense * _ratio(table, joint, leader)
    if total == 0:
        raise TableError(
            f"{where}: one motor moves {listed(joints)}, and together they do not move anything; "
            f"check their signs"
        )
    table.couplings[leader] = sp.expand(total * table.couplings[leader])
    for joint in others:
        del table.couplings[joint], table.joints[joint]
        held = {real(joint): sp.S.Zero}
        table.rows = [tuple(e.xreplace(held) for e in row) for row in table.rows]
        table.axes = [axis for axis in table.axes if axis[0] != real(joint)]
    table.notes.append(
        f"{where}: {listed(joints)} slide in one direction, and {leader} is what they move "
        f"together; this is {table.couplings[leader]} in those of the motors"
    )


def _sense_of_rows(table: Table, one: str, other: str) -> int:
    """1 or -1 if a later slide moves the arm along the line of an earlier one; else 0."""
    first, last = (
        next(k for k, row in enumerate(table.rows) if row[2].has(real(joint)))
        for joint in (one, other)
    )
    sense = sp.diff(table.rows[first][2], real(one)) * sp.diff(table.rows[last][2], real(other))
    shift = 1 if table.modified else 0
    for row in table.rows[first + shift : last + shift]:
        along = sp.cos(row[1])
        if along not in (1, -1):
            return 0
        sense *= along
    return int(sense)


def _sense_of_axes(table: Table, one: str, other: str) -> int:
    names = [joint.free_symbols & {*map(real, table.joints)} for joint, *_ in table.axes]
    first, last = (names.index({real(joint)}) for joint in (one, other))
    direction = sp.Matrix(table.axes[first][1])
    for (_, w, _), name in list(zip(table.axes, names, strict=True))[first + 1 : last + 1]:
        (joint,) = map(str, name)
        turns = table.joints[joint] == "revolute"
        across = direction.cross(sp.Matrix(w)).applyfunc(sp.simplify)
        if (turns or joint == other) and not across.is_zero_matrix:
            return 0
    return int(sp.sign(sp.simplify(direction.dot(sp.Matrix(table.axes[last][1])))))


__all__ = ["declared", "follow"]
