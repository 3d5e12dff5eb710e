"""Names in formulas: entries of matrices, quantities with a name, and names of a program."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import sympy as sp

from closedform.algebra.operations import operations
from closedform.emit.backends.latex.called import GREEK
from closedform.emit.backends.latex.formulas import Printer, measure
from closedform.emit.backends.latex.grouping import joint_by_joint
from closedform.emit.backends.latex.prose import symbol_name, written_name
from closedform.model.derivation import Derivation
from closedform.model.functions import real

NAME = re.compile(r"\\?[A-Za-z]+(?:_(?:\w|\\[A-Za-z]+|\{(?:[^{}]|\{[^{}]*\})+\}))?")
"""The left side of an equation that defines a quantity."""
LARGEST = 400
"""The largest number of operations of an expression in which quantities are looked for."""
NARROWEST = 9.0
"""The narrowest expression for which its name is printed instead."""
MATRIX_ENTRY = re.compile(r"([A-Z])(\d)_(\d)(\d)")


TUPLE = re.compile(r"\(([^()]+)\)_\{?([^{}]+)\}?")
"""A vector that is called by its coordinates: ``(x, y, z)_T``."""


def element(base: str, index: str) -> str:
    """The name of an entry of a matrix or a vector: ``x_{T}`` of ``(x, y, z)_T``."""
    if called := TUPLE.fullmatch(base):
        return f"{called[1].split(',')[int(index) - 1].strip()}_{{{called[2]}}}"
    if subscript := re.fullmatch(r"(.+?)_\{?([^{}]+)\}?", base):
        return f"{subscript[1]}_{{{subscript[2]},{index}}}"
    return f"{base}_{{{index}}}" if " " not in base else f"({base})_{{{index}}}"


class Quantities:
    """Quantities that an equation has defined: later formulas contain their names.

    A name that is defined again, as the same quantity of the target, has its new meaning from there
    on; the functions that follow the steps are of the joints, and ``former`` meanings serve there.
    ``inputs`` are the left sides that define nothing: joints, and what the mechanism is to reach.
    """

    def __init__(self, printer: Printer, inputs: Iterable[str]):
        self.printer, self.inputs = printer, frozenset(map(_without_braces, inputs))
        self.known: dict[str, tuple[sp.Expr, sp.Symbol]] = {}
        self.former: dict[str, tuple[sp.Expr, sp.Symbol]] = {}
        self.narrow: dict[str, tuple[sp.Expr, sp.Symbol]] = {}
        """Short sums, which serve in algorithms alone."""
        self.entries: dict[str, tuple[sp.Expr, sp.Symbol]] = {}
        """Coordinates of a vector that is called by them, which a function gives as they are."""

    def define(self, left: str, value: Any) -> None:
        """What a step shows; a vector that is called by its coordinates defines each of them."""
        called = TUPLE.fullmatch(left)
        if isinstance(value, sp.MatrixBase) and called and called[1].count(",") + 1 == len(value):
            for k, entry in enumerate(value, 1):
                name = element(left, str(k))
                self.define(name, entry)
                self.narrow.pop(name, None)
                if name in self.known:
                    self.entries[name] = self.known.pop(name)
            return
        if not NAME.fullmatch(left) or _without_braces(left) in self.inputs:
            return
        if left in self.known:
            self.former[left] = self.known.pop(left)
        named = isinstance(value, sp.Add) or (isinstance(value, sp.Pow) and value.base.is_Add)
        self.narrow.pop(left, None)
        if named:
            symbol = real(f"{left} ")  # a space: it is nobody else's name
            self.printer.rename({symbol: left})
            wide = measure(self.printer.math(value)) >= NARROWEST
            (self.known if wide else self.narrow)[left] = value, symbol

    def of_a_function(
        self,
        value: sp.Expr,
        without: Iterable[str],
        names: Mapping[str, sp.Symbol] = MappingProxyType({}),
    ) -> Any:
        """A result in names that the steps have defined, ``without`` its own.

        ``names`` are the symbols of the function, of which more may be assumed.
        """
        # an algorithm computes the coordinates itself
        meanings = (self.former, *([self.narrow] if names else [self.entries]), self.known)
        every = {left: k for meaning in meanings for left, k in meaning.items()}
        found = {left: k for left, k in every.items() if left not in without}
        pairs = [k for m in meanings for left, k in m.items() if left not in without]
        if not names:
            return self._named(value, pairs, whole=False)
        symbols = {s for e, _ in pairs for s in e.free_symbols}
        own = {s: names[str(s)] for s in symbols if str(s) in names}
        written = {_without_braces(left): symbol for left, (_, symbol) in found.items()}
        for s in symbols - own.keys():  # a quantity in the definition of another one
            if quantity := written.get(_without_braces(self.printer.math(s))):
                own[s] = quantity
        known = [(e.xreplace(own), s) for e, s in pairs]
        while (named := self._named(value, known, whole=False)) != value:
            value = named
        return value

    @property
    def values(self) -> set[sp.Expr]:
        """The values of the quantities."""
        return {e for e, _ in {**self.former, **self.narrow, **self.known}.values()}

    def in_value(self, value: sp.Expr) -> set[str]:
        """The names of quantities of steps in a value."""
        meanings = (self.former, self.narrow, self.known, self.entries)
        return {n for m in meanings for n, (_, s) in m.items() if s in value.free_symbols}

    def __call__(self, value: Any) -> Any:
        """A value with the names of the quantities that occur in it."""
        if isinstance(value, sp.MatrixBase):
            return value.applyfunc(self)
        known = [*self.known.values(), *self.entries.values()]
        named = self._named(value, known)
        summed = isinstance(value, sp.Add) and operations(value) <= LARGEST
        if named == value and summed:  # a quantity times the cosine of a joint
            grouped = joint_by_joint(value)
            whole = self._named(grouped, known)
            return whole if whole != grouped else value
        return named

    def _named(
        self, value: Any, known: Iterable[tuple[sp.Expr, sp.Symbol]], *, whole: bool = True
    ) -> Any:
        """A value with names of quantities; a coordinate is one of its parts, or ``whole``."""
        if not isinstance(value, sp.Expr) or value.is_Atom or operations(value) > LARGEST:
            return value
        known = sorted(known, key=lambda k: (-operations(k[0]), str(k[1])))
        coordinates = set[sp.Symbol]() if whole else {s for _, s in self.entries.values()}
        for expr, symbol in known:
            if expr.free_symbols <= value.free_symbols:
                named = value.xreplace({expr: symbol, -expr: -symbol})
                named = named if expr.is_Pow else self._in_sums(named, expr, symbol)
                value = value if named in coordinates else named
        return value

    def _in_sums(self, value: sp.Expr, expr: sp.Expr, symbol: sp.Symbol) -> sp.Expr:
        """The sum where it is a part of a larger one."""
        terms = set(expr.args)
        opposite = {-t for t in terms}
        changed = {}
        for total in value.atoms(sp.Add):
            held = set(total.args)
            if terms < held:
                changed[total] = sp.Add(*(held - terms), symbol)
            elif opposite < held:
                changed[total] = sp.Add(*(held - opposite), -symbol)
        return value.xreplace(changed) if changed else value


def _without_braces(name: str) -> str:
    """The LaTeX of a name as another one may spell it: ``\\theta_4`` for ``\\theta_{4}``."""
    return re.sub("[{}]", "", name)


def is_word(name: str) -> bool:
    """Whether a name of a program is a word of English, and not a letter with an index."""
    letters = re.match(r"[A-Za-z]*", name)
    assert letters
    base = letters[0]
    if base in GREEK or len(base) < 2 or MATRIX_ENTRY.fullmatch(name):
        return False
    if len(base) == 2 and "_" not in name:
        return base.islower() and base[1] not in "xyz"
    return True


def program_name(symbol: sp.Symbol, value: sp.Expr) -> str | None:
    """The LaTeX of an entry of a matrix, as in ``R1_23``, or of a square, as in ``r2``."""
    name = str(symbol.name)
    if entry := MATRIX_ENTRY.fullmatch(name):
        return rf"{entry[1]}^{{({entry[2]})}}_{{{entry[3]}{entry[4]}}}"
    squares = value.is_Add and all(t.is_Pow and t.exp == 2 for t in value.args)
    if squares and re.fullmatch("[a-z]2", name):
        return f"{name[0]}^{{2}}"
    return None


def conventional_names(derivation: Derivation) -> dict[sp.Symbol, str]:
    """Names that do not follow from those of symbols.

    The entries of a pose are those of its rotation and its position, and the targets of a chain
    those of the task; an angle that is called by a word is psi.  An auxiliary angle of that kind is
    phi, with the number of its place if there are several.
    """
    names: dict[sp.Symbol, str] = {}
    for array in (a for f in derivation.functions for a in f.inputs if a.shape == (4, 4)):
        for i in range(3):
            for j in range(3):
                names[array.entries[4 * i + j]] = f"R_{{{i + 1}{j + 1}}}"
            names[array.entries[4 * i + 3]] = f"p_{{{'xyz'[i]}}}"
    used = {s.name for f in derivation.functions for s in f.symbols}
    used |= {p.name for p in derivation.parameters} | {j.name for j in derivation.joints}
    for target in (s for f in derivation.functions if f.has_status for s in f.symbols):
        coordinate = str(target.name).removeprefix("x_")
        if coordinate != target.name and coordinate in derivation.task and coordinate not in used:
            free = is_word(coordinate) and not {"psi", "yaw"} & used
            names[target] = r"\psi" if free else symbol_name(coordinate)
    angles = [a for i in derivation.inverses for a in i.rank.defined if is_word(str(a.name))]
    angles = [a for a in angles if a.name not in derivation.written]
    for k, angle in enumerate(dict.fromkeys(angles), 1):
        names[angle] = r"\varphi" if len(angles) == 1 else rf"\varphi_{{{k}}}"
    return names


def coordinate_name(derivation: Derivation, coordinate: str) -> str:
    """The LaTeX of a coordinate of the task, which is also that of the target for it."""
    targets = conventional_names(derivation)
    found = (n for s, n in targets.items() if s.name == f"x_{coordinate}")
    return next(found, written_name(derivation, coordinate))
