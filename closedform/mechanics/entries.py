"""The entries of a table of joints: exact numbers and parameters, unit axes, rigid poses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from closedform.model.derivation import Derivation
from closedform.model.functions import reject_text

LONGEST = 60
"""A value with more characters is shortened in messages."""


class RowError(ValueError):
    """A row of a table of joints that cannot be read."""


def constant(d: Derivation, entries: Any, where: str) -> sp.Matrix:
    """Exact entries that contain only parameters."""
    reject_text(entries, where)
    matrix = sp.Matrix(entries)
    matrix = sp.Matrix(*matrix.shape, [exact(e, where) for e in matrix])
    joints = {j.symbol for j in d.joints}
    for symbol in sorted(matrix.free_symbols - {p.symbol for p in d.parameters}, key=str):
        if symbol in joints:
            raise RowError(f"{where}: it contains the joint {symbol}; at home all joints are zero")
        raise RowError(
            f"{where}: the symbol {symbol} is not a parameter; declare it with d.parameter"
        )
    return matrix


def dh_row(d: Derivation, row: Sequence[Any], where: str) -> list[sp.Expr]:
    """The exact entries of a row, which contain only parameters and joints."""
    if len(row) != 4:
        raise RowError(
            f"{where} has {len(row)} entries ({', '.join(map(str, row))}); it needs 4: a, alpha, "
            f"d, theta"
        )
    entries = [exact(e, where) for e in row]
    known = {p.symbol for p in d.parameters} | {j.symbol for j in d.joints}
    if unknown := sorted(map(str, {s for e in entries for s in e.free_symbols} - known)):
        raise RowError(
            f"{where}: the symbol {unknown[0]} is neither a parameter nor a joint; declare it "
            f"with d.parameter or d.joint"
        )
    return entries


def _short(value: sp.Expr) -> str:
    """A value in a message; of a long one, six digits or the beginning."""
    text = str(value)
    if len(text) <= LONGEST:
        return text
    return f"{float(value):.6g}" if value.is_number else f"{text[:LONGEST]}..."


def check_unit(w: sp.Matrix, where: str) -> None:
    length = sp.simplify(sp.sqrt(w.dot(w)))
    if length == 1:
        return
    text = ", ".join(map(_short, w))
    if length == 0:
        raise RowError(f"{where}: the direction ({text}) is zero; an axis needs a unit vector")
    if w.free_symbols:
        remedy = "write numbers, or the cosine and the sine of an angle"
    elif all(e.is_Integer for e in w):
        unit = ", ".join(map(str, w / length))
        remedy = f"write ({unit})" if len(unit) <= LONGEST else "divide it by its length"
    else:
        remedy = "numbers are exact: write sqrt(2)/2, not 0.7071"
    size = _short(length) if w.free_symbols else f"{float(length):.6g}"
    raise RowError(f"{where}: the direction ({text}) has the length {size}, not 1; {remedy}")


def rigid(d: Derivation, pose: Any, what: str) -> sp.Matrix:
    """A constant 4x4 pose with a proper rotation."""
    where = f"{d.name}: {what}"
    T = constant(d, pose, where)
    if T.shape != (4, 4) or T.row(3) != sp.Matrix([[0, 0, 0, 1]]):
        raise RowError(f"{where} must be a 4x4 matrix with the last row 0, 0, 0, 1")
    R = T[:3, :3]
    if sp.simplify(R.T * R) != sp.eye(3):
        raise RowError(
            f"{where}: [{', '.join(map(_short, R))}] is not a rotation: {_not_orthonormal(R)}; the "
            f"rows must be unit vectors at right angles to each other, written exactly (sqrt(3)/2, "
            f"not 0.866)"
        )
    if sp.simplify(R.det()) != 1:
        raise RowError(
            f"{where}: its rotation {R.tolist()} is mirrored; the third column must be the cross "
            f"product of the first two, x, y and z of the tool"
        )
    return T


def _not_orthonormal(R: sp.Matrix) -> str:
    """The row that is not a unit vector, or the rows that are not at right angles."""
    for i in range(3):
        for j in range(i + 1):
            value = sp.simplify(R.row(i).dot(R.row(j)))
            if value != (1 if i == j else 0):
                size = sp.sqrt(value) if i == j else value
                shown = size if size.free_symbols else f"{float(size):.6g}"
                if i == j:
                    return f"row {i + 1} has the length {shown}"
                return f"the scalar product of the rows {j + 1} and {i + 1} is {shown}"
    return "its columns are not"


def exact(value: Any, where: str) -> sp.Expr:
    if isinstance(value, float):
        raise TypeError(
            f"{where}: {value} is a float; write an integer or sympy.Rational('{value}')"
        )
    reject_text(value, where)
    expr = sp.sympify(value, strict=True)
    if expr.atoms(sp.Float):
        raise TypeError(
            f"{where}: the float {sorted(expr.atoms(sp.Float), key=str)[0]} occurs in {expr}; "
            "write an integer or sympy.Rational instead"
        )
    return expr


__all__ = ["RowError", "check_unit", "constant", "dh_row", "exact", "rigid"]
