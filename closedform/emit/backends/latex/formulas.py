"""Expressions as LaTeX, in the form in which a person writes them.

A sum starts with a positive term.  A product has its factors in a fixed order: numbers, signs of
branches, lengths, roots, short sines and cosines, sums, long sines and cosines.  The printer does
not write ``\\left(``, because TeX never breaks inside it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache, lru_cache
from itertools import chain
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter

from closedform.emit.backends.latex.called import GREEK, as_it_is
from closedform.emit.backends.latex.prose import loosen, spaced, symbol_name
from closedform.emit.backends.latex.vectors import is_vector

FITS = 76.0
"""The widest formula that is set on one line, in average letters of 10 pt."""

SIGN = re.compile(r"sigma(_|$)")
JOINT = re.compile(r"theta(\d)([A-Z]?)")
TRIGONOMETRIC = sp.sin | sp.cos | sp.tan
WAVES = (sp.sin, sp.cos)
SHORT = re.compile(r"\\mathrm\{([cs])\}(_.+)")
"""An abbreviated sine or cosine."""


class Printer(LatexPrinter):  # type: ignore[misc]
    """LaTeX with upright c, s for cosines and sines of (sums of) numbered joint angles.

    ``names`` are the symbols that are not printed by the rule of :func:`symbol_name`.
    """

    def __init__(self, joints: set[sp.Symbol], names: Mapping[sp.Symbol, str] | None = None):
        super().__init__({"long_frac_ratio": 20, "fold_frac_powers": True})
        self.joints, self.legend = joints, dict[str, str]()
        self.names: Mapping[sp.Symbol, str] = dict(names or {})
        self.parameters = frozenset[str]()
        """Names of parameters: a length ``c1`` is not the cosine of ``theta1``."""
        self.written: dict[str, str] = {}
        """What the derivation says of how symbols are written, by their names."""
        self.called: Callable[[str], str] = as_it_is
        """How names are spelled in which joints occur that are called by words."""
        self._texts: dict[sp.Basic, str] = {}
        self._printed = set[sp.Symbol]()
        """The symbols in the texts that are kept."""

    def rename(self, names: Mapping[sp.Symbol, str]) -> None:
        """Print symbols by these names from now on; texts with their former names are forgotten."""
        changed = {s for s, name in names.items() if self.names.get(s) != name}
        self.names = {**self.names, **names}
        if changed & self._printed:
            self._texts.clear()
            self._printed.clear()

    @contextmanager
    def written_as(self, names: Mapping[sp.Symbol, str]) -> Iterator[None]:
        """Print symbols by these names meanwhile, in whatever way they are declared."""
        before = self.written, self.joints
        self.written = {**self.written, **{str(s.name): name for s, name in names.items()}}
        self.joints = self.joints - names.keys()
        self._texts.clear()
        try:
            yield
        finally:
            self.written, self.joints = before
            self._texts.clear()

    def _print(self, expr: Any, **kwargs: Any) -> str:
        """A part of an expression; the same parts are printed again and again."""
        if kwargs or not isinstance(expr, sp.Basic):
            return str(super()._print(expr, **kwargs))
        if expr not in self._texts:
            self._texts[expr] = str(super()._print(expr))
        return self._texts[expr]

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        self._printed.add(expr)
        if known := self.written.get(expr.name) or self.names.get(expr):
            return known
        name = self.called(expr.name)
        pair = None if name in self.parameters else re.fullmatch(r"([cs])(\d)(?:_0)?", name)
        named = (j for j in self.joints if pair and self.called(j.name) == f"theta{pair[2]}")
        joint = next(named, None)
        if pair and joint is not None:  # the cosine or the sine of a joint that was solved
            return str(self._print(sp.cos(joint) if pair[1] == "c" else sp.sin(joint)))
        return symbol_name(name)

    def _print_Integer(self, expr: sp.Integer) -> str:
        return integer(int(expr))

    def _print_Rational(self, expr: sp.Rational) -> str:
        return self._print_Mul(expr) if expr.q != 1 else integer(int(expr))

    # Sums

    def _as_ordered_terms(self, expr: sp.Add, order: str | None = None) -> list[sp.Expr]:
        """The terms in SymPy's order, but if that starts with a minus, the positive ones first.

        A direction comes before an angle to either side of it.
        """
        renamed = {s: self._by_letter(s) for s in expr.free_symbols if self._called(s)}
        if renamed:
            former = {new: old for old, new in renamed.items()}
            in_order = _ordered_terms(expr.xreplace(renamed), order or self.order)
            terms = [t.xreplace(former) for t in in_order]
        else:
            terms = list(_ordered_terms(expr, order or self.order))
        if _negative(terms[0]):
            terms.sort(key=_negative)
        if terms[-1].is_number and all(t.has(*WAVES) for t in terms[:-1]):  # 1 + cos
            terms.sort(key=lambda term: not (term.is_number and term.is_positive))
        if any(e.is_Symbol and SIGN.match(e.name) for e in terms[0].args):
            terms.sort(key=lambda term: not isinstance(term, sp.atan2))
        if all(term.is_Pow and term.exp == 2 for term in terms):
            terms.sort(key=_coordinate)
        return _with_common_fractions(terms)

    def _called(self, symbol: sp.Symbol) -> str:
        """How a symbol is written if that does not follow from its name."""
        return self.written.get(str(symbol.name)) or self.names.get(symbol, "")

    def _by_letter(self, symbol: sp.Symbol) -> sp.Symbol:
        """A symbol that SymPy sorts by what is printed for this one."""
        letter = re.sub(r"\\(?:math[a-z]+|prime)|[\\{}^ ]", "", self._called(symbol))
        return sp.Symbol(letter, **symbol.assumptions0)

    # Products

    def _print_Mul(self, expr: sp.Mul) -> str:
        """A product; one with a fraction inside a fraction is printed as a single fraction."""
        text = self._fraction(expr)
        if is_nested(text) and (whole := sp.together(expr)).is_Mul:
            text = self._fraction(whole)
        return flat(text) if is_nested(text) else text

    def _fraction(self, expr: sp.Mul) -> str:
        number, factors = _number(expr)
        if number.is_negative and (turned := _turned(factors)):
            number, factors = -number, turned
        number, over, under, radicands = _sides(number, factors)
        over_root, under_root = map(self._root, radicands)
        sign = "- " if number.is_negative else ""
        p, q = abs(number.p), number.q
        if not (under or under_root):
            if q == 1:
                return sign + self._product(p, over, over_root)
            if small := _small(p, q):
                rest = [self._product(1, over, over_root)] if over or over_root else []
                return sign + self._joined([small, *rest])
            if over or over_root:
                return sign + self._fractional(p, q, over, over_root)
        top = self._product(p, over, over_root, alone=True)
        bottom = self._product(q, under, under_root, alone=True)
        return rf"{sign}\frac{{{top}}}{{{bottom}}}"

    def _fractional(self, p: int, q: int, factors: Sequence[sp.Expr], root: str) -> str:
        """A product with a rational number; a sum stands behind the fraction."""
        numbers = [f for f in factors if f.is_number and not f.is_Add]
        rest = [f for f in factors if f not in numbers]
        whole = self._product(p, factors, root, alone=True)
        if not any(f.is_Add for f in rest) or (len(rest) == 1 and measure(whole) < 12):
            return rf"\frac{{{whole}}}{{{integer(q)}}}"
        front = rf"\frac{{{self._product(p, numbers, '', alone=True)}}}{{{integer(q)}}}"
        return self._joined([front, self._product(1, rest, root)])

    def _root(self, radicands: Sequence[sp.Expr]) -> str:
        if not radicands:
            return ""
        if len(radicands) == 1:
            return rf"\sqrt{{{self._print(radicands[0])}}}"
        return rf"\sqrt{{{self._print_Mul(sp.Mul(*radicands, evaluate=False))}}}"

    def _product(
        self, number: int, factors: Sequence[sp.Expr], root: str, *, alone: bool = False
    ) -> str:
        """Factors in order; a sum that stands alone in a numerator needs no parentheses."""
        if alone and number == 1 and len(factors) == 1 and not root:
            return str(self._print(factors[0]))
        placed = sorted(((self._place(f), f) for f in factors), key=lambda pair: pair[0])
        parts = [(place[0], self._factor(f)) for place, f in placed]
        parts += [(2, root)] if root else []
        parts.sort(key=lambda part: part[0])
        texts = ([integer(number)] if number != 1 else []) + [text for _, text in parts]
        return self._joined([t for t in texts if t != "1"] or ["1"])

    def _factor(self, factor: sp.Expr) -> str:
        text = str(self._print(factor))
        if factor.is_Add or factor.is_Piecewise or text.startswith("-"):
            return rf"\left({text}\right)"
        return text

    def _joined(self, texts: Sequence[str]) -> str:
        done = ""
        for text in texts:
            digits = done[-1:].isdigit() and text[:1].isdigit()
            done += (r" \cdot " if digits else " " if done else "") + text
        return done

    def _place(self, factor: sp.Expr) -> tuple[Any, ...]:
        """The key by which factors are ordered."""
        base, power = factor.as_base_exp()
        if factor.is_number:
            return (0, 0, "", str(factor))
        if is_vector(base):
            return (6, 0, natural(str(base)), str(power))
        if base.is_Symbol:
            text = self._print_Symbol(base)
            if pair := SHORT.fullmatch(text):  # the sine or the cosine of a joint that was solved
                return (3, 0, natural(pair[2]), (pair[1] == "s", str(power)))
            kind = 1 if SIGN.match(base.name) else 2
            greek = re.sub(r"\d.*|_.*", "", base.name).strip("\\ ") in GREEK
            entry = text[:1].isupper() and base.name not in self.parameters
            return (kind, kind == 2 and (greek, entry), natural(text), str(power))
        if isinstance(base, TRIGONOMETRIC):
            text = self._print(base)
            short = text.startswith(r"\mathrm")
            order = re.sub(r"^\\mathrm\{\w\}", "", text) if short else self._print(base.args[0])
            return (3 if short else 5, 0, natural(order), (isinstance(base, sp.sin), str(power)))
        return (4 if factor.is_Add or base.is_Add else 3, 1, _as_text(factor), str(power))

    # Functions

    def _print_sin(self, expr: sp.Expr, exp: str | None = None) -> str:
        angle = expr.args[0]
        return self._circular("sin", self._from_joint(angle) if exp == "2" else angle, exp)

    def _print_cos(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._circular("cos", self._from_joint(expr.args[0]), exp)

    def _from_joint(self, angle: sp.Expr) -> sp.Expr:
        """The angle or its negative, so that a joint is not subtracted from another angle."""
        terms = {_negative(t): t in self.joints or -t in self.joints for t in angle.args}
        turned = angle.is_Add and len(angle.args) == 2 and terms == {False: False, True: True}
        return -angle if turned else angle

    def _print_tan(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._circular("tan", expr.args[0], exp)

    def _circular(self, function: str, angle: sp.Expr, exp: str | None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        numbers = [
            (JOINT.fullmatch(self.called(str(term))) if term in self.joints else None)
            for term in _ordered_terms(angle, None)
        ]
        over, under = _over_under(angle)
        if angle.is_Add and under.is_Integer and under != 1:
            full = rf"\frac{{{self._print(over)}}}{{{under}}}"
        else:
            full = self._print(angle)
            if not angle.is_Symbol and not FRACTION.fullmatch(full):
                full = rf"\left({full}\right)"
        if all(numbers):
            index = sorted(n[1] + (rf"\mathrm{{{n[2]}}}" if n[2] else "") for n in numbers if n)
            short = rf"\mathrm{{{function[0]}}}_{{{''.join(index)}}}"
            self.legend[short] = loosen(rf"\{function} {full}")
            return short + power
        return rf"\{function}{power} {full}"

    def _print_asin(self, expr: sp.Expr, exp: str | None = None) -> str:
        return rf"\arcsin\left({self._print(expr.args[0])}\right)"

    def _print_acos(self, expr: sp.Expr, exp: str | None = None) -> str:
        return rf"\arccos\left({self._print(expr.args[0])}\right)"

    def _print_atan(self, expr: sp.Expr, exp: str | None = None) -> str:
        y, x = sp.fraction(sp.together(expr.args[0]))
        if x != 1:  # SymPy makes it of an atan2 whose second argument is positive
            return self._print_atan2(sp.atan2(y, x, evaluate=False))
        return rf"\arctan\left({self._print(expr.args[0])}\right)"

    def _print_atan2(self, expr: sp.Expr) -> str:
        y, x = map(self._print, expr.args)
        return rf"\operatorname{{atan2}}\left({y},\ {x}\right)"

    def _print_Resolvent(self, expr: sp.Expr) -> str:
        return rf"\operatorname{{root}}({', '.join(map(self._print, expr.args))})"

    def _print_Abs(self, expr: sp.Expr, exp: str | None = None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        return rf"\left|{self._print(expr.args[0])}\right|{power}"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        cases = [rf"{self._print(e)}, & {self.case(c)}" for e, c in expr.args]
        return rf"\begin{{cases}}{stacked(cases)}\end{{cases}}"

    def case(self, condition: Any) -> str:
        if condition == sp.true:
            return r"\text{otherwise}"
        return rf"\text{{if {self.condition(condition)}}}"

    def condition(self, condition: Any) -> str:
        """A condition in words and formulas."""
        if isinstance(condition, sp.Not):
            return f"not {self.condition(condition.args[0])}"
        if isinstance(condition, sp.And | sp.Or):
            word = " and " if isinstance(condition, sp.And) else " or "
            return word.join(sorted(map(self.condition, condition.args)))
        if condition.is_Symbol and condition not in self.names:
            self._printed.add(condition)
            return str(condition.name).replace("_", " ")
        return f"${self._print(condition)}$"

    def math(self, expr: Any) -> str:
        """An expression that TeX can break between its terms."""
        return spaced(loosen(SQUARED.sub(r"\1", self.doprint(expr))))


# The same sums and angles are printed again and again, to find the narrowest form.
@cache
def _ordered_terms(expr: sp.Expr, order: str | None) -> tuple[sp.Expr, ...]:
    return tuple(expr.as_ordered_terms(order=order))


@cache
def _over_under(angle: sp.Expr) -> tuple[sp.Expr, sp.Expr]:
    over, under = sp.fraction(sp.together(angle))
    return over, under


def _negative(term: sp.Expr) -> bool:
    return bool(term.as_coeff_Mul()[0].is_negative)


def _coordinate(square: sp.Expr) -> float:
    """Where a square stands in a distance: x, y and z in this order, a sine after a cosine."""
    letters = [n for s in square.free_symbols if (n := str(s.name)) in ("x", "y", "z")]
    if letters:
        return "xyz".index(min(letters))
    return 1.5 if square.has(sp.sin) and not square.has(sp.cos) else 0.5


def _turned(factors: Sequence[sp.Expr]) -> list[sp.Expr] | None:
    """The factors with the opposite sign: the sine of b - a for that of a - b."""
    for k, factor in enumerate(factors):
        sine, power = factor.as_base_exp()
        if isinstance(sine, sp.sin | sp.tan) and power in (1, -1) and sine.args[0].is_Add:
            signs = {_negative(term) for term in sine.args[0].args}
            if signs == {True, False} and len(sine.args[0].args) == 2:
                turned = sine.func(-sine.args[0], evaluate=False) ** power
                return [*factors[:k], turned, *factors[k + 1 :]]
    return None


def _factors(expr: sp.Expr) -> list[sp.Expr]:
    return list(sp.Mul.make_args(expr))


def _with_common_fractions(terms: Sequence[sp.Expr]) -> list[sp.Expr]:
    """The terms of a sum, with halves (or thirds, ...) of symbols as one: ``x + (a + b)/2``."""
    numbers = [t.as_coeff_Mul() for t in terms]
    parts = [(n, s) for n, s in numbers if s.is_Symbol and abs(n.p) == 1 and n.q != 1]
    q = parts[0][0].q if parts else 1
    if not 2 <= len(parts) < len(terms) or any(n.q != q for n, _ in parts):
        return list(terms)
    parts.sort(key=lambda part: bool(part[0].is_negative))
    sign = -1 if parts[0][0].is_negative else 1
    whole = sp.Add(*(sign * n * q * s for n, s in parts))
    at = next(k for k, number in enumerate(numbers) if number in parts)
    rest = [t for t, number in zip(terms, numbers, strict=True) if number not in parts]
    return [*rest[:at], sp.Mul(sp.Rational(sign, q), whole, evaluate=False), *rest[at:]]


def _sides(
    number: sp.Rational, factors: Sequence[sp.Expr]
) -> tuple[sp.Rational, list[sp.Expr], list[sp.Expr], tuple[list[sp.Expr], list[sp.Expr]]]:
    """The factors above and below the line of a fraction, and what is under a root there.

    The number changes its sign with each sum that has minus signs alone.
    """
    over, under = list[sp.Expr](), list[sp.Expr]()
    radicands = list[sp.Expr](), list[sp.Expr]()
    for repeated, times in Counter(factors).items():
        factor = repeated**times
        base, power = factor.as_base_exp()
        if factor.is_Add and all(map(_negative, factor.args)):
            number, factor, base = -number, -factor, -factor
        if factor.is_number and power == sp.S.Half:  # stands with the numbers
            over.append(factor)
        elif power.is_Rational and abs(power) == sp.S.Half:
            radicands[power.is_negative].append(base)
        elif power.is_Rational and power.is_negative:
            under.append(base ** (-power))
        else:
            over.append(factor)
    return number, over, under, radicands


def _number(expr: sp.Expr) -> tuple[sp.Rational, list[sp.Expr]]:
    """The rational factor of a product, and the others."""
    factors = list(chain.from_iterable(map(_factors, _factors(expr))))
    numbers = [f for f in factors if f.is_Rational]
    return sp.Mul(*numbers), [f for f in factors if not f.is_Rational]


def integer(n: int) -> str:
    """An integer; a large power of two or ten as a power."""
    for base, least in ((2, 12), (10, 4)):
        power, rest = 0, n
        while rest and rest % base == 0:
            rest, power = rest // base, power + 1
        if power >= least and rest < 100:
            return f"{base}^{{{power}}}" if rest == 1 else rf"{rest} \cdot {base}^{{{power}}}"
    return str(n)


def _small(p: int, q: int) -> str:
    """A small number as a negative power of two, or of ten with a digit before it."""
    if p == 1 and q >= 2**12 and q & (q - 1) == 0:
        return f"2^{{-{q.bit_length() - 1}}}"
    digits = len(str(q))
    if q >= 10**4 and 10**digits % q == 0 and (n := p * 10**digits // q) < 10:
        return rf"{n} \cdot 10^{{-{digits}}}" if n > 1 else f"10^{{-{digits}}}"
    if q >= 10**4 and 10 ** (digits - 1) == q and p < 10:
        return rf"{p} \cdot 10^{{-{digits - 1}}}" if p > 1 else f"10^{{-{digits - 1}}}"
    return ""


def natural(text: str) -> tuple[Any, ...]:
    """A key that puts a_2 before a_10."""
    return tuple((p.isdigit(), int(p) if p.isdigit() else 0, p) for p in re.split(r"(\d+)", text))


@lru_cache(maxsize=10_000)
def _as_text(expr: sp.Expr) -> tuple[Any, ...]:
    """The key of an expression by its text; the same factors are ordered again and again."""
    return natural(str(expr))


FLAT = re.compile(r"\\frac\{((?:[^{}+-]|\{[^{}+-]*\})*)\}\{(\d+)\}")
"""A fraction that can stand in a line."""
ANGLE = re.compile(r"(\\(?:sin|cos|tan)) \\frac\{((?:[^{}]|\{[^{}]*\})*)\}\{(\d+)\}")
"""The sine, the cosine or the tangent of a part of an angle."""


def stacked(rows: Sequence[str]) -> str:
    """Rows of a matrix or of cases; fractions need some space between them."""
    small = r"\frac" not in "".join(rows)
    return (r" \\ " if small else r" \\[9pt] ").join(rows)


INNERMOST = re.compile(r"\\begin\{(\w+)\}((?:(?!\\begin|\\end).)*)\\end\{\1\}", re.DOTALL)
SQUARED = re.compile(r"\\sqrt\{([A-Za-z](?:_\w)?)\^(?:2|\{2\})\}")
"""The root of a name that is written as a square, and whose root is not negative."""
FRACTION = re.compile(r"\\frac\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}\{((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*)\}")  # fmt: skip  # noqa: E501


def flat(text: str) -> str:
    """The same with fractions that stand in a line, where that can be."""
    return FLAT.sub(r"\1/\2", ANGLE.sub(_part_of_angle, text))


def _part_of_angle(found: re.Match[str]) -> str:
    """A function of a part of an angle, with brackets: sin a/2 would be read as (sin a)/2."""
    function, angle, parts = found.groups()
    return f"{function}({f'({angle})' if re.search('[+-]', angle) else angle}/{parts})"


def is_nested(text: str) -> bool:
    """Whether a fraction stands in a fraction, where it would be small."""
    depth, parts, starts = 0, 0, list[int]()
    for token in re.findall(r"\\frac|[{}]", text):
        if token == r"\frac" and starts:
            return True
        if token == r"\frac":
            parts = 2  # the groups that follow: above and below the line
        elif token == "{":
            if parts and not starts:
                starts.append(depth)
            depth += 1
        else:
            depth -= 1
            if starts == [depth]:
                starts.clear()
                parts -= 1
    return False


@lru_cache(maxsize=10_000)
def measure(text: str) -> float:
    """The width of a formula, in average letters; a fraction counts as the wider of its parts."""
    if stack := INNERMOST.search(text):
        widest = max(map(measure, re.split(r" \\\\(?:\[9pt\])? ", stack[2])))
        return measure(text[: stack.start()] + text[stack.end() :]) + 3 + widest
    if fraction := FRACTION.search(text):
        widest = 0.8 + max(map(measure, fraction.groups()))
        return measure(text[: fraction.start()] + text[fraction.end() :]) + widest
    text = re.sub(r"\\(?:mathrm|mathit|operatorname|text|left|right|[bB]ig[lr])\b", "", text)
    small = sum(
        len(re.findall(r"\\[A-Za-z]+|[^\s{}\\]", index))
        for index in re.findall(r"[_^](?:\{((?:[^{}]|\{[^{}]*\})*)\}|\w)", text)
    )
    return (
        len(re.findall(r"\\[a-zA-Z]+|[^\s{}^_]", text))
        - 0.3 * small
        + 1.2 * len(re.findall(r"[-+=&]|\\(?:le|ge|sin|cos|max|min)\b", text))
    )
