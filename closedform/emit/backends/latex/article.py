"""Prints a derivation as a LaTeX article.

Python prepares the formulas and the sentences; the templates lay them out.  A formula that fits on
a line is aligned; a longer one is set in a paragraph, and TeX breaks it at operators.  The printer
does not write ``\\left(``, because TeX never breaks inside it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import count, groupby
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter

from closedform.algebra.formulas import PRINTED, formula
from closedform.emit.backends.latex import bibliography, lemmas, symbols
from closedform.emit.backends.latex.claims import Claims
from closedform.emit.backends.latex.equations import (
    Equation,
    Numbers,
    canonical,
    listed,
    names_in,
    reference,
)
from closedform.emit.backends.latex.prose import (
    Prose,
    escape,
    loosen,
    mixed,
    spaced,
    symbol_name,
    symbols_declared,
    symbols_of,
    upright,
    written_name,
)
from closedform.model.derivation import Continuum, Derivation, Inverse, Joint, Step
from closedform.model.functions import (
    Array,
    Bound,
    Determined,
    Function,
    Let,
    Match,
    Statement,
    Vanishes,
    real,
)
from closedform.proof.prove import InverseResult, Proof

__all__ = ["Page", "document"]

FITS = 84.0
"""The widest formula that is set on one line, in average letters of 10 pt."""
LISTED = 3
"""More equations than this that only name a symbol, such as lengths, are a list without numbers."""


class Printer(LatexPrinter):  # type: ignore[misc]
    """LaTeX with upright c, s for cosines and sines of (sums of) numbered joint angles."""

    def __init__(self, joints: set[sp.Symbol], name: Callable[[str], str] = symbol_name):
        super().__init__({"long_frac_ratio": 20})
        self.joints, self.legend, self.name = joints, dict[str, str](), name

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        pair = re.fullmatch(r"([cs])(\d)", expr.name)
        if pair and any(j.name == f"theta{pair[2]}" for j in self.joints):  # a joint, solved
            return self._circular({"c": "cos", "s": "sin"}[pair[1]], real(f"theta{pair[2]}"), None)
        return self.name(expr.name)

    def _print_sin(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._circular("sin", expr.args[0], exp)

    def _print_cos(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._circular("cos", expr.args[0], exp)

    def _circular(self, function: str, angle: sp.Expr, exp: str | None) -> str:
        power = f"^{{{exp}}}" if exp else ""
        numbers = [
            (re.fullmatch(r"theta(\d)([A-Z]?)", str(term)) if term in self.joints else None)
            for term in angle.as_ordered_terms()
        ]
        over, under = sp.fraction(sp.together(angle))
        if angle.is_Add and under.is_Integer and under != 1:
            full = rf"\frac{{{self._print(over)}}}{{{under}}}"
        else:
            full = self._print(angle) if angle.is_Symbol else f"({self._print(angle)})"
        if all(numbers):
            index = sorted(n[1] + (rf"\mathrm{{{n[2]}}}" if n[2] else "") for n in numbers if n)
            short = rf"\mathrm{{{function[0]}}}_{{{''.join(index)}}}"
            self.legend[short] = rf"\{function} {full}"
            return short + power
        return rf"\{function}{power} {full}"

    def _print_atan2(self, expr: sp.Expr) -> str:
        y, x = map(self._print, expr.args)
        return rf"\operatorname{{atan2}}({y},\ {x})"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        cases = [rf"{self._print(e)}, & {self.case(c)}" for e, c in expr.args]
        return rf"\begin{{cases}}{stacked(cases)}\end{{cases}}"

    def case(self, condition: Any) -> str:
        if condition == sp.true:
            return r"\text{otherwise}"
        return rf"\text{{if {self._words(condition)}}}"

    def _words(self, condition: Any) -> str:
        if isinstance(condition, sp.Not):
            return f"not {self._words(condition.args[0])}"
        if isinstance(condition, sp.And | sp.Or):
            word = " and " if isinstance(condition, sp.And) else " or "
            return word.join(sorted(map(self._words, condition.args)))
        return flag_name(condition) if condition.is_Symbol else f"${self._print(condition)}$"

    def math(self, expr: Any) -> str:
        """An expression that TeX can break between its terms."""
        return spaced(loosen(self.doprint(expr)))


def flag_name(flag: sp.Symbol) -> str:
    return str(flag.name).replace("_", " ")


def stacked(rows: Sequence[str]) -> str:
    """Rows of a matrix or of cases; fractions need some space between them."""
    small = "".join(rows).count(r"\frac") < 2
    return (r" \\ " if small else r" \\[3pt] ").join(rows)


INNERMOST = re.compile(r"\\begin\{(\w+)\}((?:(?!\\begin|\\end).)*)\\end\{\1\}", re.DOTALL)


def measure(text: str) -> float:
    """The width of a formula, in average letters; a fraction counts as its two parts."""
    if stack := INNERMOST.search(text):
        widest = max(map(measure, re.split(r" \\\\(?:\[3pt\])? ", stack[2])))
        return measure(text[: stack.start()] + text[stack.end() :]) + 3 + widest
    text = re.sub(r"\\(?:mathrm|operatorname|text|left|right|[bB]ig[lr])\b", "", text)
    return len(re.findall(r"\\[a-z]+|[^\s{}^_]", text)) + 1.2 * len(
        re.findall(r"[-+=&]|\\sin|\\cos", text)
    )


class Page:
    """Collects the strings of one document."""

    def __init__(self, derivation: Derivation, proof: Proof):
        self.derivation, self.proof = derivation, proof
        joints = {j.symbol for j in derivation.joints}
        self.printer = Printer(joints, partial(written_name, derivation))
        self.numbers = Numbers(derivation.name)
        self.labels: list[list[str]] = []
        """The labels of the equations of each step."""
        self.claims = Claims(derivation, proof, self.labels)
        self.math, self.prose = self.printer.math, Prose(derivation)
        self.parts: dict[sp.Basic, sp.Symbol] = {}
        """Names for parts of formulas that are too wide for a line, within one list of them."""

    def legend(self) -> list[tuple[str, str]]:
        """The abbreviated sines and cosines that have been printed so far."""
        return sorted(self.printer.legend.items(), key=lambda e: (len(e[1]), e[0][9:], e[0]))

    def joint(self, joint: Joint) -> tuple[str, str, str, str]:
        role = "passive: the others move it" if joint.passive else "actuated"
        if joint.coupling is not None:
            role = f"coupled: ${self.math(joint.symbol)} = {self.math(joint.coupling)}$"
        return self.math(joint.symbol), escape(joint.name), joint.kind, role

    def step(self, step: Step) -> dict[str, Any]:
        self.parts.clear()
        shown = [
            (left, right)
            for lhs, value in step.shown
            for left, right in self.equations(upright(lhs), value)
        ]
        again = [label for e in shown if (label := self.numbers.is_shown(*e))]
        uses = self.used(step, [left for left, _ in shown])
        new = self.numbers.number(e for e in shown if not self.numbers.is_shown(*e))
        if len(shown) > LISTED and all(isinstance(v, sp.Symbol) for _, v in step.shown):
            new = [Equation(e.left, e.right) for e in new]
        self.labels.append([e.label for e in new if e.label] or again)
        n, proved = len(step.vanishes), step.title in self.proof.steps
        mark = f"{n} {'identity' if n == 1 else 'identities'}" if n and proved else ""
        if mark and step.nonnegative:
            mark += ", where " + ", ".join(rf"${self.math(e)} \ge 0$" for e in step.nonnegative)
        return {
            "title": escape(step.title),
            "index": indexed(step.title),
            "reason": self.prose(step.reason),
            "uses": uses,
            "again": reference(again),
            "blocks": blocks(new),
            "columns": "l" * len(step.rows[0]) if step.rows else "",
            "rows": [" & ".join(map(self.cell, row)) for row in step.rows],
            "published": [(escape(n), self.claims.judged(n)) for n in step.published],
            "mark": mark,
            "proves": self.prose(step.proves) if mark else "",
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
        seen = [f"{reference([label])} for ${name}$" for name, label in found.items()]
        return f"{told} See {listed(seen)}." if seen else told

    def cell(self, value: Any) -> str:
        """A cell of a table: a sentence, an expression or an increasing chain of them."""
        if isinstance(value, str):  # after \\ a star or a bracket would be an argument
            return "{}" * value.startswith(("*", "[")) + self.prose(value)
        chain = value if isinstance(value, tuple) else (value,)
        text = r" \le ".join(map(self.math, chain))
        return rf"$\displaystyle {text}$"

    def function(self, function: Function) -> dict[str, Any]:
        return {
            "name": escape(function.name),
            "arguments": ", ".join(escape(a.name) for a in function.inputs),
            "summary": self.prose(function.summary),
            "source": self.prose(function.source),
            **self.formulas_of(function),
            "key": _key(function) if function.has_status else "",
            "notes": [self.prose(n) for n in function.notes],
        }

    def formulas_of(self, function: Function) -> dict[str, Any]:
        """The formulas of a function, unless steps show them: then where they stand."""
        if function.has_status or function.name == "singularities":
            return {"statements": [], "blocks": [], "evaluates": ""}
        defined, name = self.numbers.defined, canonical(function.equation)
        outputs = [] if name in defined else self.outputs(function)
        where = [self.numbers.right.get(right, "") for _, right in outputs]
        if name in defined or (outputs and all(where) and not function.body):
            labels = [defined[name]] if name in defined else list(dict.fromkeys(where))
            return {"statements": [], "blocks": [], "evaluates": reference(labels)}
        return {
            "statements": self.shared_statements(function),
            "blocks": blocks(self.numbers.number(outputs)),
            "evaluates": "",
        }

    def inverse(self, function: Function) -> dict[str, Any]:
        """A function with a status for each branch."""
        solved = [s for s in self.derivation.solved if s.function == function.name]
        lemmas = {s.lemma.name: s.lemma.statement for s in solved}
        inverse = next((i for i in self.derivation.inverses if i.function == function.name), None)
        proved = [self.proved(r) for r in self.proof.inverses if r.function == function.name]
        return {
            **self.function(function),
            "statements": self.statements(function.body),
            "blocks": blocks(self.outputs(function)),
            "given": formulas(
                [f"{a} = {b}" for v in function.inputs for a, b in self.assigned(v, {})]
            ),
            "lemmas": [(escape(name), loosen(text)) for name, text in lemmas.items()],
            "solved": [
                (self.math(s.unknown), escape(s.lemma.name), f"0 = {self.math(s.equation)}")
                for s in solved
            ],
            "branches": [
                (escape(label), ",\\ ".join(f"{self.math(s)} = {v:+d}" for s, v in signs.items()))
                for label, signs in function.cases()
                if signs
            ],
            "continua": [self.continuum(function, inverse, c) for c in inverse.continua]
            if inverse
            else [],
            "proved": proved,
        }

    def shared_statements(self, function: Function) -> list[tuple[str, str]]:
        """Like :meth:`statements`, but statements of an earlier function are not repeated."""
        functions = self.derivation.functions
        earlier = functions[: functions.index(function)]
        shared = [f for f in earlier if f.body and function.body[: len(f.body)] == f.body]
        if not shared:
            return self.statements(function.body)
        model = max(shared, key=lambda f: len(f.body))
        place = (
            rf", Section~\ref{{inverse:{self.derivation.name}:{_key(model)}}}"
            if model.has_status
            else ""
        )
        rest = self.statements(function.body[len(model.body) :])
        return [("as in", rf"\texttt{{{escape(model.name)}}}{place}"), *rest]

    def statements(self, body: Sequence[Statement]) -> list[tuple[str, str]]:
        """One line for each statement, but neighbours of the same kind may share a line."""
        self.parts.clear()
        lines: list[tuple[str, str]] = []
        for kind, text in map(self.statement, body):
            _, colon, meaning = text.partition("$: ")
            last = lines[-1][1] if lines and lines[-1][0] == kind else ""
            if kind == "let" and last and measure(last + text) < FITS:
                lines[-1] = kind, f"{last},\\quad {text}"
            elif kind == "match" and last.endswith(colon + meaning):
                lines[-1] = kind, f"{last.removesuffix(colon + meaning)}$, {text}"
            else:
                lines.append((kind, text))
        return lines

    def statement(self, statement: Statement) -> tuple[str, str]:
        """The kind of a statement, and a sentence for it."""
        if isinstance(statement, Let | Bound):
            equations = [f"{a} = {b}" for a, b in self.equations(statement.symbol, statement.value)]
            if isinstance(statement, Let):
                return "let", formulas(equations)
            equations[-1] += r" \ge 0"
            return "bound", f"{formulas(equations)}: {self.prose(statement.meaning)}"
        if isinstance(statement, Vanishes):
            condition = formulas([f"{self.math(statement.value)} = 0"])
            free = " and ".join(f"${self.math(s)}$" for s in statement.free)
            effect = f"; then {free} is free (\\textsc{{singular}})" if free else ""
            name, meaning = flag_name(statement.symbol), self.prose(statement.meaning)
            return "flag", rf"\emph{{{name}}} if {condition}: {meaning}{effect}"
        if isinstance(statement, Determined):
            small = formulas([rf"{self.math(statement.value)} \ll {self.math(statement.scale)}"])
            effect = r"rounded joints do not determine the posture (\textsc{singular})"
            return "flag", f"If {small}, {self.prose(statement.meaning)}: {effect}"
        values = [statement.value] if isinstance(statement, Match) else statement.values
        conditions = formulas([f"{self.math(v)} = 0" for v in values])
        kind = "match" if isinstance(statement, Match) else "require"
        return kind, f"{conditions}: {self.prose(statement.meaning)}"

    def continuum(self, function: Function, inverse: Inverse, case: Continuum) -> dict[str, str]:
        """The set on which a joint is free, the returned value, and what all solutions share."""
        given = [e for a in function.inputs for e in self.assigned(a, case.locus)]
        others = {p.symbol for p in self.derivation.parameters} & set(case.locus)
        given += [e for s in sorted(others, key=str) for e in self.equations(s, case.locus[s])]
        _, signs = next(function.cases())
        values = function.at(signs, {case.flag: True}, case.locus)
        convention = dict(zip(inverse.unknowns, values, strict=True))[case.free]
        return {
            "free": self.math(case.free),
            "flag": flag_name(case.flag),
            "locus": formulas([f"{a} = {b}" for a, b in given]),
            "convention": f"{self.math(case.free)} = {self.math(convention)}",
            "relation": upright(case.relation),
        }

    def proved(self, result: InverseResult) -> dict[str, Any]:
        symbols = {s.name: s for f in self.derivation.functions for s in f.symbols}
        symbols |= {p.name: p.symbol for p in self.derivation.parameters}
        known = self.derivation[result.function]
        named = self.named_bounds(known, result.assumptions)
        assumed = dict.fromkeys(
            self.math(named.get(a) or formula(a, lambda n: symbols.get(n, real(n)), PRINTED))
            for a in result.assumptions
        )
        given = [rf"{e} \ge 0" for e in assumed]
        how = {
            "generic": "by a Groebner basis over the field of parameters and targets",
            "specialised": "by Groebner bases, with the same result at several rational points",
        }
        return {
            "where": f", where {formulas(given)}" if given else "",
            "count": f"{result.solutions} solution{'s' * (result.solutions != 1)}",
            "how": how.get(result.method, escape(result.method)),
            "lemmas": result.lemmas,
            "continua": result.continua,
        }

    def named_bounds(self, function: Function, assumed: Sequence[str]) -> dict[str, sp.Symbol]:
        """The name of each bound by its explicit form, for all branches.

        Only bounds with the symbols of an assumption are included: the others cannot be an
        assumption, and may be very long.
        """
        held = [set(re.findall(r"\w+", text)) for text in assumed]
        rests: dict[sp.Basic, set[str]] = {}
        names = []
        for statement in function.body:
            if isinstance(statement, Let | Bound):
                free = statement.value.free_symbols
                rests[statement.symbol] = {n for s in free for n in rests.get(s, {str(s)})}
                if isinstance(statement, Bound):
                    names.append(statement.symbol)
        signs = {str(s) for _, chosen in function.cases() for s in chosen}
        flags = {str(s.symbol) for s in function.body if isinstance(s, Vanishes)}
        names = [n for n in names if any(rests[n] - signs - flags <= h for h in held)]
        return {
            str(function.explicit([name], chosen)[1][-1]): name
            for _, chosen in function.cases()
            for name in names
        }

    def singular_set(self) -> dict[str, Any]:
        """The factors that vanish, each with its name: where the rank falls, and the poles."""
        derivation = self.derivation
        if unknown := set(derivation.poles) - set(derivation.singularities):
            raise ValueError(f"{sorted(unknown)[0]!r} is a pole, but not one of the singularities")
        found = next((f for f in derivation.functions if f.name == "singularities"), None)
        if found is None:
            return {}
        names = derivation.singularities or ("factor",)
        entries = list(enumerate(e for a in found.outputs for e in a.entries))
        rows = {
            kind: [
                (escape(names[k % len(names)]), formulas([f"{self.math(e)} = 0"]))
                for k, e in entries
                if (names[k % len(names)] in derivation.poles) == poles
            ]
            for kind, poles in (("rank", False), ("poles", True))
        }
        return {**rows, "statements": self.shared_statements(found)}

    def outputs(self, function: Function) -> list[tuple[str, str]]:
        self.parts.clear()
        return [e for a in function.outputs for e in self.array(a, function.entries)]

    def assigned(self, array: Array, locus: Mapping[sp.Symbol, sp.Expr]) -> list[tuple[str, str]]:
        """An argument and its entries, or the values of the entries on ``locus``."""
        if not locus or all(e in locus for e in array.entries):
            entries = [locus.get(e, e) for e in array.entries]
            matrix = len(array.shape) == 2
            value = sp.Matrix(*array.shape, entries) if matrix else entries
            return self.equations(symbol_name(array.name), value)
        return [x for e in array.entries if e in locus for x in self.equations(e, locus[e])]

    def array(self, array: Array, entries: Sequence[sp.Symbol] = ()) -> list[tuple[str, str]]:
        """The equations of a result: a matrix, or a row for each coordinate under its name."""
        name = symbol_name(array.name)
        if len(array.shape) > 1:
            shape = array.shape[-2:]
            parts = sp.Matrix(array.size // sp.prod(shape), sp.prod(shape), array.entries)
            marks = [f"^{{({k + 1})}}" if len(array.shape) > 2 else "" for k in range(parts.rows)]
            return [
                equation
                for k, mark in enumerate(marks)
                for equation in self.equations(name + mark, parts.row(k).reshape(*shape))
            ]
        names = [element(name, str(k + 1)) if array.shape else name for k in range(array.size)]
        if entries:
            return [
                e for s, v in zip(entries, array.entries, strict=True) for e in self.equations(s, v)
            ]
        for known, coordinates in (("q", self.derivation.actuated), ("x", self.derivation.task)):
            if array.name == known and len(coordinates) == array.size:
                names = [self.printer.name(str(j)) for j in coordinates]
        return [e for n, v in zip(names, array.entries, strict=True) for e in self.equations(n, v)]

    def equations(self, lhs: Any, value: Any) -> list[tuple[str, str]]:
        """A value as one equation or, if it is too wide, as several."""
        left = lhs if isinstance(lhs, str) else self.math(lhs)
        if isinstance(value, sp.Expr | sp.MatrixBase) and (inner := self._unbreakable(value)):
            known = inner in self.parts
            name = self.parts.setdefault(inner, self._new_name())
            rest = self.equations(left, value.xreplace({inner: name}))
            return rest if known else rest + self.equations(name, inner)
        if isinstance(value, sp.MatrixBase):
            return self._matrix(left, value)
        if isinstance(value, str):
            return [(left, value)]
        if isinstance(value, list | tuple):
            return [(left, "(" + r",\ ".join(map(self.math, value)) + ")")]
        text = self.math(value)
        if isinstance(value, sp.Piecewise) and measure(text) > FITS:
            return [(left, rf"{self.math(e)}\quad {self.printer.case(c)}") for e, c in value.args]
        return [(left, text)]

    def _new_name(self) -> sp.Symbol:
        taken = self.prose.known | {s.name for s in self.parts.values()}
        return real(next(n for n in map("u{}".format, count(1)) if n not in taken))

    def _unbreakable(self, value: sp.Basic) -> sp.Expr | None:
        """The smallest part of a formula that is too wide and inside which TeX cannot break.

        This is a radicand, a denominator, a sum in a numerator, or cases next to other terms.
        """
        powers = (p for p in value.atoms(sp.Pow) if not p.exp.is_Integer or p.exp.is_negative)
        wide = [p.base for p in powers if measure(self.math(p.base)) > FITS - 12]
        for fraction in value.atoms(sp.Mul):
            over, under = sp.fraction(fraction)
            sums = [a for a in fraction.args if isinstance(a, sp.Add)]
            if under != 1 and sums and measure(self.math(over)) > FITS - 12:
                wide.append(max(sums, key=lambda e: (measure(self.math(e)), str(e))))
        if isinstance(value, sp.Expr) and not isinstance(value, sp.Piecewise):
            cases = sorted(value.atoms(sp.Piecewise), key=str)
            wide += cases if cases and measure(self.math(value)) > FITS - 12 else []
        return min(wide, key=lambda e: (sp.count_ops(e), str(e)), default=None)

    def _matrix(self, lhs: str, matrix: sp.MatrixBase) -> list[tuple[str, str]]:
        """The equations of a matrix; the widest entries get names until the rest fits on a line."""
        cells = [[self.math(e) for e in matrix.row(i)] for i in range(matrix.rows)]
        base, named = lhs.partition("=")[0].strip(), []
        while measure(lhs) + sum(max(map(measure, c)) + 2 for c in zip(*cells, strict=True)) > FITS:
            width, i, j = max(
                (measure(c), -i, -j) for i, row in enumerate(cells) for j, c in enumerate(row)
            )
            name = element(base, f"{1 - i}{1 - j}")
            if width <= measure(name):
                break
            named.append((-i, -j, (name, cells[-i][-j])))
            cells[-i][-j] = name
        rows = [" & ".join(row) for row in cells]
        whole = (lhs, rf"\begin{{bmatrix}} {stacked(rows)} \end{{bmatrix}}")
        return [whole, *(equation for _, _, equation in sorted(named))]


def indexed(title: str) -> str:
    """The entry of a step in the index: ``inverse!the elbow`` for "Inverse: the elbow"."""
    escaped = re.sub(r'(["@|!])', r'"\1', escape(title))
    return "!".join(part.strip()[:1].lower() + part.strip()[1:] for part in escaped.split(":"))


def decimal(value: sp.Rational) -> str:
    """A rational as a decimal if that is exact and short, else as a fraction."""
    digits = next((k for k in range(7) if (value * 10**k).is_Integer), None)
    return str(value) if digits is None else f"{float(value):.{digits}f}"


def _key(function: Function) -> str:
    return function.name.replace("_", "-")


def element(base: str, index: str) -> str:
    """The name of an entry of a matrix or a vector."""
    if subscript := re.fullmatch(r"(.+?)_\{?([^{}]+)\}?", base):
        return f"{subscript[1]}_{{{subscript[2]},{index}}}"
    return f"{base}_{{{index}}}" if " " not in base else f"({base})_{{{index}}}"


def blocks(equations: Sequence[Equation | tuple[str, str]]) -> list[str]:
    """Neighbours that fit on a line as one aligned block, longer equations as paragraphs."""
    done: list[str] = []
    lines = [e if isinstance(e, Equation) else Equation(*e) for e in equations]
    for (fits, numbered), group in groupby(lines, lambda e: (fitting(e), bool(e.label))):
        if fits:
            ends = ((e, rf" \label{{{e.label}}}" if e.label else "") for e in group)
            rows = " \\\\\n".join(f"{e.left} &= {e.right}{end}" for e, end in ends)
            kind = "align" if numbered else "align*"
            done.append(f"\\display\n\\begin{{{kind}}}\n{rows}\n\\end{{{kind}}}")
        elif numbered:
            done += [rf"\longequation{{{e.label}}}{{{e.left} = {e.right}}}" for e in group]
        else:
            done += [rf"\longformula{{{e.left} = {e.right}}}" for e in group]
    return done


def fitting(equation: Equation) -> bool:
    """Whether an equation fits on a line, with its number."""
    return measure(equation.left + equation.right) + 4 <= FITS - 6 * bool(equation.label)


def formulas(texts: Sequence[str]) -> str:
    """Formulas in a sentence."""
    return ", ".join(rf"$\displaystyle {t}$" for t in texts)


def document(derivation: Derivation, proof: Proof) -> dict[str, Any]:
    """The context of ``latex/robot.tex.jinja``."""
    page = Page(derivation, proof)
    text = page.prose
    context = {
        "name": derivation.name,
        "title": escape(derivation.title),
        "source": bibliography.source(derivation.paper),
        "cited": bibliography.cited(derivation.paper),
        "works": bibliography.entries([derivation.paper]),
        "mechanism": text(derivation.mechanism),
        "parameters": [
            (page.math(p.symbol), escape(p.name), escape(p.unit), decimal(p.value),
             text(p.meaning), text(p.source)) for p in derivation.parameters
        ],
        "joints": [page.joint(j) for j in derivation.joints],
        "steps": [{**page.step(s), "number": k} for k, s in enumerate(derivation.steps, 1)],
        "modes": derivation.assembly_modes,
        "inverses": [page.inverse(f) for f in derivation.functions if f.has_status],
        # the points of the skeleton are too many to print; a step says what is proved of them
        "functions": [page.function(f) for f in derivation.functions if f.name != "skeleton"],
        "singular": page.singular_set(),
        "verdicts": ", ".join(f"{n} {kind}" for kind, n in proof.verdicts().items()),
        "errata": page.claims.errata(),
        "paper_source": mixed(derivation.paper.source),
        "claims": page.claims.rows(),
    }  # fmt: skip
    legend = page.legend()
    symbols.require_distinct(derivation, page.math, legend)
    return context | {
        "legend": ",\\quad ".join(map(" = ".join, legend)),
        "symbols": symbols.table(derivation, page.numbers, text),
        "theorems": lemmas.context(lemmas.lemmas_of(derivation), {}),
    }
