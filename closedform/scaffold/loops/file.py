"""Reads a closed loop from a file: bodies and the joints between them.

The file is TOML::

    hand = "P"

    [parameters]
    L1 = 7

    [bodies.ground]
    A1 = [0, 0]
    [bodies.crank1]
    A1 = [0, 0]
    B1 = ["L1", 0]
    [bodies.rod1]
    length = "L3"

    [joints.theta1]
    between = ["ground", "crank1"]
    at = "A1"
    driven = true

A body has named points; two bodies meet in a point that both have, or that a joint names.  The
points of the ground, and of a body that a driven joint moves, are where they are when the joint is
zero; those of the hand are seen from the point of the hand.  A rod has a ``length`` instead of
points.  :mod:`closedform.scaffold.loops.legs` finds the legs.
"""

from __future__ import annotations

import difflib
import re
import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.model.names import check_text
from closedform.scaffold.inputs.tables import (
    TableError,
    check_keys,
    check_variable,
    expression,
    parameter,
    text_of,
)
from closedform.scaffold.loops.bodies import AXES, GROUND, Joint, Loop
from closedform.scaffold.loops.copies import copy_numbered
from closedform.scaffold.source import VARIABLES

KINDS = ("revolute", "prismatic", "spherical", "universal", "cylindrical")
USED = {
    "d",
    *VARIABLES.values(),
    "pi",
    "real",
    "coupled",
    "parallel",
    "platform",
    "tripod",
    "on_rod",
    "linkage",
}
USED |= {"slotted", "guided", "sliding_linkage", "on_pins", "on_balls", "on_lines", "mirrored"}
USED |= {
    "bennett",
    "on_levers",
    "Derivation",
    "Paper",
    "Across",
    "Along",
    "Around",
    "Ball",
    "BallOnLine",
    "BallOnMast",
    "Body",
    "Crank",
    "Cross",
    "Extended",
    "FreeAlong",
    "Gimbal",
    "Guide",
    "Half",
    "Hinge",
    "Hinged",
    "Lever",
    "Mast",
    "OnCylinders",
    "OnTurret",
    "ParallelAxes",
    "Parallelogram",
    "Plane",
    "Prism",
    "Rail",
    "Sleeve",
    "ThroughBall",
    "Screws",
    "Slide",
    "Sliding",
    "Spindle",
    "StandingPlane",
    "Stretch",
    "Strut",
    "ThreeHinges",
    "ThreePlanes",
    "TurningPlane",
    "TwoHinges",
    "Universal",
    "Upright",
}
USED |= {"Abs", "Rational", "cos", "sin", "sqrt"}
"""Names that the written script uses itself."""
OTHER_NAMES = {
    **dict.fromkeys(("ball", "socket", "ball joint"), "a ball joint is spherical"),
    **dict.fromkeys(("cardan", "hooke"), "a joint of Cardan or Hooke is universal"),
    **dict.fromkeys(("hinge", "pin", "rotary", "turn"), "a hinge or a pin is revolute"),
    **dict.fromkeys(("slide", "slider", "linear", "sliding"), "a slide is prismatic"),
}
"""What is meant by other names of joints."""
GEARS = ("gear", "gears", "belt", "chain", "pulley", "rack", "pinion")
OTHER_NAMES |= {
    **dict.fromkeys(
        GEARS,
        "gears, belts and chains are no joints here: let both joints that they couple be driven, "
        "and put their ratio between the two where you call the functions",
    ),
    **dict.fromkeys(
        ("cam", "cams"),
        "a cam is no joint here: let the joint of its follower be driven, whose value the profile "
        "gives",
    ),
}
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
"""Bodies and points."""
TASK = (*AXES, "yaw")


def read_loop(path: Path) -> Loop:
    """The bodies and joints of a file; raises :class:`TableError`, which says what to correct."""
    try:
        data = tomllib.loads(text_of(path), parse_float=str)
    except TableError:
        raise
    except (ValueError, RecursionError) as error:
        raise TableError(f"{path.name} is not valid TOML: {error}") from error
    check_keys(data, ("hand", "copies", "parameters", "bodies", "joints"), path.name)
    for key in ("hand", "bodies", "joints"):
        if key not in data:
            raise TableError(f"{path.name}: {key} is missing")
    hand = _named(data["hand"], f"{path.name}: hand")
    loop = Loop(path.name, _dimensions(data["bodies"], path.name), hand)
    for name, entry in data.get("parameters", {}).items():
        loop.parameters[name] = parameter(name, entry, f"{path.name}, [parameters]")
    _read_bodies(loop, data["bodies"])
    _read_joints(loop, data["joints"])
    if "copies" in data:
        copy_numbered(loop, data["copies"])
    _check_names(loop)
    return loop


