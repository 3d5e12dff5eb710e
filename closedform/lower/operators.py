"""The operators of lowered programs: the one list of them.

A graph refuses what is not in it.  A printer has a method for each operator that is printed, called
as :attr:`Operator.method` says, and the banner counts operations by their group.
"""

from __future__ import annotations

import keyword
from dataclasses import dataclass

COMPARED = "compare and select"


@dataclass(frozen=True)
class Operator:
    """An operator.

    ``arity`` is None if it takes any number of operands.  A leaf costs nothing by itself: a number,
    an input, or a value that is computed before all others.  ``group`` names the group in which the
    banner counts it, empty if it is not counted.  Operators that are not printed are replaced
    before a program is finished.
    """

    name: str
    arity: int | None
    group: str = COMPARED
    boolean: bool = False
    leaf: bool = False
    printed: bool = True

    @property
    def method(self) -> str:
        """The name of the method that prints it; words of Python get an underscore at the end."""
        return f"{self.name}_" if keyword.iskeyword(self.name) else self.name


_TABLE = (
    # what is known before the program starts
    Operator("const", 0, "", leaf=True),
    Operator("input", 0, "", leaf=True),
    Operator("nan", 0, "", leaf=True),
    Operator("tolerance", 0, "", leaf=True),
    Operator("true", 0, "", boolean=True, leaf=True),
    Operator("false", 0, "", boolean=True, leaf=True),
    # of an angle, taken before all else
    Operator("sin", 1, "sincos", leaf=True),
    Operator("cos", 1, "sincos", leaf=True),
    Operator("principal", 1, "reduce to a turn", leaf=True),
    # arithmetic
    Operator("sum", None, "add", printed=False),
    Operator("product", None, "multiply", printed=False),
    Operator("add", 2, "add"),
    Operator("sub", 2, "add"),
    Operator("mul", 2, "multiply"),
    Operator("div", 2, "divide"),
    Operator("neg", 1, ""),
    Operator("sqrt", 1, "sqrt"),
    Operator("atan2", 2, "atan2"),
    # comparing and choosing
    Operator("abs", 1),
    Operator("sign", 1),
    Operator("max", 2),
    Operator("min", 2),
    Operator("wrap", 1),
    Operator("wrap_cut", 1),
    Operator("select", 3),
    Operator("lt", 2, boolean=True),
    Operator("le", 2, boolean=True),
    Operator("eq", 2, boolean=True),
    Operator("and", 2, boolean=True),
    Operator("or", 2, boolean=True),
    Operator("not", 1, boolean=True),
    Operator("finite", None, boolean=True),
    # what an answer says of itself
    Operator("poison", 1),
    Operator("status", 3),
)
OPERATORS = {operator.name: operator for operator in _TABLE}
BOOLEAN = frozenset(o.name for o in _TABLE if o.boolean)
LEAVES = frozenset(o.name for o in _TABLE if o.leaf)
COUNTED = frozenset(o.name for o in _TABLE if o.group and not o.leaf)
"""Operators that are counted wherever they occur; sines and the like are counted by angle."""
PRINTED = tuple(o for o in _TABLE if o.printed)
GROUPS = {**{o.name: o.group for o in _TABLE}, "sincos": "sincos"}
"""The groups in which operations are counted; a sine and a cosine of one angle count once."""
