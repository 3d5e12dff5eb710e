"""Joints of a file that are held: each becomes a parameter, an input of all printed functions.

Without it many machines have more joints than their tool has motions: booms of concrete pumps,
cranes whose jib slides out, arms on a lift.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import sympy as sp

from closedform.algebra.formulas import FormulaError, number
from closedform.mechanics.frames import exponential, homogeneous
from closedform.model.functions import real
from closedform.scaffold.inputs.exact import orthonormal
from closedform.scaffold.inputs.joints import MOVING, Joint
from closedform.scaffold.inputs.names import symbol_of
from closedform.scaffold.inputs.tables import Table, TableError, shown_name


def held(chain: Sequence[Joint], values: Mapping[str, str], table: Table, file: str) -> list[Joint]:
    """The chain with fixed joints for those that have ``values``, which are numbers as text."""
    names = {joint.name for joint in chain if joint.kind in MOVING}
    if missing := [name for name in values if name not in names]:
        raise TableError(
            f"{file}: --hold {shown_name(missing[0])}: the chain has no such joint that moves; its "
            f"joints are {', '.join(sorted(map(shown_name, names)))}"
        )
    return [_held(joint, values, table, file) for joint in chain]


def _held(joint: Joint, values: Mapping[str, str], table: Table, file: str) -> Joint:
    where = f"{file}, joint {shown_name(joint.name)}"
    if joint.mimics in values:
        raise TableError(f"{where}: it mimics {shown_name(joint.mimics)}; hold both, or neither")
    if joint.name not in values:
        return joint
    if joint.mimics:
        joint = replace(joint, mimics="")
    try:
        number(values[joint.name])
    except FormulaError as error:
        raise TableError(f"{where}: --hold: {error}") from error
    if not orthonormal(joint.axis):
        raise TableError(
            f"{where}: its axis is not a unit vector in exact numbers, so that it cannot be held; "
            f"write it along a coordinate, and turn its origin by rpy"
        )
    name, slides = symbol_of(joint.name), MOVING[joint.kind] == "prismatic"
    if name in table.parameters:
        raise TableError(f"{where}: two joints have the name {name}")
    unit = "m" if slides else "rad"
    table.parameters[name] = {
        "value": values[joint.name],
        "unit": unit,
        "meaning": f"the joint {shown_name(joint.name)}, which is held",
        "signed": "yes",
    }
    table.notes.append(
        f"{where}: it is held; the parameter {name}, an input of all printed functions, is "
        f"{values[joint.name]} {unit} by default"
    )
    moved = (
        homogeneous(sp.eye(3), tuple(real(name) * joint.axis))
        if slides
        else exponential(sp.Matrix([0, 0, 0, *joint.axis]), real(name))
    )
    return replace(joint, kind="fixed", origin=joint.origin * moved, limits=None)


__all__ = ["held"]
