"""The expression graph: hash-consed nodes with their local identities applied.

A node has an operator and operands, and does not depend on any language.  Negation stays outside
products and sums, so that a value and its negative share one node.  Sums and products are n-ary
until :mod:`closedform.lower.share` has looked for common parts in them.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import sympy as sp

from closedform.lower.operators import OPERATORS


@dataclass(frozen=True, eq=False)
class Node:
    """An operator applied to operands.  ``payload`` is the constant, or the name of an input."""

    id: int
    op: str
    args: tuple[Node, ...] = ()
    payload: Hashable = None

    def __repr__(self) -> str:
        return f"{self.op}#{self.id}"


@dataclass
class Graph:
    """Makes nodes; equal nodes are the same object."""

    _nodes: dict[Hashable, Node] = field(default_factory=dict)

    def node(self, op: str, *args: Node, payload: Hashable = None) -> Node:
        key = (op, args, payload)
        found = self._nodes.get(key)
        if found is None:
            arity = OPERATORS[op].arity
            if arity is not None and arity != len(args):
                raise TypeError(f"{op} takes {arity} operands, not {len(args)}")
            found = self._nodes[key] = Node(len(self._nodes), op, args, payload)
        return found

    def const(self, value: sp.Expr | int) -> Node:
        value = sp.sympify(value, strict=True)
        if value.is_negative:
            return self.neg(self.const(-value))
        return self.node("const", payload=value)

    def input(self, name: str) -> Node:
        return self.node("input", payload=name)

    def neg(self, a: Node) -> Node:
        if a.op == "neg":
            return a.args[0]
        if is_const(a, 0) or a.op == "nan":
            return a
        return self.node("neg", a)

    def sum(self, terms: Iterable[Node]) -> Node:
        """An n-ary sum with a positive first term, or the negative of one."""
        kept: list[Node] = []
        for term in terms:
            opposite = self.neg(term)
            if opposite in kept:
                kept.remove(opposite)
            elif not is_const(term, 0):
                kept.append(term)
        kept = self._constants_together(kept, sp.Add, 0)
        if not kept:
            return self.const(0)
        kept.sort(key=lambda t: strip_sign(t).id)
        if len(kept) == 1:
            return kept[0]
        if kept[0].op == "neg":
            return self.neg(self.node("sum", *(self.neg(t) for t in kept)))
        return self.node("sum", *kept)

    def product(self, factors: Iterable[Node]) -> Node:
        """An n-ary product of unsigned factors, or the negative of one."""
        negative = False
        kept: list[Node] = []
        for factor in factors:
            if factor.op == "neg":
                negative, factor = not negative, factor.args[0]
            if is_const(factor, 0):
                return factor
            if not is_const(factor, 1):
                kept.append(factor)
        for sign in [f for f in kept if f.op == "sign" and strip_sign(f.args[0]) in kept]:
            value = strip_sign(sign.args[0])
            negative ^= value is not sign.args[0]
            kept.remove(sign)
            kept[kept.index(value)] = self.node("abs", value)
        kept = self._constants_together(kept, sp.Mul, 1)
        kept.sort(key=lambda f: f.id)
        if not kept:
            result = self.const(1)
        elif len(kept) == 1:
            result = kept[0]
        else:
            result = self.node("product", *kept)
        return self.neg(result) if negative else result

    def div(self, a: Node, b: Node) -> Node:
        if is_const(b, 1) or is_const(a, 0):
            return a
        if a.op == "neg":
            return self.neg(self.div(a.args[0], b))
        if b.op == "neg":
            return self.neg(self.div(a, b.args[0]))
        if a.op == b.op == "const":
            return self.const(
                sp.sympify(a.payload, strict=True) / sp.sympify(b.payload, strict=True)
            )
        return self.node("div", a, b)

    def select(self, condition: Node, a: Node, b: Node) -> Node:
        if condition.op == "true" or a is b:
            return a
        if condition.op == "false":
            return b
        if a.op == "neg" and b.op == "neg":
            return self.neg(self.select(condition, a.args[0], b.args[0]))
        if b.op == "neg" and is_const(a, 0):
            return self.neg(self.select(condition, a, b.args[0]))
        if self.neg(a) is b and condition.op == "le" and is_const(condition.args[0], 0):
            return self.product([a, self.node("sign", condition.args[1])])
        return self.node("select", condition, a, b)

    def every(self, conditions: Sequence[Node]) -> Node:
        return self._fold("and", conditions, "true", "false")

    def any(self, conditions: Sequence[Node]) -> Node:
        return self._fold("or", conditions, "false", "true")

    def negate(self, condition: Node) -> Node:
        opposite = {"true": "false", "false": "true"}.get(condition.op)
        if opposite:
            return self.node(opposite)
        return condition.args[0] if condition.op == "not" else self.node("not", condition)

    def atan2(self, y: Node, x: Node) -> Node:
        """``atan2`` is odd in y except on the branch cut; the callers wrap the result."""
        if is_const(y, 0) and x.op == "const":
            return y
        if y.op == "neg":
            return self.neg(self.node("atan2", y.args[0], x))
        return self.node("atan2", y, x)

    def odd(self, op: str, a: Node) -> Node:
        """An odd function: the sign moves outside."""
        return self.neg(self.node(op, a.args[0])) if a.op == "neg" else self.node(op, a)

    def even(self, op: str, a: Node) -> Node:
        """An even function: the sign is dropped."""
        return self.node(op, strip_sign(a))

    def _constants_together(
        self, operands: list[Node], combine: Callable[..., sp.Expr], neutral: int
    ) -> list[Node]:
        """Combine several constants into one exact constant; drop a neutral one."""
        values = [constant_of(n) for n in operands]
        found = [v for v in values if v is not None]
        if len(found) < 2:
            return operands
        others = [n for n, v in zip(operands, values, strict=True) if v is None]
        value = combine(*found)
        return others if value == neutral else [*others, self.const(value)]

    def _fold(self, op: str, conditions: Sequence[Node], neutral: str, absorbing: str) -> Node:
        kept: list[Node] = []
        for condition in conditions:
            if condition.op == absorbing:
                return condition
            if condition.op != neutral and condition not in kept:
                kept.append(condition)
        if not kept:
            return self.node(neutral)
        result = kept[0]
        for condition in kept[1:]:
            result = self.node(op, result, condition)
        return result


def is_const(node: Node, value: int) -> bool:
    return node.op == "const" and node.payload == value


def constant_of(node: Node) -> sp.Expr | None:
    """The exact value of a constant node, else None."""
    if strip_sign(node).op != "const":
        return None
    value: sp.Expr = strip_sign(node).payload
    return -value if node.op == "neg" else value


def inverse_power_of_two(node: Node) -> sp.Expr | None:
    """The factor that replaces division by a constant, or None if that is not exact."""
    value = constant_of(node)
    if value is None or not value.is_Integer or value & (value - 1):
        return None
    return 1 / value


def strip_sign(node: Node) -> Node:
    return node.args[0] if node.op == "neg" else node


Operands = Callable[[Node], tuple[Node, ...]]


def reachable(
    roots: Iterable[Node], stop: Container[str] = (), operands: Operands | None = None
) -> Iterator[Node]:
    """Every node below ``roots`` once, operands before operators, without recursion.

    The operands of the operators in ``stop`` are not visited.  ``operands`` may replace those of a
    node.
    """
    seen: set[Node] = set()
    path: list[Node] = []
    left = [iter(roots)]  # of the operands of each node on the path
    while left:
        for node in left[-1]:
            if node in seen:
                continue
            seen.add(node)
            below = node.args if operands is None else operands(node)
            if below and node.op not in stop:
                path.append(node)
                left.append(iter(below))
                break
            yield node
        else:
            left.pop()
            if path:
                yield path.pop()


def hardly_ever(condition: Node) -> bool:
    """Whether a condition holds only if a flag does: a quantity counts as zero."""
    if condition.op == "or":
        return all(map(hardly_ever, condition.args))
    if condition.op == "and":
        return any(map(hardly_ever, condition.args))
    if condition.op != "le":
        return False
    products = ("product", "mul", "neg")
    factors = reachable(condition.args[1:], operands=lambda n: n.args if n.op in products else ())
    return any(n.op == "tolerance" and n.payload == "vanishing" for n in factors)


def rebuild(
    roots: Sequence[Node],
    change: Callable[[Node, tuple[Node, ...]], Node],
    operands: Operands | None = None,
) -> list[Node]:
    """The images of ``roots`` after ``change`` has replaced every node, operands first."""
    image: dict[Node, Node] = {}
    for node in reachable(roots, operands=operands):
        below = node.args if operands is None else operands(node)
        image[node] = change(node, tuple([image[a] for a in below]))
    return [image[root] for root in roots]
