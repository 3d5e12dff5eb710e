"""Joints of a serial arm that follow others: one motor moves several axes, as through a belt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp

from closedform.mechanics.entries import RowError
from closedform.mechanics.links import Group
from closedform.model.derivation import Derivation, Joint

FOLLOWED = (
    "  Where others follow a joint, its column is the sum of their twists and its own, each times "
    "how fast it moves."
)


@dataclass(frozen=True)
class Coupling:
    """The joints of all ``axes``, and the matrix ``rates``: how fast each moves by each motor."""

    axes: tuple[sp.Symbol, ...]
    rates: sp.Matrix


def require_driven(d: Derivation, joint: sp.Symbol, where: str) -> None:
    """Refuse a joint that is moved by others, unless it follows one by a constant factor."""
    (declared,) = (j for j in d.joints if j.symbol == joint)
    if joint in d.actuated:
        return
    leader = _leader(declared)
    if leader is None:
        raise RowError(
            f"{where}: {joint} is moved by other joints; a serial arm has a motor for each joint, "
            f"or a column of motors, or a joint that follows one other joint.  If a parallelogram "
            f"keeps the hand level, add the lengths from the wrist to the hand to those of the "
            f"turret, as docs/adding-a-mechanism.md says"
        )
    assert declared.coupling is not None
    factor, kinds = declared.coupling / leader, {j.symbol: j.kind for j in d.joints}
    if kinds.get(leader) != declared.kind or leader not in d.actuated:
        raise RowError(
            f"{where}: {joint} follows {leader}, which has to be a joint of the same kind with a "
            f"motor of its own; if one turns and the other slides, the inverse is not algebraic"
        )
    if declared.kind == "revolute" and not factor.is_Integer:
        raise RowError(
            f"{where}: {joint} turns by {factor} times {leader}, which is not a whole multiple; "
            f"let the joint that turns least lead the others"
        )


def _leader(joint: Joint) -> sp.Symbol | None:
    """The one joint that a joint follows by a rational factor; None if there is no such joint."""
    symbols = joint.coupling.free_symbols if joint.coupling is not None else set()
    if len(symbols) != 1:
        return None
    (leader,) = symbols
    factor = joint.coupling / leader
    return leader if factor.is_Rational and factor != 0 else None


def coupling_of(d: Derivation, axes: Sequence[sp.Symbol]) -> Coupling | None:
    """How the motors move the axes; None if each has a motor of its own."""
    motors = [q for q in axes if q in d.actuated]
    if len(motors) == len(axes):
        return None
    values = [d.couple(q) for q in axes]
    if missing := {s for e in values for s in e.free_symbols} - set(motors):
        first = min(missing, key=str)
        raise RowError(f"{d.name}: a joint follows {first}, which is not a joint of this arm")
    return Coupling(tuple(axes), sp.Matrix([[e.diff(q) for q in motors] for e in values]))


def coupled_groups(d: Derivation, groups: Sequence[Group]) -> tuple[Group, ...]:
    """Groups in which every joint that follows another is replaced by its multiple of that."""
    return tuple(
        Group(
            tuple(
                row._replace(turn=d.couple(row.turn), shift=tuple(map(d.couple, row.shift)))
                for row in group.rows
            ),
            group.end,
        )
        for group in groups
    )


__all__ = ["FOLLOWED", "Coupling", "coupled_groups", "coupling_of", "require_driven"]
