"""Whether the equations of a chain determine its target, as ranks of matrices at a posture."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from closedform.algebra import certificates
from closedform.algebra.balls import Evaluator, pivot_rows
from closedform.algebra.expressions import Derivatives
from closedform.model.inverse import Inverse
from closedform.proof.posture import Posture

Expr = Any


def random_posture(draw: random.Random, symbols: Sequence[Expr]) -> dict[Expr, Expr]:
    return {
        s: sp.Rational(draw.randint(1, 40), draw.randint(7, 20)) for s in sorted(symbols, key=str)
    }


def undetermined(
    inverse: Inverse, posture: Posture, systems: Sequence[Sequence[Expr]]
) -> list[str]:
    """The coordinates of the target that the equations do not determine, given the joints.

    Equations that are linear in the coordinates not known yet determine more of them, all together
    or those of one system, until nothing is added.
    """
    draw = random.Random(2)
    columns, circle = _columns(inverse, posture)
    constant = [x - f for x, f in zip(inverse.targets, inverse.forward, strict=True) if f.is_number]
    left = [
        [sp.expand_trig(posture.in_coordinates(e)).xreplace(circle) for e in system]
        for system in (*systems, constant)
    ]
    known: dict[Expr, Expr] = {}
    while True:
        open_columns = [x for x in columns if x not in known]
        parts = [_linear_rows(system, open_columns, known) for system in left]
        nonlinear = any(others for _, others in parts)
        found = _determined([row for rows, _ in parts for row in rows], open_columns, draw)
        if len(found) < len(open_columns):
            alone = {x for rows, _ in parts for x in _determined(rows, open_columns, draw)}
            found = [x for x in open_columns if x in alone.union(found)]
        missing = [x for x in open_columns if x not in found]
        # what the target determines follows from the rest of it
        if all(x in posture.extra_coordinates for x in missing):
            return []
        if not found or not nonlinear:
            return [str(x) for x in missing]
        known |= {x: columns[x] for x in found}


def _columns(inverse: Inverse, posture: Posture) -> tuple[dict[Expr, Expr], dict[Expr, Expr]]:
    """The coordinates of the target, names that count as such, and auxiliary lengths, at a posture.

    An angle has two coordinates, its cosine and its sine.
    """
    columns: dict[Expr, Expr] = {}
    circle: dict[Expr, Expr] = {}
    for x in inverse.targets:
        value = posture.targets[x]
        if x in inverse.angles:
            c, s = sp.Dummy(f"c_{x}"), sp.Dummy(f"s_{x}")
            circle |= {sp.cos(x): c, sp.sin(x): s}
            columns |= {c: sp.cos(value), s: sp.sin(value)}
        else:
            columns[x] = value
    columns |= {s: posture(s) for s in posture.extra_coordinates}
    return columns | posture.lengths, circle


def _linear_rows(
    equations: Sequence[Expr], columns: Sequence[Expr], known: Mapping[Expr, Expr]
) -> tuple[list[list[Expr]], bool]:
    """The coefficients of the linear equations, and whether there are nonlinear ones."""
    rows, nonlinear, along = [], False, [Derivatives(x) for x in columns]
    for e in equations:
        slopes = [rate.of(e) for rate in along]
        if any(slope.has(*columns) for slope in slopes):
            nonlinear = True
        else:
            rows.append([slope.xreplace(known) for slope in slopes])
    return rows, nonlinear


def _determined(
    rows: Sequence[Sequence[Expr]], columns: Sequence[Expr], draw: random.Random
) -> list[Expr]:
    """The columns of a matrix if it has full rank, otherwise those of its parts of full rank.

    Parts share no row and no column.  Of a part with too few rows, the column that the fewest rows
    touch is left out with these rows.
    """
    if _has_full_rank(rows, len(columns), draw):
        return list(columns)
    found = []
    for part in _parts(rows, len(columns)):
        own = [[row[j] for j in part] for row in rows if any(row[j] != 0 for j in part)]
        within = [columns[j] for j in part]
        if len(part) < len(columns) and _has_full_rank(own, len(part), draw):
            found += within
            continue
        touched = [sum(row[k] != 0 for row in own) for k in range(len(part))]
        least = touched.index(min(touched))
        rest = [row[:least] + row[least + 1 :] for row in own if row[least] == 0]
        found += _determined(rest, within[:least] + within[least + 1 :], draw) if rest else []
    return found


def _has_full_rank(rows: Sequence[Sequence[Expr]], width: int, draw: random.Random) -> bool:
    """Whether a matrix certainly has full column rank at a random posture."""
    if len(rows) < width:
        return False
    entries = [slope for row in rows for slope in row]
    point = random_posture(draw, list({s for e in entries for s in e.free_symbols}))
    balls = Evaluator(list(point), entries)(list(point.values()))
    full = len(pivot_rows([balls[i : i + width] for i in range(0, len(balls), width)])) == width
    if full:
        certificates.point(rows, point, "ranks of a matrix at a posture")
    return full


def _parts(rows: Sequence[Sequence[Expr]], width: int) -> list[list[int]]:
    """The columns in groups that rows connect; columns of zeros are left out."""
    parts: list[set[int]] = []
    for row in rows:
        touched = {j for j in range(width) if row[j] != 0}
        if not touched:
            continue
        joined = [part for part in parts if part & touched]
        parts = [part for part in parts if not part & touched]
        parts.append(touched.union(*joined))
    return [sorted(part) for part in parts]


__all__ = ["random_posture", "undetermined"]
