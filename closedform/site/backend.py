"""Prints the pages of the site as Markdown: a page for each mechanism, and those about all of them.

It is a back end like the others, but what it prints is built into ``build/site`` and not kept in
``generated/``.  The sentences and formulas are those of the articles.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import sympy as sp

from closedform.emit.backend import Backend, Files, Mechanism, Pages
from closedform.emit.backends.latex import book, lemmas
from closedform.emit.backends.latex.article import document
from closedform.emit.backends.latex.prose import escape, mixed
from closedform.emit.backends.latex.sheet import Sheet
from closedform.emit.errata import gathered, part
from closedform.emit.markup import Markdown, Place, anchor, displayed, fenced, plain
from closedform.emit.render import render
from closedform.emit.text import describe_operations
from closedform.model.claims import HOLDS
from closedform.model.derivation import Derivation
from closedform.model.step import Step
from closedform.site import labels, maps, published
from closedform.site.graph import rests_on

LIVE = "five_bar"
"""The mechanism on the first page."""
LEMMAS = "../lemmas.html"
LONGEST = 400
"""A difference of more characters is not shown, only counted."""


@dataclass(frozen=True)
class Card:
    """What the gallery shows of a mechanism, besides its chapter."""

    chapter: book.Chapter
    branches: int
    modes: int
    functions: tuple[str, ...]
    info: Mapping[str, Any]
    constants: Mapping[str, tuple[str, ...]]

    @property
    def counts(self) -> str:
        """How many solutions there are, in words."""
        modes = f", {self.modes} assembly modes" if self.modes > 1 else ""
        return f"{self.branches} branch{'es' if self.branches != 1 else ''}{modes}"


class Site(Backend):
    def pages(self, mechanism: Mechanism) -> Pages:
        derivation, proof = mechanism.derivation, mechanism.proof
        chapter = book.chapter(derivation, part(derivation, proof))
        card = Card(
            chapter=chapter,
            branches=len(derivation.branches),
            modes=len(derivation.assembly_modes),
            functions=tuple(f.name for f in derivation.functions),
            info=info(derivation),
            constants={
                "JOINTS": tuple(map(str, derivation.actuated)),
                "TASK": tuple(derivation.task),
                "BRANCHES": tuple(derivation.branches),
                "ASSEMBLY_MODES": tuple(derivation.assembly_modes),
                "SINGULARITIES": tuple(derivation.singularities),
            },
        )
        found = published.cases(derivation, proof)
        files = {Path("mechanisms", f"{derivation.name}.md"): page(mechanism)}
        if found:
            path = Path("_static", "published", f"{derivation.name}.js")
            files[path] = published.module(derivation, found)
        if maps.has_section(derivation):
            path = Path("_static", "maps", f"{derivation.name}.js")
            files[path] = maps.module(derivation)
        return Pages(files, card)

    def shared(self, shares: Sequence[Card]) -> Files:
        cards = {c.chapter.name: c for c in shares}
        chapters = book.in_order(c.chapter for c in shares)
        context = {"cards": [cards[c.name] for c in chapters], "md": Markdown({})}
        found = gathered(c.errata for c in chapters)
        home = {
            **context,
            "explorer": explorer(cards[LIVE].info),
            "errors": sum(p.errors()["Errors"] for p in found),
            "papers": sum(p.errors()["Errors"] > 0 for p in found),
            "lesser": sum(len(p.entries) - p.errors()["Errors"] for p in found),
        }
        return {
            Path("index.md"): render("site/home.md.jinja", home),
            Path("reference", "index.md"): render("site/index.md.jinja", context),
            Path("mechanisms", "index.md"): render("site/gallery.md.jinja", context),
            Path("lemmas.md"): render("site/lemmas.md.jinja", _lemmas(chapters)),
            **{Path("reference", f"{n}.md"): _reference(c) for n, c in cards.items()},
        }


def page(mechanism: Mechanism) -> str:
    """The page of one mechanism."""
    derivation, proof = mechanism.derivation, mechanism.proof
    found = document(derivation, proof)
    found["claims"] = [
        {**row, "kind": css(claim.kind), "said": claim.kind}
        for row, claim in zip(found["claims"], proof.claims, strict=True)
    ]
    md = Markdown(places(found), [work["key"] for work in found["works"]])
    sheet = Sheet(derivation)
    for shown, step in zip(found["steps"], derivation.steps, strict=True):
        shown["rows"] = [[md(cell) for cell in row] for row in shown["rows"]]
        shown["identities"] = identities(sheet, step) if shown["counted"] else []
    context = {
        **found,
        "md": md,
        "display": md.display,
        "paragraph": displayed,
        "place": md.place,
        "link": md.section,
        "anchor": anchor,
        "plain": plain,
        "unexplored": unexplored(derivation),
        "explorer": "" if unexplored(derivation) else explorer(info(derivation)),
        "graph": fenced("graph", rests_on(derivation, proof)),
        "operations": {n: describe_operations(p) for n, p in mechanism.lowered.items()},
        "parameter_rows": [
            [md(f"${symbol}$"), f"`{plain(name)}`", md(unit), md(value), md(meaning), md(source)]
            for symbol, name, unit, value, meaning, source in found["parameters"]
        ],
        "joint_rows": [
            [md(f"${symbol}$"), f"`{plain(name)}`", kind, md(role)]
            for symbol, name, kind, role in found["joints"]
        ],
        "symbol_rows": [[md(f"${symbol}$"), md(meaning)] for symbol, meaning in found["symbols"]],
        "branch_rows": lambda rows: [[f"`{plain(n)}`", md(f"${signs}$")] for n, signs in rows],
        "cases": partial(_cases, md),
    }
    return render("site/mechanism.md.jinja", context)


def _cases(md: Markdown, cases: Sequence[Any]) -> list[list[str]]:
    rows = []
    for c in cases:
        status = f" ({c.status.upper()})" if c.status else ""
        rows.append([md(c.where), md(c.meaning), md(c.returned) + status])
    return rows


def places(found: Mapping[str, Any]) -> dict[str, Place]:
    """What the sentences of a page refer to, besides its equations."""
    name = found["name"]
    titles = {f"step:{name}:{s['number']}": s["title"] for s in found["steps"]}
    titles |= {f"inverse:{name}:{f['key']}": rf"\texttt{{{f['name']}}}" for f in found["inverses"]}
    titles |= {f"erratum:{name}:{e['key']}": e["title"] for e in found["errata"]}
    titles |= {f"claim:{name}:{c['number']}": c["label"] for c in found["claims"]}
    titles[f"singular:{name}"] = "singular set"
    titles[f"chapter:{name}"] = found["title"]
    md = Markdown({})
    here = {x: Place(f"#{anchor(x)}", md(title)) for x, title in titles.items()}
    return here | lemma_places(LEMMAS)


def lemma_places(address: str) -> dict[str, Place]:
    """The lemmas, which have a page of their own."""
    return {
        f"lemma:{t['key']}": Place(f"{address}#{anchor('lemma:' + t['key'])}", t["title"])
        for t in lemmas.context(None, {})
    }


def identities(sheet: Sheet, step: Step) -> list[str]:
    """The differences that the prover has shown to vanish, as displays; nothing if one is long."""
    rows = []
    for value in step.vanishes:
        for entry in sp.flatten(value) if isinstance(value, sp.MatrixBase) else [value]:
            text = sheet.math(entry) if isinstance(entry, sp.Expr) else ""
            if not text or len(text) > LONGEST:
                return []
            rows.append(f"{text} = 0")
    return [displayed(row) for row in dict.fromkeys(rows)]


def info(derivation: Derivation) -> dict[str, Any]:
    """What the explorer needs to know that the JavaScript module does not say."""
    return {
        "name": derivation.name,
        "title": derivation.title,
        "unit": labels.length_unit(derivation),
        "parameters": {
            p.name: {
                **labels.written(derivation, p.name),
                "meaning": p.meaning,
                "unit": labels.unit(p.unit),
            }
            for p in derivation.parameters
        },
        "joints": {j.name: labels.written(derivation, j.name) for j in derivation.joints},
        "task": [labels.coordinate(derivation, name) for name in derivation.task],
        "given": labels.given(derivation),
    }


def unexplored(derivation: Derivation) -> str:
    """Why a mechanism has no explorer, or an empty string."""
    if not derivation.has_forward_map:
        return "This mechanism has no forward map in closed form"
    return ""


def explorer(told: Mapping[str, Any]) -> str:
    return fenced("explorer", json.dumps(told, ensure_ascii=False))


def css(kind: str) -> str:
    """A verdict as a class of the style sheet."""
    return ("holds " if kind in HOLDS else "") + kind.replace(" ", "-")


def _reference(card: Card) -> str:
    """The page of the Python module of a mechanism."""
    shown = {"name": card.chapter.name, "functions": card.functions}
    context = {**shown, "constants": {n: v for n, v in card.constants.items() if v}}
    return render("site/reference.md.jinja", context)


def _lemmas(chapters: Sequence[book.Chapter]) -> dict[str, Any]:
    used: dict[str, list[str]] = {}
    for chapter in chapters:
        for name in chapter.lemmas:
            link = rf"\hyperref[chapter:{chapter.name}]{{{escape(chapter.title)}}}"
            used.setdefault(name, []).append(link)
    known = {
        f"chapter:{c.name}": Place(f"mechanisms/{c.name}.html", mixed(c.title)) for c in chapters
    }
    md = Markdown(known | lemma_places("lemmas.html"))
    return {"theorems": lemmas.context(None, used), "md": md, "anchor": anchor}


BACKEND = Site()
