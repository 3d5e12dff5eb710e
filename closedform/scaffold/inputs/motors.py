"""The motors of an arm whose joints are coupled, and the matrix that takes them to the joints."""

from __future__ import annotations

import sympy as sp

from closedform.model.functions import real
from closedform.scaffold.inputs.names import TAKEN
from closedform.scaffold.inputs.tables import Table, TableError


def motors_of(table: Table, where: str) -> tuple[list[str], sp.Matrix]:
    """The names of the motors, and the matrix that takes their angles to those of the joints."""
    driven = {j: table.couplings.get(j, real(f"m_{j}")) for j in table.joints}
    names = list(dict.fromkeys(str(s) for e in driven.values() for s in _in_order(e)))
    names = [n for n in names if n not in table.parameters]
    if clash := [n for n in names if n in table.joints or n in TAKEN]:
        raise TableError(f"{where}: the motor {clash[0]} has the name of something else; rename it")
    matrix = sp.Matrix([[e.diff(real(n)) for n in names] for e in driven.values()])
    if not matrix.is_square or not _invertible(table, matrix):
        raise TableError(
            f"{where}: the column motors names {len(names)} motors for {len(driven)} joints, and "
            f"they do not determine each other; a joint with an empty cell has a motor of its own"
        )
    return names, matrix


def _invertible(table: Table, matrix: sp.Matrix) -> bool:
    """Whether the joints determine the motors: turns up to whole turns, slides at all."""
    turns = [k for k, kind in enumerate(table.joints.values()) if kind == "revolute"]
    own = [k for k in range(matrix.cols) if any(matrix[i, k] != 0 for i in turns)]
    whole = len(own) == len(turns) and abs(matrix.extract(turns, own).det()) == 1
    return bool(whole and sp.simplify(matrix.det()) != 0)


def _in_order(e: sp.Expr) -> list[sp.Symbol]:
    return sorted(e.free_symbols, key=str)


__all__ = ["motors_of"]
