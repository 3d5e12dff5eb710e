"""The context of the templates of a JavaScript module."""

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
class Compute:
    """The plain strings of one program."""

    name: str
    lines: tuple[str, ...]


@dataclass(frozen=True)
class Kernel:
    """The plain strings of a program with its common case, and its data for the runtime."""

    name: str
    constant: str
    programs: tuple[Compute, ...]
    compute: str
    common: str
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    used: str
    size: str


@dataclass(frozen=True)
class ModuleFunction:
    """The plain strings of one function.

    ``arguments`` are those of a single call but the parameters, ``results`` what a batch takes
    beside them.
    """

    name: str
    kernel: Kernel
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
    inverse = next((f for f in derivation.functions if f.name == "ik"), None)
    return {
        "banner": banner(derivation, lowered, "//"),
        "interface": described,
        "mechanism": described.mechanism.split("\n"),
        "labels": [(name, _strings(values)) for name, values in labels.items()],
        "given": inverse.inputs[1].name if inverse and len(inverse.inputs) == 2 else "",
        "limits": [[repr(v).replace("inf", "Infinity") for v in side] for side in limits],
        "functions": [_function(derivation, f, lowered[f.name]) for f in derivation.functions],
    }


def _function(derivation: Derivation, function: Function, program: Lowered) -> ModuleFunction:
    branches = len(function.branches) if function.branches else 0
    return ModuleFunction(
        name=function.name,
        kernel=kernel(function.name, program, branches),
        doc=tuple(single_doc(derivation, function, WIDTH - 3)),
        batch_doc=tuple(batch_doc(function, program, WIDTH - 3)),
        arguments=", ".join(a.name for a in function.inputs),
        results=", ".join(r.name for r in program.results),
    )


def kernel(name: str, program: Lowered, branches: int = 0) -> Kernel:
    """The context of ``js/kernel.js.jinja`` for a program with so many branches."""
    programs = [_compute(f"_{name}", program)]
    if program.common is not None:
        programs.append(_compute(f"_{name}_common", program.common))
    results = [(r.name, r.shape[1:] if branches else r.shape, r.kind) for r in program.results]
    return Kernel(
        name=name,
        constant=f"_{name.upper()}",
        programs=tuple(programs),
        compute=programs[0].name,
        common=programs[-1].name if program.common else "null",
        inputs=tuple(_spec(a.name, a.shape, 0, "real") for a in program.inputs),
        outputs=tuple(_spec(result, shape, branches, kind) for result, shape, kind in results),
        used=_strings(program.parameters),
        size=_size(program),
    )


def _compute(name: str, program: Lowered) -> Compute:
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
    return Compute(name, tuple(_wrapped(lines)))


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
