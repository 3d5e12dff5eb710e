"""Fewer square roots and divisions: each takes as long as several products.

If neither a nor b is negative, ``sqrt(a) sqrt(b)`` is ``sqrt(a b)``, and twice
``atan2(sqrt(a), sqrt(b))`` is ``atan2(2 sqrt(a b), b - a)``.  If d is not negative,
``atan2(y / d, x / d)`` is ``atan2(y, x)``.  The exponents of these products are up to four times
those of a length; lengths for which they would leave the range are first multiplied by a power of
two.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import sympy as sp

from closedform.lower.graph import Graph, Node, constant_of, reachable, rebuild, strip_sign
from closedform.lower.ranges import Ranges
from closedform.lower.share import same


def fewer_roots(
    graph: Graph, roots: Sequence[Node], followers: Sequence[Node], ranges: Ranges
) -> list[Node]:
    """The images of ``roots`` and ``followers``; only ``roots`` count as uses of a node."""

    def simpler_angles(node: Node, args: tuple[Node, ...]) -> Node:
        found = None
        if node.op == "product":
            found = _whole_angle(graph, ranges, args)
        elif node.op == "atan2":
            found = _undivided(graph, ranges, *args)
        return found or same(graph, node, args)

    nodes = rebuild([*roots, *followers], simpler_angles)
    products = _products_by_root(nodes[: len(roots)], ranges)
    if not products:
        return nodes

    def merged(node: Node, args: tuple[Node, ...]) -> Node:
        if node.op != "product":
            return same(graph, node, args)
        together = defaultdict(list)
        others = []
        for factor, image in zip(node.args, args, strict=True):
            if factor.id in products:
                together[products[factor.id]].append(image.args[0])
            else:
                others.append(image)
        joint = [graph.node("sqrt", graph.product(factors)) for factors in together.values()]
        return graph.product([*others, *joint])

    return rebuild(nodes, merged)


def _whole_angle(graph: Graph, ranges: Ranges, factors: Sequence[Node]) -> Node | None:
    """The product of an even number and the angle ``atan2(sqrt(a), sqrt(b))``."""
    angle = next((f for f in factors if f.op == "atan2"), None)
    number, half = next(((f, h) for f in factors if (h := _half(f)) is not None), (None, None))
    if angle is None or half is None:
        return None
    a, b = (_square(graph, ranges, arg) for arg in angle.args)
    if a is None or b is None:
        return None
    root = graph.node("sqrt", graph.product([a, b]))
    whole = graph.atan2(graph.product([graph.const(2), root]), graph.sum([b, graph.neg(a)]))
    others = [f for f in factors if f is not angle and f is not number]
    return graph.product([*others, graph.const(half), whole])


def _half(node: Node) -> sp.Expr | None:
    """Half of a constant, or None if the constant is not even."""
    value = constant_of(node)
    return value / 2 if value is not None and (value / 2).is_Integer else None


def _undivided(graph: Graph, ranges: Ranges, y: Node, x: Node) -> Node | None:
    """The angle of two quotients with the same divisor, which is not negative."""
    quotients = [strip_sign(n) for n in (y, x)]
    if any(q.op != "div" for q in quotients):
        return None
    (top_y, divisor), (top_x, other) = (q.args for q in quotients)
    if divisor is not other or not ranges.not_negative(divisor):
        return None
    return graph.atan2(
        graph.neg(top_y) if y.op == "neg" else top_y, graph.neg(top_x) if x.op == "neg" else top_x
    )


def _square(graph: Graph, ranges: Ranges, node: Node) -> Node | None:
    """The square of a product of roots whose radicands are not negative."""
    factors = node.args if node.op == "product" else (node,)
    if all(f.op == "sqrt" and ranges.not_negative(f.args[0]) for f in factors):
        return graph.product([f.args[0] for f in factors])
    return None


def _products_by_root(roots: Sequence[Node], ranges: Ranges) -> dict[int, frozenset[int]]:
    """For every root that occurs only in products, the products in which it occurs."""
    users: defaultdict[int, set[int]] = defaultdict(set)
    elsewhere = {r.id for r in roots}
    for node in reachable(roots):
        for arg in node.args:
            if arg.op == "sqrt" and ranges.not_negative(arg.args[0]):
                users[arg.id].add(node.id)
                if node.op != "product":
                    elsewhere.add(arg.id)
    return {i: frozenset(users[i]) for i in users.keys() - elsewhere}
