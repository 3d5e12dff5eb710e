"""Programs whose derivatives are finite: what is not selected is computed from safe operands.

Where all values are computed and then selected, the derivative of a result is a sum over all paths
to it.  A path through a value that is not selected counts with the factor zero, but zero times an
infinite derivative is NaN.  Here a quotient, a root or an arctangent that does not matter gets
other operands, the number 1, at which its derivative is finite.

A value matters where a result depends on it: unless it is on the other side of a selection, or the
branch fails.  Derivatives do not pass through conditions.  So a condition is computed from the
operands as they are, because it is what decides; a value in both is computed twice.

Safe operands are not those of any posture, so what follows from them can grow: a search of many
steps multiplies a sine that is larger than 1 with itself until it overflows, and zero times
infinity is NaN once more.  A value that is a product of many others therefore gets a guard, too.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import NamedTuple, TypeAlias

from closedform.lower.degrees import OF_ANGLES
from closedform.lower.graph import Graph, Node, constant_of, reachable
from closedform.lower.operators import BOOLEAN
from closedform.lower.program import Lowered

FLAT = frozenset({"sign", "status", "poison"})
"""Operators without a derivative, besides conditions."""


class Case(NamedTuple):
    """One side of a selection: where the selection itself matters, and the condition holds or not.

    ``within`` is the number of the cases of the selection, ``condition`` that of a node.
    """

    within: int
    condition: int
    holds: bool


Cases: TypeAlias = "frozenset[Case]"
"""Where a value matters: in any of these cases."""
ALWAYS = 0
"""The number of the cases of a value that matters always."""
FACTORS = 64
"""How many values are multiplied, at most, before a product that does not matter becomes 1.

Where that happens, powers of the size of the mechanism that are as high are computed.
"""


def finite_derivatives(program: Lowered) -> Lowered:
    """The same values, with finite derivatives wherever the status is ``OK``; no common case."""
    graph = Graph()
    copies: dict[int, Node] = {}
    for node in reachable([*program.roots, *program.angles, *program.turned]):
        args = tuple(copies[a.id] for a in node.args)
        copies[node.id] = _selected(graph, args) or graph.node(node.op, *args, payload=node.payload)
    results = [tuple(copies[n.id] for n in r.nodes) for r in program.results]
    roots = [n for nodes in results for n in nodes]
    values, high = _with_safe_operands(graph, roots)
    degrees = program.degrees
    if degrees and high:
        degrees = replace(degrees, highest=max(degrees.highest, FACTORS))
    flat = iter([values.get(n.id, n) for n in roots])
    names = {copies[i].id: name for i, name in program.names.items() if i in copies}
    names |= {values[i].id: name for i, name in names.items() if i in values}
    return replace(
        program,
        angles=tuple(copies[n.id] for n in program.angles),
        turned=tuple(copies[n.id] for n in program.turned),
        results=tuple(replace(r, nodes=tuple(islice(flat, len(r.nodes)))) for r in program.results),
        names=names,
        degrees=degrees,
        common=None,
        branch=None,
    )


def _selected(graph: Graph, args: Sequence[Node]) -> Node | None:
    """Instead of a sum with a poison: NaN if the branch fails, and else the value."""
    if len(args) == 2 and args[1].op == "poison":
        return graph.node("select", args[1].args[0], graph.node("nan"), args[0])
    return None


def _with_safe_operands(graph: Graph, roots: Sequence[Node]) -> tuple[dict[int, Node], bool]:
    """The images of all values that a result depends on, and whether one has many factors."""
    matters = _Matters(graph, roots)
    image: dict[int, Node] = {}
    factors: defaultdict[int, int] = defaultdict(int)
    high = False

    def guarded(node: Node, operand: Node) -> Node:
        return graph.select(matters.condition(matters.cases[node.id]), operand, graph.const(1))

    for node in reachable(roots):
        if node.id not in matters.cases or not node.args:
            continue
        args = [image.get(a.id, a) if _carries(node, a) else a for a in node.args]
        if node.op in ("div", "atan2") and constant_of(node.args[1]) is None:
            args[1] = guarded(node, args[1])
        elif node.op == "sqrt":
            args[0] = guarded(node, args[0])
        image[node.id] = graph.node(node.op, *args, payload=node.payload)
        factors[node.id] = _factors(node, factors) if matters.cases[node.id] != ALWAYS else 1
        if factors[node.id] > FACTORS:
            image[node.id] = guarded(node, image[node.id])
            factors[node.id], high = 0, True
    return image, high


def _factors(node: Node, known: Mapping[int, int]) -> int:
    """How many values are multiplied in a value, where it does not matter."""
    if node.op in ("sqrt", "atan2", *FLAT) or node.op in OF_ANGLES:
        return 0
    counts = [1 if a.op == "input" else known[a.id] for a in node.args]
    if node.op == "div":
        return counts[0]
    return sum(counts) if node.op == "mul" else max(counts)


def _carries(node: Node, operand: Node) -> bool:
    """Whether the derivative of a value passes to an operand."""
    return node.op not in FLAT and node.op not in BOOLEAN and operand.op not in BOOLEAN


class _Matters:
    """For every value that a derivative reaches, the number of the cases in which it matters."""

    def __init__(self, graph: Graph, roots: Sequence[Node]):
        self.graph = graph
        self.nodes = {n.id: n for n in reachable(roots)}
        self.listed: list[Cases] = [frozenset()]
        self._numbers: dict[Cases, int] = {}
        self._conditions = {ALWAYS: graph.node("true")}
        self.cases: dict[int, int] = {}
        users: defaultdict[int, set[int]] = defaultdict(set)
        for root in roots:
            if root.op not in FLAT and root.op not in BOOLEAN:
                users[root.id].add(ALWAYS)
        for node in reversed(self.nodes.values()):
            if node.id not in users:
                continue
            self.cases[node.id] = own = self._any(users[node.id])
            for k, operand in enumerate(node.args):
                if node.op == "select" and k:
                    one_side = frozenset({Case(own, node.args[0].id, k == 1)})
                    users[operand.id].add(self._number(one_side))
                elif _carries(node, operand):
                    users[operand.id].add(own)

    def condition(self, number: int) -> Node:
        """The condition that one of the cases is given."""
        if number not in self._conditions:
            sides = [self._side(case) for case in sorted(self.listed[number])]
            self._conditions[number] = self.graph.any(sides)
        return self._conditions[number]

    def _side(self, case: Case) -> Node:
        condition = self.nodes[case.condition]
        taken = condition if case.holds else self.graph.negate(condition)
        return self.graph.every([self.condition(case.within), taken])

    def _number(self, cases: Cases) -> int:
        if cases not in self._numbers:
            self._numbers[cases] = len(self.listed)
            self.listed.append(cases)
        return self._numbers[cases]

    def _any(self, numbers: Iterable[int]) -> int:
        """All these cases together; both sides of a selection make the whole of it."""
        kept: set[Case] = set()
        waiting = list(numbers)
        while waiting:
            number = waiting.pop()
            if number == ALWAYS:
                return ALWAYS
            for case in self.listed[number] - kept:
                kept.add(case)
                if case._replace(holds=not case.holds) in kept:
                    waiting.append(case.within)

        def is_within(case: Case) -> bool:
            return case.within != ALWAYS and self.listed[case.within] <= kept

        return self._number(frozenset(c for c in kept if not is_within(c)))