def _check_names(loop: Loop) -> None:
    """Refuse names that clash, because joints and parameters become variables of the script."""
    if loop.hand not in loop.joints:
        written = {j.name for j in loop.joints.values() if _is_written(loop, j)}
        for name in [*AXES[: loop.dimensions], TASK[-1]]:
            if name in written or name in loop.symbols | set(loop.parameters):
                kind = "joint" if name in written else "parameter"
                raise loop.error(
                    f"{name} is a coordinate of the hand; give the {kind} another name"
                )
    loop.parameters |= {name: {} for name in sorted(loop.symbols - set(loop.parameters))}
    if untold := [n for n, given in loop.parameters.items() if "value" not in given]:
        loop.notes.append(
            f"{loop.file}: no value is given for {', '.join(untold)}, so 1 is taken; write one in "
            f'[parameters], such as {untold[0]} = {{value = "0.1", meaning = "what it is"}}'
        )
    for name, given in loop.parameters.items():
        check_variable(
            name, f"{loop.file}, [parameters]", taken=name in USED and name not in VARIABLES
        )
        check_text(f"{loop.file}: {name}", given.get("meaning", ""), given.get("unit", ""))
        if name in loop.joints:
            raise loop.error(f"{name} is a joint and a parameter; rename one of them")


def _dimensions(bodies: Any, file: str) -> int:
    check_keys(bodies, None, f"{file}, [bodies]")
    places = [
        at
        for body in bodies.values()
        if isinstance(body, dict)
        for key, at in body.items()
        if isinstance(at, list) and key != "parallelogram"
    ]
    sizes = {len(at) for at in places}
    if sizes not in ({2}, {3}):
        raise TableError(
            f"{file}: all points need 2 coordinates (in a plane) or all need 3 (in space)"
        )
    return sizes.pop()


def _read_bodies(loop: Loop, bodies: Mapping[str, Any]) -> None:
    for name, body in bodies.items():
        where = f"{loop.file}, [bodies.{name}]"
        _named(name, f"{loop.file}, [bodies]: a body")
        check_keys(body, None, where)
        points: dict[str, sp.Matrix] = {}
        for key, given in body.items():
            if key == "length":
                loop.rods[name] = expression(given, where, VARIABLES)
            elif key == "parallelogram":
                if not isinstance(given, list) or len(given) != loop.dimensions:
                    raise TableError(
                        f"{where}: parallelogram is a vector along its short sides, from one end "
                        f"to the other, with {loop.dimensions} coordinates"
                    )
                loop.parallelograms[name] = sp.Matrix(
                    [expression(e, where, VARIABLES) for e in given]
                )
            elif isinstance(given, list):
                points[_named(key, f"{where}: a point")] = sp.Matrix(
                    [expression(e, f"{where}, {key}", VARIABLES) for e in given]
                )
            else:
                close = difflib.get_close_matches(key, ("length", "parallelogram"))
                hint = f"; did you mean {close[0]}?" if close else ""
                raise TableError(f"{where}: {key} must be a point, such as [0, 0]{hint}")
        if name in loop.rods:
            _check_rod(loop.rods[name], points, where)
        loop.bodies[name] = points
    if GROUND not in loop.bodies:
        raise loop.error("there is no [bodies.ground]; one body must stand still")


def _check_rod(length: sp.Expr, points: Mapping[str, sp.Matrix], where: str) -> None:
    """Refuse a length that is not positive, and points, which only a body without a length has."""
    if length.is_number and not length.is_positive:
        raise TableError(f"{where}: the length of a rod must be positive, not {length}")
    if points:
        raise TableError(f"{where}: a rod has a length and no points, but there is {min(points)}")


