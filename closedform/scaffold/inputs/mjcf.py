"""Reads a serial arm from an MJCF file, with MuJoCo, which resolves defaults, frames and units.

Only bodies, joints and sites are used, so the meshes of the model need not be there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray

from closedform.scaffold.inputs.joints import Joint
from closedform.scaffold.inputs.tables import Table, TableError, content_of, shown_name
from closedform.scaffold.inputs.tree import (
    DEFAULT,
    LARGEST,
    Choice,
    meant_angle,
    meant_axis,
    meant_length,
    placed,
    table_of,
)

KINDS = ("floating", "ball", "prismatic", "revolute")
"""What MuJoCo's numbers of joint types mean."""
UNUSED = (
    *("keys", "sensors", "actuators", "tendons", "pairs", "excludes", "equalities", "skins"),
    *("flexes", "texts", "numerics", "tuples", "plugins", "geoms", "cameras", "lights"),
    *("meshes", "hfields", "materials", "textures"),
)
"""What a model has besides bodies, joints and sites."""


def read_mjcf(path: Path, choice: Choice = DEFAULT) -> Table:
    """The chain of the ``choice``, whose tool is a body or a site; by default to the end."""
    if b"<mujoco" not in content_of(path, LARGEST, "an MJCF file"):
        raise TableError(f"{path.name}: the file is not MJCF, which begins with <mujoco>")
    model, followed = _model(path)
    found = [j for k in range(1, model.nbody) for j in _body(model, k, path.name)]
    joints = [_following(j, followed[j.name]) if j.name in followed else j for j in found]
    sites = [j for k in range(model.nsite) if (j := _site(model, k, path.name))]
    if choice.tool and choice.tool not in {j.child for j in joints}:
        return table_of(joints + sites, path.name, choice)
    table = table_of(joints, path.name, choice)
    if beyond := [shown_name(j.child) for j in sites if j.parent == table.end]:
        table.notes.append(
            f"{path.name}: a site beyond it can be chosen with --tool: {', '.join(beyond)}"
        )
    return table


