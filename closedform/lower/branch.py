"""One branch of a function as nodes of a graph: its outputs and its status."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import islice

import sympy as sp

from closedform.lower.build import Builder
from closedform.lower.graph import Graph, Node
from closedform.lower.operators import LEAVES
from closedform.lower.ranges import Ranges, UnboundedError
from closedform.model.derivation import Derivation
from closedform.model.expressions import free_symbols
from closedform.model.functions import (
    Bound,
    Determined,
    Function,
    Let,
    Match,
    Require,
    Statement,
    Vanishes,
)


class UnboundedAngleError(TypeError):
    """An output is an angle whose size is not known."""


def is_guarded(function: Function) -> bool:
    """Whether a failure must be reported, by a status or by NaN for a missing branch."""
    return function.has_status or any(isinstance(s, (Bound, Match)) for s in function.body)


def expressions_of(function: Function) -> Iterable[sp.Basic]:
    """The expressions of the statements and of the outputs."""
    for statement in function.body:
        if isinstance(statement, Require):
            yield from statement.values
        else:
            yield statement.value
    for output in function.outputs:
        yield from output.entries


@dataclass
class Branch:
    """Lowers one branch: statements first, then outputs and the status.

    ``names`` collects the preferred names of nodes, and ``signs`` are the branch signs that are
    inputs of the program.  With ``unscaled`` a length that overflows makes the target UNREACHABLE.
    """

    function: Function
    derivation: Derivation
    build: Builder
    names: dict[int, str]
    label: str
    signs: Sequence[sp.Symbol]
    ranges: Ranges
    valid: list[Node] = field(default_factory=list)
    """Conditions without which an input is INVALID."""
    reachable: list[Node] = field(default_factory=list)
    """Conditions without which the target is UNREACHABLE."""
    singular: list[Node] = field(default_factory=list)
    """Conditions of which any one makes the answer SINGULAR."""
    before: dict[int, tuple[Node, ...]] = field(default_factory=dict)
    """For a flag, the conditions of ``reachable`` that do not depend on it."""
    unscaled: bool = False
    """Whether lengths are numbers, so that powers of a large target overflow."""

    @property
    def graph(self) -> Graph:
        return self.build.graph

    def lowered(
        self, chosen: Mapping[sp.Symbol, int], entries: Sequence[tuple[sp.Expr, bool]]
    ) -> tuple[list[list[Node]], Node]:
        """The entries of each output, and the status, for the ``chosen`` signs.

        Each of the ``entries`` is an expression, and whether it is an angle.
        """
        graph = self.graph
        for symbol, sign in chosen.items():
            self.build.define(symbol, graph.const(sign))
        self.build.names = self.names
        self.valid += self._valid_input()
        for statement in self.function.body:
            self._add(statement)
        if self.unscaled and self.function.has_status:
            self.reachable += self._in_range(entries)
        # In this form a comparison with NaN, after an overflow, counts as a failure.
        invalid = graph.negate(graph.every(self.valid))
        unreachable = graph.negate(graph.every(self.reachable))
        guarded = is_guarded(self.function)
        failed = graph.any([invalid, unreachable]) if guarded else graph.node("false")
        for node, name in (
            (invalid, "invalid"),
            (unreachable, "unreachable"),
            (failed, "failed"),
        ):
            self.names.setdefault(node.id, name)
        nodes = iter([self._output(failed, e, angle) for e, angle in entries])
        outputs = [list(islice(nodes, output.size)) for output in self.function.outputs]
        return outputs, graph.node("status", invalid, unreachable, graph.any(self.singular))

    def _add(self, statement: Statement) -> None:
        match statement:
            case Let():
                self._name(statement.symbol, self.build(statement.value))
            case Bound():
                self._bound(statement)
            case Match():
                size = self.graph.even("abs", self.build(statement.value))
                allowed = self._tolerance("feasibility", statement.scale)
                if statement.rounding != 0:
                    rounded = self._tolerance("vanishing", statement.rounding)
                    allowed = self.graph.node("max", allowed, rounded)
                self.reachable.append(self.graph.node("le", size, allowed))
            case Vanishes():
                value = self.build(statement.value)
                limit = self._tolerance("vanishing", statement.scale, statement.squares)
                flag = self.graph.node("le", value, limit)
                self._name(statement.symbol, flag)
                self.before.setdefault(flag.id, tuple(self.reachable))
                if statement.free:
                    self.singular.append(flag)
            case Determined():
                self._determined(statement)
            case Require():
                sizes = [self.graph.even("abs", self.build(v)) for v in statement.values]
                allowed = self._tolerance("rotation", statement.scale)
                self.valid += [self.graph.node("le", size, allowed) for size in sizes]

    def _bound(self, statement: Bound) -> None:
        graph = self.graph
        value = self.build(statement.value)
        allowed = graph.neg(self._tolerance("feasibility", statement.scale))
        self.reachable.append(graph.node("le", allowed, value))
        least = graph.const(0)
        if (scale := statement.above) is not None:
            # the square of an angle of four times the tolerance
            squared = [self._tolerance("vanishing", 16 * scale), self._tolerance("vanishing", 1)]
            least = graph.product(squared)
        self._name(statement.symbol, graph.node("max", value, least))

    def _determined(self, statement: Determined) -> None:
        """What is missed adds to the rounding error, so its sum with it takes the place of it."""
        graph = self.graph
        value = self.build(statement.value)
        least = self._tolerance("determined", statement.scale, statement.squares)
        if statement.missed != 0:
            rounded = self._tolerance("vanishing", statement.size)
            error = graph.sum([rounded, self.build(statement.missed)])
            power = 2 if statement.squares else 1
            value = graph.product([value, *[rounded] * power])
            least = graph.product([least, *[error] * power])
        self.singular.append(graph.node("le", value, least))

    def _tolerance(self, name: str, scale: sp.Expr, squares: bool = False) -> Node:
        """A tolerance, or its square, times its scale."""
        powers = [self.graph.node("tolerance", payload=name)] * (2 if squares else 1)
        return self.graph.product([*powers, self.build(sp.sympify(scale, strict=True))])

    def _name(self, symbol: sp.Symbol, node: Node) -> None:
        self.build.define(symbol, node)
        depends = self.function.branches and len(self.function.branches) > 1
        if node.op not in LEAVES and node.id not in self.names:
            taken = symbol.name in self.names.values() and depends
            self.names[node.id] = f"{symbol.name}_{self.label}" if taken else symbol.name

    def _output(self, failed: Node, entry: sp.Expr, angle: bool) -> Node:
        """The value of an entry; NaN is added if the branch fails, with one selection for all."""
        node = self.build(entry)
        if self.function.boolean:
            return self.graph.every([self.graph.negate(failed), node])
        if angle:
            try:
                node = self.ranges.wrapped(self.graph, node)
            except UnboundedError:
                raise UnboundedAngleError(
                    f"{self.function.name}: the size of the angle {entry} is not known, so it "
                    f"cannot be moved to (-pi, pi]; write it as atan2(sin, cos)"
                ) from None
        if failed.op == "false":
            return node
        return self.graph.node("add", node, self.graph.node("poison", failed))

    def _in_range(self, entries: Sequence[tuple[sp.Expr, bool]]) -> list[Node]:
        """The condition that no length of the answer overflows; an angle cannot."""
        lengths = [self.build(entry) for entry, angle in entries if not angle]
        computed = [node for node in lengths if node.op not in LEAVES]
        return [self.graph.node("finite", *computed)] if computed else []

    def _valid_input(self) -> list[Node]:
        """The conditions that every input and parameter is finite and no length is negative.

        A function with a status also tests parameters that it does not use, because impossible
        dimensions are an error for the whole robot.  An input in a requirement needs no test here:
        the requirement fails if it is not finite.
        """
        graph = self.graph
        used = free_symbols(expressions_of(self.function))
        judged = self.function.has_status
        parameters = [p for p in self.derivation.parameters if judged or p.symbol in used]
        required = {
            s
            for statement in self.function.body
            if isinstance(statement, Require)
            for e in statement.values
            for s in e.free_symbols
        }

        def finite(symbols: Iterable[sp.Symbol]) -> list[Node]:
            tested = [self.build.known[s] for s in symbols if s not in required]
            return [graph.node("finite", *tested)] if tested else []

        # Parameters come first: if all postures share them, a batch tests them only once.
        return [
            *finite(p.symbol for p in parameters),
            *(
                graph.node("le", graph.const(0), self.build.known[p.symbol])
                for p in parameters
                if p.nonnegative
            ),
            *finite(s for s in self.function.symbols if s not in self.signs),
        ]
