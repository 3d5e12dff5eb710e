"""A derivation as a page for the terminal."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Literal

import sympy as sp
from sympy.printing.pretty.pretty import PrettyPrinter
from sympy.printing.pretty.pretty_symbology import pretty_use_unicode

from closedform.emit.errata import gathered, part
from closedform.emit.terminal import (
    WIDTH,
    decimal,
    expression,
    from_latex,
    heading,
    mixed,
    paragraph,
)
from closedform.emit.text import citation
from closedform.model.derivation import Derivation
from closedform.model.functions import Bound, Determined, Function, Let, Match, Statement, Vanishes
from closedform.model.step import Step
from closedform.proof.prove import Proof


def show(
    derivation: Derivation,
    proof: Proof | None,
    format: Literal["text", "latex"] = "text",
    *,
    pretty: bool = True,
) -> str:
    """A derivation for the terminal: plain text of at most 100 columns, or the LaTeX article.

    Formulas are drawn in Unicode, or in ASCII unless ``pretty``.
    """
    if format == "latex":
        from closedform.emit.backends.latex.article import document
        from closedform.emit.render import render

        empty = Proof(derivation.name, derivation.paper.key, (), 0, ())
        return render("latex/robot.tex.jinja", document(derivation, proof or empty))
    return "\n".join(line.rstrip() for line in _lines(derivation, proof, pretty)) + "\n"


def _lines(derivation: Derivation, proof: Proof | None, pretty: bool) -> Iterator[str]:
    yield from _head(derivation)
    yield from heading("Steps")
    for number, step in enumerate(derivation.steps, 1):
        proved = proof is not None and step.title in proof.steps
        yield from _step(number, step, proved=proved, pretty=pretty)
    yield from heading("Functions")
    for function in derivation.functions:
        yield from _function(derivation, function, proof)
    if derivation.singularities:
        yield from heading("Singular set")
        yield from paragraph(", ".join(derivation.singularities), 2)
    if proof:
        yield from _findings(derivation, proof, pretty)


def _head(derivation: Derivation) -> Iterator[str]:
    """The mechanism, its parameters and its joints."""
    yield from (derivation.title, "=" * len(derivation.title), "")
    yield from paragraph(derivation.mechanism)
    yield from paragraph(f"Source: {citation(derivation)}.")
    yield from heading("Parameters")
    for p in derivation.parameters:
        yield from paragraph(f"{p.name} = {decimal(p.value)} {p.unit}: {p.meaning} ({p.source})", 2)
    yield from heading("Joints")
    for j in derivation.joints:
        role = "passive" if j.passive else "actuated" if j.coupling is None else f"= {j.coupling}"
        yield f"  {j.name}: {j.kind}, {role}"


def _step(number: int, step: Step, *, proved: bool, pretty: bool) -> Iterator[str]:
    published = f"  [paper: {', '.join(step.published)}]" if step.published else ""
    yield from ("", f"{number}. {step.title}{published}")
    yield from paragraph(step.reason, 3, 0)
    for lhs, value in step.shown:
        yield from _equation(from_latex(lhs, pretty=pretty), value, pretty)
    for row in step.rows:
        yield from paragraph("  |  ".join(map(_cell, row)), 3)
    if step.vanishes and proved:
        yield f"   [identities proved: {len(step.vanishes)}]"


def _findings(derivation: Derivation, proof: Proof, pretty: bool) -> Iterator[str]:
    """The errata of the paper, and its claims by verdict."""
    if proof.errata:
        yield from heading("Errata of the paper")
        for paper in gathered([part(derivation, proof)]):
            for entry in paper.entries:
                labels = ", ".join(c.label for c in entry.claims)
                title = mixed(entry.erratum.title, pretty=pretty)
                about = f"{title} ({entry.gravity.value}): {labels}"
                yield from paragraph(f"{entry.number}. {about}", 2)
    if proof.claims:
        yield from heading("Claims of the paper")
        for kind, n in proof.verdicts().items():
            labels = ", ".join(c.label for c in proof.claims if c.kind == kind)
            yield from paragraph(f"{n} {kind}: {labels}", 2)


def _cell(value: Any) -> str:
    return " <= ".join(map(str, value)) if isinstance(value, tuple) else str(value)


def _function(derivation: Derivation, function: Function, proof: Proof | None) -> Iterator[str]:
    arguments = ", ".join(f"{a.name}: {_entries(a.entries)}" for a in function.inputs)
    results = ", ".join(f"{a.name}{list(a.shape) or ''}" for a in function.outputs)
    yield from ("", *paragraph(f"{function.name}({arguments}) -> {results}", 2))
    yield from paragraph(function.summary, 4)
    for statement in function.body:
        yield from paragraph(_statement(statement), 4)
    if function.has_status:
        inverse = next((i for i in derivation.inverses if i.function == function.name), None)
        for a in function.outputs:
            names = inverse.unknowns if inverse else [f"{a.name}{k + 1}" for k in range(a.size)]
            for name, e in zip(names, a.entries, strict=False):
                yield from paragraph(f"{name} = {expression(e)}", 4)
    if function.branches and len(function.branches) > 1:
        for label, signs in function.cases():
            yield f"    branch {label}: " + ", ".join(f"{s} = {v:+d}" for s, v in signs.items())
    for result in proof.inverses if proof else ():
        if result.function == function.name:
            found = f"{result.solutions} solution{'s' * (result.solutions != 1)}"
            yield f"    proved sound and complete: the system has {found} ({result.method})"
    for note in function.notes:
        yield from paragraph(note, 4)


def _entries(entries: Sequence[sp.Expr]) -> str:
    if len(entries) > 6:
        return f"({entries[0]}, ..., {entries[-1]})"
    return f"({', '.join(map(str, entries))})"


def _statement(statement: Statement) -> str:
    if isinstance(statement, Let):
        return f"{statement.symbol} = {expression(statement.value)}"
    if isinstance(statement, Bound):
        return f"{statement.symbol} = {expression(statement.value)} >= 0: {statement.meaning}"
    if isinstance(statement, Vanishes):
        free = " and ".join(map(str, statement.free))
        effect = f"; then {free} is free" if free else ""
        zero = f"{expression(statement.value)} = 0"
        return f"{statement.symbol} if {zero}: {statement.meaning}{effect}"
    if isinstance(statement, Determined):
        small = f"{expression(statement.value)} << {expression(statement.scale)}"
        return f"{small}: {statement.meaning}; rounded joints do not determine the posture"
    values = (statement.value,) if isinstance(statement, Match) else statement.values
    return f"{statement.meaning}: " + ", ".join(f"{expression(v)} = 0" for v in values)


def _equation(lhs: str, value: Any, pretty: bool) -> list[str]:
    """An equation in two dimensions if it fits, else on lines of text; a value may be LaTeX."""
    if isinstance(value, str):
        return paragraph(f"{lhs} = {from_latex(value, pretty=pretty)}", 3)
    if isinstance(value, list | tuple):
        return paragraph(f"{lhs} = ({', '.join(map(expression, value))})", 3)
    before = pretty_use_unicode(pretty)  # roots and brackets depend on this, not on the setting
    try:
        form = PrettyPrinter({"use_unicode": pretty, "wrap_line": False})._print(
            sp.sympify(value, strict=True)
        )
    finally:
        pretty_use_unicode(before)
    picture, space = list(form.picture), 3 + len(lhs) + 3
    if space + form.width() <= WIDTH:
        pad = " " * space
        return [
            (f"   {lhs} = " if k == form.baseline else pad) + line for k, line in enumerate(picture)
        ]
    if isinstance(value, sp.MatrixBase):
        return [
            line
            for i in range(value.rows)
            for j in range(value.cols)
            for line in _equation(f"{lhs}[{i + 1},{j + 1}]", value[i, j], pretty)
        ]
    return paragraph(f"{lhs} = {value}", 3)
