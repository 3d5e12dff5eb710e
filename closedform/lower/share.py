"""Common parts of sums, products and quotients, and the step from n-ary to binary operators.

If two sums (products) have two terms (factors) in common, these are computed once.  The most
frequent pair is extracted first, then the next, until no pair occurs twice.
"""

from __future__ import annotations

import heapq
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations

from closedform.lower.graph import Graph, Node, reachable, rebuild, strip_sign

Operand = tuple[int, int]
"""The id of an operand without its sign, and the sign."""
Pair = tuple[int, int, int]
"""The ids of two operands, the lower first, and their relative sign."""


def share(graph: Graph, roots: Sequence[Node], *, by_reciprocals: bool = False) -> list[Node]:
    """``roots`` in binary operators, with common pairs extracted from products and then from sums.

    With ``by_reciprocals``, quotients by the same value become products with its reciprocal.  A
    division takes as long as several products, but the product has one more rounding.
    """
    shared = _by_reciprocals(graph, list(roots)) if by_reciprocals else list(roots)
    shared = _take_out(graph, shared, "product")
    shared = _take_out(graph, shared, "sum")
    binary = rebuild(shared, lambda node, args: _binary(graph, node, args))
    return _turn_differences(graph, binary)


def _by_reciprocals(graph: Graph, roots: list[Node]) -> list[Node]:
    """Use one division for all quotients by the same value, unless that is a constant."""
    divisors = Counter(n.args[1].id for n in reachable(roots) if n.op == "div")
    if max(divisors.values(), default=0) < 2:
        return roots

    def change(node: Node, args: tuple[Node, ...]) -> Node:
        if node.op != "div" or node.args[1].op == "const" or divisors[node.args[1].id] < 2:
            return same(graph, node, args)
        return graph.product([args[0], graph.div(graph.const(1), args[1])])

    return rebuild(roots, change)


def _turn_differences(graph: Graph, roots: list[Node]) -> list[Node]:
    """Replace ``-(a - b)`` by ``b - a`` if ``a - b`` itself is not needed."""
    uses = Counter(a.id for n in reachable(roots) for a in n.args)
    uses.update(r.id for r in roots)

    def change(node: Node, args: tuple[Node, ...]) -> Node:
        below = node.args[0] if node.op == "neg" else None
        if below is not None and below.op == "sub" and uses[below.id] == 1:
            return graph.node("sub", args[0].args[1], args[0].args[0])
        return same(graph, node, args)

    return rebuild(roots, change)


def _take_out(graph: Graph, roots: list[Node], op: str) -> list[Node]:
    """Extract the common pairs of one operator.

    The pairs of all nodes are in a table and in a heap.  So extracting a part takes time for the
    nodes in which it occurs, not for the whole graph.
    """
    table = _Table(n for n in reachable(roots) if n.op == op)
    if not table.heap:
        return roots
    while pair := table.most_frequent():
        first, second = (table.node[i] for i in pair[:2])
        part = _make(graph, op, [first, second if pair[2] > 0 else graph.neg(second)])
        table.replace(pair, part)

    def change(node: Node, args: tuple[Node, ...]) -> Node:
        return _make(graph, op, args) if node.id in table.operands else same(graph, node, args)

    def operands(node: Node) -> tuple[Node, ...]:
        if node.id not in table.operands:
            return node.args
        listed = ((table.node[i], sign) for i, sign in table.operands[node.id])
        return tuple(graph.neg(n) if sign < 0 else n for n, sign in listed)

    return rebuild(roots, change, operands)


class _Table:
    """The operands of every sum (or product), and for each pair of operands the nodes with it."""

    def __init__(self, nodes: Iterable[Node]):
        self.node: dict[int, Node] = {}
        self.operands: dict[int, list[Operand]] = {}
        self.holders: defaultdict[Pair, dict[int, None]] = defaultdict(dict)
        self.heap: list[tuple[int, int, int, int]] = []
        for node in nodes:
            self._enter(node)
        for pair in self.holders:
            self._push(pair)

    def _enter(self, node: Node) -> None:
        self.node[node.id] = node
        self.node.update((strip_sign(a).id, strip_sign(a)) for a in node.args)
        signed = [(strip_sign(a).id, -1 if a.op == "neg" else 1) for a in node.args]
        self.operands[node.id] = signed
        for pair in _pairs(signed):
            self.holders[pair][node.id] = None

    def _push(self, pair: Pair) -> None:
        if (count := len(self.holders[pair])) > 1:
            heapq.heappush(self.heap, (-count, pair[0], pair[1], -pair[2]))

    def most_frequent(self) -> Pair | None:
        """The most frequent pair that is worth extracting; the oldest if there are several."""
        while self.heap:
            count, first, second, opposite = heapq.heappop(self.heap)
            pair = (first, second, -opposite)
            holders = self.holders[pair]
            if len(holders) == -count and any(len(self.operands[h]) > 2 for h in holders):
                return pair
        return None

    def replace(self, pair: Pair, part: Node) -> None:
        """Replace ``pair`` by ``part`` in all nodes with more than two operands."""
        changed: set[Pair] = set()
        for holder in [h for h in self.holders[pair] if len(self.operands[h]) > 2]:
            signed = self.operands[holder]
            for old in _pairs(signed):
                self.holders[old].pop(holder, None)
                changed.add(old)
            first = next(o for o in signed if o[0] == pair[0])
            rest = list(signed)
            rest.remove(first)
            rest.remove((pair[1], first[1] * pair[2]))
            self.operands[holder] = [(part.id, first[1]), *rest]
            for new in _pairs(self.operands[holder]):
                self.holders[new][holder] = None
                changed.add(new)
        if part.id not in self.operands:
            self._enter(part)
        for pair in sorted(changed):
            self._push(pair)


def _pairs(signed: Sequence[Operand]) -> Iterator[Pair]:
    """Unordered pairs of operands with their relative sign."""
    for (i, si), (j, sj) in combinations(signed, 2):
        yield (i, j, si * sj) if i <= j else (j, i, si * sj)


def _make(graph: Graph, op: str, args: Sequence[Node]) -> Node:
    return graph.product(args) if op == "product" else graph.sum(args)


def same(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
    """``node`` over new operands, with its local identities applied again."""
    if args == node.args:
        return node
    if node.op in ("sum", "product"):
        return _make(graph, node.op, args)
    if node.op == "neg":
        return graph.neg(args[0])
    if node.op == "div":
        return graph.div(*args)
    if node.op == "select":
        return graph.select(*args)
    if node.op == "atan2" and all(a.op == "const" for a in args):
        return graph.atan2(*args)
    if node.op == "not":
        return graph.negate(args[0])
    if node.op == "and":
        return graph.every(args)
    if node.op == "or":
        return graph.any(args)
    return graph.node(node.op, *args, payload=node.payload)


def _binary(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
    if node.op == "product":
        result = args[0]
        for factor in args[1:]:
            result = graph.node("mul", result, factor)
        return result
    if node.op == "sum":
        result = args[0]
        for term in args[1:]:
            if term.op == "neg":
                result = graph.node("sub", result, term.args[0])
            elif result.op == "neg":
                result = graph.node("sub", term, result.args[0])
            else:
                result = graph.node("add", result, term)
        return result
    return same(graph, node, args)
