"""LaTeX: an article a mechanism, the book of all, and the errata in Markdown and as text."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from closedform.emit import errata_text
from closedform.emit.backend import Backend, Files, Mechanism, Pages
from closedform.emit.backends.latex import book, errata
from closedform.emit.backends.latex.article import document
from closedform.emit.errata import part
from closedform.emit.render import render

BOOK = Path("latex", "closedform.tex")


class Latex(Backend):
    def pages(self, mechanism: Mechanism) -> Pages:
        derivation, proof = mechanism.derivation, mechanism.proof
        text = render("latex/robot.tex.jinja", document(derivation, proof))
        share = book.chapter(derivation, part(derivation, proof))
        return Pages({Path("latex", f"{derivation.name}.tex"): text}, share)

    def shared(self, shares: Sequence[book.Chapter]) -> Files:
        parts = [share.errata for share in shares]
        return {
            Path("errata.md"): render("errata.md.jinja", errata.context(parts)),
            Path("errata.txt"): errata_text.text(parts),
            BOOK: render("latex/book.tex.jinja", book.context(shares)),
        }

    def first_file(self, robot: str) -> Path:
        return Path("latex", f"{robot}.tex")


BACKEND = Latex()
