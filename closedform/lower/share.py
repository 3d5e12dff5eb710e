"""Common parts of sums and products, and the step from n-ary to binary operators.

Sums (products) that have two terms (factors) in common get them computed once.  The pair that
occurs most often is taken out first, then the next, until no pair occurs twice.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from itertools import combinations

from closedform.lower.graph import Graph, Node, reachable, rebuild, strip_sign


def share(graph: Graph, roots: Sequence[Node]) -> list[Node]:
    """``roots`` with common pairs taken out of products and then of sums, in binary operators."""
    shared = _take_out(graph, list(roots), "product")
    shared = _take_out(graph, shared, "sum")
    binary = rebuild(shared, lambda node, args: _binary(graph, node, args))
    return _turn_differences(graph, binary)


def _turn_differences(graph: Graph, roots: list[Node]) -> list[Node]:
    """``-(a - b)`` as ``b - a``, where ``a - b`` itself is not needed."""
    uses = Counter(a.id for n in reachable(roots) for a in n.args)
    uses.update(r.id for r in roots)

    def change(node: Node, args: tuple[Node, ...]) -> Node:
        below = node.args[0] if node.op == "neg" else None
        if below is not None and below.op == "sub" and uses[below.id] == 1:
            return graph.node("sub", args[0].args[1], args[0].args[0])
        return _same(graph, node, args)

    return rebuild(roots, change)


def _take_out(graph: Graph, roots: list[Node], op: str) -> list[Node]:
    while True:
        nodes = [n for n in reachable(roots) if n.op == op and len(n.args) >= 2]
        if not any(len(n.args) > 2 for n in nodes):
            return roots
        by_id = {strip_sign(a).id: strip_sign(a) for n in nodes for a in n.args}
        counts: Counter[tuple[int, int, int]] = Counter()
        for node in nodes:
            counts.update(set(_pairs(node)))
        first, second, sign = max(counts, key=lambda p: (counts[p], -p[0], -p[1], p[2]))
        if counts[first, second, sign] < 2:
            return roots
        pair = (first, second, sign)
        a, b = by_id[first], by_id[second]
        part = _make(graph, op, [a, b if sign > 0 else graph.neg(b)])

        def change(
            node: Node,
            args: tuple[Node, ...],
            pair: tuple[int, int, int] = pair,
            part: Node = part,
        ) -> Node:
            if node.op == op and len(node.args) > 2 and pair in _pairs(node):
                return _replace(graph, node, pair, part)
            return _same(graph, node, args)

        roots = rebuild(roots, change)


def _pairs(node: Node) -> list[tuple[int, int, int]]:
    """Unordered pairs of operands with their relative sign."""
    found = []
    signed = [(strip_sign(a).id, -1 if a.op == "neg" else 1) for a in node.args]
    for (i, si), (j, sj) in combinations(signed, 2):
        low, high = (i, j) if i <= j else (j, i)
        found.append((low, high, si * sj))
    return found


def _replace(graph: Graph, node: Node, pair: tuple[int, int, int], part: Node) -> Node:
    rest = list(node.args)
    first = next(a for a in rest if strip_sign(a).id == pair[0])
    rest.remove(first)
    second = next(a for a in rest if strip_sign(a).id == pair[1])
    rest.remove(second)
    return _make(graph, node.op, [graph.neg(part) if first.op == "neg" else part, *rest])


def _make(graph: Graph, op: str, args: Sequence[Node]) -> Node:
    return graph.product(args) if op == "product" else graph.sum(args)


def _same(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
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
    return _same(graph, node, args)
