"""What the templates of a JavaScript module are filled with."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from closedform.emit.backends.js.jsdoc import batch_doc, single_doc
from closedform.emit.backends.js.printer import JavaScriptPrinter
from closedform.emit.escape import javascript_string
from closedform.emit.sizes import Size, arguments
from closedform.emit.text import WIDTH, banner, interface
from closedform.lower import Lowered
from closedform.model.derivation import Derivation
from closedform.model.functions import Function


@dataclass(frozen=True)
class Kernel:
    """The plain strings of one program."""

    name: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class ModuleFunction:
    """The plain strings of one function.

    ``arguments`` are those of a single call but the parameters, ``results`` what a batch takes
    beside them.
    """

    name: str
    constant: str
    kernels: tuple[Kernel, ...]
    common: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    used: str
    size: str
    doc: tuple[str, ...]
    batch_doc: tuple[str, ...]
    arguments: str
    results: str


def module(derivation: Derivation, lowered: Mapping[str, Lowered]) -> dict[str, Any]:
    """The context of ``js/module.js.jinja``."""
    described = interface(derivation)
    labels = {
        "ASSEMBLY_MODES": derivation.assembly_modes,
        "JOINTS": [s.name for s in derivation.actuated],
        "TASK": derivation.task,
        "BRANCHES": derivation.branches,
        "SINGULARITIES": derivation.singularities,
    }
    limits = derivation.limits or ()
    return {
        "banner": banner(derivation, lowered, "//"),
        "interface": described,
        "mechanism": described.mechanism.split("\n"),
        "labels": [(name, _strings(values)) for name, values in labels.items()],
        "limits": [[repr(v).replace("inf", "Infinity") for v in side] for side in limits],
        "functions": [_function(derivation, f, lowered[f.name]) for f in derivation.functions],
    }


def _function(derivation: Derivation, function: Function, program: Lowered) -> ModuleFunction:
    kernels = [_kernel(f"_{function.name}", program)]
    if program.common is not None:
        kernels.append(_kernel(f"_{function.name}_common", program.common))
    branches = len(function.branches) if function.branches else 0
    results = [(r.name, r.shape[1:] if branches else r.shape, r.kind) for r in program.results]
    names = [a.name for a in function.inputs]
    return ModuleFunction(
        function.name,
        f"_{function.name.upper()}",
        tuple(kernels),
        kernels[-1].name if program.common else "null",
        tuple(_spec(a.name, a.shape, 0, "real") for a in function.inputs),
        tuple(_spec(name, shape, branches, kind) for name, shape, kind in results),
        _strings(program.parameters),
        _size(program),
        tuple(single_doc(derivation, function, WIDTH - 3)),
        tuple(batch_doc(function, program, WIDTH - 3)),
        ", ".join(names),
        ", ".join(name for name, _, _ in results),
    )


def _kernel(name: str, program: Lowered) -> Kernel:
    printer = JavaScriptPrinter(program, reserved=["v", "o"])
    results = printer.run()
    used = program.used_inputs()
    lines = [
        f"const {printer.inputs[entry]} = v[{k}];"
        for k, entry in enumerate(arguments(program))
        if entry in used
    ]
    needed = {(n.op, n.args[0].id) for n in program.schedule() if n.op in ("sin", "cos")}
    for angle, *named in printer.trig:
        lines.append(f"_runtime.sincos({printer.text[angle.id].code});")
        lines += [
            f"const {named[k]} = _runtime.found[{k}];"
            for k, op in enumerate(("sin", "cos"))
            if (op, angle.id) in needed
        ]
    for angle, principal in printer.turned:
        lines.append(f"const {principal} = _runtime.principal({printer.text[angle.id].code});")
    lines += [f"const {line.name} = {line.code};" for line in printer.lines]
    values = [
        f"({value}) ? 1 : 0" if result.kind == "bool" else value
        for result, entries in zip(program.results, results, strict=True)
        for value in entries
    ]
    lines += [f"o[{k}] = {value};" for k, value in enumerate(values)]
    return Kernel(name, tuple(_wrapped(lines)))


def _wrapped(lines: Iterable[str]) -> Iterator[str]:
    for line in lines:
        yield from textwrap.wrap(line, WIDTH - 4, subsequent_indent="    ", break_long_words=False)


def _spec(name: str, shape: Sequence[int], branches: int, kind: str) -> str:
    """An argument or a result, as the runtime reads it."""
    return (
        f'{{ name: "{name}", shape: {list(map(int, shape))}, branches: {branches}, '
        f'kind: "{kind}" }}'
    )


def _size(program: Lowered) -> str:
    size = Size.of(program)
    if size is None:
        return "null"
    degrees = [list(d) for d in size.degrees]
    return (
        f"{{\n        lengths: {list(size.lengths)},\n        degrees: {degrees},\n"
        f"        least: {size.least!r},\n        most: {size.most!r},\n    }}"
    )


def _strings(values: Iterable[str]) -> str:
    return f"[{', '.join(javascript_string(value) for value in values)}]"
