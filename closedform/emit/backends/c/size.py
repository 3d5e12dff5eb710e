"""The C code for mechanisms of any size, which computes them at a size near 1.

The size is the largest length of a posture and its mechanism.  If powers of it might leave the
range of the type, all lengths are first multiplied by a power of two, which is exact.  The results
are then multiplied by the powers for their degrees.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from closedform.emit.backends.c.kernel import CArray, folded
from closedform.lower import Lowered
from closedform.model.derivation import Derivation


@dataclass(frozen=True)
class CScaled:
    """An array that is multiplied by powers of the size, and the power of every entry."""

    name: str
    size: int
    degrees: str


@dataclass(frozen=True)
class CSize:
    """The plain strings of one function: how its size is computed, and what scales with it."""

    limits: str
    single: str
    dimensions: str
    posture: str
    excess: str
    unused: tuple[str, ...]
    arguments: str
    block_arguments: str
    other: str
    planes: str
    parameters: tuple[str, ...]
    inputs: tuple[CScaled, ...]
    outputs: tuple[CScaled, ...]


def size_of(
    derivation: Derivation,
    program: Lowered,
    inputs: Sequence[CArray],
    outputs: Sequence[CArray],
) -> CSize | None:
    """The strings for the size of a function; None if no power of it can leave the range."""
    if program.degrees is None or not program.is_scaled:
        return None
    lengths = program.degrees.lengths
    parameters = tuple(p.name for p in derivation.parameters if p.name in lengths)
    of_inputs = [
        (a, [int(str(e) in lengths) for e in argument.entries])
        for a, argument in zip(inputs, program.inputs, strict=True)
    ]
    entries = [(a, k) for a, degrees in of_inputs for k, one in enumerate(degrees) if one]
    taken = [a for a, degrees in of_inputs if any(degrees)]
    dimensions = [f"params->{name}" for name in parameters]
    results = zip(outputs, program.degrees.results, strict=True)
    return CSize(
        limits=f"CF_SIZES_{program.degrees.highest}",
        single=_largest([*dimensions, *(f"{a.name}[{k}]" for a, k in entries)]),
        dimensions=_largest(dimensions) if dimensions else "CLOSEDFORM_C(0.0)",
        posture=_largest([f"{a.name}[{_plane(a, k)}i]" for a, k in entries], "dimensions"),
        excess=folded(
            ["const real_t dimensions", *(a.batch for a in taken), "size_t i"],
        ),
        unused=tuple(f"{a.name}_stride" for a in taken if not any(k for b, k in entries if a is b)),
        arguments=", ".join(
            ["dimensions", *(f"{a.name}, {a.name}_stride" for a in taken), "i"],
        ),
        block_arguments=", ".join(
            ["dimensions", *(f"{a.name} + start, {a.name}_stride" for a in taken), "i"],
        ),
        other=folded(
            [
                "size_t n",
                *["const real_t dimensions"] * bool(taken),
                f"const {derivation.name}_params *params",
                *(a.batch for a in (*inputs, *outputs)),
            ]
        ),
        planes=", ".join(["params", *(f"{a.name}, {a.name}_stride" for a in (*inputs, *outputs))]),
        parameters=parameters,
        inputs=tuple(_scaled(a, degrees) for a, degrees in of_inputs if any(degrees)),
        outputs=tuple(_scaled(o, degrees) for o, degrees in results if any(degrees)),
    )


def _plane(array: CArray, k: int) -> str:
    return {0: "", 1: f"{array.name}_stride + "}.get(k, f"{k} * {array.name}_stride + ")


def _scaled(array: CArray, degrees: Sequence[int]) -> CScaled:
    return CScaled(array.name, array.size, ", ".join(map(str, degrees)))


def _largest(values: Sequence[str], first: str = "") -> str:
    """The largest magnitude, computed as a tree, so that comparisons can overlap."""
    terms = [first] * bool(first) + [f"cf_abs({v})" for v in values]
    while len(terms) > 1:
        pairs = [terms[k : k + 2] for k in range(0, len(terms), 2)]
        terms = [f"cf_max({', '.join(p)})" if len(p) == 2 else p[0] for p in pairs]
    return terms[0]
