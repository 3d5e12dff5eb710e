"""Lemmas as LaTeX: what they say, and why it is true."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

from closedform.emit.backends.latex.formulas import FITS, measure
from closedform.emit.backends.latex.prose import escape, loosen, mixed
from closedform.lemmas.registry import theorems
from closedform.model.derivation import Derivation
from closedform.model.lemma import Lemma, Theorem


def lemmas_of(derivation: Derivation, function: str = "") -> list[str]:
    """The names of the lemmas that the inverses of a derivation apply, or one of its functions."""
    found = [s.lemma.name for s in derivation.solved if function in ("", s.function)]
    for inverse in derivation.inverses:
        if function in ("", inverse.function):
            found += [link.lemma.name for link in inverse.links if link.lemma]
    return list(dict.fromkeys(found))


def label(name: str) -> str:
    """The label of a lemma, ``lemma:two-link-arm``, or nothing if nobody states it."""
    return f"lemma:{key(name)}" if name in theorems() else ""


def titled(name: str) -> str:
    """The name of a lemma in a sentence; some are formulas."""
    theorem = theorems().get(name)
    return mixed(theorem.title) if theorem and theorem.title else escape(name)


def key(name: str) -> str:
    """The name of a lemma in labels: ``two-link-arm``."""
    return re.sub(r"[^a-z0-9]+", "-", name.lower()).strip("-")


def statement(lemma: Lemma) -> list[str]:
    """The statement of a lemma: what it solves, and the solution on a line of its own."""
    problem, arrow, solution = loosen(lemma.statement).partition(r"\;\Rightarrow\;")
    if not arrow:
        return packed("", clauses(problem))
    return [problem.strip(), *packed(r"\Rightarrow\quad ", clauses(solution))]


def clauses(text: str) -> list[str]:
    """The formulas of a list, each with the sign behind it; a space in TeX separates them."""
    parts, depth, start = list[str](), 0, 0
    for found in re.finditer(r"[({[]|[])}]|([,;:]?)\\(?:quad|(?<=,\\) )", text):
        if found[0] in "({[":
            depth += 1
        elif found[0] in "])}":
            depth -= 1
        elif depth == 0:
            parts.append(text[start : found.start()].strip() + found[1])
            start = found.end()
    return [*parts, text[start:].strip()]


def packed(lead: str, texts: Sequence[str]) -> list[str]:
    """Formulas beside each other as far as they fit; later lines start below the first formula."""
    rows = [lead]
    for text in texts:
        if rows[-1] not in (lead, "") and measure(rf"{rows[-1]} {text}") > FITS:
            rows.append(rf"\phantom{{{lead.strip()}}}" if lead else "")
        rows[-1] += text if rows[-1] in (lead, "") else rf"\quad {text}"
    return rows


def context(names: Sequence[str] | None, used: Mapping[str, Sequence[str]]) -> list[dict[str, Any]]:
    """The lemmas of these names, and those that they rest on; all lemmas for None.

    ``used`` names the mechanisms that apply a lemma, by their LaTeX.
    """
    known = _simplest_first(theorems(), used)
    wanted = set(known if names is None else names)
    for name in reversed(known):
        if name in wanted:
            wanted |= set(known[name].rests_on)
    return [_theorem(t, used.get(name, ())) for name, t in known.items() if name in wanted]


def _simplest_first(
    known: Mapping[str, Theorem], used: Mapping[str, Sequence[str]]
) -> dict[str, Theorem]:
    """The lemmas by the length of what is said about them, but after those that they rest on.

    One that serves other lemmas alone stands directly before the first of them.
    """
    ordered: dict[str, Theorem] = {}
    serving = {name for t in known.values() for name in t.rests_on} - {n for n in used if used[n]}

    def add(name: str) -> None:
        for other in known[name].rests_on:
            add(other)
        ordered.setdefault(name, known[name])

    for name in sorted(known, key=lambda n: (len(known[n].statement + known[n].proof), n)):
        if name not in serving:
            add(name)
    return ordered


def _theorem(theorem: Theorem, used: Sequence[str]) -> dict[str, Any]:
    plain = escape(theorem.name)
    title = mixed(theorem.title) if theorem.title else plain[:1].upper() + plain[1:]
    return {
        "key": key(theorem.name),
        "title": rf"\texorpdfstring{{{title}}}{{{plain}}}" if theorem.title else title,
        "index": f"{plain}@{title}" if theorem.title else plain,
        "statement": displayed(theorem.statement),
        "proof": displayed(theorem.proof),
        "exception": displayed(theorem.exception),
        "used": ", ".join(used),
    }


def displayed(text: str) -> str:
    """Text with formulas between dollar signs; those between two of them are displays."""
    parts = text.split("$$")
    return "".join(rf"\[{p}\]" if k % 2 else mixed(p) for k, p in enumerate(parts))
