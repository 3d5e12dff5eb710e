r"""The notation of a paper: it reads printed formulas as expressions.

A :class:`Notation` says once what each printed name means, such as ``\theta_1`` or ``c_{12}``.
:meth:`Notation.read` then reads a formula as it is printed.  So the text that a reader sees and the
expression that is judged are one object.

The reader understands sums, products by juxtaposition, fractions, roots, powers, transposes,
matrices (also of blocks), vectors, cases, aligned lines, sums over an index, degrees, the
trigonometric functions with their inverses, and the signs ``\pm`` and ``\mp``.  Everything else is
a name: the longest name that matches is taken, so a name may be any piece of LaTeX.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, TypeAlias

import sympy as sp

from closedform.model.tokens import Token, tokens

Value: TypeAlias = Any  # an expression or a matrix; SymPy's annotations are partial

SIGN = sp.Symbol("pm", real=True)
r"""The sign ``\pm`` in a formula that was read; ``\mp`` is its negative."""

RELATIONS = {
    "=": "=",
    r"\equiv": "=",
    r"\ne": "!=",
    r"\neq": "!=",
    "<": "<",
    ">": ">",
    r"\le": "<=",
    r"\leq": "<=",
    r"\ge": ">=",
    r"\geq": ">=",
}
COMPARED = {"=": sp.Eq, "!=": sp.Ne, "<": sp.Lt, ">": sp.Gt, "<=": sp.Le, ">=": sp.Ge}
FUNCTIONS: dict[str, tuple[Callable[..., Value], Callable[..., Value]]] = {
    r"\sin": (sp.sin, sp.asin),
    r"\cos": (sp.cos, sp.acos),
    r"\tan": (lambda x: sp.sin(x) / sp.cos(x), sp.atan),
}
"""Each function and its inverse, which has one value."""
CLOSING = {"(": ")", "[": "]", "{": "}"}
LIST_WORDS = ("or", "and")
ARGUMENT = re.compile(
    r"\\(sin|cos|tan)(\^\{\w+\})?\{\\left\((\\?\w+(?:_\w|_\{\w+\})?)\s*\\right\)\}"
)
"""A function of one symbol as SymPy writes it, with parentheses that are not needed."""


class NotationError(ValueError):
    """A formula cannot be read; the message shows where."""


@dataclass(frozen=True)
class Relation:
    """A formula that was read: its sides and the signs of relation between them."""

    sides: tuple[Value, ...]
    signs: tuple[str, ...]
    texts: tuple[str, ...]
    """The printed text of each side."""
    decimals: int = 0
    """The largest number of digits after a decimal point."""

    @property
    def left(self) -> Value:
        return self.sides[0]

    @property
    def right(self) -> Value:
        return self.sides[-1]

    @property
    def relational(self) -> Value:
        """The relation as a relational of SymPy, if it has two sides."""
        if len(self.sides) != 2:
            raise NotationError(f"{' '.join(self.texts)} has {len(self.sides)} sides, not two")
        return COMPARED[self.signs[0]](*self.sides, evaluate=False)


@dataclass(frozen=True)
class Piece:
    """A place in a formula at which a misprint is possible."""

    kind: str
    """``sign``, ``number``, ``function``, ``name`` or ``relation``."""
    start: int
    end: int
    name: str = ""
    """The name in the notation, which may be printed with other spaces and braces."""


class Notation:
    """What the printed names of a paper mean.

    A name maps to an expression or a matrix, or to a function, which is applied to what follows it:
    ``c(\\theta_1)``, ``s\\theta_1``.  A name that begins with ``^`` is applied to what precedes it.
    """

    def __init__(self, meanings: Mapping[str, Any]):
        self.meanings = dict(meanings)
        self._names: dict[str, list[tuple[tuple[str, ...], str, Any]]] = {}
        for name, meaning in self.meanings.items():
            key = tuple(t.text for t in tokens(name))
            if not key:
                raise NotationError("a name of the notation must not be empty")
            if isinstance(meaning, int) and not isinstance(meaning, bool):
                meaning = sp.Integer(meaning)
            self._names.setdefault(key[0], []).append((key, name, meaning))
        for found in self._names.values():
            found.sort(key=lambda entry: -len(entry[0]))

    def extended(self, meanings: Mapping[str, Any]) -> Notation:
        """The same notation with further names, or with other meanings."""
        return Notation(self.meanings | dict(meanings)) if meanings else self

    def read(self, text: str) -> tuple[Relation, ...]:
        """The relations of a formula; commas and lines separate them."""
        return _Reader(self, text).relations()

    def value(self, text: str) -> Value:
        """A formula without a relation."""
        (relation,) = self.read(text)
        (value,) = relation.sides
        return value

    def pieces(self, text: str) -> list[Piece]:
        """The places at which a misprint is possible."""
        reader = _Reader(self, text)
        reader.relations()
        return sorted(set(reader.pieces), key=lambda p: p.start)

    def alternatives(self, name: str) -> list[str]:
        """Names that mean something else of the same kind, the most similar first."""
        key, meaning = tokens(name), self.meanings[name]
        found = []
        for other, value in self.meanings.items():
            if callable(value) or callable(meaning) or _shape(value) != _shape(meaning):
                continue
            if value == meaning:
                continue
            theirs = tokens(other)
            same = sum(a.text == b.text for a, b in zip(key, theirs, strict=False))
            differs = theirs[0].text != key[0].text
            found.append((differs, abs(len(key) - len(theirs)), len(key) - same, other))
        return [other for *_, other in sorted(found)]

    def match(self, read: Sequence[Token], at: int) -> tuple[int, str, Any] | None:
        """The longest name that begins at a token: its length, its text and its meaning."""
        if at >= len(read):
            return None
        for key, name, meaning in self._names.get(read[at].text, ()):
            if len(key) <= len(read) - at and all(
                read[at + k].text == part for k, part in enumerate(key)
            ):
                return len(key), name, meaning
        return None

    def write(self, value: Value) -> str:
        """An expression in LaTeX, in the names of the paper where it has them."""
        names: dict[sp.Symbol, str] = {}
        for name, meaning in self.meanings.items():
            if isinstance(meaning, sp.Symbol):
                names.setdefault(meaning, name)
        text = sp.latex(value, symbol_names=names)
        text = re.sub(r"_\{(\w)\}", r"_\1", text)
        return ARGUMENT.sub(r"\\\1\2 \3", text)


def _shape(value: Value) -> tuple[int, ...]:
    return tuple(getattr(value, "shape", ()))


class _Reader:
    """Reads one formula by recursive descent."""

    def __init__(self, notation: Notation, text: str):
        self.notation = notation
        self.text = text
        self.tokens = _lines(tokens(text))
        self.at = 0
        self.decimals = 0
        self.pieces: list[Piece] = []
        self.bars = 0
        """The number of absolute values that are open: if any, a bar closes one."""

    def relations(self) -> tuple[Relation, ...]:
        found = []
        while not self.ended:
            found.append(self.relation())
            self.separators()
        if not found:
            raise self.error("a formula is empty")
        return tuple(found)

    def separators(self) -> None:
        """Skip what separates two relations."""
        start = self.at
        while not self.ended:
            if self.peek in (",", ";", "."):
                self.at += 1
            elif self.peek == r"\text" and self.text_word in LIST_WORDS:
                self.at += 2
            else:
                break
        if self.at == start and not self.ended:
            raise self.error("what follows cannot be read")

    @property
    def text_word(self) -> str:
        r"""The words of a ``\text`` that comes next."""
        return self.tokens[self.at + 1].text[1:-1].strip()

    def relation(self) -> Relation:
        self.decimals = 0
        sides, signs, texts = [], [], []
        while True:
            start = self.at
            sides.append(self.sum())
            texts.append(self.text[self.tokens[start].start : self.tokens[self.at - 1].after])
            if self.peek not in RELATIONS:
                break
            self.note("relation")
            signs.append(RELATIONS[self.take()])
        return Relation(tuple(sides), tuple(signs), tuple(texts), self.decimals)

    def sum(self) -> Value:
        total = None
        while total is None or self.peek in ("+", "-", r"\pm", r"\mp"):
            sign: Value = sp.S.One
            if self.peek in ("+", "-", r"\pm", r"\mp"):
                self.note("sign")
                sign = {"+": sp.S.One, "-": -sp.S.One, r"\pm": SIGN, r"\mp": -SIGN}[self.take()]
            term = sign * self.product()
            total = term if total is None else _added(total, term)
        return total

    def product(self) -> Value:
        value = self.factor()
        while not self.ended:
            if self.peek in ("*", r"\cdot", r"\times", "/"):
                sign = self.take()
                other = self.factor()
                value = _vector_product(sign, value, other)
            elif self.peek == r"\text":
                if self.text_word in (*LIST_WORDS, "if"):
                    break
                self.at += 2  # a unit
            elif self.begins_factor():
                value = value * self.factor()
            else:
                break
        return value

    def begins_factor(self) -> bool:
        text = self.peek
        return (
            text in ("(", "[", "{", r"\frac", r"\sqrt", r"\begin", r"\sum", r"\pi")
            or text in FUNCTIONS
            or (text == "|" and not self.bars)
            or bool(re.match(r"\d", text))
            or self.notation.match(self.tokens, self.at) is not None
        )

    def factor(self) -> Value:
        value = self.base()
        while not self.ended and self.peek == "^":
            named = self.notation.match(self.tokens, self.at)
            if named:
                self.at += named[0]
                value = named[2](value)
                continue
            self.take()
            value = self.power(value)
        return value

    def power(self, value: Value) -> Value:
        if self.peek == r"\circ":
            self.take()
            return value * sp.pi / 180
        if self.peek == "T":
            self.take()
            return value.T
        exponent = self.group("{") if self.peek == "{" else self.base()
        if exponent == -1 and isinstance(value, sp.MatrixBase):
            return value.inv()
        return value**exponent

    def base(self) -> Value:
        if self.ended:
            raise self.error("the formula ends too early")
        named = self.notation.match(self.tokens, self.at)
        if named:
            return self.named(*named)
        text = self.peek
        if re.match(r"\d", text):
            self.note("number")
            self.decimals = max(self.decimals, len(text.partition(".")[2]))
            return sp.Rational(self.take())
        if text in FUNCTIONS:
            return self.function()
        if text in CLOSING:
            return self.listed(text)
        if text == "|":
            return self.absolute()
        if text == r"\text":
            self.at += 2
            return sp.Symbol(self.tokens[self.at - 1].text[1:-1].strip())
        readers = {
            r"\frac": self.fraction, r"\sqrt": self.root, r"\begin": self.environment,
            r"\sum": self.series, r"\pi": lambda: (self.take(), sp.pi)[1],
        }  # fmt: skip
        if text in readers:
            return readers[text]()
        raise self.error("the notation has no such name")

    def named(self, length: int, name: str, meaning: Any) -> Value:
        first = self.tokens[self.at]
        self.at += length
        if not callable(meaning):
            self.pieces.append(Piece("name", first.start, self.tokens[self.at - 1].after, name))
            return meaning
        return meaning(*self.arguments())

    def arguments(self) -> list[Value]:
        """The arguments of a function: a list in brackets, or one factor."""
        if self.peek in ("(", "["):
            closing = CLOSING[self.take()]
            found = [self.sum()]
            while self.peek == ",":
                self.take()
                found.append(self.sum())
            self.expect(closing)
            return found
        value = self.base()
        named = not self.ended and self.notation.match(self.tokens, self.at)
        if isinstance(value, sp.Number) and named:
            value = value * self.base()
        return [value]

    def function(self) -> Value:
        self.note("function")
        name = self.take()
        plain, inverse = FUNCTIONS[name]
        power: Value = sp.S.One
        if self.peek == "^":
            self.take()
            power = self.group("{") if self.peek == "{" else self.base()
        (argument,) = self.arguments()
        return inverse(argument) if power == -1 else plain(argument) ** power

    def listed(self, opening: str) -> Value:
        """A group; with commas in brackets, a row."""
        self.take()
        rows = [[self.sum()]]
        while opening == "[" and self.peek in (",", ";"):
            if self.take() == ";":
                rows.append([])
            rows[-1].append(self.sum())
        self.expect(CLOSING[opening])
        if len(rows) == 1 and len(rows[0]) == 1:
            return rows[0][0]
        return _blocks(rows)

    def absolute(self) -> Value:
        self.expect("|")
        self.bars += 1
        value = self.sum()
        self.bars -= 1
        self.expect("|")
        return sp.Abs(value)

    def group(self, opening: str) -> Value:
        self.expect(opening)
        value = self.sum()
        self.expect(CLOSING[opening])
        return value

    def fraction(self) -> Value:
        self.take()
        top = self.group("{")
        return top / self.group("{")

    def root(self) -> Value:
        self.take()
        degree = self.group("[") if self.peek == "[" else 2
        return sp.root(self.group("{"), degree)

    def environment(self) -> Value:
        self.take()
        kind = self.tokens[self.at].text[1:-1]
        self.at += 1
        if kind == "array":  # the alignment of the columns
            self.expect("{")
            depth = 1
            while depth:
                depth += {"{": 1, "}": -1}.get(self.take(), 0)
        rows: list[list[Value]] = [[]]
        while self.peek != r"\end":
            if self.peek == r"\\":
                self.take()
                if self.peek != r"\end":
                    rows.append([])
            elif self.peek == "&" or (kind == "cases" and self.peek == ","):
                self.take()
            elif kind == "cases" and rows[-1]:
                rows[-1].append(self.condition())
            else:
                rows[-1].append(self.sum())
        self.at += 2
        try:
            if kind == "cases":
                return sp.Piecewise(*((value, condition) for value, condition in rows))
            return _blocks(rows)
        except ValueError as error:
            raise self.error(str(error)) from error

    def condition(self) -> Value:
        """The condition of a case: a relation, after a word such as "if", or "otherwise"."""
        if self.peek == r"\text":
            word = self.text_word
            self.at += 2
            if word in ("otherwise", "else"):
                return sp.true
        return self.relation().relational

    def series(self) -> Value:
        """A sum over an index; the term is read once for each value of the index."""
        self.take()
        self.expect("_")
        self.expect("{")
        index = self.take()
        self.expect("=")
        low = self.sum()
        self.expect("}")
        self.expect("^")
        high = self.group("{") if self.peek == "{" else self.base()
        start, total = self.at, None
        kept = self.tokens
        for k in range(int(low), int(high) + 1):
            self.at = start
            self.tokens = [
                t if t.text != index or i < start else Token(str(k), t.start, t.end)
                for i, t in enumerate(kept)
            ]
            term = self.product()
            total = term if total is None else _added(total, term)
        self.tokens = kept
        return total

    @property
    def ended(self) -> bool:
        return self.at >= len(self.tokens)

    @property
    def peek(self) -> str:
        return "" if self.ended else self.tokens[self.at].text

    def take(self) -> str:
        if self.ended:
            raise self.error("the formula ends too early")
        self.at += 1
        return self.tokens[self.at - 1].text

    def note(self, kind: str) -> None:
        token = self.tokens[self.at]
        self.pieces.append(Piece(kind, token.start, token.start + len(token.text)))

    def expect(self, text: str) -> None:
        if self.peek != text:
            raise self.error(f"{text} is missing")
        self.at += 1

    def error(self, why: str) -> NotationError:
        at = len(self.text) if self.ended else self.tokens[self.at].start
        return NotationError(f"{self.text[:at]} >>> {self.text[at:]}: {why}")


def _lines(read: list[Token]) -> list[Token]:
    """The tokens with aligned lines joined: a comma separates the lines that begin a relation."""
    if not any(t.text == "{aligned}" for t in read):
        return read
    found: list[Token] = []
    lines: list[list[Token]] = [[]]
    for token in read:
        if token.text == r"\\" and not _depth(found):
            lines.append([])
        elif token.text != "&" or _depth(found):
            lines[-1].append(token)
        found.append(token)
    joined: list[Token] = []
    for line in lines:
        plain = [
            t
            for k, t in enumerate(line)
            if t.text != "{aligned}"
            and not (t.text in (r"\begin", r"\end") and line[k + 1].text == "{aligned}")
        ]
        if not plain:
            continue
        starts = plain[0].text not in RELATIONS and plain[0].text != "+"
        if plain[0].text == "-":
            starts = any(t.text in RELATIONS for t in plain)
        if joined and starts:
            joined.append(Token(",", plain[0].start, plain[0].start))
        joined += plain
    return joined


def _depth(read: Sequence[Token]) -> int:
    """How many environments other than ``aligned`` are open."""
    steps = {r"\begin": 1, r"\end": -1}
    return sum(steps.get(a.text, 0) for a, b in pairwise(read) if b.text != "{aligned}")


def _added(a: Value, b: Value) -> Value:
    """The sum; zero may stand for a matrix of zeros."""
    if isinstance(a, sp.MatrixBase) and b == 0:
        return a
    if isinstance(b, sp.MatrixBase) and a == 0:
        return b
    return a + b


def _vector_product(sign: str, a: Value, b: Value) -> Value:
    if sign == "/":
        return a / b
    vectors = all(isinstance(v, sp.MatrixBase) and v.cols == 1 for v in (a, b))
    if vectors and sign == r"\cdot":
        return a.dot(b)
    if vectors and sign == r"\times":
        return a.cross(b)
    return a * b


def _blocks(rows: Sequence[Sequence[Value]]) -> sp.Matrix:
    """A matrix; its entries may be matrices, and then 0 stands for a block of zeros."""
    if len({len(row) for row in rows}) != 1:
        raise NotationError("the rows of a matrix differ in length")
    if not any(isinstance(e, sp.MatrixBase) for row in rows for e in row):
        return sp.Matrix([list(row) for row in rows])
    heights = [max([e.rows for e in row if isinstance(e, sp.MatrixBase)] or [1]) for row in rows]
    columns = list(zip(*rows, strict=True))
    widths = [max([e.cols for e in c if isinstance(e, sp.MatrixBase)] or [1]) for c in columns]
    found = []
    for row, height in zip(rows, heights, strict=True):
        blocks = []
        for entry, width in zip(row, widths, strict=True):
            if not isinstance(entry, sp.MatrixBase):
                if entry != 0 and (height, width) != (1, 1):
                    raise NotationError(f"{entry} cannot be a block of {height} by {width}")
                entry = sp.zeros(height, width) if entry == 0 else sp.Matrix([[entry]])
            blocks.append(entry)
        found.append(sp.Matrix.hstack(*blocks))
    return sp.Matrix.vstack(*found)
