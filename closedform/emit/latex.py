"""Prints a derivation as a LaTeX article, as a notebook cell, and the papers' errata as Markdown.

Python prepares the formulas and the sentences; the templates lay them out.  A formula that fits is
aligned; a longer one is set in a paragraph, where TeX itself breaks it at operators.  For that the
printer writes no ``\\left(``, between which TeX never breaks.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any

import sympy as sp
from sympy.printing.latex import LatexPrinter

from closedform.derivation import Continuum, Derivation, Joint, Step
from closedform.emit.show import Prose, errata, escape, mixed, symbol_name, upright, verified
from closedform.emit.text import citation
from closedform.functions import Array, Bound, Function, Let, Match, Statement, Vanishes
from closedform.prove import InverseResult, Proof

__all__ = ["document", "errata", "notebook"]

FITS = 78.0
"""Widest formula that is set on one line, in average letters of 10 pt."""


class Printer(LatexPrinter):  # type: ignore[misc]
    """LaTeX with upright c, s for cosines and sines of (sums of) numbered joint angles."""

    def __init__(self, derivation: Derivation, **settings: Any):
        super().__init__(settings)
        self.joints = {j.symbol for j in derivation.joints}
        self.legend: dict[str, str] = {}

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        return symbol_name(expr.name)

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
        full = self._print(angle)
        if all(numbers):
            index = sorted(n[1] + (rf"\mathrm{{{n[2]}}}" if n[2] else "") for n in numbers if n)
            short = rf"\mathrm{{{function[0]}}}_{{{''.join(index)}}}"
            self.legend[short] = rf"\{function}({full})" if len(index) > 1 else rf"\{function}{full}"
            return short + power
        simple = angle.is_Symbol
        return rf"\{function}{power}{full}" if simple else rf"\{function}{power}({full})"

    def _print_atan2(self, expr: sp.Expr) -> str:
        y, x = map(self._print, expr.args)
        return rf"\operatorname{{atan2}}({y},\ {x})"

    def _print_Piecewise(self, expr: sp.Piecewise) -> str:
        cases = [rf"{self._print(e)}, & {self.case(c)}" for e, c in expr.args]
        return r"\begin{cases}" + r" \\ ".join(cases) + r"\end{cases}"

    def case(self, condition: Any) -> str:
        if condition == sp.true:
            return r"\text{otherwise}"
        return rf"\text{{if {flag_name(condition)}}}" if condition.is_Symbol else self._print(condition)

    def math(self, expr: Any) -> str:
        """An expression that TeX can break between its terms."""
        text = loosen(self.doprint(expr))
        if max(map(measure, pieces(text))) <= FITS:
            return text
        wide = type(self).__new__(type(self))
        wide.__dict__.update(self.__dict__)
        wide._settings = {**self._settings, "long_frac_ratio": 1, "root_notation": False}
        return loosen(wide.doprint(expr))


def flag_name(flag: sp.Symbol) -> str:
    return str(flag.name).replace("_", " ")


def measure(text: str) -> float:
    """The width of a formula, in average letters; a fraction counts as its two parts."""
    text = re.sub(r"_\{?\\?\w+\}?|\\mathrm|\\operatorname|\\text|\\[a-z]+\{\w*matrix\}", "i", text)
    rows = re.split(r"\\\\(?= )", re.sub(r"\\(left|right|[bB]ig[lr])?(?![A-Za-z\\])|[{}^]", "", text))
    signs = re.compile(r"[-+=&]|\\(?:sin|cos|quad)")
    return max(
        len(re.findall(r"\\[A-Za-z]+|\S", row)) + 1.2 * len(signs.findall(row)) for row in rows
    )


def pieces(text: str) -> list[str]:
    """What TeX keeps together: the parts between operators outside braces."""
    parts, depth = [""], 0
    for token in re.findall(r"\\left|\\right|\\begin|\\end|\\.|[{}+=-]|[^\\{}+=-]+", text):
        depth += (token in ("{", r"\left", r"\begin")) - (token in ("}", r"\right", r"\end"))
        parts[-1] += token
        if token in "+-=" and depth == 0:
            parts.append("")
    return parts


def notebook(derivation: Derivation) -> str:
    """What Jupyter shows of a derivation: the forward map and the inverse."""
    page = Page(derivation, Proof("", "", (), 0, ()))
    rows = [rf"&\textbf{{{derivation.title}}}"]
    for function in derivation.functions:
        if function.name in ("fk", "ik"):
            rows.append(rf"&\text{{{function.summary}}}")
            for s in function.body:
                if isinstance(s, (Let, Bound)):
                    rows += [f"{a} &= {b}" for a, b in page.equations(s.symbol, s.value)]
            rows += [f"{a} &= {b}" for a, b in page.outputs(function)]
    rows += [f"{short} &= {full}" for short, full in page.legend()]
    return r"$\displaystyle \begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}$"


def document(derivation: Derivation, proof: Proof) -> dict[str, Any]:
    """The context of ``latex/robot.tex.jinja``."""
    page = Page(derivation, proof)
    text = page.prose
    context = {
        "name": derivation.name,
        "title": escape(derivation.title),
        "source": escape(citation(derivation)),
        "reference": escape(derivation.paper.reference),
        "mechanism": text(derivation.mechanism),
        "parameters": [
            (page.printer.math(p.symbol), escape(p.name), escape(p.unit), p.value, text(p.meaning),
             text(p.source)) for p in derivation.parameters
        ],
        "joints": [page.joint(j) for j in derivation.joints],
        "steps": [page.step(s) for s in derivation.steps],
        "inverses": [page.inverse(f) for f in derivation.functions if f.has_status],
        "functions": [page.function(f) for f in derivation.functions],
        "singular": page.singular_set(),
        "verdicts": ", ".join(f"{n} {kind}" for kind, n in proof.verdicts().items()),
        "claims": page.claims(),
    }  # fmt: skip
    return context | {"legend": page.legend()}


class Page:
    """Collects the strings of one document."""

    def __init__(self, derivation: Derivation, proof: Proof):
        self.derivation, self.proof = derivation, proof
        self.printer, self.prose = Printer(derivation), Prose(derivation)
        self.math = self.printer.math

    def legend(self) -> list[tuple[str, str]]:
        """The abbreviated sines and cosines that were printed so far."""
        return sorted(self.printer.legend.items(), key=lambda item: (len(item[1]), item))

    def joint(self, joint: Joint) -> tuple[str, str, str, str]:
        role = "passive: the others move it" if joint.passive else "actuated"
        if joint.coupling is not None:
            role = f"coupled: ${self.math(joint.symbol)} = {self.math(joint.coupling)}$"
        return self.math(joint.symbol), escape(joint.name), joint.kind, role

    def step(self, step: Step) -> dict[str, Any]:
        shown = [e for lhs, value in step.shown for e in self.equations(upright(lhs), value)]
        n, proved = len(step.vanishes), step.title in self.proof.steps
        mark = f"{n} {'identity' if n == 1 else 'identities'} proved" if n and proved else ""
        if mark and step.nonnegative:
            mark += " where " + ", ".join(rf"${self.math(e)} \ge 0$" for e in step.nonnegative)
        return {
            "title": escape(step.title),
            "reason": self.prose(step.reason),
            "blocks": blocks(shown),
            "published": escape(", ".join(step.published)),
            "mark": mark,
        }

    def function(self, function: Function) -> dict[str, Any]:
        statements = [] if function.has_status else function.body
        return {
            "name": escape(function.name),
            "arguments": ", ".join(escape(a.name) for a in function.inputs),
            "summary": self.prose(function.summary),
            "source": self.prose(function.source),
            "statements": [self.statement(s) for s in statements],
            "blocks": [] if function.has_status else blocks(self.outputs(function)),
            "label": f"inverse:{function.name}" if function.has_status else "",
            "notes": [] if function.has_status else [self.prose(n) for n in function.notes],
        }

    def inverse(self, function: Function) -> dict[str, Any]:
        """A function with a status for each branch."""
        solved = [s for s in self.derivation.solved if s.function == function.name]
        lemmas = {s.lemma.name: s.lemma.statement for s in solved}
        inverse = next((i for i in self.derivation.inverses if i.function == function.name), None)
        continua = inverse.continua if inverse else ()
        return {
            **self.function(function),
            "given": ", ".join(self.math(s) for s in function.symbols),
            "lemmas": [(escape(name), loosen(text)) for name, text in lemmas.items()],
            "solved": [
                (self.math(s.unknown), escape(s.lemma.name), f"0 = {self.math(s.equation)}")
                for s in solved
            ],
            "statements": [self.statement(s) for s in function.body],
            "blocks": blocks(self.outputs(function)),
            "branches": [
                (escape(label), ",\\ ".join(f"{self.math(s)} = {v:+d}" for s, v in signs.items()))
                for label, signs in function.cases()
                if signs
            ],
            "continua": [self.continuum(function, c) for c in continua],
            "proved": [
                line
                for result in self.proof.inverses
                if result.function == function.name
                for line in self.proved(result)
            ],
            "notes": [self.prose(n) for n in function.notes],
        }

    def statement(self, statement: Statement) -> tuple[str, str]:
        """The kind of a statement, and the sentence that says it."""
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
        values = [statement.value] if isinstance(statement, Match) else statement.values
        conditions = formulas([f"{self.math(v)} = 0" for v in values])
        kind = "match" if isinstance(statement, Match) else "require"
        return kind, f"{conditions}: {self.prose(statement.meaning)}"

    def continuum(self, function: Function, continuum: Continuum) -> dict[str, str]:
        """Where a joint is free, what is returned, and what all solutions there share."""
        locus = dict(continuum.locus)
        equations = []
        for a in function.inputs:
            if a.shape and len(a.shape) == 2 and all(e in locus for e in a.entries):
                equations += self.equations(a.name, sp.Matrix(*a.shape, [locus.pop(e) for e in a.entries]))
        equations += [e for s, v in locus.items() for e in self.equations(s, v)]
        inverse = next(i for i in self.derivation.inverses if i.function == function.name)
        _, signs = next(function.cases())
        values = function.at(signs, {continuum.flag: True}, continuum.locus)
        convention = dict(zip(inverse.unknowns, values, strict=False))[continuum.free]
        return {
            "free": self.math(continuum.free),
            "flag": flag_name(continuum.flag),
            "locus": formulas([f"{a} = {b}" for a, b in equations]),
            "convention": f"{self.math(continuum.free)} = {self.math(convention)}",
            "relation": upright(continuum.relation),
        }

    def proved(self, result: InverseResult) -> list[str]:
        symbols = {s.name: s for f in self.derivation.functions for s in f.symbols}
        symbols |= {p.name: p.symbol for p in self.derivation.parameters}
        given = [rf"${self.math(sp.sympify(a, symbols))} \ge 0$" for a in result.assumptions]
        where = f", where {', '.join(given)}" if given else ""
        one = result.branches == 1
        each = "the branch, put" if one else f"each of the {result.branches} branches, put"
        count = f"{result.solutions} solution{'' if result.solutions == 1 else 's'}"
        how = {
            "generic": "counted from a Gr\\"obner basis over the field of parameters and targets",
            "specialised": "counted from Gr\\"obner bases, the same at several rational points",
        }.get(result.method, escape(result.method))
        lines = [
            f"Sound: {each} into the forward map, gives the target identically{where}.",
            f"Complete: the polynomial system has {count}, {how}.",
        ]
        if result.lemmas:
            lines.append("Each equation that a lemma solves follows from the forward map.")
        if result.continua:
            lines.append("On each continuum the value by convention satisfies the forward map too.")
        return lines

    def claims(self) -> list[dict[str, Any]]:
        checks = {(c.label, c.printed): c.check for c in self.derivation.claims}
        rows = []
        for claim in self.proof.claims:
            details = [("", self.prose(claim.evidence))] if claim.evidence else []
            if claim.corrected:
                sure = verified(checks.get((claim.label, claim.printed)))
                corrected = re.split(r";\\quad |,\\ (?=\[)", claim.corrected)
                text = formulas([loosen(c) for c in corrected])
                if "$" in claim.corrected:
                    text = mixed(claim.corrected)
                details.append(("holds instead (proved)" if sure else "instead", text))
            row = {"label": escape(claim.label), "where": escape(claim.where), "verdict": claim.kind}
            rows.append(row | {"printed": mixed(claim.printed), "details": details})
        return rows

    def singular_set(self) -> list[tuple[str, str]]:
        if all(f.name != "singularities" for f in self.derivation.functions):
            return []
        entries = self.derivation["singularities"].outputs[0].entries
        titles = self.derivation.singularities
        return [
            (escape(titles[k % len(titles)]), formulas([f"{self.math(e)} = 0"]))
            for k, e in enumerate(entries)
        ]

    def outputs(self, function: Function) -> list[tuple[str, str]]:
        return [e for a in function.outputs for e in self.array(function, a)]

    def array(self, function: Function, array: Array) -> list[tuple[str, str]]:
        """The equations of a result: a matrix, or a row for each coordinate under its name."""
        name = symbol_name(array.name)
        if len(array.shape) == 0:
            return self.equations(name, array.entries[0])
        if len(array.shape) == 2:
            return self.equations(name, sp.Matrix(*array.shape, array.entries))
        if len(array.shape) == 3:
            n, size = array.shape[0], array.size // array.shape[0]
            parts = [array.entries[k * size : (k + 1) * size] for k in range(n)]
            return [
                e
                for k, part in enumerate(parts)
                for e in self.equations(f"{name}^{{({k + 1})}}", sp.Matrix(*array.shape[1:], part))
            ]
        names = [element(name, str(k + 1)) for k in range(array.size)]
        for known, joints in (("q", self.derivation.actuated), ("x", self.derivation.task)):
            if array.name == known and len(joints) == array.size:
                names = [symbol_name(str(j)) for j in joints]
        return [e for n, v in zip(names, array.entries, strict=True) for e in self.equations(n, v)]

    def equations(self, lhs: Any, value: Any) -> list[tuple[str, str]]:
        """A value as one equation or, where it is too wide, as several."""
        left = lhs if isinstance(lhs, str) else self.math(lhs)
        if isinstance(value, sp.MatrixBase):
            return self._matrix(left, value)
        if isinstance(value, str):
            return [(left, value)]
        if isinstance(value, list | tuple):
            return [(left, "(" + r",\ ".join(map(self.math, value)) + ")")]
        text = self.math(value)
        if isinstance(value, sp.Piecewise) and measure(text) > FITS:
            return [
                (left, rf"{self.math(e)}\quad {self.printer.case(c)}") for e, c in value.args
            ]
        return [(left, text)]

    def _matrix(self, lhs: str, matrix: sp.MatrixBase) -> list[tuple[str, str]]:
        """The widest entries get names, until the rest fits on a line."""
        cells = [[self.math(e) for e in matrix.row(i)] for i in range(matrix.rows)]
        base, named = lhs.partition("=")[0].strip(), []
        while measure(lhs) + _table_width(cells) > FITS:
            width, i, j = max(
                (measure(c), -i, -j) for i, row in enumerate(cells) for j, c in enumerate(row)
            )
            name = element(base, f"{1 - i}{1 - j}")
            if width <= measure(name):
                break
            named.append((-i, -j, (name, cells[-i][-j])))
            cells[-i][-j] = name
        rows = r" \\ ".join(" & ".join(row) for row in cells)
        whole = (lhs, rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}")
        return [whole, *(equation for _, _, equation in sorted(named))]


def _table_width(cells: Sequence[Sequence[str]]) -> float:
    columns = zip(*cells, strict=True)
    return sum(max(map(measure, column)) + 2 for column in columns)


def element(base: str, index: str) -> str:
    """The name of an entry of a matrix or a vector."""
    if subscript := re.fullmatch(r"(.+?)_\{?([^{}]+)\}?", base):
        return f"{subscript[1]}_{{{subscript[2]},{index}}}"
    return f"{base}_{{{index}}}" if " " not in base else f"({base})_{{{index}}}"


def blocks(equations: Sequence[tuple[str, str]]) -> list[str]:
    """Neighbours that fit on a line, aligned; longer ones as paragraphs."""
    done: list[list[str]] = []
    aligned = False
    for left, right in equations:
        fits = measure(left) + measure(right) + 4 <= FITS
        if fits and aligned:
            done[-1].append(f"{left} &= {right}")
        else:
            done.append([f"{left} &= {right}" if fits else f"{left} = {right}"])
        aligned = fits
    return [
        "\\begin{align*}\n" + " \\\\\n".join(rows) + "\n\\end{align*}"
        if " &= " in rows[0]
        else rf"\longformula{{{rows[0]}}}"
        for rows in done
    ]


def formulas(texts: Sequence[str]) -> str:
    """Formulas in a sentence."""
    return ", ".join(rf"$\displaystyle {t}$" for t in texts)


def notebook(derivation: Derivation) -> str:
    """What Jupyter shows of a derivation: the forward map and the inverse."""
    page = Page(derivation, Proof(derivation.name, derivation.paper.key, (), 0, ()))
    rows = [rf"&\textbf{{{derivation.title}}}"]
    for function in derivation.functions:
        if function.name in ("fk", "ik"):
            rows.append(rf"&\text{{{function.summary}}}")
            for s in function.body:
                if isinstance(s, Let | Bound):
                    rows += [f"{a} &= {b}" for a, b in page.equations(s.symbol, s.value)]
            rows += [f"{a} &= {b}" for a, b in page.outputs(function)]
    rows += [f"{short} &= {full}" for short, full in page.legend()]
    return r"$\displaystyle \begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}$"


def document(derivation: Derivation, proof: Proof) -> dict[str, Any]:
    """The context of ``latex/robot.tex.jinja``."""
    page = Page(derivation, proof)
    text = page.prose
    context = {
        "name": derivation.name,
        "title": escape(derivation.title),
        "source": escape(citation(derivation)),
        "reference": escape(derivation.paper.reference),
        "mechanism": text(derivation.mechanism),
        "parameters": [
            (page.math(p.symbol), escape(p.name), escape(p.unit), p.value, text(p.meaning),
             text(p.source)) for p in derivation.parameters
        ],
        "joints": [page.joint(j) for j in derivation.joints],
        "steps": [page.step(s) for s in derivation.steps],
        "inverses": [page.inverse(f) for f in derivation.functions if f.has_status],
        "functions": [page.function(f) for f in derivation.functions],
        "singular": page.singular_set(),
        "verdicts": ", ".join(f"{n} {kind}" for kind, n in proof.verdicts().items()),
        "claims": page.claims(),
    }  # fmt: skip
    return context | {"legend": page.legend()}
