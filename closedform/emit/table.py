"""Prints a table of a derivation as comma-separated values, rounded to doubles."""

from __future__ import annotations

import io
from csv import writer

from closedform.algebra.balls import Evaluator, to_float
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
