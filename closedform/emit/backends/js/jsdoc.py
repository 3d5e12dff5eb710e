"""The documentation of functions in a JavaScript module, with their types."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import prod

from closedform.emit.docstring import Item, Wording, inputs_of, notes, opening, results_of
from closedform.emit.text import wrapped
from closedform.lower import Lowered
from closedform.model.derivation import Derivation
from closedform.model.functions import Function

RAISES = (
    ("TypeError", "If an argument does not hold numbers, or a parameter is not known."),
    ("RangeError", "If an argument has the wrong length."),
)


def _kind(dtype: str, branches: int, shape: Sequence[int]) -> str:
    """The type of an array; that of an input is ``given``, and a scalar input is a number."""
    if dtype == "given":
        return "ArrayLike<number>" if shape else "number"
    return dtype + "[]" * (bool(shape) + bool(branches))


JAVASCRIPT = Wording("given", "number", "boolean", "number", _kind)


def single_doc(derivation: Derivation, function: Function, width: int) -> Iterator[str]:
    """The lines of the documentation of a function of one posture."""
    yield from opening(function, width)
    yield from _notes(derivation, function, width)
    yield ""
    inputs = inputs_of(derivation, function, JAVASCRIPT)
    for item, array in zip(inputs, function.inputs, strict=True):
        yield from _tag(
            f"@param {{{item.kind}}} {item.name}", f"{_shape(array.shape)}{item.text}", width
        )
    yield from _tag(
        "@param {Parameters} [parameters]",
        "The dimensions; one that is missing has its default.",
        width,
    )
    results = results_of(derivation, function, JAVASCRIPT)
    branches = len(function.branches) if function.branches else 0
    shapes = [_shape(a.shape, branches) for a in function.outputs]
    shapes += [""] * (len(results) - len(shapes))
    texts = [f"{shape}{item.text}" for shape, item in zip(shapes, results, strict=True)]
    if len(results) > 1:
        texts = [f"`{item.name}`: {text}" for item, text in zip(results, texts, strict=True)]
    yield from _tag(f"@returns {{{_record(results)}}}", " ".join(texts), width)
    for error, text in RAISES:
        yield from _tag(f"@throws {{{error}}}", text, width)


def _notes(derivation: Derivation, function: Function, width: int) -> Iterator[str]:
    """The notes as a list, without the heading of numpydoc."""
    lines = list(notes(derivation, function, width, JAVASCRIPT))
    if lines:
        yield ""
        yield from lines[3:]


def batch_doc(function: Function, program: Lowered, width: int) -> Iterator[str]:
    """The lines of the documentation of a function of n postures."""
    inputs = [(a.name, prod(a.shape)) for a in function.inputs]
    outputs = [
        (r.name, prod(r.shape), "Float64Array" if r.kind == "real" else "Uint8Array")
        for r in program.results
    ]
    place = inputs[0][0] if inputs else outputs[0][0]
    yield from wrapped(
        f"`{function.name}` of n postures, as planes: number k of posture i is at "
        f"`{place}[k * n + i]`.",
        width,
    )
    yield ""
    yield "@param {number} n"
    for name, size in inputs:
        yield f"@param {{Float64Array}} {name} {_times_n(size)}"
    for name, size, dtype in outputs:
        yield f"@param {{{dtype}}} [{name}] {_times_n(size)}, to write to; allocated if omitted"
    yield "@param {Parameters} [parameters] the same for all postures"
    items = [Item(name, dtype, "") for name, _, dtype in outputs]
    yield f"@returns {{{_record(items)}}} the results"


def _record(items: Sequence[Item]) -> str:
    """The type of what is returned: of several results an object."""
    if len(items) == 1:
        return items[0].kind
    return f"{{ {', '.join(f'{item.name}: {item.kind}' for item in items)} }}"


def _shape(shape: Sequence[int], branches: int = 0) -> str:
    """How many numbers there are, in words that go before a sentence."""
    each = f"{branches} branch{'es' if branches > 1 else ''}" if branches else ""
    if not shape:
        return f"One number for each of {each}. " if branches > 1 else ""
    n = prod(shape)
    size = f"{n} number{'s' if n > 1 else ''}"
    if len(shape) > 1:
        size += f" ({' x '.join(map(str, shape))} in row order)"
    return f"{each} of {size}. " if each else f"{size[:1].upper()}{size[1:]}. "


def _times_n(size: int) -> str:
    return f"{size} n numbers" if size > 1 else "n numbers"


def _tag(tag: str, text: str, width: int) -> list[str]:
    return wrapped(f"{tag} {text}".strip(), width, rest="    ")
