"""The motors of an arm whose joints are coupled, and the matrix that takes them to the joints."""

from __future__ import annotations

import sympy as sp

from closedform.model.functions import real
from closedform.scaffold.inputs.names import TAKEN
from closedform.scaffold.inputs.tables import Table, TableError


def motors_of(table: Table, where: str) -> tuple[list[str], sp.Matrix]:
    """The names of the motors, and the matrix that takes their angles to those of the joints."""
    own = [joint for joint in table.joints if joint not in table.followers]
    driven = {j: table.couplings.get(j, real(f"m_{j}")) for j in own}
    names = list(dict.fromkeys(str(s) for e in driven.values() for s in _in_order(e)))
    names = [n for n in names if n not in table.parameters]
    if clash := [n for n in names if n in table.joints or n in TAKEN]:
        raise TableError(f"{where}: the motor {clash[0]} has the name of something else; rename it")
    matrix = sp.Matrix([[e.diff(real(n)) for n in names] for e in driven.values()])
    if not matrix.is_square or not _invertible(table, matrix):
        raise TableError(
            f"{where}: the column motors names {len(names)} motors for {len(driven)} joints, and "
            f"they do not determine each other; a joint with an empty cell has a motor of its own, "
            f"and one motor that turns a joint and slides another leaves no algebraic equation"
        )
    return names, matrix


def geared(table: Table, matrix: sp.Matrix) -> bool:
    """Whether a whole turn of a joint need not be one of its motor."""
    return bool(abs(_turning(table, matrix).det()) != 1)


def _turning(table: Table, matrix: sp.Matrix) -> sp.Matrix:
    """The part of the matrix for joints that turn, and the motors that turn them."""
    kinds = [kind for joint, kind in table.joints.items() if joint not in table.followers]
    turns = [k for k, kind in enumerate(kinds) if kind == "revolute"]
    own = [k for k in range(matrix.cols) if any(matrix[i, k] != 0 for i in turns)]
    return matrix.extract(turns, own)


def _invertible(table: Table, matrix: sp.Matrix) -> bool:
    """Whether the joints determine the motors, and those that turn the motors that turn them."""
    return _turning(table, matrix).is_square and bool(sp.simplify(matrix.det()) != 0)


def _in_order(e: sp.Expr) -> list[sp.Symbol]:
    return sorted(e.free_symbols, key=str)


__all__ = ["geared", "motors_of"]
