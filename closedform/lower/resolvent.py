"""The root of a resolvent as a program: Laguerre's method, from the end on the side of the root.

If there are three real roots, the sign of the cubic at their mean tells on which side one of them
is alone.  Started from the end of the interval on that side, the method does not pass the root, and
near a root each step triples the digits.  A step that leaves the bracket becomes a bisection; the
first one goes to the other end, near which the root then usually is.  The result is the argument
with the smallest value, because near a multiple root the last steps only follow rounding.
"""

from __future__ import annotations

from closedform.lower.graph import Graph, Node

STEPS = 8
"""The number of steps: four to six are usually enough, more are needed near a triple root."""


class _Arithmetic:
    """Sums and products of nodes of a graph."""

    def __init__(self, graph: Graph):
        self.graph = graph

    def number(self, value: int) -> Node:
        return self.graph.const(value)

    def add(self, *terms: Node) -> Node:
        return self.graph.sum(terms)

    def less(self, a: Node, b: Node) -> Node:
        return self.graph.sum((a, self.graph.neg(b)))

    def times(self, *factors: Node) -> Node:
        return self.graph.product(factors)


def root_between(graph: Graph, a: Node, b: Node, e: Node) -> Node:
    """The root of the cubic of :mod:`closedform.algebra.resolvent` for nodes of a graph."""
    o = _Arithmetic(graph)
    one, two, three, zero = map(o.number, (1, 2, 3, 0))
    A, B = o.times(a, a), o.times(b, b)
    both = o.add(A, B)

    def cubic(u: Node, product: Node) -> Node:
        return o.add(
            o.times(product, o.less(u, e)),
            o.less(o.times(A, o.less(one, u)), o.times(B, o.add(one, u))),
        )

    def product(u: Node) -> Node:
        return o.times(o.less(one, u), o.add(one, u))

    mean = graph.div(e, three)
    right = graph.node("le", zero, cubic(mean, product(mean)))
    u = graph.select(right, one, o.number(-1))
    value = graph.select(right, o.times(o.number(-2), B), o.times(two, A))
    low, high = o.number(-1), one
    best, least = u, graph.even("abs", value)
    outside = graph.neg(u)
    for _ in range(STEPS):
        rate = o.less(product(u), o.add(o.times(two, u, o.less(u, e)), both))
        bend = o.less(o.times(two, e), o.times(o.number(6), u))
        inside = o.less(o.times(two, rate, rate), o.times(three, value, bend))
        width = graph.node("sqrt", o.times(two, graph.node("max", inside, zero)))
        ahead = graph.select(graph.node("le", zero, rate), width, graph.neg(width))
        divisor = o.add(rate, ahead)
        step = graph.div(o.times(three, value), divisor)
        after = graph.select(graph.node("eq", divisor, zero), two, o.less(u, step))
        within = graph.every([graph.node("le", low, after), graph.node("le", after, high)])
        u = graph.select(within, after, outside)
        value = cubic(u, product(u))
        rises = graph.node("le", zero, value)
        low, high = graph.select(rises, u, low), graph.select(rises, high, u)
        outside = graph.div(o.add(low, high), two)
        size = graph.even("abs", value)
        better = graph.node("lt", size, least)
        best, least = graph.select(better, u, best), graph.select(better, size, least)
    return best


__all__ = ["root_between"]
