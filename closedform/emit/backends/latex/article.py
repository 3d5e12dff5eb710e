"""Prints a derivation as a LaTeX article.

Python prepares the formulas and the sentences; the templates lay them out.  Formulas that fit on
a line are aligned; what does not fit is taken apart in
:mod:`closedform.emit.backends.latex.wide`.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import starmap
from typing import Any

import sympy as sp
from sympy.logic.boolalg import Boolean

from closedform.emit.backends.latex import bibliography, lemmas, symbols
from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.angles import in_angles
from closedform.emit.backends.latex.cases import Cases
from closedform.emit.backends.latex.claims import Claims
from closedform.emit.backends.latex.equations import (
    by_equation,
    canonical,
    defined_in,
    names_in,
    parts_first,
    reference,
    runs,
)
from closedform.emit.backends.latex.formulas import FITS, flat, measure
from closedform.emit.backends.latex.inverse import Told
from closedform.emit.backends.latex.listing import Line, lines_kept
from closedform.emit.backends.latex.names import is_word
from closedform.emit.backends.latex.places import place
from closedform.emit.backends.latex.plain import angles_of_readers, plain
from closedform.emit.backends.latex.prose import (
    escape,
    mixed,
    symbols_declared,
    symbols_of,
    upright,
)
from closedform.emit.backends.latex.sheet import UNPRINTED, Sheet, blocks
from closedform.emit.backends.latex.subject import Subject
from closedform.emit.backends.latex.vectors import in_vectors
from closedform.emit.backends.latex.wide import Equation, moduli_cancelled, with_sums_of_angles
from closedform.emit.terminal import decimal as exact_decimal
from closedform.model.alike import INDEX
from closedform.model.derivation import Derivation, Joint
from closedform.model.functions import Function, real
from closedform.model.inverse import Combination, Inverse, Rank
from closedform.model.lemma import Lemma
from closedform.model.names import listed
from closedform.model.step import Step
from closedform.proof.prove import Proof

__all__ = ["Page", "document", "index_of", "indexed", "tied"]

MAPS = ("Forward", "Inverse")
"""What the title of a step calls a map in short."""
FEW = 3
"""Fewer results that are arguments are equations like all others."""
BARE: Mapping[str, Any] = {
    "same": "",
    "blocks": [],
    "lines": [],
    "lines_kept": 0,
    "borrowed": "",
    "cases": [],
    "roundings": [],
    "after": "",
}
"""A function without a listing."""
ROOM = 18
"""A table that needs no more lines than that is kept on one page; a longer one may be broken."""
LEFT = 9
"""The lines that a longer table has to find on a page, to begin there."""
HEADING = 5
"""The lines of a heading and a short reason, which stay with the table below them."""
SENTENCE = 60
"""The letters of a cell that is broken into lines."""
PROPER = re.compile(r"[A-Z]\b|Jacobian|Denavit|[A-Z]{2}")
"""What keeps its capital in the index: names, and letters of the figure."""
ARTICLE = re.compile(r"^(?:[Tt]he|[Aa]n) ")
"""What no entry of the index starts with."""
LENGTH = re.compile(r"[a-z]_\d")
"""A letter of a lemma for a length, such as ``l_1``."""
PARTS = 360
"""The smallest part of half a turn that a default is recognised as: half a degree."""


class Page(Sheet):
    """Collects the strings of one document."""

    def __init__(self, derivation: Derivation, proof: Proof):
        super().__init__(derivation)
        self.proof = proof
        self.labels: list[list[str]] = []
        """The labels of the equations of each step."""
        self.claims = Claims(derivation, proof, self.labels)
        self.algorithms: dict[str, Algorithm] = {}

    def algorithm(self, function: Function) -> Algorithm:
        """The algorithm of a function, which goes on where that of an earlier one ends."""
        if function.name not in self.algorithms:
            model, subject = self.model(function), Subject.of(self.derivation, function)
            means = dict(self.derivation.means)
            means |= {n: m for s in self.derivation.solved for n, m in s.lemma.means.items()}
            if inverse := subject.inverse:
                means |= inverse.rank.meaning
            lemmas = subject.lemmas
            means |= {n: m for lemma in lemmas for n, m in lemma.means.items()}
            letters = {s: letter for lemma in lemmas for s, letter in lemma.letters.items()}
            letters |= {
                s: f"{letter[0]}_{{{letter[2]}}}"
                for lemma in lemmas
                for letter, s in lemma.roles
                if isinstance(s, sp.Symbol) and LENGTH.fullmatch(letter) and is_word(str(s.name))
            }
            earlier = self.algorithm(model) if model else None
            results = inverse.unknowns if inverse else ()
            turned = None
            if inverse and (isinstance(inverse.glue, Rank) or finds_all(inverse, lemmas)):
                named = {n: w.same for n, w in self.derivation.written.items() if w.same}
                turned = in_angles(subject.function, lemmas, results, self.free_angles, named)
                turned = turned.multiplied(self.rotations() | matrices(inverse, lemmas))
                subject = replace(subject, function=turned.function)
                letters |= turned.letters
            returned = results or self.coordinates_of(subject.function)
            free = list(self.free_angles)
            letters |= {
                angle: self.written(free.pop(0))
                for lemma in lemmas
                for angle in angles_of_readers(lemma)
                if angle not in self.symbols
            }
            glue = inverse.glue if inverse else None
            joints = glue.joints if isinstance(glue, Combination) else {}
            known = set() if function.has_status else self.quantities.values
            read = plain(
                subject.function, lemmas, free, known=known, results=returned, joints=joints
            )
            written = {n: w for lemma in lemmas for n, w in lemma.written.items()}
            vectors = in_vectors(read.function, written) if written else None
            if vectors:
                read = replace(read, function=vectors.function)
            replaced = {**(turned.names if turned else {}), **read.names}
            subject = replace(subject, function=read.function)
            self.algorithms[function.name] = Algorithm(
                self,
                subject,
                means=means,
                model=earlier,
                letters=letters,
                replaced=replaced,
                chosen=turned.chosen if turned else {},
                product=turned.product if turned else "",
                vectors=vectors,
            )
        algorithm = self.algorithms[function.name]
        self.printer.rename(algorithm.names)
        return algorithm

    def model(self, function: Function) -> Function | None:
        """The same; where an equation tells what a function computes, it has no lines."""
        functions = self.derivation.functions
        printed = [f for f in functions if not self.numbers.of(f.equation) or f is function]
        return self.earlier(function, printed)

    def coordinates_of(self, function: Function) -> list[sp.Symbol]:
        """The coordinates of the task, if they are what a function returns."""
        task = [real(t) for t in self.derivation.task]
        alone = len(function.outputs) == 1 and function.outputs[0].shape == (len(task),)
        return task if alone and function.outputs[0].name == "x" else []

    def rotations(self) -> dict[str, sp.MatrixBase]:
        """The rotations that steps define, by their names."""
        shown = [pair for step in self.derivation.steps for pair in step.shown]
        return {n: v for n, v in shown if isinstance(v, sp.MatrixBase) and v.shape == (3, 3)}

    def joint(self, joint: Joint) -> tuple[str, str, str, str]:
        role = "passive: the others move it" if joint.passive else "actuated"
        if joint.coupling is not None:
            role = f"coupled: ${self.math(joint.symbol)} = {self.math(joint.coupling)}$"
        return self.math(joint.symbol), escape(joint.name), joint.kind, role

    def step(self, step: Step) -> dict[str, Any]:
        self.lines.clear(spend=True)
        shown: list[Equation] = []
        for lhs, value in step.shown:
            left = upright(lhs)
            if isinstance(value, Boolean) and not value.is_Symbol:
                left += ":"  # what the condition is called
            shown += self.equations(left, self.quantities(value))
            self.quantities.define(left, value)
        shown = parts_first(shown)
        fresh = [run for run in runs(shown) if not self.numbers.is_shown(run)]
        again = [label for run in runs(shown) if (label := self.numbers.is_shown(run))]
        uses = self.used(step, [left for left, _ in shown])
        if fresh and again:  # of what is shown once more, the number says enough
            names = [run[0][0] for run in runs(shown) if self.numbers.is_shown(run)]
            uses = f"{uses} Here {defined_in(names, again)}.".lstrip()
        new = self.numbers.number(fresh)
        self.labels.append([e.label for e in new if e.label] or again)
        n, proved = len(step.vanishes), step.title in self.proof.steps
        counted = f"{n} {'identity' if n == 1 else 'identities'}" if n and proved else ""
        if counted and step.nonnegative:
            counted += ", where " + ", ".join(rf"${self.math(e)} \ge 0$" for e in step.nonnegative)
        rows, upright_vectors = self.table(step.rows)
        room = room_of((4 if upright_vectors else 2) * len(rows) + 3)
        return {
            "title": escape(step.title),
            "index": indexed(step.title),
            "place": place(step.title),
            "reason": self.prose(step.reason),
            "uses": uses,
            "again": "" if fresh else reference(again),
            "blocks": blocks(new),
            "columns": "".join(map(column, zip(*step.rows, strict=True))),
            "rows": rows,
            "room": room,
            "heading_room": room + HEADING,
            "published": [(escape(n), self.claims.judged(n)) for n in step.published],
            "counted": counted,
            "proves": self.prose(step.proves) if counted else "",
        }

    def used(self, step: Step, left: Sequence[str]) -> str:
        """Where the names in a step are defined that earlier steps define."""
        steps = self.derivation.steps
        labels = [x for s in step.uses for x in self.labels[steps.index(s)]]
        told = f"This rests on {reference(labels)}." if labels else ""
        here = {n for text in left for n in names_in(text.partition("=")[0])}
        names = [n for text in left for n in names_in(text.partition("=")[2])]
        names += [canonical(text) for text in sorted(map(self.math, symbols_of(step)))]
        here |= {canonical(self.math(e)) for e in symbols_declared(self.derivation)}
        known = self.numbers.defined
        found = {n: known[n] for n in dict.fromkeys(names) if n in known and n not in here}
        found = {n: label for n, label in found.items() if label not in labels}
        seen = defined_in(by_equation(found), found.values()) if found else ""
        return f"{told} Here {seen}.".lstrip() if seen else told

    def table(self, rows: Sequence[Sequence[Any]]) -> tuple[list[list[str]], bool]:
        """The cells of a table, and whether its vectors stand upright because it is too wide."""
        cells = [[self.cell(cell) for cell in row] for row in rows]
        columns = [zip(*part, strict=True) for part in (rows, cells)]
        if sum(starmap(width_of, zip(*columns, strict=True))) <= FITS:
            return cells, False
        return [[self.cell(cell, upright=True) for cell in row] for row in rows], True

    def cell(self, value: Any, *, upright: bool = False) -> str:
        """A cell of a table: a sentence, an expression or an increasing chain of them.

        Vectors that lie in their row stand ``upright`` if that is asked for.
        """
        if isinstance(value, str):  # after \\ a star or a bracket would be an argument
            return "{}" * value.startswith(("*", "[")) + self.prose(value)
        chain = value if isinstance(value, tuple) else (value,)
        sums = [
            moduli_cancelled(e).replace(lambda part: part.is_Add, with_sums_of_angles)
            for e in map(sp.sympify, chain)
        ]
        if upright:
            sums = [e.T if isinstance(e, sp.MatrixBase) and e.rows == 1 else e for e in sums]
        text = r" \le ".join(map(self.math, sums))
        text = text if "(" in text else flat(text)  # 1/2 (a + b) would be misread
        return rf"$\displaystyle {text}$"

    def function(self, function: Function) -> dict[str, Any]:
        return {
            "name": escape(function.name),
            "index": index_of(function.name),
            "arguments": ", ".join(escape(a.name) for a in function.inputs),
            "summary": self.prose(function.summary),
            "source": self.prose(function.source),
            **self.computed(function),
            "key": key(function.name) if function.has_status else "",
            "notes": [self.prose(n) for n in function.notes],
        }

    def computed(self, function: Function) -> dict[str, Any]:
        """What a function without a status computes, line by line, or where its formulas are."""
        if function.has_status or function.name == "singularities":
            return {**BARE, "evaluates": ""}
        shown = self.numbers.of(function.equation)
        outputs = [] if shown else self.outputs(function)
        where = [self.numbers.with_right(right) for _, right in outputs]
        if shown or (outputs and all(where) and not function.body):
            labels = [shown] if shown else list(dict.fromkeys(where))
            modes = " in each assembly mode" if function.branches else ""
            return {**BARE, "evaluates": reference(labels) + modes}
        if not function.body:
            return {**BARE, **self.formulas(function, outputs), "evaluates": ""}
        return {**self.listing(function), "evaluates": ""}

    def formulas(self, function: Function, outputs: Sequence[Equation]) -> dict[str, Any]:
        """The results of a function that its summary does not tell; many arguments in one line."""
        summary = self.prose(function.summary)
        given = {self.math(e) for a in function.inputs for e in a.entries}
        found = [run for run in runs(outputs) if "${} = {}$".format(*run[0]) not in summary]
        same = [run[0] for run in found if len(run) == 1 and run[0][1] in given]
        if len(same) < FEW:
            same = []
        left, right = (r",\ ".join(side) for side in zip(*same, strict=True)) if same else ("", "")
        return {
            "same": f"$({left}) = ({right})$" if same else "",
            "blocks": blocks(self.numbers.number(run for run in found if run[0] not in same)),
        }

    def listing(self, function: Function) -> dict[str, Any]:
        """The lines of a function."""
        algorithm = self.algorithm(function)
        lines, cases = algorithm.lines(), Cases(algorithm)
        return {
            **BARE,
            "after": self.after(function, algorithm),
            "roundings": cases.roundings(),
            "lines": lines,
            "lines_kept": lines_kept(lines),
            "borrowed": self.borrowed(algorithm, lines),
            "cases": cases.told(),
        }

    def borrowed(self, algorithm: Algorithm, lines: Sequence[Line]) -> str:
        """The names in an algorithm that steps define, and the numbers of their equations.

        Names that only a function has which it continues are explained there.
        """
        numbers = self.numbers.defined
        seen = {name for line in lines for name in names_in(line.text)}
        known = numbers.keys() & seen
        labels = {n: numbers[c] for n in algorithm.borrowed if (c := canonical(n)) in known}
        return f"Here {defined_in(by_equation(labels), labels.values())}." if labels else ""

    def after(self, function: Function, algorithm: Algorithm) -> str:
        """The function with whose statements this one starts, and whether their cases matter."""
        model = self.model(function)
        if model is None:
            return ""
        label = f"inverse:{self.derivation.name}:{key(model.name)}"
        place = rf", Section~\ref{{{label}}}" if model.has_status else ""
        cases = ", with its special cases" if Cases(algorithm).has_cases_of_model else ""
        return rf"\texttt{{{escape(model.name)}}}{place}{cases}"

    def inverse(self, function: Function) -> dict[str, Any]:
        """A function with a status for each branch."""
        algorithm = self.algorithm(function)
        told = Told(self, function, algorithm, self.after(function, algorithm))
        results = [r for r in self.proof.inverses if r.function == function.name]
        proved = [told.proved(r) for r in results]
        return {**self.function(function), **told.context(), "proved": proved}

    def singular_set(self) -> dict[str, Any]:
        """The factors that vanish, each with its name: where the rank falls, and the poles."""
        derivation = self.derivation
        if unknown := set(derivation.poles) - set(derivation.singularities):
            raise ValueError(f"{sorted(unknown)[0]!r} is a pole, but not one of the singularities")
        found = next((f for f in derivation.functions if f.name == "singularities"), None)
        if found is None:
            return {}
        names = derivation.singularities or ("factor",)
        signs = {s: sp.S.One for _, chosen in found.cases() for s in chosen}
        factors = [e for a in found.outputs for e in a.entries]
        # without the sign of a mode it vanishes where it did
        entries = list(enumerate(e.xreplace(signs) if e.is_Mul else e for e in factors))
        told = not found.body or self.numbers.of(found.equation)
        algorithm = None if told else self.algorithm(found)
        rows = {
            kind: [
                (
                    self.named_set(names[k % len(names)]),
                    formulas([text := self.vanishing(e, algorithm)]) + self.stated(text),
                )
                for k, e in entries
                if (names[k % len(names)] in derivation.poles) == poles
            ]
            for kind, poles in (("rank", False), ("poles", True))
        }
        arguments = ", ".join(escape(a.name) for a in found.inputs)
        listing = BARE if told else self.listing(found)
        return {**rows, **listing, "name": found.name, "arguments": arguments}

    def named_set(self, name: str) -> str:
        """The name of a singular set, or nothing if it is the equation itself."""
        return "" if "=" in name else f"{self.prose(name)}: "

    def vanishing(self, factor: sp.Expr, algorithm: Algorithm | None) -> str:
        """``B_11 = rho = 0`` for a factor with a name of its own; a sign does not vanish."""
        if algorithm and factor.is_Mul:
            factor = sp.Mul(*(f for f in factor.args if not is_sign(algorithm.values.get(f))))
        named = algorithm.shown if algorithm else self.in_names_of_steps
        shown = self.math(named(factor))
        own = self.math(factor)
        name = f"{own} = " if factor.is_Symbol and own != shown else ""
        return f"{name}{shown} = 0"

    def stated(self, vanishing: str) -> str:
        """Where the name is defined whose vanishing is a formula."""
        printed = vanishing.removesuffix(" = 0")
        name = canonical(printed)
        any_leg = re.sub(r"\d(?=\d?\}$)", INDEX, name)
        known = self.numbers.defined
        label = known.get(name) or known.get(any_leg) or known.get(symbols.matrix_of(name, known))
        joints = {canonical(self.math(j.symbol)) for j in self.derivation.joints}
        return f", where {defined_in([printed], [label])}" if label and name not in joints else ""

    def in_names_of_steps(self, value: sp.Expr) -> sp.Expr:
        """A value of the joints in names that the steps have defined."""
        named = {str(s): s for s in value.free_symbols}
        return self.lines.tidy(self.quantities.of_a_function(value, (), named))

    def outputs(self, function: Function) -> list[Equation]:
        self.lines.clear()
        names = function.entries
        rows = list[Equation]()
        for array in function.outputs:
            own = [self.math(n) for n in names] or self.named(array)
            entries = [self.quantities.of_a_function(e, own) for e in array.entries]
            rows += self.array(array, entries, names)
        return rows


def finds_all(inverse: Inverse, lemmas: Sequence[Lemma]) -> bool:
    """Whether one lemma finds all joints of an inverse without links, as the angles of a wrist."""
    return len(lemmas) == 1 and not inverse.links and {*lemmas[0].solution} == {*inverse.unknowns}


def is_sign(value: sp.Expr | None) -> bool:
    """Whether a value is a sign, by cases."""
    return isinstance(value, sp.Piecewise) and {abs(e) for e, _ in value.args} == {1}


def matrices(inverse: Inverse, lemmas: Sequence[Lemma]) -> dict[str, sp.MatrixBase]:
    """The rotations that lemmas find entry by entry, in the names of the program."""
    meaning = {e: name for name, e in inverse.rank.meaning.items()}
    return {
        lemma.matrix: sp.Matrix(3, 3, [meaning[u] for u in lemma.solution])
        for lemma in lemmas
        if lemma.matrix and len(lemma.solution) == 9
    }


def tied(title: str) -> str:
    """A title in which the number of a model stays beside its name: ``IRB~2400``."""
    return re.sub(r"(?<=[A-Za-z]) (?=\d+\b)", "~", title)


def room_of(lines: int) -> int:
    """The lines that a table of so many lines has to find on a page, to begin there."""
    return lines if lines <= ROOM else LEFT


def column(cells: Sequence[Any]) -> str:
    """The type of a column of a table: long sentences are broken into lines."""
    longest = max(len(c) for c in (*cells, "") if isinstance(c, str))
    return r"L{0.5\linewidth}" if longest > SENTENCE else "l"


def width_of(values: Sequence[Any], cells: Sequence[str]) -> float:
    """The width of a column of a table from its values and what is printed of them."""
    spoken = column(values) != "l"
    return FITS / 2 if spoken else max(map(measure, cells))


def indexed(title: str) -> str:
    """The entry of a step in the index, ``inverse kinematics!elbow`` for "Inverse: the elbow"."""
    escaped = re.sub(r'(["@|!])', r'"\1', escape(title))
    parts = [ARTICLE.sub("", part.strip()) for part in escaped.split(":")]
    if len(parts) > 1 and parts[0] in MAPS:
        parts[0] += " kinematics"
    return "!".join(p if PROPER.match(p) else p[:1].lower() + p[1:] for p in parts)


def index_of(function: str) -> str:
    """The entry of a function in the index."""
    return rf"function!{function.replace('_', ' ')}@\texttt{{{escape(function)}}}"


def default(value: sp.Rational) -> str:
    """The value of a parameter: a part of a turn if it is one to all digits, or a decimal."""
    part = sp.Rational(float(value / sp.pi)).limit_denominator(PARTS)
    if part and abs(float(value / (part * sp.pi)) - 1) <= 2 * sys.float_info.epsilon:
        return f"${flat(sp.latex(part * sp.pi))}$"
    text = decimal(value)
    return f"${text}$" if value.is_negative else text


def decimal(value: sp.Rational) -> str:
    """A rational as a decimal if that is exact and short, or shorter than the fraction."""
    text = exact_decimal(value)
    digits = len(text.partition(".")[2])
    return text if digits < 7 or len(text) < len(str(value)) else str(value)


def key(function: str) -> str:
    """The name of a function in labels."""
    return function.replace("_", "-")


def formulas(texts: Sequence[str]) -> str:
    """Formulas in a sentence."""
    return ", ".join(rf"$\displaystyle {t}$" for t in texts)


def shared_notes(functions: Sequence[Mapping[str, Any]]) -> dict[str, str]:
    """The notes that several functions have, which are printed once, with their names."""
    having: dict[str, list[str]] = {}
    for function in functions:
        for note in function["notes"] if not function["key"] else ():
            having.setdefault(note, []).append(rf"\texttt{{{function['name']}}}")
    return {note: listed(names) for note, names in having.items() if len(names) >= FEW}


def source_of_all(derivation: Derivation, text: Callable[[str], str]) -> str:
    """Where all defaults come from, if that is one source."""
    sources = {text(p.source) for p in derivation.parameters}
    return sources.pop() if len(sources) == 1 and len(derivation.parameters) > 1 else ""


def document(derivation: Derivation, proof: Proof) -> dict[str, Any]:
    """The context of ``latex/robot.tex.jinja``."""
    page = Page(derivation, proof)
    text = page.prose
    context: dict[str, Any] = {
        "name": derivation.name,
        "title": escape(derivation.title),
        "heading": tied(escape(derivation.title)),
        "source": bibliography.source(derivation.paper),
        "cited": bibliography.cited(derivation.paper),
        "works": bibliography.entries([derivation.paper]),
        "mechanism": text(derivation.mechanism),
        "parameters": [
            (page.math(p.symbol), escape(p.name), escape(p.unit), default(p.value),
             text(p.meaning), text(p.source)) for p in derivation.parameters
        ],
        "source_of_all": source_of_all(derivation, text),
        "joints": [page.joint(j) for j in derivation.joints],
        "joints_room": room_of(len(derivation.joints) + 4),
        "parameters_room": room_of(
            4 + sum(1 + len(p.meaning) // SENTENCE for p in derivation.parameters)
        ),
        "steps": [{**page.step(s), "number": k} for k, s in enumerate(derivation.steps, 1)],
        "modes": derivation.assembly_modes,
        "inverses": [page.inverse(f) for f in derivation.functions if f.has_status],
        "functions": [page.function(f) for f in derivation.functions if f.name != UNPRINTED],
        "singular": page.singular_set(),
        "verdicts": ", ".join(f"{n} {kind}" for kind, n in proof.verdicts().items()),
        "errata": page.claims.errata(),
        "paper_source": mixed(derivation.paper.source),
        "claims": page.claims.rows(),
        "claims_numbered": any(c["step"] for c in page.claims.rows()),
        "sources": len(derivation.paper.cited) > 1,
    }  # fmt: skip
    legend = page.legend()
    symbols.require_distinct(derivation, page.math, legend, page.printer.names)
    notation = symbols.joined(symbols.table(derivation, page.numbers, text, page.math))
    return context | {
        "shared_notes": shared_notes(context["functions"]),
        "legend": [f"{short} = {full}" for short, full in legend],
        "symbols": notation,
        "theorems": lemmas.context(lemmas.lemmas_of(derivation), {}),
    }
