"""Prints the tables of a derivation as comma-separated values, rounded to doubles."""

from __future__ import annotations

import io
from csv import writer
from pathlib import Path

from closedform.algebra.balls import Evaluator, to_float
from closedform.emit.backend import Backend, Mechanism, Pages
from closedform.model.derivation import Derivation, Table
from closedform.model.functions import reject_floats


def csv(derivation: Derivation, table: Table) -> str:
    """The header and a line for each value of the variable."""
    example = {p.symbol: p.value for p in derivation.parameters}
    columns = [e.xreplace(example) for e in table.columns.values()]
    for name, column in zip(table.columns, columns, strict=True):
        reject_floats(column, f"{derivation.name}, table {table.name}, column {name}")
    evaluate = Evaluator([table.variable], columns)
    text = io.StringIO()
    lines = writer(text, lineterminator="\n")
    lines.writerow([table.header, *table.columns])
    for value in table.values:
        numbers = [float(value), *map(to_float, evaluate([value]))]
        lines.writerow([n + 0.0 for n in numbers])  # never -0.0
    return text.getvalue()


class Data(Backend):
    def pages(self, mechanism: Mechanism) -> Pages:
        d = mechanism.derivation
        return Pages({Path("data", f"{t.name}.csv"): csv(d, t) for t in d.tables})


BACKEND = Data()
