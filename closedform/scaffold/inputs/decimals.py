"""The axes of a chain whose frames have many angles without short cosines, from decimals.

Exports of CAD programs turn each frame by three angles, though the axes are simple.  Products of
such turns have a page of sines for each entry.  So they are multiplied in decimals, and each axis
becomes exact by itself: along one before it or at a right angle to one if it nearly is, and
through a point that it nearly shares with one before.  All numbers are rational: products with
several square roots are slow.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import sympy as sp

from closedform.scaffold.inputs.exact import rotation, unit_vector
from closedform.scaffold.inputs.joints import MOVING, Joint, declare
from closedform.scaffold.inputs.tables import Table, shown_name

MANY = 4
"""More angles than this are multiplied in decimals."""
DIGITS = 6
"""Decimals of a direction: two are the same if they differ by less than one in the last."""
PLACES = 9
"""Decimals of a length in metres."""
MEET = 1e-5
"""Axes that pass each other at a smaller distance, in metres, are taken to meet."""


class Changed(NamedTuple):
    """By how much axes were turned, each with its joint, and points and the tool were moved."""

    turned: list[tuple[Joint, float]]
    moved: float
    tool: float
    """The angle by which the tool was turned."""


def has_many_angles(chain: Sequence[Joint]) -> bool:
    """Whether the frames of a chain have too many angles for exact products."""
    origins = [joint.origin for joint in chain]
    if any(o.free_symbols for o in origins) or any(j.mimics for j in chain):
        return False
    return len({f.args[0] for o in origins for f in o.atoms(sp.sin, sp.cos)}) > MANY


def rational_if_slow(mount: sp.Matrix, where: str, table: Table) -> sp.Matrix:
    """The pose of a tilted mount, in rational numbers if it is turned by several angles."""
    turns = mount[:3, :3]
    if turns.free_symbols or len({f.args[0] for f in turns.atoms(sp.sin, sp.cos)}) < 2:
        return mount
    found = mount.copy()
    found[:3, :3] = rotation(_rational(_floats(turns), PLACES), roots=False)
    table.notes.append(
        f"{where}: the mount is turned by several angles; its rotation is taken from {PLACES} "
        f"decimals"
    )
    return found


def add_axes(chain: Sequence[Joint], table: Table, file: str, ignore: float) -> Changed:
    """Add the axes at home, and the pose of the tool, to the table, seen from the first axes."""
    place = np.eye(4)
    placed: list[tuple[Joint, np.ndarray, np.ndarray]] = []
    for joint in chain:
        place = place @ _floats(joint.origin)
        if joint.kind in MOVING:
            axis = place[:3, :3] @ _floats(joint.axis).ravel()
            placed.append((joint, axis / np.linalg.norm(axis), place[:3, 3]))
    M = rotation(_rational(_mount([w for _, w, _ in placed]), PLACES), roots=False)
    assert M is not None
    table.base = sp.diag(M, 1)
    back = _floats(M).T
    directions: list[sp.Matrix] = []
    points: list[sp.Matrix] = []
    turned: list[tuple[Joint, float]] = []
    moved = 0.0
    for joint, direction, point in placed:
        given, at = back @ direction, back @ point
        w = unit_vector(_rational(given, DIGITS), directions, roots=False)
        assert w is not None
        directions.append(w)
        points.append(_shared(at, directions, points, max(MEET, ignore)))
        turned.append((joint, float(np.linalg.norm(_floats(w).ravel() - given))))
        moved += 2 * _distance(at, points[-1], w)
    for (joint, *_), w, at in zip(placed, directions, points, strict=True):
        symbol = declare(joint, table, f"{file}, joint {shown_name(joint.name)}")
        table.axes.append((symbol, list(w), list(at)))
    R = rotation(_rational(back @ place[:3, :3], DIGITS), directions, roots=False)
    assert R is not None
    table.home = sp.eye(4)
    table.home[:3, :3], table.home[:3, 3] = R, _rational(back @ place[:3, 3], PLACES)
    table.notes.append(
        f"{file}: the frames of the joints are turned by many angles, so the directions of the "
        f"axes are taken from {DIGITS} decimals, seen from the first of them"
    )
    return Changed(turned, moved, float(np.linalg.norm(_floats(R) - back @ place[:3, :3])))


def _mount(directions: Sequence[np.ndarray]) -> np.ndarray:
    """A rotation whose z axis is the first direction, and its x axis another one across it."""
    z = directions[0]
    across = [w - (w @ z) * z for w in directions]
    normal = [u for u, w in zip(across, directions, strict=True) if abs(w @ z) < 10.0**-DIGITS]
    x = (normal or [max([*across, *np.eye(3) - np.outer(z, z)], key=np.linalg.norm)])[0]
    x = x / np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def _shared(
    at: np.ndarray, directions: Sequence[sp.Matrix], points: list[sp.Matrix], near: float
) -> sp.Matrix:
    """A point of the last axis: one before it, or one where it meets the axis before, if near.

    Then the ``points`` have this point for the axis before, too.
    """
    w = directions[-1]
    for point in reversed(points):
        if _distance(at, point, w) < near:
            return point
    if points and (along := _foot(at, directions, points[-1])) is not None:
        meeting = (points[-1] + along * directions[-2]).applyfunc(sp.expand)
        if _distance(at, meeting, w) < near:
            points[-1] = meeting
            return meeting
    return _rational(at, PLACES)


def _foot(at: np.ndarray, directions: Sequence[sp.Matrix], point: sp.Matrix) -> sp.Rational | None:
    """How far along the axis before the last one the last one is nearest; None if parallel."""
    u, w = (_floats(v).ravel() for v in directions[-2:])
    across = np.cross(u, w)
    square = across @ across
    if square < 10.0**-DIGITS:
        return None
    along = np.cross(at - _floats(point).ravel(), w) @ across / square
    return sp.Rational(round(float(along) * 10**PLACES), 10**PLACES)


def _distance(at: np.ndarray, point: sp.Matrix, direction: sp.Matrix) -> float:
    """Of a point from the line through another."""
    return float(np.linalg.norm(np.cross(_floats(point).ravel() - at, _floats(direction).ravel())))


def _floats(exact: sp.Matrix) -> np.ndarray:
    return np.array(exact.evalf(20), dtype=float)


def _rational(values: np.ndarray, places: int) -> sp.Matrix:
    """Numbers, rounded to so many decimals."""
    return sp.Matrix(values).applyfunc(
        lambda e: sp.Rational(round(float(e) * 10**places), 10**places)
    )


__all__ = ["Changed", "add_axes", "has_many_angles", "rational_if_slow"]
