"""Prints a derivation as C99: a header and a source for each robot, and the table for Python.

A function with many flags has three kernels: one for all cases, which few postures need, one for
the case that nothing vanishes, and one for a single branch of that case, so that a single call can
compute all branches as the lanes of vectors.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from closedform.emit.backends.c.comment import comment
from closedform.emit.backends.c.kernel import CArray, CProgram, Emission
from closedform.emit.backends.c.size import CSize, size_of
from closedform.emit.docstring import docstring
from closedform.emit.text import WIDTH, banner, interface
from closedform.lower import Lowered
from closedform.model.derivation import Derivation
from closedform.model.functions import Function


@dataclass(frozen=True)
class CBranch:
    """One branch of the common case, for all branches of a posture as the lanes of vectors."""

    program: CProgram
    n: int
    signs: tuple[str, ...]
    loads: tuple[str, ...]
    stores: tuple[str, ...]
    collected: tuple[str, ...]
    kernel_call: str


@dataclass(frozen=True)
class CFunction:
    """The plain strings of one function, for the templates.

    If there is a common case, its rare postures are passed on to ``whole``.
    """

    name: str
    full: str
    comment: str
    doc_lines: tuple[str, ...]
    result: str
    n_params: int
    inputs: tuple[CArray, ...]
    outputs: tuple[CArray, ...]
    whole: CProgram
    common: CProgram | None
    branch: CBranch | None
    size: CSize | None
    arguments: str
    block_arguments: str
    gathered_arguments: str
    table_single: str
    table_batch: str


def robot(derivation: Derivation, lowered: Mapping[str, Lowered]) -> dict[str, Any]:
    """The context of the header and the source of one robot."""
    return {
        "name": derivation.name,
        "banner": banner(derivation, lowered, " *"),
        "interface": interface(derivation),
        "field_names": ", ".join(f'"{p.name}"' for p in derivation.parameters),
        "functions": [_function(derivation, f, lowered[f.name]) for f in derivation.functions],
    }


def _function(derivation: Derivation, function: Function, program: Lowered) -> CFunction:
    full = f"{derivation.name}_{function.name}"
    parts = program.common is not None
    whole = Emission(derivation, function, program, f"{full}_whole" if parts else full)
    common = branch = None
    if program.common is not None:
        common = Emission(derivation, function, program.common, f"{full}_common").emit()
    if program.branch is not None:
        branch = _branch(derivation, function, program.branch, f"{full}_branch")
    inputs, outputs = whole.inputs, whole.outputs
    arrays = (*inputs, *outputs)
    call = f"(const {derivation.name}_params *)params"
    return CFunction(
        name=function.name,
        full=full,
        comment="\n".join(f" * {x}".rstrip() for x in comment(derivation, function, WIDTH - 3)),
        doc_lines=tuple(f"{x}\n" for x in docstring(derivation, function, WIDTH - 4)),
        result=function.result or "",
        n_params=len(derivation.parameters),
        inputs=inputs,
        outputs=outputs,
        whole=whole.emit(),
        common=common,
        branch=branch,
        size=size_of(derivation, program, inputs, outputs),
        arguments=", ".join(["params", *(a.name for a in arrays)]),
        block_arguments=", ".join(
            ["params", *(f"{a.name} + start, {a.name}_stride" for a in arrays)]
        ),
        gathered_arguments=", ".join(["params", *(f"{a.name}_i" for a in arrays)]),
        table_single=_table_call(call, inputs, outputs, "in[{k}]", "out[{k}]"),
        table_batch=_table_call(
            f"n, {call}", inputs, outputs, "in[{k}], in_stride[{k}]", "out[{k}], out_stride[{k}]"
        ),
    )


def _branch(derivation: Derivation, function: Function, program: Lowered, full: str) -> CBranch:
    emission = Emission(derivation, function, program, full, branch=True)
    signs = emission.inputs[-1]
    assert function.branches
    rows = [[b[s] for b in function.branches.signs] for s in function.branches.signs[0]]
    n = len(function.branches)
    listed = ", ".join(f"signs[{k}][i]" for k in range(signs.size))
    read = [a.name for a in emission.raw if a is not signs]
    return CBranch(
        program=emission.emit(),
        n=n,
        signs=tuple("{ " + ", ".join(f"CLOSEDFORM_C({v}.0)" for v in row) + " }" for row in rows),
        loads=(
            f"const real_t signs_i[{signs.size}] = {{ {listed} }};",
            *(f"real_t {o.name}_i[{o.size}];" for o in emission.outputs),
        ),
        stores=tuple(
            f"{o.name}_lanes[{k}][i] = {o.name}_i[{k}];"
            for o in emission.outputs
            for k in range(o.size)
        ),
        collected=tuple(
            f"{o.name}[{f'{o.size} * i' if o.size > 1 else 'i'}{f' + {k}' if k else ''}] = "
            f"{'' if o.kind == 'CF_REAL' else f'({o.type})'}{o.name}_lanes[{k}][i];"
            for o in emission.outputs[:-1]
            for k in range(o.size)
        ),
        kernel_call=emission.call(
            emission.leading("0"),
            "&local",
            read,
            ["signs_i"],
            emission.trig,
            [f"{o.name}_i" for o in emission.outputs],
        ),
    )


def _table_call(
    first: str, inputs: Sequence[CArray], outputs: Sequence[CArray], source: str, target: str
) -> str:
    read = [source.format(k=k) for k in range(len(inputs))]
    return ", ".join([first, *read, *(target.format(k=k) for k in range(len(outputs)))])
