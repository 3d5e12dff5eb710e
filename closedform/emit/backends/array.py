"""Any array library: a module for each robot, by the array API standard, and their runtime."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from closedform.emit import sines
from closedform.emit.backend import Backend, Files, Mechanism, Pages, runtime
from closedform.emit.code import ATOM, Printer, Text, call, word
from closedform.emit.docstring import Wording, docstring, python_kind
from closedform.emit.python import argument_list, kernel_arguments, tuple_code
from closedform.emit.render import render
from closedform.emit.sizes import Size
from closedform.emit.text import WIDTH, banner, interface
from closedform.lower import Lowered
from closedform.lower.finite import finite_derivatives
from closedform.lower.graph import Node
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.names import in_python
from closedform.model.tolerances import DOUBLE, FLOAT, GENERATED, Tolerances

OPERATIONS = "ops"
"""The first argument of a kernel."""
WORDS = Wording("array_like", "array", "array of bool", "array of uint8", python_kind, out=False)


def operation(name: str) -> Any:
    """A method that prints an operator as a call of an operation."""
    return call(f"{OPERATIONS}.{name}")


class ArrayPrinter(Printer):
    """Code of a kernel over planes of any library."""

    has_meaning = staticmethod(in_python)

    nan = word(f"{OPERATIONS}.nan")
    true, false = word(f"{OPERATIONS}.truth(True)"), word(f"{OPERATIONS}.truth(False)")
    sqrt, atan2, abs = operation("sqrt"), operation("atan2"), operation("abs")
    max, min, sign = operation("max"), operation("min"), operation("sign")
    wrap, wrap_cut = operation("wrap"), operation("wrap_cut")
    select, finite, not_ = operation("select"), operation("finite"), operation("opposite")
    poison, status = operation("poison"), operation("status")

    def tolerance(self, node: Node) -> Text:
        return Text(f"{OPERATIONS}.{node.payload}")

    def eq(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"({super().eq(node, a, b).code})", ATOM)


@dataclass(frozen=True)
class ArrayFunction:
    """The plain strings of one function, for the template."""

    name: str
    signature: str
    arguments: str
    returns: str
    wrap: str
    docstring: str
    planes: str
    lines: tuple[str, ...]
    values: tuple[str, ...]
    inputs: str
    outputs: str
    used: str
    size: str


def _numbers() -> Iterator[str]:
    """The tolerances and the range of each floating-point type."""
    for name, tolerances in (("FLOAT64", DOUBLE), ("FLOAT32", FLOAT)):
        listed = [f"    {field}={getattr(tolerances, field)!r},\n" for field in GENERATED]
        yield "".join([f"{name} = Precision(\n", *listed])
        yield _range(tolerances)
    parts = ", ".join(f"4 * {part}" for part in sines.RIGHT_ANGLE)
    yield f"    parts=({parts}),\n    limit={sines.LIMIT},\n"


def _range(tolerances: Tolerances) -> str:
    least, most = tolerances.least_exponent, tolerances.most_exponent
    return f"    least={least},\n    most={most},\n"


def _function(derivation: Derivation, function: Function, program: Lowered) -> ArrayFunction:
    printer = ArrayPrinter(program, [OPERATIONS])
    results = printer.run()
    needed = {(n.op, n.args[0].id) for n in program.schedule() if n.op in ("sin", "cos")}
    lines = []
    for angle, *names in printer.trig:
        code = printer.text[angle.id].code
        for op, name in zip(("sin", "cos"), names, strict=True):
            if (op, angle.id) in needed:
                lines.append(f"{name} = {OPERATIONS}.{op}({code})")
    for angle, name in printer.turned:
        lines.append(f"{name} = {OPERATIONS}.principal({printer.text[angle.id].code})")
    lines += [f"{line.name} = {line.code}" for line in printer.lines]
    names = [OPERATIONS, *kernel_arguments(printer, program)]
    size = Size.of(program)
    return ArrayFunction(
        name=function.name,
        signature="".join(f'{a.name}: "ArrayLike", ' for a in function.inputs),
        arguments=tuple_code(a.name for a in function.inputs),
        returns=f'"{function.result}"' if function.result else "Any",
        wrap=f"{function.result}(*result)" if function.result else "result",
        docstring=textwrap.indent(
            "\n".join(docstring(derivation, function, WIDTH - 4, WORDS)), "    "
        ).strip(),
        planes=argument_list(names, f"_{function.name}", WIDTH),
        lines=tuple(lines),
        values=tuple(v for result in results for v in result),
        inputs=_specs((a.name, a.shape, "real") for a in function.inputs),
        outputs=_specs((r.name, r.shape, r.kind) for r in program.results),
        used=repr(program.parameters),
        size=f"_runtime.Size({size.lengths!r}, {size.degrees!r}, {_highest(program)})"
        if size
        else "",
    )


def _highest(program: Lowered) -> int:
    """The highest power of the size; derivatives of angles have the squares of powers."""
    return 2 * program.degrees.highest if program.degrees else 0


def _specs(specs: Iterable[tuple[str, tuple[int, ...], str]]) -> str:
    kinds = {"real": "", "status": ', "status"', "bool": ', "bool"'}
    return tuple_code(f'_runtime.Spec("{n}", {shape!r}{kinds[kind]})' for n, shape, kind in specs)


class AnyArray(Backend):
    runner = "array"

    def pages(self, mechanism: Mechanism) -> Pages:
        derivation = mechanism.derivation
        lowered = {n: finite_derivatives(p) for n, p in mechanism.lowered.items()}
        context: Mapping[str, Any] = {
            "banner": banner(derivation, lowered, "#"),
            "interface": interface(derivation),
            "functions": [_function(derivation, f, lowered[f.name]) for f in derivation.functions],
        }
        return Pages({self.first_file(derivation.name): render("array/module.py.jinja", context)})

    def shared(self, shares: Sequence[Any]) -> Files:
        return {Path("array", "_runtime.py"): runtime("array/_runtime.py", list(_numbers()))}

    def first_file(self, robot: str) -> Path:
        return Path("array", f"{robot}.py")


BACKEND = AnyArray()
