"""How the values of a program scale with the size of the mechanism.

If all lengths double, an angle does not change, a distance doubles and an area becomes four times
as large: their degrees are 0, 1 and 2.  The degrees follow from the program itself, because the
operands of a sum or a comparison have the same degree and the argument of a sine has degree 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from math import ceil
from typing import TypeAlias

from closedform.lower.graph import Node, constant_of, reachable
from closedform.lower.operators import BOOLEAN

NUMBERS = frozenset({"", "-", "1", "deg", "degree", "degrees", "rad", "radian", "radians"})
"""The units of parameters that are not lengths."""

EQUAL_DEGREES = frozenset({"add", "sub", "max", "min", "neg", "abs"})
"""Operators whose operands and value all have one degree."""
COMPARISONS = frozenset({"lt", "le", "eq"})
"""Conditions whose operands have one degree."""
OF_ANGLES = frozenset({"sin", "cos", "principal", "wrap", "wrap_cut"})
"""Operators of an angle, whose degree is 0."""
WITHOUT_DEGREE = OF_ANGLES | {"atan2", "tolerance", "sign", "status"}
"""Operators whose value has the degree 0."""
LEAVES = frozenset({"const", "nan", "poison", "input"})
"""Inputs and numbers; also NaN where a condition holds."""

Degree: TypeAlias = "dict[str, Fraction]"
"""A sum of the unknown degrees of inputs; the name ``""`` stands for the number 1."""

ZERO, ONE = Fraction(0), Fraction(1)


class MixedError(ValueError):
    """The program adds or compares values of different degrees."""


@dataclass(frozen=True)
class Degrees:
    """The inputs that are lengths, the degree of every entry of the results, and the highest.

    The highest is the largest absolute value of a degree, intermediate values included.  A length
    has degree 0 if it is only added to lengths of its own kind, such as heights, and these are
    never combined with lengths that are multiplied: it may be of any size.
    """

    lengths: frozenset[str]
    results: tuple[tuple[int, ...], ...]
    highest: int


def degrees(
    results: Sequence[Sequence[Node]],
    known: Mapping[str, int],
    preferred: Sequence[str],
    lengths: Iterable[Node] = (),
) -> Degrees | None:
    """The degrees of a program, or None if it has none, for example with a constant length in it.

    ``known`` contains degrees of inputs.  The inputs in ``preferred`` are lengths unless the
    program excludes it; the others are lengths only if the program requires it.  The nodes in
    ``lengths`` are results of degree 1.
    """
    roots = [n for nodes in results for n in nodes]
    nodes = list(reachable(roots))
    inputs = [str(n.payload) for n in nodes if n.op == "input"]
    system = _System()
    try:
        for name in inputs:
            if name in known:
                system.equate({name: ONE}, {"": Fraction(known[name])})
        degree_of = _NodeDegrees(system)
        for node in nodes:
            degree_of.add(node)
        for node in lengths:
            if (degree := degree_of[node]) is not None:
                system.equate(degree, {"": ONE})
    except MixedError:
        return None
    for name in [name for name in preferred if name in inputs]:
        system.prefer(name, 1)
    for name in inputs:
        system.prefer(name, 0)
    taken = {name: system.value({name: ONE}) for name in inputs}
    listed = [[system.value(degree_of[n]) for n in row] for row in results]
    values = {i: system.value(d) for i, d in degree_of.found.items()}
    unscaled = _unscaled(nodes, values)
    taken |= {str(n.payload): Fraction(0) for n in nodes if n.op == "input" and n.id in unscaled}
    listed = [
        [Fraction(0) if n.id in unscaled else d for n, d in zip(nodes_of, row, strict=True)]
        for nodes_of, row in zip(results, listed, strict=True)
    ]
    if any(d not in (0, 1) for d in taken.values()) or any(
        d.denominator != 1 for row in listed for d in row
    ):
        return None
    return Degrees(
        frozenset(name for name, d in taken.items() if d == 1),
        tuple(tuple(int(d) for d in row) for row in listed),
        ceil(max(map(abs, values.values()), default=0)),
    )


def _unscaled(nodes: Sequence[Node], degree: Mapping[int, Fraction]) -> set[int]:
    """Nodes that only meet values of their own degree and have no powers: any size will do."""
    group = {n.id: n.id for n in nodes if degree[n.id]}

    def find(i: int) -> int:
        while group[i] != i:
            group[i] = i = group[group[i]]
        return i

    for node in nodes:
        met = [n.id for n in (node, *node.args) if n.id in group and node.op != "finite"]
        for other in met[1:]:
            group[find(other)] = find(met[0])
    powers = {find(i) for i in group if abs(degree[i]) > 1}
    return {i for i in group if find(i) not in powers} if powers else set()


@dataclass
class _System:
    """Linear equations between unknown degrees, solved one after another."""

    solved: dict[str, Degree] = field(default_factory=dict)
    _values: dict[tuple[tuple[str, Fraction], ...], Fraction] = field(default_factory=dict)
    """The values of degrees so far; most nodes share one of a few degrees."""

    def reduced(self, degree: Degree) -> Degree:
        """The same degree in terms of those that are still free."""
        result: Degree = {}
        for name, factor in degree.items():
            for other, f in self.solved.get(name, {name: ONE}).items():
                result[other] = result.get(other, ZERO) + factor * f
        return {name: f for name, f in result.items() if f}

    def equate(self, a: Degree, b: Degree) -> None:
        if a == b:
            return
        difference = self.reduced(_combined(a, b, -1))
        free = next((name for name in difference if name), None)
        if free is None:
            if difference:
                raise MixedError
            return
        self._values.clear()
        factor = difference.pop(free)
        self.solved[free] = {name: -f / factor for name, f in difference.items()}
        self.solved = {name: self.reduced(value) for name, value in self.solved.items()}

    def prefer(self, name: str, degree: int) -> None:
        """Give an input this degree if its degree is still free."""
        if any(self.reduced({name: ONE})):
            self.equate({name: ONE}, {"": Fraction(degree)})

    def value(self, degree: Degree | None) -> Fraction:
        """The value of a degree when nothing is free any more; the degree of zero counts as 0."""
        key = tuple(degree.items()) if degree else ()
        if key not in self._values:
            self._values[key] = self.reduced(dict(key)).get("", ZERO)
        return self._values[key]


def _combined(a: Degree, b: Degree, factor: int) -> Degree:
    """``a + factor * b``."""
    if not b:
        return a
    names = dict.fromkeys([*a, *b])
    total = {n: a.get(n, ZERO) + factor * b.get(n, ZERO) for n in names}
    return {name: f for name, f in total.items() if f}


def _of_leaf(node: Node) -> Degree | None:
    """The degree of an input or a number; that of zero and of NaN is not determined."""
    if node.op == "input":
        return {str(node.payload): ONE}
    return {} if node.op == "const" and node.payload != 0 else None


class _NodeDegrees:
    """The degree of every node so far; None for zero and NaN, which may have any degree."""

    def __init__(self, system: _System) -> None:
        self.system = system
        self.found: dict[int, Degree | None] = {}

    def __getitem__(self, node: Node) -> Degree | None:
        return self.found[node.id]

    def add(self, node: Node) -> None:
        """Derive the degree of a node from those of its operands."""
        self.found[node.id] = self._degree(node)

    def _degree(self, node: Node) -> Degree | None:
        op, args = node.op, node.args
        if op in EQUAL_DEGREES:
            return self._equal(args)
        if op in BOOLEAN:
            if op in COMPARISONS:
                self._equal(args)
            return None
        if op in WITHOUT_DEGREE:
            self._require_numbers(op, args)
            return {}
        if op in LEAVES:
            return _of_leaf(node)
        if op in ("mul", "div"):
            a, b = self[args[0]], self[args[1]]
            return None if a is None or b is None else _combined(a, b, 1 if op == "mul" else -1)
        if op == "sqrt":
            square = self[args[0]]
            return square and {name: f / 2 for name, f in square.items()}
        if op == "select":
            # A constant instead of a length selects a direction if every direction is valid.
            return self._equal([n for n in args[1:] if constant_of(n) is None] or args[1:])
        raise TypeError(f"the degree of {op} is not known")

    def _require_numbers(self, op: str, args: Sequence[Node]) -> None:
        """What the operands of an operator need whose result has no degree."""
        if op == "atan2":
            self._equal(args)
        elif op in OF_ANGLES and (angle := self[args[0]]) is not None:
            self.system.equate(angle, {})

    def _equal(self, args: Iterable[Node]) -> Degree | None:
        """The degree that all of these have."""
        listed = [d for n in args if (d := self[n]) is not None]
        for other in listed[1:]:
            self.system.equate(listed[0], other)
        return listed[0] if listed else None
