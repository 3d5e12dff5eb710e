"""JavaScript code of a kernel."""

from __future__ import annotations

from closedform.emit.code import ATOM, COMPARE, LOGIC, SUM, UNARY, Line, Printer, Text, call, word
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
    wrap = call("_runtime.wrap")

    def tolerance(self, node: Node) -> Text:
        return Text(f"_runtime.{str(node.payload).upper()}")

    def eq(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} === {b.at(SUM)}", COMPARE)

    def and_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "&&", a, b, COMPARE)

    def or_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "||", a, b, COMPARE)

    def not_(self, node: Node, a: Text) -> Text:
        return Text(f"!{a.at(ATOM)}", UNARY)

    def finite(self, node: Node, *args: Text) -> Text:
        tests = [f"Number.isFinite({a.code})" for a in args]
        return Text(" && ".join(tests), LOGIC if len(tests) > 1 else ATOM)

    def select(self, node: Node, condition: Text, a: Text, b: Text) -> Text:
        return Text(f"{condition.at(LOGIC)} ? {a.at(LOGIC)} : {b.at(LOGIC)}", CHOICE)

    def sign(self, node: Node, a: Text) -> Text:
        return Text(f"{a.at(SUM)} < 0 ? -1 : 1", CHOICE)

    def wrap_cut(self, node: Node, a: Text) -> Text:
        if not a.code.isidentifier():  # it is read twice
            a, code = Text(self.names.fresh()), a.code
            self.lines.append(Line(a.code, code, False))
        return Text(f"{a.code} <= -Math.PI ? Math.PI : {a.code}", CHOICE)

    def poison(self, node: Node, failed: Text) -> Text:
        return Text(f"{failed.at(LOGIC)} ? NaN : 0", CHOICE)

    def status(self, node: Node, invalid: Text, unreachable: Text, singular: Text) -> Text:
        """The status of a branch: INVALID comes before UNREACHABLE, and that before SINGULAR."""
        first, second, third = (a.at(LOGIC) for a in (invalid, unreachable, singular))
        return Text(f"{first} ? 3 : {second} ? 1 : {third} ? 2 : 0", CHOICE)
