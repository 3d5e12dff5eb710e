"""Reads a formula from untrusted text: the text is parsed and never executed.

A formula consists of numbers, names, ``pi``, ``+ - * / **``, parentheses and the functions below.
Numbers are exact: 0.1 is 1/10.  Everything else that Python can express is refused, and so is a
formula that is too long, too deep, or too large when it is expanded.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import sympy as sp


class FormulaError(ValueError):
    """A text is not a formula or exceeds a limit; the message says why."""


@dataclass(frozen=True)
class Limits:
    """The limits of a formula: characters, nesting, and terms and degree when it is expanded.

    ``bits`` are those of a numerator or denominator: SymPy factors polynomials with larger ones by
    primes of the same size, and takes minutes to find one.
    """

    length: int = 200
    depth: int = 30
    terms: int = 64
    degree: int = 12
    bits: int = 256


TABLE = Limits()
DIGITS = 77
"""The decimal digits of such a number."""
PRINTED = Limits(length=100_000, depth=100, terms=10**9, degree=10**9, bits=1024)
"""The limits of a formula that this toolkit has printed itself."""
EXPONENT = 9
CANCELLED = sp.Rational(1, 10**20)
"""A sum of numbers below this fraction of its terms counts as zero: SymPy could need hours."""

FUNCTIONS: dict[str, tuple[int, Callable[..., sp.Expr]]] = {
    "Abs": (1, sp.Abs),
    "atan": (1, sp.atan),
    "atan2": (2, sp.atan2),
    "cos": (1, sp.cos),
    "sin": (1, sp.sin),
    "sqrt": (1, sp.sqrt),
    "tan": (1, lambda x: sp.sin(x) / sp.cos(x)),
}
"""The number of arguments of each function, and its implementation."""
NUMBER = re.compile(r"(\d{1,400}(?:\.\d{0,400})?|\.\d{1,400})(?:[eE]([-+]?\d{1,3}))?", re.ASCII)
TOKEN = re.compile(rf"(?P<space>[ \t]+)|(?P<number>{NUMBER.pattern})(?![\w.])"
                   r"|(?P<name>[A-Za-z_]\w*)|(?P<sign>\*\*|[-+*/(),])", re.ASCII)  # fmt: skip


def number(text: str, bits: int = TABLE.bits) -> Fraction:
    """The exact value of a decimal or of a fraction such as ``9/20``, with a sign or without."""
    body = text.removeprefix("-") if text.startswith("-") else text.removeprefix("+")
    over, slash, under = body.partition("/")
    whole = slash and (over + under).isascii() and (over + under).isdecimal()
    if len(text) > TABLE.length or not NUMBER.fullmatch(over) or (slash and not whole):
        raise FormulaError(f"{shown(text)} is not a number such as 0.45 or 9/20")
    if slash and not int(under):
        raise FormulaError(f"{shown(text)} divides by zero")
    value = Fraction(body)
    if max(value.numerator, value.denominator).bit_length() > bits:
        raise FormulaError(
            f"{shown(text)} is too large, too small or too long: write it with at most "
            f"{DIGITS} digits before and after the point"
        )
    return -value if text.startswith("-") else value


def formula(text: str, symbol: Callable[[str], sp.Expr], limits: Limits = TABLE) -> sp.Expr:
    """The exact expression for a text; ``symbol`` gives the expression for a name, or raises.

    Raises :class:`FormulaError` if the text is not a formula within the limits.
    """
    if len(text) > limits.length:
        raise FormulaError(
            f"a formula has at most {limits.length} characters, and {shown(text)} has {len(text)}"
        )
    text = text.strip(" \t")
    names = {name: symbol(name) for name in _names(text)}
    try:
        tree = ast.parse(text, mode="eval")
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise FormulaError(_unread(text)) from error
    return _Reader(text, names, limits).read(tree.body, 0).value


def shown(text: object) -> str:
    """A text of a table for a message: on one line, without control characters, shortened."""
    quoted = repr(text) if isinstance(text, str | int | bool) else f"a {type(text).__name__}"
    return quoted if len(quoted) <= 60 else f"{quoted[:56]} ..."


def _unread(text: str, why: str = "a formula has symbols, numbers and + - * /") -> str:
    return f"cannot read {shown(text)}; {why}"


def _names(text: str) -> Iterator[str]:
    """The names of symbols in a text; raises if a token cannot occur in a formula."""
    place = 0
    while place < len(text):
        token = TOKEN.match(text, place)
        if not token:
            why = f"a formula has no {text[place]!a}"
            if text[place].isdecimal() or text[place] == ".":
                why = "a number is written as 2, 0.25 or 1e-3, with at most three digits after e"
            raise FormulaError(_unread(text, why))
        place = token.end()
        name = token["name"]
        if name in FUNCTIONS or (name and text[place:].lstrip(" \t").startswith("(")):
            if name not in FUNCTIONS:
                known = ", ".join(FUNCTIONS)
                raise FormulaError(
                    _unread(text, f"{shown(name)} is not a function; there are {known}")
                )
        elif name and name != "pi":
            yield name


@dataclass(frozen=True)
class _Part:
    """An expression, with bounds on the number of its terms and on its degree when expanded."""

    value: sp.Expr
    terms: int = 1
    degree: int = 0


@dataclass(frozen=True)
class _Reader:
    """Turns the nodes of a syntax tree into SymPy objects; unknown nodes are refused."""

    text: str
    names: dict[str, sp.Expr]
    limits: Limits

    def read(self, node: ast.expr, depth: int) -> _Part:
        if depth > self.limits.depth:
            raise FormulaError(_unread(self.text, "it is nested too deeply"))
        match node:
            case ast.Constant():
                part = self._number(node)
            case ast.Name(id="pi"):
                part = _Part(sp.pi)
            case ast.Name(id=name) if name in self.names:
                part = _Part(self.names[name], degree=1)
            case ast.UnaryOp(op=ast.USub(), operand=operand):
                inner = self.read(operand, depth + 1)
                part = _Part(-inner.value, inner.terms, inner.degree)
            case ast.UnaryOp(op=ast.UAdd(), operand=operand):
                part = self.read(operand, depth + 1)
            case ast.BinOp(left=left, op=operator, right=right):
                part = self._binary(
                    self.read(left, depth + 1), operator, self.read(right, depth + 1)
                )
            case ast.Call(func=ast.Name(id=name), args=arguments, keywords=[]):
                part = self._call(name, [self.read(a, depth + 1) for a in arguments])
            case _:
                raise FormulaError(_unread(self.text))
        self._check(part)
        return part

    def _number(self, node: ast.Constant) -> _Part:
        written = self.text[node.col_offset : node.end_col_offset]
        if type(node.value) not in (int, float):
            raise FormulaError(_unread(self.text))
        value = number(written, self.limits.bits)
        return _Part(sp.Rational(value.numerator, value.denominator))

    def _binary(self, left: _Part, operator: ast.operator, right: _Part) -> _Part:
        a, b = left.value, right.value
        degree = left.degree + right.degree
        match operator:
            case ast.Add():
                terms = left.terms + right.terms
                return _Part(a + b, terms, max(left.degree, right.degree))
            case ast.Sub():
                terms = left.terms + right.terms
                return _Part(a - b, terms, max(left.degree, right.degree))
            case ast.Mult():
                return _Part(a * b, left.terms * right.terms, degree)
            case ast.Div():
                if b == 0:
                    raise FormulaError(_unread(self.text, "it divides by zero"))
                return _Part(a / b, left.terms * right.terms, degree)
            case ast.Pow():
                return self._power(left, b)
        raise FormulaError(_unread(self.text))

    def _power(self, base: _Part, exponent: sp.Expr) -> _Part:
        if not (exponent.is_Rational and abs(exponent) <= EXPONENT and exponent.q <= 2):
            why = f"an exponent is a whole number from -{EXPONENT} to {EXPONENT}, or a half"
            raise FormulaError(_unread(self.text, why))
        if base.value == 0 and exponent < 0:
            raise FormulaError(_unread(self.text, "it divides by zero"))
        times = int(sp.ceiling(abs(exponent)))
        terms, degree = base.terms**times, base.degree * times
        self._check_size(terms, degree)
        return _Part(base.value**exponent, terms, degree)

    def _call(self, name: str, arguments: list[_Part]) -> _Part:
        count, function = FUNCTIONS.get(name, (-1, sp.S.Zero))
        if len(arguments) != count:
            raise FormulaError(
                _unread(self.text, f"{name} takes {count} argument{'s' * (count != 1)}")
            )
        value = function(*(a.value for a in arguments))
        return _Part(value, degree=max(min(a.degree, 1) for a in arguments))

    def _check(self, part: _Part) -> None:
        value = part.value
        if not isinstance(value, sp.Expr) or value.has(sp.nan, sp.zoo, sp.oo, -sp.oo, sp.I):
            raise FormulaError(f"{shown(self.text)} is not a real number or formula")
        self._check_size(part.terms, part.degree)
        for rational in value.atoms(sp.Rational):
            if max(abs(rational.p), rational.q).bit_length() > self.limits.bits:
                raise FormulaError(
                    _unread(self.text, f"its numbers have more than {DIGITS} digits")
                )
        if value.is_Add and not value.free_symbols:
            largest = max(abs(term.evalf(15)) for term in value.args)
            if not abs(value.evalf(15, maxn=60)) > CANCELLED * largest:
                raise FormulaError(_unread(self.text, "its terms cancel; write 0 instead"))

    def _check_size(self, terms: int, degree: int) -> None:
        if terms > self.limits.terms or degree > self.limits.degree:
            raise FormulaError(_unread(self.text, "it is too large when it is written out"))


__all__ = ["PRINTED", "TABLE", "FormulaError", "Limits", "formula", "number", "shown"]
