"""The names, sentences and displays of a mechanism, for all that is printed of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.called import called
from closedform.emit.backends.latex.equations import Numbered, Numbers
from closedform.emit.backends.latex.formulas import FITS, Printer, measure
from closedform.emit.backends.latex.names import (
    Quantities,
    conventional_names,
    coordinate_name,
    element,
    is_word,
)
from closedform.emit.backends.latex.prose import Prose, upright, written_name
from closedform.emit.backends.latex.wide import Equation, Lines
from closedform.model.alike import INDEX
from closedform.model.derivation import Derivation
from closedform.model.functions import Array, Function

ANGLES = ("alpha", "gamma", "delta", "eta", "zeta", "mu", "nu", "xi", "chi", "omega")
"""Letters for angles that only an algorithm has."""
UNPRINTED = "skeleton"
"""Its points are too many to print; a step says what is proved of them."""


class Sheet:
    """Prints symbols, expressions, sentences and equations of a mechanism."""

    def __init__(self, derivation: Derivation):
        self.derivation = derivation
        self.numbers = Numbers(derivation.name)
        self.printer = Printer({j.symbol for j in derivation.joints})
        self.printer.written |= {n: w.latex for n, w in derivation.written.items() if w.latex}
        self.printer.called = called(derivation)
        self.printer.parameters = frozenset(p.name for p in derivation.parameters)
        self.math, self.prose = self.printer.math, Prose(derivation)
        self.lines = Lines(self.printer, self.prose.known)
        inputs = [self.written(n) for n in (*derivation.task, *(j.name for j in derivation.joints))]
        self.quantities = Quantities(self.printer, [upright(n) for n in inputs])
        self.parameters = {p.symbol for p in derivation.parameters}
        self.symbols = set(self.parameters)
        self.symbols |= {s for f in derivation.functions for s in f.symbols}
        self.printer.rename(conventional_names(derivation))
        defined = [a for i in derivation.inverses for a in i.rank.defined]
        self.prose.angles = {a.name: self.math(a) for a in defined if is_word(a.name)}

    def written(self, name: str) -> str:
        """The LaTeX of a symbol that is known by its name."""
        return written_name(self.derivation, name)

    def legend(self) -> list[tuple[str, str]]:
        """The abbreviated sines and cosines that have been printed so far."""
        return sorted(self.printer.legend.items(), key=lambda e: (len(e[1]), e[0][9:], e[0]))

    @property
    def free_angles(self) -> list[str]:
        """The letters for angles that mean nothing else."""
        used = {*self.prose.names}
        written = self.derivation.written
        letters = (w.latex.removeprefix("\\").partition("_")[0] for w in written.values())
        used |= {*written, *letters}
        return [g for g in ANGLES if g not in used]

    def model(self, function: Function) -> Function | None:
        """The earlier printed function whose statements this one starts with, if there is one."""
        return self.earlier(function, self.derivation.functions)

    def earlier(self, function: Function, functions: Sequence[Function]) -> Function | None:
        """The last of some functions whose statements this one starts with."""
        earlier = [f for f in functions[: functions.index(function)] if f.name != UNPRINTED]
        shared = [f for f in earlier if f.body and function.body[: len(f.body)] == f.body]
        return max(shared, key=lambda f: len(f.body), default=None)

    def assigned(self, array: Array, locus: Mapping[sp.Symbol, sp.Expr]) -> list[Equation]:
        """An argument and its entries, or the values of the entries on ``locus``."""
        if not locus or all(e in locus for e in array.entries):
            entries = [locus.get(e, e) for e in array.entries]
            matrix = len(array.shape) == 2
            value = sp.Matrix(*array.shape, entries) if matrix else entries
            return self.equations(self.written(array.name), value)
        return [x for e in array.entries if e in locus for x in self.equations(e, locus[e])]

    def array(
        self,
        array: Array,
        entries: Sequence[sp.Expr] | None = None,
        names: Sequence[sp.Symbol] = (),
    ) -> list[Equation]:
        """The equations of a result: a matrix, or a row for each coordinate under its name."""
        entries = array.entries if entries is None else entries
        name = self.written(array.name)
        if len(array.shape) > 1:
            if array.name == "p":  # the place of the hand, which is its rotation
                arguments = (a for f in self.derivation.functions for a in f.inputs)
                rotation = next((a for a in arguments if a.shape == array.shape), array)
                name = self.written(rotation.name)
            shape = array.shape[-2:]
            if array.size == 1:  # a number needs no brackets
                return self.equations(name, entries[0]) if self.math(entries[0]) != name else []
            parts = sp.Matrix(array.size // sp.prod(shape), sp.prod(shape), entries)
            above = [f"^{{({k + 1})}}" if len(array.shape) > 2 else "" for k in range(parts.rows)]
            return [
                equation
                for k, mode in enumerate(above)
                for equation in self.equations(name + mode, parts.row(k).reshape(*shape))
            ]
        left = [self.math(n) for n in names] or self.coordinates(array, name)
        return [
            e
            for n, v in zip(left, entries, strict=True)
            if self.math(v) != n  # a name that is returned needs no line
            for e in self.equations(n, v)
        ]

    def named(self, array: Array) -> list[str]:
        """What stands on the left of the equations of a vector."""
        return self.coordinates(array, self.written(array.name)) if len(array.shape) < 2 else []

    def coordinates(self, array: Array, name: str) -> list[str]:
        """What the entries of a vector are called: joints, coordinates, entries of a matrix."""
        task = [coordinate_name(self.derivation, t) for t in self.derivation.task]
        joints = [self.written(str(j)) for j in self.derivation.actuated]
        for known, names in (("q", joints), ("x", task), ("p", task)):
            if array.name == known and len(names) == array.size:
                return names
        arguments = (a for f in self.derivation.functions for a in f.inputs)
        alike = (a for a in arguments if (a.name, a.shape) == (array.name, array.shape))
        if same := next(alike, None):
            return [self.math(e) for e in same.entries]
        if array.name == "det":
            return [r"\det J"]
        whole = {left: value for step in self.derivation.steps for left, value in step.shown}
        if not array.shape or (array.size == 1 and name in whole):
            return [name]
        value = whole.get(name)
        square = isinstance(value, sp.MatrixBase) and value.rows == value.cols
        diagonal = square or any(f"{name}_{{{k}{k}}}" in whole for k in ("1", INDEX))
        indices = [f"{k}{k}" if diagonal else str(k) for k in range(1, array.size + 1)]
        return [element(name, k) for k in indices]

    def equations(self, lhs: Any, value: Any) -> list[Equation]:
        """A value as one equation or, if it is too wide, as several."""
        return self.lines.equations(lhs if isinstance(lhs, str) else self.math(lhs), value)


@dataclass(frozen=True)
class Block:
    """A display: equations below each other, or one that is too wide and is a paragraph."""

    rows: tuple[Numbered, ...]
    wide: bool = False

    def __str__(self) -> str:
        """The block as LaTeX."""
        if self.wide:
            [row] = self.rows
            kind = r"\matrixequation" if r"\begin" in row.text else r"\longequation"
            command = rf"{kind}{{{row.label}}}" if row.label else r"\longformula"
            return rf"{command}{{{row.text}}}"
        return f"\\display\n{self.aligned(labelled)}"

    def aligned(self, label: Callable[[str], str]) -> str:
        """The rows as an environment of LaTeX; ``label`` writes their labels."""
        rows = "".join(
            aligned(row, label) + (f" {gap(row, after)}\n" if after else "")
            for row, after in zip(self.rows, (*self.rows[1:], None), strict=True)
        )
        kind = "align" if self.rows[0].numbered else "align*"
        return f"\\begin{{{kind}}}\n{rows}\n\\end{{{kind}}}"


def block(array: Array) -> list[sp.Expr]:
    """The entries of the rotation in a matrix or a pose."""
    columns = array.shape[1]
    return [array.entries[columns * i + j] for i in range(3) for j in range(3)]


def blocks(equations: Sequence[Numbered | Equation]) -> list[Block]:
    """Neighbours that fit beside each other as one aligned block, longer ones as paragraphs."""
    done: list[Block] = []
    group: list[Numbered] = []

    def flush() -> None:
        if group:
            done.append(Block(tuple(group)))
        group.clear()

    for e in (e if isinstance(e, Numbered) else Numbered(*e) for e in equations):
        if not fitting(e):
            flush()
            done.append(Block((e,), wide=True))
            continue
        if group and (e.numbered != group[0].numbered or (e.left and not beside([*group, e]))):
            flush()
        group.append(e)
    flush()
    return done


def beside(group: Sequence[Numbered]) -> bool:
    """Whether the columns of an aligned block fit beside each other, with the numbers."""
    width = max(measure(e.left) for e in group) + max(measure(e.right) for e in group)
    return width <= FITS - 6 * any(e.label for e in group)


def labelled(label: str) -> str:
    return rf"\label{{{label}}}"


def gap(above: Numbered, below: Numbered) -> str:
    """The end of a line: tall neighbours need more space between them."""
    both = above.right + below.right
    if r"\\" in both:  # rows of a matrix or cases
        return r"\\[4pt]"
    return r"\\[2pt]" if r"\frac" in both else r"\\"


def aligned(equation: Numbered, label: Callable[[str], str]) -> str:
    """A line of an aligned block; what goes on from the line before has nothing on the left."""
    left, right = equation.left, equation.right
    text = f"{left} &= {right}" if left else rf"&\quad {right}"
    if equation.called:
        text = rf"{left} \quad &\ {right}"
    if equation.label:
        return f"{text} {label(equation.label)}"
    return rf"{text} \notag" if equation.numbered else text


def fitting(equation: Numbered) -> bool:
    """Whether an equation fits on a line, with its number."""
    return measure(equation.left + equation.right) <= FITS - 6 * bool(equation.label)
