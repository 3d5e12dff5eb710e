"""LaTeX: an article a mechanism, and the errata of all papers in Markdown."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from closedform.emit.backend import Backend, Files, Mechanism, Pages
from closedform.emit.backends.latex.article import document
from closedform.emit.backends.latex.errata import context
from closedform.emit.errata import Part, part
from closedform.emit.render import render


class Latex(Backend):
    def pages(self, mechanism: Mechanism) -> Pages:
        derivation, proof = mechanism.derivation, mechanism.proof
        text = render("latex/robot.tex.jinja", document(derivation, proof))
        return Pages({Path("latex", f"{derivation.name}.tex"): text}, part(derivation, proof))

    def shared(self, shares: Sequence[Part | None]) -> Files:
        return {Path("errata.md"): render("errata.md.jinja", context(shares))}

    def first_file(self, robot: str) -> Path:
        return Path("latex", f"{robot}.tex")


BACKEND = Latex()
