"""A direct interpreter of a lowered program, independent of the printers."""

import math

from closedform.lower import Lowered
from closedform.model.tolerances import DOUBLE

RULES = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b if b else math.nan,
    "neg": lambda a: -a,
    "sqrt": math.sqrt,
    "sin": math.sin,
    "cos": math.cos,
    "abs": abs,
    "max": max,
    "atan2": math.atan2,
    "wrap": lambda a: math.pi - (math.pi - a) % math.tau,
    "principal": lambda a: math.atan2(math.sin(a), math.cos(a)),
    "wrap_cut": lambda a: math.pi if a <= -math.pi else a,
    "le": lambda a, b: a <= b,
    "and": lambda a, b: a and b,
    "or": lambda a, b: a or b,
    "not": lambda a: not a,
    "select": lambda c, a, b: a if c else b,
    "true": lambda: True,
    "false": lambda: False,
    "poison": lambda failed: math.nan if failed else 0.0,
    "finite": lambda *values: all(map(math.isfinite, values)),
}


def run(program: Lowered, values: dict[str, float]) -> list[float]:
    value: dict[int, float] = {}
    for node in program.schedule():
        if node.op == "const":
            value[node.id] = float(node.payload)
        elif node.op == "input":
            value[node.id] = values[node.payload]
        elif node.op == "tolerance":
            value[node.id] = getattr(DOUBLE, node.payload)
        else:
            value[node.id] = RULES[node.op](*(value[a.id] for a in node.args))
    return [value[r.id] for r in program.roots]
