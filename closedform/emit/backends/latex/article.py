"""Prints a derivation as a LaTeX article.

Python prepares the formulas and the sentences; the templates lay them out.  Formulas that fit on
a line are aligned; what does not fit is taken apart in
:mod:`closedform.emit.backends.latex.wide`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from closedform.emit.backends.latex.algorithm import Algorithm
from closedform.emit.backends.latex.formulas import FITS, Printer, measure
from closedform.emit.backends.latex.inverse import Told
from closedform.emit.backends.latex.names import Quantities, conventional_names, element
from closedform.emit.backends.latex.prose import Prose, escape, mixed, symbol_name, upright
from closedform.emit.backends.latex.wide import Equation, Lines
from closedform.emit.errata import Entry, gathered, part
from closedform.emit.text import citation
from closedform.model.claims import HOLDS, PROVED_UNDER
from closedform.model.derivation import Derivation, Joint, Step
from closedform.model.functions import Array, Function
from closedform.proof.claims import ClaimResult
from closedform.proof.prove import Proof

__all__ = ["Page", "document"]


class Page:
    """Collects the strings of one document."""

    def __init__(self, derivation: Derivation, proof: Proof):
        self.derivation, self.proof = derivation, proof
        self.printer = Printer({j.symbol for j in derivation.joints})
        self.math, self.prose = self.printer.math, Prose(derivation)
        self.lines = Lines(self.printer, self.prose.known)
        kept = [symbol_name(n) for n in (*derivation.task, *(j.name for j in derivation.joints))]
        self.quantities = Quantities(self.printer, [upright(n) for n in kept])
        self.symbols = {p.symbol for p in derivation.parameters}
        self.symbols |= {s for f in derivation.functions for s in f.symbols}
        self.printer.names |= conventional_names(derivation)
        self.algorithms: dict[str, Algorithm] = {}

    def blocks(self, equations: Sequence[Equation]) -> list[str]:
        return blocks(equations)

    def algorithm(self, function: Function) -> Algorithm:
        """The algorithm of a function, which goes on where that of an earlier one ends."""
        if function.name not in self.algorithms:
            model = self.model(function)
            means = {n: m for s in self.derivation.solved for n, m in s.lemma.means.items()}
            for inverse in self.derivation.inverses:
                if inverse.function == function.name:
                    means |= inverse.meaning
                    for lemma in inverse.reduction.lemmas if inverse.reduction else ():
                        means |= lemma.means
            earlier = self.algorithm(model) if model else None
            self.algorithms[function.name] = Algorithm(self, function, means, earlier)
        algorithm = self.algorithms[function.name]
        self.printer.names |= algorithm.names
        return algorithm

    def model(self, function: Function) -> Function | None:
        """The earlier function whose statements this one starts with, if there is one."""
        functions = self.derivation.functions
        earlier = functions[: functions.index(function)]
        shared = [f for f in earlier if f.body and function.body[: len(f.body)] == f.body]
        return max(shared, key=lambda f: len(f.body), default=None)

    def answers(self, function: Function) -> list[sp.Symbol]:
        """The joints that the outputs of an inverse stand for."""
        found = [i for i in self.derivation.inverses if i.function == function.name]
        total = sum(a.size for a in function.outputs)
        return list(found[0].unknowns) if found and len(found[0].unknowns) == total else []

    def legend(self) -> list[tuple[str, str]]:
        """The abbreviated sines and cosines that have been printed so far."""
        return sorted(self.printer.legend.items(), key=lambda e: (len(e[1]), e[0][9:], e[0]))

    def joint(self, joint: Joint) -> tuple[str, str, str, str]:
        role = "passive: the others move it" if joint.passive else "actuated"
        if joint.coupling is not None:
            role = f"coupled: ${self.math(joint.symbol)} = {self.math(joint.coupling)}$"
        return self.math(joint.symbol), escape(joint.name), joint.kind, role

    def step(self, step: Step) -> dict[str, Any]:
        self.lines.clear()
        shown: list[Equation] = []
        for lhs, value in step.shown:
            left = upright(lhs)
            shown += self.equations(left, self.quantities(value))
            self.quantities.define(left, value)
        n, proved = len(step.vanishes), step.title in self.proof.steps
        mark = f"{n} {'identity' if n == 1 else 'identities'}" if n and proved else ""
        if mark and step.nonnegative:
            mark += " where " + ", ".join(rf"${self.math(e)} \ge 0$" for e in step.nonnegative)
        return {
            "title": escape(step.title),
            "reason": self.prose(step.reason),
            "blocks": blocks(shown),
            "columns": "l" * len(step.rows[0]) if step.rows else "",
            "rows": [" & ".join(map(self.cell, row)) for row in step.rows],
            "published": escape(", ".join(step.published)),
            "mark": mark,
        }

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
            **self.computed(function),
            "key": _key(function) if function.has_status else "",
            "notes": [self.prose(n) for n in function.notes],
        }

    def computed(self, function: Function) -> dict[str, Any]:
        """What a function without a status computes, line by line; its formulas if that is all."""
        if function.has_status:
            return {}
        algorithm = self.algorithm(function)
        if not function.body:
            formulas = blocks(self.outputs(function))
            return {"blocks": formulas, "lines": [], "cases": [], "roundings": [], "after": ""}
        return {
            "after": self.after(function),
            "roundings": algorithm.roundings(),
            "blocks": [],
            "lines": algorithm.lines(),
            "cases": algorithm.cases(),
        }

    def after(self, function: Function) -> str:
        """The function with whose statements this one starts."""
        model = self.model(function)
        if model is None:
            return ""
        place = f", Section~\ref{{inverse:{_key(model)}}}" if model.has_status else ""
        return rf"\texttt{{{escape(model.name)}}}{place}"

    def inverse(self, function: Function) -> dict[str, Any]:
        """A function with a status for each branch."""
        return {**self.function(function), **Told(self, function).context()}

    def errata(self) -> list[dict[str, Any]]:
        """The errors of the paper that this mechanism shows, gravest first."""
        papers = gathered([part(self.derivation, self.proof)])
        return [self.erratum(e) for paper in papers for e in paper.entries]

    def erratum(self, entry: Entry) -> dict[str, Any]:
        return {
            "key": entry.erratum.key,
            "title": mixed(entry.erratum.title),
            "gravity": entry.gravity.value.capitalize(),
            "verdict": ", ".join(entry.verdicts),
            "why": mixed(entry.erratum.why),
            "use": mixed(entry.erratum.use),
            "claims": [self.claim(c) for c in entry.claims],
        }

    def claims(self) -> list[dict[str, Any]]:
        """The rows of the table; ``heading`` is the section of the paper, given once."""
        rows, where = [], ""
        for claim in self.proof.claims:
            rows.append({**self.claim(claim), "heading": claim.where != where})
            where = claim.where
        return rows

    def claim(self, claim: ClaimResult) -> dict[str, Any]:
        titles = {e.key: mixed(e.title) for e in self.proof.errata}
        steps = self.derivation.steps
        return {
            "where": escape(claim.where),
            "label": escape(claim.label),
            "step": next((k for k, s in enumerate(steps, 1) if derives(s, claim.label)), 0),
            "verdict": claim.kind if claim.kind in HOLDS else rf"\textbf{{{claim.kind}}}",
            "printed": mixed(claim.printed),
            "paraphrase": claim.paraphrase,
            "found": "Assumption:" if claim.kind == PROVED_UNDER else "Found:",
            "evidence": mixed(claim.evidence),
            "reading": mixed(claim.readings[0].text) if claim.readings else "",
            "others": [(mixed(r.text), r.kind, mixed(r.evidence)) for r in claim.readings[1:]],
            "corrected": mixed(claim.corrected),
            "erratum": claim.erratum,
            "title": titles.get(claim.erratum, ""),
        }

    def singular_set(self) -> list[tuple[str, str]]:
        """The name of each factor, and the equation that sets it to zero."""
        names = list(map(escape, self.derivation.singularities)) or ["factor"]
        found = [f.outputs[0] for f in self.derivation.functions if f.name == "singularities"]
        vanish = [formulas([f"{self.math(e)} = 0"]) for a in found for e in a.entries]
        return [(names[k % len(names)], formula) for k, formula in enumerate(vanish)]

    def outputs(self, function: Function) -> list[Equation]:
        self.lines.clear()
        return [e for a in function.outputs for e in self.array(a)]

    def assigned(self, array: Array, locus: Mapping[sp.Symbol, sp.Expr]) -> list[Equation]:
        """An argument and its entries, or the values of the entries on ``locus``."""
        if not locus or all(e in locus for e in array.entries):
            entries = [locus.get(e, e) for e in array.entries]
            matrix = len(array.shape) == 2
            value = sp.Matrix(*array.shape, entries) if matrix else entries
            return self.equations(symbol_name(array.name), value)
        return [x for e in array.entries if e in locus for x in self.equations(e, locus[e])]

    def array(self, array: Array, entries: Sequence[sp.Expr] | None = None) -> list[Equation]:
        """The equations of a result: a matrix, or a row for each coordinate under its name."""
        entries = array.entries if entries is None else entries
        name = symbol_name(array.name)
        if len(array.shape) > 1:
            shape = array.shape[-2:]
            parts = sp.Matrix(array.size // sp.prod(shape), sp.prod(shape), entries)
            marks = [f"^{{({k + 1})}}" if len(array.shape) > 2 else "" for k in range(parts.rows)]
            return [
                equation
                for k, mark in enumerate(marks)
                for equation in self.equations(name + mark, parts.row(k).reshape(*shape))
            ]
        names = [element(name, str(k + 1)) if array.shape else name for k in range(array.size)]
        for known, symbols in (("q", self.derivation.actuated), ("x", self.derivation.task)):
            if array.name == known and len(symbols) == array.size:
                names = [symbol_name(str(j)) for j in symbols]
        return [e for n, v in zip(names, entries, strict=True) for e in self.equations(n, v)]

    def equations(self, lhs: Any, value: Any) -> list[Equation]:
        """A value as one equation or, if it is too wide, as several."""
        return self.lines.equations(lhs if isinstance(lhs, str) else self.math(lhs), value)


def derives(step: Step, label: str) -> bool:
    """Whether a step derives the equation of a claim: ``eq. (9)`` or ``eq. (9), first line``."""
    names = {name for n in step.published for name in (n, f"eq. {n}")}
    return label in names or label.partition(",")[0] in names


def decimal(value: sp.Rational) -> str:
    """A rational as a decimal if that is exact and short, else as a fraction."""
    digits = next((k for k in range(7) if (value * 10**k).is_Integer), None)
    return str(value) if digits is None else f"{float(value):.{digits}f}"


def _key(function: Function) -> str:
    return function.name.replace("_", "-")


def blocks(equations: Sequence[Equation]) -> list[str]:
    """Neighbours that fit beside each other as one aligned block, longer ones as paragraphs."""
    done: list[str] = []
    group: list[Equation] = []

    def flush() -> None:
        if group:
            rows = " \\\\\n".join(
                f"{left} &= {right}" if left else rf"&\quad {right}" for left, right in group
            )
            done.append(f"\\display\n\\begin{{align*}}\n{rows}\n\\end{{align*}}")
        group.clear()

    for left, right in equations:
        if measure(left + right) > FITS:
            flush()
            text = f"{left} = {right}" if left else right
            done.append(rf"\longformula{{{text}}}")
            continue
        sides = zip(*group, (left, right), strict=True)
        if left and sum(max(map(measure, side)) for side in sides) > FITS:
            flush()
        group.append((left, right))
    flush()
    return done


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
        "source": escape(citation(derivation)),
        "reference": escape(derivation.paper.reference),
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
        "errata": page.errata(),
        "paper_source": mixed(derivation.paper.source),
        "claims": page.claims(),
    }  # fmt: skip
    return context | {"legend": ",\\quad ".join(map(" = ".join, page.legend()))}
