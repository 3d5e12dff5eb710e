"""The common part of all printers: names for values, which values get a name, and precedence.

A value that is used once is printed inline; one that is used twice, or whose text is too long, gets
a name.  A language is a subclass with one method per operator of
:mod:`closedform.lower.operators`; a class that lacks one is refused when it is made.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp

from closedform.lower import Lowered
from closedform.lower.graph import Node, inverse_power_of_two
from closedform.lower.operators import BOOLEAN, LEAVES, OPERATORS, PRINTED

LONGEST = 44
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
    """Names for a sine and a cosine: ``s1, c1`` for theta1, ``s_psi, c_psi`` for psi."""
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


class Printer:
    """Turns a lowered program into lines of code; subclasses say how each operator looks.

    The method of an operator takes the node and the text of each operand.
    """

    has_meaning: Callable[[str], bool]
    """Whether a name already has a meaning in the language."""

    def __init_subclass__(cls) -> None:
        missing = [o.method for o in PRINTED if not hasattr(cls, o.method)]
        if missing:
            raise TypeError(f"{cls.__name__} prints no {', '.join(missing)}: write these methods")

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

    def schedule(self) -> Sequence[Node]:
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
        """The code of a node, by the method of its operator."""
        method: Callable[..., Text] = getattr(self, OPERATORS[node.op].method)
        return method(node, *(self.text[a.id] for a in node.args))

    # What reads alike in the languages that descend from C, Python among them

    def const(self, node: Node) -> Text:
        return self.number(literal(node.payload))

    def input(self, node: Node) -> Text:
        return Text(self.inputs[str(node.payload)])

    def sin(self, node: Node, _: Text) -> Text:
        return Text(self._sines[node.args[0].id][0])

    def cos(self, node: Node, _: Text) -> Text:
        return Text(self._sines[node.args[0].id][1])

    def principal(self, node: Node, _: Text) -> Text:
        return Text(self._principals[node.args[0].id])

    def add(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} + {b.at(PRODUCT)}", SUM)

    def sub(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} - {b.at(PRODUCT)}", SUM)

    def mul(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(PRODUCT)} * {b.at(UNARY)}", PRODUCT)

    def div(self, node: Node, a: Text, b: Text) -> Text:
        inverse = inverse_power_of_two(node.args[1])
        if inverse is not None:
            return Text(f"{a.at(PRODUCT)} * {self.number(literal(inverse)).code}", PRODUCT)
        return Text(f"{a.at(PRODUCT)} / {b.at(UNARY)}", PRODUCT)

    def neg(self, node: Node, a: Text) -> Text:
        return Text(f"-{a.at(UNARY)}", UNARY)

    def lt(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} < {b.at(SUM)}", COMPARE)

    def le(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} <= {b.at(SUM)}", COMPARE)

    def eq(self, node: Node, a: Text, b: Text) -> Text:
        return Text(f"{a.at(SUM)} == {b.at(SUM)}", COMPARE)

    def and_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "&", a, b)

    def or_(self, node: Node, a: Text, b: Text) -> Text:
        return self.logic(node, "|", a, b)

    def logic(self, node: Node, sign: str, a: Text, b: Text, least: int = UNARY) -> Text:
        """Conditions joined by an operator; a chain of the same one needs no parentheses.

        Operands that bind less tightly than ``least`` are put in parentheses.
        """
        chained = node.args[0].op == node.op and a.precedence == LOGIC
        left = a.code if chained else a.at(least)
        return Text(f"{left} {sign} {b.at(least)}", LOGIC)

    def number(self, text: str) -> Text:
        """A decimal number."""
        return Text(text)


def call(function: str) -> Callable[[Printer, Node, Text], Text]:
    """A method that prints an operator as a call of a function."""

    def method(printer: Printer, node: Node, *args: Text) -> Text:
        return Text(f"{function}({', '.join(a.code for a in args)})")

    return method


def word(code: str) -> Callable[[Printer, Node], Text]:
    """A method that prints an operator without operands as a word."""
    return lambda printer, node: Text(code)
