"""The documentation of a function: by the conventions of numpydoc for Python, in parts for others.

Names, shapes and statuses follow from the function; its summary and notes say what is special.  A
language is a :class:`Wording`.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import groupby, pairwise

import sympy as sp

from closedform.emit.text import wrapped
from closedform.lower.turns import Turns
from closedform.model.derivation import Derivation
from closedform.model.functions import Array, Function, Require

LENGTH = "in the unit of the parameters"
ANGLE = "in rad"
BOUNDED = "in rad, in (-pi, pi]"
STATUSES = (
    ": OK (0) if {values} is a solution, UNREACHABLE (1) if there is no solution, SINGULAR (2) "
    "if {values} is one of infinitely many solutions or poorly determined (see the notes), and "
    "INVALID (3) if an input is not finite or not possible. {values} is NaN if the status is "
    "UNREACHABLE or INVALID."
)
TARGETS = ("fk", "pose")
"""Functions whose result is a target of the inverse."""
BY_JOINTS = ("jacobian", "jacobian_space", "jacobian_body")
"""Functions whose result is a matrix with a column for each joint."""
BY_TASK = ("jacobian_parallel", "jacobian_inverse")
"""Functions whose result is a matrix with a column for each coordinate of the task."""
RAISES = (
    ("TypeError", "If an argument does not hold real numbers."),
    ("ValueError", "If an argument has the wrong shape, or leading axes do not broadcast."),
)


@dataclass(frozen=True)
class Item:
    """An argument or a result: its name, its type, and a sentence or two."""

    name: str
    kind: str
    text: str


@dataclass(frozen=True)
class Wording:
    """How a language speaks of what a function takes and gives.

    given, real, boolean, small
        The types of inputs, of results, of truth values and of statuses.
    kind
        The type with the shape, from a type, the number of branches (0 if there is no such axis)
        and the shape of one.
    status
        What a status is called.
    quote
        What stands around code.
    constants
        Whether branches are listed in a constant of the module.
    out
        Whether a function takes arrays to write the results to.
    """

    given: str
    real: str
    boolean: str
    small: str
    kind: Callable[[str, int, Sequence[int]], str]
    status: str = "A `Status`"
    quote: str = "`"
    constants: bool = True
    out: bool = True


def python_kind(dtype: str, branches: int, shape: Sequence[int]) -> str:
    axes = ["...", *([branches] if branches else []), *shape]
    return f"{dtype}, shape ({', '.join(map(str, axes))})"


PYTHON = Wording(
    "array_like", "ndarray of float64", "ndarray of bool", "ndarray of uint8", python_kind
)


def docstring(
    derivation: Derivation, function: Function, width: int, wording: Wording = PYTHON
) -> list[str]:
    """The lines of a Python docstring."""
    dimensions = Item(
        "params",
        "Parameters, optional",
        "The dimensions. Each may be an array that broadcasts with the leading axes.",
    )
    results = results_of(derivation, function, wording)
    several = len(results) > 1
    out = Item(
        "out",
        "tuple of ndarray, optional" if several else "ndarray, optional",
        "Arrays to write the results to; they are returned."
        if several
        else "An array to write the result to; it is returned.",
    )
    arguments = [*inputs_of(derivation, function, wording), dimensions]
    raises = [Item("", name, text) for name, text in RAISES]
    return [
        *opening(function, width),
        *section("Parameters", [*arguments, out] if wording.out else arguments, width),
        *section("Returns", results, width),
        *section("Raises", raises, width),
        *notes(derivation, function, width, wording),
    ]


def opening(function: Function, width: int) -> list[str]:
    """The lines of the summary, and the source."""
    lines = wrapped(function.summary, width)
    if function.source:
        lines += ["", *wrapped(f"Source: {function.source}.", width)]
    return lines


def section(title: str, items: Sequence[Item], width: int) -> list[str]:
    """The lines of items below a heading, as numpydoc lays them out."""
    if not items:
        return []
    lines = ["", title, "-" * len(title)]
    for item in items:
        lines.append(f"{item.name} : {item.kind}" if item.name else item.kind)
        lines += wrapped(item.text, width, 4 * " ", 4 * " ")
    return lines


def notes(
    derivation: Derivation, function: Function, width: int, wording: Wording
) -> Iterator[str]:
    """The lines of the notes, with a heading if there are any."""
    labels = function.branches.labels if function.branches else ()
    listed = [" ".join(n.split()) for n in function.notes]
    if len(labels) > 1:
        constant = _labels_name(derivation, function)
        order = f"in the order of `{constant}`" if constant and wording.constants else "in order"
        kind = "assembly modes" if labels == derivation.assembly_modes else "branches"
        listed.insert(0, f"The {kind}, {order}: {', '.join(labels)}.")
    if listed:
        yield from ("", "Notes", "-----")
    for note in listed:
        yield from wrapped(note, width, "- ", "  ")


def _labels_name(derivation: Derivation, function: Function) -> str:
    """The constant of the module that names the branches of a function."""
    labels = function.branches.labels if function.branches else ()
    known = {"ASSEMBLY_MODES": derivation.assembly_modes, "BRANCHES": derivation.branches}
    return next((name for name, given in known.items() if given and given == labels), "")


# Arguments and results


def inputs_of(derivation: Derivation, function: Function, wording: Wording) -> list[Item]:
    """The arguments without the parameters."""
    return [
        Item(a.name, wording.kind(wording.given, 0, a.shape), _input_text(derivation, function, a))
        for a in function.inputs
    ]


def _input_text(derivation: Derivation, function: Function, array: Array) -> str:
    if len(array.shape) > 1:
        return _requirement(derivation, array)
    names = [str(e) for e in array.entries]
    if function.result == "Solutions" and len(names) == len(derivation.task):
        names = list(derivation.task)
    return _listed(names, _units(derivation), array.shape, ANGLE)


def results_of(derivation: Derivation, function: Function, wording: Wording) -> list[Item]:
    """The results, the status last."""
    branches = len(function.branches) if function.branches else 0
    dtype = wording.boolean if function.boolean else wording.real
    items = [
        Item(
            a.name,
            wording.kind(dtype, branches, a.shape),
            _output_text(derivation, function, a, wording),
        )
        for a in function.outputs
    ]
    if function.result:
        kind = "assembly mode" if function.result == "Positions" else "branch"
        each = f" of each {kind}" if branches > 1 else ""
        values = f"{wording.quote}{items[0].name}{wording.quote}"
        text = f"{wording.status}{each}{STATUSES.format(values=values)}"
        items.append(Item("status", wording.kind(wording.small, branches, ()), text))
    return items


def _output_text(derivation: Derivation, function: Function, array: Array, wording: Wording) -> str:
    if function.name == "singularities":
        return f"One factor for each singular set: {'; '.join(derivation.singularities)}."
    if len(array.shape) > 1:
        return _matrix_text(derivation, function, array, wording)
    joints = [s.name for s in derivation.actuated]
    inverse = next((i for i in derivation.inverses if i.function == function.name), None)
    names: Sequence[str] = ()
    if function.result == "Solutions" and inverse:
        names = [str(s) for s in inverse.unknowns]
    elif array.name == "q" and array.size == len(joints):
        names = joints
    elif function.name == "fk" and array.size == len(derivation.task):
        names = derivation.task
    reduced = [angle for _, angle in Turns.of(function, derivation).entries()]
    if names:
        return _listed(names, _units(derivation), array.shape, BOUNDED if any(reduced) else ANGLE)
    if all(reduced):
        return f"{'Angles' if array.shape else 'Angle'} {BOUNDED}."
    given = next((a for f in derivation.functions for a in f.inputs if a.name == array.name), None)
    if given and array.shape == given.shape:
        return _listed([str(e) for e in given.entries], _units(derivation), array.shape, ANGLE)
    return ""


def _requirement(derivation: Derivation, array: Array) -> str:
    """What functions of the mechanism require of an input of this shape, as a sentence."""
    for function in derivation.functions:
        for statement in function.body:
            if isinstance(statement, Require) and any(
                a.shape == array.shape
                and {*a.entries} >= {s for v in statement.values for s in v.free_symbols}
                for a in function.inputs
            ):
                return f"{statement.meaning[:1].upper()}{statement.meaning[1:]}."
    return ""


def _matrix_text(derivation: Derivation, function: Function, array: Array, wording: Wording) -> str:
    """A sentence about a matrix that is returned: what it is, or what its columns belong to."""
    if function.name == "skeleton":
        assert derivation.skeleton is not None
        order = ", in the order of `SKELETON.points`" if wording.constants else ""
        return f"Coordinates x, y, z of each point{order}: {', '.join(derivation.skeleton.points)}."
    if function.name in TARGETS and (target := _requirement(derivation, array)):
        return target
    if array.shape == (4, 4) and list(array.entries[-4:]) == [0, 0, 0, 1]:
        return "A homogeneous transform."
    joints = [s.name for s in derivation.actuated]
    columns: Sequence[str] = ()
    if function.name in BY_JOINTS:
        columns = joints
    elif function.name in BY_TASK:
        columns = derivation.task
    if len(columns) != array.shape[-1]:
        return ""
    return f"One column for {'each of ' if len(columns) > 1 else ''}{_span(columns)}."


def _listed(
    names: Sequence[str], units: Mapping[str, str], shape: Sequence[int], angle: str
) -> str:
    """Coordinates with their units; neighbours with the same unit are joined."""
    parts = []
    for unit, group in groupby(names, lambda name: units.get(name, "")):
        shown = angle if unit == ANGLE else unit
        parts.append(f"{_span(list(group))} {shown}".strip())
    if not shape:
        unit = units.get(names[0], "")
        return (
            f"{'Angle' if unit == ANGLE else 'Length'} {angle if unit == ANGLE else unit}."
            if unit
            else ""
        )
    return f"{'; '.join(parts)}."


def _span(names: Sequence[str]) -> str:
    """Names in words; "theta1 to theta6" if they are numbered consecutively."""
    numbered = [re.fullmatch(r"(\D+)(\d+)", name) for name in names]
    if len(names) > 3 and all(numbered):
        found = [(m[1], int(m[2])) for m in numbered if m]
        if all(b == (a[0], a[1] + 1) for a, b in pairwise(found)):
            return f"{names[0]} to {names[-1]}"
    return ", ".join(names)


def _units(derivation: Derivation) -> dict[str, str]:
    """The known units of joints, task coordinates and other angles."""
    units: dict[str, str] = {}
    angles = {str(s) for i in derivation.inverses for s in i.angles}
    for function in derivation.functions:
        given = set(function.symbols)
        values = [e for a in function.outputs for e in a.entries]
        for statement in function.body:
            values += [getattr(statement, "value", sp.S.Zero), *getattr(statement, "values", ())]
        turned = frozenset[sp.Symbol]().union(*map(_in_circular_functions, values))
        angles |= {str(s) for s in turned & given}
        angles |= {str(s) for e in _revolute(derivation, function) for s in e.free_symbols & given}
    for inverse in derivation.inverses:
        solver = derivation[inverse.function]
        if solver.result == "Solutions" and len(solver.symbols) == len(derivation.task):
            for symbol, name in zip(solver.symbols, derivation.task, strict=True):
                units[name] = ANGLE if str(symbol) in angles else LENGTH
    units |= dict.fromkeys(angles, ANGLE)
    units |= {j.name: ANGLE if j.kind == "revolute" else LENGTH for j in derivation.joints}
    return units


def _revolute(derivation: Derivation, function: Function) -> list[sp.Expr]:
    """What a function gives for the revolute joints, if it is linear with numbers as factors."""
    kinds = [j.kind for j in derivation.joints if j.symbol in derivation.actuated]
    found = [
        e
        for array in function.outputs
        if array.name == "q" and array.size == len(kinds)
        for e, kind in zip(array.entries, kinds, strict=True)
        if kind == "revolute"
    ]
    return [e for e in found if all(s.is_Symbol for s in e.as_coefficients_dict())]


@cache
def _in_circular_functions(expr: sp.Basic) -> frozenset[sp.Symbol]:
    """The symbols in the arguments of sines, cosines and tangents."""
    return frozenset(s for t in expr.atoms(sp.sin, sp.cos, sp.tan) for s in t.free_symbols)
