"""JavaScript code of a kernel."""

from __future__ import annotations

from closedform.emit.code import ATOM, COMPARE, LOGIC, SUM, UNARY, Printer, Text, call, word
from closedform.lower.graph import Node
from closedform.model.names import in_javascript

CHOICE = 1
"""How tightly ``? :`` binds: less than everything else."""


class JavaScriptPrinter(Printer):
    """JavaScript code of a kernel over numbers."""

    has_meaning = staticmethod(in_javascript)

    nan, true, false = word("NaN"), word("true"), word("false")
    sqrt, atan2 = call("Math.sqrt"), call("Math.atan2")
    abs, max, min = call("Math.abs"), call("Math.max"), call("Math.min")
    sign, wrap, wrap_cut = call("_runtime.sign"), call("_runtime.wrap"), call("_runtime.wrapCut")
    poison, status = call("_runtime.poison"), call("_runtime.status")

    def tolerance(self, node: Node) -> Text:
        return Text(f"_runtime.{str(node.payload).upper()}")

    def eq(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} === {b.at(SUM)}", COMPARE)

    def and_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "&&", a, b)

    def or_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "||", a, b)

    def not_(self, node: Node, a: Text) -> Text:
        return Text(f"!{a.at(ATOM)}", UNARY)

    def finite(self, node: Node, *args: Text) -> Text:
        tests = [f"Number.isFinite({a.code})" for a in args]
        return Text(" && ".join(tests), LOGIC if len(tests) > 1 else ATOM)

    def select(self, node: Node, condition: Text, a: Text, b: Text) -> Text:
        return Text(f"{condition.at(LOGIC)} ? {a.at(LOGIC)} : {b.at(LOGIC)}", CHOICE)
