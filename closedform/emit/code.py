"""The common part of all printers: names for values, which values get a name, and precedence.

A value that is used once is printed inline; one that is used twice, or whose text is too long, gets
a name.  A language is a subclass with one method per operator.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from closedform.lower import Lowered
from closedform.lower.graph import BOOLEAN, Node, constant_of
from closedform.lower.program import LEAVES

LONGEST = 44
WRAPS = ("wrap", "wrap_cut")
ATOM, UNARY, PRODUCT, SUM, COMPARE, LOGIC = 7, 6, 5, 4, 3, 2


@dataclass(frozen=True)
class Text:
    """Code and the precedence of its outermost operator."""

    code: str
    precedence: int = ATOM

    def at(self, precedence: int) -> str:
        return self.code if self.precedence >= precedence else f"({self.code})"


@dataclass(frozen=True)
class Line:
    """``name = code``; ``boolean`` is for languages with types."""

    name: str
    code: str
    boolean: bool


class Names:
    """Makes identifiers that are not taken and have no meaning in the language."""

    def __init__(self, reserved: Iterable[str], has_meaning: Callable[[str], bool]):
        self.taken = set(reserved)
        self.has_meaning = has_meaning
        self.counter = 0

    def take(self, wanted: str) -> str:
        name, n = wanted, 1
        while name in self.taken or self.has_meaning(name):
            n += 1
            name = f"{wanted}_{n}"
        self.taken.add(name)
        return name

    def fresh(self) -> str:
        self.counter += 1
        return self.take(f"t{self.counter}")


def trig_names(names: Names, angle: Node) -> tuple[str, str]:
    """Names for the sine and cosine of an angle: ``s1, c1`` of theta1, ``s_psi, c_psi`` of psi."""
    half = ""
    if angle.op == "div":
        half = "_half" if angle.args[1].payload == 2 else f"_{angle.args[1].payload}th"
        angle = angle.args[0]
    suffix = _suffix(angle)
    return names.take(f"s{suffix}{half}"), names.take(f"c{suffix}{half}")


def _suffix(angle: Node) -> str:
    """``1`` of theta1, ``_psi`` of psi."""
    label = str(angle.payload) if angle.op == "input" else "angle"
    return label.removeprefix("theta") if label.startswith("theta") else f"_{label}"


def literal(value: sp.Expr) -> str:
    """The shortest decimal that reads back as the double nearest to an exact number."""
    if value.is_Rational:
        return repr(float(Fraction(int(value.p), int(value.q))))
    return repr(float(value.evalf(40)))


def _inverse_power_of_two(node: Node) -> sp.Expr | None:
    """The factor that replaces division by a constant, or None if that is not exact."""
    value = constant_of(node)
    if value is None or not value.is_Integer or value & (value - 1):
        return None
    return 1 / value


class Printer:
    """Turns a lowered program into lines of code; subclasses print the operators."""

    has_meaning: Callable[[str], bool]
    """Whether a name already has a meaning in the language."""

    def __init__(self, lowered: Lowered, reserved: Iterable[str] = ()):
        self.lowered = lowered
        inputs = [str(e) for a in lowered.inputs for e in a.entries]
        self.names = Names(reserved, self.has_meaning)
        self.inputs = {name: self.names.take(name) for name in (*inputs, *lowered.parameters)}
        self.text: dict[int, Text] = {}
        self.lines: list[Line] = []
        self.trig = [(angle, *trig_names(self.names, angle)) for angle in lowered.angles]
        self._sines = {angle.id: (s, c) for angle, s, c in self.trig}
        self.turned = [
            (angle, self.names.take(f"principal{_suffix(angle)}")) for angle in lowered.turned
        ]
        self._principals = {angle.id: name for angle, name in self.turned}

    def run(self) -> list[list[str]]:
        """Fill ``lines`` and return the code of every entry of every result."""
        schedule = self.schedule()
        uses = Counter(a.id for n in schedule for a in n.args)
        uses.update(n.id for n in self.lowered.roots)
        for node in schedule:
            text = self.render(node)
            if self.deserves_name(node, text, uses[node.id]):
                wanted = self.lowered.names.get(node.id)
                name = self.names.take(wanted) if wanted else self.names.fresh()
                self.lines.append(Line(name, text.code, node.op in BOOLEAN))
                text = Text(name)
            self.text[node.id] = text
        return [[self.text[n.id].code for n in r.nodes] for r in self.lowered.results]

    def schedule(self) -> list[Node]:
        """The order in which nodes are printed, operands before operators."""
        return self.lowered.schedule()

    def deserves_name(self, node: Node, text: Text, uses: int) -> bool:
        if node.op in LEAVES:
            return False
        if node.id in self._sines:  # printed before all else, where its sine is taken
            return False
        if node.op == "neg" and self.text[node.args[0].id].precedence == ATOM:
            return False
        return uses > 1 or len(text.code) > LONGEST

    def render(self, node: Node) -> Text:
        args = tuple(self.text[a.id] for a in node.args)
        match node.op:
            case "const":
                return self.constant(literal(node.payload))
            case "input":
                return Text(self.inputs[str(node.payload)])
            case "sin" | "cos":
                return Text(self._sines[node.args[0].id][node.op == "cos"])
            case "principal":
                return Text(self._principals[node.args[0].id])
            case "add":
                return Text(f"{args[0].at(SUM)} + {args[1].at(PRODUCT)}", SUM)
            case "sub":
                return Text(f"{args[0].at(SUM)} - {args[1].at(PRODUCT)}", SUM)
            case "mul":
                return Text(f"{args[0].at(PRODUCT)} * {args[1].at(UNARY)}", PRODUCT)
            case "div" if (inverse := _inverse_power_of_two(node.args[1])) is not None:
                return Text(
                    f"{args[0].at(PRODUCT)} * {self.constant(literal(inverse)).code}", PRODUCT
                )
            case "div":
                return Text(f"{args[0].at(PRODUCT)} / {args[1].at(UNARY)}", PRODUCT)
            case "neg":
                return Text(f"-{args[0].at(UNARY)}", UNARY)
            case "lt" | "le" | "eq":
                sign = {"lt": "<", "le": "<=", "eq": "=="}[node.op]
                return Text(f"{args[0].at(SUM)} {sign} {args[1].at(SUM)}", COMPARE)
            case "and" | "or":
                sign = {"and": "&", "or": "|"}[node.op]
                chained = node.args[0].op == node.op and args[0].precedence == LOGIC
                left = args[0].code if chained else args[0].at(UNARY)
                return Text(f"{left} {sign} {args[1].at(UNARY)}", LOGIC)
            case op:
                return self.call(op, [a.code for a in args], node)

    def constant(self, text: str) -> Text:
        raise NotImplementedError

    def call(self, op: str, args: list[str], node: Node) -> Text:
        """Operators that look different in every language."""
        raise NotImplementedError
