"""Between which multiples of pi an angle lies: how much it takes to bring it to (-pi, pi].

The bounds are halves of pi, and hold after rounding: sums of such multiples of the double (or the
float) nearest to pi are exact up to 2 pi, and rounding keeps order.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from fractions import Fraction
from typing import TypeAlias

import sympy as sp

from closedform.lower.graph import BOOLEAN, Graph, Node, constant_of, is_const

Range: TypeAlias = "tuple[Fraction, Fraction]"


class Ranges:
    """Ranges of the nodes of a graph; the inputs named in ``lengths`` are not negative."""

    def __init__(self, lengths: Collection[str] = ()):
        self.lengths = frozenset(lengths)

    def wrapped(self, graph: Graph, angle: Node) -> Node:
        """The angle in (-pi, pi], by the cheapest of the wraps that its range allows."""
        low, high = self.of(angle) or (Fraction(-2), Fraction(2))
        while low < -2 or high > 2:
            angle = graph.node("wrap", angle)
            low, high = min(low + 2, Fraction(-1)), max(high - 2, Fraction(1))
        if high <= 1:
            op = "wrap_cut" if low == -1 else "wrap_up"
            return angle if low > -1 else graph.node(op, angle)
        return graph.node("wrap" if low <= -1 else "wrap_down", angle)

    def of(self, node: Node) -> Range | None:
        """The least and the largest value in units of pi, if anything is known of them."""
        value = constant_of(node)
        if value is not None:
            multiple = 2 * sp.sympify(value) / sp.pi
            half_turns = Fraction(int(multiple), 2) if multiple.is_Integer else None
            return None if half_turns is None else (half_turns, half_turns)
        if node.op == "atan2":
            y, x = node.args
            high = Fraction(1, 2) if self.positive(x) else Fraction(1)
            return (Fraction(0) if self.positive(y) else -high), high
        parts = [self.of(a) for a in node.args if a.op not in BOOLEAN]
        known = [p for p in parts if p is not None]
        if node.op == "neg" and known:
            return -known[0][1], -known[0][0]
        if node.op == "sum" and len(known) == len(parts):
            zero = Fraction(0)
            return sum((p[0] for p in known), zero), sum((p[1] for p in known), zero)
        if node.op == "select" and len(known) == 2:
            return min(p[0] for p in known), max(p[1] for p in known)
        if node.op == "product" and len(node.args) == 2 and len(known) == 1:
            factor = next((v for a in node.args if (v := constant_of(a)) is not None), None)
            if factor is not None and factor == 2:
                return 2 * known[0][0], 2 * known[0][1]
        return None

    def positive(self, node: Node) -> bool:
        """Whether a value is never below zero and never the negative zero (it may be NaN)."""
        if node.op in ("const", "abs"):
            return True
        if node.op == "sqrt":
            return self.positive(node.args[0])
        if node.op == "max":  # the other operand is returned where it is larger
            return is_const(node.args[1], 0)
        if node.op == "product":
            return all(n % 2 == 0 or self.positive(f) for f, n in Counter(node.args).items())
        if node.op == "sum":
            return all(map(self._not_negative, node.args)) and any(map(self.positive, node.args))
        return False

    def _not_negative(self, node: Node) -> bool:
        return self.positive(node) or (node.op == "input" and node.payload in self.lengths)
