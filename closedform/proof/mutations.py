"""Changes the printed text of a claim, to see that its verdict depends on it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from closedform.model.claims import HOLDS, NUMBERS, PIECE, Claim
from closedform.model.notation import NotationError
from closedform.proof.claims import judged

_SIGNS = {"+": "-", "-": "+", r"\pm": "+", r"\mp": r"\pm"}
_FUNCTIONS = {r"\sin": r"\cos", r"\cos": r"\sin", r"\tan": r"\sin"}
_RELATIONS = {
    "=": r"\ne", r"\equiv": r"\ne", r"\ne": "=", r"\neq": "=", "<": ">", ">": "<",
    r"\le": r"\ge", r"\leq": r"\ge", r"\ge": r"\le", r"\geq": r"\le",
}  # fmt: skip


@dataclass(frozen=True)
class Mutation:
    """One changed place of a claim: what was there, what stands there now, and the whole text."""

    kind: str
    old: str
    new: str
    text: str

    def __str__(self) -> str:
        return f"{self.kind} {self.old} -> {self.new}"


@dataclass(frozen=True)
class Outcome:
    """The outcome for a changed text: its verdict, or the error that its check raised."""

    mutation: Mutation
    kind: str
    error: str = ""
    changes: bool = False
    """Whether the text holds and the printed one does not, or the reverse."""


def outcomes(claim: Claim, *, held: bool | None = None) -> Iterator[Outcome]:
    """The verdict of each changed text; a text that the notation cannot read is left out.

    ``held`` says whether the printed text holds, if that is known.
    """
    if held is None:
        held = judged(claim, claim.printed).kind in HOLDS
    for mutation in mutations(claim):
        try:
            kind = judged(claim, mutation.text).kind
        except NotationError:
            continue
        except Exception as error:  # a check may call anything that its author wrote
            yield Outcome(mutation, "", f"{type(error).__name__}: {error}")
        else:
            yield Outcome(mutation, kind, changes=(kind in HOLDS) != held)


def mutations(claim: Claim) -> Iterator[Mutation]:
    """All texts with a sign, number, function, name, relation, phrase or word changed.

    A claim that does not hold yields its correction alone, which has to hold.
    """
    if claim.corrected:
        yield Mutation("correction", claim.text, claim.corrected, claim.corrected)
        return
    for match in PIECE.finditer(claim.printed):
        if match["phrase"] is not None:
            found = _phrases(claim, match["phrase"])
            start = match.start("phrase")
        else:
            found = _formula(claim, match["formula"])
            start = match.start("formula")
        for kind, a, b, new in found:
            old = claim.printed[start + a : start + b]
            text = claim.printed[: start + a] + new + claim.printed[start + b :]
            yield Mutation(kind, old, new, text)


def _phrases(claim: Claim, phrase: str) -> Iterator[tuple[str, int, int, str]]:
    if phrase in claim.opposites:
        yield "word", 0, len(phrase), claim.opposites[phrase]
        return
    meaning, others = claim.meaning(phrase), claim.vocabulary(phrase)
    if others is NUMBERS:
        near = [word for word, n in NUMBERS.items() if n is not None and n == (meaning or 0) + 1]
        others = {word: NUMBERS[word] for word in [*near[:1], "infinite"]}
    for other, value in others.items():
        if value != meaning:
            yield "phrase", 0, len(phrase), other


def _formula(claim: Claim, formula: str) -> Iterator[tuple[str, int, int, str]]:
    notation = claim.notation
    for piece in notation.pieces(formula):
        old = formula[piece.start : piece.end].strip()
        end = piece.start + len(old)
        if piece.kind == "sign":
            yield "sign", piece.start, end, _SIGNS[old] + " " * (old == r"\pm")
        elif piece.kind == "number":
            yield "number", piece.start, end, _next_number(old)
        elif piece.kind == "function":
            yield "function", piece.start, end, _FUNCTIONS[old]
        elif piece.kind == "relation" and old not in ("=", r"\equiv"):
            yield "relation", piece.start, end, _RELATIONS[old] + " "
        elif piece.kind == "name":
            for other in notation.alternatives(piece.name)[:1]:
                yield "name", piece.start, end, other


def _next_number(text: str) -> str:
    """The number with one more in its last digit."""
    whole, point, part = text.partition(".")
    digits = str(int(whole + part) + 1).rjust(len(whole + part), "0")
    return digits[: len(digits) - len(part)] + point + digits[len(digits) - len(part) :]
