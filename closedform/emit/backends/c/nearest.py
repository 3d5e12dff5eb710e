"""The header for the posture nearest to a seed: what the shared code needs of a robot."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from closedform.emit.backends.c.kernel import CArray, c_array
from closedform.emit.backends.c.robot import CFunction
from closedform.model.derivation import Derivation

ANGLES = ("yaw", "pitch", "roll", "psi", "phi", "theta")
"""Task coordinates that count modulo a turn."""


@dataclass(frozen=True)
class CNearest:
    """Sizes and calls of one robot.

    ``target`` is the argument of its inverse, and ``given`` the one beside it, if any.  The shared
    code sees both as one array of ``task`` numbers.
    """

    target: str
    target_size: int
    given: str
    given_at: str
    """The statement that writes its value at a posture."""
    held: int
    """The index of the joint that is given; the number of joints if none is."""
    joints: int
    branches: int
    task: int
    modes: int
    rows: int
    jacobian: str
    jacobian_rows: int
    jacobian_size: int
    """The entries of that function, before the row of what is given."""
    determinant: str
    """The name of a function for it, or NULL."""
    lengths: int
    """The power of a length in the determinant."""
    fields: int
    revolute: str
    angles: str
    fk_status: int
    joint_names: str
    limits: str
    """The numbers of an array; empty if no joint has limits."""
    inputs: tuple[CArray, ...]
    outputs: tuple[CArray, ...]
    """The arrays of one call from Python."""


def nearest(derivation: Derivation, functions: Sequence[CFunction]) -> CNearest | None:
    """None without a Jacobian, and for an inverse of more than a target, or a pose and a number."""
    known = {f.name: f for f in functions}
    ik, fk = known.get("ik"), known.get("fk")
    if ik is None or fk is None:
        return None
    joints = derivation.actuated
    target, *beside = ik.inputs
    if beside and (target.size, [a.size for a in beside]) != (16, [1]):
        return None
    task = target.size
    modes = fk.outputs[0].size // task
    jacobian = known.get("jacobian_space" if task in (9, 16) else "jacobian")
    if jacobian is None:
        return None
    rows = {16: 6, 9: 3}.get(task, task) + len(beside)
    kinds = {j.symbol: j.kind for j in derivation.joints}
    revolute = sum(1 << k for k, j in enumerate(joints) if kinds[j] == "revolute")
    named = sum(1 << k for k, name in enumerate(derivation.task) if name in ANGLES)
    lengths = {16: 3, 9: 0}.get(task, task - named.bit_count())
    slides = {j.name for j in joints if kinds[j] != "revolute"}
    given = {a.name for a in beside}
    held = [k for k, j in enumerate(joints) if j.name in given]
    angles = named if task not in (9, 16) else 0
    angles |= sum(1 << task for name in given - slides)
    return CNearest(
        target=target.name,
        target_size=task,
        given=beside[0].name if beside else "",
        given_at=_given_at(derivation, beside[0].name) if beside else "",
        held=held[0] if held else len(joints),
        joints=len(joints),
        branches=ik.outputs[0].size // len(joints),
        task=task + len(beside),
        modes=modes,
        rows=rows,
        jacobian=jacobian.full,
        jacobian_rows=jacobian.outputs[0].size // (modes * len(joints)) + len(beside),
        jacobian_size=jacobian.outputs[0].size,
        determinant=f"{derivation.name}_nearest_determinant" if "determinant" in known else "NULL",
        lengths=lengths - len(slides - given),
        fields=len(derivation.parameters),
        revolute=f"0x{revolute:x}u",
        angles=f"0x{angles:x}u",
        fk_status=modes if len(fk.outputs) > 1 else 0,
        joint_names=", ".join(j.name for j in joints),
        limits=", ".join(_number(v) for side in derivation.limits or () for v in side),
        inputs=(
            target,
            c_array("q_seed", (len(joints),), "real", "const "),
            c_array("limits", (2, len(joints)), "real", "const "),
            c_array("weights", (len(joints),), "real", "const "),
            *beside,
        ),
        outputs=(
            c_array("q", (len(joints),), "real"),
            c_array("status", (), "status"),
            c_array("branch", (), "real"),
            c_array("distance", (), "real"),
            c_array("outside", (ik.outputs[0].size // len(joints), len(joints)), "bool"),
        ),
    )


def _given_at(derivation: Derivation, given: str) -> str:
    names = [j.name for j in derivation.actuated]
    if given in names:
        return f"(void)params, *{given} = q[{names.index(given)}];"
    name = derivation.name
    return f"{name}_{given}((const {name}_params *)params, q, {given});"


def _number(value: float) -> str:
    if math.isinf(value):
        return "INFINITY" if value > 0 else "-INFINITY"
    return f"CLOSEDFORM_C({value!r})"
