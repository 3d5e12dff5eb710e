"""Bounds on angles, in multiples of pi, and the cheapest way to move an angle to (-pi, pi].

The bounds are multiples of pi/2 and hold after rounding: sums of such multiples of the double (or
float) nearest to pi are exact up to 2 pi, and rounding is monotone.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from fractions import Fraction
from itertools import product
from math import prod
from typing import TypeAlias

import sympy as sp

from closedform.lower.graph import Graph, Node, constant_of, is_const

Range: TypeAlias = "tuple[Fraction, Fraction]"


class UnboundedError(ValueError):
    """Nothing is known about the size of an angle."""


class Ranges:
    """Ranges of the nodes of a graph.

    The inputs in ``lengths`` are not negative; those in ``signs`` are 1 or -1.
    """

    def __init__(self, lengths: Collection[str] = (), signs: Collection[str] = ()):
        self.lengths = frozenset(lengths)
        self.signs = frozenset(signs)
        self._not_negative: dict[int, bool] = {}

    def wrapped(self, graph: Graph, angle: Node) -> Node:
        """The angle moved to (-pi, pi] by the cheapest wrap that its range allows.

        Raises :class:`UnboundedError` if no range is known.
        """
        found = self.of(angle)
        if found is None:
            raise UnboundedError
        low, high = found
        if (low > -1 and high <= 1) or angle.op == "wrap":
            return angle
        return graph.node("wrap_cut" if low == -1 and high <= 1 else "wrap", angle)

    def of(self, node: Node) -> Range | None:
        """The smallest and the largest value in units of pi, or None if they are not known."""
        value = constant_of(node)
        if value is not None:
            multiple = 2 * sp.sympify(value, strict=True) / sp.pi
            return Fraction(int(sp.floor(multiple)), 2), Fraction(int(sp.ceiling(multiple)), 2)
        if node.op == "atan2":
            y, x = node.args
            high = Fraction(1, 2) if self.positive(x) else Fraction(1)
            return (Fraction(0) if self.positive(y) else -high), high
        if node.op == "wrap":
            return Fraction(-1), Fraction(1)
        if node.op == "product":
            return self._product(node)
        parts = [self.of(a) for a in (node.args[1:] if node.op == "select" else node.args)]
        known = [p for p in parts if p is not None]
        if not known or len(known) < len(parts):
            return None
        lows, highs = zip(*known, strict=True)
        match node.op:
            case "neg":
                return -highs[0], -lows[0]
            case "sum":
                return sum(lows, Fraction(0)), sum(highs, Fraction(0))
            case "select" | "max" | "min":
                return min(lows), max(highs)
            case "abs":
                return Fraction(0), max(-lows[0], highs[0])
        return None

    def _product(self, node: Node) -> Range | None:
        """The range of a product of one angle and integers, which may be computed signs."""
        factors = [self._whole_numbers(a) for a in node.args]
        others = [a for a, f in zip(node.args, factors, strict=True) if f is None]
        found = self.of(others[0]) if len(others) == 1 else None
        if found is None:
            return None
        for numbers in (f for f in factors if f is not None):
            ends = [bound * n for bound in found for n in numbers]
            found = min(ends), max(ends)
        return found

    def positive(self, node: Node) -> bool:
        """Whether a value is never below zero and never the negative zero (it may be NaN)."""
        if node.op in ("const", "abs"):
            return True
        if node.op == "sqrt":
            return self.positive(node.args[0])
        if node.op == "max":  # the other operand is returned only if it is larger than zero
            return is_const(node.args[1], 0)
        if node.op == "select":
            return all(map(self.positive, node.args[1:]))
        if node.op == "div":
            return all(map(self.positive, node.args))
        if node.op == "product":
            return all(n % 2 == 0 or self.positive(f) for f, n in Counter(node.args).items())
        if node.op == "sum":
            return all(map(self.not_negative, node.args)) and any(map(self.positive, node.args))
        return False

    def not_negative(self, node: Node) -> bool:
        """Whether a value is never below zero; it may be the negative zero, or NaN."""
        if node.id not in self._not_negative:
            self._not_negative[node.id] = self._is_not_negative(node)
        return self._not_negative[node.id]

    def _is_not_negative(self, node: Node) -> bool:
        match node.op:
            case "const" | "tolerance" | "abs" | "sqrt":
                return True
            case "input":
                return node.payload in self.lengths
            case "sum":
                return all(map(self.not_negative, node.args))
            case "div":  # division by the negative zero changes the sign
                return self.not_negative(node.args[0]) and self.positive(node.args[1])
            case "select":
                return all(map(self.not_negative, node.args[1:]))
            case "max":
                return any(map(self.not_negative, node.args))
            case "product":
                powers = Counter(node.args).items()
                return all(n % 2 == 0 or self.not_negative(f) for f, n in powers)
        return False

    def _whole_numbers(self, node: Node) -> set[int] | None:
        """The possible values of an integer node, made of constants, signs and choices."""
        value = constant_of(node)
        if value is not None:
            return {int(value)} if value.is_Integer else None
        if node.op == "sign" or (node.op == "input" and node.payload in self.signs):
            return {-1, 1}
        if node.op not in ("select", "neg", "sum", "product"):
            return None
        known = []
        for arg in node.args[node.op == "select" :]:
            numbers = self._whole_numbers(arg)
            if numbers is None:
                return None
            known.append(numbers)
        match node.op:
            case "select":
                return set().union(*known)
            case "neg":
                return {-n for n in known[0]}
            case "sum":
                return {sum(values) for values in product(*known)}
            case _:
                return {prod(values) for values in product(*known)}