def _read_joints(loop: Loop, joints: Any) -> None:
    check_keys(joints, None, f"{loop.file}, [joints]")
    for name, given in joints.items():
        where = f"{loop.file}, [joints.{name}]"
        check_keys(given, None, where)
        kind, between = given.get("kind", "revolute"), given.get("between")
        if kind in KINDS:
            check_keys(given, ("between", "kind", "at", "axis", "second", "driven"), where)
        if kind == "cylindrical" and given.get("driven") is True and GROUND in (between or ()):
            given = _on_slider(loop, name, given, where)
            kind, between = given["kind"], given["between"]
        if kind not in KINDS:
            meant = OTHER_NAMES.get(kind.lower(), "") if isinstance(kind, str) else ""
            raise TableError(
                f"{where}: kind must be one of {', '.join(KINDS)}" + f"; {meant}" * bool(meant)
            )
        if not (isinstance(between, list) and len(between) == 2):
            raise TableError(f'{where}: between must be two bodies, such as ["ground", "crank1"]')
        between = [_named(b, f"{where}: between") for b in between]
        if between[0] == between[1]:
            raise TableError(f"{where}: between names {between[0]} twice; give two bodies")
        missing = [b for b in between if b not in loop.bodies]
        if missing:
            raise TableError(f"{where}: there is no body {missing[0]}")
        axis, second = (_axis(loop, given.get(key), where, key) for key in ("axis", "second"))
        if second is not None and kind != "universal":
            raise TableError(f"{where}: only a universal joint has a second axis")
        driven = given.get("driven", False)
        if not isinstance(driven, bool):
            coupled = (
                "; for a joint that gears or a belt couple to another one write true, and put "
                "their ratio between the two where you call the functions"
            ) * isinstance(driven, str)
            raise TableError(f"{where}: driven must be true or false{coupled}")
        at = _named(given["at"], f"{where}: at") if "at" in given else _shared(loop, between, where)
        joint = Joint(name, kind, (between[0], between[1]), at, axis, driven, second)
        check_variable(name, where, taken=name in USED and _is_written(loop, joint))
        loop.joints[name] = joint


def _on_slider(loop: Loop, name: str, given: Mapping[str, Any], where: str) -> Mapping[str, Any]:
    """The slide of a cylindrical joint on the ground, beside a new body and its turning joint."""
    if "axis" not in given or "at" not in given:
        raise TableError(f"{where}: a cylindrical joint needs its axis, and at which point it is")
    at, slider = given["at"], f"slider_{name}"
    (body,) = (b for b in given["between"] if b != GROUND)
    if slider in loop.bodies or at not in loop.bodies[GROUND]:
        raise TableError(f"{where}: {GROUND} has no point {at}, or {slider} is a body already")
    loop.bodies[slider] = {at: loop.bodies[GROUND][at]}
    axis = _axis(loop, given["axis"], where, "axis")
    turn = f"turn_{name}"
    loop.joints[turn] = Joint(
        name=turn, kind="revolute", between=(slider, body), at=at, axis=axis, driven=False
    )
    return {**given, "kind": "prismatic", "between": [GROUND, slider]}


def _is_written(loop: Loop, joint: Joint) -> bool:
    """Whether a joint becomes a variable of the script."""
    return joint.driven or joint.kind == "prismatic" or joint.name == loop.hand


def _axis(loop: Loop, axis: Any, where: str, key: str) -> sp.Matrix | None:
    if axis is None:
        return None
    if not isinstance(axis, list) or len(axis) != loop.dimensions:
        raise TableError(f"{where}: {key} needs {loop.dimensions} coordinates")
    return _unit(sp.Matrix([expression(e, where, VARIABLES) for e in axis]), where)


def _named(name: Any, what: str) -> str:
    """A name of a body or a point, which messages and the script may hold."""
    if isinstance(name, str) and NAME.fullmatch(name):
        return name
    raise TableError(f"{what} needs a name of letters, digits, _ and -, not {name!a}")


def _shared(loop: Loop, between: Sequence[str], where: str) -> str:
    shared = loop.bodies[between[0]].keys() & loop.bodies[between[1]].keys()
    if len(shared) != 1:
        raise TableError(f'{where}: say where the bodies meet, as in at = "A1"')
    return str(next(iter(shared)))


def _unit(v: sp.Matrix, where: str) -> sp.Matrix:
    size = sp.sqrt(sp.simplify(v.dot(v)))
    if size == 0:
        raise TableError(f"{where}: the direction has no length")
    return (v / size).applyfunc(sp.simplify)


__all__ = ["read_loop"]
