"""Long expressions, taken apart until every line fits.

An equation that is too wide for a line is set with names for its parts, and an article sets them
first: the coefficients of a polynomial, a sum that stands in a product, what stands under a root,
in a fraction or beside cases.  What is left, a long sum, is broken before its terms.  All choices
depend on the widths of :func:`~closedform.emit.backends.latex.formulas.measure` alone, so that they
are the same on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, count, groupby, permutations
from typing import Any

import sympy as sp

from closedform.algebra.factoring import factored
from closedform.algebra.operations import operations
from closedform.emit.backends.latex.equations import runs
from closedform.emit.backends.latex.formulas import FITS, Printer, measure, stacked
from closedform.emit.backends.latex.grouping import joint_by_joint, without_minus
from closedform.emit.backends.latex.names import TUPLE, element
from closedform.model.functions import real

Equation = tuple[str, str]
"""Both sides; a line that continues the one before has no left side."""

GAIN = 1.5
"""By how much another form of an expression has to be narrower."""
PRODUCT = 3.0
"""How much wider than a sum a product may be."""
SIMPLIFIED = 80
"""The largest number of operations of an expression that is tried in other forms."""
FACTORED, FACTORED_SYMBOLS = 30, 7
"""The largest numbers of operations and of symbols of a sum that is factored."""
NESTED = 1.0
"""The same of a sum whose terms are collected joint by joint."""
TERMS = 8
"""A polynomial with fewer terms is printed as it is."""
SHORT = 16.0
"""The widest coefficient of a polynomial that stands in it."""
NUMBER = 3.0
"""The room that is kept beside a matrix for the number of its equation."""
NAMED = 13.0
"""The narrowest sum that is worth a name."""


class Lines:
    """Prints equations in lines that fit; names of parts are kept until :meth:`clear`."""

    def __init__(self, printer: Printer, taken: Iterable[str]):
        self.printer, self.taken = printer, frozenset(taken)
        self.line_width = FITS
        self.parts: dict[sp.Basic, sp.Symbol] = {}
        self.spent = set[str]()
        """Names of parts that have been printed and may not get another meaning."""
        self._widths: dict[Any, float] = {}
        self._tidied: dict[sp.Basic, sp.Basic] = {}

    def clear(self, *, spend: bool = False) -> None:
        """Forget the parts; their names are not given again if they are spent."""
        if spend:
            self.spent |= {s.name for s in self.parts.values()}
        self.parts.clear()
        self._widths.clear()

    def width(self, value: Any) -> float:
        if value not in self._widths:
            self._widths[value] = measure(self.printer.math(value))
        return self._widths[value]

    def equations(self, left: str, value: Any) -> list[Equation]:
        """A value as one equation or, if it is too wide, as several: the parts by their numbers."""
        return self._in_order(self._equations(left, value))

    def _in_order(self, rows: Sequence[Equation]) -> list[Equation]:
        names = {self.printer.math(s): k for k, s in enumerate(self.parts.values())}
        done: list[Equation] = []
        for are_parts, group in groupby(runs(rows), lambda run: run[0][0] in names):
            found = list(group)
            if are_parts:
                found.sort(key=lambda run: names[run[0][0]])
            done += [row for run in found for row in run]
        return done

    def _equations(self, left: str, value: Any) -> list[Equation]:
        if isinstance(value, str):
            return [(left, value)]
        if isinstance(value, list | tuple):
            return [(left, "(" + r",\ ".join(map(self.printer.math, value)) + ")")]
        if isinstance(value, sp.MatrixBase):
            return self._matrix(left, value)
        if isinstance(value, sp.Eq) and isinstance(value.lhs, sp.Expr):
            return self._equation(left, value)
        if not isinstance(value, sp.Expr):
            return [(left, self.printer.math(value))]
        return self._expression(left, self.tidy(value))

    def _expression(self, left: str, value: sp.Expr) -> list[Equation]:
        """An expression on one line if it fits, or else with names for its parts, or broken."""
        if inner := self._unbreakable(value):
            return self._with_part(left, value, inner)
        text = self.printer.math(value)
        available = self.line_width - measure(left) - 4
        if measure(text) <= available:
            return [(left, text)]
        if isinstance(value, sp.Piecewise):
            inner = self._widest_case(value)
            return self._with_part(left, value, inner) if inner else [(left, text)]
        if _of_squares(value):  # says more than its powers of one symbol
            return self._broken(left, value, available)
        if (parts := self._polynomial(value)) is not None:
            return self._with_coefficients(left, *parts)
        if inner := self._nested(value) or self._widest_argument(value):
            return self._with_part(left, value, inner)
        return self._broken(left, value, available)

    def _equation(self, left: str, value: sp.Eq) -> list[Equation]:
        """A value that is an equation itself: its right side stands behind its left."""
        rows = self.equations(left, value.lhs)
        last = next((k for k, (side, _) in enumerate(rows[1:]) if side), len(rows) - 1)
        rows[last] = rows[last][0], f"{rows[last][1]} = {self.printer.math(value.rhs)}"
        return rows

    def tidy(self, value: sp.Expr) -> sp.Expr:
        """The narrowest of some equal forms: common factors in front, one fraction, factored."""
        if value not in self._tidied:
            terms, size = len(sp.Add.make_args(value)), operations(value)
            nested = joint_by_joint(value) if size <= SIMPLIFIED else value

            def cost(form: sp.Expr) -> float:
                grouped = form.is_Add and len(form.args) == 2 < len(value.args) == 4
                collected = form == nested != value
                bonus = PRODUCT if form.is_Mul or grouped else NESTED if collected else 0
                return self.width(form) - bonus

            # no product of sums is multiplied out unless terms cancel
            forms = (
                f
                for f in self._forms(value)
                if len(sp.Add.make_args(f)) <= terms or operations(f) < size
            )
            best = min(forms, key=cost)
            narrower = cost(best) < cost(value) - GAIN
            self._tidied[value] = without_minus(best if narrower else value)
        return self._tidied[value]

    def _forms(self, value: sp.Expr) -> Iterator[sp.Expr]:
        yield value
        size = operations(value)
        if value.is_Add and sp.pi in (t.as_coeff_Mul()[1] for t in value.args):
            return  # an angle and a part of a turn
        if value.is_Atom or size > SIMPLIFIED or value.has(sp.Piecewise, sp.Max, sp.Min):
            return
        yield sp.factor_terms(value)
        if (grouped := joint_by_joint(value)) != value:
            yield grouped
        yield from unit_circles(value)
        if (together := with_sums_of_angles(value)) != value:
            yield together
            yield sp.factor_terms(together)
        if value.is_Add and len(value.args) == 4 and all(map(_is_product, value.args)):
            names = sorted(value.free_symbols, key=str)
            yield sp.collect(value, names)
            yield sp.collect(value, names[::-1])
        powers = value.atoms(sp.Pow)
        if any(p.exp.is_negative for p in powers):
            yield sp.together(value)
        if (
            value.is_Add
            and size <= FACTORED
            and len(value.free_symbols) <= FACTORED_SYMBOLS
            and all(p.exp.is_Integer for p in powers)
        ):
            yield factored(value)

    # Parts with names

    def _with_part(self, left: str, value: sp.Basic, inner: sp.Basic) -> list[Equation]:
        known = inner in self.parts
        name = self.parts.setdefault(inner, self._new_name())
        whole = value.xreplace({inner: name})
        if whole.is_Mul:
            whole = sp.Mul(*(self.tidy(f) if f.is_Add else f for f in whole.args))
        rest = self.equations(left, whole)
        return rest if known else rest + self.equations(self.printer.math(name), inner)

    def _new_name(self) -> sp.Symbol:
        taken = self.taken | self.spent | {s.name for s in self.parts.values()}
        return real(next(n for n in map("u{}".format, count(1)) if n not in taken))

    def _unbreakable(self, value: sp.Basic) -> sp.Basic | None:
        """The smallest part of a formula that is too wide and inside which TeX cannot break.

        This is a radicand, a denominator, a sum in a numerator, or cases next to other terms.
        """
        powers = (p for p in value.atoms(sp.Pow) if not p.exp.is_Integer or p.exp.is_negative)
        wide = [p.base for p in powers if self.width(p.base) > FITS - 12]
        for fraction in value.atoms(sp.Mul):
            over, under = sp.fraction(fraction)
            sums = [a for a in fraction.args if isinstance(a, sp.Add)]
            if not under.is_Integer and sums and self.width(over) > FITS - 12:
                wide.append(max(sums, key=lambda e: (self.width(e), str(e))))
        if isinstance(value, sp.Expr) and not isinstance(value, sp.Piecewise):
            wide += sorted(value.atoms(sp.Piecewise), key=str)
        elif isinstance(value, sp.Piecewise):
            wide += sorted({p for e, _ in value.args for p in e.atoms(sp.Piecewise)}, key=str)
        return min(wide, key=lambda e: (operations(e), str(e)), default=None)

    def _widest_case(self, value: sp.Piecewise) -> sp.Basic | None:
        """The widest value or side of a condition of cases that has more than a name."""
        sides = [e for e, _ in value.args]
        sides += [a for _, c in value.args for r in c.atoms(sp.core.relational.Rel) for a in r.args]
        wide = [e for e in sides if self.width(e) > NAMED and not e.is_Atom]
        return max(wide, key=lambda e: (self.width(e), str(e)), default=None)

    def _widest_argument(self, value: sp.Expr) -> sp.Basic | None:
        """The widest of those of which the largest or the smallest is taken."""
        inner = {a for e in value.atoms(sp.Max, sp.Min) for a in e.args if not a.is_Atom}
        return max(inner, key=lambda e: (self.width(e), str(e)), default=None)

    def _nested(self, value: sp.Expr) -> sp.Basic | None:
        """The sum inside products whose name saves most."""
        found: dict[sp.Basic, int] = {}

        def visit(e: sp.Basic, *, whole: bool) -> None:
            if isinstance(e, sp.Add) and not whole:
                found[e] = found.get(e, 0) + 1
            if not isinstance(e, sp.sin | sp.cos):
                for a in e.args:
                    visit(a, whole=False)

        visit(value, whole=True)
        saved = {e: n * (self.width(e) - 2) for e, n in found.items() if self.width(e) > NAMED}
        for factor in value.args if value.is_Mul and len(saved) > 1 else ():
            saved.pop(factor, None)  # a part of it says more than the whole product
        return max(saved, key=lambda e: (saved[e], str(e)), default=None)

    # Polynomials

    def _polynomial(self, value: sp.Expr) -> tuple[sp.Symbol, list[tuple[int, sp.Expr]]] | None:
        """The symbol by whose powers a long polynomial is collected, and the coefficients."""
        if not value.is_Add or len(value.args) < TERMS:
            return None
        found = []
        turning = {s for f in value.atoms(sp.sin, sp.cos) for s in f.free_symbols}
        degrees = _degrees(value)
        for symbol in sorted(value.free_symbols - turning, key=str):
            if degrees[symbol] < 2:
                continue  # to find that in the polynomial takes SymPy long
            poly = value.as_poly(symbol)
            if poly is None or not 2 <= poly.degree() <= TERMS:
                continue
            terms = [(k, factored(c)) for (k,), c in poly.terms()]
            if 1 < len(terms) < len(value.args):
                found.append((sum(self.width(c) for _, c in terms), str(symbol), symbol, terms))
        return min(found, key=lambda f: f[:2])[2:] if found else None

    def _with_coefficients(
        self, left: str, symbol: sp.Symbol, terms: list[tuple[int, sp.Expr]]
    ) -> list[Equation]:
        named, total = [], []
        for power, coefficient in terms:
            if self.width(coefficient) > SHORT and coefficient not in self.parts:
                self.parts[coefficient] = self._new_name()
                named.append(coefficient)
            shown = self.parts.get(coefficient, coefficient)
            total.append(self.printer.math(sp.Mul(shown, symbol**power, evaluate=False)))
        text = total[0] + "".join(t if t.startswith("-") else f" + {t}" for t in total[1:])
        rows = [(left, text)]
        for coefficient in named:
            rows += self.equations(self.printer.math(self.parts[coefficient]), coefficient)
        return rows

    # Lines

    def _broken(self, left: str, value: sp.Expr, available: float) -> list[Equation]:
        """A sum in several lines, each of which starts with the sign of a term."""
        terms = self.printer._as_ordered_terms(value) if value.is_Add else [value]
        lines, line = list[str](), ""
        for term in terms:
            text = self.printer.math(term)
            text = text if (not line and not lines) or text.startswith("-") else f"+ {text}"
            if line and measure(f"{line} {text}") > available - 3 * bool(lines):
                lines.append(line)
                line = text
            else:
                line = f"{line} {text}".strip()
        lines.append(line)
        return [(left, lines[0]), *(("", line) for line in lines[1:])]

    # Matrices

    def _matrix(self, left: str, matrix: sp.MatrixBase) -> list[Equation]:
        """The equations of a matrix that fit on a line.

        What divides all entries of a matrix that is too wide stands before it, if it fits then.
        Otherwise the widest entries get names.
        """
        matrix = matrix.applyfunc(lambda e: self.tidy(e) if isinstance(e, sp.Expr) else e)
        cells = self._cells(matrix)
        available = self.line_width - measure(left) - (NUMBER if matrix.rows > 1 else 0)
        if _width(cells) > available and (factor := _common(matrix)) != 1:
            before = self.printer.math(factor)
            inner = self._cells(matrix.applyfunc(lambda e: e / factor))
            if _width(inner) + measure(before) <= available:
                return [(left, f"{before} {_bracketed(inner)}")]
        base, named = left.partition("=")[0].strip(), []
        while _width(cells) > available:
            widest, i, j = max(
                (measure(c), -i, -j) for i, row in enumerate(cells) for j, c in enumerate(row)
            )
            column = len(cells[0]) == 1
            name = element(base, f"{1 - i}" if column else f"{1 - i}{1 - j}")
            if widest <= measure(name):
                break
            named.append((-i, -j, name))
            cells[-i][-j] = name
        entries = (self.equations(name, matrix[i, j]) for i, j, name in sorted(named))
        rows = [row for entry in entries for row in entry]
        listed = len(named) == matrix.rows and TUPLE.fullmatch(left)
        return rows if listed else [(left, _bracketed(cells)), *rows]

    def _cells(self, matrix: sp.MatrixBase) -> list[list[str]]:
        return [[self.printer.math(e) for e in matrix.row(i)] for i in range(matrix.rows)]


def _width(cells: Sequence[Sequence[str]]) -> float:
    return sum(max(map(measure, column)) + 2 for column in zip(*cells, strict=True))


def _bracketed(cells: Sequence[Sequence[str]]) -> str:
    rows = stacked([" & ".join(row) for row in cells])
    return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"


def _common(matrix: sp.MatrixBase) -> sp.Expr:
    """The factors of all entries that are not zero, if one of them divides."""
    entries = [{*sp.Mul.make_args(e)} for e in matrix if e != 0]
    shared = set.intersection(*entries) if len(entries) > 1 else set()
    if not any(f.is_Pow and f.exp.is_negative for f in shared):
        return sp.S.One
    return sp.Mul(*sorted(shared, key=str))


def with_sums_of_angles(value: sp.Expr) -> sp.Expr:
    """A sum with the sines and cosines of sums of angles where two terms are one of them."""
    if not value.is_Add:
        return value.func(*map(with_sums_of_angles, value.args)) if value.is_Mul else value
    terms = list(value.args)
    for first, second in combinations(terms, 2):
        for angle, other in permutations(_angles_in(first), 2):
            for f, g, u, v in ((sp.sin, sp.cos, sp.cos, sp.sin), (sp.cos, sp.cos, sp.sin, sp.sin)):
                part = f(angle) * g(other)
                rest = first / part
                if rest.has(angle, other) or abs(second / (rest * u(angle) * v(other))) != 1:
                    continue
                same = second == rest * u(angle) * v(other)
                total = angle + (1 if same == (f == sp.sin) else -1) * other
                left = [t for t in terms if t not in (first, second)]
                return with_sums_of_angles(sp.Add(*left, rest * f(total)))
    return value


def _angles_in(term: sp.Expr) -> list[sp.Symbol]:
    factors = [f for f in sp.Mul.make_args(term) if isinstance(f, sp.sin | sp.cos)]
    return sorted({f.args[0] for f in factors if f.args[0].is_Symbol}, key=str)


def moduli_cancelled(value: Any) -> Any:
    """An expression or a matrix, multiplied out where it divides by a modulus that cancels then."""
    if isinstance(value, sp.MatrixBase):
        return value.applyfunc(moduli_cancelled)
    divides = any(p.exp.is_negative and p.base.has(sp.Abs) for p in value.atoms(sp.Pow))
    whole = sp.expand(value) if divides else value
    return whole if len(whole.atoms(sp.Abs)) < len(value.atoms(sp.Abs)) else value


def unit_circles(value: sp.Expr) -> Iterator[sp.Expr]:
    """A sum where the squares of the sine and the cosine of an angle add to 1, if they do."""
    angles = sorted(
        {f.args[0] for f in value.atoms(sp.sin) if value.has(sp.cos(f.args[0]))}, key=str
    )
    if not value.is_Add or not angles:
        return
    whole = sp.expand(value)
    for angle in angles:
        powers = {p for p in whole.atoms(sp.Pow) if p.exp.is_Integer and p.exp > 1}
        squares = {
            p: (1 - sp.sin(angle) ** 2) ** (p.exp // 2) * p.base ** (p.exp % 2)
            for p in powers
            if p.base == sp.cos(angle)
        }
        if squares and any(p.base == sp.sin(angle) for p in powers):
            shorter = sp.expand(whole.xreplace(squares))
            if len(sp.Add.make_args(shorter)) < len(sp.Add.make_args(whole)):
                yield shorter
                yield from (sp.collect(shorter, s) for s in sorted(shorter.free_symbols, key=str))


__all__ = ["Equation", "Lines", "moduli_cancelled", "unit_circles", "with_sums_of_angles"]


def _degrees(value: sp.Expr) -> dict[sp.Symbol, float]:
    """Upper bounds for the degrees of a value in its symbols; infinite if it has other powers."""
    if value.is_Symbol:
        return {value: 1}
    found = dict[sp.Symbol, float]()
    if value.is_Add or value.is_Mul:
        for part in map(_degrees, value.args):
            for s, n in part.items():
                found[s] = max(found.get(s, 0), n) if value.is_Add else found.get(s, 0) + n
        return found
    if value.is_Pow and value.exp.is_Integer and value.exp.is_positive:
        return {s: n * int(value.exp) for s, n in _degrees(value.base).items()}
    return dict.fromkeys(value.free_symbols, math.inf)


def _of_squares(value: sp.Expr) -> bool:
    """Whether a value is a sum of squares of sums."""
    terms = sp.Add.make_args(value)
    return len(terms) > 1 and all(t.is_Pow and t.exp == 2 and t.base.is_Add for t in terms)


def _is_product(value: sp.Basic) -> bool:
    """Whether a term is a product of two symbols, up to its sign."""
    factor, rest = value.as_coeff_Mul()
    return abs(factor) == 1 and len(rest.args) == 2 and all(a.is_Symbol for a in rest.args)
