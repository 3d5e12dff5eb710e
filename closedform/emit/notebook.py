"""Prints records as the LaTeX that a notebook shows.

Importing this module registers its printers with :mod:`closedform.model.display`.
"""

# mypy: allow-untyped-calls
# SymPy is only partly annotated.

from __future__ import annotations

from closedform.emit.backends.latex.article import Page
from closedform.emit.backends.latex.prose import escape, mixed
from closedform.model.claims import Claim, Erratum
from closedform.model.derivation import Derivation
from closedform.model.display import prints
from closedform.model.functions import Bound, Let
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


@prints(Claim)
def claim(claim: Claim) -> str:
    """A claim as it is printed, below its label."""
    return rf"$\textbf{{{escape(claim.label)}}}\text{{: {mixed(claim.text)}}}$"


@prints(Erratum)
def erratum(erratum: Erratum) -> str:
    """What is wrong, and why."""
    return rf"$\textbf{{{mixed(erratum.title)}}}\text{{: {mixed(erratum.why)}}}$"
