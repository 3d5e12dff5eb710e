"""Prints a derivation as a NumPy module."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from closedform.emit import sines
from closedform.emit.code import ATOM, LOGIC, WRAPS, Printer, Text
from closedform.emit.docstring import docstring
from closedform.emit.text import WIDTH, banner, call_signature, interface
from closedform.lower import Lowered
from closedform.lower.graph import Node
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.names import in_python
from closedform.model.tolerances import DOUBLE, GENERATED

CALLS = {
    "sqrt": "np.sqrt",
    "atan2": "np.arctan2",
    "abs": "np.abs",
    "max": "np.maximum",
    "min": "np.minimum",
    "select": "_runtime.select",
    "sign": "_runtime.sign",
    "not": "np.logical_not",
    **{op: f"_runtime.{op}" for op in WRAPS},
    "poison": "_runtime.poison",
    "status": "_runtime.status",
}
COMMON = "Where nothing vanishes; last, whether something does."
DTYPES = {"real": "np.float64", "status": "np.uint8", "bool": "np.bool_"}


class NumpyPrinter(Printer):
    """NumPy code of a kernel over planes."""

    has_meaning = staticmethod(in_python)

    def constant(self, text: str) -> Text:
        return Text(text)

    def call(self, op: str, args: list[str], node: Node) -> Text:
        if op == "nan":
            return Text("np.nan")
        if op in ("true", "false"):
            return Text(f"np.{op.capitalize()}_")
        if op == "tolerance":
            return Text(f"_runtime.{str(node.payload).upper()}")
        if op == "finite":
            tests = [f"np.isfinite({a})" for a in args]
            return Text(" & ".join(tests), LOGIC if len(tests) > 1 else ATOM)
        return Text(f"{CALLS[op]}({', '.join(args)})")


@dataclass(frozen=True)
class NumpyKernel:
    """The plain strings of one program."""

    name: str
    comment: str
    arguments: str
    lines: tuple[str, ...]
    values: tuple[str, ...]


@dataclass(frozen=True)
class NumpyFunction:
    """The plain strings of one function, for the template."""

    name: str
    signature: str
    arguments: str
    returns: str
    wrap: str
    docstring: str
    kernels: tuple[NumpyKernel, ...]
    inputs: str
    outputs: str
    used: str
    common: str
    size: str


def module(derivation: Derivation, lowered: Mapping[str, Lowered]) -> dict[str, Any]:
    """The context of ``numpy/module.py.jinja``."""
    return {
        "banner": banner(derivation, lowered, "#"),
        "interface": interface(derivation),
        "functions": [_function(derivation, f, lowered[f.name]) for f in derivation.functions],
    }


def runtime() -> dict[str, Any]:
    """The context of ``numpy/_runtime.py.jinja``."""
    return {name: repr(getattr(DOUBLE, name)) for name in GENERATED} | {"sines": sines}


def _function(derivation: Derivation, function: Function, program: Lowered) -> NumpyFunction:
    kernels = [_kernel(f"_{function.name}", "", program)]
    if program.common is not None:
        kernels.append(_kernel(f"_{function.name}_common", COMMON, program.common))
    returns = f'"{function.result}"' if function.result else "Any"
    return NumpyFunction(
        function.name,
        call_signature(function),
        tuple_code(a.name for a in function.inputs),
        returns,
        f"{function.result}(*result)" if function.result else "result",
        textwrap.indent("\n".join(docstring(derivation, function, WIDTH - 4)), "    ").strip(),
        tuple(kernels),
        _arrays((a.name, a.shape, "real") for a in function.inputs),
        _arrays((r.name, r.shape, r.kind) for r in program.results),
        repr(program.parameters),
        kernels[-1].name if program.common else "",
        _size(program),
    )


def _size(program: Lowered) -> str:
    """The code for the size: the planes that are lengths, the degrees and the range of sizes."""
    if program.degrees is None or not program.is_scaled:
        return ""
    entries = [str(e) for a in program.inputs for e in a.entries] + list(program.parameters)
    lengths = tuple(k for k, name in enumerate(entries) if name in program.degrees.lengths)
    flat = [d for row in program.degrees.results for d in row]
    degrees = tuple((k, d) for k, d in enumerate(flat) if d)
    least, most = DOUBLE.sizes(program.degrees.highest)
    return f"_runtime.Size({lengths!r}, {degrees!r}, {least!r}, {most!r})"


def _kernel(name: str, comment: str, program: Lowered) -> NumpyKernel:
    printer = NumpyPrinter(program)
    results = printer.run()
    lines = []
    needed = {(n.op, n.args[0].id) for n in program.schedule() if n.op in ("sin", "cos")}
    deciding = program.deciding_angles()
    for angle, sine, cosine in printer.trig:
        code = printer.text[angle.id].code
        if angle.id in deciding:
            lines.append(f"{sine}, {cosine} = _runtime.sincos_as_in_c({code})")
        elif {("sin", angle.id), ("cos", angle.id)} <= needed:
            lines.append(f"{sine}, {cosine} = _runtime.sincos({code})")
        elif ("sin", angle.id) in needed:
            lines.append(f"{sine} = np.sin({code})")
        else:
            lines.append(f"{cosine} = np.cos({code})")
    for angle, principal in printer.turned:
        lines.append(f"{principal} = _runtime.principal({printer.text[angle.id].code})")
    lines += [f"{line.name} = {line.code}" for line in printer.lines]
    values = [v for result in results for v in result]
    used = program.used_inputs()
    entries = [str(e) for a in program.inputs for e in a.entries] + list(program.parameters)
    arguments = ", ".join(printer.inputs[e] if e in used else f"_{e}" for e in entries)
    return NumpyKernel(
        name,
        comment,
        _wrapped(arguments, f"def {name}():"),
        tuple(_until_last_use(lines, values)),
        tuple(values),
    )


def _until_last_use(lines: Sequence[str], values: Sequence[str]) -> Iterator[str]:
    """The lines, each followed by the deletion of values that no later line uses.

    The next array then reuses memory that is still in the cache.
    """
    name = re.compile(r"\b[A-Za-z_]\w*")
    made = {n for line in lines for n in name.findall(line.partition(" = ")[0])}
    later = made.intersection(n for value in values for n in name.findall(value))
    spent: list[list[str]] = []
    for line in reversed(lines):
        used = made.intersection(name.findall(line))
        spent.append(sorted(used - later))
        later |= used
    for line, names in zip(lines, reversed(spent), strict=True):
        yield line
        if names:
            yield f"del {', '.join(names)}"


def _wrapped(arguments: str, around: str) -> str:
    """An argument list, on separate lines if it is too long."""
    if len(arguments) + len(around) <= WIDTH:
        return arguments
    return "\n" + textwrap.indent(textwrap.fill(arguments, WIDTH - 4), "    ") + "\n"


def _arrays(specs: Any) -> str:
    items = []
    for name, shape, kind in specs:
        dtype = "" if kind == "real" else f", {DTYPES[kind]}"
        items.append(f'_runtime.Array("{name}", {shape!r}{dtype})')
    return tuple_code(items)


def tuple_code(items: Iterable[str]) -> str:
    """The Python code of a tuple, on one line."""
    listed = list(items)
    return f"({listed[0]},)" if len(listed) == 1 else f"({', '.join(listed)})"
