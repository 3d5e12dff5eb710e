"""Prints records as the LaTeX or the Markdown that a notebook shows.

Importing this module registers its printers with :mod:`closedform.model.display`.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import Any

from closedform.emit.backends.latex.article import Page, document
from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.prose import symbols_of, upright
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.escape import markdown_text
from closedform.emit.markup import Markdown, number, plain
from closedform.model.claims import Claim, Erratum
from closedform.model.derivation import Derivation, Paper
from closedform.model.display import prints
from closedform.model.lemma import Lemma, Theorem
from closedform.model.step import Step
from closedform.proof.prove import Proof

MAPS = ("fk", "ik")
INDENT = "&emsp;"
NUMBERED = re.compile(r"theta\d")
"""An angle whose number tells it from others."""


class _Cell(Markdown):
    """Sentences of the articles for a cell of a notebook, where nothing can be referred to."""

    def __init__(self) -> None:
        super().__init__({})

    def inline(self, formula: str) -> str:
        return f"${' '.join(formula.split())}$"

    def status(self, name: str) -> str:
        return f"*{name.lower()}*"

    def equation(self, label: str) -> str:
        return f"({number(label)})"


@prints(Derivation, "markdown")
def notebook(derivation: Derivation) -> str:
    """A derivation for Jupyter: the mechanism, and how a reader computes its maps."""
    proof = Proof(derivation.name, derivation.paper.key, (), 0, ())
    context, page, cell = document(derivation, proof), Page(derivation, proof), _Cell()
    parts = [f"**{cell(context['title'])}.** {cell(context['mechanism'])}"]
    told = {f["name"]: f for f in (*context["functions"], *context["inverses"])}
    maps = [(derivation[name], f) for name, f in told.items() if name in MAPS]
    for function, f in maps:
        written = not function.has_status and len(function.outputs[0].shape) < 2
        if not f["lines"] and not written:  # a pose is a product of matrices, which steps show
            continue
        parts.append(f"**`{plain(f['name'])}({plain(f['arguments'])})`** {cell(f['summary'])}")
        if not f["lines"]:
            parts.append(_aligned(page.outputs(function)))
        for line in f["lines"]:
            remark = f" ({cell(line.remark)})" if line.remark else ""
            parts.append(f"{INDENT * (line.depth + 1)}{cell(line.text)}{remark}")
    if context["legend"]:
        parts.append(f"Here {', '.join(f'${entry}$' for entry in context['legend'])}.")
    return "\n\n".join(parts)


@prints(Claim, "markdown")
def claim(claim: Claim) -> str:
    """A claim as it is printed, after its label."""
    return f"**{markdown_text(claim.label)}:** {_text(claim.text)}"


@prints(Erratum, "markdown")
def erratum(erratum: Erratum) -> str:
    """What is wrong, why, and what follows."""
    parts = (f"**{_text(erratum.title)}.** {_text(erratum.why)}", _text(erratum.use))
    return "\n\n".join(parts)


@prints(Step, "markdown")
def step(step: Step) -> str:
    """A step as an article tells it: its reason, its equations, and what is proved of them."""
    alone = Derivation("step", step.title, Paper("none", "None", ()), "", steps=[step])
    for symbol in sorted(symbols_of(step), key=str):
        if NUMBERED.fullmatch(symbol.name):  # its sine and cosine have short names
            alone.joint(symbol.name)
    sheet, cell = Sheet(alone), _Cell()

    def text(sentences: str) -> str:
        return cell(sheet.prose(sentences))

    rows = [row for left, value in step.shown for row in sheet.equations(upright(left), value)]
    parts = [
        f"**{step.title}.** {text(step.reason)}",
        _aligned(rows),
        _table(step.rows, text),
    ]
    if legend := sheet.legend():
        parts.append(f"Here {', '.join(f'${short} = {full}$' for short, full in legend)}.")
    if step.proves:
        parts.append(f"*Proved:* {text(step.proves)}")
    return "\n\n".join(filter(None, parts))


@prints(Lemma, "markdown")
def lemma(lemma: Lemma) -> str:
    """What a lemma says, and the equations to which it was applied."""
    count = "one solution" if lemma.branches == 1 else f"{lemma.branches} solutions"
    return "\n\n".join(
        (
            f"**Lemma ({lemma.name}).**",
            f"$$\n{lemma.statement}\n$$",
            f"It solves these equations, which have {count}:",
            _aligned([("0", _math(e)) for e in lemma.equations]),
        )
    )


@prints(Theorem, "markdown")
def theorem(theorem: Theorem) -> str:
    """A lemma as the book states and proves it."""
    parts = [f"**Lemma ({theorem.title or theorem.name}).** {theorem.statement}"]
    parts += [f"*Exception.* {theorem.exception}"] if theorem.exception else []
    return "\n\n".join([*parts, f"*Proof.* {theorem.proof}"])


def _table(rows: Sequence[Sequence[Any]], text: Callable[[str], str]) -> str:
    """The rows of a step below the first one, which is the head."""
    lines = [f"| {' | '.join(_entry(e, text) for e in row)} |" for row in rows]
    return "\n".join([*lines[:1], "|---" * len(rows[0]) + "|", *lines[1:]]) if rows else ""


def _entry(value: Any, text: Callable[[str], str]) -> str:
    """An entry of a table: words, an expression or an increasing chain of them."""
    if isinstance(value, str):
        return text(value)
    chain = value if isinstance(value, tuple) else (value,)
    formula = r" \le ".join(map(_math, chain)).replace("|", r"\vert ")
    return f"${formula}$"


def _aligned(rows: list[tuple[str, str]]) -> str:
    lines = " \\\\\n".join(f"{left} &= {right}" for left, right in rows)
    return f"$$\\begin{{aligned}}\n{lines}\n\\end{{aligned}}$$" if rows else ""


def _math(value: Any) -> str:
    """An expression, a chain of them, or LaTeX as it is."""
    if isinstance(value, (tuple, list)):
        return r",\quad ".join(map(_math, value))
    return value if isinstance(value, str) else str(Printer(set()).doprint(value))


def _text(text: str) -> str:
    """Text with formulas between dollar signs, as Markdown."""
    parts = text.split("$")
    for i, part in enumerate(parts):
        inner = markdown_text(part)
        before, after = part[: len(part) - len(part.lstrip())], part[len(part.rstrip()) :]
        parts[i] = f"${part}$" if i % 2 else f"{before}{inner}{after}" if inner else before
    return "".join(parts)