def _model(path: Path) -> tuple[Any, dict[str, Any]]:
    """The compiled model, without parts that have to be loaded or may fail.

    Also the equations that make one joint follow another, by the name of the one that follows.
    """
    try:
        import mujoco
    except ModuleNotFoundError as error:
        raise TableError("MJCF is read with MuJoCo; run: pip install 'closedform[mjcf]'") from error
    try:
        spec = mujoco.MjSpec.from_file(str(path))
        followed = {
            e.name1: (e.name2, _exact(e.data[:5]))
            for e in spec.equalities
            if e.type == mujoco.mjtEq.mjEQ_JOINT and e.active
        }
        for kind in UNUSED:
            for element in [*getattr(spec, kind, ())]:
                spec.delete(element)
        for body in spec.bodies:
            body.explicitinertial, body.mass, body.inertia = True, 1.0, [1.0, 1.0, 1.0]
        return spec.compile(), followed
    except (ValueError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        raise TableError(f"{path.name} is not a model that MuJoCo reads: {reason}") from error


def _body(model: Any, k: int, file: str) -> Iterator[Joint]:
    """The joints between a body and its parent, one after the other."""
    notes: list[str] = []
    body = model.body(k)
    where = f"{file}, body {shown_name(body.name or str(k))}"
    place, written = _pose(body.pos, body.quat, where, notes)
    at, end = _name(model.body(int(body.parentid[0]))), _name(body)
    first, count = int(body.jntadr[0]), int(body.jntnum[0])
    level = (0, 0, 0)
    back = back_written = sp.eye(4)
    for i in range(first, first + count):
        joint = model.joint(i)
        of = f"{file}, joint {shown_name(joint.name or str(i))}"
        kind = KINDS[int(joint.type[0])]
        through = _place(joint.pos, of, notes)
        axis = given = sp.Matrix([0, 0, 1])
        if kind in ("prismatic", "revolute"):
            given = sp.Matrix(_exact(joint.axis))
            axis = meant_axis(given, of, notes)
        if model.qpos0[joint.qposadr[0]] and kind != "floating":
            notes.append(f"{of}: it is 0 in the pose of the file, not at the value of ref")
        least, most = (repr(float(v)) for v in joint.range)
        limits = (least, most) if model.jnt_limited[i] else None
        place = (place * back * placed(through, level)).applyfunc(sp.expand)
        written = written * back_written * placed(_exact(joint.pos), level)
        last = i == first + count - 1 and not any(joint.pos)
        link = end if last else f"{end} after {joint.name or i}"
        name, literal = joint.name or f"q{i + 1}", (written, given)
        yield Joint(
            name=name,
            kind=kind,
            parent=at,
            child=link,
            origin=place,
            axis=axis,
            limits=limits,
            written=literal,
            notes=tuple(notes),
        )
        notes.clear()
        at, place, written = link, sp.eye(4), sp.eye(4)
        back = placed([-e for e in through], level)
        back_written = placed([-e for e in _exact(joint.pos)], level)
    if at == end:
        return
    remaining, literal = place * back, (written * back_written, sp.Matrix([0, 0, 1]))
    yield Joint(
        name=f"{end} on {at}",
        kind="fixed",
        parent=at,
        child=end,
        origin=remaining,
        axis=literal[1],
        written=literal,
        notes=tuple(notes),
    )


def _following(joint: Joint, equation: tuple[str, list[sp.Rational]]) -> Joint:
    """A joint that an equality ties to another, or to a constant.

    Their values are counted from ``ref``, as those of the arm are.
    """
    other, (offset, factor, *higher) = equation
    if not other or (factor == 0 and not any(higher)):
        fault = "an equality holds it; remove the joint, or the equality"
        return replace(joint, fault=fault)
    if any(higher):
        fault = (
            f"an equality makes it a polynomial of {shown_name(other)}, of degree above 1; "
            f"remove the equality to read both as joints of their own"
        )
        return replace(joint, fault=fault)
    return replace(joint, mimics=other, factor=factor, offset=offset)


def _site(model: Any, k: int, file: str) -> Joint | None:
    notes: list[str] = []
    site = model.site(k)
    where = f"{file}, site {shown_name(site.name)}"
    place, written = _pose(site.pos, site.quat, where, notes)
    body, z = _name(model.body(int(site.bodyid[0]))), sp.Matrix([0, 0, 1])
    fixed = Joint(
        name=site.name,
        kind="fixed",
        parent=body,
        child=site.name,
        origin=place,
        axis=z,
        written=(written, z),
        notes=tuple(notes),
    )
    return fixed if site.name else None


def _name(body: Any) -> str:
    return str(body.name) or f"body {body.id}"


def _exact(values: NDArray[Any]) -> list[sp.Rational]:
    """The decimals that were written, from the doubles next to them."""
    return [sp.Rational(f"{float(v):.15g}") for v in values]


def _place(pos: NDArray[Any], where: str, notes: list[str]) -> list[sp.Rational]:
    return [meant_length(e, f"{where}: pos", notes) for e in _exact(pos)]


def _pose(
    pos: NDArray[Any], quat: NDArray[Any], where: str, notes: list[str]
) -> tuple[sp.Matrix, sp.Matrix]:
    """A pose as it is meant, and in numbers as the file has it."""
    w, x, y, z = quat
    sine = 2 * (w * y - z * x)
    if abs(sine) > 1 - 1e-9:  # the first turn and the last have the same axis
        angles = (0.0, np.copysign(np.pi / 2, sine), 2 * np.arctan2(z, w))
    else:
        angles = (
            np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
            np.arcsin(sine),
            np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
        )
    given = _exact(np.array(angles))
    turns = [meant_angle(angle, where, notes) for angle in given]
    return placed(_place(pos, where, notes), turns), placed(_exact(pos), given).evalf(30)
