"""Formulas as text for a terminal: LaTeX, and expressions with cases.

A library such as pylatexenc leaves out the brackets of a numerator: ``a+b/c`` for ``(a+b)/c``.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Callable

import sympy as sp
from sympy.printing.str import StrPrinter

from closedform.emit.text import unbold

WIDTH = 100
TOKEN = re.compile(r"\\\\(?:\[[^\]]*\])?|\\[A-Za-z]+|\\.|\s+|.", re.DOTALL)
SIMPLE = re.compile(r"-?\w+|.|\|\|")
"""An index or an exponent without brackets."""
ATOM = re.compile(r"[∂\w.']+|\([^()]*\)")
"""A numerator or a denominator without brackets."""
AFTER_INDEX = re.compile(r"[_^]-?\w+$")
LAST = re.compile(r"[^\W\d_]*$")
GREEK = """alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi omicron pi rho
sigma tau upsilon phi chi psi omega"""
LETTERS = {name: chr(0x3B1 + k + (k > 16)) for k, name in enumerate(GREEK.split())}
LETTERS |= {name.capitalize(): letter.upper() for name, letter in LETTERS.items()}
LETTERS |= {"vartheta": "ϑ", "varsigma": "ς", "varphi": "φ", "varepsilon": "ε"}
SIGNS = {
    "cdot": ("·", "*"),
    "times": (" × ", " x "),
    "ast": ("*", "*"),
    "cdots": ("...", "..."),
    "ldots": ("...", "..."),
    "partial": ("∂", "d"),
    "infty": ("∞", "oo"),
    "pm": ("±", "+-"),
    "le": ("≤", "<="),
    "ge": ("≥", ">="),
    "ne": ("≠", "!="),
    "parallel": ("∥", "||"),
    "perp": ("⊥", "perp"),
    "Rightarrow": ("⇒", "=>"),
    "ell": ("l", "l"),
    "circ": ("°", " deg"),
    "lVert": ("‖", "||"),
    "rVert": ("‖", "||"),
    "Vert": ("‖", "||"),
    "lvert": ("|", "|"),
    "rvert": ("|", "|"),
    "vert": ("|", "|"),
}
"""Commands for a sign, in Unicode and in ASCII."""
OPERATORS = {"sin", "cos", "tan", "arcsin", "arccos", "arctan", "det", "min", "max", "exp", "log"}
PLAIN = {"text", "mathrm", "mathbf", "mathcal", "boldsymbol", "operatorname", "overrightarrow"}
"""Commands that change the look of their argument."""
ACCENTS = {"hat": "\N{COMBINING CIRCUMFLEX ACCENT}", "dot": "\N{COMBINING DOT ABOVE}"}
SIZES = {"left", "right", "bigl", "bigr", "Bigl", "Bigr", "displaystyle"}


def from_latex(latex: str, *, pretty: bool = True) -> str:
    """A formula in LaTeX as text on one line, with Greek letters or, unless ``pretty``, in ASCII.

    What the text cannot show, such as bold letters, is left out.  A command that is not known is
    written by its name.
    """
    return " ".join(_Reader(latex, pretty).row().split())


def mixed(text: str, *, pretty: bool = True) -> str:
    """Text whose formulas are between dollar signs."""
    parts = text.split("$")
    return "".join(from_latex(p, pretty=pretty) if i % 2 else p for i, p in enumerate(parts))


class _Reader:
    def __init__(self, latex: str, pretty: bool) -> None:
        self.tokens: list[str] = TOKEN.findall(latex)[::-1]
        self.pretty = pretty

    def row(self, *ends: str) -> str:
        """The text up to one of these tokens, which is left."""
        found = ""
        while self.tokens and self.tokens[-1] not in ends:
            found = self._joined(found, self._item())
        return found

    def _joined(self, before: str, piece: str) -> str:
        if not (before and piece and piece[0].isalnum()):
            return before + piece
        ended = before[-1].isalnum() or before[-1] in ACCENTS.values()
        named = piece in OPERATORS or (not self.pretty and piece in LETTERS)
        apart = (named and ended) or self._is_word(before)
        return f"{before} {piece}" if apart or AFTER_INDEX.search(before) else before + piece

    def _is_word(self, before: str) -> bool:
        """Whether the text ends with a name of several letters, to which nothing can be added."""
        last = LAST.findall(before)[0]
        return last in OPERATORS or (not self.pretty and last in LETTERS)

    def _item(self) -> str:
        token = self.tokens.pop()
        if token == "{":
            found = self.row("}")
            self._skip("}")
            return found
        if token in ("_", "^"):
            raised = self._argument()
            if raised in SIGNS["circ"]:
                return raised
            index = raised.strip()
            return token + (index if SIMPLE.fullmatch(index) else f"({index})")
        if token.isspace() or token in (r"\,", r"\;", r"\:", r"\ "):
            return " "
        if token == r"\!":
            return ""
        if not token.startswith("\\"):
            return token
        return self._command(token[1:])

    def _command(self, name: str) -> str:
        if name in LETTERS:
            return LETTERS[name] if self.pretty else name
        if name in ("lVert", "lvert", "partial"):
            self._skip(" ")
        if name in SIGNS:
            return SIGNS[name][not self.pretty]
        if name in PLAIN:
            return self._argument()
        if name in ACCENTS:
            return self._argument() + ACCENTS[name] * self.pretty
        if name in SIZES:
            return ""
        if name in ("frac", "tfrac", "dfrac"):
            over, under = (self._argument() for _ in range(2))
            return "/".join(e if ATOM.fullmatch(e) else f"({e})" for e in (over, under))
        if name == "sqrt":
            return f"sqrt({self._argument()})"
        if name == "begin":
            return self._matrix()
        return {"quad": " ", "qquad": " ", "|": SIGNS["Vert"][not self.pretty]}.get(name, name)

    def _argument(self) -> str:
        while self.tokens and self.tokens[-1].isspace():
            self.tokens.pop()
        return self._item() if self.tokens else ""

    def _matrix(self) -> str:
        """Rows between semicolons, entries between commas."""
        self._argument()
        rows: list[list[str]] = [[]]
        while self.tokens:
            line = next((t for t in self.tokens[::-1] if t.startswith(r"\\")), r"\\")
            rows[-1].append(" ".join(self.row("&", line, r"\end").split()))
            end = self.tokens.pop() if self.tokens else r"\end"
            if end == r"\end":
                self._argument()
                break
            if end == line:
                rows.append([])
        return f"[{'; '.join(', '.join(row) for row in rows)}]"

    def _skip(self, token: str) -> None:
        if self.tokens and self.tokens[-1] == token:
            self.tokens.pop()


class _Printer(StrPrinter):  # type: ignore[misc]
    """Cases as "a if c, else b", and equations with a sign."""

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        return f"({self.cases(expr)})"

    def cases(self, expr: sp.Piecewise) -> str:
        says: Callable[[sp.Basic], str] = self._print
        cases = [(says(e), c == sp.true or says(c)) for e, c in expr.args]
        return ", ".join(f"else {e}" if c is True else f"{e} if {c}" for e, c in cases)

    def _print_Equality(self, expr: sp.Eq) -> str:
        return f"{self._print(expr.lhs)} = {self._print(expr.rhs)}"


def expression(value: object) -> str:
    """An expression as text; cases are written with "if" and "else"."""
    printer = _Printer()
    found = printer.cases(value) if isinstance(value, sp.Piecewise) else printer.doprint(value)
    return str(found)


def decimal(value: sp.Expr) -> str:
    """A number as a decimal where that is exact, and else as it is."""
    if not isinstance(value, sp.Rational):
        return str(value)
    twos, fives = sp.multiplicity(2, value.q), sp.multiplicity(5, value.q)
    if value.q != 2**twos * 5**fives:
        return str(value)
    places = max(twos, fives)
    digits = str(abs(value.p) * 10**places // value.q).rjust(places + 1, "0")
    whole, part = digits[: len(digits) - places], digits[len(digits) - places :]
    sign = "-" if value.p < 0 else ""
    return f"{sign}{whole}.{part}" if part else f"{sign}{whole}"


def heading(title: str) -> tuple[str, ...]:
    """A heading, with an empty line above it."""
    return ("", title, "-" * len(title))


def paragraph(text: str, indent: int = 0, hang: int = 4) -> list[str]:
    """Lines of at most :data:`WIDTH` columns; all but the first are indented more if any is."""
    first, rest = " " * indent, " " * (indent + hang * bool(indent))
    return textwrap.wrap(unbold(text), WIDTH, initial_indent=first, subsequent_indent=rest)


__all__ = ["WIDTH", "decimal", "expression", "from_latex", "heading", "mixed", "paragraph"]
