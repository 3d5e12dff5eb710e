"""The C code of single operations, for one posture and for a batch."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from closedform.emit.backends.c.guards import (
    deciding_products,
    final_values,
    given_up_where,
    not_negative,
    unused_where,
)
from closedform.emit.code import COMPARE, PRODUCT, UNARY, Line, Printer, Text, call, word
from closedform.lower import Lowered
from closedform.lower.graph import Node, hardly_ever, reachable, strip_sign
from closedform.lower.operators import LEAVES
from closedform.model.names import in_c

FEW = 2
"""Up to this many quotients by one divisor get a jump each, and are infinite if it is zero."""


class CPrinter(Printer):
    """C code of a kernel over scalars.

    All ``atan2`` whose arguments need no other ``atan2`` are computed together, so that one call
    can evaluate them in one vector.  The lines above ``head`` come first, then ``arctangents``
    (pairs of y and x), then the rest.
    """

    has_meaning = staticmethod(in_c)
    single = "single"
    """Whether the code is for one posture: an argument, or a constant if only one kind calls it."""

    def __init__(self, lowered: Lowered, reserved: Iterable[str] = (), *, branch: bool = False):
        super().__init__(lowered, reserved)
        self.branch = branch
        self.arctangents: list[tuple[str, str]] = []
        self.head = 0
        self._arguments = self._before_arctangents()
        self._given_up = dict(given_up_where(lowered))
        self._unused_where = unused_where(self.schedule(), lowered.roots)
        for quotient, conditions in self._given_up.items():
            others = [c for c in self._unused_where.get(quotient, ()) if c not in conditions]
            self._unused_where[quotient] = (*conditions, *others)
        self._final = final_values(lowered)
        self._divided = Counter(n.args[1].id for n in lowered.schedule() if n.op == "div")
        self._tested: dict[int, str] = {}
        self._deciding = set(deciding_products(lowered))
        self._before_slow = needed_by_slow(lowered.schedule())

    def _before_arctangents(self) -> set[int]:
        """The nodes that need no ``atan2``."""
        found: set[int] = set()
        for node in self.lowered.schedule():
            if node.op != "atan2" and all(a.id in found for a in node.args):
                found.add(node.id)
        return found

    def _together(self, node: Node) -> bool:
        return node.op == "atan2" and all(a.id in self._arguments for a in node.args)

    def schedule(self) -> list[Node]:
        """First the arguments of the shared ``atan2``, then these, then the nodes that need them.

        A quotient comes after the condition under which nothing uses it.
        """

        def operands(node: Node) -> tuple[Node, ...]:
            return (*node.args, *self._given_up.get(node.id, ()))

        nodes = list(reachable(self.lowered.roots, operands=operands))
        if sum(map(self._together, nodes)) < 2:
            self._arguments = set()
            return nodes
        return sorted(
            nodes, key=lambda n: 0 if n.id in self._arguments else 1 if self._together(n) else 2
        )

    nan, true, false = word("CLOSEDFORM_NAN"), word("1"), word("0")
    abs, max, min, sign = call("cf_abs"), call("cf_max"), call("cf_min"), call("cf_sign")
    wrap, wrap_cut = call("cf_wrap"), call("cf_wrap_cut")

    def number(self, text: str) -> Text:
        return Text(f"CLOSEDFORM_C({text})")

    def tolerance(self, node: Node) -> Text:
        return Text(f"CLOSEDFORM_{str(node.payload).upper()}")

    def mul(self, node: Node, a: Text, b: Text) -> Text:
        product = super().mul(node, a, b)
        if node.id in self._deciding:
            return Text(f"cf_rounded({self.single}, one, {product.code})")
        return product

    def div(self, node: Node, a: Text, b: Text) -> Text:
        return super().div(node, a, b) if node.args[1].op == "const" else self._quotient(node, a, b)

    def sqrt(self, node: Node, a: Text) -> Text:
        if not_negative(node.args[0]):
            return Text(f"cf_sqrt({a.code})")
        return Text(f"cf_root({'1' if self.branch else self.single}, {a.code})")

    def atan2(self, node: Node, y: Text, x: Text) -> Text:
        if not self._together(node):
            return Text(f"cf_atan2({y.code}, {x.code})")
        if not self.arctangents:
            self.head = len(self.lines)
        self.arctangents.append((y.code, x.code))
        return Text(f"angles[{len(self.arctangents) - 1}]")

    def not_(self, node: Node, a: Text) -> Text:
        return Text(f"!{a.at(UNARY)}", PRODUCT)  # gcc warns of `!a | b`

    def finite(self, node: Node, *args: Text) -> Text:
        return Text(f"{' + '.join(f'cf_nought({a.code})' for a in args)} == 0", COMPARE)

    def select(self, node: Node, condition: Text, a: Text, b: Text) -> Text:
        arguments = f"{condition.code}, {a.code}, {b.code}"
        rarely = f"cf_rarely({self.single}, {arguments})"
        return Text(rarely if self._is_worth_a_jump(node) else f"cf_select({arguments})")

    def poison(self, node: Node, failed: Text) -> Text:
        return Text(f"cf_poison({self.single}, {failed.code})")

    def status(self, node: Node, invalid: Text, unreachable: Text, singular: Text) -> Text:
        return Text(
            f"cf_status({self.single}, {invalid.code}, {unreachable.code}, {singular.code})"
        )

    def _quotient(self, node: Node, dividend: Text, divisor: Text) -> Text:
        """A quotient, which divides by 1 where nothing uses it: its divisor may vanish there.

        Otherwise a division by zero is avoided.  The value is infinite, as in IEEE arithmetic, if
        no further operation uses it.  It is NaN if one does, or if there are many quotients by one
        divisor, each of which would need a jump.  The loop over branches is part of a single call.
        """
        unused = self._unused_where.get(node.id)
        if unused is not None:
            texts = [self.text[n.id] for n in unused]
            either = " | ".join(t.at(UNARY) for t in texts) if len(texts) > 1 else texts[0].code
            if self.branch:
                safe = f"cf_select({either}, CLOSEDFORM_C(1.0), {divisor.code})"
            else:
                safe = f"cf_divisor({self.single}, {either}, {divisor.code})"
            return Text(f"{dividend.at(PRODUCT)} / {safe}", PRODUCT)
        if self.branch:
            return super().div(node, dividend, divisor)
        if node.id in self._final and self._divided[node.args[1].id] <= FEW:
            return Text(f"cf_quotient({self.single}, {dividend.code}, {divisor.code})")
        return Text(f"{dividend.at(PRODUCT)} / {self._nonzero(node.args[1])}", PRODUCT)

    def _nonzero(self, divisor: Node) -> str:
        """The divisor, or NaN if it is zero; tested once for all quotients by it."""
        code = f"cf_nonzero({self.single}, {self.text[divisor.id].code})"
        if self._divided[divisor.id] < 2:
            return code
        if divisor.id not in self._tested:
            self._tested[divisor.id] = self.names.fresh()
            self.lines.append(Line(self._tested[divisor.id], code, False))
        return self._tested[divisor.id]

    def _is_worth_a_jump(self, select: Node) -> bool:
        """Whether a choice is hardly ever made, and a jump saves time.

        It saves the computation of the value, if there is any.  It also saves a wait: a quotient or
        a root that needs the choice starts before the condition is known.
        """
        condition, value, _ = select.args
        computed = strip_sign(value).op not in LEAVES
        return hardly_ever(condition) and (computed or select.id in self._before_slow)

    def deserves_name(self, node: Node, text: Text, uses: int) -> bool:
        """Comparisons of calls get a name, an int, because clang warns about ``&`` between them."""
        if self._together(node):
            return False
        compares_calls = node.op in ("lt", "le", "eq", "finite") and "cf_" in text.code
        return compares_calls or super().deserves_name(node, text, uses)


def needed_by_slow(schedule: Sequence[Node]) -> set[int]:
    """The values that a quotient or a square root waits for.

    There are none in an inverse: it computes its branches side by side, and jumps would part them.
    """
    if any(node.op == "atan2" for node in schedule):
        return set()
    slow = [arg for node in schedule if node.op in ("div", "sqrt") for arg in node.args]
    return {node.id for node in reachable(slow)}


__all__ = ["CPrinter"]
