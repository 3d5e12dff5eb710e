"""Prints records as the LaTeX or the Markdown that a notebook shows.

Importing this module registers its printers with :mod:`closedform.model.display`.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from typing import Any

from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.formulas import Printer
from closedform.emit.backends.latex.prose import escape
from closedform.emit.escape import markdown_text
from closedform.model.claims import Claim, Erratum
from closedform.model.derivation import Derivation
from closedform.model.display import prints
from closedform.model.functions import Bound, Let
from closedform.model.lemma import Lemma, Theorem
from closedform.model.step import Step
from closedform.proof.prove import Proof


@prints(Derivation)
def notebook(derivation: Derivation) -> str:
    """The LaTeX of a derivation for Jupyter: the forward map and the inverse."""
    page = Page(derivation, Proof(derivation.name, derivation.paper.key, (), 0, ()))
    rows = [rf"&\textbf{{{escape(derivation.title)}}}"]
    for function in derivation.functions:
        if function.name in ("fk", "ik"):
            rows.append(rf"&\text{{{escape(function.summary)}}}")
            for s in function.body:
                if isinstance(s, Let | Bound):
                    rows += map(_row, page.equations(s.symbol, s.value))
            rows += map(_row, page.outputs(function))
    rows += [f"{short} &= {full}" for short, full in page.legend()]
    return r"$\displaystyle \begin{aligned}" + " \\\\\n".join(rows) + r"\end{aligned}$"


def _row(equation: tuple[str, str]) -> str:
    left, right = equation
    return f"{left} &= {right}" if left else rf"&\quad {right}"


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
    """A step: its reason, its equations, and what is proved of them."""
    rows = [(left, _math(value)) for left, value in step.shown]
    parts = [f"**{step.title}.** {step.reason}", _aligned(rows)]
    if step.proves:
        parts.append(f"*Proved:* {step.proves}")
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
