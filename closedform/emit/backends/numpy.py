"""NumPy: a module for each robot, and the runtime that they share."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from closedform.emit import sines
from closedform.emit.backend import Backend, Files, Mechanism, Pages, runtime
from closedform.emit.code import ATOM, LOGIC, Printer, Text, call, word
from closedform.emit.docstring import docstring
from closedform.emit.python import argument_list, kernel_arguments, tuple_code
from closedform.emit.render import render
from closedform.emit.sizes import Size
from closedform.emit.text import WIDTH, banner, call_signature, interface
from closedform.lower import Lowered
from closedform.lower.graph import Node
from closedform.model.derivation import Derivation
from closedform.model.functions import Function
from closedform.model.names import in_python
from closedform.model.tolerances import DOUBLE, GENERATED

COMMON = "Where nothing vanishes; last, whether something does."
DTYPES = {"real": "np.float64", "status": "np.uint8", "bool": "np.bool_"}


class NumpyPrinter(Printer):
    """NumPy code of a kernel over planes."""

    has_meaning = staticmethod(in_python)

    nan, true, false = word("np.nan"), word("np.True_"), word("np.False_")
    sqrt, atan2 = call("np.sqrt"), call("np.arctan2")
    abs, max, min = call("np.abs"), call("np.maximum"), call("np.minimum")
    not_ = call("np.logical_not")
    sign, select = call("_runtime.sign"), call("_runtime.select")
    wrap, wrap_cut = call("_runtime.wrap"), call("_runtime.wrap_cut")
    poison, status = call("_runtime.poison"), call("_runtime.status")

    def tolerance(self, node: Node) -> Text:
        return Text(f"_runtime.{str(node.payload).upper()}")

    def finite(self, node: Node, *args: Text) -> Text:
        tests = [f"np.isfinite({a.code})" for a in args]
        return Text(" & ".join(tests), LOGIC if len(tests) > 1 else ATOM)


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


def _numbers() -> list[str]:
    """The tolerances, and the sine and cosine by the operations of the C."""
    turns, limit, shift = sines.RIGHT_ANGLE, sines.LIMIT, sines.ROUND
    return [
        "".join(f"{name.upper()} = {getattr(DOUBLE, name)!r}\n" for name in GENERATED),
        f"    wide = size > {limit}\n",
        f"    wide = np.abs(angle) > {limit}\n",
        f"    if size > {limit}:\n",
        f"    shifted = size * {sines.RIGHT_ANGLES}\n"
        f"    shifted += {shift}\n    n = shifted - {shift}\n",
        f"    part = n * {turns[1]}\n    tail = size - n * {turns[0]}\n",
        f"    n *= {turns[2]}\n",
        *(_polynomial(name, c) for name, c in (("sine", sines.SINE), ("cosine", sines.COSINE))),
        f"    near = angle - turns * (4 * {turns[0]})\n    near -= turns * (4 * {turns[1]})\n"
        f"    turns *= 4 * {turns[2]}\n",
    ]


def _polynomial(name: str, c: Sequence[float]) -> str:
    return (
        f"    {name} = z * {c[5]}\n    {name} += {c[4]}\n    {name} *= z2\n"
        f"    part = z * {c[3]}\n    part += {c[2]}\n    {name} += part\n    {name} *= z2\n"
        f"    part = z * {c[1]}\n    part += {c[0]}\n    {name} += part\n"
    )


def _function(derivation: Derivation, function: Function, program: Lowered) -> NumpyFunction:
    kernels = [_kernel(f"_{function.name}", "", program)]
    if program.common is not None:
        kernels.append(_kernel(f"_{function.name}_common", COMMON, program.common))
    returns = f'"{function.result}"' if function.result else "Any"
    return NumpyFunction(
        name=function.name,
        signature=call_signature(function),
        arguments=tuple_code(a.name for a in function.inputs),
        returns=returns,
        wrap=f"{function.result}(*result)" if function.result else "result",
        docstring=textwrap.indent(
            "\n".join(docstring(derivation, function, WIDTH - 4)), "    "
        ).strip(),
        kernels=tuple(kernels),
        inputs=_arrays((a.name, a.shape, "real") for a in function.inputs),
        outputs=_arrays((r.name, r.shape, r.kind) for r in program.results),
        used=repr(program.parameters),
        common=kernels[-1].name if program.common else "",
        size=_size(program),
    )


def _size(program: Lowered) -> str:
    """The code for the size: the planes that are lengths, the degrees and the range of sizes."""
    size = Size.of(program)
    if size is None:
        return ""
    return f"_runtime.Size({size.lengths!r}, {size.degrees!r}, {size.least!r}, {size.most!r})"


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
    return NumpyKernel(
        name,
        comment,
        argument_list(kernel_arguments(printer, program), name, WIDTH),
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


def _arrays(specs: Any) -> str:
    items = []
    for name, shape, kind in specs:
        dtype = "" if kind == "real" else f", {DTYPES[kind]}"
        items.append(f'_runtime.Array("{name}", {shape!r}{dtype})')
    return tuple_code(items)


class Numpy(Backend):
    runner = "python"

    def pages(self, mechanism: Mechanism) -> Pages:
        context = module(mechanism.derivation, mechanism.lowered)
        path = Path("numpy", f"{mechanism.derivation.name}.py")
        return Pages({path: render("numpy/module.py.jinja", context)})

    def shared(self, shares: Sequence[Any]) -> Files:
        return {Path("numpy", "_runtime.py"): runtime("numpy/_runtime.py", _numbers())}

    def first_file(self, robot: str) -> Path:
        return Path("numpy", f"{robot}.py")


BACKEND = Numpy()
